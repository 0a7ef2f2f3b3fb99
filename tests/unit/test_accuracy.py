"""Allowances of DIN 3967 and tolerances of ISO 1328-1 by name."""

from __future__ import annotations

import io

import numpy as np
import pytest
from rich.console import Console

import epicyclic as ep
from epicyclic.gears import measures as accuracy
from epicyclic.gears.measures import fit_allowances, flank_tolerances, named_fit
from epicyclic.show.data_sheet import data_sheet
from epicyclic.study.bands.inputs import uncertain_values

PAIR = {
    "kind": "gear_pair",
    "operation": {"torque": "120 N*m", "speed": "1700 rpm", "oil_inlet_temperature": "63 degC"},
    "gears": {
        "normal_module": "3 mm",
        "normal_pressure_angle": "20 deg",
        "helix_angle": "11 deg",
        "center_distance": "92 mm",
    },
    "pinion": {
        "teeth": 23,
        "face_width": "31 mm",
        "profile_shift_coefficient": 0.21,
        "roughness": "0.4 um",
    },
    "gear": {"teeth": 37, "face_width": "29 mm", "roughness": "0.5 um"},
    "lubricant": {"oil": "iso-vg-100-mineral"},
}


def pair(changes):
    return ep.load_case(PAIR).updated(changes)


@pytest.mark.parametrize(
    ("fit", "diameter", "upper", "lower"),
    [
        # the example of DIN 3967, 3.4
        ("27cd", 100.0, -70, -170),
        # rows and columns at the corners of both tables, and both sides of a limit
        ("21a", 9.0, -100, -103),
        ("30h", 9.0, 0, -200),
        ("25c", 50.0, -65, -95),
        ("25c", 50.01, -85, -125),
        ("24e", 300.0, -75, -115),
        ("30a", 10_000.0, -2000, -4400),
        ("21g", 9_000.0, -100, -140),
    ],
)
def test_printed_allowances(fit, diameter, upper, lower):
    found = fit_allowances(fit, diameter * 1e-3)
    assert np.array(found) * 1e6 == pytest.approx([upper, lower])


def test_tables_rise_in_every_row_and_column():
    for table, along in ((accuracy._UPPER, -1), (accuracy._WIDTHS, 1)):
        values = np.array(table)
        assert (along * np.diff(values, axis=1) > 0).all()
        grows = np.diff(values, axis=0)
        assert (grows[:, :-1] > 0).all()
        assert values.shape[0] == len(accuracy._DIAMETERS)


@pytest.mark.parametrize(
    ("name", "fit"),
    [("27cd", "27cd"), ("CD 27", "27cd"), ("c25", "25c"), ("20c", None), ("31a", None),
     ("25x", None), ("25", None), ("", None)],
)  # fmt: skip
def test_names_of_series(name, fit):
    assert named_fit(name) == fit


def test_a_fit_is_the_same_as_its_allowances():
    named = pair({"pinion.tooth_thickness_fit": "cd26", "gear.tooth_thickness_fit": "24b"})
    stated = pair(
        {
            "pinion.tooth_thickness_allowance": ["-70 um", "-130 um"],
            "gear.tooth_thickness_allowance": ["-125 um", "-150 um"],
        }
    )
    one, two = (ep.solve(case) for case in (named, stated))
    assert one.losses == two.losses
    backlash = one.meshes["mesh"].backlash
    wanted = (100 + 137.5) * 1e-6 / np.cos(np.radians(11))
    assert backlash == pytest.approx(wanted, rel=0.03)  # at the pitch circles, not the reference


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"pinion.tooth_thickness_fit": "31a"}, "not a series of DIN 3967"),
        ({"pinion.tooth_thickness_fit": 27}, "not a series of DIN 3967"),
        (
            {
                "pinion.tooth_thickness_fit": "25c",
                "pinion.tooth_thickness_allowance": ["-1 um", "-2 um"],
            },
            "conflicts",
        ),
        ({"pinion.accuracy_class": 12}, "<= 11"),
        (
            {
                "gears.normal_module": "300 mm",
                "gears.center_distance": "9200 mm",
                "gear.tooth_thickness_fit": "25c",
                "pinion.face_width": "3 m",
            },
            "up to 10000 mm",
        ),
    ],
)
def test_what_is_no_class_or_series(changes, words):
    with pytest.raises(ep.InputError, match=words):
        pair(changes)


def test_tolerances_by_class():
    # worked by hand from the formulae: m_n = 4 mm, d = 100 mm, b = 25 mm, class 5
    found = flank_tolerances(5, 4e-3, 0.1, 25e-3)
    by_hand = [6.7, 5.7, 7.2, 6.25, 6.95]
    values = [
        found.single_pitch,
        found.profile_slope,
        found.profile_form,
        found.helix_slope,
        found.helix_form,
    ]
    assert np.array(values) * 1e6 == pytest.approx(by_hand)
    coarser = flank_tolerances(9, 4e-3, 0.1, 25e-3)
    assert coarser.helix == pytest.approx(4 * found.helix)
    assert found.profile == pytest.approx(np.hypot(5.7, 7.2) * 1e-6)


def test_the_data_sheet_shows_both():
    case = pair({"pinion.tooth_thickness_fit": "26cd", "gear.accuracy_class": 6})
    console = Console(width=80, file=io.StringIO())
    console.print(data_sheet(case))
    text = console.file.getvalue()
    rows = {line.strip()[:20].strip(): line.split() for line in text.splitlines()}
    assert rows["allowance A_sne"][-3:] == ["-70.0", "-", "µm"]
    assert rows["allowance A_sni"][-3:] == ["-130.0", "-", "µm"]
    helix = flank_tolerances(6, 3e-3, 37 * 3e-3 / np.cos(np.radians(11)), 29e-3).helix
    assert rows["total helix F_betaT"][-3:] == ["-", f"{helix * 1e6:.1f}", "µm"]
    console = Console(width=80, file=io.StringIO())
    console.print(data_sheet(pair({})))
    assert "A_sne" not in console.file.getvalue()
    assert "F_betaT" not in console.file.getvalue()


def slopes(case):
    values, problems = uncertain_values(case)
    assert not problems
    return {it.key: it for it in values if it.key.endswith("_slope")}


def test_slopes_are_uncertain_by_the_class():
    changes = {
        "pinion.accuracy_class": 7,
        "pinion.micro_geometry.lead_slope": "3 um",
        "models.load_distribution": "compliance",
    }
    found = slopes(pair(changes))
    assert set(found) == {"pinion.micro_geometry.lead_slope", "pinion.micro_geometry.profile_slope"}
    limits = flank_tolerances(7, 3e-3, 23 * 3e-3 / np.cos(np.radians(11)), 31e-3)
    lead = found["pinion.micro_geometry.lead_slope"]
    assert lead.spread == pytest.approx(
        (3 - 1e6 * limits.helix_slope, 3 + 1e6 * limits.helix_slope)
    )
    profile = found["pinion.micro_geometry.profile_slope"]
    assert profile.spread[1] == pytest.approx(1e6 * limits.profile_slope)
    assert slopes(pair(changes | {"models.load_distribution": "uniform"})) == {}
    own = {"uncertainty": {"pinion.micro_geometry.lead_slope": {"exact": True}}}
    assert set(slopes(pair(changes | own))) == {"pinion.micro_geometry.profile_slope"}


def test_slopes_of_planets_and_of_sets_of_trains():
    case = ep.load_case("talbot-2012").updated(
        {"planet.accuracy_class": 5, "models.load_distribution": "compliance"}
    )
    assert set(slopes(case)) == {
        f"planet.micro_geometry.{which}_slope" for which in ("lead", "profile")
    }
    sided = case.updated({"planet.micro_geometry_ring_side.lead_crown": "2 um"})
    assert len(slopes(sided)) == 4
    train = ep.load_case("train-eaxle")
    name = next(name for name, table in train.sets.items() if hasattr(table, "pinion"))
    changed = train.updated(
        {
            f"sets.{name}.gear.accuracy_class": 6,
            f"sets.{name}.models.load_distribution": "compliance",
        }
    )
    assert set(slopes(changed)) == {
        f"sets.{name}.gear.micro_geometry.{which}_slope" for which in ("lead", "profile")
    }
