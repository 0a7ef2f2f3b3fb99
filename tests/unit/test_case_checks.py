"""Checks across tables: each fires on its own small change, and none on gears that work."""

from __future__ import annotations

import math

import pytest

from epicyclic.case.case import read_case
from problems import problems_of
from reference.planetary import admissible_angles

TALBOT, PAIR = "talbot-2012", "talbot-2012-pair"


def problems_of_changes(name, changes):
    problems = problems_of(read_case(name).updated, changes)
    assert all(problem.value for problem in problems)
    return problems


ONE_PROBLEM = {
    "no tooth, external": (
        TALBOT, {"sun.tip_diameter": "130 mm"},
        "sun.tip_diameter, sun.root_diameter", "leave no tooth",
    ),
    "no tooth, ring": (
        TALBOT, {"ring.tip_diameter": "238 mm"},
        "ring.tip_diameter, ring.root_diameter", "leave no tooth",
    ),
    "no height": (
        TALBOT, {"ring.root_diameter": "229.60 mm"},
        "ring.tip_diameter, ring.root_diameter", "leave no tooth",
    ),
    "a ring like a pinion": (
        PAIR, {"gear.internal": True},
        "gear.tip_diameter, gear.root_diameter", "leave no tooth",
    ),
    "root below zero": (
        PAIR, {"gear.teeth": 5, "gears.dedendum_coefficient": 4, "gear.root_diameter": None,
               "gear.tip_diameter": None, "gear.tooth_thickness": None,
               "gear.thickness_diameter": None, "gear.profile_shift_coefficient": 0},
        "gear.root_diameter", "must exceed zero",
    ),
    "tip inside the base circle": (
        TALBOT, {"sun.tip_diameter": "125 mm", "sun.root_diameter": "120 mm"},
        "sun.tip_diameter", "inside the base circle",
    ),
    "thickness inside the base circle": (
        TALBOT, {"sun.thickness_diameter": "120 mm"},
        "sun.thickness_diameter", "inside the base circle",
    ),
    "pointed": (
        TALBOT, {"planet.tooth_thickness": "0.9 mm"},
        "planet.tip_diameter", "pointed",
    ),
    "a chamfer without tip land": (
        TALBOT, {"planet.tip_chamfer": "2 mm"},
        "planet.tip_chamfer", "leaves no tip land",
    ),
    "chamfers that end the contact": (
        PAIR, {"gears.helix_angle": "0 deg", "gear.tip_diameter": "52.6 mm",
               "pinion.tip_diameter": "52.6 mm", "pinion.tip_chamfer": "0.5 mm"},
        "pinion.tip_diameter, gear.tip_diameter", "below 1",
    ),
    "no space": (
        TALBOT, {"planet.tooth_thickness": "6 mm"},
        "planet.root_diameter", "no width left",
    ),
    "no tool": (
        TALBOT, {"planet.root_diameter": "38 mm"},
        "planet.tip_diameter, planet.root_diameter", "no tool can cut",
    ),
    "ring no larger than its pinion": (
        PAIR, {"pinion.teeth": 60, "gear.internal": True, "gear.teeth": 60,
               "gear.tip_diameter": "118 mm", "gear.root_diameter": "125 mm",
               "gear.thickness_diameter": "120 mm", "pinion.thickness_diameter": "120 mm",
               "pinion.tip_diameter": "124 mm", "pinion.root_diameter": "115 mm"},
        "gear.teeth", "must exceed the 60 teeth",
    ),
    "centre distance below the base radii": (
        PAIR, {"gears.center_distance": "46 mm"},
        "gears.center_distance", "must exceed 46.985 mm, the sum",
    ),
    "negative backlash, sun": (
        TALBOT, {"gears.center_distance": "92.0 mm"},
        "sun.tooth_thickness, planet.tooth_thickness", "negative backlash",
    ),
    "negative backlash, ring": (
        TALBOT, {"ring.tooth_thickness": "3.1 mm"},
        "planet.tooth_thickness, ring.tooth_thickness", "negative backlash",
    ),
    "negative backlash, pair": (
        PAIR, {"gear.tooth_thickness": "3.3 mm"},
        "pinion.tooth_thickness, gear.tooth_thickness", "negative backlash",
    ),
    "planet tip in the sun": (
        TALBOT, {"sun.root_diameter": "133.5 mm"},
        "planet.tip_diameter", "into the root of the sun",
    ),
    "planet tip in the ring": (
        TALBOT, {"ring.root_diameter": "235.5 mm"},
        "planet.tip_diameter", "into the root of the ring",
    ),
    "ring tip in the planet": (
        TALBOT, {"ring.tip_diameter": "227 mm"},
        "ring.tip_diameter", "into the root of the planet",
    ),
    "gear tip in the pinion": (
        PAIR, {"gear.tip_diameter": "55.41 mm"},
        "gear.tip_diameter", "into the root of the pinion",
    ),
    "contact ratio": (
        PAIR, {"gears.helix_angle": "0 deg", "gear.tip_diameter": "52 mm",
               "pinion.tip_diameter": "52 mm"},
        "pinion.tip_diameter, gear.tip_diameter", "contact ratio of the mesh is 0.877, below 1",
    ),
    "fillet of the sun": (
        TALBOT, {"sun.root_diameter": "132.8 mm", "sun.tool_tip_radius": "3 mm"},
        "planet.tip_diameter", "fillet interference",
    ),
    "fillet of the ring": (
        TALBOT, {"ring.root_diameter": "235.6 mm", "ring.tool_tip_radius": "3 mm"},
        "planet.tip_diameter", "fillet interference",
    ),
    "fillet of the pinion": (
        PAIR, {"pinion.root_diameter": "45.9 mm", "pinion.tool_tip_radius": "3 mm"},
        "gear.tip_diameter", "fillet interference",
    ),
    "too many planets": (
        TALBOT, {"planet.count": 12}, "planet.count", "overlap by",
    ),
    "touching planets": (
        TALBOT, {"planet.angles": ["0 deg", "20 deg", "240 deg"]}, "planet.angles", "overlap by",
    ),
    "angles of other planets": (
        TALBOT, {"planet.angles": ["0 deg", "120 deg"]}, "planet.angles", "each of the 3 planets",
    ),
    "an angle between the teeth": (
        TALBOT, {"planet.angles": ["0 deg", "120 deg", "239 deg"]},
        "planet.angles[2]", "cannot be assembled there",
    ),
    "the input held still": (
        TALBOT, {"operation.fixed": "sun"}, "operation.fixed", "a different member",
    ),
    "two speeds of one member": (
        TALBOT, {"operation.fixed": None, "operation.second_input": "sun",
                 "operation.second_speed": "5 rpm"},
        "operation.second_input", "a different member",
    ),
    "too many rollers": (
        TALBOT, {"planet_bearing.rollers_per_row": 24},
        "planet_bearing.rollers_per_row", "only 23 rollers of 4.015 mm",
    ),
    "bore in the teeth": (
        TALBOT, {"planet_bearing.pin_diameter": "36 mm"},
        "planet_bearing.pin_diameter", "reaches its root circle",
    ),
    "errors of other planets": (
        TALBOT, {"load_sharing.position_errors": ["8 um", "-3 um"]},
        "load_sharing.position_errors", "each of the 3 planets",
    ),
    "full complement": (
        TALBOT, {"planet_bearing.cage": "full-complement", "models.bearing": "mixed-ehl"},
        "models.bearing", "caged bearings",
    ),
    "no table of coefficients": (
        TALBOT, {"models.friction": "table"}, "models.friction", "needs a table",
    ),
    "coefficients of nothing": (
        TALBOT, {"friction_table.friction": [0.1]}, "friction_table", "one or two of the axes",
    ),
    "too many axes": (
        PAIR, {"friction_table": {"film_ratio": [0.1, 1], "slide_to_roll_ratio": [0, 1],
                                  "rolling_speed": ["0 m/s", "1 m/s"], "friction": [0.1, 0.1]}},
        "friction_table", "one or two of the axes",
    ),
    "an axis that falls": (
        TALBOT, {"friction_table": {"film_ratio": [1, 0.1], "friction": [0.1, 0.1]}},
        "friction_table.film_ratio", "increasing",
    ),
    "an axis of one point": (
        TALBOT, {"friction_table": {"film_ratio": [1], "friction": [0.1]}},
        "friction_table.film_ratio", "two or more",
    ),
    "too few coefficients": (
        TALBOT, {"friction_table": {"film_ratio": [0.1, 1], "friction": [0.1]}},
        "friction_table.friction", "must have 2 values",
    ),
    "unequal rows": (
        TALBOT, {"friction_table": {"film_ratio": [0.1, 1], "rolling_speed": ["1 m/s", "2 m/s"],
                                    "friction": [[0.1, 0.1], [0.1]]}},
        "friction_table.friction", "must have 2 x 2 values",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", ONE_PROBLEM.values(), ids=ONE_PROBLEM)
def test_a_small_change_has_its_one_problem(case):
    name, changes, key, words = case
    (problem,) = problems_of_changes(name, changes)
    assert problem.key == key
    assert words in problem.allowed


@pytest.mark.parametrize(
    ("name", "changes", "missing"),
    [
        (TALBOT, {"gears.center_distance": "92.0 mm", "ring.teeth": 152}, "center_distance ="),
        (
            "train-eaxle",
            {"sets.planets.ring.teeth": 95, "sets.planets.sun.profile_shift_coefficient": 0.5},
            "planet.profile_shift_coefficient =",
        ),
    ],
)
def test_a_remedy_for_thick_teeth_leaves_out_what_an_unsound_gear_decides(name, changes, missing):
    first, second = problems_of_changes(name, changes)
    assert "negative backlash" in first.allowed
    assert "Zero backlash needs" in first.remedy
    assert missing not in first.remedy
    assert "ring" in second.key + second.allowed


def test_default_tips_are_pointed_by_thicker_teeth():
    changes = {"pinion.teeth": 9, "pinion.profile_shift_coefficient": 1.4}
    gone = ("tooth_thickness", "thickness_diameter", "tip_diameter", "root_diameter")
    changes |= {f"pinion.{key}": None for key in gone}
    problem = next(it for it in problems_of_changes(PAIR, changes) if "pointed" in it.allowed)
    assert problem.remedy.endswith("or reduce pinion.profile_shift_coefficient.")


def test_values_are_the_ones_of_the_file():
    (problem,) = problems_of_changes(TALBOT, {"gears.center_distance": "3.62 in"})
    assert problem.key == "sun.tooth_thickness, planet.tooth_thickness"
    assert problem.value == '"2.873 mm", "2.8732 mm"'
    (problem,) = problems_of_changes(TALBOT, {"ring.tip_diameter": "8.937 in"})
    assert problem.value == '"8.937 in"'
    (problem,) = problems_of_changes(
        PAIR,
        {
            "gears.center_distance": "51.999 mm",
            "gear.tip_diameter": None,
            "gears.addendum_coefficient": 2.0,
        },
    )
    assert problem.value.endswith("mm (the default)")


@pytest.mark.parametrize(
    ("name", "changes", "key"),
    [
        (TALBOT, {"sun.root_diameter": "133.5 mm"}, "planet.tip_diameter"),
        (TALBOT, {"ring.root_diameter": "235.5 mm"}, "planet.tip_diameter"),
        (TALBOT, {"ring.tip_diameter": "227 mm"}, "ring.tip_diameter"),
        (TALBOT, {"sun.root_diameter": "132.8 mm", "sun.tool_tip_radius": "3 mm"},
         "planet.tip_diameter"),
        (TALBOT, {"ring.root_diameter": "235.6 mm", "ring.tool_tip_radius": "3 mm"},
         "planet.tip_diameter"),
        (PAIR, {"pinion.root_diameter": "45.9 mm", "pinion.tool_tip_radius": "3 mm"},
         "gear.tip_diameter"),
        (PAIR, {"gear.tip_diameter": "55.5 mm"}, "gear.tip_diameter"),
    ],
)  # fmt: skip
def test_the_tip_diameter_that_is_proposed_works(name, changes, key):
    (problem,) = problems_of_changes(name, changes)
    words = problem.remedy.split()
    limit = float(words[words.index("mm,") - 1])
    assert problems_of_changes(name, changes | {key: f"{limit} mm"}) == ()
    beyond = limit + (0.01 if "at most" in problem.remedy else -0.01)
    assert problems_of_changes(name, changes | {key: f"{beyond} mm"})


def test_problems_of_different_tables_come_together():
    changes = {
        "sun.tip_diameter": "130 mm",
        "ring.tooth_thickness": "3.1 mm",
        "planet.angles": ["0 deg", "120 deg", "239 deg"],
        "planet_bearing.rollers_per_row": 24,
        "operation.fixed": "sun",
        "surroundings.oil_air_ratio": 5,
        "lubricant.oil": "water",
        "sun.roughness": 0.4,
        "planet.colour": "red",
        "carrier": {"width": 5},
    }
    assert [problem.key for problem in problems_of(read_case(TALBOT).updated, changes)] == [
        "operation.fixed",
        "sun.roughness",
        "sun.tip_diameter, sun.root_diameter",
        "planet.colour",
        "planet.tooth_thickness, ring.tooth_thickness",
        "planet.angles[2]",
        "planet_bearing.rollers_per_row",
        "carrier.outer_diameter",
        "carrier.width",
        "lubricant.oil",
        "surroundings.oil_air_ratio",
    ]


@pytest.mark.parametrize(
    "key", ["roughness", "material", "tool_tip_radius", "mass", "some_other_key"]
)
def test_a_key_that_no_geometry_needs_does_not_hide_its_problems(key):
    changes = {f"planet.{key}": -5, "planet.root_diameter": "38 mm"}
    keys = {problem.key for problem in problems_of(read_case(TALBOT).updated, changes)}
    assert keys == {f"planet.{key}", "planet.tip_diameter, planet.root_diameter"}


@pytest.mark.parametrize("key", ["tip_diameter", "teeth", "face_width", "tooth_thickness"])
def test_geometry_is_not_judged_without_a_key_it_needs(key):
    changes = {f"planet.{key}": -5, "ring.tooth_thickness": "3.1 mm"}
    (problem,) = problems_of_changes(TALBOT, changes)
    assert problem.key == f"planet.{key}"


def test_a_friction_table_with_mistakes_is_not_told_as_missing():
    changes = {"models.friction": "table", "friction_table": {"film_ratio": [0.1, 1.0]}}
    (problem,) = problems_of(read_case(TALBOT).updated, changes)
    assert problem.key == "friction_table.friction"


def test_a_ring_that_no_cutter_makes():
    changes = {"ring.root_diameter": "246 mm"}
    (problem,) = problems_of_changes(TALBOT, changes)
    assert problem.key in ("ring.tip_diameter, ring.root_diameter", "ring.root_diameter")


# No false alarms.


@pytest.mark.parametrize("count", range(1, 12))
def test_the_published_set_takes_up_to_eleven_planets(count):
    case = read_case(TALBOT).updated({"planet.count": count})
    assert case.planet.angles is None


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 6])
def test_admissible_angles_are_taken_as_given_ones(count):
    degrees = [math.degrees(angle) for angle in admissible_angles(count, 73, 125)]
    for shift in (0.0, 17.3, -100.0):
        angles = [f"{angle + shift:.4f} deg" for angle in degrees]
        read_case(TALBOT).updated({"planet.count": count, "planet.angles": angles})


@pytest.mark.parametrize(("error", "sound"), [(0.009, True), (0.011, False), (-0.011, False)])
def test_angles_are_checked_to_a_hundredth_of_a_degree(error, sound):
    angles = ["5 deg", "125 deg", f"{245 + error} deg"]
    assert (problems_of_changes(TALBOT, {"planet.angles": angles}) == ()) is sound


@pytest.mark.parametrize(
    "turns", [["0 deg", "-120 deg", "120 deg"], ["300 deg", "60 deg", "180 deg"]]
)
def test_angles_may_come_in_any_order_and_sense(turns):
    assert problems_of_changes(TALBOT, {"planet.angles": turns}) == ()


def test_the_nearest_angle_is_proposed():
    (problem,) = problems_of_changes(TALBOT, {"planet.angles": ["10 deg", "130 deg", "249 deg"]})
    assert problem.remedy == "The nearest is 248.181818 deg."


def test_clearance_and_backlash_may_be_zero():
    tables = read_case(PAIR).inputs()
    mesh_tip = f"{2 * (50 - 46 / 2)} mm"
    tables["pinion"]["tip_diameter"] = mesh_tip
    assert problems_of(read_case, tables) == ()
    pitch = math.pi * 2.0
    for gear in ("pinion", "gear"):
        tables[gear]["tooth_thickness"] = f"{pitch / 2} mm"
        tables[gear]["thickness_diameter"] = "50 mm"
    assert problems_of(read_case, tables) == ()
