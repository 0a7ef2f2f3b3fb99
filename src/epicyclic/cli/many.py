"""Commands on many cases, resumed where they were interrupted: sweep, map."""

from __future__ import annotations

import glob
import sys
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from epicyclic.cli import common
from epicyclic.errors import EXIT_FAILED_POINTS, Problem, one_problem, raise_any

if TYPE_CHECKING:
    from epicyclic.case.case import Case
    from epicyclic.study.maps.compute import MapPlan
    from epicyclic.study.sweeps.run import SweepPlan
    from epicyclic.study.sweeps.runner import Journal, Plan, Rows, Runner


def refuse_options(options: Mapping[str, object]) -> None:
    """Raise `InputError` for options that say what is computed: a stored map holds it."""
    allowed = "selects what is computed, but a stored map already holds its results."
    remedy = "Leave it out, or give the case in place of the file."
    wrong = (Problem(f"--{it}", "", allowed, remedy) for it, value in options.items() if value)
    raise_any(wrong, "the command")


def convert(file: Path, output: Path, name: str | None, *, heated: bool) -> None:
    """Write the map of `file` to `output`, with the temperature as a state if it is `heated`."""
    from epicyclic.show.record import open_map
    from epicyclic.study.maps.compute import with_temperature_state
    from epicyclic.study.maps.formats import write_map
    from epicyclic.study.maps.tables import map_case

    data = open_map(file)
    if heated:
        case = map_case(data)
        if case is None:
            allowed = "cannot be given, because the case of the map was not made by this version."
            remedy = "Compute the map again."
            raise one_problem("--temperature-state", "", allowed, remedy, str(file))
        data = with_temperature_state(data, case)
    write_map(data, output, name)
    common.echo(f"Wrote the map of {file} to {output}.")


Write = Callable[["Rows"], str]  # Writes the rows of a plan, and tells what it wrote.
SHOWN_FAILURES = 10


@click.command()
@common.case_options
@click.option(
    "--vary",
    metavar="KEY=VALUES",
    multiple=True,
    help='a,b,c or start:stop:count, as in "operation.speed=1000:4000:4 rpm".',
)
@click.option(
    "--vary-together",
    "together",
    metavar="KEY=VALUES; KEY=VALUES",
    multiple=True,
    help='Keys that vary together, as in "sun.teeth=30,33; ring.teeth=84,90".',
)
@common.file_option(
    "--points",
    metavar="FILE.csv",
    help='Table with one point per row and one key per column: "gears.normal_module [mm]".',
)
@click.option(
    "--link",
    "links",
    metavar="KEY=EXPRESSION",
    multiple=True,
    help='A key computed from others, as in "ring.teeth = sun.teeth + 2 * planet.teeth".',
)
@common.output_option(".nc, .csv or .parquet", required=True)
@common.shard_option
@common.runner_options
def sweep(
    case: str,
    changes: tuple[str, ...],
    vary: tuple[str, ...],
    together: tuple[str, ...],
    points: Path | None,
    links: tuple[str, ...],
    output: Path,
    runner: Runner,
) -> None:
    """Compute the full product of the values of some keys.

    Keys that change together, or the rows of a table, are one dimension of it. In the expression
    of a key, the key itself is its value in the case, as is case(KEY) of any other.

    Finished points are kept in a file beside OUTPUT that ends in .partial, so that an interrupted
    sweep continues where it stopped when the same command is given again.
    """
    from epicyclic.study.sweeps.axes import columns_of
    from epicyclic.study.sweeps.run import (
        check_output,
        make_plan,
        parse_links,
        parse_together,
        parse_vary,
    )

    loaded = common.load_with(case, changes)
    check_output(output)
    plan = make_plan(
        loaded,
        parse_vary(loaded, vary),
        together=parse_together(loaded, together),
        points=None if points is None else columns_of(points),
        links=parse_links(links),
    )
    compute(plan, output, runner, sweep_writer(plan, output))


def sweep_writer(plan: SweepPlan, output: Path) -> Write:
    """Writes a sweep; raises `InputError` if it cannot."""
    from epicyclic.study.sweeps import run as dataset

    dataset.check_output(output)

    def write(rows: Rows) -> str:
        for key in dataset.idle_keys(plan, rows):
            common.echo(f"Note: no loss changes with {key}.", err=True)
        tell_ranges(plan, rows)
        dataset.write_dataset(dataset.to_dataset(plan, rows), output)
        return points_written(rows, output)

    return write


@click.command("map")
@click.argument("case", metavar="CASE|FILE.nc")
@common.set_option
@click.option("--speed", metavar="VALUES", help='Speed of the input member, as in "0:4000:41 rpm".')
@click.option(
    "--torque",
    metavar="VALUES",
    help='Torque on the input member, as in "-1000:1000:41 N*m"; against the speed means coasting.',
)
@common.temperature_option
@click.option(
    "--states",
    metavar="NAMES",
    help='States of a train, as in "1,2,R"; default: all in which it can run.',
)
@click.option(
    "--vary",
    metavar="KEY=VALUES",
    multiple=True,
    help='Further keys to vary, as in "planet.count=3,4".',
)
@common.output_option("File of the map.", required=True)
@click.option(
    "--format", "name", metavar="NAME", help="File format; default: by the ending of the file."
)
@click.option(
    "--even-torques", is_flag=True, help="Do not add torques close to zero to start:stop:count."
)
@click.option(
    "--temperature-state",
    "heated",
    is_flag=True,
    help="For an FMU: its temperature follows from its losses.",
)
@common.shard_option
@common.runner_options
def loss_map(
    case: str,
    changes: tuple[str, ...],
    states: str | None,
    vary: tuple[str, ...],
    output: Path,
    name: str | None,
    even_torques: bool,
    heated: bool,
    runner: Runner,
    **values: str | None,
) -> None:
    """Compute a loss map: torque loss, losses and efficiency over speed and torque.

    VALUES are a,b,c or start:stop:count with a unit. Because losses rise steeply near zero torque,
    a range start:stop:count that reaches zero gets additional torques there. The torque loss is
    that at the input member; the file states the signs. A train has a map of each of its states.
    An interrupted map continues where it stopped, as a sweep does.

    FILE.nc is a stored map, which is converted to another format.
    """
    from epicyclic.show.record import is_stored

    if is_stored(case):
        refuse_options(
            {"set": changes, "states": states, "vary": vary, "even-torques": even_torques}
            | values
            | {"jobs": runner.jobs, "dask": runner.dask, "shard": runner.shard}
        )
        convert(Path(case), output, name, heated=heated)
        return
    from epicyclic.study.maps.compute import (
        check_axis,
        coordinates,
        lumped,
        map_plan,
        resolving_texts,
        states_left_out,
    )
    from epicyclic.study.sweeps.run import parse_vary

    loaded = common.load_with(case, changes)
    _check_given(values)
    check_values(values)
    chosen = None if states is None else [name.strip() for name in states.split(",")]
    own = lumped(loaded) if heated else None
    if heated:  # the map holds the losses of a gearbox that is as hot as its oil
        loaded = loaded.updated({"models.temperatures": "inlet"})
    given, further = parse_axes(loaded, values), parse_vary(loaded, vary)
    speed, torque = given["speed"], given["torque"]
    if ":" in (values["torque"] or "") and not even_torques:
        torque = resolving_texts(torque)
    plan = map_plan(loaded, speed, torque, given.get("temperature"), further, chosen)
    for state, reason in ({} if chosen else states_left_out(loaded)).items():
        common.echo(f"State {state} is left out: it {reason}", err=True)
    if heated:
        check_axis(len(coordinates(plan).get("temperature", ())))
    compute(plan, output, runner, map_writer(plan, output, name, own), format=name, lumped=own)


def map_writer(
    plan: MapPlan,
    output: Path,
    format: str | None = None,
    lumped: Mapping[str, float] | None = None,
) -> Write:
    """Writes a map, with the attributes `lumped`; raises `InputError` if it cannot."""
    from epicyclic.study.maps.compute import checked_map, coordinates, held_shaft
    from epicyclic.study.maps.formats import check_map_output, files_of_map, write_map

    axes = coordinates(plan)
    chosen = check_map_output(output, format, axes, held_shaft(plan.case))
    files = ", ".join(map(str, files_of_map(output, chosen, axes).values()))

    def write(rows: Rows) -> str:
        data = checked_map(plan, rows)
        write_map(data.assign_attrs(lumped or {}), output, format)
        if "torque_interpolation" in data.attrs:
            common.echo(f"Interpolated {data.attrs['torque_interpolation']}.", err=True)
        tell_warnings(plan, rows)
        return points_written(rows, files)

    return write


def _check_given(values: Mapping[str, str | None]) -> None:
    """Raise `InputError` for options without which a map cannot be computed."""
    problems = [
        Problem(f"--{name}", "", "is missing.", f'For example --{name} "{example}".')
        for name, example in {"speed": "0:4000:41 rpm", "torque": "-1000:1000:41 N*m"}.items()
        if values[name] is None
    ]
    raise_any(problems, "the command")


def check_values(values: Mapping[str, str | None]) -> None:
    """Raise `InputError` for options that name no values."""
    allowed = "must be a,b,c or start:stop:count with a unit."
    remedy = 'For example "0:4000:41 rpm" for the speed.'
    problems = [
        Problem(f"--{name}", f'"{text}"', allowed, remedy)
        for name, text in values.items()
        if text is not None and not text.strip()
    ]
    raise_any(problems, "the command")


def parse_axes(case: Case, values: Mapping[str, str | None]) -> dict[str, list[Any]]:
    """The values of speed, torque and temperature, as far as they are given."""
    from epicyclic.study.operating import AXES
    from epicyclic.study.sweeps.run import parse_vary

    texts = [f"{AXES[axis]}={text}" for axis, text in values.items() if text is not None]
    found = parse_vary(case, texts)
    return {axis: found[key] for axis, key in AXES.items() if key in found}


def compute(
    plan: Plan, output: Path, runner: Runner, write: Write, noun: str = "points", **how: Any
) -> None:
    """Compute the points of `plan`, resumed and kept beside `output`, and write them.

    Those of a shard are kept only, with `how` they are to be written.
    """
    from epicyclic.study.sweeps.runner import Journal, fingerprint, share_of

    mark = fingerprint(plan)
    name = f"{mark}.partial" if runner.shard is None else "shard-{}-of-{}".format(*runner.shard)
    journal = Journal(output.with_name(f"{output.name}.{name}"), mark)
    _tell_others(output, journal.path)
    size, kept = len(share_of(plan, runner.shard)), len(journal.read())
    if kept:
        common.echo(f"Continuing from {kept} of {size} points in {journal.path}.", err=True)
    try:
        with common.progress_bar(noun) as progress:
            rows = replace(runner, journal=journal.path, progress=progress, output=how).run(plan)
        if runner.shard is None:
            finish(plan, rows, write, journal)
        else:
            common.echo(f"{size} of {plan.size} points are in {journal.path}.")
    except (KeyboardInterrupt, Exception):
        kept = len(journal.read())
        if kept:
            common.echo(
                f"{kept} of {size} points kept in {journal.path}; give the same command again to "
                "continue.",
                err=True,
            )
        raise


def finish(plan: Plan, rows: Rows, write: Write, journal: Journal | None = None) -> None:
    """Write the rows of all points, and end with an exit code of its own if some failed."""
    failures = [] if plan.may_fail else rows.failures
    _print_failures(failures)
    _print_thin_teeth(rows)
    written = write(rows)
    if journal is not None:
        journal.remove()
    common.echo(written)
    if failures:
        sys.exit(EXIT_FAILED_POINTS)


def _print_thin_teeth(rows: Rows) -> None:
    """Say at how many points the gears have gross backlash, which losses do not show."""
    from epicyclic.gears.rules import TOO_THIN

    thin = sum(TOO_THIN in text for text in rows.warnings)
    if thin:
        common.echo(
            f"{thin} of {len(rows)} points: the teeth are far too thin for their centre distance. "
            "If profile shifts are left out, they are computed for each point.",
            err=True,
        )


def tell_ranges(plan: SweepPlan, rows: Rows) -> None:
    """Say at how many points models are used outside their ranges, and at which most of them."""
    from epicyclic.losses.ranges import OUT_OF_RANGE

    outside = [text.count(OUT_OF_RANGE) for text in rows.warnings]
    if count := sum(map(bool, outside)):
        worst = plan.changes(outside.index(max(outside))).items()
        told = f"{count} of {len(rows)} points use a model outside its range, most at"
        place = ", ".join(f"{key} = {value}" for key, value in worst)
        common.echo(f"{told} {place}; 'epicyclic run' there names them.", err=True)


def tell_warnings(plan: MapPlan, rows: Rows) -> None:
    """Say what `run` would warn of where most is lost, and where ranges are left."""
    from numpy import nan_to_num

    tell_ranges(plan, rows)
    worst = int(nan_to_num(rows.numbers("total"), nan=-1.0).argmax())
    if rows.warnings[worst]:
        warn_at(plan.case.updated(plan.changes(worst)))


def warn_at(case: Case, where: str = "at the greatest loss") -> None:
    """Say what `run` warns of at this point."""
    from epicyclic.show.summary import first_warnings
    from epicyclic.study.solve import solve

    found = first_warnings(solve(case))
    if found.items:
        head = f"{found.title} {where}: {common.point_of(case)}"
        common.echo("\n• ".join((head, *found.items)), err=True)


def points_written(rows: Rows, output: Path | str) -> str:
    """What to say of the file, or of several."""
    failed = len(rows.failures)
    outcome = f", {failed} of them failed." if failed else "."
    return f"Wrote {len(rows)} point{'' if len(rows) == 1 else 's'} to {output}{outcome}"


def _tell_others(output: Path, own: Path) -> None:
    """Say what is there beside `output` from other sweeps that were interrupted."""
    for path in sorted(output.parent.glob(f"{glob.escape(output.name)}.*.partial")):
        if path.name != own.name:
            common.echo(
                f"{path} holds points of an interrupted sweep of another case or with other "
                "values, and is kept. Delete it if you do not need it.",
                err=True,
            )


def _print_failures(reasons: Sequence[str]) -> None:
    """Each reason once, with the number of points that failed for it."""
    counts = Counter(reasons)
    for reason, count in list(counts.items())[:SHOWN_FAILURES]:
        common.echo(f"{count} failed: {reason}", err=True)
    if len(counts) > SHOWN_FAILURES:
        common.echo(f"... and {len(counts) - SHOWN_FAILURES} other reasons.", err=True)
