"""The tabs of the page: chapters of a report, turning gears, maps, another case beside."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Awaitable, Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from nicegui import background_tasks, events, ui
from nicegui.element import Element

from epicyclic.errors import EpicyclicError
from epicyclic.plugins.app import worker as tasks
from epicyclic.plugins.app.case_form import Desk, Shelf, number_in, received, received_task
from epicyclic.plugins.app.worker import IN_PAGE, MESH, Answer, Doing, Latest, Study, Worker
from epicyclic.show.html import items_html
from epicyclic.show.page import Drawing, Gallery, Item, KeyFigure, Listing, Row, Section, Table
from epicyclic.study.maps.formats import formats
from epicyclic.study.operating import OPERATING, OperatingValue

if TYPE_CHECKING:
    from epicyclic.plugins.design.report import Front

# Chapters of a report on the page: tables at once, figures as they are drawn, each to save.


FORMATS = ("png", "svg", "pdf")
BEHIND = "behind"  # Class of what is of an earlier case than that of the form.
Do = Callable[..., Awaitable[Any]]  # Has a task done by the worker.
Part = str | Table | Listing  # What is shown at once: the lead of a chapter, and its tables.


def key_figures(figures: Sequence[KeyFigure]) -> None:
    """The numbers at the head of a result, and their bands."""
    for figure in figures:
        with ui.element("div").classes("key-figure"):
            ui.label(figure.label).classes("label")
            with ui.element("div").classes("value"):
                ui.label(figure.cell.text)
                ui.label(figure.unit).classes("unit")
            ui.label(f"95 %: {figure.band}" if figure.band else "").classes("band")


class Failure(ui.label):
    """Why something could not be done; it is there while there is a reason."""

    def __init__(self) -> None:
        super().__init__()
        self.classes("problem").set_visibility(False)

    def tell(self, text: str) -> None:
        """Show the reason, none if it is empty, unless the page is gone."""
        if not self.is_deleted:
            self.set_text(text)
            self.set_visibility(bool(text))


MAP_FILES = {
    **{name: f"{one.about}, {one.suffix or name}" for name, one in formats().items()},
    ".html": "Report, .html",
    ".pdf": "Report, .pdf",
}
"""What can be saved of a map: the formats of the command, and its report."""


def save_menu(label: str, files: Mapping[str, str], save: Callable[[str], Awaitable[None]]) -> None:
    """A menu of files, by their endings or formats; calls `save` with one of these."""
    with ui.button(label, icon="save").props("flat no-caps"), ui.menu():
        for name, title in files.items():
            ui.menu_item(title, partial(save, name))


async def download(do: Do, study: Study, name: str, original: str | None, stem: str) -> None:
    """Hand what `saved` makes to the browser, or say why there is nothing."""
    try:
        suffix, content = await do(tasks.saved, study, name, original)
    except EpicyclicError as error:
        ui.notify(str(error), multi_line=True, timeout=0, close_button="Close")
        return
    ui.download(content, f"{stem}{suffix}")


def save_buttons(name: str, draw: Callable[[str], Awaitable[bytes]]) -> Element:
    """A button for each format, which draws a figure in it and hands the file to the browser."""

    async def save(ending: str) -> None:
        try:
            ui.download(await draw(ending), f"{name}.{ending}")
        except EpicyclicError as error:
            ui.notify(str(error))

    with ui.element("div").classes("formats") as buttons:
        for ending in FORMATS:
            ui.button(ending, on_click=partial(save, ending)).props("flat dense no-caps")
    return buttons


class Place:
    """Where a figure stands, with a sign as long as its picture is of an earlier case."""

    def __init__(
        self,
        title: str,  # Shown until it is drawn.
        name: str,  # Of its files.
        classes: str,  # Of the frame.
        draw: Callable[[str], Awaitable[bytes]],  # In a format.
    ) -> None:
        self.name = name
        self.drawn: Study | None = None
        self.pictures: list[ui.plotly | ui.html] = []  # One for each panel.
        self._titles: list[ui.label] = []
        with ui.element("figure").classes(classes) as self._frame:
            self._panels = ui.element("div").classes("panels")
            with self._panels:
                ui.label(title).classes("heading")
                ui.spinner(size="2em")
            with ui.element("figcaption"):
                self._point = ui.label().classes("point")
                ui.label("computing ...").classes("computing")
                self._buttons = save_buttons(name, draw)
        self._buttons.set_visibility(False)  # until there is something to save

    @property
    def is_gone(self) -> bool:
        """True if it is on the page no more."""
        return self._frame.is_deleted

    def show(self, drawings: Sequence[Drawing], study: Study) -> None:
        """Show the pictures of a study: what can be explored as a chart, else still."""
        kinds = [ui.html if drawing.plot is None else ui.plotly for drawing in drawings]
        if [type(one) for one in self.pictures] != kinds:
            self._panels.clear()
            with self._panels:
                self._make(drawings)
        for title, picture, drawing in zip(self._titles, self.pictures, drawings, strict=True):
            title.set_text(drawing.title)
            if isinstance(picture, ui.html):
                picture.set_content(drawing.svg)
            else:
                picture.update_figure(_chart(drawing))
        self._point.set_text(drawings[0].point if drawings else "")
        self._buttons.set_visibility(True)
        self.drawn = study

    def _make(self, drawings: Sequence[Drawing]) -> None:
        self.pictures, self._titles = [], []
        for drawing in drawings:
            with ui.element("div").classes("panel"):
                self._titles.append(ui.label().classes("heading"))
                if drawing.plot is None:
                    self.pictures.append(ui.html("", sanitize=False).classes("still"))
                else:
                    bars = drawing.plot["layout"].get("yaxis", {}).get("ticktext", ())
                    named = [it for it in drawing.plot["data"] if it.get("showlegend") is not False]
                    height = max(_HEIGHT, _REST + _BAR * len(bars))
                    height += _ENTRY * max(0, len(named) - _IN_ROWS)
                    chart = ui.plotly({}).classes("still chart").style(f"height: {height}rem")
                    self.pictures.append(chart)

    def age(self, now: Study) -> None:
        """Say whether the picture is of another study than the one of now."""
        mark_behind(self._frame, self.drawn not in (None, now))


_HEIGHT, _REST, _BAR = 20.0, 7.0, 1.5  # Of a chart at least; beside its bars; of a bar. [rem]
_ENTRY, _IN_ROWS = 1.2, 4  # Of an entry of the legend [rem], beyond those that have room.
_BUTTONS = ["select2d", "lasso2d", "zoomIn2d", "zoomOut2d", "autoScale2d", "toImage"]
_LEGEND = {"orientation": "h", "yanchor": "top", "y": -0.2, "xanchor": "left", "x": 0}


def _chart(drawing: Drawing) -> dict[str, Any]:
    """A figure to explore as its element takes it; its title stands above it."""
    assert drawing.plot is not None
    own = {
        "title": None,
        "font": {"family": "inherit", "size": 12},
        "margin": {"t": 8, "r": 12, "b": 48, "l": 56},
        "legend": _LEGEND,
        "uirevision": drawing.name,
    }
    return {
        "data": drawing.plot["data"],
        "layout": drawing.plot["layout"] | own,
        "config": {"displaylogo": False, "modeBarButtonsToRemove": _BUTTONS},
    }


def mark_behind(element: Element, is_behind: bool) -> None:
    """Mark what is of an earlier case than that of the form."""
    element.classes(**{"add" if is_behind else "remove": BEHIND})


class Sheet:
    """What is shown of a study in one place, and of others of the same form after it.

    Figures of several panels are `wide`.
    """

    def __init__(self, do: Do, study: Study, wide: Iterable[str] = ()) -> None:
        self._do, self._wide = do, frozenset(wide)
        self.study = study
        self._places: list[Place] = []
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

    def figure(self, drawing: Drawing) -> None:
        """A place for a figure of the study."""
        name = drawing.name

        async def draw(ending: str) -> bytes:
            study = place.drawn or self.study
            return cast(bytes, await self._do(tasks.picture, study, name, ending))

        place = Place(drawing.title, name, "wide" * (name in self._wide), draw)
        self._places.append(place)

    def update(self, study: Study, sections: Iterable[Section], wide: Iterable[str]) -> bool:
        """Show the tables of another study; False, and nothing done, if its form is another."""
        parts = [part for section in sections for part in _parts(section)]
        texts = [part for part in parts if not isinstance(part, Drawing)]
        names = [part.name for part in parts if isinstance(part, Drawing)]
        is_same = names == [place.name for place in self._places]
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
            place.age(now)

    async def draw(self, is_wanted: Callable[[], bool] = lambda: True) -> None:
        """Draw the figures that are not of the study, one after the other while that is wanted."""
        study = self.study
        for place in self._places:
            if place.drawn == study:
                continue
            try:
                drawings = await self._do(tasks.picture, study, place.name, IN_PAGE)
            except EpicyclicError as error:
                drawings = [Drawing("", "", items_html(Listing((str(error),))))]
            if place.is_gone:
                return
            place.show(drawings, study)
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
    """A slider, and the sets and meshes that follow it."""

    def __init__(self, do: Do) -> None:
        self._do = do
        self._places: dict[str, Place] = {}
        self._titles: dict[str, str] = {}
        self._slider: ui.slider | None = None

    def build(self, titles: Mapping[str, str]) -> None:
        """Make the slider and places for pictures."""
        self._places, self._titles = {}, dict(titles)
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
            drawing = Drawing(what, self._titles[what], svg.decode(), point=data.pop("point"))
            place.show([drawing], study)
            place.age(study)
            data["phase"] = self._phase
            (picture,) = place.pictures
            key = json.dumps(picture.html_id)
            with picture:
                ui.run_javascript(f"turning.add({key}, {json.dumps(data)})")
            if not is_wanted():
                return


# Tabs beside the chapters of a result: its map, and another case beside it.


MAP_STEPS = {"speed": 9, "torque": 13}
_NAMES = ("kept", "now")  # Of two cases beside each other.
_TOLD = "Keep the current case, then change it: both are shown here side by side."


class View:
    """What a tab shows that is no chapter of the result."""

    title: str

    def __init__(self) -> None:
        # after a change of the case, while it is shown; the last change counts
        self.follow = Latest(self._work).want

    async def show(self) -> None:
        """Make its elements."""

    def age(self) -> None:
        """Mark what is of another case than that of the form, if anything is."""

    async def _work(self) -> None:
        """Show what follows from the case as it is now, if anything does."""


class MapView(View):
    """Loss and efficiency over speed and torque, by a worker beside those of the page."""

    title = "Map"

    def __init__(self, desk: Callable[[], Desk], worker: Worker) -> None:
        super().__init__()
        self._desk, self._worker = desk, worker
        self._texts: dict[str, str] = {}
        self._known: tuple[Study, Answer] | None = None
        self._sheet: Sheet | None = None
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
            save_menu("Save map", MAP_FILES, self._save)
        ui.label("Values as a,b,c or start:stop:count, with their unit.").classes("soft")
        self._doing = Doing(self._worker.end)
        self._failed = Failure()
        self._body = ui.element("div")
        self._sheet = None

    def age(self) -> None:
        """Mark a map of another case."""
        now = self._desk().case
        if self._known is not None and self._sheet is not None and now is not None:
            self._sheet.age(replace(self._known[0], case=now))

    async def _save(self, name: str) -> None:
        if self._known is None:
            ui.notify("There is no map yet. Compute one first.")
            return
        await download(self._worker.do, self._known[0], name, None, "map")

    def _take(self, axis: str, event: events.ValueChangeEventArguments[str]) -> None:
        self._texts[axis] = event.value or ""

    async def _compute(self) -> None:
        if self._desk().case is None:
            ui.notify("The case has problems. Correct them first.")
            return
        self._is_asked = True
        await self.follow()

    async def _work(self) -> None:
        """Show the map, computed again if it is of another case."""
        case = self._desk().case
        is_old = self._known is not None and case not in (None, self._known[0].case)
        try:
            if case is not None and (self._is_asked or is_old):
                self._is_asked = False
                self._failed.tell("")
                texts = (self._texts[axis].strip() for axis in OPERATING)
                study = Study(case, *texts, is_map=True)
                with self._doing.shown("points of the map"):
                    progress = self._doing.progress
                    answer = await self._worker.do(tasks.answered, study, "", progress=progress)
                self._known = study, answer
            if self._known is not None and not self._body.is_deleted:
                await self._fill(*self._known)
        except EpicyclicError as error:
            self._failed.tell(str(error))

    async def _fill(self, study: Study, answer: Answer) -> None:
        values = {axis: getattr(study, axis) for axis in OPERATING}
        options = [word for axis, text in values.items() if text for word in (f"--{axis}", text)]
        command = self._desk().command("map", *options, "-o", "map.nc")
        if self._sheet is None or not self._sheet.update(study, answer.sections, answer.wide):
            self._sheet = sheet = Sheet(self._worker.do, study, answer.wide)
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


def _values(axis: str, part: OperatingValue, text: str) -> str:
    """From rest to the speed of the case, up to its torque in both directions; its temperature."""
    now = number_in(text)
    if now is None:
        return ""
    if axis not in MAP_STEPS or not now:
        return f"{now:g} {part.unit}"
    start = -abs(now) if axis == "torque" else 0
    end = abs(now) if axis == "torque" else now
    return f"{start:g}:{end:g}:{MAP_STEPS[axis]} {part.unit}"


class CompareView(View):
    """The case beside another one, which `choose` asks for: it calls what it is given with it."""

    title = "Compare"

    def __init__(
        self, desk: Callable[[], Desk], do: Do, choose: Callable[[Callable[[Desk], None]], None]
    ) -> None:
        super().__init__()
        self._desk, self._do, self._choose = desk, do, choose
        self._other: Desk | None = None
        self._sheet: Sheet | None = None

    async def show(self) -> None:
        """Buttons that set the other case, and both side by side."""
        with ui.row().classes("values"):
            keep = ui.button("Keep the current case for comparison", on_click=self._keep)
            other = ui.button("Another case", on_click=lambda: self._choose(self._set))
            for button in (keep, other):
                button.props("outline no-caps dense")
        self._body = ui.element("div")
        self._sheet = None

    def age(self) -> None:
        """Mark what is of another case than that of the form."""
        now = self._desk().case
        if self._sheet is not None and now is not None:
            self._sheet.age(Study(now))
            self._place.age(Study(now))

    def _keep(self) -> None:
        self._set(self._desk().copy())

    def _set(self, other: Desk) -> None:
        self._other, self._sheet = other, None
        background_tasks.create(self.follow())

    async def _work(self) -> None:
        """Show both cases."""
        now, other = self._desk(), self._other
        if self._body.is_deleted or now.case is None:
            return
        if other is None or other.case is None:
            self._say(_TOLD if other is None else "The other case has problems.", "soft")
            return
        study, cases = Study(now.case), (other.case, now.case)
        try:
            tables = await self._do(tasks.compared, *cases, _NAMES)
            drawings = await self._do(tasks.beside, *cases, _NAMES, IN_PAGE)
        except EpicyclicError as error:
            if not self._body.is_deleted:
                self._say(str(error), "problem")
            return
        if self._body.is_deleted or other is not self._other:
            return
        if self._sheet is None or not self._sheet.update(study, [Section("", "", (*tables,))], ()):
            self._build(study, tables, other)
        self._command.set_content(now.command())
        self._place.show(drawings, study)
        self.age()

    def _say(self, text: str, style: str) -> None:
        """Words in place of both cases."""
        self._sheet = None
        self._body.clear()
        with self._body:
            ui.label(text).classes(style)

    def _build(self, study: Study, tables: list[Table], other: Desk) -> None:
        """Places for both cases."""

        async def draw(ending: str) -> bytes:
            cases = other.case, (self._place.drawn or study).case
            return cast(bytes, await self._do(tasks.beside, *cases, _NAMES, ending))

        self._sheet = sheet = Sheet(self._do, study)
        self._body.clear()
        with self._body:
            for label, desk in zip(_NAMES, (other, self._desk()), strict=True):
                ui.label(f"{label}: {desk.title}").classes("soft")
                self._command = ui.code(desk.command()).classes("wrapped")
            self._place = Place("Losses of both cases", "losses-beside", "wide", draw)
            for table in tables:
                sheet.item(table)


class DesignView(View):
    """The front of a search for designs; a click on a point opens that design."""

    title = "Designs"
    _failed: Failure

    def __init__(self, folder: Path, worker: Worker, then: Callable[[Desk], None]) -> None:
        super().__init__()
        self._folder, self._worker, self._then = folder, worker, then
        self._front: Front | None = None

    async def show(self) -> None:
        """Where a file is dropped, and the front of the last one."""
        ui.label(_DESIGNS).classes("lead")
        ui.upload(
            label="Drop a task or candidates.nc here, or choose it",
            max_file_size=LARGEST_DATASET,
            auto_upload=True,
            on_upload=self._take,
            on_rejected=lambda: self._failed.tell(f"Files of up to {LARGEST_DATASET // 10**6} MB."),
        ).props("flat bordered accept=.toml,.nc").classes("upload")
        self._doing = Doing(self._worker.end)
        self._failed = Failure()
        self._body = ui.element("div")
        self._fill()

    async def _take(self, event: events.UploadEventArguments) -> None:
        self._failed.tell("")
        own = Path(tempfile.mkdtemp(dir=self._folder))
        try:
            path = received_task(event.file.name, await event.file.read(), own)
            with self._doing.shown("designs"):
                progress = self._doing.progress
                self._front = await self._worker.do(tasks.designs, path, progress=progress)
        except EpicyclicError as error:
            self._failed.tell(str(error))
        self._fill()

    def _fill(self) -> None:
        front = self._front
        if front is None or self._body.is_deleted:
            return
        self._body.clear()
        with self._body:
            ui.label(front.title).classes("heading")
            chart = ui.plotly(_chart(front.chart)).classes("still chart").mark("front")
            chart.style(f"height: {_FRONT_HEIGHT}rem").on("plotly_click", self._open)
            for table in front.tables:
                ui.html(_html(table), sanitize=False).classes("text")

    def _open(self, event: events.GenericEventArguments) -> None:
        number = event.args["points"][0].get("customdata")
        text = self._front.cases.get(number) if self._front is not None else None
        if text is not None:
            own = Path(tempfile.mkdtemp(dir=self._folder))
            self._then(received([(f"design-{number}.toml", text.encode())], own))


_FRONT_HEIGHT = 30  # Of its chart. [rem]
LARGEST_DATASET = 10_000_000  # Of an uploaded file. [bytes]
_DESIGNS = (
    "Gear sets of a given ratio that no other one beats. Give a task of 'epicyclic design', whose "
    "search begins at once, or the candidates.nc that it has written. A click on a point opens "
    "that design."
)


GROUPS = {
    "Result": (),
    "Trust": ("uncertainty", "validity", "methods"),
    "Parts": ("gears", "load", "friction", "bearing", "pockets", "temperatures", "oil"),
    "Studies": ("map", "compare", "designs"),
    "Case": ("inputs", "versions"),
}
"""Groups of tabs; what none of them names is in the first."""


def _group_of(name: str) -> str:
    return next((group for group, names in GROUPS.items() if name in names), next(iter(GROUPS)))


class Chapters:
    """Tabs, one for each chapter and view."""

    def __init__(
        self,
        shelf: Shelf,  # Knows the open chapter, also after the page was loaded again.
        do: Do,
        views: dict[str, View],
        want: Callable[[], Awaitable[None]],  # Has the opened chapter follow the case.
        tell: Callable[[Study, Sequence[KeyFigure]], None],  # Once the bands are known.
    ) -> None:
        self._shelf, self._do, self._views, self._want = shelf, do, views, want
        self._tell = tell
        self._turning = TurningView(do)
        self._sections: dict[str, str] = {}  # Titles of the chapters by their names.
        self._sheet: Sheet | None = None
        self._groups = ui.tabs(on_change=self._turn).props("dense no-caps align=left")
        self._tabs = ui.tabs(on_change=self._open).props("dense no-caps align=left")
        self._tabs.classes("chapters")
        self._last: dict[str, str] = {}  # What was open in each group.
        self._body = ui.element("div").classes("chapter")

    def clear(self) -> None:
        """Show nothing: another case is opened."""
        self._sections, self._sheet = {}, None
        self._last = {}
        for tabs in (self._groups, self._tabs):
            tabs.clear()
            tabs.set_value(None)
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
        for name in dict.fromkeys((tasks.BANDS, *self._sections)):
            # each by itself, so that the next value need not wait for all
            answer = await self._do(tasks.answered, study, name)
            if self._body.is_deleted or not is_wanted():
                return
            if name == tasks.BANDS:
                self._tell(study, answer.key_figures)
            elif name == tasks.FIRST and self._tabs.value == name:
                self._update(answer.sections[0], study, answer)
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
        """Have tabs for chapters and views, in groups."""
        sections = {section.name: section.title for section in found}
        titles = sections | {name: view.title for name, view in self._views.items()}
        if list(sections) != list(self._sections):
            groups = dict.fromkeys(_group_of(name) for name in titles)
            self._tabs.clear()
            self._groups.clear()
            with self._tabs:
                for name, title in titles.items():
                    ui.tab(name, label=title)
            with self._groups:
                for group in sorted(groups, key=list(GROUPS).index):
                    ui.tab(group)
        self._sections = sections
        if self._tabs.value not in titles:
            chapter = self._shelf.chapter
            self._tabs.set_value(chapter if chapter in titles else next(iter(sections)))
        self._group()

    def _group(self) -> None:
        """Show the tabs of the group of the open one."""
        name = str(self._tabs.value)
        group = _group_of(name)
        self._last[group] = name
        self._groups.set_value(group)
        for tab in self._tabs:
            tab.set_visibility(_group_of(str(tab.props["name"])) == group)

    def _turn(self) -> None:
        """Open what was open last in a group, or its first chapter."""
        group = self._groups.value
        if group is None or group == _group_of(str(self._tabs.value)):
            return
        names = [str(tab.props["name"]) for tab in self._tabs]
        first = next((name for name in names if _group_of(name) == group), None)
        self._tabs.set_value(self._last.get(group, first))

    async def _open(self) -> None:
        name = str(self._tabs.value)
        if name in self._sections or name in self._views:
            self._shelf.chapter = name
            self._group()
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
