"""How a computation ended."""

from __future__ import annotations

from enum import StrEnum

__all__ = ["Status"]


class Status(StrEnum):
    """Every result carries one."""

    CONVERGED = "converged"
    FAILED = "failed"
