"""Methods of a case against those that its result states."""

from __future__ import annotations

import pytest

import epicyclic as ep
from epicyclic.study.friction import methods_of


@pytest.mark.parametrize(
    "changes",
    [{}, {"models.mesh": "loss-factor", "models.bearing": "palmgren"}],
    ids=["defaults", "others"],
)
def test_the_sources_are_those_of_the_result(talbot, changes):
    case = talbot.updated(changes)
    methods = methods_of(case)
    stated = {part for source in ep.solve(case).sources for part in source.split("; ")}
    named = {part for _, source in methods.values() for part in source.split("; ") if source}
    assert named == stated


def test_the_methods_of_a_pair_are_those_of_its_result():
    case = ep.load_case("talbot-2012-pair")
    result = ep.solve(case)
    assert {source for _, source in methods_of(case).values()} == set(result.sources)
