"""Read a case from whatever holds one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from epicyclic.case.case import Case, read_case
from epicyclic.plugins.rexs.files import is_rexs


def load_case(
    source: str | Path | Mapping[str, Any], changes: Mapping[str, Any] | None = None
) -> Case:
    """Read and check a case.

    Parameters
    ----------
    source : str, Path or mapping
        A TOML file, a REXS file (``.rexs``, ``.rexsj``, ``.rexsz``), the name of a built-in case
        (``"talbot-2012"``, ``"talbot-2012-n6-40C"``), or the tables of a case.
    changes : mapping of str to object, optional
        Keys to change, as in `PlanetaryCase.updated`; with a REXS file, those that it lacks too.

    Returns
    -------
    PlanetaryCase or GearPairCase

    Raises
    ------
    InputError
        With every problem found, not only the first.
    """
    if isinstance(source, str | Path) and is_rexs(source):
        from epicyclic.plugins.rexs.importing import read_rexs

        return read_rexs(source).case(changes)
    case = read_case(source)
    return case.updated(changes) if changes else case
