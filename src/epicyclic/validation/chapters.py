"""The parametric studies and the tests of Talbot (2012), chapters 2, 3 and 5, computed again.

A figure of the source is a family of curves: a loss over one parameter, a curve for each value of a
second one, a panel for each value of a third. The studies of chapter 4 are those of
`epicyclic.pocketing_study`.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from epicyclic.arrays import FloatArray
from epicyclic.build.machine import build
from epicyclic.build.models import fluids_of
from epicyclic.dataclass import dataclass
from epicyclic.study.maps.warm_up import warm_up
from epicyclic.study.meshes import bearing_details
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.runner import HERE, Runner
from epicyclic.units import CELSIUS, unit_text
from epicyclic.validation.compare import published_figures, rows_of_all
from epicyclic.validation.compute import (
    TEST_SPEEDS,
    TEST_TORQUES,
    WITHOUT_FLOW,
    data_file,
    helical,
    planet_bearing,
    slopes,
    source_case,
)
from epicyclic.validation.pocketing import FIGURES_AGAIN

PLANETS = 3  # Planets of the set whose planet bearing chapter 3 studies.


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
    value: float  # Where it lies.
    over: float | None = None  # Where it lies; None is a line across the panel.
    panel: float | str | None = None  # In which panel; None is each of its variable.
    variable: str = ""  # Of the data; default: the first.


@dataclass(frozen=True)
class Family:
    """A figure of the source: data over (panels, curves, over), and what is published of it."""

    figure: str  # Its number in the source.
    title: str
    data: xr.Dataset  # Its variables have three dimensions, or two if one panel shows them.

    @property
    def marks(self) -> tuple[Mark, ...]:
        """The published numbers, where the data files say that they lie."""
        return tuple(
            _mark(row, mark, self.data)
            for row in published_figures()
            for mark in row.get("mark", ())
            if mark["figure"] == self.figure
        )


def _mark(row: Mapping[str, Any], given: Mapping[str, Any], data: xr.Dataset) -> Mark:
    """With `base` the number is a ratio to, or a change in % of, the computed value of a curve."""
    variable = given.get("variable", next(iter(map(str, data.data_vars))))
    drawn, value = data[variable], given.get("value", row["value"])
    over, panel = given.get("over"), given.get("panel")
    if "base" in given:
        place = dict(zip(map(str, drawn.dims), (panel, given["base"], over), strict=True))
        value = float(drawn.sel(place, method="nearest")) * (1 + value / 100)
    elif row["unit"] == "W" and drawn.attrs.get("units") == "kW":
        value /= 1e3
    label = given["label"] + (" (inferred)" if "inferred" in row and "value" not in given else "")
    return Mark(label, value, over, panel, variable)


def _key(key: str, unit: str) -> Callable[[Any], dict[str, Any]]:
    return lambda value: {key: f"{value} {unit}"}


def _speed(values: Sequence[float] = TEST_SPEEDS) -> Lever:
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

_CURVES = {
    "roughness": Lever(
        "roughness", "composite roughness", "um", tuple(_ROUGHNESS),
        lambda composite: {
            f"planet_bearing.{surface}_roughness": f"{roughness} um"
            for surface, roughness in zip(("roller", "race"), _ROUGHNESS[composite], strict=True)
        },
    ),
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
    "helix": Lever("helix_angle", "helix angle", "deg", (0, 13.124, 20, 30), helical),
}  # fmt: skip
_BEARING_STUDIES = {
    "3.4": (_TEMPERATURE, _speed((3000, 4000))),
    "3.5": (_CURVES["roughness"], _speed()),
    "3.6": (_CURVES["roller"], _speed()),
    "3.8": (_CURVES["clearance"], _speed()),
    "3.10": (_CURVES["length"], _speed()),
    "3.11": (_CURVES["helix"], _speed()),
}
"""Figures of chapter 3 over the torque on a branch: the curves and panels of each."""
ROLLER_FIGURES = {
    "3.3": (_BRANCH, (42, 100, 333)),
    "3.7": (_CURVES["roller"], _CURVES["roller"].values),
    "3.9": (_CURVES["clearance"], _CURVES["clearance"].values),
    "3.12": (_CURVES["helix"], (0, 20, 30)),
}
"""Figures of roller loads: what varies in them, and its values."""


def bearing_families(figures: Sequence[str], runner: Runner = HERE) -> list[Family]:
    """Mechanical loss of one planet bearing. Talbot (2012), section 3.4.

    Raises `ConvergenceError` if a point cannot be computed.
    """
    wanted = [figure for figure in figures if figure in _BEARING_STUDIES]
    points: list[dict[str, Any]] = []
    for figure in wanted:
        curves, panels = _BEARING_STUDIES[figure]
        points += (WITHOUT_FLOW | point for point in _points(panels, curves, _BRANCH))
    rows = rows_of_all(points, runner)
    losses = iter(rows.numbers("planet_bearing_mechanical") / PLANETS)
    families = []
    for figure in wanted:
        curves, panels = _BEARING_STUDIES[figure]
        held = "" if curves is _TEMPERATURE else f", {_oil()}"
        shape = tuple(len(lever.values) for lever in (panels, curves, _BRANCH))
        values = np.array(list(itertools.islice(losses, math.prod(shape)))).reshape(shape)
        data = _dataset({"bearing_loss": values}, (panels, curves, _BRANCH))
        data["bearing_loss"].attrs = _about("loss of one planet bearing", "W")
        families.append(Family(figure, f"loss of a planet bearing, {curves.label}{held}", data))
    return families


def _oil() -> str:
    """What the example says of its oil where nothing else is studied."""
    temperature = CELSIUS.text(fluids_of(source_case()).oil.temperature, 3)
    return f"oil at {unit_text(temperature)}"


def roller_loads_over(figure: str) -> list[tuple[str, xr.Dataset]]:
    """Loads along the rollers at the largest torque, or at the torques of Fig. 3.3.

    Returns list of (str, xarray.Dataset): what varies, and `epicyclic.study.meshes.bearing_details`
    of it.
    """
    lever, values = ROLLER_FIGURES[figure]
    found = []
    for value in values:
        case = source_case().updated(WITHOUT_FLOW | dict(lever.changes(value)))
        result = solve(case)
        assert result.bearing is not None
        assert result.bearing.loads is not None
        details = bearing_details(planet_bearing(build(case)), result.bearing.loads)
        found.append((f"{lever.label} {value:g} {unit_text(lever.unit)}", details))
    return found


def joined(cases: Sequence[tuple[str, xr.Dataset]]) -> xr.Dataset:
    """The loads of several cases as one dataset."""
    data = xr.concat([data for _, data in cases], dim="case")
    return data.assign_coords(case=[label for label, _ in cases])


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
_TORQUE = Lever(
    "torque", "torque on the sun", "N*m", (0, *TEST_TORQUES), _key("operation.torque", "N*m")
)


def loaded_and_unloaded(runner: Runner = HERE) -> xr.Dataset:
    """The 300 tests: 3 to 6 planets, shaved or polished, at all temperatures, torques and speeds.

    Raises `ConvergenceError` if a test cannot be computed.
    """
    levers = (_SET, _TEMPERATURE, _TORQUE, _speed())
    names = ("total", "load_dependent", "load_independent", "input_power")
    shape = tuple(len(lever.values) for lever in levers)
    rows = rows_of_all(_points(*levers), runner)
    return _dataset({name: rows.numbers(name).reshape(shape) for name in names}, levers)


def set_families(figures: Sequence[str], runner: Runner = HERE) -> list[Family]:
    """Losses of the whole set in the tests. Talbot (2012), sections 2.3 and 5.3.

    Raises `ConvergenceError` if a test cannot be computed.
    """
    wanted = [figure for figure in figures if figure in _OF_TESTS]
    if not wanted:
        return []
    data = loaded_and_unloaded(runner)
    return [_OF_TESTS[figure](figure, data) for figure in wanted]


def _drawn(**values: tuple[xr.DataArray, str, str]) -> xr.Dataset:
    """Named arrays with what they are and their units, without coordinates of one value."""
    found = xr.Dataset(
        {name: array.reset_coords(drop=True) for name, (array, *_) in values.items()}
    )
    for name, (_, label, unit) in values.items():
        found[name].attrs = _about(label, unit)
    return found


_TOTAL, _LOADED, _SPIN = "total loss", "load-dependent loss", "load-independent loss"
_SHAVED = list(_SETS)[:4]


def _of_one_set(figure: str, data: xr.Dataset) -> Family:
    """Losses and efficiencies at 90 degC over the speed, a curve for each torque."""
    name = dict(zip(("2.4", "2.5", "2.6", "2.7", "2.17"), _SETS, strict=True))[figure]
    own = data.sel(set=name, temperature=90)
    loaded, power = own["load_dependent"].where(own["torque"] > 0), own["input_power"]
    found = _drawn(
        total=(own["total"] / 1e3, _TOTAL, "kW"),
        load_dependent=(loaded / 1e3, _LOADED, "kW"),
        efficiency=(100 * (1 - own["total"] / power).where(own["torque"] > 0), "efficiency", "%"),
        mechanical_efficiency=(100 * (1 - loaded / power), "mechanical efficiency", "%"),
    )
    return Family(figure, f"losses of {name} planets at 90 °C", found)


def _by_planets(figure: str, data: xr.Dataset) -> Family:
    own = data["total"].sel(set=_SHAVED, temperature=90, torque=[0, 500, 1000])
    found = _drawn(total=(own.transpose("torque", "set", "speed") / 1e3, _TOTAL, "kW"))
    return Family(figure, "total loss by the number of planets, 90 °C", found)


def _by_temperature(figure: str, data: xr.Dataset) -> Family:
    name = list(_SETS)[int(figure.removeprefix("2.")) - 10]
    own = data.sel(set=name)
    found = _drawn(
        load_dependent=(own["load_dependent"].sel(torque=1000) / 1e3, f"{_LOADED}, 1000 N·m", "kW"),
        load_independent=(own["load_independent"].sel(torque=0) / 1e3, _SPIN, "kW"),
    )
    return Family(figure, f"losses of {name} planets by the oil inlet temperature", found)


def _saved(figure: str, data: xr.Dataset) -> Family:
    temperature = {"2.18": 90, "2.19": 60, "2.20": 40}[figure]
    total = data["total"].sel(temperature=temperature, torque=list(TEST_TORQUES))
    saved = total.sel(set="6 shaved") - total.sel(set="6 polished")
    found = _drawn(saved=(saved / 1e3, "loss that polished planets save", "kW"))
    return Family(figure, f"6 shaved less 6 polished planets, {temperature} °C", found)


def _spin(figure: str, data: xr.Dataset) -> Family:
    loss = data["load_independent"].sel(torque=0, set=_SHAVED)
    found = _drawn(loss=(loss.transpose("temperature", "set", "speed") / 1e3, _SPIN, "kW"))
    return Family(figure, _SPIN, found)


def _branch_spin(figure: str, data: xr.Dataset) -> Family:
    """As the tests give it, a third of the difference of six and three planets. Eq. 5.14."""
    loss = data["load_independent"].sel(torque=0)
    branch = (loss.sel(set="6 shaved") - loss.sel(set="3 shaved")) / 3
    curves = branch.expand_dims(way=["a third of 6 less 3 planets"])
    title = f"{_SPIN} of a branch"
    curves = curves.transpose("temperature", "way", "speed")
    return Family(figure, title, _drawn(loss=(curves, title, "W")))


def _loaded(figure: str, data: xr.Dataset) -> Family:
    temperature = dict(zip(("5.3", "5.4", "5.5"), _TEMPERATURE.values, strict=True))[figure]
    own = data["load_dependent"].sel(temperature=temperature, set=_SHAVED)
    own = own.sel(torque=list(TEST_TORQUES)).transpose("set", "torque", "speed") / 1e3
    title = f"{_LOADED}, shaved, {temperature} °C"
    return Family(figure, title, _drawn(loss=(own, _LOADED, "kW")))


def _polished(figure: str, data: xr.Dataset) -> Family:
    own = data["load_dependent"].sel(set="6 polished", torque=list(TEST_TORQUES)) / 1e3
    own = own.transpose("temperature", "torque", "speed")
    return Family(figure, f"{_LOADED}, 6 polished planets", _drawn(loss=(own, _LOADED, "kW")))


def _branches(figure: str, data: xr.Dataset) -> Family:
    """Loss of a branch over its power, all tests of a finish and temperature, with their lines.

    Fig. 2.9: over its torque, without lines.
    """
    number = int(figure.partition(".")[2]) - 7
    temperature = _TEMPERATURE.values[number % 3]
    own = data.sel(
        temperature=temperature,
        set=_SHAVED if number < 3 else list(_SETS)[4:],
        torque=list(TEST_TORQUES),
    )
    over = (
        (own["torque"] / own["planets"], "torque on a branch", "N*m")
        if figure == "2.9"
        else (own["input_power"] / own["planets"] / 1e3, "power of a branch", "kW")
    )
    loss = own["load_dependent"] / own["planets"] / 1e3
    found = _drawn(branch_loss=(loss, f"{_LOADED} of a branch", "kW"), over=over)
    found = found.broadcast_like(loss).transpose("speed", "set", "torque")
    finish = "shaved" if number < 3 else "chemically polished"
    if figure != "2.9":
        points = found["over"].values.ravel(), found["branch_loss"].values.ravel()
        found.attrs = {name: 100 * slope for name, slope in slopes(*points).items()}
    return Family(figure, f"loss of a branch, {finish}, {temperature} °C", found)


WARM_UPS = {"2.15": 0, "2.16": 1000}
"""Figures of temperatures over a test, and the torque on the sun. [N m]"""
AT_EACH_SPEED, STEP, CHANGE = 60.0, 10.0, 1.0
"""How long each speed is held, which is not printed: the axes of the source go to 140 to 500 s for
all four. Steps of the course, and how long a change of speed takes. [s]"""
_WARM_UP = {"planet.count": 6, "thermal.oil_volume": "1 l"}  # The volume is an estimate.


def warm_up_families(figures: Sequence[str]) -> Iterator[Family]:
    """Temperatures of six planets, ring and outlet of the oil over the speeds of a test."""
    for figure in figures:
        if figure not in WARM_UPS:
            continue
        found = []
        for temperature in _TEMPERATURE.values:
            case = source_case().updated(_WARM_UP | dict(_TEMPERATURE.changes(temperature)))
            cycle = _speed_steps(WARM_UPS[figure])
            duration = f"{cycle['time [s]'][-1]} s"
            course = warm_up(case, duration, f"{temperature} degC", cycle=cycle)
            found.append(course["temperature"].sel(node=["oil", "ring"]).drop_duplicates("time"))
        data = xr.concat(found, dim="temperature").transpose("temperature", "node", "time")
        data = data.assign_coords(
            temperature=("temperature", list(_TEMPERATURE.values), _about("oil inlet", "degC")),
            node=("node", ["outlet", "ring"], _about("temperature", "1")),
            time=("time", data["time"].values, _about("time", "s")),
        )
        drawn = _drawn(part_temperature=(data, "temperature", "degC"))
        title = f"temperatures of 6 shaved planets at {WARM_UPS[figure]} N·m"
        yield Family(figure, title, drawn)


def _speed_steps(torque: float) -> dict[str, list[float]]:
    """All speeds of the tests, one after another, as a cycle."""
    within = np.arange(0.0, AT_EACH_SPEED, STEP)
    within = np.append(within, AT_EACH_SPEED - CHANGE)
    times = np.concatenate([AT_EACH_SPEED * place + within for place in range(len(TEST_SPEEDS))])
    return {
        "time [s]": times.tolist(),
        "speed [rpm]": np.repeat(TEST_SPEEDS, within.size).tolist(),
        "torque [N*m]": [float(torque)] * times.size,
    }


_OF_TESTS: dict[str, Callable[[str, xr.Dataset], Family]] = {
    **dict.fromkeys(("2.4", "2.5", "2.6", "2.7"), _of_one_set),
    "2.8": _by_planets,
    "2.9": _branches,
    **dict.fromkeys((f"2.{number}" for number in range(10, 15)), _by_temperature),
    "2.17": _of_one_set,
    **dict.fromkeys(("2.18", "2.19", "2.20"), _saved),
    "5.1": _spin,
    "5.2": _branch_spin,
    **dict.fromkeys(("5.3", "5.4", "5.5"), _loaded),
    "5.6": _polished,
    **dict.fromkeys((f"5.{number}" for number in range(7, 13)), _branches),
}
"""Figures of chapters 2 and 5, and what makes them from the tests."""
_FIGURES = sorted(
    {*_OF_TESTS, *WARM_UPS, *ROLLER_FIGURES, *_BEARING_STUDIES, *FIGURES_AGAIN},
    key=lambda it: int(it[2:]),
)
CHAPTERS = {
    chapter: tuple(figure for figure in _FIGURES if figure.startswith(f"{chapter}."))
    for chapter in ("2", "3", "4", "5")
}
"""The figures of each chapter that are computed again."""
TOPICS = {
    "2": ("Planetary sets, tests", r"p\. \d\d\b"),
    "3": ("Planet bearings", ""),
    "4": ("Pockets", ""),
    "5": ("Planetary sets, tests", r"p\. 1\d\d\b"),
}
"""Which published numbers belong to a chapter: their topic, and a pattern of their pages."""


@dataclass(frozen=True)
class Influence:
    """What the source says of a parameter, and what is computed for it."""

    parameter: str  # With the values from which to which it varies.
    figure: str
    says: str
    source: str
    sign: int  # 1 increases, -1 reduces, 0 hardly influences.
    least: float  # Smallest and largest relative change of all that is drawn. [1]
    most: float

    @property
    def verdict(self) -> str:
        """Whether all changes have the sign that the source tells; sizes are not classed there."""
        signs = {int(np.sign(change)) for change in (self.least, self.most)}
        if self.sign == 0:
            return ""
        if self.sign in signs:
            return "sign agrees" if len(signs) == 1 else "sign differs in part"
        return "sign differs"


def influences(figure: str, data: xr.Dataset) -> Iterator[Influence]:
    """Those of a figure that was computed again."""
    for given in data_file("influences.toml")["influence"]:
        if given["figure"] != figure:
            continue
        name, parameter = given.get("variable", str(next(iter(data.data_vars)))), given["parameter"]
        drawn = data[name].sel(given.get("at", {}))
        over = drawn[parameter]
        change = drawn.isel({parameter: -1}) / drawn.isel({parameter: 0}) - 1
        ends = " to ".join(str(value) for value in over.values[[0, -1]])
        where = (f", {_named(data[key], str(at))}" for key, at in given.get("at", {}).items())
        yield Influence(
            _named(over, ends) + "".join(where),
            figure,
            given["says"],
            given["source"],
            given["sign"],
            float(change.min()),
            float(change.max()),
        )


def _named(coordinate: xr.DataArray, values: str) -> str:
    """``"face width 35 mm"``"""
    unit = unit_text(str(coordinate.attrs["units"])).removeprefix("1")
    return f"{coordinate.attrs['long_name']} {values} {unit}".rstrip()


def _points(*levers: Lever) -> Iterator[dict[str, Any]]:
    """All combinations, the last lever changing fastest."""
    for values in itertools.product(*(lever.values for lever in levers)):
        point: dict[str, Any] = {}
        for lever, value in zip(levers, values, strict=True):
            point |= lever.changes(value)
        yield point


def _dataset(values: Mapping[str, FloatArray], levers: Sequence[Lever]) -> xr.Dataset:
    dims = tuple(lever.name for lever in levers)
    coordinates: dict[str, Any] = {
        lever.name: (lever.name, list(lever.values), _about(lever.label, lever.unit or "1"))
        for lever in levers
    }
    if _SET in levers:
        planets = [count for count, _ in _SETS.values()]
        coordinates["planets"] = (_SET.name, planets, _about("number of planets", "1"))
    variables = {
        name: (dims, array, _about(name.replace("_", " "), "W")) for name, array in values.items()
    }
    return xr.Dataset(variables, coordinates)


def _about(label: str, unit: str) -> dict[str, str]:
    """The attributes of an array."""
    return {"long_name": label, "units": unit}
