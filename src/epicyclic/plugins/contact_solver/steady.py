"""Steady smooth contact: pressure, film, friction and rolling loss."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass
from epicyclic.errors import Status
from epicyclic.plugins.contact_solver.conditions import (
    Heating,
    LineContact,
    flow_easing,
    moes_central_film,
    temperature_rise,
    thinning,
)
from epicyclic.plugins.contact_solver.kernels_steady import (
    deflection_matrix,
    shear_stresses,
    solve_steady,
)

# Nodes of the steady solver: dense where the inlet ends and where the film ruptures.

MIDDLE_SHARE, INLET_SHARE, EXIT_SHARE = 0.25, 0.375, 0.375
"""Shares of the nodes around x = 0, x = -b and x = b. [1]"""
INLET_WIDTH, EXIT_WIDTH = 0.5, 0.4
"""Widths of the dense zones over the length on which the gap grows by one film. [1]"""
INLET_PARABOLAS = 25.0
"""Distance of the inlet from the contact in parabola widths sqrt(2 h R), where h doubles; the load
of a rigid contact is then 0.3 % short of that of an endless inlet. [1]"""
SAMPLES = 400  # Samples of each zone from which the inverse of the node density is started.
CORRECTIONS = 3
"""Newton corrections of the nodes; the samples leave an error of 1e-3, squared by each."""


class Zone(NamedTuple):
    """Nodes around `center` whose spacing doubles within about `width`; half-widths."""

    share: float
    center: float
    width: float


class Grid(NamedTuple):
    """Range and zones of a grid, in half-widths."""

    inlet: float
    outlet: float
    zones: tuple[Zone, ...]


def grid_for(film: float, inlet: float | None = None) -> Grid:
    """The grid for an expected film H = h R/b^2. Theory (H16).

    Outside the contact the gap grows as (2 sqrt(2)/3) (X - 1)^1.5 next to it, as X^2/2 further off.
    The film starts at `inlet`, or so far off that it does not matter.
    """
    parabola = math.sqrt(2 * film)
    near = gap_length(film)
    return Grid(
        inlet=-(1 + max(3.5, INLET_PARABOLAS * parabola)) if inlet is None else inlet,
        outlet=1 + max(0.5, 1.5 * parabola),
        zones=(
            Zone(MIDDLE_SHARE, 0.0, 1 + parabola),
            Zone(INLET_SHARE, -1.0, INLET_WIDTH * near),
            Zone(EXIT_SHARE, 1.0, EXIT_WIDTH * near),
        ),
    )


def gap_length(film: float) -> float:
    """Distance outside the contact over which the gap grows by `film`. Theory (H16)."""
    return float(min((1.06 * film) ** (2 / 3), math.sqrt(2 * film)))


def graded_nodes(count: int, grid: Grid) -> FloatArray:
    """`count` nodes from inlet to outlet, shape (count,). Theory (H16)."""
    low = [math.asinh((grid.inlet - zone.center) / zone.width) for zone in grid.zones]
    high = [math.asinh((grid.outlet - zone.center) / zone.width) for zone in grid.zones]
    zones = list(zip(grid.zones, low, high, strict=True))

    def position(x: FloatArray) -> FloatArray:
        total = np.zeros_like(x)
        for (share, center, width), start, end in zones:
            total += share * (np.arcsinh((x - center) / width) - start) / (end - start)
        return total

    def density(x: FloatArray) -> FloatArray:
        total = np.zeros_like(x)
        for (share, center, width), start, end in zones:
            total += share / np.hypot(x - center, width) / (end - start)
        return total

    known = np.sort(
        np.concatenate(
            [zone.center + zone.width * np.sinh(np.linspace(a, b, SAMPLES)) for zone, a, b in zones]
        )
    )
    wanted = np.linspace(0, 1, count)
    x: FloatArray = np.interp(wanted, position(known), known)
    for _ in range(CORRECTIONS):
        x -= (position(x) - wanted) / density(x)
    x[0], x[-1] = grid.inlet, grid.outlet
    return x


NODES = 256  # Nodes by default: the central film is then within 0.7 % of its limit up to M = 200.
COARSE_NODES = 96  # Nodes of the first solution, from which the others start.
REFINEMENT = 3  # Largest ratio of the nodes of one solution to those it starts from.
TOLERANCE = 1e-6  # Largest relative change of pressure and film in the last Newton step. [1]
MAX_ITERATIONS = 40  # Newton steps on one grid; twelve have always been enough.
EXIT_GUESS = 0.4  # Where the film is first taken to rupture: beyond x = b, over `gap_length`. [1]
TRACE = 1e-9  # Pressure that marks a node as not ruptured in a starting guess, over p_h. [1]


@dataclass(frozen=True, eq=False)
class SmoothSolution:
    """Solution of a steady smooth contact."""

    contact: LineContact
    # Whether the iteration met its tolerance; if it did not, nothing else may be used.
    status: Status
    message: str  # Why it failed; empty if it did not.
    iterations: int  # Newton steps on the last grid.
    error: float  # Largest relative change in the last step. [1]
    x: FloatArray  # [m]
    pressure: FloatArray  # [Pa]
    film: FloatArray  # [m]
    shear_stress: FloatArray  # Mean over the film; zero where it is ruptured. [Pa]
    flow: FloatArray  # Volume flow at ambient density through the faces between the nodes. [m^2/s]
    # Rise of the temperature of the film above the inlet; zero without heating. [K]
    temperature_rise: FloatArray

    @property
    def minimum_film(self) -> float:
        """Least film before the rupture. [m]"""
        return float(self.film[self.pressure > 0].min())

    @property
    def central_film(self) -> float:
        """Film at x = 0. [m]"""
        return float(np.interp(0.0, self.x, self.film))

    @property
    def friction_coefficient(self) -> float:
        """Sliding friction over the load. Theory (H18). [1]"""
        return float(np.trapezoid(self.shear_stress, self.x)) / self.contact.line_load

    @property
    def rolling_traction(self) -> float:
        """Rolling force on each surface, half the integral of h dp. Theory (H19). [N/m]"""
        mean = (self.film[1:] + self.film[:-1]) / 2
        return float((mean * np.diff(self.pressure)).sum()) / 2

    @property
    def rolling_loss(self) -> float:
        """Power per length that rolling costs. Theory (H19). [W/m]"""
        return 2 * self.rolling_traction * self.contact.rolling_speed

    @property
    def mass_error(self) -> float:
        """Largest difference of flow between faces of the full film, over the flow. [1]"""
        full = self.flow[: np.flatnonzero(self.pressure > 0)[-1] + 1]
        return float(np.ptp(full) / full.mean())


def solve_smooth(
    contact: LineContact,
    nodes: int = NODES,
    # Where the film starts, over b_h and below -1; by default so far off that it does not matter, a
    # fully flooded contact.
    inlet: float | None = None,
    heating: Heating | None = None,  # Isothermal without.
) -> SmoothSolution:
    """Steady smooth solution of a contact. Theory (H14)."""
    easing = flow_easing(contact, heating)
    film = expected_film(contact, easing)
    fluid = contact.scaled_fluid(easing)
    grid = grid_for(film, inlet)
    x = graded_nodes(node_counts(nodes)[0], grid)
    pressure = _first_guess(x, film)
    message, iterations, error = "", 0, math.inf
    matrix = deflection_matrix(x, x)
    approach = film - float(np.interp(0.0, x, matrix @ pressure))
    for count in node_counts(nodes):
        if count != x.size:
            finer = graded_nodes(count, grid)
            pressure, x = np.interp(finer, x, pressure), finer
            matrix = deflection_matrix(x, x)
        try:
            pressure, height, flow, approach, iterations, error = solve_steady(
                x, x**2 / 2, matrix, math.pi / 2, fluid, pressure, approach, TOLERANCE,
                MAX_ITERATIONS,
            )  # fmt: skip
        except np.linalg.LinAlgError:
            iterations, message = 0, "the equations of a Newton step are singular"
            height, flow = np.full_like(x, math.nan), np.full(x.size - 1, math.nan)
        if iterations <= 0:
            message = message or f"no convergence in {-iterations} Newton steps on {count} nodes"
            break
    si = x * contact.half_width, pressure * contact.hertz_pressure, height * contact.film_scale
    heating = None if message else heating
    rise = np.zeros_like(x) if heating is None else temperature_rise(contact, heating, *si)
    thinned = thinning(contact, heating, si[1], rise)
    stress = shear_stresses(pressure, height, thinned, contact.scaled_fluid())
    return SmoothSolution(
        contact=contact,
        status=Status.FAILED if message else Status.CONVERGED,
        message=message,
        iterations=abs(iterations),
        error=error,
        x=si[0],
        pressure=si[1],
        film=si[2],
        shear_stress=stress * contact.hertz_pressure,
        flow=flow * contact.film_scale * contact.rolling_speed,
        temperature_rise=rise,
    )


def expected_film(contact: LineContact, easing: float = 1.0) -> float:
    """H = h R/b^2 from the fit of Moes. Theory (H3), (H20).

    A flow that is eased by a factor is that of an oil thinner by it, with the same slope.
    """
    load = contact.moes_load * math.sqrt(easing)
    material = contact.moes_material * math.pow(easing, -0.25)
    return moes_central_film(load, material) * math.pi / (8 * load)


def node_counts(nodes: int) -> Sequence[int]:
    """Numbers of nodes of the solutions one after the other, the last being `nodes`."""
    counts = [nodes]
    while counts[0] > REFINEMENT * COARSE_NODES:
        counts.insert(0, counts[0] // REFINEMENT)
    if counts[0] > COARSE_NODES:
        counts.insert(0, COARSE_NODES)
    return counts


def _first_guess(x: FloatArray, film: float) -> FloatArray:
    """Half an ellipse, as wide as the contact or, in a thick film, as the parabola of the gap."""
    width = math.sqrt(1 + film)
    pressure = np.sqrt(np.maximum(1 - (x / width) ** 2, 0)) / width
    full = (x > 0) & (x < 1 + EXIT_GUESS * gap_length(film))
    return np.where(full, np.maximum(pressure, TRACE), pressure)
