"""Losses of the set under test, from what a back-to-back rig measures."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.study.measured.compare import ComparisonPlan, ask
from epicyclic.study.measured.rig import Rig
from epicyclic.study.measured.table import parse_measurements
from epicyclic.study.table_file import read_grid

RIG = """\
speed [rpm],torque [N*m],temperature [degC],torque_loss [N*m],planet.count,reaction
1000,0,90.2,1.6,6,equal
1000,1000,89.8,18,6,equal
3998,0,90.1,4.2,6,equal
4001,1000,90.3,19,6,equal
1000,0,90.0,1.5,3,kept
1001,1000,90.4,17,3,kept
4000,0,90.0,3.4,3,kept
4000,999.2,89.7,18.5,3,kept
"""
RPM = math.pi / 30
BOTH = Rig(baseline="reaction=equal", unloaded=True, torque_uncertainty="0.1125 N*m")


@pytest.fixture
def asked(tmp_path, talbot):
    """The question about a table of given text."""

    def from_text(text, rig=BOTH):
        path = tmp_path / "rig.csv"
        path.write_text(text)
        return ask(talbot, read_grid(path), rig=rig)

    return from_text


def test_half_of_the_baseline_belongs_to_the_reaction_set(asked):
    table = asked(RIG, Rig(baseline="reaction=equal")).table
    own = [1.6 / 2, 18 / 2, 4.2 / 2, 19 / 2]
    kept = [1.5 - 0.8, (17 * 1.001 - 9), (3.4 - 2.1 * 0.9995), (18.5 - 9.5 * 1.00025)]
    speeds = np.array([1000, 1000, 3998, 4001, 1000, 1000, 4000, 4000])
    assert table.loss == pytest.approx(np.array([*own, *kept]) * speeds * RPM)
    assert set(table.component) == {"total"}
    assert table.uncertainty is None


def test_loaded_less_unloaded_of_the_same_set(asked):
    table = asked(RIG).table
    assert table.component == ("total", "load_dependent") * 4
    half = 0.5 * RPM * np.array([1600.0, 18000.0, 4.2 * 3998, 19 * 4001])
    assert table.loss[1] == pytest.approx(half[1] - half[0])
    three = RPM * np.array([1500, 17 * 1001, 13600, 74000]) - half
    assert table.loss[4::2] == pytest.approx(three[::2])
    assert table.loss[5::2] == pytest.approx(three[1::2] - three[::2])


def test_a_baseline_in_another_state_is_none(asked):
    rig = Rig(baseline="reaction=equal")
    table = asked(RIG, Rig()).table
    states = [*["first"] * 4, *["second"] * 4]
    changes = [
        {**own, "operation.state": state} for own, state in zip(table.changes, states, strict=True)
    ]
    with pytest.raises(ep.InputError, match="line 6"):
        rig.losses(replace(table, changes=tuple(changes)))
    assert len(rig.losses(table)) == 8


def test_the_sensor_tells_how_uncertain_each_loss_is(asked):
    table = asked(RIG).table
    one = 0.1125 * RPM * np.array([1000, 1000, 3998, 4001, 1000, 1001, 4000, 4000])
    half = one[:4] / 2
    kept = np.hypot(one[4:], half)
    assert table.uncertainty[::2] == pytest.approx([half[0], half[2], kept[0], kept[2]])
    loaded = [math.hypot(a, b) for a, b in (half[:2], half[2:], kept[:2], kept[2:])]
    assert table.uncertainty[1::2] == pytest.approx(loaded)


def test_two_torques_leave_six_per_cent_of_a_small_loss(tmp_path, talbot):
    """Relative errors of 0.05 % each, at an efficiency of 98.9 %."""
    path = tmp_path / "two.csv"
    head = "speed [rpm],torque [N*m],temperature [degC],efficiency [%],torque_uncertainty [%]\n"
    path.write_text(f"{head}2000,700,60,98.9,0.05\n")
    table = parse_measurements(read_grid(path), talbot)
    expected = 0.0005 * math.hypot(1, 0.989) / 0.011
    assert table.uncertainty / table.loss == pytest.approx(expected)
    assert expected == pytest.approx(0.06, abs=0.005)
    leaving = 700 * 0.989 * 198 / 73
    path.write_text(
        "speed [rpm],torque [N*m],temperature [degC],output_torque [N*m],torque_uncertainty [N*m]\n"
        f"2000,700,60,{leaving!r},0.35\n"
    )
    table = parse_measurements(read_grid(path), talbot)
    assert table.loss == pytest.approx(700 * 2000 * RPM * 0.011)
    assert table.uncertainty == pytest.approx(0.35 * 2000 * RPM * math.hypot(1, 73 / 198))


def test_computed_losses_are_formed_as_the_measured_ones(asked):
    question = asked(RIG)
    assert question.load_dependent == "as-tested"
    plan = ComparisonPlan.of(question)
    again = ComparisonPlan.again(plan.describe(), "")
    assert again.question.table.loss == pytest.approx(question.table.loss)
    assert again.question.table.uncertainty == pytest.approx(question.table.uncertainty)


@pytest.mark.parametrize(
    ("rig", "old", "new", "key", "word"),
    [
        (Rig(baseline="reaction"), "", "", "baseline", "COLUMN=VALUE"),
        (Rig(baseline="reaction=other"), "", "", "baseline", "equal, kept"),
        (Rig(torque_uncertainty="much"), "", "", "torque_uncertainty", "0.11 N*m"),
        (Rig(torque_uncertainty="0.1 kg"), "", "", "torque_uncertainty", "N*m"),
        (BOTH, "4000,0,90.0", "3900,0,90.0", "rows", "line 8"),
        (Rig(unloaded=True), "3998,0,90.1", "3998,0,94.1", "rows", "without torque"),
        (Rig(unloaded=True), "reaction", "component", "component", "equal"),
    ],
)
def test_what_cannot_be_formed_is_told(asked, rig, old, new, key, word):
    with pytest.raises(ep.InputError) as error:
        asked(RIG.replace(old, new), rig)
    assert any(key in one.key and word in str(one) for one in error.value.problems), error.value
