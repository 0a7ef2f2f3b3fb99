"""The command ``epicyclic``: parses, calls the library, prints.

Exit codes: 0 done, 1 an error of the program, 2 bad input, 3 no solution found, 4 a sweep with
failed points, 130 interrupted. ``EPICYCLIC_TRACEBACK=1`` shows where in the program an error arose.
"""

from __future__ import annotations

import io
import os
import signal
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from epicyclic.errors import ConvergenceError, InputError, Problem, is_interrupt
from epicyclic.status import Status

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from epicyclic.sweeps.journal import Journal, Row
    from epicyclic.sweeps.plan import Plan

__all__ = ["main"]

EXIT_ERROR, EXIT_INPUT, EXIT_NO_SOLUTION, EXIT_FAILED_POINTS = 1, 2, 3, 4
EXIT_INTERRUPTED, EXIT_BROKEN_PIPE = 130, 141
SHOWN_FAILURES = 10
PICTURES = (".png", ".svg", ".pdf")
ANIMATION = ".gif"

case_argument = click.argument("case", metavar="CASE")
set_option = click.option(
    "--set",
    "changes",
    metavar="KEY=VALUE",
    multiple=True,
    help='Change a key of the case, as in --set "operation.torque=500 N*m". An empty value '
    "removes the key.",
)


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="epicyclic")
def cli() -> None:
    """Power losses of planetary gear sets and gear pairs: how much, where, and why.

    CASE is a TOML file or the name of a built-in case (epicyclic cases).

    \b
    epicyclic run talbot-2012
    epicyclic run talbot-2012 --set "operation.torque=500 N*m" --json -
    epicyclic sweep talbot-2012 --vary "operation.speed=1000:4000:4 rpm" -o speed.nc
    """


@cli.command()
@case_argument
@set_option
@click.option(
    "--json",
    "json_file",
    metavar="[FILE]",
    is_flag=False,
    flag_value="-",
    help="Write the result as JSON, to standard output if no FILE or - is given.",
)
def run(case: str, changes: tuple[str, ...], json_file: str | None) -> None:
    """Compute the losses of a case and print them by component."""
    from epicyclic.analysis.solve import solve

    result = solve(_load(case, changes))
    if json_file == "-":
        click.echo(result.to_json())
        return
    from epicyclic.report.tables import result_tables, terminal

    if json_file is not None:
        _write(Path(json_file), result.to_json() + "\n")
    terminal().print(result_tables(result))


@cli.command()
@case_argument
@set_option
def check(case: str, changes: tuple[str, ...]) -> None:
    """Check a case without computing anything."""
    loaded = _load(case, changes)
    click.echo(f"{case}: a sound {loaded.kind} case.")


@cli.command()
def cases() -> None:
    """List the built-in cases and their variants."""
    from epicyclic.report.library_tables import case_table
    from epicyclic.report.tables import terminal

    terminal().print(case_table())


@cli.command()
@click.argument("name", required=False)
def oils(name: str | None) -> None:
    """List the built-in oils, or show one with the source of every value."""
    from epicyclic import library
    from epicyclic.case.nearest import did_you_mean
    from epicyclic.report.library_tables import oil_sheet, oil_table
    from epicyclic.report.tables import terminal

    if name is None:
        terminal().print(oil_table())
        return
    if name not in library.oil_names():
        remedy = did_you_mean(name, library.oil_names()) or "See 'epicyclic oils'."
        raise InputError([Problem("NAME", repr(name), "is no built-in oil.", remedy)])
    terminal().print(oil_sheet(name))


@cli.command()
@click.argument("file", type=click.Path(path_type=Path), default=Path("case.toml"))
@click.option("--kind", type=click.Choice(["planetary", "gear_pair"]), default="planetary")
def init(file: Path, kind: str) -> None:
    """Write a commented case FILE (default case.toml) to start from."""
    from epicyclic.report.template import case_template

    if file.exists():
        problem = Problem("FILE", str(file), "exists already.", "Name another file.")
        raise InputError([problem], "the command")
    _write(file, case_template(kind))
    click.echo(f"Wrote {file}. Next: epicyclic run {file}")


@cli.command()
def schema() -> None:
    """Print the JSON Schema of case files."""
    import json

    from epicyclic.case.case import case_schema

    click.echo(json.dumps(case_schema(), indent=2))


@cli.command()
@case_argument
@set_option
def friction(case: str, changes: tuple[str, ...]) -> None:
    """Compare all friction models on a case, with the spread."""
    from epicyclic.analysis.compare import compare_friction
    from epicyclic.report.tables import friction_table, terminal

    terminal().print(friction_table(compare_friction(_load(case, changes))))


CONTACT_OPTIONS = {
    "radius": ("contact.radius", "Equivalent radius, as in '10 mm'."),
    "load": ("contact.line_load", "Load per length, as in '500 N/mm'."),
    "pressure": ("contact.hertz_pressure", "Instead of the load: Hertz pressure, as in '1 GPa'."),
    "speed": ("contact.rolling_speed", "Mean surface speed, as in '10 m/s'."),
    "slip": ("contact.slide_to_roll_ratio", "Slide-to-roll ratio, 0 to 2."),
    "oil": ("lubricant.oil", "A name of 'epicyclic oils'."),
    "temperature": ("lubricant.temperature", "Of the oil at the inlet, as in '90 degC'."),
    "roughness1": ("surface1.roughness", "Rq, as in '0.4 um', or the name of a finish."),
    "roughness2": ("surface2.roughness", "Of the other surface."),
}


def contact_options(command: Any) -> Any:
    """An option for each of `CONTACT_OPTIONS`."""
    for name, (_, text) in reversed(CONTACT_OPTIONS.items()):
        command = click.option(f"--{name}", metavar="VALUE", help=text)(command)
    return command


@cli.command()
@click.argument("file", type=click.Path(path_type=Path), required=False)
@contact_options
@set_option
@click.option("--json", "json_file", metavar="FILE", help="Write the result as JSON; - for stdout.")
@click.option(
    "--plot",
    type=click.Path(path_type=Path),
    help="Draw pressure and film (.png, .svg, .pdf); a rough contact moves in a .gif.",
)
def contact(
    file: Path | None,
    changes: tuple[str, ...],
    json_file: str | None,
    plot: Path | None,
    **options: str | None,
) -> None:
    """Solve one lubricated line contact, given by FILE or by options.

    \b
    epicyclic contact --radius "10 mm" --pressure "1 GPa" --speed "10 m/s" --slip 0.2 \\
        --oil atf-talbot-2012 --temperature "90 degC" --roughness1 "0.1 um"
    """
    from epicyclic.analysis.contact import solve_contact
    from epicyclic.case.contact import load_contact_case
    from epicyclic.case.values import parse_value

    given = {
        CONTACT_OPTIONS[name][0]: parse_value(text)
        for name, text in options.items()
        if text is not None
    }
    if plot is not None:
        _check_picture("--plot", plot, (*PICTURES, ANIMATION))
    case = load_contact_case(file or {}, given | _parse_changes(changes))
    result = solve_contact(case, frames=plot is not None)
    if json_file == "-":
        click.echo(result.to_json())
    else:
        from epicyclic.report.contact_table import contact_tables
        from epicyclic.report.tables import terminal

        if json_file is not None:
            _write(Path(json_file), result.to_json() + "\n")
        terminal().print(contact_tables(result))
    if plot is not None and result.smooth.status is Status.CONVERGED:
        from epicyclic.plots.contact import contact_animation, contact_figure

        if plot.suffix == ANIMATION and result.rough is not None:
            _write(plot, contact_animation(result))
        else:
            _write(plot, _picture(contact_figure(result), plot))
    if result.status is not Status.CONVERGED:
        sys.exit(EXIT_NO_SOLUTION)


@cli.command()
@case_argument
@set_option
@click.option(
    "--plot",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Draw each mesh to FILE-MESH.png, .svg or .pdf.",
)
def mesh(case: str, changes: tuple[str, ...], plot: Path | None) -> None:
    """Show how the teeth carry: load, transmission error, stiffness, pressure, friction power."""
    from epicyclic.analysis.mesh_details import mesh_details
    from epicyclic.report.mesh_table import mesh_tables
    from epicyclic.report.tables import terminal

    if plot is not None:
        _check_picture("--plot", plot)
    meshes = mesh_details(_load(case, changes))
    terminal().print(mesh_tables(meshes))
    if plot is not None:
        from epicyclic.plots.mesh import mesh_figure

        for key, details in meshes.items():
            _draw(mesh_figure(details), plot.with_name(f"{plot.stem}-{key}{plot.suffix}"))


@cli.command()
@case_argument
@set_option
@click.option(
    "--vary",
    metavar="KEY=VALUES",
    multiple=True,
    required=True,
    help='a,b,c or start:stop:count, as in "operation.speed=1000:4000:4 rpm".',
)
@click.option(
    "-o", "--output", required=True, type=click.Path(path_type=Path), help=".nc, .csv or .parquet"
)
@click.option("--jobs", type=click.IntRange(1), help="Worker processes; default: as it pays.")
def sweep(
    case: str, changes: tuple[str, ...], vary: tuple[str, ...], output: Path, jobs: int | None
) -> None:
    """Compute the full product of the values of some keys.

    Finished points are kept in a file beside OUTPUT that ends in .partial, so that an interrupted
    sweep goes on where it stopped when the same command is given again.
    """
    from epicyclic.sweeps import dataset
    from epicyclic.sweeps.plan import make_plan, parse_vary

    loaded = _load(case, changes)
    dataset.check_output(output)
    plan = make_plan(loaded, parse_vary(loaded, vary))
    _compute(
        plan,
        output,
        jobs,
        lambda rows: dataset.write_dataset(dataset.to_dataset(plan, rows), output),
    )


@cli.command("map")
@case_argument
@set_option
@click.option(
    "--speed", metavar="VALUES", required=True, help='Of the input member, as in "0:4000:41 rpm".'
)
@click.option(
    "--torque",
    metavar="VALUES",
    required=True,
    help='On the input member, as in "-1000:1000:41 N*m"; against the speed is coasting.',
)
@click.option(
    "--temperature",
    metavar="VALUES",
    help='Of the oil at the inlet, as in "40,60,90 degC"; default: that of the case.',
)
@click.option(
    "--vary", metavar="KEY=VALUES", multiple=True, help='Further keys, as in "planet.count=3,4".'
)
@click.option(
    "-o", "--output", required=True, type=click.Path(path_type=Path), help="File of the map."
)
@click.option("--format", "name", metavar="NAME", help="Default: by the ending of the file.")
@click.option("--jobs", type=click.IntRange(1), help="Worker processes; default: as it pays.")
def loss_map(
    case: str,
    changes: tuple[str, ...],
    vary: tuple[str, ...],
    output: Path,
    name: str | None,
    jobs: int | None,
    **values: str | None,
) -> None:
    """Compute a loss map: torque loss, losses and efficiency over speed and torque.

    VALUES are a,b,c or start:stop:count with a unit. The torque loss is that at the input member;
    the file states the signs. An interrupted map goes on where it stopped, as a sweep does.
    """
    from epicyclic.maps.compute import AXES, coordinates, held_shaft, map_plan, row_length, to_map
    from epicyclic.maps.formats import check_map_output, write_map
    from epicyclic.sweeps.plan import parse_vary

    loaded = _load(case, changes)
    _check_values(values)
    axes = [f"{AXES[axis]}={text}" for axis, text in values.items() if text is not None]
    given, further = parse_vary(loaded, axes), parse_vary(loaded, vary)
    speed, torque = given[AXES["speed"]], given[AXES["torque"]]
    plan = map_plan(loaded, speed, torque, given.get(AXES["temperature"]), further)
    check_map_output(output, name, coordinates(plan), held_shaft(loaded))
    _compute(
        plan,
        output,
        jobs,
        lambda rows: write_map(to_map(plan, rows), output, name),
        batch=row_length(plan),
    )


def _check_values(values: Mapping[str, str | None]) -> None:
    """Raise `InputError` for options that name no values."""
    problems = [
        Problem(
            f"--{name}", f'"{text}"', "must be a,b,c or start:stop:count with a unit.",
            'For example "0:4000:41 rpm" for the speed.',
        )
        for name, text in values.items()
        if text is not None and not text.strip()
    ]  # fmt: skip
    if problems:
        raise InputError(problems, "the command")


def _compute(
    plan: Plan,
    output: Path,
    jobs: int | None,
    write: Callable[[Sequence[Row]], None],
    **options: int,
) -> None:
    """Compute the points of `plan`, resumed and kept beside `output`, and `write` their rows."""
    from epicyclic.cli.progress import progress_bar
    from epicyclic.sweeps.run import run_plan

    journal = _open_journal(plan, output)
    with _kept_in(journal, plan.size):
        with progress_bar("points") as progress:
            rows = run_plan(plan, jobs=jobs, journal=journal, progress=progress, **options)
        reasons = [row.message for row in rows if row.status == Status.FAILED]
        _print_failures(reasons)
        with _finishing(f"Writing {output}."):
            write(rows)
            journal.remove()
    outcome = f", {len(reasons)} of them failed." if reasons else "."
    click.echo(f"Wrote {plan.size} point{'' if plan.size == 1 else 's'} to {output}{outcome}")
    if reasons:
        sys.exit(EXIT_FAILED_POINTS)


def _open_journal(plan: Plan, output: Path) -> Journal:
    """The journal of `plan` beside `output`; says what is there from interrupted sweeps."""
    from epicyclic.sweeps.journal import Journal

    fingerprint = plan.fingerprint()
    journal = Journal(output.with_name(f"{output.name}.{fingerprint}.partial"), fingerprint)
    others = [
        path
        for path in output.parent.iterdir()
        if path.name.startswith(f"{output.name}.") and path.suffix == journal.path.suffix
        if path.name != journal.path.name
    ]
    for path in sorted(others):
        click.echo(
            f"{path} holds points of an interrupted sweep of another case or other values; it is "
            "kept. Delete it if you do not need it.",
            err=True,
        )
    kept = len(journal.read())
    if kept:
        click.echo(f"Going on from {kept} of {plan.size} points in {journal.path}.", err=True)
    return journal


@contextmanager
def _finishing(what: str) -> Iterator[None]:
    """Put off the first interruption until all is done: it would leave the file half written.

    Libraries that write files may also hang for ever when they are interrupted.
    """
    usual = signal.getsignal(signal.SIGINT)

    def put_off(*_: object) -> None:
        signal.signal(signal.SIGINT, usual)
        click.echo(f"{what} Interrupt again to stop.", err=True)

    signal.signal(signal.SIGINT, put_off)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, usual)


@contextmanager
def _kept_in(journal: Journal, size: int) -> Iterator[None]:
    """Say what is left of a sweep that does not reach its end."""
    try:
        yield
    except (KeyboardInterrupt, Exception):
        kept = len(journal.read())
        if kept:
            click.echo(
                f"{kept} of {size} points kept in {journal.path}; give the same command again to "
                "go on.",
                err=True,
            )
        raise


@cli.command()
def validate() -> None:
    """Compare with published figures: published, computed, difference, verdict."""
    from epicyclic.cli.progress import progress_bar
    from epicyclic.report.tables import terminal
    from epicyclic.report.validation_table import validation_table
    from epicyclic.validation.compare import compare_published

    with progress_bar("figures") as progress:
        rows = compare_published(progress)
    terminal().print(validation_table(rows))


def _load(case: str, changes: Sequence[str]) -> Any:
    from epicyclic.case.case import load_case

    loaded = load_case(case)
    return loaded.updated(_parse_changes(changes)) if changes else loaded


def _parse_changes(options: Sequence[str]) -> dict[str, Any]:
    from epicyclic.case.values import parse_value

    changes: dict[str, Any] = {}
    problems = []
    for option in options:
        key, equals, text = option.partition("=")
        if not equals or not key.strip():
            problems.append(
                Problem(
                    "--set", f'"{option}"', "must be KEY=VALUE.",
                    'For example --set "operation.torque=500 N*m".',
                )
            )  # fmt: skip
        else:
            changes[key.strip()] = parse_value(text.strip()) if text.strip() else None
    if problems:
        raise InputError(problems, "the command")
    return changes


def _check_picture(option: str, path: Path, formats: Sequence[str] = PICTURES) -> None:
    if path.suffix not in formats:
        allowed = f"must end in {', '.join(formats)}."
        problem = Problem(option, str(path), allowed, "Choose one of these formats.")
        raise InputError([problem], "the command")


def _draw(figure: Figure, path: Path) -> None:
    _write(path, _picture(figure, path))
    click.echo(f"Wrote {path}.")


def _picture(figure: Figure, path: Path) -> bytes:
    """What a file of the type of `path` holds of a figure."""
    picture = io.BytesIO()
    figure.savefig(picture, format=path.suffix[1:])
    return picture.getvalue()


def _write(path: Path, content: str | bytes) -> None:
    """Write `content` to a file whole or not at all, or to a device or pipe as it is."""
    data = content.encode() if isinstance(content, str) else content
    target = path.resolve()
    temporary = target.with_name(f".{target.name}.tmp")
    try:
        if target.exists() and not target.is_file():
            target.write_bytes(data)  # must not be replaced by a file
            return
        temporary.write_bytes(data)
        temporary.replace(target)
    except OSError as error:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        allowed = f"cannot be written: {error.strerror}."
        problem = Problem("FILE", str(path), allowed, "Name another file.")
        raise InputError([problem], "the command") from None


def _print_failures(reasons: Sequence[str]) -> None:
    """Each reason once, with the number of points that failed for it."""
    counts = Counter(reasons)
    for reason, count in list(counts.items())[:SHOWN_FAILURES]:
        click.echo(f"{count} failed: {reason}", err=True)
    if len(counts) > SHOWN_FAILURES:
        click.echo(f"... and {len(counts) - SHOWN_FAILURES} other reasons.", err=True)


def main() -> None:
    """Entry point: errors become messages and exit codes, never tracebacks."""
    try:
        cli.main(standalone_mode=False)
    except click.ClickException as error:
        error.show()
        sys.exit(EXIT_INPUT)
    except InputError as error:
        click.echo(str(error), err=True)
        sys.exit(EXIT_INPUT)
    except ConvergenceError as error:
        click.echo(f"No solution: {error}", err=True)
        sys.exit(EXIT_NO_SOLUTION)
    except BrokenPipeError:  # the reader of a pipe has seen enough
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123
        sys.exit(EXIT_BROKEN_PIPE)
    except (KeyboardInterrupt, click.Abort):
        _end_interrupted()
    except Exception as error:
        if is_interrupt(error):
            _end_interrupted()
        if os.environ.get("EPICYCLIC_TRACEBACK") == "1":
            raise
        click.echo(
            f"Error of the program: {type(error).__name__}: {error}\n"
            "Set EPICYCLIC_TRACEBACK=1 to see where it arose.",
            err=True,
        )
        sys.exit(EXIT_ERROR)


def _end_interrupted() -> NoReturn:
    click.echo("Interrupted.", err=True)
    sys.exit(EXIT_INTERRUPTED)
