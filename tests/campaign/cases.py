"""Random valid cases over the whole schema: planetary sets, pairs and trains, each by its number.

A case is a point of a design: designs differ in kind, geometry, models and oil, the points of a
design in speed, torque, temperature, share of oil and pressure. Points share the flows through
pockets where they may, so that many of them are solved soon.

Sets and pairs are those of the frozen results, with operating points, oils and models over all that
is documented. Trains are listed sets with their losses computed, sets and pairs inside a train, and
trains of given efficiencies.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import Any

import epicyclic as ep
import listed_trains
from epicyclic import library
from epicyclic.case.case import Case
from frozen import drawn_cases
from property.test_random_trains import random_train

__all__ = ["POINTS", "drawn_case", "drawn_design", "is_whole"]

Tables = dict[str, Any]
ATTEMPTS = 10_000
POINTS = 10
"""Of each design."""
WHOLE = 10
"""One design of so many has the default resolution."""
TORQUES = 2
"""Other torques at each state of speed, temperature and air around the gears."""

KINDS = ("planetary", "planetary", "gear_pair", "gear_pair", "listed", "train")
"""Each drawn as often as it is written here."""
COARSE = {"pocket_slices": 8, "pocket_steps": 12}
POCKETING = ("auto", "incompressible", "isentropic", "mean-density", "talbot-2012")
FRICTION = (
    "auto", "mixed-ehl", "mixed-ehl+pairing", "schlenk", "niemann-winter", "benedict-kelley",
    "matsumoto", "doleschel", "xu-2007", "constant", "fitted", "fitted-or-schlenk",
)  # fmt: skip
ROLLING = (
    "auto", "mixed-ehl", "mixed-ehl+pairing", "goksem-hargreaves", "fitted",
    "fitted-or-goksem-hargreaves",
)  # fmt: skip
BEARING = ("auto", "mixed-ehl", "palmgren", "fitted", "fitted-or-palmgren")
OWN: dict[str, tuple[Any, ...]] = {
    "planetary": (drawn_cases.OF_PLANETARY, drawn_cases.draw_planetary, drawn_cases.settled),
    "gear_pair": (drawn_cases.OF_PAIRS, drawn_cases.draw_pair, dict),
}
"""Options of sets and of pairs, what draws them, and what takes out options that exclude others."""
LISTED: tuple[Callable[[], Tables], ...] = (
    listed_trains.wolfrom, listed_trains.stepped, listed_trains.double_planet,
    listed_trains.ravigneaux, listed_trains.plus, listed_trains.layshaft,
    listed_trains.listed_simple, listed_trains.listed_pair, listed_trains.train_of_planetary,
    listed_trains.train_of_pair,
)  # fmt: skip


def drawn_case(number: int) -> Case:
    """The case of a number: of its design the point that its last digit names."""
    design, point = divmod(number, POINTS)
    return _points(design)[point]


def is_whole(number: int) -> bool:
    """Whether a case has the default resolution and all its losses."""
    return number // POINTS % WHOLE == WHOLE - 1


def drawn_design(number: int, *, whole: bool = False) -> Case:
    """A design at a point of its own; in the default resolution with all its losses if `whole`."""
    rng = random.Random(number)
    for _ in range(ATTEMPTS):
        tables = _drawn(rng)
        if whole:
            tables.pop("numerics", None)
            tables.pop("losses", None)
        try:
            return ep.load_case(tables)
        except (ep.InputError, ValueError):
            continue
    raise RuntimeError(f"no valid case among {ATTEMPTS}")


@lru_cache(maxsize=1)
def _points(design: int) -> tuple[Case, ...]:
    """The design at all its points: a few states, each with several torques."""
    rng = random.Random(f"points of {design}")
    case = drawn_design(design, whole=is_whole(design * POINTS))
    found = [case]
    for changes in _changes(case, rng):
        if len(found) == POINTS:
            break
        try:
            found.append(case.updated(changes))
        except ep.InputError:
            continue
    return tuple(found)


def _changes(case: Case, rng: random.Random) -> Iterator[Tables]:
    """What points of a design change, without end: points with one state follow each other."""
    given = case.given()
    operation = given["operation"]
    torque, speed = (abs(drawn_cases.value(operation[key])) for key in ("torque", "speed"))
    has_oil = "lubricant" in given
    yield {"operation.torque": "0 N*m"}
    yield {"operation.speed": "0 rpm"}
    while True:
        state: Tables = {"operation.speed": _point(rng, torque, speed or 1500.0)["speed"]}
        if has_oil:
            state["operation.oil_inlet_temperature"] = _temperature(rng)
            state |= {f"surroundings.{key}": each for key, each in _surroundings(rng).items()}
        yield state
        for _ in range(TORQUES):
            yield state | {"operation.torque": _point(rng, torque or 50.0, speed)["torque"]}


def _drawn(rng: random.Random) -> Tables:
    """The tables of a case, which may or may not be possible."""
    kind = rng.choice(KINDS)
    if kind == "train":
        return random_train(rng.randrange(2**32))
    if kind == "listed":
        tables = rng.choice(LISTED)()
        tables["operation"] |= _point(rng, 200.0, 3000.0)
        tables["operation"]["oil_inlet_temperature"] = _temperature(rng)
        tables["lubricant"] = {"oil": rng.choice(library.names("oils"))}
        tables["surroundings"] = _surroundings(rng)
        tables["numerics"] = listed_trains.NUMERICS
        tables["models"] = _models(rng, tables.get("models", {}))
        return tables
    own, draw, settled = OWN[kind]
    options = {name: rng.choice(each) for name, each in (drawn_cases.COMMON | own).items()}
    tables = draw("drawn", settled(options), rng)
    operation = tables["operation"]
    torque, speed = (abs(drawn_cases.value(operation[key])) for key in ("torque", "speed"))
    operation |= _point(rng, torque or 50.0, speed or 1500.0)
    operation["oil_inlet_temperature"] = _temperature(rng)
    tables["models"] = _models(rng, tables.get("models", {}), planetary=kind == "planetary")
    tables["numerics"] = COARSE | tables.get("numerics", {})
    if tables["models"].get("friction") != "table":
        tables.pop("friction_table", None)
    if rng.random() < 0.7:
        tables.pop("losses", None)
    if rng.random() < 0.6:
        tables["surroundings"] = _surroundings(rng)
    if rng.random() < 0.2:
        tables["lubrication"] = _lubrication(rng)
    if rng.random() < 0.2:
        _warm(tables, rng)
    return tables


def _point(rng: random.Random, torque: float, speed: float) -> Tables:
    """An operating point around usual ones: both signs, down to zero, up to overload and racing."""
    return {
        "torque": f"{_around(rng, torque, 1e-9, 5.0)!r} N*m",
        "speed": f"{min(max(_around(rng, speed, 1e-6, 10.0), -3e4), 3e4)!r} rpm",
    }


def _around(rng: random.Random, usual: float, low: float, high: float) -> float:
    sign = rng.choice([-1, 1])
    return rng.choice(
        [
            sign * usual,
            sign * usual * rng.uniform(0.3, 1.5),
            sign * usual * low ** rng.random(),
            sign * usual * high ** rng.random(),
            0.0,
        ]
    )


def _temperature(rng: random.Random) -> str:
    return f"{rng.choice([rng.uniform(-40, 160), rng.uniform(20, 110)])!r} degC"


def _surroundings(rng: random.Random) -> Tables:
    """Shares of oil from air to oil without air, pressures from thin air to a pressurised box."""
    trace = 10 ** rng.uniform(-6, 0)
    share = rng.choice([0.0, 1.0, 0.05, rng.random(), trace, 1 - trace])
    pressure = rng.choice([1.01325, 10 ** rng.uniform(-0.5, 0.7)])
    return {"oil_air_ratio": share, "pressure": f"{pressure!r} bar"}


def _models(rng: random.Random, drawn: Tables, *, planetary: bool = False) -> Tables:
    """Models over those that are drawn already."""
    tables = dict(drawn)
    tables["pocketing"] = rng.choice(POCKETING)
    if rng.random() < 0.7:
        tables["friction"] = rng.choice(FRICTION)
        tables["rolling"] = rng.choice(ROLLING)
    if planetary and rng.random() < 0.5:
        tables["bearing"] = rng.choice(BEARING)
    if rng.random() < 0.15:
        tables["mesh_loads"] = "without-losses"
    if rng.random() < 0.1:
        tables["load_dependent"] = "as-tested"
    if rng.random() < 0.2:
        tables["oil_beyond_range"] = "extrapolated"
    if tables["pocketing"] == "incompressible":
        tables["pocket_void_pressure"] = rng.choice(["0 bar", "0.01 bar", "0.1 bar"])
    if tables.get("friction") != "constant":
        tables.pop("constant_friction", None)
    if tables.get("friction") not in ("matsumoto", "doleschel"):
        tables.pop("boundary_friction", None)
        tables.pop("fluid_friction", None)
    return tables


def _lubrication(rng: random.Random) -> Tables:
    method = rng.choice(["jet", "spray", "flow", "drained", "dip", "submerged"])
    tables: Tables = {"method": method}
    if method in ("jet", "spray", "flow"):
        tables["oil_flow"] = f"{rng.uniform(0.05, 20)!r} l/min"
    if method == "jet":
        tables["jet_speed"] = f"{rng.uniform(0, 40)!r} m/s"
        tables["nozzle_side"] = rng.choice(["in-mesh", "out-of-mesh", "radial"])
    if method == "dip":
        tables["oil_level"] = f"{rng.uniform(-80, 5)!r} mm"
        tables["oil_volume"] = f"{rng.uniform(0.3, 8)!r} l"
        tables["churning"] = rng.choice(["changenet-velex", "iso-14179-1"])
    return tables


def _warm(tables: Tables, rng: random.Random) -> None:
    """Temperatures that follow from the losses."""
    tables["models"]["temperatures"] = rng.choice(["flank", "network"])
    thermal: Tables = {"lubrication": rng.choice(["spray", "dip", "spray-and-dip", "submerged"])}
    if tables["models"]["temperatures"] == "flank":
        thermal["bulk"] = rng.choice(["iso-6336-20", "iso-6336-22"])
    else:
        thermal |= {
            "oil_flow": f"{rng.uniform(0.5, 30)!r} l/min",
            "ambient_temperature": f"{rng.uniform(-30, 45)!r} degC",
            "housing": {"area": f"{rng.uniform(0.05, 2)!r} m^2"},
        }
    tables["thermal"] = thermal
