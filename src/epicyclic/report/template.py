"""A commented case file, written from the schema and a built-in case."""

from __future__ import annotations

import json
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from epicyclic import library
from epicyclic.case.case import GearPairCase, PlanetaryCase
from epicyclic.case.fields import choices_of, quantity_of, table_of

__all__ = ["case_template"]

_EXAMPLES: dict[str, tuple[str, type[BaseModel]]] = {
    "planetary": ("talbot-2012", PlanetaryCase),
    "gear_pair": ("talbot-2012-pair", GearPairCase),
}
COMMENT_COLUMN = 44


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
        subtable = table_of(inner.annotation)
        if subtable is not None and name not in values:
            if key == "losses":
                lines.append(_line(f"# {name} = {{ include = true, factor = 1.0 }}", ""))
                continue
            if inner.default == "steel":
                lines.append(_line('# material = "steel"', _about(inner)))
            continue
        if name in values:
            lines.append(_line(f"{name} = {_toml(values[name])}", _about(inner)))
        else:
            lines.append(_line(f"# {name} = {_default(inner)}", _about(inner)))
    return lines


def _line(text: str, about: str) -> str:
    return f"{text.ljust(COMMENT_COLUMN)}# {about}" if about else text


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
    return f"[{value}, ...]" if "tuple" in str(field.annotation) else value


def _toml(value: Any) -> str:
    """Text, numbers, booleans and lists as TOML; JSON writes these alike."""
    return json.dumps(value, ensure_ascii=False)
