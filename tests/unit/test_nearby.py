"""The correction of a form by the simulations nearby."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import ValidationError
from scipy.interpolate import RBFInterpolator

from epicyclic.contact import fitted_models as nearby
from epicyclic.contact.fitted_models import FORMS, MOST_SIMULATIONS, NearbySimulations
from epicyclic.contact.line_contact import CONDITIONS, contacts_at
from epicyclic.plugins.contact_solver.fit import fit_quantity

STEEL = 227.47e9
RANGES = {
    "slide_to_roll_ratio": (0.03, 1.1),
    "rolling_speed": (1.2, 21.0),
    "radius": (4e-3, 42e-3),
    "hertz_pressure": (0.4e9, 2.3e9),
    "roughness1": (0.08e-6, 0.65e-6),
    "roughness2": (0.07e-6, 0.7e-6),
    "dynamic_viscosity": (5e-3, 48e-3),
    "pressure_viscosity": (11e-9, 16e-9),
}


def states(count, seed=1):
    rng = np.random.default_rng(seed)
    values = {name: low * (high / low) ** rng.random(count) for name, (low, high) in RANGES.items()}
    values["slide_to_roll_ratio"] *= rng.choice([-1.0, 1.0], count)
    return contacts_at(**values, equivalent_modulus=STEEL)


def excess_of(contacts):
    """Smooth in the conditions, alike for contacts whose surfaces are exchanged."""
    one, two = contacts.roughness
    sense = np.sign(contacts.sliding_speed)
    return 0.2 * np.sin(np.log(contacts.radius) + np.log(contacts.hertz_pressure)) + 0.1 * sense * (
        np.log(one / two)
    )


@pytest.fixture(scope="module")
def simulations():
    contacts = states(300)
    weight = np.linspace(0.3, 1.0, 300)
    return NearbySimulations.of(contacts, excess_of(contacts), weight)


def test_what_a_form_lacks_is_found_between_the_simulations(simulations):
    contacts = states(200, seed=2)
    wanted = excess_of(contacts)
    left = wanted - np.log(simulations.factor(contacts))
    assert np.sqrt(np.mean(left**2)) < 0.4 * np.sqrt(np.mean(wanted**2))


def test_it_is_the_interpolation_of_scipy(simulations):
    def places(contacts):
        one, two = (np.log(roughness) for roughness in contacts.roughness)
        columns = [
            np.log(contacts.hertz_pressure), np.log(contacts.radius),
            np.log(contacts.rolling_speed), np.log(contacts.slide_to_roll_ratio + 0.01),
            np.log(contacts.dynamic_viscosity), np.maximum(one, two), np.abs(one - two),
            np.sign(contacts.sliding_speed) * (one - two),
        ]  # fmt: skip
        return np.array(columns).T

    given = places(states(300))
    length = 2 * given.std(axis=0)
    scipy = RBFInterpolator(
        given / length, excess_of(states(300)), kernel="inverse_quadratic",
        epsilon=np.sqrt(0.5), smoothing=(0.08 / 0.2) ** 2 / np.linspace(0.3, 1.0, 300), degree=-1,
    )  # fmt: skip
    asked = states(9, seed=3)
    # the file keeps five digits
    assert np.log(simulations.factor(asked)) == pytest.approx(
        scipy(places(asked) / length), abs=1e-4
    )


def test_exchanged_surfaces_have_the_same_correction(simulations):
    contacts = states(20, seed=4)
    one, two = contacts.roughness
    exchanged = contacts.changed(
        roughness1=two,
        roughness2=one,
        slide_to_roll_ratio=-contacts.sliding_speed / contacts.rolling_speed,
    )
    assert simulations.factor(exchanged) == pytest.approx(simulations.factor(contacts), rel=1e-12)


def test_far_from_all_simulations_nothing_is_corrected(simulations):
    far = states(5).changed(radius=np.full(5, 1e30), rolling_speed=np.full(5, 1e-30))
    assert simulations.factor(far) == pytest.approx(1.0, abs=0.02)


def test_smooth_surfaces_and_pure_rolling_have_a_place(simulations):
    contacts = states(4).changed(roughness1=np.zeros(4), slide_to_roll_ratio=np.zeros(4))
    assert np.isfinite(simulations.factor(contacts)).all()


def test_of_a_large_campaign_some_take_part():
    contacts = states(MOST_SIMULATIONS + 37)
    size = contacts.radius.size
    taken = NearbySimulations.of(contacts, 1e-3 * np.arange(size), np.ones(size))
    assert len(taken.excess) == len(set(taken.excess)) == MOST_SIMULATIONS


@pytest.mark.slow
def test_fits_are_corrected_where_that_helps(monkeypatch):
    contacts = states(150)
    form = FORMS["friction"]["structured"]
    exact = form.value(contacts, np.array(form.start))
    weight = np.ones(150)
    fit = fit_quantity("friction", "1", contacts, exact * np.exp(excess_of(contacts)), weight)
    corrected = fit.forms[0]
    assert corrected.nearby is not None
    monkeypatch.setattr(nearby, "NOISE", 1e9)  # so that it cannot
    alone = fit_quantity("friction", "1", contacts, exact * np.exp(excess_of(contacts)), weight)
    assert corrected.errors[0].median < 0.8 * alone.forms[0].errors[0].median
    rng = np.random.default_rng(6)
    monkeypatch.undo()
    scattered = exact * np.exp(0.1 * rng.standard_normal(150))
    assert fit_quantity("friction", "1", contacts, scattered, weight).forms[0].nearby is None


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"excess": (0.1, 3.5)}, "within 3"),
        ({"excess": (0.1,)}, "have the same length"),
        ({"excess": ()}, "at least 1"),
        ({"weight": (0.0, 0.5)}, "above 0"),
        ({"equivalent_modulus": 0.0}, "greater than 0"),
        ({"conditions": {}}, "must be slide"),
        ({"excess": (0.1, float("nan"))}, "finite"),
        ({"conditions.radius": (1e-3, -2e-3)}, "above zero"),
        ({"conditions.radius": (1e-3,)}, "have the same length"),
    ],
    ids=lambda value: str(value)[:40],
)
def test_altered_simulations_are_refused(change, told):
    values = {
        "conditions": {
            name: (low, high) for name, (low, high) in RANGES.items() if name in CONDITIONS
        },
        "excess": (0.1, -0.2),
        "weight": (0.9, 0.5),
        "equivalent_modulus": STEEL,
    }
    assert NearbySimulations.model_validate(values).excess == (0.1, -0.2)
    for key, value in change.items():
        first, _, name = key.partition(".")
        values[first] = values[first] | {name: value} if name else value
    with pytest.raises(ValidationError, match=told):
        NearbySimulations.model_validate(values)
