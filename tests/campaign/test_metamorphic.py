"""One thing stated in many ways: a few cases by default, more on demand."""

from __future__ import annotations

import csv
import random
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

import epicyclic as ep
from campaign import metamorphic
from campaign.metamorphic import FAULTS, FORMS, drawn, outcome, rows

TABLE = Path(__file__).parents[2] / "docs" / "development" / "metamorphic.csv"


@pytest.mark.parametrize(
    ("first", "count"),
    [
        (1_000_001, 20),
        pytest.param(1_000_100, 100, marks=pytest.mark.slow),
        pytest.param(1_001_000, 5000, marks=pytest.mark.campaign),
    ],
)
def test_other_forms_of_a_case_give_the_same(first, count):
    found = {number: outcome(number) for number in range(first, first + count)}
    faults = {number: it for number, it in found.items() if it[1] in FAULTS}
    assert not faults
    assert sum(name == "same" for _, name, _ in found.values()) > count / 2


def test_pockets_of_the_other_flank_are_solved_again():
    """A mesh whose load its losses turn round: the pockets on the flank that carries it count."""
    rng = random.Random("e4")
    included = {f"losses.{mesh}_mesh_pocketing.include": True for mesh in ("sun", "ring")}
    case = ep.load_case(metamorphic._planetary(rng)).updated(included)
    case = case.updated({"operation.torque": "45.54 N*m"})  # 0.4 of what turns it without load
    result = ep.solve(case)
    other, _, tolerance = metamorphic.other_end(case, result, rng)
    found = ep.solve(other)
    for name in ("sun_mesh_pocketing", "ring_mesh_pocketing", "ring_mesh_rolling"):
        assert found.losses[name] == pytest.approx(result.losses[name], rel=tolerance), name


def test_friction_that_bends_at_a_load_is_solved_as_well_from_both_ends():
    """Sliding loss whose slope changes by 6 % within 0.7 % of the load: predictions err by it."""
    form, name, _ = outcome(18_986)
    assert (form, name) == ("exchanged", "same")


def test_a_form_that_differs_is_a_fault(monkeypatch):
    """The check itself can fail: a form with one per mille more torque is told."""

    def other_torque(case, result, rng):
        torque, unit = case.given()["operation"]["torque"].split()
        return case.updated({"operation.torque": f"{1.001 * float(torque)!r} {unit}"}), {}, 1e-9

    monkeypatch.setattr(metamorphic, "FORMS", (other_torque, other_torque))
    form, name, detail = outcome(1_000_003)
    assert (form, name) == ("other_torque", "differs")
    assert " by " in detail


@pytest.mark.slow
def test_a_killed_campaign_goes_on(tmp_path):
    """Kills at any moment, in the middle of a line too: the same counts as without."""
    journal = tmp_path / "forms.jsonl"
    command = [sys.executable, "-m", "campaign.metamorphic", "60", "--first", "1000000"]
    folder = Path(__file__).parents[1]
    whole = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout
    command += ["--journal", str(journal)]
    for seconds in (8, 12, 9):
        with suppress(subprocess.TimeoutExpired):
            subprocess.run(command, cwd=folder, capture_output=True, timeout=seconds, check=False)
        if journal.exists():
            journal.write_bytes(journal.read_bytes()[:-5])  # a line that was not written whole
    left = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout
    assert left == whole
    assert len(journal.read_text(encoding="utf-8").splitlines()) == 60


def test_cases_of_a_number_are_the_same_and_have_no_two_equal_widths():
    assert drawn(1_000_005) == drawn(1_000_005)
    tables = drawn(1_000_005).given()
    widths = [it["face_width"] for it in tables.values() if "face_width" in it]
    assert len(set(widths)) == len(widths) > 1


def test_the_published_counts_have_no_faults_and_add_up():
    with TABLE.open(newline="", encoding="utf-8") as file:
        counts = {row[0]: list(map(int, row[1:])) for row in list(csv.reader(file))[1:]}
    assert all(sum(counts[name]) == 0 for name in FAULTS)
    total = counts.pop("all")
    assert [sum(column) for column in zip(*counts.values(), strict=True)] == total
    assert sum(total[1:]) == total[0]
    assert len(total) == 1 + len(FORMS)
    head = next(iter(rows({})))
    assert head[1:] == ["all", *(form.__name__.replace("_", " ") for form in FORMS)]
