"""Flow of a compressible mixture through the pockets of a mesh, periodic in time.

Pressures are kept as q = p/p_a - 1. Symbols follow the theory manual, page on pocketing.
"""

from __future__ import annotations

import math

import numpy as np

from epicyclic.kernels.compiling import kernel
from epicyclic.kernels.pocket_stage import (
    Fields,
    Flags,
    Floats,
    Fluid,
    Fresh,
    Numbers,
    Shape,
    kinetic_shares,
    mixture,
    number,
    solve_stage,
)

SDIRK = 1 - math.sqrt(0.5)
"""Coefficient of the two-stage, second-order, L-stable Runge-Kutta method. Alexander (1977). [1]"""
EASE = 0.125  # How long an opening beside a new pocket has next to no inertia. [periods]
NEW_INERTIA = 0.1  # Inertia in that time, as that of a step of ten periods over that of a step.
SMALLEST = 4**6
PARTS = ((4, 4), (16, SMALLEST))
"""Into how many a time step is cut at first and at most where it has no solution otherwise."""
EULER_MOST = 4000  # Newton iterations for one time step that is cut, at most.
FEWEST = 4  # Periods of which a mean is a result.


@kernel
def _excess(q: Floats, volume: Floats, live: Flags, xi: float, excess: Floats) -> None:
    """V (rho/rho_m - 1) of every live cell, zero elsewhere."""
    for i in range(q.shape[0]):
        for j in range(q.shape[1]):
            excess[i, j] = 0.0
            if live[i, j]:
                swelling = mixture(q[i, j], xi)[4]
                excess[i, j] = -volume[i, j] * swelling / (1 + swelling)


@kernel
def _euler_steps(
    start: Shape,
    end: Shape,
    fields: Fields,
    numbers: Numbers,
    live: Flags,
    fluid: Fluid,
    fresh: Fresh,
    step: float,
    parts: tuple[int, int],
    totals: Floats,
) -> int:
    """One time step by implicit Euler steps, the geometry linear in between.

    The way out where the larger step has no solution that Newton's method finds. `parts` says into
    how many equal ones the step is cut at first and at most: what has no solution is cut into four.

    Returns the Newton iterations; negative if no solution was found.
    """
    kept = (fields[0].copy(), fields[1].copy(), fields[2].copy())
    excess = np.zeros_like(fields[0])
    rates = np.zeros(3)
    work = np.zeros(3)
    largest, smallest = SMALLEST // parts[0], SMALLEST // parts[1]
    iterations, done, part = 0, 0, largest
    while done < SMALLEST:
        left, right = done / SMALLEST, (done + part) / SMALLEST
        share = right - left
        now = (
            start[0] + right * (end[0] - start[0]),
            (end[0] - start[0]) * share,
            start[2] + right * (end[2] - start[2]),
            start[3] + right * (end[3] - start[3]),
            start[4] + right * (end[4] - start[4]),
            start[5] + right * (end[5] - start[5]),
        )
        _excess(kept[0], start[0] + left * (end[0] - start[0]), live, fluid[0], excess)
        shares = kinetic_shares(kept[1], now, numbers[0], fluid, fresh)
        before = (excess, kept[1], kept[2])
        found = solve_stage(now, before, fields, numbers, fluid, fresh, shares, step * share, rates)
        iterations += abs(found)
        if found > 0:
            work += step * part / SMALLEST * rates
            kept[0][:], kept[1][:], kept[2][:] = fields
            done += part
            while part < largest and done % (4 * part) == 0:
                part *= 4
        else:
            fields[0][:], fields[1][:], fields[2][:] = kept
            part //= 4
        if part < smallest or iterations > EULER_MOST:
            return -iterations
    totals[:3] += work
    return iterations


@kernel
def _advance(
    start: Shape,
    middle: Shape,
    end: Shape,
    fields: Fields,
    numbers: Numbers,
    live: Flags,
    fluid: Fluid,
    fresh: Fresh,
    step: float,
    moves: tuple[Floats, Floats],
    totals: Floats,
) -> int:
    """One time step; adds its works and its outflow to `totals`. Theory (Q17).

    `moves` has, of the same step one period before, how far pressures and axial velocities moved in
    the first stage and in both; they lead to the first guess, and are replaced.

    Returns the Newton iterations; negative if no solution was found.
    """
    q, axial, cross = fields
    q0, axial0, cross0 = q.copy(), axial.copy(), cross.copy()
    excess0 = np.zeros_like(q)
    _excess(q, start[0], live, fluid[0], excess0)
    rates = np.zeros((2, 3))
    shares = kinetic_shares(axial, start, numbers[0], fluid, fresh)
    tau = SDIRK * step
    q += moves[0][0]
    axial += moves[1][0]
    done = solve_stage(
        middle, (excess0, axial0, cross0), fields, numbers, fluid, fresh, shares, tau, rates[0]
    )
    if done > 0:
        more = (1 - SDIRK) / SDIRK
        ahead_q, ahead_axial = moves[0][1] - moves[0][0], moves[1][1] - moves[1][0]
        moves[0][0], moves[1][0] = q - q0, axial - axial0
        excess1 = np.zeros_like(q)
        _excess(q, middle[0], live, fluid[0], excess1)
        before = (
            excess0 + more * (excess1 - excess0),
            axial0 + more * (axial - axial0),
            cross0 + more * (cross - cross0),
        )
        q += ahead_q
        axial += ahead_axial
        second = solve_stage(end, before, fields, numbers, fluid, fresh, shares, tau, rates[1])
        if second > 0:
            moves[0][1], moves[1][1] = q - q0, axial - axial0
            totals[:3] += step * ((1 - SDIRK) * rates[0] + SDIRK * rates[1])
            return done + second
    moves[0][:], moves[1][:] = 0.0, 0.0
    used = 0
    for parts in PARTS:
        q[:], axial[:], cross[:] = q0, axial0, cross0
        done = _euler_steps(start, end, fields, numbers, live, fluid, fresh, step, parts, totals)
        used += abs(done)
        if done > 0:
            return used
    return -used


@kernel
def periodic_flow(
    # As for `solve_stage`, with a first axis of 2 n + 1 times: the start of the period, then for
    # each of n steps the inner point of the time stepping and the end of the step.
    shape: Shape,
    live: Flags,  # Which cells are pockets during each step.
    fluid: Fluid,  # As for `solve_stage`.
    step: float,  # [s]
    shift: int,  # Pockets by which the numbering moves on from one period to the next.
    # Most periods; the change of the power from one period to the next, relative, below which the
    # flow is periodic; and most Newton iterations. Fields may change by ten times that of their
    # largest value.
    limits: tuple[int, float, int],
    # Receives q (n, pockets, slices), velocities through axial faces (n, pockets, slices + 1) and
    # gaps (n, pockets + 1, slices) [m/s] of the last period.
    history: Fields,
    works: Floats,  # Receives the boundary work over p_a of each step of the last period. [m^3]
    # Receives for the last period: boundary work over p_a [m^3]; work lost in the flow over rho_m
    # [m^5/s^2], that left in pockets at their end included; volumes at ambient density that come
    # with new pockets, leave through the openings and go with the ended ones, and what is stored
    # [m^3]; change of the power and of the fields [1]. The last one is raised by the iterations of
    # all periods.
    figures: Floats,
) -> int:
    """Flow through the pockets, mesh period after mesh period until it repeats. Theory (Q18).

    Periods; negative if the flow did not repeat, and both works are then means of the last half of
    these; zero if a step has no solution, or the iterations are over before there are `FEWEST`
    periods.
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
    fresh = (np.zeros((pockets + 1, slices)), np.zeros((pockets, slices + 1)), NEW_INERTIA / steps)
    moves_q = np.zeros((steps, 2, pockets, slices))
    moves_axial = np.zeros((steps, 2, pockets, slices + 1))
    last_work = math.nan
    courses = np.zeros((limits[0], 2))
    for period in range(1, limits[0] + 1):
        totals = np.zeros(6)
        stored = _stored(q, shape[0][0], alive, xi, excess)
        for n in range(steps):
            volume0 = shape[0][2 * n]
            mark_fresh(live[n], alive, fresh, 1 / steps)
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
            count, width = number(alive, cell_at, face_at)
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
                (moves_q[n], moves_axial[n]),
                totals,
            )
            figures[8] += abs(done)
            if done < 0:
                return 0
            if figures[8] > limits[2]:
                return -_mean_works(courses[: period - 1], figures)
            works[n] = totals[0] - work_before
            history[0][n] = q
            history[1][n] = axial
            history[2][n] = cross
        stored_now = _stored(q, shape[0][2 * steps], alive, xi, excess)
        for rows in (q, axial, cross, fresh[0], fresh[1]):
            move_on(rows, shift, 0.0)
        move_on(alive, shift, False)
        field_change = np.abs(q - before).max() / max(np.abs(q).max(), 1e-300)
        before[:] = q
        work = totals[0]
        change = abs(work - last_work) / max(abs(work), 1e-300)
        last_work = work
        courses[period - 1] = totals[:2]
        figures[:5] = totals[0], totals[1], totals[3], totals[2], totals[4]
        figures[5] = stored_now - stored
        figures[6], figures[7] = change, field_change
        if change <= limits[1] and field_change <= 10 * limits[1]:
            return period
    return -_mean_works(courses, figures)


@kernel
def _mean_works(courses: Floats, figures: Floats) -> int:
    """Means of the works of the last half of the periods into `figures`; how many there are.

    Zero if they are too few to tell.
    """
    count = len(courses)
    if count < FEWEST:
        return 0
    for kind in range(2):
        figures[kind] = courses[count // 2 :, kind].mean()
    return count


@kernel
def mark_fresh(live: Flags, alive: Flags, fresh: Fresh, step: float) -> None:
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
def _at(shape: Shape, n: int) -> Shape:
    """Copies, because arrays that are read-only are of another type to the compiler."""
    return (
        shape[0][n].copy(),
        shape[1][max(n - 1, 0)].copy(),
        shape[2][n].copy(),
        shape[3][n].copy(),
        shape[4][n].copy(),
        shape[5][n].copy(),
    )


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
def _leave(q: float, volume: float, fluid: Fluid, totals: Floats) -> float:
    """Mass over rho_m of a cell that ends; its work above ambient goes to `totals`. [m^3]

    Theory (Q20).
    """
    _, rho, _, enthalpy, _ = mixture(q, fluid[0])
    totals[1] += volume * fluid[1] * (rho * enthalpy - q)
    return volume * rho


@kernel
def move_on(rows: Floats | Flags, shift: int, last: float) -> None:
    """Give every pocket the number of the one that it has replaced one period later."""
    for i in range(rows.shape[0]):
        if i + shift < rows.shape[0]:
            rows[i] = rows[i + shift]
        else:
            rows[i] = last
