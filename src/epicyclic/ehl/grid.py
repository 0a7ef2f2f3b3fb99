"""Nodes of the steady solver: dense where the inlet ends and where the film ruptures."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

MIDDLE_SHARE, INLET_SHARE, EXIT_SHARE = 0.25, 0.375, 0.375
"""Shares of the nodes around x = 0, x = -b and x = b. [1]"""
INLET_WIDTH, EXIT_WIDTH = 0.5, 0.4
"""Widths of the dense zones over the length on which the gap grows by one film. [1]"""
INLET_PARABOLAS = 25.0
"""Distance of the inlet from the contact in parabola widths sqrt(2 h R), where h doubles; the load
of a rigid contact is then 0.3 % short of that of an endless inlet. [1]"""
SAMPLES = 400
"""Samples of each zone from which the inverse of the node density is started."""
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
