"""Roughness as Ra or Rz, and basic rack profiles by name."""

import math

import pytest
from test_gear_sizes import X, changed

from epicyclic import load_case
from problems import only, problems_of


@pytest.mark.parametrize(
    ("text", "rq"),
    [
        ("Rq 0.35 um", 0.35e-6),
        ("Ra 0.4 um", 0.4e-6 / math.sqrt(2 / math.pi)),
        ("Rz 3.1um", 3.1e-6 / 6 / math.sqrt(2 / math.pi)),
        ("ra0.32 um", 0.32e-6 / math.sqrt(2 / math.pi)),
        ("RZ = 2.9 um", 2.9e-6 / 6 / math.sqrt(2 / math.pi)),
    ],
)
def test_roughness_by_its_parameter(text, rq):
    case = load_case(changed(sun={"roughness": text}))
    assert case.sun.roughness == pytest.approx(rq, rel=1e-12)
    told = [one for one in case.found if one.key == "sun.roughness"]
    assert bool(told) is not text.startswith("Rq")


def test_the_conversion_is_shown_with_its_band():
    (told,) = load_case(changed(ring={"roughness": "Rz 3 um"})).found
    assert told.value == "0.6267 um"
    for words in ("Rz = 6 Ra (DIN 3991)", "4 to 7", "0.537 to 0.94 um"):
        assert words in told.how


@pytest.mark.parametrize("text", ["Ra", "Rz 3", "Rt 3 um", "Ra 3 N", "Rz 900 um", "Ra -1 um"])
def test_roughness_that_cannot_be_read(text):
    assert only(problems_of(load_case, changed(sun={"roughness": text}))).key == "sun.roughness"


@pytest.mark.parametrize(
    ("text", "words"),
    [("Ra0.4", 'Write "Ra 0.4 um".'), ("Rz 3", 'Write "Rz 3 um".'), ("Ra 90 um", "to 79 um")],
)
def test_remedies_for_roughness_keep_its_parameter(text, words):
    tables = changed(sun={"roughness": text})
    assert words in only(problems_of(load_case, tables)).remedy


@pytest.mark.parametrize(
    ("name", "dedendum", "rounding"),
    [("a", 1.25, 0.38), ("b", 1.25, 0.30), ("c", 1.25, 0.25), ("d", 1.40, 0.39)],
)
def test_profiles_of_iso_53(name, dedendum, rounding):
    case = load_case(
        changed(
            gears={"basic_rack": f"iso-53-{name}"},
            planet={"tool_tip_radius": "0.2 mm"},
            sun={X: None},
        )
    )
    plain = load_case(
        changed(
            gears={"dedendum_coefficient": dedendum},
            planet={"tool_tip_radius": "0.2 mm"},
            sun={X: None, "tool_tip_radius": f"{rounding * 1.25} mm"},
        )
    )
    assert case.sun.tool_tip_radius == pytest.approx(plain.sun.tool_tip_radius)
    assert case.ring == plain.ring
    assert case.planet == plain.planet
    roots = [one.gearings[""].gear("sun").root_radius for one in (case, plain)]
    assert roots[0] == pytest.approx(roots[1])
    assert case.found[0].key == "gears.basic_rack"
    assert load_case(case.inputs()) == case


def test_a_profile_contradicts_its_coefficients():
    tables = changed(gears={"basic_rack": "iso-53-d", "dedendum_coefficient": 1.3})
    problem = only(problems_of(load_case, tables))
    assert problem.key == "gears.dedendum_coefficient"
    assert "conflicts with basic_rack" in problem.allowed
