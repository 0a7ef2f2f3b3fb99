"""Load and loss of the planet bearing."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.build.gear_sets import roller_bearing
from epicyclic.build.machine import build
from epicyclic.gears.mesh import Mesh
from epicyclic.kernels.mixed_ehl import needle_rolling_loss
from epicyclic.losses.planet_bearing import (
    centrifugal_forces,
    mixed_ehl_rolling_loss,
    palmgren_loss,
    pressed_alone,
    roller_loads,
)
from epicyclic.losses.shaft_bearing import minimum_load, thermal_speed_rating
from epicyclic.machine.gear_mesh import MeshDuty
from epicyclic.machine.planets import PlanetContact, planet_load, rated

BEARING_SPEED = 4000 * 125 / 198 * 73 / 26 * math.pi / 30  # at 4000 rpm of the sun, rad/s


@pytest.fixture(scope="module")
def article(talbot):
    """The test article at 333 N m a branch, as in Talbot (2012), Fig. 3.4."""
    return talbot.updated(
        {
            "operation.torque": "999 N*m",
            "models.mesh_loads": "without-losses",
            "planet.mass": "0 kg",
        }
    )


def bearing_and_loads(case):
    bearing = roller_bearing(case.planet_bearing, case.numerics)
    load = build(case).planet_loads()["planet_bearing"]
    return bearing, roller_loads(bearing, load.force, 0.0, load.moment_x, load.moment_y)


def composite(bearing, value):
    """The bearing with a composite roughness in um."""
    each = value * 1e-6 / math.sqrt(2)
    return replace(bearing, roller_roughness=each, race_roughness=each)


# --- load on the bearing --------------------------------------------------------------------------


@pytest.mark.parametrize("torque", [42.0, 100.0, 333.0])
def test_load_of_the_test_article(article, torque):
    case = article.updated({"operation.torque": f"{3 * torque} N*m"})
    load = build(case).planet_loads()["planet_bearing"]
    # Talbot (2012), Eq. 3.7 and 3.8, with operating pitch radii a z/(z_s + z_p)
    r_ps, r_pp = 92.13e-3 * 73 / 99, 92.13e-3 * 26 / 99
    assert load.force == pytest.approx(2 * torque / r_ps, rel=1e-12)
    # helix angle at the operating circle, 0.02 % from that at the reference circle
    moment = 2 * torque * r_pp * math.tan(math.radians(13.124)) / r_ps
    assert load.moment_y == pytest.approx(moment, rel=5e-4)
    # equal pressure angles: radial forces cancel, the moment is orthogonal to the force
    assert abs(load.moment_x) < 1e-9 * load.moment_y


def forces_on_planet(sun_mesh, ring_mesh, torque):
    """Tooth forces on a planet and where they act; x tangential, y outward, z axial.

    Planet at the origin. Normal forces in the plane of action: along the line of action in the
    transverse section, and sideways by tan(beta_b).
    """
    normal = torque / sun_mesh.gear1.base_radius
    forces = []
    for mesh, outward in ((sun_mesh, -1.0), (ring_mesh, 1.0)):
        alpha = mesh.operating_pressure_angle
        axial = normal * math.tan(mesh.gear1.rack.base_helix_angle)
        # at the pitch point below (sun) or above (ring); both drive the planet the same way and
        # push it away from the other gear
        radius = mesh.operating_radius2 if outward < 0 else mesh.operating_radius1
        push = np.array(
            [normal * math.cos(alpha), -outward * normal * math.sin(alpha), -outward * axial]
        )
        forces.append((np.array([0.0, outward * radius, 0.0]), push))
    return forces


@pytest.mark.parametrize("beta", [0.0, 20.0])
@pytest.mark.parametrize("centrifugal", [0.0, 700.0])
@pytest.mark.parametrize("x_ring", [-0.4, 0.0, 0.3])
def test_load_is_the_resultant_of_the_tooth_forces(make_gear, beta, centrifugal, x_ring):
    """Unequal pressure angles leave a radial force, and turn the moment against the force."""
    sun, planet = make_gear(30, 0.2, beta=beta), make_gear(24, 0.1, beta=beta)
    ring = make_gear(79, x_ring, internal=True, beta=beta)  # one tooth more than 30 + 2 * 24
    distance = 1.02 * (sun.reference_radius + planet.reference_radius)
    meshes = Mesh("sun mesh", sun, planet, distance), Mesh("ring mesh", planet, ring, distance)
    assert meshes[0].operating_pressure_angle != pytest.approx(
        meshes[1].operating_pressure_angle, abs=0.01
    )
    torque = 120.0
    # the same force along both lines of action, by the balance of the planet
    planet_torque = torque / sun.base_radius * planet.base_radius
    duties = (
        MeshDuty(SimpleNamespace(mesh=meshes[0]), torque, 100.0, True),
        MeshDuty(SimpleNamespace(mesh=meshes[1]), -planet_torque, -80.0, True),
    )
    contacts = [PlanetContact(duties[0], 2, 1j, 1), PlanetContact(duties[1], 1, -1j, -1)]
    load = planet_load(contacts, centrifugal)
    force = np.array([0.0, centrifugal, 0.0])
    moment = np.zeros(3)
    for at, push in forces_on_planet(*meshes, torque):
        force += push
        moment += np.cross(at, push)
    assert moment[2] == pytest.approx(0.0, abs=1e-9 * torque)  # the planet turns freely
    assert force[2] == pytest.approx(0.0, abs=1e-9 * force[0])  # and floats axially
    assert load.force == pytest.approx(math.hypot(force[0], force[1]), rel=1e-10)
    # The moment about an axis tilts in the plane square to it: about x it tilts y. Components along
    # and across the force, up to the hand of the helix, which is not given.
    along = np.array([force[0], force[1]]) / load.force
    across = np.array([-along[1], along[0]])
    tilting = np.array([moment[1], -moment[0]])  # in the planes of z with x and with y
    found = np.array([load.moment_x, load.moment_y])
    expected = np.array([tilting @ along, tilting @ across])
    scale = np.abs(expected).max() + 1e-12
    assert np.allclose(found, expected, atol=1e-9 * scale) or np.allclose(
        found, -expected, atol=1e-9 * scale
    )


def test_centrifugal_force_of_the_planets(article):
    light = ep.solve(article)
    heavy = ep.solve(article.updated({"planet.mass": "0.3 kg"}))
    # m a omega_c^2, square to the tangential force
    outward = 0.3 * 92.13e-3 * (4000 * 73 / 198 * math.pi / 30) ** 2
    expected = math.hypot(light.bearing.radial_force, outward)
    assert heavy.bearing.radial_force == pytest.approx(expected, rel=1e-10)
    at_rest = ep.solve(article.updated({"planet.mass": "0.3 kg", "operation.fixed": "carrier"}))
    assert at_rest.bearing.radial_force == pytest.approx(light.bearing.radial_force, rel=1e-10)


# --- published losses -----------------------------------------------------------------------------


@pytest.mark.parametrize(("celsius", "watts"), [(40, 236.0), (60, 195.0), (90, 181.0)])
def test_losses_that_calibrate_the_oil(article, celsius, watts):
    # Talbot (2012), p. 70: not validation, these three fix the pressure-viscosity coefficient. To
    # 1e-3: the printed whole watts, and coefficients of six digits.
    warm = {"operation.oil_inlet_temperature": f"{celsius} degC"}
    losses = ep.solve(article.updated(warm | {"models.preset": "talbot-2012"})).losses
    assert losses["planet_bearing_mechanical"] / 3 == pytest.approx(watts, rel=1e-3)


@pytest.mark.parametrize(("newton_metres", "adds"), [(1000, True), (60, True), (0, False)])
def test_the_load_adds_what_exceeds_the_idle_bearing(article, newton_metres, adds):
    # (B24): rolling contains the viscous loss, but not Palmgren's coefficient, and not as published
    alike = {"friction": "schlenk", "rolling": "goksem-hargreaves", "drag": "theodorsen-regier"}
    case = article.updated({
        "operation.torque": f"{newton_metres} N*m",
        "operation.oil_inlet_temperature": "25 degC",
        **{f"models.{key}": value for key, value in alike.items()},
    })  # fmt: skip

    def bearing(**models):
        keys = {f"models.{key}": value for key, value in models.items()}
        losses = ep.solve(case.updated(keys)).losses
        return losses["planet_bearing_mechanical"], losses["planet_bearing_viscous"]

    (rolling, viscous), (added, idle) = bearing(preset="talbot-2012"), bearing()
    assert idle == viscous
    # other losses of the bearings change the loads by a thousandth
    assert added == pytest.approx(max(0.0, rolling - viscous), rel=2e-3)
    assert (added > 0) == adds
    plain = bearing(bearing="palmgren")
    assert bearing(bearing="palmgren", preset="talbot-2012") == pytest.approx(plain, rel=1e-6)


def test_loss_of_smooth_needles(article, atf):
    bearing, loads = bearing_and_loads(article)
    # Talbot (2012) 89 W at S_co 0.063 um, 90 degC; the reading chosen met it to a few per
    # cent, single bars of that chart can be read to some watts
    loss = mixed_ehl_rolling_loss(composite(bearing, 0.063), loads, BEARING_SPEED, atf(90)).loss
    assert loss == pytest.approx(89.0, rel=0.10)


def test_rough_needles_lose_three_times_as_much(article, atf):
    bearing, loads = bearing_and_loads(article)
    smooth, rough = (
        mixed_ehl_rolling_loss(composite(bearing, value), loads, BEARING_SPEED, atf(90)).loss
        for value in (0.063, 0.180)
    )
    # Talbot (2012) "nearly three times"
    assert rough / smooth == pytest.approx(3.0, rel=0.10)


def test_speed_of_the_test_article(article):
    # worked out separately: 7090 rpm
    assert BEARING_SPEED * 30 / math.pi == pytest.approx(7090, abs=0.5)
    figures = ep.solve(article).bearing
    assert figures.speed == pytest.approx(BEARING_SPEED, rel=1e-12)
    assert figures.moment == pytest.approx(55.3, abs=0.05)


# --- the sum over the slices ----------------------------------------------------------------------


@pytest.mark.parametrize(("share", "wider"), [(1.0, 0.0), (0.13, 3.1e-3), (5.3, 0.0)])
def test_loss_is_the_sum_over_loaded_slices(article, atf, share, wider):
    """(3.6), one evaluation for each loaded slice, with the radius of the outer race.

    Slower, faster and larger than simulated (1 to 20 m/s, 4 mm): the force is held.
    """
    bearing, loads = bearing_and_loads(article)
    bearing = replace(bearing, roller_diameter=4.015e-3 + wider)
    oil, speed = atf(60), share * BEARING_SPEED
    pitch, roller = 0.030008 + wider, 4.015e-3 + wider
    u_r = pitch * speed * (1 - (roller / pitch) ** 2) / 4
    held_speed = min(max(u_r, 1.0), 20.0)
    radius = 1 / (2 / roller - 2 / (34.025e-3 + 2 * wider))
    held_radius = min(radius, 4e-3)
    modulus = 207e9 / (1 - 0.3**2)
    total = 0.0
    for q in loads.intensity[loads.intensity > 0]:
        pressure = math.sqrt(q * modulus / (2 * math.pi * radius))
        # below the lowest simulated pressure, 0.25 GPa, in proportion to the load
        held = max(pressure, 0.25e9)
        density = needle_rolling_loss(
            held,
            held_speed,
            oil.dynamic_viscosity,
            oil.pressure_viscosity,
            held_radius,
            math.hypot(0.1e-6, 0.1e-6),
            modulus,
        )
        below = min(1.0, q / (2 * math.pi * held_radius * held**2 / modulus))
        total += 9.52e-3 / 20 * density * below * u_r / held_speed
    found = mixed_ehl_rolling_loss(bearing, loads, speed, oil).loss
    assert (held_speed == u_r, held_radius == radius) == (share == 1.0, wider == 0.0)
    assert found == pytest.approx(total, rel=1e-10)


def test_no_motion_or_no_load_no_loss(article, atf):
    bearing, loads = bearing_and_loads(article)
    assert mixed_ehl_rolling_loss(bearing, loads, 0.0, atf(60)).loss == 0.0
    idle = roller_loads(bearing, 0.0, 0.0, 0.0, 0.0)
    assert mixed_ehl_rolling_loss(bearing, idle, BEARING_SPEED, atf(60)).loss == 0.0


def test_loss_does_not_depend_on_the_sense_of_rotation(article, atf):
    bearing, loads = bearing_and_loads(article)
    one, two = (
        mixed_ehl_rolling_loss(bearing, loads, speed, atf(60)).loss
        for speed in (BEARING_SPEED, -BEARING_SPEED)
    )
    assert one == two


@pytest.mark.parametrize("celsius", [40, 90])
def test_loss_grows_with_load_speed_and_roughness(article, atf, celsius):
    bearing = roller_bearing(article.planet_bearing, article.numerics)
    by_load = [
        mixed_ehl_rolling_loss(
            bearing,
            roller_loads(bearing, force, 0.0, 0.0, 0.00564 * force),
            BEARING_SPEED,
            atf(celsius),
        ).loss
        for force in (1.0, 10.0, 100.0, 1000.0, 3000.0, 10000.0, 20000.0)
    ]
    assert np.all(np.diff(by_load) > 0)
    _, loads = bearing_and_loads(article)
    by_speed = [
        mixed_ehl_rolling_loss(bearing, loads, share * BEARING_SPEED, atf(celsius)).loss
        for share in (0.1, 0.25, 0.5, 1.0, 1.5)
    ]
    assert np.all(np.diff(by_speed) > 0)
    by_roughness = [
        mixed_ehl_rolling_loss(composite(bearing, value), loads, BEARING_SPEED, atf(celsius)).loss
        for value in (0.063, 0.125, 0.149, 0.180)
    ]
    assert np.all(np.diff(by_roughness) > 0)


def test_slices_converge(article, atf):
    losses = []
    for slices in (10, 20, 40, 320):
        case = article.updated({"numerics.bearing_slices": slices})
        bearing, loads = bearing_and_loads(case)
        losses.append(mixed_ehl_rolling_loss(bearing, loads, BEARING_SPEED, atf(90)).loss)
    # measured 0.15, 0.15 and 0.05 %, erratic because the crown begins within a slice; times 1.5
    for loss, error in zip(losses[:-1], (2.3e-3, 2.3e-3, 0.7e-3), strict=True):
        assert loss == pytest.approx(losses[-1], rel=error)


def test_crown_height_matters_little(article, atf):
    # The crown is an estimate. worked out separately found less than 2 % over drops of 0 to
    # 10 um, with a higher alpha and both races; as implemented, +3.8 and -6.4 % at 60 degC.
    losses = []
    for drop in (0, 3, 10):
        case = article.updated({"planet_bearing.crown_drop": f"{drop} um"})
        bearing, loads = bearing_and_loads(case)
        losses.append(mixed_ehl_rolling_loss(bearing, loads, BEARING_SPEED, atf(60)).loss)
    assert losses == pytest.approx([losses[1]] * 3, rel=0.08)


# --- Palmgren -------------------------------------------------------------------------------------


def test_palmgren_loss():
    # (3.1): P = f1 F_r d_m omega; by hand 0.0003 * 9804 N * 0.030008 m * 742.5 rad/s = 65.53 W
    assert palmgren_loss(0.0003, 9804.0, 0.030008, 742.5) == pytest.approx(65.53, abs=0.5e-2)
    assert palmgren_loss(0.0003, 9804.0, 0.030008, -742.5) == pytest.approx(65.53, abs=0.5e-2)


def test_palmgren_coefficients(talbot):
    def coefficient(**changes):
        case = talbot.updated({f"planet_bearing.{key}": it for key, it in changes.items()})
        return build(case).sets[""].planets[0].bearing.palmgren_coefficient

    assert 0.0002 <= coefficient() <= 0.0004  # Talbot (2012), p. 56, caged
    assert coefficient(cage="full-complement") == 0.00055
    assert coefficient(palmgren_coefficient=0.002) == 0.002


def test_palmgren_model_of_the_set(article):
    case = article.updated({"models.bearing": "palmgren"})
    result = ep.solve(case)
    force = 2 * 333 / (92.13e-3 * 73 / 99)
    expected = 3 * 0.0003 * force * 0.030008 * BEARING_SPEED
    assert result.losses["planet_bearing_mechanical"] == pytest.approx(expected, rel=1e-10)


# --- force of rotation on rollers -----------------------------------------------------------------


def test_force_of_rotation_on_a_roller(article):
    # from where a roller is at three times: it turns with the carrier, and with its cage around the
    # pin, at half the speed at which it rolls on the bore of the planet
    bearing, _ = bearing_and_loads(article)
    pin, carrier, speed, outward, step = 0.092, 310.0, -520.0, 0.7, 1e-5
    around = bearing.pitch_diameter / 2
    cage = speed * bearing.outer_diameter / 2 / (2 * around)
    mass = 7850 * math.pi / 4 * bearing.roller_diameter**2 * bearing.roller_length

    def place(t, azimuth):  # outward is 0 in this frame
        return pin * np.exp(1j * carrier * t) + around * np.exp(
            1j * ((carrier + cage) * t + azimuth - outward)
        )

    for azimuth in (0.0, 1.1, 3.9):
        before, now, after = (place(k * step, azimuth) for k in (-1, 0, 1))
        acceleration = (before - 2 * now + after) / step**2
        expected = -mass * (acceleration * np.exp(-1j * (azimuth - outward))).real
        (found,) = centrifugal_forces(
            bearing, np.array([azimuth]), 7850.0, pin, carrier, speed, outward
        )
        # the small clearance is in the pitch circle
        assert found == pytest.approx(expected, rel=1e-3)


def test_a_needle_at_92_mm_and_4000_rpm_is_pulled_with_15_newtons(article):
    needle = replace(bearing_and_loads(article)[0], roller_diameter=4e-3, roller_length=9.5e-3)
    carrier = 4000 * math.pi / 30
    still = -2 * carrier / (1 + needle.roller_diameter / needle.pitch_diameter)
    (force,) = centrifugal_forces(needle, np.zeros(1), 7850.0, 0.092, carrier, still, 0.0)
    assert force == pytest.approx(15.2, abs=0.1)  # 0.94 g in print


def test_unloaded_rollers_roll_under_the_force_of_rotation(talbot):
    def lost(**changes):
        return ep.solve(talbot.updated(changes)).losses["planet_bearing_mechanical"]

    fast = {"operation.speed": "11000 rpm", "planet.mass": "0.51 kg"}
    light = {"planet_bearing.material": talbot.planet_bearing.material.model_copy(
        update={"density": 1e-6}
    )}  # fmt: skip
    heavy = lost(**fast)
    assert heavy > 1.02 * lost(**fast, **light)
    assert lost(**fast | {"planet.mass": "0 kg"}) < heavy


def test_rollers_are_pressed_alone_by_what_exceeds_their_load(article):
    bearing, loads = bearing_and_loads(article)
    carried = loads.intensity.sum(axis=2) * bearing.slice_width
    forces = np.linspace(-3.0, 4.0, bearing.rollers_per_row)
    forces[np.argmax(carried > 0, axis=1)] = 1.25 * carried.max()  # those under the load
    alone = pressed_alone(loads, forces, bearing.roller_length)
    pressed = alone.intensity[:, :, 0] * bearing.roller_length
    assert (carried == 0).any()
    assert (pressed[carried > 0] > 0).any()
    assert pressed == pytest.approx(np.maximum(np.abs(forces) - carried, 0.0))


# --- least load and speed -------------------------------------------------------------------------


def test_least_load_and_speed_follow_from_the_rollers(article):
    bearing, _ = bearing_and_loads(article)
    least, fastest = minimum_load(rated(bearing), 0.0, 0.0), thermal_speed_rating(rated(bearing))
    # ISO 281 by hand: 2 rows of 16 rollers 4.015 x 9.52 mm on a pitch circle of 30.0 mm
    gamma = 4.015 / 30.008
    f_c = 172.6 * (1 + (1.04 * ((1 - gamma) / (1 + gamma)) ** (143 / 108)) ** 4.5) ** (-2 / 9)
    f_c *= gamma ** (2 / 9) * (1 - gamma) ** (29 / 27) / (1 + gamma) ** 0.25
    rating = 1.1 * f_c * (2 * 9.52) ** (7 / 9) * 16**0.75 * 4.015 ** (29 / 27)
    assert least == pytest.approx(0.02 * rating, rel=1e-3)
    barrels = minimum_load(rated(bearing, aligns_itself=True), 0.0, 0.0)
    assert barrels == pytest.approx(0.01 * 44 * (1 - gamma) * 2 * 16 * 9.52 * 4.015, rel=1e-3)
    # heat of 16 mW/mm2 on the seats at the reference speed (J35)
    static = 44 * (1 - gamma) * 2 * 16 * 9.52 * 4.015
    rpm = fastest * 30 / math.pi
    moment = 5e-7 * (12 * rpm) ** (2 / 3) * 30.008**3 + 0.0005 * 0.05 * static * 30.008
    seats = math.pi * 2 * 30.008 * 2 * 9.52
    assert moment * fastest == pytest.approx(16 * seats, rel=1e-3)


def test_loads_and_speeds_beyond_them_are_told(talbot):
    def told(**changes):
        notes = [it for it in ep.solve(talbot.updated(changes)).warnings if "by its rollers" in it]
        return [it.split(": the load")[0].split(" against")[0] for it in notes]

    quick = {
        "losses.sun_mesh_pocketing.include": False,
        "losses.ring_mesh_pocketing.include": False,
    }
    assert told(**quick) == []
    light = {"operation.torque": "7 N*m", "operation.speed": "900 rpm"}
    assert told(**quick, **light) == ["planet bearing"]
    (fast,) = told(**quick, **{"operation.torque": "900 N*m", "operation.speed": "6100 rpm"})
    assert fast.endswith("rpm")


def test_limiting_speed_of_planets_is_told(talbot):
    """490,000 mm/min caged, 320,000 without a cage, on the pitch circle of 30.008 mm."""
    quick = {
        "losses.sun_mesh_pocketing.include": False,
        "losses.ring_mesh_pocketing.include": False,
    }
    full = {"cage": "full-complement", "rollers_per_row": 23}
    full = {f"planet_bearing.{key}": value for key, value in full.items()}
    ratio = ep.solve(talbot.updated(quick)).bearing.speed * 30 / math.pi / 4000
    for changes, product in ((quick, 490e3), ({**quick, **full}, 320e3)):
        limit = product / 30.008
        for share in (0.99, 1.01):
            speed = f"{share * limit / ratio} rpm"
            warnings = ep.solve(talbot.updated({**changes, "operation.speed": speed})).warnings
            assert any("exceed the limiting speed of" in it for it in warnings) == (share > 1)
    stated = quick | {"planet_bearing.limiting_speed": f"{3900 * ratio} rpm"}
    told = [it for it in ep.solve(talbot.updated(stated)).warnings if "limiting speed of" in it]
    assert [("SKF" in note) for note in told] == [False]
