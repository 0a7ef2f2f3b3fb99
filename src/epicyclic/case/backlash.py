"""Teeth that are too thick for their mesh, or far too thin, and what would fit."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from epicyclic.case.gear_tables import GearTable
from epicyclic.case.messages import micrometres, millimetres
from epicyclic.case.thickness import DIGITS, fitting, thickness_key
from epicyclic.errors import Problem
from epicyclic.gears.gear import Gear
from epicyclic.gears.mesh import (
    Mesh,
    closed_center_distance,
    profile_shift_sum,
    recommended_backlash,
    thinning,
)

ROUNDING = 1e-9
"""Clearances count as negative beyond this: drawings may state exactly zero. [m]"""

GROSS = 5.0
"""Backlash over the recommended one from which a result says so; an estimate. [1]"""

TOO_THIN = "its teeth are too thin for their centre distance"
"""By which a warning of that is known."""

Tables = Mapping[str, GearTable]


def check_backlash(mesh: Mesh, tables: Tables, distance_key: str) -> list[Problem]:
    """Teeth that are too thick, with the thickness and the centre distance that fit."""
    if mesh.backlash >= -ROUNDING:
        return []
    gears = (mesh.gear1, mesh.gear2)
    keys = [thickness_key(gear.name, tables[gear.name]) for gear in gears]
    fits = " or ".join(_fitting(mesh, gear, tables[gear.name]) for gear in gears)
    usual = micrometres(_recommended(mesh))
    return [
        Problem(
            ", ".join(keys),
            "",
            f"the teeth of the {mesh.name} are {millimetres(-mesh.backlash)} too thick for the "
            f"centre distance of {millimetres(mesh.center_distance)} (negative backlash).",
            f"Without backlash {fits} fits{_distance(mesh, distance_key)}; "
            f"{_recommended_shift(mesh):.4f} less of one x leaves {usual}, recommended by "
            f"ISO/TR 10064-2.{_other_sign(mesh, tables)}",
        )
    ]


def backlash_notes(mesh: Mesh, tables: Tables) -> Iterator[str]:
    """A note on teeth that are far too thin for their mesh."""
    backlash, usual = mesh.normal_backlash, _recommended(mesh)
    if backlash <= GROSS * usual:
        return
    gears = (mesh.gear1, mesh.gear2)
    fits = " or ".join(_fitting(mesh, gear, tables[gear.name], usual) for gear in gears)
    yield (
        f"The {mesh.name} has a normal backlash of {millimetres(backlash)}, "
        f"{backlash / usual:.2g} times the {micrometres(usual)} that ISO/TR 10064-2 recommends: "
        f"{TOO_THIN}. With {fits} it has that."
        f"{_other_sign(mesh, tables)}"
    )


def _recommended(mesh: Mesh) -> float:
    return recommended_backlash(mesh.gear1.rack, mesh.center_distance)


def _recommended_shift(mesh: Mesh) -> float:
    return thinning(mesh.gear1.rack, _recommended(mesh))


def _teeth(mesh: Mesh) -> int:
    """z1 + z2 with the sign of ISO 21771."""
    return mesh.gear1.teeth + mesh.side * mesh.gear2.teeth


def _over(mesh: Mesh, backlash: float = 0.0) -> float:
    """x1 + x2 less what leaves this normal backlash. [1]"""
    wanted = profile_shift_sum(mesh.gear1.rack, _teeth(mesh), mesh.center_distance, backlash)
    gears = (mesh.gear1, mesh.gear2)
    return sum(gear.profile_shift_coefficient for gear in gears) - wanted


def _fitting(mesh: Mesh, gear: Gear, table: GearTable, backlash: float = 0.0) -> str:
    """The thickness of a gear that leaves this backlash, as the case states it."""
    return fitting(gear, table, _over(mesh, backlash))


def _distance(mesh: Mesh, key: str) -> str:
    """What centre distance the teeth fit, rounded to the loose side."""
    total = mesh.gear1.profile_shift_coefficient + mesh.gear2.profile_shift_coefficient
    try:
        distance = closed_center_distance(mesh.gear1.rack, _teeth(mesh), total)
    except ValueError:
        return ""
    loose = math.floor if mesh.internal else math.ceil
    return f', or {key} = "{loose(distance * 1e6) / 1e3:.3f} mm"'


def _other_sign(mesh: Mesh, tables: Tables) -> str:
    """A hint if the profile shift of a ring fits with the other sign."""
    ring = mesh.gear2
    shift = tables[ring.name].profile_shift_coefficient
    if not mesh.internal or not shift:
        return ""
    over = _over(mesh) - 2 * shift
    if not -GROSS * _recommended_shift(mesh) <= over <= 10.0**-DIGITS:
        return ""
    return (
        f" With the other sign, {-shift:g}, x of the {ring.name} fits: in ISO 21771 positive x "
        "thickens the teeth."
    )
