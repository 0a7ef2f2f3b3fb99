"""The tabs of the page: chapters of the result, and views that stand beside them."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from typing import Protocol

from nicegui import background_tasks, ui

from epicyclic.app import tasks
from epicyclic.app.sheet import Do, Sheet
from epicyclic.app.shelves import Shelf
from epicyclic.app.tasks import Answer, Study
from epicyclic.app.turning import TurningView
from epicyclic.report.page import Section


class View(Protocol):
    """What a tab shows that is no chapter of the result."""

    title: str

    async def show(self) -> None:
        """Make its elements."""

    def age(self) -> None:
        """Mark what is of another case than that of the form."""

    async def follow(self) -> None:
        """After a change of the case, while it is shown."""


class Chapters:
    """Tabs, one for each chapter and view.

    Parameters
    ----------
    shelf : Shelf
        Knows the chapter that is open, also after the page was loaded again.
    do : callable
        Has a task done.
    views : dict of str to View
    want : callable
        Has the chapter that was opened follow the case.
    """

    def __init__(
        self, shelf: Shelf, do: Do, views: dict[str, View], want: Callable[[], Awaitable[None]]
    ) -> None:
        self._shelf, self._do, self._views, self._want = shelf, do, views, want
        self._turning = TurningView(do)
        self._sections: dict[str, Section] = {}
        self._sheet: Sheet | None = None
        self._tabs = ui.tabs(on_change=self._open).props("dense no-caps align=left")
        self._body = ui.element("div").classes("chapter")

    def clear(self) -> None:
        """Show nothing: another case is opened."""
        self._sections, self._sheet = {}, None
        self._tabs.clear()
        self._tabs.set_value(None)
        self._body.clear()

    def age(self, now: Study) -> None:
        """Mark what is of another study than the one of now."""
        if self._sheet is not None:
            self._sheet.age(now)
            self._turning.age(now)
        elif self._tabs.value in self._views:
            self._views[str(self._tabs.value)].age()

    async def follow(self, study: Study, is_wanted: Callable[[], bool]) -> None:
        """Show a study in the tab that is open, figure by figure while that is wanted."""
        name = str(self._tabs.value)
        if name in self._views:
            background_tasks.create(self._views[name].follow())
        elif name in self._sections:
            answer = await self._do(tasks.answered, study, name)
            if self._tabs.value != name or name not in self._sections or self._body.is_deleted:
                return
            (section,) = answer.sections
            if not self._update(section, study, answer):
                self._build(section, study, answer)
            await self._draw(is_wanted)

    async def complete(self, study: Study, is_wanted: Callable[[], bool]) -> None:
        """Have tabs for all chapters of a study that is shown, the same one open as before.

        Of a case that is new one chapter is shown before the others are known.
        """
        if not self._sections:
            await self._begin(study, is_wanted)
            return  # what opens the tab wants the others too
        for name in self._sections:  # each by itself, so that the next value need not wait for all
            await self._do(tasks.answered, study, name)
            if not is_wanted():
                return
        answer = await self._do(tasks.answered, study, "")
        if not self._body.is_deleted and is_wanted():
            self._offer(answer.sections)

    async def _begin(self, study: Study, is_wanted: Callable[[], bool]) -> None:
        """Show the chapter that was open, or the first one."""
        chapter = self._shelf.chapter
        name = tasks.FIRST if chapter in ("", *self._views) else chapter
        answer = await self._do(tasks.answered, study, name)
        if not answer.sections[0].items:  # the case has no such chapter
            answer = await self._do(tasks.answered, study, tasks.FIRST)
        if not self._body.is_deleted and is_wanted():
            self._offer(answer.sections)

    def _offer(self, found: Sequence[Section]) -> None:
        """Have tabs for chapters, and beside the first one for the views."""
        sections = {section.name: section for section in found}
        if list(sections) != list(self._sections):
            first, *others = [(name, section.title) for name, section in sections.items()]
            views = [(name, view.title) for name, view in self._views.items()]
            self._tabs.clear()
            with self._tabs:
                for name, title in (first, *views, *others):
                    ui.tab(name, label=title)
        self._sections = sections
        known = (*sections, *self._views)
        if self._tabs.value not in known:
            chapter = self._shelf.chapter
            self._tabs.set_value(chapter if chapter in known else next(iter(sections)))

    async def _open(self) -> None:
        name = str(self._tabs.value)
        if name in self._sections or name in self._views:
            self._shelf.chapter = name
        self._body.clear()
        self._sheet = None
        with self._body:
            if name in self._views:
                await self._views[name].show()
            elif name in self._sections:
                ui.spinner(size="2em")
        await self._want()

    def _update(self, section: Section, study: Study, answer: Answer) -> bool:
        """Show a chapter in the place of the same one; False if it has another form."""
        if self._sheet is None or self._turning.titles != list(answer.turning):
            return False
        return self._sheet.update(study, [section], answer.wide)

    def _build(self, section: Section, study: Study, answer: Answer) -> None:
        self._sheet = sheet = Sheet(self._do, study, answer.wide)
        self._body.clear()
        with self._body:
            self._turning.build(answer.turning)
            sheet.section(section)

    async def _draw(self, is_wanted: Callable[[], bool]) -> None:
        sheet = self._sheet
        assert sheet is not None

        def is_shown() -> bool:
            return sheet is self._sheet and is_wanted()

        sheet.age(sheet.study)
        await self._turning.draw(sheet.study, is_shown)
        if is_shown():
            await sheet.draw(is_shown)
