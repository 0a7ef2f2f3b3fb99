"""Suggestions for misspelt names."""

from __future__ import annotations

from collections.abc import Iterable

from rapidfuzz import process

__all__ = ["did_you_mean"]

_LIKENESS = 60.0
"""Smallest likeness, in percent, at which a name is worth suggesting."""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """``"Did you mean 'sun'?"``, or nothing if no known name is near."""
    found = process.extractOne(name, list(known), score_cutoff=_LIKENESS)
    return f"Did you mean {found[0]!r}?" if found else ""
