"""What a set leaves out of its gears: centre distances, profile shifts, a named basic rack.

A mesh joins its centre distance, two profile shifts and its backlash: any one of them follows from
the others. What was found, and what was adjusted because the printed digits contradict each other,
stands in `Found`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from epicyclic.dataclass import dataclass
from epicyclic.errors import InputError, Problem, one_problem
from epicyclic.gears.assembly import rack_problems, set_problems
from epicyclic.gears.gear import BasicRack, Gear
from epicyclic.gears.gearing import Gearing, GearPairing
from epicyclic.gears.mesh import (
    closed_center_distance,
    profile_shift_sum,
    recommended_backlash,
    thinning,
)
from epicyclic.gears.rules import gears_by_name
from epicyclic.gears.stated import THICKNESS, allowance_shift, thickness_key
from epicyclic.messages import micrometres, millimetres, value_at, written
from epicyclic.units import MILLIMETRE

BASIC_RACKS = {
    "iso-53-a": (1.25, 0.38),
    "iso-53-b": (1.25, 0.30),
    "iso-53-c": (1.25, 0.25),
    "iso-53-d": (1.40, 0.39),
}
"""h_fP and the rounding rho_fP of the tool's tip, in normal modules; ISO 53:1998 (second hand)."""
FINEST_SHIFT = 0.5e-3
"""Half a unit of the last digit of a profile shift counts at most as this: 0.3 means 0.300. [1]"""
FINEST_LENGTH = 0.5e-6  # The same of lengths: 39 mm means 39.000 mm. [m]
AGREES = 0.5e-6
"""A stated backlash that differs less from that of the teeth is that of the teeth. [m]"""
ROUNDING = 0.5e-9
"""Teeth that are too thick by less than this pass as they are; see `rules.ROUNDING`. [m]"""
_ALIKE = 1e-9  # Modules and angles that differ by less are equal, relatively.
LEAST_SHIFT, LARGEST_SHIFT = -3.0, 5.0  # What a case may state.


@dataclass(frozen=True, slots=True)
class Found:
    """A value that the case does not state."""

    key: str
    value: str  # With unit, as a message shows it.
    how: str  # Where it comes from.

    def __str__(self) -> str:
        return f"{self.key} = {self.value}: {self.how}"


@dataclass(frozen=True, slots=True)
class _Sized:
    """A mesh whose centre distance or profile shifts may have to be found."""

    drawn: GearPairing
    gears: tuple[str, str]  # A ring is the second.
    backlash: float | None  # j_bn, as stated. [m]
    teeth: int  # z1 + z2, those of a ring negative.
    rack: BasicRack  # Rack of both gears.
    place: tuple[str, ...]  # Path of its centre distance.
    gives_way: str  # The gear that is thinned where digits contradict each other.
    group: str  # Meshes of one group have one centre distance.


def complete(
    gearing: Gearing, raw: Mapping[str, Any]
) -> tuple[Gearing, tuple[Found, ...], list[Problem]]:
    """A set with what it leaves out, what was found, and why something cannot be found."""
    if any(rack_problems(gearing)):  # reported with the gears
        return gearing, (), []
    incomplete = None in gearing.distances.values() or not all(
        table.states_thickness for table in gearing.tables.values()
    )
    gearing, named = _with_named_rack(gearing)
    made, problems = gears_by_name(gearing)
    if problems:  # of gears that are sound but for their rules all is reported later
        return gearing, named, problems if incomplete else []
    solver = _Solver(gearing, made, raw)
    try:
        solver.solve()
    except InputError as error:
        return gearing, named, list(error.problems)
    except ValueError:  # gears that cannot mesh: reported with the meshes
        return gearing, named, []
    unknown = [name for name, table in solver.tables.items() if not table.states_thickness]
    if unknown:
        keys = ", ".join(f"{gearing.key(it)}.profile_shift_coefficient" for it in unknown)
        allowed = "is missing, and no mesh with a gear of the same basic rack gives it."
        return gearing, named, [Problem(keys, "", allowed, "Add it.")]
    return _completed(gearing, solver), (*named, *solver.found), []


def problems_of_some(
    gearing: Gearing, gears: Collection[str], raw: Mapping[str, Any]
) -> list[Problem]:
    """Problems of `gears` and their meshes, where the tables of the others cannot be used.

    Of default tips, which a mate that is left out may shorten, nothing is said.
    """
    thick = {gear for gear in gears if gearing.tables[gear].states_thickness}
    if not thick:
        return []
    some, _, problems = complete(gearing.only(thick), raw)
    open_tips = {
        f"{gearing.key(gear)}.tip_diameter"
        for mesh in gearing.meshes if mesh.key not in {it.key for it in some.meshes}
        for gear in thick & {mesh.first, mesh.second} if some.tables[gear].tip_diameter is None
    }  # fmt: skip
    problems += [] if problems else set_problems(some)
    return [it for it in problems if open_tips.isdisjoint(it.key.split(", "))]


def _with_named_rack(gearing: Gearing) -> tuple[Gearing, tuple[Found, ...]]:
    """What a profile says that is given by its name. ISO 53:1998, Table 2."""
    shared = gearing.shared
    if shared is None or shared.basic_rack is None:
        return gearing, ()
    name = shared.basic_rack
    dedendum, rounding = BASIC_RACKS[name]
    tables = {}
    for gear, table in gearing.tables.items():
        keeps = table.tool_tip_radius is not None or table.is_ring
        radius = rounding * gearing.racks[gear].normal_module
        tables[gear] = table if keeps else table.model_copy(update={"tool_tip_radius": radius})
    coefficients = {
        "addendum_coefficient": 1.0,
        "dedendum_coefficient": dedendum,
        "basic_rack": None,
    }
    found = f"h_aP = 1, h_fP = {dedendum:g}, rounding {rounding:g}"
    named = gearing.changed(tables, shared.model_copy(update=coefficients), {})
    return named, (Found("gears.basic_rack", found, f"{name}, in normal modules."),)


def _sized(gearing: Gearing) -> Iterator[_Sized]:
    """The meshes whose gears have one basic rack: profile shifts of others tell no distance."""
    for mesh in gearing.meshes:
        one, two = (gearing.racks[gear] for gear in (mesh.first, mesh.second))
        least = _ALIKE * one.normal_module
        keys = ("transverse_module", "transverse_pressure_angle", "helix_angle")
        pairs = ((getattr(one, key), getattr(two, key)) for key in keys)
        if not all(math.isclose(a, b, rel_tol=_ALIKE, abs_tol=least) for a, b in pairs):
            continue
        teeth = [gearing.tables[gear].teeth for gear in (mesh.first, mesh.second)]
        yield _Sized(
            mesh,
            (mesh.first, mesh.second),
            mesh.table.normal_backlash,
            teeth[0] + (-1 if mesh.internal else 1) * teeth[1],
            one,
            tuple(gearing.distance_key(mesh).split(".")),
            gives_way=mesh.second if mesh.internal else gearing.central_gear(mesh) or mesh.first,
            group=gearing.planet_of(mesh) or mesh.key,
        )


def _completed(gearing: Gearing, solver: _Solver) -> Gearing:
    """The set with what the solver found."""
    stated, shared = gearing.distances, gearing.shared
    found = {
        mesh.key: distance
        for mesh in gearing.meshes
        if stated[mesh.key] is None
        and (distance := solver.distances.get(gearing.planet_of(mesh) or mesh.key)) is not None
    }
    if found and shared is not None and not gearing.listed:  # one distance for all meshes
        shared = shared.model_copy(update={"center_distance": next(iter(found.values()))})
        found = {}
    assert shared is not None
    same = all(table is gearing.tables[name] for name, table in solver.tables.items())
    if same and shared is gearing.shared and not found:
        return gearing  # with what follows from it
    return gearing.changed(solver.tables, shared, found)


class _Solver:
    """The gears of meshes that have something in common."""

    def __init__(
        self,
        gearing: Gearing,
        made: Mapping[str, Gear],  # Those that say how thick their teeth are.
        raw: Mapping[str, Any],  # The set as the user wrote it, for the digits that are printed.
    ) -> None:
        self.gearing, self.raw = gearing, raw
        self.tables = dict(gearing.tables)
        self.meshes = meshes = list(_sized(gearing))
        self.found: list[Found] = []
        self.distances: dict[str, float] = {
            mesh.group: distance
            for mesh in reversed(meshes)
            if (distance := gearing.distances[mesh.drawn.key]) is not None
        }
        racks = {name: mesh.rack for mesh in meshes for name in mesh.gears}
        self.thinned = {
            name: allowance_shift(table, racks[name])
            for name, table in self.tables.items()
            if name in racks
        }
        # what allowances take from x1 + x2 before the stated backlash is left; where none is
        # stated, the nominal teeth have none
        self.allowances = {
            mesh.drawn.key: sum(self.thinned[name] for name in mesh.gears)
            for mesh in meshes
            if mesh.backlash is not None
        }
        self.shifts = {  # nominal, without allowances
            name: gear.profile_shift_coefficient - self.thinned[name]
            for name, gear in made.items()
            if name in racks
        }

    def _shift_key(self, name: str) -> str:
        return f"{self.gearing.key(name)}.profile_shift_coefficient"

    def solve(self) -> None:
        """Find what is left out; raise `InputError` if that cannot be."""
        doubly = [mesh for mesh in self.meshes if self.shifts.keys() >= set(mesh.gears)]
        while (mesh := self._find_distance()) is not None or self._find_shift():
            if mesh in doubly:
                doubly.remove(mesh)
        without = [mesh for mesh in self.meshes if mesh.group not in self.distances]
        if without:
            place = ".".join(without[0].place)
            pairs = " or ".join(" and ".join(mesh.gears) for mesh in without)
            table, _, key = place.rpartition(".")
            allowed = "is missing and cannot be computed from a mesh without the tooth thickness "
            allowed += f"of both gears, {pairs}."
            remedy = f'Add {key} = "... mm" to [{table}], or profile_shift_coefficient to them.'
            raise one_problem(place, "", allowed, remedy)
        free = [name for name in self.thinned if name not in self.shifts]
        if free:
            allowed = "is missing, and so is that of every mating gear."
            remedy = "Add one of them, or tooth_thickness with thickness_diameter: the others "
            remedy += "follow from the centre distance."
            raise one_problem(", ".join(map(self._shift_key, free)), "", allowed, remedy)
        problems: list[Problem] = []
        for mesh in doubly:
            try:
                self._adjust(mesh)
            except InputError as error:
                problems += error.problems
        if problems:
            raise InputError(problems)

    # --- centre distances ---

    def _find_distance(self) -> _Sized | None:
        """From the first mesh without one both of whose gears state their thickness."""
        for mesh in self.meshes:
            if mesh.group not in self.distances and self.shifts.keys() >= set(mesh.gears):
                distance = self._closed(mesh)
                self.distances[mesh.group] = distance
                self._tell(".".join(mesh.place), f"{1e3 * distance:.4f} mm", mesh)
                return mesh
        return None

    def _closed(self, mesh: _Sized) -> float:
        total = sum(self.shifts[name] for name in mesh.gears)
        total += self.allowances.get(mesh.drawn.key, 0.0)
        try:
            return closed_center_distance(mesh.rack, mesh.teeth, total, mesh.backlash or 0.0)
        except ValueError as error:
            key = ", ".join(map(self._shift_key, mesh.gears))
            remedy = f"Correct the profile shifts, or give {'.'.join(mesh.place)}."
            raise one_problem(key, "", f"allow no centre distance: {error}.", remedy) from None

    # --- profile shifts ---

    def _find_shift(self) -> bool:
        """Profile shift of the first gear without one, the thinner of what its mates leave."""
        for name in self.thinned:
            known = [
                (self._sum(mesh) - self.shifts[mate], mesh)
                for mesh in self.meshes
                if name in mesh.gears
                and name not in self.shifts
                and mesh.group in self.distances
                and (mate := mesh.gears[1 - mesh.gears.index(name)]) in self.shifts
            ]
            if known:
                shift, mesh = min(known, key=lambda item: item[0])
                self._set(name, shift, mesh)
                self._tell(self._shift_key(name), f"{shift:z.4f}", mesh)
                return True
        return False

    def _sum(self, mesh: _Sized) -> float:
        """Nominal x1 + x2 of a mesh; 0 if its gears cannot mesh, which is told with the meshes."""
        distance = self.distances[mesh.group]
        try:
            total = profile_shift_sum(mesh.rack, mesh.teeth, distance, mesh.backlash or 0.0)
        except ValueError:
            return 0.0
        return total - self.allowances.get(mesh.drawn.key, 0.0)

    def _set(self, name: str, shift: float, mesh: _Sized) -> None:
        if not LEAST_SHIFT <= shift <= LARGEST_SHIFT:
            allowed = f"would have to be {shift:.3g} at the centre distance of "
            allowed += f"{millimetres(self.distances[mesh.group])}, and must be >= {LEAST_SHIFT:g} "
            allowed += f"and <= {LARGEST_SHIFT:g}."
            remedy = f"Correct {'.'.join(mesh.place)}, the tooth numbers or the module."
            raise one_problem(self._shift_key(name), "", allowed, remedy)
        self.shifts[name] = shift
        keys = {key: None for choice in THICKNESS for key in choice.split("+")}
        self.tables[name] = self.tables[name].model_copy(
            update=keys | {"profile_shift_coefficient": shift}
        )

    def _tell(self, key: str, value: str, mesh: _Sized) -> None:
        """Note what was found from a mesh."""
        if mesh.backlash is None:
            least = micrometres(recommended_backlash(mesh.rack, self.distances[mesh.group]))
            with_what = (
                f"for nominal teeth without backlash; ISO/TR 10064-2 recommends {least} or more"
            )
        else:
            with_what = f"with a normal backlash of {micrometres(mesh.backlash)}"
        self.found.append(Found(key, value, f"computed from the {mesh.drawn.title}, {with_what}."))

    # --- what is stated twice ---

    def _adjust(self, mesh: _Sized) -> None:
        """Thin a gear whose teeth are too thick by less than the printed digits."""
        over = sum(self.shifts[name] for name in mesh.gears) - self._sum(mesh)
        if mesh.backlash is None:
            over += sum(self.thinned[name] for name in mesh.gears)
        backlash = over * -2 * mesh.rack.normal_module * math.sin(mesh.rack.normal_pressure_angle)
        if mesh.backlash is not None and abs(backlash) > AGREES:
            allowed = "contradicts the teeth and the centre distance, which leave "
            allowed += f"{micrometres(backlash + mesh.backlash)}."
            remedy = "Leave out normal_backlash, a profile shift or the centre distance."
            key = f"{mesh.drawn.table_key}.normal_backlash"
            raise one_problem(key, millimetres(mesh.backlash), allowed, remedy)
        if mesh.backlash is not None or backlash > -ROUNDING or over > self._printed(mesh):
            return
        name = mesh.gives_way
        shift = self.shifts[name] - over
        self._set(name, shift, mesh)
        how = f"adjusted, because the teeth of the {mesh.drawn.title} are {-1e9 * backlash:.3g} nm "
        how += "too thick for the centre distance, which is less than the printed digits show."
        self.found.append(Found(self._shift_key(name), f"{shift:.6f}", how))

    def _printed(self, mesh: _Sized) -> float:
        """How far x1 + x2 may be from the centre distance by the digits of both. [1]"""
        distance = self.distances[mesh.group]
        step = self._half_digit(mesh.place, FINEST_LENGTH)
        away = profile_shift_sum(mesh.rack, mesh.teeth, distance + step)
        near = profile_shift_sum(mesh.rack, mesh.teeth, distance)
        return abs(away - near) + sum(self._printed_shift(mesh, name) for name in mesh.gears)

    def _printed_shift(self, mesh: _Sized, name: str) -> float:
        path = tuple(thickness_key(self.gearing.key(name), self.tables[name]).split("."))
        if self.tables[name].profile_shift_coefficient is not None:
            return self._half_digit(path, FINEST_SHIFT)
        return thinning(mesh.rack, self._half_digit(path, FINEST_LENGTH))

    def _half_digit(self, path: tuple[str, ...], most: float) -> float:
        """Half a unit of the last digit that the user wrote, in SI; 0 if he wrote none."""
        given = value_at(dict(self.raw), path)
        if given is None:
            return 0.0
        match = re.match(r"\s*[-+]?\d*\.?(\d*)(?:[eE]([-+]?\d+))?\s*(.*)", str(given))
        assert match is not None
        half = 0.5 * 10.0 ** (int(match[2] or 0) - len(match[1]))
        return min(most, MILLIMETRE.parse(f"{half!r} {match[3]}") if match[3] else half)


def places_told(gearing: Gearing) -> Iterator[Found]:
    """Where planets and their gears stand, as far as only the order of the meshes says it."""
    for number, mesh in enumerate(gearing.meshes):
        one, two = (gearing.bodies[gear] for gear in mesh.pair)
        if one in gearing.pins and two in gearing.pins:
            how = f"{two} is assumed ahead of {one} in the sense of positive speeds."
            yield Found(f"meshes[{number}]", written(list(mesh.pair)), how)
    for body in gearing.planets:
        gears = gearing.gears_of(body)
        for gear in gears if len(gears) > 1 else ():
            if getattr(gearing.tables[gear], "axial_position", None) is None:
                place = millimetres(gearing.positions[gear])
                how = "assumed, side by side in the order of the meshes."
                yield Found(f"gears.{gear}.axial_position", place, how)
