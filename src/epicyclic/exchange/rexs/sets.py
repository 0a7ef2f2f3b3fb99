"""Which gear sets a REXS file holds, and the components that each consists of."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from epicyclic.errors import InputError, Problem
from epicyclic.exchange.rexs.model import Component, Model
from epicyclic.exchange.rexs.vocabulary import types_of

GEARS = ("cylindrical_gear", "ring_gear")

_RIGID = (
    *types_of("coupling"),
    "switchable_coupling",
    "cylindrical_interference_fit",
    "tapered_interference_fit",
    "feather_key_connection",
    "involute_spline_connection",
)
"""Components that make two parts turn as one."""


@dataclass(frozen=True, slots=True)
class Mesh:
    """A stage and its two gears."""

    stage: Component
    gears: tuple[Component, Component]

    def mate(self, gear: Component) -> Component:
        """The other gear."""
        return self.gears[1] if self.gears[0].id == gear.id else self.gears[0]


@dataclass(frozen=True, slots=True)
class Pair:
    """Two gears that mesh; the pinion is the smaller one, and the external one of two."""

    mesh: Mesh
    pinion: Component
    gear: Component

    @property
    def component(self) -> Component:
        """The component that stands for the whole."""
        return self.mesh.stage

    @property
    def meshes(self) -> tuple[Mesh, ...]:
        """Every mesh."""
        return (self.mesh,)


@dataclass(frozen=True, slots=True)
class PlanetarySet:
    """One sun, planets that are all alike, one ring."""

    component: Component  # The planetary stage.
    sun: Component
    ring: Component
    planets: tuple[Component, ...]
    sun_meshes: tuple[Mesh, ...]  # One for each planet.
    ring_meshes: tuple[Mesh, ...]  # One for each planet.
    shafts: dict[str, tuple[Component, ...]]  # Shafts of sun, ring, carrier, planet and pin.

    @property
    def meshes(self) -> tuple[Mesh, ...]:
        """Every mesh."""
        return (*self.sun_meshes, *self.ring_meshes)


def is_internal(gear: Component) -> bool:
    """True for a ring gear, by its type or by a negative number of teeth."""
    teeth = gear.get("number_of_teeth")
    return gear.type == "ring_gear" or (teeth is not None and str(teeth.value).startswith("-"))


def gear_sets(model: Model) -> list[Component]:
    """Planetary stages, and cylindrical stages outside of them."""
    planetary = model.of_type("planetary_stage")
    inside = {mesh.stage.id for stage in planetary for mesh in _planet_meshes(model, stage)}
    inside |= {
        part.id
        for stage in planetary
        for part in model.partners(stage.id, "assembly", "assembly", "part", "cylindrical_stage")
    }
    cylindrical = model.of_type("cylindrical_stage")
    return [*planetary, *(stage for stage in cylindrical if stage.id not in inside)]


def choose(model: Model, component: int | None) -> PlanetarySet | Pair:
    """The gear set of a component, or the only one.

    Raises
    ------
    InputError
        If there is none, if there are several to choose from, or if it is of a kind that is not
        covered.
    """
    if component is not None:
        chosen = model.components.get(component)
        if chosen is None or chosen.type not in ("planetary_stage", "cylindrical_stage"):
            allowed = "is neither a planetary_stage nor a cylindrical_stage of the file."
            raise InputError([Problem("--component", str(component), allowed, _remedy(model))])
    else:
        sets = gear_sets(model)
        if len(sets) != 1:
            allowed = f"the file has {len(sets) or 'no'} stages to choose from."
            raise InputError([Problem("--component", "", allowed, _remedy(model))])
        chosen = sets[0]
    return read_stage(model, chosen)


def read_stage(model: Model, stage: Component) -> PlanetarySet | Pair:
    """The gear set of a stage; InputError if it is of a kind that is not covered."""
    return _planetary_set(model, stage) if stage.type == "planetary_stage" else _pair(model, stage)


def _remedy(model: Model) -> str:
    stages = [*model.of_type("planetary_stage"), *model.of_type("cylindrical_stage")]
    if not stages:
        return "Cylindrical gears and planetary stages can be read."
    shown = "; ".join(map(str, stages[:12])) + ("; ..." if len(stages) > 12 else "")
    return f"Import one by its id: {shown}."


def _meshes(model: Model) -> Iterator[Mesh]:
    for relation in model.relations:
        if relation.type == "stage":
            by_role = {role: model.components[number] for role, number in relation.refs}
            gears = [by_role[name] for name in ("gear_1", "gear_2") if name in by_role]
            if len(gears) == 2 and "stage" in by_role:
                yield Mesh(by_role["stage"], (gears[0], gears[1]))


def gears_on(model: Model, shafts: Iterable[Component]) -> list[Component]:
    """The gears that turn with shafts."""
    return [part for part in rigid_parts(model, shafts) if part.type in GEARS]


def _planet_meshes(model: Model, stage: Component) -> list[Mesh]:
    shafts = model.partners(stage.id, "planet_shaft", "planetary_stage", "shaft")
    planets = {gear.id for gear in gears_on(model, shafts)}
    return [mesh for mesh in _meshes(model) if any(gear.id in planets for gear in mesh.gears)]


def _planetary_set(model: Model, stage: Component) -> PlanetarySet:
    shafts = {
        "planet": model.partners(stage.id, "planet_shaft", "planetary_stage", "shaft"),
        "pin": model.partners(stage.id, "planet_pin", "planetary_stage", "shaft"),
        "carrier": model.partners(stage.id, "planet_carrier_shaft", "planetary_stage", "shaft"),
    }
    central = model.partners(stage.id, "central_shaft", "planetary_stage", "shaft")
    planets = {gear.id: gear for gear in gears_on(model, shafts["planet"])}
    meshes = _planet_meshes(model, stage)
    suns: dict[int, Component] = {}
    rings: dict[int, Component] = {}
    between = False
    for mesh in meshes:
        mates = [gear for gear in mesh.gears if gear.id not in planets]
        between |= not mates
        for mate in mates:
            (rings if is_internal(mate) else suns)[mate.id] = mate
    counts = (len(suns), len(rings), len(planets), len(meshes))
    if between or counts[:2] != (1, 1) or not planets or counts[3] != 2 * counts[2]:
        found = f"{counts[0]} suns, {counts[2]} planets, {counts[1]} rings and {counts[3]} meshes"
        if between:
            found += ", planets that mesh with each other"
        raise InputError(
            [
                Problem(
                    str(stage),
                    "",
                    f"has {found}.",
                    "One sun, one ring and planets that mesh with both can be read.",
                )
            ]
        )
    (sun,), (ring,) = suns.values(), rings.values()
    for name, gear in (("sun", sun), ("ring", ring)):
        own = [shaft for shaft in central if gear.id in {g.id for g in gears_on(model, [shaft])}]
        shafts[name] = own or model.partners(gear.id, "assembly", "part", "assembly", "shaft")
    return PlanetarySet(
        stage,
        sun,
        ring,
        tuple(planets.values()),
        tuple(mesh for mesh in meshes if sun.id in (gear.id for gear in mesh.gears)),
        tuple(mesh for mesh in meshes if ring.id in (gear.id for gear in mesh.gears)),
        {name: tuple(found) for name, found in shafts.items()},
    )


def _pair(model: Model, stage: Component) -> Pair:
    meshes = [mesh for mesh in _meshes(model) if mesh.stage.id == stage.id]
    if len(meshes) != 1:
        allowed = f"has {len(meshes)} relations of type stage with two gears."
        raise InputError([Problem(str(stage), "", allowed, "Correct the file.")])

    def size(gear: Component) -> tuple[bool, float]:
        teeth = gear.get("number_of_teeth")
        try:
            return is_internal(gear), 0.0 if teeth is None else abs(teeth.number())
        except ValueError:  # told when the number of teeth is read
            return is_internal(gear), 0.0

    pinion, gear = sorted(meshes[0].gears, key=size)
    return Pair(meshes[0], pinion, gear)


def rigid_parts(model: Model, start: Iterable[Component]) -> list[Component]:
    """`start` and all that turns with it: parts on shafts and parts coupled to them."""
    found = {component.id: component for component in start}
    waiting = list(found)
    neighbours = _rigid_neighbours(model)
    while waiting:
        for other in neighbours.get(waiting.pop(0), ()):
            component = model.components[other]
            if other not in found and component.type != "gear_casing":
                found[other] = component
                waiting.append(other)
    return list(found.values())


def _rigid_neighbours(model: Model) -> dict[int, list[int]]:
    neighbours: dict[int, list[int]] = {}
    for first, second in rigid_links(model):
        neighbours.setdefault(first, []).append(second)
        neighbours.setdefault(second, []).append(first)
    return neighbours


def rigid_links(model: Model, *, switched: bool = True) -> Iterator[tuple[int, int]]:
    """Parts that turn as one, two by two; without clutches that are `switched` if that is False."""
    owners = ("shaft", "planet_carrier")
    for relation in model.relations:
        sides: Sequence[int] = ()
        if relation.type == "assembly":
            sides = [*relation.partners("assembly"), *relation.partners("part")]
            if model.components[sides[0]].type not in owners if sides else True:
                sides = ()
        elif relation.type == "side" and is_rigid(
            model, relation.partners("assembly"), switched=switched
        ):
            sides = [*relation.partners("inner_part"), *relation.partners("outer_part")]
        if len(sides) == 2:
            yield sides[0], sides[1]


class Joint(NamedTuple):
    """A coupling, a bearing or the like, and the parts at its two sides."""

    component: Component
    inner: int
    outer: int


def joints(model: Model) -> Iterator[Joint]:
    """Everything that stands between two parts."""
    for relation in model.relations:
        if relation.type == "side":
            roles = (relation.partners(role) for role in ("assembly", "inner_part", "outer_part"))
            joint, inner, outer = (next(parts, None) for parts in roles)
            if joint is not None and inner is not None and outer is not None:
                yield Joint(model.components[joint], inner, outer)


def is_switched(joint: Component) -> bool:
    """True for a clutch or brake whose positions the file states."""
    return joint.type == "switchable_coupling" and joint.get("is_engaged") is not None


def is_rigid(model: Model, parts: Iterable[int], *, switched: bool = True) -> bool:
    """True if the joint of a relation, the first of `parts`, makes its sides turn as one.

    A clutch with several positions does if it is closed in all; none does if `switched` is False.
    """
    for number in parts:
        joint = model.components[number]
        engaged = joint.get("is_engaged")
        if not switched and is_switched(joint):
            return False
        try:
            return joint.type in _RIGID and (engaged is None or engaged.flag())
        except ValueError:
            return False
    return False


def fixed_by(model: Model, parts: Iterable[Component]) -> Component | None:
    """The joint that holds one of `parts` to the casing; None if none does."""
    numbers = {part.id for part in parts}
    for relation in model.relations:
        if relation.type == "side" and is_rigid(model, relation.partners("assembly")):
            sides = [*relation.partners("inner_part"), *relation.partners("outer_part")]
            to_casing = any(model.components[side].type == "gear_casing" for side in sides)
            if to_casing and numbers & set(sides):
                return model.components[next(relation.partners("assembly"))]
    return None
