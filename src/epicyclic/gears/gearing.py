"""One gear set: its gears, meshes and planets, however its tables are written.

The room of cases makes a `Gearing` from every form that a case has for a set. Gears stand on
bodies; those in `Gearing.planets` turn on pins of the carrier.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Collection, Iterator, Mapping
from functools import cached_property, lru_cache

from epicyclic.dataclass import dataclass, field, replace
from epicyclic.gears.gear import CARRIER, BasicRack, Gear
from epicyclic.gears.mesh import Mesh, closing_number, nearest_places, pin_angle, tip_shortening
from epicyclic.gears.stated import StatedGear, StatedMesh, StatedShared, allowance_shift, half_angle

DEFAULT_RIM_THICKNESS = 3.0
"""Rim of a ring gear from root to outside if the case states none (estimate). [normal modules]"""
RACK_KEYS = (
    ("normal_module", "transverse_module"),
    ("normal_pressure_angle", "transverse_pressure_angle"),
    ("helix_angle",),
)
"""Keys that a gear takes from what all gears share if it has none of them itself."""


@dataclass(frozen=True, slots=True)
class GearPairing:
    """Two gears of a set in mesh."""

    key: str  # Of its results, ``"sun_mesh"``.
    first: str  # The ring gear of an internal mesh is the second.
    second: str
    teeth: tuple[float, float]  # [1]
    internal: bool
    table: StatedMesh
    efficiency: float = 1.0  # As given; 1 if losses are computed. [1]
    pair: tuple[str, str] = ("", "")  # Both gears in the order in which the case lists them.
    title: str = ""  # In sentences: ``"sun mesh"``.
    table_key: str = ""  # Key of its table: ``"sun_mesh"``, ``"mesh.a-b"``.
    own_distance: float | None = None  # Centre distance that its own table states. [m]
    direction: float = 0.0  # From the axis of `pair[0]` to that of `pair[1]`, fixed axes. [rad]


@dataclass(frozen=True, slots=True)
class Pin:
    """Where the pin of a planet stands on its arm of the carrier."""

    radius: float  # From the axis of the set. [m]
    angle: float  # From the middle of the arm, positive in the sense of positive speeds. [rad]

    @property
    def place(self) -> tuple[float, float]:
        """x and y; the arm lies along x. [m]"""
        return self.radius * math.cos(self.angle), self.radius * math.sin(self.angle)


@dataclass(frozen=True, slots=True)
class Arrangement:
    """How the planets stand around the axis."""

    angles: tuple[float, ...]  # Angles of the arms of the carrier. [rad]
    number: int  # Alike planets fit at multiples of a turn over this number; 0: anywhere. [1]
    # True if the gears on one body must be turned against each other from planet to planet.
    individual: bool


@dataclass(frozen=True)
class Gearing:
    """The gears of a set, the bodies on which they stand, and their meshes.

    What follows from its fields is found once, when it is first asked for.
    """

    bodies: Mapping[str, str]  # The body of each gear.
    planets: tuple[str, ...]  # Bodies that stand on the carrier; empty for fixed axes.
    meshes: tuple[GearPairing, ...]
    # The rest is known of sets with computed losses only.
    tables: Mapping[str, StatedGear] = field(default_factory=dict)
    shared: StatedShared | None = None  # What all gears share.
    listed: bool = False  # Gears have names of the user, their tables stand below ``gears``.
    count: int | None = None  # Planets of each kind; None if the case does not say.
    stated_angles: tuple[float, ...] | None = None  # Of the planets, as stated. [rad]
    hand: int = 1  # Of the helix of the first gear, +1 right, where its table does not state it.
    # By the loss that drag is counted as: the central gears that turn in oil and air.
    drags: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    # Torque at the first gear of each mesh over that of a member; empty if it is not determined.
    levers: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    @property
    def members(self) -> tuple[str, ...]:
        """Bodies that shafts can join, the carrier among them."""
        central = [body for body in dict.fromkeys(self.bodies.values()) if body not in self.planets]
        return (*central, CARRIER) if self.planets else tuple(central)

    @property
    def computed(self) -> bool:
        """Losses are computed; else its efficiency is given."""
        return bool(self.tables)

    def key(self, gear: str) -> str:
        """The key of the table of a gear."""
        return f"gears.{gear}" if self.listed else gear

    @property
    def terms(self) -> tuple[str, ...]:
        """Names of the losses of a listed set, in the order in which they are shown."""
        keys = [mesh.key for mesh in self.meshes]
        return (
            *(f"{key}_{kind}" for key in keys for kind in ("sliding", "rolling")),
            *(f"{body}_bearing_{k}" for body in self.planets for k in ("mechanical", "viscous")),
            *(f"{key}_pocketing" for key in keys),
            *self.drags,
            *(("carrier_drag", "planets_drag") if self.planets else ()),
        )

    @property
    def count_key(self) -> str:
        """The key of the number of planets."""
        return "planets" if self.listed else "planet.count"

    @cached_property
    def rack_keys(self) -> dict[str, dict[str, float]]:
        """What is given of each basic rack: keys of the gear, else those that all gears share."""
        found: dict[str, dict[str, float]] = {name: {} for name in self.tables}
        for name, keys in found.items():
            for group in RACK_KEYS:
                for owner in (self.tables[name], self.shared):
                    given = vars(owner)  # gears of a planetary set have none of these keys
                    own = {key: given[key] for key in group if given.get(key) is not None}
                    if own:
                        keys |= own
                        break
        return found

    @cached_property
    def racks(self) -> dict[str, BasicRack]:
        """Module and pressure angle of each gear, from whichever form the case gives."""
        return {gear: basic_rack(**keys) for gear, keys in self.rack_keys.items()}

    def gear(self, name: str) -> Gear:
        """A gear by its name.

        Raises `ValueError` if its thickness is given, or the middle of measuring balls lies, in the
        base circle.
        """
        if name not in self._made:
            assert self.shared is not None
            table, rack = self.tables[name], self.racks[name]
            addendum = self.shared.addendum_coefficient
            if table.tip_diameter is None:
                addendum -= self.tip_shortenings.get(name, 0.0) / rack.normal_module
            dedendum = self.shared.dedendum_coefficient
            self._made[name] = _gear(name, table, rack, addendum, dedendum)
        return self._made[name]

    @cached_property
    def _made(self) -> dict[str, Gear]:
        """Those that `gear` made."""
        return {}

    @cached_property
    def tip_shortenings(self) -> dict[str, float]:
        """By how much each gear is shortened if it has the default tip: as every mesh needs. [m]"""
        found: dict[str, float] = {}
        assert self.shared is not None
        for mesh in self.meshes if self.shared.tip_alteration == "keep-clearance" else ():
            names = (mesh.first, mesh.second)
            rack, distance = self.racks[mesh.first], self.distances[mesh.key]
            modules = (rack.normal_module, self.racks[mesh.second].normal_module)
            if distance is None or not math.isclose(*modules):  # mates of one rack only
                continue
            try:
                shift_sum = sum(map(self._nominal_shift, names))
            except ValueError:  # a thickness that is still missing, or lies in the base circle
                continue
            teeth = int(mesh.teeth[0] + (-1 if mesh.internal else 1) * mesh.teeth[1])
            shortening = tip_shortening(rack, teeth, distance, shift_sum)
            found |= {name: max(shortening, found.get(name, 0.0)) for name in names}
        return found

    def _nominal_shift(self, name: str) -> float:
        """x without allowances; raises `ValueError` if the teeth have no thickness. [1]"""
        table, rack = self.tables[name], self.racks[name]
        if not table.states_thickness:
            raise ValueError(name)
        shift = _gear(name, table, rack, 0.0, 0.0).profile_shift_coefficient
        return shift - allowance_shift(table, rack)

    def rings(self) -> Iterator[tuple[str, StatedGear, Gear]]:
        """Name, table and geometry of every internal gear."""
        for name, table in self.tables.items():
            if table.is_ring:
                yield name, table, self.gear(name)

    def gears_of(self, body: str) -> list[str]:
        """The gears on a body, in the order of the tables."""
        return [gear for gear, own in self.bodies.items() if own == body]

    @cached_property
    def in_order(self) -> list[str]:
        """All gears in the order of the meshes; the order of tables in a file has no meaning."""
        return list(dict.fromkeys(gear for mesh in self.meshes for gear in mesh.pair))

    def distance_key(self, mesh: GearPairing) -> str:
        """The key that states the centre distance of a mesh."""
        assert self.shared is not None
        shared = mesh.own_distance is None and self.shared.center_distance is not None
        table = "gears" if shared or not self.listed else mesh.table_key
        return f"{table}.center_distance"

    @cached_property
    def distances(self) -> dict[str, float | None]:
        """Centre distance of each mesh by its key; None if nothing states it. [m]

        The central gears of a planet share its pin radius: one of its meshes tells it for all.
        """
        assert self.shared is not None
        stated = {it.key: it.own_distance or self.shared.center_distance for it in self.meshes}
        radii = self.pin_radii(stated)
        return {
            mesh.key: stated[mesh.key] or radii.get(self.planet_of(mesh) or "")
            for mesh in self.meshes
        }

    def pin_radii(self, distances: Mapping[str, float | None]) -> dict[str, float]:
        """Distance of the pins of planets from the axis, by their meshes with central gears. [m]"""
        radii: dict[str, float] = {}
        for mesh in self.meshes:
            distance, planet = distances[mesh.key], self.planet_of(mesh)
            if planet is not None and distance is not None:
                radii.setdefault(planet, distance)
        return radii

    def central_gear(self, mesh: GearPairing) -> str | None:
        """The gear of a mesh with a planet that turns about the axis of the set, if it has one."""
        central = [it for it in (mesh.first, mesh.second) if self.bodies[it] not in self.planets]
        return central[0] if len(central) == 1 else None

    def planet_of(self, mesh: GearPairing) -> str | None:
        """The planet of a mesh with a central gear; None for other meshes."""
        if self.central_gear(mesh) is None:
            return None
        bodies = (self.bodies[mesh.first], self.bodies[mesh.second])
        return next(body for body in bodies if body in self.planets)

    def planet_pair(self, mesh: GearPairing) -> tuple[str, str] | None:
        """The bodies of two planets that mesh with each other; None for other meshes."""
        one, two = self.bodies[mesh.first], self.bodies[mesh.second]
        return (one, two) if one in self.planets and two in self.planets else None

    def geometry(self, mesh: GearPairing) -> Mesh:
        """The geometry of a mesh whose centre distance is known."""
        distance = self.distances[mesh.key]
        assert distance is not None
        return _mesh(mesh.title, self.gear(mesh.first), self.gear(mesh.second), distance)

    @cached_property
    def geometries(self) -> tuple[Mesh, ...]:
        """The geometry of every mesh."""
        return tuple(map(self.geometry, self.meshes))

    @cached_property
    def hands(self) -> dict[str, int]:
        """Hand of the helix of each gear, +1 right.

        As stated; mates demand the other of an external and the same of an internal mesh. What
        they leave open is as on the rest of the body, and of the first gear as the set has it.
        """
        gears = self.in_order
        hands = {
            gear: 1 if hand == "right" else -1
            for gear in gears
            if (hand := getattr(self.tables[gear], "hand", None)) is not None
        }
        while len(hands) < len(gears):
            before = len(hands)
            for mesh in self.meshes:
                for known, other in ((mesh.first, mesh.second), (mesh.second, mesh.first)):
                    if known in hands and other not in hands:
                        hands[other] = hands[known] if mesh.internal else -hands[known]
            if len(hands) > before:
                continue
            of_body = {self.bodies[gear]: hand for gear, hand in reversed(hands.items())}
            left = [gear for gear in gears if gear not in hands]
            nearest = next((gear for gear in left if self.bodies[gear] in of_body), left[0])
            hands[nearest] = of_body.get(self.bodies[nearest], self.hand)
        return hands

    @property
    def directions(self) -> dict[str, float]:
        """Angle from the axis of the first to that of the second gear of each mesh. [rad]

        Of fixed axes as stated; of listed planets by the pins on the first arm.
        """
        pins = self.pins if self.listed and self.planets else {}
        directions = {}
        for mesh in self.meshes:
            angle = mesh.direction
            if pins:
                (x, y), (ahead_x, ahead_y) = (
                    pins[body].place if body in pins else (0.0, 0.0)
                    for body in map(self.bodies.__getitem__, mesh.pair)
                )
                angle = math.atan2(ahead_y - y, ahead_x - x)
            directions[mesh.key] = angle if mesh.first == mesh.pair[0] else angle + math.pi
        return directions

    @cached_property
    def positions(self) -> dict[str, float]:
        """Middle of the face of each gear on a planet from the middle of its bearing. [m]

        As stated; else the gears of a body stand side by side in the order of the meshes, the
        bearing in the middle of all.
        """
        positions = {}
        for body in self.planets:
            gears = [gear for gear in self.in_order if self.bodies[gear] == body]
            start = -sum(self.tables[gear].face_width for gear in gears) / 2
            for gear in gears:
                width = self.tables[gear].face_width
                stated = getattr(self.tables[gear], "axial_position", None)
                positions[gear] = start + width / 2 if stated is None else stated
                start += width
        return positions

    @cached_property
    def pins(self) -> dict[str, Pin]:
        """Where the pins stand on an arm of the carrier, by the bodies of planets. Theory (A4).

        The central gears of a planet give the radius of its pin; two planets that mesh with each
        other the angle between their pins: the second of a listed pair stands ahead of the first in
        the sense of positive speeds. A planet without a central gear has no place that this would
        determine, and is left out. Raises `ValueError` if two pins cannot stand at the distance of
        their planets.
        """
        distances = self.distances
        radii = self.pin_radii(distances)
        between: dict[tuple[str, str], float] = {}
        for mesh in self.meshes:
            one, two = (self.bodies[gear] for gear in mesh.pair)
            distance = distances[mesh.key]
            if one in radii and two in radii and distance is not None:
                angle = pin_angle(radii[one], radii[two], distance)
                between[one, two], between[two, one] = angle, -angle
        pins: dict[str, Pin] = {}
        for start in radii:
            found = [start] if start not in pins else []
            pins.setdefault(start, Pin(radii[start], 0.0))
            while found:
                known = found.pop(0)
                for (one, two), angle in between.items():
                    if one == known and two not in pins:
                        pins[two] = Pin(radii[two], pins[known].angle + angle)
                        found.append(two)
        return pins

    @cached_property
    def centers(self) -> dict[str, tuple[complex, ...]]:
        """Where each body stands in the plane across the axes, planets several times. [m]

        Of fixed axes from the first body; of planets, the first arm upwards, from the axis of the
        set. Bodies whose places the case does not tell are left out.
        """
        found: dict[str, tuple[complex, ...]]
        if self.planets:
            arms = self.arrangement.angles
            found = dict.fromkeys(self.members, (0j,))
            for body, pin in self.pins.items():
                turns = (math.pi / 2 + arm + pin.angle for arm in arms)
                found[body] = tuple(cmath.rect(pin.radius, turn) for turn in turns)
            return found
        directions = self.directions
        found = {self.bodies[self.meshes[0].first]: (0j,)}
        before = 0
        while len(found) > before:
            before = len(found)
            for mesh, geometry in zip(self.meshes, self.geometries, strict=True):
                one, two = self.bodies[mesh.first], self.bodies[mesh.second]
                step = cmath.rect(geometry.center_distance, directions[mesh.key])
                if one in found:
                    found.setdefault(two, (found[one][0] + step,))
                elif two in found:
                    found[one] = (found[two][0] - step,)
        return found

    @cached_property
    def arrangement(self) -> Arrangement:
        """The arms of the carrier: as stated, else equally spaced if possible. Theory (A7).

        Planets whose gears stand alike on their bodies are preferred to such that are made one by
        one, and these to unequal spacing.
        """
        planets = self.count or 1
        number = self._closing_number(self.bodies)
        if self.stated_angles is not None:
            return Arrangement(self.stated_angles, number, individual=False)
        if number % planets == 0:
            return Arrangement(nearest_places(planets, number), number, individual=False)
        single = self._closing_number({gear: gear for gear in self.bodies})
        individual = single % planets == 0
        places = nearest_places(planets, single if individual else number)
        return Arrangement(places, number, individual)

    @property
    def planet_angles(self) -> tuple[float, ...]:
        """Where the planets stand around the axis; empty without planets. [rad]"""
        return self.arrangement.angles if self.planets and self.count else ()

    def _closing_number(self, owners: Mapping[str, str]) -> int:
        """Teeth on planets by `owners` of gears, and of the central gear, for `closing_number`."""
        closures = []
        for mesh in self.meshes:
            central = self.central_gear(mesh)
            teeth = dict(zip((mesh.first, mesh.second), map(int, mesh.teeth), strict=True))
            turned = 0 if central is None else teeth.pop(central)
            owned = {owners[gear]: count for gear, count in teeth.items()}
            closures.append((owned, -turned if mesh.internal else turned))
        return closing_number(closures)

    def only(self, gears: Collection[str]) -> Gearing:
        """Some of its gears, and the meshes between them; planets have no number."""
        return replace(
            self,
            bodies={gear: body for gear, body in self.bodies.items() if gear in gears},
            meshes=tuple(it for it in self.meshes if {it.first, it.second} <= {*gears}),
            tables={gear: table for gear, table in self.tables.items() if gear in gears},
            count=None,
            stated_angles=None,
        )

    def changed(
        self,
        tables: Mapping[str, StatedGear],
        shared: StatedShared,
        distances: Mapping[str, float],  # By the keys of meshes that have one of their own. [m]
    ) -> Gearing:
        """The gearing with other tables and centre distances."""
        meshes = tuple(
            replace(mesh, own_distance=distances.get(mesh.key, mesh.own_distance))
            for mesh in self.meshes
        )
        return replace(self, tables=tables, shared=shared, meshes=meshes)


def outward_of(
    pins: Mapping[str, Pin],
    planet: str,
    mate: str | None,  # The body of another planet; None for a central gear.
) -> tuple[float, float]:
    """Unit vector along t and r from the pitch point with an external mate to a planet's axis.

    Theory (A5). For t and r see `epicyclic.machine.planets`.
    """
    if mate is None:
        return 0.0, 1.0
    own = pins[planet]
    x, y = (a - b for a, b in zip(own.place, pins[mate].place, strict=True))
    length = math.hypot(x, y)
    sine, cosine = math.sin(own.angle), math.cos(own.angle)
    return (x * sine - y * cosine) / length, (x * cosine + y * sine) / length


def basic_rack(
    helix_angle: float,  # [rad]
    normal_module: float = 0.0,  # One of both modules. [m]
    transverse_module: float | None = None,
    normal_pressure_angle: float = 0.0,  # One of both angles. [rad]
    transverse_pressure_angle: float | None = None,
) -> BasicRack:
    """The basic rack in its transverse section. ISO 21771."""
    cosine = math.cos(helix_angle)
    if transverse_module is None:
        transverse_module = normal_module / cosine
    if transverse_pressure_angle is None:
        transverse_pressure_angle = math.atan(math.tan(normal_pressure_angle) / cosine)
    return BasicRack(transverse_module, transverse_pressure_angle, helix_angle)


@lru_cache(maxsize=512)
def _gear(name: str, table: StatedGear, rack: BasicRack, addendum: float, dedendum: float) -> Gear:
    internal = table.is_ring
    half = half_angle(table, rack, internal=internal)
    # tip and root that the basic rack of ISO 53 would give (ISO 21771, Eq. 38 and 41)
    probe = Gear(name, rack, table.teeth, internal, half, 0.0, 0.0, table.face_width)
    outward = -1 if internal else 1
    shift = probe.profile_shift_coefficient
    nominal = shift - allowance_shift(table, rack)
    tip = probe.reference_radius + outward * rack.normal_module * (nominal + addendum)
    root = probe.reference_radius + outward * rack.normal_module * (shift - dedendum)
    return Gear(
        name=name,
        rack=rack,
        teeth=table.teeth,
        internal=internal,
        thickness_half_angle=half,
        tip_radius=tip if table.tip_diameter is None else table.tip_diameter / 2,
        root_radius=root if table.root_diameter is None else table.root_diameter / 2,
        face_width=table.face_width,
        tip_chamfer=table.tip_chamfer,
    )


_mesh = lru_cache(maxsize=512)(Mesh)
"""One object for each mesh, which keeps what it has computed of itself."""


def rim_thickness(table: StatedGear) -> float | None:
    """Rim of a ring gear from root to outside; None if the case states none. [m]"""
    return getattr(table, "rim_thickness", None)


def outside_radius(gear: Gear, table: StatedGear) -> float:
    """Radius of the outside of a gear as a rotating body: tip circle, or back of the rim. [m]"""
    if not gear.internal:
        return gear.tip_radius
    rim = rim_thickness(table)
    return gear.root_radius + (
        DEFAULT_RIM_THICKNESS * gear.rack.normal_module if rim is None else rim
    )
