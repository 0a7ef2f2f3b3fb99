"""Rolling is not lost twice: mean friction of gear tests contains it."""

from __future__ import annotations

import pytest

import epicyclic as ep

COARSE = {"numerics.mesh_positions": 6, "numerics.contact_segments": 6}


@pytest.fixture(scope="module")
def case():
    return ep.load_case("talbot-2012").updated(COARSE)


def told(result, text):
    return [note for note in result.warnings if text in note]


@pytest.mark.parametrize("friction", ["schlenk", "niemann-winter"])
def test_mean_friction_of_gear_tests_contains_rolling(case, friction):
    result = ep.solve(case.updated({"models.friction": friction}))
    assert result.models["rolling"] == "contained"
    assert result.losses["sun_mesh_rolling"] == result.losses["ring_mesh_rolling"] == 0
    assert told(result, f"contained in the friction {friction}")
    assert not told(result, "counts twice")


def test_a_rolling_model_asked_for_counts_twice_with_its_watts(case):
    chosen = {"models.friction": "schlenk", "models.rolling": "goksem-hargreaves"}
    result = ep.solve(case.updated(chosen))
    watts = result.losses["sun_mesh_rolling"]
    assert watts > 0
    assert told(result, f"The rolling loss of the sun mesh, {watts:.3g} W, counts twice")
    alone = ep.solve(case.updated({"models.friction": "schlenk"}))
    assert alone.losses["sun_mesh_sliding"] == pytest.approx(
        result.losses["sun_mesh_sliding"],
        rel=0.02,  # the torques of the meshes differ a little
    )


@pytest.mark.parametrize("friction", ["mixed-ehl", "constant", "benedict-kelley"])
@pytest.mark.parametrize(
    ("preset", "rolling"), [("general", "goksem-hargreaves"), ("talbot-2012", "mixed-ehl")]
)
def test_other_friction_does_not_contain_it(case, friction, preset, rolling):
    result = ep.solve(case.updated({"models.friction": friction, "models.preset": preset}))
    assert result.models["rolling"] == rolling
    assert result.losses["sun_mesh_rolling"] > 0
    assert not told(result, "counts twice")


def test_lubricant_factor_is_in_the_result(case):
    result = ep.solve(case.updated({"models.friction": "schlenk"}))
    assert told(result, "the oil has X_L = 1 (X_L of ISO/TR 14179-2")
