"""Results to REXS files: into a file that is there, or into a new one."""

from __future__ import annotations

from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

from epicyclic.case.case import read_case
from epicyclic.case.train import TrainCase
from epicyclic.case.wording import one_line
from epicyclic.errors import InputError, Problem
from epicyclic.exchange.rexs.content import build_model
from epicyclic.exchange.rexs.file import Document, new_document, read_document
from epicyclic.exchange.rexs.model import Model
from epicyclic.exchange.rexs.new_file import case_parts
from epicyclic.exchange.rexs.new_train import train_parts
from epicyclic.exchange.rexs.results import check_match, write_results
from epicyclic.exchange.rexs.sets import Pair, PlanetarySet, choose
from epicyclic.exchange.rexs.trains import Train, chosen_train
from epicyclic.exchange.rexs.vocabulary import versions
from epicyclic.results.result import Result
from epicyclic.whole_file import whole_file


def write_rexs(
    path: str | Path,
    result: Result,
    original: str | Path | None = None,
    component: int | None = None,
) -> None:
    """Write results to a REXS file, whole or not at all.

    Parameters
    ----------
    path : str or Path
        The file to write, ``.rexs``, ``.rexsj`` or ``.rexsz``. With an `original` it has the form
        of that file.
    result : Result
        From `solve`.
    original : str or Path, optional
        The file that the gear set or train came from. All that it holds stays as it is; results
        are added. Without it, a new file of version 2.0.0 describes the gears of the result.
    component : int, optional
        Id of the stage in the original, if it has several.

    Raises
    ------
    InputError
        If the original cannot be read, or holds another gear set.
    """
    data = rexs_bytes(path, result, original, component)
    with whole_file(Path(path)) as temporary:
        temporary.write_bytes(data)


def rexs_bytes(
    path: str | Path, result: Result, original: str | Path | None, component: int | None
) -> bytes:
    """What `write_rexs` writes."""
    if original is None:
        document = _described(path, result)
    else:
        document = read_document(Path(original), with_others=True)
    try:
        model = build_model(document.content)
        chosen = _chosen(model, result, component)
        check_match(chosen, result)
    except InputError as error:
        raise InputError(error.problems, one_line(str(original), 500)) from None
    write_results(document.content, model, chosen, result)
    return document.to_bytes()


def _chosen(model: Model, result: Result, component: int | None) -> PlanetarySet | Pair | Train:
    """What a result belongs to in a file."""
    if result.train is None:
        return choose(model, component)
    train = chosen_train(model) if component is None else None
    if train is None:
        allowed = "the result is of a train, and the file has one stage."
        if component is not None:
            allowed = "names one stage, and the result is of a train."
        shown = "" if component is None else str(component)
        remedy = "Write it into the file of all its stages."
        raise InputError([Problem("--component", shown, allowed, remedy)])
    return train


def _described(path: str | Path, result: Result) -> Document:
    """A new file with the gear set of a result."""
    head = {
        "version": versions()[-1],
        "applicationId": "Epicyclic",
        "applicationVersion": version("epicyclic"),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
    }
    document = new_document(path, head)
    case = read_case(result.inputs)
    for part in train_parts(case) if isinstance(case, TrainCase) else case_parts(case):
        document.content.add(part)
    return document
