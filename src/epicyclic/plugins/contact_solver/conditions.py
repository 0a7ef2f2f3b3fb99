"""What a line contact and its oil are given by: load, speeds, scales, heating."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.contact.line_contact import LineContacts
from epicyclic.dataclass import dataclass
from epicyclic.errors import Problem, raise_any
from epicyclic.kernels.line_contact import hertz_half_width, hertz_pressure
from epicyclic.oil.oil import ROELANDS_OFFSET, ROELANDS_PRESSURE, OilState
from epicyclic.oil.rheology import (
    Carreau,
    LimitingStress,
    Newtonian,
    OilLaws,
    PressureLaw,
    ReeEyring,
    Roelands,
    ShearLaw,
    TwoSlope,
    shear_problems,
)
from epicyclic.plugins.contact_solver.kernels_fluid import (
    BARUS,
    CARREAU,
    EYRING,
    LIMITING,
    NEWTONIAN,
    ROELANDS,
    TWO_SLOPE,
    ScaledFluid,
    mean_shear,
)


def moes_central_film(
    load: float,  # M. [1]
    material: float,  # L. [1]
) -> float:
    """Central film of an incompressible oil in Moes' units, H = (h/R)(2U)^-1/2. Theory (H20).

    H. Moes, Lubrication and Beyond, University of Twente (2000). A fit of numerical solutions over
    all four regimes, rigid or elastic, isoviscous or piezoviscous.
    """
    rigid_isoviscous, elastic_isoviscous = 3 / load, 2.621 * load**-0.2
    rigid_piezoviscous = 1.287 * math.pow(material, 2 / 3)
    elastic_piezoviscous = 1.311 * load**-0.125 * math.pow(material, 0.75)
    s = (7 + 8 * math.exp(-2 * elastic_isoviscous / rigid_isoviscous)) / 5
    isoviscous = rigid_isoviscous ** (7 / 3) + elastic_isoviscous ** (7 / 3)
    piezoviscous = rigid_piezoviscous**-3.5 + elastic_piezoviscous**-3.5
    return float((isoviscous ** (3 * s / 7) + piezoviscous ** (-2 * s / 7)) ** (1 / s))


# Where the solver of line contacts is tested: beyond it, its answers are not relied on.


SOLVER_BOX: dict[str, tuple[float, float]] = {
    "radius": (0.3e-3, 0.3),
    "hertz_pressure": (3e6, 3e9),
    "rolling_speed": (0.1, 50.0),
    "slide_to_roll_ratio": (0.0, 2.0),
    "film_ratio": (0.01, 20.0),
    "composite_roughness": (0.0, 1.7e-6),
}
"""Lowest and highest equivalent radius [m], Hertz pressure [Pa], rolling speed [m/s], slip [1], and
of rough contacts minimum film over composite roughness [1], composite roughness [m]."""
DRY_SPEED = 0.01
"""Rolling speed below which ridges across the motion trap oil that would leak past real ones, and
a contact does not become dry. [m/s]"""
FEWEST_KEPT = 0.95  # Share of Rq that a grid must resolve. [1]
VALIDATED_FILM_RATIO = 0.7
"""Film ratio below which friction of rough contacts is not validated. [1]"""

STIFFENING, PACKING = 1.34 / 5.9e8, 1.0 / 5.9e8
"""Constants of Dowson and Higginson's density. [1/Pa]"""


SHEAR_CODES: dict[type[ShearLaw], int] = {
    Newtonian: NEWTONIAN,
    ReeEyring: EYRING,
    LimitingStress: LIMITING,
    Carreau: CARREAU,
}


@dataclass(frozen=True, slots=True)
class ContactOil:
    """Oil in a contact, at one temperature."""

    viscosity: float  # Dynamic viscosity at ambient pressure. [Pa s]
    pressure_law: PressureLaw
    shear_law: ShearLaw = Newtonian()
    compressible: bool = True  # Density after Dowson and Higginson, or constant.

    @property
    def roelands_index(self) -> float:
        """z = alpha 1.96e8/(ln mu_0 + 9.67). Theory (H6). [1]"""
        return (
            self.pressure_law.alpha
            * ROELANDS_PRESSURE
            / (math.log(self.viscosity) + ROELANDS_OFFSET)
        )


def contact_oil(oil: OilState, laws: OilLaws) -> ContactOil:
    """An oil at the temperature of a contact, and how it behaves there."""
    pressure_law = laws.pressure(oil.pressure_viscosity)
    return ContactOil(oil.dynamic_viscosity, pressure_law, laws.shear)


@dataclass(frozen=True)
class LineContact:
    """Load, geometry and surface speeds of one line contact, as the solver wants them."""

    line_load: float  # W', per length. [N/m]
    radius: float  # R_eq. [m]
    equivalent_modulus: float  # E_eq. [Pa]
    speed1: float  # Speeds of the surfaces through the contact, both in the direction of x. [m/s]
    speed2: float  # Speeds of the surfaces through the contact, both in the direction of x. [m/s]
    oil: ContactOil

    def __post_init__(self) -> None:
        problems = [
            Problem(name, f"{value:g}", "must be a finite number above zero.", "Change it.")
            for name, value in (
                ("line_load", self.line_load),
                ("radius", self.radius),
                ("equivalent_modulus", self.equivalent_modulus),
                ("speed1 + speed2", self.speed1 + self.speed2),
                ("oil.viscosity", self.oil.viscosity),
                ("oil.pressure_law.alpha", self.oil.pressure_law.alpha),
            )
            if not (value > 0 and math.isfinite(value))
        ]
        problems += [
            Problem(f"oil.shear_law.{name}", f"{value:g}", allowed, "Change it.")
            for name, value, allowed in shear_problems(self.oil.shear_law)
        ]
        raise_any(problems, "the contact")

    @property
    def rolling_speed(self) -> float:
        """u_r, the mean of both. [m/s]"""
        return (self.speed1 + self.speed2) / 2

    @property
    def sliding_speed(self) -> float:
        """u_s = u_1 - u_2. [m/s]"""
        return self.speed1 - self.speed2

    @cached_property
    def half_width(self) -> float:
        """b_h of Hertz. [m]"""
        return hertz_half_width(self.line_load, self.radius, self.equivalent_modulus)

    @cached_property
    def hertz_pressure(self) -> float:
        """p_h. [Pa]"""
        return hertz_pressure(self.line_load, self.radius, self.equivalent_modulus)

    @property
    def film_scale(self) -> float:
        """b^2/R, the unit of H. Theory (H1). [m]"""
        return self.half_width**2 / self.radius

    @property
    def moes_load(self) -> float:
        """M = W (2U)^-1/2. Theory (H3). [1]"""
        load = self.line_load / (self.equivalent_modulus * self.radius)
        return load / math.sqrt(2 * self._speed_number)

    @property
    def moes_material(self) -> float:
        """L = G (2U)^1/4. Theory (H3). [1]"""
        return (
            self.oil.pressure_law.alpha
            * self.equivalent_modulus
            * math.pow(2 * self._speed_number, 0.25)
        )

    @property
    def _speed_number(self) -> float:
        return self.oil.viscosity * self.rolling_speed / (self.equivalent_modulus * self.radius)

    def scaled_fluid(self, easing: float = 1.0) -> ScaledFluid:
        """The oil in the units of this contact, its flow under pressure eased. Theory (H2)."""
        oil, p_h = self.oil, self.hertz_pressure
        law = oil.pressure_law
        code, second, third = BARUS, 0.0, 0.0
        if isinstance(law, Roelands):
            code, second, third = ROELANDS, p_h / ROELANDS_PRESSURE, oil.roelands_index
        elif isinstance(law, TwoSlope):
            code, second, third = TWO_SLOPE, law.alpha_high * p_h, law.transition / p_h
        wedge = 12 * oil.viscosity * self.rolling_speed * self.radius**2
        return ScaledFluid(
            law=code,
            slope=law.alpha * p_h,
            second=second,
            third=third,
            stiffening=STIFFENING * p_h if oil.compressible else 0.0,
            packing=PACKING * p_h if oil.compressible else 0.0,
            poiseuille=easing * self.half_width**3 * p_h / wedge,
            sliding=oil.viscosity * abs(self.sliding_speed) / (p_h * self.film_scale),
            shear_law=SHEAR_CODES[type(oil.shear_law)],
            stress=getattr(oil.shear_law, "stress", math.inf) / p_h,
            stress_slope=getattr(oil.shear_law, "slope", 0.0),
            exponent=getattr(oil.shear_law, "exponent", 1.0),
        )


def line_contact(contacts: LineContacts, index: int, oil: ContactOil) -> LineContact:
    """One of many contacts."""
    rolling, sliding = (
        float(speed[index]) for speed in (contacts.rolling_speed, contacts.sliding_speed)
    )
    return LineContact(
        line_load=float(contacts.line_load[index]),
        radius=float(contacts.radius[index]),
        equivalent_modulus=contacts.flanks.equivalent_modulus,
        speed1=rolling + sliding / 2,
        speed2=rolling - sliding / 2,
        oil=oil,
    )


# Heat of sliding: thinner inlet film, warmer film. An estimate beside an isothermal solution.

FILM_EXPONENT = 0.694  # Exponent of the viscosity in the film of Pan and Hamrock (1989). [1]
SMALLEST_CHANGE = 1e-3  # To which the temperature of a node is found. [K]


@dataclass(frozen=True, slots=True)
class Heating:
    """What carries the heat of sliding away."""

    thermoviscosity: float  # beta = -d(ln mu)/dT of the oil at the inlet. [1/K]
    oil_conductivity: float  # [W/(m K)]
    effusivity1: float  # sqrt(k rho c) of each solid. [W s^0.5/(m^2 K)]
    effusivity2: float  # sqrt(k rho c) of each solid. [W s^0.5/(m^2 K)]


def heating_of(oil: OilState, effusivity1: float, effusivity2: float) -> Heating:
    """Heat carried away by an oil at the temperature of the contact and two solids."""
    return Heating(oil.thermoviscosity, oil.thermal_conductivity, effusivity1, effusivity2)


def inlet_factor(contact: LineContact, heating: Heating) -> float:
    """Film over that without heat of shear in the inlet: Wilson and Sheu (1983). Theory (H29)."""
    speed = contact.rolling_speed
    # L = beta mu_0 u_r^2/k
    load = heating.thermoviscosity * contact.oil.viscosity * speed**2 / heating.oil_conductivity
    slip = abs(contact.sliding_speed) / speed
    return 1 / (1 + 0.1 * (1 + 14.8 * math.pow(slip, 0.83)) * math.pow(load, 0.64))


def flow_easing(contact: LineContact, heating: Heating | None) -> float:
    """Factor on the flow under pressure by which the film falls by the inlet factor.

    Theory (H29).
    """
    if heating is None:
        return 1.0
    return math.pow(inlet_factor(contact, heating), -1 / FILM_EXPONENT)


def thinning(
    contact: LineContact, heating: Heating | None, pressure: FloatArray, rise: FloatArray
) -> FloatArray:
    """What a `rise` of the temperature [K] takes off ln(mu): 0 if isothermal. Theory (H31)."""
    if heating is None:
        return np.zeros_like(rise)
    thinned = heating.thermoviscosity * rise
    if isinstance(contact.oil.pressure_law, Roelands):
        stiffer = 1 + np.maximum(pressure, 0) / ROELANDS_PRESSURE
        thinned = thinned * stiffer**contact.oil.roelands_index
    return thinned


def temperature_rise(
    contact: LineContact,
    heating: Heating,
    x: FloatArray,  # Nodes [m], pressure [Pa] and film [m] of a steady solution.
    pressure: FloatArray,  # Nodes [m], pressure [Pa] and film [m] of a steady solution.
    film: FloatArray,  # Nodes [m], pressure [Pa] and film [m] of a steady solution.
) -> FloatArray:
    """Mean over the film of the temperature above that of the inlet, shape (n,). [K]

    Theory (H30), (H31). Heat only acts downstream, so that node after node has one unknown.
    """
    from scipy.optimize import brentq

    fluid, slip = contact.scaled_fluid(), abs(contact.sliding_speed)
    conveyed = heating.effusivity1 * math.sqrt(abs(contact.speed1))
    conveyed += heating.effusivity2 * math.sqrt(abs(contact.speed2))
    surfaces = _moving_source(x) / (math.sqrt(math.pi) * conveyed)
    # by the heat of a node itself, half of which is that of the cell before it
    own = film / (12 * heating.oil_conductivity)
    own[1:] += np.diagonal(surfaces, -1)[: x.size - 1] / 2
    per_kelvin = thinning(contact, heating, pressure, np.ones_like(x))
    rise, heat = np.zeros_like(x), np.zeros_like(x)

    def source(warmer: float, i: int) -> float:
        scaled = pressure[i] / contact.hertz_pressure, film[i] / contact.film_scale
        stress = mean_shear(*scaled, per_kelvin[i] * warmer, fluid)
        return float(stress * contact.hertz_pressure * slip)

    def excess(warmer: float, i: int, before: float) -> float:
        return warmer - before - float(own[i]) * source(warmer, i)

    for i in range(x.size):
        before = float(surfaces[i, :i] @ (heat[1 : i + 1] + heat[:i])) / 2
        rise[i] = before
        if pressure[i] > 0:
            # the warmer the film the less heat: one answer, and no warmer than this
            most = before + own[i] * source(before, i)
            if excess(most, i, before) > SMALLEST_CHANGE:
                most = brentq(excess, before, most, args=(i, before), xtol=SMALLEST_CHANGE)
            rise[i] = most
            heat[i] = source(rise[i], i)
    return rise


def _moving_source(x: FloatArray) -> FloatArray:
    """Integral over each cell upstream of (x - s)^-1/2 ds, shape (n, n - 1). [m^0.5]"""
    root = np.sqrt(np.maximum(np.subtract.outer(x, x), 0))
    integral: FloatArray = 2 * (root[:, :-1] - root[:, 1:])
    return integral
