"""Transient line contact with two moving rough surfaces.

Time steps of a whole number of nodes, m dX/u_r on an even grid, so that the entrained mass is
carried from node to node along the characteristic, exactly. The pressure flow, the deflection and
the load are implicit. Each step is solved by Newton's method.
"""

from __future__ import annotations

import math
from enum import IntEnum

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.kernels.compiling import kernel
from epicyclic.plugins.contact_solver.kernels_fluid import (
    ScaledFluid,
    density_ratio,
    flow_work,
    log_viscosity_ratio,
    mean_fluidity,
    mean_shear,
    thinning_factor,
)
from epicyclic.plugins.contact_solver.kernels_linear import (
    BAND,
    Groups,
    Space,
    coarse_matrix,
    deflect,
    factor_band,
    factor_dense,
    solve_linear,
    space_for,
    update_groups,
)


class Column(IntEnum):
    """What a record of a time step holds."""

    FLUID_SHEAR = 0
    """Integral over X, scaled, as the next."""
    ASPERITY_SHEAR = 1
    CONTACT_SHARE = 2
    """Touching length over 2 b."""
    ASPERITY_LOAD = 3
    """Integral over X of the pressure where surfaces touch."""
    LEAST_FILM = 4
    FLOW_POWER = 5
    """Power of the pressure flow. Theory (H33)."""
    ERROR = 6
    """What the tolerance of a step bounds."""
    HIGHEST_PRESSURE = 7
    CENTRAL_FILM = 8


REFRESH = 1  # GMRES steps beyond which the preconditioner is made anew in the next Newton step.
LARGEST_STEP = 0.7
"""Largest change of a pressure in one Newton step, over the largest pressure or p_h. [1]"""
HELD = (1.0, 2.0)
"""Compliance of a node that holds it back in each attempt, over that to its own pressure. [1]"""
FILM_FALL = 0.5
"""Share of the film upstream below which the second-order step would come near to none. [1]"""


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
    pull = fluid.poiseuille / dx
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
            product, part = left * right, 1.0 / (left + right)
            mean_film = 0.5 * (left + right)
            ease, exponent, softening = thinning_factor(
                1.0 / (root_left * root_right), mean_film, 0.5 * (pressure[i] + pressure[i + 1]),
                fluid,
            )  # fmt: skip
            soft = 0.5 * exponent * softening
            density = rho[i] + rho[i + 1]  # twice its mean
            g = pull * density * product * product * part * fluidity * ease
            conductance[i] = g
            flow = g * (pressure[i + 1] - pressure[i])
            packed = flow / density
            terms[i, 0] = -g + (
                packed * d_rho[i] + flow * (soft + (by_left + 0.5 * exponent) * slope_left)
            )
            terms[i, 1] = g + (
                packed * d_rho[i + 1] + flow * (soft + (by_right + 0.5 * exponent) * slope_right)
            )
            shared = (1.0 + exponent) * part
            doubled = 2.0 / product
            terms[i, 2] = flow * (doubled * right - shared)
            terms[i, 3] = flow * (doubled * left - shared)
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
    active: BoolArray, compliance: float, local: FloatArray, by_film: FloatArray,
) -> None:  # fmt: skip
    """Derivatives of the excess of mass in P and in H of nodes i - 1, i, i + 1.

    A node that a thicker film fills by more than it holds is held back by a `compliance`. Beside a
    steep pressure the inflow of a thin film grows faster with it than its mass. The node then has
    two states, and Newton's method would swing between them.
    """
    n = film.size
    local[:] = 0.0
    by_film[:] = 0.0
    for i in range(1, n - 1):
        if active[i]:
            by_film[i, 0] = terms[i - 1, 2]
            by_film[i, 1] = order[i] * rho[i] + terms[i - 1, 3] - terms[i, 2]
            by_film[i, 2] = -terms[i, 3]
            local[i, 0] = terms[i - 1, 0]
            local[i, 1] = order[i] * d_rho[i] * film[i] + terms[i - 1, 1] - terms[i, 0]
            local[i, 1] += compliance * max(order[i] * rho[i] - by_film[i, 1], 0.0)
            local[i, 2] = -terms[i, 1]


@kernel
def solve_step(
    pressure: FloatArray,  # Started from; the first and last one stay.
    film: FloatArray,
    approach: float,  # H_0 to start from.
    kernel_row: FloatArray,  # As for `deflect`.
    order: FloatArray,  # Factor of the mass now.
    history: FloatArray,  # What earlier masses contribute.
    fluid: ScaledFluid,
    dx: float,
    load: float,
    active: BoolArray,  # Nodes with a full film, changed to the solution.
    groups: Groups,  # As for `update_groups`.
    held: float,  # Compliance as for `tridiagonals`, over that of a node to its own pressure.
    tolerance: float,  # Of the last change of a pressure over the largest or p_h, and of load.
    linear_tolerance: float,  # As `tolerance` for `solve_linear`.
    max_iterations: int,
    space: Space,  # As for `solve_linear`.
) -> tuple[float, float]:
    """Pressure and film after one time step, in place. Theory (H21), (H22).

    Returns H_0 and what `tolerance` bounds: not a number if the iterations broke down.
    """
    n = pressure.size
    rho, d_rho = np.empty(n), np.empty(n)
    conductance, terms = np.empty(n - 1), np.empty((n - 1, 4))
    local, by_film = np.empty((n, 3)), np.empty((n, 3))
    lack, change = np.zeros(n + 1), np.zeros(n + 1)
    bend, kept, back = np.empty(n), np.zeros(n), np.zeros(n)
    band = np.empty((n + BAND, 2 * BAND + 1))
    size = groups.bends.shape[0] + 1
    coarse, rows = np.empty((size, size)), np.empty(size, dtype=np.int64)
    error = np.inf
    iteration = linear = 0
    while iteration < max_iterations and not error < tolerance:
        iteration += 1
        face_terms(pressure, film, fluid, dx, rho, d_rho, conductance, terms)
        residual(pressure, film, rho, conductance, order, history, active, lack[:n])
        lack[n] = load - dx * (pressure.sum() - 0.5 * pressure[0])
        compliance = held * kernel_row[n - 1]
        tridiagonals(film, rho, d_rho, terms, order, active, compliance, local, by_film)
        if iteration == 1 or linear > REFRESH:
            update_groups(kernel_row, active, groups)
            factor_band(local, by_film, kernel_row, active, band)
            coarse = factor_dense(coarse_matrix(local, by_film, groups.across, active, dx), rows)
        linear = solve_linear(
            lack, kernel_row, coarse, rows, groups.bends, local, by_film, band, active, dx,
            linear_tolerance, space, change, bend,
        )  # fmt: skip
        if not np.isfinite(change).all():
            return approach, np.nan
        # asperities may carry many times p_h
        peak = max(1.0, pressure.max())
        length = min(1.0, LARGEST_STEP * peak / np.abs(change[:n]).max())
        error, any_kept = 0.0, False
        for i in range(1, n - 1):
            new = pressure[i] + length * change[i]
            kept[i] = max(0.0, -new)  # no pressure falls below zero
            if new < 0.0:
                new = 0.0
                active[i] = False
                any_kept = True
            error = max(error, abs(new - pressure[i]) / peak)
            pressure[i] = new
        error = max(error, abs(load - dx * (pressure.sum() - 0.5 * pressure[0])) / load)
        approach += length * change[n]
        if any_kept:
            deflect(kernel_row, kept, back)
        for i in range(n):
            film[i] += length * bend[i] + (back[i] if any_kept else 0.0)
    return approach, error


@kernel
def lower_by(heights: FloatArray, start: float, amplitude: float, gap: FloatArray) -> None:
    """Take the heights at `start`, `start` + 1, ... off the gap: a cubic through four points.

    `heights` is the periodic profile with its last point before it and, after it, as many more of
    its points as the gap has, and one.
    """
    period = heights.size - gap.size - 2
    whole = math.floor(start)
    f = start - whole
    a = -amplitude * f * (1.0 - f) * (2.0 - f) / 6.0
    b = amplitude * (1.0 + f) * (1.0 - f) * (2.0 - f) / 2.0
    c = amplitude * (1.0 + f) * f * (2.0 - f) / 2.0
    d = -amplitude * (1.0 + f) * f * (1.0 - f) / 6.0
    row = heights[int(whole) % period :]
    for i in range(gap.size):
        gap[i] -= (a * row[i] + b * row[i + 1]) + (c * row[i + 2] + d * row[i + 3])


@kernel
def carry(
    now: FloatArray, before: FloatArray, stride: int, order: FloatArray, history: FloatArray,
    second: bool,
) -> None:  # fmt: skip
    """Orders and histories of a step from the masses one and two steps ago. Theory (H21).

    The mass comes from `stride` nodes upstream; from beyond the grid, where the film is thick, it
    is extrapolated.
    """
    n = now.size
    order[:] = 1.0
    for i in range(n):
        if i < stride:
            history[i] = now[0] + (stride - i) * (now[0] - now[1])
        else:
            history[i] = max(now[i - stride], 0.0)
        if second and i >= 2 * stride:
            ahead = 2.0 * now[i - stride] - 0.5 * before[i - 2 * stride]
            if ahead > 1.5 * FILM_FALL * history[i]:
                order[i] = 1.5
                history[i] = ahead


@kernel
def masses(pressure: FloatArray, film: FloatArray, fluid: ScaledFluid, out: FloatArray) -> None:
    """Density ratio times film of every node into `out`."""
    for i in range(pressure.size):
        out[i] = density_ratio(pressure[i], fluid)[0] * film[i]


@kernel
def flow_power(
    pressure: FloatArray, now: FloatArray, order: FloatArray, history: FloatArray,
    fluid: ScaledFluid,
) -> float:  # fmt: skip
    """Power of the pressure flow in a time step: the mass it takes from every node, lifted.

    Theory (H33). Linear in the pressure, so that what the iteration leaves does not spoil it.
    """
    power = 0.0
    for i in range(1, pressure.size - 1):
        if pressure[i] > 0.0:
            power += flow_work(pressure[i], fluid) * (history[i] - order[i] * now[i])
    return power


@kernel
def measure(
    pressure: FloatArray, film: FloatArray, thinned: FloatArray, fluid: ScaledFluid, dx: float,
    contact_film: float, boundary_friction: float, record: FloatArray,
) -> None:  # fmt: skip
    """Friction and contact of one moment into `record`. Theory (H23), (H24)."""
    record[: Column.FLOW_POWER] = 0.0
    record[Column.LEAST_FILM] = np.inf
    for i in range(pressure.size):
        p = pressure[i]
        if p > 0.0:
            record[Column.LEAST_FILM] = min(record[Column.LEAST_FILM], film[i])
            if film[i] < contact_film:
                record[Column.ASPERITY_SHEAR] += boundary_friction * p * dx
                record[Column.CONTACT_SHARE] += 0.5 * dx
                record[Column.ASPERITY_LOAD] += p * dx
            else:
                record[Column.FLUID_SHEAR] += mean_shear(p, film[i], thinned[i], fluid) * dx


@kernel
def march(
    pressure: FloatArray,  # At the nodes, as the next arrays but the profiles.
    film: FloatArray,
    now: FloatArray,  # Mass one step ago.
    before: FloatArray,  # Two steps ago.
    active: BoolArray,  # Nodes with a full film.
    approach: float,  # H_0.
    smooth: FloatArray,  # Pressure of the smooth contact; what exceeds it moves with the oil.
    base: FloatArray,  # Smooth gap, with the deflection by the pressure outside the grid.
    kernel_row: FloatArray,  # As for `deflect`.
    groups: Groups,  # As for `update_groups`.
    heights1: FloatArray,  # Profiles with the spacing of the nodes, as for `lower_by`.
    heights2: FloatArray,
    shift1: float,  # Nodes by which each surface moves in a step, `stride` times u_k/u_r.
    shift2: float,
    stride: int,  # Nodes by which the entrained mass moves in a step.
    center: int,  # Node at X = 0.
    first: int,  # Steps done before, negative before any roughness.
    growth: int,  # Steps in which it grows from zero.
    fluid: ScaledFluid,  # With `stride` times its conductance.
    thinned: FloatArray,  # As for `mean_shear`.
    dx: float,
    load: float,  # On the grid.
    contact_film: float,  # Film below which surfaces touch.
    boundary_friction: float,  # Friction there over the pressure.
    tolerance: float,  # As for `solve_step`.
    linear_tolerance: float,
    max_iterations: int,
    records: FloatArray,  # Shape (steps, 9), see `Column`.
) -> float:
    """Time steps, as many as `records` has rows; state arrays change in place. Theory (H21), (H25).

    Returns H_0.
    """
    n = pressure.size
    gap, bent = np.empty(n), np.empty(n)
    order, history = np.empty(n), np.empty(n)
    tried, space = np.empty(n), space_for(n)
    for t in range(records.shape[0]):
        step = first + t + 1
        amplitude = min(1.0, max(0.0, step / growth))
        gap[:] = base
        lower_by(heights1, -step * shift1, amplitude, gap)
        lower_by(heights2, -step * shift2, amplitude, gap)
        for i in range(n - 2, stride, -1):  # what the roughness adds moves with the oil
            pressure[i] = max(0.0, smooth[i] + pressure[i - stride] - smooth[i - stride])
            active[i] = active[i - stride]
            if not active[i]:
                pressure[i] = 0.0
        active[1 : stride + 1] = True
        tried[:] = pressure
        for attempt in range(2):
            carry(now, before, stride, order, history, attempt == 0)
            deflect(kernel_row, pressure, bent)
            for i in range(n):
                film[i] = gap[i] + approach + bent[i]
            tries = max_iterations * (1 + attempt)
            result = solve_step(
                pressure, film, approach, kernel_row, order, history, fluid, dx, load,
                active, groups, HELD[attempt], tolerance, linear_tolerance, tries, space,
            )  # fmt: skip
            if result[1] < tolerance or attempt == 1:
                break
            pressure[:] = tried  # again with short steps and first order
            for i in range(1, n - 1):
                active[i] = pressure[i] > 0.0
        if np.isfinite(result[1]):
            approach = result[0]
        else:  # counted as unsolved; what the roughness adds has moved with the oil
            pressure[:] = tried
            deflect(kernel_row, pressure, bent)
            film[:] = gap + approach + bent
        before[:] = now
        masses(pressure, film, fluid, now)
        measure(pressure, film, thinned, fluid, dx, contact_film, boundary_friction, records[t])
        records[t, Column.FLOW_POWER] = flow_power(pressure, now, order, history, fluid) / stride
        records[t, Column.ERROR] = result[1]
        records[t, Column.HIGHEST_PRESSURE] = pressure.max()
        records[t, Column.CENTRAL_FILM] = film[center]
    return approach
