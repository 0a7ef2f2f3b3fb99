"""A campaign of simulated contacts of an oil: design, points, folder."""

from __future__ import annotations

import io
import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from importlib import metadata
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic import library
from epicyclic.arrays import FloatArray
from epicyclic.contact.elastic_teeth import one_thread
from epicyclic.dataclass import asdict, dataclass, field, replace
from epicyclic.errors import InputError, Problem, one_problem, raise_any
from epicyclic.files import make_folder, read_bytes, read_text, write_file
from epicyclic.messages import did_you_mean, one_line
from epicyclic.plugins.contact_solver.conditions import SOLVER_BOX
from epicyclic.plugins.contact_solver.contact import (
    ContactCase,
    ContactResult,
    load_contact_case,
    solve_contact,
)
from epicyclic.plugins.contact_solver.rough import BRIEF
from epicyclic.schema.fields import find_field, quantity_of
from epicyclic.schema.read import flattened, plain, read_file, without
from epicyclic.study.sweeps.runner import HERE, Journal, Plan, Row, Rows, Runner, fingerprint
from epicyclic.units import MICROMETRE, NUMBER, Quantity, format_number

if TYPE_CHECKING:
    import pandas as pd


# Which contacts are simulated: the tables of Talbot (2012), or points that fill their ranges.


AXES = {
    "temperature": "lubricant.temperature",
    "radius": "contact.radius",
    "roughness1": "surface1.roughness",
    "roughness2": "surface2.roughness",
    "hertz_pressure": "contact.hertz_pressure",
    "rolling_speed": "contact.rolling_speed",
    "slide_to_roll_ratio": "contact.slide_to_roll_ratio",
}
"""What a design varies, and the keys of a line contact that hold it."""
LOGARITHMIC = ("radius", "roughness1", "roughness2", "rolling_speed", "slide_to_roll_ratio")
"""Axes that are filled evenly in the logarithm."""

_RANGE = re.compile(
    r"\s*(?P<name>(bearing\.)?\w+)\s*=\s*(?P<low>[^:\s]+)\s*:\s*(?P<high>[^:\s]+)\s*(?P<unit>.*)"
)

Axis = tuple[str, tuple[float, ...]]


@dataclass(frozen=True)
class Design:
    """Points of a campaign."""

    part: str  # ``"gear"`` or ``"bearing"``: what the contacts are those of.
    # Name and values of each axis, in display units: the levels of a full product, or of a space-
    # filling design the first and the last one as limits.
    axes: tuple[Axis, ...]
    # Number of points of a space-filling design; None for the full product.
    size: int | None = None
    seed: int = 0  # Seed of the scrambling of a space-filling design.

    @property
    def count(self) -> int:
        """Number of points."""
        return math.prod(len(values) for _, values in self.axes) if self.size is None else self.size

    def point(self, index: int) -> dict[str, float]:
        """The values of point number `index`, in display units."""
        names = [name for name, _ in self.axes]
        return dict(zip(names, map(float, _points(self)[index]), strict=True))

    def filling(
        self,
        size: int,
        seed: int,
        # Other limits of some axes, in display units; see `prefix`.
        ranges: Mapping[str, tuple[float, float]] = MappingProxyType({}),
    ) -> Design:
        """`size` points that fill the ranges of the axes: a scrambled Sobol sequence."""
        axes = tuple((name, ranges.get(self.prefix + name, values)) for name, values in self.axes)
        return replace(self, axes=axes, size=size, seed=seed)

    @property
    def prefix(self) -> str:
        """What stands before the names of its axes where limits are given."""
        return "" if self.part == "gear" else f"{self.part}."

    def describe(self) -> dict[str, Any]:
        """As plain data, for files."""
        return asdict(self) | {"axes": {name: list(values) for name, values in self.axes}}

    def check_types(self) -> None:
        """Raise `TypeError` if anything is not of its type, or there are too many points."""
        numbers = [self.seed, *(value for _, values in self.axes for value in values)]
        whole = self.size is None or type(self.size) is int
        finite = all(type(it) in (int, float) and math.isfinite(it) for it in numbers)
        if not whole or not finite or not 0 < self.count <= MOST_CONTACTS:
            raise TypeError("not a design")

    def check(self) -> None:
        """Raise `InputError` for every axis that leaves what the solver is tested for."""
        raise_any(self._problems(), "the design")

    def _problems(self) -> Iterator[Problem]:
        beyond = "exceeds the tested range of the solver"
        for name, values in self.axes:
            key, quantity = f"{self.part}.{name}", quantity_of_axis(name)
            scale, offset = quantity.scale_and_offset()
            box = SOLVER_BOX.get(name, (-math.inf, math.inf))
            low, high = (limit * scale + offset for limit in box)
            least, most = format_number(min(values)), format_number(max(values))
            if self.size is not None and name in LOGARITHMIC and min(values) <= 0:
                allowed = (
                    "must be above zero, because it is filled uniformly on a logarithmic scale."
                )
                yield Problem(key, least, allowed, "Raise it.")
            slack = 1e-9 * max(abs(value) for value in values)
            if min(values) < low - slack or max(values) > high + slack:
                unit = f" {quantity.display}".rstrip()
                allowed = f"{beyond}, {format_number(low)} to {format_number(high)}{unit}."
                yield Problem(key, f"{least} to {most}{unit}", allowed, "Give a smaller range.")
        rough = (max(values) for name, values in self.axes if name in ("roughness1", "roughness2"))
        highest = math.hypot(*rough)
        limit = MICROMETRE.to_display(SOLVER_BOX["composite_roughness"][1])
        if highest > limit:
            key, given = f"{self.part}.roughness1, roughness2", f"up to {highest:.3g} um together"
            yield Problem(key, given, f"{beyond}, {limit:g} um.", "Give smaller ranges.")


def quantity_of_axis(name: str) -> Quantity:
    """Unit and range of an axis; raises `InputError` if there is no such axis."""
    if name not in AXES:
        remedy = did_you_mean(name, list(AXES)) or f"The axes are {', '.join(AXES)}."
        raise one_problem("--range", name, "is not an axis of a design.", remedy)
    field = find_field(ContactCase, AXES[name])
    assert field is not None
    return quantity_of(*field) or NUMBER


def parse_ranges(options: Iterable[str]) -> dict[str, tuple[float, float]]:
    """Limits of axes from ``NAME=LOW:HIGH UNIT``, in display units.

    Raises `InputError` for every range that cannot be read.
    """
    ranges, problems = {}, []
    for option in options:
        match = _RANGE.fullmatch(option)
        if match is None:
            allowed = "must be NAME=LOW:HIGH with a unit."
            remedy = 'For example "hertz_pressure=0.3:1.5 GPa".'
            problems.append(Problem("--range", f'"{option}"', allowed, remedy))
            continue
        name, unit = match["name"], match["unit"]
        try:
            quantity = quantity_of_axis(name.removeprefix("bearing."))
            low, high = (
                quantity.to_display(quantity.parse(f"{match[end]} {unit}"))
                if quantity.display
                else float(match[end])
                for end in ("low", "high")
            )
        except InputError as error:
            problems += error.problems
            continue
        except (PydanticCustomError, ValueError) as error:
            problems.append(Problem(f"--range {name}", f'"{option}"', f"{error}.", "Change it."))
            continue
        if not low < high:
            allowed = "must be increasing."
            problems.append(Problem(f"--range {name}", f'"{option}"', allowed, "Swap them."))
        ranges[name] = (low, high)
    raise_any(problems, "the command")
    return ranges


@lru_cache(maxsize=8)
def _points(design: Design) -> FloatArray:
    """All points, shape (count, axes)."""
    if design.size is None:
        grids = np.meshgrid(*(values for _, values in design.axes), indexing="ij")
        return np.stack([grid.ravel() for grid in grids], axis=1)
    from scipy.stats import qmc

    sequence = qmc.Sobol(len(design.axes), scramble=True, seed=design.seed)
    unit = sequence.random_base2(max(0, math.ceil(math.log2(design.size))))[: design.size]
    columns = []
    for (name, values), share in zip(design.axes, unit.T, strict=True):
        low, high = min(values), max(values)
        if name in LOGARITHMIC:
            columns.append(low * (high / low) ** share)
        else:
            columns.append(low + (high - low) * share)
    return np.stack(columns, axis=1)


GEAR_TABLE = Design(
    "gear",
    (
        ("temperature", (25.0, 50.0, 75.0, 100.0)),
        ("radius", (5.0, 20.0, 40.0)),
        ("roughness1", (0.1, 0.3, 0.5, 0.7)),
        ("roughness2", (0.1, 0.3, 0.5, 0.7)),
        ("hertz_pressure", (0.5, 1.0, 1.5, 2.0, 2.5)),
        ("rolling_speed", (1.0, 5.0, 10.0, 15.0, 20.0)),
        ("slide_to_roll_ratio", (0.025, 0.05, 0.10, 0.25, 0.50, 0.75, 1.00)),
    ),
)
"""33,600 contacts of gear teeth. Talbot (2012), Table 5.1."""
BEARING_TABLE = Design(
    "bearing",
    (
        ("temperature", (25.0, 50.0, 75.0, 100.0)),
        ("radius", (0.5, 1.0, 2.0, 4.0)),
        ("roughness1", (0.02, 0.06, 0.10)),
        ("roughness2", (0.055, 0.11, 0.165)),
        ("hertz_pressure", (0.25, 1.0, 2.0, 3.0)),
        ("rolling_speed", (1.0, 5.0, 10.0, 15.0, 20.0)),
    ),
)
"""2,880 contacts of rollers with races in pure rolling. Talbot (2012), Table 3.1."""


# A campaign: an oil, its designs, and one simulated contact for each point.


SCHEMA = 2  # Version of the files of a campaign.
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
    batch: ClassVar[int] = 1  # A simulation takes up to some seconds.
    # The tables of a line contact that all points share, as JSON: oil, shear stress, spectra.
    settings: str
    designs: tuple[Design, ...]
    seed: int = 0  # Every profile of every point follows from it and the number of the point.
    # Version of this package, which solves the contacts.
    version: str = field(default_factory=lambda: metadata.version("epicyclic"))

    @classmethod
    def again(cls, content: Mapping[str, Any], source: str = "") -> Campaign:
        """The campaign that `describe` described.

        Raises `TypeError` or `InputError` for what cannot be simulated.
        """
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
        campaign = cls(settings, designs, content["seed"], content["version"])
        first = 0
        for design in designs:
            design.check_types()
            design.check()
            campaign.case(first)
            first += design.count
        return campaign

    @property
    def size(self) -> int:
        """Number of simulations."""
        return sum(design.count for design in self.designs)

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


MOST_CONTACTS = 1_000_000  # Most contacts of one design: years of simulation.


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

    Raises `InputError` with every problem of oil, ranges and changes.
    """
    for name, count in (("size", size), ("bearing_size", bearing_size)):
        if count is not None and count > MOST_CONTACTS:
            allowed = f"must be {MOST_CONTACTS} or less."
            raise one_problem(name, str(count), allowed, "Give a smaller one.", "the command")
    if size is not None:
        bearing_size = bearing_size or 0
    designs = [
        table if count is None else table.filling(count, seed, ranges or {})
        for table, count in ((GEAR_TABLE, size), (BEARING_TABLE, bearing_size))
        if count is None or count > 0
    ]
    if ranges and not size:
        stated, allowed = ", ".join(ranges), "needs a space-filling design."
        raise one_problem("ranges", stated, allowed, "Give a size.", "the command")
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
    oil = name if name in library.names("oils") else None
    words = ["epicyclic oil characterise", oil or "OIL.toml"]
    for design, size in zip(campaign.designs, ("--size", "--bearing-size"), strict=False):
        table = GEAR_TABLE if design.part == "gear" else BEARING_TABLE
        if design.size is not None:
            words.append(f"{size} {design.size}")
        for (axis, values), (_, levels) in zip(design.axes, table.axes, strict=True):
            if values != levels:
                unit = f" {quantity_of_axis(axis).display}".rstrip()
                limits = f"{min(values):g}:{max(values):g}{unit}"
                words.append(f'--range "{design.prefix}{axis}={limits}"')
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


def _check_changes(changes: Mapping[str, Any]) -> None:
    """Refuse keys that are not the same for all contacts."""
    problems = []
    for key, value in changes.items():
        if key in AXES.values():
            allowed, remedy = "varies from contact to contact.", "Give its --range instead."
        elif key in SEEDS:
            allowed, remedy = "varies from contact to contact.", "Give --seed instead."
        elif key in PROFILES:
            allowed = "applies to a single contact, but here every contact has its own profiles."
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
    if isinstance(oil, Mapping) or str(oil) in library.names("oils"):
        return oil
    path = Path(oil)
    if path.suffix != ".toml":
        remedy = did_you_mean(str(oil), library.names("oils")) or "See 'epicyclic oils'."
        allowed = "is neither a .toml file nor a built-in oil."
        raise one_problem("OIL", str(oil), allowed, remedy, "the command")
    tables, problems = read_file(path, "'epicyclic oils' shows the properties of others.")
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


# The folder of a campaign: what is simulated, what is finished, and the table of all results.
#
# ``campaign.json``  the plan; a folder with another one is refused
# ``simulations.partial``  journal of an unfinished campaign; of a shard ``.shard-2-of-8``
# ``simulations.csv``  one line for each simulation, when all are done
# ``model.json``  the fitted models


SIMULATIONS = "simulations"  # With which files of results begin.


@dataclass(frozen=True)
class CampaignFolder:
    """A campaign and the folder that keeps it."""

    path: Path
    campaign: Campaign

    @property
    def journal(self) -> Journal:
        """Finished simulations of an unfinished campaign."""
        return Journal(self.path.absolute() / f"{SIMULATIONS}.partial", fingerprint(self.campaign))

    @property
    def table(self) -> Path:
        """All results."""
        return self.path / f"{SIMULATIONS}.csv"

    @property
    def model(self) -> Path:
        """The fitted models."""
        return self.path / "model.json"

    @property
    def finished(self) -> int:
        """Number of finished simulations."""
        return self.campaign.size if self.table.exists() else len(self.journal.read())

    def prepare(self) -> None:
        """Make the folder; raises `InputError` if it cannot be made, or holds another campaign."""
        make_folder(self.path)
        plan = self.path / "campaign.json"
        simulated = any(self.path.glob(f"{SIMULATIONS}.*"))  # first: shards may begin at once
        if not plan.exists():
            if simulated:
                raise _folder_error(self.path, "contains simulations without their campaign.json.")
            write_file(plan, json.dumps(self.campaign.describe(), indent=2) + "\n")
        elif _read_json(plan) != json.loads(json.dumps(self.campaign.describe())):
            raise _folder_error(
                self.path,
                "contains a different campaign: other oil, points, seed, settings or version.",
            )

    def run(self, runner: Runner = HERE) -> None:
        """Simulate all that is not finished, and write the table."""
        if not self.table.exists():
            runner = replace(runner, journal=self.journal.path, tell_failures=True)
            self.write(runner.run(self.campaign))
            self.journal.remove()

    def write(self, rows: Rows) -> None:
        """Write the table of all results."""
        write_file(self.table, self._frame(rows).to_csv(index=False))

    def read(self) -> pd.DataFrame:
        """The table of all results; raises `InputError` if there is none, or it is damaged."""
        import pandas as pd

        try:
            content = read_bytes(self.table, "table of simulations", _LARGEST_TABLE)
            frame = pd.read_csv(io.BytesIO(content))
        except InputError as error:
            raise _folder_error(self.table, error.problems[0].allowed) from None
        except (OSError, ValueError) as error:
            allowed = f"cannot be read: {one_line(str(error))}."
            raise _folder_error(self.table, allowed) from None
        if len(frame) != self.campaign.size or "status" not in frame:
            raise _folder_error(self.table, "does not have one line for each simulation.")
        if "friction" not in frame:
            remedy = "See the reason in its column of messages, and give another folder."
            raise _folder_error(self.table, "has no simulation with a solution.", remedy)
        self._check_columns(frame)
        return frame

    def _check_columns(self, frame: pd.DataFrame) -> None:
        """Raise `InputError` unless all that is fitted is there, as finite numbers."""
        known = list(map(column_of, AXES))
        solved = [
            "unsolved_share",
            "roughness_kept",
            *(f"{name}{end}" for name in _RESULTS for end in ("", "_error")),
        ]
        lacks = [name for name in ("part", *known, *solved) if name not in frame]
        if lacks:
            raise _folder_error(self.table, f"lacks the columns {', '.join(lacks)}.")
        numbers = frame[known + solved]
        wrong = [name for name in numbers if numbers[name].dtype.kind not in "fiu"]
        wrong += [
            name
            for name in numbers
            if name not in wrong
            and (np.isinf(numbers[name]).any() or (name in known and numbers[name].isna().any()))
        ]
        if wrong:
            raise _folder_error(self.table, f"must hold finite numbers in {', '.join(wrong)}.")

    def _frame(self, rows: Rows) -> pd.DataFrame:
        """Conditions and results, one line for each simulation."""
        import pandas as pd

        every = range(self.campaign.size)
        points = [self.campaign.point(index) for index in every]
        return pd.DataFrame(
            {"number": every, "part": [self.campaign.part(index) for index in every]}
            | {column_of(name): [point[name] for point in points] for name in AXES}
            | {"status": rows.status, "message": rows.message}
            | {name: rows.numbers(name) for name in rows.names}
        )


def open_folder(path: Path) -> CampaignFolder:
    """The campaign that a folder holds.

    Raises `InputError` if it holds none, or one of another version of these files.
    """
    file = path / "campaign.json"
    data = _read_json(file)
    try:
        version = data["schema"]
        campaign = Campaign.again(data) if version == SCHEMA else None
    except InputError as error:
        raise InputError(error.problems, str(file)) from None
    except (KeyError, TypeError, AttributeError, ValueError, OverflowError):
        raise _folder_error(file, "is not a plan of a campaign.") from None
    if campaign is None:
        raise _folder_error(path, f"has files of version {version}, not {SCHEMA}.")
    return CampaignFolder(path, campaign)


def column_of(name: str) -> str:
    unit = quantity_of_axis(name).display
    return f"{name} [{unit}]" if unit else name


_LARGEST_PLAN, _LARGEST_TABLE = 1_000_000, 200_000_000
"""Largest campaign.json, and largest table of results. [bytes]"""
_RESULTS = ("friction", "rolling_loss")  # What the table holds with its error.


def _read_json(path: Path) -> Any:
    try:
        return json.loads(read_text(path, "campaign", _LARGEST_PLAN))
    except InputError as error:
        raise _folder_error(path, error.problems[0].allowed) from None
    except (RecursionError, ValueError):
        raise _folder_error(path, "is not JSON.") from None


def _folder_error(
    path: Path, allowed: str, remedy: str = "Give another folder, or repair this one."
) -> InputError:
    return one_problem("DIR", str(path), allowed, remedy, "the campaign")
