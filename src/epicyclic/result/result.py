"""Results: what `solve` returns, with temperatures and supply of oil, and its JSON form."""

from __future__ import annotations

import dataclasses
import json
import math
import platform
from collections.abc import Callable, Container, Iterator, Mapping
from functools import cache, lru_cache, partial
from importlib import metadata
from typing import TYPE_CHECKING, Any, Protocol

from epicyclic.dataclass import dataclass, field
from epicyclic.errors import Status
from epicyclic.losses.ranges import ModelUse, ValidityFlag, describe_flags, flags_with_loss
from epicyclic.machine.element import (
    LOAD_DEPENDENT,
    LOAD_INDEPENDENT,
    OIL,
    Extremes,
    Figure,
    FluidFigures,
    displayed,
    figure,
)
from epicyclic.machine.gear_mesh import MeshFigures
from epicyclic.machine.planets import BearingFigures
from epicyclic.result.codec import plain, stored
from epicyclic.units import CELSIUS, DEGREE, NEWTON_METRE, NUMBER, RPM, WATT, known_text, percent

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


@dataclass(frozen=True, slots=True)
class HeatPath:
    """Heat from one part to another.

    Attributes
    ----------
    key : str
        ``"sun-oil"``.
    hot, into : str
        Where it comes from and goes to.
    watts : float
        Negative if it flows the other way. [W]
    conductance : float
        NaN for a cooler of given power. [W/K]
    method, source : str
        How the conductance is found, and where that is printed.
    """

    key: str
    hot: str = field(metadata=stored(key="from"))
    into: str = field(metadata=stored(key="to"))
    watts: float = field(metadata=stored(key="heat"))
    conductance: float
    method: str
    source: str


@dataclass(frozen=True, slots=True)
class HeatBalance:
    """Temperatures that follow from the losses, and the paths of their heat.

    Attributes
    ----------
    model : str
        ``"flank"`` or ``"network"``.
    temperatures : mapping of str to float
        Temperatures of all nodes. [K]
    sources : mapping of str to float
        Heat that losses bring to each node. [W]
    ways : tuple of HeatPath
        Empty with ``"flank"``.
    given : mapping of str to float
        Temperatures that were given: of the oil inlet, the air, a coolant; of all oil with
        ``"flank"``. [K]
    residual : float
        Largest heat of a node that does not leave it, over all heat or the largest flow. [1]
    evaluations : int
        Evaluations of the losses, until temperatures and losses agreed.
    """

    model: str
    temperatures: Mapping[str, float] = field(metadata=stored(unit=CELSIUS))
    given: Mapping[str, float] = field(metadata=stored(unit=CELSIUS))
    sources: Mapping[str, float]
    ways: tuple[HeatPath, ...] = field(metadata=stored(index="key"))
    residual: float
    evaluations: int

    @property
    def oil(self) -> float:
        """Temperature of the oil. [K]"""
        return {**self.given, **self.temperatures}[OIL]

    @property
    def brought(self) -> dict[str, float]:
        """Heat that losses bring to each node; what has no temperature of its own is oil. [W]"""
        heat = {node: self.sources.get(node, 0.0) for node in (*self.temperatures, OIL)}
        heat[OIL] = sum(self.sources.values()) - sum(heat[node] for node in heat if node != OIL)
        return heat

    @property
    def outlets(self) -> tuple[HeatPath, ...]:
        """The paths that lead out of the gearbox."""
        return tuple(path for path in self.ways if path.into not in self.temperatures)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and text, in the units stated beside them."""
        found: dict[str, Any] = plain(self)
        return found


@dataclass(frozen=True, slots=True)
class OilSupply:
    """The share of oil around the gears of a set, and their churning.

    Attributes
    ----------
    method : str
        ``"dip"``.
    share, low, high : float
        Share of oil by volume, and the ends of its 95 % band. [1]
    grade : str
        ``"given"``, ``"read"`` or ``"estimate"``.
    source : str
    churning : mapping of str to float
        What parts that dip lose after each model; empty if none dips. [W]
    meshes : mapping of str to float
        Share of oil in the pockets of each mesh. [1]
    """

    method: str
    share: float
    low: float
    high: float
    grade: str
    source: str
    churning: Mapping[str, float] = field(default_factory=dict[str, float])
    meshes: Mapping[str, float] = field(default_factory=dict[str, float])

    @property
    def text(self) -> str:
        """In words, for a list of models and how well they are known."""
        if self.grade == "given":
            return f"{self.method}: share of oil {self.share:.2g}, given by {self.source}"
        band = f"95 %: {self.low:.2g} to {self.high:.2g}"
        fed = max(self.meshes.values(), default=0.0) - self.share
        more = f"; up to {fed:.2g} more in the meshes" if fed > 0 else ""
        return f"{self.method}: share of oil {self.share:.2g} ({band}; {self.source}){more}"

    @property
    def comparison(self) -> str:
        """Churning after each model in words; empty if nothing dips."""
        return ", ".join(f"{name} {known_text(watts)}" for name, watts in self.churning.items())

    def to_dict(self) -> dict[str, Any]:
        """As plain numbers and text."""
        return {
            "method": self.method,
            "oil_share": {
                "value": self.share,
                "low": self.low,
                "high": self.high,
                "unit": "1",
                "grade": self.grade,
                "source": self.source,
            },
            "oil_share_in_meshes": plain(self.meshes, NUMBER),
            "churning": plain(self.churning, WATT),
        }


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
    shares : mapping of str to float
        Share of each model in the loss; empty if there is one model only. [1]
    """

    name: str
    watts: float
    group: str
    method: str
    source: str
    factor: float = 1.0
    left_out: str = ""
    shares: Mapping[str, float] = field(default_factory=dict[str, float])


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

    speed: float = field(metadata=stored(unit=RPM))
    torque: float = field(metadata=stored(unit=NEWTON_METRE))

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
class BranchFigures:
    """A planet branch of a single set, the mean of all: one planet with its meshes and bearing."""

    power: float = figure("input power", WATT)
    load_dependent: float = figure("load-dependent loss", WATT)
    load_independent: float = figure("load-independent loss of its meshes and bearing", WATT)


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
    input: str
    output: str
    ratio: float | None
    power_ratio: float | None
    self_locking: bool
    jammed: bool
    rolling: Mapping[str, float] = field(metadata=stored(key="rolling_power"))
    clutches: Mapping[str, float]
    stages: Mapping[str, Mapping[str, float]] = field(metadata=stored(key="stage_torques"))


@cache
def versions() -> dict[str, str]:
    """Versions of this package and of what its numbers depend on."""
    names = ("epicyclic", "numpy", "numba", "pint", "pydantic")
    return {"python": platform.python_version()} | {name: metadata.version(name) for name in names}


class Stated(Protocol):
    """What was solved: a case, of which a result knows only this."""

    def inputs(self) -> Mapping[str, Any]:
        """Its keys, defaults included, as a case file has them."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Result:
    """The losses of one case, their places and the methods used.

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
    extremes : mapping of str to Extremes
        What meshes and bearings are judged by.
    fluid : FluidFigures or None
    models : mapping of str to str
        The models used, defaults resolved.
    standing : mapping of str to str
        The models of friction, rolling loss and planet bearings, and the reliability of each,
        ``"schlenk: fitted to gear tests ..."``, by their keys.
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
    versions : mapping of str to str
        Versions of this package and of what its numbers depend on.
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
    lubrication: Mapping[str, OilSupply] = field(default_factory=dict[str, OilSupply])
    status: Status = Status.CONVERGED
    unloaded: float | None = None
    versions: Mapping[str, str] = field(default_factory=versions)
    extremes: Mapping[str, Extremes] = field(default_factory=dict[str, Extremes])

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
    def groups(self) -> dict[str, str]:
        """The group of every loss."""
        return {term.name: term.group for term in self.terms}

    @property
    def not_included(self) -> dict[str, str]:
        """Why losses are not included, of those that are not."""
        return {term.name: term.left_out for term in self.terms if term.left_out}

    @property
    def methods(self) -> dict[str, str]:
        """How every loss, and the load, is found."""
        own = {term.name: term.method for term in self.terms if not term.left_out}
        return {**own, **self.load_methods}

    @property
    def citations(self) -> dict[str, str]:
        """Where the `methods` are printed."""
        own = {term.name: term.source for term in self.terms if not term.left_out}
        return {**own, **self.load_sources}

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
        return sum(term.watts for term in self.terms)

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
    def load_dependent_efficiency(self) -> float | None:
        """1 less load-dependent loss over input power, eta_LD. Theory (P11). [1]"""
        if self.efficiency is None or not self.input_power:
            return None
        return 1 - self.load_dependent / self.input_power

    @property
    def branch(self) -> BranchFigures | None:
        """A planet branch; None if this is not a single set with planets. Theory (P10)."""
        planets = len(self.planet_shares)
        if self.train is not None or not planets:
            return None
        contacts = (*self.layout.meshes, *self.layout.bearings, "planets_drag")
        spin = sum(
            term.watts
            for term in self.terms
            if term.group == LOAD_INDEPENDENT and term.name.startswith(contacts)
        )
        power, load_dependent = self.input_power / planets, self.load_dependent / planets
        return BranchFigures(power, load_dependent, spin / planets)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Everything the user should know before trusting the numbers."""
        return (*self.notes, *describe_flags(self.flags, self.losses_of(), self.total))

    @property
    def flags_with_loss(self) -> list[tuple[float, list[ValidityFlag]]]:
        """Ranges that models leave, with the loss that each concerns; NaN if unknown. [W]"""
        return flags_with_loss(self.flags, self.losses_of())

    def losses_of(self) -> Callable[[ModelUse], float]:
        """What finds the loss that a model was used for, or of which it is a part; else NaN. [W]"""
        losses = {_same_words(term.name): term.watts for term in self.terms}

        def loss_of(use: ModelUse) -> float:
            last = LOSSES_OF_ROLES.get(use.role, use.role)
            stage, colon, _ = use.where.rpartition(": ")
            # the drag of both gears of a pair, or the loss of a bearing of a train
            found = (_same_words(it) for it in (f"{use.where} {last}", f"{stage}{colon}{last}"))
            return next((losses[place] for place in found if place in losses), math.nan)

        return loss_of

    def numbers(self) -> Iterator[Figure]:
        """Every number of the result with key, label and unit, as sweeps store them.

        The keys are those of every result of this kind; NaN stands where there is no such number.
        """
        values = self.values()
        for it in number_fields(self.layout):
            yield Figure(it.key, it.label, values[it.key], it.unit)

    def values(self, keys: Container[str] | None = None) -> dict[str, float]:
        """The `numbers` alone, or some of them, by their keys."""
        fields = number_fields(self.layout)
        wanted = fields if keys is None else [it for it in fields if it.key in keys]
        return {it.key: it.read(self) + 0.0 for it in wanted}  # no -0.0

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers and text, in W and in the units stated beside them."""
        result: dict[str, Any] = plain(
            {
                "title": self.title,
                "kind": self.kind,
                "status": str(self.status),
                "losses": self.losses,
                "load_dependent": self.load_dependent,
                "load_independent": self.load_independent,
                "total": self.total,
                "input_power": self.input_power,
                "efficiency": self.efficiency,
                "load_dependent_efficiency": self.load_dependent_efficiency,
                "units": dict.fromkeys(_POWERS, WATT.display)
                | {"efficiency": "1", "load_dependent_efficiency": "1"},
                "warnings": self.warnings,
                "not_included": self.not_included,
                "factors": {term.name: term.factor for term in self.terms if term.factor != 1.0},
                "methods": self.methods,
                "groups": self.groups,
                "citations": self.citations,
                "models": self.models,
                "standing": self.standing,
                "validity": self.flags,
                "members": _members_dict(self.flow),
                "meshes": self.meshes,
                "fluid": self.fluid,
                **({} if self.heat is None else {"heat": self.heat}),
                **({"lubrication": self._lubrication()} if self.lubrication else {}),
                **(self._planets() if self.train is None else self._train(self.train)),
                "sources": self.sources,
                "inputs": self.inputs,
                "versions": self.versions,
            }
        )
        return result

    def _lubrication(self) -> dict[str, Any]:
        """Lubrication of a single set itself, of a train by sets."""
        found = {name: supply.to_dict() for name, supply in self.lubrication.items()}
        return found.get("", found)

    def _planets(self) -> dict[str, Any]:
        """What only a single set states."""
        return {
            "planet_bearing": self.bearing,
            "branch": self.branch,
            "planet_angles": plain(self.planet_angles, DEGREE),
            "planet_shares": plain(self.planet_shares, NUMBER),
            "mesh_load_factor": plain(self.mesh_load_factor, NUMBER),
        }

    def _train(self, train: Train) -> dict[str, Any]:
        """What only a train states."""
        own = plain(train)
        flows = {key: own.pop(key) for key in ("rolling_power", "clutches", "stage_torques")}
        return {
            **own,
            "shafts": _members_dict(self.flow),
            **flows,
            "stages": self.stage_losses,
            "kinds": self.kind_losses,
            "bearings": self.bearings,
            "parts": self.parts,
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


def origin(case: Stated) -> dict[str, str]:
    """Attributes of a dataset that tell what made it, from which case."""
    used = versions()
    return {
        "source": f"epicyclic {used['epicyclic']}",
        "versions": json.dumps(used),
        "case": json.dumps(case.inputs()),
    }


def _members_dict(flow: PowerFlow) -> dict[str, Any]:
    return {name: plain(it) | {"power": plain(it.power, WATT)} for name, it in flow.members.items()}


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
    return tuple(NumberField(*field) for field in _number_fields(layout))


def _number_fields(layout: Layout) -> Iterator[tuple[str, str, str, Callable[[Result], float]]]:
    watt = WATT.display
    for place, name in enumerate(layout.losses):
        yield name, in_words(name), watt, partial(lambda own, it: it.terms[own].watts, place)
    yield "load_dependent", "load-dependent loss", watt, lambda it: it.load_dependent
    yield "load_independent", "load-independent loss", watt, lambda it: it.load_independent
    yield "total", "total loss", watt, lambda it: it.total
    yield "input_power", "input power", watt, lambda it: it.input_power
    yield "efficiency", "efficiency", "1", lambda it: _or_nan(it.efficiency)
    label = "load-dependent efficiency"
    yield "load_dependent_efficiency", label, "1", lambda it: _or_nan(it.load_dependent_efficiency)
    if layout.shares:
        yield "mesh_load_factor", "mesh load factor", "1", lambda it: it.mesh_load_factor
    if layout.shares and not layout.rolling:
        yield from _part_fields("branch", BranchFigures, lambda it: it.branch)
    if layout.rolling:
        label = "input speed over output speed"
        yield "ratio", label, "1", partial(_of_train, "ratio")
        label = "sum of the rolling powers over the input power"
        yield "power_ratio", label, "1", partial(_of_train, "power_ratio")
    for name in layout.rolling:
        label = f"{in_words(name)}: rolling power"
        yield f"{name}_rolling_power", label, watt, partial(_rolling, name)
    for name in layout.members:
        label, unit = f"speed of the {name}", RPM.display
        speed = partial(lambda own, it: RPM.to_display(it.flow.members[own].speed), name)
        yield f"{name}_speed", label, unit, speed
        label, unit = f"torque on the {name}", NEWTON_METRE.display
        torque = partial(lambda own, it: it.flow.members[own].torque, name)
        yield f"{name}_torque", label, unit, torque
    for node in layout.nodes:
        label = f"temperature of the {in_words(node)}"
        yield f"{node}_temperature", label, CELSIUS.display, partial(_temperature, node)
    if layout.fluid:
        yield from _part_fields("fluid", FluidFigures, lambda it: it.fluid)
    for name in layout.meshes:
        yield from _part_fields(name, MeshFigures, partial(_part, "meshes", name))
    for name in layout.bearings:
        yield from _part_fields(name, BearingFigures, partial(_part, "bearings", name))
    for name, kind in layout.parts:
        yield from _part_fields(name, kind, partial(_part, "parts", name))


def in_words(name: str) -> str:
    """A key of a train in words: ``"P1: sun mesh"``."""
    return name.replace("_", " ").replace(".", ": ")


@lru_cache(maxsize=1024)
def _same_words(name: str) -> str:
    """A key, or a place as sentences name it: both in the same words, ``"S: a b mesh"``."""
    return in_words(name).replace("-", " ")


def set_of(key: str) -> str:
    """The set to which a mesh, gear or bearing belongs; empty if there is one set only."""
    return key.rpartition(".")[0]


def of_gear(name: str) -> str:
    """What a label says something is of: ``"of the sun"``, but ``"of gear A"``."""
    words = in_words(name)
    return f"of the {words}" if words.endswith(_KINDS_OF_GEARS) else f"of gear {words}"


def _part_fields(
    name: str, kind: type[DataclassInstance], part: Callable[[Result], DataclassInstance | None]
) -> Iterator[tuple[str, str, str, Callable[[Result], float]]]:
    title = name.replace("_", " ").replace(".", ", ")
    for it in dataclasses.fields(kind):
        if "label" in it.metadata:
            label, unit = f"{title}: {it.metadata['label']}", it.metadata["unit"].display or "1"
            yield f"{name}_{it.name}", label, unit, partial(_part_number, part, it)


def _part_number(
    part: Callable[[Result], DataclassInstance | None],
    field: dataclasses.Field[Any],
    result: Result,
) -> float:
    source = part(result)
    return math.nan if source is None else displayed(source, field)


def _of_train(name: str, result: Result) -> float:
    return _or_nan(getattr(result.train, name, None))


def _or_nan(value: float | None) -> float:
    return math.nan if value is None else value


def _rolling(name: str, result: Result) -> float:
    return math.nan if result.train is None else result.train.rolling.get(name, math.nan)


def _temperature(node: str, result: Result) -> float:
    return math.nan if result.heat is None else CELSIUS.to_display(result.heat.temperatures[node])


def _part(group: str, name: str, result: Result) -> DataclassInstance | None:
    found: DataclassInstance | None = getattr(result, group).get(name)
    return found
