"""Deviations of computed from measured losses over weights, for any values of some keys."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.parameters import Parameter
from epicyclic.errors import ConvergenceError
from epicyclic.measurement.model import MeasuredPoints

FloatArray = NDArray[np.float64]

STEP = 1e-2
"""Step of the differences that give the derivatives, over the start value: flows through pockets
are found to 1e-3 of their power, which smaller steps would show. [1]"""


@dataclass(slots=True)
class Residuals:
    """Deviations over weights at the points of calibration, and their derivatives. Theory (X1)."""

    points: MeasuredPoints
    # Their values are given as ratios to the start values, "scaled".
    parameters: Sequence[Parameter]
    used: NDArray[np.bool_]  # Points of the table that the fit sees.
    _known: dict[tuple[float, ...], FloatArray] = field(default_factory=dict)
    _offset: FloatArray | float = 0.0

    def correct(self, exact: Residuals, scaled: FloatArray) -> None:
        """From now on, agree with others at one place."""
        self._offset = 0.0
        offset = exact(scaled) - self(scaled)
        if np.isfinite(offset).all():
            self._offset = offset

    @property
    def evaluations(self) -> int:
        """Computed points."""
        return len(self._known) * len(self.points.measured)

    @property
    def uncertainty(self) -> FloatArray | None:
        """Uncertainty of the losses at the points used; None if they have none. [W]"""
        whole = self.points.measured.uncertainty
        return None if whole is None else whole[self.used]

    @property
    def bounds(self) -> FloatArray:
        """Bounds of the scaled parameters, shape (p, 2). [1]"""
        return np.array([item.ends for item in self.parameters])

    def settings(self, scaled: FloatArray) -> dict[str, Any]:
        """The values of the keys as a case file has them."""
        return {
            item.key: item.value(float(z)) for item, z in zip(self.parameters, scaled, strict=True)
        }

    def __call__(self, scaled: FloatArray) -> FloatArray:
        return self.at([scaled])[0]

    def derivatives(self, scaled: FloatArray, *, central: bool = False) -> FloatArray:
        """d(residual)/d(scaled parameter), all from one batch of points, shape (n, p).

        By differences to one side, or to both, `central`, where bounds leave room for them.
        """
        ahead = [
            -STEP if z + STEP > high else STEP
            for z, (_, high) in zip(scaled, self.bounds, strict=True)
        ]
        behind = [
            -STEP if central and step > 0 and z - STEP >= low else 0.0
            for z, step, (low, _) in zip(scaled, ahead, self.bounds, strict=True)
        ]
        unit = np.eye(scaled.size)
        moved = self.at(
            [
                scaled + step * one
                for steps in (ahead, behind)
                for step, one in zip(steps, unit, strict=True)
            ]
        )
        span = np.subtract(ahead, behind)
        table = (np.array(moved[: scaled.size]) - moved[scaled.size :]) / span[:, None]
        if not np.isfinite(table).all():
            raise ConvergenceError(
                f"near {self.settings(scaled)} points cannot be computed; fit fewer keys, or "
                "start from other values."
            )
        return table.T

    def at(self, scaled: Sequence[FloatArray]) -> list[FloatArray]:
        """Deviations for each of several parameter sets; those that are not known in one batch."""
        sets = [tuple(map(float, one)) for one in scaled]
        new = [one for one in dict.fromkeys(sets) if one not in self._known]
        measured = self.points.measured.loss[self.used]
        weight = 1.0 if self.uncertainty is None else 1 / self.uncertainty
        settings = [self.settings(np.array(one)) for one in new]
        for one, computed in zip(new, self.points.compute(*settings) if new else [], strict=True):
            self._known[one] = (computed.loss[self.used] - measured) * weight
        return [self._known[one] + self._offset for one in sets]
