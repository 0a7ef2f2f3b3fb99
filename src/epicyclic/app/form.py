"""The form of a case: every key of its schema, with unit, range, default and description."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from epicyclic.case.case import GearPairCase, PlanetaryCase, TrainCase
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
from epicyclic.case.values import parse_value
from epicyclic.units import Quantity, unit_text

__all__ = ["Entry", "Group", "form_of"]

_KINDS: dict[str, type[BaseModel]] = {
    "planetary": PlanetaryCase,
    "gear_pair": GearPairCase,
    "train": TrainCase,
}
_SHORT = 3
"""Tables of no more keys stand among those of the table that holds them."""
_YES_NO = ("true", "false")


@dataclass(frozen=True, slots=True)
class Entry:
    """One key of a case.

    Attributes
    ----------
    key : str
        Dotted, as in ``--set``.
    name : str
        What is left of the key within its group.
    about : str
        Description, and what is allowed.
    unit : str
        In which numbers are shown and typed; empty for keys without one.
    choices : tuple of str
        All that the key may hold; empty if that is not a list.
    suggestions : tuple of str
        Names that stand for tables of values, such as those of oils.
    text : str
        What is given, without its unit; empty if nothing is.
    default : str
        What holds if nothing is given.
    is_required : bool
        True if something must be given.
    quantity : Quantity or None
        Of keys with a unit.
    is_text : bool
        True if what is typed is not read as a number or a list.
    """

    key: str
    name: str
    about: str
    unit: str
    choices: tuple[str, ...]
    suggestions: tuple[str, ...]
    text: str
    default: str
    is_required: bool
    quantity: Quantity | None
    is_text: bool

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
class Group:
    """One table of a case: its keys, and the tables in it."""

    key: str
    about: str
    entries: tuple[Entry, ...]
    groups: tuple[Group, ...]
    is_given: bool

    def walk(self) -> Iterator[Entry]:
        """All entries, also of the groups within."""
        yield from self.entries
        for group in self.groups:
            yield from group.walk()


def form_of(tables: Mapping[str, Any]) -> Group:
    """The form of the tables of a case, whether they are sound or not.

    Parameters
    ----------
    tables : mapping
        As a case file has them, with the kind.
    """
    return _group(_KINDS[tables["kind"]], "", tables)


def _group(table: type[BaseModel], key: str, given: Mapping[str, Any]) -> Group:
    entries: list[Entry] = []
    groups: list[Group] = []
    for name, field in table.model_fields.items():
        if name == "kind":
            continue
        full = f"{key}.{name}" if key else name
        value = given.get(name)
        inner = _inner(full, field, value)
        if inner is None:
            entries.append(_entry(full, name, field, value))
        elif key and not inner.groups and len(inner.entries) <= _SHORT:
            entries += [_renamed(entry, full, name) for entry in inner.entries]
        else:
            groups.append(inner)
    about = (table.__doc__ or "").strip().partition("\n")[0]
    return Group(key, about, tuple(entries), tuple(groups), bool(given))


def _renamed(entry: Entry, key: str, name: str) -> Entry:
    return replace(entry, name=f"{name}{entry.key.removeprefix(key)}")


def _inner(key: str, field: FieldInfo, value: Any) -> Group | None:
    """The group of a key that holds a table, or several by name; None of others."""
    named = dict_value(field.annotation)
    tables = list(tables_in(field.annotation if named is None else named))
    is_array = entry_of(field.annotation) is not None or entry_of(named) is not None
    if not tables or is_array or isinstance(value, str | tuple | list):
        return None
    if named is None:
        is_preset = value is None and _names(field) != ()
        return None if is_preset else _group(_likeliest(tables, value or {}), key, value or {})
    groups = tuple(
        _group(_likeliest(tables, item), f"{key}.{toml_key(name)}", item)
        for name, item in (value or {}).items()
        if isinstance(item, Mapping)
    )
    return Group(key, field.description or "", (), groups, bool(value))


def _likeliest(tables: list[type[BaseModel]], given: Mapping[str, Any]) -> type[BaseModel]:
    """The table that knows most of the keys."""
    return max(tables, key=lambda table: len(given.keys() & table.model_fields.keys()))


def _names(field: FieldInfo) -> tuple[str, ...]:
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
        suggestions=_names(field),
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
