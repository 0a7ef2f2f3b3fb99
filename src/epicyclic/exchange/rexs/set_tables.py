"""The tables of a planetary set or a pair from a REXS file: gears, bearing, carrier."""

from __future__ import annotations

import math
from dataclasses import replace

from epicyclic.exchange.rexs import checks, planetary
from epicyclic.exchange.rexs.draft import Draft
from epicyclic.exchange.rexs.flank_forms import micro_geometry
from epicyclic.exchange.rexs.gears import gear_table, shared_table
from epicyclic.exchange.rexs.model import Model
from epicyclic.exchange.rexs.sets import Pair, PlanetarySet, is_internal
from epicyclic.units import format_number

ROUNDING = 1e-3
"""Sum of the profile shifts of a mesh, as printed with three decimals, less the exact sum. [1]"""

_SHIFT = "profile_shift_coefficient"


def set_tables(draft: Draft, model: Model, chosen: PlanetarySet | Pair, place: str = "") -> None:
    """What describes a set or a pair; `place` is where its tables stand in the case."""
    if isinstance(chosen, Pair):
        _pair(draft, model, chosen, place)
    else:
        _planetary(draft, model, chosen, place)


def _planetary(draft: Draft, model: Model, chosen: PlanetarySet, place: str) -> None:
    gears = [chosen.sun, *chosen.planets, chosen.ring]
    shared_table(draft, model, gears, [mesh.stage for mesh in chosen.meshes])
    for key, own in (("sun", [chosen.sun]), ("planet", chosen.planets), ("ring", [chosen.ring])):
        gear_table(draft, model, key, own)
        micro_geometry(draft, model, key, own)
    draft.give("planet.count", len(chosen.planets), f"counted: planets of {chosen.component}")
    draft.take("planet.mass", "mass_of_component", chosen.planets, None)
    _shifts(draft, place, "sun", "planet", "sun")
    _shifts(draft, place, "planet", "ring", "ring")
    planetary.planet_angles(draft, chosen)
    planetary.bearing_table(draft, model, chosen)
    planetary.carrier_table(draft, model, chosen)
    rims = model.partners(chosen.ring.id, "assembly", "assembly", "part", "gear_body")
    draft.take("ring.rim_thickness", "gear_body_rim_thickness", rims, None)


def _pair(draft: Draft, model: Model, chosen: Pair, place: str) -> None:
    shared_table(draft, model, [chosen.pinion, chosen.gear], [chosen.mesh.stage])
    for key, own in (("pinion", [chosen.pinion]), ("gear", [chosen.gear])):
        gear_table(draft, model, key, own)
        micro_geometry(draft, model, key, own)
    if is_internal(chosen.gear):
        draft.give("gear.internal", True, f"{chosen.gear}")
    _shifts(draft, place, "pinion", "gear", "gear")


def _shifts(draft: Draft, place: str, member1: str, member2: str, changed: str) -> None:
    """Look at the profile shifts of a mesh.

    Say which one would close it if one is lacking, and if one seems to have the wrong sign. Shifts
    of a mesh without backlash may overlap by the last digit that is printed of them; the one of
    `changed` is then reduced.
    """
    draft.notes += checks.shift_notes(draft.tables, member1, member2, place)
    for own, other in ((member2, member1), (member1, member2)):
        key = f"{own}.profile_shift_coefficient"
        closing = checks.closing_shift(draft.tables, other, own)
        if closing is None:
            continue
        shown = math.floor(closing * 1e6) / 1e6 + 0.0
        if key in draft.lacks:
            text = f"With the {other}, {format_number(shown)} leaves no backlash."
            draft.lacks[key] = replace(draft.lacks[key], instead=text)
            continue
        shift = draft.tables[own].get(_SHIFT)
        is_too_much = isinstance(shift, float) and 0 < shift - shown <= ROUNDING
        if own == changed and is_too_much:
            origin = f"{draft.origins[key]}: {shift}, less what the printed digits are too much"
            draft.give(key, shown, origin)
