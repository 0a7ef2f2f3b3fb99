"""Laminar heat transfer of a disc against the exact solution for the flow of von Kármán."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, simpson, solve_ivp

from epicyclic.machine.convection import Fluid, disc_coefficient

FAR = 12.0
"""In boundary-layer units; the axial flow has its last value there to 1e-5."""


@pytest.fixture(scope="module")
def axial_flow():
    """Distances from the disc, and the integral of the axial speed up to them."""

    def slope(_, y):
        radial, d_radial, around, d_around, axial = y
        return [
            d_radial,
            radial**2 - around**2 + axial * d_radial,
            d_around,
            2 * radial * around + axial * d_around,
            -2 * radial,
        ]

    # slopes at the disc: Rogers and Lance (1960), quoted in textbooks
    start = [0.0, 0.510232619, 1.0, -0.615922014, 0.0]
    flow = solve_ivp(slope, (0, FAR), start, rtol=1e-11, atol=1e-12, dense_output=True)
    distance = np.linspace(0, FAR, 60001)
    return distance, cumulative_trapezoid(flow.sol(distance)[4], x=distance, initial=0)


@pytest.mark.parametrize("prandtl", [0.7, 1.0, 2.0, 5.0, 10.0, 30.0, 100.0, 1000.0])
def test_coefficient_is_that_of_the_exact_solution(axial_flow, prandtl):
    """T'' = Pr H T': the slope at the disc is 1/int exp(Pr int H)."""
    distance, integral = axial_flow
    exact = 1 / simpson(np.exp(prandtl * integral), x=distance)
    # unit density, conductivity and viscosity: alpha = Nu/sqrt(Re) at 1 rad/s
    fluid = Fluid(1.0, 1.0, 1.0, prandtl)
    # a series cut off, one term fitted
    assert disc_coefficient(fluid, 1.0, 1.0) == pytest.approx(exact, rel=0.006)


def test_air_is_cooled_as_in_handbooks(axial_flow):
    """0.326 sqrt(Re) at a Prandtl number of 0.71, printed with three digits."""
    found = disc_coefficient(Fluid(1.0, 1.0, 1.0, 0.71), 1.0, 1.0)
    assert found == pytest.approx(0.326, rel=0.005)
