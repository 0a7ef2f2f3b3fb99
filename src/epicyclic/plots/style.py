"""What all plots share: colours that colour-blind eyes tell apart, sizes, labels with units."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
import xarray as xr
from matplotlib import rcsetup
from matplotlib.figure import Figure

from epicyclic.units import unit_text

__all__ = ["COLOURS", "COLOUR_MAP", "label_of", "styled_figure"]

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""Of M. Okabe and K. Ito, Color Universal Design (2008)."""
COLOUR_MAP = "viridis"

_STYLE: Any = {
    "axes.prop_cycle": rcsetup.cycler("color", COLOURS),
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": "medium",
    "axes.titlelocation": "left",
    "font.size": 9.0,
    "savefig.dpi": 160,
    "svg.fonttype": "none",
}


@contextmanager
def styled_figure(rows: int, columns: int, title: str) -> Iterator[tuple[Figure, Any]]:
    """A figure and its array of Axes, drawn in the style of the package.

    Parameters
    ----------
    rows, columns : int
    title : str
    """
    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(4.8 * columns, 3.4 * rows), layout="constrained")
        axes = figure.subplots(rows, columns, squeeze=False)
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        yield figure, axes


def label_of(variable: xr.DataArray) -> str:
    """Name and unit of a variable, ``"line load, N/mm"``."""
    unit = unit_text(str(variable.attrs["units"]))
    name = str(variable.attrs["long_name"])
    return f"{name}, {unit}" if unit else name
