"""The search for designs: enumerate, screen, solve in the order of bounds, polish, choose.

A candidate is left unsolved only if a solved design beats it even where its loss is the least that
friction allows. How far losses stay above that least is learned from all solved designs of the same
arrangement, with a margin, and asked again after every batch: a guess, so those left out by it are
counted apart. The front is that of brute force as long as `search.solved` is not reached and no
candidate loses far less than all solved ones.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import pandas as pd

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.case.case import Case, read_case
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import EpicyclicError, InputError, Problem, Status, one_problem, raise_any
from epicyclic.messages import did_you_mean
from epicyclic.plugins.design.candidates import (
    LAYOUTS,
    case_tables,
    enumerate_all,
    operation,
    sizes,
    stated_gears,
    teeth_text,
)
from epicyclic.plugins.design.strength import strength
from epicyclic.plugins.design.task import OF_CASES, Task, read_task, task_tables
from epicyclic.schema.read import plain
from epicyclic.study.solve import loaded_meshes, solve
from epicyclic.study.sweeps.runner import Plan, Row, Rows, Runner, failed_row

if TYPE_CHECKING:
    import xarray as xr

SAFETIES = ("pitting", "bending", "micropitting", "scuffing", "bearing_life")
KNOWN = ("mass", "diameter", "width", "backlash")  # Without solving.
SCREENS = {
    "ratio_error": "error of the ratio",
    "assembly": "planets do not fit between the gears at equal angles",
    "planets_touch": "planets touch each other",
    "mesh": "gears do not mesh",
    "diameter": "diameter",
    "width": "width",
    "mass": "mass",
    "backlash": "backlash of all meshes at the output",
    "contact_ratio": "contact ratio",
    "tip_thickness": "thickness of the tips",
    "pitting": "pitting, bound without solving",
    "bending": "bending, bound without solving",
}
"""What a candidate may be rejected for before it is solved, in the order in which it is asked."""
UNITS = {
    "loss": "W", "mass": "kg", "diameter": "m", "width": "m", "backlash": "rad",
    "transmission_error": "um", "bearing_life": "h", "module": "m", "module2": "m",
}  # fmt: skip
SHOWN_LIMITS = {
    "diameter": (1e3, "mm"), "width": (1e3, "mm"), "mass": (1.0, "kg"),
    "backlash": (180 / math.pi, "deg"), "bearing_life": (1 / 3600, "h"),
}  # fmt: skip
"""What limits are told in."""
ROUNDED = 5e-4  # Largest error of four digits. [1]
USUAL_SHARE = 0.6  # Of a computed safety in its bound, before any is solved. [1]
LOSS_MARGIN = 0.8  # Of the smallest solved loss over its bound, for candidates not solved. [1]
ENOUGH_SOLVED = 16  # Designs of an arrangement that tell this.
BEATEN = "beaten by a bound"  # Of friction.
LIKELY = "probably beaten, judging by solved designs"
POLISH_REACH, POLISH_STEPS = 0.15, 8


def evaluate(task: Task, row: Mapping[str, Any]) -> dict[str, float]:
    """Loss over the cycle, transmission error and safety of one candidate, solved in full."""
    total = sum(point.share for point in task.points)
    loss = 0.0
    for number, point in enumerate(task.points):
        result = solve(read_case(case_tables(task, row, number)))
        if result.status is not Status.CONVERGED:
            raise one_problem("design", "", result.notes[0], "Leave it out.")
        loss += point.share / total * result.total
    case = read_case(case_tables(task, row))
    found = {"loss": loss, **strength(case).least()}
    if "transmission_error" in task.search.objectives:
        found["transmission_error"] = max(
            float(np.ptp(mesh.transmission_error)) * 1e6 for mesh in loaded_meshes(case).values()
        )
    return found


@dataclass(frozen=True, slots=True)
class DesignPlan(Plan):
    """Candidates that are solved in full, each a point."""

    kind: ClassVar[str] = "designs"
    may_fail: ClassVar[bool] = True
    batch: ClassVar[int] = 1  # A design takes up to some seconds.
    task: Mapping[str, Any]  # As its file has it.
    rows: tuple[Mapping[str, Any], ...]

    @property
    def size(self) -> int:
        """Number of designs."""
        return len(self.rows)

    def _solve(self, index: int) -> Row:
        try:
            return Row("converged", numbers=evaluate(read_task(self.task), self.rows[index]))
        except InputError as error:
            return failed_row(_reason(error))

    def describe(self) -> dict[str, Any]:
        """The task and the candidates."""
        return {"task": dict(self.task), "rows": [dict(row) for row in self.rows]}


def _reason(error: InputError) -> str:
    """Why a case is refused, without its numbers, so that equal reasons are counted together."""
    first = error.problems[0]
    key = first.key.split(".")[-1] if first.key else "case"
    return f"refused by the checks of cases: {key} {first.allowed}"


@dataclass
class Found:
    """The candidates of a task and what became of them.

    `table` has a row for each candidate; its column `fate` says why it was rejected, or
    ``"front"``, ``"dominated"``, `BEATEN`, `LIKELY` or ``"not solved"``.
    """

    task: Task
    table: pd.DataFrame
    margins: pd.DataFrame
    bounds: pd.DataFrame = field(default_factory=pd.DataFrame)  # `margins` before solving.
    fronts: list[int] = field(default_factory=list)
    chosen: list[int] = field(default_factory=list)
    combinations: int = 0  # Of which the candidates are all, or drawn.
    raw: Mapping[str, Any] = field(default_factory=dict)  # The task as its file has it.

    @cached_property
    def fates(self) -> dict[str, int]:
        """How many candidates ended how; they sum to all."""
        return {str(k): int(v) for k, v in self.table["fate"].value_counts().items()}

    def case(self, number: int) -> Case:
        """The case of a candidate at the operating point."""
        return read_case(case_tables(self.task, self.table.loc[number].to_dict()))

    def dataset(self) -> xr.Dataset:
        """All candidates over ``design``, with units."""
        import xarray as xr

        data = xr.Dataset.from_dataframe(self.table.rename_axis("design"))
        for name in data.data_vars:
            data[name].attrs = {"units": UNITS.get(str(name), "1")}
        data.attrs = {
            "title": self.task.title,
            "fates": json.dumps(self.fates),
            "objectives": ", ".join(self.task.search.objectives),
            "combinations": self.combinations,
            "seed": self.task.search.seed,
            "chosen": ", ".join(map(str, self.chosen)),
            "task": json.dumps(plain(self.raw)),
        }
        return data


def dominated(values: FloatArray, others: FloatArray) -> BoolArray:
    """Which rows any of `others` beats or equals in all columns and beats in one."""
    found = np.zeros(len(values), dtype=bool)
    for own in others:
        found |= (own <= values).all(axis=1) & (own < values).any(axis=1)
    return found


def design(
    task: str | Path | Mapping[str, Any],
    *,
    jobs: int | None = None,
    dask: str | None = None,
    journal: str | Path | None = None,
) -> Found:
    """Pareto-optimal gear sets that meet a task.

    Parameters
    ----------
    task : str, Path or mapping
        A TOML file, or its tables: ratio, operation, cycle, choices, limits, search, and the tables
        that all cases share.
    jobs, dask
        As for `sweep`.
    journal : str or Path, optional
        Folder for solved designs, from which the same task continues.

    Returns
    -------
    Found
        ``table``, a row for each candidate with its ``fate``; ``fates``, how many ended how;
        ``fronts`` and ``chosen``, their numbers; ``case(number)``; ``dataset()``.

    Raises
    ------
    InputError
        With all problems of the task, or the limit that no candidate meets, and by how much.
    """
    read = read_task(task)
    raw = dict(task) if isinstance(task, Mapping) else task_tables(Path(task))[0]
    return search(read, raw, Runner(jobs, dask, journal=journal))


def screen(task: Task) -> Found:
    """All candidates of a task, screened without solving."""
    table, combinations = enumerate_all(task)
    _check_tables(task, table.loc[0].dropna().to_dict())
    margins = pd.DataFrame(1.0, index=table.index, columns=[*SCREENS])
    for name in ("ratio", *KNOWN, "bound"):
        table[name] = math.nan
    for _, own in table.groupby("arrangement"):
        found = sizes(task, own.dropna(axis=1, how="all"))
        for key, values in found.margins.items():
            margins.loc[own.index, key] = values
        for key in ("ratio", *KNOWN):
            table.loc[own.index, key] = getattr(found, key)
        table.loc[own.index, "bound"] = found.loss
    fate = pd.Series("", index=table.index, dtype=object)
    for key, text in SCREENS.items():
        fate[(fate == "") & (margins[key] < 1 - 1e-9)] = text
    table["fate"] = fate
    return Found(task, table, margins, margins.copy(), combinations=combinations)


def _check_tables(task: Task, row: Mapping[str, Any]) -> None:
    """Raise what is wrong with the tables that all cases share, as any candidate's case has it."""
    gears = {
        gear.removesuffix("2") for name in task.choices.arrangements for gear in LAYOUTS[name].gears
    }
    problems = []
    for name in stated_gears(task):
        if name not in gears:
            remedy = did_you_mean(name, gears) or f"Name one of {', '.join(sorted(gears))}."
            key = f"case.strength.gears.{name}"
            problems.append(Problem(key, "", "is no gear of the arrangements.", remedy))
    raise_any(problems, task.title or "the task")
    try:
        read_case(case_tables(task, row))
    except InputError as error:
        shared = (it for it in error.problems if it.key.split(".")[0] in OF_CASES)
        raise_any((replace(it, key=f"case.{it.key}") for it in shared), task.title or "the task")


def _objectives(found: Found, rows: Any, loss: str) -> FloatArray:
    """The objectives of some rows; `loss` names the column that has the loss."""
    table, columns = found.table.loc[rows], []
    for name in found.task.search.objectives:
        if name == "transmission_error" and loss == "bound":
            columns.append(np.zeros(len(table)))
        else:
            columns.append(table[loss if name == "loss" else name].to_numpy(dtype=float))
    return np.column_stack(columns)


def search(
    task: Task,
    raw: Mapping[str, Any],  # The task as its file has it.
    runner: Runner | None = None,
    *,
    brute: bool = False,  # Solve every candidate that passes the screens.
    tell: Callable[[str], None] = lambda text: None,
    progress: Callable[[int, int], None] = lambda done, total: None,  # Of the designs to solve.
) -> Found:
    """Designs for a task: the non-dominated ones among all that meet the limits.

    Raises `InputError` if no candidate meets all limits, with the limit that is nearest to be met.
    """
    runner = runner or Runner()
    found = screen(task)
    found.raw = raw
    table = found.table
    for name in ("loss", "transmission_error", *SAFETIES):
        table[name] = math.nan
    if found.combinations > len(table):
        tell(f"{len(table):,} candidates are drawn from {found.combinations:,} combinations")
    tell(f"{len(table):,} candidates, {int((table['fate'] == '').sum()):,} pass the screens")
    solved = 0
    limit = len(table) if brute else task.search.solved
    while True:
        left = table.index[table["fate"] == ""] if brute else _not_beaten(found)
        if not len(left) or solved >= limit:
            break
        batch = _next(found, left, min(task.search.batch, limit - solved))
        rows = _solve(found, raw, batch, runner)
        _judge(found, batch, rows)
        solved += len(batch)
        progress(solved, min(limit, solved + len(left) - len(batch)))
        tell(f"{solved} solved, {int((table['fate'] == 'feasible').sum())} meet all limits")
    table.loc[table["fate"] == "", "fate"] = "not solved"
    if not (table["fate"] == "feasible").any():
        raise _impossible(found)
    _tell_front(found)
    if task.search.polished and not brute:
        table["polished_shift"] = math.nan
        for number in _choose(found)[: task.search.polished]:
            _polish(found, number, tell)
        _tell_front(found)  # a polished design may beat others of the front
    found.chosen = _choose(found)
    return found


def _tell_front(found: Found) -> None:
    """Which of the designs that meet all limits no other one beats."""
    table = found.table
    good = table.index[table["fate"].isin(["feasible", "front", "dominated"])]
    values = _objectives(found, good, "loss")
    beaten = dominated(values, values)
    table.loc[good, "fate"] = np.where(beaten, "dominated", "front")
    found.fronts = [int(it) for it in good[~beaten]]


def _not_beaten(found: Found) -> Any:
    """Candidates to solve: no feasible design beats them at the least loss they can have.

    Asked anew of all, as the last batch may have told more.
    """
    table = found.table
    table.loc[table["fate"].isin([BEATEN, LIKELY]), "fate"] = ""
    left = table.index[table["fate"] == ""]
    known = _objectives(found, table.index[table["fate"] == "feasible"], "loss")
    bounds = _objectives(found, left, "bound")
    learned = bounds.copy()
    if "loss" in found.task.search.objectives:
        learned[:, found.task.search.objectives.index("loss")] *= _least_ratios(found, left)
    fate = np.where(dominated(learned, known), LIKELY, "").astype(object)
    fate[dominated(bounds, known)] = BEATEN
    table.loc[left, "fate"] = fate
    return left[fate == ""]


def _least_ratios(found: Found, rows: Any) -> FloatArray:
    """Least loss that some rows will have over its bound, 1 or more, by their arrangement."""
    table = found.table
    ratios = (table["loss"] / table["bound"].where(table["bound"] > 0)).groupby(
        table["arrangement"]
    )
    least = (LOSS_MARGIN * ratios.min()).where(ratios.count() >= ENOUGH_SOLVED).clip(lower=1.0)
    own: FloatArray = table.loc[rows, "arrangement"].map(least).fillna(1.0).to_numpy(dtype=float)
    return own


def _next(found: Found, left: Any, count: int) -> list[int]:
    """The next designs to solve: fronts of their bounds, those first that will probably hold.

    Solved designs tell how far safety factors stay below their bounds. That only changes the order,
    and so does one design of every arrangement of which none is solved yet.
    """
    bounds = _objectives(found, left, "bound")
    rank = np.log(np.maximum(bounds, 1e-12)).sum(axis=1)
    weak = np.zeros(len(left), dtype=bool)
    for name in ("pitting", "bending"):
        needed = getattr(found.task.limits, name)
        if needed:
            known = found.table[name] / needed / found.bounds[name]
            usual = known.median() if known.notna().any() else USUAL_SHARE
            weak |= (found.bounds.loc[left, name] * usual < 1).to_numpy()
    order = np.lexsort((rank, weak))
    few = order[: 40 * count]
    few = few[weak[few] == weak[few[0]]]
    front = few[~dominated(bounds[few], bounds[few])]
    kinds = found.table["arrangement"]
    new = ~kinds[left[order]].isin(kinds[found.table["loss"].notna()])
    untried = order[new & ~kinds[left[order]].duplicated()]
    return [int(left[it]) for it in dict.fromkeys([*untried, *front, *order])][:count]


def _solve(found: Found, raw: Mapping[str, Any], batch: list[int], runner: Runner) -> Rows:
    left_out = ["fate", "bound", "ratio", *KNOWN, "loss", "transmission_error", *SAFETIES]
    rows = found.table.loc[batch].drop(columns=left_out)
    made = [row.dropna().to_dict() for _, row in rows.iterrows()]
    plan = DesignPlan(raw, tuple(made))
    return runner.within(plan).run(plan)


def _judge(found: Found, batch: list[int], rows: Rows) -> None:
    """What became of solved candidates."""
    needed = _needed(found.task)
    for place, number in enumerate(batch):
        if rows.status[place] != "converged":
            text = rows.message[place]
            found.table.loc[number, "fate"] = [*text.splitlines(), "no solution"][0][:100]
            continue
        fate = "feasible"
        for name in ("loss", "transmission_error", *SAFETIES):
            value = float(rows.numbers(name)[place])
            found.table.loc[number, name] = value
            least = needed.get(name)
            if least is not None and not math.isnan(value):
                if name not in found.margins:
                    found.margins[name] = 1.0
                found.margins.loc[number, name] = value / least if least else 1.0
                if value < least and fate == "feasible":
                    fate = name.replace("_", " ")
        found.table.loc[number, "fate"] = fate


def _impossible(found: Found) -> InputError:
    """Which limit the nearest candidate misses, and by how much."""
    margins = found.margins.clip(upper=1.0)
    refused = found.table["fate"].str.startswith(("refused", "no solution"))
    usable = margins[~refused] if (~refused).any() else margins
    nearest = usable.min(axis=1).sort_values(ascending=False).index[0]
    missed = usable.loc[nearest]
    row = found.table.loc[nearest]
    what = (
        f"the nearest of {len(found.table):,} candidates, "
        f"{row['arrangement']} {teeth_text(row)} with module {1e3 * row['module']:.3g} mm"
    )
    problems = [
        _missed(found.task, str(key), float(missed[key]), what, bool(np.isnan(row["loss"])))
        for key in missed.index[missed < 1 - 1e-9]
    ]
    if not problems:
        fates = "; ".join(f"{count} {fate}" for fate, count in found.fates.items())
        problems = [Problem("search", "", f"found no design: {fates}.", "Raise search.solved.")]
    return InputError(problems, found.task.title or "the task")


def _missed(task: Task, key: str, margin: float, what: str, is_bound: bool) -> Problem:
    """A limit that even the nearest candidate does not meet, and what it reaches."""
    if not hasattr(task.limits, key):
        text = f"lead to no design: {SCREENS[key]}, even of {what}."
        return Problem("choices", "", text, "Allow other numbers of teeth and planets.")
    scale, unit = SHOWN_LIMITS.get(key, (1.0, ""))
    limit = getattr(task.limits, key)
    is_least = key in (*SAFETIES, "contact_ratio", "tip_thickness")
    reached = limit * margin if is_least else limit / max(margin, 1e-12)
    safe = reached * (1 - ROUNDED if is_least else 1 + ROUNDED)
    stated, known, safe = (f"{scale * it:.4g} {unit}".rstrip() for it in (limit, reached, safe))
    told = f"is missed by {100 * (1 - margin):.3g} %: {what}, has {known}"
    if is_bound and key in SAFETIES:
        told += " at best"
    remedy = f"Relax it to {safe}, or allow more choices."
    return Problem(f"limits.{key}", stated, f"{told}.", remedy)


def _needed(task: Task) -> dict[str, float]:
    """Safeties that must be, and hours of bearings, as `Strength.least` has them."""
    stated = {name: getattr(task.limits, name) for name in SAFETIES}
    found = {name: float(it) for name, it in stated.items() if it is not None}
    if "bearing_life" in found:
        found["bearing_life"] /= 3600
    return found


def _polish(found: Found, number: int, tell: Callable[[str], None]) -> None:
    """A better profile shift of a design, by a bounded search along x of the sun."""
    from scipy.optimize import minimize_scalar

    start, known = (float(found.table.loc[number, name]) for name in ("shift", "loss"))
    tried: list[dict[str, float]] = []
    others = [name for name in found.task.search.objectives if name != "loss"]

    def loss_at(shift: float) -> float:
        made = _shifted(found, number, float(shift))
        if made is None:
            return 10 * known
        if all(made[it] <= found.table.loc[number, it] for it in others):  # else it is another one
            tried.append(made)
        return made["loss"]

    minimize_scalar(
        loss_at,
        bounds=(start - POLISH_REACH, start + POLISH_REACH),
        method="bounded",
        options={"maxiter": POLISH_STEPS, "xatol": 5e-3},
    )
    best = min(tried, key=lambda it: it["loss"], default={"loss": known})
    if best["loss"] < known:
        found.table.loc[number, ["polished_shift", *best]] = [start, *best.values()]
        saved = known - best["loss"]
        tell(f"design {number}: x {start:.3g} -> {best['shift']:.3f} saves {saved:.3g} W")


def _shifted(found: Found, number: int, shift: float) -> dict[str, float] | None:
    """A design with another profile shift: what changes; None if it misses a limit."""
    row = found.table.loc[number].dropna().to_dict() | {"shift": shift}
    own = sizes(found.task, pd.DataFrame([row]))
    if min(it[0] for it in own.margins.values()) < 1 - 1e-9:
        return None
    try:
        numbers = evaluate(found.task, row)
    except EpicyclicError:  # a shift that cannot be made is a bad one
        return None
    needed = _needed(found.task)
    if any(numbers.get(name, math.inf) < least for name, least in needed.items()):
        return None
    return {"shift": shift, **{name: float(getattr(own, name)[0]) for name in KNOWN}, **numbers}


def _choose(found: Found) -> list[int]:
    """Of the front the best in each objective and the one nearest to all of them."""
    rows = found.fronts
    values = _objectives(found, rows, "loss")
    span = np.ptp(values, axis=0)
    scaled = (values - values.min(axis=0)) / np.where(span > 0, span, 1.0)
    order = np.argsort(np.hypot.reduce(scaled, axis=1), kind="stable")
    wanted = dict.fromkeys([order[0], *values.argmin(axis=0), *order])
    return [rows[it] for it in wanted][: found.task.search.chosen]


def odds(found: Found, samples: int, runner: Runner | None = None) -> list[str]:
    """Sentences on how probably the first chosen design loses less than the others, or they less.

    Over the cycle, by paired draws that are the same at all of its points.
    """
    from epicyclic.study.bands.compare_cases import compare_cases

    runner, points = runner or Runner(), found.task.points
    times = [
        (point.share, {f"operation.{key}": text for key, text in operation(point).items()})
        for point in points
    ]
    first, *others = found.chosen
    lines = []
    for other in others:
        data = compare_cases(
            found.case(other), found.case(first), samples=samples, seed=found.task.search.seed,
            points=times, jobs=runner.jobs, dask=runner.dask,
        )  # fmt: skip
        total = data.sel(result="total")
        share, mean = float(total.probability), float(total.difference)
        low, high = float(total.low), float(total.high)
        better, worse = first, other
        if share < 0.5:
            better, worse = other, first
            share, mean, low, high = 1 - share, -mean, -high, -low
        lines.append(
            f"Design {better} loses less than design {worse} in {100 * share:.0f} % of {samples} "
            f"paired draws over the cycle: {-mean:.3g} W on average, {-high:.3g} to {-low:.3g} W."
        )
    return lines


def case_text(tables: Mapping[str, Any]) -> str:
    """A case file, one line for each table."""
    from epicyclic.show.template import toml_key, toml_value

    return "".join(f"{toml_key(key)} = {toml_value(value)}\n" for key, value in tables.items())
