"""What a machine consists of, how it is driven, and the forces on the bearings of its shafts."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

from epicyclic.arrays import Alone, FloatArray, points_in
from epicyclic.dataclass import dataclass, field
from epicyclic.errors import ConvergenceError
from epicyclic.losses.shaft_bearing import BearingLoad
from epicyclic.machine.element import Element
from epicyclic.units import NEWTON, torque_text

# Statics of a shaft: forces of its gear meshes, and what its bearings answer.
#
# Axes: z along the shaft, x and y across it, right-handed. Forces and moments are those that act
# *on* the shaft.


AxialSense = Literal["none", "both", "positive", "negative"]

NEGLIGIBLE = 1e-9
"""Sum of moments about a single support, or of axial forces, over that of their magnitudes, at
which it vanishes. [1]"""


@dataclass(frozen=True, slots=True)
class Support:
    """A bearing that supports a shaft radially."""

    position: float  # z, where its reaction meets the axis. [m]
    # The sense of an axial force of the shaft that the bearing takes: ``"positive"`` if it holds a
    # shaft that is pushed towards +z, ``"negative"``, ``"both"``, ``"none"``.
    axial: AxialSense = "none"
    # Axial force that a radial one induces, over it; 0 for bearings without a contact angle. [1]
    thrust_ratio: float = 0.0
    preload: float = 0.0  # Axial, of this bearing and the one that it is set against. [N]


@dataclass(frozen=True, slots=True)
class ShaftLoad:
    """A force on a shaft, and a moment about the point of the axis where it acts."""

    position: float  # z. [m]
    force: tuple[float, float, float]  # F_x, F_y, F_z. [N]
    moment: tuple[float, float] = (0.0, 0.0)  # M_x, M_y. [N m]


@dataclass(frozen=True, slots=True)
class Reaction:
    """Force of a bearing on the shaft."""

    x: float  # [N]
    y: float  # [N]
    z: float  # [N]

    @property
    def force(self) -> BearingLoad:
        """Magnitudes, radial and axial."""
        return BearingLoad(radial=math.hypot(self.x, self.y), axial=abs(self.z))


def bearing_reactions(
    supports: Sequence[Support],  # Two; or one, if the loads leave no moment about it.
    loads: Sequence[ShaftLoad],
) -> tuple[Reaction, ...]:
    """Forces of the bearings of a rigid shaft, in the order of `supports`. Theory (J18).

    With supports at z_1 and z_2, loads F at z and moments M, the moments about z_1 give ::

        R_2x = -sum(F_x (z - z_1) + M_y)/(z_2 - z_1)
        R_2y = -sum(F_y (z - z_1) - M_x)/(z_2 - z_1)

    and the forces R_1 = -R_2 - sum F. The axial force -sum F_z falls on the first support that
    takes it in this sense; on the first of all if none is marked. Bearings with a contact angle
    that another one is set against press each other, (J31). Raises `ValueError` if statics alone
    does not give the reactions; the message says why.
    """
    if not supports:
        raise ValueError("the shaft has no bearing to carry its loads")
    if len(supports) > 2:
        raise ValueError(
            f"the shaft has {len(supports)} bearings, but statics gives the forces on only two; "
            "give radial_force"
        )
    forces = np.array([load.force for load in loads], dtype=float).reshape(-1, 3)
    moments = np.array([load.moment for load in loads], dtype=float).reshape(-1, 2)
    arms = np.array([load.position for load in loads], dtype=float) - supports[0].position
    about_first = forces[:, :2] * arms[:, None] + moments[:, ::-1] * np.array([1.0, -1.0])
    total = forces.sum(axis=0)
    second = np.zeros(2)
    if len(supports) == 2:
        span = supports[1].position - supports[0].position
        if span == 0:
            raise ValueError("both bearings of the shaft are at the same position")
        second = -about_first.sum(axis=0) / span
    else:
        largest = float(np.abs(forces[:, :2] * arms[:, None]).sum() + np.abs(moments).sum())
        left = float(np.abs(about_first.sum(axis=0)).max())
        if left > NEGLIGIBLE * largest:
            raise ValueError(
                f"a moment of {torque_text(left, 4)} remains on the only bearing of the shaft; "
                "add a second bearing, or give radial_force"
            )
    radial = (-second - total[:2], second)[: len(supports)]
    thrust = float(total[2])
    if abs(thrust) <= NEGLIGIBLE * float(np.abs(forces[:, 2]).sum()):
        thrust = 0.0
    axial = _axial_reactions(supports, [math.hypot(*r) for r in radial], thrust)
    return tuple(Reaction(float(r[0]), float(r[1]), z) for r, z in zip(radial, axial, strict=True))


_TAKES: Mapping[AxialSense, tuple[int, ...]] = {
    "none": (),
    "both": (1, -1),
    "positive": (1,),
    "negative": (-1,),
}
"""Senses of an axial force that a support takes."""


def _axial_reactions(
    supports: Sequence[Support], radial: Sequence[float], thrust: float
) -> list[float]:
    """Axial forces of the bearings on the shaft. Theory (J31). [N]

    Of a bearing with a contact angle and the one that it is set against, each carries at least what
    its own radial force induces, and what the other and the thrust press on it.
    """
    for number, other in ((0, 1), (1, 0)) if len(supports) == 2 else ():
        one, two = supports[number], supports[other]
        senses = _TAKES[one.axial]
        if not one.thrust_ratio or len(senses) != 1 or -senses[0] not in _TAKES[two.axial]:
            continue
        sense, preload = senses[0], max(one.preload, two.preload)
        pressed = two.thrust_ratio * radial[other] + sense * thrust
        # clamped bearings of equal stiffness share an outer force until one of them is free
        clamped = preload + sense * thrust / 2 if preload else 0.0
        force = max(one.thrust_ratio * radial[number], pressed, clamped)
        found = {number: -sense * force, other: sense * force - thrust}
        return [found[0], found[1]]
    axial = _axial_bearing(supports, thrust)
    return [-thrust if number == axial else 0.0 for number in range(len(supports))]


def _axial_bearing(supports: Sequence[Support], thrust: float) -> int:
    """Number of the support that takes the axial force of the shaft."""
    marked = [support.axial for support in supports]
    if all(axial == "none" for axial in marked):
        return 0
    sense = "positive" if thrust > 0 else "negative"
    able = [number for number, axial in enumerate(marked) if axial in ("both", sense)]
    if not able and thrust != 0:
        raise ValueError(
            f"no bearing of the shaft takes its axial force of {NEWTON.text(abs(thrust), 4)} in "
            f"the {sense} sense; let one take it with axial_sense"
        )
    return able[0] if able else 0


def mesh_force(
    torque: float,  # Torque of the mesh on the gear, about +z. [N m]
    radius: float,  # r_w, of the operating pitch circle. [m]
    pressure_angle: float,  # alpha_wt, operating, transverse. [rad]
    helix_tangent: float,  # tan beta_w on the operating pitch cylinder, not negative. [1]
    # 1 for a right-handed helix, -1 for a left-handed one: the hand of the teeth themselves, also
    # of a ring gear, which has the hand of its mate. Of two external gears the hands differ.
    hand: int,
    direction: float,  # Angle of e from x about +z. [rad]
    *,
    internal: bool = False,  # True for a ring gear.
) -> FloatArray:
    """Force of a mesh on a gear, shape (3,). Theory (J19). [N]

    Let e be the unit vector from the axis of the gear to the pitch point and t = z x e, the sense
    in which the gear turns there about +z. A torque tau about +z is the moment of the component
    along t, since (r_w e x F) z = r_w F t. In the transverse plane the force lies along the line of
    action, at alpha_wt to t, and presses on the flank: towards the axis of a gear with external
    teeth, away from that of a ring gear. Along the pitch cylinder the flank follows
    s = h tan(beta_w) t + z, h = 1 for a right-handed helix; it takes no force along itself without
    friction, and e is normal to s, so that F s = 0 gives the axial component. ::

        F_t = tau/r_w
        F = F_t t -+ |F_t| tan(alpha_wt) e - h F_t tan(beta_w) z

    with the upper sign for external teeth.
    """
    outward = np.array([math.cos(direction), math.sin(direction), 0.0])
    along = np.array([-math.sin(direction), math.cos(direction), 0.0])
    tangential = torque / radius
    radial = (1 if internal else -1) * abs(tangential) * math.tan(pressure_angle)
    axial = -hand * tangential * helix_tangent
    return tangential * along + radial * outward + axial * np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True)
class GearSeat:
    """A gear on a shaft, in one of its meshes."""

    mesh: str  # Key of the mesh.
    # Torque of the mesh on the gear over the torque that the mesh takes up at its first gear. [1]
    lever: float
    position: float  # Along the shaft. [m]
    radius: float  # Operating radius. [m]
    pressure_angle: float  # Operating, transverse. [rad]
    helix_tangent: float  # tan(beta_w). [1]
    hand: int  # +1 for a right-handed helix of the teeth, -1 for a left-handed one.
    direction: float  # Direction of the vector from the axis of the gear to the pitch point. [rad]
    internal: bool  # True for a ring gear.
    around: bool  # True if several planets stand around the gear: their radial forces cancel.

    def load(self, torque: float) -> ShaftLoad:
        """Load of the mesh, at the middle of the gear, on the shaft. Theory (J20).

        The axial force acts at the pitch point: its moment about the axis is r_w F_z e x z.
        """
        angles = self.pressure_angle, self.helix_tangent, self.hand, self.direction
        force = mesh_force(self.lever * torque, self.radius, *angles, internal=self.internal)
        x, y, z = map(float, force)
        if self.around:
            return ShaftLoad(self.position, (0.0, 0.0, z))
        outward = np.array([math.cos(self.direction), math.sin(self.direction), 0.0])
        moment = np.cross(self.radius * outward, force)
        return ShaftLoad(self.position, (x, y, z), (float(moment[0]), float(moment[1])))


@dataclass(frozen=True, slots=True)
class ShaftLayout:
    """What stands along a shaft whose bearing forces are computed."""

    supports: Mapping[str, Support]  # Its bearings, by the keys of their elements.
    seats: tuple[GearSeat, ...]


def forces_of(
    layouts: Sequence[ShaftLayout],
    torques: Mapping[str, float],  # That each mesh takes up at its first gear. [N m]
) -> dict[str, BearingLoad]:
    """Forces on the bearings of all shafts, by the keys of their elements.

    Raises `ConvergenceError` if the bearings of a shaft cannot take the forces of its gears.
    """
    if layouts and (count := points_in(torques.values())):
        raise Alone(count)
    forces: dict[str, BearingLoad] = {}
    for layout in layouts:
        loads = [seat.load(torques[seat.mesh]) for seat in layout.seats]
        try:
            reactions = bearing_reactions(tuple(layout.supports.values()), loads)
        except ValueError as error:
            raise ConvergenceError(f"bearings {', '.join(layout.supports)}: {error}.") from None
        for key, reaction in zip(layout.supports, reactions, strict=True):
            forces[key] = reaction.force
    return forces


Terms = tuple[tuple[str, float], ...]
"""Bodies with the coefficients of their speeds in a constraint."""


@dataclass(frozen=True, slots=True)
class MeshRow:
    """Two gears in mesh, each on a body, seen from a carrier."""

    key: str  # ``"P1.sun_mesh"``.
    first: str  # The body of gear 1.
    second: str  # The body of gear 2.
    carrier: str  # `HOUSING` for axes that stand still.
    teeth: tuple[float, float]  # Numbers of teeth of gear 1 and gear 2. [1]
    internal: bool = False  # True if gear 2 is a ring gear around gear 1.
    # Given: power that leaves the mesh over power that enters, with the carrier at rest. Losses of
    # elements come on top. [1]
    efficiency: float = 1.0

    def terms(self, first: float = 1.0, second: float = 1.0) -> Terms:
        """Bodies with their coefficients in z1 (w1 - wc) + s z2 (w2 - wc) = 0. Theory (T1).

        s = -1 for a ring gear, else 1; `first` and `second` multiply the coefficients of the gears.
        """
        one = first * self.teeth[0]
        two = second * (-self.teeth[1] if self.internal else self.teeth[1])
        return ((self.first, one), (self.second, two), (self.carrier, -(one + two)))


@dataclass(frozen=True, slots=True)
class Coupling:
    """A closed clutch: two bodies that turn together."""

    key: str
    first: str
    second: str

    def terms(self) -> Terms:
        """Bodies with their coefficients in w1 - w2 = 0."""
        return ((self.first, 1.0), (self.second, -1.0))


@dataclass(frozen=True, slots=True)
class Operation:
    """How a machine is driven."""

    pointwise = True

    input: str  # The body of given torque.
    output: str  # The body whose torque balances.
    torque: float  # On the input, from outside. [N m]
    # Given speeds: of the input, of bodies that are held, of bodies that are driven as well.
    # [rad/s]
    speeds: Mapping[str, float]
    # Further torques from outside. [N m]
    torques: Mapping[str, float] = field(default_factory=dict[str, float])
    held: tuple[str, ...] = ()  # Bodies of `speeds` that something holds still.

    @property
    def driven(self) -> tuple[str, ...]:
        """Bodies of given speed beside the input that are not held."""
        return tuple(body for body in self.speeds if body not in (self.input, *self.held))


@dataclass(frozen=True, slots=True)
class Machine:
    """Bodies, what couples their speeds, and what loses power."""

    pointwise = True

    bodies: tuple[str, ...]  # All that can turn, without `HOUSING`.
    rows: tuple[MeshRow, ...]
    elements: tuple[Element, ...]
    couplings: tuple[Coupling, ...] = ()
    # Gears and bearings along the shafts whose bearing forces are computed.
    layouts: tuple[ShaftLayout, ...] = ()
    # Shafts that are joined to nothing; what is on them stands still.
    resting: tuple[str, ...] = ()
