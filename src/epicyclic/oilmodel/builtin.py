"""The fitted models that come with the package, for oils whose properties are those simulated."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

from epicyclic import library
from epicyclic.lubricant.oil import Oil
from epicyclic.oilmodel.model import OilModel, read_oil_model

_SIMULATED = (
    "kinematic_viscosity",
    "density",
    "density_slope",
    "pressure_viscosity",
    "thermal_conductivity",
    "specific_heat_capacity",
)
"""Properties that a solved contact depends on."""


def builtin_model(
    oil: Oil,  # One that only bears the name, or of which a property was changed, has no models.
) -> OilModel | None:
    """The models of a library oil; None if there are none, or the oil is not that of the library.

    `lubricant.pressure_viscosity_factor` of a case makes no other oil: the coefficient is a
    condition of every contact, and the domain of the fits tells how far it may be off.

    Examples
    --------
    >>> builtin_model(Oil(
    ...     kind="mineral",
    ...     kinematic_viscosity=[
    ...         {"temperature": "40 degC", "value": "100 mm^2/s"},
    ...         {"temperature": "100 degC", "value": "11 mm^2/s"},
    ...     ],
    ...     density=[{"temperature": "15 degC", "value": "890 kg/m^3"}],
    ...     pressure_viscosity={"law": "gold", "s": 9.904, "t": 0.139},
    ... )) is None
    True
    """
    file = library.oil_model_file(oil.name)
    if file is None or _changed(oil, file):
        return None
    return _read(file)


def changed_properties(oil: Oil) -> tuple[str, ...]:
    """Properties in which an oil differs from the one of its name that was simulated.

    Wherever their values are from; none if no oil of this name was.
    """
    file = library.oil_model_file(oil.name)
    return () if file is None else _changed(oil, file)


@lru_cache(maxsize=64)
def _changed(oil: Oil, file: Path) -> tuple[str, ...]:
    own, simulated = map(_numbers, (oil, _read(file).oil))
    return tuple(name for name in _SIMULATED if own[name] != simulated[name])


@lru_cache(maxsize=64)
def _read(file: Path) -> OilModel:
    """The model in a file that comes with the package and does not change."""
    return read_oil_model(file)


def _numbers(oil: Oil) -> dict[str, Any]:
    """What the contacts of an oil depend on."""
    numbers: dict[str, Any] = _plain(oil.model_dump(include=set(_SIMULATED)))
    return numbers


def _plain(value: Any) -> Any:
    """`value` without the sources beside its numbers."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items() if key != "source"}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return value
