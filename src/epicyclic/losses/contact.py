"""Local conditions at every point of the contact lines of a loaded, turning mesh.

Surface speeds across the contact line are omega times the *transverse* radius of curvature: the
sliding velocity is perpendicular to the plane of action. Curvatures are those of the normal section
of the helicoid, rho_n = rho_t/cos(beta_b).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact import Flanks, LineContacts
from epicyclic.geometry.contact_lines import ContactLines
from epicyclic.geometry.mesh import Mesh
from epicyclic.lubricant.properties import OilState

if TYPE_CHECKING:
    from epicyclic.losses.friction.base import FrictionModel

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MeshContact(LineContacts):
    """A mesh under load and in motion, point by point.

    Arrays have shape (n,), one entry for each loaded segment of each contact line at each mesh
    position.

    Attributes
    ----------
    flanks : Flanks
    oil : OilState
    mesh : Mesh
    force : float
        Force of the mesh in the transverse plane, tangent to the base circles. [N]
    speed1, speed2 : float
        Angular speeds of the members relative to the carrier, magnitudes. [rad/s]
    weight : ndarray
        Length of each segment times the weight of its mesh position: sums over it are averages
        over the mesh period. [m]
    path : ndarray
        Position on the path of contact from the pitch point, towards the tip of member 1. [m]
    around : OilState or None
        Oil around the gears, where its temperature is not that of the flanks.
    """

    flanks: Flanks[float]
    oil: OilState
    mesh: Mesh
    force: float
    speed1: float
    speed2: float
    weight: FloatArray
    path: FloatArray
    around: OilState | None = None

    def seen_by(self, model: FrictionModel) -> MeshContact:
        """The contact with the oil at the temperature that a friction model was made for."""
        if self.around is None or not model.takes_oil_temperature:
            return self
        return replace(self, oil=self.around)

    @cached_property
    def pitch_line_speed(self) -> float:
        """Speed of the operating circles relative to the carrier. Theory (C15). [m/s]"""
        return self.speed1 * self.mesh.operating_radius1

    @cached_property
    def input_power(self) -> float:
        """Power through the mesh, relative to the carrier. Theory (C15). [W]"""
        return self.force * self.speed1 * self.mesh.gear1.base_radius


def mesh_contact(
    mesh: Mesh,  # The mesh and its contact lines.
    lines: ContactLines,  # The mesh and its contact lines.
    line_load: FloatArray,  # Load per length of each segment. [N/m]
    *,
    force: float,  # Transverse force along the line of action, positive. [N]
    speed1: float,  # Angular speed of member 1 relative to the carrier, positive. [rad/s]
    oil: OilState,  # Oil at the contacts, and the surfaces.
    flanks: Flanks[float],  # Oil at the contacts, and the surfaces.
    around: OilState | None = None,  # Oil around the gears, if its temperature differs.
) -> MeshContact:
    """Conditions at the loaded segments of `lines`.

    Theory (C2).
    """
    loaded = (lines.length > 0) & (line_load > 0)
    speed2 = speed1 / mesh.ratio
    rho1, rho2 = lines.curvature1[loaded], lines.curvature2[loaded]
    u1, u2 = speed1 * rho1, speed2 * rho2
    return MeshContact(
        mesh=mesh,
        oil=oil,
        flanks=flanks,
        force=force,
        speed1=speed1,
        speed2=speed2,
        weight=(lines.weight[:, None, None] * lines.length)[loaded],
        line_load=line_load[loaded],
        path=rho1 - mesh.pitch_point,
        radius=mesh.equivalent_radius(rho1),
        rolling_speed=(u1 + u2) / 2,
        sliding_speed=u1 - u2,
        around=around,
    )
