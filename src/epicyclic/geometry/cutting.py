"""The tool that cuts a gear: as stated, or one that leaves the involute that the mate needs."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

from epicyclic.geometry.gear import Gear
from epicyclic.geometry.generation import default_tool
from epicyclic.geometry.mesh import Mesh
from epicyclic.geometry.outline import form_radius, tooth_outline
from epicyclic.geometry.tools import RackTool, ShaperTool, Tool

TOOL_HALVINGS = 30
"""Halvings of the rounding of a tool until it is known: to a billionth."""


@lru_cache(maxsize=64)
def longest_involute(gear: Gear, rounding: float | None) -> float:
    """Radius at which the involute of `gear` ends towards its root, as long as a tool leaves it.

    That is the tool of the stated tip rounding, or else one with sharp corners. If these undercut
    the tooth, it is the rack with just the rounding that lets the involute begin at the base
    circle; if they cut away the tips of a ring, the default shaper cutter.

    Raises
    ------
    ValueError
        If no tool generates the tooth.
    """
    stated = stated_tool(gear, rounding)
    if not gear.internal:
        tool = _kindest_rack(gear) if stated is None else stated
        if _sharp_undercut(gear) > 0:
            tooth_outline(gear, tool, points=8)  # raises if undercut severs the teeth
        return form_radius(gear, tool)
    if stated is not None:
        return form_radius(gear, stated)
    shaper = default_tool(gear)
    assert isinstance(shaper, ShaperTool)
    try:
        return form_radius(gear, ShaperTool(shaper.teeth, 0.0))
    except ValueError:
        return form_radius(gear, shaper)


def stated_tool(gear: Gear, rounding: float | None) -> Tool | None:
    """The tool that cuts `gear` with a stated tip `rounding`; None if none is stated.

    Raises
    ------
    ValueError
        If no default shaper cutter generates a ring.
    """
    if rounding is None:
        return None
    if not gear.internal:
        return RackTool(rounding)
    shaper = default_tool(gear)
    assert isinstance(shaper, ShaperTool)
    return ShaperTool(shaper.teeth, rounding)


def cutting_tool(gear: Gear, rounding: float | None) -> Tool:
    """The tool that leaves the root fillet: as stated, or the default one if it cuts the tooth.

    If that one does not, it is the tool that leaves the longest involute.

    Raises
    ------
    ValueError
        If no tool generates the tooth.
    """
    stated = stated_tool(gear, rounding)
    if stated is not None:
        return stated
    tool = default_tool(gear)
    try:
        tooth_outline(gear, tool)
    except ValueError:
        if gear.internal:
            raise
        return _kindest_rack(gear)
    return tool


def _kindest_rack(gear: Gear) -> RackTool:
    sine = math.sin(gear.rack.normal_pressure_angle)
    return RackTool(max(0.0, _sharp_undercut(gear)) / (1 - sine))


def _sharp_undercut(gear: Gear) -> float:
    """How far a rack with sharp corners reaches beyond the start of the involute. [m]

    Negative if it does not reach that far: no undercut.
    """
    cosine = math.cos(gear.rack.transverse_pressure_angle)
    return gear.reference_radius * cosine**2 - gear.root_radius


@lru_cache(maxsize=256)
def fitted_tool(
    gear: Gear,
    rounding: float | None,  # Rounding of the tip of the tool, as stated; None if it is not. [m]
    needed: float,  # Radius to which the involute must reach towards the root. [m]
) -> Tool:
    """`cutting_tool`, its rounding reduced where it would take away involute that the mate needs.

    A stated rounding is kept.

    Raises
    ------
    ValueError
        If no tool generates the tooth.
    """
    usual = cutting_tool(gear, rounding)
    outward = -1 if gear.internal else 1

    def suits(tip_radius: float) -> bool:
        try:
            reached = form_radius(gear, replace(usual, tip_radius=tip_radius))
        except ValueError:
            return False
        return outward * (reached - needed) <= 0

    low = 0.0 if gear.internal else _kindest_rack(gear).tip_radius
    high = usual.tip_radius
    if rounding is not None or suits(high) or not suits(low):
        return usual
    for _ in range(TOOL_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if suits(middle) else (low, middle)
    return replace(usual, tip_radius=low)


def mated_tools(mesh: Mesh, roundings: tuple[float | None, float | None]) -> tuple[Tool, Tool]:
    """The tools that cut both gears of a mesh, each leaving the involute that the mate needs."""
    return (
        fitted_tool(mesh.gear1, roundings[0], mesh.radius1_at_start),
        fitted_tool(mesh.gear2, roundings[1], mesh.radius2_at_end),
    )
