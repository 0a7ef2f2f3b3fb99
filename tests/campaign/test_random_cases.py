"""The campaign of random valid cases: a quick share by default, longer ones on demand."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

import epicyclic as ep
from campaign.cases import drawn_case, drawn_design
from campaign.outcomes import FAULTS, outcome_of
from campaign.run import CampaignPlan, counted
from epicyclic.plugins.contact_solver import direct

TABLE = Path(__file__).parents[2] / "docs" / "development" / "campaign.csv"


def solved(numbers):
    numbers = list(numbers)
    plan = CampaignPlan(max(numbers) + 1)
    counts = counted(zip(numbers, plan.solve_all(numbers), strict=True))
    for row in counts.rows():
        print(",".join(row))
    return counts


def check(counts):
    names = {name for name, _, _ in counts.outcomes}
    assert not names & set(FAULTS), counts.faults
    assert sum(number for (name, *_), number in counts.outcomes.items() if name == "solved") > 0


@pytest.mark.slow
def test_a_quick_share_ends_in_results_or_outcomes():
    # beyond those that the documentation counts: five designs at four points each
    check(solved(10_000_000 + 30 * design + point for design in range(5) for point in (0, 3, 4, 7)))


@pytest.mark.parametrize("number", [11, 17])
def test_tilted_planets_may_have_a_mesh_without_load(number):
    """The ring and its mesh turn freely, the sun carries what the bearings resist."""
    assert outcome_of(drawn_case(number)).name == "solved"


def stand_in(line, roughness, seeds, heating, settings):
    """Friction of a contact that the solver of contacts would take seconds for; some have none."""
    known = np.nan if seeds[0] % 17 == 0 else 0.05 * (line.radius / 0.01) ** 0.3
    return known, 0.9 if seeds[1] % 5 == 0 else 1.0


@pytest.mark.parametrize("number", [18, 41, 117, 289, 308, 358, 456])
def test_meshes_of_few_and_of_equal_contacts_can_be_solved_directly(number, monkeypatch):
    """Few positions and segments, spur gears, even loads: contacts at one place of the mesh."""
    monkeypatch.setattr(direct, "_friction", stand_in)
    case = drawn_design(number).updated({"models.friction": "ehl-direct"})
    assert outcome_of(case).name == "solved"
    assert "ehl-direct" in " ".join(ep.solve(case).notes)


def test_of_few_contacts_all_are_solved_whatever_the_most_of_many(monkeypatch):
    """Of number 41 eighteen differ, more than `most_contacts`, but no more than with the checks."""
    solved = []

    def stand_in_of_all(line, *_):
        solved.append((line.radius, line.line_load))
        return 0.05 * (line.radius / 0.01) ** 0.3, 1.0

    monkeypatch.setattr(direct, "_friction", stand_in_of_all)
    changes = {"models.friction": "ehl-direct", "contact_solver.most_contacts": 12}
    result = ep.solve(drawn_design(41).updated(changes))
    (note,) = (note for note in result.notes if "ehl-direct" in note)
    assert "18 contacts" in note
    assert "these are all the different ones" in note
    assert len(solved) == len(set(solved)) == 18


@pytest.mark.parametrize(
    "number",
    [
        *(826, 1884, 56103),
        *(
            pytest.param(number, marks=pytest.mark.slow)
            for number in (829, 1104, 1881, 5248, 11481)
        ),
    ],
)
def test_losses_that_alone_load_a_mesh_agree_with_its_load(number):
    """No torque from outside: the least loss of a mesh changes its load by a multiple.

    Or each pass brings the load but a third nearer to where it stays, or planets tilt in their play
    by far more than their teeth give way (56103).
    """
    assert outcome_of(drawn_case(number)).name == "solved"


@pytest.mark.parametrize("number", [3228, 17535])
def test_planets_share_next_to_no_torque(number):
    """A force of 1e-14 N presses rollers by less than the rounding of their clearance."""
    assert outcome_of(drawn_case(number)).name == "solved"


def test_parts_that_rest_are_as_warm_as_the_oil():
    """Nothing heats them, nothing cools them."""
    case = drawn_case(3742)
    assert case.operation.speed == 0
    found = ep.solve(case).heat.temperatures
    assert found["pinion"] == found["gear"] == pytest.approx(found["oil"], rel=1e-12)


def test_a_turning_ring_gives_heat_to_the_mixture():
    """No gear dips, and the oil that flows meets none."""
    assert outcome_of(drawn_case(24883)).name == "solved"


@pytest.mark.parametrize("number", [10183, 17636, 50103])
def test_losses_beyond_all_bounds_end_as_such(number):
    """Formulas that are extrapolated to cold oil give more than a number can hold.

    Of the last one any load loses 1e86 W and more, none nothing: secants end at that jump.
    """
    case = drawn_case(number).updated({"thermal.lubrication": "spray"})
    assert outcome_of(case).name == "losses grow with the torques that they cause"


@pytest.mark.parametrize(
    ("first", "count"),
    [
        pytest.param(202_000, 100, marks=pytest.mark.slow),
        pytest.param(200_000, 1000, marks=pytest.mark.campaign),
        pytest.param(201_000, 1000, marks=pytest.mark.campaign),
    ],
)
def test_a_longer_share_ends_in_results_or_outcomes(first, count):
    check(solved(range(first, first + count)))


def test_points_of_a_design_differ_in_operation_only():
    cases = [drawn_case(number) for number in range(240, 250)]
    assert len({str(case.given()) for case in cases}) > 8  # standstill may be drawn twice
    left = ("operation", "surroundings")
    rest = [{key: it for key, it in case.given().items() if key not in left} for case in cases]
    assert all(each == rest[0] for each in rest)
    speeds = {case.operation.speed for case in cases}
    torques = {case.operation.torque for case in cases}
    assert 0.0 in speeds
    assert 0.0 in torques
    assert len(speeds) < len(cases) - 2  # states are shared


def test_a_case_follows_from_its_number_alone():
    plan = CampaignPlan(8)
    one, two = plan.solve_all([3, 3])
    assert one.message == two.message
    assert one.numbers["energy"] == two.numbers["energy"]


def test_the_published_counts_have_no_faults_and_add_up():
    with TABLE.open(newline="", encoding="utf-8") as file:
        rows = {row[0]: row[1:] for row in csv.reader(file)}
    assert all(rows[name][0] == "0" for name in FAULTS if name != "too long")
    assert int(rows["too long"][0]) <= int(rows["all"][0]) / 10_000
    outcomes = [row for name, row in rows.items() if row[-1].isdigit() and name != "all"]
    for column, total in enumerate(rows["all"]):
        assert sum(int(row[column]) for row in outcomes) == int(total)
