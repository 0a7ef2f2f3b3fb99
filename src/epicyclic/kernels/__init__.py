"""Compiled numerics on plain arrays."""

from __future__ import annotations

from collections.abc import Callable

listeners: list[Callable[[], None]] = []
"""Called before each kernel is compiled, which takes minutes at the first run of a version; not for
one whose machine code is kept on disk. They stand here because the compiler is slow to import."""

ahead: list[Callable[[], object]] = []
"""Work that is to come: while a kernel is compiled, copies of the process do it for its kernels."""
