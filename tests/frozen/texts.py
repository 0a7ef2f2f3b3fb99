"""Frozen texts, and those that were improved since."""

from __future__ import annotations

import json
import lzma
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

__all__ = [
    "IMPROVED",
    "OTHERWISE",
    "TEXTS",
    "changed_words",
    "differing",
    "frozen_texts",
    "improved",
    "kept",
    "words",
]

TEXTS = Path(__file__).with_name("texts.json.xz")
IMPROVED = Path(__file__).with_name("improved_texts.toml")
_TABLES = tomllib.loads(IMPROVED.read_text(encoding="utf-8"))
PAIRS = tuple((pair["old"], pair["new"]) for pair in _TABLES["text"])
ADDED = tuple(re.compile(it["pattern"]) for it in _TABLES["added"])
OTHERWISE = frozenset(it["name"] for it in _TABLES["otherwise"])

TOLD = tuple((re.compile(it["key"]), re.compile(it["allowed"])) for it in _TABLES["problem"])
PATTERNS = tuple((re.compile(it["old"]), it["new"]) for it in _TABLES["pattern"])


def frozen_texts() -> dict[str, Any]:
    """What the file of texts holds."""
    content: dict[str, Any] = json.loads(lzma.decompress(TEXTS.read_bytes()))
    return content


def words(content: Any) -> Any:
    """A text, or lists and tables of them, without its layout.

    Line breaks and the width of columns follow from the words, and change with each of them.
    """
    if isinstance(content, str):
        return re.sub(r"\s*─[─\s]*", " ─ ", " ".join(content.split()))
    if isinstance(content, dict):
        return {key: words(item) for key, item in content.items()}
    return [words(item) for item in content] if isinstance(content, list) else content


def improved(content: Any) -> Any:
    """The words of a frozen text, or of lists and tables of them, as they read now."""
    if isinstance(content, str):
        content = words(content)
        for pattern, new in PATTERNS:
            content = pattern.sub(new, content)
        for old, new in PAIRS:
            content = content.replace(old, new)
        return content
    if isinstance(content, dict):
        return {key: improved(item) for key, item in content.items()}
    return [improved(item) for item in content] if isinstance(content, list) else content


def kept(content: Any) -> Any:
    """The words of a text, or of lists and tables of them, without what was added since."""
    if isinstance(content, dict):
        return {key: kept(item) for key, item in content.items()}
    if isinstance(content, list):  # without items that are nothing else
        return [new for it in content if not _is_new(it) for new in [kept(it)] if new or not it]
    content = words(content)
    for pattern in ADDED if isinstance(content, str) else ():
        content = pattern.sub("", content)
    return content


def _is_new(item: Any) -> bool:
    """Whether it is a problem that was not told when texts were frozen."""
    return (
        isinstance(item, list)
        and len(item) == 4
        and any(key.search(str(item[0])) and told.match(str(item[2])) for key, told in TOLD)
    )


def differing(frozen: Any, found: Any) -> Iterator[tuple[str, str]]:
    """Pairs of texts in the same place that differ, beside the improved ones."""
    yield from _differing(improved(frozen), kept(found))


def _differing(frozen: Any, found: Any) -> Iterator[tuple[str, str]]:
    if isinstance(frozen, dict) and isinstance(found, dict):
        for key in frozen.keys() & found.keys():
            yield from _differing(frozen[key], found[key])
        frozen, found = ({key: it for key, it in one.items() if key not in other}
                         for one, other in ((frozen, found), (found, frozen)))  # fmt: skip
    elif isinstance(frozen, list) and isinstance(found, list) and len(frozen) == len(found):
        for old, new in zip(frozen, found, strict=True):
            yield from _differing(old, new)
        return
    if frozen != found:
        yield tuple(it if isinstance(it, str) else json.dumps(it) for it in (frozen, found))


def changed_words(old: str, new: str) -> tuple[str, str]:
    """The words of two texts that differ, with one before and one after them."""
    one, two = old.split(" "), new.split(" ")
    before = after = 0
    shorter = min(len(one), len(two))
    while before < shorter and one[before] == two[before]:
        before += 1
    while after < shorter - before and one[-1 - after] == two[-1 - after]:
        after += 1
    first, rest = max(before - 1, 0), max(after - 1, 0)
    return " ".join(one[first : len(one) - rest]), " ".join(two[first : len(two) - rest])
