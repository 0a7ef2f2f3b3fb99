"""Gearboxes with random ways of the heat: it all leaves, and temperatures stay in order."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import epicyclic as ep
from asymmetric import gear_pair, planetary

WAYS = st.fixed_dictionaries(
    {
        "models.temperatures": st.just("network"),
        "thermal.oil_flow": st.floats(1.5, 30).map(lambda value: f"{value!r} l/min"),
        "thermal.jet_effectiveness": st.floats(0.1, 1),
        "thermal.ambient_temperature": st.floats(-30, 45).map(lambda value: f"{value!r} degC"),
        "thermal.lubrication": st.sampled_from(["spray", "dip", "spray-and-dip", "submerged"]),
        "operation.torque": st.floats(-400, 400).map(lambda value: f"{value:.3f} N*m"),
        "operation.speed": st.floats(-3500, 3500).map(lambda value: f"{value:.2f} rpm"),
    },
    optional={
        "thermal.housing.area": st.floats(0.05, 2).map(lambda value: f"{value!r} m^2"),
        "thermal.cooler_conductance": st.floats(0, 50).map(lambda value: f"{value!r} W/K"),
    },
)


@pytest.mark.slow
@pytest.mark.parametrize("tables", [planetary, gear_pair])
@settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=list(HealthCheck),
    phases=[Phase.generate],  # to shrink a case takes minutes
)
@given(ways=WAYS)
def test_all_heat_leaves(tables, ways):
    case = ep.load_case(tables()).updated(ways | QUICK[tables])
    result = ep.solve(case)
    heat = result.heat
    assert heat.residual < 1e-9 or result.total < 1  # W: temperatures in kelvin are rounded
    assert heat.evaluations < 10
    out = sum(way.watts for way in heat.ways if way.into in heat.given)
    whole = sum(abs(way.watts) for way in heat.ways if way.into in heat.given)
    rounding = 1e-8  # W: of temperatures in kelvin, times the heat capacity of the flow
    assert out == pytest.approx(result.total, rel=1e-9, abs=1e-9 * whole + rounding)
    coldest = min(heat.given.values())
    assert all(value > coldest - 1e-6 for value in heat.temperatures.values())
    assert all(watts >= 0 for watts in result.losses.values())


QUICK = {
    planetary: {
        "losses.sun_mesh_pocketing.include": False,
        "losses.ring_mesh_pocketing.include": False,
        "models.planet_tilt": "left-out",
        "numerics.mesh_positions": 6,
        "numerics.contact_segments": 6,
    },
    gear_pair: {
        "losses.mesh_pocketing.include": False,
        "numerics.mesh_positions": 6,
        "numerics.contact_segments": 6,
    },
}
"""Coarse, and without the flow through pockets: heat does not care."""
