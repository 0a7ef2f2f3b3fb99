"""Units: the one place that knows pint.

Inside, every number is SI with angles in radians and temperatures in kelvin. Outside, a dimensional
value is text with its unit, or a pint quantity; a bare number is refused. `Quantity` is the
annotation that carries, for one kind of value, its SI unit, the unit it is shown in, and its range;
parsing, JSON Schema, tables, file headers and labels all read it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Annotated, Any, cast

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

if TYPE_CHECKING:
    from pint import UnitRegistry

__all__ = [
    "Angle",
    "Density",
    "DynamicViscosity",
    "HelixAngle",
    "KinematicViscosity",
    "Length",
    "Mass",
    "Modulus",
    "Pressure",
    "PressureViscosity",
    "Quantity",
    "RotationalSpeed",
    "SmallLength",
    "Speed",
    "Temperature",
    "Torque",
    "format_number",
    "registry",
]

_NUMBER_AND_UNIT = re.compile(
    r"\s*(?P<number>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(?P<unit>.*?)\s*"
)
_MISSING_CARET = re.compile(r"(?<=[A-Za-z])(?=[23]\b)")


@cache
def registry() -> UnitRegistry[float]:
    """The unit registry, built at first use (building it is most of the cost of pint)."""
    import pint

    ureg: UnitRegistry[float] = pint.UnitRegistry(cache_folder=":auto:")
    # pint reads "Nm" as a count times a metre; every engineer means the torque.
    ureg.define("newton_metre = newton * meter = Nm")
    return ureg


def format_number(value: float, digits: int = 6) -> str:
    """`value` with up to `digits` significant digits and no trailing zeros."""
    return f"{value:.{digits}g}"


@lru_cache(maxsize=4096)
def _convert(number: float, unit: str, si: str) -> float:
    """`number` in `unit` as SI; raises what pint raises when that makes no sense."""
    ureg = registry()
    parsed = ureg.parse_units(_MISSING_CARET.sub("^", unit))
    if si == "rad/s" and not _turns(parsed):
        raise ValueError("a rate without an angle: 1/min or Hz could mean turns or radians")
    return float(ureg.Quantity(number, parsed).to(si).magnitude)


def _turns(unit: Any) -> bool:
    """True if `unit` counts an angle; pint itself takes angles as pure numbers."""
    names = {str(name) for name in registry().get_base_units(unit)[1]._units}
    return "radian" in names


@dataclass(frozen=True, slots=True)
class Quantity:
    """A kind of dimensional value: its units, its range, and how to read it.

    Attributes
    ----------
    noun : str
        What it is, for messages: ``"a length"``.
    si : str
        Unit inside the program.
    display : str
        Unit shown to the user.
    low, high : float or None
        Allowed range, in the display unit.
    open_low : bool
        True if `low` itself is not allowed.
    """

    noun: str
    si: str
    display: str
    low: float | None = None
    high: float | None = None
    open_low: bool = False

    def parse(self, value: object) -> float:
        """`value`, text with a unit or a pint quantity, as an SI number.

        Raises
        ------
        PydanticCustomError
            With the allowed form and range, when `value` is not such a quantity.
        """
        number, unit = self._split(value)
        try:
            result = _convert(number, unit, self.si)
            shown = self.to_display(result)
        except Exception as error:  # pint's own errors have no common base
            raise self._error(f"cannot be read in {self.display}", str(error)) from None
        self._check_range(shown)
        return result

    def to_display(self, value: float) -> float:
        """SI `value` in the display unit."""
        return _convert_back(value, self.si, self.display)

    def text(self, value: float, digits: int = 6) -> str:
        """SI `value` as text in the display unit, ``"139.23 mm"``."""
        return f"{format_number(self.to_display(value), digits)} {self.display}"

    def describe(self) -> str:
        """What is allowed, in words: ``"a length > 0 mm"``."""
        parts = [self.noun]
        if self.low is not None:
            sign = ">" if self.open_low else ">="
            parts.append(f"{sign} {format_number(self.low)} {self.display}")
        if self.high is not None:
            joiner = "and <=" if self.low is not None else "<="
            parts.append(f"{joiner} {format_number(self.high)} {self.display}")
        return " ".join(parts)

    def _split(self, value: object) -> tuple[float, str]:
        if isinstance(value, str):
            match = _NUMBER_AND_UNIT.fullmatch(value)
            if match is None:
                raise self._error("is not a number with a unit")
            if not match["unit"]:
                raise self._error("has no unit", f'write "{value.strip()} {self.display}"')
            return float(match["number"]), match["unit"]
        if hasattr(value, "magnitude") and hasattr(value, "units"):
            quantity = cast("Any", value)
            return float(quantity.magnitude), str(quantity.units)
        if isinstance(value, int | float) and not isinstance(value, bool):
            raise self._error("has no unit", f'write "{value} {self.display}"')
        raise self._error("is not a number with a unit")

    def _check_range(self, shown: float) -> None:
        # comparisons written so that NaN fails them
        low_ok = self.low is None or (shown > self.low if self.open_low else shown >= self.low)
        high_ok = self.high is None or shown <= self.high
        if not (low_ok and high_ok and abs(shown) < float("inf")):
            raise self._error("is out of range")

    def _error(self, what: str, remedy: str = "") -> PydanticCustomError:
        return PydanticCustomError(
            "quantity",
            "{what}: allowed is {allowed}",
            {
                "what": what,
                "allowed": self.describe(),
                "remedy": remedy or f'give a number with a unit, such as in "{self.display}"',
            },
        )

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.parse)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {
            "type": "string",
            "description": f"{self.describe()}; text with a unit",
            "x-unit": self.display,
            "pattern": r"^\s*[+-]?[0-9.]+([eE][+-]?[0-9]+)?\s*\S+.*$",
        }


@lru_cache(maxsize=4096)
def _convert_back(value: float, si: str, display: str) -> float:
    converted = float(registry().Quantity(value, si).to(display).magnitude)
    # 139.23 mm -> m -> mm must read 139.23 again, not 139.23000000000002
    return float(f"{converted:.14g}")


Length = Annotated[float, Quantity("a length", "m", "mm", low=0.0, open_low=True)]
SmallLength = Annotated[float, Quantity("a length", "m", "um", low=0.0)]
Mass = Annotated[float, Quantity("a mass", "kg", "kg", low=0.0)]
Angle = Annotated[float, Quantity("an angle", "rad", "deg")]
HelixAngle = Annotated[float, Quantity("a helix angle", "rad", "deg", low=0.0, high=45.0)]
Torque = Annotated[float, Quantity("a torque", "N*m", "N*m", low=-1e9, high=1e9)]
RotationalSpeed = Annotated[
    float, Quantity("a rotational speed", "rad/s", "rpm", low=-1e6, high=1e6)
]
Speed = Annotated[float, Quantity("a speed", "m/s", "m/s", low=0.0)]
Temperature = Annotated[float, Quantity("a temperature", "K", "degC", low=-50.0, high=250.0)]
Pressure = Annotated[float, Quantity("a pressure", "Pa", "bar", low=0.0, open_low=True)]
Modulus = Annotated[float, Quantity("a modulus", "Pa", "GPa", low=0.0, open_low=True)]
Density = Annotated[float, Quantity("a density", "kg/m^3", "kg/m^3", low=0.0, open_low=True)]
KinematicViscosity = Annotated[
    float, Quantity("a kinematic viscosity", "m^2/s", "mm^2/s", low=0.0, open_low=True)
]
DynamicViscosity = Annotated[
    float, Quantity("a dynamic viscosity", "Pa*s", "mPa*s", low=0.0, open_low=True)
]
PressureViscosity = Annotated[
    float, Quantity("a pressure-viscosity coefficient", "1/Pa", "1/GPa", low=1.0, high=60.0)
]
