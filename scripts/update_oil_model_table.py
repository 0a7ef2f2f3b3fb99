"""Write the table of the models that come with the package into their page of the manual."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from epicyclic import library
from epicyclic.contact.fitted_models import OilModel, read_oil_model

PAGE = Path(__file__).parents[1] / "docs" / "how-to" / "characterise-oil.md"
TABLE = re.compile(r"^\| Oil \|.*?\n\n", re.DOTALL | re.MULTILINE)
HEAD = (
    "Oil", "Contacts: teeth, rollers", "$R_{eq}$ up to, mm", "$R_q$ of flanks up to, µm",
    "Corrected", "Friction", "Rolling loss of teeth", "Rolling loss of rollers",
)  # fmt: skip


def table() -> str:
    """A row for each oil, in Markdown."""
    files = {name: library.oil_model_file(name) for name in library.names("oils")}
    rows = [_row(name, read_oil_model(file)) for name, file in files.items() if file]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (HEAD, ["---"] * len(HEAD), *rows))


def _row(name: str, model: OilModel) -> list[str]:
    designs = {
        part: [design for design in model.designs if design["part"] == part]
        for part in ("gear", "bearing")
    }
    contacts = [sum(design["size"] for design in each) for each in designs.values()]
    radii = [_highest(each, "radius") for each in designs.values()]
    forms = {quantity: fit.forms[0] for quantity, fit in model.fits.items()}
    errors = [form.errors[0] for form in forms.values()]
    return [
        f"`{name}`", *(", ".join(f"{number:g}" for number in pair) for pair in (contacts, radii)),
        f"{_highest(designs['gear'], 'roughness1'):g}",
        "no" if forms["friction"].nearby is None else "yes",
        *(f"{100 * one.median:.2g}, {100 * one.largest_of_90_percent:.2g} %" for one in errors),
    ]  # fmt: skip


def _highest(designs: list[dict[str, Any]], axis: str) -> float:
    limits: list[float] = [design["axes"][axis][1] for design in designs]
    return max(limits)


def main() -> None:
    text = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(TABLE.sub(lambda _: f"{table()}\n\n", text, count=1), encoding="utf-8")


if __name__ == "__main__":
    main()
