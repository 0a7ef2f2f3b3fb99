"""Maps as Excel workbooks and as MATLAB files."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.errors import Problem, Status, printable
from epicyclic.schema.read import flattened
from epicyclic.study.maps.formats import Format
from epicyclic.study.maps.tables import statements
from epicyclic.study.operating import PLANE, STATE
from epicyclic.units import format_number, unit_text

if TYPE_CHECKING:
    import xarray as xr

_MOST_ROWS = 1_048_574  # Rows of a sheet of Excel below the two of names and units.
_LONG_TEXT = ("warnings",)  # Variables that are too long for a cell to be read in.


def workbook_problems(axes: Mapping[str, Sequence[Any]]) -> list[Problem]:
    """More points than a sheet has rows; every state has its own."""
    count = int(np.prod([len(values) for name, values in axes.items() if name != STATE]))
    if count <= _MOST_ROWS:
        return []
    allowed = f"have {count} points; an Excel sheet holds {_MOST_ROWS}."
    return [Problem("all axes", "", allowed, "Give fewer values, or write .parquet.")]


def write_workbook(data: xr.Dataset, path: Path) -> None:
    """Sheets: the map with a row of names and a row of units, the inputs, what the numbers mean.

    A train has an overview of its states, and a sheet for each of them.
    """
    from openpyxl import Workbook

    book = Workbook(write_only=True)
    if STATE in data.dims:
        overview = book.create_sheet("overview")
        for row in _overview(data):
            _append(overview, row)
        for number, state in enumerate(data[STATE].values):
            own = data.sel({STATE: state})
            _append_map(book, _sheet_name(str(state), number), data.sel({STATE: [state]}))
            _append_matrices(book, own, f"{state}, ")
    else:
        _append_map(book, "map", data)
        _append_matrices(book, data)
    inputs = book.create_sheet("inputs")
    _append(inputs, ["key", "value"])
    for key, value in flattened(json.loads(data.attrs["case"])):
        _append(inputs, [key, json.dumps(value) if isinstance(value, list) else value])
    about = book.create_sheet("about")
    for key, text in statements(data).items():
        _append(about, [key, text])
    _append(about, ["versions", data.attrs["versions"]])
    book.save(path)


def _append_map(book: Any, name: str, data: xr.Dataset) -> None:
    sheet = book.create_sheet(name)
    sheet.freeze_panes = "A3"
    table = data.drop_vars(_LONG_TEXT).to_dataframe().reset_index()
    _append(sheet, table.columns)
    _append(sheet, [_unit(data, str(name)) for name in table.columns])
    for row in table.itertuples(index=False, name=None):
        _append(sheet, row)


def _append_matrices(book: Any, data: xr.Dataset, prefix: str = "") -> None:
    """A sheet for each temperature: loss and efficiency over speed and torque, and a chart."""
    further = {name for name in data["total"].dims if name not in (*PLANE, "temperature")}
    if any(data.sizes[name] > 1 for name in further):
        return
    plane = data[list(_MATRICES)].squeeze(list(further))
    for celsius in data["temperature"].values if "temperature" in data.dims else [None]:
        oil = "" if celsius is None else f"oil at {format_number(float(celsius))} °C"
        at = plane if celsius is None else plane.sel(temperature=celsius)
        title = _NOT_IN_TITLES.sub("_", printable(f"{prefix}{oil or 'speed by torque'}"))
        sheet = book.create_sheet(title[:31])
        sheet.freeze_panes = "B1"
        for number, (name, style) in enumerate(_MATRICES.items()):
            first = 2 + number * (3 + at.sizes["speed"])
            _append_matrix(sheet, at[name].transpose(*PLANE), first, style)
        _add_chart(sheet, at.sizes["speed"], at.sizes["torque"], oil)


_MATRICES = {"total": ("0.0", "FFFFFF", "F8696B"), "efficiency": ("0.00%", "F8696B", "63BE7B")}
"""Variables, their number formats, and the colours of their smallest and largest values."""
_MOST_LINES = 8  # Of a chart; the speeds are spread over all.


def _append_matrix(sheet: Any, values: xr.DataArray, first: int, style: tuple[str, ...]) -> None:
    """A row of torques, and a row for each speed; `first` is the line of the torques."""
    from openpyxl.formatting.rule import ColorScaleRule
    from openpyxl.utils import get_column_letter

    label, unit = str(values.attrs["long_name"]), str(values.attrs.get("units", "1"))
    _append(sheet, [f"{label}{'' if unit == '1' else f', {unit_text(unit)}'}"])
    torques = [float(value) for value in values["torque"]]
    _append(sheet, ["speed, rpm \\ torque, N·m", *torques], "General")
    for speed, row in zip(values["speed"].values, values.values, strict=True):
        _append(sheet, [float(speed), *map(float, row)], style[0])
    _append(sheet, [])
    last = f"{get_column_letter(1 + len(torques))}{first + values.sizes['speed']}"
    low, high = style[1:]
    rule = ColorScaleRule(start_type="min", start_color=low, end_type="max", end_color=high)
    sheet.conditional_formatting.add(f"B{first + 1}:{last}", rule)


def _add_chart(sheet: Any, speeds: int, torques: int, oil: str) -> None:
    """Total loss over torque, a line for each of some speeds, to the right of the numbers."""
    from openpyxl.chart import Reference, ScatterChart, Series
    from openpyxl.chart.data_source import StrRef
    from openpyxl.chart.series import SeriesLabel
    from openpyxl.utils import get_column_letter

    chart = ScatterChart(scatterStyle="lineMarker")
    chart.title = f"Total loss, {oil}".rstrip(", ")
    chart.x_axis.title, chart.y_axis.title = "torque, N·m", "total loss, W"
    chart.x_axis.delete = chart.y_axis.delete = False  # else Excel shows no numbers
    chart.width, chart.height = 24, 13
    over = Reference(sheet, min_col=2, max_col=1 + torques, min_row=2)
    for place in np.unique(np.linspace(0, speeds - 1, min(speeds, _MOST_LINES)).round()):
        row = 3 + int(place)
        values = Reference(sheet, min_col=2, max_col=1 + torques, min_row=row)
        line = Series(values, over)
        line.tx = SeriesLabel(strRef=StrRef(f"'{sheet.title}'!$A${row}"))
        chart.series.append(line)
    sheet.add_chart(chart, f"{get_column_letter(torques + 3)}2")


_NOT_IN_TITLES = re.compile(r"[\[\]:*?/\\']")


def _sheet_name(state: str, number: int) -> str:
    """A name that Excel takes, of 31 characters at most; with the number where it is cut."""
    name = _NOT_IN_TITLES.sub("_", printable(f"state {state}"))
    return name if name == f"state {state}" and len(name) <= 31 else f"{name[:25]} ({number + 1})"


def _overview(data: xr.Dataset) -> Iterator[Sequence[Any]]:
    """One row for each state: its ratio, brakes and clutches, and its best point."""
    states = json.loads(data.attrs["case"]).get("states", {})
    yield ["state", "ratio", "fixed", "joined", "points", "failed", "highest efficiency"]
    for name in map(str, data[STATE].values):
        own = data.sel({STATE: name})
        table = states.get(name, {})
        yield [
            name,
            float(own["ratio"].max()),
            ", ".join(table.get("fixed", ())),
            "; ".join(" + ".join(group) for group in table.get("joined", ())),
            own["total"].size,
            int((own["status"] != Status.CONVERGED).sum()),
            float(own["efficiency"].max()),
        ]


def _append(sheet: Any, row: Sequence[Any], style: str = "") -> None:
    """A row of numbers and text; text that looks like a formula stays text, NaN is empty.

    With a number format, `style`, for all numbers but the first.
    """
    from openpyxl.cell import WriteOnlyCell
    from openpyxl.cell.cell import ILLEGAL_CHARACTERS_RE

    cells = []
    for value in row:
        if isinstance(value, str):
            cell = WriteOnlyCell(sheet, ILLEGAL_CHARACTERS_RE.sub("", value))
            cell.data_type = "s"
            cells.append(cell)
        elif value != value:  # only NaN differs from itself
            cells.append(None)
        elif style and cells:
            cell = WriteOnlyCell(sheet, value)
            cell.number_format = style
            cells.append(cell)
        else:
            cells.append(value)
    sheet.append(cells)


def _unit(data: xr.Dataset, name: str) -> str:
    return str(data[name].attrs.get("units", ""))


def write_matlab(data: xr.Dataset, path: Path) -> None:
    """A struct ``loss_map``: axes, variables over them, their units, and what the numbers mean."""
    from scipy.io import savemat

    content: dict[str, Any] = {_field(name): _matlab(data[name].values) for name in data.variables}
    content["dimensions"] = _matlab(np.array(data["torque_loss"].dims, dtype=object))
    content["units"] = {_field(name): _unit(data, str(name)) for name in data.variables}
    content["about"] = dict(data.attrs)
    with path.open("wb") as file:
        savemat(file, {"loss_map": content}, long_field_names=True, oned_as="column")


def _matlab(values: Any) -> Any:
    """Numbers as they are, text as a cell array."""
    return values.astype(object) if values.dtype.kind in "OU" else values


def _field(name: object) -> str:
    """The name of a variable as that of a field of a struct."""
    text = re.sub(r"\W", "_", str(name), flags=re.ASCII)
    return text if text[:1].isalpha() else f"x{text}"


EXCEL = Format(".xlsx", "Excel workbook", write_workbook, workbook_problems)
MATLAB = Format(".mat", "MATLAB", write_matlab)
