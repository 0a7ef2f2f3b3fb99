"""Flow through the pockets of a mesh and the power it takes. Talbot (2012), section 4.3."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from epicyclic.errors import ConvergenceError
from epicyclic.kernels.pocket_flow import GAMMA, SDIRK, choking_table, periodic_flow
from epicyclic.lubricant.properties import MixtureState
from epicyclic.pocketing.geometry import PocketGeometry

__all__ = ["POCKETING_MODELS", "PocketFlow", "PocketModel", "pocket_flow"]

Floats = NDArray[np.float64]

PocketModel = Literal["isentropic", "mean-density", "incompressible"]
POCKETING_MODELS: dict[PocketModel, str] = {
    "isentropic": "flow of a compressible mixture, isentropic openings",
    "mean-density": "flow of a compressible mixture, mean density at the openings",
    "incompressible": "flow of an incompressible mixture",
}

SLICES_PER_PITCH = 10
"""Fewest slices for each pitch that the helix turns over the face."""
POCKETS_PER_PITCH = 2
"""A tooth of either gear."""
LEAST_AIR = 1e-4
"""Air in a compressible mixture, at least: with it pure oil cavitates near zero pressure. The loss
is that without a lower bound within a percent. [1]"""
PERIODS_MOST = 60
PERIOD_TOLERANCE = 1e-4
"""The flow repeats if the power of two periods differs less than this, and the fields by less than
ten times this of their largest value. [1]"""


@dataclass(frozen=True, slots=True, eq=False)
class PocketFlow:
    """One period of the flow through the pockets of a mesh. Arrays are read-only.

    Attributes
    ----------
    power : float
        Mean power that the teeth put into the fluid, from the work at the boundaries. [W]
    power_from_flow : float
        The same from what the flow loses: kinetic energy, unexpanded pressure at choked openings,
        and what ended pockets leave behind. [W]
    mass_error : float
        What comes in less what goes out and what is stored, over what comes in, in a period. [1]
    periods : int
        Mesh periods from rest until the flow repeated.
    periodic : bool
        False if it did not; powers are then means of the last half of the periods.
    sound_speed : float
        Of the mixture at ambient pressure; infinite for an incompressible one. [m/s]
    angle : ndarray, shape (steps,)
        Rotation of gear 1 at the end of each step, one pitch in all. [rad]
    place : ndarray, shape (pockets,)
        Angle of each pocket at the beginning, at the first end of the face: of its tooth or space
        of gear 1 from the line of centres. [rad]
    station : ndarray, shape (slices + 1,)
        Angle that the helix turns from the first end of the face to both ends of each slice. [rad]
    live : ndarray of bool, shape (steps, pockets, slices)
        Which cells are pockets. Pockets follow each other along the mesh: a tooth of gear 1 in a
        space of gear 2 at even places, a tooth of gear 2 in a space of gear 1 at odd ones.
    pressure : ndarray, shape (steps, pockets, slices)
        Above ambient; zero where there is no pocket. [Pa]
    axial_speed : ndarray, shape (steps, pockets, slices + 1)
        [m/s]
    gap_speed : ndarray, shape (steps, pockets + 1, slices)
        Through the gaps between pockets. [m/s]
    instant_power : ndarray, shape (steps,)
        Mean power of the teeth during each step. [W]
    """

    power: float
    power_from_flow: float
    mass_error: float
    periods: int
    periodic: bool
    sound_speed: float
    angle: Floats
    place: Floats
    station: Floats
    live: NDArray[np.bool_]
    pressure: Floats
    axial_speed: Floats
    gap_speed: Floats
    instant_power: Floats

    @property
    def speed_max(self) -> float:
        """Fastest flow through any opening. [m/s]"""
        return float(max(np.abs(self.axial_speed).max(), np.abs(self.gap_speed).max()))

    @property
    def difference(self) -> float:
        """Relative difference of the two powers. [1]"""
        return self.power_from_flow / self.power - 1


@dataclass(frozen=True, slots=True, eq=False)
class _Cells:
    """Geometry of all cells at all times of a period, as the kernel takes it."""

    shape: tuple[Floats, Floats, Floats, Floats, Floats]
    live: NDArray[np.bool_]
    place: Floats
    station: Floats


@lru_cache(maxsize=256)
def pocket_flow(
    geometry: PocketGeometry,
    speed: float,
    mixture: MixtureState,
    pressure: float,
    model: PocketModel = "mean-density",
    slices: int = 16,
    steps: int = 32,
) -> PocketFlow:
    """Periodic flow through the pockets.

    Theory (Q11).

    Parameters
    ----------
    geometry : PocketGeometry
    speed : float
        Of gear 1 against the line of centres, not zero; its sign does not matter. [rad/s]
    mixture : MixtureState
        At ambient pressure.
    pressure : float
        Ambient. [Pa]
    model : str
        Key of `POCKETING_MODELS`.
    slices : int
        Across the common face width, at least; more where the helix turns far.
    steps : int
        Time steps in one pitch.

    Returns
    -------
    PocketFlow

    Raises
    ------
    ConvergenceError
        If a time step has no solution.
    """
    cells = _cells(geometry, _slices(geometry, slices), steps)
    pockets, count = cells.live.shape[1:]
    oil = min(mixture.oil_fraction, 1 - LEAST_AIR)
    xi = 1.0 if model == "incompressible" else oil
    c2 = pressure / mixture.density
    choke = np.empty(0) if model == "mean-density" else choking_table(xi)
    period = geometry.pitch / abs(speed)
    history = (
        np.zeros((steps, pockets, count)),
        np.zeros((steps, pockets, count + 1)),
        np.zeros((steps, pockets + 1, count)),
    )
    work = np.zeros(steps)
    figures = np.zeros(8)
    periods = periodic_flow(
        cells.shape,
        cells.live,
        (xi, c2, choke),
        period / steps,
        POCKETS_PER_PITCH,
        (PERIODS_MOST, PERIOD_TOLERANCE),
        history,
        work,
        figures,
    )
    if periods == 0:
        raise ConvergenceError(
            f"pocketing of the {geometry.mesh.name}: a time step has no solution; raise "
            "numerics.pocket_steps, or leave the term out (losses)."
        )
    for array in (*history, work, cells.live, cells.place, cells.station):
        array.flags.writeable = False
    work_done, lost, come, out, gone, stored = map(float, figures[:6])
    return PocketFlow(
        power=pressure * work_done / period,
        power_from_flow=mixture.density * lost / period,
        mass_error=(come - out - gone - stored) / come,
        periods=abs(periods),
        periodic=periods > 0,
        sound_speed=_sound_speed(xi, c2),
        angle=geometry.pitch * np.arange(1, steps + 1) / steps,
        place=cells.place,
        station=cells.station,
        live=cells.live,
        pressure=pressure * history[0],
        axial_speed=history[1],
        gap_speed=history[2],
        instant_power=pressure * work * steps / period,
    )


def _sound_speed(xi: float, c2: float) -> float:
    """Speed of sound at ambient pressure. Theory (Q10). [m/s]"""
    return math.inf if xi >= 1.0 else math.sqrt(GAMMA * c2 / (1 - xi))


def _twist(geometry: PocketGeometry) -> float:
    """Angle of gear 1 that the helix turns over the common face width. Theory (Q7). [rad]"""
    gear = geometry.mesh.gear1
    return geometry.mesh.face_width * math.tan(gear.rack.helix_angle) / gear.reference_radius


def _slices(geometry: PocketGeometry, slices: int) -> int:
    return max(slices, math.ceil(SLICES_PER_PITCH * _twist(geometry) / geometry.pitch))


@lru_cache(maxsize=32)
def _cells(geometry: PocketGeometry, slices: int, steps: int) -> _Cells:
    """Volumes, openings and distances of all cells at all times of a period. Theory (Q7)."""
    pitch, width = geometry.pitch, geometry.mesh.face_width / slices
    start = np.arange(steps) / steps
    inner = np.column_stack([start + SDIRK / steps, start + 1 / steps]).ravel()
    times = np.concatenate([[0.0], inner]) * pitch
    stations = np.linspace(0.0, _twist(geometry), slices + 1)
    teeth = _teeth(geometry, float(stations[-1]))
    # Every tooth of gear 1, and one more for the last gap: (times, teeth, stations).
    angle = times[:, None, None] + stations - (teeth * pitch)[:, None]
    spaces = [angle[:, :-1] - place * pitch / 2 for place in (0, 1)]
    area = _along_mesh([_read(geometry.angle[k], geometry.area[k], spaces[k]) for k in (0, 1)])
    centroid = _along_mesh(
        [_read(geometry.angle[k], geometry.centroid[k], spaces[k]) for k in (0, 1)]
    )
    gap = _along_mesh([_read(geometry.gap_angle, geometry.gap[k], angle) for k in (0, 1)])
    middle = _along_mesh([_read(geometry.gap_angle, geometry.gap_middle[k], angle) for k in (0, 1)])
    gap, middle = (_mean_of_ends(array[:, :-1]) for array in (gap, middle))
    cell = _mean_of_ends(centroid)
    live = _along_mesh(
        [
            (space[2::2, :, 1:] > life[0]) & (space[:-1:2, :, :-1] < life[1])
            for space, life in zip(spaces, geometry.life, strict=True)
        ]
    )
    reach = np.zeros((times.size, 2, *area.shape[1:]))
    reach[:, 0, :, 1:] = np.hypot(width / 2, np.linalg.norm(centroid[:, :, 1:] - cell, axis=-1))
    reach[:, 1, :, :-1] = np.hypot(width / 2, np.linalg.norm(centroid[:, :, :-1] - cell, axis=-1))
    gap_reach = np.zeros((times.size, 2, *gap.shape[1:]))
    gap_reach[:, 0, 1:] = np.linalg.norm(middle[:, 1:] - cell, axis=-1)
    gap_reach[:, 1, :-1] = np.linalg.norm(middle[:, :-1] - cell, axis=-1)
    place = np.add.outer(-teeth[:-1], [0.0, -0.5]).ravel() * pitch
    shape = (width * _mean_of_ends(area), area, width * gap, reach, gap_reach)
    return _Cells(shape, live, place, stations)


def _teeth(geometry: PocketGeometry, twist: float) -> Floats:
    """Numbers of the teeth of gear 1 beside live pockets in a period, and of the one after."""
    pitch, life = geometry.pitch, geometry.life + np.array([[0.0], [geometry.pitch / 2]])
    first = math.floor(-life[:, 1].max() / pitch)
    last = math.ceil((pitch + twist - life[:, 0].min()) / pitch)
    return np.arange(first, last + 2, dtype=np.float64)


def _read(angle: Floats, values: Floats, at: Floats) -> Floats:
    """A table between its points by monotone cubics, beyond them its last value."""
    inside = np.clip(at, angle[0], angle[-1])
    read: Floats = PchipInterpolator(angle, values, axis=0)(inside)
    return read


def _along_mesh(parts: list[Any]) -> Any:
    """Arrays of both kinds of pocket, teeth on the second axis, as one array of all pockets."""
    both = np.stack(parts, axis=2)
    return np.ascontiguousarray(both.reshape(both.shape[0], -1, *both.shape[3:]))


def _mean_of_ends(values: Floats) -> Floats:
    """Mean of the values at both ends of each slice, stations on the third axis."""
    mean: Floats = (values[:, :, :-1] + values[:, :, 1:]) / 2
    return mean
