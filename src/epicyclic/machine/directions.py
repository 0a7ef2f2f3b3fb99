"""Which gear drives each mesh: the directions of the rolling powers that agree with themselves.

Which gear of a mesh drives decides on which side its efficiency stands, and the torques with these
efficiencies decide which gear drives. Near self-locking, losses turn some directions round against
those of the lossless flow, and more than one set of directions may agree with itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations, islice

from epicyclic.machine.balance import Balance, balance, drives_first
from epicyclic.machine.machine import Machine, Operation

MOST_TRIED = 2000
"""Sets of directions that are tried; all of them for up to ten meshes that pass power."""
MOST_FOLLOWED = 8
"""Steps from the directions of the lossless flow to those that its torques with losses have."""

Drives = Mapping[str, bool]


@dataclass(frozen=True, slots=True)
class Directions:
    """Directions of the rolling powers."""

    drives: Drives  # For each mesh, True if its first gear drives it.
    # True if no directions agree with themselves and leave the output torque its lossless sign: the
    # machine is self-locking.
    locking: bool
    # True if no directions agree with themselves at all: no torque on the output lets the machine
    # turn with this torque on the input.
    jammed: bool = False


def find_directions(
    machine: Machine,
    operation: Operation,
    speeds: Mapping[str, float],  # Speeds of all bodies. [rad/s]
    lossless: Balance,  # Torques without losses.
    efficiencies: Mapping[str, float],  # Efficiency of each mesh with its carrier at rest. [1]
) -> Directions:
    """The directions that count, with these efficiencies of the meshes. Theory (T4).

    They start as without losses and follow the torques. Of the directions that agree with
    themselves those count whose output torque has the sign of the lossless one; without any the
    machine is self-locking, and the first that agree count: the output must be driven too. If none
    agree, it is jammed.
    """
    start = drives_first(lossless.powers, dict.fromkeys(lossless.powers, True))
    wanted = lossless.torques[operation.output]
    passes = any(lossless.powers.values())
    if not passes or all(efficiency == 1 for efficiency in efficiencies.values()):
        return Directions(start, locking=False)
    agreeing: Drives | None = None
    drives: Drives = start
    seen = []
    for _ in range(MOST_FOLLOWED):
        found = balance(machine, operation, speeds, drives, efficiencies)
        follow = drives_first(found.powers, drives)
        if follow == drives:
            if found.torques[operation.output] * wanted >= 0:
                return Directions(drives, locking=False)
            agreeing = drives
        seen.append(drives)
        if follow in seen:
            break
        drives = follow
    for drives in islice(_turned(start, lossless, efficiencies), MOST_TRIED):
        found = balance(machine, operation, speeds, drives, efficiencies)
        if drives_first(found.powers, drives) == drives:
            if found.torques[operation.output] * wanted >= 0:
                return Directions(drives, locking=False)
            agreeing = agreeing or drives
    return Directions(agreeing or start, locking=True, jammed=agreeing is None)


def _turned(
    start: Drives, lossless: Balance, efficiencies: Mapping[str, float]
) -> Iterator[Drives]:
    """`start` with ever more directions turned round, of the meshes that lose power."""
    able = [key for key, power in lossless.powers.items() if power and efficiencies[key] < 1]
    for count in range(1, len(able) + 1):
        for turned in combinations(able, count):
            yield {key: drives != (key in turned) for key, drives in start.items()}
