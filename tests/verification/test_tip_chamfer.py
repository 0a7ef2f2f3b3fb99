"""Tip chamfers: outlines, pockets, path of contact and pocketing loss."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

import epicyclic as ep
from epicyclic.losses.pocket_flow import pocket_flow
from epicyclic.losses.pocket_geometry import pocket_geometry
from epicyclic.oil.oil import MixtureState

SHARP = (None, None)
"""The default tools."""

HEIGHT = 0.2e-3
"""A tenth of the module of the meshes here."""


def chamfered(mesh, height1, height2):
    return replace(
        mesh,
        gear1=replace(mesh.gear1, tip_chamfer=height1),
        gear2=replace(mesh.gear2, tip_chamfer=height2),
    )


def power(mesh, rpm=5000.0, xi=0.05, **kwargs):
    mixture = MixtureState(xi, xi * 824.1 + (1 - xi) * 0.972, 0.0)
    return pocket_flow(
        pocket_geometry(mesh, SHARP, True), rpm * math.pi / 30, mixture, 101325.0, **kwargs
    ).power


def chamfer_area(gear):
    """Section of one chamfer between the sharp tooth and its chord, in polar coordinates."""
    start, end = gear.half_angle_at(gear.tip_form_radius), gear.tip_half_angle
    outward = -1 if gear.internal else 1
    flank, _ = quad(
        lambda r: r * (gear.half_angle_at(r) - end), gear.tip_form_radius, gear.tip_radius
    )
    triangle = gear.tip_form_radius * gear.tip_radius * math.sin(start - end) / 2
    wedge = gear.tip_form_radius**2 * (start - end) / 2
    return outward * flank - outward * (triangle - wedge)


@pytest.mark.parametrize("internal", [False, True])
@pytest.mark.parametrize("member", [1, 2])
def test_pockets_grow_by_the_chamfers(make_mesh, internal, member):
    mesh = make_mesh(24, 60, internal=internal, x1=0.2, x2=-0.2)
    heights = (HEIGHT, 0.0) if member == 1 else (0.0, HEIGHT)
    other = chamfered(mesh, *heights)
    sharp, broken = (pocket_geometry(item, SHARP, True) for item in (mesh, other))
    gear = other.gear1 if member == 1 else other.gear2
    # on the line of centres both gaps lie on the flanks, away from the tips
    area = [
        np.interp(0.0, item.angle[member - 1], item.area[member - 1]) for item in (sharp, broken)
    ]
    # the outlines are chords, and angles of both tables differ: their errors do not cancel fully
    assert area[1] - area[0] == pytest.approx(2 * chamfer_area(gear), rel=0.01)


@pytest.mark.parametrize("internal", [False, True])
def test_contact_is_that_of_gears_as_short_as_the_tip_form_circles(make_mesh, internal):
    mesh = make_mesh(24, 60, internal=internal)
    short = replace(
        mesh,
        gear1=replace(mesh.gear1, tip_radius=mesh.gear1.tip_radius - HEIGHT),
        gear2=replace(mesh.gear2, tip_radius=mesh.gear2.tip_radius - mesh.side * HEIGHT),
    )
    broken = chamfered(mesh, HEIGHT, HEIGHT)
    assert broken.transverse_contact_ratio == short.transverse_contact_ratio
    assert broken.inner_radii[0] == short.inner_radii[0]
    assert broken.inner_radii[1] == short.inner_radii[1]
    assert broken.tip_clearances[0] == mesh.tip_clearances[0]
    assert broken.transverse_contact_ratio < mesh.transverse_contact_ratio


def test_pocketing_loss_falls_gradually_with_the_chamfer(make_mesh):
    mesh = make_mesh(30, 30, beta=10.0)
    heights = (0.0, 1e-9, 0.05e-3, 0.1e-3, 0.2e-3, 0.3e-3)
    powers = [power(chamfered(mesh, height, height)) for height in heights]
    assert powers[1] == pytest.approx(powers[0], rel=1e-3)
    assert np.all(np.diff(powers[1:]) < 0)
    assert powers[-1] > 0.7 * powers[0]


def test_areas_of_chamfered_pockets_are_continuous(make_mesh):
    mesh = chamfered(make_mesh(30, 30), 1.5 * HEIGHT, 1.5 * HEIGHT)
    coarse, fine = (pocket_geometry(mesh, SHARP, True, angles).area for angles in (385, 1537))
    largest = [np.abs(np.diff(area, axis=1)).max() for area in (coarse, fine)]
    # a jump would stay, a steep slope takes a quarter of the step
    assert largest[1] == pytest.approx(largest[0] / 4, rel=0.05)


def test_chamfered_pockets_mirror_with_the_driver(make_mesh):
    mesh = chamfered(make_mesh(24, 36), HEIGHT, HEIGHT / 2)
    one, other = (pocket_geometry(mesh, SHARP, drives1) for drives1 in (True, False))
    for k in (0, 1):
        assert one.angle[k] == pytest.approx(-other.angle[k][::-1], abs=1e-12)
        assert one.area[k] == pytest.approx(other.area[k][::-1], rel=1e-9)
    assert one.gap[0] == pytest.approx(other.gap[1][::-1], abs=1e-12)


def test_a_chamfer_reduces_the_contact_of_a_case():
    case = ep.load_case("talbot-2012-pair")
    changes = {"pinion.tip_chamfer": "0.1 mm", "gear.tip_chamfer": "0.1 mm"}
    meshes = [item.gearings[""].geometries[0] for item in (case, case.updated(changes))]
    assert meshes[1].transverse_contact_ratio < meshes[0].transverse_contact_ratio
    assert meshes[1].gear1.tip_radius == meshes[0].gear1.tip_radius


# --- flow: what holds with and without chamfers ---------------------------------------------------


def test_only_the_common_face_takes_part(make_mesh):
    mesh = make_mesh(30, 30, beta=10.0)
    wider = replace(mesh, gear2=replace(mesh.gear2, face_width=1.5 * mesh.gear2.face_width))
    assert power(wider) == power(mesh)


@pytest.mark.parametrize("height", [0.0, HEIGHT])
def test_meshes_without_backlash_have_a_flow(make_mesh, height):
    mesh = chamfered(make_mesh(30, 30, beta=10.0), height, height)
    assert mesh.backlash == pytest.approx(0.0, abs=1e-12)
    assert 0 < power(mesh) < math.inf


def test_slow_loss_is_linear_in_the_share_of_oil(make_mesh):
    """Incompressible: proportional to the density of the mixture."""
    mesh = make_mesh(30, 30, beta=10.0)
    small, large = (power(mesh, 30.0, xi) for xi in (0.1, 0.4))
    ratio = (0.4 * 824.1 + 0.6 * 0.972) / (0.1 * 824.1 + 0.9 * 0.972)
    # at 30 rpm what is left of compressibility is far below a thousandth
    assert large / small == pytest.approx(ratio, rel=1e-3)
