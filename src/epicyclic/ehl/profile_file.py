"""Measured surface profiles in files: CSV, or X3P of ISO 25178-72; levelled and filtered."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from epicyclic.ehl.roughness import Profile, mean_line
from epicyclic.errors import InputError, Problem
from epicyclic.text_file import check_archive, read_bytes, read_text, refuse

FloatArray = NDArray[np.float64]

X3P = ".x3p"
LARGEST_FILE = 10_000_000
"""Largest file of a measured profile. [bytes]"""
MOST_POINTS = 200_000
"""Most points of a measured profile; those in print have some ten thousand."""
FEWEST_POINTS = 16
EVEN = 0.01
"""Largest deviation of a distance of points from the others. [1]"""
FLAT = 1e-12
"""Rq that no instrument measures: what is less is a straight line. [m]"""
MILLIMETRE, MICROMETRE = 1e-3, 1e-6


class _Points(NamedTuple):
    """Positions and heights [m], and where each point stands in the file: ``"line"``, numbers."""

    x: FloatArray
    heights: FloatArray
    noun: str
    numbers: Sequence[int]

    def place(self, index: int) -> str:
        return f"{self.noun} {self.numbers[index]}"


def read_profile(
    # An X3P file, or CSV with position in mm and height in um in its first two columns; there lines
    # that start with # or letters are skipped.
    path: Path,
    # cutoff, short_cutoff: lambda_c and lambda_s: longer and shorter waves are taken off. [m]
    cutoff: float | None = None,
    short_cutoff: float | None = None,
) -> Profile:
    """A measured profile, the straight line through it taken off. Theory (H32).

    Raises
    ------
    InputError
        If it cannot be read, has gaps or uneven positions, or nothing is left of it.
    """
    try:
        stat = path.stat()
    except (OSError, ValueError):
        return _read(path, cutoff, short_cutoff, 0, 0)  # says why
    return _read(path, cutoff, short_cutoff, stat.st_mtime_ns, stat.st_size)


@lru_cache(maxsize=16)
def _read(
    path: Path, cutoff: float | None, short_cutoff: float | None, _changed: int, _size: int
) -> Profile:
    """The file as it was when it was last changed."""
    try:
        points = _x3p_points(path) if path.suffix.lower() == X3P else _csv_points(path)
        spacing = _spacing(points)
    except InputError as error:
        problem = replace(error.problems[0], key="profile", value=str(path))
        raise InputError([problem], str(path)) from None
    _check_cutoffs(points.x.size * spacing, spacing, cutoff, short_cutoff)
    x = np.arange(points.x.size) * spacing
    heights = points.heights - np.polyval(np.polyfit(x, points.heights, 1), x)
    if cutoff is not None:
        heights = heights - mean_line(heights, spacing, cutoff)
    if short_cutoff is not None:
        heights = mean_line(heights, spacing, short_cutoff)
    profile = Profile(heights - heights.mean(), spacing)
    if profile.rms < FLAT:
        remedy = "Give another file, or none for a smooth surface."
        problem = Problem("profile", str(path), "has no roughness that is left.", remedy)
        raise InputError([problem], str(path))
    return profile


def _csv_points(path: Path) -> _Points:
    lines = read_text(path, "profile", LARGEST_FILE).splitlines()
    if len(lines) > MOST_POINTS:
        refuse(f"has more than {MOST_POINTS} lines.", "Cut it.")
    rows, numbers = [], []
    for number, line in enumerate(lines, 1):
        if _is_data(line):
            cells = _cells(line)
            try:
                rows.append([float(cell) if cell.strip() else math.nan for cell in cells[:2]])
            except ValueError:
                rows.append([])
            if len(rows[-1]) != 2:
                remedy = "Write position in mm, height in um."
                refuse(f"has something else than two numbers in line {number}.", remedy)
            numbers.append(number)
    table = np.array(rows, dtype=float).reshape(-1, 2)
    return _Points(table[:, 0] * MILLIMETRE, table[:, 1] * MICROMETRE, "line", numbers)


def _is_data(line: str) -> bool:
    text = line.strip()
    return bool(text) and (text[0].isdigit() or text[0] in "+-.,;" or text[:3].lower() == "nan")


def _cells(line: str) -> list[str]:
    """The columns of a line; with semicolons or tabs between them decimals may have commas."""
    for separator in (";", "\t"):
        if separator in line:
            return line.replace(",", ".").split(separator)
    return line.split(",") if "," in line else line.split()


def _x3p_points(path: Path) -> _Points:
    try:
        import x3pio
    except ImportError:
        refuse("needs the package x3pio.", 'Install "epicyclic[x3p]", or give CSV.')
    content = read_bytes(path, "profile", LARGEST_FILE)
    check_archive(content, "an X3P file", LARGEST_FILE, "Save one profile, or give CSV.")
    try:
        file = x3pio.read(io.BytesIO(content))
    except Exception as error:  # the reader raises whatever its parsers do
        refuse(f"is no sound X3P file: {' '.join(str(error).split())[:200]}.", "Save it again.")
    if not isinstance(file, x3pio.Profile) or len(file.layers) != 1:
        kind = type(file).__name__.lower()
        remedy = "Extract one profile along the motion and save that."
        refuse(f"is a {kind} of {len(file.layers)} layer(s), not one profile.", remedy)
    layer = file.layers[0]
    if layer.z.size > MOST_POINTS:
        refuse(f"has more than {MOST_POINTS} points.", "Cut it.")
    x, heights = np.array(layer.x_values, dtype=float), np.array(layer.z, dtype=float)
    return _Points(x, heights, "point", range(1, heights.size + 1))


def _spacing(points: _Points) -> float:
    """The distance of the points, if it is even. [m]"""
    count = points.x.size
    if count < FEWEST_POINTS:
        refuse(f"has {count} points.", f"Give {FEWEST_POINTS} or more.")
    gaps = np.flatnonzero(~(np.isfinite(points.x) & np.isfinite(points.heights)))
    if gaps.size:
        more = f" and {gaps.size - 1} more" if gaps.size > 1 else ""
        where = f"at {points.place(gaps[0])}{more}"
        refuse(f"has gaps: no number {where}.", "Fill or cut them out.")
    steps = np.diff(points.x)
    usual = float(np.median(steps))
    uneven = np.flatnonzero(~(np.abs(steps - usual) < EVEN * abs(usual)))
    if uneven.size:
        first = int(uneven[0])
        found = (
            f"has uneven positions: after {points.place(first)} the next is "
            f"{steps[first] / MILLIMETRE:.4g} mm away, elsewhere {usual / MILLIMETRE:.4g} mm."
        )
        refuse(found, "Fill the gap, or resample it evenly.")
    if not usual > 0:
        refuse("has falling positions.", "Turn it round.")
    return float(steps.mean())


def _check_cutoffs(
    length: float, spacing: float, cutoff: float | None, short_cutoff: float | None
) -> None:
    """Refuse cutoffs that the profile cannot be filtered with."""
    problems = [
        Problem(
            key, f"{value / MILLIMETRE:g} mm",
            f"must be from two distances of points, {2 * spacing / MILLIMETRE:.4g} mm, to the "
            f"length of the profile, {length / MILLIMETRE:.4g} mm.",
            "Change it or leave it out.",
        )
        for key, value in (("cutoff", cutoff), ("short_cutoff", short_cutoff))
        if value is not None and not 2 * spacing <= value <= length
    ]  # fmt: skip
    if cutoff is not None and short_cutoff is not None and not short_cutoff < cutoff:
        given = f"{short_cutoff / MILLIMETRE:g} mm"
        allowed = "must be less than the cutoff of long waves."
        problems.append(Problem("short_cutoff", given, allowed, "Reduce it."))
    if problems:
        raise InputError(problems, "the profile")
