"""Texts that were improved since they were frozen."""

from __future__ import annotations

import tomllib
from pathlib import Path

__all__ = ["improved"]

IMPROVED = Path(__file__).with_name("improved_texts.toml")
PAIRS = tuple(
    (pair["old"], pair["new"])
    for pair in tomllib.loads(IMPROVED.read_text(encoding="utf-8")).get("text", [])
)


def improved(text: str) -> str:
    """A frozen text as it reads now."""
    for old, new in PAIRS:
        text = text.replace(old, new)
    return text
