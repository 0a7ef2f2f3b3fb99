"""Friction as a mixture of dry and separated contact: mu = xi mu_b + (1 - xi) mu_f.

The share xi of dry contact follows from a film ratio. The coefficients mu_b and mu_f belong to the
oil and the surfaces; the original works give them from disc tests of single oils, so that here they
are keys of the case. Film thicknesses are those of smooth, isothermal contacts.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.geometry.roughness import RA_OVER_RQ, RZ_OVER_RA
from epicyclic.kernels.line_contact import pan_hamrock_central_film
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.friction.base import mean_roughness_ra
from epicyclic.losses.validity import Range, RegressionFluid
from epicyclic.units import NUMBER

FloatArray = NDArray[np.float64]

_FILM_SOURCE = "films of Pan and Hamrock, J. Tribol. 111 (1989) 246"
FILM_RANGES = (
    Range("load_number", "load number W", 2.045e-5, 5.0e-4, NUMBER, _FILM_SOURCE),
    Range("speed_number", "speed number U", 1e-12, 5.03e-10, NUMBER, _FILM_SOURCE),
    Range("material_number", "material number G", 2504.0, 15027.0, NUMBER, _FILM_SOURCE),
)
"""Ranges of the film formulas. The shares themselves are within 0 to 1 everywhere. Theory (F8)."""


@dataclass(frozen=True, slots=True)
class _FilmShare(ABC):
    """mu = xi mu_b + (1 - xi) mu_f. Theory (F8)."""

    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = False
    ranges: ClassVar[tuple[Range, ...]] = FILM_RANGES

    boundary: float  # mu_b and mu_f. [1]
    fluid: float  # mu_b and mu_f. [1]

    @abstractmethod
    def share(self, contact: MeshContact) -> FloatArray:
        """Share xi of dry contact. [1]"""

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        dry = self.share(contact)
        return dry * self.boundary + (1 - dry) * self.fluid


@dataclass(frozen=True, slots=True)
class Doleschel(_FilmShare):
    """xi = (1 - lambda/2)^2 for lambda < 2, else 0; lambda = h_c/[(Ra1 + Ra2)/2].

    Theory (F9).
    """

    name: ClassVar = "doleschel"
    title: ClassVar = "film share of Doleschel"
    source: ClassVar = "A. Doleschel, Diss. TU Muenchen (2002)"

    def share(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        film = contact.radius * pan_hamrock_central_film(
            contact.speed_number, contact.material_number, contact.load_number
        )
        ratio = np.minimum(film / mean_roughness_ra(contact), 2.0)
        dry: FloatArray = (1 - ratio / 2) ** 2
        return dry


@dataclass(frozen=True, slots=True)
class Matsumoto(_FilmShare):
    """xi = log10(D)/2 within 0 to 1, D = (Rz1 + Rz2)/h_min. Theory (F10)."""

    name: ClassVar = "matsumoto"
    title: ClassVar = "film share of Matsumoto and Morikawa"
    source: ClassVar = "S. Matsumoto and K. Morikawa, Int. Gear Conf. Lyon (2014) 1078"

    def share(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        rz = RZ_OVER_RA * RA_OVER_RQ * (contact.flanks.roughness1 + contact.flanks.roughness2)
        dry: FloatArray = np.clip(np.log10(rz / contact.minimum_film) / 2, 0.0, 1.0)
        return dry
