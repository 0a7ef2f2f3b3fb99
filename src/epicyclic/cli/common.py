"""What commands share: options, output, progress, exit codes."""

from __future__ import annotations

import math
import os
import re
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from datetime import timedelta
from functools import wraps
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from rich.console import Console

from epicyclic.errors import Problem, one_problem, printable_lines, raise_any
from epicyclic.files import write_file
from epicyclic.kernels import listeners
from epicyclic.messages import one_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import RenderableType

    from epicyclic.case.case import Case
    from epicyclic.study.load import ForeignCase


# Progress on standard error: a bar on a terminal, a line now and then in a file or pipe.
#
# ``EPICYCLIC_PROGRESS=0`` turns both off.


EVERY = 15.0  # Between two lines, and before the first one. [s]
COMPILING_EVERY = 5.0  # The same while kernels are compiled. [s]
COMPILED = 110  # Kernels that a result needs, at most: simple cases need half as many.
Update = Callable[..., None]
LONG_SECONDS = 2.0  # After which a command that tells nothing of itself says that it works.


def echo(text: str, err: bool = False) -> None:
    """Print lines, on standard error if so; what names in them would do to a terminal is shown."""
    click.echo(printable_lines(text), err=err)


def tell(text: str) -> None:
    """Say on standard error how a long command gets on; ``EPICYCLIC_PROGRESS=0`` turns it off."""
    if not _is_off():
        sys.stderr.write(f"{text}\n")


def _is_off() -> bool:
    return os.environ.get("EPICYCLIC_PROGRESS") == "0"


def progress_bar(noun: str) -> AbstractContextManager[Update]:
    """A callback ``(done, total, failed=0)`` that shows how far it is, with the time left."""
    console = Console(stderr=True)
    return _bar(noun, console) if console.is_terminal and not _is_off() else _lines(noun)


@contextmanager
def _bar(noun: str, console: Console) -> Iterator[Update]:
    from rich import progress

    bar = progress.Progress(
        progress.TextColumn(noun),
        progress.BarColumn(),
        progress.MofNCompleteColumn(),
        progress.TimeElapsedColumn(),
        progress.TextColumn("left"),
        progress.TimeRemainingColumn(),
        progress.TextColumn("{task.fields[failures]}"),
        console=console,
        transient=True,
    )
    with bar:
        task = bar.add_task(noun, total=None, failures="")

        def update(done: int, total: int, failed: int = 0) -> None:
            bar.update(task, completed=done, total=total, failures=_failures(failed))

        yield update


@contextmanager
def _lines(noun: str) -> Iterator[Update]:
    start = told = time.monotonic()
    first: tuple[float, int] | None = None  # of what is done; before it kernels are compiled

    def update(done: int, total: int, failed: int = 0) -> None:
        nonlocal told, first
        now = time.monotonic()
        if done and first is None:
            first = now, done
        if now - told < EVERY or _is_off():
            return
        told = now
        parts = [f"{noun}: {done} of {total} after {_seconds(now - start)}"]
        if first is not None and done > first[1]:
            left = (now - first[0]) * (total - done) / (done - first[1])
            parts.append(f"about {_seconds(left)} left")
        if failed:
            parts.append(_failures(failed))
        echo(", ".join(parts), err=True)

    yield update


def _failures(failed: int) -> str:
    return f"{failed} not converged" if failed else ""


def _seconds(duration: float) -> str:
    """``"0:01:05"``."""
    return str(timedelta(seconds=round(duration)))


def tell_compilation() -> None:
    """Say that kernels are compiled, and how far that is, should it take long."""
    first = told = 0.0
    count = 0

    def tell_of_kernel() -> None:
        nonlocal first, told, count
        now = time.monotonic()
        first, told, count = first or now, told or now, count + 1
        if now - told < COMPILING_EVERY or _is_off():
            return
        told = now
        echo(
            f"First run of this version: compiling the numerics, {count} of up to {COMPILED} "
            f"functions after {_seconds(now - first)}.",
            err=True,
        )

    listeners.append(tell_of_kernel)


@contextmanager
def working() -> Iterator[None]:
    """A bar without an end, and the time, for what takes long and tells nothing of itself."""
    console = Console(stderr=True)
    if not console.is_terminal or _is_off():
        yield
        return
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("solving"), BarColumn(), TimeElapsedColumn())
    bar = Progress(*columns, console=console, transient=True)
    bar.add_task("solving", total=None)
    begin = threading.Timer(LONG_SECONDS, bar.start)
    begin.daemon = True
    begin.start()
    try:
        yield
    finally:
        begin.cancel()
        begin.join()
        bar.stop()


# What commands show, and the pictures and pages that they write.


PICTURES = (".png", ".svg", ".pdf")
MOST_KEYS = 1000
"""For which the braces of one key may stand."""
PAGE, PRINT = ".html", ".pdf"
SIZES = (30, 2000)  # Smallest and largest size of a picture. [mm]
MILLIMETRES = {"mm": 1.0, "cm": 10.0, "in": 25.4}


def check_ending(option: str, path: Path, endings: Sequence[str]) -> None:
    """Raise `InputError` for a file that ends otherwise."""
    raise_any(wrong_ending(option, path, endings), "the command")


def wrong_ending(option: str, path: Path, endings: Sequence[str]) -> list[Problem]:
    """The problem of a file that ends otherwise."""
    if path.suffix in endings:
        return []
    return [Problem(option, str(path), f"must end in {' or '.join(endings)}.", "Name such a file.")]


def beside(path: Path, part: str) -> Path:
    """The file beside `path` for one part of what it is to hold."""
    return path.with_name(f"{path.stem}-{part}{path.suffix}")


def show(
    tables: Callable[[], RenderableType], as_json: Callable[[], str], json_file: str | None
) -> None:
    """Print tables, or JSON in their place if `json_file` is -; else write that file first."""
    if json_file == "-":
        click.echo(as_json())
        return
    if json_file is not None:
        write_file(Path(json_file), as_json() + "\n")
        echo(f"Wrote {json_file}.")
    print_tables(tables())


def print_tables(*parts: RenderableType, end: str = "\n") -> None:
    """Print tables and sentences of results."""
    from epicyclic.show.terminal import terminal

    terminal().print(*parts, end=end)


def tell_given(case: Case, doing: str, err: bool = False) -> bool:
    """Name the sets of which only the efficiency is given; True if no other is left."""
    given = [name for name, gearing in case.gearings.items() if not gearing.computed]
    if given:
        names = ", ".join(given)
        echo(f"Sets with a given efficiency, without teeth to {doing}: {names}.", err)
    return len(given) == len(case.gearings)


def parse_size(text: str) -> tuple[float, float]:
    """Width and height of a picture, ``"160x90 mm"``. [mm]"""
    low, high = SIZES
    match = re.fullmatch(r"\s*([\d.]+)\s*[x×*]\s*([\d.]+)\s*(mm|cm|in)\s*", text)
    if match:
        with suppress(ValueError):  # "1.2.3"
            scale = MILLIMETRES[match[3]]
            width, height = float(match[1]) * scale, float(match[2]) * scale
            if low <= min(width, height) and max(width, height) <= high:
                return width, height
    allowed = f"must be a width and a height of {low} to {high} mm, in mm, cm or in."
    raise one_problem("--size", f'"{text}"', allowed, 'For example "160x90 mm".', "the command")


def draw(figure: Figure, path: Path, caption: str = "") -> None:
    """Write a picture, with its operating point below if it has none yet."""
    from epicyclic.show.plots.style import caption_below, figure_bytes

    if caption:
        caption_below(figure, caption)
    write_file(path, figure_bytes(figure, path.suffix[1:]))
    echo(f"Wrote {path}.")


def check_page(path: Path) -> None:
    """Raise `InputError` if a page cannot be written to a file of this name."""
    check_ending("-o", path, (PAGE, PRINT))
    if path.suffix == PRINT:
        from epicyclic.show.html import check_pdf

        check_pdf()


def write_page(path: Path, page: str) -> None:
    """Write a page as it is, or printed to a PDF."""
    from epicyclic.show.html import page_bytes

    write_file(path, page_bytes(page, path.suffix))
    echo(f"Wrote {path}.")


# Options that commands share, above all a case and changes of its keys.


def file_option(
    *names: str, metavar: str | None = "FILE", endings: Sequence[str] = (), **options: Any
) -> Callable[[Any], Any]:
    """An option that names a file, which must end so if there are `endings`."""

    def checked(context: click.Context, option: click.Parameter, path: Path | None) -> Path | None:
        if path is not None and endings:
            check_ending(names[0], path, endings)
        return path

    kind = click.Path(path_type=Path)
    return click.option(*names, metavar=metavar, type=kind, callback=checked, **options)


case_argument = click.argument("case", metavar="CASE")
json_option = click.option(
    "--json",
    "json_file",
    metavar="[FILE]",
    is_flag=False,
    flag_value="-",
    help="Write the result as JSON, to standard output if no FILE or - is given.",
)
temperature_option = click.option(
    "--temperature",
    metavar="VALUES",
    help='Oil inlet temperatures, as in "40,60,90 degC"; default: that of the case.',
)


def runner_options(command: Callable[..., None]) -> Callable[..., None]:
    """Where points are computed: --jobs and --dask, of which the command gets a `runner`."""

    @click.option(
        "--jobs",
        type=click.IntRange(1, 10_000),
        help="Worker processes; default: chosen automatically.",
    )
    @click.option("--dask", metavar="ADDRESS", help="Scheduler of a Dask cluster, tcp://host:8786.")
    @wraps(command)
    def call(
        *args: Any, jobs: int | None, dask: str | None, shard: str | None = None, **options: Any
    ) -> None:
        from epicyclic.study.sweeps.runner import Runner, parse_shard

        runner = Runner(jobs, dask, parse_shard(shard))
        runner.check()
        command(*args, runner=runner, **options)

    return call


journal_option = file_option(
    "--journal",
    metavar="DIR",
    help="File or folder for finished points, from which the same command continues after an "
    "interruption.",
)
shard_option = click.option(
    "--shard", metavar="I/N", help="Compute share I of N; 'epicyclic merge' combines all shares."
)
"""To stand above `runner_options`."""


def table_options(command: Callable[..., None]) -> Callable[..., None]:
    """How a table is to be read, where it does not say so itself: the command gets a `form`."""

    @click.option(
        "--column",
        "columns",
        metavar="NAME=HEADER",
        multiple=True,
        help='Which column of the table is which, as in --column "speed [rpm]=nMot"; repeatable.',
    )
    @click.option("--sheet", metavar="NAME", default="", help="Sheet of an Excel workbook.")
    @click.option("--rows", metavar="FIRST-LAST", help="Read only these lines of the table.")
    @click.option(
        "--decimal",
        type=click.Choice(["point", "comma"]),
        help="Decimal mark, where the numbers of the table leave it open.",
    )
    @wraps(command)
    def call(
        *args: Any,
        columns: tuple[str, ...],
        sheet: str,
        rows: str | None,
        decimal: str,
        **rest: Any,
    ) -> None:
        from epicyclic.study.table_file import parse_form

        command(*args, form=parse_form(columns, sheet, rows, decimal or ""), **rest)

    return call


def set_option_for(what: str, example: str) -> Callable[[Any], Any]:
    """The option --set for the keys of `what`."""
    return click.option(
        "--set",
        "changes",
        metavar="KEY=VALUE",
        multiple=True,
        help=f'Change a key of {what}, as in --set "{example}". An empty value removes the key; '
        "{sun,ring}.teeth stands for two keys.",
    )


set_option = set_option_for("the case", "operation.torque=500 N*m")
contact_set_option = set_option_for("the contact", "lubricant.eyring_stress=8 MPa")


def case_options(command: Callable[..., None]) -> Any:
    """A CASE with its option --set: the command gets a `case` and its `changes`."""
    return case_argument(set_option(command))


def plot_option(text: str, endings: Sequence[str] = PICTURES) -> Callable[[Any], Any]:
    """The option --plot, with its help."""
    return file_option("--plot", endings=endings, help=text)


def output_option(
    text: str, metavar: str | None = None, required: bool = False, endings: Sequence[str] = ()
) -> Callable[[Any], Any]:
    """The option -o, with its help."""
    names = ("-o", "--output")
    return file_option(*names, required=required, metavar=metavar, endings=endings, help=text)


picture_option = click.option(
    "--picture", type=click.Choice([ending[1:] for ending in PICTURES]), default="png"
)


def point_of(case: Any) -> str:
    """The operating point of a case, for the captions of its pictures."""
    from epicyclic.study.operating import operating_line

    return operating_line(case.inputs()["operation"])


def load_with(case: str, changes: Sequence[str]) -> Case:
    from epicyclic.study.load import load_case, reader_of

    parsed = parse_changes(changes)
    reader = reader_of(case)
    return load_case(case, parsed) if reader is None else case_with_remarks(reader(case), parsed)


def case_with_remarks(found: ForeignCase, changes: dict[str, Any]) -> Case:
    """The case in a file of another form; standard error shows what the file lacks."""
    loaded = found.case(changes)
    for remark in found.remarks(changes, loaded):
        echo(remark, err=True)
    return loaded


def parse_changes(options: Sequence[str]) -> dict[str, Any]:
    from epicyclic.schema.read import parse_value

    changes: dict[str, Any] = {}
    problems = []
    for option in options:
        key, equals, text = option.partition("=")
        if not equals or not key.strip():
            remedy = 'For example --set "operation.torque=500 N*m".'
            problems.append(Problem("--set", f'"{option}"', "must be KEY=VALUE.", remedy))
        else:
            value = parse_value(text.strip()) if text.strip() else None
            changes |= dict.fromkeys(_alternatives(key.strip()), value)
    raise_any(problems, "the command")
    return changes


def _alternatives(key: str) -> list[str]:
    """The keys that braces stand for: ``{sun,ring}.teeth``."""
    choices = [
        [name.strip() for name in part.split(",")] if place % 2 else [part]
        for place, part in enumerate(re.split(r"\{([^{}]*)\}", key))
    ]
    if math.prod(map(len, choices)) > MOST_KEYS:
        allowed = f"stands for more than {MOST_KEYS} keys."
        shown, remedy = f'"{one_line(key)}"', "Give fewer names in braces."
        raise one_problem("--set", shown, allowed, remedy, "the command")
    return ["".join(chosen) for chosen in product(*choices)]
