"""Oils by their grade and kind, or by two viscosities."""

import jsonschema
import pytest
from test_gear_sizes import SET

from epicyclic import load_case, solve
from epicyclic.case.case import case_schema
from epicyclic.contact.fitted_models import builtin_model
from epicyclic.oil.oil import oil_state
from problems import only, problems_of

VG_46 = [
    {"temperature": "40 degC", "value": "46 mm^2/s"},
    {"temperature": "100 degC", "value": "7.8 mm^2/s"},
]


def with_oil(oil):
    return SET | {"lubricant": {"oil": oil}}


@pytest.mark.parametrize(("grade", "kind"), [(46, "mineral"), (320, "pao")])
def test_a_grade_is_the_built_in_oil_with_its_models(grade, kind):
    case = load_case(with_oil({"iso_vg": grade, "kind": kind}))
    named = load_case(with_oil(f"iso-vg-{grade}-{kind}"))
    assert case.lubricant == named.lubricant
    assert (builtin_model(case.lubricant.oil) is None) == (grade == 46)
    (told,) = case.found
    assert told.value == f"iso-vg-{grade}-{kind}"


def test_two_viscosities_with_gold_by_the_kind():
    oil = {"kind": "pag", "viscosity_40": "222 mm^2/s", "viscosity_100": "41.3 mm^2/s"}
    case = load_case(with_oil(oil))
    state = oil_state(case.lubricant.oil, 313.15)
    assert state.kinematic_viscosity == pytest.approx(222e-6, rel=1e-9)
    assert state.pressure_viscosity == pytest.approx(5.489e-9 * 222**0.1485, rel=1e-9)
    assert state.density == pytest.approx(1050 - 0.65 * 25)
    (told,) = case.found
    assert "Gold's constants for polyglycol, not measured" in told.how
    assert "an estimate" in told.how
    assert "not measured" in case.lubricant.oil.pressure_viscosity.source
    assert load_case(case.inputs()) == case
    assert any("Gold's constants" in note for note in solve(case).warnings)


def test_what_is_stated_takes_the_place_of_what_is_typical():
    oil = {
        "kind": "ester",
        "iso_vg": 5,
        "viscosity_100": "1.7 mm^2/s",
        "density_15": "917 kg/m^3",
        "pressure_viscosity": {"law": "gold", "s": 8.1, "t": 0.12},
    }
    case = load_case(with_oil(oil))
    assert case.lubricant.oil.kinematic_viscosity[0].value == pytest.approx(4.6e-6)
    assert case.lubricant.oil.density[0].value == pytest.approx(917)
    assert case.lubricant.oil.pressure_viscosity.s == 8.1
    assert case.found[0].how == "all stated."
    own = load_case(with_oil({"iso_vg": 46, "kind": "mineral", "viscosity_100": "7.3 mm^2/s"}))
    assert own.lubricant.oil.kinematic_viscosity[1].value == pytest.approx(7.3e-6)


def test_points_of_viscosity_beside_a_density_at_15_degrees():
    oil = {"kind": "ester", "density_15": "921 kg/m^3", "kinematic_viscosity": VG_46}
    found = load_case(with_oil(oil)).lubricant.oil
    assert found.kinematic_viscosity[1].value == pytest.approx(7.8e-6)
    assert found.density[0].value == pytest.approx(921)


@pytest.mark.parametrize(
    ("oil", "key", "words"),
    [
        ({"iso_vg": 99, "kind": "pao"}, "lubricant.oil", "no viscosity grade of ISO 3448"),
        ({"iso_vg": "46", "kind": "pao"}, "lubricant.oil", "no viscosity grade of ISO 3448"),
        ({"iso_vg": 220, "kind": "pag"}, "lubricant.oil", "at 100 °C"),
        ({"viscosity_100": "9 mm^2/s", "kind": "pag"}, "lubricant.oil", "at 40 °C"),
        ({"iso_vg": 46, "viscosity_40": "40 mm^2/s", "kind": "pao"}, "lubricant.oil", "the same"),
        ({"iso_vg": 46, "viscosity_100": "9 mm^2/s"}, "lubricant.oil.kind", "is missing"),
        ({"iso_vg": 220}, "lubricant.oil.kind", "is missing"),
        ({"iso_vg": 150, "kind": "minerals"}, "lubricant.oil.kind", '"mineral"'),
        (
            {"kind": "pao", "iso_vg": 100, "kinematic_viscosity": VG_46},
            "lubricant.oil",
            "twice: iso_vg and kinematic_viscosity",
        ),
        (
            {
                "kind": "pao",
                "viscosity_40": "99 mm^2/s",
                "viscosity_100": "11 mm^2/s",
                "density_15": "861 kg/m^3",
                "kinematic_viscosity": VG_46,
                "density": [{"temperature": "20 degC", "value": "870 kg/m^3"}],
            },
            "lubricant.oil",
            "viscosity_100 and kinematic_viscosity, density_15 and density",
        ),
        (
            {"iso_vg": 46, "viscosity_100": "9", "kind": "pag"},
            "lubricant.oil.kinematic_viscosity[1].value",
            "has no unit",
        ),
    ],
)
def test_oils_that_a_short_table_does_not_tell(oil, key, words):
    problem = only(problems_of(load_case, with_oil(oil)))
    assert problem.key == key
    assert words in problem.allowed


@pytest.mark.slow
def test_the_schema_knows_the_short_form():
    tables = with_oil({"iso_vg": 46, "kind": "mineral"})
    tables["ring"] = tables["ring"] | {"teeth": -85}
    tables["sun"] = tables["sun"] | {"roughness": "Rz 3 um"}
    jsonschema.validate(tables, case_schema())
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(with_oil({"iso_vg": 46, "kind": "water"}), case_schema())
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(tables | {"ring": tables["ring"] | {"teeth": -3}}, case_schema())
