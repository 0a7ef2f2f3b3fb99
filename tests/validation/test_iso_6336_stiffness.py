"""Mesh stiffness of standard steel gears against ISO 6336-1, external and internal.

The standard multiplies the theoretical stiffness by C_M = 0.8, "to meet measurements of solid
gears". The theory behind it (Weber and Banaschek) is of the kind used here, so that the comparison
is without C_M; with it the values of the standard are 17 to 27 % below those computed.
"""

from __future__ import annotations

import math

import pytest

from epicyclic.contact.elastic_teeth import GearBody, load_mesh_elastically
from reference.mesh_stiffness import (
    STIFFNESS_CORRECTION,
    mesh_stiffness,
    theoretical_single_stiffness,
)

STEEL = GearBody(206e9, 0.3)
LINE_LOAD = 300e3
"""The stiffness of the standard is for 100 N/mm and more. [N/m]"""
TEETH = [(17, 17), (20, 20), (18, 36), (25, 75), (30, 60), (60, 120), (100, 100)]
RINGS = [(20, 70), (25, 80), (30, 100), (40, 120)]


@pytest.fixture
def loaded(make_mesh):
    def load(teeth1, teeth2, **options):
        mesh = make_mesh(teeth1, teeth2, module=4e-3, width=40e-3, **options)
        return load_mesh_elastically(mesh, STEEL, STEEL, 20, 20, LINE_LOAD * mesh.face_width)

    return load


@pytest.mark.parametrize("beta", [0.0, 10.0, 20.0, 30.0])
@pytest.mark.parametrize(("z1", "z2"), TEETH)
def test_mesh_stiffness_of_external_gears(loaded, z1, z2, beta):
    """10 %: q' is itself a fit, and coupling along helical contact lines is not in it."""
    mesh = loaded(z1, z2, beta=beta)
    single = theoretical_single_stiffness(z1, z2, math.radians(beta))
    expected = mesh_stiffness(single, mesh.mesh.transverse_contact_ratio)
    found = mesh.mean(mesh.secant_stiffness) / mesh.mesh.face_width
    assert found == pytest.approx(expected, rel=0.10)
    # C_M is not in the theory: with it the standard is lower by more than the scatter
    assert found > expected * STIFFNESS_CORRECTION / 0.85


@pytest.mark.parametrize(("z1", "z2"), TEETH)
def test_single_stiffness_of_external_spur_gears(loaded, z1, z2):
    """Largest stiffness of a lone pair; 10 %, as above."""
    mesh = loaded(z1, z2)
    alone = (mesh.pair_force > 0).sum(axis=1) == 1
    found = mesh.secant_stiffness[alone].max() / mesh.mesh.face_width
    assert found == pytest.approx(theoretical_single_stiffness(z1, z2), rel=0.10)


@pytest.mark.parametrize("beta", [0.0, 15.0])
@pytest.mark.parametrize(("z1", "z2"), RINGS)
def test_mesh_stiffness_of_internal_gears(loaded, z1, z2, beta):
    """A ring counts as a gear with an infinite number of teeth, and its rim as rigid; 5 %."""
    mesh = loaded(z1, z2, internal=True, beta=beta)
    single = theoretical_single_stiffness(z1, math.inf, math.radians(beta))
    expected = mesh_stiffness(single, mesh.mesh.transverse_contact_ratio)
    found = mesh.mean(mesh.secant_stiffness) / mesh.mesh.face_width
    assert found == pytest.approx(expected, rel=0.05)
