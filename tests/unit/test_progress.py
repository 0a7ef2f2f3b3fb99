"""Progress without a terminal: lines now and then."""

from __future__ import annotations

import pytest

from epicyclic.cli import common as progress
from epicyclic.kernels import listeners


class Clock:
    """Time that passes when it is told to."""

    now = 100.0

    def monotonic(self):
        return self.now


@pytest.fixture
def clock(monkeypatch):
    clock = Clock()
    monkeypatch.setattr(progress, "time", clock)
    monkeypatch.delenv("EPICYCLIC_PROGRESS", raising=False)
    return clock


def test_a_line_now_and_then(clock, capsys):
    with progress.progress_bar("points") as update:
        for done, seconds, failed in ((1, 3, 0), (20, 60, 0), (21, 62, 0), (30, 90, 2)):
            clock.now = 100.0 + seconds
            update(done, 80, failed)
    assert capsys.readouterr().err.splitlines() == [
        "points: 20 of 80 after 0:01:00, about 0:03:00 left",
        "points: 30 of 80 after 0:01:30, about 0:02:30 left, 2 not converged",
    ]


def test_the_time_left_does_not_count_compilation_before_the_first_point(clock, capsys):
    with progress.progress_bar("points") as update:
        for done, seconds in ((0, 50), (1, 110), (11, 130)):
            clock.now = 100.0 + seconds
            update(done, 80)
    assert capsys.readouterr().err.splitlines() == [
        "points: 0 of 80 after 0:00:50",
        "points: 1 of 80 after 0:01:50",
        "points: 11 of 80 after 0:02:10, about 0:02:18 left",
    ]


def test_what_is_quick_says_nothing(clock, capsys):
    with progress.progress_bar("points") as update:
        clock.now += progress.EVERY / 2
        update(80, 80)
    assert capsys.readouterr().err == ""


def test_lines_can_be_turned_off(clock, capsys, monkeypatch):
    monkeypatch.setenv("EPICYCLIC_PROGRESS", "0")
    with progress.progress_bar("points") as update:
        clock.now += 1000
        update(1, 80)
    assert capsys.readouterr().err == ""


def test_a_first_run_says_that_it_compiles(clock, capsys):
    progress.tell_compilation()
    tell = listeners.pop()
    for seconds in (0, 2, 7, 8, 13):
        clock.now = 100.0 + seconds
        tell()
    said = "First run of this version: compiling the numerics, {} of up to 110 functions after {}."
    expected = [said.format(3, "0:00:07"), said.format(5, "0:00:13")]
    assert capsys.readouterr().err.splitlines() == expected


def test_compiling_a_kernel_is_told(monkeypatch):
    from epicyclic.kernels.compiling import kernel

    told = []
    monkeypatch.setattr("epicyclic.kernels.compiling._CACHE_DIR", None)
    listeners.append(lambda: told.append(1))
    try:

        def twice(x):
            return 2 * x

        twice.__module__ = "epicyclic.test"
        compiled = kernel(twice)
        assert compiled(3.0) == 6.0
        assert compiled(4.0) == 8.0
    finally:
        listeners.pop()
    assert told == [1]
