"""Flow through the pockets of a mesh and the power it takes. Talbot (2012), section 4.3."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from epicyclic.errors import ConvergenceError
from epicyclic.kernels.pocket_flow import periodic_flow
from epicyclic.kernels.pocket_fluid import GAMMA, choking_table
from epicyclic.lubricant.properties import MixtureState
from epicyclic.pocketing.cells import pocket_cells
from epicyclic.pocketing.geometry import PocketGeometry

__all__ = ["POCKETING_MODELS", "PocketFlow", "PocketModel", "pocket_flow"]

Floats = NDArray[np.float64]

PocketModel = Literal["isentropic", "mean-density", "incompressible", "central-differences"]
POCKETING_MODELS: dict[PocketModel, str] = {
    "isentropic": "flow of a compressible mixture, isentropic openings",
    "mean-density": "flow of a compressible mixture, mean density at the openings",
    "incompressible": "flow of an incompressible mixture",
    "central-differences": "flow of a compressible mixture, mean density, central differences",
}

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
    face : ndarray, shape (slices + 1,)
        Distance from the first end of the face to both ends of each slice. [m]
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
    face: Floats
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


@lru_cache(maxsize=256)
def pocket_flow(
    geometry: PocketGeometry,
    speed: float,
    mixture: MixtureState,
    pressure: float,
    model: PocketModel = "mean-density",
    slices: int = 24,
    steps: int = 32,
    end_length: float = 1.0,
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
    end_length : float
        Width of the slice at either end of the face, in normal modules. [1]

    Returns
    -------
    PocketFlow

    Raises
    ------
    ConvergenceError
        If a time step has no solution.
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
    figures = np.zeros(8)
    periods = periodic_flow(
        cells.shape,
        cells.live,
        fluid,
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
    for array in (*history, work):
        array.flags.writeable = False
    work_done, lost, come, out, gone, stored = map(float, figures[:6])
    return PocketFlow(
        power=pressure * work_done / period,
        power_from_flow=mixture.density * lost / period,
        mass_error=(come - out - gone - stored) / come,
        periods=abs(periods),
        periodic=periods > 0,
        sound_speed=_sound_speed(*fluid[:2]),
        angle=geometry.pitch * np.arange(1, steps + 1) / steps,
        place=cells.place,
        station=cells.station,
        face=cells.face,
        live=cells.live,
        pressure=pressure * history[0],
        axial_speed=history[1],
        gap_speed=history[2],
        instant_power=pressure * work * steps / period,
    )


def _fluid(
    model: PocketModel, mixture: MixtureState, pressure: float
) -> tuple[float, float, Floats, bool]:
    """What the kernel takes of the fluid: see `kernels.pocket_stage.solve_stage`."""
    oil = min(mixture.oil_fraction, 1 - LEAST_AIR)
    xi = 1.0 if model == "incompressible" else oil
    central = model == "central-differences"
    choke = np.empty(0) if central or model == "mean-density" else choking_table(xi)
    return xi, pressure / mixture.density, choke, central


def _sound_speed(xi: float, c2: float) -> float:
    """Speed of sound at ambient pressure. Theory (Q10). [m/s]"""
    return math.inf if xi >= 1.0 else math.sqrt(GAMMA * c2 / (1 - xi))
