"""The elements that a train adds by tables of their own: bearings, seals, other drags.

A new kind is one module in `epicyclic.machine`, one table of keys with its line in `ElementTables`
of `epicyclic.case.tables.elements`, and one function here with its line in `_BUILDERS`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from epicyclic.case.tables.elements import (
    ClutchTable,
    DragTable,
    SealTable,
    ShaftBearingTable,
    between,
)
from epicyclic.losses.designations import SEALED, DesignatedBearing, designated, with_elements
from epicyclic.losses.houpert import CONFORMITIES, THRUST_CONFORMITIES, THRUST_SHARES, BallModel
from epicyclic.losses.shaft_bearing import (
    DEFAULT_FLANGE_COEFFICIENTS,
    TYPE_CONSTANTS,
    AxialSpring,
    BearingLoad,
    CatalogueBearing,
    PalmgrenModel,
    TableModel,
    bearing_types,
    preload_of,
)
from epicyclic.losses.skf_2018 import (
    STARVATION,
    SkfConstants,
    SkfModel,
    full_film_friction,
    seal_moment,
    skf_constants,
    skf_series,
    skf_supply,
)
from epicyclic.losses.zhou_hoeprich import (
    RIB_HEIGHT,
    RIB_ROUGHNESS,
    ROLLER_SHARES,
    CylindricalModel,
    TaperedModel,
    ThrustRollerModel,
)
from epicyclic.machine.clutch import Clutch
from epicyclic.machine.element import Element
from epicyclic.machine.shaft_parts import BearingModel, Seal, ShaftBearing, TableLoss
from epicyclic.oil.oil import Oil, oil_state

_OF_PALMGREN = ("viscous_factor", "palmgren_coefficient", "flange_coefficient")
_OF_SKF = ("seal", "oil_level", "drag_variable", "sliding_friction", "lubrication")
_UNUSED = {
    "palmgren": _OF_SKF,
    "harris": (*_OF_SKF, "palmgren_coefficient"),
    "houpert": (*_OF_PALMGREN, "sliding_friction"),
    "zhou-hoeprich": (*_OF_PALMGREN, "sliding_friction"),
}
"""Keys that a model does not use; other models do not use those of Palmgren's."""
_FORTY_CELSIUS = 313.15  # 40 degC in kelvin.


def _bearing(
    name: str, table: ShaftBearingTable, bodies: tuple[str, str], oil: Oil, folder: Path
) -> ShaftBearing:
    force = None
    if table.radial_force is not None or table.axial_force is not None:
        force = BearingLoad(radial=table.radial_force or 0.0, axial=table.axial_force or 0.0)
    model = _bearing_model(table, oil, folder)
    idle = {*_UNUSED.get(model.name, _OF_PALMGREN)}
    idle |= {"flange_coefficient"} if table.type != "cylindrical" else set()
    idle |= {"drag_variable"} if not table.oil_level else set()
    usual = ShaftBearingTable(shaft="any", type="needle", bore="1 mm", outside_diameter="2 mm")
    lacks = f"seal friction of {table.designation} is not included. Give seal with model skf-2018."
    sealed = SEALED.search(table.designation or "")
    return ShaftBearing(
        key=name,
        between=bodies,
        bearing=catalogue_bearing(table),
        model=model,
        force=force,
        idle=tuple(sorted(it for it in idle if getattr(table, it) != getattr(usual, it))),
        minimum_load_factor=table.minimum_load_factor,
        reference_speed=table.reference_speed,
        limiting_speed=table.limiting_speed,
        lacks=(lacks,) if sealed and (table.seal is None or model.name != "skf-2018") else (),
    )


def catalogue_bearing(table: ShaftBearingTable) -> CatalogueBearing:
    """The bearing that a table describes, with estimated ratings if it names a designation."""
    axial_factor = table.axial_factor
    if axial_factor is None and table.contact_angle is not None:
        axial_factor = 0.4 / math.tan(table.contact_angle)
    dynamic, static, estimated = table.dynamic_load_rating, table.static_load_rating, ""
    if table.designation is not None and (dynamic is None or static is None):
        own = designated(table.designation)
        estimated = table.designation if own.elements else ""
        dynamic = dynamic or own.dynamic_load_rating
        static = static or own.static_load_rating
    return CatalogueBearing(
        type=table.type,
        bore=table.bore,
        outside_diameter=table.outside_diameter,
        width=_known(table.width),
        cage=table.cage,
        dynamic_load_rating=_known(dynamic),
        static_load_rating=_known(static),
        axial_factor=_known(axial_factor),
        estimated=estimated,
    )


def axial_preload(table: ShaftBearingTable, other: ShaftBearingTable) -> float:
    """Axial force with which two bearings of a shaft press each other from the start. [N]"""
    force = max(table.preload or 0.0, other.preload or 0.0)
    approach = max(table.preload_displacement or 0.0, other.preload_displacement or 0.0)
    if approach:
        force = max(force, preload_of(approach, (_spring(table), _spring(other))))
    return force


def _spring(table: ShaftBearingTable) -> AxialSpring:
    angle = catalogue_bearing(table).contact_angle
    size = 1e3 * table.bore, 1e3 * table.outside_diameter, 1e3 * (table.width or 0.0)
    if table.type == "angular-contact":
        fits = with_elements(DesignatedBearing("", table.type, *size, angle))
        return AxialSpring(fits.elements, fits.element_diameter, 0.0, angle)
    count, diameter, length = _rollers(table)
    usual = ROLLER_SHARES["tapered"][2] * (0.8 * (table.outside_diameter - table.bore) / 2)
    return AxialSpring(count, diameter, length or usual, angle)


def _known(value: float | None) -> float:
    return math.nan if value is None else value


def _bearing_model(table: ShaftBearingTable, oil: Oil, folder: Path) -> BearingModel:
    if table.model == "table":
        points = table.points(folder)
        assert points is not None
        return TableModel(points)
    if table.model == "skf-2018":
        return _skf_model(table, oil, skf_constants(table.type, table.series or "", table.cage))
    by_film = _film_model(table, oil)
    if by_film is not None:
        return by_film
    known, constant = TYPE_CONSTANTS[table.type, table.cage], None
    if table.model != "harris":
        constant = table.palmgren_coefficient or known.coefficient
    factor, flange = table.viscous_factor, table.flange_coefficient
    return PalmgrenModel(
        viscous_factor=known.viscous_factor if factor is None else factor,
        constant=constant,
        flange_coefficient=DEFAULT_FLANGE_COEFFICIENTS[table.cage] if flange is None else flange,
    )


def _film_model(table: ShaftBearingTable, oil: Oil) -> BearingModel | None:
    """By the films in the contacts; None where f0 or f1 is stated, or a roller's length unknown."""
    stated = table.palmgren_coefficient is not None
    stated |= table.type == "cylindrical" and table.flange_coefficient is not None
    chosen = table.model in ("zhou-hoeprich", "houpert")
    if not (chosen or table.model == "auto"):
        return None
    if table.type in bearing_types("houpert") or table.type == "thrust-roller":
        if not chosen and (stated or table.viscous_factor is not None):
            return None
        if table.type != "thrust-roller":
            return _balls(table, oil)
        supply = skf_supply(table.type)
        return ThrustRollerModel(*_rollers(table), skf=_skf_model(table, oil, supply))
    if not _roller_length(table):
        return None
    if table.type == "tapered":
        return _tapered_model(table, oil)
    caged = table.cage == "caged" and (chosen or not stated)
    return _cylindrical_model(table, oil) if caged else None


def _balls(table: ShaftBearingTable, oil: Oil) -> BallModel:
    bearing = catalogue_bearing(table)
    thrust, (share, fill) = table.type == "thrust-ball", THRUST_SHARES
    diameter = table.roller_diameter
    if thrust and diameter is None:
        diameter = share * (table.outside_diameter - table.bore)
    angle = bearing.contact_angle if table.type == "angular-contact" else 0.0
    sizes = 1e3 * table.bore, 1e3 * table.outside_diameter, 0.0, angle
    fits = with_elements(
        DesignatedBearing("", table.type, *sizes), None if diameter is None else 1e3 * diameter
    )
    fitting = int(fill * math.pi * fits.pitch_diameter / fits.element_diameter)
    return BallModel(
        balls=table.rollers or (fitting if thrust else fits.elements),
        ball_diameter=fits.element_diameter,
        conformities=THRUST_CONFORMITIES if thrust else CONFORMITIES,
        static_load_rating=table.static_load_rating or fits.static_load_rating,
        skf=_skf_model(table, oil, skf_supply(table.type)),
    )


def _rollers(table: ShaftBearingTable) -> tuple[int, float, float]:
    """Number, diameter and length of the rollers."""
    share, fill, _ = ROLLER_SHARES[table.type]
    diameter = table.roller_diameter or share * (table.outside_diameter - table.bore)
    pitch_circle = math.pi * (table.outside_diameter + table.bore) / 2
    count = table.rollers or max(4, int(fill * pitch_circle / diameter))
    return count, diameter, _roller_length(table)


def _roller_length(table: ShaftBearingTable) -> float:
    """Of tapered, cylindrical or thrust rollers; 0 where it is not known."""
    if table.type not in ROLLER_SHARES:
        return 0.0
    across = table.width or 0.0
    if table.type == "thrust-roller":
        across = table.outside_diameter - table.bore
    return table.roller_length or ROLLER_SHARES[table.type][2] * across


def _tapered_model(table: ShaftBearingTable, oil: Oil) -> TaperedModel:
    height = table.outside_diameter - table.bore
    return TaperedModel(
        *_rollers(table),
        rib_height=table.rib_height or RIB_HEIGHT * height,
        rib_roughness=table.rib_roughness or RIB_ROUGHNESS,
        skf=_skf_model(table, oil, skf_supply(table.type, table.cage)),
    )


def _cylindrical_model(table: ShaftBearingTable, oil: Oil) -> CylindricalModel:
    known, factor = TYPE_CONSTANTS[table.type, "caged"], table.viscous_factor
    return CylindricalModel(
        *_rollers(table),
        viscous_factor=known.viscous_factor if factor is None else factor,
        # all series slide alike
        skf=_skf_model(table, oil, skf_constants(table.type, skf_series(table.type)[0])),
    )


def _skf_model(table: ShaftBearingTable, oil: Oil, constants: SkfConstants) -> SkfModel:
    friction, sealed = table.sliding_friction, 0.0
    if friction is None:
        friction = full_film_friction(table.type, oil.kind)
    if (seal := table.seal) is not None:
        sealed = seal_moment(seal.counterface_diameter, seal.factor, seal.exponent, seal.constant)
    return SkfModel(
        constants=constants,
        full_film_friction=friction,
        starvation=STARVATION[table.lubrication],
        oil_level=table.oil_level,
        drag_variable=table.drag_variable,
        seal_moment=sealed,
    )


def _seal(name: str, table: SealTable, bodies: tuple[str, str], oil: Oil, folder: Path) -> Seal:
    viscosity = oil_state(oil, _FORTY_CELSIUS).kinematic_viscosity
    model = table.model if table.model != "table" else table.points(folder)
    assert model is not None
    return Seal(name, bodies, table.diameter, model, viscosity)


def _clutch(
    name: str, table: ClutchTable, bodies: tuple[str, str], oil: Oil, folder: Path
) -> Clutch:
    return Clutch(
        key=name,
        between=bodies,
        gaps=table.gaps,
        inner=table.inner_diameter / 2,
        outer=table.outer_diameter / 2,
        gap=table.gap,
        slope=1.0 if table.cone_angle is None else math.sin(table.cone_angle),
        flow=table.oil_flow,
    )


def _drag(
    name: str, table: DragTable, bodies: tuple[str, str], oil: Oil, folder: Path
) -> TableLoss:
    return TableLoss(name, bodies, table.points(folder))


_BUILDERS: Mapping[str, Callable[..., Element]] = {
    "bearings": _bearing,
    "seals": _seal,
    "clutches": _clutch,
    "drags": _drag,
}


def build_element(
    kind: str,  # A field of `ElementTables`, ``"bearings"``.
    name: str,
    table: Any,  # Its table, which the checks found sound.
    *,
    shafts: Mapping[str, str],  # The bodies beside the housing, by all their names.
    oil: Oil,
    folder: Path,  # That of the case.
) -> Element:
    """The element of a table; raises `InputError` for unknown shafts and bad files."""
    return _BUILDERS[kind](name, table, between(table, shafts), oil, folder)
