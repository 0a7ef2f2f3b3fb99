"""Models fitted to the simulated contacts of an oil: their forms, their file, those built in."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, lru_cache
from importlib import metadata
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from packaging.version import InvalidVersion, Version
from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from epicyclic import library
from epicyclic.arrays import FloatArray
from epicyclic.contact.line_contact import CONDITIONS, LineContacts, contacts_at
from epicyclic.dataclass import dataclass
from epicyclic.errors import InputError, Problem
from epicyclic.files import read_text, sealed, unsealed
from epicyclic.kernels import mixed_ehl as talbot
from epicyclic.kernels.interpolation import covariance_sums, covariances
from epicyclic.kernels.line_contact import eyring_means, pan_hamrock_central_film
from epicyclic.oil.oil import Oil

# The regressions of Talbot (2012) as forms: his formulas, with coefficients to be fitted.

SMALLEST_SLIP = 1e-4  # Slide-to-roll ratio put into the logarithms. [1]
SMALLEST_SINGULAR = 1e-10
"""Singular value over the largest one below which columns count as dependent. [1]"""


@dataclass(frozen=True)
class Regression:
    """Branches in the film ratio, each exp of a sum, blended where they meet. Theory (O3)."""

    name: str
    title: str
    # ln of the quantity in each branch, from coefficients and groups, and how many coefficients.
    branches: tuple[tuple[Callable[..., Any], int], ...]
    limits: tuple[float, ...]  # Film ratios at which branches meet.
    # From conditions to the unit of the quantity.
    scale: Callable[[LineContacts], FloatArray | float]
    groups: Callable[[LineContacts], Sequence[Any]]  # From conditions to those of the branches.

    @property
    def size(self) -> int:
        """Number of coefficients of all branches."""
        return sum(size for _, size in self.branches)

    def value(self, states: LineContacts, coefficients: FloatArray) -> FloatArray:
        """See the class."""
        logarithm: Any = 0.0
        for (formula, size), share in zip(self.branches, self._weights(states), strict=True):
            logarithm += share * formula(coefficients[:size], self.groups(states))
            coefficients = coefficients[size:]
        value: FloatArray = np.exp(logarithm) * self.scale(states)
        return value

    def fit(self, states: LineContacts, target: FloatArray, weight: FloatArray) -> FloatArray:
        """Linear least squares of the logarithm, all branches at once.

        Raises `ValueError` if a branch has fewer contacts than coefficients.
        """
        parts = zip(self.branches, self._weights(states), strict=True)
        if any(np.count_nonzero(share) <= size for (_, size), share in parts):
            raise ValueError("too few contacts in a range of film ratios")
        matrix = np.sqrt(weight)[:, None] * self._matrix(states)
        size = np.sqrt((matrix**2).mean(axis=0))
        logarithm = np.sqrt(weight) * np.log(target / self.scale(states))
        found, *_ = np.linalg.lstsq(matrix / size, logarithm, rcond=SMALLEST_SINGULAR)
        coefficients: FloatArray = found / size
        return coefficients

    def _matrix(self, states: LineContacts) -> FloatArray:
        """Columns of all branches, each times the share of its branch, shape (n, size)."""
        columns = [
            share * formula(coefficients, self.groups(states))
            for (formula, size), share in zip(self.branches, self._weights(states), strict=True)
            for coefficients in np.eye(size)
        ]
        return np.stack(columns, axis=1)

    def _weights(self, states: LineContacts) -> list[FloatArray]:
        """Share of each branch, blended as (F4)."""
        above = [_blend(states.film_ratio, limit) for limit in self.limits]
        edges = [np.ones(states.film_ratio.shape), *above, np.zeros(states.film_ratio.shape)]
        return [low * (1 - high) for low, high in pairwise(edges)]


def _blend(ratio: FloatArray, limit: float) -> FloatArray:
    """Weight of the branch above `limit`. Theory (F4)."""
    width = talbot.BLEND_HALF_WIDTH
    t = np.clip((np.log(ratio / limit) + width) / (2 * width), 0, 1)
    return t * t * (3 - 2 * t)


class RegressionGroups(NamedTuple):
    """Groups of the source, in its letters, shape (n,)."""

    s: FloatArray
    u: FloatArray
    g: Any
    p: FloatArray
    r: FloatArray
    s_co: FloatArray
    s_eq: FloatArray
    lam: FloatArray


@lru_cache(maxsize=2)  # friction and rolling of a mesh ask for the same ones
def regression_groups(states: LineContacts) -> RegressionGroups:
    """The groups of every contact."""
    flanks = states.flanks
    return RegressionGroups(
        s=states.slide_to_roll_ratio,
        u=states.speed_number,
        g=states.material_number,
        p=states.hertz_pressure / flanks.equivalent_modulus,
        r=states.radius / states.hertz_half_width,
        s_co=states.composite_roughness / states.radius,
        s_eq=flanks.reduced_roughness / states.radius,
        lam=states.film_ratio,
    )


def at_each(kernel: Callable[..., FloatArray], states: LineContacts) -> FloatArray:
    """A kernel of the groups at every contact, of one point or of several."""
    groups = np.broadcast_arrays(*regression_groups(states))
    found = kernel(*(group.flatten() for group in groups)).reshape(groups[0].shape)
    return found.view(type(states.line_load))


def _groups(states: LineContacts) -> RegressionGroups:
    """The groups with a slip that has a logarithm."""
    groups = regression_groups(states)
    return groups._replace(s=np.maximum(groups.s, SMALLEST_SLIP))


def rolling_scale(states: LineContacts) -> FloatArray:
    """mu u_r^2: the power per length that turns the number of Eq. 5.10 into W/m. Theory (R4).

    A documented reconstruction. The source prints 1e5 W/m, with which the rolling loss exceeds the
    input power; mu u_r^2 is the only natural scale of the problem, reproduces the published
    totals, and agrees with smooth EHL solutions within about a factor of two.
    """
    scale: FloatArray = states.dynamic_viscosity * states.rolling_speed**2
    return scale


def _needle_contact(states: LineContacts) -> Sequence[Any]:
    """What `log_needle_loss` takes."""
    return (
        states.hertz_pressure, states.rolling_speed, states.dynamic_viscosity,
        states.pressure_viscosity, states.radius, states.composite_roughness,
        states.flanks.equivalent_modulus,
    )  # fmt: skip


FRICTION_REGRESSION = Regression(
    "regression", "form of Talbot (2012), Eq. 5.8",
    (
        (talbot.log_mu_boundary, len(talbot.FRICTION_BOUNDARY)),
        (talbot.log_mu_mixed, len(talbot.FRICTION_MIXED)),
        (talbot.log_mu_full_film, len(talbot.FRICTION_FULL_FILM)),
    ),
    (talbot.FRICTION_BOUNDARY_LIMIT, talbot.FRICTION_FULL_FILM_LIMIT), lambda _: 1.0, _groups,
)  # fmt: skip
ROLLING_REGRESSION = Regression(
    "regression", "form of Talbot (2012), Eq. 5.10",
    (
        (talbot.log_rolling_mixed, len(talbot.ROLLING_MIXED)),
        (talbot.log_rolling_film, len(talbot.ROLLING_FILM)),
    ),
    (talbot.ROLLING_LIMIT,), rolling_scale, _groups,
)  # fmt: skip
NEEDLE_REGRESSION = Regression(
    "regression", "form of Talbot (2012), Eq. 3.5",
    ((talbot.log_needle_loss, len(talbot.NEEDLE_FILM)),), (), lambda _: 1.0, _needle_contact,
)  # fmt: skip


# Forms with physical structure: smooth over all film ratios, and safe to continue beyond the data.
#
# Friction is that of a sheared film and of the asperities that touch through it, rolling loss that
# of a smooth contact times what the roughness adds. Both have few coefficients, each with a
# meaning, and neither falls when the film becomes thinner. Both see the roughness of each surface:
# a polished one keeps the ridges of the other from meeting any, and a rough surface that moves
# slower than the oil touches more than one that moves faster.

EYRING_STRESS = 5e6  # Unit of the stress of the fit. [Pa]
SLOPE_RATIO, TRANSITION = 0.41, 0.38e9
"""The two slopes of the closed form are those of the default of the solver: slope at high over that
at low pressure [1], and where they meet [Pa]."""
LIGHT_LOAD = 0.6
"""M of Moes at which the pressure is half that of Hertz, found for smooth contacts. [1]"""
HALF_WIDTH = 0.2e-3  # Unit of the half-width. [m]
TOUCHING = 40e-9  # Unit of the film at which surfaces touch: that of the default of the solver. [m]
CORRELATION_LENGTH = 20e-6  # Length over which roughness is alike, that of the simulations. [m]
SAME_MOTION = 0.1
"""Slide-to-roll ratio at which half of the effect of which surface is faster is there. [1]"""

FIT_TOLERANCE = 1e-5
"""Relative gain of a step in the sum of squares at which a fit ends: what the data do not tell
apart, such as size and exponent of a roughness that adds next to nothing, need not be found. [1]"""
TINY = 1e-12  # Roughness of a smooth surface, which has a logarithm. [m]
SMALLEST_FITTED_SLIP = 0.01
"""Added to the slide-to-roll ratio where it is raised to a power or has a logarithm. [1]"""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_COSINES = np.cos(math.pi / 4 * (_NODES + 1))
"""Pressure over the highest at the points of the quadrature over half a contact. [1]"""


@dataclass(frozen=True)
class Structured:
    """A form that is not linear in its coefficients."""

    name: str
    title: str
    labels: tuple[str, ...]  # What each coefficient is.
    start: tuple[float, ...]  # Where the fit begins.
    low: tuple[float, ...]  # Bounds of the fit, which keep the form monotone.
    high: tuple[float, ...]  # See `low`.
    # From conditions and coefficients to the quantity at every contact, shape (n,).
    value: Callable[[LineContacts, FloatArray], FloatArray]

    @property
    def size(self) -> int:
        """Number of coefficients."""
        return len(self.labels)

    def allows(self, coefficients: Sequence[float]) -> bool:
        """Whether coefficients are within the bounds of the fit."""
        return all(
            low <= value <= high
            for low, value, high in zip(self.low, coefficients, self.high, strict=True)
        )

    def fit(self, states: LineContacts, target: FloatArray, weight: FloatArray) -> FloatArray:
        """Coefficients by least squares of the logarithm.

        Raises `ValueError` if there are fewer contacts than coefficients, or nothing is found.
        """
        from scipy.optimize import least_squares

        if target.size <= self.size:
            raise ValueError("too few contacts")
        logarithm, root = np.log(target), np.sqrt(weight)

        def lack(coefficients: FloatArray) -> FloatArray:
            value = np.maximum(self.value(states, coefficients), np.finfo(float).tiny)
            residual: FloatArray = root * (np.log(value) - logarithm)
            return residual

        found = least_squares(
            lack, self.start, bounds=(self.low, self.high), x_scale="jac", ftol=FIT_TOLERANCE,
            max_nfev=400,
        )  # fmt: skip
        if not found.success:
            raise ValueError(f"least squares failed: {found.message}")
        coefficients: FloatArray = found.x
        return coefficients


def eyring_friction(
    states: LineContacts,  # n of them.
    stress: float,  # tau_0. [Pa]
    light_load: float = LIGHT_LOAD,  # M of Moes at which the pressure is half that of Hertz. [1]
) -> FloatArray:
    """Friction of an Eyring fluid under the pressure of Hertz in an even film. Theory (O4). [1]"""
    film = states.radius * pan_hamrock_central_film(
        states.speed_number, states.material_number, states.load_number
    )
    rate = states.dynamic_viscosity * np.abs(states.sliding_speed) / (film * stress)
    highest = states.hertz_pressure / (1 + light_load / states.moes_load)
    slope = states.pressure_viscosity * np.ones(rate.shape)
    mean = eyring_means(rate, highest, slope, SLOPE_RATIO, TRANSITION, _COSINES, _WEIGHTS)
    return mean * stress / highest


def _pairing(states: LineContacts) -> FloatArray:
    """Roughness of the smoother over that of the rougher surface, 1 without any. [1]"""
    one, two = states.roughness
    ratio: FloatArray = np.minimum(one, two) / np.maximum(np.maximum(one, two), TINY)
    return np.where(np.maximum(one, two) > 0, ratio, 1.0) + np.zeros(states.radius.shape)


def _faster(states: LineContacts) -> FloatArray:
    """ln of the roughness of the faster over that of the slower surface, less with less slip. [1]

    Theory (O12).
    """
    one, two = (np.maximum(roughness, TINY) for roughness in states.roughness)
    slip = states.slide_to_roll_ratio
    sense = np.sign(states.sliding_speed) * slip / (slip + SAME_MOTION)
    difference: FloatArray = np.log(one / two) * sense
    return difference


def _flattened(states: LineContacts) -> FloatArray:
    """The group by which a contact flattens its roughness, nabla. Theory (O14). [1]"""
    shortest = CORRELATION_LENGTH / states.hertz_half_width
    viscosity = states.material_number * (2 * states.speed_number) ** 0.25
    group: FloatArray = shortest * np.sqrt(states.moes_load**1.5 / viscosity)
    return group


def _friction(states: LineContacts, c: FloatArray) -> FloatArray:
    """A sheared film and, the more the thinner it is, touching asperities. Theory (O5). [1]"""
    stress, light, factor, flat, pairing, faster, steep, wide_part, touching, level = c[:10]
    dry, wide, slip = c[10:]
    film = math.exp(factor) * eyring_friction(
        states, EYRING_STRESS * math.exp(stress), math.exp(light)
    )
    composite = np.maximum(states.composite_roughness, TINY)
    roughness = (
        composite
        * _flattened(states) ** -flat
        * _pairing(states) ** pairing
        * np.exp(faster * _faster(states))
    )
    gap = (states.film_ratio * states.composite_roughness - touching * TOUCHING) / roughness
    width = math.exp(wide_part)
    odds = level - math.exp(steep) * width * np.arcsinh(gap / width)
    half_width = states.hertz_half_width / HALF_WIDTH
    asperities = (
        dry * half_width**wide * (states.slide_to_roll_ratio + SMALLEST_FITTED_SLIP) ** slip
    )
    share = (1 + np.tanh(odds / 2)) / 2
    friction: FloatArray = film + np.maximum(asperities - film, 0.0) * share
    return friction


def _rolling(states: LineContacts, c: FloatArray) -> FloatArray:
    """A smooth contact, and what roughness adds. Theory (O7). [W/m]"""
    factor, speed, material, load, light, pairing, rough, thinness, slip, width, most, held = c
    smooth = (
        2 * states.rolling_speed * states.radius / states.pressure_viscosity
        * np.exp(factor)
        * (states.speed_number * 1e11) ** speed
        * (states.material_number / 3e3) ** material
        * (states.load_number * 1e4) ** load
        / (1 + math.exp(light) / states.moes_load)
    )  # fmt: skip
    thickness = states.film_ratio * _pairing(states) ** -pairing
    added = (
        math.exp(rough)
        * thickness**-thinness
        * (SMALLEST_FITTED_SLIP + states.slide_to_roll_ratio) ** slip
        * (states.hertz_half_width / HALF_WIDTH) ** width
        / (1 + (math.exp(most) * thickness) ** (-held * thinness))
    )
    loss: FloatArray = smooth * (1 + added)
    return loss


STRUCTURED_FRICTION = Structured(
    name="structured",
    title="Eyring film, and asperities by film and flattened roughness",
    labels=(
        "ln of the Eyring stress over 5 MPa", "ln of the load number at half the pressure",
        "ln of the film's factor", "exponent of the flattening", "exponent of the pairing",
        "exponent of the faster roughness", "ln of the steepness of the shares",
        "ln of the range of even steepness", "film at which surfaces touch, over 40 nm",
        "ln of the odds of touching there", "friction where all is dry, at a half-width of 0.2 mm",
        "exponent of the half-width in it", "exponent of the slip in it",
    ),
    start=(0.2, -0.8, -0.2, 0.4, 0.2, 0.0, 2.0, 1.0, 0.75, 0.0, 0.06, -0.2, -0.1),
    low=(-3.0, -3.0, -2.0, 0.0, 0.0, -1.0, -3.0, -2.0, 0.0, -6.0, 0.0, -2.0, -1.0),
    high=(3.0, 2.0, 2.0, 2.0, 3.0, 1.0, 5.0, 4.0, 4.0, 8.0, 1.0, 2.0, 1.0),
    value=_friction,
)  # fmt: skip
STRUCTURED_ROLLING = Structured(
    name="structured",
    title="smooth contact and what roughness adds, by film ratio and pairing",
    labels=(
        "ln of the factor", "exponent of U", "exponent of G", "exponent of W",
        "ln of the load number at half the loss", "exponent of the pairing",
        "ln of what roughness adds", "exponent of the thinness", "exponent of the slip",
        "exponent of the half-width", "ln of one over the film ratio of half of that",
        "share of the thinness that is lost in thinner films",
    ),
    start=(-10.0, 0.75, 1.2, 0.05, -1.0, 0.1, 1.0, 1.5, 0.8, 0.8, 1.5, 0.5),
    low=(-30.0, 0.2, -1.0, -1.0, -6.0, 0.0, -20.0, 0.0, 0.0, -3.0, -3.0, 0.0),
    high=(10.0, 1.5, 3.0, 1.0, 4.0, 3.0, 12.0, 6.0, 2.0, 3.0, 9.0, 1.0),
    value=_rolling,
)  # fmt: skip


# What simulations near a contact have over a structured form: its smooth correction.
#
# Far from all simulations nothing is corrected.

MOST_SIMULATIONS = 512
"""As many of a larger campaign take part: each costs time wherever the fit is used."""
LENGTH = 2.0
"""Standard deviations of a coordinate over which what a form lacks is alike. Chosen on the contacts
of `atf-dexron-ulv`, as is `NOISE`. [1]"""
NOISE = (0.08 / 0.2) ** 2  # Variance of what no neighbour knows over that of what a form lacks. [1]
SMOOTH = 10e-9  # Roughness that counts as none, which has no logarithm. [m]
LARGEST_EXCESS = 3.0
"""A form is not corrected by more than a factor of 20, the logarithm of which this is. [1]"""
DIGITS = 5  # Significant digits in a file.


class _Data(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, defer_build=True)


class NearbySimulations(_Data):
    """Simulations that correct a form between them. Theory (O15)."""

    # Conditions of each simulation, SI, the slide-to-roll ratio with its sign.
    conditions: dict[str, tuple[float, ...]]
    # ln of the simulated quantity over that of the form. [1]
    excess: tuple[float, ...] = Field(min_length=1, max_length=MOST_SIMULATIONS)
    weight: tuple[float, ...]  # What each counts. [1]
    equivalent_modulus: float = Field(gt=0)  # Equivalent modulus of all. [Pa]

    @model_validator(mode="after")
    def _check(self) -> NearbySimulations:
        if set(self.conditions) != set(CONDITIONS):
            raise ValueError(f"the conditions must be {', '.join(CONDITIONS)}")
        columns = (*self.conditions.values(), self.weight)
        if any(len(column) != len(self.excess) for column in columns):
            raise ValueError("conditions, excess and weight must have the same length")
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
        """What `states` have over a form. Raises `ValueError` if one is too far off to correct."""
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
        return (_coordinates(states) - centre) / spread

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
        return np.linalg.solve(alike + noise, np.array(self.excess))

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
        np.log(states.slide_to_roll_ratio + SMALLEST_FITTED_SLIP),
    )
    return np.column_stack(np.broadcast_arrays(*columns))


def _rounded(values: FloatArray) -> tuple[float, ...]:
    return tuple(float(f"{value:.{DIGITS}g}") for value in values)


# The file of the models fitted for an oil: it says what was simulated, what fits, and how well.

Form = Regression | Structured

FORMAT: Literal["epicyclic oil model 4"] = "epicyclic oil model 4"
"""Name and version of the file format."""
FORMS: dict[str, dict[str, Form]] = {
    "friction": {form.name: form for form in (STRUCTURED_FRICTION, FRICTION_REGRESSION)},
    "rolling_loss": {form.name: form for form in (STRUCTURED_ROLLING, ROLLING_REGRESSION)},
    "bearing_rolling_loss": {form.name: form for form in (STRUCTURED_ROLLING, NEEDLE_REGRESSION)},
}
"""Forms of every quantity by name, the one that is used by default first."""
REGIMES: dict[str, tuple[float, float]] = {
    "all": (0.0, np.inf),
    "film ratio up to 0.7": (0.0, 0.7),
    "film ratio 0.7 to 3": (0.7, 3.0),
    "film ratio above 3": (3.0, np.inf),
}
"""Ranges of the film ratio for which errors are stated. [1]"""
LARGEST_FILE = 5_000_000  # A file of coefficients is much smaller. [bytes]


_OF_THE_FILM = {"rolling_speed": False, "roughness1": True, "roughness2": True}
"""Conditions that make films thick, and whether they do so by falling."""
_MAY_BE_ZERO = ("slide_to_roll_ratio", "roughness1", "roughness2")


class FitError(_Data):
    """Errors of contacts that the fit had not seen, |computed/simulated - 1|. Theory (O8)."""

    regime: str  # One of `REGIMES`.
    contacts: int = Field(ge=0)
    median: float = Field(ge=0)  # [1]
    largest_of_90_percent: float = Field(ge=0)  # [1]


class FittedForm(_Data):
    """Coefficients of a form, its correction, and its cross-validated errors."""

    form: str
    coefficients: tuple[float, ...]
    errors: tuple[FitError, ...]  # With the correction, if there is one.
    nearby: NearbySimulations | None = None  # What corrects a structured form.


class QuantityFit(_Data):
    """What was fitted to one quantity."""

    unit: str
    contacts: int = Field(ge=1)  # Simulations behind it.
    # Lowest and highest value of every condition among them, SI.
    domain: dict[str, tuple[float, float]]
    forms: tuple[FittedForm, ...] = Field(min_length=1)  # The one that is used by default first.
    left_out: dict[str, str] = {}  # Forms that could not be fitted, and why.

    @model_validator(mode="after")
    def _check_domain(self) -> QuantityFit:
        if set(self.domain) != set(CONDITIONS):
            raise ValueError(f"the domain must have {', '.join(CONDITIONS)}")
        for name, (low, high) in self.domain.items():
            if not 0 <= low <= high or (low == 0 and name not in _MAY_BE_ZERO):
                raise ValueError(
                    f"the domain of {name} must be increasing and above zero: {low:g} to {high:g}"
                )
        return self


class OilModel(_Data):
    """Friction and rolling loss of an oil."""

    format: Literal["epicyclic oil model 4"]  # `FORMAT`.
    version: str  # Version of this package, which solved the contacts.
    # Tables of a line contact that all simulations shared; the oil is one of them.
    settings: dict[str, Any]
    designs: tuple[dict[str, Any], ...]  # The simulated points.
    seed: int  # Seed of the profiles; of several campaigns that of the first one.
    # Command that makes the simulations; of several campaigns one after the other.
    command: str = ""
    simulations: dict[str, int]  # How many were simulated, failed, and were fitted.
    notes: tuple[str, ...] = ()  # What to know before using it.
    equivalent_modulus: float = Field(gt=0)  # E_eq of the simulations. [Pa]
    fits: dict[str, QuantityFit]  # By quantity, the keys of `FORMS`.

    def __hash__(self) -> int:
        # of a few fields: all of them take longer than what is looked up by it
        return hash((self.version, self.seed, self.command, self.equivalent_modulus))

    @model_validator(mode="after")
    def _check_fits(self) -> OilModel:
        try:
            _ = self.oil
        except (KeyError, TypeError) as error:
            raise ValueError("the settings have no oil") from error
        for quantity, fit in self.fits.items():
            known = FORMS.get(quantity)
            if known is None:
                raise ValueError(f"there is no quantity {quantity}")
            if quantity != "bearing_rolling_loss":  # any of two gears may be the rougher one
                one, two = fit.domain["roughness1"], fit.domain["roughness2"]
                both = (min(one[0], two[0]), max(one[1], two[1]))
                fit.domain.update(roughness1=both, roughness2=both)
            for fitted in fit.forms:
                form = known.get(fitted.form)
                if form is None or form.size != len(fitted.coefficients):
                    raise ValueError(f"{quantity}: wrong coefficients of form {fitted.form}")
                if isinstance(form, Structured) and not form.allows(fitted.coefficients):
                    raise ValueError(f"{quantity}: {fitted.form} coefficients out of bounds")
                if isinstance(form, Regression):
                    check_resistance(
                        quantity, form, fitted.coefficients, fit.domain, self.equivalent_modulus
                    )
        return self

    @field_validator("version")
    @classmethod
    def _check_version(cls, version: str) -> str:
        own = metadata.version("epicyclic")
        try:
            if Version(version) <= Version(own):
                return version
        except InvalidVersion:
            pass
        raise ValueError(f"made by version {version[:40]}; this is {own}")

    def to_text(self) -> str:
        """What its file holds."""
        return sealed(self.model_dump(mode="json"), indent=2)

    @cached_property
    def oil(self) -> Oil:
        """The oil that was simulated."""
        return Oil.model_validate(self.settings["lubricant"]["oil"])

    def value(
        self,
        quantity: str,  # A key of `fits`.
        states: LineContacts,
        form: str = "",  # By default the first one of the file.
    ) -> FloatArray:
        """A quantity at every contact, conditions held in the domain. Theory (O2)."""
        fit = self.fits[quantity]
        fitted = next((item for item in fit.forms if item.form == form), fit.forms[0])
        coefficients = np.array(fitted.coefficients)
        limits = dict(fit.domain)
        if fitted.form == STRUCTURED_FRICTION.name and quantity == "friction":
            # (O5) goes on to no sliding
            limits["slide_to_roll_ratio"] = (0.0, limits["slide_to_roll_ratio"][1])
        held = states.held(limits)
        value = FORMS[quantity][fitted.form].value(held, coefficients)
        if fitted.nearby is not None:
            value = value * fitted.nearby.factor(held)
        return value


def check_resistance(
    quantity: str,
    form: Form,
    coefficients: Sequence[float],
    domain: Mapping[str, tuple[float, float]],
    equivalent_modulus: float,
) -> None:
    """Raise `ValueError` unless friction and losses are above zero and below what the load can do.

    In thin, middling and thick films of the domain. Coefficients themselves have no natural size,
    those of products of groups up to 1e10.
    """
    middle = {name: math.sqrt(low * high) or high / 2 for name, (low, high) in domain.items()}
    conditions = {name: np.full(3, value) for name, value in middle.items()}
    for name, falling in _OF_THE_FILM.items():
        low, high = domain[name][0] or middle[name], domain[name][1]
        conditions[name][::2] = (high, low) if falling else (low, high)
    with np.errstate(all="ignore"):  # what is no number is refused
        states = contacts_at(**conditions, equivalent_modulus=equivalent_modulus)
        shares = form.value(states, np.array(coefficients))
        if quantity != "friction":  # a loss
            shares = shares / (states.line_load * states.rolling_speed)
    worst = shares[np.argmax(np.abs(np.nan_to_num(shares, nan=np.inf) - 0.5))]
    if not 0 < worst <= 1:
        raise ValueError(
            f"{quantity}: {form.name} coefficients give a resistance of {worst:.3g} times the "
            "load within the domain, which must be above 0 and at most 1"
        )


def read_oil_model(path: str | Path) -> OilModel:
    """The models in a file.

    Raises `InputError` if there is no such file, or it is not one of these, or damaged.
    """
    file = Path(path)
    try:
        stat = file.stat()
        # clocks jump: the time alone does not tell a file from one written later
        state = (stat.st_ino, stat.st_ctime_ns, stat.st_mtime_ns, stat.st_size)
        return _read(file.absolute(), state)
    except OSError as error:
        raise _file_error(file, f"cannot be read: {error.strerror}.") from None


@lru_cache(maxsize=64)
def _read(path: Path, _state: tuple[int, ...]) -> OilModel:
    """The file as it was when it was last changed."""
    try:
        content = unsealed(read_text(path, "oil model", LARGEST_FILE))
        return OilModel.model_validate_json(json.dumps(content))
    except InputError as error:
        raise _file_error(path, error.problems[0].allowed) from None
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        where = f" at {place}" if place else ""
        raise _file_error(path, f"is not a valid oil model{where}: {first['msg']}.") from None


def _file_error(path: Path, allowed: str) -> InputError:
    remedy = "Give a model.json from 'epicyclic oil characterise' of this version."
    return InputError([Problem("models.oil_model", str(path), allowed, remedy)], str(path))


# The fitted models that come with the package, for oils whose properties are those simulated.

_SIMULATED = (
    "kinematic_viscosity",
    "density",
    "density_slope",
    "pressure_viscosity",
    "thermal_conductivity",
    "specific_heat_capacity",
)
"""Properties that a solved contact depends on."""


def builtin_model(
    oil: Oil,  # One that only bears the name, or of which a property was changed, has no models.
) -> OilModel | None:
    """The models of a library oil; None if there are none, or the oil is not that of the library.

    `lubricant.pressure_viscosity_factor` of a case makes no other oil: the coefficient is a
    condition of every contact, and the domain of the fits tells how far it may be off.

    Examples
    --------
    >>> builtin_model(Oil(
    ...     kind="mineral",
    ...     kinematic_viscosity=[
    ...         {"temperature": "40 degC", "value": "100 mm^2/s"},
    ...         {"temperature": "100 degC", "value": "11 mm^2/s"},
    ...     ],
    ...     density=[{"temperature": "15 degC", "value": "890 kg/m^3"}],
    ...     pressure_viscosity={"law": "gold", "s": 9.904, "t": 0.139},
    ... )) is None
    True
    """
    file = library.oil_model_file(oil.name)
    return None if file is None or changed_properties(oil) else read_oil_model(file)


@lru_cache(maxsize=64)
def changed_properties(oil: Oil) -> tuple[str, ...]:
    """Properties in which an oil differs from the one of its name that was simulated.

    Wherever their values are from; none if no oil of this name was.
    """
    file = library.oil_model_file(oil.name)
    if file is None:
        return ()
    # only the oil: to check all fits takes much longer, and most cases of such an oil use none
    settings = unsealed(read_text(file, "oil model", LARGEST_FILE))["settings"]
    simulated = Oil.model_validate(settings["lubricant"]["oil"])
    own, theirs = (_plain(each.model_dump(include=set(_SIMULATED))) for each in (oil, simulated))
    return tuple(name for name in _SIMULATED if own[name] != theirs[name])


def _plain(value: Any) -> Any:
    """`value` without the sources beside its numbers."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items() if key != "source"}
    return [_plain(item) for item in value] if isinstance(value, list | tuple) else value
