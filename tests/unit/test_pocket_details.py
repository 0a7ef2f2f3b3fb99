"""The pockets of a mesh through their life: the dataset, its tables and its pictures."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr

import epicyclic as ep
from epicyclic.analysis.pocket_details import mesh_duties

SPUR = {"gears.helix_angle": "0 deg"}


@pytest.fixture(scope="module")
def pair():
    return ep.load_case("talbot-2012-pair").updated({"numerics.pocket_slices": 8})


@pytest.fixture(scope="module")
def mesh(pair):
    return ep.pocket_details(pair)["mesh"]


def test_every_mesh_has_its_pockets_with_labels(talbot):
    meshes = ep.pocket_details(talbot)
    assert list(meshes) == ["sun_mesh", "ring_mesh"]
    losses = ep.solve(talbot).losses
    for key, mesh in meshes.items():
        assert isinstance(mesh, xr.Dataset)
        assert all(array.attrs["units"] and array.attrs["long_name"] for array in mesh.values())
        total = mesh.attrs["meshes"] * float(mesh["power"])
        assert total == pytest.approx(losses[f"{key}_pocketing"], rel=1e-12)
        assert float(mesh["instant_power"].mean()) == pytest.approx(float(mesh["power"]), rel=1e-9)


def test_pressure_over_the_life_does_the_work_of_a_period(mesh):
    # all pockets of a period together live one whole life of each kind
    volume = mesh["slice_volume"].to_numpy() * 1e-9
    pressure = mesh["pressure"].to_numpy() * 1e5
    mean = (pressure[:, 1:] + pressure[:, :-1]) / 2
    work = -np.nansum(mean * np.diff(volume, axis=1))
    pitches_per_second = float(mesh["speed"]) / 60 * mesh.attrs["teeth"][0]
    # the trapezoidal rule in time, and births and deaths within a step that it leaves out
    assert work * pitches_per_second == pytest.approx(float(mesh["power"]), rel=0.02)


def test_outlines_enclose_the_areas(mesh):
    for end, station in (("first", 0), ("last", -1)):
        area = mesh["end_area"].isel(station=station).to_numpy()
        outlines = mesh["outline"].sel(end=end).to_numpy()
        for kind, roll in zip(*np.nonzero(np.isfinite(area)), strict=True):
            points = outlines[kind, roll]
            x, y = points[np.isfinite(points[:, 0])].T
            shoelace = abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2
            # areas are read from a table over the angle, linearly
            assert shoelace == pytest.approx(area[kind, roll], rel=1e-4)


@pytest.mark.parametrize("torque", [100, -100])
def test_gaps_are_at_their_sides(pair, torque):
    case = pair.updated(SPUR | {"operation.torque": f"{torque} N*m"})
    mesh = ep.pocket_details(case)["mesh"]
    duty = mesh_duties(case)[0]
    assert mesh.attrs["drives"] == ("pinion" if torque > 0 else "gear")
    backlash = duty.mesh.backlash * math.cos(duty.mesh.operating_pressure_angle) * 1e6
    middle = abs(mesh["roll_angle"].sel(tooth="pinion")) < 2.0
    tooth = mesh.sel(tooth="pinion")
    assert np.allclose(tooth["contact_gap"].where(middle, 0.0, drop=True), 0.0)
    known = tooth["backlash_gap"].where(middle, drop=True).to_numpy()
    assert known == pytest.approx(np.full(known.shape, backlash), rel=1e-6)


def test_what_the_volume_loses_flows_out(pair):
    """Balance of every cell from the dataset alone: signs and sides are those of the flow."""
    changes = SPUR | {"models.pocketing": "incompressible", "numerics.pocket_steps": 128}
    mesh = ep.pocket_details(pair.updated(changes))["mesh"]
    period = 60 / float(mesh["speed"]) / mesh.attrs["teeth"][0]
    step = period / mesh.sizes["mesh_position"]
    thickness = float(mesh["slice_position"].diff("slice")[0])
    rate = np.gradient(mesh["slice_volume"].to_numpy(), step, axis=1)
    ends = mesh["end_area"] * mesh["axial_speed"] * 1e3
    out = (ends.diff("station")).to_numpy()
    for side in ("contact", "backlash"):
        gap = mesh[f"{side}_gap"].isel(station=slice(1, None)).to_numpy() * 1e-3
        out = out + thickness * gap * mesh[f"{side}_gap_speed"].to_numpy() * 1e3
    known = np.isfinite(out) & np.isfinite(rate)
    assert known.sum() > 1000
    # two-stage steps against differences of the volume
    error = np.abs(out + rate)[known]
    assert np.quantile(error, 0.9) < 0.02 * np.abs(rate[known]).max()


def test_pockets_of_a_moment_are_a_pitch_apart(mesh):
    stride = mesh.sizes["mesh_position"]
    moment = mesh.isel(roll=slice(5, None, stride))
    pitch = 360 / mesh.attrs["teeth"][0]
    assert np.diff(moment["roll_angle"]) == pytest.approx(pitch)
    ahead, behind = moment["roll_angle"].to_numpy()
    assert (ahead - behind) % pitch == pytest.approx(pitch / 2)


def test_pockets_at_rest_are_refused(pair):
    with pytest.raises(ep.InputError, match="does not turn"):
        ep.pocket_details(pair.updated({"operation.speed": "0 rpm"}))
