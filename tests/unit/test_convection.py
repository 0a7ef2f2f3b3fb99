"""Heat transfer from discs and shafts, fluids, and heat through rollers."""

from __future__ import annotations

import doctest
import importlib
import math

import numpy as np
import pytest

from epicyclic.machine.convection import (
    TRANSITION_REYNOLDS,
    Fluid,
    air,
    air_conductivity,
    dipped_disc,
    disc_coefficient,
    free_convection,
    mixture,
    oil_conductivity,
    oil_heat_capacity,
    roller_conductance,
)
from epicyclic.oil.oil import MixtureState
from reference.heat_transfer import cylinder_in_air, room_convection

AIR = air(333.15, 101325.0)
OIL = Fluid(850.0, 20e-3, 0.13, 2000.0)


@pytest.mark.parametrize("name", ["contact.temperatures", "machine.convection"])
def test_examples_run(name):
    found = doctest.testmod(importlib.import_module(f"epicyclic.{name}"))
    assert found.attempted > 0
    assert found.failed == 0


# --- discs ----------------------------------------------------------------------------------------


def transition_radius(fluid, speed):
    return math.sqrt(TRANSITION_REYNOLDS * fluid.kinematic_viscosity / speed)


def test_laminar_disc_of_any_size_has_one_coefficient():
    small, large, ring = (disc_coefficient(OIL, 100.0, *r) for r in ((0.01,), (0.1,), (0.1, 0.05)))
    assert small == pytest.approx(large, rel=1e-12)
    assert small == pytest.approx(ring, rel=1e-12)
    levich = 0.62 * OIL.prandtl ** (1 / 3) * OIL.conductivity
    # finite Prandtl number: 4.5 % at 308
    expected = levich * math.sqrt(100.0 / OIL.kinematic_viscosity)
    assert small == pytest.approx(expected, rel=0.05)
    assert disc_coefficient(OIL, 0.0, 0.1) == 0.0
    assert disc_coefficient(OIL, -100.0, 0.1) == large


def test_mean_coefficient_is_continuous_at_the_transition():
    radius = transition_radius(AIR, 1000.0)
    below, above = (disc_coefficient(AIR, 1000.0, radius * x) for x in (1 - 1e-9, 1 + 1e-9))
    assert above == pytest.approx(below, rel=1e-7)
    # 1 % more speed shifts the transition only a little
    assert 1 < disc_coefficient(AIR, 1010.0, radius) / below < 1.03


def test_mean_is_that_of_rings():
    """A disc across the transition, cut into rings in closed form and by quadrature."""
    speed = 1000.0
    edges = np.linspace(0.0, 2 * transition_radius(AIR, speed), 401)
    rings = [
        disc_coefficient(AIR, speed, *pair) for pair in zip(edges[1:], edges[:-1], strict=True)
    ]
    mean = np.sum(rings * np.diff(edges**2)) / edges[-1] ** 2
    assert disc_coefficient(AIR, speed, edges[-1]) == pytest.approx(mean, rel=1e-12)
    middle = (edges[-1] + edges[-2]) / 2
    local = 0.0238 * AIR.conductivity * AIR.prandtl**0.6
    local *= (speed / AIR.kinematic_viscosity) ** 0.8 * middle**0.6
    assert rings[-1] == pytest.approx(local, rel=1e-4)  # one thin ring for a point


def test_turbulent_disc_in_air_against_another_formula():
    """2.73 w^0.8 r^0.6 W/(m^2 K), film law of Thermca, in air of a room."""
    found = disc_coefficient(air(293.15, 101325.0), 2000.0, 1.0)
    # two fits; the laminar centre of the disc is 0.5 %
    assert found == pytest.approx(2.73 * 2000.0**0.8, rel=0.03)


def test_dipped_disc():
    reynolds = 100.0 * 40e-3 * 80e-3 / OIL.kinematic_viscosity
    nusselt = 0.228 * reynolds**0.731 * OIL.prandtl ** (1 / 3)
    found = dipped_disc(OIL, 100.0, 80e-3)
    assert found * 80e-3 / OIL.conductivity == pytest.approx(nusselt, rel=1e-12)
    assert dipped_disc(OIL, 0.0, 80e-3) == 0.0
    # the boundary layer of a disc in the same bath: the same order
    assert 0.3 < disc_coefficient(OIL, 100.0, 40e-3) / found < 3


def test_air_around_shafts_and_walls():
    assert cylinder_in_air(100.0, 0.05) == pytest.approx(3.75 * 100**0.7 * 0.05**0.4)
    assert cylinder_in_air(0.0, 0.05) == 0.0
    assert room_convection(333.0, 293.0) == pytest.approx(2.21 * 40**0.33, rel=1e-12)
    # two formulas for one thing; the one of housings has their fittings in it
    assert room_convection(333.0, 293.0) == pytest.approx(
        free_convection(0.5, 333.0, 293.0), rel=0.35
    )


# --- fluids ---------------------------------------------------------------------------------------


def test_oil_is_that_of_tables():
    """Mineral oil at 60 degC, Modelica Standard Library: 0.14 W/(m K), 2010 J/(kg K)."""
    assert oil_conductivity(333.15, 0.87) == pytest.approx(0.14, rel=0.10)
    assert oil_heat_capacity(333.15, 0.87) == pytest.approx(2010, rel=0.04)
    assert oil_conductivity(373.15, 0.87) < oil_conductivity(313.15, 0.87)
    assert oil_heat_capacity(373.15, 0.87) > oil_heat_capacity(313.15, 0.87)


def test_air_is_that_of_the_standard_atmosphere():
    sea_level = air(288.15, 101325.0)
    assert sea_level.density == pytest.approx(1.225, rel=1e-4)
    assert sea_level.kinematic_viscosity == pytest.approx(1.4607e-5, rel=1e-4)
    assert sea_level.conductivity == air_conductivity(288.15) == pytest.approx(0.02534, rel=1e-3)
    assert sea_level.prandtl == pytest.approx(0.71, abs=0.01)


def test_mixture_ends_at_its_parts():
    hot = air(363.15, 101325.0)
    for share, part in ((0.0, hot), (1.0, OIL)):
        state = MixtureState(share, part.density, part.dynamic_viscosity)
        assert mixture(OIL, hot, state) == part
    state = MixtureState(0.05, 0.05 * OIL.density + 0.95 * hot.density, 19e-3)
    wet = mixture(OIL, hot, state)
    # heat capacities add by volume too
    stored = 0.05 * OIL.density * OIL.heat_capacity + 0.95 * hot.density * hot.heat_capacity
    assert wet.density * wet.heat_capacity == pytest.approx(stored, rel=1e-12)
    assert hot.conductivity < wet.conductivity < OIL.conductivity


# --- rollers --------------------------------------------------------------------------------------

NEEDLES = {
    "roller_diameter": 2.5e-3,
    "inner_pitch": 3e-3,
    "outer_pitch": 4e-3,
    "conductivity": 45.0,
}


def test_needle_bearing_of_a_planet():
    width = np.full(16, 30e-6)
    assert 1 < roller_conductance(width, width, 20e-3, **NEEDLES) < 5


def test_only_rollers_between_both_races_count():
    inner, outer = np.array([30e-6, 30e-6, 0.0, 0.0]), np.array([30e-6, 0.0, 30e-6, 0.0])
    one = roller_conductance(np.array([30e-6]), np.array([30e-6]), 20e-3, **NEEDLES)
    assert roller_conductance(inner, outer, 20e-3, **NEEDLES) == one
    assert roller_conductance(np.zeros(4), np.zeros(4), 20e-3, **NEEDLES) == 0.0


def test_slices_add_up_to_the_roller():
    whole = roller_conductance(np.array([30e-6]), np.array([40e-6]), 20e-3, **NEEDLES)
    slices = roller_conductance(
        np.full((2, 5), 30e-6), np.full((2, 5), 40e-6), np.full((2, 5), 2e-3), **NEEDLES
    )
    assert slices == pytest.approx(whole, rel=1e-12)
    wider = roller_conductance(np.array([60e-6]), np.array([80e-6]), 20e-3, **NEEDLES)
    assert wider > whole
