"""Results are those that were frozen at commit 93d3dc1.

make_frozen.py, beside this file, says what was frozen and how. Keys that results did not have then
may be new; none may be missing. Texts are compared exactly. Results that are meant to differ stand
in intended_changes.toml, each with its reason.
"""

from __future__ import annotations

import copy
import functools
import json
import lzma
import math
import tomllib
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.library import uncertainty_table
from epicyclic.losses.ranges import OUT_OF_RANGE
from epicyclic.machine.solve import LOSS_AGREEMENT
from epicyclic.study.operating import key_of
from frozen.make_frozen import RESULTS, band_of
from frozen.texts import improved, words

TOLERANCE = 1e-9
"""Relative. Other processors round differently and change these results by up to 1e-11."""

ROUNDING = {
    # one less a ratio of two powers
    "*pocket_power_difference*": 1e-12,
    # the tilt of the planets of a spur set, zero by symmetry, in um, and its moment in N m
    "*misalignment*": 1e-9,
    "*planet_bearing*moment*": 1e-12,
    "*heat/residual": 1e-12,  # over the heat of all losses
    "*/band/shares/*": 1e-16,  # of the variance: squares of the rounding of losses
}
"""Numbers that may be nothing but rounding, and how large that may be."""

LOSSES = ("_sliding", "_rolling", "_mechanical", "total", "load_dependent", "load_independent")
"""Ends of the names of losses that follow loads, and of sums, in maps and sweeps."""

BALANCED = 1e-12
"""Rounding of what balances between the members, over the largest of them: speeds, torques, powers.
Where a member should have none of it, the balance leaves this."""

AGREED = 2 * LOSS_AGREEMENT
"""Difference of losses, over all of them, that agree with the torques that they lead to, then and
now: where the passes stop depends on where they begin."""

CHANGED = tomllib.loads(
    Path(__file__).with_name("intended_changes.toml").read_text(encoding="utf-8")
)
AS_THEN = {name: it["as_then"] for it in CHANGED["case"] for name in it["names"]}
ONLY = {name: it["only"] for it in CHANGED["sweep"] for name in it["names"]}
WITHIN = {name: it["within"] for it in CHANGED["result"] for name in it["names"]}
MORE = {name: it.get("more", {}) for it in CHANGED["result"] for name in it["names"]}
FACTORS = {it["kind"]: it["then"] for it in CHANGED["factor"]}
FIGURES = {it: own["within"] for own in CHANGED["figure"] for it in own["patterns"]}

WEIGHED = [item["text"] for item in CHANGED["weighed"]]
NEW_WARNINGS = [item["text"] for item in CHANGED["warning"]]

FROZEN = json.loads(lzma.decompress(RESULTS.read_bytes()))

CASES = [
    pytest.param(name, marks=() if entry["quick"] else pytest.mark.slow)
    for name, entry in FROZEN["cases"].items()
]


@pytest.mark.parametrize("name", CASES)
def test_results_are_the_frozen_ones(name):
    entry = FROZEN["cases"][name]
    case = ep.load_case(entry["case"])
    if name in AS_THEN:
        case = case.updated(AS_THEN[name])
    if "error" in entry:
        with pytest.raises(ep.ConvergenceError) as error:
            ep.solve(case)
        assert words(str(error.value)) == improved(entry["error"])
        return
    result = ep.solve(case)
    numbers = {item.key: item.value for item in result.numbers()}
    found = {"result": result.to_dict(), "numbers": numbers}
    warnings = found["result"]["warnings"]
    found["result"]["warnings"] = [
        it for it in warnings if not any(new in it for new in NEW_WARNINGS)
    ]
    if any(text in it for it in entry["result"]["warnings"] for text in WEIGHED):
        for one in (entry, found):
            told = one["result"]["warnings"]
            one["result"]["warnings"] = [it for it in told if not it.startswith(OUT_OF_RANGE)]
    name_the_same_roller(entry, found)
    if name in WITHIN:
        for key in ("warnings", "validity"):
            del entry["result"][key]
    check(name, {key: entry[key] for key in found if key in entry}, found)


def without_new(warnings: Any) -> Any:
    """Warnings of points without those that came later, and without ranges, which weigh else."""
    if isinstance(warnings, list):
        return [without_new(one) for one in warnings]
    new = (OUT_OF_RANGE, *NEW_WARNINGS)
    return " | ".join(it for it in warnings.split(" | ") if not any(text in it for text in new))


@pytest.mark.parametrize("name", FROZEN["data"])
def test_maps_and_sweeps_are_the_frozen_ones(name):
    entry = FROZEN["data"][name]
    case = ep.load_case(entry["case"]).updated(entry["changes"])
    if entry["kind"] == "loss_map":
        data = ep.loss_map(case, **entry["asked"], jobs=1)
    else:
        data = ep.sweep(case, entry["asked"], jobs=1)
    keys = {} if entry["kind"] == "loss_map" else {name: key_of(data[name]) for name in data.dims}
    found = {  # a sweep's dimensions, once its keys, have names without dots
        str(key): {"dims": [keys.get(it, it) for it in array.dims], "values": array.values.tolist()}
        for key, array in {**data.coords, **data.data_vars}.items()
    }
    for one in (entry["data"], found):
        one["warnings"] = one["warnings"] | {"values": without_new(one["warnings"]["values"])}
    for axis, value in ONLY.get(name, {}).items():
        index = entry["asked"][axis].index(value)
        entry["data"], found = at(entry["data"], axis, index), at(found, axis, index)
    check(name, entry["data"], found)


def at(data: dict[str, Any], axis: str, index: int) -> dict[str, Any]:
    """Arrays at one place of an axis; those of texts as they are."""
    taken = {}
    for name, array in data.items():
        if axis in array["dims"]:
            place = array["dims"].index(axis)
            array = {"dims": array["dims"], "values": _at(array["values"], place, index)}
        taken[name] = array
    return taken


def _at(values: list[Any], place: int, index: int) -> list[Any]:
    return [values[index]] if place == 0 else [_at(item, place - 1, index) for item in values]


@pytest.mark.parametrize("name", FROZEN["bands"])
def test_bands_are_the_frozen_ones(name, tmp_path, monkeypatch):
    entry = FROZEN["bands"][name]
    for form in uncertainty_table()["model_form"]:
        factor = FACTORS.get(form["kind"], form["lognormal_factor"])
        monkeypatch.setitem(form, "lognormal_factor", factor)
    tables = copy.deepcopy(entry["case"])
    for key, value in AS_THEN.get(name, {}).items():
        *path, last = key.split(".")
        functools.reduce(lambda table, part: table.setdefault(part, {}), path, tables)[last] = value
    found = band_of(tables, tmp_path)
    # later remarks, on ISO/TR 14179-2 beside the result, come behind those of then
    then = len(entry["result"]["advice"]["remarks"])
    found["advice"]["remarks"] = found["advice"]["remarks"][:then]
    check(name, entry["result"], found)


def check(name: str, frozen: dict[str, Any], found: dict[str, Any]) -> None:
    """No difference."""
    left = [f"{place}: {text}" for place, text in differences(frozen, found, name)]
    assert not left, "\n".join([f"{len(left)} differences", *left[:30]])


def name_the_same_roller(entry: dict[str, Any], found: dict[str, Any]) -> None:
    """Of rollers that are loaded equally, left and right of the load, take the frozen one."""
    azimuth = found["numbers"].get("planet_bearing_roller_azimuth")
    if any(math.isclose(azimuth, tied, rel_tol=TOLERANCE) for tied in entry["tied"]):
        figure = entry["result"]["planet_bearing"]["roller_azimuth"]
        found["result"]["planet_bearing"]["roller_azimuth"] = figure
        found["numbers"]["planet_bearing_roller_azimuth"] = figure["value"]


def differences(
    frozen: dict[str, Any], found: dict[str, Any], name: str
) -> Iterator[tuple[str, str]]:
    """Place and text of all that is missing or not the same.

    A place reads "planetary-004/result/losses/sun_drag".
    """
    floors = [agreement_floors(frozen), balance_floors(frozen), ROUNDING]
    yield from _differences(frozen, found, name, floors)


def agreement_floors(frozen: dict[str, Any]) -> dict[str, float]:
    """What losses may differ by, by pattern."""
    if "result" in frozen:
        most = AGREED * frozen["result"]["total"]
        own = [f"*/numbers/{name}" for name in frozen["result"]["losses"]]
        sums = ["*/total", "*/load_dependent", "*/load_independent", "*/kinds/*", "*/stages/*"]
        floors = dict.fromkeys([*own, *sums, "*/losses/*"], most)
        share = most / (frozen["result"]["input_power"] or math.inf)
        return floors | {"*/efficiency": share} | member_floors(frozen, share)
    if "total" in frozen and "dims" in frozen["total"]:
        largest = {
            name: float(np.nanmax(values(frozen["total" if name.endswith(LOSSES) else name])))
            for name in frozen
            if name.endswith((*LOSSES, "torque_loss"))
        }
        return {f"*/{name}/values/*": AGREED * most for name, most in largest.items()}
    return {}


def balance_floors(frozen: dict[str, Any]) -> dict[str, float]:
    """Rounding of what balances between the members, by pattern."""
    floors = member_floors(frozen, BALANCED)
    for name, array in frozen.items():
        if name.endswith("_torque"):  # of a map or a sweep
            floors[f"*/{name}/values/*"] = BALANCED * float(np.nanmax(np.abs(values(array))))
    return floors


def member_floors(frozen: dict[str, Any], share: float) -> dict[str, float]:
    """That share of the largest speed, torque and power of all members, by pattern."""
    members = frozen.get("result", {}).get("members", {})
    floors = {}
    for kind in ("speed", "torque", "power"):
        largest = max((abs(member[kind]["value"]) for member in members.values()), default=0.0)
        for name in members:
            floors[f"*/members/{name}/{kind}/value"] = share * largest
            floors[f"*/numbers/{name}_{kind}"] = share * largest
        if kind == "torque":  # which of it the sets of a train leave to each other
            floors["*/stage_torques/*"] = share * largest
    return floors


def values(array: dict[str, Any]) -> np.ndarray:
    """Those of a frozen array of numbers."""
    return np.array(array["values"], dtype=float)


def _differences(
    frozen: Any, found: Any, place: str, floors: list[dict[str, float]]
) -> Iterator[tuple[str, str]]:
    if isinstance(frozen, dict) and isinstance(found, dict):
        for key, item in frozen.items():
            if key in found:
                yield from _differences(item, found[key], f"{place}/{key}", floors)
            else:
                yield f"{place}/{key}", "is missing"
    elif isinstance(frozen, list) and isinstance(found, list) and len(frozen) == len(found):
        for number, (old, new) in enumerate(zip(frozen, found, strict=True)):
            yield from _differences(old, new, f"{place}/{number}", floors)
    elif not same(frozen, found, place, floors) and not meant(frozen, found, place):
        yield place, f"{found!r} was {frozen!r}"


def same(frozen: Any, found: Any, place: str, floors: list[dict[str, float]]) -> bool:
    """Two values without parts; NaN was frozen as None, and texts may have been improved."""
    if isinstance(frozen, str):
        return bool(improved(frozen) == words(found))
    if isinstance(found, float) and math.isnan(found):
        found = None
    if not (is_number(frozen) and is_number(found)):
        return bool(frozen == found)
    if frozen == found:
        return True
    fits = (size for own in floors for key, size in own.items() if fnmatch(place, key))
    floor = max(fits, default=0.0)
    name = place.split("/")[0]
    near = WITHIN.get(name, TOLERANCE)
    more = FIGURES | MORE.get(name, {})
    near = max([near, *(it for key, it in more.items() if fnmatch(place, key))])
    return math.isclose(frozen, found, rel_tol=near, abs_tol=floor)


def meant(frozen: Any, found: Any, place: str) -> bool:
    """True if it is meant to be different there."""
    return any(
        fnmatch(place, item["pattern"]) and frozen == item.get("old") and found in item["new"]
        for item in CHANGED["place"]
    )


def is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
