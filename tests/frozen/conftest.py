"""What was frozen was computed with the models that ``auto`` stood for then."""

from __future__ import annotations

import pytest

from epicyclic.build import models
from epicyclic.case.tables import uncertainty


@pytest.fixture(autouse=True)
def former_models(monkeypatch):
    """Cases as with the preset talbot-2012, without a key for it."""
    monkeypatch.setattr(models, "GENERAL", {})
    monkeypatch.setattr(uncertainty, "has_rough_flanks", lambda models: False)
