"""The tabs of the page: chapters of the result, and views that stand beside them."""

from __future__ import annotations

from typing import Protocol

from nicegui import ui

from epicyclic.app.sheet import Do, Sheet
from epicyclic.app.tasks import Answer, Study
from epicyclic.app.turning import TurningView
from epicyclic.report.page import Section

__all__ = ["Chapters", "View"]

TURNS = "gears"
"""The chapter in which gears turn."""


class View(Protocol):
    """What a tab shows that is no chapter of the result."""

    title: str

    async def show(self) -> None:
        """Make its elements."""

    async def follow(self) -> None:
        """After a change of the case, while it is shown."""


class Chapters:
    """Tabs, one for each chapter and view.

    Parameters
    ----------
    do : callable
        Has a task done.
    views : dict of str to View
    """

    def __init__(self, do: Do, views: dict[str, View]) -> None:
        self._do, self._views = do, views
        self._turning = TurningView(do)
        self._study: Study | None = None
        self._answer: Answer
        self._sections: dict[str, Section] = {}
        self.sheet = Sheet(do)
        self._tabs = ui.tabs(on_change=self._open).props("dense no-caps align=left outside-arrows")
        self._body = ui.element("div").classes("chapter")

    def clear(self) -> None:
        """Show nothing: another case is opened."""
        self._sections, self._study = {}, None
        self._tabs.clear()
        self._body.clear()
        self.sheet = Sheet(self._do)

    async def show(self, study: Study, answer: Answer) -> None:
        """Show the chapters of a result, the same one open as before."""
        self._study, self._answer = study, answer
        sections = {section.name: section for section in answer.sections}
        if list(sections) != list(self._sections):
            self._tabs.clear()
            first, *others = [(name, section.title) for name, section in sections.items()]
            views = [(name, view.title) for name, view in self._views.items()]
            with self._tabs:
                for name, title in (first, *views, *others):
                    ui.tab(name, label=title)
        self._sections = sections
        if self._tabs.value in sections:
            await self._open()
        elif self._tabs.value in self._views:
            await self._views[str(self._tabs.value)].follow()
        else:
            self._tabs.set_value(next(iter(sections)))

    async def _open(self) -> None:
        name = str(self._tabs.value)
        if name not in self._sections and name not in self._views:
            return
        self._body.clear()
        with self._body:
            if name in self._views:
                self.sheet = Sheet(self._do)
                await self._views[name].show()
            elif self._study is not None:
                await self._show_section(self._sections[name], self._study)

    async def _show_section(self, section: Section, study: Study) -> None:
        self.sheet = sheet = Sheet(self._do, self._answer.wide)
        if section.name == TURNS:
            self._turning.build(self._answer.turning)
        sheet.section(section, study)
        if section.name == TURNS:
            await self._turning.draw(study.case)
        await sheet.draw()
