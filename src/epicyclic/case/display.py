"""How a case shows itself: in one line, and as a page of a notebook, in the units of case files."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from typing import Any

from epicyclic.case.plain import flattened
from epicyclic.units import unit_text


def case_line(
    name: str,  # Name of its class.
    given: Mapping[str, Any],  # Its tables, without defaults.
) -> str:
    """A case in one line: its title and operating point."""
    words = [f"title={given['title']!r}"] if given.get("title") else []
    words += [f"{key}={value!r}" for key, value in given.get("operation", {}).items()]
    return f"{name}({', '.join(words)})"


def case_html(name: str, given: Mapping[str, Any]) -> str:
    """The keys of a case that were given, table by table; parameters as for `case_line`."""
    alone = {key: value for key, value in given.items() if not isinstance(value, Mapping)}
    tables = {"": alone} | {key: it for key, it in given.items() if isinstance(it, Mapping)}
    rows = "".join(
        _row(key if number == 0 else "", name, value)
        for key, table in tables.items()
        for number, (name, value) in enumerate(flattened(table))
    )
    title = escape(str(given.get("title") or name))
    return f"<table><caption><strong>{title}</strong></caption><tbody>{rows}</tbody></table>"


def _row(table: str, key: str, value: object) -> str:
    text = unit_text(value) if isinstance(value, str) else str(value)
    cells = (f"<strong>{escape(table)}</strong>", escape(key), escape(text))
    return f"<tr>{''.join(map(_cell, cells))}</tr>"


def _cell(content: str) -> str:
    return f'<td style="text-align: left">{content}</td>'
