"""Notes: what a user must know about a result besides its numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping

from epicyclic.builders.models import fitted_oil_model, friction_of, resolve_models, rolling_of
from epicyclic.case import build, flanks
from epicyclic.case.case import Case, PlanetaryCase
from epicyclic.case.gear_tables import GearTable, MeshTable
from epicyclic.case.model_tables import LoadSharing
from epicyclic.elements.figures import MeshFigures
from epicyclic.elements.gear_set import GearSetResult
from epicyclic.geometry.assembly import are_evenly_spaced
from epicyclic.losses.fitted import FittedFriction
from epicyclic.losses.load_distribution import LOAD_DISTRIBUTIONS
from epicyclic.losses.mixed_ehl_groups import TALBOT_FLUID
from epicyclic.results.result import LossTerm

__all__ = ["NOT_INCLUDED", "case_notes", "general_notes", "load_notes"]

NOT_INCLUDED = "Not included"
"""Begins the note that names loss terms which are missing."""
LEAST_CONTACT = 0.75
"""Share of the contact lines that carries below which a result says so. [1]"""


def case_notes(case: Case, found: GearSetResult, *, ring_turns: bool) -> tuple[str, ...]:
    """What a user must know about a set: its oil, its load, its flows, its planets."""
    meshes = {key: item for key, item in found.figures.items() if isinstance(item, MeshFigures)}
    notes = (*fluid_notes(case), *load_notes(case), *contact_notes(meshes), *found.notes)
    if not isinstance(case, PlanetaryCase):
        return notes
    return (
        *notes,
        *_planet_notes(case),
        *_share_notes(case.load_sharing, found.shares),
        *(_ring_notes(case) if ring_turns else ()),
    )


def fluid_notes(case: Case) -> tuple[str, ...]:
    """What was made for another oil than that of the case, and what the case changes in it."""
    oil, models = case.lubricant.oil, resolve_models(case)
    fluids = {
        "friction": friction_of(case).made_for,
        "rolling": rolling_of(case).made_for,
        "bearing": TALBOT_FLUID if models.get("bearing") == "mixed-ehl" else None,
    }
    notes = [
        f"models.{key}: the regression {models[key]} was made for {fluid.title}, not for "
        f"{oil.name}."
        for key, fluid in fluids.items()
        if fluid is not None and fluid.key != oil.friction_regression
    ]
    if FittedFriction.name in models.values() and fitted_oil_model(case).oil != oil:
        fitted = fitted_oil_model(case).oil.name
        notes.append(f"models.oil_model was fitted for {fitted}, not for {oil.name}.")
    factor = case.lubricant.pressure_viscosity_factor
    if factor != 1:
        notes.append(f"The pressure-viscosity coefficient of the oil is multiplied by {factor:g}.")
    return tuple(notes)


def contact_notes(meshes: Mapping[str, MeshFigures]) -> tuple[str, ...]:
    """A note on every mesh of which much does not carry."""
    return tuple(
        f"Only {mesh.contact_share:.0%} of the contact lines of the {name.replace('_', ' ')} carry "
        "load: the deviations of the flanks exceed what the teeth bend. Contact that begins or "
        "ends beyond the path of contact is not modelled."
        for name, mesh in meshes.items()
        if mesh.contact_share < LEAST_CONTACT
    )


def load_notes(case: Case) -> tuple[str, ...]:
    """Notes on deviations that the load distribution ignores, and on the rim of a ring gear."""
    notes = []
    model = case.models.load_distribution
    if _states_deviations(case) and not LOAD_DISTRIBUTIONS[model].takes_deviations:
        notes.append(
            f"models.load_distribution = {model} ignores micro-geometry and misalignment; "
            "compliance takes them into account."
        )
    return (*notes, *_rim_notes(case))


def _rim_notes(case: Case) -> Iterator[str]:
    """Where a rim leaves the assumptions of its formula."""
    name = "ring" if isinstance(case, PlanetaryCase) else "gear"
    table = case.ring if isinstance(case, PlanetaryCase) else case.gear
    thickness = build.rim_thickness(table)
    if thickness is None:
        return
    ring = build.gear(name, table, case.gears)
    height = ring.root_radius - ring.tip_radius
    if thickness < height:
        yield (
            f"{name}.rim_thickness is less than the height of the teeth, {1e3 * height:.4g} mm: "
            "the deflection of so thin a rim is outside what the compliance is made for."
        )
    if not isinstance(case, PlanetaryCase):
        return
    even = are_evenly_spaced(build.planet_angles(case.sun, case.planet, case.ring))
    if not even or case.load_sharing.method != "equal":
        yield (
            "ring.rim_thickness: the rim bends as under evenly spaced and equally loaded planets, "
            f"but these are {'not equally loaded' if even else 'not evenly spaced'}."
        )


def _states_deviations(case: Case) -> bool:
    gears: tuple[GearTable, ...]
    if isinstance(case, PlanetaryCase):
        gears = (case.sun, case.planet, case.ring)
        meshes: tuple[MeshTable, ...] = (case.sun_mesh, case.ring_mesh)
    else:
        gears, meshes = (case.pinion, case.gear), (case.mesh,)
    return any(mesh.misalignment for mesh in meshes) or any(map(flanks.micro_geometries, gears))


def general_notes(
    terms: Iterable[LossTerm], input_power: float, efficiency: float | None
) -> tuple[str, ...]:
    """Notes on what is missing, what is scaled, and on efficiency near zero load."""
    notes = []
    missing: dict[str, list[str]] = {}
    for term in terms:
        if term.left_out:
            missing.setdefault(term.left_out, []).append(term.name)
        elif term.factor != 1.0:
            notes.append(f"{term.name} is multiplied by {term.factor:g}.")
    notes += [
        f"{NOT_INCLUDED}: {', '.join(names)} ({reason})." for reason, names in missing.items()
    ]
    if efficiency == 0.0 and input_power > 0:
        notes.append(
            "The losses exceed the power passed on: no power leaves, and the output must be driven."
        )
    return tuple(notes)


def _planet_notes(case: PlanetaryCase) -> tuple[str, ...]:
    count, teeth = case.planet.count, case.sun.teeth + case.ring.teeth
    if case.planet.angles is not None or teeth % count == 0:
        return ()
    angles = build.planet_angles(case.sun, case.planet, case.ring)
    placed = ", ".join(f"{math.degrees(angle):.4f}" for angle in angles)
    return (
        f"{count} planets cannot be equally spaced, because ({case.sun.teeth} + "
        f"{case.ring.teeth})/{count} is no integer; they stand at {placed} deg.",
    )


def _share_notes(sharing: LoadSharing, shares: tuple[float, ...]) -> tuple[str, ...]:
    notes = []
    if len(set(shares)) > 1:
        most = shares.index(max(shares)) + 1
        notes.append(f"Meshes and bearing are those of planet {most}, the most loaded one.")
    notes += [
        f"load_sharing.{key} has no effect with load_sharing.method = {sharing.method}."
        for key in sharing.idle_keys()
    ]
    return tuple(notes)


def _ring_notes(case: PlanetaryCase) -> tuple[str, ...]:
    if case.ring.rim_thickness is not None:
        return ()
    return (
        "ring.rim_thickness is not given: the drag of the turning ring is that of a rim of "
        f"{build.DEFAULT_RIM_THICKNESS:g} normal modules.",
    )
