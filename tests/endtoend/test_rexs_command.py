"""The commands rexs import and rexs export, and REXS files in the place of cases."""

from __future__ import annotations

import re
import shlex
import sys
import tomllib
from pathlib import Path

import pytest

import epicyclic as ep
from epicyclic.cli.main import main
from rexs_files import FIRST, SUN, eaxle, pair, planetary

HOW_TO = Path(__file__).parents[2] / "docs" / "how-to" / "rexs.md"
COARSE = ("--set", "numerics.mesh_positions=4", "--set", "numerics.contact_segments=4")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The folder in which the command runs."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def command(folder, monkeypatch, capsys):
    """The command in this process: its exit code and what it says."""

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["epicyclic", *arguments])
        try:
            main()
            code = 0
        except SystemExit as end:
            code = end.code
        return code, *capsys.readouterr()

    return call


def test_the_how_to_works_as_written(command, folder):
    planetary().write(folder / "gears.rexs")
    text = HOW_TO.read_text(encoding="utf-8")
    blocks = re.findall(r"```console\n(.*?)```", text, re.DOTALL)
    commands = [line[2:] for line in "".join(blocks).replace("\\\n", "").splitlines()]
    assert len(commands) == 4
    for line in commands:
        code, _, told = command(*shlex.split(line)[1:])
        assert code == 0, told
    for line in re.findall(r"```toml\n(.*?)```", text, re.DOTALL)[0].splitlines():
        assert line in (folder / "case.toml").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    exec(code, {})
    again = ep.read_rexs(folder / "results.rexs")
    assert again.tables == ep.read_rexs(folder / "gears.rexs").tables


def test_import_writes_what_it_can_and_says_what_is_needed(command, folder):
    planetary().write(folder / "gears.rexs")
    code, out, told = command("rexs", "import", "gears.rexs")
    assert code == 5
    assert "planet_bearing.roller_roughness" in out
    assert "run gears.toml" in told
    text = (folder / "gears.toml").read_text(encoding="utf-8")
    assert re.search(r"^# roller_roughness = .*# NEEDED\. The file has no", text, re.MULTILINE)
    assert tomllib.loads(text)["sun"]["teeth"] == 24
    code, _, told = command("run", "gears.toml")
    assert code == 2
    assert "planet_bearing.roller_roughness" in told
    assert command("rexs", "import", "gears.rexs")[0] == 2  # gears.toml is there


def test_bad_files_and_keys_write_nothing(command, folder):
    (folder / "bad.rexs").write_text("<model", encoding="utf-8")
    pair().write(folder / "gears.rexs")
    before = set(folder.iterdir())
    for arguments in (
        ("rexs", "import", "bad.rexs"),
        ("run", "bad.rexs"),
        ("rexs", "import", "gears.rexs", "--component", "999"),
        ("rexs", "import", "gears.rexs", "--set", "pinion.no_key=1"),
        ("rexs", "export", "gears.rexs", "-o", "out.toml"),
        ("rexs", "export", "talbot-2012-pair", "gears.rexs", "-o", "out.rexs", *COARSE),
        ("rexs", "export", "talbot-2012-pair", "-o", "out.rexs", "--component", "99", *COARSE),
    ):
        code, _, told = command(*arguments)
        assert code == 2, arguments
        assert told.startswith("1 problem") or "teeth" in told
    assert set(folder.iterdir()) == before


def test_run_tells_which_defaults_it_takes(command, folder):
    pair().write(folder / "gears.rexs")
    code, out, told = command("run", "gears.rexs", *COARSE, "--set", "gear.tip_diameter=77.6 mm")
    assert code == 0
    assert "stage B" in out
    keys = [line.partition(":")[0] for line in told.splitlines()]
    assert keys == [
        "pinion.tip_diameter", "pinion.root_diameter", "pinion.material", "gear.root_diameter",
        "gear.material",
    ]  # fmt: skip


def test_problems_of_the_geometry_are_told_and_the_case_is_written(command, folder):
    parts = pair()
    parts.set(SUN, tip_diameter=(60.0, "mm"))
    parts.write(folder / "gears.rexs")
    code, out, _ = command("rexs", "import", "gears.rexs")
    assert code == 5
    assert "Problem: pinion" in out
    assert (folder / "gears.toml").exists()


def test_export_without_an_original_describes_the_case(command, folder):
    assert command("rexs", "export", "talbot-2012-pair", "-o", "new.rexsz", *COARSE)[0] == 0
    oil = "lubricant.oil=atf-talbot-2012"
    code, out, _ = command("rexs", "import", "new.rexsz", "--set", oil)
    assert code == 0, out
    first, again = ep.load_case("talbot-2012-pair"), ep.load_case(folder / "new.toml")
    assert again.operation == first.operation
    assert again.gears.center_distance == pytest.approx(first.gears.center_distance)


def test_several_stages_become_a_train(command, folder):
    parts = eaxle()
    parts.set(FIRST + 1, arithmetic_mean_roughness_flank_iso_4287_1997=None)
    parts.write(folder / "eaxle.rexs")
    code, out, _ = command("rexs", "import", "eaxle.rexs", "-o", "train.toml")
    assert code == 5
    assert "sets.pair.pinion.roughness" in out
    assert re.search(
        r"^# roughness = .*# NEEDED\. The file has no",
        (folder / "train.toml").read_text(encoding="utf-8"),
        re.MULTILINE,
    )
    rough = ("--set", "sets.pair.pinion.roughness=0.4 um")
    code, out, _ = command("run", "eaxle.rexs", *COARSE, *rough)
    assert code == 0
    assert "wheels" in out
    code, out, _ = command("rexs", "import", "eaxle.rexs", "-o", "whole.toml", *rough)
    assert code == 0, out
    assert command("rexs", "export", "whole.toml", "eaxle.rexs", "-o", "out.rexs", *COARSE)[0] == 0
    assert "custom_epicyclic_total" in (folder / "out.rexs").read_text(encoding="utf-8")
    one = ("--component", str(FIRST), "-o", "one.toml", "--set", "pinion.roughness=0.4 um")
    assert command("rexs", "import", "eaxle.rexs", *one)[0] == 0
    assert tomllib.loads((folder / "one.toml").read_text(encoding="utf-8"))["kind"] == "gear_pair"
