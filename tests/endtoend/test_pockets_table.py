"""``epicyclic pockets-table`` as a user meets it."""

from __future__ import annotations

import pytest

COARSE = ("--set", "numerics.pocket_slices=4", "--set", "numerics.pocket_steps=8")


def test_table_is_written_and_a_case_reads_it(epicyclic, tmp_path):
    file = tmp_path / "p.nc"
    made = epicyclic(
        "pockets-table", "talbot-2012-pair", *COARSE, "--speed", "9000:11000:3 rpm",
        "-o", str(file),
    )  # fmt: skip
    assert made.returncode == 0, made.stderr
    assert "interpolated within 0." in made.stdout
    run = epicyclic(
        "run", "talbot-2012-pair", "--details", *COARSE, "--set", f"models.pocketing_table={file}"
    )
    assert run.returncode == 0, run.stderr
    assert "table p.nc" in run.stdout


def test_table_for_people(epicyclic, tmp_path):
    file = tmp_path / "p.csv"
    done = epicyclic(
        "pockets-table", "talbot-2012-pair", *COARSE, "--speed", "10000 rpm",
        "--temperature", "40,90 degC", "-o", str(file),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    lines = file.read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("mesh,driver,speed [rpm],temperature [degC],power [W]")
    assert len(lines) == 1 + 2 * 2


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--speed", "1000 rpm", "-o", "p.xlsx"), "must end in .nc or .csv"),
        (("--speed", "", "-o", "p.nc"), "--speed"),
        (("--speed", "fast", "-o", "p.nc"), "operation.speed"),
    ],
)
def test_mistakes_are_named(epicyclic, options, said):
    done = epicyclic("pockets-table", "talbot-2012-pair", *options)
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr
