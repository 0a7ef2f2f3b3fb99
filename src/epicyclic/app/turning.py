"""Gears that turn on the page while a slider moves: drawn once, turned by the browser."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import cast

from nicegui import ui

from epicyclic.app import tasks
from epicyclic.app.sheet import Do, Place
from epicyclic.app.tasks import IN_PAGE, MESH, Study

PERIODS, STEP = 4, 0.005
"""Range and step of the slider. [mesh periods]"""


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
