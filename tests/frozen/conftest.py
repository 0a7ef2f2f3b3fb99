"""What was frozen was computed with the models that ``auto`` stood for then."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from epicyclic.build import models
from epicyclic.case import keys
from epicyclic.case.tables import uncertainty
from epicyclic.gears.flanks import FlankDeviations
from epicyclic.gears.gearing import Gearing
from epicyclic.losses import drag
from epicyclic.losses.shaft_bearing import Flagged
from epicyclic.losses.windage import LAMINAR_RIMS
from epicyclic.losses.zhou_hoeprich import ThrustRollerModel
from epicyclic.machine import gear_set, planets
from epicyclic.study.bands import inputs

BOUNDARY = uncertainty.DistributionTable(uniform=(0.08, 0.13))


@pytest.fixture(autouse=True)
def former_models(monkeypatch):
    """Cases as with the preset talbot-2012, without a key for it."""
    monkeypatch.setattr(models, "GENERAL", {"drag": LAMINAR_RIMS})
    monkeypatch.setattr(uncertainty, "has_rough_flanks", lambda models: False)


@pytest.fixture(autouse=True)
def former_viscous_loss(monkeypatch):
    """The viscous loss of planet bearings was added to their rolling, as with that preset."""
    solved = gear_set.solve_bearing

    def as_then(key, own, *args, **others):
        return solved(key, replace(own, viscous_added=True), *args, **others)

    monkeypatch.setattr(gear_set, "solve_bearing", as_then)


@pytest.fixture(autouse=True)
def former_tips(monkeypatch):
    """As with gears.tip_alteration = "none", without a key for it."""
    monkeypatch.setattr(Gearing, "tip_shortenings", {})


@pytest.fixture(autouse=True)
def no_limit_of_viscosity(monkeypatch):
    """Thick oil in bearings went without a flag."""
    boundless = replace(drag.THICKEST, high=1e9)
    monkeypatch.setattr(drag, "THICKEST", boundless)
    monkeypatch.setattr(Flagged, "thickest", ("viscous", boundless))
    monkeypatch.setattr(ThrustRollerModel, "thickest", ("mechanical", boundless))


@pytest.fixture(autouse=True)
def former_boundary_friction(monkeypatch):
    """What was assumed of it then did not lie about the value that a case states, if it did."""
    monkeypatch.setattr(keys, "_of_oil", lambda case, key: None)
    assumed = tuple(
        replace(it, table=BOUNDARY) if it.holds_for("models.boundary_friction") else it
        for it in inputs._assumptions()
    )
    monkeypatch.setattr(inputs, "_assumptions", lambda: assumed)


@pytest.fixture(autouse=True)
def former_factors_of_models(monkeypatch):
    """They were larger before the residuals of tapered bearings and of slopes became smaller."""
    forms = uncertainty.model_forms()
    former = {"shaft-bearings": 1.25, "sliding": 1.15}
    then = forms | {kind: (factor, forms[kind][1]) for kind, factor in former.items()}
    for module in (uncertainty, inputs):
        monkeypatch.setattr(module, "model_forms", lambda: then)


@pytest.fixture(autouse=True)
def former_face_width(monkeypatch):
    """Deviations over it began where contact begins if gear 1 drives, whichever gear drove."""
    made = FlankDeviations.__init__

    def as_then(self, *args, mirrored=False, **others):
        made(self, *args, **others)

    monkeypatch.setattr(FlankDeviations, "__init__", as_then)


@pytest.fixture(autouse=True)
def former_rollers(monkeypatch):
    """The force of rotation on rollers that carry no load did not count.

    It adds 0.5 % to the loss of the planet bearings of talbot-2012 at 4000 rpm, 5 % at 12,000 rpm.
    """
    monkeypatch.setattr(
        planets, "centrifugal_forces", lambda _, azimuth, *others: np.zeros_like(azimuth)
    )
