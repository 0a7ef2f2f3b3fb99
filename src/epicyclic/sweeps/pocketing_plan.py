"""What the parametric study of pocketing losses varies. Talbot (2012), section 4.4."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from epicyclic.analysis.pocket_details import mesh_duties
from epicyclic.analysis.pocket_variants import (
    PocketVariant,
    base_variant,
    solve_variant,
    teeth_for_module,
)
from epicyclic.case.case import Case, build_case
from epicyclic.case.nearest import did_you_mean
from epicyclic.case.plain import plain
from epicyclic.case.wording import refused, written
from epicyclic.elements.gear_mesh import MeshDuty
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.pocketing.similarity import flow_figures
from epicyclic.status import Status
from epicyclic.sweeps.journal import Row
from epicyclic.sweeps.runner import Plan
from epicyclic.units import NUMBER, Quantity


@dataclass(frozen=True, slots=True)
class Parameter:
    """What a study varies: its name in print, its unit and range."""

    label: str
    quantity: Quantity


PARAMETERS = {
    "speed": Parameter(
        "speed",
        Quantity("a rotational speed", "rad/s", "rpm", low=0.0, high=1e6, open_low=True),
    ),
    "helix-angle": Parameter("helix angle", Quantity("an angle", "rad", "deg", low=0.0, high=45.0)),
    "face-width": Parameter(
        "face width", Quantity("a length", "m", "mm", low=0.0, high=1e5, open_low=True)
    ),
    "oil-fraction": Parameter("share of oil by volume", NUMBER),
    "backlash": Parameter("backlash", Quantity("a length", "m", "um", low=0.0, high=1e4)),
    "module": Parameter(
        "transverse module", Quantity("a length", "m", "mm", low=0.0, high=1e3, open_low=True)
    ),
}


@dataclass(frozen=True, slots=True)
class Study:
    """Which curves and panels a figure over one parameter has."""

    figure: str  # Figure of Talbot (2012).
    panels: tuple[str, ...]  # Parameters with one panel for each value.
    curves: str  # Parameter with one curve for each value.
    # Values of these: helix angles in degrees, the others over those of the case.
    levels: Mapping[str, tuple[float, ...]]


_SPEEDS: dict[str, tuple[float, ...]] = {"speed": (0.5, 0.75, 1.0)}
_FOUR: dict[str, tuple[float, ...]] = {"helix-angle": (0.0, 30.0), "face-width": (1.0, 5 / 3)}
STUDIES = {
    "speed": Study("Fig. 4.8", (), "helix-angle", {"helix-angle": (0.0, 15.0, 30.0)}),
    "helix-angle": Study(
        "Fig. 4.9", ("face-width",), "speed", {"face-width": (1.0, 5 / 3, 7 / 3), **_SPEEDS}
    ),
    "face-width": Study(
        "Fig. 4.10", ("helix-angle",), "speed", {"helix-angle": (0.0, 10.0, 20.0, 30.0), **_SPEEDS}
    ),
    "oil-fraction": Study("Fig. 4.11", tuple(_FOUR), "speed", _FOUR | _SPEEDS),
    "backlash": Study("Fig. 4.12", tuple(_FOUR), "speed", _FOUR | _SPEEDS),
    "module": Study("Fig. 4.13", tuple(_FOUR), "speed", _FOUR | _SPEEDS),
}

LEVELS = ("speed", "helix-angle", "face-width")
"""Parameters that have curves or panels."""


NUMBERS = {
    "pocketing_loss": "power",
    "power_difference": "difference",
    "pressure_max": "pressure_max",
    "pressure_min": "pressure_min",
    "speed_max": "speed_max",
}
"""What is kept of the flow of a point, and which of the `FLOW_NUMBERS` it is."""


@dataclass(frozen=True, slots=True)
class StudyAxis:
    """Values of one parameter, in SI and as `PocketVariant` has them."""

    name: str
    values: tuple[float, ...]
    variants: tuple[Any, ...]

    @property
    def field(self) -> str:
        """Field of `PocketVariant`."""
        return "teeth" if self.name == "module" else self.dimension

    @property
    def dimension(self) -> str:
        """Dimension of the dataset."""
        return self.name.replace("-", "_")


@dataclass(frozen=True, slots=True)
class StudyPlan(Plan):
    """All points of some studies of one mesh, each point once."""

    kind: ClassVar[str] = "study"
    case: Case
    duty: MeshDuty
    # By study: panels, curves, and last the parameter itself.
    axes: dict[str, tuple[StudyAxis, ...]]
    points: tuple[PocketVariant, ...]
    given: dict[str, Any]  # What was asked for, as `make_study` takes it.

    @classmethod
    def again(cls, content: Mapping[str, Any], source: str) -> StudyPlan:
        """The plan that `describe` described."""
        return make_study(build_case(content["case"], {}, source), **content["given"])

    @property
    def source(self) -> str:
        """The file of the case."""
        return str(Path(self.case.source).absolute())

    @property
    def size(self) -> int:
        """Number of points."""
        return len(self.points)

    def order(self) -> list[int]:
        """Those of the same geometry next to each other."""
        return sorted(range(self.size), key=lambda index: _geometry(self.points[index]))

    def describe(self) -> dict[str, Any]:
        """The case, and what was asked for."""
        return {"case": self.case.given(), "given": self.given}

    def _solve(self, index: int) -> Row:
        flow = solve_variant(self.case, self.duty, self.points[index])
        warning = "" if flow.periodic else "the flow does not repeat; the loss is a mean"
        figures = flow_figures(flow)
        numbers = {name: getattr(figures, own) for name, own in NUMBERS.items()}
        return Row(str(Status.CONVERGED), warnings=warning, numbers=numbers)

    def variants(self, name: str) -> Iterator[PocketVariant]:
        """All points of study `name`, its last axis fastest."""
        return _variants(base_variant(self.case, self.duty), self.axes[name])


def make_study(
    case: Case,
    what: Iterable[str],
    *,
    mesh: str | None = None,
    ranges: Mapping[str, Iterable[Any]],
    levels: Mapping[str, Iterable[Any]],
) -> StudyPlan:
    """Check what is to be studied. Parameters as for `pocketing_study`."""
    names = list(dict.fromkeys(what))
    ranges = {name: tuple(values) for name, values in ranges.items()}
    levels = {name: tuple(values) for name, values in levels.items()}
    given = plain({"what": names, "mesh": mesh, "ranges": ranges, "levels": levels})
    duty = _duty(case, mesh)
    given_ranges, range_problems = _parsed("range", ranges, names)
    given_levels, level_problems = _parsed("level", levels, list(LEVELS))
    problems = [*_unknown_studies(names), *range_problems, *level_problems]
    raise_any(problems, "the study")
    base = base_variant(case, duty)
    axes = {}
    for name in names:
        study = STUDIES[name]
        values = {
            parameter: given_levels.get(parameter) or _levels(base, parameter, shares)
            for parameter, shares in study.levels.items()
        } | {name: given_ranges.get(name) or _range(duty, base, name)}
        order = (*study.panels, study.curves, name)
        axes[name] = tuple(_axis(duty, parameter, values[parameter]) for parameter in order)
    points = dict.fromkeys(point for name in names for point in _variants(base, axes[name]))
    return StudyPlan(case, duty, axes, tuple(points), given)


def _unknown_studies(names: Sequence[str]) -> list[Problem]:
    if not names:
        return [Problem("what", "", "names no study.", f"Choose of {', '.join(STUDIES)}.")]
    return [
        Problem("what", written(name), "is no study.", _choice(name, list(STUDIES)))
        for name in names
        if name not in STUDIES
    ]


def _choice(name: str, known: Sequence[str]) -> str:
    return did_you_mean(name, list(known)) or f"Choose of {', '.join(known)}."


def _duty(case: Case, mesh: str | None) -> MeshDuty:
    duties = {duty.key: duty for duty in mesh_duties(case)}
    key = next(iter(duties)) if mesh is None else mesh
    if key not in duties:
        allowed = f"must be {' or '.join(duties)}."
        raise InputError(
            [Problem("mesh", written(key), allowed, "Name one of these.")], "the study"
        )
    if duties[key].speed1 == 0:
        problem = Problem(key, "", "does not turn.", "Change operation.speed.")
        raise InputError([problem], case.source)
    return duties[key]


def _parsed(
    what: str, given: Mapping[str, Iterable[Any]], known: Sequence[str]
) -> tuple[dict[str, tuple[float, ...]], list[Problem]]:
    """Values in SI, and the problems of names that are not `known` and of values."""
    parsed: dict[str, tuple[float, ...]] = {}
    problems = []
    for name, values in given.items():
        if name not in PARAMETERS:
            allowed = "is no parameter of the study."
            problems.append(Problem(what, written(name), allowed, _choice(name, known)))
            continue
        if name not in known:
            allowed = f"has no {what} in this study, only {', '.join(known)}."
            problems.append(Problem(what, written(name), allowed, "Leave it out."))
            continue
        items = list(values)
        if not items:
            problems.append(Problem(f"{what} {name}", "", "has no values.", "Give at least one."))
        found = []
        for value in items:
            try:
                found.append(_parse(PARAMETERS[name].quantity, value))
            except PydanticCustomError as error:
                problems.append(refused(error, f"{what} {name}", written(value)))
        parsed[name] = tuple(sorted(set(found)))
    return parsed, problems


def _parse(quantity: Quantity, value: Any) -> float:
    if quantity.si:
        return quantity.parse(value)
    if isinstance(value, int | float) and 0 <= value <= 1:
        return float(value)
    raise PydanticCustomError(
        "share", "must be a number from 0 to 1", {"remedy": "give a number without a unit"}
    )


def _levels(base: PocketVariant, name: str, shares: tuple[float, ...]) -> tuple[float, ...]:
    if name == "helix-angle":
        return tuple(math.radians(angle) for angle in shares)
    own = base.speed if name == "speed" else base.face_width
    return tuple(share * own for share in shares)


def _range(duty: MeshDuty, base: PocketVariant, name: str) -> tuple[float, ...]:
    """Values of the source for its example, over those of the case where they have a unit."""
    module = duty.mesh.gear1.rack.transverse_module
    values: Mapping[str, NDArray[np.float64]] = {
        "speed": base.speed * np.linspace(0.1, 1.0, 10),
        "helix-angle": np.radians(np.arange(0.0, 36.0, 5.0)),
        "face-width": base.face_width * np.linspace(1.0, 7 / 3, 5),
        "oil-fraction": np.array([0.01, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6]),
        "backlash": module * np.linspace(0.025, 0.1125, 8),
        "module": module * 25 / np.arange(28.0, 22.0, -1.0),
    }
    return tuple(map(float, values[name]))


def _axis(duty: MeshDuty, name: str, values: tuple[float, ...]) -> StudyAxis:
    if name != "module":
        return StudyAxis(name, values, values)
    try:
        found = teeth_for_module(duty.mesh, values)
    except ValueError as error:
        problem = Problem("range module", "", f"{error}.", "Give smaller modules.")
        raise InputError([problem], "the study") from None
    return StudyAxis(name, tuple(found), tuple(found.values()))


def _variants(base: PocketVariant, axes: Sequence[StudyAxis]) -> Iterator[PocketVariant]:
    for values in product(*(axis.variants for axis in axes)):
        yield replace(base, **dict(zip((axis.field for axis in axes), values, strict=True)))


def _geometry(point: PocketVariant) -> tuple[Any, ...]:
    """Equal for points of the same geometry."""
    return (point.teeth, point.backlash, point.helix_angle, point.face_width)
