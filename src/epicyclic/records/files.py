"""Files of results: one NetCDF file with a group for each field, readable without this package."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

from pydantic import BaseModel, ValidationError

from epicyclic.case.case import Case
from epicyclic.case.messages import one_line
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.files import check_place, whole_file
from epicyclic.netcdf_file import read_groups
from epicyclic.records.checks import RUN_AGAIN, field_problems, map_problems, sweep_problems
from epicyclic.records.contents import MapContents, RecordContents, SweepContents
from epicyclic.records.record import ResultRecord, record
from epicyclic.study.maps.tables import check_map

if TYPE_CHECKING:
    import xarray as xr

Stated = TypeVar("Stated", bound=BaseModel)

SUFFIX = ".nc"
FORMAT = "epicyclic result"
FORMAT_VERSION = 1


def save_result(result: ResultRecord | Case, path: str | Path) -> None:
    """Write a result with everything that reports and plots show, whole or not at all.

    Parameters
    ----------
    result : ResultRecord, PlanetaryCase, GearPairCase or TrainCase
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
        "result": contents.model_dump_json(exclude_unset=True, by_alias=True),
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
    """True for the name of a stored result, map or sweep, False for that of a case."""
    return Path(name).suffix.lower() == SUFFIX


def is_sweep(data: xr.Dataset) -> bool:
    """True for what a sweep makes, False for a loss map."""
    return "torque_loss" not in data and {"total", "status"} <= set(data.data_vars)


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
        If it is no such file, is damaged, or holds too much.
    """
    source = Path(path)
    try:
        fields = read_groups(source)
        root = fields.pop("")
        if root.attrs.get("format") == FORMAT:
            return _record_of(root, fields)
        if "torque_loss" in root and "reference_shaft" in root.attrs:
            raise_any(map_problems(root))
            _sound(MapContents, dict(root.attrs))
            check_map(root)
            return root
        if {"contribution", "nominal"} <= set(root.data_vars):
            raise_any(field_problems("uncertainty/", root))
            return root
        if is_sweep(root):
            raise_any(sweep_problems(root))
            _sound(SweepContents, dict(root.attrs))
            return root
        _refuse("is neither a stored result nor a loss map nor an uncertainty nor a sweep.")
    except InputError as error:
        raise InputError(error.problems, str(source)) from None


def open_map(path: str | Path) -> xr.Dataset:
    """Read a loss map. Parameters and errors as for `open_result`."""
    found = open_result(path)
    if isinstance(found, ResultRecord):
        problem = Problem("MAP", str(path), "is a stored result.", "Give a loss map.")
        raise InputError([problem], "the command")
    check_map(found, str(path))
    return found


def _refuse(what: str, remedy: str = RUN_AGAIN) -> NoReturn:
    raise InputError([Problem("", "", f"the file {what}", remedy)])


def _record_of(root: xr.Dataset, fields: dict[str, xr.Dataset]) -> ResultRecord:
    version = root.attrs.get("format_version")
    if version != FORMAT_VERSION:
        _refuse(f"has the format version {version}; this program reads {FORMAT_VERSION}.")
    raise_any(problem for path, data in fields.items() for problem in field_problems(path, data))
    stated = _sound(RecordContents, dict(root.attrs))
    return ResultRecord(
        result=stated.result,
        given=stated.given,
        created=str(root.attrs["created"]),
        numbers=root.drop_attrs(deep=False),
        fields=fields,
    )


def _sound(kind: type[Stated], attributes: dict[str, Any]) -> Stated:
    """The attributes of a file, checked."""
    try:
        return kind.model_validate(attributes)
    except ValidationError as error:
        raise_any(
            Problem(".".join(map(str, one["loc"])), "", f"{one_line(one['msg'])}.", RUN_AGAIN)
            for one in error.errors()
        )
        raise
