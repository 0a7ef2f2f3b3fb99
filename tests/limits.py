"""Within what a file must be read or refused, whatever it holds."""

from __future__ import annotations

import resource
import sys
import time

__all__ = ["MOST_MEMORY", "is_soon", "peak_memory"]

MOST_SECONDS = 5.0
"""Of processor time, on a machine that takes `USUAL`."""
MOST_MEMORY = 500e6
"""Bytes beyond what was in use before."""
USUAL = 0.03
"""Processor time of a million additions on the machines that limits are stated for. [s]"""


def is_soon(seconds: float, most: float = MOST_SECONDS) -> bool:
    """Whether a processor time is within a limit, which is longer on a machine that is slower."""
    return seconds < most or seconds < most * _addition() / USUAL


def _addition() -> float:
    """Processor time of a million additions here and now. [s]"""
    start = time.process_time()
    total = 0
    for number in range(1_000_000):
        total += number
    return time.process_time() - start


def peak_memory() -> int:
    """Largest memory of this process so far. [bytes]"""
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
