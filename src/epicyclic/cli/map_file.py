"""A stored map written in another format."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import click

from epicyclic.errors import InputError, Problem


def refuse_options(options: Mapping[str, object]) -> None:
    """Raise `InputError` for options that say what is computed: a stored map holds it."""
    problems = [
        Problem(
            f"--{name}",
            "",
            "says what is computed, and a stored map is computed already.",
            "Leave it out, or give the case in place of the file.",
        )
        for name, value in options.items()
        if value
    ]
    if problems:
        raise InputError(problems, "the command")


def convert(file: Path, output: Path, name: str | None, *, heated: bool) -> None:
    """Write the map of `file` to `output`, with the temperature as a state if it is `heated`."""
    from epicyclic.maps.formats import write_map
    from epicyclic.maps.lumped import with_temperature_state
    from epicyclic.maps.tables import map_case
    from epicyclic.records.files import open_map

    data = open_map(file)
    if heated:
        case = map_case(data)
        if case is None:
            allowed = "cannot be given: the case of the map is none of this version."
            problem = Problem("--temperature-state", "", allowed, "Compute the map again.")
            raise InputError([problem], str(file))
        data = with_temperature_state(data, case)
    write_map(data, output, name)
    click.echo(f"Wrote the map of {file} to {output}.")
