"""From a REXS file to a case."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from epicyclic.case.case import Case, build_case, changed_tables
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import InputError, Problem, problems_in, raise_any
from epicyclic.messages import one_line
from epicyclic.plugins.rexs.draft import (
    Draft,
    Lack,
    lubricant_table,
    pair_operation,
    planetary_operation,
    temperature,
)
from epicyclic.plugins.rexs.files import read_document
from epicyclic.plugins.rexs.gears import file_notes, geometry_notes, set_tables
from epicyclic.plugins.rexs.model import Model, build_model, check_places
from epicyclic.plugins.rexs.sets import SetParts, Train, choose, chosen_train
from epicyclic.plugins.rexs.train import train_draft
from epicyclic.show.template import case_text


@dataclass(frozen=True, slots=True, eq=False)
class RexsImport:
    """The data of one gear set or of a train in a REXS file, and the data missing there.

    Attributes
    ----------
    source : str
        The file.
    version : str
        Version of REXS.
    kind : str
        ``"planetary"`` or ``"gear_pair"``; ``"train"`` if the file has several stages.
    component : str
        The stage it was read from, or the gear unit.
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
    _chosen: SetParts | Train

    def case(
        self,
        # Dotted keys to values, as in `PlanetaryCase.updated`.
        changes: Mapping[str, Any] | None = None,
    ) -> Case:
        """The case, with some keys set.

        Raises `InputError` with every problem; for a key that the file lacks, with the REXS id that
        would give it.
        """
        try:
            return build_case(self.tables, changes or {}, self.source)
        except InputError as error:
            problems = [self._explained(problem) for problem in error.problems]
            raise InputError(problems, error.source) from None

    def lacking(self, given: Mapping[str, Any] = MappingProxyType({})) -> tuple[Lack, ...]:
        """What is missing but for the keys, or whole tables, that are `given`.

        Nothing of it is needed if there is a case without it: of a train whose losses are given.
        """
        left = tuple(
            lack for lack in self.missing if not any(_is_below(lack.key, key) for key in given)
        )
        if not any(lack.needed for lack in left):
            return left
        try:
            self.case(given)
        except InputError:
            return left
        return tuple(replace(lack, needed=False) for lack in left)

    def text(
        self,
        changes: Mapping[str, Any] | None = None,  # Keys to set.
    ) -> str:
        """The commented case file: the origin of every value, for other keys what is known."""
        tables, about = dict(self.tables), dict(self.origins)
        for lack in self.lacking(changes or {}):
            about[lack.key] = f"{'NEEDED. ' if lack.needed else ''}{lack}"
        if changes:
            tables = changed_tables(tables, changes)
            for key, value in changes.items():
                about = {name: told for name, told in about.items() if not _is_below(name, key)}
                about[key] = "Removed by the user." if value is None else "Set by the user."
        head = [
            f"Case of epicyclic, imported from {one_line(self.source, 200)}: {self.component}.",
            f"REXS {self.version}. Each value is shown with the attribute it comes from.",
            "Commented-out keys have the default shown or described, or are NEEDED.",
            *self.notes,
        ]
        return case_text(tables, [one_line(line, 400) for line in head], about)

    def remarks(self, changes: Mapping[str, Any], case: Case) -> list[str]:
        """What the file lacks for `case`, which was made with `changes`, and where it differs."""
        notes = (*self.notes, *self.geometry_notes(case))
        lacks = [f"{lack.key}: {lack}" for lack in self.lacking(changes)]
        return lacks + [f"Note: {note}" for note in notes]

    def geometry_notes(self, case: Case) -> tuple[str, ...]:
        """Figures of the file, such as base diameters, that differ from those of `case`."""
        return tuple(geometry_notes(case, self._chosen, self._model))

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
    """Read a gear set from a REXS file, or the train that its stages make.

    Parameters
    ----------
    path : str or Path
        A file ``.rexs``, ``.rexsj`` or ``.rexsz`` of version 1.0 to 2.0.
    component : int, optional
        Id of one ``planetary_stage`` or ``cylindrical_stage``. Without it, several stages are read
        as one train.
    load_case : int, optional
        Id of a load case of the load spectrum, whose values come before those of the components.

    Raises
    ------
    InputError
        If it is no such file, or if it has no such gear set.
    """
    source = str(path)
    document = read_document(Path(path))
    with problems_in(one_line(source, 500)):
        model = build_model(document.content)
        if load_case is not None:
            model = model.with_load_case(load_case)
        train = chosen_train(model) if component is None else None
        chosen = train or choose(model, component)
        draft = _draft(model, chosen)
    return RexsImport(
        source=source,
        version=model.version,
        kind=draft.tables["kind"],
        component=str(chosen if isinstance(chosen, Train) else chosen.component),
        tables=draft.tables,
        origins=draft.origins,
        missing=tuple(draft.lacks.values()),
        notes=tuple(draft.notes),
        _model=model,
        _chosen=chosen,
    )


def _draft(model: Model, chosen: SetParts | Train) -> Draft:
    draft = train_draft(model, chosen) if isinstance(chosen, Train) else _set_draft(model, chosen)
    if cases := model.known_load_cases:
        draft.notes.append(f"The file has load cases: {cases}. Choose one with --load-case.")
    raise_any([*draft.problems, *check_places(model)])
    return draft


def _set_draft(model: Model, chosen: SetParts) -> Draft:
    title = chosen.component.name.strip()
    kind = "gear_pair" if chosen.is_pair else "planetary"
    draft = Draft({"kind": kind, "title": one_line(title)})
    operation = pair_operation if chosen.is_pair else planetary_operation
    operation(draft, model, chosen)
    set_tables(draft, model, chosen)
    stages = [mesh.stage for mesh in chosen.meshes]
    temperature(draft, model, stages)
    lubricant_table(draft, model, stages)
    draft.notes += file_notes(chosen)
    return draft
