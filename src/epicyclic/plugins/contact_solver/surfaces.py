"""Surface profiles: generated with given statistics, or measured, filtered and levelled."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import InputError, Problem, one_problem, raise_any
from epicyclic.files import check_archive, read_bytes, read_text, refuse

POINTS_PER_CORRELATION = 8  # Points of a generated profile within one correlation length.
PERIOD = 4000.0
"""Length of a generated profile over its correlation length: that of 200 has a friction of its own,
up to 10 % from that of other seeds. [1]"""
FEWEST_SAMPLES = 4  # Fewest samples of a period that a grid resolves.
GAUSSIAN = math.sqrt(math.log(2) / math.pi)
"""alpha of the Gaussian filter: half of a wave as long as the cutoff passes. [1]"""


@dataclass(frozen=True, eq=False)
class Profile:
    """Heights of a surface at even distances; it repeats itself."""

    heights: FloatArray  # With zero mean. [m]
    spacing: float  # [m]

    @property
    def length(self) -> float:
        """Length of one period. [m]"""
        return self.heights.size * self.spacing

    @property
    def rms(self) -> float:
        """Rq. [m]"""
        return float(np.sqrt(np.mean(self.heights**2)))

    @property
    def correlation_length(self) -> float:
        """Length of the Gaussian autocorrelation with the same slopes. Theory (H26). [m]"""
        slopes = (np.roll(self.heights, -1) - np.roll(self.heights, 1)) / (2 * self.spacing)
        return math.sqrt(2) * self.rms / float(np.sqrt(np.mean(slopes**2)))

    @property
    def skewness(self) -> float:
        """Rsk. [1]"""
        return float(np.mean(self.heights**3)) / self.rms**3

    @property
    def kurtosis(self) -> float:
        """Rku, 3 for a normal distribution. [1]"""
        return float(np.mean(self.heights**4)) / self.rms**4

    def scaled_to(self, rms: float) -> Profile:
        """The same shape with another Rq."""
        return Profile(self.heights * (rms / self.rms), self.spacing)

    def kept(self, spacing: float) -> float:
        """Share of Rq that a grid of `spacing` resolves; shorter waves are lost. [1]"""
        if self.rms == 0:
            return 1.0
        return Profile(self.resampled(spacing), spacing).rms / self.rms

    def resampled(self, spacing: float) -> FloatArray:
        """Heights at about `spacing`, without what that cannot resolve, shape (m,).

        The period is kept, so that the spacing is stretched by less than half a point in it. Of a
        period shorter than `FEWEST_SAMPLES` nothing is left: it would be stretched to a longer one.
        """
        count = round(self.length / spacing)
        if count < FEWEST_SAMPLES:
            return np.zeros(FEWEST_SAMPLES)
        spectrum = np.fft.rfft(self.heights)
        kept = np.zeros(count // 2 + 1, dtype=complex)
        shared = min(kept.size, spectrum.size)
        kept[:shared] = spectrum[:shared]
        if shared == kept.size and count % 2 == 0:
            kept[-1] = 0  # the highest wave has no phase on this grid
        heights: FloatArray = np.fft.irfft(kept, count) * (count / self.heights.size)
        return heights


SMOOTH = Profile(np.zeros(4), 1.0)  # No roughness.


def generate_profile(
    rms: float,  # Rq. [m]
    correlation_length: float,  # Where the autocorrelation exp(-(x/l)^2) has fallen to 1/e. [m]
    length: float,  # Length of the period. [m]
    seed: int,  # The same seed gives the same profile.
    skewness: float = 0.0,  # Rsk and Rku of the height distribution.
    kurtosis: float = 3.0,  # Rsk and Rku of the height distribution.
) -> Profile:
    """A random profile of given statistics. Theory (H26).

    Raises `InputError` if the statistics are impossible, or not reached by the sinh-arcsinh
    transformation.
    """
    _check_statistics(rms, correlation_length, length, skewness, kurtosis)
    if rms == 0:
        return SMOOTH
    count = 2 * math.ceil(length / correlation_length * POINTS_PER_CORRELATION / 2)
    rng = np.random.default_rng(seed)
    wave = 2 * math.pi * np.fft.rfftfreq(count, length / count)
    noise = rng.standard_normal(wave.size) + 1j * rng.standard_normal(wave.size)
    spectrum = noise * np.exp(-((wave * correlation_length) ** 2) / 8)
    spectrum[0] = 0
    normal = np.fft.irfft(spectrum, count)
    heights = _with_moments(normal / normal.std(), skewness, kurtosis)
    heights -= heights.mean()
    return Profile(heights * (rms / heights.std()), length / count)


def mean_line(
    heights: FloatArray,  # At even distances.
    spacing: float,  # In the same unit.
    cutoff: float,  # In the same unit.
) -> FloatArray:
    """What of a profile is longer than `cutoff`: the Gaussian filter. Theory (H32)."""
    from scipy.signal import fftconvolve

    reach = math.ceil(cutoff / spacing)  # the weight there is 7e-7 of the largest
    distance = np.arange(-reach, reach + 1) * (spacing / cutoff)
    weight = np.exp(-math.pi * (distance / GAUSSIAN) ** 2)
    mean: FloatArray = fftconvolve(heights, weight, "same") / fftconvolve(
        np.ones(heights.size), weight, "same"
    )
    return mean


def _check_statistics(
    rms: float, correlation_length: float, length: float, skewness: float, kurtosis: float
) -> None:
    checks = (
        ("rms", rms, rms >= 0, "must be zero or more.", "Change it."),
        ("correlation_length", correlation_length, correlation_length > 0, "must be > 0.",
         "Change it."),
        ("length", length, not correlation_length > 0 or length >= 4 * correlation_length,
         "is under four correlation lengths.", "Increase it."),
        ("kurtosis", kurtosis, kurtosis >= skewness**2 + 1, "cannot be less than 1 + skewness^2.",
         "Increase it."),
    )  # fmt: skip
    problems = (
        Problem(name, f"{value:g}", allowed, remedy)
        for name, value, is_met, allowed, remedy in checks
        if not is_met
    )
    raise_any(problems, "the roughness")


def _with_moments(normal: FloatArray, skewness: float, kurtosis: float) -> FloatArray:
    """Heights of other third and fourth moments in the order of the `normal` ones.

    Sinh-arcsinh transformation of Jones and Pewsey (2009), y = sinh((asinh(z) + e)/d), its two
    constants found for the sample. Theory (H26).
    """
    if skewness == 0 and kurtosis == 3:
        return normal
    from scipy.optimize import least_squares

    def transformed(constants: FloatArray) -> FloatArray:
        y = np.sinh((np.arcsinh(normal) + constants[0]) * math.exp(constants[1]))
        standard: FloatArray = (y - y.mean()) / y.std()
        return standard

    def lack(constants: FloatArray) -> FloatArray:
        y = transformed(constants)
        return np.array([np.mean(y**3) - skewness, np.mean(y**4) - kurtosis])

    found = least_squares(lack, np.zeros(2), bounds=([-5, -3], [5, 1.5]))
    if np.abs(found.fun).max() > 0.01:
        value = f"skewness {skewness:g}, kurtosis {kurtosis:g}"
        remedy = "Choose values closer to 0 and 3."
        raise one_problem("roughness", value, "cannot be reached.", remedy, "the roughness")
    return transformed(found.x)


# Measured surface profiles in files: CSV, or X3P of ISO 25178-72; levelled and filtered.


X3P = ".x3p"
LARGEST_FILE = 10_000_000  # Largest file of a measured profile. [bytes]
MOST_POINTS = 200_000  # Most points of a measured profile; those in print have some ten thousand.
FEWEST_POINTS = 16
EVEN = 0.01  # Largest deviation of a distance of points from the others. [1]
FLAT = 1e-12  # Rq that no instrument measures: what is less is a straight line. [m]
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

    Raises `InputError` if it cannot be read, has gaps or uneven positions, or nothing is left
    of it.
    """
    try:
        stat = path.stat()
    except (OSError, ValueError):
        return _read(path, cutoff, short_cutoff, ())  # says why
    # clocks jump: the time alone does not tell a file from one written later
    state = (stat.st_ino, stat.st_ctime_ns, stat.st_mtime_ns, stat.st_size)
    return _read(path, cutoff, short_cutoff, state)


@lru_cache(maxsize=16)
def _read(
    path: Path, cutoff: float | None, short_cutoff: float | None, _state: tuple[int, ...]
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
        raise one_problem("profile", str(path), "has no roughness left.", remedy, str(path))
    return profile


def _csv_points(path: Path) -> _Points:
    lines = read_text(path, "profile", LARGEST_FILE).splitlines()
    if len(lines) > MOST_POINTS:
        refuse(f"has more than {MOST_POINTS} lines.", "Shorten it.")
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
                refuse(f"must have two numbers in line {number}.", remedy)
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
        refuse(f"is not a valid X3P file: {' '.join(str(error).split())[:200]}.", "Save it again.")
    if not isinstance(file, x3pio.Profile) or len(file.layers) != 1:
        kind = type(file).__name__.lower()
        remedy = "Extract one profile along the motion and save that."
        refuse(f"is a {kind} of {len(file.layers)} layer(s), not one profile.", remedy)
    layer = file.layers[0]
    if layer.z.size > MOST_POINTS:
        refuse(f"has more than {MOST_POINTS} points.", "Shorten it.")
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
        refuse(f"has gaps: a number is missing {where}.", "Fill or cut them out.")
    steps = np.diff(points.x)
    usual = float(np.median(steps))
    uneven = np.flatnonzero(~(np.abs(steps - usual) < EVEN * abs(usual)))
    if uneven.size:
        first = int(uneven[0])
        found = (
            f"has positions at unequal distances: after {points.place(first)} the next is "
            f"{steps[first] / MILLIMETRE:.4g} mm away, elsewhere {usual / MILLIMETRE:.4g} mm."
        )
        refuse(found, "Fill the gap, or resample it at equal distances.")
    if not usual > 0:
        refuse("has falling positions.", "Reverse it.")
    return float(steps.mean())


def _check_cutoffs(
    length: float, spacing: float, cutoff: float | None, short_cutoff: float | None
) -> None:
    """Refuse cutoffs that the profile cannot be filtered with."""
    allowed = (
        f"must be between two point distances, {2 * spacing / MILLIMETRE:.4g} mm, and the "
        f"length of the profile, {length / MILLIMETRE:.4g} mm."
    )
    problems = [
        Problem(key, f"{value / MILLIMETRE:g} mm", allowed, "Change it or leave it out.")
        for key, value in (("cutoff", cutoff), ("short_cutoff", short_cutoff))
        if value is not None and not 2 * spacing <= value <= length
    ]
    if cutoff is not None and short_cutoff is not None and not short_cutoff < cutoff:
        given = f"{short_cutoff / MILLIMETRE:g} mm"
        allowed = "must be less than the cutoff of long waves."
        problems.append(Problem("short_cutoff", given, allowed, "Reduce it."))
    raise_any(problems, "the profile")
