"""Checks across tables do not refuse gears that work, and refuse what textbooks say does not."""

from __future__ import annotations

import itertools
import math

import pytest

from epicyclic.case.case import read_case
from epicyclic.gears.cutting import RackTool, ShaperTool, form_radius, longest_involute
from epicyclic.gears.gear import involute
from problems import problems_of

TALBOT, PAIR = "talbot-2012", "talbot-2012-pair"


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
    tables = read_case(PAIR).inputs()
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
    tables = read_case(TALBOT).inputs()
    del tables["planet_bearing"], tables["carrier"]
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


SHIFTS = [(0, 0), (0.2, 0), (0.5, 0), (0.5, 0.5), (0, 0.5), (0.3, 0.1)]


@pytest.mark.slow
@pytest.mark.parametrize("module", [0.5, 2, 10])
@pytest.mark.parametrize("beta", [0, 15, 30, 40])
def test_standard_gear_pairs_are_sound(module, beta):
    for z1, z2 in itertools.product((17, 18, 20, 40, 200), (17, 25, 100, 200)):
        for x1, x2 in SHIFTS:
            tables = pair(z1, z2, x1, x2, module=module, beta=beta)
            assert problems_of(read_case, tables) == (), (z1, z2, x1, x2)


@pytest.mark.parametrize(
    ("z1", "z2"), [(24, 60), (30, 80), (26, 125), (40, 100), (50, 60), (20, 200), (60, 72)]
)
@pytest.mark.parametrize("beta", [0, 15, 30])
def test_standard_ring_pairs_are_sound(z1, z2, beta):
    for x1, x2 in ((0, 0), (0.2, -0.2), (0.5, -0.5), (0.3, -0.5)):
        assert problems_of(read_case, pair(z1, z2, x1, x2, beta=beta, internal=True)) == (), (
            x1,
            x2,
        )


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
            assert problems_of(read_case, tables) == (), (xs, xp, beta)


@pytest.mark.parametrize("alpha", [17.5, 22.5, 25])
def test_other_pressure_angles_are_sound(alpha):
    assert problems_of(read_case, planetary(30, 30, 90, 0.3, 0.1, alpha=alpha)) == ()
    assert problems_of(read_case, pair(30, 60, 0.2, 0.1, alpha=alpha)) == ()


# Interference that does exist, against textbooks.


def test_a_ring_tip_needs_planets_with_enough_teeth():
    """Full-depth rings of 60 teeth meet the base circle of pinions below about 21 teeth."""
    assert problems_of(read_case, pair(22, 60, internal=True)) == ()
    (problem,) = problems_of(read_case, pair(19, 60, internal=True))
    assert problem.key == "gear.tip_diameter"
    assert "tip interference" in problem.allowed


def test_tips_collide_where_the_tooth_numbers_are_too_near():
    """With full-depth teeth of 20 deg the difference must be about 8 to 10."""
    assert problems_of(read_case, pair(60, 72, internal=True)) == ()
    (problem,) = problems_of(read_case, pair(60, 66, internal=True))
    assert problem.key == "pinion.tip_diameter, gear.tip_diameter"
    assert "collide beside the mesh" in problem.allowed
    assert problems_of(read_case, pair(60, 66, internal=True, addendum_coefficient=0.6)) == ()


def test_tips_of_a_pinion_beyond_its_ring_all_around_collide():
    tables = pair(32, 33, 0.0, 0.107, module=1.25, beta=20, internal=True)
    tables["gears"]["center_distance"] = "0.665 mm"
    tables["pinion"]["profile_shift_coefficient"] = None
    problems = problems_of(read_case, tables)
    assert any("collide beside the mesh" in problem.allowed for problem in problems)


def test_undercut_takes_the_involute_that_a_large_mate_needs():
    """Below 17 teeth a rack of full depth undercuts; with profile shift it does not."""
    (problem,) = problems_of(read_case, pair(12, 100))
    assert problem.key == "gear.tip_diameter"
    assert problems_of(read_case, pair(12, 100, 0.4)) == ()


@pytest.mark.parametrize("teeth", [20, 30, 33])
def test_a_ring_too_small_for_its_teeth_is_told_once(teeth):
    (problem,) = problems_of(read_case, pair(11, teeth, 0.3, -0.1, internal=True))
    assert problem.key.startswith("gear.tip_diameter")


def test_the_longest_involute_is_as_long_as_that_of_any_tool():
    case = read_case(TALBOT)
    tables = {"sun": case.sun, "planet": case.planet, "ring": case.ring}
    for name, table in tables.items():
        gear = case.gearings[""].gear(name)
        longest = longest_involute(gear, table.tool_tip_radius)
        for rounding in (0.0, 0.1e-3, 0.3e-3, 0.6e-3):
            tool = ShaperTool(42, rounding) if gear.internal else RackTool(rounding)
            form = form_radius(gear, tool)
            assert (form <= longest + 1e-12) if gear.internal else (form >= longest - 1e-12)


@pytest.mark.parametrize("teeth", [12, 15, 17, 18, 20])
def test_the_longest_involute_of_gears_that_sharp_tools_undercut(teeth):
    case = read_case(pair(teeth, 40, 0.4 if teeth < 17 else 0.0))
    gear = case.gearings[""].gear("pinion")
    longest = longest_involute(gear, case.pinion.tool_tip_radius)
    assert longest >= gear.base_radius
    roundings = [share * gear.rack.normal_module for share in (0.0, 0.1, 0.2, 0.3, 0.38, 0.45)]
    forms = [form_radius(gear, RackTool(rounding)) for rounding in roundings]
    assert longest <= min(forms) + 1e-12
