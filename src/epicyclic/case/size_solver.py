"""Finds centre distances and profile shifts that a case leaves out of meshes.

What was found, and what was adjusted because the printed digits contradict each other, is told in
`Found`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from epicyclic.case.gear_tables import GearTable
from epicyclic.case.messages import micrometres, millimetres
from epicyclic.case.read import value_at
from epicyclic.case.thickness import allowance_shift, thickness_key
from epicyclic.errors import InputError, Problem
from epicyclic.gears.gear import BasicRack, Gear
from epicyclic.gears.mesh import (
    closed_center_distance,
    profile_shift_sum,
    recommended_backlash,
    thinning,
)
from epicyclic.units import MILLIMETRE

FINEST_SHIFT = 0.5e-3
"""Half a unit of the last digit of a profile shift counts at most as this: 0.3 means 0.300. [1]"""
FINEST_LENGTH = 0.5e-6
"""The same of lengths: 39 mm means 39.000 mm. [m]"""
AGREES = 0.5e-6
"""A stated backlash that differs less from that of the teeth is that of the teeth. [m]"""
ROUNDING = 0.5e-9
"""Teeth that are too thick by less than this pass as they are; see `backlash.ROUNDING`. [m]"""
LEAST_SHIFT, LARGEST_SHIFT = -3.0, 5.0
"""What a case may state."""


@dataclass(frozen=True, slots=True)
class Found:
    """A value that the case does not state.

    Attributes
    ----------
    key : str
    value : str
        With unit, as a message shows it.
    how : str
        Where it comes from.
    """

    key: str
    value: str
    how: str

    def __str__(self) -> str:
        return f"{self.key} = {self.value}: {self.how}"


@dataclass(frozen=True, slots=True)
class SizedMesh:
    """A mesh whose centre distance or profile shifts may have to be found."""

    name: str
    backlash_key: str  # Where its backlash is stated.
    gears: tuple[str, str]  # A ring is the second.
    teeth: int  # z1 + z2, those of a ring negative.
    backlash: float | None  # j_bn. [m]
    rack: BasicRack  # Rack of both gears.
    place: tuple[str, ...]  # Path of its centre distance.
    stated_distance: float | None  # [m]
    gives_way: str  # The gear that is thinned where digits contradict each other.
    group: str = ""  # Meshes of one group have one centre distance.
    prefix: str = ""  # Before the names of gears in keys.

    def shift_key(self, name: str) -> str:
        """The key of the profile shift of a gear."""
        return f"{self.prefix}{name}.profile_shift_coefficient"


class Solver:
    """The gears of meshes that have something in common.

    Parameters
    ----------
    made : mapping of str to Gear
        Those that say how thick their teeth are.
    tables : mapping of str to GearTable
        Tables of all gears.
    meshes : sequence of SizedMesh
    raw : mapping
        The tables as the user wrote them, for the digits that are printed.
    """

    def __init__(
        self,
        made: Mapping[str, Gear],
        tables: Mapping[str, GearTable],
        meshes: Sequence[SizedMesh],
        raw: Mapping[str, Any],
    ) -> None:
        self.tables, self.meshes, self.raw = dict(tables), meshes, raw
        self.found: list[Found] = []
        self.distances: dict[str, float] = {
            mesh.group: mesh.stated_distance
            for mesh in reversed(meshes)
            if mesh.stated_distance is not None
        }
        racks = {name: mesh.rack for mesh in meshes for name in mesh.gears}
        self.thinned = {
            name: allowance_shift(table, racks[name])
            for name, table in tables.items()
            if name in racks
        }
        self.shifts = {  # nominal, without allowances
            name: gear.profile_shift_coefficient - self.thinned[name]
            for name, gear in made.items()
            if name in racks
        }

    def solve(self) -> None:
        """Find what is left out; raise `InputError` if that cannot be."""
        doubly = [mesh for mesh in self.meshes if self.shifts.keys() >= set(mesh.gears)]
        while (mesh := self._find_distance()) is not None or self._find_shift():
            if mesh in doubly:
                doubly.remove(mesh)
        without = [mesh for mesh in self.meshes if mesh.group not in self.distances]
        if without:
            raise _no_distance(without)
        free = [name for name in self.thinned if name not in self.shifts]
        if free:
            raise self._no_shift(free)
        for mesh in doubly:
            self._adjust(mesh)

    # --- centre distances ---

    def _find_distance(self) -> SizedMesh | None:
        """From the first mesh without one both of whose gears state their thickness."""
        for mesh in self.meshes:
            if mesh.group not in self.distances and self.shifts.keys() >= set(mesh.gears):
                distance = self._closed(mesh)
                self.distances[mesh.group] = distance
                self._tell(".".join(mesh.place), f"{1e3 * distance:.4f} mm", mesh)
                return mesh
        return None

    def _closed(self, mesh: SizedMesh) -> float:
        total = sum(self.shifts[name] for name in mesh.gears) + self._allowances(mesh)
        try:
            return closed_center_distance(mesh.rack, mesh.teeth, total, mesh.backlash or 0.0)
        except ValueError as error:
            raise _refused(
                ", ".join(map(mesh.shift_key, mesh.gears)),
                "",
                f"leave no centre distance: {error}.",
                f"Correct the profile shifts, or give {'.'.join(mesh.place)}.",
            ) from None

    # --- profile shifts ---

    def _find_shift(self) -> bool:
        """Profile shift of the first gear without one, the thinner of what its mates leave."""
        for name in self.thinned:
            known = [] if name in self.shifts else list(self._known_mates(name))
            if known:
                shift, mesh = min(
                    ((self._sum(mesh) - self.shifts[mate], mesh) for mesh, mate in known),
                    key=lambda item: item[0],
                )
                self._set(name, shift, mesh)
                self._tell(mesh.shift_key(name), f"{shift:z.4f}", mesh)
                return True
        return False

    def _known_mates(self, name: str) -> Iterator[tuple[SizedMesh, str]]:
        for mesh in self.meshes:
            if name in mesh.gears and mesh.group in self.distances:
                mate = mesh.gears[1 - mesh.gears.index(name)]
                if mate in self.shifts:
                    yield mesh, mate

    def _no_shift(self, free: list[str]) -> InputError:
        mesh = {name: mesh for mesh in self.meshes for name in mesh.gears}
        return _refused(
            ", ".join(mesh[name].shift_key(name) for name in free),
            "",
            "is missing, and so is that of every mate.",
            "Add one of them, or tooth_thickness with thickness_diameter: the others "
            "follow from the centre distance.",
        )

    def _sum(self, mesh: SizedMesh) -> float:
        """Nominal x1 + x2 of a mesh; 0 if its gears cannot mesh, which is told with the meshes."""
        distance = self.distances[mesh.group]
        try:
            total = profile_shift_sum(mesh.rack, mesh.teeth, distance, mesh.backlash or 0.0)
        except ValueError:
            return 0.0
        return total - self._allowances(mesh)

    def _allowances(self, mesh: SizedMesh) -> float:
        """What allowances take from x1 + x2 before the stated backlash is left.

        Where none is stated, the nominal teeth have none.
        """
        return 0.0 if mesh.backlash is None else sum(self.thinned[name] for name in mesh.gears)

    def _set(self, name: str, shift: float, mesh: SizedMesh) -> None:
        if not LEAST_SHIFT <= shift <= LARGEST_SHIFT:
            raise _refused(
                mesh.shift_key(name),
                "",
                f"would have to be {shift:.3g} at the centre distance of "
                f"{millimetres(self.distances[mesh.group])}, and must be >= {LEAST_SHIFT:g} and <= "
                f"{LARGEST_SHIFT:g}.",
                f"Correct {'.'.join(mesh.place)}, the tooth numbers or the module.",
            )
        self.shifts[name] = shift
        keys = {key: None for choice in GearTable.THICKNESS for key in choice.split("+")}
        self.tables[name] = self.tables[name].model_copy(
            update=keys | {"profile_shift_coefficient": shift}
        )

    def _tell(self, key: str, value: str, mesh: SizedMesh) -> None:
        """Note what was found from a mesh."""
        if mesh.backlash is None:
            distance = self.distances[mesh.group]
            least = micrometres(recommended_backlash(mesh.rack, distance))
            with_what = (
                f"without backlash of the nominal teeth; ISO/TR 10064-2 recommends {least} or more"
            )
        else:
            with_what = f"with a normal backlash of {micrometres(mesh.backlash)}"
        self.found.append(Found(key, value, f"found from the {mesh.name}, {with_what}."))

    # --- what is stated twice ---

    def _adjust(self, mesh: SizedMesh) -> None:
        """Thin a gear whose teeth are too thick by less than the printed digits."""
        over = sum(self.shifts[name] for name in mesh.gears) - self._sum(mesh)
        if mesh.backlash is None:
            over += sum(self.thinned[name] for name in mesh.gears)
        backlash = over * -2 * mesh.rack.normal_module * math.sin(mesh.rack.normal_pressure_angle)
        if mesh.backlash is not None and abs(backlash) > AGREES:
            raise _refused(
                mesh.backlash_key,
                millimetres(mesh.backlash),
                f"contradicts the teeth and the centre distance, which leave "
                f"{micrometres(backlash + mesh.backlash)}.",
                "Leave out normal_backlash, a profile shift or the centre distance.",
            )
        if mesh.backlash is not None or backlash > -ROUNDING or over > self._printed(mesh):
            return
        name = mesh.gives_way
        shift = self.shifts[name] - over
        self._set(name, shift, mesh)
        self.found.append(
            Found(
                mesh.shift_key(name),
                f"{shift:.6f}",
                f"adjusted, because the teeth of the {mesh.name} are {-1e9 * backlash:.3g} nm too "
                "thick for the centre distance, less than the printed digits tell.",
            )
        )

    def _printed(self, mesh: SizedMesh) -> float:
        """How far x1 + x2 may be from the centre distance by the digits of both. [1]"""
        distance = self.distances[mesh.group]
        step = self._half_digit(mesh.place, FINEST_LENGTH)
        away = profile_shift_sum(mesh.rack, mesh.teeth, distance + step)
        near = profile_shift_sum(mesh.rack, mesh.teeth, distance)
        return abs(away - near) + sum(self._printed_shift(mesh, name) for name in mesh.gears)

    def _printed_shift(self, mesh: SizedMesh, name: str) -> float:
        key = thickness_key(name, self.tables[name]).rpartition(".")[2]
        path = (*filter(None, mesh.prefix.split(".")), name, key)
        if self.tables[name].profile_shift_coefficient is not None:
            return self._half_digit(path, FINEST_SHIFT)
        return thinning(mesh.rack, self._half_digit(path, FINEST_LENGTH))

    def _half_digit(self, path: tuple[str, ...], most: float) -> float:
        """Half a unit of the last digit that the user wrote, in SI; 0 if he wrote none."""
        given = value_at(dict(self.raw), path)
        if given is None:
            return 0.0
        match = re.match(r"\s*[-+]?\d*\.?(\d*)(?:[eE]([-+]?\d+))?\s*(.*)", str(given))
        assert match is not None
        half = 0.5 * 10.0 ** (int(match[2] or 0) - len(match[1]))
        return min(most, MILLIMETRE.parse(f"{half!r} {match[3]}") if match[3] else half)


def _no_distance(meshes: Sequence[SizedMesh]) -> InputError:
    place = ".".join(meshes[0].place)
    pairs = " or ".join(" and ".join(mesh.gears) for mesh in meshes)
    table, _, key = place.rpartition(".")
    return _refused(
        place,
        "",
        f"is missing, and no mesh tells it: that takes the tooth thickness of both gears, {pairs}.",
        f'Add {key} = "... mm" to [{table}], or profile_shift_coefficient to them.',
    )


def _refused(key: str, value: str, allowed: str, remedy: str) -> InputError:
    return InputError([Problem(key, value, allowed, remedy)])
