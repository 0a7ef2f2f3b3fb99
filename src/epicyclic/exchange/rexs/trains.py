"""Several stages of a REXS file as one train: its sets, its shafts, its clutches and brakes."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from epicyclic.elements.base import HOUSING
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.exchange.rexs.model import Component, Model
from epicyclic.exchange.rexs.sets import (
    Joint,
    Mesh,
    Pair,
    PlanetarySet,
    gear_sets,
    is_rigid,
    is_switched,
    joints,
    read_stage,
    rigid_links,
)

MOST_STAGES, MOST_BEARINGS = 40, 400
"""A file with more than this is not a gear unit."""

_LONGEST_NAME = 32


@dataclass(frozen=True, slots=True)
class Shaft:
    """What turns together, always."""

    # Name of the shaft in the case; if the file has none there, the name of its first member.
    name: str
    parts: Mapping[int, Component]  # Shafts, gears, loads.
    members: tuple[str, ...]  # Members of sets, ``"S1.sun"``.
    held: Component | None  # What joins it to the casing.

    @property
    def components(self) -> tuple[Component, ...]:
        """The shafts of the file."""
        return tuple(part for part in self.parts.values() if part.type == "shaft")

    @property
    def loads(self) -> tuple[Component, ...]:
        """Loads from outside."""
        return tuple(part for part in self.parts.values() if part.type == "external_load")

    @property
    def is_listed(self) -> bool:
        """False for a member alone, of which the file has no shaft: the case does not name it."""
        return bool(self.components) or len(self.members) > 1 or self.held is not None


@dataclass(frozen=True, slots=True)
class Switch:
    """A clutch or brake; a brake joins a shaft to the housing."""

    component: Component
    shafts: tuple[str, str]


@dataclass(frozen=True, slots=True)
class Train:
    """The stages of a file and the shafts between them.

    Attributes
    ----------
    unit : Component
        The gear unit, or the first stage if the file has none.
    sets : dict of str to PlanetarySet or Pair
        By their names in the case.
    shafts : dict of str to Shaft
        By their names.
    switches : tuple of Switch
    bearings : dict of str to Joint
        All but those of planets, by their names in the case.
    """

    unit: Component
    sets: dict[str, PlanetarySet | Pair]
    shafts: dict[str, Shaft]
    switches: tuple[Switch, ...]
    bearings: dict[str, Joint]

    @property
    def meshes(self) -> tuple[Mesh, ...]:
        """Every mesh."""
        return tuple(mesh for one in self.sets.values() for mesh in one.meshes)

    def __str__(self) -> str:
        return f"{self.unit}, {len(self.sets)} stages"

    def shaft_of(self, part: int) -> Shaft | None:
        """The shaft with which a part turns; None if it turns with no gear of a set."""
        return next((shaft for shaft in self.shafts.values() if part in shaft.parts), None)

    def pieces(self) -> list[list[str]]:
        """Names of sets that shafts or clutches join; one list if all hang together."""
        bodies = [{name.partition(".")[0] for name in one.members} for one in self.shafts.values()]
        for switch in self.switches:
            owners = [self.shafts[name].members for name in switch.shafts if name != HOUSING]
            if len(owners) == 2:
                bodies.append({name.partition(".")[0] for own in owners for name in own})
        pieces: list[set[str]] = [{name} for name in self.sets]
        for body in bodies:
            touched = [piece for piece in pieces if piece & body]
            pieces = [piece for piece in pieces if not piece & body]
            if touched:
                pieces.append(set().union(*touched))
        return [[name for name in self.sets if name in piece] for piece in pieces]


def chosen_train(model: Model) -> Train | None:
    """The train of a file with several stages; None for a file with fewer.

    Raises
    ------
    InputError
        If there are too many, or if one is of a kind that is not covered.
    """
    kinds = ("planetary_stage", "cylindrical_stage")
    if len(model.of_type(kinds[0])) > MOST_STAGES:
        raise _too_many(f"{len(model.of_type(kinds[0]))} stages", MOST_STAGES)
    stages = gear_sets(model)
    if len(stages) < 2:
        return None
    if len(stages) > MOST_STAGES:
        raise _too_many(f"{len(stages)} stages", MOST_STAGES)
    order = list(model.components)
    names = Names()
    sets: dict[str, PlanetarySet | Pair] = {}
    problems: list[Problem] = []
    for stage in sorted(stages, key=lambda stage: order.index(stage.id)):
        try:
            sets[names.of(stage, "stage")] = read_stage(model, stage)
        except InputError as error:
            problems += error.problems
    raise_any(problems)
    units = model.of_type("gear_unit")
    shafts = _shafts(model, sets, names)
    by_part = {part: name for name, shaft in shafts.items() for part in shaft.parts}
    switches = tuple(_switches(model, by_part))
    borne = list(_bearings(model, sets))
    if len(borne) > MOST_BEARINGS:
        raise _too_many(f"{len(borne)} bearings", MOST_BEARINGS)
    bearings = {names.of(joint.component, "bearing"): joint for joint in borne}
    return Train(units[0] if units else stages[0], sets, shafts, switches, bearings)


def _too_many(found: str, most: int) -> InputError:
    allowed = f"has {found}; up to {most} are read as one train."
    remedy = "Import one stage with --component, or export fewer."
    return InputError([Problem("", "", f"the file {allowed}", remedy)])


class Names:
    """Names in the case for components of the file: short, safe, each once."""

    def __init__(self) -> None:
        self._taken = {HOUSING}

    def of(self, component: Component, kind: str) -> str:
        """A name from that of a component, or from its `kind` and number."""
        plain = unicodedata.normalize("NFKD", component.name[:200]).replace("ß", "ss")
        text = re.sub(r"[^A-Za-z0-9]+", "_", plain.encode("ascii", "ignore").decode())
        text = text.strip("_")[:_LONGEST_NAME].strip("_")
        if not text or text[0].isdigit():
            text = f"{kind}_{text or component.id}"
        return self.free(text, component.id)

    def free(self, text: str, number: int) -> str:
        """`text`, with a number if another part has this name."""
        while text.lower() in self._taken:
            text = f"{text}_{number}"
        self._taken.add(text.lower())
        return text


def _shafts(
    model: Model, sets: Mapping[str, PlanetarySet | Pair], names: Names
) -> dict[str, Shaft]:
    """The shafts of all sets, in the order of the sets."""
    owned = {
        f"{name}.{member}": parts for name, one in sets.items() for member, parts in _members(one)
    }
    bodies = _bodies(model, owned.values())
    members: dict[int, list[str]] = {}
    for number, (member, parts) in enumerate(owned.items()):
        body = bodies[parts[0].id] if parts else -1 - number
        members.setdefault(body, []).append(member)
    held = _held(model, bodies)
    found: dict[str, Shaft] = {}
    for body, joined in members.items():
        turning = {part: model.components[part] for part, root in bodies.items() if root == body}
        shaft = Shaft(joined[0], turning, tuple(joined), held.get(body))
        if shaft.is_listed:
            own = shaft.components
            named = names.of(own[0], "shaft") if own else names.free("shaft", abs(body))
            shaft = replace(shaft, name=named)
        found[shaft.name] = shaft
    return found


def _members(one: PlanetarySet | Pair) -> Iterator[tuple[str, list[Component]]]:
    """The members of a set, each with parts that turn with it."""
    if isinstance(one, Pair):
        yield "pinion", [one.pinion]
        yield "gear", [one.gear]
    else:
        yield "sun", [one.sun, *one.shafts["sun"]]
        yield "carrier", list(one.shafts["carrier"])
        yield "ring", [one.ring, *one.shafts["ring"]]


def _bodies(model: Model, joined: Iterable[list[Component]]) -> dict[int, int]:
    """For each part that turns with others, which body it belongs to, by one of its parts."""
    own = [(parts[0].id, part.id) for parts in joined for part in parts]
    others = [
        pair
        for pair in rigid_links(model, switched=False)
        if all(model.components[part].type != "gear_casing" for part in pair)
    ]
    neighbours: dict[int, list[int]] = {}
    for one, two in (*own, *others):
        neighbours.setdefault(one, []).append(two)
        neighbours.setdefault(two, []).append(one)
    bodies: dict[int, int] = {}
    for start in neighbours:
        waiting = [start]
        while waiting:
            part = waiting.pop()
            if part not in bodies:
                bodies[part] = start
                waiting += neighbours[part]
    return bodies


def _held(model: Model, bodies: Mapping[int, int]) -> dict[int, Component]:
    """Bodies that something joins to the casing, and what does."""
    held: dict[int, Component] = {}
    for joint in joints(model):
        sides = {side: model.components[side].type for side in (joint.inner, joint.outer)}
        if "gear_casing" in sides.values() and is_rigid(
            model, [joint.component.id], switched=False
        ):
            for side, kind in sides.items():
                if kind != "gear_casing" and side in bodies:
                    held.setdefault(bodies[side], joint.component)
    return held


def _bearings(model: Model, sets: Mapping[str, PlanetarySet | Pair]) -> Iterator[Joint]:
    """The bearings of the file but for those of planets, each once."""
    planetary = [one for one in sets.values() if isinstance(one, PlanetarySet)]
    planets = {part.id for one in planetary for part in (*one.planets, *one.shafts["planet"])}
    seen: set[int] = set()
    for joint in joints(model):
        number = joint.component.id
        is_bearing = "bearing" in joint.component.type
        if is_bearing and number not in seen and not planets & {joint.inner, joint.outer}:
            seen.add(number)
            yield joint


def _switches(model: Model, by_part: Mapping[int, str]) -> Iterator[Switch]:
    """Clutches and brakes between shafts of the train."""
    for joint in joints(model):
        if not is_switched(joint.component):
            continue
        ends = [
            HOUSING if model.components[side].type == "gear_casing" else by_part.get(side)
            for side in (joint.inner, joint.outer)
        ]
        one, two = ends
        if one is not None and two is not None and one != two:
            yield Switch(joint.component, (one, two))
