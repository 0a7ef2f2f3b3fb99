"""Nodes, links, and the temperatures at which heat leaves."""

from __future__ import annotations

import pytest

from epicyclic.machine.heat_flow import Link, Network

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
