"""The campaign: random valid cases over the whole schema, solved, judged and counted.

Run it from the folder tests:

    python -m campaign.run 100000 --journal cases.partial --table ../docs/development/campaign.csv

It goes on where it was stopped, prints how many cases ended how, and writes the table of the docs.
Every tenth design has the default resolution and all its losses. ``--shard 2/8`` solves a share,
and ``--seconds 3600`` ends it after the case in which that time is over. Exit code 1: faults.
"""

from __future__ import annotations

import argparse
import csv
import math
import sys
import time
import warnings
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from campaign.cases import POINTS, WHOLE, drawn_case, is_whole
from campaign.outcomes import FAULTS, outcome_of
from epicyclic.errors import Status
from epicyclic.study.sweeps.runner import Journal, Plan, Row, Runner, fingerprint, parse_shard

__all__ = ["CampaignPlan", "Counts", "counted"]

KINDS = ("planetary", "gear_pair", "train")
RESOLUTIONS = ("coarse", "default")


@dataclass(frozen=True)
class CampaignPlan(Plan):
    """Cases by number, from 0."""

    count: int
    kind: ClassVar[str] = "random cases"
    may_fail: ClassVar[bool] = True

    @property
    def size(self) -> int:
        return self.count

    def order(self) -> Sequence[int]:
        return range(self.count)

    def describe(self) -> dict[str, Any]:
        # not how many: more go on from fewer
        return {"cases": "by number", "points": POINTS, "whole": WHOLE}

    def _solve(self, index: int) -> Row:
        case = drawn_case(index)
        found = outcome_of(case)
        return Row(
            status=str(Status.FAILED if found.name in FAULTS else Status.CONVERGED),
            message=found.name,
            warnings=found.detail,
            numbers={
                "kind": KINDS.index(case.kind),
                "whole": is_whole(index),
                "seconds": found.seconds,
                "energy": found.energy,
            },
        )


@dataclass(frozen=True)
class Counts:
    """What became of the cases.

    Attributes
    ----------
    outcomes : Counter
        By outcome, kind of case and resolution.
    seconds : dict
        Longest processor time of a case, by resolution. [s]
    energy : float
        Largest relative error of the energy of a case. [1]
    faults : list of str
        One line for each.
    """

    outcomes: Counter[tuple[str, str, str]]
    seconds: dict[str, float]
    energy: float
    faults: list[str]

    def rows(self) -> Iterable[list[str]]:
        """A table: outcomes by kind and resolution, the most frequent one first."""
        columns = [(kind, resolution) for resolution in RESOLUTIONS for kind in KINDS]
        totals: Counter[str] = Counter()
        for (name, _, _), number in self.outcomes.items():
            totals[name] += number
        head = [f"{kind.replace('_', ' ')}, {resolution}" for kind, resolution in columns]
        yield ["outcome", "all", *head]
        for name in [name for name, _ in totals.most_common()] + [
            fault for fault in FAULTS if fault not in totals
        ]:
            numbers = [self.outcomes[(name, *column)] for column in columns]
            yield [name, *map(str, (totals[name], *numbers))]
        sums = [sum(self.outcomes[(name, *column)] for name in totals) for column in columns]
        yield ["all", *map(str, (sum(sums), *sums))]
        for resolution in RESOLUTIONS:
            longest = self.seconds.get(resolution, 0.0)
            yield [f"longest processor time, {resolution} [s]", f"{longest:.1f}"]
        yield ["largest error of the energy", f"{self.energy:.1e}"]


def counted(rows: Iterable[tuple[int, Row]]) -> Counts:
    """Counts of finished cases."""
    found = Counts(Counter(), {}, 0.0, [])
    energy = 0.0
    for index, row in rows:
        resolution = RESOLUTIONS[int(row.numbers["whole"])]
        kind = KINDS[int(row.numbers["kind"])]
        found.outcomes[(row.message, kind, resolution)] += 1
        longest = max(found.seconds.get(resolution, 0.0), row.numbers["seconds"])
        found.seconds[resolution] = longest
        if math.isfinite(row.numbers["energy"]):
            energy = max(energy, row.numbers["energy"])
        if row.warnings:
            found.faults.append(f"{index} ({kind}): {row.message}: {row.warnings}")
    return Counts(found.outcomes, found.seconds, energy, found.faults)


def main() -> None:
    """Solve, print, write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("count", type=int)
    parser.add_argument("--journal", type=Path, default=Path("cases.partial"))
    parser.add_argument("--table", type=Path)
    parser.add_argument("--shard", type=parse_shard)
    parser.add_argument("--seconds", type=float, default=math.inf)
    asked = parser.parse_args()
    warnings.simplefilter("error")
    plan = CampaignPlan(asked.count)
    end = time.monotonic() + asked.seconds

    def watch(*_: int) -> None:
        if time.monotonic() > end:
            raise TimeoutError

    with suppress(TimeoutError):
        Runner(jobs=1, journal=asked.journal, shard=asked.shard, progress=watch).run(plan)
    counts = counted(sorted(Journal(asked.journal, fingerprint(plan)).points()))
    csv.writer(sys.stdout).writerows(counts.rows())
    print("\n".join(counts.faults))
    if asked.table is not None:
        with asked.table.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(counts.rows())
    sys.exit(any(name in FAULTS for name, _, _ in counts.outcomes))


if __name__ == "__main__":
    main()
