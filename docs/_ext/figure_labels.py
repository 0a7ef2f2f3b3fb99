"""List the labelled fields of result classes in the reference, with the units they carry."""

from __future__ import annotations

import dataclasses
from typing import Any

from sphinx.application import Sphinx


def add_fields(app: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Append an Attributes section, in SI, to the docstring of a class with labelled fields."""
    if what != "class" or not dataclasses.is_dataclass(obj):
        return
    labelled = [field for field in dataclasses.fields(obj) if "label" in field.metadata]
    if not labelled:
        return
    lines += ["", "Attributes", "----------"]
    for field in labelled:
        label, unit = field.metadata["label"], field.metadata["unit"].si or "1"
        lines += [f"{field.name} : float", f"    {label[0].upper()}{label[1:]}. [{unit}]"]


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", add_fields, priority=400)  # before napoleon
    return {"parallel_read_safe": True}
