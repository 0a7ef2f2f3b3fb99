"""Tables of fitted quantities against the fits themselves, for meshes and bearings."""

from __future__ import annotations

import numpy as np
import pytest

import asymmetric
import epicyclic as ep
from epicyclic.losses import rolling as fitted
from epicyclic.losses.rolling import RaceContacts

CASES = {
    "asymmetric": (asymmetric.planetary, "iso-vg-100-pao"),
    "helical pair": (asymmetric.gear_pair, "iso-vg-320-mineral"),
    "talbot-2012": (lambda: "talbot-2012", "atf-dexron-vi"),
    "e-axle": (lambda: "train-eaxle", "75w-90-gear-oil"),
}


@pytest.fixture(params=CASES)
def looked_up(request, monkeypatch):
    """What was asked of tables while a case was solved: arguments and answers."""
    seen = []

    def remember(*arguments):
        answer = found(*arguments)
        seen.append((*arguments, answer))
        return answer

    found = fitted.tabulated
    monkeypatch.setattr(fitted, "tabulated", remember)
    tables, oil = CASES[request.param]
    case = ep.load_case(tables())
    models = (
        {"models.preset": "talbot-2012"}
        if case.kind == "train"
        else {"models.friction": "fitted", "models.rolling": "fitted"}
    )
    ep.solve(case.updated({"lubricant": {"oil": oil}, **models}))
    return seen


def test_losses_are_those_of_the_fit(looked_up):
    """Of meshes to 2e-5, of bearings to 1e-6; at single contacts to 1e-3, where a fit has a kink.

    At the pitch point itself a fit may jump with the sign of the slip, which is rounding there.
    """
    kinds = set()
    for model, quantity, form, contacts, told in looked_up:
        direct = model.value(quantity, contacts, form)
        race = isinstance(contacts, RaceContacts)
        kinds.add((quantity, race))
        weight = 1.0 if race else contacts.weight
        if quantity == "friction":
            weight = weight * contacts.line_load * np.abs(contacts.sliding_speed)
        slides = (contacts.slide_to_roll_ratio > 1e-6) | race
        np.testing.assert_allclose(told[slides], direct[slides], rtol=1e-3)
        assert (told * weight).sum() == pytest.approx(
            (direct * weight).sum(), rel=1e-6 if race else 2e-5
        )
    assert {("friction", False), ("rolling_loss", False)} <= kinds
