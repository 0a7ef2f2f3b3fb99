"""Parts of a planetary set in a REXS file beside its gears: bearing, carrier, operation."""

from __future__ import annotations

import math
from collections.abc import Sequence

from epicyclic.exchange.rexs.draft import Draft, Lack, amount_text
from epicyclic.exchange.rexs.model import Component, Model
from epicyclic.exchange.rexs.sets import PlanetarySet, rigid_parts

_ROLLING = ("rolling_bearing_with_catalog_geometry", "rolling_bearing_with_detailed_geometry")
_ROLLERS = ("radial_needle_roller_bearing", "radial_roller_bearing")
"""Types of bearings that the planet bearing of a case can be."""

_CLEARANCES = (
    "operating_radial_bearing_clearance",
    "mounted_radial_bearing_clearance",
    "radial_bearing_clearance",
)
_LEFT_OUT = "Without the bearing's data its loss is left out."


def planet_bearings(model: Model, planetary: PlanetarySet) -> list[Component]:
    """All bearings between planets and their pins, or between their shafts and the carrier."""
    planets = {part.id for part in rigid_parts(model, planetary.shafts["planet"])}
    carried = {part.id for part in rigid_parts(model, planetary.shafts["pin"])}
    carried |= {part.id for part in rigid_parts(model, planetary.shafts["carrier"])}
    found: dict[int, Component] = {}
    for relation in model.relations:
        if relation.type == "side":
            sides = {*relation.partners("inner_part"), *relation.partners("outer_part")}
            joints = [model.components[number] for number in relation.partners("assembly")]
            if sides & planets and sides & carried:
                found |= {item.id: item for item in joints if "bearing" in item.type}
    return list(found.values())


def bearing_table(draft: Draft, model: Model, planetary: PlanetarySet) -> None:
    """The planet bearing; every key of it that the file does not give is noted."""
    key = "planet_bearing"
    bearings = planet_bearings(model, planetary)
    rolling = [item for item in bearings if item.type in _ROLLING and _has_rollers(item)]
    if not rolling or len(rolling) < len(bearings):
        others = [item for item in bearings if item not in rolling]
        what = f"; {others[0]} is none" if others else ""
        where = f"roller bearing with its geometry between planet and pin{what}"
        draft.lacks[key] = Lack(key, where, False, _LEFT_OUT)
        return
    rows = _parts(model, rolling, "rolling_bearing_row")
    elements = _parts(model, rows, "rolling_element")
    _rows(draft, planetary, rolling, rows)
    draft.take(f"{key}.rollers_per_row", "number_of_rolling_elements", rows)
    roller = draft.take(f"{key}.roller_diameter", "diameter_of_rolling_element", elements)
    effective = "significant_contact_length_inner_ring"
    if draft.take(f"{key}.roller_length", effective, rows, None) is None:
        draft.take(f"{key}.roller_length", "length_of_rolling_element", elements)
    _pin(draft, rows, roller)
    for name in _CLEARANCES:
        if draft.take(f"{key}.diametral_clearance", name, rolling, None) is not None:
            break
    else:
        draft.lack(f"{key}.diametral_clearance", _CLEARANCES[-1], rolling)
    for name in ("roller_roughness", "race_roughness"):
        draft.lack(f"{key}.{name}", "roughness (there is no attribute for it)", rolling)


def _has_rollers(bearing: Component) -> bool:
    """True if a bearing is of a type that can be computed, or of none that is stated."""
    kind = bearing.get("bearing_type")
    return kind is None or kind.text() in _ROLLERS


def _parts(model: Model, owners: Sequence[Component], kind: str) -> list[Component]:
    """Parts of a kind of all owners, in order."""
    return [
        part
        for owner in owners
        for part in model.partners(owner.id, "ordered_assembly", "assembly", "part", kind)
    ]


def _rows(
    draft: Draft, planetary: PlanetarySet, rolling: list[Component], rows: list[Component]
) -> None:
    """Rows of all bearings of one planet together."""
    count = len(rows) / len(planetary.planets)
    if count and count.is_integer():
        several = f" of {len(rolling)} bearings" if len(rolling) > 1 else ""
        draft.give("planet_bearing.rows", int(count), f"counted: rolling_bearing_row{several}")
        if count > 1:
            gap = "gap between the rollers of neighbouring rows"
            draft.lack("planet_bearing.row_gap", gap, rolling, "Default: none.")
    else:
        draft.lack("planet_bearing.rows", "rolling_bearing_row", rolling)


def _pin(draft: Draft, rows: list[Component], roller: float | None) -> None:
    """The inner race: the pitch circle less one roller."""
    name, key = "reference_diameter_rolling_bearing", "planet_bearing.pin_diameter"
    pitch = draft.read(name, rows, key)
    if pitch is None or roller is None:
        draft.lack(key, name, rows)
        return
    draft.give(
        key,
        amount_text(pitch.number - roller, pitch.unit),
        f"computed: {pitch.origin} less the roller diameter",
    )


def carrier_table(draft: Draft, model: Model, planetary: PlanetarySet) -> None:
    """The carrier as a disc: the largest side plate, as wide as all of them stand."""
    stage = planetary.component.id
    carriers = model.partners(stage, "assembly", "assembly", "part", "planet_carrier")
    plates = [
        plate
        for carrier in carriers
        for plate in model.partners(carrier.id, "assembly", "assembly", "part", "side_plate")
    ]
    instead = "Without the carrier's size its drag is left out."
    sizes = [(draft.read("outer_diameter", [p]), draft.read("length", [p]), p) for p in plates]
    known = [(outer, length, plate) for outer, length, plate in sizes if outer and length]
    if not known:
        draft.lack("carrier", "outer_diameter and length of side_plate", carriers, instead)
        return
    outer = max(item[0] for item in known)
    draft.give("carrier.outer_diameter", outer.text, outer.origin)
    _, length, first = known[0]
    if len(known) == 1:
        draft.give("carrier.width", length.text, length.origin)
        return
    starts = [_position(plate) for _, _, plate in known]
    if any(start is None for start in starts):
        draft.lacks["carrier.width"] = Lack(
            "carrier.width", f"support_vector of {first}", True, "Give the width over all plates."
        )
        return
    axial = [start[0] for start in starts if start is not None]
    ends = [start + item[1].number for start, item in zip(axial, known, strict=True)]
    width = max(ends) - min(axial)
    draft.give(
        "carrier.width",
        amount_text(round(width, 9), length.unit),
        f"computed over {len(known)} side plates from support_vector and length",
    )


def _position(component: Component) -> tuple[float, ...] | None:
    """Position in the axes of the gear unit, in mm; None if it is not given."""
    vector = component.get("support_vector")
    try:
        numbers = vector.numbers() if vector is not None else ()
    except ValueError:
        return None
    return numbers if len(numbers) == 3 else None


def planet_angles(draft: Draft, planetary: PlanetarySet) -> None:
    """Positions of the planets, if they are not spaced equally."""
    centre = _position(planetary.shafts["sun"][0]) if planetary.shafts["sun"] else None
    places = [_position(shaft) for shaft in planetary.shafts["planet"]]
    if centre is None or any(place is None for place in places) or len(places) < 2:
        return
    angles = sorted(
        math.degrees(math.atan2(place[2] - centre[2], place[1] - centre[1])) % 360
        for place in places
        if place is not None
    )
    turned = [angle - angles[0] for angle in angles]
    equal = [360 * number / len(turned) for number in range(len(turned))]
    if any(abs(a - b) > 1e-3 for a, b in zip(turned, equal, strict=True)):
        values = [f"{angle:.6f} deg" for angle in turned]
        draft.give("planet.angles", values, "computed from support_vector of the planet shafts")
