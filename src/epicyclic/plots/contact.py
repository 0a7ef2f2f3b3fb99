"""Pressure, film, shear stress and temperature of a line contact, still or in motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from epicyclic.analysis.contact import FRAMES, ContactResult
from epicyclic.case.fields import to_inputs
from epicyclic.ehl.rough import Frame
from epicyclic.plots.style import COLOURS, gif_bytes, styled_figure
from epicyclic.units import unit_text

FloatArray = NDArray[np.float64]

GIGAPASCAL, MEGAPASCAL, MICROMETRE, MILLIMETRE = 1e9, 1e6, 1e-6, 1e-3
MICROSECOND = 1e-6
SHOWN_WIDTHS = (-2.0, 1.5)
"""Limits of the abscissa, over the half-width of Hertz. [1]"""
SHOWN_FILMS = 5.0
"""Height of the film axis, over the central film of the smooth contact. [1]"""
SHOWN_STRESSES = 10.0
"""Height of the stress axis, over the highest of the smooth contact; touching ones leave it. [1]"""
TWO, MORE = (6.4, 1.8), (4.8, 2.7)
"""Width and height of one of two Axes below each other, and of up to four in two columns: both fill
a slide. [inch]"""
FRAMES_PER_SECOND = 20
ANIMATION_DPI = 80


def contact_figure(result: ContactResult) -> Figure:
    """Pressure, film, and shear stress and temperature if there are any."""
    panels = [plot_pressure, plot_film]
    if result.smooth.shear_stress.any():
        panels.append(plot_shear_stress)
    if result.smooth.temperature_rise.any():
        panels.append(plot_temperature)
    title = result.case.title or "Line contact"
    columns, panel = (1, TWO) if len(panels) == 2 else (2, MORE)
    with styled_figure(2, columns, title, panel=panel, caption=_point(result)) as (figure, axes):
        for ax in axes.flat[len(panels) :]:
            ax.remove()
        for plot, ax in zip(panels, axes.flat, strict=False):
            plot(result, ax)
        if columns == 1:
            axes[0, 0].label_outer()
        if _frames(result):
            axes[0, 0].set_title("rough: the last moment solved", loc="left")
    return figure


def _point(result: ContactResult) -> str:
    """Load and speeds of the contact, its oil and temperature."""
    inputs = to_inputs(result.case)
    words = {key: key.replace("_", " ").replace("hertz", "Hertz") for key in inputs["contact"]}
    stated = [f"{words[key]} {value}" for key, value in inputs["contact"].items()]
    oil = result.case.lubricant.oil.name or "oil"
    return unit_text(", ".join([*stated, f"{oil} at {inputs['lubricant']['temperature']}"]))


def plot_pressure(result: ContactResult, ax: Axes) -> Axes:
    """Pressure of the smooth contact, and of a rough one the last moment kept."""
    frames = _frames(result)
    smooth = result.smooth.pressure / GIGAPASCAL
    rough = [frame.pressure / GIGAPASCAL for frame in frames]
    _plot_both(result, ax, smooth, rough)
    ax.set_ylim(0, 1.05 * max(values.max() for values in (smooth, *rough)))
    if rough:
        ax.legend(loc="upper right")
    return _over_x(result, ax, "pressure, GPa")


def plot_film(result: ContactResult, ax: Axes) -> Axes:
    """Film of the smooth contact, and of a rough one the last moment kept; where it touches."""
    frames = _frames(result)
    films = [frame.film / MICROMETRE for frame in frames]
    _plot_both(result, ax, result.smooth.film / MICROMETRE, films)
    if any(result.touching(frame).any() for frame in frames):
        where = _touching(result, frames[-1])
        style: dict[str, Any] = {"color": COLOURS[6], "ms": 10, "mew": 2, "clip_on": False}
        ax.plot(_rough_x(result), where, "|", label="touching", **style)
        ax.legend(handles=ax.lines[-1:], loc="upper center")  # at the sides the film rises
    ax.set_ylim(0, SHOWN_FILMS * result.smooth.central_film / MICROMETRE)
    return _over_x(result, ax, "film, µm")


def plot_shear_stress(result: ContactResult, ax: Axes) -> Axes:
    """Shear stress of the smooth contact, and of a rough one the last moment kept."""
    smooth = result.smooth.shear_stress / MEGAPASCAL
    rough = [result.shear_stress(frame) / MEGAPASCAL for frame in _frames(result)]
    _plot_both(result, ax, smooth, rough)
    highest = max(values.max() for values in (smooth, *rough))
    ax.set_ylim(0, min(1.05 * highest, SHOWN_STRESSES * smooth.max()) or 1.0)
    return _over_x(result, ax, "shear stress, MPa")


def plot_temperature(result: ContactResult, ax: Axes) -> Axes:
    """Temperature of the film above the inlet, that of the smooth contact."""
    ax.plot(result.smooth.x / MILLIMETRE, result.smooth.temperature_rise)
    ax.set_ylim(bottom=0)
    return _over_x(result, ax, "temperature rise, K")


def contact_animation(result: ContactResult) -> bytes:
    """The last moments kept of a rough contact as an animated GIF."""
    frames = _frames(result)
    figure = contact_figure(result)
    pressure, film, *others = figure.axes
    moving = [
        (pressure.lines[1], [frame.pressure / GIGAPASCAL for frame in frames]),
        (film.lines[1], [frame.film / MICROMETRE for frame in frames]),
        *((line, [_touching(result, frame) for frame in frames]) for line in film.lines[2:]),
    ]
    if others and len(others[0].lines) > 1:
        stresses = [result.shear_stress(frame) / MEGAPASCAL for frame in frames]
        moving.append((others[0].lines[1], stresses))

    def show(number: int) -> list[Any]:
        for line, values in moving:
            line.set_ydata(values[number])
        time = (frames[number].time - frames[0].time) / MICROSECOND
        pressure.set_title(f"rough: after {time:.1f} µs", loc="left")
        return [line for line, _ in moving]

    animation = FuncAnimation(figure, show, frames=len(frames))
    return gif_bytes(animation, FRAMES_PER_SECOND, ANIMATION_DPI)


def _frames(result: ContactResult) -> Sequence[Frame]:
    """The moments that are shown."""
    return [] if result.rough is None else result.rough.frames[-FRAMES:]


def _rough_x(result: ContactResult) -> FloatArray:
    assert result.rough is not None
    x: FloatArray = result.rough.x / MILLIMETRE
    return x


def _touching(result: ContactResult, frame: Frame) -> FloatArray:
    """Zero where surfaces touch, nothing elsewhere."""
    return np.where(result.touching(frame), 0.0, np.nan)


def _plot_both(
    result: ContactResult, ax: Axes, smooth: FloatArray, rough: Sequence[FloatArray]
) -> None:
    """The smooth contact, and the last moment of the rough one."""
    ax.plot(result.smooth.x / MILLIMETRE, smooth, ls="--" if rough else "-", label="smooth")
    if rough:
        ax.plot(_rough_x(result), rough[-1], label="rough")


def _over_x(result: ContactResult, ax: Axes, label: str) -> Axes:
    width = result.smooth.contact.half_width / MILLIMETRE
    ax.set_xlim(SHOWN_WIDTHS[0] * width, SHOWN_WIDTHS[1] * width)
    ax.set_xlabel("place along the rolling direction, mm")
    ax.set_ylabel(label)
    return ax
