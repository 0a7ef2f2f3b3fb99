"""Hertz contact of two cylinders with parallel axes, in the notation of Johnson."""

from __future__ import annotations

import math
from typing import NamedTuple


class HertzContact(NamedTuple):
    """Half-width [m] and largest pressure [Pa] of a contact."""

    half_width: float
    pressure: float


def contact_modulus(
    e1: float,  # Elastic moduli. [Pa]
    nu1: float,  # Poisson's ratios. [1]
    e2: float,  # Elastic moduli. [Pa]
    nu2: float,  # Poisson's ratios. [1]
) -> float:
    """Johnson's E*, with 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.

    Returns
    -------
    float
        Half the modulus that is called E' or E_eq in film-thickness literature. [Pa]

    References
    ----------
    K. L. Johnson, Contact Mechanics (1985), chapter 4.
    """
    return 1 / ((1 - nu1**2) / e1 + (1 - nu2**2) / e2)


def hertz_line_contact(
    load: float,  # P, per length. [N/m]
    radius: float,  # R, with 1/R = 1/R1 + 1/R2 for two cylinders. [m]
    modulus: float,  # E* of `contact_modulus`. [Pa]
) -> HertzContact:
    """Contact of a cylinder of `radius` with a plane: a^2 = 4 P R/(pi E*), p_0 = 2 P/(pi a).

    Returns
    -------
    HertzContact
        a [m] and p_0 [Pa].

    References
    ----------
    K. L. Johnson, Contact Mechanics (1985), Eq. 4.43 to 4.45.
    """
    half_width = math.sqrt(4 * load * radius / (math.pi * modulus))
    return HertzContact(half_width, 2 * load / (math.pi * half_width))
