"""Gears that turn on the page while a slider moves: drawn once, turned by the browser."""

from __future__ import annotations

import json
from collections.abc import Awaitable, Callable, Mapping
from functools import partial
from typing import Any

from nicegui import ui

from epicyclic.app.worker import Ended
from epicyclic.case.case import Case
from epicyclic.errors import EpicyclicError

__all__ = ["FORMATS", "TurningView"]

FORMATS = ("png", "svg", "pdf")
PERIODS, STEP = 4, 0.005
"""Range and step of the slider. [mesh periods]"""
IN_PAGE = "svg-page"
Draw = Callable[[Case, str, str, float], Awaitable[tuple[bytes, dict[str, Any]]]]
"""Draws what turns of a case in a format at a phase."""


class TurningView:
    """A slider, and the sets and meshes that follow it.

    Parameters
    ----------
    draw : callable
    """

    def __init__(self, draw: Draw) -> None:
        self._draw = draw
        self._case: Case | None = None
        self._places: dict[str, ui.html] = {}
        self._phase = 0.0

    def build(self, titles: Mapping[str, str]) -> None:
        """Make the slider and places for pictures."""
        self._places = {}
        if not titles:
            return
        with ui.row().classes("turner"):
            ui.button(icon="play_arrow").props("flat round dense").on(
                "click", js_handler="(event) => turning.play(event.currentTarget)"
            ).tooltip("Turn, or stop")
            self._slider = ui.slider(min=0, max=PERIODS, step=STEP, value=self._phase)
            self._slider.on("update:model-value", js_handler="(phase) => turning.turn(phase)")
            ui.label("mesh periods").classes("soft")
        with ui.element("div").classes("turned"):
            for what, title in titles.items():
                with ui.element("figure").classes("mesh" if what.startswith("/") else ""):
                    self._places[what] = ui.html("", sanitize=False).classes("still")
                    with ui.element("figcaption"):
                        ui.label(title)
                        with ui.element("div").classes("formats"):
                            for ending in FORMATS:
                                ui.button(ending, on_click=partial(self._save, what, ending)).props(
                                    "flat dense no-caps"
                                )

    async def draw(self, case: Case) -> None:
        """Draw everything for a case."""
        self._case = case
        for what, place in list(self._places.items()):
            try:
                svg, data = await self._draw(case, what, IN_PAGE, 0.0)
            except Ended:
                return
            except EpicyclicError as error:
                place.set_content(str(error))
                continue
            if self._places.get(what) is not place:
                return
            place.set_content(svg.decode())
            ui.run_javascript(f"turning.add({json.dumps(place.html_id)}, {json.dumps(data)})")

    async def _save(self, what: str, ending: str) -> None:
        if self._case is not None:
            phase = float(self._slider.value)
            content, _ = await self._draw(self._case, what, ending, phase)
            ui.download(content, f"turning.{ending}")
