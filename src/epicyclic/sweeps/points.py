"""Tables of points: a column for each key, a row for each point."""

from __future__ import annotations

import io
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.case.values import parse_value
from epicyclic.case.wording import one_line
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.sweeps.axes import MOST_POINTS
from epicyclic.text_file import read_text, refuse

if TYPE_CHECKING:
    import pandas as pd

_LARGEST_FILE = 10_000_000
"""[bytes]"""
_HEADER = re.compile(r"(?P<key>[^\[\]]+?)\s*(\[(?P<unit>[^\[\]]*)\])?")


def columns_of(points: str | Path | pd.DataFrame) -> dict[str, list[Any]]:
    """Keys of a table of points with their values, as a case file has them.

    Units stand in the header, ``gears.normal_module [mm]``, or with the values.

    Raises
    ------
    InputError
        If the file cannot be read, a cell is empty, or a key has two columns.
    """
    if not isinstance(points, str | Path):
        return _columns({str(name): column.tolist() for name, column in points.items()})
    source = one_line(str(points), 500)
    try:
        return _columns(_read(Path(points)))
    except InputError as error:
        raise InputError(error.problems, source) from None


def _read(path: Path) -> dict[str, Sequence[Any]]:
    import pandas as pd

    text = read_text(path, "table", _LARGEST_FILE)
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if len(lines) < 2:
        refuse("has no rows below a header.", "Give a header of keys, and a row for each point.")
    if len(lines) > MOST_POINTS + 1:  # not worth reading them
        refuse(f"has more than {MOST_POINTS} rows.", "Give fewer points, or several tables.")
    separator = max(",;\t", key=lines[0].count)
    try:
        cells = pd.read_csv(
            io.StringIO("\n".join(lines)),
            sep=separator,
            header=None,
            dtype=str,
            keep_default_na=False,
            skipinitialspace=True,
        )
    except (pd.errors.ParserError, pd.errors.EmptyDataError) as error:
        refuse(f"is not a table: {str(error).strip()}.", "Give every row as many cells.")
    header = [str(name).strip() for name in cells.iloc[0]]
    repeated = {name for name in header if header.count(name) > 1}
    if repeated:
        refuse(f"has two columns {', '.join(sorted(repeated))}.", "Keep one of them.")
    values = cells.iloc[1:]
    return {
        name: [str(cell).strip() for cell in values[number]] for number, name in enumerate(header)
    }


def _columns(table: dict[str, Any]) -> dict[str, list[Any]]:
    columns: dict[str, list[Any]] = {}
    problems = []
    for header, cells in table.items():
        match = _HEADER.fullmatch(header)
        key, unit = (match["key"], match["unit"] or "") if match else (header, "")
        if key in columns:
            problems.append(Problem(key, "", "has two columns.", "Keep one of them."))
        empty = [str(number) for number, cell in enumerate(cells, 1) if _is_empty(cell)]
        if empty:
            allowed = f"has no value in row {', '.join(empty[:5])}{' ...' * (len(empty) > 5)}."
            problems.append(Problem(key, "", allowed, "Give every row a value."))
        columns[key] = [_value(cell, unit) for cell in cells]
    raise_any(problems, "the table of points")
    return columns


def _is_empty(cell: Any) -> bool:
    return cell is None or cell == "" or cell != cell  # NaN of a frame


def _value(cell: Any, unit: str) -> Any:
    """A cell as a case file has it, a bare number with the unit of its column."""
    value = parse_value(cell) if isinstance(cell, str) else cell
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return f"{value!r} {unit}" if unit not in ("", "1") and is_number else value
