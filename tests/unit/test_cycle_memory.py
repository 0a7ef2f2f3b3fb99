"""A duty cycle takes no more memory than stated, whatever its size and the rows of its groups."""

from __future__ import annotations

import inspect
import subprocess
import sys

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import epicyclic as ep
from epicyclic.study.maps.cycle import largest_page, open_cycle

MOST_MEMORY = 200e6
"""Beyond what the program and its libraries take, as docs/how-to/duty-cycle.md says. [bytes]"""
FEW, MANY = 1_000, 12_000_000

READER = r"""\
import re, sys
from pathlib import Path
from epicyclic.maps.cycle import open_cycle
cycle = open_cycle(sys.argv[1])
rows = sum(piece.speed.size for piece in cycle.pieces())
(peak,) = re.findall(r"VmHWM:\s*(\d+) kB", Path("/proc/self/status").read_text())
print(cycle.rows, rows, 1024 * int(peak))
"""


def write(path, rows, **how):
    draw = np.random.default_rng(rows)
    columns = {
        "duration [s]": draw.random(rows) + 0.5,
        "speed [rpm]": 900.0 * draw.random(rows),
        "torque [N*m]": 70.0 * draw.random(rows),
    }
    pq.write_table(pa.table(columns), path, row_group_size=rows, **how)


def memory_of(path, rows):
    command = [sys.executable, "-c", READER, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    first, second, peak = map(int, done.stdout.split())
    assert first == second == rows
    return peak


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_a_single_row_group_of_any_size_is_read_in_pieces(tmp_path):
    write(tmp_path / "few.parquet", FEW)
    write(tmp_path / "many.parquet", MANY)
    assert (tmp_path / "many.parquet").stat().st_size > MOST_MEMORY
    usual = memory_of(tmp_path / "few.parquet", FEW)
    assert memory_of(tmp_path / "many.parquet", MANY) - usual < MOST_MEMORY


def test_pages_beyond_the_stated_size_are_refused(tmp_path):
    """However well they are packed: this file is small."""
    rows = 5_000_000
    ones = pa.table(dict.fromkeys(("duration [s]", "speed [rpm]", "torque [N*m]"), np.ones(rows)))
    path = tmp_path / "one_page.parquet"
    many = {"max_rows_per_page": rows}  # earlier versions of pyarrow have no such bound
    known = inspect.signature(pq.ParquetWriter.__init__).parameters
    pq.write_table(
        ones, path, row_group_size=rows, data_page_size=1 << 30, use_dictionary=False,
        write_batch_size=rows, compression="zstd",
        **{name: value for name, value in many.items() if name in known},
    )  # fmt: skip
    assert path.stat().st_size < 1e6
    command = [sys.executable, "-c", READER, str(path)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 1
    assert "has a page of 40 MB; pages of up to 16 MB are read." in done.stderr, done.stderr


@pytest.mark.parametrize("version", ["1.0", "2.0"])
@pytest.mark.parametrize("dictionary", [True, False])
def test_pages_are_measured_to_the_last_one(tmp_path, version, dictionary):
    path = tmp_path / "cycle.parquet"
    write(path, 500_000, data_page_version=version, use_dictionary=dictionary)
    with pq.ParquetFile(path) as file:
        columns = [file.metadata.row_group(0).column(number) for number in range(3)]
        largest = largest_page(path, file, file.schema_arrow.names, 500_000)
        beyond = largest_page(path, file, ["speed [rpm]"], 10**9)
    assert beyond == 0  # no column is that large
    sizes = [column.total_uncompressed_size for column in columns]
    assert max(sizes) / 40 < largest < min(sizes) / 3


def test_headers_of_pages_that_are_none_are_refused(tmp_path):
    path = tmp_path / "cycle.parquet"
    write(path, 3_000_000)
    content = bytearray(path.read_bytes())
    with pq.ParquetFile(path) as file:
        place = file.metadata.row_group(0).column(1).data_page_offset
    content[place : place + 200_000] = b"\x1c" * 200_000
    path.write_bytes(content)
    with pytest.raises(ep.InputError, match="header of a page"):
        list(open_cycle(path).pieces())
