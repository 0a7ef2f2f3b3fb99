"""Pressure and film of a line contact, still or in motion."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from epicyclic.analysis.contact import FRAMES, ContactResult
from epicyclic.plots.style import styled_figure

__all__ = ["contact_animation", "contact_figure", "plot_film", "plot_pressure"]

GIGAPASCAL, MICROMETRE, MILLIMETRE = 1e9, 1e-6, 1e-3
SHOWN_WIDTHS = (-2.0, 1.5)
"""Limits of the abscissa, over the half-width of Hertz. [1]"""
SHOWN_FILMS = 5.0
"""Height of the film axis, over the central film of the smooth contact. [1]"""
FRAMES_PER_SECOND = 20
ANIMATION_DPI = 80


def contact_figure(result: ContactResult) -> Figure:
    """Pressure above, film below."""
    with styled_figure(2, 1, result.case.title or "Line contact") as (figure, axes):
        plot_pressure(result, axes[0, 0])
        plot_film(result, axes[1, 0])
    return figure


def plot_pressure(result: ContactResult, ax: Axes) -> Axes:
    """Pressure of the smooth contact, and of a rough one the last moment kept."""
    ax.plot(result.smooth.x / MILLIMETRE, result.smooth.pressure / GIGAPASCAL, label="smooth")
    rough = result.rough
    if rough is not None and rough.frames:
        ax.plot(rough.x / MILLIMETRE, rough.frames[-1].pressure / GIGAPASCAL, label="rough")
        highest = max(float(frame.pressure.max()) for frame in rough.frames[-FRAMES:])
        ax.set_ylim(0, 1.05 * highest / GIGAPASCAL)
        ax.legend()
    return _over_x(result, ax, "pressure, GPa")


def plot_film(result: ContactResult, ax: Axes) -> Axes:
    """Film of the smooth contact, and of a rough one the last moment kept."""
    ax.plot(result.smooth.x / MILLIMETRE, result.smooth.film / MICROMETRE, label="smooth")
    rough = result.rough
    if rough is not None and rough.frames:
        ax.plot(rough.x / MILLIMETRE, rough.frames[-1].film / MICROMETRE, label="rough")
    ax.set_ylim(0, SHOWN_FILMS * result.smooth.central_film / MICROMETRE)
    return _over_x(result, ax, "film, µm")


def contact_animation(result: ContactResult) -> bytes:
    """The last moments kept of a rough contact as an animated GIF."""
    assert result.rough is not None
    frames = result.rough.frames[-FRAMES:]
    figure = contact_figure(result)
    upper, lower = (ax.lines[-1] for ax in figure.axes)

    def show(number: int) -> list[Any]:
        upper.set_ydata(frames[number].pressure / GIGAPASCAL)
        lower.set_ydata(frames[number].film / MICROMETRE)
        return [upper, lower]

    animation = FuncAnimation(figure, show, frames=len(frames))
    with tempfile.TemporaryDirectory() as folder:  # the writer of frames takes a path only
        path = Path(folder) / "contact.gif"
        animation.save(path, writer=PillowWriter(fps=FRAMES_PER_SECOND), dpi=ANIMATION_DPI)
        return path.read_bytes()


def _over_x(result: ContactResult, ax: Axes, label: str) -> Axes:
    width = result.smooth.contact.half_width / MILLIMETRE
    ax.set_xlim(SHOWN_WIDTHS[0] * width, SHOWN_WIDTHS[1] * width)
    ax.set_xlabel("x, mm")
    ax.set_ylabel(label)
    return ax
