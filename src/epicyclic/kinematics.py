"""Speeds, torques and power flow of a planetary gear set and of a gear pair.

Signs: speeds are positive in one common sense of rotation; a torque is the one that acts on the
gear set from outside, so that torque times speed is the power that enters through that member.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

__all__ = [
    "MEMBERS",
    "MemberState",
    "PowerFlow",
    "pair_power_flow",
    "planet_speed",
    "planetary_power_flow",
    "planetary_speeds",
]

MEMBERS = ("sun", "ring", "carrier")


@dataclass(frozen=True, slots=True)
class MemberState:
    """One shaft.

    Attributes
    ----------
    speed : float
        [rad/s]
    torque : float
        From outside, losses accounted for. [N m]
    """

    speed: float
    torque: float

    @property
    def power(self) -> float:
        """Power that enters the gear set through this shaft. [W]"""
        return self.torque * self.speed


@dataclass(frozen=True, slots=True)
class PowerFlow:
    """Where power enters and leaves.

    Attributes
    ----------
    members : mapping of str to MemberState
        The shafts; their powers sum to the loss.
    input_power : float
        Power that enters, at the members that would drive without losses. [W]
    efficiency : float or None
        Power that leaves over power that enters; 0 if the loss takes all of it; None if no power
        is passed on. [1]
    """

    members: Mapping[str, MemberState]
    input_power: float
    efficiency: float | None


def planetary_speeds(
    teeth_sun: int, teeth_ring: int, given: Mapping[str, float]
) -> dict[str, float]:
    """Speeds of sun, ring and carrier from those of two of them.

    Theory (K1).

    Willis: z_s omega_s + z_r omega_r = (z_s + z_r) omega_c. [rad/s]
    """
    factors = {"sun": teeth_sun, "ring": teeth_ring, "carrier": -(teeth_sun + teeth_ring)}
    (third,) = set(MEMBERS) - set(given)
    (_, first), (other, second) = given.items()
    # from the difference of the two: members that turn as one body do so exactly
    speeds = {**given, third: first + (first - second) * factors[other] / factors[third]}
    return {name: speeds[name] for name in MEMBERS}


def planet_speed(teeth_sun: int, teeth_planet: int, speeds: Mapping[str, float]) -> float:
    """Speed of a planet relative to the carrier: -(omega_s - omega_c) z_s/z_p. [rad/s]

    Theory (K2).
    """
    return -(speeds["sun"] - speeds["carrier"]) * teeth_sun / teeth_planet


def lossless_torques(
    teeth_sun: int, teeth_ring: int, member: str, torque: float
) -> dict[str, float]:
    """Torques of all members from one of them, T_s : T_r : T_c = z_s : z_r : -(z_s + z_r). [N m]

    Theory (K3).
    """
    factors = {"sun": teeth_sun, "ring": teeth_ring, "carrier": -(teeth_sun + teeth_ring)}
    return {name: torque * factors[name] / factors[member] for name in MEMBERS}


def planetary_power_flow(
    teeth_sun: int,
    teeth_ring: int,
    speeds: Mapping[str, float],
    given: str,
    held: str,
    torque: float,
    loss: float,
    drags: Mapping[str, float] | None = None,
) -> PowerFlow:
    """Torques and powers with the losses, the torque of the member `given` being prescribed.

    Theory (K5).

    The torques that the meshes pass balance, and their powers sum to the loss inside the gear set;
    each shaft carries besides the torque of its own drag against the housing.

    Parameters
    ----------
    teeth_sun, teeth_ring : int
    speeds : mapping of str to float
        Of the members. [rad/s]
    given, held : str
        The member of prescribed torque, and the fixed or second driven one; the third is the
        output.
    torque : float
        On the member `given`, from outside. [N m]
    loss : float
        Inside the gear set. [W]
    drags : mapping of str to float, optional
        Power that each member loses to the housing. [W]
    """
    (output,) = set(MEMBERS) - {given, held}
    powers = dict.fromkeys(MEMBERS, 0.0) | dict(drags or {})
    drag = {name: powers[name] / speeds[name] if speeds[name] else 0.0 for name in MEMBERS}
    difference = speeds[output] - speeds[held]
    # without a difference they turn as one body: no relative motion, no loss inside
    friction = loss / difference if difference else 0.0
    passed = lossless_torques(teeth_sun, teeth_ring, given, torque - drag[given])
    passed[output] += friction
    passed[held] -= friction
    members = {name: MemberState(speeds[name], passed[name] + drag[name]) for name in MEMBERS}
    lossless = lossless_torques(teeth_sun, teeth_ring, given, torque)
    drivers = [name for name in MEMBERS if lossless[name] * speeds[name] > 0]
    return _flow(members, drivers, loss + sum(powers.values()))


def pair_power_flow(
    ratio: float, internal: bool, torque: float, speed: float, loss: float
) -> PowerFlow:
    """Power flow of a pair, pinion torque and speed given, ratio u = z2/z1. Theory (K6)."""
    speed2 = speed / ratio * (1 if internal else -1)
    passed = torque * speed
    torque2 = (loss - passed) / speed2 if speed2 else -torque * ratio * (1 if internal else -1)
    members = {"pinion": MemberState(speed, torque), "gear": MemberState(speed2, torque2)}
    drivers = [] if passed == 0.0 else ["pinion" if passed > 0 else "gear"]
    return _flow(members, drivers, loss)


def _flow(members: Mapping[str, MemberState], drivers: Collection[str], loss: float) -> PowerFlow:
    """Input power and efficiency; `drivers` are the members that drive without losses.

    Theory (P5), (P6), (P7).
    """
    if not drivers:
        return PowerFlow(members, 0.0, None)
    entering = max(0.0, sum(members[name].power for name in drivers))
    return PowerFlow(members, entering, 1 - loss / entering if loss < entering else 0.0)
