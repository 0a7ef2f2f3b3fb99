"""Values typed on a command line."""

from __future__ import annotations

import tomllib
from typing import Any


def parse_value(text: str) -> Any:
    """`text` as TOML would read it (numbers, true, lists), else as plain text."""
    try:
        tables = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):  # no TOML, numbers or lists beyond all measure
        return text
    return tables["value"] if len(tables) == 1 else text
