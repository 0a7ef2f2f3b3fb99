from __future__ import annotations

import os
import subprocess
import sys

import pytest

from frozen.command import run_command


@pytest.fixture
def epicyclic(tmp_path):
    """The command, run in an empty folder: within this process, which is a second sooner."""
    folder = tmp_path / "elsewhere"

    def call(*arguments: str) -> subprocess.CompletedProcess[str]:
        folder.mkdir(exist_ok=True)
        try:
            done = run_command(arguments, folder)
        finally:
            if not any(folder.iterdir()):
                folder.rmdir()
        return subprocess.CompletedProcess(arguments, done.code, done.output, done.errors)

    return call


@pytest.fixture
def started(tmp_path):
    """The command in a process of its own, as a user starts it."""

    def call(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "epicyclic", *arguments],
            cwd=tmp_path,
            env={"EPICYCLIC_PROGRESS": "0"} | os.environ,  # however slow the machine is
            capture_output=True,
            text=True,
            check=False,
            timeout=300,  # the first one compiles the kernels, beside other tests
        )

    return call
