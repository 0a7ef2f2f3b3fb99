"""Write the tables of measured sets into docs/validation.md, where they stand, and their picture.

    python scripts/update_scoreboard.py

Takes some minutes.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from epicyclic.show.plots.style import figure_bytes
from epicyclic.units import percent
from epicyclic.validation.pages import score_markdown
from epicyclic.validation.plots import scores_figure
from epicyclic.validation.scoreboard import DEFAULTS, Score, read_sets, scoreboard

DOCS = Path(__file__).parents[1] / "docs"
PAGE, PICTURE = DOCS / "validation.md", DOCS / "_static" / "measured.svg"


def matrix(head: str, scores: Sequence[Score]) -> str:
    """Mean errors, a row for each model and a column for each set."""
    names = list(dict.fromkeys(score.set.name for score in scores))
    errors = {(score.run, score.set.name): score.mean_error for score in scores}
    rows = [(head, *names), ("---",) * (len(names) + 1)]
    for run in dict.fromkeys(score.run for score in scores):
        found = (errors.get((run, name)) for name in names)
        rows.append((run, *("-" if it is None else percent(it, 0) for it in found)))
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def main() -> None:
    write(scoreboard(read_sets(), others=True))


def write(scores: Sequence[Score]) -> None:
    """The tables of all scores; by model those of points alone, slopes are formed of many."""
    ours = [score for score in scores if score.run in (DEFAULTS, *score.set.runs)]
    models = [it for it in scores if it not in ours or it.run == DEFAULTS]
    bearings = [score for score in models if hasattr(score.set.case, "bearings")]
    gears = [it for it in models if it not in bearings and not it.set.tests]
    text = PAGE.read_text(encoding="utf-8")
    for head, table in (
        ("measured set", score_markdown(ours)),
        ("friction model", matrix("friction model", gears)),
        ("bearing model", matrix("bearing model", bearings)),
    ):
        pattern = re.compile(rf"^\| {head} \|.*?\n\n", re.DOTALL | re.MULTILINE)
        assert pattern.search(text), head
        text = pattern.sub(f"{table}\n\n", text, count=1)
    PAGE.write_text(text, encoding="utf-8")
    PICTURE.write_bytes(figure_bytes(scores_figure(scores), "svg"))


if __name__ == "__main__":
    main()
