"""The train of a REXS file as the tables of a case."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from epicyclic.case.wording import one_line
from epicyclic.exchange.rexs import checks
from epicyclic.exchange.rexs.draft import Draft
from epicyclic.exchange.rexs.lubricant import lubricant_table, temperature
from epicyclic.exchange.rexs.model import Component, Model
from epicyclic.exchange.rexs.set_tables import set_tables
from epicyclic.exchange.rexs.sets import Pair, PlanetarySet
from epicyclic.exchange.rexs.shaft_parts import shaft_parts
from epicyclic.exchange.rexs.train_operation import train_operation
from epicyclic.exchange.rexs.trains import Train

_OTHER_STAGES = ("bevel_stage", "worm_stage")
_HELIX = "helix_angle_reference_diameter"


def train_draft(model: Model, train: Train) -> Draft:
    """What the file says of a train, and what it lacks."""
    draft = Draft({"kind": "train", "title": one_line(train.unit.name.strip())})
    train_operation(draft, model, train)
    for name, one in train.sets.items():
        own = Draft({})
        set_tables(own, model, one, f"sets.{name}.")
        _hand(own, one)
        own.notes += checks.file_notes(one)
        draft.adopt(own, name)
    shaft_parts(draft, model, train)
    stages = [mesh.stage for mesh in train.meshes]
    _temperature(draft, model, stages)
    lubricant_table(draft, model, stages)
    draft.notes += _notes(model, train)
    return draft


def _hand(draft: Draft, one: PlanetarySet | Pair) -> None:
    """Hand of the helix of the sun or pinion: positive angles are right-handed, ISO 21771."""
    gear = one.pinion if isinstance(one, Pair) else one.sun
    helix = draft.read(_HELIX, [gear])
    if helix is not None and helix.number != 0:
        draft.give("hand", "right" if helix.number > 0 else "left", f"sign of {helix.origin}")


def _temperature(draft: Draft, model: Model, stages: Sequence[Component]) -> None:
    """Temperature of the oil: that of the first stage, if they differ."""
    name, key = "temperature_lubricant", "operation.oil_inlet_temperature"
    stated = [found for stage in stages if (found := draft.read(name, [stage], key)) is not None]
    if len({found.text for found in stated}) < 2:
        temperature(draft, model, stages)
        return
    draft.give(key, stated[0].text, stated[0].origin)
    draft.notes.append(f"The stages have different {name}; that of the first is taken.")


def _notes(model: Model, train: Train) -> Iterator[str]:
    """Stages that are left out; gears that stand in two sets."""
    for kind in _OTHER_STAGES:
        for stage in model.of_type(kind)[:4]:
            yield f"{stage} is left out: cylindrical and planetary stages can be read."
    sets = train.sets.values()
    gears = [gear for one in sets for gear in ((one.pinion, one.gear) if isinstance(one, Pair)
             else (one.sun, one.ring))]  # fmt: skip
    counts = Counter(gear.id for gear in gears)
    for number, count in counts.items():
        if count > 1:
            yield f"{model.components[number]} stands in {count} sets, with its drag in each."
