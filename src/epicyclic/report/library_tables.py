"""Tables of what is built in."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from epicyclic import library
from epicyclic.oil.oil import Oil
from epicyclic.oil.properties import OilState, oil_state
from epicyclic.report.shown import shown
from epicyclic.report.tables import plain_table
from epicyclic.units import (
    CELSIUS,
    KILOGRAM_PER_CUBIC_METRE,
    PER_GIGAPASCAL,
    SQUARE_MM_PER_SECOND,
    Quantity,
    unit_text,
)


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
    viscosity = unit_text(SQUARE_MM_PER_SECOND.display)
    for column in (
        f"ν 40 °C\n{viscosity}",
        f"ν 100 °C\n{viscosity}",
        f"ρ 40 °C\n{unit_text(KILOGRAM_PER_CUBIC_METRE.display)}",
        f"α 40 °C\n{unit_text(PER_GIGAPASCAL.display)}",
    ):
        table.add_column(column, justify="right")
    for name in sorted(library.oil_names(), key=_by_grade):
        oil = Oil.model_validate(library.oil_table(name))
        warm, hot = _state(oil, "40 degC"), _state(oil, "100 degC")
        table.add_row(
            name,
            oil.kind,
            shown(SQUARE_MM_PER_SECOND.to_display(warm.kinematic_viscosity)),
            shown(SQUARE_MM_PER_SECOND.to_display(hot.kinematic_viscosity)),
            shown(KILOGRAM_PER_CUBIC_METRE.to_display(warm.density)),
            shown(PER_GIGAPASCAL.to_display(warm.pressure_viscosity), 3),
        )
    return Group(table, Text("Sources of the values: epicyclic oils NAME"))


def _state(oil: Oil, temperature: str) -> OilState:
    return oil_state(oil, CELSIUS.parse(temperature))


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
        table.add_row(
            f"kinematic viscosity at {_text(CELSIUS, point.temperature, 4)}",
            _text(SQUARE_MM_PER_SECOND, point.value),
            point.source,
        )
    for density in oil.density:
        table.add_row(
            f"density at {_text(CELSIUS, density.temperature, 4)}",
            _text(KILOGRAM_PER_CUBIC_METRE, density.value),
            density.source,
        )
    law = oil.pressure_viscosity
    calibrated = " (calibrated)" if law.calibrated else ""
    table.add_row(
        f"pressure-viscosity coefficient at 40 °C, {law.law} law{calibrated}",
        _text(PER_GIGAPASCAL, _state(oil, "40 degC").pressure_viscosity, 4),
        law.source,
    )
    factor = oil.lubricant_factor
    table.add_row("lubricant factor X_L", f"{factor.value:g}", factor.source)
    return Group(Text(oil.description), table)


def _text(kind: Quantity, value: float, digits: int = 6) -> str:
    """An SI `value` with its unit, as tables show them."""
    return f"{shown(kind.to_display(value), digits)} {unit_text(kind.display)}"
