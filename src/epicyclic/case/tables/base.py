"""What the tables of a case file are made of: their base class, named presets, shared values.

Each table is one class, in the modules beside this one; field descriptions become the JSON Schema
and the commented template. Values are SI after validation.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetJsonSchemaHandler,
)
from pydantic_core import CoreSchema, PydanticCustomError

from epicyclic import library
from epicyclic.case.fields import Named, did_you_mean, to_inputs
from epicyclic.case.read import plain
from epicyclic.errors import Problem
from epicyclic.gears.flanks import RA_OVER_RQ, RZ_BAND, RZ_OVER_RA, rq_of
from epicyclic.gears.measures import named_fit
from epicyclic.oil.oil import Conductivity, HeatCapacity, Oil, OilDensity
from epicyclic.units import (
    MILLIMETRE,
    Density,
    KinematicViscosity,
    Modulus,
    Number,
    Quantity,
    as_stated,
)


def option(description: str, default: Any = None, **limits: Any) -> Any:
    """The field of a key with a default, which is stated as a file has it, with its unit."""
    return Field(default=default, description=description, **limits)


# An oil by its ISO viscosity grade or by two viscosities.
#
# What such a table leaves out is typical of its kind, and its source says so.

GOLD: dict[str, tuple[float, float, str]] = {
    "mineral": (9.904, 0.1390, "mineral oil"),
    "pao": (7.382, 0.1335, "polyalphaolefin"),
    "ester": (6.605, 0.1360, "ester"),
    "pag": (5.489, 0.1485, "polyglycol"),
    "atf": (9.904, 0.1390, "mineral oil, assumed for transmission fluids"),
}
"""s, t and name of base oils; Gold et al. (2001), second hand; see `GoldLaw`."""

DENSITY = {"mineral": 880, "pao": 850, "ester": 930, "pag": 1050, "atf": 850}
"""Usual densities at 15 degC; estimates. [kg/m^3]"""

GRADES = (2, 3, 5, 7, 10, 15, 22, 32, 46, 68, 100, 150, 220, 320, 460, 680, 1000, 1500, 2200, 3200)
"""Grades of ISO 3448: middle of their viscosity at 40 degC in mm^2/s. Those below 10 have
2.2, 3.2, 4.6 and 6.8."""
_SMALL = {2: 2.2, 3: 3.2, 5: 4.6, 7: 6.8}


class ShortOil(BaseModel):
    """An oil by its ISO viscosity grade or two viscosities, and its kind."""

    model_config = ConfigDict(extra="allow")

    kind: Literal["mineral", "pao", "ester", "pag", "atf"]
    iso_vg: int | None = option("Grade of ISO 3448.")
    viscosity_40: KinematicViscosity | None = option("At 40 degC.")
    viscosity_100: KinematicViscosity | None = option("At 100 degC.")
    density_15: OilDensity | None = option("At 15 degC.")


_SHORT_KEYS = ("iso_vg", "viscosity_40", "viscosity_100", "density_15")


def _is_short(table: object) -> bool:
    return isinstance(table, Mapping) and any(key in table for key in _SHORT_KEYS)


def _refused_oil(what: str, remedy: str) -> PydanticCustomError:
    return PydanticCustomError("oil", "{what}", {"what": what, "remedy": remedy})


def _builtin_oil(table: Mapping[str, Any]) -> str | None:
    """The built-in oil of the grade and kind."""
    name = f"iso-vg-{table.get('iso_vg')}-{table.get('kind')}"
    return name if name in library.oil_names() else None


def whole_oil(table: dict[str, Any]) -> dict[str, Any]:
    """The properties of an oil that its grade or two viscosities describe; others as they are.

    Raises `PydanticCustomError` if the table does not tell the viscosity at two temperatures.
    """
    if not _is_short(table):
        return table
    grade, preset = table.get("iso_vg"), _builtin_oil(table)
    own = {key: value for key, value in table.items() if key not in _SHORT_KEYS}
    if grade is not None and grade not in GRADES:
        near = ", ".join(map(str, GRADES))
        raise _refused_oil(
            f"has no viscosity grade of ISO 3448: iso_vg must be one of {near}", "Choose one"
        )
    if grade is not None and "viscosity_40" in table:
        raise _refused_oil("gives iso_vg and viscosity_40, which are the same", "Give one of them")
    whole: dict[str, Any]
    if preset is not None and "viscosity_100" not in table:
        whole = plain(library.oil_table(preset)) | own
    else:
        whole = _typical(str(table.get("kind"))) | own
        whole["kinematic_viscosity"] = _viscosities(table)
    if "density_15" in table:
        whole["density"] = (_point("15 degC", table["density_15"], "as stated"),)
    return whole


def _viscosities(table: Mapping[str, Any]) -> tuple[dict[str, Any], ...]:
    grade, warm = table.get("iso_vg"), table.get("viscosity_100")
    if warm is None:
        raise _refused_oil(
            "leaves the viscosity at 100 degC open, and no built-in oil has this grade and kind",
            'Add viscosity_100 = "... mm^2/s" from the data sheet',
        )
    if grade is None and "viscosity_40" not in table:
        raise _refused_oil("leaves the viscosity at 40 degC open", "Add iso_vg or viscosity_40")
    stated = table.get("viscosity_40", f"{_SMALL.get(grade or 0, grade)} mm^2/s")
    source = "as stated" if grade is None else "ISO 3448, middle of the grade"
    return _point("40 degC", stated, source), _point("100 degC", warm, "as stated")


def _point(temperature: str, value: Any, source: str) -> dict[str, Any]:
    return {"temperature": temperature, "value": value, "source": source}


def _typical(kind: str) -> dict[str, Any]:
    """What a kind of oil has if nothing else is known; of an unknown kind that of mineral oil."""
    s, t, base = GOLD.get(kind, GOLD["mineral"])
    density = f"{DENSITY.get(kind, DENSITY['mineral'])} kg/m^3"
    return {
        "density": (_point("15 degC", density, f"typical of {base}, an estimate"),),
        "pressure_viscosity": {
            "law": "gold",
            "s": s,
            "t": t,
            "source": f"Gold et al. 2001, {base}, second hand; not measured on this oil",
        },
    }


def short_oil_told(table: object) -> tuple[str, str] | None:
    """What a short table of an oil stands for, and where that comes from; None of others."""
    if not isinstance(table, Mapping) or not _is_short(table):
        return None
    preset = _builtin_oil(table)
    if preset is not None and "viscosity_100" not in table:
        return preset, "the built-in oil of this grade and kind ('epicyclic oils' shows it)."
    told = []
    if "density" not in table and "density_15" not in table:
        told.append(f"density {DENSITY[table['kind']]} kg/m^3 at 15 degC, an estimate")
    if "pressure_viscosity" not in table:
        told.append(
            "pressure-viscosity coefficient from Gold's constants for "
            f"{GOLD[table['kind']][2]}, not measured on this oil"
        )
    return f"an oil of the kind {table['kind']}", f"{'; '.join(told) or 'all stated'}."


class Table(BaseModel):
    """Base of all tables: immutable, no unknown keys.

    ``EXACTLY_ONE`` lists groups of alternatives of which a file gives exactly one; an alternative
    of several keys, joined by ``+``, needs all of them. Of the groups in ``AT_MOST_ONE`` a file may
    give none.

    ``STAND_INS`` are keys on which no check across tables depends. If such a key cannot be used,
    the checks go on with the value given here (None: with the default).
    """

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        validate_default=True,
        allow_inf_nan=False,
        defer_build=True,  # a case of one kind builds no tables of the others
    )
    EXACTLY_ONE: ClassVar[tuple[tuple[str, ...], ...]] = ()
    AT_MOST_ONE: ClassVar[tuple[tuple[str, ...], ...]] = ()
    STAND_INS: ClassVar[dict[str, object]] = {}

    def __repr_args__(self) -> Iterable[tuple[str, Any]]:
        """Keys with their values as a file has them, with units."""
        return to_inputs(self).items()

    def __dir__(self) -> list[str]:
        """Keys, and what this package adds to them: not what Pydantic does."""
        own = {name for name in super().__dir__() if not name.startswith("_") and name.islower()}
        return sorted(own - set(dir(BaseModel)) | set(type(self).model_fields))


class PointsTable(Table):
    """Base of tables with values over some of the ``AXES``."""

    AXES: ClassVar[tuple[str, ...]]

    def axes(self) -> dict[str, tuple[float, ...]]:
        """The axes given, by name."""
        given = {name: getattr(self, name) for name in self.AXES}
        return {name: points for name, points in given.items() if points is not None}


class Condition(NamedTuple):
    """What a table, or several, must not state: a row of a list of checks."""

    key: str  # The keys that it is about, whole, joined by ``", "``.
    broken: Callable[..., bool]  # Whether the tables break it.
    allowed: str
    remedy: str


def broken_conditions(conditions: Iterable[Condition], *tables: Table) -> list[Problem]:
    """The problems of the conditions that `tables` break."""
    return [
        Problem(one.key, "", one.allowed, one.remedy) for one in conditions if one.broken(*tables)
    ]


def _values_or_rows(value: object) -> str:
    """Which of its two forms a list of numbers has."""
    rows = isinstance(value, list | tuple) and any(isinstance(row, list | tuple) for row in value)
    return "rows" if rows else "values"


VALUES_OR_ROWS = Discriminator(_values_or_rows)


def _no_preset(noun: str, name: str, known: Iterable[str], allowed: str) -> PydanticCustomError:
    nearest = did_you_mean(name, known)
    return PydanticCustomError(
        "preset",
        "no such {noun}; it must be {allowed}",
        {"noun": noun, "allowed": allowed, "remedy": nearest or "Check the name"},
    )


_PARAMETER = re.compile(r"\s*(R[aqz])\b\s*(.*)")


class _Roughness(Quantity):
    """A length, also with its parameter, ``"Ra 0.4 um"``, or the name of a built-in finish."""

    def parse(self, value: object) -> float:
        finishes = library.finishes()
        named = _PARAMETER.fullmatch(value) if isinstance(value, str) else None
        if named is not None:
            found = rq_of(named[1], super().parse(named[2]))
            self._check_range(self.to_display(found))
            return found
        if isinstance(value, str) and value in finishes:
            value = finishes[value]["roughness"]
        elif isinstance(value, str) and value[:1].isalpha():
            raise _no_preset("finish", value, finishes, self.describe())
        return super().parse(value)

    def describe(self) -> str:
        finishes = ", ".join(library.finishes())
        return f"{super().describe()}, also as Ra or Rz, or one of the finishes {finishes}"

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        length = super().__get_pydantic_json_schema__(schema, handler)
        stated = {"type": "string", "pattern": r"^\s*R[aqz]\b"}
        return {"anyOf": [length, {"enum": list(library.finishes())}, stated]}


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
    named = _PARAMETER.fullmatch(text)
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

ShortLength = Annotated[float, Quantity("a length", "m", "mm", low=0.0, high=1e5)]


class Material(Table):
    """Elastic and thermal constants of a solid."""

    title: str = "material of the case"
    elastic_modulus: Modulus
    poisson_ratio: Number = Field(default=0.3, ge=0.0, le=0.5)
    density: Density = Field(default=as_stated("7850 kg/m^3"))
    thermal_conductivity: Conductivity = Field(default=as_stated("46 W/(m*K)"))
    heat_capacity: HeatCapacity = Field(default=as_stated("460 J/(kg*K)"))
    source: str = ""


@cache
def _material(name: str) -> Material:
    return Material.model_validate(library.materials()[name])


@cache
def _oil(name: str) -> Oil:
    return Oil.model_validate(library.oil_table(name))


_MATERIALS = Named(
    lambda: tuple(library.materials()),
    lambda: f"a table of properties or one of {', '.join(library.materials())}",
)
_OILS = Named(
    library.oil_names,
    lambda: "a table of properties or a name of the oil library (epicyclic oils)",
    ShortOil,
)


def _named_material(value: object) -> object:
    """The built-in material if `value` is a name; anything else goes on to be checked."""
    if not isinstance(value, str):
        return value
    if value not in _MATERIALS.names():
        raise _no_preset("material", value, _MATERIALS.names(), _MATERIALS.allowed())
    return _material(value)


def _named_oil(value: object) -> object:
    """The built-in oil if `value` is a name; the whole oil of a short table; else as it is."""
    if isinstance(value, dict):
        return whole_oil(value)
    if not isinstance(value, str):
        return value
    if value not in _OILS.names():
        raise _no_preset("oil", value, _OILS.names(), _OILS.allowed())
    return _oil(value)


NamedMaterial = Annotated[Material, BeforeValidator(_named_material), _MATERIALS]
NamedOil = Annotated[Oil, BeforeValidator(_named_oil), _OILS]
