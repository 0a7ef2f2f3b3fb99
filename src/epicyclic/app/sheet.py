"""Chapters of a report on the page: tables at once, figures as they are drawn, each to save."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Iterator, Sequence
from functools import partial
from html import escape
from typing import Any, cast

from nicegui import ui
from nicegui.element import Element

from epicyclic.app import tasks
from epicyclic.app.tasks import IN_PAGE, Study
from epicyclic.app.worker import Ended
from epicyclic.errors import EpicyclicError
from epicyclic.report.html import items_html
from epicyclic.report.page import Drawing, Gallery, Item, KeyFigure, Listing, Row, Section, Table

FORMATS = ("png", "svg", "pdf")
BEHIND = "behind"
"""Class of what is of an earlier case than that of the form."""
Do = Callable[..., Awaitable[Any]]
"""Has a task done by the worker."""
Part = str | Table | Listing
"""What is shown at once: the lead of a chapter, and its tables."""


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


class Place:
    """Where a figure stands, with a sign as long as its picture is of an earlier case.

    Parameters
    ----------
    title, name : str
        Shown below the figure; of its files.
    classes : str
        Classes of the frame.
    draw : callable
        Draws it in a format.
    """

    def __init__(
        self, title: str, name: str, classes: str, draw: Callable[[str], Awaitable[bytes]]
    ) -> None:
        self.name = name
        self.drawn: Study | None = None
        with ui.element("figure").classes(classes) as self._frame:
            self.picture = ui.html("", sanitize=False).classes("still")
            with self.picture:
                ui.spinner(size="2em")
            with ui.element("figcaption"):
                ui.label(title)
                ui.label("computing ...").classes("computing")
                save_buttons(name, draw)

    @property
    def is_gone(self) -> bool:
        """True if it is on the page no more."""
        return self._frame.is_deleted

    def show(self, content: str, study: Study) -> None:
        """Show the picture of a study."""
        self.picture.set_content(content)
        self.drawn = study

    def age(self, now: Study) -> None:
        """Say whether the picture is of another study than the one of now."""
        mark_behind(self._frame, self.drawn not in (None, now))


def mark_behind(element: Element, is_behind: bool) -> None:
    """Mark what is of an earlier case than that of the form."""
    element.classes(**{"add" if is_behind else "remove": BEHIND})


class Sheet:
    """What is shown of a study in one place, and of others of the same form after it.

    Parameters
    ----------
    do : callable
    study : Study
    wide : iterable of str
        Figures of several panels.
    """

    def __init__(self, do: Do, study: Study, wide: Iterable[str] = ()) -> None:
        self._do, self._wide = do, frozenset(wide)
        self.study = study
        self._places: list[Place] = []
        self._others: dict[Place, Study] = {}
        self._texts: list[ui.html] = []

    def section(self, section: Section) -> None:
        """A chapter, its figures still to be drawn."""
        if section.lead:
            self._text(section.lead)
        for item in section.items:
            self.item(item)

    def item(self, item: Item) -> None:
        """A part of a chapter."""
        if isinstance(item, Row):
            with ui.element("div").classes("pair"):
                for part in item.items:
                    self.item(part)
        elif isinstance(item, Gallery):
            with ui.element("div").classes("gallery" + " wide" * item.is_wide):
                for drawing in item.drawings:
                    self.figure(drawing)
        elif isinstance(item, Table | Listing):  # others need the script of a report
            self._text(item)

    def _text(self, part: Part) -> None:
        self._texts.append(ui.html(_html(part), sanitize=False).classes("text"))

    def figure(self, drawing: Drawing, other: Study | None = None) -> None:
        """A place for a figure of the study, or always of another one."""
        name = drawing.name

        async def draw(ending: str) -> bytes:
            study = place.drawn or self.study
            return cast(bytes, await self._do(tasks.picture, study, name, ending))

        place = Place(drawing.title, name, "wide" * (name in self._wide), draw)
        self._places.append(place)
        if other is not None:
            self._others[place] = other

    def update(self, study: Study, sections: Iterable[Section], wide: Iterable[str]) -> bool:
        """Show the tables of another study; False, and nothing done, if its form is another."""
        parts = [part for section in sections for part in _parts(section)]
        texts = [part for part in parts if not isinstance(part, Drawing)]
        names = [part.name for part in parts if isinstance(part, Drawing)]
        is_same = names == [place.name for place in self._places if place not in self._others]
        if not is_same or len(texts) != len(self._texts) or self._wide != frozenset(wide):
            return False
        self.study = study
        for place, text in zip(self._texts, texts, strict=True):
            place.set_content(_html(text))
        return True

    def age(self, now: Study) -> None:
        """Mark what is of another study than the one of now."""
        for text in self._texts:
            mark_behind(text, self.study != now)
        for place in self._places:
            place.age(self._others.get(place, now))

    async def draw(self, is_wanted: Callable[[], bool] = lambda: True) -> None:
        """Draw the figures that are not of the study, one after the other while that is wanted."""
        for place in self._places:
            study = self._others.get(place, self.study)
            if place.drawn == study:
                continue
            try:
                svg = await self._do(tasks.picture, study, place.name, IN_PAGE)
                content = svg.decode()
            except EpicyclicError as error:
                content = items_html(Listing((str(error),)))
            if place.is_gone:
                return
            place.show(content, study)
            place.age(study)
            if not is_wanted():
                return


def _parts(section: Section) -> Iterator[Part | Drawing]:
    """Texts and figures of a chapter in the order in which a sheet shows them."""
    if section.lead:
        yield section.lead
    for item in section.items:
        for part in item.items if isinstance(item, Row) else (item,):
            if isinstance(part, Gallery):
                yield from part.drawings
            elif isinstance(part, Table | Listing):
                yield part


def _html(part: Part) -> str:
    return f'<p class="lead">{escape(part)}</p>' if isinstance(part, str) else items_html(part)
