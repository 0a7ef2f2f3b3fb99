"""Sums over the neighbours of each place, near ones counting more."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels._jit import kernel

__all__ = ["covariance_sums", "covariances"]

FloatArray = NDArray[np.float64]


@kernel
def covariances(place: FloatArray, others: FloatArray, row: FloatArray) -> None:
    """Write 1/(1 + r^2/2) of a place with each of its neighbours to `row`. Theory (O15). [1]

    The rational quadratic covariance of power 1: C. E. Rasmussen and C. K. I. Williams, Gaussian
    Processes for Machine Learning (2006), (4.19).

    Parameters
    ----------
    place : ndarray, shape (k,)
        In units of the length over which things are alike.
    others : ndarray, shape (k, m)
        One neighbour in each column: the inner loop runs along a row.
    row : ndarray, shape (m,)
    """
    row[:] = 1.0
    for k in range(place.size):
        own = place[k]
        for j in range(row.size):
            step = own - others[k, j]
            row[j] += 0.5 * step * step
    for j in range(row.size):
        row[j] = 1.0 / row[j]


@kernel
def covariance_sums(places: FloatArray, others: FloatArray, shares: FloatArray) -> FloatArray:
    """Sum of the shares of all neighbours times their covariance, shape (n,). [1]

    Parameters
    ----------
    places : ndarray, shape (n, k)
    others : ndarray, shape (k, m)
    shares : ndarray, shape (m,)
        What each neighbour adds at its own place.
    """
    sums = np.zeros(places.shape[0])
    row = np.empty(others.shape[1])
    for i in range(places.shape[0]):
        covariances(places[i], others, row)
        total = 0.0
        for j in range(row.size):
            total += shares[j] * row[j]
        sums[i] = total
    return sums
