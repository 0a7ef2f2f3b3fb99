"""Allowances of the tooth thickness by DIN 3967, and tolerances of flanks by ISO 1328-1.

The tables of DIN 3967:1978 are second hand: two independent open programs print the same values,
and the example of the standard agrees, series 27cd at 100 mm. Lengths are in metres.
"""

from __future__ import annotations

import math
import re
from bisect import bisect_left
from dataclasses import dataclass

_MM, _UM = 1e-3, 1e-6
_DIAMETERS = (10, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6300, 10000)
"""Largest reference diameter of each row of both tables. [mm]"""
LARGEST_FIT = _DIAMETERS[-1] * _MM
"""[m]"""
_SERIES = ("a", "ab", "b", "bc", "c", "cd", "d", "e", "f", "g", "h")
_UPPER = (
    (100, 85, 70, 58, 48, 40, 33, 22, 10, 5, 0),
    (135, 110, 95, 75, 65, 54, 44, 30, 14, 7, 0),
    (180, 150, 125, 105, 85, 70, 60, 40, 19, 9, 0),
    (250, 200, 170, 140, 115, 95, 80, 56, 26, 12, 0),
    (330, 280, 230, 190, 155, 130, 110, 75, 35, 17, 0),
    (450, 370, 310, 260, 210, 175, 145, 100, 48, 22, 0),
    (600, 500, 420, 340, 290, 240, 200, 135, 64, 30, 0),
    (820, 680, 560, 460, 390, 320, 270, 180, 85, 41, 0),
    (1100, 920, 760, 620, 520, 430, 360, 250, 115, 56, 0),
    (1500, 1250, 1020, 840, 700, 580, 480, 330, 155, 75, 0),
    (2000, 1650, 1350, 1150, 940, 780, 640, 450, 210, 100, 0),
)
"""-A_sne of each row and series; Table 1. [um]"""
_FINEST = 21
_WIDTHS = (
    (3, 5, 8, 12, 20, 30, 50, 80, 130, 200),
    (5, 8, 12, 20, 30, 50, 80, 130, 200, 300),
    (6, 10, 16, 25, 40, 60, 100, 160, 250, 400),
    (8, 12, 20, 30, 50, 80, 130, 200, 300, 500),
    (10, 16, 25, 40, 60, 100, 160, 250, 400, 600),
    (12, 20, 30, 50, 80, 130, 200, 300, 500, 800),
    (16, 25, 40, 60, 100, 160, 250, 400, 600, 1000),
    (20, 30, 50, 80, 130, 200, 300, 500, 800, 1300),
    (25, 40, 60, 100, 160, 250, 400, 600, 1000, 1600),
    (30, 50, 80, 130, 200, 300, 500, 800, 1300, 2000),
    (40, 60, 100, 160, 250, 400, 600, 1000, 1600, 2400),
)
"""T_sn of each row, series 21 to 30; Table 2. [um]"""
_NAME = re.compile(r"(\d\d)([a-z]{1,2})|([a-z]{1,2})(\d\d)")


def named_fit(name: str) -> str | None:
    """The series of allowances and tolerances as DIN 3967 writes them, ``"27cd"``; None if unknown.

    Examples
    --------
    >>> named_fit("C 25")
    '25c'
    """
    match = _NAME.fullmatch("".join(name.lower().split()))
    if match is None:
        return None
    number, letters = int(match[1] or match[4]), match[2] or match[3]
    known = letters in _SERIES and _FINEST <= number < _FINEST + len(_WIDTHS[0])
    return f"{number}{letters}" if known else None


def fit_allowances(
    fit: str,  # As `named_fit` returns it.
    reference_diameter: float,  # Up to 10 m. [m]
) -> tuple[float, float]:
    """Upper and lower allowance of the tooth thickness, A_sne and A_sni. [m]

    DIN 3967:1978, Tables 1 and 2, and 3.2 (second hand). Theory (G53).

    Examples
    --------
    >>> [round(1e6 * value) for value in fit_allowances("27cd", 0.1)]
    [-70, -170]
    """
    row = bisect_left(_DIAMETERS, reference_diameter / _MM)
    upper = _UPPER[row][_SERIES.index(fit[2:])]
    width = _WIDTHS[row][int(fit[:2]) - _FINEST]
    return -upper * _UM, -(upper + width) * _UM


@dataclass(frozen=True, slots=True)
class FlankTolerances:
    """Tolerances of the flanks of one gear by its class."""

    single_pitch: float  # f_pT. [m]
    profile_slope: float  # f_HalphaT, f_falphaT. [m]
    profile_form: float  # f_HalphaT, f_falphaT. [m]
    helix_slope: float  # f_HbetaT, f_fbetaT. [m]
    helix_form: float  # f_HbetaT, f_fbetaT. [m]

    @property
    def profile(self) -> float:
        """F_alphaT. [m]"""
        return math.hypot(self.profile_slope, self.profile_form)

    @property
    def helix(self) -> float:
        """F_betaT. [m]"""
        return math.hypot(self.helix_slope, self.helix_form)


def flank_tolerances(
    accuracy_class: int,  # 1 to 11.
    normal_module: float,  # [m]
    reference_diameter: float,  # [m]
    face_width: float,  # [m]
) -> FlankTolerances:
    """Tolerances of ISO 1328-1:2013, Formulae 5 and 7 to 12 (second hand). Theory (G54).

    Not rounded as the standard rounds them, to 1, 0.5 or 0.1 um. It holds for m_n from 0.5 to
    70 mm, d from 5 mm to 15 m and b from 4 mm to 1.2 m.

    Examples
    --------
    >>> found = flank_tolerances(6, 3e-3, 0.12, 0.04)
    >>> [round(1e6 * value, 2) for value in (found.single_pitch, found.profile, found.helix)]
    [8.94, 12.04, 14.4]
    """
    module, diameter, width = (
        value / _MM for value in (normal_module, reference_diameter, face_width)
    )
    step = _UM * math.sqrt(2) ** (accuracy_class - 5)
    root_d, root_b = math.sqrt(diameter), math.sqrt(width)
    return FlankTolerances(
        step * (0.001 * diameter + 0.4 * module + 5),
        step * (0.4 * module + 0.001 * diameter + 4),
        step * (0.55 * module + 5),
        step * (0.05 * root_d + 0.35 * root_b + 4),
        step * (0.07 * root_d + 0.45 * root_b + 4),
    )
