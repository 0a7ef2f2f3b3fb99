"""Temperatures on the command line: heat, and what run says about them."""

from __future__ import annotations

import json
import re

import pytest

CASE = (
    "talbot-2012-pair",
    "--set",
    "operation.torque=100 N*m",
    "--set",
    "operation.speed=2000 rpm",
    "--set",
    "losses.mesh_pocketing.include=false",
)
FLOW = ("--set", "thermal.oil_flow=2.3 l/min")


def test_heat_prints_temperatures_and_where_the_heat_goes(epicyclic):
    done = epicyclic("heat", *CASE, *FLOW)
    assert done.returncode == 0
    assert "models.temperatures = network instead of inlet" in done.stderr
    for words in ("pinion", "above the oil, K", "Where the heat leaves", "flow of oil", "100.0 %"):
        assert words in done.stdout, words
    assert re.search(r"\npinion-jet +\S+ +\S+ +oil from a jet\n", done.stdout)
    assert "Sources of the conductances" in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 100


@pytest.mark.parametrize(
    ("quantity", "key"), [("oil_flow", "thermal.oil_flow"), ("input_power", "operation.torque")]
)
def test_heat_finds_what_leads_to_a_temperature(epicyclic, quantity, key):
    options = ("--solve", quantity, "--target", "96.5 degC")
    done = epicyclic("heat", *CASE, *FLOW, *options)
    assert f"With {key} = " in done.stdout
    assert "the oil is at 96.5 °C." in done.stdout
    assert ("input power" in done.stdout) == (quantity == "input_power")
    result = json.loads(epicyclic("heat", *CASE, *FLOW, *options, "--json", "-").stdout)
    assert result["found"]["key"] == key
    assert result["heat"]["temperatures"]["oil"]["value"] == pytest.approx(96.5, rel=1e-6)
    found = f"{key}={result['found']['value']!r} {result['found']['unit']}"
    given = (found if it.startswith(f"{key}=") else it for it in (*CASE, *FLOW))
    again = json.loads(epicyclic("heat", *given, "--json").stdout)
    assert again["heat"]["temperatures"]["oil"]["value"] == pytest.approx(96.5, rel=1e-6)


def test_heat_draws_the_network(epicyclic, tmp_path):
    picture = tmp_path / "heat.svg"
    done = epicyclic("heat", *CASE, *FLOW, "--plot", str(picture))
    assert f"Wrote {picture}." in done.stdout
    text = picture.read_text()
    for words in ("pinion", "gear", "oil inlet", "90.0 °C", "Heat: oil in the gearbox"):
        assert words in text, words


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--set", "thermal.oil_flow="), "leaves no path out for the heat"),
        ((*FLOW, "--solve", "oil_flow"), "--target: is needed with --solve oil_flow"),
        ((*FLOW, "--target", "90 degC"), "needs a quantity to solve for"),
        ((*FLOW, "--solve", "oil_flow", "--target", "60 degC"), "cannot be reached"),
        ((*FLOW, "--solve", "oil_flow", "--target", "60 W"), "temperature"),
        ((*FLOW, "--solve", "money", "--target", "60 degC"), "money"),
        ((*FLOW, "--plot", "heat.txt"), "must end in .png or .svg or .pdf"),
    ],
)
def test_bad_input_of_heat_is_told(epicyclic, options, words):
    done = epicyclic("heat", *CASE, *options)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr


def test_run_tells_temperatures_and_what_warm_flanks_would_change(epicyclic):
    cold = epicyclic("run", "--details", *CASE).stdout
    assert "With models.temperatures = flank the " in cold
    warm = epicyclic(
        "run", "--details", *CASE, *FLOW, "--set", "models.temperatures=network"
    ).stdout
    assert "Where the heat leaves" in warm
    assert "With models.temperatures" not in warm
    file = json.loads(epicyclic("run", *CASE, "--json").stdout)
    assert "heat" not in file
