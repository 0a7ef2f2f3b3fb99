"""Generated surface profiles, and the filter of measured ones."""

from __future__ import annotations

import math

import numpy as np
import pytest

from contacts import sinusoidal_profile
from epicyclic.errors import InputError
from epicyclic.plugins.contact_solver.surfaces import SMOOTH, Profile, generate_profile, mean_line


@pytest.mark.parametrize(("skewness", "kurtosis"), [(0.0, 3.0), (-1.0, 5.0), (0.5, 4.0), (0, 2.5)])
def test_generated_profile_has_the_statistics_asked_for(skewness, kurtosis):
    profile = generate_profile(0.4e-6, 20e-6, 8e-3, 1, skewness, kurtosis)
    assert profile.rms == pytest.approx(0.4e-6, rel=1e-12)
    assert profile.heights.mean() == pytest.approx(0, abs=1e-18)
    # a normal profile is left as drawn: 400 lengths scatter by some 6/sqrt(400)
    scatter = 0.3 if (skewness, kurtosis) == (0, 3) else 0.02
    assert profile.skewness == pytest.approx(skewness, abs=scatter)
    assert profile.kurtosis == pytest.approx(kurtosis, abs=scatter)


def test_autocorrelation_falls_to_1_over_e_at_the_correlation_length():
    length = 20e-6
    profile = generate_profile(1e-6, length, 40e-3, 2)
    lag = round(length / profile.spacing)
    correlation = np.mean(profile.heights * np.roll(profile.heights, lag)) / profile.rms**2
    assert correlation == pytest.approx(math.exp(-1), abs=0.05)  # 2000 lengths


def test_seeds_repeat_and_differ():
    first, again, other = (generate_profile(1e-7, 1e-5, 1e-3, seed) for seed in (4, 4, 5))
    assert (first.heights == again.heights).all()
    assert (first.heights != other.heights).any()


def test_scaling_keeps_the_shape():
    profile = generate_profile(1e-7, 1e-5, 1e-3, 4)
    scaled = profile.scaled_to(3e-7)
    assert scaled.rms == pytest.approx(3e-7)
    assert scaled.heights == pytest.approx(3 * profile.heights)


@pytest.mark.parametrize("count", [20, 64, 301])
def test_resampling_keeps_what_the_spacing_resolves(count):
    wave = sinusoidal_profile(1e-6, 1e-3)
    heights = wave.resampled(1e-3 / count)
    assert heights == pytest.approx(1e-6 * np.cos(2 * np.pi * np.arange(count) / count), abs=1e-12)


def test_resampling_drops_waves_it_cannot_resolve():
    # waves 10 and 70 of a period of 1024 points; at 8 points apart there are 128, up to wave 64
    phase = 2 * np.pi * np.arange(1024) / 1024
    profile = Profile(1e-6 * (np.cos(10 * phase) + np.cos(70 * phase)), 1e-6)
    left = 1e-6 * np.cos(10 * phase[::8])
    assert profile.resampled(8e-6) == pytest.approx(left, abs=1e-15)
    assert SMOOTH.resampled(0.1) == pytest.approx(0)


@pytest.mark.parametrize("spacing", [0.3e-3, 0.6e-3, 5e-3])
def test_a_period_that_is_not_resolved_is_not_stretched_to_a_longer_one(spacing):
    assert not sinusoidal_profile(1e-6, 1e-3).resampled(spacing).any()


def test_no_height_is_smooth():
    assert generate_profile(0.0, 1e-5, 1e-3, 1).rms == 0


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ((-1e-7, 1e-5, 1e-3, 1), "rms"),
        ((1e-7, 0.0, 1e-3, 1), "correlation_length"),
        ((1e-7, 1e-5, 2e-5, 1), "length"),
        ((1e-7, 1e-5, 1e-3, 1, 2.0, 3.0), "kurtosis"),
        ((1e-7, 1e-5, 1e-3, 1, 0.0, 1.01), "roughness"),
    ],
)
def test_impossible_statistics_are_refused(arguments, key):
    with pytest.raises(InputError) as error:
        generate_profile(*arguments)
    assert key in {problem.key for problem in error.value.problems}


@pytest.mark.parametrize("length", [0.5, 1.0, 2.0])
def test_the_gaussian_filter_passes_half_of_a_wave_as_long_as_its_cutoff(length):
    spacing, cutoff = 1e-6, 0.25e-3
    x = spacing * np.arange(4000)
    wave = np.cos(2 * np.pi * x / (length * cutoff))
    inner = slice(500, -500)  # two cutoffs from the ends, where the weight is 1e-24
    passed = 2.0 ** -(1 / length**2)  # ISO 16610-21
    # sums at 250 points a cutoff are as good as the integral
    assert mean_line(wave, spacing, cutoff)[inner] == pytest.approx(passed * wave[inner], abs=1e-6)


def test_the_gaussian_filter_keeps_a_constant_to_the_ends():
    assert mean_line(np.ones(300), 1e-6, 0.1e-3) == pytest.approx(1, rel=1e-9)
