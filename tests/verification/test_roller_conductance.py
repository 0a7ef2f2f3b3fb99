"""Heat through the rollers of a planet bearing: the potential in a roller, and a real bearing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from epicyclic.build.gear_sets import roller_bearing
from epicyclic.build.machine import build
from epicyclic.kernels.line_contact import hertz_half_width
from epicyclic.losses.planet_bearing import roller_loads
from epicyclic.machine.convection import roller_conductance

STEEL = 45.0
"""Thermal conductivity. [W/(m K)]"""


def test_roller_between_races_by_finite_strips():
    """Boundary integral in two dimensions: strips at even temperature on a circle and half-planes.

    Potential of a strip on a smooth boundary: -q ln(s)/(pi lambda) of each of its pieces, twice
    that of free space. The circle has both strips, a race one strip in a row without end, whose
    potential is ln|2 sin(pi s/pitch)|.
    """
    radius, half_width, pitch = 1.25e-3, 40e-6, 3.2e-3
    edges = half_width * np.cos(np.linspace(np.pi, 0, 401))  # finer towards the ends
    middle, width = (edges[1:] + edges[:-1]) / 2, np.diff(edges)
    apart, mean = middle[:, None] - middle, (middle[:, None] + middle) / 2

    def logarithm(distance):
        """Of the distance of two pieces; of a piece from itself the mean over it."""
        np.fill_diagonal(distance, width / (2 * math.e))
        return np.log(distance)

    def resistance(potential):
        """Temperature of an evenly warm strip over the heat through it; conductivity 1."""
        flux = np.linalg.solve(potential / math.pi * width, np.ones(width.size))
        return 1 / (flux @ width)

    chord = 2 * radius * np.abs(np.sin(apart / (2 * radius)))
    across = 2 * radius * np.cos(mean / radius)
    # as warm as the other strip is cold
    roller = 2 * resistance(np.log(across) - logarithm(chord))
    # far from the race the potential of the row has the mean 0
    row = pitch / math.pi * np.abs(np.sin(np.pi * apart / pitch))
    race = resistance(math.log(pitch / (2 * math.pi)) - logarithm(row))
    length = 20e-3
    expected = STEEL * length / (roller + 2 * race)
    strip = np.array([half_width])
    found = roller_conductance(strip, strip, length, 2 * radius, pitch, pitch, STEEL)
    # strips that are narrow beside roller and pitch; 400 pieces
    assert found == pytest.approx(expected, rel=2e-3)


def test_planet_bearing_of_the_test_article(talbot):
    bearing = roller_bearing(talbot.planet_bearing, talbot.numerics)
    load = build(talbot).planet_loads()["planet_bearing"]
    loads = roller_loads(bearing, load.force, 0.0, load.moment_x, load.moment_y)
    inner, outer = (
        hertz_half_width(loads.intensity, radius, bearing.equivalent_modulus)
        for radius in (bearing.inner_radius, bearing.outer_radius)
    )
    found = roller_conductance(
        inner,
        outer,
        bearing.roller_length / bearing.slices,
        bearing.roller_diameter,
        math.pi * bearing.inner_diameter / bearing.rollers_per_row,
        math.pi * bearing.outer_diameter / bearing.rollers_per_row,
        STEEL,
    )
    assert found == pytest.approx(1.05, abs=0.005)  # as the theory manual says
