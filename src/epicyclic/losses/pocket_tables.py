"""Flows through pockets by the one number on which they depend: in tables, memory and files."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import lru_cache
from importlib import metadata
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from epicyclic.arrays import Alone, BoolArray, FloatArray, Points, every, larger, sqrt
from epicyclic.dataclass import asdict, dataclass, field, replace
from epicyclic.errors import ConvergenceError, InputError, Problem, raise_any
from epicyclic.files import sealed, unsealed
from epicyclic.gears.cutting import Tool
from epicyclic.gears.mesh import Mesh
from epicyclic.losses.pocket_flow import (
    NETWORK_MODELS,
    PocketFlow,
    PocketModel,
    pocket_flow,
    void_number,
)
from epicyclic.losses.pocket_geometry import PocketGeometry, pocket_geometry
from epicyclic.netcdf_file import read_attribute
from epicyclic.oil.oil import MixtureState
from epicyclic.units import BAR, METRE_PER_SECOND, NUMBER, WATT, Quantity

# Flows through the pockets of a mesh that differ in one number only.
#
# Viscosity takes no part in the flow. For given pockets, share of oil and resolution its equations
# hold speed, density and ambient pressure in one number, so that one curve over it serves all
# speeds and temperatures.

LEAST_NUMBER = 1e-3
"""Number below which the scaled figures are those at it: there the fluid is incompressible to 1e-6,
and at next to no speed pressures drown in rounding. [1/m]"""


@dataclass(frozen=True, slots=True)
class FlowFigures:
    """What a result reports of the flow through the pockets of a mesh."""

    pointwise = True

    power: float  # [W]
    difference: float  # Difference of the power from the energy balance, relative. [1]
    pressure_max: float  # Above ambient. [Pa]
    pressure_min: float  # Above ambient. [Pa]
    speed_max: float  # [m/s]
    periods: int = 0  # Mesh periods until the flow repeated.
    periodic: bool = True  # False if it did not.
    # Number of flows in the table that these figures were read from; zero for the flow itself.
    nodes: int = 0
    # Largest error of the power in that table, relative, measured at flows left out of it; NaN for
    # the flow itself. [1]
    error: float = math.nan
    file: str = ""  # Name of the file that holds this table; empty if there is none.


FLOW_NUMBERS: dict[str, tuple[str, Quantity]] = {
    "power": ("pocketing loss of one mesh", WATT),
    "pressure_max": ("highest pressure in the pockets, above ambient", BAR),
    "pressure_min": ("lowest pressure in the pockets, above ambient", BAR),
    "speed_max": ("highest flow speed out of or into a pocket", METRE_PER_SECOND),
    "difference": ("pocketing loss: error of its energy balance", NUMBER),
}
"""Label and quantity of the numbers of `FlowFigures`."""


@dataclass(frozen=True, slots=True)
class FlowFamily:
    """All flows through the same pockets. Attributes as for `pocket_geometry` and `pocket_flow`.

    The share of oil is 1 for the models in which it enters through the density alone.
    """

    mesh: Mesh
    tools: tuple[Tool | None, Tool | None]
    drives1: bool
    oil_fraction: float
    model: PocketModel
    slices: int
    steps: int
    end_length: float

    @property
    def geometry(self) -> PocketGeometry:
        """The pockets."""
        return pocket_geometry(self.mesh, self.tools, self.drives1)

    def flow(self, speed: float, mixture: MixtureState, pressure: float) -> PocketFlow:
        """The flow itself. Parameters as for `pocket_flow`."""
        resolution = (self.slices, self.steps, self.end_length)
        return pocket_flow(self.geometry, speed, mixture, pressure, self.model, *resolution)

    @staticmethod
    def number(speed: float, mixture: MixtureState, pressure: float) -> float:
        """Speed over the root of pressure over density, held at the least. Theory (Q21). [1/m]"""
        return larger(speed * sqrt(mixture.density / pressure), LEAST_NUMBER)

    def scales(self, speed: float, mixture: MixtureState, pressure: float) -> bool:
        """Whether flows are all another one times density and powers of the speed."""
        if self.model != "incompressible":
            return self.model in NETWORK_MODELS
        try:
            limit = void_number(self.geometry, self.slices, self.steps, self.end_length)
        except ValueError:  # no tooth outline: the solution says so
            return False
        return every(self.number(speed, mixture, pressure) <= limit)

    def figures(self, speed: float, mixture: MixtureState, pressure: float) -> FlowFigures:
        """Figures of the flow itself. Parameters as for `pocket_flow`."""
        least = every(self.number(speed, mixture, pressure) == LEAST_NUMBER)
        if least or self.scales(speed, mixture, pressure):
            scaled = kept_figures(self, LEAST_NUMBER)
            if np.isfinite(scaled).all():
                return from_scaled(scaled, speed, mixture.density)
        if isinstance(speed, Points):
            raise Alone
        return flow_figures(self.flow(speed, mixture, pressure))

    def scaled(self, number: float) -> FloatArray:
        """Scaled figures of the flow at a number; NaN if it does not repeat or is not found."""
        unit, solve = MixtureState(self.oil_fraction, 1.0, 0.0), pocket_flow.__wrapped__
        resolution = (self.slices, self.steps, self.end_length)
        with suppress(ConvergenceError):  # not kept: only its figures are needed again
            flow = solve(self.geometry, number, unit, 1.0, self.model, *resolution)
            if flow.periodic:
                return scaled_figures(flow_figures(flow), number, 1.0)
        return np.full(5, math.nan)


def flow_figures(flow: PocketFlow) -> FlowFigures:
    """The figures of a flow."""
    return FlowFigures(
        power=flow.power,
        difference=flow.difference,
        pressure_max=float(flow.pressure.max()),
        pressure_min=float(flow.pressure.min()),
        speed_max=flow.speed_max,
        periods=flow.periods,
        periodic=flow.periodic,
    )


def scaled_figures(figures: FlowFigures, speed: float, density: float) -> FloatArray:
    """Power, difference, pressures and speed as functions of the number alone. Theory (Q22)."""
    head = density * speed**2
    return np.array(
        [
            figures.power / (head * speed),
            figures.difference,
            figures.pressure_max / head,
            figures.pressure_min / head,
            figures.speed_max / speed,
        ]
    )


def from_scaled(
    scaled: FloatArray, speed: float, density: float, nodes: int = 0, error: float = math.nan
) -> FlowFigures:
    """The reverse of `scaled_figures`."""
    power, difference, highest, lowest, fastest = map(float, scaled)
    head = density * speed**2
    return FlowFigures(
        power=power * head * speed,
        difference=difference,
        pressure_max=highest * head,
        pressure_min=lowest * head,
        speed_max=fastest * speed,
        nodes=nodes,
        error=error,
    )


# Tables of flows through pockets over the one number that they depend on.
#
# A table is made for the numbers that are asked of it. It starts from few of them and adds the one
# nearest to the middle of every interval until the flow there was predicted by the others well
# enough; where that does not come to pass, all numbers asked for are solved.

WIDEST = math.log(2.0)
"""Largest distance of the first nodes, where the numbers asked for lie closer: an octave."""
SAME = 1e-9  # Numbers that differ less, relatively, are one: machines round differently. [1]
KEPT_MOST = 10_000  # Flows remembered for the next tables.


@dataclass(frozen=True, slots=True, eq=False)
class FlowTable:
    """Scaled figures of a family of flows over its number."""

    number: FloatArray  # Rising. [1/m]
    scaled: FloatArray  # As from `scaled_figures`; NaN where the flow does not repeat.
    readable: BoolArray  # Whether the table may be read between two of its numbers.
    # Largest error of the power in what is readable, each measured at a number before that was
    # added to the table. [1]
    error: float
    file: str = ""  # Name of the file that it was read from; empty if from none.

    def figures(self, speed: float, mixture: MixtureState, pressure: float) -> FlowFigures | None:
        """Figures of a flow; None where the table has none. Parameters as for `pocket_flow`."""
        scaled = self._at(FlowFamily.number(speed, mixture, pressure))
        if scaled is None or not np.isfinite(scaled).all():
            return None
        figures = from_scaled(scaled, speed, mixture.density, self.number.size, self.error)
        return replace(figures, file=self.file)

    def _at(self, number: float) -> FloatArray | None:
        nearest = int(np.abs(self.number - number).argmin())
        if abs(self.number[nearest] / number - 1) <= SAME:
            node: FloatArray = self.scaled[nearest]
            return node
        interval = int(np.searchsorted(self.number, number)) - 1
        if not (0 <= interval < self.readable.size and self.readable[interval]):
            return None
        return interpolate(np.log(self.number), self.scaled, math.log(number))


FlowTables = Mapping[FlowFamily, FlowTable]


def table_around(number: float, scaled: FloatArray, reach: float) -> FlowTable:
    """One flow for all numbers that differ from its own by `reach` at most, relatively.

    The error is not known: scaled figures change about as much as their number.
    """
    numbers = number * np.array([1 - reach, 1.0, 1 + reach])
    return FlowTable(numbers, np.tile(scaled, (3, 1)), np.ones(2, dtype=np.bool_), math.nan)


def interpolate(place: FloatArray, values: FloatArray, at: float) -> FloatArray:
    """Cubic through the two nearest points on either side; at the ends the nearest four."""
    first = int(np.searchsorted(place, at)) - 2
    first = max(0, min(first, place.size - 4))
    near = place[first : first + 4]
    weights = np.ones(near.size)
    for i in range(near.size):
        others = np.delete(near, i)
        weights[i] = np.prod((at - others) / (near[i] - others))
    return weights @ values[first : first + 4]


def make_tables(
    asked: Mapping[FlowFamily, Iterable[float]],  # [1/m]
    bound: float,  # Largest error of the power between the numbers of a table. [1]
    threads: int | None = None,  # Flows solved at once; default: one on each core.
) -> dict[FlowFamily, FlowTable]:
    """Tables for the numbers asked of each family."""
    growing = {family: _Growing(numbers, bound) for family, numbers in asked.items()}
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        while True:
            wanted = [(family, number) for family in growing for number in growing[family].wanted()]
            if not wanted:
                return {family: table.finished() for family, table in growing.items()}
            for family in {family for family, _ in wanted}:
                _ = family.geometry  # once, before threads ask for it at the same time
            solved = list(pool.map(kept_figures, *zip(*wanted, strict=True)))
            for family, table in growing.items():
                flows = zip(wanted, solved, strict=True)
                table.take({number: flow for (one, number), flow in flows if one == family})


@lru_cache(maxsize=KEPT_MOST)
def kept_figures(family: FlowFamily, number: float) -> FloatArray:
    """As `FlowFamily.scaled`, solved once."""
    return family.scaled(number)


class _Growing:
    """A table while it grows. Numbers asked for are known by their places in rising order."""

    def __init__(self, numbers: Iterable[float], bound: float) -> None:
        rising = sorted(numbers)
        distinct = [rising[0]]
        for number in rising:
            if number > distinct[-1] * (1 + SAME):
                distinct.append(number)
        self._number = np.array(distinct)
        self._place = np.log(self._number)
        self._bound = bound
        self._solved: dict[int, FloatArray] = {}
        self._open: list[tuple[int, int]] = []
        self._readable: set[tuple[int, int]] = set()
        self._error = 0.0

    def wanted(self) -> list[float]:
        """Numbers at which the flow is needed next; none when the table is finished."""
        if not self._solved:
            return [float(self._number[i]) for i in self._first()]
        return [float(self._number[self._middle(gap)]) for gap in self._open]

    def take(self, flows: Mapping[float, FloatArray]) -> None:
        """Scaled figures at the numbers that were wanted."""
        places = {
            int(np.searchsorted(self._number, number)): flow for number, flow in flows.items()
        }
        if not self._solved:
            self._open = list(pairwise(sorted(places)))
        else:
            known = sorted(self._solved)
            scaled = np.array([self._solved[i] for i in known])
            checked, self._open = self._open, []
            for gap in checked:
                middle = self._middle(gap)
                expected = interpolate(self._place[known], scaled, float(self._place[middle]))
                error = abs(float(expected[0] / places[middle][0]) - 1)
                halves = ((gap[0], middle), (middle, gap[1]))
                if error <= self._bound:
                    self._error = max(self._error, error)
                    self._readable.update(halves)
                else:
                    self._open += halves
        self._solved |= places
        self._open = [gap for gap in self._open if gap[1] - gap[0] > 1]

    def finished(self) -> FlowTable:
        """The table."""
        known = sorted(self._solved)
        return FlowTable(
            number=self._number[known],
            scaled=np.array([self._solved[i] for i in known]),
            readable=np.array([gap in self._readable for gap in pairwise(known)], dtype=np.bool_),
            error=self._error,
        )

    def _first(self) -> list[int]:
        """Both ends, and numbers in between no more than an octave apart where there are such."""
        parts = max(1, math.ceil(float(self._place[-1] - self._place[0]) / WIDEST))
        aims = np.linspace(self._place[0], self._place[-1], parts + 1)
        return sorted({int(np.abs(self._place - aim).argmin()) for aim in aims})

    def _middle(self, gap: tuple[int, int]) -> int:
        """The place inside a gap that is nearest to its middle."""
        low, high = gap
        inside = self._place[low + 1 : high]
        middle = (self._place[low] + self._place[high]) / 2
        return low + 1 + int(np.abs(inside - middle).argmin())


# Flows through pockets that were solved for one operating point, for those next to them.
#
# While temperatures settle, the density of the mixture changes by a few percent, and with it the
# one number that the flow depends on. Between two flows so near to each other scaled figures follow
# straight lines, so that not every pass has to solve its flow.

CURVATURE = 20.0
"""Second derivative of the scaled power over ln(number), over that power, at most: 15 in second
differences over 1 and 4 % of the number, in meshes of the built-in cases, of asymmetric ones and of
an e-axle. [1]"""
CURVATURE_WITH_VOIDS = 80.0  # The same where pockets hold voids, 60 there. [1]
ERROR = 1e-5
"""Largest error of an interpolated power, relative: flows themselves are found to 1e-3. [1]"""
RESTLESS = 5e-3
"""Change of ln(number) over which a flow that does not repeat serves, by scaling. Its mean over 30
periods scatters by 1 to 2 %, the scaled power changes by less than that. [1]"""


@dataclass(frozen=True, slots=True, eq=False)
class KnownFlows:
    """Solved flows of some families."""

    one_by_one = True

    # By family and ln(number): scaled figures, and the figures themselves.
    flows: Mapping[tuple[FlowFamily, float], tuple[FloatArray, FlowFigures]] = field(
        default_factory=dict[tuple[FlowFamily, float], tuple[FloatArray, FlowFigures]]
    )

    def figures(
        self, family: FlowFamily, speed: float, mixture: MixtureState, pressure: float
    ) -> FlowFigures | None:
        """The flow between the two nearest ones known; None if that may be too far off."""
        place = math.log(FlowFamily.number(speed, mixture, pressure))
        own = {other: flow for (one, other), flow in self.flows.items() if one == family}
        # the first one that is near, so that figures do not jump between two of them
        for other, (scaled, figures) in own.items():
            if not figures.periodic and abs(other - place) < RESTLESS:
                mean = from_scaled(scaled, speed, mixture.density)
                return replace(mean, periods=figures.periods, periodic=False)
        known = {other: scaled for other, (scaled, figures) in own.items() if figures.periodic}
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

    def with_flow(
        self,
        family: FlowFamily,
        speed: float,
        mixture: MixtureState,
        pressure: float,
        figures: FlowFigures,
    ) -> KnownFlows:
        """These flows and another one."""
        number = FlowFamily.number(speed, mixture, pressure)
        # at the least one it is scaled, and its speed may be too small to divide by
        if isinstance(number, Points) or number == LEAST_NUMBER:
            return self
        place, scaled = math.log(number), scaled_figures(figures, speed, mixture.density)
        return KnownFlows({**self.flows, (family, place): (scaled, figures)})


# Tables of flows through pockets in a file, with the pockets that they were made for.

ATTRIBUTE = "flows"  # Attribute of the NetCDF file that holds the tables as JSON.
_KEY = "models.pocketing_table"
_REMEDY = "Make it with 'epicyclic pockets table', or leave the key out."

NEGLIGIBLE = 1e-3
"""Share of the largest power of a table; what is below zero by less is numerical error. [1]"""

_Plain = bool | int | float | str | None
_Finite = Annotated[float, Field(allow_inf_nan=False)]


class _Stored(BaseModel):
    """One table. Attributes as of `FlowTable`, and the family in plain values."""

    model_config = ConfigDict(extra="forbid", ser_json_inf_nan="constants", defer_build=True)

    family: dict[str, _Plain]
    number: list[Annotated[_Finite, Field(gt=0)]] = Field(min_length=1)
    scaled: list[Annotated[list[float], Field(min_length=5, max_length=5)]]
    readable: list[bool]
    error: Annotated[_Finite, Field(ge=0)]

    @model_validator(mode="after")
    def _fits(self) -> _Stored:
        nodes = len(self.number)
        if len(self.scaled) != nodes or len(self.readable) != nodes - 1:
            raise ValueError("the counts of numbers and figures differ")
        if any(np.diff(self.number) <= 0):
            raise ValueError("the numbers do not rise")
        powers = [figures[0] for figures in self.scaled]
        if np.nanmin(powers, initial=0.0) < -NEGLIGIBLE * np.nanmax(np.abs(powers), initial=0.0):
            raise ValueError("a power is below zero")
        return self


class StoredTables(BaseModel):
    """All tables of a file."""

    model_config = ConfigDict(extra="forbid", ser_json_inf_nan="constants", defer_build=True)

    version: str
    tables: list[_Stored]


def store(tables: Mapping[FlowFamily, FlowTable]) -> str:
    """Tables as the text that a file holds."""
    stored = StoredTables(
        version=metadata.version("epicyclic"),
        tables=[
            _Stored(
                family=_plain(family),
                number=table.number.tolist(),
                scaled=table.scaled.tolist(),
                readable=table.readable.tolist(),
                error=table.error,
            )
            for family, table in tables.items()
        ],
    )
    return sealed(json.loads(stored.model_dump_json()))


def read_stored(path: Path) -> StoredTables:
    """The tables in a file.

    Raises `InputError` if there is no such file, or it is none of these, or of another version.
    """
    return _read(*_state(path))


def _state(path: Path) -> tuple[Path, tuple[int, ...]]:
    """The file, and what tells its contents from others: clocks jump, so not the time alone."""
    try:
        stat = path.stat()
    except (OSError, ValueError) as error:
        raise _error(path, f"cannot be read: {getattr(error, 'strerror', error)}.") from None
    return path.absolute(), (stat.st_ino, stat.st_ctime_ns, stat.st_mtime_ns, stat.st_size)


@lru_cache(maxsize=16)
def _read(path: Path, _state: tuple[int, ...]) -> StoredTables:
    """The file as it was when it was last changed."""
    try:
        stored = StoredTables.model_validate(unsealed(read_attribute(path, ATTRIBUTE)))
    except InputError as error:
        raise _error(path, error.problems[0].allowed) from None
    except ValidationError as error:
        reason = error.errors(include_url=False)[0]["msg"]
        raise _error(path, f"is damaged: {reason}.") from None
    version = metadata.version("epicyclic")
    if stored.version != version:
        raise _error(path, f"was made by version {stored.version}, but this is {version}.")
    return stored


def stored_table(path: Path, family: FlowFamily) -> FlowTable:
    """The table of a family of flows in a file.

    Raises `InputError`: As for `read_stored`, and if the file has no table for these pockets; it
    names what differs.
    """
    return _table(*_state(path), family)


@lru_cache(maxsize=64)
def _table(path: Path, state: tuple[int, ...], family: FlowFamily) -> FlowTable:
    wanted = _plain(family)
    alike = [
        stored
        for stored in _read(path, state).tables
        if stored.family.get("mesh.name") == family.mesh.name
        and stored.family.get("drives1") == family.drives1
    ]
    if not alike:
        raise _error(path, f"has no table for a {family.mesh.name}.")
    stored = alike[0]
    differing = []
    for name in dict.fromkeys([*wanted, *stored.family]):
        if not _same(wanted.get(name), stored.family.get(name)):
            made = f"was made for a {family.mesh.name} with {name} = {_shown(stored.family, name)}"
            remedy = "Make it again with 'epicyclic pockets table', or leave the key out."
            allowed = f"{made}, not {_shown(wanted, name)}."
            differing.append(Problem(_KEY, str(path), allowed, remedy))
    raise_any(differing, str(path))
    return FlowTable(
        number=np.array(stored.number),
        scaled=np.array(stored.scaled),
        readable=np.array(stored.readable, dtype=np.bool_),
        error=stored.error,
        file=path.name,
    )


def _plain(family: FlowFamily) -> dict[str, _Plain]:
    """Everything that the flows of a family depend on, by dotted names, in SI; the face once."""
    return {key: it for key, it in _leaves("", asdict(family)) if key != "mesh.gear2.face_width"}


def _leaves(name: str, value: Any) -> Iterator[tuple[str, _Plain]]:
    if isinstance(value, tuple):
        value = dict(enumerate(value, 1))
    if not isinstance(value, dict):
        yield name, value
        return
    for part, inner in value.items():
        yield from _leaves(f"{name}.{part}" if name else part, inner)


def _same(one: _Plain, other: _Plain) -> bool:
    if isinstance(one, float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=SAME)
    return one == other


def _shown(family: Mapping[str, _Plain], name: str) -> str:
    value = family.get(name)
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def _error(path: Path, allowed: str) -> InputError:
    return InputError([Problem(_KEY, str(path), allowed, _REMEDY)], str(path))
