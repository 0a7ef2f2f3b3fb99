"""What `Result` offers beside its numbers, made here: tables, pictures, files, a page."""

from __future__ import annotations

from functools import lru_cache
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, cast

from epicyclic.case.case import Case
from epicyclic.errors import InputError, Problem
from epicyclic.files import check_place, whole_file
from epicyclic.records.contents import contents_of
from epicyclic.records.files import save_result
from epicyclic.records.record import ResultRecord, record
from epicyclic.report.html import items_html, report_html
from epicyclic.report.page import Listing
from epicyclic.report.pdf import check_pdf, report_pdf
from epicyclic.report.result_tables import key_figures, losses_table
from epicyclic.report.train_tables import sums_table
from epicyclic.results.result import Result
from epicyclic.show.plots.catalogue import figure_of
from epicyclic.study.operating import operating_line

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

FILES = (".nc", ".json", ".html", ".pdf")


def table(result: Result, of: str) -> pd.DataFrame:
    """`Result.table`."""
    import pandas as pd

    if of == "numbers":
        rows = [(it.key, it.value, it.unit, it.label) for it in result.numbers()]
        return pd.DataFrame(rows, columns=["key", "value", "unit", "label"]).set_index("key")
    if of != "losses":
        problem = Problem("of", f'"{of}"', 'must be "losses" or "numbers".', "Choose one.")
        raise InputError([problem], "the table")
    terms = [(it.name, it.watts, it.group, it.left_out or it.method) for it in result.terms]
    sums = ("load_dependent", "load_independent", "total")
    terms += [(name, getattr(result, name), "sum", "") for name in sums]
    losses = pd.DataFrame(terms, columns=["key", "loss [W]", "group", "method"]).set_index("key")
    share = losses["loss [W]"] / result.total if result.total else float("nan")
    losses.insert(1, "share of the total", share)
    return losses


def plot(result: Result, what: str, size: tuple[float, float] | None, dpi: float | None) -> Figure:
    """`Result.plot`."""
    return figure_of(_record_of(result), what, size=size, dpi=dpi)


def save(result: Result, path: Path) -> None:
    """`Result.save`."""
    if path.suffix not in FILES:
        allowed = f"must end in {', '.join(FILES)}."
        raise InputError([Problem("path", str(path), allowed, "Name such a file.")], "the result")
    check_place(path)
    if path.suffix == ".pdf":
        check_pdf()
    if path.suffix == ".nc":
        save_result(_record_of(result), path)
        return
    text = result.to_json() + "\n" if path.suffix == ".json" else report_html(_record_of(result))
    with whole_file(path) as file:
        if path.suffix == ".pdf":
            file.write_bytes(report_pdf(text))
        else:
            file.write_text(text, encoding="utf-8")


def html(result: Result) -> str:
    """A result in a notebook: operating point, key figures, losses, warnings."""
    contents = contents_of(result)
    figures = (f"{it.label} {it.cell.text} {it.unit}".rstrip() for it in key_figures(contents))
    lines = (operating_line(contents.inputs["operation"]), ", ".join(figures))
    title = escape(result.title or result.kind.replace("_", " "))
    losses = sums_table(contents) if result.kind == "train" else losses_table(contents)
    warnings = (Listing(contents.warnings, "Warnings"),) if contents.warnings else ()
    head = f"<p><strong>{title}</strong><br>{'<br>'.join(map(escape, lines))}</p>"
    return f"<div>{head}{items_html(losses, *warnings)}</div>"


@lru_cache(maxsize=4)
def _record_of(result: Result) -> ResultRecord:
    """The fields behind a result, which take longer than the result: several pictures need them."""
    return record(cast(Case, result.case), result=result)
