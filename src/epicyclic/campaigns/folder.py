"""The folder of a campaign: what is simulated, what is finished, and the table of all results.

``campaign.json``  the plan; a folder with another one is refused
``simulations.partial``  journal of an unfinished campaign
``simulations.csv``  one line for each simulation, when all are done
``model.json``  the fitted models
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.campaigns.campaign import SCHEMA, Campaign
from epicyclic.campaigns.design import AXES, Design, quantity_of_axis
from epicyclic.errors import InputError, Problem
from epicyclic.status import Status
from epicyclic.sweeps.dataset import whole_file
from epicyclic.sweeps.journal import Journal, Row
from epicyclic.sweeps.work import run_work
from epicyclic.text_file import read_text

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["CampaignFolder", "CampaignProgress", "column_of", "open_folder", "write_whole"]

CampaignProgress = Callable[[int, int, int], None]
"""Called with the numbers of finished, of all, and of failed simulations."""


@dataclass(frozen=True)
class CampaignFolder:
    """A campaign and the folder that keeps it."""

    path: Path
    campaign: Campaign

    @property
    def journal(self) -> Journal:
        """Finished simulations of an unfinished campaign."""
        return Journal(self.path.absolute() / "simulations.partial", self.campaign.fingerprint())

    @property
    def table(self) -> Path:
        """All results."""
        return self.path / "simulations.csv"

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
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise _folder_error(self.path, f"cannot be made: {error.strerror}.") from None
        plan = self.path / "campaign.json"
        if not plan.exists():
            if any(self.path.glob("simulations.*")):
                raise _folder_error(self.path, "holds simulations without their campaign.json.")
            write_whole(plan, json.dumps(self.campaign.describe(), indent=2) + "\n")
        elif _read_json(plan) != json.loads(json.dumps(self.campaign.describe())):
            raise _folder_error(
                self.path,
                "holds another campaign: other oil, points, seed, settings or version.",
            )

    def run(
        self,
        *,
        jobs: int | None = None,
        cluster: str | None = None,
        progress: CampaignProgress | None = None,
    ) -> None:
        """Simulate all that is not finished, and write the table."""
        if self.table.exists():
            return
        rows: dict[int, Row] = {}
        failed = 0
        for finished in run_work(
            self.campaign, jobs=jobs, journal=self.journal, batch=1, cluster=cluster
        ):
            rows.update(finished)
            failed += sum(row.status == Status.FAILED for _, row in finished)
            if progress is not None:
                progress(len(rows), self.campaign.size, failed)
        ordered = [rows[index] for index in range(self.campaign.size)]
        write_whole(self.table, self._frame(ordered).to_csv(index=False))
        self.journal.remove()

    def read(self) -> pd.DataFrame:
        """The table of all results.

        Raises
        ------
        InputError
            If there is none, or it is damaged.
        """
        import pandas as pd

        try:
            frame = pd.read_csv(self.table)
        except (OSError, ValueError) as error:
            allowed = f"cannot be read: {error}."
            raise _folder_error(self.table, allowed) from None
        if len(frame) != self.campaign.size or "status" not in frame:
            raise _folder_error(self.table, "does not have one line for each simulation.")
        if "friction" not in frame:
            remedy = "See why in its column of messages, and name another folder."
            raise _folder_error(self.table, "has no simulation with a solution.", remedy)
        return frame

    def _frame(self, rows: Sequence[Row]) -> pd.DataFrame:
        """Conditions and results, one line for each simulation."""
        import pandas as pd

        names = list(dict.fromkeys(name for row in rows for name in row.numbers))
        lines = []
        for index, row in enumerate(rows):
            conditions = self.campaign.point(index)
            lines.append(
                {"number": index, "part": self.campaign.part(index)}
                | {column_of(name): conditions[name] for name in AXES}
                | {"status": row.status, "message": row.message}
                | {name: row.numbers.get(name) for name in names}
            )
        return pd.DataFrame(lines)


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
        designs = tuple(
            Design(
                item["part"],
                tuple((name, tuple(values)) for name, values in item["axes"].items()),
                item["size"],
                item["seed"],
            )
            for item in data["designs"]
        )
        settings = json.dumps(data["settings"], sort_keys=True)
        return CampaignFolder(path, Campaign(settings, designs, data["seed"], data["version"]))
    except (KeyError, TypeError, AttributeError):
        raise _folder_error(path / "campaign.json", "is no plan of a campaign.") from None


def write_whole(path: Path, text: str) -> None:
    """Write a file whole or not at all.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    try:
        with whole_file(path) as temporary:
            temporary.write_text(text, encoding="utf-8")
    except OSError as error:
        raise _folder_error(
            path, f"cannot be written: {error.strerror}.",
            "Nothing is lost; make room, and give the same command again.",
        ) from None  # fmt: skip


def column_of(name: str) -> str:
    unit = quantity_of_axis(name).display
    return f"{name} [{unit}]" if unit else name


_LARGEST_PLAN = 1_000_000
"""Of campaign.json. [bytes]"""


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
