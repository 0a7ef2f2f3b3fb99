"""Reports, plots and stored results as a user meets them."""

from __future__ import annotations

import json

import pytest

MESH = ("--set", "operation.torque=100 N*m", "--set", "losses.mesh_pocketing.include=false")


@pytest.mark.slow
def test_a_result_is_stored_shown_and_drawn(epicyclic, tmp_path):
    file, folder = "result.nc", tmp_path / "elsewhere"
    run = epicyclic("run", "talbot-2012-pair", *MESH, "--save", file, "--json", "-")
    assert run.returncode == 0, run.stderr
    done = epicyclic("report", file, "-o", "report.html")
    assert (done.returncode, done.stdout, done.stderr) == (0, "Wrote report.html.\n", "")
    page = (folder / "report.html").read_text(encoding="utf-8")
    total = json.loads(run.stdout)["total"]
    assert f'<data value="{total}" data-key="total">' in page
    listed = epicyclic("plot", file)
    assert [line.split()[0] for line in listed.stdout.splitlines()][:4] == [
        "gear-set", "teeth", "losses", "loss-sum",
    ]  # fmt: skip
    drawn = epicyclic("plot", file, "losses", "-o", "losses.svg")
    assert (drawn.returncode, drawn.stdout) == (0, "Wrote losses.svg.\n")
    assert "power loss, W" in (folder / "losses.svg").read_text(encoding="utf-8")
    names = {path.name for path in folder.iterdir()}
    assert names == {file, "report.html", "losses.svg"}  # nothing half-written is left


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (("report", "missing.nc", "-o", "r.html"), "does not exist"),
        (("report", "talbot-2012", "-o", "r.txt"), "must end in .html or .pdf"),
        (("report", "missing.nc", "--set", "sun.teeth=20", "-o", "r.html"), "stored result"),
        (("plot", "talbot-2013", "losses"), "neither a file nor a built-in case"),
        (("plot", "talbot-2012", "losses", "-o", "x.docx"), "must end in .png or .svg or .pdf"),
        (("run", "talbot-2012", "--save", "result.json"), "must end in .nc"),
        (("run", "talbot-2012", "--save", "nowhere/result.nc"), "that does not exist"),
    ],
)
def test_bad_requests_end_in_one_clear_error(epicyclic, tmp_path, arguments, reason):
    done = epicyclic(*arguments)
    assert done.returncode == 2
    assert done.stderr.startswith("1 problem")
    assert reason in done.stderr
    assert not (tmp_path / "elsewhere").exists()
