"""Commands on trains as a user meets them."""

from __future__ import annotations

import json

import pytest

SMALL = (
    "--set", "numerics.mesh_positions=5", "--set", "numerics.contact_segments=5",
    "--set", "sets.pair.losses.mesh_pocketing.include=false",
    "--set", "sets.planets.losses.sun_mesh_pocketing.include=false",
    "--set", "sets.planets.losses.ring_mesh_pocketing.include=false",
)  # fmt: skip


def test_a_train_is_started_checked_and_run(epicyclic):
    done = epicyclic("init", "--kind", "train", "axle.toml")
    assert (done.returncode, done.stdout) == (0, "Wrote axle.toml. Next: epicyclic run axle.toml\n")
    checked = epicyclic("check", "axle.toml")
    assert checked.returncode == 0, checked.stderr
    assert checked.stdout.startswith("axle.toml: a valid train case; 3 points to check:\n")
    assert "-7.8996" in checked.stdout
    assert "motor_seal seals motor, housing" in " ".join(checked.stdout.split())
    run = epicyclic("run", "axle.toml", "--details", *SMALL)
    assert run.returncode == 0, run.stderr
    assert "ratio -7.8996 " in run.stdout
    assert "Shaft bearings" in run.stdout
    assert max(map(len, run.stdout.splitlines())) <= 100


def test_a_gearbox_is_stored_shown_and_drawn(epicyclic, tmp_path):
    folder = tmp_path / "elsewhere"
    run = epicyclic(
        "run", "train-8hp70", "--set", "operation.state=R", "--save", "r.nc", "--json", "-"
    )
    assert run.returncode == 0, run.stderr
    result = json.loads(run.stdout)
    assert result["stage_torques"]["P4"]["output"] == pytest.approx(1447.4, abs=0.1)
    assert epicyclic("report", "r.nc", "-o", "r.html").stdout == "Wrote r.html.\n"
    page = (folder / "r.html").read_text(encoding="utf-8")
    assert "Power losses of a train of gear sets" in page
    assert "state R, input to output, 2000 rpm, 300 N·m" in page
    listed = epicyclic("plot", "r.nc").stdout.splitlines()
    assert [line.split()[0] for line in listed] == ["losses", "loss-sum", "power-flow"]
    drawn = epicyclic("plot", "r.nc", "power-flow", "-o", "flow.svg")
    assert (drawn.returncode, drawn.stdout) == (0, "Wrote flow.svg.\n")
    assert "output + P3.carrier" in (folder / "flow.svg").read_text(encoding="utf-8")


def test_the_states_of_a_gearbox_are_listed(epicyclic):
    done = epicyclic("check", "train-8hp70")
    assert done.returncode == 0
    assert "4.6957" in done.stdout
    assert "-3.2968" in done.stdout


@pytest.mark.parametrize(
    "command",
    [
        ("mesh",),
        ("pockets",),
        ("friction", "--plot", "f.png"),
        ("strength", "--rotor-dynamics", "r.csv"),
    ],
)
def test_given_efficiencies_end_in_one_clear_error(epicyclic, command):
    done = epicyclic(command[0], "train-8hp70", *command[1:])
    assert done.returncode == 2
    assert "1 problem in train-8hp70:" in done.stderr
    assert "given efficiencies only" in done.stderr


@pytest.mark.parametrize(("command", "verb"), [("friction", "compare"), ("strength", "rate")])
def test_sets_of_given_efficiencies_are_named_in_one_line(epicyclic, command, verb):
    done = epicyclic(command, "train-8hp70")
    line = f"Sets with a given efficiency, without teeth to {verb}: P1, P2, P3, P4."
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, line, "")


def test_the_strength_of_given_efficiencies_is_empty_in_json(epicyclic):
    done = epicyclic("strength", "train-8hp70", "--json", "-")
    assert done.returncode == 0
    assert json.loads(done.stdout) == {"least": {}, "meshes": {}, "bearings": {}, "parts": []}


@pytest.mark.slow
def test_meshes_of_a_train_are_drawn_one_by_one(epicyclic, tmp_path):
    done = epicyclic("mesh", "train-eaxle", *SMALL, "--plot", "m.png")
    assert done.returncode == 0, done.stderr
    assert "planets: sun mesh of Two-stage e-axle" in done.stdout
    names = {path.name for path in (tmp_path / "elsewhere").iterdir()}
    assert names == {"m-pair.mesh.png", "m-planets.sun_mesh.png", "m-planets.ring_mesh.png"}
