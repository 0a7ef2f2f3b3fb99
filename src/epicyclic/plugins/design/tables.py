"""Tables of strength and mass, for the terminal and for reports."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from epicyclic.case.case import Case
from epicyclic.plugins.design.mass import parts
from epicyclic.plugins.design.strength import AFTER, MeshRating, Strength, strength
from epicyclic.result.result import Result, in_words
from epicyclic.show.page import Cell, Listing, Table, number

MPA, HOUR, CELSIUS = 1e-6, 3600.0, -273.15


def strength_tables(case: Case, result: Result | None) -> Iterator[Table | Listing]:
    """What `check`, `run --details` and reports show of a case with ``[strength]``."""
    yield from tables_of(strength(case))


def tables_of(found: Strength) -> Iterator[Table | Listing]:
    """Safeties, what leads to them, and which standards are followed how far."""
    if found.meshes:
        yield _gears(found)
        yield _flanks(found)
        yield _factors(found.meshes)
    if found.bearings:
        yield _bearings(found)
    yield Listing(
        (*found.notes, *AFTER.values(), f"load stages of the oil, scuffing {found.stages[0]}, "
        f"micropitting {found.stages[1]}: {found.stages_source}"),
        "Safeties: methods and limits",
    )  # fmt: skip


def _table(
    title: str, head: tuple[str, ...], digits: Sequence[int], rows: Sequence[tuple[Any, ...]]
) -> Table:
    """Rows of a name and numbers, of which NaN is none."""

    def cell(value: float, figures: int) -> Cell:
        return number(None if math.isnan(value) else value, "", figures)

    made = ((Cell(name), *map(cell, values, digits)) for name, *values in rows)
    return Table(head, tuple(made), title)


def _gears(found: Strength) -> Table:
    head = ("gear", "S_H", "sigma_H, MPa", "limit", "S_F", "sigma_F, MPa", "limit", "Y_F", "Y_S")
    rows = [
        (f"{in_words(it.gear)}, {in_words(mesh.key.rpartition('.')[2])}", it.pitting,
         it.contact_stress * MPA, it.contact_limit * MPA, it.bending,
         it.root_stress * MPA, it.root_limit * MPA, it.form_factor, it.stress_correction)
        for mesh in found.meshes for it in mesh.gears
    ]  # fmt: skip
    return _table("Pitting and bending after ISO 6336-2, -3", head, (3, 4, 4, 3, 4, 4, 3, 3), rows)


def _flanks(found: Strength) -> Table:
    head = ("mesh", "S_lambda", "lambda", "limit", "S_B", "theta_B, °C", "limit", "S_intS")
    rows = [
        (in_words(mesh.key), it.micropitting, it.film_ratio, it.film_ratio_limit, it.scuffing,
         it.contact_temperature + CELSIUS, it.scuffing_temperature + CELSIUS, it.integral_scuffing)
        for mesh in found.meshes for it in (mesh.flanks,)
    ]  # fmt: skip
    title = "Micropitting and scuffing after ISO/TS 6336-20 to -22"
    return _table(title, head, (3, 3, 3, 3, 4, 4, 3), rows)


def _factors(meshes: Sequence[MeshRating]) -> Table:
    head = ("mesh", "F_t, N", "K_A", "K_gamma", "K_v", "K_Hbeta", "computed", "K_Halpha",
            "K_Falpha")  # fmt: skip
    rows = [
        (in_words(mesh.key), mesh.tangential_force, it.application, it.sharing, it.dynamic, it.face,
         it.face_computed, it.transverse, it.transverse_bending)
        for mesh in meshes for it in (mesh.factors,)
    ]  # fmt: skip
    return _table("Load factors after ISO 6336-1", head, (5, *[4] * 7), rows)


def _bearings(found: Strength) -> Table:
    head = ("bearing", "P, N", "C, N", "kappa", "a_ISO", "L10, h", "L10m, h")
    rows = [
        (in_words(it.key), it.load, it.dynamic_load_rating, it.viscosity_ratio, it.life_factor,
         it.basic_life / HOUR, it.modified_life / HOUR)
        for it in found.bearings
    ]  # fmt: skip
    return _table("Bearing life after ISO 281", head, (4, 4, 3, 3, 4, 4), rows)


def mass_table(case: Case) -> Table:
    """Mass and inertia of every part."""
    found = parts(case)
    rows = (
        (Cell(in_words(it.name)), number(it.count, ""), number(it.mass, ""),
         number(1e4 * it.inertia, ""), number(1e4 * it.carried_inertia, ""))
        for it in found
    )  # fmt: skip
    total = sum(part.count * part.mass for part in found)
    return Table(
        ("part", "number", "mass, kg", "inertia, kg·cm²", "on the carrier, kg·cm²"),
        tuple(rows),
        "Mass and inertia",
        note=f"Together {total:.4g} kg, without shafts, pins, rollers and housing.",
    )
