"""How the oil of a case meets the bodies that turn in it."""

from __future__ import annotations

from epicyclic.builders.lubrication import oil_share
from epicyclic.builders.set_case import SetCase
from epicyclic.case.gear_tables import GearTable
from epicyclic.case.gearing import outside_radius
from epicyclic.case.tables.operation import LubricationTable
from epicyclic.gears.gear import Gear
from epicyclic.losses.drag import Dipped
from epicyclic.machine.disc import Disc, Jets, Sump


def gear_disc(case: SetCase, body: str, gear: Gear, table: GearTable) -> Disc:
    """A central gear as it turns in the mixture, dips or meets jets.

    A ring dips as a body without teeth: those of its inside are left out.
    """
    radius = outside_radius(gear, table)
    pitch = radius if gear.internal else gear.reference_radius
    part = Dipped(
        radius=pitch,
        tip_radius=radius,
        width=gear.face_width,
        depth=_depth(case.lubrication, gear.name, radius),
        module=gear.rack.normal_module,
        teeth=0 if gear.internal else gear.teeth,
        tooth_height=abs(gear.tip_radius - gear.root_radius),
        pressure_angle=gear.rack.normal_pressure_angle,
        helix_angle=abs(gear.rack.helix_angle),
    )
    return Disc(
        where=gear.name,
        body=body,
        radius=radius,
        width=gear.face_width,
        oil_fraction=oil_share(case).share,
        sump=_sump(case, part),
        jets=_jets(case.lubrication, gear),
    )


def carrier_disc(case: SetCase, body: str, outer_diameter: float, width: float, mate: Gear) -> Disc:
    """A carrier as it turns in the mixture or dips; its flow is told apart by a gear beside it."""
    radius = outer_diameter / 2
    depth = _depth(case.lubrication, "carrier", radius)
    part = Dipped(radius, radius, width, depth, mate.rack.normal_module)
    return Disc("carrier", body, radius, width, oil_share(case).share, _sump(case, part))


def _depth(table: LubricationTable | None, name: str, radius: float) -> float:
    """Depth of the lowest point of a part below the oil at rest; 0 above it. [m]"""
    if table is None or table.method != "dip":
        return 0.0
    if table.oil_level is not None:
        return max(radius + table.oil_level, 0.0)
    return table.immersion.get(name, 0.0)


def _sump(case: SetCase, part: Dipped) -> Sump | None:
    table = case.lubrication
    if table is None or table.method != "dip":
        return None
    volume = case.thermal.oil_volume if table.oil_volume is None else table.oil_volume
    assert volume is not None
    return Sump(part, volume, table.churning)


def _jets(table: LubricationTable | None, gear: Gear) -> Jets | None:
    if table is None or table.method != "jet" or not table.oil_flow:
        return None
    return Jets(table.oil_flow, table.jet_speed, table.nozzle_side, gear.reference_radius)
