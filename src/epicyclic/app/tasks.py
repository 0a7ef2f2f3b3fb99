"""What the worker does for the app: everything that takes longer than a click."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

from epicyclic.case.case import Case
from epicyclic.losses.direct import contacts_told
from epicyclic.plots.catalogue import available, figure_of
from epicyclic.records.record import ResultRecord, record
from epicyclic.report.drawings import svg_text
from epicyclic.report.page import Drawing, KeyFigure, Section
from epicyclic.report.result_page import result_sections
from epicyclic.report.result_tables import key_figures

__all__ = ["IN_PAGE", "Answer", "picture", "solved"]

Progress = Callable[[int, int], None]
IN_PAGE = "svg-page"
"""Format of a figure that becomes a part of the page."""


@dataclass(frozen=True, slots=True)
class Answer:
    """What a page shows of a result; its figures have no pictures yet.

    Attributes
    ----------
    key_figures : list of KeyFigure
    sections : list of Section
    wide : frozenset of str
        Figures of several panels.
    """

    key_figures: list[KeyFigure]
    sections: list[Section]
    wide: frozenset[str]


def solved(case: Case, progress: Progress) -> Answer:
    """Chapters of the result of a case."""
    with contacts_told(progress):
        found = _record(case)
    plots = available(found)
    drawings = {name: (Drawing(name, plot.question, ""),) for name, plot in plots.items()}
    wide = frozenset(name for name, plot in plots.items() if len(plot.panels(found)) > 1)
    return Answer(key_figures(found.result), result_sections(found, drawings), wide)


def picture(case: Case, name: str, ending: str, progress: Progress) -> bytes:
    """A figure of the result of a case, as a file of this type holds it."""
    figure = figure_of(_record(case), name)
    if ending == IN_PAGE:
        return svg_text(figure, name).encode()
    file = io.BytesIO()
    figure.savefig(file, format=ending)
    return file.getvalue()


@lru_cache(maxsize=4)
def _record(case: Case) -> ResultRecord:
    return record(case)
