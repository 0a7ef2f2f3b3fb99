"""The gear sets of a REXS file, and the train that several of them make."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import InputError, Problem, one_problem, raise_any
from epicyclic.files import refuse
from epicyclic.gears.gear import HOUSING
from epicyclic.plugins.rexs.model import Component, Model, Relation, types_of

# Which gear sets a REXS file holds, and the components that each consists of.


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


@dataclass(frozen=True, slots=True)
class SetParts:
    """A pair of gears, or a planetary set of one sun, planets that are all alike, and one ring."""

    component: Component  # That stands for the whole: the stage.
    alike: dict[str, tuple[Component, ...]]  # Gears by their names in a case, with every planet.
    meshes_by_key: dict[str, tuple[Mesh, ...]]  # By their names in a case, of every planet.
    # Of a planetary set the shafts of sun, ring, carrier, planet and pin.
    shafts: dict[str, tuple[Component, ...]] = field(default_factory=dict)

    @property
    def is_pair(self) -> bool:
        """True for two gears; the pinion is the smaller one, and the external one of two."""
        return "pinion" in self.alike

    @property
    def gears(self) -> dict[str, Component]:
        """The gears by their names in a case; of the planets, which are alike, the first."""
        return {name: own[0] for name, own in self.alike.items()}

    @property
    def meshes(self) -> tuple[Mesh, ...]:
        """Every mesh."""
        return tuple(mesh for own in self.meshes_by_key.values() for mesh in own)


def is_internal(gear: Component) -> bool:
    """True for a ring gear, by its type or by a negative number of teeth."""
    teeth = gear.get("number_of_teeth")
    return gear.type == "ring_gear" or (teeth is not None and str(teeth.value).startswith("-"))


def gear_sets(model: Model) -> list[Component]:
    """Planetary stages, and cylindrical stages outside of them."""
    planetary = model.of_type("planetary_stage")
    inside = {mesh.stage.id for stage in planetary for mesh in _planet_meshes(model, stage)}
    parts = model.partners_of(planetary, "assembly", "assembly", "part", "cylindrical_stage")
    inside |= {part.id for part in parts}
    cylindrical = model.of_type("cylindrical_stage")
    return [*planetary, *(stage for stage in cylindrical if stage.id not in inside)]


def choose(model: Model, component: int | None) -> SetParts:
    """The gear set of a component, or the only one.

    Raises `InputError` if there is none, if there are several to choose from, or if it is of a
    kind that is not covered.
    """
    if component is not None:
        chosen = model.components.get(component)
        if chosen is None or chosen.type not in ("planetary_stage", "cylindrical_stage"):
            allowed = "is neither a planetary_stage nor a cylindrical_stage of the file."
            raise one_problem("--component", str(component), allowed, _remedy(model))
    else:
        sets = gear_sets(model)
        if len(sets) != 1:
            allowed = f"the file has {len(sets) or 'no'} stages to choose from."
            raise one_problem("--component", "", allowed, _remedy(model))
        chosen = sets[0]
    return read_stage(model, chosen)


def read_stage(model: Model, stage: Component) -> SetParts:
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


def _planetary_set(model: Model, stage: Component) -> SetParts:
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
        remedy = "Only one sun, one ring and planets that mesh with both can be read."
        raise one_problem(str(stage), "", f"has {found}.", remedy)
    (sun,), (ring,) = suns.values(), rings.values()
    for name, gear in (("sun", sun), ("ring", ring)):
        own = [shaft for shaft in central if gear.id in {g.id for g in gears_on(model, [shaft])}]
        shafts[name] = own or model.partners(gear.id, "assembly", "part", "assembly", "shaft")
    return SetParts(
        stage,
        {"sun": (sun,), "planet": tuple(planets.values()), "ring": (ring,)},
        {
            f"{name}_mesh": tuple(
                mesh for mesh in meshes if central.id in (gear.id for gear in mesh.gears)
            )
            for name, central in (("sun", sun), ("ring", ring))
        },
        {name: tuple(found) for name, found in shafts.items()},
    )


def _pair(model: Model, stage: Component) -> SetParts:
    meshes = [mesh for mesh in _meshes(model) if mesh.stage.id == stage.id]
    if len(meshes) != 1:
        allowed = f"has {len(meshes)} relations of type stage with two gears."
        raise one_problem(str(stage), "", allowed, "Correct the file.")

    def size(gear: Component) -> tuple[bool, float]:
        return is_internal(gear), abs(gear.number("number_of_teeth"))

    pinion, gear = sorted(meshes[0].gears, key=size)
    return SetParts(stage, {"pinion": (pinion,), "gear": (gear,)}, {"mesh": (meshes[0],)})


def rigid_parts(model: Model, start: Iterable[Component]) -> list[Component]:
    """`start` and all that turns with it: parts on shafts and parts coupled to them."""
    found = {component.id: component for component in start}
    waiting = list(found)
    neighbours = _neighbours(rigid_links(model))
    while waiting:
        for other in neighbours.get(waiting.pop(0), ()):
            component = model.components[other]
            if other not in found and component.type != "gear_casing":
                found[other] = component
                waiting.append(other)
    return list(found.values())


def _neighbours(links: Iterable[tuple[int, int]]) -> dict[int, list[int]]:
    neighbours: dict[int, list[int]] = {}
    for first, second in links:
        neighbours.setdefault(first, []).append(second)
        neighbours.setdefault(second, []).append(first)
    return neighbours


def rigid_links(model: Model, *, switched: bool = True) -> Iterator[tuple[int, int]]:
    """Parts that turn as one, two by two; without clutches that are `switched` if that is False."""
    owners = ("shaft", "planet_carrier")
    for relation in model.relations:
        joint = _joint(model, relation)
        if joint is not None and is_rigid(joint.component, switched=switched):
            yield joint.inner, joint.outer
        if relation.type == "assembly":
            sides = [*relation.partners("assembly"), *relation.partners("part")]
            if len(sides) == 2 and model.components[sides[0]].type in owners:
                yield sides[0], sides[1]


class Joint(NamedTuple):
    """A coupling, a bearing or the like, and the parts at its two sides."""

    component: Component
    inner: int
    outer: int


def joints(model: Model) -> Iterator[Joint]:
    """Everything that stands between two parts."""
    return filter(None, (_joint(model, relation) for relation in model.relations))


def _joint(model: Model, relation: Relation) -> Joint | None:
    """What a relation puts between two parts; None if it is of another type."""
    if relation.type != "side":
        return None
    roles = ("assembly", "inner_part", "outer_part")
    joint, inner, outer = (next(relation.partners(role), None) for role in roles)
    if joint is None or inner is None or outer is None:
        return None
    return Joint(model.components[joint], inner, outer)


def is_switched(joint: Component) -> bool:
    """True for a clutch or brake whose positions the file states."""
    return joint.type == "switchable_coupling" and joint.get("is_engaged") is not None


def is_rigid(joint: Component, *, switched: bool = True) -> bool:
    """True if a joint makes its sides turn as one.

    A clutch with several positions does if it is closed in all; none does if `switched` is False.
    """
    engaged = joint.get("is_engaged")
    if not switched and is_switched(joint):
        return False
    try:
        return joint.type in _RIGID and (engaged is None or all(engaged.flags()))
    except ValueError:
        return False


def fixed_by(
    model: Model, parts: Iterable[Component], *, switched: bool = True
) -> Component | None:
    """The joint that holds one of `parts` to the casing, as `is_rigid`; None if none does."""
    numbers = {part.id for part in parts}
    for joint, *sides in joints(model):
        to_casing = any(model.components[side].type == "gear_casing" for side in sides)
        if to_casing and numbers.intersection(sides) and is_rigid(joint, switched=switched):
            return joint
    return None


# Several stages of a REXS file as one train: its sets, its shafts, its clutches and brakes.


MOST_STAGES, MOST_BEARINGS = 40, 400  # A file with more than this is not a gear unit.

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
    """The stages of a file and the shafts between them."""

    unit: Component  # The gear unit, or the first stage if the file has none.
    sets: dict[str, SetParts]  # By their names in the case, as shafts and bearings.
    shafts: dict[str, Shaft]
    switches: tuple[Switch, ...]
    bearings: dict[str, Joint]  # All but those of planets.

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

    Raises `InputError` if there are too many, or if one is of a kind that is not covered.
    """
    _check_count(len(model.of_type("planetary_stage")), "stages", MOST_STAGES)
    stages = gear_sets(model)
    if len(stages) < 2:
        return None
    _check_count(len(stages), "stages", MOST_STAGES)
    order = list(model.components)
    names = Names()
    sets: dict[str, SetParts] = {}
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
    _check_count(len(borne), "bearings", MOST_BEARINGS)
    bearings = {names.of(joint.component, "bearing"): joint for joint in borne}
    return Train(units[0] if units else stages[0], sets, shafts, switches, bearings)


def _check_count(count: int, noun: str, most: int) -> None:
    if count > most:
        remedy = "Import one stage with --component, or export fewer."
        refuse(f"has {count} {noun}, but at most {most} are read as one train.", remedy)


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


def _shafts(model: Model, sets: Mapping[str, SetParts], names: Names) -> dict[str, Shaft]:
    """The shafts of all sets, in the order of the sets."""
    owned = {
        f"{name}.{member}": parts for name, one in sets.items() for member, parts in _members(one)
    }
    bodies = _bodies(model, owned.values())
    members: dict[int, list[str]] = {}
    for number, (member, parts) in enumerate(owned.items()):
        body = bodies[parts[0].id] if parts else -1 - number
        members.setdefault(body, []).append(member)
    found: dict[str, Shaft] = {}
    for body, joined in members.items():
        turning = {part: model.components[part] for part, root in bodies.items() if root == body}
        loose = (part for part in turning.values() if part.type != "gear_casing")
        held = fixed_by(model, loose, switched=False)
        shaft = Shaft(joined[0], turning, tuple(joined), held)
        if shaft.is_listed:
            own = shaft.components
            named = names.of(own[0], "shaft") if own else names.free("shaft", abs(body))
            shaft = replace(shaft, name=named)
        found[shaft.name] = shaft
    return found


def _members(one: SetParts) -> Iterator[tuple[str, list[Component]]]:
    """The members of a set, each with parts that turn with it."""
    for name in ("pinion", "gear") if one.is_pair else ("sun", "carrier", "ring"):
        yield name, [*one.alike.get(name, ()), *one.shafts.get(name, ())]


def _bodies(model: Model, joined: Iterable[list[Component]]) -> dict[int, int]:
    """For each part that turns with others, which body it belongs to, by one of its parts."""
    own = [(parts[0].id, part.id) for parts in joined for part in parts]
    others = [
        pair
        for pair in rigid_links(model, switched=False)
        if all(model.components[part].type != "gear_casing" for part in pair)
    ]
    neighbours = _neighbours([*own, *others])
    bodies: dict[int, int] = {}
    for start in neighbours:
        waiting = [start]
        while waiting:
            part = waiting.pop()
            if part not in bodies:
                bodies[part] = start
                waiting += neighbours[part]
    return bodies


def _bearings(model: Model, sets: Mapping[str, SetParts]) -> Iterator[Joint]:
    """The bearings of the file but for those of planets, each once."""
    planetary = [one for one in sets.values() if not one.is_pair]
    planets = {
        part.id for one in planetary for part in (*one.alike["planet"], *one.shafts["planet"])
    }
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
