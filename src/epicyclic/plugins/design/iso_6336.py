"""Pitting and bending of involute gears after ISO 6336-1, -2, -3 and -5, method B: formulas.

Second hand: taken from the trade's common knowledge of the editions of 2006 and checked on the
factors and stresses that KISSsoft 03/2017 prints for the gearbox of 5 MW of the NREL. Covered: the
nominal stresses of external and internal meshes, spur and helical, the load factors, life factors
and the factors of oil, speed, roughness, hardness, notch and size. Not covered: overload at rest,
protuberance, grinding notches, thin rims, and shrink fits.

SI units, but for empirical formulas that say so.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cached_property
from statistics import fmean
from typing import Literal

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass, replace
from epicyclic.gears.cutting import RackTool, Tool, fit_tool
from epicyclic.gears.gear import Gear, involute
from epicyclic.gears.mesh import Mesh

Numbers = FloatArray | float
MM, MPA = 1e3, 1e-6
Treatment = Literal["case-hardened", "through-hardened", "nitrided"]

# Pitting: stresses.


def zone_factor(mesh: Mesh) -> float:
    """Z_H. ISO 6336-2, Eq. 16. [1]"""
    rack, angle = mesh.gear1.rack, mesh.operating_pressure_angle
    top = 2 * math.cos(rack.base_helix_angle) / math.tan(angle)
    return math.sqrt(top) / math.cos(rack.transverse_pressure_angle)


def contact_ratio_factor(mesh: Mesh) -> float:
    """Z_eps. ISO 6336-2, Eq. 21 to 24. [1]"""
    alpha, beta = mesh.transverse_contact_ratio, min(mesh.overlap_ratio, 1.0)
    spur = max(0.0, (4 - alpha) / 3)
    return math.sqrt(spur * (1 - beta) + beta / alpha)


def elasticity_factor(equivalent_modulus: float) -> float:
    """Z_E of two bodies whose modulus for Hertz is E_eq. ISO 6336-2, Eq. 18. [Pa^0.5]"""
    return math.sqrt(equivalent_modulus / (2 * math.pi))


def single_contact_factors(mesh: Mesh) -> tuple[float, float]:
    """Z_B and Z_D: pressure at the inner points of single contact over that at the pitch point.

    ISO 6336-2, Eq. 25 to 29; between spur gears and an overlap ratio of 1, Z falls linearly to 1.
    """
    pitch = mesh.gear1.rack.transverse_base_pitch
    places = (mesh.path_end - pitch, mesh.path_start + pitch)
    at_pitch = mesh.equivalent_radius(mesh.pitch_point)
    overlap = min(mesh.overlap_ratio, 1.0)
    found = []
    for place in places:
        radius = mesh.equivalent_radius(place) if mesh.path_start < place < mesh.path_end else 0.0
        spur = math.sqrt(at_pitch / radius) if radius > 0 else 1.0
        found.append(max(1.0, spur - overlap * (spur - 1)))
    return found[0], 1.0 if mesh.internal else found[1]


def nominal_contact_stress(mesh: Mesh, tangential: float, equivalent_modulus: float) -> float:
    """sigma_H0 at the pitch point. ISO 6336-2, Eq. 5. [Pa]

    `tangential` is F_t at the reference circle. [N]
    """
    ratio = (mesh.ratio + mesh.side) / mesh.ratio
    load = tangential / (2 * mesh.gear1.reference_radius * mesh.face_width) * ratio
    factors = zone_factor(mesh) * elasticity_factor(equivalent_modulus)
    helix = 1 / math.sqrt(math.cos(mesh.gear1.rack.helix_angle))  # Z_beta, corrigendum of 2008
    return factors * contact_ratio_factor(mesh) * helix * math.sqrt(load)


# Bending: form and stress correction of a tooth root.


@dataclass(frozen=True)
class ToothRoot:
    """The critical section of a tooth root, loaded at the outer point of single contact."""

    arm: float  # h_Fe. [m]
    thickness: float  # s_Fn. [m]
    radius: float  # rho_F. [m]
    load_angle: float  # alpha_Fen. [rad]
    module: float  # m_n. [m]
    pressure_angle: float  # alpha_n. [rad]

    @cached_property
    def form_factor(self) -> float:
        """Y_F. ISO 6336-3, Eq. 9. [1]"""
        arm, thickness = self.arm / self.module, self.thickness / self.module
        bend = 6 * arm * math.cos(self.load_angle)
        return bend / (thickness**2 * math.cos(self.pressure_angle))

    @cached_property
    def notch(self) -> float:
        """q_s. ISO 6336-3, Eq. 38. [1]"""
        return self.thickness / (2 * self.radius)

    @cached_property
    def stress_correction(self) -> float:
        """Y_S. ISO 6336-3, Eq. 36. [1]"""
        slender = self.thickness / self.arm
        return (1.2 + 0.13 * slender) * math.pow(self.notch, 1 / (1.21 + 2.3 / slender))


def tooth_root(gear: Gear, tool: Tool, transverse_contact_ratio: float) -> ToothRoot:
    """Section at the tangent of 30 degrees, of internal gears 60. ISO 6336-3, Eq. 10 to 35.

    In normal modules on the virtual spur gear, whose number of teeth is negative for a ring.
    """
    rack, sign = gear.rack, gear.side
    module, alpha = rack.normal_module, rack.normal_pressure_angle
    base = math.cos(rack.base_helix_angle) ** 2
    teeth = sign * gear.teeth / (base * math.cos(rack.helix_angle))
    shift = gear.profile_shift_coefficient
    depth = sign * (gear.reference_radius - gear.root_radius) / module + shift  # h_fP
    rounding = fit_tool(gear, tool).tool_radius  # less than stated where the tip of the tool ends
    radius = _tool_radius(replace(tool, tip_radius=rounding), depth, module)
    limit, narrow, short = math.pi / 3, math.sqrt(3), 1.0
    if gear.internal:
        limit, narrow, short = math.pi / 6, 1.0, math.sqrt(3)
    land = math.pi / 4 - depth * math.tan(alpha) - (1 - math.sin(alpha)) * radius / math.cos(alpha)
    shape = radius - depth + shift  # G
    offset = 2 / teeth * (math.pi / 2 - land) - limit  # H
    angle = limit
    for _ in range(100):
        angle = 2 * shape / teeth * math.tan(angle) - offset
    centre = shape / math.cos(angle) - radius
    size = abs(teeth) * math.cos(angle) ** 2 - 2 * shape
    # where the load acts, on a circle of diameter d_en
    tip = abs(teeth) + 2 * (gear.tip_form_radius - gear.reference_radius) / module
    own = abs(teeth) * math.cos(alpha)
    beyond = math.pi * math.cos(alpha) * (transverse_contact_ratio / base - 1)
    roll = math.sqrt(max(0.0, (tip / 2) ** 2 - (own / 2) ** 2)) - sign * beyond
    circle = 2 * sign * math.hypot(max(roll, 0.0), own / 2)
    at_load = math.acos(own / abs(circle))
    turn = (math.pi / 2 + 2 * math.tan(alpha) * shift) / teeth + involute(alpha)
    turn -= involute(at_load)
    load_angle = at_load - turn
    lever = (math.cos(turn) - math.sin(turn) * math.tan(load_angle)) * circle
    return ToothRoot(
        arm=module * (lever - teeth * math.cos(limit - angle) - short * centre) / 2,
        thickness=module * (teeth * math.sin(limit - angle) + narrow * centre),
        radius=module * (radius + 2 * shape**2 / (math.cos(angle) * size)),
        load_angle=load_angle,
        module=module,
        pressure_angle=alpha,
    )


def _tool_radius(tool: Tool, depth: float, module: float) -> float:
    """rho_fP of a rack, or of that in place of a shaper cutter. ISO 6336-3, Eq. 16. [m_n]"""
    radius = tool.tip_radius / module
    if isinstance(tool, RackTool):
        return radius
    reach = max(0.0, tool.profile_shift_coefficient + depth - radius)
    return radius + math.pow(reach, 1.95) / (3.156 * math.pow(1.036, tool.teeth))


def helix_factor_bending(mesh: Mesh) -> float:
    """Y_beta. ISO 6336-3, Eq. 46. [1]"""
    helix = min(math.degrees(mesh.gear1.rack.helix_angle), 30.0)
    return 1 - min(mesh.overlap_ratio, 1.0) * helix / 120


def nominal_root_stress(mesh: Mesh, root: ToothRoot, tangential: float, width: float) -> float:
    """sigma_F0. ISO 6336-3, Eq. 4. [Pa]"""
    factors = root.form_factor * root.stress_correction * helix_factor_bending(mesh)
    return tangential / (width * root.module) * factors


# Load factors of ISO 6336-1, method B.


def running_in(treatment: Treatment, strength: float, deviation: float) -> float:
    """y_alpha of a deviation. ISO 6336-1, Eq. 77 and 81. [m]"""
    if treatment == "through-hardened":
        return min(1.0, 160 / (strength * MPA)) * deviation
    return min(3e-6, 0.075 * deviation)


def running_in_relief(strengths: Iterable[float]) -> float:
    """C_ay of gears without tip relief, mean of both sigma_Hlim. ISO 6336-1, second hand. [m]"""
    return fmean((it * MPA / 97 - 18.45) ** 2 / 18 + 1.5 for it in strengths) * 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Excitation:
    """What moves the teeth of a mesh against each other beside its load."""

    stiffness: float  # c_gamma_alpha, over the face width. [Pa]
    contact_ratio: float  # epsilon_alpha. [1]
    total_contact_ratio: float  # epsilon_gamma. [1]
    pitch_deviation: float  # f_pb or f_f_alpha, the larger one, less running-in. [m]
    form_deviation: float  # f_f_alpha less running-in. [m]
    tip_relief: float  # C_a, of either gear the smaller one; without any C_ay. [m]

    def transverse_shares(self, load: float, contact_ratio_factor: float) -> tuple[float, float]:
        """K_Halpha and K_Falpha, at most as of one pair of teeth. ISO 6336-1, Eq. 75, 76. [1]"""
        ratio, found = self.contact_ratio, self.transverse_factor(load)
        bounds = ratio * contact_ratio_factor**2, 0.25 * ratio + 0.75
        of_flank, of_root = (max(1.0, min(found, self.total_contact_ratio / it)) for it in bounds)
        return of_flank, of_root

    def transverse_factor(self, load: float) -> float:
        """K_Halpha at F_tH over the face width [N/m], at least 1. ISO 6336-1, Eq. 73, 74. [1]"""
        open_ = 0.4 * self.stiffness * self.pitch_deviation / load
        total = self.total_contact_ratio
        found = total / 2 * (0.9 + open_)
        if total > 2:
            found = 0.9 + open_ * math.sqrt(2 * (total - 1) / total)
        return max(1.0, found)

    def dynamic_factor(self, load: float, resonance: float) -> float:
        """K_v at K_A K_gamma F_t over the face width [N/m]. ISO 6336-1, Eq. 13 to 23. [1]

        `resonance` is the speed over that of the resonance, N.
        """
        total = max(self.total_contact_ratio, 1.0)
        single = self.stiffness / (0.75 * self.contact_ratio + 0.25)  # c'
        pitch, form = (single * it / load for it in (self.pitch_deviation, self.form_deviation))
        relief = abs(1 - single * self.tip_relief / load)
        wide = total > 2
        c2 = 0.57 / (total - 0.3) if wide else 0.34
        c3 = 0.096 / (total - 1.56) if wide else 0.23
        c4 = (0.57 - 0.05 * total) / (total - 1.44) if wide else 0.90
        c6 = 0.12 / (total - 1.74) if wide else 0.47
        c7 = 0.75
        if total > 1.5:
            c7 = 1.0 if total > 2.5 else 0.125 * math.sin(math.pi * (total - 2)) + 0.875
        below = 0.32 * pitch + c2 * form + c3 * relief
        main = 1 + 0.32 * pitch + c2 * form + c4 * relief
        above = 0.47 * pitch + c6 * form + c7
        lightly = min(load / 100e3, 1.0)  # N_S of ISO 6336-1 below 100 N/mm, second hand
        if resonance <= 0.5 + 0.35 * math.sqrt(lightly):
            return 1 + resonance * below
        if resonance <= 1.15:
            return main
        if resonance < 1.5:
            return above + (main - above) * (1.5 - resonance) / 0.35
        return above


def face_factor_bending(face_factor: float, width: float, depth: float) -> float:
    """K_Fbeta. ISO 6336-1, Eq. 69. [1]"""
    slender = min(depth / width, 1 / 3)
    return math.pow(face_factor, 1 / (1 + slender + slender**2))


# What a material bears.


def life_factor(cycles: Numbers, knees: tuple[tuple[float, float], ...]) -> FloatArray:
    """Z_NT or Y_NT: straight in the logarithms between `knees`, cycles and factor. [1]"""
    at, factors = np.log(knees).T
    return np.asarray(np.exp(np.interp(np.log(np.maximum(cycles, 1.0)), at, factors)))


PITTING_LIFE: dict[Treatment, tuple[tuple[float, float], ...]] = {
    "case-hardened": ((1e5, 1.6), (5e7, 1.0), (1e10, 0.85)),
    "through-hardened": ((1e5, 1.6), (5e7, 1.0), (1e10, 0.85)),
    "nitrided": ((1e5, 1.3), (2e6, 1.0), (1e10, 0.85)),
}
"""Z_NT without any pitting. ISO 6336-2, table 2."""
BENDING_LIFE: dict[Treatment, tuple[tuple[float, float], ...]] = {
    "case-hardened": ((1e3, 2.5), (3e6, 1.0), (1e10, 0.85)),
    "through-hardened": ((1e4, 2.5), (3e6, 1.0), (1e10, 0.85)),
    "nitrided": ((1e3, 1.6), (3e6, 1.0), (1e10, 0.85)),
}
"""Y_NT. ISO 6336-3, table 1."""


def _between(strength: float, low: float, high: float, slope: tuple[float, float]) -> float:
    """A factor constant below 850 and above 1200 MPa and straight between. [1]"""
    value = strength * MPA
    if value < 850:
        return low
    return high if value > 1200 else slope[0] * value + slope[1]


def oil_factor(strength: float, viscosity40: float) -> float:
    """Z_L. ISO 6336-2, Eq. 36. [1] `strength` is sigma_Hlim of the softer gear."""
    least = _between(strength, 0.83, 0.91, (1 / 4375, 0.6357))
    return least + 4 * (1 - least) / (1.2 + 134 / (viscosity40 * 1e6)) ** 2


def speed_factor(strength: float, speed: float) -> float:
    """Z_v. ISO 6336-2, Eq. 38. [1]"""
    least = _between(strength, 0.85, 0.93, (1 / 4375, 0.6557))
    return least + 2 * (1 - least) / math.sqrt(0.8 + 32 / max(speed, 1e-3))


def roughness_factor(strength: float, height: float, radius: float) -> float:
    """Z_R with the mean peak-to-valley height of both flanks. ISO 6336-2, Eq. 42. [1]"""
    exponent = _between(strength, 0.15, 0.08, (-0.0002, 0.32))
    rz10 = height * 1e6 * math.pow(10 / (radius * MM), 1 / 3)
    return math.pow(3 / rz10, exponent)


def hardening_factor(
    hardness: float,  # Of the softer gear, Brinell.
    equivalent_height: float,  # R_zH of the harder flank, held at 3 to 16 um. [m]
) -> float:
    """Z_W of a through-hardened gear with a hard, smooth mate. ISO 6336-2, Eq. 46. [1]"""
    height = min(max(equivalent_height * 1e6, 3.0), 16.0)
    soft = 1.2 - (min(max(hardness, 130.0), 470.0) - 130) / 1700
    return soft * math.pow(3 / height, 0.15)


def notch_sensitivity(root: ToothRoot, slip_layer: float) -> float:
    """Y_delta_relT with the thickness rho' of the slip layer [m]. ISO 6336-3, Eq. 60. [1]"""
    layer = slip_layer * MM
    own = math.sqrt(layer * (1 + 2 * root.notch) / 5)
    return (1 + own) / (1 + math.sqrt(layer * 1.2))


def root_surface_factor(treatment: Treatment, height: float) -> float:
    """Y_RrelT with R_z of the root. ISO 6336-3, Eq. 66 to 71. [1]"""
    value = max(height * 1e6, 1.0)
    if treatment == "nitrided":
        return 4.299 - 3.259 * math.pow(value + 1, 0.0058)
    return 1.674 - 0.529 * math.pow(value + 1, 0.1)


def size_factor_bending(treatment: Treatment, module: float) -> float:
    """Y_X. ISO 6336-3, table 5. [1]"""
    size = module * MM
    if treatment == "through-hardened":
        return min(1.0, max(0.85, 1.03 - 0.006 * size))
    return min(1.0, max(0.80, 1.05 - 0.01 * size))
