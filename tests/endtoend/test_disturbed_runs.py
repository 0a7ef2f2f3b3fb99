"""Signals, two processes, two versions, clocks that jump, full disks: the file as without them."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time

import pytest
from test_shards import COMMANDS, FAILS, content

from epicyclic.files import PREFIX

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX signals"),
]

COMMANDS = COMMANDS | {"bands.nc": ("uncertainty", "train-eaxle", "--samples", "16")}
ENDS = {signal.SIGTERM: -15, signal.SIGINT: 130}
OTHER = """\
from importlib import metadata
known = metadata.version
metadata.version = lambda name: "999.0" if name == "epicyclic" else known(name)
"""
"""Another version of the package."""
EARLIER = """\
import time
since = time.time
time.time = lambda: since() - 1e8
"""
FULL = """\
import resource
resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
"""
"""As a full disk: no file grows beyond so many bytes."""


def started(output, folder, before=""):
    """A command that writes `output` in a folder, after some statements."""
    command = [*COMMANDS[output], "-o", str(folder / output), "--jobs", "1"]
    program = f"{before}\nimport sys\nsys.argv = ['epicyclic', *{command!r}]\n"
    program += "from epicyclic.__main__ import main\nmain()\n"
    return subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def ended(process):
    """Exit code and errors."""
    _, errors = process.communicate(timeout=600)
    return process.returncode, errors


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Content of each output without disturbance, and the seconds that it takes."""
    known = {}

    def made(output):
        if output not in known:
            folder = tmp_path_factory.mktemp("whole")
            begin = time.monotonic()
            code, errors = ended(started(output, folder))
            assert code == (4 if output in FAILS else 0), errors
            known[output] = content(folder / output), time.monotonic() - begin
        return known[output]

    return made


def struck(process, number, seconds):
    """Whether a command got a signal in mid-work, after which it ends soon."""
    try:
        process.wait(timeout=seconds)
    except subprocess.TimeoutExpired:
        process.send_signal(number)
        code, _ = ended(process)
        assert code in (0, ENDS[number])  # 0: the signal came when all was written
        return code != 0
    ended(process)
    return False


@pytest.mark.parametrize("output", ["map.nc", "bands.nc", "oil"])
def test_a_command_that_is_told_to_end_goes_on_later(tmp_path, whole, output):
    random.seed(output)
    expected, seconds = whole(output)
    hits, tries = 0, 0
    while hits < 4:
        tries += 1
        assert tries < 40, "signals end nothing"
        number = (signal.SIGTERM, signal.SIGINT)[hits % 2]
        hits += struck(started(output, tmp_path), number, random.uniform(0.3, 0.9) * seconds)
    assert ended(started(output, tmp_path))[0] == 0
    assert content(tmp_path / output) == expected
    assert not list(tmp_path.rglob(f"{PREFIX}*"))


@pytest.mark.parametrize("output", ["sweep.nc", "map.nc"])
def test_two_at_once_write_the_same(tmp_path, whole, output):
    """Whether both write or the second is refused: the file is whole."""
    running = [started(output, tmp_path) for _ in range(2)]
    for code, errors in map(ended, running):
        assert code == 0 or errors.startswith("1 problem"), errors
    assert content(tmp_path / output) == whole(output)[0]


def interrupted(output, folder, seconds, before=""):
    """Leave a journal of a part of the points."""
    while not list(folder.glob("*.partial")):
        struck(started(output, folder, before), signal.SIGTERM, random.uniform(0.5, 0.9) * seconds)
        if (folder / output).exists():
            (folder / output).unlink()


def test_no_points_of_another_version_are_taken(tmp_path, whole):
    """A journal of another version is refused or begun anew."""
    expected, seconds = whole("map.nc")
    interrupted("map.nc", tmp_path, seconds, OTHER)
    (journal,) = tmp_path.glob("*.partial")
    code, errors = ended(started("map.nc", tmp_path))
    if code:
        assert (code, journal.exists()) == (2, True)
        assert str(journal) in errors
        journal.unlink()
        assert ended(started("map.nc", tmp_path))[0] == 0
    assert content(tmp_path / "map.nc") == expected


def test_a_clock_that_jumps_changes_nothing(tmp_path, whole):
    """Journals from the future, and hours that come twice."""
    expected, seconds = whole("map.nc")
    interrupted("map.nc", tmp_path, seconds)
    (journal,) = tmp_path.glob("*.partial")
    later = time.time() + 1e8
    os.utime(journal, (later, later))
    assert ended(started("map.nc", tmp_path, EARLIER))[0] == 0
    assert content(tmp_path / "map.nc") == expected


@pytest.mark.parametrize("output", ["sweep.nc", "map.nc"])
def test_a_full_disk_keeps_what_is_done(tmp_path, whole, output):
    code, errors = ended(started(output, tmp_path, FULL))
    assert code == 2
    assert "cannot be written: " in errors
    assert not (tmp_path / output).exists()
    assert ended(started(output, tmp_path))[0] == 0
    assert content(tmp_path / output) == whole(output)[0]
