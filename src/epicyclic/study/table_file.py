"""Tables as rigs, simulators and spreadsheets write them: text, Excel, Parquet, in memory.

A table is read in pieces. What its text leaves open (encoding, separator, decimal mark, where the
head ends, which row has the units) is found from its first rows; a row that contradicts is refused.
"""

from __future__ import annotations

import codecs
import csv
import io
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import compress, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass, field
from epicyclic.errors import InputError, Problem, first_of, one_problem, problems_in, raise_any
from epicyclic.files import check_archive, read_bytes, refuse
from epicyclic.messages import one_line, sentence
from epicyclic.study.operating import NAMES
from epicyclic.units import CELSIUS, NEWTON_METRE, NUMBER, RPM, SECOND, WATT, Quantity, one_of

if TYPE_CHECKING:
    import pyarrow as pa

TEXT, EXCEL, PARQUET = (".csv", ".txt", ".tsv", ".dat", ".asc"), (".xlsx", ".xlsm"), (".parquet",)
SUFFIXES = (*TEXT, *EXCEL, *PARQUET)
HEADER = re.compile(r"(?P<name>[^\[\]]+?)\s*(?:\[(?P<unit>[^\[\]]*)\])?")
"""A column and its unit."""

_LARGEST_WORKBOOK = 10_000_000  # Also of what it unpacks to. [bytes]
_SAMPLE_ROWS, _SAMPLE_CHARACTERS, _HEAD_ROWS = 2000, 1 << 18, 30
_BATCH_ROWS, _PAGE_BYTES = 1 << 16, 1 << 20
_NOUN, _SAVE_AGAIN, _TIME_OF_DATES = "table", "Save it again, or as CSV.", "time [s]"
_SHOWN = 5  # Lines, columns and sheets that a message names.
_MOST_COLUMNS = 2000

_SEPARATORS = ";\t|,"  # The first of those that divide the lines alike.
_GAPS = re.compile(r'"[^"]*"|[^\s\[("]+(?:\s*(?:\[[^\]]*\]|\([^)]*\)))?')
"""A cell of a table that is separated by spaces."""
_SPACES = "'’\u00a0\u202f "  # Between groups of three digits, beside the other decimal mark.
_CERTAIN = {  # Numbers that have the mark as the decimal one and cannot be meant otherwise.
    ".": re.compile(r"[+-]?(?:(?:\d{4,}|0\d*|)\.\d+|\d+\.(?:\d{1,2}|\d{4,})?"
                    r"|\d+(?:[,'’\s]\d{3})+\.\d*|\d{1,3}(?:,\d{3}){2,})(?:[eE][+-]?\d+)?"),
    ",": re.compile(r"[+-]?(?:(?:\d{4,}|0\d*|),\d+|\d+,(?:\d{1,2}|\d{4,})?"
                    r"|\d+(?:[.'’\s]\d{3})+,\d*|\d{1,3}(?:\.\d{3}){2,})(?:[eE][+-]?\d+)?"),
}  # fmt: skip
_OPEN = {mark: re.compile(rf"[+-]?[1-9]\d{{0,2}}[{mark}]\d{{3}}") for mark in ".,"}
"""A decimal mark, or one of thousands."""
_VALUE = re.compile(
    r"[+-]?[\d.,'’\s]*\d[\d.,]*\s*(?:[eE][+-]?\d+|%)?|\d[\d:.,/T +-]*[\d:]Z?|nan|NaN"
)
_MOMENT = re.compile(r"\d+[-./:]\d+([-./:T ].*)?")
_MOMENT_FORMS = (
    "ISO8601", "%d.%m.%Y %H:%M:%S", "%d.%m.%Y %H:%M:%S.%f", "%d.%m.%Y %H:%M", "%Y/%m/%d %H:%M:%S",
    "%m/%d/%Y %H:%M:%S", "%m/%d/%Y %H:%M", "%m/%d/%Y %I:%M:%S %p", "%d/%m/%Y %H:%M:%S",
    "%d/%m/%Y %H:%M", "%H:%M:%S", "%H:%M:%S.%f", "%H:%M",
)  # fmt: skip

# What may stand in a head for the columns, by name, with the quantity that tells them apart.
COLUMNS: dict[str, tuple[Quantity | None, tuple[str, ...]]] = {
    "speed": (RPM, ("n", "rpm", "drehzahl", "rotational speed",
              "input speed", "antriebsdrehzahl", "eingangsdrehzahl")),
    "torque": (NEWTON_METRE, ("m", "t", "drehmoment", "moment", "input torque",
               "antriebsmoment", "eingangsmoment")),
    "temperature": (CELSIUS, ("t", "theta", "ϑ", "temp", "temperatur",
                    "oil temperature", "oil temp", "t oil", "öltemperatur",
                    "oil inlet temperature", "inlet temperature")),
    "loss": (WATT, ("losses", "power loss", "loss power", "verlust", "verlustleistung", "p loss",
             "ploss", "pv", "p v")),
    "torque_loss": (NEWTON_METRE, ("torque loss", "drag torque", "friction torque",
                    "verlustmoment", "reibmoment")),
    "torque_uncertainty": (None, ("torque uncertainty",)),
    "efficiency": (NUMBER, ("eta", "η", "wirkungsgrad")),
    "output_torque": (NEWTON_METRE, ("output torque", "torque out", "abtriebsmoment",
                      "ausgangsmoment")),
    "output_speed": (RPM, ("output speed", "speed out", "abtriebsdrehzahl",
                     "ausgangsdrehzahl")),
    "uncertainty": (None, ("unsicherheit",)),
    "component": (None, ()),
    "state": (None, ("gear", "gang")),
    "time": (SECOND, ("t", "zeit", "timestamp", "date time", "datetime", "zeitstempel", "datum")),
    "duration": (SECOND, ("dauer",)),
    "share": (None, ("anteil", "zeitanteil", "time share")),
}  # fmt: skip
_SYMBOLS = ("n", "m", "t", "theta", "ϑ", "rpm")  # Names only with the unit that makes them clear.
_TURNS = ("1/min", "min-1", "min^-1", "min⁻¹", "u/min", "upm", "r/min")
"""Units of speeds in tables, where they count turns."""


@dataclass(frozen=True, slots=True)
class TableForm:
    """How a table is to be read, where it does not say so itself."""

    # Headers of the file, with or without units, by what they are: ``{"speed [rpm]": "nMot"}``.
    columns: Mapping[str, str] = field(default_factory=dict)
    sheet: str = ""  # Of an Excel workbook. Default: the one that has a table of this kind.
    rows: tuple[int, int] | None = None  # First and last line to be read, below the head.
    decimal: str = ""  # "point" or "comma". Default: as the numbers show.


AS_IT_IS = TableForm()


def parse_form(
    columns: Iterable[str], sheet: str = "", rows: str | None = None, decimal: str = ""
) -> TableForm:
    """The form that options of a command state; raises `InputError`."""
    named, problems = {}, []
    for option in columns:
        wanted, equals, header = (part.strip() for part in option.partition("="))
        if not (wanted and equals and header):
            example = 'For example --column "speed [rpm]=nMot".'
            shown = f'"{one_line(option)}"'
            problems.append(Problem("--column", shown, "must be NAME=HEADER.", example))
        named[wanted] = header
    lines = re.fullmatch(r"\s*(\d{1,12})\s*-\s*(\d{1,12})\s*", rows or "1-1")
    if lines is None or int(lines[1]) > int(lines[2]):
        allowed = "must be the first and the last line of the file to be read."
        shown = f'"{one_line(rows or "")}"'
        problems.append(Problem("--rows", shown, allowed, "Give --rows 2-60."))
    raise_any(problems, "the command")
    first_last = (int(lines[1]), int(lines[2])) if rows and lines else None
    return TableForm(named, sheet, first_last, decimal)


@dataclass(frozen=True, slots=True)
class Piece:
    """Some rows of a table."""

    lines: NDArray[np.int64]  # Their lines in the file, or numbers in memory.
    columns: Mapping[str, pa.Array]  # By header.


@dataclass(frozen=True, slots=True)
class Source:
    """Rows in pieces that fit into memory."""

    name: str  # For messages.
    headers: tuple[str, ...]
    pieces: Callable[[Sequence[str]], Iterator[Piece]]  # Of the columns of some headers.
    place: str  # What a row is called in messages.
    decimal: str = "."  # The decimal mark of its text.
    moments: str = ""  # The form of its dates, as `pandas.to_datetime` has it.
    rows: tuple[int, int] | None = None  # First and last to be read, of all `pieces`.

    def batches(self, chosen: Sequence[str]) -> Iterator[Piece]:
        """The rows that are asked for, in columns of some headers."""
        with problems_in(self.name):
            for piece in self.pieces(chosen):
                if self.rows is not None:
                    first, last = self.rows
                    kept = (piece.lines >= first) & (piece.lines <= last)
                    columns = {name: column.filter(kept) for name, column in piece.columns.items()}
                    piece = Piece(piece.lines[kept], columns)
                if piece.lines.size:
                    yield piece


def open_table(table: Any, form: TableForm = AS_IT_IS) -> Source:
    """The rows of a file, or of columns by name such as a `pandas.DataFrame`.

    Raises `InputError` if there is no such file, or nothing that can be read as a table.
    """
    if not isinstance(table, str | Path):
        return _of_frame(table, form)
    path = Path(table)
    name, suffix = one_line(str(path), 500), path.suffix.lower()
    with problems_in(name):
        if suffix not in SUFFIXES:
            old = "Save it as .xlsx." if suffix in (".xls", ".xlsb", ".ods") else ""
            refuse(f"must end in {', '.join(SUFFIXES)}.", old or "Choose one of these formats.")
        if form.sheet and suffix not in EXCEL:
            refuse(f'has no sheet "{one_line(form.sheet)}", as it is no workbook.', "Omit --sheet.")
        if suffix in PARQUET:
            return _of_parquet(path, name, form)
        return _of_cells(_Workbook(path, form) if suffix in EXCEL else _Text(path), name, form)


MOST_ROWS = 10_000
"""Of measurements, each of which is computed; tables of more rows are recordings."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Cells of a table."""

    header: tuple[str, ...]
    # Line in the file, or row of the sheet, and its cells; as many as the header has.
    rows: tuple[tuple[int, tuple[str, ...]], ...]
    source: str  # Where it comes from.


def read_grid(
    table: Any,
    form: TableForm = AS_IT_IS,
    most: int = MOST_ROWS,
    fewer: str = "Average the records of each point.",  # What to do with more rows.
) -> Grid:
    """The cells of a file, or of a table in memory, numbers as Python writes them.

    Raises `InputError` if it cannot be read as such, is empty, or has more than `most` rows.
    """
    source = open_table(table, form)
    header = source.headers
    with problems_in(source.name):
        if not header:
            refuse("has no columns.", "Give a header such as: speed [rpm],torque [N*m],...")
        rows: list[tuple[int, tuple[str, ...]]] = []
        for piece in source.batches(header):
            columns = [
                plain_numbers(source, name, piece.columns[name]).to_pylist() for name in header
            ]
            for line, *cells in zip(piece.lines.tolist(), *columns, strict=True):
                if any(cell is not None and cell != "" for cell in cells):
                    rows.append((line, tuple(map(cell_text, cells))))
            if len(rows) > most:
                refuse(f"has more than {most} rows.", fewer)
        if not rows:
            refuse("has no rows below its header.", "Give one row for each point.")
    return Grid(header, tuple(rows), source.name)


@dataclass(frozen=True)
class _Text:
    """Cells of a text file."""

    path: Path

    @cached_property
    def encoding(self) -> str:
        """UTF-8 and UTF-16 if it is, else that of Western Windows, which has all of Latin-1."""
        start = read_bytes(self.path, _NOUN, _SAMPLE_CHARACTERS, whole=False)
        for mark, name in ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"),
                           (codecs.BOM_UTF16_BE, "utf-16")):  # fmt: skip
            if start.startswith(mark):
                return name
        if b"\0" in start:
            zeros = [start[side::2].count(0) / (len(start) / 2) for side in (0, 1)]
            if min(zeros) > 0.2 or max(zeros) < 0.8:
                refuse("is not text: it contains zero bytes.", "Save it as CSV in UTF-8.")
            return "utf-16-le" if zeros[1] > zeros[0] else "utf-16-be"
        for name in ("utf-8", "cp1252"):
            try:
                with self.path.open(encoding=name, newline="") as file:
                    while file.read(_PAGE_BYTES):
                        pass
            except UnicodeDecodeError:
                continue
            return name
        return refuse("is not text in UTF-8, UTF-16 or Latin-1.", "Save it as CSV in UTF-8.")

    @cached_property
    def start(self) -> str:
        with self.path.open(encoding=self.encoding, newline="") as file:
            text = file.read(_SAMPLE_CHARACTERS)
        if len(text) == _SAMPLE_CHARACTERS and "\n" not in text and "\r" not in text:
            refuse("cannot be read: its first line does not end.", "Write it again as CSV.")
        return text

    @cached_property
    def separator(self) -> str:
        """What divides most lines into the same number of cells; a blank stands for spaces."""
        lines = [line for line in self.start.splitlines() if line.strip(" ;,\t|")]
        lines = [line for line in lines if not line.startswith("#")][:_SAMPLE_ROWS]

        def alike(mark: str) -> int:
            counts = Counter(len(cells) for cells in csv.reader(lines, delimiter=mark))
            return max((count for size, count in counts.items() if size > 1), default=0)

        best = max(_SEPARATORS, key=alike)
        return best if alike(best) > 0 else " "

    def batches(self, size: int) -> Iterator[tuple[NDArray[np.int64], list[list[str]]]]:
        """Lines and cells of `size` rows at a time, comments and blank lines included."""
        try:
            with self.path.open(encoding=self.encoding, newline="") as file:
                if self.separator == " ":
                    done = 0
                    while some := list(islice(file, size)):
                        rows = [[one.strip('"') for one in _GAPS.findall(line)] for line in some]
                        yield np.arange(done, done + len(rows)) + 1, rows
                        done += len(rows)
                    return
                lines: Iterable[str] = file
                if "#" in self.start:  # quotes in a comment do not count
                    lines = (it.replace('"', "'") if it.startswith("#") else it for it in file)
                reader = csv.reader(lines, delimiter=self.separator, skipinitialspace=True)
                before = 0
                while rows := list(islice(reader, size)):
                    numbers = np.arange(before, before + len(rows)) + 1
                    if reader.line_num != numbers[-1]:  # cells of several lines
                        numbers += np.cumsum(["".join(row).count("\n") for row in rows])
                    before = reader.line_num
                    yield numbers, rows
        except (csv.Error, UnicodeError) as error:
            refuse(f"cannot be read: {one_line(str(error), 200)}.", "Write it again as CSV.")


@dataclass(frozen=True)
class _Workbook:
    """Cells of a sheet, with the values that formulas had when the file was saved."""

    path: Path
    form: TableForm
    separator = ","  # For messages; cells of a sheet have none.

    @cached_property
    def _book(self) -> Any:
        import openpyxl

        content = read_bytes(self.path, _NOUN, _LARGEST_WORKBOOK)
        remedy = "Save one small sheet as .xlsx, or as CSV."
        check_archive(content, "an Excel workbook", _LARGEST_WORKBOOK, remedy)
        try:
            return openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)
        except Exception as error:  # the reader raises whatever its parsers do
            refuse(f"is not a valid workbook: {one_line(str(error))}.", _SAVE_AGAIN)

    @cached_property
    def _sheet(self) -> Any:
        """The sheet that is asked for, else the only one whose head has known columns."""
        sheets = {sheet.title: sheet for sheet in self._book.worksheets}
        shown = first_of([f'"{name}"' for name in sheets], _SHOWN)
        if not sheets:
            refuse("has no sheets.", _SAVE_AGAIN)
        if self.form.sheet:
            if self.form.sheet not in sheets:
                allowed = f'has no sheet "{one_line(self.form.sheet)}"; it has {shown}.'
                refuse(allowed, "Give one of them with --sheet.")
            return sheets[self.form.sheet]
        if len(sheets) == 1:
            return next(iter(sheets.values()))
        known = [
            sheet
            for sheet in sheets.values()
            if max(_known(cells, self.form) for _, cells in islice(_rows(sheet), _HEAD_ROWS)) > 1
        ]
        if len(known) > 1:
            shown = first_of([f'"{sheet.title}"' for sheet in known], _SHOWN)
            refuse(f"has tables on the sheets {shown}.", "Choose one with --sheet NAME.")
        return known[0] if known else next(iter(sheets.values()))

    def batches(self, size: int) -> Iterator[tuple[NDArray[np.int64], list[list[str]]]]:
        """As those of a text."""
        try:
            numbered = _rows(self._sheet)
            while rows := list(islice(numbered, size)):
                yield np.array([number for number, _ in rows]), [cells for _, cells in rows]
        except InputError:
            raise
        except Exception as error:  # the reader raises whatever its parsers do
            refuse(f"is not a valid workbook: {one_line(str(error))}.", _SAVE_AGAIN)


def _rows(sheet: Any) -> Iterator[tuple[int, list[str]]]:
    for number, row in enumerate(sheet.iter_rows(), 1):
        yield number, [_shown_cell(cell) for cell in row]


def _shown_cell(cell: Any) -> str:
    """A cell of a sheet as text; numbers with all their digits, a share as it is shown."""
    value = cell.value
    if isinstance(value, float | int) and str(getattr(cell, "number_format", "")).endswith("%"):
        return f"{100 * value:.12g} %"
    return cell_text(value)


def cell_text(value: object) -> str:
    """A cell as text, numbers with all their digits."""
    text = "" if value is None else str(value).strip()
    return text.lower() if isinstance(value, bool) else text


def _of_cells(cells: _Text | _Workbook, name: str, form: TableForm) -> Source:
    lines, rows = next(cells.batches(_SAMPLE_ROWS), (np.arange(0), []))
    sample = [
        (int(line), [cell.strip() for cell in row]) for line, row in zip(lines, rows, strict=True)
    ]
    last, headers = _head(sample, form)
    width = len(headers)
    data = [(line, row) for line, row in sample if line > last and any(row) and row[0][:1] != "#"]
    mark = _decimal_mark(data, headers, cells.separator, form)
    moments = _moment_form(headers, [row for _, row in data])
    index = {header: headers.index(header) for header in headers}

    def pieces(chosen: Sequence[str]) -> Iterator[Piece]:
        import pyarrow as pa
        import pyarrow.compute as pc

        first, final = form.rows or (0, 1 << 60)
        for numbers, rows in cells.batches(_BATCH_ROWS):
            kept = (numbers > last) & (numbers >= first) & (numbers <= final)
            uniform = all(map(width.__eq__, map(len, rows)))
            if not uniform or not kept.all() or any(row[0][:1] in ("", "#", " ") for row in rows):
                # neither blank nor a comment
                whole = [any(row) and row[0].lstrip()[:1] != "#" for row in rows]
                kept &= np.array(whole, dtype=bool)
                rows = list(compress(rows, kept))
                numbers = numbers[kept]
                _check_widths(zip(numbers.tolist(), rows, strict=True), width, cells.separator)
            columns = {}
            for header in chosen:
                texts = pa.array([row[index[header]] for row in rows], pa.string())
                columns[header] = pc.utf8_trim_whitespace(texts)
            yield Piece(numbers, columns)

    return Source(name, tuple(headers), pieces, "line", mark, moments)


def _check_widths(rows: Iterable[tuple[int, list[str]]], width: int, separator: str) -> None:
    """Raise `InputError` for rows that have other cells than the head; end blanks do not count."""
    ragged = [
        (line, row)
        for line, row in rows
        if len(row) != width and len(_without_end(row, width)) != width
    ]
    if not ragged:
        return
    shown = first_of([f"line {line} has {len(row)}" for line, row in ragged], _SHOWN)
    remedy = "Give every row the same number of cells; quote cells that contain the separator."
    if separator == "," and any(len(row) > width for _, row in ragged):
        remedy = 'Write numbers without commas, or in quotes: "1,400".'
    elif all(len(row) == 1 for _, row in ragged):
        remedy = "Delete lines that are no rows, or leave them out with --rows FIRST-LAST."
    refuse(f"has {width} columns, but {shown}.", remedy)


def _without_end(cells: list[str], least: int) -> list[str]:
    """`cells` without the empty ones at the end, as spreadsheets leave them, but `least`."""
    count = len(cells)
    while count > least and not cells[count - 1].strip():
        count -= 1
    return cells[:count]


def _known(cells: Sequence[str], form: TableForm) -> int:
    """How many cells name columns."""
    asked = {_folded(header) for header in form.columns.values()}
    return sum(bool(_recognised(cell)) or _folded(cell) in asked for cell in cells)


def _head(sample: Sequence[tuple[int, list[str]]], form: TableForm) -> tuple[int, list[str]]:
    """The last line of the head, and the columns as they are called here, with their units."""
    heads = [(line, _without_end(cells, 0)) for line, cells in sample[:_HEAD_ROWS]]
    heads = [(line, cells) for line, cells in heads if any(cells)]
    comments = [
        (line, [cells[0].lstrip("# "), *cells[1:]]) for line, cells in heads if cells[0][:1] == "#"
    ]
    rows = [(line, cells) for line, cells in heads if cells[0][:1] != "#"]
    if any(len(cells) > _MOST_COLUMNS for _, cells in rows):
        refuse(f"has more than {_MOST_COLUMNS} columns.", "Keep the columns that are used.")
    place = max(range(len(rows)), key=lambda i: _known(rows[i][1], form), default=-1)
    if place < 0 or not _known(rows[place][1], form):
        named = [row for row in comments if _known(row[1], form)]
        texts = [i for i, (_, cells) in enumerate(rows) if not all(map(_VALUE.fullmatch, cells))]
        if named:
            rows, place = [named[-1], *rows], 0
        elif not texts:
            remedy = 'Start it with "speed [rpm],torque [N*m]".'
            refuse("has no line with the column names.", remedy)
        else:
            place = texts[0]
    line, names = rows[place]
    below = rows[place + 1][1] if place + 1 < len(rows) else []
    units = [""] * len(names)
    is_named = any(re.search(r"[^\W\d]|%", cell) for cell in below)
    if is_named and all(not cell or _is_unit(cell) for cell in below):
        line = rows[place + 1][0]
        units = [cell.strip("[]() ") for cell in [*below, *units]][: len(names)]
        units = ["1" if unit == "-" else unit for unit in units]
    known = [_recognised(name, unit) for name, unit in zip(names, units, strict=True)]
    found = [one[0] for one in known if one]
    if place > 0 and len(set(found)) < len(found):  # groups of columns stand in the row above
        groups, group = [*rows[place - 1][1], *names][: len(names)], ""
        for i, name in enumerate(names):
            group = groups[i] if i < len(rows[place - 1][1]) and groups[i] else group
            names[i] = f"{group} {name}".strip()
    return line, headers_of(names, form, units)


def headers_of(names: Sequence[str], form: TableForm, units: Sequence[str] = ()) -> list[str]:
    """The columns as they are called here, with their units: ``"speed [rpm]"``.

    A name of another kind stays as it is. Raises `InputError` if a column is not there that the
    form renames.
    """
    units = units or [""] * len(names)
    known = [_recognised(name, unit) for name, unit in zip(names, units, strict=True)]
    exact = {one[0] for one in known if one and one[2]}
    headers = []
    for name, unit, one in zip(names, units, known, strict=True):
        if one is None or (one[0] in exact and not one[2]):
            headers.append(_with_unit(name, unit))
        else:
            headers.append(_with_unit(*one[:2]))
    for wanted, given in form.columns.items():
        places = [i for i, name in enumerate(names) if _folded(name) == _folded(given)]
        places = places or [
            i for i, name in enumerate(names) if _folded(_parts(name)[0][0]) == _folded(given)
        ]
        if len(places) != 1:
            shown = first_of([f'"{one_line(name)}"' for name in names], 20)
            asked, allowed = f"{wanted}={one_line(given)}", f"must name one of the columns {shown}."
            raise one_problem("--column", asked, allowed, "Correct it.")
        (place,) = places
        match = HEADER.fullmatch(wanted.strip())
        base = match["name"] if match else wanted
        own = units[place] or _parts(names[place])[0][1]
        unit = (match["unit"] if match else "") or own
        if own and unit != own:
            allowed = f"has the unit [{own}] in the table, not [{unit}]."
            remedy = f'Write --column "{base}={one_line(given)}".'
            raise one_problem("--column", f"{wanted}={given}", allowed, remedy)
        new = _recognised(base, unit)
        for i, header in enumerate(headers):  # another column of that name is a label now
            if new and HEADER.sub(r"\g<name>", header) == new[0]:
                headers[i] = f"other {header}"
        headers[place] = f"{new[0] if new else base} [{new[1] if new else unit}]"
        headers[place] = headers[place].removesuffix(" []")
    return headers


def missing_remedy(verb: str, name: str, unit: str, headers: Sequence[str]) -> str:
    """What to do where no column is called `name`, with the only header that may be meant."""
    alike = [header for header in headers if name in header.lower()]
    if len(alike) != 1:
        return f'{verb} a column "{name} [{unit}]".'
    own = _parts(alike[0])[0][1]  # the unit of the file stays
    asked = f"{name if own else f'{name} [{unit}]'}={one_line(alike[0])}"
    return f'{verb} a column "{name} [{own or unit}]", or say which it is: --column "{asked}".'


def unit_problem(
    name: str, header: str, unit: str | None, quantity: Quantity | None, error: PydanticCustomError
) -> Problem:
    """The problem of a column whose unit is not read, with the one that is meant if it is clear."""
    assert quantity is not None
    wrong = sentence(error.message(), capital=False)
    allowed = wrong if unit else f"has no unit; it must be {quantity.noun}."
    shown, meant = f'"{one_line(header)}"', quantity.meant_unit(unit or "")
    if not unit or meant:
        return Problem(name, shown, allowed, f'Call it "{name} [{meant or quantity.display}]".')
    return Problem(name, shown, allowed, f"Convert it, for example to [{quantity.display}].")


def _with_unit(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit and "[" not in name else name


def _folded(text: str) -> str:
    return " ".join(text.replace("_", " ").split()).casefold()


def _parts(text: str) -> list[tuple[str, str]]:
    """Name and unit as a head may state them; the likeliest first."""
    text = " ".join(text.split())
    match = re.fullmatch(r"(.+?)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\))", text)
    if match is not None:
        return [(match[1], (match[2] or match[3] or "").strip())]
    divided = re.fullmatch(r"(.+?)(?:\s*/\s*|\s+in\s+|\s*,\s*|_)([^\s_,]+)", text)
    return [(text, ""), *([(divided[1], divided[2])] if divided else [])]


def _recognised(text: str, unit: str = "") -> tuple[str, str, bool] | None:
    """Name here, unit, and whether it is called so; None for a column of another kind."""
    parts = _parts(text)
    for name, own in parts:
        divided = len(parts) > 1 and bool(own)  # a unit without brackets, if it is one
        for known, (quantity, others) in COLUMNS.items():
            measure = own or unit
            if quantity is RPM and _folded(measure) in _TURNS:
                measure = "rpm"
            called = _folded(name) == _folded(known)
            alike = _folded(name) in others or NAMES.get(name) == known
            fits = (called or alike) and _measures(quantity, measure)  # else pint is loaded in vain
            if called and (fits or not divided):
                return known, measure, True
            if alike and (fits if measure else _folded(name) not in _SYMBOLS):
                return known, measure, False
    return None


def _measures(quantity: Quantity | None, unit: str) -> bool:
    """Whether a column of this kind may have a unit."""
    if quantity is None:
        return unit in ("", "1", "%")
    try:
        quantity.scale_from(unit)
    except PydanticCustomError:
        return False
    return True


def _is_unit(text: str) -> bool:
    text = text.strip("[]() ")
    if text in ("-", "%", "1") or _folded(text) in _TURNS:
        return True
    try:
        return not _VALUE.fullmatch(text) and one_of(text) is not None
    except Exception:  # pint's own errors have no common base
        return False


def _decimal_mark(
    rows: Sequence[tuple[int, list[str]]], headers: Sequence[str], separator: str, form: TableForm
) -> str:
    """The decimal mark of the numbers; raises `InputError` if they have both, or may have."""
    if form.decimal:
        return "," if form.decimal == "comma" else "."
    numbers = [i for i, header in enumerate(headers) if "[" in header or header in COLUMNS]
    cells = [(line, row[i]) for line, row in rows for i in numbers if i < len(row)]
    sure = {
        mark: next(((line, cell) for line, cell in cells if number.fullmatch(cell)), None)
        for mark, number in _CERTAIN.items()
    }
    point, comma = sure["."], sure[","]
    if point and comma:
        allowed = (
            f'has decimal points ("{point[1]}" in line {point[0]}) and decimal commas '
            f'("{comma[1]}" in line {comma[0]}).'
        )
        refuse(allowed, "Write all numbers alike, or choose with --decimal point or comma.")
    if point or comma:
        return "." if point else ","
    for mark, number in _OPEN.items():
        unsure = next(((line, cell) for line, cell in cells if number.fullmatch(cell)), None)
        if unsure and not (mark == "." and separator == ","):
            line, cell = unsure
            small, large = cell.replace(",", "."), cell.replace(mark, "")
            same, other = ("point", "comma") if mark == "." else ("comma", "point")
            refuse(
                f'has "{cell}" in line {line}, which may mean {small} or {large}.',
                f"Say --decimal {same} for {small}, --decimal {other} for {large}.",
            )
    return "."


def plain_numbers(source: Source, header: str, column: pa.Array) -> pa.Array:
    """Cells of a column as plain numbers where they are any, times of day in seconds."""
    import pyarrow as pa
    import pyarrow.compute as pc

    if not pa.types.is_string(column.type):
        return column
    if source.moments and header == _TIME_OF_DATES:
        return pa.array(_seconds(column.to_pylist(), source.moments), from_pandas=True)
    if header.endswith("[%]") or header == "share":
        column = pc.replace_substring_regex(column, r"\s*%$", "")
    marked = pc.match_substring_regex(column, rf"[,%{_SPACES}]")
    if source.decimal == "." and not pc.any(marked).as_py():
        return column
    other = "," if source.decimal == "." else r"\."
    own = rf"\{source.decimal}"
    whole = rf"(\d{{1,3}}([{other}{_SPACES}]\d{{3}})+|\d+)"
    number = rf"^[+-]?({whole}({own}\d*)?|{own}\d+)([eE][+-]?\d+)?\s*%?$"
    fits = pc.match_substring_regex(column, number)
    if source.decimal == ",":
        wrong = pc.and_(pc.match_substring_regex(column, r"^[+-]?\d*\.\d+$"), pc.invert(fits))
        beside = pc.binary_join_element_wise(column, "beside decimal commas", " ")
        column = pc.if_else(wrong, beside, column)
    bare = pc.replace_substring_regex(column, f"[{other}{_SPACES}]", "")
    bare = pc.replace_substring(bare, source.decimal, ".")
    return pc.if_else(fits, bare, column)


def _seconds(cells: Sequence[str], form: str) -> FloatArray:
    """Dates and times in seconds; NaN for other text."""
    import pandas as pd

    moments = pd.to_datetime(pd.Series(cells), format=form, utc=True, errors="coerce")
    return np.array((moments - pd.Timestamp(0, tz="UTC")) / pd.Timedelta(seconds=1), dtype=float)


def _moment_form(headers: list[str], rows: Sequence[Sequence[str]]) -> str:
    """The form of the dates or times of a column of time; renames it. Empty if it has numbers."""
    if "time" not in headers:
        return ""
    place = headers.index("time")
    cells = [row[place] for row in rows if place < len(row) and row[place]]
    if not cells or not all(map(_MOMENT.fullmatch, cells)):
        return ""
    fitting = {form: _seconds(cells, form) for form in _MOMENT_FORMS}
    fitting = {form: read for form, read in fitting.items() if np.isfinite(read).all()}
    if not fitting:
        allowed = f'has times such as "{one_line(cells[0])}", which cannot be read.'
        refuse(allowed, 'Write them as "2021-03-12 14:05:00", or as seconds: "time [s]".')
    spans = {round(float(read[-1] - read[0]), 3) for read in fitting.values()}
    if len(spans) > 1:
        allowed = f'has dates such as "{one_line(cells[0])}", whose day and month are not clear.'
        refuse(allowed, 'Write them as "2021-03-12 14:05:00".')
    headers[place] = _TIME_OF_DATES
    return next(iter(fitting))


def _of_parquet(path: Path, name: str, form: TableForm) -> Source:
    import pyarrow as pa
    import pyarrow.parquet as pq

    def opened() -> Any:
        # a row group may hold all rows: it is read as its pages are needed, not as a whole
        return pq.ParquetFile(path, pre_buffer=False, buffer_size=_PAGE_BYTES)

    read_bytes(path, _NOUN, 1, whole=False)  # raises for a folder or a pipe
    try:
        with opened() as file:
            names = tuple(file.schema_arrow.names)
    except (pa.ArrowException, OSError, UnicodeError) as error:
        reason = one_line(str(error), 200).rstrip(".")
        refuse(f"is not a valid Parquet file: {reason}.", "Write it again, or as CSV.")
    headers = headers_of(names, form)
    own = dict(zip(headers, names, strict=True))

    def pieces(chosen: Sequence[str]) -> Iterator[Piece]:
        try:
            with opened() as file:
                done = 0
                wanted = list(dict.fromkeys(own[header] for header in chosen))
                for batch in file.iter_batches(_BATCH_ROWS, columns=wanted):
                    columns = {
                        header: _cells(header, batch.column(own[header])) for header in chosen
                    }
                    yield Piece(np.arange(done, done + batch.num_rows) + 1, columns)
                    done += batch.num_rows
        except (pa.ArrowException, OSError, UnicodeError) as error:
            refuse(f"cannot be read: {one_line(str(error), 200)}.", "Write it again.")

    return Source(name, tuple(headers), pieces, "row", rows=form.rows)


_PER_SECOND = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}


def _cells(header: str, column: pa.Array) -> pa.Array:
    """A column of numbers or texts; dates of a column of time in seconds, all others as text."""
    import pyarrow as pa
    import pyarrow.compute as pc

    kind = column.type
    if pa.types.is_dictionary(kind) and not pa.types.is_string(kind.value_type):
        return _cells(header, column.dictionary_decode())
    if pa.types.is_nested(kind):
        return pa.array([str(kind)] * len(column))
    if not pa.types.is_temporal(kind):
        return column
    if header.startswith(("time", "duration")) and hasattr(kind, "unit"):
        counts = column.cast(pa.int32() if kind.bit_width == 32 else pa.int64())
        # to a part in 2^53
        return pc.divide(counts.cast(pa.float64(), safe=False), _PER_SECOND[kind.unit])
    texts = column.cast(pa.string())
    if pa.types.is_duration(kind):  # else a bare number
        return pc.binary_join_element_wise(texts, kind.unit, " ")
    return texts


def _of_frame(table: Any, form: TableForm) -> Source:
    import pandas as pd
    import pyarrow as pa

    try:
        frame = table if isinstance(table, pd.DataFrame) else pd.DataFrame(table)
    except (TypeError, ValueError) as error:
        allowed = f"is not a table: {one_line(str(error))}."
        raise one_problem("", "", allowed, "Give a file.", "the table") from None
    columns = []
    for position in range(frame.shape[1]):
        values = frame.iloc[:, position]
        try:
            columns.append(pa.array(values, from_pandas=True))
        except pa.ArrowException:  # values of several kinds
            columns.append(pa.array(values.astype(str)))
    headers = headers_of([str(header) for header in frame.columns], form)

    def pieces(chosen: Sequence[str]) -> Iterator[Piece]:
        for start in range(0, len(frame), _BATCH_ROWS):
            own = {header: columns[headers.index(header)] for header in chosen}
            cells = {it: _cells(it, column.slice(start, _BATCH_ROWS)) for it, column in own.items()}
            yield Piece(np.arange(start, min(start + _BATCH_ROWS, len(frame))) + 1, cells)

    return Source("the table", tuple(headers), pieces, "row", rows=form.rows)
