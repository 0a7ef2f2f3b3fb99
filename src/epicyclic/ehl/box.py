"""Where the solver of line contacts is tested: beyond it, its answers are not relied on."""

from __future__ import annotations

SOLVER_BOX: dict[str, tuple[float, float]] = {
    "radius": (0.3e-3, 0.3),
    "hertz_pressure": (3e6, 3e9),
    "rolling_speed": (0.1, 50.0),
    "slide_to_roll_ratio": (0.0, 2.0),
    "film_ratio": (0.01, 20.0),
    "composite_roughness": (0.0, 1.7e-6),
}
"""Lowest and highest equivalent radius [m], Hertz pressure [Pa], rolling speed [m/s], slip [1], and
of rough contacts minimum film over composite roughness [1], composite roughness [m]."""
DRY_SPEED = 0.01
"""Rolling speed below which ridges across the motion trap oil that would leak past real ones, and
a contact does not become dry. [m/s]"""
FEWEST_KEPT = 0.95
"""Share of Rq that a grid must resolve. [1]"""
VALIDATED_FILM_RATIO = 0.7
"""Film ratio below which friction of rough contacts is not validated. [1]"""
