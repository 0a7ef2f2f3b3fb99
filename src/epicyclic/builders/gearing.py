"""The gears, meshes and planets of a set, whichever kind it is.

What reads a `Gearing` need not know of what kind the case is; `gearing_of` alone asks.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from epicyclic.case import build
from epicyclic.case.case import GearPairCase, PlanetaryCase
from epicyclic.case.gear_tables import GearTable
from epicyclic.case.listed_set import ListedCase, arrangement_of, gear_of, meshes_of
from epicyclic.case.tables.elements import PlanetBearing
from epicyclic.case.tables.models import LoadSharing, LossOption
from epicyclic.gears.gear import Gear
from epicyclic.gears.mesh import Mesh

SetCase = PlanetaryCase | GearPairCase | ListedCase
"""A set or pair with its oil and surroundings."""


class Gearing(ABC):
    """What the tables of a set say of its gears."""

    prefix = ""
    """Stands before the name of a gear in a key of the case."""

    @property
    @abstractmethod
    def tables(self) -> Mapping[str, GearTable]:
        """The tables of the gears, by their names."""

    @property
    @abstractmethod
    def losses(self) -> Mapping[str, LossOption]:
        """What becomes of each loss, in the order in which they are shown."""

    @property
    @abstractmethod
    def misalignments(self) -> tuple[float, ...]:
        """Misalignments of the meshes. [rad]"""

    @property
    def planets(self) -> int:
        """Number of each kind of planets; zero without a carrier."""
        return 0

    @property
    def sharing(self) -> LoadSharing | None:
        """How planets share the load; None without planets."""
        return None

    @property
    def bearings(self) -> tuple[PlanetBearing | None, ...]:
        """One for each kind of planets; None if the case has no table of it."""
        return ()

    @abstractmethod
    def gear(self, name: str) -> Gear:
        """The gear of this name."""

    @abstractmethod
    def meshes(self) -> tuple[Mesh, ...]:
        """All meshes."""

    def planet_angles(self) -> tuple[float, ...]:
        """Where the planets stand around the axis; empty without planets. [rad]"""
        return ()

    def rings(self) -> Iterator[tuple[str, GearTable, Gear]]:
        """Key, table and geometry of every internal gear."""
        for name, table in self.tables.items():
            if build.is_internal(table):
                yield self.prefix + name, table, self.gear(name)


@dataclass(frozen=True, slots=True)
class _Planetary(Gearing):
    case: PlanetaryCase

    @property
    def tables(self) -> Mapping[str, GearTable]:
        return {"sun": self.case.sun, "planet": self.case.planet, "ring": self.case.ring}

    @property
    def losses(self) -> Mapping[str, LossOption]:
        return dict(self.case.losses)

    @property
    def misalignments(self) -> tuple[float, ...]:
        return self.case.sun_mesh.misalignment, self.case.ring_mesh.misalignment

    @property
    def planets(self) -> int:
        return self.case.planet.count

    @property
    def sharing(self) -> LoadSharing | None:
        return self.case.load_sharing

    @property
    def bearings(self) -> tuple[PlanetBearing | None, ...]:
        return (self.case.planet_bearing,)

    def gear(self, name: str) -> Gear:
        return build.gear(name, self.tables[name], self.case.gears)

    def meshes(self) -> tuple[Mesh, ...]:
        case = self.case
        return build.planetary_meshes(case.gears, case.sun, case.planet, case.ring)

    def planet_angles(self) -> tuple[float, ...]:
        return build.planet_angles(self.case.sun, self.case.planet, self.case.ring)


@dataclass(frozen=True, slots=True)
class _Pair(Gearing):
    case: GearPairCase

    @property
    def tables(self) -> Mapping[str, GearTable]:
        return {"pinion": self.case.pinion, "gear": self.case.gear}

    @property
    def losses(self) -> Mapping[str, LossOption]:
        return dict(self.case.losses)

    @property
    def misalignments(self) -> tuple[float, ...]:
        return (self.case.mesh.misalignment,)

    def gear(self, name: str) -> Gear:
        return build.gear(name, self.tables[name], self.case.gears)

    def meshes(self) -> tuple[Mesh, ...]:
        return (build.pair_mesh(self.case.gears, self.case.pinion, self.case.gear),)


@dataclass(frozen=True, slots=True)
class _Listed(Gearing):
    case: ListedCase
    prefix = "gears."

    @property
    def tables(self) -> Mapping[str, GearTable]:
        return self.case.table.members

    @property
    def losses(self) -> Mapping[str, LossOption]:
        return self.case.loss_options

    @property
    def misalignments(self) -> tuple[float, ...]:
        return tuple(mesh.misalignment for mesh in self.case.table.mesh.values())

    @property
    def planets(self) -> int:
        return self.case.table.planets or 0

    @property
    def sharing(self) -> LoadSharing | None:
        return self.case.table.load_sharing if self.planets else None

    @property
    def bearings(self) -> tuple[PlanetBearing | None, ...]:
        return self.case.planet_bearings

    def gear(self, name: str) -> Gear:
        return gear_of(self.case.table, name)

    def meshes(self) -> tuple[Mesh, ...]:
        return tuple(mesh for _, mesh, _ in meshes_of(self.case.table, self.case.shape))

    def planet_angles(self) -> tuple[float, ...]:
        planets = self.planets
        return arrangement_of(self.case.shape, planets).angles if planets else ()


def gearing_of(case: SetCase) -> Gearing:
    """The gears of the case of a set."""
    if isinstance(case, PlanetaryCase):
        return _Planetary(case)
    return _Pair(case) if isinstance(case, GearPairCase) else _Listed(case)
