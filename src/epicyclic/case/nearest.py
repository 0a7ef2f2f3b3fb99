"""Suggestions for misspelt names."""

from __future__ import annotations

from collections.abc import Iterable

from rapidfuzz import fuzz, process
from rapidfuzz.distance import OSA

_LIKENESS = 60.0
"""Smallest likeness, in percent, at which a name is worth suggesting."""

_MOST_SLIPS = 2
"""Letters left out, added, changed or swapped in a name that is still clear."""

_LONGEST = 60
"""No name is longer, and longer text is not compared. [characters]"""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """``"Did you mean 'sun'?"``, or nothing if no known name is near."""
    if len(name) > _LONGEST:
        return ""
    found = process.extractOne(name, list(known), scorer=_likeness, score_cutoff=_LIKENESS)
    return f"Did you mean {found[0]!r}?" if found else ""


def misspelt(name: str, known: Iterable[str]) -> str:
    """The known name that `name` can only be a misspelling of; empty if there is none."""
    slips = {
        other: OSA.distance(name.casefold(), other.casefold(), score_cutoff=_MOST_SLIPS)
        for other in known
        if len(name) <= _LONGEST
    }
    nearest = min(slips, key=slips.__getitem__, default="")
    clear = nearest and slips[nearest] <= min(_MOST_SLIPS, len(name) // 3)
    return nearest if clear else ""


def _likeness(name: str, known: str, *, score_cutoff: float | None = None) -> float:
    """In percent; a name that is part of another one is somewhat like it."""
    one, two = name.casefold(), known.casefold()
    score = fuzz.ratio(one, two, score_cutoff=score_cutoff)
    partly = min(len(one), len(two)) > 3 and (one in two or two in one)
    return max(score, _LIKENESS + 10) if partly else score
