"""Interpolation in compiled code: weighted neighbours, cubic tables, monotone cubics."""

from __future__ import annotations

import math

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.kernels.compiling import kernel

# Sums over the neighbours of each place, near ones counting more.
#
# They are what `scipy.interpolate.RBFInterpolator` gives, which a test compares. Contacts are asked
# for tens of thousands of times in a solution, so that its time is felt.


@kernel
def _add_squares(place: FloatArray, others: FloatArray, first: int, row: FloatArray) -> None:
    """Add half the squared distance along four coordinates to `row`: one pass is quicker."""
    a, b, c, d = place[first], place[first + 1], place[first + 2], place[first + 3]
    along_a, along_b = others[first], others[first + 1]
    along_c, along_d = others[first + 2], others[first + 3]
    for j in range(row.size):
        u, v, w, x = a - along_a[j], b - along_b[j], c - along_c[j], d - along_d[j]
        row[j] += 0.5 * (u * u + v * v + w * w + x * x)


@kernel
def covariances(
    place: FloatArray,  # In units of the length over which things are alike.
    others: FloatArray,  # One neighbour in each column: inner loops run along rows.
    row: FloatArray,
) -> None:
    """Write 1/(1 + r^2/2) of a place with each of its neighbours to `row`. Theory (O15). [1]

    The rational quadratic covariance of power 1: C. E. Rasmussen and C. K. I. Williams, Gaussian
    Processes for Machine Learning (2006), (4.19).
    """
    row[:] = 1.0
    _add_squares(place, others, 0, row)
    _add_squares(place, others, 4, row)
    row[:] = 1.0 / row


@kernel
def covariance_sums(
    # The first four coordinates often stay as they are from one place to the next.
    places: FloatArray,
    others: FloatArray,
    shares: FloatArray,  # What each neighbour adds at its own place.
) -> FloatArray:
    """Sum of the shares of all neighbours times their `covariances`, shape (n,). [1]"""
    sums = np.empty(places.shape[0])
    held, row = np.empty(shares.size), np.empty(shares.size)
    parts = np.empty(shares.size // 4)
    for i in range(sums.size):
        if i == 0 or not _same(places[i], places[i - 1]):
            held[:] = 1.0
            _add_squares(places[i], others, 0, held)
        row[:] = held
        _add_squares(places[i], others, 4, row)
        sums[i] = _sum_of_quotients(shares, row, parts)
    return sums


@kernel
def _same(place: FloatArray, other: FloatArray) -> bool:
    """Whether the first four coordinates are equal."""
    return bool(
        place[0] == other[0]
        and place[1] == other[1]
        and place[2] == other[2]
        and place[3] == other[3]
    )


@kernel
def _sum_of_quotients(shares: FloatArray, row: FloatArray, parts: FloatArray) -> float:
    """Sum of shares over `row`, four to one division, which takes longer than all the rest."""
    q = parts.size
    for j in range(q):
        one, two = row[j] * row[j + q], row[j + 2 * q] * row[j + 3 * q]
        over_one = shares[j] * row[j + q] + shares[j + q] * row[j]
        over_two = shares[j + 2 * q] * row[j + 3 * q] + shares[j + 3 * q] * row[j + 2 * q]
        parts[j] = (over_one * two + over_two * one) / (one * two)
    total = _sum(parts)
    for j in range(4 * q, row.size):
        total += shares[j] / row[j]
    return total


@kernel
def _sum(row: FloatArray) -> float:
    """In four parts, which do not wait for each other."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    whole = row.size - row.size % 4
    for j in range(0, whole, 4):
        a += row[j]
        b += row[j + 1]
        c += row[j + 2]
        d += row[j + 3]
    for j in range(whole, row.size):
        a += row[j]
    return a + b + c + d


# Tables over the pressure, and over the place on a path of contact: cubics through four points.


@kernel
def _cubic(place: float, size: int, weights: FloatArray) -> int:
    """Write the weights of four points next to a place among `size` ones; their first one.

    Lagrange's; places count the points from 0 and are held among them.
    """
    first = min(max(int(place) - 1, 0), size - 4)
    x = min(max(place, 0.0), size - 1.0) - first
    weights[0] = -(x - 1) * (x - 2) * (x - 3) / 6
    weights[1] = x * (x - 2) * (x - 3) / 2
    weights[2] = -x * (x - 1) * (x - 3) / 2
    weights[3] = x * (x - 1) * (x - 2) / 6
    return first


@kernel
def _weighted(weights: FloatArray, row: FloatArray, k: int) -> float:
    """Sum of the four weighted values from the k-th one."""
    total = 0.0
    for a in range(4):
        total += weights[a] * row[k + a]
    return total


@kernel
def over_pressure(
    pressure: FloatArray,  # p_h, held within `pressures`. [Pa]
    # Lowest and highest one of the points, which are even in the logarithm. [Pa]
    pressures: FloatArray,
    values: FloatArray,
) -> FloatArray:
    """A quantity under a pressure, shape (n,). Theory (O16)."""
    found, weights = np.empty(pressure.size), np.empty(4)
    low = math.log(pressures[0])
    level = (values.size - 1) / (math.log(pressures[1]) - low)
    for i in range(pressure.size):
        k = _cubic((math.log(pressure[i]) - low) * level, values.size, weights)
        found[i] = _weighted(weights, values, k)
    return found


@kernel
def along_path(
    path: FloatArray,  # s, from the pitch point, shape (n,). [m]
    pressure: FloatArray,  # p_h, held within `pressures`, shape (n,). [Pa]
    ends: FloatArray,  # Ends of the path on the negative and on the positive side. [m]
    crowding: FloatArray,  # k of both sides: how much points crowd at the pitch point. [1]
    pressures: FloatArray,  # Lowest and highest one of the points, even in the logarithm. [Pa]
    # At the points of both sides, from the pitch point outwards, and of the pressure, (2, m, k).
    values: FloatArray,
) -> FloatArray:
    """A quantity at places on the path of contact under a pressure, shape (n,). Theory (O16)."""
    found = np.empty(path.size)
    along, over = np.empty(4), np.empty(4)
    points, levels = values.shape[1:]
    low = math.log(pressures[0])
    level = (levels - 1) / (math.log(pressures[1]) - low)
    for i in range(path.size):
        side = 1 if path[i] >= 0 else 0
        share = path[i] / ends[side] if ends[side] != 0 else 0.0
        place = math.log1p(math.expm1(crowding[side]) * share) / crowding[side] * (points - 1)
        m = _cubic(place, points, along)
        k = _cubic((math.log(pressure[i]) - low) * level, levels, over)
        found[i] = 0.0
        for a in range(4):
            found[i] += along[a] * _weighted(over, values[side, m + a], k)
    return found


# Interpolation that makes no new extremes: piecewise cubics over evenly spaced points.
#
# Fritsch and Butland (1984): the slope at a point is the harmonic mean of those on both sides, zero
# at an extreme.


@kernel
def _slope(values: FloatArray, n: int, column: int) -> float:
    """Slope at point `n`, in units of the spacing."""
    last = values.shape[0] - 1
    left = values[n, column] - values[n - 1, column] if n > 0 else 0.0
    right = values[n + 1, column] - values[n, column] if n < last else 0.0
    if n == 0:
        return right
    if n == last:
        return left
    return 2 * left * right / (left + right) if left * right > 0.0 else 0.0


@kernel
def monotone_cubic(
    first: float,  # Place of the first point, and spacing of all.
    spacing: float,  # Place of the first point, and spacing of all.
    values: FloatArray,
    at: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Values and slopes, (m, k), at m places; beyond the points their last value, slope zero."""
    count, columns = values.shape
    slopes = np.empty_like(values)
    for n in range(count):
        for k in range(columns):
            slopes[n, k] = _slope(values, n, k)
    read = np.empty((at.size, columns))
    slope = np.zeros((at.size, columns))
    for m in range(at.size):
        place = (at[m] - first) / spacing
        n = min(max(int(place), 0), count - 2)
        t = min(max(place - n, 0.0), 1.0)
        inside = t == place - n
        for k in range(columns):
            here, rise = values[n, k], values[n + 1, k] - values[n, k]
            one, two = slopes[n, k], slopes[n + 1, k]
            bend, twist = 3 * rise - 2 * one - two, one + two - 2 * rise
            read[m, k] = here + t * (one + t * (bend + t * twist))
            if inside:
                slope[m, k] = (one + t * (2 * bend + 3 * t * twist)) / spacing
    return read, slope
