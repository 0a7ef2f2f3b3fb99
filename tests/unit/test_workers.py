"""Points in several processes: the first one takes part, and nobody waits for one that is lost."""

from __future__ import annotations

import multiprocessing
import os
import time
from pathlib import Path

import pytest
from loky.process_executor import ProcessPoolExecutor, TerminatedWorkerError

from epicyclic.study.sweeps.runner import Plan, Row, Runner


def meeting(folder, *, deadly=False, pause=0.01):
    """A plan whose points wait until two processes have begun one; the worker may end there."""
    first = os.getpid()

    class Meeting(Plan):  # a local class travels to the worker whole
        kind = "meeting"
        size = 7

        def order(self):
            return range(self.size)

        def describe(self):
            return {}

        def _solve(self, index):
            Path(folder, str(os.getpid())).touch()
            deadline = time.monotonic() + 60
            while len(list(Path(folder).iterdir())) < 2 and time.monotonic() < deadline:
                time.sleep(0.01)
            time.sleep(pause)
            if deadly and os.getpid() != first:
                os._exit(1)
            return Row("converged", numbers={"process": float(os.getpid()), "index": float(index)})

    return Meeting()


def test_the_first_process_takes_part(tmp_path):
    rows = Runner(jobs=2).run(meeting(tmp_path))
    assert list(rows.numbers("index")) == list(range(7))
    processes = set(rows.numbers("process"))
    assert os.getpid() in processes
    assert len(processes) == 2


def test_a_worker_that_ends_is_told(tmp_path):
    with pytest.raises(TerminatedWorkerError):
        Runner(jobs=2).run(meeting(tmp_path, deadly=True))


def test_a_worker_that_cannot_go_on_is_told(tmp_path, monkeypatch):
    submit = ProcessPoolExecutor.submit

    def once(self, function, *args):
        if args[-2:-1] != ((),):  # all but the first call, which brings no points
            raise OSError("cannot allocate memory")
        return submit(self, function, *args)

    monkeypatch.setattr(ProcessPoolExecutor, "submit", once)
    (tmp_path / "another").touch()
    with pytest.raises(OSError, match="cannot allocate memory"):
        Runner(jobs=2).run(meeting(tmp_path, pause=1.0))


def test_a_process_without_children_goes_on_alone(tmp_path, monkeypatch):
    (tmp_path / "another").touch()
    monkeypatch.setitem(multiprocessing.current_process()._config, "daemon", True)
    rows = Runner(jobs=2).run(meeting(tmp_path))
    assert set(rows.numbers("process")) == {os.getpid()}
