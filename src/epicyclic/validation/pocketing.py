"""What is published of the parametric study of pocketing losses. Talbot (2012), section 4.4."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from epicyclic.case.case import Case, GearPairCase, read_case
from epicyclic.sweeps.pocketing_plan import STUDIES, make_study
from epicyclic.sweeps.pocketing_study import study_datasets
from epicyclic.sweeps.runner import HERE, Runner
from epicyclic.units import DEGREE, MILLIMETRE, RPM
from epicyclic.validation.closures import open_figures
from epicyclic.validation.compare import published_figures

if TYPE_CHECKING:
    import xarray as xr

EXAMPLE = "talbot-2012-pair"
_SAME = ("gears", "pinion", "gear", "lubricant", "surroundings")
"""Tables in which a case must agree with the example."""


@dataclass(frozen=True, slots=True)
class PublishedStudy:
    """Values that the text of the source prints, in display units."""

    helix_angle: float  # A loss and where it holds. [deg], [mm], [rpm], [W]
    face_width: float  # A loss and where it holds. [deg], [mm], [rpm], [W]
    speed: float  # A loss and where it holds. [deg], [mm], [rpm], [W]
    loss: float  # A loss and where it holds. [deg], [mm], [rpm], [W]
    exponent: float  # Exponent of the speed in the loss of the spur pair. [1]
    # Helix angle, face width, and the losses between which the one at `speed` lies, by the axes of
    # the figures. [deg], [mm], [W], [W]
    bands: tuple[tuple[float, float, float, float], ...] = ()


FIGURES_AGAIN = {study.figure.removeprefix("Fig. "): name for name, study in STUDIES.items()}
"""Figures of section 4.4, and the study behind each."""


AS_IN_THE_SOURCE = {"models.pocketing": "talbot-2012"}
"""The flow that is meant for this comparison."""


def study_again(
    figures: Sequence[str], runner: Runner = HERE
) -> tuple[Case, dict[str, xr.Dataset]]:
    """The example of the source, and the studies of its figures by their numbers."""
    case = read_case(EXAMPLE).updated(AS_IN_THE_SOURCE)
    names = {FIGURES_AGAIN[figure]: figure for figure in figures if figure in FIGURES_AGAIN}
    if not names:
        return case, {}
    plan = make_study(case, names, mesh=None, ranges={}, levels={})
    found = study_datasets(plan, runner.run(plan))
    return case, {names[name]: data for name, data in found.items()}


def published_study(case: Case) -> PublishedStudy | None:
    """The published values if they hold for `case`, the example of the source."""
    example = read_case(EXAMPLE)
    assert isinstance(example, GearPairCase)
    if not isinstance(case, GearPairCase) or not _is_example(case, example):
        return None
    loss, exponent = _figure("pocketing_loss"), _figure("pocketing_speed_exponent")
    return PublishedStudy(
        helix_angle=DEGREE.to_display(DEGREE.parse(loss["with"]["helix_angle"])),
        face_width=MILLIMETRE.to_display(example.pinion.face_width),
        speed=RPM.to_display(example.operation.speed),
        loss=loss["value"],
        exponent=exponent["value"],
        bands=tuple(
            (
                DEGREE.to_display(DEGREE.parse(item["helix_angle"])),
                MILLIMETRE.to_display(MILLIMETRE.parse(item["face_width"])),
                item["low"],
                item["high"],
            )
            for item in open_figures()
            if "over" not in item and item["low"] < item["high"]
        ),
    )


def _is_example(case: GearPairCase, example: GearPairCase) -> bool:
    same = all(getattr(case, table) == getattr(example, table) for table in _SAME)
    one, other = (item.operation.oil_inlet_temperature for item in (case, example))
    return same and one == other


def _figure(compute: str) -> dict[str, Any]:
    return next(
        figure
        for figure in published_figures()
        if figure["compute"] == compute and figure["role"] == "validation"
    )
