"""What is known without solving: gears as on a data sheet, states of a train, the library."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from rich.console import Group, RenderableType
from rich.table import Column
from rich.text import Text

from epicyclic import library
from epicyclic.case.case import Case, TrainCase
from epicyclic.case.tables.elements import between
from epicyclic.gears.assembly import spacing_notes
from epicyclic.gears.gear import HOUSING
from epicyclic.gears.rules import tooth_notes
from epicyclic.oil.oil import GoldLaw, Oil, OilState, oil_state
from epicyclic.show import page
from epicyclic.show.page import MISSING, shown
from epicyclic.show.result_tables import adjusted
from epicyclic.show.terminal import as_on_page, plain_table, titled
from epicyclic.study.data_sheet import DataSheet, GearSheet, MeshSheet, data_sheets
from epicyclic.study.trains import StateKinematics, train_states
from epicyclic.units import (
    CELSIUS,
    KILOGRAM_PER_CUBIC_METRE,
    PER_GIGAPASCAL,
    SQUARE_MM_PER_SECOND,
    celsius_text,
    format_number,
    unit_text,
)

MM, UM = 1e3, 1e6
_GearRow = tuple[str, str, Callable[[GearSheet], str]]
_MeshRow = tuple[str, str, Callable[[MeshSheet], str]]


def _mm(value: float | None) -> str:
    return MISSING if value is None else f"{MM * value:.3f}"


def _allowance(one: GearSheet, which: int) -> str:
    return MISSING if one.allowances is None else f"{UM * one.allowances[which]:.1f}"


def _tolerance(one: GearSheet, name: str) -> str:
    return MISSING if one.tolerances is None else f"{UM * getattr(one.tolerances, name):.1f}"


_GEAR_ROWS: tuple[_GearRow, ...] = (
    ("teeth z", "", lambda one: str(one.gear.teeth)),
    ("profile shift x, nominal", "", lambda one: f"{one.nominal_shift:z.4f}"),
    ("profile shift x_E, as made", "", lambda one: f"{one.gear.profile_shift_coefficient:z.4f}"),
    ("normal thickness s_n", "mm", lambda one: _mm(one.normal_thickness)),
    ("reference diameter d", "mm", lambda one: _mm(2 * one.gear.reference_radius)),
    ("base diameter d_b", "mm", lambda one: _mm(2 * one.gear.base_radius)),
    ("tip diameter d_a", "mm", lambda one: _mm(2 * one.gear.tip_radius)),
    ("tip alteration k m_n", "mm", lambda one: _mm(one.tip_alteration or None)),
    ("root diameter d_f", "mm", lambda one: _mm(2 * one.gear.root_radius)),
    ("tip thickness s_a", "mm", lambda one: _mm(one.gear.thickness_at(one.gear.tip_radius))),
    ("face width b", "mm", lambda one: _mm(one.gear.face_width)),
    ("number of teeth spanned k", "", lambda one: str(one.span[0]) if one.span else MISSING),
    ("span W_k", "mm", lambda one: _mm(one.span[1]) if one.span else MISSING),
    ("measuring ball D_M", "mm", lambda one: _mm(one.pins[0]) if one.pins else MISSING),
    ("dimension over balls M_d", "mm", lambda one: _mm(one.pins[1]) if one.pins else MISSING),
    ("allowance A_sne", "um", lambda one: _allowance(one, 0)),
    ("allowance A_sni", "um", lambda one: _allowance(one, 1)),
    ("single pitch f_pT, ISO 1328-1", "um", lambda one: _tolerance(one, "single_pitch")),
    ("total profile F_alphaT", "um", lambda one: _tolerance(one, "profile")),
    ("profile slope f_HalphaT", "um", lambda one: _tolerance(one, "profile_slope")),
    ("total helix F_betaT", "um", lambda one: _tolerance(one, "helix")),
    ("helix slope f_HbetaT", "um", lambda one: _tolerance(one, "helix_slope")),
    ("roughness Rq", "um", lambda one: f"{UM * one.roughness:.3f}"),
)

_MESH_ROWS: tuple[_MeshRow, ...] = (
    ("centre distance a", "mm", lambda one: _mm(one.mesh.center_distance)),
    (
        "pressure angle alpha_wt",
        "deg",
        lambda one: f"{math.degrees(one.mesh.operating_pressure_angle):.4f}",
    ),
    ("pitch diameter d_w1", "mm", lambda one: _mm(2 * one.mesh.operating_radius1)),
    ("pitch diameter d_w2", "mm", lambda one: _mm(2 * one.mesh.operating_radius2)),
    ("contact ratio epsilon_alpha", "", lambda one: f"{one.mesh.transverse_contact_ratio:.4f}"),
    ("overlap ratio epsilon_beta", "", lambda one: f"{one.mesh.overlap_ratio:.4f}"),
    (
        "total contact ratio",
        "",
        lambda one: f"{one.mesh.transverse_contact_ratio + one.mesh.overlap_ratio:.4f}",
    ),
    ("normal backlash j_bn", "um", lambda one: f"{UM * one.mesh.normal_backlash:z.1f}"),
    ("circumferential backlash j_wt", "um", lambda one: f"{UM * one.mesh.backlash:z.1f}"),
    ("recommended j_bn, ISO/TR 10064-2", "um", lambda one: f"{UM * one.recommended_backlash:.1f}"),
    ("clearance at tip 1", "mm", lambda one: _mm(one.mesh.tip_clearances[0])),
    ("clearance at tip 2", "mm", lambda one: _mm(one.mesh.tip_clearances[1])),
    ("specific sliding at root 1", "", lambda one: _ratio(one.specific_sliding[0])),
    ("specific sliding at root 2", "", lambda one: _ratio(one.specific_sliding[1])),
)


def _ratio(value: float | None) -> str:
    return MISSING if value is None else f"{value:.3f}"


LEAST_CLEARANCE = 0.1
"""Clearance between tip and root over the normal module from which none is missing; ISO 53 has 0.25
(general knowledge). [1]"""


def reservations(case: Case) -> Iterator[str]:
    """What a designer would correct, although the case can be computed."""
    for name, sheet in data_sheets(case).items():
        where = f"{name}: the" if name else "The"
        for note in (*spacing_notes(case.gearings[name]), *tooth_notes(case.gearings[name])):
            yield f"{name}: {note}" if name else note
        for one in sheet.meshes:
            mesh, found, least = one.mesh, one.mesh.normal_backlash, one.recommended_backlash
            if found < (1 - _ROUNDING) * least:
                yield (
                    f"{where} normal backlash of the {mesh.name} is {UM * found:z.1f} µm, less "
                    f"than the {UM * least:.1f} µm that ISO/TR 10064-2 recommends."
                )
            module = mesh.gear1.rack.normal_module
            for gear, clearance in zip(mesh.gears, mesh.tip_clearances, strict=True):
                if clearance < LEAST_CLEARANCE * module:
                    yield (
                        f"{where} tip clearance of the {gear.name} in the {mesh.name} is "
                        f"{_mm(clearance)} mm, {clearance / module:z.2f} normal modules; ISO 53 "
                        "specifies 0.25."
                    )


_ROUNDING = 1e-9


def data_sheet(case: Case) -> RenderableType:
    """The gears and the oil of a case, and what was found, for a terminal."""
    parts: list[RenderableType] = []
    for name, sheet in data_sheets(case).items():
        parts += map(as_on_page, _tables(sheet, f", {name}" if name else ""))
    if (oil := _oil(case)) is not None:
        parts.append(Text(oil))
    parts += map(as_on_page, adjusted(case))
    return titled(case.title or case.kind, *parts)


def _tables(sheet: DataSheet, of: str) -> Iterator[page.Table]:
    names = [one.gear.name for one in sheet.gears]
    yield _table(f"Gears{of}", names, _GEAR_ROWS, sheet.gears)
    names = [one.mesh.name for one in sheet.meshes]
    yield _table(f"Meshes{of}", names, _MESH_ROWS, sheet.meshes)


def _table(
    title: str,
    names: Sequence[str],
    rows: Sequence[tuple[str, str, Callable[[Any], str]]],
    columns: Sequence[Any],
) -> page.Table:
    """The rows in which any column has a value."""
    filled = ((label, unit, [text(one) for one in columns]) for label, unit, text in rows)
    return page.Table(
        ("", *names, "unit"),
        tuple(
            (page.Cell(label), *map(page.aligned, texts), page.Cell(unit_text(unit)))
            for label, unit, texts in filled
            if any(text != MISSING for text in texts)
        ),
        title,
    )


def _oil(case: Case) -> str | None:
    """One line on the oil at the inlet."""
    temperature = case.operation.oil_inlet_temperature
    if case.lubricant is None or temperature is None:
        return None
    oil = case.lubricant.oil
    state = oil_state(oil, temperature)
    law = "Gold" if isinstance(oil.pressure_viscosity, GoldLaw) else "Roelands"
    return (
        f"Oil {oil.name} at {state.temperature - 273.15:.4g} °C: "
        f"nu {UM * state.kinematic_viscosity:.4g} mm²/s, rho {state.density:.4g} kg/m³, "
        f"alpha {1e9 * state.pressure_viscosity:.4g} 1/GPa after {law}."
    )


def state_tables(case: TrainCase) -> RenderableType:
    """Shafts of a train with their members, parts between them, and the ratio of every state."""
    states = train_states(case)
    shafts = plain_table("Shafts", Column("", no_wrap=True), "turns as one body")
    for name, members in case.shape.shafts.items():
        shafts.add_row("housing, at rest" if name == HOUSING else name, ", ".join(members))
    parts = plain_table("Parts", "", "kind", "between")
    for kind, name, part in case.elements:
        parts.add_row(name, kind.replace("_", " "), ", ".join(between(part, case.shape.names)))
    title = f"Ratio: speed of {case.operation.input} over speed of {case.operation.output}"
    numbers = (Column(head, justify="right", no_wrap=True) for head in ("ratio", "step"))
    table = plain_table(title, "state", *numbers, "held", "joined", "")
    before: StateKinematics | None = None
    for state in states:
        table.add_row(
            state.name or "always",
            MISSING if state.ratio is None else shown(state.ratio, 5),
            _step(before, state),
            ", ".join(state.held),
            ", ".join(" + ".join(group) for group in state.joined),
            state.remark,
        )
        before = state
    return Group(shafts, Text(), *((parts, Text()) if parts.rows else ()), table)


def _step(before: StateKinematics | None, state: StateKinematics) -> str:
    """Ratio of the state before over that of this one, where both turn the output one way."""
    if before is None or not before.ratio or not state.ratio or before.ratio * state.ratio < 0:
        return ""
    return format_number(before.ratio / state.ratio, 4)


# Tables of what is built in.


def case_table() -> RenderableType:
    """Built-in cases and the words that name their variants."""
    variants = "variants: at most one word of each line, joined by -"
    table = plain_table("Built-in cases", Column("name", no_wrap=True), "description", variants)
    for name in library.names("cases"):
        groups = library.case_variants().get(name, [])
        words = "\n".join(f"{' '.join(group['words'])}  ({group['about']})" for group in groups)
        table.add_row(name, library.builtin_case(name)["title"], words)
    return Group(table, Text("For example: epicyclic run talbot-2012-n6-polished-40C"))


def oil_table() -> RenderableType:
    """The oil library."""
    viscosity = unit_text(SQUARE_MM_PER_SECOND.display)
    heads = (
        f"ν 40 °C\n{viscosity}",
        f"ν 100 °C\n{viscosity}",
        f"ρ 40 °C\n{unit_text(KILOGRAM_PER_CUBIC_METRE.display)}",
        f"α 40 °C\n{unit_text(PER_GIGAPASCAL.display)}",
    )
    numbers = (Column(head, justify="right") for head in heads)
    table = plain_table("Built-in oils", Column("name", no_wrap=True), "kind", *numbers)
    for name in sorted(library.names("oils"), key=_by_grade):
        oil = Oil.model_validate(library.oil_table(name))
        warm, hot = _state(oil, "40 degC"), _state(oil, "100 degC")
        table.add_row(
            name,
            oil.kind,
            shown(SQUARE_MM_PER_SECOND.to_display(warm.kinematic_viscosity)),
            shown(SQUARE_MM_PER_SECOND.to_display(hot.kinematic_viscosity)),
            shown(KILOGRAM_PER_CUBIC_METRE.to_display(warm.density)),
            shown(PER_GIGAPASCAL.to_display(warm.pressure_viscosity), 3),
        )
    return Group(table, Text("Sources of the values: epicyclic oils NAME"))


def _state(oil: Oil, temperature: str) -> OilState:
    return oil_state(oil, CELSIUS.parse(temperature))


def _by_grade(name: str) -> list[tuple[bool, int, str]]:
    """Sort key that puts ISO VG 68 before ISO VG 100."""
    return [(part.isdigit(), int(part) if part.isdigit() else 0, part) for part in name.split("-")]


def oil_sheet(name: str) -> RenderableType:
    """Every value of one oil with its source."""
    oil = Oil.model_validate(library.oil_table(name))
    value = Column("value", justify="right", no_wrap=True)
    table = plain_table(f"{name}: {oil.title}", "property", value, "source")
    for label, unit, points in (
        ("kinematic viscosity", SQUARE_MM_PER_SECOND, oil.kinematic_viscosity),
        ("density", KILOGRAM_PER_CUBIC_METRE, oil.density),
    ):
        for point in points:
            at = f"{label} at {celsius_text(point.temperature, 4)}"
            table.add_row(at, unit_text(unit.text(point.value)), point.source)
    law = oil.pressure_viscosity
    calibrated = " (calibrated)" if law.calibrated else ""
    table.add_row(
        f"pressure-viscosity coefficient at 40 °C, {law.law} law{calibrated}",
        unit_text(PER_GIGAPASCAL.text(_state(oil, "40 degC").pressure_viscosity, 4)),
        law.source,
    )
    factor = oil.lubricant_factor
    table.add_row("lubricant factor X_L", f"{factor.value:g}", factor.source)
    return Group(Text(oil.description), table)
