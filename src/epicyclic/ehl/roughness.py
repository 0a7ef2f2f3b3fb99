"""Surface profiles: generated with given statistics; filtered."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.errors import InputError, Problem

FloatArray = NDArray[np.float64]

POINTS_PER_CORRELATION = 8
"""Points of a generated profile within one correlation length."""
PERIOD = 4000.0
"""Length of a generated profile over its correlation length: that of 200 has a friction of its own,
up to 10 % from that of other seeds. [1]"""
FEWEST_SAMPLES = 4
"""Fewest samples of a period that a grid resolves."""
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


SMOOTH = Profile(np.zeros(4), 1.0)
"""No roughness."""


def sinusoidal_profile(amplitude: float, wavelength: float) -> Profile:
    """One wave. `amplitude` from its mean line. [m]"""
    points = 64
    phase = np.arange(points) * (2 * math.pi / points)
    return Profile(amplitude * np.cos(phase), wavelength / points)


def generate_profile(
    rms: float,  # Rq. [m]
    correlation_length: float,  # Where the autocorrelation exp(-(x/l)^2) has fallen to 1/e. [m]
    length: float,  # Length of the period. [m]
    seed: int,  # The same seed gives the same profile.
    skewness: float = 0.0,  # Rsk and Rku of the height distribution.
    kurtosis: float = 3.0,  # Rsk and Rku of the height distribution.
) -> Profile:
    """A random profile of given statistics. Theory (H26).

    Raises
    ------
    InputError
        If the statistics are impossible, or not reached by the sinh-arcsinh transformation.
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
    problems = []
    if not rms >= 0:
        problems.append(Problem("rms", f"{rms:g}", "must be zero or more.", "Change it."))
    if not correlation_length > 0:
        problems.append(
            Problem("correlation_length", f"{correlation_length:g}", "must be > 0.", "Change it.")
        )
    elif not length >= 4 * correlation_length:
        problems.append(
            Problem("length", f"{length:g}", "is under four correlation lengths.", "Increase it.")
        )
    if not kurtosis >= skewness**2 + 1:
        problems.append(
            Problem(
                "kurtosis", f"{kurtosis:g}", "cannot be less than 1 + skewness^2.", "Increase it."
            )
        )
    if problems:
        raise InputError(problems, "the roughness")


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
        raise InputError(
            [Problem("roughness", value, "cannot be reached.", "Bring them nearer to 0 and 3.")],
            "the roughness",
        )
    return transformed(found.x)
