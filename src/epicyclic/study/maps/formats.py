"""The formats of loss maps: what each can hold, and how it is written."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.dataclass import dataclass
from epicyclic.errors import Problem, one_problem, raise_any
from epicyclic.files import check_place, whole_file
from epicyclic.registry import load, offered
from epicyclic.study.maps import tables
from epicyclic.study.operating import STATE
from epicyclic.study.sweeps.run import write_netcdf

if TYPE_CHECKING:
    import xarray as xr

Coordinates = Mapping[str, Sequence[Any]]


@dataclass(frozen=True, slots=True)
class Format:
    """One format of a map."""

    suffix: str  # Ending of its files; empty if it must be asked for by name.
    about: str  # What it is.
    write: Callable[[xr.Dataset, Path], None]  # Writes a map to a file.
    # What of the axes of a map the format cannot hold.
    problems: Callable[[Coordinates], list[Problem]] = lambda axes: []
    # Axes that may have several values; a map then has no gaps and one member held. None: any.
    axes: tuple[str, ...] | None = None
    each_state: bool = False  # True: a map of several states becomes several files.


NETCDF = Format(".nc", "NetCDF", write_netcdf)


@cache
def formats() -> Mapping[str, Format]:
    """The formats of maps, of this package and of its plug-ins, by their names."""
    own = {
        "netcdf": NETCDF,
        "csv": Format(".csv", "table of all points", tables.write_csv),
        "parquet": Format(".parquet", "table of all points", tables.write_parquet),
    }
    return own | {name: load("map_formats", name) for name in offered("map_formats")}


def write_map(data: xr.Dataset, path: str | Path, format: str | None = None) -> None:
    """Write a loss map to a file, completely or not at all.

    Parameters
    ----------
    data : xarray.Dataset
        As `loss_map` returns it.
    path : str or Path
        A format of one table of speed and torque has a file for each state of a train, its name
        with that of the state, ``gearbox-1.vtlm``.
    format : str, optional
        Name of the format. Default: the one that the ending of `path` names.

    Raises
    ------
    InputError
        If there is no such format, it cannot hold the map, or the file cannot be written there.
    """
    target = Path(path)
    tables.check_map(data)
    axes = {name: list(data[name].values) for name in map(str, data["torque_loss"].dims)}
    chosen = check_map_output(target, format, axes, data.attrs["held_shaft"])
    if chosen.axes is not None:
        tables.check_gaps(data)
    # how well a map is known stands beside it, over further dimensions
    beside = [name for name in data.dims if name not in axes]
    kept = data if chosen is NETCDF else data.drop_dims(beside)
    with ExitStack() as stack:
        for state, file in files_of_map(target, chosen, axes).items():
            part = kept.sel({STATE: [state]}) if state else kept
            chosen.write(part, stack.enter_context(whole_file(file)))


def files_of_map(path: Path, chosen: Format, axes: Coordinates) -> dict[str, Path]:
    """The files of a map by the states that they hold; a single one of all by an empty name."""
    states = [str(name) for name in axes.get(STATE, ())]
    if not chosen.each_state or len(states) < 2:
        return {"": path}
    return {
        state: path.with_name(f"{path.stem}-{re.sub(r'[^A-Za-z0-9_.+-]', '_', state)}{path.suffix}")
        for state in states
    }


def check_map_output(path: Path, format: str | None, axes: Coordinates, held: str) -> Format:
    """The format of `path`; raises `InputError` if a map of these axes cannot be written to it.

    `held` is the shaft that stands still, empty if there is none.
    """
    chosen = _choose(path, format)
    files = files_of_map(path, chosen, axes)
    for file in files.values():
        check_place(file)
    problems = chosen.problems(axes)
    if len(set(files.values())) < len(files):
        allowed = "have names that lead to the same file."
        problems.append(Problem("states", "", allowed, "Choose them one by one."))
    if chosen.axes is not None:
        several = (*chosen.axes, STATE) if chosen.each_state else chosen.axes
        counts = {name: len(it) for name, it in axes.items() if name not in several}
        remedy = "Write one file for each."
        many = [
            Problem(name, "", f"has {count} values, but the format holds one.", remedy)
            for name, count in counts.items()
            if count > 1
        ]
        problems = [*many, *problems]
        if not held:
            why = "the format covers gears with one input and one output"
            problems.append(tables.driven_problem(why))
    raise_any(problems, f"the map for {chosen.about}")
    return chosen


def _choose(path: Path, format: str | None) -> Format:
    if format is not None:
        if format in formats():
            return formats()[format]
        allowed = f"must be one of {', '.join(formats())}."
        raise one_problem("--format", f'"{format}"', allowed, "Choose one.", "the command")
    by_suffix = {item.suffix: item for item in formats().values() if item.suffix}
    if path.suffix in by_suffix:
        return by_suffix[path.suffix]
    allowed = f"must end in {', '.join(by_suffix)}, or --format must be given."
    raise one_problem("-o", str(path), allowed, "Choose one of these formats.", "the command")
