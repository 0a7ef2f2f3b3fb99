"""What design and relief show and write: tables, pictures, files."""

from __future__ import annotations

import io
import json
import math
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from pydantic import TypeAdapter, ValidationError
from rich.console import Console, RenderableType

from epicyclic.dataclass import dataclass
from epicyclic.errors import one_problem
from epicyclic.files import whole_file, write_file
from epicyclic.netcdf_file import read_groups
from epicyclic.plugins.design.candidates import SHARED, case_tables, teeth_text
from epicyclic.plugins.design.search import (
    ENOUGH_SOLVED,
    KNOWN,
    LIKELY,
    LOSS_MARGIN,
    SAFETIES,
    Found,
    case_text,
    search,
)
from epicyclic.plugins.design.tables import mass_table, strength_tables
from epicyclic.plugins.design.task import read_task, task_tables
from epicyclic.result.result import in_words
from epicyclic.show.data_sheet import data_sheet
from epicyclic.show.page import Cell, Drawing, Listing, Table, number
from epicyclic.show.plots.catalogue import Panel, drawing
from epicyclic.show.plots.style import figure_bytes, styled_figure
from epicyclic.show.terminal import as_on_page, spaced
from epicyclic.study.maps.cycle import SUMS_TO_ONE, shares_text
from epicyclic.study.sweeps.run import write_netcdf
from epicyclic.study.sweeps.runner import Runner
from epicyclic.units import Length

if TYPE_CHECKING:
    import xarray as xr

SHOWN = {
    "loss": ("loss [W]", 1.0), "mass": ("mass [kg]", 1.0), "diameter": ("diameter [mm]", 1e3),
    "width": ("width [mm]", 1e3), "transmission_error": ("transmission error [um]", 1.0),
    "pressure": ("pressure [GPa]", 1.0), "flash": ("flash temperature [K]", 1.0),
    "bearing_life": ("bearing life [h]", 1.0),
}  # fmt: skip

FRONT = "not beaten"


def fates_table(found: Found) -> Table:
    """How many candidates ended how."""
    rows = tuple(
        (Cell(fate), number(count, "", text=f"{count:,}")) for fate, count in found.fates.items()
    )
    notes = []
    if found.combinations > len(found.table):
        notes.append(f"Drawn from {found.combinations:,} combinations.")
    if LIKELY in found.fates:
        notes.append(
            f"Probably beaten: a solved design is better even if they lose only {LOSS_MARGIN:.0%} "
            f"of what {ENOUGH_SOLVED} or more solved designs of their arrangement suggest."
        )
    shares = [point.share for point in found.task.cycle]
    whole, stated = sum(shares), any(share != 1 for share in shares)
    if stated and not math.isclose(whole, 1.0, rel_tol=SUMS_TO_ONE):
        notes.append(f"In the cycle {shares_text(whole)}.")
    total = (Cell("candidates"), number(len(found.table), "", text=f"{len(found.table):,}"))
    return Table(
        ("what became of them", "number"),
        (*rows, total),
        f"Candidates of {found.task.title or 'the task'}",
        frozenset({len(rows)}),
        note=" ".join(notes),
    )


def tables(found: Found, sentences: Sequence[str]) -> RenderableType:
    """Counts, the front, and the odds."""
    parts: list[RenderableType] = [*map(as_on_page, (fates_table(found), front_table(found)))]
    if sentences:
        parts.append(as_on_page(Listing(tuple(sentences), "Odds")))
    return spaced(*parts)


def front_table(found: Found) -> Table:
    """The designs that no other one beats."""
    objectives = found.task.search.objectives
    safeties = [name for name in SAFETIES if found.table.loc[found.fronts, name].notna().any()]
    rows = []
    for place in found.fronts:
        row = found.table.loc[place]
        mark = " *" if place in found.chosen else ""
        rows.append(
            (
                Cell(f"{place}{mark}"),
                Cell(f"{row['arrangement']} {teeth_text(row)}"),
                number(float(row["planets"]), ""),
                number(1e3 * float(row["module"]), ""),
                number(float(np.degrees(row["helix"])), ""),
                *(number(SHOWN[it][1] * float(row[it]), "") for it in objectives),
                *(number(float(row[it]), "", 3) for it in safeties),
            )
        )
    head = (
        "design", "gears", "planets", "m_n [mm]", "helix [°]",
        *(SHOWN[it][0] for it in objectives), *(SHOWN.get(it, (it,))[0] for it in safeties),
    )  # fmt: skip
    note = "* chosen and written. Mass is that of the gears as discs."
    return Table(head, tuple(rows), "Pareto-optimal designs", note=note)


def as_json(found: Found, sentences: Sequence[str]) -> str:
    """Counts, the front and the odds."""
    front = json.loads(found.table.loc[found.fronts].to_json(orient="index"))
    content = {
        "title": found.task.title,
        "combinations": found.combinations,
        "candidates": len(found.table),
        "fates": found.fates,
        "front": {
            key: {k: v for k, v in row.items() if v is not None} for key, row in front.items()
        },
        "chosen": found.chosen,
        "odds": list(sentences),
    }
    return json.dumps(content, indent=2, ensure_ascii=False)


def write_all(found: Found, sentences: Sequence[str], folder: Path) -> Iterator[Path]:
    """Dataset, picture, cases and data sheets; their paths."""
    path = folder / "candidates.nc"
    with whole_file(path) as temporary:
        write_netcdf(found.dataset(), temporary)
    yield path
    path = folder / "front.png"
    with styled_figure(1, 1, found.task.title or "Designs") as (figure, axes):
        draw_front(found, axes[0, 0])
    write_file(path, figure_bytes(figure, "png"))
    yield path
    for place in found.chosen:
        path = folder / f"design-{place}.toml"
        write_file(path, case_text(case_tables(found.task, found.table.loc[place])))
        yield path
        case = found.case(place)
        sheet = Console(file=io.StringIO(), width=100, highlight=False, emoji=False)
        sheet.print(data_sheet(case))
        items = (*strength_tables(case, None), mass_table(case))
        sheet.print(spaced(*map(as_on_page, items)))
        path = folder / f"design-{place}.txt"
        assert isinstance(sheet.file, io.StringIO)
        lines = (line.rstrip() for line in sheet.file.getvalue().splitlines())
        write_file(path, "\n".join([case.title, "", *lines, *sentences]) + "\n")
        yield path


def draw_front(found: Found, ax: Axes) -> Axes:
    """The first two objectives of all solved designs, those of the front marked."""
    one, two = (*found.task.search.objectives, "mass", "loss")[:2]
    for (name, rows), marker in zip(front_groups(found).items(), "xoo", strict=True):
        line, alpha = ("-", 1.0) if name == FRONT else ("none", 0.45)
        places = SHOWN[one][1] * rows[one], SHOWN[two][1] * rows[two]
        ax.plot(*places, marker=marker, linestyle=line, alpha=alpha, label=name)
    for turn, place in enumerate(found.chosen):  # labels above and below in turn
        row = found.table.loc[place]
        at = (SHOWN[one][1] * row[one], SHOWN[two][1] * row[two])
        ax.annotate(f"{place}", at, textcoords="offset points", xytext=(6, 6 - 18 * (turn % 2)))
    ax.set(xlabel=SHOWN[one][0], ylabel=SHOWN[two][0])
    ax.legend()
    return ax


def front_groups(found: Found) -> dict[str, pd.DataFrame]:
    """Solved designs as pictures show them, in this order."""
    table = found.table[found.table["loss"].notna()]
    met = table["fate"].isin(["front", "dominated"])
    front = table.loc[found.fronts].sort_values(found.task.search.objectives[0])
    return {"miss a limit": table[~met], "meet all limits": table[met], FRONT: front}


# The front of a search, just made or stored, as a chart whose points are designs.

SIZE = (7.0, 4.6)  # [inch]


@dataclass(frozen=True, slots=True)
class Front:
    """What a page shows of a search."""

    title: str
    chart: Drawing  # The numbers of the designs are in its ``customdata``.
    tables: tuple[Table, ...]
    cases: dict[int, str]  # Case files of the designs in the chart.


def found_in(path: Path, progress: Callable[[int, int], None]) -> Front:
    """The front of a task, whose search begins, or of the dataset of one that has ended."""
    if path.suffix == ".toml":
        return front_of(search(read_task(path), task_tables(path)[0], Runner(), progress=progress))
    return front_of(stored(path))


def stored(path: Path) -> Found:
    """The search whose dataset 'epicyclic design -o' has written; `InputError` for other files."""
    try:
        data = read_groups(path)[""]
        raw = json.loads(str(data.attrs.get("task", "")))
    except ValueError:
        raw = None
    needed = {"fate", "arrangement", "loss", "bound", *KNOWN, *SAFETIES, *SHARED}
    if not isinstance(raw, dict) or not needed <= set(data.data_vars):
        remedy = "Give candidates.nc of 'epicyclic design -o'."
        raise one_problem("", path.name, "is no dataset of designs.", remedy, path.name)
    table = data.to_dataframe()
    fronts = [int(it) for it in table.index[table["fate"] == "front"]]
    chosen = [it for it in fronts if str(it) in str(data.attrs.get("chosen", "")).split(", ")]
    return Found(read_task(raw), table, pd.DataFrame(), fronts=fronts, chosen=chosen, raw=raw)


def front_of(found: Found) -> Front:
    """The chart of a search, its tables, and the cases behind its points."""
    groups = front_groups(found)
    title = found.task.title or "Designs"
    made = drawing(Panel("", lambda ax: draw_front(found, ax)), "front", SIZE, is_live=True)
    assert made.plot is not None
    for trace in made.plot["data"]:
        rows = groups[trace["name"]]
        trace |= {
            "customdata": rows.index.tolist(),
            "text": [_hover(found, number) for number in rows.index],
            "hovertemplate": "%{text}<extra>%{customdata}</extra>",
            "marker": {"size": 9},
        }
    made.plot["layout"]["showlegend"] = True
    numbers = sorted({int(it) for rows in groups.values() for it in rows.index})
    cases = {
        number: case_text(case_tables(found.task, found.table.loc[number].dropna().to_dict()))
        for number in numbers
    }
    return Front(title, made, (fates_table(found), front_table(found)), cases)


def _hover(found: Found, number: int) -> str:
    """What is told of a design where the pointer is."""
    row = found.table.loc[number]
    shape = (
        f"{row['arrangement']} {teeth_text(row)}, module {1e3 * row['module']:.4g} mm, "
        f"helix {np.degrees(row['helix']):.3g}°"
    )
    aims = (f"{SHOWN[it][0]}: {SHOWN[it][1] * row[it]:.4g}" for it in found.task.search.objectives)
    safe = (f"{SHOWN.get(it, (it,))[0]}: {row[it]:.3g}" for it in SAFETIES if not np.isnan(row[it]))
    return "<br>".join([shape, *aims, *safe, str(row["fate"])])


# Relief.


def parse_length(option: str, text: str | None) -> float:
    """A length of an option; zero without one. [m]"""
    if text is None:
        return 0.0
    try:
        return float(TypeAdapter(Length).validate_python(text))
    except ValidationError:
        remedy = 'For example "3 um".'
        raise one_problem(option, f'"{text}"', "must be a length.", remedy, "the command") from None


def variants_table(data: xr.Dataset) -> Table:
    """All variants, with bands and which are not beaten."""
    keys = [str(it) for it in data.data_vars if data[it].dtype.kind not in "fb" and it != "status"]
    names = [it for it in SHOWN if it in data]
    rows = []
    for place in range(data.sizes["variant"]):
        one = data.isel(variant=place)
        cells = [Cell(str(one[key].item())) for key in keys]
        for name in names:
            text = f"{one[name].item():.4g}"
            if f"{name}_low" in data:
                text += f" ({one[f'{name}_low'].item():.4g} to {one[f'{name}_high'].item():.4g})"
            cells.append(number(one[name].item(), "", text=text))
        rows.append((*cells, Cell("yes" if one["front"].item() else "")))
    short = [key.replace(".micro_geometry", "") for key in keys]
    head = (*short, *(f"{it.replace('_', ' ')} [{data[it].attrs['units']}]" for it in names))
    title = f"{in_words(data.attrs['mesh']).capitalize()} of {data.attrs['title']}"
    return Table((*head, "not beaten"), tuple(rows), title)


def relief_figure(data: xr.Dataset) -> Figure:
    """The first two objectives, with bands, and the front, as a line if there are only two."""
    names = [it for it in SHOWN if it in data]
    one, two = (*names, names[0])[:2]
    with styled_figure(1, 1, data.attrs["title"]) as (figure, axes):
        ax = axes[0, 0]
        bars: dict[str, Any] = {}
        for axis, name in (("xerr", one), ("yerr", two)):
            if f"{name}_low" in data:
                low, high = data[name] - data[f"{name}_low"], data[f"{name}_high"] - data[name]
                bars[axis] = np.array([low, high])
        ax.errorbar(data[one], data[two], fmt="o", alpha=0.6, label="all", **bars)
        front = data.isel(variant=np.flatnonzero(data["front"])).sortby(one)
        ax.plot(front[one], front[two], "-" if len(names) <= 2 else "s", label="not beaten")
        ax.set(xlabel=SHOWN[one][0], ylabel=SHOWN[two][0])
        ax.legend()
    return figure
