"""Read-only tools for agents: each answers in the words of a command, with the numbers beside."""

from __future__ import annotations

import io
import json
import math
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from functools import wraps
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any

from anyio import from_thread
from mcp.server.mcpserver import MCPServer
from mcp_types import CallToolResult, TextContent, ToolAnnotations
from pydantic import Field

from epicyclic.cli.common import echo, load_with, print_tables
from epicyclic.errors import ConvergenceError, InputError, Problem, one_problem, raise_any
from epicyclic.messages import did_you_mean, key_parts, one_line, written
from epicyclic.registry import offered

MOST_POINTS = 400  # Of a map.
MOST_SAMPLES = 1024
MOST_CHANGES = 200
LONGEST = 60_000  # Characters of an answer.
LONGEST_ARGUMENT = 2_000  # Characters.
CASES = ("case", "first", "second")
"""Arguments that name cases."""
INSTRUCTIONS = """\
Power losses of gears, planetary sets and gearboxes. A case is a path to a TOML or REXS file, or the
name of a built-in case: talbot-2012 (planetary), talbot-2012-pair, train-8hp70, train-eaxle.
Changes are KEY=VALUE with a unit, as in "operation.torque=500 N*m". Check first, then run. Read
the status, the band and the warnings before you quote a number: the band is that of 95 %. A
refusal lists every problem with what to change. Nothing is written."""
SHOWN = (
    "title", "kind", "status", "total", "load_dependent", "load_independent", "input_power",
    "efficiency", "losses", "units", "factors", "not_included", "warnings", "validity", "band",
    "advice", "models", "versions",
)  # fmt: skip
"""What an answer of `run` has of the JSON of the command."""

Case = Annotated[str, Field(description="TOML or REXS file, or the name of a built-in case.")]
Changes = Annotated[
    Sequence[str], Field(description='Changed keys, as in ["operation.torque=500 N*m"].')
]
Values = Annotated[str, Field(description='"a,b,c unit" or "start:stop:count unit".')]
_one_at_a_time = threading.Lock()


def server() -> MCPServer[Any]:
    """The server with its tools."""
    made = MCPServer(
        "epicyclic", instructions=INSTRUCTIONS, version=version("epicyclic"), log_level="ERROR"
    )
    reading = ToolAnnotations(
        read_only_hint=True, destructive_hint=False, idempotent_hint=True, open_world_hint=False
    )
    for tool in (check, run, loss_map, uncertainty, compare_cases, explain_key):
        name = {"loss_map": "map"}.get(tool.__name__, tool.__name__.replace("_", "-"))
        made.add_tool(_answering(tool), name, annotations=reading, structured_output=False)
    return made


def _answering(tool: Callable[..., dict[str, Any] | None]) -> Callable[..., CallToolResult]:
    """A tool whose answer is what it prints, and the numbers that it returns."""

    @wraps(tool)
    def call(**arguments: Any) -> CallToolResult:
        numbers: dict[str, Any] | None = None
        failed = True
        with _printed() as text:
            try:
                _check(arguments)
                numbers = tool(**arguments)
                failed = False
            except InputError as error:
                echo(str(error))
                parts = ("key", "value", "allowed", "remedy")
                found = [{part: getattr(it, part) for part in parts} for it in error.problems]
                numbers = {"problems": found[:MOST_CHANGES]}
            except ConvergenceError as error:
                echo(f"No solution: {error}")
            except OSError as error:
                echo(f"The system refused access: {error.strerror or error}.")
            except Exception as error:  # the server goes on
                echo(f"Internal error: {type(error).__name__}: {error}")
        answer = text.getvalue()
        if len(answer) > LONGEST:
            answer = f"{answer[:LONGEST]}\n... {len(answer) - LONGEST} more characters."
        content = [TextContent(type="text", text=answer)]
        return CallToolResult(content=content, structured_content=numbers, is_error=failed)

    call.__annotations__ = tool.__annotations__ | {"return": CallToolResult}
    return call


@contextmanager
def _printed() -> Iterator[io.StringIO]:
    """What is printed to both streams, of one call at a time."""
    text = io.StringIO()
    with _one_at_a_time, redirect_stdout(text), redirect_stderr(text):
        yield text


def _check(arguments: dict[str, Any]) -> None:
    """Raise `InputError` for what is longer than any case needs, and for files that are no cases.

    Messages quote lines of a file. Of others than cases an agent is not told any, wherever a link
    leads.
    """
    endings = (".toml", *offered("case_readers"))
    problems = []
    for name, value in arguments.items():
        if name in CASES and _leads_elsewhere(value, endings):
            allowed = f"must lead to a file {', '.join(endings)}."
            remedy = "Name a case file, or a built-in case."
            problems.append(Problem(name, one_line(value), allowed, remedy))
        texts = value if isinstance(value, list) else [value]
        if len(texts) > MOST_CHANGES:
            allowed = f"must be at most {MOST_CHANGES}."
            problems.append(Problem(name, f"{len(texts)} entries", allowed, "Write a case file."))
        if any(isinstance(text, str) and len(text) > LONGEST_ARGUMENT for text in texts):
            allowed = f"must have at most {LONGEST_ARGUMENT} characters."
            problems.append(Problem(name, one_line(str(texts[0])), allowed, "Write a case file."))
    raise_any(problems, "the call")


def _leads_elsewhere(path: str, endings: tuple[str, ...]) -> bool:
    """True for a file, or a link to one, whose name has none of the endings."""
    try:
        found = Path(path).resolve()
        return found.is_file() and not found.name.lower().endswith(endings)
    except (OSError, RuntimeError, ValueError):  # the reader says what is wrong with it
        return False


def check(case: Case, changes: Changes = ()) -> None:
    """Check a case without computing losses: what is wrong or doubtful, and its data sheet."""
    from epicyclic.cli.case import check as command

    assert command.callback is not None
    command.callback(case, tuple(changes))


def run(case: Case, changes: Changes = (), details: bool = False) -> dict[str, Any]:
    """Losses, efficiency and 95 % band of a case; with details all figures, warnings, sources."""
    from epicyclic.show.details import result_tables
    from epicyclic.show.result_tables import remarks
    from epicyclic.show.summary import first_screen
    from epicyclic.show.uncertainty_tables import band_texts, result_json
    from epicyclic.study.bands.study import quick_known
    from epicyclic.study.solve import solve

    loaded = load_with(case, changes)
    result = solve(loaded)
    known = quick_known(loaded, result)
    print_tables(
        result_tables(result, tuple(remarks(loaded, result)), band_texts(known))
        if details
        else first_screen(result, known)
    )
    content = json.loads(result_json(result, known))
    return {key: content[key] for key in SHOWN if key in content}


def loss_map(
    case: Case,
    speed: Values,
    torque: Values,
    temperature: Values | None = None,
    states: Sequence[str] | None = None,
    changes: Changes = (),
) -> None:
    """Losses and efficiency over speed, torque and oil temperature of at most 400 points, as CSV.

    Of a train by state; without states of all. Missing numbers belong to points without a solution,
    whose reason is in the column message.
    """
    from epicyclic.cli.many import check_values, parse_axes
    from epicyclic.study.maps.compute import map_plan, to_map
    from epicyclic.study.sweeps.runner import Runner

    values = {"speed": speed, "torque": torque, "temperature": temperature}
    loaded = load_with(case, changes)
    check_values(values)
    given = parse_axes(loaded, values)
    plan = map_plan(
        loaded, given["speed"], given["torque"], given.get("temperature"), states=states
    )
    if plan.size > MOST_POINTS:
        remedy = "Give fewer values, or run the command 'epicyclic map', which writes a file."
        raise one_problem("map", f"{plan.size} points", f"has more than {MOST_POINTS}.", remedy)
    data = to_map(plan, Runner(progress=_go_on).run(plan))
    shown = [
        name for name in ("torque_loss", "total", "efficiency", "status", "message") if name in data
    ]
    units = {str(name): f"{name} [{it.attrs['units']}]" for name, it in data.variables.items()
             if it.attrs.get("units")}  # fmt: skip
    echo(data[shown].to_dataframe()[shown].reset_index().rename(columns=units).to_csv(index=False))


def uncertainty(
    case: Case, changes: Changes = (), samples: int = 256, seed: int = 1
) -> dict[str, Any]:
    """95 % bands of losses and efficiency from samples, and what causes them."""
    from epicyclic.show.uncertainty_tables import uncertainty_tables
    from epicyclic.study.bands.points import uncertainty as compute

    _check_samples(samples)
    data = compute(load_with(case, changes), samples=samples, seed=seed, progress=_go_on)
    print_tables(uncertainty_tables(data))
    return _numbers(data, ("nominal", "low", "high", "standard_uncertainty"))


def compare_cases(first: Case, second: Case, samples: int = 256, seed: int = 1) -> dict[str, Any]:
    """Whether the second case loses less than the first, and with what confidence."""
    from epicyclic.show.uncertainty_tables import pair_tables
    from epicyclic.study.bands.compare_cases import compare_cases as compute

    _check_samples(samples)
    cases = [load_with(name, ()) for name in (first, second)]
    data = compute(cases[0], cases[1], samples=samples, seed=seed, progress=_go_on)
    print_tables(pair_tables(data))
    return _numbers(data, ("first", "second", "difference", "low", "high", "probability"))


def _go_on(*_: int) -> None:
    """Raise what ends a call that the agent has cancelled."""
    from_thread.check_cancelled()


def _check_samples(samples: int) -> None:
    if samples > MOST_SAMPLES:
        allowed = f"must be at most {MOST_SAMPLES}."
        raise one_problem("samples", str(samples), allowed, "Give fewer, a power of 2.", "the call")


def _numbers(data: Any, names: Sequence[str]) -> dict[str, Any]:
    """Some variables of a study by result; what is not finite is missing."""
    return {
        str(result): {
            name: value
            for name in names
            if name in data and math.isfinite(value := float(data[name].sel(result=result)))
        }
        for result in data["result"].values
    }


def explain_key(
    key: Annotated[
        str, Field(description="Key of a case file, as operation.torque, or its start.")
    ],
    kind: Annotated[str, Field(description="planetary, gear_pair or train.")] = "planetary",
) -> dict[str, Any]:
    """What a key of a case file means: unit, range or choices, default; of a table its keys."""
    from epicyclic.case.case import KINDS
    from epicyclic.schema.fields import all_keys, describe, locate, quantity_of, table_of

    if kind not in KINDS:
        allowed = f"must be {' or '.join(KINDS)}."
        remedy = did_you_mean(kind, tuple(KINDS))
        raise one_problem("kind", written(kind), allowed, remedy, "the call")
    known = all_keys(KINDS[kind])
    parts = key_parts(key)
    place = locate(KINDS[kind], parts)
    if place.annotation is None or not parts:
        remedy = (
            did_you_mean(key, known)
            or f"Tables of this kind: {', '.join(sorted({it.partition('.')[0] for it in known}))}."
        )
        raise one_problem(key, "", f"is no key of a {kind} case.", remedy, "the call")
    field = None if place.owner is None else place.owner.model_fields.get(str(place.path[-1]))
    inner = table_of(place.annotation)
    found: dict[str, Any] = {"key": key, "allowed": describe(place.annotation, place.metadata)}
    quantity = quantity_of(place.annotation, place.metadata)
    if quantity is not None:
        found["unit"] = quantity.display
    if field is not None:
        found["meaning"] = field.description or ""
        found["required"] = field.is_required()
        if not field.is_required() and isinstance(field.default, str | int | float):
            found["default"] = field.default
    if inner is not None:
        found["keys"] = list(all_keys(inner))
    for name, value in found.items():
        echo(f"{name}: {', '.join(value) if isinstance(value, list) else value}")
    return found
