"""A result with all that a report shows: every mesh, pocket and roller, shapes, inputs."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from epicyclic.builders.build import build
from epicyclic.case.case import Case
from epicyclic.losses.planet_bearing import RollerBearing
from epicyclic.records.contents import ResultContents, contents_of, set_of
from epicyclic.results.result import Result
from epicyclic.study.bands.quick import quick_dataset
from epicyclic.study.meshes import bearing_details, mesh_details
from epicyclic.study.pockets import pocket_details
from epicyclic.study.shapes import gear_shapes, mesh_views
from epicyclic.study.solve import solve
from epicyclic.units import known_text

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ResultRecord:
    """A result and the fields behind it, as `save_result` keeps them.

    Attributes
    ----------
    result : ResultContents
        The JSON form of the result.
    given : mapping
        The case without defaults, as it was given.
    created : str
        When it was computed, ISO 8601 in UTC.
    numbers : xarray.Dataset
        Every number of the result with label and unit.
    fields : mapping of str to xarray.Dataset
        By path: ``"meshes/sun_mesh"`` as `mesh_details` returns it, ``"gears/sun"``,
        ``"views/sun_mesh"``, ``"bearings/planet_bearing"``, ``"pockets/sun_mesh"`` as
        `pocket_details` returns it, without outlines, ``"uncertainty/result"``, how well losses
        are known. Of a train with the set:
        ``"meshes/P1.sun_mesh"``.
    """

    result: ResultContents
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

    @property
    def labels(self) -> dict[str, str]:
        """What every number of the result is called, by its key."""
        return {str(key): number.attrs["long_name"] for key, number in self.numbers.items()}

    def group(self, name: str) -> dict[str, xr.Dataset]:
        """The fields whose path begins with `name`, by the rest of it."""
        return {
            path.removeprefix(f"{name}/"): data
            for path, data in self.fields.items()
            if path.startswith(f"{name}/")
        }


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class _GrowingRecord(ResultRecord):
    """A record that computes a group of fields when it is first asked for."""

    fields: dict[str, xr.Dataset]
    makers: dict[str, Callable[[], Mapping[str, xr.Dataset]]]

    def group(self, name: str) -> dict[str, xr.Dataset]:
        if name in self.makers:
            self.fields.update(_under(name, self.makers[name]()))
            del self.makers[name]
        return ResultRecord.group(self, name)  # classes with slots are made twice: no super()


def growing_record(case: Case) -> ResultRecord:
    """Solve a case, and compute each group of fields when it is first asked for.

    Returns
    -------
    ResultRecord
        Not to be saved: it has the fields that were asked for.

    Raises
    ------
    ConvergenceError
        As for `solve`, and when a group is asked for.
    """
    result = solve(case)
    contents = contents_of(result)
    makers = _makers(case, result, contents)
    return _GrowingRecord(**_head(case, result, contents), fields={}, makers=makers)


def record(
    case: Case, *, result: Result | None = None, groups: Collection[str] | None = None
) -> ResultRecord:
    """Solve a case and keep everything that reports and plots show.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
    result : Result, optional
        Result of that case, if it is solved already.
    groups : collection of str, optional
        Groups of fields to keep, of those of `ResultRecord`. Default: all.

    Returns
    -------
    ResultRecord

    Raises
    ------
    ConvergenceError
        As for `solve`.
    """
    result = solve(case) if result is None else result
    contents = contents_of(result)
    fields: dict[str, xr.Dataset] = {}
    for name, make in _makers(case, result, contents).items():
        if groups is None or name in groups:
            fields |= _under(name, make())
    return ResultRecord(**_head(case, result, contents), fields=fields)


def _makers(
    case: Case, result: Result, contents: ResultContents
) -> dict[str, Callable[[], Mapping[str, xr.Dataset]]]:
    """What computes each group of fields."""
    return {
        "gears": lambda: gear_shapes(case),
        "views": lambda: mesh_views(case),
        "bearings": lambda: _bearings(case, result),
        "meshes": lambda: _meshes(case, contents),
        "uncertainty": lambda: _uncertainty(case, result),
        "pockets": lambda: _pockets(case, contents),
    }


def _head(case: Case, result: Result, contents: ResultContents) -> dict[str, Any]:
    """What a record has beside its fields."""
    return {
        "result": contents,
        "given": json.loads(json.dumps(case.given())),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "numbers": _numbers(result),
    }


def _under(group: str, fields: Mapping[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    """The fields of a group by their paths."""
    return {f"{group}/{name}": data for name, data in fields.items()}


def _bearings(case: Case, result: Result) -> dict[str, xr.Dataset]:
    return {
        key: bearing_details(_bearing_of(case, key), figures.loads)
        for key, figures in result.bearings.items()
        if figures.loads is not None
    }


def _meshes(case: Case, contents: ResultContents) -> dict[str, xr.Dataset]:
    return mesh_details(case) if case.operation.torque != 0 and contents.meshes else {}


def _uncertainty(case: Case, result: Result) -> dict[str, xr.Dataset]:
    known = quick_dataset(case, result)
    return {} if known is None else {"result": known}


def _pockets(case: Case, contents: ResultContents) -> dict[str, xr.Dataset]:
    """Pockets of sets in which every mesh turns and has the flow of its pockets solved."""
    lacking = {
        set_of(key)
        for key, mesh in contents.meshes.items()
        if mesh["pocket_pressure_max"].value is None
    }
    flowing = [key for key in contents.meshes if set_of(key) not in lacking]
    # the outlines, for pictures of one moment, would be ten times all the rest
    pockets = pocket_details(case, flowing) if flowing else {}
    return {name: data.drop_dims("end") for name, data in pockets.items()}


def _bearing_of(case: Case, key: str) -> RollerBearing:
    """The bearing of the planets that `key` names."""
    name, _, planets = key.rpartition(".")
    found = next(one.bearing for one in build(case).sets[name].planets if one.key == planets)
    assert found is not None
    return found.bearing


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
