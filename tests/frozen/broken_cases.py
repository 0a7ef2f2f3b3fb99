"""Cases that are refused, for the frozen texts: tables with mistakes in them, and wrong changes.

Inputs that tests were found to refuse stand in found_inputs.json; those here reach the rest.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import asymmetric
import epicyclic as ep
import listed_trains
import trains

__all__ = ["bases", "broken_cases"]

Tables = dict[str, Any]


def bases() -> dict[str, Tables]:
    """Sound tables that entries start from."""
    small_set = {
        "kind": "planetary",
        "operation": {
            "input": "sun", "fixed": "ring", "torque": "150 N*m", "speed": "15000 rpm",
            "oil_inlet_temperature": "80 degC"},
        "gears": {
            "normal_module": "1.25 mm", "normal_pressure_angle": "20 deg", "helix_angle": "19 deg",
            "center_distance": "38.7 mm"},
        "sun": {"teeth": 31, "face_width": "26 mm", "profile_shift_coefficient": 0.26,
                "roughness": "0.3 um"},
        "planet": {"teeth": 27, "count": 4, "face_width": "25 mm",
                   "profile_shift_coefficient": 0.02, "roughness": "0.4 um"},
        "ring": {"teeth": 85, "face_width": "24 mm", "profile_shift_coefficient": -0.42,
                 "roughness": "0.8 um"},
        "lubricant": {"oil": "atf-dexron-vi"},
    }  # fmt: skip
    found = {
        **{name: ep.load_case(name).given() for name in (
            "talbot-2012", "talbot-2012-pair", "train-8hp70", "train-eaxle")},
        "asymmetric planetary": asymmetric.planetary(),
        "asymmetric pair": asymmetric.gear_pair(),
        "small set": small_set,
        **{f"listed {name}": getattr(listed_trains, name)() for name in listed_trains.__all__},
        "simple train": trains.simple(30, 90, "ring", ("sun", "carrier")),
        "stepped train": trains.stepped(20, 50, 22, 92, "ring", ("sun", "carrier")),
        "wolfrom train": trains.wolfrom(12, 33, 78, 30, 75),
    }  # fmt: skip
    plain: dict[str, Tables] = json.loads(json.dumps(found))
    return plain


def _of(section: str, **changes: Tables) -> dict[str, Tables]:
    return {name: {section: change} for name, change in changes.items()}


FRONT, REAR = "motor_front", "motor_rear"
TABLE = {"speed": ["0 rpm", "9000 rpm"], "torque": ["0.3 N*m", "0.2 N*m"]}
PALMGREN = {"model": None, "series": None}


def _bearing(name: str = FRONT, **keys: Any) -> Tables:
    return {"bearings": {name: keys}}


def _seal(**keys: Any) -> Tables:
    return {"seals": {"motor_seal": keys}}


def _drag(**keys: Any) -> Tables:
    return {"drags": {"pump": {"between": ["motor", "housing"], **keys}}}


def _rows(text: str) -> dict[str, str]:
    return {"t.csv": text}


PLANETARY: dict[str, Tables] = {
    "closed form of two planets": {
        "planet": {"count": 2, "angles": None}, "load_sharing": {
            "method": "closed-form", "position_errors": ["1 um", "2 um"],
            "floating_member": "none"}},
    "closed form of uneven planets": {
        "planet": {"count": 3, "angles": ["0 deg", "117.5 deg", "240 deg"]},
        "load_sharing": {"method": "closed-form"}},
    "factor beyond the planets": {
        "load_sharing": {"method": "mesh-load-factor", "mesh_load_factor": 5.0}},
    "errors of two planets": {
        "load_sharing": {"method": "direct", "position_errors": ["1 um", "2 um"]}},
    "one floating planet": {
        "planet": {"count": 1}, "load_sharing": {"method": "direct", "floating_member": "sun"}},
    "void at the pressure around": {
        "models": {"pocketing": "incompressible", "pocket_void_pressure": "0.9 bar"},
        "surroundings": {"pressure": "0.8 bar"}},
    "void beyond all": {"models": {"pocketing": "incompressible",
                                   "pocket_void_pressure": "1.3 bar"}},
    "no form of a fit": {"models": {"friction": "fitted", "fitted_form": "structured"},
                         "lubricant": {"oil": "iso-vg-100-pao"}},
    "another form of a fit": {"models": {"friction": "fitted", "fitted_form": "regression"},
                              "lubricant": {"oil": "iso-vg-100-pao"}},
    "flow and outlet": {"thermal": {"oil_flow": "2 l/min", "oil_outlet_temperature": "90 degC"}},
    "outlet colder than the inlet": {"thermal": {"oil_outlet_temperature": "50 degC"},
                                     "models": {"temperatures": "network"}},
    "shares of jets": {"thermal": {"jet_shares": {"sun": 1.4, "ring": -0.2}}},
    "shares of more than all": {"thermal": {"jet_shares": {"sun": 0.7, "ring": 0.6}}},
    "input twice": {"operation": {"input": "sun", "second_input": "sun"}},
    "fixed input": {"operation": {"second_input": None, "second_speed": None, "fixed": "sun"}},
    "fixed and second": {"operation": {"fixed": "carrier"}},
    "a string for a table": {"sun": "none"},
    "a table for a number": {"sun": {"teeth": {"a": 1}}},
    "a list for a table": {"gears": [1, 2]},
    "wrong units everywhere": {
        "operation": {"torque": "318 W", "speed": "2900", "oil_inlet_temperature": "67 bar"},
        "gears": {"normal_module": "2.1", "helix_angle": "14 mm"},
        "sun": {"roughness": "0.5 furlongs"}},
    "infinities": {"operation": {"torque": "inf N*m", "speed": "nan rpm"}},
    "numbers without unit": {"operation": {"torque": 318, "speed": 2900}},
    "unknown keys": {"sunn": {"teeth": 3}, "sun": {"teth": 31}, "operation": {"tork": "1 N*m"}},
    "missing keys": {"operation": {"torque": None}, "sun": {"teeth": None, "face_width": None},
                     "lubricant": None},
    "no gears": {"gears": None, "planet": None},
    "out of range": {"sun": {"teeth": 0}, "planet": {"count": -3},
                     "surroundings": {"oil_air_ratio": 1.4, "pressure": "-1 bar"},
                     "numerics": {"mesh_positions": 0, "bearing_slices": 100000}},
    "fractions of teeth": {"sun": {"teeth": 31.5}, "planet": {"count": "three"}},
    "unknown choices": {"models": {"friction": "magic", "rolling": "none", "pocketing": "some",
                                   "bearing": "ball", "drag": "little", "planet_tilt": "yes"},
                        "load_sharing": {"method": "fair"}, "operation": {"input": "planet"}},
    "unknown oil": {"lubricant": {"oil": "iso-vg-100-minerl"}},
    "oil of another type": {"lubricant": {"oil": 5}},
    "unknown material and finish": {"sun": {"material": "kryptonite", "roughness": "smooth"}},
    "module twice": {"gears": {"transverse_module": "2.2 mm"}},
    "angle twice": {"gears": {"transverse_pressure_angle": "21 deg"}},
    "no module": {"gears": {"normal_module": None}},
    "no angle": {"gears": {"normal_pressure_angle": None}},
    "colliding tips of the ring": {
        "gears": {"center_distance": None, "normal_module": "2 mm", "helix_angle": "0 deg",
                  "normal_pressure_angle": "20 deg", "addendum_coefficient": 1.0},
        "sun": {"teeth": 12, "profile_shift_coefficient": 0.3, "tip_chamfer": "0 mm"},
        "planet": {"teeth": 30, "profile_shift_coefficient": 0.0, "tip_chamfer": "0 mm",
                   "count": 1},
        "ring": {"teeth": 35, "profile_shift_coefficient": None, "tip_chamfer": "0 mm"}},
    "both thicknesses": {"sun": {"tooth_thickness": "3.3 mm"}},
    "half a span": {"sun": {"profile_shift_coefficient": None, "span_measurement": "29 mm"}},
    "half of pins": {"sun": {"profile_shift_coefficient": None, "dimension_over_pins": "75 mm"}},
    "planets that overlap": {"planet": {"count": 9}},
    "planets that cannot be assembled": {"planet": {"count": 5}},
    "angles of other planets": {"planet": {"angles": ["0 deg", "90 deg"]}},
    "equal angles": {"planet": {"angles": ["0 deg", "0 deg", "180 deg", "270 deg"]}},
    "rollers that do not fit": {"planet_bearing": {"rollers_per_row": 40}},
    "a pin that is too thick": {"planet_bearing": {"pin_diameter": "60 mm"}},
    "rollers longer than the planet": {"planet_bearing": {"roller_length": "44 mm"}},
    "bearing rubs": {"planet_bearing": {"cage": "full-complement"},
                     "models": {"bearing": "mixed-ehl"}},
    "tilt without a bearing": {"planet_bearing": None},
    "tilt of even loads": {"models": {"load_distribution": "uniform"}},
    "reliefs that overlap": {"sun": {"micro_geometry": {
        "tip_relief": "4 um", "tip_relief_roll_length": "9 mm", "root_relief": "4 um",
        "root_relief_roll_length": "9 mm"}}},
    "relief without length": {"sun": {"micro_geometry": {"tip_relief_roll_length": None}}},
    "length without relief": {"sun": {"micro_geometry": {"tip_relief": None}}},
    "end relief beyond the width": {"ring": {"micro_geometry": {"end_relief_length": "22 mm"}}},
    "topography of other rows": {"sun": {"micro_geometry": {"topography": {
        "diameter": ["70 mm", "72 mm"], "face_position": ["0 mm", "20 mm"],
        "deviation": [["1 um", "2 um"]]}}}},
    "topography elsewhere": {"sun": {"micro_geometry": {"topography": {
        "diameter": ["170 mm", "172 mm"], "face_position": ["0 mm", "20 mm"],
        "deviation": [["1 um", "2 um"], ["1 um", "2 um"]]}}}},
    "friction table without axes": {"models": {"friction": "table"},
                                    "friction_table": {"friction": [0.1, 0.2]}},
    "friction table of three axes": {"models": {"friction": "table"}, "friction_table": {
        "slide_to_roll_ratio": [0, 1], "film_ratio": [0.1, 1], "rolling_speed": ["1 m/s", "2 m/s"],
        "friction": [0.1, 0.2]}},
    "friction table that falls": {"models": {"friction": "table"}, "friction_table": {
        "film_ratio": [1, 0.1], "friction": [0.1, 0.2]}},
    "friction table of other size": {"models": {"friction": "table"}, "friction_table": {
        "film_ratio": [0.1, 1, 2], "friction": [0.1, 0.2]}},
    "friction table that is missing": {"models": {"friction": "table"}},
    "constant friction that is missing": {"models": {"friction": "constant"}},
    "law of an oil": {"lubricant": {"oil": {"pressure_viscosity": {"law": "barus"}}}},
    "law that is missing": {"lubricant": {"oil": {"pressure_viscosity": {"law": None}}}},
    "points of an oil": {"lubricant": {"oil": {"kinematic_viscosity": [
        {"temperature": "40 degC", "value": "61 mm^2/s"}]}}},
    "oil that thickens": {"lubricant": {"oil": {"kinematic_viscosity": [
        {"temperature": "40 degC", "value": "10 mm^2/s"},
        {"temperature": "100 degC", "value": "60 mm^2/s"}]}}},
    "same point of an oil twice": {"lubricant": {"oil": {"kinematic_viscosity": [
        {"temperature": "40 degC", "value": "60 mm^2/s"},
        {"temperature": "40 degC", "value": "10 mm^2/s"}]}}},
    "losses that there are not": {"losses": {"mesh_sliding": {"factor": 1.0}}},
    "negative factor": {"losses": {"sun_drag": {"factor": -1.0, "include": "maybe"}}},
    "uncertain number of teeth": {"uncertainty": {"sun.teeth": {"normal": "1"}}},
    "uncertain nothing": {"uncertainty": {"sun.color": {"normal": "1"}}},
    "normal without width": {"uncertainty": {"operation.torque": {"normal": "0 N*m"}}},
    "lognormal of a negative": {"uncertainty": {"ring_mesh.misalignment": {
        "lognormal_factor": 1.3}}},
    "limits exchanged": {"uncertainty": {"operation.torque": {"uniform": ["400 N*m", "200 N*m"]}}},
    "limits outside": {"uncertainty": {"surroundings.oil_air_ratio": {"uniform": [1.2, 1.4]}}},
    "two distributions": {"uncertainty": {"operation.torque": {
        "normal": "2 N*m", "uniform": ["200 N*m", "400 N*m"]}}},
    "no distribution": {"uncertainty": {"operation.torque": {}}},
    "form of no loss": {"uncertainty": {"model_form.friction": {"lognormal_factor": 1.3}}},
    "form of a loss without factor": {"uncertainty": {"model_form.sliding": {"normal": "1"}}},
    "form of losses without factor": {"uncertainty": {
        "model_form.sun_mesh_sliding": {"normal": "1"}, "model_form.drag": {"normal": "1"},
        "model_form.mesh_sliding": {"normal": "1"}, "model_form.pocketing": {"normal": "1"}}},
    "correlated with nothing": {"uncertainty": {"operation.torque": {
        "normal": "2 N*m", "correlated": {"sun.roughness": 0.5}}}},
    "correlated beyond one": {"uncertainty": {
        "operation.torque": {"normal": "2 N*m", "correlated": {"sun.roughness": 1.0}},
        "sun.roughness": {"normal": "0.1 um"}}},
    "correlations that cannot be": {"uncertainty": {
        "operation.torque": {"normal": "2 N*m",
                             "correlated": {"sun.roughness": 0.9, "ring.roughness": 0.9}},
        "sun.roughness": {"normal": "0.1 um", "correlated": {"ring.roughness": -0.9}},
        "ring.roughness": {"normal": "0.1 um"}}},
    "correlation of a factor": {"uncertainty": {
        "operation.torque": {"normal": "2 N*m", "correlated": {"model_form.sliding": 0.5}},
        "model_form.sliding": {"lognormal_factor": 1.3}}},
    "solver without what a law needs": {"contact_solver": {"pressure_law": "two-slope"}},
    "solver with what a law needs not": {"contact_solver": {
        "pressure_law": "roelands", "slope_ratio": 0.4, "second_slope": "8 1/GPa",
        "transition_pressure": "0.4 GPa"}},
    "shear without what a law needs": {"contact_solver": {"shear_law": "carreau"}},
    "unknown laws": {"contact_solver": {"pressure_law": "x", "shear_law": "y", "preset": "z"}},
    "shear law of limits": {"contact_solver": {
        "shear_law": "limiting", "shear_exponent": 0.4, "eyring_stress": "5 MPa"}},
    "network without a way out": {"models": {"temperatures": "network"}},
    "network without an ambient": {"models": {"temperatures": "network"},
                                   "thermal": {"housing": {"method": "given"}}},
    "capacities of no part": {"thermal": {"oil_flow": "2 l/min",
                                          "capacities": {"moon": {"value": "3 J/K"}}},
                              "models": {"temperatures": "network"}},
    "conductances of no part": {"thermal": {"oil_flow": "2 l/min",
                                            "conductances": {"moon-sun": {"value": "3 W/K"}}},
                                "models": {"temperatures": "network"}},
    "jets at no part": {"thermal": {"oil_flow": "2 l/min", "jet_shares": {"moon": 0.3}},
                        "models": {"temperatures": "network"}},
    "chamfers that leave no tip": {"sun": {"tip_chamfer": "1.9 mm"}},
    "pointed teeth": {"sun": {"tip_diameter": "82 mm"}},
    "no tooth": {"sun": {"tip_diameter": "60 mm", "root_diameter": "66 mm"}},
    "no ring": {"ring": {"tip_diameter": "190 mm", "root_diameter": "160 mm"}},
    "tip in the base circle": {"planet": {"tip_diameter": "44 mm", "root_diameter": "40 mm"}},
    "root below zero": {"planet": {"root_diameter": "0 mm"},
                        "gears": {"dedendum_coefficient": 30.0}},
    "no space at the root": {"planet": {"root_diameter": "10 mm"}},
    "thin rim": {"ring": {"rim_thickness": "0.1 mm"}},
    "meshes out of reach": {"gears": {"center_distance": "66 mm"}},
    "meshes too near": {"gears": {"center_distance": "52 mm"}},
    "no tool": {"sun": {"tool_tip_radius": "2 mm"}},
    "class of accuracy": {"sun": {"accuracy_class": 13}, "planet": {"accuracy_class": "fine"}},
    "fit of a tooth": {"sun": {"tooth_thickness_fit": "zz"}},
    "allowance and fit": {"sun": {"tooth_thickness_fit": "cd25", "tooth_thickness_allowance":
                                  "-40 um"}},
    "thrust bearing between nothing": {"thrust_bearing": {"between": "sun-sun"}},
    "carrier of no size": {"carrier": {"outer_diameter": "0 mm", "width": "-1 mm"}},
    "misalignment in radians": {"sun_mesh": {"misalignment": "0.1 rad"}},
    "another kind": {"kind": "planetry"},
    "no kind": {"kind": None},
    "kind of a pair": {"kind": "gear_pair"},
    "heat that cannot leave the sun": {
        "models": {"temperatures": "network"}, "thermal": {"oil_flow": "2 l/min", "conductances": {
            name: {"value": "0 W/K"} for name in ("sun-jet", "sun-oil", "planet-jet")}}},
    "heat that cannot leave any gear": {
        "models": {"temperatures": "network"}, "thermal": {"oil_flow": "2 l/min", "conductances": {
            name: {"value": "0 W/K"} for name in (
                "sun-jet", "sun-oil", "planet-jet", "planet-oil", "ring-jet", "ring-oil",
                "planet-pin", "pin-jet", "pin-carrier", "carrier-oil")}}},
    "a number for the kind": {"kind": 4},
    "fitted model of no oil": {"models": {"friction": "fitted"}},
    "oil model that is missing": {"models": {"friction": "fitted", "oil_model": "no/model.json"}},
    "pocketing table that is missing": {"models": {"pocketing_table": "no.nc"}},
    "compliance that needs too much": {"numerics": {"mesh_positions": 600,
                                                    "contact_segments": 600}},
}  # fmt: skip
PAIR: dict[str, Tables] = {
    "too thick teeth": {"pinion": {"profile_shift_coefficient": 0.9}},
    "internal gear too small": {"gear": {"internal": True}},
    "internal without rim": {"pinion": {"rim_thickness": "4 mm"}},
    "planetary tables": {"sun": {"teeth": 20}, "planet_bearing": {"rows": 2}},
    "pinion larger": {"pinion": {"teeth": 91}},
    "no distance and no shift": {
        "gears": {"center_distance": None}, "pinion": {"profile_shift_coefficient": None},
        "gear": {"profile_shift_coefficient": None}},
    "backlash and shifts": {"mesh": {"normal_backlash": "60 um"}},
    "distance beyond teeth": {"gears": {"center_distance": "190 mm"},
                              "gear": {"profile_shift_coefficient": None}},
    "lubrication twice": {"lubrication": {"method": "dip", "oil_level": "-9 mm",
                                          "immersion": {"gear": "4 mm"}}},
    "lubrication without level": {"lubrication": {"method": "dip"}},
    "lubrication of no gear": {"lubrication": {"method": "dip", "immersion": {"moon": "4 mm"},
                                               "oil_volume": "1 l"}},
    "jets at rest": {"lubrication": {
        "method": "jet", "jet_speed": "9 m/s", "nozzle_side": "in-mesh"}},
    "ways of heat beside methods": {"lubrication": {"method": "jet"},
                                    "thermal": {"lubrication": "dip"}},
    "housing without size": {"models": {"temperatures": "network"}, "thermal": {"housing": {}}},
    "housing with too much": {"models": {"temperatures": "network"}, "thermal": {"housing": {
        "area": "0.3 m^2", "coefficient": "20 W/(m^2*K)", "method": "iso-14179-2",
        "air_speed": "2 m/s", "height": "0.2 m", "length": "0.3 m", "fin_factor": 1.2}}},
    "cooler twice": {"models": {"temperatures": "network"}, "thermal": {
        "oil_flow": "2 l/min", "cooler_power": "30 W", "cooler_conductance": "4 W/K"}},
    "coolant without a cooler": {"models": {"temperatures": "network"}, "thermal": {
        "oil_flow": "2 l/min", "coolant_temperature": "30 degC"}},
    "module of another": {"gears": {"basic_rack": "iso-54"}},
}  # fmt: skip
AXLE: dict[str, Tables] = {
    "bore beyond the outside": _bearing(bore="80 mm"),
    "full complement of balls": _bearing(cage="full-complement"),
    "needle of skf": _bearing(type="needle"),
    "needle of harris": _bearing(type="needle", model="harris", series=None),
    "needle that locates": _bearing(REAR, type="needle", locating=True),
    "needle with axial force": _bearing(REAR, type="needle", radial_force="1 N", axial_force="1 N"),
    "series that is missing": _bearing(series=None),
    "series of no row": _bearing(series="302"),
    "series of another type": _bearing("middle_rear", model="skf-2018", series="62"),
    "rating that is missing": _bearing(static_load_rating=None),
    "rating of harris": _bearing(model="harris", series=None, static_load_rating=None),
    "width that is missing": _bearing(REAR, model="skf-2018", series="2", oil_level="3 mm"),
    "tapered without angle": _bearing(type="tapered", **PALMGREN),
    "tapered with both": _bearing(type="tapered", axial_factor=1.6, contact_angle="14 deg",
                                  **PALMGREN),
    "factor of no tapered one": _bearing(axial_factor=1.6),
    "axial force alone": _bearing(axial_force="100 N"),
    "against itself": _bearing(against="motor"),
    "against itself by another name": _bearing(shaft="pair.pinion", against="motor"),
    "shaft that there is not": _bearing(shaft="moter"),
    "model that needs a table": _bearing(model="table", series=None),
    "table without its model": _bearing(table=TABLE),
    "table of nothing": _bearing(model="table", series=None, table={"speed": ["0 rpm", "1 rpm"]}),
    "table of both": _bearing(model="table", series=None, table={
        "speed": ["0 rpm", "1 rpm"], "torque": ["1 N*m", "1 N*m"], "power": ["0 W", "1 W"]}),
    "table without axes": _bearing(model="table", series=None, table={"torque": ["1 N*m"]}),
    "places of three bearings": {"bearings": {"motor_third": {
        "shaft": "motor", "position": "50 mm", "type": "deep-groove", "bore": "35 mm",
        "outside_diameter": "72 mm"}}},
    "places that are equal": _bearing(REAR, position="0 mm"),
    "place that is missing": _bearing(REAR, position=None),
    "gear without a place": {"positions": {"pair.pinion": None}},
    "place of no gear": {"positions": {"pair.moon": "3 mm"}},
    "both locate": _bearing(REAR, type="deep-groove", locating=True),
    "none locates": _bearing(locating=None),
    "one bearing alone": {"bearings": {REAR: None}},
    "force of one": {"bearings": {"output_rear": {"radial_force": None}}},
    "set of given efficiency": {"sets": {"pair": None, "P": {
        "gears": {"pinion": {"teeth": 27}, "gear": {"teeth": 57}}, "meshes": [["pinion", "gear"]],
        "mesh_efficiency": 0.99}}, "shafts": {
            "motor": ["P.pinion"], "middle": ["P.gear", "planets.sun"]}, "positions": None},
    "seal against itself": _seal(against="motor"),
    "seal that needs a table": _seal(model="table"),
    "seal with an idle table": _seal(table=TABLE),
    "seal with a load": _seal(model="table", table={
        "radial_force": ["0 N", "1 N"], "torque": ["1 N*m", "1 N*m"]}),
    "seal with a file and axes": _seal(model="table", table={
        "file": "t.csv", "speed": ["0 rpm", "1 rpm"]}),
    "drag of nothing": _drag(),
    "drag of both": _drag(torque=["1 N*m"], power=["1 W"]),
    "drag with a load": _drag(radial_force=["0 N", "1 N"], torque=["1 N*m", "1 N*m"]),
    "drag that falls": _drag(speed=["1 rpm", "0 rpm"], torque=["1 N*m", "1 N*m"]),
    "drag of other size": _drag(speed=["0 rpm", "1 rpm"], torque=["1 N*m"]),
    "drag of ragged rows": _drag(speed=["0 rpm", "1 rpm"], temperature=["20 degC", "40 degC"],
                                 torque=[["1 N*m"], ["1 N*m", "2 N*m"]]),
    "drag of negative speeds": _drag(speed=["-1 rpm", "1 rpm"], torque=["1 N*m", "1 N*m"]),
    "negative drag": _drag(speed=["0 rpm", "1 rpm"], torque=["-1 N*m", "1 N*m"]),
    "power without speed": _drag(temperature=["20 degC", "40 degC"], power=["1 W", "2 W"]),
    "power at rest": _drag(speed=["0 rpm", "1 rpm"], power=["1 W", "2 W"]),
    "drag without axes": _drag(torque=["1 N*m"]),
    "drag of itself": {"drags": {"pump": {"between": ["motor", "motor"], **TABLE}}},
    "drag of no shaft": {"drags": {"pump": {"between": ["motor", "moon"], **TABLE}}},
    "drag of three": {"drags": {"pump": {"between": ["motor", "middle", "housing"], **TABLE}}},
    "dot in a name": {"seals": {"a.b": {"shaft": "motor", "diameter": "35 mm"}}},
    "name of a set": {"seals": {"pair": {"shaft": "motor", "diameter": "35 mm"}}},
    "name of another part": {"seals": {"motor_front": {"shaft": "motor", "diameter": "35 mm"}}},
    "no sets": {"sets": None},
    "no set": {"sets": {"pair": None, "planets": None}},
    "set that is no table": {"sets": {"pair": 3}},
    "sets that are no table": {"sets": 3},
    "temperatures of a set": {"sets": {"pair": {"models": {"temperatures": "network"}}}},
    "output is input": {"operation": {"output": "motor"}},
    "output of no shaft": {"operation": {"output": "wheel"}},
    "state that there is not": {"operation": {"state": "1"}},
    "speed of no shaft": {"operation": {"speeds": {"moon": "3 rpm"}}},
    "speed of the input": {"operation": {"speeds": {"motor": "3 rpm"}}},
    "speed of a shaft that follows": {"operation": {"speeds": {"middle": "3 rpm"}}},
    "torque of the output": {"operation": {"torques": {"differential": "3 N*m"}}},
    "torque of no shaft": {"operation": {"torques": {"moon": "3 N*m"}}},
    "dot in a shaft": {"shafts": {"a.b": ["pair.pinion"]}},
    "member of two shafts": {"shafts": {"other": ["pair.pinion"]}},
    "member that there is not": {"shafts": {"motor": ["pair.pinoin"]}},
    "member of no set": {"shafts": {"motor": ["pear.pinion"]}},
    "member without a set": {"shafts": {"motor": ["pinion"]}},
    "planet on a shaft": {"shafts": {"motor": ["pair.pinion", "planets.planet"]}},
    "shaft that is no list": {"shafts": {"motor": "pair.pinion"}},
    "all at rest": {"shafts": {"housing": ["planets.ring", "planets.sun", "planets.carrier"],
                               "middle": ["pair.gear"], "differential": None}},
    "nothing at rest": {"shafts": {"housing": None, "ring": ["planets.ring"]}},
    "hands that are missing": {"sets": {"pair": {"hand": None}}},
    "directions that are missing": {"sets": {"pair": {"direction": None}}},
    "hand of no helix": {"sets": {"pair": {"hand": "both"}}},
    "lubrication of a set alone": {"sets": {"pair": {"lubrication": {"method": "jet"}}}},
    "immersion of a train": {"lubrication": {
        "method": "dip", "immersion": {"gear": "7 mm"}, "oil_volume": "1.9 l"}},
}  # fmt: skip
GEARBOX: dict[str, Tables] = {
    "no state": {"operation": {"state": None}},
    "another state": {"operation": {"state": "9"}},
    "temperatures of given losses": {"models": {"temperatures": "network"}},
    "state of no shafts": {"states": {"1": {"fixed": ["moon"], "joined": [["sun", "stars"]]}}},
    "state that joins one": {"states": {"1": {"joined": [["input"]]}}},
    "state with too much": {"states": {"1": {"fixed": ["A", "B", "C", "D", "E"]}}},
    "state that is empty": {"states": {"1": {"fixed": [], "joined": []}}},
    "state of three joined": {"states": {"1": {"joined": [["input", "output", "housing"]]}}},
    "output that is joined to nothing": {"operation": {"output": "nothing"},
                                         "shafts": {"nothing": []}},
    "efficiency beyond one": {"sets": {"P1": {"efficiency": 1.2}}},
    "efficiency twice": {"sets": {"P1": {"efficiency": 0.98, "mesh_efficiency": 0.99}}},
    "efficiency of nothing": {"sets": {"P1": {"efficiency": None, "mesh_efficiency": None}}},
    "an oil for nothing": {"lubricant": {"oil": "atf-dexron-vi"}},
}  # fmt: skip
LISTED: dict[str, Tables] = {
    "no meshes": {"sets": {"S": {"meshes": None}}},
    "mesh of one": {"sets": {"S": {"meshes": [["sun"]]}}},
    "mesh with itself": {"sets": {"S": {"meshes": [["sun", "sun"], ["narrow", "ring"]]}}},
    "mesh of no gear": {"sets": {"S": {"meshes": [["sun", "moon"], ["narrow", "ring"]]}}},
    "mesh twice": {"sets": {"S": {"meshes": [
        ["sun", "wide"], ["wide", "sun"], ["narrow", "ring"]]}}},
    "mesh within a body": {"sets": {"S": {"meshes": [
        ["sun", "wide"], ["wide", "narrow"], ["narrow", "ring"]]}}},
    "gear in no mesh": {"sets": {"S": {"meshes": [["sun", "wide"]]}}},
    "mesh of two names": {"sets": {"S": {"mesh": {"wide-sun": {"misalignment": "1 um"}}}}},
    "own mesh of no pair": {"sets": {"S": {"mesh": {"sun-ring": {"misalignment": "1 um"}}}}},
    "ring as planet": {"sets": {"S": {"gears": {"ring": {"planet": True}}}}},
    "ring with a body": {"sets": {"S": {"gears": {"ring": {"body": "planet"}}}}},
    "sun as ring": {"sets": {"S": {"gears": {"sun": {"internal": True}}}}},
    "ring that is external": {"sets": {"S": {"gears": {"ring": {"internal": None}}}}},
    "planets without count": {"sets": {"S": {"planets": None}}},
    "planets of no number": {"sets": {"S": {"planets": 0}}},
    "gear called carrier": {"sets": {"S": {"gears": {"sun": None, "carrier": {
        "teeth": 20, "face_width": "20 mm", "roughness": "0.4 um"}},
        "meshes": [["carrier", "wide"], ["narrow", "ring"]]}}},
    "dot in a gear": {"sets": {"S": {"gears": {"sun": None, "s.n": {
        "teeth": 20, "face_width": "20 mm", "roughness": "0.4 um",
        "profile_shift_coefficient": 0.1}},
        "meshes": [["s.n", "wide"], ["narrow", "ring"]], "mesh": None}}},
    "distance that is missing": {"sets": {"S": {"mesh": {"sun-wide": {"center_distance": None}}}}},
    "distances that differ": {"sets": {"S": {"mesh": {
        "narrow-ring": {"center_distance": "50 mm"}}}}},
    "bearings of no body": {"sets": {"S": {"planet_bearings": {"moon": {"rows": 2}}}}},
    "no bearing": {"sets": {"S": {"planet_bearings": None}}},
    "both bearings": {"sets": {"S": {"planet_bearing": listed_trains.BEARING}}},
    "no carrier": {"sets": {"S": {"carrier": None}}},
    "sharing in closed form": {"sets": {"S": {"load_sharing": {"method": "closed-form"}}}},
    "sharing directly": {"sets": {"S": {"load_sharing": {"method": "direct"}}}},
    "masses twice": {"sets": {"S": {"gears": {"narrow": {"mass": "0.3 kg"}}}}},
    "modules that differ": {"sets": {"S": {"gears": {"narrow": {"transverse_module": "1.8 mm"}}}}},
    "helices that differ": {"sets": {"S": {"gears": {"narrow": {"helix_angle": "12 deg"}}}}},
    "hands that contradict": {"sets": {"S": {"gears": {
        "sun": {"hand": "left"}, "wide": {"hand": "left"}}}}},
    "losses of no mesh": {"sets": {"S": {"losses": {"moon_sliding": {"factor": 1.1}}}}},
    "tilt": {"sets": {"S": {"models": {"planet_tilt": "coupled"}}}},
    "internal pair of two rings": {"sets": {"S": {"gears": {
        "narrow": {"internal": True}}}}},
    "planets that touch": {"sets": {"S": {"planets": 9}}},
    "planets not assembled": {"sets": {"S": {"planets": 7}}},
    "given efficiency beside": {"sets": {"S": {"mesh_efficiency": 0.99}}},
}  # fmt: skip
OTHER_LISTED: dict[str, tuple[str, Tables]] = {
    "two meshes of one name": ("listed plus", {"sets": {"S": {
        "gears": {"A": None, "wide": None, "a": listed_trains.gear(40, -0.02),
                  "b-c": listed_trains.gear(42, 0.0, body="planet"),
                  "a-b": listed_trains.gear(41, 0.0, body="planet"),
                  "c": listed_trains.gear(40, -0.02)},
        "meshes": [["a", "b-c"], ["a-b", "c"], ["narrow", "B"]]}},
        "shafts": {"in": ["S.carrier"], "out": ["S.a"]}}),
    "ring of planets that does not close": ("listed ravigneaux", {"sets": {"S": {"meshes": [
        ["small_sun", "short"], ["short", "long_front"], ["large_sun", "long_rear"],
        ["long_front", "ring"], ["short", "ring"]]}}}),
    "triangle that cannot be": ("listed double_planet", {"sets": {"S": {"mesh": {
        "outer-inner": {"center_distance": "9 mm"}}}}}),
    "triangle that cannot reach": ("listed double_planet", {"sets": {"S": {"mesh": {
        "sun-inner": {"center_distance": "18 mm"}}}}}),
    "distance and shift that are missing": ("listed stepped", {"sets": {"S": {
        "gears": {"sun": {"profile_shift_coefficient": None}},
        "mesh": {"sun-wide": {"center_distance": None}}}}}),
    "three planets in a ring": ("listed double_planet", {"sets": {"S": {
        "gears": {"third": listed_trains.gear(17, 0.05, 22.0, planet=True)},
        "meshes": [["sun", "inner"], ["inner", "outer"], ["outer", "ring"], ["outer", "third"],
                   ["third", "sun"]],
        "mesh": {"outer-third": {"center_distance": "34.6 mm"},
                 "third-sun": {"center_distance": "47 mm"}}}}}),
    "closed ring of planets": ("listed double_planet", {"sets": {"S": {
        "gears": {"sun": {"teeth": 30}, "third": listed_trains.gear(18, -0.07, planet=True)},
        "meshes": [["sun", "inner"], ["inner", "outer"], ["outer", "ring"], ["outer", "third"],
                   ["third", "sun"]],
        "mesh": {"outer-third": {"center_distance": "35 mm"},
                 "third-sun": {"center_distance": "48 mm"}}}}}),
    "planets in a ring": ("listed double_planet", {"sets": {"S": {"planets": 6}}}),
    "planets too near": ("listed double_planet", {"sets": {"S": {"planets": 12}}}),
    "directions of pairs": ("listed layshaft", {"sets": {"S": {
        "mesh": {"lay_pinion-driven": {"direction": None}}}}}),
    "directions against each other": ("listed layshaft", {"sets": {"S": {"gears": {
        "drive": {"planet": True}}}}}),
    "planets where none are": ("listed layshaft", {"sets": {"S": {"planets": 3}}}),
    "bearings where no planets are": ("listed layshaft", {"sets": {"S": {
        "planet_bearing": listed_trains.BEARING}}}),
    "mesh efficiency beyond": ("stepped train", {"sets": {"S": {"mesh_efficiency": 1.1}}}),
    "efficiencies of some meshes": ("stepped train", {"sets": {"S": {"mesh_efficiency": {
        "sun-wide": 0.99}}}}),
    "carrier to nothing": ("simple train", {"operation": {"output": "moon"}}),
    "gears of a simple train": ("simple train", {"sets": {"S": {"gears": None, "meshes": None}}}),
    "nothing drives": ("simple train", {"operation": {"input": None, "output": None}}),
    "speed of the train": ("simple train", {"operation": {"speed": "0 rad"}}),
    "name of a train's set": ("simple train", {"sets": {"a.b": {"efficiency": 0.9}}}),
    "wolfrom with the wrong ring": ("wolfrom train", {"sets": {"S": {"gears": {
        "fixed": {"teeth": 12}}}}}),
    "small set without distance": ("small set", {"gears": {"center_distance": None}, "sun": {
        "profile_shift_coefficient": None}, "ring": {"profile_shift_coefficient": None}, "planet": {
            "profile_shift_coefficient": None}}),
    "small set with tip passage": ("small set", {"gears": {
        "helix_angle": "0 deg", "normal_module": "2 mm", "center_distance": None},
        "sun": {"teeth": 10, "profile_shift_coefficient": 0.4},
        "planet": {"teeth": 40, "count": 1, "profile_shift_coefficient": 0.3},
        "ring": {"teeth": 46, "profile_shift_coefficient": None}}),
    "pair with tip passage": ("asymmetric pair", {
        "gears": {"center_distance": None, "helix_angle": "0 deg"},
        "pinion": {"teeth": 40, "profile_shift_coefficient": 0.0, "micro_geometry": None,
                   "tip_chamfer": "0 mm"},
        "gear": {"teeth": 45, "internal": True, "profile_shift_coefficient": 0.0,
                 "micro_geometry": None, "tip_chamfer": "0 mm"}}),
}  # fmt: skip

DEEP: Tables = {}
for _ in range(60):
    DEEP = {"gears": DEEP}
SOURCES: dict[str, Any] = {
    "deep tables": DEEP, "endless tables": {"gears": [[0] * 1000] * 300},
    "tables without names": {"": {"": 3}}, "tables with control characters": {"a\nb": 3},
    "a number": 5, "a list": [1, 2], "no tables": {}, "no case": "talbot-2013",
    "variant that there is not": "talbot-2012-n9", "two words of a group": "talbot-2012-n3-n4",
    "file that there is not": "nothing.toml", "a folder": ".", "other ending": "case.txt",
}  # fmt: skip
TEXTS: dict[str, str] = {
    "nothing": "",
    "prose": "This is no case.\n",
    "no value": 'kind = "gear_pair"\ntitle =\n',
    "no quotes": "kind = gear_pair\n",
    "unit without quotes": '[operation]\ntorque = 5 N*m\n',
    "key twice": 'kind = "gear_pair"\nkind = "planetary"\n',
    "table twice": '[sun]\nteeth = 3\n[sun]\nteeth = 4\n',
    "dotted table twice": '[sun]\nmicro_geometry.tip_relief = "4 um"\n[sun.micro_geometry]\n'
                          'root_relief = "3 um"\n',
    "comma": '[planet]\nangles = ["0 deg" "120 deg"]\n',
    "open quote": 'title = "open\nkind = "gear_pair"\n',
    "decimal comma": "[pinion]\nprofile_shift_coefficient = 0,3\n",
    "open bracket": "[sun\nteeth = 4\n",
    "colon": "kind: gear_pair\n",
    "true": "[gear]\ninternal = True\n",
    "leading zero": "[pinion]\nteeth = 017\n",
    "only a kind": 'kind = "gear_pair"\n',
    "only the kind of a set": 'kind = "planetary"\n',
    "only the kind of a train": 'kind = "train"\n',
    "a date": "title = 2012-01-01\n[operation]\ntorque = 2012-01-01\n",
}  # fmt: skip

LOSS_FILES: dict[str, str] = {
    "nothing": "",
    "header only": "speed [rpm],torque [N*m]\n",
    "ragged": "speed [rpm],torque [N*m]\n0,1\n1\n2,3,4\n",
    "no quantity": "speed [rpm],temperature [degC]\n0,20\n1,30\n",
    "both quantities": "speed [rpm],torque [N*m],power [W]\n0,1,0\n1,1,1\n",
    "no axis": "torque [N*m]\n1\n2\n",
    "words": "speed [rpm],torque [N*m]\n0,1\n1,x\n2,-1 N*m\n",
    "point twice": "speed [rpm],torque [N*m]\n0,1\n0,2\n",
    "gap": "speed [rpm],temperature [degC],torque [N*m]\n0,20,1\n1,20,1\n0,40,2\n",
    "unknown column": "speed [rpm],colour,torque [N*m]\n0,1,1\n1,1,1\n",
    "no unit": "speed,torque [N*m]\n0,1\n1,1\n",
    "other unit": "speed [mm],torque [N*m]\n0,1\n1,1\n",
    "second column": "speed [rpm],speed [rpm],torque [N*m]\n0,0,1\n1,1,1\n",
    "negative": "speed [rpm],torque [N*m]\n-1,1\n1,-1\n",
    "one point": "speed [rpm],torque [N*m]\n0,1\n",
    "with a load": "radial_force [N],torque [N*m]\n0,1\n1,2\n",
    "power at rest": "speed [rpm],power [W]\n0,1\n1,2\n",
    "not text": "\x00\x01\x02",
}  # fmt: skip

UPDATES: dict[str, tuple[str, Tables]] = {
    "unknown key": ("talbot-2012", {"sun.teth": 3}),
    "unknown table": ("talbot-2012", {"sunn.teeth": 3}),
    "key below a value": ("talbot-2012", {"sun.teeth.number": 3}),
    "key of a list": ("talbot-2012", {"planet.angles.0": "3 deg"}),
    "key below a name": ("talbot-2012", {"lubricant.oil.density_slope.value": -0.6}),
    "key below a material": ("talbot-2012", {"sun.material.density": "7800 kg/m^3"}),
    "value of a table": ("talbot-2012", {"sun": 3}),
    "no key": ("talbot-2012", {"": 3}),
    "dots": ("talbot-2012", {"..": 3, "sun.": 3, ".sun": 3}),
    "wrong value": ("talbot-2012-pair", {"operation.torque": "much", "pinion.teeth": "many"}),
    "missing value": ("talbot-2012-pair", {"pinion.teeth": None}),
    "other kind": ("talbot-2012-pair", {"kind": "planetary"}),
    "shaft of a train": ("train-eaxle", {"shafts.motor": []}),
    "set of a train": ("train-eaxle", {"sets.pair.pinion.teeth": 0, "sets.pear.x": 1}),
    "state of a train": ("train-8hp70", {"operation.state": "10"}),
}  # fmt: skip


def broken_cases() -> Iterator[Tables]:
    """All of these as entries."""
    groups = {
        "asymmetric planetary": PLANETARY, "asymmetric pair": PAIR, "train-eaxle": AXLE,
        "train-8hp70": GEARBOX, "listed stepped": LISTED,
    }  # fmt: skip
    for base, patches in groups.items():
        for name, patch in patches.items():
            # a wrong case is told when it is read, or when it is solved
            call = "solve" if patch.get("models", {}).get("temperatures") == "network" else "load"
            yield {"name": f"{base}: {name}", "call": call, "case": base, "patch": patch}
    for name, (base, patch) in OTHER_LISTED.items():
        yield {"name": f"{base}: {name}", "call": "load", "case": base, "patch": patch}
    for name, source in SOURCES.items():
        yield {"name": f"source: {name}", "call": "load", "case": source}
    for name, text in TEXTS.items():
        yield {"name": f"text: {name}", "call": "load", "case": "c.toml", "files": {"c.toml": text}}
    for name, text in LOSS_FILES.items():
        yield {
            "name": f"file of a seal: {name}", "call": "solve", "case": "train-eaxle",
            "patch": _seal(model="table", table={"file": "t.csv"}), "files": _rows(text),
        }  # fmt: skip
    yield {
        "name": "file of a drag: with a load", "call": "load", "case": "train-eaxle",
        "patch": _drag(file="t.csv"), "files": _rows(LOSS_FILES["with a load"]),
    }  # fmt: skip
    yield {
        "name": "file of a drag: none", "call": "load", "case": "train-eaxle",
        "patch": _drag(file="none.csv"),
    }  # fmt: skip
    for name, (base, changes) in UPDATES.items():
        yield {"name": f"change: {name}", "call": "update", "case": base, "changes": changes}
