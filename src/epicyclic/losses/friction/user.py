"""Coefficients of friction that the user gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.losses.contact import MeshContact
from epicyclic.losses.validity import Range, RegressionFluid
from epicyclic.units import GIGAPASCAL, METRE_PER_SECOND, NUMBER, Quantity

FloatArray = NDArray[np.float64]

_AXES: dict[str, tuple[str, Quantity]] = {
    "slide_to_roll_ratio": ("slide-to-roll ratio", NUMBER),
    "film_ratio": ("film ratio", NUMBER),
    "hertz_pressure": ("Hertz pressure", GIGAPASCAL),
    "rolling_speed": ("rolling speed", METRE_PER_SECOND),
}
"""Label and display unit of the quantities that a table may have as axes."""


@dataclass(frozen=True, slots=True)
class Constant:
    """The same coefficient everywhere."""

    name: ClassVar = "constant"
    title: ClassVar = "constant friction"
    source: ClassVar = "the case"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = False
    ranges: ClassVar[tuple[Range, ...]] = ()

    value: float

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        return np.full_like(contact.line_load, self.value)


@dataclass(frozen=True, slots=True)
class FrictionMap:
    """Linear interpolation in a table over one or two local quantities, constant beyond it.

    Theory (F17).
    """

    name: ClassVar = "table"
    title: ClassVar = "friction table"
    source: ClassVar = "the case"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = False

    # Name of a quantity of `MeshContact` and its rising points, SI.
    axes: tuple[tuple[str, tuple[float, ...]], ...]
    # Coefficients, one (nested) entry for each point.
    values: tuple[float, ...] | tuple[tuple[float, ...], ...]

    @property
    def ranges(self) -> tuple[Range, ...]:
        """From the first to the last point of every axis."""
        return tuple(
            Range(
                name,
                label,
                _shown(points[0], unit),
                _shown(points[-1], unit),
                unit,
                "[friction_table] of the case",
            )
            for name, points in self.axes
            for label, unit in (_AXES[name],)
        )

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        from scipy.interpolate import RegularGridInterpolator

        points = [np.asarray(axis) for _, axis in self.axes]
        table = RegularGridInterpolator(points, np.asarray(self.values))
        where = [np.clip(getattr(contact, name), axis[0], axis[-1]) for name, axis in self.axes]
        mu: FloatArray = table(np.column_stack(where))
        return mu


def _shown(value: float, unit: Quantity) -> float:
    return unit.to_display(value) if unit.si else value
