"""The loaded tests of the dissertation with temperatures that follow from the losses.

Nothing is fitted to them: what is not published of their heat is varied over its plausible range.
"""

from __future__ import annotations

import itertools
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from importlib import resources
from typing import Any, NamedTuple

from epicyclic.errors import ConvergenceError
from epicyclic.sweeps.plan import PointList
from epicyclic.sweeps.runner import HERE, Runner
from epicyclic.sweeps.unloaded import as_tested, with_unloaded
from epicyclic.validation.compare import published_figures
from epicyclic.validation.compute import FIGURES, LoadedTests, loaded_conditions, source_case

_MODEL = "models.temperatures"
_OF_TESTS = ("branch_slope", "load_dependent_loss", "loss_share")
"""Figures that follow from the loaded tests."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """An input of the heat network that is not published."""

    key: str
    what: str
    low: float | str  # As a case file has them.
    value: float | str  # As a case file has them.
    high: float | str  # As a case file has them.
    origin: str


@dataclass(frozen=True, slots=True)
class SettledFigure:
    """A figure of the loaded tests, with load-dependent losses as a test rig forms them."""

    what: str
    unit: str
    # The published value, or the ends of its range; empty where none is known here.
    published: tuple[float, ...]
    inlet: float  # By how temperatures follow.
    flank: float  # By how temperatures follow.
    network: float  # By how temperatures follow.
    low: float  # The least and the most of the network with all combinations of `estimates`.
    high: float  # The least and the most of the network with all combinations of `estimates`.


class _Test(NamedTuple):
    input_power: float
    load_dependent: float


@cache
def _content() -> dict[str, Any]:
    file = resources.files("epicyclic.validation").joinpath("settled.toml")
    return tomllib.loads(file.read_text(encoding="utf-8"))


def estimates() -> tuple[Estimate, ...]:
    """Inputs of the network that are not published, and their plausible ranges."""
    return tuple(Estimate(**item) for item in _content()["estimate"])


def settled_figures(runner: Runner = HERE) -> tuple[SettledFigure, ...]:
    """Every published figure of the loaded tests, and the slopes at all temperatures and finishes.

    Raises
    ------
    ConvergenceError
        If a test cannot be computed.
    """
    networks = list(_networks())
    settings = [{_MODEL: "inlet"}, {_MODEL: "flank"}, *networks]
    inlet, flank, *others = _tests_of(settings, runner)
    middle = others[networks.index(_network(item.value for item in estimates()))]
    return tuple(
        SettledFigure(
            what=figure["what"],
            unit=figure["unit"],
            published=tuple(figure[key] for key in ("value", "low", "high") if key in figure),
            inlet=_compute(figure, inlet),
            flank=_compute(figure, flank),
            network=_compute(figure, middle),
            low=min(_compute(figure, one) for one in others),
            high=max(_compute(figure, one) for one in others),
        )
        for figure in _figures()
    )


def _networks() -> Iterator[dict[str, Any]]:
    """All combinations of the estimates and the ends of their ranges."""
    ways = [(item.low, item.value, item.high) for item in estimates()]
    return map(_network, itertools.product(*ways))


def _network(values: Iterable[float | str]) -> dict[str, Any]:
    """What a case changes that takes these values of the estimates."""
    keys = (item.key for item in estimates())
    return {_MODEL: "network", **dict(zip(keys, values, strict=True))}


def _figures() -> Iterator[dict[str, Any]]:
    """Those that are published, then slopes of which no measurement is kept here."""
    known = [figure for figure in published_figures() if figure["compute"] in _OF_TESTS]
    yield from known
    content = _content()
    for finish, temperature in itertools.product(content["finishes"], content["temperatures"]):
        given = {"temperature": temperature, "finish": finish, "planets": content["planets"]}
        if not any(figure["with"] == given for figure in known):
            yield {
                "what": f"slope of the branch loss over the branch power, {finish}, {temperature}",
                "unit": "%",
                "compute": "branch_slope",
                "with": given,
            }


def _compute(figure: Mapping[str, Any], tests: LoadedTests) -> float:
    return FIGURES[figure["compute"]](**figure["with"], tests=tests)


def _tests_of(settings: Sequence[Mapping[str, Any]], runner: Runner) -> list[LoadedTests]:
    """The loaded tests with each of the settings, all computed in one go."""
    content = _content()
    conditions = [
        test
        for temperature, finish in itertools.product(content["temperatures"], content["finishes"])
        for test in loaded_conditions(temperature, finish, content["planets"])
    ]
    points, unloaded = with_unloaded([{**test, **own} for own in settings for test in conditions])
    rows = runner.run(PointList(source_case(), points))
    if rows.failures:
        raise ConvergenceError(
            f"{len(rows.failures)} of {len(rows)} tests cannot be computed: {rows.failures[0]}"
        )
    loss = as_tested(rows, unloaded)
    tests = list(map(_Test, rows.numbers("input_power")[: loss.size].tolist(), loss.tolist()))
    names, count = [tuple(test.values()) for test in conditions], len(conditions)
    return [
        partial(_chosen, dict(zip(names, tests[first : first + count], strict=True)))
        for first in range(0, len(tests), count)
    ]


def _chosen(
    tests: Mapping[tuple[Any, ...], _Test], temperature: str, finish: str, planets: Iterable[int]
) -> list[_Test]:
    chosen = loaded_conditions(temperature, finish, planets)
    return [tests[tuple(test.values())] for test in chosen]
