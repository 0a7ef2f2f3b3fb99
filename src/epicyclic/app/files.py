"""Opening and saving: files go through the browser, never by a path on the page."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

from nicegui import events, ui

from epicyclic import library
from epicyclic.app import tasks
from epicyclic.app.desk import ENDINGS, Desk, built_in, received
from epicyclic.app.guard import LARGEST_BODY
from epicyclic.app.sheet import Do
from epicyclic.app.worker import Ended
from epicyclic.errors import EpicyclicError, InputError

RESULTS = {
    ".nc": "Result with all its fields",
    ".json": "Result as JSON",
    ".html": "Report",
    ".rexs": "REXS file with the results",
}
MOST_FILES = 20


def ask_for_case(
    folder: Path,  # In which uploaded files are kept, each time in a new folder.
    then: Callable[[Desk], None],
) -> None:
    """Ask for a case, built in or a file of the user; call `then` with its desk."""
    with ui.dialog() as dialog, ui.card().classes("asking"):
        ui.label("Open a case").classes("section")
        told = ui.label("").classes("told")

        def take(make: Callable[[], Desk]) -> None:
            try:
                desk = make()
            except InputError as error:
                # where a received file lies is of no use to who sent it
                told.set_text(str(InputError(error.problems, Path(error.source).name)))
                return
            dialog.close()
            then(desk)

        async def upload(event: events.MultiUploadEventArguments) -> None:
            files = [(file.name, await file.read()) for file in event.files]
            own = Path(tempfile.mkdtemp(dir=folder))
            take(lambda: received(files, own))

        with ui.row():
            for name in library.case_files():
                ui.button(name, on_click=lambda name=name: take(lambda: built_in(name))).props(
                    "outline no-caps dense"
                )
        ui.label(
            f"Or a file of your own, {', '.join(ENDINGS)}, with the files that it names:"
        ).classes("soft")
        ui.upload(
            label="Drop files here, or choose them",
            multiple=True,
            max_file_size=LARGEST_BODY,
            max_total_size=LARGEST_BODY,
            max_files=MOST_FILES,
            auto_upload=True,
            on_multi_upload=upload,
            on_rejected=lambda: told.set_text(f"Files of up to {LARGEST_BODY // 10**6} MB."),
        ).props("flat bordered").classes("upload")
    dialog.open()


def save_menu(desk: Callable[[], Desk], do: Do) -> None:
    """A menu of all that can be saved of a case."""

    async def save(ending: str) -> None:
        now = desk()
        if now.case is None:
            ui.notify("The case has problems: mend them first.")
            return
        original = now.original if ending == ".rexs" else None
        suffix = Path(original).suffix if original else ending
        try:
            content = await do(tasks.saved, now.case, suffix, original)
        except (Ended, EpicyclicError) as error:
            ui.notify(str(error), multi_line=True)
            return
        ui.download(content, f"{_stem(now)}{suffix}")

    def save_case() -> None:
        ui.download(desk().text().encode(), f"{_stem(desk())}.toml")

    with ui.button("Save", icon="save").props("flat no-caps"), ui.menu():
        ui.menu_item("Case file", save_case)
        for ending, title in RESULTS.items():
            ui.menu_item(f"{title}, {ending}", partial(save, ending))


def _stem(desk: Desk) -> str:
    return Path(desk.source).stem or "case"
