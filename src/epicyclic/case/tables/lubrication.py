"""The table [lubrication], how oil gets to the gears, and its checks."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from epicyclic.case.messages import did_you_mean
from epicyclic.case.tables.base import Condition, Table, broken_conditions, option
from epicyclic.case.tables.thermal import ThermalTable
from epicyclic.errors import Problem
from epicyclic.units import LITRE, Length, Number, Quantity, Speed, VolumeFlow

Method = Literal["jet", "spray", "flow", "drained", "dip", "submerged"]
SHARE_KEY = "surroundings.oil_air_ratio"
OWN_SHARE_KEY = "lubrication.oil_share"
FACTOR_KEY = "lubrication.oil_share_factor"
"""The keys that say how uncertain the share of oil is: given, or as the method has it."""
WETTING: Mapping[Method, tuple[str, ...]] = {
    "jet": ("spray", "spray-and-dip"),
    "spray": ("spray", "spray-and-dip"),
    "flow": ("spray", "spray-and-dip"),
    "drained": ("spray",),
    "dip": ("dip", "spray-and-dip"),
    "submerged": ("submerged",),
}
"""What thermal.lubrication is with each method if it is not given, and what else it may be."""
_Sump = Annotated[float, Quantity("a volume", "m^3", "l", low=0.0, high=1e6, open_low=True)]
_Level = Annotated[float, Quantity("a height", "m", "mm", low=-1e5, high=1e5)]


class LubricationTable(Table):
    """How oil gets to the gears: gives the share of oil around them, and their churning."""

    STAND_INS: ClassVar[dict[str, object]] = {
        "jet_speed": None,
        "nozzle_side": None,
        "churning": None,
        "oil_share_factor": None,
    }

    method: Method = Field(
        description="drained: mist only; flow: oil fed through shafts or carrier; dip: some of the "
        "gears reach into the sump."
    )
    oil_flow: VolumeFlow | None = option(
        None, "That jet, spray or flow brings to the gears of one set."
    )
    jet_speed: Speed = option(
        "0 m/s", "Of the oil of jets, along the teeth; 0: not known, or across."
    )
    nozzle_side: Literal["in-mesh", "out-of-mesh", "radial"] = option(
        "in-mesh", "Jets with the teeth as they mesh, against them as they part, or radial."
    )
    oil_level: _Level | None = option(
        None,
        "With dip: oil at rest above the axis of the set, or both axes of a pair; negative: below.",
    )
    immersion: dict[str, Length] = option(
        {},
        "With dip, instead of oil_level: depth of the lowest point of each gear, or of the "
        "carrier, below the oil at rest.",
    )
    oil_volume: _Sump | None = option(None, "With dip: in the sump. Default: thermal.oil_volume.")
    churning: Literal["changenet-velex", "iso-14179-1"] = option("changenet-velex", "With dip.")
    oil_share: Number | None = option(
        None,
        "Share of oil by volume around the gears, where it is known. Default: an estimate by "
        "method.",
        ge=0,
        le=1,
    )
    oil_share_factor: Number = option(1.0, "Multiplies that estimate, at most to 1.", gt=0, le=100)

    def __hash__(self) -> int:  # a table of names cannot be hashed
        return hash((self.method, self.oil_flow, self.oil_level, self.oil_share_factor))


LUBRICATION: Any = option(None, "With it surroundings.oil_air_ratio has no effect.")
"""The field of a case."""


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


_JETS = ("jet_speed", "nozzle_side")
_CONDITIONS = (
    Condition(
        "lubrication.oil_flow",
        lambda table: table.method == "flow" and table.oil_flow is None,
        'is missing, and method = "flow" needs it.',
        'Give it, as "2 l/min".',
    ),
    Condition(
        "lubrication.oil_level",
        lambda table: table.method == "dip" and table.oil_level is None and not table.immersion,
        'is missing, and method = "dip" needs it, or immersion.',
        'Give it from the axis of the set, as "-30 mm", or immersion = { sun = "5 mm" }.',
    ),
    Condition(
        "lubrication.oil_share, lubrication.oil_share_factor",
        lambda table: table.oil_share is not None and "oil_share_factor" in _stated(table),
        "exclude each other: the factor is of what follows from the method.",
        "Give one of them.",
    ),
    Condition(
        "lubrication.oil_level, lubrication.immersion",
        lambda table: table.oil_level is not None and bool(table.immersion),
        "state the same thing twice.",
        "Give one of them.",
    ),
)


def check_lubrication(table: LubricationTable) -> list[Problem]:
    """Keys that another method needs, and those that its own one lacks."""
    method, given = table.method, _stated(table)
    problems = []
    for key in sorted(given - _EVERY - set(_KEYS[method])):
        users = [f'"{name}"' for name, keys in _KEYS.items() if key in keys]
        allowed = f'has no effect with method = "{method}", but with {" or ".join(users)}.'
        problems.append(Problem(f"lubrication.{key}", "", allowed, "Remove it, or change method."))
    problems += [
        Problem(
            f"lubrication.{key}",
            "",
            "has no effect without oil_flow, the flow of the jets.",
            'Give that, as oil_flow = "2 l/min", or remove this key.',
        )
        for key in sorted(given.intersection(_JETS))
        if method == "jet" and table.oil_flow is None
    ]
    problems += broken_conditions(_CONDITIONS, table)
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
    allowed = f'contradicts lubrication.method = "{table.method}", with which it is {fitting}.'
    remedy = "Remove it: it follows from the method."
    return [Problem("thermal.lubrication", f'"{thermal.lubrication}"', allowed, remedy)]


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
