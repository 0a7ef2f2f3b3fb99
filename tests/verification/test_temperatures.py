"""Temperatures that follow from the losses: limits, balances, symmetry, what is fed with what."""

from __future__ import annotations

import copy
import itertools
import math

import pytest

import epicyclic as ep
from asymmetric import planetary
from epicyclic.contact.elastic_teeth import TOLERANCE
from epicyclic.machine.heat import AGREEMENT

FLOW = {"models.temperatures": "network", "thermal.oil_flow": "3.7 l/min"}
HOUSED = {
    "models.temperatures": "network",
    "thermal.oil_flow": "2.3 l/min",
    "thermal.housing.area": "0.37 m^2",
    "thermal.ambient_temperature": "17 degC",
}
TALBOT = "talbot-2012"


@pytest.fixture(scope="module")
def settled():
    return ep.solve(ep.load_case(planetary()).updated(HOUSED))


def leaving(result):
    """Heat that leaves by every way to a node of given temperature."""
    ends = {*result.heat.given, "cooler"}
    return sum(way.watts for way in result.heat.ways if way.into in ends)


def test_the_heat_that_leaves_is_the_loss(settled):
    assert settled.heat.residual < 1e-9
    assert leaving(settled) == pytest.approx(settled.total, rel=1e-9)
    assert sum(settled.heat.sources.values()) == pytest.approx(settled.total, rel=1e-12)
    assert settled.heat.evaluations < 7
    powers = sum(member.power for member in settled.flow.members.values())
    assert powers == pytest.approx(settled.total, rel=1e-10)


def test_losses_belong_to_the_temperatures_they_lead_to(settled):
    temperatures = settled.heat.temperatures
    for key, nodes in (("sun_mesh", ("sun", "planet")), ("ring_mesh", ("planet", "ring"))):
        mean = sum(temperatures[node] for node in nodes) / 2
        assert settled.meshes[key].contact_temperature == pytest.approx(mean, abs=3 * AGREEMENT)
    middle = (temperatures["planet"] + temperatures["pin"]) / 2
    assert settled.bearing.contact_temperature == pytest.approx(middle, abs=3 * AGREEMENT)


def test_no_two_parts_are_equally_warm(settled):
    values = sorted(settled.heat.temperatures.values())
    assert all(hot - cold > 0.01 for cold, hot in itertools.pairwise(values))


def test_endless_oil_keeps_everything_at_the_inlet_temperature():
    case = ep.load_case(planetary())
    flooded = ep.solve(case.updated(FLOW | {"thermal.oil_flow": "1e6 l/min"}))
    inlet = case.operation.oil_inlet_temperature
    assert flooded.heat.temperatures["oil"] == pytest.approx(inlet, abs=1e-3)
    for node in ("sun", "planet", "ring", "pin"):
        assert flooded.heat.temperatures[node] == pytest.approx(inlet, abs=1e-2)
    isothermal = ep.solve(case)
    for name, watts in isothermal.losses.items():
        assert flooded.losses[name] == pytest.approx(watts, rel=2e-4), name


def test_a_cooler_takes_its_power_from_the_oil():
    cooled = HOUSED | {"thermal.cooler_power": "130 W", "thermal.cooler_conductance": "2.9 W/K"}
    result = ep.solve(ep.load_case(planetary()).updated(cooled))
    ways = {way.key: way for way in result.heat.ways}
    assert ways["oil-cooler"].watts == 130.0
    driven = 2.9 * (result.heat.temperatures["oil"] - 313.15)
    assert ways["oil-coolant"].watts == pytest.approx(driven, rel=1e-9)
    assert leaving(result) == pytest.approx(result.total, rel=1e-9)


@pytest.mark.parametrize("coefficient", [12.0, 350.0])
def test_the_coefficient_of_part_1_is_that_from_oil_to_air(coefficient):
    part_1 = {
        "models.temperatures": "network",
        "thermal.oil_flow": "1.9 l/min",
        "thermal.housing.method": "iso-14179-1",
        "thermal.housing.area": "0.43 m^2",
        "thermal.housing.coefficient": f"{coefficient} W/(m^2*K)",
    }
    result = ep.solve(ep.load_case(planetary()).updated(part_1))
    ways = {way.key: way.watts for way in result.heat.ways}
    driven = coefficient * 0.43 * (result.heat.temperatures["oil"] - 293.15)
    assert ways["housing-air"] == pytest.approx(driven, rel=1e-9)
    assert ways["oil-housing"] == pytest.approx(driven, rel=1e-9)


@pytest.mark.parametrize(
    "others",
    [
        {},
        {"thermal.housing.area": "0.2 m^2"},
        {"thermal.housing.area": "0.2 m^2", "thermal.ambient_temperature": "190 degC"},
        {"thermal.cooler_conductance": "5 W/K", "thermal.cooler_power": "30 W"},
    ],
)
def test_a_measured_outlet_temperature_gives_the_flow(others):
    case = ep.load_case(planetary()).updated(others)
    known = ep.solve(case.updated(FLOW))
    outlet = f"{known.heat.temperatures['oil']!r} K"
    changes = {"models.temperatures": "network", "thermal.oil_outlet_temperature": outlet}
    found = ep.solve(case.updated(changes))
    assert found.total == pytest.approx(known.total, rel=1e-7)
    for node, value in known.heat.temperatures.items():
        assert found.heat.temperatures[node] == pytest.approx(value, abs=3 * AGREEMENT), node


def test_an_outlet_temperature_that_other_paths_prevent_is_told():
    changes = {"thermal.oil_outlet_temperature": "120 degC", "thermal.housing.area": "50 m^2"}
    case = ep.load_case(planetary()).updated({"models.temperatures": "network"} | changes)
    with pytest.raises(ep.ConvergenceError, match="the oil cannot leave at 120 °C: other paths"):
        ep.solve(case)


def test_the_faster_the_air_the_cooler_the_housing():
    case = ep.load_case(planetary()).updated(FLOW | {"thermal.housing.area": "0.3 m^2"})
    speeds = ("0 m/s", "0.001 m/s", "0.3 m/s", "1 m/s", "10 m/s")
    found = [ep.solve(case.updated({"thermal.housing.air_speed": it})).heat for it in speeds]
    walls = [heat.temperatures["housing"] for heat in found]
    assert all(slow >= fast - 1e-9 for slow, fast in itertools.pairwise(walls))
    assert walls[1] == pytest.approx(walls[0], abs=1e-6)
    assert walls[-1] < walls[0] - 1


def test_flank_rises_by_the_flash_of_its_own_meshes():
    case = ep.load_case(planetary())
    result = ep.solve(case.updated({"models.temperatures": "flank", "thermal.lubrication": "dip"}))
    inlet, count = case.operation.oil_inlet_temperature, case.planet.count
    sun, ring = (result.meshes[key].flash_temperature_mean for key in ("sun_mesh", "ring_mesh"))
    rises = {node: value - inlet for node, value in result.heat.temperatures.items()}
    assert rises == pytest.approx(
        {
            "sun": 0.47 * 1.0 * (1 + count) / 2 * sun,
            "ring": 0.47 * 1.0 * (1 + count) / 2 * ring,
            "planet": 0.47 * 1.0 * 1.5 * (sun + ring) / 2,
        },
        rel=1e-6,
    )
    # the planet bearing lies between planet and oil
    middle = inlet + rises["planet"] / 2
    assert result.bearing.contact_temperature == pytest.approx(middle, abs=3 * AGREEMENT)


@pytest.mark.parametrize(
    ("friction", "changes_it"),
    [
        ("schlenk", False),
        ("niemann-winter", False),
        ("benedict-kelley", False),
        ("mixed-ehl", True),
    ],
)
def test_formulas_fitted_by_the_oil_take_the_oil(friction, changes_it):
    case = ep.load_case(planetary()).updated(
        {"models.friction": friction, "models.mesh_loads": "without-losses"}
    )
    cold, warm = ep.solve(case), ep.solve(case.updated({"models.temperatures": "flank"}))
    told = [note for note in warm.warnings if "by their oil temperature" in note]
    assert bool(told) is not changes_it
    change = warm.losses["sun_mesh_sliding"] / cold.losses["sun_mesh_sliding"] - 1
    # the load on the flanks goes on from that at the inlet temperature, within its tolerance
    assert (abs(change) > TOLERANCE) is changes_it


def test_flank_rises_by_the_loss_of_one_of_its_meshes():
    """7400 (P/(a b))^0.72/1.2 of ISO/TS 6336-22, P of one of the planets, in kW and mm."""
    changes = {"models.temperatures": "flank", "thermal.bulk": "iso-6336-22"}
    case = ep.load_case(planetary()).updated(changes | {"thermal.lubrication": "dip"})
    result, geometries = ep.solve(case), case.gearings[""].geometries
    sun, ring = (
        7400 / 1.2
        * (result.losses[f"{key}_sliding"] / 1e3 / case.planet.count
           / (1e6 * mesh.center_distance * mesh.face_width)) ** 0.72
        for key, mesh in zip(("sun_mesh", "ring_mesh"), geometries, strict=True)
    )  # fmt: skip
    inlet = case.operation.oil_inlet_temperature
    rises = {node: value - inlet for node, value in result.heat.temperatures.items()}
    assert rises == pytest.approx({"sun": sun, "planet": (sun + ring) / 2, "ring": ring}, rel=1e-4)


def test_oil_of_jets_that_meets_one_part_cools_no_other():
    case = ep.load_case(planetary()).updated(FLOW)
    even, given = (
        ep.solve(case.updated(changes)).heat.temperatures
        for changes in ({}, {"thermal.jet_shares": {"sun": 0.8}})
    )
    assert given["sun"] < even["sun"] - 0.1
    assert given["ring"] > even["ring"] + 0.1


def test_heat_of_sliding_goes_where_it_is_carried_away():
    """A gear of a material that takes up heat more readily gets more of it."""
    tables = planetary()
    base = ep.solve(ep.load_case(tables).updated(FLOW))
    changed = copy.deepcopy(tables)
    changed["sun"]["material"]["thermal_conductivity"] = "390 W/(m*K)"
    copper = ep.solve(ep.load_case(changed).updated(FLOW))
    assert copper.heat.sources["sun"] > 1.2 * base.heat.sources["sun"]
    assert copper.meshes["sun_mesh"].flash_temperature_mean < (
        0.8 * base.meshes["sun_mesh"].flash_temperature_mean
    )
    ring = base.meshes["ring_mesh"].flash_temperature_mean
    assert copper.meshes["ring_mesh"].flash_temperature_mean == pytest.approx(ring, rel=0.05)


def test_a_train_of_one_set_is_as_warm_as_the_set():
    """The pair of the e-axle as a train of one set, and alone."""
    tables = ep.load_case("train-eaxle").given()
    pair = tables["sets"]["pair"]
    common = {key: tables[key] for key in ("lubricant", "surroundings")}
    operation = {key: tables["operation"][key] for key in ("speed", "torque")}
    operation |= {"oil_inlet_temperature": "70 degC"}
    ends = {"input": "only.pinion", "output": "only.gear"}
    train = ep.solve(
        ep.load_case(
            common | {"kind": "train", "sets": {"only": pair}, "operation": operation | ends}
        ).updated(FLOW)
    )
    own = {key: pair[key] for key in ("gears", "pinion", "gear")}
    alone = ep.solve(
        ep.load_case(common | own | {"kind": "gear_pair", "operation": operation}).updated(FLOW)
    )
    assert alone.heat.temperatures["pinion"] != pytest.approx(
        alone.heat.temperatures["gear"], abs=0.1
    )
    assert {
        node.removeprefix("only."): value for node, value in train.heat.temperatures.items()
    } == pytest.approx(alone.heat.temperatures, abs=AGREEMENT)
    assert train.total == pytest.approx(alone.total, rel=1e-9)


def test_a_train_balances_its_heat():
    case = ep.load_case("train-eaxle").updated(HOUSED)
    result = ep.solve(case)
    assert result.heat.residual < 1e-9
    assert leaving(result) == pytest.approx(result.total, rel=1e-9)
    assert {"motor_front", "pair.pinion", "planets.planet"} < set(result.heat.temperatures)


def test_no_way_for_the_heat_is_an_error():
    case = ep.load_case(TALBOT)
    with pytest.raises(ep.InputError, match="no path out"):
        case.updated({"models.temperatures": "network", "thermal.oil_flow": None})
    dry = {"thermal.jet_effectiveness": 0, "losses.sun_drag.include": True}
    with pytest.raises(ep.InputError, match=r"heat of ring has no path out"):
        ep.solve(case.updated(FLOW | dry))


@pytest.mark.parametrize(("power", "told"), [("120 W", ""), ("5 kW", "5000 W"), ("200 W", "200 W")])
def test_a_cooler_leaves_heat_to_the_oil_that_flows_out(power, told):
    outlet = {"thermal.oil_outlet_temperature": "95 degC", "thermal.cooler_power": power}
    case = ep.load_case("talbot-2012-pair", outlet | {"models.temperatures": "network"})
    if not told:
        assert ep.solve(case).heat.oil == pytest.approx(273.15 + 95)
        return
    with pytest.raises(ep.InputError, match=r"the losses are \d+ W\. Give less") as error:
        ep.solve(case)
    assert [(it.key, it.value) for it in error.value.problems] == [("thermal.cooler_power", told)]


def test_a_gearbox_that_runs_away_says_how_hot_it_gets():
    case = ep.load_case(TALBOT).updated(FLOW | {"thermal.oil_flow": "0.01 l/min"})
    with pytest.raises(ep.ConvergenceError, match=r"thermal runaway.*oil \d+ °C"):
        ep.solve(case)


@pytest.mark.slow
@pytest.mark.parametrize("power", ["500 kW", "1 MW"])
def test_a_cooler_that_takes_more_than_there_is_is_told(power):
    case = ep.load_case(TALBOT).updated(
        FLOW | {"thermal.cooler_power": power, "thermal.housing.area": "1 m^2"}
    )
    with pytest.raises(ep.ConvergenceError, match=r"more heat is removed.*colder than -73"):
        ep.solve(case)


def test_thick_oil_that_mostly_warms_itself_has_temperatures():
    """The drag of oil at -30 degC would make it so hot that it drags next to nothing."""
    ways = {
        "models.temperatures": "network",
        "models.friction": "doleschel",
        "thermal.oil_flow": "1.5643 l/min",
        "thermal.cooler_power": "436.6 W",
        "thermal.lubrication": "submerged",
        "surroundings.oil_air_ratio": 0.05,
        "operation.torque": "2391.726 N*m",
        "operation.speed": "3538.64 rpm",
        "operation.oil_inlet_temperature": "-30 degC",
        "lubricant.oil": "iso-vg-680-mineral",
    }
    result = ep.solve(ep.load_case(TALBOT).updated(ways))
    assert result.heat.temperatures["oil"] - 273.15 == pytest.approx(53.36, abs=0.05)
    assert leaving(result) == pytest.approx(result.total, rel=1e-9)


def test_oil_outside_its_data_is_told_with_the_temperature():
    result = ep.solve(ep.load_case(TALBOT).updated(FLOW))
    told = [text for text in result.warnings if "data of this oil" in text]
    hottest = max(
        result.meshes["sun_mesh"].contact_temperature,
        result.meshes["ring_mesh"].contact_temperature,
        result.bearing.contact_temperature,
    )
    assert len(told) == 1
    assert f"to {hottest - 273.15:.0f} °C" in told[0]


def test_flows_remembered_are_as_good_as_solved():
    """The pockets' power while the oil warms up, against the flow at the very temperature."""
    result = ep.solve(ep.load_case(TALBOT).updated(FLOW))
    oil = result.heat.temperatures["oil"]
    isothermal = ep.solve(
        ep.load_case(TALBOT).updated({"operation.oil_inlet_temperature": f"{oil!r} K"})
    )
    for name in (
        "sun_mesh_pocketing",
        "ring_mesh_pocketing",
        "sun_drag",
        "carrier_drag",
        "planets_drag",
    ):
        assert result.losses[name] == pytest.approx(isothermal.losses[name], rel=1e-5), name
        assert not math.isnan(result.losses[name])
