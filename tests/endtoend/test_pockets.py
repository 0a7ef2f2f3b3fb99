"""``epicyclic pockets`` as a user meets it."""

from __future__ import annotations

import pytest


@pytest.mark.slow
def test_pockets_prints_power_and_draws_the_mesh(epicyclic, tmp_path):
    done = epicyclic(
        "pockets", "talbot-2012-pair", "--set", "numerics.pocket_steps=8",
        "--plot", str(tmp_path / "p.png"), "--animate", str(tmp_path / "p.gif"),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    for words in ("Pockets of the mesh", "energy balance", "highest pressure"):
        assert words in done.stdout, words
    for name in ("p-mesh.png", "p-mesh-section.png"):
        assert (tmp_path / name).read_bytes()[:4] == b"\x89PNG"
    assert (tmp_path / "p-mesh.gif").read_bytes()[:6] == b"GIF89a"


def test_mistakes_are_named_before_anything_is_computed(epicyclic):
    done = epicyclic("pockets", "talbot-2012-pair", "--animate", "p.png")
    assert done.returncode == 2
    assert "--animate" in done.stderr
    assert done.stdout == ""
    done = epicyclic("pockets", "talbot-2012-pair", "--set", "operation.speed=0 rpm")
    assert done.returncode == 2
    assert "does not turn" in done.stderr


def test_study_writes_numbers_and_figures(epicyclic, tmp_path):
    folder = tmp_path / "new" / "study"
    done = epicyclic(
        "study", "talbot-2012-pair", "--what", "helix-angle", "--range", "helix-angle=0:20:2 deg",
        "--level", "face-width=15 mm", "--level", "speed=5000,10000 rpm", "--picture", "svg",
        "--set", "numerics.pocket_steps=8", "-o", str(folder),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in folder.iterdir()) == [
        "helix-angle.csv", "helix-angle.nc", "helix-angle.svg",
    ]  # fmt: skip
    lines = (folder / "helix-angle.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("face_width [mm],speed [rpm],helix_angle [deg],pocketing_loss [W]")
    assert len(lines) == 1 + 4
