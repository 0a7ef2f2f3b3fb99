"""A result with all that a report shows, and the files that keep it."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Collection, Iterator, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic_core import from_json

from epicyclic.build.machine import build
from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass
from epicyclic.errors import Problem, one_problem, problems_in, raise_any
from epicyclic.files import check_place, refuse, whole_file
from epicyclic.losses.planet_bearing import RollerBearing
from epicyclic.messages import one_line
from epicyclic.netcdf_file import read_groups
from epicyclic.result.result import Result, set_of
from epicyclic.result.stored import read_result, stated_result
from epicyclic.study.bands.study import quick_dataset
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.maps.tables import check_map
from epicyclic.study.meshes import bearing_details, mesh_details
from epicyclic.study.operating import AXES
from epicyclic.study.pockets import pocket_details
from epicyclic.study.shapes import gear_shapes, mesh_views
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.run import is_sweep
from epicyclic.units import known_text

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ResultRecord:
    """A result and the fields behind it, as `save_result` keeps them.

    Attributes
    ----------
    result : Result
    given : mapping
        The case without defaults, as it was given.
    created : str
        When it was computed, ISO 8601 in UTC.
    numbers : xarray.Dataset
        Every number of the result with label and unit.
    fields : mapping of str to xarray.Dataset
        By path: ``"meshes/sun_mesh"`` as `mesh_details` returns it, ``"gears/sun"``,
        ``"views/sun_mesh"``, ``"bearings/planet_bearing"``, ``"pockets/sun_mesh"`` as
        `pocket_details` returns it, without outlines, ``"uncertainty/result"``, the uncertainty
        of the losses. In a train with the set: ``"meshes/P1.sun_mesh"``.
    """

    result: Result
    given: Mapping[str, Any]
    created: str
    numbers: xr.Dataset
    fields: Mapping[str, xr.Dataset]

    def __repr__(self) -> str:
        fields = ", ".join(self.fields)
        total = f"total loss {known_text(self.result.total)}"
        return f"<ResultRecord {self.title!r}: {total}, {self.created}; fields {fields}>"

    @property
    def title(self) -> str:
        """Title of the case, or what kind of gears it is."""
        return self.result.title or self.result.kind.replace("_", " ")

    def group(self, name: str) -> dict[str, xr.Dataset]:
        """The fields whose path begins with `name`, by the rest of it."""
        if isinstance(self.fields, _Growing):
            return self.fields.group(name)
        return {
            path.removeprefix(f"{name}/"): data
            for path, data in self.fields.items()
            if path.startswith(f"{name}/")
        }


class _Growing(Mapping[str, "xr.Dataset"]):
    """Fields by path, each group of which is computed when it is first asked for."""

    def __init__(self, makers: Mapping[str, Callable[[], Mapping[str, xr.Dataset]]]) -> None:
        self._makers = makers
        self._found: dict[str, Mapping[str, xr.Dataset]] = {}

    def group(self, name: str) -> dict[str, xr.Dataset]:
        if name not in self._found:
            self._found[name] = self._makers[name]() if name in self._makers else {}
        return dict(self._found[name])

    def __getitem__(self, path: str) -> xr.Dataset:
        group, _, name = path.partition("/")
        return self.group(group)[name]

    def __iter__(self) -> Iterator[str]:
        return (f"{group}/{name}" for group, found in self._found.items() for name in found)

    def __len__(self) -> int:
        return sum(map(len, self._found.values()))


def growing_record(case: Case) -> ResultRecord:
    """Solve a case, and compute each group of fields when it is first asked for.

    Not to be saved: it has the fields that were asked for. Raises `ConvergenceError`: As for
    `solve`, and when a group is asked for.
    """
    result = solve(case)
    return _record(case, result, _Growing(_makers(case, result)))


def record(
    case: CaseSource, *, result: Result | None = None, groups: Collection[str] | None = None
) -> ResultRecord:
    """Solve a case and keep everything that reports and plots show.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
    result : Result, optional
        Result of that case, if it is solved already.
    groups : collection of str, optional
        Groups of fields to keep, of those of `ResultRecord`. Default: all.

    Raises
    ------
    ConvergenceError
        As for `solve`.
    """
    case = as_case(case)
    result = solve(case) if result is None else result
    fields = {
        f"{group}/{name}": data
        for group, make in _makers(case, result).items()
        if groups is None or group in groups
        for name, data in make().items()
    }
    return _record(case, result, fields)


def _record(case: Case, result: Result, fields: Mapping[str, xr.Dataset]) -> ResultRecord:
    return ResultRecord(
        result=result,
        given=json.loads(json.dumps(case.given())),
        created=datetime.now(UTC).isoformat(timespec="seconds"),
        numbers=_numbers(result),
        fields=fields,
    )


def _makers(case: Case, result: Result) -> dict[str, Callable[[], Mapping[str, xr.Dataset]]]:
    """What computes each group of fields."""
    return {
        "gears": lambda: gear_shapes(case),
        "views": lambda: mesh_views(case),
        "bearings": lambda: _bearings(case, result),
        "meshes": lambda: mesh_details(case) if case.operation.torque and result.meshes else {},
        "uncertainty": lambda: (
            {} if (known := quick_dataset(case, result)) is None else {"result": known}
        ),
        "pockets": lambda: _pockets(case, result),
    }


def _bearings(case: Case, result: Result) -> dict[str, xr.Dataset]:
    found = {}
    for key, figures in result.bearings.items():
        if figures.loads is not None:
            name, _, planets = key.rpartition(".")
            own = next(one.bearing for one in build(case).sets[name].planets if one.key == planets)
            assert own is not None
            assert isinstance(own.bearing, RollerBearing)
            found[key] = bearing_details(own.bearing, figures.loads)
    return found


def _pockets(case: Case, result: Result) -> dict[str, xr.Dataset]:
    """Pockets of sets in which every mesh turns and has the flow of its pockets solved."""
    lacking = {
        set_of(key) for key, mesh in result.meshes.items() if math.isnan(mesh.pocket_pressure_max)
    }
    flowing = [key for key in result.meshes if set_of(key) not in lacking]
    # the outlines, for pictures of one moment, would be ten times all the rest
    pockets = pocket_details(case, flowing) if flowing else {}
    return {name: data.drop_dims("end") for name, data in pockets.items()}


def sets_of(fields: Mapping[str, xr.Dataset]) -> dict[str, dict[str, xr.Dataset]]:
    """Fields of a group by their set, and in each without its name."""
    found: dict[str, dict[str, xr.Dataset]] = {}
    for key, data in fields.items():
        found.setdefault(set_of(key), {})[key.rpartition(".")[2]] = data
    return found


def _numbers(result: Result) -> xr.Dataset:
    import xarray as xr

    return xr.Dataset(
        {
            item.key: ((), item.value, {"long_name": item.label, "units": item.unit})
            for item in result.numbers()
        }
    )


# Checks of what a file holds, so that reports and plots can rely on it.

RUN_AGAIN = (
    "Write it again: epicyclic run CASE --save FILE.nc, or epicyclic map CASE ... -o FILE.nc."
)
MOST_TEETH = 5000
LARGEST_VALUE = 1e12  # No number of a gear set is larger, in the units that users see.
_ROUNDING = 1e-9
_LIMITS = {
    "total": (0.0, LARGEST_VALUE),
    "torque_loss": (0.0, LARGEST_VALUE),
    "efficiency": (-LARGEST_VALUE, 1.0 + _ROUNDING),
}
"""Limits of numbers that have others than these in a map or a sweep."""

_MESH = ("mesh_position", "contact_line", "segment")
_POCKET = ("tooth", "roll")

_NEEDED: dict[str, Mapping[tuple[str, ...], str]] = {
    "meshes": {
        _MESH[:1]: "roll_angle weight transmission_error mesh_stiffness",
        _MESH[:2]: "pair_load",
        _MESH: "path_position face_position line_load hertz_pressure sliding_speed film_ratio "
        "friction_coefficient friction_power",
    },
    "gears": {
        ("place",): "center_x center_y direction",
        (): "reference_diameter base_diameter tip_diameter root_diameter outside_diameter",
    },
    "views": {
        ("gear",): "center_x center_y direction operating_radius",
        ("end",): "path_x path_y",
        (): "pressure_angle",
    },
    "bearings": {
        ("roller",): "azimuth",
        ("row", "slice"): "axial_position",
        ("row", "roller"): "load",
        ("row", "roller", "slice"): "line_load pressure",
    },
    "pockets": {
        _POCKET: "roll_angle volume",
        (*_POCKET, "slice"): "pressure contact_gap_speed backlash_gap_speed",
        (*_POCKET, "station"): "end_area contact_gap backlash_gap axial_speed",
        ("mesh_position",): "period_angle instant_power",
        ("slice",): "slice_position",
        ("station",): "station_position",
        (): "power",
    },
    "uncertainty": {
        ("result",): "nominal mean standard_uncertainty expanded_uncertainty low high shortest_low "
        "shortest_high",
        ("input", "result"): "contribution",
        ("sum", "driver"): "first_order",
        ("result", "sample"): "value",
        ("input",): "input_value input_uncertainty cut_off",
    },
}
"""Numbers that plots read in each group, by their dimensions."""
_ATTRIBUTES: dict[str, tuple[tuple[str, type], ...]] = {
    "meshes": (("title", str), ("pitch_angle_deg", float)),
    "gears": (("name", str),),
    "uncertainty": (("title", str), ("grouping", str), ("left_out", str), ("remarks", str)),
}
_UNCERTAINTY_TEXTS = {
    "result": "result unit",
    "input": "input input_unit input_name input_advice distribution distribution_source",
    "driver": "driver",
    "sum": "sum",
}
"""Texts that tables of an uncertainty show, by their dimension."""
_MAY_LACK = {"meshes", "pockets", "uncertainty"}
"""Groups with NaN where nothing touches, or no pocket is; but places are known everywhere."""
_PLACES = {
    "roll_angle",
    "weight",
    "path_position",
    "face_position",
    "slice_position",
    "station_position",
    "period_angle",
}
_TEXTS = ("status", "message", "warnings")


def field_problems(path: str, data: xr.Dataset) -> Iterator[Problem]:
    """What plots would miss in one field of a result."""
    group = path.partition("/")[0]
    if group not in _NEEDED:
        return  # of a later version
    for dims, names in _NEEDED[group].items():
        for variable in names.split():
            yield from _number_problems(f"{path}/{variable}", data, variable, dims)
            if group not in _MAY_LACK or variable in _PLACES:
                yield from _value_problems(f"{path}/{variable}", data, variable)
    yield from _label_problems(path, data)
    for attribute, kind in _ATTRIBUTES.get(group, ()):
        if not isinstance(data.attrs.get(attribute), kind):
            yield Problem(f"{path}/{attribute}", "", "is missing.", RUN_AGAIN)
    if group == "gears":
        yield from _gear_problems(path, data)
    if group == "uncertainty":
        yield from _uncertainty_problems(path, data)


def map_problems(data: xr.Dataset) -> Iterator[Problem]:
    """What plots and reports would miss in a loss map."""
    dims = data["torque_loss"].dims
    for axis in AXES:
        if axis == "temperature" and axis not in data.coords:
            continue  # a train whose losses are all given has no oil
        if axis not in dims:
            yield Problem(axis, "", "is not an axis of the map.", RUN_AGAIN)
        else:
            yield from _number_problems(axis, data, axis, (axis,))
    yield from _point_problems(data, "torque_loss", "total", "efficiency")


def _point_problems(data: xr.Dataset, first: str, *others: str) -> Iterator[Problem]:
    """Numbers over all points of a map or sweep, what these say of themselves, and labels."""
    dims = tuple(map(str, data[first].dims))
    for name in (first, *others):
        yield from _number_problems(name, data, name, dims)
    for name in _TEXTS:
        if name not in data or data[name].dtype.kind not in "OU":
            yield Problem(name, "", "must have a text for every point.", RUN_AGAIN)
    yield from _label_problems("", data)


def sweep_problems(data: xr.Dataset) -> Iterator[Problem]:
    """What plots would miss in a sweep."""
    for dim in map(str, data["total"].dims):
        if dim not in data.coords or data[dim].dtype.kind not in "fiuOU":
            yield Problem(dim, "", "must be numbers or names.", RUN_AGAIN)
    yield from _point_problems(data, "total", "efficiency")


def _number_problems(
    place: str, data: xr.Dataset, name: str, dims: tuple[str, ...]
) -> Iterator[Problem]:
    if name not in data.variables:
        yield Problem(place, "", "is missing.", RUN_AGAIN)
        return
    array = data[name]
    if array.dtype.kind != "f" or set(array.dims) != set(dims) or not array.size:
        over = f"over {', '.join(dims)}" if dims else "alone"
        yield Problem(place, "", f"must be numbers {over}.", RUN_AGAIN)
        return
    low, high = _LIMITS.get(name, (-LARGEST_VALUE, LARGEST_VALUE))
    values = array.to_numpy()
    if (values > high).any():
        yield Problem(place, "", f"must not exceed {high:g}.", RUN_AGAIN)
    if (values < low).any():
        yield Problem(place, "", f"must not be below {low:g}.", RUN_AGAIN)


def _value_problems(place: str, data: xr.Dataset, name: str) -> Iterator[Problem]:
    """Where numbers are known everywhere; diameters and radii are lengths."""
    if name not in data.variables or data[name].dtype.kind != "f":
        return
    values = data[name].to_numpy()
    if np.isnan(values).any():
        yield Problem(place, "", "must not have missing values.", RUN_AGAIN)
    if name.endswith(("diameter", "radius")) and (values <= 0).any():
        yield Problem(place, "", "must be positive.", RUN_AGAIN)


def _label_problems(path: str, data: xr.Dataset) -> Iterator[Problem]:
    for name, array in data.variables.items():
        labels = (array.attrs.get("long_name"), array.attrs.get("units"))
        if array.dtype.kind == "f" and not all(isinstance(label, str) for label in labels):
            yield Problem(f"{path}/{name}", "", "has no label or no unit.", RUN_AGAIN)


def _gear_problems(path: str, data: xr.Dataset) -> Iterator[Problem]:
    """Teeth are counted, and drawn one by one."""
    teeth, internal = (data.attrs.get(name) for name in ("teeth", "internal"))
    if internal not in (0, 1):
        yield Problem(f"{path}/internal", str(internal), "must be 0 or 1.", RUN_AGAIN)
    if not isinstance(teeth, int | np.integer) or not 1 <= teeth <= MOST_TEETH:
        allowed = f"must be a whole number from 1 to {MOST_TEETH}."
        yield Problem(f"{path}/teeth", str(teeth), allowed, RUN_AGAIN)
    for name in ("x", "y"):
        if name in data:
            yield from _number_problems(f"{path}/{name}", data, name, ("point",))
            yield from _value_problems(f"{path}/{name}", data, name)


def _uncertainty_problems(path: str, data: xr.Dataset) -> Iterator[Problem]:
    """Names are text, all that tables look for among them."""
    for dim, names in _UNCERTAINTY_TEXTS.items():
        for name in names.split():
            if name not in data.variables or data[name].dims != (dim,):
                yield Problem(f"{path}/{name}", "", f"is missing for every {dim}.", RUN_AGAIN)
            elif data[name].dtype.kind not in "OU":
                yield Problem(f"{path}/{name}", "", "must be text.", RUN_AGAIN)
    known = data["result"].values if "result" in data.variables else ()
    lacking = {"total", "efficiency", "load_dependent", "load_independent"} - set(map(str, known))
    if lacking:
        yield Problem(f"{path}/result", "", f"lacks {', '.join(sorted(lacking))}.", RUN_AGAIN)
    if not isinstance(data.attrs.get("failed"), int | np.integer):
        yield Problem(f"{path}/failed", "", "must be a number.", RUN_AGAIN)


# Files of results: one NetCDF file with a group for each field, readable without this package.

SUFFIX = ".nc"
FORMAT = "epicyclic result"
FORMAT_VERSION = 1


def save_result(result: ResultRecord | CaseSource, path: str | Path) -> None:
    """Write a result with everything that reports and plots show, completely or not at all.

    Parameters
    ----------
    result : ResultRecord, PlanetaryCase, GearPairCase or TrainCase
        A case is solved first.
    path : str or Path
        A ``.nc`` file: NetCDF with groups, its own documentation.

    Raises
    ------
    InputError
        If the file cannot be written there.
    """
    import xarray as xr

    target = Path(path)
    check_result_output(target)
    kept = result if isinstance(result, ResultRecord) else record(result)
    contents = kept.result
    attributes = {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "title": contents.title,
        "source": f"epicyclic {contents.versions.get('epicyclic', '')}",
        "created": kept.created,
        "conventions": "losses in W of the whole gear set, summed over planets; attribute result: "
        "the result as JSON; attribute given: the case as it was given; groups: meshes, planet "
        "bearing, shapes",
        "result": json.dumps(stated_result(contents), allow_nan=False, ensure_ascii=False),
        "given": json.dumps(kept.given),
    }
    tree = xr.DataTree.from_dict({"/": kept.numbers.assign_attrs(attributes), **kept.fields})
    with whole_file(target) as temporary:
        tree.to_netcdf(temporary, engine="netcdf4")


def check_result_output(path: Path) -> None:
    """Raise `InputError` unless a result can be written to `path`."""
    if path.suffix != SUFFIX:
        allowed, remedy = f"must end in {SUFFIX}.", f"Name it {path.stem}.nc."
        raise one_problem("FILE", str(path), allowed, remedy, "the command")
    check_place(path)


def is_stored(name: str | Path) -> bool:
    """True for the name of a stored result, map or sweep, False for that of a case."""
    return Path(name).suffix.lower() == SUFFIX


def open_result(path: str | Path) -> ResultRecord | xr.Dataset:
    """Read what `save_result`, `write_map`, 'epicyclic sweep' or 'epicyclic uncertainty' wrote.

    Parameters
    ----------
    path : str or Path
        A ``.nc`` file.

    Returns
    -------
    ResultRecord or xarray.Dataset
        A loss map is a dataset as `loss_map` returns it, a sweep as `sweep`, an uncertainty as
        `uncertainty`.

    Raises
    ------
    InputError
        If it is not such a file, is damaged, or is too large.
    """
    source = Path(path)
    with problems_in(str(source)):
        fields = read_groups(source)
        root = fields.pop("")
        if root.attrs.get("format") == FORMAT:
            return _record_of(root, fields)
        if "torque_loss" in root and "reference_shaft" in root.attrs:
            raise_any(map_problems(root))
            raise_any(_attribute_problems(root.attrs, "reference_shaft"))
            check_map(root)
            return root
        if {"contribution", "nominal"} <= set(root.data_vars):
            raise_any(field_problems("uncertainty/", root))
            return root
        if is_sweep(root):
            from epicyclic.study.sweeps.names import with_plain_names

            root = with_plain_names(root)
            raise_any(sweep_problems(root))
            raise_any(_attribute_problems(root.attrs))
            return root
        allowed = "is neither a stored result nor a loss map nor an uncertainty nor a sweep."
        return refuse(allowed, RUN_AGAIN)


def open_map(path: str | Path) -> xr.Dataset:
    """Read a loss map. Parameters and errors as for `open_result`."""
    found = open_result(path)
    if isinstance(found, ResultRecord):
        allowed, remedy = "is a stored result.", "Give a loss map."
        raise one_problem("MAP", str(path), allowed, remedy, "the command")
    check_map(found, str(path))
    return found


def _record_of(root: xr.Dataset, fields: dict[str, xr.Dataset]) -> ResultRecord:
    version = root.attrs.get("format_version")
    if version != FORMAT_VERSION:
        refuse(f"has the format version {version}; this program reads {FORMAT_VERSION}.", RUN_AGAIN)
    raise_any(problem for path, data in fields.items() for problem in field_problems(path, data))
    stated = dict(root.attrs)
    problems: list[Problem] = []
    try:
        datetime.fromisoformat(stated.get("created", ""))
    except (TypeError, ValueError) as error:
        problems.append(_problem("created", f"Input should be a valid datetime, {error}"))
    result = None
    content = _read_json(stated, "result", problems)
    if content is not None:
        result, found = read_result(content, _wrong_inputs)
        problems += (_problem(".".join(filter(None, ("result", *it[:1]))), it[1]) for it in found)
    given = _read_json(stated, "given", problems)
    raise_any(problems)
    assert result is not None
    return ResultRecord(result, given, stated["created"], root.drop_attrs(deep=False), fields)


def _problem(place: str, what: str) -> Problem:
    return Problem(place, "", f"{one_line(what)}.", RUN_AGAIN)


def _read_json(stated: Mapping[str, Any], name: str, problems: list[Problem]) -> Any:
    """The table that an attribute holds as JSON text."""
    if name not in stated:
        problems.append(_problem(name, "Field required"))
        return None
    try:
        found = from_json(str(stated[name]))
    except ValueError as error:  # also if it is nested too deep
        problems.append(_problem(name, str(error)))
        return None
    if isinstance(found, dict):
        return found
    problems.append(_problem(name, "Input should be a valid dictionary"))
    return None


def _attribute_problems(stated: Mapping[str, Any], *more: str) -> Iterator[Problem]:
    """What reports would miss in the attributes of a map or sweep."""
    for name in ("title", "source", *more):
        if not isinstance(stated.get(name), str):
            what = "Input should be a valid string" if name in stated else "Field required"
            yield _problem(name, what)
    problems: list[Problem] = []
    case = _read_json(stated, "case", problems)
    versions = _read_json(stated, "versions", problems)
    yield from problems
    if case is not None and (wrong := _wrong_inputs(case)):
        yield _problem("case", wrong)
    if versions is not None and not isinstance(versions.get("epicyclic"), str):
        yield _problem("versions", "must name the version of epicyclic")


def _wrong_inputs(inputs: Mapping[str, Any]) -> str:
    """Why inputs are not those of a case with its operating point as text; empty if they are."""
    if inputs.get("kind") not in ("planetary", "gear_pair", "train"):
        return "must name the kind of the case"
    operation = inputs.get("operation")
    keys = [key.rpartition(".")[2] for key in AXES.values()]
    if inputs["kind"] == "train":
        keys = ["speed", "torque", "input", "output"]
    if not isinstance(operation, dict) or not all(isinstance(operation.get(k), str) for k in keys):
        return f"must state operation with {', '.join(keys)}"
    return ""
