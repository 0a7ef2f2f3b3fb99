"""From a REXS file to a case."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from epicyclic.case.case import Case, build_case, changed_tables
from epicyclic.case.template import case_text
from epicyclic.case.wording import one_line
from epicyclic.errors import InputError, Problem
from epicyclic.exchange.rexs import checks, planetary
from epicyclic.exchange.rexs.content import build_model
from epicyclic.exchange.rexs.draft import Draft, Lack
from epicyclic.exchange.rexs.file import read_document
from epicyclic.exchange.rexs.flank_forms import micro_geometry
from epicyclic.exchange.rexs.gears import gear_table, shared_table
from epicyclic.exchange.rexs.lubricant import lubricant_table, temperature
from epicyclic.exchange.rexs.model import Model
from epicyclic.exchange.rexs.operation import pair_operation, planetary_operation
from epicyclic.exchange.rexs.sets import Pair, PlanetarySet, choose, is_internal
from epicyclic.units import format_number

__all__ = ["RexsImport", "read_rexs"]

ROUNDING = 1e-3
"""Sum of the profile shifts of a mesh, as printed with three decimals, less the exact sum. [1]"""

_SHIFT = "profile_shift_coefficient"


@dataclass(frozen=True, slots=True, eq=False)
class RexsImport:
    """What a REXS file says of one gear set, and what it lacks.

    Attributes
    ----------
    source : str
        The file.
    version : str
        Of REXS.
    kind : str
        ``"planetary"`` or ``"gear_pair"``.
    component : str
        The stage it was read from.
    tables : mapping
        The tables of the case as far as the file gives them.
    origins : mapping of str to str
        Where the value of each key comes from.
    missing : tuple of Lack
        Keys for which the file has no value: REXS id, component, whether the case needs it, and
        what happens without it.
    notes : tuple of str
        Contradictions in the file, and choices that were made.
    """

    source: str
    version: str
    kind: str
    component: str
    tables: Mapping[str, Any]
    origins: Mapping[str, str]
    missing: tuple[Lack, ...]
    notes: tuple[str, ...]
    _model: Model
    _chosen: PlanetarySet | Pair

    def case(self, changes: Mapping[str, Any] | None = None) -> Case:
        """The case, with some keys set.

        Parameters
        ----------
        changes : mapping of str to object, optional
            Dotted keys to values, as in `PlanetaryCase.updated`.

        Raises
        ------
        InputError
            With every problem; for a key that the file lacks, with the REXS id that would give it.
        """
        try:
            return build_case(self.tables, changes or {}, self.source)
        except InputError as error:
            problems = [self._explained(problem) for problem in error.problems]
            raise InputError(problems, error.source) from None

    def lacking(self, given: Collection[str] = ()) -> tuple[Lack, ...]:
        """What is missing but for the keys, or whole tables, that are `given`."""
        return tuple(
            lack for lack in self.missing if not any(_is_below(lack.key, key) for key in given)
        )

    def text(self, changes: Mapping[str, Any] | None = None) -> str:
        """The commented case file: for every value its origin, for every other key what is known.

        Parameters
        ----------
        changes : mapping of str to object, optional
            Keys to set.
        """
        tables, about = dict(self.tables), dict(self.origins)
        for lack in self.lacking(changes or ()):
            about[lack.key] = f"{'NEEDED. ' if lack.needed else ''}{lack}"
        if changes:
            tables = changed_tables(tables, changes)
            for key, value in changes.items():
                about = {name: told for name, told in about.items() if not _is_below(name, key)}
                about[key] = "Taken out by the user." if value is None else "Set by the user."
        head = [
            f"Case of epicyclic, imported from {one_line(self.source, 200)}: {self.component}.",
            f"REXS {self.version}. Beside each value stands the attribute that it comes from.",
            "Keys behind a # have the default that is shown or told, or are NEEDED.",
            *self.notes,
        ]
        return case_text(tables, [one_line(line, 400) for line in head], about)

    def geometry_notes(self, case: Case) -> tuple[str, ...]:
        """Figures of the file, such as base diameters, that differ from those of `case`."""
        return tuple(checks.geometry_notes(case, self._chosen, self._model))

    def _explained(self, problem: Problem) -> Problem:
        """A problem of a key that the file lacks, with what the file should have."""
        lacks = [lack for lack in self.missing if lack.needed and lack.explains(problem)]
        remedies = [
            f"The file has no {lack.attribute}. Set {lack.key}. {lack.instead}" for lack in lacks
        ]
        return replace(problem, remedy=" ".join(remedies).rstrip()) if lacks else problem


def _is_below(key: str, owner: str) -> bool:
    """True if `key` is `owner` or one of its keys."""
    return key == owner or key.startswith(f"{owner}.")


def read_rexs(
    path: str | Path, component: int | None = None, load_case: int | None = None
) -> RexsImport:
    """Read a gear set from a REXS file.

    Parameters
    ----------
    path : str or Path
        A file ``.rexs``, ``.rexsj`` or ``.rexsz`` of version 1.1 to 2.0.
    component : int, optional
        Id of the ``planetary_stage`` or ``cylindrical_stage``, if the file has several.
    load_case : int, optional
        Id of a load case of the load spectrum, whose values come before those of the components.

    Returns
    -------
    RexsImport

    Raises
    ------
    InputError
        If it is no such file, or if it has no such gear set.
    """
    source = str(path)
    document = read_document(Path(path))
    try:
        model = _with_load_case(build_model(document.content), load_case)
        chosen = choose(model, component)
        draft = _draft(model, chosen)
    except InputError as error:
        raise InputError(error.problems, one_line(source, 500)) from None
    return RexsImport(
        source=source,
        version=model.version,
        kind=draft.tables["kind"],
        component=str(chosen.component),
        tables=draft.tables,
        origins=draft.origins,
        missing=tuple(draft.lacks.values()),
        notes=tuple(draft.notes),
        _model=model,
        _chosen=chosen,
    )


def _with_load_case(model: Model, load_case: int | None) -> Model:
    if load_case is None:
        return model
    if load_case not in model.load_cases:
        known = ", ".join(map(str, list(model.load_cases)[:12])) or "none"
        problem = Problem("--load-case", str(load_case), "is not in the file.", f"It has {known}.")
        raise InputError([problem])
    return model.with_load_case(load_case)


def _draft(model: Model, chosen: PlanetarySet | Pair) -> Draft:
    title = chosen.component.name.strip()
    is_pair = isinstance(chosen, Pair)
    draft = Draft({"kind": "gear_pair" if is_pair else "planetary", "title": one_line(title)})
    if isinstance(chosen, Pair):
        _pair(draft, model, chosen)
    else:
        _planetary(draft, model, chosen)
    stages = [mesh.stage for mesh in chosen.meshes]
    temperature(draft, model, stages)
    lubricant_table(draft, model, stages)
    draft.notes += checks.file_notes(chosen)
    if len(model.load_cases) > 0:
        cases = ", ".join(map(str, list(model.load_cases)[:12]))
        draft.notes.append(f"The file has load cases: {cases}. One is read with --load-case.")
    if draft.problems:
        raise InputError(draft.problems)
    return draft


def _planetary(draft: Draft, model: Model, chosen: PlanetarySet) -> None:
    planetary_operation(draft, model, chosen)
    gears = [chosen.sun, *chosen.planets, chosen.ring]
    shared_table(draft, model, gears, [mesh.stage for mesh in chosen.meshes])
    for key, own in (("sun", [chosen.sun]), ("planet", chosen.planets), ("ring", [chosen.ring])):
        gear_table(draft, model, key, own)
        micro_geometry(draft, model, key, own)
    draft.give("planet.count", len(chosen.planets), f"counted: planets of {chosen.component}")
    draft.take("planet.mass", "mass_of_component", chosen.planets, None)
    _shifts(draft, "sun", "planet", "sun")
    _shifts(draft, "planet", "ring", "ring")
    planetary.planet_angles(draft, chosen)
    planetary.bearing_table(draft, model, chosen)
    planetary.carrier_table(draft, model, chosen)
    rims = model.partners(chosen.ring.id, "assembly", "assembly", "part", "gear_body")
    draft.take("ring.rim_thickness", "gear_body_rim_thickness", rims, None)


def _pair(draft: Draft, model: Model, chosen: Pair) -> None:
    pair_operation(draft, model, chosen)
    shared_table(draft, model, [chosen.pinion, chosen.gear], [chosen.mesh.stage])
    for key, own in (("pinion", [chosen.pinion]), ("gear", [chosen.gear])):
        gear_table(draft, model, key, own)
        micro_geometry(draft, model, key, own)
    if is_internal(chosen.gear):
        draft.give("gear.internal", True, f"{chosen.gear}")
    _shifts(draft, "pinion", "gear", "gear")


def _shifts(draft: Draft, member1: str, member2: str, changed: str) -> None:
    """Look at the profile shifts of a mesh.

    Say which one would close it if one is lacking, and if one seems to have the wrong sign. Shifts
    of a mesh without backlash may overlap by the last digit that is printed of them; the one of
    `changed` is then reduced.
    """
    draft.notes += checks.shift_notes(draft.tables, member1, member2)
    for own, other in ((member2, member1), (member1, member2)):
        key = f"{own}.profile_shift_coefficient"
        closing = checks.closing_shift(draft.tables, other, own)
        if closing is None:
            continue
        shown = math.floor(closing * 1e6) / 1e6 + 0.0
        if key in draft.lacks:
            text = f"With the {other}, {format_number(shown)} leaves no backlash."
            draft.lacks[key] = replace(draft.lacks[key], instead=text)
            continue
        shift = draft.tables[own].get(_SHIFT)
        is_too_much = isinstance(shift, float) and 0 < shift - shown <= ROUNDING
        if own == changed and is_too_much:
            origin = f"{draft.origins[key]}: {shift}, less what the printed digits are too much"
            draft.give(key, shown, origin)
