"""Whatever the operating point, the results make physical sense."""

from __future__ import annotations

import json
import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import epicyclic as ep
from asymmetric import oil_table
from epicyclic import library
from epicyclic.units import Length

MEMBERS = ("sun", "ring", "carrier")
FRICTION = [
    "auto",
    "mixed-ehl",
    "schlenk",
    "niemann-winter",
    "benedict-kelley",
    "matsumoto",
    "doleschel",
    "xu-2007",
    "constant",
]


def log_uniform(low, high):
    return st.floats(math.log(low), math.log(high)).map(math.exp)


def signed(magnitudes):
    return st.tuples(st.sampled_from([1.0, -1.0]), magnitudes).map(lambda pair: pair[0] * pair[1])


def quantity(numbers, unit):
    return numbers.map(lambda value: f"{value!r} {unit}")


TORQUE = quantity(st.one_of(st.just(0.0), signed(log_uniform(1e-9, 1e6))), "N*m")
SPEED = quantity(st.one_of(st.just(0.0), signed(log_uniform(1e-2, 3e4))), "rpm")
TEMPERATURE = quantity(st.floats(-40.0, 200.0), "degC")
ROUGHNESS = quantity(log_uniform(0.005, 100.0), "um")
THICKEST_OIL = oil_table(
    "like ISO VG 1000", "mineral", {40: 1000, 100: 52}, (15, 920), (9.904, 0.139)
)
MODELS = {
    "lubricant.oil": st.sampled_from([*library.names("oils"), THICKEST_OIL]),
    "models.friction": st.sampled_from(FRICTION),
    "models.rolling": st.sampled_from(["auto", "mixed-ehl", "goksem-hargreaves"]),
    "models.load_distribution": st.sampled_from(["uniform", "minimum-energy"]),
    "models.mesh": st.sampled_from(["local", "loss-factor"]),
}
COMMON = {
    "operation.torque": TORQUE,
    "operation.speed": SPEED,
    "operation.oil_inlet_temperature": TEMPERATURE,
    "surroundings.oil_air_ratio": st.floats(0.0, 1.0),
    "numerics.mesh_positions": st.integers(4, 30),
    "numerics.contact_segments": st.integers(2, 30),
    **MODELS,
}
DRIVES = st.permutations(MEMBERS).flatmap(
    lambda order: st.one_of(
        st.just({"operation.input": order[0], "operation.fixed": order[1]}),
        quantity(signed(log_uniform(1.0, 1e4)), "rpm").map(
            lambda speed: {
                "operation.input": order[0],
                "operation.fixed": None,
                "operation.second_input": order[1],
                "operation.second_speed": speed,
            }
        ),
    )
)


PLANETARY = st.fixed_dictionaries(
    {
        **COMMON,
        "planet.count": st.integers(1, 6),
        "sun.roughness": ROUGHNESS,
        "planet.roughness": ROUGHNESS,
        "planet_bearing.diametral_clearance": quantity(st.floats(0.0, 60.0), "um"),
        "planet_bearing.rows": st.integers(1, 2),
        "planet_bearing.rollers_per_row": st.integers(3, 20),
        "numerics.bearing_slices": st.integers(3, 30),
        "models.bearing": st.sampled_from(["auto", "mixed-ehl", "palmgren"]),
    }
)
PAIR = st.fixed_dictionaries({**COMMON, "pinion.roughness": ROUGHNESS, "gear.roughness": ROUGHNESS})
SIZES = st.sampled_from([0.1, 1.0, 10.0])


@cache
def sized(name, size):
    """A built-in case with all lengths but roughness multiplied by `size`."""
    tables = library.builtin_case(name)
    for table in tables.values():
        for key, value in table.items() if isinstance(table, dict) else ():
            number, _, unit = str(value).partition(" ")
            if unit == "mm":
                table[key] = f"{size * float(number)!r} mm"
    # what is asserted here holds for flows of any resolution
    tables["numerics"] = {"pocket_slices": 6, "pocket_steps": 10}
    return ep.load_case(tables)


def scaled_torque(changes, size):
    """`changes` with a torque that loads gears of `size` as the same torque loads the original."""
    torque = float(changes["operation.torque"].split()[0])
    return {**changes, "operation.torque": f"{size**3 * torque!r} N*m"}


def assert_sensible(result):
    for name, loss in result.losses.items():
        assert math.isfinite(loss), name
        assert loss >= 0.0, name
    powers = [member.power for member in result.flow.members.values()]
    assert all(math.isfinite(power) for power in powers)
    # rounding of powers far larger than the loss
    size = max(1.0, result.total, *map(abs, powers))
    assert sum(powers) == pytest.approx(result.total, abs=1e-9 * size)
    assert result.total == pytest.approx(result.load_dependent + result.load_independent, rel=1e-12)
    assert result.input_power >= 0.0
    if result.efficiency is not None:
        assert 0.0 <= result.efficiency <= 1.0
    for flag in result.flags:
        assert 0.0 <= flag.share <= 1.0
    parsed = json.loads(result.to_json())
    assert parsed["losses"].keys() == result.losses.keys()
    assert parsed["status"] == ("unphysical" if flattened(result) else "converged")
    for mesh in result.meshes.values():
        if mesh.contact is not None:
            # dry steel has some 0.2, and no model knows more than that and its factor of roughness
            assert 0.0 < mesh.friction_mean < 0.5
            assert mesh.hertz_pressure_max > 0.0
    assert_rolling_is_bounded(result)


def flattened(result):
    """Whether contacts are pressed flat over more than their radius: Hertz, p = E' b / (4 R)."""
    modulus = 207e9 / (1.0 - 0.3**2)
    bearings = [result.bearing] if result.bearing is not None else []
    contacts = [*result.meshes.values(), *bearings]
    return any(4.0 * contact.hertz_pressure_max > modulus for contact in contacts)


def assert_rolling_is_bounded(result):
    """Each rolling model in what its theory page says it cannot exceed."""
    count = result.inputs["planet"]["count"] if result.kind == "planetary" else 1
    for name, mesh in result.meshes.items():
        if mesh.contact is None:
            continue
        contact, loss = mesh.contact, result.losses[f"{name}_rolling"] / count
        power = (contact.line_load * contact.rolling_speed * contact.weight).sum()
        if result.models["rolling"] == "mixed-ehl":
            # 0.0925 at the worst corner of Table 5.1, with the oil's data of 25 to 100 degC
            assert loss <= 0.1 * power
        elif result.models["rolling"] == "goksem-hargreaves":
            # rigid cylinders, Martin: force 2 x 2.0796 sqrt(mu u W')
            rigid = contact.rolling_speed * np.sqrt(
                contact.oil.dynamic_viscosity * contact.rolling_speed * contact.line_load
            )
            assert loss <= 4.1593 * (rigid * contact.weight).sum()
    if result.bearing is not None and result.models["bearing"] == "mixed-ehl":
        table, bearing = result.inputs["planet_bearing"], result.bearing
        pin, roller, length = (LENGTH.parse(table[key]) for key in LENGTHS)
        intensity = bearing.loads.intensity
        load = intensity.sum() * length / intensity.shape[2]
        surface_speed = (pin + roller) * bearing.speed / 4
        loss = result.losses["planet_bearing_mechanical"] / count
        # 0.365 at the worst corner of Table 3.1; 0.38 leaves the clearance in the pitch diameter
        assert loss <= 0.38 * load * surface_speed


LENGTHS = ("pin_diameter", "roller_diameter", "roller_length")
LENGTH = Length.__metadata__[0]


@pytest.mark.slow
@settings(max_examples=200)
@given(changes=PLANETARY, drive=DRIVES, size=SIZES)
def test_many_planetary_results_make_sense(changes, drive, size):
    case = sized("talbot-2012", size)
    assert_sensible(ep.solve(case.updated({**scaled_torque(changes, size), **drive})))


@pytest.mark.slow
@settings(max_examples=150)
@given(changes=PAIR, size=SIZES)
def test_many_pair_results_make_sense(changes, size):
    pair = sized("talbot-2012-pair", size)
    assert_sensible(ep.solve(pair.updated(scaled_torque(changes, size))))


@settings(max_examples=20)
@given(changes=PLANETARY, drive=DRIVES, size=SIZES)
def test_planetary_results_make_sense(changes, drive, size):
    case = sized("talbot-2012", size)
    assert_sensible(ep.solve(case.updated({**scaled_torque(changes, size), **drive})))


@settings(max_examples=20)
@given(changes=PAIR, size=SIZES)
def test_pair_results_make_sense(changes, size):
    pair = sized("talbot-2012-pair", size)
    assert_sensible(ep.solve(pair.updated(scaled_torque(changes, size))))


@settings(max_examples=12)
@given(changes=PLANETARY)
def test_planetary_results_make_sense_with_elastic_teeth(talbot, changes):
    coarse = {
        "models.load_distribution": "compliance",
        "numerics.mesh_positions": 4,
        "numerics.contact_segments": 4,
    }
    assert_sensible(ep.solve(talbot.updated({**changes, **coarse})))


GIVEN_LOADS = {"models.mesh_loads": "without-losses"}
"""Loads that follow from the stated torque alone."""


@given(changes=PLANETARY)
def test_signs_of_torque_and_speed_do_not_matter(talbot, changes):
    # which member drives decides which flanks bound the pockets
    pockets = {f"losses.{mesh}_mesh_pocketing.include": False for mesh in ("sun", "ring")}
    case = talbot.updated({**changes, **pockets, **GIVEN_LOADS})
    losses = ep.solve(case).losses
    positive = case.updated(
        {
            "operation.torque": changes["operation.torque"].lstrip("-"),
            "operation.speed": changes["operation.speed"].lstrip("-"),
        }
    )
    assert ep.solve(positive).losses == pytest.approx(losses, rel=1e-9, abs=1e-12)


@pytest.mark.slow
@given(changes=PLANETARY, count=st.integers(2, 6))
def test_planets_at_the_same_branch_torque_lose_the_same(talbot, changes, count):
    torque = float(changes["operation.torque"].split()[0])
    one = ep.solve(talbot.updated({**changes, **GIVEN_LOADS, "planet.count": 1}))
    many = ep.solve(
        talbot.updated(
            {
                **changes,
                **GIVEN_LOADS,
                "planet.count": count,
                "operation.torque": f"{count * torque!r} N*m",
            }
        )
    )
    # branch torques differ by rounding, which the solution of the bearing's balance enlarges to its
    # tolerance of 1e-9 of the load, ten times that in the loss
    assert many.load_dependent == pytest.approx(count * one.load_dependent, rel=1e-7, abs=1e-12)


@pytest.mark.slow
@given(changes=PLANETARY, name=st.sampled_from(["sun_mesh_sliding", "carrier_drag"]))
def test_left_out_terms_leave_the_others(talbot, changes, name):
    case = talbot.updated({**changes, **GIVEN_LOADS})
    with_it, without = ep.solve(case), ep.solve(case.updated({f"losses.{name}.include": False}))
    assert without.losses == pytest.approx({**with_it.losses, name: 0.0}, rel=1e-12)


@given(
    helix=st.floats(0.0, 30.0),
    width=st.floats(5.0, 60.0),
    torque=log_uniform(1.0, 2000.0),
    friction=st.floats(0.001, 0.2),
    distribution=st.sampled_from(["uniform", "minimum-energy"]),
)
def test_constant_friction_loses_what_the_load_factor_says(
    helix, width, torque, friction, distribution
):
    """Sliding loss over friction and power is a property of the gears alone."""
    pair = ep.load_case("talbot-2012-pair").updated(
        {
            "gears.helix_angle": f"{helix!r} deg",
            "pinion.face_width": f"{width!r} mm",
            "gear.face_width": f"{width!r} mm",
            "models.friction": "constant",
            "models.constant_friction": friction,
            "models.load_distribution": distribution,
            "operation.torque": f"{torque!r} N*m",
            "losses.mesh_pocketing.include": False,
        }
    )
    result = ep.solve(pair)
    power = torque * 10000 * math.pi / 30
    factor = result.losses["mesh_sliding"] / (friction * power)
    again = ep.solve(pair.updated({"operation.torque": f"{2 * torque!r} N*m"}))
    assert again.losses["mesh_sliding"] == pytest.approx(
        2 * result.losses["mesh_sliding"], rel=1e-10
    )
    # between all load where it slides least and all load at the ends of the path
    assert 0.02 < factor < 0.3
    assert result.meshes["mesh"].friction_mean == pytest.approx(friction, rel=1e-10)
