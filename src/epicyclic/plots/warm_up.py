"""Temperatures and losses of a gearbox that warms up."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from epicyclic.plots.style import COLOURS, LINE_STYLES, styled_figure
from epicyclic.results.result import in_words

if TYPE_CHECKING:
    import xarray as xr

_MINUTE, _HOUR = 60.0, 3600.0
_PANEL = (7.0, 3.2)
_MOST_NODES = 7
"""With a line of their own; those whose temperature goes furthest from the others come first."""


def warm_up_figure(data: xr.Dataset) -> Figure:
    """Temperatures of the parts over the total power loss, over time."""
    seconds = data["time"].values
    size, unit = (_HOUR, "h") if seconds[-1] > 2 * _HOUR else (_MINUTE, "min")
    times = seconds / size
    with styled_figure(2, 1, data.attrs["title"], panel=_PANEL) as (figure, axes):
        above, below = axes[0, 0], axes[1, 0]
        nodes = _shown(data)
        for number, node in enumerate(nodes):
            above.plot(
                times,
                data["temperature"].sel(node=node).values,
                label=in_words(node),
                color=COLOURS[number % len(COLOURS)],
                linestyle=LINE_STYLES[number % len(LINE_STYLES)],
            )
        above.set(title="Temperatures", ylabel="temperature, °C", xlim=(0, times[-1]))
        above.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize="small")
        below.plot(times, data["total_loss"].values, color=COLOURS[6])
        below.set(title="Loss", ylabel="power loss, W", xlabel=f"time, {unit}")
        below.set(xlim=(0, times[-1]), ylim=(0, None))
    return figure


def _shown(data: xr.Dataset) -> list[str]:
    """The nodes to draw, the hottest at the end first; of many the hottest, oil and housing."""
    last = data["temperature"].isel(time=-1)
    nodes = [str(node) for node in last.sortby(-last)["node"].values]
    if len(nodes) <= _MOST_NODES:
        return nodes
    kept = [node for node in ("oil", "housing") if node in nodes]
    others = [node for node in nodes if node not in kept]
    return [*others[: _MOST_NODES - len(kept)], *kept]
