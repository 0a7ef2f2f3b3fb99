"""Tables of flows through pockets in a file, with the pockets that they were made for."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from functools import lru_cache
from importlib import metadata
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from epicyclic.errors import InputError, Problem
from epicyclic.netcdf_file import read_attribute
from epicyclic.pocketing.similarity import FlowFamily
from epicyclic.pocketing.table import FlowTable
from epicyclic.text_file import sealed, unsealed

ATTRIBUTE = "flows"
"""Attribute of the NetCDF file that holds the tables as JSON."""
_KEY = "models.pocketing_table"
_REMEDY = "Make it with 'epicyclic pockets-table', or leave the key out."
_SAME = 1e-9
"""Numbers that differ less, relatively, are the same: machines round differently. [1]"""

NEGLIGIBLE = 1e-3
"""Share of the largest power of a table; what is below zero by less is numerical error. [1]"""

_Plain = bool | int | float | str | None
_Finite = Annotated[float, Field(allow_inf_nan=False)]


class _Stored(BaseModel):
    """One table. Attributes as of `FlowTable`, and the family in plain values."""

    model_config = ConfigDict(extra="forbid", ser_json_inf_nan="constants")

    family: dict[str, _Plain]
    number: list[Annotated[_Finite, Field(gt=0)]] = Field(min_length=1)
    scaled: list[Annotated[list[float], Field(min_length=5, max_length=5)]]
    readable: list[bool]
    error: Annotated[_Finite, Field(ge=0)]

    @model_validator(mode="after")
    def _fits(self) -> _Stored:
        nodes = len(self.number)
        if len(self.scaled) != nodes or len(self.readable) != nodes - 1:
            raise ValueError("numbers and figures differ in count")
        if any(np.diff(self.number) <= 0):
            raise ValueError("the numbers do not rise")
        powers = [figures[0] for figures in self.scaled]
        if np.nanmin(powers, initial=0.0) < -NEGLIGIBLE * np.nanmax(np.abs(powers), initial=0.0):
            raise ValueError("a power is below zero")
        return self


class StoredTables(BaseModel):
    """All tables of a file."""

    model_config = ConfigDict(extra="forbid", ser_json_inf_nan="constants")

    version: str
    tables: list[_Stored]


def store(tables: Mapping[FlowFamily, FlowTable]) -> str:
    """Tables as the text that a file holds."""
    stored = StoredTables(
        version=metadata.version("epicyclic"),
        tables=[
            _Stored(
                family=_plain(family),
                number=table.number.tolist(),
                scaled=table.scaled.tolist(),
                readable=table.readable.tolist(),
                error=table.error,
            )
            for family, table in tables.items()
        ],
    )
    return sealed(json.loads(stored.model_dump_json()))


def read_stored(path: Path) -> StoredTables:
    """The tables in a file.

    Raises
    ------
    InputError
        If there is no such file, or it is none of these, or of another version.
    """
    return _read(*_state(path))


def _state(path: Path) -> tuple[Path, int, int]:
    """The file, and when it was last changed."""
    try:
        stat = path.stat()
    except (OSError, ValueError) as error:
        raise _error(path, f"cannot be read: {getattr(error, 'strerror', error)}.") from None
    return path.absolute(), stat.st_mtime_ns, stat.st_size


@lru_cache(maxsize=16)
def _read(path: Path, _changed: int, _size: int) -> StoredTables:
    """The file as it was when it was last changed."""
    try:
        stored = StoredTables.model_validate(unsealed(read_attribute(path, ATTRIBUTE)))
    except InputError as error:
        raise _error(path, error.problems[0].allowed) from None
    except ValidationError as error:
        reason = error.errors(include_url=False)[0]["msg"]
        raise _error(path, f"is damaged: {reason}.") from None
    version = metadata.version("epicyclic")
    if stored.version != version:
        raise _error(path, f"was made by version {stored.version}, this is {version}.")
    return stored


def stored_table(path: Path, family: FlowFamily) -> FlowTable:
    """The table of a family of flows in a file.

    Raises
    ------
    InputError
        As for `read_stored`, and if the file has no table for these pockets; it names what differs.
    """
    return _table(*_state(path), family)


@lru_cache(maxsize=64)
def _table(path: Path, changed: int, size: int, family: FlowFamily) -> FlowTable:
    wanted = _plain(family)
    alike = [
        stored
        for stored in _read(path, changed, size).tables
        if stored.family.get("mesh.name") == family.mesh.name
        and stored.family.get("drives1") == family.drives1
    ]
    if not alike:
        raise _error(path, f"has no table of a {family.mesh.name}.")
    stored = alike[0]
    differing = [
        Problem(
            _KEY,
            str(path),
            f"was made for a {family.mesh.name} with {name} = {_shown(stored.family, name)}, "
            f"not {_shown(wanted, name)}.",
            "Make it again with 'epicyclic pockets-table', or leave the key out.",
        )
        for name in dict.fromkeys([*wanted, *stored.family])
        if not _same(wanted.get(name), stored.family.get(name))
    ]
    if differing:
        raise InputError(differing, str(path))
    return FlowTable(
        number=np.array(stored.number),
        scaled=np.array(stored.scaled),
        readable=np.array(stored.readable, dtype=np.bool_),
        error=stored.error,
        file=path.name,
    )


def _plain(family: FlowFamily) -> dict[str, _Plain]:
    """Everything that the flows of a family depend on, by dotted names, in SI."""
    return dict(_leaves("", asdict(family)))


def _leaves(name: str, value: Any) -> Iterator[tuple[str, _Plain]]:
    if isinstance(value, tuple):
        value = dict(enumerate(value, 1))
    if not isinstance(value, dict):
        yield name, value
        return
    for part, inner in value.items():
        yield from _leaves(f"{name}.{part}" if name else part, inner)


def _same(one: _Plain, other: _Plain) -> bool:
    if isinstance(one, float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=_SAME)
    return one == other


def _shown(family: Mapping[str, _Plain], name: str) -> str:
    value = family.get(name)
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def _error(path: Path, allowed: str) -> InputError:
    return InputError([Problem(_KEY, str(path), allowed, _REMEDY)], str(path))
