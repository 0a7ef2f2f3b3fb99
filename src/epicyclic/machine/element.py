"""What an element of a gearbox sees and answers, its figures, and the fluids around it."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property, lru_cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeVar

from epicyclic.arrays import points_in, taken
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.losses.ranges import (
    Flags,
    ModelUse,
    Range,
    SomeFlags,
    Sought,
    ValidityFlag,
    check_ranges,
)
from epicyclic.losses.shaft_bearing import BearingLoad
from epicyclic.oil.oil import (
    MixtureState,
    Oil,
    OilState,
    extrapolated_viscosity,
    mixture_state,
    oil_state,
)
from epicyclic.units import (
    CELSIUS,
    KILOGRAM_PER_CUBIC_METRE,
    MILLIPASCAL_SECOND,
    PER_GIGAPASCAL,
    SQUARE_MM_PER_SECOND,
    Quantity,
)

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


_VISCOSITY_SOURCE = "ASTM D341, form for 2 mm^2/s and more"
_VISCOSITY = Range(
    "kinematic_viscosity", "kinematic viscosity", 2.0, 2e7, SQUARE_MM_PER_SECOND, _VISCOSITY_SOURCE
)


@dataclass(frozen=True, slots=True)
class Fluids:
    """The oil, its mixture with air, and flags on both."""

    pointwise = True

    oil: OilState
    mixture: MixtureState
    pressure: float  # Ambient. [Pa]
    flags: SomeFlags
    # Oil at the contacts whose temperature differs, by the keys of meshes and bearings.
    contacts: Mapping[str, OilState] = field(default_factory=dict[str, OilState], hash=False)

    def at(self, contact: str) -> OilState:
        """The oil at a contact, at the temperature of its surfaces."""
        return self.contacts.get(contact, self.oil)

    def mixed(self, oil_fraction: float) -> MixtureState:
        """The oil with another share of it in the mixture, by volume."""
        if oil_fraction == self.mixture.oil_fraction:
            return self.mixture
        return mixture_state(self.oil, oil_fraction, self.pressure)

    @property
    def figures(self) -> FluidFigures:
        """The properties for the user."""
        return FluidFigures(
            kinematic_viscosity=self.oil.kinematic_viscosity,
            dynamic_viscosity=self.oil.dynamic_viscosity,
            density=self.oil.density,
            pressure_viscosity=self.oil.pressure_viscosity,
            mixture_density=self.mixture.density,
            mixture_viscosity=self.mixture.dynamic_viscosity,
        )


def oil_at(oil: Oil, temperature: float, pressure_viscosity_factor: float = 1.0) -> OilState:
    """Properties of an oil at `temperature` in kelvin, its alpha multiplied by a factor."""
    state = oil_state(oil, temperature)
    return replace(state, pressure_viscosity=pressure_viscosity_factor * state.pressure_viscosity)


def fluids_at(
    oil: Oil,
    temperature: float,  # [K]
    *,
    oil_air_ratio: float,  # Oil share by volume at ambient pressure. [1]
    pressure: float,  # Ambient. [Pa]
    # Multiplies the pressure-viscosity coefficient of the oil. [1]
    pressure_viscosity_factor: float = 1.0,
) -> Fluids:
    """Oil and mixture at one temperature."""
    state = oil_at(oil, temperature, pressure_viscosity_factor)
    mixture = mixture_state(state, oil_air_ratio, pressure)
    return Fluids(state, mixture, pressure, Flags(partial(oil_flags, oil, temperature)))


@lru_cache(maxsize=64)
def oil_flags(oil: Oil, temperature: float) -> tuple[ValidityFlag, ...]:
    """Where properties of an oil at a temperature leave the data behind them."""
    viscosity = extrapolated_viscosity(oil, temperature)
    low, high = (CELSIUS.to_display(limit) for limit in oil.temperature_range)
    data = Range("temperature", "temperature", low, high, CELSIUS, "data of this oil")
    return check_ranges(
        ModelUse("oil", oil.name, "properties"),
        (data, _VISCOSITY),
        {"temperature": temperature, "kinematic_viscosity": viscosity},
    )


# The figures of a result: what an engineer checks by eye on meshes, bearings and oil.
#
# Figures are dataclass fields that carry their label and unit, so that tables, JSON and sweeps read
# them from one place.


def figure(label: str, unit: Quantity) -> Any:
    """A field of a dataclass that carries its label and unit."""
    return dataclasses.field(metadata={"label": label, "unit": unit})


@dataclass(frozen=True, slots=True)
class Figure:
    """One number for the user, in its display unit; the unit of a pure number is ``"1"``."""

    key: str
    label: str
    value: float
    unit: str


Found = TypeVar("Found")


class Figures(Mapping[str, Found]):
    """Figures by what they describe, found when somebody reads them.

    Most answers of an element are steps on the way to the last one, of which alone anybody does.
    """

    pointwise = True

    __slots__ = ("_finds", "_found")

    def __init__(self, finds: Mapping[str, Callable[[], Found]]) -> None:
        self._finds = finds
        self._found: dict[str, Found] = {}

    @property
    def parts(self) -> tuple[Mapping[str, Callable[[], Found]]]:
        """What they are made of."""
        return (self._finds,)

    def __reduce__(self) -> tuple[Any, ...]:
        return dict, (dict(self),)

    def __getitem__(self, key: str) -> Found:
        if key not in self._found:
            self._found[key] = self._finds[key]()
        return self._found[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._finds)

    def __len__(self) -> int:
        return len(self._finds)


@dataclass(frozen=True, slots=True)
class Extremes:
    """What a contact is judged by: its figures are read only where these may exceed a limit."""

    pointwise = True

    pressure: float  # Largest Hertz pressure; NaN without load or motion. [Pa]
    flattening: float  # Largest half-width of the contact over its radius. [1]
    resistance: float  # As of `MeshFigures`. [1]
    share: float  # Of the contact lines, or of the most loaded roller, that carries. [1]
    # Largest interpolation error of the pocketing loss; NaN where none is interpolated. [1]
    flow_error: float = math.nan


def figures(source: DataclassInstance) -> Iterator[Figure]:
    """The labelled numbers of a dataclass."""
    for it in dataclasses.fields(source):
        if "label" in it.metadata:
            label, unit = it.metadata["label"], it.metadata["unit"]
            yield Figure(it.name, label, displayed(source, it), unit.display or "1")


def displayed(source: DataclassInstance, field: dataclasses.Field[Any]) -> float:
    """A labelled number of a dataclass in its display unit."""
    unit: Quantity = field.metadata["unit"]
    value: float = getattr(source, field.name)
    return unit.to_display(value) if unit.si else value


@dataclass(frozen=True, eq=False)
class PartFigures:
    """Figures of a further element of a train; a file is read with the class that has its keys."""


@dataclass(frozen=True, slots=True, eq=False)
class FluidFigures:
    """Properties of the oil at its inlet temperature, and of its mixture with air."""

    kinematic_viscosity: float = figure("kinematic viscosity of the oil", SQUARE_MM_PER_SECOND)
    dynamic_viscosity: float = figure("dynamic viscosity of the oil", MILLIPASCAL_SECOND)
    density: float = figure("density of the oil", KILOGRAM_PER_CUBIC_METRE)
    pressure_viscosity: float = figure("pressure-viscosity coefficient", PER_GIGAPASCAL)
    mixture_density: float = figure("density of the air-oil mixture", KILOGRAM_PER_CUBIC_METRE)
    mixture_viscosity: float = figure(
        "dynamic viscosity of the air-oil mixture", MILLIPASCAL_SECOND
    )


BENT = 0.25
"""Change of the power with which a loss rises, over the relative change of its load. Where friction
turns from one regime into another it is more. [1]"""
LOAD_DEPENDENT = "load-dependent"
LOAD_INDEPENDENT = "load-independent"
OIL = "oil"  # The thermal node of the oil around the gears.


def joined_key(element: str, name: str) -> str:
    """Key of a part of an element: the element's own before it, if it has one."""
    return f"{element}.{name}" if element else name


@dataclass(frozen=True)
class State:
    """What an element sees of the machine."""

    pointwise = True

    # Speeds of every body, positive in one common sense; that of `HOUSING` is 0. [rad/s]
    speeds: Mapping[str, float]
    # That each mesh takes up at its first gear, by the key of the mesh; all its planets together.
    # Torque times speed of that gear against the carrier is the rolling power. [N m]
    torques: Mapping[str, float]
    forces: Mapping[str, BearingLoad]  # On each bearing of a shaft, by the key of its element.
    fluids: Fluids  # Oil and mixture with air. A machine without elements may do without.
    lossless: bool = False  # True if no loss is known yet that was taken from the torques.
    # For each mesh, True if its first gear drives it; where losses turn a small load round, not
    # before they are found.
    drives: Mapping[str, bool] = field(default_factory=dict[str, bool])
    # Results at another temperature, by the key of the element. What it solved then and what hardly
    # depends on the temperature need not be solved again: flows through pockets.
    earlier: Mapping[str, ElementResult] = field(default_factory=dict[str, Any])
    # Loads of the element; what follows one of them need not be found again, the last serves.
    serve: frozenset[str] = frozenset()

    @cached_property
    def each(self) -> list[State]:
        """That of each of several points, without what was earlier; nothing of a single one."""
        count = points_in(self.speeds.values())
        return taken(replace(self, earlier={}), range(count)) if count else []


class Loss(NamedTuple):
    """Power that an element loses, or why it loses none."""

    group: str  # `LOAD_DEPENDENT` or `LOAD_INDEPENDENT`.
    watts: float = 0.0  # Never negative. [W]
    method: str = ""  # The model.
    source: str = ""  # Where it is printed.
    left_out: str = ""  # Why there is no such loss; empty if there is.
    # Two bodies each whose relative motion the loss brakes, and its share there. [1]
    brakes: tuple[tuple[str, str, float], ...] = ()
    # Key of the mesh whose power the loss is a share of; empty for friction between bodies.
    mesh: str = ""
    factor: float = 1.0  # The user's factor, which `watts` contain. [1]
    # The thermal nodes that it heats, each with its share. [1]
    heat: tuple[tuple[str, float], ...] = ((OIL, 1.0),)
    # Those of the loads of its element that it depends on; empty: all of them.
    follows: tuple[str, ...] = ()
    # Share of each of its methods in the watts; empty if it has one. [1]
    shares: tuple[tuple[str, float], ...] = ()
    bent: float = BENT  # At most, of what it follows. [1]


class Note(str):
    """A sentence for the user that knows the loss it concerns; nothing if it only informs. [W]

    A note that is a plain text concerns nobody knows how much.
    """

    watts: float

    def __new__(cls, text: str, watts: float = 0.0) -> Note:
        note = super().__new__(cls, text)
        note.watts = watts
        return note


def note_watts(note: str) -> float:
    """The loss that a note concerns; infinite if nobody says. [W]"""
    return getattr(note, "watts", math.inf)


@dataclass(frozen=True, slots=True)
class ElementResult:
    """What an element answers to a state."""

    pointwise = True

    # By the last part of their keys, ``"sun_mesh_sliding"``, ``"friction"``.
    losses: Mapping[str, Loss]
    # Labelled numbers for the user, by what they describe: ``"sun_mesh"``.
    figures: Mapping[str, DataclassInstance] = field(default_factory=dict[str, Any])
    flags: SomeFlags = ()  # Models used outside their ranges.
    notes: tuple[str, ...] | Sought[str] = ()  # What else the user must know.
    # What its parts carry, from which a solution at another temperature goes on.
    loaded: Mapping[Any, Any] = field(default_factory=dict[Any, Any])
    extremes: Mapping[str, Extremes] = field(default_factory=dict[str, Any])  # Of some figures.


class Element(Protocol):
    """Something that loses power."""

    @property
    def key(self) -> str:
        """First part of the keys of its losses; empty for those of a single gear set."""

    @property
    def terms(self) -> tuple[str, ...]:
        """Names of its losses, in the order in which they are shown."""

    @property
    def figure_types(self) -> tuple[tuple[str, type[DataclassInstance]], ...]:
        """Names and types of its figures."""

    @property
    def several(self) -> bool:
        """Whether it takes states of several points at once."""

    def loads(self, state: State, last: ElementResult | None = None) -> Mapping[str, float]:
        """What of a state it depends on beside the speeds: loads in one unit, by their names."""

    def evaluate(self, state: State, last: ElementResult | None = None) -> ElementResult:
        """Losses, figures and flags in a state.

        `last`, its own result at the same speeds and temperatures, saves work.
        """
