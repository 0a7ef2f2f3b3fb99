"""Within what a file must be read or refused, whatever it holds."""

from __future__ import annotations

import resource
import sys

__all__ = ["MOST_MEMORY", "MOST_SECONDS", "peak_memory"]

MOST_SECONDS = 5.0
"""Of processor time."""
MOST_MEMORY = 500e6
"""Bytes beyond what was in use before."""


def peak_memory() -> int:
    """Largest memory of this process so far. [bytes]"""
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
