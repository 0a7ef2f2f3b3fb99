"""The pocketing losses of the meshes of a case over speed and oil temperature, to be used again."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from epicyclic.build.machine import build
from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import Status, one_problem
from epicyclic.losses.pocket_tables import (
    ATTRIBUTE,
    FLOW_NUMBERS,
    FlowFamily,
    FlowFigures,
    FlowTable,
    make_tables,
    store,
)
from epicyclic.machine.pocket_flow import POCKETING_SOURCE, flow_request, pocketing_method
from epicyclic.oil.oil import MixtureState
from epicyclic.result.result import origin
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.operating import AXES
from epicyclic.study.pockets import mesh_duties
from epicyclic.study.sweeps.run import SweepPlan, make_plan
from epicyclic.study.sweeps.runner import Plan, Progress, Row, Rows, Runner

if TYPE_CHECKING:
    import xarray as xr

_PER_OCTAVE = 256
"""Numbers in each doubling at which a flow may be solved; few of them are. Fewer leave gaps."""
_DRIVERS = (1, 2)


def pocketing_table(
    case: CaseSource,
    speeds: Iterable[Any],
    temperatures: Iterable[Any] | None = None,
    *,
    jobs: int | None = None,
    dask: str | None = None,
    shard: tuple[int, int] | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Pocketing losses over speed and oil temperature, which cases can read again.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
    speeds : iterable
        Speeds of the input member (the pinion of a pair), as text with units.
    temperatures : iterable, optional
        Temperatures of the oil at the inlet. Default: that of the case.
    jobs, dask, shard, journal, progress
        As for `sweep`; the points are the tables, one for each mesh and member that drives.

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
    plan = make_table_plan(as_case(case), speeds, temperatures)
    return table_dataset(plan, Runner(jobs, dask, shard, journal, progress).run(plan))


@dataclass(frozen=True, slots=True)
class _Flow:
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
        """Speed over the root of pressure over density. [1/m]"""
        return self.family.number(*self.request)


def _flows(case: Case, index: int) -> Iterator[_Flow]:
    """Every mesh, either member driving."""
    built = build(case)
    for duty in built.mean_duties().values():
        family, speed, mixture, pressure = flow_request(duty, built.fluids)
        for driver in _DRIVERS:
            yield _Flow(index, replace(family, drives1=driver == 1), (speed, mixture, pressure))


@dataclass(frozen=True, slots=True)
class TablePlan(Plan):
    """Tables to be made: of every mesh, either member driving."""

    kind: ClassVar[str] = "pockets-table"
    batch: ClassVar[int] = 1  # A table takes seconds.
    places: SweepPlan
    flows: tuple[_Flow, ...]

    @classmethod
    def again(cls, content: Mapping[str, Any], source: str) -> TablePlan:
        """The plan that `describe` described."""
        return _table_plan(SweepPlan.again(content, source))

    @property
    def case(self) -> Case:
        """The case whose meshes they are of."""
        return self.places.case

    @property
    def source(self) -> str:
        """The file of the case."""
        return self.places.source

    @property
    def families(self) -> list[FlowFamily]:
        """What the tables are of."""
        return list(dict.fromkeys(flow.family for flow in self.flows))

    @property
    def size(self) -> int:
        """Number of tables."""
        return len(self.families)

    def describe(self) -> dict[str, Any]:
        """The case, its speeds and temperatures."""
        return self.places.describe()

    def _solve(self, index: int) -> Row:
        return _row(self._table(self.families[index]))

    def _table(self, family: FlowFamily) -> FlowTable:
        asked = {flow.number for flow in self.flows if flow.family == family and flow.turns}
        low, high = min(asked), max(asked)
        count = math.ceil(_PER_OCTAVE * math.log2(high / low)) + 1
        wanted = asked.union(map(float, np.geomspace(low, high, count)))
        return make_tables({family: wanted}, self.case.numerics.pocket_interpolation)[family]


def make_table_plan(
    case: Case, speeds: Iterable[Any], temperatures: Iterable[Any] | None = None
) -> TablePlan:
    """Check what is to be tabulated. Parameters as for `pocketing_table`."""
    given = case.inputs()["operation"]["oil_inlet_temperature"]
    temperatures = [given] if temperatures is None else temperatures
    return _table_plan(make_plan(case, {AXES["speed"]: speeds, AXES["temperature"]: temperatures}))


def _table_plan(places: SweepPlan) -> TablePlan:
    case = places.case
    if case.numerics.pocket_interpolation == 0:
        allowed = "must be above 0, because a table is interpolated."
        raise one_problem("numerics.pocket_interpolation", "0", allowed, "Take 0.002.", case.source)
    flows = tuple(
        flow
        for index in range(places.size)
        for flow in _flows(case.updated(places.changes(index)), index)
    )
    plan = TablePlan(places, flows)
    for family in plan.families:
        if not any(flow.turns for flow in flows if flow.family == family):
            name, allowed = family.mesh.name, "stands still at all these speeds."
            raise one_problem(name, "", allowed, "Give other speeds.", case.source)
        try:
            _ = family.geometry
        except ValueError as error:
            allowed = f"has no tooth outline: {error}."
            remedy = "Change the tooth (tip and root diameter, tool_tip_radius)."
            raise one_problem(family.mesh.name, "", allowed, remedy, case.source) from None
    return plan


def _row(table: FlowTable) -> Row:
    """A table as a flat record."""
    numbers = {"error": table.error, "nodes": table.number.size}
    numbers |= {f"number {i}": value for i, value in enumerate(table.number)}
    numbers |= {f"scaled {i} {j}": value for (i, j), value in np.ndenumerate(table.scaled)}
    numbers |= {f"readable {i}": value for i, value in enumerate(table.readable)}
    return Row(str(Status.CONVERGED), numbers={name: float(x) for name, x in numbers.items()})


def _table_of(rows: Rows, index: int) -> FlowTable:
    """The table of a flat record."""

    def read(name: str) -> float:
        return float(rows.numbers(name)[index])

    nodes = range(int(read("nodes")))
    return FlowTable(
        number=np.array([read(f"number {i}") for i in nodes]),
        scaled=np.array([[read(f"scaled {i} {j}") for j in range(5)] for i in nodes]),
        readable=np.array([read(f"readable {i}") for i in nodes[:-1]], dtype=np.bool_),
        error=read("error"),
    )


def table_dataset(plan: TablePlan, rows: Rows) -> xr.Dataset:
    """The tables, and what they say at the speeds and temperatures of the plan."""
    import xarray as xr

    case, families = plan.case, plan.families
    if rows.failures:
        raise one_problem("", "", rows.failures[0], "Change the case.", case.source)
    made = [i for i, status in enumerate(rows.status) if status == Status.CONVERGED]
    tables = {families[i]: _table_of(rows, i) for i in made}
    meshes = [duty.gears.key for duty in mesh_duties(case)]
    coordinates: dict[str, Any] = {
        "mesh": meshes,
        "driver": ("driver", list(_DRIVERS), {"long_name": "member that drives"}),
    }
    labels = {"speed": "speed of the input member", "temperature": "oil inlet temperature"}
    for (name, label), axis in zip(labels.items(), plan.places.axes, strict=True):
        about = {"long_name": label, "units": axis.unit}
        coordinates[name] = name, list(axis.coordinate), about
    both = (len(meshes), len(_DRIVERS))
    values = np.full((len(FLOW_NUMBERS), *both, *plan.places.shape), math.nan)
    flat = values.reshape(len(FLOW_NUMBERS), len(families), plan.places.size)
    for flow in plan.flows:
        figures = _figures(flow, tables.get(flow.family))
        if figures is not None:
            flat[:, families.index(flow.family), flow.index] = [
                unit.to_display(getattr(figures, name)) for name, (_, unit) in FLOW_NUMBERS.items()
            ]
    variables: dict[str, Any] = {
        name: (tuple(coordinates), array, {"long_name": label, "units": unit.display or "1"})
        for array, (name, (label, unit)) in zip(values, FLOW_NUMBERS.items(), strict=True)
    }
    errors = rows.numbers("error").reshape(both)
    about = {"long_name": "largest error of the power, interpolated", "units": "1"}
    variables["interpolation_error"] = (("mesh", "driver"), errors, about)
    attributes = {
        "title": case.title,
        **origin(case),
        "method": f"{pocketing_method(plan.flows[0].family.model, None)}; {POCKETING_SOURCE}",
        "conventions": "power in W of one mesh; member 1: sun, planet in the ring mesh, pinion",
        ATTRIBUTE: store(tables),
    }
    return xr.Dataset(variables, coordinates, attributes)


def _figures(flow: _Flow, table: FlowTable | None) -> FlowFigures | None:
    if not flow.turns:
        return FlowFigures(0.0, 0.0, 0.0, 0.0, 0.0)
    return None if table is None else table.figures(*flow.request)
