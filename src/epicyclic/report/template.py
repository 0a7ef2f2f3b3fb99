"""A commented case file, written from the schema and a built-in case."""

from __future__ import annotations

import json
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from epicyclic import library
from epicyclic.case.case import GearPairCase, PlanetaryCase
from epicyclic.case.fields import choices_of, entry_of, quantity_of, table_of

__all__ = ["case_template"]

_EXAMPLES: dict[str, tuple[str, type[BaseModel]]] = {
    "planetary": ("talbot-2012", PlanetaryCase),
    "gear_pair": ("talbot-2012-pair", GearPairCase),
}
COMMENT_COLUMN = 44
_SPELT_OUT = ("micro_geometry", "micro_geometry_ring_side", "topography")
"""Tables within a table whose keys are listed."""


def case_template(kind: str) -> str:
    """A case file of `kind` with every key: given ones with values, defaults commented out."""
    name, schema = _EXAMPLES[kind]
    example = library.builtin_case(name)
    lines = [
        f"# A case file of epicyclic, kind {kind}, filled in with the built-in case {name}.",
        "# Every dimensional value carries its unit. Keys behind a # have defaults.",
        f'kind = "{kind}"',
        f"title = {_toml(example['title'])}",
    ]
    for key, field in schema.model_fields.items():
        table = table_of(field.annotation)
        if table is not None:
            lines += _table_lines(key, table, example.get(key, {}), field)
    return "\n".join(lines) + "\n"


def _table_lines(
    key: str, table: type[BaseModel], values: dict[str, Any], field: FieldInfo
) -> list[str]:
    about = (table.__doc__ or "").strip().splitlines()[0]
    mark = "" if values or field.is_required() else "# "
    lines = ["", f"{mark}[{key}]".ljust(COMMENT_COLUMN) + f"# {about}"]
    for name, inner in table.model_fields.items():
        lines += _field_lines(key, name, inner, values)
    return lines


def _field_lines(
    key: str, name: str, field: FieldInfo, values: dict[str, Any], prefix: str = ""
) -> list[str]:
    """Lines of one key of table `key`; a table within it appears as dotted keys."""
    subtable = table_of(field.annotation)
    if name in values:
        return [_line(f"{prefix}{name} = {_toml(values[name])}", _about(field))]
    if subtable is None:
        return [_line(f"# {prefix}{name} = {_default(field)}", _about(field))]
    if key == "losses":
        return [_line(f"# {name} = {{ include = true, factor = 1.0 }}", "")]
    if isinstance(field.default, str):
        return [_line(f"# {name} = {_toml(field.default)}", _about(field))]
    if field.default is None and name not in _SPELT_OUT:
        return [_line(f"# {prefix}{name} = {{ ... }}", _about(field))]
    return [
        line
        for inner, below in subtable.model_fields.items()
        for line in _field_lines(key, inner, below, {}, f"{prefix}{name}.")
    ]


def _line(text: str, about: str) -> str:
    return f"{text.ljust(COMMENT_COLUMN - 1)} # {about}" if about else text


def _about(field: FieldInfo) -> str:
    choices = " | ".join(choices_of(field.annotation))
    quantity = quantity_of(field.annotation, tuple(field.metadata))
    parts = [field.description or "", choices]
    if not field.description and quantity is not None:
        parts.append(quantity.describe())
    return " ".join(part for part in parts if part)


def _default(field: FieldInfo) -> str:
    if field.default is not None and not field.is_required():
        return _toml(field.default)
    quantity = quantity_of(field.annotation, tuple(field.metadata))
    value = f'"... {quantity.display}"' if quantity is not None else "..."
    return _nested(field.annotation, value)


def _nested(annotation: Any, value: str) -> str:
    """`value` as the entry of an array, or of an array of arrays, if the key holds one."""
    entry = entry_of(annotation)
    return value if entry is None else f"[{_nested(entry, value)}, ...]"


def _toml(value: Any) -> str:
    """Text, numbers, booleans and lists as TOML; JSON writes these alike."""
    return json.dumps(value, ensure_ascii=False)
