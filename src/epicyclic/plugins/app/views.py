"""The tabs of the page: chapters of a report, turning gears, maps, another case beside."""

from __future__ import annotations

import json
from collections.abc import Awaitable, Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from html import escape
from typing import Any, Protocol, cast

from nicegui import background_tasks, events, ui
from nicegui.element import Element

from epicyclic.errors import EpicyclicError
from epicyclic.plugins.app import worker as tasks
from epicyclic.plugins.app.case_form import Desk, Shelf, number_in
from epicyclic.plugins.app.worker import IN_PAGE, MESH, Answer, Doing, Ended, Latest, Study, Worker
from epicyclic.show.html import items_html
from epicyclic.show.page import Drawing, Gallery, Item, KeyFigure, Listing, Row, Section, Table
from epicyclic.study.operating import OPERATING, OperatingValue

# Chapters of a report on the page: tables at once, figures as they are drawn, each to save.


FORMATS = ("png", "svg", "pdf")
BEHIND = "behind"  # Class of what is of an earlier case than that of the form.
Do = Callable[..., Awaitable[Any]]  # Has a task done by the worker.
Part = str | Table | Listing  # What is shown at once: the lead of a chapter, and its tables.


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


# Gears that turn on the page while a slider moves: drawn once, turned by the browser.


PERIODS, STEP = 4, 0.005  # Range and step of the slider. [mesh periods]


class TurningView:
    """A slider, and the sets and meshes that follow it.

    Parameters
    ----------
    do : callable
        Has a task done.
    """

    def __init__(self, do: Do) -> None:
        self._do = do
        self._places: dict[str, Place] = {}
        self._slider: ui.slider | None = None

    def build(self, titles: Mapping[str, str]) -> None:
        """Make the slider and places for pictures."""
        self._places = {}
        if not titles:
            return
        with ui.row().classes("turner"):
            play = ui.button(icon="play_arrow").props("flat round dense").tooltip("Turn, or stop")
            play.on("click", js_handler="(event) => turning.play(event.currentTarget)")
            self._slider = ui.slider(min=0, max=PERIODS, step=STEP, value=self._phase).mark("phase")
            self._slider.on("update:model-value", js_handler="(phase) => turning.turn(phase)")
            ui.label("mesh periods").classes("soft")
        with ui.element("div").classes("turned"):
            for what, title in titles.items():
                self._places[what] = self._place(what, title)

    @property
    def titles(self) -> list[str]:
        """What turns."""
        return list(self._places)

    @property
    def _phase(self) -> float:
        return float(self._slider.value) if self._slider else 0.0

    def _place(self, what: str, title: str) -> Place:
        async def draw(ending: str) -> bytes:
            assert place.drawn is not None
            case = place.drawn.case
            content, _ = await self._do(tasks.turning, case, what, ending, self._phase)
            return cast(bytes, content)

        place = Place(title, "turning", "mesh" * what.startswith(MESH), draw)
        return place

    def age(self, now: Study) -> None:
        """Mark the pictures of other studies than the one of now."""
        for place in self._places.values():
            place.age(now)

    async def draw(self, study: Study, is_wanted: Callable[[], bool]) -> None:
        """Draw what is not of a study, one after the other while that is wanted."""
        for what, place in list(self._places.items()):
            if place.drawn == study:
                continue
            svg, data = await self._do(tasks.turning, study.case, what, IN_PAGE, 0.0)
            if place.is_gone:
                return
            place.show(svg.decode(), study)
            place.age(study)
            data["phase"] = self._phase
            key = json.dumps(place.picture.html_id)
            with place.picture:
                ui.run_javascript(f"turning.add({key}, {json.dumps(data)})")
            if not is_wanted():
                return


# Tabs beside the chapters of a result: its map, and another case beside it.


MAP_STEPS = {"speed": 9, "torque": 7}
SHOWN_TWICE = {"losses": "Where is the power lost?", "loss-sum": "How do the losses add up?"}
_TOLD = "Keep the case, change it, and come back. Both are shown here side by side."


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
            ui.notify("The case has problems. Correct them first.")
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
            ui.button("Keep the current case for comparison", on_click=self._keep).props(
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
            told = _TOLD if other is None else "The other case has problems."
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


# The tabs of the page: chapters of the result, and views that stand beside them.


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
