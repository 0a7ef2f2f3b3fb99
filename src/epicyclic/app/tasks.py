"""What the worker does for the app: everything that takes longer than a click."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from epicyclic.analysis.solve import solve
from epicyclic.case.case import Case
from epicyclic.case.operating import AXES, operating_line
from epicyclic.exchange.rexs.exporting import rexs_bytes
from epicyclic.exchange.rexs.file import is_rexs
from epicyclic.losses.direct import contacts_told
from epicyclic.maps.compute import loss_map
from epicyclic.plots.catalogue import PLOTS, Stored, figure_of
from epicyclic.plots.style import figure_bytes
from epicyclic.plots.turning import POSITION, Turning, turning_mesh, turning_set
from epicyclic.records.contents import contents_of, set_of
from epicyclic.records.record import ResultRecord, growing_record, sets_of
from epicyclic.report.drawings import svg_text
from epicyclic.report.map_page import map_key_figures, map_sections
from epicyclic.report.page import Drawing, KeyFigure, Section, Table
from epicyclic.report.result_page import result_section, result_sections
from epicyclic.report.result_tables import key_figures
from epicyclic.report.side_by_side import side_by_side
from epicyclic.results.result import in_words
from epicyclic.sweeps.plan import parse_vary

Progress = Callable[[int, int], None]
STILL = ("gear-set", "teeth")
"""Plots of what turns, where that is shown."""
MESH = "/"
"""Before the key of a mesh among what turns."""
FIRST, TURNS = "losses", "gears"
"""The chapter that every result has, and the one in which gears turn."""
IN_PAGE = "svg-page"
"""Format of a figure that becomes a part of the page."""
MOST_KEPT = 6


@dataclass(frozen=True, slots=True)
class Study:
    """The result of a case, or its map over speed and torque."""

    case: Case
    speed: str = ""  # Values of the map, as the command has them.
    torque: str = ""  # Values of the map, as the command has them.
    temperature: str = ""  # Values of the map, as the command has them.
    is_map: bool = field(default=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Answer:
    """What a page shows of a study; its figures have no pictures yet."""

    key_figures: list[KeyFigure]
    sections: list[Section]
    wide: frozenset[str]  # Figures of several panels.
    # What turns: sets, and meshes with a slash before the key; with its title.
    turning: dict[str, str]


_kept: dict[Study, Stored] = {}
"""Results of the last studies: their figures are drawn without computing them again."""


def _stored(study: Study, progress: Progress) -> Stored:
    if study not in _kept:
        _kept[study] = _mapped(study, progress) if study.is_map else _recorded(study, progress)
        while len(_kept) > MOST_KEPT:
            del _kept[next(iter(_kept))]
    return _kept[study]


def _recorded(study: Study, progress: Progress) -> ResultRecord:
    with contacts_told(progress):
        return growing_record(study.case)


def _mapped(study: Study, progress: Progress) -> Stored:
    texts = {"speed": study.speed, "torque": study.torque, "temperature": study.temperature}
    options = [f"{AXES[axis]}={text}" for axis, text in texts.items() if text.strip()]
    values = parse_vary(study.case, options, "map")
    return loss_map(
        study.case,
        values.get(AXES["speed"], ()),
        values.get(AXES["torque"], ()),
        values.get(AXES["temperature"]),
        resolve_zero=":" in study.torque,
        progress=progress,
    )


class _Drawings(Mapping[str, Sequence[Drawing]]):
    """The figures of what is stored, without pictures; each is looked for when it is asked for."""

    def __init__(self, found: Stored) -> None:
        self._found = found
        self.wide: set[str] = set()

    def __getitem__(self, name: str) -> Sequence[Drawing]:
        is_hidden = isinstance(self._found, ResultRecord) and name in STILL
        panels = [] if is_hidden else PLOTS[name].panels(self._found)
        if not panels:
            raise KeyError(name)
        if len(panels) > 1:
            self.wide.add(name)
        return (Drawing(name, PLOTS[name].question, ""),)

    def __iter__(self) -> Iterator[str]:
        return iter(PLOTS)

    def __len__(self) -> int:
        return len(PLOTS)


def answered(study: Study, only: str, progress: Progress) -> Answer:
    """Key figures and chapters of a study; of a result the chapter `only`, if that is not empty."""
    found = _stored(study, progress)
    drawings = _Drawings(found)
    if not isinstance(found, ResultRecord):
        figures, sections = map_key_figures(found), map_sections(found, drawings)
        return Answer(figures, sections, frozenset(drawings.wide), {})
    with contacts_told(progress):
        if only:
            sections = [result_section(found, drawings, only)]
        else:
            sections = result_sections(found, drawings)
        turns = _turning_titles(found) if only in ("", TURNS) else {}
    return Answer(key_figures(found.result), sections, frozenset(drawings.wide), turns)


def _turning_titles(found: ResultRecord) -> dict[str, str]:
    sets = {name: in_words(name) or "gears" for name in sets_of(found.group("gears"))}
    meshes = {f"{MESH}{key}": in_words(key) for key in found.group("meshes")}
    return sets | meshes


def moved(case: Case, progress: Progress) -> list[KeyFigure]:
    """Key figures of a case, and nothing that takes longer; nothing is kept."""
    return key_figures(contents_of(solve(case)))


def compared(first: Case, second: Case, names: tuple[str, str], progress: Progress) -> list[Table]:
    """Two cases side by side."""
    contents = []
    for case in (first, second):
        found = _stored(Study(case), progress)
        assert isinstance(found, ResultRecord)
        contents.append(found.result)
    return list(side_by_side(contents[0], contents[1], names))


def picture(study: Study, name: str, ending: str, progress: Progress) -> bytes:
    """A figure of a study, as a file of this type holds it."""
    figure = figure_of(_stored(study, progress), name)
    if ending == IN_PAGE:
        return svg_text(figure, name).encode()
    return figure_bytes(figure, ending)


def turning(
    case: Case, what: str, ending: str, phase: float, progress: Progress
) -> tuple[bytes, dict[str, Any]]:
    """Gears that turn, as a file at one phase, or for a page with what its script needs."""
    found = _stored(Study(case), progress)
    assert isinstance(found, ResultRecord)
    drawn = _turning(found, what, None if ending == IN_PAGE else phase)
    if ending != IN_PAGE:
        return figure_bytes(drawn.figure, ending), {}
    key = f"turning-{what.removeprefix(MESH)}"
    svg = svg_text(drawn.figure, key).encode()
    layers = [asdict(layer) | {"name": f"{key}-{layer.name}"} for layer in drawn.layers()]
    return svg, {"layers": layers, "phases": drawn.phases, "position": f"{key}-{POSITION}"}


def _turning(found: ResultRecord, what: str, phase: float | None) -> Turning:
    caption = operating_line(found.result.inputs["operation"])
    sets = sets_of(found.group("gears"))
    if not what.startswith(MESH):
        return turning_set(sets[what], found.title, caption, phase or 0.0)
    key = what.removeprefix(MESH)
    view, mesh = found.group("views")[key], found.group("meshes")[key]
    return turning_mesh(view, sets[set_of(key)], mesh, found.title, caption, phase)


def saved(case: Case, ending: str, original: str | None, progress: Progress) -> bytes:
    """The result of a case as a file of this type; of a REXS file, in a copy of the original."""
    with contacts_told(progress):
        result = solve(case)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"result{ending}"
        if is_rexs(path):
            return rexs_bytes(path, result, original, None)
        result.save(path)
        return path.read_bytes()
