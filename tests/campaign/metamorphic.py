"""One thing stated in many ways: random cases of which every other form must give the same result.

Run it from the folder tests:

    python -m campaign.metamorphic 20000 --workers 2 --table ../docs/development/metamorphic.csv

It solves the cases of these numbers, each with one of its other forms, prints how many ended how,
and goes on where it was stopped if a journal is given. Exit code 1: forms differ, or a case ends in
an error that is none of the program. Nine of ten cases are without pockets; loads are uniform.
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import random
import re
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any
from unittest.mock import patch

import epicyclic as ep
from epicyclic.cli.common import parse_changes
from epicyclic.files import write_file
from epicyclic.machine.solve import LOSS_AGREEMENT
from epicyclic.result.result import Result
from epicyclic.show import html
from epicyclic.show.template import case_text
from epicyclic.units import known_text

__all__ = ["FORMS", "drawn", "outcome"]

Tables = dict[str, Any]
ROUNDING = 1e-9
"""The same numbers in another order, or after a conversion: relative."""
AGREEMENT = 2 * LOSS_AGREEMENT
"""Of torques and losses that are solved from the other end, where another iteration ends at the
same tolerance, beside the solution or beyond it: relative."""
FAULTS = ("differs", "refused in one form", "solved in one form", "exception")
ATTEMPTS = 300
STORED = 200
"""One case of so many is stored and read again."""
PICTURES = 10
"""One report of so many has its pictures, which take longer than a hundred cases."""
OTHER_UNITS = {
    "mm": (("in", 1 / 25.4), ("m", 1e-3), ("um", 1e3)),
    "um": (("nm", 1e3), ("mm", 1e-3)),
    "deg": (("rad", math.pi / 180),),
    "rpm": (("rad/s", math.pi / 30), ("deg/s", 6.0)),
    "N*m": (("kN*m", 1e-3), ("lbf*in", 1 / 0.1129848290276167)),
    "bar": (("Pa", 1e5), ("kPa", 100.0)),
    "mm^2/s": (("m^2/s", 1e-6),),
    "kg/m^3": (("g/cm^3", 1e-3),),
}
"""Units of the drawn cases, others, and what a number is multiplied by."""
FRICTION = ("schlenk", "niemann-winter", "benedict-kelley", "xu-2007", "doleschel", "mixed-ehl")


def drawn(number: int) -> ep.GearPairCase | ep.PlanetaryCase:
    """The case of a number, a pair or a planetary set whose numbers all differ."""
    rng = random.Random(f"metamorphic {number}")
    for _ in range(ATTEMPTS):
        tables = rng.choice((_pair, _planetary))(rng)
        try:
            return ep.load_case(tables)
        except ep.InputError:
            continue
    raise RuntimeError(f"no valid case among {ATTEMPTS}")


def _number(rng: random.Random, low: float, high: float) -> float:
    return float(f"{rng.uniform(low, high):.5g}")


def _shared(rng: random.Random, module: float, helix: float, distance: float) -> Tables:
    sign = rng.choice((1, 1, -1))
    torque = rng.choice((0.0, *[_number(rng, 1, 60 * module**2)] * 6, 10 ** rng.uniform(-6, 0)))
    models = {
        "friction": rng.choice(FRICTION),
        "load_distribution": rng.choice(("uniform", "uniform", "minimum-energy")),
        "pocketing": "incompressible",
    }
    return {
        "operation": {
            "torque": f"{sign * torque!r} N*m",
            "speed": f"{rng.choice((1, -1)) * _number(rng, 20, 9000)!r} rpm",
            "oil_inlet_temperature": f"{_number(rng, 20, 110)!r} degC",
        },
        "gears": {
            "normal_module": f"{module!r} mm",
            "normal_pressure_angle": f"{_number(rng, 19, 24)!r} deg",
            "helix_angle": f"{helix!r} deg",
            "center_distance": f"{distance!r} mm",
        },
        "lubricant": {
            "oil": {
                "name": "drawn",
                "kind": rng.choice(("mineral", "pao", "ester")),
                "kinematic_viscosity": [
                    {"temperature": "40 degC", "value": f"{_number(rng, 25, 320)!r} mm^2/s"},
                    {"temperature": "100 degC", "value": f"{_number(rng, 5, 24)!r} mm^2/s"},
                ],
                "density": [
                    {"temperature": "15 degC", "value": f"{_number(rng, 820, 960)!r} kg/m^3"}
                ],
                "pressure_viscosity": {
                    "law": "gold",
                    "s": _number(rng, 6, 10),
                    "t": _number(rng, 0.12, 0.15),
                },
            }
        },
        "surroundings": {
            "oil_air_ratio": _number(rng, 0, 0.3),
            "pressure": f"{_number(rng, 0.8, 1.6)!r} bar",
        },
        "models": models,
        "numerics": {
            "mesh_positions": 6, "contact_segments": 5, "bearing_slices": 5, "pocket_slices": 6,
            "pocket_steps": 10,
        },
    }  # fmt: skip


def _gear(rng: random.Random, teeth: int, module: float, width: float) -> Tables:
    table: Tables = {
        "teeth": teeth,
        "face_width": f"{width * _number(rng, 0.9, 1.1)!r} mm",
        "roughness": f"{_number(rng, 0.1, 1.2)!r} um",
    }
    if rng.random() < 0.3:
        table["micro_geometry"] = {
            "lead_slope": f"{_number(rng, -3, 3)!r} um",
            "tip_relief": f"{_number(rng, 1, 6)!r} um",
            "tip_relief_roll_length": f"{_number(rng, 0.2, 0.5) * module!r} mm",
        }
    return table


def _geometry(rng: random.Random) -> tuple[float, float, float]:
    module = _number(rng, 1.2, 6)
    return module, rng.choice((0.0, _number(rng, 8, 26))), _number(rng, 6, 14) * module


def _pair(rng: random.Random) -> Tables:
    module, helix, width = _geometry(rng)
    one, two = rng.randint(15, 40), rng.randint(16, 90)
    nominal = module * (one + two) / 2 / math.cos(math.radians(helix))
    tables = _shared(rng, module, helix, nominal * _number(rng, 0.999, 1.02))
    pinion, gear = (_gear(rng, teeth, module, width) for teeth in (one, two))
    pinion["profile_shift_coefficient"] = _number(rng, -0.1, 0.4)
    tables |= {"kind": "gear_pair", "pinion": pinion, "gear": gear}
    tables["mesh"] = {"normal_backlash": f"{_number(rng, 30, 150)!r} um"}
    tables["mesh"]["misalignment"] = f"{rng.choice((0.0, _number(rng, 1, 6)))!r} um"
    tables["losses"] = {"mesh_pocketing": {"include": rng.random() < 0.1}}
    return tables


def _planetary(rng: random.Random) -> Tables:
    module, helix, width = _geometry(rng)
    count = rng.choice((3, 4, 5))
    sun, planet = rng.randint(18, 45), rng.randint(16, 40)
    ring = sun + 2 * planet
    ring += -(sun + ring) % count
    nominal = module * (sun + planet) / 2 / math.cos(math.radians(helix))
    tables = _shared(rng, module, helix, nominal * _number(rng, 0.999, 1.01))
    tables |= {"kind": "planetary"}
    for name, teeth in (("sun", sun), ("planet", planet), ("ring", ring)):
        tables[name] = _gear(rng, teeth, module, width)
    tables["sun"]["profile_shift_coefficient"] = _number(rng, 0, 0.3)
    tables["planet"]["count"] = count
    driven, fixed = rng.sample(("sun", "ring", "carrier"), 2)
    tables["operation"] |= {"input": driven, "fixed": fixed}
    for mesh in ("sun_mesh", "ring_mesh"):
        tables[mesh] = {"normal_backlash": f"{_number(rng, 30, 150)!r} um"}
    pockets = rng.random() < 0.1
    tables["losses"] = {f"{mesh}_mesh_pocketing": {"include": pockets} for mesh in ("sun", "ring")}
    return tables


Form = Callable[[Any, Result, random.Random], tuple[Any, dict[str, str], float] | None]
"""Of a case and its result another form of it, the loss that each of its losses is by name where it
has another one, and the relative tolerance; None if it has no such form."""


def other_units(case: Any, result: Result, rng: random.Random) -> Any:
    """Every value in another unit."""

    def changed(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: changed(it) for key, it in value.items()}
        if isinstance(value, list | tuple):
            return [changed(it) for it in value]
        match = re.fullmatch(r"(\S+) (\S+)", value) if isinstance(value, str) else None
        if match is None:
            return value
        if match[2] == "degC":
            return f"{float(match[1]) + 273.15!r} K"
        if match[2] not in OTHER_UNITS:
            return value
        unit, factor = rng.choice(OTHER_UNITS[match[2]])
        return f"{float(match[1]) * factor!r} {unit}"

    return ep.load_case(changed(case.given())), {}, ROUNDING


def mirrored(case: Any, result: Result, rng: random.Random) -> Any:
    """All turns the other way round."""
    changes = {}
    for key in ("torque", "speed"):
        number, unit = case.given()["operation"][key].split()
        changes[f"operation.{key}"] = f"{-float(number)!r} {unit}"
    return case.updated(changes), {}, ROUNDING


def exchanged(case: Any, result: Result, rng: random.Random) -> Any:
    """The gears of a pair named the other way round, stated at the same end of the power."""
    if case.kind != "gear_pair":
        return None
    tables = case.given()
    tables["pinion"], tables["gear"] = tables["gear"], tables["pinion"]
    tables["operation"] |= _end(result, "gear", turned=-1)
    return ep.load_case(tables), {}, AGREEMENT


def other_end(case: Any, result: Result, rng: random.Random) -> Any:
    """A planetary set stated at the end where it was solved."""
    if case.kind != "planetary":
        return None
    operation = case.given()["operation"]
    ends = {"sun", "ring", "carrier"} - {operation["input"], operation["fixed"]}
    (end,) = ends
    changes = {f"operation.{key}": it for key, it in _end(result, end).items()}
    return case.updated(changes | {"operation.input": end}), {}, AGREEMENT


def _end(result: Result, member: str, turned: int = 1) -> Tables:
    state = result.flow.members[member]
    return {"torque": f"{turned * state.torque!r} N*m", "speed": f"{turned * state.speed!r} rad/s"}


def in_a_train(case: Any, result: Result, rng: random.Random) -> Any:
    """The only set of a train, as it is or as a list of gears and meshes."""
    tables = case.given()
    operation, kind = tables.pop("operation"), tables.pop("kind")
    shared = ("lubricant", "surroundings", "models", "numerics")
    train: Tables = {key: tables.pop(key) for key in shared} | {"kind": "train"}
    own, names = tables, {name: f"S.{name}" for name in result.losses}
    kept = {key: operation[key] for key in ("torque", "speed", "oil_inlet_temperature")}
    if kind == "gear_pair":
        train["shafts"] = {"in": ["S.pinion"], "out": ["S.gear"]}
    else:
        third = {"sun", "ring", "carrier"} - {operation["input"], operation["fixed"]}
        train["shafts"] = {
            "in": [f"S.{operation['input']}"],
            "out": [f"S.{third.pop()}"],
            "housing": [f"S.{operation['fixed']}"],
        }
    if kind == "gear_pair" and rng.random() < 0.5:
        own = {
            "meshes": [["pinion", "gear"]],
            "gears": own["gears"] | {"pinion": own["pinion"], "gear": own["gear"]},
            "mesh": {"pinion-gear": own["mesh"]},
            "losses": {"pinion_gear_mesh_pocketing": own["losses"]["mesh_pocketing"]},
        }
        names = {name: f"S.pinion_gear_{name}" for name in result.losses}
    train["sets"] = {"S": own}
    train["operation"] = kept | {"input": "in", "output": "out"}
    return ep.load_case(train), names, ROUNDING


def reordered(case: Any, result: Result, rng: random.Random) -> Any:
    """Tables and keys in another order."""

    def shuffled(value: Any) -> Any:
        if not isinstance(value, dict):
            return value
        names = list(value)
        rng.shuffle(names)
        return {name: shuffled(value[name]) for name in names}

    return ep.load_case(shuffled(case.given())), {}, 0.0


def by_set(case: Any, result: Result, rng: random.Random) -> Any:
    """From a file of another operating point, by --set and from Python."""
    given = case.given()
    keys = {key: given["operation"][key] for key in ("torque", "speed")}
    other = case.updated({"operation.torque": "1.5 N*m", "operation.speed": "37 rpm"})
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "case.toml"
        file.write_text(case_text(other.given(), [], {}), encoding="utf-8")
        options = [f"operation.{key}={text}" for key, text in keys.items()]
        found = ep.load_case(file, parse_changes(options))
    assert found == other.updated({f"operation.{key}": it for key, it in keys.items()})
    return found, {}, 0.0


def stored(case: Any, result: Result, rng: random.Random) -> Any:
    """Nothing else to solve: JSON, NetCDF and report hold the same total."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "result.nc"
        ep.save_result(ep.record(case, result=result), file)
        kept = ep.open_result(file)
        assert kept.result.to_dict()["losses"] == result.to_dict()["losses"]
        assert json.loads(json.dumps(result.to_dict()))["total"] == kept.result.total
        drawn_ones = {} if rng.randrange(PICTURES) == 0 else {"return_value": ()}
        with patch.object(html, "available", wraps=html.available, **drawn_ones):
            assert known_text(result.total, unit="W").split()[0] in html.report_html(kept)
    return case, {}, 0.0


FORMS: tuple[Form, ...] = (
    other_units, mirrored, exchanged, other_end, in_a_train, reordered, by_set, stored,
)  # fmt: skip


def outcome(number: int) -> tuple[str, str, str]:
    """How the case of a number and one of its other forms end: form, outcome, detail."""
    rng = random.Random(f"form of {number}")
    case = drawn(number)
    form = rng.choice([it for it in FORMS[:-1] if it not in _none_of(case)])
    form = FORMS[-1] if number % STORED == 0 else form  # takes a hundred times as long
    try:
        return (form.__name__, *_compared(case, form, rng))
    except Exception as error:  # any other is a fault
        return form.__name__, "exception", f"{type(error).__name__}: {error}"


def _none_of(case: Any) -> tuple[Form, ...]:
    return (exchanged,) if case.kind == "planetary" else (other_end,)


def _compared(case: Any, form: Form, rng: random.Random) -> tuple[str, str]:
    try:
        result = ep.solve(case)
    except ep.ConvergenceError as error:
        result, reason = None, str(error)
    if result is None:
        if form in (exchanged, other_end, in_a_train, stored):
            return "no solution", ""
        found = form(case, result, rng)
        try:
            ep.solve(found[0])
        except ep.ConvergenceError:
            return "no solution", ""
        return "solved in one form", reason
    try:
        found = form(case, result, rng)
    except ep.InputError as error:
        return "refused in one form", str(error)
    if found is None:
        return "no such form", ""
    other, names, tolerance = found
    try:
        again = ep.solve(other)
    except ep.ConvergenceError as error:
        return ("two balances", "") if _floats(result) else ("solved in one form", str(error))
    scale = abs(result.total)
    pairs = [("total", result.total, again.total)] + [
        (name, watts, again.losses[names.get(name, name)])
        for name, watts in result.losses.items()
        if names.get(name, name) in again.losses
    ]
    off = [(abs(one - two) / scale, name) for name, one, two in pairs if scale]
    worst = max(off, default=(0.0, ""))
    if worst[0] <= tolerance:
        return "same", f"{worst[0]:.1e}"
    if _floats(result) or _floats(again):
        return "two balances, told in a note", ""
    return "differs", f"{worst[1]} by {worst[0]:.1e} of {scale:.6g} W"


def _floats(result: Result) -> bool:
    """Whether a note says that teeth next to no load may lie on either flank."""
    return any("float within their backlash" in it or "either flank" in it for it in result.notes)


def _numbers(journal: Path | None) -> dict[int, tuple[str, str, str]]:
    if journal is None or not journal.exists():
        return {}
    lines = [
        line for line in journal.read_text(encoding="utf-8").splitlines() if line.endswith("]")
    ]
    return {int(it[0]): (it[1], it[2], it[3]) for it in map(json.loads, lines)}


def rows(found: dict[int, tuple[str, str, str]]) -> Iterator[list[str]]:
    """A table: outcomes by form."""
    counts = Counter((form, name) for form, name, _ in found.values())
    forms = [form.__name__ for form in FORMS]
    names = sorted({name for _, name in counts} | set(FAULTS), key=lambda it: (it in FAULTS, it))
    yield ["outcome", "all", *(form.replace("_", " ") for form in forms)]
    for name in names:
        numbers = [counts[form, name] for form in forms]
        yield [name, *map(str, (sum(numbers), *numbers))]
    sums = [sum(counts[form, name] for name in names) for form in forms]
    yield ["all", *map(str, (sum(sums), *sums))]


def main() -> None:
    """Solve, print, write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("count", type=int)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--journal", type=Path)
    parser.add_argument("--table", type=Path)
    parser.add_argument("--seconds", type=float, default=math.inf)
    asked = parser.parse_args()
    found = _numbers(asked.journal)
    if asked.journal is not None:  # without a line that a kill has cut
        kept = (json.dumps([number, *ended]) + "\n" for number, ended in found.items())
        write_file(asked.journal, "".join(kept))
    left = [it for it in range(asked.first, asked.first + asked.count) if it not in found]
    end = time.monotonic() + asked.seconds
    with ProcessPoolExecutor(
        asked.workers, initializer=warnings.simplefilter, initargs=("error",)
    ) as pool:
        for start in range(0, len(left), 20 * asked.workers):
            if time.monotonic() > end:
                break
            block = left[start : start + 20 * asked.workers]
            for number, ended in zip(block, pool.map(outcome, block), strict=True):
                found[number] = ended
                if asked.journal is not None:
                    with asked.journal.open("a", encoding="utf-8") as file:
                        file.write(json.dumps([number, *ended]) + "\n")
    csv.writer(sys.stdout).writerows(rows(found))
    for number, (form, name, detail) in sorted(found.items()):
        if name in FAULTS:
            print(f"{number} {form}: {name}: {detail}")
    if asked.table is not None:
        with asked.table.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(rows(found))
    sys.exit(any(name in FAULTS for _, name, _ in found.values()))


if __name__ == "__main__":
    main()
