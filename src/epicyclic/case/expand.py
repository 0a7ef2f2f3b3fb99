"""From the tables of a set, in whichever form a case states it, to its one `Gearing`."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from epicyclic.case.gear_tables import SetMesh
from epicyclic.case.train_tables import ListedMesh
from epicyclic.errors import Problem
from epicyclic.gears.assembly import MOST_SHIFTED, reach_problems
from epicyclic.gears.gear import CARRIER
from epicyclic.gears.gearing import Gearing, GearPairing
from epicyclic.messages import did_you_mean, written

Parts = Mapping[str, Any]  # The tables of a set by their keys, as ``dict(table)`` gives them.


def expand(
    parts: Parts,
    # Members of the set that shafts, states and the operation name: they are no planets.
    joined: Iterable[str] = (),
) -> tuple[Gearing, list[Problem]]:
    """The gearing of a set, and what cannot be about it."""
    if "members" in parts:
        return _listed(parts, set(joined))
    make, check = _planetary, _given_planetary_problems
    if "pinion" in parts:
        make, check = _pair, _given_pair_problems
    return make(parts), [] if "gears" in parts else list(check(parts))


def _planetary(parts: Parts) -> Gearing:
    """Sun, planets and ring, with the torques of the members without losses. Theory (K3), (K4)."""
    sun, ring = parts["sun"].teeth, parts["ring"].teeth
    planet: float = parts["planet"].teeth or (ring - sun) / 2
    efficiency = 1.0
    if parts.get("mesh_efficiency") is not None:
        efficiency = parts["mesh_efficiency"]
    elif parts.get("efficiency") is not None:
        # both meshes alike, so that sun to ring has the efficiency of the set
        efficiency = math.sqrt(parts["efficiency"])
    meshes = (
        _pairing(parts, "sun_mesh", ("sun", "planet"), (sun, planet), False, efficiency),
        _pairing(parts, "ring_mesh", ("planet", "ring"), (planet, ring), True, efficiency),
    )
    names = ("sun", "planet", "ring")
    gearing = Gearing({name: name for name in names}, ("planet",), meshes)
    if "gears" not in parts:
        return gearing
    levers = {
        member: {"sun_mesh": lever, "ring_mesh": -lever * planet / sun}
        for member, factor in (("sun", sun), ("ring", ring), (CARRIER, -(sun + ring)))
        for lever in (sun / factor,)
    }
    return replace(
        gearing,
        tables={name: parts[name] for name in names},
        shared=parts["gears"],
        count=parts["planet"].count,
        stated_angles=parts["planet"].angles,
        hand=-1 if parts.get("hand") == "left" else 1,
        drags={"sun_drag": ("sun",), "ring_drag": ("ring",)},
        levers=levers,
    )


def _pair(parts: Parts) -> Gearing:
    one, two = parts["pinion"].teeth, parts["gear"].teeth
    internal: bool = parts["gear"].internal
    efficiency: float = parts.get("efficiency", 1.0)
    mesh = _pairing(parts, "mesh", ("pinion", "gear"), (one, two), internal, efficiency)
    names = ("pinion", "gear")
    gearing = Gearing({name: name for name in names}, (), (mesh,))
    if "gears" not in parts:
        return gearing
    return replace(
        gearing,
        tables={name: parts[name] for name in names},
        shared=parts["gears"],
        hand=-1 if parts.get("hand") == "left" else 1,
        drags={"drag": names},
        levers={"pinion": {"mesh": 1.0}, "gear": {"mesh": (-1 if internal else 1) * one / two}},
    )


def _pairing(
    parts: Parts,
    key: str,
    gears: tuple[str, str],
    teeth: tuple[float, float],
    internal: bool,
    efficiency: float,
) -> GearPairing:
    return GearPairing(
        key,
        *gears,
        teeth,
        internal,
        parts.get(key) or SetMesh(),
        efficiency,
        pair=gears,
        title=key.replace("_", " "),
        table_key=key,
        direction=parts.get("direction") or 0.0,
    )


def _given_planetary_problems(parts: Parts) -> Iterator[Problem]:
    """Tooth numbers that leave no room for planets; those of computed sets are checked before."""
    sun, ring, planet = (parts[name].teeth for name in ("sun", "ring", "planet"))
    if ring <= sun:
        allowed = f"must exceed the {sun} teeth of the sun, which it surrounds."
        yield Problem("ring.teeth", str(ring), allowed, "Check both tooth numbers.")
    elif planet is not None and planet >= ring:
        allowed = f"must be less than the {ring} teeth of the ring, in which the planet turns."
        yield Problem("planet.teeth", str(planet), allowed, "Check it, or leave it out.")
    elif planet is not None and abs(ring - sun - 2 * planet) > MOST_SHIFTED:
        allowed = f"does not fit between a sun of {sun} and a ring of {ring} teeth, which leave "
        allowed += f"room for {(ring - sun) / 2:g}."
        yield Problem("planet.teeth", str(planet), allowed, "Correct it, or leave it out.")
    elif "count" in parts["planet"].model_fields_set:
        teeth, count = planet or (ring - sun) / 2, parts["planet"].count
        most = math.floor(math.pi / math.asin((teeth + 2) / (sun + teeth))) if sun > 2 else 1
        allowed = f"is too many: planets of {teeth:g} teeth and standard addendum touch each other."
        remedy = f"Use at most {most}, or leave it out: it does not change the losses."
        if count > most:
            yield Problem("planet.count", str(count), allowed, remedy)


def _given_pair_problems(parts: Parts) -> Iterator[Problem]:
    pinion, gear = parts["pinion"].teeth, parts["gear"].teeth
    if parts["gear"].internal and gear <= pinion:
        allowed = f"must exceed the {pinion} teeth of the pinion, which turns inside it."
        yield Problem("gear.teeth", str(gear), allowed, "Check both tooth numbers.")


def _listed(parts: Parts, joined: set[str]) -> tuple[Gearing, list[Problem]]:
    gears, listed = parts["members"], parts["meshes"]
    bodies = {name: gear.body or name for name, gear in gears.items()}
    problems = list(_name_problems(parts, bodies))
    pairs = [
        pair
        for pair in listed
        if all(gear in gears for gear in pair) and bodies[pair[0]] != bodies[pair[1]]
    ]
    planets = _planets(parts, bodies, pairs, joined)
    meshes: list[GearPairing] = []
    for one, two in pairs:
        found = _mesh_problem(parts, bodies, planets, one, two)
        if found is None and any(mesh.key == f"{one}_{two}_mesh" for mesh in meshes):
            key, name = f"meshes[{listed.index((one, two))}]", f"{one}_{two}_mesh"
            allowed = f"has the same name in the results as another mesh, {name}."
            found = Problem(key, f'["{one}", "{two}"]', allowed, "Rename a gear.")
        if found is not None:
            problems.append(found)
        else:
            meshes.append(_listed_pairing(parts, one, two))
    gearing = Gearing(bodies, tuple(planets), tuple(meshes), listed=True, count=parts["planets"])
    if "gears" not in parts:
        return gearing, [*problems, *reach_problems(gearing)]
    central = [gear for gear, body in bodies.items() if body not in planets]
    drags = {f"{gear}_drag": (gear,) for gear in central}
    return replace(gearing, tables=gears, shared=parts["gears"], drags=drags), problems


def _listed_pairing(parts: Parts, one: str, two: str) -> GearPairing:
    gears = parts["members"]
    first, second = (two, one) if gears[one].internal else (one, two)
    names = (f"{one}-{two}", f"{two}-{one}")
    name = next((name for name in names if name in parts["mesh"]), names[0])
    own = parts["mesh"].get(name)
    efficiency: float = parts.get("mesh_efficiency", 1.0)
    return GearPairing(
        f"{one}_{two}_mesh",
        first,
        second,
        (gears[first].teeth, gears[second].teeth),
        gears[second].internal,
        own if isinstance(own, ListedMesh) else SetMesh(),
        efficiency if own is None else getattr(own, "efficiency", efficiency),
        pair=(one, two),
        title=f"{one}-{two} mesh",
        table_key=f"mesh.{name}",
        own_distance=getattr(own, "center_distance", None),
        direction=getattr(own, "direction", 0.0),
    )


def _name_problems(parts: Parts, bodies: Mapping[str, str]) -> Iterator[Problem]:
    """Meshes between gears that are not there, twice, or on one body; gears without a mesh."""
    listed = parts["meshes"]
    seen: set[frozenset[str]] = set()
    for number, (one, two) in enumerate(listed):
        key, shown = f"meshes[{number}]", f'["{one}", "{two}"]'
        for gear in dict.fromkeys((one, two)):
            if gear not in bodies:
                remedy = did_you_mean(gear, bodies) or f"The gears are {', '.join(bodies)}."
                yield Problem(key, written(gear), "is not a gear of this set.", remedy)
        if one == two:
            yield Problem(key, shown, "is a gear in mesh with itself.", "Name two gears.")
        elif bodies.get(one, one) == bodies.get(two, two):
            allowed = f"cannot mesh: both gears turn with the body {bodies.get(one, one)}."
            yield Problem(key, shown, allowed, "Give one of them another body.")
        if frozenset((one, two)) in seen:
            yield Problem(key, shown, "is listed already.", "List each mesh once.")
        seen.add(frozenset((one, two)))
    used = {gear for pair in listed for gear in pair}
    for gear in bodies:
        if gear not in used:
            remedy = "Add its mesh to meshes, or remove it."
            yield Problem(f"gears.{gear}", "", "has no mesh.", remedy)
    known = {f"{one}-{two}" for pair in listed for one, two in (pair, pair[::-1])}
    for one, two in listed:
        if {f"{one}-{two}", f"{two}-{one}"} <= {*parts["mesh"]}:
            allowed = f"repeats the mesh {one}-{two}."
            yield Problem(f"mesh.{two}-{one}", "", allowed, "Keep one of the two.")
    for name in parts["mesh"]:
        if name not in known:
            remedy = f"The meshes are {', '.join('-'.join(pair) for pair in listed)}."
            yield Problem(f"mesh.{name}", "", "is not a mesh of this set.", remedy)


def _mesh_problem(
    parts: Parts, bodies: Mapping[str, str], planets: Sequence[str], one: str, two: str
) -> Problem | None:
    """Why two gears on different bodies cannot mesh; None if they can."""
    gears = parts["members"]
    key, shown = f"meshes[{parts['meshes'].index((one, two))}]", f'["{one}", "{two}"]'
    if gears[one].internal and gears[two].internal:
        allowed = "cannot mesh: both are ring gears."
        return Problem(key, shown, allowed, "Make one of them external.")
    if planets and bodies[one] not in planets and bodies[two] not in planets:
        allowed = "cannot mesh: both turn about the axis of the set."
        remedy = f"If one of them is a planet, write gears.{two}.planet = true."
        return Problem(key, shown, allowed, remedy)
    for ring, mate in ((one, two), (two, one)):
        if not gears[ring].internal:
            continue
        if bodies[ring] in planets:
            allowed = f"cannot mesh, because the ring gear {ring} would be a planet."
            return Problem(key, shown, allowed, f"Leave out gears.{ring}.planet.")
        if gears[ring].teeth <= gears[mate].teeth:
            allowed = (
                f"cannot mesh: the ring gear {ring} with {gears[ring].teeth} teeth must have more "
                f"than {mate} with {gears[mate].teeth}."
            )
            return Problem(key, shown, allowed, "Check both tooth numbers.")
    return None


def _planets(
    parts: Parts, bodies: Mapping[str, str], pairs: Sequence[tuple[str, str]], joined: set[str]
) -> list[str]:
    """Bodies that stand on the carrier: as stated, or as meshes and shafts suggest."""
    gears = parts["members"]
    stated = {bodies[name]: gear.planet for name, gear in gears.items() if gear.planet is not None}
    rings = {bodies[name] for name, gear in gears.items() if gear.internal}
    mates: dict[str, set[str]] = defaultdict(set)
    for one, two in pairs:
        mates[bodies[one]].add(two)
        mates[bodies[two]].add(one)
    around = parts["planets"] is not None or CARRIER in joined
    if not around and not any(stated.values()):
        around = any("planet" in name for name in (*bodies, *bodies.values()))
    planets = []
    for body in dict.fromkeys(bodies.values()):
        names = {body, *(name for name in bodies if bodies[name] == body)}
        named = bool(names & joined) and not any("planet" in name for name in names)
        if body in stated:
            on_carrier = bool(stated[body])
        elif body in rings or named or not around:
            on_carrier = False
        else:
            on_carrier = len(mates[body]) > 1 or "planet" in body
        if on_carrier:
            planets.append(body)
    return planets
