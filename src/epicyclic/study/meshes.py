"""Everything about the loaded meshes and planet bearings of a case, point by point."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.build.result import load_notes
from epicyclic.errors import one_problem
from epicyclic.gears.mesh import Mesh
from epicyclic.kernels.line_contact import hertz_pressure
from epicyclic.losses.contact import LineLoads
from epicyclic.losses.mesh import flash_temperatures, loss_factor_notes
from epicyclic.losses.planet_bearing import RollerBearing, RollerLoads
from epicyclic.machine.element import Fluids, joined_key
from epicyclic.machine.gear_mesh import MeshDuty, contact_under, distribute_load
from epicyclic.result.result import of_gear
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.solve import build_computed
from epicyclic.units import (
    DEGREE,
    GIGAPASCAL,
    KELVIN,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    NEWTON,
    NEWTON_PER_MM,
    NEWTON_PER_MM_MICROMETRE,
    NUMBER,
    WATT_PER_MM,
    Quantity,
)

if TYPE_CHECKING:
    import xarray as xr


Array = FloatArray | BoolArray
Variable = tuple[tuple[str, ...], Array, dict[str, Any]]


def variable(
    dims: str | tuple[str, ...], values: Array | float, label: str, unit: Quantity
) -> Variable:
    """`values`, in SI, as a variable over `dims`, for the constructor of `xarray.Dataset`."""
    scale, offset = unit.scale_and_offset()
    return (
        (dims,) if isinstance(dims, str) else dims,
        np.asarray(values) * scale + offset,
        {"long_name": label, "units": unit.display or "1"},
    )


_DIMENSIONS = ("mesh_position", "contact_line", "segment")
_points = partial(variable, _DIMENSIONS)
_positions = partial(variable, _DIMENSIONS[:1])


def mesh_details(case: CaseSource) -> dict[str, xr.Dataset]:
    """Load, pressure, sliding and friction at every point of every loaded mesh of a case.

    For a planetary set both meshes of the most loaded planet; for a train every loaded set with
    computed losses.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase

    Returns
    -------
    dict of str to xarray.Dataset
        By mesh, ``"sun_mesh"``, of a train with its set, ``"P1.sun_mesh"``. Dimensions
        ``mesh_position`` over one base pitch, ``contact_line`` (line k touches k base pitches after
        line 0) and ``segment`` along a line.
        NaN where no tooth touches or, without motion, for what depends on it. Each variable has its
        unit in ``attrs["units"]``.

    Raises
    ------
    InputError
        If the case has no torque, or is a train of given efficiencies.
    ConvergenceError
        If the load on the teeth cannot be determined.
    """
    case = as_case(case)
    if case.operation.torque == 0:
        allowed, remedy = "leaves the meshes without load.", "Give a torque other than zero."
        raise one_problem("operation.torque", "0 N*m", allowed, remedy, case.source)
    built = build_computed(case)
    notes = {name: tuple(load_notes(own)) for name, own in built.set_cases.items()}
    state = built.loaded_state()
    return {
        key: _details(case.title, key, duty, state.fluids, notes[name])
        for name, own in built.sets.items()
        for duty in own.loaded_duties(state)
        for key in (joined_key(name, duty.gears.key),)
        if not name or duty.torque1 != 0
    }


def _details(
    title: str, key: str, duty: MeshDuty, fluids: Fluids, notes: tuple[str, ...]
) -> xr.Dataset:
    import xarray as xr

    mesh = duty.gears.mesh
    loads = distribute_load(duty)
    lines = loads.lines
    pitch_angle = 2 * math.pi / mesh.gear1.teeth
    variables = {
        "weight": _positions(lines.weight, "share of the mesh period", NUMBER),
        "path_position": _points(
            lines.curvature1 - mesh.pitch_point, "path of contact from the pitch point", MILLIMETRE
        ),
        "face_position": _points(lines.face_position, "position across the face", MILLIMETRE),
        **_loads(loads, mesh.face_width),
        **_contact(duty, key, fluids, loads),
    }
    coordinates = {
        "roll_angle": _positions(
            lines.position * pitch_angle, f"roll angle {of_gear(mesh.gear1.name)}", DEGREE
        ),
        "contact_line": np.arange(lines.length.shape[1]),
    }
    words = mesh_words(key)
    attributes = {
        "title": f"{words if '.' in key else words.capitalize()} of {title or 'the case'}",
        "notes": "\n".join((*notes, *_other_programs(mesh, loads))),
        "load_distribution": duty.gears.models.load_distribution,
        "force_N": duty.force,
        "pitch_angle_deg": DEGREE.to_display(pitch_angle),
    }
    return xr.Dataset(variables, coordinates, attributes)


def _other_programs(mesh: Mesh, loads: LineLoads) -> Iterator[str]:
    """Where a user who compares with another program finds another number, and why."""
    if loads.elastic is not None:
        yield (
            "The stiffness is the theoretical one of the teeth. ISO 6336-1 multiplies it by C_M "
            "= 0.8 and by a factor of the gear blank: programs that follow it report 0.7 to 0.8 "
            "of this value."
        )
    yield (
        "The film thickness is that of smooth contacts with oil at the temperature of the case. "
        "ISO/TR 15144 uses the flank temperature, with K_A K_gamma K_v: programs that follow it "
        "state thinner ones."
    )
    yield from loss_factor_notes(mesh)


def mesh_words(key: str) -> str:
    """A mesh in words, that of a train with its set: ``"P1: sun mesh"``."""
    name, dot, mesh = key.rpartition(".")
    return f"{name}{': ' if dot else ''}{mesh.replace('_', ' ')}"


def _loads(loads: LineLoads, face_width: float) -> dict[str, Variable]:
    """What the load distribution tells."""
    lines = loads.lines
    touching = lines.length > 0
    unknown = np.full(len(lines.position), math.nan)
    elastic = loads.elastic
    error = unknown if elastic is None else elastic.transmission_error
    stiffness = unknown if elastic is None else elastic.tangent_stiffness
    return {
        "line_load": _points(
            np.where(touching, loads.line_load, math.nan), "line load", NEWTON_PER_MM
        ),
        "pair_load": variable(
            _DIMENSIONS[:2],
            (loads.line_load * lines.length).sum(axis=2),
            "normal force on the tooth pair",
            NEWTON,
        ),
        "transmission_error": _positions(error, "loaded transmission error", MICROMETRE),
        "mesh_stiffness": _positions(
            stiffness / face_width, "mesh stiffness per face width", NEWTON_PER_MM_MICROMETRE
        ),
    }


def _contact(duty: MeshDuty, key: str, fluids: Fluids, loads: LineLoads) -> dict[str, Variable]:
    """What pressure and motion add."""
    contact = contact_under(duty, loads, fluids.at(key), fluids.oil)
    loaded = (loads.lines.length > 0) & (loads.line_load > 0)

    def spread(values: FloatArray) -> FloatArray:
        field = np.full(loaded.shape, math.nan)
        field[loaded] = values
        return field

    film = friction = flash = np.full(contact.line_load.shape, math.nan)
    if duty.speed1 != 0:
        model = duty.gears.models.friction
        film, friction = contact.film_ratio, model.coefficient(contact.seen_by(model))
        flash = flash_temperatures(contact, friction, duty.gears.materials)
    power = friction * contact.line_load * np.abs(contact.sliding_speed)
    return {
        "hertz_pressure": _points(spread(contact.hertz_pressure), "contact pressure", GIGAPASCAL),
        "sliding_speed": _points(spread(contact.sliding_speed), "sliding speed", METRE_PER_SECOND),
        "film_ratio": _points(spread(film), "film ratio", NUMBER),
        "friction_coefficient": _points(spread(friction), "coefficient of friction", NUMBER),
        "flash_temperature": _points(spread(flash), "flash temperature", KELVIN),
        "friction_power": _points(spread(power), "friction power per length", WATT_PER_MM),
    }


def bearing_details(
    bearing: RollerBearing,
    # Loads of the result, ``result.bearing.loads``, of a train ``result.bearings[...].loads``.
    loads: RollerLoads,
) -> xr.Dataset:
    """Roller loads of a bearing with units, rows, rollers and slices counted from 1.

    Returns xarray.Dataset: dimensions ``row``, ``roller``, ``slice``: ``azimuth`` of each roller
    from the load, ``axial_position`` of each slice from the middle of the bearing, ``load`` of each
    roller, ``line_load`` and ``pressure`` (inner race) of each slice.
    """
    import xarray as xr

    modulus = bearing.equivalent_modulus
    pressure = hertz_pressure(
        loads.intensity, np.full_like(loads.intensity, bearing.inner_radius), modulus
    )
    dims = ("row", "roller", "slice")
    variables = {
        "azimuth": variable("roller", loads.azimuth, "azimuth of the roller from the load", DEGREE),
        "axial_position": variable(
            ("row", "slice"),
            bearing.slice_positions,
            "axial position from the middle of the bearing",
            MILLIMETRE,
        ),
        "load": variable(
            dims[:2],
            loads.intensity.sum(axis=2) * bearing.slice_width,
            "load of the roller",
            NEWTON,
        ),
        "line_load": variable(dims, loads.intensity, "line load", NEWTON_PER_MM),
        "pressure": variable(dims, pressure, "Hertz pressure, inner race", GIGAPASCAL),
    }
    counts = dict(zip(dims, loads.intensity.shape, strict=True))
    coordinates = {dim: np.arange(1, count + 1) for dim, count in counts.items()}
    return xr.Dataset(variables, coordinates, {"title": "planet bearing"})
