"""Asking for the name of what the user adds to a case, and for what it stands."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

from nicegui import ui

from epicyclic.app.form import Group

Take = Callable[[str], Awaitable[str]]
"""Takes what was typed; what is wrong with it, or nothing."""


def ask_for_name(
    title: str,
    name: str,  # The one of now.
    take: Take,  # Takes the name; what is wrong with it, or nothing.
) -> None:
    """Ask for another name."""
    with ui.dialog() as dialog, ui.card().classes("asking"):
        ui.label(title).classes("section")
        field = _line("name", name)
        _buttons(dialog, lambda: take(str(field.value or "")))
    dialog.open()


def ask_for_new(
    group: Group,
    # Takes the name, and what a case file has for it; what is wrong with it, or nothing.
    take: Callable[[str, object], Awaitable[str]],
) -> None:
    """Ask for a new name in a table of names, and what it stands for."""
    sample = group.sample
    with ui.dialog() as dialog, ui.card().classes("asking"):
        ui.label(f"Add to {group.name}").classes("section")
        field = _line("name", "")
        kinds = {number: kind.about for number, kind in enumerate(group.kinds)}
        choice = ui.select(kinds, value=0, label="what it is").props("dense outlined")
        choice.classes("field").mark("new-kind").set_visibility(len(kinds) > 1)
        value = _line("value", "", sample.unit if sample else "").mark("new-value")
        value.set_visibility(sample is not None)
        if sample is not None:
            ui.label(f"The value: {sample.about}.").classes("soft")

        async def done() -> str:
            name = str(field.value or "")
            if sample is None:
                return await take(name, group.kinds[choice.value or 0].tables)
            stands_for = sample.value(str(value.value or ""))
            if stands_for is None:
                return f"A value is missing. It must be {sample.about}."
            return await take(name, stands_for)

        _buttons(dialog, done)
    dialog.open()


def _line(label: str, text: str, unit: str = "") -> ui.input:
    field = ui.input(label, value=text).props("dense outlined").classes("field")
    if unit:
        field.props["suffix"] = unit
    return field.mark(f"new-{label}")


def _buttons(dialog: ui.dialog, done: Callable[[], Awaitable[str]]) -> None:
    told = ui.label("").classes("told")

    async def finish() -> None:
        wrong = await done()
        if wrong:
            told.set_text(wrong)
        else:
            dialog.close()

    with ui.row():
        ui.button("OK", on_click=finish).props("unelevated no-caps dense")
        ui.button("Cancel", on_click=dialog.close).props("flat no-caps dense")
