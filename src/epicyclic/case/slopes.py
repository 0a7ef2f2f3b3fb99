"""How far the slopes of flanks may be off by the accuracy class of their gear."""

from __future__ import annotations

from typing import Any

from epicyclic.case.base import CaseTable
from epicyclic.case.fields import value_of
from epicyclic.case.gear_tables import GearTable
from epicyclic.case.messages import dotted, key_parts
from epicyclic.case.thickness import tolerances_of

SLOPES = {"profile_slope": "profile_slope", "lead_slope": "helix_slope"}
"""Keys of ``micro_geometry``, and what ISO 1328-1 calls their tolerance."""
_FLANKS = ("micro_geometry", "micro_geometry_ring_side")
_TAKES_DEVIATIONS = "compliance"
"""The load distribution to which slopes matter."""


def slope_limit(case: CaseTable, key: str) -> float | None:
    """Tolerance f_HalphaT or f_HbetaT of the slope that `key` states; None where it has none.

    None also where the load distribution does not see slopes, and of the flank that works against
    the ring unless the case has a table of it: else it has the slope of the other one. [m]
    """
    parts = key_parts(key)
    if len(parts) < 3 or parts[-1] not in SLOPES or parts[-2] not in _FLANKS:
        return None
    *owner, name = parts[:-2]
    table = value_of(case, dotted([*owner, name]))
    if not isinstance(table, GearTable) or table.accuracy_class is None:
        return None
    if parts[-2] != _FLANKS[0] and getattr(table, parts[-2], None) is None:
        return None
    of_set: Any = case  # a set or pair by itself, in a train, or with listed gears
    if owner:
        of_set = value_of(case, dotted(owner[:2]))
    if of_set.models.load_distribution != _TAKES_DEVIATIONS:
        return None
    gearing = case.gearings[owner[1] if owner else ""]
    tolerances = tolerances_of(gearing.gear(name), table)
    return float(getattr(tolerances, SLOPES[parts[-1]]))
