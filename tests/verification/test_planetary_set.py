"""The whole set: sums, shares, balances and closed forms, under the loads of a set without losses.

Loads with losses: test_loads_with_losses.py.
"""

from __future__ import annotations

import itertools
import json
import math

import pytest

import epicyclic as ep
from reference.gear_loss import equal_sharing_loss_factor
from reference.planetary import planetary_efficiency

ROUNDING = 1e-10  # relative; sums of losses, powers a hundred times as large

MEMBERS = ("sun", "ring", "carrier")
CHOICES = list(itertools.permutations(MEMBERS, 2))
PER_PLANET = (
    "sun_mesh_sliding",
    "sun_mesh_rolling",
    "ring_mesh_sliding",
    "ring_mesh_rolling",
    "planet_bearing_mechanical",
    "planet_bearing_viscous",
)
ALL_LOSSES = (
    *PER_PLANET,
    "sun_mesh_pocketing",
    "ring_mesh_pocketing",
    "sun_drag",
    "ring_drag",
    "carrier_drag",
    "planets_drag",
    "thrust_bearing_viscous",
)


@pytest.fixture(scope="module")
def talbot():
    """The test article, with the loads that the laws here are about."""
    return ep.load_case("talbot-2012").updated(
        {"models.mesh_loads": "without-losses", "planet.mass": "0 kg"}
    )


@pytest.fixture(scope="module")
def full(talbot):
    """The test article with every loss that is modelled."""
    return talbot.updated({"thrust_bearing": {"mean_diameter": "90 mm"}, "planet.mass": "0.25 kg"})


def assert_consistent(result):
    losses = result.losses
    assert all(math.isfinite(loss) and loss >= 0 for loss in losses.values())
    assert result.total == pytest.approx(sum(losses.values()), rel=ROUNDING)
    assert result.total == pytest.approx(
        result.load_dependent + result.load_independent, rel=ROUNDING
    )
    powers = [member.power for member in result.flow.members.values()]
    size = max(map(abs, powers), default=0.0)
    assert sum(powers) == pytest.approx(result.total, abs=ROUNDING * max(size, 1.0))
    if result.efficiency is not None:
        assert 0 <= result.efficiency <= 1
    text = result.to_json()
    assert json.loads(text)["total"] == pytest.approx(result.total, rel=1e-12)


# --- sums -----------------------------------------------------------------------------------------


def test_terms_sum_to_the_total(full):
    result = ep.solve(full)
    assert_consistent(result)
    for name in ALL_LOSSES:
        if name != "ring_drag":  # the ring is held
            assert result.losses[name] > 0, name
    by_group = {"load-dependent": 0.0, "load-independent": 0.0}
    for term in result.terms:
        by_group[term.group] += term.watts
    assert by_group["load-dependent"] == pytest.approx(result.load_dependent, rel=ROUNDING)
    # Talbot (2012), Eq. 1.2 and 1.3
    load_dependent = {term.name for term in result.terms if term.group == "load-dependent"}
    assert load_dependent == set(PER_PLANET) - {"planet_bearing_viscous"}


def test_losses_of_a_pair_sum_to_the_total():
    pair = ep.load_case("talbot-2012-pair").updated({"operation.torque": "150 N*m"})
    result = ep.solve(pair)
    assert_consistent(result)
    assert result.losses["mesh_sliding"] > 0
    assert result.losses["drag"] > 0


@pytest.mark.parametrize("name", ALL_LOSSES)
def test_factor_and_include_act_on_their_term_alone(full, name):
    full = full.updated({"operation.fixed": "carrier"})  # all but the carrier turn
    if name == "carrier_drag":
        full = full.updated({"operation.fixed": "ring"})
    base = ep.solve(full)
    assert base.losses[name] > 0 or name == "thrust_bearing_viscous"
    doubled = ep.solve(full.updated({f"losses.{name}.factor": 2.0}))
    left_out = ep.solve(full.updated({f"losses.{name}.include": False}))
    for other in ALL_LOSSES:
        times = 2 if other == name else 1
        assert doubled.losses[other] == pytest.approx(times * base.losses[other], rel=ROUNDING)
        times = 0 if other == name else 1
        assert left_out.losses[other] == pytest.approx(times * base.losses[other], rel=ROUNDING)
    assert left_out.total == pytest.approx(base.total - base.losses[name], rel=ROUNDING)
    assert_consistent(doubled)
    assert_consistent(left_out)


# --- number of planets ----------------------------------------------------------------------------


def test_load_dependent_losses_grow_with_the_planets_at_the_same_branch_torque(talbot):
    one = ep.solve(talbot.updated({"planet.count": 1, "operation.torque": "200 N*m"}))
    for count in (2, 3, 4, 5, 6):
        many = ep.solve(
            talbot.updated({"planet.count": count, "operation.torque": f"{200 * count} N*m"})
        )
        for name in PER_PLANET:
            assert many.losses[name] == pytest.approx(count * one.losses[name], rel=ROUNDING)
        for name in ("sun_drag", "carrier_drag"):
            assert many.losses[name] == one.losses[name]
        assert many.meshes["sun_mesh"].hertz_pressure_max == pytest.approx(
            one.meshes["sun_mesh"].hertz_pressure_max, rel=ROUNDING
        )


def test_more_planets_at_the_same_torque_lower_the_pressures(talbot):
    even = talbot.updated({"models.load_distribution": "uniform"})
    three, six = (ep.solve(even.updated({"planet.count": count})) for count in (3, 6))
    ratio = three.meshes["sun_mesh"].hertz_pressure_max / six.meshes["sun_mesh"].hertz_pressure_max
    assert ratio == pytest.approx(math.sqrt(2), rel=ROUNDING)
    assert six.bearing.radial_force == pytest.approx(three.bearing.radial_force / 2, rel=ROUNDING)


# --- every way to drive it ------------------------------------------------------------------------


@pytest.mark.parametrize(("driver", "held"), CHOICES)
@pytest.mark.parametrize("torque", [800.0, -800.0])
@pytest.mark.parametrize("speed", [2000.0, -2000.0])
def test_every_choice_of_input_and_fixed_member(full, driver, held, torque, speed):
    case = full.updated(
        {
            "operation.input": driver,
            "operation.fixed": held,
            "operation.torque": f"{torque} N*m",
            "operation.speed": f"{speed} rpm",
        }
    )
    result = ep.solve(case)
    assert_consistent(result)
    member = result.flow.members[driver]
    assert member.torque == pytest.approx(torque, rel=1e-12)
    assert result.flow.members[held].speed == 0.0
    # signs do not change the losses, but for the pockets, where driving and coasting differ
    mirrored = case.updated(
        {"operation.torque": f"{abs(torque)} N*m", "operation.speed": f"{abs(speed)} rpm"}
    )
    losses = ep.solve(mirrored).losses
    if torque * speed < 0:
        for name in ("sun_mesh_pocketing", "ring_mesh_pocketing"):
            assert losses.pop(name) == pytest.approx(result.losses[name], rel=0.2)
    assert {name: result.losses[name] for name in losses} == pytest.approx(losses, rel=ROUNDING)


@pytest.mark.parametrize(("driver", "second"), CHOICES)
@pytest.mark.parametrize("rpm", [700.0, -700.0, 5000.0])
def test_two_driven_members(full, driver, second, rpm):
    result = ep.solve(
        full.updated(
            {
                "operation.input": driver,
                "operation.fixed": None,
                "operation.second_input": second,
                "operation.second_speed": f"{rpm} rpm",
                "operation.speed": "2000 rpm",
            }
        )
    )
    assert_consistent(result)
    assert result.flow.members[second].speed == pytest.approx(rpm * math.pi / 30, rel=1e-12)


def test_losses_depend_on_speeds_relative_to_the_carrier_only(talbot):
    """All members turned faster by the same speed: meshes and bearings do not notice."""
    base = ep.solve(talbot)
    speeds = {name: member.speed * 30 / math.pi for name, member in base.flow.members.items()}
    turned = ep.solve(
        talbot.updated(
            {
                "operation.fixed": None,
                "operation.speed": f"{speeds['sun'] + 1000!r} rpm",
                "operation.second_input": "ring",
                "operation.second_speed": f"{speeds['ring'] + 1000!r} rpm",
            }
        )
    )
    for name in PER_PLANET:
        assert turned.losses[name] == pytest.approx(base.losses[name], rel=ROUNDING)
    assert turned.losses["sun_drag"] > base.losses["sun_drag"]


@pytest.mark.parametrize("rpm", [4000.0, 4000.001, 3999.0])
def test_set_in_lock_up_or_next_to_it_has_hardly_more_than_drag(talbot, rpm):
    result = ep.solve(
        talbot.updated(
            {
                "operation.fixed": None,
                "operation.second_input": "ring",
                "operation.second_speed": f"{rpm} rpm",
            }
        )
    )
    for name in PER_PLANET:
        assert result.losses[name] <= 1.0 * abs(rpm - 4000.0)  # W for each rpm between sun and ring
    assert result.losses["carrier_drag"] > 0
    assert_consistent(result)
    # The carrier takes the torques of sun and ring and 1.3 N m of drag; rolling slowly, the meshes
    # keep 0.85 % back.
    assert result.flow.members["carrier"].torque == pytest.approx(-1000 * 198 / 73, rel=0.015)


def test_standstill_and_no_load(talbot):
    at_rest = ep.solve(talbot.updated({"operation.speed": "0 rpm"}))
    assert all(loss == 0.0 for loss in at_rest.losses.values())
    assert at_rest.efficiency is None
    assert_consistent(at_rest)
    idle = ep.solve(talbot.updated({"operation.torque": "0 N*m"}))
    for name in PER_PLANET[:-1]:
        assert idle.losses[name] == 0.0
    assert idle.load_independent > 0
    assert idle.efficiency == 0.0
    assert_consistent(idle)


# --- efficiency -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("driver", "held"), CHOICES)
def test_efficiency_is_that_of_the_textbook(talbot, driver, held):
    """Constant friction and Ohlendorf's factors: closed form of the whole set."""
    friction = 0.06
    changes = {f"losses.{name}.include": False for name in ALL_LOSSES if "sliding" not in name}
    result = ep.solve(
        talbot.updated(
            {
                "operation.input": driver,
                "operation.fixed": held,
                "operation.torque": "500 N*m",
                "models.friction": "constant",
                "models.constant_friction": friction,
                "models.mesh": "loss-factor",
                **changes,
            }
        )
    )
    # contact ratios and base helix angle worked out separately, four digits
    helix = math.radians(12.109)
    sun = equal_sharing_loss_factor(73, 26, 0.7515, 0.6127, helix)
    ring = equal_sharing_loss_factor(26, 125, 0.6127, 0.7541, helix, internal=True)
    expected = planetary_efficiency(73, 125, friction * (sun + ring), held)
    # contact ratios rounded to 0.5e-4 change the loss by 1e-4 of itself
    assert 1 - result.efficiency == pytest.approx(1 - expected, rel=3e-4)


def test_local_method_on_a_spur_set_is_the_textbook():
    """The same from contact lines, through a case of standard spur gears."""
    gear = {"face_width": "25 mm", "profile_shift_coefficient": 0.0, "roughness": "0.4 um"}
    case = ep.load_case(
        {
            "kind": "planetary",
            "operation": {
                "input": "sun",
                "fixed": "ring",
                "torque": "300 N*m",
                "speed": "1500 rpm",
                "oil_inlet_temperature": "60 degC",
            },
            "gears": {
                "normal_module": "2 mm",
                "normal_pressure_angle": "20 deg",
                "helix_angle": "0 deg",
                "center_distance": "60 mm",
                "addendum_coefficient": 0.9,
            },
            "sun": {"teeth": 30, **gear},
            "planet": {"count": 4, "teeth": 30, **gear},
            "ring": {"teeth": 90, **gear},
            "lubricant": {"oil": "iso-vg-100-mineral"},
            "models": {
                "friction": "constant",
                "constant_friction": 0.05,
                "load_distribution": "uniform",
            },
            "losses": {name: {"include": "sliding" in name} for name in ALL_LOSSES},
        }
    )
    result = ep.solve(case)
    alpha, pitch = math.radians(20), math.pi * 2 * math.cos(math.radians(20))

    def tip_ratio(teeth, tip, internal=False):
        base = teeth * math.cos(alpha)
        length = math.sqrt(tip**2 - base**2) - teeth * math.sin(alpha)
        return (-length if internal else length) / pitch

    small, large = tip_ratio(30, 31.8), tip_ratio(90, 88.2, internal=True)
    sun = equal_sharing_loss_factor(30, 30, small, small)
    ring = equal_sharing_loss_factor(30, 90, small, large, internal=True)
    expected = planetary_efficiency(30, 90, 0.05 * (sun + ring), "ring")
    # 20 mesh positions: 0.17 % of the loss at most on spur gears, times 1.5
    assert 1 - result.efficiency == pytest.approx(1 - expected, rel=0.0025)


def test_sliding_loss_is_linear_in_the_torque_for_constant_friction(talbot):
    case = talbot.updated({"models.friction": "constant", "models.load_distribution": "uniform"})
    one, five = (
        ep.solve(case.updated({"operation.torque": f"{torque} N*m"})) for torque in (200, 1000)
    )
    for name in ("sun_mesh_sliding", "ring_mesh_sliding"):
        assert five.losses[name] == pytest.approx(5 * one.losses[name], rel=ROUNDING)


def test_elastic_teeth_change_the_loss_of_a_helical_set_little(talbot):
    """Elastic teeth load the long contact lines of a helical set nearly evenly, but for their ends:
    the sliding loss stays that of the even load within 1 %, as the overlap ratio is near 1."""
    even = ep.solve(talbot.updated({"models.load_distribution": "uniform"}))
    elastic = ep.solve(talbot)
    for name in ("sun_mesh_sliding", "ring_mesh_sliding"):
        assert elastic.losses[name] == pytest.approx(even.losses[name], rel=0.01)
        assert elastic.losses[name] != even.losses[name]


@pytest.mark.parametrize("celsius", [40, 90])
def test_losses_rise_with_torque_and_speed(talbot, celsius):
    case = talbot.updated({"operation.oil_inlet_temperature": f"{celsius} degC"})
    for key, unit, values in (
        ("operation.torque", "N*m", (250, 500, 750, 1000)),
        ("operation.speed", "rpm", (1000, 2000, 3000, 4000)),
    ):
        totals = [ep.solve(case.updated({key: f"{value} {unit}"})).total for value in values]
        assert totals == sorted(totals)
        assert totals[0] < 0.9 * totals[-1]


def test_result_does_not_depend_on_what_was_solved_before(talbot):
    """Caches hold no state of other cases."""
    first = ep.solve(talbot).losses
    for torque in (10, 5000):
        ep.solve(talbot.updated({"operation.torque": f"{torque} N*m", "planet.count": 5}))
    assert ep.solve(talbot).losses == first
    assert ep.solve(ep.load_case(talbot.inputs())).losses == pytest.approx(first, rel=1e-9)


@pytest.mark.slow
def test_resolution_of_the_default_is_enough(talbot):
    coarse = ep.solve(talbot).losses
    fine = ep.solve(
        talbot.updated(
            {
                "numerics.mesh_positions": 100,
                "numerics.contact_segments": 100,
                "numerics.bearing_slices": 200,
            }
        )
    ).losses
    # measured: meshes 0.13 % (load peaks at the ends of the lines), bearing 0.16 % (kinks of load
    # and crown within a slice); times 1.5
    for name in PER_PLANET[:4]:
        assert coarse[name] == pytest.approx(fine[name], rel=2e-3)
    assert coarse["planet_bearing_mechanical"] == pytest.approx(
        fine["planet_bearing_mechanical"], rel=2.4e-3
    )


@pytest.mark.parametrize("rolling", ["mixed-ehl", "goksem-hargreaves"])
@pytest.mark.parametrize(
    "oil", ["atf-talbot-2012", "75w-90-gear-oil", "iso-vg-32-pao", "iso-vg-680-mineral"]
)
def test_losses_go_to_those_of_no_load(talbot, oil, rolling):
    case = talbot.updated({"lubricant.oil": oil, "models.rolling": rolling})
    idle = ep.solve(case.updated({"operation.torque": "0 N*m"})).total
    excess = [
        ep.solve(case.updated({"operation.torque": torque})).total - idle
        for torque in ("1e-2 N*m", "1e-4 N*m", "1e-6 N*m", "1e-8 N*m")
    ]
    assert excess[1] < 0.01 * idle
    # the rolling force of rigid cylinders falls with the root of the load, all others with the load
    # itself: at a hundredth of the torque a tenth or less is left, but for the heating of the inlet
    # between the first two and the rounding of the idle loss
    for larger, smaller in itertools.pairwise(excess):
        assert smaller < 0.11 * larger + 1e-12 * idle


@pytest.mark.parametrize(
    "changes",
    [
        {"operation.oil_inlet_temperature": "-20 degC"},
        {"operation.oil_inlet_temperature": "-40 degC"},
        {
            "lubricant.oil": "iso-vg-320-mineral",
            "operation.oil_inlet_temperature": "20 degC",
            "models.rolling": "mixed-ehl",
            "models.bearing": "mixed-ehl",
        },
    ],
)
def test_thick_oil_keeps_the_losses_bounded(talbot, changes):
    losses = ep.solve(talbot.updated(changes)).losses
    for name in ("sun_mesh_rolling", "ring_mesh_rolling", "planet_bearing_mechanical"):
        assert losses[name] < 20e3  # W; 0.3 to 2 kW at 0 degC, and 419 kW pass through
