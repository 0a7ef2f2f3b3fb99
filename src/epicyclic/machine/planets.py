"""Planets: their shares of the load, their tilt, their roller bearings and plain pins."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache, partial

import numpy as np

from epicyclic.arrays import (
    TINY,
    Alone,
    AtOnce,
    FloatArray,
    Points,
    either,
    hypot,
    larger,
    most,
    phase,
    total,
)
from epicyclic.contact.planet_sharing import (
    Branches,
    branch_directions,
    closed_form_branch_forces,
    mesh_load_factor_shares,
    solve_branch_forces,
)
from epicyclic.dataclass import dataclass, replace
from epicyclic.kernels.line_contact import hertz_half_width, hertz_pressure
from epicyclic.losses.designations import DesignatedBearing
from epicyclic.losses.drag import (
    VISCOUS_METHOD,
    VISCOUS_SOURCE,
    bearing_viscous_loss,
    viscous_flags,
)
from epicyclic.losses.journal_bearing import (
    JournalBearing,
    JournalState,
    journal_flags,
    solve_journal,
)
from epicyclic.losses.planet_bearing import (
    FULL_COMPLEMENT,
    BearingLoss,
    RollerBearing,
    RollerLoads,
    Rubbing,
    centrifugal_forces,
    fitted_rolling_loss,
    mixed_ehl_rolling_loss,
    palmgren_flags,
    palmgren_loss,
    pressed_alone,
    radial_stiffness,
    roller_loads,
    roller_loads_next_to,
    rubbing,
    tilting_moments,
)
from epicyclic.losses.ranges import BearingType, Cage, Flags, Sought
from epicyclic.losses.rolling import FittedRolling
from epicyclic.losses.shaft_bearing import (
    CatalogueBearing,
    limit_text,
    limiting_speed,
    minimum_load,
    thermal_excess,
    thermal_speed_rating,
)
from epicyclic.machine.convection import oil_heat_capacity, roller_conductance
from epicyclic.machine.element import (
    LOAD_DEPENDENT,
    LOAD_INDEPENDENT,
    ElementResult,
    Extremes,
    Figures,
    Loss,
    Note,
    PartFigures,
    figure,
)
from epicyclic.machine.gear_mesh import MeshDuty, elastic_loads
from epicyclic.oil.oil import OilState
from epicyclic.units import (
    CELSIUS,
    DEGREE,
    GIGAPASCAL,
    MICROMETRE,
    MILLIMETRE,
    NEWTON,
    NEWTON_METRE,
    NUMBER,
    RPM,
    WATT,
    WATT_PER_KELVIN,
    format_number,
    percent,
)

# The share of the load that each planet of a set carries.


SHARE_DIGITS = 12  # Decimals of a share, so that planets that carry alike are solved once. [1]
SHARING_METHODS = {
    "equal": ("equal loads", ""),
    "mesh-load-factor": ("one planet overloaded by a given factor", "ISO 6336-1"),
    "closed-form": (
        "closed form for equally spaced planets",
        "T. Ligata, A. Kahraman, A. Singh, J. Mech. Des. 131 (2009) 021007",
    ),
    "direct": (
        "elastic branches between rigid members",
        "T. Ligata, A. Kahraman, A. Singh, J. Mech. Des. 131 (2009) 021007",
    ),
}
"""What each method of load sharing is, and its source."""


@dataclass(frozen=True, slots=True)
class LoadSharing:
    """How the planets of a set share the load."""

    # A key of `SHARING_METHODS`; the last two are for a sun, a ring and planets between them.
    method: str
    mesh_load_factor: float  # K_gamma: load of the most loaded planet over the mean. [1]
    angles: tuple[float, ...]  # Positions of the planets. [rad]
    # Error of each pin, against the sense in which a positive torque of the sun pushes it. [m]
    position_errors: tuple[float, ...]
    floating_member: str  # The member that gives way, or ``"none"``.
    support_stiffness: float  # Radial, of that member. [N/m]
    pin_stiffness: float | None  # Radial, of one pin; None: rigid. [N/m]

    @property
    def whatever_the_load(self) -> bool:
        """True if the shares do not depend on the load."""
        return self.method in ("equal", "mesh-load-factor") or len(self.angles) == 1


def planet_shares(
    sharing: LoadSharing,
    # The meshes of a planet under the mean load, that of the sun first.
    duties: tuple[MeshDuty, ...],
    bearing: RollerBearing | None,  # Bearing of one planet; None: rigid.
) -> tuple[float, ...]:
    """Share of the load that each planet carries; their sum is 1. Theory (S1).

    The closed form holds while all planets carry; where one does not, (S3) and (S4) are solved.
    Raises `ConvergenceError` if no loads of the planets balance.
    """
    count = len(sharing.angles)
    if sharing.method == "mesh-load-factor":
        return mesh_load_factor_shares(count, sharing.mesh_load_factor)
    idle = not all(duty.torque1 for duty in duties)
    if sharing.whatever_the_load or idle:
        return (1 / count,) * count
    branches = _branches(sharing, duties, bearing)
    floats = sharing.floating_member != "none"
    force = count * duties[0].force
    if sharing.method == "closed-form":
        forces = closed_form_branch_forces(force, branches, floating=floats)
    if sharing.method == "direct" or forces.min() < 0:
        sun_mesh, ring_mesh = duties
        directions = branch_directions(
            branches.angles,
            sun_mesh.gears.mesh.operating_pressure_angle,
            ring_mesh.gears.mesh.operating_pressure_angle,
        )
        supports = {sharing.floating_member: sharing.support_stiffness} if floats else {}
        forces = solve_branch_forces(force, branches, directions, supports)
    return tuple(float(share) for share in np.round(forces / forces.sum(), SHARE_DIGITS))


def _branches(
    sharing: LoadSharing, duties: tuple[MeshDuty, ...], bearing: RollerBearing | None
) -> Branches:
    """The branches of all planets. Theory (S6)."""
    sun_mesh = duties[0]
    # the branch force reaches the pin through both meshes
    through_pin = sum(math.cos(duty.gears.mesh.operating_pressure_angle) for duty in duties)
    pin_force = through_pin * sun_mesh.force
    pin_compliance = 0.0 if bearing is None else 1 / radial_stiffness(bearing, pin_force)
    if sharing.pin_stiffness is not None:
        pin_compliance += 1 / sharing.pin_stiffness
    # slope of the transmission error over the force, mean of the mesh period [m/N]
    loaded = [elastic_loads(duty) for duty in duties]
    compliance = sum(one.mean(1 / one.tangent_stiffness) for one in loaded)
    errors = np.array(sharing.position_errors or np.zeros(len(sharing.angles)))
    return Branches(
        np.array(sharing.angles),
        compliance + through_pin**2 * pin_compliance,
        math.copysign(through_pin, sun_mesh.torque1) * errors,
    )


# The load of a planet on its bearing, and how the planet tilts under it.
#
# Axes, right-handed: t along the circle of the planets; r outward from the centre of the set; y
# along the planet's axis, from the middle of the bearing. They are turned about r so that the first
# mesh turns the planet from t to r: for a sun, t is then the sense in which it pushes the planet.

TILT_TOLERANCE = 1e-9
"""Imbalance over the tilt at which the latter counts as found: under next to no load, teeth give
way by less than a thousandth of what the planet moves in its play. [1]"""
SMALL_TILT = 1e-6
"""A tilt as small as this counts as that size in `TILT_TOLERANCE`: 0.02 um across 20 mm. [rad]"""
NEWTON_MOST = 40
FLATTER = 0.5  # Slope of the energy at the end of a step over that at its start, at most. [1]
SLOPE = 1e-4  # Step of differences, over the size of the tilt. [1]


@dataclass(frozen=True, slots=True)
class PlanetLoad:
    """Load of one planet on its bearing, x along the radial force."""

    pointwise = True

    force: float  # Radial. [N]
    moment_x: float  # Tilting moment in the plane of the axis and x. [N m]
    moment_y: float  # The same in that of the axis and y. [N m]
    # Azimuth of the way outward from the axis of the set, from the most loaded rollers. [rad]
    outward: float = 0.0


@dataclass(frozen=True, slots=True)
class PlanetContact:
    """A mesh that loads a planet. Theory (A1)."""

    duty: MeshDuty
    member: int  # Which of its gears sits on the planet, 1 or 2.
    # Unit vector t + i r from the pitch point to the axis of the planet: the sense in which the
    # radial force of the mesh pushes the planet.
    outward: complex
    sense: int  # +1 if the mesh turns the planet from t to r, else -1.
    hand: int = 1  # +1 if a positive `sense` pushes the planet along y, else -1.
    position: float = 0.0  # Position of the middle of the face, along y. [m]

    @property
    def face_sense(self) -> int:
        """+1 if y points to the end of the face where contact ends, else -1. Theory (A3).

        That end is the one towards which the mesh pushes its second gear.
        """
        return self.hand * self.sense * (1 if self.member == 2 else -1)

    @property
    def direction(self) -> complex:
        """Unit vector of the transverse force on the planet, t + i r."""
        angle = self.duty.gears.mesh.operating_pressure_angle
        # its arm is -outward, and z x is i times
        return self.outward * (math.sin(angle) - 1j * self.sense * math.cos(angle))

    @property
    def axial_force(self) -> float:
        """Axial force of the mesh on the planet, along y. [N]"""
        mesh = self.duty.gears.mesh
        tangential = abs(self.duty.torque1) / mesh.operating_radius1
        return self.hand * self.sense * tangential * mesh.operating_helix_tangent


Contacts = Sequence[PlanetContact]


def planet_load(
    contacts: Contacts,
    centrifugal: float,  # [N]
    # Moments of the transverse force of each mesh about the middle of its face. [N m]
    mesh_moments: Sequence[float] = (),
) -> PlanetLoad:
    """Load on the bearing of a planet from all its meshes and the centrifugal force.

    Theory (A2), (B1), (B2), (B17). Talbot (2012), Eq. 3.7 and 3.8, for any number of meshes and any
    pressure angles: the transverse forces add as vectors, the axial ones form couples in the planes
    of the axes, and a force beside the middle of the bearing a moment.
    """
    moment = 0j  # t + i r
    for contact, own in zip(contacts, mesh_moments or [0.0] * len(contacts), strict=True):
        lever = own + contact.position * contact.duty.force
        moment += lever * contact.direction
        mesh = contact.duty.gears.mesh
        radius = mesh.operating_radius1 if contact.member == 1 else mesh.operating_radius2
        couple = contact.axial_force * radius  # operating radius of the planet in this mesh
        moment += couple * contact.outward
    force = radial_force(contacts, centrifugal)
    turned = moment * abs(force) / force if force else moment
    # the bore of a pushed planet meets its pin on the other side: those rollers carry
    outward = math.pi / 2 - phase(-force)
    return PlanetLoad(abs(force), turned.real, turned.imag, outward)


def radial_force(contacts: Contacts, centrifugal: float) -> complex:
    """Force of all meshes and of rotation on the planet, t + i r. [N]"""
    return sum((contact.duty.force * contact.direction for contact in contacts), 1j * centrifugal)


def _axes(force: complex) -> tuple[FloatArray, FloatArray]:
    """Unit vectors along the radial force and at right angles to it, in t and r."""
    turn = cmath.phase(force)
    along = np.array([math.cos(turn), math.sin(turn)])
    return along, np.array([-along[1], along[0]])


def tilt_planet(
    contacts: Contacts, bearing: RollerBearing, centrifugal: float
) -> tuple[Contacts, PlanetLoad]:
    """Meshes misaligned by the tilt of the planet in its bearing, and the load that belongs to it.

    Theory (B17), (B18). The tilt opens one end of each mesh, the load moves to the other end, and
    its moment tilts the planet back. Carrier and pin are rigid; the bearing stands under the middle
    of the face. Raises `ConvergenceError` if the load of a mesh or of the bearing is not found.
    """
    from scipy.optimize import root

    tilt = _tilt_under(planet_load(contacts, centrifugal), contacts, bearing, centrifugal)
    scale = max(math.hypot(*tilt), SMALL_TILT)

    def imbalance(scaled: FloatArray) -> FloatArray:
        load = _load_at(scaled * scale, contacts, centrifugal)
        return scaled - _tilt_under(load, contacts, bearing, centrifugal) / scale

    found = root(imbalance, tilt / scale, method="hybr", tol=TILT_TOLERANCE / 10)
    if np.abs(found.fun).max() <= TILT_TOLERANCE:
        tilt = found.x * scale
        return _misaligned(contacts, tilt), _load_at(tilt, contacts, centrifugal)
    axes = np.array(_axes(radial_force(contacts, centrifugal)))
    excess = _excess(contacts, bearing, centrifugal)
    reach = (bearing.diametral_clearance + bearing.crown_drop) / bearing.half_width + SMALL_TILT
    tilts = _tilt_by_newton(excess, reach)
    tilt = (_tilt_one_by_one(excess, reach) if tilts is None else tilts) @ axes
    return _misaligned(contacts, tilt), _load_at(tilt, contacts, centrifugal)


def _excess(
    contacts: Contacts, bearing: RollerBearing, centrifugal: float
) -> Callable[[FloatArray], FloatArray]:
    """Moments with which the bearing holds a tilt less those of the planet. [N m]

    In the planes of the axis and the radial force, and at right angles to it; both rise with the
    tilt in that plane.
    """
    force = radial_force(contacts, centrifugal)
    axes = np.array(_axes(force))
    size = abs(force)

    def excess(tilts: FloatArray) -> FloatArray:
        load = _load_at(tilts @ axes, contacts, centrifugal)
        holding = tilting_moments(bearing, size, *map(float, tilts))
        return np.array(holding) - (load.moment_x, load.moment_y)

    return excess


def _tilt_by_newton(excess: Callable[[FloatArray], FloatArray], reach: float) -> FloatArray | None:
    """Where both excesses are zero; None if Newton's method does not get there. [rad]

    What resists a tilt stores energy, whose slopes the excesses are and which has one minimum.
    Along each of Newton's directions the step ends where the energy falls far less steeply. A
    stiffness with which the excess would tilt the planet by `reach` is added, so that steps stay
    bounded in a play, where nothing resists.
    """
    tilts: FloatArray = np.zeros(2)
    found = excess(tilts)
    for _ in range(NEWTON_MOST):
        if not found.any():
            return tilts
        size = max(float(np.abs(tilts).max()), SMALL_TILT)
        slope = np.column_stack(
            [(excess(tilts + apart) - found) / (SLOPE * size) for apart in SLOPE * size * np.eye(2)]
        )
        slope += float(np.hypot(*found)) / reach * np.eye(2)
        step = np.asarray(np.linalg.solve(slope, -found), dtype=np.float64)
        if not found @ step < 0:  # the slopes there are but errors of their differences
            step = -found * (reach / float(np.hypot(*found)))
        elif np.abs(step).max() <= TILT_TOLERANCE * size:
            return tilts + step
        ahead = _down(excess, tilts, step, found)
        if ahead is None:
            return None
        tilts, found = ahead
    return None


def _down(
    excess: Callable[[FloatArray], FloatArray],
    tilts: FloatArray,
    step: FloatArray,
    found: FloatArray,
) -> tuple[FloatArray, FloatArray] | None:
    """Tilts ahead along a step, and their excesses; None if the energy does not fall that way.

    The slope of the energy there is at most `FLATTER` of that at the start.
    """
    start = float(found @ step)
    near, near_slope, far, far_slope = 0.0, start, math.inf, math.inf
    share = 1.0
    for _ in range(NEWTON_MOST):
        ahead = excess(tilts + share * step)
        along = float(ahead @ step)
        if abs(along) <= -FLATTER * start:
            return tilts + share * step, ahead
        if along < 0:
            near, near_slope = share, along
        else:
            far, far_slope = share, along
        if math.isinf(far):
            share *= 2
        else:
            secant = near + (far - near) * near_slope / (near_slope - far_slope)
            margin = (far - near) / 10
            share = min(max(secant, near + margin), far - margin)
    return None


def _tilt_one_by_one(excess: Callable[[FloatArray], FloatArray], reach: float) -> FloatArray:
    """Where both excesses are zero, each component in a bracket of its own. [rad]

    What is left where Newton's method ends without a result, ten times slower: bearing and meshes
    resist the more the farther the planet tilts, so that for any tilt in one plane there is one in
    the other.
    """

    def first(second: float) -> float:
        return _rising_root(lambda tilt: excess(np.array([tilt, second]))[0], reach)

    second = _rising_root(lambda tilt: excess(np.array([first(tilt), tilt]))[1], reach)
    return np.array([first(second), second])


def _rising_root(rising: Callable[[float], float], reach: float) -> float:
    """Where a rising function is zero, from -`reach` to `reach` or beyond."""
    from scipy.optimize import brentq

    while rising(-reach) > 0 or rising(reach) < 0:
        reach *= 2
    return float(brentq(rising, -reach, reach, xtol=TILT_TOLERANCE * SMALL_TILT))


def _misaligned(contacts: Contacts, tilt: FloatArray) -> Contacts:
    """The meshes with a planet tilted by `tilt` in t and r. Theory (B18)."""
    return [
        replace(
            contact,
            duty=contact.duty.misaligned(
                contact.face_sense
                * contact.duty.gears.mesh.face_width
                * float(tilt @ (contact.direction.real, contact.direction.imag))
            ),
        )
        for contact in contacts
    ]


def _load_at(tilt: FloatArray, contacts: Contacts, centrifugal: float) -> PlanetLoad:
    """Load of a planet tilted by `tilt`."""
    moments = [
        contact.face_sense * _mesh_moment(contact.duty) for contact in _misaligned(contacts, tilt)
    ]
    return planet_load(contacts, centrifugal, moments)


def _mesh_moment(duty: MeshDuty) -> float:
    """Moment of the transverse force of a mesh about the middle of its face. Theory (B17). [N m]"""
    if duty.torque1 == 0:
        return 0.0
    loaded = elastic_loads(duty)
    lines = loaded.compliance.lines
    height = lines.face_position - duty.gears.mesh.face_width / 2
    moments = (loaded.line_load * lines.length * height).sum(axis=(1, 2))
    return loaded.mean(moments) * math.cos(duty.gears.mesh.gear1.rack.base_helix_angle)


def _tilt_under(
    load: PlanetLoad, contacts: Contacts, bearing: RollerBearing, centrifugal: float
) -> FloatArray:
    """Tilt of the planet under `load`, in t and r. [rad]"""
    loads = roller_loads(bearing, load.force, 0.0, load.moment_x, load.moment_y)
    along, across = _axes(radial_force(contacts, centrifugal))
    tilt: FloatArray = loads.displacement[2] * along + loads.displacement[3] * across
    return tilt


# The roller bearing between a planet and its pin.

BEARING_METHOD = "mixed-EHL rolling-loss regression, slice by slice"
BEARING_SOURCE = "D. C. Talbot, PhD dissertation, Ohio State (2012), Eq. 3.2 to 3.6"
PALMGREN_METHOD = "friction coefficient f1 of Palmgren"
PALMGREN_SOURCE = "A. Palmgren, Ball and Roller Bearing Engineering (1959); Talbot (2012), Eq. 3.1"


@dataclass(frozen=True, slots=True)
class PlanetBearing:
    """A planet bearing and the models of its losses."""

    pointwise = True

    bearing: RollerBearing
    # ``"mixed-ehl"``, ``"palmgren"``, or a loss fitted to simulated contacts.
    model: str | FittedRolling
    palmgren_coefficient: float  # f1. [1]
    viscous_factor: float  # f0 of the whole bearing. [1]
    conductivity: float  # Thermal, of races and rollers. [W/(m K)]
    oil_held: bool = True  # False to continue the model mixed-ehl beyond its oil.
    # True if Palmgren's coefficient takes over where a fitted loss was not simulated.
    palmgren_beyond: bool = False
    roller_density: float = 7850.0  # [kg/m^3]
    aligns_itself: bool = False  # True if it takes no moment.
    cage: Cage = "caged"
    limiting_speed: float | None = None  # None for that of the type. [rad/s]
    viscous_added: bool = False  # True if (V1) is added to rolling losses, as by Talbot.

    @property
    def method(self) -> tuple[str, str]:
        """How the load-dependent loss is found, and where that is printed."""
        if isinstance(self.model, FittedRolling):
            title, source = self.model.title, self.model.source
            if self.palmgren_beyond:
                title += f"; outside their range {PALMGREN_METHOD}"
                source += f"; {PALMGREN_SOURCE}"
            return title, source
        if self.model == "mixed-ehl":
            return BEARING_METHOD, BEARING_SOURCE
        if self.model == FULL_COMPLEMENT:
            return f"{BEARING_METHOD}, and sliding of rollers without a cage", BEARING_SOURCE
        return PALMGREN_METHOD, PALMGREN_SOURCE


@dataclass(frozen=True, slots=True, eq=False)
class BearingFigures:
    """What an engineer checks by eye on the planet bearing.

    `flattening` and `resistance` as of `MeshFigures`, the latter at the speed of the pitch circle.
    """

    pointwise = True

    loads: RollerLoads | None
    flattening: float
    resistance: float
    radial_force: float = figure("radial force", NEWTON)
    moment: float = figure("tilting moment", NEWTON_METRE)
    speed: float = figure("speed relative to carrier", RPM)
    rollers_loaded: float = figure("loaded rollers, all rows", NUMBER)
    roller_load_max: float = figure("most loaded roller", NEWTON)
    roller_azimuth: float = figure("azimuth of that roller from the load", DEGREE)
    hertz_pressure_max: float = figure("largest Hertz pressure, inner race", GIGAPASCAL)
    contact_temperature: float = figure("oil temperature at the contact inlet", CELSIUS)
    heat_conductance: float = figure("heat from race to race through the rollers", WATT_PER_KELVIN)


BENT_SLICES = 5.0
"""`BENT` of rollers whose slices leave the range of a formula, or their race, one by one. [1]"""
Carried = RollerLoads | JournalState | None
"""What the bearing of a planet carried in the last pass."""


@dataclass(frozen=True, slots=True)
class BearingResult(ElementResult):
    """Losses of the planet bearings, and the figures of one of them."""

    loads: Carried = None  # On its rollers or film: what the next pass goes on from.


ROLLER_FRICTION = 0.0003, 0.002
"""f1 of caged rollers, and the largest of catalogues of needle bearings. Theory (B16). [1]"""
MISSING_PITCH = 0.5
"""Pitch diameter of rollers that are not known, over that of the planet's teeth; assumed. [1]"""
MAY_LOSE = "not given; its rollers may lose"
"""In the note on what a missing planet bearing may cost."""


def missing_bearing(
    key: str,
    reason: str,
    force: float,  # On the bearings of all planets. [N]
    diameter: float,  # Of the teeth of the planet. [m]
    speed: float,  # Against the carrier. [rad/s]
) -> BearingResult:
    """The losses of a bearing that is not there, with a note on what rollers may lose (B16)."""
    low, high = ROLLER_FRICTION
    power = force * MISSING_PITCH * diameter * abs(speed)
    if isinstance(power, Points):
        raise Alone(len(power))
    most = high * power
    text = (
        f"{key.replace('_', ' ')}: {MAY_LOSE} {format_number(low * power, 2)} to "
        f"{WATT.text(most, 2)}, which the band does not contain. By Palmgren, f1 = {low:g} to "
        f"{high:g}, on a pitch diameter of {percent(MISSING_PITCH, 0)} of that of the planet."
    )
    return BearingResult(
        {
            f"{key}_mechanical": Loss(LOAD_DEPENDENT, left_out=reason),
            f"{key}_viscous": Loss(LOAD_INDEPENDENT, left_out=reason),
        },
        notes=(Note(text, most),) if most else (),
    )


def solve_bearing(
    key: str,  # First word of the losses, ``"planet_bearing"``.
    own: PlanetBearing,
    load: PlanetLoad,  # Load of each of them.
    count: int,
    oil: OilState,
    speed: float,  # Speed of the planet against the carrier. [rad/s]
    last: Carried = None,  # Under nearly this load, which saves work.
    pin_radius: float = 0.0,  # From the axis of the set to that of the planet. [m]
    carrier: float = 0.0,  # Speed of the carrier. [rad/s]
    loaded: bool = True,  # False if no mesh carries torque.
) -> BearingResult:
    """Losses of `count` planet bearings under the same load. Theory (B24)."""
    bearing, where = own.bearing, key.replace("_", " ")
    if own.aligns_itself:
        load = PlanetLoad(load.force, 0.0, 0.0, load.outward)
    moments = load.moment_x, load.moment_y
    if isinstance(last, RollerLoads):
        loads = roller_loads_next_to(bearing, last, load.force, *moments)
    else:  # those of several points are not kept
        find = roller_loads.__wrapped__ if isinstance(load.force, Points) else roller_loads
        loads = find(bearing, load.force, 0.0, *moments)
    loss = _by_load(own, loads, load.force, speed, oil)
    viscous_loss = bearing_viscous_loss(
        own.viscous_factor, oil.kinematic_viscosity, speed, bearing.pitch_diameter
    )
    forces = centrifugal_forces(
        bearing, loads.azimuth, own.roller_density, pin_radius, carrier, speed, load.outward
    )
    alone = pressed_alone(loads, forces, bearing.roller_length)
    held = total(alone.intensity) * bearing.roller_length
    watts = loss.loss
    notes: tuple[str, ...] = ()
    if held:  # on one race each, by slices as long as the roller
        found = _by_load(own, alone, held / bearing.slices, speed, oil, alone=True)
        watts += found.loss * bearing.slices / 2
    if not own.viscous_added:
        watts = larger(0.0, watts - loss.rolling * viscous_loss)
    if own.model == FULL_COMPLEMENT:
        if isinstance(load.force, Points):
            raise Alone
        pull = bearing.roller_mass(own.roller_density) * pin_radius * carrier**2
        rubbed = rubbing(bearing, loads, speed, oil, pull, load.outward)
        watts += rubbed.between + rubbed.skewed
        notes = (_rubbing_note(where, rubbed),)
    carried = load.force if loaded else math.inf
    limits = partial(_limit_notes, where, own, carried, abs(speed), watts)
    figures = AtOnce(_bearing_figures, own, loads, load, speed, oil, watts)
    idle = speed, bearing.pitch_diameter, oil.dynamic_viscosity
    return BearingResult(
        {
            f"{key}_mechanical": Loss(LOAD_DEPENDENT, count * watts, *own.method, bent=BENT_SLICES),
            f"{key}_viscous": Loss(
                LOAD_INDEPENDENT, count * viscous_loss, VISCOUS_METHOD, VISCOUS_SOURCE
            ),
        },
        Figures({key: figures}),
        loss.flags + Flags(partial(viscous_flags, where, *idle)),
        Sought(notes.__iter__, limits),
        extremes=Figures({key: AtOnce(_bearing_extremes, own, loads, speed, watts)}),
        loads=loads,
    )


def _rubbing_note(where: str, rubbed: Rubbing) -> Note:
    touch = f"{rubbed.touching} pairs of them touch with up to {NEWTON.text(rubbed.force, 3)}"
    return Note(
        f"{where}: rollers without a cage have {MILLIMETRE.text(rubbed.play, 3)} of play in a row; "
        f"{touch if rubbed.touching else 'none touch'} and lose {WATT.text(rubbed.between, 3)}; "
        f"skewed by up to {DEGREE.text(rubbed.skew, 2)}, the most that the play allows, they lose "
        f"{WATT.text(rubbed.skewed, 3)}. Both are of one planet and contained in its loss."
    )


@lru_cache(maxsize=64)
def rated(
    bearing: RollerBearing, aligns_itself: bool = False, cage: Cage = "caged"
) -> CatalogueBearing:
    """A planet bearing between pin and race of the planet with the ratings of its rollers.

    Cylindrical ones count as needles. Theory (J27), (J28).
    """
    sizes = bearing.inner_diameter, bearing.outer_diameter, 2 * bearing.half_width
    kind: BearingType = "spherical" if aligns_itself else "needle"
    rollers = DesignatedBearing(
        "",
        kind,
        *sizes,
        rows=bearing.rows,
        pitch_diameter=bearing.pitch_diameter,
        element_diameter=bearing.roller_diameter,
        element_length=bearing.roller_length,
        elements=bearing.rollers_per_row,
    )
    ratings = rollers.dynamic_load_rating, rollers.static_load_rating
    return CatalogueBearing(kind, *sizes, "caged" if aligns_itself else cage, *ratings)


def _limit_notes(
    where: str,
    own: PlanetBearing,
    force: float,
    speed: float,  # Not negative. [rad/s]
    watts: float,
) -> Iterator[Note]:
    known = rated(own.bearing, own.aligns_itself, own.cage)
    share = "0.01 C0" if known.type == "spherical" else "0.02 C"
    least = minimum_load(known, 0.0, 0.0)
    if speed and force < least:
        text = (
            f"{where}: the load of {NEWTON.text(force, 3)} is below the minimum load of "
            f"{NEWTON.text(least, 3)}, {share} by its rollers (SKF, second hand). They may slip; "
            "the loss is that of the actual load without slip."
        )
        yield Note(text, watts)
    if thermal_excess(known, speed) > 0:
        rating = thermal_speed_rating(known)
        text = (
            f"{where}: {RPM.text(speed, 4)} against the carrier exceed the thermal reference "
            f"speed of {RPM.text(rating, 2)}, an estimate after ISO 15312 by its rollers. Above it "
            "the bearing needs oil that cools it."
        )
        yield Note(text, watts)
    limit = own.limiting_speed or limiting_speed(known)
    if speed > limit:
        told = limit_text(speed, limit, own.limiting_speed is not None)
        yield Note(f"{where}, against the carrier: {told}", watts)


def _by_load(
    own: PlanetBearing,
    loads: RollerLoads,
    force: float,  # For Palmgren. [N]
    speed: float,
    oil: OilState,
    *,
    alone: bool = False,  # As of `fitted_rolling_loss`.
) -> BearingLoss:
    """Loss that grows with the load, after the model of the bearing."""
    if isinstance(own.model, FittedRolling):
        beyond = _palmgren(own, loads, force, speed) if own.palmgren_beyond else None
        return fitted_rolling_loss(own.bearing, loads, speed, oil, own.model, beyond, alone=alone)
    if own.model in ("mixed-ehl", FULL_COMPLEMENT):
        return mixed_ehl_rolling_loss(own.bearing, loads, speed, oil, oil_held=own.oil_held)
    return _palmgren(own, loads, force, speed)


def _palmgren(own: PlanetBearing, loads: RollerLoads, force: float, speed: float) -> BearingLoss:
    bearing = own.bearing
    watts = palmgren_loss(own.palmgren_coefficient, force, bearing.pitch_diameter, speed)
    return BearingLoss(watts, Flags(partial(palmgren_flags, bearing, loads, speed)), 0.0)


def _bearing_extremes(
    own: PlanetBearing, loads: RollerLoads, speed: float, loss: float
) -> Extremes:
    bearing, intensity = own.bearing, loads.intensity
    points = intensity.shape[:-3]
    rollers = intensity.reshape(*points, -1, bearing.slices)
    place = np.asarray(rollers).sum(axis=-1).argmax(axis=-1)[..., None, None]
    hardest = most(intensity.reshape(*points, -1)), bearing.inner_radius, bearing.equivalent_modulus
    held = total(intensity) * bearing.slice_width
    resisted = held * bearing.pitch_diameter / 2 * abs(speed)
    return Extremes(
        pressure=hertz_pressure(*hardest),
        flattening=hertz_half_width(*hardest) / bearing.inner_radius,
        resistance=either(resisted > 0, loss / larger(resisted, TINY), 0.0),
        share=total((np.take_along_axis(rollers, place, axis=-2) > 0).mean(axis=-1)),
    )


def _bearing_figures(
    own: PlanetBearing,
    loads: RollerLoads,
    load: PlanetLoad,
    speed: float,
    oil: OilState,
    loss: float,
) -> BearingFigures:
    bearing, intensity, points = own.bearing, loads.intensity, loads.intensity.shape[:-3]
    rollers = intensity.sum(axis=-1).reshape(*points, -1) * bearing.slice_width
    hardest = np.arange(rollers.shape[-1]) == np.asarray(rollers).argmax(axis=-1)[..., None]
    azimuth = total((hardest * np.tile(loads.azimuth, bearing.rows)).view(type(rollers)))
    extremes = _bearing_extremes(own, loads, speed, loss)
    slices, turn = intensity.reshape(*points, -1), math.pi / bearing.rollers_per_row
    inner, outer = (
        hertz_half_width(slices, radius * np.ones_like(slices), bearing.equivalent_modulus)
        for radius in (bearing.inner_radius, bearing.outer_radius)
    )
    sizes = bearing.slice_width, bearing.roller_diameter
    pitches = turn * bearing.inner_diameter, turn * bearing.outer_diameter
    return BearingFigures(
        radial_force=load.force,
        moment=hypot(load.moment_x, load.moment_y),
        speed=abs(speed),
        rollers_loaded=total(1.0 * (rollers > 0)),
        roller_load_max=most(rollers),
        roller_azimuth=azimuth - 2 * math.pi * np.round(azimuth / (2 * math.pi)),
        hertz_pressure_max=extremes.pressure,
        flattening=extremes.flattening,
        resistance=extremes.resistance,
        contact_temperature=oil.temperature,
        heat_conductance=roller_conductance(inner, outer, *sizes, *pitches, own.conductivity),
        loads=loads,
    )


# The plain pin of a planet: a journal bearing.

PIN_METHOD = "Reynolds' equation of the film, with contact of asperities"
PIN_SOURCE = (
    "O. Reynolds, Phil. Trans. R. Soc. 177 (1886) 157; heat balance of ISO 7902-1, second hand; "
    "asperities J. A. Greenwood, J. H. Tripp (1971), second hand"
)
PETROFF = "film of a concentric pin after Petroff"
MIXED = 0.01
"""Share of the load on asperities from which a note says so. [1]"""


@dataclass(frozen=True, slots=True)
class PlanetPin:
    """A plain pin and what its film needs of the oil."""

    bearing: JournalBearing
    specific_gravity: float  # Of the oil, at 15.6 degC. [1]
    heat_capacity: float | None  # Of the oil; None for that of its density. [J/(kg K)]

    method = PIN_METHOD, PIN_SOURCE


@dataclass(frozen=True, eq=False)
class PinFigures(PartFigures):
    """The film on a plain pin."""

    eccentricity: float = figure("eccentricity over the clearance", NUMBER)
    attitude: float = figure("attitude angle", DEGREE)
    tilt: float = figure("tilt of the planet on its pin", DEGREE)
    film: float = figure("narrowest film", MICROMETRE)
    film_ratio: float = figure("film over roughness", NUMBER)
    contact_share: float = figure("load on asperities", NUMBER)
    film_temperature: float = figure("temperature of the film", CELSIUS)
    friction_coefficient: float = figure("friction coefficient", NUMBER)


def solve_pin(
    key: str,  # First word of the losses.
    own: PlanetPin,
    load: PlanetLoad,
    count: int,
    oil: OilState,
    speed: float,  # Of the planet against the carrier, positive if the first mesh drives. [rad/s]
    last: Carried = None,  # Under nearly this load, which saves work.
) -> BearingResult:
    """Losses of `count` planets on plain pins under the same load."""
    capacity = own.heat_capacity
    if capacity is None:
        capacity = oil_heat_capacity(oil.temperature, own.specific_gravity)
    tilting = complex(load.moment_x, load.moment_y)
    last = last if isinstance(last, JournalState) else None
    found = solve_journal(own.bearing, load.force, speed, oil, capacity, tilting, last)
    by_load = max(found.watts - found.petroff_watts, 0.0)
    losses = {
        f"{key}_mechanical": Loss(LOAD_DEPENDENT, count * by_load, PIN_METHOD, PIN_SOURCE),
        f"{key}_viscous": Loss(LOAD_INDEPENDENT, count * found.petroff_watts, PETROFF, PIN_SOURCE),
    }
    bearing = own.bearing
    sliding = abs(speed) * bearing.inner_diameter / 2
    friction = found.watts / (load.force * sliding) if load.force * sliding else math.nan
    figures = BearingFigures(
        loads=None,
        flattening=0.0,
        resistance=0.0,
        radial_force=load.force,
        moment=abs(tilting),
        speed=abs(speed),
        rollers_loaded=math.nan,
        roller_load_max=math.nan,
        roller_azimuth=math.nan,
        hertz_pressure_max=math.nan,
        contact_temperature=oil.temperature,
        heat_conductance=oil.thermal_conductivity
        * math.pi
        * bearing.inner_diameter
        * bearing.length
        / (bearing.diametral_clearance / 2),
    )
    film = PinFigures(
        eccentricity=found.eccentricity,
        attitude=found.attitude,
        tilt=found.tilt,
        film=found.film,
        film_ratio=found.film_ratio,
        contact_share=found.contact_force / load.force if load.force else 0.0,
        film_temperature=found.temperature,
        friction_coefficient=friction,
    )
    where = key.replace("_", " ")
    return BearingResult(
        losses,
        {key: figures, f"{key}_film": film},
        journal_flags(where, found, speed),
        tuple(_pin_notes(where, own, load, found, count * found.watts, speed)),
        loads=found,
    )


def _pin_notes(
    where: str, own: PlanetPin, load: PlanetLoad, found: JournalState, watts: float, speed: float
) -> Iterator[Note]:
    """Mixed friction, and what of the couple of helical meshes the film cannot hold."""
    if speed and found.contact_force > MIXED * load.force:
        rubbing = watts * found.contact_watts / found.watts if found.watts else 0.0
        text = (
            f"{where}: asperities carry {percent(found.contact_force / load.force, 0)} of the "
            f"load, because the film of {MICROMETRE.text(found.film, 3)} is "
            f"{format_number(found.film_ratio, 2)} times the roughness. Of "
            f"{WATT.text(watts, 3)} of the pins {WATT.text(rubbing, 3)} are due to "
            "boundary_friction, which is known within a factor of 2 at best."
        )
        yield Note(text, rubbing)
    if speed and found.moment_share < 1:
        held, moment = found.moment_share, math.hypot(load.moment_x, load.moment_y)
        force = 2 * (1 - held) * moment / own.bearing.length
        edges = watts / found.watts * own.bearing.rubbing(force, speed)
        text = (
            f"{where}: the film holds {percent(held, 0)} of the couple of "
            f"{NEWTON_METRE.text(moment, 3)} that tilts the planet on its pin; then an edge "
            f"of the bore is {MICROMETRE.text(found.film, 2)} from it. The rest counts as held "
            "by the teeth, whose load moves along the face, which is not computed. Edges that "
            f"held it would rub with {WATT.text(edges, 3)} more."
        )
        yield Note(text, edges)
