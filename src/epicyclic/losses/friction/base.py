"""What a friction model is, and quantities that several of them use."""

from __future__ import annotations

import math
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from epicyclic.geometry.roughness import RA_OVER_RQ
from epicyclic.kernels.line_contact import hertz_pressure
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.validity import Range, RegressionFluid

FloatArray = NDArray[np.float64]


class FrictionModel(Protocol):
    """A way to the coefficient of sliding friction at every point of a mesh.

    Attributes
    ----------
    name : str
        Under which a case chooses it.
    title, source : str
        For reports.
    made_for : RegressionFluid or None
        The fluid that it was made for, if it holds for no other.
    takes_oil_temperature : bool
        True if it was fitted to tests by the temperature of their oil, so that the temperature of
        the flanks is contained in it; False if it takes the oil as it enters the contact.
    """

    name: ClassVar[str]
    made_for: ClassVar[RegressionFluid | None]
    takes_oil_temperature: ClassVar[bool]

    @property
    def title(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def ranges(self) -> tuple[Range, ...]:
        """Where the model was made; leaving it is flagged."""
        ...

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """Coefficient of friction at each point of `contact`, shape (n,). [1]"""
        ...


def specific_load(contact: MeshContact) -> float:
    """F_bt/b. Theory (F13). [N/m]"""
    return contact.force / contact.mesh.face_width


def pitch_point_sum_speed(contact: MeshContact) -> float:
    """v_SigmaC = 2 v_t sin(alpha_wt), the sum of the surface speeds at the pitch point. [m/s]

    Theory (F11).
    """
    return 2 * contact.pitch_line_speed * math.sin(contact.mesh.operating_pressure_angle)


def pitch_point_radius(contact: MeshContact) -> float:
    """rho_redC, equivalent radius at the pitch point in the normal section. Theory (F12). [m]"""
    mesh = contact.mesh
    rho1 = mesh.pitch_point
    rho2 = mesh.curvature2(rho1)
    return rho1 * rho2 / ((rho2 + mesh.side * rho1) * math.cos(mesh.gear1.rack.base_helix_angle))


def pitch_point_pressure(contact: MeshContact) -> float:
    """Hertz pressure of F_bt/b on rho_redC. Theory (F18). [Pa]"""
    return hertz_pressure(
        specific_load(contact), pitch_point_radius(contact), contact.flanks.equivalent_modulus
    )


def mean_roughness_ra(contact: MeshContact) -> float:
    """(Ra1 + Ra2)/2 from the rms values of the flanks. Theory (F14). [m]"""
    flanks = contact.flanks
    return RA_OVER_RQ * (flanks.roughness1 + flanks.roughness2) / 2
