"""A thousand hostile files over every reader: one clear error each, soon and in little memory."""

from __future__ import annotations

import os
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pytest

import epicyclic as ep
from campaign.hostile import hostile_file
from epicyclic.plugins.contact_solver.surfaces import read_profile
from limits import MOST_MEMORY, is_soon, peak_memory

sys.path.insert(0, str(Path(__file__).parents[1] / "unit"))
from test_damaged_files import LONGEST_MESSAGE, READERS, binary_files, sound_file

__all__ = ["binary_files"]

OF_EACH = 44
"""Files of each of the 23 kinds."""


@pytest.mark.slow
@pytest.mark.parametrize("name", READERS)
def test_hostile_files_end_in_an_input_error_or_are_read(tmp_path, binary_files, name):
    check(tmp_path, {it: sound_file(it, binary_files) for it in READERS}, name, range(OF_EACH))


@pytest.mark.parametrize("name", ["case.toml", "cycle.csv", "points.csv", "drag.csv"])
def test_some_hostile_files_of_text_end_in_an_input_error_or_are_read(tmp_path, name):
    texts = ("case.toml", "cycle.csv", "points.csv", "drag.csv")
    check(tmp_path, {it: sound_file(it, {}) for it in texts}, name, range(100, 106))


def check(folder, sound, name, numbers):
    others = [data for kind, data in sound.items() if kind != name]
    path = folder / name
    messages, before = {}, peak_memory()
    for number in numbers:
        path.unlink(missing_ok=True)  # HDF5 knows a file by its place on the disk
        path.write_bytes(hostile_file(name, sound[name], others, number))
        start = time.process_time()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of the libraries, on odd workbooks
            try:
                READERS[name](path)
            except ep.InputError as error:
                messages[number] = str(error)
            except ep.ConvergenceError:
                pass  # was read
        assert is_soon(time.process_time() - start), number
        assert peak_memory() - before < MOST_MEMORY, number
    assert messages
    assert max(map(len, messages.values())) < LONGEST_MESSAGE
    assert all(it.replace("\n", "").isprintable() for it in messages.values())


def test_a_clock_that_jumps_mixes_up_no_files(tmp_path):
    """Another file of the same size, changed at the same time by a clock that was set back."""
    path, heights = tmp_path / "profile.csv", np.sin(np.arange(200) / 7)
    found = []
    for scale in (1.0, 2.0):
        rows = (f"{0.001 * n:.3f},{scale * z:+.4f}\n" for n, z in enumerate(heights))
        path.write_text("".join(rows), encoding="utf-8")
        os.utime(path, ns=(7_000_000_000, 7_000_000_000))
        found.append(read_profile(path).rms)
    assert found[1] == pytest.approx(2 * found[0], rel=1e-3)  # four decimals
