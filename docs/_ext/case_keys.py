"""Keys of case files: those that a page describes are compared with the schema, others listed.

A row of a table in how-to/case-file.md starts with a key in backticks, then its default. With
``sphinx-build -W`` a missing key, a key that no longer exists or a wrong default ends the build.

The directive ``{case-keys} PREFIX MODULE.TABLE`` lists the keys of a table from the schema; those
named in its content, one a line, are left out. how-to/trains.md has one for every kind of element
and one for the housing, how-to/case-file.md has those for planet pins and seals.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from docutils import nodes
from pydantic import BaseModel
from pydantic.fields import FieldInfo
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

from epicyclic.case.case import GearPairCase, PlanetaryCase
from epicyclic.case.gear_tables import GearTable
from epicyclic.case.tables.elements import ElementTables
from epicyclic.schema.fields import choices_of, dict_value, entry_of, quantity_of, table_of
from epicyclic.units import Quantity

PAGE, PAGE_OF_TRAINS = "how-to/case-file.md", "how-to/trains.md"
ROW = re.compile(r"^\| `(?P<key>[\w.<>]+)` \| (?P<default>[^|]*) \|", re.MULTILINE)
GEARS = ("sun", "planet", "ring", "pinion", "gear")
WITH_PAGES_OF_THEIR_OWN = ("material", "oil")
DESCRIBED_ELSEWHERE = ("micro_geometry_ring_side", "planet_pin", "seals", "strength")
"""Tables with the keys of another table, and those that the page has from their schema."""

logger = logging.getLogger(__name__)


def keys_of_schema() -> dict[str, str]:
    """Every documented key and its default as text; empty where a key has none."""
    found: dict[str, str] = {}
    for case in (PlanetaryCase, GearPairCase):
        for table, field in case.model_fields.items():
            inner = table_of(field.annotation)
            if table in DESCRIBED_ELSEWHERE:
                continue
            if inner is None or table == "losses":
                found[table] = ""
                continue
            named = "" if dict_value(field.annotation) is None else "NAME."
            for key, default in _fields(inner):
                shared = table in GEARS and key.partition(".")[0] in GearTable.model_fields
                found[f"<gear>.{key}" if shared else f"{table}.{named}{key}"] = default
    found["losses.<term>.include"], found["losses.<term>.factor"] = "true", "1"
    found.pop("losses")
    return found


def _fields(table: type[BaseModel]) -> Iterator[tuple[str, str]]:
    for name, field in table.model_fields.items():
        inner = table_of(field.annotation)
        if dict_value(field.annotation) is not None:  # of names that the user has
            if inner is None:
                yield name, ""
            else:
                yield from ((f"{name}.NAME.{key}", default) for key, default in _fields(inner))
            continue
        if inner is not None and name not in WITH_PAGES_OF_THEIR_OWN + DESCRIBED_ELSEWHERE:
            yield from ((f"{name}.{key}", default) for key, default in _fields(inner))
            continue
        default = None if field.is_required() else field.default
        yield name, _text(default, quantity_of(field.annotation, tuple(field.metadata)))


def _text(default: Any, quantity: Quantity | None) -> str:
    if default is None:
        return ""
    if isinstance(default, tuple):
        parts = (it if isinstance(it, str) else _text(it, quantity) for it in default)
        return ", ".join(parts)
    if quantity is not None and not isinstance(default, str):
        return quantity.text(default)
    if isinstance(default, bool):
        return str(default).lower()
    return f"{default:g}" if isinstance(default, int | float) else str(default)


def check(app: Sphinx) -> None:
    """Compare the page with the schema."""
    text = (Path(app.srcdir) / PAGE).read_text(encoding="utf-8")
    described = {match["key"]: match["default"].strip(" `") for match in ROW.finditer(text)}
    schema = keys_of_schema()
    for key in schema.keys() - described.keys():
        logger.warning("%s: the key %s is not described", PAGE, key)
    for key in described.keys() - schema.keys():
        logger.warning("%s: there is no key %s", PAGE, key)
    trains = (Path(app.srcdir) / PAGE_OF_TRAINS).read_text(encoding="utf-8")
    listed = [(PAGE_OF_TRAINS, trains, f"{kind}.<name>") for kind in ElementTables.model_fields]
    listed += [(PAGE_OF_TRAINS, trains, "housing"), (PAGE, text, "planet_pin")]
    listed += [(PAGE, text, key) for key in ("seals.<name>", "seals.<name>.table")]
    for page, own, keys in listed:
        if f"{{case-keys}} {keys} " not in own:
            logger.warning("%s: the keys of %s are not listed", page, keys)
    for key in schema.keys() & described.keys():
        if schema[key] and described[key] != schema[key]:
            logger.warning(
                "%s: the default of %s is %s, not %s", PAGE, key, schema[key], described[key]
            )


class CaseKeys(SphinxDirective):
    """A table of the keys of one table of a case file."""

    required_arguments = 2
    has_content = True

    def run(self) -> list[nodes.Node]:
        """Key, default and meaning of every field."""
        prefix, place = self.arguments
        module, _, name = place.rpartition(".")
        table: type[BaseModel] = getattr(import_module(module), name)
        rows = [("Key", "Default", "Meaning")]
        rows += [
            (f"``{prefix}.{key}``", _default(field), _meaning(field))
            for key, field in table.model_fields.items()
            if key not in self.content
        ]
        lines = [".. list-table::", "   :header-rows: 1", ""]
        for row in rows:
            lines += [f"   {'*' if not i else ' '} - {cell}" for i, cell in enumerate(row)]
        return self.parse_text_to_nodes("\n".join(["```{eval-rst}", *lines, "```"]))


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "required"
    if table_of(field.annotation) is not None or isinstance(field.default, dict | tuple):
        return "none" if field.default in (None, {}, ()) else "its defaults"
    text = _text(field.default, quantity_of(field.annotation, tuple(field.metadata)))
    return f"``{text}``" if text else "none"


def _meaning(field: FieldInfo) -> str:
    annotation = entry_of(field.annotation) or field.annotation
    quantity = quantity_of(annotation, tuple(field.metadata))
    choices = ", ".join(f"``{choice}``" for choice in choices_of(field.annotation))
    parts = [field.description or "", choices]
    if quantity is not None and quantity.display:
        parts.append(f"[{quantity.display}]")
    return " ".join(part for part in parts if part).replace("*", "\\*")


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("case-keys", CaseKeys)
    app.connect("builder-inited", check)
    return {"parallel_read_safe": True}
