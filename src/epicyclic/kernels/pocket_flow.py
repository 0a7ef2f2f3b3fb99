"""Flow of a compressible mixture through the pockets of a mesh, periodic in time.

Cells (i, j): pocket i along the mesh, slice j across the face. Axial face j of pocket i lies before
cell (i, j), gap i of slice j before cell (i, j) as well. Pressures are kept as q = p/p_a - 1, which
stays exact at low speed. Symbols follow the theory manual, page on pocketing.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels._jit import kernel

__all__ = ["choking_table", "enthalpy", "periodic_flow"]

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Indices = NDArray[np.int64]

GAMMA = 1.4
"""Ratio of the specific heats of air. [1]"""
SDIRK = 1 - math.sqrt(0.5)
"""Coefficient of the two-stage, second-order, L-stable Runge-Kutta method. Alexander (1977). [1]"""
EASE = 0.125
"""How long an opening beside a new pocket has next to no inertia. [periods]"""
NEW_INERTIA = 0.1
"""Inertia in that time, as that of a step of ten periods over that of a step."""
NEWTON_MOST = 40
"""Newton iterations of one stage before it is given up."""
NEWTON_TOLERANCE = 1e-9
"""Last Newton step over the largest value in the field. [1]"""
CHOKE_STEP = 0.05
CHOKE_END = 16.0
"""Step and end of the table of throat pressures, in the logarithm of the pressure."""


@kernel
def _swelling(q: float, xi: float) -> float:
    """rho_m/rho - 1. Theory (Q8)."""
    return (1 - xi) * math.expm1(-math.log1p(q) / GAMMA)


@kernel
def enthalpy(q: float, xi: float) -> float:
    """Integral of dp/rho from ambient pressure, over p_a/rho_m. Theory (Q9). [1]"""
    air = 0.0
    if xi < 1.0:
        power = (GAMMA - 1) / GAMMA
        air = (1 - xi) / power * math.expm1(power * math.log1p(q))
    return xi * q + air


@kernel
def _density(q: float, xi: float) -> tuple[float, float]:
    """rho/rho_m and its derivative by q. Theory (Q8)."""
    if xi >= 1.0:
        return 1.0, 0.0
    log_p = math.log1p(q)
    swelling = 1 + (1 - xi) * math.expm1(-log_p / GAMMA)
    slope = (1 - xi) / GAMMA * math.exp(-log_p * (1 / GAMMA + 1))
    return 1 / swelling, slope / swelling**2


@kernel
def choking_table(xi: float) -> Floats:
    """Throat pressure over stagnation pressure where the throat runs at the speed of sound.

    Theory (Q13).

    On a grid of the logarithm of the stagnation pressure, ``CHOKE_STEP`` apart from ``-CHOKE_END``
    to ``CHOKE_END``; all zero for pure oil, which does not choke.
    """
    count = round(2 * CHOKE_END / CHOKE_STEP) + 1
    ratio = np.zeros(count)
    if xi >= 1.0:
        return ratio
    guess = 0.53
    for n in range(count):
        p = math.exp(-CHOKE_END + n * CHOKE_STEP)
        total = enthalpy(p - 1, xi)
        low, high = 0.0, 1.0
        for _ in range(60):
            guess = (low + high) / 2
            throat = guess * p
            _, slope = _density(throat - 1, xi)
            if enthalpy(throat - 1, xi) + 0.5 / slope > total:
                high = guess
            else:
                low = guess
        ratio[n] = guess
    return ratio


@kernel
def _throat(q: float, choke: Floats) -> tuple[float, float]:
    """Throat pressure of a choked nozzle less ambient, and its derivative by q. Theory (Q13)."""
    place = (math.log1p(q) + CHOKE_END) / CHOKE_STEP
    if place <= 0.0:
        return choke[0] * (1 + q) - 1, choke[0]
    if place >= choke.size - 1:
        return choke[-1] * (1 + q) - 1, choke[-1]
    n = int(place)
    slope = choke[n + 1] - choke[n]
    ratio = choke[n] + (place - n) * slope
    return ratio * (1 + q) - 1, ratio + slope / CHOKE_STEP


@kernel
def _nozzle(
    qa: float, qb: float, xi: float, choke: Floats
) -> tuple[float, float, float, float, float, float]:
    """Drop of enthalpy from a to b down to the throat, density there, and their derivatives.

    Theory (Q12), (Q13).

    Returns
    -------
    drop, drop_a, drop_b, rho, rho_a, rho_b : float
        Over p_a/rho_m, and over rho_m.
    """
    if choke.size == 0:
        return _mean_density(qa, qb, xi)
    if qa < qb:
        drop, drop_b, drop_a, rho, rho_b, rho_a = _nozzle_down(qb, qa, xi, choke)
        return -drop, -drop_a, -drop_b, rho, rho_a, rho_b
    return _nozzle_down(qa, qb, xi, choke)


@kernel
def _mean_density(
    qa: float, qb: float, xi: float
) -> tuple[float, float, float, float, float, float]:
    """`_nozzle` with the mean density of both sides and no choking. Theory (Q19)."""
    rho_one, slope_one = _density(qa, xi)
    rho_two, slope_two = _density(qb, xi)
    rho = (rho_one + rho_two) / 2
    drop = (qa - qb) / rho
    drop_a = (1 - drop * slope_one / 2) / rho
    drop_b = (-1 - drop * slope_two / 2) / rho
    return drop, drop_a, drop_b, rho, slope_one / 2, slope_two / 2


@kernel
def _nozzle_down(
    qa: float, qb: float, xi: float, choke: Floats
) -> tuple[float, float, float, float, float, float]:
    """`_nozzle` for a pressure that is not lower at a."""
    rho_up, _ = _density(qa, xi)
    drop = enthalpy(qa, xi)
    if xi < 1.0:
        throat, slope = _throat(qa, choke)
        if throat > qb:
            rho, rho_p = _density(throat, xi)
            drop -= enthalpy(throat, xi)
            return drop, 1 / rho_up - slope / rho, 0.0, rho, rho_p * slope, 0.0
    rho, rho_p = _density(qb, xi)
    return drop - enthalpy(qb, xi), 1 / rho_up, -1 / rho, rho, 0.0, rho_p


@kernel
def _donor(u: float, qa: float, qb: float, xi: float) -> tuple[float, float, float]:
    """Density on the side that the flow comes from, and its derivatives by both pressures."""
    if u > 0.0:
        rho, slope = _density(qa, xi)
        return rho, slope, 0.0
    rho, slope = _density(qb, xi)
    return rho, 0.0, slope


@kernel
def _solve_banded(matrix: Floats, right: Floats, width: int) -> None:
    """Gauss elimination of a banded matrix without pivoting; the solution replaces `right`.

    `matrix[r, width + c - r]` is the element in row r and column c.
    """
    n = right.size
    for k in range(n):
        pivot = matrix[k, width]
        for r in range(k + 1, min(n, k + width + 1)):
            factor = matrix[r, width + k - r]
            if factor != 0.0:
                factor /= pivot
                shift = k - r
                for c in range(width + 1, 2 * width + 1):
                    matrix[r, c + shift] -= factor * matrix[k, c]
                right[r] -= factor * right[k]
    for k in range(n - 1, -1, -1):
        total = right[k]
        for c in range(1, min(width, n - 1 - k) + 1):
            total -= matrix[k, width + c] * right[k + c]
        right[k] = total / matrix[k, width]


@kernel
def _number(live: Flags, cell_at: Indices, face_at: Indices) -> tuple[int, int]:
    """Numbers of the unknowns, slice by slice; how many, and the half-width of their matrix.

    Cells and axial faces without a number get -1. A face takes part if a cell beside it is live.
    """
    pockets, slices = live.shape
    count = 0
    for j in range(slices + 1):
        for i in range(pockets):
            face_at[i, j] = -1
            if (j > 0 and live[i, j - 1]) or (j < slices and live[i, j]):
                face_at[i, j] = count
                count += 1
            if j < slices:
                cell_at[i, j] = -1
                if live[i, j]:
                    cell_at[i, j] = count
                    count += 1
    width = 1
    for i in range(pockets):
        for j in range(slices + 1):
            own = face_at[i, j]
            if own < 0:
                continue
            if j < slices:
                if face_at[i, j + 1] >= 0:
                    width = max(width, face_at[i, j + 1] - own)
                if cell_at[i, j] >= 0:
                    width = max(width, cell_at[i, j] - own)
            if j > 0 and cell_at[i, j - 1] >= 0:
                width = max(width, own - cell_at[i, j - 1])
            if j < slices and i > 0 and cell_at[i, j] >= 0 and cell_at[i - 1, j] >= 0:
                width = max(width, cell_at[i, j] - cell_at[i - 1, j])
    return count, width


@kernel
def _solve_stage(
    shape: tuple[Floats, Floats, Floats, Floats, Floats],
    before: tuple[Floats, Floats, Floats, Floats],
    fields: tuple[Floats, Floats, Floats],
    numbers: tuple[Indices, Indices, int, int],
    fluid: tuple[float, float, Floats],
    fresh: tuple[Floats, Floats, float],
    tau: float,
    rates: Floats,
) -> int:
    """One implicit Euler step by Newton's method. Theory (Q14), (Q15), (Q16).

    Parameters
    ----------
    shape : tuple of ndarray
        Volumes (pockets, slices) [m^3], axial areas (pockets, slices + 1) and areas of the gaps
        (pockets + 1, slices) [m^2], distances of axial faces from the cells before and behind
        (2, pockets, slices + 1) and of gaps from the pockets before and behind (2, pockets + 1,
        slices) [m].
    before : tuple of ndarray
        What the step starts from: volume, excess mass V (rho/rho_m - 1) [m^3], velocities through
        axial faces and gaps [m/s].
    fields : tuple of ndarray
        q, velocities through axial faces and through gaps: first guess, and the solution.
    numbers : tuple
        From `_number`: cells, axial faces, count, half-width.
    fluid : tuple
        Oil fraction, p_a/rho_m [m^2/s^2], choking table; an empty table for the mean density of
        both sides at all openings, without choking.
    fresh : tuple
        Positive for the gaps and axial faces that have just opened, and the factor of their
        inertia.
    tau : float
        Time step. [s]
    rates : ndarray, shape (3,)
        Receives boundary work over p_a [m^3/s], power lost or stored in the flow over rho_m
        [m^5/s^3], volume that leaves to ambient at ambient density [m^3/s].

    Returns
    -------
    int
        Newton iterations, negative without convergence.
    """
    volume, area, gap, reach, gap_reach = shape
    volume0, excess0, axial0, cross0 = before
    q, axial, cross = fields
    cell_at, face_at, count, width = numbers
    xi, c2, choke = fluid
    pockets, slices = q.shape
    matrix = np.zeros((count, 2 * width + 1))
    right = np.zeros(count)
    for iteration in range(1, NEWTON_MOST + 1):
        matrix[:] = 0.0
        right[:] = 0.0
        rates[:] = 0.0
        # Mass of every cell.
        for i in range(pockets):
            for j in range(slices):
                k = cell_at[i, j]
                if k < 0:
                    continue
                rho, slope = _density(q[i, j], xi)
                swelling = _swelling(q[i, j], xi) if xi < 1.0 else 0.0
                excess = -volume[i, j] * swelling / (1 + swelling)
                change = volume[i, j] - volume0[i, j]
                right[k] = -(change + excess - excess0[i, j])
                matrix[k, width] += volume[i, j] * slope
                rates[0] -= q[i, j] * change / tau
        # Gaps, whose velocity follows from the pressures at once.
        for i in range(pockets + 1):
            for j in range(slices):
                ka = cell_at[i - 1, j] if i > 0 else -1
                kb = cell_at[i, j] if i < pockets else -1
                if (ka < 0 and kb < 0) or gap[i, j] <= 0.0:
                    cross[i, j] = 0.0
                    continue
                qa = q[i - 1, j] if ka >= 0 else 0.0
                qb = q[i, j] if kb >= 0 else 0.0
                inertia = (gap_reach[0, i, j] if ka >= 0 else 0.0) + (
                    gap_reach[1, i, j] if kb >= 0 else 0.0
                )
                drop, drop_a, drop_b, rho, rho_a, rho_b = _nozzle(qa, qb, xi, choke)
                a = inertia / tau
                if fresh[0][i, j] > 0.0:
                    a *= fresh[2]
                drive = a * cross0[i, j] + c2 * drop
                root = math.sqrt(a * a + 2 * abs(drive))
                u = 2 * drive / (a + root)
                cross[i, j] = u
                if u * drop < 0.0:
                    rho, rho_a, rho_b = _donor(u, qa, qb, xi)
                flow = gap[i, j] * rho * u
                flow_a = tau * gap[i, j] * (rho * c2 * drop_a / root + u * rho_a)
                flow_b = tau * gap[i, j] * (rho * c2 * drop_b / root + u * rho_b)
                loss = u * abs(u) / 2 + a * (u - cross0[i, j])
                loss += c2 * (enthalpy(qa, xi) - enthalpy(qb, xi) - drop)
                rates[1] += flow * loss
                if ka >= 0:
                    right[ka] -= tau * flow
                    matrix[ka, width] += flow_a
                else:
                    rates[2] -= flow
                if kb >= 0:
                    right[kb] += tau * flow
                    matrix[kb, width] -= flow_b
                else:
                    rates[2] += flow
                if ka >= 0 and kb >= 0:
                    matrix[ka, width + kb - ka] += flow_b
                    matrix[kb, width + ka - kb] -= flow_a
        # Axial faces.
        for i in range(pockets):
            for j in range(slices + 1):
                k = face_at[i, j]
                if k < 0:
                    continue
                ka = cell_at[i, j - 1] if j > 0 else -1
                kb = cell_at[i, j] if j < slices else -1
                u = axial[i, j]
                if ka >= 0 and kb >= 0:
                    rho_one, slope_one = _density(q[i, j - 1], xi)
                    rho_two, slope_two = _density(q[i, j], xi)
                    drop = enthalpy(q[i, j - 1], xi) - enthalpy(q[i, j], xi)
                    drop_a, drop_b = 1 / rho_one, -1 / rho_two
                    rho = 2 * rho_one * rho_two / (rho_one + rho_two)
                    rho_a = slope_one * (rho / rho_one) ** 2 / 2
                    rho_b = slope_two * (rho / rho_two) ** 2 / 2
                    inertia = reach[0, i, j] + reach[1, i, j]
                    whole = drop
                else:
                    qa = q[i, j - 1] if ka >= 0 else 0.0
                    qb = q[i, j] if kb >= 0 else 0.0
                    drop, drop_a, drop_b, rho, rho_a, rho_b = _nozzle(qa, qb, xi, choke)
                    inertia = reach[0, i, j] if ka >= 0 else reach[1, i, j]
                    whole = enthalpy(qa, xi) - enthalpy(qb, xi)
                    if u * drop < 0.0:
                        rho, rho_a, rho_b = _donor(u, qa, qb, xi)
                a = inertia / tau
                if fresh[1][i, j] > 0.0:
                    a *= fresh[2]
                head = u * abs(u) / 2
                matrix[k, width] += a + abs(u)
                if ka >= 0:
                    before_it = max(0.0, axial[i, j - 1])
                    head -= before_it**2 / 2
                    matrix[k, width + face_at[i, j - 1] - k] -= before_it
                    matrix[k, width + ka - k] -= c2 * drop_a
                if kb >= 0:
                    behind_it = min(0.0, axial[i, j + 1])
                    head += behind_it**2 / 2
                    matrix[k, width + face_at[i, j + 1] - k] += behind_it
                    matrix[k, width + kb - k] -= c2 * drop_b
                right[k] = c2 * drop - head - a * (u - axial0[i, j])
                flow = area[i, j] * rho * u
                rates[1] += flow * (head + a * (u - axial0[i, j]) + c2 * (whole - drop))
                section = tau * area[i, j]
                if ka >= 0:
                    right[ka] -= tau * flow
                    matrix[ka, width + k - ka] += section * rho
                    matrix[ka, width] += section * u * rho_a
                    if kb >= 0:
                        matrix[ka, width + kb - ka] += section * u * rho_b
                else:
                    rates[2] -= flow
                if kb >= 0:
                    right[kb] += tau * flow
                    matrix[kb, width + k - kb] -= section * rho
                    matrix[kb, width] -= section * u * rho_b
                    if ka >= 0:
                        matrix[kb, width + ka - kb] -= section * u * rho_a
                else:
                    rates[2] += flow
        _solve_banded(matrix, right, width)
        largest_q, step_q, largest_u, step_u = 0.0, 0.0, 0.0, 0.0
        for k in range(count):
            if not math.isfinite(right[k]):
                return -iteration
        for i in range(pockets):
            for j in range(slices + 1):
                k = face_at[i, j]
                if k >= 0:
                    axial[i, j] += right[k]
                    step_u = max(step_u, abs(right[k]))
                    largest_u = max(largest_u, abs(axial[i, j]))
                if j == slices:
                    continue
                k = cell_at[i, j]
                if k >= 0:
                    moved = q[i, j] + right[k]
                    if xi < 1.0:
                        moved = max(moved, 0.2 * (1 + q[i, j]) - 1)
                    step_q = max(step_q, abs(moved - q[i, j]))
                    q[i, j] = moved
                    largest_q = max(largest_q, abs(moved))
        if (
            step_q <= NEWTON_TOLERANCE * largest_q + 1e-15
            and step_u <= NEWTON_TOLERANCE * largest_u + 1e-12
        ):
            return iteration
    return -NEWTON_MOST


@kernel
def _excess(q: Floats, volume: Floats, live: Flags, xi: float, excess: Floats) -> None:
    """V (rho/rho_m - 1) of every live cell, zero elsewhere."""
    for i in range(q.shape[0]):
        for j in range(q.shape[1]):
            excess[i, j] = 0.0
            if live[i, j] and xi < 1.0:
                swelling = _swelling(q[i, j], xi)
                excess[i, j] = -volume[i, j] * swelling / (1 + swelling)


@kernel
def _euler_steps(
    start: tuple[Floats, Floats, Floats, Floats, Floats],
    end: tuple[Floats, Floats, Floats, Floats, Floats],
    fields: tuple[Floats, Floats, Floats],
    numbers: tuple[Indices, Indices, int, int],
    live: Flags,
    fluid: tuple[float, float, Floats],
    fresh: tuple[Floats, Floats, float],
    step: float,
    parts: int,
    totals: Floats,
) -> int:
    """One time step by `parts` implicit Euler steps, the geometry linear in between.

    The way out where the larger step has no solution that Newton's method finds.
    """
    q, axial, cross = fields
    excess = np.zeros_like(q)
    rates = np.zeros(3)
    iterations = 0
    for part in range(parts):
        left, right = part / parts, (part + 1) / parts
        volume0 = start[0] + left * (end[0] - start[0])
        now = (
            start[0] + right * (end[0] - start[0]),
            start[1] + right * (end[1] - start[1]),
            start[2] + right * (end[2] - start[2]),
            start[3] + right * (end[3] - start[3]),
            start[4] + right * (end[4] - start[4]),
        )
        _excess(q, volume0, live, fluid[0], excess)
        done = _solve_stage(
            now,
            (volume0, excess, axial.copy(), cross.copy()),
            fields,
            numbers,
            fluid,
            fresh,
            step / parts,
            rates,
        )
        if done < 0:
            return -1
        iterations += done
        totals[:3] += step / parts * rates
    return iterations


@kernel
def _advance(
    start: tuple[Floats, Floats, Floats, Floats, Floats],
    middle: tuple[Floats, Floats, Floats, Floats, Floats],
    end: tuple[Floats, Floats, Floats, Floats, Floats],
    fields: tuple[Floats, Floats, Floats],
    numbers: tuple[Indices, Indices, int, int],
    live: Flags,
    fluid: tuple[float, float, Floats],
    fresh: tuple[Floats, Floats, float],
    step: float,
    totals: Floats,
) -> int:
    """One time step; adds its works and its outflow to `totals`. Theory (Q17).

    Returns the Newton iterations; negative if no solution was found.
    """
    q, axial, cross = fields
    q0, axial0, cross0 = q.copy(), axial.copy(), cross.copy()
    excess0 = np.zeros_like(q)
    _excess(q, start[0], live, fluid[0], excess0)
    rates = np.zeros((2, 3))
    tau = SDIRK * step
    done = _solve_stage(
        middle, (start[0], excess0, axial0, cross0), fields, numbers, fluid, fresh, tau, rates[0]
    )
    if done > 0:
        more = (1 - SDIRK) / SDIRK
        excess1 = np.zeros_like(q)
        _excess(q, middle[0], live, fluid[0], excess1)
        second = _solve_stage(
            end,
            (
                start[0] + more * (middle[0] - start[0]),
                excess0 + more * (excess1 - excess0),
                axial0 + more * (axial - axial0),
                cross0 + more * (cross - cross0),
            ),
            fields,
            numbers,
            fluid,
            fresh,
            tau,
            rates[1],
        )
        if second > 0:
            totals[:3] += step * ((1 - SDIRK) * rates[0] + SDIRK * rates[1])
            return done + second
    parts = 4
    while parts <= 256:
        q[:], axial[:], cross[:] = q0, axial0, cross0
        trial = np.zeros(3)
        done = _euler_steps(start, end, fields, numbers, live, fluid, fresh, step, parts, trial)
        if done > 0:
            totals[:3] += trial
            return done
        parts *= 4
    return -1


@kernel
def periodic_flow(
    shape: tuple[Floats, Floats, Floats, Floats, Floats],
    live: Flags,
    fluid: tuple[float, float, Floats],
    step: float,
    shift: int,
    limits: tuple[int, float],
    history: tuple[Floats, Floats, Floats],
    works: Floats,
    figures: Floats,
) -> int:
    """Flow through the pockets, mesh period after mesh period until it repeats. Theory (Q18).

    Parameters
    ----------
    shape : tuple of ndarray
        As for `_solve_stage`, with a first axis of 2 n + 1 times: the start of the period, then
        for each of n steps the inner point of the time stepping and the end of the step.
    live : ndarray of bool, shape (n, pockets, slices)
        Which cells are pockets during each step.
    fluid : tuple
        As for `_solve_stage`.
    step : float
        [s]
    shift : int
        Pockets by which the numbering moves on from one period to the next.
    limits : tuple
        Most periods, and the change of the power from one period to the next, relative, below
        which the flow is periodic; fields may change by ten times that of their largest value.
    history : tuple of ndarray
        Receives q (n, pockets, slices), velocities through axial faces (n, pockets, slices + 1)
        and gaps (n, pockets + 1, slices) [m/s] of the last period.
    works : ndarray, shape (n,)
        Receives the boundary work over p_a of each step of the last period. [m^3]
    figures : ndarray, shape (8,)
        Receives for the last period: boundary work over p_a [m^3]; work lost in the flow over
        rho_m [m^5/s^2], that left in pockets at their end included; volumes at ambient density
        that come with new pockets, leave through the openings and go with the ended ones, and
        what is stored [m^3]; change of the power and of the fields [1].

    Returns
    -------
    int
        Periods; negative if the flow did not repeat, and both works are then means of the last
        half of the periods; zero if a step has no solution.
    """
    steps, pockets, slices = live.shape
    xi = fluid[0]
    q = np.zeros((pockets, slices))
    axial = np.zeros((pockets, slices + 1))
    cross = np.zeros((pockets + 1, slices))
    fields = (q, axial, cross)
    cell_at = np.zeros((pockets, slices), np.int64)
    face_at = np.zeros((pockets, slices + 1), np.int64)
    alive = np.zeros((pockets, slices), np.bool_)
    excess = np.zeros((pockets, slices))
    before = np.zeros((pockets, slices))
    fresh = (
        np.zeros((pockets + 1, slices)),
        np.zeros((pockets, slices + 1)),
        NEW_INERTIA / steps,
    )
    last_work = math.nan
    mean = np.zeros(2)
    for period in range(1, limits[0] + 1):
        totals = np.zeros(6)
        stored = _stored(q, shape[0][0], alive, xi, excess)
        for n in range(steps):
            volume0 = shape[0][2 * n]
            _mark_fresh(live[n], alive, fresh, 1 / steps)
            for i in range(pockets):
                for j in range(slices):
                    if live[n, i, j] == alive[i, j]:
                        continue
                    if live[n, i, j]:
                        q[i, j] = 0.0
                        totals[3] += volume0[i, j]
                    else:
                        totals[4] += _leave(q[i, j], volume0[i, j], fluid, totals)
                        q[i, j] = 0.0
                    alive[i, j] = live[n, i, j]
            count, width = _number(alive, cell_at, face_at)
            for i in range(pockets):
                for j in range(slices + 1):
                    if face_at[i, j] < 0:
                        axial[i, j] = 0.0
            work_before = totals[0]
            done = _advance(
                _at(shape, 2 * n),
                _at(shape, 2 * n + 1),
                _at(shape, 2 * n + 2),
                fields,
                (cell_at, face_at, count, width),
                alive,
                fluid,
                fresh,
                step,
                totals,
            )
            if done < 0:
                return 0
            works[n] = totals[0] - work_before
            history[0][n] = q
            history[1][n] = axial
            history[2][n] = cross
        stored_now = _stored(q, shape[0][2 * steps], alive, xi, excess)
        _renumber(fields, fresh, alive, shift)
        field_change = np.abs(q - before).max() / max(np.abs(q).max(), 1e-300)
        before[:] = q
        work = totals[0]
        change = abs(work - last_work) / max(abs(work), 1e-300)
        last_work = work
        if 2 * period > limits[0]:
            mean += totals[:2] / (limits[0] - limits[0] // 2)
        figures[:5] = totals[0], totals[1], totals[3], totals[2], totals[4]
        figures[5] = stored_now - stored
        figures[6], figures[7] = change, field_change
        if change <= limits[1] and field_change <= 10 * limits[1]:
            return period
    figures[:2] = mean
    return -limits[0]


@kernel
def _mark_fresh(
    live: Flags, alive: Flags, fresh: tuple[Floats, Floats, float], step: float
) -> None:
    """Age the openings by a step, a share of the period, and mark those beside new pockets only.

    Theory (Q20).
    """
    pockets, slices = live.shape
    for i in range(pockets + 1):
        for j in range(slices):
            here = (i > 0 and live[i - 1, j]) or (i < pockets and live[i, j])
            old = (i > 0 and alive[i - 1, j]) or (i < pockets and alive[i, j])
            fresh[0][i, j] = max(0.0, fresh[0][i, j] - step)
            if here and not old:
                fresh[0][i, j] = EASE - step / 2
    for i in range(pockets):
        for j in range(slices + 1):
            here = (j > 0 and live[i, j - 1]) or (j < slices and live[i, j])
            old = (j > 0 and alive[i, j - 1]) or (j < slices and alive[i, j])
            fresh[1][i, j] = max(0.0, fresh[1][i, j] - step)
            if here and not old:
                fresh[1][i, j] = EASE - step / 2


@kernel
def _at(
    shape: tuple[Floats, Floats, Floats, Floats, Floats], n: int
) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    return shape[0][n], shape[1][n], shape[2][n], shape[3][n], shape[4][n]


@kernel
def _stored(q: Floats, volume: Floats, live: Flags, xi: float, excess: Floats) -> float:
    """Mass in all live cells over rho_m. [m^3]"""
    _excess(q, volume, live, xi, excess)
    total = 0.0
    for i in range(q.shape[0]):
        for j in range(q.shape[1]):
            if live[i, j]:
                total += volume[i, j] + excess[i, j]
    return total


@kernel
def _leave(q: float, volume: float, fluid: tuple[float, float, Floats], totals: Floats) -> float:
    """Mass over rho_m of a cell that ends; its work above ambient goes to `totals`. [m^3]

    Theory (Q20).
    """
    rho, _ = _density(q, fluid[0])
    totals[1] += volume * fluid[1] * (rho * enthalpy(q, fluid[0]) - q)
    return volume * rho


@kernel
def _renumber(
    fields: tuple[Floats, Floats, Floats],
    fresh: tuple[Floats, Floats, float],
    alive: Flags,
    shift: int,
) -> None:
    """Give every pocket the number of the one that it has replaced one period later."""
    q, axial, cross = fields
    for i in range(cross.shape[0]):
        source = i + shift
        if source < cross.shape[0]:
            cross[i], fresh[0][i] = cross[source], fresh[0][source]
        else:
            cross[i], fresh[0][i] = 0.0, 0.0
        if source < q.shape[0]:
            q[i], axial[i], alive[i] = q[source], axial[source], alive[source]
            fresh[1][i] = fresh[1][source]
        elif i < q.shape[0]:
            q[i], axial[i], alive[i] = 0.0, 0.0, False
            fresh[1][i] = 0.0
