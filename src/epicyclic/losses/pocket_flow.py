"""Flow through the pockets of a mesh and the power that it takes."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, Literal

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.dataclass import dataclass
from epicyclic.errors import ConvergenceError
from epicyclic.kernels.pocket_flow import periodic_flow
from epicyclic.kernels.pocket_network import periodic_network
from epicyclic.kernels.pocket_stage import GAMMA, choking_table
from epicyclic.losses.pocket_geometry import Cells, PocketGeometry, pocket_cells
from epicyclic.oil.oil import MixtureState

# Flow of an incompressible mixture through the pockets of a mesh, free of speed and density.
#
# What has no sound waves is a network of openings between cells. Its flow is found once for a
# geometry and multiplied by density and powers of the speed, as long as no pocket holds a void.

POCKETS_PER_PITCH = 2  # A tooth of either gear.
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
    pressure: FloatArray  # Over density and square of the speed. [m^2]
    axial_speed: FloatArray  # Over the speed. [m]
    gap_speed: FloatArray  # Over the speed. [m]
    instant_power: FloatArray  # [m^5]
    damped: FloatArray  # Work of each step that the method of time stepping damps. [m^5]


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
    return _Network(geometry, slices, steps, end_length).flow(-1 / number**2, free.damped)


@lru_cache(maxsize=64)
def _free_flow(geometry: PocketGeometry, slices: int, steps: int, end_length: float) -> NetworkFlow:
    """The flow while no pocket holds a void."""
    return _Network(geometry, slices, steps, end_length).flow(-math.inf)


@lru_cache(maxsize=32)
def study_flow(geometry: PocketGeometry) -> NetworkFlow:
    """Flow and power as a reading of Talbot (2012), section 4.3, has them. Theory (Q28).

    `power_from_flow` is the boundary work.
    """
    return _Network(geometry, STUDY_SLICES, STUDY_STEPS, None, slice(2, None, 2)).study()


class _Network:
    """Cells, openings and one solved period. Arguments as for `pocket_flow`."""

    def __init__(
        self,
        geometry: PocketGeometry,
        slices: int,
        steps: int,
        end_length: float | None,
        at: slice = slice(1, None, 2),  # Times of the openings among those of cells: mid-step.
    ) -> None:
        end = None if end_length is None else end_length * geometry.mesh.gear1.rack.normal_module
        cells = pocket_cells(geometry, slices, steps, end, inner=0.5)
        self._cells, self._turn = cells, geometry.pitch / steps  # The time step is an angle. [rad]
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

    def _solve(self, lowest: float, carries: bool, eased: bool) -> tuple[int, FloatArray]:
        """Periods, and the boundary work of each step; fills the history."""
        pockets = self._volume, self._cells.live, self._openings
        limits = POCKETS_PER_PITCH, (PERIODS_MOST, PERIOD_TOLERANCE)
        periods = periodic_network(
            *pockets, (self._turn, lowest, carries), eased, *limits, self._history, np.zeros(2)
        )
        return int(periods), -(self._history[0][:, 1:-1, 1:-1] * self._growth).sum(axis=(1, 2))

    def flow(self, lowest: float, damped: FloatArray | None = None) -> NetworkFlow:
        """Eased births, kinetic energy carried on, power from the boundary work. Theory (Q27).

        `damped` is of the flow without voids, if this is not the one.
        """
        periods, works = self._solve(lowest, carries=True, eased=True)
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
        # work that opening voids store, less what they give back when they fill up
        q, inside = self._history[0][:, 1:-1, 1:-1], np.s_[:, 1:-1, 1:-1]
        opened = (1 - full[inside]) * self._volume[1:]
        opened -= (1 - _before(full, 1.0)[inside]) * self._volume[:-1]
        lost += float(-(q * opened)[self._cells.live].sum()) - float(damped.sum())
        return self._made(periods, works - damped, lost, damped)

    def study(self) -> NetworkFlow:
        """New pockets from rest, no kinetic energy inside, power at the openings. Theory (Q28)."""
        periods, inside = self._solve(-math.inf, carries=False, eased=False)
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
        return self._made(periods, works, float(inside.sum()), np.zeros(len(q)))

    def _made(
        self, periods: int, works: FloatArray, other: float, damped: FloatArray
    ) -> NetworkFlow:
        period = self._turn * len(works)
        # what comes in less what goes out, over what comes in, in a period
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
            one, two = _sides(live, axis)
            out += float(flow[one & ~two].sum() - flow[two & ~one].sum())
        cell, _, axial, gap, *_ = self._history
        pressure = np.ascontiguousarray(cell[:, 1:-1, 1:-1])
        instants = works / self._turn
        for array in (pressure, axial, gap, instants, damped):
            array.flags.writeable = False
        return NetworkFlow(
            cells=self._cells,
            power=float(works.sum()) / period,
            power_from_flow=other / period,
            mass_error=(come - out - gone) / come,
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


# Flow through the pockets of a mesh and the power it takes. Talbot (2012), section 4.3.

PocketModel = Literal[
    "incompressible", "isentropic", "mean-density", "central-differences", "talbot-2012"
]
POCKETING_MODELS: dict[str, str] = {
    "incompressible": "flow of an incompressible mixture above the pressure of a void",
    "isentropic": "flow of a compressible mixture, isentropic openings",
    "mean-density": "flow of a compressible mixture, mean density at the openings",
    "central-differences": "flow of a compressible mixture, mean density, central differences",
    "talbot-2012": "flow of an incompressible mixture, after one reading of the source",
}
NETWORK_MODELS: tuple[PocketModel, ...] = ("incompressible", "talbot-2012")
"""Those without sound waves, whose flow scales with density and speed."""

LEAST_OIL = 0.005
"""Share of oil below which the choice auto takes the mixture for compressible: it is a gas. [1]"""
LEAST_AIR = 1e-4
"""Air in a compressible mixture, at least: with it pure oil cavitates near zero pressure. The loss
is that without a lower bound within a percent. [1]"""
ITERATIONS_MOST = 2000
"""Newton iterations of one flow, over its time steps in a period, in all periods and trials: usual
are 70 to 200, and up to 1800 where the flow does not repeat. It bounds the time of a flow. [1]"""
FINER = (1, 2, 4)
"""A flow with a time step that has no solution is tried with more steps, by these factors."""


@dataclass(frozen=True, slots=True, eq=False)
class PocketFlow:
    """One period of the flow through the pockets of a mesh. Arrays are read-only."""

    # Mean power that the teeth put into the fluid, from the work at the boundaries. [W]
    power: float
    # The same from what the flow loses: kinetic energy, unexpanded pressure at choked openings, and
    # what ended pockets leave behind; of "talbot-2012" the work at the boundaries. [W]
    power_from_flow: float
    # What comes in less what goes out and what is stored, over what comes in, in a period. [1]
    mass_error: float
    periods: int  # Mesh periods from rest until the flow repeated.
    periodic: bool  # False if it did not; powers are then means of the last half of the periods.
    angle: FloatArray  # Rotation of gear 1 at the end of each step, one pitch in all. [rad]
    # Angle of each pocket at the beginning, at the first end of the face: of its tooth or space of
    # gear 1 from the line of centres. [rad]
    place: FloatArray
    # Angle that the helix turns from the first end of the face to both ends of each slice. [rad]
    station: FloatArray
    face: FloatArray  # Distance from the first end of the face to both ends of each slice. [m]
    # Which cells are pockets. Pockets follow each other along the mesh: a tooth of gear 1 in a
    # space of gear 2 at even places, a tooth of gear 2 in a space of gear 1 at odd ones.
    live: BoolArray
    pressure: FloatArray  # Above ambient; zero where there is no pocket. [Pa]
    axial_speed: FloatArray  # [m/s]
    gap_speed: FloatArray  # Through the gaps between pockets. [m/s]
    instant_power: FloatArray  # Mean power of the teeth during each step. [W]

    @property
    def speed_max(self) -> float:
        """Fastest flow through any opening. [m/s]"""
        return float(max(np.abs(self.axial_speed).max(), np.abs(self.gap_speed).max()))

    @property
    def difference(self) -> float:
        """Relative difference of the two powers. [1]"""
        return self.power_from_flow / self.power - 1


@lru_cache(maxsize=8)  # of others the figures are kept, not the fields
def pocket_flow(
    geometry: PocketGeometry,
    # Speed of gear 1 against the line of centres, not zero; its sign does not matter. [rad/s]
    speed: float,
    mixture: MixtureState,  # At ambient pressure.
    pressure: float,  # Ambient; for "incompressible" ambient pressure less that of a void. [Pa]
    model: PocketModel = "incompressible",  # Key of `POCKETING_MODELS`.
    slices: int = 24,  # Across the common face width, at least; more where the helix turns far.
    steps: int = 32,  # Time steps in one pitch.
    # Width of the slice at either end of the face, in normal modules. [1] "talbot-2012" has its own
    # resolution.
    end_length: float = 1.0,
) -> PocketFlow:
    """Periodic flow through the pockets. Theory (Q11).

    Raises `ConvergenceError` if a time step has no solution, not even as one of four times as many.
    """
    if model == "talbot-2012":
        return _scaled_up(study_flow(geometry), geometry, abs(speed), mixture.density)
    if model == "incompressible":
        number = abs(speed) * math.sqrt(mixture.density / pressure)
        flow = bounded_flow(geometry, number, slices, steps, end_length)
        return _scaled_up(flow, geometry, abs(speed), mixture.density)
    used, most = 0, ITERATIONS_MOST * steps
    for finer in FINER:
        resolution = (slices, finer * steps, end_length)
        found, used = _compressible_flow(
            geometry, speed, mixture, pressure, model, *resolution, (used, most)
        )
        if found is not None:
            return found
        if used > most:
            break
    raise _no_solution(geometry)


def _compressible_flow(
    geometry: PocketGeometry,
    speed: float,
    mixture: MixtureState,
    pressure: float,
    model: PocketModel,
    slices: int,
    steps: int,
    end_length: float,
    iterations: tuple[int, int],
) -> tuple[PocketFlow | None, int]:
    """`pocket_flow` of the models with sound waves; None if a time step has no solution.

    Also returns the iterations so far. `iterations` are those of the trials before and the most.
    """
    cells = pocket_cells(
        geometry, slices, steps, end_length * geometry.mesh.gear1.rack.normal_module
    )
    pockets, count = cells.live.shape[1:]
    # the fluid as `kernels.pocket_stage.solve_stage` takes it
    xi = min(mixture.oil_fraction, 1 - LEAST_AIR)
    central = model == "central-differences"
    choke = np.empty(0) if central or model == "mean-density" else choking_table(xi)
    fluid = xi, pressure / mixture.density, choke, central
    period = geometry.pitch / abs(speed)
    history = (
        np.zeros((steps, pockets, count)),
        np.zeros((steps, pockets, count + 1)),
        np.zeros((steps, pockets + 1, count)),
    )
    work = np.zeros(steps)
    figures = np.zeros(9)
    figures[8] = iterations[0]
    periods = periodic_flow(
        *(cells.shape, cells.live, fluid, period / steps, POCKETS_PER_PITCH),
        (PERIODS_MOST, PERIOD_TOLERANCE, iterations[1]),
        *(history, work, figures),
    )
    used = int(figures[8])
    if periods == 0:
        return None, used
    for array in (*history, work):
        array.flags.writeable = False
    work_done, lost, come, out, gone, stored = map(float, figures[:6])
    found = PocketFlow(
        power=pressure * work_done / period,
        power_from_flow=mixture.density * lost / period,
        mass_error=(come - out - gone - stored) / come,
        periods=abs(periods),
        periodic=periods > 0,
        pressure=pressure * history[0],
        axial_speed=history[1],
        gap_speed=history[2],
        instant_power=pressure * work * steps / period,
        **_places(cells, geometry),
    )
    return found, used


def _no_solution(geometry: PocketGeometry) -> ConvergenceError:
    return ConvergenceError(
        f"pocketing of the {geometry.mesh.name}: the flow does not converge even with shorter "
        "time steps, or needs too many iterations. Choose another models.pocketing, or leave the "
        "term out (losses)."
    )


def _scaled_up(
    flow: NetworkFlow, geometry: PocketGeometry, speed: float, density: float
) -> PocketFlow:
    """A flow without sound waves at a speed and a density. Theory (Q22)."""
    if not math.isfinite(flow.power):
        raise _no_solution(geometry)
    head = density * speed**2
    return PocketFlow(
        power=head * speed * flow.power,
        power_from_flow=head * speed * flow.power_from_flow,
        mass_error=flow.mass_error,
        periods=abs(flow.periods),
        periodic=flow.periods > 0,
        pressure=head * flow.pressure,
        axial_speed=speed * flow.axial_speed,
        gap_speed=speed * flow.gap_speed,
        instant_power=head * speed * flow.instant_power,
        **_places(flow.cells, geometry),
    )


def _places(cells: Cells, geometry: PocketGeometry) -> dict[str, Any]:
    """Attributes of `PocketFlow` that tell where and when its fields are."""
    steps = len(cells.live)
    return {
        "angle": geometry.pitch * np.arange(1, steps + 1) / steps,
        "place": cells.place,
        "station": cells.station,
        "face": cells.face,
        "live": cells.live,
    }


def sound_speed(mixture: MixtureState, pressure: float) -> float:
    """Speed of sound of a homogeneous mixture at ambient pressure. Theory (Q10). [m/s]"""
    air = max(1 - mixture.oil_fraction, LEAST_AIR)
    return math.sqrt(GAMMA * pressure / (air * mixture.density))
