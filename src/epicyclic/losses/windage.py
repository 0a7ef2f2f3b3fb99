"""Drag at any speed: rims and faces from creeping to turbulent flow, teeth, gaps, arms."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, NamedTuple

from scipy.special import lambertw

from epicyclic.losses.ranges import ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.oil.oil import MixtureState
from epicyclic.units import NUMBER

DragModel = Literal[
    "seetharaman-kahraman", "theodorsen-regier", "diab-ville-velex", "anderson-loewenthal"
]
_SMOOTH = (
    "T. Theodorsen, A. Regier, NACA Report 793 (1944); T. von Karman, ZAMM 1 (1921) 233; walls "
    "beside: E. Bilgen, R. Boulos, J. Fluids Eng. 95 (1973) 122, J. W. Daily, R. E. Nece, J. Basic "
    "Eng. 82 (1960) 217, second hand"
)
DRAG_METHODS: Mapping[DragModel, tuple[str, str]] = {
    "seetharaman-kahraman": (
        "drag of a disc in the air-oil mixture",
        "Seetharaman and Kahraman, Tribol. Trans. 53 (2010) 473; Talbot (2012), Eq. 5.4, 5.5",
    ),
    "theodorsen-regier": ("drag of smooth rims and faces, laminar to turbulent", _SMOOTH),
    "diab-ville-velex": (
        "drag of rims and faces, laminar to turbulent; windage of teeth after Diab, Ville, Velex",
        "Y. Diab, F. Ville, P. Velex, C. Changenet, J. Mech. Des. 126 (2004) 903, second hand; "
        + _SMOOTH,
    ),
    "anderson-loewenthal": (
        "windage of gears after Anderson and Loewenthal; drag of other rims and faces",
        "N. E. Anderson, S. H. Loewenthal, NASA TP-1622 (1980), second hand; " + _SMOOTH,
    ),
}
"""Title and source of each model of drag."""

RIM_TRANSITION = 60.0  # omega r^2/nu at which the flow around a cylinder turns turbulent. [1]
TAYLOR_NUMBER = 41.3
"""Re_t sqrt(t/r) at which vortices arise in a narrow gap t (Taylor 1923). [1]"""
FACE_TRANSITION = 3e5
"""omega r^2/nu about which the flow on a free disc turns turbulent (von Karman). [1]"""
TRANSITION_WIDTH = 2.0
"""Factor below and above the transition within which one law passes into the other: of this
package, as the tests of Theodorsen and Regier scatter by no less. [1]"""
SHARPNESS = 8  # Exponent of the mean that takes the larger, or the smaller, law without a kink.
SLOPE = 4.07 / math.log(10.0)  # Theodorsen and Regier: 1/sqrt(C_d) = -0.6 + 4.07 lg(Re sqrt(C_d))
OFFSET = 0.6
MIST_SHARE = 0.005
"""Share of oil up to which drops follow the flow through the teeth. Of this package: that below
which pockets count as filled with gas. [1]"""
FREE_FLANGE = 0.5  # Distance of a flange over the radius from which it has no effect (Diab). [1]
BLUNT = 1.2  # Drag coefficient of a long cylinder across the flow (Hoerner), general knowledge. [1]
_DISCS = Range(
    "reynolds_number",
    "Reynolds number of the faces",
    None,
    7e6,
    NUMBER,
    "tests with discs, Theodorsen and Regier, NACA Report 793 (1944)",
)


def passage(laminar: float, turbulent: float, reynolds: float, transition: float) -> float:
    """A coefficient that passes from one law to the other without a kink. Theory (V7)."""
    place = math.log(reynolds / transition) / math.log(TRANSITION_WIDTH)
    share = min(max((place + 1) / 2, 0.0), 1.0)
    return laminar + (turbulent - laminar) * share**2 * (3 - 2 * share)


def _largest(*coefficients: float, power: int = SHARPNESS) -> float:
    """The largest of some laws, of which none leaves with a kink; the smallest with -`SHARPNESS`.

    Theory (V7).
    """
    about = max(coefficients) if power > 0 else min(coefficients)
    return about * math.pow(sum((it / about) ** power for it in coefficients), 1 / power)


def turbulent_rim(reynolds: float) -> float:
    """C_d of a cylinder by 1/sqrt(C_d) = -0.6 + 4.07 lg(Re sqrt(C_d)). Theory (V8). [1]

    Theodorsen and Regier (1944); solved for C_d by Lambert's function.

    Examples
    --------
    >>> [round(turbulent_rim(it), 5) for it in (5612, 12049, 22751)]
    [0.00907, 0.00735, 0.00625]
    """
    root = SLOPE * lambertw(reynolds * math.exp(-OFFSET / SLOPE) / SLOPE).real
    return float(1 / root**2)


def rim_coefficient(
    reynolds: float,  # omega r^2/nu. [1]
    gap: float | None = None,  # To a wall around the rim, over the radius. [1]
) -> float:
    """C_d of a rim, tau = C_d rho (omega r)^2/2, laminar to turbulent. Theory (V9). [1]

    Laminar the exact 4/Re, or Couette's flow in a gap; turbulent Theodorsen and Regier, or Bilgen
    and Boulos where a wall near by holds the fluid back.

    Examples
    --------
    A free rim, laminar and turbulent, and one in a gap of a tenth of its radius:

    >>> round(rim_coefficient(20.0), 4), round(rim_coefficient(14000.0), 5)
    (0.2, 0.00706)
    >>> round(rim_coefficient(14000.0, 0.1), 5)
    0.00647
    """
    couette, transition = 4 / reynolds, RIM_TRANSITION
    if gap is not None:
        couette /= 1 - (1 + gap) ** -2
        transition = max(transition, TAYLOR_NUMBER * gap**-1.5)
    if reynolds < transition / TRANSITION_WIDTH:
        return couette
    turbulent = turbulent_rim(reynolds)
    if gap is not None:
        within = gap * reynolds
        walls = math.pow(gap, 0.3) * _largest(1.03 * within**-0.5, 0.065 * within**-0.2) / 2
        turbulent = _largest(walls, turbulent, power=-SHARPNESS)
    return passage(couette, turbulent, reynolds, transition)


def face_coefficient(
    reynolds: float,  # omega r^2/nu. [1]
    gap: float | None = None,  # To walls beside both faces, over the radius. [1]
) -> float:
    """C_M of both faces, T = C_M rho omega^2 r^5/2, creeping to turbulent. Theory (V10). [1]

    Free: 64/(3 Re) of Lamb, 3.87 Re^-1/2 and 0.146 Re^-1/5 of von Karman; beside walls the four
    regimes of Daily and Nece.

    Examples
    --------
    >>> [round(face_coefficient(it), 5) for it in (1.0, 1e4, 2e6)]
    [21.33333, 0.0387, 0.00802]
    >>> round(face_coefficient(1e4, 0.02), 5)
    0.03407
    """
    free = _largest(64 / (3 * reynolds), 3.87 * reynolds**-0.5)
    free = passage(free, 0.146 * reynolds**-0.2, reynolds, FACE_TRANSITION)
    if gap is None:
        return free
    merged = 2 * math.pi / (gap * reynolds), 0.08 * math.pow(gap, -1 / 6) * reynolds**-0.25
    apart = _largest(3.7 * reynolds**-0.5, 0.102 * reynolds**-0.2) * math.pow(gap, 0.1)
    return _largest(*merged, _largest(apart, free, power=-SHARPNESS))


@dataclass(frozen=True, slots=True)
class Teeth:
    """Teeth around a body."""

    number: int
    pitch_radius: float  # That of the reference circle. [m]
    tip_radius: float  # [m]
    width: float  # [m]
    space: float  # Angle of a tooth space at the tip circle. [rad]


def tooth_coefficient(teeth: Teeth, flange: float | None = None) -> float:
    """C of the teeth, T = C rho omega^2 R^5/2, after Diab et al. (2004). Theory (V11). [1]

    C = z/4 (b/R) (R_a/R)^4 (1 - cos phi) (1 + cos phi)^3, phi the tooth space at the tip, second
    hand; less beside flanges at a distance h < R/2, by the exponent 0.56 of the same authors.

    Examples
    --------
    72 teeth of module 4 mm, 30 mm wide, in the open and between flanges at 3 mm:

    >>> gear = Teeth(72, 0.144, 0.148, 0.03, 0.0658)
    >>> round(tooth_coefficient(gear), 4), round(tooth_coefficient(gear, 0.003), 4)
    (0.0721, 0.012)
    """
    ratio, cosine = teeth.tip_radius / teeth.pitch_radius, math.cos(teeth.space)
    open_gear = teeth.number / 4 * teeth.width / teeth.pitch_radius * ratio**4
    near = 1.0
    if flange is not None:
        near = math.pow(flange / (FREE_FLANGE * teeth.pitch_radius), 0.56)
        near = _largest(near, 1.0, power=-SHARPNESS)
    return open_gear * (1 - cosine) * (1 + cosine) ** 3 * near


def anderson_loewenthal(
    teeth: Teeth,
    speed: float,  # [rad/s]
    viscosity: float,  # Dynamic, of the oil. [Pa s]
) -> float:
    """Windage of a gear in one part of oil and 34.25 of air, second hand. Theory (V12). [W]

    P = 2.82e-7 (1 + 2.3 b/r) n^2.8 r^4.6 (0.028 mu + 0.019)^0.2; kW, rpm, m, mPa s. Faces and rim
    are in it.

    Examples
    --------
    >>> gear = Teeth(27, 0.0293, 0.0318, 0.03, 0.2)
    >>> round(anderson_loewenthal(gear, 20000 * math.pi / 30, 7e-3), 1)
    67.8
    """
    radius, rpm = teeth.pitch_radius, abs(speed) * 30 / math.pi
    thickness = math.pow(0.028 * viscosity * 1e3 + 0.019, 0.2)
    shape = 1 + 2.3 * teeth.width / radius
    return 1e3 * 2.82e-7 * shape * math.pow(rpm, 2.8) * math.pow(radius, 4.6) * thickness


@dataclass(frozen=True, slots=True)
class Turning:
    """A body that turns in the mixture."""

    radius: float  # [m]
    width: float  # Of its rim. [m]
    teeth: Teeth | None = None
    # To a shroud around the rim, and to walls beside both faces, if there are any. [m]
    radial_gap: float | None = None
    axial_gap: float | None = None
    # Sum of width, diameter and cubed distance from the axis of cylinders that stand across the
    # flow: planets in an open carrier. [m^5]
    across: float = 0.0


class Fluid(NamedTuple):
    """What a body turns in."""

    mixture: MixtureState
    mist: MixtureState  # What of it flows through teeth: at most `MIST_SHARE` of oil.
    oil_viscosity: float  # Dynamic. [Pa s]


class Parts(NamedTuple):
    """Drag of a body, by what causes it."""

    rim: float  # [W]
    faces: float  # [W]
    teeth: float  # Also of what stands across the flow. [W]


def drag(body: Turning, speed: float, fluid: Fluid, model: DragModel) -> Parts:
    """The drag of a body in the mixture. Theory (V9) to (V13). [W]

    Skin friction in the mixture, as the share of oil was found for it; teeth, and what stands
    across the flow, push the mist.
    """
    omega, r = abs(speed), body.radius
    reynolds = omega * r**2 / fluid.mixture.kinematic_viscosity
    if not reynolds * omega:
        return Parts(0.0, 0.0, 0.0)
    across = BLUNT / 2 * fluid.mist.density * body.across * omega**3
    if model == "anderson-loewenthal" and body.teeth is not None:
        return Parts(0.0, 0.0, across + anderson_loewenthal(body.teeth, omega, fluid.oil_viscosity))
    group = fluid.mixture.density * omega**3 * r**4
    teeth = 0.0
    if model == "diab-ville-velex" and body.teeth is not None:
        teeth = tooth_windage(body.teeth, omega, fluid.mist.density, body.axial_gap)
    around, beside = (None if it is None else it / r for it in (body.radial_gap, body.axial_gap))
    return Parts(
        math.pi * rim_coefficient(reynolds, around) * group * body.width,
        face_coefficient(reynolds, beside) * group * r / 2,
        teeth + across,
    )


def tooth_windage(teeth: Teeth, speed: float, density: float, flange: float | None = None) -> float:
    """P = C rho omega^3 R^5/2 of the teeth alone. Theory (V11). [W]"""
    return tooth_coefficient(teeth, flange) * density * abs(speed) ** 3 * teeth.pitch_radius**5 / 2


def drag_flags(
    where: str, body: Turning, parts: Parts, speed: float, fluid: Fluid, model: DragModel
) -> tuple[ValidityFlag, ...]:
    """Flags of the drag of the body called `where`."""
    reynolds = abs(speed) * body.radius**2 / fluid.mixture.kinematic_viscosity
    use, total = ModelUse("drag", model, where), sum(parts)
    if not total:
        return ()
    part = parts.faces / total
    return check_ranges(use, (_DISCS,), {"reynolds_number": reynolds}, part=part, watts=parts.faces)
