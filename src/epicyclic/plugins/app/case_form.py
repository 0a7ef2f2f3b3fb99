"""A case that is being edited: its form, its state, and what each browser tab has of its own."""

from __future__ import annotations

import math
import shlex
import shutil
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from epicyclic import library
from epicyclic.case.case import FILE_KEYS, KINDS, Case, build_case, changed_tables
from epicyclic.case.train_tables import PlanetarySet, form_of_set
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import InputError, Problem, one_problem, raise_any
from epicyclic.messages import dotted, key_parts, value_at, written
from epicyclic.plugins.app.worker import Worker
from epicyclic.plugins.rexs.files import is_rexs
from epicyclic.schema.fields import (
    Named,
    choices_of,
    describe,
    dict_value,
    entry_of,
    is_text,
    quantity_of,
    tables_in,
)
from epicyclic.schema.read import parse_value, read_file
from epicyclic.show.template import case_text, toml_key, toml_value
from epicyclic.study.load import load_case
from epicyclic.units import Quantity, unit_text

# The form of a case: every key of its schema, with unit, range, default and description.


_SHORT = 3  # Tables of no more keys stand among those of the table that holds them.
_YES_NO = ("true", "false")
_MEMBERS, _GEARS = "members", "gears"
"""Table of the gears of a listed set in the schema, and in a file."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One key of a case."""

    key: str  # Dotted, as in ``--set``.
    name: str  # What is left of the key within its group.
    about: str  # Description, and what is allowed.
    unit: str  # In which numbers are shown and typed; empty for keys without one.
    choices: tuple[str, ...]  # All that the key may hold; empty if that is not a list.
    suggestions: tuple[str, ...]  # Names that stand for tables of values, such as those of oils.
    text: str  # What is given, without its unit; empty if nothing is.
    default: str  # What holds if nothing is given.
    is_required: bool  # True if something must be given.
    quantity: Quantity | None  # Quantity of keys with a unit.
    is_text: bool  # True if what is typed is not read as a number or a list.
    is_own: bool = False  # True if the user chose the name.

    def shown(self, text: str) -> str:
        """What was typed in the unit of the field, if it is a value in another one."""
        return _shown(text, self.quantity)

    def value(self, text: str) -> Any:
        """What a case file has for what was typed; None for nothing."""
        text = text.strip()
        if not text:
            return None
        if self.quantity is not None:
            with suppress(ValueError):
                float(text)
                return f"{text} {self.quantity.display}"
            return parse_value(text) if text.startswith("[") else text
        return text if self.is_text or self.suggestions else parse_value(text)


@dataclass(frozen=True, slots=True)
class Kind:
    """What a new name may stand for."""

    about: str  # First line of its description.
    # What the name holds at first; None if it is a value, not a table.
    tables: dict[str, Any] | None


@dataclass(frozen=True, slots=True)
class Group:
    """One table of a case: its keys, and the tables in it."""

    key: str  # Dotted, as in ``--set``.
    name: str  # Its last part.
    about: str
    entries: tuple[Entry, ...]
    groups: tuple[Group, ...]
    is_given: bool
    is_own: bool = False  # True if the user chose the name.
    is_optional: bool = False  # True if a case may do without the table.
    # What new names in it may stand for; empty if it has none of the user.
    kinds: tuple[Kind, ...] = ()
    sample: Entry | None = None  # How values of new names are read, if they are no tables.

    def walk(self) -> Iterator[Entry]:
        """All entries, also of the groups within."""
        yield from self.entries
        for group in self.groups:
            yield from group.walk()

    def find(self, key: str) -> Group | None:
        """The group of a key, here or within."""
        if self.key == key:
            return self
        return next(filter(None, (group.find(key) for group in self.groups)), None)


def form_of(
    tables: Mapping[str, Any],  # As a case file has them, with the kind.
) -> Group:
    """The form of the tables of a case, whether they are sound or not."""
    return _group(KINDS[tables["kind"]], "", "", tables)


def _is_table(tables: list[type[BaseModel]], given: Any) -> bool:
    """True for a table that has tables where its schema, one of several, has them."""
    return isinstance(given, Mapping) and all(
        _has_place(field, given[own])
        for own, field in _likeliest(tables, given).model_fields.items()
        if own != _MEMBERS and given.get(own) is not None
    )


def _has_place(field: FieldInfo, value: Any) -> bool:
    """True for a value that the form has a place for, right or wrong."""
    of_names = dict_value(field.annotation)
    inner = field.annotation if of_names is None else of_names
    tables = [] if entry_of(inner) is not None else list(tables_in(inner))
    if of_names is not None:
        return isinstance(value, Mapping) and all(
            not tables or _is_table(tables, item) for item in value.values()
        )
    is_name = isinstance(value, str) and bool(_presets(field))
    return not tables or is_name or _is_table(tables, value)


def _group(table: type[BaseModel], key: str, name: str, given: Mapping[str, Any]) -> Group:
    entries: list[Entry] = []
    groups: list[Group] = []
    for own, info in table.model_fields.items():
        if own in ("kind", _MEMBERS):
            continue
        full = f"{key}.{own}" if key else own
        value = given.get(own)
        inner = _inner(full, own, info, value)
        if inner is None:
            entries.append(_entry(full, own, info, value))
        elif key and not inner.groups and not inner.kinds and len(inner.entries) <= _SHORT:
            entries += [
                replace(it, name=f"{own}{it.key.removeprefix(full)}") for it in inner.entries
            ]
        else:
            groups.append(inner)
    if _MEMBERS in table.model_fields:
        groups = _with_members(table, f"{key}.{_GEARS}", given, groups)
    about = _first_line(table)
    return Group(key, name, about, tuple(entries), tuple(groups), bool(given))


def _with_members(
    table: type[BaseModel], key: str, given: Mapping[str, Any], groups: list[Group]
) -> list[Group]:
    """Groups of a listed set; a file has its gears beside what they share."""
    shared = next((group for group in groups if group.key == key), None)
    others = [group for group in groups if group is not shared]
    gears = given.get(_GEARS)
    listed = {
        name: gear
        for name, gear in (gears if isinstance(gears, Mapping) else {}).items()
        if isinstance(gear, Mapping)
    }
    named = _names(key, _GEARS, table.model_fields[_MEMBERS], listed)
    about = "The gears and their common properties." if shared else "The gears."
    return [replace(named, about=about, entries=shared.entries if shared else ()), *others]


def _inner(key: str, name: str, field: FieldInfo, value: Any) -> Group | None:
    """The group of a key that holds a table, or several by name; None of others."""
    if dict_value(field.annotation) is not None:
        return _names(key, name, field, value if isinstance(value, Mapping) else {})
    tables = list(tables_in(field.annotation))
    is_array = entry_of(field.annotation) is not None
    if not tables or is_array or isinstance(value, str | tuple | list):
        return None
    if value is None and _presets(field) != ():
        return None
    group = _group(_likeliest(tables, value or {}), key, name, value or {})
    return replace(group, is_optional=not field.is_required() and field.default is None)


def _names(key: str, name: str, field: FieldInfo, given: Mapping[str, Any]) -> Group:
    """The group of a table of the user's names."""
    value = dict_value(field.annotation)
    tables = list(tables_in(value))
    about = field.description or ""
    if not tables or entry_of(value) is not None:
        field_of_value = FieldInfo.from_annotation(value)
        entries = tuple(
            replace(_entry(f"{key}.{toml_key(own)}", own, field_of_value, item), is_own=True)
            for own, item in given.items()
        )
        sample = _entry(key, name, field_of_value, None)
        kind = Kind(sample.about, None)
        return Group(key, name, about, entries, (), bool(given), kinds=(kind,), sample=sample)
    groups = tuple(
        replace(_group(_likeliest(tables, item), f"{key}.{toml_key(own)}", own, item), is_own=True)
        for own, item in given.items()
        if isinstance(item, Mapping)
    )
    kinds = tuple(_kind(table, is_one=len(tables) == 1) for table in tables)
    return Group(key, name, about, (), groups, bool(given), kinds=kinds)


def _kind(table: type[BaseModel], *, is_one: bool) -> Kind:
    """What a table holds at first: what tells it from others."""
    about = _first_line(table)
    if is_one:
        return Kind(about, {})
    needed = [name for name, field in table.model_fields.items() if field.is_required()]
    needed += [group[0] for group in getattr(table, "EXACTLY_ONE", ())]
    tables: dict[str, Any] = {}
    for own in needed:
        holds_tables = any(tables_in(table.model_fields[own].annotation))
        tables[_GEARS if own == _MEMBERS else own] = {} if holds_tables else ""
    return Kind(about, tables)


def _first_line(table: type[BaseModel]) -> str:
    """What a table holds, without the marks of the manual."""
    return (table.__doc__ or "").strip().partition("\n")[0].replace("`", "")


def _likeliest(tables: list[type[BaseModel]], given: Mapping[str, Any]) -> type[BaseModel]:
    """The table that knows most of the keys; of a set, the form in which it is read."""
    found = form_of_set(dict(given))[0] if PlanetarySet in tables else None
    return found or max(tables, key=lambda table: len(given.keys() & table.model_fields.keys()))


def _presets(field: FieldInfo) -> tuple[str, ...]:
    """Names that stand for whole tables."""
    return next((item.names() for item in field.metadata if isinstance(item, Named)), ())


def _entry(key: str, name: str, field: FieldInfo, value: Any) -> Entry:
    metadata = tuple(field.metadata)
    quantity = quantity_of(field.annotation, metadata)
    choices = choices_of(field.annotation)
    allowed = describe(field.annotation, metadata)
    if allowed == "true or false":
        choices = _YES_NO
    default = None if field.is_required() else field.default
    told = (
        f"{field.description} {allowed[:1].upper()}{allowed[1:]}." if field.description else allowed
    )
    return Entry(
        key=key,
        name=name,
        about=told,
        unit=unit_text(quantity.display) if quantity is not None else "",
        choices=choices,
        suggestions=_presets(field),
        text=_shown(value, quantity),
        default="required" if field.is_required() else _shown(default, quantity),
        is_required=field.is_required(),
        quantity=quantity,
        is_text=is_text(field.annotation) or bool(choices and choices != _YES_NO),
    )


def _shown(value: Any, quantity: Quantity | None) -> str:
    """A value as the form shows it: numbers in the unit of the key, without it."""
    if value is None or isinstance(value, BaseModel):
        return ""
    if quantity is not None and isinstance(value, str):
        with suppress(ValueError):
            si = quantity.parse(value)
            number = value.strip().removesuffix(quantity.display).strip()
            with suppress(ValueError):
                float(number)
                return number
            return quantity.exact_text(si).removesuffix(quantity.display).strip()
    if quantity is not None and isinstance(value, float):
        return quantity.exact_text(value).removesuffix(quantity.display).strip()
    return value if isinstance(value, str) else toml_value(value)


def number_in(text: str) -> float | None:
    """The number that a field shows; None for other text, and for one that cannot be doubled."""
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(2 * number) else None


ENDINGS = (".toml", ".rexs", ".rexsj", ".rexsz")  # Endings of files that hold a case.
_HEAD = "A case file of epicyclic, saved by its app. Commented-out keys have defaults."


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
        return self.add(table, name, value)

    def _refused(self, table: str, name: str) -> str:
        """Why a table of names cannot take a new name."""
        if not name:
            return "A name is missing. Give one."
        if set(name) & set('"\\') or not name.isprintable():
            return "Names have no quotation marks, backslashes or control characters."
        if value_at(self.current, [*key_parts(table), name]) is not None:
            return f"{table} already has {name}. Choose another name."
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
            words += ["--set", f"{key}={_shown(value, None)}"]
        return shlex.join([*words, *arguments])

    def text(self) -> str:
        """The case file of the case as it is now."""
        return case_text(self.current, [_HEAD], {})


def owner_of(key: str) -> str:
    """The table that holds a key."""
    return ".".join(map(toml_key, key_parts(key)[:-1]))


def _elsewhere(
    tables: Any,
    may_be: Callable[[object], bool] | None = None,  # Default: names without a folder.
    path: tuple[str, ...] = (),
) -> Iterator[Problem]:
    """Keys that name files elsewhere than beside the case: pages do not open those."""
    if isinstance(tables, Mapping):
        for name, value in tables.items():
            yield from _elsewhere(value, may_be, (*path, *key_parts(name)))
    elif isinstance(tables, list | tuple):
        for item in tables:
            yield from _elsewhere(item, may_be, path)
    elif path and path[-1] in FILE_KEYS and not (may_be or _is_name)(tables):
        allowed = "must be the name of a file beside the case, because the app opens no others."
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

    A case with problems is opened, if it is known what kind it is and a form can show it. Raises
    `InputError` if it cannot be read.
    """
    if is_rexs(path):
        from epicyclic.plugins.rexs.importing import read_rexs

        found = read_rexs(path)
        return Desk(shown or path, found.tables, found.case, path)
    if Path(path).suffix.lower() == ".toml":
        tables, problems = read_file(Path(path))
        is_known = not problems and tables.get("kind") in tuple(KINDS)
        # what else stands where a table belongs is shown by no field
        if is_known and _is_table([KINDS[tables["kind"]]], tables):
            return Desk(shown or path, tables, lambda changes: build_case(tables, changes, path))
    case = load_case(path)
    return Desk(shown or path, case.given(), case.updated)


def received(
    # Names and contents: the file with the case, and those that it names.
    files: Iterable[tuple[str, bytes]],
    folder: Path,  # Folder of the app, empty.
) -> Desk:
    """The desk of an uploaded case.

    Raises `InputError` if two have the same name, not one of them is a case, it names files
    elsewhere, or they cannot be kept.
    """
    contents = [(Path(name).name, content) for name, content in files]
    counts = Counter(name.casefold() for name, _ in contents)  # as some systems compare names
    remedy = "Rename all but one of them."
    problems = [
        Problem("file", written(name), f"is the name of {count} files.", remedy)
        for name, count in counts.items()
        if count > 1
    ]
    raise_any(problems, "the upload")
    for name, content in contents:
        _keep(folder, name, content)
    cases = [name for name, _ in contents if Path(name).suffix.lower() in ENDINGS]
    if len(cases) != 1:
        allowed = f"One of the files must be a case, {', '.join(ENDINGS)}."
        raise one_problem("", "", allowed, "", "the upload")
    desk = opened(str(folder / cases[0]), cases[0])
    raise_any(_elsewhere(desk.tables), desk.source)
    return desk


def received_task(name: str, content: bytes, folder: Path) -> Path:
    """An uploaded task of designs, or its dataset; `InputError` if it names files."""
    path = folder / Path(name).name
    _keep(folder, path.name, content)
    if path.suffix.lower() == ".toml":
        tables, problems = read_file(path)
        told = "names a file, which the app does not open for a search."
        named = [
            Problem(it.key, it.value, told, "Search with 'epicyclic design'.")
            for it in _elsewhere(tables, lambda file: False)
        ]
        raise_any([*problems, *named], path.name)
    return path


def _keep(folder: Path, name: str, content: bytes) -> None:
    """Write an uploaded file under its name."""
    told = "is not a valid file name" if name in ("", "..") or not name.isprintable() else ""
    try:
        if not told:
            (folder / name).write_bytes(content)
    except OSError as error:
        told = f"cannot be kept: {error.strerror}"
    if told:
        raise one_problem("file", written(name), f"{told}.", "Rename it.", "the upload")


def built_in(name: str) -> Desk:
    """The desk of a built-in case, and of nothing else."""
    if name not in library.names("cases"):
        raise one_problem("CASE", name, "is not a built-in case.", "Choose one.")
    return opened(name)


# What each tab of a browser has of its own: a case, and processes that work for it.


MOST_TABS = 8  # That are open at a time: each has up to three processes of some 300 MB.
MOST_KEPT = 50
"""Cases of tabs that are open or were, so that a tab that comes back finds its changes."""
BEHIND = 5  # Niceness of what may take longer than key figures.


@dataclass
class Shelf:
    """What is kept for one tab while its page is loaded again."""

    desk: Desk  # The case that is open.
    folder: Path  # For uploaded files.
    chapter: str = ""  # That is open.
    # Follows every value of an input; draws what takes longer; computes maps.
    quick: Worker = field(default_factory=Worker)
    slow: Worker = field(default_factory=lambda: Worker(BEHIND))
    maps: Worker = field(default_factory=lambda: Worker(BEHIND))

    @property
    def workers(self) -> Iterator[Worker]:
        """All of them."""
        yield from (self.quick, self.slow, self.maps)

    def close(self) -> None:
        """End all work."""
        for worker in self.workers:
            worker.close()


class Shelves:
    """The shelves of all tabs, which begin with `desk`; at most so many are open at a time."""

    def __init__(self, desk: Desk, folder: Path, most: int = MOST_TABS) -> None:
        self._desk, self._folder, self.most = desk, folder, most
        self._kept: dict[str, Shelf] = {}
        self._pages: dict[str, str] = {}

    def take(
        self,
        # tab, page: What the tab and its present page are called; a page that is loaded again is
        # another.
        tab: str,
        page: str,
        before: str = "",  # The tab that this one was duplicated from.
    ) -> Shelf | None:
        """The shelf of a tab; None if too many are open."""
        is_open = tab in self._pages
        if not is_open and len(self._pages) >= self.most:
            return None
        shelf = self._kept.pop(tab, None)
        if shelf is None:
            origin = self._kept[before].desk if before in self._kept else self._desk
            shelf = Shelf(origin.copy(), Path(tempfile.mkdtemp(dir=self._folder)))
        elif not is_open:
            shelf = Shelf(shelf.desk, shelf.folder, shelf.chapter)
        self._kept[tab] = shelf
        self._pages[tab] = page
        closed = [own for own in self._kept if own not in self._pages]
        for own in closed[: max(0, len(self._kept) - MOST_KEPT)]:  # those closed longest ago
            shutil.rmtree(self._kept.pop(own).folder, ignore_errors=True)
        return shelf

    def leave(self, tab: str, page: str) -> None:
        """End the work for a tab, if it shows that page still."""
        if self._pages.get(tab) == page:
            del self._pages[tab]
            self._kept[tab].close()

    def close(self) -> None:
        """End all work."""
        for shelf in self._kept.values():
            shelf.close()
