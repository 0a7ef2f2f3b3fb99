"""Drag at any speed: rims, faces, teeth, gaps, planets and carriers, and what warnings weigh."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.losses.drag import Dipped, SumpOil, changenet_velex, disc_drag, disc_drag_flags
from epicyclic.losses.ranges import describe_flags, flags_with_loss, what_it_may_be
from epicyclic.losses.windage import (
    DRAG_METHODS,
    Teeth,
    Turning,
    drag,
    face_coefficient,
    rim_coefficient,
    tooth_coefficient,
)
from epicyclic.oil.oil import MixtureState
from reference.rotating_body import (
    cylinder_power,
    dawson_windage,
    dimensional_windage,
    laminar_disc_power,
    turbulent_disc_power,
)

RPM = math.pi / 30
AIR = MixtureState(0.0, 1.19, 18.3e-6)
MIXTURE = MixtureState(0.05, 42.13, 140e-6 * 42.13)
PINION = Turning(31.8e-3, 30.4e-3, Teeth(27, 29.3e-3, 31.8e-3, 30.4e-3, 0.21))
SPEEDS = np.geomspace(1e-2, 6e3, 400)
MODELS = [model for model in DRAG_METHODS if model != "seetharaman-kahraman"]


def power(body, speed, fluid=MIXTURE, model="diab-ville-velex", mist=AIR):
    return sum(drag(body, speed, fluid, mist, 7.3e-3, model))


# --- smooth bodies --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("reynolds", "coefficient", "over_laminar"),
    [(5612, 0.00907, 12.7), (12049, 0.00735, 22.1), (14000, 0.00706, 24.7), (22751, 0.00625, 35.6)],
)
def test_turbulent_rims_are_those_of_theodorsen_and_regier(reynolds, coefficient, over_laminar):
    found = rim_coefficient(reynolds)
    assert found == pytest.approx(coefficient, rel=0.005)
    assert found * reynolds / 4 == pytest.approx(over_laminar, rel=0.005)
    root = 1 / math.sqrt(found)
    assert root == pytest.approx(-0.6 + 4.07 * math.log10(reynolds / root), rel=1e-6)


def test_slow_rims_and_faces_are_the_exact_ones():
    rim, speed = Turning(0.07, 0.05), 0.2  # Re 7
    exact = cylinder_power(0.07, 0.05, speed, MIXTURE.dynamic_viscosity)
    assert drag(rim, speed, MIXTURE, AIR, 0.01, "theodorsen-regier").rim == pytest.approx(
        exact, rel=1e-3
    )
    crawling = drag(rim, 1e-4, MIXTURE, AIR, 0.01, "theodorsen-regier")
    # Lamb: 32/3 mu omega^2 r^3 on both faces
    lamb = 32 / 3 * MIXTURE.dynamic_viscosity * 1e-8 * 0.07**3
    assert crawling.faces == pytest.approx(lamb, rel=1e-6)


@pytest.mark.parametrize(
    ("reynolds", "law"), [(2e4, laminar_disc_power), (4e6, turbulent_disc_power)]
)
def test_free_faces_are_those_of_von_karman(reynolds, law):
    radius, nu = 0.083, MIXTURE.kinematic_viscosity
    speed = reynolds * nu / radius**2
    found = drag(Turning(radius, 0.0), speed, MIXTURE, AIR, 0.01, "theodorsen-regier").faces
    assert found == pytest.approx(law(radius, speed, MIXTURE.density, nu), rel=0.002)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("gaps", [(None, None), (2.3e-3, 1.7e-3)])
def test_the_power_has_no_kink_from_creeping_to_turbulent(model, gaps):
    """The local exponent of speed changes by little from step to step, and power only grows."""
    body = Turning(0.094, 0.037, PINION.teeth, *gaps, across=2e-8)
    watts = np.array([power(body, speed, model=model) for speed in SPEEDS])
    exponent = np.diff(np.log(watts)) / np.diff(np.log(SPEEDS))
    assert np.all(exponent > 1.5)
    assert np.all(exponent < 3.3)
    # a kink between two power laws would change it by 0.3 and more in one step
    assert np.abs(np.diff(exponent)).max() < 0.1


def test_far_walls_are_none_and_near_ones_shear_the_gap():
    for reynolds in (7.0, 900.0, 2.3e4, 3e5, 5e6):
        assert rim_coefficient(reynolds, 1e9) == pytest.approx(rim_coefficient(reynolds), rel=1e-3)
        assert face_coefficient(reynolds, 1e9) == pytest.approx(
            face_coefficient(reynolds), rel=1e-3
        )
    # Couette flow in a gap of 0.4 mm: tau = mu omega r/t, within the curvature
    radius, gap, speed = 0.06, 4e-4, 31.0
    body = Turning(radius, 0.021, radial_gap=gap, axial_gap=gap)
    found = drag(body, speed, MIXTURE, AIR, 0.01, "theodorsen-regier")
    shear = MIXTURE.dynamic_viscosity * speed**2 / gap
    assert found.rim == pytest.approx(2 * math.pi * radius**3 * 0.021 * shear, rel=0.02)
    assert found.faces == pytest.approx(math.pi * radius**4 * shear, rel=0.02)


# --- teeth ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("rpm", [4100, 6700, 11300])
def test_windage_of_teeth_is_of_the_size_of_two_other_published_formulas(rpm):
    """Spur gear of 72 teeth of 4 mm in air; the formulas do not share a constant."""
    teeth = Teeth(72, 0.144, 0.148, 0.030, 0.0658)
    speed = rpm * RPM
    found = power(Turning(0.148, 0.030, teeth), speed, AIR)
    dimensional = dimensional_windage(72, 0.144, 0.030, speed, AIR.density, 18.3e-6)
    for other in (dawson_windage(0.278, 0.030, 4e-3, rpm), dimensional):
        assert 0.5 < found / other < 2.0


@pytest.mark.parametrize("model", ["diab-ville-velex", "anderson-loewenthal"])
def test_windage_grows_with_the_speed_as_its_sources_say(model):
    slow, fast = (power(PINION, speed, AIR, model) for speed in (2100.0, 2200.0))
    assert 2.8 - 1e-9 <= math.log(fast / slow) / math.log(2200 / 2100) <= 3.0


def test_anderson_and_loewenthal_as_printed():
    # worked out separately: kW, rpm, m, cP
    rpm, b, r, mu = 17_300.0, 30.4e-3, 29.3e-3, 7.3
    kilowatts = 2.82e-7 * (1 + 2.3 * b / r) * rpm**2.8 * r**4.6 * (0.028 * mu + 0.019) ** 0.2
    found = power(PINION, rpm * RPM, model="anderson-loewenthal")
    assert found == pytest.approx(1e3 * kilowatts, rel=1e-12)


def test_flanges_take_from_the_windage_and_gaps_do_so_steadily():
    teeth = PINION.teeth
    assert teeth is not None
    open_gear = tooth_coefficient(teeth)
    beside = [tooth_coefficient(teeth, gap) for gap in (1e-3, 2.7e-3, 6.1e-3, 0.4)]
    assert beside == sorted(beside)
    assert beside[-1] == pytest.approx(open_gear, rel=1e-5)
    assert beside[1] / beside[0] == pytest.approx(2.7**0.56, rel=1e-3)


def test_teeth_push_the_mist_and_not_all_of_the_oil():
    speed = 1900.0
    smooth = power(PINION, speed, model="theodorsen-regier")
    assert PINION.teeth is not None
    group = tooth_coefficient(PINION.teeth) * speed**3 * 29.3e-3**5 / 2
    for mist in (AIR, MixtureState(0.001, 2.02, 20e-6)):
        found = power(PINION, speed, mist=mist) - smooth
        assert found == pytest.approx(group * mist.density, rel=1e-9)


# --- in a gearbox ---------------------------------------------------------------------------------

COARSE = {"numerics.pocket_slices": 6, "numerics.pocket_steps": 10, "numerics.mesh_positions": 6}


def test_planets_spin_in_the_carrier_and_stand_in_the_flow_of_an_open_one(talbot):
    case = talbot.updated(COARSE)
    bare = case.updated({"carrier": None})
    closed, alone = (ep.solve(it) for it in (case, bare))
    assert alone.losses["planets_drag"] == pytest.approx(closed.losses["planets_drag"], rel=1e-9)
    planet, fluid = case.gearings[""].gear("planet"), closed.fluid
    mixture = MixtureState(0.05, fluid.mixture_density, fluid.mixture_viscosity)
    smooth = Turning(planet.tip_radius, planet.face_width)
    spin = 4000 * RPM * 73 * 125 / (198 * 26)  # against the carrier
    least = 3 * power(smooth, spin, mixture, "theodorsen-regier")
    assert 1.05 * least < closed.losses["planets_drag"] < 2 * least
    half_open = case.updated({"carrier.open_width": "21 mm"})
    narrow = case.updated({"carrier.width": "39 mm"})  # of 60 mm
    speed = closed.flow.members["carrier"].speed
    pin = case.gearings[""].pins["planet"].radius
    mist = 1.2 * talbot.surroundings.pressure / 101325 * 293.15 / 363.15  # air, at 90 degC
    added = ep.solve(half_open).losses["carrier_drag"] - ep.solve(narrow).losses["carrier_drag"]
    least = 0.6 * mist * 3 * 2 * planet.tip_radius * 21e-3 * (pin * speed) ** 3
    assert least < added < 2 * least  # the mist is up to 1.8 times as heavy as air
    laminar = ep.solve(bare.updated({"models.drag": "seetharaman-kahraman"}))
    assert "planets_drag" not in laminar.losses


def test_powers_balance_with_drag_of_planets(talbot):
    case = talbot.updated(COARSE | {"operation.speed": "9100 rpm", "carrier.open_width": "17 mm"})
    for loads in ("with-losses", "without-losses"):
        result = ep.solve(case.updated({"models.mesh_loads": loads}))
        passed = sum(it.torque * it.speed for it in result.flow.members.values())
        assert passed == pytest.approx(result.total, rel=1e-9)
        assert abs(passed - result.total) < 1e-10 * abs(result.input_power)


def test_an_open_carrier_is_not_wider_than_it_is(talbot):
    with pytest.raises(ep.InputError) as error:
        talbot.updated({"carrier.open_width": "61.5 mm"})
    (problem,) = error.value.problems
    assert (problem.key, problem.value) == ("carrier.open_width", '"61.5 mm"')
    assert "60 mm" in problem.allowed


def test_a_pair_loses_the_sum_of_its_gears_and_shows_the_models_beside():
    case = ep.load_case("talbot-2012-pair").updated(COARSE)
    standing = {}
    for model in DRAG_METHODS:
        result = ep.solve(case.updated({"models.drag": model}))
        standing[model] = result.standing.get("drag", "")
        if model in ("theodorsen-regier", "anderson-loewenthal"):
            assert f"{model} {result.losses['drag']:.3g} W" in standing[model]
    assert standing["seetharaman-kahraman"] == ""
    assert "anderson-loewenthal" in standing["diab-ville-velex"]
    chosen = ep.solve(case).standing["drag"]
    assert chosen == standing["diab-ville-velex"]
    former = ep.solve(case.updated({"models.preset": "talbot-2012"}))
    assert former.models["drag"] == "seetharaman-kahraman"


# --- warnings -------------------------------------------------------------------------------------


def test_warnings_weigh_what_the_drag_could_be_and_each_part_by_itself():
    """A large and a small gear whose shares of their own drag differ."""
    flags, rims, turbulent = (), 0.0, 0.0
    for where, radius, width, speed in (
        ("pinion", 0.03, 0.031, 900.0),
        ("gear", 0.07, 0.02, 380.0),
    ):
        parts = disc_drag(radius, width, speed, MIXTURE)
        flags += disc_drag_flags(where, radius, parts, speed, MIXTURE)
        rims += parts.rim
        body = Turning(radius, width)
        turbulent += drag(body, speed, MIXTURE, AIR, 0.01, "theodorsen-regier").rim
    ((watts, group),) = flags_with_loss(flags, lambda use: 1e3 * rims)
    assert watts == pytest.approx(rims, rel=1e-12)
    assert what_it_may_be(watts, group) == pytest.approx(turbulent, rel=1e-9)
    assert turbulent > 5 * rims
    (text,) = describe_flags(flags, lambda use: 1e3 * rims, total=40 * turbulent)
    assert f"{rims:.3g} W, which could be {turbulent:.3g} W in all" in text


def test_the_regimes_of_churning_pass_into_one_another_without_a_kink():
    part = Dipped(0.061, 0.065, 0.031, 0.027, 0.0042, 29, 0.0093, 0.35, 0.17)
    speeds = np.linspace(150.0, 330.0, 721)  # acceleration parameter 450 to 2200 m/s^2
    oil = SumpOil(861.0, 33e-6, 1.7e-3)
    for smooth, most in ((True, 0.1), (False, math.inf)):
        own = replace(oil, smooth=smooth)
        torques = np.array([changenet_velex(part, speed, own) for speed in speeds])
        exponent = np.diff(np.log(torques)) / np.diff(np.log(speeds))
        jump = np.abs(np.diff(exponent)).max()
        assert jump < most
        assert smooth or jump > 0.5


@pytest.mark.parametrize(
    ("share", "told"), [(0.05, False), (0.016, False), (0.1, True), (0.01, True)]
)
def test_a_mist_unlike_that_of_anderson_and_loewenthal_is_told(share, told):
    """Theirs has one part of oil in 34.25 of air; other models have no such range."""
    quiet = {"losses.mesh_pocketing.include": False, "surroundings.oil_air_ratio": share}
    case = ep.load_case("talbot-2012-pair", quiet | {"models.drag": "anderson-loewenthal"})
    result = ep.solve(case)
    flags = [it for it in result.flags if it.quantity == "share of oil around the gears"]
    assert {it.use.where for it in flags} == ({"pinion", "gear"} if told else set())
    assert sum(it.watts for it in flags) == pytest.approx(result.losses["drag"] * told)
    assert all("34.25" in it.source for it in flags)
    other = ep.solve(case.updated({"models.drag": "diab-ville-velex"}))
    assert not [it for it in other.flags if "share of oil" in it.quantity]
