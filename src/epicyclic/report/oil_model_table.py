"""Tables of a fitted oil model: what was simulated, how well each form fits."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from epicyclic.oilmodel.model import FORMS, OilModel

__all__ = ["oil_model_tables"]


def oil_model_tables(model: OilModel) -> RenderableType:
    """Every quantity with the cross-validated errors of its forms."""
    counts = ", ".join(f"{count} {name}" for name, count in model.simulations.items())
    parts: list[RenderableType] = [Text(f"{model.oil.title}: {counts} contacts.")]
    for quantity, fit in model.fits.items():
        title = f"{quantity.replace('_', ' ')}, {fit.contacts} contacts, errors of unseen ones"
        table = Table("form", "contacts", title=title, title_justify="left")
        for name in ("number", "median", "90 % below"):
            table.add_column(name, justify="right")
        for fitted in fit.forms:
            form = FORMS[quantity][fitted.form]
            for i, error in enumerate(fitted.errors):
                table.add_row(
                    f"{form.name}: {form.title}" if i == 0 else "",
                    error.regime,
                    str(error.contacts),
                    f"{error.median:.1%}",
                    f"{error.largest_of_90_percent:.1%}",
                )
        parts.append(table)
        parts += [Text(f"{name} left out: {why}.") for name, why in fit.left_out.items()]
    parts += [Text(note) for note in model.notes]
    return Group(*parts)
