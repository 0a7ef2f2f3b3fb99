"""Whether a result can be: no loss below zero, as much power lost as the shafts bring, contacts
that can carry what they carry."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from epicyclic.errors import Status
from epicyclic.machine.element import Extremes
from epicyclic.machine.gear_mesh import MeshFigures
from epicyclic.machine.planets import BearingFigures
from epicyclic.result.result import Result, in_words
from epicyclic.units import GIGAPASCAL, WATT

NEGLIGIBLE = 1e-3
"""A loss that is below zero by a smaller share of the sum of all magnitudes is an error of the
numerics: the power of pockets is a small difference of large ones. [1]"""
UNBALANCED = 1e-8
"""Power, relative to the largest one, that torques and losses may differ by when they agree to
5e-10 of each load. [1]"""
FLATTENED = 1.0
"""Half-width of a contact over its radius at which the bodies would have to pass through each
other; Hertz's theory takes it to be far smaller. Johnson, Contact Mechanics (1985), section 4.1.
Steel on steel is pressed with some 60 GPa there; perfect steel shears off at about 40 GPa: 0.30 of
the pressure (Johnson, Eq. 4.47) against the shear modulus over 2 pi (Frenkel; general knowledge).
[1]"""
MOST_RESISTANCE = 1.0
"""Mean coefficient of friction, rolling loss included, that no lubricated contact reaches: that of
dry steel is below. [1]"""
PRESSED = 1e8
"""Hertz pressure from which that holds: under less load films that hardly carry anything resist
with more than their load. [Pa]"""
CHECK_FILES = "Check the files and tables that the case names, or choose other models."
CHECK_CONTACTS = (
    "Check torque and sizes. If they are intended, a formula diverges far outside its range: "
    "choose other models.friction, models.rolling or models.bearing, or "
    'models.oil_beyond_range = "held".'
)

Contact = MeshFigures | BearingFigures


def judged(result: Result) -> Result:
    """The result, or the same with the status `Status.UNPHYSICAL` and a note that says why."""
    contacts: dict[str, Contact] = {
        f"{what} of the {in_words(name)}": found[name]
        for what, found in (("teeth", result.meshes), ("rollers", result.bearings))
        for name in found
        if _may_be_overloaded(result.extremes.get(name))
    }
    models = list(_overloaded(contacts))
    reasons = []
    limit = NEGLIGIBLE * sum(map(abs, result.losses.values()))
    below = [
        f"{in_words(name)} {WATT.text(watts, 3)}"
        for name, watts in result.losses.items()
        if watts < -limit
    ]
    if below:
        reasons.append(f"Losses are negative: {', '.join(below)}.")
    powers = [member.power for member in result.flow.members.values()]
    left = sum(powers) - result.total
    if abs(left) > UNBALANCED * max(map(abs, (*powers, result.total)), default=0.0):
        reasons.append(f"The shaft powers exceed the losses by {WATT.text(left, 3)}.")
    reasons += models
    if not reasons:
        return result
    advice = [CHECK_CONTACTS] if models else []
    if len(reasons) > len(models):
        advice.append(CHECK_FILES)
    note = f"No result: {' '.join(reasons + advice)}"
    return replace(result, status=Status.UNPHYSICAL, notes=(note, *result.notes))


def _may_be_overloaded(own: Extremes | None) -> bool:
    """Whether the figures of a contact are worth reading."""
    if own is None or own.flattening > FLATTENED:
        return True
    return own.resistance > MOST_RESISTANCE and own.pressure > PRESSED


def _overloaded(contacts: Mapping[str, Contact]) -> Iterator[str]:
    """Contacts that no material bears, then those that resist with more than any does."""
    for name, found in contacts.items():
        if found.flattening > FLATTENED:
            yield (
                f"The {name} would have a contact pressure of "
                f"{GIGAPASCAL.text(found.hertz_pressure_max, 3)}, which flattens them over more "
                "than their radius. No material withstands that."
            )
    for name, found in contacts.items():
        if found.resistance > MOST_RESISTANCE and found.hertz_pressure_max > PRESSED:
            yield (
                f"The {name} would lose {found.resistance:.3g} times the power that their load "
                "can dissipate at their surface speeds."
            )
