"""Friction models of gear flanks: the general form, the published formulas, those of the user."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact.fitted_models import regression_groups
from epicyclic.contact.line_contact import LineContacts
from epicyclic.gears.flanks import RA_OVER_RQ, RZ_OVER_RA
from epicyclic.kernels.line_contact import (
    hertz_pressure,
    line_load_at_pressure,
    pan_hamrock_central_film,
)
from epicyclic.kernels.mixed_ehl import sliding_friction_at
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.mixed_ehl import TalbotRegression, equally_rough, held_in_table, pairing_ratio
from epicyclic.losses.ranges import OF_THIS_PACKAGE, Range, RegressionFluid, held_in_range
from epicyclic.units import (
    GIGAPASCAL,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    MILLIPASCAL_SECOND,
    NEWTON_PER_MM,
    NUMBER,
    Quantity,
)

# What a friction model is, and quantities that several of them use.


FloatArray = NDArray[np.float64]


class FrictionModel(Protocol):
    """A way to the coefficient of sliding friction at every point of a mesh.

    Attributes
    ----------
    name : str
        Under which a case chooses it.
    title, source : str
        For reports.
    made_for : RegressionFluid or None
        The fluid that it was made for, if it holds for no other.
    takes_oil_temperature : bool
        True if it was fitted to tests by the temperature of their oil, so that the temperature of
        the flanks is contained in it; False if it takes the oil as it enters the contact.
    """

    name: ClassVar[str]
    made_for: ClassVar[RegressionFluid | None]
    takes_oil_temperature: ClassVar[bool]

    @property
    def title(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def ranges(self) -> tuple[Range, ...]:
        """Where the model was made; leaving it is flagged."""
        ...

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """Coefficient of friction at each point of `contact`, shape (n,). [1]"""
        ...


class SolvedFriction(ABC):
    """A friction model that first solves contacts of the mesh, which takes minutes."""

    @abstractmethod
    def solved_for(self, contact: MeshContact) -> FrictionModel:
        """The model with contacts that are solved; those that it has, if they still hold."""

    @property
    @abstractmethod
    def remarks(self) -> tuple[str, ...]:
        """How many contacts were solved, how many not, and the error."""


CONTACT_PROGRESS: ContextVar[Callable[[int, int], None]] = ContextVar(
    "progress", default=lambda *_: None
)
"""Called with the numbers of contacts solved and planned so far, mesh by mesh."""


@contextmanager
def contact_progress(progress: Callable[[int, int], None]) -> Iterator[None]:
    """Let `progress` be called as contacts of meshes are solved."""
    token = CONTACT_PROGRESS.set(progress)
    try:
        yield
    finally:
        CONTACT_PROGRESS.reset(token)


def specific_load(contact: MeshContact) -> float:
    """F_bt/b. Theory (F13). [N/m]"""
    return contact.force / contact.mesh.face_width


def pitch_point_sum_speed(contact: MeshContact) -> float:
    """v_SigmaC = 2 v_t sin(alpha_wt), the sum of the surface speeds at the pitch point. [m/s]

    Theory (F11).
    """
    return 2 * contact.pitch_line_speed * math.sin(contact.mesh.operating_pressure_angle)


def pitch_point_radius(contact: MeshContact) -> float:
    """rho_redC, equivalent radius at the pitch point in the normal section. Theory (F12). [m]"""
    mesh = contact.mesh
    rho1 = mesh.pitch_point
    rho2 = mesh.curvature2(rho1)
    return rho1 * rho2 / ((rho2 + mesh.side * rho1) * math.cos(mesh.gear1.rack.base_helix_angle))


def pitch_point_pressure(contact: MeshContact) -> float:
    """Hertz pressure of F_bt/b on rho_redC. Theory (F18). [Pa]"""
    return hertz_pressure(
        specific_load(contact), pitch_point_radius(contact), contact.flanks.equivalent_modulus
    )


def mean_roughness_ra(contact: MeshContact) -> float:
    """(Ra1 + Ra2)/2 from the rms values of the flanks. Theory (F14). [m]"""
    flanks = contact.flanks
    return RA_OVER_RQ * (flanks.roughness1 + flanks.roughness2) / 2


# Friction formulas fitted to gear and disc tests, each held within the range of its tests.


_NIEMANN = "Niemann and Winter, Maschinenelemente II"
_SPEED = Range("pitch_line_speed", "pitch-line speed", 1.0, 50.0, METRE_PER_SECOND, _NIEMANN)
_LOAD = Range(
    "specific_load", "load for each face width", 150.0, None, NEWTON_PER_MM, _NIEMANN, specific_load
)
_PRESSURE = Range(
    "pitch_point_pressure",
    "Hertz pressure at the pitch point",
    None,
    2.5,
    GIGAPASCAL,
    OF_THIS_PACKAGE,
    pitch_point_pressure,
)
_ROUGHNESS = Range(
    "mean_ra", "mean roughness Ra", None, 5.0, MICROMETRE, OF_THIS_PACKAGE, mean_roughness_ra
)
_GEAR_TESTS = (_SPEED, _LOAD, _PRESSURE)


def _mean_group(contact: MeshContact, load_factor: float = 1.0) -> float:
    """[K (F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 in N/mm, m/s, mm and mPa s, in its range.

    Theory (F19).
    """
    radius, e_eq = pitch_point_radius(contact), contact.flanks.equivalent_modulus
    load = held_in_range(load_factor * specific_load(contact), _LOAD)
    pressure = held_in_range(hertz_pressure(load, radius, e_eq), _PRESSURE)
    load = line_load_at_pressure(pressure, radius, e_eq)
    speed = contact.pitch_line_speed
    sum_speed = pitch_point_sum_speed(contact) * held_in_range(speed, _SPEED) / speed
    group = load * 1e-3 / (sum_speed * radius * 1e3)
    viscosity = contact.oil.dynamic_viscosity * 1e3
    return float(group**0.2 * viscosity**-0.05)


def _held_ra(contact: MeshContact) -> float:
    """Mean Ra of the flanks in its range. [um]"""
    return held_in_range(mean_roughness_ra(contact), _ROUGHNESS) * 1e6


def _relative_roughness(contact: MeshContact) -> float:
    """Ra/d1 in um/mm, as in the X_R of Niemann and Winter; d1 is that of the pinion."""
    pinion = min(contact.mesh.gear1.reference_radius, contact.mesh.gear2.reference_radius)
    return mean_roughness_ra(contact) * 1e6 / (2e3 * pinion)


def _mean_rms(contact: MeshContact) -> float:
    """Mean rms roughness of both flanks. [m]"""
    return (contact.flanks.roughness1 + contact.flanks.roughness2) / 2


class Schlenk:
    """mu = 0.048 [(F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 Ra^0.25 X_L, one value for the mesh.

    Theory (F15).

    N/mm, m/s, mm, mPa s, um; Ra the mean of both flanks. The standard's text was not read; the
    constants agree in several independent implementations.
    """

    name: ClassVar = "schlenk"
    title: ClassVar = "mean friction of ISO/TR 14179-2"
    source: ClassVar = "L. Schlenk, Diss. TU Muenchen (1994); ISO/TR 14179-2:2001"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = True
    ranges: ClassVar[tuple[Range, ...]] = (*_GEAR_TESTS, _ROUGHNESS)

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        rough = _held_ra(contact) ** 0.25
        mu = 0.048 * _mean_group(contact) * rough * contact.oil.lubricant_factor
        return np.full_like(contact.line_load, mu)


@dataclass(frozen=True, slots=True)
class NiemannWinter:
    """mu = 0.045 [K (F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 X_R X_L, X_R = 3.8 (Ra/d1)^0.25.

    Theory (F16).

    N/mm, m/s, mm, mPa s, um; K = K_A K_gamma is `load_factor`. Standard formula from general
    knowledge, its text not read; X_R agrees with the form 2.2 (Ra/rho)^0.25 of DIN 3990-4.
    """

    name: ClassVar = "niemann-winter"
    title: ClassVar = "mean friction after Michaelis, Niemann and Winter"
    source: ClassVar = "K. Michaelis, Diss. TU Muenchen (1987); Niemann and Winter, vol. II"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = True
    RELATIVE_ROUGHNESS: ClassVar = Range(
        "relative_roughness",
        "Ra over reference diameter, um/mm",
        None,
        0.1,
        NUMBER,
        OF_THIS_PACKAGE,
        _relative_roughness,
    )

    load_factor: float = 1.0

    @property
    def ranges(self) -> tuple[Range, ...]:
        """Those of the tests, for the load with its factor."""
        factor = self.load_factor
        return (
            _SPEED,
            replace(_LOAD, of=lambda contact: factor * specific_load(contact)),
            replace(_PRESSURE, of=lambda contact: factor**0.5 * pitch_point_pressure(contact)),
            self.RELATIVE_ROUGHNESS,
        )

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        rough = held_in_range(_relative_roughness(contact), self.RELATIVE_ROUGHNESS)
        group = _mean_group(contact, self.load_factor)
        mu = 0.045 * group * 3.8 * rough**0.25 * contact.oil.lubricant_factor
        return np.full_like(contact.line_load, mu)


def _log_argument(contact: MeshContact) -> FloatArray:
    """29.66 w/(eta v_s v_r^2) of Benedict and Kelley, v_s at 1 % of v_r or above. [1]"""
    rolling = 2 * contact.rolling_speed
    sliding = np.maximum(np.abs(contact.sliding_speed), BenedictKelley.SMALLEST_SLIDING * rolling)
    viscosity = contact.oil.dynamic_viscosity * 1e3
    argument: FloatArray = 29.66 * contact.line_load / (viscosity * sliding * rolling**2)
    return argument


class BenedictKelley:
    """mu = 0.0127 [50/(50 - S)] log10[29.66 w/(eta v_s v_r^2)], local.

    Theory (F7).

    w in N/m, eta in mPa s, v_s and v_r = u1 + u2 in m/s, S rms roughness in microinches. The
    argument of the logarithm is held: below 10, with little load on much oil, it has no meaning;
    above 1e8 the friction of smooth flanks would exceed that of dry steel, 0.10. Near the pitch
    point v_s is kept at 1 % of v_r, because the formula grows without bound there.
    """

    name: ClassVar = "benedict-kelley"
    title: ClassVar = "local friction of Benedict and Kelley"
    source: ClassVar = "G. H. Benedict and B. W. Kelley, ASLE Trans. 4 (1961) 59"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = True

    SMALLEST_SLIDING: ClassVar = 0.01
    MICROINCH: ClassVar = 25.4e-9
    ARGUMENT: ClassVar = Range(
        "log_argument",
        "argument of the logarithm",
        10.0,
        1e8,
        NUMBER,
        OF_THIS_PACKAGE,
        _log_argument,
    )
    ROUGHNESS: ClassVar = Range(
        "mean_rms",
        "mean rms roughness",
        None,
        0.0254 * 100 / 3,
        MICROMETRE,
        "AGMA 925-A03: 50/(50 - S) at most 3",
        _mean_rms,
    )
    ranges: ClassVar[tuple[Range, ...]] = (ARGUMENT, ROUGHNESS)

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        rms = held_in_range(_mean_rms(contact), self.ROUGHNESS) / self.MICROINCH
        argument = held_in_range(_log_argument(contact), self.ARGUMENT)
        mu: FloatArray = 0.0127 * 50 / (50 - rms) * np.log10(argument)
        return mu


# Friction as a mixture of dry and separated contact: mu = xi mu_b + (1 - xi) mu_f.
#
# The share xi of dry contact follows from a film ratio. The coefficients mu_b and mu_f belong to
# the oil and the surfaces; the original works give them from disc tests of single oils, so that
# here they are keys of the case. Film thicknesses are those of smooth, isothermal contacts.


_FILM_SOURCE = "films of Pan and Hamrock, J. Tribol. 111 (1989) 246"
FILM_RANGES = (
    Range("load_number", "load number W", 2.045e-5, 5.0e-4, NUMBER, _FILM_SOURCE),
    Range("speed_number", "speed number U", 1e-12, 5.03e-10, NUMBER, _FILM_SOURCE),
    Range("material_number", "material number G", 2504.0, 15027.0, NUMBER, _FILM_SOURCE),
)
"""Ranges of the film formulas. The shares themselves are within 0 to 1 everywhere. Theory (F8)."""


@dataclass(frozen=True, slots=True)
class _FilmShare(ABC):
    """mu = xi mu_b + (1 - xi) mu_f. Theory (F8)."""

    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = False
    ranges: ClassVar[tuple[Range, ...]] = FILM_RANGES

    boundary: float  # mu_b and mu_f. [1]
    fluid: float  # mu_b and mu_f. [1]

    @abstractmethod
    def share(self, contact: MeshContact) -> FloatArray:
        """Share xi of dry contact. [1]"""

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        dry = self.share(contact)
        return dry * self.boundary + (1 - dry) * self.fluid


@dataclass(frozen=True, slots=True)
class Doleschel(_FilmShare):
    """xi = (1 - lambda/2)^2 for lambda < 2, else 0; lambda = h_c/[(Ra1 + Ra2)/2].

    Theory (F9).
    """

    name: ClassVar = "doleschel"
    title: ClassVar = "film share of Doleschel"
    source: ClassVar = "A. Doleschel, Diss. TU Muenchen (2002)"

    def share(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        film = contact.radius * pan_hamrock_central_film(
            contact.speed_number, contact.material_number, contact.load_number
        )
        ratio = np.minimum(film / mean_roughness_ra(contact), 2.0)
        dry: FloatArray = (1 - ratio / 2) ** 2
        return dry


@dataclass(frozen=True, slots=True)
class Matsumoto(_FilmShare):
    """xi = log10(D)/2 within 0 to 1, D = (Rz1 + Rz2)/h_min. Theory (F10)."""

    name: ClassVar = "matsumoto"
    title: ClassVar = "film share of Matsumoto and Morikawa"
    source: ClassVar = "S. Matsumoto and K. Morikawa, Int. Gear Conf. Lyon (2014) 1078"

    def share(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        rz = RZ_OVER_RA * RA_OVER_RQ * (contact.flanks.roughness1 + contact.flanks.roughness2)
        dry: FloatArray = np.clip(np.log10(rz / contact.minimum_film) / 2, 0.0, 1.0)
        return dry


# Friction formulas fitted to EHL simulations of one fluid each.


@dataclass(frozen=True, slots=True)
class MixedEhl(TalbotRegression):
    """Regression of 33,600 mixed-EHL simulations of an automatic transmission fluid.

    Talbot (2012), Eq. 5.8 and Table 5.2(a); branches in the film ratio blended, conditions
    outside Table 5.1 held at its limits (`mixed_ehl_groups`).
    """

    name: ClassVar = "mixed-ehl"
    title: ClassVar = "mixed-EHL friction regression"
    source: ClassVar = "D. C. Talbot, PhD dissertation, Ohio State (2012), Eq. 5.8"
    takes_oil_temperature: ClassVar[bool] = False

    def coefficient(self, contact: LineContacts) -> FloatArray:
        """See the class. [1]"""
        held = held_in_table(contact, oil_held=self.oil_held)
        return sliding_friction_at(*regression_groups(held))


@dataclass(frozen=True, slots=True)
class PairedFriction(TalbotRegression):
    """`MixedEhl` of two flanks as rough as the rougher one, times the effect of the smoother one.

    Theory (O13).
    """

    name: ClassVar = "mixed-ehl+pairing"
    title: ClassVar = "mixed-EHL friction regression, pairing of unequal flanks from the solver"
    source: ClassVar = f"{MixedEhl.source}; solver for line contacts of this package"
    takes_oil_temperature: ClassVar[bool] = False

    def coefficient(self, contact: LineContacts) -> FloatArray:
        """See the class. [1]"""
        published = MixedEhl(self.oil_held).coefficient(equally_rough(contact))
        coefficient: FloatArray = published * pairing_ratio("friction", contact)
        return coefficient


_SUCCESSOR = "none is in print; that of the later regression, Talbot (2012), Table 5.1"
_REGRESSION_PRESSURE = Range("hertz_pressure", "Hertz pressure", 0.5, 2.5, GIGAPASCAL, _SUCCESSOR)
_REGRESSION_SPEED = Range("rolling_speed", "rolling speed", 1.0, 20.0, METRE_PER_SECOND, _SUCCESSOR)
_RADIUS = Range("radius", "equivalent radius", 5.0, 40.0, MILLIMETRE, _SUCCESSOR)
_VISCOSITY = Range(
    "dynamic_viscosity",
    "dynamic viscosity",
    5.0,
    180.0,
    MILLIPASCAL_SECOND,
    "none is in print; a 75W-90 gear oil from 150 to 25 degC",
)
_REGRESSION_ROUGHNESS = Range(
    "composite_roughness", "composite rms roughness", None, 1.0, MICROMETRE, OF_THIS_PACKAGE
)


class Xu2007:
    """Regression of EHL simulations of a 75W-90 gear oil, full film only.

    Theory (F6).

    Xu, Kahraman, Anderson and Maddock, J. Mech. Des. 129 (2007) 58: with p_h in GPa, u_r in m/s,
    dynamic viscosity in mPa s, composite rms roughness S in um, radius in m. The range of the
    regression was not found in print; conditions are held in the ranges assumed here, because
    exp(b9 exp(S)) and the powers run away.
    """

    name: ClassVar = "xu-2007"
    title: ClassVar = "EHL friction regression of Xu et al."
    source: ClassVar = "Xu, Kahraman, Anderson, Maddock, J. Mech. Des. 129 (2007) 58"
    made_for: ClassVar[RegressionFluid | None] = RegressionFluid("xu-2007", "a 75W-90 gear oil")
    takes_oil_temperature: ClassVar[bool] = False
    ranges: ClassVar[tuple[Range, ...]] = (
        _REGRESSION_PRESSURE,
        _REGRESSION_SPEED,
        _RADIUS,
        _VISCOSITY,
        _REGRESSION_ROUGHNESS,
        Range("film_ratio", "film ratio", 1.0, None, NUMBER, "the regression is for full films"),
    )

    B: ClassVar = (
        -8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305,
    )  # fmt: skip
    SMALLEST_SLIDE_TO_ROLL: ClassVar = 1e-9

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        b1, b2, b3, b4, b5, b6, b7, b8, b9 = self.B
        pressure = held_in_range(contact.hertz_pressure, _REGRESSION_PRESSURE) * 1e-9
        slip = np.maximum(contact.slide_to_roll_ratio, self.SMALLEST_SLIDE_TO_ROLL)
        viscosity = held_in_range(contact.dynamic_viscosity, _VISCOSITY) * 1e3
        roughness = held_in_range(contact.composite_roughness, _REGRESSION_ROUGHNESS) * 1e6
        group = slip * pressure * np.log10(viscosity)
        f = b1 + b4 * group + b5 * np.exp(-group) + b9 * np.exp(roughness)
        mu: FloatArray = (
            np.exp(f)
            * pressure**b2
            * slip**b3
            * held_in_range(contact.rolling_speed, _REGRESSION_SPEED) ** b6
            * viscosity**b7
            * held_in_range(contact.radius, _RADIUS) ** b8
        )
        return mu


# Coefficients of friction that the user gives.


_AXES: dict[str, tuple[str, Quantity]] = {
    "slide_to_roll_ratio": ("slide-to-roll ratio", NUMBER),
    "film_ratio": ("film ratio", NUMBER),
    "hertz_pressure": ("Hertz pressure", GIGAPASCAL),
    "rolling_speed": ("rolling speed", METRE_PER_SECOND),
}
"""Label and display unit of the quantities that a table may have as axes."""


@dataclass(frozen=True, slots=True)
class Constant:
    """The same coefficient everywhere."""

    name: ClassVar = "constant"
    title: ClassVar = "constant friction"
    source: ClassVar = "the case"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = False
    ranges: ClassVar[tuple[Range, ...]] = ()

    value: float

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        return np.full_like(contact.line_load, self.value)


@dataclass(frozen=True, slots=True)
class FrictionMap:
    """Linear interpolation in a table over one or two local quantities, constant beyond it.

    Theory (F17).
    """

    name: ClassVar = "table"
    title: ClassVar = "friction table"
    source: ClassVar = "the case"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = False

    # Name of a quantity of `MeshContact` and its rising points, SI.
    axes: tuple[tuple[str, tuple[float, ...]], ...]
    # Coefficients, one (nested) entry for each point.
    values: tuple[float, ...] | tuple[tuple[float, ...], ...]

    @property
    def ranges(self) -> tuple[Range, ...]:
        """From the first to the last point of every axis."""
        return tuple(
            Range(
                name,
                label,
                _shown(points[0], unit),
                _shown(points[-1], unit),
                unit,
                "[friction_table] of the case",
            )
            for name, points in self.axes
            for label, unit in (_AXES[name],)
        )

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        from scipy.interpolate import RegularGridInterpolator

        points = [np.asarray(axis) for _, axis in self.axes]
        table = RegularGridInterpolator(points, np.asarray(self.values))
        where = [np.clip(getattr(contact, name), axis[0], axis[-1]) for name, axis in self.axes]
        mu: FloatArray = table(np.column_stack(where))
        return mu


def _shown(value: float, unit: Quantity) -> float:
    return unit.to_display(value) if unit.si else value


# Coefficients of sliding friction: one class a model, chosen by name.
#
# =================  ============  ===========================================================
# name               kind          source
# =================  ============  ===========================================================
# mixed-ehl          local         Talbot (2012), Eq. 5.8: regression of mixed-EHL simulations
# mixed-ehl+pairing  local         as above, for flanks of unequal roughness: solver of this package
# xu-2007            local         Xu, Kahraman, Anderson, Maddock (2007): regression, full film
# benedict-kelley    local         Benedict and Kelley (1961)
# matsumoto          local         Matsumoto and Morikawa (2014): film share
# doleschel          local         Doleschel (2002): film share
# schlenk            mean          Schlenk (1994), as in ISO/TR 14179-2
# niemann-winter     mean          Michaelis (1987), as in Niemann and Winter
# constant           mean          the case
# table              local         the case
# =================  ============  ===========================================================


DRY_FRICTION = 0.10
"""Coefficient of dry contact in the film-share models, unless the case has its own. [1]"""


@dataclass(frozen=True, slots=True)
class FrictionSettings:
    """Numbers that some models take from the case."""

    constant: float  # Coefficient of the model constant. [1]
    boundary: float  # Coefficients of dry and of separated contact in the film-share models. [1]
    fluid: float  # Coefficients of dry and of separated contact in the film-share models. [1]
    table: FrictionMap | None = None
    oil_held: bool = True  # False to continue the model mixed-ehl beyond its oil.
    load_factor: float = 1.0  # K_A K_gamma, for the model niemann-winter. [1]


def _table(settings: FrictionSettings) -> FrictionModel:
    if settings.table is None:
        raise ValueError("the friction model 'table' needs a friction_table")
    return settings.table


FRICTION_MODELS: dict[str, Callable[[FrictionSettings], FrictionModel]] = {
    MixedEhl.name: lambda settings: MixedEhl(settings.oil_held),
    PairedFriction.name: lambda settings: PairedFriction(settings.oil_held),
    Xu2007.name: lambda _: Xu2007(),
    BenedictKelley.name: lambda _: BenedictKelley(),
    Matsumoto.name: lambda settings: Matsumoto(settings.boundary, settings.fluid),
    Doleschel.name: lambda settings: Doleschel(settings.boundary, settings.fluid),
    Schlenk.name: lambda _: Schlenk(),
    NiemannWinter.name: lambda settings: NiemannWinter(settings.load_factor),
    Constant.name: lambda settings: Constant(settings.constant),
    FrictionMap.name: _table,
}


def friction_model(name: str, settings: FrictionSettings) -> FrictionModel:
    """The friction model called `name`."""
    return FRICTION_MODELS[name](settings)
