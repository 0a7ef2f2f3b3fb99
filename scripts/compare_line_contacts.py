"""Sliding friction of the line-contact solver beside the regression of Talbot (2012), Eq. 5.8.

Run: python scripts/compare_line_contacts.py POINTS SEED LAW [KEY=VALUE ...]

LAW is roelands, two-slope or barus; KEY any key of a line contact, as in asperities.film=30nm.
Points are drawn from the levels of his Table 5.1 for the test fluid. The source states neither the
profiles nor the laws of viscosity nor the boundary friction of its simulations: those of the
defaults of `epicyclic contact` are used, uncalibrated. The two slopes are in the ratio, and meet at
the pressure, that S. Li and A. Kahraman used for another oil (general knowledge).
"""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from epicyclic.analysis.contact import solve_contact
from epicyclic.case.contact import load_contact_case
from epicyclic.case.values import parse_value
from epicyclic.kernels.line_contact import pan_hamrock_minimum_film
from epicyclic.kernels.mixed_ehl import sliding_friction
from epicyclic.lubricant.properties import oil_state

LEVELS = {
    "temperature": (25.0, 50.0, 75.0, 100.0),
    "radius": (5.0, 20.0, 40.0),
    "rough1": (0.1, 0.3, 0.5, 0.7),
    "rough2": (0.1, 0.3, 0.5, 0.7),
    "pressure": (0.5, 1.0, 1.5, 2.0, 2.5),
    "speed": (1.0, 5.0, 10.0, 15.0, 20.0),
    "slip": (0.025, 0.05, 0.10, 0.25, 0.50, 0.75, 1.00),
}
"""Table 5.1: degC, mm, um, um, GPa, m/s, 1."""
SECOND_OVER_FIRST_SLOPE, TRANSITION = 0.41, "0.38 GPa"


def lubricant_of(temperature: float, law: str) -> dict[str, str]:
    """Table of the test fluid."""
    table = {
        "oil": "atf-talbot-2012",
        "temperature": f"{temperature} degC",
        "pressure_law": law,
    }
    if law == "two-slope":
        oil = load_contact_case({"contact": DUMMY, "lubricant": {**table, "pressure_law": "barus"}})
        state = oil_state(oil.lubricant.oil, oil.lubricant.temperature)
        slope = SECOND_OVER_FIRST_SLOPE * state.pressure_viscosity * 1e9
        table |= {"second_slope": f"{slope} 1/GPa", "transition_pressure": TRANSITION}
    return table


NUMERICS = {"most_blocks": 256, "friction_tolerance": 0.04}
"""Friction known to a sixth of the band that is asked for."""
DUMMY = {"radius": "10 mm", "hertz_pressure": "1 GPa", "rolling_speed": "1 m/s"}
"""Any contact, to read an oil with."""


def compare(
    point: dict[str, float], law: str, changes: Mapping[str, Any]
) -> dict[str, float | str]:
    """Friction of both, and how the solution ended."""
    case = load_contact_case(
        {
            "contact": {
                "radius": f"{point['radius']} mm",
                "hertz_pressure": f"{point['pressure']} GPa",
                "rolling_speed": f"{point['speed']} m/s",
                "slide_to_roll_ratio": point["slip"],
            },
            "lubricant": lubricant_of(point["temperature"], law),
            "surface1": {"roughness": f"{point['rough1']} um"},
            "surface2": {"roughness": f"{point['rough2']} um"},
            "numerics": NUMERICS,
        },
        changes,
    )
    start = time.perf_counter()
    result = solve_contact(case)
    seconds = time.perf_counter() - start
    rough, contact = result.rough, result.smooth.contact
    assert rough is not None
    state = oil_state(case.lubricant.oil, case.lubricant.temperature)
    e_eq, r_eq = contact.equivalent_modulus, contact.radius
    u = contact.rolling_speed * state.dynamic_viscosity / (e_eq * r_eq)
    g = state.pressure_viscosity * e_eq
    rq1, rq2 = point["rough1"] * 1e-6 / r_eq, point["rough2"] * 1e-6 / r_eq
    s_co = float(np.hypot(rq1, rq2))
    lam = pan_hamrock_minimum_film(u, g, contact.line_load / (e_eq * r_eq)) / s_co
    published = sliding_friction(
        point["slip"], u, g, contact.hertz_pressure / e_eq, r_eq / contact.half_width, s_co,
        rq1 * rq2 / (rq1 + rq2), lam,
    )  # fmt: skip
    return {
        **point,
        "film_ratio": lam,
        "published": published,
        "computed": rough.friction_coefficient,
        "smooth": result.smooth.friction_coefficient,
        "ratio": rough.friction_coefficient / published,
        "asperity_load": rough.asperity_load_share,
        "status": str(rough.status),
        "unsolved": rough.unsolved_steps / max(rough.steps, 1),
        "steps": rough.steps,
        "seconds": seconds,
    }


def main(count: int, seed: int, law: str, changes: Mapping[str, Any]) -> None:
    rng = np.random.default_rng(seed)
    rows: list[dict[str, float | str]] = []
    for _ in range(count):
        point = {name: float(rng.choice(levels)) for name, levels in LEVELS.items()}
        rows.append(compare(point, law, changes))
        print(rows[-1], file=sys.stderr, flush=True)
    table = pd.DataFrame(rows)
    name = "_".join([law, *(f"{key}-{value}" for key, value in changes.items())])
    table.to_csv(Path(f"line_contacts_{name}.csv"), index=False)
    report(table)


def report(table: pd.DataFrame) -> None:
    """Ratios of the friction, in all and by what they depend on."""
    solved = table[table["status"] == "converged"]
    ratio = solved["film_ratio"]
    parts = {
        "all": solved,
        "film ratio <= 0.7": solved[ratio <= 0.7],
        "0.7 to 3": solved[(ratio > 0.7) & (ratio <= 3)],
        "> 3": solved[ratio > 3],
    } | {f"{t:.0f} degC": solved[solved["temperature"] == t] for t in LEVELS["temperature"]}
    for name, part in parts.items():
        if len(part):
            low, median, high = part["ratio"].quantile([0.1, 0.5, 0.9])
            near = ((part["ratio"] - 1).abs() <= 0.25).mean()
            print(
                f"{name}: {len(part)} points, computed/published median {median:.2f}, "
                f"10 to 90 %: {low:.2f} to {high:.2f}, within 25 %: {near:.0%}"
            )
    print(f"not converged: {len(table) - len(solved)} of {len(table)}")
    print(f"median {table['seconds'].median():.2f} s, {table['steps'].median():.0f} time steps")


if __name__ == "__main__":
    count, seed, law, *others = sys.argv[1:]
    pairs = (other.split("=", 1) for other in others)
    main(int(count), int(seed), law, {key: parse_value(value) for key, value in pairs})
