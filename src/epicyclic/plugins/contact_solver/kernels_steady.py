"""Steady smooth line contact: compressible Reynolds equation with elastic half-spaces.

Unknowns are the pressures P_i at the nodes and the rigid approach H_0. The flow is balanced over
the cell of every node; the film follows from all pressures, so that the Jacobian is full, and a
Newton iteration is taken with it. Where the film ruptures, P = 0 and the balance is an inequality:
the set of such nodes is found in the same iteration.
"""

from __future__ import annotations

import math
from importlib import import_module

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.kernels.compiling import kernel
from epicyclic.plugins.contact_solver.kernels_fluid import (
    ScaledFluid,
    density_ratio,
    log_viscosity_ratio,
    mean_fluidity,
    mean_shear,
    thinning_factor,
)

import_module("scipy.linalg")  # numba calls its library, which `one_thread` must find

SMALLEST_FILM_SHARE = 0.2  # Share of its film that every node keeps in one Newton step. [1]
LARGEST_PRESSURE_SHARE = 0.5
"""Largest change of a pressure in one Newton step, over the largest pressure. [1]"""


@kernel
def _second_primitive(x: float) -> float:
    """Second primitive of ln|x|: x^2 (ln|x| - 3/2)/2."""
    if x == 0.0:
        return 0.0
    value: float = 0.5 * x * x * (np.log(abs(x)) - 1.5)
    return value


@kernel
def deflection_matrix(points: FloatArray, nodes: FloatArray) -> FloatArray:
    """Deflection at each point for unit pressure at each node, linear in between. Theory (H9).

    `points` of shape (m,), `nodes` of shape (n,), rising. The result, shape (m, n), is -1/pi times
    the integral of ln|X_i - S| times the hat function of node j. The pressure vanishes at the first
    and the last node, whose columns are zero.
    """
    n = nodes.size
    matrix = np.zeros((points.size, n))
    for i in range(points.size):
        before = _second_primitive(points[i] - nodes[0])
        here = _second_primitive(points[i] - nodes[1])
        for j in range(1, n - 1):
            after = _second_primitive(points[i] - nodes[j + 1])
            left, right = nodes[j] - nodes[j - 1], nodes[j + 1] - nodes[j]
            matrix[i, j] = -((after - here) / right - (here - before) / left) / math.pi
            before, here = here, after
    return matrix


@kernel
def _film(pressure: FloatArray, approach: float, gap: FloatArray, matrix: FloatArray) -> FloatArray:
    """H = H_0 + gap + deflection, shape (n,). Theory (H10)."""
    return gap + approach + matrix @ pressure


@kernel
def _flows(
    pressure: FloatArray, film: FloatArray, x: FloatArray, fluid: ScaledFluid
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mass flow through the faces between nodes, with its local derivatives.

    Those of face i + 1/2 are in film and pressure of the nodes i - 1, i, i + 1, shape (n - 1, 3).
    Theory (H11), (H12), (H13).
    """
    n = x.size
    flow = np.zeros(n - 1)
    d_film = np.zeros((n - 1, 3))
    d_pressure = np.zeros((n - 1, 3))
    rho, d_rho = np.zeros(n), np.zeros(n)
    log_mu, d_log_mu, root = np.zeros(n), np.zeros(n), np.zeros(n)
    for i in range(n):
        rho[i], d_rho[i] = density_ratio(pressure[i], fluid)
        log_mu[i], d_log_mu[i] = log_viscosity_ratio(pressure[i], fluid)
        root[i] = math.exp(-0.5 * log_mu[i])
    for i in range(n - 1):
        dx = x[i + 1] - x[i]
        # Couette flow: extrapolated from upstream; at the inlet, centred
        share = 0.5 * dx / (x[i] - x[i - 1]) if i > 0 else 0.0
        weights = (-share, 1.0 + share, 0.0) if i > 0 else (0.0, 0.5, 0.5)
        for k in range(3):
            j = i - 1 + k
            if weights[k] != 0.0:
                flow[i] += weights[k] * rho[j] * film[j]
                d_film[i, k] += weights[k] * rho[j]
                d_pressure[i, k] += weights[k] * d_rho[j] * film[j]
        # Poiseuille flow
        h = 0.5 * (film[i] + film[i + 1])
        density = 0.5 * (rho[i] + rho[i + 1])
        fluidity, d_left, d_right = mean_fluidity(log_mu[i], log_mu[i + 1], root[i], root[i + 1])
        ease, exponent, softening = thinning_factor(
            1.0 / (root[i] * root[i + 1]), h, 0.5 * (pressure[i] + pressure[i + 1]), fluid
        )
        conductance = fluid.poiseuille * density * h**3 * fluidity * ease
        gradient = (pressure[i + 1] - pressure[i]) / dx
        poiseuille = conductance * gradient
        flow[i] -= poiseuille
        by_film = 0.5 * poiseuille * (3.0 - exponent) / h
        d_film[i, 1] -= by_film
        d_film[i, 2] -= by_film
        soft = 0.5 * exponent * softening
        by_left = 0.5 * d_rho[i] / density + soft + (d_left + 0.5 * exponent) * d_log_mu[i]
        by_right = (
            0.5 * d_rho[i + 1] / density + soft + (d_right + 0.5 * exponent) * d_log_mu[i + 1]
        )
        d_pressure[i, 1] -= poiseuille * by_left - conductance / dx
        d_pressure[i, 2] -= poiseuille * by_right + conductance / dx
    return flow, d_film, d_pressure


@kernel
def _assemble(
    d_film: FloatArray,
    d_pressure: FloatArray,
    matrix: FloatArray,
    active: BoolArray,
    weights: FloatArray,
) -> FloatArray:
    """Jacobian of balance and load in (P, H_0), shape (n + 1, n + 1)."""
    n = matrix.shape[0]
    jacobian = np.zeros((n + 1, n + 1))
    for i in range(n):
        if not active[i]:
            jacobian[i, i] = 1.0
            continue
        row = jacobian[i]
        for side in range(2):
            face, sign = i - side, 1.0 - 2.0 * side
            for k in range(3):
                j = face - 1 + k
                factor = sign * d_film[face, k]
                if factor != 0.0:
                    for m in range(n):
                        row[m] += factor * matrix[j, m]
                    row[n] += factor
                if d_pressure[face, k] != 0.0:
                    row[j] += sign * d_pressure[face, k]
    for m in range(n):
        jacobian[n, m] = weights[m]
    return jacobian


@kernel
def _balance_errors(
    flow: FloatArray, pressure: FloatArray, active: BoolArray, weights: FloatArray, load: float
) -> FloatArray:
    """What flows, pressures of ruptured nodes and the load lack, shape (n + 1,).

    A ruptured node into which more flows than out is put back among the `active` ones.
    """
    n = pressure.size
    lack = np.zeros(n + 1)
    for i in range(1, n - 1):
        net = flow[i] - flow[i - 1]
        if not active[i] and net < 0.0:
            active[i] = True
        lack[i] = -net if active[i] else -pressure[i]
    lack[n] = load - weights @ pressure
    return lack


@kernel
def solve_steady(
    x: FloatArray,  # Nodes, rising; the pressure is zero at the first and the last.
    gap: FloatArray,  # Undeformed gap at the nodes but for a constant.
    matrix: FloatArray,  # `deflection_matrix` of `x`.
    load: float,  # Integral of P over X.
    fluid: ScaledFluid,
    guess: FloatArray,  # Pressures to start from; a node after x = 0 with none starts ruptured.
    approach: float,  # H_0 to start from.
    tolerance: float,  # Largest last step of P over the largest P, and of H over H, at every node.
    max_iterations: int,
) -> tuple[FloatArray, FloatArray, FloatArray, float, int, float]:
    """Pressure and film of a steady contact. Theory (H4), (H14), (H15).

    Behind them the mass flow through the faces between the nodes, H_0, the number of iterations,
    negative if `tolerance` was not met, and the measure that `tolerance` bounds.
    """
    n = x.size
    half = 0.5 * np.diff(x)
    weights = np.append(half, 0.0) + np.append(0.0, half)  # of the trapezoidal rule
    pressure = guess.copy()
    active = (pressure > 0.0) | (x <= 0.0)
    active[0] = active[n - 1] = False
    film = _film(pressure, approach, gap, matrix)
    flow, d_film, d_pressure = _flows(pressure, film, x, fluid)
    error = np.inf
    for iteration in range(1, max_iterations + 1):
        lack = _balance_errors(flow, pressure, active, weights, load)
        jacobian = _assemble(d_film, d_pressure, matrix, active, weights)
        if not (np.isfinite(lack).all() and np.isfinite(jacobian).all()):
            return pressure, film, flow, approach, -iteration, np.inf
        step = np.linalg.solve(jacobian, lack)
        change = matrix @ step[:n] + step[n]
        largest, peak = np.abs(step[:n]).max(), pressure.max()
        length = min(1.0, LARGEST_PRESSURE_SHARE * peak / largest)
        for i in range(n):
            if change[i] < 0.0:  # every node keeps a share of its film
                length = min(length, (1.0 - SMALLEST_FILM_SHARE) * film[i] / -change[i])
        for i in range(1, n - 1):
            pressure[i] += length * step[i]
            if pressure[i] < 0.0:
                pressure[i] = 0.0
                active[i] = False
        approach += length * step[n]
        film = _film(pressure, approach, gap, matrix)
        flow, d_film, d_pressure = _flows(pressure, film, x, fluid)
        error = max(largest / peak, np.abs(change / film).max())
        if error < tolerance:
            return pressure, film, flow, approach, iteration, error
    return pressure, film, flow, approach, -max_iterations, error


@kernel
def shear_stresses(
    pressure: FloatArray, film: FloatArray, thinned: FloatArray, fluid: ScaledFluid
) -> FloatArray:
    """`mean_shear` where there is pressure, else zero; arrays of shape (n,)."""
    stress = np.zeros(pressure.size)
    for i in range(pressure.size):
        if pressure[i] > 0.0:
            stress[i] = mean_shear(pressure[i], film[i], thinned[i], fluid)
    return stress
