"""A case that is being edited: where it came from, what has been changed, what is wrong with it."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from epicyclic.app.form import Group, form_of
from epicyclic.case.case import Case, changed_tables
from epicyclic.case.template import toml_value
from epicyclic.errors import InputError, Problem
from epicyclic.exchange.load import load_case
from epicyclic.exchange.rexs.file import is_rexs

__all__ = ["Desk", "opened"]


@dataclass
class Desk:
    """One case and its changes.

    Attributes
    ----------
    source : str
        File or built-in case, as a command names it.
    tables : mapping
        What the source holds.
    build : callable
        Makes the case of the source with changed keys.
    changes : dict
        Of dotted keys, as ``--set`` has them; None for keys that are removed.
    case : Case or None
        None if it is not sound.
    problems : tuple of Problem
        What is wrong with it.
    """

    source: str
    tables: Mapping[str, Any]
    build: Callable[[dict[str, Any]], Case]
    changes: dict[str, Any] = field(default_factory=dict)
    case: Case | None = None
    problems: tuple[Problem, ...] = ()

    def __post_init__(self) -> None:
        self._check()

    @property
    def title(self) -> str:
        """Of the case, or its source."""
        return str(self.current.get("title") or self.source)

    @property
    def current(self) -> dict[str, Any]:
        """The tables with the changes, sound or not."""
        return changed_tables(self.tables, self.changes)

    def form(self) -> Group:
        """The form as it is now."""
        return form_of(self.current)

    def change(self, key: str, value: Any) -> None:
        """Set a key, or remove it if `value` is None; see `problems` then."""
        changes = {name: was for name, was in self.changes.items() if name != key}
        if changed_tables(self.tables, changes) != changed_tables(
            self.tables, {**changes, key: value}
        ):
            changes[key] = value
        self.changes = changes
        self._check()

    def _check(self) -> None:
        try:
            self.case, self.problems = self.build(self.changes), ()
        except InputError as error:
            self.case, self.problems = None, error.problems

    def problems_of(self, key: str) -> list[Problem]:
        """Those that name a key of the form."""
        return [problem for problem in self.problems if key in problem.key.split(", ")]

    def command(self, verb: str = "run", *arguments: str) -> str:
        """The command that does the same."""
        words = ["epicyclic", verb, self.source, *arguments]
        for key, value in self.changes.items():
            words += ["--set", f"{key}={_text(value)}"]
        return shlex.join(words)


def _text(value: Any) -> str:
    """A value as ``--set`` reads it."""
    if value is None:
        return ""
    return value if isinstance(value, str) else toml_value(value)


def opened(path: str, shown: str = "") -> Desk:
    """The desk of a case: a file, or a built-in one.

    Parameters
    ----------
    path : str
        File or name.
    shown : str
        How commands name it, if not by `path`.

    Raises
    ------
    InputError
        If it is no case, or not a sound one; a REXS file may lack keys.
    """
    if is_rexs(path):
        from epicyclic.exchange.rexs.importing import read_rexs

        found = read_rexs(path)
        return Desk(shown or path, found.tables, found.case)
    case = load_case(path)
    return Desk(shown or path, case.given(), lambda changes: case.updated(changes))
