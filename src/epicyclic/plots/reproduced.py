"""Every figure of a chapter of Talbot (2012) that is computed again, with its data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from epicyclic.plots.chapters import SOURCE, branch_figure, family_figure, roller_figure
from epicyclic.plots.pocketing_study import study_figure
from epicyclic.sweeps.runner import HERE, Runner
from epicyclic.validation import chapters
from epicyclic.validation.pocketing import published_study, study_again

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Reproduced:
    """A figure of the source, computed again."""

    number: str  # In the source.
    data: xr.Dataset
    picture: Figure


def reproduce(figures: Sequence[str], runner: Runner = HERE) -> Iterator[Reproduced]:
    """Compute and draw figures, ``"3.4"``, published numbers marked on them.

    Raises
    ------
    ConvergenceError
        If a point of chapter 3 or 5 cannot be computed.
    """
    for name in figures:
        if name in chapters.ROLLER_FIGURES:
            cases = chapters.roller_loads_over(name)
            yield Reproduced(name, chapters.joined(cases), roller_figure(name, cases))
    for family in chapters.bearing_families(figures, runner):
        yield Reproduced(family.figure, family.data, family_figure(family))
    case, studies = study_again(figures, runner)
    for name, data in studies.items():
        title = f"{SOURCE}, Fig. {name}: pocketing loss of the mesh of Table 4.1"
        picture = study_figure(data.assign_attrs(title=title), published_study(case))
        yield Reproduced(name, data, picture)
    for family in chapters.set_families(figures, runner):
        draw = branch_figure if "branch_power" in family.data else family_figure
        yield Reproduced(family.figure, family.data, draw(family))
