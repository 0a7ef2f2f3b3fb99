"""What an element of a gearbox sees, and what it answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from epicyclic.elements.fluids import Fluids
from epicyclic.losses.shaft_bearing import BearingLoad
from epicyclic.losses.validity import SomeFlags

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

LOAD_DEPENDENT = "load-dependent"
LOAD_INDEPENDENT = "load-independent"
HOUSING = "housing"
"""The body that stands still."""
OIL = "oil"
"""The thermal node of the oil around the gears."""


def joined_key(element: str, name: str) -> str:
    """Key of a part of an element: the element's own before it, if it has one."""
    return f"{element}.{name}" if element else name


@dataclass(frozen=True, slots=True)
class State:
    """What an element sees of the machine."""

    # Speeds of every body, positive in one common sense; that of `HOUSING` is 0. [rad/s]
    speeds: Mapping[str, float]
    # That each mesh takes up at its first gear, by the key of the mesh; all its planets together.
    # Torque times speed of that gear against the carrier is the rolling power. [N m]
    torques: Mapping[str, float]
    forces: Mapping[str, BearingLoad]  # On each bearing of a shaft, by the key of its element.
    fluids: Fluids  # Oil and mixture with air. A machine without elements may do without.
    lossless: bool = False  # True if no loss has been taken from the torques yet.
    # For each mesh, True if its first gear drives it; where losses turn a small load round, not
    # before they are found.
    drives: Mapping[str, bool] = field(default_factory=dict[str, bool])
    # What each element has found out about itself from the speeds alone, by its key.
    idle: Mapping[str, Any] = field(default_factory=dict[str, Any])


class Loss(NamedTuple):
    """Power that an element loses, or why it loses none."""

    group: str  # `LOAD_DEPENDENT` or `LOAD_INDEPENDENT`.
    watts: float = 0.0  # Never negative. [W]
    method: str = ""  # The model and where it is printed.
    source: str = ""  # The model and where it is printed.
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


@dataclass(frozen=True, slots=True)
class ElementResult:
    """What an element answers to a state."""

    # By the last part of their keys, ``"sun_mesh_sliding"``, ``"friction"``.
    losses: Mapping[str, Loss]
    # Labelled numbers for the user, by what they describe: ``"sun_mesh"``.
    figures: Mapping[str, DataclassInstance] = field(default_factory=dict[str, Any])
    flags: SomeFlags = ()  # Models used outside their ranges.
    notes: tuple[str, ...] = ()  # What else the user must know.


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

    def idle(self, state: State) -> object:
        """What follows from the speeds alone; `State.idle` has it from then on."""

    def loads(self, state: State) -> Mapping[str, float]:
        """What of a state it depends on beside the speeds: loads in one unit, by their names."""

    def evaluate(self, state: State) -> ElementResult:
        """Losses, figures and flags in a state."""
