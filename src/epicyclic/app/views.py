"""Tabs beside the chapters of a result: its map, and another case beside it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from nicegui import events, ui

from epicyclic.app import tasks
from epicyclic.app.desk import Desk
from epicyclic.app.sheet import Do, Sheet, key_figures
from epicyclic.app.state import Doing
from epicyclic.app.tasks import Answer, Study
from epicyclic.app.worker import Ended, Worker
from epicyclic.case.operating import OPERATING, OperatingValue
from epicyclic.errors import EpicyclicError
from epicyclic.report.page import Drawing, Gallery

__all__ = ["CompareView", "MapView"]

MAP_STEPS = {"speed": 9, "torque": 7}
SHOWN_TWICE = {"losses": "Where do the watts go?", "loss-sum": "How do the losses add up?"}


class MapView:
    """Loss and efficiency over speed and torque.

    Parameters
    ----------
    desk : callable
        The desk as it is now.
    worker : Worker
        That computes the map, beside the one of the page.
    """

    title = "Map"

    def __init__(self, desk: Callable[[], Desk], worker: Worker) -> None:
        self._desk, self._worker = desk, worker
        self._texts: dict[str, str] = {}
        self._known: tuple[Study, Answer] | None = None
        self._is_following = False

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
        self._body = ui.element("div")
        if self._known is not None:
            await self._fill(*self._known)
            await self.follow()

    async def follow(self) -> None:
        """Compute a map again that was computed for another case; the last change counts."""
        if self._known is None or self._is_following:
            return
        self._is_following = True
        try:
            case = None
            while self._desk().case not in (None, self._known[0].case, case):
                case = self._desk().case
                await self._compute()
        finally:
            self._is_following = False

    def _take(self, axis: str, event: events.ValueChangeEventArguments[str]) -> None:
        self._texts[axis] = event.value or ""

    async def _compute(self) -> None:
        case = self._desk().case
        if case is None:
            ui.notify("The case has problems: mend them first.")
            return
        study = Study(case, *(self._texts[axis].strip() for axis in OPERATING))
        try:
            with self._doing.shown("points of the map"):
                answer = await self._worker.do(tasks.answered, study, progress=self._doing.progress)
        except (Ended, EpicyclicError) as error:
            self._body.clear()
            with self._body:
                ui.label(str(error)).classes("problem")
            return
        self._known = study, answer
        await self._fill(study, answer)

    async def _fill(self, study: Study, answer: Answer) -> None:
        sheet = Sheet(self._do, answer.wide)
        self._body.clear()
        with self._body:
            values = {axis: getattr(study, axis) for axis in OPERATING}
            options = [
                word for axis, text in values.items() if text for word in (f"--{axis}", text)
            ]
            ui.code(self._desk().command("map", *options, "-o", "map.nc")).classes("wrapped")
            with ui.element("div").classes("key-figures"):
                key_figures(answer.key_figures)
            for section in answer.sections:
                is_open = any(isinstance(item, Gallery) for item in section.items)
                with ui.expansion(section.title, value=is_open).classes("group"):
                    sheet.section(section, study)
        await sheet.draw()

    async def _do(self, *work: Any) -> Any:
        return await self._worker.do(*work, progress=lambda done, total: None)


def _values(axis: str, part: OperatingValue, text: str) -> str:
    """Values around those of the case: from zero to twice them; its own temperature."""
    try:
        now = float(text)
    except ValueError:
        return ""
    if axis not in MAP_STEPS:
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
        await self.follow()

    async def _keep(self) -> None:
        now = self._desk()
        self._set(Desk(now.source, now.tables, now.build, now.original, dict(now.changes)))

    def _set(self, other: Desk) -> None:
        self._other = other
        with self._body:
            ui.timer(0, self.follow, once=True)

    async def follow(self) -> None:
        """Both cases as they are now."""
        now, other = self._desk(), self._other
        self._body.clear()
        with self._body:
            if other is None or other.case is None or now.case is None:
                ui.label(
                    "Keep the case, change it, and come back: both stand side by side here."
                    if other is None or other.case is not None
                    else "The other case has problems of its own."
                ).classes("soft")
                return
            sheet = Sheet(self._do)
            names = (f"kept: {other.title}", f"now: {now.title}")
            for name, desk in zip(names, (other, now), strict=True):
                ui.label(name).classes("soft")
                ui.code(desk.command()).classes("wrapped")
            place = ui.element("div")
            for figure, title in SHOWN_TWICE.items():
                with ui.element("div").classes("pair"):
                    sheet.figure(Drawing(figure, f"{title} Kept.", ""), Study(other.case))
                    sheet.figure(Drawing(figure, f"{title} Now.", ""), Study(now.case))
        try:
            tables = await self._do(tasks.compared, other.case, now.case, ("kept", "now"))
        except (Ended, EpicyclicError) as error:
            with place:
                ui.label(str(error)).classes("problem")
            return
        with place:
            for table in tables:
                sheet.item(table, Study(now.case))
        await sheet.draw()
