"""Drawings that turn: gears at the speeds of their teeth, positions as layers of their own."""

from __future__ import annotations

import io

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.show.plots.drawing import POSITION, turning_mesh, turning_set
from epicyclic.study.shapes import gear_shapes, mesh_views

FEW_POINTS = {"numerics.mesh_positions": 7, "numerics.contact_segments": 6}
"""Of the loads on the teeth: every position is drawn."""


@pytest.fixture(scope="module")
def drawn(talbot):
    meshes = ep.mesh_details(talbot.updated(FEW_POINTS))
    return gear_shapes(talbot), mesh_views(talbot), meshes


def test_relative_speeds_are_those_of_the_teeth(talbot, drawn):
    speeds = {name: gear.attrs["relative_speed"] for name, gear in drawn[0].items()}
    sun, planet, ring = (getattr(talbot, name).teeth for name in ("sun", "planet", "ring"))
    assert speeds == pytest.approx({"sun": 1, "planet": -sun / planet, "ring": -sun / ring})


def test_gears_of_one_body_turn_together():
    gears = gear_shapes(ep.load_case("train-eaxle"))
    teeth = {name: int(gear.attrs["teeth"]) for name, gear in gears.items()}
    speed = gears["pair.gear"].attrs["relative_speed"]
    assert speed == pytest.approx(-teeth["pair.pinion"] / teeth["pair.gear"])
    assert gears["planets.sun"].attrs["relative_speed"] == 1


def test_every_gear_of_a_set_is_a_layer_that_turns_about_its_centre(drawn):
    turning = turning_set(drawn[0], "A set", "")
    svg = io.StringIO()
    turning.figure.savefig(svg, format="svg")
    layers = {layer.name: layer for layer in turning.layers()}
    assert len(layers) == 5
    for name in layers:
        assert f'id="{name}"' in svg.getvalue()
    sun, up = layers["gear-sun-0"], layers["gear-planet-0"]
    assert up.x == pytest.approx(sun.x, abs=0.5)  # the first planet stands above the sun
    assert up.y < sun.y
    assert sun.rate * 73 == pytest.approx(360)
    assert up.rate * 26 == pytest.approx(-360)


def test_a_later_phase_is_drawn_as_a_page_would_turn_it(drawn):
    gears, views, meshes = drawn
    mesh = meshes["sun_mesh"]
    still = turning_mesh(views["sun_mesh"], gears, mesh, "", "", phase=0.25)
    for gear in still.gears:
        assert gear.start == pytest.approx(-0.25 * gear.rate), gear.name


@pytest.mark.slow
def test_teeth_touch_where_the_load_is(drawn):
    """The turned outlines of both gears pass through the points that carry, on the line of action.

    The tolerance is a hundredth of a tooth's height: outlines are polygons.
    """
    gears, views, meshes = drawn
    for key, mesh in meshes.items():
        view = views[key]
        turning = turning_mesh(view, gears, mesh, "", "", phase=0.4)
        points = next(
            one.get_offsets()
            for one in turning.ax.collections
            if str(one.get_gid()).endswith("points")
        )
        outlines = [
            patch.get_path().vertices
            for patch in turning.ax.patches
            if str(patch.get_gid()).startswith("gear-")
        ]
        number = int(np.argmin(np.abs(np.array(turning.phases) - 0.4)))
        moved = (0.4 - turning.phases[number]) * float(mesh.attrs["pitch_angle_deg"])
        base = float(gears[str(view["gear"].values[0])]["base_diameter"]) / 2
        slip = base * np.radians(moved)  # the position shown is the nearest, the gears turn evenly
        alpha = np.radians(float(view["pressure_angle"]))
        along = np.array([np.cos(alpha), np.sin(alpha)])
        for outline in outlines:
            for point in points + slip * along:
                assert _distance(outline, point) < 0.04


def _distance(outline, point):
    """From a point to a polygon. [mm]"""
    start, side = outline[:-1], np.diff(outline, axis=0)
    length = np.maximum((side**2).sum(axis=1), 1e-12)
    share = np.clip(((point - start) * side).sum(axis=1) / length, 0, 1)
    return np.hypot(*(start + share[:, None] * side - point).T).min()


def test_every_position_is_a_layer(drawn):
    gears, views, meshes = drawn
    mesh = meshes["ring_mesh"]
    turning = turning_mesh(views["ring_mesh"], gears, mesh, "A mesh", "")
    svg = io.StringIO()
    turning.figure.savefig(svg, format="svg")
    assert len(turning.phases) == mesh.sizes["mesh_position"]
    for number in range(len(turning.phases)):
        for part in ("points", "lines"):
            assert f'id="{POSITION}-{number}-{part}"' in svg.getvalue()
