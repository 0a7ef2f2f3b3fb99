"""Text files that users give: read whole if they are no larger than such a file can be, as UTF-8.

Everything that reads a file of the user goes through here, so that devices, folders, huge files and
other encodings end in the same messages.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import re
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NoReturn

from epicyclic.errors import InputError, Problem

_MEGABYTE = 1_000_000
_SEAL = "fingerprint"
_MAKE_AGAIN = "Make it again."
_LONGEST_REASON = 200


def read_text(
    path: Path,
    noun: str,  # What the file should be, ``"case"`` for a case file, for messages.
    largest: int,  # Size beyond which it is something else. [bytes]
) -> str:
    """The text of a file.

    Raises
    ------
    InputError
        If it is not a file, too large, or not UTF-8 text.
    """
    return decode(read_bytes(path, noun, largest), noun)


def read_bytes(path: Path, noun: str, largest: int) -> bytes:
    """The content of a file. Parameters and errors as for `read_text`."""
    kind, content = "a file", b""
    try:
        # a pipe or a device could keep the program waiting for ever
        if path.exists() and not path.is_file():
            kind = "a folder" if path.is_dir() else "not a regular file"
        else:
            with path.open("rb") as file:
                content = file.read(largest + 1)
    except OSError as error:
        refuse(f"cannot be read: {error.strerror}.", "Check the path.")
    except ValueError:
        refuse("cannot be read: no path has a zero character.", "Check the path.")
    if kind != "a file":
        refuse(f"cannot be read: it is {kind}.", f"Name a {noun} file.")
    if len(content) > largest:
        size = f"{largest / _MEGABYTE:g} MB"
        refuse(f"is too large to be a {noun} file (over {size}).", f"Name a {noun} file.")
    return content


def decode(content: bytes, noun: str) -> str:
    """`content` as text; raises `InputError` unless it is UTF-8."""
    if b"\0" in content:
        refuse("is not text: it has zero bytes.", f"Name a {noun} file, saved as UTF-8 text.")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        where = f"byte 0x{content[error.start]:02x} in line {line}"
        refuse(f"is not UTF-8 text: {where}.", "Save it as UTF-8 text.")


def csv_rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """Line number and cells of each row; the separator is that of the header.

    Lines that begin with # are skipped.
    """
    kept = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    separator = max(",;\t", key=kept[0][1].count) if kept else ","
    for number, line in kept:  # line by line: a quote that stays open spoils one row only
        try:
            (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
        except csv.Error as error:
            refuse(f"is no CSV: {error} in line {number}.", "Correct this line.")
        yield number, [cell.strip() for cell in cells]


def check_archive(content: bytes, noun: str, largest: int, remedy: str) -> None:
    """Raise `InputError` unless `content` is a zip archive that unpacks to `largest` bytes or less.

    `noun` with its article: ``"an X3P file"``.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            unpacked = sum(item.file_size for item in archive.infolist())
    except Exception:  # damaged archives end in many kinds of errors
        refuse(f"is not {noun}.", remedy)
    if unpacked > largest:
        refuse(f"unpacks to more than {largest / _MEGABYTE:g} MB.", remedy)


_COLUMN = re.compile(r"\[\n\s*([-+.,eE\d\s]+)\]")
"""A list of numbers with each on a line of its own: they share one line."""


def sealed(content: Mapping[str, Any], indent: int | None = None) -> str:
    """JSON with a fingerprint of its content, so that `unsealed` sees whether it was altered."""
    separators = (",", ":") if indent is None else (",", ": ")
    whole = {**content, _SEAL: _fingerprint(content)}
    text = json.dumps(whole, indent=indent, separators=separators)
    return _COLUMN.sub(lambda found: "[" + " ".join(found[1].split()) + "]", text) + "\n"


def unsealed(text: str) -> dict[str, Any]:
    """The content of a text from `sealed`; raises `InputError` if it is none, or was altered."""
    try:
        content = json.loads(text)
    except (ValueError, RecursionError) as error:
        refuse(f"is not JSON: {str(error)[:_LONGEST_REASON]}.", _MAKE_AGAIN)
    if not isinstance(content, dict) or _SEAL not in content:
        refuse("has no fingerprint.", _MAKE_AGAIN)
    if content.pop(_SEAL) != _fingerprint(content):
        refuse("was altered: its fingerprint is that of other content.", _MAKE_AGAIN)
    return content


def _fingerprint(content: Mapping[str, Any]) -> str:
    text = json.dumps(content, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def refuse(allowed: str, remedy: str) -> NoReturn:
    """Raise the `InputError` of a file as a whole."""
    raise InputError([Problem("", "", f"the file {allowed}", remedy)])
