"""Checks of what a case states about how oil gets to its gears."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from epicyclic.case.lubrication import WETTING
from epicyclic.case.messages import did_you_mean
from epicyclic.case.tables.lubrication import LubricationTable, Method
from epicyclic.case.tables.thermal import ThermalTable
from epicyclic.errors import Problem
from epicyclic.units import LITRE

_EVERY = {"method", "oil_share", "oil_share_factor"}
_KEYS: Mapping[Method, Collection[str]] = {
    "jet": ("oil_flow", "jet_speed", "nozzle_side"),
    "spray": ("oil_flow",),
    "flow": ("oil_flow",),
    "drained": (),
    "dip": ("oil_level", "immersion", "oil_volume", "churning"),
    "submerged": (),
}
"""Keys that have an effect with each method."""


def check_lubrication(table: LubricationTable) -> list[Problem]:
    """Keys that another method needs, and those that its own one lacks."""
    method, given = table.method, _stated(table)
    problems = []
    for key in sorted(given - _EVERY - set(_KEYS[method])):
        users = [f'"{name}"' for name, keys in _KEYS.items() if key in keys]
        allowed = f'has no effect with method = "{method}", but with {" or ".join(users)}.'
        problems.append(Problem(f"lubrication.{key}", "", allowed, "Remove it, or change method."))
    if method == "flow" and table.oil_flow is None:
        allowed = 'is missing, and method = "flow" needs it.'
        problems.append(Problem("lubrication.oil_flow", "", allowed, 'Give it, as "2 l/min".'))
    if method == "jet" and table.oil_flow is None:
        problems += [
            Problem(
                f"lubrication.{key}",
                "",
                "has no effect without oil_flow, the flow of the jets.",
                'Give that, as oil_flow = "2 l/min", or remove this key.',
            )
            for key in sorted(given & {"jet_speed", "nozzle_side"})
        ]
    if method == "dip" and table.oil_level is None and not table.immersion:
        allowed = 'is missing, and method = "dip" needs it, or immersion.'
        remedy = 'Give it from the axis of the set, as "-30 mm", or immersion = { sun = "5 mm" }.'
        problems.append(Problem("lubrication.oil_level", "", allowed, remedy))
    if table.oil_share is not None and "oil_share_factor" in given:
        key = "lubrication.oil_share, lubrication.oil_share_factor"
        allowed = "exclude each other: the factor is of what follows from the method."
        problems.append(Problem(key, "", allowed, "Give one of them."))
    if table.oil_level is not None and table.immersion:
        key = "lubrication.oil_level, lubrication.immersion"
        problems.append(Problem(key, "", "state the same thing twice.", "Give one of them."))
    return problems


def _stated(table: LubricationTable) -> set[str]:
    """Keys that were given other values than their defaults."""
    usual = LubricationTable(method=table.method)
    return {key for key in table.model_fields_set if getattr(table, key) != getattr(usual, key)}


def check_sump(table: LubricationTable, thermal: ThermalTable) -> list[Problem]:
    """Dipping needs the volume of the oil, once."""
    own, other = table.oil_volume, thermal.oil_volume or None
    if table.method != "dip":
        return []
    if own is None and other is None:
        allowed = 'is missing, and method = "dip" needs it.'
        return [Problem("lubrication.oil_volume", "", allowed, 'Give it, as "1.5 l".')]
    if own is None or other is None or own == other:
        return []
    return [
        Problem(
            "lubrication.oil_volume, thermal.oil_volume",
            f"{LITRE.text(own)}, {LITRE.text(other)}",
            "are one volume, and differ.",
            "Give one of them.",
        )
    ]


def check_wetting(table: LubricationTable, thermal: ThermalTable) -> list[Problem]:
    """The temperatures must see the oil as the losses do."""
    wetting = WETTING[table.method]
    if "lubrication" not in thermal.model_fields_set or thermal.lubrication in wetting:
        return []
    fitting = " or ".join(f'"{name}"' for name in wetting)
    return [
        Problem(
            "thermal.lubrication",
            f'"{thermal.lubrication}"',
            f'contradicts lubrication.method = "{table.method}", with which it is {fitting}.',
            "Remove it: it follows from the method.",
        )
    ]


def check_immersion(table: LubricationTable, parts: Collection[str]) -> list[Problem]:
    """Depths of parts that can churn."""
    known = ", ".join(parts)
    return [
        Problem(
            f"lubrication.immersion.{name}",
            "",
            f"is no part whose churning is computed: {known}.",
            did_you_mean(name, parts) or "Name one of these; planets are left out.",
        )
        for name in table.immersion
        if name not in parts
    ]
