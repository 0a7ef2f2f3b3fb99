"""Tilt of the planet in its bearing, coupled with the load along the teeth."""

from __future__ import annotations

import json
import lzma
import math
from pathlib import Path

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.build.gear_sets import roller_bearing
from epicyclic.build.machine import build
from epicyclic.losses.planet_bearing import roller_loads
from epicyclic.machine.gear_mesh import elastic_loads
from epicyclic.machine.planets import PlanetContact, _tilt_by_newton, _tilt_one_by_one, planet_load


@pytest.fixture(scope="module")
def talbot():
    return ep.load_case("talbot-2012").updated(
        {
            "models.planet_tilt": "coupled",
            "models.mesh_loads": "without-losses",
            "planet.mass": "0 kg",
        }
    )


def misalignments(case):
    """Of sun and ring mesh. [um]"""
    return [duty.gears.deviations.misalignment * 1e6 for duty in loaded_duties(case).values()]


def loaded_duties(case):
    built = build(case)
    return built.loaded_duties(built.loaded_state())


def test_bearing_and_meshes_are_in_balance(talbot):
    """The moments of the line loads, summed here, tilt the bearing by the misalignment found."""
    duties = loaded_duties(talbot).values()
    moments = []
    for key, mesh in ep.loaded_meshes(talbot).items():
        height = mesh.compliance.lines.face_position - 24.4e-3 / 2
        beta_b = math.radians(12.109)  # sin(beta_b) = sin(13.124 deg) cos(22.5 deg)
        force = mesh.line_load * mesh.compliance.lines.length * math.cos(beta_b)
        assert force.sum(axis=(1, 2)) == pytest.approx(mesh.force, rel=1e-4), key
        moments.append(float((force * height).sum(axis=(1, 2)) @ mesh.compliance.lines.weight))
    sun, ring = duties
    contacts = [PlanetContact(sun, 2, 1j, 1), PlanetContact(ring, 1, -1j, -1)]
    load = planet_load(contacts, 0.0, moments)
    bearing = roller_bearing(talbot.planet_bearing, talbot.numerics)
    tilt = roller_loads(bearing, load.force, 0.0, load.moment_x, load.moment_y).displacement[2:]
    # the radial force lies along the circle of the planets but for the difference of the meshes'
    # pressure angles, which are equal here: x is t, y is r
    alpha = math.radians(23.011)
    for duty, outward in zip(duties, (1, -1), strict=True):
        expected = 24.4e-3 * (tilt[0] * math.cos(alpha) + outward * tilt[1] * math.sin(alpha))
        assert duty.gears.deviations.misalignment == pytest.approx(expected, rel=1e-3)


def test_planet_opens_the_sun_mesh_where_contact_ends_and_the_ring_mesh_where_it_begins(talbot):
    sun, ring = misalignments(talbot)
    assert sun > 1.0
    assert ring < -1.0


def test_teeth_carry_back_part_of_the_couple(talbot):
    rigid = ep.solve(talbot.updated({"models.planet_tilt": "left-out"}))
    tilted = ep.solve(talbot)
    assert tilted.bearing.moment < rigid.bearing.moment
    assert tilted.meshes["sun_mesh"].misalignment * 1e6 == pytest.approx(misalignments(talbot)[0])
    assert rigid.meshes["sun_mesh"].misalignment == 0.0
    for name, mesh in tilted.meshes.items():
        assert mesh.line_load_max > rigid.meshes[name].line_load_max


def test_more_clearance_more_tilt(talbot):
    sizes = [
        misalignments(talbot.updated({"planet_bearing.diametral_clearance": clearance}))[0]
        for clearance in ("0 um", "10 um", "40 um")
    ]
    assert sizes == sorted(sizes)
    assert sizes[2] > 1.2 * sizes[0]


def test_misalignment_of_the_case_is_added(talbot):
    """A gear set made askew turns its planets, but not as far as to undo it."""
    alone = misalignments(talbot)[0]
    both = misalignments(talbot.updated({"sun_mesh.misalignment": "20 um"}))[0]
    assert alone < both < alone + 20


def test_spur_planets_stand_straight():
    case = ep.load_case("talbot-2012").updated(
        {
            "models.planet_tilt": "coupled",
            "gears.helix_angle": "0 deg",
            "gears.normal_module": None,
            "gears.transverse_module": "1.8616 mm",
            "gears.normal_pressure_angle": None,
            "gears.transverse_pressure_angle": "23.041 deg",
        }
    )
    assert misalignments(case) == pytest.approx([0.0, 0.0], abs=1e-3)


def test_no_torque_no_tilt(talbot):
    assert misalignments(talbot.updated({"operation.torque": "0 N*m"})) == [0.0, 0.0]


def test_torque_and_speed_may_have_any_sign(talbot):
    there = misalignments(talbot)
    for changes in ({"operation.torque": "-1000 N*m"}, {"operation.speed": "-4000 rpm"}):
        # the face width is counted from the end where contact begins
        back = [-value for value in misalignments(talbot.updated(changes))]
        assert back == pytest.approx(there, rel=1e-6)


@pytest.mark.parametrize("torque", ["0.01 N*m", "10 N*m", "10000 N*m"])
def test_balance_is_found_at_any_load(talbot, torque):
    case = talbot.updated({"operation.torque": torque})
    assert all(math.isfinite(value) for value in misalignments(case))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"models.load_distribution": "uniform"}, "compliance"),
        ({"planet_bearing": None}, "planet_bearing"),
    ],
)
def test_what_the_tilt_needs(talbot, changes, words):
    with pytest.raises(ep.InputError, match=words):
        talbot.updated(changes)


def test_shares_are_those_of_straight_planets(talbot):
    """The branch stiffness of load sharing leaves the tilt out."""
    changes = {
        "planet.count": 6,
        "load_sharing.method": "direct",
        "load_sharing.position_errors": ["10 um", *["0 um"] * 5],
    }
    straight = talbot.updated({**changes, "models.planet_tilt": "left-out"})
    coupled = ep.solve(talbot.updated(changes))
    assert coupled.planet_shares == ep.solve(straight).planet_shares
    assert misalignments(talbot.updated(changes))[0] > misalignments(straight)[0]


FROZEN = Path(__file__).parents[1] / "frozen" / "results.json.xz"


@pytest.mark.slow
@pytest.mark.parametrize("share", [1.0, 0.01, 1e-5])
@pytest.mark.parametrize("number", ["001", "004", "019", "055", "103", "157", "175", "181"])
def test_tilt_is_found_in_drawn_sets_down_to_light_loads(number, share):
    """Sets in which it was not found, at one of these loads at least; moments must balance."""
    tables = json.loads(lzma.decompress(FROZEN.read_bytes()))["cases"][f"planetary-{number}"]
    case = ep.load_case(tables["case"])
    torque = share * case.operation.torque
    case = case.updated(
        {
            "models.planet_tilt": "coupled",
            "models.load_distribution": "compliance",
            "models.mesh_loads": "without-losses",
            "load_sharing.method": "equal",
            "operation.torque": f"{torque!r} N*m",
        }
    )
    built = build(case)
    (planet,) = built.sets[""].planets
    state = built.state()
    duties = {duty.gears.key: duty for duty in built.sets[""].mean_duties(state)}
    tilted, load = planet.load(duties, state.speeds["carrier"])
    moments = [
        own.mean((own.line_load * own.compliance.lines.length * height).sum(axis=(1, 2)))
        * math.cos(duty.gears.mesh.gear1.rack.base_helix_angle)
        for duty in tilted
        for own in (elastic_loads(duty),)
        for height in (own.compliance.lines.face_position - duty.gears.mesh.face_width / 2,)
    ]
    contacts = planet._contacts({duty.gears.key: duty for duty in tilted})
    signed = [contact.face_sense * m for contact, m in zip(contacts, moments, strict=True)]
    outward = planet.centrifugal(state.speeds["carrier"])
    balanced = planet_load(contacts, outward, signed)
    scale = load.force * tilted[0].gears.mesh.face_width
    assert load.moment_x == pytest.approx(balanced.moment_x, abs=1e-4 * scale)
    assert load.moment_y == pytest.approx(balanced.moment_y, abs=1e-4 * scale)


def resistance(steep, soft, coupling, play):
    """Excess of moments that rises with the tilt: next to nothing within the play, then steeply."""

    def excess(tilts):
        beyond = np.sign(tilts) * np.maximum(np.abs(tilts) - play, 0.0)
        common = tilts[0] + tilts[1]
        return soft * tilts + steep * beyond * np.abs(beyond) ** 0.11 + coupling * common - (7, -3)

    return excess


@pytest.mark.parametrize("play", [0.0, 4e-4])
@pytest.mark.parametrize("coupling", [0.0, 900.0, 2e5])
def test_newton_and_brackets_find_the_same_tilt(coupling, play):
    """Also beyond a play, in which next to nothing resists."""
    excess = resistance(4e4, 31.0, coupling, play)
    calls = []

    def counted(tilts):
        calls.append(tilts)
        return excess(tilts)

    quick = _tilt_by_newton(counted, 5e-4)
    newton = len(calls)
    slow = _tilt_one_by_one(counted, 5e-4)
    assert quick == pytest.approx(slow, rel=1e-5, abs=1e-11)
    assert excess(quick) == pytest.approx(0.0, abs=1e-4)
    assert 5 * newton < len(calls) - newton


def test_newton_leaves_what_nothing_resists_to_the_brackets():
    assert _tilt_by_newton(lambda tilts: np.zeros(2) - (0.2, 0.1), 5e-4) is None
