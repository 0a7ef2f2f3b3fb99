"""Load along the contact lines of elastic teeth at one mesh position.

Unilateral contact: every segment of every line carries F >= 0, its teeth approach each other by
C F + delta_c(F), and where F > 0 this equals the rigid approach of the gears, the same everywhere;
the forces sum to the force of the mesh (T. F. Conry and A. Seireg, J. Eng. Ind. 95 (1973) 1115).
C couples the segments of one line, which lie on one pair of teeth. The local deflection of a
segment of length l under q = F/l is (C. Weber and K. Banaschek, 1953)

    delta_c = q [A - B ln(q)/2] .

C is positive definite and delta_c rises with q, so that the solution is unique; a Newton iteration
on the set of loaded segments finds it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels._jit import kernel

__all__ = ["solve_contact_loads"]

FloatArray = NDArray[np.float64]

LINEAR_SHARE = 1e-3
"""Share of the mean line load below which delta_c is linear: ln(q) has no value at 0. [1]"""


@kernel
def local_deflection(q: float, a: float, b: float, floor: float) -> float:
    """delta_c of a segment. Theory (E4). [m]"""
    deflection: float = q * (a - 0.5 * b * np.log(max(q, floor)))
    return deflection


@kernel
def local_compliance(q: float, a: float, b: float, floor: float) -> float:
    """Derivative of `local_deflection` in q. [m^2/N]"""
    if q > floor:
        compliance: float = a - 0.5 * b * np.log(q) - 0.5 * b
        return compliance
    secant: float = a - 0.5 * b * np.log(floor)
    return secant


@kernel
def solve_contact_loads(
    force: float,
    compliance: FloatArray,
    length: FloatArray,
    local_a: FloatArray,
    local_b: float,
    tolerance: float,
    max_iterations: int,
) -> tuple[FloatArray, float, int]:
    """Forces on all segments of all lines.

    Theory (E5).

    Parameters
    ----------
    force : float
        Normal force of the mesh. [N]
    compliance : ndarray, shape (lines, segments, segments)
        Influence coefficients of both teeth. [m/N]
    length : ndarray, shape (lines, segments)
        Of the segments; zero where a line is not in contact. [m]
    local_a : ndarray, shape (lines, segments)
        A of delta_c. [m^2/N]
    local_b : float
        B of delta_c. [m^2/N]
    tolerance : float
        Largest change of a segment's force in the last step over the mean force. [1]
    max_iterations : int

    Returns
    -------
    forces : ndarray, shape (lines, segments)
        [N]
    approach : float
        Normal approach of the gears. [m]
    iterations : int
        Newton steps, or -1 without convergence.
    """
    lines, segments = length.shape
    floor = LINEAR_SHARE * force / length.sum()
    forces = force * length / length.sum()
    mean = force / np.count_nonzero(length)
    loaded = length > 0.0
    approach = 0.0
    for iteration in range(max_iterations):
        unit = np.zeros((lines, segments))
        shortfall = np.zeros((lines, segments))
        for line in range(lines):
            index = np.nonzero(loaded[line])[0]
            n = index.size
            if n == 0:
                continue
            jacobian = np.empty((n, n))
            sides = np.ones((n, 2))
            for i in range(n):
                k = index[i]
                q = forces[line, k] / length[line, k]
                deflection = local_deflection(q, local_a[line, k], local_b, floor)
                for j in range(n):
                    jacobian[i, j] = compliance[line, k, index[j]]
                    deflection += compliance[line, k, index[j]] * forces[line, index[j]]
                slope = local_compliance(q, local_a[line, k], local_b, floor)
                jacobian[i, i] += slope / length[line, k]
                sides[i, 1] = deflection
            solved = np.linalg.solve(jacobian, sides)
            for i in range(n):
                unit[line, index[i]] = solved[i, 0]
                shortfall[line, index[i]] = solved[i, 1]
        approach = (force - forces.sum() + shortfall.sum()) / unit.sum()
        change = 0.0
        settled = True
        for line in range(lines):
            for k in range(segments):
                if not loaded[line, k]:
                    continue
                step = approach * unit[line, k] - shortfall[line, k]
                if forces[line, k] + step <= 0.0:
                    step = -forces[line, k]
                    loaded[line, k] = False
                    settled = False
                forces[line, k] += step
                change = max(change, abs(step))
        for line in range(lines):
            for k in range(segments):
                if length[line, k] > 0.0 and not loaded[line, k]:
                    gap = -approach
                    for j in range(segments):
                        gap += compliance[line, k, j] * forces[line, j]
                    if gap < -1e-12 * approach:
                        loaded[line, k] = True
                        settled = False
        if settled and change <= tolerance * mean:
            return forces, approach, iteration + 1
    return forces, approach, -1
