"""Gears, flanks and planets of a REXS file as tables of a case, checked."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass, replace
from epicyclic.gears.flanks import RA_OVER_RQ
from epicyclic.gears.gearing import basic_rack
from epicyclic.gears.mesh import profile_shift_sum
from epicyclic.plugins.rexs.draft import Amount, Draft, amount_text, number_of
from epicyclic.plugins.rexs.model import IN_MILLIMETRES, Component, Model, vector
from epicyclic.plugins.rexs.sets import SetParts, Train, is_internal, joints, rigid_parts
from epicyclic.units import DEGREE, MILLIMETRE, Quantity, format_number

# Gears of a REXS file to tables of a case.
#
# Angles and profile shifts are taken as ISO 21771 has them. Numbers of teeth and diameters of
# internal gears are taken by their magnitude, because programs write them with either sign.


_TOOLS = ("rack_shaped_tool", "cutter_wheel_tool")


def flanks_of(model: Model, gears: Iterable[Component]) -> list[Component]:
    """The flanks of gears, left and right."""
    return [
        flank
        for gear in gears
        for side in ("left", "right")
        for flank in model.partners(gear.id, "flank", "gear", side)
    ]


def _tools_of(model: Model, gears: Iterable[Component]) -> list[Component]:
    """The first tool of each gear: the one that leaves the root."""
    found: dict[int, Component] = {}
    for gear in gears:
        tools = model.partners(gear.id, "ordered_reference", "origin", "referenced", *_TOOLS)
        flanks = flanks_of(model, [gear])
        tools += model.partners_of(flanks, "manufacturing_step", "workpiece", "tool", *_TOOLS)
        if tools:
            found[tools[0].id] = tools[0]
    return list(found.values())


def shared_table(
    draft: Draft, model: Model, gears: Sequence[Component], stages: Sequence[Component]
) -> None:
    """What all gears share: module, angles, centre distance."""
    draft.take("gears.normal_module", "normal_module", gears)
    flanks = flanks_of(model, gears)
    normal = draft.take("gears.normal_pressure_angle", "normal_pressure_angle", flanks, None)
    if normal is None:
        name = "pressure_angle_in_the_transverse_section"
        if draft.take("gears.transverse_pressure_angle", name, flanks, None) is None:
            draft.lack("gears.normal_pressure_angle", "normal_pressure_angle", flanks or gears)
    name = "helix_angle_reference_diameter"
    magnitudes: dict[str, str] = {}
    for gear in gears:
        found = draft.read(name, [gear], "gears.helix_angle")
        if found is not None:
            text = amount_text(round(abs(found.number), 9), found.unit)
            magnitudes.setdefault(text, found.origin)
    if len(magnitudes) > 1:
        shown = ", ".join(map(str, magnitudes))
        draft.notes.append(f"The gears have different helix angles: {shown}. The first is used.")
    if magnitudes:
        draft.give("gears.helix_angle", *next(iter(magnitudes.items())))
    else:
        draft.lack("gears.helix_angle", name, gears)
    draft.take("gears.center_distance", "center_distance", stages, change=abs)


def gear_table(draft: Draft, model: Model, key: str, gears: Sequence[Component]) -> None:
    """Table `key` of one gear, or of several that are alike."""
    draft.take(f"{key}.teeth", "number_of_teeth", gears, change=abs)
    draft.take(f"{key}.face_width", "face_width", gears)
    shift = _thickness(draft, model, key, gears)
    _tip(draft, model, key, gears, shift)
    _root(draft, model, key, gears, shift)
    _roughness(draft, key, gears)
    _material(draft, model, key, gears)


def _thickness(draft: Draft, model: Model, key: str, gears: Sequence[Component]) -> float | None:
    """The profile shift, or the tooth thickness; the profile shift if it is known."""
    flanks = flanks_of(model, gears)
    name = "addendum_modification_coefficient"
    target = f"{key}.profile_shift_coefficient"
    shift = draft.take(target, name, flanks, None)
    if shift is not None:
        return shift
    thickness, diameter = (
        draft.read(attribute, gears, target)
        for attribute in (
            "transverse_tooth_thickness_at_reference_diameter",
            "reference_diameter_cylindrical_gear",
        )
    )
    if thickness is not None and diameter is not None:
        draft.give(f"{key}.tooth_thickness", thickness.text, thickness.origin)
        length = amount_text(abs(diameter.number), diameter.unit)
        draft.give(f"{key}.thickness_diameter", length, diameter.origin)
        return None
    roles = ("manufacturing_step", "workpiece", "manufacturing_settings")
    settings = model.partners_of(flanks, *roles)
    generated = "generated_addendum_modification_coefficient"
    if draft.take(target, generated, settings, None) is None:
        draft.lack(target, name, flanks or gears)
    return None


def _tip(
    draft: Draft, model: Model, key: str, gears: Sequence[Component], shift: float | None
) -> None:
    """Tip diameter, of the file or of the basic profile of its flanks."""
    target = f"{key}.tip_diameter"
    if draft.take(target, "tip_diameter", gears, None, abs) is not None:
        return
    addendum = draft.read("addendum_coefficient_basic_profile", flanks_of(model, gears))
    module = draft.read("normal_module", gears)
    height = addendum.number * module.number if addendum and module else None
    diameter = _diameter(draft, gears, shift, height)
    if diameter is None or addendum is None:
        draft.lack(target, "tip_diameter", gears, "Default: from gears.addendum_coefficient.")
    else:
        origin = f"computed without alteration of the tip: {addendum.origin}"
        draft.give(target, amount_text(diameter, "mm"), origin)


def _root(
    draft: Draft, model: Model, key: str, gears: Sequence[Component], shift: float | None
) -> None:
    """Root diameter, of the file or of a rack-shaped tool, and the rounding of the tool's tip."""
    target = f"{key}.root_diameter"
    tools = _tools_of(model, gears)
    module = draft.read("normal_module", gears)
    rounding = _tool_length(draft, tools, "tip_corner_radius_", "factor_", module)
    if rounding is not None:
        draft.give(f"{key}.tool_tip_radius", rounding.text, rounding.origin)
    if draft.take(target, "root_diameter", gears, None, abs) is not None:
        return
    addendum = _tool_length(draft, tools, "addendum_", "coefficient_", module)
    is_rack = all(tool.type == "rack_shaped_tool" for tool in tools) and not is_internal(gears[0])
    usable = addendum is not None and addendum.unit == "mm" and is_rack
    diameter = _diameter(draft, gears, shift, -addendum.number if addendum and usable else None)
    if diameter is None or addendum is None:
        draft.lack(target, "root_diameter", gears, "Default: from gears.dedendum_coefficient.")
    else:
        origin = f"computed from the addendum of the tool: {addendum.origin}"
        draft.give(target, amount_text(diameter, "mm"), origin)


def _diameter(
    draft: Draft, gears: Sequence[Component], shift: float | None, height: float | None
) -> float | None:
    """Diameter at `height` above the reference circle of a gear with profile shift. ISO 21771.

    In mm; None if anything is not known in the usual units.
    """
    teeth = draft.read("number_of_teeth", gears)
    module = draft.read("normal_module", gears)
    helix = draft.read("helix_angle_reference_diameter", gears[:1])
    if not (teeth and module and helix) or shift is None or height is None:
        return None
    cosine = math.cos(math.radians(helix.number))
    if (module.unit, helix.unit) != ("mm", "deg") or cosine <= 0:
        return None
    outward = -1 if is_internal(gears[0]) else 1
    reference = abs(teeth.number) * module.number / cosine
    return round(reference + outward * 2 * (shift * module.number + height), 9)


def _tool_length(
    draft: Draft, tools: Sequence[Component], start: str, middle: str, module: Amount | None
) -> Amount | None:
    """A length of the tools, given itself or as a factor of the module."""
    length = draft.read(f"{start}reference_profile", tools)
    if length is not None:
        return length
    factor = draft.read(f"{start}{middle}reference_profile", tools)
    if factor is None or module is None:
        return None
    origin = f"{factor.origin}, times normal_module"
    return Amount(factor.number * module.number, module.unit, origin)


def _roughness(draft: Draft, key: str, gears: Sequence[Component]) -> None:
    """Rq from the Ra of the file: that of a Gaussian profile."""
    name = "arithmetic_mean_roughness_flank_iso_4287_1997"
    found = draft.read(name, gears, f"{key}.roughness")
    if found is None:
        draft.lack(f"{key}.roughness", name, gears)
        return
    number, unit, origin = found
    value = amount_text(float(f"{number / RA_OVER_RQ:.6g}"), unit)
    told = f"computed: Rq = {1 / RA_OVER_RQ:.4g} Ra of a Gaussian profile, Ra from {origin}"
    draft.give(f"{key}.roughness", value, told)


def _material(draft: Draft, model: Model, key: str, gears: Sequence[Component]) -> None:
    materials = model.partners_of(gears, "reference", "origin", "referenced", "material")
    sources = list({item.id: item for item in materials}.values())
    target = f"{key}.material"
    modulus = draft.read("elastic_modulus", sources, target)
    if modulus is None:
        instead = "Default: steel of the material library."
        draft.lack(target, "material with an elastic_modulus", sources or gears, instead)
        return
    title = sources[0].get("material_designation")
    table: dict[str, object] = {"title": title.text() if title else str(sources[0])}
    table["elastic_modulus"] = modulus.text
    for name in ("poisson_ratio", "density"):
        found = draft.read(name, sources, target)
        if found is not None:
            table[name] = found.text
    draft.give(target, table, f"material {sources[0].id}")


# Modifications of the flanks in a REXS file to micro geometry.
#
# Taken are those whose meaning is the same on both sides. The others are noted: slopes, whose sign
# the attribute database does not define, and modifications that differ between the flanks of a
# gear.


@dataclass(frozen=True, slots=True)
class _Form:
    """A type of modification, the key of its amount, and the attributes that hold it."""

    type: str
    key: str
    amounts: tuple[str, ...]
    over: str = ""  # Where a crown is; a relief has a shape and the diameter where it begins.


_TAKEN = (
    _Form("tip_relief", "tip_relief", ("tip_relief_depth",)),
    _Form("root_relief", "root_relief", ("root_relief_depth",)),
    _Form("profile_crowning", "profile_crown",
          ("profile_crowning_at_tip", "profile_crowning_at_root"), ", over the active profile"),
    _Form("helix_crowning", "lead_crown",
          ("helix_crowning_amount_datum_face", "helix_crowning_amount_non_datum_face"),
          ", over the face width"),
)  # fmt: skip
_NOT_TAKEN = {
    "profile_slope": ("profile_slope", "profile_slope"),
    "helix_slope": ("lead_slope", "helix_slope"),
    "end_relief_datum_face": ("end_relief", "end_relief_depth_datum_face"),
    "end_relief_non_datum_face": ("end_relief", "end_relief_depth_non_datum_face"),
    "topographical_modification": ("topography", None),
    "triangular_tip_relief": ("topography", None),
    "triangular_root_relief": ("topography", None),
    "profile_twist": ("topography", None),
}
"""By type the key, and the attribute that holds the amount, if it is a single one."""
_SHAPES = ("linear", "parabolic")


def micro_geometry(draft: Draft, model: Model, key: str, gears: Sequence[Component]) -> None:
    """Table ``micro_geometry`` of gears that are alike."""
    flanks = flanks_of(model, gears)
    for form in _TAKEN:
        items = _of_type(model, flanks, form.type)
        if items and any(number_of(item, name) != 0 for item in items for name in form.amounts):
            _take(draft, key, form, items, len(flanks))
    for kind, (name, amount) in _NOT_TAKEN.items():
        items = _of_type(model, flanks, kind)
        if items and (amount is None or any(number_of(item, amount) != 0 for item in items)):
            _leave(draft, key, name, items, "its sign or shape is not supported here")


def _of_type(model: Model, flanks: Sequence[Component], kind: str) -> list[Component]:
    return model.partners_of(flanks, "reference", "origin", "referenced", kind)


def _take(draft: Draft, key: str, form: _Form, items: Sequence[Component], flanks: int) -> None:
    amounts = {number_of(item, name) for item in items for name in form.amounts}
    shapes = {"parabolic"} if form.over else {_shape(item) for item in items}
    (amount, *others), (shape, *_) = amounts, shapes
    if len(items) < flanks or others or amount is None or amount <= 0:
        _leave(draft, key, form.key, items, "it is not the same positive amount on all flanks")
        return
    adds_material = any(item.is_true("is_additive_modification") for item in items)
    if len(shapes) > 1 or shape not in _SHAPES or adds_material:
        _leave(draft, key, form.key, items, "its shape is not linear or parabolic")
        return
    start = f"{key}.micro_geometry."
    found = draft.read(form.amounts[0], items)
    assert found is not None
    draft.give(f"{start}{form.key}", found.text, f"{found.origin}{form.over}")
    if not form.over:
        draft.give(f"{start}{form.key}_shape", shape, f"shape_of_relief of {items[0]}")
        draft.take(f"{start}{form.key}_diameter", f"{form.type}_datum_diameter", items)


def _leave(draft: Draft, key: str, name: str, items: Sequence[Component], reason: str) -> None:
    instead = "It was not imported; set the key yourself."
    what = f"{items[0]} is there, but {reason}"
    draft.lack(f"{key}.micro_geometry.{name}", what, [], instead)


def _shape(item: Component) -> str:
    shape = item.get("shape_of_relief")
    return "linear" if shape is None else shape.text()


# Parts of a planetary set in a REXS file beside its gears: bearing, carrier, operation.


_ROLLING = ("rolling_bearing_with_catalog_geometry", "rolling_bearing_with_detailed_geometry")
_ROLLERS = ("radial_needle_roller_bearing", "radial_roller_bearing")
"""Types of bearings that the planet bearing of a case can be."""

_CLEARANCES = (
    "operating_radial_bearing_clearance",
    "mounted_radial_bearing_clearance",
    "radial_bearing_clearance",
)
_LEFT_OUT = "Without the bearing's data its loss is left out."


def planet_bearings(model: Model, planetary: SetParts) -> list[Component]:
    """All bearings between planets and their pins, or between their shafts and the carrier."""
    planets = {part.id for part in rigid_parts(model, planetary.shafts["planet"])}
    carried = {part.id for part in rigid_parts(model, planetary.shafts["pin"])}
    carried |= {part.id for part in rigid_parts(model, planetary.shafts["carrier"])}
    found: dict[int, Component] = {}
    for item, *sides in joints(model):
        if planets.intersection(sides) and carried.intersection(sides) and "bearing" in item.type:
            found[item.id] = item
    return list(found.values())


def bearing_table(draft: Draft, model: Model, planetary: SetParts) -> None:
    """The planet bearing; every key of it that the file does not give is noted."""
    key = "planet_bearing"
    bearings = planet_bearings(model, planetary)
    rolling = [item for item in bearings if item.type in _ROLLING and _has_rollers(item)]
    if not rolling or len(rolling) < len(bearings):
        others = [item for item in bearings if item not in rolling]
        what = f"; {others[0]} is not one" if others else ""
        where = f"roller bearing with its geometry between planet and pin{what}"
        draft.lack(key, where, [], _LEFT_OUT)
        return
    inside = ("ordered_assembly", "assembly", "part")
    rows = model.partners_of(rolling, *inside, "rolling_bearing_row")
    elements = model.partners_of(rows, *inside, "rolling_element")
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


def _rows(
    draft: Draft, planetary: SetParts, rolling: list[Component], rows: list[Component]
) -> None:
    """Rows of all bearings of one planet together."""
    count = len(rows) / len(planetary.alike["planet"])
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
    diameter = amount_text(pitch.number - roller, pitch.unit)
    draft.give(key, diameter, f"computed: {pitch.origin} less the roller diameter")


def carrier_table(draft: Draft, model: Model, planetary: SetParts) -> None:
    """The carrier as a disc: the largest side plate, as wide as all of them stand."""
    stage = planetary.component.id
    carriers = model.partners(stage, "assembly", "assembly", "part", "planet_carrier")
    plates = model.partners_of(carriers, "assembly", "assembly", "part", "side_plate")
    instead = "Without the carrier's size its drag is left out."
    sizes = [(draft.read("outer_diameter", [p]), draft.read("length", [p]), p) for p in plates]
    known = [(outer, length, plate) for outer, length, plate in sizes if outer and length]
    if not known:
        draft.lack("carrier", "outer_diameter and length of side_plate", carriers, instead)
        return
    outer = max(
        (item[0] for item in known), key=lambda it: it.number * IN_MILLIMETRES.get(it.unit, 1.0)
    )
    draft.give("carrier.outer_diameter", outer.text, outer.origin)
    _, length, first = known[0]
    if len(known) == 1:
        draft.give("carrier.width", length.text, length.origin)
        return
    starts = [model.place(plate) for _, _, plate in known]
    points = [start[1] for start in starts if start is not None]
    if len(points) < len(known) or len({start and start[0] for start in starts}) > 1:
        hint = "Give the width over all plates."
        draft.need("carrier.width", "support_vector", [first], hint)
        return
    axis = model.axis([plate for _, _, plate in known], [point - points[0] for point in points[1:]])
    ends: list[float] = []
    for point, (_, own, plate) in zip(points, known, strict=True):
        along = vector(plate, "u_axis_vector")
        start, sense = float(point @ axis), 1.0 if along is None else float(np.sign(along @ axis))
        ends += [start, start + sense * own.number * IN_MILLIMETRES.get(own.unit, 1.0)]
    width = amount_text(round(max(ends) - min(ends), 9), "mm")
    origin = f"computed over {len(known)} side plates from support_vector and length"
    draft.give("carrier.width", width, origin)


def planet_angles(draft: Draft, model: Model, planetary: SetParts) -> None:
    """Positions of the planets, if they are not spaced equally."""
    shafts = [*planetary.shafts["sun"][:1], *planetary.shafts["planet"]]
    places = [place for shaft in shafts if (place := model.place(shaft)) is not None]
    is_one_frame = len({frame for frame, _ in places}) == 1
    if not planetary.shafts["sun"] or len(places) < max(3, len(shafts)) or not is_one_frame:
        return
    centre, first, *others = (point for _, point in places)
    ways = [np.cross(others[0] - first, other - first) for other in others[1:]]
    axis = model.axis(shafts, [*ways, np.cross(first - centre, others[0] - centre)])
    start = np.cross(np.cross(axis, first - centre), axis)
    across = np.cross(axis, start)
    angles = (math.atan2(across @ (it - centre), start @ (it - centre)) for it in others)
    turned = [0.0, *sorted(math.degrees(angle) % 360 for angle in angles)]
    equal = [360 * number / len(turned) for number in range(len(turned))]
    if any(abs(a - b) > 1e-3 for a, b in zip(turned, equal, strict=True)):
        values = [f"{angle:.6f} deg" for angle in turned]
        draft.give("planet.angles", values, "computed from support_vector of the planet shafts")


# Does a REXS file agree with itself, and with the geometry that is computed here?


AGREES = 1e-3  # Relative difference up to which figures of two programs agree.

SHIFT_AGREES = 0.02  # Difference of profile shifts that allowances for backlash can make.


def file_notes(chosen: SetParts) -> Iterator[str]:
    """Contradictions within the file: hands of helices."""
    said: set[bool] = set()
    for mesh in chosen.meshes:
        first, second = (it.number("helix_angle_reference_diameter") for it in mesh.gears)
        internal = any(map(is_internal, mesh.gears))
        if first * second == 0 or (first * second > 0) == internal or internal in said:
            continue
        said.add(internal)
        hands = "the same hand, as on internal gears" if internal else "opposite hands"
        yield f"{mesh.gears[0]} and {mesh.gears[1]} should have {hands}: check the helix angles."


def geometry_notes(case: Case, chosen: SetParts | Train, model: Model) -> Iterator[str]:
    """Figures of the file that differ from those of the case's geometry."""
    for name, one in (chosen.sets if isinstance(chosen, Train) else {"": chosen}).items():
        gearing, gears = case.gearings.get(name), one.gears
        if gearing is None or gearing.tables.keys() != gears.keys():
            continue  # of a train, a set whose losses are not computed
        for drawn, mesh in zip(gearing.meshes, gearing.geometries, strict=True):
            stage = one.meshes_by_key[drawn.key][0].stage
            for gear, member in ((mesh.gear1, drawn.first), (mesh.gear2, drawn.second)):
                part, d = gears[member], 2 * gear.reference_radius
                yield from _compared(part, "reference_diameter_cylindrical_gear", d, MILLIMETRE)
                yield from _compared(part, "base_diameter", 2 * gear.base_radius, MILLIMETRE)
            yield from _compared(stage, "radial_contact_ratio", mesh.transverse_contact_ratio)
            yield from _compared(stage, "overlap_contact_ratio", mesh.overlap_ratio)
            for data in model.partners(stage.id, "stage_gear_data", "stage", "stage_gear_data"):
                angle = "operating_pressure_angle_in_the_transverse_section"
                yield from _compared(data, angle, mesh.operating_pressure_angle, DEGREE)


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
        signs = {it: -1 if _is_internal(tables, it) else 1 for it in (member1, member2)}
        teeth = sum(sign * int(tables[it]["teeth"]) for it, sign in signs.items())  # ISO 21771
        x1 = float(tables[member1]["profile_shift_coefficient"])
        module, center = (
            MILLIMETRE.parse(gears[it]) for it in ("normal_module", "center_distance")
        )
        normal, helix = (DEGREE.parse(gears[it]) for it in ("normal_pressure_angle", "helix_angle"))
        rack = basic_rack(helix, module, normal_pressure_angle=normal)
        return profile_shift_sum(rack, teeth, center) - x1
    except (KeyError, ValueError, ArithmeticError):  # lacking, or no gears: told elsewhere
        return None


def _is_internal(tables: Mapping[str, Any], name: str) -> bool:
    return name == "ring" or bool(tables[name].get("internal"))


ROUNDING = 1e-3
"""Sum of the profile shifts of a mesh, as printed with three decimals, less the exact sum. [1]"""

_SHIFT = "profile_shift_coefficient"


def set_tables(draft: Draft, model: Model, chosen: SetParts, place: str = "") -> None:
    """What describes a set or a pair; `place` is where its tables stand in the case."""
    gears = [gear for own in chosen.alike.values() for gear in own]
    shared_table(draft, model, gears, [mesh.stage for mesh in chosen.meshes])
    for key, own in chosen.alike.items():
        gear_table(draft, model, key, own)
        micro_geometry(draft, model, key, own)
    if chosen.is_pair:
        gear = chosen.gears["gear"]
        if is_internal(gear):
            draft.give("gear.internal", True, f"{gear}")
        _shifts(draft, place, "pinion", "gear", "gear")
        return
    planets = chosen.alike["planet"]
    draft.give("planet.count", len(planets), f"counted: planets of {chosen.component}")
    draft.take("planet.mass", "mass_of_component", planets, None)
    _shifts(draft, place, "sun", "planet", "sun")
    _shifts(draft, place, "planet", "ring", "ring")
    planet_angles(draft, model, chosen)
    bearing_table(draft, model, chosen)
    carrier_table(draft, model, chosen)
    rims = model.partners(chosen.gears["ring"].id, "assembly", "assembly", "part", "gear_body")
    draft.take("ring.rim_thickness", "gear_body_rim_thickness", rims, None)


def _shifts(draft: Draft, place: str, member1: str, member2: str, changed: str) -> None:
    """Look at the profile shifts of a mesh.

    Say which one would close it if one is lacking, and if that of an internal gear seems to count
    the other way. Shifts of a mesh without backlash may overlap by the last digit that is printed
    of them; the one of `changed` is then reduced.
    """
    for own, other in ((member2, member1), (member1, member2)):
        key = f"{own}.{_SHIFT}"
        closing = closing_shift(draft.tables, other, own)
        if closing is None:
            continue
        shift = draft.tables[own].get(_SHIFT)
        if own == member2 and isinstance(shift, float) and _is_internal(draft.tables, own):
            is_other_sign = abs(shift - closing) > SHIFT_AGREES >= abs(-shift - closing)
            if is_other_sign and abs(shift) >= SHIFT_AGREES:
                draft.notes.append(
                    f"The profile shift {format_number(shift)} of the {own} fits the centre "
                    "distance only with the other sign. If that is correct, set "
                    f"{place}{key} = {format_number(-shift)}."
                )
        shown = math.floor(round(closing * 1e6, 3)) / 1e6 + 0.0  # what is rounding is no excess
        if key in draft.lacks:
            text = f"With the {other}, {format_number(shown)} leaves no backlash."
            draft.lacks[key] = replace(draft.lacks[key], instead=text)
        elif own == changed and isinstance(shift, float) and 0 < shift - shown <= ROUNDING:
            origin = f"{draft.origins[key]}: {shift}, less the excess of the printed digits"
            draft.give(key, shown, origin)
