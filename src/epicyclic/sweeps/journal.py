"""The journal of an unfinished sweep: one line for each finished point, written as it finishes.

A sweep that is interrupted leaves its journal behind, and the same sweep goes on from there. Every
line names the sweep it belongs to, and nothing is ever overwritten: a file that holds anything else
is refused. Lines that cannot be read, such as one cut short, are computed again.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from pydantic import ConfigDict, TypeAdapter, ValidationError

from epicyclic.errors import InputError, Problem

__all__ = ["Journal", "Row"]

_LONGEST_LINE = 1_000_000
"""A point takes some kilobytes; longer lines are something else. [bytes]"""
_MOST_STRANGE_LINES = 100
"""A file that begins with more lines which are no points of the sweep is something else."""


@dataclass(frozen=True, slots=True)
class Row:
    """One finished point of a sweep.

    Attributes
    ----------
    status, message, warnings : str
        How it ended, why it failed, what to know.
    numbers : dict of str to float
        As `Result.numbers` names them; empty if it failed.
    """

    status: str
    message: str = ""
    warnings: str = ""
    numbers: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class _Record:
    __pydantic_config__ = ConfigDict(ser_json_inf_nan="constants")

    sweep: str
    point: int
    row: Row


_RECORD = TypeAdapter(_Record)


@dataclass(frozen=True, slots=True)
class Journal:
    """Finished points on disk.

    Attributes
    ----------
    path : Path
    fingerprint : str
        Of the plan; a journal of another plan is not touched.
    """

    path: Path
    fingerprint: str

    def read(self) -> dict[int, Row]:
        """Finished points by number; none if there is no file.

        Raises
        ------
        InputError
            If the file cannot be read or holds something else than points of this sweep.
        """
        rows: dict[int, Row] = {}
        strange = 0
        try:
            with self.path.open("rb") as file:
                while line := file.readline(_LONGEST_LINE):
                    record = _parse(line.rstrip(b"\n"))
                    if record is not None and record.sweep == self.fingerprint:
                        rows[record.point] = record.row
                    strange += not self._may_be_cut_short(line.rstrip(b"\n"))
                    if not rows and strange > _MOST_STRANGE_LINES:
                        break
        except FileNotFoundError:
            return {}
        except OSError as error:
            raise self._error(f"cannot be read: {error.strerror}.") from None
        if not rows and strange:
            raise self._error("holds something else than points of this sweep.")
        return rows

    def append(self, point: int, row: Row) -> None:
        """Add a finished point; it outlives this process when this returns.

        Raises
        ------
        InputError
            If it cannot be written; what was written before stays.
        """
        # first the end of a line that may have been cut short
        line = b"\n" + _RECORD.dump_json(_Record(self.fingerprint, point, row))
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

    def remove(self) -> None:
        """Delete the journal of a finished sweep."""
        self.path.unlink(missing_ok=True)

    def _may_be_cut_short(self, line: bytes) -> bool:
        """True for the start of a line of this sweep."""
        mark = b'{"sweep":"%s"' % self.fingerprint.encode()
        return line.startswith(mark) or mark.startswith(line)

    def _error(self, allowed: str) -> InputError:
        remedy = "Move it away or delete it, and give the command again."
        return InputError([Problem("journal", str(self.path), allowed, remedy)], "the sweep")


def _parse(line: bytes) -> _Record | None:
    try:
        return _RECORD.validate_json(line)
    except ValidationError:
        return None
