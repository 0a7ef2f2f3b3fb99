"""Load along the contact lines of elastic teeth at one mesh position.

Unilateral contact: every segment of every line carries F >= 0; the surfaces approach each other by
C F + delta_c(F) and have the separation s to close first. Where F > 0 both together equal the rigid
approach of the gears, the same everywhere; the forces sum to the force of the mesh (T. F. Conry and
A. Seireg, J. Eng. Ind. 95 (1973) 1115). C couples the segments of one line, which lie on one pair
of teeth; G couples the total forces of the lines, whose teeth stand on one rim. The local
deflection of a segment of length l under q = F/l is (C. Weber and K. Banaschek, 1953)

    delta_c = q [A - B ln(q)/2] .

C and G are positive (semi)definite and delta_c rises with q, so that the solution is unique: it is
the least of a convex energy. Newton's method on the set of loaded segments finds it in a few steps.
Should that set not settle, a second method goes on, which never increases the energy and so cannot
run in circles. Nothing is returned as a solution that does not satisfy the conditions above.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.kernels.compiling import kernel

LINEAR_SHARE = 1e-3
"""Share of the mean line load below which delta_c is a parabola: ln(q) has no value at 0. [1]"""
LEAST_SLOPE = 0.5
"""Slope of delta_c over B below which it is continued as a straight line: the formula would let
the teeth part again under a growing load. It is reached where b_h is about 0.6 d. [1]"""
QUICK_STEPS = 30  # Newton steps before the careful method takes over; usual are five.
UNREFINED = 0.1
"""Of the tolerance, what a start has to keep: what a step leaves is mostly far below it. [1]"""
ENOUGH_DESCENT = 0.1
"""A step is short enough when the slope of the energy has fallen to this part of its start. [1]"""
MOST_HALVINGS = 30
FARTHEST, SHARPEST = 4.0, 2500.0
"""Step over the distance of two solutions, and over its square, up to which their parabola is
followed: an error of either becomes 5000 times as large in its slope, at most. [1]"""

Teeth = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, float]
"""C, influence coefficients of both teeth [m/N]; G, deflection of each line under a unit total
force on each [m/N]; s, gap of the unloaded flanks along the common normal [m]; lengths of the
segments, zero where a line is not in contact [m]; A and B of delta_c [m^2/N]."""
Solutions = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]
"""Forces, and what `solve_points` has for each of them but the iterations, in its order."""


@kernel
def local_law(q: float, a: float, b: float, floor: float) -> tuple[float, float]:
    """delta_c of a segment [m] and its derivative in q [m^2/N]. Theory (E4).

    A parabola through zero below `floor` and a straight line beyond the load of `LEAST_SLOPE`, both
    with the slope of the law where they meet it.
    """
    log_top = 2.0 * (a / b - LEAST_SLOPE) - 1.0
    log_q = np.log(q) if q > 0.0 else -np.inf
    if q >= floor and log_q <= log_top:
        return q * (a - 0.5 * b * log_q), a - 0.5 * b * log_q - 0.5 * b
    top = np.exp(log_top)
    low = min(floor, top)
    if q < low:
        start = a - 0.5 * b * np.log(low) + 0.5 * b
        if q < 0.0:
            return q * start, start
        return q * (start - 0.5 * b * q / low), start - b * q / low
    slope = LEAST_SLOPE * b
    return top * (a - 0.5 * b * log_top) + slope * (q - top), slope


# Sums and products are written as loops: those of numpy take several times as long to compile.


@kernel
def line_totals(values: FloatArray) -> FloatArray:
    """Sum of the values of each line: four sums side by side, so that few wait for a last term."""
    totals, n = np.empty(values.shape[0]), values.shape[1]
    for line in range(values.shape[0]):
        one = two = three = four = 0.0
        for k in range(0, n - 3, 4):
            one, two = one + values[line, k], two + values[line, k + 1]
            three, four = three + values[line, k + 2], four + values[line, k + 3]
        for k in range(n - n % 4, n):
            one += values[line, k]
        totals[line] = (one + two) + (three + four)
    return totals


@kernel
def shared(force: float, weight: FloatArray) -> tuple[FloatArray, BoolArray]:
    """A force in proportion to weights, and where they are positive; nothing where they are not."""
    forces, loaded = np.empty(weight.shape), np.empty(weight.shape, np.bool_)
    for line in range(weight.shape[0]):
        for k in range(weight.shape[1]):
            loaded[line, k] = weight[line, k] > 0.0
            forces[line, k] = weight[line, k] if loaded[line, k] else 0.0
    whole = line_totals(forces).sum()
    each = force / whole if whole > 0.0 else 0.0
    for line in range(weight.shape[0]):
        for k in range(weight.shape[1]):
            forces[line, k] *= each
    return forces, loaded


@kernel
def product(values: FloatArray, others: FloatArray) -> float:
    """Sum of the products of all values."""
    found = 0.0
    for line in range(values.shape[0]):
        for k in range(values.shape[1]):
            found += values[line, k] * others[line, k]
    return found


@kernel
def after_step(start: FloatArray, share: float, step: FloatArray) -> FloatArray:
    """Values after a share of a step."""
    moved = np.empty(start.shape)
    for line in range(start.shape[0]):
        for k in range(start.shape[1]):
            moved[line, k] = start[line, k] + share * step[line, k]
    return moved


@kernel
def deflections(forces: FloatArray, teeth: Teeth, floor: float) -> tuple[FloatArray, FloatArray]:
    """s + C F + G F + delta_c of every segment [m], and the slope of delta_c over F [m/N].

    Influence coefficients are symmetric, so that C F is a sum of rows, which become vector
    instructions.
    """
    compliance, coupling, separation, length, local_a, local_b = teeth
    lines, segments = length.shape
    closed = np.zeros((lines, segments))
    slope = np.zeros((lines, segments))
    totals = line_totals(forces)
    for line in range(lines):
        if length[line, 0] <= 0.0:
            continue
        rim = 0.0
        for other in range(lines):
            rim += coupling[line, other] * totals[other]
        for k in range(segments):
            closed[line, k] = separation[line, k] + rim
        for j in range(0, segments - 3, 4):  # four rows at once, which takes half the time
            f1, f2, f3, f4 = (
                forces[line, j], forces[line, j + 1], forces[line, j + 2], forces[line, j + 3]
            )  # fmt: skip
            for k in range(segments):
                closed[line, k] += (
                    f1 * compliance[line, j, k] + f2 * compliance[line, j + 1, k]
                    + f3 * compliance[line, j + 2, k] + f4 * compliance[line, j + 3, k]
                )  # fmt: skip
        for j in range(segments - segments % 4, segments):
            for k in range(segments):
                closed[line, k] += forces[line, j] * compliance[line, j, k]
        for k in range(segments):
            q = forces[line, k] / length[line, k]
            law, law_slope = local_law(q, local_a[line, k], local_b, floor)
            closed[line, k] += law
            slope[line, k] = law_slope / length[line, k]
    return closed, slope


@kernel
def eliminate(system: FloatArray) -> None:
    """Solve a positive definite system whose right sides are its further columns, in place.

    Gauss elimination without pivoting of the upper half, of whose diagonal the inverse stays; the
    lower half is not read. Each row takes those above it four at a time. Rows of inner loops are
    views, counted from zero: only so do these become vector instructions.
    """
    n, columns = system.shape
    for k in range(n):
        row, whole = system[k, k:], k - k % 4
        for r in range(0, whole, 4):
            f1, f2 = system[r, k] * system[r, r], system[r + 1, k] * system[r + 1, r + 1]
            f3, f4 = (
                system[r + 2, k] * system[r + 2, r + 2],
                system[r + 3, k] * system[r + 3, r + 3],
            )
            u1, u2, u3, u4 = system[r, k:], system[r + 1, k:], system[r + 2, k:], system[r + 3, k:]
            for c in range(columns - k):
                row[c] -= f1 * u1[c] + f2 * u2[c] + f3 * u3[c] + f4 * u4[c]
        for r in range(whole, k):
            factor, upper = system[r, k] * system[r, r], system[r, k:]
            for c in range(columns - k):
                row[c] -= factor * upper[c]
        system[k, k] = 1.0 / system[k, k]
    for side in range(n, columns):
        for k in range(n - 1, -1, -1):
            found = system[k, side] = system[k, side] * system[k, k]
            for r in range(k):  # all sums side by side, so that none waits for its last term
                system[r, side] -= system[r, k] * found


@kernel
def newton_step(
    force: float,
    forces: FloatArray,
    loaded: BoolArray,
    closed: FloatArray,
    slope: FloatArray,
    teeth: Teeth,
) -> tuple[FloatArray, float, float, FloatArray]:
    """Newton's step on the loaded segments to the total `force`.

    Each line is solved by itself; a system of the size of the lines joins them. Returns the step
    [N], the approach [m], the stiffness of the total force against the approach [N/m], and the rise
    of each force with the total one [1]; step and rise of shape (lines, segments).
    """
    compliance, coupling = teeth[0], teeth[1]
    lines, segments = loaded.shape
    unit = np.zeros((lines, segments))
    back = np.zeros((lines, segments))
    index = np.empty(segments, np.int64)
    for line in range(lines):
        n = 0
        for k in range(segments):
            if loaded[line, k]:
                index[n] = k
                n += 1
        jacobian = np.empty((n, n + 2))
        for i in range(n):
            k = index[i]
            for j in range(i, n):
                jacobian[i, j] = compliance[line, k, index[j]]
            jacobian[i, i] += slope[line, k]
            jacobian[i, n] = 1.0
            jacobian[i, n + 1] = closed[line, k]
        eliminate(jacobian)
        for i in range(n):
            unit[line, index[i]] = jacobian[i, n]
            back[line, index[i]] = jacobian[i, n + 1]
    # change P of the total of a line: P = u (D - G P) - h, so that (1/u + G) P = D - h/u where
    # segments are loaded
    u, h = line_totals(unit), line_totals(back)
    system = np.zeros((lines, lines + 2))
    for i in range(lines):
        system[i, i] = 1.0
        if u[i] != 0.0:
            system[i, i] = 1.0 / u[i] + coupling[i, i]
            for j in range(i + 1, lines):
                system[i, j] = coupling[i, j] if u[j] != 0.0 else 0.0
            system[i, lines] = 1.0
            system[i, lines + 1] = h[i] / u[i]
    eliminate(system)
    stiffness, missing = 0.0, force
    totals = line_totals(forces)
    for i in range(lines):
        stiffness += system[i, lines]
        missing += system[i, lines + 1] - totals[i]
    approach = missing / stiffness
    step, rise = np.empty((lines, segments)), np.empty((lines, segments))
    for line in range(lines):
        rim = rim_rise = 0.0
        for other in range(lines):
            change = system[other, lines] * approach - system[other, lines + 1]
            rim += coupling[line, other] * change
            rim_rise += coupling[line, other] * system[other, lines]
        for k in range(segments):
            step[line, k] = unit[line, k] * (approach - rim) - back[line, k]
            rise[line, k] = unit[line, k] * (1.0 - rim_rise) / stiffness
    return step, approach, stiffness, rise


@kernel
def is_solution(
    force: float,
    forces: FloatArray,
    approach: float,
    closed: FloatArray,
    length: FloatArray,
    tolerance: float,
) -> bool:
    """True if nothing pulls, nothing penetrates, contact is closed and the force is balanced.

    Comparisons with NaN are false, so that NaN is no solution.
    """
    lines, segments = length.shape
    limit, lacking = tolerance * abs(approach), force
    for line in range(lines):
        for k in range(segments):
            gap = closed[line, k] - approach
            touching = forces[line, k] > 0.0 and gap <= limit
            free = forces[line, k] == 0.0
            if length[line, k] > 0.0 and not ((touching or free) and gap >= -limit):
                return False
    for carried in line_totals(forces):
        lacking -= carried
    return bool(abs(lacking) <= tolerance * force)


@kernel
def load_touching(
    loaded: BoolArray, closed: FloatArray, length: FloatArray, approach: float, tolerance: float
) -> None:
    """Add all free segments that penetrate to the loaded ones."""
    lines, segments = loaded.shape
    for line in range(lines):
        for k in range(segments):
            if length[line, k] > 0.0 and closed[line, k] - approach < -tolerance * abs(approach):
                loaded[line, k] = True


@kernel
def load_deepest(
    loaded: BoolArray, closed: FloatArray, length: FloatArray, approach: float
) -> None:
    """Add the one free segment that penetrates most."""
    lines, segments = loaded.shape
    deepest, where, which = approach, -1, -1
    for line in range(lines):
        for k in range(segments):
            if length[line, k] > 0.0 and not loaded[line, k] and closed[line, k] < deepest:
                deepest, where, which = closed[line, k], line, k
    if where >= 0:
        loaded[where, which] = True


@kernel
def share_until_release(forces: FloatArray, step: FloatArray, loaded: BoolArray) -> float:
    """Largest part of the step, at most 1, at which nothing pulls. [1]"""
    share = 1.0
    lines, segments = forces.shape
    for line in range(lines):
        for k in range(segments):
            if loaded[line, k] and forces[line, k] + share * step[line, k] < 0.0:
                share = -forces[line, k] / step[line, k]
    return share


@kernel
def let_go(forces: FloatArray, loaded: BoolArray, limit: float) -> None:
    """Release the loaded segments whose force does not exceed `limit`, or is NaN."""
    lines, segments = forces.shape
    for line in range(lines):
        for k in range(segments):
            if loaded[line, k] and not forces[line, k] > limit:
                forces[line, k] = 0.0
                loaded[line, k] = False


@kernel
def is_even(closed: FloatArray, loaded: BoolArray, approach: float, tolerance: float) -> bool:
    """True if contact is closed on all loaded segments: their energy is the least."""
    lines, segments = closed.shape
    for line in range(lines):
        for k in range(segments):
            gap = closed[line, k] - approach
            if loaded[line, k] and not abs(gap) <= tolerance * abs(approach):
                return False
    return True


@kernel
def careful_solution(
    force: float, teeth: Teeth, floor: float, tolerance: float, max_iterations: int
) -> tuple[FloatArray, float, float, int, FloatArray]:
    """The solution by steps that keep the balance and never increase the energy.

    A step ends where the first segment would pull; a free segment joins only at the least energy of
    the loaded ones. No set of loaded segments comes back, so that the method ends. Parameters and
    returns as for `solve_contact_loads`.
    """
    length = teeth[3]
    forces, loaded = shared(force, length)
    closed, slope = deflections(forces, teeth, floor)
    rise = np.zeros(length.shape)
    for iteration in range(max_iterations):
        step, approach, stiffness, rise = newton_step(force, forces, loaded, closed, slope, teeth)
        share = share_until_release(forces, step, loaded)
        blocked = share < 1.0
        descent = -product(step, closed)
        # as near to the least energy as this, its slope is lost in rounding and the step is right
        enough = max(ENOUGH_DESCENT * descent, tolerance * force * abs(approach))
        start = forces
        for _ in range(MOST_HALVINGS):
            forces = after_step(start, share, step)
            closed, slope = deflections(forces, teeth, floor)
            if product(step, closed) <= enough:
                break
            share *= 0.5
            blocked = False
        if blocked:
            let_go(forces, loaded, tolerance * force / length.size)
            closed, slope = deflections(forces, teeth, floor)
        elif is_solution(force, forces, approach, closed, length, tolerance):
            return forces, approach, stiffness, iteration + 1, rise
        elif is_even(closed, loaded, approach, tolerance):
            load_deepest(loaded, closed, length, approach)
    return forces, np.nan, np.nan, -1, rise


@kernel
def solve_contact_loads(
    force: float,  # Normal force of the mesh. [N]
    teeth: Teeth,  # With gaps from where they are nearest.
    floor: float,  # Line load below which the local law is a parabola. [N/m]
    # Forces to begin with, whatever their sum, none for those that pull: what is next to the
    # solution saves most of the steps, the lengths do for a start from nothing. [N]
    start: FloatArray,
    # Returns for these forces, which they are the solution for or nearly so; NaN if unknown.
    approach: float,
    stiffness: float,
    rise: FloatArray,
    # Largest gap or penetration at loaded segments over the approach, and largest error of the
    # balance over the force. [1]
    tolerance: float,
    # Most iterations of the careful method, for which one segment may leave or join at a time.
    max_iterations: int,
) -> tuple[FloatArray, float, float, int, FloatArray]:
    """Forces on all segments of all lines. Theory (E5).

    Returns the forces [N], shape (lines, segments), the approach of the gears along the common
    normal, from where the flanks touch first [m], the stiffness of the total normal force against
    the approach [N/m], the Newton steps, or -1 without a solution, and the rise of each force with
    the total one, before the last step [1], shape (lines, segments).
    """
    length = teeth[3]
    forces, loaded = shared(force, start)
    for iteration in range(QUICK_STEPS):
        closed, slope = deflections(forces, teeth, floor)
        if iteration == 0 and not product(closed, length) < np.inf:
            return np.zeros(length.shape), approach, stiffness, -1, rise
        enough = tolerance if iteration else UNREFINED * tolerance
        if is_solution(force, forces, approach, closed, length, enough):
            return forces, approach, stiffness, iteration, rise
        load_touching(loaded, closed, length, approach, tolerance)
        step, approach, stiffness, rise = newton_step(force, forces, loaded, closed, slope, teeth)
        forces = after_step(forces, 1.0, step)  # let go of all segments that it makes pull
        let_go(forces, loaded, 0.0)
    forces, approach, stiffness, iterations, rise = careful_solution(
        force, teeth, floor, tolerance, max_iterations
    )
    if iterations > 0:
        iterations += QUICK_STEPS
    return forces, approach, stiffness, iterations, rise


@kernel
def from_nearest(teeth: Teeth) -> tuple[Teeth, float, float]:
    """Teeth with gaps from where they are nearest; the gap there, and the length of all lines."""
    compliance, coupling, separation, length, local_a, local_b = teeth
    nearest, gap = np.inf, np.empty(length.shape)
    for line in range(length.shape[0]):
        for k in range(length.shape[1]):
            if length[line, k] > 0.0:
                nearest = min(nearest, separation[line, k])
    for line in range(length.shape[0]):
        for k in range(length.shape[1]):
            gap[line, k] = separation[line, k] - nearest
    return (compliance, coupling, gap, length, local_a, local_b), nearest, line_totals(length).sum()


@kernel
def foreseen(
    force: float, m: int, length: FloatArray, one: tuple[Solutions, int], two: tuple[Solutions, int]
) -> tuple[FloatArray, float, float, FloatArray]:
    """Forces [N] at position `m` under a total `force` [N], from two solutions and their points.

    On the tangent of the nearer one, with its stiffness, or on the parabola from there through the
    other: shares of the force over its logarithm, where they bend a tenth as much as forces do.
    Returns `start`, `approach`, `stiffness` and `rise` as `solve_contact_loads` takes them.
    """
    if abs(one[0][0][one[1]] - force) > abs(two[0][0][two[1]] - force):
        one, two = two, one
    (forces, loads, approach, stiffness, rise), i = one
    (others, other_loads, other_approach, _, _), j = two
    step, apart = np.log(force / forces[i]), np.log(others[j] / forces[i])
    bend = step / apart**2 if abs(step) < min(FARTHEST, SHARPEST * abs(apart)) * abs(apart) else 0.0
    start, slope = np.empty(length.shape), np.empty(length.shape)
    for line in range(length.shape[0]):
        for k in range(length.shape[1]):
            share = loads[i, m, line, k] * length[line, k] / forces[i]
            other = other_loads[j, m, line, k] * length[line, k] / others[j]
            tangent = rise[i, m, line, k] - share
            off = bend * (other - share - apart * tangent)
            share += step * (tangent + off)
            start[line, k], slope[line, k] = force * share, share + tangent + 2.0 * off
    share, other = approach[i, m] / forces[i], other_approach[j, m] / others[j]
    tangent = 1.0 / stiffness[i, m] - share
    off = bend * (other - share - apart * tangent)
    share += step * (tangent + off)
    stiff = 1.0 / (share + tangent + 2.0 * off) if bend != 0.0 else stiffness[i, m]
    return start, force * share, stiff, slope


@kernel
def solve_points(
    forces: FloatArray,  # Shape (points,). [N]
    order: NDArray[np.intp],  # From the least to the greatest of them.
    mesh: Teeth,  # At all mesh positions, axis 0.
    last: Solutions,  # To start from: one for each force, or one for the least.
    tolerance: float,
    max_iterations: int,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, NDArray[np.int64]]:
    """`solve_contact_loads` for points (axis 0) and positions (1); line loads, not forces. [N/m]"""
    compliance, coupling, separation, length, local_a, local_b = mesh
    points, (positions, lines, segments) = forces.size, length.shape
    loads = np.zeros((points, positions, lines, segments))
    rise = np.zeros(loads.shape)
    approach, stiffness = np.empty((points, positions)), np.empty((points, positions))
    iterations = np.empty((points, positions), dtype=np.int64)
    made = forces, loads, approach, stiffness, rise
    for m in range(positions):  # whose influence stays at hand for all points
        here = compliance[m], coupling[m], separation[m], length[m], local_a[m], local_b
        teeth, nearest, whole = from_nearest(here)
        for place in range(points):
            i, before = order[place], order[max(place - 1, 0)]
            if place and forces[i] == forces[before]:  # points of one torque, in the first pass
                loads[i, m], rise[i, m] = loads[before, m], rise[before, m]
                approach[i, m], stiffness[i, m] = approach[before, m], stiffness[before, m]
                iterations[i, m] = min(iterations[before, m], 0)
                continue
            own = last, i if last[0].size == points else 0
            near = (made, before) if place else own
            start, closer, stiff, slope = foreseen(forces[i], m, length[m], near, own)
            found, closed, stiffness[i, m], iterations[i, m], rise[i, m] = solve_contact_loads(
                forces[i], teeth, LINEAR_SHARE * forces[i] / whole, start,
                closer - nearest, stiff, slope, tolerance, max_iterations,
            )  # fmt: skip
            approach[i, m] = closed + nearest
            for line in range(lines):
                for k in range(segments):
                    if length[m, line, k] > 0.0:
                        loads[i, m, line, k] = found[line, k] / length[m, line, k]
    return loads, approach, stiffness, rise, iterations
