"""Rolling of tapered and cylindrical rollers and rib friction after Zhou and Hoeprich."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.kernels.line_contact import hertz_pressure, inlet_film_factor
from epicyclic.losses import zhou_hoeprich
from epicyclic.losses.drag import bearing_viscous_loss
from epicyclic.losses.shaft_bearing import BearingLoad, CatalogueBearing
from epicyclic.losses.skf_2018 import (
    SkfModel,
    skf_constants,
    skf_load_variables,
    skf_moments,
    skf_supply,
)
from epicyclic.losses.zhou_hoeprich import (
    RIB_ROUGHNESS,
    CylindricalModel,
    TaperedModel,
    cylindrical_rolling,
    roller_loads,
    rolling_force,
    rolling_moment,
    tapered_moments,
)
from epicyclic.oil.oil import OilState
from shaft_bearings import RPM


def lubricant(eta, nu, alpha, beta):
    return OilState(323.15, nu, eta / nu, eta, alpha, beta, 0.14, 1.0, 0.139, 0.047, 0.065)


def fva_3(celsius):
    """Reference oil FVA 3 as Wingertszahn et al. (2023) have it; alpha by Gold."""
    eta = 0.062e-3 * math.exp(1021.7 / (celsius + 101.55))
    nu = eta / (887.6 - 0.65 * (celsius - 15))
    return lubricant(eta, nu, 9.904e-9 * (nu * 1e6) ** 0.139, 1021.7 / (celsius + 101.55) ** 2)


SUPPLY = SkfModel(skf_supply("tapered"), 0.002)
LARGE = CatalogueBearing("tapered", 80e-3, 140e-3, 33e-3, axial_factor=1.4)
LARGE_MODEL = TaperedModel(
    16, 17e-3, 22.7e-3, 1.8e-3, RIB_ROUGHNESS, replace(SUPPLY, oil_level=8.5e-3)
)
SMALL = CatalogueBearing(
    "tapered", 22e-3, 45.2e-3, axial_factor=0.4 / math.tan(math.radians(11 + 32 / 60))
)
SMALL_MODEL = TaperedModel(17, 0.26 * 23.2e-3, 10.8e-3, 0.03 * 23.2e-3, RIB_ROUGHNESS, SUPPLY)
THIN = lubricant(4.6e-3, 5.5e-6, 12.6e-9, 0.023)
"""An oil of SAE 75W at 80 degC; its viscosity is a guess."""


def torque(model, bearing, load, rpm, oil):
    """[N mm]"""
    return 1e3 * sum(it.watts for it in model.parts(bearing, load, rpm * RPM, oil)) / (rpm * RPM)


def test_rolling_grows_as_the_printed_solutions():
    # Zhou and Hoeprich, Table 1: 2 F R_e of 0.0623 and 1.1290 at U = 1e-11 and 1e-9, and of 0.5485
    # and 0.6933 at W = 1e-4 and 3e-4, which their power law (17) smooths
    fast = rolling_force(1e-9, 3745, 2e-4) / rolling_force(1e-11, 3745, 2e-4)
    assert fast == pytest.approx(1.1290 / 0.0623, rel=0.10)
    loaded = rolling_force(3.5e-10, 3745, 3e-4) / rolling_force(3.5e-10, 3745, 1e-4)
    assert loaded == pytest.approx(0.6933 / 0.5485, rel=0.05)
    assert rolling_force(1e-10, 3745, 2e-4) == pytest.approx(
        29.2 * 3.745e-7**0.648 * 2e-4**0.246, rel=1e-12
    )


def test_half_of_the_rollers_carry_at_the_printed_ratio():
    # line contact, epsilon = 0.5: F_a = 1.260 F_r tan(alpha), Q_max = 4.08 F_r/(z cos(alpha)), NSK
    loads = roller_loads(1 / 1.260, 2000)
    assert sum(load > 0 for load in loads) == pytest.approx(1000, abs=10)
    assert max(loads) == pytest.approx(4.08 / 1.260, rel=0.005)
    assert sum(loads) == pytest.approx(2000, rel=1e-12)


@pytest.mark.parametrize("size", ["30208", "32216"])
def test_a_tapered_bearing_loses_the_mean_over_all_positions_of_its_rollers(size):
    """With one roller under the load, 6e-6 more of it took the last one its load, and 0.7 %."""
    force = [f"{newton!r} N" for newton in np.linspace(3000.0, 5000.0, 801).tolist()]
    found = ep.bearing_loss(
        size, speed="3000 rpm", temperature="70 degC", oil="iso-vg-220-mineral",
        radial_force=force, axial_force="1.5 kN",
    )  # fmt: skip
    assert np.abs(np.diff(found)).max() < 0.004 * found.mean()


def test_rib_friction_at_creep_is_the_starting_torque():
    # Aihara (1987), Eq. 11: M = e mu F_a cos(beta), mu = 0.2
    moments = tapered_moments(LARGE_MODEL, LARGE, BearingLoad(0.0, 6000.0), 1e-9, fva_3(50))
    assert moments.rib == pytest.approx(1.8e-3 * 0.2 * 6000, rel=0.02)
    # and 0.15 G_sl of SKF's series 322, from which the height on the rib comes
    _, sliding = skf_load_variables(
        skf_constants("tapered", "322"), LARGE, BearingLoad(0.0, 6000.0)
    )
    assert moments.rib == pytest.approx(0.15e-3 * sliding, rel=0.12)


def test_rib_and_raceways_cross_where_printed():
    # Zhou and Hoeprich, Fig. 9: the raceways are the larger part above 1600 rpm
    slow, fast = (
        tapered_moments(SMALL_MODEL, SMALL, BearingLoad(0.0, 3600.0), rpm * RPM, THIN)
        for rpm in (1600 / 1.3, 1600 * 1.3)
    )
    assert slow.rib > slow.rolling
    assert fast.rib < fast.rolling


def test_measured_torque_of_a_32216():
    # Wingertszahn et al., Lubricants 11 (2023) 369, read from figures: F_r, degC, rpm, N mm
    measured = (
        (0, 50, 500, 1300), (0, 50, 2000, 2950), (0, 50, 4000, 3750), (0, 42, 500, 1700),
        (6500, 50, 500, 1500), (6500, 50, 1000, 1950), (6500, 50, 2000, 2500),
        (6500, 50, 4000, 3250), (6500, 42, 500, 2000), (6500, 42, 1000, 2650),
        (6500, 42, 2000, 3500), (6500, 42, 4000, 4450),
    )  # fmt: skip
    errors = [
        torque(LARGE_MODEL, LARGE, BearingLoad(force, 6000.0), rpm, fva_3(celsius)) / found - 1
        for force, celsius, rpm, found in measured
    ]
    assert np.abs(errors).mean() < 0.12
    assert abs(np.mean(errors)) < 0.05


def test_cold_oil_makes_a_bearing_harder_to_turn():
    # moments of the theory page, without the bath: [N mm]
    model, load = replace(LARGE_MODEL, skf=SUPPLY), BearingLoad(0.0, 6000.0)
    found = [torque(model, LARGE, load, 1000, fva_3(celsius)) for celsius in (50, 20, 0, -20)]
    assert found == pytest.approx([2220, 3510, 5320, 5550], rel=3e-3)  # printed digits


def test_tapered_moments_vanish_with_the_load_and_grow_with_it():
    moments = [
        tapered_moments(LARGE_MODEL, LARGE, BearingLoad(radial, axial), 100.0, fva_3(50))
        for radial, axial in ((0.0, 0.0), (0.0, 1.0), (0.0, 1e3), (1e3, 0.0), (2e4, 2e4))
    ]
    assert moments[0].rolling == moments[0].rib == 0
    assert 0 < moments[1].rolling < moments[2].rolling < moments[4].rolling
    assert moments[3].rolling > 0


def test_auto_takes_the_rib_where_the_width_is_known():
    tapered = {
        "bearings.output_rear.type": "tapered", "bearings.output_rear.contact_angle": "14 deg"
    }  # fmt: skip
    case = ep.load_case("train-eaxle").updated(tapered)
    without = ep.solve(case)
    assert any("W after palmgren" in note for note in without.warnings)
    assert "output_rear.viscous" in without.losses
    wide = case.updated(
        {
            "bearings.output_rear.bore": "200 mm",
            "bearings.output_rear.outside_diameter": "260 mm",
            "bearings.output_rear.width": "30 mm",
        }
    )
    result = ep.solve(wide)
    watts = result.losses["output_rear.mechanical"]
    (told,) = (note for note in result.warnings if "bore 200 mm" in note)
    assert f"zhou-hoeprich (output_rear: output_rear) 100 %; {watts:.3g} W in all" in told


NJ = CatalogueBearing("cylindrical", 30e-3, 90e-3, 23e-3)
NJ_MODEL = CylindricalModel(
    9, 16.5e-3, 15e-3, 3.0, SkfModel(skf_constants("cylindrical", "4"), 0.02)
)
GEAR_OIL = lubricant(40e-3, 47e-6, 17e-9, 0.035)


def test_rollers_of_a_cylindrical_bearing_carry_its_force(monkeypatch):
    given = []
    monkeypatch.setattr(zhou_hoeprich, "rolling_moment", lambda *args: given.extend(args[3]) or 0.0)
    cylindrical_rolling(NJ_MODEL, NJ, 2000.0, 100.0, GEAR_OIL)
    upright = [force * math.cos(2 * math.pi * k / len(given)) for k, force in enumerate(given)]
    # 9 rollers in all positions carry 2 kN, the most loaded 4.08 F_r/z of half of them (NSK)
    assert sum(upright) * 9 / len(given) == pytest.approx(2000.0, rel=1e-12)
    assert max(given) == pytest.approx(4.08 * 2000.0 / 9, rel=0.005)


def test_rolling_of_cylindrical_rollers_on_two_equal_raceways():
    # one of many small rollers, by hand: both races have nearly the radius of the pitch circle
    model = replace(NJ_MODEL, rollers=1, roller_diameter=1e-6)
    speed, force = 100.0, 50.0
    moment = rolling_moment(model, NJ, 0.0, np.array([force]), speed, GEAR_OIL)
    radius, R, u = 30e-3, 0.5e-6, speed * 15e-3
    E = 206e9 / (1 - 0.3**2)
    own = rolling_force(40e-3 * u / (E * R), 17e-9 * E, force / 15e-3 / (E * R))
    heat = inlet_film_factor(GEAR_OIL.thermal_load(u), hertz_pressure(force / 15e-3, R, E) / E, 0.0)
    _, starved = NJ_MODEL.skf.reduction_factors(NJ, speed, 47e-6)
    assert moment == pytest.approx(2 * own * heat * R / 17e-9 * 15e-3 * radius * starved, rel=1e-3)


@pytest.mark.parametrize("force", [0.0, 2.0, 2000.0])
def test_an_idle_cylindrical_bearing_loses_its_viscous_moment(force):
    speed, load = 1000 * RPM, BearingLoad(force, 0.0)
    watts = {it.key: it.watts for it in NJ_MODEL.parts(NJ, load, speed, GEAR_OIL)}
    assert watts["viscous"] == bearing_viscous_loss(3.0, 47e-6, speed, 60e-3)
    moments = skf_moments(NJ_MODEL.skf, NJ, load, speed, 47e-6)
    loaded = cylindrical_rolling(NJ_MODEL, NJ, force, speed, GEAR_OIL) + moments.sliding
    assert sum(watts.values()) == pytest.approx(max(watts["viscous"], loaded * speed), rel=1e-12)
    assert (watts["mechanical"] > 0) == (force > 100)
