"""The load-dependent loss as a test rig forms it: the total loss less that without torque.

Both are found at one speed and oil inlet temperature, each at the temperatures it settles at. The
loaded oil is hotter and drags less, so that this is less than the loss that depends on the load.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.operating import AXES
from epicyclic.sweeps.journal import Rows

Points = tuple[dict[str, Any], ...]

LoadDependent = Literal["computed", "as-tested"]
"""What load-dependent losses are: the sum of the losses that depend on the load, or as above."""
COMPUTED: LoadDependent = "computed"
AS_TESTED: LoadDependent = "as-tested"


def with_unloaded(points: Sequence[Mapping[str, Any]]) -> tuple[Points, NDArray[np.intp]]:
    """Points, behind them the same without torque, each once.

    Returns
    -------
    tuple of mapping
        Keys that each point changes.
    ndarray of int, shape (n,)
        Number of the one without torque that belongs to each of the `points`.
    """
    added: dict[tuple[tuple[str, str], ...], tuple[int, dict[str, Any]]] = {}
    numbers = []
    for point in points:
        unloaded = {**point, AXES["torque"]: "0 N*m"}
        alike = tuple(sorted((key, str(value)) for key, value in unloaded.items()))
        number, _ = added.setdefault(alike, (len(points) + len(added), unloaded))
        numbers.append(number)
    behind = (unloaded for _, unloaded in added.values())
    return (*map(dict, points), *behind), np.array(numbers, dtype=np.intp)


def as_tested(rows: Rows, unloaded: NDArray[np.intp]) -> NDArray[np.float64]:
    """Load-dependent losses of points from `with_unloaded`. Theory (P9).

    NaN where a point or its partner failed. [W]
    """
    total = rows.numbers("total")
    return total[: unloaded.size] - total[unloaded]
