"""Problems and how they are told."""

from __future__ import annotations

import pickle

import pytest

from epicyclic.errors import ConvergenceError, EpicyclicError, InputError, Problem

TEETH = Problem("sun.teeth", "3", "must be 5 or more.", "Increase it.")
FILE = Problem("", "", "the file is empty.", "Fill it.")
LINE = Problem("", "line 3: [sun", "is not TOML.", "Correct this line.")
MISSING = Problem("sun.face_width", "", "is missing.", "Add it.")


@pytest.mark.parametrize(
    ("problem", "text"),
    [
        (TEETH, "sun.teeth = 3: must be 5 or more. Increase it."),
        (FILE, "the file is empty. Fill it."),
        (LINE, "line 3: [sun: is not TOML. Correct this line."),
        (MISSING, "sun.face_width: is missing. Add it."),
    ],
)
def test_a_problem_reads_as_key_value_rule_and_remedy(problem, text):
    assert str(problem) == text


def test_an_input_error_lists_every_problem_and_its_source():
    text = str(InputError([TEETH, MISSING], "case.toml"))
    assert text.splitlines() == [
        "2 problems in case.toml:",
        "  - sun.teeth = 3: must be 5 or more. Increase it.",
        "  - sun.face_width: is missing. Add it.",
    ]
    assert str(InputError(iter([TEETH]))).startswith("1 problem:")


def test_an_input_error_survives_the_way_between_processes():
    error = pickle.loads(pickle.dumps(InputError([TEETH], "case.toml")))
    assert error.problems == (TEETH,)
    assert error.source == "case.toml"


def test_errors_can_be_caught_together_and_as_what_they_are():
    assert issubclass(InputError, EpicyclicError)
    assert issubclass(InputError, ValueError)
    assert issubclass(ConvergenceError, EpicyclicError)
