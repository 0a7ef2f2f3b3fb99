"""Fits to simulated contacts: their forms, their coefficients, their files."""

from __future__ import annotations

import json
import math
import re
from itertools import pairwise

import numpy as np
import pytest

from epicyclic.contact import fitted_models as regressions
from epicyclic.contact import fitted_models as structured
from epicyclic.contact.fitted_models import FORMAT, FORMS, OilModel, read_oil_model
from epicyclic.contact.line_contact import CONDITIONS, contacts_at
from epicyclic.errors import InputError
from epicyclic.files import sealed
from epicyclic.kernels import mixed_ehl
from epicyclic.library import oil_model_file
from epicyclic.losses.ranges import ModelUse, check_ranges
from epicyclic.losses.rolling import domain_ranges
from epicyclic.plugins.contact_solver.fit import fit_quantity
from epicyclic.schema.read import plain

STEEL = 227.47e9
# Tables 5.2(a), 5.2(b) and 3.2 of Talbot (2012), in the order of the columns
FRICTION = (
    -0.92139, -0.00008711, -4400.2, -208.356, 0.00034889, 0.00000156, 18.9479,
    0.00201603, -0.0059483, -1.90169, -0.579273, -0.00711570,
    -4.35656, -0.0060247, 0.00001033, -5940595.0, -0.00009197, -0.0251361, 0.0092455, -0.146072,
    -21.8661, 0.00007909, 0.00315987, -0.0584464,
    -54.986, -0.0058891, -0.041242, 0.00000905, 0.48686, -0.00022193, 21.533, 0.0074347, 6.8850,
    0.035346, -5.2323, -0.00073500, -0.052499,
)  # fmt: skip
ROLLING = (
    -55.5228, -4049775804.0, 0.00036893, 91748360.0, 0.0035756, -2.81418, 0.79315, -1.57573,
    0.71772, -4.20259, -0.162010,
    -63.8414, -0.74816, 700205388.0, -4.85987, -0.287849, -0.43762, 2202.89, -0.183452, -0.123683,
    0.50128, -0.370511,
)  # fmt: skip
NEEDLE = (
    27.3758, 0.0169312, -0.00260401, 55.582, 0.179813, -0.097448, -1.33225, 0.272560, -15.4258,
    -0.102883, 0.233836,
)  # fmt: skip


def states(count=200, seed=1, **given):
    """Random gear contacts within Table 5.1."""
    rng = np.random.default_rng(seed)
    ranges = {
        "slide_to_roll_ratio": (0.025, 1.0),
        "rolling_speed": (1.0, 20.0),
        "radius": (5e-3, 40e-3),
        "hertz_pressure": (0.5e9, 2.5e9),
        "roughness1": (0.1e-6, 0.7e-6),
        "roughness2": (0.1e-6, 0.7e-6),
        "dynamic_viscosity": (5e-3, 48e-3),
        "pressure_viscosity": (11e-9, 16e-9),
    }
    values = {name: low * (high / low) ** rng.random(count) for name, (low, high) in ranges.items()}
    values |= {name: np.broadcast_to(value, (count,)) for name, value in given.items()}
    return contacts_at(**values, equivalent_modulus=STEEL)


def published(kernel, contacts):
    """A regression of the source by the kernel that evaluates it."""
    groups = regressions.regression_groups(contacts)
    return np.array([kernel(*row) for row in np.stack(groups, axis=1)])


def test_with_the_published_coefficients_the_forms_are_the_published_regressions():
    contacts = states()
    assert len(np.unique(np.digitize(contacts.film_ratio, [0.7, 1.0, 3.0]))) == 4
    friction = regressions.FRICTION_REGRESSION.value(contacts, np.array(FRICTION))
    assert friction == pytest.approx(published(mixed_ehl.sliding_friction, contacts), rel=1e-9)
    rolling = regressions.ROLLING_REGRESSION.value(contacts, np.array(ROLLING))
    scale = contacts.dynamic_viscosity * contacts.rolling_speed**2
    expected = published(mixed_ehl.rolling_loss_number, contacts) * scale
    assert rolling == pytest.approx(expected, rel=1e-9)
    needle = regressions.NEEDLE_REGRESSION.value(contacts, np.array(NEEDLE))
    rows = zip(
        contacts.hertz_pressure, contacts.rolling_speed, contacts.dynamic_viscosity,
        contacts.pressure_viscosity, contacts.radius, contacts.composite_roughness, strict=True,
    )  # fmt: skip
    one_by_one = [mixed_ehl.needle_rolling_loss(*row, STEEL) for row in rows]
    # the source has a factor of 1e5 in front
    assert 1e5 * needle == pytest.approx(np.array(one_by_one), rel=1e-9)


def test_eyring_friction_of_constant_viscosity_has_a_closed_form():
    # alpha = 0: one shear stress over the whole contact, of width 2b under pi/2 b p_h
    contacts = states(20, pressure_viscosity=1e-14)
    film = contacts.radius * structured.pan_hamrock_central_film(
        contacts.speed_number, contacts.material_number, contacts.load_number
    )
    stress = 5e6
    rate = contacts.dynamic_viscosity * contacts.sliding_speed / film
    expected = 4 * stress * np.arcsinh(rate / stress) / (math.pi * contacts.hertz_pressure)
    # 1e-14/Pa at 2.5 GPa: 2.5e-5
    found = structured.eyring_friction(contacts, stress, light_load=0.0)
    assert found == pytest.approx(expected, rel=1e-4)
    # the less load, the flatter the pressure
    light = structured.eyring_friction(contacts, stress, light_load=2.0)
    flatter = 1 + 2.0 / contacts.moes_load
    assert light == pytest.approx(expected * flatter, rel=1e-4)


def random_coefficients(form, count=50):
    """Within the bounds of a form, and not far from one."""
    low, high = (np.maximum(np.minimum(limit, 3), -3) for limit in (form.low, form.high))
    return low + (high - low) * np.random.default_rng(3).random((count, form.size))


def with_roughness(form, coefficients):
    """Values of both surfaces smooth to rough, a row each."""
    roughness = (1e-8, 1e-7, 3e-7, 1e-6, 1e-5)
    return [
        form.value(states(20, roughness1=rough, roughness2=rough), coefficients)
        for rough in roughness
    ]


def test_the_structured_rolling_loss_never_falls_with_the_roughness():
    form = FORMS["rolling_loss"]["structured"]
    for coefficients in random_coefficients(form):
        for smoother, rougher in pairwise(with_roughness(form, coefficients)):
            assert (rougher >= smoother).all()
            assert np.isfinite(rougher).all()


def test_roughness_adds_to_the_structured_friction_where_smooth_surfaces_do_not_touch():
    form = FORMS["friction"]["structured"]
    contacts = states(20)
    film = contacts.film_ratio * contacts.composite_roughness / 40e-9
    at = form.labels.index("film at which surfaces touch, over 40 nm")
    seen = np.zeros(2)
    for coefficients in random_coefficients(form):
        touching = film < coefficients[at]
        seen += touching.sum(), (~touching).sum()
        for smoother, rougher in pairwise(with_roughness(form, coefficients)):
            assert (rougher[~touching] >= smoother[~touching]).all()
            assert (rougher[touching] <= smoother[touching]).all()
            assert np.isfinite(rougher).all()
    assert (seen > 30).all()


def test_the_structured_friction_of_asperities_never_falls_as_the_film_becomes_thinner():
    form = FORMS["friction"]["structured"]
    # a film of no friction, so that asperities are all there is
    for coefficients in random_coefficients(form):
        coefficients[:3] = 0.0, 0.0, -40.0
        coefficients[form.labels.index("exponent of the flattening")] = 0.0
        thick, thin = (
            form.value(states(20, dynamic_viscosity=viscosity), coefficients)
            for viscosity in (0.02, 0.002)
        )
        assert (thin >= thick - 1e-15).all()  # the film's


@pytest.mark.parametrize("quantity", sorted(FORMS))
@pytest.mark.parametrize("name", ["structured", "regression"])
def test_a_fit_finds_the_values_of_its_own_form(quantity, name):
    form = FORMS[quantity][name]
    contacts = states(400)
    known = {"friction": FRICTION, "rolling_loss": ROLLING, "bearing_rolling_loss": NEEDLE}
    coefficients = np.array(known[quantity] if name == "regression" else form.start)
    target = form.value(contacts, coefficients)
    found = form.fit(contacts, target, np.ones(400))
    # coefficients of the regressions are nearly dependent; values are what they are for
    assert form.value(contacts, found) == pytest.approx(target, rel=1e-4)


def test_errors_are_those_of_contacts_that_were_not_fitted():
    contacts = states(400)
    rng = np.random.default_rng(5)
    form = FORMS["friction"]["structured"]
    noise = np.exp(0.1 * rng.standard_normal(400))
    target = form.value(contacts, np.array(form.start)) * noise
    fit = fit_quantity("friction", "1", contacts, target, np.ones(400))
    errors = {error.regime: error for error in fit.forms[0].errors}
    # median and 90 % of |exp(0.1 z) - 1|, of 400 draws: 0.067 and 0.165
    assert errors["all"].median == pytest.approx(0.067, rel=0.2)
    assert errors["all"].largest_of_90_percent == pytest.approx(0.165, rel=0.2)
    assert errors["all"].contacts == 400
    assert sum(error.contacts for name, error in errors.items() if name != "all") == 400


def test_a_form_with_more_coefficients_than_contacts_is_left_out():
    contacts = states(20)
    target = FORMS["friction"]["structured"].value(contacts, np.full(13, 0.1))
    fit = fit_quantity("friction", "1", contacts, target, np.ones(20))
    assert [form.form for form in fit.forms] == ["structured"]
    assert "too few" in fit.left_out["regression"]
    with pytest.raises(ValueError, match="too few"):
        fit_quantity("friction", "1", states(5), target[:5], np.ones(5))


@pytest.fixture
def model(talbot):
    contacts = states(60)
    form = FORMS["friction"]["structured"]
    target = form.value(contacts, np.array(form.start))
    return OilModel(
        format=FORMAT,
        version="0",
        settings={"lubricant": {"oil": plain(talbot.lubricant.oil)}},
        designs=(),
        seed=0,
        simulations={"simulated": 60},
        equivalent_modulus=STEEL,
        fits={"friction": fit_quantity("friction", "1", contacts, target, np.ones(60))},
    )


def test_a_file_gives_back_the_model(model, talbot, tmp_path):
    file = tmp_path / "model.json"
    file.write_text(model.to_text())
    back = read_oil_model(file)
    assert back.model_dump_json() == model.model_dump_json()
    assert back.oil == talbot.lubricant.oil
    contacts = states(30)
    assert np.array_equal(back.value("friction", contacts), model.value("friction", contacts))


def test_conditions_are_held_in_the_domain(model):
    inside = states(10)
    limits = model.fits["friction"].domain
    far = {"rolling_speed": 1e3, "radius": 10.0, "roughness1": 1e-3, "dynamic_viscosity": 10.0}
    held = {name: limits[name][1] for name in far}
    outside = contacts_at(
        **{
            name: np.full(10, far[name]) if name in far else getattr(inside, name)
            for name in CONDITIONS
        },
        equivalent_modulus=STEEL,
    )
    at_limit = contacts_at(
        **{
            name: np.full(10, held[name]) if name in held else getattr(inside, name)
            for name in CONDITIONS
        },
        equivalent_modulus=STEEL,
    )
    expected = pytest.approx(model.value("friction", at_limit), rel=1e-12)
    assert model.value("friction", outside) == expected


def test_every_condition_that_is_held_is_flagged(talbot):
    # each surface on its own: the range of one is none of the other
    contacts = states(60, roughness1=1e-7, roughness2=4e-7)
    target = np.ones(60)
    fit = fit_quantity("bearing_rolling_loss", "W/m", contacts, target, target)
    model = OilModel(
        format=FORMAT, version="0", settings={"lubricant": {"oil": plain(talbot.lubricant.oil)}},
        designs=(), seed=0, simulations={}, equivalent_modulus=STEEL,
        fits={"bearing_rolling_loss": fit},
    )  # fmt: skip
    ranges = list(domain_ranges(model, "bearing_rolling_loss"))
    for name in CONDITIONS:
        limits = fit.domain[name]
        outside = contacts.changed(**{name: np.full(60, 1.1 * limits[1])})
        values = {item.name: getattr(outside, item.name) for item in ranges}
        flags = check_ranges(ModelUse("bearing", "fitted", "bearing"), ranges, values)
        assert len(flags) == 1, name
    swapped = contacts.changed(roughness1=contacts.roughness2, roughness2=contacts.roughness1)
    values = {item.name: getattr(swapped, item.name) for item in ranges}
    flags = check_ranges(ModelUse("bearing", "fitted", "bearing"), ranges, values)
    assert [flag.quantity[-1] for flag in flags] == ["1", "2"]


def resealed(text):
    """An altered file with the fingerprint of what it holds now."""
    content = json.loads(text)
    del content["fingerprint"]
    return sealed(content)


def with_domain(low, high):
    def damage(text):
        content = json.loads(text)
        content["fits"]["friction"]["domain"]["radius"] = [low, high]
        return resealed(json.dumps(content))

    return damage


def with_coefficient(text):
    content = json.loads(text)
    content["fits"]["friction"]["forms"][0]["coefficients"][10] = -0.3
    return resealed(json.dumps(content))


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        (lambda text: text[: len(text) // 2], "is not JSON"),
        (lambda text: resealed(text.replace(FORMAT, "epicyclic oil model 7")), "format"),
        (lambda text: resealed(text.replace('"form": "structured"', '"form": "other"')), "other"),
        (lambda text: resealed(text.replace('"lubricant"', '"fluid"')), "no oil"),
        (lambda text: resealed(text.replace('"radius":', '"size":')), "domain"),
        (lambda text: resealed(text.replace('"version": "0"', '"version": "99.1"')), "99.1"),
        (lambda text: text.replace('"seed": 0', '"seed": 7'), "was altered"),
        (lambda text: text.replace('"fingerprint"', '"print"'), "no fingerprint"),
        (with_domain(0.02, 0.01), "must be increasing"),
        (with_domain(-0.02, 0.01), "above zero"),
        (with_coefficient, "out of bounds"),
        (
            lambda text: resealed(
                re.sub('"equivalent_modulus": [0-9.]+', '"equivalent_modulus": 0', text)
            ),
            "greater than 0",
        ),
        (lambda text: json.dumps({"coefficients": "x" * 6_000_000}), "too large"),
        (lambda text: "", "is not JSON"),
    ],
    ids=[
        "cut",
        "format",
        "form",
        "oil",
        "domain",
        "version",
        "altered",
        "no fingerprint",
        "reversed domain",
        "negative domain",
        "coefficient",
        "modulus",
        "large",
        "empty",
    ],
)
def test_a_damaged_file_is_refused(model, tmp_path, damage, told):
    file = tmp_path / "model.json"
    file.write_text(damage(model.to_text()))
    with pytest.raises(InputError, match=told) as caught:
        read_oil_model(file)
    assert str(file) in str(caught.value)


@pytest.mark.parametrize("value", [1e300, -1e300, 60.0, -900.0])
@pytest.mark.parametrize(("quantity", "form"), [(q, form) for q in FORMS for form in FORMS[q]])
def test_huge_coefficients_of_every_form_are_refused(tmp_path, quantity, form, value):
    content = json.loads(oil_model_file("atf-talbot-2012").read_text(encoding="utf-8"))
    (fitted,) = (f for f in content["fits"][quantity]["forms"] if f["form"] == form)
    fitted["coefficients"][0] = value
    file = tmp_path / "model.json"
    file.write_text(resealed(json.dumps(content)))
    with pytest.raises(InputError, match=f"{quantity}: {form} coefficients"):
        read_oil_model(file)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_oil_model(tmp_path / "none.json")
