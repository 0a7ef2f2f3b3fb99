"""Temperatures of results: balances, what leads to a temperature, tables and the picture."""

from __future__ import annotations

import doctest
import itertools
import json

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import epicyclic as ep
from epicyclic.build.machine import build
from epicyclic.errors import InputError
from epicyclic.losses.friction import FRICTION_MODELS
from epicyclic.result.stored import read_result
from epicyclic.show.plots.catalogue import available, figure_of
from epicyclic.show.result_tables import heat_items, remarks
from epicyclic.study import heat as analysis
from epicyclic.study.heat import beyond_range
from epicyclic.study.load import as_case
from epicyclic.study.solve import mesh_contacts, solve
from epicyclic.units import CELSIUS
from listed_trains import ravigneaux

RUNNING = {
    "operation.torque": "100 N*m",
    "operation.speed": "2000 rpm",
    "losses.mesh_pocketing.include": False,
    "models.preset": "talbot-2012",
    "thermal.oil_flow": None,
}
FLOW = {"thermal.oil_flow": "2.3 l/min"}
HOUSING = {"thermal.housing.area": "0.31 m^2"}
EVERYTHING = {**FLOW, **HOUSING, "thermal.cooler_power": "37 W", "models.temperatures": "network"}


def pair(changes):
    return ep.load_case("talbot-2012-pair", {**RUNNING, **changes})


@pytest.mark.parametrize(("power", "told"), [("39 W", False), ("3.9 kW", True)])
def test_a_cooler_that_removes_more_than_the_losses_is_told(power, told):
    result = solve(pair({**EVERYTHING, "thermal.cooler_power": power}))
    words = f"thermal.cooler_power removes 3900 W, and all losses are {result.total:.0f} W"
    assert any(words in note for note in result.notes) == told


@pytest.mark.parametrize(("flow", "told"), [("2.3 l/min", False), ("3.1 l/min", True)])
def test_flows_that_differ_are_told(flow, told):
    oil = {"lubrication.method": "spray", "lubrication.oil_flow": flow, "thermal.housing": None}
    notes = solve(pair({**EVERYTHING, **oil})).notes
    assert any("differs from lubrication.oil_flow" in note for note in notes) == told


def test_an_outlet_temperature_without_losses_is_told_as_such():
    still = {**FLOW, "thermal.oil_flow": None, "operation.speed": "0 rpm"}
    outlet = {"thermal.oil_outlet_temperature": "110 degC", "models.temperatures": "network"}
    with pytest.raises(InputError, match="without losses the leaving oil has no heat") as error:
        solve(pair({**still, **outlet}))
    assert [it.key for it in error.value.problems] == ["thermal.oil_outlet_temperature"]


def test_gears_that_are_sprayed_and_dip_give_heat_both_ways():
    spray, both, dip = (
        solve(pair({**EVERYTHING, "thermal.lubrication": way})).heat.temperatures["pinion"]
        for way in ("spray", "spray-and-dip", "dip")
    )
    assert both < min(spray, dip)


BARE = {"thermal.lubrication": "spray", "thermal.cooler_conductance": "0 W/K"}
HOUSED = {"thermal.housing.area": "0.31 m^2", "thermal.housing.fin_factor": 1.7}
OLD = {"thermal.housing.method": "iso-14179-1"}


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"thermal.coolant_temperature": "37 degC"}, "coolant_temperature"),
        ({"thermal.bulk": "iso-6336-22"}, "bulk"),
        ({"thermal.bath_share": 0.21}, "bath_share"),
        ({"thermal.lubrication": "dip", "thermal.jet_effectiveness": 0.7}, "jet_effectiveness"),
        ({**HOUSED, **OLD}, "housing.fin_factor"),
        ({**HOUSED, "thermal.housing.coefficient": "17 W/(m^2*K)"}, "housing.coefficient"),
    ],
)
def test_keys_without_effect_on_the_network_are_told(changes, key):
    notes = solve(pair({**EVERYTHING, **BARE, **changes})).notes
    assert [it for it in notes if "has no effect" in it and f"thermal.{key} " in it]
    assert sum("thermal." in it and "has no effect" in it for it in notes) == 1
    inlet = solve(pair({**EVERYTHING, **BARE, **changes, "models.temperatures": "inlet"}))
    assert not any(f"thermal.{key} has no effect" in it for it in inlet.notes)


@pytest.mark.parametrize(
    "changes",
    [
        {"thermal.coolant_temperature": "37 degC", "thermal.cooler_conductance": "3 W/K"},
        {"thermal.bath_share": 0.21, "thermal.lubrication": "spray-and-dip"},
        {"thermal.jet_effectiveness": 0.7, "thermal.lubrication": "spray-and-dip"},
        HOUSED,
    ],
)
def test_keys_with_an_effect_are_not(changes):
    case = {**EVERYTHING, **BARE, **changes}
    assert not any("thermal." in it and "has no effect" in it for it in solve(pair(case)).notes)


def test_heat_of_sliding_is_shared_where_it_arises():
    """Weights are the heat at each point, not the friction: they give another share."""
    case = pair({})
    losses = build(case).solve().solution.results[""].losses
    (contact,) = mesh_contacts(case).values()
    friction = FRICTION_MODELS["mixed-ehl"].coefficient(contact)
    speed1, speed2 = (np.sqrt(np.abs(speed)) for speed in contact.surface_speeds)
    share = speed1 / (speed1 + speed2)  # both of steel: Blok
    heat = friction * contact.line_load * np.abs(contact.sliding_speed) * contact.weight
    (first, own), (second, rest) = losses["mesh_sliding"].heat
    assert (first, second) == ("pinion", "gear")
    assert own == pytest.approx(np.average(share, weights=heat), rel=1e-9)
    assert own + rest == pytest.approx(1.0, rel=1e-12)
    assert own != pytest.approx(np.average(share, weights=friction), rel=1e-3)


@pytest.fixture(scope="module")
def everything():
    return solve(pair(EVERYTHING))


def test_heat_of_the_losses_leaves_by_the_outlets(everything):
    heat = everything.heat
    assert sum(heat.brought.values()) == pytest.approx(everything.total, rel=1e-12)
    assert {way.hot for way in heat.outlets} == {"oil", "housing"}
    assert sum(way.watts for way in heat.outlets) == pytest.approx(everything.total, rel=1e-9)


def test_stored_heat_is_that_of_the_result(everything):
    heat = everything.heat
    read, problems = read_result(json.loads(everything.to_json()))
    assert not problems
    stored = read.heat
    assert stored.temperatures == pytest.approx(heat.temperatures, rel=1e-12)
    assert stored.given == pytest.approx(heat.given, rel=1e-12)
    assert [way.key for way in stored.ways] == [way.key for way in heat.ways]
    assert [way.watts for way in stored.ways] == [way.watts for way in heat.ways]
    assert stored.brought == pytest.approx(heat.brought)


@pytest.mark.parametrize(
    ("quantity", "key", "changes", "celsius"),
    [
        ("oil_flow", "thermal.oil_flow", {}, 103.7),
        ("oil_flow", "thermal.oil_flow", HOUSING, 81.3),
        ("oil_flow", "thermal.oil_flow", {"thermal.oil_outlet_temperature": "97 degC"}, 93.1),
        ("cooler_power", "thermal.cooler_power", FLOW, 92.9),
        ("input_power", "operation.torque", FLOW, 98.3),
        ("input_power", "operation.torque", {**FLOW, "operation.torque": "-40 N*m"}, 96.1),
    ],
)
def test_what_is_found_leads_back_to_the_temperature(quantity, key, changes, celsius):
    case = pair(changes)
    found = ep.solve_for(case, quantity, f"{celsius} degC")
    again = case.updated(
        {
            key: found.unit.exact_text(found.value),
            **({"thermal.oil_outlet_temperature": None} if quantity == "oil_flow" else {}),
        }
    )
    assert CELSIUS.to_display(ep.heat_balance(again).oil) == pytest.approx(celsius, rel=1e-6)
    assert found.key == key
    if quantity == "input_power":
        assert found.value * case.operation.torque > 0


def test_examples_hold():
    found = doctest.testmod(analysis)
    assert found.attempted
    assert not found.failed


def test_a_temperature_may_be_a_number_of_kelvin():
    found = ep.solve_for(pair({}), "oil_flow", 371.0)
    assert found.result.heat.oil == pytest.approx(371.0, rel=1e-8)


@pytest.mark.parametrize(
    ("quantity", "temperature", "words"),
    [
        ("oil_flow", "71 degC", "oil at 71 °C: cannot be reached: with unlimited thermal.oil_flow"),
        ("oil_flow", "90 degC", "with unlimited thermal.oil_flow it is at 90 °C"),
        ("cooler_power", "150 degC", "with thermal.cooler_power = 0 W it is at 9"),
        ("input_power", "20 degC", r"with operation.torque = 0 N\*m it is at 90"),
        ("oil_flow", "hot", "oil temperature to reach = "),
        ("oil_flow", 20.0, "oil temperature to reach = "),
        ("torque", "90 degC", "must be one of cooler_power, oil_flow, input_power"),
    ],
)
def test_what_cannot_be_found_is_an_input_error(quantity, temperature, words):
    with pytest.raises(InputError, match=words):
        ep.solve_for(pair(FLOW), quantity, temperature)


def test_given_losses_warm_an_oil_that_is_stated():
    case = ep.load_case("train-8hp70")
    heat = ep.heat_balance(case)
    ways = {way.key: way for way in heat.ways}
    assert heat.oil - heat.given["oil_inlet"] == pytest.approx(
        solve(case).total / ways["oil-outflow"].conductance, rel=1e-9
    )
    with pytest.raises(InputError, match="lubricant: is missing; the heat needs it"):
        ep.heat_balance(case.updated({"lubricant": None}))
    with pytest.raises(InputError, match=r"needs \[lubricant\] and operation.oil_inlet_t"):
        ep.heat_balance(case.updated({"operation.oil_inlet_temperature": None}))
    with pytest.raises(InputError, match="all sets have given efficiencies"):
        case.updated({"models.temperatures": "flank"})


def test_tables_list_parts_from_the_hottest(everything):
    temperatures, balance = heat_items(everything.heat)
    values = [row[1].value for row in temperatures.rows]
    own = values[: len(everything.heat.temperatures)]
    assert own == sorted(own, reverse=True)
    assert balance.rows[-1][2].value == pytest.approx(everything.total)


def test_remarks_compare_with_warm_flanks_and_without_holding():
    case = pair({})
    cold = solve(case)
    warm = solve(case.updated({"models.temperatures": "flank"}))
    hottest = max(warm.heat.temperatures.values())
    (first,) = remarks(case, cold)
    assert f"at {CELSIUS.to_display(hottest):.0f} °C" in first
    assert f"the total loss would be {warm.total:.0f} W" in first
    hot = case.updated({"operation.oil_inlet_temperature": "110 degC"})
    free = solve(hot.updated({"models.oil_beyond_range": "extrapolated"}))
    result = solve(hot)
    assert beyond_range(hot, result).share == pytest.approx(1.0)
    _, second = remarks(hot, result)
    assert second.startswith("100 % of the load-dependent loss arises in contacts")
    assert second.endswith(f"without this limit the total would be {free.total:.0f} W.")


@pytest.mark.parametrize(
    "changes", [{"operation.torque": "0 N*m"}, {"operation.speed": "0 rpm"}], ids=["load", "motion"]
)
def test_without_load_or_motion_there_is_nothing_to_remark(changes):
    case = pair(changes)
    assert list(remarks(case, solve(case))) == []


def pictures():
    planetary = {
        "losses.sun_mesh_pocketing.include": False,
        "losses.ring_mesh_pocketing.include": False,
        "numerics.mesh_positions": 4,
        "thermal.oil_flow": "4 l/min",
    }
    axle = {"thermal.oil_flow": "4 l/min", "numerics.mesh_positions": 4}
    yield "pair", ep.load_case("talbot-2012-pair", {**RUNNING, **FLOW})
    yield "pair in a housing", ep.load_case("talbot-2012-pair", {**RUNNING, **HOUSING})
    yield "set", ep.load_case("talbot-2012", planetary)
    yield "set in a housing", ep.load_case("talbot-2012", planetary | HOUSING)
    yield "axle", ep.load_case("train-eaxle", axle)
    yield "axle in a housing", ep.load_case("train-eaxle", axle | HOUSING)
    yield "Ravigneaux", ep.load_case(ravigneaux(), axle)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name, _ in pictures()])
def test_texts_of_the_picture_are_apart_and_within_it(name):
    source = dict(pictures())[name]
    heat = ep.heat_balance(source)
    figure = figure_of(ep.record(analysis.with_network(as_case(source)), groups=()), "heat-network")
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    (ax,) = figure.axes
    boxes = {
        (place, text.get_text()): text.get_window_extent(canvas.get_renderer())
        for place, text in enumerate(ax.texts)
    }
    shown = " ".join(text for _, text in boxes)
    for node, kelvin in {**heat.temperatures, **heat.given}.items():
        assert f"{CELSIUS.to_display(kelvin):.1f} °C" in shown, node
    width, height = canvas.get_width_height()
    for (_, text), box in boxes.items():
        assert min(box.x0, box.y0) > -1, text
        assert box.x1 < width + 1, text
        assert box.y1 < height + 1, text
    for (one, first), (other, second) in itertools.combinations(boxes.items(), 2):
        apart = (
            first.x1 <= second.x0 + 1
            or second.x1 <= first.x0 + 1
            or first.y1 <= second.y0 + 3
            or second.y1 <= first.y0 + 3
        )
        assert apart, (one, other)


@pytest.mark.slow
def test_a_stored_result_has_the_picture_of_its_heat(tmp_path):
    record = ep.record(pair(EVERYTHING))
    ep.save_result(record, tmp_path / "warm.nc")
    stored = ep.open_result(tmp_path / "warm.nc")
    assert figure_of(stored, "heat-network").axes[0].get_title(loc="left").startswith("Heat: oil")
    page = ep.report_html(stored)
    assert "Where the heat leaves" in page
    assert "Heat paths" in page
    assert 'id="figure-heat-network-1"' in page
    assert "The oil is at its inlet temperature at all contacts." not in page


@pytest.mark.slow
def test_without_a_network_there_is_no_picture_of_it():
    record = ep.record(pair({"models.temperatures": "flank"}))
    assert "heat-network" not in available(record)
    page = ep.report_html(record)
    assert "heat of losses" in page
    assert "Where the heat leaves" not in page
