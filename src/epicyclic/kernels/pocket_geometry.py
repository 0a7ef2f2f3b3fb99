"""Transverse section of the pockets of a mesh: gaps between flanks, areas, centroids.

The axis of gear 1 is the origin, that of gear 2 lies on the x axis, and the mesh at positive x.
Points are complex numbers. A flank is stored once, on the positive side of the middle of its tooth
(the x axis), from the middle of the space to the tip corner; a placed flank is that curve, mirrored
if `mirror` is negative, turned by `turn` and shifted by `centre`.
"""

from __future__ import annotations

import cmath
import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.compiling import kernel

Floats = NDArray[np.float64]
Points = NDArray[np.complex128]

TIP_POINTS = 9
"""Points on a tip land: a chord of it leaves the arc by a millionth of the module, about."""


@kernel
def _involute_point(rho: float, base: float, base_half_angle: float, outward: float) -> complex:
    """Point of the involute with radius of curvature `rho`, the middle of the tooth along x."""
    roll = rho / base
    angle = base_half_angle - outward * (roll - math.atan(roll))
    return math.hypot(base, rho) * cmath.exp(1j * angle)


@kernel
def _next_to_tip(flank: Points, first: int, rho: float, base: float, outward: float) -> int:
    """Index of the first point of the involute closer to the tip than `rho`."""
    low, high = first, flank.size - 1
    while low < high:
        middle = (low + high) // 2
        squared = flank[middle].real ** 2 + flank[middle].imag ** 2 - base**2
        if outward * (math.sqrt(max(0.0, squared)) - rho) > 0.0:
            high = middle
        else:
            low = middle + 1
    return low


@kernel
def _closest(
    point: complex,  # In the frame of the stored flank. [m]
    flank: Points,  # From the middle of the space to the tip corner. [m]
    # Indices where the fillet begins, where it ends, and where the involute ends: at the tip
    # corner, or at the chamfer, on which no foot lies.
    joints: Floats,
    # Base radius [m], half angle of the tooth at the base circle [rad], radii of curvature of the
    # involute at its root and tip ends [m], +1 for an external gear, -1 for a ring.
    gear: Floats,
) -> tuple[float, complex, int]:
    """Point of a flank closest to `point`. Theory (Q2).

    Returns its distance [m], itself [m], and the index of the first point of `flank` beyond it
    towards the tip.
    """
    base, base_half_angle, rho_form, rho_tip, outward = gear
    after = int(joints[2])
    foot = flank[after]
    best = abs(point - foot)
    radius = abs(point)
    if radius > base:
        # The normal of the involute through the point is a tangent of the base circle, and its
        # length between parallel involutes is the arc between them on that circle.
        rho = math.sqrt(radius**2 - base**2)
        roll = rho / base
        half_angle = cmath.phase(point) + outward * (roll - math.atan(roll))
        rho_foot = rho - outward * base * (half_angle - base_half_angle)
        if outward * (rho_foot - rho_form) >= 0.0 and outward * (rho_tip - rho_foot) >= 0.0:
            distance = abs(rho_foot - rho)
            if distance < best:
                best = distance
                foot = _involute_point(rho_foot, base, base_half_angle, outward)
                after = _next_to_tip(flank, int(joints[1]), rho_foot, base, outward)
    nearly = 1 + 1e-12  # rounding
    for k in range(int(joints[0]), int(joints[1])):
        chord = flank[k + 1] - flank[k]
        to_point = point - flank[k]
        squared = chord.real**2 + chord.imag**2
        share = (to_point.real * chord.real + to_point.imag * chord.imag) / squared
        share = min(1.0, max(0.0, share))
        away = to_point - share * chord
        if away.real**2 + away.imag**2 > nearly * best**2:
            continue  # saves the root
        distance = abs(away)
        if distance < best:
            best = distance
            foot = flank[k] + share * chord
            after = k + 1
    return best, foot, after


@kernel
def _mirrored(point: complex, mirror: float) -> complex:
    return point if mirror > 0.0 else point.conjugate()


@kernel
def _place(point: complex, turn: float, mirror: float, centre: float) -> complex:
    return centre + _mirrored(point, mirror) * cmath.exp(1j * turn)


@kernel
def _unplace(point: complex, turn: float, mirror: float, centre: float) -> complex:
    return _mirrored((point - centre) * cmath.exp(-1j * turn), mirror)


@kernel
def _gap(
    phi: float,  # Angle of the tooth from the line of centres. [rad]
    leading: float,  # +1 for the flank on the side that `phi` grows to, -1 for the other.
    # Flank, joints and figures of gear 1, then of gear 2, as for `_closest`.
    gears: tuple[Points, Floats, Floats, Points, Floats, Floats],
    # Coordinate of the axis of gear 2 [m], teeth of gears 1 and 2, +1 for an external mesh and -1
    # for an internal one, operating pressure angle [rad], length of the line of action [m],
    # clearances of the leading and the trailing flanks along the line of action [m].
    mesh: Floats,
) -> tuple[float, complex, complex, int, int]:
    """Gap between a flank of a tooth of gear 1 and the flank of gear 2 that it faces.

    Returns the gap [m], the closest points of both flanks [m], and of each the index that
    `_closest` returns. Theory (Q1), (Q3).
    """
    flank1, joints1, gear1, flank2, joints2, gear2 = gears
    centre2, _, _, side, alpha, action, clear_leading, clear_trailing = mesh
    turn2, mirror2 = _facing(phi, leading, mesh, gear2)
    clearance = clear_leading if leading > 0.0 else clear_trailing
    base1, half1, form1, tip1, out1 = gear1
    base2, half2, form2, tip2, out2 = gear2
    # Involutes conjugate to each other have their common normal on the line of action. Where one of
    # them ends in its fillet, the point of the fillet closest to the other foot is taken: that
    # keeps the feet continuous, although a point nearby may be closer by some micrometres.
    rho1 = base1 * (half1 + alpha + leading * phi)
    rho2 = action - side * (rho1 + clearance)
    real1 = rho1 >= form1
    real2 = out2 * (rho2 - form2) >= 0.0
    if rho1 <= tip1 and out2 * (tip2 - rho2) >= 0.0 and (real1 or real2):
        foot1 = _involute_point(rho1, base1, half1, out1)
        foot2 = _involute_point(rho2, base2, half2, out2)
        after1 = _next_to_tip(flank1, int(joints1[1]), rho1, base1, out1)
        after2 = _next_to_tip(flank2, int(joints2[1]), rho2, base2, out2)
        place1 = _place(foot1, phi, leading, 0.0)
        place2 = _place(foot2, turn2, mirror2, centre2)
        if real1 and real2:
            return clearance, place1, place2, after1, after2
        if real2:
            width, foot1, after1 = _closest(
                _unplace(place2, phi, leading, 0.0), flank1, joints1, gear1
            )
            return width, _place(foot1, phi, leading, 0.0), place2, after1, after2
        width, foot2, after2 = _closest(
            _unplace(place1, turn2, mirror2, centre2), flank2, joints2, gear2
        )
        return width, place1, _place(foot2, turn2, mirror2, centre2), after1, after2
    end1, end2 = int(joints1[2]), int(joints2[2])
    corner1 = _place(flank1[end1], phi, leading, 0.0)
    corner2 = _place(flank2[end2], turn2, mirror2, centre2)
    on2, foot2, after2 = _closest(
        _unplace(corner1, turn2, mirror2, centre2), flank2, joints2, gear2
    )
    on1, foot1, after1 = _closest(_unplace(corner2, phi, leading, 0.0), flank1, joints1, gear1)
    if on2 <= on1:
        return on2, corner1, _place(foot2, turn2, mirror2, centre2), end1, after2
    return on1, _place(foot1, phi, leading, 0.0), corner2, after1, end2


@kernel
def _facing(phi: float, leading: float, mesh: Floats, gear2: Floats) -> tuple[float, float]:
    """Turn and mirroring of the flank of gear 2 that faces a flank of gear 1. Theory (Q1)."""
    _, z1, z2, side, _, _, clear_leading, clear_trailing = mesh
    # Half the difference of the clearances, as an angle of gear 2.
    shift = (clear_leading - clear_trailing) / 2 / gear2[0]
    turned = phi * z1 / z2 + shift
    space = math.pi - turned if side > 0.0 else turned
    half_pitch = math.pi / z2
    return space - side * leading * half_pitch, side * leading


@kernel
def gap_table(
    phi: Floats,  # Angles of the tooth of gear 1 from the line of centres. [rad]
    leading: float,  # As for `_gap`.
    gears: tuple[Points, Floats, Floats, Points, Floats, Floats],  # As for `_gap`.
    mesh: Floats,  # As for `_gap`.
) -> tuple[Floats, Points]:
    """Gap between two flanks at many angles, and where it is narrowest. Theory (Q3).

    Width, and the points on gear 1 and on gear 2. [m]
    """
    width, feet = np.empty(phi.size), np.empty((phi.size, 2), np.complex128)
    for n in range(phi.size):
        width[n], feet[n, 0], feet[n, 1], _, _ = _gap(phi[n], leading, gears, mesh)
    return width, feet


@kernel
def _add_tooth(
    polygon: Points, count: int, flank: Points, after: tuple[int, int], place: tuple[float, float]
) -> int:
    """Append a tooth from its leading foot over the tip to its trailing foot, feet left out.

    `after`: as of `_closest` on the flank of positive and on that of negative side; `place`: turn
    and centre.
    """
    rotation, centre = cmath.exp(1j * place[0]), place[1]
    for k in range(after[0], flank.size):
        polygon[count] = centre + flank[k] * rotation
        count += 1
    corner = flank[flank.size - 1]
    half = cmath.phase(corner)
    for k in range(1, TIP_POINTS - 1):
        angle = half * (1 - 2 * k / (TIP_POINTS - 1))
        polygon[count] = centre + abs(corner) * cmath.exp(1j * angle) * rotation
        count += 1
    for k in range(flank.size - 1, after[1] - 1, -1):
        polygon[count] = centre + flank[k].conjugate() * rotation
        count += 1
    return count


@kernel
def _add_space(
    polygon: Points,
    count: int,
    flank: Points,
    after: tuple[int, int],
    turns: tuple[float, float],
    mirror: float,
    centre: float,
) -> int:
    """Append a space from one foot over the root to the other, feet left out.

    `after` and `turns` belong to the flank where the path begins and to the one where it ends;
    `mirror` to the first one.
    """
    rotation = cmath.exp(1j * turns[0])
    for k in range(after[0] - 1, -1, -1):
        polygon[count] = centre + _mirrored(flank[k], mirror) * rotation
        count += 1
    rotation = cmath.exp(1j * turns[1])
    for k in range(1, after[1]):
        polygon[count] = centre + _mirrored(flank[k], -mirror) * rotation
        count += 1
    return count


@kernel
def _area_and_centroid(polygon: Points, count: int) -> tuple[float, complex]:
    """Area and centroid of a polygon. Theory (Q4), (Q5)."""
    area = 0.0
    moment = 0j
    origin = polygon[0]
    for k in range(1, count - 1):
        one = polygon[k] - origin
        two = polygon[k + 1] - origin
        cross = one.real * two.imag - one.imag * two.real
        area += cross
        moment += cross * (one + two)
    return abs(area) / 2, origin + moment / (3 * area)


@kernel
def _add_pocket(
    polygon: Points,
    phi: float,
    member: int,
    gears: tuple[Points, Floats, Floats, Points, Floats, Floats],
    mesh: Floats,
) -> int:
    """Fill `polygon` with the outline of a pocket and return how many points it has.

    From the leading foot of the tooth over its tip and back along the space. Arguments as for
    `pocket_table`, `phi` one angle.
    """
    flank1, _, _, flank2, _, gear2 = gears
    centre2, side = mesh[0], mesh[3]
    half_pitch = math.pi / mesh[1]
    # Teeth of gear 1 whose leading and trailing flanks bound the pocket.
    lead = phi if member == 1 else phi - half_pitch
    trail = phi if member == 1 else phi + half_pitch
    _, lead1, lead2, lead_after1, lead_after2 = _gap(lead, 1.0, gears, mesh)
    _, trail1, trail2, trail_after1, trail_after2 = _gap(trail, -1.0, gears, mesh)
    lead_turn2, _ = _facing(lead, 1.0, mesh, gear2)
    trail_turn2, _ = _facing(trail, -1.0, mesh, gear2)
    # Foot, index after it and turn of the four flanks, in the order in which the outline passes.
    ahead1, ahead2 = (lead1, lead_after1, lead), (lead2, lead_after2, lead_turn2)
    behind1, behind2 = (trail1, trail_after1, trail), (trail2, trail_after2, trail_turn2)
    if member == 1:
        ends = (ahead1, behind1, behind2, ahead2)
        tooth, place, space, centre = flank1, (lead, 0.0), flank2, centre2
    else:
        # The leading flank of one tooth of gear 1 faces the tooth of gear 2 in the space before it;
        # seen from gear 2 that is the positive side if the axes turn together.
        ends = (ahead2, behind2, behind1, ahead1)
        if side < 0.0:
            ends = (behind2, ahead2, ahead1, behind1)
        tooth, place, space, centre = flank2, (lead_turn2, centre2), flank1, 0.0
    first, second, third, last = ends
    polygon[0] = first[0]
    count = _add_tooth(polygon, 1, tooth, (first[1], second[1]), place)
    polygon[count], polygon[count + 1] = second[0], third[0]
    # On either gear the path along a space begins on the flank whose mirroring is `-side`.
    after, turns = (third[1], last[1]), (third[2], last[2])
    count = _add_space(polygon, count + 2, space, after, turns, -side, centre)
    polygon[count] = last[0]
    return count + 1


@kernel
def _most_points(flank1: Points, flank2: Points) -> int:
    return 2 * (flank1.size + flank2.size) + TIP_POINTS + 4


@kernel
def pocket_outlines(
    phi: Floats,
    member: int,
    gears: tuple[Points, Floats, Floats, Points, Floats, Floats],
    mesh: Floats,
) -> Points:
    """Outlines of a pocket at many angles, arguments as for `pocket_table`.

    Points around the pocket, as many as it has, then NaN. [m]
    """
    outlines = np.full((phi.size, _most_points(gears[0], gears[3])), complex(math.nan, math.nan))
    for n in range(phi.size):
        count = _add_pocket(outlines[n], phi[n], member, gears, mesh)
        outlines[n, count:] = complex(math.nan, math.nan)
    return outlines


@kernel
def pocket_table(
    # For a tooth of gear 1 in a space of gear 2 the angle of that tooth, for a tooth of gear 2 in a
    # space of gear 1 the angle of that space, from the line of centres. [rad]
    phi: Floats,
    member: int,  # 1 or 2: whose tooth is in the space of the other.
    gears: tuple[Points, Floats, Floats, Points, Floats, Floats],  # As for `_gap`.
    mesh: Floats,  # As for `_gap`.
) -> Floats:
    """End area of a pocket and its centroid at many angles. Theory (Q4), (Q5).

    Area [m^2], x and y of the centroid [m].
    """
    polygon = np.empty(_most_points(gears[0], gears[3]), np.complex128)
    table = np.empty((phi.size, 3))
    for n in range(phi.size):
        count = _add_pocket(polygon, phi[n], member, gears, mesh)
        area, centroid = _area_and_centroid(polygon, count)
        table[n, 0] = area
        table[n, 1] = centroid.real
        table[n, 2] = centroid.imag
    return table
