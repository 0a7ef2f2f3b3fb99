"""The formulas that are public without a case, and that they are those of a case."""

import doctest
import importlib
import math

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.losses.friction import FrictionSettings, friction_model
from epicyclic.losses.rolling import ROLLING_MODELS
from epicyclic.losses.windage import Teeth, Turning, drag
from epicyclic.oil.oil import mixture_state, oil_state
from epicyclic.study.physics import LOCAL_FRICTION

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


AT = {"speed": "3000 rpm", "temperature": "80 degC", "oil": "iso-vg-100-pao"}
DISC = AT | {"diameter": "100 mm", "width": "20 mm"}
PIN = AT | {"diameter": "25 mm", "length": "25 mm", "clearance": "50 um", "force": "1 kN"}
FORCES = AT | {"radial_force": "1 kN", "axial_force": "1 kN"}


@pytest.mark.parametrize(
    ("function", "arguments", "key"),
    [
        (ep.line_contact, CONTACT | {"modulus": -1.0}, "modulus"),
        (ep.line_contact, CONTACT | {"modulus": math.nan}, "modulus"),
        (ep.line_contact, CONTACT | {"radius": []}, "radius"),
        (ep.oil_properties, {"oil": "iso-vg-100-pao", "temperature": []}, "temperature"),
        (ep.plain_pin, PIN | {"roughness": "0 um"}, "roughness"),
        (ep.plain_pin, PIN | {"conductance": -1}, "conductance"),
        (ep.plain_pin, PIN | {"conductance": math.inf}, "conductance"),
        (ep.windage, DISC | {"oil_share": "5 %"}, "oil_share"),
        (ep.windage, DISC | {"teeth": -30}, "teeth"),
        (ep.windage, DISC | {"teeth": 30.5}, "teeth"),
        (ep.windage, DISC | {"teeth": True}, "teeth"),
        (ep.windage, DISC | {"pitch_diameter": "90 mm"}, "pitch_diameter"),
        (ep.windage, DISC | {"teeth": 30, "pitch_diameter": "110 mm"}, "pitch_diameter"),
        (ep.bearing_loss, FORCES | {"designation": "51108"}, "radial_force"),
        (ep.bearing_loss, FORCES | {"designation": "NKI 40/30"}, "axial_force"),
        (ep.bearing_loss, FORCES | {"designation": "6208", "model": "zhou-hoeprich"}, "model"),
        (ep.bearing_loss, FORCES | {"designation": "6208", "model": "table"}, "model"),
    ],
)
def test_impossible_arguments_are_named(function, arguments, key):
    with pytest.raises(ep.InputError) as error:
        function(**arguments)
    assert [problem.key for problem in error.value.problems] == [key]


def test_arguments_that_were_numbers_may_be_texts_and_arrays():
    found = ep.plain_pin(**PIN, conductance=["0 W/K", "2 W/K"])
    assert found["temperature"][1] < found["temperature"][0]
    assert found["watts"][0] == ep.plain_pin(**PIN)["watts"]
    modulus = ep.line_contact(**CONTACT, modulus="220 GPa")
    assert modulus == ep.line_contact(**CONTACT, modulus=220e9)


@pytest.mark.parametrize("model", ["doleschel", "matsumoto"])
def test_separated_flanks_have_the_fluid_friction_of_a_case(model):
    smooth = {"roughness1": "0.001 um", "roughness2": "0.001 um", "sliding_speed": "1 m/s"}
    fluid = ep.load_case("talbot-2012").models.fluid_friction
    assert ep.friction(model, **CONTACT | smooth) == pytest.approx(fluid, rel=1e-3)


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


AT_REST = [(ep.friction, model) for model in LOCAL_FRICTION]
AT_REST += [(ep.rolling_loss, model) for model in ROLLING_MODELS if model != "fitted"]


@pytest.mark.parametrize(("function", "model"), AT_REST)
@pytest.mark.parametrize("sliding", [0.0, 1.0, 100.0])
def test_surfaces_that_do_not_roll_have_the_limit(function, model, sliding):
    contact = CONTACT | {"rolling_speed": [0.0, 1e-60, 1e-30], "sliding_speed": sliding}
    limit, near, _ = function(model, **contact)
    assert limit == pytest.approx(near, abs=1e-9)
    assert (function(model, **contact | {"line_load": 0.0}) >= 0.0).all()


def test_every_wrong_argument_of_a_contact_is_named():
    given = {"line_load": "300 N/mm", "rolling_speed": "8 m/s", "temperature": "80 degC"}
    with pytest.raises(ep.InputError) as caught:
        ep.friction("mixed-lubrication", **given, radius="12 mm", roughness="0.3 um", slip=0.2)
    assert [(it.key, it.remedy) for it in caught.value.problems] == [
        ("roughness", "Did you mean 'roughness1'?"),
        ("slip", "Give some of modulus, roughness1, roughness2, temperature, line_load, radius, "
         "rolling_speed, sliding_speed, oil."),
        ("oil", 'Give it: oil = "...".'),
    ]  # fmt: skip
