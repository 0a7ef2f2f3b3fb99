"""What `check` shows: the gears of a case as on a data sheet, its oil, and what was found."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from epicyclic.case.case import Case
from epicyclic.oil.oil import GoldLaw
from epicyclic.report import page
from epicyclic.report.shown import MISSING
from epicyclic.report.tables import as_on_page, titled
from epicyclic.study.data_sheet import DataSheet, GearSheet, MeshSheet, data_sheets, oil_at_inlet
from epicyclic.units import unit_text

MM, UM = 1e3, 1e6
_GearRow = tuple[str, str, Callable[[GearSheet], str]]
_MeshRow = tuple[str, str, Callable[[MeshSheet], str]]


def _mm(value: float) -> str:
    return f"{MM * value:.3f}"


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
    ("root diameter d_f", "mm", lambda one: _mm(2 * one.gear.root_radius)),
    (
        "thickness of the tips s_a",
        "mm",
        lambda one: _mm(one.gear.thickness_at(one.gear.tip_radius)),
    ),
    ("face width b", "mm", lambda one: _mm(one.gear.face_width)),
    ("teeth of the span k", "", lambda one: str(one.span[0]) if one.span else MISSING),
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
    ("least j_bn, ISO/TR 10064-2", "um", lambda one: f"{UM * one.recommended_backlash:.1f}"),
    ("clearance at tip 1", "mm", lambda one: _mm(one.mesh.tip_clearance1)),
    ("clearance at tip 2", "mm", lambda one: _mm(one.mesh.tip_clearance2)),
    ("specific sliding at root 1", "", lambda one: _ratio(one.specific_sliding[0])),
    ("specific sliding at root 2", "", lambda one: _ratio(one.specific_sliding[1])),
)


def _ratio(value: float | None) -> str:
    return MISSING if value is None else f"{value:.3f}"


def data_sheet(case: Case) -> RenderableType:
    """The gears and the oil of a case, and what was found, for a terminal."""
    parts: list[RenderableType] = []
    for name, sheet in data_sheets(case).items():
        parts += map(as_on_page, _tables(sheet, f", {name}" if name else ""))
    if (oil := _oil(case)) is not None:
        parts.append(Text(oil))
    if case.found:
        told = tuple(map(str, case.found))
        parts.append(as_on_page(page.Listing(told, "Found, converted or adjusted")))
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
    state = oil_at_inlet(case)
    if state is None or case.lubricant is None:
        return None
    oil = case.lubricant.oil
    law = "by Gold's constants" if isinstance(oil.pressure_viscosity, GoldLaw) else "by Roelands"
    return (
        f"Oil {oil.name} at {state.temperature - 273.15:.4g} °C: "
        f"nu {UM * state.kinematic_viscosity:.4g} mm²/s, rho {state.density:.4g} kg/m³, "
        f"alpha {1e9 * state.pressure_viscosity:.4g} 1/GPa {law}."
    )
