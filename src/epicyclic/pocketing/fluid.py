"""Flow through the pockets of a mesh and the power it takes. Talbot (2012), section 4.3."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from epicyclic.errors import ConvergenceError
from epicyclic.kernels.pocket_flow import periodic_flow
from epicyclic.kernels.pocket_fluid import GAMMA, choking_table
from epicyclic.lubricant.properties import MixtureState
from epicyclic.pocketing.cells import Cells, pocket_cells
from epicyclic.pocketing.geometry import PocketGeometry
from epicyclic.pocketing.network import (
    PERIOD_TOLERANCE,
    PERIODS_MOST,
    POCKETS_PER_PITCH,
    NetworkFlow,
    bounded_flow,
    study_flow,
)

Floats = NDArray[np.float64]

PocketModel = Literal[
    "incompressible", "isentropic", "mean-density", "central-differences", "talbot-2012"
]
POCKETING_MODELS: dict[PocketModel, str] = {
    "incompressible": "flow of an incompressible mixture above the pressure of a void",
    "isentropic": "flow of a compressible mixture, isentropic openings",
    "mean-density": "flow of a compressible mixture, mean density at the openings",
    "central-differences": "flow of a compressible mixture, mean density, central differences",
    "talbot-2012": "flow of an incompressible mixture as a reading of the source has it",
}
NETWORK_MODELS: tuple[PocketModel, ...] = ("incompressible", "talbot-2012")
"""Those without sound waves, whose flow scales with density and speed."""

LEAST_OIL = 0.005
"""Share of oil below which `automatic_pocketing` takes the mixture for compressible. [1]"""
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
    # Speed of sound of the mixture in the model at ambient pressure; infinite for an incompressible
    # one. [m/s]
    sound_speed: float
    angle: Floats  # Rotation of gear 1 at the end of each step, one pitch in all. [rad]
    # Angle of each pocket at the beginning, at the first end of the face: of its tooth or space of
    # gear 1 from the line of centres. [rad]
    place: Floats
    # Angle that the helix turns from the first end of the face to both ends of each slice. [rad]
    station: Floats
    face: Floats  # Distance from the first end of the face to both ends of each slice. [m]
    # Which cells are pockets. Pockets follow each other along the mesh: a tooth of gear 1 in a
    # space of gear 2 at even places, a tooth of gear 2 in a space of gear 1 at odd ones.
    live: NDArray[np.bool_]
    pressure: Floats  # Above ambient; zero where there is no pocket. [Pa]
    axial_speed: Floats  # [m/s]
    gap_speed: Floats  # Through the gaps between pockets. [m/s]
    instant_power: Floats  # Mean power of the teeth during each step. [W]

    @property
    def speed_max(self) -> float:
        """Fastest flow through any opening. [m/s]"""
        return float(max(np.abs(self.axial_speed).max(), np.abs(self.gap_speed).max()))

    @property
    def difference(self) -> float:
        """Relative difference of the two powers. [1]"""
        return self.power_from_flow / self.power - 1


@lru_cache(maxsize=256)
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
    """Periodic flow through the pockets.

    Theory (Q11).

    Returns
    -------
    PocketFlow

    Raises
    ------
    ConvergenceError
        If a time step has no solution, not even as one of four times as many.
    """
    if model == "talbot-2012":
        return _scaled_up(study_flow(geometry), geometry, abs(speed), mixture.density)
    if model == "incompressible":
        number = abs(speed) * math.sqrt(mixture.density / pressure)
        flow = bounded_flow(geometry, number, slices, steps, end_length)
        return _scaled_up(flow, geometry, abs(speed), mixture.density)
    used, most = 0, ITERATIONS_MOST * steps
    for finer in FINER:
        found, used = _compressible_flow(
            geometry,
            speed,
            mixture,
            pressure,
            model,
            slices,
            finer * steps,
            end_length,
            (used, most),
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
    fluid = _fluid(model, mixture, pressure)
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
        cells.shape,
        cells.live,
        fluid,
        period / steps,
        POCKETS_PER_PITCH,
        (PERIODS_MOST, PERIOD_TOLERANCE, iterations[1]),
        history,
        work,
        figures,
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
        sound_speed=sound_speed(mixture, pressure),
        pressure=pressure * history[0],
        axial_speed=history[1],
        gap_speed=history[2],
        instant_power=pressure * work * steps / period,
        **_places(cells, geometry),
    )
    return found, used


def _no_solution(geometry: PocketGeometry) -> ConvergenceError:
    return ConvergenceError(
        f"pocketing of the {geometry.mesh.name}: the flow does not converge, not even in shorter "
        "time steps, or takes too many iterations; take another models.pocketing, or leave the "
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
        sound_speed=math.inf,
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


def automatic_pocketing(oil_fraction: float) -> PocketModel:
    """The model where the user leaves the choice: air with hardly any oil in it is a gas."""
    return "isentropic" if oil_fraction < LEAST_OIL else "incompressible"


def _fluid(
    model: PocketModel, mixture: MixtureState, pressure: float
) -> tuple[float, float, Floats, bool]:
    """What the kernel takes of the fluid: see `kernels.pocket_stage.solve_stage`."""
    xi = min(mixture.oil_fraction, 1 - LEAST_AIR)
    central = model == "central-differences"
    choke = np.empty(0) if central or model == "mean-density" else choking_table(xi)
    return xi, pressure / mixture.density, choke, central


def sound_speed(mixture: MixtureState, pressure: float) -> float:
    """Speed of sound of a homogeneous mixture at ambient pressure. Theory (Q10). [m/s]"""
    air = max(1 - mixture.oil_fraction, LEAST_AIR)
    return math.sqrt(GAMMA * pressure / (air * mixture.density))
