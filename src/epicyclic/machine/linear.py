"""Systems of as many linear equations as unknowns."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def solution_of(matrix: FloatArray, right: FloatArray) -> FloatArray | None:
    """The solution, refined once; None if the square `matrix` is singular."""
    from scipy.linalg.lapack import dgesv, dgetrs  # a case that is only read needs no algebra

    if not len(right):
        return right
    factors, pivots, found, singular = dgesv(matrix, right)
    if singular:
        return None
    refined: FloatArray = found + dgetrs(factors, pivots, right - matrix @ found)[0]
    return refined
