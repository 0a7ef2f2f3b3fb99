"""What a machine consists of, and how it is driven."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from epicyclic.elements.base import Element
from epicyclic.machine.forces import ShaftLayout

Terms = tuple[tuple[str, float], ...]
"""Bodies with the coefficients of their speeds in a constraint."""


@dataclass(frozen=True, slots=True)
class MeshRow:
    """Two gears in mesh, each on a body, seen from a carrier."""

    key: str  # ``"P1.sun_mesh"``.
    first: str  # Bodies of gear 1, gear 2 and the carrier; `HOUSING` for axes that stand still.
    second: str  # Bodies of gear 1, gear 2 and the carrier; `HOUSING` for axes that stand still.
    carrier: str  # Bodies of gear 1, gear 2 and the carrier; `HOUSING` for axes that stand still.
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

    input: str  # The body of given torque, and the one whose torque balances.
    output: str  # The body of given torque, and the one whose torque balances.
    torque: float  # On the input, from outside. [N m]
    # Given speeds: of the input, of bodies that are held, of bodies that are driven as well.
    # [rad/s]
    speeds: Mapping[str, float]
    # Further torques from outside. [N m]
    torques: Mapping[str, float] = field(default_factory=dict[str, float])


@dataclass(frozen=True, slots=True)
class Machine:
    """Bodies, what couples their speeds, and what loses power."""

    bodies: tuple[str, ...]  # All that can turn, without `HOUSING`.
    rows: tuple[MeshRow, ...]
    elements: tuple[Element, ...]
    couplings: tuple[Coupling, ...] = ()
    # Gears and bearings along the shafts whose bearing forces are computed.
    layouts: tuple[ShaftLayout, ...] = ()
    # Shafts that are joined to nothing; what is on them stands still.
    resting: tuple[str, ...] = ()
