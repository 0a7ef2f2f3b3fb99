"""Results: what `solve` returns, and its JSON form."""

from __future__ import annotations

import dataclasses
import json
import math
import platform
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache, partial
from importlib import metadata
from typing import TYPE_CHECKING, Any, Protocol

from epicyclic.errors import Status
from epicyclic.losses.ranges import ModelUse, ValidityFlag, describe_flags, flags_with_loss
from epicyclic.machine.element import (
    LOAD_DEPENDENT,
    LOAD_INDEPENDENT,
    Figure,
    FluidFigures,
    displayed,
    figures,
)
from epicyclic.machine.gear_mesh import MeshFigures
from epicyclic.machine.planets import BearingFigures
from epicyclic.results.heat import HeatBalance
from epicyclic.results.lubrication import OilSupply
from epicyclic.results.views import Views
from epicyclic.units import CELSIUS, DEGREE, NEWTON_METRE, RPM, WATT, known_text, percent

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

LOSSES_OF_ROLES = {
    "friction": "sliding",
    "rolling": "rolling",
    "bearing": "mechanical",
    "bearing_viscous": "viscous",
}
"""Last word of the loss for which a model is chosen by a key."""
_KINDS_OF_GEARS = ("sun", "planet", "ring", "pinion", "gear")
_POWERS = ("losses", "load_dependent", "load_independent", "total", "input_power")


@dataclass(frozen=True, slots=True)
class LossTerm:
    """One component of the loss.

    Attributes
    ----------
    name : str
        Key of the term, ``"sun_mesh_sliding"``.
    watts : float
        Loss of the whole gear set, factor included. [W]
    group : str
        ``"load-dependent"`` or ``"load-independent"``.
    method, source : str
        The model and where it is printed.
    factor : float
        The user's factor. [1]
    left_out : str
        Why the term is not included; empty if it is.
    """

    name: str
    watts: float
    group: str
    method: str
    source: str
    factor: float = 1.0
    left_out: str = ""


@dataclass(frozen=True, slots=True)
class MemberState:
    """One shaft.

    Attributes
    ----------
    speed : float
        [rad/s]
    torque : float
        From outside, losses accounted for. [N m]
    """

    speed: float
    torque: float

    @property
    def power(self) -> float:
        """Power that enters through this shaft. [W]"""
        return self.torque * self.speed


@dataclass(frozen=True, slots=True)
class PowerFlow:
    """Where power enters and leaves.

    Speeds are positive in one common sense of rotation; a torque is the one that acts from outside,
    so that torque times speed is the power that enters through that shaft.

    Attributes
    ----------
    members : mapping of str to MemberState
        The shafts; their powers sum to the loss.
    input_power : float
        Power that enters, at all members where it does. [W]
    efficiency : float or None
        Power that leaves over power that enters; 0 if the loss takes all of it; None if no power
        is passed on. [1]
    """

    members: Mapping[str, MemberState]
    input_power: float
    efficiency: float | None


@dataclass(frozen=True, slots=True)
class Layout:
    """What the results of a case consist of, known before they are."""

    # Keys of the loss terms, shafts, meshes of computed losses, and planet bearings.
    losses: tuple[str, ...]
    members: tuple[str, ...]
    meshes: tuple[str, ...]
    bearings: tuple[str, ...] = ()
    shares: bool = False  # True if there are planets that share a load.
    # Keys of the meshes of a train, whose rolling power is stated; empty for a single set.
    rolling: tuple[str, ...] = ()
    # Keys of further elements with the type of their figures.
    parts: tuple[tuple[str, type[DataclassInstance]], ...] = ()
    fluid: bool = True  # False if nothing is computed that needs an oil.
    nodes: tuple[str, ...] = ()  # Parts whose temperatures follow from the losses.


@dataclass(frozen=True, slots=True)
class Train:
    """What the result of a train states beside that of a single set.

    Attributes
    ----------
    state : str
        The state of brakes and clutches; empty if the train has none.
    ratio : float or None
        Speed of the input over that of the output, signed; None if the output stands still. [1]
    power_ratio : float or None
        Sum of the rolling powers of all meshes over the input power; None without power. [1]
    rolling : mapping of str to float
        Power that each mesh would pass with its carrier at rest. [W]
    clutches : mapping of str to float
        Torque through each closed clutch, ``"input+third"``, from its first to its second shaft.
        [N m]
    stages : mapping of str to mapping of str to float
        Torque that each set and part takes from each shaft and from the housing: times the speed of
        the shaft it is the power that enters there. [N m]
    self_locking : bool
        True if the output must be driven too.
    jammed : bool
        True if not even that helps: the train stands still under its torque.
    input, output : str
        Shafts.
    """

    state: str
    ratio: float | None
    power_ratio: float | None
    rolling: Mapping[str, float]
    clutches: Mapping[str, float]
    stages: Mapping[str, Mapping[str, float]]
    self_locking: bool
    jammed: bool
    input: str
    output: str


class Stated(Protocol):
    """What was solved: a case, of which a result knows only this."""

    def inputs(self) -> Mapping[str, Any]:
        """Its keys, defaults included, as a case file has them."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Result(Views):
    """The losses of one case, where they arise, and how they were found.

    Attributes
    ----------
    title : str
    kind : str
        ``"planetary"``, ``"gear_pair"`` or ``"train"``.
    layout : Layout
        What the result consists of.
    terms : tuple of LossTerm
    flow : PowerFlow
        Speeds, torques, powers, efficiency.
    meshes : mapping of str to MeshFigures
    bearings : mapping of str to BearingFigures
        Bearings of planets, by the first words of their losses.
    parts : mapping of str to dataclass
        Figures of further elements: bearings of shafts, seals.
    fluid : FluidFigures or None
    models : mapping of str to str
        The models used, defaults resolved.
    standing : mapping of str to str
        The models of friction, rolling loss and planet bearings, and how well each is known to be
        right, ``"schlenk: fitted to gear tests ..."``, by their keys.
    flags : tuple of ValidityFlag
        Models used outside their ranges.
    notes : tuple of str
        Other warnings.
    load_methods, load_sources : mapping of str to str
        How the load is found, along the teeth and between planets.
    sources : tuple of str
        Literature of the models used.
    case : PlanetaryCase, GearPairCase or TrainCase
        What was solved.
    planet_angles : tuple of float
        Positions of the planets; empty for a pair. [rad]
    planet_shares : tuple of float
        Share of the torque that each planet carries; their sum is 1. [1]
    train : Train or None
        None for a single set.
    heat : HeatBalance or None
        None if everything is at the temperature of the oil inlet.
    lubrication : mapping of str to OilSupply
        Supply of oil to each set that states it; the key of a single set is empty.
    status : Status
    unloaded : float or None
        Total loss without torque, where losses are grouped as a test rig does; else None. [W]
    """

    title: str
    kind: str
    layout: Layout
    terms: tuple[LossTerm, ...]
    flow: PowerFlow
    meshes: Mapping[str, MeshFigures]
    bearings: Mapping[str, BearingFigures]
    parts: Mapping[str, DataclassInstance]
    fluid: FluidFigures | None
    models: Mapping[str, str]
    standing: Mapping[str, str]
    flags: tuple[ValidityFlag, ...]
    notes: tuple[str, ...]
    load_methods: Mapping[str, str]
    load_sources: Mapping[str, str]
    sources: tuple[str, ...]
    case: Stated
    planet_angles: tuple[float, ...] = ()
    planet_shares: tuple[float, ...] = ()
    train: Train | None = None
    heat: HeatBalance | None = None
    lubrication: Mapping[str, OilSupply] = dataclasses.field(default_factory=dict[str, OilSupply])
    status: Status = Status.CONVERGED
    unloaded: float | None = None

    @property
    def inputs(self) -> Mapping[str, Any]:
        """The case, defaults included, as a case file has it."""
        return self.case.inputs()

    def __repr__(self) -> str:
        title = self.title or in_words(self.kind)
        words = [f"total loss {known_text(self.total)} of {known_text(self.input_power)}"]
        if self.efficiency is not None:
            words.append(f"efficiency {percent(self.efficiency, 3)}")
        words.append(f"{len(self.warnings)} warnings")
        return f"<Result {title!r}: {', '.join(words)}>"

    @property
    def bearing(self) -> BearingFigures | None:
        """The planet bearing of a single set; None if it has none."""
        return self.bearings.get("planet_bearing")

    @property
    def losses(self) -> dict[str, float]:
        """Every loss term. [W]"""
        return {term.name: term.watts for term in self.terms}

    @property
    def load_dependent(self) -> float:
        """Sum of the load-dependent terms, P_LD. Theory (P1). [W]

        As tested: what torque adds to the total. Theory (P9).
        """
        return self._sum(LOAD_DEPENDENT) if self.unloaded is None else self.total - self.unloaded

    @property
    def load_independent(self) -> float:
        """Sum of the load-independent terms, P_LI. Theory (P2). [W]

        As tested: the total without torque.
        """
        return self._sum(LOAD_INDEPENDENT) if self.unloaded is None else self.unloaded

    @property
    def total(self) -> float:
        """Total loss. Theory (P3). [W]"""
        return self._sum(LOAD_DEPENDENT) + self._sum(LOAD_INDEPENDENT)

    def _sum(self, group: str) -> float:
        return sum(term.watts for term in self.terms if term.group == group)

    @property
    def mesh_load_factor(self) -> float:
        """Load of the most loaded planet over the mean, K_gamma; 1 for a pair. Theory (S1). [1]"""
        return max(self.planet_shares, default=1.0) * max(1, len(self.planet_shares))

    @property
    def input_power(self) -> float:
        """Power that enters the gear set. [W]"""
        return self.flow.input_power

    @property
    def efficiency(self) -> float | None:
        """Power out over power in; None if no power is passed on. [1]"""
        return self.flow.efficiency

    @property
    def warnings(self) -> tuple[str, ...]:
        """Everything the user should know before trusting the numbers."""
        return (*self.notes, *describe_flags(self.flags, self._losses_of(), self.total))

    @property
    def flags_with_loss(self) -> list[tuple[float, list[ValidityFlag]]]:
        """Ranges that models leave, with the loss that each concerns; NaN if unknown. [W]"""
        return flags_with_loss(self.flags, self._losses_of())

    def _losses_of(self) -> Callable[[ModelUse], float]:
        """What finds the loss that a model was used for, or of which it is a part; else NaN. [W]"""
        losses = {in_words(term.name): term.watts for term in self.terms}

        def loss_of(use: ModelUse) -> float:
            last = LOSSES_OF_ROLES.get(use.role, use.role)
            stage, colon, _ = use.where.rpartition(": ")
            whole = f"{stage}{colon}{last}"  # the drag of both gears of a pair
            return losses.get(f"{use.where} {last}", losses.get(whole, math.nan))

        return loss_of

    def numbers(self) -> Iterator[Figure]:
        """Every number of the result with key, label and unit, as sweeps store them.

        The keys are those of every result of this kind; NaN stands where there is no such number.
        """
        values = self.values()
        for field in number_fields(self.layout):
            yield Figure(field.key, field.label, values[field.key], field.unit)

    def values(self) -> dict[str, float]:
        """The `numbers` alone, by their keys."""
        return {
            field.key: field.read(self) + 0.0  # no -0.0
            for field in number_fields(self.layout)
        }

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers and text, in W and in the units stated beside them."""
        result: dict[str, Any] = {
            "title": self.title,
            "kind": self.kind,
            "status": str(self.status),
            "losses": self.losses,
            "load_dependent": self.load_dependent,
            "load_independent": self.load_independent,
            "total": self.total,
            "input_power": self.input_power,
            "efficiency": self.efficiency,
            "units": dict.fromkeys(_POWERS, WATT.display) | {"efficiency": "1"},
            "warnings": list(self.warnings),
            "not_included": {term.name: term.left_out for term in self.terms if term.left_out},
            "factors": {term.name: term.factor for term in self.terms if term.factor != 1.0},
            "methods": {
                **{term.name: term.method for term in self.terms if not term.left_out},
                **self.load_methods,
            },
            "groups": {term.name: term.group for term in self.terms},
            "citations": {
                **{term.name: term.source for term in self.terms if not term.left_out},
                **self.load_sources,
            },
            "models": dict(self.models),
            "standing": dict(self.standing),
            "validity": [dataclasses.asdict(flag) for flag in self.flags],
            "members": _members_dict(self.flow),
            "meshes": {name: _figures_dict(mesh) for name, mesh in self.meshes.items()},
            "fluid": None if self.fluid is None else _figures_dict(self.fluid),
            **({} if self.heat is None else {"heat": self.heat.to_dict()}),
            **({"lubrication": self._lubrication()} if self.lubrication else {}),
            **(self._planets() if self.train is None else self._train(self.train)),
            "sources": list(self.sources),
            "inputs": dict(self.inputs),
            "versions": versions(),
        }
        clean: dict[str, Any] = _json_value(result)
        return clean

    def _lubrication(self) -> dict[str, Any]:
        """Lubrication of a single set itself, of a train by sets."""
        found = {name: supply.to_dict() for name, supply in self.lubrication.items()}
        return found.get("", found)

    def _planets(self) -> dict[str, Any]:
        """What only a single set states."""
        return {
            "planet_bearing": None if self.bearing is None else _figures_dict(self.bearing),
            "planet_angles": {
                "value": [DEGREE.to_display(angle) for angle in self.planet_angles],
                "unit": "deg",
            },
            "planet_shares": {"value": list(self.planet_shares), "unit": "1"},
            "mesh_load_factor": {"value": self.mesh_load_factor, "unit": "1"},
        }

    def _train(self, train: Train) -> dict[str, Any]:
        """What only a train states."""
        return {
            "state": train.state,
            "input": train.input,
            "output": train.output,
            "ratio": train.ratio,
            "power_ratio": train.power_ratio,
            "self_locking": train.self_locking,
            "jammed": train.jammed,
            "shafts": _members_dict(self.flow),
            "rolling_power": dict(train.rolling),
            "clutches": dict(train.clutches),
            "stage_torques": {name: dict(taken) for name, taken in train.stages.items()},
            "stages": self.stage_losses,
            "kinds": self.kind_losses,
            "bearings": {name: _figures_dict(item) for name, item in self.bearings.items()},
            "parts": {name: _figures_dict(item) for name, item in self.parts.items()},
        }

    @property
    def stage_losses(self) -> dict[str, float]:
        """Losses of a train summed by set or part. [W]"""
        return self._summed(lambda name: name.partition(".")[0])

    @property
    def kind_losses(self) -> dict[str, float]:
        """Losses of a train summed by kind, ``"sun_mesh_sliding"``. [W]"""
        return self._summed(lambda name: name.partition(".")[2] or name)

    def _summed(self, group: Callable[[str], str]) -> dict[str, float]:
        sums: dict[str, float] = {}
        for term in self.terms:
            sums[group(term.name)] = sums.get(group(term.name), 0.0) + term.watts
        return sums

    def to_json(self) -> str:
        """`to_dict` as indented JSON text."""
        return json.dumps(self.to_dict(), indent=2, allow_nan=False, ensure_ascii=False)


def versions() -> dict[str, str]:
    """Versions of this package and of what its numbers depend on."""
    names = ("epicyclic", "numpy", "numba", "pint", "pydantic")
    return {"python": platform.python_version()} | {name: metadata.version(name) for name in names}


def origin(case: Stated) -> dict[str, str]:
    """Attributes of a dataset that tell what made it, from which case."""
    used = versions()
    return {
        "source": f"epicyclic {used['epicyclic']}",
        "versions": json.dumps(used),
        "case": json.dumps(case.inputs()),
    }


def _members_dict(flow: PowerFlow) -> dict[str, Any]:
    return {
        name: {
            "speed": {"value": RPM.to_display(member.speed), "unit": "rpm"},
            "torque": {"value": member.torque, "unit": "N*m"},
            "power": {"value": member.power, "unit": "W"},
        }
        for name, member in flow.members.items()
    }


def _figures_dict(source: DataclassInstance) -> dict[str, Any]:
    return {item.key: {"value": item.value, "unit": item.unit} for item in figures(source)}


def _json_value(value: Any) -> Any:
    """`value` with None for every NaN, which JSON does not know, and 0.0 for every -0.0."""
    if isinstance(value, dict):
        return {key: _json_value(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_json_value(item) for item in value]
    if isinstance(value, float):
        return None if math.isnan(value) else value + 0.0
    return value


# --- the numbers of every result of a kind --------------------------------------------------------


@dataclass(frozen=True, slots=True)
class NumberField:
    """One number that every result of a kind has."""

    key: str  # As in `Figure`.
    label: str  # As in `Figure`.
    unit: str  # As in `Figure`.
    read: Callable[[Result], float]  # Takes it from a result; NaN where there is none.


@lru_cache(maxsize=16)
def number_fields(layout: Layout) -> tuple[NumberField, ...]:
    """The numbers that every result of a layout has."""
    watt = WATT.display
    fields = [
        NumberField(name, in_words(name), watt, partial(_loss, name)) for name in layout.losses
    ]
    fields += [
        NumberField("load_dependent", "load-dependent loss", watt, lambda it: it.load_dependent),
        NumberField(
            "load_independent", "load-independent loss", watt, lambda it: it.load_independent
        ),
        NumberField("total", "total loss", watt, lambda it: it.total),
        NumberField("input_power", "input power", watt, lambda it: it.input_power),
        NumberField("efficiency", "efficiency", "1", lambda it: _or_nan(it.efficiency)),
    ]
    if layout.shares:
        fields.append(
            NumberField("mesh_load_factor", "mesh load factor", "1", lambda it: it.mesh_load_factor)
        )
    if layout.rolling:
        fields += _train_fields(layout)
    for name in layout.members:
        fields += [
            NumberField(
                f"{name}_speed", f"speed of the {name}", RPM.display, partial(_speed, name)
            ),
            NumberField(
                f"{name}_torque",
                f"torque on the {name}",
                NEWTON_METRE.display,
                partial(_torque, name),
            ),
        ]
    fields += [
        NumberField(
            f"{node}_temperature",
            f"temperature of the {in_words(node)}",
            CELSIUS.display,
            partial(_temperature, node),
        )
        for node in layout.nodes
    ]
    if layout.fluid:
        fields += _part_fields("fluid", FluidFigures, lambda it: it.fluid)
    for name in layout.meshes:
        fields += _part_fields(name, MeshFigures, partial(_mesh, name))
    for name in layout.bearings:
        fields += _part_fields(name, BearingFigures, partial(_bearing, name))
    for name, kind in layout.parts:
        fields += _part_fields(name, kind, partial(_part, name))
    return tuple(fields)


def _train_fields(layout: Layout) -> Iterator[NumberField]:
    yield NumberField("ratio", "speed of the input over that of the output", "1", _ratio)
    yield NumberField(
        "power_ratio", "sum of the rolling powers over the input power", "1", _power_ratio
    )
    for name in layout.rolling:
        yield NumberField(
            f"{name}_rolling_power",
            f"{in_words(name)}: rolling power",
            WATT.display,
            partial(_rolling, name),
        )


def in_words(name: str) -> str:
    """A key of a train in words: ``"P1: sun mesh"``."""
    return name.replace("_", " ").replace(".", ": ")


def of_gear(name: str) -> str:
    """What a label says something is of: ``"of the sun"``, but ``"of gear A"``."""
    words = in_words(name)
    return f"of the {words}" if words.endswith(_KINDS_OF_GEARS) else f"of gear {words}"


def _part_fields(
    name: str,
    kind: type[DataclassInstance],
    part: Callable[[Result], DataclassInstance | None],
) -> Iterator[NumberField]:
    for field in dataclasses.fields(kind):
        if "label" in field.metadata:
            yield NumberField(
                f"{name}_{field.name}",
                f"{name.replace('_', ' ').replace('.', ', ')}: {field.metadata['label']}",
                field.metadata["unit"].display or "1",
                partial(_part_number, part, field),
            )


def _part_number(
    part: Callable[[Result], DataclassInstance | None],
    field: dataclasses.Field[Any],
    result: Result,
) -> float:
    source = part(result)
    return math.nan if source is None else displayed(source, field)


def _loss(name: str, result: Result) -> float:
    return result.losses[name]


def _or_nan(value: float | None) -> float:
    return math.nan if value is None else value


def _ratio(result: Result) -> float:
    return math.nan if result.train is None else _or_nan(result.train.ratio)


def _power_ratio(result: Result) -> float:
    return math.nan if result.train is None else _or_nan(result.train.power_ratio)


def _rolling(name: str, result: Result) -> float:
    return math.nan if result.train is None else result.train.rolling.get(name, math.nan)


def _speed(name: str, result: Result) -> float:
    return RPM.to_display(result.flow.members[name].speed)


def _torque(name: str, result: Result) -> float:
    return result.flow.members[name].torque


def _temperature(node: str, result: Result) -> float:
    if result.heat is None:
        return math.nan
    return CELSIUS.to_display(result.heat.temperatures[node])


def _mesh(name: str, result: Result) -> MeshFigures | None:
    return result.meshes.get(name)


def _bearing(name: str, result: Result) -> BearingFigures | None:
    return result.bearings.get(name)


def _part(name: str, result: Result) -> DataclassInstance | None:
    return result.parts.get(name)
