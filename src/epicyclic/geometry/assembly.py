"""Where planets can stand on their carrier, and how near they come to each other.

A planet fits between sun and ring only at angles that are multiples of 2 pi/(z_s + z_r) from
another one (Lynwander, Gear Drive Systems, 1983, chapter 8; Mueller, Epicyclic Drive Trains, 1982).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise


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


def closing_number(
    # For each mesh the teeth of its gears on planets, by their bodies, and those of its central
    # gear: negative for a ring gear, 0 between two planets.
    meshes: Sequence[tuple[Mapping[str, int], int]],
) -> int:
    """N: alike planets can stand at multiples of 1/N of a turn from another one. Theory (A6).

    0 if they can stand anywhere.
    """
    bodies = dict.fromkeys(body for teeth, _ in meshes for body in teeth)
    rows = [[*(teeth.get(body, 0) for body in bodies), central] for teeth, central in meshes]
    for column in range(len(bodies)):
        held = [row for row in rows if row[column]]
        rows = [row for row in rows if not row[column]]
        while len(held) > 1:
            # Euclid's algorithm with whole rows
            held.sort(key=lambda row: abs(row[column]))
            least = held[0]
            for row in held[1:]:
                times = row[column] // least[column]
                row[:] = [a - times * b for a, b in zip(row, least, strict=True)]
            rows += [row for row in held if not row[column]]
            held = [row for row in held if row[column]]
    return math.gcd(*(row[-1] for row in rows))


def nearest_places(count: int, number: int) -> tuple[float, ...]:
    """Angles of `count` planets, multiples of 1/`number` of a turn, nearest to equal spacing. [rad]

    Equally spaced if `number` is 0.
    """
    if number % count == 0:
        return tuple(2 * math.pi * planet / count for planet in range(count))
    step = 2 * math.pi / number
    return tuple(step * round(number * planet / count) for planet in range(count))


def pin_angle(radius1: float, radius2: float, distance: float) -> float:
    """Angle at the axis of the set between two pins at a distance from each other. Theory (A4).

    Raises
    ------
    ValueError
        If no triangle has these sides.
    """
    cosine = (radius1**2 + radius2**2 - distance**2) / (2 * radius1 * radius2)
    if abs(cosine) > 1:
        raise ValueError("no triangle has these sides")
    return math.acos(cosine)
