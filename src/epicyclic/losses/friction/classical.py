"""Friction formulas fitted to gear and disc tests."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.losses.contact import MeshContact
from epicyclic.losses.friction.base import (
    mean_roughness_ra,
    pitch_point_radius,
    pitch_point_sum_speed,
    specific_load,
)
from epicyclic.losses.validity import METRE_PER_SECOND, Range

__all__ = ["BenedictKelley", "NiemannWinter", "Schlenk"]

FloatArray = NDArray[np.float64]


def _mean_group(contact: MeshContact) -> float:
    """[(F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 in N/mm, m/s, mm and mPa s."""
    load = specific_load(contact) * 1e-3
    radius = pitch_point_radius(contact) * 1e3
    viscosity = contact.oil.dynamic_viscosity * 1e3
    group = load / (pitch_point_sum_speed(contact) * radius)
    return float(group**0.2 * viscosity**-0.05)


class Schlenk:
    """mu = 0.048 [(F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 Ra^0.25 X_L, one value for the mesh.

    Theory (F15).

    N/mm, m/s, mm, mPa s, um; Ra the mean of both flanks. The standard's text was not read; the
    constants agree in several independent implementations.
    """

    title: ClassVar = "mean friction of ISO/TR 14179-2"
    source: ClassVar = "L. Schlenk, Diss. TU Muenchen (1994); ISO/TR 14179-2:2001"
    ranges: ClassVar[tuple[Range, ...]] = (
        Range(
            "pitch_line_speed", "pitch-line speed", 0.0, 50.0, METRE_PER_SECOND,
            "Niemann and Winter, Maschinenelemente II",
        ),
    )  # fmt: skip

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        ra = mean_roughness_ra(contact) * 1e6
        mu = 0.048 * _mean_group(contact) * ra**0.25 * contact.oil.lubricant_factor
        return np.full_like(contact.line_load, mu)


class NiemannWinter:
    """mu = 0.045 [(F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 X_R X_L, X_R = 3.8 (Ra/d1)^0.25.

    Theory (F16).

    N/mm, m/s, mm, mPa s, um. Standard formula from general knowledge, its text not read; X_R
    agrees with the form 2.2 (Ra/rho)^0.25 of DIN 3990-4.
    """

    title: ClassVar = "mean friction after Michaelis, Niemann and Winter"
    source: ClassVar = "K. Michaelis, Diss. TU Muenchen (1987); Niemann and Winter, vol. II"
    ranges: ClassVar[tuple[Range, ...]] = (
        Range(
            "pitch_line_speed", "pitch-line speed", 1.0, 50.0, METRE_PER_SECOND,
            "Niemann and Winter, Maschinenelemente II",
        ),
    )  # fmt: skip

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        ra = mean_roughness_ra(contact) * 1e6
        diameter = 2e3 * contact.mesh.gear1.reference_radius
        roughness_factor = 3.8 * (ra / diameter) ** 0.25
        mu = 0.045 * _mean_group(contact) * roughness_factor * contact.oil.lubricant_factor
        return np.full_like(contact.line_load, mu)


class BenedictKelley:
    """mu = 0.0127 [50/(50 - S)] log10[29.66 w/(eta v_s v_r^2)], local.

    Theory (F7).

    w in N/m, eta in mPa s, v_s and v_r = u1 + u2 in m/s, S rms roughness in microinches. The
    logarithm is kept at 1 or above: with little load on much oil it has no meaning. Near the pitch
    point v_s is kept at 1 % of v_r, because the formula grows without bound there.
    """

    title: ClassVar = "local friction of Benedict and Kelley"
    source: ClassVar = "G. H. Benedict and B. W. Kelley, ASLE Trans. 4 (1961) 59"
    ranges: ClassVar[tuple[Range, ...]] = ()

    SMALLEST_SLIDING: ClassVar = 0.01
    LARGEST_ROUGHNESS: ClassVar = 45.0
    """Where 50/(50 - S) = 10; the formula diverges at 50 microinches."""
    MICROINCH: ClassVar = 25.4e-9

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        flanks = contact.flanks
        rms = (flanks.roughness1 + flanks.roughness2) / 2 / self.MICROINCH
        rough = 50 / (50 - min(rms, self.LARGEST_ROUGHNESS))
        rolling = 2 * contact.rolling_speed
        sliding = np.maximum(np.abs(contact.sliding_speed), self.SMALLEST_SLIDING * rolling)
        viscosity = contact.oil.dynamic_viscosity * 1e3
        argument = 29.66 * contact.line_load / (viscosity * sliding * rolling**2)
        mu: FloatArray = 0.0127 * rough * np.log10(np.maximum(argument, 10.0))
        return mu
