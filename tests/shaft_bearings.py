"""Shaft bearings of the size of a 6208, for tests of the models of their friction."""

from __future__ import annotations

import math

from epicyclic.losses.shaft_bearing import CatalogueBearing
from epicyclic.losses.skf_2018 import SkfModel, full_film_friction, skf_constants

RPM = math.pi / 30
BALL = CatalogueBearing("deep-groove", 40e-3, 80e-3, 18e-3, static_load_rating=19e3)
"""The size of a 6208."""
ROLLER = CatalogueBearing("cylindrical", 40e-3, 80e-3, 18e-3)
TAPER = CatalogueBearing("tapered", 40e-3, 80e-3, 18e-3, axial_factor=1.6)
NEEDLE = CatalogueBearing("needle", 40e-3, 55e-3, 20e-3, dynamic_load_rating=30e3)
SERIES = {"deep-groove": "62", "cylindrical": "2", "tapered": "302"}
PRINTED = 1e-6
"""Relative; the expected values were worked out separately and are given to seven digits."""


def skf(bearing, **changes):
    constants = skf_constants(bearing.type, SERIES[bearing.type], bearing.cage)
    return SkfModel(constants, full_film_friction(bearing.type, "mineral"), **changes)
