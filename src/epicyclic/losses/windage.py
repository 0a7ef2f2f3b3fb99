"""Drag at any speed: rims and faces from creeping to turbulent flow, teeth, gaps, arms."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal, NamedTuple

from epicyclic.arrays import exp, larger, log, norm, pow, sqrt
from epicyclic.dataclass import dataclass
from epicyclic.losses.ranges import Range
from epicyclic.oil.oil import MixtureState
from epicyclic.units import NUMBER

DragModel = Literal[
    "seetharaman-kahraman", "theodorsen-regier", "diab-ville-velex", "anderson-loewenthal"
]
LAMINAR_RIMS: DragModel = "seetharaman-kahraman"
"""That of the dissertation, without teeth, planets and turbulence."""
_SMOOTH = (
    "T. Theodorsen, A. Regier, NACA Report 793 (1944); T. von Karman, ZAMM 1 (1921) 233; walls "
    "beside: E. Bilgen, R. Boulos, J. Fluids Eng. 95 (1973) 122, J. W. Daily, R. E. Nece, J. Basic "
    "Eng. 82 (1960) 217, second hand"
)


class DragMethod(NamedTuple):
    """What a model of drag is."""

    title: str
    source: str
    reliability: str  # How well it is known to be right, as a phrase.


DRAG_METHODS: Mapping[DragModel, DragMethod] = {
    LAMINAR_RIMS: DragMethod(
        "drag of a disc in the air-oil mixture",
        "Seetharaman and Kahraman, Tribol. Trans. 53 (2010) 473; Talbot (2012), Eq. 5.4, 5.5",
        "rims are laminar at any speed, which gives 10 to 40 times too little at usual speeds",
    ),
    "theodorsen-regier": DragMethod(
        "drag of smooth rims and faces, laminar to turbulent",
        _SMOOTH,
        "measured on smooth bodies in one fluid; leaves out the teeth",
    ),
    "diab-ville-velex": DragMethod(
        "drag of rims and faces, laminar to turbulent; windage of teeth after Diab, Ville, Velex",
        "Y. Diab, F. Ville, P. Velex, C. Changenet, J. Mech. Des. 126 (2004) 903, second hand; "
        + _SMOOTH,
        "teeth: such models are within 20 % of tests in air for spur gears and 50 % for helical "
        "ones, after Dynamics 5 (2025) 33, abstract; no law covers more oil than a mist, so the "
        "loss lies between those of a mist and of all the oil",
    ),
    "anderson-loewenthal": DragMethod(
        "windage of gears after Anderson and Loewenthal; drag of other rims and faces",
        "N. E. Anderson, S. H. Loewenthal, NASA TP-1622 (1980), second hand; " + _SMOOTH,
        "made for gears with oil jets, one part of oil in 34.25 of air; without walls near by",
    ),
}
"""Title, source and standing of each model of drag."""

RIM_TRANSITION = 60.0  # omega r^2/nu at which the flow around a cylinder turns turbulent. [1]
TAYLOR_NUMBER = 41.3
"""Re_t sqrt(t/r) at which vortices arise in a narrow gap t (Taylor 1923). [1]"""
FACE_TRANSITION = 3e5
"""omega r^2/nu about which the flow on a free disc turns turbulent (von Karman). [1]"""
TRANSITION_POWER = 4  # With which one law gives way to the other; of this package. [1]
LARGEST = 8  # Order of the norm that takes the larger, or the smaller, of laws without a kink.
SLOPE = 4.07 / math.log(10.0)  # Theodorsen and Regier: 1/sqrt(C_d) = -0.6 + 4.07 lg(Re sqrt(C_d))
OFFSET = 0.6
MIST_SHARE = 0.001
"""Share of oil by volume up to which drops follow the flow through the teeth; with more they meet
and join (S. Elghobashi, Appl. Sci. Res. 52 (1994) 309, general knowledge). [1]"""
LEAST_REYNOLDS = 1e-6  # Held there, deep in creeping flow, whose law is exact at any. [1]
FREE_FLANGE = 0.5  # Distance of a flange over the radius from which it has no effect (Diab). [1]
BLUNT = 1.2  # Drag coefficient of a long cylinder across the flow (Hoerner), general knowledge. [1]
DISCS = Range(
    "reynolds_number", "Reynolds number of the faces", None, 7e6, NUMBER,
    "tests with discs, Theodorsen and Regier, NACA Report 793 (1944)",
)  # fmt: skip
JETS_IN_AIR = Range(
    "oil_share", "share of oil around the gears", 0.014, 0.057, NUMBER,
    "one part of oil in 34.25 of air, half to twice that: Anderson and Loewenthal, NASA TP-1622 "
    "(1980), second hand; the limits are of this package",
)  # fmt: skip


def rim_coefficient(
    reynolds: float,  # omega r^2/nu. [1]
    gap: float | None = None,  # To a wall around the rim, over the radius. [1]
) -> float:
    """C_d of a rim, tau = C_d rho (omega r)^2/2, laminar to turbulent. Theory (V7), (V8). [1]

    Laminar the exact 4/Re, or Couette's flow in a gap; turbulent 1/sqrt(C_d) = -0.6 + 4.07
    lg(Re sqrt(C_d)) of Theodorsen and Regier (1944), which Lambert's function solves, or Bilgen and
    Boulos (1973) where a wall near by holds the fluid back.

    Examples
    --------
    Free rims, laminar and turbulent, and one in a gap of a tenth of its radius:

    >>> [round(rim_coefficient(it), 5) for it in (10.0, 5612.0, 12049.0, 14000.0, 22751.0)]
    [0.39986, 0.00907, 0.00735, 0.00706, 0.00625]
    >>> round(rim_coefficient(14000.0, 0.1), 5)
    0.0064
    """
    laminar, transition = 4 / reynolds, RIM_TRANSITION
    # w + ln w = z by Newton's method from below: the import of Lambert's function takes long
    z = log(reynolds / SLOPE) - OFFSET / SLOPE
    w = exp(z - larger(z, 1.0))
    for _ in range(8):
        w = w * (1 + z - log(w)) / (1 + w)
    turbulent = (SLOPE * w) ** -2
    if gap is not None:
        laminar /= 1 - (1 + gap) ** -2
        transition = larger(transition, TAYLOR_NUMBER * gap**-1.5)
        within = gap * reynolds
        walls = [1.03 / sqrt(within), 0.065 * pow(within, -0.2)]
        held = pow(gap, 0.3) / 2 * norm(walls, LARGEST)
        turbulent = norm([held, turbulent], -LARGEST)
    share = 1 / (1 + pow(transition / reynolds, TRANSITION_POWER))
    return laminar + share * (turbulent - laminar)


def face_coefficient(
    reynolds: float,  # omega r^2/nu. [1]
    gap: float | None = None,  # To walls beside both faces, over the radius. [1]
) -> float:
    """C_M of both faces, T = C_M rho omega^2 r^5/2, creeping to turbulent. Theory (V9). [1]

    Free: 64/(3 Re) of Lamb, 3.87 Re^-1/2 and 0.146 Re^-1/5 of von Karman; beside walls the four
    regimes of Daily and Nece (1960).

    Examples
    --------
    >>> [round(face_coefficient(it), 5) for it in (1.0, 1e4, 2e6)]
    [21.33334, 0.0387, 0.00802]
    >>> round(face_coefficient(1e4, 0.02), 5)
    0.03201
    """
    root = sqrt(reynolds)
    laminar = 3.87 / root * norm([64 / (3 * 3.87) / root, 1.0], LARGEST)
    share = 1 / (1 + pow(FACE_TRANSITION / reynolds, TRANSITION_POWER))
    free = laminar + share * (0.146 * pow(reynolds, -0.2) - laminar)
    if gap is None:
        return free
    creeping = 64 / (3 * reynolds)
    apart = [creeping, 3.7 / root, 0.102 * pow(reynolds, -0.2)]
    held = norm([pow(gap, 0.1) * norm(apart, LARGEST), free], -LARGEST)
    merged = 0.08 * pow(gap, -1 / 6) / sqrt(root)
    return norm([2 * math.pi / (gap * reynolds), merged, held], LARGEST)


@dataclass(frozen=True, slots=True)
class Teeth:
    """Teeth around a body."""

    number: int
    pitch_radius: float  # That of the reference circle. [m]
    tip_radius: float  # [m]
    width: float  # [m]
    space: float  # Angle of a tooth space at the tip circle. [rad]


def tooth_coefficient(teeth: Teeth, flange: float | None = None) -> float:
    """C of the teeth, T = C rho omega^2 R^5/2, after Diab et al. (2004). Theory (V10). [1]

    C = z/4 (b/R) (R_a/R)^4 (1 - cos phi) (1 + cos phi)^3, phi the tooth space at the tip, second
    hand; less beside flanges at a distance h < R/2, by the exponent 0.56 of the same authors.

    Examples
    --------
    72 teeth of module 4 mm, 30 mm wide, in the open and between flanges at 3 mm:

    >>> gear = Teeth(72, 0.144, 0.148, 0.03, 0.0658)
    >>> round(tooth_coefficient(gear), 4), round(tooth_coefficient(gear, 0.003), 4)
    (0.0722, 0.0122)
    """
    ratio, cosine = teeth.tip_radius / teeth.pitch_radius, math.cos(teeth.space)
    open_gear = teeth.number / 4 * teeth.width / teeth.pitch_radius * ratio**4
    near = 1.0
    if flange is not None:
        near = pow(flange / (FREE_FLANGE * teeth.pitch_radius), 0.56)
        near = norm([near, 1.0], -LARGEST)
    return open_gear * (1 - cosine) * (1 + cosine) ** 3 * near


@dataclass(frozen=True, slots=True)
class Turning:
    """A body that turns in the mixture."""

    pointwise = True

    radius: float  # [m]
    width: float  # Of its rim. [m]
    teeth: Teeth | None = None
    # To a shroud around the rim, and to walls beside both faces, if there are any. [m]
    radial_gap: float | None = None
    axial_gap: float | None = None
    # Sum of width, diameter and cubed distance from the axis of cylinders that stand across the
    # flow: planets in an open carrier. [m^5]
    across: float = 0.0


class Parts(NamedTuple):
    """Drag of a body, by what causes it."""

    rim: float  # [W]
    faces: float  # [W]
    teeth: float  # Also of what stands across the flow. [W]


def drag(
    body: Turning,
    speed: float,  # Against what is around it. [rad/s]
    mixture: MixtureState,  # Oil and air around it.
    mist: MixtureState,  # What of it flows through teeth: at most `MIST_SHARE` of oil.
    oil_viscosity: float,  # Dynamic. [Pa s]
    model: DragModel,
) -> Parts:
    """The drag of a body. Theory (V11), (V12), (V13). [W]

    Skin friction in the mixture, whose share of oil was found for it; teeth, and what stands across
    the flow, push the mist. The formula of Anderson and Loewenthal is for one part of oil in 34.25
    of air: 2.82e-7 (1 + 2.3 b/r) n^2.8 r^4.6 (0.028 mu + 0.019)^0.2; kW, rpm, m, mPa s.

    Examples
    --------
    >>> air = MixtureState(0.0, 1.0, 20e-6)
    >>> pinion = Turning(0.0318, 0.03, Teeth(27, 0.0293, 0.0318, 0.03, 0.2))
    >>> omega = 20000 * math.pi / 30
    >>> [round(sum(drag(pinion, omega, air, air, 7e-3, it)), 1)
    ...  for it in ("theodorsen-regier", "anderson-loewenthal", "diab-ville-velex")]
    [5.7, 68.1, 152.9]
    """
    omega, r, teeth = abs(speed), body.radius, body.teeth
    reynolds = omega * r**2 / mixture.kinematic_viscosity
    if not omega:
        return Parts(0.0, 0.0, 0.0)
    form = BLUNT / 2 * mist.density * body.across * omega**3
    if model == "anderson-loewenthal" and teeth is not None:
        shape = math.pow(teeth.pitch_radius, 4.6) + 2.3 * teeth.width * teeth.pitch_radius**3.6
        thickness = pow(0.028e3 * oil_viscosity + 0.019, 0.2)
        watts = 2.82e-4 * shape * pow(omega * 30 / math.pi, 2.8) * thickness
        return Parts(0.0, 0.0, form + watts)
    if model == "diab-ville-velex" and teeth is not None:
        coefficient = tooth_coefficient(teeth, body.axial_gap)
        form += coefficient * mist.density * omega**3 * teeth.pitch_radius**5 / 2
    around, beside = (None if it is None else it / r for it in (body.radial_gap, body.axial_gap))
    held = larger(reynolds, LEAST_REYNOLDS)
    group = held * mixture.dynamic_viscosity * omega**2 * r**2
    return Parts(
        math.pi * rim_coefficient(held, around) * group * body.width,
        face_coefficient(held, beside) * group * r / 2,
        form,
    )
