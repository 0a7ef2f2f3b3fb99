"""The journal of an unfinished sweep: one line for each finished case, written as it finishes.

A sweep that is interrupted leaves its journal beside the output, and the same sweep goes on from
there. A line cut short by the interruption is ignored.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

__all__ = ["Journal"]

Row = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Journal:
    """Finished rows on disk.

    Attributes
    ----------
    path : Path
    fingerprint : str
        Of the plan; rows of another plan are not taken over.
    """

    path: Path
    fingerprint: str

    def read(self) -> dict[int, Row]:
        """Rows of the same plan by case number; starts a new journal if there are none."""
        rows: dict[int, Row] = {}
        lines = self.path.read_text(encoding="utf-8").splitlines() if self.path.exists() else []
        if not lines or _parse(lines[0]) != {"fingerprint": self.fingerprint}:
            self.path.write_text(json.dumps({"fingerprint": self.fingerprint}) + "\n")
            return rows
        for line in lines[1:]:
            record = _parse(line)
            if record is not None:
                rows[record["case"]] = record["row"]
        return rows

    def append(self, rows: Iterable[tuple[int, Row]]) -> None:
        """Add finished rows; they are on disk when this returns."""
        text = "".join(json.dumps({"case": case, "row": row}) + "\n" for case, row in rows)
        with self.path.open("a", encoding="utf-8") as file:
            # after an interruption the last line may lack its end
            if not self._ends_with_newline():
                file.write("\n")
            file.write(text)
            file.flush()
            os.fsync(file.fileno())

    def remove(self) -> None:
        """Delete the journal of a finished sweep."""
        self.path.unlink(missing_ok=True)

    def _ends_with_newline(self) -> bool:
        with self.path.open("rb") as file:
            file.seek(0, os.SEEK_END)
            if file.tell() == 0:
                return True
            file.seek(-1, os.SEEK_END)
            return file.read(1) == b"\n"


def _parse(line: str) -> Any:
    try:
        return json.loads(line)
    except json.JSONDecodeError:
        return None
