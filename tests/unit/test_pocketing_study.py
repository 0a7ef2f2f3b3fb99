"""The parametric study of pocketing losses: variants, points, datasets, figures."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.study.pockets import mesh_duties
from epicyclic.validation.plots import study_figure
from epicyclic.validation.pocketing import (
    STUDIES,
    base_variant,
    make_study,
    published_study,
    solve_variant,
    teeth_for_module,
    varied_duty,
)

QUICK = {"numerics.pocket_slices": 4, "numerics.pocket_steps": 8}


@pytest.fixture(scope="module")
def pair():
    return ep.load_case("talbot-2012-pair").updated(QUICK)


@pytest.fixture(scope="module")
def study(pair):
    return ep.pocketing_study(
        pair,
        ["speed", "helix-angle"],
        ranges={"speed": ["5000 rpm", "10000 rpm"], "helix-angle": ["10 deg", "20 deg"]},
        jobs=1,
    )


@pytest.mark.parametrize("name", ["talbot-2012", "talbot-2012-pair"])
def test_the_base_variant_is_the_mesh_of_the_case(name):
    case = ep.load_case(name).updated(QUICK)
    losses = ep.solve(case).losses
    count = case.planet.count if case.kind == "planetary" else 1
    for duty in mesh_duties(case):
        flow = solve_variant(case, duty, base_variant(duty))
        # the tooth thickness goes to the operating circle and back
        assert count * flow.power == pytest.approx(losses[f"{duty.gears.key}_pocketing"], rel=1e-6)


def test_the_helix_leaves_the_transverse_section(pair):
    (duty,) = mesh_duties(pair)
    base = base_variant(duty)
    mesh = varied_duty(duty, replace(base, helix_angle=0.0)).gears.mesh
    assert mesh.gear1.rack.helix_angle == 0.0
    for one, other in ((duty.gears.mesh.gear1, mesh.gear1), (duty.gears.mesh.gear2, mesh.gear2)):
        assert other.thickness_half_angle == pytest.approx(one.thickness_half_angle, rel=1e-12)
        assert (other.tip_radius, other.root_radius) == (one.tip_radius, one.root_radius)


@pytest.mark.parametrize("number", [0, 1])
def test_backlash_is_taken_from_both_members(talbot, number):
    duty = mesh_duties(talbot)[number]
    base = base_variant(duty)
    mesh = varied_duty(duty, replace(base, backlash=150e-6)).gears.mesh
    assert mesh.backlash == pytest.approx(150e-6, rel=1e-9)
    for which, radius in (("gear1", mesh.operating_radius1), ("gear2", mesh.operating_radius2)):
        before = getattr(duty.gears.mesh, which).thickness_at(radius)
        after = getattr(mesh, which).thickness_at(radius)
        assert before - after == pytest.approx((150e-6 - base.backlash) / 2, rel=1e-6)


@pytest.mark.parametrize("number", [0, 1])
def test_modules_keep_centre_distance_pressure_angle_and_backlash(talbot, number):
    duty = mesh_duties(talbot)[number]
    base = base_variant(duty)
    module = duty.gears.mesh.gear1.rack.transverse_module
    for nearest, teeth in teeth_for_module(duty.gears.mesh, [0.9 * module, 1.1 * module]).items():
        mesh = varied_duty(duty, replace(base, teeth=teeth)).gears.mesh
        assert mesh.gear1.rack.transverse_module == pytest.approx(nearest, rel=1e-12)
        assert mesh.center_distance == duty.gears.mesh.center_distance
        assert mesh.backlash == pytest.approx(base.backlash, rel=1e-9)
        assert mesh.operating_pressure_angle == pytest.approx(
            duty.gears.mesh.operating_pressure_angle, rel=1e-12
        )


def test_modules_of_the_example_are_those_printed(pair):
    # Talbot (2012), p. 122: 23 to 28 teeth on a pitch diameter of 50 mm
    printed = (1.786, 1.852, 1.923, 2.0, 2.083, 2.174)
    plan = make_study(pair, ["module"], ranges={}, levels={})
    module = plan.axes["module"][-1]
    assert [round(1e3 * value, 3) for value in module.values] == list(printed)
    assert [teeth for teeth, _ in module.variants] == [28, 27, 26, 25, 24, 23]


def test_defaults_are_the_values_of_the_source(pair):
    plan = make_study(pair, STUDIES, ranges={}, levels={})
    widths, speeds, angles = plan.axes["helix-angle"]
    assert np.array(widths.values) * 1e3 == pytest.approx([15, 25, 35])
    assert np.array(speeds.values) * 30 / math.pi == pytest.approx([5000, 7500, 10000])
    assert np.degrees(angles.values) == pytest.approx(np.arange(0, 36, 5))
    assert np.array(plan.axes["backlash"][-1].values) * 1e6 == pytest.approx(range(50, 226, 25))
    assert len(plan.points) == len(set(plan.points))
    assert sorted(plan.order()) == list(range(len(plan.points)))


def test_a_study_is_the_loss_of_its_cases(pair, study):
    loss = study["helix-angle"]["pocketing_loss"]
    assert loss.dims == ("face_width", "speed", "helix_angle")
    for angle, width, speed in ((10, 15, 10000), (20, 35, 5000)):
        changes = {
            "gears.helix_angle": f"{angle} deg",
            "pinion.face_width": f"{width} mm",
            "gear.face_width": f"{width} mm",
            "operation.speed": f"{speed} rpm",
        }
        expected = ep.solve(pair.updated(changes)).losses["mesh_pocketing"]
        found = loss.sel(helix_angle=angle, face_width=width, speed=speed)
        assert float(found) == pytest.approx(expected, rel=1e-6)
    assert (study["helix-angle"]["status"] == "converged").all()


def test_exponents_are_slopes(study):
    speed = study["speed"]
    low, high = (speed["pocketing_loss"].sel(speed=rpm) for rpm in (5000, 10000))
    slope = np.log(high / low) / math.log(2)
    assert speed["speed_exponent"].to_numpy() == pytest.approx(slope.to_numpy())


def test_finished_points_are_kept(pair, tmp_path, monkeypatch):
    wanted = {
        "ranges": {"oil-fraction": [0.1, 0.2]},
        "levels": {"helix-angle": ["0 deg"], "face-width": ["15 mm"], "speed": ["5000 rpm"]},
        "journal": tmp_path / "study.partial",
        "jobs": 1,
    }
    first = ep.pocketing_study(pair, ["oil-fraction"], **wanted)["oil-fraction"]
    monkeypatch.delattr("epicyclic.validation.pocketing.solve_variant")
    again = ep.pocketing_study(pair, ["oil-fraction"], **wanted)["oil-fraction"]
    assert again.equals(first)
    assert float(first["pocketing_loss"].min()) > 0


def test_points_that_cannot_be_say_why(pair):
    found = ep.pocketing_study(
        pair,
        ["backlash"],
        ranges={"backlash": ["0.1 mm", "6 mm"]},
        levels={"helix-angle": ["0 deg"], "face-width": ["15 mm"], "speed": ["5000 rpm"]},
        jobs=1,
    )["backlash"].squeeze()
    assert list(found["status"].to_numpy()) == ["converged", "failed"]
    assert np.isnan(found["pocketing_loss"][1])
    assert "mesh: is impossible: the teeth of the pinion become pointed" in str(
        found["message"][1].item()
    )


def test_every_mistake_is_named(pair):
    with pytest.raises(ep.InputError) as error:
        ep.pocketing_study(
            pair,
            ["helix", "speed"],
            ranges={"backlash": ["1 um"], "speed": ["0 rpm"], "width": ["1 mm"]},
            levels={"helix-angle": ["50 deg"], "oil-fraction": [0.1], "speed": []},
        )
    text = str(error.value)
    for words in (
        "Did you mean 'helix-angle'?",
        'range = "backlash": has no range in this study',
        'range speed = "0 rpm": is out of range',
        'range = "width": is not a parameter',
        'level helix-angle = "50 deg": is out of range',
        'level = "oil-fraction": has no level',
        "level speed: has no values",
    ):
        assert words in text, words
    with pytest.raises(ep.InputError, match="sun_mesh or ring_mesh"):
        ep.pocketing_study(ep.load_case("talbot-2012"), mesh="mesh")
    with pytest.raises(ep.InputError, match="does not turn"):
        ep.pocketing_study(pair.updated({"operation.speed": "0 rpm"}))
    with pytest.raises(ep.InputError, match="leaves 2 and 2 teeth"):
        ep.pocketing_study(pair, ["module"], ranges={"module": ["20 mm"]})
    with pytest.raises(ep.InputError, match="names no study"):
        ep.pocketing_study(pair, [])


def test_published_values_belong_to_the_example_only(pair, study):
    published = published_study(pair)
    assert published is not None
    assert published.exponents == {0.0: 3.06, 30.0: 2.95}
    printed = {
        (it.place["helix_angle"], it.place["face_width"]): it.ends
        for it in published.marks
        if it.base is None
    }
    assert printed[(10.0, 15.0)] == (120.0, 120.0)
    assert printed[(30.0, 15.0)] == (57.0, 76.0)
    (backlash, *_) = (it for it in published.marks if it.place["backlash"] == 225)
    assert (backlash.base["backlash"], backlash.ends) == (50, (0.83, 0.83))
    assert published_study(pair.updated({"pinion.face_width": "14 mm"})) is None
    assert published_study(ep.load_case("talbot-2012")) is None
    figure = study_figure(study["helix-angle"], published)
    stars = [[line for line in ax.lines if line.get_marker() == "*"] for ax in figure.axes]
    assert [len(found) for found in stars] == [1, 1, 0]  # face widths of 15, 25 and 35 mm
    assert (stars[0][0].get_xdata(), stars[0][0].get_ydata()) == ([10.0], [120.0])
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    bands = "Talbot (2012), 10000 rpm, read between ticks of its axes"
    assert texts == ["5000 rpm", "7500 rpm", "10000 rpm", "Talbot (2012), 10000 rpm", bands]
    # of the helix angles of this study, 10 and 20 deg of 35 mm
    assert [len(ax.containers) for ax in figure.axes] == [1, 1, 2]


def test_figures_have_a_panel_for_each_level(study):
    figure = study_figure(study["speed"])
    assert [ax.get_xlabel() for ax in figure.axes] == ["speed of the pinion, rpm"] * 2
    titles = [ax.get_title(loc="left") for ax in study_figure(study["helix-angle"]).axes]
    assert titles == [f"face width {width} mm" for width in (15, 25, 35)]


def test_figures_tell_the_oil_beside_their_legend(pair, study):
    for figure in (
        study_figure(study["helix-angle"], published_study(pair)),
        study_figure(study["speed"]),
    ):
        (caption,) = [text for text in figure.texts if "oil at" in text.get_text()]
        assert caption.get_text() == "pocketing incompressible, oil at 90 °C"
        figure.draw_without_rendering()
        legend = figure.legends[0].get_window_extent()
        assert not caption.get_window_extent().overlaps(legend)
