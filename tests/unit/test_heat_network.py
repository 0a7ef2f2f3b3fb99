"""Nodes, links, and the temperatures at which heat leaves."""

from __future__ import annotations

import numpy as np
import pytest

from epicyclic.thermal.network import Link, Network

GEARBOX = Network(
    nodes=("sun", "planet", "oil", "housing"),
    given={"inlet": 330.0, "air": 291.0},
    links=(
        Link("sun-jet", "sun", "inlet", 7.0, into="oil"),
        Link("sun-oil", "sun", "oil", 2.5),
        Link("planet-oil", "planet", "oil", 11.0),
        Link("oil-outflow", "oil", "inlet", 40.0),
        Link("oil-housing", "oil", "housing", 23.0),
        Link("housing-air", "housing", "air", 5.5),
    ),
    capacities={"sun": 900.0, "planet": 1300.0, "oil": 8100.0, "housing": 15200.0},
)
HEAT = {"sun": 210.0, "planet": 340.0, "oil": 95.0}


def test_all_heat_leaves():
    found = GEARBOX.steady(HEAT)
    flows = GEARBOX.flows(found)
    assert flows["oil-outflow"] + flows["housing-air"] == pytest.approx(645.0, rel=1e-13)
    assert flows["sun-jet"] + flows["sun-oil"] == pytest.approx(210.0, rel=1e-13)
    assert flows["planet-oil"] == pytest.approx(340.0, rel=1e-13)
    assert max(map(abs, GEARBOX.residuals(found, HEAT).values())) < 1e-11


def test_heat_of_a_jet_is_driven_by_the_inlet_and_goes_to_the_oil():
    alone = Network(
        ("gear", "oil"),
        {"inlet": 300.0},
        (
            Link("gear-jet", "gear", "inlet", 4.0, into="oil"),
            Link("oil-outflow", "oil", "inlet", 10.0),
        ),
    )
    found = alone.steady({"gear": 120.0, "oil": 30.0})
    assert found["gear"] == pytest.approx(300.0 + 120.0 / 4.0, rel=1e-14)
    assert found["oil"] == pytest.approx(300.0 + 150.0 / 10.0, rel=1e-14)


def test_heat_without_a_way_out_is_named():
    assert GEARBOX.cut_off() == ()
    dead_end = Network(
        ("sun", "planet", "pin", "oil"),
        {"inlet": 330.0},
        (
            Link("oil-outflow", "oil", "inlet", 40.0),
            Link("sun-oil", "sun", "oil", 0.0),
            Link("planet-pin", "planet", "pin", 3.0),
        ),
    )
    assert dead_end.cut_off() == ("sun", "planet", "pin")


def test_one_node_has_its_time_constant():
    single = Network(
        ("oil",), {"air": 293.0}, (Link("oil-air", "oil", "air", 17.3),), {"oil": 8211.0}
    )
    assert single.time_constants() == pytest.approx([8211.0 / 17.3], rel=1e-12)


def test_the_slowest_time_constant_is_that_of_the_decay():
    from scipy.integrate import solve_ivp

    slowest = GEARBOX.time_constants()[0]
    matrix, known = GEARBOX.system()
    inertia = np.array([GEARBOX.capacities[node] for node in GEARBOX.nodes])
    steady = np.array([GEARBOX.steady(HEAT)[node] for node in GEARBOX.nodes])
    heat = GEARBOX.sources(HEAT)

    def rate(_, found):
        return (heat + known - matrix @ found) / inertia

    late = [8 * slowest, 9 * slowest]
    path = solve_ivp(
        rate, (0, late[1]), steady - 20.0, t_eval=late, method="BDF", rtol=1e-10, atol=1e-10
    )
    left = path.y - steady[:, None]
    assert left[:, 1] / left[:, 0] == pytest.approx(np.exp(-1.0), rel=1e-3)
