"""What the tables of a case file are made of: their base class, named presets, shared values.

Each table is one class, in the modules beside this one; field descriptions become the JSON Schema
and the commented template. Values are SI after validation.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, GetJsonSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError

from epicyclic import library
from epicyclic.gears.flanks import RA_OVER_RQ, RZ_BAND, RZ_OVER_RA, rq_of
from epicyclic.gears.measures import named_fit
from epicyclic.messages import did_you_mean, titled, value_at
from epicyclic.oil.grades import ShortOil, whole_oil
from epicyclic.oil.oil import Conductivity, HeatCapacity, Oil
from epicyclic.schema.fields import Named, Table, option
from epicyclic.schema.read import plain
from epicyclic.units import MILLIMETRE, Density, Modulus, Number, Quantity


def _no_preset(
    noun: str, name: str, known: Iterable[str], allowed: str, other: str = ""
) -> PydanticCustomError:
    remedy = other or did_you_mean(name, known) or "Check the name"
    values = {"noun": noun, "allowed": allowed, "remedy": remedy}
    return PydanticCustomError("preset", "no such {noun}; it must be {allowed}", values)


_PARAMETER = re.compile(r"(R[aqz])(?![a-z])[\s=]*(.*)")


class _Roughness(Quantity):
    """A length, also with its parameter, ``"Ra 0.4 um"``, or the name of a built-in finish."""

    def parse(self, value: object) -> float:
        finishes = library.named("finishes")
        text = value.strip().capitalize() if isinstance(value, str) else ""
        if named := _PARAMETER.fullmatch(text):
            most = 100 // rq_of(named[1], 1.0)
            stated = Quantity(named[1], "m", "um", 0.0, most, open_low=True, label=f"{named[1]} ")
            return rq_of(named[1], stated.parse(named[2]))
        if isinstance(value, str) and value in finishes:
            value = finishes[value]["roughness"]
        elif isinstance(value, str) and value[:1].isalpha():
            raise _no_preset("finish", value, finishes, self.describe())
        return super().parse(value)

    def describe(self) -> str:
        finishes = ", ".join(library.named("finishes"))
        return f"{super().describe()}, also as Ra or Rz, or one of the finishes {finishes}"

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        length = super().__get_pydantic_json_schema__(schema, handler)
        stated = {"type": "string", "pattern": r"^\s*[Rr][AaQqZz](?![A-Za-z])"}
        return {"anyOf": [length, {"enum": list(library.named("finishes"))}, stated]}


Roughness = Annotated[
    float, _Roughness("an rms roughness", "m", "um", low=0.0, high=100.0, open_low=True)
]


def _known_fit(value: object) -> str:
    """The series of DIN 3967 as the standard writes them."""
    fit = named_fit(value) if isinstance(value, str) else None
    if fit is None:
        raise PydanticCustomError(
            "preset",
            "is not a series of DIN 3967; it must be a tolerance series from 21 to 30 with an "
            "allowance series a, ab, b, bc, c, cd, d, e, f, g or h",
            {"remedy": 'For example "25cd"'},
        )
    return fit


ThicknessFit = Annotated[str, BeforeValidator(_known_fit, json_schema_input_type=str)]


def roughness_told(text: object) -> tuple[float, str] | None:
    """Rq of a roughness that is stated as Ra or Rz, and how it was converted; None of others."""
    if not isinstance(text, str):
        return None
    named = _PARAMETER.fullmatch(text.strip().capitalize())
    if named is None or named[1] == "Rq":
        return None
    value = MILLIMETRE.parse(named[2])
    how = f"Rq from {' '.join(text.split())}: Ra = {RA_OVER_RQ:.3f} Rq of a Gaussian profile"
    if named[1] == "Rz":
        low, high = (value / (ratio * RA_OVER_RQ) for ratio in reversed(RZ_BAND))
        how += (
            f", Rz = {RZ_OVER_RA:g} Ra (DIN 3991); Rz/Ra from {RZ_BAND[0]:g} to {RZ_BAND[1]:g} "
            f"makes it {1e6 * low:.3g} to {1e6 * high:.3g} um"
        )
    return rq_of(named[1], value), f"{how}."


Stress = Annotated[float, Quantity("a stress", "Pa", "MPa", low=0.0, high=1e6, open_low=True)]

Gap = Annotated[float, Quantity("a gap", "m", "mm", low=0.0, high=1e4, open_low=True)]
SHROUD_GAP: Any = option("From its rim to a shroud around it. Default: no shroud.")
FLANGE_GAP: Any = option("From its faces to walls beside them. Default: no walls.")
ShortLength = Annotated[float, Quantity("a length", "m", "mm", low=0.0, high=1e5)]


class Material(Table):
    """Elastic and thermal constants of a solid."""

    title: str = "material of the case"
    elastic_modulus: Modulus
    poisson_ratio: Number = Field(default=0.3, ge=0.0, le=0.5)
    density: Density = option(None, "7850 kg/m^3")
    thermal_conductivity: Conductivity = option(None, "46 W/(m*K)")
    heat_capacity: HeatCapacity = option(None, "460 J/(kg*K)")
    source: str = ""


@cache
def _builtin(kind: type[Material] | type[Oil], name: str) -> Material | Oil:
    """A material or an oil of the library."""
    own = library.named("materials")[name] if kind is Material else library.oil_table(name)
    return kind.model_validate(own)


_MATERIALS = Named(
    lambda: tuple(library.named("materials")),
    lambda: f"a table of properties or one of {', '.join(library.named('materials'))}",
)
_OILS = Named(
    lambda: library.names("oils"),
    lambda: "a table of properties or a name of the oil library (epicyclic oils)",
    ShortOil,
)


def _named_material(value: object) -> object:
    """The built-in material if `value` is a name; anything else goes on to be checked."""
    if not isinstance(value, str):
        return value
    if value not in _MATERIALS.names():
        known = {name: table["title"] for name, table in library.named("materials").items()}
        raise _no_preset("material", value, known, _MATERIALS.allowed(), titled(value, known))
    return _builtin(Material, value)


def builtin_oil(table: Any) -> str | None:
    """The built-in oil of the grade and kind that a table states."""
    name = f"iso-vg-{value_at(table, ('iso_vg',))}-{value_at(table, ('kind',))}"
    return name if name in library.names("oils") else None


def _named_oil(value: object) -> object:
    """The built-in oil if `value` is a name; the whole oil of a short table; else as it is."""
    if isinstance(value, dict):
        name = builtin_oil(value)
        return whole_oil(value, None if name is None else plain(library.oil_table(name)))
    if not isinstance(value, str):
        return value
    if value not in _OILS.names():
        grease = 'Name its base oil, and write lubrication.method = "grease"'
        other = grease if "grease" in value.casefold() else ""
        raise _no_preset("oil", value, _OILS.names(), _OILS.allowed(), other)
    return _builtin(Oil, value)


NamedMaterial = Annotated[Material, BeforeValidator(_named_material), _MATERIALS]
NamedOil = Annotated[Oil, BeforeValidator(_named_oil), _OILS]
