"""A duty cycle takes no more memory than stated, whatever its size and the rows of its groups."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

MOST_MEMORY = 200e6
"""Beyond what the program and its libraries take, as docs/how-to/duty-cycle.md says. [bytes]"""
FEW, MANY = 1_000, 12_000_000

READER = r"""\
import re, sys
from pathlib import Path
from epicyclic.study.maps.cycle import open_cycle
cycle = open_cycle(sys.argv[1])
rows = sum(piece.speed.size for piece in cycle.pieces())
(peak,) = re.findall(r"VmHWM:\s*(\d+) kB", Path("/proc/self/status").read_text())
print(cycle.rows, rows, 1024 * int(peak))
"""


def write(path, rows):
    draw = np.random.default_rng(rows)
    columns = {
        "duration [s]": draw.random(rows) + 0.5,
        "speed [rpm]": 900.0 * draw.random(rows),
        "torque [N*m]": 70.0 * draw.random(rows),
    }
    pq.write_table(pa.table(columns), path, row_group_size=rows)


def memory_of(path, rows):
    command = [sys.executable, "-c", READER, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    first, second, peak = map(int, done.stdout.split())
    assert first == second == rows
    return peak


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_a_single_row_group_of_any_size_is_read_in_pieces(tmp_path):
    write(tmp_path / "few.parquet", FEW)
    write(tmp_path / "many.parquet", MANY)
    assert (tmp_path / "many.parquet").stat().st_size > MOST_MEMORY
    usual = memory_of(tmp_path / "few.parquet", FEW)
    assert memory_of(tmp_path / "many.parquet", MANY) - usual < MOST_MEMORY
