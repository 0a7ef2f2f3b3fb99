"""The folder of a campaign: what is simulated, what is finished, and the table of all results.

``campaign.json``  the plan; a folder with another one is refused
``simulations.partial``  journal of an unfinished campaign; of a shard ``.shard-2-of-8``
``simulations.csv``  one line for each simulation, when all are done
``model.json``  the fitted models
"""

from __future__ import annotations

import io
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.campaigns.campaign import SCHEMA, Campaign
from epicyclic.campaigns.design import AXES, quantity_of_axis
from epicyclic.case.wording import one_line
from epicyclic.errors import InputError, Problem
from epicyclic.sweeps.journal import Journal, Rows
from epicyclic.sweeps.runner import HERE, Runner, fingerprint
from epicyclic.text_file import read_bytes, read_text
from epicyclic.whole_file import make_folder, write_file

if TYPE_CHECKING:
    import pandas as pd

SIMULATIONS = "simulations"
"""With which files of results begin."""


@dataclass(frozen=True)
class CampaignFolder:
    """A campaign and the folder that keeps it."""

    path: Path
    campaign: Campaign

    @property
    def journal(self) -> Journal:
        """Finished simulations of an unfinished campaign."""
        return Journal(self.path.absolute() / f"{SIMULATIONS}.partial", fingerprint(self.campaign))

    @property
    def table(self) -> Path:
        """All results."""
        return self.path / f"{SIMULATIONS}.csv"

    @property
    def model(self) -> Path:
        """The fitted models."""
        return self.path / "model.json"

    @property
    def finished(self) -> int:
        """Number of finished simulations."""
        return self.campaign.size if self.table.exists() else len(self.journal.read())

    def prepare(self) -> None:
        """Make the folder.

        Raises
        ------
        InputError
            If it cannot be made, or holds another campaign.
        """
        make_folder(self.path)
        plan = self.path / "campaign.json"
        simulated = any(self.path.glob(f"{SIMULATIONS}.*"))  # first: shards may begin at once
        if not plan.exists():
            if simulated:
                raise _folder_error(self.path, "holds simulations without their campaign.json.")
            write_file(plan, json.dumps(self.campaign.describe(), indent=2) + "\n")
        elif _read_json(plan) != json.loads(json.dumps(self.campaign.describe())):
            raise _folder_error(
                self.path,
                "holds another campaign: other oil, points, seed, settings or version.",
            )

    def run(self, runner: Runner = HERE) -> None:
        """Simulate all that is not finished, and write the table."""
        if not self.table.exists():
            runner = replace(runner, journal=self.journal.path, tell_failures=True)
            self.write(runner.run(self.campaign))
            self.journal.remove()

    def write(self, rows: Rows) -> None:
        """Write the table of all results."""
        write_file(self.table, self._frame(rows).to_csv(index=False))

    def read(self) -> pd.DataFrame:
        """The table of all results.

        Raises
        ------
        InputError
            If there is none, or it is damaged.
        """
        import pandas as pd

        try:
            content = read_bytes(self.table, "table of simulations", _LARGEST_TABLE)
            frame = pd.read_csv(io.BytesIO(content))
        except InputError as error:
            raise _folder_error(self.table, error.problems[0].allowed) from None
        except (OSError, ValueError) as error:
            allowed = f"cannot be read: {one_line(str(error))}."
            raise _folder_error(self.table, allowed) from None
        if len(frame) != self.campaign.size or "status" not in frame:
            raise _folder_error(self.table, "does not have one line for each simulation.")
        if "friction" not in frame:
            remedy = "See why in its column of messages, and name another folder."
            raise _folder_error(self.table, "has no simulation with a solution.", remedy)
        self._check_columns(frame)
        return frame

    def _check_columns(self, frame: pd.DataFrame) -> None:
        """Raise `InputError` unless all that is fitted is there, as finite numbers."""
        known = list(map(column_of, AXES))
        solved = [
            "unsolved_share",
            "roughness_kept",
            *(f"{name}{end}" for name in _RESULTS for end in ("", "_error")),
        ]
        lacks = [name for name in ("part", *known, *solved) if name not in frame]
        if lacks:
            raise _folder_error(self.table, f"lacks the columns {', '.join(lacks)}.")
        numbers = frame[known + solved]
        wrong = [name for name in numbers if numbers[name].dtype.kind not in "fiu"]
        wrong += [
            name
            for name in set(numbers) - set(wrong)
            if np.isinf(numbers[name]).any() or (name in known and numbers[name].isna().any())
        ]
        if wrong:
            raise _folder_error(self.table, f"must hold finite numbers in {', '.join(wrong)}.")

    def _frame(self, rows: Rows) -> pd.DataFrame:
        """Conditions and results, one line for each simulation."""
        import pandas as pd

        every = range(self.campaign.size)
        points = [self.campaign.point(index) for index in every]
        return pd.DataFrame(
            {"number": every, "part": [self.campaign.part(index) for index in every]}
            | {column_of(name): [point[name] for point in points] for name in AXES}
            | {"status": rows.status, "message": rows.message}
            | {name: rows.numbers(name) for name in rows.names}
        )


def open_folder(path: Path) -> CampaignFolder:
    """The campaign that a folder holds.

    Raises
    ------
    InputError
        If it holds none, or one of another version of these files.
    """
    data = _read_json(path / "campaign.json")
    try:
        if data["schema"] != SCHEMA:
            raise _folder_error(path, f"has files of version {data['schema']}, not {SCHEMA}.")
        return CampaignFolder(path, Campaign.again(data))
    except (KeyError, TypeError, AttributeError):
        raise _folder_error(path / "campaign.json", "is no plan of a campaign.") from None


def column_of(name: str) -> str:
    unit = quantity_of_axis(name).display
    return f"{name} [{unit}]" if unit else name


_LARGEST_PLAN, _LARGEST_TABLE = 1_000_000, 200_000_000
"""Largest campaign.json, and largest table of results. [bytes]"""
_RESULTS = ("friction", "rolling_loss")
"""What the table holds with its error."""


def _read_json(path: Path) -> Any:
    try:
        return json.loads(read_text(path, "campaign", _LARGEST_PLAN))
    except InputError as error:
        raise _folder_error(path, error.problems[0].allowed) from None
    except (RecursionError, ValueError):
        raise _folder_error(path, "is no JSON.") from None


def _folder_error(
    path: Path, allowed: str, remedy: str = "Name another folder, or mend this one."
) -> InputError:
    return InputError([Problem("DIR", str(path), allowed, remedy)], "the campaign")
