"""What a result offers beside its numbers: tables, pictures, files, a page of a notebook.

All of these are made by layers above this one. They are looked up by name when they are asked for,
as plug-ins are: nothing here depends on how they are made.
"""

from __future__ import annotations

import pkgutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

_MADE_BY = "epicyclic.report.views"


class Views:
    """Methods of a result that show or keep it."""

    __slots__ = ()

    def table(
        self,
        # ``"losses"``: power, share of the total, group and method of every loss and sum.
        # ``"numbers"``: value, unit and label of every number, as sweeps store them.
        of: str = "losses",
    ) -> pd.DataFrame:
        """Losses, or every number, as a table.

        Returns
        -------
        pandas.DataFrame
            One row for each, named by its key.

        Examples
        --------
        >>> import epicyclic as ep
        >>> result = ep.solve(ep.load_case("talbot-2012"))
        >>> table = result.table()
        >>> bool(table.loc["total", "loss [W]"] == result.total)
        True
        """
        return _made("table", self, of)

    def plot(
        self,
        # Its name, ``"power-flow"``; an unknown one is answered with those that there are.
        what: str = "losses",
        *,
        # Width and height; default: those of a slide. [mm]
        size: tuple[float, float] | None = None,
        # Pixels an inch; default: such that the picture is as wide as a slide of 1920 pixels.
        dpi: float | None = None,
    ) -> Figure:
        """One of the pictures of ``epicyclic plot``.

        Returns
        -------
        matplotlib.figure.Figure
            Its ``savefig`` writes a file.

        Examples
        --------
        >>> import epicyclic as ep
        >>> figure = ep.solve(ep.load_case("talbot-2012")).plot("losses", size=(120, 80))
        """
        figure: Figure = _made("plot", self, what, size, dpi)
        return figure

    def save(
        self,
        # ``.nc``: everything, for `open_result`, reports and plots; ``.json``: the numbers;
        # ``.html`` or ``.pdf``: the report.
        path: str | Path,
    ) -> None:
        """Keep the result in a file, whole or not at all.

        Raises
        ------
        InputError
            If there is no place for the file, or it ends otherwise.

        Examples
        --------
        >>> import tempfile
        >>> import epicyclic as ep
        >>> result = ep.solve(ep.load_case("talbot-2012"))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     result.save(f"{folder}/result.json")
        """
        _made("save", self, Path(path))

    def _repr_html_(self) -> str:
        return str(_made("html", self))


def _made(name: str, *arguments: object) -> Any:
    return pkgutil.resolve_name(f"{_MADE_BY}:{name}")(*arguments)
