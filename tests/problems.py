"""The problems that something finds in its input, for tests of bad input."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from epicyclic.errors import InputError, Problem
from limits import is_soon


def problems_of(action: Callable[..., object], *args: Any) -> tuple[Problem, ...]:
    """What `action` finds wrong, which is nothing if all is sound.

    It must come soon, and each problem must say what is allowed and what to change.
    """
    start = time.thread_time()
    try:
        action(*args)
    except InputError as error:
        problems = tuple(error.problems)
    else:
        problems = ()
    assert is_soon(time.thread_time() - start)
    for problem in problems:
        assert problem.allowed.endswith("."), problem
        assert problem.remedy.endswith((".", "?")), problem
    return problems


def only(problems: tuple[Problem, ...]) -> Problem:
    """The one problem that there must be."""
    (problem,) = problems
    return problem
