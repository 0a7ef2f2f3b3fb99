"""Compare the published figures with what is computed."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any, Literal

from epicyclic.validation.closures import CLOSURES, ClosureFigure
from epicyclic.validation.compute import FIGURES

Verdict = Literal["agrees", "differs", "calibrated", "no verdict"]
_TOPICS = {
    "Planet bearings": ("planet_bearing_loss", "planet_bearing_ratio", "azimuth_of_gained_rollers"),
    "Pockets": (),
    "Air-oil mixture": ("mixture_density", "mixture_viscosity"),
    "Planetary sets, tests": (
        "branch_slope", "load_dependent_loss", "load_independent_loss", "loss_share",
    ),
    "Stiffness of teeth": ("single_stiffness", "mean_mesh_stiffness"),
    "Trains": ("train_ratio", "train_efficiency"),
    "Temperatures": ("bulk_temperature", "pair_bulk_temperature", "pair_flash_temperature"),
    "KISSsoft, NREL 5 MW": ("nrel-1", "nrel-2"),
    "GEARpie": ("gearpie-c14", "gearpie-c40"),
}  # fmt: skip
"""The functions that compute the figures, or the cases of other programs; whatever begins with
``pocket`` is about pockets."""
FILES = ("published.toml", "programs.toml")
"""What is published, and what other programs print."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """One published figure and the computed one."""

    what: str
    topic: str
    unit: str
    source: str
    low: float  # The published value, twice, or the published range.
    high: float  # The published value, twice, or the published range.
    computed: float
    tolerance: float  # Relative to the published value. [1]
    cause: str  # Why that tolerance.
    role: str  # ``"validation"``, ``"calibration"`` or ``"context"``.
    # How the tolerance was: ``"print"``, the rounding of what is printed, or ``"in view"`` of the
    # computed figure.
    settled: str = ""
    # How the published value follows from what is printed; empty if it is printed itself.
    inferred: str = ""
    reason: str = ""  # Why there is no verdict; empty if there is.

    @property
    def difference(self) -> float:
        """(computed - published)/published; 0 within a published range. [1]"""
        nearest = min(max(self.computed, self.low), self.high)
        return (self.computed - nearest) / nearest

    @property
    def verdict(self) -> Verdict:
        """Agreement within the tolerance; calibration and context get none."""
        if self.role == "calibration":
            return "calibrated"
        if self.role == "context":
            return "no verdict"
        return "agrees" if abs(self.difference) <= self.tolerance else "differs"


def compare_published(
    progress: Callable[[int, int], None] = lambda done, total: None, topic: str = ""
) -> tuple[Comparison, ...]:
    """Every published figure whose model exists, or those of a topic, compared."""
    figures = [item for item in published_figures() if topic in ("", _topic(item))]
    rows = []
    for number, figure in enumerate(figures):
        rows.append(_compare(figure))
        progress(number + 1, len(figures))
    return tuple(rows)


def published_figures() -> list[dict[str, Any]]:
    """The entries of all `FILES`."""
    folder = resources.files("epicyclic.validation")
    texts = (folder.joinpath(name).read_text(encoding="utf-8") for name in FILES)
    return [figure for text in texts for figure in tomllib.loads(text)["figure"]]


def by_topic(rows: Sequence[Comparison]) -> dict[str, list[Comparison]]:
    """The rows of each topic, in the order of the topics."""
    found = {topic: [row for row in rows if row.topic == topic] for topic in _TOPICS}
    return {topic: own for topic, own in found.items() if own}


def _topic(figure: Mapping[str, Any]) -> str:
    name = figure["with"].get("case", figure["compute"])
    if name.startswith("pocket"):
        return "Pockets"
    return next(topic for topic, names in _TOPICS.items() if name in names)


def summary(
    rows: Sequence[Comparison],
    # Open figures of pocketing losses, which are counted apart.
    closures: Sequence[ClosureFigure] = (),
) -> str:
    """How many figures agree, and how much each kind of agreement says."""
    return " ".join((*_sentences(rows), *_of_closures(closures)))


def _of_closures(closures: Sequence[ClosureFigure]) -> Iterator[str]:
    if closures:
        held = (
            f"{sum(figure.holds(model) for figure in closures)} with {model}" for model in CLOSURES
        )
        yield f"Of {len(closures)} open figures of pocketing hold {', '.join(held)}."


def _sentences(rows: Sequence[Comparison]) -> Iterator[str]:
    counted = [row for row in rows if row.role == "validation"]
    agreeing = [row for row in counted if row.verdict == "agrees"]
    printed = sum(row.settled == "print" for row in agreeing)
    inferred = sum(bool(row.inferred) for row in counted)
    yield (
        f"{len(agreeing)} of {len(counted)} figures agree: {printed} to the digits that are "
        f"printed, {len(agreeing) - printed} within a tolerance that was settled with the computed "
        f"figure in view (*). Differing: {len(counted) - len(agreeing)}."
    )
    if inferred:
        yield f"{inferred} of the {len(counted)} are not printed as such but inferred, as stated."
    calibrated = sum(row.role == "calibration" for row in rows)
    yield (
        f"Not counted: {calibrated} that fixed an unknown input, and "
        f"{sum(row.role == 'context' for row in rows)} without a verdict, for the reasons stated."
    )


def _compare(figure: dict[str, Any]) -> Comparison:
    return Comparison(
        what=figure["what"],
        topic=_topic(figure),
        unit=figure["unit"],
        source=figure["source"],
        low=figure["low"] if "low" in figure else figure["value"],
        high=figure["high"] if "high" in figure else figure["value"],
        computed=FIGURES[figure["compute"]](**figure["with"]),
        tolerance=figure.get("tolerance", 0.0),
        cause=figure.get("cause", ""),
        role=figure["role"],
        settled=figure.get("settled", ""),
        inferred=figure.get("inferred", ""),
        reason=figure.get("reason", ""),
    )
