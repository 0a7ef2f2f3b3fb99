"""How often Python looks through memory for what nothing refers to any more."""

from __future__ import annotations

import gc

NEW_OBJECTS = 100_000
"""So many make Python look for garbage. Imports make several times as many, all of them to stay."""


def look_seldom() -> None:
    """Look less often than Python does by itself, in a process that is the program's own."""
    gc.set_threshold(NEW_OBJECTS)
