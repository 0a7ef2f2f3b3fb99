"""Results to REXS files: into a file that is there, or into a new one."""

from __future__ import annotations

from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

from epicyclic.case.case import load_case
from epicyclic.case.wording import one_line
from epicyclic.errors import InputError
from epicyclic.exchange.rexs.content import build_model
from epicyclic.exchange.rexs.file import Document, new_document, read_document
from epicyclic.exchange.rexs.new_file import case_parts
from epicyclic.exchange.rexs.results import check_match, write_results
from epicyclic.exchange.rexs.sets import choose
from epicyclic.exchange.rexs.vocabulary import versions
from epicyclic.results.result import Result
from epicyclic.sweeps.dataset import whole_file

__all__ = ["rexs_bytes", "write_rexs"]


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
        The file that the gear set came from. All that it holds stays as it is; results are added.
        Without it, a new file of version 2.0.0 describes the gear set of the result.
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
        chosen = choose(model, component)
        check_match(chosen, result)
    except InputError as error:
        raise InputError(error.problems, one_line(str(original), 500)) from None
    write_results(document.content, model, chosen, result)
    return document.to_bytes()


def _described(path: str | Path, result: Result) -> Document:
    """A new file with the gear set of a result."""
    head = {
        "version": versions()[-1],
        "applicationId": "Epicyclic",
        "applicationVersion": version("epicyclic"),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
    }
    document = new_document(path, head)
    for part in case_parts(load_case(result.inputs)):
        document.content.add(part)
    return document
