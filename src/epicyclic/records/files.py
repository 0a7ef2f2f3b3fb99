"""Files of results: one NetCDF file with a group for each field, readable without this package."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from pydantic import ValidationError

from epicyclic.case.case import GearPairCase, PlanetaryCase
from epicyclic.case.wording import one_line
from epicyclic.errors import InputError, Problem
from epicyclic.records.contents import ResultContents
from epicyclic.records.record import ResultRecord, record
from epicyclic.sweeps.dataset import check_place, whole_file

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["is_stored", "open_result", "save_result"]

SUFFIX = ".nc"
FORMAT = "epicyclic result"
FORMAT_VERSION = 1
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
"""Of HDF5, in which NetCDF 4 files are kept."""
_LARGEST = 200_000_000
"""A result takes a few megabytes, a map of a million points less than this. [bytes]"""
_MOST_VARIABLES = 2000
_RUN_AGAIN = (
    "Write it again: epicyclic run CASE --save FILE.nc, or epicyclic map CASE ... -o FILE.nc."
)

_NEEDED = {
    "meshes": {
        "roll_angle": 1, "weight": 1, "transmission_error": 1, "mesh_stiffness": 1,
        "pair_load": 2, "path_position": 3, "face_position": 3, "line_load": 3,
        "hertz_pressure": 3, "sliding_speed": 3, "film_ratio": 3, "friction_coefficient": 3,
        "friction_power": 3,
    },
    "gears": {"center_x": 1, "center_y": 1, "direction": 1, "tip_diameter": 0, "root_diameter": 0,
        "base_diameter": 0, "reference_diameter": 0, "outside_diameter": 0},
    "views": {"center_x": 1, "center_y": 1, "direction": 1, "operating_radius": 1, "path_x": 1,
        "path_y": 1, "pressure_angle": 0},
    "bearings": {"azimuth": 1, "axial_position": 2, "load": 2, "line_load": 3, "pressure": 3},
}  # fmt: skip
"""Variables of each group that plots read, and their numbers of dimensions."""


def save_result(result: ResultRecord | PlanetaryCase | GearPairCase, path: str | Path) -> None:
    """Write a result with everything that reports and plots show, whole or not at all.

    Parameters
    ----------
    result : ResultRecord, PlanetaryCase or GearPairCase
        A case is solved first.
    path : str or Path
        A ``.nc`` file: NetCDF with groups, its own documentation.

    Raises
    ------
    InputError
        If there is no place for the file.
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
        "result": contents.model_dump_json(),
        "given": json.dumps(kept.given),
    }
    tree = xr.DataTree.from_dict({"/": kept.numbers.assign_attrs(attributes), **kept.fields})
    with whole_file(target) as temporary:
        tree.to_netcdf(temporary, engine="netcdf4")


def check_result_output(path: Path) -> None:
    """Raise `InputError` unless a result can be written to `path`."""
    if path.suffix != SUFFIX:
        problem = Problem("FILE", str(path), f"must end in {SUFFIX}.", f"Name it {path.stem}.nc.")
        raise InputError([problem], "the command")
    check_place(path)


def is_stored(name: str | Path) -> bool:
    """True for the name of a stored result or map, False for that of a case."""
    return Path(name).suffix.lower() == SUFFIX


def open_result(path: str | Path) -> ResultRecord | xr.Dataset:
    """Read what `save_result` or `write_map` wrote.

    Parameters
    ----------
    path : str or Path
        A ``.nc`` file.

    Returns
    -------
    ResultRecord or xarray.Dataset
        A loss map is a dataset as `loss_map` returns it.

    Raises
    ------
    InputError
        If it is no such file, is damaged, or holds too much.
    """
    source = Path(path)
    try:
        _check_file(source)
        root, fields = _read(source)
        if root.attrs.get("format") == FORMAT:
            return _record_of(root, fields)
        if "torque_loss" in root and "reference_shaft" in root.attrs:
            _check(_problems("", root, {"torque_loss": len(root["torque_loss"].dims)}))
            return root
        _refuse("is neither a stored result nor a loss map.")
    except InputError as error:
        raise InputError(error.problems, str(source)) from None


def _refuse(what: str, remedy: str = _RUN_AGAIN) -> NoReturn:
    raise InputError([Problem("", "", f"the file {what}", remedy)])


def _check(problems: Iterable[Problem]) -> None:
    found = list(problems)
    if found:
        raise InputError(found)


def _check_file(path: Path) -> None:
    try:
        if not path.is_file():
            _refuse("does not exist, or is no file.", "Check the path.")
        if path.stat().st_size > _LARGEST:
            _refuse(f"is larger than {_LARGEST // 10**6} MB.", "Name a stored result or a map.")
        with path.open("rb") as file:
            signature = file.read(len(_SIGNATURE))
    except (OSError, ValueError) as error:
        _refuse(f"cannot be read: {error}.", "Check the path.")
    if signature != _SIGNATURE:
        _refuse("is no NetCDF 4 file.")


def _read(path: Path) -> tuple[xr.Dataset, dict[str, xr.Dataset]]:
    """The root of the file and its groups by path, in memory."""
    import xarray as xr

    try:
        with xr.open_datatree(path, engine="netcdf4", decode_times=False) as tree:
            # sizes are known before anything is read, and a small file can declare a large one
            sizes = [data.nbytes for node in tree.subtree for data in node.variables.values()]
            if len(sizes) > _MOST_VARIABLES or sum(sizes) > _LARGEST:
                _refuse("holds more than a result or a map does.", "Name one of these.")
            tree.load()
            fields = {
                node.path.strip("/"): node.to_dataset(inherit=False)
                for node in tree.subtree
                if node.path != "/" and node.has_data
            }
            return tree.to_dataset(), fields
    except InputError:
        raise
    except Exception as error:  # the libraries raise what they please on damaged files
        _refuse(f"is damaged: {one_line(str(error))}.")


def _record_of(root: xr.Dataset, fields: dict[str, xr.Dataset]) -> ResultRecord:
    version = root.attrs.get("format_version")
    if version != FORMAT_VERSION:
        _refuse(f"has the format version {version}; this program reads {FORMAT_VERSION}.")
    _check(
        [
            problem
            for path, data in fields.items()
            for problem in _problems(path, data, _NEEDED.get(path.partition("/")[0], {}))
        ]
    )
    _check(_problems("", root, {}))
    try:
        return ResultRecord(
            result=ResultContents.model_validate_json(str(root.attrs["result"])),
            given=_object(str(root.attrs["given"])),
            created=str(root.attrs["created"]),
            numbers=root.drop_attrs(deep=False),
            fields=fields,
        )
    except KeyError as error:
        _refuse(f"lacks the attribute {error}.")
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(map(str, first["loc"]))
        _refuse(f"holds no sound result: {place}: {one_line(first['msg'])}.")
    except (ValueError, RecursionError) as error:
        _refuse(f"holds no sound case: {one_line(str(error))}.")


def _object(text: str) -> dict[str, Any]:
    value = json.loads(text)
    if not isinstance(value, dict):
        raise TypeError("not a table of keys")
    return value


def _problems(path: str, data: xr.Dataset, needed: Mapping[str, int]) -> Iterator[Problem]:
    """What is missing in a group, or is no labelled number with a unit."""
    for name, dims in needed.items():
        if name not in data.variables:
            yield Problem(f"{path}/{name}", "", "is missing.", _RUN_AGAIN)
        elif data[name].ndim != dims or data[name].dtype.kind != "f" or not data[name].size:
            yield Problem(f"{path}/{name}", "", f"must be numbers over {dims} axes.", _RUN_AGAIN)
    for label, array in data.variables.items():
        if array.dtype.kind == "f" and not {"long_name", "units"} <= array.attrs.keys():
            yield Problem(f"{path}/{label}", "", "has no label or no unit.", _RUN_AGAIN)
