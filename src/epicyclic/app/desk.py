"""A case that is being edited: where it came from, what has been changed, what is wrong with it."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from epicyclic import library
from epicyclic.app.form import Group, form_of, has_form
from epicyclic.case.base import FILE_KEYS
from epicyclic.case.case import KINDS, Case, build_case, changed_tables
from epicyclic.case.plain import value_at
from epicyclic.case.reading import read_file
from epicyclic.case.template import case_text, toml_key, toml_value
from epicyclic.case.train_text import train_text
from epicyclic.case.wording import dotted, key_parts, written
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.exchange.load import load_case
from epicyclic.exchange.rexs.file import is_rexs

ENDINGS = (".toml", ".rexs", ".rexsj", ".rexsz")
"""Endings of files that hold a case."""
_HEAD = "A case file of epicyclic, saved by its app. Keys behind a # have defaults."


@dataclass
class Desk:
    """One case and its changes."""

    source: str  # File or built-in case, as a command names it.
    tables: Mapping[str, Any]  # What the source holds.
    build: Callable[[dict[str, Any]], Case]  # Makes the case of the source with changed keys.
    original: str | None = None  # The REXS file it came from.
    # Changes of dotted keys, as ``--set`` has them; None for keys that are removed.
    changes: dict[str, Any] = field(default_factory=dict)
    case: Case | None = None  # None if it is not sound.
    problems: tuple[Problem, ...] = ()  # What is wrong with it.

    def __post_init__(self) -> None:
        self._check()

    @property
    def title(self) -> str:
        """Title of the case, or its source."""
        return str(self.current.get("title") or self.source)

    @property
    def current(self) -> dict[str, Any]:
        """The tables with the changes, sound or not."""
        return changed_tables(self.tables, self.changes)

    def copy(self) -> Desk:
        """Another desk of the same case with the same changes."""
        return Desk(self.source, self.tables, self.build, self.original, dict(self.changes))

    def form(self) -> Group:
        """The form as it is now."""
        return form_of(self.current)

    def change(self, key: str, value: Any) -> None:
        """Set a key, or remove it if `value` is None; see `problems` then."""
        changes = {name: was for name, was in self.changes.items() if name != key}
        changed = {**changes, key: value}
        if changed_tables(self.tables, changes) != changed_tables(self.tables, changed):
            changes = changed
        self.changes = changes
        self._check()

    def add(self, table: str, name: str, value: Any) -> str:
        """Add a name of the user to a table of names; what is wrong with the name, or nothing."""
        name = name.strip()
        if told := self._refused(table, name):
            return told
        self.change(f"{table}.{toml_key(name)}", value)
        return ""

    def remove(self, key: str) -> None:
        """Remove a name or a table with all that it holds."""
        inside = f"{key}."
        self.changes = {
            name: value for name, value in self.changes.items() if not name.startswith(inside)
        }
        self.change(key, None)

    def rename(self, key: str, name: str) -> str:
        """Give what a name of the user stands for another name; what is wrong with it, or nothing.

        What names it elsewhere keeps the old name, as in a case file.
        """
        name = name.strip()
        table = owner_of(key)
        if name == key_parts(key)[-1]:
            return ""
        if told := self._refused(table, name):
            return told
        value = value_at(self.current, key_parts(key))
        self.remove(key)
        self.change(f"{table}.{toml_key(name)}", value)
        return ""

    def _refused(self, table: str, name: str) -> str:
        """Why a table of names cannot take a new name."""
        if not name:
            return "A name is missing. Give one."
        if set(name) & set('"\\') or not name.isprintable():
            return "Names have no quotation marks, backslashes or control characters."
        if value_at(self.current, [*key_parts(table), name]) is not None:
            return f"{table} has {name} already. Choose another name."
        return ""

    def _check(self) -> None:
        typed = list(_elsewhere(self.changes))
        if typed:  # before anything looks for the file
            self.case, self.problems = None, tuple(typed)
            return
        try:
            self.case, self.problems = self.build(self.changes), ()
        except InputError as error:
            self.case, self.problems = None, error.problems

    def problems_of(self, key: str) -> list[Problem]:
        """Those that name a key of the form."""
        return [problem for problem in self.problems if key in problem.key.split(", ")]

    def command(self, verb: str = "run", *arguments: str) -> str:
        """The command that does the same."""
        words = ["epicyclic", verb, self.source]
        for key, value in self.changes.items():
            words += ["--set", f"{key}={_text(value)}"]
        return shlex.join([*words, *arguments])

    def text(self) -> str:
        """The case file of the case as it is now."""
        write = train_text if self.tables["kind"] == "train" else case_text
        return write(self.current, [_HEAD], {})


def owner_of(key: str) -> str:
    """The table that holds a key."""
    return ".".join(map(toml_key, key_parts(key)[:-1]))


def _text(value: Any) -> str:
    """A value as ``--set`` reads it."""
    if value is None:
        return ""
    return value if isinstance(value, str) else toml_value(value)


def _elsewhere(tables: Any, path: tuple[str, ...] = ()) -> Iterator[Problem]:
    """Keys that name files elsewhere than beside the case: pages do not open those."""
    if isinstance(tables, Mapping):
        for name, value in tables.items():
            yield from _elsewhere(value, (*path, *key_parts(name)))
    elif isinstance(tables, list | tuple):
        for item in tables:
            yield from _elsewhere(item, path)
    elif path and path[-1] in FILE_KEYS and not _is_name(tables):
        allowed = "must be the name of a file beside the case: the app opens no others."
        remedy = "Upload the file together with the case, and give its name."
        yield Problem(dotted(path), written(tables), allowed, remedy)


def _is_name(value: object) -> bool:
    """True for what cannot lead to another folder; what is no text is refused later."""
    text = value if isinstance(value, str) else ""
    return text not in (".", "..") and not set(text) & set("/\\:\0")


def opened(
    path: str,  # File or name.
    shown: str = "",  # How commands name it, if not by `path`.
) -> Desk:
    """The desk of a case: a file, or a built-in one.

    A case with problems is opened, if it is known what kind it is and a form can show it.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    if is_rexs(path):
        from epicyclic.exchange.rexs.importing import read_rexs

        found = read_rexs(path)
        return Desk(shown or path, found.tables, found.case, path)
    if Path(path).suffix.lower() == ".toml":
        tables, problems = read_file(Path(path))
        is_known = not problems and tables.get("kind") in tuple(KINDS)
        if is_known and has_form(tables):
            return Desk(shown or path, tables, lambda changes: build_case(tables, changes, path))
    case = load_case(path)
    return Desk(shown or path, case.given(), case.updated)


def received(
    # Names and contents: the file with the case, and those that it names.
    files: Iterable[tuple[str, bytes]],
    folder: Path,  # Folder of the app, empty.
) -> Desk:
    """The desk of an uploaded case.

    Raises
    ------
    InputError
        If two have the same name, not one of them is a case, it names files elsewhere, or they
        cannot be kept.
    """
    contents = [(Path(name).name, content) for name, content in files]
    counts = Counter(name.casefold() for name, _ in contents)  # as some systems compare names
    problems = [
        Problem(
            "file", written(name), f"is the name of {count} files.", "Rename all but one of them."
        )
        for name, count in counts.items()
        if count > 1
    ]
    raise_any(problems, "the upload")
    for name, content in contents:
        _keep(folder, name, content)
    cases = [name for name, _ in contents if Path(name).suffix.lower() in ENDINGS]
    if len(cases) != 1:
        allowed = f"One of the files must be a case, {', '.join(ENDINGS)}."
        raise InputError([Problem("", "", allowed, "")], "the upload")
    desk = opened(str(folder / cases[0]), cases[0])
    raise_any(_elsewhere(desk.tables), desk.source)
    return desk


def _keep(folder: Path, name: str, content: bytes) -> None:
    """Write an uploaded file under its name."""
    told = "is no name of a file" if name in ("", "..") or not name.isprintable() else ""
    try:
        if not told:
            (folder / name).write_bytes(content)
    except OSError as error:
        told = f"cannot be kept: {error.strerror}"
    if told:
        raise InputError([Problem("file", written(name), f"{told}.", "Rename it.")], "the upload")


def built_in(name: str) -> Desk:
    """The desk of a built-in case, and of nothing else."""
    if name not in library.case_files():
        raise InputError([Problem("CASE", name, "is no built-in case.", "Choose one.")])
    return opened(name)
