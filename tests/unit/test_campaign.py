"""What a campaign simulates: designs, seeds, and input that cannot be used."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from epicyclic.errors import InputError
from epicyclic.plugins.contact_solver.campaign import (
    BEARING_TABLE,
    GEAR_TABLE,
    CampaignFolder,
    make_campaign,
    open_folder,
    parse_ranges,
)
from epicyclic.study.sweeps.runner import fingerprint

ATF = "atf-talbot-2012"
CHANGES = {
    "settings lubricant eyring_stress": ([], "5 MPb", "9" * 400),
    "settings lubricant oil density": ({}, "870 kg/m^3", 870),
    "settings surface1 colour": ("red",),
    "designs 0 axes radius": ({}, [], [True, 5.0], [5.0, 1e300], ["5 mm"], [float("nan")]),
    "designs 0 axes hertz_pressure": ([0.5, [1.0]], [1.0] * 1_000_000),
    "designs 0 size": (0, -3, 8.5, 10**9, True, "8"),
    "designs 0 seed": ("1", None, 1.5),
    "designs 0": (None, []),
}


def test_tables_have_the_published_numbers_of_contacts():
    # Talbot (2012), pp. 135 and 62
    assert GEAR_TABLE.count == 33600
    assert BEARING_TABLE.count == 2880
    assert make_campaign(ATF).size == 36480
    points = {tuple(BEARING_TABLE.point(index).values()) for index in range(BEARING_TABLE.count)}
    assert len(points) == 2880


def test_a_design_fills_its_ranges_evenly():
    design = GEAR_TABLE.filling(256, 3)
    points = [design.point(index) for index in range(256)]
    for name, levels in GEAR_TABLE.axes:
        values = np.array([point[name] for point in points])
        low, high = min(levels), max(levels)
        assert low <= values.min() <= values.max() <= high
        if name in ("temperature", "hertz_pressure"):
            share = (values - low) / (high - low)
        else:
            share = np.log(values / low) / np.log(high / low)
        # a Sobol sequence of 2^8 points has one in each of 256 slices of every axis
        assert np.array_equal(np.sort(np.floor(256 * share)), np.arange(256))
    assert GEAR_TABLE.filling(256, 4).point(0) != design.point(0)


def test_every_point_is_a_contact_of_its_conditions_with_profiles_of_its_own():
    campaign = make_campaign(ATF, size=8, bearing_size=4, seed=2)
    assert campaign.size == 12
    assert [campaign.part(index) for index in (0, 7, 8, 11)] == ["gear"] * 2 + ["bearing"] * 2
    seeds = set()
    for index in range(12):
        case, point = campaign.case(index), campaign.point(index)
        assert case.contact.radius == pytest.approx(point["radius"] * 1e-3, rel=1e-12)
        assert case.contact.hertz_pressure == pytest.approx(point["hertz_pressure"] * 1e9)
        assert case.lubricant.temperature == pytest.approx(point["temperature"] + 273.15)
        assert case.surface2.roughness == pytest.approx(point["roughness2"] * 1e-6, rel=1e-12)
        assert case.contact.slide_to_roll_ratio == point["slide_to_roll_ratio"]
        seeds |= {case.surface1.seed, case.surface2.seed}
    assert len(seeds) == 24
    assert campaign.case(9).contact.slide_to_roll_ratio == 0.0
    again = make_campaign(ATF, size=8, bearing_size=4, seed=2)
    assert again == campaign
    assert again.case(5) == campaign.case(5)


def test_settings_hold_for_every_point_and_tell_campaigns_apart():
    one = make_campaign(ATF, size=4)
    other = make_campaign(ATF, size=4, changes={"lubricant.eyring_stress": "8 MPa"})
    assert other.case(3).lubricant.eyring_stress == pytest.approx(8e6)
    prints = {
        fingerprint(campaign)
        for campaign in (
            one,
            other,
            make_campaign(ATF, size=4, seed=1),
            make_campaign(ATF, size=5),
            make_campaign("iso-vg-100-mineral", size=4),
        )
    }
    assert len(prints) == 5


OIL = """
kind = "mineral"
pressure_viscosity = { law = "gold", s = 9.904, t = 0.139 }
kinematic_viscosity = [
    { temperature = "40 degC", value = "46 mm^2/s" },
    { temperature = "100 degC", value = "7.8 mm^2/s" },
]
density = [{ temperature = "15 degC", value = "870 kg/m^3" }]
"""


def test_an_oil_comes_from_a_file(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text(OIL)
    oil = make_campaign(file, size=4).case(0).lubricant.oil
    assert oil.name == "own"
    assert oil.kinematic_viscosity[0].value == pytest.approx(46e-6)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (OIL.replace('pressure_viscosity = { law = "gold", s = 9.904, t = 0.139 }', ""),
         "pressure_viscosity"),
        (OIL.replace("46 mm^2/s", "46"), "kinematic_viscosity"),
        ("kind = mineral", "not TOML"),
    ],
    ids=["no pressure data", "no unit", "no TOML"],
)  # fmt: skip
def test_an_oil_that_cannot_be_used_is_refused(tmp_path, text, told):
    file = tmp_path / "own.toml"
    file.write_text(text)
    with pytest.raises(InputError, match=told) as error:
        make_campaign(file, size=4)
    assert error.value.source == str(file)


def test_keys_that_differ_from_contact_to_contact_are_refused():
    changes = {
        "contact.radius": "4 mm",
        "surface2.seed": 3,
        "surface1.profile": "measured.csv",
        "lubricant.eyring_stress": "8 MPa",
    }
    with pytest.raises(InputError) as error:
        make_campaign(ATF, size=4, changes=changes)
    assert {problem.key for problem in error.value.problems} == set(list(changes)[:3])


@pytest.mark.parametrize(
    ("oil", "given", "told"),
    [
        ("atf-talbot", {}, "Did you mean"),
        (ATF, {"ranges": {"hertz_pressure": (1.0, 4.0)}}, "tested range"),
        (ATF, {"ranges": {"rolling_speed": (0.01, 4.0)}}, "tested range"),
        (ATF, {"ranges": {"roughness1": (0.1, 1.6)}}, "up to 1.75 um together"),
        (ATF, {"ranges": {"slide_to_roll_ratio": (0.0, 1.0)}}, "above zero"),
        (ATF, {"changes": {"lubricant.eyring": "8 MPa"}}, "not a known key"),
    ],
)
def test_what_cannot_be_simulated_is_refused(oil, given, told):
    with pytest.raises(InputError, match=told):
        make_campaign(oil, size=4, **given)


def test_ranges_without_effect_are_refused():
    with pytest.raises(InputError, match="hertz_presure: is not an axis"):
        make_campaign(ATF, size=4, ranges={"hertz_presure": (1.0, 2.0)})
    with pytest.raises(InputError, match="Give a size"):
        make_campaign(ATF, ranges={"hertz_pressure": (1.0, 2.0)})


def test_ranges_are_read_in_any_unit_and_all_mistakes_told():
    assert parse_ranges(["hertz_pressure = 500:1500 MPa", "slide_to_roll_ratio=0:1"]) == {
        "hertz_pressure": pytest.approx((0.5, 1.5)),
        "slide_to_roll_ratio": (0.0, 1.0),
    }
    with pytest.raises(InputError) as caught:
        parse_ranges(["pressure=1:2 GPa", "radius=5:x mm", "radius=9:5 mm", "radius"])
    assert len(caught.value.problems) == 4


def test_a_table_without_any_solution_says_so(tmp_path):
    folder = CampaignFolder(tmp_path, make_campaign(ATF, size=2))
    folder.table.write_text("number,part,status,message\n0,gear,failed,x\n1,gear,failed,x\n")
    with pytest.raises(InputError, match="no simulation with a solution"):
        folder.read()


@pytest.mark.parametrize("place", CHANGES)
def test_a_plan_of_what_cannot_be_simulated_is_refused_when_it_is_opened(tmp_path, place):
    CampaignFolder(tmp_path, make_campaign(ATF, size=8)).prepare()
    file = tmp_path / "campaign.json"
    sound = file.read_text()
    assert open_folder(tmp_path).campaign.size == 8
    *path, last = (int(it) if it.isdigit() else it for it in place.split())
    for value in CHANGES[place]:
        plan = table = json.loads(sound)
        for key in path:
            table = table[key]
        table[last] = value
        file.write_text(json.dumps(plan))
        with pytest.raises(InputError):
            open_folder(tmp_path)


def test_a_folder_keeps_one_campaign(tmp_path):
    campaign = make_campaign(ATF, size=4)
    folder = CampaignFolder(tmp_path / "atf", campaign)
    folder.prepare()
    folder.prepare()
    assert open_folder(tmp_path / "atf").campaign == campaign
    older = CampaignFolder(tmp_path / "older", replace(campaign, version="0.0.1"))
    older.prepare()
    assert open_folder(tmp_path / "older").campaign.version == "0.0.1"
    with pytest.raises(InputError, match="a different campaign"):
        CampaignFolder(tmp_path / "older", campaign).prepare()
    with pytest.raises(InputError, match="a different campaign"):
        CampaignFolder(tmp_path / "atf", make_campaign(ATF, size=5)).prepare()
    with pytest.raises(InputError, match="cannot be read"):
        open_folder(tmp_path)
    (tmp_path / "atf" / "campaign.json").write_text("{}")
    with pytest.raises(InputError, match="not a plan of a campaign"):
        open_folder(tmp_path / "atf")
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="cannot hold a folder"):
        CampaignFolder(tmp_path / "file", campaign).prepare()
