"""One line contact: solved, and its figures."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.contact_limits import contact_flags, contact_notes, film_ratio
from epicyclic.case.contact import ContactCase, ContactModel, contact_model
from epicyclic.case.plain import plain
from epicyclic.ehl.heating import thinning
from epicyclic.ehl.rough import Frame, RoughSolution, solve_rough
from epicyclic.ehl.roughness import Profile
from epicyclic.ehl.steady import SmoothSolution, solve_smooth
from epicyclic.kernels.ehl_steady import shear_stresses
from epicyclic.losses.validity import ValidityFlag, range_left
from epicyclic.results.result import versions
from epicyclic.status import Status

FloatArray = NDArray[np.float64]

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
    """Solution of a contact."""

    case: ContactCase
    model: ContactModel  # What the solver was given.
    smooth: SmoothSolution
    rough: RoughSolution | None  # None without roughness.

    @property
    def status(self) -> Status:
        """Status of the solution that counts."""
        return self.smooth.status if self.rough is None else self.rough.status

    @property
    def message(self) -> str:
        """Why it failed; empty if it did not."""
        return self.smooth.message if self.rough is None else self.rough.message

    @property
    def flags(self) -> tuple[ValidityFlag, ...]:
        """Quantities outside what solver and oil data are good for."""
        if self.smooth.status is not Status.CONVERGED:
            return ()
        return contact_flags(self.case, self.model, self.smooth)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to know before the figures are used."""
        if self.smooth.status is not Status.CONVERGED:
            return ()
        left = (range_left([flag]) for flag in self.flags)
        return (*left, *contact_notes(self.case, self.model, self.smooth, self.rough))

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
            ContactFigure("smooth: highest pressure", float(smooth.pressure.max()), "Pa", "GPa"),
            ContactFigure(
                "smooth: highest shear stress", float(smooth.shear_stress.max()), "Pa", "MPa"
            ),
            ContactFigure("smooth: friction coefficient", smooth.friction_coefficient, "1", "1"),
            ContactFigure("smooth: rolling loss", smooth.rolling_loss, "W/m", "W/m"),
        ]
        rise = float(smooth.temperature_rise.max())
        if rise > 0:
            found.append(ContactFigure("smooth: highest temperature rise", rise, "K", "K"))
        rough = self.rough
        if rough is not None:
            found += [
                ContactFigure("film ratio", film_ratio(self.model, smooth), "1", "1"),
                ContactFigure("friction coefficient", rough.friction_coefficient, "1", "1"),
                ContactFigure("its standard error", rough.friction_error, "1", "1"),
                ContactFigure("friction of asperities", rough.asperity_friction_share, "1", "%"),
                ContactFigure("load on asperities", rough.asperity_load_share, "1", "%"),
                ContactFigure("length in contact", rough.contact_share, "1", "%"),
                ContactFigure("central film, mean in time", rough.mean_central_film, "m", "um"),
                ContactFigure("least film, mean in time", rough.mean_least_film, "m", "um"),
                ContactFigure(
                    "highest pressure, mean in time", rough.mean_highest_pressure, "Pa", "GPa"
                ),
                ContactFigure("rolling loss", rough.rolling_loss, "W/m", "W/m"),
                ContactFigure(
                    "standard error of the rolling loss", rough.rolling_loss_error, "W/m", "W/m"
                ),
            ]
        return [figure for figure in found if math.isfinite(figure.value)]

    def shear_stress(self, frame: Frame) -> FloatArray:
        """At a moment of the rough contact, of film and touching asperities, shape (n,). [Pa]

        Theory (H23).
        """
        assert self.rough is not None
        model, smooth, x = self.model, self.smooth, self.rough.x
        contact = model.contact
        thinned = np.zeros_like(x)
        if model.heating is not None:
            rise = np.interp(x, smooth.x, smooth.temperature_rise)
            pressure = np.interp(x, smooth.x, smooth.pressure)
            thinned = thinning(contact, model.heating, pressure, rise)
        scaled = frame.pressure / contact.hertz_pressure, frame.film / contact.film_scale
        fluid = shear_stresses(*scaled, thinned, contact.scaled_fluid()) * contact.hertz_pressure
        friction = model.asperities.friction if contact.sliding_speed else 0.0
        return np.where(self.touching(frame), friction * frame.pressure, fluid)

    def touching(self, frame: Frame) -> NDArray[np.bool_]:
        """Where surfaces touch at a moment of the rough contact, shape (n,). Theory (H23)."""
        touching: NDArray[np.bool_] = (frame.film < self.model.asperities.film) & (
            frame.pressure > 0
        )
        return touching

    def to_json(self) -> str:
        """Inputs, status, warnings; in SI units figures and all that varies over x."""
        data: dict[str, Any] = {
            "title": self.case.title,
            "versions": versions(),
            "inputs": plain(self.case),
            "status": str(self.status),
            "message": self.message,
            "warnings": self.warnings,
            "out_of_range": [flag.quantity for flag in self.flags],
            "figures": {
                figure.name: {"value": figure.value, "unit": figure.unit} for figure in self.figures
            },
            "surfaces": [_statistics(surface) for surface in self.model.surfaces],
        }
        smooth = self.smooth
        if smooth.status is Status.CONVERGED:
            data["smooth"] = {
                "iterations": smooth.iterations,
                "x": smooth.x.tolist(),
                "pressure": smooth.pressure.tolist(),
                "film": smooth.film.tolist(),
                "shear_stress": smooth.shear_stress.tolist(),
                "temperature_rise": smooth.temperature_rise.tolist(),
            }
        if self.rough is not None:
            data["rough"] = self._rough_data(self.rough)
        return json.dumps(data, indent=2, allow_nan=False)

    def _rough_data(self, rough: RoughSolution) -> dict[str, Any]:
        data: dict[str, Any] = {
            "time_steps": rough.steps,
            "unsolved_time_steps": rough.unsolved_steps,
            "friction": [value if math.isfinite(value) else None for value in rough.friction],
        }
        if rough.frames and np.isfinite(rough.frames[-1].pressure).all():
            frame = rough.frames[-1]
            data["last_moment"] = {
                "time": frame.time,
                "x": rough.x.tolist(),
                "pressure": frame.pressure.tolist(),
                "film": frame.film.tolist(),
                "shear_stress": self.shear_stress(frame).tolist(),
            }
        return data


def _statistics(surface: Profile) -> dict[str, float]:
    """Statistics of a profile, lengths in m."""
    if surface.rms == 0:
        return {"rms": 0.0}
    return {
        "rms": surface.rms,
        "correlation_length": surface.correlation_length,
        "skewness": surface.skewness,
        "kurtosis": surface.kurtosis,
    }


def solve_contact(
    case: ContactCase,
    frames: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> ContactResult:
    """Solve a contact, with `FRAMES` moments of a rough one over 6 half-widths if `frames`.

    `progress` is called with the numbers of blocks of a rough contact done and expected.
    """
    model = contact_model(case)
    contact = model.contact
    if model.smooth:
        return ContactResult(case, model, solve_smooth(contact, heating=model.heating), None)
    interval = 6 * contact.half_width / contact.rolling_speed / FRAMES if frames else None
    rough = solve_rough(
        contact, *model.surfaces, model.asperities, case.numerics.nodes, interval, model.heating,
        case.numerics.frozen_roughness, case.numerics.most_blocks,
        case.numerics.friction_tolerance, progress,
    )  # fmt: skip
    return ContactResult(case, model, rough.smooth, rough)
