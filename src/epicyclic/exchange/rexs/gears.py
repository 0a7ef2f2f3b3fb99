"""Gears of a REXS file to tables of a case.

Angles and profile shifts are taken as ISO 21771 has them. Numbers of teeth and diameters of
internal gears are taken by their magnitude, because programs write them with either sign.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from epicyclic.exchange.rexs.draft import Amount, Draft, amount_text
from epicyclic.exchange.rexs.model import Component, Model
from epicyclic.exchange.rexs.sets import is_internal
from epicyclic.geometry.roughness import RA_OVER_RQ

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
        for flank in flanks_of(model, [gear]):
            tools += model.partners(flank.id, "manufacturing_step", "workpiece", "tool", *_TOOLS)
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
        draft.notes.append(f"The gears have different helix angles: {shown}. The first is taken.")
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
    settings = [
        item
        for flank in flanks
        for item in model.partners(
            flank.id, "manufacturing_step", "workpiece", "manufacturing_settings"
        )
    ]
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
    draft.give(
        f"{key}.roughness",
        value,
        f"computed: Rq = {1 / RA_OVER_RQ:.4g} Ra of a Gaussian profile, Ra from {origin}",
    )


def _material(draft: Draft, model: Model, key: str, gears: Sequence[Component]) -> None:
    materials = {
        item.id: item
        for gear in gears
        for item in model.partners(gear.id, "reference", "origin", "referenced", "material")
    }
    sources = list(materials.values())
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
