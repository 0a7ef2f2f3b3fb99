"""Transient line contact with two moving rough surfaces.

Time steps of dX/u_r on an even grid, so that the entrained mass is carried by one node a step along
the characteristic, exactly. The pressure flow, the deflection and the load are implicit. Each step
is solved by Newton's method; its linear systems by GMRES with two levels: a banded matrix with the
near part of the deflection, and a dense matrix for sums of nodes.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels._jit import kernel
from epicyclic.kernels.ehl_fluid import (
    ScaledFluid,
    density_ratio,
    log_viscosity_ratio,
    mean_fluidity,
    mean_shear,
    thinning_factor,
)

__all__ = ["GROUP", "march", "masses"]

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

GROUP = 8
"""Nodes summed into one unknown of the coarse level."""
BAND = 6
"""Nodes to either side whose deflection the banded matrix holds."""
KRYLOV = 12
"""Largest number of GMRES steps of one linear solution."""
LINEAR_TOLERANCE = 0.05
"""Residual at which a linear solution stops, over that at its start. [1]"""
FREE_STEPS = 5
"""Newton steps before single nodes are held back."""
HOLD = 1.0
"""Compliance added to that of a node for its own pressure, over that. [1]"""
REFRESH = 4
"""GMRES steps beyond which the preconditioner is made anew in the next Newton step."""
LARGEST_STEP = 1.0
"""Largest change of a pressure in one Newton step, over p_h. [1]"""
FILM_FALL = 0.5
"""Share of the film upstream below which the second-order step would come near to none. [1]"""


@kernel
def deflect(kernel_row: FloatArray, pressure: FloatArray, out: FloatArray) -> None:
    """Deflection by the pressures of an even grid into `out`. Theory (H9).

    `kernel_row`, shape (2 n - 1,), holds the coefficients of the offsets 1 - n to n - 1. The
    pressures of the first and last node are fixed, and their deflection is part of the gap.
    """
    n = pressure.size
    out[:] = 0.0
    for j in range(1, n - 1):
        p = pressure[j]
        row = kernel_row[n - 1 - j : 2 * n - 1 - j]  # indices from 0 only: the loop vectorises
        for i in range(n):
            out[i] += row[i] * p


@kernel
def face_terms(
    pressure: FloatArray, film: FloatArray, fluid: ScaledFluid, dx: float, rho: FloatArray,
    d_rho: FloatArray, conductance: FloatArray, terms: FloatArray,
) -> None:  # fmt: skip
    """Conductance/dx of each face and the derivatives of its flow. Theory (H13), (H22).

    Columns of `terms`, shape (n - 1, 4): derivative of the flow to the left (positive upstream) in
    P_i, P_i+1, H_i, H_i+1.
    """
    n = pressure.size
    log_left, slope_left = log_viscosity_ratio(pressure[0], fluid)
    root_left = math.exp(-0.5 * log_left)
    rho[0], d_rho[0] = density_ratio(pressure[0], fluid)
    for i in range(n - 1):
        log_right, slope_right = log_viscosity_ratio(pressure[i + 1], fluid)
        root_right = math.exp(-0.5 * log_right)
        rho[i + 1], d_rho[i + 1] = density_ratio(pressure[i + 1], fluid)
        left, right = film[i], film[i + 1]
        conductance[i] = 0.0
        terms[i, :] = 0.0
        if left > 0.0 and right > 0.0:
            fluidity, by_left, by_right = mean_fluidity(log_left, log_right, root_left, root_right)
            sum_ = left + right
            cube = 2.0 * (left * right) ** 2 / sum_
            mean_film = 0.5 * sum_
            ease, exponent = thinning_factor(1.0 / (root_left * root_right), mean_film, fluid)
            density = 0.5 * (rho[i] + rho[i + 1])
            g = fluid.poiseuille * density * cube * fluidity * ease / dx
            conductance[i] = g
            flow = g * (pressure[i + 1] - pressure[i])
            terms[i, 0] = -g + flow * (
                0.5 * d_rho[i] / density + (by_left / fluidity + 0.5 * exponent) * slope_left
            )
            terms[i, 1] = g + flow * (
                0.5 * d_rho[i + 1] / density + (by_right / fluidity + 0.5 * exponent) * slope_right
            )
            terms[i, 2] = flow * (2.0 / left - (1.0 + exponent) / sum_)
            terms[i, 3] = flow * (2.0 / right - (1.0 + exponent) / sum_)
        log_left, slope_left, root_left = log_right, slope_right, root_right


@kernel
def residual(
    pressure: FloatArray, film: FloatArray, rho: FloatArray, conductance: FloatArray,
    order: FloatArray, history: FloatArray, active: BoolArray, out: FloatArray,
) -> None:  # fmt: skip
    """Lack of mass of every node into `out`; wakes ruptured nodes that fill. Theory (H21)."""
    n = pressure.size
    out[:] = 0.0
    for i in range(1, n - 1):
        inflow = conductance[i] * (pressure[i + 1] - pressure[i]) - conductance[i - 1] * (
            pressure[i] - pressure[i - 1]
        )
        lack = history[i] + inflow - order[i] * rho[i] * film[i]
        if not active[i] and lack > 0.0:
            active[i] = True
        if active[i]:
            out[i] = lack


@kernel
def tridiagonals(
    film: FloatArray, rho: FloatArray, d_rho: FloatArray, terms: FloatArray, order: FloatArray,
    active: BoolArray, local: FloatArray, by_film: FloatArray,
) -> None:  # fmt: skip
    """Derivatives of the excess of mass in P and in H of nodes i - 1, i, i + 1."""
    n = film.size
    local[:] = 0.0
    by_film[:] = 0.0
    for i in range(1, n - 1):
        if active[i]:
            local[i, 0] = terms[i - 1, 0]
            local[i, 1] = order[i] * d_rho[i] * film[i] + terms[i - 1, 1] - terms[i, 0]
            local[i, 2] = -terms[i, 1]
            by_film[i, 0] = terms[i - 1, 2]
            by_film[i, 1] = order[i] * rho[i] + terms[i - 1, 3] - terms[i, 2]
            by_film[i, 2] = -terms[i, 3]


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
    local: FloatArray, by_film: FloatArray, near: FloatArray, active: BoolArray, band: FloatArray
) -> None:
    """LU of the banded matrix, in place in `band`, shape (n, 2 width + 1)."""
    n, width = band.shape[0], band.shape[1] // 2
    reach = near.size - 1
    band[:] = 0.0
    for i in range(n):
        if not active[i]:
            band[i, width] = 1.0
            continue
        for k in range(-width, width + 1):
            j = i + k
            if 0 <= j < n and active[j]:
                value = 0.0
                for side in range(3):
                    distance = abs(k + 1 - side)
                    if distance <= reach:
                        value += by_film[i, side] * near[distance]
                if -1 <= k <= 1:
                    value += local[i, k + 1]
                band[i, width + k] = value
    for i in range(n):
        pivot = 1.0 / band[i, width]
        for k in range(1, min(width, n - 1 - i) + 1):
            factor = band[i + k, width - k] * pivot
            if factor != 0.0:
                band[i + k, width - k] = factor
                for m in range(1, width + 1):
                    band[i + k, width - k + m] -= factor * band[i, width + m]


@kernel
def solve_band(band: FloatArray, x: FloatArray) -> None:
    """Solve with the factors of `factor_band`; `x` holds the right side and then the solution."""
    n, width = band.shape[0], band.shape[1] // 2
    for i in range(n):
        value = x[i]
        for k in range(1, min(width, i) + 1):
            value -= band[i, width - k] * x[i - k]
        x[i] = value
    for i in range(n - 1, -1, -1):
        value = x[i]
        for k in range(1, min(width, n - 1 - i) + 1):
            value -= band[i, width + k] * x[i + k]
        x[i] = value / band[i, width]


@kernel
def update_groups(
    kernel_row: FloatArray, active: BoolArray, grouped: FloatArray, included: BoolArray
) -> None:
    """Bring `grouped`, shape (groups, n), up to date with the active nodes.

    It holds the deflection of every node by unit pressure on the `included` nodes of each group.
    """
    n = active.size
    for j in range(n):
        if active[j] != included[j]:
            included[j] = active[j]
            sign = 1.0 if active[j] else -1.0
            group = grouped[j // GROUP]
            row = kernel_row[n - 1 - j : 2 * n - 1 - j]
            for i in range(n):
                group[i] += sign * row[i]


@kernel
def coarse_matrix(
    local: FloatArray, by_film: FloatArray, grouped: FloatArray, active: BoolArray, weight: float
) -> FloatArray:
    """Matrix of the coarse level: groups, then the approach and the load."""
    n, groups = active.size, grouped.shape[0]
    matrix = np.zeros((groups + 1, groups + 1))
    for g in range(groups):
        film = grouped[g]
        for i in range(1, n - 1):
            if active[i]:
                matrix[i // GROUP, g] += (
                    by_film[i, 0] * film[i - 1] + by_film[i, 1] * film[i]
                    + by_film[i, 2] * film[i + 1]
                )  # fmt: skip
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
def factor_dense(matrix: FloatArray, order: NDArray[np.int64]) -> None:
    """LU with row exchanges, in place; `order` becomes the order of the rows."""
    n = matrix.shape[0]
    for i in range(n):
        order[i] = i
    for k in range(n - 1):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if best != k:
            order[k], order[best] = order[best], order[k]
            for j in range(n):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
        upper = matrix[k]
        for i in range(k + 1, n):
            row = matrix[i]
            factor = row[k] / upper[k]
            row[k] = factor
            if factor != 0.0:
                for j in range(k + 1, n):
                    row[j] -= factor * upper[j]


@kernel
def solve_dense(matrix: FloatArray, order: NDArray[np.int64], right: FloatArray) -> FloatArray:
    """Solve with the factors of `factor_dense`."""
    n = matrix.shape[0]
    x = np.empty(n)
    for i in range(n):
        value = right[order[i]]
        for j in range(i):
            value -= matrix[i, j] * x[j]
        x[i] = value
    for i in range(n - 1, -1, -1):
        value = x[i]
        for j in range(i + 1, n):
            value -= matrix[i, j] * x[j]
        x[i] = value / matrix[i, i]
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
    for g in range(groups):
        row = grouped[g]
        value = sums[g]
        for i in range(n):
            film[i] += value * row[i]
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
    active: BoolArray, weight: float, solution: FloatArray,
) -> int:  # fmt: skip
    """GMRES with `precondition` on the right; returns its steps."""
    n = active.size
    basis = np.empty((KRYLOV + 1, n + 1))
    ahead = np.empty((KRYLOV, n + 1))
    hessenberg = np.zeros((KRYLOV + 1, KRYLOV))
    cosine, sine = np.zeros(KRYLOV), np.zeros(KRYLOV)
    rest = np.zeros(KRYLOV + 1)
    film, work = np.zeros(n), np.zeros(n)
    solution[:] = 0.0
    norm = math.sqrt((right * right).sum())
    if norm == 0.0:
        return 0
    basis[0] = right / norm
    rest[0] = norm
    steps = 0
    for k in range(KRYLOV):
        precondition(
            basis[k], coarse, rows, grouped, local, by_film, band, active, film, work, ahead[k]
        )
        deflect(kernel_row, ahead[k, :n], film)
        film += ahead[k, n]
        new = basis[k + 1]
        apply_rows(local, by_film, ahead[k, :n], film, work)
        total = 0.0
        for i in range(n):
            new[i] = work[i] if active[i] else 0.0
            total += ahead[k, i]
        new[n] = weight * total
        for m in range(k + 1):
            product = 0.0
            old = basis[m]
            for i in range(n + 1):
                product += new[i] * old[i]
            hessenberg[m, k] = product
            for i in range(n + 1):
                new[i] -= product * old[i]
        size = math.sqrt((new * new).sum())
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
        if abs(rest[k + 1]) <= LINEAR_TOLERANCE * norm:
            break
    for k in range(steps - 1, -1, -1):
        for m in range(k + 1, steps):
            rest[k] -= hessenberg[k, m] * rest[m]
        rest[k] /= hessenberg[k, k]
    for k in range(steps):
        solution += rest[k] * ahead[k]
    return steps


@kernel
def near_coefficients(kernel_row: FloatArray) -> FloatArray:
    """Coefficients of the offsets 0 to `BAND` less that of the next."""
    middle = kernel_row.size // 2
    near: FloatArray = kernel_row[middle : middle + BAND + 1] - kernel_row[middle + BAND + 1]
    return near


@kernel
def solve_step(
    pressure: FloatArray, film: FloatArray, approach: float, gap: FloatArray,
    kernel_row: FloatArray, order: FloatArray, history: FloatArray, fluid: ScaledFluid, dx: float,
    load: float, active: BoolArray, grouped: FloatArray, included: BoolArray, held: bool,
    tolerance: float, max_iterations: int,
) -> tuple[float, int, float, float]:  # fmt: skip
    """Pressure and film after one time step, in place.

    Theory (H21), (H22).

    Parameters
    ----------
    pressure, film : ndarray, shape (n,)
        Started from, and changed to the solution; the first and last pressure stay.
    approach : float
        H_0 to start from.
    gap : ndarray, shape (n,)
        Undeformed gap with the roughness, and the deflection by the pressure outside.
    kernel_row : ndarray, shape (2 n - 1,)
        Of `deflect`.
    order, history : ndarray, shape (n,)
        Factor of the mass now, and what earlier masses contribute.
    active : ndarray of bool, shape (n,)
        Nodes with a full film, changed to the solution.
    grouped, included : ndarray
        Of `update_groups`.
    held : bool
        Hold single nodes back from the first step on.
    tolerance : float
        Largest change of a pressure in the last step, and largest relative lack of load.
    max_iterations : int

    Returns
    -------
    approach : float
    iterations : int
    error : float
        What `tolerance` bounds; not a number if the iteration broke down.
    dissipation : float
        Power of the pressure flow at the start of the last Newton step.
    """
    n = pressure.size
    rho, d_rho = np.empty(n), np.empty(n)
    conductance, terms = np.empty(n - 1), np.empty((n - 1, 4))
    local, by_film = np.empty((n, 3)), np.empty((n, 3))
    lack, change, bent = np.zeros(n + 1), np.zeros(n + 1), np.zeros(n)
    band = np.empty((n, 2 * BAND + 1))
    groups = grouped.shape[0]
    coarse, rows = np.empty((groups + 1, groups + 1)), np.empty(groups + 1, dtype=np.int64)
    near = near_coefficients(kernel_row)
    error, dissipation = np.inf, 0.0
    hold = HOLD * kernel_row[n - 1]
    iteration = linear = 0
    while iteration < max_iterations and not error < tolerance:
        iteration += 1
        face_terms(pressure, film, fluid, dx, rho, d_rho, conductance, terms)
        residual(pressure, film, rho, conductance, order, history, active, lack[:n])
        lack[n] = load - dx * (pressure.sum() - 0.5 * pressure[0])
        tridiagonals(film, rho, d_rho, terms, order, active, local, by_film)
        if iteration > FREE_STEPS or held:  # a film may else close and open in turns
            for i in range(n):
                local[i, 1] += hold * rho[i] * order[i]
        if iteration == 1 or linear > REFRESH:
            update_groups(kernel_row, active, grouped, included)
            factor_band(local, by_film, near, active, band)
            coarse = coarse_matrix(local, by_film, grouped, active, dx)
            factor_dense(coarse, rows)
        linear = solve_linear(
            lack, kernel_row, coarse, rows, grouped, local, by_film, band, active, dx, change
        )
        dissipation = 0.0
        for i in range(n - 1):
            difference = pressure[i + 1] - pressure[i]
            dissipation += conductance[i] * difference**2 / (0.5 * (rho[i] + rho[i + 1]))
        if not np.isfinite(change).all():
            return approach, iteration, np.nan, dissipation
        error = 0.0
        for i in range(1, n - 1):
            new = pressure[i] + min(max(change[i], -LARGEST_STEP), LARGEST_STEP)
            if new < 0.0:
                new = 0.0
                active[i] = False
            error = max(error, abs(new - pressure[i]))
            pressure[i] = new
        error = max(error, abs(load - dx * (pressure.sum() - 0.5 * pressure[0])) / load)
        approach += change[n]
        deflect(kernel_row, pressure, bent)
        for i in range(n):
            film[i] = gap[i] + approach + bent[i]
    return approach, iteration, error, dissipation


@kernel
def height_at(heights: FloatArray, position: float) -> float:
    """Height of a periodic profile between its points, by the cubic through four of them."""
    n = heights.size
    whole = math.floor(position)
    f = position - whole
    i = int(whole) % n
    height: float = (
        -f * (1.0 - f) * (2.0 - f) / 6.0 * heights[i - 1]
        + (1.0 + f) * (1.0 - f) * (2.0 - f) / 2.0 * heights[i]
        + (1.0 + f) * f * (2.0 - f) / 2.0 * heights[(i + 1) % n]
        - (1.0 + f) * f * (1.0 - f) / 6.0 * heights[(i + 2) % n]
    )
    return height


@kernel
def carry(
    now: FloatArray, before: FloatArray, order: FloatArray, history: FloatArray, second: bool
) -> None:
    """Orders and histories of a step from the masses one and two steps ago. Theory (H21)."""
    n = now.size
    order[:] = 1.0
    history[0] = 0.0
    for i in range(1, n):
        history[i] = max(now[i - 1], 0.0)
        if second and i > 1:
            ahead = 2.0 * now[i - 1] - 0.5 * before[i - 2]
            if ahead > 1.5 * FILM_FALL * history[i]:
                order[i] = 1.5
                history[i] = ahead


@kernel
def masses(pressure: FloatArray, film: FloatArray, fluid: ScaledFluid, out: FloatArray) -> None:
    """Density ratio times film of every node into `out`."""
    for i in range(pressure.size):
        out[i] = density_ratio(pressure[i], fluid)[0] * film[i]


@kernel
def measure(
    pressure: FloatArray, film: FloatArray, fluid: ScaledFluid, dx: float, contact_film: float,
    boundary_friction: float, record: FloatArray,
) -> None:  # fmt: skip
    """Friction and contact of one moment into `record`. Theory (H23), (H24)."""
    record[:5] = 0.0
    record[4] = np.inf
    for i in range(pressure.size):
        p = pressure[i]
        if p > 0.0:
            record[4] = min(record[4], film[i])
            if film[i] < contact_film:
                record[1] += boundary_friction * p * dx
                record[2] += 0.5 * dx
                record[3] += p * dx
            else:
                record[0] += mean_shear(p, film[i], fluid) * dx


@kernel
def march(
    pressure: FloatArray, film: FloatArray, now: FloatArray, before: FloatArray,
    active: BoolArray, approach: float, smooth: FloatArray, base: FloatArray,
    kernel_row: FloatArray, grouped: FloatArray, included: BoolArray, heights1: FloatArray,
    heights2: FloatArray, shift1: float, shift2: float, first: int, growth: int,
    fluid: ScaledFluid, dx: float, load: float, contact_film: float, boundary_friction: float,
    tolerance: float, max_iterations: int, records: FloatArray,
) -> float:  # fmt: skip
    """Time steps of dX/u_r, as many as `records` has rows; state arrays change in place.

    Theory (H21), (H25).

    Parameters
    ----------
    pressure, film : ndarray, shape (n,)
    now, before : ndarray, shape (n,)
        Mass at each node one and two steps ago.
    active : ndarray of bool, shape (n,)
        Nodes with a full film.
    approach : float
        H_0.
    smooth : ndarray, shape (n,)
        Pressure of the smooth contact; what exceeds it is expected to move with the oil.
    base : ndarray, shape (n,)
        Smooth gap, with the deflection by the pressure outside the grid.
    kernel_row, grouped, included : ndarray
        Of `deflect` and `update_groups`.
    heights1, heights2 : ndarray, shape (m1,), (m2,)
        Periodic profiles with the spacing of the nodes.
    shift1, shift2 : float
        Nodes by which each surface moves in a step, u_k/u_r.
    first, growth : int
        Steps done before; steps in which the roughness grows from zero.
    fluid, dx, load
        Oil, spacing, load on the grid.
    contact_film, boundary_friction : float
        Film below which surfaces touch; friction there over the pressure.
    tolerance, max_iterations
        Of `solve_step`.
    records : ndarray, shape (steps, 8)
        Integrals over X of fluid and of asperity shear, contact length over 2 b, integral of the
        pressure in contact, least film, dissipation, Newton steps, error; not numbers from the
        step on that broke down.

    Returns
    -------
    float
        H_0.
    """
    n = pressure.size
    gap, bent = np.empty(n), np.empty(n)
    order, history = np.empty(n), np.empty(n)
    tried = np.empty(n)
    for t in range(records.shape[0]):
        step = first + t + 1
        amplitude = min(1.0, step / growth)
        for i in range(n):
            gap[i] = base[i] - amplitude * (
                height_at(heights1, i - step * shift1) + height_at(heights2, i - step * shift2)
            )
        for i in range(n - 2, 1, -1):  # what the roughness adds moves with the oil
            pressure[i] = max(0.0, smooth[i] + pressure[i - 1] - smooth[i - 1])
            active[i] = active[i - 1]
            if not active[i]:
                pressure[i] = 0.0
        active[1] = True
        tried[:] = pressure
        iterations = 0
        for attempt in range(2):
            carry(now, before, order, history, attempt == 0)
            deflect(kernel_row, pressure, bent)
            for i in range(n):
                film[i] = gap[i] + approach + bent[i]
            tries = max_iterations * (1 + attempt)
            result = solve_step(
                pressure, film, approach, gap, kernel_row, order, history, fluid, dx, load,
                active, grouped, included, attempt == 1, tolerance, tries,
            )  # fmt: skip
            iterations += result[1]
            if result[2] < tolerance or attempt == 1:
                break
            pressure[:] = tried  # again with short steps and first order
            for i in range(1, n - 1):
                active[i] = pressure[i] > 0.0
        if not np.isfinite(result[2]):
            records[t:] = np.nan
            return approach
        approach = result[0]
        before[:] = now
        masses(pressure, film, fluid, now)
        measure(pressure, film, fluid, dx, contact_film, boundary_friction, records[t])
        records[t, 5] = result[3]
        records[t, 6] = iterations
        records[t, 7] = result[2]
    return approach
