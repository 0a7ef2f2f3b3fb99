"""Sound files damaged at random: a reader takes them, or says in its own words what is wrong.

A quick share runs in the suite, more with ``-m slow``, all with ``-m campaign -s``, which prints
how many were refused.
"""

from __future__ import annotations

import io
import re
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import x3pio

import epicyclic as ep
from epicyclic.contact.fitted_models import read_oil_model
from epicyclic.library import oil_model_file
from epicyclic.losses.loss_table import read_loss_table
from epicyclic.losses.pocket_tables import read_stored
from epicyclic.plugins.contact_solver.campaign import CampaignFolder, make_campaign, open_folder
from epicyclic.plugins.contact_solver.contact import contact_model, load_contact_case
from epicyclic.plugins.contact_solver.surfaces import read_profile
from epicyclic.plugins.rexs.exporting import rexs_bytes
from epicyclic.plugins.rexs.importing import read_rexs
from epicyclic.show.record import open_map
from epicyclic.show.template import case_text
from epicyclic.study.maps.cycle import open_cycle
from epicyclic.study.measured.table import parse_measurements
from epicyclic.study.sweeps.axes import columns_of
from epicyclic.study.sweeps.run import SweepPlan, make_plan, write_dataset
from epicyclic.study.sweeps.runner import Journal, Row, Runner, gather
from epicyclic.study.table_file import read_grid
from limits import MOST_MEMORY, is_soon, peak_memory

QUICK, SLOW, ALL = 12, 200, 1000
COARSE = {"numerics.pocket_slices": 4, "numerics.pocket_steps": 12}
OIL = {
    "kind": "mineral",
    "kinematic_viscosity": [
        {"temperature": "40 degC", "value": "46 mm^2/s"},
        {"temperature": "100 degC", "value": "7.8 mm^2/s"},
    ],
    "density": [{"temperature": "15 degC", "value": "870 kg/m^3"}],
    "pressure_viscosity": {"law": "gold", "s": 9.904, "t": 0.139},
}
RICH = {
    "lubricant.oil": OIL,
    "models.friction": "table",
    "friction_table": {"film_ratio": [0.1, 0.5, 3.0], "friction": [0.09, 0.06, 0.03]},
    "sun.micro_geometry": {
        "topography": {
            "diameter": ["132 mm", "139 mm"],
            "face_position": ["0 mm", "30 mm"],
            "deviation": [["0 um", "1 um"], ["2 um", "3 um"]],
        }
    },
}
"""Tables within tables and lists: an oil, coefficients of friction, deviations of a flank."""
CONTACT = """\
[contact]
radius = "8 mm"
line_load = "300 N/mm"
rolling_speed = "8 m/s"

[lubricant]
oil = "iso-vg-100-mineral"
temperature = "80 degC"
pressure_law = "two-slope"
second_slope = "8 1/GPa"
transition_pressure = "0.4 GPa"

[surface1]
roughness = "0.4 um"
skewness = -0.5
kurtosis = 4
"""
LONGEST_MESSAGE = 20_000
ODD = [b"nan", b"inf", b"-", b"1e999", b"[", b"{", b'"', b"\0", b"\xff", b"\n", b"9" * 400, b"0"]
NUMBER = re.compile(rb"\d+\.?\d*")


def table_bytes(table, suffix):
    file = io.BytesIO()
    write = {".csv": table.to_csv, ".xlsx": table.to_excel, ".parquet": table.to_parquet}[suffix]
    write(file, index=False)
    return file.getvalue()


def measurements():
    columns = {
        "speed [rpm]": [1000, 2000],
        "torque [N*m]": [500, 10],
        "temperature [degC]": [90, 40],
        "loss [W]": [400.0, 800.0],
        "planet.count": [3, 4],
    }
    return pd.DataFrame(columns)


def read_measured(path):
    return parse_measurements(read_grid(path), ep.load_case("talbot-2012"))


CYCLE = {"speed [rpm]": [900.0, 1800.0], "torque [N*m]": [40.0, -70.0], "duration [s]": [3.0, 5.0]}


def energy_over_cycle(path):
    """What is read goes into a duty cycle: nothing but finite energies may come out."""
    found = ep.duty_cycle(open_map(path), CYCLE, ["60 degC"], clamp=True, samples=1)
    for name in ("energy_in", "energy_out", "energy_lost"):
        assert np.isfinite(found[name]).all(), name


def stored_file(name, write):
    """The bytes of a file that is written to a path."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        write(path)
        return path.read_bytes()


@pytest.fixture(scope="module")
def binary_files(pair_map, talbot_record):
    """Sound files of NetCDF, and a fitted model."""
    speeds = ["6000 rpm", "12000 rpm"]
    pair = ep.load_case("talbot-2012-pair", COARSE | {"models.pocketing": "mean-density"})
    table = ep.pocketing_table(pair, speeds, jobs=1)
    return {
        "map.nc": stored_file("map.nc", lambda path: ep.write_map(pair_map, path)),
        "result.nc": stored_file("result.nc", lambda path: ep.save_result(talbot_record, path)),
        "pockets.nc": stored_file("pockets.nc", lambda path: write_dataset(table, path)),
        "sweep.nc": stored_file(
            "sweep.nc", lambda path: write_dataset(ep.sweep(TRAIN, VARY), path)
        ),
        "bands.nc": stored_file(
            "bands.nc", lambda path: write_dataset(ep.uncertainty(TRAIN, samples=16, jobs=1), path)
        ),
        "model.json": oil_model_file("atf-talbot-2012").read_bytes(),
    }


def sound_file(name, binary_files):
    """The bytes of a sound file."""
    if name in binary_files:
        return binary_files[name]
    stem, dot, suffix = name.partition(".")
    if stem == "case":
        return case_text(ep.load_case("talbot-2012").updated(RICH).given(), []).encode()
    if stem == "contact":
        return CONTACT.encode()
    if name == "profile.x3p":
        file = io.BytesIO()
        x3pio.write(file, 1e-6 * np.sin(np.arange(200)), x_scale=1e-6)
        return file.getvalue()
    if stem == "profile":
        return "".join(f"{0.001 * n:.3f},{np.sin(n):.4f}\n" for n in range(200)).encode()
    if stem == "measured":
        return table_bytes(measurements(), dot + suffix)
    if name == "drag.csv":
        return b"speed [rpm],temperature [degC],torque [N*m]\n" + b"".join(
            b"%d,%d,%.2f\n" % (speed, celsius, 0.1 + speed / celsius / 100)
            for speed in (0, 900, 2500)
            for celsius in (35, 95)
        )
    if name == "sweep.partial":
        return stored_file(name, written_journal)
    if name == "sweep.shard":
        run = Runner(shard=(1, 1), jobs=1)
        return stored_file(
            name, lambda path: list(replace(run, journal=path)._finished(make_plan(TRAIN, VARY)))
        )
    if name == "campaign.json":
        campaign = make_campaign("atf-talbot-2012", size=8)
        return stored_file(name, lambda path: CampaignFolder(path.parent, campaign).prepare())
    if name == "points.csv":
        return b"operation.speed [rpm],operation.torque [N*m]\n900,12\n1700.5,-31\n2600,44\n"
    if stem == "cycle":
        cycle = measurements()[["speed [rpm]", "torque [N*m]"]].assign(**{"time [s]": [0, 1]})
        return table_bytes(cycle, dot + suffix)
    return rexs_bytes(name, ep.solve(ep.load_case("talbot-2012")), None, None)


def merged(path):
    """All points of a shard that states all of them; none of it is made up."""
    _, rows, _ = gather([path], {SweepPlan.kind: SweepPlan})
    assert set(rows.status) == {"converged"}


def written_journal(path):
    journal = Journal(path, FINGERPRINT)
    for point in range(5):
        journal.append(
            point, Row("converged", numbers={"total": 3.5 * point, "ratio": point + 0.5})
        )


def read_journal(path):
    """Rows that were altered are none: those that are left have the numbers that were written."""
    found = Journal(path, FINGERPRINT).read()
    assert all(row.numbers["total"] == 3.5 * point for point, row in found.items())
    if len(found) < 5:
        raise ep.InputError([], "some points are computed again")


FINGERPRINT = "0123456789ab"
TRAIN = ep.load_case("train-8hp70")
VARY = {"operation.speed": ["700 rpm", "1300 rpm", "2900 rpm"], "operation.state": ["1", "R"]}
READERS = {
    "case.toml": ep.load_case,
    "contact.toml": lambda path: contact_model(load_contact_case(path)),
    "profile.csv": read_profile,
    "profile.x3p": read_profile,
    "measured.csv": read_measured,
    "measured.xlsx": read_measured,
    "measured.parquet": read_measured,
    "cycle.csv": open_cycle,
    "cycle.parquet": open_cycle,
    "map.nc": energy_over_cycle,
    "result.nc": ep.open_result,
    "pockets.nc": read_stored,
    "sweep.nc": ep.open_result,
    "bands.nc": ep.open_result,
    "model.json": read_oil_model,
    "campaign.json": lambda path: open_folder(path.parent),
    "points.csv": lambda path: make_plan(TRAIN, {}, points=columns_of(path)),
    "gears.rexs": read_rexs,
    "gears.rexsj": read_rexs,
    "gears.rexsz": read_rexs,
    "drag.csv": read_loss_table,
    "sweep.partial": read_journal,
    "sweep.shard": merged,
}


def damaged(data, rng):
    """`data` cut short, with a byte changed, a piece lost or repeated, or something odd in it."""
    at, length = int(rng.integers(len(data))), int(rng.integers(1, 40))
    head, piece, tail = data[:at], data[at : at + length], data[at + length :]
    odd = ODD[rng.integers(len(ODD))]
    numbers = [match.span() for match in NUMBER.finditer(data)]
    start, end = numbers[rng.integers(len(numbers))] if numbers else (at, at)
    ways = [
        head,
        head + bytes([rng.integers(256)]) + data[at + 1 :],
        head + tail,
        head + piece + piece + tail,
        head + odd + piece + tail,
        data[:start] + odd + data[end:],
    ]
    return ways[rng.integers(len(ways))]


@pytest.mark.filterwarnings("ignore::UserWarning")  # of the libraries, on damaged workbooks
@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize(
    "copies",
    [
        QUICK,
        pytest.param(SLOW, marks=pytest.mark.slow),
        pytest.param(ALL, marks=pytest.mark.campaign),
    ],
    ids=["quick", "slow", "all"],
)
def test_damaged_files_end_in_an_input_error_or_are_read(tmp_path, binary_files, name, copies):
    path = tmp_path / name
    data = sound_file(name, binary_files)
    path.write_bytes(data)
    READERS[name](path)
    rng = np.random.default_rng(2012)
    messages, seconds, before = [], [], peak_memory()
    for _ in range(copies):
        path.unlink()  # HDF5 knows a file that it failed to open by its place on the disk
        path.write_bytes(damaged(data, rng))
        start = time.process_time()
        try:
            READERS[name](path)
        except ep.InputError as error:
            messages.append(str(error))
        seconds.append(time.process_time() - start)
    assert messages
    assert max(map(len, messages)) < LONGEST_MESSAGE
    assert is_soon(max(seconds))
    assert peak_memory() - before < MOST_MEMORY
    print(
        f"{name}: {len(messages)} of {copies} damaged files refused, the others read, "
        f"{max(seconds):.2f} s at most"
    )
