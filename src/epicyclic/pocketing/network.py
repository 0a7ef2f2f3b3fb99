"""Flow of an incompressible mixture through the pockets of a mesh, free of speed and density.

What has no sound waves is a network of openings between cells. Its flow is found once for a
geometry and multiplied by density and powers of the speed, as long as no pocket holds a void.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.pocket_network import periodic_network
from epicyclic.pocketing.cells import Cells, pocket_cells
from epicyclic.pocketing.geometry import PocketGeometry

Floats = NDArray[np.float64]

POCKETS_PER_PITCH = 2
"""A tooth of either gear."""
PERIODS_MOST = 60
PERIOD_TOLERANCE = 1e-4
"""The flow repeats if the power of two periods differs less than this, and the fields by less than
ten times this of their largest value. [1]"""
STUDY_SLICES, STUDY_STEPS = 12, 48
"""Resolution of `study_flow`: equal slices across the face, time steps in one pitch."""


@dataclass(frozen=True, slots=True, eq=False)
class NetworkFlow:
    """One period of the flow at density 1 and speed 1. Arrays are read-only."""

    cells: Cells
    power: float  # As for `PocketFlow`, over density and cube of the speed. [m^5]
    power_from_flow: float  # As for `PocketFlow`, over density and cube of the speed. [m^5]
    mass_error: float  # [1]
    periods: int  # Negative if the flow did not repeat.
    pressure: Floats  # Over density and square of the speed. [m^2]
    axial_speed: Floats  # Over the speed. [m]
    gap_speed: Floats  # Over the speed. [m]
    instant_power: Floats  # [m^5]
    damped: Floats  # Work of each step that the method of time stepping damps. [m^5]


def void_number(geometry: PocketGeometry, slices: int, steps: int, end_length: float) -> float:
    """Number from which on pockets hold voids. Theory (Q21), (Q25). [1/m]"""
    free = _free_flow(geometry, slices, steps, end_length)
    return 1 / math.sqrt(max(-float(free.pressure.min()), 1e-300))


def bounded_flow(
    geometry: PocketGeometry,
    # Speed over the root of ambient pressure less that of a void, over density. [1/m]
    number: float,
    slices: int,  # As for `pocket_flow`.
    steps: int,  # As for `pocket_flow`.
    end_length: float,  # As for `pocket_flow`.
) -> NetworkFlow:
    """Flow whose pressures do not fall below that of a void. Theory (Q25), (Q26), (Q27)."""
    free = _free_flow(geometry, slices, steps, end_length)
    if number <= void_number(geometry, slices, steps, end_length):
        return free
    return _network(geometry, slices, steps, end_length).flow(-1 / number**2, free.damped)


@lru_cache(maxsize=64)
def _free_flow(geometry: PocketGeometry, slices: int, steps: int, end_length: float) -> NetworkFlow:
    """The flow while no pocket holds a void."""
    return _network(geometry, slices, steps, end_length).flow(-math.inf)


def _network(geometry: PocketGeometry, slices: int, steps: int, end_length: float) -> _Network:
    """With the openings in the middle of each step."""
    end = end_length * geometry.mesh.gear1.rack.normal_module
    cells = pocket_cells(geometry, slices, steps, end, inner=0.5)
    return _Network(cells, geometry.pitch / steps, slice(1, None, 2))


@lru_cache(maxsize=32)
def study_flow(geometry: PocketGeometry) -> NetworkFlow:
    """Flow and power as a reading of Talbot (2012), section 4.3, has them. Theory (Q28).

    `power_from_flow` is the boundary work.
    """
    cells = pocket_cells(geometry, STUDY_SLICES, STUDY_STEPS, None, inner=0.5)
    network = _Network(cells, geometry.pitch / STUDY_STEPS, slice(2, None, 2))
    return network.study()


class _Network:
    """Cells, openings and one solved period.

    Parameters
    ----------
    cells : Cells
    turn : float
        Time step, as an angle of gear 1. [rad]
    at : slice
        The times of `cells` at which openings are taken, one for each step.
    """

    def __init__(self, cells: Cells, turn: float, at: slice) -> None:
        self._cells, self._turn = cells, turn
        self._volume = np.ascontiguousarray(cells.volume[::2])
        self._growth = np.diff(self._volume, axis=0)
        self._openings = (
            np.ascontiguousarray(cells.axial[at]),
            np.ascontiguousarray(cells.gap[at]),
            np.ascontiguousarray(cells.axial_reach[at]),
            np.ascontiguousarray(cells.gap_reach[at]),
        )
        steps, pockets, slices = cells.live.shape
        faces, gaps = (steps, pockets, slices + 1), (steps, pockets + 1, slices)
        cell = (steps, pockets + 2, slices + 2)
        self._history = tuple(map(np.zeros, (cell, cell, faces, gaps, faces, gaps, faces)))

    def _solve(self, lowest: float, carries: bool, eased: bool) -> int:
        """Periods; fills the history."""
        return int(
            periodic_network(
                self._volume,
                self._cells.live,
                self._openings,
                (self._turn, lowest, carries),
                eased,
                POCKETS_PER_PITCH,
                (PERIODS_MOST, PERIOD_TOLERANCE),
                self._history,
                np.zeros(2),
            )
        )

    def flow(self, lowest: float, damped: Floats | None = None) -> NetworkFlow:
        """Eased births, kinetic energy carried on, power from the boundary work. Theory (Q27).

        `damped` is of the flow without voids, if this is not the one.
        """
        periods = self._solve(lowest, carries=True, eased=True)
        _, full, axial, gap, inertia, gap_inertia, law = self._history
        lost, damping = 0.0, np.zeros(len(axial))
        for u, area, mass, drop, axis in (
            (axial, self._openings[0], inertia, law, 2),
            (gap, self._openings[1], gap_inertia, np.abs(gap) * gap / 2, 1),
        ):
            wet = area * np.where(u > 0, *_sides(full, axis)) * self._turn
            step = u - _before(u, 0.0)
            damping += (wet * mass * step**2 / 2).sum(axis=(1, 2))
            lost += float((wet * u * (drop + mass * step)).sum())
        damped = damping if damped is None else damped
        lost += self._voids() - float(damped.sum())
        return self._made(periods, self._works() - damped, lost, damped)

    def study(self) -> NetworkFlow:
        """New pockets from rest, no kinetic energy inside, power at the openings. Theory (Q28)."""
        periods = self._solve(-math.inf, carries=False, eased=False)
        q, _, axial, gap, *_ = self._history
        live = np.pad(self._cells.live, ((0, 0), (1, 1), (1, 1)))
        works = np.zeros(len(q))
        for u, area, axis in ((axial, self._openings[0], 2), (gap, self._openings[1], 1)):
            one, other = _sides(live, axis)
            pressure = sum(_sides(q, axis))  # zero in the surroundings
            out = np.where(one, u, -u)
            alpha = np.where(out > 0, 2.0, 1.0)
            power = area * out * (pressure + alpha * u**2) / 2
            works += np.where(one != other, power, 0.0).sum(axis=(1, 2)) * self._turn
        return self._made(periods, works, float(self._works().sum()), np.zeros(len(q)))

    def _works(self) -> Floats:
        """Boundary work of each step."""
        works: Floats = -(self._history[0][:, 1:-1, 1:-1] * self._growth).sum(axis=(1, 2))
        return works

    def _voids(self) -> float:
        """Work that opening voids store, less what they give back when they fill up."""
        q, full = self._history[0][:, 1:-1, 1:-1], self._history[1]
        volume = (1 - full[:, 1:-1, 1:-1]) * self._volume[1:]
        before = (1 - _before(full, 1.0)[:, 1:-1, 1:-1]) * self._volume[:-1]
        return float(-(q * (volume - before))[self._cells.live].sum())

    def _mass_error(self) -> float:
        """What comes in less what goes out, over what comes in, in a period."""
        live = np.pad(self._cells.live, ((0, 0), (1, 1), (1, 1)))
        full, volume = self._history[1], self._volume[:-1]
        before = _before(live, False)[:, 1:-1, 1:-1]
        now = live[:, 1:-1, 1:-1]
        come = float(volume[now & ~before].sum())
        held = volume * _before(full, 1.0)[:, 1:-1, 1:-1]
        gone, out = float(held[before & ~now].sum()), 0.0
        for u, area, axis in (
            (self._history[2], self._openings[0], 2), (self._history[3], self._openings[1], 1)
        ):  # fmt: skip
            flow = u * area * np.where(u > 0, *_sides(full, axis)) * self._turn
            one, other = _sides(live, axis)
            out += float(flow[one & ~other].sum() - flow[other & ~one].sum())
        return (come - out - gone) / come

    def _made(self, periods: int, works: Floats, other: float, damped: Floats) -> NetworkFlow:
        period = self._turn * len(works)
        cell, _, axial, gap, *_ = self._history
        pressure = np.ascontiguousarray(cell[:, 1:-1, 1:-1])
        instants = works / self._turn
        for array in (pressure, axial, gap, instants, damped):
            array.flags.writeable = False
        return NetworkFlow(
            cells=self._cells,
            power=float(works.sum()) / period,
            power_from_flow=other / period,
            mass_error=self._mass_error(),
            periods=periods,
            pressure=pressure,
            axial_speed=axial,
            gap_speed=gap,
            instant_power=instants,
            damped=damped,
        )


def _sides(padded: Any, axis: int) -> tuple[Any, Any]:
    """Values of the cells before and behind each axial face (axis 2) or gap (axis 1)."""
    if axis == 2:
        return padded[:, 1:-1, :-1], padded[:, 1:-1, 1:]
    return padded[:, :-1, 1:-1], padded[:, 1:, 1:-1]


def _before(values: Any, ended: float) -> Any:
    """Values of every pocket at the step before, over the first axis."""
    moved = np.full_like(values[:1], ended)
    # the first pocket of a padded array is no pocket; to take its place does no harm
    moved[0, :-POCKETS_PER_PITCH] = values[-1, POCKETS_PER_PITCH:]
    return np.concatenate([moved, values[:-1]])
