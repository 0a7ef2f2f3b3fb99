"""Speeds of all bodies from the constraints of meshes and clutches.

Speeds are positive in one common sense of rotation.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.elements.base import HOUSING
from epicyclic.machine.linear import solution_of
from epicyclic.machine.machine import Machine

FloatArray = NDArray[np.float64]

SINGULAR = 1e-10
"""Singular values below this share of the largest count as zero: rows are scaled to length 1."""
TOGETHER = 1e-12
"""Speeds that differ by less, relative to the fastest body, are one speed. [1]"""


@dataclass(frozen=True, slots=True)
class Freedom:
    """What the constraints leave open."""

    blocked: bool  # True if the input cannot turn.
    loose: tuple[str, ...]  # Bodies whose speeds the given ones do not determine.
    freedoms: int  # Number of further speeds that would determine them. [1]


def freedom(
    machine: Machine,
    driven: str,  # The input.
    given: Sequence[str],  # Further bodies of given speed, held ones among them.
) -> Freedom:
    """What stays open with the speed of `driven`, and of the bodies `given`, known."""
    bodies = machine.bodies
    others = _matrix(machine, [body for body in given if body != driven])
    whole = np.vstack([others, _unit(bodies, driven)])
    free = _null_space(whole)
    moves = _null_space(others)
    blocked = bool(np.abs(moves[bodies.index(driven)]).max(initial=0.0) < SINGULAR)
    loose = tuple(
        body for body, row in zip(bodies, free, strict=True) if np.abs(row).max(initial=0.0) > 1e-8
    )
    return Freedom(blocked, loose, free.shape[1])


def implied(machine: Machine, known: Sequence[str], further: Sequence[str]) -> tuple[str, ...]:
    """Those of `further` whose speeds follow from the ones before and from the `known` bodies."""
    given, found = list(known), []
    left = _null_space(_matrix(machine, given)).shape[1]
    for body in further:
        now = _null_space(_matrix(machine, [*given, body])).shape[1]
        if now == left:
            found.append(body)
        else:
            given, left = [*given, body], now
    return tuple(found)


def speeds_of(machine: Machine, given: Mapping[str, float]) -> dict[str, float]:
    """Speeds of all bodies, `HOUSING` among them, from `given` ones that determine them. [rad/s]

    Theory (T2).
    """
    bodies = machine.bodies
    matrix = _matrix(machine, list(given))
    known = np.zeros(len(matrix))
    if given:
        known[-len(given) :] = list(given.values())
    if matrix.shape[0] == matrix.shape[1]:
        found = solution_of(matrix, known)
        assert found is not None, "they determine all: the checks of the case say so"
    else:
        least = np.linalg.lstsq(matrix, known, rcond=SINGULAR)[0]
        found = least + np.linalg.lstsq(matrix, known - matrix @ least, rcond=SINGULAR)[0]
    speeds = dict(zip(bodies, map(float, found), strict=True))
    return dict.fromkeys(machine.resting, 0.0) | _joined(speeds | dict(given))


def _joined(speeds: Mapping[str, float]) -> dict[str, float]:
    """`speeds` in which bodies that turn together do so exactly, and still ones stand still."""
    limit = TOGETHER * max(map(abs, speeds.values()), default=0.0)
    joined = {HOUSING: 0.0}
    last = 0.0
    for body, speed in sorted(speeds.items(), key=lambda item: abs(item[1])):
        near = [known for known in (last, -last, 0.0) if abs(speed - known) <= limit]
        joined[body] = near[0] if near else speed
        last = joined[body]
    return joined


def _matrix(machine: Machine, given: Sequence[str]) -> FloatArray:
    """Constraints, scaled to length 1, and below them one row for each given speed."""
    place = {body: index for index, body in enumerate(machine.bodies)}
    rows = []
    constraints = [mesh.terms() for mesh in machine.rows]
    constraints += [coupling.terms() for coupling in machine.couplings]
    for terms in constraints:
        row = np.zeros(len(place))
        for body, coefficient in terms:
            if body != HOUSING:
                row[place[body]] += coefficient
        length = math.hypot(*row)
        rows.append(row / length if length else row)
    rows += [_unit(machine.bodies, body) for body in given]
    return np.array(rows).reshape(len(rows), len(place))


def _unit(bodies: Sequence[str], body: str) -> FloatArray:
    row = np.zeros(len(bodies))
    row[bodies.index(body)] = 1.0
    return row


def _null_space(matrix: FloatArray) -> FloatArray:
    """Columns that span what the rows of `matrix` leave open."""
    from scipy.linalg import null_space

    if not len(matrix):
        return np.eye(matrix.shape[1])
    space: FloatArray = null_space(matrix, rcond=SINGULAR)
    return space
