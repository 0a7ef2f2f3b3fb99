"""What commands show, and the pictures and pages that they write."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.errors import InputError, Problem
from epicyclic.whole_file import write_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import RenderableType

PICTURES = (".png", ".svg", ".pdf")
PAGE, PRINT = ".html", ".pdf"
SIZES = (30, 2000)
"""Smallest and largest size of a picture. [mm]"""
MILLIMETRES = {"mm": 1.0, "cm": 10.0, "in": 25.4}


def check_ending(option: str, path: Path, endings: Sequence[str] = PICTURES) -> None:
    """Raise `InputError` for a file that ends otherwise."""
    problems = wrong_ending(option, path, endings)
    if problems:
        raise InputError(problems, "the command")


def wrong_ending(option: str, path: Path, endings: Sequence[str]) -> list[Problem]:
    """The problem of a file that ends otherwise."""
    if path.suffix in endings:
        return []
    allowed = f"must end in {' or '.join(endings)}."
    return [Problem(option, str(path), allowed, "Name such a file.")]


def beside(path: Path, part: str) -> Path:
    """The file beside `path` for one part of what it is to hold."""
    return path.with_name(f"{path.stem}-{part}{path.suffix}")


def show(
    tables: Callable[[], RenderableType], as_json: Callable[[], str], json_file: str | None
) -> None:
    """Print tables, or JSON in their place if `json_file` is -; else write that file first."""
    if json_file == "-":
        click.echo(as_json())
        return
    from epicyclic.report.tables import terminal

    if json_file is not None:
        write_file(Path(json_file), as_json() + "\n")
        click.echo(f"Wrote {json_file}.")
    terminal().print(tables())


def parse_size(text: str) -> tuple[float, float]:
    """Width and height of a picture, ``"160x90 mm"``. [mm]"""
    low, high = SIZES
    match = re.fullmatch(r"\s*([\d.]+)\s*[x×*]\s*([\d.]+)\s*(mm|cm|in)\s*", text)
    if match:
        with suppress(ValueError):  # "1.2.3"
            scale = MILLIMETRES[match[3]]
            width, height = float(match[1]) * scale, float(match[2]) * scale
            if low <= min(width, height) and max(width, height) <= high:
                return width, height
    allowed = f"must be a width and a height of {low} to {high} mm, in mm, cm or in."
    problem = Problem("--size", f'"{text}"', allowed, 'For example "160x90 mm".')
    raise InputError([problem], "the command")


def draw(figure: Figure, path: Path, caption: str = "") -> None:
    """Write a picture, with its operating point below if it has none yet."""
    if caption:
        from epicyclic.plots.style import caption_below

        caption_below(figure, caption)
    write_file(path, picture_bytes(figure, path))
    click.echo(f"Wrote {path}.")


def picture_bytes(figure: Figure, path: Path) -> bytes:
    """What a file of the type of `path` holds of a figure."""
    from epicyclic.plots.style import figure_bytes

    return figure_bytes(figure, path.suffix[1:])


def check_page(path: Path) -> None:
    """Raise `InputError` if a page cannot be written to a file of this name."""
    check_ending("-o", path, (PAGE, PRINT))
    if path.suffix == PRINT:
        from epicyclic.report.pdf import check_pdf

        check_pdf()


def write_page(path: Path, page: str) -> None:
    """Write a page as it is, or printed to a PDF."""
    if path.suffix == PRINT:
        from epicyclic.report.pdf import report_pdf

        write_file(path, report_pdf(page))
    else:
        write_file(path, page)
    click.echo(f"Wrote {path}.")
