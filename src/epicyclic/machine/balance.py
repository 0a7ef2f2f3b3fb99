"""Torques of all bodies and loads of all meshes in balance.

A torque is the one that acts on a body from outside, so that torque times speed is the power that
enters there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.elements.base import HOUSING
from epicyclic.machine.linear import solution_of
from epicyclic.machine.machine import Machine, MeshRow, Operation, Terms

FloatArray = NDArray[np.float64]

UNBALANCED = 1e-9
"""Torque left over, relative to the largest one, beyond which there is no balance. [1]"""
SINGULAR = 1e-13
"""Singular values below this share of the largest count as zero."""
LARGEST_FACTOR = 1e6
"""Torques over the given ones beyond which the rank of the system is looked at. [1]"""
ROUNDING = 1e-14
"""Torque, relative to the largest one, that is left over from rounding. [1]"""
NO_POWER = 1e-12
"""Rolling power, relative to the largest one, below which its direction has no meaning. [1]"""


@dataclass(frozen=True, slots=True)
class Friction:
    """Power lost in the relative motion of two bodies."""

    between: tuple[str, str]
    watts: float


@dataclass(frozen=True, slots=True)
class Balance:
    """Torques in balance."""

    torques: Mapping[str, float]  # From outside, on every body. [N m]
    # That each mesh takes up at its first gear, at the load of its driving gear. [N m]
    meshes: Mapping[str, float]
    # That each clutch passes from its first to its second body. [N m]
    couplings: Mapping[str, float]
    # Rolling power of each mesh: what it would pass with its carrier at rest, positive if the first
    # gear drives. [W]
    powers: Mapping[str, float]
    residual: float  # Largest torque left over, relative to the largest one. [1]
    unique: bool  # False if meshes or clutches share a load in more than one possible way.

    @property
    def holds(self) -> bool:
        """False if no torques balance: the output is not connected to the input."""
        return self.residual <= UNBALANCED


def balance(
    machine: Machine,
    operation: Operation,
    speeds: Mapping[str, float],  # Speeds of all bodies. [rad/s]
    drives: Mapping[str, bool],  # For each mesh, True if its first gear drives it.
    efficiencies: Mapping[str, float],  # Efficiency of each mesh with its carrier at rest. [1]
    frictions: Iterable[Friction] = (),
) -> Balance:
    """Torques and mesh loads from the balance of every body. Theory (T3), (T5)."""
    bodies = machine.bodies
    place = {body: index for index, body in enumerate(bodies)}
    unknown = _unknown_torques(operation, place)
    columns = np.zeros((len(bodies), len(machine.rows) + len(machine.couplings) + len(unknown)))
    scale: list[float] = []
    lossy = [_lossy_terms(row, drives[row.key], efficiencies[row.key]) for row in machine.rows]
    stiff = [coupling.terms() for coupling in machine.couplings]
    for number, terms in enumerate((*lossy, *stiff)):
        column: dict[str, float] = {}
        for body, coefficient in terms:
            if body != HOUSING:
                column[body] = column.get(body, 0.0) + coefficient
        length = math.hypot(*column.values()) or 1.0
        for body, coefficient in column.items():
            columns[place[body], number] = coefficient / length
        scale.append(length)
    for number, body in enumerate(unknown, len(scale)):
        columns[place[body], number] = 1.0
    known = _known_torques(machine, operation, speeds, frictions)
    found, unique = _least(columns, -known)
    size = max(float(np.abs(known).max(initial=0.0)), float(np.abs(found).max(initial=0.0)))
    found[np.abs(found) <= ROUNDING * size] = 0.0
    left = columns @ found + known
    lambdas = found[: len(scale)] / np.array(scale)
    outside = dict.fromkeys(bodies, 0.0) | dict(operation.torques)
    outside[operation.input] = operation.torque
    outside |= dict(zip(unknown, map(float, found[len(scale) :]), strict=True))
    meshes = {
        row.key: -float(lambdas[number]) * row.teeth[0] for number, row in enumerate(machine.rows)
    }
    return Balance(
        torques=outside,
        meshes=meshes,
        couplings={
            coupling.key: -float(lambdas[len(machine.rows) + number])
            for number, coupling in enumerate(machine.couplings)
        },
        powers={
            row.key: meshes[row.key] * (speeds[row.first] - speeds[row.carrier])
            for row in machine.rows
        },
        residual=float(np.abs(left).max(initial=0.0)) / size if size else 0.0,
        unique=unique,
    )


def _lossy_terms(row: MeshRow, first: bool, efficiency: float) -> Terms:
    """The terms of a mesh with that of its driven gear reduced; `first` if gear 1 drives."""
    return row.terms(1.0, efficiency) if first else row.terms(efficiency, 1.0)


def _least(matrix: FloatArray, known: FloatArray) -> tuple[FloatArray, bool]:
    """The smallest solution of a linear system, and whether it is the only one."""
    if matrix.shape[0] == matrix.shape[1]:
        only = solution_of(matrix, known)
        size = float(np.abs(known).max(initial=0.0))
        if only is not None and float(np.abs(only).max(initial=0.0)) <= LARGEST_FACTOR * size:
            return only, True
    least, _, rank, _ = np.linalg.lstsq(matrix, known, rcond=SINGULAR)
    found = np.asarray(least, float)
    found += np.linalg.lstsq(matrix, known - matrix @ found, rcond=SINGULAR)[0]
    return found, int(rank) == matrix.shape[1]


def drives_first(powers: Mapping[str, float], before: Mapping[str, bool]) -> dict[str, bool]:
    """For each mesh whether its first gear drives; as `before` where no power flows."""
    limit = NO_POWER * max(map(abs, powers.values()), default=0.0)
    return {key: before[key] if abs(power) <= limit else power > 0 for key, power in powers.items()}


def _unknown_torques(operation: Operation, place: Mapping[str, int]) -> list[str]:
    """Bodies whose torque balances: the output, and all of given speed but the input."""
    held = [body for body in operation.speeds if body not in (operation.input, operation.output)]
    return [body for body in (operation.output, *held) if body in place]


def _known_torques(
    machine: Machine,
    operation: Operation,
    speeds: Mapping[str, float],
    frictions: Iterable[Friction],
) -> FloatArray:
    """Given torques and those of friction on every body. Theory (T6). [N m]"""
    torques = dict.fromkeys((*machine.bodies, *machine.resting, HOUSING), 0.0) | dict(
        operation.torques
    )
    torques[operation.input] += operation.torque
    for friction in frictions:
        one, two = friction.between
        difference = speeds[one] - speeds[two]
        if difference:
            torques[one] -= friction.watts / difference
            torques[two] += friction.watts / difference
    return np.array([torques[body] for body in machine.bodies])
