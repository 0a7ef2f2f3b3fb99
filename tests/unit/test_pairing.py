"""Regressions for flanks of unequal roughness."""

from __future__ import annotations

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.contact.line_contact import contacts_at
from epicyclic.losses.friction import FRICTION_MODELS, equally_rough, pairing_ratio
from epicyclic.losses.rolling import ROLLING_MODELS

STEEL = 227.47e9


def gear_contacts(roughness1, roughness2, slip=1.0):
    """Contacts within Table 5.1 of Talbot (2012); `slip` may turn which surface is faster."""
    rng = np.random.default_rng(2)
    ranges = {
        "slide_to_roll_ratio": (0.06, 0.9),
        "rolling_speed": (2.0, 19.0),
        "radius": (5.5e-3, 31e-3),
        "hertz_pressure": (0.6e9, 1.9e9),
    }
    values = {name: low * (high / low) ** rng.random(60) for name, (low, high) in ranges.items()}
    values["slide_to_roll_ratio"] = slip * values["slide_to_roll_ratio"]
    values |= {"dynamic_viscosity": 6.3e-3, "pressure_viscosity": 11.4e-9}
    values |= {"roughness1": np.full(60, roughness1), "roughness2": np.full(60, roughness2)}
    return contacts_at(**values, equivalent_modulus=STEEL)


def test_equally_rough_flanks_have_the_published_values():
    contacts = gear_contacts(0.37e-6, 0.37e-6)
    assert FRICTION_MODELS["mixed-ehl+pairing"].coefficient(contacts) == pytest.approx(
        FRICTION_MODELS["mixed-ehl"].coefficient(contacts), rel=1e-12
    )
    assert ROLLING_MODELS["mixed-ehl+pairing"].loss_density(contacts) == pytest.approx(
        ROLLING_MODELS["mixed-ehl"].loss_density(contacts), rel=1e-12
    )


def test_the_pair_is_compared_with_two_of_the_rougher_flank():
    contacts = gear_contacts(0.12e-6, 0.43e-6)
    both = equally_rough(contacts)
    assert np.all(both.roughness1 == 0.43e-6)
    assert np.all(both.roughness2 == 0.43e-6)
    expected = FRICTION_MODELS["mixed-ehl"].coefficient(both) * pairing_ratio("friction", contacts)
    assert FRICTION_MODELS["mixed-ehl+pairing"].coefficient(contacts) == pytest.approx(expected)


@pytest.mark.parametrize("quantity", ["friction", "rolling_loss"])
def test_a_smoother_flank_lowers_both_losses(quantity):
    ratio = pairing_ratio(quantity, gear_contacts(0.41e-6, 0.1e-6))
    assert np.median(ratio) < 0.9
    smoother = pairing_ratio(quantity, gear_contacts(0.41e-6, 0.2e-6))
    assert np.median(ratio) < np.median(smoother) < 1.0


def test_it_matters_which_flank_is_faster_not_how_they_are_called():
    one = pairing_ratio("friction", gear_contacts(0.41e-6, 0.1e-6))
    exchanged = pairing_ratio("friction", gear_contacts(0.1e-6, 0.41e-6, slip=-1.0))
    assert exchanged == pytest.approx(one, rel=1e-12)
    rough_is_slower = pairing_ratio("friction", gear_contacts(0.41e-6, 0.1e-6, slip=-1.0))
    assert np.median(rough_is_slower) > np.median(one)


def test_the_models_are_chosen_by_name():
    case = ep.load_case("talbot-2012-n6-polished").updated({"models.preset": "talbot-2012"})
    paired = case.updated(
        {"models.friction": "mixed-ehl+pairing", "models.rolling": "mixed-ehl+pairing"}
    )
    plain, found = ep.solve(case).losses, ep.solve(paired).losses
    for name in ("sun_mesh_sliding", "ring_mesh_sliding", "sun_mesh_rolling", "ring_mesh_rolling"):
        assert 0.4 * plain[name] < found[name] < plain[name]
    assert found["planet_bearing_mechanical"] == pytest.approx(
        plain["planet_bearing_mechanical"], rel=0.01
    )  # torques are those with losses
