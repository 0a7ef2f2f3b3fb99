"""Film and asperities sharing the load: limits, symmetry, and what the film is like."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.kernels.line_contact import asperity_share, central_film, power
from epicyclic.kernels.mixed_lubrication import acting_roughness, eyring_stress, film_stress
from epicyclic.losses import mixed_lubrication as model
from epicyclic.losses.mixed_lubrication import RUN_IN, Surfaces, acting_heights, mixed_friction
from epicyclic.oil.oil import oil_state
from epicyclic.study.solve import mesh_contacts


@pytest.fixture(scope="module")
def pair():
    """A coarse gear pair."""
    coarse = {"numerics.mesh_positions": 6, "numerics.contact_segments": 5}
    return ep.load_case("talbot-2012-pair").updated(
        {**coarse, "losses.mesh_pocketing.include": False, "models.load_distribution": "uniform"}
    )


@pytest.fixture(scope="module")
def contact(pair):
    """Contacts of a loaded pair in motion."""
    case = pair.updated({"operation.torque": "133 N*m", "operation.speed": "2400 rpm"})
    return mesh_contacts(case)["mesh"]


def stress_at(temperature, pressure, rate, oil):
    """Of the film at a temperature."""
    log_rate = math.log(rate * oil[4] * oil[5] / oil[7])
    at = (np.array([value]) for value in (temperature, pressure, log_rate))
    return eyring_stress(*at, tuple(oil))[0][0]


def share(contact):
    """Of the load on asperities."""
    film = central_film(
        contact.line_load, contact.radius, contact.rolling_speed, contact.slide_to_roll_ratio,
        contact.flanks.equivalent_modulus, contact.dynamic_viscosity, contact.pressure_viscosity,
        contact.oil.thermal_load(contact.rolling_speed),
    )  # fmt: skip
    grown = power(2 * contact.hertz_half_width, RUN_IN.hurst_exponent)
    return asperity_share(
        film / acting_roughness(grown, *acting_heights(contact.roughness, RUN_IN))
    )


def rough(contact, one, two):
    return replace(contact, flanks=replace(contact.flanks, roughness1=one, roughness2=two))


def test_a_rougher_flank_never_loses_less(contact):
    heights = np.geomspace(0.01e-6, 5e-6, 60)
    friction = np.array([mixed_friction(rough(contact, r, 0.3e-6), RUN_IN) for r in heights])
    assert (np.diff(friction, axis=0) >= -1e-12).all()
    assert friction[-1].mean() > 1.2 * friction[0].mean()


def test_exchanged_roughness_changes_nothing(contact):
    one = mixed_friction(rough(contact, 1.5e-6, 0.4e-6), RUN_IN)
    other = mixed_friction(rough(contact, 0.4e-6, 1.5e-6), RUN_IN)
    assert one == pytest.approx(other, rel=1e-12)


def test_creeping_flanks_have_boundary_friction(contact):
    slow = replace(
        contact,
        rolling_speed=1e-9 * contact.rolling_speed,
        sliding_speed=1e-9 * contact.sliding_speed,
    )
    assert share(slow) == pytest.approx(1.0)
    assert mixed_friction(slow, RUN_IN) == pytest.approx(contact.oil.boundary_friction)
    assert mixed_friction(slow, RUN_IN, 0.11) == pytest.approx(0.11)


def test_smooth_flanks_have_the_friction_of_the_film(contact):
    smooth = rough(contact, 1e-9, 2e-9)
    assert (share(smooth) < 1e-6).all()
    friction = mixed_friction(smooth, RUN_IN)
    assert (friction < contact.oil.limiting_traction).all()
    assert (friction > 0).all()


def test_the_film_is_as_hot_as_its_stress_makes_it(contact):
    pressure, rate = np.array([0.6e9, 0.9e9]), np.array([1e6, 4e6])
    warm, heating = np.array([3.0, 7.0]), np.array([5e-7, 8e-7])
    oil = np.array(model._oil_constants(contact.oil))
    stress = film_stress(pressure, rate, warm, heating, oil)
    for i in range(2):
        hot = oil[0] + warm[i] + heating[i] * stress[i]
        assert stress[i] == pytest.approx(stress_at(hot, pressure[i], rate[i], oil), rel=1e-9)
        assert stress[i] < stress_at(oil[0], pressure[i], rate[i], oil)


def test_the_stress_is_found_however_stiff_the_oil():
    """Newton's method alone ran in circles where an oil of 5e5 mm^2/s heats itself by 100 K."""
    rng = np.random.default_rng(20)
    for _ in range(300):
        n, viscosity = 40, 10 ** rng.uniform(-0.3, 6)
        oil = np.array(
            [rng.uniform(230, 450), math.log(viscosity + 0.7), math.log(viscosity),
             rng.uniform(2, 5), 0.9e-3, 10 ** rng.uniform(-9, -7.2), rng.uniform(0, 0.3), 0.047]
        )  # fmt: skip
        pressure, rate = 10 ** rng.uniform(5, 9.8, n), 10 ** rng.uniform(-3, 9, n)
        warm, heating = 10 ** rng.uniform(-6, 2, n), 10 ** rng.uniform(-14, -5.3, n)
        stress = film_stress(pressure, rate, warm, heating, oil)
        hot = oil[0] + warm + heating * stress
        found = [stress_at(*each, oil) for each in zip(hot, pressure, rate, strict=True)]
        assert stress == pytest.approx(found, rel=1e-7)


def test_a_short_step_behind_a_very_long_one_is_not_the_last():
    """The stress was a third of that of neighbours where the film lies far below the start."""
    found = ep.friction(
        "mixed-lubrication", line_load="298.6 N/mm", radius="36 mm", rolling_speed="84.4 m/s",
        sliding_speed=["130 m/s", "134 m/s", "156 m/s", "160 m/s"], oil="iso-vg-320-mineral",
        temperature="-4.4 degC",
    )  # fmt: skip
    assert (np.diff(found) < 0).all()
    assert found[-1] > 0.9 * found[0]


def test_derivative_of_the_stress_to_the_temperature(contact):
    oil = tuple(model._oil_constants(contact.oil))
    at = np.array([0.0, 0.4e9, 1.5e9]), np.array([-9.0, -6.0, -4.0])
    temperatures = (np.full(3, oil[0] + change) for change in (-1e-3, 1e-3, 0.0))
    (low, _), (high, _), (_, slope) = (eyring_stress(it, *at, oil) for it in temperatures)
    assert slope == pytest.approx((high - low) / 2e-3, rel=1e-6)
    assert (slope < 0).all()


def test_stress_over_pressure_tends_to_the_limiting_traction(contact):
    oil = model._oil_constants(contact.oil)
    over = [stress_at(oil[0], p, 1e6, oil) / p for p in (1e9, 1e10, 1e12)]
    assert over[0] < over[1] < over[2]
    assert over[2] == pytest.approx(0.047, rel=1e-3)


def test_viscosity_of_the_film_is_that_of_the_oil():
    """At little stress the fluid is Newtonian, with the viscosity of ASTM D341 when warm."""
    oil = ep.load_case("talbot-2012-pair").lubricant.oil
    cold, hot = oil_state(oil, 363.15), oil_state(oil, 373.15)
    stress = stress_at(373.15, 0.0, 1.0, model._oil_constants(cold))
    # density falls by 0.7 % in between, which is left out
    assert stress == pytest.approx(hot.dynamic_viscosity, rel=0.012)


def test_roughness_that_acts():
    """By hand: 2 b 0.2 mm, cut-off 0.8 mm, H 0.5 leave half."""
    surfaces = Surfaces(running_in=0.7, cutoff=0.8e-3, hurst_exponent=0.5)
    width = np.array([0.2e-3, 1.6e-3])
    found = acting_roughness(np.sqrt(width), *acting_heights((0.3e-6, 0.4e-6), surfaces))
    assert found == pytest.approx([0.7 * 0.5e-6 / 2, 0.7 * 0.5e-6])


def test_share_of_the_asperities_as_printed():
    """Aihara (1987): exp(-1.8 Lambda^1.2), of flanks and of roller ends alike."""
    ratios = np.array([0.0, 0.2, 0.7, 1.6])
    printed = [math.exp(-1.8 * it**1.2) for it in ratios]
    assert asperity_share(ratios) == pytest.approx(printed)
    assert asperity_share(0.7) == pytest.approx(printed[2])


def test_kind_and_additives_decide(pair):
    stated = {"viscosity_40": "220 mm^2/s", "viscosity_100": "19 mm^2/s"}
    at = {"operation.torque": "133 N*m", "operation.speed": "2400 rpm"}

    def sliding(**oil):
        case = pair.updated({**at, "lubricant.oil": {**stated, **oil}})
        return ep.solve(case).losses["mesh_sliding"]

    assert sliding(kind="pag") < sliding(kind="pao") < sliding(kind="mineral")
    plain, package = (sliding(kind="mineral", additives=level) for level in ("none", "gear-oil"))
    assert plain > package
    grippy = sliding(kind="mineral", limiting_traction={"value": 0.07, "source": "disc test"})
    assert grippy > package


def test_running_in_smooths(pair):
    at = {"operation.torque": "133 N*m", "operation.speed": "700 rpm"}
    losses = [
        ep.solve(pair.updated({**at, **keys})).losses["mesh_sliding"]
        for keys in (
            {"models.running_in_factor": 0.5},
            {},
            {"models.running_in": "as-made", "models.running_in_factor": 0.5},
        )
    ]
    assert losses[0] < losses[1] < losses[2]


@pytest.mark.parametrize("stated", [{"exact": True}, {"normal": "7 %"}])
def test_an_uncertain_friction_of_asperities_stays_while_other_models_are_tried(stated):
    """A case leaves its value to the oil: bands failed where they compare models."""
    case = ep.load_case("talbot-2012-pair").updated(
        {"uncertainty": {"models.boundary_friction": stated}}
    )
    other = case.updated({"models.friction": "schlenk"})
    assert other.given()["uncertainty"] == {"models.boundary_friction": stated}
    assert "models.boundary_friction" not in ep.uncertainty(other, samples=16)["input"].values
