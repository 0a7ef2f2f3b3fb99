"""Friction of rough, lubricated flanks, for any oil: film and asperities share the load.

At each contact, in the order of docs/theory/mixed-lubrication.md:

1. the film of Pan and Hamrock, thinned by the heat at the inlet (Gupta et al.);
2. the roughness that acts: what is shorter than the contact is wide, after running-in;
3. the share of the load on asperities by the film ratio (Aihara);
4. the shear stress of the film: Eyring with a limit, as hot as friction makes it;
5. mu = xi mu_b + (1 - xi) tau/p.

They are one kernel, `epicyclic.kernels.mixed_lubrication.mixed_friction`; formulas of smooth
contacts stand in `epicyclic.kernels.line_contact`.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from epicyclic.arrays import FloatArray, log, pow, row_by_row, sqrt
from epicyclic.contact.line_contact import LineContacts
from epicyclic.dataclass import dataclass
from epicyclic.gears.flanks import (
    HURST_EXPONENT,
    MIDDLE_OF_CLASS,
    PROFILE_CUTOFF,
    RA_OVER_RQ,
    RUNNING_IN,
)
from epicyclic.kernels import mixed_lubrication as kernels
from epicyclic.oil.oil import D341_OFFSET, MM2_PER_S, OilState


@dataclass(frozen=True, slots=True)
class Surfaces:
    """What of the roughness acts."""

    pointwise = True

    running_in: float = RUNNING_IN
    cutoff: float | None = None  # Of the measured profiles; None: `usual_cutoff`. [m]
    hurst_exponent: float = HURST_EXPONENT


RUN_IN = Surfaces()


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


def mixed_friction(
    contact: LineContacts,
    surfaces: Surfaces,
    boundary: float | None = None,  # mu_b; None: that of the oil. [1]
    film: FloatArray | None = None,  # None: `central_film`. [m]
) -> FloatArray:
    """mu of each contact, as the kernel of this name has it. [1]"""
    oil, flanks = contact.oil, contact.flanks
    assert isinstance(oil, OilState)
    heights = acting_heights(contact.roughness, surfaces)
    of_flanks = flanks.equivalent_modulus, *flanks.effusivities, *heights, surfaces.hurst_exponent
    boundary = oil.boundary_friction if boundary is None else boundary
    inlet = oil.dynamic_viscosity, oil.thermal_load(1.0), oil.thermal_conductivity
    places = contact.line_load, contact.radius, contact.rolling_speed, contact.sliding_speed
    films = np.empty((1, 0)) if film is None else film
    of_oil = *_oil_constants(oil), *inlet, boundary
    return row_by_row(kernels.mixed_friction, (*places, films), of_flanks, of_oil)


def acting_heights(roughness: Iterable[float], surfaces: Surfaces) -> list[float]:
    """f Rq [m] and l_c^H of both flanks, as `acting_roughness` of the kernels takes them."""
    found = []
    for height in roughness:
        cutoff = usual_cutoff(height) if surfaces.cutoff is None else surfaces.cutoff
        found += [surfaces.running_in * height, pow(cutoff, surfaces.hurst_exponent)]
    return found


def _oil_constants(oil: OilState) -> tuple[float, ...]:
    """As `eyring_stress` takes them: the line of ASTM D341 that touches at this temperature."""
    viscosity = oil.kinematic_viscosity / MM2_PER_S
    shifted = viscosity + D341_OFFSET
    return (
        oil.temperature,
        log(shifted),
        log(viscosity),
        oil.d341_slope,
        oil.density * MM2_PER_S,
        oil.pressure_viscosity,
        oil.pressure_viscosity_exponent,
        oil.limiting_traction,
    )
