"""The page: the form of a case on the left, what follows from it on the right."""

from __future__ import annotations

import asyncio
from importlib import resources
from typing import Any

from nicegui import ui

from epicyclic.app import tasks
from epicyclic.app.chapters import Chapters, View
from epicyclic.app.desk import Desk
from epicyclic.app.fields import Form
from epicyclic.app.files import ask_for_case, save_menu
from epicyclic.app.latest import Latest
from epicyclic.app.sheet import key_figures, mark_behind
from epicyclic.app.shelves import Shelf
from epicyclic.app.state import Doing
from epicyclic.app.tasks import Study
from epicyclic.app.views import CompareView, MapView
from epicyclic.app.worker import Ended
from epicyclic.errors import EpicyclicError

_VERBS = {"run": (), "check": (), "report": ("-o", "report.html")}
"""Commands that do what the page does, and what they need more."""


def add_assets() -> None:
    """What the page needs before it is connected."""
    ui.add_css(_asset("app.css"))
    ui.add_body_html(f"<script>{_asset('turning.js')}</script>")


class Page:
    """What a browser shows of the open case.

    Parameters
    ----------
    shelf : Shelf
    """

    def __init__(self, shelf: Shelf) -> None:
        self._shelf = shelf
        self._is_moving = False
        self._quick = Latest(self._follow_figures)
        self._slow = Latest(self._follow_chapters)

    @property
    def desk(self) -> Desk:
        """The open case."""
        return self._shelf.desk

    def build(self) -> None:
        """Make the page; results follow when they are known."""
        shelf = self._shelf
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
                self._failed = ui.label().classes("problem")
                self._failed.set_visibility(False)
                with ui.element("div") as self._results:
                    self._figures = ui.element("div").classes("key-figures")
                    self._doing = Doing(shelf.slow.end)
                    views: dict[str, View] = {
                        "map": MapView(lambda: self.desk, shelf.maps),
                        "compare": CompareView(lambda: self.desk, self._do, self._choose),
                    }
                    self._chapters = Chapters(shelf, self._do, views, self._slow.want)
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
        return await self._shelf.slow.do(*work, progress=self._doing.progress)

    async def _changed(self) -> None:
        """After a change of the case."""
        self._is_moving = False
        await self._follow()

    async def _moved(self) -> None:
        """While an input moves."""
        self._is_moving = True
        await self._follow()

    async def _follow(self) -> None:
        self._tell()
        if self.desk.case is not None:
            self._chapters.age(Study(self.desk.case))
            await asyncio.gather(self._quick.want(), self._slow.want())

    def _tell(self) -> None:
        """Title and problems of the case as it is."""
        self._title.set_text(self.desk.title)
        self._form.show_problems()
        self._problems.clear()
        with self._problems:
            for problem in self.desk.problems:
                ui.label(str(problem)).classes("problem")
        self._fail("")
        self._results.classes(**{"add" if self.desk.problems else "remove": "stale"})
        mark_behind(self._figures, self.desk.case is not None)

    async def _follow_figures(self) -> None:
        """Key figures of the case as it is."""
        desk, case = self.desk, self.desk.case
        if case is None:
            return
        try:
            figures = await self._shelf.quick.do(tasks.moved, case, progress=self._doing.progress)
        except (Ended, EpicyclicError):
            return  # what follows the chapters says it
        if self._figures.is_deleted or desk is not self.desk:
            return
        self._figures.clear()
        with self._figures:
            key_figures(figures)
        mark_behind(self._figures, case is not self.desk.case)

    async def _follow_chapters(self) -> None:
        """All else of the case as it is."""
        case = self.desk.case
        if case is None:
            return
        self._fail("")  # what was cancelled is of an earlier case
        study = Study(case)

        def is_wanted() -> bool:
            """A picture that lags behind is better than none while an input moves."""
            return self._is_moving or case is self.desk.case

        def is_at_rest() -> bool:
            return not self._is_moving and case is self.desk.case

        try:
            with self._doing.shown("solving"):
                await self._chapters.follow(study, is_wanted)
                if is_at_rest():
                    await self._chapters.complete(study, is_at_rest)
        except (Ended, EpicyclicError) as error:
            self._fail(str(error))
        if self.desk.case is not None and not self._figures.is_deleted:
            self._chapters.age(Study(self.desk.case))

    def _fail(self, text: str) -> None:
        """Say why the case was not solved."""
        if not self._failed.is_deleted:
            self._failed.set_text(text)
            self._failed.set_visibility(bool(text))

    def _show_command(self) -> None:
        with ui.dialog() as dialog, ui.card().classes("command"):
            ui.label("The same on the command line")
            for verb, more in _VERBS.items():
                ui.code(self.desk.command(verb, *more), language="bash").classes("wrapped")
        dialog.open()


def _asset(name: str) -> str:
    """A file of the package that goes into the page."""
    return (resources.files("epicyclic.app") / name).read_text(encoding="utf-8")
