"""Cases in Python: read by key, changed with units in keys, solved from a path, swept."""

from __future__ import annotations

import inspect

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import epicyclic as ep

WITHOUT_POCKETS = {"losses.mesh_pocketing.include": False}


@pytest.fixture(scope="module")
def case():
    return ep.load_case("talbot-2012-pair", WITHOUT_POCKETS)


def test_a_path_or_a_name_is_solved(tmp_path, case):
    path = tmp_path / "own.toml"
    from epicyclic.show.template import case_text

    path.write_text(case_text(case.given(), []))
    wanted = ep.solve(case).total
    assert ep.solve(path).total == wanted
    assert ep.solve(str(path)).total == wanted
    assert ep.solve(case.given()).total == wanted
    with pytest.raises(ep.InputError, match=r"none\.toml"):
        ep.solve("none.toml")


CYCLE = {"speed [rpm]": [900.0], "torque [N*m]": [40.0], "share": [1.0]}
OF_A_CASE = {
    "compare_cases": lambda case: ep.compare_cases(case, case),
    "compare_measured": lambda case: ep.compare_measured(case, "none.csv"),
    "duty_cycle": lambda case: ep.duty_cycle(case, CYCLE),
    "loss_map": lambda case: ep.loss_map(case, ["900 rpm"], ["40 N*m"]),
    "pocketing_table": lambda case: ep.pocketing_table(case, ["900 rpm"]),
    "save_result": lambda case: ep.save_result(case, "none.nc"),
    "solve_for": lambda case: ep.solve_for(case, "oil_flow", "110 degC"),
    "warm_up": lambda case: ep.warm_up(case, "2 h"),
    "with_temperature_state": lambda case: ep.with_temperature_state(
        xr.Dataset(coords={"temperature": [20, 60]}, attrs={"case": "{}"}), case
    ),
}


@pytest.mark.parametrize(
    "name",
    [
        name
        for name in sorted(ep._HOME)
        if inspect.isfunction(getattr(ep, name))
        and "Case" in str(inspect.signature(getattr(ep, name))).partition("->")[0]
    ],
)
def test_what_takes_a_case_takes_a_name_or_a_file(name):
    with pytest.raises(ep.InputError, match=r"none\.toml"):
        OF_A_CASE.get(name, getattr(ep, name))("none.toml")


@pytest.mark.parametrize("source", [None, 5, [], b"talbot-2012", object()])
def test_what_is_no_case_is_refused(source):
    with pytest.raises(ep.InputError):
        ep.solve(source)


@pytest.mark.parametrize(
    "changes",
    [
        {"operation.torque": "1 N*m", "operation.torque [kN*m]": 2},
        {"operation.speed [rpm]": 3, "operation.speed [rad/s]": 4},
        {"operation.torque [N*m]": 10**400},
    ],
)
def test_changes_that_say_two_things_or_no_number_are_refused(case, changes):
    with pytest.raises(ep.InputError, match=r"changed already|not a number"):
        case.updated(changes)


def test_numbers_of_a_study_are_checked(case):
    for key, call in {
        "seed": lambda: ep.uncertainty(case, seed=-1),
        "jobs": lambda: ep.uncertainty(case, jobs=-1),
        "samples": lambda: ep.duty_cycle(case, CYCLE, samples=-1),
    }.items():
        with pytest.raises(ep.InputError, match=f"{key} = -1: must be"):
            call()


def test_a_key_is_read_as_it_is_stated(case):
    changes = {"operation.speed [rpm]": 1730, "operation.torque [kN*m]": np.float64(0.27)}
    other = case.updated(changes | {"operation.oil_inlet_temperature [degF]": 149})
    assert other["operation.speed"] == other.operation.speed
    assert other["operation.speed [rpm]"] == pytest.approx(1730, rel=1e-12)
    assert other["operation.torque [N*m]"] == pytest.approx(270, rel=1e-12)
    assert other["operation.oil_inlet_temperature [degC]"] == pytest.approx(65, rel=1e-9)
    assert other["pinion.teeth"] == case.pinion.teeth
    assert other.updated({"operation.speed": "1730 rpm"}) == other
    for key, words in (
        ("operation.sped", "Did you mean 'operation.speed'"),
        ("operation.speed [kg]", "measures something else"),
    ):
        with pytest.raises(ep.InputError, match=words):
            other[key]
        with pytest.raises(ep.InputError):
            other.updated({key: 5})


def test_arrays_with_the_unit_in_the_key_are_swept(case):
    torques = np.linspace(12, 96, 3)
    data = ep.sweep(case, {"operation.torque [N*m]": torques, "pinion.teeth": np.array([23, 24])})
    texts = ep.sweep(
        case, {"operation.torque": [f"{value} N*m" for value in torques], "pinion.teeth": [23, 24]}
    )
    np.testing.assert_array_equal(data["torque"], torques)
    np.testing.assert_array_equal(data["total"], texts["total"])
    together = ep.sweep(
        case,
        together=[
            {"operation.torque [kN*m]": torques / 1e3, "operation.speed [rpm]": [700, 800, 950]}
        ],
    )
    points = ep.sweep(case, points=pd.DataFrame(
        {"operation.torque [kN*m]": torques / 1e3, "operation.speed [rpm]": [700, 800, 950]}
    ))  # fmt: skip
    np.testing.assert_allclose(together["total"], points["total"], rtol=1e-12)
    with pytest.raises(ep.InputError, match="varied twice"):
        ep.sweep(case, {"operation.torque [N*m]": [1, 2], "operation.torque": ["3 N*m"]})
    with pytest.raises(ep.InputError, match="has no unit"):
        ep.sweep(case, {"operation.torque": torques})
