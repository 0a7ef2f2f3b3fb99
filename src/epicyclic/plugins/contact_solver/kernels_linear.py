"""Linear systems of the transient line contact: flow, deflection by all pressures, load.

Solved by GMRES with two levels: a banded matrix with the near part of the deflection, and a dense
matrix for sums of nodes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.kernels.compiling import kernel

GROUP = 12  # Nodes summed into one unknown of the coarse level.
BAND = 4  # Nodes to either side whose deflection the banded matrix holds.
KRYLOV = 12  # Largest number of GMRES steps of one linear solution.
LEAST_DIAGONAL = 0.1
"""Least diagonal by which a residual is divided, over the compliance of a node. [1]"""


class Space(NamedTuple):
    """Arrays that `solve_linear` overwrites, made once for many systems by `space_for`."""

    bends: FloatArray
    work: FloatArray
    scale: FloatArray
    unscaled: FloatArray
    basis: FloatArray
    ahead: FloatArray
    hessenberg: FloatArray


class Groups(NamedTuple):
    """Deflection by unit pressure on the `included` nodes of each group; see `update_groups`."""

    bends: FloatArray
    across: FloatArray  # The same by nodes, to be read in rows too.
    included: BoolArray


@kernel
def groups_for(n: int) -> Groups:
    """No node is included yet."""
    groups = (n + GROUP - 1) // GROUP
    return Groups(np.zeros((groups, n)), np.zeros((n, groups)), np.zeros(n, dtype=np.bool_))


@kernel
def space_for(n: int) -> Space:
    """Arrays for systems of n nodes."""
    return Space(
        np.empty((KRYLOV, n)), np.empty(n), np.ones(n + 1), np.empty(n + 1),
        np.empty((KRYLOV + 1, n + 1)), np.empty((KRYLOV, n + 1)), np.zeros((KRYLOV + 1, KRYLOV)),
    )  # fmt: skip


@kernel
def add_one(a: float, row: FloatArray, out: FloatArray) -> None:
    """Add a row times a number. Indices from 0 only, so that the loop is vectorised."""
    for i in range(out.size):
        out[i] += a * row[i]


@kernel
def add_rows(factors: FloatArray, rows: FloatArray, out: FloatArray) -> None:
    """Add rows times numbers, four at once, which saves three of four passes over `out`."""
    count = factors.size
    whole = count // 4 * 4
    for k in range(0, whole, 4):
        a, b, c, d = factors[k], factors[k + 1], factors[k + 2], factors[k + 3]
        row_a, row_b, row_c, row_d = rows[k], rows[k + 1], rows[k + 2], rows[k + 3]
        for i in range(out.size):
            out[i] += a * row_a[i] + b * row_b[i] + c * row_c[i] + d * row_d[i]
    for k in range(whole, count):
        add_one(factors[k], rows[k], out)


@kernel
def deflect(kernel_row: FloatArray, pressure: FloatArray, out: FloatArray) -> None:
    """Deflection by the pressures of an even grid into `out`. Theory (H9).

    `kernel_row`, shape (2 n - 1,), holds the coefficients of the offsets 1 - n to n - 1. The
    pressures of the first and last node are fixed, and their deflection is part of the gap.
    """
    n = pressure.size
    out[:] = 0.0
    last = n - 1
    whole = 1 + (last - 1) // 8 * 8
    for j in range(1, whole, 8):
        # eight columns at once save seven of eight passes over `out`; indices from 0 only, so that
        # the loop is vectorised
        a, b, c, d = pressure[j], pressure[j + 1], pressure[j + 2], pressure[j + 3]
        e, f, g, h = pressure[j + 4], pressure[j + 5], pressure[j + 6], pressure[j + 7]
        if max(a, b, c, d, e, f, g, h) > 0.0 or min(a, b, c, d, e, f, g, h) < 0.0:
            row = kernel_row[last - j - 7 : last - j + n]
            for i in range(n):
                out[i] += (
                    (row[i + 7] * a + row[i + 6] * b) + (row[i + 5] * c + row[i + 4] * d)
                ) + ((row[i + 3] * e + row[i + 2] * f) + (row[i + 1] * g + row[i] * h))
    for j in range(whole, last):
        add_one(pressure[j], kernel_row[last - j : last - j + n], out)


@kernel
def apply_rows(
    local: FloatArray, by_film: FloatArray, pressure: FloatArray, film: FloatArray,
    out: FloatArray,
) -> None:  # fmt: skip
    """Change of the excess of mass by changes of pressure and film, into `out`."""
    n = pressure.size
    out[0] = out[n - 1] = 0.0
    for i in range(1, n - 1):
        out[i] = (
            local[i, 0] * pressure[i - 1] + local[i, 1] * pressure[i]
            + local[i, 2] * pressure[i + 1]
            + by_film[i, 0] * film[i - 1] + by_film[i, 1] * film[i] + by_film[i, 2] * film[i + 1]
        )  # fmt: skip


@kernel
def factor_band(
    local: FloatArray, by_film: FloatArray, kernel_row: FloatArray, active: BoolArray,
    band: FloatArray,
) -> None:  # fmt: skip
    """LU of the banded matrix, pivots inverted, in `band`, shape (n + BAND, 2 BAND + 1).

    With rows of ones below, all loops have their full length.
    """
    fill_band(local, by_film, kernel_row, active, band)
    for i in range(active.size):
        row = band[i]
        pivot = row[BAND] = 1.0 / row[BAND]
        for k in range(1, BAND + 1):
            below = band[i + k]
            factor = below[BAND - k] * pivot
            below[BAND - k] = factor
            for m in range(1, BAND + 1):
                below[BAND - k + m] -= factor * row[BAND + m]


@kernel
def fill_band(
    local: FloatArray, by_film: FloatArray, kernel_row: FloatArray, active: BoolArray,
    band: FloatArray,
) -> None:  # fmt: skip
    """The banded matrix of active nodes, with ones on the diagonal for all other rows."""
    n = active.size
    near = kernel_row[n - 1 : n + BAND] - kernel_row[n + BAND]  # less that of the next offset
    bends = np.zeros((3, 2 * BAND + 1))  # of the nodes i - 1, i, i + 1 by the pressures of the band
    for side in range(3):
        for k in range(2 * BAND + 1):
            distance = abs(k - BAND + 1 - side)
            if distance <= BAND:
                bends[side, k] = near[distance]
    left, here, right = bends
    counts = np.zeros(n + 2 * BAND)
    counts[BAND : n + BAND] = active
    for i in range(n):
        row = band[i]
        if active[i]:
            a, b, c = by_film[i, 0], by_film[i, 1], by_film[i, 2]
            for k in range(2 * BAND + 1):
                row[k] = a * left[k] + b * here[k] + c * right[k]
            for side in range(3):
                row[BAND - 1 + side] += local[i, side]
            for k in range(2 * BAND + 1):
                row[k] *= counts[i + k]
        else:
            row[:] = 0.0
            row[BAND] = 1.0
    band[n:] = 0.0
    band[n:, BAND] = 1.0


@kernel
def solve_band(band: FloatArray, x: FloatArray) -> None:
    """Solve with the factors of `factor_band`; `x` holds the right side and then the solution."""
    n = x.size
    for i in range(BAND):
        for k in range(1, i + 1):
            x[i] -= band[i, BAND - k] * x[i - k]
    for i in range(BAND, n):  # written out, the node known last at the end
        x[i] = (
            x[i] - band[i, 0] * x[i - 4] - band[i, 1] * x[i - 3] - band[i, 2] * x[i - 2]
            - band[i, 3] * x[i - 1]
        )  # fmt: skip
    for i in range(n - 1, n - 1 - BAND, -1):
        for k in range(1, n - i):
            x[i] -= band[i, BAND + k] * x[i + k]
        x[i] *= band[i, BAND]
    for i in range(n - 1 - BAND, -1, -1):
        x[i] = (
            x[i] - band[i, 8] * x[i + 4] - band[i, 7] * x[i + 3] - band[i, 6] * x[i + 2]
            - band[i, 5] * x[i + 1]
        ) * band[i, 4]  # fmt: skip


@kernel
def update_groups(kernel_row: FloatArray, active: BoolArray, groups: Groups) -> None:
    """Bring `groups` up to date with the active nodes."""
    n = active.size
    for j in range(n):
        if active[j] != groups.included[j]:
            groups.included[j] = active[j]
            sign = 1.0 if active[j] else -1.0
            group = j // GROUP
            bends = groups.bends[group]
            add_one(sign, kernel_row[n - 1 - j : 2 * n - 1 - j], bends)
            groups.across[:, group] = bends


@kernel
def coarse_matrix(
    local: FloatArray, by_film: FloatArray, across: FloatArray, active: BoolArray, weight: float
) -> FloatArray:
    """Matrix of the coarse level: groups, then the approach and the load."""
    n, groups = across.shape
    matrix = np.zeros((groups + 1, groups + 1))
    weights = np.zeros(groups * GROUP + 2)  # of the films of a group, and of its neighbours
    for g in range(groups):
        first, last = max(1, g * GROUP), min(n - 1, (g + 1) * GROUP)
        weights[first - 1 : last + 1] = 0.0
        for i in range(first, last):
            for side in range(3):
                weights[i - 1 + side] += by_film[i, side]
        add_rows(weights[first - 1 : last + 1], across[first - 1 : last + 1], matrix[g, :groups])
    for i in range(1, n - 1):
        row = i // GROUP
        if active[i]:
            matrix[groups, row] += weight
            matrix[row, groups] += by_film[i, 0] + by_film[i, 1] + by_film[i, 2]
            for side in range(3):
                j = i - 1 + side
                if active[j]:
                    matrix[row, j // GROUP] += local[i, side]
    for g in range(groups):
        if matrix[groups, g] == 0.0:  # a group of ruptured nodes
            matrix[g, g] = 1.0
    return matrix


@kernel
def factor_dense(matrix: FloatArray, order: NDArray[np.int64]) -> FloatArray:
    """LU with row exchanges, transposed; `order` becomes the order of the rows.

    Overwrites `matrix`. Four columns at a time, so that the rest is passed over once for them.
    """
    n = matrix.shape[0]
    for i in range(n):
        order[i] = i
    for first in range(0, n, 4):
        last = min(first + 4, n)
        for k in range(first, last):
            factor_column(matrix, order, k, last)
            for m in range(first, k):
                add_one(-matrix[k, m], matrix[m, last:], matrix[k, last:])
        if last < n:  # `add_rows` written out: for each row a call would take as long again
            row_a, row_b = matrix[first, last:], matrix[first + 1, last:]
            row_c, row_d = matrix[first + 2, last:], matrix[first + 3, last:]
            for i in range(last, n):
                row = matrix[i, last:]
                a, b = matrix[i, first], matrix[i, first + 1]
                c, d = matrix[i, first + 2], matrix[i, first + 3]
                for j in range(row.size):
                    row[j] -= a * row_a[j] + b * row_b[j] + c * row_c[j] + d * row_d[j]
    return matrix.T.copy()


@kernel
def factor_column(matrix: FloatArray, order: NDArray[np.int64], k: int, last: int) -> None:
    """Eliminate column k, in those before `last` only."""
    n = matrix.shape[0]
    best = k
    for i in range(k + 1, n):
        if abs(matrix[i, k]) > abs(matrix[best, k]):
            best = i
    if best != k:
        order[k], order[best] = order[best], order[k]
        for j in range(n):
            matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
    turned = 1.0 / matrix[k, k]
    for i in range(k + 1, n):
        matrix[i, k] *= turned
        for j in range(k + 1, last):
            matrix[i, j] -= matrix[i, k] * matrix[k, j]


@kernel
def solve_dense(factors: FloatArray, order: NDArray[np.int64], right: FloatArray) -> FloatArray:
    """Solve with the factors of `factor_dense`, by columns: sums along rows are not vectorised."""
    n = factors.shape[0]
    x = right[order]
    for j in range(n - 1):
        add_one(-x[j], factors[j, j + 1 :], x[j + 1 :])
    for j in range(n - 1, -1, -1):
        x[j] /= factors[j, j]
        add_one(-x[j], factors[j, :j], x[:j])
    return x


@kernel
def precondition(
    right: FloatArray, coarse: FloatArray, rows: NDArray[np.int64], grouped: FloatArray,
    local: FloatArray, by_film: FloatArray, band: FloatArray, active: BoolArray,
    film: FloatArray, work: FloatArray, out: FloatArray,
) -> None:  # fmt: skip
    """Approximate solution for the right side (nodes, then load): coarse level, then band."""
    n, groups = active.size, grouped.shape[0]
    sums = np.zeros(groups + 1)
    for i in range(n):
        if active[i]:
            sums[i // GROUP] += right[i]
    sums[groups] = right[n]
    sums = solve_dense(coarse, rows, sums)
    out[n] = sums[groups]
    film[:] = sums[groups]
    add_rows(sums[:groups], grouped, film)
    for i in range(n):
        out[i] = sums[i // GROUP] if active[i] else 0.0
    apply_rows(local, by_film, out[:n], film, work)
    for i in range(n):
        work[i] = right[i] - work[i] if active[i] else 0.0
    solve_band(band, work)
    for i in range(n):
        if active[i]:
            out[i] += work[i]


@kernel
def solve_linear(
    right: FloatArray, kernel_row: FloatArray, coarse: FloatArray, rows: NDArray[np.int64],
    grouped: FloatArray, local: FloatArray, by_film: FloatArray, band: FloatArray,
    active: BoolArray, weight: float, tolerance: float, space: Space, solution: FloatArray,
    bend: FloatArray,
) -> int:  # fmt: skip
    """GMRES with `precondition` on the right; returns its steps.

    The change of the film that goes with `solution` is put into `bend`.

    Residuals are measured over the diagonal, as pressures, lest a few stiff nodes hide the others.
    It stops where that is `tolerance` times the one at the start.
    """
    n = active.size
    bends, work, scale, unscaled, basis, ahead, hessenberg = space
    scale[:] = 1.0
    here, beside = kernel_row[n - 1], kernel_row[n]
    for i in range(1, n - 1):
        if active[i]:
            diagonal = local[i, 1] + by_film[i, 1] * here + (by_film[i, 0] + by_film[i, 2]) * beside
            scale[i] = 1.0 / max(abs(diagonal), LEAST_DIAGONAL * here)
    cosine, sine = np.zeros(KRYLOV), np.zeros(KRYLOV)
    rest = np.zeros(KRYLOV + 1)
    solution[:] = bend[:] = 0.0
    basis[0] = right * scale
    norm = math.sqrt(np.dot(basis[0], basis[0]))
    if norm == 0.0:
        return 0
    basis[0] /= norm
    rest[0] = norm
    steps = 0
    for k in range(KRYLOV):
        unscaled[:] = basis[k] / scale
        film = bends[k]
        precondition(
            unscaled, coarse, rows, grouped, local, by_film, band, active, film, work, ahead[k]
        )
        deflect(kernel_row, ahead[k, :n], film)
        film += ahead[k, n]
        new = basis[k + 1]
        apply_rows(local, by_film, ahead[k, :n], film, work)
        total = 0.0
        for i in range(n):
            new[i] = work[i] * scale[i] if active[i] else 0.0
            total += ahead[k, i]
        new[n] = weight * total
        for m in range(k + 1):
            hessenberg[m, k] = np.dot(new, basis[m])
            add_one(-hessenberg[m, k], basis[m], new)
        size = math.sqrt(np.dot(new, new))
        hessenberg[k + 1, k] = size
        if size > 0.0:
            new /= size
        for m in range(k):
            upper = cosine[m] * hessenberg[m, k] + sine[m] * hessenberg[m + 1, k]
            hessenberg[m + 1, k] = -sine[m] * hessenberg[m, k] + cosine[m] * hessenberg[m + 1, k]
            hessenberg[m, k] = upper
        radius = math.hypot(hessenberg[k, k], hessenberg[k + 1, k])
        cosine[k], sine[k] = hessenberg[k, k] / radius, hessenberg[k + 1, k] / radius
        hessenberg[k, k] = radius
        rest[k + 1] = -sine[k] * rest[k]
        rest[k] *= cosine[k]
        steps = k + 1
        if abs(rest[k + 1]) <= tolerance * norm:
            break
    for k in range(steps - 1, -1, -1):
        for m in range(k + 1, steps):
            rest[k] -= hessenberg[k, m] * rest[m]
        rest[k] /= hessenberg[k, k]
    for k in range(steps):
        solution += rest[k] * ahead[k]
        bend += rest[k] * bends[k]
    return steps
