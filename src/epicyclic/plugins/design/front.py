"""The front of a search, just made or stored, as a chart whose points are designs."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from epicyclic.errors import one_problem
from epicyclic.netcdf_file import read_groups
from epicyclic.plugins.design.candidates import SHARED, case_tables, teeth_text
from epicyclic.plugins.design.report import (
    SHOWN,
    draw_front,
    fates_table,
    front_groups,
    front_table,
)
from epicyclic.plugins.design.search import KNOWN, SAFETIES, Found, case_text, search
from epicyclic.plugins.design.task import read_task, task_tables
from epicyclic.show.page import Drawing, Table
from epicyclic.show.plots.catalogue import Panel, drawing
from epicyclic.study.sweeps.runner import Runner

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
