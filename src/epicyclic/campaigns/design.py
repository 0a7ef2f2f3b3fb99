"""Which contacts are simulated: the tables of Talbot (2012), or points that fill their ranges."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from epicyclic.case.contact import ContactCase
from epicyclic.case.fields import find_field, quantity_of
from epicyclic.case.nearest import did_you_mean
from epicyclic.ehl.box import SOLVER_BOX
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.units import MICROMETRE, NUMBER, Quantity, format_number

AXES = {
    "temperature": "lubricant.temperature",
    "radius": "contact.radius",
    "roughness1": "surface1.roughness",
    "roughness2": "surface2.roughness",
    "hertz_pressure": "contact.hertz_pressure",
    "rolling_speed": "contact.rolling_speed",
    "slide_to_roll_ratio": "contact.slide_to_roll_ratio",
}
"""What a design varies, and the keys of a line contact that hold it."""
LOGARITHMIC = ("radius", "roughness1", "roughness2", "rolling_speed", "slide_to_roll_ratio")
"""Axes that are filled evenly in the logarithm."""

_RANGE = re.compile(
    r"\s*(?P<name>(bearing\.)?\w+)\s*=\s*(?P<low>[^:\s]+)\s*:\s*(?P<high>[^:\s]+)\s*(?P<unit>.*)"
)

Axis = tuple[str, tuple[float, ...]]


@dataclass(frozen=True)
class Design:
    """Points of a campaign."""

    part: str  # ``"gear"`` or ``"bearing"``: what the contacts are those of.
    # Name and values of each axis, in display units: the levels of a full product, or of a space-
    # filling design the first and the last one as limits.
    axes: tuple[Axis, ...]
    # Number of points of a space-filling design; None for the full product.
    size: int | None = None
    seed: int = 0  # Seed of the scrambling of a space-filling design.

    @property
    def count(self) -> int:
        """Number of points."""
        return math.prod(len(values) for _, values in self.axes) if self.size is None else self.size

    def point(self, index: int) -> dict[str, float]:
        """The values of point number `index`, in display units."""
        names = [name for name, _ in self.axes]
        return dict(zip(names, map(float, _points(self)[index]), strict=True))

    def filling(self, size: int, seed: int) -> Design:
        """`size` points that fill the ranges of the axes: a scrambled Sobol sequence."""
        return replace(self, size=size, seed=seed)

    def within(self, ranges: Mapping[str, tuple[float, float]]) -> Design:
        """The design with other limits of some axes, in display units."""
        axes = tuple((name, ranges.get(name, values)) for name, values in self.axes)
        return replace(self, axes=axes)

    def describe(self) -> dict[str, Any]:
        """As plain data, for files."""
        return {
            "part": self.part,
            "axes": {name: list(values) for name, values in self.axes},
            "size": self.size,
            "seed": self.seed,
        }

    def check(self) -> None:
        """Raise `InputError` for every axis that leaves what the solver is tested for."""
        problems = []
        for name, values in self.axes:
            quantity = quantity_of_axis(name)
            scale, offset = quantity.scale_and_offset()
            box = SOLVER_BOX.get(name, (-math.inf, math.inf))
            low, high = (limit * scale + offset for limit in box)
            if self.size is not None and name in LOGARITHMIC and min(values) <= 0:
                allowed = "must be above zero: it is filled evenly in the logarithm."
                lowest = format_number(min(values))
                problems.append(Problem(f"{self.part}.{name}", lowest, allowed, "Raise it."))
            slack = 1e-9 * max(abs(value) for value in values)
            if min(values) < low - slack or max(values) > high + slack:
                unit = f" {quantity.display}".rstrip()
                problems.append(
                    Problem(
                        f"{self.part}.{name}",
                        f"{format_number(min(values))} to {format_number(max(values))}{unit}",
                        f"leaves what the solver is tested for, {format_number(low)} to "
                        f"{format_number(high)}{unit}.",
                        "Give a smaller range.",
                    )
                )
        problems += self._check_roughness()
        raise_any(problems, "the design")

    def _check_roughness(self) -> Iterator[Problem]:
        """Both surfaces together must not be rougher than the solver is tested for."""
        names = ("roughness1", "roughness2")
        highest = math.hypot(*(max(values) for name, values in self.axes if name in names))
        limit = MICROMETRE.to_display(SOLVER_BOX["composite_roughness"][1])
        if highest > limit:
            yield Problem(
                f"{self.part}.roughness1, roughness2", f"up to {highest:.3g} um together",
                f"leaves what the solver is tested for, {limit:g} um.", "Give smaller ranges.",
            )  # fmt: skip


def quantity_of_axis(name: str) -> Quantity:
    """Unit and range of an axis.

    Raises
    ------
    InputError
        If there is no such axis.
    """
    if name not in AXES:
        remedy = did_you_mean(name, list(AXES)) or f"Axes are {', '.join(AXES)}."
        raise InputError([Problem("--range", name, "is no axis of a design.", remedy)])
    field = find_field(ContactCase, AXES[name])
    assert field is not None
    return quantity_of(*field) or NUMBER


def parse_ranges(options: Iterable[str]) -> dict[str, tuple[float, float]]:
    """Limits of axes from ``NAME=LOW:HIGH UNIT``, in display units.

    Raises
    ------
    InputError
        For every range that cannot be read.
    """
    ranges, problems = {}, []
    for option in options:
        match = _RANGE.fullmatch(option)
        if match is None:
            allowed = "must be NAME=LOW:HIGH with a unit."
            remedy = 'For example "hertz_pressure=0.3:1.5 GPa".'
            problems.append(Problem("--range", f'"{option}"', allowed, remedy))
            continue
        name, unit = match["name"], match["unit"]
        try:
            quantity = quantity_of_axis(name.removeprefix("bearing."))
            low, high = (
                quantity.to_display(quantity.parse(f"{match[end]} {unit}"))
                if quantity.display
                else float(match[end])
                for end in ("low", "high")
            )
        except InputError as error:
            problems += error.problems
            continue
        except (PydanticCustomError, ValueError) as error:
            problems.append(Problem(f"--range {name}", f'"{option}"', f"{error}.", "Change it."))
            continue
        if not low < high:
            problems.append(Problem(f"--range {name}", f'"{option}"', "must rise.", "Swap them."))
        ranges[name] = (low, high)
    raise_any(problems, "the command")
    return ranges


@lru_cache(maxsize=8)
def _points(design: Design) -> NDArray[np.float64]:
    """All points, shape (count, axes)."""
    if design.size is None:
        grids = np.meshgrid(*(values for _, values in design.axes), indexing="ij")
        return np.stack([grid.ravel() for grid in grids], axis=1)
    from scipy.stats import qmc

    sequence = qmc.Sobol(len(design.axes), scramble=True, seed=design.seed)
    unit = sequence.random_base2(max(0, math.ceil(math.log2(design.size))))[: design.size]
    columns = []
    for (name, values), share in zip(design.axes, unit.T, strict=True):
        low, high = min(values), max(values)
        if name in LOGARITHMIC:
            columns.append(low * (high / low) ** share)
        else:
            columns.append(low + (high - low) * share)
    return np.stack(columns, axis=1)


GEAR_TABLE = Design(
    "gear",
    (
        ("temperature", (25.0, 50.0, 75.0, 100.0)),
        ("radius", (5.0, 20.0, 40.0)),
        ("roughness1", (0.1, 0.3, 0.5, 0.7)),
        ("roughness2", (0.1, 0.3, 0.5, 0.7)),
        ("hertz_pressure", (0.5, 1.0, 1.5, 2.0, 2.5)),
        ("rolling_speed", (1.0, 5.0, 10.0, 15.0, 20.0)),
        ("slide_to_roll_ratio", (0.025, 0.05, 0.10, 0.25, 0.50, 0.75, 1.00)),
    ),
)
"""33,600 contacts of gear teeth. Talbot (2012), Table 5.1."""
BEARING_TABLE = Design(
    "bearing",
    (
        ("temperature", (25.0, 50.0, 75.0, 100.0)),
        ("radius", (0.5, 1.0, 2.0, 4.0)),
        ("roughness1", (0.02, 0.06, 0.10)),
        ("roughness2", (0.055, 0.11, 0.165)),
        ("hertz_pressure", (0.25, 1.0, 2.0, 3.0)),
        ("rolling_speed", (1.0, 5.0, 10.0, 15.0, 20.0)),
    ),
)
"""2,880 contacts of rollers with races in pure rolling. Talbot (2012), Table 3.1."""
