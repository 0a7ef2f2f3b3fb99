"""The pocketing losses of the meshes of a case over speed and oil temperature, to be used again."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.analysis.parts import fluids_of
from epicyclic.analysis.pocket_details import mesh_duties
from epicyclic.analysis.pockets import POCKETING_SOURCE, flow_family, pocketing_method
from epicyclic.analysis.result import versions
from epicyclic.case.case import Case
from epicyclic.errors import InputError, Problem
from epicyclic.lubricant.properties import MixtureState
from epicyclic.pocketing.similarity import FlowFamily, FlowFigures
from epicyclic.pocketing.stored import ATTRIBUTE, store
from epicyclic.pocketing.table import FlowTable, make_tables
from epicyclic.sweeps.plan import make_plan
from epicyclic.sweeps.work import Progress
from epicyclic.units import BAR, METRE_PER_SECOND, NUMBER, WATT

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["SPEED", "TEMPERATURE", "pocketing_table"]

SPEED = "operation.speed"
TEMPERATURE = "operation.oil_inlet_temperature"

_PER_OCTAVE = 256
"""Numbers in each doubling at which a flow may be solved; few of them are. Fewer leave gaps."""
_DRIVERS = (1, 2)
_FIGURES = {
    "power": ("pocketing loss of one mesh", WATT),
    "pressure_max": ("highest pressure in the pockets, above ambient", BAR),
    "pressure_min": ("lowest pressure in the pockets, above ambient", BAR),
    "speed_max": ("fastest flow out of or into a pocket", METRE_PER_SECOND),
    "difference": ("pocketing loss: energy balance over work, less 1", NUMBER),
}
"""Attributes of `FlowFigures`."""


def pocketing_table(
    case: Case,
    speeds: Iterable[Any],
    temperatures: Iterable[Any] | None = None,
    *,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Pocketing losses over speed and oil temperature, which cases can read again.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
    speeds : iterable
        Of the input member (the pinion of a pair), as text with units.
    temperatures : iterable, optional
        Of the oil at the inlet. Default: that of the case.
    progress : callable, optional
        Called with the tables done and their number.

    Returns
    -------
    xarray.Dataset
        Dimensions ``mesh``, ``driver`` (which member of the mesh drives, 1 or 2), ``speed`` [rpm]
        and ``temperature`` [degC]. ``power`` [W] is that of one mesh; beside it pressures [bar],
        ``speed_max`` [m/s] and the ``difference`` of the power from the energy balance [1]. At rest
        all are zero; NaN where the flow does not repeat or is not found.
        ``interpolation_error`` [1] is the largest error of the power that was measured at flows
        left out of a table. The attribute ``flows`` holds the tables over the one number
        that they depend on, and all that they were made for; a case whose
        ``models.pocketing_table`` names the file reads them.

    Raises
    ------
    InputError
        For values that cannot be read, a set at rest, a mesh without pockets, and without
        interpolation.
    """
    given = case.inputs()["operation"]["oil_inlet_temperature"]
    axes = {SPEED: speeds, TEMPERATURE: [given] if temperatures is None else temperatures}
    plan = make_plan(case, axes)
    _check(case)
    points = [
        point
        for index in range(plan.size)
        for point in _points(case.updated(plan.changes(index)), index)
    ]
    tables = _make(case, points, progress)
    speed, temperature = plan.axes
    meshes = [duty.key for duty in mesh_duties(case)]
    coordinates = {
        "mesh": meshes,
        "driver": ("driver", list(_DRIVERS), {"long_name": "member that drives"}),
        "speed": _coordinate("speed", speed.coordinate, speed.unit),
        "temperature": _coordinate("temperature", temperature.coordinate, temperature.unit),
    }
    shape = (len(meshes), len(_DRIVERS), *plan.shape)
    return _dataset(case, points, tables, coordinates, shape)


@dataclass(frozen=True, slots=True)
class _Point:
    """A flow through the pockets of a mesh, at a place in speed and temperature."""

    index: int
    family: FlowFamily
    request: tuple[float, MixtureState, float]

    @property
    def turns(self) -> bool:
        """Whether the gears turn against each other."""
        return self.request[0] != 0

    @property
    def number(self) -> float:
        """Of the family. [1/m]"""
        return self.family.number(*self.request)


def _points(case: Case, index: int) -> Iterator[_Point]:
    """Every mesh, either member driving."""
    mixture = fluids_of(case).mixture
    for duty in mesh_duties(case):
        family = flow_family(case, duty)
        request = (abs(duty.speed1), mixture, case.surroundings.pressure)
        for driver in _DRIVERS:
            yield _Point(index, replace(family, drives1=driver == 1), request)


def _check(case: Case) -> None:
    if case.numerics.pocket_interpolation == 0:
        allowed = "must be more than 0: a table is interpolated."
        problem = Problem("numerics.pocket_interpolation", "0", allowed, "Take 0.002.")
        raise InputError([problem], case.source)


def _make(
    case: Case, points: list[_Point], progress: Progress | None
) -> dict[FlowFamily, FlowTable]:
    asked: dict[FlowFamily, set[float]] = {point.family: set() for point in points}
    for point in points:
        if point.turns:
            asked[point.family].add(point.number)
    tables: dict[FlowFamily, FlowTable] = {}
    for family, numbers in asked.items():
        if not numbers:
            problem = Problem(
                family.mesh.name, "", "stands still at all these speeds.", "Give other speeds."
            )
            raise InputError([problem], case.source)
        low, high = min(numbers), max(numbers)
        count = math.ceil(_PER_OCTAVE * math.log2(high / low)) + 1
        wanted = numbers.union(map(float, np.geomspace(low, high, count)))
        try:
            tables |= make_tables({family: wanted}, case.numerics.pocket_interpolation)
        except ValueError as error:
            allowed = f"has no tooth outline: {error}."
            remedy = "Change the tooth (tip and root diameter, tool_tip_radius)."
            problem = Problem(family.mesh.name, "", allowed, remedy)
            raise InputError([problem], case.source) from None
        if progress is not None:
            progress(len(tables), len(asked))
    return tables


def _coordinate(
    name: str, values: tuple[float | str, ...], unit: str
) -> tuple[str, list[float | str], dict[str, str]]:
    labels = {"speed": "speed of the input member", "temperature": "oil inlet temperature"}
    return name, list(values), {"long_name": labels[name], "units": unit}


def _dataset(
    case: Case,
    points: list[_Point],
    tables: dict[FlowFamily, FlowTable],
    coordinates: dict[str, Any],
    shape: tuple[int, ...],
) -> xr.Dataset:
    import xarray as xr

    values = np.full((len(_FIGURES), *shape), math.nan)
    meshes, drivers, *inner = shape
    flat = values.reshape(len(_FIGURES), meshes * drivers, math.prod(inner))
    families = list(tables)
    for point in points:
        figures = _figures(point, tables[point.family])
        if figures is not None:
            flat[:, families.index(point.family), point.index] = [
                unit.to_display(getattr(figures, name)) for name, (_, unit) in _FIGURES.items()
            ]
    variables: dict[str, Any] = {
        name: (tuple(coordinates), array, {"long_name": label, "units": unit.display or "1"})
        for array, (name, (label, unit)) in zip(values, _FIGURES.items(), strict=True)
    }
    errors = np.array([table.error for table in tables.values()]).reshape(meshes, drivers)
    about = {"long_name": "largest error of the power, interpolated", "units": "1"}
    variables["interpolation_error"] = (("mesh", "driver"), errors, about)
    used = versions()
    attributes = {
        "title": case.title,
        "source": f"epicyclic {used['epicyclic']}",
        "versions": json.dumps(used),
        "case": json.dumps(case.inputs()),
        "method": f"{pocketing_method(case, None)}; {POCKETING_SOURCE}",
        "conventions": "power in W of one mesh; member 1: sun, planet in the ring mesh, pinion",
        ATTRIBUTE: store(tables),
    }
    return xr.Dataset(variables, coordinates, attributes)


def _figures(point: _Point, table: FlowTable) -> FlowFigures | None:
    if not point.turns:
        return FlowFigures(0.0, 0.0, 0.0, 0.0, 0.0)
    return table.figures(*point.request)
