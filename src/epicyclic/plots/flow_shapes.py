"""Shapes that the slides of power and of heat have in common. Every length is in inches."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.patches import FancyBboxPatch

INK, SOFT = "#1a1d21", "#5b6470"
"""Colours of words and of edges."""
_ROUND = 0.04
"""Radius of the corners of a box."""


@dataclass(frozen=True, slots=True)
class Arrow:
    """How heads of arrows follow from widths."""

    # Half the width of a head, and its length: at least, and over the width of the arrow.
    reach: tuple[float, float]
    length: tuple[float, float]
    share: float  # Of the arrow, for the head at most.

    def corners(
        self, start: float, tip: float, middle: float, width: float, *, upright: bool = False
    ) -> list[tuple[float, float]]:
        """Of an arrow to the right or left, or upright."""
        half = width / 2
        reach, length = (max(least, over * width) for least, over in (self.reach, self.length))
        length = min(self.share * abs(tip - start), length)
        neck = tip - length if tip > start else tip + length
        below = [(start, middle - half), (neck, middle - half), (neck, middle - reach)]
        above = [(neck, middle + reach), (neck, middle + half), (start, middle + half)]
        points = [*below, (tip, middle), *above]
        return [(across, along) for along, across in points] if upright else points


def draw_box(
    ax: Axes, corner: tuple[float, float], size: tuple[float, float], **style: Any
) -> None:
    """A box with round corners, behind words."""
    place = corner[0] + _ROUND, corner[1] + _ROUND
    sides = size[0] - 2 * _ROUND, size[1] - 2 * _ROUND
    shape = f"round,pad={_ROUND}"
    ax.add_patch(FancyBboxPatch(place, *sides, shape, ec=SOFT, lw=0.9, zorder=5, **style))


def fit(letter: float, text: str, room: float, size: float) -> float:
    """The size of a font at which `text` fits into `room`; `letter` is in inch/point. [point]"""
    return min(size, room / (letter * max(1, len(text))))
