"""Tools that generate gears: a rack for external gears, a pinion-type cutter for internal ones."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RackTool:
    """A rack, the tool of external gears.

    The rounding is a circle in the normal section of the rack. The transverse section of the gear
    is generated exactly by the transverse section of the rack, where that circle is an ellipse,
    1/cos(beta) times as wide as high; the ellipse is used, not a circle in its place.

    The tip line of the rack touches the root circle of the gear, and its teeth fill the spaces of
    the gear on the reference circle: tool addendum and profile shift follow from the gear.
    """

    # rho_fP, rounding of the tool tip in the normal section; zero for a sharp corner. [m]
    tip_radius: float

    def __post_init__(self) -> None:
        _check_rounding(self.tip_radius)


@dataclass(frozen=True, slots=True)
class ShaperTool:
    """A pinion-type cutter, the tool of internal gears.

    Its rounding is a circle in the transverse section, tangent to the tip circle and to the
    involute flank of the cutter. The generating centre distance is the one without backlash, where
    the cutter fills the spaces of the ring, and the tip radius of the cutter is the root radius of
    the ring less that distance. Infeed of the cutter is taken as axial.
    """

    teeth: int  # z_0.
    # Rounding of the tool tip in the transverse section; zero for a sharp corner. [m]
    tip_radius: float
    # x_0: new cutters have a positive one, reground ones a smaller. [1]
    profile_shift_coefficient: float = 0.0

    def __post_init__(self) -> None:
        _check_rounding(self.tip_radius)
        if self.teeth < 1:
            raise ValueError("a shaper cutter needs at least one tooth")


Tool = RackTool | ShaperTool


def _check_rounding(tip_radius: float) -> None:
    if not (math.isfinite(tip_radius) and tip_radius >= 0.0):
        raise ValueError("the rounding of a tool tip must be zero or positive")
