"""Results into a REXS file.

Attributes of the standard are written where the file has no value of its own. Everything else goes
under ids that begin with ``custom_epicyclic_``, which the standard leaves to programs; these are
written anew each time.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from importlib.metadata import version

from epicyclic.elements.figures import MeshFigures
from epicyclic.errors import InputError, Problem
from epicyclic.exchange.rexs.content import Content
from epicyclic.exchange.rexs.draft import DIGITS
from epicyclic.exchange.rexs.model import Attribute, Component, Model
from epicyclic.exchange.rexs.planetary import planet_bearings
from epicyclic.exchange.rexs.sets import Mesh, Pair, PlanetarySet
from epicyclic.exchange.rexs.vocabulary import CUSTOM, id_in, rexs_unit, term, written
from epicyclic.results.result import Result
from epicyclic.units import format_number

__all__ = ["check_match", "write_results"]


def write_results(
    content: Content, model: Model, chosen: PlanetarySet | Pair, result: Result
) -> None:
    """Give the components of a gear set the figures of `result`."""
    for component, attribute in _attributes(model, chosen, result):
        content.set_attribute(component.id, attribute)


def check_match(chosen: PlanetarySet | Pair, result: Result) -> None:
    """Raise InputError if a result is not of the gear set of a file, by its numbers of teeth."""
    if isinstance(chosen, Pair):
        members = {"pinion": chosen.pinion, "gear": chosen.gear}
    else:
        members = {"sun": chosen.sun, "planet": chosen.planets[0], "ring": chosen.ring}
    problems = []
    for name, component in members.items():
        stated = component.get("number_of_teeth")
        table = result.inputs.get(name)
        here = table["teeth"] if table else None
        there = None if stated is None else abs(stated.number())
        if here != there:
            problems.append(
                Problem(
                    f"{name}.teeth",
                    f"{here}",
                    f"is {there} in {component}.",
                    "Write the results of a gear set into its own file.",
                )
            )
    if problems:
        raise InputError(problems)


def _attributes(
    model: Model, chosen: PlanetarySet | Pair, result: Result
) -> Iterator[tuple[Component, Attribute]]:
    stage = chosen.component
    yield stage, Attribute(f"{CUSTOM}version", "none", version("epicyclic"))
    left_out = {term.name for term in result.terms if term.left_out}
    for figure in result.numbers():
        if figure.key not in left_out and not math.isnan(figure.value):
            yield stage, _custom(figure.key, figure.value, figure.unit)
    if isinstance(chosen, Pair):
        yield from _mesh(model, chosen.mesh, result, "mesh", 1)
        return
    for name, meshes in (("sun_mesh", chosen.sun_meshes), ("ring_mesh", chosen.ring_meshes)):
        for mesh in meshes:
            yield from _mesh(model, mesh, result, name, len(meshes))
    yield from _bearings(model, chosen, result)


def _mesh(
    model: Model, mesh: Mesh, result: Result, name: str, count: int
) -> Iterator[tuple[Component, Attribute]]:
    """Of one of `count` meshes: its loss, the mean of all, and its contact ratios."""
    terms = [watts for key, watts in result.losses.items() if key.startswith(f"{name}_")]
    yield mesh.stage, _custom("power_loss", sum(terms) / count, "W")
    figures: MeshFigures = result.meshes[name]
    for attribute, value in (
        ("radial_contact_ratio", figures.transverse_contact_ratio),
        ("overlap_contact_ratio", figures.overlap_ratio),
        ("operating_viscosity", result.fluid.kinematic_viscosity * 1e6),
    ):
        yield from _standard(model, mesh.stage, attribute, value)


def _bearings(
    model: Model, chosen: PlanetarySet, result: Result
) -> Iterator[tuple[Component, Attribute]]:
    """Of each planet bearing: an equal part of the loss of all, and its torque."""
    bearings = planet_bearings(model, chosen)
    terms = [term for term in result.terms if term.name.startswith("planet_bearing_")]
    if not bearings or result.bearing is None or all(item.left_out for item in terms):
        return
    loss = sum(item.watts for item in terms) / len(bearings)
    for bearing in bearings:
        yield bearing, _custom("power_loss", loss, "W")
        if bearing.type.startswith("rolling_bearing"):
            yield from _standard(model, bearing, "total_frictional_power_loss", loss)
            if result.bearing.speed > 0:
                torque = loss / result.bearing.speed
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
