"""The tables of a line contact, and how it is built from them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from epicyclic.case.oil_laws import (
    HEATING,
    PRESET,
    USUAL,
    HeatingModel,
    LoadPressure,
    OilBehaviour,
    PresetName,
    behaviour_of,
    film_text,
    law_problems,
    oil_laws,
)
from epicyclic.case.plain import plain, value_at, with_value
from epicyclic.case.reading import read_file
from epicyclic.case.schema import NamedMaterial, NamedOil, Roughness, Table
from epicyclic.case.validation import validate
from epicyclic.case.wording import key_parts
from epicyclic.ehl.assumptions import DEFAULT, PRESETS
from epicyclic.ehl.conditions import LineContact, contact_oil
from epicyclic.ehl.heating import Heating, heating_of
from epicyclic.ehl.profile_file import read_profile
from epicyclic.ehl.rough import MOST_BLOCKS, NODES, STATIONARY, AsperityContact
from epicyclic.ehl.roughness import PERIOD, SMOOTH, Profile, generate_profile
from epicyclic.errors import InputError, Problem
from epicyclic.kernels.line_contact import line_load_at_pressure
from epicyclic.lubricant.oil import Conductivity, HeatCapacity
from epicyclic.lubricant.properties import OilState, oil_state
from epicyclic.units import Length, Number, Quantity, SmallLength, Temperature, as_stated

LineLoad = Annotated[
    float, Quantity("a line load", "N/m", "N/mm", low=0.0, high=1e5, open_low=True)
]
RollingSpeed = Annotated[float, Quantity("a speed", "m/s", "m/s", low=0.0, high=1e4, open_low=True)]
SURFACES = ("surface1", "surface2")
OF_GENERATED: tuple[str, ...] = ("correlation_length", "skewness", "kurtosis", "seed")
OF_MEASURED: tuple[str, ...] = ("cutoff", "short_cutoff")
"""Keys of a surface that are for profiles of either kind."""


class Contact(Table):
    """Load, geometry and motion."""

    EXACTLY_ONE = (("line_load", "hertz_pressure"),)

    radius: Length = Field(description="Equivalent radius of curvature.")
    line_load: LineLoad | None = Field(default=None, description="Normal load per length.")
    hertz_pressure: LoadPressure | None = Field(
        default=None, description="Instead of line_load: the pressure of Hertz it causes."
    )
    rolling_speed: RollingSpeed = Field(description="Mean of both surface speeds.")
    slide_to_roll_ratio: Number = Field(
        default=0.0, ge=0.0, le=2.0, description="Difference of the surface speeds over their mean."
    )


class ContactLubricant(OilBehaviour):
    """The oil in the contact."""

    oil: NamedOil = Field(
        description="A name of the oil library (epicyclic oils) or a table of properties."
    )
    temperature: Temperature = Field(description="Of the oil at the inlet.")


class Surface(Table):
    """A surface: its material and its roughness, generated or measured."""

    material: NamedMaterial = Field(
        default=as_stated("steel"), description="A name or a table of elastic constants."
    )
    roughness: Roughness | None = Field(
        default=None, description="Rq; a measured profile is scaled to it. Smooth by default."
    )
    correlation_length: SmallLength = Field(
        default=as_stated("20 um"), description="Where the autocorrelation has fallen to 1/e."
    )
    skewness: Number = Field(default=0.0, ge=-5.0, le=5.0, description="Rsk.")
    kurtosis: Number = Field(default=3.0, ge=1.0, le=50.0, description="Rku.")
    seed: int = Field(default=1, ge=0, description="Of the generated profile.")
    profile: str | None = Field(
        default=None,
        description="A measured one instead: X3P, or CSV of position in mm and height in um.",
    )
    cutoff: Length | None = Field(
        default=None, description="Of a measured profile: longer waves are taken off."
    )
    short_cutoff: Length | None = Field(
        default=None, description="Of a measured profile: shorter waves are taken off."
    )


class SecondSurface(Surface):
    """The other surface: a profile of its own."""

    seed: int = Field(default=2, ge=0, description="Of the generated profile.")


class Asperities(Table):
    """Where the film vanishes."""

    film: SmallLength = Field(
        default=as_stated(film_text(USUAL)),
        description="Film below which surfaces touch (estimate).",
    )
    friction: Number = Field(
        default=USUAL.friction, ge=0.0, le=1.0, description="Friction where they touch (estimate)."
    )


class ContactHeating(Table):
    """Heat of sliding."""

    model: HeatingModel = Field(default="isothermal", description=HEATING)
    solid_conductivity: Conductivity | None = Field(
        default=None, description="Of both solids. Default: that of the material of each."
    )
    solid_heat_capacity: HeatCapacity | None = Field(
        default=None, description="Of both solids. Default: that of the material of each."
    )


class ContactNumerics(Table):
    """The grid."""

    nodes: int = Field(default=NODES, ge=128, le=4096, description="In the rough contact.")
    most_blocks: int = Field(
        default=MOST_BLOCKS, ge=4, le=100_000,
        description="Times half-width over rolling speed after which a rough contact is given up.",
    )  # fmt: skip
    friction_tolerance: Number = Field(
        default=STATIONARY, ge=1e-3, le=0.5,
        description="Standard error over the mean friction at which a rough contact is solved.",
    )  # fmt: skip
    frozen_roughness: bool = Field(
        default=False, description="Hold the roughness still: the steady rough contact."
    )


class ContactCase(Table):
    """One line contact."""

    kind: Literal["line_contact"] = "line_contact"
    title: str = ""
    preset: PresetName = Field(default=DEFAULT, description=PRESET)
    contact: Contact
    lubricant: ContactLubricant
    surface1: Surface = Surface()
    surface2: SecondSurface = SecondSurface()
    asperities: Asperities = Asperities()
    heating: ContactHeating = ContactHeating()
    numerics: ContactNumerics = ContactNumerics()

    @model_validator(mode="before")
    @classmethod
    def _assume(cls, tables: Any) -> Any:
        """Fill in what the preset says of keys that are not given."""
        preset = value_at(tables, ("preset",))
        if preset not in PRESETS:
            return tables
        touching = {"film": film_text(PRESETS[preset]), "friction": PRESETS[preset].friction}
        for name, keys in (("lubricant", behaviour_of(preset)), ("asperities", touching)):
            given = tables.get(name, {})
            if isinstance(given, Mapping):
                tables = {**tables, name: {**keys, **given}}
        return tables


@dataclass(frozen=True, eq=False)
class ContactModel:
    """What the solver needs of a case."""

    contact: LineContact
    surfaces: tuple[Profile, Profile]
    asperities: AsperityContact
    heating: Heating | None = None

    @property
    def smooth(self) -> bool:
        """Neither surface has a roughness."""
        return self.composite_roughness == 0

    @property
    def composite_roughness(self) -> float:
        """Rq of both surfaces together. [m]"""
        return math.hypot(*(surface.rms for surface in self.surfaces))


def load_contact_case(
    source: str | Path | Mapping[str, Any],  # A TOML file, with profiles beside it, or its tables.
    changes: Mapping[str, Any] | None = None,  # Dotted keys to values as a file has them.
) -> ContactCase:
    """Read and check a line contact.

    Raises
    ------
    InputError
        With every problem found.
    """
    problems: Sequence[Problem] = ()
    if isinstance(source, Mapping):
        name, tables = "the command", plain(source)
    else:
        name = str(source)
        tables, problems = read_file(Path(source))
        tables = _beside(tables, Path(source).parent)
    tables = {"contact": {}, "lubricant": {}} | tables  # so that what they lack is told
    for key, value in (changes or {}).items():
        tables = with_value(tables, key_parts(key), plain(value))
    checked = validate(ContactCase, tables)
    found = [*problems, *checked.problems, *_cross_check(checked.sections)]
    if checked.case is None or found:
        raise InputError(found, name)
    return checked.case


def _beside(tables: dict[str, Any], folder: Path) -> dict[str, Any]:
    """`tables` with profiles that are named as seen from `folder`."""
    for name in SURFACES:
        profile = value_at(tables, (name, "profile"))
        if isinstance(profile, str):
            tables = with_value(tables, (name, "profile"), str(folder / profile))
    return tables


def _cross_check(sections: Mapping[str, Table]) -> list[Problem]:
    """What is wrong across keys."""
    problems = []
    lubricant = sections.get("lubricant")
    if isinstance(lubricant, ContactLubricant):
        problems += law_problems("lubricant", lubricant)
    for name in SURFACES:
        surface = sections.get(name)
        if isinstance(surface, Surface):
            problems += _check_surface(name, surface)
    return problems


def _check_surface(name: str, surface: Surface) -> list[Problem]:
    """A measured profile must be sound, a generated one possible, and nothing be without effect."""
    if surface.profile is not None:
        idle, allowed = OF_GENERATED, "is for a generated profile, not for a measured one."
    elif surface.roughness is not None:
        idle, allowed = OF_MEASURED, "is for a measured profile."
    else:
        idle, allowed = (*OF_GENERATED, *OF_MEASURED), "has no effect on a smooth surface."
    remedy = "Give profile or roughness to suit, or leave it out."
    usual = type(surface)()
    problems = [
        Problem(f"{name}.{key}", "", allowed, remedy)
        for key in idle
        if getattr(surface, key) != getattr(usual, key)
    ]
    if problems:
        return problems
    try:
        _profile(surface)
    except InputError as error:
        return [replace(problem, key=f"{name}.{problem.key}") for problem in error.problems]
    return []


def contact_model(case: ContactCase) -> ContactModel:
    """Contact, profiles and asperities of a case."""
    modulus = case.surface1.material.modulus_against(case.surface2.material)
    table = case.contact
    load = table.line_load
    if load is None:
        assert table.hertz_pressure is not None
        load = line_load_at_pressure(table.hertz_pressure, table.radius, modulus)
    slip = table.slide_to_roll_ratio / 2
    contact = LineContact(
        line_load=load,
        radius=table.radius,
        equivalent_modulus=modulus,
        speed1=table.rolling_speed * (1 + slip),
        speed2=table.rolling_speed * (1 - slip),
        oil=contact_oil(_oil_state(case), oil_laws(case.lubricant)),
    )
    surfaces = (_profile(case.surface1), _profile(case.surface2))
    asperities = AsperityContact(case.asperities.film, case.asperities.friction)
    return ContactModel(contact, surfaces, asperities, _heating(case))


def _oil_state(case: ContactCase) -> OilState:
    return oil_state(case.lubricant.oil, case.lubricant.temperature)


def _heating(case: ContactCase) -> Heating | None:
    table = case.heating
    if table.model == "isothermal":
        return None
    solids = (
        surface.material.solid_with(table.solid_conductivity, table.solid_heat_capacity)
        for surface in (case.surface1, case.surface2)
    )
    return heating_of(_oil_state(case), *(solid.effusivity for solid in solids))


def _profile(table: Surface) -> Profile:
    """The profile of a surface; problems have its keys."""
    if table.profile is not None:
        measured = read_profile(Path(table.profile), table.cutoff, table.short_cutoff)
        return measured if table.roughness is None else measured.scaled_to(table.roughness)
    if table.roughness is None:
        return SMOOTH
    return generate_profile(
        table.roughness, table.correlation_length, PERIOD * table.correlation_length,
        table.seed, table.skewness, table.kurtosis,
    )  # fmt: skip
