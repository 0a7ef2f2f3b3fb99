"""Span measurement and dimension over balls or pins, and the tooth thickness that they tell.

ISO 21771 and DIN 3960. An internal gear is measured like the external one that would fill its
spaces: the span goes over spaces, and balls touch their spaces from within.
"""

from __future__ import annotations

import math

from epicyclic.geometry.gear import BasicRack, Gear, inverse_involute, involute

PIN = 1.7
"""Usual diameter of a measuring ball or pin over the normal module, near 1.68 to 1.73. [1]"""
PIN_STEP = 0.05e-3
"""To which it is rounded. [m]"""


def _pitch_and_base(rack: BasicRack, teeth: int) -> tuple[float, float]:
    """Normal base pitch, and the base diameter times cos(beta_b). [m]"""
    pitch = rack.transverse_base_pitch * math.cos(rack.base_helix_angle)
    return pitch, teeth * pitch / math.pi


def half_angle_from_span(
    rack: BasicRack, teeth: int, internal: bool, measured: float, count: int
) -> float:
    """Half angle at the reference circle of a tooth with span W_k over `count` teeth.

    Theory (G48).
    """
    pitch, base = _pitch_and_base(rack, teeth)
    half = (measured - (count - 1) * pitch) / base - involute(rack.transverse_pressure_angle)
    return math.pi / teeth - half if internal else half


def span(gear: Gear, count: int) -> float:
    """W_k over `count` teeth, or spaces of a ring. ISO 21771. Theory (G48). [m]

    Examples
    --------
    >>> import math
    >>> from epicyclic.geometry.gear import BasicRack
    >>> rack = BasicRack(1e-3, math.radians(20.0), 0.0)
    >>> gear = Gear("pinion", rack, 20, False, math.pi / 40, 11e-3, 8.75e-3, 10e-3)
    >>> round(1e3 * span(gear, 3), 3)
    7.66
    """
    pitch, base = _pitch_and_base(gear.rack, gear.teeth)
    half = gear.thickness_half_angle
    if gear.internal:
        half = math.pi / gear.teeth - half
    return (count - 1) * pitch + base * (half + involute(gear.rack.transverse_pressure_angle))


def span_contact_radius(gear: Gear, measured: float) -> float:
    """Radius at which a span touches the flanks. ISO 21771. Theory (G49). [m]"""
    return math.hypot(gear.base_radius, measured * math.cos(gear.rack.base_helix_angle) / 2)


def usual_span_teeth(gear: Gear) -> int:
    """The number of teeth whose span touches nearest to the middle of the teeth."""
    pitch, _ = _pitch_and_base(gear.rack, gear.teeth)
    middle = gear.reference_radius + (-1 if gear.internal else 1) * (
        gear.profile_shift_coefficient * gear.rack.normal_module
    )
    chord = 2 * math.sqrt(max(0.0, middle**2 - gear.base_radius**2))
    wanted = chord / math.cos(gear.rack.base_helix_angle)
    return max(2, 1 + round((wanted - span(gear, 1)) / pitch))


def usual_pin(rack: BasicRack) -> float:
    """Diameter of a ball or pin that touches near the middle of the teeth. [m]"""
    return max(1, round(PIN * rack.normal_module / PIN_STEP)) * PIN_STEP


def _spacing(teeth: int) -> float:
    """Distance of opposite balls over the diameter of their circle. [1]"""
    return math.cos(math.pi / (2 * teeth)) if teeth % 2 else 1.0


def half_angle_from_pins(
    rack: BasicRack, teeth: int, internal: bool, measured: float, pin: float
) -> float:
    """Half angle at the reference circle of a tooth with dimension M_d over balls. Theory (G50).

    Raises
    ------
    ValueError
        If the balls would have their middle inside the base circle.
    """
    _, base = _pitch_and_base(rack, teeth)
    side = -1 if internal else 1
    cosine = base / math.cos(rack.base_helix_angle) * _spacing(teeth) / (measured - side * pin)
    if not 0 < cosine <= 1:
        raise ValueError("inside the base circle")
    change = involute(math.acos(cosine)) - involute(rack.transverse_pressure_angle)
    return math.pi / teeth - pin / base + side * change


def _pin_angle(gear: Gear, pin: float) -> float:
    """Transverse pressure angle at the middle of a ball in a space. Theory (G50).

    Raises
    ------
    ValueError
        If the ball is too small to touch the flanks.
    """
    _, base = _pitch_and_base(gear.rack, gear.teeth)
    side = -1 if gear.internal else 1
    space = math.pi / gear.teeth - gear.thickness_half_angle
    value = involute(gear.rack.transverse_pressure_angle) + side * (pin / base - space)
    if value <= 0:
        raise ValueError("the ball does not touch the flanks")
    return inverse_involute(value)


def dimension_over_pins(gear: Gear, pin: float) -> float:
    """M_d over two balls, or between them in a ring. ISO 21771. Theory (G50). [m]

    Raises
    ------
    ValueError
        If the balls are too small to touch the flanks.

    Examples
    --------
    >>> import math
    >>> from epicyclic.geometry.gear import BasicRack
    >>> rack = BasicRack(1e-3, math.radians(20.0), 0.0)
    >>> gear = Gear("pinion", rack, 20, False, math.pi / 40, 11e-3, 8.75e-3, 10e-3)
    >>> round(1e3 * dimension_over_pins(gear, 1.7e-3), 4)
    22.2941
    """
    circle = 2 * gear.base_radius / math.cos(_pin_angle(gear, pin))
    return circle * _spacing(gear.teeth) + (-pin if gear.internal else pin)


def pin_contact_radius(gear: Gear, pin: float) -> float:
    """Radius at which balls touch the flanks. ISO 21771. Theory (G51). [m]

    Raises
    ------
    ValueError
        If the balls are too small to touch the flanks.
    """
    side = -1 if gear.internal else 1
    curvature = gear.base_radius * math.tan(_pin_angle(gear, pin))
    inward = side * pin * math.cos(gear.rack.base_helix_angle) / 2
    return math.hypot(gear.base_radius, curvature - inward)
