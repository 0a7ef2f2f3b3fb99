"""Next to no torque, where neither gear of a mesh drives it with the losses that follow."""

from __future__ import annotations

import pytest

import epicyclic as ep
from epicyclic.build import result as build_result
from epicyclic.machine import solve as machine_solve


def gear(teeth, width, shift, roughness):
    return {
        "teeth": teeth,
        "face_width": f"{width} mm",
        "profile_shift_coefficient": shift,
        "roughness": f"{roughness} um",
    }


E_AXLE = {
    "kind": "planetary",
    "operation": {
        "input": "sun",
        "fixed": "ring",
        "torque": "0.091 N*m",
        "speed": "15000 rpm",
        "oil_inlet_temperature": "80 degC",
    },
    "gears": {
        "normal_module": "1.25 mm",
        "normal_pressure_angle": "20 deg",
        "helix_angle": "20 deg",
        "center_distance": "39 mm",
    },
    "sun": gear(31, 26, 0.26, 0.4),
    "planet": gear(27, 25, 0.05, 0.4) | {"count": 4},
    "ring": gear(85, 24, -0.46, 0.8),
    "planet_bearing": {
        "rows": 1,
        "rollers_per_row": 15,
        "roller_diameter": "3 mm",
        "roller_length": "19 mm",
        "pin_diameter": "16 mm",
        "diametral_clearance": "20 um",
        "roller_roughness": "0.1 um",
        "race_roughness": "0.2 um",
    },
    "lubricant": {"oil": "atf-dexron-vi"},
    "carrier": {"outer_diameter": "105 mm", "width": "45 mm"},
    "numerics": {
        "mesh_positions": 6,
        "contact_segments": 6,
        "bearing_slices": 5,
        "pocket_slices": 6,
        "pocket_steps": 10,
    },
}
"""An invented set of an electric axle."""


def floats(result):
    return [note for note in result.notes if "float within their backlash" in note]


@pytest.mark.parametrize("torque", ["0.05 N*m", "0.2 N*m"])
def test_teeth_that_lie_on_a_flank_do_not_float(torque):
    assert not floats(ep.solve(ep.load_case(E_AXLE).updated({"operation.torque": torque})))


def test_energy_balances_where_no_direction_agrees_with_itself(monkeypatch):
    braking = []
    converged = machine_solve._converged

    def spied(branch):
        braking.append(branch.braking)
        return converged(branch)

    monkeypatch.setattr(machine_solve, "_converged", spied)
    result = ep.solve(ep.load_case(E_AXLE).updated({"models.preset": "talbot-2012"}))
    assert str(result.status) == "converged"
    assert braking[-1] == frozenset({".sun_mesh"})
    (note,) = floats(result)
    assert note.startswith("sun mesh:")
    brought = sum(member.power for member in result.flow.members.values())
    assert brought == pytest.approx(result.total, rel=1e-9)


def test_stage_torques_balance_where_teeth_float(monkeypatch):
    built_and_settled = []
    heat = build_result._heat

    def spied(case, built, settled):
        built_and_settled.append((built, settled))
        return heat(case, built, settled)

    monkeypatch.setattr(build_result, "_heat", spied)
    ep.solve(ep.load_case(E_AXLE).updated({"models.preset": "talbot-2012"}))
    built, settled = built_and_settled[-1]
    solution = settled.solution
    assert solution.floating
    taken = machine_solve.stage_torques(built.machine, solution)
    for body, torque in solution.torques.items():
        sum_of_parts = sum(own.get(body, 0.0) for own in taken.values())
        assert sum_of_parts == pytest.approx(torque, rel=1e-9, abs=1e-12), body
