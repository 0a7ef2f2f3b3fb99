"""The command as a user meets it."""

from __future__ import annotations

import importlib
import json
import os
import re
import sys
import tomllib
from pathlib import Path

import click
import pytest

import epicyclic as ep
from epicyclic.cli.main import WRITTEN, cli, main
from frozen.command import run_command

PLANETARY_LOSSES = [
    "sun_mesh_sliding",
    "sun_mesh_rolling",
    "ring_mesh_sliding",
    "ring_mesh_rolling",
    "planet_bearing_mechanical",
    "planet_bearing_viscous",
    "sun_mesh_pocketing",
    "ring_mesh_pocketing",
    "sun_drag",
    "ring_drag",
    "carrier_drag",
    "planets_drag",
    "thrust_bearing_viscous",
]


def test_run_prints_where_the_watts_go(epicyclic):
    done = epicyclic("run", "talbot-2012", "--details")
    assert done.returncode == 0
    assert done.stderr == ""
    for name in PLANETARY_LOSSES:
        assert name.replace("_", " ") in done.stdout
    for words in (
        "load-dependent",
        "load-independent",
        "efficiency",
        "operating pressure angle",
        "transverse contact ratio",
        "pitch-line speed",
        "largest sliding speed",
        "largest Hertz pressure",
        "smallest film ratio",
        "mean coefficient of friction",
        "radial force",
        "tilting moment",
        "most loaded roller",
        "highest pressure in the pockets",
        "Out of range: ",
        "Sources",
    ):
        assert words in done.stdout, words
    assert max(map(len, done.stdout.splitlines())) <= 100


@pytest.fixture(scope="module")
def as_json(tmp_path_factory):
    """What `run` prints of the test article as JSON."""
    done = run_command(("run", "talbot-2012", "--json", "-"), tmp_path_factory.mktemp("json"))
    return json.loads(done.output)


def test_json_result_keeps_the_contract(epicyclic, as_json, tmp_path):
    result = as_json
    assert list(result["losses"]) == PLANETARY_LOSSES
    assert result["total"] == pytest.approx(sum(result["losses"].values()), rel=1e-12)
    assert result["total"] == pytest.approx(
        result["load_dependent"] + result["load_independent"], rel=1e-12
    )
    assert result["efficiency"] == pytest.approx(1 - result["total"] / result["input_power"])
    assert result["status"] == "converged"
    assert all(isinstance(warning, str) for warning in result["warnings"])
    assert result["versions"]["epicyclic"]
    assert result["models"]["friction"] == "mixed-lubrication"
    file = tmp_path / "result.json"
    assert epicyclic("run", "talbot-2012", "--json", str(file)).returncode == 0
    assert json.loads(file.read_text()) == result


@pytest.mark.parametrize("rest", [(), ("--set", "operation.torque=10 N*m")])
def test_json_without_a_file_goes_to_standard_output(epicyclic, rest):
    done = epicyclic("run", "talbot-2012-pair", "--json", *rest)
    assert done.returncode == 0
    assert json.loads(done.stdout)["losses"]


@pytest.mark.skipif(sys.platform == "win32", reason="needs named pipes and links")
def test_json_goes_through_pipes_and_links(epicyclic, tmp_path):
    file, link, pipe = tmp_path / "r.json", tmp_path / "link.json", tmp_path / "pipe.json"
    link.symlink_to(file)
    assert epicyclic("run", "talbot-2012-pair", "--json", str(link)).returncode == 0
    assert link.is_symlink()
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        assert epicyclic("run", "talbot-2012-pair", "--json", str(pipe)).returncode == 0
        assert pipe.is_fifo()
        assert os.read(reader, 10**6).decode() == file.read_text()
    finally:
        os.close(reader)


def test_zeros_have_no_sign(epicyclic, coarse_options, tmp_path):
    file = tmp_path / "result.json"
    for change in ("operation.torque=0 N*m", "operation.speed=0 rpm", "operation.speed=-100 rpm"):
        done = epicyclic(
            "run", "talbot-2012", "--details", "--set", change, *coarse_options, "--json", str(file)
        )
        for text in (done.stdout, file.read_text()):
            assert len(text) > 1000
            # not in the name of a folder, such as pytest-0
            assert re.search(r"(?<!\w)-0(\.0*)?(?![\d.])", text) is None


@pytest.mark.parametrize("change", ["operation.torque=0 N*m", "operation.speed=0 rpm"])
def test_tables_say_that_there_is_no_load_or_motion(epicyclic, change):
    given = ("--set", "models.mesh_loads=without-losses", "--set", change)
    told = {
        ("run", "--details"): "no load or no motion in the mesh",
        ("friction",): "Without load or motion",
    }
    for command, words in told.items():
        done = epicyclic(*command, "talbot-2012", *given)
        assert done.returncode == 0
        assert words in done.stdout
        assert "nan" not in done.stdout.split()


def test_inputs_of_a_result_are_the_case_again(epicyclic):
    result = json.loads(epicyclic("run", "talbot-2012-n4-polished", "--json", "-").stdout)
    again = ep.solve(ep.load_case(result["inputs"]))
    assert again.losses == result["losses"]


def test_gear_pair_has_its_own_losses(epicyclic):
    done = epicyclic("run", "talbot-2012-pair", "--set", "operation.torque=100 N*m", "--json", "-")
    result = json.loads(done.stdout)
    assert list(result["losses"]) == ["mesh_sliding", "mesh_rolling", "mesh_pocketing", "drag"]
    assert result["losses"]["mesh_sliding"] > 0


def test_set_changes_the_case(epicyclic, coarse_options):
    args = ("--set", "operation.torque=-500 N*m", "--set", "planet.count=6", "--json", "-")
    result = json.loads(epicyclic("run", "talbot-2012", *args, *coarse_options).stdout)
    assert result["inputs"]["planet"]["count"] == 6
    assert result["members"]["sun"]["torque"]["value"] == -500
    assert 0 < result["efficiency"] < 1
    # with the torque reversed power enters through the carrier
    assert result["members"]["carrier"]["power"]["value"] == pytest.approx(result["input_power"])


def test_an_empty_value_removes_a_key(epicyclic):
    done = epicyclic("run", "talbot-2012", "--set", "carrier=", "--json", "-")
    result = json.loads(done.stdout)
    assert result["losses"]["carrier_drag"] == 0
    assert "no [carrier]" in result["not_included"]["carrier_drag"]


def test_options_of_a_loss_are_reported(epicyclic, as_json):
    args = (
        "--set", "losses.sun_drag.factor=2",
        "--set", "losses.ring_mesh_rolling.include=false",
    )  # fmt: skip
    result = json.loads(epicyclic("run", "talbot-2012", *args, "--json", "-").stdout)
    assert result["losses"]["sun_drag"] == 2 * as_json["losses"]["sun_drag"]
    assert result["losses"]["ring_mesh_rolling"] == 0
    assert result["not_included"]["ring_mesh_rolling"] == "left out by the case"
    assert result["factors"] == {"sun_drag": 2.0}
    assert any("sun drag is multiplied by 2" in warning for warning in result["warnings"])


def test_all_problems_of_a_case_are_reported_together(epicyclic, tmp_path):
    text = Path(ep.__file__).with_name("library").joinpath("cases/talbot-2012.toml").read_text()
    text = text.replace('helix_angle = "13.124 deg"', 'helix_angle = "13.124 mm"')
    text = text.replace("count = 3", "count = 3\ncuont = 4")
    text = text.replace('oil = "atf-talbot-2012"', 'oil = "atf-talbot-2021"')
    text = text.replace('width = "60 mm"', "width = 60")
    file = tmp_path / "case.toml"
    file.write_text(text)
    done = epicyclic("run", str(file), "--json", str(tmp_path / "result.json"))
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert "4 problems" in done.stderr
    for words in ("gears.helix_angle", "planet.cuont", "lubricant.oil", "carrier.width"):
        assert words in done.stderr
    for words in ("'count'", "'atf-talbot-2012'", "60 mm"):
        assert words in done.stderr
    assert not (tmp_path / "result.json").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("run", "talbot-2013"), "talbot-2012"),
        (("run", "missing.toml"), "cannot be read"),
        (("run",), "Missing argument"),
        (("rum", "talbot-2012"), "No such command"),
        (("run", "talbot-2012", "--set", "planet.count"), "KEY=VALUE"),
        (("run", "talbot-2012", "--set", "planet.cuont=3"), "Did you mean 'count'?"),
        (("run", "talbot-2012-pair", "--json", "no/such/folder/r.json"), "cannot be written"),
        (("run", "talbot-2012-pair", "--json", "."), "cannot be written"),
        (("run", "talbot-2012-pair", "--json", "x" * 300), "cannot be written"),
        (("sweep", "talbot-2012", "-o", "s.csv"), "--vary"),
        (("oils", "atf-talbot-2021"), "atf-talbot-2012"),
    ],
)
def test_bad_commands_end_with_2_and_a_hint(epicyclic, arguments, words):
    done = epicyclic(*arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr


def test_check_only_checks(epicyclic):
    done = epicyclic("check", "talbot-2012-n5")
    assert done.returncode == 0
    assert "valid planetary case" in done.stdout
    assert epicyclic("check", "talbot-2012", "--set", "planet.count=13").returncode == 2


def test_lists_of_what_is_built_in(epicyclic):
    cases = epicyclic("cases").stdout
    assert "talbot-2012-pair" in cases
    assert "polished" in cases
    oils = epicyclic("oils").stdout
    for name in ("atf-talbot-2012", "iso-vg-32-mineral", "iso-vg-680-pao"):
        assert name in oils
    assert "29.77 mm²/s" in epicyclic("oils", "atf-talbot-2012").stdout


@pytest.mark.parametrize("kind", ["planetary", "gear_pair"])
def test_init_writes_a_case_that_runs(epicyclic, tmp_path, kind):
    file = tmp_path / "mine.toml"
    done = epicyclic("init", str(file), "--kind", kind)
    assert done.returncode == 0
    assert tomllib.loads(file.read_text())["kind"] == kind
    assert epicyclic("check", str(file)).returncode == 0
    shadow = epicyclic("init", "talbot-2012-pair")  # would stand in for the built-in case
    assert shadow.returncode == 2
    assert "--like talbot-2012-pair copies the case" in shadow.stderr
    again = epicyclic("init", str(file))
    assert again.returncode == 2
    assert "already exists" in again.stderr


@pytest.mark.parametrize("kind", ["planetary", "gear_pair", "train"])
def test_init_writes_a_minimal_case_that_runs(epicyclic, tmp_path, kind):
    file = tmp_path / "mine.toml"
    assert epicyclic("init", str(file), "--minimal", "--kind", kind).returncode == 0
    assert len(file.read_text().splitlines()) < 60
    checked = epicyclic("check", str(file))
    assert checked.returncode == 0
    assert f" {kind.replace('_', ' ')} case" in checked.stdout.splitlines()[0]
    result = ep.solve(ep.load_case(file))
    assert 0.9 < result.efficiency < 1


@pytest.mark.parametrize("name", ["talbot-2012-n5-polished", "talbot-2012-pair", "train-eaxle"])
def test_init_like_a_case_is_that_case(epicyclic, tmp_path, name):
    file = tmp_path / "mine.toml"
    assert epicyclic("init", str(file), "--like", name).returncode == 0
    assert ep.load_case(file) == ep.load_case(name)
    again = tmp_path / "again.toml"
    assert epicyclic("init", str(again), "--like", str(file)).returncode == 0
    assert ep.load_case(again) == ep.load_case(name)


def test_init_like_takes_no_kind_and_no_unknown_case(epicyclic, tmp_path):
    file = tmp_path / "mine.toml"
    for options in (["--kind", "train"], ["--minimal"]):
        done = epicyclic("init", str(file), "--like", "talbot-2012", *options)
        assert done.returncode == 2
        assert f"conflicts with {options[0]}" in done.stderr
    assert epicyclic("init", str(file), "--like", "talbot-2013").returncode == 2
    assert not file.exists()


def test_check_shows_a_data_sheet(epicyclic):
    done = epicyclic("check", "talbot-2012", "--set", "gears.center_distance=")
    assert done.returncode == 0
    for words in ("tip diameter d_a", "normal backlash j_bn", "gears.center_distance = "):
        assert words in done.stdout


def test_init_names_every_key(epicyclic, tmp_path):
    from epicyclic.schema.fields import all_keys

    file = tmp_path / "mine.toml"
    epicyclic("init", str(file))
    text = file.read_text()
    for key in all_keys(ep.PlanetaryCase):
        table, _, name = key.rpartition(".")
        short = table.startswith(("lubricant.oil", "losses.")) or table.endswith(".table")
        if not short and "material" not in table:
            assert name in text, key


def test_schema_is_json(epicyclic):
    schema = json.loads(epicyclic("schema").stdout)
    assert {"PlanetaryCase", "GearPairCase"} <= set(schema["$defs"])


def test_friction_models_side_by_side(epicyclic):
    done = epicyclic("friction", "talbot-2012")
    assert done.returncode == 0
    for name in (
        "mixed-lubrication", "mixed-ehl", "schlenk", "niemann-winter", "benedict-kelley",
        "matsumoto", "doleschel", "xu-2007", "constant",
    ):  # fmt: skip
        assert name in done.stdout
    assert "Spread" in done.stdout


def test_an_unexpected_error_is_one_line(monkeypatch, capsys):
    def broken(case):
        raise RuntimeError("something new")

    # what takes the function over when it is imported must not find the broken one
    importlib.import_module("epicyclic.study.bands.study")
    monkeypatch.setattr("epicyclic.study.solve.solve", broken)
    monkeypatch.setattr("sys.argv", ["epicyclic", "run", "talbot-2012"])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 1
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.splitlines()[0] == "Internal error: RuntimeError: something new"
    assert "EPICYCLIC_TRACEBACK=1" in shown.err
    monkeypatch.setenv("EPICYCLIC_TRACEBACK", "1")
    with pytest.raises(RuntimeError, match="something new"):
        main()


@pytest.mark.parametrize("wrapped", [True, False])
def test_an_interruption_ends_with_130(monkeypatch, capsys, wrapped):
    def interrupted(case):
        if wrapped:  # as compiled code does
            raise SystemError("returned a result with an exception set") from KeyboardInterrupt()
        raise KeyboardInterrupt

    monkeypatch.setattr("epicyclic.study.solve.solve", interrupted)
    monkeypatch.setattr("sys.argv", ["epicyclic", "run", "talbot-2012"])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 130
    assert capsys.readouterr().err.strip() == "Interrupted."


def test_version_and_help(started):
    assert "epicyclic" in started("--version").stdout
    assert "talbot-2012" in started("--help").stdout


@pytest.mark.slow
def test_mesh_prints_and_draws(epicyclic, tmp_path):
    coarse = ("--set", "numerics.mesh_positions=5", "--set", "numerics.contact_segments=5")
    done = epicyclic("mesh", "talbot-2012", *coarse, "--plot", str(tmp_path / "teeth.png"))
    assert done.returncode == 0, done.stderr
    assert "mean mesh stiffness" in done.stdout
    for name in ("teeth-sun_mesh.png", "teeth-ring_mesh.png"):
        assert (tmp_path / name).read_bytes().startswith(b"\x89PNG")


def test_mesh_refuses_an_unknown_format_before_any_work(epicyclic, tmp_path):
    done = epicyclic("mesh", "talbot-2012", "--plot", str(tmp_path / "teeth.bmp"))
    assert done.returncode == 2
    assert ".svg" in done.stderr
    assert not list(tmp_path.glob("teeth*"))


def test_changes_of_the_command_come_before_the_checks(epicyclic, tmp_path):
    file = tmp_path / "pair.toml"
    assert epicyclic("init", str(file), "--like", "talbot-2012-pair").returncode == 0
    file.write_text(re.sub("teeth = 25", "teeth = 2", file.read_text(), count=1))
    assert epicyclic("check", str(file)).returncode == 2
    assert epicyclic("check", str(file), "--set", "pinion.teeth=25").returncode == 0
    both = epicyclic("check", str(file), "--set", "gear.face_width=15 kg")
    assert both.returncode == 2
    assert "gear.face_width" in both.stderr
    assert "pinion.teeth = 2" in both.stderr


@pytest.mark.parametrize(
    ("words", "former"),
    [(("pockets", "table"), "pockets-table"), (("pockets", "study"), "study"),
     (("validate", "reproduce"), "reproduce")],
)  # fmt: skip
def test_commands_under_another_one_have_their_former_names_too(epicyclic, words, former):
    now, then = epicyclic(*words, "--help"), epicyclic(former, "--help")
    assert now.returncode == then.returncode == 0
    assert now.stdout == then.stdout
    listed = re.findall(r"^  ([a-z-]+) ", epicyclic("--help").stdout, re.MULTILINE)
    assert words[0] in listed
    assert former not in listed


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["run", "c.toml", "--json", "c.toml"], "--json = c.toml: is also the file of CASE."),
        (["run", "c.toml", "--json", "./r.nc", "--save", "r.nc"], "--save = r.nc: is also the"),
        (["duty", "c.toml", "t.csv", "-o", "t.csv"], "-o = t.csv: is also the file of CYCLE."),
        (["sweep", "c.toml", "-o", "t.csv", "--points", "t.csv"], "the file of --points."),
        (["strength", "c.toml", "--json", "l.toml"], "--json = l.toml: is also the file of CASE."),
    ],
)
def test_no_file_is_written_over_one_that_is_read(tmp_path, arguments, told):
    text = "speed [rpm],torque [N*m]\n1700,31\n"
    for name in ("c.toml", "t.csv"):
        (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / "l.toml").symlink_to("c.toml")
    done = run_command(arguments, tmp_path)
    assert done.code == 2
    assert told in done.errors
    assert {(tmp_path / it).read_text(encoding="utf-8") for it in ("c.toml", "t.csv")} == {text}
    assert not (tmp_path / "r.nc").exists()


def test_options_of_a_picture_need_its_name(epicyclic):
    done = epicyclic("plot", "talbot-2012-pair", "-o", "x.png")
    assert done.returncode == 2
    assert "WHAT: is missing." in done.stderr


def test_a_wrong_distance_ends_a_duty_before_its_map(tmp_path):
    (tmp_path / "c.csv").write_text("time [s],speed [rpm],torque [N*m]\n0,1700,31\n9,1900,37\n")
    arguments = ["duty", "talbot-2012-pair", "c.csv", "--map", "m.nc", "--distance", "0 km"]
    done = run_command(arguments, tmp_path)
    assert done.code == 2
    assert "distance = " in done.errors
    assert not (tmp_path / "m.nc").exists()


def test_every_option_that_names_a_file_is_known_as_read_or_written():
    """Else a new one could be written over a file that its command reads."""
    context = click.Context(cli)
    commands = [cli.get_command(context, name) for name in cli.list_commands(context)]
    options = {
        option.name
        for command in commands
        for option in command.params
        if isinstance(option, click.Option)
        and (isinstance(option.type, click.Path) or option.name == "json_file")
    }
    assert options - WRITTEN == {"points", "journal"}
    assert len(options & WRITTEN) > 3
