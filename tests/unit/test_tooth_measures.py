"""Span, dimension over balls and allowances, against printed data sheets."""

import math

import numpy as np
import pytest

from epicyclic import load_case
from epicyclic.gears import measures
from epicyclic.gears.gear import BasicRack, Gear, half_angle_from_profile_shift
from problems import only, problems_of

X = "profile_shift_coefficient"
TABLES = {
    "kind": "gear_pair",
    "operation": {"torque": "90 N*m", "speed": "700 rpm", "oil_inlet_temperature": "60 degC"},
    "gears": {
        "normal_module": "2.5 mm",
        "normal_pressure_angle": "20 deg",
        "helix_angle": "17 deg",
        "center_distance": "75 mm",
    },
    "pinion": {"teeth": 23, "face_width": "21 mm", X: 0.31, "roughness": "0.4 um"},
    "gear": {"teeth": 33, "face_width": "20 mm", X: 0.12, "roughness": "0.6 um"},
    "lubricant": {"oil": "atf-dexron-vi"},
}
RING = {
    "gears": TABLES["gears"] | {"helix_angle": "13 deg", "center_distance": "64 mm"},
    "pinion": TABLES["pinion"],
    "gear": TABLES["gear"] | {"teeth": -73, X: -0.3},
}


def gear(module, teeth, shift, internal=False, helix=0.0):
    rack = BasicRack(
        module / math.cos(helix), math.atan(math.tan(math.radians(20)) / math.cos(helix)), helix
    )
    half = half_angle_from_profile_shift(rack, teeth, shift)
    reference = teeth * rack.transverse_module / 2
    ends = (reference - module, reference + 1.25 * module)
    tip, root = ends if internal else (reference + module, reference - 1.25 * module)
    return Gear("gear", rack, teeth, internal, half, tip, root, 20e-3)


@pytest.mark.parametrize(
    ("teeth", "shift", "count", "printed"),
    [
        # University of Ljubljana, LECAD, program pg: module 1.75 mm
        (21, 0.4380, 3, 13.9546),
        (43, 0.0426, 5, 24.3530),
    ],
)
def test_printed_spans(teeth, shift, count, printed):
    found = gear(1.75e-3, teeth, shift)
    assert 1e3 * measures.span(found, count) == pytest.approx(printed, abs=2e-4)
    assert measures.usual_span_teeth(found) == count


@pytest.mark.parametrize("count", [3, 8])
def test_the_span_of_a_ring_is_that_of_the_teeth_that_fill_its_spaces(count):
    ring, fills = (gear(1.75e-3, 61, shift, internal=shift > 0) for shift in (0.23, -0.23))
    assert measures.span(ring, count) == pytest.approx(measures.span(fills, count), rel=1e-12)


def test_printed_dimension_over_balls():
    # MESYS AG, online calculation of helical gears: module 1 mm, 20 teeth, balls of 1.7 mm,
    # radial dimension 11.1471 mm; span over 2 teeth 4.7083 mm, touched at 19.3746 mm
    found = gear(1e-3, 20, 0.0)
    assert 1e3 * measures.dimension_over_pins(found, 1.7e-3) == pytest.approx(22.2941, abs=1e-4)
    assert 1e3 * measures.span(found, 2) == pytest.approx(4.7083, abs=1e-4)
    touched = 2e3 * measures.span_contact_radius(found, measures.span(found, 2))
    assert touched == pytest.approx(19.3746, abs=1e-4)
    assert 2e3 * measures.pin_contact_radius(found, 1.7e-3) == pytest.approx(19.9594, abs=1e-4)


@pytest.mark.parametrize("internal", [False, True])
@pytest.mark.parametrize("teeth", [44, 57])
def test_balls_touch_the_flanks_of_spur_gears(internal, teeth):
    """Against the distance of the middle of a ball from points of the flank."""
    ball, found = 3.4e-3, gear(2e-3, teeth, 0.17, internal=internal)
    measured = measures.dimension_over_pins(found, ball)
    circle = measured + ball if internal else measured - ball
    middle = circle / 2 / (math.cos(math.pi / 2 / teeth) if teeth % 2 else 1.0)
    curvature = np.linspace(0.2, 1.2, 400_001) * found.reference_radius * math.sin(math.radians(20))
    radius = np.hypot(curvature, found.base_radius)
    angle = math.pi / teeth - found.half_angles_at(curvature)
    distance = np.hypot(radius * np.cos(angle) - middle, radius * np.sin(angle))
    nearest = int(np.argmin(distance))
    assert distance[nearest] == pytest.approx(ball / 2, abs=1e-10)
    contact = measures.pin_contact_radius(found, ball)
    assert contact == pytest.approx(radius[nearest], abs=1e-6)


@pytest.mark.parametrize(
    ("allowance", "shift", "radial"), [(-60, -0.0824, 16.0821), (-30, -0.0412, 16.1190)]
)
def test_printed_allowances(allowance, shift, radial):
    # MESYS AG for Ondrives: module 1 mm, 30 teeth, x 0, balls of 1.7 mm, A_sn -60 and -30 um
    found = gear(1e-3, 30, 0.0)
    tables = TABLES | {
        "gears": TABLES["gears"]
        | {"normal_module": "1 mm", "helix_angle": "0 deg", "center_distance": "31.5 mm"}
    }
    own = tables["gear"] | {
        "teeth": 30,
        X: 0.0,
        "tooth_thickness_allowance": [f"{allowance} um"] * 2,
    }
    case = load_case(tables | {"gear": own, "pinion": tables["pinion"] | {"teeth": 33, X: None}})
    made = case.gearings[""].gear("gear")
    assert made.profile_shift_coefficient == pytest.approx(shift, abs=5e-5)
    assert 1e3 * measures.dimension_over_pins(made, 1.7e-3) / 2 == pytest.approx(radial, abs=1e-4)
    assert made.tip_radius == pytest.approx(found.tip_radius)  # of the nominal shift
    assert made.root_radius < found.root_radius
    # the nominal pinion fits without backlash; the allowance leaves one
    (mesh,) = case.gearings[""].geometries
    assert mesh.normal_backlash == pytest.approx(
        -allowance * 1e-6 * math.cos(math.radians(20)), rel=1e-9
    )


@pytest.mark.parametrize("tables", [TABLES, TABLES | RING], ids=["external", "ring"])
@pytest.mark.parametrize("name", ["pinion", "gear"])
@pytest.mark.parametrize("way", ["span", "pins"])
def test_a_measured_gear_is_that_of_its_profile_shift(tables, name, way):
    case = load_case(tables)
    made = case.gearings[""].gear(name)
    if way == "span":
        if made.internal:
            pytest.skip("helical rings have no span")
        count = measures.usual_span_teeth(made)
        stated = {
            "span_measurement": f"{1e3 * measures.span(made, count)!r} mm",
            "teeth_in_span": count,
        }
    else:
        stated = {
            "dimension_over_pins": f"{1e3 * measures.dimension_over_pins(made, 4.3e-3)!r} mm",
            "measuring_pin_diameter": "4.3 mm",
        }
    own = {key: value for key, value in tables[name].items() if key != X} | stated
    again = load_case(tables | {name: own})
    same = again.gearings[""].gear(name)
    assert same.profile_shift_coefficient == pytest.approx(made.profile_shift_coefficient, abs=1e-9)
    assert load_case(again.inputs()) == again


def test_a_stated_backlash_contains_the_allowances():
    tables = TABLES | {
        "pinion": TABLES["pinion"] | {X: None, "tooth_thickness_allowance": ["-50 um", "-90 um"]},
        "mesh": {"normal_backlash": "111 um"},
    }
    case = load_case(tables)
    assert case.gearings[""].geometries[0].normal_backlash == pytest.approx(111e-6)


@pytest.mark.parametrize(
    ("stated", "key", "words"),
    [
        ({"span_measurement": "20 mm"}, "pinion.teeth_in_span", "belongs to span_measurement"),
        (
            {"dimension_over_pins": "9 mm", "measuring_pin_diameter": "4 mm"},
            "pinion.dimension_over_pins",
            "inside the base circle",
        ),
        ({"span_measurement": "20 mm", "teeth_in_span": 3, X: 0.1}, f"pinion.{X}", "conflicts"),
        (
            {X: 0.1, "tooth_thickness_allowance": ["-3 um"]},
            "pinion.tooth_thickness_allowance",
            "at least 2",
        ),
        (
            {X: 0.1, "tooth_thickness_allowance": ["70 um", "100 um"]},
            "pinion.tooth_thickness_allowance",
            "neither positive",
        ),
        (
            {X: 0.1, "tooth_thickness_allowance": ["-110 um", "-80 um"]},
            "pinion.tooth_thickness_allowance",
            "the upper, then the lower",
        ),
        (
            {
                "dimension_over_pins": "58.7 mm",
                "measuring_pin_diameter": "2.57 mm",
                "tooth_thickness_fit": "30h",
            },
            "pinion.dimension_over_pins",
            "do not touch the flanks",
        ),
    ],
)
def test_measures_that_cannot_be(stated, key, words):
    own = {k: value for k, value in TABLES["pinion"].items() if k != X} | stated
    assert words in only(problems_of(load_case, TABLES | {"pinion": own})).allowed


def test_a_span_over_too_many_teeth_is_refused():
    case = load_case(TABLES)
    measured = measures.span(case.gearings[""].gear("pinion"), 6)
    own = {k: value for k, value in TABLES["pinion"].items() if k != X}
    own |= {"span_measurement": f"{1e3 * measured:.4f} mm", "teeth_in_span": 6}
    problem = only(problems_of(load_case, TABLES | {"pinion": own}))
    assert "beyond the flanks" in problem.allowed
    assert "Over 4 teeth" in problem.remedy


def test_the_span_of_a_helical_ring_is_refused():
    own = {k: value for k, value in RING["gear"].items() if k != X}
    own |= {"span_measurement": "57 mm", "teeth_in_span": 8}
    problem = only(problems_of(load_case, TABLES | RING | {"gear": own}))
    assert "helical ring" in problem.allowed


@pytest.mark.parametrize("way", ["span", "pins", "thickness"])
def test_too_thick_teeth_are_told_in_the_way_they_are_stated(way):
    case = load_case(TABLES | {"pinion": TABLES["pinion"] | {X: 0.62}})
    made = case.gearings[""].gear("pinion")
    over_pins = measures.dimension_over_pins(made, 4.3e-3)
    stated = {
        "span": {
            "span_measurement": f"{1e3 * measures.span(made, 4) + 0.15:.4f} mm",
            "teeth_in_span": 4,
        },
        "pins": {
            "dimension_over_pins": f"{1e3 * over_pins + 0.3:.4f} mm",
            "measuring_pin_diameter": "4.3 mm",
        },
        "thickness": {
            "tooth_thickness": f"{1e3 * made.thickness_at(made.reference_radius) + 0.15:.4f} mm",
            "thickness_diameter": f"{2e3 * made.reference_radius:.6f} mm",
        },
    }[way]
    own = {key: value for key, value in TABLES["pinion"].items() if key != X} | stated
    problems = problems_of(load_case, TABLES | {"pinion": own})
    (problem,) = [one for one in problems if "too thick" in one.allowed]
    key, value = problem.remedy.removeprefix("Zero backlash needs ").split(" or ")[0].split(" = ")
    fitted = own | {key.removeprefix("pinion."): value.strip('"')}
    case = load_case(TABLES | {"pinion": fitted})
    (mesh,) = case.gearings[""].geometries
    assert 0 <= mesh.normal_backlash < 1.1e-6
