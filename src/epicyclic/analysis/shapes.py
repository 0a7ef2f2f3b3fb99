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
from epicyclic.builders.build import build as build_machine
from epicyclic.builders.train import set_cases
from epicyclic.case import build
from epicyclic.case.case import Case, GearPairCase, PlanetaryCase
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

__all__ = ["gear_shapes", "mesh_views"]

Place = tuple[float, float, float]
"""x and y of the centre [m], direction of the first tooth [rad]."""

POINTS_PER_SECTION = 12
"""Points of a drawn outline on each section of half a tooth."""
HALF = 0.5
"""Of a pitch: what a tooth is from the space beside it."""


def gear_shapes(case: Case) -> dict[str, xr.Dataset]:
    """Outline and places of every gear of a case, about the axis of the set or of the wheel.

    Of a train the gears of the sets whose losses are computed, but for those that are listed.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase

    Returns
    -------
    dict of str to xarray.Dataset
        By gear, ``"sun"``, of a train ``"P1.sun"``. ``x``, ``y`` over ``point``: one tooth from the
        middle of a space to the middle of the next; absent if the tooth has no outline.
        ``center_x``, ``center_y``, ``direction`` over ``place``. Diameters without dimension. Units
        in ``attrs["units"]``.
    """
    return {
        joined_key(prefix, name): shape
        for prefix, own, duties in _drawn_sets(case)
        for name, shape in _set_shapes(own, duties).items()
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


def _drawn_sets(
    case: Case,
) -> Iterator[tuple[str, PlanetaryCase | GearPairCase, tuple[MeshDuty, ...]]]:
    """Name, case and meshes of every set that is drawn: not those whose gears are listed."""
    built = build_machine(case)
    state = built.state()
    for name, own in set_cases(case, built.sets):
        if isinstance(own, PlanetaryCase | GearPairCase):
            yield name, own, built.sets[name].mean_duties(state)


def _set_shapes(
    case: PlanetaryCase | GearPairCase, duties: tuple[MeshDuty, ...]
) -> dict[str, xr.Dataset]:
    tables: dict[str, GearTable]
    pairs = [
        ((duty.mesh.gear1, duty.tools[0]), (duty.mesh.gear2, duty.tools[1])) for duty in duties
    ]
    if isinstance(case, PlanetaryCase):
        tables = {"sun": case.sun, "planet": case.planet, "ring": case.ring}
        places = _planetary_places(case)
    else:
        tables = {"pinion": case.pinion, "gear": case.gear}
        places = _pair_places(case.gears.center_distance, *pairs[0])
    gears = {gear.name: (gear, tool) for pair in pairs for gear, tool in pair}
    return {name: _shape(*gears[name], table, places[name]) for name, table in tables.items()}


# --- where gears stand ----------------------------------------------------------------------------


def _planetary_places(case: PlanetaryCase) -> dict[str, list[Place]]:
    """The sun with a tooth upwards, the planets in its spaces, the ring on the first planet."""
    radius = case.gears.center_distance
    angles = [
        math.pi / 2 + angle for angle in build.planet_angles(case.sun, case.planet, case.ring)
    ]
    sun = math.pi / 2
    teeth = case.sun.teeth, case.planet.teeth
    planets = [
        (radius * math.cos(angle), radius * math.sin(angle), _outside(sun, angle, *teeth))
        for angle in angles
    ]
    ring = _around(planets[0][2], angles[0], case.planet.teeth, case.ring.teeth)
    return {"sun": [(0.0, 0.0, sun)], "planet": planets, "ring": [(0.0, 0.0, ring)]}


def _pair_places(
    distance: float, pinion: tuple[Gear, Tool], wheel: tuple[Gear, Tool]
) -> dict[str, list[Place]]:
    """The pinion at the origin, or inside an internal gear there."""
    teeth, up = (pinion[0].teeth, wheel[0].teeth), math.pi / 2
    if wheel[0].internal:
        around = _around(up, 0.0, *teeth)
        return {"pinion": [(distance, 0.0, up)], "gear": [(0.0, 0.0, around)]}
    return {"pinion": [(0.0, 0.0, up)], "gear": [(distance, 0.0, _outside(up, 0.0, *teeth))]}


def _outside(direction1: float, angle: float, teeth1: int, teeth2: int) -> float:
    """Direction of a tooth of gear 2, beside gear 1 at `angle`, whose spaces take its teeth."""
    passed = (angle - direction1) * teeth1 / (2 * math.pi)
    return angle + math.pi - (HALF - passed) * 2 * math.pi / teeth2


def _around(direction1: float, angle: float, teeth1: int, teeth2: int) -> float:
    """Direction of a tooth of the internal gear 2 around gear 1, which stands at `angle`."""
    passed = (angle - direction1) * teeth1 / (2 * math.pi)
    return angle - (passed + HALF) * 2 * math.pi / teeth2


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
