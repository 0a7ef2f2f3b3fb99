"""A gear pair on parallel axes as a machine."""

from __future__ import annotations

from collections.abc import Mapping

from epicyclic.builders.built import Built
from epicyclic.builders.gears import gear_mesh
from epicyclic.builders.models import fluids_of, loss_choices, mesh_models
from epicyclic.builders.wetting import gear_disc
from epicyclic.case import build
from epicyclic.case.case import GearPairCase
from epicyclic.gears.cutting import mated_tools
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.machine.element import HOUSING, joined_key
from epicyclic.machine.gear_set import GearSet, Reference
from epicyclic.machine.machine import Machine, MeshRow, Operation
from epicyclic.result.result import Layout

PAIR_MEMBERS = ("pinion", "gear")


def build_pair(case: GearPairCase, flow_tables: FlowTables) -> Built:
    """A single gear pair, driven as the case says."""
    bodies = {name: name for name in PAIR_MEMBERS}
    element = pair_element("", case, bodies, "pinion", flow_tables)
    return Built(
        machine=Machine(PAIR_MEMBERS, pair_rows("", case, bodies), (element,)),
        operation=Operation(
            "pinion", "gear", case.operation.torque, {"pinion": case.operation.speed}
        ),
        known_fluids=fluids_of(case),
        sets={"": element},
        layout=Layout(tuple(element.choices), PAIR_MEMBERS, ("mesh",)),
    )


def pair_rows(key: str, case: GearPairCase, bodies: Mapping[str, str]) -> tuple[MeshRow, ...]:
    """The constraint of a pair. Theory (K6)."""
    teeth = (case.pinion.teeth, case.gear.teeth)
    one, two = (bodies[name] for name in PAIR_MEMBERS)
    return (MeshRow(f"{key}.mesh", one, two, HOUSING, teeth, case.gear.internal),)


def pair_element(
    key: str,  # First part of the keys of its losses.
    case: GearPairCase,
    bodies: Mapping[str, str],  # Bodies of ``"pinion"`` and ``"gear"``.
    reference: str,  # The gear whose torque states the load.
    flow_tables: FlowTables,  # Tables of flows through pockets.
) -> GearSet:
    """The losses of a pair."""
    mesh = build.pair_mesh(case.gears, case.pinion, case.gear)
    tables = (case.pinion, case.gear)
    other = "gear" if reference == "pinion" else "pinion"
    sense = -1 if mesh.internal else 1
    lever = 1.0 if reference == "pinion" else sense * case.pinion.teeth / case.gear.teeth
    discs = tuple(
        gear_disc(case, bodies[gear.name], gear, table)
        for gear, table in zip((mesh.gear1, mesh.gear2), tables, strict=True)
    )
    return GearSet(
        key=key,
        carrier=HOUSING,
        meshes=(
            gear_mesh(
                "mesh",
                mesh,
                tables,
                bodies=(bodies["pinion"], bodies["gear"]),
                nodes=(joined_key(key, "pinion"), joined_key(key, "gear")),
                tools=mated_tools(mesh, (case.pinion.tool_tip_radius, case.gear.tool_tip_radius)),
                misalignment=case.mesh.misalignment,
                models=mesh_models(case, flow_tables)["mesh"],
            ),
        ),
        planets=(),
        sharing=None,
        discs={"drag": discs},
        missing={},
        thrust=None,
        choices=loss_choices(case),
        reference=(
            None
            if case.models.mesh_loads == "with-losses"
            else Reference(bodies[reference], {"mesh": lever}, (bodies[other], HOUSING))
        ),
    )
