"""Shapes of the gears of a case and where they stand, as drawings need them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from epicyclic.build.machine import build as build_machine
from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass
from epicyclic.gears.cutting import Tool, tooth_outline
from epicyclic.gears.gear import Gear
from epicyclic.gears.gearing import Gearing, outside_radius
from epicyclic.gears.mesh import Mesh
from epicyclic.gears.stated import StatedGear
from epicyclic.machine.element import joined_key
from epicyclic.machine.gear_mesh import MeshDuty
from epicyclic.machine.gear_set import GearSet
from epicyclic.study.meshes import variable
from epicyclic.units import DEGREE, MILLIMETRE

if TYPE_CHECKING:
    import xarray as xr


# Where the gears of a set stand, and how they must be turned for their teeth to mesh.

Point = tuple[float, float]  # x and y of a centre. [m]
Place = tuple[float, float, float]  # x and y of the centre [m], direction of the first tooth [rad].
_Stand = tuple[str, int]  # A gear and the number of its place.
UP = math.pi / 2
HALF = 0.5  # Part of a pitch by which a tooth is away from the space beside it.


@dataclass(frozen=True, slots=True)
class SetPlaces:
    """What is to be drawn of a set."""

    tables: Mapping[str, StatedGear]  # Tables of its gears, by name.
    # Where each gear stands; several times on the planets. [m]
    centers: Mapping[str, tuple[Point, ...]]
    bodies: Mapping[str, str]  # The body of each gear: gears of one body turn together.

    def places(self, meshes: Sequence[Mesh]) -> dict[str, list[Place]]:
        """Centres with directions of teeth so that these stand in spaces, the first one upwards.

        Nothing is checked: whether the set can be assembled so is a matter of the case.
        """
        known: dict[_Stand, float] = {}
        stands = [(name, number) for name, at in self.centers.items() for number in range(len(at))]
        while left := [stand for stand in stands if stand not in known]:
            found = next(self._through_meshes(meshes, known), None)
            if found is None:  # where no mesh decides, the gears of one body point the same way
                found = next(self._on_known_bodies(left, known), (left[0], UP))
            stand, turn = found
            known[stand] = turn
        return {
            name: [(*center, known[name, number]) for number, center in enumerate(centers)]
            for name, centers in self.centers.items()
        }

    def _through_meshes(
        self, meshes: Sequence[Mesh], known: Mapping[_Stand, float]
    ) -> Iterator[tuple[_Stand, float]]:
        """Gears whose mates are known, with their directions."""
        centers = self.centers
        for mesh in meshes:
            one, two = mesh.gear1.name, mesh.gear2.name
            for own, other in ((one, two), (two, one)):
                for number in range(max(len(centers[own]), len(centers[other]))):
                    ends = [(name, min(number, len(centers[name]) - 1)) for name in (own, other)]
                    if ends[0] in known and ends[1] not in known:
                        (px, py), (x, y) = (centers[name][place] for name, place in ends)
                        angle = math.atan2(y - py, x - px)
                        yield ends[1], _meshing(mesh, own == one, known[ends[0]], angle)

    def _on_known_bodies(
        self, left: Sequence[_Stand], known: Mapping[_Stand, float]
    ) -> Iterator[tuple[_Stand, float]]:
        """Gears beside which another one of their body is known."""
        for name, number in left:
            for (other, place), turn in known.items():
                if (self.bodies[other], place) == (self.bodies[name], number):
                    yield (name, number), turn

    def relative_speeds(self, meshes: Sequence[Mesh]) -> dict[str, float]:
        """Speed of each gear over that of the first one, seen from the carrier; 0 if unrelated."""
        known = {next(iter(self.bodies.values())): 1.0}
        for mesh in (*meshes,) * len(meshes):  # one may be related by the last of the others
            one, two = self.bodies[mesh.gear1.name], self.bodies[mesh.gear2.name]
            ratio = -mesh.side * mesh.gear1.teeth / mesh.gear2.teeth
            if one in known:
                known.setdefault(two, known[one] * ratio)
            elif two in known:
                known[one] = known[two] / ratio
        return {name: known.get(body, 0.0) for name, body in self.bodies.items()}


def places_of(gearing: Gearing) -> SetPlaces | None:
    """Gears and centres of a set; None if the case does not tell where all of them stand."""
    bodies = gearing.centers
    if not set(gearing.bodies.values()) <= bodies.keys():
        return None
    centers = {
        name: tuple((at.real, at.imag) for at in bodies[body])
        for name, body in gearing.bodies.items()
    }
    return SetPlaces(gearing.tables, centers, gearing.bodies)


def _meshing(
    mesh: Mesh,
    forward: bool,  # True from gear 1 to gear 2.
    turn: float,  # [rad]
    angle: float,  # From the centre of the gear to that of its mate. [rad]
) -> float:
    """Direction of a tooth of the mate of a gear with a tooth at `turn`, its centre lies ahead."""
    one, two = mesh.gear1.teeth, mesh.gear2.teeth
    own, mate = (one, two) if forward else (two, one)
    if not mesh.gear2.internal:
        passed = (angle - turn) * own / (2 * math.pi)
        return angle + math.pi - (HALF - passed) * 2 * math.pi / mate
    # the pitch point lies beyond the pinion, seen from the centre of the internal gear
    outwards = angle + math.pi if forward else angle
    passed = (outwards - turn) * own / (2 * math.pi)
    return outwards - (passed + (HALF if forward else -HALF)) * 2 * math.pi / mate


# Each gear is one dataset: the outline of one tooth about the axis of the gear, the tooth pointing
# along y, and the places at which the gear stands, each with the direction of its first tooth.

POINTS_PER_SECTION = 12  # Points of a drawn outline on each section of half a tooth.


def gear_shapes(case: Case) -> dict[str, xr.Dataset]:
    """Outline and places of every gear of a case, about the axis of the set or of the wheel.

    Of a train the gears of the sets whose losses are computed.

    Returns dict of str to xarray.Dataset: by gear, ``"sun"``, of a train ``"P1.sun"``. ``x``, ``y``
    over ``point``: one tooth from the middle of a space to the middle of the next; absent if the
    tooth has no outline. ``center_x``, ``center_y``, ``direction`` over ``place``. Diameters
    without dimension. Units in ``attrs["units"]``. The attribute ``relative_speed`` is that of the
    gear over that of the first one of its set, seen from the carrier. If it dips, ``oil_depth`` is
    the depth of its lowest point below the oil at rest; where the case dips, ``stands_x``,
    ``stands_y`` over ``place`` are its places in the housing, y upwards.
    """
    return {
        joined_key(prefix, name): _with_oil(case, prefix, own, shape)
        for prefix, found, own, duties in _drawn_sets(case)
        for name, shape in _set_shapes(found, duties).items()
    }


def _with_oil(case: Case, prefix: str, own: GearSet, shape: xr.Dataset) -> xr.Dataset:
    """A gear with its place in the housing, and how deep it dips, where gears of its set do."""
    sumps = {it.where: it.sump for of in own.discs.values() for it in of if it.sump is not None}
    name = shape.attrs["name"]
    stands = case.centers.get(prefix, {}).get(case.gearings[prefix].bodies[name])
    if not sumps or stands is None:
        return shape
    if name in sumps:
        shape = shape.assign(
            oil_depth=variable((), sumps[name].part.depth, "depth in the oil", MILLIMETRE)
        )
    return shape.assign(
        stands_x=variable("place", np.real(stands), "x in the housing", MILLIMETRE),
        stands_y=variable("place", np.imag(stands), "y in the housing", MILLIMETRE),
    )


def mesh_views(case: Case) -> dict[str, xr.Dataset]:
    """Each mesh of a case with the teeth touching at the pitch point, which is the origin.

    Member 1 stands below and pushes to the right, whichever flank carries in the case.

    Returns dict of str to xarray.Dataset: by mesh, ``"sun_mesh"``, of a train ``"P1.sun_mesh"``.
    ``center_x``, ``center_y``, ``direction``, ``operating_radius`` over ``gear``; ``path_x``,
    ``path_y`` over ``end``, where contact begins and ends; ``pressure_angle`` of the line of
    action.
    """
    return {
        joined_key(prefix, duty.gears.key): _view(duty.gears.mesh)
        for prefix, _, _, duties in _drawn_sets(case)
        for duty in duties
    }


def _drawn_sets(case: Case) -> Iterator[tuple[str, SetPlaces, GearSet, tuple[MeshDuty, ...]]]:
    """Name, gears and meshes of every set of which it is known where its gears stand."""
    built = build_machine(case)
    state = built.state()
    for name, own in built.sets.items():
        found = places_of(case.gearings[name])
        if found is not None:
            yield name, found, own, own.mean_duties(state)


def _set_shapes(found: SetPlaces, duties: tuple[MeshDuty, ...]) -> dict[str, xr.Dataset]:
    gears = {
        gear.name: (gear, tool)
        for duty in duties
        for gear, tool in zip(duty.gears.mesh.gears, duty.gears.tools, strict=True)
    }
    meshes = [duty.gears.mesh for duty in duties]
    places, speeds = found.places(meshes), found.relative_speeds(meshes)
    return {
        name: _shape(*gears[name], table, places[name]).assign_attrs(relative_speed=speeds[name])
        for name, table in found.tables.items()
    }


def _shape(gear: Gear, tool: Tool, table: StatedGear, places: list[Place]) -> xr.Dataset:
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
                "outside": outside_radius(gear, table),
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
    # Both teeth touch at the origin: that of gear 1 lies left of its flank there, of gear 2 right.
    turns = (1, mesh.side)
    radii = (mesh.operating_radius1, mesh.operating_radius2)
    directions = [
        math.copysign(math.pi / 2, -height) + turn * gear.half_angle_at(radius)
        for height, turn, gear, radius in zip(heights, turns, mesh.gears, radii, strict=True)
    ]
    ends = np.array([mesh.path_start, mesh.path_end]) - mesh.pitch_point
    path = np.outer(ends, along)
    return xr.Dataset(
        {
            "center_x": variable("gear", np.zeros(2), "x of the centre", MILLIMETRE),
            "center_y": variable("gear", np.array(heights), "y of the centre", MILLIMETRE),
            "direction": variable("gear", np.array(directions), "direction of a tooth", DEGREE),
            "operating_radius": variable("gear", np.array(radii), "operating radius", MILLIMETRE),
            "path_x": variable("end", path[:, 0], "x of the path of contact", MILLIMETRE),
            "path_y": variable("end", path[:, 1], "y of the path of contact", MILLIMETRE),
            "pressure_angle": variable((), alpha, "operating pressure angle", DEGREE),
        },
        {"gear": [gear.name for gear in mesh.gears]},
        {"title": mesh.name},
    )
