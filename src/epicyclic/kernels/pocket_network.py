"""Flow of an incompressible mixture through the pockets of a mesh, periodic in time.

Density and speed are the units: pressures are above ambient and over rho_m Omega^2 [m^2],
velocities over Omega [m], times are angles of gear 1 [rad]. Openings are numbered as in
`pocket_stage`; arrays of cells have a margin of one, which stands for the surroundings, as all
cells do that are no pockets. Symbols follow the theory manual, page on pocketing.
"""

from __future__ import annotations

import math

import numpy as np

from epicyclic.kernels.compiling import kernel
from epicyclic.kernels.pocket_flow import NEW_INERTIA, mark_fresh, move_on
from epicyclic.kernels.pocket_stage import Flags, Floats, Fresh, Indices, downstream_share

Openings = tuple[Floats, Floats, Floats, Floats]
"""Areas of axial faces and of gaps [m^2], distances from the cells before and behind them [m]."""
Rules = tuple[float, float, bool]
"""Time step [rad]; pressure of a void; whether kinetic energy goes on inside a pocket."""
Pair = tuple[Floats, Floats]  # Values at axial faces and at gaps, unless said otherwise.
State = tuple[Floats, Floats, Floats, Floats]
"""Pressure and full share of the cells, velocities through axial faces and gaps."""

Work = tuple[Floats, Floats, Indices, tuple[Pair, Pair], Floats]
"""Memory of `_advance`: matrix, right side, rows of the cells, laws of the openings, `_carry`."""

SHOCK_VOID = 0.1  # Void in a cell from which on its kinetic energy is taken from upstream. [1]
ITERATIONS_MOST = 30
"""Iterations of one time step, which does not count as solved if they are too few."""
TOLERANCE = 1e-5  # Last change of pressures and velocities over the largest of the field. [1]
LOOSE = 0.1
"""The same over the change of the work in the period before, while that is large, but not in the
last period where there are voids, whose shares hold the mass. [1]"""


@kernel
def _number(live: Flags, full: Floats, row: Indices) -> tuple[int, int]:
    """Rows of the cells without a void, slice by slice; their count, and how far neighbours differ.

    Other cells get -1: their pressure is known.
    """
    pockets, slices = live.shape
    count, width = 0, 1
    row[0], row[-1] = -1, -1
    for j in range(slices):
        for i in range(pockets):
            row[i + 1, j + 1] = -1
            if live[i, j] and full[i + 1, j + 1] >= 1.0:
                row[i + 1, j + 1] = count
                if row[i + 1, j] >= 0:
                    width = max(width, count - row[i + 1, j])
                count += 1
    return count, width


@kernel
def _solve_symmetric(matrix: Floats, right: Floats, width: int) -> None:
    """Gauss elimination of a positive definite banded matrix; the solution replaces `right`.

    `matrix[r, d]` is the element in row r and column r + d.
    """
    n = right.size
    for k in range(n):
        row = matrix[k]
        for c in range(1, min(width, n - 1 - k) + 1):
            if row[c] != 0.0:
                factor = row[c] / row[0]
                below = matrix[k + c]
                for d in range(width + 1 - c):
                    below[d] -= factor * row[c + d]
                right[k + c] -= factor * right[k]
    for k in range(n - 1, -1, -1):
        total = right[k]
        for c in range(1, min(width, n - 1 - k) + 1):
            total -= matrix[k, c] * right[k + c]
        right[k] = total / matrix[k, 0]


@kernel
def _linear_law(
    law: tuple[float, float, float], inertia: float, before: float, last: float, drop: float
) -> tuple[float, float]:
    """Velocity in an opening without a drop of pressure, and its derivative by the drop.

    Both are zero in an opening that leads nowhere, which has no inertia.

    Newton's method about the velocity of the last iteration, for which the law is convex. Where
    that is too small for the drop, or the neighbours have more influence than the inertia, the
    velocity is held back, or it would overshoot. Theory (Q26).
    """
    if inertia == 0.0:
        return 0.0, 0.0
    loss, head, influence = law
    drive = inertia * before + drop - head
    stiffness = max(
        inertia + loss * abs(last), math.sqrt(inertia * inertia + 2 * loss * abs(drive))
    )
    stiffness += influence * influence / (2 * stiffness)
    lacking = inertia * (last - before) + loss * abs(last) * last / 2 + head
    return last - lacking / stiffness, 1 / stiffness


@kernel
def _carry(axial: Floats, share: Floats, live: Flags, carried: Floats) -> None:
    """What the cells of a pocket have to do with their faces. Theory (Q24), (Q26).

    A column of `carried` for each, and one of zeros at either end: the share of the faces in its
    kinetic energy; the head that it gives to the face behind it, and the change of that with the
    velocity before it; the same the other way round.
    """
    carried[:] = 0.0
    for j in range(live.size):
        if live[j]:
            before, behind = axial[j], axial[j + 1]
            down = 1 - share[j] if before > 0.0 else share[j]
            up = 1 - share[j] if behind < 0.0 else share[j]
            carried[0, j + 1] = share[j]
            carried[1, j + 1], carried[2, j + 1] = down * before * before / 2, down * abs(before)
            carried[3, j + 1], carried[4, j + 1] = up * behind * behind / 2, up * abs(behind)


@kernel
def _face_law(
    carried: Floats, live: Flags, i: int, j: int, carries: bool
) -> tuple[float, float, float]:
    """What axial face j of pocket i has to do with its neighbours, from `carried` of `_carry`.

    Returns the part of its own velocity head that it takes, the head that is carried on from and to
    the neighbours, and the change of that with their velocities. Without all that, only faces to
    the surroundings take their velocity head.
    """
    if carries:
        loss = 1 - carried[0, j] - carried[0, j + 1]
        return loss, carried[3, j + 1] - carried[1, j], carried[2, j] + carried[4, j + 1]
    inside = j > 0 and j < live.shape[1] and live[i, j - 1] and live[i, j]
    return (0.0 if inside else 1.0), 0.0, 0.0


@kernel
def _inertias(
    live: Flags, openings: Openings, fresh: Fresh, turn: float, axial: Floats, gap: Floats
) -> None:
    """Length over time step of every opening beside a pocket, zero of all others. Theory (Q20)."""
    pockets, slices = live.shape
    for i in range(pockets + 1):
        for j in range(slices):
            length = openings[3][0, i, j] if i > 0 and live[i - 1, j] else 0.0
            length += openings[3][1, i, j] if i < pockets and live[i, j] else 0.0
            length = length if openings[1][i, j] > 0.0 else 0.0
            gap[i, j] = length / turn * (fresh[2] if fresh[0][i, j] > 0.0 else 1.0)
    for i in range(pockets):
        for j in range(slices + 1):
            length = openings[2][0, i, j] if j > 0 and live[i, j - 1] else 0.0
            length += openings[2][1, i, j] if j < slices and live[i, j] else 0.0
            axial[i, j] = length / turn * (fresh[2] if fresh[1][i, j] > 0.0 else 1.0)


@kernel
def _find_laws(
    live: Flags, carries: bool, share: Floats, inertias: Pair, start: State, state: State,
    laws: tuple[Pair, Pair], carried: Floats,
) -> None:  # fmt: skip
    """Velocities without a drop in all openings, and their slopes, to `laws`."""
    q = state[0]
    for inertia, before, last, (rest, slope), gap in (
        (inertias[0], start[2], state[2], laws[0], 0), (inertias[1], start[3], state[3], laws[1], 1)
    ):  # fmt: skip
        for i in range(last.shape[0]):
            if not gap:
                _carry(last[i], share[i], live[i], carried)
            for j in range(last.shape[1]):
                law = (1.0, 0.0, 0.0) if gap else _face_law(carried, live, i, j, carries)
                drop = q[i + 1 - gap, j + gap] - q[i + 1, j + 1]
                found = _linear_law(law, inertia[i, j], before[i, j], last[i, j], drop)
                rest[i, j], slope[i, j] = found


@kernel
def _assemble(
    volume: Pair, openings: Openings, turn: float, held: Floats, state: State,
    laws: tuple[Pair, Pair], row: Indices, width: int, matrix: Floats, right: Floats,
) -> None:  # fmt: skip
    """Balances of volume of the cells with the flows through gaps and faces of these laws."""
    q, full, axial, cross = state
    pockets, slices = row.shape[0] - 2, row.shape[1] - 2
    for i in range(pockets):
        for j in range(slices):
            k = row[i + 1, j + 1]
            if k >= 0:
                matrix[k, : width + 1] = 0.0
                right[k] = (held[i + 1, j + 1] * volume[0][i, j] - volume[1][i, j]) / turn
    for area, u, (rest, slope), gap in (
        (openings[1], cross, laws[1], 1), (openings[0], axial, laws[0], 0)
    ):  # fmt: skip
        for i in range(pockets):
            for j in range(slices):
                k, own = row[i + 1, j + 1], full[i + 1, j + 1]
                if k < 0:
                    continue
                a, b = i + 1 - gap, j + gap  # the cell before
                wet = area[i, j] * (full[a, b] if u[i, j] > 0.0 else own)
                matrix[k, 0] += wet * slope[i, j]
                right[k] += wet * rest[i, j]
                if row[a, b] < 0:
                    right[k] += wet * slope[i, j] * q[a, b]
                n, m = i + gap, j + 1 - gap
                a, b = n + 1, m + 1  # the cell behind
                wet = area[n, m] * (own if u[n, m] > 0.0 else full[a, b])
                matrix[k, 0] += wet * slope[n, m]
                right[k] -= wet * rest[n, m]
                if row[a, b] < 0:
                    right[k] += wet * slope[n, m] * q[a, b]
                else:
                    matrix[k, row[a, b] - k] -= wet * slope[n, m]


@kernel
def _update_velocities(laws: tuple[Pair, Pair], state: State) -> tuple[float, float]:
    """Velocities in all openings after the pressures; their largest change, and the largest."""
    q, _, axial, cross = state
    moved, largest = 0.0, 0.0
    for velocity, (rest, slope), gap in ((axial, laws[0], 0), (cross, laws[1], 1)):
        for i in range(velocity.shape[0]):
            for j in range(velocity.shape[1]):
                u = rest[i, j] + slope[i, j] * (q[i + 1 - gap, j + gap] - q[i + 1, j + 1])
                moved, largest = max(moved, abs(u - velocity[i, j])), max(largest, abs(u))
                velocity[i, j] = u
    return moved, largest


@kernel
def _update_voids(
    live: Flags, volume: tuple[Floats, Floats], openings: Openings, rules: Rules, start: State,
    state: State, row: Indices,
) -> float:  # fmt: skip
    """Which cells hold a void, and how much of them is full; the largest change. Theory (Q25)."""
    q, full, axial, cross = state
    turn, lowest, _ = rules
    ends, gaps, held, volume0, volume1 = openings[0], openings[1], start[1], volume[0], volume[1]
    changed = 0.0
    for i in range(live.shape[0]):
        for j in range(live.shape[1]):
            known = row[i + 1, j + 1] < 0
            if not live[i, j] or (not known and q[i + 1, j + 1] >= lowest * (1 + TOLERANCE)):
                continue
            comes, leaves = 0.0, 0.0
            for u, share in (
                (axial[i, j] * ends[i, j], full[i + 1, j]),
                (-axial[i, j + 1] * ends[i, j + 1], full[i + 1, j + 2]),
                (cross[i, j] * gaps[i, j], full[i, j + 1]),
                (-cross[i + 1, j] * gaps[i + 1, j], full[i + 2, j + 1]),
            ):
                comes += max(u, 0.0) * share
                leaves += max(-u, 0.0)
            kept = held[i + 1, j + 1] * volume0[i, j] + turn * comes
            share = min(1.0, kept / (volume1[i, j] + turn * leaves))
            if not known:
                share = min(share, 1 - TOLERANCE)
            if known == (share >= 1.0):
                changed = 1.0
            changed = max(changed, abs(share - full[i + 1, j + 1]))
            full[i + 1, j + 1] = share
            q[i + 1, j + 1] = lowest
    return changed


@kernel
def _advance(
    live: Flags, volume: Pair, openings: Openings, rules: Rules, share: Floats, inertias: Pair,
    start: State, state: State, work: Work, tolerance: float,
) -> int:  # fmt: skip
    """One implicit Euler step; iterations, negative if they were too few. Theory (Q25), (Q26)."""
    q, full = state[0], state[1]
    matrix, right, row, laws, carried = work
    count, width = _number(live, full, row)
    for iteration in range(1, ITERATIONS_MOST + 1):
        _find_laws(live, rules[2], share, inertias, start, state, laws, carried)
        _assemble(volume, openings, rules[0], start[1], state, laws, row, width, matrix, right)
        _solve_symmetric(matrix[:count], right[:count], width)
        moved_q, largest_q = 0.0, 0.0
        for i in range(1, q.shape[0] - 1):
            for j in range(1, q.shape[1] - 1):
                k = row[i, j]
                if k >= 0:
                    moved_q = max(moved_q, abs(right[k] - q[i, j]))
                    largest_q = max(largest_q, abs(right[k]))
                    q[i, j] = right[k]
        moved, largest = _update_velocities(laws, state)
        changed = _update_voids(live, volume, openings, rules, start, state, row)
        if changed >= 1.0:
            count, width = _number(live, full, row)
        elif (
            changed <= tolerance
            and moved <= tolerance * largest
            and moved_q <= tolerance * largest_q
        ):
            return iteration
    return -ITERATIONS_MOST


@kernel
def _shares(
    axial: Floats, area: Floats, volume: Floats, live: Flags, new: Floats, full: Floats,
    share: Floats,
) -> None:  # fmt: skip
    """Share of faces downstream in the kinetic energy of each cell. Theory (Q24).

    No pressure keeps jets apart that meet in a void: there it is taken from upstream.
    """
    for i in range(live.shape[0]):
        spread = (area[i, 1:] + area[i, :-1]) / volume[i]
        for j in range(live.shape[1]):
            share[i, j] = 0.0
            if live[i, j] and new[i, j] <= 0.0 and new[i, j + 1] <= 0.0:
                share[i, j] = downstream_share(axial[i], spread, live[i], j)
                share[i, j] *= max(0.0, 1 - (1 - full[i + 1, j + 1]) / SHOCK_VOID)


@kernel
def _drops(
    axial: Floats, share: Floats, live: Flags, inertias: Floats, carries: bool, drops: Floats,
    carried: Floats,
) -> None:  # fmt: skip
    """Drop of pressure that each axial face takes beside its inertia. Theory (Q26)."""
    drops[:] = 0.0
    for i in range(axial.shape[0]):
        _carry(axial[i], share[i], live[i], carried)
        for j in range(axial.shape[1]):
            if inertias[i, j] > 0.0:
                loss, head, _ = _face_law(carried, live, i, j, carries)
                drops[i, j] = loss * abs(axial[i, j]) * axial[i, j] / 2 + head


@kernel
def _begin(live: Flags, alive: Flags, state: State) -> None:
    """Put new cells, and those that have ended, to ambient state; stop openings without a cell."""
    q, full, axial, cross = state
    for i in range(live.shape[0]):
        for j in range(live.shape[1]):
            if live[i, j] != alive[i, j]:
                q[i + 1, j + 1], full[i + 1, j + 1] = 0.0, 1.0
                alive[i, j] = live[i, j]
    for i in range(live.shape[0]):
        for j in range(live.shape[1] + 1):
            before, behind = j > 0 and live[i, j - 1], j < live.shape[1] and live[i, j]
            if not (before or behind):
                axial[i, j] = 0.0
    for i in range(live.shape[0] + 1):
        for j in range(live.shape[1]):
            before, behind = i > 0 and live[i - 1, j], i < live.shape[0] and live[i, j]
            if not (before or behind):
                cross[i, j] = 0.0


@kernel
def _span(live: Flags) -> tuple[int, int]:
    """The first pocket that is one, and the one after the last."""
    first, last = 0, live.shape[0]
    while last > first + 1 and not live[last - 1].any():
        last -= 1
    while first < last - 1 and not live[first].any():
        first += 1
    return first, last


@kernel
def periodic_network(
    # At the start of the period and at the end of each of its n steps, shape (n + 1, pockets,
    # slices). [m^3]
    volume: Floats,
    live: Flags,  # Which cells are pockets during each step, shape (n, pockets, slices).
    openings: Openings,  # With a first axis of n steps.
    rules: Rules,
    eased: bool,  # Whether openings beside new pockets have next to no inertia at first.
    shift: int,  # Pockets by which the numbering moves on from one period to the next.
    # Most periods, and the change of the boundary work, relative, below which the flow is periodic;
    # pressures may change by ten times that of their largest value, full shares by that.
    limits: tuple[int, float],
    # Receives for each step of the last period pressures and full shares (n, pockets + 2,
    # slices + 2), velocities in axial faces (n, pockets, slices + 1) and gaps (n, pockets + 1,
    # slices), the inertias of both, and the drops that axial faces take.
    history: tuple[Floats, ...],
    # Receives the change of the work in the last period and the iterations in all, shape (2,).
    figures: Floats,
) -> int:
    """Flow through the pockets, mesh period after mesh period until it repeats. Theory (Q18).

    Returns the periods; negative if the flow did not repeat.
    """
    steps, pockets, slices = live.shape
    q, full = np.zeros((pockets + 2, slices + 2)), np.ones((pockets + 2, slices + 2))
    axial, cross = np.zeros((pockets, slices + 1)), np.zeros((pockets + 1, slices))
    state = (q, full, axial, cross)
    alive = np.zeros((pockets, slices), np.bool_)
    fresh = (np.zeros((pockets + 1, slices)), np.zeros((pockets, slices + 1)), NEW_INERTIA / steps)
    inertias = (np.zeros((pockets, slices + 1)), np.zeros((pockets + 1, slices)))
    share = np.zeros((pockets, slices))
    row = np.full((pockets + 2, slices + 2), -1)
    laws = (
        (np.zeros_like(axial), np.zeros_like(axial)), (np.zeros_like(cross), np.zeros_like(cross))
    )  # fmt: skip
    matrix, right = np.zeros((pockets * slices, pockets + 1)), np.zeros(pockets * slices)
    carried = np.zeros((5, slices + 2))
    last_work = 0.0
    figures[0] = 1.0
    for period in range(1, limits[0] + 1):
        done, moved, largest, filled, solved = 0.0, 0.0, 0.0, 0.0, True
        tolerance = max(TOLERANCE, LOOSE * figures[0])
        for n in range(steps):
            now = (openings[0][n], openings[1][n], openings[2][n], openings[3][n])
            if eased:
                mark_fresh(live[n], alive, fresh, 1 / steps)
            _begin(live[n], alive, state)
            _inertias(live[n], now, fresh, rules[0], *inertias)
            if rules[2]:
                _shares(axial, now[0], volume[n], live[n], fresh[1], full, share)
            start = (q.copy(), full.copy(), axial.copy(), cross.copy())
            if period > 1:  # the last period is the first guess
                q[:], full[:] = history[0][n], history[1][n]
                axial[:], cross[:] = history[2][n], history[3][n]
            first, last = _span(live[n])
            part, cells = slice(first, last), slice(first, last + 2)
            gaps = slice(first, last + 1)
            here = ((laws[0][0][part], laws[0][1][part]), (laws[1][0][gaps], laws[1][1][gaps]))
            iterations = _advance(
                live[n, part],
                (volume[n, part], volume[n + 1, part]),
                (now[0][part], now[1][gaps], now[2][:, part], now[3][:, gaps]),
                rules,
                share[part],
                (inertias[0][part], inertias[1][gaps]),
                (start[0][cells], start[1][cells], start[2][part], start[3][gaps]),
                (q[cells], full[cells], axial[part], cross[gaps]),
                (matrix, right, row[cells], here, carried),
                tolerance,
            )
            figures[1] += abs(iterations)
            solved = solved and iterations > 0
            for i in range(pockets):
                for j in range(slices):
                    pressure = q[i + 1, j + 1]
                    done -= pressure * (volume[n + 1, i, j] - volume[n, i, j])
                    moved = max(moved, abs(pressure - history[0][n, i + 1, j + 1]))
                    largest = max(largest, abs(pressure))
                    filled = max(filled, abs(full[i + 1, j + 1] - history[1][n, i + 1, j + 1]))
            history[0][n], history[1][n], history[2][n], history[3][n] = q, full, axial, cross
            history[4][n], history[5][n] = inertias
            _drops(axial, share, live[n], inertias[0], rules[2], history[6][n], carried)
        for rows in (q[1:-1], axial, cross, fresh[0], fresh[1]):
            move_on(rows, shift, 0.0)
        move_on(full[1:-1], shift, 1.0)
        move_on(alive, shift, False)
        figures[0] = abs(done - last_work) / max(abs(done), 1e-300)
        last_work = done
        repeats = solved and figures[0] <= limits[1] and moved <= 10 * limits[1] * largest
        holds = tolerance <= TOLERANCE and filled <= limits[1]
        if repeats and (holds or history[1].min() >= 1.0):
            return period
    return -limits[0]
