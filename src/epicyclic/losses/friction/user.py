"""Coefficients of friction that the user gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.losses.contact import MeshContact
from epicyclic.losses.validity import Range

__all__ = ["Constant", "FrictionMap"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Constant:
    """The same coefficient everywhere."""

    title: ClassVar = "constant friction"
    source: ClassVar = "the case"
    ranges: ClassVar[tuple[Range, ...]] = ()

    value: float

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        return np.full_like(contact.line_load, self.value)


@dataclass(frozen=True, slots=True)
class FrictionMap:
    """Linear interpolation in a table over one or two local quantities, constant beyond it.

    Theory (F17).

    Attributes
    ----------
    axes : tuple of (str, tuple of float)
        Name of a quantity of `MeshContact` and its rising points, SI.
    values : tuple
        Coefficients, one (nested) entry for each point.
    """

    title: ClassVar = "friction table"
    source: ClassVar = "the case"
    ranges: ClassVar[tuple[Range, ...]] = ()

    axes: tuple[tuple[str, tuple[float, ...]], ...]
    values: tuple[float, ...] | tuple[tuple[float, ...], ...]

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        from scipy.interpolate import RegularGridInterpolator

        points = [np.asarray(axis) for _, axis in self.axes]
        table = RegularGridInterpolator(points, np.asarray(self.values))
        where = [np.clip(getattr(contact, name), axis[0], axis[-1]) for name, axis in self.axes]
        mu: FloatArray = table(np.column_stack(where))
        return mu
