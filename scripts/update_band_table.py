"""Write the tables of bands and of missed figures into docs/validation.md, where they stand."""

from __future__ import annotations

import re
from pathlib import Path

from epicyclic.validation.compare import compare_published, measured_figures
from epicyclic.validation.pages import band_markdown, missed_markdown

PAGE = Path(__file__).parents[1] / "docs" / "validation.md"
TABLE = r"^\| {} \|.*?\n\n"


def main() -> None:
    text = PAGE.read_text(encoding="utf-8")
    for head, table in (
        ("Figure", missed_markdown(compare_published())),
        ("Measured figure", band_markdown(measured_figures())),
    ):
        (old,) = re.findall(TABLE.format(head), text, re.DOTALL | re.MULTILINE)
        text = text.replace(old, f"{table}\n\n")
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
