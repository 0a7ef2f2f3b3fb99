"""Ctrl-C ends any command soon, with exit code 130 and nothing half-written."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from importlib.metadata import entry_points
from pathlib import Path

import pytest

from epicyclic.files import PREFIX
from limits import is_soon

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX signals")

LONGEST_END = 2.0
FINE = ("--set", "numerics.pocket_slices=60", "--set", "numerics.pocket_steps=700")
"""Pockets that take minutes."""


def group_of(leader):
    """CPU seconds of every living process in a process group, by number."""
    seconds = {}
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
        except OSError:  # it has just ended
            continue
        if int(fields[2]) == leader and fields[0] != "Z":
            seconds[entry.name] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return seconds


def interrupted(arguments, folder, *, after):
    """Exit code, errors and seconds to the end of a command, interrupted in mid-work."""
    process = subprocess.Popen(
        [sys.executable, "-m", "epicyclic", *arguments],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    deadline = time.monotonic() + 120
    while sum(group_of(process.pid).values()) < after:
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.05)
    start = time.monotonic()
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    _, errors = process.communicate(timeout=60)
    seconds = time.monotonic() - start
    while group_of(process.pid):
        assert is_soon(time.monotonic() - start, LONGEST_END), "workers are left"
        time.sleep(0.05)
    return process.returncode, errors, seconds


def slow(*arguments):
    return pytest.param(arguments, marks=pytest.mark.slow, id=arguments[0])


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
@pytest.mark.parametrize(
    "arguments",
    [
        ("run", "talbot-2012", *FINE, "--save", "r.nc"),
        slow("sweep", "talbot-2012", *FINE, "--vary", "operation.speed=1:4000:9 rpm", "--jobs", "2",
             "-o", "s.nc"),
        slow("pockets", "talbot-2012", *FINE, "--plot", "p.png"),
        slow("pockets-table", "talbot-2012", *FINE, "--speed", "500:5000:10 rpm", "-o", "t.nc"),
        slow("oil", "characterise", "atf-talbot-2012", "--size", "64", "--jobs", "2", "-o", "atf"),
    ],
    ids=lambda arguments: arguments[0],
)  # fmt: skip
def test_compiled_code_is_left_at_once(tmp_path, arguments):
    code, errors, seconds = interrupted(arguments, tmp_path, after=6.0)
    assert code == 130, errors
    assert errors.strip().endswith("Interrupted.")
    assert errors.count("Interrupted.") == 1
    assert "Traceback" not in errors
    assert "leaked" not in errors
    assert is_soon(seconds, LONGEST_END)
    left = [path for path in tmp_path.rglob("*") if path.is_file()]
    # what is finished is kept: journals of points, the plan of the campaign
    assert all(path.suffix == ".partial" or path.name == "campaign.json" for path in left), left
    assert not list(tmp_path.rglob(f"{PREFIX}*"))


@pytest.mark.slow
def test_a_terminal_shows_that_pockets_are_being_solved(tmp_path):
    ours, theirs = os.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "epicyclic", "run", "talbot-2012", *FINE],
        cwd=tmp_path,
        stdout=subprocess.DEVNULL,
        stderr=theirs,
    )
    os.close(theirs)
    shown, deadline = b"", time.monotonic() + 120
    try:
        while b"solving" not in shown or b"0:00:0" not in shown:
            assert time.monotonic() < deadline
            shown += os.read(ours, 4096)
    finally:
        process.send_signal(signal.SIGINT)
        while process.poll() is None:  # what is not read would keep it waiting
            with suppress(OSError):
                os.read(ours, 4096)
        os.close(ours)
    assert process.returncode == 130


INTERRUPTS_ITSELF = """\
import os, signal, sys

class Interrupting:
    def find_spec(self, name, path=None, target=None):
        if name == "{module}":
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Interrupting())
sys.argv = ["epicyclic", "run", "talbot-2012"]
from epicyclic.__main__ import main
main()
"""


@pytest.mark.parametrize("module", ["click", "epicyclic.cli.main", "pydantic", "numpy"])
def test_imports_are_left_at_once(module):
    script = INTERRUPTS_ITSELF.format(module=module)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.returncode == 130
    assert done.stdout == ""
    assert done.stderr.strip() == "Interrupted."


def test_the_command_is_the_module():
    (command,) = (point for point in entry_points(group="console_scripts", name="epicyclic"))
    assert command.value == "epicyclic.__main__:main"


def test_ctrl_c_after_the_work_changes_nothing():
    """What was registered before the command runs after all that it does at its end."""
    program = """
import atexit, os, signal, sys
atexit.register(os.kill, os.getpid(), signal.SIGINT)
sys.argv = ["epicyclic", "check", "talbot-2012"]
from epicyclic.__main__ import main
main()
"""
    run = subprocess.run([sys.executable, "-c", program], check=False, capture_output=True)
    assert (run.returncode, run.stderr) == (0, b"")


def test_the_thread_that_ends_compiled_code_tells_of_the_interruption_alone():
    """What runs at the end of the process may call for the main thread."""
    program = """
import sys, threading
from epicyclic.cli import main as ending
def end(*arguments):
    thread = threading.Thread(target=ending._end)
    thread.start()
    thread.join()
ending.main = end
sys.argv = ["epicyclic"]
from epicyclic.__main__ import main
main()
"""
    run = subprocess.run([sys.executable, "-c", program], check=False, capture_output=True)
    assert (run.returncode, run.stderr) == (130, b"Interrupted.\n")
