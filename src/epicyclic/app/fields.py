"""The form on the page: groups that open, a field for each key, its problem beside it."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from functools import partial

from nicegui import ui
from nicegui.element import Element

from epicyclic.app.desk import Desk
from epicyclic.app.form import Entry, Group

__all__ = ["Form"]

_OPEN = "operation"
"""The table that is open at first."""


class Form:
    """Fields of a desk.

    Parameters
    ----------
    desk : Desk
    changed : callable
        Called after the desk has changed.
    """

    def __init__(self, desk: Desk, changed: Callable[[], Awaitable[None]]) -> None:
        self._desk, self._changed = desk, changed
        self._fields: dict[str, ui.input | ui.select] = {}
        self._groups: dict[str, ui.expansion] = {}
        form = desk.form()
        for entry in form.entries:
            self._field(entry)
        for group in form.groups:
            self._group(group)

    def show_problems(self) -> None:
        """Mark fields and groups with problems."""
        for key, field in self._fields.items():
            found = self._desk.problems_of(key)
            field.error = f"{found[0].allowed} {found[0].remedy}" if found else None
        for key, group in self._groups.items():
            wrong = any(problem.key.startswith(f"{key}.") for problem in self._desk.problems)
            group.classes(add="wrong" if wrong else "", remove="" if wrong else "wrong")

    def _group(self, group: Group) -> None:
        name = group.key.rpartition(".")[2]
        is_open = group.key == _OPEN
        box = ui.expansion(name, caption=group.about, value=is_open).classes("group")
        box.classes(add="" if group.is_given else "unset")
        self._groups[group.key] = box
        if is_open:
            self._fill(box, group)
        else:
            box.on_value_change(partial(self._fill_once, box, group))

    def _fill_once(self, box: ui.expansion, group: Group) -> None:
        """Fields are made when they are first looked at: there are hundreds."""
        if not box.default_slot.children:
            self._fill(box, group)
            self.show_problems()

    def _fill(self, box: Element, group: Group) -> None:
        with box:
            for entry in group.entries:
                self._field(entry)
            for inner in group.groups:
                self._group(inner)

    def _field(self, entry: Entry) -> None:
        field: ui.input | ui.select
        if entry.choices:
            options = dict.fromkeys(entry.choices) | {one: one for one in entry.choices}
            field = ui.select(
                {"": f"{entry.default} (default)"} | options, value=entry.text, label=entry.name
            )
            field.on_value_change(partial(self._take, entry))
        else:
            field = ui.input(
                entry.name,
                value=entry.text,
                placeholder=entry.default,
                suffix=entry.unit,
                autocomplete=list(entry.suggestions),
            )
            field.on("change", partial(self._take, entry))
        field.props("dense outlined stack-label hide-bottom-space no-error-icon")
        field.classes("field").mark(entry.key)
        with field:
            ui.tooltip(f"{entry.key}: {entry.about}").props("delay=600 max-width=26rem")
        self._fields[entry.key] = field

    async def _take(self, entry: Entry) -> None:
        self._desk.change(entry.key, entry.value(str(self._fields[entry.key].value or "")))
        await self._changed()
