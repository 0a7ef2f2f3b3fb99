"""Warming up: against closed forms, the steady state, and the balance of energy."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

import epicyclic as ep
from epicyclic.build.machine import build
from epicyclic.machine.heat_flow import Curves, Link, Source, Transient

CAPACITY, CONDUCTANCE, AIR = 5000.0, 12.5, 293.15
"""[J/K], [W/K], [K]"""
HOUSING = {
    "thermal.oil_volume": "2 l",
    "thermal.housing": {"area": "0.5 m^2", "mass": "20 kg"},
    "losses.sun_mesh_pocketing.include": False,
    "losses.ring_mesh_pocketing.include": False,
}


def flat(value, nodes):
    """A curve that is `value` at all temperatures, read at the first of `nodes`."""
    coefficients = np.zeros((4, 1, 1))
    coefficients[3] = value
    return Curves(np.array([200.0, 800.0]), coefficients, np.eye(1, nodes))


def one_node(watts=100.0):
    link = Link("oil-air", "oil", "air", CONDUCTANCE)
    return Transient(
        {"oil": CAPACITY},
        {"air": AIR},
        (Source("drag", "oil", ("oil",)),),
        flat(watts, 1),
        (link,),
        flat(CONDUCTANCE, 1),
        {},
    )


def test_one_node_has_the_time_constant_capacity_over_conductance():
    transient = one_node()
    constant = CAPACITY / CONDUCTANCE
    assert transient.time_constants(np.array([AIR])) == pytest.approx([constant], rel=1e-12)
    course = transient.integrate(np.array([AIR]), np.array([0.0, constant / 2, constant]))
    rise = 100.0 / CONDUCTANCE * (1 - np.exp([0, -0.5, -1.0]))
    assert course.temperatures[0] - AIR == pytest.approx(rise, rel=1e-6)
    # the time constant that the course shows
    left = 1 - (course.temperatures[0, -1] - AIR) / (100.0 / CONDUCTANCE)
    assert -constant / np.log(left) == pytest.approx(constant, rel=1e-6)


def test_one_node_keeps_the_energy():
    transient = one_node()
    course = transient.integrate(np.array([AIR + 50]), np.linspace(0, 1000, 11))
    stored = CAPACITY * (course.temperatures[0] - AIR - 50)
    assert course.gained == pytest.approx(100.0 * course.times, rel=1e-9)
    assert course.gained - course.given_off == pytest.approx(stored, rel=1e-9, abs=1e-3)
    out = np.array([100.0 * t - s for t, s in zip(course.times, stored, strict=True)])
    assert course.given_off == pytest.approx(out, rel=1e-6)


def test_slopes_are_those_of_the_rates():
    case = ep.load_case("talbot-2012").updated(HOUSING | {"thermal.oil_flow": "4 l/min"})
    transient = tables_of(case).transient(np.ones(1), np.ones(1))
    at = np.linspace(330.0, 400.0, len(transient.capacities))
    rise, gained, left = transient.slopes(at)
    for column in range(at.size):
        step = np.zeros(at.size)
        step[column] = 1e-3
        above, below = transient.rates(at + step), transient.rates(at - step)
        slopes = [(up - down) / 2e-3 for up, down in zip(above, below, strict=True)]
        assert rise[:, column] == pytest.approx(slopes[0], rel=1e-4, abs=1e-9)
        assert gained[column] == pytest.approx(slopes[1], rel=1e-4, abs=1e-6)
        assert left[column] == pytest.approx(slopes[2], rel=1e-4, abs=1e-6)


def tables_of(case):
    from epicyclic.study.maps.warm_up import HeatTables, heat_samples

    warm = case.updated({"models.temperatures": "network"})
    knots = [293.15 + 20 * number for number in range(8)]
    return HeatTables(build(warm).thermal, knots, heat_samples(warm, [{}], knots, {}))


CASES = {
    "talbot-2012": HOUSING
    | {
        "thermal.oil_flow": "4 l/min",
        "lubrication": {"method": "jet", "oil_flow": "1.7 l/min"},  # what reaches the gears
        "thermal.conductances.sun-jet.scale": 0.6,
    },
    "talbot-2012-pair": {
        "thermal.lubrication": "dip",
        "thermal.oil_volume": "1 l",
        "thermal.housing": {"area": "0.5 m^2", "mass": "10 kg"},
        "losses.mesh_pocketing.include": False,
        "operation.torque": "60 N*m",
    },
    "train-eaxle": {
        "thermal.oil_volume": "2 l",
        "thermal.oil_flow": "8 l/min",
        "thermal.housing": {"area": "0.5 m^2", "mass": "20 kg"},
        "sets.pair.losses.mesh_pocketing.include": False,
        "sets.planets.losses.sun_mesh_pocketing.include": False,
        "sets.planets.losses.ring_mesh_pocketing.include": False,
    },
}


@pytest.fixture(
    scope="module",
    params=["talbot-2012", "talbot-2012-pair", pytest.param("train-eaxle", marks=pytest.mark.slow)],
)
def warmed(request):
    case = ep.load_case(request.param).updated(CASES[request.param])
    return case, ep.warm_up(case, "12 h")


@pytest.mark.slow
def test_the_course_ends_in_the_steady_state(warmed):
    case, data = warmed
    steady = ep.solve(case.updated({"models.temperatures": "network"}))
    wanted = np.array([steady.heat.temperatures[node] for node in data["node"].values]) - 273.15
    assert data["temperature"].values[-1] == pytest.approx(wanted, abs=0.1)  # what is asked for
    assert data["settled_temperature"].values == pytest.approx(wanted, abs=0.1)
    # interpolated between losses at every 20 K, which fitted models leave with a bend
    assert float(data["total_loss"][-1]) == pytest.approx(steady.total, rel=2e-3)
    assert float(data["efficiency"][-1]) == pytest.approx(steady.efficiency, abs=1e-4)


def test_energy_is_kept(warmed):
    _, data = warmed
    left = data["energy_lost"] - data["energy_given_off"] - data["energy_stored"]
    assert float(abs(left).max()) < 1e-6 * float(data["energy_lost"][-1])
    added = np.trapezoid(data["total_loss"].values, data["time"].values) / 1000
    assert added == pytest.approx(float(data["energy_lost"][-1]), rel=2e-3)


def test_it_starts_cold_with_the_losses_of_the_cold_gearbox(warmed):
    case, data = warmed
    cold = case.updated(
        {"operation.oil_inlet_temperature": "20 degC", "models.temperatures": "inlet"}
    )
    assert data["temperature"].values[0] == pytest.approx(20.0)
    assert float(data["total_loss"][0]) == pytest.approx(ep.solve(cold).total, rel=1e-6)


@pytest.mark.slow
def test_a_cycle_that_never_changes_is_a_constant_operating_point():
    case = ep.load_case("talbot-2012").updated(CASES["talbot-2012"])
    operation = case.inputs()["operation"]
    columns = {"speed": operation["speed"], "torque": operation["torque"]}
    cycle = pd.DataFrame(
        {
            "time [s]": [0.0, 40.0],
            **{f"{name} [{text.split()[1]}]": 2 * [float(text.split()[0])]
               for name, text in columns.items()},
        }
    )  # fmt: skip
    constant = ep.warm_up(case, "10 min")
    over_cycle = ep.warm_up(case, "10 min", cycle=cycle)
    end = over_cycle.isel(time=-1)
    assert end["temperature"].values == pytest.approx(constant["temperature"].values[-1], abs=0.01)
    for name in ("energy_lost", "efficiency"):
        assert float(end[name]) == pytest.approx(float(constant[name][-1]), rel=1e-4)


@pytest.mark.slow
def test_a_histogram_settles_where_a_fast_time_series_does():
    case = ep.load_case("talbot-2012-pair").updated(CASES["talbot-2012-pair"])
    rows = {"speed [rpm]": [2000.0, 500.0, 2000.0], "torque [N*m]": [50.0, -30.0, 50.0]}
    series = ep.warm_up(case, "4 h", cycle=pd.DataFrame({"time [s]": [0, 10, 20], **rows}))
    histogram = ep.warm_up(case, "4 h", cycle=pd.DataFrame({"share": [1, 2, 1], **rows}))
    assert series["settled_temperature"].values == pytest.approx(
        histogram["settled_temperature"].values, abs=0.01
    )
    assert float(series["energy_lost"][-1]) == pytest.approx(
        float(histogram["energy_lost"][-1]), rel=5e-3
    )


def test_capacities_are_those_of_rings_and_discs():
    case = ep.load_case("talbot-2012").updated(HOUSING | {"models.temperatures": "network"})
    found = build(case).thermal.capacities()
    sun = case.sun.teeth * case.gears.normal_module / np.cos(case.gears.helix_angle) / 2
    steel = case.sun.material.density * case.sun.material.heat_capacity
    assert found["sun"] == pytest.approx(np.pi * sun**2 * case.sun.face_width * steel)
    assert found["housing"] == pytest.approx(20 * 460)
    changed = case.updated(
        {
            "sun.material": {"elastic_modulus": "206 GPa", "heat_capacity": "920 J/(kg*K)"},
            "thermal.capacities.ring.scale": 3,
            "thermal.capacities.oil.value": "1234 J/K",
        }
    )
    other = build(changed).thermal.capacities()
    assert other["sun"] == pytest.approx(found["sun"] * 920 * 7850 / steel)
    assert other["ring"] == pytest.approx(3 * found["ring"])
    assert other["oil"] == 1234.0


def test_what_is_not_known_is_told_at_once():
    stores = {"thermal.oil_volume": None, "thermal.housing": {"area": "0.5 m^2"}}
    housed = stores | {"thermal.oil_flow": None}
    case = ep.load_case("talbot-2012").updated(housed)
    with pytest.raises(ep.InputError) as error:
        ep.warm_up(case.updated({"thermal.capacities.sum.scale": 2}), "1 h")
    keys = {problem.key for problem in error.value.problems}
    assert keys == {"thermal.oil_volume", "thermal.housing.mass", "thermal.capacities.sum"}
    with pytest.raises(ep.InputError) as error:
        ep.warm_up(case.updated({"thermal.oil_outlet_temperature": "99 degC"}), "2", "20")
    assert len(error.value.problems) == 3
    with pytest.raises(ep.InputError, match="lubricant: is missing; the heat needs it"):
        ep.warm_up(ep.load_case("train-8hp70", {"lubricant": None}), "1 h")


@pytest.mark.slow
def test_a_runaway_is_told_with_its_time():
    small = {"area": "0.01 m^2", "mass": "1 kg"}
    hot = HOUSING | {"thermal.oil_flow": None, "thermal.housing": small}
    with pytest.raises(ep.ConvergenceError, match=r"thermal runaway: within .* s \w+ exceeds"):
        ep.warm_up(ep.load_case("talbot-2012").updated(hot), "2 h")


def test_a_short_time_is_told_though_it_would_run_away():
    heavy = {"area": "0.01 m^2", "mass": "100 kg"}
    hot = HOUSING | {"thermal.oil_flow": None, "thermal.housing": heavy}
    data = ep.warm_up(ep.load_case("talbot-2012").updated(hot), "20 s")
    assert np.isnan(data["settled_temperature"]).all()
    assert np.isnan(data["time_to_90_percent"]).all()
    assert float(data["energy_lost"][-1]) > 0


@pytest.mark.slow
def test_light_load_of_a_cycle_is_resolved():
    """Torques far below the largest of the cycle, near where rolling loss rises like a root."""
    case = ep.load_case("talbot-2012-pair").updated({
        "models.preset": "talbot-2012",
        "numerics.mesh_positions": 8,
        "numerics.contact_segments": 6,
        "losses.mesh_pocketing.include": False,
        "models.temperatures": "network",
        "thermal.lubrication": "dip",
        "thermal.oil_volume": "1 l",
        "thermal.housing": {"area": "0.3 m^2", "mass": "10 kg"},
    })  # fmt: skip
    rows = {"time [s]": [0.0, 300.0, 310.0], "speed [rpm]": [1500.0, 1500.0, 1500.0],
            "torque [N*m]": [3.0, 150.0, 150.0]}  # fmt: skip
    course = ep.warm_up(case, "310 s", "20 degC", cycle=pd.DataFrame(rows))
    cold = case.updated({
        "models.temperatures": "inlet",
        "operation.torque": "3 N*m",
        "operation.speed": "1500 rpm",
        "operation.oil_inlet_temperature": "20 degC",
    })  # fmt: skip
    assert float(course["total_loss"][0]) == pytest.approx(ep.solve(cold).total, rel=5e-3)


@pytest.mark.slow
def test_a_cycle_of_a_train_of_given_losses_needs_no_temperature():
    cycle = {"time [s]": [0, 3, 7, 9], "speed [rpm]": [900, 900, 900, 900],
             "torque [N*m]": [130, 130, 130, 130], "state": ["1", "1", "R", "R"]}  # fmt: skip
    data = ep.warm_up("train-8hp70", "9 s", "20 degC", cycle=pd.DataFrame(cycle))
    case = ep.load_case("train-8hp70").updated(
        {"operation.speed": "900 rpm", "operation.torque": "130 N*m"}
    )
    first, back = (ep.solve(case.updated({"operation.state": it})).total for it in ("1", "R"))
    lost = float(data["energy_lost"][-1])
    # a row stands for half of the time to each neighbour: 3 + 2 s and 2 + 2 s
    assert lost == pytest.approx(5e-3 * first + 4e-3 * back, rel=1e-6)
