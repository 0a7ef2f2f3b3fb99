"""Units: the one place that knows pint.

Inside, every number is SI with angles in radians and temperatures in kelvin. Outside, a dimensional
value is text with its unit, or a pint quantity; a bare number is refused. `Quantity` is the
annotation that carries, for one kind of value, its SI unit, the unit it is shown in, and its range;
parsing, JSON Schema, tables, file headers and labels all read it. `Number` marks the keys that have
no dimension.
"""

from __future__ import annotations

import math
import re
import sys
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from epicyclic.dataclass import dataclass

if TYPE_CHECKING:
    from pint import Unit, UnitRegistry

KILO = 10_000.0
"""Watts and newton metres are shown in thousands from here on: no more digits than are known."""
PLAIN_NUMBERS = 1e7  # Numbers from here on are shown with a power of ten.

_LONGEST_TEXT = 100
"""A number with a unit takes a few characters; longer text is not searched for one."""

_NUMBER_AND_UNIT = re.compile(
    r"(?P<number>[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(?P<unit>.*)", re.DOTALL
)
_MORE_DIGITS = re.compile(r"[.,'’]|\d{3}(?![\d/])")
"""What follows a number that has marks between its digits."""
_DECIMAL_COMMA = re.compile(r"[+-]?[0-9]+,[0-9]+")
_MARKED = re.compile(r"[+-]?\d[\d.,'’\s]*(?<!\s)(?:[eE][+-]?\d+)?(?![eE.,'’\d])")
_GROUPED = {
    mark: re.compile(
        rf"[+-]?(?:[1-9]\d{{0,2}}(?:[{other}'’\s]\d{{3}})+|\d*)(?:[{mark}]\d*)?(?:[eE][+-]?\d+)?"
    )
    for mark, other in (".,", ",.")
}
"""Numbers by their decimal mark; the other one, blanks and apostrophes divide thousands."""

# Units as they are often written and not read, by what they are here: without blanks and signs
# between, in small letters. What they measure says whether they are meant.
_SPELLINGS = {
    **dict.fromkeys(("lbft", "ftlb", "ftlbs", "lbsft", "lbfft", "ftlbf"), "lbf*ft"),
    **dict.fromkeys(("lbin", "inlb", "inlbs", "lbsin", "lbfin", "inlbf"), "lbf*in"),
    **dict.fromkeys(("kgm", "kpm", "kgfm"), "kgf*m"),
    **dict.fromkeys(('"', "''", "”", "″", "zoll"), "in"),
    **dict.fromkeys(("f", "degf", "°f", "ºf", "fahrenheit"), "degF"),
    **dict.fromkeys(("c", "degc", "°c", "ºc", "celsius"), "degC"),
    **dict.fromkeys(("u/min", "upm", "r/min", "1/min"), "rpm"),
    "nm": "N*m",
    "knm": "kN*m",
    "ps": "metric_horsepower",
    "kp": "kgf",
}

# Other ways to write the same sign: middle dots and crosses, superscripts, minus, Greek mu.
_PLAIN_SIGNS = str.maketrans(
    {"·": "*", "⋅": "*", "×": "*", "−": "-", "μ": "µ", "⁻": "-", "¹": "1", "²": "2", "³": "3"}
)

# Products and quotients of names with one-digit exponents, none of them zero. Anything else is kept
# from pint, which evaluates what it is given: 9**9**9 would never end.
_NAME = r"(?:[^\W\d]*°?[^\W\d]+|[°%'\"])"
_EXPONENT = r"(?:\s*(?:\^|\*\*)?\s*[+-]?[1-9](?!\s*(?:[0-9.^]|\*\*)))"
_FACTOR = rf"\(?\s*{_NAME}{_EXPONENT}?\s*\)?"
_UNIT = re.compile(rf"(?:1?\s*/\s*)?{_FACTOR}(?:(?:\s*[*/]\s*|\s+){_FACTOR})*")
_MISSING_CARET = re.compile(r"(?<=[^\W\d])(?=[+-]?[0-9])")


# Size of common units in SI; pint, which takes a sixth of a command to import, has all others.
_SIZES = {
    **dict.fromkeys((("mm", "m"), ("mPa*s", "Pa*s"), ("g", "kg"), ("mN*m", "N*m")), 1e-3),
    **dict.fromkeys((("um", "m"), ("mm^2", "m^2"), ("mm^2/s", "m^2/s")), 1e-6),
    **dict.fromkeys((("nm", "m"), ("mm^3", "m^3"), ("1/GPa", "1/Pa")), 1e-9),
    **dict.fromkeys((("kN", "N"), ("N/mm", "N/m"), ("W/mm", "W/m"), ("kJ", "J"), ("kW", "W")), 1e3),
    **dict.fromkeys((("kN*m", "N*m"), ("kNm", "N*m")), 1e3),
    **dict.fromkeys((("MPa", "Pa"), ("N/um", "N/m"), ("MN*m", "N*m"), ("MW", "W")), 1e6),
    **dict.fromkeys((("GPa", "Pa"), ("N/(mm*um)", "N/m^2")), 1e9),
    ("Nm", "N*m"): 1.0,
    ("l", "m^3"): 1.0000000000000002e-3,
    ("bar", "Pa"): 1e5,
    ("deg", "rad"): math.pi / 180,
    ("rpm", "rad/s"): math.tau / 60,
    ("l/min", "m^3/s"): 1.666666666666667e-05,
}
_ICE = 273.15  # [K]


@cache
def registry() -> UnitRegistry[float]:
    """The unit registry, built at first use (building it is most of the cost of pint)."""
    import pint

    from epicyclic.cache_folder import private_folder  # needed where pint is

    ureg: UnitRegistry[float]
    try:
        # pint's own folder, which holds pickles, is trusted by pint whoever may write to it
        ureg = pint.UnitRegistry(cache_folder=private_folder("units"))
    except Exception:  # the cache is damaged, or another process is just writing it
        ureg = pint.UnitRegistry()
    # pint reads "Nm" as a count times a metre; every engineer means the torque.
    ureg.define("newton_metre = newton * meter = Nm")
    ureg.define("@alias turn = rev")
    return ureg


def format_number(value: float, digits: int = 6) -> str:
    """`value` with up to `digits` significant digits and no trailing decimal zeros.

    Without a power of ten from 1e-4 up to `PLAIN_NUMBERS`: ``"14600"``, not ``"1.46e+04"``.
    """
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e+" in text and abs(value) < PLAIN_NUMBERS else text


def efficiency_text(*values: float, ends: tuple[float, float]) -> str:
    """Efficiencies in percent with the decimals that the band between `ends` leaves."""
    width = 100 * abs(ends[1] - ends[0])
    decimals = min(6, max(1, 1 - math.floor(math.log10(width)))) if width > 0 else 3
    return f"{' to '.join(f'{100 * value:.{decimals}f}' for value in values)} %"


def percent(share: float, decimals: int = 1, *, signed: bool = False) -> str:
    """A share of one as tables and sentences have it, ``"7.3 %"``."""
    return f"{100 * share:{'+' if signed else ''}z.{decimals}f} %"


def decimals_of(total: float) -> int:
    """Decimals of powers beside their `total`: models are not known to more than three digits."""
    return min(3, max(0, 2 - math.floor(math.log10(total)))) if total > 0 else 0


def large_unit(largest: float, unit: str) -> tuple[str, float]:
    """The unit in print for values in `unit` up to the `largest`, and its size.

    Watts and newton metres have a prefix once they are many.
    """
    for prefix, size in (("G", 1e9), ("M", 1e6), ("k", 1e3)):
        if unit in ("W", "N*m") and abs(largest) >= size * KILO / 1e3:
            return f"{prefix}{unit_text(unit)}", size
    return unit_text(unit), 1.0


def part_text(part: float, total: float, decimals: int) -> str:
    """A part of a `total`; one that would read 0 beside a share that does not has two digits."""
    if part and 5e-4 * abs(total) <= abs(part) < 0.5 / 10**decimals:
        decimals = 1 - math.floor(math.log10(abs(part)))
    return f"{part:z.{decimals}f}"


def power_unit(power: float) -> tuple[str, float]:
    """The unit in which a `power` is shown, and its size. [W]"""
    return large_unit(power, WATT.display)


def known_text(*values: float, unit: str = "W", beside: float = 0.0) -> str:
    """Losses as a sentence has them, with the unit and the decimals of the largest of them.

    One that stands `beside` them counts too.
    """
    largest = max(abs(beside), *map(abs, values))
    shown_unit, size = large_unit(largest, unit)
    decimals = decimals_of(largest / size)
    return f"{' to '.join(f'{value / size:z.{decimals}f}' for value in values)} {shown_unit}"


def torque_text(torque: float, digits: int = 6) -> str:
    """A `torque` with its unit, for sentences and pictures. [N*m]"""
    unit, size = large_unit(torque, NEWTON_METRE.display)
    return f"{format_number(torque / size, digits)} {unit}"


def celsius_text(temperature: float, digits: int = 6) -> str:
    """A `temperature` as a sentence has it; a case file has degC. [K]"""
    return unit_text(CELSIUS.text(temperature, digits))


def describe_range(
    noun: str, low: float | None, high: float | None, unit: str = "", *, open_low: bool = False
) -> str:
    """`noun` with its bounds: ``"a length > 0 mm and <= 100000 mm"``."""
    limits = [
        f"{sign} {format_number(bound, 10)} {unit}".rstrip()
        for sign, bound in ((">" if open_low else ">=", low), ("<=", high))
        if bound is not None
    ]
    return f"{noun} {' and '.join(limits)}".rstrip()


def range_remedy(
    value: float, low: float | None, high: float | None, unit: str = "", *, open_low: bool = False
) -> str:
    """What to do about a `value` beyond its bounds; empty if it is not."""
    if low is not None and (value < low or (open_low and value == low)):
        limit = f"{format_number(low, 10)} {unit}".rstrip()
        return f"give more than {limit}" if open_low else f"increase it to {limit} or more"
    if high == 1 and not unit and 5 < value <= 100:
        return f"write {format_number(value / 100, 12)} for {format_number(value, 12)} %"
    if high is not None and value > high:
        limit = f"{format_number(high, 10)} {unit}".rstrip()
        return f"reduce it to {limit} or less"
    return "" if math.isfinite(value) else "give a finite number"


def plain_number(text: str) -> str:
    """A number with other marks as Python writes it; empty if it is none, or may be two."""
    read = {
        re.sub(r"['’\s]", "", text.replace(other, "")).replace(mark, ".")
        for (mark, form), other in zip(_GROUPED.items(), ",.", strict=True)
        if form.fullmatch(text) and re.search(r"\d", text)
    }
    return read.pop() if len({float(number) for number in read}) == 1 else ""


def from_pint(value: Any) -> tuple[float, str] | None:
    """Number and unit of a pint quantity; None for anything else, and for arrays."""
    if not (hasattr(value, "magnitude") and hasattr(value, "units")):
        return None
    try:
        return float(value.magnitude), str(value.units)
    except (TypeError, ValueError):
        return None


def with_unit(number: float, unit: str) -> Any:
    """A pint quantity."""
    return registry().Quantity(number, unit)


def one_of(unit: str) -> Any:
    """One `unit` as a pint quantity; raises what pint raises."""
    return registry().Quantity(1.0, _parse_unit(unit))


def in_unit(value: Any, unit: str) -> float:
    """A pint quantity, or a number, in `unit`; radians count as numbers.

    Raises `TypeError` if its dimension is another one.
    """
    quantity = value if hasattr(value, "magnitude") else with_unit(value, "")
    return float(quantity.to(unit).magnitude)


def pure_number(value: Any) -> float:
    """The value of a number or pint quantity without dimension; angles are in radians.

    Raises `TypeError` if it has one.
    """
    return in_unit(value, "")


class _UnitError(ValueError):
    """A unit that cannot be taken, with what to write instead."""

    def __init__(self, what: str, remedy: str = "") -> None:
        super().__init__(what)
        self.remedy = remedy


@lru_cache(maxsize=1024)
def _parse_unit(text: str) -> Unit:
    """The unit written as `text`; raises what pint raises, or `_UnitError`."""
    if _UNIT.fullmatch(text) is None:
        raise _UnitError("has a unit that cannot be read")
    for name in re.findall(_NAME, text):  # also those that cancel each other
        registry().parse_units(name)
    start = "1" if text.startswith("/") else ""
    return registry().parse_units(_MISSING_CARET.sub("^", f"{start}{text}"))


@lru_cache(maxsize=4096)
def _convert(number: float, unit: str, si: str) -> float:
    """`number` in `unit` as SI; raises what pint raises, or `_UnitError`."""
    if (unit, si) == ("degC", "K"):
        return number + _ICE
    size = 1.0 if unit == si else _SIZES.get((unit, si))
    if size is not None:
        return number * size
    ureg = registry()
    parsed, wanted = _parse_unit(unit), ureg.parse_units(si)
    if parsed.dimensionality != wanted.dimensionality:
        raise _UnitError("has a unit that measures something else")
    if "delta_" in str(parsed):
        raise _UnitError("is a temperature difference", "give the temperature itself")
    # powers of the angle; pint itself takes angles as pure numbers
    turns = [
        dict(ureg.Quantity(1, each).to_base_units().unit_items()).get("radian", 0)
        for each in (parsed, wanted)
    ]
    if turns[0] != turns[1]:
        if si != "rad/s":
            raise _UnitError("has a unit that measures something else")
        rate = format_number(ureg.Quantity(number, parsed).to("1/min").magnitude, 12)
        remedy = f'write "{rate} rpm" if it counts turns'
        raise _UnitError("has a unit that may count turns or radians", remedy)
    return float(ureg.Quantity(number, parsed).to(wanted).magnitude)


def _divided(text: str) -> tuple[str, str]:
    """What is wrong with a number that has marks between its digits, and what to write."""
    match = _MARKED.match(text)
    number = match[0] if match else ""
    plain = plain_number(number)
    if plain:
        comma = _DECIMAL_COMMA.fullmatch(number)
        what = "has a decimal comma" if comma else "has separators of thousands"
        return what, f"write {plain}" + (", with a decimal point" if "." in plain else "")
    what = "has separators of thousands or of decimals"
    return what, "write it with a decimal point and without separators of thousands"


@lru_cache(maxsize=4096)
def _parsed_text(quantity: Quantity, text: str) -> float:
    """A text that `quantity` reads: the cases of a sweep have most of theirs in common."""
    if len(text) > _LONGEST_TEXT:
        raise quantity._error("is not a number with a unit", quantity._form())
    text = text.strip().translate(_PLAIN_SIGNS)
    match = _NUMBER_AND_UNIT.fullmatch(text)
    if match is None:
        raise quantity._error("is not a number with a unit", quantity._form())
    if _MORE_DIGITS.match(match["unit"]):
        raise quantity._error(*_divided(text))
    if not match["unit"]:
        form = f'write "{quantity.label}{text} {quantity.display}"'
        fits = quantity._is_allowed(float(match["number"]))
        raise quantity._error("has no unit", form if fits else quantity._form())
    return quantity._checked(quantity._converted(float(match["number"]), match["unit"]))


@dataclass(frozen=True, slots=True)
class Quantity:
    """A kind of dimensional value: its units, its range, and how to read it."""

    noun: str  # What it is, for messages: ``"a length"``.
    si: str  # Unit inside the program.
    display: str  # Unit shown to the user.
    low: float | None = None  # Allowed range, in the display unit.
    high: float | None = None  # Allowed range, in the display unit.
    open_low: bool = False  # True if `low` itself is not allowed.
    signed_by: str = ""  # The key that has the sign.
    label: str = ""  # That stands before its values.

    def parse(self, value: object) -> float:
        """`value`, text with a unit or a pint quantity, as an SI number.

        Raises `PydanticCustomError` with the allowed form and range, when `value` is not such a
        quantity.
        """
        if isinstance(value, str):
            return _parsed_text(self, value)
        quantity = from_pint(value)
        if quantity is not None:
            return self._checked(self._converted(*quantity))
        if isinstance(value, int | float) and not isinstance(value, bool):
            raise self._error("has no unit", self._form(value))
        raise self._error("is not a number with a unit", self._form())

    def _checked(self, value: float) -> float:
        """`value`, in SI, if it is within the bounds."""
        shown = self.to_display(value)
        if not self._is_allowed(shown):
            remedy = range_remedy(shown, self.low, self.high, self.display, open_low=self.open_low)
            if self.signed_by and self._is_allowed(-shown):
                remedy = f'write "{self.text(-value, 12)}"; in trains {self.signed_by} has the sign'
            bounds = self._described() if self.describe() == self.noun else ""
            raise self._error("is out of range", remedy, bounds)
        return value

    def _is_allowed(self, shown: float) -> bool:
        """True for a number in the display unit within the bounds."""
        # comparisons written so that NaN fails them, and a whole number too large to be a float
        low_ok = self.low is None or (shown > self.low if self.open_low else shown >= self.low)
        high_ok = self.high is None or shown <= self.high
        return low_ok and high_ok and abs(shown) <= sys.float_info.max

    def scale_from(self, unit: str) -> tuple[float, float]:
        """What arrays of numbers in `unit` are multiplied by, and what is added, for display.

        Raises `PydanticCustomError` with the allowed form, when `unit` does not measure this
        quantity.
        """
        zero, one = (
            self.to_display(self._converted(number, unit.strip().translate(_PLAIN_SIGNS)))
            for number in (0.0, 1.0)
        )
        return one - zero, zero

    def _converted(self, number: float, unit: str) -> float:
        try:
            return _convert(number, unit, self.si) + 0.0  # one zero, whatever was read before
        except _UnitError as error:
            remedy = error.remedy or self._remedy_of_unit(number, unit)
            raise self._error(str(error), remedy) from None
        except Exception:  # pint's own errors have no common base
            remedy = self._remedy_of_unit(number, unit)
            raise self._error("has an unknown unit", remedy) from None

    def meant_unit(self, unit: str) -> str:
        """The unit that is meant by one which is not read, and measures this; empty if none is."""
        meant = _SPELLINGS.get(re.sub(r"[\s*.·-]", "", unit).casefold(), "")
        try:
            _convert(1.0, meant, self.si)
        except Exception:  # it measures something else
            return ""
        return meant

    def _remedy_of_unit(self, number: float, unit: str) -> str:
        """What to write for a number whose unit is not read: the same, or no number."""
        meant = self.meant_unit(unit)
        if not meant:
            return self._form()
        return f'write "{self.text(_convert(number, meant, self.si), 12)}"'

    def to_display(self, value: float) -> float:
        """SI `value` in the display unit."""
        factor, zero = _scale(self.si, self.display)
        # 139.23 mm -> m -> mm must read 139.23 again, not 139.23000000000002
        return float(f"{value * factor + zero if zero else value * factor:.14g}")

    def from_display(self, value: float) -> float:
        """A number in the display unit in SI."""
        return _convert(value, self.display, self.si) if self.si else value

    def scale_and_offset(self) -> tuple[float, float]:
        """What arrays of SI values are multiplied by, and what is added, for the display unit."""
        if not self.si:
            return 1.0, 0.0
        zero = self.to_display(0.0)
        return self.to_display(1.0) - zero, zero

    def text(self, value: float, digits: int = 6) -> str:
        """SI `value` as text in the display unit, ``"139.23 mm"``."""
        return f"{format_number(self.to_display(value), digits)} {self.display}"

    def exact_text(self, value: float) -> str:
        """SI `value` as text that `parse` reads as the very same number."""
        text = self.text(value, digits=12)
        number, _, unit = text.partition(" ")
        if _convert(float(number), unit, self.si) == value:
            return text
        return f"{float(value)!r} {self.si}"  # those of numpy would write their type

    def describe(self) -> str:
        """What is allowed, in words: ``"a length > 0 mm"``, without bounds of no interest."""
        if self.high is not None and self.low == -self.high:
            return self.noun
        return self._described()

    def _described(self) -> str:
        return describe_range(self.noun, self.low, self.high, self.display, open_low=self.open_low)

    def _form(self, number: float | None = None) -> str:
        """How to write it; with the user's `number` if it is allowed and short enough."""
        if number is None or not self._is_allowed(number):
            return "give a number" + (self.display and f" with its unit, {self.display}")
        text = format_number(number, 12) if isinstance(number, float) else str(number)
        return f'give it in {self.display}, such as "{text} {self.display}"'

    def _error(self, what: str, remedy: str, allowed: str = "") -> PydanticCustomError:
        return PydanticCustomError(
            "quantity",
            "{what}; it must be {allowed}",
            {
                "what": what,
                "allowed": allowed or self.describe(),
                "remedy": f"{remedy[:1].upper()}{remedy[1:]}",
            },
        )

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        limits = {"gt", "ge", "lt", "le"} & handler(source).keys()
        if limits:  # they would be lost: those of a quantity are its own
            raise TypeError(f"{sorted(limits)} beside {self.noun}: use its low and high")
        return core_schema.no_info_plain_validator_function(self.parse)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {
            "type": "string",
            "description": f"{self.describe()}; text with a unit",
            "x-unit": self.display,
            "pattern": r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*[^0-9\s].*$",
        }


@cache
def _scale(si: str, display: str) -> tuple[float, float]:
    """What a number in one unit is multiplied by for another, and where the zero of it lies."""
    if (si, display) == ("K", "degC"):
        return 1.0, -_ICE
    size = 1.0 if si == display else _SIZES.get((display, si))
    if size is not None:
        return 1 / size, 0.0
    zero, one = (float(registry().Quantity(it, si).to(display).magnitude) for it in (0.0, 1.0))
    return one - zero, zero


# Kinds of values that are only shown; a case does not read them, so that they have no bounds.
BAR = Quantity("a pressure", "Pa", "bar")
CELSIUS = Quantity("a temperature", "K", "degC")
CUBIC_MILLIMETRE = Quantity("a volume", "m^3", "mm^3")
DEGREE = Quantity("an angle", "rad", "deg")
GIGAPASCAL = Quantity("a pressure", "Pa", "GPa")
JOULE_PER_KELVIN = Quantity("a heat capacity", "J/K", "J/K")
KELVIN = Quantity("a temperature difference", "K", "K")
KILOGRAM_PER_CUBIC_METRE = Quantity("a density", "kg/m^3", "kg/m^3")
KILOJOULE = Quantity("an energy", "J", "kJ")
LITRE = Quantity("a volume", "m^3", "l")
METRE_PER_SECOND = Quantity("a speed", "m/s", "m/s")
MICROMETRE = Quantity("a length", "m", "um")
MILLIMETRE = Quantity("a length", "m", "mm")
MILLIPASCAL_SECOND = Quantity("a viscosity", "Pa*s", "mPa*s")
NEWTON = Quantity("a force", "N", "N")
NEWTON_METRE = Quantity("a torque", "N*m", "N*m")
NEWTON_PER_MM = Quantity("a line load", "N/m", "N/mm")
NEWTON_PER_MM_MICROMETRE = Quantity("a stiffness per width", "N/m^2", "N/(mm*um)")
NEWTON_PER_UM = Quantity("a stiffness", "N/m", "N/um")
NUMBER = Quantity("a number", "", "")
PER_GIGAPASCAL = Quantity("a pressure-viscosity coefficient", "1/Pa", "1/GPa")
RPM = Quantity("a rotational speed", "rad/s", "rpm")
SQUARE_MILLIMETRE = Quantity("an area", "m^2", "mm^2")
SECOND = Quantity("a time", "s", "s")
SQUARE_MM_PER_SECOND = Quantity("a viscosity", "m^2/s", "mm^2/s")
WATT = Quantity("a power", "W", "W")
WATT_PER_KELVIN = Quantity("a thermal conductance", "W/K", "W/K")
WATT_PER_MM = Quantity("a power per length", "W/m", "W/mm")


Number = Annotated[float, "dimensionless"]
"""A number that has no unit because it has no dimension."""

Length = Annotated[float, Quantity("a length", "m", "mm", low=0.0, high=1e5, open_low=True)]
SmallLength = Annotated[float, Quantity("a length", "m", "um", low=0.0, high=1e4)]
Play = Annotated[float, Quantity("a length", "m", "um", low=0.0, high=1e4, open_low=True)]
Deviation = Annotated[float, Quantity("a deviation", "m", "um", low=-1e4, high=1e4)]
Mass = Annotated[float, Quantity("a mass", "kg", "kg", low=0.0, high=1e6)]
Angle = Annotated[float, Quantity("an angle", "rad", "deg", low=-360.0, high=360.0)]
HelixAngle = Annotated[float, Quantity("a helix angle", "rad", "deg", 0.0, 45.0, signed_by="hand")]
Torque = Annotated[float, Quantity("a torque", "N*m", "N*m", low=-1e9, high=1e9)]
RotationalSpeed = Annotated[
    float, Quantity("a rotational speed", "rad/s", "rpm", low=-1e6, high=1e6)
]
Speed = Annotated[float, Quantity("a speed", "m/s", "m/s", low=0.0, high=1e4)]
Temperature = Annotated[float, Quantity("a temperature", "K", "degC", low=-50.0, high=250.0)]
Pressure = Annotated[float, Quantity("a pressure", "Pa", "bar", low=0.0, high=1e3, open_low=True)]
HertzPressure = Annotated[float, Quantity("a pressure", "Pa", "GPa", low=0.0, high=100.0)]
Stiffness = Annotated[float, Quantity("a stiffness", "N/m", "N/um", low=0.0, high=1e7)]
Modulus = Annotated[float, Quantity("a modulus", "Pa", "GPa", low=0.0, high=2e3, open_low=True)]
Density = Annotated[
    float, Quantity("a density", "kg/m^3", "kg/m^3", low=0.0, high=3e4, open_low=True)
]
KinematicViscosity = Annotated[
    float, Quantity("a kinematic viscosity", "m^2/s", "mm^2/s", low=0.3, high=1e7, open_low=True)
]
"""ASTM D341 takes the logarithm of a logarithm of the value in mm^2/s plus 0.7."""
PressureViscosity = Annotated[
    float, Quantity("a pressure-viscosity coefficient", "1/Pa", "1/GPa", low=1.0, high=60.0)
]


Area = Annotated[float, Quantity("an area", "m^2", "m^2", low=0.0, high=1e4, open_low=True)]
Volume = Annotated[float, Quantity("a volume", "m^3", "l", low=0.0, high=1e6)]
VolumeFlow = Annotated[float, Quantity("a flow", "m^3/s", "l/min", low=0.0, high=1e6)]
Power = Annotated[float, Quantity("a power", "W", "W", low=0.0, high=1e9)]
Conductance = Annotated[float, Quantity("a thermal conductance", "W/K", "W/K", low=0.0, high=1e7)]
BodyCapacity = Annotated[
    float, Quantity("a heat capacity", "J/K", "J/K", low=0.0, high=1e10, open_low=True)
]
HeatTransfer = Annotated[
    float, Quantity("a heat transfer coefficient", "W/(m^2*K)", "W/(m^2*K)", low=0.0, high=1e6)
]


def unit_text(unit: str) -> str:
    """`unit` in print, ``"mm²/s"`` for ``"mm^2/s"``; nothing for pure numbers."""
    if unit == "1":
        return ""
    text = unit.replace("*", "·").replace("^2", "²").replace("^3", "³")
    return text.replace("degC", "°C").replace("um", "µm")
