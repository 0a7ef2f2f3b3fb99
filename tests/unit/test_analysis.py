"""What `solve` adds to the loss models: loads, options, notes, and the form of its result."""

from __future__ import annotations

import io
import json
import math

import pytest
from rich.console import Console

import epicyclic as ep
from epicyclic.build.machine import build
from epicyclic.build.models import set_cases
from epicyclic.show.details import result_tables
from epicyclic.study.friction import compare_friction


def set_of(case):
    """The only set of a case."""
    return set_cases(case)[""]


IDENTITY = 1e-12  # rounding only


@pytest.fixture(scope="module")
def case():
    return ep.load_case("talbot-2012")


def solve(case, **changes):
    return ep.solve(case.updated({key.replace("__", "."): v for key, v in changes.items()}))


def test_bearing_load_is_that_of_the_printed_equations(case):
    """Talbot (2012), Eq. 3.7 and 3.8, with operating radii."""
    load = build(case.updated({"planet.mass": "0 kg"})).planet_loads()["planet_bearing"]
    branch = 1000 / 3
    sun_radius = 0.09213 * 73 / 99
    planet_radius = 0.09213 * 26 / 99
    reference = 73 * 1.813e-3 / (2 * math.cos(math.radians(13.124)))
    tangent = math.tan(math.radians(13.124)) * sun_radius / reference
    assert load.force == pytest.approx(2 * branch / sun_radius, rel=IDENTITY)
    assert load.moment_y == pytest.approx(load.force * planet_radius * tangent, rel=1e-9)
    # equal pressure angles: the radial forces cancel, and the couple is across the load
    assert load.moment_x == pytest.approx(0.0, abs=1e-9 * load.moment_y)


def test_centrifugal_force_turns_the_load_and_not_the_couple(case):
    plain = build(case.updated({"planet.mass": "0 kg"})).planet_loads()["planet_bearing"]
    heavy = build(case.updated({"planet.mass": "5000 g"}))
    loaded = heavy.planet_loads()["planet_bearing"]
    force = 5.0 * case.gears.center_distance * heavy.state().speeds["carrier"] ** 2
    assert loaded.force == pytest.approx(math.hypot(plain.force, force), rel=1e-9)
    assert math.hypot(loaded.moment_x, loaded.moment_y) == pytest.approx(plain.moment_y)
    assert math.atan2(loaded.moment_x, loaded.moment_y) == pytest.approx(
        math.atan2(force, plain.force)
    )


def test_planet_mass_loads_the_bearing(case):
    case = case.updated({"models.mesh_loads": "without-losses"})
    result = solve(case, planet__mass="0.2 kg")
    speed = result.flow.members["carrier"].speed
    light = solve(case, planet__mass="0 kg")
    expected = math.hypot(light.bearing.radial_force, 0.2 * 0.09213 * speed**2)
    assert result.bearing.radial_force == pytest.approx(expected, rel=1e-9)
    idle = solve(case, planet__mass="0.2 kg", operation__torque="0 N*m")
    assert idle.losses["planet_bearing_mechanical"] > 0


def test_mass_that_is_not_given_is_that_of_gear_and_rollers(case):
    """A disc to the reference circle less the bore of 34.025 mm, 24.4 mm wide, and 32 rollers of
    4.015 mm by 9.52 mm, of 7850 kg/m3."""
    z, module = 26, 1.813 / math.cos(math.radians(13.124))
    disc = math.pi / 4 * ((z * module) ** 2 - 34.025**2) * 24.4
    rollers = 32 * math.pi / 4 * 4.015**2 * 9.52
    mass = 7850e-9 * (disc + rollers)
    given = case.updated({"planet.mass": f"{mass!r} kg"})
    one, two = (build(each).planet_loads()["planet_bearing"].force for each in (case, given))
    light = build(case.updated({"planet.mass": "0 kg"})).planet_loads()["planet_bearing"].force
    assert one == pytest.approx(two, rel=1e-9)
    assert one > light * (1 + 1e-4)


def test_estimated_mass_is_told_where_it_matters(case):
    def told(**changes):
        return [note for note in solve(case, **changes).notes if "mass of a planet" in note]

    assert told() == []
    (note,) = told(operation__torque="20 N*m")
    assert "N on the bearing" in note
    assert told(operation__torque="20 N*m", planet__mass="0.2 kg") == []


def test_defaults_of_the_models_follow_the_oil(case):
    keys = ("friction", "rolling", "bearing")
    general = set_of(case).chosen
    assert [general[key] for key in keys[:2]] == ["mixed-lubrication", "goksem-hargreaves"]
    case = case.updated({"models.preset": "talbot-2012"})
    assert set_of(case).chosen["friction"] == "mixed-ehl"
    formulas = ["schlenk", "goksem-hargreaves", "palmgren"]
    fitted = set_of(case.updated({"lubricant.oil": "iso-vg-100-mineral"})).chosen
    assert [fitted[key] for key in keys] == [f"fitted-or-{name}" for name in formulas]
    chosen = set_of(case.updated({"lubricant.oil": "iso-vg-46-mineral"})).chosen
    assert [chosen[key] for key in keys] == ["schlenk", "contained", "palmgren"]


def test_a_regression_used_for_another_oil_is_noted(case):
    result = solve(
        case, lubricant__oil="iso-vg-32-mineral", models__friction="mixed-ehl",
        models__bearing="mixed-ehl",
    )  # fmt: skip
    noted = [note for note in result.notes if "not for iso-vg-32-mineral" in note]
    assert len(noted) == 2
    assert not [note for note in ep.solve(case).notes if "not for" in note]
    assert any("75W-90" in note for note in solve(case, models__friction="xu-2007").notes)


def test_palmgren_is_the_printed_formula(case):
    case = case.updated({"models.mesh_loads": "without-losses", "planet.mass": "0 kg"})
    result = solve(case, models__bearing="palmgren")
    bearing = result.bearing
    expected = 3 * 0.0003 * bearing.radial_force * 30.008e-3 * bearing.speed
    assert result.losses["planet_bearing_mechanical"] == pytest.approx(expected, rel=IDENTITY)
    full = solve(case, planet_bearing__cage="full-complement")
    assert full.losses["planet_bearing_mechanical"] == pytest.approx(expected * 0.00055 / 0.0003)
    own = solve(case, models__bearing="palmgren", planet_bearing__palmgren_coefficient=0.002)
    assert own.losses["planet_bearing_mechanical"] == pytest.approx(expected * 0.002 / 0.0003)


def test_full_complement_is_refused_by_the_regression(case):
    with pytest.raises(ep.InputError, match="full-complement"):
        case.updated({"planet_bearing.cage": "full-complement", "models.bearing": "mixed-ehl"})


def test_parts_that_are_not_described_are_named(case):
    result = solve(case, planet_bearing=None, carrier=None)
    missing = {term.name: term.left_out for term in result.terms if term.left_out}
    assert set(missing) == {
        "planet_bearing_mechanical",
        "planet_bearing_viscous",
        "carrier_drag",
        "thrust_bearing_viscous",
    }
    assert result.bearing is None
    assert any("carrier_drag" in note for note in result.notes)


@pytest.mark.parametrize(
    ("between", "rpm"),
    [("carrier-housing", 4000 * 73 / 198), ("sun-carrier", 4000 * 125 / 198), ("sun-ring", 4000)],
)
def test_thrust_bearing_turns_with_its_two_parts(case, between, rpm):
    result = solve(case, thrust_bearing={"mean_diameter": "80 mm", "between": between, "count": 2})
    # Talbot (2012), Eq. 5.6 with f0 = 3.5 and 7.32 mm^2/s
    one = math.pi / 30 * 1e-10 * 3.5 * 7.32 ** (2 / 3) * rpm ** (5 / 3) * 80**3
    assert result.losses["thrust_bearing_viscous"] == pytest.approx(2 * one, rel=1e-9)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"operation.torque": "-800 N*m"},
        {"operation.torque": "0 N*m"},
        {"operation.speed": "0 rpm"},
        {"operation.torque": "1 N*m"},
        {"operation.input": "carrier", "operation.fixed": "sun"},
        {"operation.fixed": None, "operation.second_input": "ring",
         "operation.second_speed": "-300 rpm"},
        {"operation.fixed": None, "operation.second_input": "ring",
         "operation.second_speed": "4000 rpm"},
        {"thrust_bearing": {"mean_diameter": "80 mm"}},
    ],
)  # fmt: skip
def test_powers_of_the_shafts_sum_to_the_loss(case, changes):
    result = ep.solve(case.updated(changes))
    powers = [member.power for member in result.flow.members.values()]
    assert sum(powers) == pytest.approx(result.total, abs=1e-9 * max(1.0, *map(abs, powers)))
    assert all(term.watts >= 0 for term in result.terms)


def test_turning_as_one_body_leaves_only_drag(case):
    result = solve(
        case, operation__fixed=None, operation__second_input="carrier",
        operation__second_speed="4000 rpm",
    )  # fmt: skip
    turning = {name for name, watts in result.losses.items() if watts > 0}
    assert turning == {"sun_drag", "ring_drag", "carrier_drag"}


def test_efficiency_near_zero_load(case):
    idle = solve(case, operation__torque="0 N*m")
    assert idle.efficiency == 0.0
    assert idle.input_power == pytest.approx(idle.total, rel=1e-12)
    light = solve(case, operation__torque="0.1 N*m")
    assert light.efficiency == 0.0
    assert any("No power reaches the output" in note for note in light.notes)
    still = solve(case, operation__speed="0 rpm")
    assert still.total == still.input_power == 0
    assert json.loads(still.to_json())["efficiency"] is None


def test_unequal_spacing_is_reported(case):
    result = solve(case, planet__count=5)
    assert any("cannot be equally spaced" in note for note in result.notes)
    degrees = [math.degrees(angle) for angle in result.planet_angles]
    assert degrees == pytest.approx([360 / 198 * k for k in (0, 40, 79, 119, 158)])
    assert not any("equally" in note for note in solve(case, planet__count=6).notes)


def test_a_turning_ring_of_unknown_rim_is_noted(case):
    turning = {"operation.input": "sun", "operation.fixed": "carrier"}
    assert any("rim" in note for note in ep.solve(case.updated(turning)).notes)
    known = {**turning, "ring.rim_thickness": "8 mm"}
    assert not any("rim" in note for note in ep.solve(case.updated(known)).notes)


def test_oil_outside_its_range_is_flagged(case):
    result = solve(case, operation__oil_inlet_temperature="120 degC")
    assert any("temperature" in flag.quantity for flag in result.flags)
    assert any("25 to 100 °C" in warning for warning in result.warnings)


def test_range_warnings_are_one_a_quantity(case):
    warnings = [text for text in ep.solve(case).warnings if text.startswith("Out of range")]
    assert len(warnings) == len({text.split(";")[0].split(" of ")[-1] for text in warnings})
    assert len(warnings) <= 4


def test_quick_method_has_no_rolling_loss(case):
    result = solve(
        case, models__mesh="loss-factor", models__friction="constant",
        models__mesh_loads="without-losses",
    )  # fmt: skip
    assert result.losses["sun_mesh_rolling"] == 0
    # P_in relative to the carrier times mu H_V, Talbot's set: H_V 0.0965 and 0.0565
    relative = 1000 * 4000 * math.pi / 30 * 125 / 198
    assert result.losses["sun_mesh_sliding"] == pytest.approx(0.04 * 0.096532 * relative, rel=1e-4)
    assert result.losses["ring_mesh_sliding"] == pytest.approx(0.04 * 0.056502 * relative, rel=1e-4)


def test_friction_table_of_the_user(case):
    table = {"slide_to_roll_ratio": [0.0, 1.0], "friction": [0.02, 0.06]}
    result = solve(case, friction_table=table, models__friction="table")
    assert 0.02 < result.meshes["sun_mesh"].friction_mean < 0.06
    two = {
        "film_ratio": [0.1, 10.0],
        "hertz_pressure": ["0.1 GPa", "2 GPa"],
        "friction": [[0.05, 0.05], [0.05, 0.05]],
    }
    flat = solve(case, friction_table=two, models__friction="table")
    constant = solve(case, models__friction="constant", models__constant_friction=0.05)
    assert flat.losses["sun_mesh_sliding"] == pytest.approx(
        constant.losses["sun_mesh_sliding"], rel=IDENTITY
    )


def test_comparison_of_friction_models_repeats_their_own_solutions(case):
    rows = {row.name: row for row in compare_friction(case)}
    assert [name for name, row in rows.items() if row.chosen] == ["mixed-lubrication"]
    assert "table" not in rows
    own = solve(case, models__friction="schlenk")
    assert rows["schlenk"].sliding == pytest.approx(
        own.losses["sun_mesh_sliding"] + own.losses["ring_mesh_sliding"], rel=IDENTITY
    )


def test_parallel_pair_internal_and_external():
    pair = ep.load_case("talbot-2012-pair").updated({"operation.torque": "50 N*m"})
    result = ep.solve(pair)
    assert result.flow.members["gear"].speed == pytest.approx(-result.flow.members["pinion"].speed)
    assert sum(member.power for member in result.flow.members.values()) == pytest.approx(
        result.total
    )
    inputs = pair.inputs()
    inputs["gears"] |= {"center_distance": "35 mm"}
    inputs["pinion"] = {
        "teeth": 25, "face_width": "15 mm", "profile_shift_coefficient": 0.0, "roughness": "0.4 um",
    }  # fmt: skip
    inputs["gear"] = inputs["pinion"] | {
        "teeth": 60, "internal": True, "profile_shift_coefficient": -0.05,
        "tip_diameter": "117 mm", "root_diameter": "125 mm",
    }  # fmt: skip
    ring = ep.solve(ep.load_case(inputs))
    assert ring.flow.members["gear"].speed == pytest.approx(
        ring.flow.members["pinion"].speed * 25 / 60
    )
    # sliding is the difference of the speeds, not the sum: less loss at the same torque
    assert ring.losses["mesh_sliding"] < result.losses["mesh_sliding"]


@pytest.mark.parametrize("torque", ["640 N*m", "-75 N*m"])
def test_losses_grouped_as_a_test_rig_does(case, torque):
    """What torque adds to the total, and the total without torque."""
    plain = solve(case, operation__torque=torque)
    tested = solve(case, operation__torque=torque, models__load_dependent="as-tested")
    idle = solve(case, operation__torque="0 N*m")
    assert tested.losses == plain.losses
    assert tested.total == plain.total
    assert tested.load_independent == idle.total
    assert tested.load_dependent == pytest.approx(plain.total - idle.total, rel=1e-12)
    # teeth and bearings that drive the input without torque
    assert tested.load_independent - plain.load_independent > 2.0
    written = json.loads(tested.to_json())
    assert written["load_dependent"] == tested.load_dependent
    assert "load-dependent, as tested" in told_by_tables(tested)


def told_by_tables(result):
    console = Console(width=120, record=True, file=io.StringIO())
    console.print(result_tables(result))
    return console.export_text()
