"""Loss maps as FMUs: losses and efficiency from speed, torque, temperature and state.

FMI 2.0, for Model Exchange and Co-Simulation. `fmu.c` is compiled with the numbers of the map for
three systems at once, so that the file runs there without Python, this package or a compiler. FMPy
writes the model description and has the header files; the C compiler of Zig, which compiles for
other systems than its own, comes as a Python package too.
"""

from __future__ import annotations

import html
import os
import subprocess
import sys
import tempfile
import uuid
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from importlib import metadata
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.errors import EpicyclicError, Problem
from epicyclic.messages import one_line
from epicyclic.study.maps.compute import CAPACITY, CONDUCTANCE, SURROUNDINGS
from epicyclic.study.maps.formats import Format
from epicyclic.study.maps.tables import Lookup, make_lookup, slack, stated
from epicyclic.study.operating import AXES, PLANE, STATE
from epicyclic.units import CELSIUS, RPM, format_number

if TYPE_CHECKING:
    import xarray as xr

_LIBRARIES = ("fmpy", "ziglang")
_TARGETS = {
    "win64": ("x86_64-windows-gnu", ".dll"),
    "linux64": ("x86_64-linux-gnu.2.17", ".so"),
    "darwin64": ("x86_64-macos", ".dylib"),
}
"""Folder of FMI 2.0, target of the compiler, ending of the library."""
_OPTIONS = ("-shared", "-std=c99", "-O2", "-s", "-nostdlib", "-fno-sanitize=all", "-Wall")
_HEADERS = ("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h")
_MODEL = "loss_map"
_VARIABLES = {
    "speed": ("rad/s", "rpm", "speed of the {shaft}"),
    "torque": ("N.m", None, "torque on the {shaft}; coasting if against the speed"),
    "temperature": ("K", "degC", "oil inlet temperature"),
    SURROUNDINGS: ("K", "degC", "temperature of the heat sink"),
    STATE: ("1", None, "number of the state"),
    "torque_loss": ("N.m", None, "power loss over the magnitude of the speed of the {shaft}"),
    "power_loss": ("W", None, "loss of the whole gear set"),
    "efficiency": ("1", None, "output power over input power; 0 without output power"),
}
"""Unit, unit to be shown, and what it is, of all but the losses of components."""
_INSIDE = "inside_map"


def fmu_problems(axes: Mapping[str, Sequence[Any]]) -> list[Problem]:
    """Libraries that are not installed, and a map that ends at rest."""
    missing = [name for name in _LIBRARIES if find_spec(name) is None]
    problems = []
    if missing:
        allowed = f"needs {' and '.join(missing)}, which is not installed."
        remedy = 'Install with: python -m pip install "epicyclic[fmu]".'
        problems.append(Problem("--format", "fmu", allowed, remedy))
    if not any(axes["speed"]):
        allowed = "has only the value zero."
        problems.append(Problem("speed", "", allowed, "Give other values as well."))
    return problems


def write_fmu(data: xr.Dataset, path: Path) -> None:
    """FMI 2.0 with binaries for Windows, Linux and macOS on x86-64, and the sources."""
    lookup = make_lookup(data)
    # the same map makes the same FMU
    lumped = _lumped(data)
    content = lookup.torques.tobytes().hex() + data.attrs["case"] + str(lumped or "")
    guid = str(uuid.uuid5(uuid.NAMESPACE_OID, content))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _write_sources(folder / "sources", lookup, guid, lumped)
        _compile(folder)
        _write_description(folder / "modelDescription.xml", data, lookup, guid)
        _write_documentation(folder / "documentation", data)
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            for file in sorted(folder.rglob("*")):
                if file.is_file():
                    archive.write(file, file.relative_to(folder))


def _lumped(data: xr.Dataset) -> dict[str, float]:
    """What a temperature that follows from the losses needs; nothing if it is an input."""
    names = (CAPACITY, CONDUCTANCE, SURROUNDINGS)
    return {name: float(data.attrs[name]) for name in names if name in data.attrs}


def _write_sources(folder: Path, lookup: Lookup, guid: str, lumped: Mapping[str, float]) -> None:
    """The program, the numbers of the map, and the header files of the standard."""
    folder.mkdir()
    code = files("epicyclic.plugins.simulators").joinpath("fmu.c").read_text(encoding="utf-8")
    (folder / f"{_MODEL}.c").write_text(code, encoding="utf-8")
    (folder / "map_data.h").write_text(
        "\n".join(_map_data(lookup, guid, lumped)) + "\n", encoding="utf-8"
    )
    for header in _HEADERS:
        text = files("fmpy").joinpath("c-code", header).read_text(encoding="utf-8")
        (folder / header).write_text(text, encoding="utf-8")


def _map_data(lookup: Lookup, guid: str, lumped: Mapping[str, float]) -> Iterator[str]:
    """Lines of C that define the map, in SI units."""
    axes = _si_axes(lookup)
    counts = {
        "AXES": len(axes),
        "NODES": lookup.size,
        "COMPONENTS": len(lookup.components),
        "STATE": lookup.names.index(STATE) if STATE in lookup.names else -1,
        "TEMPERATURE": lookup.names.index("temperature") if lumped else 0,
        "HEATED": int(bool(lumped)),
    }
    yield f'#define GUID "{guid}"'
    for name, key in (("CAPACITY", CAPACITY), ("CONDUCTANCE", CONDUCTANCE)):
        yield f"#define {name} {lumped.get(key, 1.0)!r}"
    yield f"enum {{ {', '.join(f'{name} = {count}' for name, count in counts.items())} }};"
    for name, axis in zip(lookup.names, axes, strict=True):
        yield f"static const double {name}_axis[] = {{{_numbers(axis)}}};"
    names = ", ".join(f"{name}_axis" for name in lookup.names)
    yield f"static const double *const axis_values[] = {{{names}}};"
    yield f"static const int axis_sizes[] = {{{', '.join(str(axis.size) for axis in axes)}}};"
    yield f"static const double slack[] = {{{_numbers([slack(axis) for axis in axes])}}};"
    yield f"static const double start[] = {{{_numbers(_start(lookup, lumped))}}};"
    yield "static const double torque_losses[][NODES] = {"
    for torques in lookup.torques:
        yield f"    {{{_numbers(torques.ravel())}}},"
    yield "};"


def _numbers(values: Any) -> str:
    return ", ".join(repr(float(value)) for value in values)


def _si_axes(lookup: Lookup) -> list[Any]:
    """Axes in rad/s, N m, K, and numbers of states."""
    rpm, _ = RPM.scale_and_offset()
    _, zero = CELSIUS.scale_and_offset()
    axes = dict(zip(lookup.names, lookup.axes, strict=True))
    axes["speed"] = axes["speed"] / rpm
    if "temperature" in axes:
        axes["temperature"] = axes["temperature"] - zero
    return list(axes.values())


def _start(lookup: Lookup, lumped: Mapping[str, float]) -> list[float]:
    """Rest without torque, or what of the map is next to it; lowest temperature, first state.

    A temperature that follows from the losses starts as that of the surroundings.
    """
    start = [
        float(np.clip(0, axis[0], axis[-1])) if name in PLANE else float(axis[0])
        for name, axis in zip(lookup.names, _si_axes(lookup), strict=True)
    ]
    if lumped:
        start[lookup.names.index("temperature")] = lumped[SURROUNDINGS]
    return start


def _compile(folder: Path) -> None:
    """Make the libraries of all systems from the sources, without a C library."""
    with tempfile.TemporaryDirectory() as name:
        shim = Path(name) / "stdlib.h"  # the headers of FMI take from it what is in stddef.h
        shim.write_text("#include <stddef.h>\n", encoding="utf-8")
        for system, (target, ending) in _TARGETS.items():
            library = folder / "binaries" / system / f"{_MODEL}{ending}"
            library.parent.mkdir(parents=True)
            command = [sys.executable, "-m", "ziglang", "cc", "-target", target, *_OPTIONS]
            files_used = ["-I", name, "-o", library, folder / "sources" / f"{_MODEL}.c"]
            done = subprocess.run(
                [*command, *map(str, files_used)],
                cwd=name,
                # nothing is kept in the folder of the user
                env={**os.environ, "ZIG_LOCAL_CACHE_DIR": name, "ZIG_GLOBAL_CACHE_DIR": name},
                capture_output=True,
                text=True,
                check=False,
            )
            if done.returncode or not library.is_file():
                raise EpicyclicError(f"The C compiler failed for {system}: {done.stderr.strip()}")
            for extra in library.parent.iterdir():  # the linker of Windows adds some
                if extra != library:
                    extra.unlink()


def _write_description(path: Path, data: xr.Dataset, lookup: Lookup, guid: str) -> None:
    """modelDescription.xml: interfaces, units, variables, what depends on what."""
    from fmpy.model_description import (
        CoSimulation,
        DefaultExperiment,
        ModelDescription,
        ModelExchange,
        Unknown,
        write_model_description,
    )

    variables = _variables(data, lookup)
    inputs = [item for item in variables if item.causality == "input"]
    outputs = [Unknown(variable=item, dependencies=inputs) for item in variables[len(inputs) :]]
    exchange = ModelExchange(modelIdentifier=_MODEL, completedIntegratorStepNotNeeded=True)
    description = ModelDescription(
        fmiVersion="2.0",
        modelName=_MODEL,
        instantiationToken=guid,
        description=f"Losses of a gear set, from a loss map: {one_line(data.attrs['title'])}",
        version=metadata.version("epicyclic"),
        generationTool=one_line(data.attrs.get("source", "epicyclic")),
        # its temperature is integrated inside
        modelExchange=None if _lumped(data) else exchange,
        coSimulation=CoSimulation(
            modelIdentifier=_MODEL, canHandleVariableCommunicationStepSize=True
        ),
        defaultExperiment=DefaultExperiment(startTime="0", stopTime="1"),
        unitDefinitions=_units(),
        modelVariables=variables,
        outputs=outputs,
        initialUnknowns=[item for item in outputs if item.variable.initial == "calculated"],
    )
    write_model_description(description, path)


def _variables(data: xr.Dataset, lookup: Lookup) -> list[Any]:
    """Inputs, outputs in the order of the program, and whether a point is inside of the map."""
    from fmpy.model_description import ModelVariable

    axes, lumped = _si_axes(lookup), _lumped(data)
    inputs = [SURROUNDINGS if lumped and it == "temperature" else it for it in lookup.names]
    shaft = one_line(data.attrs["reference_shaft"])
    about = {
        name: _VARIABLES[name][-1].format(shaft=shaft)
        for name in (*inputs, "torque_loss", "power_loss", "efficiency")
    }
    if lookup.states:
        about[STATE] += f": {_states_text(data)}"
    about |= {name: f"loss: {name.replace('_', ' ')}" for name in lookup.components}
    if lumped:
        about["temperature"] = "temperature of the gearbox, computed from its losses"
    start = _start(lookup, lumped)
    variables = []
    for number, (name, text) in enumerate(about.items()):
        unit, shown, _ = _VARIABLES.get(name, _VARIABLES["power_loss"])
        variable = ModelVariable(
            name=name,
            valueReference=number,
            type="Real",
            description=text,
            unit=unit,
            displayUnit=shown,
            variability="continuous",
            causality="output",
            initial="calculated",
        )
        if number < len(axes):
            variable.causality, variable.initial = "input", None
            variable.start = repr(start[number])
        if number < len(axes) and name != SURROUNDINGS:
            variable.min, variable.max = (repr(float(axes[number][end])) for end in (0, -1))
        if name == STATE:
            variable.variability = "discrete"
        if lumped and name == "temperature":
            variable.initial, variable.start = "exact", repr(lumped[SURROUNDINGS])
        variables.append(variable)
    inside = ModelVariable(
        name=_INSIDE,
        valueReference=len(about),
        type="Boolean",
        variability="discrete",
        causality="output",
        initial="calculated",
        description="false: the point is outside the map and evaluated at its boundary",
    )
    return [*variables, inside]


def _states_text(data: xr.Dataset) -> str:
    """Numbers of the states with their names and ratios."""
    ratios = data["ratio"].isel({name: 0 for name in data["ratio"].dims if name != STATE})
    return "; ".join(
        f"{number} = {one_line(str(name))} (ratio {format_number(float(ratio))})"
        for number, (name, ratio) in enumerate(
            zip(data[STATE].values, ratios.values, strict=True), start=1
        )
    )


def _units() -> list[Any]:
    from fmpy.model_description import BaseUnit, DisplayUnit, Unit

    rpm, _ = RPM.scale_and_offset()
    _, zero = CELSIUS.scale_and_offset()
    return [
        Unit("rad/s", BaseUnit(rad=1, s=-1), [DisplayUnit("rpm", rpm)]),
        Unit("K", BaseUnit(K=1), [DisplayUnit("degC", 1.0, zero)]),
        Unit("N.m", BaseUnit(kg=1, m=2, s=-2)),
        Unit("W", BaseUnit(kg=1, m=2, s=-3)),
        Unit("1", BaseUnit()),
    ]


def _write_documentation(folder: Path, data: xr.Dataset) -> None:
    """The statements of the map, as a page."""
    folder.mkdir()
    rows = "".join(
        f"<dt>{html.escape(key)}</dt><dd>{html.escape(text)}</dd>\n"
        for key, text in stated(data, tuple(_VARIABLES)).items()
    )
    page = f'<!DOCTYPE html>\n<meta charset="utf-8">\n<title>Loss map</title>\n<dl>\n{rows}</dl>\n'
    (folder / "index.html").write_text(page, encoding="utf-8")


FMU = Format(".fmu", "FMI 2.0", write_fmu, fmu_problems, (*AXES, STATE))
