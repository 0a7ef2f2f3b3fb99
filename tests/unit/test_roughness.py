"""Generated and measured surface profiles."""

from __future__ import annotations

import math

import numpy as np
import pytest

from epicyclic.ehl.roughness import SMOOTH, generate_profile, read_profile, sinusoidal_profile
from epicyclic.errors import InputError


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
    wave = sinusoidal_profile(1e-6, 1e-3)
    assert np.abs(wave.resampled(0.6e-3)).max() < 1.1e-6  # no alias
    assert SMOOTH.resampled(0.1) == pytest.approx(0)


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


def write(path, x, heights):
    lines = ["# Surface 1", "x [mm], z [um]"]
    lines += [f"{a:.6f}, {b:.6f}" for a, b in zip(x, heights, strict=True)]
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def test_measured_profile_is_levelled_and_filtered(tmp_path):
    x = np.arange(1000) * 1e-3  # mm
    wave, wide = np.cos(2 * np.pi * x / 0.05), np.cos(2 * np.pi * x / 0.5)
    file = write(tmp_path / "p.csv", x, 5 + 3 * x + 0.4 * wave + wide)
    profile = read_profile(file, cutoff=0.25e-3)
    assert profile.spacing == pytest.approx(1e-6)
    assert profile.rms == pytest.approx(0.4e-6 / math.sqrt(2), rel=0.01)
    assert read_profile(file).rms == pytest.approx(1e-6 * math.sqrt((0.4**2 + 1) / 2), rel=0.02)


def test_bad_profiles_are_refused(tmp_path):
    x = np.arange(100) * 1e-3
    gap = np.where(np.arange(100) == 50, math.nan, 0.0)
    for heights, positions, what in (
        (gap, x, "gaps"),
        (0 * x, x**2, "uneven"),
        (0 * x[:10], x[:10], "10 points"),
    ):
        with pytest.raises(InputError, match=what):
            read_profile(write(tmp_path / "bad.csv", positions, heights))
    with pytest.raises(InputError, match="cannot be read"):
        read_profile(tmp_path / "none.csv")
    (tmp_path / "one.csv").write_text("1\n2\n", encoding="utf-8")
    with pytest.raises(InputError, match="two numbers"):
        read_profile(tmp_path / "one.csv")
