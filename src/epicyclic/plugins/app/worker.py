"""The process beside the app that solves and draws, its tasks and its progress."""

from __future__ import annotations

import asyncio
import io
import itertools
import multiprocessing
import os
import signal
import tempfile
import zipfile
from collections.abc import Awaitable, Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nicegui import ui

from epicyclic.case.case import Case
from epicyclic.dataclass import asdict, dataclass, field
from epicyclic.errors import EpicyclicError
from epicyclic.kernels import listeners
from epicyclic.losses.friction import contact_progress
from epicyclic.plugins.rexs.exporting import rexs_bytes
from epicyclic.plugins.rexs.files import is_rexs
from epicyclic.result.result import in_words, set_of
from epicyclic.show.page import Drawing, KeyFigure, Section, Table
from epicyclic.show.plots.catalogue import PLOTS, Panel, Stored, draw, drawing, figure_of, svg_text
from epicyclic.show.plots.drawing import POSITION, Turning, turning_mesh, turning_set
from epicyclic.show.plots.losses import WIDE, plot_losses_beside
from epicyclic.show.plots.style import figure_bytes, styled_figure
from epicyclic.show.record import ResultRecord, growing_record, sets_of
from epicyclic.show.result_page import (
    map_key_figures,
    map_sections,
    result_section,
    result_sections,
)
from epicyclic.show.result_tables import side_by_side
from epicyclic.show.summary import head_figures, summary_section
from epicyclic.show.uncertainty_tables import result_json
from epicyclic.show.views import save
from epicyclic.study.bands.advice import Known, known_of
from epicyclic.study.bands.study import quick_known
from epicyclic.study.maps.compute import loss_map
from epicyclic.study.maps.formats import formats, write_map
from epicyclic.study.operating import AXES, operating_line
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.run import parse_vary

if TYPE_CHECKING:
    from epicyclic.plugins.design.report import Front


class Latest:
    """Does work again after each change, for the last one: what comes meanwhile never queues.

    Work that has begun is done to its end, so that it follows a value that never stands still. It
    looks itself at what is to be done.
    """

    def __init__(self, work: Callable[[], Awaitable[None]]) -> None:
        self._work = work
        self._wanted = 0
        self._is_running = False

    async def want(self) -> None:
        """Have the work done for what is now; returns at once if it is being done for before."""
        self._wanted += 1
        if self._is_running:
            return
        self._is_running = True
        try:
            done = 0
            while done != self._wanted:
                done = self._wanted
                await self._work()
        finally:
            self._is_running = False


# A process beside the app that solves and draws: pages stay quick, and work can be ended.


Progress = Callable[[int, int], None]
"""Called with what is done and what there is to do, and with 0 for this while code is compiled."""


class EndedError(EpicyclicError):
    """The work was ended before it was done."""

    def __str__(self) -> str:
        return "Stopped before it was finished."


class WorkError(EpicyclicError):
    """An error that was not foreseen, from the other process."""


class Worker:
    """Does one thing after the other, each in the same process as long as none is ended.

    Its process stands back behind others by its niceness, on systems that know this.
    """

    def __init__(self, niceness: int = 0) -> None:
        self._niceness = niceness
        self.is_closed = False
        self._waiting = ThreadPoolExecutor(1)  # threads shared by all workers could run out
        self._process: Any = None
        self._ours: Connection | None = None
        self._lock = asyncio.Lock()

    async def do(
        self,
        task: Callable[..., Any],  # Takes `arguments` and a function that it tells its progress.
        *arguments: Any,
        progress: Progress = lambda done, total: None,  # Called in this process.
    ) -> Any:
        """What a function of a module returns, computed in the process.

        Raises `EndedError` if `end` or `close` was called meanwhile, or `close` before. Raises
        `EpicyclicError`: As the task raises it.
        """
        loop = asyncio.get_running_loop()
        async with self._lock:
            if self.is_closed:
                raise EndedError
            pipe = self._pipe()
            try:
                pipe.send((task, arguments))
                while True:
                    what, content = await loop.run_in_executor(self._waiting, pipe.recv)
                    if what == "done":
                        return content
                    if what == "failed":
                        raise content
                    progress(*content)
                    if self.is_closed:  # since then, and there is no thread to wait any more
                        raise EndedError
            except (EOFError, OSError):
                self.end()
                raise EndedError from None

    def end(self) -> None:
        """End what is being done; the next thing starts a new process."""
        if self._process is not None:
            with suppress(OSError, AttributeError):  # it has no group yet, or the system has none
                os.killpg(self._process.pid, signal.SIGTERM)  # with those it started for a map
            self._process.terminate()
            self._process = None
        self._ours = None

    def close(self) -> None:
        """End what is being done, and begin nothing more."""
        self.is_closed = True
        self.end()
        self._waiting.shutdown(wait=False)

    def _pipe(self) -> Connection:
        if self._process is None or not self._process.is_alive():
            context = multiprocessing.get_context("spawn")
            self._ours, theirs = context.Pipe()
            self._process = context.Process(target=_serve, args=(theirs, self._niceness))
            self._process.start()
            theirs.close()
        assert self._ours is not None
        return self._ours


def _serve(pipe: Connection, niceness: int) -> None:
    """What the process does: tasks until the pipe is closed."""
    if hasattr(os, "setsid"):
        os.setsid()  # a group of its own, see `Worker.end`
        os.nice(niceness)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the app ends this process
    compiled = itertools.count(1)
    listeners.append(lambda: pipe.send(("progress", (next(compiled), 0))))
    with suppress(EOFError, OSError):
        while True:
            task, arguments = pipe.recv()
            try:
                pipe.send(("done", task(*arguments, lambda *count: pipe.send(("progress", count)))))
            except EpicyclicError as error:
                pipe.send(("failed", error))
            except Exception as error:
                pipe.send(("failed", WorkError(f"{type(error).__name__}: {error}")))
    if hasattr(os, "killpg"):  # workers of a map would be waited for
        os.killpg(0, signal.SIGTERM)
    os._exit(0)


# A line that tells what is being computed, how far it is, and ends it.


class Doing:
    """The line; it is there while something is done."""

    def __init__(self, end: Callable[[], None]) -> None:
        with ui.row().classes("state idle") as self._row:
            ui.spinner(size="1.2em")
            self._label = ui.label()
            self._bar = ui.linear_progress(0, show_value=False).classes("progress")
            ui.button("Cancel", on_click=end).props("flat dense no-caps")
        self._count, self._noun = 0, ""

    @contextmanager
    def shown(self, noun: str) -> Iterator[None]:
        """Show the line while the block runs; of blocks within each other until the last ends."""
        self._noun = noun
        self._count += 1
        self._label.set_text(noun)
        self._bar.set_visibility(False)
        self._row.classes(remove="idle")
        try:
            yield
        finally:
            self._count -= 1
            if not self._count and not self._row.is_deleted:
                self._row.classes("idle")

    def progress(self, done: int, total: int) -> None:
        """Tell how far it is; without a total, functions that a first run has compiled."""
        if self._row.is_deleted:  # the page is closed, and the work not yet ended
            return
        self._bar.set_visibility(total > 0)
        self._bar.set_value(done / total if total else 0)
        first = f"first run of this version, compiling the numerics: {done} functions so far"
        self._label.set_text(f"{self._noun}: {done} of {total}" if total else first)


# What the worker does for the app: everything that takes longer than a click.


STILL = ("gear-set", "teeth")  # Plots of what turns, where that is shown.
MESH = "/"  # Before the key of a mesh among what turns.
FIRST, BANDS, TURNS = "summary", "uncertainty", "gears"
"""The chapter that every result has, that on how well it is known, and that in which gears turn."""
PAGES = (".html", ".pdf")
IN_PAGE = "svg-page"  # Format of a figure that becomes a part of the page.
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


_known: dict[Study, Known | None] = {}  # How well results are known, if that was computed.
_kept: dict[Study, Stored] = {}
"""Results of the last studies: their figures are drawn without computing them again."""


def _stored(study: Study, progress: Progress) -> Stored:
    if study not in _kept:
        _kept[study] = _mapped(study, progress) if study.is_map else _recorded(study, progress)
        while len(_kept) > MOST_KEPT:
            oldest = next(iter(_kept))
            del _kept[oldest]
            _known.pop(oldest, None)
    return _kept[study]


def _recorded(study: Study, progress: Progress) -> ResultRecord:
    with contact_progress(progress):
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
    """Key figures and chapters of a study; of a result the chapter `only`, if that is not empty.

    Bands of the key figures are those of the chapter on them, once that was asked for.
    """
    found = _stored(study, progress)
    drawings = _Drawings(found)
    if not isinstance(found, ResultRecord):
        # the explorer of a report needs its script
        sections = [it for it in map_sections(found, drawings) if not it.needs_script]
        return Answer(map_key_figures(found), sections, frozenset(drawings.wide), {})
    with contact_progress(progress):
        if only in ("", BANDS):
            _known[study] = next(map(known_of, found.group("uncertainty").values()), None)
        known = _known.get(study)
        if only == FIRST:
            sections = [summary_section(found.result, known, drawings)]
        elif only:
            sections = [result_section(found, drawings, only)]
        else:
            sections = [
                summary_section(found.result, known, drawings),
                *result_sections(found, drawings),
            ]
        turns = _turning_titles(found) if only in ("", TURNS) else {}
    figures = list(head_figures(found.result, known))
    return Answer(figures, sections, frozenset(drawings.wide), turns)


def _turning_titles(found: ResultRecord) -> dict[str, str]:
    sets = {name: in_words(name) or "gears" for name in sets_of(found.group("gears"))}
    meshes = {f"{MESH}{key}": in_words(key) for key in found.group("meshes")}
    return sets | meshes


def moved(case: Case, progress: Progress) -> list[KeyFigure]:
    """Key figures of a case, and nothing that takes longer; nothing is kept."""
    return list(head_figures(solve(case), None))


def compared(first: Case, second: Case, names: tuple[str, str], progress: Progress) -> list[Table]:
    """Two cases side by side."""
    one, two = (_record(case, progress).result for case in (first, second))
    return list(side_by_side(one, two, names))


def beside(
    first: Case, second: Case, names: tuple[str, str], ending: str, progress: Progress
) -> list[Drawing] | bytes:
    """The losses of two cases in one picture, for a page or as a file of this type holds it."""
    cases = dict(zip(names, (first, second), strict=True))
    results = {name: _record(case, progress).result for name, case in cases.items()}
    if ending == IN_PAGE:
        panel = Panel("", partial(plot_losses_beside, results))
        return [drawing(panel, "losses-beside", WIDE, is_live=True)]
    with styled_figure(1, 1, "", panel=WIDE) as (figure, axes):
        plot_losses_beside(results, axes[0, 0])
    return figure_bytes(figure, ending)


def _record(case: Case, progress: Progress) -> ResultRecord:
    found = _stored(Study(case), progress)
    assert isinstance(found, ResultRecord)
    return found


def picture(study: Study, name: str, ending: str, progress: Progress) -> list[Drawing] | bytes:
    """A figure of a study, for a page or as a file of this type holds it."""
    found = _stored(study, progress)
    if ending == IN_PAGE:
        return draw(found, name, is_live=True)
    return figure_bytes(figure_of(found, name), ending)


def turning(
    case: Case, what: str, ending: str, phase: float, progress: Progress
) -> tuple[bytes, dict[str, Any]]:
    """Gears that turn, as a file at one phase, or for a page with what its script needs."""
    found = _record(case, progress)
    point = operating_line(found.result.inputs["operation"])
    if ending != IN_PAGE:
        drawn = _turning(found, what, (found.title, point), phase)
        return figure_bytes(drawn.figure, ending), {}
    drawn = _turning(found, what, ("", ""), None)  # which stand beside it
    drawn.ax.set_title("", loc="left")
    key = f"turning-{what.removeprefix(MESH)}"
    svg = svg_text(drawn.figure, key).encode()
    layers = [asdict(layer) | {"name": f"{key}-{layer.name}"} for layer in drawn.layers()]
    position = f"{key}-{POSITION}"
    return svg, {"layers": layers, "phases": drawn.phases, "position": position, "point": point}


def _turning(
    found: ResultRecord, what: str, words: tuple[str, str], phase: float | None
) -> Turning:
    sets = sets_of(found.group("gears"))
    if not what.startswith(MESH):
        return turning_set(sets[what], *words, phase or 0.0)
    key = what.removeprefix(MESH)
    view, mesh = found.group("views")[key], found.group("meshes")[key]
    return turning_mesh(view, sets[set_of(key)], mesh, *words, phase)


def designs(path: Path, progress: Progress) -> Front:
    """The front of a search for designs."""
    from epicyclic.plugins.design.report import found_in  # only this view needs it

    return found_in(path, progress)


def saved(study: Study, name: str, original: str | None, progress: Progress) -> tuple[str, bytes]:
    """What a file of this name, or of a map's format, holds of a study, and the ending it has.

    Of a REXS file a copy of the original with the results; of a format with a file for each state,
    these in an archive.
    """
    found = _stored(study, progress)
    with tempfile.TemporaryDirectory() as folder, contact_progress(progress):
        suffix = name if name.startswith(".") else formats()[name].suffix
        path = Path(folder) / f"result{suffix}"
        if is_rexs(path):
            return path.suffix, rexs_bytes(
                path, _record(study.case, progress).result, original, None
            )
        if path.suffix in PAGES:
            from epicyclic.show.html import page_bytes, report_html  # only what is saved needs it

            path.write_bytes(page_bytes(report_html(found), path.suffix))
        elif not isinstance(found, ResultRecord):
            write_map(found, path, name)
        elif path.suffix == ".json":
            known = quick_known(study.case, found.result)
            path.write_text(f"{result_json(found.result, known)}\n", encoding="utf-8")
        else:
            save(found.result, path)
        files = list(Path(folder).iterdir())
        if len(files) == 1:
            return path.suffix, path.read_bytes()
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w") as archive:
            for file in files:
                archive.write(file, file.name)
        return ".zip", packed.getvalue()
