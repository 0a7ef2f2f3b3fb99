"""The file of a design task: what is asked for, what may be chosen, what must hold."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from epicyclic.case.case import FILE_KEYS
from epicyclic.case.gear_tables import PressureAngle
from epicyclic.case.tables.base import ShortLength
from epicyclic.errors import Problem, one_problem, raise_any
from epicyclic.schema.fields import Table, option
from epicyclic.schema.read import plain, read_file
from epicyclic.schema.validation import validate
from epicyclic.units import (
    HelixAngle,
    Length,
    Mass,
    Number,
    Quantity,
    RotationalSpeed,
    Temperature,
    Torque,
)

Arrangement = Literal["pair", "planetary", "stepped", "wolfrom", "two-stage"]
Objective = Literal["loss", "mass", "diameter", "width", "transmission_error"]
Share = Annotated[Number, Field(gt=0, le=1)]
Planets = Annotated[int, Field(ge=1, le=30)]
Shift = Annotated[Number, Field(ge=-2, le=2)]
WidthRatio = Annotated[Number, Field(gt=0, le=10)]
Play = Annotated[float, Quantity("an angle", "rad", "deg", low=0.0, high=30.0, open_low=True)]


class DutyPoint(Table):
    """One operating point of the cycle, of the input."""

    torque: Torque
    speed: RotationalSpeed
    oil_inlet_temperature: Temperature
    share: Share = option("Of the time; shares are taken relative to their sum.", 1.0)


class Choices(Table):
    """What the search may choose; every combination is a candidate."""

    arrangements: tuple[Arrangement, ...] = option(None, ("planetary",), min_length=1)
    module: tuple[Length, ...] = Field(description="Normal modules.", min_length=1)
    helix_angle: tuple[HelixAngle, ...] = option(None, ("0 deg",), min_length=1)
    pressure_angle: PressureAngle = option("alpha_n.", "20 deg")
    pinion_teeth: tuple[int, int] = option("Fewest and most, of the pinion or the sun.", (17, 35))
    planets: tuple[Planets, ...] = option("Numbers of planets.", (3,), min_length=1)
    profile_shift: tuple[Shift, ...] = option(
        "x of the pinion or the sun.", (0.0, 0.3), min_length=1
    )
    distance_shift: tuple[Shift, ...] = option(
        "Centre distance beyond that of gears without shift, in modules.", (0.0,), min_length=1
    )
    width_ratio: tuple[WidthRatio, ...] = option(
        "Face width over reference diameter of pinion or sun.", (0.8,), min_length=1
    )
    step: int = option("Most teeth between both steps of the planet of a Wolfrom set.", 6, ge=1)
    backlash: ShortLength = option("j_bn of every mesh.", "60 um")
    roughness: str = option("Of all flanks, as in a case.", "Ra 0.4 um")
    pocketing: bool = option(
        "Compute the loss of oil and air in the pockets, which takes long.", False
    )
    bearings: bool = option(
        "Planets run on cylindrical rollers in a bore of half their root.", True
    )


class Limits(Table):
    """What every design must meet; keys left out are no limit."""

    ratio_error: Number = option("Relative.", 0.03, ge=0, le=0.5)
    diameter: Length | None = option("Of the gears, outside.")
    width: Length | None = option("Of all face widths side by side.")
    mass: Mass | None = option("Of all gears, as discs.")
    backlash: Play | None = option("Of all meshes, as play of the output with the input held.")
    contact_ratio: Number = option("Least epsilon_alpha + epsilon_beta.", 1.1, ge=1, le=10)
    tip_thickness: Number = option("Least, in normal modules.", 0.2, ge=0, le=1)
    pitting: Number | None = option("Least S_H.", 1.0, ge=0)
    bending: Number | None = option("Least S_F.", 1.4, ge=0)
    micropitting: Number | None = option("Least S_lambda.", None, ge=0)
    scuffing: Number | None = option("Least S_B.", None, ge=0)
    bearing_life: Annotated[float, Quantity("a time", "s", "h", low=0.0, high=1e7)] | None = option(
        "Least L10m of planet bearings."
    )


class Search(Table):
    """How far the search goes."""

    objectives: tuple[Objective, ...] = option("All to be small.", ("loss", "mass"), min_length=1)
    solved: int = option("Most designs that are solved with all physics.", 60, ge=1, le=100_000)
    batch: int = option("Solved before the search looks again.", 16, ge=1, le=1000)
    polished: int = option("Designs whose profile shift is polished.", 1, ge=0, le=50)
    chosen: int = option("Designs that are written as cases.", 3, ge=1, le=50)
    most_candidates: int = option("Drawn at random from more.", 100_000, ge=1, le=2_000_000)
    seed: int = option("Of all that is drawn.", 1, ge=0)


class Task(Table):
    """A whole task."""

    SHOWN_BY: ClassVar[str] = "'epicyclic design --help'"

    title: str = ""
    ratio: Number = Field(gt=1, le=1000, description="Speed of the input over that of the output.")
    operation: DutyPoint = Field(description="Where the safety factors hold.")
    cycle: tuple[DutyPoint, ...] = option("Where the loss is averaged. Default: operation.", ())
    choices: Choices
    limits: Limits = Limits()
    search: Search = Search()
    case: Any = option("Tables of every case: lubricant, strength, models, numerics.", {})

    @property
    def points(self) -> tuple[DutyPoint, ...]:
        """The cycle, or the operating point alone."""
        return self.cycle or (self.operation,)


OF_CASES = ("lubricant", "strength", "models", "numerics", "surroundings", "thermal", "lubrication")


def read_task(source: str | Path | Mapping[str, Any]) -> Task:
    """A task from a TOML file or its tables; `InputError` with every problem."""
    problems: list[Problem] = []
    if isinstance(source, Mapping):
        raw, name = plain(source), "the given tables"
    else:
        name = str(source)
        raw, problems = task_tables(Path(source))
    found = validate(Task, raw)
    raise_any([*problems, *found.problems], name)
    task = found.case
    if task is None:
        raise one_problem("TASK", name, "is not a task.", "See the page on design.")
    raise_any(_problems(task), name)
    return task


def task_tables(path: Path) -> tuple[dict[str, Any], list[Problem]]:
    """The tables of a task's file, with the places of the files that they name; and problems."""
    raw, problems = read_file(path, f"{Task.SHOWN_BY} shows one.")
    if "case" in raw:
        raw["case"] = _found_from(path.absolute().parent, raw["case"])
    return raw, problems


def _found_from(folder: Path, value: Any, key: str = "") -> Any:
    """Tables with files in a folder by their whole path: designs are written elsewhere."""
    if isinstance(value, Mapping):
        return {name: _found_from(folder, own, name) for name, own in value.items()}
    if isinstance(value, list):
        return [_found_from(folder, own, key) for own in value]
    return str(folder / value) if key in FILE_KEYS and isinstance(value, str) else value


def _problems(task: Task) -> Iterator[Problem]:
    """Contradictions between tables."""
    low, high = task.choices.pinion_teeth
    if not 5 <= low <= high:
        allowed = "must be two numbers of teeth, 5 or more, the smaller one first."
        yield Problem("choices.pinion_teeth", f"{low}, {high}", allowed, "Give [17, 35].")
    tables = task.case if isinstance(task.case, dict) else {}
    for key in tables.keys() - set(OF_CASES):
        allowed = f"is no table that designs share; these are {', '.join(OF_CASES)}."
        yield Problem(f"case.{key}", "", allowed, "Leave it out.")
    if "lubricant" not in tables:
        yield Problem("case.lubricant", "", "is missing.", 'Add [case.lubricant] oil = "...".')
    if task.cycle and not any(point.torque * point.speed for point in task.cycle):
        yield Problem("cycle", "", "has no torque at a speed.", "Give points with both.")
    for key, values in task.choices:
        if key != "pinion_teeth" and isinstance(values, tuple) and len({*values}) < len(values):
            told = "has the same value twice."
            yield Problem(f"choices.{key}", "", told, "Give each value once.")
    if task.operation.torque <= 0 or task.operation.speed <= 0:
        allowed = "must have a positive torque and speed."
        yield Problem("operation", "", allowed, "Give the point of the largest load.")
