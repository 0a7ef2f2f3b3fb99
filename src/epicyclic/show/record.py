"""A result with all that a report shows: every mesh, pocket and roller, shapes, inputs."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from epicyclic.build.machine import build
from epicyclic.case.case import Case
from epicyclic.losses.planet_bearing import RollerBearing
from epicyclic.result.result import Result, set_of
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
        `pocket_details` returns it, without outlines, ``"uncertainty/result"``, how well losses
        are known. Of a train with the set:
        ``"meshes/P1.sun_mesh"``.
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
        "uncertainty": lambda: _uncertainty(case, result),
        "pockets": lambda: _pockets(case, result),
    }


def _bearings(case: Case, result: Result) -> dict[str, xr.Dataset]:
    return {
        key: bearing_details(_bearing_of(case, key), figures.loads)
        for key, figures in result.bearings.items()
        if figures.loads is not None
    }


def _uncertainty(case: Case, result: Result) -> dict[str, xr.Dataset]:
    known = quick_dataset(case, result)
    return {} if known is None else {"result": known}


def _pockets(case: Case, result: Result) -> dict[str, xr.Dataset]:
    """Pockets of sets in which every mesh turns and has the flow of its pockets solved."""
    lacking = {
        set_of(key) for key, mesh in result.meshes.items() if math.isnan(mesh.pocket_pressure_max)
    }
    flowing = [key for key in result.meshes if set_of(key) not in lacking]
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
