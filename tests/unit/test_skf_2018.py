"""SKF's friction model of 2018: load variables, reduction, drag and seals, and its table."""

from __future__ import annotations

import math
import tomllib
from importlib import resources

import numpy as np
import pytest

from epicyclic.losses.shaft_bearing import BearingLoad, CatalogueBearing, bearing_types
from epicyclic.losses.skf_2018 import (
    LEAST_SUPPLY,
    STARVATION,
    SkfModel,
    drag_variable,
    full_film_friction,
    seal_moment,
    skf_constants,
    skf_drag_moment,
    skf_load_variables,
    skf_moments,
    skf_series,
)
from epicyclic.oil.oil import OilState
from shaft_bearings import BALL, NEEDLE, PRINTED, ROLLER, RPM, SERIES, TAPER, skf

ALPHA_AND_ON = (17e-9, 0.035, 0.14, 1.0, 0.139, 0.047, 0.065)
"""What else an oil state has, of which SKF's model takes nothing."""


def test_reduction_factors_at_published_conditions():
    # bearing 61900 at 30,000 rpm in oil of 1 mm^2/s, starved as with grease; worked out separately
    bearing = CatalogueBearing("deep-groove", 10e-3, 22e-3, static_load_rating=1270.0)
    constants = skf_constants("deep-groove", "619")
    greased = SkfModel(constants, 0.05, STARVATION["grease"])
    hot, dry = greased.reduction_factors(bearing, 30_000 * RPM, 1e-6)
    assert hot == pytest.approx(0.96672563, rel=PRINTED)
    assert dry == pytest.approx(0.97951150, rel=PRINTED)
    model = SkfModel(constants, 0.05)
    moments = skf_moments(model, bearing, BearingLoad(500.0, 0.0), 30_000 * RPM, 1e-6)
    _, sliding = skf_load_variables(constants, bearing, BearingLoad(500.0, 0.0))
    share = (moments.sliding * 1e3 / sliding - 0.05) / (0.12 - 0.05)
    assert share == pytest.approx(0.46254314, rel=PRINTED)


@pytest.mark.parametrize(
    ("bearing", "radial", "axial", "rolling", "sliding"),
    [
        (BALL, 2000, 0, 0.07224325, 353.67133),
        (BALL, 2000, 500, 0.13950637, 599.44721),
        (ROLLER, 5000, 300, 0.29474857, 2362.3940),
        (TAPER, 5000, 1000, 0.67039340, 4002.6425),
    ],
)
def test_load_variables(bearing, radial, axial, rolling, sliding):
    constants = skf_constants(bearing.type, SERIES[bearing.type])
    found = skf_load_variables(constants, bearing, BearingLoad(radial, axial))
    assert found == pytest.approx((rolling, sliding), rel=PRINTED)


def test_moments_of_a_ball_bearing():
    moments = skf_moments(skf(BALL), BALL, BearingLoad(2000.0, 0.0), 3000 * RPM, 20e-6)
    assert moments.rolling * 1e3 == pytest.approx(47.771999, rel=PRINTED)
    assert moments.sliding * 1e3 == pytest.approx(17.695588, rel=PRINTED)
    assert moments.seal == moments.drag == 0.0


def test_sliding_of_balls_jumps_with_the_first_axial_force():
    # the two printed branches differ by d_m^(0.26 - 0.145) where they should meet
    constants = skf_constants("deep-groove", "62")
    _, alone = skf_load_variables(constants, BALL, BearingLoad(2000.0, 0.0))
    _, loaded = skf_load_variables(constants, BALL, BearingLoad(2000.0, 1e-9))
    assert loaded / alone == pytest.approx(60**0.115, rel=1e-9)  # F_a adds less than rounding


@pytest.mark.parametrize(
    ("bearing", "moment"), [(BALL, 12.800758), (ROLLER, 26.064672)], ids=["ball", "roller"]
)
def test_drag_in_an_oil_bath(bearing, moment):
    model = skf(bearing, oil_level=18e-3, drag_variable=0.0004)
    found = skf_drag_moment(model, bearing, 3000 * RPM, 20e-6)
    assert found * 1e3 == pytest.approx(moment, rel=PRINTED)


@pytest.mark.parametrize("bearing", [BALL, ROLLER, TAPER], ids=lambda b: b.type)
def test_drag_over_the_oil_level(bearing):
    levels = [0.0, 1e-6, 5e-3, 20e-3, 40e-3, 60e-3, 72e-3]
    drags = [skf_drag_moment(skf(bearing, oil_level=h), bearing, 3000 * RPM, 20e-6) for h in levels]
    assert drags[0] == 0.0
    assert drags[1] < 1e-4 * drags[-1]
    assert np.all(np.diff(drags) > 0)
    deeper = skf_drag_moment(skf(bearing, oil_level=1.0), bearing, 3000 * RPM, 20e-6)
    assert deeper == drags[-1]


def test_estimate_of_the_drag_variable():
    assert drag_variable(BALL, 0.0) == 0.0
    # half of 1.2 d_m, and all of it; rounding
    assert drag_variable(BALL, 36e-3) == pytest.approx(0.0006, rel=1e-12)
    assert drag_variable(BALL, 72e-3) == pytest.approx(0.0012, rel=1e-12)


def test_submerged_bearing_does_not_starve():
    load = BearingLoad(2000.0, 0.0)
    deep, dry = (
        skf_moments(skf(BALL, oil_level=level), BALL, load, 3000 * RPM, 20e-6).rolling
        for level in (72.1e-3, 0.0)
    )
    _, factor = skf(BALL).reduction_factors(BALL, 3000 * RPM, 20e-6)
    assert factor < 0.97
    assert dry / deep == pytest.approx(factor, rel=1e-12)  # rounding


def test_thick_oil_starves_films_no_more_than_to_the_largest_rolling():
    model, load, speed = skf(TAPER), BearingLoad(5000.0, 1000.0), 1500 * RPM
    _, at_40 = model.reduction_factors(TAPER, speed, 40e-6)
    largest = 40e-6 * -0.6 / math.log(at_40)  # viscosity at which phi_rs is e^-0.6, by (J8)

    def unheated(viscosity):
        hot, _ = model.reduction_factors(TAPER, speed, viscosity)
        return skf_moments(model, TAPER, load, speed, viscosity).rolling / hot

    assert unheated(largest) > max(unheated(0.97 * largest), unheated(1.03 * largest))
    assert model.supply(TAPER, speed, 40e-6) == at_40 > LEAST_SUPPLY
    assert model.supply(TAPER, speed, 50 * largest) == LEAST_SUPPLY == math.exp(-0.6)


def test_skf_says_what_rolling_could_be_in_thick_oil():
    load, speed = BearingLoad(5000.0, 1000.0), 1500 * RPM
    warm, cold = (OilState(300.0, nu, 880.0, 880 * nu, *ALPHA_AND_ON) for nu in (40e-6, 4e-3))
    assert skf(TAPER).flags("left", TAPER, load, speed, warm) == ()
    (flag,) = skf(TAPER).flags("left", TAPER, load, speed, cold)
    flooded, _ = skf(TAPER, oil_level=1.0).parts(TAPER, load, speed, cold)
    assert flag.quantity == "starvation factor of rolling"
    assert flag.could_be == pytest.approx(flooded.watts, rel=1e-12)  # rounding


def test_moment_of_contact_seals():
    # 0.028 45^2 N mm + 2 N mm
    moment = seal_moment(45e-3, 0.028, 2.0, 2e-3)
    assert moment * 1e3 == pytest.approx(58.7, rel=1e-12)  # rounding
    model = skf(BALL, seal_moment=moment)
    assert skf_moments(model, BALL, BearingLoad(0.0, 0.0), 10.0, 20e-6).seal == moment


@pytest.mark.parametrize("bearing", [BALL, ROLLER, TAPER], ids=lambda b: b.type)
def test_no_load_no_load_dependent_friction(bearing):
    moments = skf_moments(skf(bearing), bearing, BearingLoad(0.0, 0.0), 3000 * RPM, 20e-6)
    assert moments.rolling == moments.sliding == 0.0


@pytest.mark.parametrize("bearing", [BALL, ROLLER, TAPER], ids=lambda b: b.type)
@pytest.mark.parametrize("axial", [0.0, 500.0])
def test_friction_grows_with_the_load(bearing, axial):
    found = [
        skf_moments(skf(bearing), bearing, BearingLoad(force, axial), 3000 * RPM, 20e-6)
        for force in (100.0, 1000.0, 5000.0, 20_000.0)
    ]
    assert np.all(np.diff([moments.rolling for moments in found]) > 0)
    assert np.all(np.diff([moments.sliding for moments in found]) > 0)


def test_every_row_of_the_table_names_its_grade_and_source():
    text = resources.files("epicyclic.library").joinpath("bearings", "skf-2018.toml").read_text()
    table = tomllib.loads(text)
    for row in table["rows"]:
        assert row["grade"] in ("read", "second hand")
        assert row["source"]
        for series in row["series"]:
            cage = "full-complement" if series == "full-complement" else "caged"
            constants = skf_constants(row["type"], series, cage)
            assert constants.rolling_1 == row["rolling_1"]
            assert constants.is_read == (row["grade"] == "read")
    seen = [(row["type"], series) for row in table["rows"] for series in row["series"]]
    assert len(seen) == len(set(seen))


def test_constants_of_the_published_table():
    # a sample of each type: R1, R2, S1, S2, K_Z, K_L
    def row(*key):
        c = skf_constants(*key)
        return (
            c.rolling_1,
            c.rolling_2,
            c.sliding_1,
            c.sliding_2,
            c.bearing_factor,
            c.roller_length_factor,
        )

    assert row("deep-groove", "623") == (3.7e-7, 1.7, 2.84e-3, 92.8, 3.1, 0.0)
    assert row("cylindrical", "23") == (1.48e-6, 0.0, 0.16, 0.0015, 5.1, 0.65)
    assert row("cylindrical", "2", "full-complement") == (2.13e-6, 0.0, 0.16, 0.0015, 6.2, 0.7)
    assert row("tapered", "320X") == (2.38e-6, 10.9, 0.014, 2.0, 6.0, 0.7)
    assert skf_constants("deep-groove", "42").ball_rows == 2
    with pytest.raises(KeyError):
        skf_constants("cylindrical", "99")


def test_needle_rollers_have_no_row():
    assert skf_series("needle") == ()
    assert "needle" not in bearing_types("skf-2018")
    assert "needle" not in bearing_types("harris")
    assert "needle" in bearing_types("palmgren")
    with pytest.raises(ValueError, match="needle"):
        skf_load_variables(skf(BALL).constants, NEEDLE, BearingLoad(1000.0, 0.0))


def test_full_film_friction_by_oil():
    kinds = ("mineral", "pao", "atf")
    assert [full_film_friction("deep-groove", kind) for kind in kinds] == [0.05, 0.04, 0.10]
    assert full_film_friction("cylindrical", "atf") == 0.02
    assert full_film_friction("tapered", "pao") == 0.002
