"""What a sweep varies: command-line forms, axes, order."""

from __future__ import annotations

import numpy as np
import pint
import pytest

import epicyclic as ep
from epicyclic.study.sweeps.run import make_plan, parse_vary
from epicyclic.study.sweeps.runner import fingerprint


@pytest.fixture(scope="module")
def case():
    return ep.load_case("talbot-2012")


@pytest.mark.parametrize(
    ("option", "key", "values"),
    [
        (
            "operation.speed=1000:4000:4 rpm",
            "operation.speed",
            ["1000 rpm", "2000 rpm", "3000 rpm", "4000 rpm"],
        ),
        ("operation.speed=1000 rpm:2000 rpm:2", "operation.speed", ["1000 rpm", "2000 rpm"]),
        ("operation.speed=1000:2000 rpm:2", "operation.speed", ["1000 rpm", "2000 rpm"]),
        ("operation.torque=-100,0,100 N*m", "operation.torque", ["-100 N*m", "0 N*m", "100 N*m"]),
        ("planet.count=3:6:4", "planet.count", [3, 4, 5, 6]),
        ("surroundings.oil_air_ratio=0:0.1:3", "surroundings.oil_air_ratio", [0.0, 0.05, 0.1]),
        ("models.friction=schlenk,xu-2007", "models.friction", ["schlenk", "xu-2007"]),
        ("losses.sun_drag.include=true,false", "losses.sun_drag.include", [True, False]),
        ("planet.roughness=shaved,0.1 um", "planet.roughness", ["shaved", "0.1 um"]),
        (
            "operation.oil_inlet_temperature=40,60 degC",
            "operation.oil_inlet_temperature",
            ["40 degC", "60 degC"],
        ),
    ],
)
def test_command_line_form(case, option, key, values):
    assert parse_vary(case, [option]) == {key: values}


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["operation.speed"], "key=a,b,c or key=start:stop:count"),
        (["operation.speed="], "key=a,b,c or key=start:stop:count"),
        (["operation.speed=1 rpm:2 rad/s:3"], "differ"),
        (["operation.speed=a:b:3"], "must be numbers"),
        (["operation.speed=1:2:0 rpm"], "1 or more"),
        (["operation.speed=1:2:1 rpm"], "a count of 1 leaves out the stop"),
        (["operation.speed=1:2:2.5 rpm"], "a,b,c or start:stop:count"),
        (["operation.speed=1:2:1000000000000 rpm"], "1000000 or less"),
        (["planet.count=3,4", "planet.count=5,6"], "again"),
        (["operation.speed=1000,,2000 rpm"], "has an empty value"),
        (["planet.roughness=shaved, ,ground"], "has an empty value"),
        (["planet.count=3,4,"], "has an empty value"),
    ],
)
def test_unreadable_option(case, options, words):
    with pytest.raises(ep.InputError, match=words):
        parse_vary(case, options)


@pytest.mark.parametrize("text", ["1700,nan rpm", "nan:1700:2 rpm", "inf,1700 rpm"])
def test_what_is_no_number_takes_no_unit_from_others(case, text):
    with pytest.raises(ep.InputError) as error:
        make_plan(case, parse_vary(case, [f"operation.speed={text}"]))
    (problem,) = error.value.problems
    assert "1700" not in problem.value
    assert "is not a number" in problem.allowed


@pytest.mark.parametrize(
    ("vary", "words"),
    [
        ({}, "empty"),
        ({"operation.sped": ["1 rpm"]}, "operation.speed"),
        ({"operation.speed": []}, "no values"),
        ({"operation.speed": [1000, 2000]}, "has no unit"),
        ({"operation.speed": ["1 kg"]}, "rotational speed"),
        ({"operation.speed": ["60 rpm", "6.283185307179586 rad/s"]}, "same value twice"),
        ({"gears": [1, 2]}, "is a table; .*such as gears.normal_module"),
        ({"losses.sun_drag": [1]}, "is a table; .*such as losses.sun_drag.include"),
        ({"friction_table": [1]}, "is a table"),
        ({"planet.angles": [["0 deg", "180 deg"]]}, "is a list"),
        ({"planet.angles": ["0 deg", "180 deg"]}, "is a list"),
        ({"lubricant.oil.density": [1]}, "is a list"),
        ({"lubricant.oil": [{"kind": "mineral"}]}, "not a value of one key"),
        ({"planet.count": [10**400]}, "not a value of one key"),
        ({"planet.count": range(1001), "sun.teeth": range(1001)}, "1000000 points or fewer"),
    ],
)
def test_unsuitable_axis(case, vary, words):
    with pytest.raises(ep.InputError, match=words) as caught:
        make_plan(case, vary)
    for problem in caught.value.problems:
        assert problem.allowed.endswith(".")
        assert problem.remedy[0].isupper()
        assert problem.remedy.endswith((".", "?"))


def test_all_problems_of_a_sweep_are_reported_together(case):
    with pytest.raises(ep.InputError) as caught:
        make_plan(case, {"operation.sped": ["1 rpm"], "sun.teth": [3], "planet.count": []})
    assert len(caught.value.problems) == 3


def test_coordinates_are_in_display_units(case):
    quantity = pint.UnitRegistry().Quantity
    plan = make_plan(
        case,
        {
            "operation.speed": ["1000 rpm", quantity(2000, "rpm")],
            "gears.center_distance": ["92.13 mm", "9.2 cm"],
            "planet.count": [3, 4],
        },
    )
    assert plan.axes[0].coordinate == pytest.approx((1000.0, 2000.0), rel=1e-12)
    assert plan.axes[1].coordinate == (92.13, 92.0)
    assert plan.axes[2].coordinate == (3, 4)
    assert [axis.unit for axis in plan.axes] == ["rpm", "mm", "1"]


def test_coordinates_without_unit(case):
    plan = make_plan(
        case,
        {
            "planet.count": np.arange(3, 5),
            "models.friction": "schlenk",
            "losses.sun_drag.include": [True, False],
            "lubricant.oil": ["iso-vg-32-mineral", "iso-vg-32-pao"],
            "planet.roughness": ["shaved", "0.1 um"],
            "losses.sun_drag.factor": 2,
        },
    )
    assert [axis.unit for axis in plan.axes] == ["1", "", "", "", "um", "1"]
    assert plan.axes[0].coordinate == (3, 4)
    assert all(isinstance(count, int) for count in plan.axes[0].coordinate)
    assert plan.axes[1].coordinate == ("schlenk",)
    assert plan.axes[2].coordinate == ("true", "false")
    assert plan.axes[3].coordinate == ("iso-vg-32-mineral", "iso-vg-32-pao")
    assert plan.axes[5].coordinate == (2,)


def test_cases_that_share_geometry_are_next_to_each_other(case):
    plan = make_plan(
        case,
        {
            "operation.speed": ["1000 rpm", "2000 rpm"],
            "gears.center_distance": ["92.13 mm", "92.14 mm"],
            "operation.torque": ["1 N*m", "2 N*m", "3 N*m"],
        },
    )
    distances = [plan.changes(index)["gears.center_distance"] for index in plan.order()]
    assert sorted(plan.order()) == list(range(12))
    assert distances == ["92.13 mm"] * 6 + ["92.14 mm"] * 6


def test_case_numbers_count_with_the_last_axis_fastest(case):
    plan = make_plan(case, {"planet.count": [3, 4], "operation.torque": ["1 N*m", "2 N*m"]})
    assert plan.changes(1) == {"planet.count": 3, "operation.torque": "2 N*m"}
    assert plan.changes(2) == {"planet.count": 4, "operation.torque": "1 N*m"}


def test_fingerprint_follows_case_and_values(case):
    plans = [
        make_plan(case, {"planet.count": [3, 4]}),
        make_plan(case, {"planet.count": [3, 5]}),
        make_plan(case.updated({"operation.torque": "1 N*m"}), {"planet.count": [3, 4]}),
    ]
    assert len({fingerprint(plan) for plan in plans}) == 3
    assert fingerprint(plans[0]) == fingerprint(make_plan(case, {"planet.count": [3, 4]}))


def test_values_with_the_same_fault_are_one_problem(case):
    with pytest.raises(ep.InputError) as caught:
        make_plan(case, {"operation.speed": [1000.0, "2000 rpm", 3000.0, 4000.0, "5 kg"]})
    bare, wrong = caught.value.problems
    assert (bare.value, wrong.value) == ("1000.0 and 2 more", '"5 kg"')


@pytest.mark.parametrize(
    ("option", "told"),
    [
        ("operation.speed=700:4300:5", 'has no unit. Write "700:4300:5 rpm".'),
        ("operation.torque=15,80", 'has no unit. Write "15,80 N*m".'),
        ("operation.speed=700:4300 rpm", "must be a,b,c or start:stop:count. Give all three"),
    ],
)
def test_values_without_what_they_need_are_told_as_they_were_written(case, option, told):
    with pytest.raises(ep.InputError) as error:
        parse_vary(case, [option])
    assert told in str(error.value)


def test_points_with_temperatures_keep_them_beside_points_without():
    pair = ep.load_case("talbot-2012-pair").updated({"losses.mesh_pocketing.include": False})
    kinds, torques = ["inlet", "network"], ["70 N*m", "110 N*m"]
    varied = {"models.temperatures": kinds, "operation.torque": torques}
    for base in kinds:
        data = ep.sweep(pair.updated({"models.temperatures": base}), varied, jobs=1)
        found = data["oil_temperature"].transpose("models_temperatures", "torque").values
        heated = pair.updated({"models.temperatures": "network"})
        wanted = [
            ep.solve(heated.updated({"operation.torque": torque})).heat.temperatures["oil"]
            for torque in torques
        ]
        assert np.isnan(found[0]).all()
        assert found[1] + 273.15 == pytest.approx(wanted, abs=1e-3)
