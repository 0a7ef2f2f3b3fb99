"""The formats of loss maps: what each can hold, and how it is written."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.errors import InputError, Problem
from epicyclic.maps import fmu, simscape, simulation, tables, workbook
from epicyclic.maps.compute import AXES
from epicyclic.sweeps.dataset import check_place, whole_file

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["FORMATS", "check_map_output", "write_map"]

Coordinates = Mapping[str, Sequence[Any]]


@dataclass(frozen=True, slots=True)
class Format:
    """One format of a map.

    Attributes
    ----------
    suffix : str
        Ending of its files; empty if it must be asked for by name.
    about : str
        What it is.
    write : callable
        Writes a map to a file.
    problems : callable
        What of the axes of a map the format cannot hold.
    axes : tuple of str or None
        Axes that may have several values; a map then has no gaps and one member held. None: any.
    """

    suffix: str
    about: str
    write: Callable[[xr.Dataset, Path], None]
    problems: Callable[[Coordinates], list[Problem]] = lambda axes: []
    axes: tuple[str, ...] | None = None


_PLANE = ("speed", "torque")

FORMATS = {
    "netcdf": Format(".nc", "NetCDF", tables.write_netcdf),
    "csv": Format(".csv", "table of all points", tables.write_csv),
    "parquet": Format(".parquet", "table of all points", tables.write_parquet),
    "excel": Format(".xlsx", "Excel workbook", workbook.write_workbook, workbook.workbook_problems),
    "matlab": Format(".mat", "MATLAB", workbook.write_matlab),
    "vecto": Format(".vtlm", "VECTO", simulation.write_vecto, simulation.vecto_problems, _PLANE),
    "modelica": Format(
        ".mo", "Modelica", simulation.write_modelica, simulation.modelica_problems, _PLANE
    ),
    "simscape": Format(".m", "Simscape and Simulink", simscape.write_simscape, axes=tuple(AXES)),
    "fmu": Format(".fmu", "FMI 2.0", fmu.write_fmu, fmu.fmu_problems, tuple(AXES)),
    "gem": Format("", "EPA GEM", simulation.write_gem, simulation.gem_problems, _PLANE),
}


def write_map(data: xr.Dataset, path: str | Path, format: str | None = None) -> None:
    """Write a loss map to a file, whole or not at all.

    Parameters
    ----------
    data : xarray.Dataset
        As `loss_map` returns it.
    path : str or Path
    format : str, optional
        Name of the format. Default: the one that the ending of `path` names.

    Raises
    ------
    InputError
        If there is no such format, it cannot hold the map, or there is no place for the file.
    """
    target = Path(path)
    tables.check_map(data)
    axes = {name: list(data[name].values) for name in map(str, data["torque_loss"].dims)}
    chosen = check_map_output(target, format, axes, data.attrs["held_shaft"])
    if chosen.axes is not None:
        tables.check_gaps(data)
    with whole_file(target) as temporary:
        chosen.write(data, temporary)


def check_map_output(path: Path, format: str | None, axes: Coordinates, held: str) -> Format:
    """The format of `path`; raises `InputError` if a map of these axes cannot be written to it.

    `held` is the shaft that stands still, empty if there is none.
    """
    chosen = _choose(path, format)
    check_place(path)
    problems = chosen.problems(axes)
    if chosen.axes is not None:
        problems = _several(axes, chosen.axes) + problems
        if not held:
            allowed = "is driven; the format holds gears of one input and one output."
            problems.append(
                Problem("operation.second_input", "", allowed, "Set operation.fixed instead.")
            )
    if problems:
        raise InputError(problems, f"the map for {chosen.about}")
    return chosen


def _choose(path: Path, format: str | None) -> Format:
    if format is not None:
        if format in FORMATS:
            return FORMATS[format]
        problem = Problem(
            "--format", f'"{format}"', f"must be one of {', '.join(FORMATS)}.", "Choose one."
        )
        raise InputError([problem], "the command")
    by_suffix = {item.suffix: item for item in FORMATS.values() if item.suffix}
    if path.suffix in by_suffix:
        return by_suffix[path.suffix]
    problem = Problem(
        "-o",
        str(path),
        f"must end in {', '.join(by_suffix)}, or --format must be given.",
        "Choose one of these formats.",
    )
    raise InputError([problem], "the command")


def _several(axes: Coordinates, allowed: tuple[str, ...]) -> list[Problem]:
    """Axes of which the format can hold one value only."""
    return [
        Problem(
            name, "", f"has {len(values)} values; the format holds one.", "Write one file for each."
        )
        for name, values in axes.items()
        if name not in allowed and len(values) > 1
    ]
