"""What follows from the gears of a case before anything is computed, as on a data sheet."""

from __future__ import annotations

import math

from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass
from epicyclic.gears import measures
from epicyclic.gears.gear import Gear
from epicyclic.gears.gearing import Gearing
from epicyclic.gears.measures import FlankTolerances
from epicyclic.gears.mesh import Mesh, recommended_backlash
from epicyclic.gears.stated import StatedGear, allowance_shift, allowances, tolerances_of


@dataclass(frozen=True, slots=True)
class GearSheet:
    """One gear."""

    gear: Gear
    nominal_shift: float  # x before allowances. [1]
    tip_alteration: float  # k m_n of the default tip; 0 where the case states the tip. [m]
    normal_thickness: float  # s_n at the reference circle. [m]
    roughness: float  # Rq. [m]
    # k and W_k [m]; None for a helical ring, and where a span does not touch the flanks.
    span: tuple[int, float] | None
    pins: tuple[float, float] | None  # D_M and M_d [m]; None where balls do not touch the flanks.
    allowances: tuple[float, float] | None  # A_sne and A_sni, where the case states them. [m]
    tolerances: FlankTolerances | None  # By the class that the case states.


@dataclass(frozen=True, slots=True)
class MeshSheet:
    """One mesh."""

    mesh: Mesh
    recommended_backlash: float  # Least j_bn of ISO/TR 10064-2. [m]
    # Sliding over rolling speed of each member at its root. [1]
    specific_sliding: tuple[float | None, float | None]


@dataclass(frozen=True, slots=True)
class DataSheet:
    """The gears of a set or pair."""

    gears: tuple[GearSheet, ...]
    meshes: tuple[MeshSheet, ...]


def data_sheets(case: Case) -> dict[str, DataSheet]:
    """The gears of every computed set, by its name; that of a set or pair has none.

    Examples
    --------
    >>> import epicyclic as ep
    >>> sheet = data_sheets(ep.load_case("talbot-2012"))[""]
    >>> [one.gear.name for one in sheet.gears]
    ['sun', 'planet', 'ring']
    >>> round(sheet.meshes[0].mesh.transverse_contact_ratio, 2)
    1.36
    """
    return {
        name: DataSheet(
            tuple(_gear_sheet(gearing, gear, table) for gear, table in gearing.tables.items()),
            tuple(map(_mesh_sheet, gearing.geometries)),
        )
        for name, gearing in case.gearings.items()
        if gearing.computed
    }


def _gear_sheet(gearing: Gearing, name: str, table: StatedGear) -> GearSheet:
    gear, default = gearing.gear(name), table.tip_diameter is None
    rack = gear.rack
    thickness = 2 * gear.reference_radius * gear.thickness_half_angle
    return GearSheet(
        gear,
        gear.profile_shift_coefficient - allowance_shift(table, rack),
        -gearing.tip_shortenings.get(name, 0.0) if default else 0.0,
        thickness * math.cos(rack.helix_angle),
        table.roughness,
        _span(gear, table),
        _pins(gear, table),
        allowances(table, rack),
        tolerances_of(gear, table),
    )


def _on_flank(gear: Gear, radius: float) -> bool:
    low, high = sorted((gear.root_radius, gear.tip_radius))
    return low < radius < high


def _span(gear: Gear, table: StatedGear) -> tuple[int, float] | None:
    """As stated, or over the number of teeth whose span touches in the middle."""
    if gear.internal and gear.rack.helix_angle > 0:
        return None
    count = table.teeth_in_span or measures.usual_span_teeth(gear)
    value = measures.span(gear, count)
    return (count, value) if _on_flank(gear, measures.span_contact_radius(gear, value)) else None


def _pins(gear: Gear, table: StatedGear) -> tuple[float, float] | None:
    pin = table.measuring_pin_diameter or measures.usual_pin(gear.rack)
    try:
        radius = measures.pin_contact_radius(gear, pin)
        value = measures.dimension_over_pins(gear, pin)
    except ValueError:
        return None
    return (pin, value) if _on_flank(gear, radius) else None


def _mesh_sheet(mesh: Mesh) -> MeshSheet:
    start, end = mesh.path_start, mesh.path_end
    return MeshSheet(
        mesh,
        recommended_backlash(mesh.gear1.rack, mesh.center_distance),
        (
            _sliding(start, mesh.curvature2(start) / mesh.ratio),
            _sliding(mesh.curvature2(end), end * mesh.ratio),
        ),
    )


def _sliding(own: float, other: float) -> float | None:
    """zeta = 1 - v_other/v_own, the specific sliding of DIN 3960; None at the base circle. [1]"""
    return 1 - other / own if own > 0 else None
