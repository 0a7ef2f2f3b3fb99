"""Every element of trains has an error for its losses, and its figures are in the manual."""

from __future__ import annotations

from pathlib import Path
from typing import get_args, get_type_hints

import pytest

from epicyclic import library
from epicyclic.build.elements import _BUILDERS
from epicyclic.machine.element import PartFigures
from epicyclic.machine.shaft_parts import BearingModel
from epicyclic.study.bands.inputs import model_form_of

DOCS = Path(__file__).parents[2] / "docs"


def terms_of(kind):
    element = get_type_hints(_BUILDERS[kind])["return"]
    models = get_args(BearingModel) if kind == "bearings" else (element,)
    return {term for model in models for term in model.terms}


@pytest.mark.parametrize("kind", _BUILDERS)
def test_losses_of_an_element_have_an_error(kind):
    terms = terms_of(kind)
    assert terms
    lacking = {term for term in terms if model_form_of(f"part.{term}") == "other"}
    assert lacking == set(), "add a [[model_form]] to library/uncertainty.toml"
    assert model_form_of("part.unheard_of") == "other"


def test_kinds_of_errors_are_in_the_manual():
    text = (DOCS / "how-to" / "uncertainty.md").read_text(encoding="utf-8")
    kinds = {entry["kind"] for entry in library.uncertainty_table()["model_form"]}
    lacking = {kind for kind in kinds if f"`{kind}`" not in text}
    assert lacking == set(), "name them in docs/how-to/uncertainty.md"


def test_figures_of_parts_are_in_the_manual():
    text = (DOCS / "reference" / "results.md").read_text(encoding="utf-8")
    own = [it for it in PartFigures.__subclasses__() if it.__module__.startswith("epicyclic.")]
    assert len(own) >= len(_BUILDERS)
    missing = [it.__qualname__ for it in own if f"{it.__module__}.{it.__qualname__}" not in text]
    assert missing == [], "add them to docs/reference/results.md"
