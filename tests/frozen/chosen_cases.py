"""Cases of the frozen results that are chosen by hand: tables of built-in cases and of tests.

Each has a name, a case that it starts from and what is changed in it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import asymmetric
import listed_trains
from trains import SMALL

__all__ = ["BANDS", "BUILT_IN", "chosen_cases"]

Tables = dict[str, Any]

BUILT_IN = (
    "talbot-2012", "talbot-2012-pair", "train-8hp70", "train-eaxle",
    "talbot-2012-n3-40C", "talbot-2012-n4-60C", "talbot-2012-n5-polished", "talbot-2012-n6",
    "talbot-2012-n4-polished-40C", "talbot-2012-n5-shaved-90C", "talbot-2012-n6-polished-60C",
)  # fmt: skip
"""As they are, in their full resolution."""

COARSE = {"numerics.pocket_slices": 6, "numerics.pocket_steps": 10}
COARSER = COARSE | {"numerics.mesh_positions": 6, "numerics.contact_segments": 6}
NO_POCKETS = {
    "losses.sun_mesh_pocketing.include": False,
    "losses.ring_mesh_pocketing.include": False,
}
SET = COARSER | {"models.planet_tilt": "left-out", "models.pocketing": "incompressible"}
PAIR = COARSER | {"models.pocketing": "incompressible"}
WARM = {
    "models.temperatures": "network",
    "thermal.oil_flow": "2.3 l/min",
    "thermal.housing.area": "0.31 m^2",
    "thermal.cooler_power": "37 W",
}

CORNERS: dict[str, tuple[str, Tables]] = {
    "lock-up": ("talbot-2012", {
        "operation.fixed": None, "operation.second_input": "carrier",
        "operation.second_speed": "4000 rpm"}),
    "nearly lock-up": ("talbot-2012", {
        "operation.fixed": None, "operation.second_input": "carrier",
        "operation.second_speed": "3999.99 rpm"}),
    "crawling": ("talbot-2012", {"operation.speed": "-0.002 rpm"}),
    "at rest under load": ("talbot-2012", {"operation.speed": "0 rpm"}),
    "one planet has all": ("talbot-2012", {
        "load_sharing.method": "mesh-load-factor", "load_sharing.mesh_load_factor": 3.0}),
    "no oil in the air": ("talbot-2012", {"surroundings.oil_air_ratio": 0.0}),
    "no air in the oil": ("talbot-2012-pair", {"surroundings.oil_air_ratio": 1.0}),
    "stiff oil": ("talbot-2012", {
        "lubricant.oil": "iso-vg-680-mineral", "operation.oil_inlet_temperature": "-30 degC"}),
    "overload": ("talbot-2012-pair", {"operation.torque": "4000 N*m"}),
    "hardly a load": ("talbot-2012-pair", {"operation.torque": "-0.0003 N*m"}),
    "racing": ("talbot-2012-pair", {
        "operation.speed": "30000 rpm", "models.pocketing": "central-differences"}),
}  # fmt: skip
"""Operating points at the ends of what can be computed."""

WAYS_OF_OIL: dict[str, Tables] = {
    "jet": {"oil_flow": "2.3 l/min", "jet_speed": "11 m/s"},
    "spray": {},
    "flow": {"oil_flow": "1.7 l/min"},
    "drained": {"oil_share_factor": 0.9},
    "dip": {"oil_level": "-21 mm", "oil_volume": "1.9 l"},
    "submerged": {"oil_share": 0.83},
}
OF_SETS: dict[str, Tables] = {
    "flank temperatures": {"models.temperatures": "flank", "thermal.bulk": "iso-6336-20"},
    "network of temperatures": WARM,
    "pairing": {"models.friction": "mixed-ehl+pairing", "models.rolling": "mixed-ehl+pairing"},
    "fitted to an oil": {"lubricant.oil": "iso-vg-220-mineral", **dict.fromkeys(
        ("models.friction", "models.rolling"), "auto")},
    "fitted alone": {"lubricant.oil": "iso-vg-100-pao", **dict.fromkeys(
        ("models.friction", "models.rolling"), "fitted")},
    "beyond the oil's range": {
        "models.oil_beyond_range": "extrapolated", "operation.oil_inlet_temperature": "141 degC"},
    "loads without losses": {"models.mesh_loads": "without-losses"},
    "losses as tested": {"models.load_dependent": "as-tested"},
    "flow as published": {"models.pocketing": "talbot-2012"},
    "void pressure": {"models.pocket_void_pressure": "0.1 bar"},
}  # fmt: skip
"""Of planetary sets and pairs alike."""
OF_PLANETARY: dict[str, Tables] = {
    "fitted bearing": {"lubricant.oil": "iso-vg-320-pao", "models.bearing": "fitted"},
    "measured teeth": {
        "sun.profile_shift_coefficient": None,
        "sun.span_measurement": "29.001 mm",
        "sun.teeth_in_span": 5,
    },
    "backlash": {
        "sun.profile_shift_coefficient": None, "ring.profile_shift_coefficient": None,
        "sun_mesh.normal_backlash": "61 um", "ring_mesh.normal_backlash": "83 um"},
    "classes of accuracy": {"sun.accuracy_class": 6, "planet.accuracy_class": 7},
}  # fmt: skip
OF_AXLE: dict[str, Tables] = {
    "backwards": {"operation.torque": "-131 N*m"},
    "at rest": {"operation.speed": "0 rpm"},
    "network of temperatures": WARM,
    "flanks by methods of oil": {
        "models.temperatures": "flank", "lubrication.method": "spray",
        "sets.planets.lubrication.method": "submerged"},
    "jets and a bath": WARM | {
        "lubrication.method": "jet", "lubrication.oil_flow": "1.3 l/min",
        "thermal.oil_flow": None, "sets.planets.lubrication.method": "submerged"},
    "another formula of seals": {
        "seals.motor_seal.model": "linke", "seals.output_seal.model": "iso-14179-1-viton"},
    "table of a seal": {
        "seals.motor_seal.model": "table",
        "seals.motor_seal.table": {
            "speed": ["0 rpm", "9800 rpm"], "torque": ["0.31 N*m", "0.17 N*m"]}},
    "pump and brake": {
        "drags.pump": {"between": ["motor", "housing"], "speed": ["0 rpm", "12000 rpm"],
                       "power": ["0 W", "410 W"]},
        "drags.brake": {"between": ["middle", "housing"], "speed": ["0 rpm", "1000 rpm"],
                        "temperature": ["40 degC", "90 degC"],
                        "torque": [["1 N*m", "0.5 N*m"], ["3 N*m", "1.5 N*m"]]}},
    "bearings of other kinds": {
        "bearings.motor_front.model": "harris", "bearings.middle_rear.model": "skf-2018",
        "bearings.middle_rear.series": "2", "bearings.middle_rear.static_load_rating": "81 kN",
        "bearings.output_rear.type": "tapered", "bearings.output_rear.contact_angle": "14 deg",
        "bearings.motor_rear.cage": "full-complement"},
    "table of a bearing": {
        "bearings.motor_rear.model": "table",
        "bearings.motor_rear.table": {
            "radial_force": ["0 N", "4000 N"], "speed": ["0 rpm", "9500 rpm"],
            "torque": [["0.1 N*m", "0.2 N*m"], ["0.3 N*m", "0.5 N*m"]]}},
    "set of given efficiency": {"sets.pair": {
        "gears": {"pinion": {"teeth": 27}, "gear": {"teeth": 57}}, "meshes": [["pinion", "gear"]],
        "mesh_efficiency": 0.99}, **{f"bearings.{name}": None for name in (
            "motor_front", "motor_rear", "middle_front", "middle_rear")}},
}  # fmt: skip
OF_LISTED: dict[str, Callable[[], Tables]] = {
    **{name: getattr(listed_trains, name) for name in listed_trains.__all__},
    "stepped with an odd planet": lambda: listed_trains.stepped((22, 82)),
    "ravigneaux with the ring driven": lambda: listed_trains.ravigneaux("carrier"),
    "plus with three planets": lambda: listed_trains.plus(3),
}
ON_LISTED: dict[str, Tables] = {
    "coasting": {"operation.torque": "-43 N*m"},
    "network of temperatures": WARM,
    "lubricated": {"lubrication": {"method": "dip", "oil_level": "-7 mm", "oil_volume": "2.1 l"}},
    "models": {"models.friction": "niemann-winter", "models.pocketing": "isentropic"},
}
"""What is changed of each listed set in turn: in one the first, in the next the second."""
STATES = ("1", "4", "6", "8", "R")
"""Of the built-in gearbox."""

BANDS = {
    "talbot-2012-pair": ("talbot-2012-pair", {}),
    "planetary set": ("asymmetric planetary", SET | NO_POCKETS),
    "gear pair with its own uncertainty": ("asymmetric pair", PAIR | {
        "uncertainty": {
            "operation.torque": {"normal": "2 N*m"},
            "pinion.roughness": {"lognormal_factor": 1.3},
            "operation.oil_inlet_temperature": {"uniform": ["69 degC", "77 degC"]},
        }}),
    "listed set": ("stepped", {}),
    "small axle": ("train-eaxle", SMALL),
}  # fmt: skip
"""Cases of which the bands are frozen too."""


def start_of(base: str) -> str | Tables:
    """A built-in case, the tables of an asymmetric one, or those of a listed set."""
    if base in OF_LISTED:
        return OF_LISTED[base]()
    own = {"asymmetric planetary": asymmetric.planetary, "asymmetric pair": asymmetric.gear_pair}
    return own[base]() if base in own else base


def chosen_cases() -> Iterator[tuple[str, str | Tables, Tables]]:
    """Names, what they start from, and what is changed in that."""
    for name, (base, changes) in CORNERS.items():
        yield name, base, COARSE | changes
    for base, coarse in (("asymmetric planetary", SET), ("asymmetric pair", PAIR)):
        yield base, start_of(base), {}
        for method, keys in WAYS_OF_OIL.items():
            table = {"method": method} | keys
            changes = {"surroundings.oil_air_ratio": None, "lubrication": table}
            yield f"{base}: {method}", start_of(base), coarse | changes
        for name, changes in OF_SETS.items():
            yield f"{base}: {name}", start_of(base), coarse | changes
    for name, changes in OF_PLANETARY.items():
        yield f"asymmetric planetary: {name}", start_of("asymmetric planetary"), SET | changes
    for name, changes in OF_AXLE.items():
        yield f"train-eaxle: {name}", "train-eaxle", COARSER | SMALL | changes
    for state in STATES:
        yield f"train-8hp70: {state}", "train-8hp70", {"operation.state": state}
    kinds = list(ON_LISTED)
    for number, base in enumerate(OF_LISTED):
        yield base, start_of(base), {}
        kind = kinds[number % len(kinds)]
        yield f"{base}: {kind}", start_of(base), ON_LISTED[kind]
