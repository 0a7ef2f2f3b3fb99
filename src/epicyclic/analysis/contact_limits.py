"""What to know before the figures of a line contact are used: ranges left, roughness lost."""

from __future__ import annotations

from collections.abc import Iterator

from epicyclic.case.contact import ContactCase, ContactModel
from epicyclic.ehl.box import DRY_SPEED, FEWEST_KEPT, VALIDATED_FILM_RATIO
from epicyclic.ehl.rough import RoughSolution
from epicyclic.ehl.roughness import Profile
from epicyclic.ehl.steady import SmoothSolution
from epicyclic.elements.fluids import oil_flags
from epicyclic.losses.direct import EhlDirect, solver_range
from epicyclic.losses.validity import ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.units import MICROMETRE, MILLIMETRE, NUMBER, Quantity, format_number, percent

KELVIN = Quantity("a temperature difference", "K", "K")
ROUGH_RANGES = (
    solver_range("film_ratio", "film ratio", NUMBER),
    solver_range("composite_roughness", "composite roughness", MICROMETRE),
)
HIGHEST_RISE = Range(
    "temperature_rise", "temperature rise", 0.0, 50.0, KELVIN, "thinning by heat, linear in it"
)
"""Beyond it the estimate of heat thins the oil too much."""
FEWEST_POINTS = 16
"""Points of a profile in the width of the contact, below which it is hardly one."""


def film_ratio(model: ContactModel, smooth: SmoothSolution) -> float:
    """Minimum film of the smooth contact over the composite Rq. [1]"""
    return smooth.minimum_film / model.composite_roughness


def contact_flags(
    case: ContactCase, model: ContactModel, smooth: SmoothSolution
) -> tuple[ValidityFlag, ...]:
    """A flag for every quantity outside what solver and oil data are good for."""
    contact = model.contact
    ranges = [*EhlDirect.ranges, HIGHEST_RISE]
    values = {
        "radius": contact.radius,
        "hertz_pressure": contact.hertz_pressure,
        "rolling_speed": contact.rolling_speed,
        "slide_to_roll_ratio": abs(contact.sliding_speed) / contact.rolling_speed,
        "temperature_rise": float(smooth.temperature_rise.max()),
    }
    if not model.smooth:
        ranges += ROUGH_RANGES
        values["film_ratio"] = film_ratio(model, smooth)
        values["composite_roughness"] = model.composite_roughness
    use = ModelUse("solver", "line contact", "contact")
    oil = case.lubricant
    return (*check_ranges(use, ranges, values), *oil_flags(oil.oil, oil.temperature))


def contact_notes(
    case: ContactCase, model: ContactModel, smooth: SmoothSolution, rough: RoughSolution | None
) -> Iterator[str]:
    """What else limits a rough contact: standing roughness, thin films, unsuitable profiles."""
    if rough is None or not rough.x.size:
        return
    if case.numerics.frozen_roughness:
        yield (
            "The roughness stands still: all is of one place of the profiles, whatever the "
            "standard error, and the rolling loss has no meaning for surfaces that move."
        )
    speed = model.contact.rolling_speed
    if speed < DRY_SPEED:
        yield (
            f"At {format_number(speed, 2)} m/s, below {DRY_SPEED:g} m/s, oil leaks out of the "
            "valleys of real surfaces; ridges that run across, as here, trap it: load and friction "
            "of the surfaces that touch are too small, and no result to use."
        )
    ratio = film_ratio(model, smooth)
    if ratio < VALIDATED_FILM_RATIO:
        yield (
            f"At a film ratio of {format_number(ratio, 2)}, below {VALIDATED_FILM_RATIO:g}, "
            "friction, load on asperities and rolling loss are not validated: vary "
            "asperities.film, asperities.friction and the correlation lengths."
        )
    spacing = float(rough.x[1] - rough.x[0])
    for number, surface in enumerate(model.surfaces, 1):
        if surface.rms > 0:
            yield from _profile_notes(f"surface{number}", surface, spacing, model)


def _profile_notes(
    name: str, surface: Profile, spacing: float, model: ContactModel
) -> Iterator[str]:
    shown = {
        key: format_number(unit.to_display(value), 4)
        for key, value, unit in (
            ("spacing", spacing, MICROMETRE),
            ("own", surface.spacing, MICROMETRE),
            ("length", surface.length, MILLIMETRE),
            ("width", 2 * model.contact.half_width, MILLIMETRE),
        )
    }
    left = surface.kept(spacing)
    if left < FEWEST_KEPT:
        yield (
            f"The nodes, {shown['spacing']} um apart, resolve {percent(left, 0)} of the Rq of "
            f"{name}: shorter waves are lost. Raise numerics.nodes."
        )
    if FEWEST_POINTS * surface.spacing > 2 * model.contact.half_width:
        yield (
            f"The points of {name} are {shown['own']} um apart, in a contact {shown['width']} mm "
            "wide: a finer profile is needed, or its positions are not in mm."
        )
    if surface.length < 2 * model.contact.half_width:
        yield (
            f"The profile of {name}, {shown['length']} mm long, repeats itself within the contact, "
            f"{shown['width']} mm wide: give a longer one."
        )
