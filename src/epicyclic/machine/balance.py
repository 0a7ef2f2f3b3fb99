"""Speeds, torques and directions of power of a machine, from the constraints of its meshes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from itertools import combinations, islice, pairwise
from typing import Any

import numpy as np

from epicyclic.arrays import Apart, FloatArray, agreed, apart, either, hypot, largest, side_by_side
from epicyclic.dataclass import dataclass
from epicyclic.gears.gear import HOUSING
from epicyclic.machine.machine import Machine, Operation, Terms

# Systems of as many linear equations as unknowns.


def solution_of(matrix: FloatArray, right: FloatArray) -> FloatArray | None:
    """The solution, refined once; None if the square `matrix` is singular."""
    try:
        inverse = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        return None
    found = (inverse @ right[..., None])[..., 0]
    return found + (inverse @ (right - (matrix @ found[..., None])[..., 0])[..., None])[..., 0]


# Speeds of all bodies from the constraints of meshes and clutches.
#
# Speeds are positive in one common sense of rotation.

SINGULAR = 1e-10
"""Singular values below this share of the largest count as zero: rows are scaled to length 1."""
LOOSE = 1e-8  # Part of a body in what stays open, from which its speed is open. [1]
TOGETHER = 1e-12  # Speeds that differ by less, relative to the fastest body, are one speed. [1]


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
    free = _null_space(np.vstack([others, np.eye(len(bodies))[bodies.index(driven)]]))
    blocked = bool(np.abs(_null_space(others)[bodies.index(driven)]).max(initial=0.0) < SINGULAR)
    loose = tuple(
        body for body, row in zip(bodies, free, strict=True) if np.abs(row).max(initial=0.0) > LOOSE
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
    known = side_by_side([*[0.0] * (len(matrix) - len(given)), *given.values()])
    if matrix.shape[0] == matrix.shape[1]:
        found = solution_of(matrix, known)
        assert found is not None, "the speeds are determined, as the checks of the case ensure"
    else:
        inverse = np.linalg.pinv(matrix, rcond=SINGULAR)
        least = (inverse @ known[..., None])[..., 0]
        left = known - (matrix @ least[..., None])[..., 0]
        found = least + (inverse @ left[..., None])[..., 0]
    speeds = dict(zip(bodies, apart(found), strict=True)) | dict(given)
    # bodies that turn together do so exactly, and still ones stand still
    limit = TOGETHER * largest(speeds.values())
    joined = {HOUSING: 0.0}
    last = 0.0
    ordered = sorted(speeds.items(), key=lambda item: np.abs(item[1]).flat[0])
    for (_, slower), (_, faster) in pairwise(ordered):
        assert abs(slower) <= abs(faster) + limit  # or points part that have other orders
    for body, speed in ordered:
        near = [known for known in (last, -last, 0.0) if abs(speed - known) <= limit]
        joined[body] = last = near[0] if near else speed
    return dict.fromkeys(machine.resting, 0.0) | joined


def exact_speeds(machine: Machine, given: Mapping[str, int]) -> dict[str, Fraction] | None:
    """Speeds of all bodies without rounding; None if they are not determined, or contradict."""
    bodies = machine.bodies
    constraints: list[Terms] = [mesh.terms() for mesh in machine.rows]
    constraints += [coupling.terms() for coupling in machine.couplings]
    constraints += [((body, 1.0),) for body in given]
    done: dict[str, dict[str, Fraction]] = {}  # rows by the body that each stands for
    for number, terms in enumerate(constraints):
        row: dict[str, Fraction] = {}
        for body, coefficient in terms:
            if body != HOUSING:
                row[body] = row.get(body, Fraction(0)) + Fraction(coefficient)
        last = number - len(constraints) + len(given)
        row["="] = Fraction(list(given.values())[last] if last >= 0 else 0)
        for body in [body for body in row if body in done]:
            _take_out(row, body, done[body])
        left = next((body for body in row if body != "=" and row[body]), None)
        if left is None:
            if row["="]:
                return None
            continue
        own = {body: value / row[left] for body, value in row.items() if value or body == "="}
        for other in done.values():
            if left in other:
                _take_out(other, left, own)
        done[left] = own
    return None if len(done) < len(bodies) else {body: done[body]["="] for body in bodies}


def _take_out(row: dict[str, Fraction], body: str, other: Mapping[str, Fraction]) -> None:
    """Subtract from `row` what takes a body out of it; `other` has it once."""
    factor = row.pop(body)
    for key, value in other.items():
        if key != body:
            row[key] = row.get(key, Fraction(0)) - factor * value


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
    rows += [np.eye(len(place))[place[body]] for body in given]
    return np.array(rows).reshape(len(rows), len(place))


def _null_space(matrix: FloatArray) -> FloatArray:
    """Columns that span what the rows of `matrix` leave open."""
    _, sizes, directions = np.linalg.svd(matrix)
    return directions[np.count_nonzero(sizes > SINGULAR * sizes.max(initial=0.0)) :].T


# Torques of all bodies and loads of all meshes in balance.
#
# A torque is the one that acts on a body from outside, so that torque times speed is the power that
# enters there.

SINGULAR_BALANCE = 1e-13  # Singular values below this share of the largest count as zero.
LARGEST_FACTOR = 1e6
"""Torques over the given ones beyond which the rank of the system is looked at. [1]"""
ROUNDING = 1e-14  # Torque, relative to the largest one, that is left over from rounding. [1]
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

    pointwise = True

    torques: Mapping[str, float]  # From outside, on every body. [N m]
    # That each mesh takes up at its first gear, at the load of its driving gear. [N m]
    meshes: Mapping[str, float]
    # That each clutch passes from its first to its second body. [N m]
    couplings: Mapping[str, float]
    # Rolling power of each mesh: what it would pass with its carrier at rest, positive if the first
    # gear drives. [W]
    powers: Mapping[str, float]
    unique: bool  # False if meshes or clutches share a load in more than one possible way.
    # Of the meshes, if torques and losses agree; else None. [1]
    efficiencies: Mapping[str, float] | None = None


@dataclass(frozen=True)
class Statics:
    """A machine that turns at given speeds: what balances whatever losses."""

    machine: Machine
    operation: Operation
    speeds: Mapping[str, float]  # Of all bodies. [rad/s]

    def balance(
        self,
        drives: Mapping[str, bool] | None = None,  # For each mesh, True if its first gear drives.
        # Of each mesh with its carrier at rest; None, and no directions, without losses. [1]
        efficiencies: Mapping[str, float] | None = None,
        frictions: Iterable[Friction] = (),
    ) -> Balance:
        """Torques and mesh loads from the balance of every body. Theory (T3), (T5), (T6)."""
        rows, couplings, speeds = self.machine.rows, self.machine.couplings, self.speeds
        columns, scale = [], []
        for row in rows:  # the term of the driven gear is reduced
            lost = 1.0 if efficiencies is None else efficiencies[row.key]
            first = drives is None or drives[row.key]
            one, two = either(first, 1.0, lost), either(first, lost, 1.0)
            column, length = self._column(row.terms(one, two))
            columns.append(column)
            scale.append(length)
        fixed, lengths, unknown = self._fixed
        scale += lengths
        own, bodies = self.operation, self.machine.bodies
        given = dict.fromkeys(bodies, 0.0) | dict(own.torques) | {own.input: own.torque}
        known_of = {body: given[body] for body in bodies}  # with those of friction (T6)
        for friction in frictions:
            one, two = friction.between
            difference = speeds[one] - speeds[two]
            if difference:
                torque = friction.watts / difference
                if one in known_of:
                    known_of[one] = known_of[one] - torque
                if two in known_of:
                    known_of[two] = known_of[two] + torque
        known = side_by_side(known_of.values())
        matrix = np.empty((*known.shape[:-1], *fixed.shape))
        matrix[...] = fixed
        for number, column in enumerate(columns):
            matrix[..., number] = side_by_side(column) if matrix.ndim > 2 else column
        found, unique = _least(matrix, -known)
        values = apart(found)
        size = largest((*apart(known), *values))
        values = [value * (abs(value) > ROUNDING * size) + 0.0 for value in values]  # no -0.0
        lambdas = [value / length for value, length in zip(values, scale, strict=False)]
        outside = given | dict(zip(unknown, values[len(scale) :], strict=True))
        meshes = {row.key: -value * row.teeth[0] for row, value in zip(rows, lambdas, strict=False)}
        return Balance(
            torques=outside,
            meshes=meshes,
            couplings={
                coupling.key: -value
                for coupling, value in zip(couplings, lambdas[len(rows) :], strict=True)
            },
            powers={
                row.key: meshes[row.key] * (speeds[row.first] - speeds[row.carrier]) for row in rows
            },
            unique=unique,
        )

    @cached_property
    def _fixed(self) -> tuple[FloatArray, list[float], list[str]]:
        """Columns of clutches and unknown torques behind those of meshes; lengths of the former.

        Unknown are the torques of the output, and of bodies of given speed but the input.
        """
        own, bodies = self.operation, self.machine.bodies
        held = (body for body in own.speeds if body not in (own.input, own.output))
        unknown = [body for body in (own.output, *held) if body in bodies]
        columns = [self._column(coupling.terms()) for coupling in self.machine.couplings]
        first = len(self.machine.rows)
        matrix = np.zeros((len(bodies), first + len(columns) + len(unknown)))
        for number, (column, _) in enumerate(columns, first):
            matrix[:, number] = column
        for number, body in enumerate(unknown, first + len(columns)):
            matrix[bodies.index(body), number] = 1.0
        return matrix, [length for _, length in columns], unknown

    def _column(self, terms: Terms) -> tuple[list[float], float]:
        """A constraint as a column of length 1, and its length."""
        bodies = self.machine.bodies
        column = [0.0] * len(bodies)
        for body, coefficient in terms:
            if body != HOUSING:
                column[bodies.index(body)] += coefficient
        length = hypot(*column) or 1.0
        return [coefficient / length for coefficient in column], length


def _least(matrix: FloatArray, known: FloatArray) -> tuple[FloatArray, bool]:
    """The smallest solution of a linear system, and whether it is the only one."""
    if matrix.shape[-2] == matrix.shape[-1]:
        only = solution_of(matrix, known)
        if only is not None:
            size = largest(apart(known))
            if largest(apart(only)) <= LARGEST_FACTOR * size:
                return only, True
    if known.ndim > 1 and len(known) > 1:
        raise Apart(np.arange(len(known)) == 0)
    points = known.shape[:-1]
    matrix, known = matrix.reshape(matrix.shape[-2:]), known.ravel()
    least, _, rank, _ = np.linalg.lstsq(matrix, known, rcond=SINGULAR_BALANCE)
    found: Any = np.asarray(least, float)
    found += np.linalg.lstsq(matrix, known - matrix @ found, rcond=SINGULAR_BALANCE)[0]
    return found.reshape((*points, -1)), int(rank) == len(matrix.T)


def drives_first(powers: Mapping[str, float], before: Mapping[str, bool]) -> dict[str, bool]:
    """For each mesh whether its first gear drives; as `before` where no power flows."""
    limit = NO_POWER * largest(powers.values())
    return {
        key: agreed(either(abs(power) <= limit, before[key], power > 0))
        for key, power in powers.items()
    }


# Which gear drives each mesh: the directions of the rolling powers that agree with themselves.
#
# Which gear of a mesh drives decides on which side its efficiency stands, and the torques with
# these efficiencies decide which gear drives. Near self-locking, losses turn some directions round
# against those of the lossless flow, and more than one set of directions may agree with itself.

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
    statics: Statics,
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
    output = statics.operation.output
    wanted = lossless.torques[output]
    passes = any(lossless.powers.values())
    if not passes or all(efficiency == 1 for efficiency in efficiencies.values()):
        return Directions(start, locking=False)
    agreeing: Drives | None = None
    drives: Drives = start
    seen = []
    for _ in range(MOST_FOLLOWED):
        found = statics.balance(drives, efficiencies)
        follow = drives_first(found.powers, drives)
        if follow == drives:
            if found.torques[output] * wanted >= 0:
                return Directions(drives, locking=False)
            agreeing = drives
        seen.append(drives)
        if follow in seen:
            break
        drives = follow
    for drives in islice(_turned(start, lossless, efficiencies), MOST_TRIED):
        found = statics.balance(drives, efficiencies)
        if drives_first(found.powers, drives) == drives:
            if found.torques[output] * wanted >= 0:
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
