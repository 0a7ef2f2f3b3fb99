"""The open figures of the published study of pocketing, for each model of the flow."""

from __future__ import annotations

import pytest

from epicyclic.validation.compare import CLOSURES, closure_figures

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def rows():
    return closure_figures()


def test_how_many_figures_hold(rows):
    assert len(rows) == 23
    held = {model: sum(row.holds(model) for row in rows) for model in CLOSURES}
    assert held == {"incompressible": 5, "isentropic": 3, "mean-density": 3, "talbot-2012": 11}


def test_every_figure_has_source_and_cause(rows):
    assert all(row.source and row.cause and row.tolerance > 0 for row in rows)
