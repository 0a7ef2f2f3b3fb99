"""The page: the form of a case on the left, what follows from it on the right."""

from __future__ import annotations

import time
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

from nicegui import ui

from epicyclic.app import tasks
from epicyclic.app.chapters import Chapters, View
from epicyclic.app.desk import Desk
from epicyclic.app.fields import Form
from epicyclic.app.files import ask_for_case, save_menu
from epicyclic.app.sheet import key_figures
from epicyclic.app.state import Doing
from epicyclic.app.tasks import Study
from epicyclic.app.views import CompareView, MapView
from epicyclic.app.worker import Ended, Worker
from epicyclic.errors import EpicyclicError

__all__ = ["Page", "Shelf"]

SLOW_SECONDS = 0.5
"""Figures that take longer wait until an input stands still."""
_VERBS = {"run": (), "check": (), "report": ("-o", "report.html")}
"""Commands that do what the page does, and what they need more."""


@dataclass
class Shelf:
    """What is kept while pages come and go.

    Attributes
    ----------
    desk : Desk
        The case that is open.
    worker, studies : Worker
        Solves and draws; computes maps meanwhile.
    folder : Path
        For uploaded files.
    """

    desk: Desk
    worker: Worker
    studies: Worker
    folder: Path


class Page:
    """What a browser shows of the open case.

    Parameters
    ----------
    shelf : Shelf
    """

    def __init__(self, shelf: Shelf) -> None:
        self._shelf = shelf
        self._wanted = 0
        self._is_moving = self._has_moved = False
        self._seconds: dict[str, float] = {}

    @property
    def desk(self) -> Desk:
        """The open case."""
        return self._shelf.desk

    async def build(self) -> None:
        """Make the page; results follow when they are known."""
        ui.add_css(_asset("app.css"))
        ui.add_body_html(f"<script>{_asset('turning.js')}</script>")
        with ui.header().classes("bar"):
            ui.label("Epicyclic").classes("name")
            self._title = ui.label().classes("title")
            ui.space()
            ui.button("Open", icon="folder_open", on_click=self._ask).props("flat no-caps")
            save_menu(lambda: self.desk, self._do)
            ui.button("Command", icon="terminal", on_click=self._show_command).props("flat no-caps")
        with ui.element("div").classes("desk"):
            self._form_place = ui.element("aside")
            with ui.element("main"):
                self._problems = ui.element("div").classes("problems")
                self._doing = Doing(self._shelf.worker.end)
                with ui.element("div") as self._results:
                    self._figures = ui.element("div").classes("key-figures")
                    views: dict[str, View] = {
                        "map": MapView(lambda: self.desk, self._shelf.studies),
                        "compare": CompareView(lambda: self.desk, self._do, self._choose),
                    }
                    self._chapters = Chapters(self._do, views)
        self._build_form()
        ui.timer(0, self._changed, once=True)

    def _build_form(self) -> None:
        self._form_place.clear()
        with self._form_place:
            self._form = Form(self.desk, self._changed, self._moved)

    def _ask(self) -> None:
        self._choose(self._open)

    def _choose(self, then: Any) -> None:
        ask_for_case(self._shelf.folder, then)

    def _open(self, desk: Desk) -> None:
        self._shelf.desk = desk
        self._figures.clear()
        self._chapters.clear()
        self._build_form()
        with self._results:
            ui.timer(0, self._changed, once=True)

    async def _do(self, *work: Any) -> Any:
        return await self._shelf.worker.do(*work, progress=_silent)

    async def _changed(self) -> None:
        """After a change of the case."""
        self._tell()
        await self._solve()

    def _tell(self) -> None:
        """Title and problems of the case as it is."""
        self._title.set_text(self.desk.title)
        self._form.show_problems()
        self._problems.clear()
        for problem in self.desk.problems:
            self._say(str(problem))
        is_stale = self.desk.case is None
        self._results.classes(**{"add" if is_stale else "remove": "stale"})

    async def _solve(self) -> None:
        """Solve the case as it is, and show what comes out; the last change counts."""
        case = self.desk.case
        self._wanted += 1
        own = self._wanted
        if case is None:
            return
        study = Study(case)
        try:
            with self._doing.shown("solving"):
                answer = await self._shelf.worker.do(
                    tasks.answered, study, progress=self._doing.progress
                )
        except (Ended, EpicyclicError) as error:
            self._say(str(error))
            return
        if own == self._wanted:
            self._show_figures(answer.key_figures)
            await self._chapters.show(study, answer)

    async def _moved(self) -> None:
        """While an input moves: what follows quickly, for the last of its values."""
        self._has_moved = True
        if self._is_moving:
            return
        self._is_moving = True
        try:
            while self._has_moved:
                self._has_moved = False
                self._tell()
                if self.desk.case is not None:
                    await self._follow()
        except (Ended, EpicyclicError) as error:
            self._say(str(error))
        finally:
            self._is_moving = False

    async def _follow(self) -> None:
        case = self.desk.case
        self._show_figures(await self._do(tasks.moved, case))
        place, name = self._chapters.sheet.first or (None, "")
        if place is None or (self._has_moved and self._is_slow(name)):
            return
        before = time.monotonic()
        svg = await self._do(tasks.followed, case, name)
        self._seconds[name] = time.monotonic() - before
        if svg and not place.is_deleted:
            place.set_content(svg)

    def _is_slow(self, name: str) -> bool:
        """True for a figure that would hold up the next value."""
        return self._seconds.get(name, 0.0) > SLOW_SECONDS

    def _show_figures(self, figures: Any) -> None:
        self._figures.clear()
        with self._figures:
            key_figures(figures)

    def _say(self, text: str) -> None:
        with self._problems:
            ui.label(text).classes("problem")

    def _show_command(self) -> None:
        with ui.dialog() as dialog, ui.card().classes("command"):
            ui.label("The same on the command line")
            for verb, more in _VERBS.items():
                ui.code(self.desk.command(verb, *more), language="bash").classes("wrapped")
        dialog.open()


def _asset(name: str) -> str:
    """A file of the package that goes into the page."""
    return (resources.files("epicyclic.app") / name).read_text(encoding="utf-8")


def _silent(done: int, total: int) -> None:
    """Progress that nobody waits for."""
