"""The kinds of elements that a case adds by tables of their own: bearings, seals, other drags.

A new kind is one module in `epicyclic.elements`, one table of keys, one line in `ELEMENT_KINDS`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from epicyclic.case.messages import did_you_mean, millimetres, written
from epicyclic.case.tables.base import Table
from epicyclic.case.tables.elements import DragTable, LossTableTable, SealTable, ShaftBearingTable
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.losses.loss_table import LossQuantity, LossTable, read_loss_table, table_problems
from epicyclic.losses.shaft_bearing import (
    DEFAULT_COEFFICIENTS,
    DEFAULT_FLANGE_COEFFICIENTS,
    DEFAULT_VISCOUS_FACTORS,
    STARVATION,
    BearingLoad,
    BearingModel,
    CatalogueBearing,
    ContactSeal,
    PalmgrenModel,
    SkfModel,
    TableModel,
    bearing_types,
    full_film_friction,
    skf_constants,
    skf_series,
)
from epicyclic.machine.element import HOUSING, Element
from epicyclic.machine.shaft_parts import Seal, SealFormula, ShaftBearing, TableLoss
from epicyclic.oil.oil import Oil
from epicyclic.oil.properties import oil_state

_FORTY_CELSIUS = 313.15
"""40 degC in kelvin."""


class ElementKind(NamedTuple):
    """A kind of element."""

    table: type[Table]  # The class of its keys.
    # ``build(name, table, *, shafts, oil, folder)`` gives the element called `name`; `shafts` are
    # the bodies beside the housing by all their names, `folder` is that of the case. Raises
    # `InputError` for unknown shafts and files that cannot be used, with keys relative to the
    # table.
    build: Callable[..., Element]
    # The problems of a table that need no other table, with keys relative to it.
    check: Callable[[Any], list[Problem]]


# --- bearings -------------------------------------------------------------------------------------


def build_bearing(
    name: str, table: ShaftBearingTable, *, shafts: Mapping[str, str], oil: Oil, folder: Path
) -> ShaftBearing:
    """A bearing from its table, which `bearing_problems` found sound."""
    between = _between({"shaft": table.shaft, "against": table.against}, shafts)
    force = None
    if table.radial_force is not None:
        force = BearingLoad(radial=table.radial_force, axial=table.axial_force or 0.0)
    return ShaftBearing(
        key=name,
        between=between,
        bearing=_catalogue_bearing(table),
        model=_bearing_model(table, oil, folder),
        force=force,
        minimum_load_factor=table.minimum_load_factor,
        reference_speed=table.reference_speed,
    )


def _catalogue_bearing(table: ShaftBearingTable) -> CatalogueBearing:
    axial_factor = table.axial_factor
    if axial_factor is None and table.contact_angle is not None:
        axial_factor = 0.4 / math.tan(table.contact_angle)
    return CatalogueBearing(
        type=table.type,
        bore=table.bore,
        outside_diameter=table.outside_diameter,
        width=_known(table.width),
        cage=table.cage,
        dynamic_load_rating=_known(table.dynamic_load_rating),
        static_load_rating=_known(table.static_load_rating),
        axial_factor=_known(axial_factor),
    )


def _known(value: float | None) -> float:
    return math.nan if value is None else value


def _bearing_model(table: ShaftBearingTable, oil: Oil, folder: Path) -> BearingModel:
    if table.model == "table":
        assert table.table is not None
        return TableModel(_loss_table(table.table, folder, "table.", LossTableTable.AXES))
    if table.model == "skf-2018":
        return _skf_model(table, oil)
    kind = (table.type, table.cage)
    constant = None
    if table.model == "palmgren":
        constant = table.palmgren_coefficient or DEFAULT_COEFFICIENTS[kind]
    factor, flange = table.viscous_factor, table.flange_coefficient
    return PalmgrenModel(
        viscous_factor=DEFAULT_VISCOUS_FACTORS[kind] if factor is None else factor,
        constant=constant,
        flange_coefficient=DEFAULT_FLANGE_COEFFICIENTS[table.cage] if flange is None else flange,
    )


def _skf_model(table: ShaftBearingTable, oil: Oil) -> SkfModel:
    seal = table.seal
    friction = table.sliding_friction
    return SkfModel(
        constants=skf_constants(table.type, table.series or "", table.cage),
        full_film_friction=full_film_friction(table.type, oil.kind)
        if friction is None
        else friction,
        starvation=STARVATION[table.lubrication],
        oil_level=table.oil_level,
        drag_variable=table.drag_variable,
        seal=None
        if seal is None
        else ContactSeal(seal.counterface_diameter, seal.factor, seal.exponent, seal.constant),
    )


def bearing_problems(table: ShaftBearingTable) -> list[Problem]:
    """What contradicts itself, or is missing, in the table of a bearing."""
    problems = _size_problems(table) + _force_problems(table)
    if table.type not in bearing_types(table.model):
        reason = f"has no constants for {table.type} roller bearings."
        remedy = 'Choose model = "palmgren" or "table".'
        return [*problems, Problem("model", written(table.model), reason, remedy)]
    if table.model == "table":
        return problems + _own_table_problems(table, LossTableTable.AXES)
    problems += _own_table_problems(table, LossTableTable.AXES)
    if table.model == "skf-2018":
        problems += _skf_problems(table)
    if (
        table.type == "deep-groove"
        and table.model in ("harris", "skf-2018")
        and table.static_load_rating is None
    ):
        reason = f"is missing; the model {table.model} needs it for ball bearings."
        problems.append(Problem("static_load_rating", "", reason, "Add C0 from the catalogue."))
    return problems


def _size_problems(table: ShaftBearingTable) -> list[Problem]:
    problems = []
    if table.bore >= table.outside_diameter:
        reason = f"must be less than outside_diameter, {millimetres(table.outside_diameter)}."
        problems.append(Problem("bore", millimetres(table.bore), reason, "Correct one of the two."))
    if (table.type, table.cage) not in DEFAULT_VISCOUS_FACTORS:
        reason = f"is not made as a {table.type} bearing."
        remedy = 'Write cage = "caged", or choose cylindrical or needle rollers.'
        problems.append(Problem("cage", written(table.cage), reason, remedy))
    angles = [key for key in ("axial_factor", "contact_angle") if getattr(table, key) is not None]
    if table.type == "tapered" and table.model != "table" and len(angles) != 1:
        reason = "is missing; needed is axial_factor or contact_angle."
        if angles:
            reason = "is given beside contact_angle; either follows from the other."
        remedy = "Delete one." if angles else "Add Y from the catalogue, or the contact angle."
        problems.append(Problem("axial_factor", "", reason, remedy))
    if table.type != "tapered":
        problems += [
            Problem(key, "", "belongs to tapered roller bearings.", "Delete it.") for key in angles
        ]
    return problems


def _force_problems(table: ShaftBearingTable) -> list[Problem]:
    problems = _same_body_problems({"shaft": table.shaft, "against": table.against})
    if table.axial_force is not None and table.radial_force is None:
        remedy = 'Add radial_force = "0 N" if there is none.'
        problems.append(Problem("radial_force", "", "is missing; axial_force is given.", remedy))
    if table.type == "needle":
        reason = "is asked of a needle roller bearing, which takes no axial force."
        remedy = "Let another bearing locate the shaft."
        if table.locating:
            problems.append(Problem("locating", "true", reason, remedy))
        if table.axial_force:
            problems.append(Problem("axial_force", f"{table.axial_force:g} N", reason, remedy))
    return problems


def _skf_problems(table: ShaftBearingTable) -> list[Problem]:
    problems = []
    known = skf_series(table.type)
    needs_series = table.cage == "caged"
    choice = ", ".join(known)
    if needs_series and table.series is None:
        remedy = f"Give one of {choice}."
        problems.append(
            Problem("series", "", f"is missing; SKF has a row for each: {choice}.", remedy)
        )
    elif needs_series and table.series not in known:
        remedy = did_you_mean(table.series or "", known) or 'Or choose model = "palmgren".'
        reason = f"is not in the table; known of {table.type} bearings are {choice}."
        problems.append(Problem("series", written(table.series), reason, remedy))
    if table.oil_level > 0 and table.type != "deep-groove" and table.width is None:
        reason = "is missing; the drag of rollers in an oil bath needs it."
        problems.append(Problem("width", "", reason, "Add B from the catalogue."))
    return problems


# --- seals ----------------------------------------------------------------------------------------


def build_seal(
    name: str, table: SealTable, *, shafts: Mapping[str, str], oil: Oil, folder: Path
) -> Seal:
    """A seal from its table, which `seal_problems` found sound."""
    between = _between({"shaft": table.shaft, "against": table.against}, shafts)
    model: SealFormula | LossTable
    if table.model == "table":
        assert table.table is not None
        model = _loss_table(table.table, folder, "table.", ("speed", "temperature"))
    else:
        model = table.model
    viscosity = oil_state(oil, _FORTY_CELSIUS).kinematic_viscosity
    return Seal(name, between, table.diameter, model, viscosity)


def seal_problems(table: SealTable) -> list[Problem]:
    """What contradicts itself, or is missing, in the table of a seal."""
    bodies = {"shaft": table.shaft, "against": table.against}
    return _same_body_problems(bodies) + _own_table_problems(table, ("speed", "temperature"))


# --- other drags ----------------------------------------------------------------------------------


def build_drag(
    name: str, table: DragTable, *, shafts: Mapping[str, str], oil: Oil, folder: Path
) -> TableLoss:
    """A drag from its table, which `drag_problems` found sound."""
    first, second = table.between
    between = _between({"between[0]": first, "between[1]": second}, shafts)
    return TableLoss(name, between, _loss_table(table, folder, "", ("speed", "temperature")))


def drag_problems(table: DragTable) -> list[Problem]:
    """What contradicts itself, or is missing, in the table of a drag."""
    first, second = table.between
    problems = _same_body_problems({"between[0]": first, "between[1]": second})
    return problems + loss_table_problems(table, ("speed", "temperature"))


# --- what they share ------------------------------------------------------------------------------


def _between(names: Mapping[str, str], shafts: Mapping[str, str]) -> tuple[str, str]:
    """The two bodies of these names, by their keys; raises `InputError` for unknown ones."""
    known = {**shafts, HOUSING: HOUSING}
    problems = [
        Problem(
            key,
            written(body),
            f"is not a shaft; known are {', '.join(dict.fromkeys(known.values()))}.",
            did_you_mean(body, known) or "Check the name.",
        )
        for key, body in names.items()
        if body not in known
    ]
    raise_any(problems)
    first, second = (known[name] for name in names.values())
    if first == second:
        reason = f"is the same shaft, {first}, by another name: nothing moves between them."
        key, name = list(names.items())[1]
        raise InputError([Problem(key, written(name), reason, "Name another shaft.")])
    return first, second


def _same_body_problems(bodies: Mapping[str, str]) -> list[Problem]:
    (_, first), (key, second) = bodies.items()
    if first != second:
        return []
    reason = "is the same body twice: nothing moves between them."
    return [Problem(key, written(second), reason, f'Name another shaft, or "{HOUSING}".')]


def _own_table_problems(
    table: ShaftBearingTable | SealTable, axes: Collection[str]
) -> list[Problem]:
    """Problems of the loss table of an element, and of one that is missing or idle."""
    if table.model != "table":
        idle = Problem("table", "", 'belongs to model = "table".', "Delete it, or choose that.")
        return [] if table.table is None else [idle]
    if table.table is None:
        reason = "needs a table of friction torque or power."
        return [Problem("model", '"table"', reason, "Add table, or choose another model.")]
    return [
        Problem(f"table.{found.key}".rstrip("."), found.value, found.allowed, found.remedy)
        for found in loss_table_problems(table.table, axes)
    ]


def loss_table_problems(table: LossTableTable, axes: Collection[str]) -> list[Problem]:
    """What contradicts itself in a table of torque or power that may have `axes`."""
    contents = [key for key in ("torque", "power", "file") if getattr(table, key) is not None]
    if len(contents) != 1:
        reason = "must have exactly one of torque, power and file."
        given = " and ".join(contents)
        return [Problem(contents[0] if contents else "", given, reason, "Give one of them.")]
    given_axes = table.axes()
    problems = [
        Problem(name, "", "is no axis here: only bearings carry a load.", "Delete it.")
        for name in given_axes
        if name not in axes
    ]
    if contents == ["file"]:
        problems += [
            Problem(name, "", "is given beside file, which has its own axes.", "Delete it.")
            for name in given_axes
        ]
        return problems
    quantity: LossQuantity = "torque" if table.torque is not None else "power"
    return problems or table_problems(quantity, given_axes, getattr(table, quantity))


def _loss_table(
    table: LossTableTable, folder: Path, prefix: str, axes: Collection[str]
) -> LossTable:
    """The table as it is interpolated; raises `InputError` if its file cannot be used."""
    if table.file is None:
        quantity: LossQuantity = "torque" if table.torque is not None else "power"
        values = np.asarray(getattr(table, quantity), dtype=float)
        points = {name: np.asarray(given) for name, given in table.axes().items()}
        return LossTable(quantity, points, values)
    try:
        found = read_loss_table(folder / table.file)
    except InputError as error:
        raise InputError(
            Problem(
                f"{prefix}file",
                written(table.file),
                " ".join(part for part in (one.key, one.value, one.allowed) if part),
                one.remedy,
            )
            for one in error.problems
        ) from None
    if not set(found.names) <= set(axes):
        reason = f"may have the axes {' and '.join(axes)} only."
        remedy = "Delete the column radial_force."
        raise InputError([Problem(f"{prefix}file", written(table.file), reason, remedy)])
    return found


ELEMENT_KINDS: Mapping[str, ElementKind] = {
    "bearings": ElementKind(ShaftBearingTable, build_bearing, bearing_problems),
    "seals": ElementKind(SealTable, build_seal, seal_problems),
    "drags": ElementKind(DragTable, build_drag, drag_problems),
}
"""By the name of the tables in a case: ``[bearings.NAME]``, ``[seals.NAME]``, ``[drags.NAME]``."""
