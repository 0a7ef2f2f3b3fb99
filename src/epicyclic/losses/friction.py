"""Friction models of gear flanks: the general form, the published formulas, those of the user.

=================  ============  ===========================================================
name               kind          source
=================  ============  ===========================================================
mixed-lubrication  local         `epicyclic.losses.mixed_lubrication`: for any oil
mixed-ehl          local         Talbot (2012), Eq. 5.8: regression of mixed-EHL simulations
mixed-ehl+pairing  local         as above, for flanks of unequal roughness: solver of this package
xu-2007            local         Xu, Kahraman, Anderson, Maddock (2007): regression, full film
benedict-kelley    local         Benedict and Kelley (1961)
matsumoto          local         Matsumoto and Morikawa (2014): film share
doleschel          local         Doleschel (2002): film share
schlenk            mean          Schlenk (1994), as in ISO/TR 14179-2
niemann-winter     mean          Michaelis (1987), as in Niemann and Winter
constant           mean          the case
table              local         the case
=================  ============  ===========================================================

A new one is a function with an entry in `FRICTION_MODELS`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import lru_cache
from typing import ClassVar, Protocol, Self

import numpy as np

from epicyclic import library
from epicyclic.arrays import FloatArray, on_grid
from epicyclic.contact.fitted_models import OilModel, at_each, read_oil_model
from epicyclic.contact.line_contact import LineContacts
from epicyclic.dataclass import dataclass, replace
from epicyclic.gears.flanks import RA_OVER_RQ, RZ_OVER_RA
from epicyclic.kernels.line_contact import (
    LEAST_SPEED,
    hertz_pressure,
    line_load_at_pressure,
    pan_hamrock_central_film,
)
from epicyclic.kernels.mixed_ehl import sliding_friction_at
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.mixed_lubrication import RUN_IN, Surfaces, mixed_friction
from epicyclic.losses.ranges import (
    OF_THIS_PACKAGE,
    Formula,
    LossModel,
    Range,
    RegressionFluid,
    held_in_range,
)
from epicyclic.units import (
    CELSIUS,
    GIGAPASCAL,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    MILLIPASCAL_SECOND,
    NEWTON_PER_MM,
    NUMBER,
    PER_GIGAPASCAL,
    Quantity,
)

# The dimensionless groups of Talbot's gear regressions, kept in the range they were made in.
#
# Powers and exponentials of a regression run away outside its data: at a fifth of the lowest
# simulated Hertz pressure Eq. 5.8 gives coefficients of friction above 1, and with pressure,
# radius, roughness and viscosity each a factor of two outside Table 5.1, Eq. 5.10 gives rolling
# losses a million times the power passed on. The conditions are therefore held at the limits of
# Table 5.1, and the pressure, along which the formulas go on smoothly, at half the lowest and twice
# the highest. Beyond a held load or speed, rolling losses go on as `beyond_data` says. Every use
# outside Table 5.1 is flagged.

TALBOT_FLUID = RegressionFluid(
    "talbot-2012", "the automatic transmission fluid of Talbot (2012), atf-talbot-2012"
)

REGRESSION_SOURCE = "D. C. Talbot, PhD dissertation, Ohio State (2012)"
_SOURCE = "Talbot (2012), Table 5.1"
_FLUID_SOURCE = "the fluid of Talbot (2012) at 100 and 25 °C"
_PRESSURE = Range("hertz_pressure", "Hertz pressure", 0.5, 2.5, GIGAPASCAL, _SOURCE)
_HELD_PRESSURE = replace(_PRESSURE, low=0.25, high=5.0)
"""Where the pressure is held: lightly loaded teeth of the very tests lie below Table 5.1."""
_RADIUS = Range("radius", "equivalent radius", 5.0, 40.0, MILLIMETRE, _SOURCE)
_SPEED = Range("rolling_speed", "rolling speed", 1.0, 20.0, METRE_PER_SECOND, _SOURCE)
VISCOSITY_RANGE = Range(
    "dynamic_viscosity", "dynamic viscosity", 4.9, 48.0, MILLIPASCAL_SECOND, _FLUID_SOURCE
)
"""Viscosities of the simulations: the fluid is that of `atf-talbot-2012`, Tables 3.1 and 5.1."""
PRESSURE_VISCOSITY_RANGE = Range(
    "pressure_viscosity", "pressure-viscosity coefficient", 10.6, 16.5, PER_GIGAPASCAL,
    f"{_FLUID_SOURCE}, calibrated",
)  # fmt: skip
"""As calibrated for that fluid. The regressions contain exp(G) and are the most sensitive to it."""
_ROUGHNESS = Range("roughness", "rms roughness", 0.1, 0.7, MICROMETRE, _SOURCE)

TALBOT_GEAR_RANGES = (
    Range("temperature", "oil temperature", 25.0, 100.0, CELSIUS, _SOURCE),
    VISCOSITY_RANGE,
    PRESSURE_VISCOSITY_RANGE,
    _RADIUS,
    _ROUGHNESS,
    _PRESSURE,
    _SPEED,
    Range("slide_to_roll_ratio", "slide-to-roll ratio", 0.025, 1.0, NUMBER, _SOURCE),
)
"""Ranges of the 33,600 simulations behind Eq. 5.8 and 5.10."""
LARGEST_SLIP = 2.0  # Of surfaces that move the same way, as in gears: regressions end here. [1]

_HELD = {
    item.name: item.limits()
    for item in (
        _RADIUS,
        _HELD_PRESSURE,
        _SPEED,
        VISCOSITY_RANGE,
        PRESSURE_VISCOSITY_RANGE,
        replace(_ROUGHNESS, name="roughness1"),
        replace(_ROUGHNESS, name="roughness2"),
    )
} | {"slide_to_roll_ratio": (None, LARGEST_SLIP)}

Limits = Mapping[str, tuple[float | None, float | None]]
_OIL = (VISCOSITY_RANGE.name, PRESSURE_VISCOSITY_RANGE.name)


@lru_cache(maxsize=2)  # friction and rolling of a mesh ask for the same one
def held_in_table(contact: LineContacts, *, oil_held: bool = True) -> LineContacts:
    """The contacts with their conditions held in Table 5.1, the slip at 2. Theory (F5).

    Without `oil_held` viscosity and pressure-viscosity stay as they are: the formula goes on.
    """
    own = {name: pair for name, pair in _HELD.items() if oil_held or name not in _OIL}
    return contact.held(own)


def beyond_data(
    load: FloatArray,  # Of every contact, and held within the data. [N/m]
    held_load: FloatArray,
    speed: FloatArray | float,  # Rolling speed, likewise. [m/s]
    held_speed: FloatArray | float,
) -> FloatArray:
    """Rolling loss over that of the same contacts held within the data. Theory (R5). [1]

    Below the held load the loss falls with the load, so that it vanishes with it; above, it is
    that of the held load. Beyond the held speed the rolling force is that of the held speed.
    """
    return np.minimum(1.0, load / held_load) * (speed / held_speed)


# The published regressions for flanks of unequal roughness.
#
# They know the composite roughness only, which hardly falls when one of two rough flanks is
# polished; but a polished flank keeps the ridges of the other from meeting any. The regression is
# therefore taken where both flanks are as rough as the rougher one, and from there the solver of
# this package tells what the smoother flank changes, by its fit to contacts of the same oil.

SIMULATED = "atf-talbot-2012"  # The oil of the regressions, whose contacts were simulated.


def equally_rough(contact: LineContacts) -> LineContacts:
    """The contacts with both surfaces as rough as the rougher one."""
    rougher = np.maximum(*contact.roughness) + np.zeros(contact.radius.shape)
    return contact.changed(roughness1=rougher, roughness2=rougher)


def pairing_ratio(
    quantity: str,  # ``"friction"`` or ``"rolling_loss"``.
    contact: LineContacts,  # n of them.
) -> FloatArray:
    """A quantity over what it is with both surfaces as rough as the rougher one. Theory (O13). [1]

    Examples
    --------
    >>> from epicyclic.contact.line_contact import contacts_at
    >>> given = dict(
    ...     slide_to_roll_ratio=0.3, rolling_speed=10.0, radius=0.01, hertz_pressure=1e9,
    ...     roughness1=0.4e-6, roughness2=0.4e-6, dynamic_viscosity=6e-3, pressure_viscosity=11e-9,
    ... )
    >>> arrays = {name: np.array([value]) for name, value in given.items()}
    >>> pairing_ratio("friction", contacts_at(**arrays, equivalent_modulus=2.3e11))
    array([1.])
    """
    model = _simulated()
    return model.value(quantity, contact) / model.value(quantity, equally_rough(contact))


@lru_cache(maxsize=1)
def _simulated() -> OilModel:
    file = library.oil_model_file(SIMULATED)
    assert file is not None
    return read_oil_model(file)


# What a friction model is, and quantities that several of them use.


DRY_FRICTION = 0.10
"""Coefficient of dry contact in the film-share models, unless the case has its own. [1]"""


class FrictionModel(LossModel, Protocol):
    """A way to the coefficient of sliding friction at every point of a mesh."""

    @property
    def takes_oil_temperature(self) -> bool:
        """True if it was fitted to tests by the temperature of their oil, so that the temperature
        of the flanks is contained in it; False if it takes the oil as it enters the contact.
        """

    @property
    def remarks(self) -> tuple[str, ...]:
        """What to know about what was solved."""

    def solved_for(self, contact: MeshContact) -> FrictionModel:
        """The model with what it has to solve for a mesh, so that it need not do so again."""

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """Coefficient of friction at each point of `contact`, shape (n,). [1]"""


class NothingToSolve:
    """What friction models have in common that solve nothing."""

    __slots__ = ()

    remarks: ClassVar[tuple[str, ...]] = ()

    def solved_for(self, contact: MeshContact) -> Self:
        """Itself."""
        return self


@dataclass(frozen=True, slots=True)
class FrictionSettings:
    """Numbers that some models take from the case."""

    pointwise = True

    constant: float = 0.0  # Coefficient of the model constant. [1]
    # Coefficients of dry and of separated contact in the film-share models. [1]
    boundary: float | None = None  # None: that of each model.
    fluid: float = 0.0
    table: FrictionMap | None = None
    oil_held: bool = True  # False to continue the model mixed-ehl beyond its oil.
    load_factor: float = 1.0  # K_A K_gamma, for the model niemann-winter. [1]
    surfaces: Surfaces = RUN_IN  # For the model mixed-lubrication.


@dataclass(frozen=True, slots=True, kw_only=True)
class FrictionFormula(NothingToSolve, Formula):
    """A formula for the coefficient of friction."""

    pointwise = True

    function: Callable[[MeshContact, FrictionSettings], FloatArray]
    takes_oil_temperature: bool = False  # As of `FrictionModel`.
    # Ranges that depend on the settings, in place of `ranges`.
    ranges_under: Callable[[FrictionSettings], tuple[Range, ...]] | None = None
    settings: FrictionSettings = FrictionSettings()

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """Coefficient of friction at each point of `contact`, shape (n,). [1]"""
        return self.function(contact, self.settings)


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


def _mean_rms(contact: MeshContact) -> float:
    """Mean rms roughness of both flanks. [m]"""
    return (contact.flanks.roughness1 + contact.flanks.roughness2) / 2


def mean_roughness_ra(contact: MeshContact) -> float:
    """(Ra1 + Ra2)/2 from the rms values of the flanks. Theory (F14). [m]"""
    return RA_OVER_RQ * _mean_rms(contact)


# Friction formulas fitted to gear and disc tests, each held within the range of its tests.

_NIEMANN = "Niemann and Winter, Maschinenelemente II"
_FORMULA_SPEED = Range(
    "pitch_line_speed", "pitch-line speed", 1.0, 50.0, METRE_PER_SECOND, _NIEMANN
)
_LOAD = Range(
    "specific_load", "load per face width", 150.0, None, NEWTON_PER_MM, _NIEMANN, specific_load
)
_FORMULA_PRESSURE = Range(
    "pitch_point_pressure", "Hertz pressure at the pitch point", None, 2.5, GIGAPASCAL,
    OF_THIS_PACKAGE, pitch_point_pressure,
)  # fmt: skip
_FORMULA_ROUGHNESS = Range(
    "mean_ra", "mean roughness Ra", None, 5.0, MICROMETRE, OF_THIS_PACKAGE, mean_roughness_ra
)


def _mean_group(contact: MeshContact, load_factor: float = 1.0) -> float:
    """[K (F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 in N/mm, m/s, mm and mPa s, in its range.

    Theory (F19).
    """
    radius, e_eq = pitch_point_radius(contact), contact.flanks.equivalent_modulus
    load = held_in_range(load_factor * specific_load(contact), _LOAD)
    pressure = held_in_range(hertz_pressure(load, radius, e_eq), _FORMULA_PRESSURE)
    load = line_load_at_pressure(pressure, radius, e_eq)
    speed = contact.pitch_line_speed
    sum_speed = pitch_point_sum_speed(contact) * held_in_range(speed, _FORMULA_SPEED) / speed
    group = load * 1e-3 / (sum_speed * radius * 1e3)
    viscosity = contact.oil.dynamic_viscosity * 1e3
    found: float = group**0.2 * viscosity**-0.05
    return found


def _relative_roughness(contact: MeshContact) -> float:
    """Ra/d1 in um/mm, as in the X_R of Niemann and Winter; d1 is that of the pinion."""
    pinion = min(contact.mesh.gear1.reference_radius, contact.mesh.gear2.reference_radius)
    return mean_roughness_ra(contact) * 1e6 / (2e3 * pinion)


def schlenk(contact: MeshContact, settings: FrictionSettings) -> FloatArray:
    """mu = 0.048 [(F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 Ra^0.25 X_L, one value for the mesh.

    Theory (F15). N/mm, m/s, mm, mPa s, um; Ra the mean of both flanks. The standard's text was not
    read; the constants agree in several independent implementations. [1]
    """
    rough = (held_in_range(mean_roughness_ra(contact), _FORMULA_ROUGHNESS) * 1e6) ** 0.25
    mu = 0.048 * _mean_group(contact) * rough * contact.oil.lubricant_factor
    return np.full_like(contact.line_load, mu)


_RELATIVE_ROUGHNESS = Range(
    "relative_roughness", "Ra over reference diameter, um/mm", None, 0.1, NUMBER, OF_THIS_PACKAGE,
    _relative_roughness,
)  # fmt: skip


def niemann_winter(contact: MeshContact, settings: FrictionSettings) -> FloatArray:
    """mu = 0.045 [K (F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 X_R X_L, X_R = 3.8 (Ra/d1)^0.25.

    Theory (F16). N/mm, m/s, mm, mPa s, um; K = K_A K_gamma is `load_factor`. Standard formula from
    general knowledge, its text not read; X_R agrees with the form 2.2 (Ra/rho)^0.25 of DIN 3990-4.
    [1]
    """
    rough = held_in_range(_relative_roughness(contact), _RELATIVE_ROUGHNESS)
    group = _mean_group(contact, settings.load_factor)
    mu = 0.045 * group * 3.8 * rough**0.25 * contact.oil.lubricant_factor
    return np.full_like(contact.line_load, mu)


def _niemann_winter_ranges(settings: FrictionSettings) -> tuple[Range, ...]:
    """Those of the tests, for the load with its factor."""
    factor = settings.load_factor
    return (
        _FORMULA_SPEED,
        replace(_LOAD, of=lambda contact: factor * specific_load(contact)),
        replace(_FORMULA_PRESSURE, of=lambda contact: factor**0.5 * pitch_point_pressure(contact)),
        _RELATIVE_ROUGHNESS,
    )


SMALLEST_SLIDING = 0.01
"""Sliding over rolling speed at which the formula of Benedict and Kelley is held. [1]"""
MICROINCH = 25.4e-9  # [m]


def _log_argument(contact: MeshContact) -> FloatArray:
    """29.66 w/(eta v_s v_r^2) of Benedict and Kelley, v_s at 1 % of v_r or above. [1]"""
    rolling = 2 * contact.rolling_speed
    sliding = np.maximum(np.abs(contact.sliding_speed), SMALLEST_SLIDING * rolling)
    viscosity = contact.oil.dynamic_viscosity * 1e3
    return 29.66 * contact.line_load / np.maximum(viscosity * sliding * rolling**2, LEAST_SPEED)


_ARGUMENT = Range(
    "log_argument", "argument of the logarithm", 10.0, 1e8, NUMBER, OF_THIS_PACKAGE, _log_argument
)
_RMS_SOURCE = "AGMA 925-A03: 50/(50 - S) at most 3"
_RMS = Range(
    "mean_rms", "mean rms roughness", None, 0.0254 * 100 / 3, MICROMETRE, _RMS_SOURCE, _mean_rms
)


def benedict_kelley(contact: MeshContact, settings: FrictionSettings) -> FloatArray:
    """mu = 0.0127 [50/(50 - S)] log10[29.66 w/(eta v_s v_r^2)], local. Theory (F7).

    w in N/m, eta in mPa s, v_s and v_r = u1 + u2 in m/s, S rms roughness in microinches. The
    argument of the logarithm is held: below 10, with little load on much oil, it has no meaning;
    above 1e8 the friction of smooth flanks would exceed that of dry steel, 0.10. Near the pitch
    point v_s is kept at 1 % of v_r, because the formula grows without bound there. [1]
    """
    rms = held_in_range(_mean_rms(contact), _RMS) / MICROINCH
    return 0.0127 * 50 / (50 - rms) * np.log10(held_in_range(_log_argument(contact), _ARGUMENT))


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


def _mixed(dry: FloatArray, settings: FrictionSettings) -> FloatArray:
    """mu = xi mu_b + (1 - xi) mu_f. Theory (F8). [1]"""
    boundary = DRY_FRICTION if settings.boundary is None else settings.boundary
    return dry * boundary + (1 - dry) * settings.fluid


def doleschel(contact: MeshContact, settings: FrictionSettings) -> FloatArray:
    """xi = (1 - lambda/2)^2 for lambda < 2, else 0; lambda = h_c/[(Ra1 + Ra2)/2]. Theory (F9)."""
    film = contact.radius * pan_hamrock_central_film(
        contact.speed_number, contact.material_number, contact.load_number
    )
    ratio = np.minimum(film / mean_roughness_ra(contact), 2.0)
    return _mixed((1 - ratio / 2) ** 2, settings)


def matsumoto(contact: MeshContact, settings: FrictionSettings) -> FloatArray:
    """xi = log10(D)/2 within 0 to 1, D = (Rz1 + Rz2)/h_min. Theory (F10)."""
    rz = RZ_OVER_RA * 2 * mean_roughness_ra(contact)
    return _mixed(np.clip(np.log10(rz / contact.minimum_film) / 2, 0.0, 1.0), settings)


# Friction formulas fitted to EHL simulations of one fluid each.


def mixed_ehl(contact: LineContacts, settings: FrictionSettings) -> FloatArray:
    """Regression of 33,600 mixed-EHL simulations of an automatic transmission fluid.

    Talbot (2012), Eq. 5.8 and Table 5.2(a); branches in the film ratio blended, conditions
    outside Table 5.1 held at its limits (`held_in_table`). [1]
    """
    return at_each(sliding_friction_at, held_in_table(contact, oil_held=settings.oil_held))


def paired_friction(contact: LineContacts, settings: FrictionSettings) -> FloatArray:
    """`mixed_ehl` of two flanks as rough as the rougher one, times the effect of the smoother one.

    Theory (O13).
    """
    published = mixed_ehl(equally_rough(contact), settings)
    return published * pairing_ratio("friction", contact)


_SUCCESSOR = "none is printed; that of the later regression, Talbot (2012), Table 5.1"
_REGRESSION_PRESSURE = Range("hertz_pressure", "Hertz pressure", 0.5, 2.5, GIGAPASCAL, _SUCCESSOR)
_REGRESSION_SPEED = Range("rolling_speed", "rolling speed", 1.0, 20.0, METRE_PER_SECOND, _SUCCESSOR)
_FORMULA_RADIUS = Range("radius", "equivalent radius", 5.0, 40.0, MILLIMETRE, _SUCCESSOR)
_VISCOSITY_SOURCE = "none is printed; a 75W-90 gear oil from 150 to 25 °C"
_VISCOSITY = Range(
    "dynamic_viscosity", "dynamic viscosity", 5.0, 180.0, MILLIPASCAL_SECOND, _VISCOSITY_SOURCE
)
_REGRESSION_ROUGHNESS = Range(
    "composite_roughness", "composite rms roughness", None, 1.0, MICROMETRE, OF_THIS_PACKAGE
)
_FULL_FILMS = Range(
    "film_ratio", "film ratio", 1.0, None, NUMBER, "the regression is for full films"
)


XU_COEFFICIENTS = (
    -8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305,
)  # fmt: skip
"""b1 to b9 of `xu_2007`."""
SMALLEST_SLIDE_TO_ROLL = 1e-9  # Slide-to-roll ratio that is put into the powers, at least. [1]


def xu_2007(contact: MeshContact, settings: FrictionSettings) -> FloatArray:
    """Regression of EHL simulations of a 75W-90 gear oil, full film only. Theory (F6).

    Xu, Kahraman, Anderson and Maddock, J. Mech. Des. 129 (2007) 58: with p_h in GPa, u_r in m/s,
    dynamic viscosity in mPa s, composite rms roughness S in um, radius in m. The range of the
    regression was not found in print; conditions are held in the ranges assumed here, because
    exp(b9 exp(S)) and the powers run away. [1]
    """
    b1, b2, b3, b4, b5, b6, b7, b8, b9 = XU_COEFFICIENTS
    pressure = held_in_range(contact.hertz_pressure, _REGRESSION_PRESSURE) * 1e-9
    slip = np.clip(contact.slide_to_roll_ratio, SMALLEST_SLIDE_TO_ROLL, LARGEST_SLIP)
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
        * held_in_range(contact.radius, _FORMULA_RADIUS) ** b8
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
class FrictionMap:
    """Linear in a table over one or two local quantities, constant beyond it. Theory (F17)."""

    # Name of a quantity of `MeshContact` and its rising points, SI.
    axes: tuple[tuple[str, tuple[float, ...]], ...]
    # Coefficients, one (nested) entry for each point.
    values: tuple[float, ...] | tuple[tuple[float, ...], ...]

    @property
    def ranges(self) -> tuple[Range, ...]:
        """From the first to the last point of every axis."""
        ranges, source = [], "[friction_table] of the case"
        for name, points in self.axes:
            label, unit = _AXES[name]
            low, high = (unit.to_display(it) if unit.si else it for it in (points[0], points[-1]))
            ranges.append(Range(name, label, low, high, unit, source))
        return tuple(ranges)

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        names, axes = zip(*self.axes, strict=True)
        found = on_grid(axes, self.values, [getattr(contact, name) for name in names])
        return found.view(type(contact.line_load))


def _table_of(settings: FrictionSettings) -> FrictionMap:
    if settings.table is None:
        raise ValueError("the friction model 'table' needs a friction_table")
    return settings.table


# The friction models by name.

_SCATTER_UNKNOWN = "fitted to gear tests, whose scatter was not found in print"
_NOT_COMPARED = "no comparison with measurements was found"

FRICTION_MODELS = {
    model.name: model
    for model in (
        FrictionFormula(
            name="mixed-lubrication",
            title="film and asperities sharing the load",
            source="S. Aihara, J. Tribol. 109 (1987) 471; P. K. Gupta et al., J. Tribol. 114 "
            "(1992) 55; C. R. Evans and K. L. Johnson, Proc. IMechE C 200 (1986) 303",
            reliability="not fitted to gears; for its error on measured gears see 'epicyclic "
            "validate --measured'",
            function=lambda contact, settings: mixed_friction(
                contact, settings.surfaces, settings.boundary
            ),
            ranges=FILM_RANGES,
        ),
        FrictionFormula(
            name="mixed-ehl",
            title="mixed-EHL friction regression",
            source=f"{REGRESSION_SOURCE}, Eq. 5.8",
            reliability="regression of simulated contacts, whose error against them is not "
            "printed; with it the predicted slope of the measured loss of the sets it was made "
            "for is 3.5 % low at 90 °C (Talbot 2012, Fig. 5.9), lower at 40 and 60 °C",
            function=mixed_ehl,
            ranges=TALBOT_GEAR_RANGES,
            made_for=TALBOT_FLUID,
        ),
        FrictionFormula(
            name="mixed-ehl+pairing",
            several=False,
            title="mixed-EHL friction regression, pairing of unequal flanks from the solver",
            source=f"{REGRESSION_SOURCE}, Eq. 5.8; solver for line contacts of this package",
            reliability="mixed-ehl where both flanks are equally rough; the effect of a smoother "
            "flank is from the solver of this package and was not compared with measurements",
            function=paired_friction,
            ranges=TALBOT_GEAR_RANGES,
            made_for=TALBOT_FLUID,
        ),
        FrictionFormula(
            name="xu-2007",
            title="EHL friction regression of Xu et al.",
            source="Xu, Kahraman, Anderson, Maddock, J. Mech. Des. 129 (2007) 58",
            reliability="regression of simulated contacts; 24 to 36 % error against the measured "
            "loss of one jet-lubricated spur pair (tests of Petry-Johnson et al., second hand)",
            function=xu_2007,
            ranges=(
                _REGRESSION_PRESSURE,
                _REGRESSION_SPEED,
                _FORMULA_RADIUS,
                _VISCOSITY,
                _REGRESSION_ROUGHNESS,
                _FULL_FILMS,
            ),
            made_for=RegressionFluid("xu-2007", "a 75W-90 gear oil"),
        ),
        FrictionFormula(
            name="benedict-kelley",
            title="local friction of Benedict and Kelley",
            source="G. H. Benedict and B. W. Kelley, ASLE Trans. 4 (1961) 59",
            reliability=f"fitted to disc tests; {_NOT_COMPARED}",
            function=benedict_kelley,
            ranges=(_ARGUMENT, _RMS),
            takes_oil_temperature=True,
        ),
        FrictionFormula(
            name="matsumoto",
            title="film share of Matsumoto and Morikawa",
            source="S. Matsumoto and K. Morikawa, Int. Gear Conf. Lyon (2014) 1078",
            reliability=f"film and dry friction are estimates in the case; {_NOT_COMPARED}",
            function=matsumoto,
            ranges=FILM_RANGES,
        ),
        FrictionFormula(
            name="doleschel",
            title="film share of Doleschel",
            source="A. Doleschel, Diss. TU Muenchen (2002)",
            reliability=f"film and dry friction are estimates in the case; {_NOT_COMPARED}",
            function=doleschel,
            ranges=FILM_RANGES,
        ),
        FrictionFormula(
            name="schlenk",
            title="mean friction of ISO/TR 14179-2",
            source="L. Schlenk, Diss. TU Muenchen (1994); ISO/TR 14179-2:2001",
            reliability=_SCATTER_UNKNOWN,
            function=schlenk,
            ranges=(_FORMULA_SPEED, _LOAD, _FORMULA_PRESSURE, _FORMULA_ROUGHNESS),
            takes_oil_temperature=True,
        ),
        FrictionFormula(
            name="niemann-winter",
            title="mean friction after Michaelis, Niemann and Winter",
            source="K. Michaelis, Diss. TU Muenchen (1987); Niemann and Winter, vol. II",
            reliability=_SCATTER_UNKNOWN,
            function=niemann_winter,
            ranges_under=_niemann_winter_ranges,
            takes_oil_temperature=True,
        ),
        FrictionFormula(
            name="constant",
            title="constant friction",
            source="the case",
            reliability="given by the case",
            function=lambda contact, settings: np.full_like(contact.line_load, settings.constant),
        ),
        FrictionFormula(
            name="table",
            title="friction table",
            source="the case",
            reliability="given by the case",
            function=lambda contact, settings: _table_of(settings).coefficient(contact),
            ranges_under=lambda settings: _table_of(settings).ranges,
        ),
    )
}


CONTAINS_ROLLING = ("schlenk", "niemann-winter")
"""Fitted to the whole load-dependent loss of gear tests, that of rolling included. Theory (R11)."""


def friction_model(name: str, settings: FrictionSettings) -> FrictionFormula:
    """The friction model called `name`, with the numbers of a case."""
    model = FRICTION_MODELS[name]
    ranges = model.ranges if model.ranges_under is None else model.ranges_under(settings)
    return replace(model, settings=settings, ranges=ranges)
