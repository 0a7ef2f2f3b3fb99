"""Load distribution of a roller bearing under radial force and moment, slice by slice.

Talbot (2012), Eq. 3.2 and 3.3 (after Harris), extended to two radial directions. State vector
d = (delta_x, delta_y, theta_x L, theta_y L): displacements of the outer race against the inner one
and tilts, made lengths with the half-width L of the bearing. A slice at azimuth psi and axial
position y is pressed by

    delta = [delta_x cos(psi) + delta_y sin(psi)
             + y (theta_x cos(psi) + theta_y sin(psi)) - C_d/2]/2 - c(y)

at each of its two contacts (the factor 1/2 shares the approach between inner and outer race), and
carries q = delta^1.11 / (1.24e-5 l^0.11) in N and mm, l being the loaded length of its roller.

For fixed l the balance of forces is the minimum of a convex function, so that a Newton iteration
with line search finds it from any start; l follows by substitution, which contracts because it
enters with the power 0.11 only.
"""

from __future__ import annotations

import numpy as np

from epicyclic.arrays import FloatArray, IntArray
from epicyclic.kernels.compiling import kernel
from epicyclic.kernels.contact_load import eliminate
from epicyclic.kernels.line_contact import power

DEFLECTION_EXPONENT = 1.11  # Exponent of the line contact, Talbot (2012) Eq. 3.3a. [1]
LENGTH_EXPONENT = 0.11  # Exponent of the loaded length, Talbot (2012) Eq. 3.3a. [1]
DEFLECTION_CONSTANT = 1.24e-5
"""Palmgren's constant for steel rollers, Talbot (2012) Eq. 3.3a; N and mm."""
MM = 1e3  # Millimetres in a metre.
LARGEST_STEP_HALVINGS = 60
SUFFICIENT_DECREASE = 1e-4  # Armijo constant of the line search. [1]
ROUNDING = 16 * 2.2e-16
"""Share of a displacement that is rounding: the force it makes cannot be balanced better. [1]"""
LENGTH_UPDATES = 25
"""Substitutions of the loaded lengths. They contract by 0.1 each, but for bearings of few rollers
that have hardly any stiffness in one direction; there the last lengths are kept."""
LARGEST_GROWTH = 10.0
"""Largest Newton step over the displacement, and over the clearance, that it starts from. [1]"""
FLATTER = 0.5
"""Share of the gradient to which a step must bring it where the energy is rounding noise. [1]"""
SMALLEST_LENGTH = 1e-6  # Size of a deflection where there is no clearance to compare it with. [m]
NEWTON_SHIFT = 1e-12
"""Share of the reference stiffness added to the Hessian, which is singular without contact. [1]"""
HIGHEST_SHIFT = 1e-4
SHORT_STEP = 1e-3
"""Factor of the line search from which on the shift grows: a step that is rounding over hardly any
stiffness, in a direction in which no roller is loaded, has run into the next roller. [1]"""
SHIFT_GROWTH = 100.0
STALLED = 1e-6
"""Residual over the largest load at which an iteration that comes no further has its answer: the
energy of small forces is rounding. [1]"""
SMALL_FORCE = 1e-3  # A largest load below this counts as this size in `STALLED`. [N]

Rollers = tuple[FloatArray, FloatArray, FloatArray, float, float]
"""Cosine and sine of the azimuth of each roller, shape (rollers, 2), then the parameters of
`solve_roller_loads` from `y_over_l` to `clearance`."""


@kernel
def slice_stiffness(loaded_length: float) -> float:
    """K of q = K delta^1.11, q in N/m and delta in m, for a roller loaded over `loaded_length`.

    Theory (B9).
    """
    compliance: float = DEFLECTION_CONSTANT * (loaded_length * MM) ** LENGTH_EXPONENT
    return float(MM * MM**DEFLECTION_EXPONENT / compliance)


@kernel
def approach_of_races(d: FloatArray, along: FloatArray, z: int) -> tuple[float, float]:
    """Approach of the races at a roller: in the middle, and by the tilt at the end. [m]"""
    cos, sin = along[z, 0], along[z, 1]
    return d[0] * cos + d[1] * sin, d[2] * cos + d[3] * sin


@kernel
def slice_deflection(
    radial: float, tilt: float, y_over_l: float, clearance: float, crown: float
) -> float:
    """Deflection of one contact of a slice; negative where there is a gap. Theory (B8). [m]"""
    return 0.5 * (radial + y_over_l * tilt - 0.5 * clearance) - crown


@kernel
def is_free(radial: float, tilt: float, y_over_l: FloatArray, clearance: float) -> bool:
    """True if even without crown no slice of a roller would be pressed."""
    return bool(radial + max(y_over_l[0] * tilt, y_over_l[-1] * tilt) <= 0.5 * clearance)


@kernel
def potential(
    d: FloatArray,
    load: FloatArray,
    rollers: Rollers,
    stiffness: FloatArray,
    gradient: FloatArray,
    hessian: FloatArray,
) -> float:
    """Elastic energy less the work of `load`; fills `gradient`, `hessian` in `d`. Theory (B10)."""
    along, y_over_l, crown, width, clearance = rollers
    energy = 0.0
    gradient[:] = -load
    hessian[:] = 0.0
    rows, slices = y_over_l.shape
    # moments along the rollers at one azimuth, of order 0 and 1, and 0 to 2
    forces, slopes = np.empty(2), np.empty(3)
    deltas, stiff = np.empty(slices), np.empty(slices)
    for z in range(len(along)):
        radial, tilt = approach_of_races(d, along, z)
        forces[:], slopes[:] = 0.0, 0.0
        for row in range(rows):
            if is_free(radial, tilt, y_over_l[row], clearance):
                continue
            for k in range(slices):
                deltas[k] = slice_deflection(radial, tilt, y_over_l[row, k], clearance, crown[k])
                stiff[k] = width * stiffness[row, z] * power(deltas[k], LENGTH_EXPONENT)
            for k in range(slices):
                y, delta, slope = y_over_l[row, k], deltas[k], stiff[k]
                if delta <= 0.0:
                    continue
                force = slope * delta
                energy += 2.0 * force * delta / (DEFLECTION_EXPONENT + 1.0)
                forces[0] += force
                forces[1] += force * y
                slopes[0] += slope
                slopes[1] += slope * y
                slopes[2] += slope * y * y
        for i in range(4):
            gradient[i] += forces[i // 2] * along[z, i % 2]
            for j in range(4):
                turned = 0.5 * DEFLECTION_EXPONENT * along[z, i % 2] * along[z, j % 2]
                hessian[i, j] += slopes[i // 2 + j // 2] * turned
    for i in range(4):
        energy -= load[i] * d[i]
    return energy


@kernel
def loaded_lengths(d: FloatArray, rollers: Rollers, lengths: FloatArray) -> bool:
    """Fill `lengths`, (rows, rollers), with the length over which each roller is loaded.

    Theory (B11). The source counts loaded slices, a number that jumps. Here the slice in which the
    load ends counts for the part of it that a straight line between slice middles finds loaded. At
    the end of a roller half a slice still comes or goes at once: where it is so near to that that
    it could be either, by the lengths before, True is returned.
    """
    along, y_over_l, crown, width, clearance = rollers
    rows, slices = y_over_l.shape
    delta = np.empty(slices)
    doubtful = False
    for z in range(len(along)):
        radial, tilt = approach_of_races(d, along, z)
        for row in range(rows):
            for k in range(slices):
                delta[k] = slice_deflection(radial, tilt, y_over_l[row, k], clearance, crown[k])
            count = 0.5 * ((1.0 if delta[0] > 0.0 else 0.0) + (1.0 if delta[-1] > 0.0 else 0.0))
            for k in range(slices - 1):
                a, b = delta[k], delta[k + 1]
                if a > 0.0 and b > 0.0:
                    count += 1.0
                elif a > 0.0 or b > 0.0:
                    count += max(a, b) / abs(a - b)
            # an unloaded roller keeps one slice: its stiffness is then finite and unused
            lengths[row, z] = width * max(count, 1.0)
            # half a slice changes the deflection by so much, under the same load
            moved = LENGTH_EXPONENT * 0.5 / max(count, 1.0) * delta.max()
            doubtful |= min(abs(delta[0]), abs(delta[-1])) < moved
    return doubtful


@kernel
def largest(values: FloatArray) -> float:
    """Largest absolute value, NaN if one is; numpy's takes several times as long to compile."""
    found = 0.0
    for value in values:
        if abs(value) > found or np.isnan(value):
            found = abs(value)
    return found


@kernel
def hold_tilt(gradient: FloatArray, hessian: FloatArray) -> None:
    """Take the tilts out of a Newton step."""
    for i in range(2, 4):
        gradient[i] = 0.0
        for j in range(4):
            hessian[i, j] = hessian[j, i] = 0.0
        hessian[i, i] = max(hessian[0, 0], hessian[1, 1])


@kernel
def minimise(
    d: FloatArray,
    load: FloatArray,
    rollers: Rollers,
    stiffness: FloatArray,
    tolerance: float,
    max_iterations: int,
    held: bool,
) -> int:
    """Move `d`, its tilts only if not `held`, to the minimum of `potential` by Newton steps.

    Returns the number of steps, or -1 if `max_iterations` did not suffice.
    """
    _, y_over_l, _, width, clearance = rollers
    gradient = np.empty(4)
    hessian = np.empty((4, 4))
    trial_gradient = np.empty(4)
    trial_hessian = np.empty((4, 4))
    system, step, trial = np.empty((4, 5)), np.empty(4), np.empty(4)
    scale = largest(load)
    reference = (
        slice_stiffness(width * y_over_l.size)
        * width
        * float(clearance_length(clearance) ** LENGTH_EXPONENT)
    )
    energy = potential(d, load, rollers, stiffness, gradient, hessian)
    relative_shift = NEWTON_SHIFT
    for iteration in range(max_iterations):
        if held:
            hold_tilt(gradient, hessian)
        stiffest = max(hessian[0, 0], hessian[1, 1], hessian[2, 2], hessian[3, 3])
        rounding = ROUNDING * stiffest * largest(d)
        if largest(gradient) <= max(tolerance * scale, rounding):
            return iteration
        shift = relative_shift * reference
        for i in range(4):
            shift = max(shift, relative_shift * hessian[i, i])
        for i in range(4):
            hessian[i, i] += shift
        for i in range(4):
            system[i, :4], system[i, 4] = hessian[i], -gradient[i]
        eliminate(system)
        # without contact the Newton step is as long as the shift makes it: start small
        length, slope = 0.0, 0.0
        for i in range(4):
            length = max(length, abs(system[i, 4]))
        longest = LARGEST_GROWTH * max(largest(d), clearance_length(clearance))
        shorter = longest / length if length > longest else 1.0
        for i in range(4):
            step[i] = shorter * system[i, 4]
            slope += gradient[i] * step[i]
        factor = 1.0
        accepted = False
        for _ in range(LARGEST_STEP_HALVINGS):
            for i in range(4):
                trial[i] = d[i] + factor * step[i]
            trial_energy = potential(trial, load, rollers, stiffness, trial_gradient, trial_hessian)
            if held:
                hold_tilt(trial_gradient, trial_hessian)
            decrease = SUFFICIENT_DECREASE * factor * slope
            # near the minimum the energy is rounding noise: then the gradient decides
            flatter = largest(trial_gradient) < FLATTER * largest(gradient)
            if trial_energy <= energy + decrease or flatter:
                accepted = True
                break
            factor *= 0.5
        if accepted and factor > SHORT_STEP:
            relative_shift = max(NEWTON_SHIFT, relative_shift / SHIFT_GROWTH)
        elif relative_shift < HIGHEST_SHIFT:
            relative_shift *= SHIFT_GROWTH
        if not accepted:
            if relative_shift < HIGHEST_SHIFT:
                potential(d, load, rollers, stiffness, gradient, hessian)
                continue
            break
        d[:] = trial
        energy = trial_energy
        gradient[:] = trial_gradient
        hessian[:] = trial_hessian
    stalled = largest(gradient) <= STALLED * max(scale, SMALL_FORCE)
    return max_iterations if stalled else -1


@kernel
def clearance_length(clearance: float) -> float:
    """A length of the size of clearances and deflections, at least 1 um. [m]"""
    return max(clearance, SMALLEST_LENGTH)


@kernel
def solve_one(
    load: FloatArray,
    d: FloatArray,
    rollers: Rollers,
    tolerance: float,
    max_iterations: int,
    held: bool,
    near: bool,
    q: FloatArray,
) -> int:
    """As `solve_roller_loads` under one load; moves the state `d`, fills the intensities `q`."""
    along, y_over_l, crown, width, clearance = rollers
    rows, slices = y_over_l.shape
    if largest(load) == 0.0:
        return 0
    lengths, stiffness = np.empty((rows, len(along))), np.empty((rows, len(along)))
    total = 0
    for whole in range(0 if near else 1, 2):  # the one solution that begins with whole rollers
        lengths[:] = width * slices
        doubtful = whole == 0 and loaded_lengths(d, rollers, lengths)
        converged = False
        for outer in range(max_iterations):
            for row in range(rows):
                for z in range(len(along)):
                    stiffness[row, z] = slice_stiffness(lengths[row, z])
            steps = minimise(d, load, rollers, stiffness, tolerance, max_iterations, held)
            if steps < 0:
                return -1
            total += steps
            if (outer > 0 and steps == 0) or outer == LENGTH_UPDATES:
                converged = True
                break
            doubtful = loaded_lengths(d, rollers, lengths)
        if not converged:
            return -1
        if not doubtful:
            break
    for z in range(len(along)):
        radial, tilt = approach_of_races(d, along, z)
        for row in range(rows):
            for k in range(slices):
                delta = slice_deflection(radial, tilt, y_over_l[row, k], clearance, crown[k])
                if delta > 0.0:
                    q[row, z, k] = stiffness[row, z] * delta**DEFLECTION_EXPONENT
    return total


@kernel
def solve_roller_loads(
    load: FloatArray,  # F_x, F_y [N] and M_x/L, M_y/L [N], moments conjugate to the tilts.
    start: FloatArray,  # Where the iteration starts. [m]
    psi: FloatArray,  # Azimuth of each roller. [rad]
    # Of the bearing of all points, or of each, in the first axis:
    y_over_l: FloatArray,  # Axial position of the slices over the half-width of the bearing. [1]
    crown: FloatArray,  # Crown drop at each slice. [m]
    sizes: FloatArray,  # Slice width and diametral clearance. [m]
    tolerance: float,  # Largest residual force over the largest load. [1]
    max_iterations: int,  # For each of the two nested iterations.
    held: bool = False,  # True to keep the tilts of `start`.
    near: bool = False,  # True if `start` is so near that its loaded lengths serve.
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Load intensity of every slice of every roller, under the load of each of n points, (n, 4).

    Returns the load intensity [N/m], shape (n, rows, rollers, slices), the state vector [m],
    (n, 4), and the Newton steps in all, (n,), or -1 without convergence.
    """
    points, (bearings, rows, slices) = len(load), y_over_l.shape
    q, d = np.zeros((points, rows, psi.size, slices)), np.empty_like(start)
    iterations, along = np.empty(points, np.intp), np.empty((psi.size, 2))
    for z in range(psi.size):
        along[z, 0], along[z, 1] = np.cos(psi[z]), np.sin(psi[z])
    for i in range(points):
        own = i % bearings
        rollers = (along, y_over_l[own], crown[own], sizes[own, 0], sizes[own, 1])
        loaded = i > 0 and iterations[i - 1] > 0 and largest(load[i]) > 0.0
        # first from the point before, which is nearer, and if that leads nowhere from its own start
        for anew in range(0 if loaded and not (near or held) else 1, 2):
            d[i] = start[i] if anew else d[i - 1]
            iterations[i] = solve_one(
                load[i], d[i], rollers, tolerance, max_iterations, held, near or not anew, q[i]
            )
            if iterations[i] >= 0:
                break
    return q, d, iterations
