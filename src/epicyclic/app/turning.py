"""Gears that turn on the page while a slider moves: drawn once, turned by the browser."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import cast

from nicegui import ui

from epicyclic.app import tasks
from epicyclic.app.sheet import Do, save_buttons
from epicyclic.app.tasks import IN_PAGE, MESH
from epicyclic.app.worker import Ended
from epicyclic.case.case import Case

__all__ = ["TurningView"]

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
        self._case: Case | None = None
        self._places: dict[str, ui.html] = {}
        self._slider: ui.slider | None = None

    def build(self, titles: Mapping[str, str]) -> None:
        """Make the slider and places for pictures."""
        self._places = {}
        if not titles:
            return
        with ui.row().classes("turner"):
            play = ui.button(icon="play_arrow").props("flat round dense").tooltip("Turn, or stop")
            play.on("click", js_handler="(event) => turning.play(event.currentTarget)")
            phase = self._slider.value if self._slider else 0.0
            self._slider = ui.slider(min=0, max=PERIODS, step=STEP, value=phase).mark("phase")
            self._slider.on("update:model-value", js_handler="(phase) => turning.turn(phase)")
            ui.label("mesh periods").classes("soft")
        with ui.element("div").classes("turned"):
            for what, title in titles.items():
                self._place(what, title)

    def _place(self, what: str, title: str) -> None:
        async def draw(ending: str) -> bytes:
            assert self._slider is not None
            phase = float(self._slider.value)
            content, _ = await self._do(tasks.turning, self._case, what, ending, phase)
            return cast(bytes, content)

        with ui.element("figure").classes("mesh" if what.startswith(MESH) else ""):
            self._places[what] = ui.html("", sanitize=False).classes("still")
            with self._places[what]:
                ui.spinner(size="2em")
            with ui.element("figcaption"):
                ui.label(title)
                save_buttons("turning", draw)

    async def draw(self, case: Case) -> None:
        """Draw everything for a case."""
        self._case = case
        for what, place in list(self._places.items()):
            try:
                svg, data = await self._do(tasks.turning, case, what, IN_PAGE, 0.0)
            except Ended:
                return
            if place.is_deleted:
                return
            place.set_content(svg.decode())
            data["phase"] = self._slider.value if self._slider else 0.0
            ui.run_javascript(f"turning.add({json.dumps(place.html_id)}, {json.dumps(data)})")
