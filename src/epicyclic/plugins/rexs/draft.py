"""A case in the making: what a file gives, with its origin, and what it lacks."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import Problem
from epicyclic.messages import key_parts, path_of
from epicyclic.plugins.rexs.model import Attribute, Component, Model, term, vocabulary
from epicyclic.plugins.rexs.sets import GEARS, SetParts, fixed_by, rigid_parts
from epicyclic.schema.read import with_value
from epicyclic.units import format_number

DIGITS = 15  # Significant digits that a number has in REXS at most.

SAME = 1e-9  # Relative difference up to which numbers of a file are the same.


class Amount(NamedTuple):
    """A number of a file, its unit in this package, and where it stands."""

    number: float
    unit: str
    origin: str

    @property
    def text(self) -> Any:
        """As a case file has it."""
        return amount_text(self.number, self.unit)


@dataclass(frozen=True, slots=True)
class Lack:
    """A key of the case for which the file has no value.

    Attributes
    ----------
    key : str
        Dotted key of the case.
    attribute : str
        REXS id of what is lacking, and the component that should have it.
    needed : bool
        True if there is no case without it.
    instead : str
        What happens without it, or what to do.
    """

    key: str
    attribute: str
    needed: bool
    instead: str

    def explains(self, problem: Problem) -> bool:
        """True if a problem of a case is that this key, or its whole table, is missing."""
        path, own = path_of(problem.key), path_of(self.key)
        is_alternative = own[:-1] == path[:-1] and str(own[-1]) in problem.allowed
        return own == path or own[:-1] == path or is_alternative

    def __str__(self) -> str:
        return f"The file has no {self.attribute}. {self.instead}".rstrip()


def amount_text(number: float, unit: str) -> Any:
    """A number as a case file has it: with its unit, or bare without one."""
    text = format_number(number + 0.0, DIGITS)
    return f"{text} {unit}" if unit else float(text)


def at(components: Sequence[Component]) -> str:
    """Where a value stands, in words."""
    more = f" and {len(components) - 1} more" if len(components) > 1 else ""
    return f"{components[0]}{more}"


@dataclass(slots=True)
class Draft:
    """What is known of a case."""

    tables: dict[str, Any]  # The tables of the case, complete or not.
    origins: dict[str, str] = field(default_factory=dict)  # Where the value of each key comes from.
    lacks: dict[str, Lack] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)  # What the user should know.
    problems: list[Problem] = field(default_factory=list)  # Values that cannot be read.

    def give(self, key: str, value: Any, origin: str) -> None:
        """Set a key."""
        self.tables = with_value(self.tables, key_parts(key), value)
        self.origins[key] = origin

    def lack(
        self, key: str, attribute: str, components: Sequence[Component], instead: str = ""
    ) -> None:
        """Note that the file has no value for a key; without `instead` the case needs one."""
        where = f"{attribute} of {at(components)}" if components else attribute
        self.lacks[key] = Lack(key, where, not instead, instead)

    def need(self, key: str, attribute: str, components: Sequence[Component], hint: str) -> None:
        """Note that the file has no value for a key that the case needs, with a hint."""
        self.lack(key, attribute, components)
        self.lacks[key] = replace(self.lacks[key], instead=hint)

    def read(self, attribute: str, components: Sequence[Component], key: str = "") -> Amount | None:
        """An attribute that `components` have in common.

        None if none has it; if it cannot be read, or if they differ, that is a problem.
        """
        found: list[tuple[float, str, Attribute, Component]] = []
        for component in components:
            raw = component.get(attribute)
            if raw is None:
                continue
            try:
                amount = component.amount(attribute)
            except ValueError as error:
                self.wrong(key, raw, component, str(error))
                return None
            assert amount is not None
            found.append((*amount, raw, component))
        if not found:
            return None
        number, unit, raw, component = found[0]
        for other, other_unit, _, where in found[1:]:
            if other_unit != unit or not math.isclose(other, number, rel_tol=SAME, abs_tol=1e-12):
                self.wrong(key, raw, component, f"differs in {where}; they must be equal")
                return None
        return Amount(number, unit, f"{raw.id} of {at([item[3] for item in found])}")

    def take(
        self,
        key: str,
        attribute: str,
        components: Sequence[Component],
        instead: str | None = "",
        change: Callable[[float], float] = lambda number: number,
    ) -> float | None:
        """Set `key` from an attribute, or note that it is lacking.

        Returns the number as the file has it, None if there is none. With `instead` None nothing
        is noted.
        """
        found = self.read(attribute, components, key)
        if found is None:
            if instead is not None:
                self.lack(key, attribute, components, instead)
            return None
        value = amount_text(change(found.number), found.unit)
        if term(attribute).type == "integer" and found.number.is_integer():
            value = int(change(found.number))
        self.give(key, value, found.origin)
        return found.number

    def adopt(self, other: Draft, name: str) -> None:
        """Take over what is known of the set called `name`."""
        place = f"sets.{name}."
        self.tables = with_value(self.tables, ["sets", name], other.tables)
        self.origins |= {f"{place}{key}": origin for key, origin in other.origins.items()}
        for key, lack in other.lacks.items():
            self.lacks[f"{place}{key}"] = replace(lack, key=f"{place}{key}")
        self.notes += [f"{name}: {note}" for note in other.notes]
        self.problems += other.problems

    def wrong(self, key: str, attribute: Attribute, component: Component, what: str) -> None:
        """Note a value that cannot be read."""
        place = f"{attribute.id} of {component}"
        remedy = "Correct the file." + (f" It is used for {key}." if key else "")
        self.problems.append(Problem(place, f'"{attribute.text()}"', f"{what}.", remedy))


_KINDS = (
    "lubricant_type_iso_6336_2019",
    "lubricant_type_iso_6336_2006",
    "lubricant_type_agma_925_2003",
    "basis",
    "kind",
)
_VISCOSITIES = {
    "viscosity_at_40_degree_celsius": "40 degC",
    "viscosity_at_100_degree_celsius": "100 degC",
}
_DENSITY = "density_at_15_degree_celsius"
_ALPHA = "pressure_viscosity_coefficient_at_38_degrees_celsius"
_AGMA = "parameter_{}_for_calculation_of_pressure_viscosity_coefficient_agma_925_2003"
_OR_NAME = "Or give an oil of the library instead: lubricant.oil."


def lubricant_table(draft: Draft, model: Model, stages: Sequence[Component]) -> None:
    """The oil of the stages, or else of the casing."""
    oils: dict[int, Component] = {}
    owners = (*stages, *model.of_type("gear_casing"))
    for oil in model.partners_of(owners, "reference", "origin", "referenced", "lubricant"):
        oils.setdefault(oil.id, oil)
    if not oils:
        draft.lack("lubricant.oil", "lubricant", stages)
        return
    oil = next(iter(oils.values()))
    if len(oils) > 1:
        draft.notes.append(f"The file has {len(oils)} lubricants for this set; {oil} is used.")
    name = oil.get("name")
    draft.give("lubricant.oil.title", name.text() if name else str(oil), f"{oil}")
    _kind(draft, oil)
    _viscosity(draft, oil)
    density = draft.read(_DENSITY, [oil], "lubricant.oil.density")
    if density is None:
        draft.lack("lubricant.oil.density", _DENSITY, [oil], "")
    else:
        point = {"temperature": "15 degC", "value": density.text}
        draft.give("lubricant.oil.density", [point], density.origin)
    _pressure_viscosity(draft, oil, density)


def _kind(draft: Draft, oil: Component) -> None:
    for attribute in _KINDS:
        found = oil.get(attribute)
        kind = None if found is None else vocabulary()["oil_kinds"].get(found.text())
        if found is not None and kind is not None:
            draft.give("lubricant.oil.kind", kind, f'{found.id} "{found.text()}" of {oil}')
            return
    draft.lack("lubricant.oil.kind", "basis, or lubricant_type_iso_6336_2019,", [oil])


def _viscosity(draft: Draft, oil: Component) -> None:
    points, origins = [], []
    for attribute, temperature in _VISCOSITIES.items():
        found = draft.read(attribute, [oil], "lubricant.oil.kinematic_viscosity")
        if found is not None:
            points.append({"temperature": temperature, "value": found.text})
            origins.append(found.origin)
    if len(points) == len(_VISCOSITIES):
        draft.give("lubricant.oil.kinematic_viscosity", points, " and ".join(origins))
    else:
        draft.lack("lubricant.oil.kinematic_viscosity", " and ".join(_VISCOSITIES), [oil], "")


def _pressure_viscosity(draft: Draft, oil: Component, density: Amount | None) -> None:
    """alpha of the file at 38 degC, or alpha = k eta^s of AGMA 925-A03 as the law of Gold."""
    key = "lubricant.oil.pressure_viscosity"
    alpha = draft.read(_ALPHA, [oil], key)
    if alpha is not None:
        point = {"temperature": "38 degC", "value": alpha.text}
        draft.give(key, {"law": "roelands", "point": [point]}, alpha.origin)
        return
    factor, exponent = (draft.read(_AGMA.format(name), [oil], key) for name in "ks")
    if factor and exponent and density and density.unit == "kg/dm^3":
        # alpha in mm^2/N is 1000 times that in 1/GPa, eta in mPa s is nu in mm^2/s times rho in
        # kg/dm^3; rho at 15 degC in place of that at temperature changes alpha by 1 %
        s = 1000 * factor.number * density.number**exponent.number
        law = {"law": "gold", "s": float(f"{s:.6g}"), "t": exponent.number}
        draft.give(
            key, law, f"computed from {factor.origin}, parameter s and the density at 15 degC"
        )
        return
    draft.need(key, _ALPHA, [oil], _OR_NAME)


def temperature(draft: Draft, model: Model, stages: Sequence[Component]) -> None:
    """Oil temperature of the stages, or else of the casing."""
    name, key = "temperature_lubricant", "operation.oil_inlet_temperature"
    if draft.take(key, name, stages, None) is None:
        draft.take(key, name, model.of_type("gear_casing") or stages)


_WATTS = {"W": 1.0, "kW": 1e3}


def planetary_operation(draft: Draft, model: Model, planetary: SetParts) -> None:
    """Input and fixed member, or two members of given speed; torque and speed of the input."""
    members = {
        name: rigid_parts(model, [*planetary.shafts[name], *planetary.alike.get(name, ())])
        for name in ("sun", "ring", "carrier")
    }
    shafts = {name: planetary.shafts[name] for name in members}
    joints = {name: fixed_by(model, parts) for name, parts in members.items()}
    fixed = next((name for name, joint in joints.items() if joint is not None), None)
    if fixed is not None:
        draft.give("operation.fixed", fixed, f"{joints[fixed]} to the casing")
    free = {name: parts for name, parts in members.items() if name != fixed}
    loaded = {name: origin for name, parts in free.items() if (origin := stated_load(parts))}
    member = next(iter(loaded), None)  # the sun before the ring before the carrier
    if member is None:
        every = [shaft for name in free for shaft in shafts[name]]
        draft.lack("operation.input", "external_load with torque_around_u_axis or power", every)
        speed_and_torque(draft, [], every)
    else:
        draft.give("operation.input", member, loaded[member])
        speed_and_torque(draft, members[member], shafts[member])
    if fixed is None and not _second_speed(draft, members, member):
        draft.lack("operation.fixed", "coupling to a gear_casing, or speed of a second member,", [])


def _second_speed(
    draft: Draft, members: Mapping[str, Sequence[Component]], member: str | None
) -> bool:
    """The speed of a member beside the input; one that stands still is the fixed one."""
    own = None if member is None else speed_of(draft, members[member])
    for name, parts in members.items():
        speed = None if name == member else speed_of(draft, parts)
        if own is None or speed is None:
            continue
        if speed.number == 0:
            draft.give("operation.fixed", name, speed.origin)
        else:
            sense = math.copysign(1.0, own.number)  # the speed of the input is its magnitude
            value = amount_text(sense * speed.number, speed.unit)
            draft.give("operation.second_input", name, speed.origin)
            draft.give("operation.second_speed", value, speed.origin)
        return True
    return False


def pair_operation(draft: Draft, model: Model, pair: SetParts) -> None:
    """Torque and speed of the pinion."""
    pinion = pair.gears["pinion"]
    shafts = model.partners(pinion.id, "assembly", "part", "assembly", "shaft")
    parts = rigid_parts(model, [pinion, *shafts])
    gears = [part for part in parts if part.type in GEARS]
    loads = parts if len(gears) == 1 else [item for item in parts if item.type != "external_load"]
    speed_and_torque(draft, loads, shafts)


def stated_load(parts: Sequence[Component]) -> str:
    """Which torque or power of a load on `parts` is stated and not zero; nothing if none is."""
    for load in parts:
        for attribute in ("torque_around_u_axis", "power"):
            if load.type == "external_load" and number_of(load, attribute) != 0:
                return f"{attribute} of {load}"
    return ""


def number_of(item: Component, attribute: str) -> float | None:
    """The number of an attribute; 0 if it is not given, None if it cannot be read."""
    try:
        found = item.amount(attribute)
    except ValueError:  # told when the value is read
        return None
    return 0.0 if found is None else found[0]


def speed_of(draft: Draft, parts: Sequence[Component]) -> Amount | None:
    """Speed of the first part that has one; all turn together."""
    turning = [part for part in parts if part.get("rotational_speed") is not None]
    return draft.read("rotational_speed", turning[:1], "operation.speed")


def _torque(draft: Draft, loads: Sequence[Component]) -> Amount | None:
    """Sum of the torques of all loads of a member."""
    name, key = "torque_around_u_axis", "operation.torque"
    found = [amount for load in loads if (amount := draft.read(name, [load], key)) is not None]
    if len({amount.unit for amount in found}) != 1:
        return None
    origin = " plus ".join(amount.origin for amount in found)
    return Amount(sum(amount.number for amount in found), found[0].unit, origin)


def speed_and_torque(draft: Draft, parts: Sequence[Component], shafts: Sequence[Component]) -> None:
    """Speed as a magnitude; torque positive if power flows in, as far as the file tells."""
    key = "operation.speed"
    speed = speed_of(draft, parts)
    if speed is None:
        draft.lack(key, "rotational_speed", shafts)
    else:
        draft.give(key, amount_text(abs(speed.number), speed.unit), speed.origin)
    loads = [part for part in parts if part.type == "external_load"]
    torque = _torque(draft, loads)
    if torque is not None:
        backward = speed is not None and torque.number * speed.number < 0
        sense = " (against the speed: power leaves here)" if backward else ""
        if speed is None:
            sense = " (its magnitude, as driving; without a speed the sign is meaningless)"
        sign = -1.0 if backward else 1.0
        value = amount_text(sign * abs(torque.number), torque.unit)
        draft.give("operation.torque", value, torque.origin + sense)
        return
    power = draft.read("power", loads, "operation.torque")
    if power and speed and speed.number and power.unit in _WATTS and speed.unit == "rpm":
        watts = power.number * _WATTS[power.unit]
        moment = float(f"{watts / (abs(speed.number) * math.pi / 30):.12g}")
        origin = f"computed: {power.origin} over the speed"
        draft.give("operation.torque", amount_text(moment, "N*m"), origin)
        return
    stated = f" ({power.origin} is {power.text})" if power is not None else ""
    draft.lack("operation.torque", f"torque_around_u_axis{stated}", loads or shafts)
