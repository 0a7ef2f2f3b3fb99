"""Where the solver of line contacts is tested: beyond it, its answers are not relied on."""

from __future__ import annotations

__all__ = ["SOLVER_BOX"]

SOLVER_BOX: dict[str, tuple[float, float]] = {
    "radius": (0.3e-3, 0.1),
    "hertz_pressure": (3e6, 3e9),
    "rolling_speed": (0.1, 50.0),
    "slide_to_roll_ratio": (0.0, 2.0),
}
"""Lowest and highest equivalent radius [m], Hertz pressure [Pa], rolling speed [m/s], slip [1]."""
