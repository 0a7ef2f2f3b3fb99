"""A campaign: an oil, its designs, and one simulated contact for each point."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib import metadata
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from epicyclic import library
from epicyclic.analysis.contact import ContactResult, solve_contact
from epicyclic.campaigns.design import AXES, BEARING_TABLE, GEAR_TABLE, Design, quantity_of_axis
from epicyclic.case.contact import ContactCase, load_contact_case
from epicyclic.case.nearest import did_you_mean
from epicyclic.case.plain import flattened, plain, without
from epicyclic.case.reading import read_file
from epicyclic.ehl.rough import BRIEF
from epicyclic.elasticity.threads import one_thread
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.sweeps.journal import Row
from epicyclic.sweeps.runner import Plan

SCHEMA = 2
"""Version of the files of a campaign."""
BRIEFLY = {"numerics.most_blocks": BRIEF, "numerics.friction_tolerance": 0.05}
"""How long a simulation takes: its error need not be smaller than the scatter of the best fit."""
OIL_KEY = "lubricant.oil."
SEEDS = ("surface1.seed", "surface2.seed")
PROFILES = ("surface1.profile", "surface2.profile")


@dataclass(frozen=True)
class Campaign(Plan):
    """What is simulated."""

    kind: ClassVar[str] = "oil"
    may_fail: ClassVar[bool] = True
    # The tables of a line contact that all points share, as JSON: oil, shear stress, spectra.
    settings: str
    designs: tuple[Design, ...]
    seed: int = 0  # Every profile of every point follows from it and the number of the point.
    # Version of this package, which solves the contacts.
    version: str = field(default_factory=lambda: metadata.version("epicyclic"))

    @classmethod
    def again(cls, content: Mapping[str, Any], source: str = "") -> Campaign:
        """The campaign that `describe` described."""
        designs = tuple(
            Design(
                item["part"],
                tuple((name, tuple(values)) for name, values in item["axes"].items()),
                item["size"],
                item["seed"],
            )
            for item in content["designs"]
        )
        settings = json.dumps(content["settings"], sort_keys=True)
        return cls(settings, designs, content["seed"], content["version"])

    @property
    def batch(self) -> int:
        """A simulation takes up to some seconds."""
        return 1

    @property
    def size(self) -> int:
        """Number of simulations."""
        return sum(design.count for design in self.designs)

    def order(self) -> Sequence[int]:
        """Numbers of all simulations."""
        return range(self.size)

    def part(self, index: int) -> str:
        """What the contact is one of: ``"gear"`` or ``"bearing"``."""
        return self._place(index)[0].part

    def point(self, index: int) -> dict[str, float]:
        """Conditions of simulation number `index`, in display units."""
        design, row = self._place(index)
        return {"slide_to_roll_ratio": 0.0} | design.point(row)

    def case(self, index: int) -> ContactCase:
        """The line contact of simulation number `index`."""
        changes = _varied(self.point(index))
        seeds = np.random.SeedSequence([self.seed, index]).generate_state(2)
        for surface, seed in zip(("surface1", "surface2"), seeds, strict=True):
            changes[f"{surface}.seed"] = int(seed)
        return load_contact_case(json.loads(self.settings), changes)

    def _solve(self, index: int) -> Row:
        """Results of one simulation; the same bits wherever and whenever it runs."""
        with one_thread():
            return _row(solve_contact(self.case(index)))

    def describe(self) -> dict[str, Any]:
        """As plain data: equal for equal results."""
        return {
            "schema": SCHEMA,
            "version": self.version,
            "settings": json.loads(self.settings),
            "designs": [design.describe() for design in self.designs],
            "seed": self.seed,
        }

    def _place(self, index: int) -> tuple[Design, int]:
        row = index
        for design in self.designs:
            if row < design.count:
                return design, row
            row -= design.count
        raise IndexError(index)


MOST_CONTACTS = 1_000_000
"""Most contacts of one design: years of simulation."""


def make_campaign(
    # A name of the oil library, a TOML file with its properties, or these.
    oil: str | Path | Mapping[str, Any],
    *,
    # Number of gear contacts in a space-filling design; default: the full table.
    size: int | None = None,
    # Number of bearing contacts in a space-filling design, 0 for none; default: the full table, or
    # with `size` none.
    bearing_size: int | None = None,
    seed: int = 0,  # Seed of designs and profiles.
    # Other limits of gear axes, in display units, and with ``bearing.`` before the name of those of
    # bearings; for space-filling designs.
    ranges: Mapping[str, tuple[float, float]] | None = None,
    # Keys of a line contact that hold for all points, ``"lubricant.eyring_stress"``.
    changes: Mapping[str, Any] | None = None,
) -> Campaign:
    """Plan the simulations for an oil.

    Raises
    ------
    InputError
        With every problem of oil, ranges and changes.
    """
    for name, count in (("size", size), ("bearing_size", bearing_size)):
        if count is not None and count > MOST_CONTACTS:
            allowed = f"must be {MOST_CONTACTS} or less."
            problem = Problem(name, str(count), allowed, "Give a smaller one.")
            raise InputError([problem], "the command")
    designs = []
    if size is None:
        designs.append(GEAR_TABLE)
    elif size > 0:
        designs.append(GEAR_TABLE.within(_ranges_of("gear", ranges)).filling(size, seed))
    if bearing_size is None and size is None:
        designs.append(BEARING_TABLE)
    elif bearing_size:
        within = _ranges_of("bearing", ranges)
        designs.append(BEARING_TABLE.within(within).filling(bearing_size, seed))
    if ranges and not size:
        problem = Problem(
            "ranges", ", ".join(ranges), "needs a space-filling design.", "Give a size."
        )
        raise InputError([problem], "the command")
    for name in ranges or {}:
        quantity_of_axis(name.removeprefix("bearing."))  # says which axes there are
    for design in designs:
        design.check()
    _check_changes(changes or {})
    given = _varied(designs[0].point(0))
    given |= {"lubricant.oil": oil_tables(oil)} | BRIEFLY | dict(changes or {})
    try:
        tables = plain(load_contact_case({}, given))
    except InputError as error:
        raise _as_of_file(error, oil) from None
    for key in (*AXES.values(), *SEEDS):
        tables = without(tables, key.split("."))
    return Campaign(json.dumps(tables, sort_keys=True), tuple(designs), seed)


def command_of(campaign: Campaign) -> str:
    """The command that makes a campaign; of an oil that is not of the library, ``OIL.toml``."""
    settings = json.loads(campaign.settings)
    name = settings["lubricant"]["oil"].get("name", "")
    oil = name if name in library.oil_names() else None
    words = ["epicyclic oil characterise", oil or "OIL.toml"]
    for design, size in zip(campaign.designs, ("--size", "--bearing-size"), strict=False):
        before = "" if design.part == "gear" else "bearing."
        table = GEAR_TABLE if design.part == "gear" else BEARING_TABLE
        if design.size is not None:
            words.append(f"{size} {design.size}")
        for (axis, values), (_, levels) in zip(design.axes, table.axes, strict=True):
            if values != levels:
                unit = f" {quantity_of_axis(axis).display}".rstrip()
                words.append(f'--range "{before}{axis}={min(values):g}:{max(values):g}{unit}"')
    words.append(f"--seed {campaign.seed}")
    if oil is not None:
        usual_settings = json.loads(make_campaign(oil, size=1).settings)
        usual = dict(flattened(usual_settings))
        words += [
            f'--set "{key}={value}"'
            for key, value in flattened(settings)
            if value != usual.get(key) and "oil" not in key.split(".")
        ]
    return " ".join(words)


def _ranges_of(
    part: str, ranges: Mapping[str, tuple[float, float]] | None
) -> dict[str, tuple[float, float]]:
    """Limits that are for the contacts of a part: bearings: ``bearing.radius``."""
    before = "" if part == "gear" else f"{part}."
    return {
        name.removeprefix(before): limits
        for name, limits in (ranges or {}).items()
        if name.startswith(before) and "." not in name.removeprefix(before)
    }


def _check_changes(changes: Mapping[str, Any]) -> None:
    """Refuse keys that are not the same for all contacts."""
    problems = []
    for key, value in changes.items():
        if key in AXES.values():
            allowed, remedy = "varies from contact to contact.", "Give its --range instead."
        elif key in SEEDS:
            allowed, remedy = "varies from contact to contact.", "Give --seed instead."
        elif key in PROFILES:
            allowed = "is for a single contact: here every contact has profiles of its own."
            remedy = "Give correlation length, skewness and kurtosis of the measured one."
        else:
            continue
        problems.append(Problem(key, str(value), allowed, remedy))
    raise_any(problems, "the command")


def _as_of_file(error: InputError, oil: str | Path | Mapping[str, Any]) -> InputError:
    """Problems of nothing but an oil in a file, with the keys and the name of that file."""
    in_file = not isinstance(oil, Mapping) and Path(oil).suffix == ".toml"
    if not in_file or not all(problem.key.startswith(OIL_KEY) for problem in error.problems):
        return error
    problems = (
        replace(problem, key=problem.key.removeprefix(OIL_KEY)) for problem in error.problems
    )
    return InputError(problems, str(oil))


def oil_tables(oil: str | Path | Mapping[str, Any]) -> Any:
    """The properties in a file; a name or tables are given back as they are."""
    if isinstance(oil, Mapping) or str(oil) in library.oil_names():
        return oil
    path = Path(oil)
    if path.suffix != ".toml":
        remedy = did_you_mean(str(oil), library.oil_names()) or "See 'epicyclic oils'."
        problem = Problem("OIL", str(oil), "is neither a .toml file nor a built-in oil.", remedy)
        raise InputError([problem], "the command")
    tables, problems = read_file(path)
    raise_any(problems, str(path))
    return {"name": path.stem} | tables


def _varied(point: Mapping[str, float]) -> dict[str, Any]:
    """The keys of a line contact that a point sets, as a file has them."""
    units = {name: quantity_of_axis(name).display for name in point}
    return {
        AXES[name]: f"{value!r} {units[name]}" if units[name] else value
        for name, value in point.items()
    }


def _row(result: ContactResult) -> Row:
    """What is kept of a simulation."""
    smooth, rough = result.smooth, result.rough
    numbers = {
        "friction": smooth.friction_coefficient,
        "friction_error": 0.0,
        "rolling_loss": smooth.rolling_loss,
        "rolling_loss_error": 0.0,
        "unsolved_share": 0.0,
        "roughness_kept": 1.0,
        "smooth_friction": smooth.friction_coefficient,
        "smooth_rolling_loss": smooth.rolling_loss,
        "smooth_central_film": smooth.central_film,
        "smooth_minimum_film": smooth.minimum_film,
    }
    if rough is not None:
        numbers |= {
            "friction": rough.friction_coefficient,
            "friction_error": rough.friction_error,
            "rolling_loss": rough.rolling_loss,
            "rolling_loss_error": rough.rolling_loss_error,
            "unsolved_share": rough.unsolved_steps / max(rough.steps, 1),
            "asperity_load_share": rough.asperity_load_share,
            "asperity_friction_share": rough.asperity_friction_share,
            "roughness_kept": rough.roughness_kept,
            "contact_share": rough.contact_share,
            "mean_least_film": rough.mean_least_film,
        }
    finite = {name: float(value) for name, value in numbers.items() if math.isfinite(value)}
    return Row(str(result.status), result.message, numbers=finite)
