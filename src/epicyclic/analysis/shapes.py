"""Shapes of the gears of a case and where they stand, as drawings need them.

Each gear is one dataset: the outline of one tooth about the axis of the gear, the tooth pointing
along y, and the places at which the gear stands, each with the direction of its first tooth.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from epicyclic.analysis.datasets import variable
from epicyclic.analysis.gear_places import Place, SetPlaces, places_of
from epicyclic.builders.build import build as build_machine
from epicyclic.builders.train import set_cases
from epicyclic.case import build
from epicyclic.case.case import Case
from epicyclic.case.gear_tables import GearTable
from epicyclic.elements.base import joined_key
from epicyclic.elements.gear_mesh import MeshDuty
from epicyclic.geometry.gear import Gear
from epicyclic.geometry.mesh import Mesh
from epicyclic.geometry.outline import tooth_outline
from epicyclic.geometry.tools import Tool
from epicyclic.units import DEGREE, MILLIMETRE

if TYPE_CHECKING:
    import xarray as xr

POINTS_PER_SECTION = 12
"""Points of a drawn outline on each section of half a tooth."""


def gear_shapes(case: Case) -> dict[str, xr.Dataset]:
    """Outline and places of every gear of a case, about the axis of the set or of the wheel.

    Of a train the gears of the sets whose losses are computed.

    Returns
    -------
    dict of str to xarray.Dataset
        By gear, ``"sun"``, of a train ``"P1.sun"``. ``x``, ``y`` over ``point``: one tooth from the
        middle of a space to the middle of the next; absent if the tooth has no outline.
        ``center_x``, ``center_y``, ``direction`` over ``place``. Diameters without dimension. Units
        in ``attrs["units"]``. The attribute ``relative_speed`` is that of the gear over that of the
        first one of its set, seen from the carrier.
    """
    return {
        joined_key(prefix, name): shape
        for prefix, found, duties in _drawn_sets(case)
        for name, shape in _set_shapes(found, duties).items()
    }


def mesh_views(case: Case) -> dict[str, xr.Dataset]:
    """Each mesh of a case with the teeth touching at the pitch point, which is the origin.

    Member 1 stands below and pushes to the right, whichever flank carries in the case.

    Returns
    -------
    dict of str to xarray.Dataset
        By mesh, ``"sun_mesh"``, of a train ``"P1.sun_mesh"``. ``center_x``, ``center_y``,
        ``direction``, ``operating_radius`` over ``gear``; ``path_x``, ``path_y`` over ``end``,
        where contact begins and ends; ``pressure_angle`` of the line of action.
    """
    return {
        joined_key(prefix, duty.key): _view(duty.mesh)
        for prefix, _, duties in _drawn_sets(case)
        for duty in duties
    }


def _drawn_sets(case: Case) -> Iterator[tuple[str, SetPlaces, tuple[MeshDuty, ...]]]:
    """Name, gears and meshes of every set of which it is known where its gears stand."""
    built = build_machine(case)
    state = built.state()
    for name, own in set_cases(case, built.sets):
        duties = built.sets[name].mean_duties(state)
        found = places_of(own, {duty.key: duty.mesh for duty in duties})
        if found is not None:
            yield name, found, duties


def _set_shapes(found: SetPlaces, duties: tuple[MeshDuty, ...]) -> dict[str, xr.Dataset]:
    gears = {
        gear.name: (gear, tool)
        for duty in duties
        for gear, tool in zip((duty.mesh.gear1, duty.mesh.gear2), duty.tools, strict=True)
    }
    meshes = [duty.mesh for duty in duties]
    places, speeds = found.places(meshes), found.relative_speeds(meshes)
    return {
        name: _shape(*gears[name], table, places[name]).assign_attrs(relative_speed=speeds[name])
        for name, table in found.tables.items()
    }


# --- datasets -------------------------------------------------------------------------------------


def _shape(gear: Gear, tool: Tool, table: GearTable, places: list[Place]) -> xr.Dataset:
    import xarray as xr

    x, y, direction = np.array(places).T
    variables = {
        "center_x": variable("place", x, "x of the centre", MILLIMETRE),
        "center_y": variable("place", y, "y of the centre", MILLIMETRE),
        "direction": variable("place", direction, "direction of the first tooth", DEGREE),
        **{
            f"{name}_diameter": variable((), 2 * radius, f"{name} diameter", MILLIMETRE)
            for name, radius in {
                "tip": gear.tip_radius,
                "root": gear.root_radius,
                "base": gear.base_radius,
                "reference": gear.reference_radius,
                "outside": build.outside_radius(gear, table),
            }.items()
        },
    }
    try:
        points = tooth_outline(gear, tool, POINTS_PER_SECTION).points(1)
    except ValueError:  # drawn as circles
        pass
    else:
        variables["x"] = variable("point", points[:, 0], "x of the outline", MILLIMETRE)
        variables["y"] = variable("point", points[:, 1], "y of the outline", MILLIMETRE)
    attributes = {"name": gear.name, "teeth": gear.teeth, "internal": int(gear.internal)}
    return xr.Dataset(variables, attrs=attributes)


def _view(mesh: Mesh) -> xr.Dataset:
    import xarray as xr

    alpha = mesh.operating_pressure_angle
    along = np.array([math.cos(alpha), math.sin(alpha)])
    heights = (-mesh.operating_radius1, mesh.side * mesh.operating_radius2)
    gears = (mesh.gear1, mesh.gear2)
    # Both teeth touch at the origin: that of gear 1 lies left of its flank there, of gear 2 right.
    turns = (1, mesh.side)
    radii = (mesh.operating_radius1, mesh.operating_radius2)
    directions = [
        math.copysign(math.pi / 2, -height) + turn * gear.half_angle_at(radius)
        for height, turn, gear, radius in zip(heights, turns, gears, radii, strict=True)
    ]
    ends = np.array([mesh.path_start, mesh.path_end]) - mesh.pitch_point
    path = np.outer(ends, along)
    return xr.Dataset(
        {
            "center_x": variable("gear", np.zeros(2), "x of the centre", MILLIMETRE),
            "center_y": variable("gear", np.array(heights), "y of the centre", MILLIMETRE),
            "direction": variable("gear", np.array(directions), "direction of a tooth", DEGREE),
            "operating_radius": variable(
                ("gear",), np.array(radii), "operating radius", MILLIMETRE
            ),
            "path_x": variable("end", path[:, 0], "x of the path of contact", MILLIMETRE),
            "path_y": variable("end", path[:, 1], "y of the path of contact", MILLIMETRE),
            "pressure_angle": variable((), alpha, "operating pressure angle", DEGREE),
        },
        {"gear": [gear.name for gear in gears]},
        {"title": mesh.name},
    )
