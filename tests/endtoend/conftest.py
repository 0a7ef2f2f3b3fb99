from __future__ import annotations

import os
import subprocess
import sys

import pytest


@pytest.fixture
def epicyclic(tmp_path):
    """The command, run in an empty folder as a user would."""
    folder = tmp_path / "elsewhere"

    def call(*arguments: str) -> subprocess.CompletedProcess[str]:
        folder.mkdir(exist_ok=True)
        try:
            return subprocess.run(
                [sys.executable, "-m", "epicyclic", *arguments],
                cwd=folder,
                env={"EPICYCLIC_PROGRESS": "0"} | os.environ,  # however slow the machine is
                capture_output=True,
                text=True,
                check=False,
                timeout=300,  # the first one compiles the kernels, beside other tests
            )
        finally:
            if not any(folder.iterdir()):
                folder.rmdir()

    return call
