"""Checks of what a case states about heat."""

from __future__ import annotations

from epicyclic.case.thermal_tables import ThermalTable
from epicyclic.errors import Problem
from epicyclic.units import CELSIUS

ROUNDING = 1e-9
"""Rounding of shares that add up to 1. [1]"""


def check_thermal(thermal: ThermalTable) -> list[Problem]:
    """What [thermal] states twice, or more of than there is."""
    problems = []
    if thermal.oil_flow is not None and thermal.oil_outlet_temperature is not None:
        problems.append(
            Problem(
                "thermal.oil_flow, thermal.oil_outlet_temperature",
                "",
                "determine each other, by the heat that the oil takes along.",
                "Give one of them.",
            )
        )
    for name, share in thermal.jet_shares.items():
        if not 0 <= share <= 1:
            problems.append(
                Problem(
                    f"thermal.jet_shares.{name}",
                    f"{share:g}",
                    "must be a number >= 0 and <= 1.",
                    "Give the part of the oil flow that meets it.",
                )
            )
    whole = sum(thermal.jet_shares.values())
    if not problems and whole > 1 + ROUNDING:
        problems.append(
            Problem(
                "thermal.jet_shares",
                "",
                f"add up to {whole:g}, more than all of the oil.",
                f"Divide each by {whole:g}, or leave some out.",
            )
        )
    return problems


def check_outlet(thermal: ThermalTable, inlet: float | None) -> list[Problem]:
    """The oil must leave warmer than it comes."""
    outlet = thermal.oil_outlet_temperature
    if outlet is None or inlet is None or outlet > inlet:
        return []
    return [
        Problem(
            "thermal.oil_outlet_temperature",
            CELSIUS.text(outlet),
            f"must be above operation.oil_inlet_temperature, {CELSIUS.text(inlet)}: the oil takes "
            "the heat of the losses along.",
            "Correct one of them, or give thermal.oil_flow.",
        )
    ]


def check_ways_out(thermal: ThermalTable, temperatures: str) -> list[Problem]:
    """A network needs a way for the heat to leave."""
    ways = (
        thermal.oil_flow,
        thermal.oil_outlet_temperature,
        thermal.housing,
        thermal.cooler_conductance,
    )
    if temperatures != "network" or any(ways):
        return []
    return [
        Problem(
            "thermal",
            "",
            'leaves no way out for the heat, which models.temperatures = "network" follows.',
            "Give thermal.oil_flow or thermal.oil_outlet_temperature, [thermal.housing] with its "
            "area, or thermal.cooler_conductance.",
        )
    ]
