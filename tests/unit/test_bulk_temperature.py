"""Bulk temperatures of ISO/TS 6336-20, -21 and -22."""

from __future__ import annotations

import pytest

from epicyclic.contact.temperatures import (
    LUBRICATION_FACTORS,
    bulk_rise_of_flash,
    bulk_rise_of_loss,
    iso_mean_friction,
    mates_factor,
    roughness_factor,
)
from reference.heat_transfer import bulk_rise_of_integral_flash


def test_bulk_temperature_over_loss_size_and_cooling():
    base = bulk_rise_of_loss(1e3, 0.1, 0.02, 1.0)
    assert bulk_rise_of_loss(0.0, 0.1, 0.02, 1.0) == 0.0
    assert bulk_rise_of_loss(2e3, 0.2, 0.02, 1.0) == pytest.approx(base, rel=1e-12)  # by area
    assert bulk_rise_of_loss(1e3, 0.1, 0.02, 1.2) == pytest.approx(base * 1.2, rel=1e-12)


def test_mean_friction_in_printed_units():
    """0.045 (F_bt/b/(v rho))^0.2 eta^-0.05 X_R X_L in N/mm, m/s, mm, mPa s, um."""
    rough = roughness_factor(0.4e-6, 10e-3)
    assert rough == pytest.approx(2.2 * 0.04**0.25, rel=1e-12)
    found = iso_mean_friction(500e3, 5.0, 10e-3, 20e-3, rough, 0.8)
    assert found == pytest.approx(0.045 * 10**0.2 * 20**-0.05 * rough * 0.8, rel=1e-12)


def test_a_gear_with_more_mates_is_hotter():
    assert [mates_factor(mates) for mates in (1, 2, 3)] == [1.0, 1.5, 2.0]
    spray = LUBRICATION_FACTORS["spray"]
    assert bulk_rise_of_flash(10.0, spray) == pytest.approx(5.64, rel=1e-12)
    assert bulk_rise_of_flash(10.0, spray, 3) == pytest.approx(11.28, rel=1e-12)
    assert bulk_rise_of_integral_flash(10.0, spray) == pytest.approx(8.4, rel=1e-12)
    assert LUBRICATION_FACTORS["submerged"] < LUBRICATION_FACTORS["dip"] < spray
