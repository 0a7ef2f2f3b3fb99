"""One line contact: solved, and its figures."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

from epicyclic.case.contact import ContactCase, contact_model
from epicyclic.ehl.rough import RoughSolution, solve_rough
from epicyclic.ehl.steady import SmoothSolution, solve_smooth
from epicyclic.status import Status

__all__ = ["ContactFigure", "ContactResult", "solve_contact"]

FRAMES = 60
"""Moments kept for an animation."""


@dataclass(frozen=True, slots=True)
class ContactFigure:
    """A number of a contact. `value` is SI, `unit` the SI unit, `display` the unit of tables."""

    name: str
    value: float
    unit: str
    display: str


@dataclass(frozen=True, eq=False)
class ContactResult:
    """Solution of a contact.

    Attributes
    ----------
    case : ContactCase
    smooth : SmoothSolution
    rough : RoughSolution or None
        None without roughness.
    """

    case: ContactCase
    smooth: SmoothSolution
    rough: RoughSolution | None

    @property
    def status(self) -> Status:
        """Of the solution that counts."""
        return self.smooth.status if self.rough is None else self.rough.status

    @property
    def message(self) -> str:
        """Why it failed; empty if it did not."""
        return self.smooth.message if self.rough is None else self.rough.message

    @property
    def figures(self) -> list[ContactFigure]:
        """Everything a table shows; none if the smooth solution failed."""
        if self.smooth.status is not Status.CONVERGED:
            return []
        contact, smooth = self.smooth.contact, self.smooth
        found = [
            ContactFigure("Hertz pressure", contact.hertz_pressure, "Pa", "GPa"),
            ContactFigure("Hertz half-width", contact.half_width, "m", "mm"),
            ContactFigure("line load", contact.line_load, "N/m", "N/mm"),
            ContactFigure("sliding speed", contact.sliding_speed, "m/s", "m/s"),
            ContactFigure("Moes load number", contact.moes_load, "1", "1"),
            ContactFigure("Moes material number", contact.moes_material, "1", "1"),
            ContactFigure("smooth: central film", smooth.central_film, "m", "um"),
            ContactFigure("smooth: minimum film", smooth.minimum_film, "m", "um"),
            ContactFigure("smooth: friction coefficient", smooth.friction_coefficient, "1", "1"),
            ContactFigure("smooth: rolling loss", smooth.rolling_loss, "W/m", "W/m"),
        ]
        rise = float(smooth.temperature_rise.max())
        if rise > 0:
            found.append(ContactFigure("smooth: highest temperature rise", rise, "K", "K"))
        rough = self.rough
        if rough is not None:
            found += [
                ContactFigure("friction coefficient", rough.friction_coefficient, "1", "1"),
                ContactFigure("its standard error", rough.friction_error, "1", "1"),
                ContactFigure("friction of asperities", rough.asperity_friction_share, "1", "%"),
                ContactFigure("load on asperities", rough.asperity_load_share, "1", "%"),
                ContactFigure("length in contact", rough.contact_share, "1", "%"),
                ContactFigure("least film, mean in time", rough.mean_least_film, "m", "um"),
                ContactFigure(
                    "highest pressure, mean in time", rough.mean_highest_pressure, "Pa", "GPa"
                ),
                ContactFigure("rolling loss", rough.rolling_loss, "W/m", "W/m"),
            ]
        return [figure for figure in found if math.isfinite(figure.value)]

    def to_json(self) -> str:
        """Figures in SI units, status, and the pressure and film of the smooth contact."""
        smooth, rough = self.smooth, self.rough
        data: dict[str, Any] = {
            "title": self.case.title,
            "status": str(self.status),
            "message": self.message,
            "figures": {
                figure.name: {"value": figure.value, "unit": figure.unit} for figure in self.figures
            },
        }
        if smooth.status is Status.CONVERGED:
            data["smooth"] = {
                "iterations": smooth.iterations,
                "x": smooth.x.tolist(),
                "pressure": smooth.pressure.tolist(),
                "film": smooth.film.tolist(),
                "shear_stress": smooth.shear_stress.tolist(),
                "temperature_rise": smooth.temperature_rise.tolist(),
            }
        if rough is not None:
            data["rough"] = {
                "time_steps": rough.steps,
                "unsolved_time_steps": rough.unsolved_steps,
                "friction": rough.friction.tolist(),
            }
        return json.dumps(data, indent=2, allow_nan=False)


def solve_contact(case: ContactCase, frames: bool = False) -> ContactResult:
    """Solve a contact, with `FRAMES` moments of a rough one if `frames`."""
    model = contact_model(case)
    if model.smooth:
        return ContactResult(case, solve_smooth(model.contact, heating=model.heating), None)
    contact = model.contact
    interval = 6 * contact.half_width / contact.rolling_speed / FRAMES if frames else None
    rough = solve_rough(
        contact, *model.surfaces, model.asperities, case.numerics.nodes, interval, model.heating,
        case.numerics.frozen_roughness, case.numerics.most_blocks,
        case.numerics.friction_tolerance,
    )  # fmt: skip
    return ContactResult(case, rough.smooth, rough)
