"""``epicyclic contact`` as a user meets it."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from epicyclic.errors import InputError
from epicyclic.plugins.contact_solver.contact import ContactCase, contact_model, load_contact_case
from epicyclic.schema.validation import tables_of

SMOOTH = (
    "contact", "--radius", "10 mm", "--pressure", "1 GPa", "--speed", "10 m/s", "--slip", "0.2",
    "--oil", "atf-talbot-2012", "--temperature", "90 degC",
)  # fmt: skip

FILE = """\
title = "Sun and planet"

[contact]
radius = "8 mm"
line_load = "300 N/mm"
rolling_speed = "8 m/s"
slide_to_roll_ratio = 0.1

[lubricant]
oil = "iso-vg-100-mineral"
temperature = "80 degC"
pressure_law = "two-slope"
second_slope = "8 1/GPa"
transition_pressure = "0.4 GPa"

[surface1]
roughness = "0.1 um"
"""


def test_contact_by_options_prints_films_and_friction(epicyclic):
    done = epicyclic(*SMOOTH)
    assert done.returncode == 0, done.stderr
    for words in ("central film", "minimum film", "friction coefficient", "rolling loss", "Conv"):
        assert words in done.stdout, words


@pytest.mark.slow
def test_contact_by_file_gives_json_and_a_figure(epicyclic, tmp_path):
    file, figure = tmp_path / "contact.toml", tmp_path / "contact.png"
    file.write_text(FILE, encoding="utf-8")
    done = epicyclic("contact", str(file), "--json", "-", "--plot", str(figure))
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    assert result["status"] == "converged"
    assert result["rough"]["time_steps"] > 0
    assert result["figures"]["line load"]["value"] == pytest.approx(3e5)
    assert 0 < result["figures"]["friction coefficient"]["value"] < 0.1
    assert figure.read_bytes()[:4] == b"\x89PNG"


@pytest.mark.slow
def test_rough_contact_moves_in_a_gif(epicyclic, tmp_path):
    figure = tmp_path / "contact.gif"
    done = epicyclic(
        *SMOOTH, "--roughness1", "0.02 um", "--set", "numerics.nodes=128", "--plot", str(figure)
    )
    assert done.returncode == 0, done.stderr
    content = figure.read_bytes()
    assert content[:6] == b"GIF89a"
    assert content.count(b"\x21\xf9\x04") > 10  # one graphic control block a frame


def test_every_mistake_is_named(epicyclic):
    done = epicyclic(
        "contact", "--radius", "10", "--pressure", "1 GPa", "--load", "5 N/mm", "--slip", "3",
        "--oil", "atf-talbt", "--set", "lubricant.pressure_law=two-slope",
    )  # fmt: skip
    assert done.returncode == 2
    for words in (
        "contact.radius = 10: has no unit",
        "contact.rolling_speed: is missing",
        "contact.slide_to_roll_ratio = 3",
        "line_load",
        "Did you mean 'atf-talbot-2012'?",
        "lubricant.temperature: is missing",
    ):
        assert words in done.stderr, words


def test_laws_and_filters_that_lack_a_key_are_named(epicyclic):
    done = epicyclic(
        *SMOOTH, "--set", "lubricant.shear_law=carreau", "--set", "surface1.cutoff=0.8 mm"
    )
    assert done.returncode == 2
    for key in ("shear_stress", "shear_exponent", "surface1.cutoff"):
        assert key in done.stderr


def test_profiles_are_looked_for_beside_the_file(tmp_path):
    (tmp_path / "contact.toml").write_text(FILE + 'profile = "one.csv"\n', encoding="utf-8")
    with pytest.raises(
        InputError, match=r"surface1\.profile = .*one\.csv: the file cannot be read"
    ):
        load_contact_case(tmp_path / "contact.toml")
    heights = "".join(f"{0.001 * n:.3f}, {n % 3}\n" for n in range(50))
    (tmp_path / "one.csv").write_text(heights, encoding="utf-8")
    case = load_contact_case(tmp_path / "contact.toml")
    assert contact_model(case).surfaces[0].rms == pytest.approx(0.1e-6)


def test_problems_of_both_surfaces_are_told_with_their_keys(epicyclic):
    done = epicyclic(
        *SMOOTH, "--set", "surface1.profile=none.csv", "--roughness2", "0.1 um",
        "--set", "surface2.kurtosis=1.01", "--set", "surface2.skewness=1",
    )  # fmt: skip
    assert done.returncode == 2
    assert "surface1.profile = none.csv: the file cannot be read" in done.stderr
    assert "surface2.kurtosis = 1.01: cannot be less" in done.stderr


def test_the_how_to_shows_every_key():
    page = Path(__file__).parents[2] / "docs" / "how-to" / "line-contact.md"
    tables = re.split(r"^\[(\w+)\]$", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    shown = {
        name: set(re.findall(r"^(?:# )?(\w+) = ", text, flags=re.MULTILINE))
        for name, text in zip(tables[1::2], tables[2::2], strict=True)
    }
    shown["contact"].add("hertz_pressure")  # in the comment beside line_load
    both = shown["surface1"] | shown["surface2"]
    shown |= {"surface1": both, "surface2": both}
    keys = {name: set(table.model_fields) for name, table in tables_of(ContactCase).items()}
    assert shown == keys


def test_keys_without_effect_are_refused(epicyclic, tmp_path):
    (tmp_path / "p.csv").write_text("".join(f"{n}, {n % 3}\n" for n in range(50)))
    changes = {
        "lubricant.pressure_law": "barus",
        "lubricant.second_slope": "8 1/GPa",
        "lubricant.slope_ratio": "0.37",
        "lubricant.shear_stress": "1 MPa",
        "surface1.skewness": "1",
        "surface2.profile": str(tmp_path / "p.csv"),
        "surface2.correlation_length": "5 um",
    }
    done = epicyclic(*SMOOTH, *(f"--set={key}={value}" for key, value in changes.items()))
    assert done.returncode == 2
    assert done.stderr.startswith("5 problems")
    for told in (
        "second_slope: applies to two-slope only",
        "slope_ratio: applies to two-slope only",
        "shear_stress: applies to limiting-stress and carreau only",
        "surface1.skewness: has no effect on a smooth surface",
        "surface2.correlation_length: applies to a generated profile",
    ):
        assert told in done.stderr


def test_two_generated_surfaces_are_not_the_same():
    tables = {
        "contact": {"radius": "10 mm", "line_load": "300 N/mm", "rolling_speed": "8 m/s"},
        "lubricant": {"oil": "iso-vg-100-mineral", "temperature": "80 degC"},
    }
    rough = {f"surface{number}": {"roughness": "0.1 um"} for number in (1, 2)}
    one, two = contact_model(load_contact_case(tables | rough)).surfaces
    correlation = np.mean(one.heights * two.heights) / (one.rms * two.rms)
    assert abs(correlation) < 0.3  # 200 correlation lengths, scatter some 0.06


def test_a_bare_command_tells_every_missing_key(epicyclic):
    done = epicyclic("contact")
    assert done.returncode == 2
    for key in ("contact.radius", "contact.line_load", "contact.rolling_speed", "lubricant.oil"):
        assert f"{key}: is missing" in done.stderr


def test_a_contact_without_solution_ends_with_3(epicyclic):
    done = epicyclic(
        "contact", "--radius", "10 mm", "--pressure", "80 GPa", "--speed", "1 m/s",
        "--oil", "iso-vg-680-mineral", "--temperature", "40 degC", "--json", "-",
        "--set", "lubricant.pressure_law=barus",
    )  # fmt: skip
    assert done.returncode == 3
    result = json.loads(done.stdout)
    assert result["status"] == "failed"
    assert "smooth" not in result
    assert "no convergence" in result["message"]


def test_unwritable_figures_are_refused(epicyclic, tmp_path):
    done = epicyclic(*SMOOTH, "--plot", str(tmp_path / "contact.nothing"))
    assert done.returncode == 2
    assert "--plot" in done.stderr
