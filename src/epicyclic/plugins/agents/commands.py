"""The commands mcp and skill."""

from __future__ import annotations

import os
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path

import click

from epicyclic.cli.common import echo
from epicyclic.errors import one_problem
from epicyclic.files import make_folder, write_file

NAME = "epicyclic"
"""Folder of the skill, which is the name in its head, too."""


@click.command()
def mcp() -> None:
    """Serve read-only tools to an agent over standard input and output (MCP).

    The tools check, run, map, uncertainty, compare-cases and explain-key answer as the commands do.
    They read the cases that they are asked for and write nothing.
    """
    if find_spec("mcp") is None:
        remedy = "Install it: pip install 'epicyclic[mcp]'."
        raise one_problem("mcp", "", "needs the package mcp.", remedy, "the command")
    from epicyclic.plugins.agents.tools import server
    from epicyclic.plugins.agents.wire import bounded_wire

    os.environ["EPICYCLIC_PROGRESS"] = "0"  # answers hold results, not how far they are
    with bounded_wire():
        server().run("stdio")


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
def skill(folder: Path) -> None:
    """Install the skill for agents into FOLDER: FOLDER/epicyclic/SKILL.md.

    It says when to use which command, how to state units, how to read outcomes, status and bands,
    and what to avoid. Calling the command again brings it up to date.
    """
    place = folder / NAME
    make_folder(place, "FOLDER")
    for source in sorted(files(__package__).joinpath("skill").iterdir(), key=lambda it: it.name):
        path = place / source.name
        write_file(path, source.read_bytes())
        echo(f"Wrote {path}.")
