"""Maps for VECTO, Modelica, Simscape and Simulink."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.errors import Problem, printable
from epicyclic.messages import one_line
from epicyclic.study.maps.formats import Format
from epicyclic.study.maps.tables import stated
from epicyclic.study.operating import AXES, PLANE, STATE
from epicyclic.units import CELSIUS, RPM, format_number

if TYPE_CHECKING:
    import xarray as xr


# Maps as MATLAB scripts of breakpoints and tables, for blocks of Simscape and Simulink.
#
# Names and order are those of the blocks of Powertrain Blockset that look up an efficiency over
# torque, speed and temperature (MathWorks, reference page of the Gearbox block: eta_tbl over
# Trq_bpts, omega_bpts and Temp_bpts); they take efficiencies above 0 and up to 1, temperatures in
# K.


_BREAKPOINTS = {"torque": "Trq_bpts", "speed": "omega_bpts", "temperature": "Temp_bpts"}
_LEAST_EFFICIENCY = 1e-3
"""Stands for none: where the loss takes all of the power, and where there is no power."""
_DIGITS = 10
_NUMBERS_PER_LINE = 8


def write_simscape(data: xr.Dataset, path: Path) -> None:
    """Vectors Trq_bpts, omega_bpts, Temp_bpts; tables torque_loss_tbl, power_loss_tbl, eta_tbl."""
    path.write_text("\n".join(_script(data)) + "\n", encoding="utf-8")


def _script(data: xr.Dataset) -> Iterator[str]:
    order = tuple(name for name in (*_BREAKPOINTS, STATE) if name in data["torque_loss"].dims)
    yield from (f"% {name}: {text}" for name, text in stated(data, order).items())
    rpm, _ = RPM.scale_and_offset()
    _, zero = CELSIUS.scale_and_offset()
    yield from _vector("Trq_bpts", data["torque"].values, "N*m")
    yield from _vector("omega_bpts", data["speed"].values / rpm, "rad/s")
    if "temperature" in order:
        yield from _vector("Temp_bpts", data["temperature"].values - zero, "K")
    if STATE in order:
        names = (printable(str(name)).replace("'", "''") for name in data[STATE].values)
        quoted = ", ".join(f"'{name}'" for name in names)
        yield f"state_names = {{{quoted}}};"
        yield from _vector(
            "ratio", data["ratio"].values.ravel(), "of each state, input over output"
        )
    efficiency = data["efficiency"].fillna(0).clip(_LEAST_EFFICIENCY, 1)
    shaft = data["torque_loss"]
    yield from _table("torque_loss_tbl", shaft, order, "N*m, at the reference shaft")
    yield from _table("power_loss_tbl", data["total"], order, "W")
    about = f"1; {format_number(_LEAST_EFFICIENCY)} where no power is transmitted"
    yield from _table("eta_tbl", efficiency, order, about)


def _vector(name: str, values: Iterable[float], about: str) -> Iterator[str]:
    yield f"{name} = [{' '.join(format_number(value, _DIGITS) for value in values)}]; % {about}"


def _table(name: str, array: xr.DataArray, order: tuple[str, ...], about: str) -> Iterator[str]:
    """Lines that set a table over the axes `order`, the first fastest."""
    chosen = array.isel({axis: 0 for axis in array.dims if axis not in order}).transpose(*order)
    sizes = " ".join(str(chosen.sizes[axis]) for axis in order)
    over = ", ".join(_BREAKPOINTS.get(axis, "state_names") for axis in order)
    numbers = [format_number(value, _DIGITS) for value in chosen.values.ravel(order="F")]
    yield f"{name} = reshape([ ... % over {over}: {about}"
    for start in range(0, len(numbers), _NUMBERS_PER_LINE):
        yield f"    {' '.join(numbers[start : start + _NUMBERS_PER_LINE])} ..."
    yield f"], [{sizes}]);"


# Maps as vehicle and system simulations read them: one table of speed and torque.
#
# Modelica: `LossyGear` of the Modelica Standard Library takes at each speed a torque loss that is
# linear in the torque of either direction; its table is fitted to the map.


_LEAST_VECTO_ROWS = 4


def _single(data: xr.Dataset, name: str) -> FloatArray:
    """A variable over speed and torque; all other axes have one value."""
    values: FloatArray = data[name].transpose("speed", "torque", ...).values
    return values.reshape(values.shape[:2])


def _points(data: xr.Dataset, name: str) -> Iterator[tuple[float, float, float]]:
    """Speed, torque and a variable at every point."""
    values = _single(data, name)
    for i, speed in enumerate(data["speed"].values):
        for j, torque in enumerate(data["torque"].values):
            yield float(speed), float(torque), float(values[i, j])


def vecto_problems(axes: Mapping[str, Sequence[Any]]) -> list[Problem]:
    """What VECTO does not take: it needs motoring, and knows one sense of rotation."""
    problems = _negative_speeds(axes)
    if not min(axes["torque"]) < 0 < max(axes["torque"]):
        problems.append(_torques("must have negative and positive values"))
    if len(axes["speed"]) * len(axes["torque"]) < _LEAST_VECTO_ROWS:
        allowed = f"and torque must give {_LEAST_VECTO_ROWS} points or more."
        problems.append(Problem("speed", "", allowed, "Give more values."))
    return problems


def write_vecto(data: xr.Dataset, path: Path) -> None:
    """Transmission loss map (.vtlm): input speed, input torque, torque loss.

    VECTO user manual, "Transmission Loss Map": output torque = (input torque - loss) * ratio in
    both directions, the loss never negative. The one header line comes first; a comment ends it.
    """
    comment = "; ".join(f"{name}: {text}" for name, text in stated(data).items())
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write(f"Input Speed [rpm],Input Torque [Nm],Torque Loss [Nm] # {comment}\n")
        for point in _points(data, "torque_loss"):
            file.write(",".join(format_number(value, _DIGITS) for value in point) + "\n")


def gem_problems(axes: Mapping[str, Sequence[Any]]) -> list[Problem]:
    """What the table of 40 CFR 1037.565 does not have: coasting, and rotation backwards."""
    problems = _negative_speeds(axes)
    if min(axes["torque"]) < 0:
        problems.append(_torques("must not be negative"))
    return problems


def write_gem(data: xr.Dataset, path: Path) -> None:
    """Power loss in kW over input speed and torque, with the digits of 40 CFR 1037.565(g)."""
    with path.open("w", encoding="utf-8", newline="") as file:
        file.writelines(f"# {name}: {text}\n" for name, text in stated(data).items())
        file.write("Input Speed [r/min],Input Torque [N*m],Power Loss [kW]\n")
        for speed, torque, watts in _points(data, "total"):
            file.write(f"{speed:.1f},{torque:.2f},{watts / 1000:.4f}\n")


def modelica_problems(axes: Mapping[str, Sequence[Any]]) -> list[Problem]:
    """What a loss table cannot be fitted to."""
    problems = _negative_speeds(axes)
    if 0 not in axes["speed"] or len(axes["speed"]) < 2:
        allowed = "must have zero and one other value, because the table starts at rest."
        problems.append(Problem("speed", "", allowed, "Add them."))
    if not min(axes["torque"]) < 0 < max(axes["torque"]):
        problems.append(_torques("must have negative and positive values"))
    if len(axes["torque"]) < 3:
        problems.append(_torques("must have three values or more"))
    return problems


def loss_table(data: xr.Dataset) -> tuple[FloatArray, FloatArray]:
    """The table `lossTable` of LossyGear, and how far its torque loss is off that of the map.

    A row for each speed has its magnitude [rad/s], eta_mf1, eta_mf2, tau_bf1, tau_bf2 [N m]. They
    follow by least squares over all torques: tau_loss = (1 - eta_mf1) tau + tau_bf for
    tau >= 0, (1 - 1/eta_mf2) tau + tau_bf for tau < 0, with efficiencies up to 1 and one
    tau_bf >= 0 for both, so that the sign of the torque is the direction of the power.
    """
    from scipy.optimize import lsq_linear  # 40 MB that maps do without

    to_rpm, _ = RPM.scale_and_offset()
    torque = data["torque"].values
    columns = np.stack([np.maximum(torque, 0), np.maximum(-torque, 0), np.ones_like(torque)], 1)
    rows, deviations = [], []
    for speed, losses in zip(data["speed"].values, _single(data, "torque_loss"), strict=True):
        drive, coast, drag = lsq_linear(columns, losses, ([0, 0, 0], [1, np.inf, np.inf])).x
        rows.append([speed / to_rpm, 1 - drive, 1 / (1 + coast), drag, drag])
        deviations.append(columns @ [drive, coast, drag] - losses)
    return np.array(rows), np.array(deviations)


def write_modelica(data: xr.Dataset, path: Path) -> None:
    """A record with the parameters `ratio` and `lossTable` of LossyGear."""
    table, deviation = loss_table(data)
    name = _identifier(path.stem)
    i, j = np.unravel_index(np.abs(deviation).argmax(), deviation.shape)
    worst = (
        f"The table has an error of up to {abs(deviation[i, j]):.3g} N.m (at "
        f"{data['speed'].values[i]:.6g} rpm and {data['torque'].values[j]:.6g} N.m), "
        f"{np.sqrt(np.mean(deviation**2)):.3g} N.m rms"
    )
    fastest = data.isel(speed=-1).stack(point=[*data["torque_loss"].dims[1:]]).isel(point=0)
    shafts = [data.attrs["reference_shaft"], data.attrs["output_shaft"]]
    ratio = float(fastest[f"{shafts[0]}_speed"] / fastest[f"{shafts[1]}_speed"])
    rows = [", ".join(format_number(value, _DIGITS) for value in row) for row in table]
    body = ";\n    ".join(rows)
    comments = "\n".join(f"// {key}: {text}" for key, text in stated(data).items())
    path.write_text(
        f"{comments}\n"
        f"// flange_a: {one_line(shafts[0])}; flange_b: {one_line(shafts[1])}; support: "
        f"{one_line(data.attrs['held_shaft'])}\n"
        f"// {worst}.\n"
        f'record {name} "For Modelica.Mechanics.Rotational.Components.LossyGear"\n'
        f'  parameter Real ratio = {format_number(ratio, 15)} "Speed of flange_a over flange_b";\n'
        f"  parameter Real lossTable[:, 5] = [\n    {body}]\n"
        f'    "|w_a| in rad/s, eta_mf1, eta_mf2, |tau_bf1|, |tau_bf2| in N.m";\n'
        f"end {name};\n",
        encoding="utf-8",
    )


def _identifier(text: str) -> str:
    """`text` as the name of a class in Modelica; its keywords have no capital letters."""
    name = re.sub(r"\W|^(?=\d)", "_", text, flags=re.ASCII)
    return name[:1].upper() + name[1:]


def _negative_speeds(axes: Mapping[str, Sequence[Any]]) -> list[Problem]:
    if min(axes["speed"]) >= 0:
        return []
    return [Problem("speed", "", "must not be negative.", "Leave these values out.")]


def _torques(allowed: str) -> Problem:
    return Problem("torque", "", f"{allowed}.", "Give others.")


VECTO = Format(".vtlm", "VECTO", write_vecto, vecto_problems, PLANE, each_state=True)
MODELICA = Format(".mo", "Modelica", write_modelica, modelica_problems, PLANE, each_state=True)
SIMSCAPE = Format(".m", "Simscape and Simulink", write_simscape, axes=(*AXES, STATE))
GEM = Format("", "EPA GEM", write_gem, gem_problems, PLANE, each_state=True)
