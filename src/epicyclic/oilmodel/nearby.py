"""What simulations near a contact have over a structured form: its smooth correction.

Far from all simulations nothing is corrected.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, model_validator

from epicyclic.contact import CONDITIONS, LineContacts, contacts_at
from epicyclic.kernels.covariance import covariance_sums, covariances
from epicyclic.oilmodel.structured import SMALLEST_SLIP

FloatArray = NDArray[np.float64]

MOST_SIMULATIONS = 512
"""As many of a larger campaign take part: each costs time wherever the fit is used."""
LENGTH = 2.0
"""Standard deviations of a coordinate over which what a form lacks is alike. Chosen on the contacts
of `atf-dexron-ulv`, as is `NOISE`. [1]"""
NOISE = (0.08 / 0.2) ** 2
"""Variance of what no neighbour knows over that of what a form lacks. [1]"""
SMOOTH = 10e-9
"""Roughness that counts as none, which has no logarithm. [m]"""
LARGEST_EXCESS = 3.0
"""A form is not corrected by more than a factor of 20, the logarithm of which this is. [1]"""
DIGITS = 5
"""Significant digits in a file."""


class NearbySimulations(BaseModel):
    """Simulations that correct a form between them. Theory (O15).

    Attributes
    ----------
    conditions : dict of str to tuple of float
        Conditions of each simulation, SI, the slide-to-roll ratio with its sign.
    excess : tuple of float
        ln of the simulated quantity over that of the form. [1]
    weight : tuple of float
        What each counts. [1]
    equivalent_modulus : float
        Equivalent modulus of all. [Pa]
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    conditions: dict[str, tuple[float, ...]]
    excess: tuple[float, ...] = Field(min_length=1, max_length=MOST_SIMULATIONS)
    weight: tuple[float, ...]
    equivalent_modulus: float = Field(gt=0)

    @model_validator(mode="after")
    def _check(self) -> NearbySimulations:
        if set(self.conditions) != set(CONDITIONS):
            raise ValueError(f"the conditions must be {', '.join(CONDITIONS)}")
        columns = (*self.conditions.values(), self.weight)
        if any(len(column) != len(self.excess) for column in columns):
            raise ValueError("conditions, excess and weight must be equally many")
        with np.errstate(all="ignore"):  # what is no number is refused
            sound = bool(np.isfinite(self._places).all())
        if not sound:
            raise ValueError("conditions must be above zero")
        if min(self.weight) <= 0 or max(map(abs, self.excess)) > LARGEST_EXCESS:
            raise ValueError(f"weight must be above 0, excess within {LARGEST_EXCESS:g}")
        return self

    @classmethod
    def of(
        cls,
        states: LineContacts,  # n of them.
        excess: FloatArray,  # See the class.
        weight: FloatArray,  # See the class.
    ) -> NearbySimulations:
        """What `states` have over a form.

        Raises
        ------
        ValueError
            If a form is too far off to be corrected.
        """
        taken = np.arange(excess.size)
        if excess.size > MOST_SIMULATIONS:
            taken = np.sort(np.random.default_rng(0).permutation(taken)[:MOST_SIMULATIONS])
        conditions = states.taken(taken).conditions()
        return cls(
            conditions={name: _rounded(values) for name, values in conditions.items()},
            excess=_rounded(excess[taken]),
            weight=_rounded(weight[taken]),
            equivalent_modulus=states.flanks.equivalent_modulus,
        )

    def factor(self, states: LineContacts) -> FloatArray:
        """By which a form is to be multiplied at every contact, shape (n,). Theory (O15)."""
        excess = covariance_sums(self._placed(states), self._others, self._shares)
        factor: FloatArray = np.exp(excess)
        return factor

    @cached_property
    def _scale(self) -> tuple[FloatArray, FloatArray]:
        """Centre of the coordinates, and what they are divided by."""
        places = _coordinates(self._states)
        spread = places.std(axis=0)
        return places.mean(axis=0), LENGTH * np.where(spread > 0, spread, 1.0)

    def _placed(self, states: LineContacts) -> FloatArray:
        centre, spread = self._scale
        places: FloatArray = (_coordinates(states) - centre) / spread
        return places

    @cached_property
    def _places(self) -> FloatArray:
        """Where the simulations lie, one in each row."""
        return self._placed(self._states)

    @cached_property
    def _others(self) -> FloatArray:
        """The same, one in each column."""
        return np.ascontiguousarray(self._places.T)

    @cached_property
    def _shares(self) -> FloatArray:
        """What each simulation adds where a contact is at its place."""
        alike = np.empty((len(self.excess), len(self.excess)))
        for place, row in zip(self._places, alike, strict=True):
            covariances(place, self._others, row)
        noise = np.diag(NOISE / np.array(self.weight))
        shares: FloatArray = np.linalg.solve(alike + noise, np.array(self.excess))
        return shares

    @property
    def _states(self) -> LineContacts:
        columns = {name: np.array(values) for name, values in self.conditions.items()}
        return contacts_at(**columns, equivalent_modulus=self.equivalent_modulus)


def _coordinates(states: LineContacts) -> FloatArray:
    """Where contacts lie among others, shape (n, 8), by oil and surfaces first."""
    one, two = (np.log(np.maximum(roughness, SMOOTH)) for roughness in states.roughness)
    faster = np.where(states.sliding_speed < 0, two - one, one - two)
    columns = (
        np.log(states.dynamic_viscosity),
        np.maximum(one, two),
        np.abs(one - two),
        faster,
        np.log(states.hertz_pressure),
        np.log(states.radius),
        np.log(states.rolling_speed),
        np.log(states.slide_to_roll_ratio + SMALLEST_SLIP),
    )
    return np.column_stack(np.broadcast_arrays(*columns))


def _rounded(values: FloatArray) -> tuple[float, ...]:
    return tuple(float(f"{value:.{DIGITS}g}") for value in values)
