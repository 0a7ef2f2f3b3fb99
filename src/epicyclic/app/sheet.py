"""Chapters of a report on the page: tables at once, figures as they are drawn, each to save."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

from nicegui import ui

from epicyclic.app import tasks
from epicyclic.app.tasks import IN_PAGE, Study
from epicyclic.app.worker import Ended
from epicyclic.errors import EpicyclicError
from epicyclic.report.html import items_html
from epicyclic.report.page import Drawing, Gallery, Item, KeyFigure, Listing, Row, Section, Table

__all__ = ["FORMATS", "Do", "Sheet", "key_figures", "save_buttons"]

FORMATS = ("png", "svg", "pdf")
Do = Callable[..., Awaitable[Any]]
"""Has a task done by the worker."""


def key_figures(figures: Sequence[KeyFigure]) -> None:
    """The numbers at the head of a result."""
    for figure in figures:
        with ui.element("div").classes("key-figure"):
            ui.label(figure.label).classes("label")
            with ui.element("div").classes("value"):
                ui.label(figure.cell.text)
                ui.label(figure.unit).classes("unit")


def save_buttons(name: str, draw: Callable[[str], Awaitable[bytes]]) -> None:
    """A button for each format, which draws a figure in it and hands the file to the browser."""

    async def save(ending: str) -> None:
        try:
            ui.download(await draw(ending), f"{name}.{ending}")
        except (Ended, EpicyclicError) as error:
            ui.notify(str(error))

    with ui.element("div").classes("formats"):
        for ending in FORMATS:
            ui.button(ending, on_click=partial(save, ending)).props("flat dense no-caps")


class Sheet:
    """What is shown of studies in one place.

    Parameters
    ----------
    do : callable
    wide : iterable of str
        Figures of several panels.
    """

    def __init__(self, do: Do, wide: Iterable[str] = ()) -> None:
        self._do, self._wide = do, frozenset(wide)
        self._waiting: list[tuple[ui.html, Study, str]] = []

    @property
    def first(self) -> tuple[ui.html, str] | None:
        """The place and the name of the first figure."""
        return (self._waiting[0][0], self._waiting[0][2]) if self._waiting else None

    def section(self, section: Section, study: Study) -> None:
        """A chapter, its figures still to be drawn."""
        if section.lead:
            ui.label(section.lead).classes("lead")
        for item in section.items:
            self.item(item, study)

    def item(self, item: Item, study: Study) -> None:
        """A part of a chapter."""
        if isinstance(item, Row):
            with ui.element("div").classes("pair"):
                for part in item.items:
                    self.item(part, study)
        elif isinstance(item, Gallery):
            with ui.element("div").classes("gallery" + " wide" * item.is_wide):
                for drawing in item.drawings:
                    self.figure(drawing, study)
        elif isinstance(item, Table | Listing):  # others need the script of a report
            ui.html(items_html(item), sanitize=False)

    def figure(self, drawing: Drawing, study: Study) -> None:
        """A place for a figure, with its title and buttons that save it."""
        name = drawing.name
        with ui.element("figure").classes("wide" if name in self._wide else ""):
            place = ui.html("", sanitize=False).classes("still")
            with place:
                ui.spinner(size="2em")
            with ui.element("figcaption"):
                ui.label(drawing.title)
                save_buttons(name, lambda ending: self._do(tasks.picture, study, name, ending))
        self._waiting.append((place, study, name))

    async def draw(self) -> None:
        """Draw the figures, one after the other, as long as they are on the page."""
        with suppress(Ended):
            for place, study, name in self._waiting:
                if place.is_deleted:
                    return
                try:
                    svg = await self._do(tasks.picture, study, name, IN_PAGE)
                    content = svg.decode()
                except EpicyclicError as error:
                    content = error_html(error)
                if not place.is_deleted:
                    place.set_content(content)


def error_html(error: EpicyclicError) -> str:
    """An error in place of a figure."""
    return items_html(Listing((str(error),)))
