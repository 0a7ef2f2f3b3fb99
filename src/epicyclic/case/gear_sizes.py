"""Finds what a case leaves out of its gears: the centre distance, or profile shifts.

A mesh joins its centre distance, two profile shifts and its backlash: any one of them follows from
the others. What was found, and what was adjusted because the printed digits contradict each other,
is told in `Found`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from epicyclic.case import build
from epicyclic.case.gear_tables import Gears, GearTable, SetMesh
from epicyclic.case.plain import value_at
from epicyclic.case.schema import Table, roughness_told
from epicyclic.case.short_oil import short_oil_told
from epicyclic.case.thickness import allowance_shift, thickness_key
from epicyclic.case.wording import micrometres, millimetres
from epicyclic.errors import InputError, Problem
from epicyclic.geometry.profile_shifts import (
    closed_center_distance,
    profile_shift_sum,
    recommended_backlash,
    thinning,
)
from epicyclic.units import MILLIMETRE

__all__ = ["Found", "Sizes", "converted_roughness", "find_sizes", "negative_teeth", "told_oil"]

MESHES = {"planetary": ("sun-planet", "planet-ring"), "gear_pair": ("pinion-gear",)}
"""Gears of each mesh; of both the first, or of a ring mesh the ring, is fitted to the other."""
BASIC_RACKS = {
    "iso-53-a": (1.25, 0.38),
    "iso-53-b": (1.25, 0.30),
    "iso-53-c": (1.25, 0.25),
    "iso-53-d": (1.40, 0.39),
}
"""h_fP and the rounding rho_fP of the tool's tip, in normal modules; ISO 53:1998 (second hand)."""
_TABLES = {"sun-planet": "sun_mesh", "planet-ring": "ring_mesh", "pinion-gear": "mesh"}

FINEST_SHIFT = 0.5e-3
"""Half a unit of the last digit of a profile shift counts at most as this: 0.3 means 0.300. [1]"""
FINEST_LENGTH = 0.5e-6
"""The same of lengths: 39 mm means 39.000 mm. [m]"""
AGREES = 0.5e-6
"""A stated backlash that differs less from that of the teeth is that of the teeth. [m]"""
ROUNDING = 0.5e-9
"""Teeth that are too thick by less than this pass as they are; see `backlash.ROUNDING`. [m]"""
LEAST_SHIFT, LARGEST_SHIFT = -3.0, 5.0
"""What a case may state."""


@dataclass(frozen=True, slots=True)
class Found:
    """A value that the case does not state.

    Attributes
    ----------
    key : str
    value : str
        With unit, as a message shows it.
    how : str
        Where it comes from.
    """

    key: str
    value: str
    how: str

    def __str__(self) -> str:
        return f"{self.key} = {self.value}: {self.how}"


def negative_teeth(raw: Mapping[str, Any]) -> Iterator[Found]:
    """How negative numbers of teeth are understood."""
    tables = dict(raw)
    members = tables.pop("members", {})
    tables |= {f"gears.{name}": table for name, table in members.items()}
    for name, table in tables.items():
        teeth = table.get("teeth") if isinstance(table, dict) else None
        if isinstance(teeth, int) and teeth < 0:
            yield Found(
                f"{name}.teeth",
                str(-teeth),
                "a ring, because the number is negative; its profile shift is that of ISO 21771 "
                "and DIN 3960, positive where it thickens the teeth.",
            )


def converted_roughness(raw: Mapping[str, Any], place: str = "") -> Iterator[Found]:
    """How roughness that is stated as Ra or Rz is converted."""
    for key, value in raw.items():
        name = f"{place}{key}"
        if isinstance(value, dict):
            yield from converted_roughness(value, f"{name}.")
        elif key.endswith("roughness") and (told := roughness_told(value)) is not None:
            yield Found(name, f"{1e6 * told[0]:.4g} um", told[1])


def told_oil(raw: Mapping[str, Any]) -> Iterator[Found]:
    """What an oil stands for that is stated by its grade or two viscosities."""
    told = short_oil_told(value_at(dict(raw), ("lubricant", "oil")))
    if told is not None:
        yield Found("lubricant.oil", *told)


@dataclass(frozen=True, slots=True)
class Sizes:
    """The tables of a case with what they left out.

    Attributes
    ----------
    changed : dict of str to Table
        Tables in place of those of the case.
    found : tuple of Found
    problems : list of Problem
        Why something cannot be found.
    """

    changed: dict[str, Table] = field(default_factory=dict)
    found: tuple[Found, ...] = ()
    problems: list[Problem] = field(default_factory=list)


def find_sizes(sections: Mapping[str, Table], raw: Mapping[str, Any]) -> Sizes | None:
    """What the gears of a set or pair leave out.

    Parameters
    ----------
    sections : mapping of str to Table
        The tables that are valid by themselves.
    raw : mapping
        The case as the user wrote it, for the digits that are printed.

    Returns
    -------
    Sizes or None
        None if something is left out that only tables tell which are not valid.
    """
    gears = sections.get("gears")
    if not isinstance(gears, Gears):
        return Sizes()
    kind = "gear_pair" if {"pinion", "gear"} & {*sections, *raw} else "planetary"
    names = dict.fromkeys(name for mesh in MESHES[kind] for name in mesh.split("-"))
    tables = {name: table for name in names if isinstance(table := sections.get(name), GearTable)}
    incomplete = gears.center_distance is None or not all(
        table.states_thickness for table in tables.values()
    )
    if len(tables) < len(names):
        return None if incomplete else Sizes()
    try:
        return _Solver(gears, tables, sections, raw).solve(MESHES[kind])
    except InputError as error:
        return Sizes(problems=list(error.problems))
    except ValueError:  # a thickness inside the base circle: told with the gears
        return None if incomplete else Sizes()


def _refused(key: str, value: str, allowed: str, remedy: str) -> InputError:
    return InputError([Problem(key, value, allowed, remedy)])


@dataclass(frozen=True, slots=True)
class _Mesh:
    """A mesh by the names of its gears, the first of which gives way, and its table."""

    name: str
    key: str
    gears: tuple[str, str]
    teeth: int
    backlash: float | None


def _with_named_rack(
    gears: Gears, tables: Mapping[str, GearTable]
) -> tuple[Gears, dict[str, GearTable], list[Found]]:
    """The tables with what a profile says that is given by its name. ISO 53:1998, Table 2."""
    if gears.basic_rack is None:
        return gears, dict(tables), []
    dedendum, rounding = BASIC_RACKS[gears.basic_rack]
    radius = {"tool_tip_radius": rounding * build.basic_rack(gears).normal_module}
    rounded = {
        name: table
        if table.tool_tip_radius is not None or build.is_internal(table)
        else table.model_copy(update=radius)
        for name, table in tables.items()
    }
    coefficients = {"addendum_coefficient": 1.0, "dedendum_coefficient": dedendum}
    value = f"h_aP = 1, h_fP = {dedendum:g}, rounding {rounding:g}"
    told = Found("gears.basic_rack", value, f"{gears.basic_rack}, in normal modules.")
    return gears.model_copy(update=coefficients | {"basic_rack": None}), rounded, [told]


class _Solver:
    """The gears of one set or pair."""

    def __init__(
        self,
        gears: Gears,
        tables: Mapping[str, GearTable],
        sections: Mapping[str, Table],
        raw: Mapping[str, Any],
    ) -> None:
        self.gears, self.tables, self.found = _with_named_rack(gears, tables)
        stated: dict[str, Table] = {"gears": gears, **tables}
        made: dict[str, Table] = {"gears": self.gears, **self.tables}
        self.changed = {name: table for name, table in made.items() if table is not stated[name]}
        self.sections, self.raw = sections, raw
        self.rack = build.basic_rack(gears)
        self.distance = gears.center_distance
        self.thinned = {
            name: allowance_shift(table, self.rack) for name, table in self.tables.items()
        }
        self.shifts = {  # nominal, without allowances
            name: build.gear(name, table, self.gears).profile_shift_coefficient - self.thinned[name]
            for name, table in self.tables.items()
            if table.states_thickness
        }

    def _mesh(self, pair: str) -> _Mesh:
        one, two = pair.split("-")
        table, key = self.sections.get(_TABLES[pair]), _TABLES[pair]
        wheel = self.tables[two]
        teeth = self.tables[one].teeth + (-1 if build.is_internal(wheel) else 1) * wheel.teeth
        backlash = table.normal_backlash if isinstance(table, SetMesh) else None
        return _Mesh(key.replace("_", " "), key, (one, two), teeth, backlash)

    def solve(self, pairs: tuple[str, ...]) -> Sizes:
        self.meshes = [self._mesh(pair) for pair in pairs]
        doubly = [mesh for mesh in self.meshes if self.shifts.keys() >= set(mesh.gears)]
        if self.distance is None:
            self.distance = self._find_distance(doubly)
            doubly = doubly[1:]
        self._find_shifts()
        for mesh in doubly:
            self._adjust(mesh)
        return Sizes(self.changed, tuple(self.found))

    # --- centre distance ---

    def _find_distance(self, known: list[_Mesh]) -> float:
        """From the first of the meshes both of whose gears state their thickness."""
        if not known:
            raise _refused(
                "gears.center_distance",
                "",
                "is missing, and no mesh tells it: that takes the tooth thickness of both gears, "
                f"{' or '.join(' and '.join(mesh.gears) for mesh in self.meshes)}.",
                'Add center_distance = "... mm" to [gears], or profile_shift_coefficient to them.',
            )
        mesh = known[0]
        total = sum(self.shifts[name] for name in mesh.gears) + self._allowances(mesh)
        try:
            found = closed_center_distance(self.rack, mesh.teeth, total, mesh.backlash or 0.0)
        except ValueError as error:
            raise _refused(
                ", ".join(f"{name}.profile_shift_coefficient" for name in mesh.gears),
                "",
                f"leave no centre distance: {error}.",
                "Correct the profile shifts, or give gears.center_distance.",
            ) from None
        self.changed["gears"] = self.gears.model_copy(update={"center_distance": found})
        self._tell("gears.center_distance", f"{1e3 * found:.4f} mm", mesh, found)
        return found

    # --- profile shifts ---

    def _find_shifts(self) -> None:
        """Of each gear without one, the thinner of what its mates leave."""
        assert self.distance is not None
        distance = self.distance
        free = [name for name in self.tables if name not in self.shifts]
        while free:
            tied = {name: [mesh for mesh, _ in self._known_mates(name)] for name in free}
            name = next((name for name in free if tied[name]), None)
            if name is None:
                keys = ", ".join(f"{name}.profile_shift_coefficient" for name in free)
                raise _refused(
                    keys,
                    "",
                    "is missing, and so is that of every mate.",
                    "Add one of them, or tooth_thickness with thickness_diameter: the others "
                    "follow from the centre distance.",
                )
            shift, mesh = min(
                ((self._left(mesh, mate), mesh) for mesh, mate in self._known_mates(name)),
                key=lambda item: item[0],
            )
            self._set(name, shift)
            self._tell(f"{name}.profile_shift_coefficient", f"{shift:z.4f}", mesh, distance)
            free.remove(name)

    def _known_mates(self, name: str) -> Iterator[tuple[_Mesh, str]]:
        for mesh in self.meshes:
            if name in mesh.gears:
                mate = mesh.gears[1 - mesh.gears.index(name)]
                if mate in self.shifts:
                    yield mesh, mate

    def _left(self, mesh: _Mesh, mate: str) -> float:
        """The profile shift that `mate` leaves to the other gear."""
        return self._sum(mesh) - self.shifts[mate]

    def _sum(self, mesh: _Mesh) -> float:
        """Nominal x1 + x2 of a mesh; 0 if its gears cannot mesh, which is told with the meshes."""
        assert self.distance is not None
        try:
            total = profile_shift_sum(self.rack, mesh.teeth, self.distance, mesh.backlash or 0.0)
        except ValueError:
            return 0.0
        return total - self._allowances(mesh)

    def _allowances(self, mesh: _Mesh) -> float:
        """What allowances take from x1 + x2 before the stated backlash is left.

        Where none is stated, the nominal teeth have none.
        """
        return 0.0 if mesh.backlash is None else sum(self.thinned[name] for name in mesh.gears)

    def _set(self, name: str, shift: float) -> None:
        if not LEAST_SHIFT <= shift <= LARGEST_SHIFT:
            assert self.distance is not None
            raise _refused(
                f"{name}.profile_shift_coefficient",
                "",
                f"would have to be {shift:.3g} at the centre distance of "
                f"{millimetres(self.distance)}, and must be >= {LEAST_SHIFT:g} and <= "
                f"{LARGEST_SHIFT:g}.",
                "Correct gears.center_distance, the tooth numbers or the module.",
            )
        self.shifts[name] = shift
        self.changed[name] = self.tables[name].model_copy(
            update={key: None for choice in GearTable.THICKNESS for key in choice.split("+")}
            | {"profile_shift_coefficient": shift}
        )

    def _tell(self, key: str, value: str, mesh: _Mesh, distance: float) -> None:
        """Note what was found from a mesh."""
        if mesh.backlash is None:
            least = micrometres(recommended_backlash(self.rack, distance))
            with_what = (
                f"without backlash of the nominal teeth; ISO/TR 10064-2 recommends {least} or more"
            )
        else:
            with_what = f"with a normal backlash of {micrometres(mesh.backlash)}"
        self.found.append(Found(key, value, f"found from the {mesh.name}, {with_what}."))

    # --- what is stated twice ---

    def _adjust(self, mesh: _Mesh) -> None:
        """Thin a gear whose teeth are too thick by less than the printed digits."""
        over = sum(self.shifts[name] for name in mesh.gears) - self._sum(mesh)
        if mesh.backlash is None:
            over += sum(self.thinned[name] for name in mesh.gears)
        backlash = over * -2 * self.rack.normal_module * math.sin(self.rack.normal_pressure_angle)
        if mesh.backlash is not None and abs(backlash) > AGREES:
            raise _refused(
                f"{mesh.key}.normal_backlash",
                millimetres(mesh.backlash),
                f"contradicts the teeth and the centre distance, which leave "
                f"{micrometres(backlash + mesh.backlash)}.",
                "Leave out normal_backlash, a profile shift or the centre distance.",
            )
        if mesh.backlash is not None or backlash > -ROUNDING or over > self._printed(mesh):
            return
        name = mesh.gears[1] if mesh.key == "ring_mesh" else mesh.gears[0]
        shift = self.shifts[name] - over
        self._set(name, shift)
        self.found.append(
            Found(
                f"{name}.profile_shift_coefficient",
                f"{shift:.6f}",
                f"adjusted, because the teeth of the {mesh.name} are {-1e9 * backlash:.3g} nm too "
                "thick for the centre distance, less than the printed digits tell.",
            )
        )

    def _printed(self, mesh: _Mesh) -> float:
        """How far x1 + x2 may be from the centre distance by the digits of both. [1]"""
        assert self.distance is not None
        step = self._half_digit(("gears", "center_distance"), FINEST_LENGTH)
        away = profile_shift_sum(self.rack, mesh.teeth, self.distance + step)
        near = profile_shift_sum(self.rack, mesh.teeth, self.distance)
        return abs(away - near) + sum(map(self._printed_shift, mesh.gears))

    def _printed_shift(self, name: str) -> float:
        if self.tables[name].profile_shift_coefficient is not None:
            return self._half_digit((name, "profile_shift_coefficient"), FINEST_SHIFT)
        key = thickness_key(name, self.tables[name]).rpartition(".")[2]
        return thinning(self.rack, self._half_digit((name, key), FINEST_LENGTH))

    def _half_digit(self, path: tuple[str, str], most: float) -> float:
        """Half a unit of the last digit that the user wrote, in SI."""
        given = value_at(dict(self.raw), path)
        match = re.match(r"\s*[-+]?\d*\.?(\d*)(?:[eE]([-+]?\d+))?\s*(.*)", str(given))
        assert match is not None
        half = 0.5 * 10.0 ** (int(match[2] or 0) - len(match[1]))
        return min(most, MILLIMETRE.parse(f"{half!r} {match[3]}") if match[3] else half)
