"""Checks across tables: each fires on its own small change, and none on gears that work."""

from __future__ import annotations

import itertools
import math

import pytest

from epicyclic.case import build
from epicyclic.case.case import load_case
from epicyclic.errors import InputError
from epicyclic.geometry.assembly import admissible_angles
from epicyclic.geometry.gear import involute
from epicyclic.geometry.outline import form_radius
from epicyclic.geometry.tools import RackTool, ShaperTool

TALBOT, PAIR = "talbot-2012", "talbot-2012-pair"


def problems_of(case):
    """The problems of a name with changes, or of tables; none if the case is sound."""
    try:
        if isinstance(case, dict):
            load_case(case)
        else:
            name, changes = case
            load_case(name).updated(changes)
    except InputError as error:
        for problem in error.problems:
            assert problem.value, problem
            assert problem.allowed.endswith(".")
            assert problem.remedy.endswith((".", "?"))
        return error.problems
    return ()


def inverse_involute(value):
    angle = min(math.cbrt(3 * value), 1.5)
    for _ in range(50):
        angle -= (involute(angle) - value) / math.tan(angle) ** 2
    return angle


def transverse(alpha, beta):
    return math.atan(math.tan(math.radians(alpha)) / math.cos(math.radians(beta)))


def pair(z1, z2, x1=0.0, x2=0.0, *, module=2.0, beta=0.0, alpha=20.0, internal=False, **gears):
    """A gear pair without backlash that states profile shifts and no diameters."""
    side = -1 if internal else 1
    alpha_t = transverse(alpha, beta)
    shifted = involute(alpha_t) + side * 2 * math.tan(math.radians(alpha)) * (x1 + x2) / (
        z2 + side * z1
    )
    reference = module / math.cos(math.radians(beta)) * (z2 + side * z1) / 2
    distance = reference * math.cos(alpha_t) / math.cos(inverse_involute(shifted))
    tables = load_case(PAIR).inputs()
    tables["gears"] = gears | {
        "normal_module": f"{module} mm",
        "normal_pressure_angle": f"{alpha} deg",
        "helix_angle": f"{beta} deg",
        "center_distance": f"{distance:.12g} mm",
    }
    for name, teeth, shift in (("pinion", z1, x1), ("gear", z2, x2)):
        tables[name] = {
            "teeth": teeth,
            "face_width": f"{10 * module} mm",
            "roughness": "ground",
            "profile_shift_coefficient": shift - 1e-7,  # room for rounding errors
        }
    tables["gear"]["internal"] = internal
    return tables


def planetary(zs, zp, zr, xs=0.0, xp=0.0, *, module=2.0, beta=0.0, alpha=20.0, count=3):
    """A planetary set without backlash that states profile shifts and no diameters."""
    alpha_t = transverse(alpha, beta)
    tangent = 2 * math.tan(math.radians(alpha))
    operating = inverse_involute(involute(alpha_t) + tangent * (xs + xp) / (zs + zp))
    half_module = module / math.cos(math.radians(beta)) / 2 * math.cos(alpha_t)
    distance = half_module * (zs + zp) / math.cos(operating)
    at_ring = math.acos(half_module * (zr - zp) / distance)
    xr = -(involute(at_ring) - involute(alpha_t)) * (zr - zp) / tangent - xp
    tables = load_case(TALBOT).inputs()
    del tables["planet_bearing"]
    tables["gears"] = {
        "normal_module": f"{module} mm",
        "normal_pressure_angle": f"{alpha} deg",
        "helix_angle": f"{beta} deg",
        "center_distance": f"{distance:.12g} mm",
    }
    for name, teeth, shift in (("sun", zs, xs), ("planet", zp, xp), ("ring", zr, xr)):
        tables[name] = {
            "teeth": teeth,
            "face_width": f"{10 * module} mm",
            "roughness": "ground",
            "profile_shift_coefficient": shift - 1e-7,
        }
    tables["planet"]["count"] = count
    return tables


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
        "planet.root_diameter", "no space left",
    ),
    "no tool": (
        TALBOT, {"planet.root_diameter": "38 mm"},
        "planet.tip_diameter, planet.root_diameter", "no tool cuts",
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
        TALBOT, {"operation.fixed": "sun"}, "operation.fixed", "another member",
    ),
    "two speeds of one member": (
        TALBOT, {"operation.fixed": None, "operation.second_input": "sun",
                 "operation.second_speed": "5 rpm"},
        "operation.second_input", "another member",
    ),
    "too many rollers": (
        TALBOT, {"planet_bearing.rollers_per_row": 24},
        "planet_bearing.rollers_per_row", "only 23 rollers of 4.015 mm",
    ),
    "bore in the teeth": (
        TALBOT, {"planet_bearing.pin_diameter": "36 mm"},
        "planet_bearing.pin_diameter", "reaches its root circle",
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
        "friction_table.film_ratio", "rising",
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
    (problem,) = problems_of((name, changes))
    assert problem.key == key
    assert words in problem.allowed


def test_values_are_the_ones_of_the_file():
    (problem,) = problems_of((TALBOT, {"gears.center_distance": "3.62 in"}))
    assert problem.key == "sun.tooth_thickness, planet.tooth_thickness"
    assert problem.value == '"2.873 mm", "2.8732 mm"'
    (problem,) = problems_of((TALBOT, {"ring.tip_diameter": "8.937 in"}))
    assert problem.value == '"8.937 in"'
    (problem,) = problems_of(
        (PAIR, {"gears.center_distance": "51.999 mm", "gear.tip_diameter": None,
                "gears.addendum_coefficient": 2.0})
    )  # fmt: skip
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
    (problem,) = problems_of((name, changes))
    words = problem.remedy.split()
    limit = float(words[words.index("mm,") - 1])
    assert problems_of((name, changes | {key: f"{limit} mm"})) == ()
    beyond = limit + (0.01 if "at most" in problem.remedy else -0.01)
    assert problems_of((name, changes | {key: f"{beyond} mm"}))


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
    assert [problem.key for problem in load_problems(changes)] == [
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


def load_problems(changes):
    with pytest.raises(InputError) as caught:
        load_case(TALBOT).updated(changes)
    return caught.value.problems


@pytest.mark.parametrize(
    "key", ["roughness", "material", "tool_tip_radius", "mass", "some_other_key"]
)
def test_a_key_that_no_geometry_needs_does_not_hide_its_problems(key):
    changes = {f"planet.{key}": -5, "planet.root_diameter": "38 mm"}
    keys = {problem.key for problem in load_problems(changes)}
    assert keys == {f"planet.{key}", "planet.tip_diameter, planet.root_diameter"}


@pytest.mark.parametrize("key", ["tip_diameter", "teeth", "face_width", "tooth_thickness"])
def test_geometry_is_not_judged_without_a_key_it_needs(key):
    changes = {f"planet.{key}": -5, "ring.tooth_thickness": "3.1 mm"}
    assert [problem.key for problem in load_problems(changes)] == [f"planet.{key}"]


def test_a_friction_table_with_mistakes_is_not_told_as_missing():
    changes = {"models.friction": "table", "friction_table": {"film_ratio": [0.1, 1.0]}}
    (problem,) = load_problems(changes)
    assert problem.key == "friction_table.friction"


# No false alarms.


@pytest.mark.parametrize("count", range(1, 12))
def test_the_published_set_takes_up_to_eleven_planets(count):
    case = load_case(TALBOT).updated({"planet.count": count})
    assert case.planet.angles is None


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 6])
def test_admissible_angles_are_taken_as_given_ones(count):
    degrees = [math.degrees(angle) for angle in admissible_angles(count, 73, 125)]
    for shift in (0.0, 17.3, -100.0):
        angles = [f"{angle + shift:.4f} deg" for angle in degrees]
        load_case(TALBOT).updated({"planet.count": count, "planet.angles": angles})


@pytest.mark.parametrize(("error", "sound"), [(0.009, True), (0.011, False), (-0.011, False)])
def test_angles_are_checked_to_a_hundredth_of_a_degree(error, sound):
    angles = ["5 deg", "125 deg", f"{245 + error} deg"]
    assert (problems_of((TALBOT, {"planet.angles": angles})) == ()) is sound


@pytest.mark.parametrize(
    "turns", [["0 deg", "-120 deg", "120 deg"], ["300 deg", "60 deg", "180 deg"]]
)
def test_angles_may_come_in_any_order_and_sense(turns):
    assert problems_of((TALBOT, {"planet.angles": turns})) == ()


def test_the_nearest_angle_is_proposed():
    (problem,) = problems_of((TALBOT, {"planet.angles": ["10 deg", "130 deg", "249 deg"]}))
    assert problem.remedy == "The nearest is 248.181818 deg."


def test_clearance_and_backlash_may_be_zero():
    tables = load_case(PAIR).inputs()
    mesh_tip = f"{2 * (50 - 46 / 2)} mm"
    tables["pinion"]["tip_diameter"] = mesh_tip
    assert problems_of(tables) == ()
    pitch = math.pi * 2.0
    for gear in ("pinion", "gear"):
        tables[gear]["tooth_thickness"] = f"{pitch / 2} mm"
        tables[gear]["thickness_diameter"] = "50 mm"
    assert problems_of(tables) == ()


SHIFTS = [(0, 0), (0.2, 0), (0.5, 0), (0.5, 0.5), (0, 0.5), (0.3, 0.1)]


@pytest.mark.parametrize("module", [0.5, 2, 10])
@pytest.mark.parametrize("beta", [0, 15, 30, 40])
def test_standard_gear_pairs_are_sound(module, beta):
    for z1, z2 in itertools.product((17, 18, 20, 40, 200), (17, 25, 100, 200)):
        for x1, x2 in SHIFTS:
            tables = pair(z1, z2, x1, x2, module=module, beta=beta)
            assert problems_of(tables) == (), (z1, z2, x1, x2)


@pytest.mark.parametrize(
    ("z1", "z2"), [(24, 60), (30, 80), (26, 125), (40, 100), (50, 60), (20, 200), (60, 72)]
)
@pytest.mark.parametrize("beta", [0, 15, 30])
def test_standard_ring_pairs_are_sound(z1, z2, beta):
    for x1, x2 in ((0, 0), (0.2, -0.2), (0.5, -0.5), (0.3, -0.5)):
        assert problems_of(pair(z1, z2, x1, x2, beta=beta, internal=True)) == (), (x1, x2)


SETS = [
    (24, 24, 72), (30, 30, 90), (36, 24, 84), (18, 30, 78), (21, 39, 99), (28, 70, 168),
    (60, 21, 102), (40, 40, 120), (73, 26, 125), (20, 40, 100), (17, 31, 79), (24, 24, 71),
]  # fmt: skip


@pytest.mark.parametrize("teeth", SETS, ids=str)
@pytest.mark.parametrize("module", [0.5, 3])
def test_planetary_sets_that_state_only_profile_shifts_are_sound(teeth, module):
    for xs, xp in ((0.3, 0.1), (0.4, 0.0), (0.3, 0.3)):
        for beta in (0, 12, 25):
            tables = planetary(*teeth, xs, xp, module=module, beta=beta)
            assert problems_of(tables) == (), (xs, xp, beta)


@pytest.mark.parametrize("alpha", [17.5, 22.5, 25])
def test_other_pressure_angles_are_sound(alpha):
    assert problems_of(planetary(30, 30, 90, 0.3, 0.1, alpha=alpha)) == ()
    assert problems_of(pair(30, 60, 0.2, 0.1, alpha=alpha)) == ()


# Interference that does exist, against textbooks.


def test_a_ring_tip_needs_planets_with_enough_teeth():
    """Full-depth rings of 60 teeth meet the base circle of pinions below about 21 teeth."""
    assert problems_of(pair(22, 60, internal=True)) == ()
    (problem,) = problems_of(pair(19, 60, internal=True))
    assert problem.key == "gear.tip_diameter"
    assert "tip interference" in problem.allowed


def test_tips_collide_where_the_tooth_numbers_are_too_near():
    """With full-depth teeth of 20 deg the difference must be about 8 to 10."""
    assert problems_of(pair(60, 72, internal=True)) == ()
    (problem,) = problems_of(pair(60, 66, internal=True))
    assert problem.key == "pinion.tip_diameter, gear.tip_diameter"
    assert "collide beside the mesh" in problem.allowed
    assert problems_of(pair(60, 66, internal=True, addendum_coefficient=0.6)) == ()


def test_undercut_takes_the_involute_that_a_large_mate_needs():
    """Below 17 teeth a rack of full depth undercuts; with profile shift it does not."""
    (problem,) = problems_of(pair(12, 100))
    assert problem.key == "gear.tip_diameter"
    assert problems_of(pair(12, 100, 0.4)) == ()


@pytest.mark.parametrize("teeth", [20, 30, 33])
def test_a_ring_too_small_for_its_teeth_is_told_once(teeth):
    (problem,) = problems_of(pair(11, teeth, 0.3, -0.1, internal=True))
    assert problem.key.startswith("gear.tip_diameter")


def test_a_ring_that_no_cutter_makes():
    changes = {"ring.root_diameter": "246 mm"}
    (problem,) = problems_of((TALBOT, changes))
    assert problem.key in ("ring.tip_diameter, ring.root_diameter", "ring.root_diameter")


def test_the_longest_involute_is_as_long_as_that_of_any_tool():
    case = load_case(TALBOT)
    tables = {"sun": case.sun, "planet": case.planet, "ring": case.ring}
    for name, table in tables.items():
        gear = build.gear(name, table, case.gears)
        longest = build.longest_involute(gear, table)
        for rounding in (0.0, 0.1e-3, 0.3e-3, 0.6e-3):
            tool = ShaperTool(42, rounding) if gear.internal else RackTool(rounding)
            form = form_radius(gear, tool)
            assert (form <= longest + 1e-12) if gear.internal else (form >= longest - 1e-12)


@pytest.mark.parametrize("teeth", [12, 15, 17, 18, 20])
def test_the_longest_involute_of_gears_that_sharp_tools_undercut(teeth):
    case = load_case(pair(teeth, 40, 0.4 if teeth < 17 else 0.0))
    gear = build.gear("pinion", case.pinion, case.gears)
    longest = build.longest_involute(gear, case.pinion)
    assert longest >= gear.base_radius
    roundings = [share * gear.rack.normal_module for share in (0.0, 0.1, 0.2, 0.3, 0.38, 0.45)]
    forms = [form_radius(gear, RackTool(rounding)) for rounding in roundings]
    assert longest <= min(forms) + 1e-12
