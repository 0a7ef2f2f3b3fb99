"""Write the table of measured figures and their bands into docs/validation.md, where it stands."""

from __future__ import annotations

import re
from pathlib import Path

from epicyclic.validation.compare import measured_figures
from epicyclic.validation.pages import band_markdown

PAGE = Path(__file__).parents[1] / "docs" / "validation.md"
TABLE = re.compile(r"^\| Measured figure \|.*?\n\n", re.DOTALL | re.MULTILINE)


def main() -> None:
    text = PAGE.read_text(encoding="utf-8")
    table = band_markdown(measured_figures())
    PAGE.write_text(TABLE.sub(f"{table}\n\n", text, count=1), encoding="utf-8")


if __name__ == "__main__":
    main()
