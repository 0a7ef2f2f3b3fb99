"""Forces on the bearings of shafts, from the loads of the meshes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from epicyclic.elements.reactions import ShaftLoad, Support, bearing_reactions, mesh_load
from epicyclic.losses.shaft_bearing import BearingLoad


@dataclass(frozen=True, slots=True)
class GearSeat:
    """A gear on a shaft, in one of its meshes."""

    mesh: str  # Key of the mesh.
    # Torque of the mesh on the gear over the torque that the mesh takes up at its first gear. [1]
    lever: float
    position: float  # Along the shaft. [m]
    radius: float  # Operating radius. [m]
    pressure_angle: float  # Operating, transverse. [rad]
    helix_tangent: float  # tan(beta_w). [1]
    hand: int  # +1 for a right-handed helix of the teeth, -1 for a left-handed one.
    direction: float  # Direction of the vector from the axis of the gear to the pitch point. [rad]
    internal: bool  # True for a ring gear.
    around: bool  # True if several planets stand around the gear: their radial forces cancel.

    def load(self, torque: float) -> ShaftLoad:
        """BearingLoad of the mesh on the shaft."""
        load = mesh_load(
            self.position,
            self.lever * torque,
            self.radius,
            self.pressure_angle,
            self.helix_tangent,
            self.hand,
            self.direction,
            internal=self.internal,
        )
        if not self.around:
            return load
        return ShaftLoad(self.position, (0.0, 0.0, load.force[2]))


@dataclass(frozen=True, slots=True)
class ShaftLayout:
    """What stands along a shaft whose bearing forces are computed."""

    supports: Mapping[str, Support]  # Its bearings, by the keys of their elements.
    seats: tuple[GearSeat, ...]


def forces_of(
    layouts: Iterable[ShaftLayout],
    torques: Mapping[str, float],  # That each mesh takes up at its first gear. [N m]
) -> dict[str, BearingLoad]:
    """Forces on the bearings of all shafts, by the keys of their elements."""
    forces: dict[str, BearingLoad] = {}
    for layout in layouts:
        loads = [seat.load(torques[seat.mesh]) for seat in layout.seats]
        reactions = bearing_reactions(tuple(layout.supports.values()), loads)
        for key, reaction in zip(layout.supports, reactions, strict=True):
            forces[key] = reaction.force
    return forces
