"""A set of gears around one carrier, or a pair in the housing: meshes, planets, bearings, discs."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from epicyclic.arrays import Each, agreed, either, for_alike, one_by_one
from epicyclic.dataclass import dataclass, replace
from epicyclic.gears.gear import HOUSING
from epicyclic.kernels import ahead
from epicyclic.losses.pocket_tables import KnownFlows
from epicyclic.losses.ranges import Flags, ModelUse, SomeFlags, Sought, ValidityFlag
from epicyclic.machine.disc import Disc, ThrustBearing, disc_loss, thrust_loss
from epicyclic.machine.element import (
    LOAD_INDEPENDENT,
    OIL,
    ElementResult,
    Figures,
    Loss,
    Note,
    State,
    joined_key,
)
from epicyclic.machine.gear_mesh import GearMesh, MeshDuty, MeshFigures, MeshResult, solve_mesh
from epicyclic.machine.planets import (
    BearingFigures,
    BearingResult,
    LoadSharing,
    PinFigures,
    PlanetBearing,
    PlanetContact,
    PlanetLoad,
    PlanetPin,
    missing_bearing,
    planet_load,
    planet_shares,
    radial_force,
    solve_bearing,
    solve_pin,
    tilt_planet,
)
from epicyclic.machine.pocket_flow import MeshFlow, mesh_flows
from epicyclic.units import NEWTON, format_number

OUTWARD = "{}_outward"  # Key of what tells the direction of the load on a planet bearing.
DIRECTION = 0.05
"""Its weight: a bearing loses by the size of its load, and little by its direction. [1]"""
WORTH_A_NOTE = 0.1
"""Centrifugal force of an estimated mass over the load on a bearing, from which a note says so: it
stands square to the force of the teeth, and changes the load by 0.5 %. [1]"""
LEAST_PULL = 10.0  # Force of rotation on a roller from which a note says so. [N]
ROUNDING = 1e-12  # Torques as small as this, relatively, are the rounding of a difference. [1]


@dataclass(frozen=True, slots=True)
class LossChoice:
    """What becomes of one loss."""

    pointwise = True

    include: bool = True
    factor: float = 1.0  # [1]


@dataclass(frozen=True, slots=True)
class Reference:
    """The body whose torque states the load of a set, without the losses of that set.

    The losses inside the set act between two other bodies, so that the torque of this one and the
    loads of the meshes stay in the ratio of the lossless set. Theory (K5).
    """

    body: str
    # Torque at the first gear of each mesh over the torque of the body. [1]
    levers: Mapping[str, float]
    between: tuple[str, str]  # The bodies between which the losses act.


@dataclass(frozen=True, slots=True)
class PlanetMesh:
    """How a mesh stands to a planet, as in `PlanetContact`; the mesh by its key, (t, r) outward."""

    mesh: str
    member: int
    outward: tuple[float, float]
    hand: int = 1
    position: float = 0.0


@dataclass(frozen=True, slots=True)
class Planet:
    """The planets of one kind: a body that turns on a pin of the carrier."""

    pointwise = True

    key: str  # First word of the losses of its bearing: ``"planet_bearing"``.
    body: str
    pin_radius: float  # From the axis of the set to that of the planet. [m]
    meshes: tuple[PlanetMesh, ...]
    mass: float = 0.0  # Mass of one planet with its rollers. [kg]
    mass_estimated: bool = False  # True if no case states it.
    bearing: PlanetBearing | PlanetPin | None = None
    no_bearing: str = ""  # Why there is none.
    diameter: float = 0.0  # Of the reference circle of its largest gear. [m]
    tilts: bool = False  # True if the planet tilts in its bearing and misaligns its meshes.
    nodes: tuple[str, str] = (OIL, OIL)  # The thermal nodes of the planets and of their pins.

    def load(
        self, duties: Mapping[str, MeshDuty], carrier_speed: float
    ) -> tuple[Sequence[MeshDuty], PlanetLoad]:
        """Duties of its meshes, misaligned if it tilts, and load on its bearing. Theory (B3)."""
        contacts = self._contacts(duties)
        centrifugal = self.centrifugal(carrier_speed)
        idle = all(contact.duty.torque1 == 0 for contact in contacts)
        if not self.tilts or not isinstance(self.bearing, PlanetBearing) or idle:
            load = planet_load(contacts, centrifugal)
        else:
            contacts, load = tilt_planet(contacts, self.bearing.bearing, centrifugal)
        return [contact.duty for contact in contacts], load

    def force(self, duties: Mapping[str, MeshDuty], carrier_speed: float) -> complex:
        """The load on its bearing if it does not tilt: along the circle of pins + i outward. [N]"""
        return radial_force(self._contacts(duties), self.centrifugal(carrier_speed))

    def centrifugal(self, carrier_speed: float) -> float:
        """Its centrifugal force. [N]"""
        return self.mass * self.pin_radius * carrier_speed**2

    def notes(self, carrier_speed: float, load: PlanetLoad) -> tuple[str, ...]:
        """That its mass is estimated and what its rollers weigh, where it matters. Theory (B20)."""
        force, where = self.centrifugal(carrier_speed), self.key.replace("_", " ")
        found: tuple[str, ...] = ()
        if isinstance(self.bearing, PlanetBearing):
            rollers = self.bearing.bearing
            mass = rollers.roller_mass(self.bearing.roller_density)
            pull = mass * self.pin_radius * carrier_speed**2
            count = rollers.rows * rollers.rollers_per_row
            if pull > LEAST_PULL and count * pull > WORTH_A_NOTE * load.force:
                found = (self._roller_note(where, pull, load.force),)
        if not self.mass_estimated or force < WORTH_A_NOTE * load.force:
            return found
        return (
            *found,
            f"{where}: the mass of a planet is not given. Estimated from its dimensions, it is "
            f"{format_number(self.mass, 3)} kg and its centrifugal force is "
            f"{NEWTON.text(force, 3)} of the {NEWTON.text(load.force, 3)} on the bearing.",
        )

    def _roller_note(self, where: str, pull: float, force: float) -> Note:
        return Note(
            f"{where}: the carrier presses each roller outward with {NEWTON.text(pull, 3)}, beside "
            f"{NEWTON.text(force, 3)} on the bearing. Unloaded rollers roll under this force, "
            "which the loss contains, and press on their cage, which it leaves out."
        )

    def _contacts(self, duties: Mapping[str, MeshDuty]) -> Sequence[PlanetContact]:
        # a mesh turns both of its external gears against the torque that gear 1 brings in
        senses = [either(duties[own.mesh].torque1 > 0, -1, 1) for own in self.meshes]
        turn = senses[0]  # axes turned about r by half a turn if -1; no -0.0, which prints oddly
        return [
            PlanetContact(
                duties[own.mesh],
                own.member,
                turn * own.outward[0] + 1j * own.outward[1],
                turn * sense,
                own.hand,
                turn * own.position + 0.0,
            )
            for own, sense in zip(self.meshes, senses, strict=True)
        ]


class Drags(NamedTuple):
    """Losses that depend on the speeds only, and their flags."""

    losses: Mapping[str, Loss]
    flags: SomeFlags


Flows = Mapping[str, MeshFlow]  # Flow through the pockets of each mesh, by its key.


@dataclass(frozen=True, slots=True, kw_only=True)
class GearSetResult(ElementResult):
    """Losses, figures, flags of a set; meshes and bearings are those of its most loaded planet.

    From `drags` on: what the next evaluation goes on from.
    """

    # Share of the load that each planet carries; empty without planets. [1]
    shares: tuple[float, ...] = ()
    drags: Drags
    flows: Mapping[tuple[bytes, ...], Flows]  # By which gears drive, at each point of a block.
    # By their key and the number of the share of the load, the largest first.
    meshes: Mapping[tuple[str, int], MeshResult]
    bearings: Mapping[tuple[str, int], BearingResult]
    known_flows: KnownFlows  # Through pockets, also those at other temperatures.

    def of_last_pass(self) -> dict[str, Any]:
        """What nothing goes on from: these fields, empty."""
        return {
            "drags": Drags({}, ()),
            "flows": {},
            "meshes": {},
            "bearings": {},
            "known_flows": KnownFlows(),
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class _Branch(ElementResult):
    """Losses of all planets with one and the same share, and the figures of one."""

    meshes: Mapping[tuple[str, int], MeshResult]
    bearings: Mapping[tuple[str, int], BearingResult]


@dataclass(frozen=True, slots=True)
class GearSet:
    """Meshes seen from one carrier, with planets, their bearings, discs and thrust bearings."""

    pointwise = True

    key: str  # First part of its losses; empty for a single set.
    carrier: str  # Body from which the meshes are seen; `HOUSING` for a pair.
    meshes: tuple[GearMesh, ...]
    planets: tuple[Planet, ...]  # Kinds of planets; empty for a pair.
    sharing: LoadSharing | None  # None without planets.
    discs: Mapping[str, tuple[Disc, ...]]  # By the name of their loss, ``"sun_drag"``.
    missing: Mapping[str, str]  # Losses that the set does not have, and why.
    thrust: ThrustBearing | None
    # Every loss of the set, in the order in which they are shown.
    choices: Mapping[str, LossChoice]
    # None: each mesh carries what the losses leave, and its losses act on its own bodies.
    reference: Reference | None = None

    def evaluate(self, state: State, last: ElementResult | None = None) -> GearSetResult:
        """Losses, figures and flags in a state; `last`, under nearly these loads, saves work."""
        assert last is None or isinstance(last, GearSetResult)
        drags = self._drags(state) if last is None else last.drags
        torques = self._torques(state, drags)
        shares = self.shares(state, torques)
        duties = self.duties(state, torques, 1 / self.count)  # under the mean load, for pockets
        if self.reference is None:
            # the directions of the whole machine count: those of next to no load are found last
            duties = tuple(
                replace(duty, drives1=state.drives[f"{self.key}.{duty.gears.key}"])
                for duty in duties
            )
        sides = [duty.drives1 for duty in duties]
        driving = tuple(np.asarray(side).tobytes() for side in sides)
        earlier = state.earlier.get(self.key)
        loaded = {} if earlier is None else earlier.loaded
        if last is None:
            flows, meshes, bearings = {}, {}, {}
            known = earlier.known_flows if isinstance(earlier, GearSetResult) else KnownFlows()
        else:
            flows, meshes, bearings = dict(last.flows), dict(last.meshes), dict(last.bearings)
            known = last.known_flows
        if driving not in flows:
            none = {duty.gears.key: MeshFlow() for duty in duties}
            of_first = partial(self._branch, state, torques, (0, shares[0]), 1)
            ahead[:] = [partial(of_first, none, {}, {}, loaded)]
            flows[driving], known = for_alike(sides, mesh_flows, duties, state.fluids, known)
            ahead.clear()
        branches = []
        for place, share in enumerate(sorted(set(shares), reverse=True)):
            last_ones = flows[driving], meshes, bearings, loaded
            branch = self._branch(state, torques, (place, share), shares.count(share), *last_ones)
            meshes |= branch.meshes
            bearings |= branch.bearings
            branches.append(branch)
        first = branches[0]
        losses = first.losses
        if len(branches) > 1:
            alike = {name: [branch.losses[name] for branch in branches] for name in losses}
            losses = {
                name: own[0]._replace(watts=sum(loss.watts for loss in own), heat=_mean_heat(own))
                for name, own in alike.items()
            }
        chosen = {name: _with_choice(loss, self.choices[name]) for name, loss in losses.items()}
        found = {**drags.losses, **chosen}
        return GearSetResult(
            losses={name: found[name] for name in self.choices},
            figures=first.figures,
            extremes=first.extremes,
            flags=Flags(partial(_widest, [branch.flags for branch in branches])) + drags.flags,
            notes=first.notes,
            loaded={
                **{place: mesh.elastic for place, mesh in meshes.items()},
                **{place: bearing.loads for place, bearing in bearings.items()},
            },
            shares=shares if self.planets else (),
            drags=drags,
            flows=flows,
            meshes=meshes,
            bearings=bearings,
            known_flows=known,
        )

    @property
    def several(self) -> bool:
        """Whether it is solved for several operating points at once."""
        pins = any(isinstance(planet.bearing, PlanetPin) for planet in self.planets)
        return self._parts_apart and not pins and all(own.models.several for own in self.meshes)

    @property
    def terms(self) -> tuple[str, ...]:
        """Names of its losses, in the order in which they are shown."""
        return tuple(self.choices)

    @property
    def figure_types(self) -> tuple[tuple[str, type[Any]], ...]:
        """Names and types of the figures of its meshes and planet bearings."""
        return (
            *((mesh.key, MeshFigures) for mesh in self.meshes),
            *((planet.key, BearingFigures) for planet in self.planets if planet.bearing),
            *(
                (f"{planet.key}_film", PinFigures)
                for planet in self.planets
                if isinstance(planet.bearing, PlanetPin)
            ),
        )

    def loads(self, state: State, last: ElementResult | None = None) -> Mapping[str, float]:
        """What each mesh and each planet bearing carries, all planets together. [N m]

        Torques at the first gears of meshes; forces on bearings times the radius of their pins.
        """
        assert last is None or isinstance(last, GearSetResult)
        torques = self._torques(state, None if last is None else last.drags)
        if not self._parts_apart:
            return torques
        duties = {duty.gears.key: duty for duty in self.duties(state, torques, 1 / self.count)}
        speed = state.speeds[self.carrier]
        loads = dict(torques)
        for planet in self.planets:
            if planet.bearing is not None:
                load = self.count * planet.pin_radius * planet.force(duties, speed)
                # positive either way: its sign tells of no other flank, as those of other loads do
                aside = DIRECTION * (2 * abs(load) + load.imag)
                loads |= {planet.key: abs(load), OUTWARD.format(planet.key): aside}
        return loads

    @property
    def _parts_apart(self) -> bool:
        """True if each mesh and each planet bearing loses by its own load alone."""
        alike = self.sharing is None or self.sharing.whatever_the_load
        return alike and not any(planet.tilts for planet in self.planets)

    @property
    def count(self) -> int:
        """Number of planets of each kind, which work in parallel."""
        return 1 if self.sharing is None else len(self.sharing.angles)

    def loaded_duties(self, state: State) -> tuple[MeshDuty, ...]:
        """The meshes of the planet that carries most, misaligned if it tilts."""
        torques = self._torques(state)
        share = max(self.shares(state, torques))
        duties = {duty.gears.key: duty for duty in self.duties(state, torques, share)}
        for planet in self.planets:
            tilted, _ = planet.load(duties, state.speeds[self.carrier])
            duties |= {duty.gears.key: duty for duty in tilted}
        return tuple(duties.values())

    def mean_duties(self, state: State) -> tuple[MeshDuty, ...]:
        """The meshes of a planet that carries its mean share."""
        return self.duties(state, self._torques(state), 1 / self.count)

    def mean_loads(self, state: State) -> dict[str, PlanetLoad]:
        """Load on the bearing of a planet that carries its mean share and does not tilt."""
        duties = {duty.gears.key: duty for duty in self.mean_duties(state)}
        speed = state.speeds[self.carrier]
        return {
            planet.key: replace(planet, tilts=False).load(duties, speed)[1]
            for planet in self.planets
        }

    def duties(
        self, state: State, torques: Mapping[str, float], share: float
    ) -> tuple[MeshDuty, ...]:
        """The meshes of a planet with `share` of the load. Theory (K4)."""
        carrier = state.speeds[self.carrier]
        duties = []
        for mesh in self.meshes:
            torque, speed = share * torques[mesh.key], state.speeds[mesh.bodies[0]] - carrier
            duties.append(MeshDuty(mesh, torque, speed, agreed(torque * speed >= 0)))
        return tuple(duties)

    def shares(self, state: State, torques: Mapping[str, float]) -> tuple[float, ...]:
        """The share of the load that each planet carries."""
        if self.sharing is None:
            return (1.0,)
        bearing = self.planets[0].bearing
        alike = self.sharing.whatever_the_load
        duties = () if alike else self.duties(state, torques, 1 / self.count)
        rollers = bearing.bearing if isinstance(bearing, PlanetBearing) else None
        return planet_shares(self.sharing, duties, rollers)

    def _torques(self, state: State, drags: Drags | None = None) -> dict[str, float]:
        """Torque at the first gear of each mesh, all planets together."""
        passed = {mesh.key: state.torques[f"{self.key}.{mesh.key}"] for mesh in self.meshes}
        if self.reference is None or state.lossless:
            return passed
        # the drag of the body itself does not take from the load that its torque states
        body, speed = self.reference.body, state.speeds[self.reference.body]
        own_shaft = ((body, HOUSING, 1.0),)
        losses = (drags or self._drags(state)).losses.values()
        drag = sum(loss.watts for loss in losses if loss.brakes == own_shaft)
        own = drag / speed if speed else 0.0
        torques = {}
        for key, torque in passed.items():
            added = own * self.reference.levers[key]
            whole = torque + added
            torques[key] = whole * (abs(whole) > ROUNDING * abs(added)) + 0.0
        return torques

    def _drags(self, state: State) -> Drags:
        """Losses that do not depend on planets, as the user wants them, where they act."""
        losses = {
            name: Loss(LOAD_INDEPENDENT, left_out=reason) for name, reason in self.missing.items()
        }
        flags = Flags()
        struck = sum(
            disc.jets is not None and bool(state.speeds[disc.body] != 0)
            for discs in self.discs.values()
            for disc in (it[0] if isinstance(it, Each) else it for it in discs)
        )
        for name, discs in self.discs.items():
            losses[name], found = one_by_one(disc_loss, discs, state, struck)
            flags += found
        if self.thrust is not None:
            losses["thrust_bearing_viscous"], found = one_by_one(thrust_loss, self.thrust, state)
            flags += found
        placed = {}
        for name, loss in losses.items():
            own = _with_choice(loss, self.choices[name])
            on_shaft = any(HOUSING in brake for brake in own.brakes) and self.carrier != HOUSING
            # inside the set it acts where all its losses do, and so do both discs of a pair
            if self.reference is not None and not on_shaft:
                own = own._replace(brakes=((*self.reference.between, 1.0),), mesh="")
            placed[name] = own
        return Drags(placed, flags)

    def _branch(
        self,
        state: State,
        torques: Mapping[str, float],
        load_share: tuple[int, float],  # Its number, the largest first.
        planets: int,
        flows: Flows,
        last_meshes: Mapping[tuple[str, int], MeshResult],
        last_bearings: Mapping[tuple[str, int], BearingResult],
        loaded: Mapping[Any, Any],  # Both at another temperature.
    ) -> _Branch:
        place, share = load_share
        duties = {duty.gears.key: duty for duty in self.duties(state, torques, share)}
        bearings: dict[tuple[str, int], BearingResult] = {}
        notes: list[Callable[[], Iterable[str]]] = []
        carrier = state.speeds[self.carrier]
        for planet in self.planets:
            tilted, load = planet.load(duties, carrier)
            duties |= {duty.gears.key: duty for duty in tilted}
            if planet.bearing is not None:
                notes.append(partial(planet.notes, carrier, load))
            speed = state.speeds[planet.body] - carrier
            oil = state.fluids.at(joined_key(self.key, planet.key))
            before = last_bearings.get((planet.key, place))
            last = None if before is None else before.loads
            if before is not None and planet.key in state.serve:
                bearing = before
            elif planet.bearing is None:
                force = load.force / share if share else 0.0
                own = planet.no_bearing, force, planet.diameter, speed
                bearing = one_by_one(missing_bearing, planet.key, *own)
            elif isinstance(planet.bearing, PlanetPin):
                # in the axes of the load, in which the first mesh turns the planet from t to r
                driven = -speed if duties[planet.meshes[0].mesh].torque1 > 0 else speed
                bearing = solve_pin(planet.key, planet.bearing, load, planets, oil, driven, last)
            else:
                start = last or loaded.get((planet.key, place))
                at = speed, start, planet.pin_radius, carrier, any(it.torque1 for it in tilted)
                bearing = one_by_one(
                    solve_bearing, planet.key, planet.bearing, load, planets, oil, *at
                )
            notes.append(bearing.notes.__iter__)
            bearings[planet.key, place] = bearing
        meshes = {
            (key, place): last_meshes[key, place]
            if key in state.serve
            else solve_mesh(
                duty,
                state.fluids,
                flows[key],
                planets,
                state.fluids.at(joined_key(self.key, key)),
                last_meshes.get((key, place)),
                loaded.get((key, place)),
            )
            for key, duty in duties.items()
        }
        losses: dict[str, Loss] = {}
        flags = Flags()
        for planet, bearing in zip(self.planets, bearings.values(), strict=True):
            between = planet.body, self.carrier
            if self.reference is not None:
                between = self.reference.between
            for name, loss in bearing.losses.items():
                placed = loss._replace(brakes=((*between, 1.0),))
                if loss.group != LOAD_INDEPENDENT:  # that of the rollers heats planet and pin
                    placed = placed._replace(heat=tuple((node, 0.5) for node in planet.nodes))
                    if planet.bearing is not None and self._parts_apart:
                        placed = placed._replace(follows=(planet.key, OUTWARD.format(planet.key)))
                losses[name] = placed
            flags += bearing.flags
        for duty, mesh in zip(duties.values(), meshes.values(), strict=True):
            losses |= self._of_mesh(duty, mesh.losses)
            flags = mesh.flags + flags
        parts: list[ElementResult] = [*bearings.values(), *meshes.values()]
        figures, extremes = (
            Figures({key: partial(it.__getitem__, key) for it in found for key in it})
            for found in zip(*((it.figures, it.extremes) for it in parts), strict=True)
        )
        return _Branch(
            losses=losses,
            figures=figures,
            extremes=extremes,
            flags=flags,
            notes=Sought(*notes, *(mesh.notes.__iter__ for mesh in meshes.values())),
            meshes=meshes,
            bearings=bearings,
        )

    def _of_mesh(self, duty: MeshDuty, losses: Mapping[str, Loss]) -> dict[str, Loss]:
        """Losses of a mesh where they act: sliding is a share of its power, half of the rest brakes
        each of its gears against the carrier.
        """
        follows = (duty.gears.key,) if self._parts_apart else ()
        if self.reference is not None:
            inside = ((*self.reference.between, 1.0),)
            return {
                name: loss._replace(brakes=inside, mesh="", follows=follows)
                for name, loss in losses.items()
            }
        mesh = duty.gears
        halves = tuple((body, self.carrier, 0.5) for body in mesh.bodies)
        sliding, own = f"{mesh.key}_sliding", f"{self.key}.{mesh.key}"
        return {
            name: loss._replace(brakes=halves, mesh=own if name == sliding else "", follows=follows)
            for name, loss in losses.items()
        }


def _with_choice(loss: Loss, choice: LossChoice) -> Loss:
    """A loss with the user's choice. Theory (P4)."""
    reason = loss.left_out or ("" if choice.include else "left out by the case")
    if reason:
        return Loss(loss.group, left_out=reason)
    if choice.factor == 1:
        return loss
    return loss._replace(watts=choice.factor * loss.watts, factor=choice.factor)


def _mean_heat(losses: Sequence[Loss]) -> tuple[tuple[str, float], ...]:
    """Shares of the heat of the same loss of all planets together."""
    total = sum(loss.watts for loss in losses)
    if not total:
        return losses[0].heat
    shares = dict.fromkeys((node for node, _ in losses[0].heat), 0.0)
    for loss in losses:
        for node, share in loss.heat:
            shares[node] += share * loss.watts / total
    return tuple(shares.items())


def _widest(branches: Sequence[SomeFlags]) -> tuple[ValidityFlag, ...]:
    """For each model and quantity the flag of the most loaded planet that raises one."""
    flags: dict[tuple[ModelUse, str, str], ValidityFlag] = {}
    for branch in branches:
        for flag in branch:
            flags.setdefault((flag.use, flag.quantity, flag.source), flag)
    return tuple(flags.values())
