"""The page: the form of a case on the left, what follows from it on the right."""

from __future__ import annotations

import asyncio
from importlib import resources
from typing import Any

from nicegui import ui

from epicyclic.app import tasks
from epicyclic.app.chapters import Chapters, key_figures
from epicyclic.app.desk import Desk
from epicyclic.app.fields import Form
from epicyclic.app.turning import TurningView
from epicyclic.app.worker import Ended, Worker
from epicyclic.case.case import Case
from epicyclic.errors import EpicyclicError

__all__ = ["Page"]

_VERBS = {"run": (), "check": (), "report": ("-o", "report.html")}
"""Commands that do what the page does, and what they need more."""


class Page:
    """What one browser shows of a desk.

    Parameters
    ----------
    desk : Desk
    worker : Worker
        That solves and draws.
    """

    def __init__(self, desk: Desk, worker: Worker) -> None:
        self.desk, self.worker = desk, worker
        self._wanted = 0

    async def build(self) -> None:
        """Make the page; results follow when they are known."""
        ui.add_css(_asset("app.css"))
        ui.add_body_html(f"<script>{_asset('turning.js')}</script>")
        with ui.header().classes("bar"):
            ui.label("Epicyclic").classes("name")
            self.title = ui.label(self.desk.title).classes("title")
            ui.space()
            ui.button("Command", icon="terminal", on_click=self._show_command).props("flat no-caps")
        with ui.element("div").classes("desk"):
            with ui.element("aside"):
                self.form = Form(self.desk, self._changed)
            with ui.element("main"):
                self.problems = ui.element("div").classes("problems")
                self._state()
                with ui.element("div") as self._results:
                    self.figures = ui.element("div").classes("key-figures")
                    self.chapters = Chapters(self._picture, TurningView(self._turning))
        ui.timer(0, self.solve, once=True)

    def _state(self) -> None:
        """What is being computed, and how to end it."""
        with ui.row().classes("state") as self.state:
            ui.spinner(size="1.2em")
            self.doing = ui.label("solving")
            self.bar = ui.linear_progress(0, show_value=False).classes("progress")
            ui.button("Cancel", on_click=self.worker.end).props("flat dense no-caps")
        self.state.set_visibility(False)

    async def _changed(self) -> None:
        """After a change of the case."""
        self.title.set_text(self.desk.title)
        self.form.show_problems()
        self.problems.clear()
        with self.problems:
            for problem in self.desk.problems:
                ui.label(str(problem)).classes("problem")
        self._results.classes(**_toggled("stale", self.desk.case is None))
        await self.solve()

    async def solve(self) -> None:
        """Solve the case as it is, and show what comes out; the last change counts."""
        case = self.desk.case
        self._wanted += 1
        own = self._wanted
        if case is None:
            return
        await asyncio.sleep(0)
        self.state.set_visibility(True)
        self.bar.set_visibility(False)
        try:
            answer = await self.worker.do(tasks.solved, case, progress=self._progress)
        except Ended:
            self._say("Ended before it was solved.")
            return
        except EpicyclicError as error:
            self._say(str(error))
            return
        finally:
            if own == self._wanted:
                self.state.set_visibility(False)
        if own == self._wanted:
            self.figures.clear()
            with self.figures:
                key_figures(answer)
            await self.chapters.show(case, answer)

    def _say(self, text: str) -> None:
        with self.problems:
            ui.label(text).classes("problem")

    def _progress(self, done: int, total: int) -> None:
        self.bar.set_visibility(total > 0)
        self.bar.set_value(done / total if total else 0)
        self.doing.set_text(f"solving: contact {done} of {total}")

    async def _picture(self, case: Case, name: str, ending: str) -> bytes:
        return bytes(await self.worker.do(tasks.picture, case, name, ending, progress=_silent))

    async def _turning(
        self, case: Case, what: str, ending: str, phase: float
    ) -> tuple[bytes, dict[str, Any]]:
        found: tuple[bytes, dict[str, Any]] = await self.worker.do(
            tasks.turning, case, what, ending, phase, progress=_silent
        )
        return found

    def _show_command(self) -> None:
        with ui.dialog() as dialog, ui.card().classes("command"):
            ui.label("The same on the command line")
            for verb, more in _VERBS.items():
                ui.code(self.desk.command(verb, *more), language="bash").classes("wrapped")
        dialog.open()


def _asset(name: str) -> str:
    """A file of the package that goes into the page."""
    return (resources.files("epicyclic.app") / name).read_text(encoding="utf-8")


def _toggled(name: str, is_on: bool) -> dict[str, str]:
    """How to give an element a class, or to take it away."""
    return {"add": name} if is_on else {"remove": name}


def _silent(done: int, total: int) -> None:
    """Progress that nobody waits for."""
