"""Who is told that a kernel is compiled: at the first run of a version, which takes minutes."""

from __future__ import annotations

from collections.abc import Callable

listeners: list[Callable[[], None]] = []
"""Called before each kernel is compiled; not for one whose machine code is kept on disk."""
