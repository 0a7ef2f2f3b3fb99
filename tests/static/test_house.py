"""The weight of the package stays below its ceilings; scripts/house.py prints it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts"))

import house


@pytest.mark.slow
def test_every_figure_is_below_its_ceiling():
    figures = house.figures()
    assert figures.keys() == house.CEILINGS.keys()
    above = {name: value for name, value in figures.items() if value > house.CEILINGS[name]}
    assert not above


def test_chains_and_mirrors_are_found():
    """The measures see what they are to see."""
    assert house.chain("epicyclic.study.solve")[-1] in house.imports()
    assert len(house.chain("epicyclic.study.solve")) > 5
    assert house.lines() == house.lines(but=house.APART) + house.lines(*house.APART)
