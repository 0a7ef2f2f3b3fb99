"""Results into a REXS file.

Attributes of the standard are written where the file has no value of its own. Everything else goes
under ids that begin with ``custom_epicyclic_``, which the standard leaves to programs; these are
written anew each time.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from importlib.metadata import version
from typing import Any

from epicyclic.elements.figures import Figure
from epicyclic.elements.shaft_bearing import ShaftBearingFigures
from epicyclic.errors import Problem, raise_any
from epicyclic.exchange.rexs.content import Content
from epicyclic.exchange.rexs.draft import DIGITS
from epicyclic.exchange.rexs.model import Attribute, Component, Model
from epicyclic.exchange.rexs.planetary import planet_bearings
from epicyclic.exchange.rexs.sets import Mesh, Pair, PlanetarySet
from epicyclic.exchange.rexs.trains import Train
from epicyclic.exchange.rexs.vocabulary import CUSTOM, id_in, rexs_unit, term, written
from epicyclic.results.result import Result
from epicyclic.units import RPM, format_number


def write_results(
    content: Content, model: Model, chosen: PlanetarySet | Pair | Train, result: Result
) -> None:
    """Give the components of a gear set, or of a train, the figures of `result`."""
    if isinstance(chosen, Train):
        attributes = _of_train(model, chosen, result)
    else:
        attributes = _of_set(model, chosen, result)
    for component, attribute in attributes:
        content.set_attribute(component.id, attribute)


def check_match(chosen: PlanetarySet | Pair | Train, result: Result) -> None:
    """Raise InputError if a result is not of the gears of a file, by their numbers of teeth."""
    if not isinstance(chosen, Train):
        problems = _differences(chosen, result.inputs, "")
    else:
        problems = []
        tables = result.inputs["sets"]
        for name in dict.fromkeys([*chosen.sets, *tables]):
            if name in chosen.sets and name in tables:
                problems += _differences(chosen.sets[name], tables[name], f"sets.{name}.")
                continue
            where = "the file" if name in tables else "the case"
            remedy = "Keep the names of the sets as they were imported."
            problems.append(Problem(f"sets.{name}", "", f"is not in {where}.", remedy))
    raise_any(problems)


def _differences(
    chosen: PlanetarySet | Pair, tables: Mapping[str, Any], place: str
) -> list[Problem]:
    """Numbers of teeth that are not those of the file."""
    if isinstance(chosen, Pair):
        members = {"pinion": chosen.pinion, "gear": chosen.gear}
    else:
        members = {"sun": chosen.sun, "planet": chosen.planets[0], "ring": chosen.ring}
    problems = []
    for name, component in members.items():
        stated = component.get("number_of_teeth")
        table = tables.get(name)
        here = table.get("teeth") if table else None
        there = None if stated is None else abs(stated.number())
        is_left_out = bool(table) and here is None  # planets of a set of given efficiency
        if here != there and not is_left_out:
            problems.append(
                Problem(
                    f"{place}{name}.teeth",
                    f"{here}",
                    f"is {there} in {component}.",
                    "Write the results of a gear set into its own file.",
                )
            )
    return problems


def _of_set(
    model: Model, chosen: PlanetarySet | Pair, result: Result
) -> Iterator[tuple[Component, Attribute]]:
    stage = chosen.component
    yield stage, Attribute(f"{CUSTOM}version", "none", version("epicyclic"))
    for figure in _known(result):
        yield stage, _custom(figure.key, figure.value, figure.unit)
    yield from _meshes(model, chosen, result, "")


def _of_train(model: Model, train: Train, result: Result) -> Iterator[tuple[Component, Attribute]]:
    """Figures of sets, shafts and bearings at their own components, all others at the unit."""
    yield train.unit, Attribute(f"{CUSTOM}version", "none", version("epicyclic"))
    owners = {name: one.component for name, one in train.sets.items()}
    owners |= {name: joint.component for name, joint in train.bearings.items()}
    for figure in _known(result):
        name, dot, key = figure.key.partition(".")
        if dot and name in owners:
            yield owners[name], _custom(key, figure.value, figure.unit)
        elif not dot and not _is_of_shaft(figure.key, result):
            yield train.unit, _custom(key or name, figure.value, figure.unit)
    for name, member in result.flow.members.items():
        for shaft in train.shafts[name].components if name in train.shafts else ():
            yield shaft, _custom("speed", RPM.to_display(member.speed), "rpm")
            yield shaft, _custom("torque", member.torque, "N*m")
    losses = result.stage_losses
    for name, one in train.sets.items():
        yield one.component, _custom("total", losses[name], "W")
        yield from _meshes(model, one, result, f"{name}.")
    for name, joint in train.bearings.items():
        figures = result.parts.get(f"{name}.bearing")
        if isinstance(figures, ShaftBearingFigures):
            yield from _bearing(model, joint.component, losses[name], figures.friction_torque)


def _known(result: Result) -> Iterator[Figure]:
    """The numbers of a result, without those of losses that are left out."""
    left_out = {term.name for term in result.terms if term.left_out}
    for figure in result.numbers():
        if figure.key not in left_out and not math.isnan(figure.value):
            yield figure


def _is_of_shaft(key: str, result: Result) -> bool:
    return any(key in (f"{name}_speed", f"{name}_torque") for name in result.flow.members)


def _meshes(
    model: Model, chosen: PlanetarySet | Pair, result: Result, place: str
) -> Iterator[tuple[Component, Attribute]]:
    """Results of the meshes and planet bearings of a set, whose figures begin with `place`."""
    if isinstance(chosen, Pair):
        yield from _mesh(model, chosen.mesh, result, f"{place}mesh", 1)
        return
    for name, meshes in (("sun_mesh", chosen.sun_meshes), ("ring_mesh", chosen.ring_meshes)):
        for mesh in meshes:
            yield from _mesh(model, mesh, result, f"{place}{name}", len(meshes))
    yield from _bearings(model, chosen, result, f"{place}planet_bearing")


def _mesh(
    model: Model, mesh: Mesh, result: Result, name: str, count: int
) -> Iterator[tuple[Component, Attribute]]:
    """Results of one of `count` meshes: its loss, the mean of all, and its contact ratios."""
    terms = [watts for key, watts in result.losses.items() if key.startswith(f"{name}_")]
    yield mesh.stage, _custom("power_loss", sum(terms) / count, "W")
    figures = result.meshes.get(name)
    if figures is None or result.fluid is None:  # of a set whose efficiency is given
        return
    for attribute, value in (
        ("radial_contact_ratio", figures.transverse_contact_ratio),
        ("overlap_contact_ratio", figures.overlap_ratio),
        ("operating_viscosity", result.fluid.kinematic_viscosity * 1e6),
    ):
        yield from _standard(model, mesh.stage, attribute, value)


def _bearings(
    model: Model, chosen: PlanetarySet, result: Result, name: str
) -> Iterator[tuple[Component, Attribute]]:
    """Results of each planet bearing: an equal part of the loss of all, and its torque."""
    bearings, figures = planet_bearings(model, chosen), result.bearings.get(name)
    terms = [term for term in result.terms if term.name.startswith(f"{name}_")]
    if not bearings or figures is None or all(item.left_out for item in terms):
        return
    loss = sum(item.watts for item in terms) / len(bearings)
    for bearing in bearings:
        torque = loss / figures.speed if figures.speed > 0 else math.nan
        yield from _bearing(model, bearing, loss, torque)


def _bearing(
    model: Model, bearing: Component, loss: float, torque: float
) -> Iterator[tuple[Component, Attribute]]:
    """Loss and friction torque of a bearing."""
    yield bearing, _custom("power_loss", loss, "W")
    if bearing.type.startswith("rolling_bearing"):
        yield from _standard(model, bearing, "total_frictional_power_loss", loss)
        yield from _standard(model, bearing, "total_frictional_torque", torque)


def _standard(
    model: Model, component: Component, name: str, value: float
) -> Iterator[tuple[Component, Attribute]]:
    """An attribute of the standard, in its unit, if the file has none and its version knows it."""
    known = id_in(name, model.version)
    if known is not None and component.get(name) is None and not math.isnan(value):
        yield component, Attribute(known, term(name).unit, _rounded(value))


def _custom(key: str, value: float, unit: str) -> Attribute:
    """An attribute of this package, in a unit of REXS."""
    name = rexs_unit(unit)
    number = value if unit == "1" else written(value, unit, name)
    return Attribute(f"{CUSTOM}{key}", name, _rounded(number))


def _rounded(value: float) -> float:
    """A computed number with the digits that it may have."""
    return float(format_number(value, DIGITS)) + 0.0
