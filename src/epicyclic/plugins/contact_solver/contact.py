"""One line contact: its tables, its solution, its figures, and the limits to know."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.build.models import contact_modulus, solid_of
from epicyclic.case.tables.base import NamedMaterial, NamedOil, Roughness
from epicyclic.case.tables.models import (
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
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import InputError, Problem, Status
from epicyclic.kernels.line_contact import line_load_at_pressure
from epicyclic.losses.ranges import ModelUse, Range, ValidityFlag, check_ranges, range_left
from epicyclic.machine.element import oil_flags
from epicyclic.messages import key_parts, value_at
from epicyclic.oil.oil import Conductivity, HeatCapacity, OilState, oil_state
from epicyclic.oil.rheology import DEFAULT, PRESETS
from epicyclic.plugins.contact_solver.conditions import (
    DRY_SPEED,
    FEWEST_KEPT,
    VALIDATED_FILM_RATIO,
    Heating,
    LineContact,
    contact_oil,
    heating_of,
)
from epicyclic.plugins.contact_solver.direct import EhlDirect, solver_range
from epicyclic.plugins.contact_solver.kernels_steady import shear_stresses
from epicyclic.plugins.contact_solver.rough import (
    MOST_BLOCKS,
    NODES,
    STATIONARY,
    AsperityContact,
    Frame,
    RoughSolution,
    solve_rough,
)
from epicyclic.plugins.contact_solver.steady import SmoothSolution, solve_smooth
from epicyclic.plugins.contact_solver.surfaces import (
    PERIOD,
    SMOOTH,
    Profile,
    generate_profile,
    read_profile,
)
from epicyclic.result.result import versions
from epicyclic.schema.fields import Table, option
from epicyclic.schema.read import plain, read_file, with_value
from epicyclic.schema.validation import validate
from epicyclic.units import (
    KELVIN,
    MICROMETRE,
    MILLIMETRE,
    NUMBER,
    Length,
    Number,
    Quantity,
    SmallLength,
    Temperature,
    format_number,
    percent,
)

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
    line_load: LineLoad | None = option("Normal load per length.")
    hertz_pressure: LoadPressure | None = option("Hertz pressure instead of line_load.")
    rolling_speed: RollingSpeed = Field(description="Mean of both surface speeds.")
    slide_to_roll_ratio: Number = option(
        "Difference of the surface speeds over their mean.", 0.0, ge=0.0, le=2.0
    )


class ContactLubricant(OilBehaviour):
    """The oil in the contact."""

    oil: NamedOil = Field(
        description="A name from the oil library (epicyclic oils) or a table of properties."
    )
    temperature: Temperature = Field(description="Oil temperature at the inlet.")


class Surface(Table):
    """A surface: its material and its roughness, generated or measured."""

    material: NamedMaterial = option("A name or a table of elastic constants.", "steel")
    roughness: Roughness | None = option(
        "Rq; a measured profile is scaled to it. Smooth by default."
    )
    correlation_length: SmallLength = option(
        "Distance at which the autocorrelation has fallen to 1/e.", "20 um"
    )
    skewness: Number = option("Rsk.", 0.0, ge=-5.0, le=5.0)
    kurtosis: Number = option("Rku.", 3.0, ge=1.0, le=50.0)
    seed: int = option("Of the generated profile.", 1, ge=0)
    profile: str | None = option(
        "A measured profile instead: X3P, or CSV with position in mm and height in um."
    )
    cutoff: Length | None = option("For a measured profile: longer waves are removed.")
    short_cutoff: Length | None = option("For a measured profile: shorter waves are removed.")


class SecondSurface(Surface):
    """The other surface: a profile of its own."""

    seed: int = option("Of the generated profile.", 2, ge=0)


class Asperities(Table):
    """Where the film vanishes."""

    film: SmallLength = option(
        "Film thickness below which surfaces touch (estimate).", film_text(USUAL)
    )
    friction: Number = option(
        "Coefficient of friction where they touch (estimate).", USUAL.friction, ge=0.0, le=1.0
    )


_OF_SOLIDS = "Of both solids. Default: that of the material of each."


class ContactHeating(Table):
    """Heat of sliding."""

    model: HeatingModel = option(HEATING, "isothermal")
    solid_conductivity: Conductivity | None = option(_OF_SOLIDS)
    solid_heat_capacity: HeatCapacity | None = option(_OF_SOLIDS)


class ContactNumerics(Table):
    """The grid."""

    nodes: int = option("In the rough contact.", NODES, ge=128, le=4096)
    most_blocks: int = option(
        "Multiples of half-width over rolling speed after which a rough contact is abandoned.",
        MOST_BLOCKS, ge=4, le=100_000,
    )  # fmt: skip
    friction_tolerance: Number = option(
        "Standard error over the mean friction at which a rough contact counts as solved.",
        STATIONARY, ge=1e-3, le=0.5,
    )  # fmt: skip
    frozen_roughness: bool = option("Keep the roughness at rest: the steady rough contact.", False)


class ContactCase(Table):
    """One line contact."""

    kind: Literal["line_contact"] = "line_contact"
    title: str = ""
    preset: PresetName = option(PRESET, DEFAULT)
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
    """Read and check a line contact; raises `InputError` with every problem found."""
    problems: Sequence[Problem] = ()
    if isinstance(source, Mapping):
        name, tables = "the command", plain(source)
    else:
        name = str(source)
        tables, problems = read_file(Path(source), "'epicyclic contact --help' names its tables.")
        tables = _beside(tables, Path(source).parent)
    tables = {"contact": {}, "lubricant": {}} | tables  # so that what they lack is told
    for key, value in (changes or {}).items():
        tables = with_value(tables, key_parts(key), plain(value))
    checked = validate(ContactCase, tables)
    found = [*problems, *checked.problems, *_contradictions(checked.sections)]
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


def _contradictions(sections: Mapping[str, Table]) -> Iterator[Problem]:
    """What is wrong across keys."""
    for name, table in sections.items():
        if isinstance(table, ContactLubricant):
            yield from law_problems(name, table)
        elif isinstance(table, Surface):
            yield from _check_surface(name, table)


def _check_surface(name: str, surface: Surface) -> list[Problem]:
    """A measured profile must be sound, a generated one possible, and nothing be without effect."""
    if surface.profile is not None:
        idle, allowed = OF_GENERATED, "applies to a generated profile, not to a measured one."
    elif surface.roughness is not None:
        idle, allowed = OF_MEASURED, "applies to a measured profile."
    else:
        idle, allowed = (*OF_GENERATED, *OF_MEASURED), "has no effect on a smooth surface."
    remedy = "Give a matching profile or roughness, or leave it out."
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
    modulus = contact_modulus(case.surface1.material, case.surface2.material)
    table = case.contact
    oil = oil_state(case.lubricant.oil, case.lubricant.temperature)
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
        oil=contact_oil(oil, oil_laws(case.lubricant)),
    )
    surfaces = (_profile(case.surface1), _profile(case.surface2))
    asperities = AsperityContact(case.asperities.film, case.asperities.friction)
    return ContactModel(contact, surfaces, asperities, _heating(case, oil))


def _heating(case: ContactCase, oil: OilState) -> Heating | None:
    table = case.heating
    if table.model == "isothermal":
        return None
    solids = (
        solid_of(surface.material, table.solid_conductivity, table.solid_heat_capacity)
        for surface in (case.surface1, case.surface2)
    )
    return heating_of(oil, *(solid.effusivity for solid in solids))


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


ROUGH_RANGES = (
    solver_range("film_ratio", "film ratio", NUMBER),
    solver_range("composite_roughness", "composite roughness", MICROMETRE),
)
HIGHEST_RISE = Range(
    "temperature_rise", "temperature rise", 0.0, 50.0, KELVIN, "linear thinning by heat"
)
"""Beyond it the estimate of heat thins the oil too much."""
FEWEST_POINTS = 16  # Points of a profile in the width of the contact, below which it is hardly one.


FRAMES = 60  # Moments kept for an animation.


@dataclass(frozen=True, slots=True)
class ContactFigure:
    """A number of a contact. `value` is SI, `unit` the SI unit, `display` the unit of tables."""

    name: str
    value: float
    unit: str
    display: str


@dataclass(frozen=True, eq=False)
class ContactResult:
    """Solution of a contact."""

    case: ContactCase
    model: ContactModel  # What the solver was given.
    smooth: SmoothSolution
    rough: RoughSolution | None  # None without roughness.

    @property
    def status(self) -> Status:
        """Status of the solution that counts."""
        return self.smooth.status if self.rough is None else self.rough.status

    @property
    def message(self) -> str:
        """Why it failed; empty if it did not."""
        return self.smooth.message if self.rough is None else self.rough.message

    @property
    def film_ratio(self) -> float:
        """Minimum film of the smooth contact over the composite Rq. [1]"""
        return self.smooth.minimum_film / self.model.composite_roughness

    @property
    def flags(self) -> tuple[ValidityFlag, ...]:
        """A flag for every quantity outside what solver and oil data are good for."""
        if self.smooth.status is not Status.CONVERGED:
            return ()
        contact, oil = self.model.contact, self.case.lubricant
        ranges = [*EhlDirect.ranges, HIGHEST_RISE]
        values = {
            "radius": contact.radius,
            "hertz_pressure": contact.hertz_pressure,
            "rolling_speed": contact.rolling_speed,
            "slide_to_roll_ratio": abs(contact.sliding_speed) / contact.rolling_speed,
            "temperature_rise": float(self.smooth.temperature_rise.max()),
        }
        if not self.model.smooth:
            ranges += ROUGH_RANGES
            values["film_ratio"] = self.film_ratio
            values["composite_roughness"] = self.model.composite_roughness
        use = ModelUse("solver", "line contact", "contact")
        return (*check_ranges(use, ranges, values), *oil_flags(oil.oil, oil.temperature))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to know before the figures are used."""
        if self.smooth.status is not Status.CONVERGED:
            return ()
        left = (range_left([flag]) for flag in self.flags)
        return (*left, *(() if self.rough is None else self._notes(self.rough)))

    def _notes(self, rough: RoughSolution) -> Iterator[str]:
        """What else limits a rough contact: standing roughness, thin films, unsuitable profiles."""
        if self.case.numerics.frozen_roughness:
            yield (
                "The roughness is at rest, so all results apply to one position of the profiles, "
                "whatever the standard error. The rolling loss has no meaning for moving surfaces."
            )
        speed = self.model.contact.rolling_speed
        if speed < DRY_SPEED:
            yield (
                f"At {format_number(speed, 2)} m/s, below {DRY_SPEED:g} m/s, oil leaks out of the "
                "valleys of real surfaces, but transverse ridges, as here, trap it. Load and "
                "friction of the touching surfaces are then too small to be used."
            )
        if self.film_ratio < VALIDATED_FILM_RATIO:
            yield (
                f"At a film ratio of {format_number(self.film_ratio, 2)}, below "
                f"{VALIDATED_FILM_RATIO:g}, friction, load on asperities and rolling loss are not "
                "validated. Vary asperities.film, asperities.friction and the correlation lengths."
            )
        spacing, width = float(rough.x[1] - rough.x[0]), 2 * self.model.contact.half_width
        for number, surface in enumerate(self.model.surfaces, 1):
            if surface.rms > 0:
                yield from _profile_notes(f"surface{number}", surface, spacing, width)

    @property
    def figures(self) -> list[ContactFigure]:
        """Everything a table shows; none if the smooth solution failed."""
        if self.smooth.status is not Status.CONVERGED:
            return []
        contact, smooth, rough = self.smooth.contact, self.smooth, self.rough
        found = [
            ("Hertz pressure", contact.hertz_pressure, "Pa", "GPa"),
            ("Hertz half-width", contact.half_width, "m", "mm"),
            ("line load", contact.line_load, "N/m", "N/mm"),
            ("sliding speed", contact.sliding_speed, "m/s", "m/s"),
            ("Moes load number", contact.moes_load, "1", "1"),
            ("Moes material number", contact.moes_material, "1", "1"),
            ("smooth: central film", smooth.central_film, "m", "um"),
            ("smooth: minimum film", smooth.minimum_film, "m", "um"),
            ("smooth: highest pressure", float(smooth.pressure.max()), "Pa", "GPa"),
            ("smooth: highest shear stress", float(smooth.shear_stress.max()), "Pa", "MPa"),
            ("smooth: friction coefficient", smooth.friction_coefficient, "1", "1"),
            ("smooth: rolling loss", smooth.rolling_loss, "W/m", "W/m"),
        ]
        rise = float(smooth.temperature_rise.max())
        if rise > 0:
            found.append(("smooth: highest temperature rise", rise, "K", "K"))
        if rough is not None:
            found += [
                ("film ratio", self.film_ratio, "1", "1"),
                ("friction coefficient", rough.friction_coefficient, "1", "1"),
                ("its standard error", rough.friction_error, "1", "1"),
                ("friction of asperities", rough.asperity_friction_share, "1", "%"),
                ("load on asperities", rough.asperity_load_share, "1", "%"),
                ("length in contact", rough.contact_share, "1", "%"),
                ("central film, mean in time", rough.mean_central_film, "m", "um"),
                ("least film, mean in time", rough.mean_least_film, "m", "um"),
                ("highest pressure, mean in time", rough.mean_highest_pressure, "Pa", "GPa"),
                ("rolling loss", rough.rolling_loss, "W/m", "W/m"),
                ("standard error of the rolling loss", rough.rolling_loss_error, "W/m", "W/m"),
            ]
        return [ContactFigure(*figure) for figure in found if math.isfinite(figure[1])]

    def shear_stress(self, frame: Frame) -> FloatArray:
        """At a moment of the rough contact, of film and touching asperities, shape (n,). [Pa]

        Theory (H23).
        """
        assert self.rough is not None
        contact, thinned = self.model.contact, self.rough.thinned
        scaled = frame.pressure / contact.hertz_pressure, frame.film / contact.film_scale
        fluid = shear_stresses(*scaled, thinned, contact.scaled_fluid()) * contact.hertz_pressure
        friction = self.model.asperities.friction if contact.sliding_speed else 0.0
        return np.where(self.touching(frame), friction * frame.pressure, fluid)

    def touching(self, frame: Frame) -> BoolArray:
        """Where surfaces touch at a moment of the rough contact, shape (n,). Theory (H23)."""
        touching: BoolArray = (frame.film < self.model.asperities.film) & (frame.pressure > 0)
        return touching

    def to_json(self) -> str:
        """Inputs, status, warnings; in SI units figures and all that varies over x."""
        data: dict[str, Any] = {
            "title": self.case.title,
            "versions": versions(),
            "inputs": plain(self.case),
            "status": str(self.status),
            "message": self.message,
            "warnings": self.warnings,
            "out_of_range": [flag.quantity for flag in self.flags],
            "figures": {
                figure.name: {"value": figure.value, "unit": figure.unit} for figure in self.figures
            },
            "surfaces": [_statistics(surface) for surface in self.model.surfaces],
        }
        smooth = self.smooth
        if smooth.status is Status.CONVERGED:
            names = ("x", "pressure", "film", "shear_stress", "temperature_rise")
            data["smooth"] = {"iterations": smooth.iterations}
            data["smooth"] |= {name: getattr(smooth, name).tolist() for name in names}
        if self.rough is not None:
            data["rough"] = self._rough_data(self.rough)
        return json.dumps(data, indent=2, allow_nan=False)

    def _rough_data(self, rough: RoughSolution) -> dict[str, Any]:
        data: dict[str, Any] = {
            "time_steps": rough.steps,
            "unsolved_time_steps": rough.unsolved_steps,
            "friction": [value if math.isfinite(value) else None for value in rough.friction],
        }
        if rough.frames and np.isfinite(rough.frames[-1].pressure).all():
            frame = rough.frames[-1]
            data["last_moment"] = {
                "time": frame.time,
                "x": rough.x.tolist(),
                "pressure": frame.pressure.tolist(),
                "film": frame.film.tolist(),
                "shear_stress": self.shear_stress(frame).tolist(),
            }
        return data


def _profile_notes(name: str, surface: Profile, spacing: float, width: float) -> Iterator[str]:
    """Whether nodes resolve a profile, and the profile fits a contact of some width. [m]"""
    wide, left = MILLIMETRE.text(width, 4), surface.kept(spacing)
    if left < FEWEST_KEPT:
        yield (
            f"The nodes, {MICROMETRE.text(spacing, 4)} apart, resolve {percent(left, 0)} of the Rq "
            f"of {name}; shorter waves are lost. Raise numerics.nodes."
        )
    if FEWEST_POINTS * surface.spacing > width:
        yield (
            f"The points of {name} are {MICROMETRE.text(surface.spacing, 4)} apart, in a contact "
            f"{wide} wide. A finer profile is needed, or its positions are not in mm."
        )
    if surface.length < width:
        yield (
            f"The profile of {name}, {MILLIMETRE.text(surface.length, 4)} long, repeats itself "
            f"within the contact, {wide} wide. Give a longer profile."
        )


def _statistics(surface: Profile) -> dict[str, float]:
    """Statistics of a profile, lengths in m."""
    names = ("rms", "correlation_length", "skewness", "kurtosis")
    return {name: getattr(surface, name) for name in names if surface.rms > 0 or name == "rms"}


def solve_contact(
    case: ContactCase, frames: bool = False, progress: Callable[[int, int], None] | None = None
) -> ContactResult:
    """Solve a contact, with `FRAMES` moments of a rough one over 6 half-widths if `frames`.

    `progress` is called with the numbers of blocks of a rough contact done and expected.
    """
    model = contact_model(case)
    contact = model.contact
    if model.smooth:
        return ContactResult(case, model, solve_smooth(contact, heating=model.heating), None)
    interval = 6 * contact.half_width / contact.rolling_speed / FRAMES if frames else None
    rough = solve_rough(
        contact, *model.surfaces, model.asperities, case.numerics.nodes, interval, model.heating,
        case.numerics.frozen_roughness, case.numerics.most_blocks,
        case.numerics.friction_tolerance, progress,
    )  # fmt: skip
    return ContactResult(case, model, rough.smooth, rough)
