"""Tables and plots of line contacts and of fitted oil models."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from epicyclic.arrays import FloatArray
from epicyclic.contact.fitted_models import FORMS, REGIMES, OilModel, QuantityFit
from epicyclic.contact.line_contact import LineContacts, contacts_at
from epicyclic.errors import Status
from epicyclic.losses.rolling import domain_ranges
from epicyclic.messages import value_at
from epicyclic.plugins.contact_solver.contact import FRAMES, ContactFigure, ContactResult
from epicyclic.plugins.contact_solver.rough import Frame
from epicyclic.plugins.contact_solver.surfaces import Profile
from epicyclic.schema.fields import to_inputs
from epicyclic.show.page import shown
from epicyclic.show.plots.style import (
    COLOURS,
    LINE_STYLES,
    gif_bytes,
    label_logarithms,
    labelled,
    legend_below,
    styled_figure,
)
from epicyclic.show.terminal import number_table, plain_table
from epicyclic.units import MICROMETRE, Quantity, percent, unit_text


def contact_tables(result: ContactResult) -> RenderableType:
    """Figures of a contact and how its solution ended."""
    title = result.case.title or "Line contact"
    table = number_table(title, "", "", no_wrap=(True, False))
    table.add_column("")
    table.show_header = False
    for figure in result.figures:
        table.add_row(figure.name, shown(_displayed(figure)), unit_text(figure.display))
    parts: list[RenderableType] = [table] if result.figures else []
    if not result.model.smooth:
        parts += [Text(_surface(*item)) for item in enumerate(result.model.surfaces, 1)]
    warnings = [Text(f"Warning: {warning}") for warning in result.warnings]
    return Group(*parts, Text(_ending(result)), *warnings)


def _surface(number: int, surface: Profile) -> str:
    """Statistics of a surface, which a generated profile meets on the whole only."""
    if surface.rms == 0:
        return f"Surface {number}: smooth."
    rms, length = (
        f"{shown(MICROMETRE.to_display(value))} {unit_text(MICROMETRE.display)}"
        for value in (surface.rms, surface.correlation_length)
    )
    return (
        f"Surface {number}: Rq {rms}, correlation length {length}, "
        f"skewness {shown(surface.skewness, 2)}, kurtosis {shown(surface.kurtosis, 2)}."
    )


def _displayed(figure: ContactFigure) -> float:
    if figure.display == "%":
        return 100 * figure.value
    return Quantity(figure.name, figure.unit, figure.display).to_display(figure.value)


def _ending(result: ContactResult) -> str:
    if result.status is not Status.CONVERGED:
        return f"Not converged: {result.message}."
    if result.rough is None:
        return f"Converged in {result.smooth.iterations} Newton steps."
    rough = result.rough
    return f"Converged; {rough.steps} time steps, {rough.unsolved_steps} of them not solved."


INPUTS = (
    "lubricant.pressure_law",
    "lubricant.shear_law",
    "lubricant.eyring_stress",
    "surface1.correlation_length",
    "surface2.correlation_length",
    "asperities.film",
    "asperities.friction",
    "heating.model",
    "numerics.nodes",
)
"""Settings of all simulations that decide what the models are worth."""


def oil_model_tables(model: OilModel) -> RenderableType:
    """What a model was made of, its domain, and the cross-validated errors of its forms."""
    counts = model.simulations
    parts: list[RenderableType] = [
        Text(
            f"{model.oil.title}: {counts.get('simulated', 0)} contacts simulated with epicyclic "
            f"{model.version}, seed {model.seed}; {counts.get('not converged', 0)} not converged, "
            f"{counts.get('fitted', 0)} fitted."
        ),
        _inputs(model),
    ]
    shown: list[Any] = []
    for quantity, fit in model.fits.items():
        title = f"{quantity.replace('_', ' ').capitalize()}, {fit.contacts} contacts"
        parts += [_errors(f"{title}: errors at contacts not used in the fit", quantity, fit)]
        parts += [Text(f"{name} left out: {why}.\n") for name, why in fit.left_out.items()]
        if fit.domain not in shown:
            parts.append(_domain(f"Domain of these {fit.contacts} contacts", model, quantity))
        shown.append(fit.domain)
    return Group(*parts, *(Text(note) for note in model.notes))


def _inputs(model: OilModel) -> Table:
    table = plain_table("Inputs of the simulations")
    table.show_header = False
    for _ in range(2):
        table.add_column(no_wrap=True)
    for key in INPUTS:
        value = value_at(model.settings, key.split("."))
        if value is not None:
            table.add_row(key, str(value))
    return table


def _errors(title: str, quantity: str, fit: QuantityFit) -> Table:
    table = plain_table(title)
    table.add_column("form")
    table.add_column("contacts", no_wrap=True)
    for name in ("number", "median", "90 % below"):
        table.add_column(name, justify="right", no_wrap=True)
    for fitted in fit.forms:
        form = FORMS[quantity][fitted.form]
        default = ", the default" if fitted is fit.forms[0] else ""
        for i, error in enumerate(fitted.errors):
            table.add_row(
                f"{form.name}{default}: {form.title}" if i == 0 else "",
                error.regime,
                str(error.contacts),
                percent(error.median),
                percent(error.largest_of_90_percent),
            )
    return table


def _domain(title: str, model: OilModel, quantity: str) -> Table:
    table = number_table(title, "", "from", "to", no_wrap=(True, False))
    table.add_column("")
    for item in domain_ranges(model, quantity):
        low, high = (shown(limit, 3) for limit in (item.low or 0.0, item.high or 0.0))
        table.add_row(item.label, low, high, unit_text(item.unit.display))
    return table


GIGAPASCAL, MEGAPASCAL, _MICROMETRE, MILLIMETRE = 1e9, 1e6, 1e-6, 1e-3
MICROSECOND = 1e-6
SHOWN_WIDTHS = (-2.0, 1.5)  # Limits of the abscissa, over the half-width of Hertz. [1]
SHOWN_FILMS = 5.0  # Height of the film axis, over the central film of the smooth contact. [1]
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
    with styled_figure(
        2, columns, title, panel=panel, caption=_point(result), count=len(panels)
    ) as (figure, axes):
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
    films = [frame.film / _MICROMETRE for frame in frames]
    _plot_both(result, ax, result.smooth.film / _MICROMETRE, films)
    if any(result.touching(frame).any() for frame in frames):
        where = _touching(result, frames[-1])
        style: dict[str, Any] = {"color": COLOURS[6], "ms": 10, "mew": 2, "clip_on": False}
        ax.plot(_rough_x(result), where, "|", label="touching", **style)
        ax.legend(handles=ax.lines[-1:], loc="upper center")  # at the sides the film rises
    ax.set_ylim(0, SHOWN_FILMS * result.smooth.central_film / _MICROMETRE)
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
        (film.lines[1], [frame.film / _MICROMETRE for frame in frames]),
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
    return labelled(ax, "position along the rolling direction, mm", label)


MARKERS = ("o", "^", "s")
LABELS = {
    "friction": "coefficient of friction",
    "rolling_loss": "rolling loss of teeth, W/m",
    "bearing_rolling_loss": "rolling loss of rollers, W/m",
}
BAND = 0.25  # Half-width of the lines beside equality. [1]
CAPTION = (
    f"Lines: fitted equal to simulated, and {percent(BAND, 0)} more or less. The fit used these "
    "contacts; its errors at others are larger and are given in the table."
)
PANEL = (4.0, 3.4)  # Width and height of one of the Axes. [inch]
SLIPS = (0.05, 0.2, 0.8)
POINTS = 80


def oil_model_figure(
    model: OilModel,
    # As from `simulated_quantities`.
    simulated: Mapping[str, tuple[LineContacts, FloatArray, FloatArray]],
) -> Figure:
    """Every quantity computed against simulated, and friction over the film ratio."""
    count = len(model.fits) + ("friction" in model.fits)
    rows, columns = (2, 2) if count > 3 else (1, count)
    with styled_figure(rows, columns, model.oil.title, panel=PANEL, caption=CAPTION) as (
        figure,
        axes,
    ):
        for ax, quantity in zip(axes.flat, model.fits, strict=False):
            plot_against_simulations(model, quantity, *simulated[quantity][:2], ax)
        if "friction" in model.fits:
            plot_over_film_ratio(model, axes.flat[len(model.fits)])
    return figure


def plot_against_simulations(
    model: OilModel, quantity: str, states: LineContacts, target: FloatArray, ax: Axes
) -> Axes:
    """The default form over the simulations, by film ratio."""
    value = model.value(quantity, states)
    regimes = list(REGIMES.items())[1:]
    for (name, (low, high)), colour, marker in zip(regimes, COLOURS, MARKERS, strict=False):
        here = (states.film_ratio > low) & (states.film_ratio <= high)
        if here.any():
            ax.plot(target[here], value[here], marker, color=colour, ms=3.5, alpha=0.7, label=name)
    ends = np.array([min(target.min(), value.min()), max(target.max(), value.max())])
    for factor, style in ((1.0, "-"), (1 + BAND, ":"), (1 / (1 + BAND), ":")):
        ax.plot(ends, factor * ends, style, color="0.4", lw=0.8)
    if quantity != "friction":
        ax.set_xscale("log")
        ax.set_yscale("log")
        label_logarithms(ax.xaxis, ax.yaxis)
    name, _, unit = LABELS[quantity].partition(", ")
    across, up = (f"{what}, {unit}".rstrip(", ") for what in ("simulated", "fitted"))
    legend_below(ax, ncols=2)
    return labelled(ax, across, up, f"{name[:1].upper()}{name[1:]}")


def plot_over_film_ratio(model: OilModel, ax: Axes) -> Axes:
    """Friction at middle conditions as the roughness changes, each form with a line of its own."""
    fit = model.fits["friction"]
    middle = _middle(fit.domain, model.equivalent_modulus)
    styles = itertools.cycle(LINE_STYLES)
    for slip, colour in zip(SLIPS, COLOURS, strict=False):
        states = middle.changed(slide_to_roll_ratio=np.full(POINTS, slip))
        for fitted in fit.forms:
            values = model.value("friction", states, fitted.form)
            form = f", {fitted.form}" if len(fit.forms) > 1 else ""
            style, label = next(styles), f"slip {slip:g}{form}"
            ax.plot(states.film_ratio, values, linestyle=style, color=colour, label=label)
    ax.set_xscale("log")
    label_logarithms(ax.xaxis)
    ax.set_ylim(bottom=0)
    legend_below(ax, ncols=3)
    title = "At the middle of the simulated conditions"
    return labelled(ax, "film ratio, by roughness", LABELS["friction"], title)


def _middle(domain: Mapping[str, tuple[float, float]], modulus: float) -> LineContacts:
    """Contacts in the middle of a domain but for their roughness, which runs through it."""
    middle = {
        name: np.full(POINTS, np.sqrt(max(low, 1e-30) * max(high, 1e-30)))
        for name, (low, high) in domain.items()
    }
    for name in ("roughness1", "roughness2"):
        middle[name] = np.geomspace(*domain[name], POINTS)
    return contacts_at(**middle, equivalent_modulus=modulus)
