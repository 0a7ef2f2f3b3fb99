"""A result that cannot be is an outcome of its own: not a number to trust, not an exception."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.build.result import GEAR_PRESSURE
from epicyclic.errors import Status
from epicyclic.losses.pocket_tables import FlowFigures
from epicyclic.machine import pocket_flow
from epicyclic.result.physical import judged
from epicyclic.study.maps.compute import map_plan, to_map
from epicyclic.study.sweeps.runner import Runner


@pytest.fixture(scope="module")
def result(coarse_talbot):
    return ep.solve(coarse_talbot)


def with_loss(result, name, watts):
    terms = [replace(one, watts=watts) if one.name == name else one for one in result.terms]
    return replace(result, terms=tuple(terms))


def test_a_sound_result_stays_as_it_is(result):
    assert judged(result) is result
    assert result.status == "converged"


def test_a_loss_below_zero_is_told(result):
    found = judged(with_loss(result, "ring_drag", -7.25))
    assert found.status == Status.UNPHYSICAL
    assert found.to_dict()["status"] == "unphysical"
    assert found.warnings[0].startswith("No result: Losses are negative: ring drag -7.25 W.")


def test_energy_that_does_not_balance_is_told(result):
    found = judged(with_loss(result, "ring_drag", result.losses["ring_drag"] + 0.5))
    assert found.status == Status.UNPHYSICAL
    assert "The shaft powers exceed the losses by -0.5 W." in found.warnings[0]


def test_errors_of_the_numerics_are_no_reason(result):
    least = -1e-4 * result.total
    members = dict(result.flow.members)
    one, other = with_loss(result, "ring_drag", least), members["sun"]
    torque = other.torque + (one.total - result.total) / other.speed
    members["sun"] = replace(other, torque=torque)
    assert judged(replace(one, flow=replace(result.flow, members=members))).status == "converged"


COLD = {
    "models.friction": "mixed-ehl",
    "models.rolling": "mixed-ehl",
    "models.oil_beyond_range": "extrapolated",
    "lubricant.oil": "iso-vg-320-pao",
    "operation.oil_inlet_temperature": "-21 degC",
    "losses.sun_mesh_pocketing.include": False,
    "losses.ring_mesh_pocketing.include": False,
}
"""The rolling regression runs away with the viscosity: megawatts at any torque."""


def test_rolling_that_exceeds_what_the_load_resists_with_is_told(coarse_talbot):
    found = ep.solve(coarse_talbot.updated({**COLD, "models.mesh_loads": "without-losses"}))
    assert found.status == "unphysical"
    assert "times the power that their load can dissipate" in found.warnings[0]
    assert 'models.oil_beyond_range = "held"' in found.warnings[0]
    held = ep.solve(coarse_talbot.updated({**COLD, "models.oil_beyond_range": "held"}))
    assert held.status == "converged"
    assert all(mesh.resistance < 0.1 for mesh in held.meshes.values())


def test_losses_and_torques_that_drive_each_other_up_are_told(coarse_talbot):
    with pytest.raises(ep.ConvergenceError, match="losses grow with the torques that they cause"):
        ep.solve(coarse_talbot.updated(COLD))


@pytest.mark.parametrize(("torque", "status"), [("20 kN*m", "converged"), ("2 MN*m", "unphysical")])
def test_contacts_wider_than_their_radius_are_told(torque, status):
    pair = ep.load_case(
        "talbot-2012-pair", {"operation.torque": torque, "losses.mesh_pocketing.include": False}
    )
    found = ep.solve(pair)
    mesh = found.meshes["mesh"]
    contact = mesh.contact
    assert found.status == status
    assert (mesh.flattening > 1) == (status == "unphysical")
    # Johnson (1985), Eq. 4.43 and 4.45: b/R = 4 p/E_eq
    assert mesh.flattening == pytest.approx(
        4 * mesh.hertz_pressure_max / contact.flanks.equivalent_modulus, rel=1e-12
    )
    told = "The teeth of the mesh would have a contact pressure of"
    assert found.warnings[0].count(told) == (status == "unphysical")


@pytest.fixture
def impossible_pockets(monkeypatch):
    """Pockets that give power, as a damaged table of flows would have it."""
    figures = FlowFigures(-40.5, 0.0, 1e5, -1e5, 20.0)
    monkeypatch.setattr(pocket_flow, "_solve", lambda _: pocket_flow.MeshFlow(figures))
    pocket_flow._solve_all.cache_clear()


def test_solve_refuses_pockets_that_give_power(coarse_talbot, impossible_pockets):
    found = ep.solve(coarse_talbot)
    assert found.status == "unphysical"
    assert "sun mesh pocketing" in found.warnings[0]


def test_the_command_ends_with_3(
    coarse_talbot, impossible_pockets, coarse_options, monkeypatch, capsys
):
    from epicyclic.cli.main import main

    monkeypatch.setattr("sys.argv", ["epicyclic", "run", "talbot-2012", *coarse_options, "--json"])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 3
    shown = capsys.readouterr()
    assert json.loads(shown.out)["status"] == "unphysical"
    assert shown.err.startswith("No result: Losses are negative: ")


def test_points_of_sweeps_have_the_outcome_and_no_numbers(coarse_talbot, impossible_pockets):
    found = ep.sweep(
        coarse_talbot.updated({"numerics.pocket_interpolation": 0}),
        {"operation.speed": ["0 rpm", "3000 rpm"]},
        jobs=1,
    )
    assert list(found["status"].values) == ["converged", "unphysical"]
    assert found["total"].isnull().values.tolist() == [False, True]
    assert found["message"].values[1].startswith("No result: ")


@pytest.mark.parametrize("torque", ["-730 N*m", "4 N*m", "1900 N*m"])
def test_contacts_are_judged_by_no_less_than_their_figures(torque):
    result = ep.solve(ep.load_case("talbot-2012").updated({"operation.torque": torque}))
    for name, found in result.meshes.items():
        own = result.extremes[name]
        assert own.share == found.contact_share
        assert own.resistance == found.resistance
        assert 0 < found.hertz_pressure_max <= own.pressure < 2 * found.hertz_pressure_max
        assert found.flattening <= own.flattening
    found, own = result.bearing, result.extremes["planet_bearing"]
    assert (own.pressure, own.flattening) == (found.hertz_pressure_max, found.flattening)
    rows, rollers, _ = found.loads.intensity.shape
    carried = found.loads.intensity.reshape(rows * rollers, -1)
    assert own.share == np.mean(carried[carried.sum(axis=1).argmax()] > 0)


def test_a_map_keeps_its_own_numbers_and_every_warning():
    """Points of a block whose contacts are pressed too much, and others."""
    case = ep.load_case("talbot-2012").updated({"sun.roughness": "0.35 um"})
    speeds = [f"{rpm} rpm" for rpm in (300, 700, 1100, 1600, 2300, 3100, 3900, 4700)]
    torques = [f"{torque} N*m" for torque in (-23000, -800, 3, 410, 9000, 30000)]
    plan = map_plan(case, speeds, torques, ["60 degC"])
    assert plan.block > 1
    rows = Runner(jobs=1).run(plan)
    own = {f"{mesh}_pocket_interpolation_error" for mesh in ("sun_mesh", "ring_mesh")}
    assert set(rows.names) <= {*to_map(plan, rows).data_vars, *own}
    for place in range(0, plan.size, 5):
        alone = ep.solve(case.updated(plan.changes(place)))
        assert rows.warnings[place] == " | ".join(alone.warnings)
        assert rows.numbers("total")[place] == pytest.approx(alone.total, rel=1e-6)
    pressed = [" withstands about " in text for text in rows.warnings]
    assert any(pressed)
    assert not all(pressed)


def test_what_carries_nothing_is_told_under_little_pressure():
    """A mesh far out of line, and a planet that tilts in its bearing."""
    askew = {"sun_mesh.misalignment": "20 um", "operation.torque": "430 N*m"}
    result = ep.solve(ep.load_case("talbot-2012").updated(askew))
    share = result.meshes["sun_mesh"].contact_share
    told = f"Only {100 * share:.0f} % of the contact lines of the sun mesh carry load"
    assert [note for note in result.notes if note.startswith(told)]
    assert share < 0.7 < result.extremes["ring_mesh"].share
    tilted = {"planet_bearing.crown_drop": "40 um", "operation.torque": "70 N*m"}
    result = ep.solve(ep.load_case("talbot-2012").updated(tilted))
    own = result.extremes["planet_bearing"]
    assert own.pressure < GEAR_PRESSURE
    told = f"Planet bearing: {100 * (1 - own.share):.0f} % of the length of the most loaded roller"
    assert [note for note in result.notes if note.startswith(told)]
