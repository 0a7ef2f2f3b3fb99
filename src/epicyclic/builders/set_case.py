"""A gear set with computed losses as the builders see it, whichever case it is part of."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from epicyclic.case.case import Case, GearPairCase, PlanetaryCase
from epicyclic.case.gearing import Gearing
from epicyclic.case.tables.elements import Carrier, PlanetBearing, ThrustBearing
from epicyclic.case.tables.models import (
    ContactSolver,
    FrictionTable,
    LoadSharing,
    LossOption,
    Numerics,
    PlanetaryModels,
)
from epicyclic.case.tables.operation import Lubricant, LubricationTable, Surroundings, ThermalTable
from epicyclic.case.train import TrainCase
from epicyclic.case.train_tables import ComputedSet, ListedSet


@dataclass(frozen=True, slots=True)
class SetCase:
    """A gear set with its tables, and those of the case that it is part of."""

    gearing: Gearing
    models: PlanetaryModels  # Those of a pair with the defaults of what planets need.
    numerics: Numerics
    losses: Mapping[str, LossOption]  # In the order in which they are shown.
    sharing: LoadSharing | None  # None without planets.
    bearings: Mapping[str, PlanetBearing | None]  # By the body of the planets.
    carrier: Carrier | None
    thrust_bearing: ThrustBearing | None
    lubrication: LubricationTable | None
    lubricant: Lubricant
    surroundings: Surroundings
    thermal: ThermalTable
    friction_table: FrictionTable | None
    contact_solver: ContactSolver
    folder: Path  # Where the files lie that it names.
    found: tuple[str, ...]  # Notes on what its tables leave out.


def set_cases(
    case: Case,
    sets: Iterable[str],  # Names; that of a single set is empty.
) -> Iterator[tuple[str, SetCase]]:
    """Name and case of each of some sets whose losses are computed."""
    if not isinstance(case, TrainCase):
        yield "", _set_case(case, case, case.gearings[""], tuple(map(str, case.found)))
        return
    tables = dict(case.computed_sets)
    for name in sets:
        yield name, _set_case(case, tables[name], case.gearings[name], ())


def _set_case(
    case: Case,
    table: PlanetaryCase | GearPairCase | ComputedSet,
    gearing: Gearing,
    found: tuple[str, ...],
) -> SetCase:
    parts = dict(table)
    bearing, own = parts.get("planet_bearing"), parts.get("planet_bearings", {})
    losses = dict(table.losses)
    if isinstance(table, ListedSet):
        losses = {name: losses.get(name, LossOption()) for name in gearing.terms}
    models = table.models
    if not isinstance(models, PlanetaryModels):
        models = PlanetaryModels.model_construct(**dict(models))
    if models.temperatures != case.models.temperatures:  # those of a train hold for all its sets
        models = models.model_copy(update={"temperatures": case.models.temperatures})
    assert case.lubricant is not None
    return SetCase(
        gearing,
        models,
        table.numerics,
        losses,
        parts.get("load_sharing") if gearing.count else None,
        {body: own.get(body, bearing) for body in gearing.planets},
        parts.get("carrier"),
        parts.get("thrust_bearing"),
        table.lubrication,
        case.lubricant,
        case.surroundings,
        case.thermal,
        case.friction_table,
        case.contact_solver,
        case.folder,
        found,
    )
