"""Forces of gear meshes on their shafts, and the reactions of the bearings."""

from __future__ import annotations

import math

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.machine.machine import GearSeat, ShaftLoad, Support, bearing_reactions, mesh_force

ROUNDING = 1e-12
"""Relative; sums and products of a few dozen numbers of like size."""
Z = np.array([0.0, 0.0, 1.0])


# --- bearing reactions ----------------------------------------------------------------------------


def moments_about(position, loads, supports, reactions):
    """Sum of all moments about a point of the axis, by cross products."""
    total = np.zeros(3)
    for load in loads:
        total += np.cross([0, 0, load.position - position], load.force)
        total += [*load.moment, 0.0]
    for support, reaction in zip(supports, reactions, strict=True):
        force = [reaction.x, reaction.y, reaction.z]
        total += np.cross([0, 0, support.position - position], force)
    return total


def random_loads(rng, count):
    return [
        ShaftLoad(rng.uniform(-1, 1), tuple(rng.normal(size=3) * 1e4), tuple(rng.normal(size=2)))
        for _ in range(count)
    ]


@pytest.mark.parametrize("seed", range(20))
def test_reactions_balance_random_loads(seed):
    rng = np.random.default_rng(seed)
    loads = random_loads(rng, rng.integers(1, 6))
    supports = [Support(rng.uniform(-1, -0.1)), Support(rng.uniform(0.1, 1), "both")]
    if seed % 2:
        supports.reverse()
    reactions = bearing_reactions(supports, loads)
    largest = sum(np.abs(load.force).sum() + np.abs(load.moment).sum() for load in loads)
    scale = largest * 10  # the shortest span is a tenth of the longest arm
    forces = sum(np.array(load.force) for load in loads)
    forces = forces + sum(np.array([r.x, r.y, r.z]) for r in reactions)
    assert np.abs(forces).max() < ROUNDING * scale
    for position in (-3.0, 0.0, 0.7):
        left = moments_about(position, loads, supports, reactions)
        assert np.abs(left[:2]).max() < ROUNDING * scale
    (locating,) = (number for number, s in enumerate(supports) if s.axial == "both")
    assert reactions[1 - locating].z == 0.0


def test_beam_by_hand():
    # 900 N down at a third of the span, and 300 N m about y: 600 and 300 N, and a couple of 100 N
    supports = [Support(0.0), Support(3.0)]
    first, second = bearing_reactions(supports, [ShaftLoad(1.0, (0.0, -900.0, 0.0))])
    assert (first.y, second.y) == pytest.approx((600.0, 300.0))
    assert first.force.radial == pytest.approx(600.0)
    first, second = bearing_reactions(supports, [ShaftLoad(1.0, (0.0, 0.0, 0.0), (0.0, 300.0))])
    # R_2x at 3 m turns about +y like F_x z, so it is negative against a positive moment
    assert (first.x, second.x) == pytest.approx((100.0, -100.0))
    first, second = bearing_reactions(supports, [ShaftLoad(1.0, (0.0, 0.0, 0.0), (300.0, 0.0))])
    assert (first.y, second.y) == pytest.approx((-100.0, 100.0))


def test_overhung_load():
    first, second = bearing_reactions(
        [Support(0.0), Support(1.0)], [ShaftLoad(2.0, (100.0, 0.0, 0.0))]
    )
    assert (first.x, second.x) == pytest.approx((100.0, -200.0))


@pytest.mark.parametrize(
    ("axial", "thrust", "expected"),
    [
        (("none", "none"), 10.0, (-10.0, 0.0)),
        (("none", "both"), 10.0, (0.0, -10.0)),
        (("both", "both"), 10.0, (-10.0, 0.0)),
        (("negative", "positive"), 10.0, (0.0, -10.0)),
        (("negative", "positive"), -10.0, (10.0, 0.0)),
        (("positive", "none"), 0.0, (0.0, 0.0)),
    ],
)
def test_axial_force_goes_to_the_locating_bearing(axial, thrust, expected):
    supports = [Support(0.0, axial[0]), Support(1.0, axial[1])]
    found = bearing_reactions(supports, [ShaftLoad(0.3, (0.0, 0.0, thrust))])
    assert tuple(reaction.z for reaction in found) == expected
    assert max(reaction.force.axial for reaction in found) == abs(thrust)


def test_one_bearing_carries_what_does_not_tilt_it():
    (found,) = bearing_reactions(
        [Support(0.5)], [ShaftLoad(0.2, (100.0, 7.0, 30.0)), ShaftLoad(0.8, (100.0, 7.0, 0.0))]
    )
    assert (found.x, found.y, found.z) == pytest.approx((-200.0, -14.0, -30.0))
    (idle,) = bearing_reactions([Support(0.5)], [])
    assert (idle.x, idle.y, idle.z) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("supports", "loads", "words"),
    [
        ([], [], "no bearing"),
        ([Support(0.0), Support(1.0), Support(2.0)], [], "give radial_force"),
        ([Support(1.0), Support(1.0)], [], "same position"),
        ([Support(0.0)], [ShaftLoad(0.1, (100.0, 0.0, 0.0))], "moment of 10 N·m remains"),
        ([Support(0.0)], [ShaftLoad(0.0, (1.0, 0.0, 0.0), (0.0, 2.0))], "moment of 2 N·m"),
        (
            [Support(0.0, "positive"), Support(1.0)],
            [ShaftLoad(0.1, (0.0, 0.0, -5.0))],
            "5 N in the negative sense",
        ),
    ],
)
def test_what_statics_cannot_give_is_refused(supports, loads, words):
    with pytest.raises(ValueError, match=words):
        bearing_reactions(supports, loads)


def test_axial_forces_that_cancel_are_none():
    """Of an idler: what rounding leaves needs no bearing that takes it."""
    supports = [Support(0.0, "positive"), Support(1.0)]
    loads = [ShaftLoad(0.3, (0.0, 0.0, axial)) for axial in (417.3, -417.3 * (1 + 1e-15))]
    assert sum(load.force[2] for load in loads) < 0
    assert [reaction.z for reaction in bearing_reactions(supports, loads)] == [0.0, 0.0]


@pytest.mark.parametrize(("held", "pushed"), [("positive", "negative"), ("negative", "positive")])
def test_a_shaft_that_no_bearing_holds_has_no_solution(held, pushed):
    torque = {"positive": "137 N*m", "negative": "-137 N*m"}[held]
    changes = {"bearings.motor_front.axial_sense": held, "operation.torque": torque}
    with pytest.raises(ep.ConvergenceError, match="motor_front, motor_rear") as told:
        ep.solve(ep.load_case("train-eaxle", changes))
    assert f"in the {pushed} sense; let one take it with axial_sense." in str(told.value)


# --- forces of a mesh -----------------------------------------------------------------------------

CASES = [
    (torque, hand, direction, internal)
    for torque in (250.0, -250.0)
    for hand in (1, -1)
    for direction in (0.0, 1.1, -2.5)
    for internal in (False, True)
]
RADIUS, ALPHA, TAN_BETA = 0.05, math.radians(22), math.tan(math.radians(17))


def flank_normal(radius, alpha, tan_beta, hand, direction, unwinding):
    """Normal of an explicit involute helicoid at the pitch point in `direction`.

    ``x + i y = r_b exp(i phi) (1 - i xi)`` with ``phi = phi_0 + xi + h z tan(beta_b)/r_b``. The
    sign of xi, `unwinding`, tells the two flanks apart.
    """
    base, tan_base = radius * math.cos(alpha), tan_beta * math.cos(alpha)
    xi = unwinding * math.tan(alpha)
    phi = direction + math.atan(xi)
    turn = np.exp(1j * phi)
    point = base * turn * (1 - 1j * xi)
    assert abs(point) == pytest.approx(radius)
    assert math.remainder(np.angle(point) - direction, math.tau) == pytest.approx(0, abs=1e-12)
    # d/dxi at constant z, and d/dz at constant xi
    along_profile = base * turn * xi
    along_lead = 1j * point * hand * tan_base / base
    first = np.array([along_profile.real, along_profile.imag, 0.0])
    second = np.array([along_lead.real, along_lead.imag, 1.0])
    return np.cross(first, second)


def test_the_helicoid_of_these_tests_is_one():
    # its two tangents against differences of its points
    def point(xi, z, hand=1):
        base, tan_base = RADIUS * math.cos(ALPHA), TAN_BETA * math.cos(ALPHA)
        turn = np.exp(1j * (xi + hand * z * tan_base / base))
        plane = base * turn * (1 - 1j * xi)
        return np.array([plane.real, plane.imag, z])

    xi, step = math.tan(ALPHA), 1e-6
    first = (point(xi + step, 0.0) - point(xi - step, 0.0)) / (2 * step)
    second = (point(xi, step) - point(xi, -step)) / (2 * step)
    start = point(xi, 0.0)
    direction = math.atan2(start[1], start[0])
    normal = flank_normal(RADIUS, ALPHA, TAN_BETA, 1, direction, 1)
    # central differences: step^2 over the square of the size, and rounding over the step
    assert np.cross(first, second) == pytest.approx(normal, rel=1e-6)


@pytest.mark.parametrize(("torque", "hand", "direction", "internal"), CASES)
def test_force_is_normal_to_the_flank(torque, hand, direction, internal):
    force = mesh_force(torque, RADIUS, ALPHA, TAN_BETA, hand, direction, internal=internal)
    # teeth that are pushed along +t have their material there: with external teeth behind the
    # involute that leans towards +t, in a ring behind the other one
    unwinding = (1 if torque > 0 else -1) * (-1 if internal else 1)
    normal = flank_normal(RADIUS, ALPHA, TAN_BETA, hand, direction, unwinding)
    sine = np.linalg.norm(np.cross(force, normal)) / (
        np.linalg.norm(force) * np.linalg.norm(normal)
    )
    assert sine < ROUNDING
    wrong = flank_normal(RADIUS, ALPHA, TAN_BETA, -hand, direction, unwinding)
    assert np.linalg.norm(np.cross(force, wrong)) > 0.1 * np.linalg.norm(force) * np.linalg.norm(
        wrong
    )


@pytest.mark.parametrize(("torque", "hand", "direction", "internal"), CASES)
def test_force_has_the_torque_and_presses_on_the_teeth(torque, hand, direction, internal):
    force = mesh_force(torque, RADIUS, ALPHA, TAN_BETA, hand, direction, internal=internal)
    outward = np.array([math.cos(direction), math.sin(direction), 0.0])
    found = np.cross(RADIUS * outward, force)
    assert found[2] == pytest.approx(torque, rel=ROUNDING)
    assert (force @ outward > 0) == internal
    assert force @ outward == pytest.approx(
        (1 if internal else -1) * abs(torque) / RADIUS * math.tan(ALPHA), rel=ROUNDING
    )


@pytest.mark.parametrize("ring", [False, True])
@pytest.mark.parametrize("torque", [80.0, -80.0])
def test_action_is_reaction(ring, torque):
    # gear 1 has external teeth; the axis of a ring lies on its other side
    direction, radius2 = 0.4, 0.13
    one = mesh_force(torque, RADIUS, ALPHA, TAN_BETA, 1, direction)
    if ring:  # torques of opposite sense, the same hand and direction to the pitch point
        other = mesh_force(
            -torque * radius2 / RADIUS, radius2, ALPHA, TAN_BETA, 1, direction, internal=True
        )
    else:
        other = mesh_force(
            torque * radius2 / RADIUS, radius2, ALPHA, TAN_BETA, -1, direction + math.pi
        )
    assert one + other == pytest.approx(np.zeros(3), abs=ROUNDING * np.linalg.norm(one) * 10)


def test_spur_gears_have_no_axial_force():
    force = mesh_force(100.0, 0.05, math.radians(20), 0.0, 1, 0.0)
    # e = x, t = y: 2000 N along y, 2000 tan 20 deg against x
    assert force == pytest.approx([-727.94, 2000.0, 0.0], abs=0.005)  # given to two decimals


def test_right_hand_gear_that_is_driven_forward_is_pushed_back():
    # like a right-handed screw turned by a nut at rest: the torque and the thrust are opposite
    assert mesh_force(100.0, 0.05, ALPHA, TAN_BETA, 1, 0.0)[2] < 0
    assert mesh_force(100.0, 0.05, ALPHA, TAN_BETA, -1, 0.0)[2] > 0


@pytest.mark.parametrize(("torque", "hand", "direction", "internal"), CASES)
def test_load_of_a_mesh_acts_at_its_pitch_point(torque, hand, direction, internal):
    at = (RADIUS, ALPHA, TAN_BETA, hand, direction)
    load = GearSeat("", 1.0, 0.2, *at, internal=internal, around=False).load(torque)
    force = mesh_force(torque, *at, internal=internal)
    pitch_point = RADIUS * np.array([math.cos(direction), math.sin(direction), 0.0])
    moment = np.cross(pitch_point, force)
    assert load.position == 0.2
    assert load.force == tuple(force)
    assert load.moment == pytest.approx(moment[:2], rel=ROUNDING)


def test_torque_does_not_load_the_bearings_of_a_symmetric_planet_ring():
    # three equal meshes a third of a turn apart: only the axial forces are left
    loads = [
        GearSeat("", 1.0, 0.3, RADIUS, ALPHA, TAN_BETA, 1, turn * math.tau / 3, False, False).load(
            50.0
        )
        for turn in range(3)
    ]
    found = bearing_reactions([Support(0.0, "both"), Support(1.0)], loads)
    one = np.linalg.norm(loads[0].force)
    for reaction in found:
        assert reaction.force.radial < 10 * ROUNDING * one
    assert found[0].z == pytest.approx(3 * 50.0 / RADIUS * TAN_BETA, rel=ROUNDING)


# --- bearings with contact angles -----------------------------------------------------------------

PUSHED = ShaftLoad(0.03, (2100.0, -900.0, 1700.0), (40.0, 70.0))


def pair(sense, ratios=(0.3125, 0.41), places=(0.0, 0.095), preload=0.0):
    """Two bearings that take forces in opposite senses, the first one in `sense`."""
    other = "negative" if sense == "positive" else "positive"
    return [
        Support(place, axial, ratio, preload)
        for place, axial, ratio in zip(places, (sense, other), ratios, strict=True)
    ]


@pytest.mark.parametrize("sense", ["positive", "negative"])
@pytest.mark.parametrize("thrust", [-9000.0, -600.0, 0.0, 130.0, 8000.0])
def test_bearings_with_contact_angles_press_each_other(sense, thrust):
    load = ShaftLoad(0.03, (2100.0, -900.0, thrust), (40.0, 70.0))
    supports = pair(sense)
    found = [reaction.force for reaction in bearing_reactions(supports, [load])]
    induced = [one.thrust_ratio * own.radial for one, own in zip(supports, found, strict=True)]
    sign = 1 if sense == "positive" else -1
    # F_1 - F_2 = K along the first; neither below what it induces, and one of the two at it
    assert found[0].axial - found[1].axial == pytest.approx(sign * thrust, rel=1e-9, abs=1e-9)
    over = [own.axial - least for own, least in zip(found, induced, strict=True)]
    assert min(over) == pytest.approx(0.0, abs=1e-9)
    assert max(over) >= 0


def test_mirrored_arrangements_give_mirrored_reactions():
    for sense in ("positive", "negative"):
        supports = pair(sense)
        found = bearing_reactions(supports, [PUSHED])
        # seen from the other end: z and y turn round, and each bearing takes the other sense
        turned = [
            Support(-one.position, pair(one.axial)[1].axial, one.thrust_ratio) for one in supports
        ]
        x, y, z = PUSHED.force
        seen = ShaftLoad(-0.03, (x, -y, -z), (PUSHED.moment[0], -PUSHED.moment[1]))
        for own, mirrored in zip(found, bearing_reactions(turned, [seen]), strict=True):
            assert (own.x, -own.y, -own.z) == pytest.approx((mirrored.x, mirrored.y, mirrored.z))


def test_preload_is_shared_until_one_bearing_is_free():
    axial = [
        [own.force.axial for own in bearing_reactions(pair("positive", preload=preload), [PUSHED])]
        for preload in (0.0, 3000.0, 5000.0)
    ]
    assert axial[1] == pytest.approx([3000 + 850, 3000 - 850])
    assert axial[2] == pytest.approx([5000 + 850, 5000 - 850])
    # beyond twice the preload one bearing has only what its radial force induces
    pulled = ShaftLoad(0.03, (2100.0, -900.0, 30e3), (40.0, 70.0))
    first, second = bearing_reactions(pair("positive", preload=3000.0), [pulled])
    assert second.force.axial == pytest.approx(0.41 * second.force.radial)
    assert first.force.axial == pytest.approx(30e3 + second.force.axial)


def test_one_angular_bearing_against_a_locating_one():
    supports = [Support(0.0, "positive", 0.5), Support(0.2, "both")]
    load = ShaftLoad(0.05, (0.0, 4000.0, -100.0))
    angular, ball = bearing_reactions(supports, [load])
    assert angular.force.axial == pytest.approx(0.5 * 3000)
    assert ball.z == pytest.approx(1600)
