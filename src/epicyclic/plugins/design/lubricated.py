"""Micropitting after ISO/TS 6336-22 and scuffing after -20 and -21: films, temperatures, oils.

Second hand, checked on print-outs of KISSsoft 03/2017 (ISO/TR 15144-1:2014, ISO/TR 13989:2000).
Covered: the film of the flank under the pressure of a point, the film that the oil bears in the
test FVA 54/7, the scuffing temperatures that the test FZG A/8.3/90 tells. Functions take arrays,
so that the fields of a computed contact serve as well as single points; SI units.
"""

from __future__ import annotations

import math
from functools import cache
from types import MappingProxyType

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.contact.temperatures import (
    LUBRICATION_FACTORS,
    bulk_rise_of_loss,
    iso_mean_friction,
    roughness_factor,
)
from epicyclic.dataclass import dataclass
from epicyclic.gears.gear import BasicRack, Gear, half_angle_from_profile_shift
from epicyclic.gears.mesh import Mesh
from epicyclic.kernels.line_contact import flash_temperature, hertz_half_width, hertz_pressure
from epicyclic.losses.mesh import ohlendorf_loss_factor
from epicyclic.machine.heat import HOTTEST
from epicyclic.oil.oil import Oil, oil_state

Numbers = FloatArray | float
ZERO_CELSIUS, REFERENCE = 273.15, 38.0 + 273.15
SCUFFING_TORQUES = (
    3.3, 13.7, 35.3, 60.8, 94.1, 135.3, 183.4, 239.3, 302.0, 372.6, 450.1, 534.5, 626.9, 714.2
)  # fmt: skip
"""T_1T on the pinion in the load stages 1 to 14 of FZG A/8.3/90; 13 and 14 second hand. [N m]"""
MICROPITTING_TORQUES = MappingProxyType({5: 70.0, 6: 98.9, 7: 132.5, 8: 171.6, 9: 215.6, 10: 265.1})
"""T_1 on the pinion in the load stages of FVA 54/7. [N m]"""


def film_oil(oil: Oil, temperature: Numbers) -> tuple[FloatArray, FloatArray]:
    """eta [Pa s], and alpha from that at 38 degC [1/Pa], at temperatures in kelvin.

    ISO/TS 6336-22, Eq. 9.
    """
    held = np.minimum(temperature, HOTTEST)  # hotter flashes leave no film
    viscosity = [oil_state(oil, it).dynamic_viscosity for it in np.atleast_1d(held)]
    at38 = oil_state(oil, REFERENCE).pressure_viscosity
    alpha = np.asarray(at38 * (1 + 516 * (1 / held - 1 / REFERENCE)))
    return np.reshape(viscosity, np.shape(held)), alpha


def film_thickness(
    radius: Numbers,  # Equivalent radius of curvature, normal section. [m]
    speed_sum: Numbers,  # Of both surfaces. [m/s]
    pressure: Numbers,  # p_dyn, with all load factors. [Pa]
    modulus: float,  # E_r. [Pa]
    # eta and alpha at the bulk temperature, and at the contact temperature.
    bulk: tuple[Numbers, Numbers],
    contact: tuple[Numbers, Numbers],
) -> FloatArray:
    """h_Y. ISO/TS 6336-22, Eq. 4 to 12. [m]

    Examples
    --------
    The planet stage of the print-out, at the point E:

    >>> h = film_thickness(32.45e-3, 2.6, 784.5e6, 226.4e9, (31.7e-3, 19e-9), (25e-3, 18e-9))
    >>> bool(0.2e-6 < h < 0.5e-6)
    True
    """
    viscosity, alpha = bulk
    material = alpha * modulus
    speed = viscosity * speed_sum / (2 * modulus * radius)
    load = 2 * math.pi * (pressure / modulus) ** 2
    sliding = contact[0] * contact[1] / (viscosity * alpha)
    return np.asarray(
        1.6 * radius * material**0.6 * speed**0.7 * load**-0.13 * sliding**0.22, dtype=float
    )


@dataclass(frozen=True, slots=True)
class ReferenceFilm:
    """The film at the point A of the test gears C-GF in a load stage."""

    bulk_temperature: float  # [K]
    ratio: float  # lambda_GFT. [1]

    @property
    def permissible(self) -> float:
        """lambda_GFP for case-hardened flanks, W_W = 1: 1.4 lambda_GFT. [1]"""
        return 1.4 * self.ratio


TEST_ROUGHNESS, TEST_WIDTH, TEST_SPEED = 0.5e-6, 14e-3, 2250 * math.pi / 30
LOAD_AT_A = 236.3e3 / 265.1  # Line load at A over the torque; print-out. [1/m2]
TEST_OIL = 90 + ZERO_CELSIUS  # Temperature of the oil. [K]
_TEST_MODULUS, _TEST_EFFUSIVITY = 206e9 / (1 - 0.3**2), 12.427e3


@cache
def fzg_mesh() -> Mesh:
    """The gears C-GF of the FZG test rig, without the tip relief that they do not have."""
    rack = BasicRack(4.5e-3, math.radians(20.0), 0.0)
    made = []
    for name, teeth, shift, tip in (
        ("pinion", 16, 0.1817, 82.45e-3),
        ("gear", 24, 0.1715, 118.37e-3),
    ):
        half = half_angle_from_profile_shift(rack, teeth, shift)
        root = (teeth / 2 - 1.25 + shift) * 4.5e-3
        made.append(Gear(name, rack, teeth, False, half, tip / 2, root, TEST_WIDTH))
    return Mesh("test", made[0], made[1], 91.5e-3)


@cache
def reference_film(oil: Oil, stage: int) -> ReferenceFilm:
    """What the oil bears in the test FVA 54/7: the film at A in its failure load stage."""
    mesh, torque = fzg_mesh(), MICROPITTING_TORQUES[stage]
    state = oil_state(oil, TEST_OIL)
    base = mesh.gear1.base_radius
    speed = 2 * TEST_SPEED * mesh.pitch_point
    radius = mesh.equivalent_radius(mesh.pitch_point)
    friction = iso_mean_friction(
        torque / base / TEST_WIDTH,
        speed,
        radius,
        state.dynamic_viscosity,
        roughness_factor(TEST_ROUGHNESS, radius),
        oil.lubricant_factor.value,
    )
    loss = torque * TEST_SPEED * friction * ohlendorf_loss_factor(mesh)
    bulk = TEST_OIL + bulk_rise_of_loss(
        loss, mesh.center_distance, TEST_WIDTH, LUBRICATION_FACTORS["spray"]
    )
    at_a = mesh.path_start
    load, own = LOAD_AT_A * torque, mesh.equivalent_radius(at_a)
    v1, v2 = TEST_SPEED * at_a, TEST_SPEED / mesh.ratio * mesh.curvature2(at_a)
    flash = flash_temperature(
        friction,
        load,
        v1 - v2,
        v1,
        v2,
        hertz_half_width(load, own, _TEST_MODULUS),
        _TEST_EFFUSIVITY,
        _TEST_EFFUSIVITY,
    )
    touching = bulk + float(flash)
    film = film_thickness(
        own,
        v1 + v2,
        hertz_pressure(load, own, _TEST_MODULUS),
        _TEST_MODULUS,
        film_oil(oil, bulk),
        film_oil(oil, touching),
    )
    return ReferenceFilm(bulk, float(film) / TEST_ROUGHNESS)


def scuffing_temperature(stage: int, viscosity: float, lubricant_factor: float) -> float:
    """theta_S of the flash temperature method with the oil at its own temperature. [K]

    ISO/TS 6336-20, Eq. 25: 80 degC + (0.85 + 1.4 X_W) X_L S^2, X_L from the viscosity [Pa s]; X_W
    of the structure of the steel is 1.

    Examples
    --------
    >>> round(scuffing_temperature(14, 30.09e-3, 1.0) - 273.15, 2)
    451.98
    """
    oil = lubricant_factor * math.pow(viscosity * 1e3, -0.05)
    return ZERO_CELSIUS + 80 + (0.85 + 1.4) * oil * stage**2


def integral_scuffing_temperature(stage: int, viscosity40: float, lubricant_factor: float) -> float:
    """theta_Sint of the integral method. ISO/TS 6336-21, second hand. [K]

    Bulk 80 + 0.23 T X_L and flash 0.2 T (100/nu40)^0.02 X_L of the test, weighted by 1.5.

    Examples
    --------
    >>> round(integral_scuffing_temperature(14, 220e-6, 1.0) - 273.15, 2)
    455.17
    """
    torque = SCUFFING_TORQUES[stage - 1] * lubricant_factor
    flash = 0.2 * torque * math.pow(100 / (viscosity40 * 1e6), 0.02)
    return ZERO_CELSIUS + 80 + 0.23 * torque + 1.5 * flash


def integral_temperature(bulk: float, mean_flash: float) -> float:
    """theta_int with C2 = 1.5. ISO/TS 6336-21, second hand. [K]

    Examples
    --------
    >>> bulk = integral_bulk(80 + 273.15, 16.25, 1.0)
    >>> round(integral_temperature(bulk, 16.25) - 273.15, 2)
    115.75
    """
    return bulk + 1.5 * mean_flash


def integral_bulk(oil: float, mean_flash: float, factor: float) -> float:
    """Bulk temperature with C1 = 0.7; `factor` is X_S X_mp. ISO/TS 6336-21, second hand. [K]"""
    return oil + 0.7 * factor * mean_flash


def flash_safety(scuffing: float, contact: float, oil: float) -> float:
    """S_B: rises above the oil, permissible over highest. ISO/TS 6336-20. [1]"""
    return (scuffing - oil) / (contact - oil)


LEAST_MEAN = 1.0
"""Integral temperature in degC, at least: the quotient has no meaning below, in cold oil. [K]"""


def integral_safety(scuffing: float, integral: float) -> float:
    """S_intS: temperatures in degC, permissible over weighted mean. ISO/TS 6336-21. [1]"""
    return (scuffing - ZERO_CELSIUS) / max(integral - ZERO_CELSIUS, LEAST_MEAN)
