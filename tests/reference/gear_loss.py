"""Loss factors of a mesh: its sliding loss over coefficient of friction and power passed on."""

from __future__ import annotations

import math


def equal_sharing_loss_factor(
    teeth1: int,  # Tooth numbers of pinion and gear, both positive.
    teeth2: int,  # Tooth numbers of pinion and gear, both positive.
    # tip_ratio1, tip_ratio2: eps_1, eps_2: path of contact from the pitch point to the tip of the
    # pinion and to that of the gear, over the transverse base pitch; each at most 1, their sum at
    # least 1. [1]
    tip_ratio1: float,
    tip_ratio2: float,
    base_helix_angle: float = 0.0,  # beta_b. [rad]
    *,
    internal: bool = False,  # True if member 2 is a ring.
) -> float:
    """Ohlendorf's H_V: tooth pairs in contact share the load equally, friction is constant.

    H_V = pi (u +- 1)/(z1 u cos(beta_b)) (1 - eps_alpha + eps_1^2 + eps_2^2), minus for internal
    meshes.

    Returns
    -------
    float
        H_V. [1]

    References
    ----------
    H. Ohlendorf, Verlustleistung und Erwaermung von Stirnraedern, Diss. TH Muenchen (1958);
    G. Niemann and H. Winter, Maschinenelemente II, Eq. 21.11/4.
    """
    if not (tip_ratio1 <= 1 and tip_ratio2 <= 1 <= tip_ratio1 + tip_ratio2):
        raise ValueError("the closed form needs eps_1 <= 1, eps_2 <= 1 and eps_alpha >= 1")
    bracket = 1 - tip_ratio1 - tip_ratio2 + tip_ratio1**2 + tip_ratio2**2
    return _ratio_term(teeth1, teeth2, base_helix_angle, internal) * bracket


def uniform_load_loss_factor(
    teeth1: int,  # As for `equal_sharing_loss_factor`, without its limits.
    teeth2: int,  # As for `equal_sharing_loss_factor`, without its limits.
    tip_ratio1: float,  # As for `equal_sharing_loss_factor`, without its limits.
    tip_ratio2: float,  # As for `equal_sharing_loss_factor`, without its limits.
    base_helix_angle: float = 0.0,  # As for `equal_sharing_loss_factor`, without its limits.
    *,
    internal: bool = False,  # As for `equal_sharing_loss_factor`, without its limits.
) -> float:
    """Loss factor for a uniform load along contact lines of constant total length.

    The last bracket of Ohlendorf's formula becomes (eps_1^2 + eps_2^2)/eps_alpha. Exact for
    integer eps_alpha or eps_beta, the limit for wide helical gears.

    Returns
    -------
    float
        [1]

    References
    ----------
    P. Velex and F. Ville, J. Mech. Des. 131 (2009) 101006, limit of small friction: their
    eps_alpha (2 k0^2 - 2 k0 + 1) with k0 = eps_1/eps_alpha.
    """
    bracket = (tip_ratio1**2 + tip_ratio2**2) / (tip_ratio1 + tip_ratio2)
    return _ratio_term(teeth1, teeth2, base_helix_angle, internal) * bracket


def _ratio_term(teeth1: int, teeth2: int, base_helix_angle: float, internal: bool) -> float:
    """pi (u +- 1)/(z1 u cos(beta_b)) = pi (1/z1 +- 1/z2)/cos(beta_b)."""
    sign = -1 if internal else 1
    return math.pi * (1 / teeth1 + sign / teeth2) / math.cos(base_helix_angle)
