"""Options that commands share: a case, and changes of its keys."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click

from epicyclic.errors import InputError, Problem

__all__ = ["case_argument", "load_with", "parse_changes", "set_option"]

case_argument = click.argument("case", metavar="CASE")
set_option = click.option(
    "--set",
    "changes",
    metavar="KEY=VALUE",
    multiple=True,
    help='Change a key of the case, as in --set "operation.torque=500 N*m". An empty value '
    "removes the key.",
)


def load_with(case: str, changes: Sequence[str]) -> Any:
    from epicyclic.exchange.load import load_case

    return load_case(case, parse_changes(changes))


def parse_changes(options: Sequence[str]) -> dict[str, Any]:
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
