"""Texts of messages: keys and values as a case file has them, and names that were meant."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from pydantic_core import PydanticCustomError

from epicyclic.errors import InputError, Problem, printable

_LONGEST_SHOWN = 60  # Text that users wrote is cut to this many characters in messages.

NAME = re.compile(r"(?!\s*$)[^\x00-\x1f\x7f-\x9f\u2028\u2029]+")
_PART_NAME = re.compile(rf"(?![\x00-/:-@[-^`{{-\xa0])(?![^/.]*[/.]){NAME.pattern}(?<!\s)")
"""Names of parts begin names of variables in NetCDF files, and end at a dot."""

_QUOTED = r'"((?:[^"\\]|\\.)*)"'  # A quote or backslash in it follows a backslash, as in TOML.
_DEEPEST = 20  # Dots of a key; tables of a case are nested a few levels deep.


def dotted(path: Sequence[str | int]) -> str:
    """A path as users write it: ``lubricant.oil.density[1].value``."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            bare = part.isascii() and part.replace("-", "").replace("_", "").isalnum()
            escaped = re.sub(r'["\\]', r"\\\g<0>", part)
            text += ("." if text else "") + (part if bare else f'"{one_line(escaped)}"')
    return text


def path_of(key: str) -> tuple[str | int, ...]:
    """The path of a key as `dotted` writes it."""
    parts = re.findall(rf"{_QUOTED}|([^.\[\]]+)", key)
    return tuple(int(bare) if bare.isdecimal() else bare or _plain(name) for name, bare in parts)


def key_parts(key: str) -> list[str]:
    """The names of a dotted key; one in quotes may have dots: ``positions."S1.pinion"``.

    Raises `InputError` if it has more names than any key of a case.
    """
    if key.count(".") > _DEEPEST:
        allowed = f"is not a key: it has more than {_DEEPEST} dots."
        raise InputError([Problem(one_line(key), "", allowed, "Correct it.")])
    if '"' not in key:
        return key.split(".")
    parts = re.findall(rf"{_QUOTED}|([^.]+)", key)
    return [bare.strip('"') or _plain(name) for name, bare in parts]


def _plain(name: str) -> str:
    return re.sub(r'\\(["\\])', r"\1", name)


def value_at(tables: Any, path: Sequence[str | int]) -> Any:
    """The value at `path` below `tables`; None if there is none."""
    for part in path:
        if isinstance(tables, (dict, Mapping)):  # of most the faster one
            tables = tables.get(part)
        elif isinstance(tables, tuple) and isinstance(part, int) and part < len(tables):
            tables = tables[part]
        else:
            return None
    return tables


def written(value: Any) -> str:
    """`value` as a case file has it, cut to one short line."""
    text = _written(value)
    is_short = isinstance(value, str) or len(text) <= _LONGEST_SHOWN
    return text if is_short else f"{text[:_LONGEST_SHOWN]}..."


def one_line(text: str, longest: int = _LONGEST_SHOWN) -> str:
    """`text` on one line, without control characters, cut to the `longest` that is shown."""
    shown = printable(" ".join(text[: 2 * longest].split()))
    is_cut = len(shown) > longest or len(text) > 2 * longest
    return f"{shown[:longest]}..." if is_cut else shown


def _written(value: Any) -> str:
    if isinstance(value, str):
        return f'"{one_line(value)}"'
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) >= 10**_LONGEST_SHOWN:
        return "a whole number of many digits"
    if isinstance(value, Mapping):
        return (
            f"{{{_joined(f'{one_line(key)} = {_written(item)}' for key, item in value.items())}}}"
        )
    if isinstance(value, tuple | list):
        return f"[{_joined(map(_written, value))}]"
    return one_line(str(value))


def _joined(parts: Iterator[str]) -> str:
    """The parts, as many as a message shows."""
    text = ""
    for part in parts:
        text += f", {part}" if text else part
        if len(text) > _LONGEST_SHOWN:
            break
    return text


def sentence(text: str, *, capital: bool = True) -> str:
    """`text` with a full stop, and with a capital letter at its start unless told otherwise."""
    is_key = "." in text.partition(" ")[0].rstrip(".:")
    start = text[:1].upper() if capital and not is_key else text[:1]
    return f"{start}{text[1:]}" + ("" if text.endswith((".", "?")) else ".")


def refused(error: PydanticCustomError, key: str, given: str) -> Problem:
    """The problem of a value that its quantity refuses."""
    remedy = str((error.context or {}).get("remedy", ""))
    return Problem(key, given, sentence(error.message(), capital=False), sentence(remedy))


def part_name_problems(key: str, name: str, noun: str) -> list[Problem]:
    """The problem of a name that no part may have."""
    if _PART_NAME.fullmatch(name):
        return []
    rule = "begin with a letter or digit, and use no dot or slash"
    return [Problem(key, "", f"is not a valid name for a {noun}: {rule}.", "Choose another name.")]


def millimetres(value: float) -> str:
    """A length in metres as text for a message."""
    return f"{value * 1e3:.5g} mm"


def micrometres(value: float) -> str:
    """A small length in metres as text for a message."""
    return f"{value * 1e6:.3g} um"


# Suggestions for misspelt names.

_LIKENESS = 60.0  # Smallest likeness, in percent, at which a name is worth suggesting.

_MOST_KINDS = 3  # Names of kinds of one thing that are all suggested.
_MOST_SLIPS = 2  # Letters left out, added, changed or swapped in a name that is still clear.

_SHORT_WORD = 2  # Length of words that say nothing.
_LONGEST = 60  # No name is longer, and longer text is not compared. [characters]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """``"Did you mean 'sun'?"``, or nothing if no known name is near."""
    from rapidfuzz import distance, process

    if len(name) > _LONGEST:
        return ""
    known = list(known)
    start = re.sub(r"[\s_]+", "-", name.casefold()) + "-"
    kinds = [repr(one) for one in known if f"-{start}" in f"-{one.casefold()}"]
    if 1 < len(kinds) <= _MOST_KINDS:  # none of them is nearer
        return f"Did you mean {' or '.join(kinds)}?"
    slips = max(0, min(_MOST_SLIPS, (len(name) - 1) // 2))
    found = (
        process.extractOne(name, known, scorer=distance.OSA.distance, score_cutoff=slips),
        process.extractOne(name, known, scorer=_likeness, score_cutoff=_LIKENESS),
    )
    near = dict.fromkeys(repr(one[0]) for one in found if one)
    return f"Did you mean {' or '.join(near)}?" if near else ""


def titled(text: str, titles: Mapping[str, str]) -> str:
    """``"Did you mean 'CuSn12'?"`` of names in whose titles a word of `text` stands; or nothing."""
    words = [word for word in re.split(r"[\W_]+", text.casefold()) if len(word) > _SHORT_WORD]
    near = [repr(name) for name in titles if any(one in titles[name].casefold() for one in words)]
    return f"Did you mean {either(near)}?" if 0 < len(near) <= _MOST_KINDS else ""


def either(names: Sequence[str]) -> str:
    """``"a, b or c"``."""
    return f"{', '.join(names[:-1])} or {names[-1]}" if len(names) > 1 else "".join(names)


def misspelt(name: str, known: Iterable[str]) -> str:
    """The known name that `name` can only be a misspelling of; empty if there is none."""
    from rapidfuzz.distance import OSA

    slips = {
        other: OSA.distance(name.casefold(), other.casefold(), score_cutoff=_MOST_SLIPS)
        for other in known
        if len(name) <= _LONGEST
    }
    nearest = min(slips, key=slips.__getitem__, default="")
    clear = nearest and slips[nearest] <= min(_MOST_SLIPS, len(name) // 3)
    return nearest if clear else ""


_SEPARATORS = str.maketrans("", "", "-_. ")


def _likeness(name: str, known: str, *, score_cutoff: float | None = None) -> float:
    """In percent; a name that is part of another one is somewhat like it."""
    from rapidfuzz.fuzz import ratio

    one, two = name.casefold(), known.casefold()
    score = ratio(one, two, score_cutoff=score_cutoff)
    one, two = one.translate(_SEPARATORS), two.translate(_SEPARATORS)
    partly = min(len(one), len(two)) > 3 and (one in two or two in one)
    return max(score, _LIKENESS + 10) if partly else score
