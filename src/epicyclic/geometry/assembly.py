"""Where planets can stand on their carrier, and how near they come to each other.

A planet fits between sun and ring only at angles that are multiples of 2 pi/(z_s + z_r) from
another one (Lynwander, Gear Drive Systems, 1983, chapter 8; Mueller, Epicyclic Drive Trains, 1982).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

__all__ = [
    "admissible_angles",
    "are_evenly_spaced",
    "nearest_admissible_angle",
    "smallest_planet_gap",
]


def are_evenly_spaced(angles: Sequence[float]) -> bool:
    """Planets at these angles [rad] divide the carrier into equal parts."""
    ordered = sorted(angle % (2 * math.pi) for angle in angles)
    step = 2 * math.pi / len(ordered)
    return all(
        math.isclose(angle - ordered[0], k * step, abs_tol=1e-9) for k, angle in enumerate(ordered)
    )


def nearest_admissible_angle(angle: float, teeth_sun: int, teeth_ring: int) -> float:
    """The angle nearest to `angle` at which a planet can be assembled. Theory (K7). [rad]"""
    step = 2 * math.pi / (teeth_sun + teeth_ring)
    return round(angle / step) * step


def admissible_angles(count: int, teeth_sun: int, teeth_ring: int) -> tuple[float, ...]:
    """Positions of `count` planets, each the admissible one nearest to equal spacing. [rad]"""
    return tuple(
        nearest_admissible_angle(2 * math.pi * planet / count, teeth_sun, teeth_ring)
        for planet in range(count)
    )


def smallest_planet_gap(
    angles: Sequence[float], center_distance: float, tip_radius: float
) -> float:
    """Smallest distance between the tip circles of neighbouring planets; negative: they overlap.

    Theory (K8).

    Infinite for a single planet. [m]
    """
    if len(angles) < 2:
        return math.inf
    ordered = sorted(angle % (2 * math.pi) for angle in angles)
    steps = [b - a for a, b in pairwise(ordered)]
    steps.append(2 * math.pi - ordered[-1] + ordered[0])
    chord = min(2 * center_distance * math.sin(step / 2) for step in steps)
    return chord - 2 * tip_radius
