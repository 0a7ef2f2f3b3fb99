"""Every value reaches its place: laws that hold only if parts are not taken for each other.

The cases have no two equal numbers, all shafts turn, and what must come out is worked out here from
speeds, losses and laws of balance alone.
"""

from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest
from click.testing import CliRunner

import asymmetric
import epicyclic as ep
from epicyclic.cli.compare import _share
from epicyclic.cli.main import cli
from epicyclic.kernels.interpolation import monotone_cubic

MEMBERS = ("sun", "ring", "carrier")
THRUST = ("sun-carrier", "sun-ring", "ring-carrier", "sun-housing", "carrier-housing")
SIMPLE = {
    "models.planet_tilt": "left-out",
    "losses.sun_mesh_pocketing.include": False,
    "losses.ring_mesh_pocketing.include": False,
}
"""What is not looked at and takes time left out."""


def planetary(changes=None, **kwargs):
    return ep.load_case(asymmetric.planetary(**kwargs)).updated(SIMPLE | (changes or {}))


def numbers(tables):
    """Every number in tables of a case, without sign and unit."""
    if isinstance(tables, dict):
        tables = list(tables.values())
    if isinstance(tables, list):
        return [number for item in tables for number in numbers(item)]
    found = re.match(r"-?[\d.]+", str(tables))
    return [] if found is None else [abs(float(found[0]))]


@pytest.mark.parametrize("tables", [asymmetric.planetary(), asymmetric.gear_pair()])
def test_no_two_numbers_are_equal(tables):
    found = numbers(tables)
    assert len(found) > 50
    assert len(set(found)) == len(found)


# --- roughness of the flanks ----------------------------------------------------------------------

ROUGHNESS = {"sun": 0.52, "planet": 0.37, "ring": 0.85, "pinion": 0.29, "gear": 0.74}  # um
FLANKS = {
    "sun_mesh": ("sun", "planet"),
    "ring_mesh": ("planet", "ring"),
    "mesh": ("pinion", "gear"),
}


@pytest.mark.parametrize("changed", ROUGHNESS)
def test_film_ratio_has_the_roughness_of_both_flanks(changed):
    """The film is that of smooth flanks, so that film ratio times composite roughness stays."""
    if changed in ("pinion", "gear"):
        case = ep.load_case(asymmetric.gear_pair()).updated(
            {"losses.mesh_pocketing.include": False}
        )
    else:
        case = planetary()
    # roughness changes losses, which would change the load and with it the film
    case = case.updated({"models.mesh_loads": "without-losses"})
    before = ep.solve(case)
    rougher = ROUGHNESS | {changed: 1.7 * ROUGHNESS[changed]}
    after = ep.solve(case.updated({f"{changed}.roughness": f"{rougher[changed]} um"}))
    for name, mesh in before.meshes.items():
        one, two = FLANKS[name]
        factor = math.hypot(ROUGHNESS[one], ROUGHNESS[two]) / math.hypot(rougher[one], rougher[two])
        assert (factor < 1) == (changed in (one, two))
        for figure in ("film_ratio_min", "film_ratio_max"):
            expected = factor * getattr(mesh, figure)
            assert getattr(after.meshes[name], figure) == pytest.approx(expected, rel=1e-9)


def test_film_ratio_of_both_meshes_is_that_of_the_printed_film():
    """Pan and Hamrock (1989) at one point of each mesh, with the case's own numbers."""
    case = planetary()
    result = ep.solve(case)
    moduli = {"sun": (209e9, 0.291), "planet": (203e9, 0.283), "ring": (171e9, 0.275)}
    for name, (one, two) in list(FLANKS.items())[:2]:
        contact = result.meshes[name].contact
        (e1, nu1), (e2, nu2) = moduli[one], moduli[two]
        modulus = 2 / ((1 - nu1**2) / e1 + (1 - nu2**2) / e2)
        radius, load = contact.radius, contact.line_load
        viscosity = result.fluid.dynamic_viscosity
        speed = contact.rolling_speed * viscosity / (modulus * radius)
        material = result.fluid.pressure_viscosity * modulus
        film = radius * (
            1.714 * (load / (modulus * radius)) ** -0.128 * speed**0.694 * material**0.568
        )
        ratio = film / (1e-6 * math.hypot(ROUGHNESS[one], ROUGHNESS[two]))
        assert result.meshes[name].film_ratio_min == pytest.approx(ratio.min(), rel=1e-9)
        assert result.meshes[name].film_ratio_max == pytest.approx(ratio.max(), rel=1e-9)


# --- torques of the shafts ------------------------------------------------------------------------


@pytest.mark.parametrize("driver", MEMBERS)
@pytest.mark.parametrize("between", THRUST)
def test_torques_of_the_shafts_balance_with_the_drags_against_the_housing(between, driver):
    """The housing takes drag over speed of each shaft; powers sum to the loss.

    With the torque of one shaft given, these two laws leave no choice for the others.
    """
    speeds = {"sun": 2900.0, "ring": -410.0, "carrier": 870.0}
    second, third = (name for name in MEMBERS if name != driver)
    case = planetary(
        {
            "operation.input": driver,
            "operation.second_input": second,
            "operation.speed": f"{speeds[driver]} rpm",
            "operation.second_speed": f"{speeds[second]} rpm",
        },
        between=between,
    )
    result = ep.solve(case)
    speed = {name: member.speed for name, member in result.flow.members.items()}
    assert len({abs(value) for value in speed.values()} | {0.0}) == 4
    assert 31 * speed["sun"] + 78 * speed["ring"] == pytest.approx(109 * speed["carrier"])
    losses = result.losses
    drag = {name: losses[f"{name}_drag"] / speed[name] for name in MEMBERS}
    one, two = between.split("-")
    if two == "housing":
        drag[one] += losses["thrust_bearing_viscous"] / speed[one]
    assert losses["thrust_bearing_viscous"] > 1.0
    left = sum(drag.values()) - 318.0, result.total - 318.0 * speed[driver]
    torques = np.linalg.solve([[1, 1], [speed[second], speed[third]]], left)
    found = [result.flow.members[name].torque for name in (driver, second, third)]
    assert found == pytest.approx([318.0, *torques], rel=1e-9)


@pytest.mark.parametrize(
    ("between", "shares"),
    [
        # torques on sun, ring and carrier stand to each other as 31 : 78 : -109
        ("sun-housing", {"sun": 0.0, "ring": -78 / 31, "carrier": 109 / 31}),
        ("carrier-housing", {"sun": 0.0, "ring": 0.0, "carrier": 1.0}),
    ],
)
def test_a_thrust_bearing_on_the_housing_brakes_its_shaft(between, shares):
    """What the input loses the meshes do not pass, and what the output loses it does not give."""
    case = planetary({"models.mesh_loads": "without-losses"}, between=between)
    with_it = ep.solve(case)
    without = ep.solve(case.updated({"losses.thrust_bearing_viscous.include": False}))
    shaft = between.split("-")[0]
    drag = with_it.losses["thrust_bearing_viscous"] / with_it.flow.members[shaft].speed
    for name, share in shares.items():
        change = with_it.flow.members[name].torque - without.flow.members[name].torque
        assert change == pytest.approx(share * drag, rel=1e-7, abs=1e-9)


# --- reverse rotation in a duty cycle -------------------------------------------------------------

SPEEDS = (-3000.0, -1000.0, 0.0, 2000.0)  # rpm
TORQUES = (-150.0, 0.0, 90.0)  # N m


@pytest.fixture(scope="module")
def pair():
    """With pockets, whose loss depends on the flanks that bear and so on the sign of the speed."""
    changes = {"models.load_distribution": "uniform", "numerics.pocket_interpolation": 0}
    return ep.load_case(asymmetric.gear_pair()).updated(changes)


@pytest.fixture(scope="module")
def pair_map(pair):
    speeds, torques = [f"{it} rpm" for it in SPEEDS], [f"{it} N*m" for it in TORQUES]
    return ep.loss_map(pair, speeds, torques, jobs=1)


def at_point(pair, speed, torque):
    return ep.solve(
        pair.updated({"operation.speed": f"{speed} rpm", "operation.torque": f"{torque} N*m"})
    )


def cycle(speed, torque, seconds):
    columns = {"speed [rpm]": speed, "torque [N*m]": torque, "duration [s]": seconds}
    return {name: [value] for name, value in columns.items()}


@pytest.mark.parametrize(
    ("speed", "torque", "mode"),
    [
        (-3000.0, -150.0, "driving"),
        (-3000.0, 90.0, "coasting"),
        (-1000.0, -150.0, "driving"),
        (-1000.0, 90.0, "coasting"),
        (2000.0, 90.0, "driving"),
        (2000.0, -150.0, "coasting"),
    ],
)
def test_a_shaft_that_turns_backwards_loses_what_it_loses_there(
    pair, pair_map, speed, torque, mode
):
    result, forward = at_point(pair, speed, torque), at_point(pair, -speed, torque)
    assert forward.losses["mesh_pocketing"] != pytest.approx(
        result.losses["mesh_pocketing"], rel=1e-3
    )
    found = ep.duty_cycle(pair_map, cycle(speed, torque, 7.0), samples=1).sel(mode=mode)
    assert float(found["duration"]) == 7.0
    for name, watts in result.losses.items():
        lost = float(found["energy_lost"].sel(component=name))
        assert lost == pytest.approx(7e-3 * watts, rel=1e-9)
    assert float(found["energy_in"]) == pytest.approx(7e-3 * result.input_power, rel=1e-9)
    passed = 7e-3 * (result.input_power - result.total)
    assert float(found["energy_out"]) == pytest.approx(passed, rel=1e-9)


@pytest.mark.parametrize(("speed", "torque"), [(-2100.0, 30.0), (-400.0, -60.0), (-700.0, 0.0)])
def test_between_speeds_of_reverse_rotation_the_torque_loss_is_interpolated(
    pair_map, speed, torque
):
    at_torque = [np.interp(torque, TORQUES, row) for row in pair_map["torque_loss"].values[..., 0]]
    power = np.interp(speed, SPEEDS, at_torque) * abs(speed) * math.pi / 30
    found = ep.duty_cycle(pair_map, cycle(speed, torque, 3.0), samples=1)
    assert float(found["energy_lost"].sum()) == pytest.approx(3e-3 * power, rel=1e-9)
    brought = torque * speed * math.pi / 30
    entering = max(brought, power, power - brought)
    assert float(found["energy_in"].sum()) == pytest.approx(3e-3 * entering, rel=1e-9)
    assert (found["energy_lost"] >= 0).all()


# --- heat that the solids take up -----------------------------------------------------------------

CONTACT = (
    "contact", "--radius", "11 mm", "--pressure", "0.9 GPa", "--speed", "8 m/s", "--slip", "0.3",
    "--oil", "atf-talbot-2012", "--temperature", "85 degC", "--json", "-",
)  # fmt: skip


def rise(conductivity=40.0, capacity=450.0, densities=(7840.0, 7120.0)):
    """Highest rise of the temperature in a line contact. [K]"""
    one, two = (f"{density} kg/m^3" for density in densities)
    changes = {
        "numerics.nodes": 128,
        "heating.model": "inlet-and-film",
        "heating.solid_conductivity": f"{conductivity} W/(m*K)",
        "heating.solid_heat_capacity": f"{capacity} J/(kg*K)",
        "surface1.material": f'{{elastic_modulus = "208 GPa", density = "{one}"}}',
        "surface2.material": f'{{elastic_modulus = "169 GPa", density = "{two}"}}',
    }
    options = [text for key, value in changes.items() for text in ("--set", f"{key}={value}")]
    done = CliRunner().invoke(cli, [*CONTACT, *options], catch_exceptions=False)
    return json.loads(done.stdout)["figures"]["smooth: highest temperature rise"]["value"]


def test_solids_of_a_contact_take_up_heat_by_conductivity_capacity_and_density():
    """Only the product of the three counts: a moving source of heat on a half-space."""
    once = rise()
    twice = rise(conductivity=80.0)
    assert twice < 0.9 * once
    assert rise(capacity=900.0) == pytest.approx(twice, rel=1e-9)
    assert rise(densities=(15680.0, 14240.0)) == pytest.approx(twice, rel=1e-9)
    assert rise(conductivity=80.0, capacity=225.0) == pytest.approx(once, rel=1e-9)
    assert twice < rise(densities=(15680.0, 7120.0)) < once
    assert twice < rise(densities=(7840.0, 14240.0)) < once


@pytest.mark.slow
def test_gears_take_up_heat_by_conductivity_capacity_and_density():
    """The same in the contacts of a mesh, smooth ones to be quick."""
    case = ep.load_case(asymmetric.gear_pair()).updated(
        {
            "losses.mesh_pocketing.include": False,
            "lubricant.oil": "iso-vg-220-mineral",
            "pinion.roughness": "0.01 um",
            "gear.roughness": "0.011 um",
            "models.friction": "ehl-direct",
            "models.load_distribution": "uniform",
            "numerics.mesh_positions": 4,
            "numerics.contact_segments": 4,
            "contact_solver.heating": "inlet-and-film",
            "contact_solver.most_contacts": 12,
            "contact_solver.error": 1.0,
        }
    )

    def sliding(conductivity=40, capacity=450, densities=(7840, 7120)):
        changes = {
            "contact_solver.solid_conductivity": f"{conductivity} W/(m*K)",
            "contact_solver.solid_heat_capacity": f"{capacity} J/(kg*K)",
            "pinion.material.density": f"{densities[0]} kg/m^3",
            "gear.material.density": f"{densities[1]} kg/m^3",
        }
        return ep.solve(case.updated(changes)).losses["mesh_sliding"]

    once, twice = sliding(), sliding(conductivity=80)
    assert twice > 1.01 * once  # cooler oil is thicker
    assert sliding(capacity=900) == pytest.approx(twice, rel=1e-9)
    assert sliding(densities=(15680, 14240)) == pytest.approx(twice, rel=1e-9)
    assert sliding(conductivity=80, capacity=225) == pytest.approx(once, rel=1e-9)
    assert once < sliding(densities=(15680, 7120)) < twice
    assert once < sliding(densities=(7840, 14240)) < twice


def test_monotone_cubics_take_the_slope_of_their_ends_and_are_straight_where_values_are():
    values = np.array([[1.0, 4.0], [3.0, 4.5], [5.0, 7.0], [7.0, 7.2]])
    read, slope = monotone_cubic(10.0, 0.5, values, np.array([10.2, 11.4, 12.0]))
    assert read[:, 0] == pytest.approx([1.8, 6.6, 7.0], rel=1e-12)
    assert slope[:2, 0] == pytest.approx([4.0, 4.0], rel=1e-12)
    assert slope[2] == pytest.approx([0.0, 0.0])  # beyond the points


def test_a_relative_uncertainty_is_a_share_or_per_cent():
    assert _share("0.03") == pytest.approx(0.03)
    assert _share("3 %") == _share("3%") == pytest.approx(0.03)
