"""Heat from a housing to the air."""

from __future__ import annotations

import math

import pytest

from epicyclic.machine.convection import air, forced_convection, free_convection, radiation
from reference.heat_transfer import (
    FAN_COEFFICIENTS,
    OVERALL_COEFFICIENTS,
    cylinder_in_air,
    fan_coefficient,
    fin_conductance,
    fin_factor,
    foundation_conductance,
    overall_coefficient,
    shaft_conductance,
)

WARM = (333.0, 293.0)
"""Housing and air. [K]"""
STEFAN_BOLTZMANN = 5.670374e-8


def test_worked_housing():
    """Height 0.5 m, 40 K above air of 293 K, painted; worked out by hand to three digits."""
    free, radiated = free_convection(0.5, *WARM), radiation(0.9, *WARM)
    assert free == pytest.approx(10.6, rel=0.01)
    assert radiated == pytest.approx(6.35, rel=0.01)
    # the guide value that KISSsoft prints for the whole
    assert 15 < overall_coefficient(free + radiated) < free + radiated < 20


def test_radiation_is_the_law_of_stefan_and_boltzmann():
    exact = STEFAN_BOLTZMANN * 0.9 * (WARM[0] ** 4 - WARM[1] ** 4) / (WARM[0] - WARM[1])
    # coefficient 0.23e-6 for 4 sigma: 1.4 %; mean temperature instead of the difference: 0.4 %
    assert radiation(0.9, *WARM) == pytest.approx(exact, rel=0.02)


def test_forced_convection_in_printed_units():
    viscosity = air(313.0, 101325.0).kinematic_viscosity
    reynolds = 20.0 * 0.5 / viscosity
    # buoyancy is 0.02 % of the Reynolds number at 20 m/s
    expected = 0.0086 * reynolds**0.64 / 0.5
    assert forced_convection(20.0, 0.5, 0.5, *WARM) == pytest.approx(expected, rel=1e-3)


def test_moving_air_becomes_still_air():
    still, breeze, wind = (forced_convection(w, 0.5, 0.5, *WARM) for w in (0.0, 1.0, 5.0))
    assert still < breeze < wind
    # another formula for the same: its limit is of the size of free convection
    assert still == pytest.approx(free_convection(0.5, *WARM), rel=0.3)
    thin = forced_convection(5.0, 0.5, 0.5, *WARM, pressure=0.8 * 101325.0)
    assert thin == pytest.approx(wind * 0.8**0.64, rel=2e-3)  # Re by density; buoyancy


def test_without_a_difference_of_temperature():
    assert free_convection(0.5, 293.0, 293.0) == 0.0
    assert forced_convection(0.0, 0.5, 0.5, 293.0, 293.0) == 0.0
    assert overall_coefficient(0.0) == 0.0


def test_resistances_in_series():
    assert overall_coefficient(17.0, inside=math.inf) == 17.0
    whole = overall_coefficient(20.0, 200.0, 1.2, 10e-3, 50.0)
    assert 1 / whole == pytest.approx(1.2 / 200 + 10e-3 / 50 + 1 / 20, rel=1e-12)


def test_fins():
    fin = {"plain_area": 1.0, "fin_area": 1.5, "fin_height": 40e-3, "fin_thickness": 5e-3}
    perfect = fin_factor(10.0, **fin, conductivity=1e9)
    assert perfect == pytest.approx(2.5, rel=1e-6)
    assert fin_factor(0.0, **fin, conductivity=50.0) == 2.5
    assert 1 < fin_factor(10.0, **fin, conductivity=1.0) < perfect
    bare = fin_factor(10.0, **(fin | {"fin_area": 0.0}), conductivity=50.0)
    assert bare == 1.0


def test_rod_short_and_long():
    rod = {"coefficient": 20.0, "perimeter": 0.1, "area": 1e-3, "conductivity": 50.0}
    # short: all of its surface at the temperature of the root
    assert fin_conductance(**rod, length=1e-3) == pytest.approx(20 * 0.1 * 1e-3, rel=1e-4)
    # long: sqrt(alpha U lambda A)
    assert fin_conductance(**rod, length=10.0) == pytest.approx(
        math.sqrt(20 * 0.1 * 50 * 1e-3), rel=1e-12
    )
    assert fin_conductance(**(rod | {"coefficient": 0.0}), length=0.1) == 0.0


def test_shafts_and_foundations_are_rods():
    slope = math.sqrt(4 * 20.0 / (50.0 * 40e-3))
    area = math.pi * 40e-3**2 / 4
    expected = 50.0 * area * slope * math.tanh(slope * 0.2)
    assert shaft_conductance(20.0, 40e-3, 0.2, 50.0) == pytest.approx(expected, rel=1e-12)
    slope = math.sqrt(10.0 / (50.0 * 20e-3))
    expected = 50.0 * 0.5 * 20e-3 * slope * math.tanh(slope * 0.3)
    plate = foundation_conductance(10.0, 0.5, 20e-3, 0.3, 50.0)
    assert plate == pytest.approx(expected, rel=1e-12)
    turning = shaft_conductance(cylinder_in_air(314.0, 20e-3), 40e-3, 0.2, 50.0)
    assert turning > shaft_conductance(20.0, 40e-3, 0.2, 50.0)


def test_coefficients_of_iso_14179_1():
    for speed, coefficient in FAN_COEFFICIENTS:
        assert fan_coefficient(speed) == coefficient
    assert fan_coefficient(0.0) == 15.0
    assert fan_coefficient(50.0) == 58.0
    assert all(low < high for low, high in OVERALL_COEFFICIENTS.values())
