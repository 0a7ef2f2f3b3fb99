"""Load-dependent loss of one mesh, and the flash temperature along its contact lines."""

from __future__ import annotations

import math
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from epicyclic.arrays import TINY, AtOnce, FloatArray, either, larger, most, total
from epicyclic.contact.temperatures import Solid, heat_share
from epicyclic.dataclass import dataclass, field
from epicyclic.gears.mesh import Mesh
from epicyclic.kernels.line_contact import flash_temperature
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.friction import FrictionModel
from epicyclic.losses.ranges import Flags, SomeFlags
from epicyclic.losses.rolling import RollingModel

# Flash temperature along the contact lines of a mesh, and which gear the heat goes to.


def heat_share1(
    contact: MeshContact,
    heat: FloatArray,  # Of sliding friction at every point. [W]
    materials: tuple[Solid, Solid],  # Materials of both gears.
) -> float:
    """Share of the heat of sliding that gear 1 takes up. Theory (W2). [1]"""
    whole = total(heat)
    if not whole > 0:
        return 0.5
    share1 = heat_share(*contact.surface_speeds, *(solid.effusivity for solid in materials))
    return total(heat * share1) / whole


def flash_temperatures(
    contact: MeshContact, friction: FloatArray, materials: tuple[Solid, Solid]
) -> FloatArray:
    """Flash temperature at every point of the contact lines, shape (n,). Theory (W1). [K]"""
    return flash_temperature(
        friction,
        contact.line_load,
        contact.sliding_speed,
        *contact.surface_speeds,
        contact.hertz_half_width,
        *(solid.effusivity for solid in materials),
    )


# Load-dependent loss of one mesh.
#
# Local method, Talbot (2012), Eq. 5.9 and 5.11: averages over the mesh period of
#
# .. math:: P_\mu = \int \mu W' |u_s|\,\mathrm{d}l, \qquad P_r = \int \Re\,\mathrm{d}l .
#
# Quick method: mean friction times the loss factor of Ohlendorf, no rolling loss.

CLOSED_LIMIT = 1.0  # Tip contact ratio up to which Ohlendorf's closed form holds. [1]


@dataclass(frozen=True, slots=True)
class MeshLoss:
    """Loss of one mesh."""

    pointwise = True

    sliding: float  # [W]
    rolling: float  # [W]
    # Coefficient of friction at every point. [1]
    friction: FloatArray = field(default_factory=lambda: np.zeros(0))
    # Heat of sliding friction at every point, averaged over the mesh period. [W]
    heat: FloatArray = field(default_factory=lambda: np.zeros(0))
    flags: SomeFlags = ()


def local_loss(contact: MeshContact, friction: FrictionModel, rolling: RollingModel) -> MeshLoss:
    """Sliding and rolling loss, summed along the contact lines, averaged over the mesh period.

    Theory (M1), (M2), (M3).
    """
    sliding_power = contact.line_load * np.abs(contact.sliding_speed) * contact.weight
    own = contact.seen_by(friction)
    coefficient = friction.coefficient(own)
    local_sliding = coefficient * sliding_power
    local_rolling = rolling.loss_density(contact) * contact.weight
    return MeshLoss(
        sliding=total(local_sliding),
        rolling=total(local_rolling),
        friction=coefficient,
        heat=local_sliding,
        flags=Flags(
            AtOnce(friction.flags, "friction", own, local_sliding),
            AtOnce(rolling.flags, "rolling", contact, local_rolling),
        ),
    )


def mean_friction(contact: MeshContact, coefficient: FloatArray) -> float:
    """Mean over the sliding power of the load, from its shares: powers may be too small. [1]"""
    share: Any = contact.weight
    for part in (contact.line_load, np.abs(contact.sliding_speed)):
        largest = most(part)
        share = share * either(largest > 0, part / larger(largest, TINY), 1.0)
    return total(coefficient * share) / total(share)


def loss_factor_loss(contact: MeshContact, friction: FrictionModel) -> MeshLoss:
    """The quick method: P = P_in mu_m H_V. Niemann and Winter, vol. II, Eq. 21.11/3. Theory (M4).

    A local friction model enters with its mean over the sliding power.
    """
    sliding_power = contact.line_load * np.abs(contact.sliding_speed) * contact.weight
    own = contact.seen_by(friction)
    coefficient = friction.coefficient(own)
    local_sliding = coefficient * sliding_power
    mean = mean_friction(contact, coefficient)
    return MeshLoss(
        sliding=contact.input_power * mean * ohlendorf_loss_factor(contact.mesh),
        rolling=0.0,
        friction=coefficient,
        heat=local_sliding,
        flags=Flags(partial(friction.flags, "friction", own, local_sliding)),
    )


def ohlendorf_loss_factor(mesh: Mesh) -> float:
    """H_V = pi (u +- 1)/(z1 u cos(beta_b)) (1 - eps_alpha + eps_1^2 + eps_2^2). [1]

    Theory (M5), (M6). H. Ohlendorf, Diss. TH Muenchen (1958); minus for internal meshes. Constant
    friction, tooth pairs in contact sharing the load equally. The last bracket holds for
    1 <= eps_alpha <= 2 with eps_1, eps_2 <= 1; here it is the integral that it stands for,
    2 int |s|/N(s) ds over s in base pitches from the pitch point, N the number of pairs in contact,
    which has no such limits.
    """
    tip1, tip2 = mesh.tip_contact_ratios
    # N changes where a neighbouring pair enters or leaves, at whole pitches from the ends
    reach = math.ceil(tip1 + tip2)
    corners = {-tip2, tip1, 0.0}
    corners |= {-tip2 + k for k in range(1, reach)} | {tip1 - k for k in range(1, reach)}
    ordered = sorted(corner for corner in corners if -tip2 <= corner <= tip1)
    integral = 0.0
    for start, end in pairwise(ordered):
        middle = (start + end) / 2
        pairs = math.floor(tip1 - middle) + math.floor(middle + tip2) + 1
        integral += 2 * abs(middle) * (end - start) / pairs
    return _ratio_term(mesh) * integral


def ohlendorf_closed_form(mesh: Mesh) -> float:
    """`ohlendorf_loss_factor` with the bracket as printed, within its range and beyond. [1]

    Theory (M5). What other programs state, KISSsoft among them.
    """
    tip1, tip2 = mesh.tip_contact_ratios
    return _ratio_term(mesh) * (1 - tip1 - tip2 + tip1**2 + tip2**2)


def loss_factor_notes(mesh: Mesh) -> tuple[str, ...]:
    """Where other programs state another loss factor, and why."""
    tip1, tip2 = mesh.tip_contact_ratios
    if max(tip1, tip2) <= CLOSED_LIMIT and 1 <= tip1 + tip2 <= 2 * CLOSED_LIMIT:
        return ()
    return (
        f"The loss factor of the {mesh.name} is {ohlendorf_loss_factor(mesh):.4f}. Ohlendorf's "
        "closed form, which other programs also use here, gives "
        f"{ohlendorf_closed_form(mesh):.4f}; it is valid for tip contact ratios up to "
        f"{CLOSED_LIMIT:g}; here they are {tip1:.2f} and {tip2:.2f}.",
    )


def _ratio_term(mesh: Mesh) -> float:
    """pi (u +- 1)/(z1 u cos(beta_b)). [1]"""
    ratio = (mesh.ratio + mesh.side) / (mesh.gear1.teeth * mesh.ratio)
    return math.pi * ratio / math.cos(mesh.gear1.rack.base_helix_angle)
