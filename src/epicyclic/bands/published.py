"""Published measurements beside the band that the shipped distributions give. Nothing is fitted."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.solve import solve
from epicyclic.bands.plan import nearby_at
from epicyclic.bands.quick import quick_band
from epicyclic.bands.statistics import summary
from epicyclic.sweeps.runner import HERE, Runner
from epicyclic.validation.compare import published_figures
from epicyclic.validation.compute import FIGURES, LoadedTests, loaded_conditions, source_case

FloatArray = NDArray[np.float64]

DRAWS = 1024
"""Draws from the distributions, the same in all tests."""
FINISH = "shaved"
"""Finish of the planets where a figure does not say it."""
MEASURED = "measured"
"""What the names of measured figures end with."""


@dataclass(frozen=True, slots=True)
class MeasuredFigure:
    """A measured figure and the band of the computed one."""

    what: str
    unit: str
    source: str
    measured: float
    computed: float
    low: float  # Ends of the 95 % band.
    high: float  # Ends of the 95 % band.

    @property
    def is_inside(self) -> bool:
        """Whether the measurement lies within the band."""
        return self.low <= self.measured <= self.high


class _Test(NamedTuple):
    input_power: float
    load_dependent: float


class _Band(NamedTuple):
    """Input power, and load-dependent and load-independent losses in all draws, of one test."""

    input_power: float
    load_dependent: FloatArray
    load_independent: FloatArray


_Bands = Mapping[tuple[Any, ...], _Band]


def measured_figures(runner: Runner = HERE) -> tuple[MeasuredFigure, ...]:
    """Every measured figure of the tests of the dissertation, with the band of the computed one.

    All inputs and errors of models are off by the same in all tests of a draw.
    """
    figures = list(_figures())
    bands = _bands(figures, runner)
    found = []
    for figure in figures:
        nominal, *drawn = (_compute(figure, bands, number) for number in range(DRAWS + 1))
        band = summary(np.array(drawn))
        found.append(
            MeasuredFigure(
                figure["what"], figure["unit"], figure["source"], figure["value"], nominal,
                band.low, band.high,
            )
        )  # fmt: skip
    return tuple(found)


def _figures() -> Iterable[dict[str, Any]]:
    """Those that are measured; 'the same' is the one before."""
    before = ""
    for figure in published_figures():
        what = figure["what"].replace("the same", before)
        before = what.rpartition(", ")[0]
        if what.endswith(MEASURED):
            yield {**figure, "what": what.removesuffix(f", {MEASURED}")}


def _conditions(figure: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The tests that a figure follows from."""
    given = figure["with"]
    planets = given["planets"]
    counts = planets if isinstance(planets, list) else [planets]
    return loaded_conditions(given["temperature"], given.get("finish", FINISH), counts)


def _bands(figures: Iterable[Mapping[str, Any]], runner: Runner) -> dict[tuple[Any, ...], _Band]:
    """All tests of the figures, each at its values first, then in all draws."""
    tests = {tuple(test.values()): test for figure in figures for test in _conditions(figure)}
    case = source_case()
    found = {}
    nearby = nearby_at(case, solve(case), list(tests.values()), runner)
    for key, own in zip(tests, nearby, strict=True):
        drawn = quick_band(own).results[:, :DRAWS]
        nominal = own.outputs.of(own.losses[:, None], np.array([own.input_power]), {})
        whole = np.concatenate([nominal, drawn], axis=1)
        found[key] = _Band(own.input_power, whole[-4], whole[-3])
    return found


def _compute(figure: Mapping[str, Any], bands: _Bands, draw: int) -> float:
    """A figure in one draw."""
    if figure["compute"] == "load_independent_loss":  # at the highest torque, as all of them
        last = bands[tuple(_conditions(figure)[-1].values())]
        return float(last.load_independent[draw]) / 1e3

    def tests(temperature: str, finish: str, planets: Iterable[int]) -> list[_Test]:
        chosen = (
            bands[tuple(it.values())] for it in loaded_conditions(temperature, finish, planets)
        )
        return [_Test(it.input_power, float(it.load_dependent[draw])) for it in chosen]

    own: LoadedTests = tests
    return FIGURES[figure["compute"]](**figure["with"], tests=own)
