"""Chapters of a result: those of its report, each figure drawn when its chapter is opened."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

from nicegui import ui

from epicyclic.app.tasks import IN_PAGE, Answer
from epicyclic.app.turning import FORMATS, TurningView
from epicyclic.app.worker import Ended
from epicyclic.case.case import Case
from epicyclic.errors import EpicyclicError
from epicyclic.report.html import items_html
from epicyclic.report.page import Drawing, Gallery, Item, Row, Section

__all__ = ["Chapters", "key_figures"]

TURNS = "gears"
"""The chapter in which gears turn."""
Picture = Callable[[Case, str, str], Awaitable[bytes]]
"""Draws a figure of the result of a case, by its name, in a format."""


def key_figures(answer: Answer) -> None:
    """The numbers at the head of a result."""
    for figure in answer.key_figures:
        with ui.element("div").classes("key-figure"):
            ui.label(figure.label).classes("label")
            with ui.element("div").classes("value"):
                ui.label(figure.cell.text)
                ui.label(figure.unit).classes("unit")


class Chapters:
    """Tabs, one for each chapter.

    Parameters
    ----------
    picture : callable
        Draws a figure.
    turning : TurningView
        The chapter of the gears begins with it.
    """

    def __init__(self, picture: Picture, turning: TurningView) -> None:
        self._picture, self._turning = picture, turning
        self._case: Case | None = None
        self._answer: Answer
        self._sections: dict[str, Section] = {}
        self._tabs = ui.tabs(on_change=self._turned).props(
            "dense no-caps align=left outside-arrows"
        )
        self._body = ui.element("div").classes("chapter")

    async def show(self, case: Case, answer: Answer) -> None:
        """Show the chapters of a result, the same one open as before."""
        self._case, self._answer, sections = case, answer, answer.sections
        names = [section.name for section in sections]
        if names != list(self._sections):
            self._tabs.clear()
            with self._tabs:
                for section in sections:
                    ui.tab(section.name, label=section.title)
        self._sections = {section.name: section for section in sections}
        if self._tabs.value in self._sections:
            await self._open(str(self._tabs.value))
        else:
            self._tabs.set_value(names[0])

    async def _turned(self) -> None:
        if self._tabs.value in self._sections:
            await self._open(str(self._tabs.value))

    async def _open(self, name: str) -> None:
        section, case = self._sections[name], self._case
        assert case is not None
        self._drawn: list[tuple[ui.html, str]] = []
        self._body.clear()
        with self._body:
            if name == TURNS:
                self._turning.build(self._answer.turning)
            if section.lead:
                ui.label(section.lead).classes("lead")
            for item in section.items:
                self._item(item)
        if name == TURNS:
            await self._turning.draw(case)
        for place, figure in self._drawn:
            if section is not self._sections.get(name) or case is not self._case:
                return
            try:
                svg = await self._picture(case, figure, IN_PAGE)
            except Ended:
                return
            except EpicyclicError as error:
                place.set_content(str(error))
            else:
                place.set_content(svg.decode())

    def _item(self, item: Item) -> None:
        if isinstance(item, Row):
            with ui.element("div").classes("pair"):
                for part in item.items:
                    self._item(part)
        elif isinstance(item, Gallery):
            with ui.element("div").classes("gallery" + " wide" * item.is_wide):
                for drawing in item.drawings:
                    self._figure(drawing)
        else:
            ui.html(items_html(item), sanitize=False)

    def _figure(self, drawing: Drawing) -> None:
        with ui.element("figure").classes("wide" if drawing.name in self._answer.wide else ""):
            place = ui.html("", sanitize=False).classes("still")
            with place:
                ui.spinner(size="2em")
            with ui.element("figcaption"):
                ui.label(drawing.title)
                with ui.element("div").classes("formats"):
                    for ending in FORMATS:
                        ui.button(ending, on_click=self._saver(drawing.name, ending)).props(
                            "flat dense no-caps"
                        )
        self._drawn.append((place, drawing.name))

    def _saver(self, name: str, ending: str) -> Callable[[], Awaitable[None]]:
        async def save() -> None:
            if self._case is not None:
                ui.download(await self._picture(self._case, name, ending), f"{name}.{ending}")

        return save
