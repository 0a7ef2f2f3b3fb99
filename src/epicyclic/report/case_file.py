"""A case as a case file, with a comment beside some of its keys."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from epicyclic.case.case import Case

__all__ = ["case_text"]


def case_text(case: Case, comments: Mapping[str, str], heading: Sequence[str] = ()) -> str:
    """The tables of a case, as they were given, as TOML.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
    comments : mapping of str to str
        Dotted keys to what stands behind their values.
    heading : sequence of str
        Lines of comment at the top.
    """
    given = case.given()
    lines = [f"# {line}" for line in heading]
    for name in sorted(given, key=lambda name: isinstance(given[name], Mapping)):  # tables last
        value = given[name]
        if isinstance(value, Mapping):
            lines += ["", f"[{name}]", *_lines((name,), value, comments)]
        else:
            lines.append(f"{_name(name)} = {_value(value)}")
    return "\n".join(lines) + "\n"


def _lines(
    path: tuple[str, ...], table: Mapping[str, Any], comments: Mapping[str, str]
) -> Iterator[str]:
    """Lines of a table at `path`; a table within it appears as dotted keys."""
    for key, value in table.items():
        inner = (*path, key)
        if isinstance(value, Mapping) and value:
            yield from _lines(inner, value, comments)
        else:
            comment = comments.get(".".join(inner))
            line = f"{'.'.join(map(_name, inner[1:]))} = {_value(value)}"
            yield f"{line}  # {comment}" if comment else line


def _name(key: str) -> str:
    bare = key.isascii() and key.replace("-", "").replace("_", "").isalnum()
    return key if bare else json.dumps(key)


def _value(value: Any) -> str:
    """`value` on one line; JSON writes text, numbers and booleans as TOML does."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{_name(key)} = {_value(item)}' for key, item in value.items())} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_value, value))}]"
    return json.dumps(value, ensure_ascii=False)
