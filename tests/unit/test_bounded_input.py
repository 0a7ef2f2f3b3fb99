"""Input that is far too large or strangely shaped: one bounded message, soon."""

from __future__ import annotations

import csv
import json
import time

import netCDF4
import numpy as np
import pytest
import xarray as xr

import epicyclic as ep
from epicyclic.cli.main import main
from epicyclic.errors import InputError, Problem
from epicyclic.plugins.contact_solver import campaign as campaign_folder
from epicyclic.plugins.contact_solver.campaign import make_campaign
from epicyclic.study.sweeps.run import write_dataset
from limits import is_soon

LONGEST = 100_000
DOTS = ".".join(["a"] * 1000)


@pytest.mark.slow
@pytest.mark.parametrize(
    "arguments",
    [
        ("run", "talbot-2012-pair", "--set", f"{DOTS}=1"),
        ("contact", "--set", f"{DOTS}=1"),
        ("run", "talbot-2012-pair", "--set", f"{'{sun,ring}' * 40}=1"),
        ("run", "talbot-2012-pair", "--set", f"{{{','.join('abcdefgh' * 900)}}}.teeth=1"),
        ("run", "talbot-2012-pair", "--set", f"{'{' * 30_000}=1"),
        ("run", "talbot-2012-pair", "--set", f"{'{}' * 15_000}=1"),
        ("run", "talbot-2012-pair", "--set", f"gear={'{a=' * 30_000}"),
        ("run", "talbot-2012-pair", "--set", f"gear={{{DOTS}.{DOTS}.{DOTS}=1}}"),
        ("run", "talbot-2012-pair", "--set", f"gear={'{a={b={c=1}}},' * 5000}"),
        ("sweep", "talbot-2012-pair", "--vary", f"{DOTS}=1,2", "-o", "s.csv"),
        ("sweep", "talbot-2012-pair", "--vary", "operation.speed=1:2:1000000 rpm",
         "--vary", "operation.torque=1:2:1000000 N*m", "-o", "s.csv"),
        ("sweep", "talbot-2012-pair", "--vary", "planet.count=3", "--jobs", "1000000000000",
         "-o", "s.csv"),
        ("map", "talbot-2012-pair", "--speed", "1:2:1000000000000 rpm", "--torque", "1:2:2 N*m",
         "-o", "m.nc"),
        ("oil", "characterise", "atf-talbot-2012", "--size", "1000000000000", "-o", "atf"),
        ("oil", "characterise", "atf-talbot-2012", "--size", "9", "--bearing-size", "1000000000000",
         "-o", "atf"),
        ("uncertainty", "talbot-2012-pair", "--samples", "1000000000000"),
        ("run", "talbot-2012-pair", *[part for i in range(3000) for part in ("--set", f"k{i}=1")]),
    ],
    ids=lambda arguments: " ".join(arguments)[:40],
)  # fmt: skip
def test_sizes_and_dots_are_refused(tmp_path, monkeypatch, capsys, arguments):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["epicyclic", *arguments])
    start = time.process_time()
    with pytest.raises(SystemExit) as ended:
        main()
    shown = capsys.readouterr()
    assert ended.value.code == 2, shown.err[:2000]
    assert is_soon(time.process_time() - start)
    assert len(shown.err) < LONGEST
    assert list(tmp_path.iterdir()) == []


def test_values_without_end_are_no_axis():
    def speeds():
        while True:
            yield "1 rpm"

    with pytest.raises(InputError, match="1000000 points or fewer"):
        ep.sweep(ep.load_case("talbot-2012-pair"), {"operation.speed": speeds()})


def test_thousands_of_unknown_keys_make_a_short_message(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text('kind = "planetary"\n[sun]\n' + "".join(f"key{n} = 1\n" for n in range(4_000)))
    start = time.process_time()
    with pytest.raises(InputError) as error:
        ep.load_case(path)
    assert is_soon(time.process_time() - start)
    assert len(error.value.problems) > 4_000
    message = str(error.value)
    assert len(message) < LONGEST
    assert message.endswith(f"... and {len(error.value.problems) - 50} more.")


def test_a_long_problem_is_cut():
    text = str(Problem("key", "x" * 10**6, "must be short.", "Cut it."))
    assert len(text) < 2000
    assert text.startswith("key = xxx")
    assert text.endswith("...")


def test_a_record_without_members_is_refused(talbot_record, tmp_path):
    path = tmp_path / "result.nc"
    ep.save_result(talbot_record, path)
    with netCDF4.Dataset(path, "a") as file:
        content = json.loads(file.getncattr("result"))
        file.setncattr("result", json.dumps(content | {"members": {}}))
    with pytest.raises(InputError, match=r"result\.members"):
        ep.open_result(path)


FORMULAS = ["=1+1", "+1-2", "-2+3", "@SUM(A1)", "\tx", "plain"]


def test_texts_in_csv_are_no_formulas(tmp_path):
    data = xr.Dataset(
        {"message": ("name", np.array(FORMULAS, dtype=object)), "loss": ("name", -np.arange(6.0))},
        {"name": FORMULAS},
    )
    write_dataset(data, tmp_path / "s.csv")
    with (tmp_path / "s.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["message"] for row in rows] == [f"'{text}" for text in FORMULAS[:5]] + ["plain"]
    assert [row["name"] for row in rows] == [row["message"] for row in rows]
    assert [float(row["loss"]) for row in rows] == [-0.0, -1.0, -2.0, -3.0, -4.0, -5.0]


@pytest.fixture
def simulated(tmp_path):
    """The folder of a campaign with a table made up of sound numbers."""
    found = campaign_folder.CampaignFolder(tmp_path, make_campaign("atf-talbot-2012", size=8))
    found.prepare()
    columns = [
        "number", "part", *map(campaign_folder.column_of, campaign_folder.AXES), "status",
        "message", "friction", "friction_error", "rolling_loss", "rolling_loss_error",
        "unsolved_share",
    ]  # fmt: skip
    rows = [
        {name: 1.5 + 0.1 * i + 0.01 * j for j, name in enumerate(columns)}
        | {"part": "gear", "status": "converged", "message": ""}
        for i in range(8)
    ]
    with found.table.open("w", newline="") as file:
        table = csv.DictWriter(file, columns)
        table.writeheader()
        table.writerows(rows)
    return found


DAMAGE = {
    "text": lambda text: text.replace("1.5", "many", 3),
    "no column": lambda text: text.replace("rolling_loss_error", "other"),
    "endless": lambda text: text.replace("1.5", "inf", 2),
    "no number": lambda text: text.replace("1.52,", ",", 1),
    "binary": lambda text: "\0\1\2" * 100,
    "empty": lambda text: "",
    "too few": lambda text: "\n".join(text.splitlines()[:4]),
    "open quote": lambda text: text.replace("gear", '"gear', 1),
    "ragged": lambda text: text.replace("converged", "converged,1,2", 1),
    "huge": lambda text: text + "1" * 250_000_000,
}


@pytest.mark.slow
@pytest.mark.parametrize("damage", DAMAGE)
def test_bad_tables_of_simulations_are_refused(simulated, monkeypatch, capsys, damage):
    simulated.table.write_text(DAMAGE[damage](simulated.table.read_text()))
    monkeypatch.setattr("sys.argv", ["epicyclic", "oil", "fit", str(simulated.path)])
    with pytest.raises(SystemExit) as ended:
        main()
    shown = capsys.readouterr().err
    assert ended.value.code == 2, shown
    assert str(simulated.table) in shown
    assert len(shown) < 3000
