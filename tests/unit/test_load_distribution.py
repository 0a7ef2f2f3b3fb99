"""Load along the contact lines."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from contacts import MESHES
from epicyclic.gears.flanks import contact_lines
from epicyclic.losses.contact import STIFFNESS_SHAPES, load_shape


@pytest.fixture(params=MESHES)
def mesh(request, make_mesh):
    return make_mesh(**request.param)


@pytest.fixture(params=sorted(STIFFNESS_SHAPES))
def model(request):
    return request.param


def spur_of_contact_ratio(make_mesh, ratio):
    """A symmetric spur pair whose tips end the path at +-eps_alpha/2."""
    mesh = make_mesh(40, 40)
    path = ratio * mesh.gear1.rack.transverse_base_pitch
    curvature = mesh.line_of_action / 2 + path / 2
    tip = math.hypot(curvature, mesh.gear1.base_radius)
    mesh = replace(
        mesh, gear1=replace(mesh.gear1, tip_radius=tip), gear2=replace(mesh.gear2, tip_radius=tip)
    )
    assert mesh.transverse_contact_ratio == pytest.approx(ratio, rel=1e-10)
    return mesh


@pytest.mark.parametrize(("positions", "segments"), [(4, 2), (20, 20), (33, 7)])
def test_force_is_balanced_at_every_position(mesh, model, positions, segments):
    lines, shape = load_shape(mesh, model, positions, segments)
    force = (shape * lines.length).sum(axis=(1, 2))
    # the normal force of a unit transverse one, in the plane of action: 1/cos(beta_b)
    expected = 1 / math.cos(mesh.gear1.rack.base_helix_angle)
    assert force == pytest.approx(np.full_like(force, expected), rel=1e-12)  # rounding of sums


def test_no_negative_loads(mesh, model):
    lines, shape = load_shape(mesh, model, 20, 20)
    assert np.all(shape[lines.length > 0] > 0)
    assert np.all(np.isfinite(shape))


def test_uniform_load_is_force_over_total_length(mesh):
    lines, shape = load_shape(mesh, "uniform", 20, 20)
    cosine = math.cos(mesh.gear1.rack.base_helix_angle)
    expected = 1 / (lines.length.sum(axis=(1, 2)) * cosine)
    assert shape == pytest.approx(np.broadcast_to(expected[:, None, None], shape.shape), rel=1e-12)


def energy_share(mesh, xi):
    """Share of a pair at xi base pitches from the start of the path, the next one following it."""
    pitch = mesh.gear1.rack.transverse_base_pitch
    lines = contact_lines(mesh, 4, 2)
    curvature = mesh.path_start + np.array([xi, xi + 1.0]) * pitch
    points = replace(lines, curvature1=curvature)
    stiffness = STIFFNESS_SHAPES["minimum-energy"](mesh, points)
    return float(stiffness[0] / stiffness.sum())


def test_minimum_energy_shares_at_contact_ratio_1_6(make_mesh):
    # worked out separately, model (b) = Sanchez, Pleguezuelos, Pedrero (2017):
    # b0 = 1.23650 at eps_alpha = 1.6, the pair that enters carries 0.3617, the one that leaves
    # 0.6383, half-way through double contact 0.5; four digits.
    mesh = spur_of_contact_ratio(make_mesh, 1.6)
    assert energy_share(mesh, 0.0) == pytest.approx(0.3617, abs=0.5e-4)
    assert energy_share(mesh, 0.6) == pytest.approx(0.6383, abs=0.5e-4)
    assert energy_share(mesh, 0.3) == pytest.approx(0.5, rel=1e-9)
    pitch = mesh.gear1.rack.transverse_base_pitch
    middle = (mesh.path_start + mesh.path_end) / 2
    points = replace(contact_lines(mesh, 4, 2), curvature1=np.array([middle, middle + 0.5 * pitch]))
    at_middle, away = STIFFNESS_SHAPES["minimum-energy"](mesh, points)
    assert math.acos(away / at_middle) / 0.5 == pytest.approx(1.23650, abs=0.5e-5)


def test_minimum_energy_in_a_spur_mesh_shares_between_pairs_only(make_mesh):
    mesh = spur_of_contact_ratio(make_mesh, 1.6)
    lines, shape = load_shape(mesh, "minimum-energy", 40, 5)
    assert np.ptp(shape, axis=2) == pytest.approx(0.0, abs=1e-9)
    single = (lines.length[:, 1, 0] == 0) & (lines.length[:, 0, 0] > 0)
    alone = shape[single, 0, 0]
    assert alone == pytest.approx(np.full_like(alone, 1 / mesh.face_width), rel=1e-12)


def test_minimum_energy_is_symmetric_about_the_middle_of_the_path(mesh):
    lines = contact_lines(mesh, 4, 2)
    middle = (mesh.path_start + mesh.path_end) / 2
    away = np.linspace(0.0, (mesh.path_end - mesh.path_start) / 2, 9)
    model = STIFFNESS_SHAPES["minimum-energy"]
    before = model(mesh, replace(lines, curvature1=middle - away))
    after = model(mesh, replace(lines, curvature1=middle + away))
    assert before == pytest.approx(after, rel=1e-10)
    assert np.all(np.diff(after) < 0)


@pytest.mark.parametrize("ratio", [1.0, 2.0])
def test_minimum_energy_is_continuous_at_the_ends_of_its_range(make_mesh, ratio):
    def middle_load(value):
        mesh = spur_of_contact_ratio(make_mesh, value)
        lines = contact_lines(mesh, 4, 2)
        end = replace(lines, curvature1=np.array([mesh.path_end]))
        return float(STIFFNESS_SHAPES["minimum-energy"](mesh, end)[0])

    below, above = middle_load(ratio - 1e-6), middle_load(ratio + 1e-6)
    assert below == pytest.approx(above, abs=1e-5)


def test_minimum_energy_takes_load_from_the_ends(make_mesh):
    mesh = make_mesh(20, 41)
    lines, uniform = load_shape(mesh, "uniform", 40, 4)
    _, shaped = load_shape(mesh, "minimum-energy", 40, 4)
    sliding = np.abs(lines.curvature1 - mesh.pitch_point) * lines.length
    assert (shaped * sliding).sum() < 0.95 * (uniform * sliding).sum()
