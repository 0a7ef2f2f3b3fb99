"""Losses of a train summed by what loses and how."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

LOSS_KINDS = ("given", "sliding", "rolling", "pocketing", "bearings", "seals", "drag")
"""In the order of their columns; ``"given"`` are those of meshes of given efficiency."""
_OF_PARTS = {"bearings": "bearings", "seals": "seals", "drags": "drag"}


def loss_sums(
    # Losses of a train, ``"planets.sun_mesh_sliding"``; without those that are left out.
    losses: Mapping[str, float],
    inputs: Mapping[str, Any],  # The case, as a file has it.
) -> dict[str, dict[str, float]]:
    """Sums by set or part, and in each by kind. [W]

    Returns
    -------
    dict of str to dict of str to float
        Of `LOSS_KINDS` those that the set or part has.
    """
    kinds = {name: kind for table, kind in _OF_PARTS.items() for name in inputs.get(table, {})}
    sums: dict[str, dict[str, float]] = {}
    for key, watts in losses.items():
        stage, _, term = key.partition(".")
        kind = kinds.get(stage) or _kind_of(term)
        own = sums.setdefault(stage, {})
        own[kind] = own.get(kind, 0.0) + watts
    return sums


def _kind_of(term: str) -> str:
    """The kind of a loss of a set."""
    last = term.rpartition("_")[2]
    if "bearing" in term:
        return "bearings"
    return last if last in LOSS_KINDS else "given"
