"""The command compare as a user calls it."""

from __future__ import annotations

import json
import re
from types import SimpleNamespace

import pytest

import epicyclic as ep
from epicyclic.cli.main import main

QUICK = [
    argument
    for mesh in ("sun", "ring")
    for argument in ("--set", f"losses.{mesh}_mesh_pocketing.include=false")
]
"""Without pockets, whose flow takes half a second for each speed and temperature."""


@pytest.fixture
def call(monkeypatch, capsys):
    """The command in this process, which has the kernels already."""

    def run(*arguments):
        monkeypatch.setattr("sys.argv", ["epicyclic", "compare", *arguments])
        code = 0
        try:
            main()
        except SystemExit as ended:
            code = ended.code
        shown = capsys.readouterr()
        return SimpleNamespace(returncode=code, stdout=shown.out, stderr=shown.err)

    return run


@pytest.fixture
def measured(tmp_path):
    """A table of measurements that the model overestimates at 90 degC only."""
    path = tmp_path / "measured.csv"
    path.write_text(
        "speed [rpm],torque [N*m],temperature [degC],loss [W],uncertainty [%]\n"
        "1000,500,90,440,2\n2000,500,90,850,2\n4000,500,90,1600,2\n4000,0,90,220,2\n"
        "1000,500,40,350,2\n4000,0,40,350,2\n"
    )
    return str(path)


def test_tables_are_printed(call, measured):
    done = call("talbot-2012", measured, *QUICK)
    assert done.returncode == 0, done.stderr
    assert re.search(r"as given: all +6 ", done.stdout)
    assert re.search(r"  temperature 40 +2 ", done.stdout)
    assert "CALIBRATED" not in done.stdout
    assert "Not included: thrust_bearing_viscous" in done.stdout


def test_negative_losses_are_told_with_their_lines(call, tmp_path):
    """Scatter about zero is sound, a wrong sign is not: the user knows which it is."""
    path = tmp_path / "measured.csv"
    path.write_text("speed [rpm],torque [N*m],loss [W]\n2000,300,989\n1700,130,-4.5\n900,0,-1\n")
    done = call("train-8hp70", str(path))
    assert done.returncode == 0, done.stderr
    told = " ".join(done.stdout.split())
    assert "measured losses are negative: -4.5 W in line 3, -1 W in line 4." in told
    assert "exceed the power" not in told
    path.write_text("speed [rpm],torque [N*m],loss [kW]\n2000,300,989\n1700,130,4.5\n900,0,1\n")
    told = " ".join(call("train-8hp70", str(path)).stdout.split())
    assert "measured losses exceed the power at the input: 989000 W in line 2." in told


@pytest.mark.slow
def test_a_calibration_is_called_so_everywhere(call, measured, tmp_path):
    case, picture, data = (tmp_path / name for name in ("fitted.toml", "fit.svg", "fit.json"))
    key = "losses.carrier_drag.factor"
    keys = f"surroundings.oil_air_ratio,{key}"
    done = call(
        "talbot-2012", measured, *QUICK, "--fit", keys, "--hold-out", "temperature=40",
        "-o", str(case), "--plot", str(picture), "--json", str(data),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "CALIBRATED: held-out " in done.stdout
    assert "CALIBRATED values" in done.stdout
    assert "CALIBRATED: surroundings.oil_air_ratio =" in picture.read_text(encoding="utf-8")

    fit = json.loads(data.read_text(encoding="utf-8"))["fit"]
    assert fit["state"] == "CALIBRATED"
    assert fit["points"] == 4
    values = {item["key"]: item["value"] for item in fit["parameters"]}
    text = case.read_text(encoding="utf-8")
    assert text.startswith("# CALIBRATED")
    assert len(re.findall(r"^(?:oil_air_ratio|carrier_drag) = .*# .*CALIBRATED", text, re.M)) == 2
    fitted = ep.load_case(case)
    assert fitted.surroundings.oil_air_ratio == values["surroundings.oil_air_ratio"]
    assert fitted.losses.carrier_drag.factor == values[key]
    assert set(fitted.given()["uncertainty"]) == set(fit["uncertainty"])


@pytest.mark.slow
def test_a_fit_tells_how_it_gets_on_and_carries_its_uncertainty(call, tmp_path, monkeypatch):
    """Sliding and oil share of a set, from losses of the model itself with 1 % off and on."""
    path, case = tmp_path / "measured.csv", tmp_path / "fitted.toml"
    truth = ep.load_case("talbot-2012").updated(
        {f"losses.{mesh}_mesh_pocketing.include": False for mesh in ("sun", "ring")}
        | {"surroundings.oil_air_ratio": 0.08, "planet.roughness": "0.3 um"}
    )
    lines = ["speed [rpm],torque [N*m],temperature [degC],loss [W],uncertainty [%]"]
    for speed, torque, temperature, off in (
        (1000, 900, 90, 1.01), (2500, 400, 70, 0.99), (3700, 0, 40, 1.005), (4200, 150, 60, 0.995)
    ):  # fmt: skip
        point = {
            "operation.speed": f"{speed} rpm",
            "operation.torque": f"{torque} N*m",
            "operation.oil_inlet_temperature": f"{temperature} degC",
        }
        total = ep.solve(truth.updated(point)).total
        lines.append(f"{speed},{torque},{temperature},{off * total:.6g},1")
    path.write_text("\n".join(lines))
    keys = ["surroundings.oil_air_ratio", "planet.roughness"]
    arguments = ["talbot-2012", str(path), *QUICK, "--fit", ",".join(keys), "-o", str(case)]
    done = call(*arguments)
    assert done.returncode == 0, done.stderr
    assert re.search(
        r"^fit: error of .* of the uncertainties, rms, at surroundings", done.stderr, re.M
    )
    assert re.search(r"^ +4 +3700 +0 +40 ", done.stdout, re.M)
    assert "profiles of the likelihood" in done.stdout

    stated = ep.load_case(case).given()["uncertainty"]
    assert list(stated) == keys
    assert list(stated["planet.roughness"]["correlated"]) == keys[:1]
    data = ep.uncertainty(ep.load_case(case), samples=16)
    rows = dict(zip(data["input"].values, data["distribution"].values, strict=True))
    assert rows["surroundings.oil_air_ratio"].startswith("normal, 0.00")
    assert " + ".join(keys) in {" + ".join(sorted(name.split(" + "), key=keys.index)) for name in
                                map(str, data["driver"].values) if " + " in name}  # fmt: skip

    monkeypatch.setenv("EPICYCLIC_PROGRESS", "0")
    assert "fit: " not in call(*arguments).stderr


def test_json_goes_to_standard_output(call, measured):
    done = call("talbot-2012", measured, *QUICK, "--json")
    content = json.loads(done.stdout)
    assert content["fit"] is None
    assert [point["measured [W]"] for point in content["points"]][:2] == [440, 850]
    assert content["errors"][0]["count"] == 6


def test_load_dependent_losses_as_a_rig_forms_them(call, measured):
    warm = ["--set", "models.temperatures=network", "--set", "thermal.oil_flow=4 l/min"]
    arguments = ["talbot-2012", measured, *QUICK, *warm, "--component", "load_dependent"]
    done = call(*arguments, "--load-dependent", "as-tested")
    assert done.returncode == 0, done.stderr
    told = " ".join(done.stdout.split())
    assert "Load-dependent losses as tested: total loss less that without torque" in told


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--load-dependent", "as-tested"], "none were measured"),
        (["-o", "fitted.toml"], "but no keys are calibrated"),
        (["--fit", "planet.roughness", "-o", "fitted.txt"], "must end in .toml"),
        (["--plot", "fit.jpg"], "must end in .png"),
        (["--fit", "planet.roughnes"], "planet.roughness"),
        (["--hold-out", "0.5"], "no keys are fitted"),
        (["--seed", "4", "--hold-out", "speed=2000"], "draws the random share of --hold-out"),
    ],
)
def test_bad_options_end_before_anything_is_written(call, measured, tmp_path, arguments, words):
    done = call("talbot-2012", measured, *QUICK, *arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["measured.csv"]


def test_a_bad_table_is_told_without_a_traceback(call, tmp_path):
    path = tmp_path / "measured.csv"
    path.write_bytes(bytes(range(256)) * 1000)
    done = call("talbot-2012", str(path))
    assert done.returncode == 2
    assert "measured.csv" in done.stderr
    assert "Traceback" not in done.stderr
