"""Everything about the pockets of the meshes of a case, through their whole life."""

from __future__ import annotations

import math
from collections.abc import Collection
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.build.machine import build
from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import InputError, one_problem
from epicyclic.gears.cutting import Tool, tooth_outline
from epicyclic.gears.gear import Gear
from epicyclic.losses.pocket_flow import POCKETING_MODELS, PocketFlow, PocketModel, sound_speed
from epicyclic.losses.pocket_geometry import (
    PocketGeometry,
    contact_clearances,
    gap_feet,
    pocket_outlines,
)
from epicyclic.losses.pocket_tables import FLOW_NUMBERS, FlowFamily, flow_figures
from epicyclic.machine.element import Fluids, joined_key
from epicyclic.machine.gear_mesh import MeshDuty
from epicyclic.machine.pocket_flow import flow_family, oil_in_mesh, pocket_notes, solve_pockets
from epicyclic.result.result import of_gear
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.meshes import Array, Variable, mesh_words, variable
from epicyclic.study.solve import build_computed
from epicyclic.units import (
    BAR,
    CUBIC_MILLIMETRE,
    DEGREE,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    NUMBER,
    RPM,
    SQUARE_MILLIMETRE,
    WATT,
)

if TYPE_CHECKING:
    import xarray as xr

_LIFE = ("tooth", "roll")
_AXIS = "axis"


def pocket_details(
    case: CaseSource, meshes: Collection[str] | None = None
) -> dict[str, xr.Dataset]:
    """Shape, pressure, flow and power of the pockets of every mesh of a case.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
    meshes : collection of str, optional
        The meshes, ``"sun_mesh"``, of a train ``"P1.sun_mesh"``; default: all.

    Returns
    -------
    dict of str to xarray.Dataset
        By mesh, ``"sun_mesh"``, each of one planet. A pocket is named after the member whose tooth
        is in a space of the other (dimension ``tooth``), and followed over ``roll``, the angle of
        that tooth of member 1, or of that space of member 1, from the line of centres, at the first
        end of the face. ``slice`` counts cells across the face, ``station`` their ends, ``end`` is
        the first or last end of the face, ``mesh_position`` one mesh period: every
        ``mesh_position``-th value along ``roll`` is a pocket that lives at the same time. NaN where
        there is no pocket. Numbers that belong to the whole mesh have no dimension. Each variable
        has its unit in ``attrs["units"]``.

    Raises
    ------
    InputError
        If the gears do not turn against each other or have no tooth outline, or if the case is a
        train of given efficiencies.
    ConvergenceError
        If the flow is not found.
    """
    case = as_case(case)
    built = build_computed(case)
    fluids = built.fluids if built.thermal is None else built.loaded_state().fluids
    found = {}
    for name, own in built.sets.items():
        for duty in own.mean_duties(built.state()):
            key = joined_key(name, duty.gears.key)
            if meshes is not None and key not in meshes:
                continue
            try:
                flow = solve_pockets(duty, fluids)
            except ValueError as error:
                raise _unsuitable(case, key, f"has no tooth outline: {error}.") from None
            if flow is None:
                raise _unsuitable(case, key, "does not turn, so its pockets keep their volume.")
            found[key] = _dataset(case.title, key, duty, flow, fluids, own.count)
    return found


def mesh_duties(case: Case) -> tuple[MeshDuty, ...]:
    """The mesh of a pair, or the meshes of one planet of equal load."""
    return tuple(build(case).mean_duties().values())


def _unsuitable(case: Case, key: str, what: str) -> InputError:
    remedy = "Change operation.speed, or the tooth (tip and root diameter, tool_tip_radius)."
    return one_problem(key, "", what, remedy, case.source)


@dataclass(frozen=True, slots=True, eq=False)
class _Life:
    """Both kinds of pocket through their life. First indices: kind of pocket, step of its life."""

    geometry: PocketGeometry
    flow: PocketFlow
    drives1: bool

    @property
    def roll(self) -> FloatArray:
        """Angle at the first end of the face. [rad]"""
        return self.of_pockets(self.flow.angle[:, None] + self.flow.place)

    @property
    def section(self) -> FloatArray:
        """Angle at every station. [rad]"""
        return self.roll[..., None] + self.flow.station

    def of_pockets(self, values: Array, first: int = 0) -> FloatArray:
        """Values over a period of places from number `first` on, as life of both kinds of pocket.

        What one pocket does in the next period, the pocket before it does in this one.
        """
        pockets = self.flow.live.shape[1]
        kinds = [values[:, first + kind : first + pockets : 2] for kind in (0, 1)]
        lives = [np.moveaxis(kind, 1, 0)[::-1] for kind in kinds]
        return np.stack([life.reshape(-1, *life.shape[2:]) for life in lives])

    @property
    def living(self) -> BoolArray:
        """Which sections are pockets, at every station."""
        birth, death = (self.geometry.life[:, k, None, None] for k in (0, 1))
        return (self.section >= birth) & (self.section <= death)

    def read(self, table: FloatArray) -> FloatArray:
        """A table of the geometry over its angle, at every station."""
        return np.stack(
            [np.interp(self.section[k], self.geometry.angle[k], table[k]) for k in (0, 1)]
        )

    def mean_area(self) -> FloatArray:
        """Area of the section where it is a pocket, mean over the face. [m^2]"""
        from scipy.integrate import cumulative_trapezoid  # 40 MB that maps do without

        first, last = self.section[..., 0], self.section[..., -1]
        if first[0, 0] == last[0, 0]:
            return np.where(self.living[..., 0], self.read(self.geometry.area)[..., 0], 0.0)
        means = []
        for k, (birth, death) in enumerate(self.geometry.life):
            angle, area = self.geometry.angle[k], self.geometry.area[k]
            swept = cumulative_trapezoid(area, angle, initial=0.0)
            low, high = (
                np.interp(np.clip(at[k], birth, death), angle, swept) for at in (first, last)
            )
            means.append((high - low) / self.flow.station[-1])
        return np.stack(means)

    def beside(self, leading: bool) -> FloatArray:
        """Angle of the tooth of member 1 whose leading or trailing flank bounds the pocket. [rad]

        A space of member 1 lies between the leading flank of the tooth behind it and the trailing
        flank of the tooth ahead.
        """
        half_pitch = self.geometry.pitch / 2
        turn = np.array([0.0, -half_pitch if leading else half_pitch])
        beside: FloatArray = self.section + turn[:, None, None]
        return beside

    @property
    def gaps(self) -> tuple[FloatArray, FloatArray]:
        """Gaps that bound the pockets at every station, of contact and of backlash side. [m]"""
        leading, trailing = (
            np.interp(self.beside(k == 0), self.geometry.gap_angle, self.geometry.gap[k])
            for k in (0, 1)
        )
        return (leading, trailing) if self.drives1 else (trailing, leading)

    @property
    def gap_speeds(self) -> tuple[FloatArray, FloatArray]:
        """Speeds out of the pockets through the gaps of contact and of backlash side. [m/s]"""
        before = -self.of_pockets(self.flow.gap_speed)
        after = self.of_pockets(self.flow.gap_speed, first=1)
        # the gap before a tooth of member 1 is at its leading flank, that before a space of it at
        # the trailing flank of the tooth ahead
        leading, trailing = np.stack([before[0], after[1]]), np.stack([after[0], before[1]])
        return (leading, trailing) if self.drives1 else (trailing, leading)


def _dataset(
    title: str, key: str, duty: MeshDuty, flow: PocketFlow, fluids: Fluids, meshes: int
) -> xr.Dataset:
    import xarray as xr

    family = flow_family(duty)
    mesh = family.mesh
    life = _Life(family.geometry, flow, family.drives1)
    stations = flow.face
    coordinates = {
        "tooth": [mesh.gear1.name, mesh.gear2.name],
        "roll_angle": variable(_LIFE, life.roll, "roll angle of the pocket", DEGREE),
        "slice_position": variable(
            ("slice",), (stations[1:] + stations[:-1]) / 2, "position across the face", MILLIMETRE
        ),
        "station_position": variable("station", stations, "position across the face", MILLIMETRE),
        "period_angle": variable(
            ("mesh_position",), flow.angle, f"roll angle {of_gear(mesh.gear1.name)}", DEGREE
        ),
        "end": ["first", "last"],
        "axis": ["x", "y"],
    }
    variables = {
        **_shapes(life, mesh.face_width),
        **_flows(life),
        **_pictures(family, life),
        **_numbers(duty, flow, fluids),
    }
    attributes = {
        "title": f"Pockets of {'' if '.' in key else 'the '}{mesh_words(key)} of "
        f"{title or 'the case'}",
        "notes": "\n".join(pocket_notes(duty, flow_figures(flow), fluids, meshes)),
        "model": POCKETING_MODELS[duty.gears.models.pockets.model],
        "drives": mesh.gear1.name if family.drives1 else mesh.gear2.name,
        "members": f"{mesh.gear1.name} {mesh.gear2.name}",
        "internal": int(mesh.internal),
        "teeth": [mesh.gear1.teeth, mesh.gear2.teeth],
        "meshes": meshes,
    }
    return xr.Dataset(variables, coordinates, attributes)


def _shapes(life: _Life, width: float) -> dict[str, Variable]:
    """What the geometry tells."""
    area = life.read(life.geometry.area)
    alive = life.of_pockets(life.flow.live).astype(bool)
    slices = np.where(
        alive, np.diff(life.flow.face) * (area[..., 1:] + area[..., :-1]) / 2, math.nan
    )
    volume = np.where(alive.any(axis=-1), width * life.mean_area(), math.nan)
    contact, backlash = life.gaps
    centroid = [life.read(life.geometry.centroid[..., k]) for k in (0, 1)]
    station = (*_LIFE, "station")

    def known(values: FloatArray) -> FloatArray:
        return np.where(life.living, values, math.nan)

    return {
        "live": (
            (*_LIFE, "slice"),
            alive,
            {"long_name": "whether a slice is a pocket", "units": "1"},
        ),
        "end_area": variable(station, known(area), "area of the section", SQUARE_MILLIMETRE),
        "slice_volume": variable((*_LIFE, "slice"), slices, "volume of a slice", CUBIC_MILLIMETRE),
        "volume": variable(_LIFE, volume, "volume of the pocket", CUBIC_MILLIMETRE),
        "contact_gap": variable(station, known(contact), "gap at the contact side", MICROMETRE),
        "backlash_gap": variable(station, known(backlash), "gap at the backlash side", MICROMETRE),
        "centroid": variable(
            (*station, _AXIS),
            np.stack([known(values) for values in centroid], axis=-1),
            "centroid of the section, axis of member 1 at the origin",
            MILLIMETRE,
        ),
    }


def _flows(life: _Life) -> dict[str, Variable]:
    """What the flow tells."""
    flow = life.flow
    alive = life.of_pockets(flow.live).astype(bool)
    cells = (*_LIFE, "slice")
    # an axial opening is one as long as either slice beside it lives
    beside = np.pad(alive, ((0, 0), (0, 0), (1, 1)))
    opening = beside[..., 1:] | beside[..., :-1]

    def known(values: FloatArray, where: BoolArray = alive) -> FloatArray:
        return np.where(where, values, math.nan)

    contact, backlash = life.gap_speeds
    return {
        "pressure": variable(
            cells, known(life.of_pockets(flow.pressure)), "pressure above ambient", BAR
        ),
        "axial_speed": variable(
            (*_LIFE, "station"),
            known(life.of_pockets(flow.axial_speed), opening),
            "axial speed, towards the last end",
            METRE_PER_SECOND,
        ),
        "contact_gap_speed": variable(
            cells, known(contact), "speed out through the contact side", METRE_PER_SECOND
        ),
        "backlash_gap_speed": variable(
            cells, known(backlash), "speed out through the backlash side", METRE_PER_SECOND
        ),
        "instant_power": variable(("mesh_position",), flow.instant_power, "power", WATT),
    }


def _pictures(family: FlowFamily, life: _Life) -> dict[str, Variable]:
    """What a picture of the transverse section at both ends of the face needs."""
    mesh = family.mesh
    section = (mesh, family.tools, family.drives1)
    ends = [0, -1]
    living = life.living[..., ends]

    def points(values: NDArray[np.complex128]) -> FloatArray:
        known = np.where(living[..., None], values.reshape(*living.shape, -1), math.nan)
        return np.stack([known.real, known.imag], axis=-1)

    outlines = np.stack(
        [pocket_outlines(*section, k + 1, life.section[k][:, ends].ravel()) for k in (0, 1)]
    )
    contact, backlash = (
        points(gap_feet(*section, leading, life.beside(leading)[..., ends].ravel()))
        for leading in (family.drives1, not family.drives1)
    )
    at_end = (*_LIFE, "end")
    leading, trailing = contact_clearances(mesh, family.drives1)
    return {
        "outline": variable(
            (*at_end, "point", _AXIS),
            points(outlines),
            "outline of the pocket, axis of member 1 at the origin",
            MILLIMETRE,
        ),
        "contact_feet": variable(
            (*at_end, "member", _AXIS), contact, "narrowest gap at the contact side", MILLIMETRE
        ),
        "backlash_feet": variable(
            (*at_end, "member", _AXIS), backlash, "narrowest gap at the backlash side", MILLIMETRE
        ),
        "center_distance": variable((), mesh.center_distance, "centre distance", MILLIMETRE),
        "space_shift": variable(
            (),
            (leading - trailing) / 2 / mesh.gear2.base_radius,
            "turn of member 2 that closes the contact side",
            DEGREE,
        ),
        "twist": variable((), life.flow.station[-1], "turn of the helix over the face", DEGREE),
        "tooth1": _tooth(mesh.gear1, family.tools[0], "tooth1_point"),
        "tooth2": _tooth(mesh.gear2, family.tools[1], "tooth2_point"),
    }


def _tooth(gear: Gear, tool: Tool | None, dimension: str) -> Variable:
    points = tooth_outline(gear, tool).points(teeth=1) @ np.array([[0.0, -1.0], [1.0, 0.0]])
    label = f"outline of a tooth {of_gear(gear.name)}, along x"
    return variable((dimension, _AXIS), points, label, MILLIMETRE)


def _numbers(duty: MeshDuty, flow: PocketFlow, fluids: Fluids) -> dict[str, Variable]:
    """What holds for the whole mesh."""
    model = duty.gears.models.pockets.model
    other: PocketModel = "incompressible" if model == "isentropic" else "isentropic"
    # the same mesh with another fluid in its pockets
    pockets = replace(duty.gears.models.pockets, model=other)
    gears = replace(duty.gears, models=replace(duty.gears.models, pockets=pockets))
    end = solve_pockets(replace(duty, gears=gears), fluids)
    assert end is not None  # it turns
    origins = ("from the work at the boundaries", "from the energy balance")
    if model == "talbot-2012":
        origins = ("after Eq. 4.16 of the source", origins[0])
    number = partial(variable, ())
    return {
        "power": number(flow.power, f"power, {origins[0]}", WATT),
        "power_from_flow": number(flow.power_from_flow, f"power, {origins[1]}", WATT),
        "power_other_end": number(end.power, f"power, other end of the band ({other})", WATT),
        "power_difference": number(flow.difference, *FLOW_NUMBERS["difference"]),
        "mass_error": number(
            flow.mass_error, "mass lost in a period over the mass that entered", NUMBER
        ),
        "periods": number(flow.periods, "mesh periods until the flow repeated", NUMBER),
        "sound_speed": number(
            sound_speed(fluids.mixed(oil_in_mesh(duty)), fluids.pressure),
            "speed of sound of a homogeneous mixture",
            METRE_PER_SECOND,
        ),
        "speed_max": number(flow.speed_max, *FLOW_NUMBERS["speed_max"]),
        "ambient_pressure": number(fluids.pressure, "ambient pressure", BAR),
        "speed": number(
            abs(duty.speed1),
            f"speed {of_gear(duty.gears.mesh.gear1.name)} against the line of centres",
            RPM,
        ),
        "oil_fraction": number(oil_in_mesh(duty), "share of oil in the mixture, by volume", NUMBER),
    }
