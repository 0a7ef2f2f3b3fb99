"""Load and pressure of every roller of a planet bearing, slice by slice, as a dataset."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from epicyclic.analysis.datasets import variable
from epicyclic.kernels.line_contact import hertz_pressure
from epicyclic.losses.planet_bearing import RollerBearing, RollerLoads
from epicyclic.units import DEGREE, GIGAPASCAL, MILLIMETRE, NEWTON, NEWTON_PER_MM

if TYPE_CHECKING:
    import xarray as xr


def bearing_details(
    bearing: RollerBearing,
    # Loads of the result, ``result.bearing.loads``, of a train ``result.bearings[...].loads``.
    loads: RollerLoads,
) -> xr.Dataset:
    """Roller loads of a bearing with units, rows, rollers and slices counted from 1.

    Returns
    -------
    xarray.Dataset
        Dimensions ``row``, ``roller``, ``slice``: ``azimuth`` of each roller from the load,
        ``axial_position`` of each slice from the middle of the bearing, ``load`` of each roller,
        ``line_load`` and ``pressure`` (inner race) of each slice.
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
            bearing.slice_positions(),
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
