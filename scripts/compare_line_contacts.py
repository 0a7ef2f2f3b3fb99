"""Sliding friction of the line-contact solver beside the regression of Talbot (2012), Eq. 5.8.

Run: python scripts/compare_line_contacts.py FILE.csv POINTS SEED [KEY=VALUE ...]

KEY is any key of a line contact, as in preset=as-published or asperities.film=30nm. Points are
drawn from the levels of his Table 5.1 for the test fluid. Each solved point is kept in FILE.csv at
once; the same command goes on where it stopped. The source states neither profiles nor the laws of
viscosity nor the boundary friction of its simulations: those are the assumptions of the preset.
"""

from __future__ import annotations

import csv
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from epicyclic.contact.fitted_models import regression_groups
from epicyclic.contact.line_contact import LineContacts, contacts_at
from epicyclic.kernels.mixed_ehl import sliding_friction
from epicyclic.oil.oil import oil_state
from epicyclic.plugins.contact_solver.contact import load_contact_case, solve_contact
from epicyclic.schema.read import parse_value

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
NUMERICS = {"most_blocks": 256, "friction_tolerance": 0.04}
"""Friction known to a sixth of the band that is asked for."""


def compare(point: Mapping[str, float], number: int, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Friction of both, and how the solution ended; each point has profiles of its own."""
    case = load_contact_case(
        {
            "contact": {
                "radius": f"{point['radius']} mm",
                "hertz_pressure": f"{point['pressure']} GPa",
                "rolling_speed": f"{point['speed']} m/s",
                "slide_to_roll_ratio": point["slip"],
            },
            "lubricant": {"oil": "atf-talbot-2012", "temperature": f"{point['temperature']} degC"},
            "surface1": {"roughness": f"{point['rough1']} um", "seed": 2 * number},
            "surface2": {"roughness": f"{point['rough2']} um", "seed": 2 * number + 1},
            "numerics": NUMERICS,
        },
        changes,
    )
    start = time.process_time()
    result = solve_contact(case)
    seconds = time.process_time() - start
    rough = result.rough
    assert rough is not None
    states = conditions(point, result.smooth.contact.equivalent_modulus)
    published = sliding_friction(
        *(float(np.ravel(group)[0]) for group in regression_groups(states))
    )
    return {
        **point,
        "film_ratio": float(states.film_ratio[0]),
        "published": published,
        "computed": rough.friction_coefficient,
        "error": rough.friction_error,
        "smooth": result.smooth.friction_coefficient,
        "ratio": rough.friction_coefficient / published,
        "asperity_load": rough.asperity_load_share,
        "status": str(rough.status),
        "unsolved": rough.unsolved_steps / max(rough.steps, 1),
        "kept": rough.roughness_kept,
        "seconds": seconds,
    }


def conditions(point: Mapping[str, float], modulus: float) -> LineContacts:
    """A point as the regressions take it."""
    oil = load_contact_case(
        {
            "contact": {"radius": "1 mm", "hertz_pressure": "1 GPa", "rolling_speed": "1 m/s"},
            "lubricant": {"oil": "atf-talbot-2012", "temperature": f"{point['temperature']} degC"},
        }
    ).lubricant
    state = oil_state(oil.oil, oil.temperature)
    values = {
        "slide_to_roll_ratio": point["slip"],
        "rolling_speed": point["speed"],
        "radius": point["radius"] * 1e-3,
        "hertz_pressure": point["pressure"] * 1e9,
        "roughness1": point["rough1"] * 1e-6,
        "roughness2": point["rough2"] * 1e-6,
        "dynamic_viscosity": state.dynamic_viscosity,
        "pressure_viscosity": state.pressure_viscosity,
    }
    arrays = {name: np.array([value]) for name, value in values.items()}
    return contacts_at(**arrays, equivalent_modulus=modulus)


def main(file: Path, count: int, seed: int, changes: Mapping[str, Any]) -> None:
    rng = np.random.default_rng(seed)
    points = [
        {name: float(rng.choice(levels)) for name, levels in LEVELS.items()} for _ in range(count)
    ]
    done = len(pd.read_csv(file)) if file.exists() else 0
    for number in range(done, count):
        row = compare(points[number], number, changes)
        new = not file.exists()
        with file.open("a", newline="") as stream:
            writer = csv.DictWriter(stream, list(row))
            if new:
                writer.writeheader()
            writer.writerow(
                {key: f"{v:.6g}" if isinstance(v, float) else v for key, v in row.items()}
            )
    report(pd.read_csv(file))


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
    print(f"median {table['seconds'].median():.2f} s of one core")


if __name__ == "__main__":
    file, count, seed, *others = sys.argv[1:]
    pairs = (other.split("=", 1) for other in others)
    main(Path(file), int(count), int(seed), {key: parse_value(value) for key, value in pairs})
