"""What results say of flows through pockets that leave what the models are made for."""

from __future__ import annotations

import re

import pytest

import epicyclic as ep

QUICK = {"numerics.pocket_slices": 6, "numerics.pocket_steps": 12}
SOUND = 59.5
"""Of the mixture of the example pair at 90 degC. [m/s]"""


def told(case, words):
    return [text for text in ep.solve(case).warnings if words in text]


@pytest.fixture(scope="module")
def pair():
    return ep.load_case("talbot-2012-pair").updated(QUICK)


def test_the_study_itself_is_inside(pair):
    assert told(pair, "outside the study") == []


def test_what_lies_outside_the_study_is_named_with_its_watts(pair):
    wide = pair.updated({"pinion.face_width": "41 mm", "gear.face_width": "43 mm"})
    (text,) = told(wide.updated({"operation.speed": "11000 rpm"}), "outside the study")
    assert "face width 41 mm (15 to 35)" in text
    assert "pitch line speed 28.8 m/s (0 to 26.2)" in text
    assert "module" not in text
    assert "helix" not in text
    loss = ep.solve(wide.updated({"operation.speed": "11000 rpm"})).losses["mesh_pocketing"]
    assert float(re.search(r"the pockets lose ([\d.]+) W", text).group(1)) == pytest.approx(
        loss, rel=5e-3
    )


@pytest.mark.parametrize("model", ["incompressible", "mean-density", "talbot-2012", "isentropic"])
def test_flow_near_the_speed_of_sound_is_told(pair, model):
    for rpm in (1500, 8000):
        case = pair.updated({"operation.speed": f"{rpm} rpm", "models.pocketing": model})
        fastest = ep.solve(case).meshes["mesh"].pocket_speed_max
        warned = told(case, "times the speed of sound")
        expected = model != "isentropic" and fastest > SOUND / 2
        assert len(warned) == expected
        if warned:
            ratio = float(re.search(r"reaches ([\d.]+) times", warned[0]).group(1))
            assert ratio == pytest.approx(fastest / SOUND, rel=6e-3)


def test_voids_and_pressures_that_cannot_be_are_told(pair):
    slow = pair.updated({"operation.speed": "4000 rpm"})
    assert told(slow, "contain voids") == []
    assert len(told(pair, "contain voids")) == 1
    study = pair.updated({"models.pocketing": "talbot-2012"})
    assert told(study, "contain voids") == []
    (text,) = told(study, "which is impossible for a fluid")
    lowest = 1.01325 + ep.solve(study).meshes["mesh"].pocket_pressure_min / 1e5
    assert lowest < 0
    assert float(re.search(r"falls to (-[\d.]+) bar", text).group(1)) == pytest.approx(
        lowest, abs=0.006
    )


def test_nothing_is_told_of_a_loss_that_means_nothing(pair):
    wide = {"pinion.face_width": "41 mm", "gear.face_width": "43 mm", "operation.speed": "300 rpm"}
    loaded = pair.updated({**wide, "operation.torque": "60 N*m"})
    losses = ep.solve(loaded).losses
    assert losses["mesh_pocketing"] < 0.01 * losses["mesh_sliding"]
    assert told(loaded, "outside the study") == []
    assert len(told(pair.updated(wide), "outside the study")) == 1


def test_pockets_show_both_ends_of_the_band(pair):
    for model, other in (("auto", "isentropic"), ("isentropic", "incompressible")):
        mesh = ep.pocket_details(pair.updated({"models.pocketing": model}))["mesh"]
        end = ep.solve(pair.updated({"models.pocketing": other})).losses["mesh_pocketing"]
        assert float(mesh["power_other_end"]) == pytest.approx(end, rel=1e-9)
        assert other in mesh["power_other_end"].attrs["long_name"]
