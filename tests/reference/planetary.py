"""Efficiency of a simple planetary set: sun, planets, ring and carrier."""

from __future__ import annotations


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
