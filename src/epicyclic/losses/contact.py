"""Local conditions at every point of the contact lines of a loaded, turning mesh.

Surface speeds across the contact line are omega times the *transverse* radius of curvature: the
sliding velocity is perpendicular to the plane of action. Curvatures are those of the normal section
of the helicoid, rho_n = rho_t/cos(beta_b).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from epicyclic.geometry.contact_lines import ContactLines
from epicyclic.geometry.mesh import Mesh
from epicyclic.kernels.line_contact import (
    hertz_half_width,
    hertz_pressure,
    pan_hamrock_minimum_film,
)
from epicyclic.losses.validity import Range, held_in_range
from epicyclic.lubricant.properties import OilState

__all__ = ["Flanks", "MeshContact", "mesh_contact"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Flanks:
    """The two surfaces in contact.

    Attributes
    ----------
    equivalent_modulus : float
        E_eq. [Pa]
    roughness1, roughness2 : float
        rms. [m]
    """

    equivalent_modulus: float
    roughness1: float
    roughness2: float

    @property
    def composite_roughness(self) -> float:
        """sqrt(Rq1^2 + Rq2^2). Theory (C12). [m]"""
        return math.hypot(self.roughness1, self.roughness2)

    @property
    def reduced_roughness(self) -> float:
        """Rq1 Rq2/(Rq1 + Rq2). Talbot (2012), p. 137. Theory (C13). [m]"""
        return self.roughness1 * self.roughness2 / (self.roughness1 + self.roughness2)

    def held_in(self, roughness: Range) -> Flanks:
        """The same with the roughness of each flank held in a range. Theory (F5)."""
        return replace(
            self,
            roughness1=held_in_range(self.roughness1, roughness),
            roughness2=held_in_range(self.roughness2, roughness),
        )


@dataclass(frozen=True, eq=False)
class MeshContact:
    """A mesh under load and in motion, point by point.

    Arrays have shape (n,), one entry for each loaded segment of each contact line at each mesh
    position.

    Attributes
    ----------
    mesh : Mesh
    oil : OilState
    flanks : Flanks
    force : float
        Force of the mesh in the transverse plane, tangent to the base circles. [N]
    speed1, speed2 : float
        Angular speeds of the members relative to the carrier, magnitudes. [rad/s]
    weight : ndarray
        Length of each segment times the weight of its mesh position: sums over it are averages
        over the mesh period. [m]
    line_load : ndarray
        W'. [N/m]
    path : ndarray
        Position on the path of contact from the pitch point, towards the tip of member 1. [m]
    radius : ndarray
        Equivalent radius of curvature in the normal section. [m]
    rolling_speed : ndarray
        u_r = (u1 + u2)/2. [m/s]
    sliding_speed : ndarray
        u_s = u1 - u2. [m/s]
    """

    mesh: Mesh
    oil: OilState
    flanks: Flanks
    force: float
    speed1: float
    speed2: float
    weight: FloatArray
    line_load: FloatArray
    path: FloatArray
    radius: FloatArray
    rolling_speed: FloatArray
    sliding_speed: FloatArray

    @cached_property
    def slide_to_roll_ratio(self) -> FloatArray:
        """abs(u_s)/u_r. Theory (C4). [1]"""
        ratio: FloatArray = np.abs(self.sliding_speed) / self.rolling_speed
        return ratio

    @cached_property
    def hertz_pressure(self) -> FloatArray:
        """p_h. [Pa]"""
        return hertz_pressure(self.line_load, self.radius, self.flanks.equivalent_modulus)

    @cached_property
    def hertz_half_width(self) -> FloatArray:
        """b_h. [m]"""
        return hertz_half_width(self.line_load, self.radius, self.flanks.equivalent_modulus)

    @cached_property
    def speed_number(self) -> FloatArray:
        """U = u_r mu/(E_eq R_eq). Theory (C7). [1]"""
        number: FloatArray = (
            self.rolling_speed
            * self.oil.dynamic_viscosity
            / (self.flanks.equivalent_modulus * self.radius)
        )
        return number

    @cached_property
    def material_number(self) -> float:
        """G = alpha E_eq. Theory (C8). [1]"""
        return self.oil.pressure_viscosity * self.flanks.equivalent_modulus

    @cached_property
    def load_number(self) -> FloatArray:
        """W = W'/(E_eq R_eq). Theory (C9). [1]"""
        number: FloatArray = self.line_load / (self.flanks.equivalent_modulus * self.radius)
        return number

    @cached_property
    def minimum_film(self) -> FloatArray:
        """h_min of the smooth contact (Pan and Hamrock). Theory (C10). [m]"""
        film: FloatArray = self.radius * pan_hamrock_minimum_film(
            self.speed_number, self.material_number, self.load_number
        )
        return film

    @cached_property
    def film_ratio(self) -> FloatArray:
        """Lambda = h_min/sqrt(Rq1^2 + Rq2^2). Theory (C14). [1]"""
        ratio: FloatArray = self.minimum_film / self.flanks.composite_roughness
        return ratio

    @property
    def temperature(self) -> float:
        """Of the oil at the contacts. [K]"""
        return self.oil.temperature

    @property
    def dynamic_viscosity(self) -> float:
        """Of the oil at the inlet of the contacts. [Pa s]"""
        return self.oil.dynamic_viscosity

    @property
    def pressure_viscosity(self) -> float:
        """Of the oil. [1/Pa]"""
        return self.oil.pressure_viscosity

    @property
    def roughness(self) -> tuple[float, float]:
        """rms roughness of both flanks. [m]"""
        return self.flanks.roughness1, self.flanks.roughness2

    @property
    def composite_roughness(self) -> float:
        """sqrt(Rq1^2 + Rq2^2). [m]"""
        return self.flanks.composite_roughness

    @cached_property
    def pitch_line_speed(self) -> float:
        """Speed of the operating circles relative to the carrier. Theory (C15). [m/s]"""
        return self.speed1 * self.mesh.operating_radius1

    @cached_property
    def input_power(self) -> float:
        """Power through the mesh, relative to the carrier. Theory (C15). [W]"""
        return self.force * self.speed1 * self.mesh.gear1.base_radius


def mesh_contact(
    mesh: Mesh,
    lines: ContactLines,
    line_load: FloatArray,
    *,
    force: float,
    speed1: float,
    oil: OilState,
    flanks: Flanks,
) -> MeshContact:
    """Conditions at the loaded segments of `lines`.

    Theory (C2).

    Parameters
    ----------
    mesh, lines
        The mesh and its contact lines.
    line_load : ndarray, shape (positions, lines, segments)
        Load per length of each segment. [N/m]
    force : float
        Transverse force along the line of action, positive. [N]
    speed1 : float
        Angular speed of member 1 relative to the carrier, positive. [rad/s]
    oil, flanks
        Oil at the contacts, and the surfaces.
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
    )
