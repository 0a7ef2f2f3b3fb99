"""Fitted models that come with an oil: when `auto` takes them, where they end, what is said."""

from __future__ import annotations

import html
import io
import json
import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import epicyclic as ep
from epicyclic import library
from epicyclic.build.models import set_cases, standing_of
from epicyclic.contact.fitted_models import FORMAT, FORMS, OilModel, read_oil_model
from epicyclic.contact.line_contact import contacts_at
from epicyclic.files import sealed, unsealed
from epicyclic.losses.friction import FRICTION_MODELS, SIMULATED
from epicyclic.losses.reliability import RELIABILITY, reliability
from epicyclic.losses.rolling import CONTAINED, REACH, ROLLING_MODELS, weight_of_fit
from epicyclic.plugins.contact_solver.fit import fit_quantity
from epicyclic.schema.read import plain
from epicyclic.show.details import result_tables
from epicyclic.show.result_tables import standing_items
from epicyclic.study.friction import compare_friction, recommended


def set_of(case):
    """The only set of a case."""
    return set_cases(case)[""]


FORMER = {"models.preset": "talbot-2012"}
OIL = "iso-vg-220-mineral"
STEEL = 227.47e9
GEAR = {
    "slide_to_roll_ratio": (0.02, 1.1),
    "rolling_speed": (0.9, 21.0),
    "radius": (4.2e-3, 43e-3),
    "hertz_pressure": (0.31e9, 2.3e9),
    "roughness1": (0.07e-6, 0.8e-6),
    "roughness2": (0.06e-6, 0.9e-6),
    "dynamic_viscosity": (9e-3, 300e-3),
    "pressure_viscosity": (13e-9, 25e-9),
}
BEARING = GEAR | {
    "slide_to_roll_ratio": (0.0, 0.0),
    "radius": (0.4e-3, 4.4e-3),
    "hertz_pressure": (0.12e9, 3.3e9),
    "roughness1": (0.03e-6, 0.3e-6),
    "roughness2": (0.04e-6, 0.35e-6),
}


def contacts(ranges, count=80, seed=5):
    rng = np.random.default_rng(seed)
    shares = [np.concatenate([[0.0, 1.0], rng.random(count - 2)]) for _ in ranges]
    values = {
        name: low + (high - low) * share
        for (name, (low, high)), share in zip(ranges.items(), shares, strict=True)
    }
    return contacts_at(**values, equivalent_modulus=STEEL)


def fit_of(quantity, ranges):
    points = contacts(ranges)
    form = FORMS[quantity]["structured"]
    unit = "1" if quantity == "friction" else "W/m"
    target = form.value(points, np.array(form.start)) * (1 + 0.01 * np.sin(np.arange(80)))
    return fit_quantity(quantity, unit, points, target, np.ones(80))


@pytest.fixture(scope="session")
def model():
    case = ep.load_case("talbot-2012").updated({"lubricant.oil": OIL})
    return OilModel(
        format=FORMAT,
        version="0",
        settings={"lubricant": {"oil": plain(case.lubricant.oil)}},
        designs=(),
        seed=0,
        simulations={"simulated": 160},
        equivalent_modulus=STEEL,
        fits={
            "friction": fit_of("friction", GEAR),
            "rolling_loss": fit_of("rolling_loss", GEAR),
            "bearing_rolling_loss": fit_of("bearing_rolling_loss", BEARING),
        },
    )


@pytest.fixture
def case(model, tmp_path, monkeypatch):
    """A set with an oil for which models are built in."""
    file = tmp_path / f"{OIL}.json"
    file.write_text(model.to_text())
    files = {OIL: file, SIMULATED: library.oil_model_file(SIMULATED)}
    monkeypatch.setattr(library, "oil_model_file", files.get)
    changes = {"lubricant.oil": OIL, "planet.count": 4, "models.preset": "talbot-2012"}
    return ep.load_case("talbot-2012").updated(changes)


def test_auto_takes_the_built_in_models(case):
    models = set_of(case).chosen
    assert models["friction"] == "fitted-or-schlenk"
    assert models["rolling"] == "fitted-or-goksem-hargreaves"
    assert models["bearing"] == "fitted-or-palmgren"
    fitted = case.updated(dict.fromkeys(("models.friction", "models.rolling"), "fitted"))
    inside, held = ep.solve(case), ep.solve(fitted.updated({"models.bearing": "fitted"}))
    for name in ("sun_mesh_sliding", "ring_mesh_rolling"):
        assert inside.losses[name] == pytest.approx(held.losses[name], rel=1e-3)
    for name in ("mixed-ehl", "schlenk"):
        other = ep.solve(case.updated({"models.friction": name}))
        assert inside.losses["sun_mesh_sliding"] != pytest.approx(
            other.losses["sun_mesh_sliding"], rel=0.01
        )


def test_full_complement_bearings_keep_their_own_formula(case):
    changed = case.updated({"planet_bearing.cage": "full-complement"})
    assert set_of(changed).chosen["bearing"] == "palmgren"


def test_an_oil_without_simulations_has_no_built_in_models(case):
    changed = case.updated({"lubricant.oil": "iso-vg-46-pao"})
    assert set_of(changed).chosen["friction"] == "schlenk"
    assert not [note for note in ep.solve(changed).warnings if "are not used" in note]


def test_a_factor_of_the_pressure_viscosity_makes_no_step(case):
    """It is a condition of the contacts: the fits follow it as far as they were simulated."""
    near = case.updated({"lubricant.pressure_viscosity_factor": 1.0001})
    one, two = ep.solve(case), ep.solve(near)
    for name in ("sun_mesh_sliding", "ring_mesh_rolling", "planet_bearing_mechanical"):
        assert two.losses[name] == pytest.approx(one.losses[name], rel=2e-3), name
        assert two.losses[name] != one.losses[name], name


@pytest.mark.parametrize("name", [OIL, "custom"])
def test_an_oil_with_other_properties_has_none(case, name):
    table = library.oil_table(OIL)
    table["name"] = name
    table["kinematic_viscosity"][0]["value"] = "221.5 mm^2/s"
    changed = case.updated({"lubricant.oil": table})
    models = set_of(changed).chosen
    assert (models["friction"], models["rolling"]) == ("schlenk", "contained")
    told = [note for note in ep.solve(changed).warnings if "are not used" in note]
    assert len(told) == (name == OIL)
    assert all("kinematic_viscosity" in note for note in told)


def test_where_a_value_is_from_does_not_matter(case):
    table = library.oil_table(OIL)
    table["kinematic_viscosity"][0]["source"] = "another certificate"
    table["lubricant_factor"] = {"value": 0.93}
    changed = case.updated({"lubricant.oil": table})
    assert set_of(changed).chosen["friction"] == "fitted-or-schlenk"


def test_a_file_of_the_user_comes_before_that_built_in(case, model, tmp_path):
    only = model.model_copy(update={"fits": {"friction": model.fits["friction"]}})
    file = tmp_path / "own.json"
    file.write_text(only.to_text())
    changed = case.updated({"models.oil_model": str(file)})
    models = set_of(changed).chosen
    assert models["friction"] == "fitted-or-schlenk"
    assert models["rolling"] == "goksem-hargreaves"
    assert models["bearing"] == "palmgren"


@pytest.mark.parametrize("key", ["friction", "rolling", "bearing"])
def test_fitted_models_need_a_file_or_one_built_in(case, key):
    assert set_of(case.updated({f"models.{key}": "fitted"})).chosen[key] == "fitted"
    with pytest.raises(ep.InputError) as error:
        case.updated({f"models.{key}": "fitted", "lubricant.oil": "iso-vg-68-pao"})
    assert [problem.key for problem in error.value.problems] == [f"models.{key}"]
    assert "none is built in" in str(error.value)


@pytest.mark.parametrize("name", [name for name in GEAR if name != "slide_to_roll_ratio"])
@pytest.mark.parametrize("end", [0, 1])
def test_weight_falls_to_zero_beyond_each_limit(model, name, end):
    middle = {key: float(np.sqrt(low * high)) for key, (low, high) in GEAR.items()}
    factors = np.array([1.0, REACH ** (1 / 3), REACH ** (2 / 3), REACH, 3 * REACH])
    away = factors if end else 1 / factors
    values = {key: np.full(5, value) for key, value in middle.items()}
    values[name] = model.fits["friction"].domain[name][end] * away
    weight = weight_of_fit(model, "friction", contacts_at(**values, equivalent_modulus=STEEL))
    # 1 - t^2 (3 - 2 t) at thirds of the way
    assert weight == pytest.approx([1.0, 20 / 27, 7 / 27, 0.0, 0.0], abs=1e-9)


def test_slow_sliding_is_not_beyond_the_fit_but_another_material_is(model):
    values = {key: np.array([float(np.sqrt(low * high))]) for key, (low, high) in GEAR.items()}
    values["slide_to_roll_ratio"] = np.zeros(1)
    for factor, expected in ((1.0, 1.0), (1.05, 1.0), (0.5, 0.0)):
        point = contacts_at(**values, equivalent_modulus=factor * STEEL)
        assert weight_of_fit(model, "friction", point) == pytest.approx(expected)


def test_loss_has_no_step_where_the_simulations_end(case):
    """Over speed, through the limit of the rolling speed, up to where the formulas take over."""
    speeds = np.geomspace(110, 900, 30)
    results = [ep.solve(case.updated({"operation.speed": f"{it} rpm"})) for it in speeds]
    friction = np.array([it.meshes["sun_mesh"].friction_mean for it in results])
    same = {"models.friction": "schlenk", "models.rolling": "fitted-or-goksem-hargreaves"}
    slow = case.updated({"operation.speed": "110 rpm"} | same)
    assert friction[0] == pytest.approx(ep.solve(slow).meshes["sun_mesh"].friction_mean)
    assert np.abs(np.diff(np.log(friction))).max() < 0.25
    assert not any(flag.use.role == "friction" for flag in results[-1].flags)


def test_what_is_left_and_what_takes_over_is_said(case, model):
    slow = ep.solve(case.updated({"operation.speed": "110 rpm"}))
    flags = [flag for flag in slow.flags if flag.use.model.startswith("fitted")]
    assert {flag.use.instead for flag in flags} == {"schlenk", "goksem-hargreaves", "palmgren"}
    told = next(text for text in slow.warnings if "rolling speed" in text)
    low, high = model.fits["friction"].domain["rolling_speed"]
    assert f"range {low:.4g} to {high:.4g} m/s" in told
    assert "fitted-or-schlenk (sun mesh; schlenk is used instead) 100 %" in told
    formula = [flag for flag in slow.flags if flag.use.model == "schlenk"]
    assert {flag.quantity for flag in formula} == {"pitch-line speed"}
    assert slow.losses["planet_bearing_mechanical"] == pytest.approx(
        ep.solve(case.updated({"operation.speed": "110 rpm", "models.bearing": "palmgren"})).losses[
            "planet_bearing_mechanical"
        ],
        rel=1e-9,
    )


def test_temperatures_are_found_where_fit_and_formula_mix(case):
    changes = {
        "models.temperatures": "flank",
        "operation.speed": "520 rpm",
        "operation.torque": "700 N*m",
    }
    result = ep.solve(case.updated(changes))
    assert result.heat is not None
    assert result.heat.residual < 0.1


def test_the_result_says_how_well_its_models_are_known(case):
    result = ep.solve(case)
    known = json.loads(result.to_json())["standing"]
    assert known == dict(result.standing) == standing_of(set_of(case))
    assert known["friction"].startswith("fitted-or-schlenk: median error ")
    assert "against 80 contacts simulated for iso-vg-220-mineral" in known["friction"]
    assert "beyond them schlenk: " in known["friction"]
    quick = ep.solve(case.updated({"models.mesh": "loss-factor"}))
    assert set(quick.standing) == {"friction", "bearing"}


@pytest.mark.slow
def test_tables_begin_with_the_models_and_reports_with_the_losses(case):
    result = ep.solve(case)
    console = Console(width=400, record=True, file=io.StringIO())
    console.print(result_tables(result))
    text = console.export_text()
    title, losses = text.index("Models and their reliability"), text.index("Losses ")
    assert title < losses
    assert f"rolling loss: {result.standing['rolling']}" in text
    page = html.unescape(ep.report_html(ep.record(case, result=result)))
    assert page.index("Models and their reliability") > page.index("loss, W")
    assert f"planet bearing: {result.standing['bearing']}" in page


def test_models_of_a_train_are_named_once_for_all_sets():
    result = ep.solve(ep.load_case("train-eaxle"))
    told = {
        "P1.friction": "schlenk: a", "P2.friction": "schlenk: a", "P3.friction": "table: b",
    }  # fmt: skip
    (listing,) = standing_items(replace(result, standing=told))
    assert listing.items == ("friction of P1, P2: schlenk: a", "friction of P3: table: b")


def test_every_model_has_a_standing():
    assert set(RELIABILITY["friction"]) == {*FRICTION_MODELS, "ehl-direct"}
    assert set(RELIABILITY["rolling"]) == {*ROLLING_MODELS, CONTAINED.name}
    for role, models in RELIABILITY.items():
        assert [reliability(role, name) for name in models] == list(models.values())


def test_comparison_gives_reasons_and_a_recommendation(case):
    rows = {row.name: row for row in compare_friction(case)}
    assert recommended(tuple(rows.values()))[0].name == "mixed-lubrication"
    assert rows["xu-2007"].other_oil == "a 75W-90 gear oil"
    assert rows["schlenk"].other_oil == ""
    film = [reason for reason in rows["xu-2007"].reasons if "film ratio" in reason]
    assert any(reason.startswith("sun mesh: film ratio 0.") for reason in film)
    assert all("range from 1 (" in reason and "of the loss" in reason for reason in film)
    assert 0.5 < rows["xu-2007"].outside <= 1.0


def test_shaft_bearings_have_a_standing():
    known = ep.solve(ep.load_case("train-eaxle")).standing
    bearings = {key: text for key, text in known.items() if key.endswith(".shaft_bearing")}
    assert bearings
    assert all(text.split(":")[0] in RELIABILITY["shaft_bearing"] for text in bearings.values())


def test_recommendation_for_the_fluid_of_the_regression_and_for_an_unknown_oil():
    case = ep.load_case("talbot-2012")
    best, why = recommended(compare_friction(case))
    assert best.name == "mixed-lubrication"
    assert "best with measured gears" in why
    rows = compare_friction(case.updated(FORMER))
    best, why = recommended(rows)
    assert best.name == "mixed-ehl"
    assert "made for this oil" in why
    assert recommended([replace(row, outside=0.51) for row in rows])[0].name == "mixed-lubrication"
    polished = ep.load_case("talbot-2012-n6-polished").updated(FORMER)
    best, why = recommended(compare_friction(polished))
    assert best.name == "mixed-ehl+pairing"
    assert "unequal roughness" in why
    pair = ep.load_case("talbot-2012-pair")
    other = pair.updated({"lubricant.oil": "iso-vg-46-pao", **FORMER})
    best, why = recommended(compare_friction(other))
    assert best.name == "mixed-lubrication"
    assert not best.chosen
    assert "best with measured gears" in why


def test_sets_with_two_models_one_of_them_the_default_are_compared():
    case = ep.load_case("train-eaxle").updated({"sets.pair.models.friction": "schlenk"})
    rows = compare_friction(case, brief=True)
    assert recommended(rows)[0].name == "mixed-lubrication"
    assert not any(row.chosen for row in rows)


SHIPPED = [name for name in library.names("oils") if library.oil_model_file(name)]


@pytest.mark.parametrize("name", SHIPPED)
def test_friction_of_unseen_contacts_meets_the_aims_that_the_manual_states(name):
    errors = read_oil_model(library.oil_model_file(name)).fits["friction"].forms[0].errors[0]
    assert errors.regime == "all"
    assert errors.median < 0.08
    assert errors.largest_of_90_percent < 0.25


def test_the_manual_shows_the_table():
    """Run scripts/update_oil_model_table.py where it does not."""
    script = runpy.run_path(
        str(Path(__file__).parents[2] / "scripts" / "update_oil_model_table.py")
    )
    assert script["table"]() in script["PAGE"].read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("own", "made", "readable"),
    [
        ("0.2.0.dev0", "0.1.0", True),
        ("0.2.0.dev0", "0.2.0.dev0", True),
        ("0.2.0.dev0", "0.2.0", False),
        ("0.10.0", "0.9.1", True),
        ("0.2.0", "next", False),
    ],
)
def test_models_of_a_later_version_are_refused_whatever_versions_are_called(
    monkeypatch, tmp_path, own, made, readable
):
    text = library.oil_model_file("iso-vg-100-mineral").read_text(encoding="utf-8")
    path = tmp_path / "model.json"
    path.write_text(sealed(unsealed(text) | {"version": made}, indent=2), encoding="utf-8")
    monkeypatch.setattr("epicyclic.contact.fitted_models.metadata.version", lambda name: own)
    if readable:
        assert read_oil_model(path).version == made
    else:
        with pytest.raises(ep.InputError, match="made by version"):
            read_oil_model(path)
