"""Loaded meshes point by point: the dataset, its tables and its pictures."""

from __future__ import annotations

import io

import numpy as np
import pytest
import xarray as xr
from rich.console import Console

import epicyclic as ep
from epicyclic.machine.solve import NEAR, STEEPEST
from epicyclic.show.plots.mesh import mesh_figure
from epicyclic.show.studies import mesh_tables


@pytest.fixture(scope="module")
def talbot():
    return ep.load_case("talbot-2012")


@pytest.fixture(scope="module")
def meshes(talbot):
    return ep.mesh_details(talbot)


def test_both_meshes_of_a_planet(meshes):
    assert list(meshes) == ["sun_mesh", "ring_mesh"]
    for mesh in meshes.values():
        assert isinstance(mesh, xr.Dataset)
        assert all(array.attrs["units"] and array.attrs["long_name"] for array in mesh.values())


def test_pairs_carry_the_force_of_the_mesh(talbot, meshes):
    for mesh in meshes.values():
        total = mesh["pair_load"].sum("contact_line")
        # the normal force: transverse force over cos(beta_b), beta_b = 12.11 deg by hand
        beta_b = np.arcsin(np.sin(np.radians(13.124)) * np.cos(np.radians(22.5)))
        assert total.to_numpy() == pytest.approx(mesh.attrs["force_N"] / np.cos(beta_b), rel=1e-4)


def test_friction_power_sums_to_the_sliding_loss(talbot, meshes):
    losses = ep.solve(talbot).losses
    contacts = ep.mesh_contacts(talbot)
    for key, mesh in meshes.items():
        power = mesh["friction_power"].to_numpy()  # W/mm
        known = power[np.isfinite(power)]
        weight = contacts[key].weight * 1e3  # mm, of the same points in the same order
        # that of the last loads whose losses were not foretold
        near = pytest.approx(losses[f"{key}_sliding"], rel=STEEPEST * NEAR)
        assert 3 * (known * weight).sum() == near


def test_nothing_is_known_where_no_tooth_touches(meshes):
    mesh = meshes["sun_mesh"]
    away = mesh["line_load"].isnull()
    assert away.any()
    assert mesh["hertz_pressure"].where(away).isnull().all()
    assert (mesh["pair_load"].where(away.all("segment"), drop=True).fillna(0.0) == 0.0).all()


def test_simple_load_distributions_know_no_deflection(talbot):
    case = talbot.updated({"models.load_distribution": "uniform"})
    mesh = ep.mesh_details(case)["sun_mesh"]
    assert mesh["transmission_error"].isnull().all()
    assert "gives no deflection" in printed({"sun_mesh": mesh})


def test_without_motion_the_load_is_known_and_the_sliding_is_not(talbot):
    mesh = ep.mesh_details(talbot.updated({"operation.speed": "0 rpm"}))["sun_mesh"]
    assert mesh["line_load"].notnull().any()
    assert mesh["hertz_pressure"].notnull().any()
    assert (mesh["sliding_speed"].fillna(0.0) == 0.0).all()
    assert mesh["friction_power"].isnull().all()
    assert "without motion" in printed({"sun_mesh": mesh})
    assert len(mesh_figure(mesh).axes) >= 9


def test_without_torque_there_is_nothing_to_show(talbot):
    with pytest.raises(ep.InputError, match="without load"):
        ep.mesh_details(talbot.updated({"operation.torque": "0 N*m"}))


def test_the_most_loaded_planet_is_shown(talbot):
    changes = {"load_sharing.method": "mesh-load-factor", "load_sharing.mesh_load_factor": 1.2}
    # with losses the loads of a set depend on how its planets share them, a little
    without = talbot.updated({"models.mesh_loads": "without-losses"})
    even, uneven = (ep.mesh_details(case) for case in (without, without.updated(changes)))
    for key, mesh in uneven.items():
        assert mesh.attrs["force_N"] == pytest.approx(1.2 * even[key].attrs["force_N"])


def printed(meshes):
    console = Console(file=io.StringIO(), width=120)
    console.print(mesh_tables(meshes))
    return console.file.getvalue()


def test_tables_show_extremes_with_their_place(meshes):
    text = printed(meshes)
    mesh = meshes["ring_mesh"]
    assert "Ring mesh of Talbot 2012 test article" in text
    assert f"{float(mesh['line_load'].max()):.4g}" in text
    assert "largest line load" in text
    assert "smallest film ratio" in text
    assert (
        f"{float(mesh['transmission_error'].max() - mesh['transmission_error'].min()):.4f}" in text
    )


def test_picture_has_labels_with_units(meshes):
    figure = mesh_figure(meshes["sun_mesh"])
    labels = {ax.get_ylabel() for ax in figure.axes} | {ax.get_xlabel() for ax in figure.axes}
    labels = {" ".join(label.partition(";")[0].partition(" (")[0].split()) for label in labels}
    assert labels >= {
        "line load, N/mm",
        "contact pressure, GPa",
        "loaded transmission error, µm",
        "mesh stiffness per face width, N/(mm·µm)",
        "roll angle of the sun, deg",
    }
