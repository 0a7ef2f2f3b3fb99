"""Churning and jets: printed formulas worked out step by step, limits, trends and ranges."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from epicyclic.losses.drag import (
    Dipped,
    SumpOil,
    acceleration_parameter,
    changenet_velex,
    churning_flags,
    displaced,
    iso_14179_1,
    jet_loss,
    wetted_area,
)

GEAR = Dipped(
    radius=46.5e-3,
    tip_radius=50.2e-3,
    width=22e-3,
    depth=27e-3,
    module=3e-3,
    teeth=31,
    tooth_height=7.3e-3,
    pressure_angle=math.radians(20),
    helix_angle=math.radians(14),
)
OIL = SumpOil(density=842.0, kinematic_viscosity=37e-6, volume=1.7e-3)
DISC = replace(GEAR, teeth=0)


def test_wetted_faces_rim_and_flanks():
    """h/d_a 0.26892, theta 1.09038: 29.430 + 22.309 + 37.903 cm2."""
    assert wetted_area(GEAR) * 1e4 == pytest.approx(29.430 + 22.309 + 37.903, abs=2e-3)
    assert wetted_area(DISC) * 1e4 == pytest.approx(29.430 + 22.309, abs=2e-3)


def test_a_body_wholly_under_oil_is_wet_all_over():
    whole = replace(DISC, depth=0.4, radius=50.2e-3)
    assert wetted_area(whole) == pytest.approx(
        2 * math.pi * 50.2e-3**2 + 2 * math.pi * 50.2e-3 * 22e-3
    )
    assert wetted_area(replace(DISC, depth=0.0)) == 0


SLOW = {  # 1.366 (h/d_a)^0.45 (V_0/D^3)^0.1 Fr^-0.6 Re^-0.21
    120.0: 1.366 * 0.553775 * 1.077705 * 0.0793274 * 0.182230,
    262.0: 1.366 * 0.553775 * 1.077705 * 0.0310799 * 0.154670,
}
FAST = {  # 3.644 (h/d_a)^0.1 (V_0/D^3)^-0.35 Fr^-0.88 (b/D)^0.85
    400.0: 3.644 * 0.876926 * 0.769573 * 0.00292115 * 0.293663,
    262.0: 3.644 * 0.876926 * 0.769573 * 0.00615133 * 0.293663,
}


@pytest.mark.parametrize(
    ("speed", "parameter", "coefficient"),
    [
        (120.0, 209.264, SLOW[120.0]),
        (400.0, 2325.157, FAST[400.0]),
        (262.0, 997.550, 0.504899 * SLOW[262.0] + 0.495101 * FAST[262.0]),
    ],
)
def test_torque_of_changenet_and_velex_by_hand(speed, parameter, coefficient):
    """V0/D^3 2.113489; Fr 68.2802, 325.488, 758.669; Re 3317.84, 7243.95."""
    assert acceleration_parameter(GEAR, speed) == pytest.approx(parameter, rel=1e-6)
    area, cube = 89.6421e-4, 46.5e-3**3
    by_hand = 842 * speed**2 * area * cube * coefficient / 2
    assert changenet_velex(GEAR, speed, OIL) == pytest.approx(by_hand, rel=1e-5)
    assert changenet_velex(GEAR, -speed, OIL) == changenet_velex(GEAR, speed, OIL)


def test_power_of_iso_14179_1_by_hand():
    """n 3819.72 rpm, m_t 3.09184, c 12.8707; the faces 0.0028 kW, the teeth 0.1558 kW."""
    speed = 400.0
    group = 0.268924 * 37 * 3819.7186**3 / (0.2 * 1e26)
    faces, rim = 1.474 * group * 100.4**5.7, 7.37 * group * 100.4**4.7 * 22
    watts = 1e3 * (faces + 12.870687 * rim)
    assert iso_14179_1(GEAR, speed, OIL) * speed == pytest.approx(watts, rel=1e-5)
    assert watts == pytest.approx(158.6, abs=0.05)
    assert iso_14179_1(DISC, speed, OIL) * speed == pytest.approx(1e3 * (faces + rim), rel=1e-5)


def test_the_standard_takes_ten_degrees_at_least():
    spur, slight = (replace(GEAR, helix_angle=math.radians(angle)) for angle in (0, 9))
    module = 3e-3 / math.cos(math.radians(9))
    same = replace(spur, module=module)
    assert iso_14179_1(same, 250.0, OIL) == pytest.approx(iso_14179_1(slight, 250.0, OIL))


@pytest.mark.parametrize("model", [changenet_velex, iso_14179_1])
@pytest.mark.parametrize("speed", [90.0, 260.0, 900.0])
def test_deeper_wider_and_faster_churns_more(model, speed):
    torque = model(GEAR, speed, OIL)
    for more in (replace(GEAR, depth=31e-3), replace(GEAR, width=29e-3)):
        assert model(more, speed, OIL) > torque
    assert model(GEAR, 1.05 * speed, OIL) * 1.05 > torque
    assert model(replace(GEAR, depth=0.0), speed, OIL) == 0
    assert model(GEAR, 0.0, OIL) == 0


def test_viscosity_matters_in_the_slow_regime_only():
    thick = replace(OIL, kinematic_viscosity=2 * 37e-6)
    slow, fast = 100.0, 500.0
    ratio = changenet_velex(GEAR, slow, thick) / changenet_velex(GEAR, slow, OIL)
    assert ratio == pytest.approx(2**0.21)
    assert changenet_velex(GEAR, fast, thick) == changenet_velex(GEAR, fast, OIL)


@pytest.mark.parametrize("limit", [750.0, 1250.0])
def test_regimes_join(limit):
    speed = math.sqrt(limit / acceleration_parameter(GEAR, 1.0))
    below, above = (changenet_velex(GEAR, speed * (1 + e), OIL) for e in (-1e-9, 1e-9))
    assert below == pytest.approx(above, rel=1e-7)


def test_what_leaves_its_range_is_flagged():
    def flags(model, part, speed, volume=1.7e-3):
        return churning_flags(model, "gear", part, speed, volume)

    assert flags("changenet-velex", GEAR, 300.0) == ()
    deep = replace(GEAR, depth=60e-3)
    (flag,) = flags("changenet-velex", deep, 300.0)
    assert flag.quantity == "immersion depth over the diameter"
    assert flag.found_high == pytest.approx(60 / 100.4)
    (flag,) = flags("changenet-velex", replace(GEAR, radius=20e-3), 300.0)
    assert (flag.quantity, flag.low) == ("immersed pitch diameter", 50.0)
    (flag,) = flags("iso-14179-1", GEAR, 500.0)
    assert flag.found_high == pytest.approx(500 * 50.2e-3)
    (flag,) = flags("iso-14179-1", replace(GEAR, module=0.6e-3), 300.0)
    assert flag.quantity == "transverse module"
    assert iso_14179_1(replace(GEAR, module=0.5e-3), 300.0, OIL) > 0
    assert flags("changenet-velex", deep, 0.0) == ()
    # a gear that dips to its axis displaces half a cylinder
    half = replace(GEAR, depth=GEAR.tip_radius)
    assert displaced(half) == pytest.approx(math.pi * 50.2e-3**2 * 22e-3 / 2)
    (flag,) = flags("changenet-velex", half, 300.0, 0.9 * displaced(half))
    assert flag.found_low == pytest.approx(0.9)
    assert flags("changenet-velex", half, 300.0, 1.1 * displaced(half)) == ()


def test_momentum_of_jets_by_hand():
    """831 kg/m3 x 3 l/min = 0.04155 kg/s on teeth of 42 m/s, jet of 17 m/s."""
    found = {
        side: jet_loss(831.0, 3e-3 / 60, 42.0, 17.0, side)
        for side in ("in-mesh", "radial", "out-of-mesh")
    }
    assert found == pytest.approx(
        {
            "in-mesh": 0.04155 * 42 * 25,
            "radial": 0.04155 * 42 * 42,
            "out-of-mesh": 0.04155 * 42 * 59,
        }
    )
    assert jet_loss(831.0, 3e-3 / 60, 12.0, 17.0, "in-mesh") == 0
