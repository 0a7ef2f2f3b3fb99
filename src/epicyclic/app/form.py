"""The form of a case: every key of its schema, with unit, range, default and description."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from epicyclic.case.case import KINDS
from epicyclic.case.fields import (
    Named,
    choices_of,
    describe,
    dict_value,
    entry_of,
    is_text,
    quantity_of,
    tables_in,
)
from epicyclic.case.template import toml_key, toml_value
from epicyclic.case.train import form_of_set
from epicyclic.case.train_tables import PlanetarySet
from epicyclic.case.values import parse_value
from epicyclic.units import Quantity, unit_text

_SHORT = 3
"""Tables of no more keys stand among those of the table that holds them."""
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

    key: str  # Dotted, as in ``--set``; its last part.
    name: str  # Dotted, as in ``--set``; its last part.
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


def has_form(tables: Mapping[str, Any]) -> bool:
    """False if something else stands where a table belongs: no field shows that."""
    return _is_table([KINDS[tables["kind"]]], tables)


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
    for own, field in table.model_fields.items():
        if own in ("kind", _MEMBERS):
            continue
        full = f"{key}.{own}" if key else own
        value = given.get(own)
        inner = _inner(full, own, field, value)
        if inner is None:
            entries.append(_entry(full, own, field, value))
        elif key and not inner.groups and not inner.kinds and len(inner.entries) <= _SHORT:
            entries += [_renamed(entry, full, own) for entry in inner.entries]
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
    about = "The gears, and what they share." if shared else "The gears."
    return [replace(named, about=about, entries=shared.entries if shared else ()), *others]


def _renamed(entry: Entry, key: str, name: str) -> Entry:
    return replace(entry, name=f"{name}{entry.key.removeprefix(key)}")


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
    tables = {
        _GEARS if name == _MEMBERS else name: {} if _has_tables(table, name) else ""
        for name in needed
    }
    return Kind(about, tables)


def _first_line(table: type[BaseModel]) -> str:
    """What a table holds, without the marks of the manual."""
    return (table.__doc__ or "").strip().partition("\n")[0].replace("`", "")


def _has_tables(table: type[BaseModel], name: str) -> bool:
    return next(tables_in(table.model_fields[name].annotation), None) is not None


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
