"""Expected film of a smooth contact in all regimes, from a fit."""

from __future__ import annotations

import math


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
