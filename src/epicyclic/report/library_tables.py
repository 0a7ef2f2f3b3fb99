"""Tables of what is built in."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from epicyclic import library
from epicyclic.lubricant.oil import Oil
from epicyclic.lubricant.properties import oil_state
from epicyclic.report.tables import plain_table
from epicyclic.units import format_number

__all__ = ["case_table", "oil_sheet", "oil_table"]

CELSIUS_40 = 313.15
CELSIUS_100 = 373.15


def case_table() -> RenderableType:
    """Built-in cases and the words that name their variants."""
    table = plain_table("Built-in cases")
    table.add_column("name", no_wrap=True)
    table.add_column("what it is")
    table.add_column("variants: at most one word of each line, joined by -")
    for name in library.case_files():
        groups = library.case_variants().get(name, [])
        words = "\n".join(f"{' '.join(group['words'])}  ({group['about']})" for group in groups)
        table.add_row(name, library.builtin_case(name)["title"], words)
    example = Text("For example: epicyclic run talbot-2012-n6-polished-40C")
    return Group(table, example)


def oil_table() -> RenderableType:
    """The oil library."""
    table = plain_table("Built-in oils")
    table.add_column("name", no_wrap=True)
    table.add_column("kind")
    for column in ("ν 40 °C\nmm²/s", "ν 100 °C\nmm²/s", "ρ 40 °C\nkg/m³", "α 40 °C\n1/GPa"):
        table.add_column(column, justify="right")
    for name in sorted(library.oil_names(), key=_by_grade):
        oil = Oil.model_validate(library.oil_table(name))
        warm, hot = oil_state(oil, CELSIUS_40), oil_state(oil, CELSIUS_100)
        table.add_row(
            name,
            oil.kind,
            format_number(warm.kinematic_viscosity * 1e6, 4),
            format_number(hot.kinematic_viscosity * 1e6, 4),
            format_number(warm.density, 4),
            format_number(warm.pressure_viscosity * 1e9, 3),
        )
    return Group(table, Text("Sources of the values: epicyclic oils NAME"))


def _by_grade(name: str) -> list[tuple[bool, int, str]]:
    """Sort key that puts ISO VG 68 before ISO VG 100."""
    return [(part.isdigit(), int(part) if part.isdigit() else 0, part) for part in name.split("-")]


def oil_sheet(name: str) -> RenderableType:
    """Every value of one oil with its source."""
    oil = Oil.model_validate(library.oil_table(name))
    table = plain_table(f"{name}: {oil.title}")
    table.add_column("property")
    table.add_column("value", justify="right", no_wrap=True)
    table.add_column("source")
    for point in oil.kinematic_viscosity:
        celsius = format_number(point.temperature - 273.15, 4)
        value = f"{format_number(point.value * 1e6)} mm²/s"
        table.add_row(f"kinematic viscosity at {celsius} °C", value, point.source)
    for density in oil.density:
        celsius = format_number(density.temperature - 273.15, 4)
        table.add_row(f"density at {celsius} °C", f"{density.value:g} kg/m³", density.source)
    law = oil.pressure_viscosity
    calibrated = " (calibrated)" if law.calibrated else ""
    alpha = oil_state(oil, CELSIUS_40).pressure_viscosity * 1e9
    table.add_row(
        f"pressure-viscosity coefficient at 40 °C, {law.law} law{calibrated}",
        f"{format_number(alpha, 4)} 1/GPa",
        law.source,
    )
    factor = oil.lubricant_factor
    table.add_row("lubricant factor X_L", f"{factor.value:g}", factor.source)
    return Group(Text(oil.description), table)
