"""A line that tells what is being computed, how far it is, and ends it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from nicegui import ui


class Doing:
    """The line; it is there while something is done.

    Parameters
    ----------
    end : callable
        Ends it.
    """

    def __init__(self, end: Callable[[], None]) -> None:
        with ui.row().classes("state idle") as self._row:
            ui.spinner(size="1.2em")
            self._label = ui.label()
            self._bar = ui.linear_progress(0, show_value=False).classes("progress")
            ui.button("Cancel", on_click=end).props("flat dense no-caps")
        self._count, self._noun = 0, ""

    @contextmanager
    def shown(self, noun: str) -> Iterator[None]:
        """Show the line while the block runs; of blocks within each other until the last ends."""
        self._noun = noun
        self._count += 1
        self._label.set_text(noun)
        self._bar.set_visibility(False)
        self._row.classes(remove="idle")
        try:
            yield
        finally:
            self._count -= 1
            if not self._count:
                self._row.classes("idle")

    def progress(self, done: int, total: int) -> None:
        """Tell how far it is; without a total, functions that a first run has compiled."""
        self._bar.set_visibility(total > 0)
        self._bar.set_value(done / total if total else 0)
        first = f"first run of this version, compiling the numerics: {done} functions so far"
        self._label.set_text(f"{self._noun}: {done} of {total}" if total else first)
