"""Results are those that were frozen at commit 50d7790, but for the exceptions named here.

make_frozen.py, beside this file, says what was frozen and how. Keys that results did not have then
may be new; none may be missing.
"""

from __future__ import annotations

import json
import lzma
import math
from collections.abc import Iterator, Mapping
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import epicyclic as ep

_EMPTY_PLANET = (
    "The flow through the pockets takes the driving flank of the planets' mean load; it took that "
    "of planet 1, which counted as driving even while it carried nothing in a set that coasts."
)
_PINION = (
    "The friction of Niemann and Winter takes the diameter of the pinion, the smaller gear of a "
    "mesh; it took that of the gear that the case names first."
)
_TILT = (
    "The tilt of the planets is found where it was not: at light loads, and in bearings of few "
    "rollers, which hardly resist to tilt in one direction."
)
_CONTACT_LOST = (
    "Where the closed form of load sharing does not hold, because a planet loses contact, the "
    "loads are those of `direct`, and a note says so; it was an error."
)
_GEAR_1_IS_LARGER = """
    pair-033 pair-044 pair-069 pair-105 planetary-013 planetary-037 planetary-043 planetary-054
    planetary-077 planetary-084 planetary-097 planetary-105 planetary-112 planetary-130
    planetary-133 planetary-144 planetary-166
"""
_ENTERING = (
    "The power that enters is counted at every shaft where it does, with the losses. It was "
    "counted at the shafts that would drive without losses, so that losses that exceed the power "
    "passed on, and those without torque, came from nowhere."
)
_NOTHING_LEAVES = """
    planetary-007 planetary-014 planetary-031 planetary-040 planetary-053 planetary-058
    planetary-069 planetary-087 planetary-089 planetary-109 planetary-118 planetary-131
    planetary-134 planetary-154 planetary-160 planetary-174 planetary-182 planetary-188
    pair-011 pair-021 pair-028 pair-041 pair-054 pair-066 pair-070 pair-078 pair-095
    pair-102
"""
_WITHOUT_POWER = (
    *_NOTHING_LEAVES.split(),
    "talbot-2012-pair",
    "no air in the oil",
    "stiff oil",
    "racing",
    "map talbot-2012",
    "map talbot-2012-pair",
    "sweep talbot-2012-pair",
)
_BOUNDED = (
    "The incompressible flow through pockets is bounded at the pressure of a void and solved by "
    "another method, which changes its loss where no void forms by up to 2 % at the default "
    "resolution, and by up to 4.4 % at coarser ones."
)
_SMALLER = (
    "The flow through the pockets of a pair takes its time steps from the smaller gear; it took "
    "them from the gear that the case names first, which changed its loss by up to 1.3 %."
)
_STARTED = (
    "The loads along the lines of contact start from those of the pass before, which changes "
    "losses within the tolerance of those loads, by up to 3 in a billion."
)
_INCOMPRESSIBLE = """
    pair-001 pair-020 pair-031 pair-040 pair-049 pair-069 pair-082 pair-096 pair-099
    planetary-009 planetary-016 planetary-028 planetary-041 planetary-060 planetary-066
    planetary-079 planetary-085 planetary-106 planetary-114 planetary-128 planetary-144
    planetary-147 planetary-166 planetary-175
"""
_WARNINGS = (
    "Warnings about ranges say how many watts they concern; the largest come first, and those that "
    "concern less than one per cent of the loss share one sentence."
)
_FITTED = (
    "Oils with models fitted to simulated contacts take them where auto is asked; they took "
    "formulas from gear tests."
)
EXCEPTIONS: dict[str, str] = {
    **{
        f"sweep talbot-2012-pair/{name}/*": _FITTED  # of another oil than the test fluid
        for name in ("mesh_rolling", "load_dependent", "total", "gear_torque")
    },
    "*/warnings*": _WARNINGS,
    **{f"planetary-{number}/error": _TILT for number in ("066", "141", "175")},
    **{f"planetary-{number}/error": _CONTACT_LOST for number in ("006", "051", "150")},
    **{
        f"{case}/*{what}*": _ENTERING
        for case in _WITHOUT_POWER
        for what in ("input_power", "efficiency", "warnings")
    },
    "planetary-095/*": _EMPTY_PLANET,  # planet 1 carries nothing, and the set coasts
    **{f"{case}/*": _PINION for case in _GEAR_1_IS_LARGER.split()},  # friction niemann-winter
    **{f"{case}/*": _BOUNDED for case in _INCOMPRESSIBLE.split()},
    **{f"pair-{number}/*": _SMALLER for number in ("037", "083")},
    "planetary-038/*ring_mesh_sliding": _STARTED,
}
"""Places where results were changed on purpose, as patterns of `fnmatch`, each with its reason in
the words of CHANGELOG.md. A place reads "planetary-004/result/losses/sun_drag"."""

THEN = {"models.pocketing": "mean-density"}
NEW_DEFAULT = (
    "The default of models.pocketing is an incompressible mixture above the pressure of a void; it "
    "was mean-density."
)
"""What has another default than when the results were frozen, and the reason in CHANGELOG.md."""

TOLERANCE = 1e-9
"""Relative. Other processors round differently and change these results by up to 1e-11."""

ROUNDING = {
    # one less a ratio of two powers
    "*pocket_power_difference*": 1e-12,
    # the tilt of the planets of a spur set, zero by symmetry, in um, and its moment in N m
    "*misalignment*": 1e-9,
    "*planet_bearing*moment*": 1e-12,
}
"""Numbers that may be nothing but rounding, and how large that may be."""

BALANCED = 1e-12
"""Rounding of what balances between the members, over the largest of them: speeds, torques, powers.
Where a member should have none of it, the balance leaves this."""

FROZEN = json.loads(lzma.decompress(Path(__file__).with_name("results.json.xz").read_bytes()))
CHANGELOG = Path(__file__).parents[2] / "CHANGELOG.md"

AS_FROZEN = {"models.mesh_loads": "without-losses"}
"""Choices that were no choices then."""


def as_frozen(case):
    """A case with the choices that were no choices then."""
    if case.kind == "planetary" and case.planet.mass is None:
        return case.updated(AS_FROZEN | {"planet.mass": "0 kg"})
    return case.updated(AS_FROZEN)


slow = pytest.mark.slow
CASES = [
    pytest.param(name, marks=() if entry["quick"] else slow)
    for name, entry in FROZEN["cases"].items()
]


@pytest.mark.parametrize("name", CASES)
def test_results_are_the_frozen_ones(name):
    entry = FROZEN["cases"][name]
    case = frozen_case(entry["case"], entry)
    if f"{name}/error" in EXCEPTIONS:
        ep.solve(case)
        return
    if "error" in entry:
        with pytest.raises(ep.ConvergenceError) as error:
            ep.solve(case)
        assert str(error.value) == entry["error"]
        return
    result = ep.solve(case)
    numbers = {item.key: item.value for item in result.numbers()}
    found = {"result": result.to_dict(), "numbers": numbers}
    name_the_same_roller(entry, found)
    check(name, {key: entry[key] for key in found}, found)


@pytest.mark.parametrize("name", FROZEN["data"])
def test_maps_and_sweeps_are_the_frozen_ones(name):
    entry = FROZEN["data"][name]
    case = frozen_case(entry["case"]).updated(entry["changes"])
    if entry["kind"] == "loss_map":
        data = ep.loss_map(case, **entry["asked"], jobs=1)
    else:
        data = ep.sweep(case, entry["asked"], jobs=1)
    found = {
        str(key): {"dims": list(array.dims), "values": array.values.tolist()}
        for key, array in {**data.coords, **data.data_vars}.items()
    }
    check(name, entry["data"], found)


def frozen_case(given: dict[str, Any] | str, entry: Mapping[str, Any] = {}) -> Any:
    """A case with the defaults of that time."""
    case = as_frozen(with_models_of(entry, ep.load_case(given)))
    if case.models.pocketing == "auto":
        case = case.updated(THEN)
    return case


def test_exceptions_are_in_the_changelog():
    told = " ".join(CHANGELOG.read_text(encoding="utf-8").split())
    assert [why for why in (*EXCEPTIONS.values(), NEW_DEFAULT) if why not in told] == []


def with_models_of(entry: Mapping[str, Any], case: Any) -> Any:
    """The case with the models that ``auto`` stood for then: oils have fitted ones since."""
    chosen = {
        f"models.{key}": model
        for key, model in entry.get("result", {}).get("models", {}).items()
        if getattr(case.models, key, None) == "auto"
    }
    return case.updated(chosen) if chosen else case


def check(name, frozen, found):
    """No difference but the exceptions."""
    floors = balance_floors(frozen)
    left = [
        f"{place}: {text}"
        for place, text in differences(frozen, found, name, floors)
        if not any(fnmatch(place, pattern) for pattern in EXCEPTIONS)
    ]
    assert not left, "\n".join([f"{len(left)} differences", *left[:30]])


def name_the_same_roller(entry: dict[str, Any], found: dict[str, Any]) -> None:
    """Of rollers that are loaded equally, left and right of the load, take the frozen one."""
    azimuth, frozen = found["numbers"].get("planet_bearing_roller_azimuth"), entry["numbers"]
    if any(math.isclose(azimuth, tied, rel_tol=TOLERANCE) for tied in entry["tied"]):
        found["numbers"]["planet_bearing_roller_azimuth"] = frozen["planet_bearing_roller_azimuth"]
        figures = entry["result"]["planet_bearing"]
        found["result"]["planet_bearing"]["roller_azimuth"] = figures["roller_azimuth"]


def balance_floors(frozen: dict[str, Any]) -> dict[str, float]:
    """Rounding of what balances between the members, by pattern."""
    members = frozen.get("result", {}).get("members", {})
    floors = {}
    for kind in ("speed", "torque", "power"):
        largest = max((abs(member[kind]["value"]) for member in members.values()), default=0.0)
        for name in members:
            floors[f"*/members/{name}/{kind}/value"] = BALANCED * largest
            floors[f"*/numbers/{name}_{kind}"] = BALANCED * largest
    for name, array in frozen.items():
        if name.endswith("_torque"):  # of a map or a sweep
            floors[f"*/{name}/values/*"] = BALANCED * float(np.nanmax(np.abs(values(array))))
    return floors


def values(array: dict[str, Any]) -> np.ndarray:
    """Those of a frozen array of numbers."""
    return np.array(array["values"], dtype=float)


def differences(
    frozen: Any, found: Any, place: str, floors: dict[str, float]
) -> Iterator[tuple[str, str]]:
    """Place and text of all that is missing or not the same."""
    if isinstance(frozen, dict) and isinstance(found, dict):
        for key, item in frozen.items():
            if key in found:
                yield from differences(item, found[key], f"{place}/{key}", floors)
            else:
                yield f"{place}/{key}", "is missing"
    elif isinstance(frozen, list) and isinstance(found, list) and len(frozen) == len(found):
        for number, (old, new) in enumerate(zip(frozen, found, strict=True)):
            yield from differences(old, new, f"{place}/{number}", floors)
    elif not same(frozen, found, place, floors):
        yield place, f"{found!r} was {frozen!r}"


def same(frozen: Any, found: Any, place: str, floors: dict[str, float]) -> bool:
    """Two values without parts; NaN was frozen as None."""
    if isinstance(found, float) and math.isnan(found):
        found = None
    if not (is_number(frozen) and is_number(found)):
        return bool(frozen == found)
    if frozen == found:
        return True
    patterns = floors | ROUNDING
    floor = max((size for key, size in patterns.items() if fnmatch(place, key)), default=0.0)
    return math.isclose(frozen, found, rel_tol=TOLERANCE, abs_tol=floor)


def is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
