"""What a case states of a gear: the thickness of its teeth, its flanks, the back of its rim.

The tables of cases, which this room does not know, have the attributes of the classes here.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any, Protocol, Self

from epicyclic.gears import measures
from epicyclic.gears.flanks import (
    FlankDeviations,
    MicroGeometry,
    Relief,
    ReliefShape,
    Topography,
    active_profile,
)
from epicyclic.gears.gear import (
    BasicRack,
    Gear,
    half_angle_from_profile_shift,
    half_angle_from_thickness,
)
from epicyclic.gears.measures import LARGEST_FIT, FlankTolerances, fit_allowances, flank_tolerances
from epicyclic.gears.mesh import Mesh

THICKNESS = (
    "tooth_thickness+thickness_diameter",
    "span_measurement+teeth_in_span",
    "dimension_over_pins+measuring_pin_diameter",
    "profile_shift_coefficient",
)
"""Keys that state how thick the teeth of a gear are: one of these, and what belongs to it."""


class StatedTopography(Protocol):
    """Deviations over a flank. [m]"""

    @property
    def diameter(self) -> tuple[float, ...]: ...
    @property
    def face_position(self) -> tuple[float, ...]: ...
    @property
    def deviation(self) -> tuple[tuple[float, ...], ...]: ...


class StatedFlank(Protocol):
    """Modifications and deviations of a flank; reliefs are read by the names of their keys. [m]"""

    @property
    def model_fields_set(self) -> set[str]: ...
    @property
    def end_relief(self) -> float: ...
    @property
    def end_relief_length(self) -> float | None: ...
    @property
    def end_relief_shape(self) -> ReliefShape: ...
    @property
    def profile_crown(self) -> float: ...
    @property
    def profile_slope(self) -> float: ...
    @property
    def lead_crown(self) -> float: ...
    @property
    def lead_slope(self) -> float: ...
    @property
    def topography(self) -> StatedTopography | None: ...


class StatedMaterial(Protocol):
    """Constants of a solid, in SI units."""

    @property
    def title(self) -> str: ...
    @property
    def elastic_modulus(self) -> float: ...
    @property
    def poisson_ratio(self) -> float: ...
    @property
    def density(self) -> float: ...
    @property
    def thermal_conductivity(self) -> float: ...
    @property
    def heat_capacity(self) -> float: ...


class StatedGear(Protocol):
    """A gear; lengths in metres."""

    @property
    def teeth(self) -> int: ...
    @property
    def is_ring(self) -> bool: ...
    @property
    def face_width(self) -> float: ...
    @property
    def tip_diameter(self) -> float | None: ...
    @property
    def root_diameter(self) -> float | None: ...
    @property
    def tip_chamfer(self) -> float: ...
    @property
    def states_thickness(self) -> bool: ...
    @property
    def tooth_thickness(self) -> float | None: ...
    @property
    def thickness_diameter(self) -> float | None: ...
    @property
    def span_measurement(self) -> float | None: ...
    @property
    def teeth_in_span(self) -> int | None: ...
    @property
    def dimension_over_pins(self) -> float | None: ...
    @property
    def measuring_pin_diameter(self) -> float | None: ...
    @property
    def tooth_thickness_allowance(self) -> tuple[float, ...] | None: ...
    @property
    def tooth_thickness_fit(self) -> str | None: ...
    @property
    def profile_shift_coefficient(self) -> float | None: ...
    @property
    def roughness(self) -> float: ...
    @property
    def material(self) -> StatedMaterial: ...
    @property
    def accuracy_class(self) -> int | None: ...
    @property
    def tool_tip_radius(self) -> float | None: ...
    @property
    def shroud_gap(self) -> float | None: ...
    @property
    def flange_gap(self) -> float | None: ...
    @property
    def micro_geometry(self) -> StatedFlank | None: ...
    def __hash__(self) -> int: ...
    def model_copy(self, *, update: Mapping[str, Any] | None = None) -> Self: ...


class StatedShared(Protocol):
    """What all gears of a set share; lengths in metres."""

    @property
    def center_distance(self) -> float | None: ...
    @property
    def addendum_coefficient(self) -> float: ...
    @property
    def dedendum_coefficient(self) -> float: ...
    @property
    def basic_rack(self) -> str | None: ...
    @property
    def tip_alteration(self) -> str: ...
    def model_copy(self, *, update: Mapping[str, Any] | None = None) -> Self: ...


class StatedMesh(Protocol):
    """What belongs to a mesh and to none of its gears. [m]"""

    @property
    def normal_backlash(self) -> float | None: ...
    @property
    def misalignment(self) -> float: ...


# How thick the teeth of a gear are, in each of the ways in which a case can state it.

DIGITS = 4  # Decimals of the profile shifts that messages propose: 0.1 um at a module of 1.5 mm.


def half_angle(table: StatedGear, rack: BasicRack, *, internal: bool) -> float:
    """Half angle at the reference circle of the teeth that a table states.

    Raises `ValueError` if the thickness is stated inside the base circle.
    """
    teeth = table.teeth
    if table.profile_shift_coefficient is not None:
        half = half_angle_from_profile_shift(rack, teeth, table.profile_shift_coefficient)
    elif table.span_measurement is not None:
        assert table.teeth_in_span is not None
        half = measures.half_angle_from_span(
            rack, teeth, internal, table.span_measurement, table.teeth_in_span
        )
    elif table.dimension_over_pins is not None:
        assert table.measuring_pin_diameter is not None
        half = measures.half_angle_from_pins(
            rack, teeth, internal, table.dimension_over_pins, table.measuring_pin_diameter
        )
    else:
        assert table.tooth_thickness is not None
        assert table.thickness_diameter is not None
        half = half_angle_from_thickness(
            rack, teeth, internal, table.tooth_thickness, table.thickness_diameter / 2
        )
    excess = 2 * allowance_shift(table, rack) * rack.normal_module
    excess *= math.tan(rack.transverse_pressure_angle)
    return half + excess / (teeth * rack.transverse_module)


def allowances(table: StatedGear, rack: BasicRack) -> tuple[float, float] | None:
    """Upper and lower allowance of the tooth thickness, A_sne and A_sni. [m]"""
    if table.tooth_thickness_fit is not None:
        diameter = min(table.teeth * rack.transverse_module, LARGEST_FIT)
        return fit_allowances(table.tooth_thickness_fit, diameter)
    if table.tooth_thickness_allowance is None:
        return None
    upper, lower = table.tooth_thickness_allowance
    return upper, lower


def allowance_shift(table: StatedGear, rack: BasicRack) -> float:
    """Profile shift of the mean tooth-thickness allowance. DIN 3960. Theory (G52). [1]"""
    stated = allowances(table, rack)
    if stated is None:
        return 0.0
    return sum(stated) / (4 * rack.normal_module * math.tan(rack.normal_pressure_angle))


def thickness_key(key: str, table: StatedGear) -> str:
    """The key that states how thick the teeth are, of the gear whose table stands at `key`."""
    keys = ("span_measurement", "dimension_over_pins", "tooth_thickness")
    stated = (key for key in keys if getattr(table, key) is not None)
    return f"{key}.{next(stated, 'profile_shift_coefficient')}"


def fitting(gear: Gear, key: str, table: StatedGear, over: float) -> str:
    """What a table states of teeth that are thinner by the profile shift `over`, rounded down."""
    rack, key = gear.rack, thickness_key(key, table)
    arc = 2 * over * rack.normal_module * math.tan(rack.transverse_pressure_angle)
    if table.span_measurement is not None:
        change = 2 * over * rack.normal_module * math.sin(rack.normal_pressure_angle) * gear.side
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


def tolerances_of(gear: Gear, table: StatedGear) -> FlankTolerances | None:
    """Tolerances of the flanks of a gear by its class."""
    if table.accuracy_class is None:
        return None
    return flank_tolerances(
        table.accuracy_class, gear.rack.normal_module, 2 * gear.reference_radius, gear.face_width
    )


Tables = tuple[StatedGear, StatedGear]


@lru_cache(maxsize=256)
def flank_deviations(mesh: Mesh, tables: Tables, misalignment: float) -> FlankDeviations:
    """The deviations of both working flanks of a mesh."""
    one, two = (_of_member(mesh, member, tables[member - 1]) for member in (1, 2))
    return FlankDeviations(one, two, misalignment)


def working_flank(member: int, table: StatedGear) -> StatedFlank | None:
    """The table of the flank of a member of a mesh that works in it.

    A planet's other flank works against the ring, where the planet is member 1.
    """
    ring_side: StatedFlank | None = getattr(table, "micro_geometry_ring_side", None)
    return table.micro_geometry if member != 1 or ring_side is None else ring_side


def _of_member(mesh: Mesh, member: int, table: StatedGear) -> MicroGeometry:
    flank = working_flank(member, table)
    if flank is None:
        return MicroGeometry()
    gear = mesh.gears[member - 1]
    root, tip = active_profile(mesh, member)
    topography = None
    if (stated := flank.topography) is not None:
        rolls = tuple(gear.roll_length_at(diameter / 2) for diameter in stated.diameter)
        topography = Topography(rolls, stated.face_position, stated.deviation)
    return MicroGeometry(
        tip_relief=_profile_relief(gear, tip, flank, "tip_relief"),
        root_relief=_profile_relief(gear, root, flank, "root_relief"),
        end_relief=None
        if flank.end_relief == 0 or flank.end_relief_length is None
        else Relief(flank.end_relief, flank.end_relief_length, flank.end_relief_shape),
        profile_crown=flank.profile_crown,
        profile_slope=flank.profile_slope,
        lead_crown=flank.lead_crown,
        lead_slope=flank.lead_slope,
        topography=topography,
    )


def _profile_relief(gear: Gear, end: float, flank: StatedFlank, key: str) -> Relief | None:
    amount: float = getattr(flank, key)
    roll_length: float | None = getattr(flank, f"{key}_roll_length")
    diameter: float | None = getattr(flank, f"{key}_diameter")
    if diameter is not None:
        roll_length = abs(gear.roll_length_at(diameter / 2) - end)
    if amount == 0 or roll_length is None:
        return None
    return Relief(amount, roll_length, getattr(flank, f"{key}_shape"))
