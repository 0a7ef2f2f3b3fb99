"""The journal of an unfinished study: one line for each finished point, written as it finishes.

A study that is interrupted leaves its journal behind, and the same study goes on from there. Every
line names the study it belongs to, one of them says what it is, and nothing is ever overwritten: a
file that holds anything else is refused. Lines that cannot be read, such as one cut short, or that
have been altered are computed again. The file of a shard is the journal of its points.
"""

from __future__ import annotations

import json
import sys
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, TypeAdapter, ValidationError

from epicyclic.errors import InputError, Problem
from epicyclic.status import Status

NOT_COMPUTED = "not computed"
"""Status of the points of other shards."""

_WITHOUT_NUMBERS = (Status.FAILED, Status.UNPHYSICAL)
_LONGEST_LINE = 50_000_000
"""A point takes some kilobytes, what a study is at most all values of a million points. [bytes]"""
_MOST_STRANGE_LINES, _LONG = 100, 500_000
"""A file that begins with more lines which are no points of the study is something else; one of
more bytes counts as several."""


@dataclass(frozen=True, slots=True)
class Row:
    """One finished point of a study."""

    status: str  # How it ended, why it failed, what to know.
    message: str = ""  # How it ended, why it failed, what to know.
    warnings: str = ""  # How it ended, why it failed, what to know.
    # As `Result.numbers` names them; empty if it failed.
    numbers: dict[str, float] = field(default_factory=dict)


class Rows:
    """All points of a study, by number: columns, which take a tenth of the memory of rows.

    Attributes
    ----------
    status, message, warnings : list of str
        As of a `Row`; `NOT_COMPUTED` until it is there.
    """

    def __init__(self, size: int) -> None:
        self.status = [NOT_COMPUTED] * size
        self.message = [""] * size
        self.warnings = [""] * size
        self._numbers: dict[str, NDArray[np.float64]] = {}

    def __len__(self) -> int:
        return len(self.status)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the numbers that any point has."""
        return tuple(self._numbers)

    @property
    def failures(self) -> list[str]:
        """Why points failed, one text for each."""
        pairs = zip(self.status, self.message, strict=True)
        return [message for status, message in pairs if status in _WITHOUT_NUMBERS]

    def add(self, point: int, row: Row) -> None:
        self.status[point] = sys.intern(row.status)
        self.message[point] = sys.intern(row.message)
        self.warnings[point] = sys.intern(row.warnings)  # neighbours often have the same
        for name, value in row.numbers.items():
            if name not in self._numbers:
                self._numbers[name] = np.full(len(self), np.nan)
            self._numbers[name][point] = value

    def numbers(self, name: str) -> NDArray[np.float64]:
        """One number of all points; NaN where there is none."""
        return self._numbers.get(name, np.full(len(self), np.nan))


@dataclass(frozen=True, slots=True)
class _Record:
    __pydantic_config__ = ConfigDict(ser_json_inf_nan="constants")

    sweep: str
    point: int
    row: Row


@dataclass(frozen=True, slots=True)
class _Heading:
    sweep: str
    study: dict[str, Any]


_RECORD, _HEADING = TypeAdapter(_Record), TypeAdapter(_Heading)


@dataclass(frozen=True, slots=True)
class Journal:
    """Finished points on disk."""

    path: Path
    fingerprint: str  # Fingerprint of the plan; a journal of another plan is not touched.

    def read(self) -> dict[int, Row]:
        """Finished points by number; none if there is no file.

        Raises
        ------
        InputError
            If the file cannot be read or holds something else than points of this study.
        """
        return dict(self.points())

    def points(self) -> Iterator[tuple[int, Row]]:
        """The same one by one, so that they need not all be held."""
        own = strange = 0
        try:
            with _opened(self.path) as file:
                while line := file.readline(_LONGEST_LINE):
                    record = _parse(line.rstrip(b"\n"))
                    if record is not None and record.sweep == self.fingerprint:
                        own += 1
                        yield record.point, record.row
                    if not self._may_be_cut_short(line.rstrip(b"\n")):
                        strange += 1 + len(line) // _LONG
                    if not own and strange > _MOST_STRANGE_LINES:
                        break
        except FileNotFoundError:
            return
        except OSError as error:
            raise self._error(f"cannot be read: {error.strerror}.") from None
        if not own and strange:
            raise self._error("holds something else than points of this sweep.")

    def begin(self, content: Mapping[str, Any]) -> None:
        """Say in the file what the study is, unless it does."""
        heading = {"sweep": self.fingerprint, "study": content}
        line = json.dumps(heading, separators=(",", ":")).encode()
        try:
            with _opened(self.path) as file:
                there = any(file.readline(_LONGEST_LINE).strip() == line for _ in range(2))
        except FileNotFoundError:
            there = False
        if not there:
            self._write(line)

    def append(self, point: int, row: Row) -> None:
        """Add a finished point; it outlives this process when this returns.

        Raises
        ------
        InputError
            If it cannot be written; what was written before stays.
        """
        self._write(_sealed(_RECORD.dump_json(_Record(self.fingerprint, point, row))))

    def remove(self) -> None:
        """Delete the journal of a finished study."""
        self.path.unlink(missing_ok=True)

    def _write(self, line: bytes) -> None:
        line = b"\n" + line  # first the end of a line that may have been cut short
        try:
            with self.path.open("ab", buffering=0) as file:  # one write: workers share the file
                whole = file.write(line) == len(line)
            reason = "the disk is full"
        except OSError as error:
            whole, reason = False, str(error.strerror)
        if not whole:
            problem = Problem(
                "journal",
                str(self.path),
                f"cannot be written: {reason}.",
                "Finished points are kept; make room, and give the same command again.",
            )
            raise InputError([problem], "the sweep")

    def _may_be_cut_short(self, line: bytes) -> bool:
        """True for the start of a line of this study."""
        mark = b'{"sweep":"%s"' % self.fingerprint.encode()
        return line.startswith(mark) or mark.startswith(line)

    def _error(self, allowed: str) -> InputError:
        return _error(self.path, allowed)


def _opened(path: Path) -> BinaryIO:
    """The file to read, if it is one: a pipe could keep the program waiting for ever."""
    if path.exists() and not path.is_file():
        raise _error(path, "is not a regular file.")
    return path.open("rb")


def read_heading(path: Path) -> tuple[str, dict[str, Any]]:
    """Fingerprint and content of the study of which a file holds points.

    Raises
    ------
    InputError
        If it cannot be read, or does not say of which study it is.
    """
    try:
        with _opened(path) as file:
            strange = 0
            while strange <= _MOST_STRANGE_LINES:
                line = file.readline(_LONGEST_LINE)
                heading = _parse_heading(line)
                if heading is not None:
                    return heading.sweep, heading.study
                strange += 1 + len(line) // _LONG
    except OSError as error:
        raise _error(path, f"cannot be read: {error.strerror}.") from None
    raise _error(path, "does not say of which study it holds points.")


_CHECK = b',"check":"%08x"}'


def _sealed(line: bytes) -> bytes:
    """A line with the checksum of what comes before it."""
    return line[:-1] + _CHECK % zlib.crc32(line)


def _parse(line: bytes) -> _Record | None:
    """The record of a line; None if it is none, or has been altered."""
    record = line[: -len(_CHECK % 0)] + b"}"
    if line != _sealed(record):
        return None
    try:
        return _RECORD.validate_json(record)
    except ValidationError:
        return None


def _parse_heading(line: bytes) -> _Heading | None:
    try:
        return _HEADING.validate_json(line)
    except ValidationError:
        return None


def _error(path: Path, allowed: str) -> InputError:
    remedy = "Move it away or delete it, and give the command again."
    return InputError([Problem("journal", str(path), allowed, remedy)], "the sweep")
