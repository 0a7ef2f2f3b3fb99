"""Pressure and film of a line contact, still or animated."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.analysis.contact import FRAMES, ContactResult
from epicyclic.errors import InputError, Problem

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["ANIMATIONS", "draw_contact", "save_contact"]

ANIMATIONS = (".gif",)
"""File types that are animated."""
GIGAPASCAL, MICROMETRE, MILLIMETRE = 1e9, 1e-6, 1e-3
FRAMES_PER_SECOND = 20
SHOWN_FILMS = 5.0
"""Height of the film axis, over the central film. [1]"""


def save_contact(result: ContactResult, path: Path) -> None:
    """Draw into a file of any type matplotlib writes; a .gif moves."""
    matplotlib = _matplotlib()
    with matplotlib.rc_context({"backend": "agg"}):
        figure = draw_contact(result)
        try:
            if path.suffix.lower() in ANIMATIONS and result.rough is not None:
                _animate(figure, result, path)
            else:
                figure.savefig(path)
        except (OSError, ValueError) as error:
            problem = Problem("--plot", str(path), f"cannot be written: {error}.", "Rename it.")
            raise InputError([problem], "the command") from None


def draw_contact(result: ContactResult) -> Figure:
    """Pressure above, film below, over x; of a rough contact the last moment kept."""
    _matplotlib()
    from matplotlib.figure import Figure

    smooth, rough = result.smooth, result.rough
    figure = Figure(figsize=(8, 6), layout="constrained")
    upper, lower = figure.subplots(2, sharex=True)
    width = smooth.contact.half_width / MILLIMETRE
    x = smooth.x / MILLIMETRE
    upper.plot(x, smooth.pressure / GIGAPASCAL, color="0.5", label="smooth")
    lower.plot(x, smooth.film / MICROMETRE, color="0.5", label="smooth")
    if rough is not None and rough.frames:
        frame = rough.frames[-1]
        inside = rough.x / MILLIMETRE
        upper.plot(inside, frame.pressure / GIGAPASCAL, linewidth=1, label="rough")
        lower.plot(inside, frame.film / MICROMETRE, linewidth=1, label="rough")
        upper.set_ylim(0, 1.05 * max(float(f.pressure.max()) for f in rough.frames) / GIGAPASCAL)
        upper.legend(frameon=False)
    upper.set_ylabel("pressure / GPa")
    lower.set_ylabel("film / µm")
    lower.set_xlabel("x / mm")
    lower.set_xlim(-2 * width, 1.5 * width)
    lower.set_ylim(0, SHOWN_FILMS * smooth.central_film / MICROMETRE)
    upper.set_title(result.case.title or "Line contact")
    return figure


def _animate(figure: Figure, result: ContactResult, path: Path) -> None:
    from matplotlib.animation import FuncAnimation, PillowWriter

    assert result.rough is not None
    frames = result.rough.frames[-FRAMES:]
    upper, lower = figure.axes[:2]

    def show(number: int) -> list[Any]:
        frame = frames[number]
        _last_line(upper).set_ydata(frame.pressure / GIGAPASCAL)
        _last_line(lower).set_ydata(frame.film / MICROMETRE)
        return [_last_line(upper), _last_line(lower)]

    animation = FuncAnimation(figure, show, frames=len(frames))
    animation.save(path, writer=PillowWriter(fps=FRAMES_PER_SECOND))


def _last_line(axes: Axes) -> Any:
    return axes.lines[-1]


def _matplotlib() -> Any:
    try:
        import matplotlib
    except ImportError:
        problem = Problem(
            "--plot", "", "needs matplotlib.", "Run: python -m pip install 'epicyclic[plot]'."
        )
        raise InputError([problem], "the command") from None
    return matplotlib
