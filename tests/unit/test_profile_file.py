"""Measured profiles from files: read, levelled, filtered, or refused with the place."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest
import x3pio

from epicyclic.errors import InputError
from epicyclic.plugins.contact_solver.surfaces import read_profile

X = np.arange(2000) * 1e-3  # mm
SHORT, LONG = np.cos(2 * np.pi * X / 0.01), np.cos(2 * np.pi * X / 1.0)
MIDDLE = 0.4 * np.cos(2 * np.pi * X / 0.1)


def write(path, x, heights, form="{:.6f}, {:.6f}"):
    lines = ["# Surface 1", "x [mm], z [um]"]
    lines += [form.format(a, b) for a, b in zip(x, heights, strict=True)]
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def test_a_profile_is_levelled(tmp_path):
    profile = read_profile(write(tmp_path / "p.csv", X, 5 + 3 * X + MIDDLE))
    assert profile.spacing == pytest.approx(1e-6)
    assert profile.rms == pytest.approx(0.4e-6 / math.sqrt(2), rel=1e-3)
    assert profile.correlation_length == pytest.approx(
        math.sqrt(2) / (2 * np.pi) * 0.1e-3, rel=0.01
    )


def test_long_and_short_waves_are_filtered_off(tmp_path):
    file = write(tmp_path / "p.csv", X, SHORT + MIDDLE + LONG)
    profile = read_profile(file, cutoff=0.25e-3, short_cutoff=0.025e-3)
    inner = slice(250, -250)
    # a wave of length l passes the filter with 2^-(cutoff/l)^2
    long = 1 - 2.0 ** -((0.25 / 1.0) ** 2)
    short = 2.0 ** -((0.025 / 0.01) ** 2)
    middle = (1 - 2.0 ** -((0.25 / 0.1) ** 2)) * 2.0 ** -((0.025 / 0.1) ** 2)
    expected = 1e-6 * (long * LONG + short * SHORT + middle * MIDDLE)
    # but for the mean of the whole, with its ends; the line through a cosine rises by a thousandth
    assert np.ptp((profile.heights - expected)[inner]) < 2e-9


@pytest.mark.parametrize(
    "form", ["{:.6f};{:.6f}", "{:.6f}\t{:.6f}", "{:.6f}  {:.6f}", "{:.6f}, {:.6f}, 7", "comma"]
)
def test_columns_are_told_apart(tmp_path, form):
    file = write(tmp_path / "p.csv", X, MIDDLE, "{:.6f};{:.6f}" if form == "comma" else form)
    if form == "comma":
        text = file.read_text(encoding="utf-8").replace(".", ",")
        file.write_text(text.replace("x [mm], z", "x [mm]; z"), encoding="utf-8")
    whole = read_profile(write(tmp_path / "whole.csv", X, MIDDLE))
    assert read_profile(file).heights == pytest.approx(whole.heights, abs=1e-12)


GAP = np.where(np.arange(100) == 50, math.nan, np.sin(np.arange(100)))


@pytest.mark.parametrize(
    ("x", "heights", "told"),
    [
        (X[:100], GAP, "gaps: a number is missing at line 53"),
        (np.delete(X[:100], 50), np.delete(GAP, 50), "after line 52 the next is 0.002 mm away"),
        (X[:100] ** 2, np.sin(X[:100]), "positions at unequal distances"),
        (-X[:100], np.sin(X[:100]), "falling"),
        (X[:10], X[:10], "10 points"),
        (X[:100], 3 * X[:100], "no roughness"),
    ],
)
def test_bad_profiles_are_refused(tmp_path, x, heights, told):
    with pytest.raises(InputError, match=told) as error:
        read_profile(write(tmp_path / "bad.csv", x, heights))
    assert error.value.problems[0].key == "profile"


def test_missing_and_odd_files_are_refused(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_profile(tmp_path / "none.csv")
    (tmp_path / "one.csv").write_text("1\n2\n", encoding="utf-8")
    with pytest.raises(InputError, match="two numbers in line 1"):
        read_profile(tmp_path / "one.csv")


def test_every_cutoff_that_cannot_be_is_told(tmp_path):
    file = write(tmp_path / "p.csv", X, MIDDLE)
    with pytest.raises(InputError) as error:
        read_profile(file, cutoff=3e-3, short_cutoff=1e-6)
    assert [problem.key for problem in error.value.problems] == ["cutoff", "short_cutoff"]
    with pytest.raises(InputError, match="less than the cutoff"):
        read_profile(file, cutoff=0.1e-3, short_cutoff=0.2e-3)


def test_a_changed_file_is_read_again(tmp_path):
    first = read_profile(write(tmp_path / "p.csv", X, MIDDLE)).rms
    assert read_profile(write(tmp_path / "p.csv", X, 10 * MIDDLE)).rms == pytest.approx(10 * first)


def test_an_x3p_profile_is_that_of_its_heights(tmp_path):
    heights = 1e-6 * (MIDDLE + 2 * X)
    x3pio.write(tmp_path / "p.x3p", heights, x_scale=1e-6)
    profile = read_profile(tmp_path / "p.x3p", cutoff=0.25e-3)
    same = read_profile(write(tmp_path / "p.csv", X, MIDDLE + 2 * X), cutoff=0.25e-3)
    assert profile.spacing == pytest.approx(1e-6)
    assert profile.heights == pytest.approx(same.heights, abs=1e-12)  # six decimals of um


def test_x3p_files_need_their_package(tmp_path, monkeypatch):
    x3pio.write(tmp_path / "p.x3p", 1e-6 * MIDDLE, x_scale=1e-6)
    monkeypatch.setitem(sys.modules, "x3pio", None)  # as if it were not installed
    with pytest.raises(InputError, match=r'Install "epicyclic\[x3p\]"'):
        read_profile(tmp_path / "p.x3p")


def test_x3p_files_without_one_whole_profile_are_refused(tmp_path):
    file = tmp_path / "p.x3p"
    x3pio.write(file, np.zeros((20, 30)), x_scale=1e-6, y_scale=1e-6)
    with pytest.raises(InputError, match="is a surface"):
        read_profile(file)
    x3pio.Profile.from_layers([np.zeros(50), np.ones(50)], x_scale=1e-6).save(file)
    with pytest.raises(InputError, match="2 layer"):
        read_profile(file)
    x3pio.write(file, 1e-6 * GAP, x_scale=1e-6)
    with pytest.raises(InputError, match="a number is missing at point 51"):
        read_profile(file)
    file.write_bytes(file.read_bytes()[:-40])
    with pytest.raises(InputError, match="X3P file"):
        read_profile(file)
