"""How thick the teeth of a gear are, in each of the ways in which a case can state it."""

from __future__ import annotations

import math
from dataclasses import replace

from epicyclic.case.gear_tables import GearTable
from epicyclic.case.messages import millimetres
from epicyclic.errors import Problem
from epicyclic.gears import measures
from epicyclic.gears.gear import (
    BasicRack,
    Gear,
    half_angle_from_profile_shift,
    half_angle_from_thickness,
)
from epicyclic.gears.measures import LARGEST_FIT, FlankTolerances, fit_allowances, flank_tolerances

DIGITS = 4
"""Decimals of the profile shifts that messages propose: 0.1 um at a module of 1.5 mm."""


def half_angle(table: GearTable, rack: BasicRack, *, internal: bool) -> float:
    """Half angle at the reference circle of the teeth that a table states.

    Raises `ValueError` if the thickness is stated inside the base circle.
    """
    teeth = table.teeth
    half = _stated(table, rack, internal=internal)
    excess = 2 * allowance_shift(table, rack) * rack.normal_module
    return half + excess * math.tan(rack.transverse_pressure_angle) / (
        teeth * rack.transverse_module
    )


def _stated(table: GearTable, rack: BasicRack, *, internal: bool) -> float:
    teeth = table.teeth
    if table.profile_shift_coefficient is not None:
        return half_angle_from_profile_shift(rack, teeth, table.profile_shift_coefficient)
    if table.span_measurement is not None:
        assert table.teeth_in_span is not None
        return measures.half_angle_from_span(
            rack, teeth, internal, table.span_measurement, table.teeth_in_span
        )
    if table.dimension_over_pins is not None:
        assert table.measuring_pin_diameter is not None
        return measures.half_angle_from_pins(
            rack, teeth, internal, table.dimension_over_pins, table.measuring_pin_diameter
        )
    assert table.tooth_thickness is not None
    assert table.thickness_diameter is not None
    return half_angle_from_thickness(
        rack, teeth, internal, table.tooth_thickness, table.thickness_diameter / 2
    )


def allowances(table: GearTable, rack: BasicRack) -> tuple[float, float] | None:
    """Upper and lower allowance of the tooth thickness, A_sne and A_sni. [m]"""
    if table.tooth_thickness_fit is not None:
        diameter = min(table.teeth * rack.transverse_module, LARGEST_FIT)
        return fit_allowances(table.tooth_thickness_fit, diameter)
    if table.tooth_thickness_allowance is None:
        return None
    upper, lower = table.tooth_thickness_allowance
    return upper, lower


def allowance_shift(table: GearTable, rack: BasicRack) -> float:
    """Profile shift of the mean tooth-thickness allowance. DIN 3960. Theory (G52). [1]"""
    stated = allowances(table, rack)
    return (
        0.0
        if stated is None
        else sum(stated) / (4 * rack.normal_module * math.tan(rack.normal_pressure_angle))
    )


def thickness_key(key: str, table: GearTable) -> str:
    """The key that states how thick the teeth are, of the gear whose table stands at `key`."""
    keys = ("span_measurement", "dimension_over_pins", "tooth_thickness")
    stated = (key for key in keys if getattr(table, key) is not None)
    return f"{key}.{next(stated, 'profile_shift_coefficient')}"


def fitting(gear: Gear, key: str, table: GearTable, over: float) -> str:
    """What a table states of teeth that are thinner by the profile shift `over`, rounded down."""
    rack, key = gear.rack, thickness_key(key, table)
    arc = 2 * over * rack.normal_module * math.tan(rack.transverse_pressure_angle)
    if table.span_measurement is not None:
        normal = math.sin(rack.normal_pressure_angle)
        change = 2 * over * rack.normal_module * normal * (-1 if gear.internal else 1)
        return _length(key, table.span_measurement - change, up=gear.internal)
    if table.dimension_over_pins is not None and table.measuring_pin_diameter is not None:
        half = gear.thickness_half_angle - arc / (2 * gear.reference_radius)
        thin = replace(gear, thickness_half_angle=half)
        change = measures.dimension_over_pins(thin, table.measuring_pin_diameter)
        change -= measures.dimension_over_pins(gear, table.measuring_pin_diameter)
        return _length(key, table.dimension_over_pins + change, up=gear.internal)
    if table.tooth_thickness is not None and table.thickness_diameter is not None:
        thinner = arc * table.thickness_diameter / (2 * gear.reference_radius)
        return _length(key, table.tooth_thickness - thinner, up=False)
    step = 10.0**-DIGITS
    nominal = gear.profile_shift_coefficient - allowance_shift(table, rack)
    return f"{key} = {math.floor((nominal - over) / step) * step:.{DIGITS}f}"


def _length(key: str, value: float, *, up: bool) -> str:
    """A key with its length, rounded to a micrometre towards thinner teeth."""
    step = math.ceil if up else math.floor
    return f'{key} = "{step(value * 1e6) / 1e3:.3f} mm"'


def tolerances_of(gear: Gear, table: GearTable) -> FlankTolerances | None:
    """Tolerances of the flanks of a gear by its class."""
    if table.accuracy_class is None:
        return None
    return flank_tolerances(
        table.accuracy_class, gear.rack.normal_module, 2 * gear.reference_radius, gear.face_width
    )


def check_fit(gear: Gear, key: str, table: GearTable) -> Problem | None:
    """DIN 3967 has no allowances for larger gears."""
    if table.tooth_thickness_fit is None or 2 * gear.reference_radius <= LARGEST_FIT:
        return None
    allowed = f"is for reference diameters up to {millimetres(LARGEST_FIT)}, and this one has "
    allowed += f"{millimetres(2 * gear.reference_radius)}."
    remedy = "Give tooth_thickness_allowance."
    return Problem(f"{key}.tooth_thickness_fit", f'"{table.tooth_thickness_fit}"', allowed, remedy)


def check_measure(gear: Gear, key: str, table: GearTable) -> Problem | None:
    """A span or balls must touch the flanks."""
    if table.span_measurement is not None:
        if gear.internal and gear.rack.helix_angle > 0:
            return Problem(
                f"{key}.span_measurement",
                millimetres(table.span_measurement),
                "cannot be measured on a helical ring.",
                "Give dimension_over_pins with measuring_pin_diameter.",
            )
        radius = measures.span_contact_radius(gear, table.span_measurement)
        remedy = f"Over {measures.usual_span_teeth(gear)} teeth it would touch in the middle."
        what = "span_measurement"
    elif table.dimension_over_pins is not None and table.measuring_pin_diameter is not None:
        radius = measures.pin_contact_radius(gear, table.measuring_pin_diameter)
        usual = millimetres(measures.usual_pin(gear.rack))
        remedy = f"A usual measuring_pin_diameter is {usual}."
        what = "dimension_over_pins"
    else:
        return None
    low, high = sorted((gear.root_radius, gear.tip_radius))
    if low < radius < high:
        return None
    value = getattr(table, what)
    shown = millimetres(value)
    allowed = f"touches at diameter {millimetres(2 * radius)}, beyond the flanks, which reach from "
    allowed += f"{millimetres(2 * low)} to {millimetres(2 * high)}."
    return Problem(f"{key}.{what}", shown, allowed, f"Check it, tooth number and module. {remedy}")
