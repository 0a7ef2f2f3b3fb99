"""Sums over the neighbours of each place, near ones counting more.

They are what `scipy.interpolate.RBFInterpolator` gives, which a test compares. Contacts are asked
for tens of thousands of times in a solution, so that its time is felt.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels._jit import kernel

FloatArray = NDArray[np.float64]


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
