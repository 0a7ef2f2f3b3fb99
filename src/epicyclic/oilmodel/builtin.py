"""The fitted models that come with the package, for oils whose properties are those simulated."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from epicyclic import library
from epicyclic.lubricant.oil import Oil
from epicyclic.oilmodel.model import OilModel, read_oil_model

__all__ = ["builtin_model", "changed_properties"]

_SIMULATED = (
    "kinematic_viscosity",
    "density",
    "density_slope",
    "pressure_viscosity",
    "thermal_conductivity",
    "specific_heat_capacity",
)
"""Properties that a solved contact depends on."""


def builtin_model(oil: Oil, pressure_viscosity_factor: float = 1.0) -> OilModel | None:
    """The models of a library oil; None if there are none, or the oil is not that of the library.

    Parameters
    ----------
    oil : Oil
        One that only bears the name, or of which a property was changed, has no models.
    pressure_viscosity_factor : float
        Of the case. [1]

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
    model = _of_name(oil.name)
    if model is None or changed_properties(oil, pressure_viscosity_factor):
        return None
    return model


def changed_properties(oil: Oil, pressure_viscosity_factor: float = 1.0) -> tuple[str, ...]:
    """Properties in which an oil differs from the one of its name that was simulated.

    Wherever their values are from; none if no oil of this name was.
    """
    model = _of_name(oil.name)
    if model is None:
        return ()
    own, simulated = map(_numbers, (oil, model.oil))
    changed = tuple(name for name in _SIMULATED if own[name] != simulated[name])
    return changed if pressure_viscosity_factor == 1 else (*changed, "pressure_viscosity_factor")


def _of_name(name: str) -> OilModel | None:
    file = library.oil_model_file(name)
    return None if file is None else read_oil_model(file)


@lru_cache(maxsize=64)
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
