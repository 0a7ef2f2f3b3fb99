"""What other programs print, computed: one function for each kind of figure.

Each takes plain values as `programs.toml` has them, among them the name of a case in the folder
``cases``, and returns a number in the unit stated there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from epicyclic.analysis.solve import loaded_meshes, mesh_contacts, solve
from epicyclic.case.case import Case, PlanetaryCase, read_case
from epicyclic.elasticity.loaded_mesh import LoadedMesh
from epicyclic.geometry.mesh import Mesh
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.friction.base import pitch_point_pressure
from epicyclic.losses.mesh import ohlendorf_closed_form, ohlendorf_loss_factor
from epicyclic.results.result import Result

_GEOMETRY: dict[str, Callable[[Mesh], float]] = {
    "pressure_angle": lambda mesh: math.degrees(mesh.operating_pressure_angle),
    "path_of_contact": lambda mesh: 1e3 * (mesh.path_end - mesh.path_start),
    "contact_ratio": lambda mesh: mesh.transverse_contact_ratio,
}


@cache
def _case(name: str) -> Case:
    file = resources.files("epicyclic.validation").joinpath("cases", f"{name}.toml")
    return read_case(Path(str(file)))


@cache
def _contacts(case: str) -> Mapping[str, MeshContact]:
    return mesh_contacts(_case(case))


@cache
def _loaded(case: str) -> Mapping[str, LoadedMesh]:
    return loaded_meshes(_case(case))


@cache
def _solved(case: str, friction: str | float, load_distribution: str = "compliance") -> Result:
    """The case with a friction model, or with a coefficient of friction."""
    changes: dict[str, Any] = {"models.load_distribution": load_distribution}
    if isinstance(friction, str):
        changes["models.friction"] = friction
    else:
        changes |= {"models.friction": "constant", "models.constant_friction": friction}
    return solve(_case(case).updated(changes))


def _planets(case: str) -> int:
    given = _case(case)
    return given.planet.count if isinstance(given, PlanetaryCase) else 1


def mesh_geometry(case: str, mesh: str, figure: str) -> float:
    """Operating pressure angle [deg], path of contact [mm], or transverse contact ratio [1]."""
    return _GEOMETRY[figure](_contacts(case)[mesh].mesh)


def mesh_power(case: str, mesh: str) -> float:
    """Through the meshes of all planets, relative to the carrier. [kW]"""
    return _planets(case) * _contacts(case)[mesh].input_power / 1e3


def loss_factor(case: str, mesh: str) -> float:
    """Ohlendorf's, by the integral. [1]"""
    return ohlendorf_loss_factor(_contacts(case)[mesh].mesh)


def closed_loss_factor(case: str, mesh: str) -> float:
    """Ohlendorf's, by the closed form, beyond its range as well. [1]"""
    return ohlendorf_closed_form(_contacts(case)[mesh].mesh)


def local_loss_factor(case: str, mesh: str, load_distribution: str) -> float:
    """Sliding loss along the contact lines over power and constant friction. [1]"""
    friction = 0.05  # any: it cancels out
    loss = _solved(case, friction, load_distribution).losses[f"{mesh}_sliding"]
    return loss / (friction * _planets(case) * _contacts(case)[mesh].input_power)


def mean_friction(case: str, mesh: str, friction: str) -> float:
    """Mean coefficient of friction of a model. [1]"""
    return _solved(case, friction).meshes[mesh].friction_mean


def closed_loss(case: str, mesh: str, friction: float) -> float:
    """Loss of one mesh: power, friction, and loss factor by the closed form. [kW]"""
    return friction * _contacts(case)[mesh].input_power * closed_loss_factor(case, mesh) / 1e3


def local_loss(case: str, mesh: str, friction: float) -> float:
    """Loss of one mesh, along the contact lines. [kW]"""
    return _solved(case, friction).losses[f"{mesh}_sliding"] / _planets(case) / 1e3


def stage_loss(case: str, **friction: float) -> float:
    """Loss of all meshes, along the contact lines, with the friction of each. [kW]"""
    return sum(_planets(case) * local_loss(case, mesh, it) for mesh, it in friction.items())


def sliding_loss(case: str, mesh: str, load_distribution: str, friction: str | float) -> float:
    """Along the contact lines. [W]"""
    return _solved(case, friction, load_distribution).losses[f"{mesh}_sliding"]


def pitch_pressure(case: str, mesh: str) -> float:
    """Hertz pressure at the pitch point. [MPa]"""
    return pitch_point_pressure(_contacts(case)[mesh]) / 1e6


def smallest_film(case: str, mesh: str) -> float:
    """Smallest minimum film along the contact lines. [um]"""
    return float(_contacts(case)[mesh].minimum_film.min()) * 1e6


def largest_film(case: str, mesh: str) -> float:
    """Largest minimum film along the contact lines. [um]"""
    return float(_contacts(case)[mesh].minimum_film.max()) * 1e6


def program_single_stiffness(case: str, mesh: str) -> float:
    """c' of a mesh under its load. [N/(mm um)]"""
    return single_stiffness_of(_loaded(case)[mesh])


def program_mesh_stiffness(case: str, mesh: str) -> float:
    """c_gamma_alpha of a mesh under its load. [N/(mm um)]"""
    return mesh_stiffness_of(_loaded(case)[mesh])


def single_stiffness_of(mesh: LoadedMesh) -> float:
    """c': largest stiffness of a lone pair of teeth per face width. [N/(mm um)]"""
    alone = (mesh.pair_force > 0).sum(axis=1) == 1
    return float(mesh.secant_stiffness[alone].max()) / mesh.mesh.face_width / 1e9


def mesh_stiffness_of(mesh: LoadedMesh) -> float:
    """c_gamma: mean stiffness over the mesh period per face width. [N/(mm um)]"""
    return mesh.mean(mesh.secant_stiffness) / mesh.mesh.face_width / 1e9


PROGRAM_FIGURES: dict[str, Callable[..., float]] = {
    function.__name__: function
    for function in (
        mesh_geometry,
        mesh_power,
        loss_factor,
        closed_loss_factor,
        local_loss_factor,
        mean_friction,
        closed_loss,
        local_loss,
        stage_loss,
        sliding_loss,
        pitch_pressure,
        smallest_film,
        largest_film,
        program_single_stiffness,
        program_mesh_stiffness,
    )
}
