"""Keys that choose how an oil behaves in a line contact."""

from __future__ import annotations

from dataclasses import fields
from typing import Annotated, Any, Literal

from pydantic import Field

from epicyclic.case.schema import Stress, Table
from epicyclic.errors import Problem
from epicyclic.oil.rheology import (
    DEFAULT,
    PRESETS,
    PRESSURE_LAWS,
    SHEAR_LAWS,
    SLOPE_RATIO,
    TRANSITION,
    Assumptions,
    OilLaws,
    PressureLaw,
    ReeEyring,
    ShearLaw,
)
from epicyclic.units import Number, PressureViscosity, Quantity, as_stated

LoadPressure = Annotated[
    float, Quantity("a pressure", "Pa", "GPa", low=0.0, high=100.0, open_low=True)
]

PRESSURE_NAMES: dict[type[PressureLaw], Any] = {law: name for name, law in PRESSURE_LAWS.items()}
USUAL = PRESETS[DEFAULT]
PresetName = Literal["usual", "as-published"]
PRESET = (
    "Assumptions where a key is not given: as-published for those made before the comparison with "
    "the dissertation."
)
"""What the key says."""


def stress_text(assumed: Assumptions) -> str:
    """The Eyring stress as a file has it."""
    return f"{assumed.eyring_stress * 1e-6:g} MPa"


def film_text(assumed: Assumptions) -> str:
    """The film of touching as a file has it."""
    return f"{assumed.film * 1e9:g} nm"


def behaviour_of(preset: object) -> dict[str, object]:
    """Keys of `OilBehaviour` that a preset sets; none for a name that there is not."""
    assumed = PRESETS.get(str(preset))
    if assumed is None:
        return {}
    law = PRESSURE_NAMES[assumed.pressure_law]
    return {"pressure_law": law, "eyring_stress": stress_text(assumed)}


HeatingModel = Literal["isothermal", "inlet-and-film"]
HEATING = "With or without thinner inlet film, flash and film temperature."
"""What the key says."""
NEEDED = {
    "limiting-stress": ("shear_stress",),
    "carreau": ("shear_stress", "shear_exponent"),
}
"""Keys without which a law cannot be used."""
OF_TWO_SLOPES = ("second_slope", "slope_ratio", "transition_pressure")
"""Keys of that law, which has a default for each."""
KEYS = {"stress": "shear_stress", "slope": "shear_stress_slope", "exponent": "shear_exponent"}
"""Keys that hold the constants of a law of shear."""


class OilBehaviour(Table):
    """Viscosity under pressure and under shear."""

    pressure_law: Literal["roelands", "barus", "two-slope"] = Field(
        default=PRESSURE_NAMES[USUAL.pressure_law], description="Viscosity under pressure."
    )
    slope_ratio: Number = Field(
        default=SLOPE_RATIO, gt=0.0, le=1.0,
        description="For two-slope: slope at high over that at ambient pressure (estimate).",
    )  # fmt: skip
    second_slope: PressureViscosity | None = Field(
        default=None, description="For two-slope: slope at high pressure, instead of slope_ratio."
    )
    transition_pressure: LoadPressure = Field(
        default=as_stated(f"{TRANSITION * 1e-9:g} GPa"),
        description="For two-slope: where the slopes meet (estimate).",
    )
    eyring_stress: Stress = Field(
        default=as_stated(stress_text(USUAL)),
        description="Of the default law: stress beyond which the oil thins (estimate; mineral "
        "oils 2 to 10 MPa).",
    )
    shear_law: Literal["ree-eyring", "newtonian", "limiting-stress", "carreau"] = Field(
        default="ree-eyring", description="Viscosity under shear."
    )
    shear_stress: Stress | None = Field(
        default=None, description="For limiting-stress and carreau: the stress of the law."
    )
    shear_stress_slope: Number = Field(
        default=0.0, ge=0.0, le=1.0,
        description="Of ree-eyring and limiting-stress: rise of the stress with the pressure.",
    )  # fmt: skip
    shear_exponent: Number | None = Field(
        default=None, gt=0.0, le=1.0, description="For carreau: n."
    )


def law_problems(section: str, table: OilBehaviour) -> list[Problem]:
    """Each law has the keys that it needs, and no others are given."""
    chosen = (table.pressure_law, table.shear_law)
    needed = {key: law for law in chosen for key in NEEDED.get(law, ())}
    problems = []
    for key in sorted({key for keys in NEEDED.values() for key in keys}):
        given = getattr(table, key) is not None
        if key in needed and not given:
            allowed = f"is missing; {needed[key]} needs it."
            problems.append(Problem(f"{section}.{key}", "", allowed, "Give it."))
        elif given and key not in needed:
            laws = " and ".join(law for law, keys in NEEDED.items() if key in keys)
            remedy = "Choose such a law, or leave it out."
            problems.append(Problem(f"{section}.{key}", "", f"is for {laws} only.", remedy))
    return problems + [
        Problem(f"{section}.{key}", "", "is for two-slope only.", "Choose it, or leave it out.")
        for key in OF_TWO_SLOPES
        if table.pressure_law != "two-slope" and getattr(table, key) != getattr(_USUAL_OIL, key)
    ]


_USUAL_OIL = OilBehaviour()


def oil_laws(table: OilBehaviour) -> OilLaws:
    """The laws that a table without problems chooses."""
    return OilLaws(
        PRESSURE_LAWS[table.pressure_law], _shear_law(table), table.second_slope,
        table.slope_ratio, table.transition_pressure,
    )  # fmt: skip


def _shear_law(table: OilBehaviour) -> ShearLaw:
    law = SHEAR_LAWS[table.shear_law]
    if law is ReeEyring:
        return ReeEyring(table.eyring_stress, table.shear_stress_slope)
    return law(*(getattr(table, KEYS[field.name]) for field in fields(law)))
