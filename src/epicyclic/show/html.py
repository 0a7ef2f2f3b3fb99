"""Reports as one HTML file that needs nothing else, and as PDF."""

from __future__ import annotations

import base64
import gzip
import logging
from collections.abc import Callable
from datetime import datetime
from functools import cache
from importlib import import_module
from types import ModuleType
from typing import Any

import jinja2
import xarray as xr
from markupsafe import Markup

from epicyclic.errors import one_problem
from epicyclic.show.inputs import input_tables
from epicyclic.show.page import Drawings, Item, KeyFigure, Section, gallery
from epicyclic.show.plots.catalogue import Stored, available, draw
from epicyclic.show.plots.loss_map import map_line
from epicyclic.show.plots.sweep import sweep_line, thinned
from epicyclic.show.record import ResultRecord
from epicyclic.show.result_page import (
    map_key_figures,
    map_sections,
    result_sections,
    sweep_key_figures,
    sweep_sections,
)
from epicyclic.show.summary import head_figures
from epicyclic.show.uncertainty_tables import band_figures, uncertainty_items
from epicyclic.study.bands.advice import known_of
from epicyclic.study.maps.tables import map_inputs
from epicyclic.study.operating import operating_line
from epicyclic.study.sweeps.run import is_sweep

KINDS = {
    "planetary": "Power losses of a planetary gear set",
    "gear_pair": "Power losses of a gear pair",
    "train": "Power losses of a train of gear sets",
}


def report_html(
    stored: Stored,
    progress: Callable[[int, int], None] | None = None,
    *,
    size: tuple[float, float] | None = None,
) -> str:
    """The report of a result, a loss map, a sweep or an uncertainty analysis.

    Parameters
    ----------
    stored : ResultRecord or xarray.Dataset
        As `epicyclic.record`, `loss_map`, `sweep` or `uncertainty` returns it, or
        `epicyclic.open_result`.
    progress : callable, optional
        Called with the numbers of plots drawn and to draw.
    size : tuple of float, optional
        Width and height of every figure, on which the size of its letters depends: a figure takes
        the width that the page has. Default: what suits it. [mm]

    Returns
    -------
    str
        HTML, identical for the same content, whether computed or read from a file. For a sweep
        of very many points, pictures and explorer show a part of them and say so.
    """
    tell = progress or (lambda done, total: None)
    if not isinstance(stored, ResultRecord) and is_sweep(stored):
        shown = thinned(stored)  # a page holds so many, a sweep any number
        sections = sweep_sections(stored, shown, _drawings(shown, tell, size))
        figures = sweep_key_figures(stored)
        return page_html(**_content(stored, "Sweep", sweep_line(stored), figures, sections))
    drawings = _drawings(stored, tell, size)
    if isinstance(stored, ResultRecord):
        content = _result_content(stored, drawings)
    elif "torque_loss" in stored:
        figures, sections = map_key_figures(stored), map_sections(stored, drawings)
        content = _content(stored, "Loss map", map_line(stored), figures, sections)
    else:
        cycle, inputs = str(stored.attrs.get("cycle", "")), map_inputs(stored)
        title = "Energy of a duty cycle" if "point_error" in stored else "Result"
        pictures = (*gallery(drawings, "drivers", wide=True), *gallery(drawings, "band"))
        sections = [
            Section("uncertainty", title, (*pictures, *uncertainty_items(stored))),
            Section("inputs", "Inputs", tuple(input_tables(inputs, inputs))),
        ]
        content = _content(stored, "Uncertainty", cycle, band_figures(stored), sections)
    return page_html(**content)


def page_html(**content: Any) -> str:
    """A page of its title, kind, operation, source, key figures and sections."""
    return _templates().get_template("report.html").render(**content, library=_library())


def _result_content(record: ResultRecord, drawings: Drawings) -> dict[str, Any]:
    result = record.result
    known = next(map(known_of, record.group("uncertainty").values()), None)
    created = f"{datetime.fromisoformat(record.created):%Y-%m-%d %H:%M} UTC"
    return {
        "title": record.title,
        "kind": KINDS[result.kind],
        "operation": operating_line(result.inputs["operation"]),
        "source": f"Computed {created} with epicyclic {result.versions['epicyclic']}",
        "key_figures": list(head_figures(result, known)),
        "sections": result_sections(record, drawings),
    }


def _content(
    data: xr.Dataset, what: str, line: str, figures: list[KeyFigure], sections: list[Section]
) -> dict[str, Any]:
    kind = map_inputs(data)["kind"]
    return {
        "title": str(data.attrs["title"]) or kind.replace("_", " "),
        "kind": f"{what}: {KINDS[kind]}",
        "operation": line,
        "source": f"Computed with {data.attrs['source']}",
        "key_figures": figures,
        "sections": sections,
    }


def _drawings(
    stored: Stored, progress: Callable[[int, int], None], size: tuple[float, float] | None
) -> Drawings:
    drawings = {}
    names = list(available(stored))
    for done, name in enumerate(names):
        progress(done, len(names))
        drawings[name] = draw(stored, name, size)
    return drawings


def items_html(*items: Item) -> str:
    """Tables and lists as a page has them, without the page."""
    macros = vars(_templates().get_template("items.html").module)
    return "".join(macros["render"](item) for item in items)


@cache
def _templates() -> jinja2.Environment:
    return jinja2.Environment(
        loader=jinja2.PackageLoader("epicyclic.show"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


@cache
def _library() -> Markup:
    """plotly.js, packed: 1.9 MB in place of 4.8."""
    from plotly.offline import get_plotlyjs

    return Markup(base64.b64encode(gzip.compress(get_plotlyjs().encode(), mtime=0)).decode())


# Reports as PDF: the page of `report_html`, set by WeasyPrint.


def check_pdf() -> ModuleType:
    """WeasyPrint, which is optional; raises `InputError` if it cannot be used."""
    try:
        return import_module("weasyprint")
    except (ImportError, OSError) as error:  # it needs Pango, a library of the system
        allowed = f"needs WeasyPrint, which cannot be used: {error}."
        remedy = (
            'Install it (pip install "epicyclic[pdf]"), or print the .html page from a browser.'
        )
        raise one_problem("-o", ".pdf", allowed, remedy, "the command") from None


def page_bytes(page: str, ending: str) -> bytes:
    """What a file holds of a page: the page itself, or a ``".pdf"`` of it with its still figures.

    Raises `InputError` if WeasyPrint is needed and cannot be used.
    """
    if ending != ".pdf":
        return page.encode()
    weasyprint = check_pdf()
    # it reports every property of style sheets for screens
    logging.getLogger("weasyprint").setLevel(logging.CRITICAL)
    fetcher = weasyprint.urls.URLFetcher(allowed_protocols=["data"])  # nothing from elsewhere
    pdf: bytes = weasyprint.HTML(string=page, url_fetcher=fetcher).write_pdf()
    return pdf
