"""Does a REXS file agree with itself, and with the geometry that is computed here?"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from epicyclic.case.build import pair_mesh, planetary_meshes
from epicyclic.case.case import Case, GearPairCase, PlanetaryCase
from epicyclic.case.train import TrainCase
from epicyclic.case.train_tables import PairSet
from epicyclic.case.train_tables import PlanetarySet as PlanetaryTable
from epicyclic.exchange.rexs.model import Component, Model
from epicyclic.exchange.rexs.sets import Pair, PlanetarySet, is_internal
from epicyclic.exchange.rexs.trains import Train
from epicyclic.geometry import mesh as geometry
from epicyclic.geometry.gear import involute
from epicyclic.units import DEGREE, MILLIMETRE, Quantity, format_number

AGREES = 1e-3
"""Relative difference up to which figures of two programs agree."""

SHIFT_AGREES = 0.02
"""Difference of profile shifts that allowances for backlash can make."""


def file_notes(chosen: PlanetarySet | Pair) -> Iterator[str]:
    """Contradictions within the file: hands of helices."""
    said: set[bool] = set()
    for mesh in chosen.meshes:
        first, second = map(_signed_helix, mesh.gears)
        internal = any(map(is_internal, mesh.gears))
        if first * second == 0 or (first * second > 0) == internal or internal in said:
            continue
        said.add(internal)
        hands = "the same hand, as on internal gears" if internal else "opposite hands"
        yield f"{mesh.gears[0]} and {mesh.gears[1]} should have {hands}: check the helix angles."


def _signed_helix(gear: Component) -> float:
    found = gear.get("helix_angle_reference_diameter")
    try:
        return 0.0 if found is None else found.number()
    except ValueError:  # told when it is read
        return 0.0


def geometry_notes(case: Case, chosen: PlanetarySet | Pair | Train, model: Model) -> Iterator[str]:
    """Figures of the file that differ from those of the case's geometry."""
    for mesh, components, stage in _all_computed(case, chosen):
        for gear, component in zip((mesh.gear1, mesh.gear2), components, strict=True):
            reference, base = 2 * gear.reference_radius, 2 * gear.base_radius
            yield from _compared(
                component, "reference_diameter_cylindrical_gear", reference, MILLIMETRE
            )
            yield from _compared(component, "base_diameter", base, MILLIMETRE)
        yield from _compared(stage, "radial_contact_ratio", mesh.transverse_contact_ratio)
        yield from _compared(stage, "overlap_contact_ratio", mesh.overlap_ratio)
        for data in model.partners(stage.id, "stage_gear_data", "stage", "stage_gear_data"):
            name = "operating_pressure_angle_in_the_transverse_section"
            yield from _compared(data, name, mesh.operating_pressure_angle, DEGREE)


_Computed = Iterator[tuple[geometry.Mesh, tuple[Component, Component], Component]]
"""Meshes as they are computed here, each with its gears and its stage in the file."""


def _all_computed(case: Case, chosen: PlanetarySet | Pair | Train) -> _Computed:
    """Every mesh; of a train those of its sets whose losses are computed."""
    if not isinstance(chosen, Train):
        if not isinstance(case, TrainCase):
            yield from _computed(case, chosen)
        return
    sets = case.sets if isinstance(case, TrainCase) else {}
    for name, one in chosen.sets.items():
        table = sets.get(name)
        if isinstance(table, PlanetaryTable | PairSet):
            yield from _computed(table, one)


def _computed(
    case: PlanetaryCase | GearPairCase | PlanetaryTable | PairSet, chosen: PlanetarySet | Pair
) -> _Computed:
    """The meshes of a set."""
    if isinstance(case, PlanetaryCase | PlanetaryTable) and isinstance(chosen, PlanetarySet):
        sun_mesh, ring_mesh = planetary_meshes(case.gears, case.sun, case.planet, case.ring)
        planet = chosen.planets[0]
        yield sun_mesh, (chosen.sun, planet), chosen.sun_meshes[0].stage
        yield ring_mesh, (planet, chosen.ring), chosen.ring_meshes[0].stage
    elif isinstance(case, GearPairCase | PairSet) and isinstance(chosen, Pair):
        mesh = pair_mesh(case.gears, case.pinion, case.gear)
        yield mesh, (chosen.pinion, chosen.gear), chosen.mesh.stage


def _compared(
    component: Component, attribute: str, computed: float, unit: Quantity | None = None
) -> Iterator[str]:
    """A note if `attribute` is given and is another than `computed`, in SI."""
    try:
        stated = component.amount(attribute)
        if stated is None:
            return
        number, name = stated
        value = abs(number) if unit is None else abs(unit.parse(f"{number!r} {name}"))
    except ValueError as error:
        yield f"{attribute} of {component} cannot be compared: it {error}."
        return
    if not math.isclose(value, computed, rel_tol=AGREES, abs_tol=AGREES * (unit is None)):
        here = format_number(computed) if unit is None else unit.text(computed)
        there = f"{format_number(number)} {name}".rstrip()
        yield f"{attribute} of {component} is {there}; computed here: {here}."


def closing_shift(tables: Mapping[str, Any], member1: str, member2: str) -> float | None:
    """Profile shift of `member2` that leaves no backlash at the centre distance. ISO 21771.

    None if the tables do not have all that it takes, or cannot mesh.
    """
    try:
        gears = tables["gears"]
        z1, z2 = (_signed_teeth(tables, name) for name in (member1, member2))
        x1 = tables[member1]["profile_shift_coefficient"]
        module = MILLIMETRE.parse(gears["normal_module"])
        center = MILLIMETRE.parse(gears["center_distance"])
        normal = DEGREE.parse(gears["normal_pressure_angle"])
        helix = DEGREE.parse(gears["helix_angle"])
        transverse = math.atan(math.tan(normal) / math.cos(helix))
        reference = abs(z1 + z2) * module / (2 * math.cos(helix))
        operating = math.acos(reference * math.cos(transverse) / center)
        difference = involute(operating) - involute(transverse)
        return (z1 + z2) * difference / (2 * math.tan(normal)) - float(x1)
    except (KeyError, ValueError, ArithmeticError):  # lacking, or no gears: told elsewhere
        return None


def _signed_teeth(tables: Mapping[str, Any], name: str) -> int:
    """Number of teeth as in ISO 21771: negative for internal gears."""
    table = tables[name]
    sign = -1 if name == "ring" or table.get("internal") else 1
    return sign * int(table["teeth"])


def shift_notes(
    tables: Mapping[str, Any], member1: str, member2: str, place: str = ""
) -> Iterator[str]:
    """A note if the profile shift of an internal gear seems to count the other way.

    `place` is where `tables` stand in the case.
    """
    table = tables.get(member2, {})
    shift = table.get("profile_shift_coefficient")
    is_ring = member2 == "ring" or table.get("internal", False)
    closing = closing_shift(tables, member1, member2) if is_ring else None
    if closing is None or not isinstance(shift, float) or abs(shift) < SHIFT_AGREES:
        return
    if abs(shift - closing) > SHIFT_AGREES >= abs(-shift - closing):
        yield (
            f"The profile shift {format_number(shift)} of the {member2} fits the centre distance "
            f"with the other sign only; if so, set {place}{member2}.profile_shift_coefficient = "
            f"{format_number(-shift)}."
        )
