"""Flows through pockets that were solved for one operating point, for those next to them.

While temperatures settle, the density of the mixture changes by a few percent, and with it the one
number that the flow depends on. Between two flows so near to each other scaled figures follow
straight lines, so that not every pass has to solve its flow.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from epicyclic.lubricant.properties import MixtureState
from epicyclic.pocketing.similarity import FlowFamily, FlowFigures, from_scaled, scaled_figures

Floats = NDArray[np.float64]

CURVATURE = 20.0
"""Second derivative of the scaled power over ln(number), over that power, at most: 15 in second
differences over 1 and 4 % of the number, in meshes of the built-in cases, of asymmetric ones and of
an e-axle. [1]"""
CURVATURE_WITH_VOIDS = 80.0
"""The same where pockets hold voids, 60 there. [1]"""
ERROR = 1e-5
"""Largest error of an interpolated power, relative: flows themselves are found to 1e-3. [1]"""
RESTLESS = 5e-3
"""Change of ln(number) over which a flow that does not repeat serves, by scaling. Its mean over 30
periods scatters by 1 to 2 %, the scaled power changes by less than that. [1]"""


class FlowMemory:
    """Solved flows of some families."""

    def __init__(self) -> None:
        self._known: dict[FlowFamily, dict[float, Floats]] = {}
        self._restless: dict[FlowFamily, dict[float, tuple[Floats, FlowFigures]]] = {}

    def figures(
        self, family: FlowFamily, speed: float, mixture: MixtureState, pressure: float
    ) -> FlowFigures | None:
        """The flow between the two nearest ones known; None if that may be too far off."""
        place = math.log(FlowFamily.number(speed, mixture, pressure))
        # the first one that is near, so that figures do not jump between two of them
        for other, (scaled, figures) in self._restless.get(family, {}).items():
            if abs(other - place) < RESTLESS:
                told = from_scaled(scaled, speed, mixture.density)
                return replace(told, periods=figures.periods, periodic=False)
        known = self._known.get(family, {})
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
        """Remember a flow."""
        place = math.log(FlowFamily.number(speed, mixture, pressure))
        scaled = scaled_figures(figures, speed, mixture.density)
        if figures.periodic:
            self._known.setdefault(family, {})[place] = scaled
        else:
            self._restless.setdefault(family, {})[place] = (scaled, figures)
