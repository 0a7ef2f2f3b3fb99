"""Tabs beside the chapters of a result: its map, and another case beside it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any

from nicegui import background_tasks, events, ui

from epicyclic.app import tasks
from epicyclic.app.desk import Desk
from epicyclic.app.form import number_in
from epicyclic.app.latest import Latest
from epicyclic.app.sheet import Do, Sheet, key_figures
from epicyclic.app.state import Doing
from epicyclic.app.tasks import Answer, Study
from epicyclic.app.worker import Ended, Worker
from epicyclic.case.operating import OPERATING, OperatingValue
from epicyclic.errors import EpicyclicError
from epicyclic.report.page import Drawing, Gallery, Section, Table

MAP_STEPS = {"speed": 9, "torque": 7}
SHOWN_TWICE = {"losses": "Where do the watts go?", "loss-sum": "How do the losses add up?"}
_TOLD = "Keep the case, change it, and come back: both stand side by side here."


class MapView:
    """Loss and efficiency over speed and torque.

    Parameters
    ----------
    desk : callable
        The desk as it is now.
    worker : Worker
        That computes the map, beside those of the page.
    """

    title = "Map"

    def __init__(self, desk: Callable[[], Desk], worker: Worker) -> None:
        self._desk, self._worker = desk, worker
        self._texts: dict[str, str] = {}
        self._known: tuple[Study, Answer] | None = None
        self._sheet: Sheet | None = None
        self._latest = Latest(self._work)
        self._is_asked = False

    async def show(self) -> None:
        """Fields for the values, and the map that was computed last."""
        form = self._desk().form()
        given = {entry.key: entry.text for entry in form.walk()}
        with ui.row().classes("values"):
            for axis, part in OPERATING.items():
                text = self._texts.get(axis) or _values(axis, part, given.get(part.key, ""))
                self._texts[axis] = text
                field = ui.input(part.label, value=text, on_change=partial(self._take, axis))
                field.props("dense outlined stack-label").mark(f"map-{axis}")
            ui.button("Compute", on_click=self._compute).props("unelevated no-caps")
        ui.label("Values as a,b,c or start:stop:count, with their unit.").classes("soft")
        self._doing = Doing(self._worker.end)
        self._failed = ui.label().classes("problem")
        self._failed.set_visibility(False)
        self._body = ui.element("div")
        self._sheet = None

    def age(self) -> None:
        """Mark a map of another case."""
        if self._known is not None and self._sheet is not None:
            now = self._desk().case
            if now is not None:
                self._sheet.age(replace(self._known[0], case=now))

    async def follow(self) -> None:
        """Show the map, computed again if it is of another case; the last change counts."""
        await self._latest.want()

    def _take(self, axis: str, event: events.ValueChangeEventArguments[str]) -> None:
        self._texts[axis] = event.value or ""

    async def _compute(self) -> None:
        if self._desk().case is None:
            ui.notify("The case has problems: mend them first.")
            return
        self._is_asked = True
        await self.follow()

    async def _work(self) -> None:
        case = self._desk().case
        is_old = self._known is not None and case not in (None, self._known[0].case)
        try:
            if case is not None and (self._is_asked or is_old):
                self._is_asked = False
                self._fail("")
                texts = (self._texts[axis].strip() for axis in OPERATING)
                study = Study(case, *texts, is_map=True)
                with self._doing.shown("points of the map"):
                    progress = self._doing.progress
                    answer = await self._worker.do(tasks.answered, study, "", progress=progress)
                self._known = study, answer
            if self._known is not None and not self._body.is_deleted:
                await self._fill(*self._known)
        except (Ended, EpicyclicError) as error:
            self._fail(str(error))

    def _fail(self, text: str) -> None:
        if not self._failed.is_deleted:
            self._failed.set_text(text)
            self._failed.set_visibility(bool(text))

    async def _fill(self, study: Study, answer: Answer) -> None:
        values = {axis: getattr(study, axis) for axis in OPERATING}
        options = [word for axis, text in values.items() if text for word in (f"--{axis}", text)]
        command = self._desk().command("map", *options, "-o", "map.nc")
        if self._sheet is None or not self._sheet.update(study, answer.sections, answer.wide):
            self._sheet = sheet = Sheet(self._do, study, answer.wide)
            self._body.clear()
            with self._body:
                self._command = ui.code(command).classes("wrapped")
                self._figures = ui.element("div").classes("key-figures")
                for section in answer.sections:
                    is_open = any(isinstance(item, Gallery) for item in section.items)
                    with ui.expansion(section.title, value=is_open).classes("group"):
                        sheet.section(section)
        self._command.set_content(command)
        self._figures.clear()
        with self._figures:
            key_figures(answer.key_figures)
        sheet = self._sheet
        sheet.age(study)
        await sheet.draw(lambda: sheet is self._sheet and not self._is_asked)

    async def _do(self, *work: Any) -> Any:
        return await self._worker.do(*work, progress=lambda done, total: None)


def _values(axis: str, part: OperatingValue, text: str) -> str:
    """Values around those of the case: from zero to twice them; its own zero or temperature."""
    now = number_in(text)
    if now is None:
        return ""
    if axis not in MAP_STEPS or not now:
        return f"{now:g} {part.unit}"
    return f"0:{2 * now:g}:{MAP_STEPS[axis]} {part.unit}"


class CompareView:
    """The case beside another one.

    Parameters
    ----------
    desk : callable
        The desk as it is now.
    do : callable
        Has a task done.
    choose : callable
        Asks for the other case, and calls what it is given with its desk.
    """

    title = "Compare"

    def __init__(
        self, desk: Callable[[], Desk], do: Do, choose: Callable[[Callable[[Desk], None]], None]
    ) -> None:
        self._desk, self._do, self._choose = desk, do, choose
        self._other: Desk | None = None
        self._sheet: Sheet | None = None
        self._latest = Latest(self._work)

    async def show(self) -> None:
        """Buttons that set the other case, and both side by side."""
        with ui.row():
            ui.button("Keep the case as it is now beside it", on_click=self._keep).props(
                "outline no-caps dense"
            )
            ui.button("Another case", on_click=lambda: self._choose(self._set)).props(
                "outline no-caps dense"
            )
        self._body = ui.element("div")
        self._sheet = None

    def age(self) -> None:
        """Mark what is of another case than that of the form."""
        now = self._desk().case
        if self._sheet is not None and now is not None:
            self._sheet.age(Study(now))

    def _keep(self) -> None:
        self._set(self._desk().copy())

    def _set(self, other: Desk) -> None:
        self._other, self._sheet = other, None
        background_tasks.create(self.follow())

    async def follow(self) -> None:
        """Both cases as they are now; the last change counts."""
        await self._latest.want()

    async def _work(self) -> None:
        now, other = self._desk(), self._other
        if self._body.is_deleted or now.case is None:
            return
        if other is None or other.case is None:
            told = _TOLD if other is None else "The other case has problems of its own."
            self._body.clear()
            with self._body:
                ui.label(told).classes("soft")
            return
        study = Study(now.case)
        try:
            tables = await self._do(tasks.compared, other.case, now.case, ("kept", "now"))
        except (Ended, EpicyclicError) as error:
            if not self._body.is_deleted:
                self._body.clear()
                with self._body:
                    ui.label(str(error)).classes("problem")
            return
        if self._body.is_deleted or other is not self._other:
            return
        drawings = tuple(Drawing(name, f"{title} Now.", "") for name, title in SHOWN_TWICE.items())
        section = Section("", "", (*tables, Gallery(drawings)))
        if self._sheet is None or not self._sheet.update(study, [section], ()):
            self._build(study, tables, drawings, other)
        self._command.set_content(now.command())
        sheet = self._sheet
        assert sheet is not None
        sheet.age(study)
        with suppress(Ended):
            await sheet.draw(lambda: sheet is self._sheet and self._desk().case is now.case)

    def _build(
        self, study: Study, tables: list[Table], drawings: Iterable[Drawing], other: Desk
    ) -> None:
        """Places for both cases."""
        assert other.case is not None
        self._sheet = sheet = Sheet(self._do, study)
        self._body.clear()
        with self._body:
            ui.label(f"kept: {other.title}").classes("soft")
            ui.code(other.command()).classes("wrapped")
            ui.label(f"now: {self._desk().title}").classes("soft")
            self._command = ui.code("").classes("wrapped")
            for table in tables:
                sheet.item(table)
            for drawing in drawings:
                with ui.element("div").classes("pair"):
                    kept = replace(drawing, title=f"{SHOWN_TWICE[drawing.name]} Kept.")
                    sheet.figure(kept, Study(other.case))
                    sheet.figure(drawing)
