"""Can these gears be cut and meshed, with these modifications on their flanks?

Every function returns the problems it finds; none stops at the first. A mesh is looked at only if
both of its gears are sound, so that one mistake is told once.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress

from epicyclic.dataclass import dataclass
from epicyclic.errors import Problem, rising_problems
from epicyclic.gears import measures
from epicyclic.gears.cutting import longest_involute
from epicyclic.gears.flanks import active_profile
from epicyclic.gears.gear import Gear
from epicyclic.gears.gearing import Gearing, rim_thickness
from epicyclic.gears.measures import LARGEST_FIT
from epicyclic.gears.mesh import (
    Mesh,
    closed_center_distance,
    profile_shift_sum,
    recommended_backlash,
    thinning,
)
from epicyclic.gears.stated import (
    DIGITS,
    StatedFlank,
    StatedGear,
    StatedTopography,
    fitting,
    thickness_key,
    working_flank,
)
from epicyclic.messages import micrometres, millimetres

FARTHEST_TIP = 8.0  # From the reference circle: the largest shift and addendum. [normal modules]
THINNEST_RIM = 0.25  # A thinner rim is foil, and its teeth find no balance. [normal modules]

LARGEST_RIM_RATIO = 1000.0  # Root radius over thickness of a rim, for the same reason. [1]


def gears_by_name(gearing: Gearing) -> tuple[dict[str, Gear], list[Problem]]:
    """The gears that state their thickness where they have an involute, and problems of others."""
    made: dict[str, Gear] = {}
    problems = []
    for name, table in gearing.tables.items():
        if table.states_thickness:
            try:
                made[name] = gearing.gear(name)
            except ValueError:
                problems.append(_no_involute_for_thickness(gearing, name))
    return made, problems


def sound_gears(gearing: Gearing) -> tuple[dict[str, Gear], list[Problem]]:
    """The gears that can be cut, by name, and the problems of the others."""
    made, problems = gears_by_name(gearing)
    sound = {}
    for name, gear in made.items():
        table, key = gearing.tables[name], gearing.key(name)
        found = _check_tooth(gear, key, table) or _check_measure(gear, key, table)
        fit, diameter = table.tooth_thickness_fit, 2 * gear.reference_radius
        if found is None and fit is not None and diameter > LARGEST_FIT:
            allowed = f"applies to reference diameters up to {millimetres(LARGEST_FIT)}, and this "
            allowed += f"gear has {millimetres(diameter)}."
            remedy = "Give tooth_thickness_allowance."
            found = Problem(f"{key}.tooth_thickness_fit", f'"{fit}"', allowed, remedy)
        stated = table.tooth_thickness_allowance or ()
        wanted = sorted((-abs(it) for it in stated), reverse=True)
        if found is None and list(stated) != wanted:
            allowed = "must be the upper, then the lower allowance of DIN 3967, neither positive."
            remedy = "Write [" + ", ".join(f'"{1e6 * it:.6g} um"' for it in wanted) + "]."
            found = Problem(f"{key}.tooth_thickness_allowance", "", allowed, remedy)
        if found is None:
            sound[name] = gear
        else:
            problems.append(found)
        problems += _check_rim(gear, key, table)
    return sound, problems


def _check_measure(gear: Gear, key: str, table: StatedGear) -> Problem | None:
    """A span or balls must touch the flanks."""
    if table.span_measurement is not None:
        if gear.internal and gear.rack.helix_angle > 0:
            place = f"{key}.span_measurement"
            reason = "cannot be measured on a helical ring gear."
            advice = "Give dimension_over_pins with measuring_pin_diameter."
            return Problem(place, millimetres(table.span_measurement), reason, advice)
        radius = measures.span_contact_radius(gear, table.span_measurement)
        remedy = f"Over {measures.usual_span_teeth(gear)} teeth it would touch mid-flank."
        what = "span_measurement"
    elif table.dimension_over_pins is not None and table.measuring_pin_diameter is not None:
        radius = 0.0
        with suppress(ValueError):
            radius = measures.pin_contact_radius(gear, table.measuring_pin_diameter)
        usual = millimetres(measures.usual_pin(gear.rack))
        remedy = f"A usual measuring_pin_diameter is {usual}."
        what = "dimension_over_pins"
    else:
        return None
    low, high = sorted((gear.root_radius, gear.tip_radius))
    if low < radius < high:
        return None
    shown = millimetres(getattr(table, what))
    allowed = f"touches at diameter {millimetres(2 * radius)}, beyond the flanks, which reach from "
    allowed += f"{millimetres(2 * low)} to {millimetres(2 * high)}."
    if radius == 0:
        allowed = "belongs to balls that do not touch the flanks of teeth with this allowance."
    return Problem(f"{key}.{what}", shown, allowed, f"Check it, tooth number and module. {remedy}")


def _check_rim(gear: Gear, owner: str, table: StatedGear) -> Iterator[Problem]:
    thickness, key = rim_thickness(table), f"{owner}.rim_thickness"
    least = max(THINNEST_RIM * gear.rack.normal_module, gear.root_radius / LARGEST_RIM_RATIO)
    if thickness is not None and not gear.internal:
        allowed = "belongs to a ring gear, and this gear is external."
        remedy = f"Leave it out, or write {owner}.internal = true."
        yield Problem(key, millimetres(thickness), allowed, remedy)
    elif thickness is not None and thickness < least:
        allowed = f"must be at least {millimetres(least)}: a quarter of the normal module, and a "
        allowed += "thousandth of the root radius."
        remedy = "Correct it, or leave it out for a rim that does not bend."
        yield Problem(key, millimetres(thickness), allowed, remedy)


def _no_involute_for_thickness(gearing: Gearing, name: str) -> Problem:
    rack, table, key = gearing.racks[name], gearing.tables[name], gearing.key(name)
    base = table.teeth * rack.transverse_module * math.cos(rack.transverse_pressure_angle)
    if table.dimension_over_pins is not None:
        shown = millimetres(table.dimension_over_pins)
        allowed = f"puts the middle of the balls inside the base circle of {millimetres(base)}."
        remedy = "Check it, measuring_pin_diameter, tooth number and module."
        return Problem(f"{key}.dimension_over_pins", shown, allowed, remedy)
    diameter, reference = table.thickness_diameter or 0.0, table.teeth * rack.transverse_module
    place, shown = f"{key}.thickness_diameter", millimetres(diameter)
    if reference - diameter > 2 * FARTHEST_TIP * rack.normal_module:
        return _other_teeth(key, place, shown, table.teeth, (reference, diameter))
    allowed = f"lies inside the base circle of {millimetres(base)}, where no involute exists."
    remedy = "Give the tooth thickness at a larger diameter."
    return Problem(place, shown, allowed, remedy)


def _other_teeth(
    gear: str,  # Key.
    circle: str,  # Key of the diameter of a circle.
    shown: str,  # That diameter.
    teeth: int,
    diameters: tuple[float, float],  # Of the reference circle: of these teeth, and likely. [m]
) -> Problem:
    """A circle so far from the reference circle that it, or the number of teeth, is wrong."""
    reference, likely = diameters
    allowed = f"do not belong together: {teeth} teeth have a reference circle of "
    allowed += f"{millimetres(reference)}."
    remedy = "Correct one of the two, or the module: this diameter belongs to about "
    remedy += f"{round(teeth * likely / reference)} teeth."
    return Problem(f"{gear}.teeth, {circle}", f"{teeth}, {shown}", allowed, remedy)


def _check_tooth(gear: Gear, key: str, table: StatedGear) -> Problem | None:
    """The first reason why this tooth cannot be: each one makes the next meaningless."""
    tip, root = (f"{key}.{which}_diameter" for which in ("tip", "root"))
    tip_shown = _diameter(gear.tip_radius, table.tip_diameter)
    root_shown = _diameter(gear.root_radius, table.root_diameter)
    if gear.root_radius <= 0:
        remedy = f"Reduce gears.dedendum_coefficient, or give {root}."
        return Problem(root, root_shown, "must exceed zero.", remedy)
    height = gear.tip_radius - gear.root_radius
    if gear.side * height <= 0:
        larger, smaller = (root, tip) if gear.internal else (tip, root)
        allowed = f"leave no tooth: {larger} must exceed {smaller} for "
        allowed += f"{'a ring' if gear.internal else 'an external gear'}."
        remedy = "Correct one of the two."
        return Problem(f"{tip}, {root}", f"{tip_shown}, {root_shown}", allowed, remedy)
    thickness = thickness_key(key, table)
    module = gear.rack.normal_module
    if abs(gear.tip_radius - gear.reference_radius) > FARTHEST_TIP * module:
        likely = 2 * (gear.tip_radius + (module if gear.internal else -module))
        return _other_teeth(key, tip, tip_shown, gear.teeth, (2 * gear.reference_radius, likely))
    if gear.tip_radius <= gear.base_radius:
        allowed = f"lies inside the base circle of {millimetres(2 * gear.base_radius)}, so that "
        allowed += "the tooth has no involute at its tip."
        remedy = f"Increase it above {millimetres(2 * gear.base_radius)}, or use more teeth."
        return Problem(tip, tip_shown, allowed, remedy)
    if gear.thickness_at(gear.tip_radius) <= 0:
        allowed = "the teeth become pointed below the tip circle."
        remedy = f"Shorten the teeth, or make them thicker with {thickness}."
        if table.tip_diameter is None and not gear.internal:  # thicker teeth are longer
            remedy = f"Shorten the teeth with {tip}, or reduce {thickness}."
        return Problem(tip, tip_shown, allowed, remedy)
    if gear.tip_form_radius <= gear.base_radius or gear.tip_half_angle <= 0:
        allowed = "leaves no tip land or no involute: the tooth is "
        allowed += f"{millimetres(gear.thickness_at(gear.tip_radius))} thick at the tip circle, "
        allowed += "and each of its two chamfers removes about its own height from that."
        return Problem(f"{key}.tip_chamfer", millimetres(gear.tip_chamfer), allowed, "Reduce it.")
    if gear.half_angle_at(max(gear.root_radius, gear.base_radius)) >= math.pi / gear.teeth:
        allowed = "the tooth spaces have no width left at the root."
        remedy = f"Reduce the tooth depth, or make the teeth thinner with {thickness}."
        return Problem(root, root_shown, allowed, remedy)
    return None


def _diameter(radius: float, given: float | None) -> str:
    return f"{millimetres(2 * radius)}{' (the default)' if given is None else ''}"


def check_mesh(
    gearing: Gearing,
    mesh: Mesh,
    distance_key: str,  # Where its centre distance is stated.
) -> list[Problem]:
    """Problems of a mesh of two sound gears."""
    one, two = mesh.gears
    if mesh.internal and two.teeth <= one.teeth:
        allowed = f"must exceed the {one.teeth} teeth of the {one.name}, which turns inside it."
        remedy = "Check both tooth numbers."
        return [Problem(f"{gearing.key(two.name)}.teeth", str(two.teeth), allowed, remedy)]
    bases, allowed = two.base_radius + mesh.side * one.base_radius, ""
    largest = max(abs(gear.profile_shift_coefficient) for gear in (one, two))
    if bases >= mesh.center_distance:
        allowed = f"must exceed {millimetres(bases)}, the "
        allowed += f"{'difference' if mesh.internal else 'sum'} of the base radii of {one.name} "
        allowed += f"and {two.name}."
    elif mesh.backlash < -ROUNDING and largest <= LARGEST_SHIFT and _over(mesh) > 2 * LARGEST_SHIFT:
        # the thickness of neither gear is to blame
        allowed = f"is far too {'large' if mesh.internal else 'small'} for the teeth of the "
        allowed += f"{mesh.name}."
    if allowed:
        remedy = f"{_reference_distance(mesh)} Check tooth numbers and module too."
        return [Problem(distance_key, millimetres(mesh.center_distance), allowed, remedy)]
    problems = _check_backlash(gearing, mesh, distance_key)
    ends: list[Problem] = []
    clearance1, clearance2 = mesh.tip_clearances
    for tip, root, clearance in ((two, one, clearance2), (one, two, clearance1)):
        if clearance < -ROUNDING:
            ends.append(_negative_clearance(gearing, tip, root, clearance))
            continue
        try:
            ends += _check_end_of_contact(gearing, mesh, root, tip)
        except ValueError as error:
            # rings whose tips reach too far for the planet are out of reach of cutters too
            if not (root.internal and ends):
                ends.append(_no_tool(gearing, root, str(error)))
    problems += [
        *ends,
        *_check_contact_ratio(gearing, mesh, distance_key),
        *_check_tip_passage(gearing, mesh),
    ]
    # where the teeth do not mesh the limits of the active profile mean nothing
    return problems or list(_check_flanks(gearing, mesh))


def _reference_distance(mesh: Mesh) -> str:
    distance = mesh.gear2.reference_radius + mesh.side * mesh.gear1.reference_radius
    return f"Without profile shift it is {millimetres(distance)}."


def _negative_clearance(gearing: Gearing, tip: Gear, root: Gear, clearance: float) -> Problem:
    """The tip of one gear reaches into the root of the other."""
    key, shown = _tips(gearing, tip)
    allowed = f"the tip of the {tip.name} reaches {millimetres(-clearance)} into the root of the "
    allowed += f"{root.name} (negative tip clearance)."
    return Problem(key, shown, allowed, f"{_tip_limit(gearing, tip)}or cut the {root.name} deeper.")


def _tip_limit(gearing: Gearing, gear: Gear) -> str:
    """Beginning of a remedy: how long the teeth may be in all meshes of the gear."""
    limits = list(_tip_limits(gearing, gear))
    limit = max(limits) if gear.internal else min(limits)
    if limit <= 0:
        return "Shorten the teeth, "
    step, bound = (math.ceil, "at least") if gear.internal else (math.floor, "at most")
    return f"Make {gearing.key(gear.name)}.tip_diameter {bound} {step(2e6 * limit) / 1e3:.3f} mm, "


def _tip_limits(gearing: Gearing, tip: Gear) -> Iterator[float]:
    """Tip radii up to which a gear leaves the root and the fillet of each mate alone. [m]"""
    for mesh in _meshes_of(gearing, tip):
        first = tip.name == mesh.gear1.name
        root, clearance = (mesh.gear2 if first else mesh.gear1), mesh.tip_clearances[not first]
        yield tip.tip_radius + tip.side * clearance
        try:
            end = longest_involute(root, gearing.tables[root.name].tool_tip_radius)
        except ValueError:  # no tool cuts it
            end = root.base_radius
        yield _tip_radius_for(mesh, tip, end)


def _meshes_of(gearing: Gearing, gear: Gear) -> Iterator[Mesh]:
    """The meshes of a gear whose mates and centre distances are known."""
    for drawn in gearing.meshes:
        pair = (drawn.first, drawn.second)
        if gear.name not in pair or gearing.distances[drawn.key] is None:
            continue
        if all(gearing.tables[it].states_thickness for it in pair):
            with suppress(ValueError):  # a mate without an involute
                yield gearing.geometry(drawn)


def _check_contact_ratio(gearing: Gearing, mesh: Mesh, distance_key: str) -> list[Problem]:
    one, two = mesh.gears
    transverse, overlap = mesh.transverse_contact_ratio, mesh.overlap_ratio
    if transverse <= 0:
        fault = f"the teeth of the {mesh.name} do not reach each other"
    elif transverse + overlap < 1:
        fault = (
            f"the contact ratio of the {mesh.name} is {transverse + overlap:.3f}, below 1 "
            f"(transverse {transverse:.3f}, overlap {overlap:.3f})"
        )
    else:
        return []
    chamfers = ", reduce tip_chamfer" if one.tip_chamfer > 0 or two.tip_chamfer > 0 else ""
    key, shown = _tips(gearing, one, two)
    remedy = f"Lengthen the teeth{chamfers} or correct {distance_key}. {_reference_distance(mesh)}"
    return [Problem(key, shown, f"{fault}: motion is not transmitted continuously.", remedy)]


def _tips(gearing: Gearing, *gears: Gear) -> tuple[str, str]:
    """Keys and values of the tip diameters of gears."""
    keys = [f"{gearing.key(gear.name)}.tip_diameter" for gear in gears]
    given = [gearing.tables[gear.name].tip_diameter for gear in gears]
    shown = [_diameter(gear.tip_radius, it) for gear, it in zip(gears, given, strict=True)]
    return ", ".join(keys), ", ".join(shown)


def _check_end_of_contact(gearing: Gearing, mesh: Mesh, gear: Gear, mate: Gear) -> list[Problem]:
    """Contact must stay on the involute of `gear` up to where the tip of `mate` leaves it.

    Raises `ValueError` if no tool generates `gear`.
    """
    member = 1 if gear is mesh.gear1 else 2
    curvature, radius = active_profile(mesh, member)[0], mesh.inner_radii[member - 1]
    change = "change tooth numbers or profile shifts"
    if curvature < 0:
        fault = (
            f"reaches inside the base circle of the {gear.name}, where no involute exists (tip "
            "interference)"
        )
    else:
        end = longest_involute(gear, gearing.tables[gear.name].tool_tip_radius)
        if (radius <= end + ROUNDING) if gear.internal else (radius >= end - ROUNDING):
            return []
        fault = (
            f"touches the {gear.name} at diameter {millimetres(2 * radius)}, "
            f"{'outside' if gear.internal else 'below'} its involute, which ends at "
            f"{millimetres(2 * end)} (fillet interference)"
        )
        if gearing.tables[gear.name].tool_tip_radius is not None:
            change = f"reduce {gearing.key(gear.name)}.tool_tip_radius"
    key, shown = _tips(gearing, mate)
    allowed = f"the tip of the {mate.name} {fault}."
    return [Problem(key, shown, allowed, f"{_tip_limit(gearing, mate)}or {change}.")]


def _tip_radius_for(mesh: Mesh, mate: Gear, radius: float) -> float:
    """Tip radius of `mate` whose contact with the other gear ends at `radius` there."""
    gear = mesh.gear2 if mate is mesh.gear1 else mesh.gear1
    curvature = gear.roll_length_at(radius)
    length = mesh.line_of_action - mesh.side * curvature
    if mate is mesh.gear1:
        length = mesh.side * (mesh.line_of_action - curvature)
    if length <= 0:
        return 0.0
    return math.hypot(mate.base_radius, length) + mate.side * mate.tip_chamfer


def _no_tool(gearing: Gearing, gear: Gear, reason: str) -> Problem:
    table, key = gearing.tables[gear.name], gearing.key(gear.name)
    tip, root = (f"{key}.{which}_diameter" for which in ("tip", "root"))
    shown = f"{_diameter(gear.tip_radius, table.tip_diameter)}, "
    shown += f"{_diameter(gear.root_radius, table.root_diameter)}"
    remedy = f"Change the tip or root diameter, or {thickness_key(key, table)}."
    return Problem(f"{tip}, {root}", shown, f"no tool can cut such a tooth: {reason}.", remedy)


def _check_tip_passage(gearing: Gearing, mesh: Mesh) -> Iterator[Problem]:
    """The tips of an internal mesh must pass each other beside it."""
    one, two = mesh.gears
    if mesh.internal and mesh.tip_clearances[1] >= -ROUNDING and mesh.tip_passage < 0:
        key, shown = _tips(gearing, one, two)
        allowed = f"the tips of {one.name} and {two.name} collide beside the mesh, by "
        allowed += f"{-math.degrees(mesh.tip_passage):.3g} deg of the {two.name} (tip "
        allowed += "interference)."
        remedy = f"Shorten the teeth or choose more teeth for the {two.name}."
        yield Problem(key, shown, allowed, remedy)


ROUNDING = 1e-9  # Clearances count as negative beyond this: drawings may state exactly zero. [m]

LARGEST_SHIFT = 1.2
"""Magnitude of usual profile shifts, general knowledge: larger ones mostly are a wrong number of
teeth, module or diameter. [1]"""
MOST_WIDER = 2.0  # Face width over that of the mate above which a result says so; an estimate. [1]
GROSS = 5.0  # Backlash over the recommended one from which a result says so; an estimate. [1]

TOO_THIN = "its teeth are too thin for their centre distance"
"""By which a warning of that is known."""


def _check_backlash(gearing: Gearing, mesh: Mesh, distance_key: str) -> list[Problem]:
    """Teeth that are too thick, with the thickness and the centre distance that fit."""
    if mesh.backlash >= -ROUNDING:
        return []
    keys = [thickness_key(gearing.key(it.name), gearing.tables[it.name]) for it in mesh.gears]
    fits: list[str] = []
    for it in mesh.gears:
        with suppress(ValueError):  # another mesh of the gear cannot be
            fits.append(_fitting(gearing, [*_meshes_of(gearing, it)], it))
    ways = ", or ".join(filter(None, [" or ".join(fits), _distance(gearing, mesh, distance_key)]))
    usual = recommended_backlash(mesh.gear1.rack, mesh.center_distance)
    less = thinning(mesh.gear1.rack, usual)
    allowed = f"the teeth of the {mesh.name} are {millimetres(-mesh.backlash)} too thick for the "
    allowed += f"centre distance of {millimetres(mesh.center_distance)} (negative backlash)."
    remedy = f"Zero backlash needs {ways}; " if ways else ""
    remedy += f"reducing one x by {less:.4f} gives {micrometres(usual)} of backlash, as ISO/TR "
    remedy += f"10064-2 recommends.{_other_sign(gearing, mesh)}"
    return [Problem(", ".join(keys), "", allowed, remedy)]


def tooth_notes(gearing: Gearing) -> Iterator[str]:
    """Gears of unusual profile shift; meshes of unlike widths, or with teeth far too thin."""
    for gear in {gear.name: gear for mesh in gearing.geometries for gear in mesh.gears}.values():
        if abs(shift := gear.profile_shift_coefficient) > LARGEST_SHIFT:
            yield (
                f"The profile shift of the {gear.name} is {shift:z.2f}: its number of "
                "teeth, a diameter or the centre distance is probably wrong."
            )
    for mesh in gearing.geometries:
        narrow, wide = sorted(gear.face_width for gear in mesh.gears)
        if wide > MOST_WIDER * narrow:
            shown = f"{millimetres(wide)} and {millimetres(narrow)}"
            yield f"The face widths of the {mesh.name} are {shown}; only the latter carries load."
        backlash = mesh.normal_backlash
        usual = recommended_backlash(mesh.gear1.rack, mesh.center_distance)
        if backlash <= GROSS * usual:
            continue
        fits = " or ".join(_fitting(gearing, [mesh], gear, usual) for gear in mesh.gears)
        yield (
            f"The {mesh.name} has a normal backlash of {millimetres(backlash)}, "
            f"{backlash / usual:.2g} times the {micrometres(usual)} that ISO/TR 10064-2 "
            f"recommends: {TOO_THIN}. With {fits} it has the recommended backlash."
            f"{_other_sign(gearing, mesh)}"
        )


def _teeth(mesh: Mesh) -> int:
    """z1 + z2 with the sign of ISO 21771."""
    return mesh.gear1.teeth + mesh.side * mesh.gear2.teeth


def _over(mesh: Mesh, backlash: float = 0.0) -> float:
    """x1 + x2 less what leaves this normal backlash. [1]"""
    wanted = profile_shift_sum(mesh.gear1.rack, _teeth(mesh), mesh.center_distance, backlash)
    return sum(gear.profile_shift_coefficient for gear in mesh.gears) - wanted


def _fitting(gearing: Gearing, meshes: list[Mesh], gear: Gear, backlash: float = 0.0) -> str:
    """The thickness of a gear that leaves this backlash in all meshes, as the case states it."""
    table, key = gearing.tables[gear.name], gearing.key(gear.name)
    return fitting(gear, key, table, max(_over(mesh, backlash) for mesh in meshes))


def _distance(gearing: Gearing, mesh: Mesh, key: str) -> str:
    """What centre distance the teeth fit, rounded to the loose side; none that others do not."""
    total = mesh.gear1.profile_shift_coefficient + mesh.gear2.profile_shift_coefficient
    same = [it for it in gearing.meshes if gearing.distance_key(it) == key]
    stated = {name for name, table in gearing.tables.items() if table.states_thickness}
    pairs = [(it.first, it.second) for it in same if {it.first, it.second} <= stated]
    loose = math.floor if mesh.internal else math.ceil
    try:
        near = loose(closed_center_distance(mesh.gear1.rack, _teeth(mesh), total) * 1e6) / 1e6
        fits = [Mesh("", gearing.gear(one), gearing.gear(two), near) for one, two in pairs]
        tight = any(it.backlash < -ROUNDING for it in fits)
    except ValueError:  # another mesh cannot be
        return ""
    return "" if tight else f'{key} = "{1e3 * near:.3f} mm"'


def _other_sign(gearing: Gearing, mesh: Mesh) -> str:
    """A hint if the profile shift of a ring fits with the other sign."""
    ring = mesh.gear2
    shift = gearing.tables[ring.name].profile_shift_coefficient
    if not mesh.internal or not shift:
        return ""
    over = _over(mesh) - 2 * shift
    usual = recommended_backlash(mesh.gear1.rack, mesh.center_distance)
    if not -GROSS * thinning(mesh.gear1.rack, usual) <= over <= 10.0**-DIGITS:
        return ""
    hint = f" With the other sign, {-shift:g}, x of the {ring.name} fits: in ISO 21771 "
    return f"{hint}positive x thickens the teeth."


@dataclass(frozen=True, slots=True)
class _Flank:
    """A flank that works in a mesh, and the key of its table."""

    key: str
    gear: Gear
    mesh: str  # Its name.
    active: tuple[float, float]  # Roll lengths of the active profile at root and tip. [m]
    table: StatedFlank

    @property
    def active_length(self) -> float:
        """[m]"""
        root, tip = self.active
        return abs(tip - root)


def _check_flanks(gearing: Gearing, mesh: Mesh) -> Iterator[Problem]:
    """Problems of the micro-geometry of both working flanks of a mesh."""
    for member, gear in ((1, mesh.gear1), (2, mesh.gear2)):
        gear_table = gearing.tables[gear.name]
        table = working_flank(member, gear_table)
        if table is not None:
            name = "micro_geometry"
            if table is not gear_table.micro_geometry:
                name = "micro_geometry_ring_side"
            key = f"{gearing.key(gear.name)}.{name}"
            active = active_profile(mesh, member)
            yield from _check_flank(_Flank(key, gear, mesh.name, active, table))


def _check_flank(flank: _Flank) -> Iterator[Problem]:
    tip, root = (_relief_length(flank, end) for end in ("tip", "root"))
    if isinstance(tip, float) and isinstance(root, float):
        if tip + root > flank.active_length:
            allowed = f"tip relief over {millimetres(tip)} and root relief over "
            allowed += f"{millimetres(root)} of roll overlap: the active profile of the "
            allowed += f"{flank.mesh} is {millimetres(flank.active_length)} long."
            yield Problem(f"{flank.key}.tip_relief", "", allowed, "Shorten one of the two.")
    else:
        yield from (found for found in (tip, root) if isinstance(found, Problem))
    yield from _check_end_relief(flank)
    yield from _without_amount(flank)
    if flank.table.topography is not None:
        yield from _check_topography(flank, flank.table.topography)


def _relief_length(flank: _Flank, end: str) -> float | Problem:
    """Roll length of the tip or root relief, 0 without one, or what is wrong with it."""
    key = f"{flank.key}.{end}_relief"
    amount: float = getattr(flank.table, f"{end}_relief")
    roll_length: float | None = getattr(flank.table, f"{end}_relief_roll_length")
    diameter: float | None = getattr(flank.table, f"{end}_relief_diameter")
    starts = {"roll_length": roll_length, "diameter": diameter}
    given = [name for name, start in starts.items() if start is not None]
    if amount == 0 and not given:
        return 0.0
    if len(given) != 1:
        allowed = f"needs one start of the relief, and has {'two' if given else 'none'}."
        remedy = f"Give {end}_relief_roll_length or {end}_relief_diameter."
        return Problem(key, f"{amount * 1e6:.5g} um", allowed, remedy)
    near, far = flank.active[::-1] if end == "tip" else flank.active
    inside = f"the active profile of the {flank.mesh}"
    if diameter is not None:
        length = (flank.gear.roll_length_at(diameter / 2) - near) / (far - near)
        if 0 < length <= 1:
            return length * flank.active_length
        ends = sorted(_diameter_at(flank.gear, roll) for roll in (near, far))
        allowed = f"between {millimetres(ends[0])} and {millimetres(ends[1])}"
        shown = millimetres(diameter)
    else:
        assert roll_length is not None
        if roll_length <= flank.active_length:
            return roll_length
        allowed = f"within {millimetres(flank.active_length)} of roll"
        shown = millimetres(roll_length)
    reason = f"the relief must start in {inside}, {allowed}."
    return Problem(f"{key}_{given[0]}", shown, reason, "Correct the start of the relief.")


def _without_amount(flank: _Flank) -> Iterator[Problem]:
    """Length, diameter or shape of a relief whose amount is not given."""
    given = flank.table.model_fields_set
    for relief in ("tip_relief", "root_relief", "end_relief"):
        for key in sorted(given):
            if relief not in given and key.startswith(f"{relief}_"):
                allowed = f"belongs to {relief}, which is not given."
                remedy = f"Give {relief}, or leave out {key}."
                yield Problem(f"{flank.key}.{key}", "", allowed, remedy)


def _diameter_at(gear: Gear, roll_length: float) -> float:
    return float(2 * (gear.base_radius**2 + roll_length**2) ** 0.5)


def _check_end_relief(flank: _Flank) -> Iterator[Problem]:
    length, width = flank.table.end_relief_length, flank.gear.face_width
    key = f"{flank.key}.end_relief_length"
    if length is None and flank.table.end_relief != 0:
        yield Problem(key, "", "is missing; it belongs to end_relief.", "Add end_relief_length.")
    elif length is not None and 2 * length > width:
        allowed = f"both end reliefs must fit into the face width of {millimetres(width)}."
        remedy = f"Reduce it to {millimetres(width / 2)} or less."
        yield Problem(key, millimetres(length), allowed, remedy)


def _check_topography(flank: _Flank, table: StatedTopography) -> list[Problem]:
    key = f"{flank.key}.topography"
    axes = {"diameter": table.diameter, "face_position": table.face_position}
    problems = rising_problems(axes, f"{key}.")
    wanted = (len(table.diameter), len(table.face_position))
    if len(table.deviation) != wanted[0] or any(len(row) != wanted[1] for row in table.deviation):
        shown = f"{len(table.deviation)} rows"
        allowed = f"must be {wanted[0]} rows of {wanted[1]} values, for the points of diameter and "
        allowed += "face_position."
        remedy = "Give one row for each diameter, with one value for each face position."
        problems.append(Problem(f"{key}.deviation", shown, allowed, remedy))
    base = 2 * flank.gear.base_radius
    if table.diameter and table.diameter[0] < base:
        allowed = f"lies inside the base circle of {millimetres(base)}, where no involute exists."
        remedy = "Leave out these rows."
        problems.append(Problem(f"{key}.diameter", millimetres(table.diameter[0]), allowed, remedy))
    return problems or list(_check_place(flank, table))


def _check_place(flank: _Flank, table: StatedTopography) -> Iterator[Problem]:
    """The points of a sound topography must lie where the flank works."""
    ends = sorted(_diameter_at(flank.gear, roll) for roll in flank.active)
    places = (
        ("diameter", table.diameter, f"active profile of the {flank.mesh}", ends),
        ("face_position", table.face_position, "face", [0.0, flank.gear.face_width]),
    )
    for name, points, where, (low, high) in places:
        first, last = points[0], points[-1]
        if min(last, high) - max(first, low) < max(last - first, high - low) / 2:
            shown = f"{millimetres(first)} to {millimetres(last)}"
            allowed = f"must overlap the {where}, {millimetres(low)} to {millimetres(high)}, by at "
            allowed += "least half of the longer of the two."
            remedy = "Give the deviations on the active part of the flank."
            yield Problem(f"{flank.key}.topography.{name}", shown, allowed, remedy)
