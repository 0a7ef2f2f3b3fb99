"""Loss maps in the formats of other programs, read back with what their users read them with."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import numpy as np
import openpyxl
import pandas as pd
import pytest
import rumoca
import scipy.io

import epicyclic as ep
from epicyclic.plugins.simulators import tables as simulation
from epicyclic.plugins.simulators.workbook import workbook_problems
from epicyclic.study.maps.formats import formats

HOW_TO = Path(__file__).parents[2] / "docs" / "how-to" / "loss-map.md"

SPEED = ["0 rpm", "500 rpm", "4000 rpm"]
TORQUE = ["-1000 N*m", "-500 N*m", "0 N*m", "500 N*m", "1000 N*m"]
TITLE = "=1+1\nsecond line"
"""A title that a spreadsheet must not take for a formula, nor a table for two lines."""


@pytest.fixture(scope="module")
def data(coarse_talbot):
    return ep.loss_map(coarse_talbot.updated({"title": TITLE}), SPEED, TORQUE, jobs=1)


@pytest.fixture(scope="module")
def temperatures(coarse_talbot):
    return ep.loss_map(
        coarse_talbot,
        SPEED,
        TORQUE,
        ["40 degC", "90 degC"],
        {"sun.roughness": ["ground", "0.2 um"]},
        jobs=1,
    )


def points(data, name):
    """Speed, torque and a variable at every point."""
    speed, torque = np.meshgrid(data["speed"], data["torque"], indexing="ij")
    values = data[name].values.reshape(speed.shape)
    return np.stack([speed.ravel(), torque.ravel(), values.ravel()], axis=1)


def test_excel_has_units_inputs_and_statements(data, tmp_path):
    path = tmp_path / "map.xlsx"
    ep.write_map(data, path)
    book = openpyxl.load_workbook(path, data_only=False)
    assert book.sheetnames == ["map", "oil at 90 °C", "inputs", "about"]
    names, units, *rows = book["map"].iter_rows(values_only=True)
    assert len(rows) == 15
    by_name = dict(zip(names, units, strict=True))
    assert by_name["torque_loss"] == "N*m"
    assert by_name["sun_mesh_sliding"] == "W"
    assert by_name["temperature"] == "degC"
    table = pd.DataFrame(rows, columns=names)
    np.testing.assert_allclose(  # a workbook keeps 16 digits, of 17 that are exact
        table[["speed", "torque", "torque_loss"]], points(data, "torque_loss"), rtol=1e-15
    )
    efficiency = table["efficiency"].astype(float)  # empty where there is none
    np.testing.assert_allclose(efficiency, data["efficiency"].values.ravel(), rtol=1e-15)
    inputs = {row[0]: row[1] for row in book["inputs"].iter_rows(values_only=True)}
    assert inputs["sun.teeth"] == 73
    assert inputs["gears.normal_module"] == "1.813 mm"
    about = {row[0].value: row[1] for row in book["about"].iter_rows()}
    assert about["reference shaft"].value == "sun"
    assert "torque times speed > 0" in about["sign convention"].value
    assert about["title"].data_type == "s"
    (title,) = (row[1] for row in book["inputs"].iter_rows() if row[0].value == "title")
    assert (title.data_type, title.value) == ("s", "=1+1\nsecond line")


def test_matlab_has_axes_variables_units(temperatures, tmp_path):
    path = tmp_path / "map.mat"
    ep.write_map(temperatures, path)
    stored = scipy.io.loadmat(path, simplify_cells=True)["loss_map"]
    assert list(stored["dimensions"]) == ["speed", "torque", "temperature", "sun_roughness"]
    assert stored["torque_loss"].shape == (3, 5, 2, 2)
    for name, array in temperatures.variables.items():
        if array.dtype.kind in "fi":
            np.testing.assert_array_equal(stored[name], array.values)
            assert stored["units"][name] == array.attrs["units"]
    assert stored["status"][0, 0, 0, 0] == "converged"
    assert stored["about"]["reference_shaft"] == "sun"
    assert "never negative" in stored["about"]["sign_convention"]
    assert json.loads(stored["about"]["case"])["sun"]["teeth"] == 73


def test_vecto_reads_header_comment_and_rows(data, tmp_path):
    path = tmp_path / "map.vtlm"
    ep.write_map(data, path)
    lines = path.read_text(encoding="utf-8").splitlines()
    header, comment = lines[0].split(" # ", 1)
    assert header == "Input Speed [rpm],Input Torque [Nm],Torque Loss [Nm]"
    assert "reference shaft: sun" in comment
    assert "temperature: 90.0 degC" in comment
    # as VECTO does: what follows a number sign is dropped, the rest are rows
    rows = list(csv.reader(line.partition("#")[0] for line in lines[1:]))
    table = np.array(rows, dtype=float)
    np.testing.assert_allclose(table, points(data, "torque_loss"), rtol=1e-9)  # ten digits
    assert (table[:, 1] < 0).any()
    assert (table[:, 2] >= 0).all()


def test_gem_has_the_digits_of_the_regulation(data, tmp_path):
    path = tmp_path / "map.csv"
    ep.write_map(data.sel(torque=slice(0, None)), path, "gem")
    text = path.read_text(encoding="utf-8")
    assert "# reference shaft: sun\n" in text
    header, *rows = csv.reader(line for line in text.splitlines() if not line.startswith("#"))
    assert header == ["Input Speed [r/min]", "Input Torque [N*m]", "Power Loss [kW]"]
    assert len(rows) == 9
    assert all(re.fullmatch(r"\d+\.\d,\d+\.\d\d,\d+\.\d{4}", ",".join(row)) for row in rows)
    wanted = points(data.sel(torque=slice(0, None)), "total")[:, 2] / 1000
    np.testing.assert_allclose(np.array(rows, float)[:, 2], wanted, atol=0.00005)  # four decimals


def lossy_gear(table, speed, torque):
    """Torque loss of Modelica.Mechanics.Rotational.Components.LossyGear, speed > 0. [N m]"""
    eta1, eta2, bearing1, bearing2 = (
        np.interp(speed, table[:, 0], table[:, i]) for i in range(1, 5)
    )
    bearing_a = (bearing1 - bearing2) / (eta1 - 1 / eta2)
    if torque - bearing_a >= 0:
        return (1 - eta1) * torque + bearing1
    return (1 - 1 / eta2) * torque + bearing2


def test_modelica_gives_the_losses_within_what_it_states(data, tmp_path):
    path = tmp_path / "my map-2.mo"
    ep.write_map(data, path)
    text = path.read_text(encoding="utf-8")
    assert text.count("record My_map_2 ") == 1
    assert text.endswith("end My_map_2;\n")
    assert "// flange_a: sun; flange_b: carrier; support: ring\n" in text
    code = "\n".join(line for line in text.splitlines() if not line.startswith("//"))
    (body,) = re.findall(r"lossTable\[:, 5\] = \[([^\]]*)\]", code)
    table = np.array([[float(value) for value in row.split(",")] for row in body.split(";")])
    (ratio,) = re.findall(r"Real ratio = (\S+)", code)
    assert float(ratio) == pytest.approx((73 + 125) / 73, rel=1e-12)
    assert table.shape == (3, 5)
    assert ((table[:, 1:3] > 0.97) & (table[:, 1:3] <= 1)).all()
    (stated,) = re.findall(r"error of up to (\S+) N.m", text)
    worst = 0.0
    for speed, torque, loss in points(data, "torque_loss"):
        worst = max(worst, abs(lossy_gear(table, speed * 2 * np.pi / 60, torque) - loss))
    assert worst == pytest.approx(float(stated), rel=0.005)  # three digits are stated
    assert worst < 0.05 * float(data["torque_loss"].max())


@pytest.mark.parametrize("name", ["my map-2", "end", "3d"])
def test_a_modelica_compiler_takes_the_record(data, tmp_path, name):
    """Rumoca compiles a model that uses the table, and simulates it."""
    path = tmp_path / f"{name}.mo"
    ep.write_map(data, path)
    text = path.read_text(encoding="utf-8")
    (record,) = re.findall(r"^record (\w+) ", text, re.MULTILINE)
    table, _ = simulation.loss_table(data)
    user = f"model User {record} gear; Real loss; Real sum(start=0); equation"
    user += " loss = gear.lossTable[2, 4] + (1 - gear.lossTable[2, 2])*500*gear.ratio;"
    user += " der(sum) = loss; end User;"
    result = rumoca.Session().loads(f"{text}\n{user}", model="User").simulate(t=(0, 1), dt=0.5)
    wanted = table[1, 3] + (1 - table[1, 1]) * 500 * (73 + 125) / 73
    found = result.to_dataframe()["sum"].iloc[-1]
    assert found == pytest.approx(wanted, rel=1e-6)  # of the integration; ten digits are written


def matlab_script(path):
    """The variables of a script of vectors and of `reshape`, as MATLAB reads it."""
    lines = path.read_text(encoding="utf-8").splitlines()
    lines = [line.partition("%")[0].replace("...", " ") for line in lines]
    variables = {}
    for name, reshaped, body, sizes in re.findall(
        r"(\w+) = (reshape\()?\[([^\]]*)\](?:, \[([\d ]*)\]\))?;", " ".join(lines)
    ):
        values = np.array([float(item) for item in body.split()])
        if reshaped:
            values = values.reshape([int(size) for size in sizes.split()], order="F")
        variables[name] = values
    return variables


def test_simscape_tables_in_si_units(temperatures, tmp_path):
    path = tmp_path / "loss_map.m"
    one = temperatures.isel(sun_roughness=[1])
    ep.write_map(one, path)
    found = matlab_script(path)
    assert set(found) == {
        "Trq_bpts", "omega_bpts", "Temp_bpts", "torque_loss_tbl", "power_loss_tbl", "eta_tbl",
    }  # fmt: skip
    np.testing.assert_allclose(found["Trq_bpts"], one["torque"])
    np.testing.assert_allclose(found["omega_bpts"], one["speed"] * np.pi / 30, rtol=1e-9)
    np.testing.assert_allclose(found["Temp_bpts"], one["temperature"] + 273.15)
    order = ("torque", "speed", "temperature")
    plain = one.isel(sun_roughness=0)
    for table, name in (("torque_loss_tbl", "torque_loss"), ("power_loss_tbl", "total")):
        np.testing.assert_allclose(found[table], plain[name].transpose(*order), rtol=1e-9)
    wanted = plain["efficiency"].transpose(*order).values
    passing = wanted > 0
    np.testing.assert_allclose(found["eta_tbl"][passing], wanted[passing], rtol=1e-9)
    assert ((found["eta_tbl"] > 0) & (found["eta_tbl"] <= 1)).all()  # as the blocks demand
    assert (found["eta_tbl"][~passing] == 0.001).all()
    text = path.read_text(encoding="utf-8")
    assert "% reference shaft: sun\n" in text
    assert "% sun_roughness: 0.2 um\n" in text
    with pytest.raises(ep.InputError, match="sun_roughness: has 2 values"):
        ep.write_map(temperatures, path)


def test_what_is_no_map_is_refused(data, tmp_path):
    sweep = ep.sweep(ep.load_case("talbot-2012-pair"), {"operation.speed": ["100 rpm"]})
    for other in (sweep, data.isel(temperature=0), data.drop_attrs(), 5):
        with pytest.raises(ep.InputError, match="is not a loss map"):
            ep.write_map(other, tmp_path / "map.csv")
    assert list(tmp_path.iterdir()) == []


def test_modelica_is_exact_for_linear_losses(data):
    """Losses that LossyGear can represent come out of the fit as they were put in."""
    linear = data.copy()
    torque = data["torque"]
    slope = 0.02 * torque.where(torque > 0, 0) - 0.03 * torque.where(torque < 0, 0)
    linear["torque_loss"] = (slope + 0.5).broadcast_like(data["torque_loss"])
    table, deviation = simulation.loss_table(linear)
    np.testing.assert_allclose(table[:, 1:], [[0.98, 1 / 1.03, 0.5, 0.5]] * 3, rtol=1e-6)
    assert abs(deviation).max() < 1e-5  # the tolerance of the bounded solver


@pytest.mark.parametrize("suffix", ["vtlm", "mo"])
def test_formats_of_one_table_refuse_more(temperatures, tmp_path, suffix):
    with pytest.raises(ep.InputError, match="temperature: has 2 values") as error:
        ep.write_map(temperatures, tmp_path / f"map.{suffix}")
    assert len(error.value.problems) == 2
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("select", "format", "words"),
    [
        ({"torque": slice(0, None)}, "vecto", "negative and positive"),
        ({"torque": slice(0, None)}, "modelica", "negative and positive"),
        ({"speed": slice(500, None)}, "modelica", "starts at rest"),
        ({}, "gem", "must not be negative"),
    ],
)
def test_formats_say_what_they_need(data, tmp_path, select, format, words):
    with pytest.raises(ep.InputError, match=words):
        ep.write_map(data.sel(select), tmp_path / "map.x", format)
    assert list(tmp_path.iterdir()) == []


def test_gaps_are_refused_and_backward_rotation_too(data, tmp_path):
    gap = data.copy(deep=True)
    gap["torque_loss"][0, 0] = np.nan
    with pytest.raises(ep.InputError, match="missing at 1 points, but all are needed"):
        ep.write_map(gap, tmp_path / "map.vtlm")
    backwards = data.assign_coords(speed=[-1.0, 0.0, 1.0])
    with pytest.raises(ep.InputError, match="speed: must not be negative"):
        ep.write_map(backwards, tmp_path / "map.vtlm")
    assert list(tmp_path.iterdir()) == []


def test_a_second_driven_member_is_refused_before_computing(tmp_path, epicyclic):
    done = epicyclic(
        "map", "talbot-2012", "--set", "operation.fixed=", "--set", "operation.second_input=ring",
        "--set", "operation.second_speed=100 rpm", "--speed", "1:9:2 rpm",
        "--torque", "-1:1:2 N*m", "-o", str(tmp_path / "map.vtlm"),
    )  # fmt: skip
    assert done.returncode == 2
    assert "one input and one output" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_cannot_be_finished_leaves_the_old_one(data, tmp_path, monkeypatch):
    path = tmp_path / "map.mat"
    path.write_text("old")

    def fail(file, *args, **kwargs):
        file.write(b"half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("scipy.io.savemat", fail)
    with pytest.raises(ep.InputError, match="No space left"):
        ep.write_map(data, path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("name", "options", "start"),
    [
        ("map.vtlm", (), b"Input Speed [rpm]"),
        ("map.mo", (), b"// title"),
        ("map.xlsx", (), b"PK"),
        ("map.mat", (), b"MATLAB 5.0"),
        ("map.m", (), b"% title"),
        ("map.fmu", (), b"PK"),
        ("map.txt", ("--format", "vecto"), b"Input Speed [rpm]"),
    ],
)
def test_the_command_writes_by_suffix_or_name(
    tmp_path, epicyclic, coarse_options, name, options, start
):
    done = epicyclic(
        "map", "talbot-2012", "--speed", "0,1000 rpm", "--torque", "-100,0,100 N*m",
        "-o", str(tmp_path / name), *options, *coarse_options,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stderr == "" or done.stderr.startswith("Interpolated linearly in torque; ")
    assert (tmp_path / name).read_bytes().startswith(start)
    assert [path.name for path in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize("name", ["map.csv", "map.m", "map.vtlm"])
def test_a_stored_map_is_written_in_another_format(data, tmp_path, epicyclic, name):
    stored, output = tmp_path / "stored.nc", tmp_path / name
    ep.write_map(data, stored)
    done = epicyclic("map", str(stored), "-o", str(output))
    assert done.returncode == 0, done.stderr
    assert done.stdout == f"Wrote the map of {stored} to {output}.\n"
    ep.write_map(data, tmp_path / f"direct-{name}")
    assert output.read_bytes() == (tmp_path / f"direct-{name}").read_bytes()


def test_a_stored_map_takes_no_options_of_what_is_computed(data, tmp_path, epicyclic):
    stored, output = tmp_path / "stored.nc", tmp_path / "map.csv"
    ep.write_map(data, stored)
    done = epicyclic("map", str(stored), "-o", str(output), "--speed", "1 rpm", "--jobs", "2")
    assert done.returncode == 2
    for option in ("--speed", "--jobs"):
        assert f"{option}: selects what is computed, but a stored map already" in done.stderr
    assert not output.exists()


def test_a_case_needs_speeds_and_torques(tmp_path, epicyclic):
    done = epicyclic("map", "talbot-2012", "--speed", "1 rpm", "-o", str(tmp_path / "map.csv"))
    assert done.returncode == 2
    assert '--torque: is missing. For example --torque "' in done.stderr
    assert "--speed" not in done.stderr


def test_the_command_says_why_points_are_missing(tmp_path, epicyclic):
    done = epicyclic(
        "map", "talbot-2012", "--speed", "0,1000 rpm", "--torque", "-100,100 N*m",
        "--vary", "planet.count=12", "--jobs", "1", "-o", str(tmp_path / "map.vtlm"),
    )  # fmt: skip
    assert done.returncode == 2
    assert "overlap" in done.stderr
    assert "missing at 4 points" in done.stderr
    assert not (tmp_path / "map.vtlm").exists()


def test_excel_refuses_more_points_than_it_has_rows():
    axes = {"speed": range(1100), "torque": range(1000), "temperature": [90.0]}
    (problem,) = workbook_problems(axes)
    assert "1100000 points" in problem.allowed
    assert workbook_problems(axes | {"speed": range(1000)}) == []


def test_the_how_to_lists_every_format():
    rows = re.findall(r"^\| `(\w+)` \| (?:`(\.\w+)`|by name) \|", HOW_TO.read_text("utf-8"), re.M)
    assert rows == [(name, item.suffix) for name, item in formats().items()]
