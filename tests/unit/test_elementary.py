"""Exponential and logarithm against those of the C library."""

from __future__ import annotations

import math

import numpy as np
import pytest

from epicyclic.arrays import of_points
from epicyclic.kernels.line_contact import exponential, exponentials, logarithm, logarithms, of_each

rng = np.random.default_rng(39)


@pytest.mark.parametrize(("low", "high"), [(-708, 709), (-2, 2), (-1e-6, 1e-7), (690, 709)])
def test_exponential_to_the_last_digits(low, high):
    values = rng.uniform(low, high, 10_007)
    exact = np.exp(values)
    assert (np.abs(exponentials(values) - exact) <= 2 * np.spacing(exact)).all()


@pytest.mark.parametrize(
    ("low", "high"), [(1e-299, 1e-290), (0.6, 1.7), (0.9999, 1.0002), (3, 1e9)]
)
def test_logarithm_to_the_last_digits(low, high):
    values = np.exp(rng.uniform(math.log(low), math.log(high), 10_007))
    exact = np.log(values)
    assert (np.abs(logarithms(values) - exact) <= 2 * np.spacing(np.abs(exact))).all()


def test_what_no_number_is_stays_so():
    """Callers look for what is not finite."""
    assert math.isnan(exponential(math.nan))
    assert math.isnan(logarithm(math.nan))
    assert exponential(709.5) == exponential(math.inf) == logarithm(math.inf) == math.inf
    assert 0 < exponential(-1e5) < 1e-300
    assert logarithm(0.0) == logarithm(-3.0) == pytest.approx(math.log(1e-300))


def test_any_shape_and_order():
    values = of_points(np.asfortranarray(rng.uniform(0.2, 5, (3, 7))))
    for found, exact in ((exponentials, np.exp), (logarithms, np.log)):
        several = of_each(found, values)
        assert type(several) is type(values)
        assert several == pytest.approx(exact(values), rel=1e-12)
        assert several[1, 4] == found(values[1, 4:5])[0]  # the same bits in any company
