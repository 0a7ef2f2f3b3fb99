"""The published measurements and the bands that the shipped distributions give."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from epicyclic.cli.main import cli
from epicyclic.study.sweeps.runner import Runner
from epicyclic.validation.compare import measured_figures, published_figures
from epicyclic.validation.compute import FIGURES

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts"))

from update_band_table import band_markdown

DOCS = Path(__file__).parents[2] / "docs" / "validation.md"


@pytest.fixture(scope="module")
def figures():
    return measured_figures(Runner(jobs=1))


@pytest.mark.slow
def test_the_manual_shows_the_table_and_says_how_many_lie_inside(figures):
    """Run scripts/update_band_table.py where it does not."""
    text = DOCS.read_text(encoding="utf-8")
    assert band_markdown(figures) in text
    assert "25 of 29 are inside, for different reasons" in text
    assert sum(figure.is_inside for figure in figures) == 25


@pytest.mark.slow
def test_computed_figures_are_those_of_validate(figures):
    measured = [
        item
        for item in published_figures()
        if item["what"].endswith("measured") and item["role"] != "calibration"
    ]
    assert len(figures) == len(measured) == 29
    for figure, row in zip(measured, figures, strict=True):
        assert row.measured == figure["value"]
        assert row.computed == pytest.approx(
            FIGURES[figure["compute"]](**figure["with"]), rel=1e-9
        ), row.what


@pytest.mark.slow
def test_bands_hold_errors_that_all_tests_share(figures):
    """They are as wide over 64 tests as over one: nothing averages out."""
    slope, single = (
        next(row for row in figures if name in row.what)
        for name in ("shaved, 90 °C", "load-dependent loss, 3 planets, 90 °C")
    )
    widths = [(row.high - row.low) / row.computed for row in (slope, single)]
    assert widths[0] == pytest.approx(widths[1], rel=0.15)
    outside = replace(slope, measured=slope.high + 1e-9)
    assert not outside.is_inside


def test_ways_to_validate_do_not_go_together():
    for arguments in (["--bands", "--temperatures"], ["--bands", "-o", "page.html"]):
        run = CliRunner().invoke(cli, ["validate", *arguments])
        assert "conflicts with" in str(run.exception)
