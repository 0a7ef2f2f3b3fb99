"""How a computation ended."""

from __future__ import annotations

from enum import StrEnum

__all__ = ["Status"]


class Status(StrEnum):
    """Every result carries one."""

    CONVERGED = "converged"
    FAILED = "failed"
    UNPHYSICAL = "unphysical"
    """There are numbers, but they cannot be: a loss below zero, or energy that does not balance."""
