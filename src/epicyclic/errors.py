"""Exceptions of the package, the text of their messages, and how a computation ended."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from enum import StrEnum
from itertools import pairwise

from epicyclic.dataclass import dataclass

# Bad input is described by `Problem` objects, one per mistake, and reported all together by one
# `InputError`. Nothing here imports the rest of the package.


MOST_SHOWN, LONGEST_PROBLEM = 50, 1500
"""Problems in one message, and characters of each; `InputError.problems` has all of them."""


@dataclass(frozen=True, slots=True)
class Problem:
    """One mistake in the input: what was given, what is allowed, what to change.

    Attributes
    ----------
    key : str
        Dotted key of the case, ``"sun.tip_diameter"``; empty for the file as a whole.
    value : str
        What was given, as the user wrote it; empty if nothing was.
    allowed : str
        What is allowed, or why the value is impossible.
    remedy : str
        What to change.
    """

    key: str
    value: str
    allowed: str
    remedy: str

    def __str__(self) -> str:
        given = " = ".join(part for part in (self.key, self.value) if part)
        head = f"{given}: {self.allowed}" if given else self.allowed
        text = printable(f"{head} {self.remedy}".rstrip()[: LONGEST_PROBLEM + 1])
        return text if len(text) <= LONGEST_PROBLEM else f"{text[:LONGEST_PROBLEM]}..."


def printable(text: str) -> str:
    """`text` with control characters, which names of users may contain, as escapes."""
    return "".join(
        char if char.isprintable() else char.encode("unicode_escape").decode() for char in text
    )


def printable_lines(text: str) -> str:
    """The same with its lines as they are."""
    return "\n".join(map(printable, text.split("\n")))


# Exit codes of the command.
EXIT_DONE = 0
EXIT_ERROR, EXIT_INPUT, EXIT_NO_SOLUTION, EXIT_FAILED_POINTS = 1, 2, 3, 4
EXIT_INCOMPLETE = 5
EXIT_INTERRUPTED, EXIT_BROKEN_PIPE = 130, 141


class EpicyclicError(Exception):
    """Base of every error this package raises on purpose."""


class InputError(EpicyclicError, ValueError):
    """The case, the file or the command cannot be used as given.

    Parameters
    ----------
    problems : iterable of Problem
        All mistakes found.
    source : str
        The file or built-in case the input came from.
    """

    def __init__(self, problems: Iterable[Problem], source: str = "") -> None:
        self.problems = tuple(problems)
        self.source = source
        super().__init__(self.problems, source)

    def __str__(self) -> str:
        count = len(self.problems)
        where = f" in {self.source}" if self.source else ""
        head = f"{count} problem{'s' if count != 1 else ''}{where}:"
        lines = [f"  - {problem}" for problem in self.problems[:MOST_SHOWN]]
        if count > MOST_SHOWN:
            lines.append(f"  ... and {count - MOST_SHOWN} more.")
        return "\n".join([head, *lines])


def one_problem(key: str, value: str, allowed: str, remedy: str, source: str = "") -> InputError:
    """The `InputError` of a single problem; parameters as for `Problem`."""
    return InputError([Problem(key, value, allowed, remedy)], source)


def raise_any(problems: Iterable[Problem], source: str = "") -> None:
    """Raise the `InputError` of the problems if there are any; parameters as for that."""
    found = tuple(problems)
    if found:
        raise InputError(found, source)


@contextmanager
def problems_in(source: str) -> Iterator[None]:
    """Where problems that are found are those of `source`."""
    try:
        yield
    except InputError as error:
        raise InputError(error.problems, source) from None


class ConvergenceError(EpicyclicError):
    """An iteration ended without a solution; the message says what to try next."""


def first_of(items: Sequence[str], most: int = 3) -> str:
    """The first of the items on one line, and how many more there are."""
    more = len(items) - most
    return ", ".join(items[:most]) + (f" and {more} more" if more > 0 else "")


def rising_problems(axes: Mapping[str, Collection[float]], prefix: str = "") -> list[Problem]:
    """One problem for each axis of a table, by its name, whose points do not rise."""
    return [
        Problem(
            f"{prefix}{name}",
            f"{len(points)} values",
            "must be two or more increasing values.",
            "Give two or more, the smallest first.",
        )
        for name, points in axes.items()
        if len(points) < 2 or any(not b > a for a, b in pairwise(points))
    ]


def is_interrupt(error: BaseException) -> bool:
    """True if an error stands for an interruption by the user.

    Compiled code that is interrupted ends in a `SystemError` with the interruption as its cause.
    """
    chain: BaseException | None = error
    while chain is not None:
        if isinstance(chain, KeyboardInterrupt):
            return True
        chain = chain.__cause__
    return False


# How a computation ended.


class Status(StrEnum):
    """Every result carries one."""

    CONVERGED = "converged"
    FAILED = "failed"
    UNPHYSICAL = "unphysical"
    """There are numbers, but they cannot be: a loss below zero, energy that does not balance, or
    contacts that carry or resist with more than any can."""
