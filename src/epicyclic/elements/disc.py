"""Bodies that turn in the air-oil mixture, as discs, and bearings that only churn oil."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from epicyclic.elements.base import HOUSING, LOAD_INDEPENDENT, Loss, State
from epicyclic.losses.validity import ValidityFlag
from epicyclic.losses.viscous import (
    DRAG_METHOD,
    DRAG_SOURCE,
    VISCOUS_METHOD,
    VISCOUS_SOURCE,
    bearing_viscous_loss,
    disc_drag,
    disc_drag_flags,
    viscous_flags,
)

__all__ = ["Disc", "ThrustBearing", "disc_loss", "thrust_loss"]

Outcome = tuple[Loss, tuple[ValidityFlag, ...]]


@dataclass(frozen=True, slots=True)
class Disc:
    """A body that turns in the mixture, as a disc.

    Attributes
    ----------
    where : str
        For the flags: ``"sun"``.
    body : str
    radius, width : float
        [m]
    """

    where: str
    body: str
    radius: float
    width: float


@dataclass(frozen=True, slots=True)
class ThrustBearing:
    """Thrust bearings that carry no load worth counting.

    Attributes
    ----------
    between : tuple of str
        The two bodies whose speeds differ.
    mean_diameter : float
        [m]
    viscous_factor : float
        f0. [1]
    count : int
    """

    between: tuple[str, str]
    mean_diameter: float
    viscous_factor: float
    count: int


def disc_loss(discs: Iterable[Disc], state: State) -> Outcome:
    """The drag of `discs` together, each on its own shaft, and its flags."""
    flags: tuple[ValidityFlag, ...] = ()
    drags = {}
    for disc in discs:
        speed = state.speeds[disc.body]
        drag = disc_drag(disc.radius, disc.width, speed, state.fluids.mixture)
        drags[disc.body] = drag.total
        flags += disc_drag_flags(disc.where, disc.radius, drag, speed, state.fluids.mixture)
    watts = sum(drags.values())
    brakes = tuple((body, HOUSING, drag / watts) for body, drag in drags.items() if drag)
    return Loss(LOAD_INDEPENDENT, watts, DRAG_METHOD, DRAG_SOURCE, brakes=brakes), flags


def thrust_loss(bearing: ThrustBearing, state: State) -> Outcome:
    """Viscous loss of all thrust bearings. Theory (V2)."""
    one, two = bearing.between
    speed = state.speeds[one] - state.speeds[two]
    loss = bearing_viscous_loss(
        bearing.viscous_factor, state.fluids.oil.kinematic_viscosity, speed, bearing.mean_diameter
    )
    return (
        Loss(
            LOAD_INDEPENDENT,
            bearing.count * loss,
            VISCOUS_METHOD,
            VISCOUS_SOURCE,
            brakes=((*bearing.between, 1.0),),
        ),
        viscous_flags("thrust bearing", speed, bearing.mean_diameter),
    )
