"""Write the tables of measured sets into docs/validation.md and README.md, and their pictures.

    python scripts/update_scoreboard.py

Takes some ten minutes.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from epicyclic.oil.oil import LIMITING_TRACTION as LIMITS
from epicyclic.schema.read import plain
from epicyclic.show.plots.style import figure_bytes
from epicyclic.units import percent
from epicyclic.validation.pages import SCORE_HEADS, score_rows
from epicyclic.validation.plots import scores_figure
from epicyclic.validation.scoreboard import (
    DEFAULTS,
    MeasuredSet,
    Score,
    read_sets,
    scoreboard,
    scored,
)

DOCS = Path(__file__).parents[1] / "docs"
PAGE, PICTURE = DOCS / "validation.md", DOCS / "_static" / "measured.svg"
README, FLOW = DOCS.parent / "README.md", DOCS / "_static" / "power-flow.svg"
LIMITING_TRACTION = "limiting traction"
RANGES: dict[str, tuple[float, float]] = {
    "models.boundary_friction": (0.065, 0.08),  # Arana et al. (2019), with and without additives.
    "models.hurst_exponent": (0.3, 0.8),  # Estimate: machined steel.
    "models.running_in_factor": (0.5, 0.8),  # Estimate.
    LIMITING_TRACTION: (0.9, 1.1),  # Times that of the oil; estimate.
}
"""Ends of what parameters of mixed lubrication may be. [1]"""


def score_markdown(scores: Sequence[Score]) -> str:
    """`score_rows` as the manual shows them."""
    heads = ("measured set", *SCORE_HEADS[1:])
    cells = [heads, ("---",) * len(heads), *score_rows(scores)]
    return "\n".join(f"| {' | '.join(row)} |" for row in cells).replace("|  |", "| |")


def model_factor(scores: Sequence[Score]) -> float:
    """Lognormal factor of a model: exp of the rms of ln(computed/measured), all sets alike."""
    squares = [np.nanmean(np.log1p(score.errors) ** 2) for score in scores]
    return float(np.exp(np.sqrt(np.mean(squares))))


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of Markdown."""
    lines = [head, ("---",) * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def matrix(head: str, scores: Sequence[Score]) -> str:
    """Mean errors, a row for each model and a column for each set."""
    names = list(dict.fromkeys(score.set.name for score in scores))
    errors = {(score.run, score.set.name): score.mean_error for score in scores}
    runs = dict.fromkeys(score.run for score in scores)
    found = ((run, [errors.get((run, name)) for name in names]) for run in runs)
    rows = ((run, *("-" if it is None else percent(it, 0) for it in row)) for run, row in found)
    return table((head, *names), rows)


def sensitivity(scores: Sequence[Score]) -> str:
    """By how many points the bias of each set moves at both ends of each parameter."""
    head = ("parameter", "from", "to", *(score.set.name for score in scores))
    return table(head, (row for name in RANGES for row in _moves(name, scores)))


def _moves(name: str, scores: Sequence[Score]) -> Iterator[Sequence[str]]:
    cells = []
    for score in scores:
        own = score.set
        if name == "models.running_in_factor" and own.case.models.running_in == "as-made":
            cells.append("-")
            continue
        biases = [scored(own, name, _changed(own, name, end)).bias for end in RANGES[name]]
        cells.append(" / ".join(f"{100 * (it - score.bias):+.0f}" for it in biases))
    key = f"`{name}`" if "." in name else f"{name}, times"
    yield key, *(f"{end:g}" for end in RANGES[name]), *cells


def _changed(own: MeasuredSet, name: str, value: float) -> dict[str, Any]:
    if name != LIMITING_TRACTION:
        return {name: value}
    assert own.case.lubricant is not None
    oil = own.case.lubricant.oil
    stated = oil.limiting_traction or LIMITS[oil.kind]
    changed = {"value": value * stated.value, "source": stated.source}
    return {"lubricant.oil": {**plain(oil), "limiting_traction": changed}}


def factors(scores: Sequence[Score], kind: str) -> Iterator[tuple[int, Sequence[str]]]:
    """For each set the factor of its model that the other sets give, and what lies inside it."""
    for score in scores:
        own, others = score.set, [it for it in scores if it is not score]
        factor = model_factor(others)
        given = plain(own.case.given()).get("uncertainty", {})
        uncertain = given | {f"model_form.{kind}": {"lognormal_factor": factor}}
        again = scored(own, "", {"uncertainty": uncertain}, banded=True)
        assert again.inside is not None
        yield again.inside, (
            own.name, kind, f"{model_factor([score]):.2f}", f"{factor:.2f}",
            f"{again.inside} of {len(own.points)}",
        )  # fmt: skip


def of_defaults(scores: Sequence[Score]) -> tuple[str, str]:
    """Tables of parameters, and of factors of models."""
    bearings = [it for it in scores if hasattr(it.set.case, "bearings")]
    gears = [it for it in scores if it not in bearings]
    rows: list[Sequence[str]] = []
    count, inside = sum(len(it.set.points) for it in scores), 0
    for kind, own in (("sliding", gears), ("shaft-bearings", bearings)):
        counts, found = zip(*factors(own, kind), strict=True)
        inside += sum(counts)
        rows += [*found, ("none", kind, "", f"{model_factor(own):.2f}", "")]
    rows.append(("each in turn", "", "", "", f"{inside} of {count}, {percent(inside / count, 0)}"))
    head = ("set left out", "model", "its own factor", "factor of the others", "inside with it")
    return sensitivity(gears), table(head, rows)


def main() -> None:
    """The tables of all scores; by model those of points alone, slopes are formed of many."""
    parameters, left_out = of_defaults(scoreboard(read_sets()))
    scores = scoreboard(read_sets(), others=True)
    ours = [score for score in scores if score.run in (DEFAULTS, *score.set.runs)]
    models = [it for it in scores if it not in ours or it.run == DEFAULTS]
    bearings = [score for score in models if hasattr(score.set.case, "bearings")]
    gears = [it for it in models if it not in bearings and not it.set.tests]
    put(README, {"measured set": score_markdown([it for it in ours if it.run == DEFAULTS])})
    contents = {
        "measured set": score_markdown(ours),
        "friction model": matrix("friction model", gears),
        "bearing model": matrix("bearing model", bearings),
        "parameter": parameters,
        "set left out": left_out,
    }
    put(PAGE, contents)
    PICTURE.write_bytes(figure_bytes(scores_figure(scores), "svg"))
    subprocess.run(
        [sys.executable, "-m", "epicyclic", "plot", "train-eaxle", "power-flow", "-o", str(FLOW)],
        check=True,
    )


def put(page: Path, contents: Mapping[str, str]) -> None:
    """Write tables where tables with such first heads stand."""
    text = page.read_text(encoding="utf-8")
    for head, content in contents.items():
        pattern = re.compile(rf"^\| {head} \|.*?\n\n", re.DOTALL | re.MULTILINE)
        assert pattern.search(text), head
        text = pattern.sub(f"{content}\n\n", text, count=1)
    page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
