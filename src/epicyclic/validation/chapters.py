"""The parametric studies and the test matrix of Talbot (2012), chapters 3 and 5, computed again.

A figure of the source is a family of curves: a loss over one parameter, a curve for each value of a
second one, a panel for each value of a third. The studies of chapter 4 are those of
`epicyclic.pocketing_study`.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.build.machine import build
from epicyclic.build.models import fluids_of
from epicyclic.errors import ConvergenceError
from epicyclic.study.meshes import bearing_details
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.run import PointList
from epicyclic.study.sweeps.runner import HERE, Runner
from epicyclic.units import CELSIUS, NUMBER, WATT, unit_text
from epicyclic.validation.compare import published_figures
from epicyclic.validation.compute import planet_bearing, source_case
from epicyclic.validation.pocketing import FIGURES_AGAIN

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]
PLANETS = 3  # Planets of the set whose planet bearing chapter 3 studies.
FULL_BRANCH = 1000 / PLANETS  # Largest torque on a branch. [N m]
ROLLER_FIGURES = {"3.3": "branch", "3.7": "roller", "3.9": "clearance", "3.12": "helix"}
"""Figures of roller loads, and what varies in them."""


@dataclass(frozen=True)
class Lever:
    """What a family varies along one of its directions."""

    name: str
    label: str
    unit: str
    values: tuple[Any, ...]  # In `unit`.
    # From a value to the keys of the case that it changes.
    changes: Callable[[Any], Mapping[str, Any]]


@dataclass(frozen=True)
class Mark:
    """A published number on a figure."""

    label: str
    over: float  # Where it lies.
    value: float  # Where it lies.
    panel: float | str  # In which panel.


@dataclass(frozen=True)
class Family:
    """A figure of the source: data over (panels, curves, over), and what is published of it."""

    figure: str  # Its number in the source.
    title: str
    data: xr.Dataset  # With one variable of three dimensions, the first of `variables`.
    marks: tuple[Mark, ...] = ()

    @property
    def variable(self) -> str:
        """Name of what is drawn."""
        return str(next(iter(self.data.data_vars)))


def _key(key: str, unit: str) -> Callable[[Any], dict[str, Any]]:
    return lambda value: {key: f"{value} {unit}"}


def _speed(values: Sequence[float] = (1000, 2000, 3000, 4000)) -> Lever:
    return Lever("speed", "speed of the sun", "rpm", tuple(values), _key("operation.speed", "rpm"))


_BRANCH = Lever(
    "branch_torque", "torque on the branch", "N*m",
    (41.7, 83.3, 125.0, 166.7, 208.3, 250.0, 291.7, 333.3),
    lambda value: {"operation.torque": f"{PLANETS * value} N*m"},
)  # fmt: skip
_TEMPERATURE = Lever(
    "temperature", "oil inlet temperature", "degC", (40, 60, 90),
    _key("operation.oil_inlet_temperature", "degC"),
)  # fmt: skip
_ROUGHNESS = {0.063: (0.06, 0.02), 0.125: (0.06, 0.11), 0.149: (0.10, 0.11), 0.180: (0.10, 0.15)}
"""Composite roughness, and that of roller and race. p. 70. [um]"""


def _rough(composite: float) -> dict[str, Any]:
    roller, race = _ROUGHNESS[composite]
    return {
        "planet_bearing.roller_roughness": f"{roller} um",
        "planet_bearing.race_roughness": f"{race} um",
    }


def _helical(angle: float) -> dict[str, Any]:
    """The transverse geometry held, so that the torque gives the same radial force. Eq. 3.7."""
    gears = source_case().given()["gears"]
    module, pressure, helix = (
        float(str(gears[key]).split()[0])
        for key in ("normal_module", "normal_pressure_angle", "helix_angle")
    )
    cosine = math.cos(math.radians(helix))
    transverse = math.degrees(math.atan(math.tan(math.radians(pressure)) / cosine))
    return {
        "gears.normal_module": None,
        "gears.normal_pressure_angle": None,
        "gears.transverse_module": f"{module / cosine!r} mm",
        "gears.transverse_pressure_angle": f"{transverse!r} deg",
        "gears.helix_angle": f"{angle} deg",
    }


_CURVES = {
    "roughness": Lever("roughness", "composite roughness", "um", tuple(_ROUGHNESS), _rough),
    "roller": Lever(
        "roller_diameter", "roller diameter", "mm", (2.015, 3.015, 4.015, 5.015),
        _key("planet_bearing.roller_diameter", "mm"),
    ),
    "clearance": Lever(
        "clearance", "diametral clearance", "um", (1, 4, 9, 14),
        _key("planet_bearing.diametral_clearance", "um"),
    ),
    "length": Lever(
        "roller_length", "roller length", "mm", (6, 8, 10, 12),
        _key("planet_bearing.roller_length", "mm"),
    ),
    "helix": Lever("helix_angle", "helix angle", "deg", (0, 13.124, 20, 30), _helical),
}  # fmt: skip
_BEARING_STUDIES = {
    "3.4": ("oil inlet temperature", _TEMPERATURE, _speed((3000, 4000))),
    "3.5": ("composite roughness", _CURVES["roughness"], _speed()),
    "3.6": ("roller diameter", _CURVES["roller"], _speed()),
    "3.8": ("diametral clearance", _CURVES["clearance"], _speed()),
    "3.10": ("roller length", _CURVES["length"], _speed()),
    "3.11": ("helix angle", _CURVES["helix"], _speed()),
}
"""Figures of chapter 3 over the torque on a branch: what each is about, its curves and panels."""
_WITHOUT_FLOW = {f"losses.{mesh}_pocketing.include": False for mesh in ("sun_mesh", "ring_mesh")}
"""Pockets have no part in the loss of a bearing, and take time."""


def bearing_families(figures: Sequence[str], runner: Runner = HERE) -> list[Family]:
    """Mechanical loss of one planet bearing. Talbot (2012), section 3.4.

    Raises `ConvergenceError` if a point cannot be computed.
    """
    wanted = [figure for figure in figures if figure in _BEARING_STUDIES]
    points: list[dict[str, Any]] = []
    for figure in wanted:
        _, curves, panels = _BEARING_STUDIES[figure]
        points += (_WITHOUT_FLOW | point for point in _points(panels, curves, _BRANCH))
    losses = iter(_numbers(points, ("planet_bearing_mechanical",), runner)[0] / PLANETS)
    families = []
    for figure in wanted:
        about, curves, panels = _BEARING_STUDIES[figure]
        held = "" if curves is _TEMPERATURE else f", {_oil()}"
        shape = tuple(len(lever.values) for lever in (panels, curves, _BRANCH))
        values = np.array(list(itertools.islice(losses, math.prod(shape)))).reshape(shape)
        data = _dataset({"bearing_loss": values}, (panels, curves, _BRANCH))
        data["bearing_loss"].attrs = {"long_name": "loss of one planet bearing", "units": "W"}
        marks = tuple(_bearing_marks(figure))
        families.append(Family(figure, f"loss of a planet bearing, {about}{held}", data, marks))
    return families


def _oil() -> str:
    """What the example says of its oil where nothing else is studied."""
    temperature = CELSIUS.text(fluids_of(source_case()).oil.temperature, 3)
    return f"oil at {unit_text(temperature)}"


def _bearing_marks(figure: str) -> Iterator[Mark]:
    """Printed losses at the largest torque and 4000 rpm."""
    for row in published_figures():
        given = row["with"]
        if row["compute"] != "planet_bearing_loss":
            continue
        warm = given["composite_roughness"] > 0.14
        if (figure, warm) in (("3.4", True), ("3.5", False)):
            label = given["temperature"] if warm else f"{given['composite_roughness']:g} um"
            yield Mark(f"printed, {unit_text(label)}", FULL_BRANCH, row["value"], 4000)
    if figure == "3.5":
        smooth, ratio = _published("planet_bearing_loss", 0.063), _published("planet_bearing_ratio")
        value = smooth["value"] * ratio["value"]
        yield Mark("inferred, 0.18 µm", FULL_BRANCH, value, 4000)


def roller_loads_over(figure: str) -> list[tuple[str, xr.Dataset]]:
    """Loads along the rollers at the largest torque, or at the torques of Fig. 3.3.

    Returns list of (str, xarray.Dataset): what varies, and `epicyclic.study.meshes.bearing_details`
    of it.
    """
    name = ROLLER_FIGURES[figure]
    lever = _BRANCH if name == "branch" else _CURVES[name]
    values = (42, 100, 333) if name == "branch" else lever.values
    if name == "helix":
        values = (0, 20, 30)
    found = []
    for value in values:
        case = source_case().updated(_WITHOUT_FLOW | dict(lever.changes(value)))
        result = solve(case)
        assert result.bearing is not None
        assert result.bearing.loads is not None
        details = bearing_details(planet_bearing(build(case)), result.bearing.loads)
        found.append((f"{lever.label} {value:g} {unit_text(lever.unit)}", details))
    return found


def joined(cases: Sequence[tuple[str, xr.Dataset]]) -> xr.Dataset:
    """The loads of several cases as one dataset."""
    import xarray as xr

    data = xr.concat([data for _, data in cases], dim="case")
    return data.assign_coords(case=[label for label, _ in cases])


# --- chapter 5 ------------------------------------------------------------------------------------

_TORQUES = (0, 250, 500, 750, 1000)
_SETS = {
    "3 shaved": (3, "shaved"),
    "4 shaved": (4, "shaved"),
    "5 shaved": (5, "shaved"),
    "6 shaved": (6, "shaved"),
    "6 polished": (6, "chemically-polished"),
}
_SET = Lever(
    "set", "planets", "", tuple(_SETS),
    lambda name: {"planet.count": _SETS[name][0], "planet.roughness": _SETS[name][1]},
)  # fmt: skip
_TORQUE = Lever("torque", "torque on the sun", "N*m", _TORQUES, _key("operation.torque", "N*m"))
_SPIN = ("sun_mesh_pocketing", "ring_mesh_pocketing", "planet_bearing_viscous")
"""Load-independent losses of a planet branch. Eq. 5.14."""


def loaded_and_unloaded(runner: Runner = HERE) -> xr.Dataset:
    """The 300 tests: 3 to 6 planets, shaved or polished, at all temperatures, torques and speeds.

    Raises `ConvergenceError` if a test cannot be computed.
    """
    levers = (_SET, _TEMPERATURE, _TORQUE, _speed())
    names = ("total", "load_dependent", "load_independent", "input_power", *_SPIN)
    shape = tuple(len(lever.values) for lever in levers)
    found = _numbers(list(_points(*levers)), names, runner)
    return _dataset(
        {name: values.reshape(shape) for name, values in zip(names, found, strict=True)}, levers
    )


def set_families(figures: Sequence[str], runner: Runner = HERE) -> list[Family]:
    """Losses of the whole set in the tests. Talbot (2012), section 5.3.

    Raises `ConvergenceError` if a test cannot be computed.
    """
    wanted = [figure for figure in figures if figure in _OF_TESTS]
    if not wanted:
        return []
    data = loaded_and_unloaded(runner)
    return [_OF_TESTS[figure](figure, data) for figure in wanted]


def _spin(figure: str, data: xr.Dataset) -> Family:
    loss = _kilowatts(data["load_independent"].sel(torque=0), "load-independent loss")
    family = loss.sel(set=list(_SETS)[:4]).transpose("temperature", "set", "speed")
    mark = _published("load_independent_loss")
    marks = (Mark("measured, 3 planets (inferred)", 4000, mark["value"], 90),)
    return Family(figure, "load-independent loss", family.to_dataset(name="loss"), marks)


def _branch_spin(figure: str, data: xr.Dataset) -> Family:
    """As the tests give it, a third of the difference of six and three planets. Eq. 5.14."""
    loss = data["load_independent"].sel(torque=0)
    branch = (loss.sel(set="6 shaved") - loss.sel(set="3 shaved")) / 3
    branch = branch.expand_dims(panel=["6 less 3 planets"]).transpose(
        "panel", "temperature", "speed"
    )
    branch.attrs = {"long_name": "load-independent loss of a branch", "units": "W"}
    mark = Mark("measured, at most 0.2 kW/3 (inferred)", 4000, 200 / 3, "6 less 3 planets")
    title = "load-independent loss of a branch"
    return Family(figure, title, branch.to_dataset(name="loss"), (mark,))


def _loaded(figure: str, data: xr.Dataset) -> Family:
    temperature = dict(zip(("5.3", "5.4", "5.5"), _TEMPERATURE.values, strict=True))[figure]
    loss = _kilowatts(data["load_dependent"], "load-dependent loss")
    family = loss.sel(temperature=temperature, set=list(_SETS)[:4], torque=list(_TORQUES[1:]))
    marks = tuple(_loaded_marks()) if temperature == 90 else ()
    title = f"load-dependent loss, shaved, {temperature} °C"
    family = family.drop_vars("temperature").transpose("set", "torque", "speed")
    return Family(figure, title, family.to_dataset(name="loss"), marks)


def _loaded_marks() -> Iterator[Mark]:
    for row in published_figures():
        if row["compute"] == "load_dependent_loss":
            how = "measured" if "measured" in row["what"] else "predicted there"
            yield Mark(f"{how}, 1000 N·m (inferred)", 4000, row["value"], "3 shaved")


def _polished(figure: str, data: xr.Dataset) -> Family:
    loss = _kilowatts(data["load_dependent"], "load-dependent loss")
    family = loss.sel(set="6 polished", torque=list(_TORQUES[1:])).drop_vars("set")
    family = family.transpose("temperature", "torque", "speed")
    title = "load-dependent loss, 6 polished planets"
    return Family(figure, title, family.to_dataset(name="loss"))


def _branches(figure: str, data: xr.Dataset) -> Family:
    """Loss over power of a branch, all tests of a finish and temperature, with its line."""
    number = int(figure.removeprefix("5.")) - 7
    temperature = _TEMPERATURE.values[number % 3]
    sets = list(_SETS)[:4] if number < 3 else list(_SETS)[4:]
    own = data.sel(temperature=temperature, set=sets, torque=list(_TORQUES[1:]))
    planets = own["planets"]
    power = _kilowatts(own["input_power"] / planets, "power of a branch")
    loss = _kilowatts(own["load_dependent"] / planets, "load-dependent loss of a branch")
    line = np.polyfit(power.values.ravel(), loss.values.ravel(), 1)
    found = loss.to_dataset(name="branch_loss").assign(branch_power=power)
    found = found.drop_vars(["temperature", "planets"]).transpose("set", "torque", "speed")
    found.attrs = {"slope": float(line[0]), "intercept": float(line[1])}
    finish = "shaved" if number < 3 else "chemically polished"
    top = float(power.max())
    marks = tuple(
        Mark(
            f"{'measured' if 'measured' in row['what'] else 'predicted there'}, slope "
            f"{row['value']} %",
            top,
            row["value"],
            "",
        )
        for row in published_figures()
        if row["compute"] == "branch_slope"
        and (row["with"]["temperature"], row["with"]["finish"]) == (f"{temperature} degC", finish)
    )
    title = f"loss of a branch, {finish}, {temperature} °C"
    return Family(figure, title, found, marks)


_OF_TESTS: dict[str, Callable[[str, xr.Dataset], Family]] = {
    "5.1": _spin,
    "5.2": _branch_spin,
    **dict.fromkeys(("5.3", "5.4", "5.5"), _loaded),
    "5.6": _polished,
    **dict.fromkeys((f"5.{number}" for number in range(7, 13)), _branches),
}
"""Figures of chapter 5, and what makes them from the tests."""
CHAPTERS = {
    "3": tuple(sorted({*ROLLER_FIGURES, *_BEARING_STUDIES}, key=lambda it: int(it[2:]))),
    "4": tuple(FIGURES_AGAIN),
    "5": tuple(_OF_TESTS),
}
"""The figures of each chapter that are computed again."""
TOPICS = {"3": "Planet bearings", "4": "Pockets", "5": "Planetary sets, tests"}
"""Which published numbers belong to a chapter."""


def _published(compute: str, roughness: float | None = None) -> dict[str, Any]:
    """The first figure of a kind, or that of a composite roughness in um."""
    return next(
        row
        for row in published_figures()
        if row["compute"] == compute and roughness in (None, row["with"].get("composite_roughness"))
    )


def _kilowatts(values: xr.DataArray, label: str) -> xr.DataArray:
    found = values / 1e3
    found.attrs = {"long_name": label, "units": "kW"}
    return found


# --- points and datasets --------------------------------------------------------------------------


def _points(*levers: Lever) -> Iterator[dict[str, Any]]:
    """All combinations, the last lever changing fastest."""
    for values in itertools.product(*(lever.values for lever in levers)):
        point: dict[str, Any] = {}
        for lever, value in zip(levers, values, strict=True):
            point |= lever.changes(value)
        yield point


def _numbers(
    points: Sequence[Mapping[str, Any]], names: Sequence[str], runner: Runner
) -> list[FloatArray]:
    """Numbers of the results of the example with other keys."""
    rows = runner.run(PointList(source_case(), tuple(map(dict, points))))
    if rows.failures:
        raise ConvergenceError(
            f"{len(rows.failures)} of {len(rows)} points cannot be computed: {rows.failures[0]}"
        )
    return [rows.numbers(name) for name in names]


def _dataset(values: Mapping[str, FloatArray], levers: Sequence[Lever]) -> xr.Dataset:
    import xarray as xr

    dims = tuple(lever.name for lever in levers)
    coordinates: dict[str, Any] = {
        lever.name: (
            lever.name,
            list(lever.values),
            {"long_name": lever.label, "units": lever.unit or NUMBER.display or "1"},
        )
        for lever in levers
    }
    if _SET in levers:
        coordinates["planets"] = (
            _SET.name, [_SETS[name][0] for name in _SETS],
            {"long_name": "number of planets", "units": "1"},
        )  # fmt: skip
    watts = {"units": WATT.display}
    return xr.Dataset(
        {
            name: (dims, array, {"long_name": name.replace("_", " "), **watts})
            for name, array in values.items()
        },
        coordinates,
    )
