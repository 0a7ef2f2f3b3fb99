"""What the worker does for the app: everything that takes longer than a click."""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from epicyclic.case.case import Case
from epicyclic.case.operating import operating_line
from epicyclic.losses.direct import contacts_told
from epicyclic.plots.catalogue import available, figure_of
from epicyclic.plots.turning import POSITION, Turning, turning_mesh, turning_set
from epicyclic.records.contents import set_of
from epicyclic.records.record import ResultRecord, record, sets_of
from epicyclic.report.drawings import svg_text
from epicyclic.report.page import Drawing, KeyFigure, Section
from epicyclic.report.result_page import result_sections
from epicyclic.report.result_tables import key_figures
from epicyclic.results.result import in_words

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["IN_PAGE", "Answer", "picture", "solved", "turning"]

Progress = Callable[[int, int], None]
STILL = ("gear-set", "teeth")
"""Plots of what turns, where that is shown."""
MESH = "/"
"""Before the key of a mesh among what turns."""
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
    turning : dict of str to str
        What turns: sets, and meshes with a slash before the key; with its title.
    """

    key_figures: list[KeyFigure]
    sections: list[Section]
    wide: frozenset[str]
    turning: dict[str, str]


def solved(case: Case, progress: Progress) -> Answer:
    """Chapters of the result of a case."""
    with contacts_told(progress):
        found = _record(case)
    turns = _turning_titles(found)
    plots = {
        name: plot for name, plot in available(found).items() if not turns or name not in STILL
    }
    drawings = {name: (Drawing(name, plot.question, ""),) for name, plot in plots.items()}
    wide = frozenset(name for name, plot in plots.items() if len(plot.panels(found)) > 1)
    return Answer(key_figures(found.result), result_sections(found, drawings), wide, turns)


def _turning_titles(found: ResultRecord) -> dict[str, str]:
    sets = {name: in_words(name) or "Gears" for name in sets_of(found.group("gears"))}
    meshes = {f"{MESH}{key}": in_words(key) for key in found.group("meshes")}
    return sets | meshes


def picture(case: Case, name: str, ending: str, progress: Progress) -> bytes:
    """A figure of the result of a case, as a file of this type holds it."""
    figure = figure_of(_record(case), name)
    if ending == IN_PAGE:
        return svg_text(figure, name).encode()
    return _file(figure, ending)


def turning(
    case: Case, what: str, ending: str, phase: float, progress: Progress
) -> tuple[bytes, dict[str, Any]]:
    """Gears that turn as a file at one phase, or for a page at all, with what its script needs."""
    drawn = _turning(_record(case), what, None if ending == IN_PAGE else phase)
    if ending != IN_PAGE:
        return _file(drawn.figure, ending), {}
    key = f"turning-{what.replace(MESH, '')}"
    svg = svg_text(drawn.figure, key).encode()
    layers = [asdict(layer) | {"name": f"{key}-{layer.name}"} for layer in drawn.layers()]
    position = f"{key}-{POSITION}"
    return svg, {"layers": layers, "phases": drawn.phases, "position": position}


def _turning(found: ResultRecord, what: str, phase: float | None) -> Turning:
    caption = operating_line(found.result.inputs["operation"])
    sets = sets_of(found.group("gears"))
    if not what.startswith(MESH):
        return turning_set(sets[what], found.title, caption, phase or 0.0)
    key = what.removeprefix(MESH)
    view, mesh = found.group("views")[key], found.group("meshes")[key]
    return turning_mesh(view, sets[set_of(key)], mesh, found.title, caption, phase)


def _file(figure: Figure, ending: str) -> bytes:
    file = io.BytesIO()
    figure.savefig(file, format=ending)
    return file.getvalue()


@lru_cache(maxsize=4)
def _record(case: Case) -> ResultRecord:
    return record(case)
