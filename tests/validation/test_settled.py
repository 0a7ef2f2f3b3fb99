"""The loaded tests at temperatures that follow from the losses."""

from __future__ import annotations

from functools import cache
from types import SimpleNamespace

import pytest
from click.testing import CliRunner

import epicyclic as ep
from epicyclic.cli.main import cli
from epicyclic.study.solve import solve, without_torque
from epicyclic.study.sweeps.runner import Rows, Runner, failed_row
from epicyclic.validation import compare as settled
from epicyclic.validation.compare import published_figures
from epicyclic.validation.compute import FIGURES, loaded_conditions, source_case


def of_shaved_planets():
    """Those at 90 degC of one set, or of all shaved ones."""
    return [
        item
        for item in published_figures()
        if item.get("with", {}).get("temperature") == "90 degC"
        and item["with"].get("finish") != "chemically-polished"
        and item["compute"] in ("branch_slope", "loss_in_test", "loss_share")
    ]


@pytest.fixture(scope="module")
def figures():
    """Those of the shaved planets at 90 degC, with the oil flow as the only estimate."""
    content = settled.data_file("settled.toml")
    few = {"estimate": content["estimate"][:1]}
    with pytest.MonkeyPatch.context() as patch:
        files = settled.data_file
        patch.setattr(
            settled, "data_file", lambda name: few if name == "settled.toml" else files(name)
        )
        patch.setattr(settled, "published_figures", of_shaved_planets)
        return settled.settled_figures(Runner(jobs=1))


@cache
def as_tested(*changes):
    """What torque adds to a test, from two solutions."""
    case = source_case().updated(dict(changes))
    loaded, without = solve(case), solve(without_torque(case))
    return SimpleNamespace(
        input_power=loaded.input_power, load_dependent=loaded.total - without.total
    )


def as_on_the_rig(temperature, finish, planets):
    return [as_tested(*it.items()) for it in loaded_conditions(temperature, finish, planets)]


@pytest.mark.slow
def test_at_inlet_temperature_they_are_the_figures_of_the_default_comparison(figures):
    """But for the little torque that the meshes carry without load: that of the rotary union."""
    published = [
        item
        for item in of_shaved_planets()
        if item["with"].get("part")
        not in ("total", "load_independent", "without_union", "input_power")
    ]
    assert len(published) == 12
    assert len(figures) == len(published)
    for figure, row in zip(published, figures, strict=True):
        assert row.what == figure["what"]
        assert row.published == tuple(
            figure[key] for key in ("value", "low", "high") if key in figure
        )
        compute = FIGURES[figure["compute"]]
        # differences of total losses: rounding
        exact = compute(**figure["with"], tests=as_on_the_rig)
        assert row.inlet == pytest.approx(exact, rel=1e-9)
        assert row.inlet == pytest.approx(compute(**figure["with"]), rel=5e-3)


@pytest.mark.slow
def test_the_range_holds_the_estimate(figures):
    for row in figures:
        assert row.low <= row.network <= row.high
        assert row.low < row.high


def test_a_test_that_fails_is_told():
    def run(plan):
        rows = Rows(plan.size)
        rows.add(1, failed_row("the gearbox runs away"))
        return rows

    with pytest.raises(ep.ConvergenceError, match=r"1 of \d+ tests cannot be .*runs away"):
        settled.settled_figures(SimpleNamespace(run=run))


def test_estimates_say_that_they_are_none_of_the_source():
    case = ep.load_case("talbot-2012")
    assert [item.key for item in settled.estimates()] == [
        "thermal.oil_flow",
        "thermal.jet_effectiveness",
    ]
    for item in settled.estimates():
        assert item.origin == "not published; plausible range"
        flow = [
            case.updated({item.key: value}).inputs()["thermal"][item.key.partition(".")[2]]
            for value in (item.low, item.value, item.high)
        ]
        assert len(set(map(str, flow))) == 3


def test_slopes_are_those_of_the_sets_that_were_measured():
    slopes = [item["with"] for item in settled._settled_figures() if "finish" in item["with"]]
    assert len(slopes) == 12
    for given in slopes:
        polished = given["finish"] == "chemically-polished"
        assert given["planets"] == ([6] if polished else [3, 4, 5, 6])


def test_command_prints_the_table(monkeypatch):
    row = settled.SettledFigure("slope", "%", (0.75,), 0.71, 0.72, 0.73, 0.7, 0.74)
    other = settled.SettledFigure("efficiency", "%", (99.0,), 99.1, 99.2, 99.3, 99.0, 99.4)
    monkeypatch.setattr(settled, "settled_figures", lambda runner: (row, other))
    output = CliRunner().invoke(cli, ["validate", "--temperatures"]).output
    assert "0.7 to 0.74" in output
    assert "not published; plausible range" in output
    assert "no verdict" in output
