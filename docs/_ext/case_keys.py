"""Warn about keys of a case file that how-to/case-file.md does not describe as the schema has them.

A row of a table there starts with a key in backticks, then its default. With ``sphinx-build -W`` a
missing key, a key that no longer exists or a wrong default ends the build.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic import BaseModel
from sphinx.application import Sphinx
from sphinx.util import logging

from epicyclic.case.case import GearPairCase, PlanetaryCase
from epicyclic.case.fields import quantity_of, table_of
from epicyclic.case.gear_tables import GearTable
from epicyclic.units import Quantity

PAGE = "how-to/case-file.md"
ROW = re.compile(r"^\| `(?P<key>[\w.<>]+)` \| (?P<default>[^|]*) \|", re.MULTILINE)
GEARS = ("sun", "planet", "ring", "pinion", "gear")
WITH_PAGES_OF_THEIR_OWN = ("material", "oil")
DESCRIBED_ELSEWHERE = ("micro_geometry_ring_side",)  # has the keys of another table

logger = logging.getLogger(__name__)


def keys_of_schema() -> dict[str, str]:
    """Every documented key and its default as text; empty where a key has none."""
    found: dict[str, str] = {}
    for case in (PlanetaryCase, GearPairCase):
        for table, field in case.model_fields.items():
            inner = table_of(field.annotation)
            if inner is None or table == "losses":
                found[table] = ""
                continue
            for key, default in _fields(inner):
                shared = table in GEARS and key.partition(".")[0] in GearTable.model_fields
                found[f"<gear>.{key}" if shared else f"{table}.{key}"] = default
    found["losses.<term>.include"], found["losses.<term>.factor"] = "true", "1"
    found.pop("losses")
    return found


def _fields(table: type[BaseModel]) -> Iterator[tuple[str, str]]:
    for name, field in table.model_fields.items():
        inner = table_of(field.annotation)
        if inner is not None and name not in WITH_PAGES_OF_THEIR_OWN + DESCRIBED_ELSEWHERE:
            yield from ((f"{name}.{key}", default) for key, default in _fields(inner))
            continue
        default = None if field.is_required() else field.default
        yield name, _text(default, quantity_of(field.annotation, tuple(field.metadata)))


def _text(default: Any, quantity: Quantity | None) -> str:
    if default is None:
        return ""
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
    for key in schema.keys() & described.keys():
        if schema[key] and described[key] != schema[key]:
            logger.warning(
                "%s: the default of %s is %s, not %s", PAGE, key, schema[key], described[key]
            )


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("builder-inited", check)
    return {"parallel_read_safe": True}
