"""Torques that resolve zero, and how far a map is off between its torques.

Near zero torque the rolling loss rises like a root, and at the torque that just drives the drag
behind a mesh the loss has a kink. A map that is read linearly needs torques there that crowd.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from epicyclic.analysis.solve import solve
from epicyclic.case.case import Case
from epicyclic.case.operating import OPERATING, STATE, STATE_KEY
from epicyclic.case.train import TrainCase
from epicyclic.errors import ConvergenceError, InputError
from epicyclic.maps.interpolation_error import further_values
from epicyclic.units import NEWTON_METRE, format_number, unit_text

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]

RATIO = 2.0
"""Between torques that crowd at zero: a loss that rises like a root is then met to 2 % of the part
that rises. [1]"""
CROWD = 10
"""Torques between zero and the smallest of an even spacing, which is 1000 times the least."""
CHECKED_NEAR_ZERO, CHECKED_BEYOND = 4, 4
"""Intervals on each side of zero, and of all others, in whose middle a map is checked."""
CLOSER_TO_ZERO = (1 / 8, 1 / 32)
"""Where it is checked too in the first interval on each side, from its end at zero. [1]"""


def resolving_zero(
    torques: Iterable[float],
    crowd: int = CROWD,  # How many on each side.
) -> list[float]:
    """`torques`, and on each side of zero that they reach more that crowd there, and zero.

    Returns
    -------
    list of float
        Rising. As given if zero is not among them or between them.

    Examples
    --------
    >>> resolving_zero([0.0, 40.0, 80.0], crowd=4)
    [0.0, 2.5, 5.0, 10.0, 20.0, 40.0, 80.0]
    """
    given = np.unique(np.array(list(torques), dtype=float))
    if not given.size or given[0] > 0 or given[-1] < 0:
        return list(map(float, given))
    ends = [
        side[np.abs(side).argmin()] for side in (given[given < 0], given[given > 0]) if side.size
    ]
    steps = RATIO ** -np.arange(1.0, crowd + 1)
    found = np.concatenate([given, [0.0], *(end * steps for end in ends)])
    return list(map(float, np.unique(found) + 0.0))  # no -0.0


def resolving_texts(torques: Iterable[Any]) -> list[Any]:
    """`torques` with units, and those that resolve zero; as given if one is no torque."""
    given = list(torques)
    try:
        values = [NEWTON_METRE.to_display(NEWTON_METRE.parse(torque)) for torque in given]
    except PydanticCustomError:
        return given
    return [f"{torque!r} {NEWTON_METRE.display}" for torque in resolving_zero(values)]


def torque_interpolation(data: xr.Dataset, case: Case) -> dict[str, str | float]:
    """What a map says of the error of linear interpolation between its torques.

    Measured where it is largest, near zero torque, and at some torques beyond: between torques of
    the map, at the middle one of its speeds and the first value of all other
    axes, the loss is solved directly.

    Returns
    -------
    dict
        ``torque_interpolation_error``, relative [1], and ``torque_interpolation`` in words; nothing
        if there is only one torque, no point can be solved, or one takes minutes.
    """
    torques = data["torque"].values.astype(float)
    speeds = data["speed"].values[data["speed"].values != 0]
    if torques.size < 2 or not speeds.size or _takes_minutes(case):
        return {}
    first = {name: 0 for name in data["total"].dims if name not in ("speed", "torque")}
    speed = float(speeds[speeds.size // 2])
    line = data.sel(speed=speed).isel(first)
    middles = _checked(torques)
    changes = further_values(line) | {OPERATING["speed"].key: OPERATING["speed"].text(speed)}
    if "temperature" in first:
        oil = OPERATING["temperature"]
        changes[oil.key] = oil.text(line["temperature"].item())
    if STATE in first:
        changes[STATE_KEY] = line[STATE].item()
    torque_key = OPERATING["torque"]
    direct = np.array(
        [
            _total(case, changes | {torque_key.key: torque_key.text(float(middle))})
            for middle in middles
        ]
    )
    error = np.abs(np.interp(middles, torques, line["total"].values) / direct - 1)
    if not np.isfinite(error).any():
        return {}
    worst = int(np.nanargmax(error))
    return {
        "torque_interpolation_error": float(f"{error[worst]:.2g}"),
        "torque_interpolation": "linear in the torque, the total loss is off by "
        f"{100 * error[worst]:.2g} % at most, at {format_number(float(middles[worst]), 3)} "
        f"{unit_text(NEWTON_METRE.display)}: {np.isfinite(error).sum()} points between torques "
        f"solved directly, at {format_number(speed)} rpm",
    }


def _checked(torques: FloatArray) -> FloatArray:
    """Middles of the intervals next to zero and of some others, and more of the first on each side.

    There the error is largest near the end at zero.
    """
    low, high = torques[:-1], torques[1:]
    middles = (low + high) / 2
    order = np.argsort(np.abs(middles), kind="stable")
    sides = [order[middles[order] < 0], order[middles[order] >= 0]]
    near = np.concatenate([side[:CHECKED_NEAR_ZERO] for side in sides])
    others = np.setdiff1d(np.arange(middles.size), near)
    places = np.linspace(0, others.size - 1, min(CHECKED_BEYOND, others.size)).astype(int)
    first = np.concatenate([side[:1] for side in sides])
    backwards = middles[first] < 0
    inner = np.where(backwards, high[first], low[first])
    outer = np.where(backwards, low[first], high[first])
    closer = [inner + part * (outer - inner) for part in CLOSER_TO_ZERO]
    found: FloatArray = np.unique(np.concatenate([middles[near], middles[others[places]], *closer]))
    return found


def _total(case: Case, changes: dict[str, Any]) -> float:
    try:
        return solve(case.updated(changes)).total
    except (ConvergenceError, InputError):  # as in the map
        return float("nan")


def _takes_minutes(case: Case) -> bool:
    tables = case.sets.values() if isinstance(case, TrainCase) else (case,)
    models = (getattr(table, "models", None) for table in tables)
    return any(getattr(own, "friction", "") == "ehl-direct" for own in models)
