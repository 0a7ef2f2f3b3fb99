"""Listed sets with sensible dimensions for tests, as tables of cases, their losses computed."""

from __future__ import annotations

import copy
from typing import Any

import asymmetric

__all__ = [
    "double_planet",
    "layshaft",
    "listed_pair",
    "listed_simple",
    "plus",
    "ravigneaux",
    "stepped",
    "train_of_pair",
    "train_of_planetary",
    "wolfrom",
]

Tables = dict[str, Any]

NUMERICS = {
    "mesh_positions": 6,
    "contact_segments": 6,
    "bearing_slices": 5,
    "pocket_slices": 6,
    "pocket_steps": 10,
}
BEARING = {
    "rows": 2,
    "rollers_per_row": 18,
    "roller_diameter": "2.5 mm",
    "roller_length": "9.8 mm",
    "pin_diameter": "16 mm",
    "diametral_clearance": "20 um",
    "roller_roughness": "0.1 um",
    "race_roughness": "0.15 um",
}
CARRIER = {"outer_diameter": "150 mm", "width": "60 mm"}


def gear(teeth: int, shift: float, width: float = 20.0, **keys: Any) -> Tables:
    """A gear; `width` in mm."""
    return {
        "teeth": teeth,
        "face_width": f"{width} mm",
        "profile_shift_coefficient": shift,
        "roughness": "0.4 um",
        **keys,
    }


def train(own: Tables, shafts: dict[str, list[str]], ends: tuple[str, str]) -> Tables:
    """A train of the one listed set S."""
    return {
        "kind": "train",
        "sets": {"S": {"load_sharing": {"method": "equal"}, **own}},
        "shafts": {name: [f"S.{member}" for member in members] for name, members in shafts.items()},
        "operation": {
            "input": ends[0],
            "output": ends[1],
            "torque": "60 N*m",
            "speed": "2000 rpm",
            "oil_inlet_temperature": "70 degC",
        },
        "lubricant": {"oil": "iso-vg-100-mineral"},
        "numerics": NUMERICS,
    }


def rack(module: float, helix: float = 0.0, distance: float | None = None) -> Tables:
    """What gears share, by the transverse module in mm."""
    shared: Tables = {
        "transverse_module": f"{module} mm",
        "normal_pressure_angle": "20 deg",
        "helix_angle": f"{helix} deg",
    }
    return shared if distance is None else shared | {"center_distance": f"{distance} mm"}


def wolfrom() -> Tables:
    """Sun, stepped planet, a ring that stands still and one that turns slowly."""
    gears = rack(2.0, distance=45.0) | {
        "sun": gear(12, 0.35),
        "wide": gear(33, -0.37, body="planet", mass="0.4 kg"),
        "narrow": gear(30, 0.0, 18.0, body="planet"),
        "fixed_ring": gear(78, 0.35),
        "output_ring": gear(75, -0.02, 18.0),
    }
    gears["fixed_ring"]["internal"] = gears["output_ring"]["internal"] = True
    own = {
        "planets": 3,
        "meshes": [["sun", "wide"], ["wide", "fixed_ring"], ["narrow", "output_ring"]],
        "gears": gears,
        "planet_bearing": BEARING,
        "carrier": CARRIER,
    }
    shafts = {"in": ["sun"], "out": ["output_ring"], "housing": ["fixed_ring"]}
    return train(own, shafts, ("in", "out"))


def stepped(ring: tuple[int, int] = (21, 81)) -> Tables:
    """Sun and ring with stepped planets between them, each mesh with its own helix and module.

    `ring`: teeth of the narrow step and of the ring.
    """
    narrow = {"transverse_module": "1.75 mm", "helix_angle": "11 deg"}
    gears = rack(1.5, 16.0) | {
        "sun": gear(20, 0.1),
        "wide": gear(50, -0.12, 19.0, body="planet", mass="0.6 kg"),
        "narrow": gear(ring[0], 0.15, 26.0, body="planet", **narrow),
        "ring": gear(ring[1], -0.17, 27.0, internal=True, rim_thickness="9 mm", **narrow),
    }
    own = {
        "planets": 3,
        "meshes": [["sun", "wide"], ["narrow", "ring"]],
        "mesh": {"sun-wide": {"center_distance": "52.5 mm", "misalignment": "2 um"}},
        "gears": gears,
        "planet_bearings": {"planet": BEARING},
        "carrier": CARRIER,
    }
    return train(own, {"in": ["sun"], "out": ["carrier"], "housing": ["ring"]}, ("in", "out"))


def double_planet() -> Tables:
    """Sun, two planets that mesh with each other, ring."""
    gears = rack(2.0, 12.0) | {
        "sun": gear(30, 0.05),
        "inner": gear(18, -0.07, planet=True, mass="0.2 kg"),
        "outer": gear(17, 0.05, 22.0, planet=True),
        "ring": gear(78, -0.07, 24.0, internal=True),
    }
    own = {
        "planets": 3,
        "meshes": [["sun", "inner"], ["inner", "outer"], ["outer", "ring"]],
        "mesh": {
            "sun-inner": {"center_distance": "48 mm"},
            "outer-inner": {"center_distance": "35 mm"},
            "outer-ring": {"center_distance": "61 mm"},
        },
        "gears": gears,
        "planet_bearing": BEARING | {"pin_diameter": "12 mm", "rollers_per_row": 14},
        "carrier": CARRIER,
    }
    return train(own, {"in": ["sun"], "out": ["carrier"], "housing": ["ring"]}, ("in", "out"))


def ravigneaux(held: str = "large_sun") -> Tables:
    """Two suns, short and long planets, one ring; the long planet works in two planes."""
    gears = rack(1.5, 20.0) | {
        "small_sun": gear(28, 0.1, 24.0),
        "large_sun": gear(38, 0.0, 22.0),
        "short": gear(20, -0.12, 23.0, planet=True),
        "long_front": gear(19, 0.1, 25.0, body="long"),
        "long_rear": gear(19, -0.02, 22.0, body="long"),
        "ring": gear(76, -0.12, 27.0, internal=True),
    }
    own = {
        "planets": 3,
        "meshes": [
            ["small_sun", "short"],
            ["short", "long_front"],
            ["large_sun", "long_rear"],
            ["long_front", "ring"],
        ],
        "mesh": {
            "small_sun-short": {"center_distance": "36 mm"},
            "short-long_front": {"center_distance": "29.25 mm"},
            "large_sun-long_rear": {"center_distance": "42.75 mm"},
        },
        "gears": gears,
        "planet_bearing": BEARING | {"pin_diameter": "10 mm", "rollers_per_row": 12},
        "planet_bearings": {
            "long": BEARING | {"pin_diameter": "11 mm", "rollers_per_row": 13, "rows": 3}
        },
        "carrier": CARRIER,
    }
    return train(own, {"in": ["small_sun"], "out": ["ring"], "housing": [held]}, ("in", "out"))


def plus(planets: int = 2) -> Tables:
    """Two suns of almost the same size with stepped planets between them."""
    gears = rack(1.5, distance=61.5) | {
        "A": gear(40, -0.02),
        "wide": gear(42, 0.0, body="planet"),
        "narrow": gear(41, 0.0, body="planet"),
        "B": gear(41, -0.02),
    }
    own = {
        "planets": planets,
        "meshes": [["A", "wide"], ["narrow", "B"]],
        "gears": gears,
        "planet_bearing": BEARING,
        "carrier": CARRIER,
    }
    return train(own, {"in": ["carrier"], "out": ["A"], "housing": ["B"]}, ("in", "out"))


def layshaft() -> Tables:
    """Two pairs on fixed axes, the second gear of the first and the first of the second together.

    The output stands in line with the input.
    """
    gears = rack(2.0, 18.0, 70.0) | {
        "drive": gear(25, 0.1),
        "lay_wheel": gear(45, -0.12, body="lay"),
        "lay_pinion": gear(20, 0.15, 25.0, body="lay"),
        "driven": gear(50, -0.17, 24.0),
    }
    own = {
        "meshes": [["drive", "lay_wheel"], ["lay_pinion", "driven"]],
        "mesh": {"lay_pinion-driven": {"direction": "180 deg"}},
        "gears": gears,
    }
    return train(own, {"in": ["drive"], "lay": ["lay"], "out": ["driven"]}, ("in", "out"))


# --- one and the same set in two forms ------------------------------------------------------------


def _shared(case: Tables) -> Tables:
    return {key: case[key] for key in ("lubricant", "surroundings", "models", "numerics")}


def _simple() -> Tables:
    case = asymmetric.planetary()
    # a listed gear has the same flanks in all of its meshes, and no thrust bearing
    del case["planet"]["micro_geometry_ring_side"], case["thrust_bearing"]
    return case


def train_of_planetary() -> Tables:
    """A planetary set as a set of a train, its ring driven as well."""
    case = _simple()
    names = (
        "gears",
        "sun",
        "planet",
        "ring",
        "sun_mesh",
        "ring_mesh",
        "planet_bearing",
        "load_sharing",
        "carrier",
    )
    return {
        "kind": "train",
        "sets": {"S": {name: case[name] for name in names}},
        "shafts": {"in": ["S.sun"], "side": ["S.ring"], "out": ["S.carrier"]},
        "operation": _operation(case) | {"speeds": {"side": "-410 rpm"}},
        **_shared(case),
    }


def listed_simple() -> Tables:
    """The same as a listed set."""
    tables = train_of_planetary()
    own = tables["sets"]["S"]
    planet = own.pop("planet")
    count = planet.pop("count")
    ring = own.pop("ring") | {"internal": True}
    tables["sets"]["S"] = {
        "planets": count,
        "meshes": [["sun", "planet"], ["planet", "ring"]],
        "gears": own["gears"] | {"sun": own["sun"], "planet": planet, "ring": ring},
        "mesh": {"sun-planet": own["sun_mesh"], "planet-ring": own["ring_mesh"]},
        **{name: own[name] for name in ("planet_bearing", "load_sharing", "carrier")},
    }
    return tables


def train_of_pair() -> Tables:
    """A pair as a set of a train."""
    case = asymmetric.gear_pair()
    return {
        "kind": "train",
        "sets": {"S": {name: case[name] for name in ("gears", "pinion", "gear", "mesh")}},
        "shafts": {"in": ["S.pinion"], "out": ["S.gear"]},
        "operation": _operation(case),
        **_shared(case),
    }


def listed_pair() -> Tables:
    """The same as a listed set."""
    tables = train_of_pair()
    own = tables["sets"]["S"]
    tables["sets"]["S"] = {
        "meshes": [["pinion", "gear"]],
        "gears": own["gears"] | {"pinion": own["pinion"], "gear": own["gear"]},
        "mesh": {"pinion-gear": own["mesh"]},
    }
    return tables


def _operation(case: Tables) -> Tables:
    kept = ("torque", "speed", "oil_inlet_temperature")
    return {"input": "in", "output": "out"} | {
        key: copy.deepcopy(case["operation"][key]) for key in kept
    }
