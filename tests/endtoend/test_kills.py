"""A hundred kills: commands that take long go on from where they were, to the same bytes."""

from __future__ import annotations

import random
import shutil
import subprocess
import sys
import time

import pytest
from test_shards import COMMANDS, FAILS, content

from epicyclic.files import PREFIX

pytestmark = [
    pytest.mark.campaign,
    pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX signals"),
]

KILLS = 15
"""Of each of the eight commands."""
COMMANDS = COMMANDS | {"bands.nc": ("uncertainty", "train-eaxle", "--samples", "32")}


def started(output, folder, jobs):
    command = [*COMMANDS[output], "-o", str(folder / output), "--jobs", str(jobs)]
    return subprocess.Popen(
        [sys.executable, "-m", "epicyclic", *command],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def emptied(folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    return folder


def killed(output, folder, seconds):
    """Whether a command was killed after some time; it had ended otherwise."""
    process = started(output, folder, random.randint(1, 2))
    try:
        process.wait(timeout=seconds)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        return True
    return False


@pytest.mark.parametrize("output", COMMANDS)
def test_killed_commands_end_with_the_same_bytes(tmp_path, output):
    random.seed(output)
    wanted = 4 if output in FAILS else 0
    whole, broken = emptied(tmp_path / "whole"), emptied(tmp_path / "broken")
    started(output, whole, 1).wait()  # compiles what is missing
    emptied(whole)
    start = time.monotonic()
    assert started(output, whole, 1).wait() == wanted
    seconds = time.monotonic() - start
    kills = 0
    while kills < KILLS:
        if killed(output, broken, random.uniform(0.3, 1.0) * seconds):
            kills += 1
        else:  # begin anew
            assert content(broken / output) == content(whole / output)
            emptied(broken)
    assert started(output, broken, 1).wait() == wanted
    assert content(broken / output) == content(whole / output)
    assert not list(broken.rglob(f"{PREFIX}*"))
    print(f"{output}: {kills} kills")
