"""Parameters of rough profiles, and how they are converted into each other."""

from __future__ import annotations

import math

RA_OVER_RQ = math.sqrt(2 / math.pi)
"""Ra/Rq of a Gaussian profile. [1]"""

RZ_OVER_RA = 6.0
"""Rz/Ra, DIN 3991 approximation, as the FVA-Workbench uses it. [1]"""

RZ_BAND = (4.0, 7.0)
"""Rz/Ra of real surfaces, a rule of thumb of the trade. [1]"""


def rq_of(
    parameter: str,  # ``"Rq"``, ``"Ra"`` (DIN EN ISO 4287) or ``"Rz"``.
    value: float,  # [m]
) -> float:
    """Rms roughness Rq of a surface of which another parameter is stated.

    Returns
    -------
    float
        [m]

    Examples
    --------
    >>> round(1e6 * rq_of("Rz", 3e-6), 3)
    0.627
    """
    factor = {"Rq": 1.0, "Ra": 1 / RA_OVER_RQ, "Rz": 1 / (RZ_OVER_RA * RA_OVER_RQ)}
    return factor[parameter] * value
