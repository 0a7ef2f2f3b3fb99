"""Flash temperature of line contacts, and the shares of its heat."""

from __future__ import annotations

import math

import numpy as np
import pytest

from epicyclic.contact.temperatures import Solid, heat_share
from epicyclic.kernels.line_contact import (
    equivalent_modulus,
    flash_temperature,
    hertz_half_width,
    hertz_pressure,
)

STEEL = Solid(45.0, 440.0, 7800.0).effusivity


def test_effusivity_of_steel():
    # 12,430 is printed with four digits
    assert pytest.approx(12430.0, rel=5e-4) == STEEL


def test_is_the_printed_form_of_iso_6336_22():
    """sqrt(pi)/2 mu p 1e6 v_g/(sqrt(B_M1 v1) + sqrt(B_M2 v2)) sqrt(8 rho p/(1000 E_r))."""
    e_eq = equivalent_modulus(206e9, 0.3, 210e9, 0.28)
    line_load = np.array([50e3, 236.3e3, 700e3])
    radius = np.array([4e-3, 8.4e-3, 12e-3])
    u1, u2 = np.array([2.0, 8.0, 12.0]), np.array([9.0, 3.0, 12.5])
    other = Solid(50.0, 470.0, 7850.0).effusivity

    pressure = hertz_pressure(line_load, radius, e_eq) / 1e6  # N/mm^2
    carried = np.sqrt(STEEL**2 * u1) + np.sqrt(other**2 * u2)
    width = np.sqrt(8 * radius * 1e3 * pressure / (1000 * e_eq / 1e6))
    printed = math.sqrt(math.pi) / 2 * 0.06 * pressure * 1e6 * np.abs(u1 - u2) / carried * width

    half_width = hertz_half_width(line_load, radius, e_eq)
    rise = flash_temperature(0.06, line_load, u1 - u2, u1, u2, half_width, STEEL, other)
    np.testing.assert_allclose(rise, printed, rtol=1e-12)  # identity; rounding


def test_is_a_surface_heated_evenly_while_it_crosses_the_contact():
    """2 q sqrt(t/pi)/e of a half-space, Carslaw and Jaeger, t = 2b/u, with the heat of one body."""
    mu, load, u1, u2, b = 0.05, 300e3, 9.0, 4.0, 0.15e-3
    rise = float(flash_temperature(mu, load, u1 - u2, u1, u2, b, STEEL, 0.7 * STEEL))
    for share, u, e in (
        (float(heat_share(u1, u2, STEEL, 0.7 * STEEL)), u1, STEEL),
        (float(heat_share(u2, u1, 0.7 * STEEL, STEEL)), u2, 0.7 * STEEL),
    ):
        flux = share * mu * load * (u1 - u2) / (2 * b)
        assert rise == pytest.approx(2 * flux * math.sqrt(2 * b / (math.pi * u)) / e, rel=1e-12)


def test_close_to_the_form_of_blok_for_equal_materials():
    """1.11 mu W' |sqrt(u1) - sqrt(u2)|/(e sqrt(2b)), the peak of heat spread as an ellipse."""
    u1, u2, b = 9.0, 4.0, 0.15e-3
    blok = 1.11 * 0.05 * 300e3 * (math.sqrt(u1) - math.sqrt(u2)) / (STEEL * math.sqrt(2 * b))
    rise = float(flash_temperature(0.05, 300e3, u1 - u2, u1, u2, b, STEEL, STEEL))
    assert rise == pytest.approx(blok * 2 / math.sqrt(math.pi) / 1.11, rel=1e-12)
    assert rise == pytest.approx(blok, rel=0.02)  # even heat instead of an ellipse: 1.7 %


def test_nothing_without_sliding_speed_or_load():
    speeds = np.array([5.0, 0.0, 0.0, 5.0])
    loads = np.array([1e5, 1e5, 0.0, 0.0])
    half_width = np.array([1e-4, 1e-4, 0.0, 0.0])
    sliding = np.array([0.0, 0.0, 0.0, 1.0])
    rise = flash_temperature(0.05, loads, sliding, speeds, speeds, half_width, STEEL, STEEL)
    assert rise.tolist() == [0.0] * 4
    share = heat_share(np.array([0.0, 3.0, 0.0, -3.0]), np.array([0.0, 0.0, 3.0, 3.0]), 1.0, 3.0)
    assert share.tolist() == [0.25, 1.0, 0.0, 0.25]


def test_sense_of_the_speeds_does_not_matter():
    one = flash_temperature(0.05, 1e5, 3.0, 8.0, 5.0, 1e-4, STEEL, STEEL)
    other = flash_temperature(0.05, 1e5, -3.0, -8.0, -5.0, 1e-4, STEEL, STEEL)
    assert one == other > 0
