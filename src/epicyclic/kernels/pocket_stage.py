"""The mixture in pockets, and one implicit step of its flow."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.compiling import kernel

# The mixture in pockets: its state, and its flow through openings.
#
# Pressures are kept as q = p/p_a - 1, which stays exact at low speed. Symbols follow the theory
# manual, page on pocketing.


Floats = NDArray[np.float64]
Mixture = tuple[float, float, float, float, float]  # As from `mixture`.

GAMMA = 1.4  # Ratio of the specific heats of air. [1]
CHOKE_STEP = 0.05
CHOKE_END = 16.0  # Step and end of the table of throat pressures, in the logarithm of the pressure.


@kernel
def mixture(q: float, xi: float) -> Mixture:
    """The mixture at a pressure: q, rho, slope, enthalpy, swelling. Theory (Q8), (Q9).

    The pressure; the density over rho_m, and its derivative by q; the integral of dp/rho from
    ambient pressure, over p_a/rho_m; rho_m/rho - 1.
    """
    log_p = math.log1p(q)
    swelling = (1 - xi) * math.expm1(-log_p / GAMMA)
    slope = (1 - xi) / GAMMA * math.exp(-log_p * (1 / GAMMA + 1))
    power = (GAMMA - 1) / GAMMA
    enthalpy = xi * q + (1 - xi) / power * math.expm1(power * log_p)
    return q, 1 / (1 + swelling), slope / (1 + swelling) ** 2, enthalpy, swelling


@kernel
def choking_table(xi: float) -> Floats:
    """Throat pressure over stagnation pressure where the throat runs at the speed of sound.

    Theory (Q13). On a grid of the logarithm of the stagnation pressure, ``CHOKE_STEP`` apart from
    ``-CHOKE_END`` to ``CHOKE_END``.
    """
    count = round(2 * CHOKE_END / CHOKE_STEP) + 1
    ratio = np.zeros(count)
    guess = 0.53
    for n in range(count):
        p = math.exp(-CHOKE_END + n * CHOKE_STEP)
        total = mixture(p - 1, xi)[3]
        low, high = 0.0, 1.0
        for _ in range(60):
            guess = (low + high) / 2
            _, _, slope, enthalpy, _ = mixture(guess * p - 1, xi)
            if enthalpy + 0.5 / slope > total:
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
def nozzle(
    a: Mixture, b: Mixture, xi: float, choke: Floats
) -> tuple[float, float, float, float, float, float]:
    """Drop of enthalpy from a to b down to the throat, density there, and their derivatives.

    Returns drop, drop_a, drop_b over p_a/rho_m, and rho, rho_a, rho_b over rho_m. Theory (Q12),
    (Q13).
    """
    if choke.size == 0:
        return _mean_density(a, b)
    if a[0] < b[0]:
        drop, drop_b, drop_a, rho, rho_b, rho_a = _nozzle_down(b, a, xi, choke)
        return -drop, -drop_a, -drop_b, rho, rho_a, rho_b
    return _nozzle_down(a, b, xi, choke)


@kernel
def _mean_density(a: Mixture, b: Mixture) -> tuple[float, float, float, float, float, float]:
    """`nozzle` with the mean density of both sides and no choking. Theory (Q19)."""
    rho = (a[1] + b[1]) / 2
    drop = (a[0] - b[0]) / rho
    drop_a = (1 - drop * a[2] / 2) / rho
    drop_b = (-1 - drop * b[2] / 2) / rho
    return drop, drop_a, drop_b, rho, a[2] / 2, b[2] / 2


@kernel
def _nozzle_down(
    a: Mixture, b: Mixture, xi: float, choke: Floats
) -> tuple[float, float, float, float, float, float]:
    """`nozzle` for a pressure that is not lower at a."""
    _, rho_up, _, total, _ = a
    q, rho, rho_p, enthalpy, _ = b
    throat, slope = _throat(a[0], choke)
    if throat > q:
        _, rho, rho_p, enthalpy, _ = mixture(throat, xi)
        return total - enthalpy, 1 / rho_up - slope / rho, 0.0, rho, rho_p * slope, 0.0
    return total - enthalpy, 1 / rho_up, -1 / rho, rho, 0.0, rho_p


@kernel
def donor(u: float, a: Mixture, b: Mixture) -> tuple[float, float, float]:
    """Density on the side that the flow comes from, and its derivatives by both pressures."""
    if u > 0.0:
        return a[1], a[2], 0.0
    return b[1], 0.0, b[2]


# One implicit step of the flow through the pockets of a mesh.
#
# Cells (i, j): pocket i along the mesh, slice j across the face. Axial face j of pocket i lies
# before cell (i, j), gap i of slice j before cell (i, j) as well.

Flags = NDArray[np.bool_]
Indices = NDArray[np.int64]
Shape = tuple[Floats, Floats, Floats, Floats, Floats, Floats]
Fluid = tuple[float, float, Floats, bool]
Fresh = tuple[Floats, Floats, float]
Numbers = tuple[Indices, Indices, int, int]
Fields = tuple[Floats, Floats, Floats]

SHOCK_MACH = 0.5  # Mach number from which flow that slows down is taken from upstream. [1]
NEWTON_MOST = 40  # Newton iterations of one stage before it is given up.
NEWTON_TOLERANCE = 1e-9  # Last Newton step over the largest value in the field. [1]
VACUUM = 1e-9 - 1  # Pressure next to none, as q.
DRIVEN = 4.0
"""Kinetic energy over what pressures and velocities can drive beyond which a root is none: exact
flows have 1 at most, and differences across the face miss that by less than this. [1]"""


@kernel
def _solve_banded(matrix: Floats, right: Floats, width: int) -> None:
    """Gauss elimination of a banded matrix without pivoting; the solution replaces `right`.

    `matrix[r, width + c - r]` is the element in row r and column c, zero in the first and the last
    diagonal. Rows are taken in pairs, which halves the way to the memory and back. Those of the
    inner loops are views, counted from zero: only so do they become vector instructions.
    """
    n = right.size
    for k in range(0, n - 1, 2):
        one, two = matrix[k], matrix[k + 1]
        factor = two[width - 1] / one[width]
        upper, lower = one[width + 1 : 2 * width + 1], two[width : 2 * width]
        for c in range(width):
            lower[c] -= factor * upper[c]
        right[k + 1] -= factor * right[k]
        upper1, upper2 = one[width + 2 : 2 * width + 1], two[width + 1 : 2 * width]
        for r in range(k + 2, min(n, k + width + 1)):
            at = width + k - r
            factor1, factor2 = matrix[r, at], matrix[r, at + 1]
            if factor1 != 0.0 or factor2 != 0.0:
                factor1 /= one[width]
                factor2 = (factor2 - factor1 * one[width + 1]) / two[width]
                lower = matrix[r, at + 2 : at + width + 1]
                for c in range(width - 1):
                    lower[c] = lower[c] - factor1 * upper1[c] - factor2 * upper2[c]
                right[r] = right[r] - factor1 * right[k] - factor2 * right[k + 1]
    for k in range(n - 1, -1, -1):
        total = right[k]
        for c in range(1, min(width, n - 1 - k) + 1):
            total -= matrix[k, width + c] * right[k + c]
        right[k] = total / matrix[k, width]


@kernel
def number(live: Flags, cell_at: Indices, face_at: Indices) -> tuple[int, int]:
    """Numbers of the unknowns, slice by slice; how many, and `width` as for `_solve_banded`.

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
    return count, width + 1


@kernel
def downstream_share(axial: Floats, spread: Floats, alive: Flags, j: int) -> float:
    """Share of faces downstream in the kinetic energy of cell j of one pocket. Theory (Q24)."""
    here = (axial[j + 1] - axial[j]) * spread[j]
    share = 0.5
    for face, other in ((j, j - 1), (j + 1, j + 1)):
        enters = axial[face] > 0.0 if other < j else axial[face] < 0.0
        if enters and 0 <= other < alive.size and alive[other]:
            before = (axial[other + 1] - axial[other]) * spread[other]
            if here * before <= 0.0:
                return 0.0
            share = min(share, before / (here + before))
    return share


@kernel
def kinetic_shares(
    axial: Floats, shape: Shape, cell_at: Indices, fluid: Fluid, fresh: Fresh
) -> Floats:
    """Shares of the left and right face in the kinetic energy of each cell. Theory (Q24)."""
    volume, area, new = shape[0], shape[2], fresh[1]
    pockets, slices = cell_at.shape
    slowness2 = (1 - fluid[0]) / (GAMMA * fluid[1])
    shares = np.full((2, pockets, slices), 0.5)
    if fluid[3]:
        return shares
    for i in range(pockets):
        alive = cell_at[i] >= 0
        spread = (area[i, 1:] + area[i, :-1]) / volume[i]
        for j in range(slices):
            if not alive[j]:
                continue
            left, right = axial[i, j], axial[i, j + 1]
            share = 0.0
            if new[i, j] <= 0.0 and new[i, j + 1] <= 0.0:
                share = downstream_share(axial[i], spread, alive, j)
                if max(left, -right) > max(-left, right):
                    mach2 = slowness2 * max(left**2, right**2)
                    share *= max(0.0, 1 - mach2 / SHOCK_MACH**2)
            shares[0, i, j] = 1 - share if left > 0.0 else share
            shares[1, i, j] = 1 - share if right < 0.0 else share
    return shares


@kernel
def _state(states: Floats, i: int, j: int) -> Mixture:
    return states[i, j, 0], states[i, j, 1], states[i, j, 2], states[i, j, 3], states[i, j, 4]


@kernel
def _keep(states: Floats, i: int, j: int, state: Mixture) -> None:
    for n in range(5):
        states[i, j, n] = state[n]


@kernel
def _add_masses(
    shape: Shape,
    excess0: Floats,
    q: Floats,
    cell_at: Indices,
    xi: float,
    states: Floats,
    system: tuple[Floats, Floats, int],
) -> float:
    """Balance of the mass of every cell, but for its openings; the boundary work. Theory (Q14).

    The state of the mixture in cell (i, j) goes to `states[i + 1, j + 1]`.
    """
    volume, growth = shape[0], shape[1]
    matrix, right, width = system
    work = 0.0
    for i in range(q.shape[0]):
        for j in range(q.shape[1]):
            k = cell_at[i, j]
            if k < 0:
                continue
            _keep(states, i + 1, j + 1, mixture(q[i, j], xi))
            _, _, slope, _, swelling = _state(states, i + 1, j + 1)
            excess = -volume[i, j] * swelling / (1 + swelling)
            right[k] = -(growth[i, j] + excess - excess0[i, j])
            matrix[k, width] += volume[i, j] * slope
            work -= q[i, j] * growth[i, j]
    return work


@kernel
def _exchange(
    ka: int, kb: int, flow: float, flow_a: float, flow_b: float, system: tuple[Floats, Floats, int]
) -> float:
    """Put a flow from cell a to cell b, and its derivatives by their pressures, into both balances.

    Returns what it takes out of the surroundings, negative if it goes there.
    """
    matrix, right, width = system
    outside = 0.0
    if ka >= 0:
        right[ka] -= flow
        matrix[ka, width] += flow_a
        if kb >= 0:
            matrix[ka, width + kb - ka] += flow_b
    else:
        outside += flow
    if kb >= 0:
        right[kb] += flow
        matrix[kb, width] -= flow_b
        if ka >= 0:
            matrix[kb, width + ka - kb] -= flow_a
    else:
        outside -= flow
    return outside


@kernel
def _add_gaps(
    shape: Shape,
    cross0: Floats,
    fields: Fields,
    cell_at: Indices,
    fluid: Fluid,
    fresh: Fresh,
    tau: float,
    states: Floats,
    system: tuple[Floats, Floats, int],
    rates: Floats,
) -> None:
    """Flow through the gaps, whose velocity follows from the pressures at once. Theory (Q16)."""
    gap, gap_reach = shape[3], shape[5]
    cross = fields[2]
    xi, c2, choke, _ = fluid
    pockets, slices = cell_at.shape
    for i in range(pockets + 1):
        for j in range(slices):
            ka = cell_at[i - 1, j] if i > 0 else -1
            kb = cell_at[i, j] if i < pockets else -1
            if (ka < 0 and kb < 0) or gap[i, j] <= 0.0:
                cross[i, j] = 0.0
                continue
            a, b = _state(states, i, j + 1), _state(states, i + 1, j + 1)
            inertia = (gap_reach[0, i, j] if ka >= 0 else 0.0) + (
                gap_reach[1, i, j] if kb >= 0 else 0.0
            )
            drop, drop_a, drop_b, rho, rho_a, rho_b = nozzle(a, b, xi, choke)
            inertia /= tau
            if fresh[0][i, j] > 0.0:
                inertia *= fresh[2]
            drive = inertia * cross0[i, j] + c2 * drop
            root = math.sqrt(inertia * inertia + 2 * abs(drive))
            u = 2 * drive / (inertia + root)
            cross[i, j] = u
            if u * drop < 0.0:
                rho, rho_a, rho_b = donor(u, a, b)
            lost = u * abs(u) / 2 + inertia * (u - cross0[i, j])
            lost += c2 * (a[3] - b[3] - drop)
            rates[1] += gap[i, j] * rho * u * lost
            section = tau * gap[i, j]
            outside = _exchange(
                ka,
                kb,
                section * rho * u,
                section * (rho * c2 * drop_a / root + u * rho_a),
                section * (rho * c2 * drop_b / root + u * rho_b),
                system,
            )
            rates[2] -= outside / tau


@kernel
def _axial_drop(
    inside: bool, a: Mixture, b: Mixture, u: float, fluid: Fluid
) -> tuple[float, float, float, float, float, float]:
    """Drop of enthalpy along the face, density, and their derivatives.

    Inside a pocket the specific volume is the mean of both sides; at its ends as `nozzle`.
    """
    if inside:
        _, rho_one, slope_one, enthalpy_one, _ = a
        _, rho_two, slope_two, enthalpy_two, _ = b
        rho = 2 * rho_one * rho_two / (rho_one + rho_two)
        rho_a = slope_one * (rho / rho_one) ** 2 / 2
        rho_b = slope_two * (rho / rho_two) ** 2 / 2
        return enthalpy_one - enthalpy_two, 1 / rho_one, -1 / rho_two, rho, rho_a, rho_b
    drop, drop_a, drop_b, rho, rho_a, rho_b = nozzle(a, b, fluid[0], fluid[2])
    if u * drop < 0.0:
        rho, rho_a, rho_b = donor(u, a, b)
    return drop, drop_a, drop_b, rho, rho_a, rho_b


@kernel
def _add_faces(
    shape: Shape,
    axial0: Floats,
    fields: Fields,
    numbers: Numbers,
    fluid: Fluid,
    fresh: Fresh,
    shares: Floats,
    tau: float,
    states: Floats,
    system: tuple[Floats, Floats, int],
    rates: Floats,
) -> None:
    """Momentum and flow of every axial face. Theory (Q15)."""
    area, reach = shape[2], shape[4]
    axial = fields[1]
    cell_at, face_at = numbers[0], numbers[1]
    c2 = fluid[1]
    matrix, right, width = system
    pockets, slices = cell_at.shape
    for i in range(pockets):
        for j in range(slices + 1):
            k = face_at[i, j]
            if k < 0:
                continue
            ka = cell_at[i, j - 1] if j > 0 else -1
            kb = cell_at[i, j] if j < slices else -1
            a, b = _state(states, i + 1, j), _state(states, i + 1, j + 1)
            u = axial[i, j]
            inside = ka >= 0 and kb >= 0
            drop, drop_a, drop_b, rho, rho_a, rho_b = _axial_drop(inside, a, b, u, fluid)
            inertia = (reach[0, i, j] if ka >= 0 else 0.0) + (reach[1, i, j] if kb >= 0 else 0.0)
            inertia /= tau
            if fresh[1][i, j] > 0.0:
                inertia *= fresh[2]
            head = 0.0
            matrix[k, width] += inertia
            if ka >= 0:
                own, beside = shares[1, i, j - 1] * u, shares[0, i, j - 1] * axial[i, j - 1]
                head -= (beside * axial[i, j - 1] + own * u) / 2
                matrix[k, width] -= own
                matrix[k, width + face_at[i, j - 1] - k] -= beside
                matrix[k, width + ka - k] -= c2 * drop_a
            elif u < 0.0:
                head -= u**2 / 2
                matrix[k, width] -= u
            if kb >= 0:
                own, beside = shares[0, i, j] * u, shares[1, i, j] * axial[i, j + 1]
                head += (own * u + beside * axial[i, j + 1]) / 2
                matrix[k, width] += own
                matrix[k, width + face_at[i, j + 1] - k] += beside
                matrix[k, width + kb - k] -= c2 * drop_b
            elif u > 0.0:
                head += u**2 / 2
                matrix[k, width] += u
            push = inertia * (u - axial0[i, j])
            right[k] = c2 * drop - head - push
            rates[1] += area[i, j] * rho * u * (head + push + c2 * (a[3] - b[3] - drop))
            section = tau * area[i, j]
            if ka >= 0:
                matrix[ka, width + k - ka] += section * rho
            if kb >= 0:
                matrix[kb, width + k - kb] -= section * rho
            flow = section * rho * u
            outside = _exchange(ka, kb, flow, section * u * rho_a, section * u * rho_b, system)
            rates[2] -= outside / tau


@kernel
def _move(step: Floats, fields: Fields, numbers: Numbers) -> bool:
    """Add a Newton step to the fields; whether it was small enough to be the last."""
    q, axial, _ = fields
    cell_at, face_at = numbers[0], numbers[1]
    largest_q, step_q, largest_u, step_u = 0.0, 0.0, 0.0, 0.0
    pockets, slices = q.shape
    for i in range(pockets):
        for j in range(slices + 1):
            k = face_at[i, j]
            if k >= 0:
                axial[i, j] += step[k]
                step_u = max(step_u, abs(step[k]))
                largest_u = max(largest_u, abs(axial[i, j]))
            if j == slices:
                continue
            k = cell_at[i, j]
            if k >= 0:
                moved = max(q[i, j] + step[k], 0.2 * (1 + q[i, j]) - 1)
                step_q = max(step_q, abs(moved - q[i, j]))
                q[i, j] = moved
                largest_q = max(largest_q, abs(moved))
    return (
        step_q <= NEWTON_TOLERANCE * largest_q + 1e-15
        and step_u <= NEWTON_TOLERANCE * largest_u + 1e-12
    )


@kernel
def solve_stage(
    # Volumes and their growth in the step (pockets, slices) [m^3], axial areas (pockets, slices +
    # 1) and areas of the gaps (pockets + 1, slices) [m^2], distances of axial faces from the cells
    # before and behind (2, pockets, slices + 1) and of gaps from the pockets before and behind (2,
    # pockets + 1, slices) [m].
    shape: Shape,
    # What the step starts from: excess mass V (rho/rho_m - 1) [m^3], velocities through axial faces
    # and gaps [m/s].
    before: Fields,
    # q, velocities through axial faces and through gaps: first guess, and the solution.
    fields: Fields,
    numbers: Numbers,  # From `number`: cells, axial faces, count, width.
    # Oil fraction, p_a/rho_m [m^2/s^2], choking table, whether differences are central; an empty
    # table for the mean density of both sides at all openings, without choking.
    fluid: Fluid,
    # Positive for the gaps and axial faces that have just opened, and the factor of their inertia.
    fresh: Fresh,
    shares: Floats,  # From `kinetic_shares`.
    tau: float,  # Time step. [s]
    # Receives boundary work over p_a [m^3/s], power lost or stored in the flow over rho_m
    # [m^5/s^3], volume that leaves to ambient at ambient density [m^3/s].
    rates: Floats,
) -> int:
    """One implicit Euler step by Newton's method. Theory (Q14), (Q15), (Q16).

    Newton iterations, negative without convergence.
    """
    excess0, axial0, cross0 = before
    cell_at, _, count, width = numbers
    pockets, slices = cell_at.shape
    states = np.zeros((pockets + 2, slices + 2, 5))
    for i in range(pockets + 2):
        for j in range(slices + 2):
            _keep(states, i, j, mixture(0.0, fluid[0]))  # the surroundings, where no cell is
    matrix = np.zeros((count, 2 * width + 1))
    right = np.zeros(count)
    system = (matrix, right, width)
    for iteration in range(1, NEWTON_MOST + 1):
        matrix[:] = 0.0
        right[:] = 0.0
        rates[:] = 0.0
        work = _add_masses(shape, excess0, fields[0], cell_at, fluid[0], states, system)
        rates[0] = work / tau
        _add_gaps(shape, cross0, fields, cell_at, fluid, fresh, tau, states, system, rates)
        _add_faces(shape, axial0, fields, numbers, fluid, fresh, shares, tau, states, system, rates)
        _solve_banded(matrix, right, width)
        if not np.isfinite(right).all():
            return -iteration
        if _move(right, fields, numbers):
            return iteration if _speeds_can_be(before, fields, fluid) else -iteration
    return -NEWTON_MOST


@kernel
def _speeds_can_be(before: Fields, fields: Fields, fluid: Fluid) -> bool:
    """Whether no flow is faster than its pressures and its velocities before can drive it.

    Newton's method also finds roots of the equations that no flow comes to.
    """
    total = mixture(fields[0].max(), fluid[0])[3] - mixture(VACUUM, fluid[0])[3]
    before2 = max(np.abs(before[1]).max(), np.abs(before[2]).max()) ** 2
    now2 = max(np.abs(fields[1]).max(), np.abs(fields[2]).max()) ** 2
    return bool(now2 <= DRIVEN * (2 * fluid[1] * total + before2))
