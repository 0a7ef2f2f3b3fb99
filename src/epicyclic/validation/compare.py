"""Published figures compared with what is computed."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any, Literal

import numpy as np

from epicyclic.dataclass import dataclass, fields
from epicyclic.errors import ConvergenceError
from epicyclic.study.bands.plan import nearby_at
from epicyclic.study.bands.samples import sample_summary
from epicyclic.study.bands.study import quick_band
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.run import PointList, as_tested, with_unloaded
from epicyclic.study.sweeps.runner import HERE, Rows, Runner
from epicyclic.validation.compute import (
    FIGURES,
    LoadedTest,
    data_file,
    loaded_conditions,
    source_case,
)

# The open figures of the published study of pocketing losses, for each model of the flow.

CLOSURES = ("incompressible", "isentropic", "mean-density", "talbot-2012")
"""Models that are compared; "central-differences" has no solution for some of the figures."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Published:
    """What is published of one figure, and how far off a computed one may be."""

    what: str
    unit: str
    source: str
    low: float  # The published value, twice, or the ends of the published range.
    high: float
    tolerance: float = 0.0  # Relative to the published value. [1]
    cause: str = ""  # Why that tolerance.

    def off(self, computed: float) -> float:
        """(computed - published)/published; 0 within a published range. [1]"""
        nearest = min(max(computed, self.low), self.high)
        return (computed - nearest) / nearest


@dataclass(frozen=True, slots=True, kw_only=True)
class ClosureFigure(Published):
    """One open figure of the study, computed with every model."""

    computed: dict[str, float]  # By model, as `CLOSURES`.

    def holds(self, model: str) -> bool:
        """Whether the value of a model is in the band, or within the tolerance of it."""
        return abs(self.off(self.computed[model])) <= self.tolerance


def closure_figures(
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> tuple[ClosureFigure, ...]:
    """All open figures, computed with every model."""
    found: list[ClosureFigure] = []
    figures = [figure for figure in open_figures() if figure.get("role") != "context"]
    for figure in figures:
        computed = {model: _computed(figure, model=model) for model in CLOSURES}
        found.append(ClosureFigure(**_stated(ClosureFigure, figure), computed=computed))
        progress(len(found), len(figures))
    return tuple(found)


def open_figures() -> list[dict[str, Any]]:
    """The entries of `pocketing.toml`; printed ones have a value, the others a band."""
    content = data_file("pocketing.toml")
    conditions = ("of", "over", "unit", "exponent")
    return [
        {
            **content["default"],
            **figure,
            "compute": "pocketing_figure",
            "with": {key: figure[key] for key in conditions if key in figure},
        }
        for figure in content["figure"]
    ]


def published_ends(figure: Mapping[str, Any]) -> tuple[float, float]:
    """The published value, twice, or the ends of the published range."""
    return (figure["low"], figure["high"]) if "low" in figure else (figure["value"],) * 2


def _stated(kind: type[Published], figure: Mapping[str, Any]) -> dict[str, Any]:
    """The fields of a comparison that the entry of a figure states."""
    stated = {field.name: figure[field.name] for field in fields(kind) if field.name in figure}
    return stated | dict(zip(("low", "high"), published_ends(figure), strict=True))


def _computed(figure: Mapping[str, Any], **more: Any) -> float:
    """NaN where it is kept without being computed."""
    if "compute" not in figure:
        return math.nan
    return FIGURES[figure["compute"]](**figure["with"], **more)


Verdict = Literal["agrees", "differs", "calibrated", "no verdict", "not computed"]
_TOPICS = {
    "Planet bearings": (
        "planet_bearing_loss", "planet_bearing_ratio", "planet_bearing_change",
        "azimuth_of_gained_rollers",
    ),
    "Pockets": ("pocketing_figure",),
    "Air-oil mixture": ("mixture_density", "mixture_viscosity"),
    "Planetary sets, tests": (
        "composite_roughness", "branch_slope", "slope_gain", "loss_in_test", "loss_change",
        "spin_share", "prediction_difference", "loss_share", "branch_loss_ratio", "branch_spin",
        "branch_spin_exponent",
    ),
    "Stiffness of teeth": ("single_stiffness", "mean_mesh_stiffness"),
    "Trains": ("train_ratio", "train_efficiency"),
    "Temperatures": ("bulk_temperature", "pair_bulk_temperature", "pair_flash_temperature"),
    "KISSsoft, NREL 5 MW": ("nrel-1", "nrel-2"),
    "GEARpie": ("gearpie-c14", "gearpie-c40"),
}  # fmt: skip
"""The functions that compute the figures, or the cases of other programs."""
FILES = ("published.toml", "programs.toml")  # What is published, and what other programs print.


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison(Published):
    """One published figure and the computed one."""

    topic: str
    computed: float
    role: str  # ``"validation"``, ``"calibration"`` or ``"context"``.
    # How the tolerance was: ``"print"``, the rounding of what is printed, or ``"in view"`` of the
    # computed figure.
    settled: str = ""
    # How the published value follows from what is printed; empty if it is printed itself.
    inferred: str = ""
    reason: str = ""  # Why there is no verdict; empty if there is.
    missed: str = ""  # Why a figure differs, or that this is not known.

    @property
    def difference(self) -> float:
        """(computed - published)/published; 0 within a published range. [1]"""
        return self.off(self.computed)

    @property
    def verdict(self) -> Verdict:
        """Agreement within the tolerance; calibration and context get none."""
        if math.isnan(self.computed):
            return "not computed"
        if self.role == "calibration":
            return "calibrated"
        if self.role == "context":
            return "no verdict"
        return "agrees" if abs(self.difference) <= self.tolerance else "differs"


def compare_published(
    progress: Callable[[int, int], None] = lambda done, total: None,
    topic: str = "",
    where: str = "",
) -> tuple[Comparison, ...]:
    """Every published figure whose model exists, compared: of a topic, or where they are printed.

    `where` is a regular expression, of which the source of a figure has a match.
    """
    figures = [
        item
        for item in published_figures()
        if topic in ("", _topic(item)) and re.search(where, item["source"])
    ]
    rows = []
    for number, figure in enumerate(figures):
        rows.append(_compare(figure))
        progress(number + 1, len(figures))
    return tuple(rows)


def published_figures() -> list[dict[str, Any]]:
    """The entries of all `FILES`, then what is printed of pocketing losses.

    The latter count with the model of the flow that is meant for the comparison.
    """
    pockets = [
        {
            "role": "validation",
            "settled": "in view",
            **figure,
            "with": {"model": CLOSURES[-1], **figure["with"]},
        }
        for figure in open_figures()
        if "value" in figure
    ]
    return [*(figure for name in FILES for figure in data_file(name)["figure"]), *pockets]


def by_topic(rows: Sequence[Comparison]) -> dict[str, list[Comparison]]:
    """The rows of each topic, in the order of the topics."""
    found = {topic: [row for row in rows if row.topic == topic] for topic in _TOPICS}
    return {topic: own for topic, own in found.items() if own}


def _topic(figure: Mapping[str, Any]) -> str:
    if "topic" in figure:
        return str(figure["topic"])
    name = figure["with"].get("case", figure["compute"])
    return next(topic for topic, names in _TOPICS.items() if name in names)


def summary(
    rows: Sequence[Comparison],
    # Open figures of pocketing losses, which are counted apart.
    closures: Sequence[ClosureFigure] = (),
) -> str:
    """How many figures agree, and how much each kind of agreement says."""
    sentences = [*_sentences(rows)]
    if closures:
        held = (
            f"{sum(figure.holds(model) for figure in closures)} with {model}" for model in CLOSURES
        )
        sentences.append(
            f"Of {len(closures)} open pocketing figures, the following agree: {', '.join(held)}."
        )
    return " ".join(sentences)


def _sentences(rows: Sequence[Comparison]) -> Iterator[str]:
    counted = [row for row in rows if row.role == "validation"]
    agreeing = [row for row in counted if row.verdict == "agrees"]
    printed = sum(row.settled == "print" for row in agreeing)
    inferred = sum(bool(row.inferred) for row in counted)
    yield (
        f"{len(agreeing)} of {len(counted)} figures agree: {printed} to the printed digits, "
        f"{len(agreeing) - printed} within a tolerance that was chosen with knowledge of the "
        f"computed figure (*). Differing: {len(counted) - len(agreeing)}."
    )
    if inferred:
        yield f"{inferred} of the {len(counted)} are not printed but inferred, as stated."
    calibrated = sum(row.role == "calibration" for row in rows)
    yield (
        f"Not counted: {calibrated} that calibrated an unknown input, and "
        f"{sum(row.verdict == 'no verdict' for row in rows)} without a verdict and "
        f"{sum(row.verdict == 'not computed' for row in rows)} that cannot be computed, for the "
        "reasons stated."
    )


def _compare(figure: dict[str, Any]) -> Comparison:
    known = {"topic": _topic(figure), "computed": _computed(figure)}
    return Comparison(**_stated(Comparison, figure) | known)


# Published measurements beside the band that the shipped distributions give. Nothing is fitted.

DRAWS = 1024  # Draws from the distributions, the same in all tests.
MEASURED = "measured"  # What the names of measured figures end with.


@dataclass(frozen=True, slots=True)
class MeasuredFigure:
    """A measured figure and the band of the computed one."""

    what: str
    unit: str
    measured: float
    computed: float
    low: float  # Ends of the 95 % band.
    high: float  # Ends of the 95 % band.

    @property
    def is_inside(self) -> bool:
        """Whether the measurement lies within the band."""
        return self.low <= self.measured <= self.high


_Tests = dict[tuple[Any, ...], LoadedTest]
"""Tests by the values of the keys that they change."""


def measured_figures(runner: Runner = HERE) -> tuple[MeasuredFigure, ...]:
    """Every measured figure of the tests of the dissertation, with the band of the computed one.

    All inputs and errors of models are off by the same in all tests of a draw.
    """
    figures = list(_figures())
    draws = _drawn_tests(figures, runner)
    found = []
    for figure in figures:
        nominal, *drawn = (_computed(figure, tests=partial(_chosen, tests)) for tests in draws)
        band = sample_summary(np.array(drawn))
        found.append(
            MeasuredFigure(
                figure["what"], figure["unit"], figure["value"], nominal, band.low, band.high
            )
        )
    return tuple(found)


def _figures() -> Iterable[dict[str, Any]]:
    """Those that are measured, of the tests and computed, and calibrated nothing."""
    for figure in published_figures():
        what, calibrated = figure["what"], figure["role"] == "calibration"
        if what.endswith(MEASURED) and "compute" in figure and not calibrated:
            yield {**figure, "what": what.removesuffix(f", {MEASURED}")}


def _conditions(figures: Iterable[Mapping[str, Any]]) -> dict[tuple[Any, ...], dict[str, Any]]:
    """The tests that figures follow from: the keys that they change, by their values."""
    asked: dict[tuple[Any, ...], dict[str, Any]] = {}
    numbers = itertools.count()

    def tests(temperature: str, finish: str, planets: Iterable[int]) -> list[LoadedTest]:
        conditions = loaded_conditions(temperature, finish, planets)
        asked.update((tuple(test.values()), test) for test in conditions)
        # any powers, no two of them equal: only the conditions are wanted
        places = itertools.islice(numbers, len(conditions))
        return [LoadedTest(9.0 + place, 2.0 + place**2, 5.0 + place) for place in places]

    for figure in figures:
        _computed(figure, tests=tests)
    return asked


def _drawn_tests(figures: Iterable[Mapping[str, Any]], runner: Runner) -> list[_Tests]:
    """All tests of the figures: at their values first, then in each draw."""
    conditions, case = _conditions(figures), source_case()
    draws: list[_Tests] = [{} for _ in range(DRAWS + 1)]
    nearby = nearby_at(case, solve(case), list(conditions.values()), runner)
    for key, own in zip(conditions, nearby, strict=True):
        drawn = quick_band(own).results[:, :DRAWS]
        losses = np.column_stack([own.nominal, drawn])[-4:-2]
        for tests, loss in zip(draws, losses.T.tolist(), strict=True):
            tests[key] = LoadedTest(float(own.powers.entering[0]), *loss)
    return draws


# The loaded tests of the dissertation with temperatures that follow from the losses.
#
# Nothing is fitted to them: what is not published of their heat is varied over its plausible range.

_MODEL = "models.temperatures"
_OF_TESTS = ("branch_slope", "slope_gain", "loss_in_test", "loss_change", "loss_share")
"""Figures that follow from the loaded tests."""
_OTHER_PARTS = ("load_independent", "without_union", "total", "input_power")
"""Losses and powers that are not formed as loaded less unloaded."""


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
    published: tuple[float, ...]  # The published value, or the ends of its range.
    inlet: float  # With everything at the inlet temperature.
    flank: float  # With flanks as their own losses heat them.
    network: float  # With the heat network.
    low: float  # The least of the network with all combinations of `estimates`.
    high: float  # The most of the network with all combinations of `estimates`.


def estimates() -> tuple[Estimate, ...]:
    """Inputs of the network that are not published, and their plausible ranges."""
    return tuple(Estimate(**item) for item in data_file("settled.toml")["estimate"])


def settled_figures(runner: Runner = HERE) -> tuple[SettledFigure, ...]:
    """Every published figure of the loaded tests.

    Raises `ConvergenceError` if a test cannot be computed.
    """
    keys = [item.key for item in estimates()]
    # all combinations of the estimates and the ends of their ranges
    ends = itertools.product(*((item.low, item.value, item.high) for item in estimates()))
    networks: list[dict[str, Any]] = [
        {_MODEL: "network"} | dict(zip(keys, values, strict=True)) for values in ends
    ]
    likely: dict[str, Any] = {_MODEL: "network"}
    likely |= {item.key: item.value for item in estimates()}
    settings = [{_MODEL: "inlet"}, {_MODEL: "flank"}, *networks]
    # The loaded tests with each of the settings, all computed in one go.
    figures = _settled_figures()
    conditions = _conditions(figures)
    tested = ({**test, **own} for own in settings for test in conditions.values())
    points, unloaded = with_unloaded(list(tested))
    rows = rows_of_all(points, runner, "tests")
    loss = as_tested(rows, unloaded)
    tests = list(map(LoadedTest, rows.numbers("input_power")[: loss.size].tolist(), loss.tolist()))
    count = len(conditions)
    inlet, flank, *others = [
        partial(_chosen, dict(zip(conditions, tests[first : first + count], strict=True)))
        for first in range(0, len(tests), count)
    ]
    middle = others[networks.index(likely)]
    return tuple(
        SettledFigure(
            what=figure["what"],
            unit=figure["unit"],
            published=tuple(figure[key] for key in ("value", "low", "high") if key in figure),
            inlet=_computed(figure, tests=inlet),
            flank=_computed(figure, tests=flank),
            network=_computed(figure, tests=middle),
            low=min(_computed(figure, tests=one) for one in others),
            high=max(_computed(figure, tests=one) for one in others),
        )
        for figure in figures
    )


def _settled_figures() -> list[dict[str, Any]]:
    """Those that are about load-dependent losses."""
    return [
        figure
        for figure in published_figures()
        if figure.get("compute") in _OF_TESTS and figure["with"].get("part") not in _OTHER_PARTS
    ]


def rows_of_all(points: Iterable[Mapping[str, Any]], runner: Runner, what: str = "points") -> Rows:
    """Rows of the set of the dissertation with other keys.

    Raises `ConvergenceError` if one of the points, called `what` then, cannot be computed.
    """
    rows = runner.run(PointList(source_case(), tuple(points)))
    if rows.failures:
        raise ConvergenceError(
            f"{len(rows.failures)} of {len(rows)} {what} cannot be computed: {rows.failures[0]}"
        )
    return rows


def _chosen(
    tests: _Tests, temperature: str, finish: str, planets: Iterable[int]
) -> list[LoadedTest]:
    chosen = loaded_conditions(temperature, finish, planets)
    return [tests[tuple(test.values())] for test in chosen]
