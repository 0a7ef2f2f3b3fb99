"""The form on the page: groups, a field for each key, names that the user adds."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from functools import partial

from nicegui import ui
from nicegui.element import Element

from epicyclic.plugins.app.case_form import Desk, Entry, Group, number_in, owner_of
from epicyclic.result.result import in_words
from epicyclic.show.template import toml_key

Take = Callable[[str], Awaitable[str]]  # Takes what was typed; what is wrong with it, or nothing.


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


_OPEN = "operation"  # The table that is open at first.
_STEPS, _DIGITS = 200, 6  # Steps of the slider of an input, and digits of its values.
_THROTTLE = 0.05  # Between two values of a slider that moves. [s]
Call = Callable[[], Awaitable[None]]


class Form:
    """Fields of a desk, and what to call after it has changed or while a slider changes it."""

    def __init__(self, desk: Desk, changed: Call, moved: Call) -> None:
        self._desk, self._changed, self._moved = desk, changed, moved
        self._fields: dict[str, ui.input | ui.select] = {}
        self._groups: dict[str, ui.expansion] = {}
        self._open = {_OPEN}
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
            wrong = any(f"{problem.key}.".startswith(f"{key}.") for problem in self._desk.problems)
            group.classes(**{"add" if wrong else "remove": "wrong"})

    def _group(self, group: Group) -> None:
        is_open = group.key in self._open
        name = group.name if group.is_own else in_words(group.name).capitalize()
        box = ui.expansion(name, caption=group.about, value=is_open).classes("group")
        box.classes(add="" if group.is_given else "unset").mark(f"group-{group.key}")
        self._groups[group.key] = box
        if is_open:
            self._fill(box, group)
        box.on_value_change(partial(self._opened, box, group.key))

    def _opened(self, box: ui.expansion, key: str) -> None:
        """Fields are made when they are first looked at: there are hundreds."""
        if not box.value:
            self._open.discard(key)
            return
        self._open.add(key)
        group = self._desk.form().find(key)
        if not box.default_slot.children and group is not None:
            self._fill(box, group)
            self.show_problems()

    def _fill(self, box: Element, group: Group) -> None:
        with box:
            if group.is_own or (group.is_optional and group.is_given):
                with ui.row().classes("own"):
                    if group.is_own:
                        _small("Rename", partial(self._ask_rename, group.key, group.name))
                    _small("Remove", partial(self._remove, group.key))
            for entry in group.entries:
                self._field(entry)
            for inner in group.groups:
                self._group(inner)
            if group.kinds:
                _small(f"Add to {group.name}", partial(self._ask_new, group))

    async def _renew(self, key: str) -> None:
        """Make the fields of a group again: it has other names."""
        group, box = self._desk.form().find(key), self._groups[key]
        below = f"{key}."
        for known in (self._fields, self._groups):
            for inner in [one for one in known if one.startswith(below)]:
                del known[inner]
        box.clear()
        box.classes(**{"remove" if group and group.is_given else "add": "unset"})
        if group is not None and key in self._open:
            self._fill(box, group)
        await self._changed()

    async def _remove(self, key: str) -> None:
        self._desk.remove(key)
        owner = owner_of(key)  # none of a table that stands outside of others
        await self._renew(owner if owner in self._groups else key)

    def _ask_rename(self, key: str, name: str) -> None:
        async def rename(new: str) -> str:
            is_open = key in self._open
            if told := self._desk.rename(key, new):
                return told
            if is_open:
                self._open.add(f"{owner_of(key)}.{toml_key(new.strip())}")
            await self._renew(owner_of(key))
            return ""

        ask_for_name(f"Rename {name}", name, rename)

    def _ask_new(self, group: Group) -> None:
        async def add(name: str, value: object) -> str:
            if told := self._desk.add(group.key, name, value):
                return told
            self._open.add(f"{group.key}.{toml_key(name.strip())}")
            await self._renew(group.key)
            return ""

        ask_for_new(group, add)

    def _field(self, entry: Entry) -> None:
        with ui.element("div").classes("holder") as holder:
            field = _choice(entry) if entry.choices else _field_line(entry)
            event = "update:model-value" if entry.choices else "change"
            field.on(event, partial(self._take, entry))
            field.props("dense outlined stack-label hide-bottom-space no-error-icon")
            field.props["hint"] = entry.key if entry.key != _label(entry) else None
            field.classes("field").mark(entry.key)
            with field:
                ui.tooltip(entry.about).props("delay=600 max-width=26rem")
        self._fields[entry.key] = field
        if entry.is_own:
            with field.add_slot("append"):
                rename = partial(self._ask_rename, entry.key, entry.name)
                _icon("edit", rename).tooltip("Rename")
                _icon("close", partial(self._remove, entry.key)).tooltip("Remove")
        elif not (entry.choices or entry.is_text) and number_in(entry.text) is not None:
            with field.add_slot("append"):
                _icon("tune", partial(self._slider, entry, holder)).mark(f"tune-{entry.key}")

    def _slider(self, entry: Entry, holder: Element) -> None:
        """Show the slider of an input below its field, or take it away."""
        sliders = [child for child in holder if isinstance(child, ui.slider)]
        if sliders:
            sliders[0].delete()
            return
        now = number_in(str(self._fields[entry.key].value)) or 0.0
        low, high = sorted((0.0, 2 * now or 1.0))
        is_count = entry.quantity is None and now == int(now) and "." not in entry.text
        with holder:
            slider = ui.slider(
                min=low, max=high, step=1 if is_count else (high - low) / _STEPS, value=now
            )
        slider.props("label dense").mark(f"slider-{entry.key}")
        slider.on("update:model-value", partial(self._move, entry, slider), throttle=_THROTTLE)
        slider.on("change", self._changed)

    async def _move(self, entry: Entry, slider: ui.slider) -> None:
        text = f"{slider.value:.{_DIGITS}g}"
        self._fields[entry.key].set_value(text)
        self._desk.change(entry.key, entry.value(text))
        await self._moved()

    async def _take(self, entry: Entry) -> None:
        text = str(self._fields[entry.key].value or "")
        self._desk.change(entry.key, entry.value(text))
        self._fields[entry.key].set_value(entry.shown(text))
        await self._changed()


def _label(entry: Entry) -> str:
    """The key in words; a name of the user as it is."""
    return entry.name if entry.is_own else in_words(entry.name.replace(".", " "))


def _choice(entry: Entry) -> ui.select:
    unset = f"{entry.default} (default)" if entry.default else "not given"
    unset = entry.default if entry.is_required else unset
    options = {"": unset} | {one: one for one in entry.choices}
    value = entry.text if entry.text in options else ""
    return ui.select(options, value=value, label=_label(entry))


def _field_line(entry: Entry) -> ui.input:
    return ui.input(
        _label(entry),
        value=entry.text,
        placeholder=entry.default,
        suffix=entry.unit,
        autocomplete=list(entry.suggestions),
    )


def _small(label: str, then: Callable[[], object]) -> None:
    """A button for names."""
    ui.button(label, on_click=then).props("flat dense no-caps size=sm")


def _icon(icon: str, then: Callable[[], object]) -> ui.button:
    """A button in a field."""
    return ui.button(icon=icon, on_click=then).props("flat dense round size=sm tabindex=-1")
