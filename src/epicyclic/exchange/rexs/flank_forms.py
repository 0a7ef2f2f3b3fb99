"""Modifications of the flanks in a REXS file to micro geometry.

Taken are those whose meaning is the same on both sides. The others are noted: slopes, whose sign
the attribute database does not define, and modifications that differ between the flanks of a gear.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from epicyclic.exchange.rexs.draft import Draft, Lack
from epicyclic.exchange.rexs.gears import flanks_of
from epicyclic.exchange.rexs.model import Component, Model


@dataclass(frozen=True, slots=True)
class _Form:
    """A type of modification, the key of its amount, and the attributes that hold it."""

    type: str
    key: str
    amounts: tuple[str, ...]
    extents: tuple[tuple[str, str], ...] = ()
    has_shape: bool = False
    over: str = ""


_TAKEN = (
    _Form("tip_relief", "tip_relief", ("tip_relief_depth",),
          (("tip_relief_diameter", "tip_relief_datum_diameter"),), has_shape=True),
    _Form("root_relief", "root_relief", ("root_relief_depth",),
          (("root_relief_diameter", "root_relief_datum_diameter"),), has_shape=True),
    _Form("profile_crowning", "profile_crown",
          ("profile_crowning_at_tip", "profile_crowning_at_root"),
          over=", over the active profile"),
    _Form("helix_crowning", "lead_crown",
          ("helix_crowning_amount_datum_face", "helix_crowning_amount_non_datum_face"),
          over=", over the face width"),
)  # fmt: skip
_NOT_TAKEN = {
    "profile_slope": "profile_slope",
    "helix_slope": "lead_slope",
    "end_relief_datum_face": "end_relief",
    "end_relief_non_datum_face": "end_relief",
    "topographical_modification": "topography",
    "triangular_tip_relief": "topography",
    "triangular_root_relief": "topography",
    "profile_twist": "topography",
}
_AMOUNTS = {
    "profile_slope": "profile_slope",
    "helix_slope": "helix_slope",
    "end_relief_datum_face": "end_relief_depth_datum_face",
    "end_relief_non_datum_face": "end_relief_depth_non_datum_face",
}
_SHAPES = ("linear", "parabolic")


def micro_geometry(draft: Draft, model: Model, key: str, gears: Sequence[Component]) -> None:
    """Table ``micro_geometry`` of gears that are alike."""
    flanks = flanks_of(model, gears)
    for form in _TAKEN:
        items = _of_type(model, flanks, form.type)
        if items and any(_amount(item, name) != 0 for item in items for name in form.amounts):
            _take(draft, key, form, items, len(flanks))
    for kind, name in _NOT_TAKEN.items():
        items = _of_type(model, flanks, kind)
        if items and (kind not in _AMOUNTS or any(_amount(i, _AMOUNTS[kind]) != 0 for i in items)):
            _leave(draft, key, name, items, "its sign or form is not the same here")


def _of_type(model: Model, flanks: Sequence[Component], kind: str) -> list[Component]:
    return [
        item
        for flank in flanks
        for item in model.partners(flank.id, "reference", "origin", "referenced", kind)
    ]


def _take(draft: Draft, key: str, form: _Form, items: Sequence[Component], flanks: int) -> None:
    amounts = {_amount(item, name) for item in items for name in form.amounts}
    shapes = {_shape(item) for item in items} if form.has_shape else {"parabolic"}
    (amount, *others), (shape, *_) = amounts, shapes
    if len(items) < flanks or others or amount is None or amount <= 0:
        _leave(draft, key, form.key, items, "it is not the same positive amount on all flanks")
        return
    if len(shapes) > 1 or shape not in _SHAPES or any(_is_added(item) for item in items):
        _leave(draft, key, form.key, items, "its shape is not linear or parabolic")
        return
    start = f"{key}.micro_geometry."
    found = draft.read(form.amounts[0], items)
    assert found is not None
    draft.give(f"{start}{form.key}", found.text, f"{found.origin}{form.over}")
    if form.has_shape:
        draft.give(f"{start}{form.key}_shape", shape, f"shape_of_relief of {items[0]}")
    for name, attribute in form.extents:
        draft.take(f"{start}{name}", attribute, items)


def _leave(draft: Draft, key: str, name: str, items: Sequence[Component], reason: str) -> None:
    full = f"{key}.micro_geometry.{name}"
    draft.lacks[full] = Lack(
        full, f"{items[0]} is there, but {reason}", False, "Not taken: set the key yourself."
    )


def _amount(item: Component, name: str) -> float | None:
    """The amount of a modification; 0 if it is not given, None if it cannot be read."""
    try:
        found = item.amount(name)
    except ValueError:
        return None
    return 0.0 if found is None else found[0]


def _shape(item: Component) -> str:
    shape = item.get("shape_of_relief")
    return "linear" if shape is None else shape.text()


def _is_added(item: Component) -> bool:
    """True if the modification adds material."""
    added = item.get("is_additive_modification")
    return added is not None and added.text().lower() == "true"
