"""Numbers with units: what is read, what is refused, and what the refusal says."""

from __future__ import annotations

import math
import re
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel, ConfigDict, Field
from pydantic_core import PydanticCustomError

from epicyclic import units
from epicyclic.units import Quantity, describe_range, format_number, range_remedy, registry
from limits import is_soon


def quantity(annotated) -> Quantity:
    return next(item for item in annotated.__metadata__ if isinstance(item, Quantity))


LENGTH = quantity(units.Length)
SPEED = quantity(units.RotationalSpeed)
TORQUE = quantity(units.Torque)
ANGLE = quantity(units.Angle)
TEMPERATURE = quantity(units.Temperature)
VISCOSITY = quantity(units.KinematicViscosity)
ALL = {
    name: quantity(getattr(units, name))
    for name in vars(units)
    if hasattr(getattr(units, name), "__metadata__") and name != "Number"
}


def refusal(kind: Quantity, value: object) -> tuple[str, str]:
    """What a refusal says, and its remedy; it must come at once."""
    start = time.thread_time()
    with pytest.raises(PydanticCustomError) as caught:
        kind.parse(value)
    assert is_soon(time.thread_time() - start, 0.5)
    context = caught.value.context or {}
    assert context["remedy"][0].isupper()
    assert kind.describe() in caught.value.message()
    return caught.value.message(), context["remedy"]


@pytest.mark.parametrize(
    ("kind", "text", "si"),
    [
        (LENGTH, "139.23 mm", 0.13923),
        (LENGTH, "  139.23mm ", 0.13923),
        (LENGTH, "1.3923e2 mm", 0.13923),
        (LENGTH, ".5 m", 0.5),
        (LENGTH, "5. mm", 0.005),
        (LENGTH, "+1 in", 0.0254),
        (LENGTH, "400 µm", 4e-4),
        (LENGTH, "400 μm", 4e-4),  # Greek mu, not the micro sign
        (LENGTH, "400 um", 4e-4),
        (LENGTH, "1\u00a0mm", 1e-3),  # a space that does not break
        (SPEED, "60 rpm", 2 * math.pi),
        (SPEED, "60 rev/min", 2 * math.pi),
        (SPEED, "1 turn/s", 2 * math.pi),
        (SPEED, "-1 rad/s", -1.0),
        (SPEED, "−1 rad/s", -1.0),  # a minus sign, not a hyphen
        (TORQUE, "2 N*m", 2.0),
        (TORQUE, "2 N·m", 2.0),
        (TORQUE, "2 N m", 2.0),
        (TORQUE, "2 Nm", 2.0),
        (TORQUE, "2 kNm", 2000.0),
        (TORQUE, "-0.0 N*m", 0.0),
        (ANGLE, "180 deg", math.pi),
        (ANGLE, "180°", math.pi),
        (ANGLE, "0.5 rad", 0.5),
        (TEMPERATURE, "90 degC", 363.15),
        (TEMPERATURE, "90 °C", 363.15),
        (TEMPERATURE, "194 °F", 363.15),
        (TEMPERATURE, "363.15 K", 363.15),
        (VISCOSITY, "10 mm²/s", 1e-5),
        (VISCOSITY, "10 mm2/s", 1e-5),
        (VISCOSITY, "10 mm^2/s", 1e-5),
        (VISCOSITY, "10 mm**2 / s", 1e-5),
        (VISCOSITY, "10 mm² s⁻¹", 1e-5),
        (VISCOSITY, "10 cSt", 1e-5),
    ],
)
def test_numbers_with_units_are_read(kind, text, si):
    assert kind.parse(text) == pytest.approx(si, rel=1e-14)


def test_pint_quantities_are_read():
    ureg = registry()
    assert LENGTH.parse(ureg.Quantity(5, "mm")) == pytest.approx(0.005)
    assert TEMPERATURE.parse(ureg.Quantity(90, "degC")) == pytest.approx(363.15)
    assert SPEED.parse(ureg.Quantity(60, "rpm")) == pytest.approx(2 * math.pi)


@pytest.mark.parametrize("number", [139.23, 139, 0, -5, 10**400])
def test_a_bare_number_is_refused_with_its_unit(number):
    message, remedy = refusal(LENGTH, number)
    assert "has no unit" in message
    assert "mm" in remedy


def test_a_bare_number_in_quotes_is_refused_with_its_unit():
    assert refusal(ANGLE, "20")[1] == 'Write "20 deg"'


@pytest.mark.parametrize(
    ("kind", "value", "fault", "remedy"),
    [
        (LENGTH, "139.23 kg", "measures something else", "its unit, mm"),
        (LENGTH, "139.23 mn", "unknown unit", "its unit, mm"),
        (LENGTH, "30,9 mm", "decimal comma", "30.9"),
        (LENGTH, "mm", "is not a number with a unit", "mm"),
        (LENGTH, "", "is not a number with a unit", "mm"),
        (LENGTH, "nan mm", "is not a number with a unit", "mm"),
        (LENGTH, "inf mm", "is not a number with a unit", "mm"),
        (LENGTH, True, "is not a number with a unit", "mm"),
        (LENGTH, ["1 mm"], "is not a number with a unit", "mm"),
        (LENGTH, {"a": 1}, "is not a number with a unit", "mm"),
        (LENGTH, "0 mm", "out of range", "more than 0 mm"),
        (LENGTH, "-0.0 mm", "out of range", "more than 0 mm"),
        (LENGTH, "1e400 mm", "out of range", "100000 mm or less"),
        (LENGTH, "1 parsec", "out of range", "100000 mm or less"),
        (LENGTH, "1 %", "measures something else", "mm"),
        (SPEED, "4000 1/min", "turns or radians", '"4000 rpm"'),
        (SPEED, "4000 /min", "turns or radians", '"4000 rpm"'),
        (SPEED, "4000 min^-1", "turns or radians", '"4000 rpm"'),
        (SPEED, "50 Hz", "turns or radians", '"3000 rpm"'),
        (ANGLE, "20 %", "measures something else", "deg"),
        (TORQUE, "1 N*m/rad", "measures something else", "N*m"),
        (TEMPERATURE, "300 degC", "out of range", "250 degC or less"),
        (TEMPERATURE, "-60 degC", "out of range", "-50 degC or more"),
        (TEMPERATURE, "10 delta_degC", "temperature difference", "temperature itself"),
        (TEMPERATURE, "10 Δ°C", "temperature difference", "temperature itself"),
        (TEMPERATURE, "10 degC*degC", "measures something else", "degC"),
    ],
)
def test_a_refusal_says_why_and_what_to_write(kind, value, fault, remedy):
    message, advice = refusal(kind, value)
    assert fault in message
    assert remedy in advice


@pytest.mark.parametrize(
    "text",
    [
        "1 m**99999999999",
        "9**9**9 mm",
        "9 **9**9 mm",
        "1 m^9^9^9^9^9",
        "1 m^-99",
        "1 km**9999999",
        "1 (km)**9999999",
        "1 (((((m)^9)^9)^9)^9)^9",
        "1 " + "m*" * 40 + "m",
        "1" + " " * 1_000_000 + "mm",
        "1 mm" + " " * 1_000_000 + "x",
        "9" * 1_000_000 + " mm",
        "1 " + "(" * 90,
        "1 mm; import os",
        "1 __import__('os')",
        "1 mm\x00",
        "1 \ud800",
        "1 mm\n1 mm",
    ],
)
def test_nothing_hangs_or_is_evaluated(text):
    refusal(LENGTH, text)


def test_quantities_that_are_not_one_number_are_refused():
    assert "is not a number" in refusal(LENGTH, registry().Quantity([1, 2], "mm"))[0]


@pytest.mark.parametrize("name", ALL)
def test_every_quantity_reads_back_what_it_writes(name):
    kind = ALL[name]
    low = -100.0 if kind.low is None else kind.low
    high = 100.0 if kind.high is None else kind.high
    for share in (0.001, 1 / 3, 0.5, 0.999):
        shown = low + share * (high - low)
        si = kind.parse(f"{shown!r} {kind.display}")
        assert kind.to_display(si) == pytest.approx(shown, rel=1e-12)
        assert kind.parse(kind.exact_text(si)) == si
        assert kind.parse(f"{si!r} {kind.si}") == si
        assert kind.text(si).endswith(f" {kind.display}")


def test_text_is_short_and_exact_text_is_exact():
    third = 1 / 3
    assert LENGTH.text(0.13923) == "139.23 mm"
    assert LENGTH.text(third) == "333.333 mm"
    assert LENGTH.exact_text(0.13923) == "139.23 mm"
    assert TORQUE.exact_text(TORQUE.parse("-0.0 N*m")) == "0 N*m"
    assert LENGTH.parse(LENGTH.exact_text(third)) == third


def test_ranges_in_words():
    assert LENGTH.describe() == "a length > 0 mm and <= 100000 mm"
    assert describe_range("a number", 0, None) == "a number >= 0"
    assert describe_range("a number", None, None) == "a number"
    assert range_remedy(-1.0, 0.0, 1.0) == "increase it to 0 or more"
    assert range_remedy(0.0, 0.0, 1.0, open_low=True) == "give more than 0"
    assert range_remedy(2.0, 0.0, 1.0, "bar") == "reduce it to 1 bar or less"
    assert range_remedy(math.nan, 0.0, 1.0) == "give a finite number"


def test_numbers_as_text():
    assert format_number(0.1 + 0.2) == "0.3"
    assert format_number(14599.0, 3) == "14600"
    assert format_number(-99999.0, 4) == "-100000"
    assert format_number(1234567.0) == "1234570"
    assert format_number(1234567.0, 10) == "1234567"
    assert format_number(12345678.0) == "1.23457e+07"
    assert format_number(float("inf")) == "inf"


def test_the_registry_needs_no_writable_home(monkeypatch):
    import pint

    real = pint.UnitRegistry

    def no_cache(*args, **kwargs):
        if kwargs:
            raise PermissionError
        return real()

    monkeypatch.setattr(pint, "UnitRegistry", no_cache)
    fresh = registry.__wrapped__()
    assert fresh.Quantity(1, "Nm").to("N*m").magnitude == 1.0


def test_numbers_of_numpy_are_written_as_any_other():
    flow = np.float64(7.816660531630488e-06)
    text = Quantity("a flow", "m^3/s", "l/min").exact_text(flow)
    assert Quantity("a flow", "m^3/s", "l/min").parse(text) == float(flow)


NOT_UNDERSTOOD = (
    "1_0 mm", "5 foo0 mm", "5 foo/foo mm", "5 foo foo-1 mm", "5 mm foo^0", "5 mm kg0", "5 mm nan0",
    "5 degC0 mm", "5 _ mm", "5 mm_", "5 mm __2", "5 (mm", "5 mm)", "5 mm**0", "5 mm #", "5 mm; m",
    "5 m\u200bm", "5 mm\0", "5 mm .", "0x5 mm", "5e mm", "5 mm^1_0", "5 rev/foo foo mm",
)  # fmt: skip


@pytest.mark.parametrize("text", NOT_UNDERSTOOD)
def test_every_sign_of_a_unit_must_be_understood(text):
    with pytest.raises(PydanticCustomError):
        LENGTH.parse(text)


SIGNS = st.sampled_from([*"m_ .,;/*^()-+0123eE°%'\"µ²\0\u200b", "mm", "foo", "kg", "km", "inch"])


@given(st.lists(SIGNS, max_size=6).map("".join))
def test_a_unit_of_random_signs_is_a_length_or_refused(text):
    """What is taken is made of signs that mean something: names of units, powers, brackets."""
    try:
        value = LENGTH.parse(f"5 {text}")
    except PydanticCustomError:
        return
    assert value > 0
    names = re.findall(r"[^\W\d]+", text)
    assert names
    assert all(name in registry() for name in names)
    assert not re.search(r"(?<![1-9])0", text)


def test_limits_beside_a_quantity_are_refused_as_they_would_be_lost():
    class Table(BaseModel):
        model_config = ConfigDict(defer_build=True)
        torque: units.Torque = Field(gt=0)

    with pytest.raises(TypeError, match=r"'gt'.* beside a torque: use its low and high"):
        Table.model_rebuild(force=True)


@pytest.mark.parametrize(("unit", "si"), units._SIZES)
def test_common_units_have_the_size_that_pint_gives_them(unit, si):
    ureg = units.registry()
    for number in (139.23, -0.07, 4e6):
        pint_s = ureg.Quantity(number, ureg.parse_units(unit)).to(si).magnitude
        assert units._convert(number, unit, si) == pint_s
        back = ureg.Quantity(number, si).to(unit).magnitude
        assert number * units._scale(si, unit)[0] == pytest.approx(back, rel=1e-15)
