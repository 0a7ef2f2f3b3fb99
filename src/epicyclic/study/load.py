"""Read a case from whatever holds one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Protocol, cast

from epicyclic.case.case import Case, read_case
from epicyclic.registry import load, offered


class ForeignCase(Protocol):
    """A case in a file of another form than TOML, as a plug-in reads it."""

    @property
    def tables(self) -> Mapping[str, Any]:
        """The tables of the case, as far as the file gives them."""

    def case(self, changes: Mapping[str, Any] | None = None) -> Case:
        """The case, with some keys set."""

    def remarks(self, changes: Mapping[str, Any], case: Case) -> list[str]:
        """What the file lacks for `case`, which was made with `changes`, and where it differs."""


CaseReader = Callable[[str | Path], ForeignCase]
Readable = str | Path | Mapping[str, Any]
CaseSource = Case | Readable
"""A case, or what `load_case` reads."""


def reader_of(path: str | Path) -> CaseReader | None:
    """What reads a file of another form than TOML, by the ending of its name."""
    name = str(path).lower()
    endings = [ending for ending in offered("case_readers") if name.endswith(ending)]
    return cast("CaseReader", load("case_readers", endings[0])) if endings else None


def load_case(source: Readable, changes: Mapping[str, Any] | None = None) -> Case:
    """Read and check a case.

    Parameters
    ----------
    source : str, Path or mapping
        A TOML file, a REXS file (``.rexs``, ``.rexsj``, ``.rexsz``), the name of a built-in case
        (``"talbot-2012"``, ``"talbot-2012-n6-40C"``), or the tables of a case.
    changes : mapping of str to object, optional
        Keys to change, as in `PlanetaryCase.updated`; also keys missing in a REXS file.

    Raises
    ------
    InputError
        With all problems found.
    """
    if isinstance(source, str | Path) and (reader := reader_of(source)) is not None:
        return reader(source).case(changes)
    return read_case(source, changes)


def as_case(source: CaseSource) -> Case:
    """The case that a function was given, or that `load_case` reads there."""
    return source if isinstance(source, Case) else load_case(source)
