"""Which gear a case names first does not matter."""

from __future__ import annotations

import copy

import pytest

import asymmetric
import epicyclic as ep
from epicyclic.build.machine import build
from epicyclic.machine.gear_mesh import elastic_loads

ROUNDING = 1e-9  # the same numbers in another order
MODELS = [
    "mixed-ehl",
    "schlenk",
    "niemann-winter",
    "benedict-kelley",
    "matsumoto",
    "doleschel",
    "xu-2007",
    "constant",
]


GIVEN = {"mesh_loads": "without-losses"}
"""The torque of either gear follows from that of the other without the losses."""


def exchanged(tables):
    """The same pair with its gears named in the other order, the same gear driving."""
    teeth = tables["pinion"]["teeth"], tables["gear"]["teeth"]
    ratio = teeth[1] / teeth[0]
    other = copy.deepcopy(tables)
    other["pinion"], other["gear"] = copy.deepcopy(tables["gear"]), copy.deepcopy(tables["pinion"])
    for table in (other["pinion"], other["gear"]):
        table.pop("internal", None)
        table.pop("rim_thickness", None)
    torque, unit = tables["operation"]["torque"].split()
    speed, speed_unit = tables["operation"]["speed"].split()
    other["operation"] = tables["operation"] | {
        "torque": f"{float(torque) * ratio!r} {unit}",
        # what enters at the pinion leaves at the gear: its torque is against its speed there
        "speed": f"{-float(speed) / ratio!r} {speed_unit}",
    }
    return other


@pytest.mark.parametrize("friction", MODELS)
def test_a_pair_with_its_gears_exchanged_loses_the_same(friction):
    tables = asymmetric.gear_pair()
    tables["models"] = tables.get("models", {}) | {"friction": friction, **GIVEN}
    one, two = ep.solve(ep.load_case(tables)), ep.solve(ep.load_case(exchanged(tables)))
    for name in ("mesh_sliding", "mesh_rolling", "mesh_pocketing", "drag"):
        assert two.losses[name] == pytest.approx(one.losses[name], rel=ROUNDING), name


def test_misaligned_teeth_carry_at_the_end_of_the_face_where_contact_begins():
    """It begins at the other end if the gear drives."""
    changes = {"mesh.misalignment": "37 um", "models.load_distribution": "compliance"}
    case = ep.load_case(asymmetric.gear_pair()).updated(changes)
    middles = []
    for torque in ("187 N*m", "-187 N*m"):
        built = build(case.updated({"operation.torque": torque}))
        (duty,) = built.loaded_duties(built.loaded_state()).values()
        loads = elastic_loads(duty)
        force = loads.line_load * loads.compliance.lines.length
        middle = float((force * loads.compliance.lines.face_position).sum() / force.sum())
        middles.append(middle / duty.gears.mesh.face_width)
    assert middles[0] < 0.4
    assert middles[1] > 0.6


def test_a_pair_with_its_gears_exchanged_is_as_warm():
    changes = {
        "models.temperatures": "network",
        "thermal.oil_flow": "3.7 l/min",
        "losses.mesh_pocketing.include": False,
        "models.mesh_loads": "without-losses",
    }
    tables = asymmetric.gear_pair()
    one, two = (
        ep.solve(ep.load_case(pair).updated(changes)) for pair in (tables, exchanged(tables))
    )
    for node, other in (("pinion", "gear"), ("gear", "pinion"), ("oil", "oil")):
        assert two.heat.temperatures[other] == pytest.approx(one.heat.temperatures[node], abs=1e-4)
    assert abs(one.heat.temperatures["pinion"] - one.heat.temperatures["gear"]) > 0.1


def test_pictures_of_the_pockets_show_the_smaller_gear_first():
    tables = asymmetric.gear_pair()
    one, two = (
        ep.pocket_details(ep.load_case(pair).updated({"numerics.pocket_steps": 10}))["mesh"]
        for pair in (tables, exchanged(tables))
    )
    # what the other order calls gear is the pinion here
    assert (one.attrs["members"], two.attrs["members"]) == ("pinion gear", "gear pinion")
    assert two.attrs["teeth"] == one.attrs["teeth"] == sorted(one.attrs["teeth"])
    for name in ("power", "power_difference", "pressure"):
        assert two[name].to_numpy() == pytest.approx(one[name].to_numpy(), rel=1e-6, nan_ok=True)
