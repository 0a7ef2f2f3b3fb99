"""Viscous loss of bearings, and drag of bodies in the mixture."""

from __future__ import annotations

import math

import pytest

import epicyclic as ep
from epicyclic.losses.drag import (
    bearing_viscous_loss,
    disc_drag,
    disc_drag_flags,
    reynolds_number,
    viscous_flags,
)
from epicyclic.oil.oil import MixtureState, mixture_state
from reference.rotating_body import cylinder_power, laminar_disc_power, turbulent_disc_power

RPM = math.pi / 30


def mixture(nu=1.4e-4, rho=42.13):
    return MixtureState(0.05, rho, nu * rho)


# --- bearings -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("rpm", "celsius", "watts"),
    # worked out separately: (5.6) with f0 = 6 and d_m 30.008 mm, per planet
    [
        (4000, 40, 42.7),
        (4000, 60, 27.5),
        (4000, 90, 16.8),
        (1000, 40, 4.2),
        (1000, 60, 2.7),
        (1000, 90, 1.7),
    ],
)
def test_viscous_loss_of_the_test_article(talbot, rpm, celsius, watts):
    case = talbot.updated(
        {"operation.speed": f"{rpm} rpm", "operation.oil_inlet_temperature": f"{celsius} degC"}
    )
    loss = ep.solve(case).losses["planet_bearing_viscous"] / 3
    # half a unit of the last digit, and 0.05 % for the speed rounded to 7090 rpm there
    assert loss == pytest.approx(watts, abs=0.05 + 0.0005 * watts)


@pytest.mark.parametrize(
    ("factor", "nu", "rpm", "moment"),
    # worked out separately, N mm: d_m 30 mm; upper and lower branch
    [(12.0, 10.0, 4000.0, 37.8953), (3.0, 10.0, 100.0, 1.2960)],
)
def test_harris_moment_at_its_worked_values(factor, nu, rpm, moment):
    loss = bearing_viscous_loss(factor, nu * 1e-6, rpm * RPM, 30e-3)
    assert loss / (rpm * RPM) * 1e3 == pytest.approx(moment, abs=0.5e-4)


def test_formula_of_the_dissertation():
    # (5.6): (pi/30) 1e-10 f0 nu^(2/3) Omega^(5/3) d_m^3, W; mm^2/s, rpm, mm
    expected = math.pi / 30 * 1e-10 * 6 * 15.39 ** (2 / 3) * 7090 ** (5 / 3) * 30.008**3
    found = bearing_viscous_loss(6.0, 15.39e-6, 7090 * RPM, 30.008e-3)
    assert found == pytest.approx(expected, rel=1e-12)


def test_branches_of_harris_meet():
    # at nu n = 2000: 2000^(2/3) = 158.74 against 160, 0.8 % apart; the larger one counts
    nu, speed = 20e-6, 100.0 * RPM
    below = bearing_viscous_loss(3.0, nu, speed * (1 - 1e-9), 50e-3)
    above = bearing_viscous_loss(3.0, nu, speed * (1 + 1e-9), 50e-3)
    assert below == pytest.approx(above, rel=1e-8)


def test_viscous_loss_scales_as_its_powers():
    base = bearing_viscous_loss(3.0, 20e-6, 300.0, 40e-3)
    assert bearing_viscous_loss(6.0, 20e-6, 300.0, 40e-3) == pytest.approx(2 * base, rel=1e-12)
    assert bearing_viscous_loss(3.0, 40e-6, 300.0, 40e-3) == pytest.approx(
        2 ** (2 / 3) * base, rel=1e-12
    )
    assert bearing_viscous_loss(3.0, 20e-6, 600.0, 40e-3) == pytest.approx(
        2 ** (5 / 3) * base, rel=1e-12
    )
    assert bearing_viscous_loss(3.0, 20e-6, 300.0, 80e-3) == pytest.approx(8 * base, rel=1e-12)
    assert bearing_viscous_loss(3.0, 20e-6, -300.0, 40e-3) == base
    assert bearing_viscous_loss(3.0, 20e-6, 0.0, 40e-3) == 0.0
    # below nu n = 2000 the moment is constant: loss in proportion to the speed, whatever the oil
    slow = bearing_viscous_loss(3.0, 20e-6, 1.0, 40e-3)
    assert bearing_viscous_loss(3.0, 20e-6, 2.0, 40e-3) == pytest.approx(2 * slow, rel=1e-12)
    assert bearing_viscous_loss(3.0, 10e-6, 1.0, 40e-3) == slow


def drag_of(radius, width, speed, fluid):
    return sum(disc_drag(radius, width, speed, fluid))


# --- drag -----------------------------------------------------------------------------------------


def test_drag_of_the_sun_of_the_test_article(talbot, atf):
    # worked out separately: 54 W on the faces and 2 W on the rim at 4000 rpm, 90 degC; Re 1.4e4
    fluid = mixture_state(atf(90), 0.05, 101325.0)
    radius, width, speed = 139.23e-3 / 2, 30.9e-3, 4000 * RPM
    assert reynolds_number(radius, speed, fluid) == pytest.approx(1.4e4, rel=0.05)
    thin = drag_of(radius, 0.0, speed, fluid)
    whole = drag_of(radius, width, speed, fluid)
    assert thin == pytest.approx(54, abs=0.5)
    assert whole - thin == pytest.approx(2, abs=0.5)
    laminar = talbot.updated({"models.drag": "seetharaman-kahraman"})
    assert ep.solve(laminar).losses["sun_drag"] == pytest.approx(whole, rel=1e-12)


def test_rim_is_the_exact_solution_of_a_cylinder():
    fluid = mixture()
    faces = drag_of(0.07, 0.0, 300.0, fluid)
    whole = drag_of(0.07, 0.05, 300.0, fluid)
    exact = cylinder_power(0.07, 0.05, 300.0, fluid.dynamic_viscosity)
    # a difference of terms twenty times as large
    assert whole - faces == pytest.approx(exact, rel=1e-11)


@pytest.mark.parametrize("radius", [0.02, 0.07, 0.15])
@pytest.mark.parametrize("speed", [50.0, 400.0])
def test_laminar_faces_against_von_karman(radius, speed):
    fluid = mixture()
    nu = fluid.kinematic_viscosity
    assert reynolds_number(radius, speed, fluid) < 3e5
    karman = laminar_disc_power(radius, speed, fluid.density, nu)
    # von Karman: 1.935 rho nu^0.5 omega^2.5 r^4 (worked out separately)
    closed = 1.935 * fluid.density * nu**0.5 * speed**2.5 * radius**4
    assert karman == pytest.approx(closed, rel=1e-12)
    # the source's plate formula is 0.41 pi/1.935 = 0.67 of it
    found = drag_of(radius, 0.0, speed, fluid)
    assert found / karman == pytest.approx(0.41 * math.pi / 1.935, rel=1e-12)
    assert 0.5 < found / karman < 1.0


def faces_at(reynolds, fluid, radius=0.1):
    speed = reynolds * fluid.kinematic_viscosity / radius**2
    return disc_drag(radius, 0.0, speed, fluid).faces, speed


def test_turbulent_faces_against_von_karman():
    # worked out separately: the turbulent branch alone is 2.5 times von Karman's at Re = 1e6; the
    # laminar part within r_c, Re_c/Re of the area, is then a small part: (Re_c/Re)^2.36 of the
    # turbulent branch is missing, and 1/6.9 of that is there
    fluid = mixture(nu=1e-5, rho=10.0)
    for reynolds in (1e6, 5e6):
        faces, speed = faces_at(reynolds, fluid)
        karman = turbulent_disc_power(0.1, speed, fluid.density, fluid.kinematic_viscosity)
        whole = 0.025 * math.pi / 0.073 * reynolds**0.06 * karman
        missing = (5e5 / reynolds) ** 2.36 * (1 - 1 / 6.9)
        assert faces / whole == pytest.approx(1 - missing, abs=0.02)


def test_drag_grows_continuously_through_the_transition():
    fluid = mixture(nu=1e-5, rho=10.0)
    below, _ = faces_at(5e5 * (1 - 1e-9), fluid)
    above, _ = faces_at(5e5 * (1 + 1e-9), fluid)
    assert above == pytest.approx(below, rel=1e-7)
    grown = [faces_at(reynolds, fluid)[0] for reynolds in (1e5, 4.9e5, 5.1e5, 7e5, 1e6, 1e7)]
    assert grown == sorted(grown)
    # far beyond, the turbulent branch of the source: 0.025 pi rho nu^0.14 omega^2.86 r^4.72
    faces, speed = faces_at(5e8, fluid)
    source = 0.025 * math.pi * 10.0 * 1e-5**0.14 * speed**2.86 * 0.1**4.72
    assert faces == pytest.approx(source, rel=1e-6)


def test_drag_is_flagged_with_the_part_that_it_concerns():
    fluid = mixture(nu=1e-5, rho=10.0)

    def flags(reynolds):
        speed = reynolds * fluid.kinematic_viscosity / 0.1**2
        drag = disc_drag(0.1, 0.02, speed, fluid)
        found = disc_drag_flags("sun", 0.1, drag, speed, fluid)
        return drag, {flag.quantity: flag for flag in found}

    drag, found = flags(1e4)
    assert set(found) == {"Reynolds number of the rim"}
    flag = found["Reynolds number of the rim"]
    assert flag.share == pytest.approx(drag.rim / sum(drag), rel=1e-12)
    assert flag.found_low == pytest.approx(1e4, rel=1e-12)
    assert set(flags(65.0)[1]) == {"Reynolds number of the rim", "Reynolds number of the faces"}
    assert set(flags(59.0)[1]) == {"Reynolds number of the faces"}
    assert "Reynolds number of the faces" in flags(2e7)[1]
    assert flags(0.0)[1] == {}


def test_fast_bearings_and_thick_oil_are_flagged():
    assert viscous_flags("bearing", 9_990 * RPM, 0.1, 0.079) == ()
    (flag,) = viscous_flags("bearing", -10_010 * RPM, 0.1, 0.079)
    assert flag.found_high == pytest.approx(1.001e6, rel=1e-12)
    assert flag.use.model == "harris"
    (flag,) = viscous_flags("bearing", -9_990 * RPM, 0.1, 0.081)
    assert flag.found_high == pytest.approx(81.0, rel=1e-12)
    assert viscous_flags("bearing", 0.0, 0.1, 0.081) == ()


def test_drag_scales_as_its_powers():
    fluid = mixture()
    base = drag_of(0.05, 0.0, 100.0, fluid)
    assert drag_of(0.05, 0.0, 200.0, fluid) == pytest.approx(2**2.5 * base, rel=1e-12)
    assert drag_of(0.10, 0.0, 100.0, fluid) == pytest.approx(16 * base, rel=1e-12)
    heavy = mixture(rho=2 * 42.13)
    assert drag_of(0.05, 0.0, 100.0, heavy) == pytest.approx(2 * base, rel=1e-12)
    thick = mixture(nu=4 * 1.4e-4)
    assert drag_of(0.05, 0.0, 100.0, thick) == pytest.approx(2 * base, rel=1e-12)
    # Re 1e8: what is laminar within r_c is (1/200)^2.36 of it
    fast = mixture(nu=1e-6)
    turbulent = drag_of(1.0, 0.0, 100.0, fast)
    assert drag_of(1.0, 0.0, 200.0, fast) == pytest.approx(2**2.86 * turbulent, rel=1e-5)
    assert drag_of(2.0, 0.0, 100.0, fast) == pytest.approx(2**4.72 * turbulent, rel=1e-5)
    assert drag_of(0.05, 0.02, -100.0, fluid) == drag_of(0.05, 0.02, 100.0, fluid)
    assert drag_of(0.05, 0.02, 0.0, fluid) == 0.0


def test_bodies_of_the_set_turn_at_their_own_speeds(talbot, atf):
    talbot = talbot.updated({"models.drag": "seetharaman-kahraman"})
    result = ep.solve(talbot)
    fluid = mixture_state(atf(90), 0.05, 101325.0)
    carrier = 4000 * 73 / 198 * RPM
    assert result.losses["carrier_drag"] == pytest.approx(
        drag_of(0.115, 0.060, carrier, fluid), rel=1e-10
    )
    assert result.losses["ring_drag"] == 0.0
    turning = ep.solve(talbot.updated({"operation.fixed": "carrier"}))
    ring = 4000 * 73 / 125 * RPM
    # a rim of three normal modules outside the root circle unless the case says otherwise
    assert turning.losses["ring_drag"] == pytest.approx(
        drag_of(237.23e-3 / 2 + 3 * 1.813e-3, 35.8e-3, ring, fluid), rel=1e-10
    )
    assert turning.losses["carrier_drag"] == 0.0
    given = talbot.updated({"operation.fixed": "carrier", "ring.rim_thickness": "10 mm"})
    assert ep.solve(given).losses["ring_drag"] == pytest.approx(
        drag_of(237.23e-3 / 2 + 10e-3, 35.8e-3, ring, fluid), rel=1e-10
    )


@pytest.mark.parametrize(
    ("between", "rpm"),
    [
        ("sun-carrier", 4000 * 125 / 198),
        ("sun-ring", 4000),
        ("ring-carrier", 4000 * 73 / 198),
        ("sun-housing", 4000),
        ("carrier-housing", 4000 * 73 / 198),
    ],
)
def test_thrust_bearing_between_two_parts(talbot, atf, between, rpm):
    case = talbot.updated(
        {"thrust_bearing": {"mean_diameter": "90 mm", "between": between, "count": 2}}
    )
    expected = 2 * bearing_viscous_loss(3.5, atf(90).kinematic_viscosity, rpm * RPM, 90e-3)
    found = ep.solve(case).losses["thrust_bearing_viscous"]
    assert found == pytest.approx(expected, rel=1e-10)
