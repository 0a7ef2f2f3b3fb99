"""Outlines and places of gears, as drawings show them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.path import Path

import epicyclic as ep
from epicyclic.build.machine import build
from epicyclic.study.shapes import gear_shapes, mesh_views
from listed_trains import double_planet, layshaft, plus, ravigneaux, stepped, wolfrom

CHORD_ERROR = 0.02
"""By how much the chords of a drawn outline leave the curve, at most. [transverse modules]"""


def outline(gear, center, direction, smaller=0.0):
    """All teeth of a gear, the first one in `direction`, `smaller` by so much. [mm], [deg]"""
    one = (gear["x"].to_numpy() + 1j * gear["y"].to_numpy())[:-1]  # the next tooth goes on there
    teeth = int(gear.attrs["teeth"])
    turns = np.exp(1j * (2 * math.pi * np.arange(teeth) / teeth))
    turned = (turns[:, None] * one).ravel() * np.exp(1j * math.radians(direction - 90))
    return turned * (1 - smaller / np.abs(turned)) + complex(*center)


def module_of(gear):
    return float(gear["reference_diameter"]) / gear.attrs["teeth"]


def placed(gear, number):
    """A gear at one of its places, by the error of chords smaller: tips may touch roots."""
    place = gear.isel(place=number)
    center = float(place["center_x"]), float(place["center_y"])
    return outline(gear, center, float(place["direction"]), CHORD_ERROR * module_of(gear))


def inside(points, polygon):
    """How many of `points` lie in `polygon`."""
    closed = Path(np.column_stack([polygon.real, polygon.imag]))
    return int(closed.contains_points(np.column_stack([points.real, points.imag])).sum())


@pytest.mark.parametrize("name", ["talbot-2012", "talbot-2012-n6", "talbot-2012-pair"])
def test_drawn_teeth_stand_in_the_spaces_of_their_mates(name):
    gears = gear_shapes(ep.load_case(name))
    if "ring" not in gears:
        one, two = placed(gears["pinion"], 0), placed(gears["gear"], 0)
        assert inside(one, two) == inside(two, one) == 0
        return
    sun, ring = placed(gears["sun"], 0), placed(gears["ring"], 0)
    for number in range(gears["planet"].sizes["place"]):
        planet = placed(gears["planet"], number)
        assert inside(planet, sun) == inside(sun, planet) == 0
        # the outline of a ring gear encloses its spaces, and the whole planet
        assert inside(planet, ring) == planet.size


@pytest.mark.parametrize(
    "listed",
    [wolfrom, stepped, double_planet, ravigneaux, plus, layshaft],
    ids=lambda it: it.__name__,
)
def test_drawn_teeth_of_listed_gears_stand_in_the_spaces_of_all_their_mates(listed):
    case = ep.load_case(listed())
    gears = gear_shapes(case)
    (name,) = case.sets
    assert gears.keys() == {f"{name}.{gear}" for gear in case.sets[name].members}
    for mesh in build(case).sets[name].meshes:
        one, two = (gears[f"{name}.{gear.name}"] for gear in (mesh.mesh.gear1, mesh.mesh.gear2))
        count = max(one.sizes["place"], two.sizes["place"])
        for number in range(count):
            first, second = (placed(it, min(number, it.sizes["place"] - 1)) for it in (one, two))
            assert inside(second, first) == 0
            assert inside(first, second) == (first.size if two.attrs["internal"] else 0)


@pytest.mark.parametrize("key", ["sun_mesh", "ring_mesh"])
def test_the_teeth_of_a_view_touch_at_the_pitch_point_and_nowhere_overlap(talbot, key):
    gears, view = gear_shapes(talbot), mesh_views(talbot)[key]
    one, two = (
        outline(
            gears[str(place["gear"].values)],
            (float(place["center_x"]), float(place["center_y"])),
            float(place["direction"]),
        )
        for place in (view.isel(gear=0), view.isel(gear=1))
    )
    module = module_of(gears["sun"])
    for points in (one, two):
        start, end = points, np.roll(points, -1)
        along = np.clip(np.real(-start * np.conj(end - start)) / np.abs(end - start) ** 2, 0, 1)
        assert np.abs(start + along * (end - start)).min() < CHORD_ERROR * module
    center = complex(0.0, float(view["center_y"][0]))
    smaller = center + (one - center) * (1 - CHORD_ERROR * module / np.abs(one - center))
    assert inside(smaller, two) == (0 if key == "sun_mesh" else smaller.size)


def test_the_path_of_contact_lies_on_the_line_of_action_between_the_tip_circles(
    talbot, talbot_meshes
):
    for mesh, (key, view) in zip(talbot_meshes, mesh_views(talbot).items(), strict=True):
        x, y = view["path_x"].to_numpy(), view["path_y"].to_numpy()
        slope = math.tan(mesh.operating_pressure_angle)
        assert y == pytest.approx(slope * x), key
        assert np.hypot(x[1] - x[0], y[1] - y[0]) == pytest.approx(
            1e3 * mesh.transverse_contact_ratio * mesh.gear1.rack.transverse_base_pitch
        )
        # contact ends on the tip circle of member 1, and begins on that of member 2
        for end, gear in ((1, 0), (0, 1)):
            tip = (mesh.gear1, mesh.gear2)[gear].tip_radius
            height = y[end] - float(view["center_y"][gear])
            assert math.hypot(x[end], height) == pytest.approx(1e3 * tip)
