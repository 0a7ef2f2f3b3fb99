"""How a computation ended."""

from __future__ import annotations

from enum import StrEnum


class Status(StrEnum):
    """Every result carries one."""

    CONVERGED = "converged"
    FAILED = "failed"
    UNPHYSICAL = "unphysical"
    """There are numbers, but they cannot be: a loss below zero, energy that does not balance, or
    contacts that carry or resist with more than any can."""
