"""Temperatures that settle with losses, also where these scatter."""

from __future__ import annotations

import itertools
from types import SimpleNamespace

import pytest

import epicyclic as ep
from epicyclic.machine import heat as settling
from epicyclic.machine.heat import AGREEMENT, SCATTER, SCATTERING_FROM, Answer, settle

SCATTERED = (0.31, -0.83, 0.57, -0.24, 0.92, -0.66, 0.13)
"""Of one evaluation after another, over the largest. [1]"""


class Model:
    """Two parts, the second of which follows the first; the equilibrium is at 350 and 340 K."""

    def __init__(self, scatter):
        self.start = {"oil": 320.0, "housing": 310.0}
        self.off = (scatter * part for part in itertools.cycle(SCATTERED))

    def fluids(self, temperatures):
        return temperatures

    def answer(self, solution):
        oil, off = solution["oil"], next(self.off)
        return Answer(
            {"oil": 350 - 0.4 * (oil - 350) + off, "housing": 0.5 * oil + 165 + 0.7 * off}
        )


@pytest.fixture
def settled(monkeypatch):
    """Temperatures of the model; the solution is them, unless `whole` makes it of them."""
    monkeypatch.setattr(settling, "start_of", lambda *_: None)
    monkeypatch.setattr(settling, "solve_machine", lambda *_: None)

    def settled(scatter, *, agree=True, whole=lambda at: at):
        def solve(wanted):
            return [(whole(it.fluids), True) if it.whole else (it.fluids, agree) for it in wanted]

        monkeypatch.setattr(settling, "solve_machines", solve)
        (found,) = settle([(SimpleNamespace(), SimpleNamespace(), Model(scatter))])
        if isinstance(found, Exception):
            raise found
        return found

    return settled


def test_temperatures_settle_in_a_few_evaluations(settled):
    found = settled(0.0)
    assert found.answer.temperatures == pytest.approx({"oil": 350, "housing": 340}, abs=AGREEMENT)
    assert found.evaluations < 8
    assert found.change <= AGREEMENT


def test_torques_agree_with_the_losses_in_the_end(settled):
    whole = []
    found = settled(0.0, agree=False, whole=lambda at: whole.append(at) or at)
    assert found.solution is whole[-1]
    assert len(whole) == 1
    assert found.answer.temperatures == pytest.approx({"oil": 350, "housing": 340}, abs=AGREEMENT)


def test_torques_that_never_let_temperatures_settle_are_told(settled):
    off = itertools.count(0.4, 0.4)  # what the whole solution adds, in each pass more
    with pytest.raises(
        ep.ConvergenceError, match=r"do not settle: .* change by \d\.\d+ K, near oil"
    ):
        settled(0.0, agree=False, whole=lambda at: at | {"oil": at["oil"] + next(off)})


def test_losses_that_scatter_settle_to_their_scatter_and_tell(settled):
    found = settled(0.012)
    assert found.answer.temperatures == pytest.approx({"oil": 350, "housing": 340}, abs=0.04)
    assert found.evaluations > SCATTERING_FROM
    assert AGREEMENT < found.change <= SCATTER


def test_losses_that_scatter_by_more_have_no_temperatures(settled):
    with pytest.raises(ep.ConvergenceError, match="temperatures and losses do not settle") as error:
        settled(5.0)
    assert "runaway" not in str(error.value)
