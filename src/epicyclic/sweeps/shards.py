"""Shards put together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any, Protocol

from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.sweeps.journal import NOT_COMPUTED, Journal, Rows, read_heading
from epicyclic.sweeps.runner import Plan, fingerprint, share_of


class PlanKind(Protocol):
    """A class of plans."""

    def again(self, content: Mapping[str, Any], source: str) -> Plan:
        """The plan that `Plan.describe` described."""


def gather(
    files: Sequence[Path],  # Journals of all shards.
    kinds: Mapping[str, PlanKind],  # Classes of plans by `Plan.kind`.
) -> tuple[Plan, Rows, dict[str, Any]]:
    """The plan of which `files` hold shards, all its points, and how they are to be written.

    Raises
    ------
    InputError
        If a file is no journal, the files are of several plans, or points are missing.
    """
    (first, *_) = files
    mark, content = read_heading(first)
    plan, output = _plan_of(first, mark, content, kinds)
    rows = Rows(plan.size)
    shares = {}
    for file in files:
        own, said = read_heading(file)
        if own != mark:
            allowed = f"holds points of another study than {first}: another case or other values."
            raise _error(file, allowed, "Name the files of one study.")
        for point, row in Journal(file, mark).points():
            if rows.status[point] == NOT_COMPUTED:
                rows.add(point, row)
        shares[file] = share_of(plan, said["shard"])
    _check_whole(rows, shares)
    return plan, rows, output


def _plan_of(
    file: Path, mark: str, content: Mapping[str, Any], kinds: Mapping[str, PlanKind]
) -> tuple[Plan, dict[str, Any]]:
    """The plan in the heading of a file, which must be that of this version."""
    version = metadata.version("epicyclic")
    if content.get("version") != version:
        allowed = f"was made by version {content.get('version')}, this is {version}."
        raise _error(file, allowed, "Merge it with that version.")
    try:
        plan = kinds[content["kind"]].again(content["plan"], content["source"])
        output = dict(content["output"])
    except (KeyError, TypeError, ValueError, AttributeError):
        plan, output = None, {}
    if plan is None or fingerprint(plan) != mark:
        allowed = "is damaged, or a file that its case names has changed."
        raise _error(file, allowed, "Compute the shard again.")
    return plan, output


def _check_whole(rows: Rows, shares: Mapping[Path, Sequence[int]]) -> None:
    """Raise `InputError` if points are missing."""
    missing = {point for point, status in enumerate(rows.status) if status == NOT_COMPUTED}
    problems = []
    for file, share in shares.items():
        lacks = len(missing.intersection(share))
        if lacks:
            allowed = f"lacks {lacks} of its {len(share)} points."
            problems.append(Problem("FILE", str(file), allowed, "Give its command again."))
    without = len(missing.difference(*shares.values()))
    if without:
        allowed = f"{without} of {len(rows)} points are of shards that are not named."
        problems.append(Problem("FILE", "", allowed, "Name the files of all shards."))
    raise_any(problems, "the command")


def _error(file: Path, allowed: str, remedy: str) -> InputError:
    return InputError([Problem("FILE", str(file), allowed, remedy)], "the command")
