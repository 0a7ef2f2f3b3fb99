"""Balls that roll after Houpert and slide by mixed friction, and rollers of thrust bearings."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.build.elements import build_element
from epicyclic.case.tables.elements import ShaftBearingTable
from epicyclic.losses.houpert import CURVATURE, ball_loads, ball_moments, point_rolling_force
from epicyclic.losses.shaft_bearing import BearingLoad, PalmgrenModel
from epicyclic.losses.skf_2018 import LEAST_SUPPLY, SkfModel, skf_constants, skf_moments
from epicyclic.losses.zhou_hoeprich import POSITIONS, rolling_moment, thrust_sliding
from epicyclic.oil.oil import oil_state
from epicyclic.study.physics import _oil
from shaft_bearings import RPM

OIL = _oil("iso-vg-100-pao")
WARM = oil_state(OIL, 343.15)


def built(**keys):
    table = ShaftBearingTable.model_validate({"shaft": "shaft", **keys})
    assert list(table.problems()) == []
    return build_element("bearings", "b", table, shafts={"shaft": "s"}, oil=OIL, folder=Path())


def test_rolling_force_is_the_printed_one():
    # Biboulet and Houpert (2010), p. 783: Houpert's elastic force is 0.734 times 10.9e-9 at
    # kappa = 0.01, U = 1e-11, W = 1e-5, G = 4000; here with the load 1e3 times as large
    flatness = np.array([(1 / 1.0339 / 0.01) ** (1 / 0.636)])
    force = point_rolling_force(np.array([1e-11]), np.array([1e-2]), 4000.0, flatness)
    assert force[0] == pytest.approx(0.734 * 10.9e-9 * 1e3**0.466, rel=0.02)
    # light and fast, Eq. 28
    rigid = point_rolling_force(np.array([1e-10]), np.array([1e-11]), 4000.0, np.array([20.0]))
    printed = 0.835 * 20**0.358 * 1e-10**0.636 * 1e-11**0.364
    assert rigid[0] == pytest.approx(printed, rel=0.01)


def test_half_of_the_balls_carry_at_the_printed_ratio():
    # point contact, epsilon = 0.5: F_a = 1.216 F_r tan(alpha), Q_max = 4.37 F_r/(z cos(alpha)), NSK
    radial = ball_loads(BearingLoad(1e3, 0.0), 0.0, 10)
    assert radial.max() == pytest.approx(437, rel=0.005)
    alpha = math.radians(30)
    both = ball_loads(BearingLoad(1e3, 1216 * math.tan(alpha)), alpha, 10)
    assert both.max() == pytest.approx(437 / math.cos(alpha), rel=0.005)
    assert (both > 1).sum() == pytest.approx(POSITIONS / 2, abs=2)
    # less axial force than that needs leaves the loads as they are, more relieves none
    around = np.cos(2 * math.pi * np.arange(POSITIONS) / POSITIONS)
    for axial in (1.0, 700.0, 3000.0):
        loads = ball_loads(BearingLoad(1e3, axial), alpha, 10) * 10 / POSITIONS
        assert (loads * around).sum() * math.cos(alpha) == pytest.approx(1e3, rel=1e-9)
    assert loads.sum() * math.sin(alpha) == pytest.approx(3000, rel=1e-9)


def test_mean_slip_of_a_curved_contact():
    # strips of an ellipse carry 3/4 (1 - y^2); half of the load is within y = 0.347
    y = np.linspace(-1, 1, 200_001)
    strips = 0.75 * (1 - y**2)
    mean = np.trapezoid(strips * np.abs(y**2 - 0.3473**2), y)
    assert mean / 2 == pytest.approx(CURVATURE, rel=1e-3)


def test_deep_groove_balls_lose_what_a_catalogue_has():
    # SKF's model was made for them and is none of this one's sources
    errors = []
    for name, series in (("6006", "60"), ("6208", "62"), ("6308", "63")):
        own = built(designation=name, radial_force="1 kN")
        skf = SkfModel(skf_constants("deep-groove", series), 0.04)
        for share in (0.02, 0.1):
            load = BearingLoad(share * own.bearing.static_load_rating, 0.0)
            for rpm in (500, 2000, 6000):
                moments = ball_moments(own.model, own.bearing, load, rpm * RPM, WARM)
                nu = WARM.kinematic_viscosity
                printed = skf_moments(skf, own.bearing, load, rpm * RPM, nu)
                found = moments.rolling + moments.sliding
                errors.append(found / (printed.rolling + printed.sliding) - 1)
    assert np.abs(errors).mean() < 0.15
    assert np.abs(errors).max() < 0.30


def test_moments_vanish_with_the_load_and_grow_with_it():
    own = built(designation="7208B", radial_force="0 N", axial_force="1 kN")
    loads = ((0.0, 0.0), (0.0, 1.0), (0.0, 1e3), (1e3, 0.0), (1e4, 1e4))
    found = [
        sum(part.watts for part in own.model.parts(own.bearing, BearingLoad(*load), speed, WARM))
        for load in loads
        for speed in (-200.0, 200.0)
    ]
    assert found[0] == 0
    assert found[::2] == found[1::2]
    assert 0 < found[2] < found[4] < found[8]
    assert found[6] > 0
    still = own.model.parts(own.bearing, BearingLoad(1e3, 1e3), 0.0, WARM)
    assert [part.watts for part in still] == [0.0, 0.0]
    assert own.model.flags("b", own.bearing, BearingLoad(1e3, 1e3), 0.0, WARM) == ()


def test_fast_thick_oil_is_flagged_and_an_oil_bath_drags():
    own = built(designation="6208", radial_force="1 kN", lubrication="oil-bath", oil_level="20 mm")
    assert own.model.parts(own.bearing, BearingLoad(1e3, 0.0), 200.0, WARM)[1].watts > 0
    cold = oil_state(OIL, 283.15)
    (flag,) = own.model.flags("b", own.bearing, BearingLoad(1e3, 0.0), 400.0, cold)
    assert "dimensionless speed" in str(flag)
    starved = own.model.parts(own.bearing, BearingLoad(1e3, 0.0), 400.0, cold)[0].watts
    assert 1.1 * starved < flag.could_be < starved / LEAST_SUPPLY
    cool = oil_state(OIL, 318.15)
    (flag,) = own.model.flags("b", own.bearing, BearingLoad(1e3, 0.0), 400.0, cool)
    assert flag.could_be == 0  # it starves as SKF has it
    assert own.model.flags("b", own.bearing, BearingLoad(1e3, 0.0), 100.0, WARM) == ()


def test_thrust_rollers_roll_and_slide():
    own = built(designation="81107", axial_force="7 kN")
    model, bearing = own.model, own.bearing
    assert (model.rollers, model.roller_diameter) == (18, pytest.approx(4.93e-3))
    # at creep asperities carry all
    creep = thrust_sliding(model, bearing, 7e3, 1e-6, WARM)
    assert creep == pytest.approx(WARM.boundary_friction * 7e3 * model.roller_length / 4, rel=1e-3)
    sliding = thrust_sliding(model, bearing, 7e3, 30.0, WARM)
    assert sliding < creep
    rolling = rolling_moment(model, bearing, math.pi / 2, np.array([7e3 / 18]), 30.0, WARM)
    mechanical, drag = model.parts(bearing, BearingLoad(0.0, 7e3), 30.0, WARM)
    assert mechanical.watts == pytest.approx(30 * (sliding + rolling), rel=1e-12)
    assert drag.watts == 0


def test_auto_takes_balls_unless_f0_or_f1_is_stated():
    ball = {"designation": "51107", "axial_force": "1 kN"}
    assert built(**ball).model.balls == 18
    stated = built(**ball, rollers=20, roller_diameter="6.35 mm").model
    assert (stated.balls, stated.ball_diameter) == (20, pytest.approx(6.35e-3))
    angular = {"designation": "7208B", "radial_force": "1 kN", "roller_diameter": "11 mm"}
    assert built(**angular, rollers=14).model.balls == 14
    for own, key in ((angular, "roller_length"), (ball, "rib_height")):
        table = ShaftBearingTable.model_validate({"shaft": "shaft", **own, key: "5 mm"})
        assert [problem.key for problem in table.problems()] == [key]
    for key in ("viscous_factor", "palmgren_coefficient"):
        assert isinstance(built(**ball, **{key: 0.001}).model, PalmgrenModel)
    chosen = built(**ball, viscous_factor=1.0, model="houpert").model
    assert chosen.name == "houpert"
    loss = ep.bearing_loss(
        "51107", speed="600 rpm", temperature="70 degC", oil=OIL.name, radial_force="0 N",
        axial_force="1 kN",
    )  # fmt: skip
    own = built(**ball)
    parts = own.model.parts(own.bearing, BearingLoad(0.0, 1e3), 600 * RPM, WARM)
    assert loss == pytest.approx(sum(part.watts for part in parts))
