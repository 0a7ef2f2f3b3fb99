"""Profile shifts, centre distance and backlash of a mesh: each from the other two.

Tooth numbers are summed with the sign of ISO 21771, in which those of internal gears are negative;
profile shifts are positive where they thicken the teeth.
"""

from __future__ import annotations

import math

from epicyclic.geometry.gear import BasicRack, inverse_involute, involute


def thinning(rack: BasicRack, normal_backlash: float) -> float:
    """Profile shift taken from a mesh that gives it a normal backlash j_bn [m]. Theory (G45). [1]

    ISO 21771:2007, Eq. 63.
    """
    return normal_backlash / (2 * rack.normal_module * math.sin(rack.normal_pressure_angle))


def profile_shift_sum(
    rack: BasicRack,
    teeth: int,  # z1 + z2, those of an internal gear negative.
    center_distance: float,  # [m]
    normal_backlash: float = 0.0,  # [m]
) -> float:
    """x1 + x2 at a centre distance. ISO 21771:2007, Eq. 62 and 63. Theory (G44), (G45). [1]

    Raises
    ------
    ValueError
        If the base circles do not let the gears come so close.

    Examples
    --------
    >>> import math
    >>> from epicyclic.geometry.gear import BasicRack
    >>> rack = BasicRack(1.75e-3, math.radians(20.0), 0.0)
    >>> round(profile_shift_sum(rack, 21 + 43, 56.8e-3), 4)
    0.4806
    """
    cosine = abs(teeth) * rack.transverse_base_pitch / (2 * math.pi * center_distance)
    if cosine > 1 or teeth == 0:
        raise ValueError("the base circles do not let the gears come so close")
    change = involute(math.acos(cosine)) - involute(rack.transverse_pressure_angle)
    return _sum_for(rack, teeth, change) - thinning(rack, normal_backlash)


def _sum_for(rack: BasicRack, teeth: int, change: float) -> float:
    """x1 + x2 without backlash for a `change` of the involute function. Theory (G44)."""
    return teeth * change / (2 * math.tan(rack.normal_pressure_angle))


def closed_center_distance(
    rack: BasicRack,
    teeth: int,  # z1 + z2, those of an internal gear negative.
    shift_sum: float,  # x1 + x2. [1]
    normal_backlash: float = 0.0,  # j_bn. [m]
) -> float:
    """Centre distance a at which profile shifts leave this backlash. Theory (G44), (G45). [m]

    Raises
    ------
    ValueError
        If there is none.

    Examples
    --------
    >>> import math
    >>> from epicyclic.geometry.gear import BasicRack
    >>> rack = BasicRack(1.75e-3, math.radians(20.0), 0.0)
    >>> round(1e3 * closed_center_distance(rack, 21 + 43, 0.4380 + 0.0426), 3)
    56.8
    """
    if teeth == 0:
        raise ValueError("equal numbers of teeth of a ring and its mate")
    value = involute(rack.transverse_pressure_angle)
    value += (shift_sum + thinning(rack, normal_backlash)) / _sum_for(rack, teeth, 1.0)
    if value < 0:
        raise ValueError("the teeth are too thin for any centre distance")
    return (
        abs(teeth) * rack.transverse_base_pitch / (2 * math.pi * math.cos(inverse_involute(value)))
    )


def recommended_backlash(rack: BasicRack, center_distance: float) -> float:
    """Least normal backlash recommended for industrial gears of steel. Theory (G46). [m]

    ISO/TR 10064-2:1996 (second hand), for pitch-line speeds up to 15 m/s.
    """
    return 2 / 3 * (0.06e-3 + 0.0005 * center_distance + 0.03 * rack.normal_module)
