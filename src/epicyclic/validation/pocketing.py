"""The parametric study of pocketing losses of Talbot (2012), section 4.4."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.arrays import FloatArray
from epicyclic.build.models import fluids_of
from epicyclic.case.case import Case, build_case, read_case
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import Problem, Status, one_problem, raise_any
from epicyclic.gears.cutting import fitted_tool
from epicyclic.gears.gear import BasicRack, Gear, half_angle_from_thickness
from epicyclic.gears.mesh import Mesh
from epicyclic.losses.pocket_flow import NETWORK_MODELS, PocketFlow
from epicyclic.losses.pocket_tables import FLOW_NUMBERS, flow_figures
from epicyclic.machine.gear_mesh import MeshDuty
from epicyclic.machine.pocket_flow import flow_request, oil_in_mesh
from epicyclic.messages import did_you_mean, refused, written
from epicyclic.oil.oil import mixture_state
from epicyclic.result.result import origin
from epicyclic.schema.read import plain
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.meshes import variable
from epicyclic.study.pockets import mesh_duties
from epicyclic.study.sweeps.runner import HERE, TEXTS, Plan, Progress, Row, Rows, Runner
from epicyclic.units import DEGREE, MILLIMETRE, NUMBER, Quantity
from epicyclic.validation.compare import open_figures, published_ends
from epicyclic.validation.compute import NOMINAL_BACKLASH

if TYPE_CHECKING:
    import xarray as xr

# Variants of a mesh as the pocketing study compares them. Talbot (2012), section 4.4.

ROUNDING = 1e-9  # What is less negative is left over from rounding. [m] or [1]

FEWEST_TEETH = 5


@dataclass(frozen=True, slots=True)
class PocketVariant:
    """A mesh that keeps what is not listed here: centre distance, pressure angle, oil, air."""

    # The transverse section stays as it is, but for the fillets, which a tool of the same rounding
    # over the normal module leaves. [rad]
    helix_angle: float
    face_width: float  # Face width of both gears. [m]
    oil_fraction: float  # [1]
    # At the operating circles; both teeth are made thinner or thicker by half of the change. [m]
    backlash: float
    # The transverse module follows: pitch diameters stay, but for the ratio that whole teeth allow;
    # addendum and dedendum at the operating circles go with the module, the backlash stays.
    teeth: tuple[int, int]
    speed: float  # Speed of member 1 against the line of centres. [rad/s]


def base_variant(duty: MeshDuty) -> PocketVariant:
    """The mesh as the case has it."""
    mesh = duty.gears.mesh
    return PocketVariant(
        helix_angle=mesh.gear1.rack.helix_angle,
        face_width=mesh.face_width,
        oil_fraction=oil_in_mesh(duty),
        backlash=mesh.backlash,
        teeth=(mesh.gear1.teeth, mesh.gear2.teeth),
        speed=abs(duty.speed1),
    )


def transverse_module(mesh: Mesh, teeth: tuple[int, int]) -> float:
    """Module that these teeth have at the same centre distance and pressure angles. [m]"""
    old = mesh.gear2.teeth + mesh.side * mesh.gear1.teeth
    new = teeth[1] + mesh.side * teeth[0]
    return mesh.gear1.rack.transverse_module * old / new


def teeth_for_module(mesh: Mesh, modules: Sequence[float]) -> dict[float, tuple[int, int]]:
    """Whole teeth whose transverse modules come nearest to `modules`, by their modules.

    Raises `ValueError` if a module leaves fewer teeth than a gear can have, or a ring no more than
    its mate.
    """
    found = {}
    for module in modules:
        ratio = mesh.gear1.rack.transverse_module / module
        teeth = (round(mesh.gear1.teeth * ratio), round(mesh.gear2.teeth * ratio))
        if min(teeth) < FEWEST_TEETH or (mesh.internal and teeth[1] <= teeth[0]):
            raise ValueError(f"{1e3 * module:.4g} mm leaves {teeth[0]} and {teeth[1]} teeth")
        found[transverse_module(mesh, teeth)] = teeth
    return found


def varied_duty(duty: MeshDuty, variant: PocketVariant) -> MeshDuty:
    """The duty with the mesh, tools and speed of `variant`.

    Raises `ValueError` if such gears do not mesh or cannot be cut.
    """
    mesh = _varied_mesh(duty.gears.mesh, variant)
    for what, value in (
        ("backlash", mesh.backlash),
        ("tip clearance of member 1", mesh.tip_clearances[0]),
        ("tip clearance of member 2", mesh.tip_clearances[1]),
        ("transverse contact ratio", mesh.transverse_contact_ratio),
    ):
        if value < -ROUNDING:
            raise ValueError(f"the {what} is negative")
    one, two = map(fitted_tool, mesh.gears, duty.gears.roundings, mesh.inner_radii)
    gears = replace(duty.gears, mesh=mesh, tools=(one, two))
    return replace(duty, gears=gears, speed1=variant.speed)


def solve_variant(case: Case, duty: MeshDuty, variant: PocketVariant) -> PocketFlow:
    """Flow through the pockets of a variant.

    Raises `InputError` if such gears do not mesh or cannot be cut; `ConvergenceError` if the flow
    is not found.
    """
    fluids = fluids_of(case)
    mixture = mixture_state(fluids.oil, variant.oil_fraction, fluids.pressure)
    try:
        varied = varied_duty(duty, variant)
        family, speed, _, pressure = flow_request(varied, fluids)
        if family.model not in NETWORK_MODELS:
            family = replace(family, oil_fraction=variant.oil_fraction)
        return family.flow(speed, mixture, pressure)
    except ValueError as error:
        allowed, remedy = f"is impossible: {error}.", "Vary over a smaller range."
        raise one_problem(duty.gears.key, "", allowed, remedy, "the study") from None


def _varied_mesh(mesh: Mesh, variant: PocketVariant) -> Mesh:
    one, two = mesh.gears
    z1, z2 = variant.teeth
    module = transverse_module(mesh, variant.teeth)
    rack = BasicRack(module, one.rack.transverse_pressure_angle, variant.helix_angle)
    operating1 = mesh.center_distance * z1 / (z2 + mesh.side * z1)
    pitch = 2 * math.pi * operating1 / z1
    pitch_before = 2 * math.pi * mesh.operating_radius1 / one.teeth

    def varied(gear: Gear, teeth: int, radius_before: float, radius: float) -> Gear:
        filled = (gear.thickness_at(radius_before) + mesh.backlash / 2) / pitch_before
        thickness = filled * pitch - variant.backlash / 2
        scale = module / gear.rack.transverse_module
        return replace(
            gear,
            rack=rack,
            teeth=teeth,
            thickness_half_angle=half_angle_from_thickness(
                rack, teeth, gear.internal, thickness, radius
            ),
            tip_radius=radius + scale * (gear.tip_radius - radius_before),
            root_radius=radius + scale * (gear.root_radius - radius_before),
            face_width=variant.face_width,
            tip_chamfer=scale * gear.tip_chamfer,
        )

    return replace(
        mesh,
        gear1=varied(one, z1, mesh.operating_radius1, operating1),
        gear2=varied(two, z2, mesh.operating_radius2, operating1 * z2 / z1),
    )


@dataclass(frozen=True, slots=True)
class Parameter:
    """What a study varies: its name in print, its unit and range."""

    label: str
    quantity: Quantity


PARAMETERS = {
    "speed": Parameter(
        "speed", Quantity("a rotational speed", "rad/s", "rpm", low=0.0, high=1e6, open_low=True)
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

LEVELS = ("speed", "helix-angle", "face-width")  # Parameters that have curves or panels.

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
        geometry = attrgetter("teeth", "backlash", "helix_angle", "face_width")
        return sorted(range(self.size), key=lambda index: geometry(self.points[index]))

    def describe(self) -> dict[str, Any]:
        """The case, and what was asked for."""
        return {"case": self.case.given(), "given": self.given}

    def _solve(self, index: int) -> Row:
        flow = solve_variant(self.case, self.duty, self.points[index])
        warning = "" if flow.periodic else "the flow is not periodic; the loss is a mean"
        figures = flow_figures(flow)
        numbers = {name: getattr(figures, own) for name, own in NUMBERS.items()}
        return Row(str(Status.CONVERGED), warnings=warning, numbers=numbers)


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
    problems = [
        Problem("what", written(name), "is not a study.", _choice(name, list(STUDIES)))
        for name in names
        if name not in STUDIES
    ]
    if not names:
        problems = [Problem("what", "", "names no study.", f"Choose one of {', '.join(STUDIES)}.")]
    raise_any([*problems, *range_problems, *level_problems], "the study")
    base = base_variant(duty)
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


def _choice(name: str, known: Sequence[str]) -> str:
    return did_you_mean(name, list(known)) or f"Choose one of {', '.join(known)}."


def _duty(case: Case, mesh: str | None) -> MeshDuty:
    duties = {duty.gears.key: duty for duty in mesh_duties(case)}
    key = next(iter(duties)) if mesh is None else mesh
    if key not in duties:
        allowed = f"must be {' or '.join(duties)}."
        raise one_problem("mesh", written(key), allowed, "Give one of these.", "the study")
    if duties[key].speed1 == 0:
        raise one_problem(key, "", "does not turn.", "Change operation.speed.", case.source)
    return duties[key]


def _parsed(
    what: str, given: Mapping[str, Iterable[Any]], known: Sequence[str]
) -> tuple[dict[str, tuple[float, ...]], list[Problem]]:
    """Values in SI, and the problems of names that are not `known` and of values."""
    parsed: dict[str, tuple[float, ...]] = {}
    problems = []
    for name, values in given.items():
        if name not in PARAMETERS:
            allowed = "is not a parameter of the study."
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
    module = duty.gears.mesh.gear1.rack.transverse_module
    values: Mapping[str, FloatArray] = {
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
        found = teeth_for_module(duty.gears.mesh, values)
    except ValueError as error:
        remedy = "Give smaller modules."
        raise one_problem("range module", "", f"{error}.", remedy, "the study") from None
    return StudyAxis(name, tuple(found), tuple(found.values()))


def _variants(base: PocketVariant, axes: Sequence[StudyAxis]) -> Iterator[PocketVariant]:
    """All points of a study, its last axis fastest."""
    for values in product(*(axis.variants for axis in axes)):
        yield replace(base, **dict(zip((axis.field for axis in axes), values, strict=True)))


def pocketing_study(
    case: CaseSource,
    what: Iterable[str] = tuple(STUDIES),
    *,
    mesh: str | None = None,
    ranges: Mapping[str, Iterable[Any]] | None = None,
    levels: Mapping[str, Iterable[Any]] | None = None,
    jobs: int | None = None,
    dask: str | None = None,
    shard: tuple[int, int] | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> dict[str, xr.Dataset]:
    """Pocketing loss of a mesh over its main parameters, as Talbot (2012), section 4.4.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
    what : iterable of str
        Some of ``"speed"``, ``"helix-angle"``, ``"face-width"``, ``"oil-fraction"``,
        ``"backlash"``, ``"module"``; default: all.
    mesh : str, optional
        ``"sun_mesh"`` (default) or ``"ring_mesh"`` of a planetary set.
    ranges : mapping, optional
        Parameters to the values over which their study goes, as text with units; a share of oil
        is a number. A module becomes the nearest one with whole teeth.
    levels : mapping, optional
        Parameters to the values that have curves and panels of their own in the other studies.
    jobs, dask, shard, journal, progress
        As for `sweep`.

    Returns
    -------
    dict of str to xarray.Dataset
        By study. What each parameter keeps constant is told in its how-to page. Points that
        failed have NaN, the status ``"failed"`` and the reason in ``message``.

    Raises
    ------
    InputError
        If a study, mesh or value cannot be, or the journal is that of another study.
    """
    runner = Runner(jobs, dask, shard, journal, progress)
    plan = make_study(as_case(case), what, mesh=mesh, ranges=ranges or {}, levels=levels or {})
    return study_datasets(plan, runner.run(plan))


def study_datasets(plan: StudyPlan, rows: Rows) -> dict[str, xr.Dataset]:
    """The rows of all points over the axes of each study."""
    place = {point: index for index, point in enumerate(plan.points)}
    base = base_variant(plan.duty)
    return {
        name: _dataset(plan, name, rows, [place[point] for point in _variants(base, axes)])
        for name, axes in plan.axes.items()
    }


def _dataset(plan: StudyPlan, name: str, rows: Rows, own: list[int]) -> xr.Dataset:
    import xarray as xr

    axes = plan.axes[name]
    dims = tuple(axis.dimension for axis in axes)
    shape = tuple(len(axis.values) for axis in axes)
    coordinates = {axis.dimension: _coordinate(axis) for axis in axes}
    if "speed" in coordinates:
        coordinates["speed"][-1]["long_name"] = f"speed of the {_member(plan)}"
    variables: dict[str, Any] = {}
    for key, figure in NUMBERS.items():
        values = rows.numbers(key)[own].reshape(shape)
        variables[key] = variable(dims, values, *FLOW_NUMBERS[figure])
    for key, label in TEXTS.items():
        texts = np.array(getattr(rows, key), dtype=object)[own].reshape(shape)
        variables[key] = (dims, texts, {"long_name": label})
    dataset = xr.Dataset(variables, coordinates, _attributes(plan, name))
    if name == "speed" and dataset.sizes["speed"] > 1:
        # Slope of the logarithm of the loss over that of the speed.
        loss = dataset["pocketing_loss"]
        speed = np.log(loss["speed"])
        away = speed - speed.mean()
        slope: xr.DataArray = (np.log(loss) * away).sum("speed", skipna=False) / (away**2).sum()
        slope.attrs = {"long_name": "exponent of the speed in the loss", "units": "1"}
        dataset["speed_exponent"] = slope
    return dataset


def _coordinate(axis: StudyAxis) -> tuple[str, FloatArray, dict[str, str]]:
    parameter = PARAMETERS[axis.name]
    scale, _ = parameter.quantity.scale_and_offset()
    attributes = {"long_name": parameter.label, "units": parameter.quantity.display or "1"}
    # rounded as everything that is shown: 15 mm and not 15.000000000000002
    values = [float(f"{scale * value:.12g}") for value in axis.values]
    return (axis.dimension, np.array(values), attributes)


def _member(plan: StudyPlan) -> str:
    """Whose speed it is, and against what."""
    name = plan.duty.gears.mesh.gear1.name
    sets = [it for it in plan.case.gearings.values() if it.computed and it.planets]
    planets = any(plan.duty.gears.mesh in gearing.geometries for gearing in sets)
    return f"{name} against the carrier" if planets else name


def _attributes(plan: StudyPlan, name: str) -> dict[str, str]:
    mesh = plan.duty.gears.key.replace("_", " ")
    return {
        "title": f"Pocketing loss of the {mesh} of {plan.case.title or 'the case'}",
        "figure": STUDIES[name].figure,
        "mesh": plan.duty.gears.key,
        "model": plan.duty.gears.models.pockets.model,
        **origin(plan.case),
    }


EXAMPLE = "talbot-2012-pair"
_SAME = ("gears", "pinion", "gear", "lubricant", "surroundings")
"""Tables in which a case must agree with the example."""


@dataclass(frozen=True, slots=True)
class PublishedStudy:
    """What is published of the example, in display units."""

    own: Mapping[str, float]  # Values of the dimensions of a study in the case itself.
    exponents: Mapping[float, float]  # Of the speed in the loss, by helix angle. [deg]
    marks: tuple[PublishedLoss, ...]


@dataclass(frozen=True, slots=True)
class PublishedLoss:
    """A published loss, or the ends between which the axes of the figures enclose it."""

    place: Mapping[str, float]  # Values of the dimensions of a study.
    # What a ratio or a change refers to, in the same way.
    base: Mapping[str, float] | None
    ends: tuple[float, float]  # [W], or ratios to the loss at `base`.


FIGURES_AGAIN = {study.figure.removeprefix("Fig. "): name for name, study in STUDIES.items()}
"""Figures of section 4.4, and the study behind each."""


def study_again(
    figures: Sequence[str], runner: Runner = HERE
) -> tuple[Case, dict[str, xr.Dataset]]:
    """The example of the source, and the studies of its figures by their numbers."""
    # with the flow that is meant for this comparison
    case = read_case(EXAMPLE).updated({"models.pocketing": "talbot-2012"})
    names = {FIGURES_AGAIN[figure]: figure for figure in figures if figure in FIGURES_AGAIN}
    if not names:
        return case, {}
    plan = make_study(case, names, ranges={}, levels={})
    found = study_datasets(plan, runner.run(plan))
    return case, {names[name]: data for name, data in found.items()}


def published_study(case: Case) -> PublishedStudy | None:
    """The published values if they hold for `case`, the example of the source."""
    example = read_case(EXAMPLE)
    one, other = (item.operation.oil_inlet_temperature for item in (case, example))
    if one != other or any(getattr(case, it, None) != getattr(example, it) for it in _SAME):
        return None
    given = example.given()
    own = _place({
        "helix_angle": given["gears"]["helix_angle"],
        "face_width": given["pinion"]["face_width"],
    })  # fmt: skip
    exponents, marks = {}, []
    for item in open_figures():
        if item.get("role") == "context":
            continue
        if "exponent" in item:
            exponents[_place(item["of"])["helix_angle"]] = item["value"]
            continue
        low, high = published_ends(item)
        if item["unit"] == "%":
            low, high = 1 + low / 100, 1 + high / 100
        base = _place(item["over"]) if "over" in item else None
        marks.append(PublishedLoss(_place(item["of"]), base, (low, high)))
    return PublishedStudy(own, exponents, tuple(marks))


def _place(given: Mapping[str, Any]) -> dict[str, float]:
    """Conditions of a figure as the dimensions of a study: rpm, um, deg, mm."""
    return {
        "speed": 1e4,
        "backlash": 1e3 * given.get("backlash", NOMINAL_BACKLASH),
        "helix_angle": DEGREE.to_display(DEGREE.parse(given["helix_angle"])),
        "face_width": MILLIMETRE.to_display(MILLIMETRE.parse(given["face_width"])),
    }
