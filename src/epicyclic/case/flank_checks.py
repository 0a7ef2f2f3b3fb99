"""Can these modifications and deviations be on these flanks?

Every function returns the problems it finds; none stops at the first.
"""

from __future__ import annotations

from dataclasses import dataclass

from epicyclic.case.flanks import roll_length_at, working_flank
from epicyclic.case.gear_tables import GearTable, MicroGeometryTable, TopographyTable
from epicyclic.case.messages import millimetres
from epicyclic.errors import Problem, rising_problems
from epicyclic.gears.flanks import active_profile
from epicyclic.gears.gear import Gear
from epicyclic.gears.mesh import Mesh


@dataclass(frozen=True, slots=True)
class _Flank:
    """A flank that works in a mesh, and the key of its table."""

    key: str
    gear: Gear
    mesh: Mesh
    member: int
    table: MicroGeometryTable

    @property
    def active(self) -> tuple[float, float]:
        """Roll lengths of the active profile at the root and at the tip. [m]"""
        return active_profile(self.mesh, self.member)

    @property
    def active_length(self) -> float:
        """[m]"""
        root, tip = self.active
        return abs(tip - root)


def check_flanks(mesh: Mesh, tables: tuple[GearTable, GearTable]) -> list[Problem]:
    """Problems of the micro-geometry of both working flanks of a mesh."""
    problems = []
    for member, gear in ((1, mesh.gear1), (2, mesh.gear2)):
        gear_table = tables[member - 1]
        table = working_flank(member, gear_table)
        if table is not None:
            name = "micro_geometry"
            if table is not gear_table.micro_geometry:
                name = "micro_geometry_ring_side"
            problems += _check_flank(_Flank(f"{gear.name}.{name}", gear, mesh, member, table))
    return problems


def _check_flank(flank: _Flank) -> list[Problem]:
    lengths = {end: _relief_length(flank, end) for end in ("tip", "root")}
    problems = [found for found in lengths.values() if isinstance(found, Problem)]
    tip, root = lengths["tip"], lengths["root"]
    if not problems and isinstance(tip, float) and isinstance(root, float):
        problems += _check_overlap(flank, tip, root)
    problems += _check_end_relief(flank)
    problems += _without_amount(flank)
    if flank.table.topography is not None:
        problems += _check_topography(flank, flank.table.topography)
    return problems


def _relief_length(flank: _Flank, end: str) -> float | Problem:
    """Roll length of the tip or root relief, 0 without one, or what is wrong with it."""
    key = f"{flank.key}.{end}_relief"
    amount: float = getattr(flank.table, f"{end}_relief")
    roll_length: float | None = getattr(flank.table, f"{end}_relief_roll_length")
    diameter: float | None = getattr(flank.table, f"{end}_relief_diameter")
    given = [
        name
        for name, value in (("roll_length", roll_length), ("diameter", diameter))
        if value is not None
    ]
    if amount == 0 and not given:
        return 0.0
    if len(given) != 1:
        return Problem(
            key,
            f"{amount * 1e6:.5g} um",
            f"needs the start of the relief, {'given once' if given else 'which is missing'}.",
            f"Give {end}_relief_roll_length or {end}_relief_diameter.",
        )
    near, far = flank.active[::-1] if end == "tip" else flank.active
    inside = f"the active profile of the {flank.mesh.name}"
    if diameter is not None:
        length = (roll_length_at(flank.gear, diameter / 2) - near) / (far - near)
        if 0 < length <= 1:
            return length * flank.active_length
        ends = sorted(_diameter(flank.gear, roll) for roll in (near, far))
        allowed = f"between {millimetres(ends[0])} and {millimetres(ends[1])}"
        shown = millimetres(diameter)
    else:
        assert roll_length is not None
        if roll_length <= flank.active_length:
            return roll_length
        allowed = f"within {millimetres(flank.active_length)} of roll"
        shown = millimetres(roll_length)
    return Problem(
        f"{key}_{given[0]}",
        shown,
        f"the relief must start in {inside}, {allowed}.",
        "Correct where it starts.",
    )


def _without_amount(flank: _Flank) -> list[Problem]:
    """Length, diameter or shape of a relief whose amount is not given."""
    given = flank.table.model_fields_set
    return [
        Problem(
            f"{flank.key}.{key}",
            "",
            f"belongs to {relief}, which is not given.",
            f"Give {relief}, or leave out {key}.",
        )
        for relief in ("tip_relief", "root_relief", "end_relief")
        if relief not in given
        for key in sorted(given)
        if key.startswith(f"{relief}_")
    ]


def _diameter(gear: Gear, roll_length: float) -> float:
    return float(2 * (gear.base_radius**2 + roll_length**2) ** 0.5)


def _check_overlap(flank: _Flank, tip: float, root: float) -> list[Problem]:
    if tip + root <= flank.active_length:
        return []
    return [
        Problem(
            f"{flank.key}.tip_relief",
            "",
            f"tip relief over {millimetres(tip)} and root relief over {millimetres(root)} of roll "
            f"overlap: the active profile of the {flank.mesh.name} has "
            f"{millimetres(flank.active_length)}.",
            "Shorten one of the two.",
        )
    ]


def _check_end_relief(flank: _Flank) -> list[Problem]:
    length, width = flank.table.end_relief_length, flank.gear.face_width
    key = f"{flank.key}.end_relief_length"
    if length is None:
        if flank.table.end_relief == 0:
            return []
        return [Problem(key, "", "is missing; it belongs to end_relief.", "Add end_relief_length.")]
    if 2 * length <= width:
        return []
    return [
        Problem(
            key,
            millimetres(length),
            f"both end reliefs must fit into the face width of {millimetres(width)}.",
            f"Reduce it to {millimetres(width / 2)} or less.",
        )
    ]


def _check_topography(flank: _Flank, table: TopographyTable) -> list[Problem]:
    key = f"{flank.key}.topography"
    axes = {"diameter": table.diameter, "face_position": table.face_position}
    problems = rising_problems(axes, f"{key}.")
    wanted = (len(table.diameter), len(table.face_position))
    if len(table.deviation) != wanted[0] or any(len(row) != wanted[1] for row in table.deviation):
        problems.append(
            Problem(
                f"{key}.deviation",
                f"{len(table.deviation)} rows",
                f"must be {wanted[0]} rows of {wanted[1]} values, for the points of diameter and "
                "face_position.",
                "Give one row for each diameter, with one value for each face position.",
            )
        )
    base = 2 * flank.gear.base_radius
    if table.diameter and table.diameter[0] < base:
        problems.append(
            Problem(
                f"{key}.diameter",
                millimetres(table.diameter[0]),
                f"lies inside the base circle of {millimetres(base)}, where there is no involute.",
                "Leave out these rows.",
            )
        )
    return problems or _check_place(flank, table)


def _check_place(flank: _Flank, table: TopographyTable) -> list[Problem]:
    """The points of a sound topography must lie where the flank works."""
    ends = sorted(_diameter(flank.gear, roll) for roll in flank.active)
    places = (
        ("diameter", table.diameter, f"active profile of the {flank.mesh.name}", ends),
        ("face_position", table.face_position, "face", [0.0, flank.gear.face_width]),
    )
    return [
        Problem(
            f"{flank.key}.topography.{name}",
            f"{millimetres(points[0])} to {millimetres(points[-1])}",
            f"must overlap the {where}, {millimetres(low)} to {millimetres(high)}, by at least "
            "half of the longer of the two.",
            "Give the deviations where the flank works.",
        )
        for name, points, where, (low, high) in places
        if not _shares_half((points[0], points[-1]), (low, high))
    ]


def _shares_half(one: tuple[float, float], two: tuple[float, float]) -> bool:
    """Two ranges have at least half of the longer one in common."""
    common = min(one[1], two[1]) - max(one[0], two[0])
    return common >= max(one[1] - one[0], two[1] - two[0]) / 2
