"""Contacts of gear teeth made to order, of given local conditions or of a loaded mesh."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from epicyclic.contact.line_contact import Flanks
from epicyclic.gears.mesh import Mesh
from epicyclic.losses.contact import MeshContact, load_shape, mesh_contact
from epicyclic.oil.oil import OilState
from epicyclic.plugins.contact_solver.surfaces import Profile

STEEL = 227.47e9
"""Equivalent modulus of two steel flanks. [Pa]"""


MESHES = [
    pytest.param({"teeth1": 20, "teeth2": 41}, id="spur"),
    pytest.param({"teeth1": 20, "teeth2": 41, "beta": 0.5}, id="nearly spur"),
    pytest.param({"teeth1": 30, "teeth2": 50, "beta": 15.0}, id="helical"),
    pytest.param({"teeth1": 30, "teeth2": 50, "beta": 30.0, "width": 60e-3}, id="wide"),
    pytest.param({"teeth1": 24, "teeth2": 90, "internal": True}, id="internal spur"),
    pytest.param({"teeth1": 24, "teeth2": 90, "internal": True, "beta": 20.0}, id="internal"),
    pytest.param({"teeth1": 60, "teeth2": 70, "addendum": 1.4, "dedendum": 1.6}, id="three pairs"),
    pytest.param(
        {"teeth1": 40, "teeth2": 50, "addendum": 0.4, "beta": 20.0, "width": 40e-3},
        id="transverse contact ratio below 1",
    ),
]
"""Arguments of `make_mesh` for meshes of every kind."""


def oil(
    viscosity: float = 10e-3,
    pressure_viscosity: float = 15e-9,
    *,
    thermoviscosity: float = 0.03,
    thermal_conductivity: float = 0.14,
    lubricant_factor: float = 1.0,
) -> OilState:
    """An oil at 80 degC."""
    density = 850.0
    return OilState(
        temperature=353.15,
        kinematic_viscosity=viscosity / density,
        density=density,
        dynamic_viscosity=viscosity,
        pressure_viscosity=pressure_viscosity,
        thermoviscosity=thermoviscosity,
        thermal_conductivity=thermal_conductivity,
        lubricant_factor=lubricant_factor,
        pressure_viscosity_exponent=0.139,
        limiting_traction=0.047,
        boundary_friction=0.065,
    )


def contact_points(
    mesh: Mesh,
    *,
    line_load: Any,
    radius: Any,
    rolling: Any,
    sliding: Any,
    oil: OilState,
    rough: tuple[float, float] = (0.0, 0.0),
    **given: float,
) -> MeshContact:
    """A contact of given local conditions; the mesh counts for mean models only."""
    names = ("line_load", "radius", "rolling_speed", "sliding_speed")
    values = np.broadcast_arrays(*map(np.atleast_1d, (line_load, radius, rolling, sliding)))
    size = values[0].size
    whole = {"force": 5000.0, "speed1": 100.0} | given
    return MeshContact(
        mesh=mesh,
        oil=oil,
        flanks=Flanks(STEEL, *rough),
        speed2=whole["speed1"] / mesh.ratio,
        weight=np.full(size, 1e-3),
        path=np.zeros(size),
        **whole,
        **{name: value.astype(float) for name, value in zip(names, values, strict=True)},
    )


def loaded_contact(
    mesh: Mesh,
    oil: OilState,
    *,
    torque: float = 200.0,
    speed: float = 200.0,
    model: str = "uniform",
    positions: int = 20,
    segments: int = 20,
    rough: tuple[float, float] = (0.4e-6, 0.4e-6),
) -> MeshContact:
    """The contact of a mesh under load, as `solve` makes it."""
    lines, shape = load_shape(mesh, model, positions, segments)
    force = torque / mesh.gear1.base_radius
    return mesh_contact(
        mesh, lines, force * shape, force=force, speed1=speed, oil=oil, flanks=Flanks(STEEL, *rough)
    )


def with_overlap_ratio(mesh: Mesh, overlap: float) -> Mesh:
    """The mesh of gears so wide that it has this overlap ratio."""
    width = overlap * mesh.face_width / mesh.overlap_ratio
    return replace(
        mesh,
        gear1=replace(mesh.gear1, face_width=width),
        gear2=replace(mesh.gear2, face_width=width),
    )


def sinusoidal_profile(amplitude: float, wavelength: float) -> Profile:
    """One wave. `amplitude` from its mean line. [m]"""
    points = 64
    phase = np.arange(points) * (2 * math.pi / points)
    return Profile(amplitude * np.cos(phase), wavelength / points)
