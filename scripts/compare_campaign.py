"""Simulations of a finished campaign beside the regressions of Talbot (2012) and other formulas.

Run: python scripts/compare_campaign.py DIR

DIR is a folder of `epicyclic oil characterise atf-talbot-2012`. Ratios of the simulated sliding
friction and rolling losses to Eq. 5.8, Eq. 5.10 and Eq. 3.5, and of the rolling loss to Goksem and
Hargreaves without heating, by film ratio and by oil temperature.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact.fitted_models import regression_groups, rolling_scale
from epicyclic.contact.line_contact import LineContacts
from epicyclic.kernels.line_contact import goksem_hargreaves_force, martin_force
from epicyclic.kernels.mixed_ehl import needle_rolling_loss, rolling_loss_number, sliding_friction
from epicyclic.plugins.contact_solver.campaign import open_folder
from epicyclic.plugins.contact_solver.fit import simulated_quantities

FloatArray = NDArray[np.float64]

FILM_RATIOS = (0.0, 0.3, 0.7, 1.0, 3.0, np.inf)


def published_friction(states: LineContacts) -> FloatArray:
    """Talbot (2012), Eq. 5.8. [1]"""
    return np.array(
        [sliding_friction(*row) for row in zip(*regression_groups(states), strict=True)]
    )


def published_rolling(states: LineContacts) -> FloatArray:
    """Talbot (2012), Eq. 5.10, scaled by mu u_r^2. [W/m]"""
    number = [rolling_loss_number(*row) for row in zip(*regression_groups(states), strict=True)]
    return np.array(number) * rolling_scale(states)


def published_needle(states: LineContacts) -> FloatArray:
    """Talbot (2012), Eq. 3.5. [W/m]"""
    rows = zip(
        states.hertz_pressure, states.rolling_speed, states.dynamic_viscosity,
        states.pressure_viscosity, states.radius, states.composite_roughness, strict=True,
    )  # fmt: skip
    modulus = states.flanks.equivalent_modulus
    return np.array(
        [needle_rolling_loss(p_h, u, mu, a, r, rq, modulus) for p_h, u, mu, a, r, rq in rows]
    )


def smooth_rolling(states: LineContacts) -> FloatArray:
    """Goksem and Hargreaves without heating, at light load Martin. [W/m]"""
    rows = zip(
        states.speed_number, states.material_number, states.load_number, states.radius,
        states.pressure_viscosity, states.line_load, states.rolling_speed,
        states.dynamic_viscosity, strict=True,
    )  # fmt: skip
    return np.array(
        [
            2 * speed * min(goksem_hargreaves_force(u, g, w, 0.0) * radius / alpha,
                            martin_force(load, speed, viscosity))
            for u, g, w, radius, alpha, load, speed, viscosity in rows
        ]
    )  # fmt: skip


FORMULAS: dict[str, dict[str, Callable[[LineContacts], FloatArray]]] = {
    "friction": {"Eq. 5.8": published_friction},
    "rolling_loss": {"Eq. 5.10": published_rolling, "Goksem-Hargreaves": smooth_rolling},
    "bearing_rolling_loss": {"Eq. 3.5": published_needle, "Goksem-Hargreaves": smooth_rolling},
}


def row(name: str, ratio: FloatArray) -> None:
    if ratio.size:
        low, median, high = np.quantile(ratio, [0.1, 0.5, 0.9])
        near = np.mean(np.abs(ratio - 1) <= 0.25)
        print(f"  {name:24}{ratio.size:6}{median:8.2f}{low:8.2f}{high:8.2f}{near:8.0%}")


def main(folder: Path) -> None:
    for quantity, (states, value, _) in simulated_quantities([open_folder(folder)]).items():
        for name, formula in FORMULAS[quantity].items():
            print(f"{quantity} over {name}: contacts, median, 10 %, 90 %, within 25 %")
            ratio = value / formula(states)
            row("all", ratio)
            for low, high in pairwise(FILM_RATIOS):
                inside = (states.film_ratio > low) & (states.film_ratio <= high)
                row(f"film ratio {low:g} to {high:g}", ratio[inside])
            for viscosities in np.array_split(np.argsort(-states.dynamic_viscosity), 4):
                mean = 1e3 * states.dynamic_viscosity[viscosities].mean()
                row(f"oil of {mean:.1f} mPa s", ratio[viscosities])


if __name__ == "__main__":
    main(Path(sys.argv[1]))
