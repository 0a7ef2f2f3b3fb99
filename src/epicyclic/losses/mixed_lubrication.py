"""Friction of rough, lubricated flanks, for any oil: film and asperities share the load.

At each contact, in the order of docs/theory/mixed-lubrication.md:

1. the film of Pan and Hamrock, thinned by the heat at the inlet (Gupta et al.);
2. the roughness that acts: what is shorter than the contact is wide, after running-in;
3. the share of the load on asperities by the film ratio (Aihara);
4. the shear stress of the film: Eyring with a limit, as hot as friction makes it;
5. mu = xi mu_b + (1 - xi) tau/p.
"""

from __future__ import annotations

import math

import numpy as np

from epicyclic.arrays import FloatArray, log, side_by_side, sqrt
from epicyclic.contact.line_contact import LineContacts
from epicyclic.contact.temperatures import flash_temperature
from epicyclic.dataclass import dataclass
from epicyclic.gears.flanks import (
    HURST_EXPONENT,
    MIDDLE_OF_CLASS,
    PROFILE_CUTOFF,
    RA_OVER_RQ,
    RUNNING_IN,
)
from epicyclic.kernels.line_contact import (
    MARTIN_FILM,
    asperity_share,
    inlet_film_factor,
    pan_hamrock_central_film,
    power,
)
from epicyclic.kernels.mixed_lubrication import film_stress
from epicyclic.oil.oil import D341_OFFSET, MM2_PER_S, OilState

MEAN_FLASH = 2 / 3
"""Mean over largest rise in an evenly heated, fast contact: the rise grows with sqrt(x). [1]"""
MEAN_PRESSURE = math.pi / 4  # Mean over largest pressure of Hertz. [1]
LEAST_FILM = 1e-40  # Of flanks that stand. [m]
LEAST_LOAD = 1e-40  # Of flanks that carry nothing [N/m]; pressures likewise [Pa].


@dataclass(frozen=True, slots=True)
class Surfaces:
    """What of the roughness acts."""

    pointwise = True

    running_in: float = RUNNING_IN
    cutoff: float | None = None  # Of the measured profiles; None: `usual_cutoff`. [m]
    hurst_exponent: float = HURST_EXPONENT


RUN_IN = Surfaces()


def acting_roughness(contact: LineContacts, surfaces: Surfaces) -> FloatArray:
    """sigma^2 = sum of (f Rq (2 b/l_c)^H)^2 of both flanks, 2 b/l_c at most 1. Theory (Y3). [m]

    A self-affine profile has an rms height that grows with the length L that is looked at as L^H;
    what is longer than the contact is wide leaves both flanks parallel and breaks no film.
    """
    exponent = surfaces.hurst_exponent
    grown = power(2 * contact.hertz_half_width, exponent)
    heights = []
    for roughness in contact.roughness:
        cutoff = usual_cutoff(roughness) if surfaces.cutoff is None else surfaces.cutoff
        heights.append(roughness * np.minimum(grown / cutoff**exponent, 1.0))
    sigma: FloatArray = surfaces.running_in * np.sqrt(heights[0] ** 2 + heights[1] ** 2)
    return sigma


def usual_cutoff(
    roughness: float,  # rms. [m]
) -> float:
    """Cut-off with which a profile of this roughness is measured. Theory (Y4). [m]

    ISO 21920-3 has 0.08 mm for Ra to 0.02 um, 0.25 mm to 0.1 um, 0.8 mm to 2 um, 2.5 mm to 10 um,
    8 mm above. The root through the middle of these classes stands for their steps, so that a
    rougher flank never seems smoother.

    Examples
    --------
    >>> round(1e3 * usual_cutoff(0.56e-6), 2)
    0.8
    """
    return PROFILE_CUTOFF * sqrt(RA_OVER_RQ * roughness / MIDDLE_OF_CLASS)


def central_film(contact: LineContacts) -> FloatArray:
    """Film of smooth flanks, thinned by heat at the inlet. Theory (Y2), (Y9). [m]

    Under light load flanks stay rigid: H. M. Martin, Engineering 102 (1916) 119, 4.895 mu u_r R/W'.
    """
    assert isinstance(contact.oil, OilState)  # of fits to simulated contacts it is not known
    heating = inlet_film_factor(
        contact.oil.thermal_load(contact.rolling_speed),
        contact.hertz_pressure / contact.flanks.equivalent_modulus,
        contact.slide_to_roll_ratio,
    )
    smooth = pan_hamrock_central_film(
        contact.speed_number, contact.material_number, contact.load_number
    )
    elastic = contact.radius * heating * smooth
    squeezed = contact.dynamic_viscosity * contact.rolling_speed * contact.radius
    rigid = MARTIN_FILM * squeezed / np.maximum(contact.line_load, LEAST_LOAD)
    film: FloatArray = np.maximum(elastic, rigid)
    return np.maximum(film, LEAST_FILM)


def mixed_friction(
    contact: LineContacts,
    surfaces: Surfaces,
    boundary: float | None = None,  # mu_b; None: that of the oil. [1]
    film: FloatArray | None = None,  # None: `central_film`. [m]
) -> FloatArray:
    """mu = xi mu_b + (1 - xi) tau/p, tau as hot as the film is. Theory (Y8). [1]"""
    oil = contact.oil
    assert isinstance(oil, OilState)
    boundary = oil.boundary_friction if boundary is None else boundary
    film = central_film(contact) if film is None else film
    share = asperity_share(film / acting_roughness(contact, surfaces))
    pressure = np.maximum(MEAN_PRESSURE * contact.hertz_pressure, LEAST_LOAD)
    slip = np.abs(contact.sliding_speed)
    # flank temperature for a coefficient of friction of 1
    flash = MEAN_FLASH * flash_temperature(
        1.0,
        contact.line_load,
        slip,
        *contact.surface_speeds,
        contact.hertz_half_width,
        *contact.flanks.effusivities,
    )
    # rises for each pascal of the film: of both flanks, and the mean across it, evenly heated
    heating = flash * (1 - share) / pressure + slip * film / (12 * oil.thermal_conductivity)
    stress = film_stress(
        pressure, slip / film, flash * share * boundary, heating, _oil_constants(oil)
    )
    return share * boundary + (1 - share) * stress / pressure


def _oil_constants(oil: OilState) -> FloatArray:
    """As `eyring_stress` takes them: the line of ASTM D341 that touches at this temperature."""
    viscosity = oil.kinematic_viscosity / MM2_PER_S
    shifted = viscosity + D341_OFFSET
    # -d(log log(nu + 0.7))/d(log T) from beta = -d(ln nu)/dT
    slope = oil.thermoviscosity * oil.temperature * viscosity / (shifted * log(shifted))
    constants = (
        oil.temperature,
        log(shifted),
        log(viscosity),
        slope,
        oil.density * MM2_PER_S,
        oil.pressure_viscosity,
        oil.pressure_viscosity_exponent,
        oil.limiting_traction,
    )
    return side_by_side(constants)
