"""What is built in: every entry can be used, and says where its values come from."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import pytest

from epicyclic import library
from epicyclic.case.case import read_case
from epicyclic.case.tables.base import Material
from epicyclic.losses.friction import FRICTION_MODELS
from epicyclic.losses.rolling import ROLLING_MODELS
from epicyclic.oil.oil import Oil

TALBOT_WORDS = [[*group["words"]] for group in library.case_variants()["talbot-2012"]]


def test_cases_and_their_variants_are_found():
    names = ("talbot-2012", "talbot-2012-pair", "train-8hp70", "train-eaxle")
    assert library.names("cases") == names
    assert TALBOT_WORDS == [["n3", "n4", "n5", "n6"], ["shaved", "polished"], ["40C", "60C", "90C"]]


@pytest.mark.parametrize("words", [*itertools.product(*TALBOT_WORDS)], ids="-".join)
def test_every_variant_is_a_sound_case(words):
    case = read_case("-".join(["talbot-2012", *words]))
    count, finish, temperature = words
    assert f"n{case.planet.count}" == count
    assert case.planet.roughness == pytest.approx(0.4e-6 if finish == "shaved" else 0.1e-6)
    assert f"{case.operation.oil_inlet_temperature - 273.15:.0f}C" == temperature
    for word in words:
        assert word in case.title


def test_the_order_of_the_words_does_not_matter():
    one, two = read_case("talbot-2012-n6-40C"), read_case("talbot-2012-40C-n6")
    assert one.updated({"title": ""}) == two.updated({"title": ""})


@pytest.mark.parametrize(
    "name",
    ["", "talbot", "talbot-2012-", "talbot-2012-n7", "talbot-2012-n3-n3", "talbot-2012-n3-n6",
     "talbot-2012-pair-n3", "../cases/talbot-2012", "talbot-2012.toml", "TALBOT-2012"],
)  # fmt: skip
def test_other_names_are_no_case(name):
    with pytest.raises(KeyError):
        library.builtin_case(name)


def test_tables_are_handed_out_afresh_or_read_only():
    library.builtin_case("talbot-2012")["sun"]["teeth"] = 1
    assert library.builtin_case("talbot-2012")["sun"]["teeth"] == 73
    library.oil_table("iso-vg-100-pao")["kind"] = "water"
    assert library.oil_table("iso-vg-100-pao")["kind"] == "pao"
    with pytest.raises(TypeError):
        library.named("finishes")["ground"]["roughness"] = "1 um"
    with pytest.raises(TypeError):
        library.named("materials")["steel"] = {}


@pytest.mark.parametrize("name", library.names("oils"))
def test_every_oil_is_sound_and_sourced(name):
    oil = Oil.model_validate(library.oil_table(name), strict=False)
    assert oil.name == name
    assert oil.title
    assert oil.pressure_viscosity.source
    assert all(point.source for point in (*oil.kinematic_viscosity, *oil.density))
    assert read_case("talbot-2012").updated({"lubricant.oil": name}).lubricant.oil == oil


@pytest.mark.parametrize("name", ["", "iso-vg-100", "../finishes", "atf-talbot-2012.toml"])
def test_other_names_are_no_oil(name):
    with pytest.raises(KeyError):
        library.oil_table(name)


CAST, PLASTIC = (90e9, 185e9, 0.25, 0.35, 6800, 8900), (1e9, 4e9, 0.33, 0.42, 1050, 1500)
RANGES = {
    **dict.fromkeys(("nodular-iron", "grey-iron", "CuSn12", "sintered-steel"), CAST),
    **dict.fromkeys(("POM", "PA66"), PLASTIC),
}
"""Modulus [Pa], Poisson's ratio, density [kg/m^3] of other materials than steel."""


@pytest.mark.parametrize("name", library.named("materials"))
def test_every_material_is_sound_and_sourced(name):
    material = Material.model_validate(dict(library.named("materials")[name]))
    assert material.title
    assert material.source
    least, most, low, high, light, heavy = RANGES.get(name, (185e9, 215e9, 0.27, 0.30, 7750, 7900))
    assert least <= material.elastic_modulus <= most
    assert low <= material.poisson_ratio <= high
    assert light <= material.density <= heavy
    case = read_case("talbot-2012").updated({"planet.material": name})
    assert case.planet.material == material


@pytest.mark.parametrize("name", library.named("finishes"))
def test_every_finish_is_sound_and_sourced(name):
    finish = library.named("finishes")[name]
    assert set(finish) == {"title", "roughness", "source"}
    assert finish["source"]
    case = read_case("talbot-2012").updated({"sun.roughness": name})
    assert case.sun.roughness == pytest.approx(float(finish["roughness"].split()[0]) * 1e-6)


def test_finer_processes_leave_finer_flanks():
    rough = [float(finish["roughness"].split()[0]) for finish in library.named("finishes").values()]
    assert max(rough) <= 2.5
    order = ["milled", "hobbed", "ground", "honed", "chemically-polished", "superfinished"]
    values = [float(library.named("finishes")[name]["roughness"].split()[0]) for name in order]
    assert values == sorted(values, reverse=True)


def test_degrees_in_what_users_read_have_their_sign():
    """What a case file states has the unit degC; sources and descriptions are sentences."""
    root = Path(library.__file__).parents[1]
    texts = [*root.glob("library/oils/*.toml"), root / "oil" / "grades.py"]
    lines = [line for path in texts for line in path.read_text(encoding="utf-8").splitlines()]
    told = [
        text for line in lines for text in re.findall(r'source = "(.*?)"|option\("(.*?)"', line)
    ]
    assert told
    assert not [text for text in itertools.chain(*told) if "degC" in text]
    models = [*FRICTION_MODELS.values(), *ROLLING_MODELS.values()]
    assert not [it.source for model in models for it in model.ranges if "degC" in it.source]
