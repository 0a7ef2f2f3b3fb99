"""What a case leaves out of its gears, and how its signs, roughness and oil are understood.

A mesh joins its centre distance, two profile shifts and its backlash: any one of them follows from
the others, which `epicyclic.case.size_solver` finds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from epicyclic.case import build
from epicyclic.case.gear_tables import Gears, GearTable, SetMesh
from epicyclic.case.read import value_at
from epicyclic.case.size_solver import Found, SizedMesh, Solver
from epicyclic.case.tables.base import Table, roughness_told, short_oil_told
from epicyclic.errors import InputError, Problem

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
    """The tables of a case with what they left out."""

    changed: dict[str, Table] = field(default_factory=dict)  # Tables in place of those of the case.
    found: tuple[Found, ...] = ()
    problems: list[Problem] = field(default_factory=list)  # Why something cannot be found.


def find_sizes(
    sections: Mapping[str, Table],  # The tables that are valid by themselves.
    raw: Mapping[str, Any],  # The case as the user wrote it, for the digits that are printed.
) -> Sizes | None:
    """What the gears of a set or pair leave out.

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
        return _solved(gears, tables, sections, raw, MESHES[kind])
    except InputError as error:
        return Sizes(problems=list(error.problems))
    except ValueError:  # a thickness inside the base circle: told with the gears
        return None if incomplete else Sizes()


def _solved(
    gears: Gears,
    tables: Mapping[str, GearTable],
    sections: Mapping[str, Table],
    raw: Mapping[str, Any],
    pairs: tuple[str, ...],
) -> Sizes:
    named, with_rack, told = _with_named_rack(gears, tables)
    solver = Solver(
        {name: build.gear(name, table, named) for name, table in with_rack.items()
         if table.states_thickness},
        with_rack,
        [_mesh(pair, named, with_rack, sections) for pair in pairs],
        raw,
    )  # fmt: skip
    solver.solve()
    changed: dict[str, Table] = {
        name: table for name, table in solver.tables.items() if table is not tables[name]
    }
    distance = solver.distances[solver.meshes[0].group]
    if named.center_distance != distance:
        named = named.model_copy(update={"center_distance": distance})
    if named is not gears:
        changed["gears"] = named
    return Sizes(changed, (*told, *solver.found))


def _mesh(
    pair: str, gears: Gears, tables: Mapping[str, GearTable], sections: Mapping[str, Table]
) -> SizedMesh:
    one, two = pair.split("-")
    table, key = sections.get(_TABLES[pair]), _TABLES[pair]
    internal = build.is_internal(tables[two])
    return SizedMesh(
        key.replace("_", " "),
        f"{key}.normal_backlash",
        (one, two),
        tables[one].teeth + (-1 if internal else 1) * tables[two].teeth,
        table.normal_backlash if isinstance(table, SetMesh) else None,
        build.basic_rack(gears),
        ("gears", "center_distance"),
        gears.center_distance,
        gives_way=two if key == "ring_mesh" else one,
    )


def _with_named_rack(
    gears: Gears, tables: Mapping[str, GearTable]
) -> tuple[Gears, dict[str, GearTable], list[Found]]:
    """The tables with what a profile says that is given by its name."""
    if gears.basic_rack is None:
        return gears, dict(tables), []
    module = build.basic_rack(gears).normal_module
    rounded = {
        name: with_tool_tip(table, gears.basic_rack, module) for name, table in tables.items()
    }
    coefficients, told = named_rack(gears.basic_rack)
    return gears.model_copy(update=coefficients), rounded, [told]


def named_rack(name: str) -> tuple[dict[str, Any], Found]:
    """What a profile says that is given by its name. ISO 53:1998, Table 2."""
    dedendum, rounding = BASIC_RACKS[name]
    told = f"h_aP = 1, h_fP = {dedendum:g}, rounding {rounding:g}"
    coefficients = {
        "addendum_coefficient": 1.0,
        "dedendum_coefficient": dedendum,
        "basic_rack": None,
    }
    return coefficients, Found("gears.basic_rack", told, f"{name}, in normal modules.")


def with_tool_tip(table: GearTable, rack: str, module: float) -> GearTable:
    """A gear with the rounding of the tool of a named profile, unless it states one."""
    if table.tool_tip_radius is not None or build.is_internal(table):
        return table
    return table.model_copy(update={"tool_tip_radius": BASIC_RACKS[rack][1] * module})
