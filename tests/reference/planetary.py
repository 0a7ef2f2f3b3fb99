"""Efficiency of a simple planetary set, and positions of its planets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from epicyclic.gears.mesh import nearest_admissible_angle


def planetary_efficiency(
    teeth_sun: int,  # z_s and z_r, both positive.
    teeth_ring: int,  # z_s and z_r, both positive.
    # L: loss of the sun-planet and planet-ring meshes over the power through them. [1]
    mesh_loss: float,
    held: str,  # ``"sun"``, ``"ring"`` or ``"carrier"``.
) -> float:
    """Efficiency when only the meshes lose power, to first order in the loss.

    Only the power that rolls through the meshes relative to the carrier is subject to loss. With
    i = z_r/z_s, the share of the power passed on that is lost is

    ============  =================
    member held   1 - efficiency
    ============  =================
    carrier       L
    ring          L i/(i + 1)
    sun           L/(i + 1)
    ============  =================

    whichever of the other two members drives.

    Returns
    -------
    float
        [1]

    References
    ----------
    H. W. Mueller, Epicyclic Drive Trains (1982).
    """
    ratio = teeth_ring / teeth_sun
    shares = {"carrier": 1.0, "ring": ratio / (ratio + 1), "sun": 1 / (ratio + 1)}
    return 1 - mesh_loss * shares[held]


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

    Infinite for a single planet. [m]
    """
    if len(angles) < 2:
        return math.inf
    ordered = sorted(angle % (2 * math.pi) for angle in angles)
    steps = [b - a for a, b in pairwise(ordered)]
    steps.append(2 * math.pi - ordered[-1] + ordered[0])
    chord = min(2 * center_distance * math.sin(step / 2) for step in steps)
    return chord - 2 * tip_radius
