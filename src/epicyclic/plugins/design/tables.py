"""Tables of strength and mass, for the terminal and for reports."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from epicyclic.case.case import Case
from epicyclic.plugins.design.mass import Part, parts
from epicyclic.plugins.design.strength import AFTER, MeshRating, Strength, strength
from epicyclic.result.result import Result
from epicyclic.show.page import Cell, Listing, Table, number

MPA, HOUR, CELSIUS = 1e-6, 3600.0, -273.15


def strength_tables(case: Case, result: Result | None) -> Iterator[Table | Listing]:
    """What `check`, `run --details` and reports show of a case with ``[strength]``."""
    yield from tables_of(strength(case))


def tables_of(found: Strength) -> Iterator[Table | Listing]:
    """Safeties, what leads to them, and which standards are followed how far."""
    yield _gears(found)
    yield _flanks(found)
    yield _factors(found.meshes)
    if found.bearings:
        yield _bearings(found)
    yield Listing(
        (*AFTER.values(), f"load stages of the oil, scuffing {found.stages[0]}, micropitting "
        f"{found.stages[1]}: {found.stages_source}"),
        "Safeties: what they follow",
    )  # fmt: skip


def _number(value: float, digits: int = 4) -> Cell:
    return number(None if math.isnan(value) else value, "", digits)


def _gears(found: Strength) -> Table:
    rows = [
        (
            Cell(f"{gear.gear}, {mesh.key.replace('_', ' ')}"),
            _number(gear.pitting, 3),
            _number(gear.contact_stress * MPA),
            _number(gear.contact_limit * MPA),
            _number(gear.bending, 3),
            _number(gear.root_stress * MPA),
            _number(gear.root_limit * MPA),
            _number(gear.form_factor, 3),
            _number(gear.stress_correction, 3),
        )
        for mesh in found.meshes
        for gear in mesh.gears
    ]
    head = ("gear", "S_H", "sigma_H [MPa]", "limit", "S_F", "sigma_F [MPa]", "limit", "Y_F", "Y_S")
    return Table(head, tuple(rows), "Pitting and bending after ISO 6336-2, -3")


def _flanks(found: Strength) -> Table:
    rows = [
        (
            Cell(mesh.key.replace("_", " ")),
            _number(mesh.flanks.micropitting, 3),
            _number(mesh.flanks.film_ratio, 3),
            _number(mesh.flanks.film_ratio_limit, 3),
            _number(mesh.flanks.scuffing, 3),
            _number(mesh.flanks.contact_temperature + CELSIUS),
            _number(mesh.flanks.scuffing_temperature + CELSIUS),
            _number(mesh.flanks.integral_scuffing, 3),
        )
        for mesh in found.meshes
    ]
    head = ("mesh", "S_lambda", "lambda", "limit", "S_B", "theta_B [°C]", "limit", "S_intS")
    return Table(head, tuple(rows), "Micropitting and scuffing after ISO/TS 6336-20 to -22")


def _factors(meshes: Sequence[MeshRating]) -> Table:
    rows = [
        (
            Cell(mesh.key.replace("_", " ")),
            _number(mesh.tangential_force, 5),
            _number(mesh.factors.application),
            _number(mesh.factors.sharing),
            _number(mesh.factors.dynamic),
            _number(mesh.factors.face),
            _number(mesh.factors.face_computed),
            _number(mesh.factors.transverse),
        )
        for mesh in meshes
    ]
    head = ("mesh", "F_t [N]", "K_A", "K_gamma", "K_v", "K_Hbeta", "computed", "K_Halpha")
    return Table(head, tuple(rows), "Load factors after ISO 6336-1")


def _bearings(found: Strength) -> Table:
    rows = [
        (
            Cell(one.key.replace("_", " ")),
            _number(one.load),
            _number(one.dynamic_load_rating),
            _number(one.viscosity_ratio, 3),
            _number(one.life_factor, 3),
            _number(one.basic_life / HOUR),
            _number(one.modified_life / HOUR),
        )
        for one in found.bearings
    ]
    head = ("bearing", "P [N]", "C [N]", "kappa", "a_ISO", "L10 [h]", "L10m [h]")
    return Table(head, tuple(rows), "Bearing life after ISO 281")


def mass_table(case: Case) -> Table:
    """Mass and inertia of every part."""
    found = parts(case)

    def row(part: Part) -> tuple[Cell, ...]:
        cells = (part.mass, 1e4 * part.inertia, 1e4 * part.carried_inertia)
        return (Cell(part.name), number(part.count, ""), *(number(it, "") for it in cells))

    total = sum(part.count * part.mass for part in found)
    return Table(
        ("part", "number", "mass [kg]", "inertia [kg cm²]", "on the carrier [kg cm²]"),
        tuple(map(row, found)),
        "Mass and inertia",
        note=f"Together {total:.4g} kg, without shafts, pins, rollers and housing.",
    )
