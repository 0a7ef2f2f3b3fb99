"""Tools that cut gears, simulated without the formulas of the package.

A tool is the tip of one of its teeth as a convex polygon, symmetric about y.
"""

from __future__ import annotations

import math

import numpy as np

from epicyclic.gears.gear import Gear, half_angle_from_profile_shift, involute

MODULE = 2e-3
"""Of the gears, near enough: sets how far the tools reach and move. [m]"""


def closed(x, y):
    """Polygon, counter-clockwise, from its right half going up."""
    half = np.column_stack([x, y])
    return np.concatenate([half, (half * [-1.0, 1.0])[::-1]])


def rack_polygon(gear, rounding):
    """Rack tooth with its tip down and the pitch line at y = 0: drawn normal, then stretched."""
    rack = gear.rack
    alpha, cos_beta = rack.normal_pressure_angle, math.cos(rack.helix_angle)
    addendum = gear.reference_radius - gear.root_radius
    width = math.pi * rack.normal_module - 2 * gear.reference_radius * (
        gear.thickness_half_angle * cos_beta
    )
    corner = width / 2 - addendum * math.tan(alpha)
    center = corner + rounding * math.tan(alpha) - rounding / math.cos(alpha)
    turn = np.linspace(-math.pi / 2, -alpha, 300)
    top = 4 * MODULE
    x = [center + rounding * np.cos(turn), [width / 2 + top * math.tan(alpha)]]
    y = [-addendum + rounding + rounding * np.sin(turn), [top]]
    return closed(np.concatenate(x) / cos_beta, np.concatenate(y))


def shaper_polygon(gear, tool, rounding):
    """Cutter tooth with its tip up, about the cutter axis; and the generating centre distance."""
    rack = gear.rack
    half_angle = half_angle_from_profile_shift(rack, tool.teeth, tool.profile_shift_coefficient)
    cutter = Gear("cutter", rack, tool.teeth, False, half_angle, 1.0, 1.0, 0.02)
    low = (gear.base_radius - cutter.base_radius) * (1 + 1e-9)
    high = gear.reference_radius
    for _ in range(100):  # the backlash falls while the cutter moves towards the ring
        middle = (low + high) / 2
        radius = middle * tool.teeth / (gear.teeth - tool.teeth)  # of the pitch circle
        thick = cutter.thickness_at(radius) + gear.thickness_at(radius * gear.teeth / tool.teeth)
        loose = 2 * math.pi * radius / tool.teeth > thick
        low, high = (middle, high) if loose else (low, middle)
    tip = gear.root_radius - low
    outermost = math.sqrt((tip + 2 * rounding) ** 2 - cutter.base_radius**2)
    radius = np.hypot(cutter.base_radius, np.linspace(0.0, outermost, 20_000))
    cosine = cutter.base_radius / radius
    profile = np.arccos(cosine)
    angle = half_angle + involute(rack.transverse_pressure_angle) - (np.tan(profile) - profile)
    x, y = radius * np.sin(angle), radius * np.cos(angle)
    # Centre of the rounding: where the flank, moved inwards, meets the tip circle, moved inwards.
    # The flank leans from the ray through its point, to the middle, by the profile angle.
    normal = angle - profile - math.pi / 2
    inner_x, inner_y = x + rounding * np.sin(normal), y + rounding * np.cos(normal)
    end = np.interp(tip - rounding, np.hypot(inner_x, inner_y), np.arange(radius.size))
    center_x, center_y = (np.interp(end, np.arange(radius.size), c) for c in (inner_x, inner_y))
    last = np.interp(end, np.arange(radius.size), normal) + math.pi
    turn = np.linspace(last, math.atan2(center_x, center_y), 300)
    below = np.linspace(0, int(end), 300).astype(int)
    land = np.linspace(turn[-1], 0.0, 9)
    x = [x[below], center_x + rounding * np.sin(turn), tip * np.sin(land)]
    y = [y[below], center_y + rounding * np.cos(turn), tip * np.cos(land)]
    return closed(np.concatenate(x), np.concatenate(y)), low


def distance_to(polygon, x, y):
    """Distance of points from a convex polygon, negative inside; small distances only."""
    step = np.roll(polygon, -1, axis=0) - polygon
    length = np.hypot(*step.T)
    real = length > 1e-12
    step, corner = step[real] / length[real, np.newaxis], polygon[real]
    farthest = np.full(x.shape, -np.inf)
    for (along_x, along_y), (corner_x, corner_y) in zip(step, corner, strict=True):
        np.maximum(farthest, along_y * (x - corner_x) - along_x * (y - corner_y), out=farthest)
    return farthest


def gap_to_rack(gear, radius, half_angle, rounding):
    polygon = rack_polygon(gear, rounding)

    def gap(turn):
        angle = math.pi / gear.teeth - half_angle + turn
        x = radius * np.sin(angle) - gear.reference_radius * turn
        return distance_to(polygon, x, radius * np.cos(angle) - gear.reference_radius)

    return closest_approach(gap, radius.size, 6 * MODULE / gear.reference_radius)


def gap_to_shaper(gear, radius, half_angle, tool, rounding):
    polygon, center_distance = shaper_polygon(gear, tool, rounding)

    def gap(turn):
        angle = math.pi / gear.teeth - half_angle + turn * tool.teeth / gear.teeth
        x, y = radius * np.sin(angle), radius * np.cos(angle) - center_distance
        return distance_to(polygon, *turned(x, y, turn))

    return closest_approach(gap, radius.size, 12 * MODULE / (tool.teeth * MODULE / 2))


def turned(x, y, angle):
    """Points turned counter-clockwise."""
    sine, cosine = np.sin(angle), np.cos(angle)
    return x * cosine - y * sine, x * sine + y * cosine


def closest_approach(gap, count, reach):
    """Least gap of each point over tool positions: a coarse grid, refined about its least one."""
    coarse = np.linspace(-reach, reach, 401)
    best = coarse[np.argmin(gap(coarse[:, np.newaxis] * np.ones(count)), axis=0)]
    step = coarse[1] - coarse[0]
    fine = best + np.linspace(-step, step, 101)[:, np.newaxis]
    return np.min(gap(fine), axis=0)


def gaps(gear, outline, tool):
    parts = outline.radius, outline.half_angle
    if gear.internal:
        return gap_to_shaper(gear, *parts, tool, outline.fillet_tool_radius)
    return gap_to_rack(gear, *parts, outline.fillet_tool_radius)
