"""The pockets of a mesh through their life: the dataset, its tables and its pictures."""

from __future__ import annotations

import io
import math

import numpy as np
import pytest
import xarray as xr
from PIL import Image
from rich.console import Console

import epicyclic as ep
from epicyclic.show.plots.pockets import MeshScene, pocket_animation, pocket_figure, section_figure
from epicyclic.show.studies import pocket_tables
from epicyclic.study.pockets import mesh_duties

SPUR = {"gears.helix_angle": "0 deg"}


@pytest.fixture(scope="module")
def pair():
    return ep.load_case("talbot-2012-pair").updated({"numerics.pocket_slices": 8})


@pytest.fixture(scope="module")
def meshes(talbot):
    return ep.pocket_details(talbot)


@pytest.fixture(scope="module")
def mesh(pair):
    return ep.pocket_details(pair)["mesh"]


def test_every_mesh_has_its_pockets_with_labels(talbot, meshes):
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
    backlash = duty.gears.mesh.backlash * math.cos(duty.gears.mesh.operating_pressure_angle) * 1e6
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
    thickness = mesh["station_position"].diff("station").to_numpy()
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


def test_table_shows_balance_and_extremes_with_their_place(meshes):
    console = Console(file=io.StringIO(), width=120)
    console.print(pocket_tables(meshes))
    text = console.file.getvalue()
    mesh = meshes["ring_mesh"]
    assert "Pockets of the ring mesh of Talbot 2012 test article" in text
    assert "power of all 3 such meshes" in text
    assert f"{float(mesh['power']):.3f}" in text
    assert f"{float(mesh['pressure'].max()):.4f}" in text
    assert f"{float(abs(mesh['axial_speed']).max()):.2f}" in text
    assert "incompressible mixture" in text


def test_pictures_have_labels_with_units(mesh):
    figure = pocket_figure(mesh)
    labels = {ax.get_ylabel() for ax in figure.axes} | {ax.get_xlabel() for ax in figure.axes}
    assert labels >= {
        "area of the section, mm²",
        "volume of the pocket, mm³",
        "gap, µm",
        "pressure above ambient, bar",
        "roll angle of the pocket, deg",
        "roll angle of the pinion, deg",
        "power, W",
    }


def distance(point, line):
    """Of a point from a closed line of chords."""
    start, chord = line, np.roll(line, -1, axis=0) - line
    share = ((point - start) * chord).sum(axis=1) / np.maximum((chord**2).sum(axis=1), 1e-12)
    nearest = start + np.clip(share, 0.0, 1.0)[:, None] * chord
    return np.hypot(*(nearest - point).T).min()


@pytest.mark.slow
@pytest.mark.parametrize("end", ["first", "last"])
def test_pockets_fit_between_the_teeth_of_a_picture(meshes, mesh, end):
    """Teeth are placed by the dataset's figures, pockets by the kernel."""
    for one in (mesh, *meshes.values()):
        ax = section_figure(one, end).axes[2]
        teeth = [body.get_paths()[0].vertices for body in ax.collections[:2]]
        pockets = ax.collections[2].get_paths()
        assert len(pockets) >= 4
        for vertices in (pocket.vertices[:-1:7] for pocket in pockets):
            away = [min(distance(point, line) for line in teeth) for point in vertices]
            # the chords of both outlines leave the curve by 2 um at most
            assert max(away) < 4e-3


@pytest.mark.slow
def test_animation_shows_one_period_and_moves(pair):
    mesh = ep.pocket_details(pair.updated({"numerics.pocket_steps": 8}))["mesh"]
    done = []
    frames = Image.open(io.BytesIO(pocket_animation(mesh, lambda *step: done.append(step))))
    assert frames.format == "GIF"
    assert frames.n_frames == 8
    assert done[-1] == (8, 8)
    pictures = []
    for number in (0, 4):
        frames.seek(number)
        pictures.append(np.asarray(frames.convert("L"), dtype=float))
    assert np.abs(pictures[1] - pictures[0]).max() > 50


def test_a_spur_mesh_is_shown_in_one_section(pair):
    mesh = ep.pocket_details(pair.updated(SPUR))["mesh"]
    titles = [ax.get_title(loc="left") for ax in MeshScene(mesh).figure.axes]
    assert "Last end of the face" not in titles
