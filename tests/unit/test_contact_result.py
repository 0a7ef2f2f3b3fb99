"""The result of one line contact: what it holds, and what it warns of."""

from __future__ import annotations

import json

import numpy as np
import pytest

from epicyclic.oil.rheology import Roelands, TwoSlope
from epicyclic.plugins.contact_solver.contact import contact_model, load_contact_case, solve_contact
from epicyclic.plugins.contact_solver.rough import AsperityContact

CONTACT = {"radius": "10 mm", "hertz_pressure": "1 GPa", "rolling_speed": "10 m/s",
           "slide_to_roll_ratio": 0.2}  # fmt: skip
TABLES = {"lubricant": {"oil": "atf-talbot-2012", "temperature": "90 degC"}}
COARSE = {"numerics": {"nodes": 128, "most_blocks": 8}}


def solved(frames=False, contact=None, **tables):
    case = load_contact_case({"contact": CONTACT | (contact or {})} | TABLES | COARSE | tables)
    return solve_contact(case, frames)


@pytest.fixture(scope="module")
def rough():
    surfaces = {f"surface{number}": {"roughness": "0.6 um"} for number in (1, 2)}
    return solved(frames=True, heating={"model": "inlet-and-film"}, **surfaces)


def test_shear_stress_of_the_last_moment_is_its_friction(rough):
    stress, x = rough.shear_stress(rough.rough.frames[-1]), rough.rough.x
    friction = stress.sum() * (x[1] - x[0]) / rough.model.contact.line_load
    # the rise of temperature is interpolated again, between pressures that were scaled
    assert friction == pytest.approx(rough.rough.friction[-1], rel=1e-9)


def test_touching_surfaces_carry_boundary_friction(rough):
    moments = [frame for frame in rough.rough.frames if rough.touching(frame).any()]
    assert moments
    where = rough.touching(moments[0])
    stress = rough.shear_stress(moments[0])
    assert stress[where] == pytest.approx(0.12 * moments[0].pressure[where])


def test_frames_change_no_bit(rough):
    again = solved(
        heating={"model": "inlet-and-film"},
        **{f"surface{number}": {"roughness": "0.6 um"} for number in (1, 2)},
    )
    assert not again.rough.frames
    assert (again.rough.friction == rough.rough.friction).all()


def test_json_holds_all_that_varies_over_x(rough):
    data = json.loads(rough.to_json())
    moment = data["rough"]["last_moment"]
    lengths = {len(moment[key]) for key in ("x", "pressure", "film", "shear_stress")}
    assert lengths == {128}
    assert max(data["smooth"]["temperature_rise"]) > 0
    assert data["surfaces"][0]["rms"] == pytest.approx(0.6e-6)
    assert data["figures"]["film ratio"]["value"] == pytest.approx(
        rough.smooth.minimum_film / (0.6e-6 * np.sqrt(2))
    )


def test_json_holds_inputs_that_make_the_same_contact():
    result = solved(surface1={"roughness": "0.1 um", "seed": 5})
    again = load_contact_case(json.loads(result.to_json())["inputs"])
    assert again == result.case


def test_a_solution_that_broke_down_says_so_in_json():
    # viscosity beyond what a float holds
    law = {
        "pressure_law": "two-slope", "second_slope": "40 1/GPa", "transition_pressure": "0.5 GPa",
        "shear_law": "carreau", "shear_stress": "5 MPa", "shear_exponent": 0.5,
    }  # fmt: skip
    result = solved(
        contact={"hertz_pressure": "12 GPa", "rolling_speed": "5 m/s"},
        lubricant={"oil": "atf-talbot-2012", "temperature": "25 degC"} | law,
        surface1={"roughness": "1 um"},
    )
    data = json.loads(result.to_json())
    assert data["status"] == "failed"
    assert data["message"] == "a time step failed"
    assert None in data["rough"]["friction"]


def test_every_quantity_beyond_the_tested_range_is_flagged():
    contact = {"radius": "0.1 mm", "hertz_pressure": "4 GPa", "rolling_speed": "100 m/s"}
    result = solved(contact=contact, lubricant=TABLES["lubricant"] | {"temperature": "20 degC"})
    told = {"equivalent radius", "Hertz pressure", "rolling speed", "temperature"}
    assert set(json.loads(result.to_json())["out_of_range"]) == told
    assert "Out of range: Hertz pressure 4 GPa, range 0.003 to 3 GPa" in " ".join(result.warnings)


def test_nothing_is_flagged_within_it():
    assert solved().warnings == ()
    assert solved(surface1={"roughness": "0.1 um"}).warnings == ()


@pytest.mark.parametrize(
    ("roughness", "told"),
    [("0.005 um", "film ratio 46.5"), ("1.9 um", "composite roughness 1.9 µm")],
)
def test_roughness_beyond_the_tested_range_is_flagged(roughness, told):
    assert told in " ".join(solved(surface1={"roughness": roughness}).warnings)


def test_thin_films_are_said_not_to_be_validated(rough):
    assert any("below 0.7" in warning for warning in rough.warnings)


def test_hot_films_are_flagged():
    result = solved(
        contact={"hertz_pressure": "1.5 GPa", "slide_to_roll_ratio": 1.0},
        lubricant={"oil": "iso-vg-320-mineral", "temperature": "40 degC"},
        heating={"model": "inlet-and-film"},
    )
    assert result.smooth.temperature_rise.max() > 50
    assert [flag.quantity for flag in result.flags] == ["temperature rise"]


def test_roughness_that_the_grid_does_not_resolve_is_told():
    result = solved(surface1={"roughness": "0.05 um", "correlation_length": "4 um"})
    assert any("of the Rq of surface1" in warning for warning in result.warnings)


def test_averages_that_say_little_are_told():
    rough = {"surface1": {"roughness": "0.05 um"}}
    frozen = solved(**rough, numerics=COARSE["numerics"] | {"frozen_roughness": True})
    assert any("is at rest" in warning for warning in frozen.warnings)


def test_profiles_too_coarse_for_the_contact_are_told(tmp_path):
    file = tmp_path / "micrometres.csv"
    file.write_text("\n".join(f"{n}, {0.1 * np.sin(n):.4f}" for n in range(100)), encoding="utf-8")
    result = solved(surface2={"profile": str(file)})
    assert any("its positions are not in mm" in warning for warning in result.warnings)


def test_a_profile_shorter_than_the_contact_is_told(tmp_path):
    file = tmp_path / "short.csv"
    rows = (f"{0.005 * n:.3f}, {0.1 * np.sin(n):.4f}" for n in range(40))
    file.write_text("\n".join(rows), encoding="utf-8")
    result = solved(surface2={"profile": str(file)})
    assert result.model.contact.half_width == pytest.approx(0.176e-3, rel=0.01)
    assert any("0.2 mm long, repeats itself" in warning for warning in result.warnings)


def test_the_figure_has_a_panel_for_whatever_there_is(rough):
    from epicyclic.plugins.contact_solver.show import contact_figure

    labels = [" ".join(ax.get_ylabel().split()) for ax in contact_figure(rough).axes]
    assert labels == ["pressure, GPa", "film, µm", "shear stress, MPa", "temperature rise, K"]
    rolling = contact_figure(solved(contact={"slide_to_roll_ratio": 0.0}))
    assert [" ".join(ax.get_ylabel().split()) for ax in rolling.axes] == labels[:2]


@pytest.mark.parametrize(("slip", "panels"), [(0.0, 2), (0.3, 3)])
def test_the_figure_names_the_contact_and_is_no_higher_than_a_slide(slip, panels):
    from epicyclic.plugins.contact_solver.show import contact_figure

    case = {"line_load": None, "hertz_pressure": "0.9 GPa", "slide_to_roll_ratio": slip}
    figure = contact_figure(solved(contact=case))
    assert len(figure.axes) == panels
    point = " ".join(figure.get_supxlabel().split())
    assert "Hertz pressure 0.9 GPa" in point
    assert f"{TABLES['lubricant']['oil']} at " in point
    width, height = figure.get_size_inches()
    assert height / width == pytest.approx(9 / 16)


def test_progress_ends_at_what_was_expected():
    calls = []
    case = load_contact_case(
        {"contact": CONTACT, "surface1": {"roughness": "0.3 um"}, "numerics": {"nodes": 128}}
        | TABLES
    )
    result = solve_contact(case, progress=lambda *call: calls.append(call))
    assert [done for done, _ in calls] == list(range(1, len(calls) + 1))
    assert all(done <= expected <= 1024 for done, expected in calls)
    assert calls[-1] == (len(calls), len(calls))
    assert result.status == "converged"


def test_a_preset_fills_in_what_is_not_given():
    tables = {
        "contact": {"radius": "7 mm", "hertz_pressure": "1.1 GPa", "rolling_speed": "6 m/s"},
        "lubricant": {"oil": "iso-vg-100-mineral", "temperature": "80 degC"},
    }
    usual = contact_model(load_contact_case(tables))
    alpha = usual.contact.oil.pressure_law.alpha
    assert usual.contact.oil.pressure_law == TwoSlope(alpha, 0.41 * alpha, 0.38e9)
    assert usual.asperities == AsperityContact(pytest.approx(40e-9), 0.12)
    before = contact_model(load_contact_case(tables | {"preset": "as-published"}))
    assert before.contact.oil.pressure_law == Roelands(alpha)
    assert before.asperities == AsperityContact(pytest.approx(20e-9), 0.10)
    given = contact_model(
        load_contact_case(tables | {"preset": "as-published"}, {"asperities.friction": 0.07})
    )
    assert given.asperities.friction == 0.07


@pytest.mark.slow
def test_creeping_contacts_are_no_result():
    creeping = solved(
        contact={"rolling_speed": "0.005 m/s", "slide_to_roll_ratio": 0.3},
        surface1={"roughness": "0.1 um"},
        numerics={"most_blocks": 6},
    )
    assert any("below 0.01 m/s" in warning for warning in creeping.warnings)
