"""Drag of open wet clutches and synchronizers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

import epicyclic as ep
from epicyclic.machine.clutch import film_drag

OIL = (0.0254, 851.0)  # dynamic viscosity [Pa s], density [kg/m^3]
FACE = (0.061, 0.077, 0.21e-3)  # inner and outer radius, gap [m]


def test_a_full_gap_shears_its_oil():
    torque, filled = film_drag(*OIL, (170.0, 20.0), *FACE)
    sheared = quad(lambda r: OIL[0] * 150.0 * r / FACE[2] * 2 * math.pi * r**2, *FACE[:2])[0]
    assert torque == pytest.approx(sheared)
    assert filled == 1


@pytest.mark.parametrize("speeds", [(170.0, 0.0), (170.0, 65.0), (130.0, -80.0)])
def test_the_flow_that_a_gap_draws_is_that_of_its_layers(speeds):
    """Poiseuille's profile under the centrifugal force of each layer, without pressure."""
    mean = quad(lambda s: 6 * s * (1 - s) * (speeds[0] * (1 - s) + speeds[1] * s) ** 2, 0, 1)[0]
    drawn = 2 * math.pi * FACE[1] ** 2 * FACE[2] ** 3 * OIL[1] * mean / (12 * OIL[0])
    assert film_drag(*OIL, speeds, *FACE, flow=1.001 * drawn)[1] == 1
    assert 0.999 < film_drag(*OIL, speeds, *FACE, flow=0.999 * drawn)[1] < 1


def test_beyond_the_radius_that_is_filled_the_share_falls_with_its_square():
    flow = 3.1e-6
    drawn = math.pi * OIL[1] * 170.0**2 * FACE[2] ** 3 / (20 * OIL[0])
    expected = quad(lambda r: min(1.0, flow / (drawn * r**2)) * r**3, *FACE[:2])[0]
    expected *= 2 * math.pi * OIL[0] * 170.0 / FACE[2]
    assert film_drag(*OIL, (170.0, 0.0), *FACE, flow=flow)[0] == pytest.approx(expected)


def test_drag_rises_to_a_peak_and_falls_with_the_speed():
    torques = [film_drag(*OIL, (w, 0.0), *FACE, flow=1e-6)[0] for w in np.linspace(5, 500, 60)]
    peak = int(np.argmax(torques))
    assert 0 < peak < 59
    assert np.all(np.diff(torques[: peak + 1]) > 0)
    assert np.all(np.diff(torques[peak:]) < 0)
    fast = [film_drag(*OIL, (w, 0.0), *FACE, flow=1e-6)[0] for w in (400.0, 800.0)]
    assert fast[0] == pytest.approx(2 * fast[1])


def test_a_cone_has_the_face_of_its_half_angle():
    flat, _ = film_drag(*OIL, (170.0, 0.0), *FACE)
    cone, _ = film_drag(*OIL, (170.0, 0.0), *FACE, slope=math.sin(math.radians(6.5)))
    assert cone == pytest.approx(flat / math.sin(math.radians(6.5)))


CLUTCH = {
    "between": ["P1.sun", "P3.ring"],
    "gaps": 10,
    "inner_diameter": "122 mm",
    "outer_diameter": "154 mm",
    "gap": "0.21 mm",
    "oil_flow": "0.9 l/min",
}


def test_an_open_clutch_of_a_gearbox_drags_and_a_closed_one_does_not():
    case = ep.load_case("train-8hp70")
    found = case.updated(
        {
            "clutches": {"K": CLUTCH},
            "lubricant": {"oil": "atf-dexron-vi"},
            "operation.oil_inlet_temperature": "60 degC",
        }
    )
    result = ep.solve(found)
    figures = result.parts["K.clutch"]
    assert result.losses["K.shear"] == pytest.approx(figures.friction_torque * figures.speed)
    assert figures.speed > 0
    assert 0 < figures.filled <= 1
    assert (
        ep.solve(found.updated({"clutches.K.oil_flow": "0.3 l/min"})).losses["K.shear"]
        < (result.losses["K.shear"])
    )
    unknown = ep.solve(found.updated({"clutches.K.oil_flow": None}))
    fewer = ep.solve(found.updated({"clutches.K.oil_flow": None, "clutches.K.gaps": 4}))
    assert unknown.losses["K.shear"] == pytest.approx(10 / 4 * fewer.losses["K.shear"], rel=1e-3)
    assert any("clutches.K.oil_flow is not given" in note for note in unknown.notes)
    assert unknown.losses["K.shear"] >= result.losses["K.shear"]


def test_diameters_that_contradict_each_other_are_told():
    with pytest.raises(ep.InputError, match="inner_diameter") as error:
        ep.load_case("train-8hp70").updated(
            {
                "clutches": {"K": CLUTCH | {"inner_diameter": "160 mm"}},
                "lubricant": {"oil": "atf-dexron-vi"},
                "operation.oil_inlet_temperature": "60 degC",
            }
        )
    assert "154 mm" in str(error.value)
