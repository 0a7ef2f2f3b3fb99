"""Tables of flows through pockets: do they give what the flows themselves give?"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

import asymmetric
import epicyclic as ep
from epicyclic.build.machine import build
from epicyclic.losses import pocket_flow as network
from epicyclic.losses import pocket_geometry
from epicyclic.losses.pocket_tables import (
    LEAST_NUMBER,
    FlowFigures,
    KnownFlows,
    flow_figures,
    make_tables,
    scaled_figures,
)
from epicyclic.machine.pocket_flow import flow_family, flow_request
from epicyclic.oil.oil import MixtureState
from epicyclic.study.solve import pocket_flow_numbers
from epicyclic.study.sweeps import run
from epicyclic.study.sweeps.run import flows_asked, make_plan

COARSE = {
    "numerics.pocket_slices": 4,
    "numerics.pocket_steps": 12,
    "models.pocketing": "mean-density",
}
BOUND = 0.002
UNIT = MixtureState(0.05, 1.0, 0.0)


@pytest.fixture(scope="module")
def case():
    return ep.load_case("talbot-2012-pair").updated(COARSE)


@pytest.fixture(scope="module")
def family(case):
    return flow_family(build(case).mean_duties()["mesh"])


@dataclass(frozen=True)
class Curve:
    """Stands for a family of flows: a power that is a function of the number."""

    name: str
    geometry: None = None

    def scaled(self, number):
        powers = {"smooth": number**0.3, "jump": 1.0 + (number > 3.0), "gone": number}
        power = powers[self.name]
        if self.name == "gone" and 2.0 < number < 2.5:
            power = math.nan
        return np.array([power, 0.0, 1.0, -1.0, 1.0])


def read(table, number):
    """Scaled power that a table gives."""
    figures = table.figures(number, UNIT, 1.0)
    return None if figures is None else figures.power / number**3


def numbers(count=200):
    return np.geomspace(1.0, 8.0, count)


def test_figures_depend_on_one_number_only(family):
    """Three ways to the same number: speed, density and pressure. Newton's tolerance is 1e-9."""
    thin = MixtureState(0.05, 40.0, 0.0)
    states = [(400.0, thin, 1e5), (800.0, thin, 4e5), (200.0, replace(thin, density=160.0), 1e5)]
    assert len({family.number(*state) for state in states}) == 1
    one, *others = (
        scaled_figures(flow_figures(family.flow(*state)), state[0], state[1].density)
        for state in states
    )
    for other in others:
        assert other == pytest.approx(one, rel=1e-6, abs=1e-9)


def test_creeping_flow_is_scaled_from_the_least_number(family):
    """Above it the flow itself is solved: what compressibility changes there is below 1e-6."""
    speeds = [1e-9, 0.5 * LEAST_NUMBER, 1.01 * LEAST_NUMBER, 3.0 * LEAST_NUMBER]
    powers = [family.figures(speed, UNIT, 1.0).power / speed**3 for speed in speeds]
    assert powers[:2] == pytest.approx([powers[0]] * 2, rel=1e-12)
    assert powers == pytest.approx([powers[0]] * 4, rel=1e-6)


def test_a_smooth_curve_takes_few_nodes_and_is_met():
    (table,) = make_tables({Curve("smooth"): numbers()}, BOUND).values()
    assert table.number.size < 10
    assert table.error <= BOUND
    for number in numbers(57)[1:-1]:
        assert read(table, number) == pytest.approx(number**0.3, rel=BOUND)


def test_a_jump_is_solved_where_it_is_and_read_elsewhere():
    (table,) = make_tables({Curve("jump"): numbers()}, BOUND).values()
    jump = int(np.searchsorted(table.number, 3.0))
    assert not table.readable[jump - 1]
    assert table.number.size < 60
    assert table.readable[[0, -1]].all()
    for number in numbers():  # every number asked for has an answer, at the jump its own
        assert read(table, number) == pytest.approx(1.0 + (number > 3.0), rel=BOUND)


def test_what_does_not_repeat_is_left_to_the_solver():
    (table,) = make_tables({Curve("gone"): numbers()}, BOUND).values()
    assert read(table, 2.2) is None
    assert read(table, 1.5) == pytest.approx(1.5, rel=BOUND)
    assert all(read(table, number) is None for number in (0.5, 9.0))


def test_equal_numbers_are_one_flow():
    asked = [1.0, 1.0 + 1e-13, 2.0]
    (table,) = make_tables({Curve("smooth"): asked}, BOUND).values()
    assert table.number.size == 2


def test_flows_read_are_the_flows(family):
    """At numbers that the table does not have, within the bound that it was made for."""
    (table,) = make_tables({family: np.geomspace(1.0, 6.0, 40)}, BOUND).values()
    assert 4 <= table.number.size < 40
    for number in np.sqrt(table.number[1:] * table.number[:-1])[table.readable][::4]:
        assert read(table, number) == pytest.approx(family.scaled(number)[0], rel=2 * BOUND)


def test_a_sweep_interpolates_and_says_so(case):
    speeds = [f"{speed} rpm" for speed in range(2000, 5000, 150)]
    vary = {"operation.speed": speeds}
    read = ep.sweep(case, vary, jobs=1)
    solved = ep.sweep(case.updated({"numerics.pocket_interpolation": 0}), vary, jobs=1)
    error = read["mesh_pocket_interpolation_error"]
    assert (error <= BOUND).all()
    assert solved["mesh_pocket_interpolation_error"].isnull().all()
    assert (read["mesh_pocketing"] != solved["mesh_pocketing"]).sum() >= 5
    # at this coarse resolution the flows themselves scatter by 0.1 %
    np.testing.assert_allclose(read["mesh_pocketing"], solved["mesh_pocketing"], rtol=2 * BOUND)
    assert "interpolated" in read.attrs["pocketing"]
    assert "solved at every point" in solved.attrs["pocketing"]


@pytest.mark.parametrize(
    ("drive", "speeds", "asked"),
    [
        ({}, range(700, 3100, 210), 2),  # all scale: the slowest and the fastest tell
        ({}, range(-9100, 9100, 1300), 14),
        ({"operation.fixed": None, "operation.second_speed": "9700 rpm"}, range(10, 9700, 880), 12),
    ],
)
def test_tables_hold_the_numbers_of_all_speeds(monkeypatch, drive, speeds, asked):
    """Where the second shaft turns, the slowest point has the largest number."""
    case = ep.load_case("talbot-2012").updated(COARSE | {"models.pocketing": "incompressible"})
    if drive:
        case = case.updated(drive | {"operation.second_input": "ring"})
    plan = make_plan(case, {"operation.speed": [f"{speed} rpm" for speed in speeds]})
    every = {}
    for index in range(plan.size):
        for family, number in pocket_flow_numbers(case.updated(plan.changes(index))):
            every.setdefault(family, set()).add(number)
    calls = []
    monkeypatch.setattr(run, "_FEWEST", 3)
    monkeypatch.setattr(
        run, "pocket_flow_numbers", lambda own: calls.append(own) or pocket_flow_numbers(own)
    )
    monkeypatch.setattr(run, "make_tables", lambda many, *_: many)
    found = run.flow_tables(plan, range(plan.size))
    assert found == {family: own for family, own in every.items() if len(own) >= 3}
    assert len(calls) == asked
    assert (len(found) == 0) is (asked == 2)


@pytest.mark.parametrize(
    ("key", "value", "matters"),
    [
        ("planet.roughness", "0.53 um", False),
        ("planet_bearing.race_roughness", "0.31 um", False),
        ("load_sharing.mesh_load_factor", 1.13, False),
        ("carrier.outer_diameter", "211 mm", False),
        ("carrier.width", "61 mm", False),
        ("carrier.open_width", "13 mm", False),
        ("carrier.shroud_gap", "7 mm", False),
        ("carrier.flange_gap", "9 mm", False),
        ("thrust_bearing.mean_diameter", "83 mm", False),
        ("models.hurst_exponent", 0.61, False),
        ("models.running_in_factor", 0.71, False),
        ("models.boundary_friction", 0.074, False),
        ("lubricant.pressure_viscosity_factor", 1.09, False),
        ("planet.face_width", "27 mm", True),
        ("surroundings.oil_air_ratio", 0.063, True),
        ("operation.oil_inlet_temperature", "71 degC", True),
        ("operation.speed", "3100 rpm", True),
    ],
)
def test_what_points_change_of_the_pockets(key, value, matters):
    case = ep.load_case("talbot-2012").updated(COARSE)
    changed = pocket_flow_numbers(case.updated({key: value})) != pocket_flow_numbers(case)
    plan = make_plan(case, {key: [value]})
    assert changed is matters
    assert [*flows_asked(plan, [0]).values()] == [{key: value} if matters else {}]


def test_a_wider_gear_keeps_pockets_of_the_same_common_face_and_sections_of_all():
    case = ep.load_case("talbot-2012")
    for kept in (pocket_geometry.pocket_geometry, pocket_geometry._sections):
        kept.cache_clear()  # else one of two that belong together may have made room for others
    widths = ({}, {"sun.face_width": "32 mm"}, {"planet.face_width": "25 mm"})
    as_given, wider_sun, wider_planets = (
        tuple(map(flow_family, build(case.updated(change)).mean_duties().values()))
        for change in widths
    )
    assert wider_sun == as_given != wider_planets
    for one, other in zip(as_given, wider_planets, strict=True):
        assert one.geometry.area is other.geometry.area


def test_a_single_case_and_few_points_are_solved(case):
    assert math.isnan(ep.solve(case).meshes["mesh"].pocket_interpolation_error)
    few = ep.sweep(case, {"operation.speed": ["1000 rpm", "2000 rpm"]}, jobs=1)
    assert few["mesh_pocket_interpolation_error"].isnull().all()


def test_known_flows_give_what_is_solved():
    """The asymmetric set: flows between two that are known, within a hundred-thousandth."""
    case = ep.load_case(asymmetric.planetary())
    built = build(case)
    for duty in built.mean_duties().values():
        family, speed, mixture, pressure = flow_request(duty, built.fluids)
        known = KnownFlows()
        read = 0
        for factor in (1.0, 1.0012, 1.0005, 1.0021, 1.0016):
            state = (speed * factor, mixture, pressure)
            solved = family.figures(*state)
            told = known.figures(family, *state)
            if told is not None:
                read += 1
                assert told.power == pytest.approx(solved.power, rel=1e-5)
            known = known.with_flow(family, *state, solved)
        assert read == 2
        assert known.figures(family, 1.1 * speed, mixture, pressure) is None


def test_a_flow_that_does_not_repeat_serves_those_near_it(case):
    """The first that is known, by its scaled power, so that nothing jumps between two of them."""
    built = build(case)
    duty = built.mean_duties()["mesh"]
    family, speed, mixture, pressure = flow_request(duty, built.fluids)
    known = KnownFlows()
    for factor, power in ((1.0, 311.0), (1.004, 327.0)):
        figures = FlowFigures(power, 0.013, 2.3e5, -0.7e5, 41.0, periods=60, periodic=False)
        known = known.with_flow(family, speed * factor, mixture, pressure, figures)
    near = known.figures(family, 1.003 * speed, mixture, pressure)
    assert near.power == pytest.approx(311.0 * 1.003**3, rel=1e-12)
    assert near.speed_max == pytest.approx(41.0 * 1.003, rel=1e-12)
    assert (near.periods, near.periodic) == (60, False)
    beyond = known.figures(family, 1.008 * speed, mixture, pressure)
    assert beyond.power == pytest.approx(327.0 * (1.008 / 1.004) ** 3, rel=1e-12)
    assert known.figures(family, 1.01 * speed, mixture, pressure) is None


def test_a_flow_without_voids_serves_all_speeds_oils_and_shares(monkeypatch):
    """One is solved; other operating points are that one times density and powers of the speed."""
    plain = ep.load_case("talbot-2012-pair").updated(
        {"operation.speed": "3000 rpm", "numerics.pocket_slices": 7, "numerics.pocket_steps": 18}
    )
    first = ep.solve(plain)
    monkeypatch.setattr(network, "periodic_network", None)
    faster = ep.solve(plain.updated({"operation.speed": "4200 rpm"}))
    ratio = faster.losses["mesh_pocketing"] / first.losses["mesh_pocketing"]
    assert ratio == pytest.approx(1.4**3, rel=1e-12)
    changes = {"surroundings.oil_air_ratio": 0.083, "operation.oil_inlet_temperature": "61 degC"}
    other = plain.updated(changes)
    densities = [build(case).fluids.mixture.density for case in (other, plain)]
    ratio = ep.solve(other).losses["mesh_pocketing"] / first.losses["mesh_pocketing"]
    assert ratio == pytest.approx(densities[0] / densities[1], rel=1e-12)


def test_hardly_any_oil_is_a_gas_and_a_void_has_its_pressure():
    """What "auto" stands for, and the pressure of a void as an input."""
    case = ep.load_case("talbot-2012-pair").updated({"numerics.pocket_slices": 5})
    losses = {}
    for share in (0.0049, 0.0051):
        for model in ("auto", "isentropic", "incompressible"):
            changes = {"surroundings.oil_air_ratio": share, "models.pocketing": model}
            losses[share, model] = ep.solve(case.updated(changes)).losses["mesh_pocketing"]
    assert losses[0.0049, "auto"] == losses[0.0049, "isentropic"]
    assert losses[0.0051, "auto"] == losses[0.0051, "incompressible"]
    assert losses[0.0049, "isentropic"] != losses[0.0049, "incompressible"]
    for void in (0.0, 0.2):
        result = ep.solve(case.updated({"models.pocket_void_pressure": f"{void} bar"}))
        lowest = 1.01325 + result.meshes["mesh"].pocket_pressure_min / 1e5
        assert lowest == pytest.approx(void, abs=2e-3)
        assert any("contain voids" in text for text in result.warnings)


def test_a_void_has_less_pressure_than_the_surroundings():
    changes = {"models.pocket_void_pressure": "0.9 bar", "surroundings.pressure": "0.83 bar"}
    with pytest.raises(ep.InputError) as error:
        ep.load_case("talbot-2012-pair").updated(changes)
    (problem,) = error.value.problems
    assert problem.key == "models.pocket_void_pressure"
    assert "less than surroundings.pressure, 0.83 bar" in problem.allowed
