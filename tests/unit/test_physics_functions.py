"""The formulas that are public without a case, and that they are those of a case."""

import doctest
import importlib
import math

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.losses.friction import FrictionSettings, friction_model
from epicyclic.losses.windage import Teeth, Turning, drag
from epicyclic.oil.oil import mixture_state, oil_state

CONTACT = {
    "line_load": "210 N/mm",
    "radius": "11 mm",
    "rolling_speed": "6 m/s",
    "temperature": "65 degC",
    "oil": "iso-vg-68-mineral",
}


def test_the_examples_run():
    found = doctest.testmod(importlib.import_module("epicyclic.study.physics"))
    assert found.attempted > 10
    assert not found.failed


def test_arrays_are_broadcast_and_units_agree():
    speeds = np.array([[3.0], [8.0]])
    found = ep.friction(
        "mixed-lubrication",
        **CONTACT | {"rolling_speed": speeds, "temperature": [320.0, 350.0, 380.0]},
        sliding_speed=1.3,
    )
    assert found.shape == (2, 3)
    one = ep.friction(
        "mixed-lubrication",
        **CONTACT | {"rolling_speed": "8 m/s", "temperature": "76.85 degC"},
        sliding_speed="1300 mm/s",
    )
    assert one == pytest.approx(found[1, 1], rel=1e-12)


def test_loss_and_friction_of_a_mesh_are_those_of_its_contacts():
    case = ep.load_case(
        "talbot-2012", {"models.friction": "mixed-ehl", "numerics.mesh_positions": 4}
    )
    own = ep.mesh_contacts(case)["sun_mesh"]
    point = own.line_load.argmax()
    mu = ep.friction(
        "mixed-ehl",
        line_load=own.line_load[point],
        radius=own.radius[point],
        rolling_speed=own.rolling_speed[point],
        sliding_speed=own.sliding_speed[point],
        temperature=own.oil.temperature,
        oil="atf-talbot-2012",
        roughness1=own.flanks.roughness1,
        roughness2=own.flanks.roughness2,
        modulus=own.flanks.equivalent_modulus,
    )
    model = friction_model("mixed-ehl", FrictionSettings())
    assert mu == pytest.approx(model.coefficient(own)[point], rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"line_load": "210 mm"}, "line_load"),
        ({"radius": ["11 mm", "12"]}, "radius"),
        ({"oil": "iso-vg-69"}, "oil"),
    ],
)
def test_bad_arguments_are_named(changes, key):
    with pytest.raises(ep.InputError) as error:
        ep.line_contact(**CONTACT | changes)
    assert error.value.problems[0].key == key


def test_a_mean_of_a_mesh_is_no_model_of_a_contact():
    with pytest.raises(ep.InputError, match="benedict-kelley"):
        ep.friction("schlenk", **CONTACT, sliding_speed=1.0)


def test_teeth_of_a_gear_are_those_of_its_rack(make_gear):
    gear = make_gear(41, module=2.5e-3)
    r, face, omega = gear.tip_radius, gear.face_width, 930.0
    oil = ep.load_case("talbot-2012", {"lubricant.oil": "iso-vg-100-pao"}).lubricant.oil
    state = oil_state(oil, 341.0)
    air = mixture_state(state, 0.0, 101325.0)
    space = 2 * (math.pi / 41 - gear.half_angle_at(r))
    body = Turning(r, face, Teeth(41, gear.reference_radius, r, face, space))
    teeth = sum(drag(body, omega, air, air, state.dynamic_viscosity, "diab-ville-velex"))
    turning = {
        "diameter": 2 * r,
        "width": face,
        "speed": omega,
        "temperature": 341.0,
        "oil": "iso-vg-100-pao",
        "oil_share": 0.0,
    }
    assert ep.windage(**turning, teeth=41) == pytest.approx(teeth, rel=1e-9)
    assert ep.windage(**turning) < 0.5 * teeth
