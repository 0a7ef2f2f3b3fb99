"""Flows through pockets that were solved for one operating point, for those next to them.

While temperatures settle, the density of the mixture changes by a few percent, and with it the one
number that the flow depends on. Between two flows so near to each other scaled figures follow
straight lines, so that not every pass has to solve its flow.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.lubricant.properties import MixtureState
from epicyclic.pocketing.similarity import FlowFamily, FlowFigures, from_scaled, scaled_figures

__all__ = ["FlowMemory"]

Floats = NDArray[np.float64]

CURVATURE = 20.0
"""Second derivative of the scaled power over ln(number), over that power, at most: 15 in second
differences over 1 and 4 % of the number, in meshes of the built-in cases, of asymmetric ones and of
an e-axle. [1]"""
CURVATURE_WITH_VOIDS = 80.0
"""The same where pockets hold voids, 60 there. [1]"""
ERROR = 1e-5
"""Largest error of an interpolated power, relative: flows themselves are found to 1e-3. [1]"""


class FlowMemory:
    """Solved flows of some families."""

    def __init__(self) -> None:
        self._known: dict[FlowFamily, dict[float, Floats]] = {}

    def figures(
        self, family: FlowFamily, speed: float, mixture: MixtureState, pressure: float
    ) -> FlowFigures | None:
        """The flow between the two nearest ones known; None if that may be too far off."""
        known = self._known.get(family, {})
        place = math.log(FlowFamily.number(speed, mixture, pressure))
        nearest = sorted(known, key=lambda other: abs(other - place))[:2]
        if nearest and nearest[0] == place:
            return from_scaled(known[place], speed, mixture.density)
        if len(nearest) < 2:
            return None
        one, two = nearest
        curvature = CURVATURE_WITH_VOIDS if family.model == "incompressible" else CURVATURE
        error = curvature * abs((place - one) * (place - two)) / 2
        if error > ERROR:
            return None
        part = (place - one) / (two - one)
        scaled = known[one] + part * (known[two] - known[one])
        return from_scaled(scaled, speed, mixture.density, nodes=2, error=error)

    def add(
        self,
        family: FlowFamily,
        speed: float,
        mixture: MixtureState,
        pressure: float,
        figures: FlowFigures,
    ) -> None:
        """Remember a flow that repeats."""
        if figures.periodic:
            place = math.log(FlowFamily.number(speed, mixture, pressure))
            known = self._known.setdefault(family, {})
            known[place] = scaled_figures(figures, speed, mixture.density)
