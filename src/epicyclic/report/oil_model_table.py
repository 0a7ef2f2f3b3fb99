"""Tables of a fitted oil model: what was simulated, where it holds, how well each form fits."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from epicyclic.case.plain import value_at
from epicyclic.losses.fitted import domain_ranges
from epicyclic.oilmodel.model import FORMS, OilModel, QuantityFit
from epicyclic.report.shown import shown
from epicyclic.report.tables import number_table, plain_table
from epicyclic.units import percent, unit_text

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
    for quantity, fit in model.fits.items():
        title = f"{quantity.replace('_', ' ').capitalize()}, {fit.contacts} contacts"
        parts += [_errors(f"{title}: errors of unseen ones", quantity, fit)]
        parts += [Text(f"{name} left out: {why}.\n") for name, why in fit.left_out.items()]
        if fit.domain not in [other.domain for other in _before(model, quantity)]:
            parts.append(_domain(f"Domain of these {fit.contacts} contacts", model, quantity))
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


def _before(model: OilModel, quantity: str) -> list[QuantityFit]:
    """Fits of the quantities that come first."""
    return list(model.fits.values())[: list(model.fits).index(quantity)]


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
