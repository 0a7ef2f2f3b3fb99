"""One study in workers, on a cluster and in shards: the same file."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import epicyclic as ep
from epicyclic.cli.main import main
from epicyclic.study.sweeps import runner
from epicyclic.study.sweeps.run import make_plan
from epicyclic.study.sweeps.runner import Rows, Runner, share_of

DOCS = Path(__file__).parents[2] / "docs"
PAIR = (
    "talbot-2012-pair", "--set", "numerics.pocket_slices=4", "--set", "numerics.pocket_steps=8",
)  # fmt: skip
SPEEDS = ("--speed", "0:9000:10 rpm")
COMMANDS = {
    "sweep.csv": (
        "sweep", *PAIR, "--vary", "operation.speed=1000:9000:3 rpm",
        "--vary", "pinion.teeth=25,26", "--vary", "operation.torque=-20,50 N*m",
    ),
    "sweep.nc": (
        "sweep", *PAIR, "--vary", "operation.speed=1000:4000:4 rpm",
        "--vary", "lubricant.oil=atf-talbot-2012,iso-vg-100-mineral",
    ),
    "map.nc": ("map", *PAIR, *SPEEDS, "--torque=-50:50:3 N*m", "--temperature", "40,90 degC"),
    "map.vtlm": ("map", *PAIR, *SPEEDS, "--torque=-50:50:3 N*m", "--format", "vecto"),
    "table.nc": ("pockets-table", *PAIR, "--speed", "9000:11000:3 rpm"),
    "study": (
        "study", *PAIR, "--what", "helix-angle,backlash", "--range", "helix-angle=0:20:2 deg",
        "--range", "backlash=50 um,6 mm", "--level", "face-width=15 mm",
        "--level", "helix-angle=0 deg", "--level", "speed=5000 rpm", "--picture", "svg",
    ),
    "oil": (
        "oil", "characterise", "atf-talbot-2012", "--size", "16", "--set", "numerics.nodes=128",
        "--range", "radius=5:6 mm", "--range", "roughness1=0.1:0.2 um",
        "--range", "roughness2=0.1:0.2 um", "--range", "hertz_pressure=1:2 GPa",
        "--range", "rolling_speed=8:20 m/s", "--range", "temperature=25:60 degC",
        "--range", "slide_to_roll_ratio=0.3:1",
    ),
}  # fmt: skip
"""A command of each kind by its output, with points that fail and tables that points share."""
FOLDERS = {"study": "study", "oil": "simulations"}
FAILS = ("sweep.csv", "study")
QUICK = ("sweep.csv", "table.nc", "study")


@pytest.fixture
def call(monkeypatch, capsys):
    """A command in this process: its exit code, and what it printed."""

    def run(*arguments):
        monkeypatch.setattr("sys.argv", ["epicyclic", *map(str, arguments)])
        code = 0
        try:
            main()
        except SystemExit as ended:
            code = ended.code
        shown = capsys.readouterr()
        return code, shown.out, shown.err

    return run


@pytest.fixture(scope="module")
def cluster():
    """A Dask cluster of two workers in this process."""
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=False, dashboard_address=":0"
    ) as local:
        yield local.scheduler_address


def content(path):
    """The bytes of a file, or of all files in a folder, less what names the moment."""
    if path.is_dir():
        return {file.name: content(file) for file in path.iterdir() if file.suffix != ".svg"}
    return path.read_bytes()


def files_of(folder, output):
    beside = folder / output / FOLDERS[output] if output in FOLDERS else folder / output
    return sorted(beside.parent.glob(f"{beside.name}.shard-*"))


@pytest.mark.parametrize(
    "output",
    [
        pytest.param(output, marks=() if output in QUICK else pytest.mark.slow)
        for output in COMMANDS
    ],
)
def test_workers_a_cluster_and_shards_give_the_same_file(call, cluster, tmp_path, output):
    command, wanted = COMMANDS[output], 4 if output in FAILS else 0
    folders = {name: tmp_path / name for name in ("one", "two", "dask", "shards")}
    for folder in folders.values():
        folder.mkdir()
    options = {"one": ("--jobs", "1"), "two": ("--jobs", "2"), "dask": ("--dask", cluster)}
    for name, how in options.items():
        code, _, errors = call(*command, *how, "-o", folders[name] / output)
        assert code == wanted, errors
    for number in (3, 1, 2):
        code, printed, errors = call(
            *command, "--shard", f"{number}/3", "--jobs", "1", "-o", folders["shards"] / output
        )
        assert code == 0, errors
        assert f"shard-{number}-of-3" in printed
    shards = files_of(folders["shards"], output)
    assert len(shards) == 3
    code, _, errors = call("merge", *shards, "-o", folders["shards"] / output)
    assert code == wanted, errors
    for path in shards:
        path.unlink()
    one = content(folders["one"] / output)
    for name in ("two", "dask", "shards"):
        assert content(folders[name] / output) == one, name


@pytest.fixture
def shards(call, tmp_path):
    """The files of both shards of a sweep."""
    command = ("sweep", *PAIR, "--vary", "pinion.face_width=10:20:6 mm", "-o", tmp_path / "s.csv")
    for number in (1, 2):
        assert call(*command, "--shard", f"{number}/2", "--jobs", "1")[0] == 0
    return files_of(tmp_path, "s.csv")


def test_missing_shards_and_points_are_told(call, tmp_path, shards):
    code, _, errors = call("merge", shards[0], "-o", tmp_path / "s.csv")
    assert code == 2
    assert "3 of 6 points belong to shards that are missing from the command" in errors
    lines = shards[1].read_bytes().splitlines(keepends=True)
    shards[1].write_bytes(b"".join(lines[:-1]) + lines[-1][:50])  # killed while it wrote
    code, _, errors = call("merge", *shards, "-o", tmp_path / "s.csv")
    assert code == 2
    assert f'FILE = "{shards[1]}"' in errors or str(shards[1]) in errors
    assert "lacks 1 of its 3 points" in errors
    assert not (tmp_path / "s.csv").exists()


def test_shards_of_another_plan_are_refused(call, tmp_path, shards):
    other = ("sweep", *PAIR, "--vary", "pinion.face_width=10:21:6 mm", "-o", tmp_path / "o.csv")
    assert call(*other, "--shard", "2/2", "--jobs", "1")[0] == 0
    (file,) = files_of(tmp_path, "o.csv")
    code, _, errors = call("merge", shards[0], file, "-o", tmp_path / "s.csv")
    assert code == 2
    assert "holds points of a different study" in errors
    # nor does a shard of another plan write to the same file
    file.replace(shards[1])
    again = ("sweep", *PAIR, "--vary", "pinion.face_width=10:20:6 mm", "-o", tmp_path / "s.csv")
    code, _, errors = call(*again, "--shard", "2/2")
    assert code == 2
    assert "something other than points of this sweep" in errors


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda text: "", "is no file of a shard"),
        (lambda text: "my notes\n" * 3, "is no file of a shard"),
        (lambda text: text.replace('"version":"', '"version":"0.0.0-'), "was made by version"),
        (lambda text: text.replace('"pinion.face_width"', '"pinion.face"'), "was altered"),
        (lambda text: text.replace('"kind":"sweep"', '"kind":"swept"'), "was altered"),
        (lambda text: text.replace('"teeth":', '"tooth":'), "was altered"),
    ],
    ids=["empty", "notes", "version", "axis", "kind", "case"],
)
def test_files_that_are_no_shards_are_refused(call, tmp_path, shards, change, told):
    shards[0].write_text(change(shards[0].read_text()))
    code, _, errors = call("merge", *shards, "-o", tmp_path / "s.csv")
    assert code == 2
    assert told in errors
    assert not (tmp_path / "s.csv").exists()


HEADS = {
    "no shard": lambda study: study.pop("shard"),
    "part of none": lambda study: study.update(shard=[1, 0]),
    "part of parts": lambda study: study.update(shard=[1.5, "2"]),
    "all of it": lambda study: study.update(shard=None),
    "another shard": lambda study: study.update(shard=[2, 2]),
    "no output": lambda study: study.pop("output"),
    "another output": lambda study: study.update(output={"format": "vecto"}),
    "list of outputs": lambda study: study.update(output=[3]),
    "no plan": lambda study: study.pop("plan"),
    "no axes": lambda study: study["plan"].update(axes=[]),
    "axes of none": lambda study: study["plan"].update(axes=[{"key": 5}]),
    "other values": lambda study: study["plan"]["axes"][0].update(values=["10 mm"]),
    "no values": lambda study: study["plan"]["axes"][0].update(values=[], coordinate=[]),
    "case of none": lambda study: study["plan"].update(case=None),
    "links": lambda study: study["plan"].update(links={"a": "1/0"}),
    "source": lambda study: study.update(source="\0"),
    "kind of kinds": lambda study: study.update(kind=["sweep"]),
    "version": lambda study: study.pop("version"),
}
SAME = ("another shard", "all of it", "source")
"""Heads that whoever seals them again may state: all points that they promise are there."""


@pytest.mark.parametrize("sealed_again", [False, True], ids=["altered", "sealed again"])
def test_altered_heads_of_shards_are_refused(call, tmp_path, shards, sealed_again):
    sound = {file: file.read_bytes().split(b"\n") for file in shards}
    for name, change in HEADS.items():
        for file, (begin, head, *points) in sound.items():
            content = json.loads(head)
            content.pop("check")
            change(content["study"])
            line = json.dumps(content, separators=(",", ":")).encode()
            line = runner._sealed(line) if sealed_again else line
            file.write_bytes(b"\n".join([begin, line, *points]))
        code, _, errors = call("merge", *shards, "-o", tmp_path / "s.csv")
        if sealed_again and name in SAME:
            assert code == 0, (name, errors)
            (tmp_path / "s.csv").unlink()
            continue
        assert code == 2, (name, errors)
        assert not (tmp_path / "s.csv").exists()
        assert len(errors) < 2000
        assert sealed_again or name == "version" or "was altered" in errors


def test_points_beyond_the_plan_are_refused(call, tmp_path, shards):
    with shards[1].open("ab") as file:
        line = shards[1].read_bytes().splitlines()[-1]
        record = json.loads(line)
        record.pop("check")
        record["point"] = 6
        file.write(b"\n" + runner._sealed(json.dumps(record, separators=(",", ":")).encode()))
    code, _, errors = call("merge", *shards, "-o", tmp_path / "s.csv")
    assert code == 2
    assert "is damaged" in errors


@pytest.mark.parametrize("shard", ["0/4", "5/4", "x", "1", "1/0", "-1/4", "1/4/2"])
def test_a_shard_that_cannot_be_is_one_error(call, tmp_path, shard):
    code, _, errors = call(*COMMANDS["sweep.nc"], f"--shard={shard}", "-o", tmp_path / "s.nc")
    assert code == 2
    assert errors.count("must be I/N") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX signals")
def test_a_killed_shard_goes_on(call, tmp_path):
    case = ("talbot-2012-pair", "--vary", "operation.torque=1:100:400 N*m")
    command = ("sweep", *case, "-o", tmp_path / "s.csv", "--jobs", "1")
    shard = [sys.executable, "-m", "epicyclic", *map(str, command), "--shard", "2/2"]
    running = subprocess.Popen(shard, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 120
    while not (files := files_of(tmp_path, "s.csv")) or files[0].read_bytes().count(b'"row":') < 20:
        assert running.poll() is None, "it ended before it could be killed"
        assert time.monotonic() < deadline, "it kept no points"
        time.sleep(0.01)
    running.send_signal(signal.SIGKILL)
    running.wait()
    code, printed, errors = call(*command, "--shard", "2/2")
    assert code == 0, errors
    assert "Continuing from" in errors
    assert "76 of 400 points are in" in printed  # the second of two blocks of up to 324
    assert call(*command, "--shard", "1/2")[0] == 0
    assert call("merge", *files_of(tmp_path, "s.csv"), "-o", tmp_path / "s.csv")[0] == 0
    assert call(*command[:-4], "-o", tmp_path / "whole.csv", "--jobs", "1")[0] == 0
    assert (tmp_path / "s.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()


SBATCH = """#!/bin/bash
# stands in for the scheduler: runs the jobs one after the other
if [ "$1" = --parsable ]; then
    last=$(sed -n 's/^#SBATCH --array=1-//p' "$2")
    for task in $(seq "$last"); do SLURM_ARRAY_TASK_ID=$task bash "$2" >&2 || exit 1; done
    echo 17
else
    [ "$1" = --dependency=afterok:17 ] && [ "$2" = --wrap ] && bash -c "$3"
fi
"""


@pytest.mark.skipif(sys.platform == "win32", reason="needs a shell")
@pytest.mark.slow
def test_the_scripts_for_slurm_do_what_they_say(call, tmp_path):
    page = (DOCS / "how-to" / "run-on-a-cluster.md").read_text(encoding="utf-8")
    for name in ("losses.sh", "submit.sh"):
        (script,) = re.findall(rf":caption: {name}\n\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
        (tmp_path / name).write_text(script)
    programs = tmp_path / "bin"
    programs.mkdir()
    command = f'#!/bin/bash\nexec "{sys.executable}" -m epicyclic "$@"\n'
    for name, text in (("sbatch", SBATCH), ("epicyclic", command)):
        (programs / name).write_text(text)
        (programs / name).chmod(0o755)
    done = subprocess.run(
        ["bash", "-e", "submit.sh"], cwd=tmp_path, capture_output=True, text=True, check=False,
        env=os.environ | {"PATH": f"{programs}:{os.environ['PATH']}"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "Wrote 16 points to losses.nc." in done.stdout
    whole = ("--vary", "operation.speed=1000:4000:4 rpm", "--vary", "planet.count=3,4,5,6")
    assert call("sweep", "talbot-2012", *whole, "-o", tmp_path / "whole.nc")[0] == 0
    assert (tmp_path / "losses.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes()


def test_shards_follow_each_other_in_the_order_of_all():
    case = ep.load_case("talbot-2012-pair")
    plan = make_plan(case, {"operation.torque": [f"{i} N*m" for i in range(1, 12)]})
    for count in (1, 2, 3, 11, 20):
        shares = [share_of(plan, (number, count)) for number in range(1, count + 1)]
        assert [point for share in shares for point in share] == plan.order()
        assert max(map(len, shares)) - min(map(len, shares)) <= 1


@pytest.mark.slow
def test_tables_of_flows_do_not_depend_on_which_points_read_them(coarse_talbot):
    vary = {
        "operation.speed": [f"{speed} rpm" for speed in range(1000, 4000, 300)],
        "planet.count": [3, 4],
        "operation.torque": ["-100 N*m", "500 N*m"],
    }
    plan = make_plan(coarse_talbot.updated({"models.pocketing": "isentropic"}), vary)
    whole = plan.prepared(plan.order(), None).flow_tables
    assert len(whole) >= 4  # two meshes, driving and coasting
    last = plan.prepared(share_of(plan, (4, 4))[-1:], None).flow_tables
    assert 0 < len(last) < len(whole)
    for family, table in last.items():
        assert np.array_equal(table.number, whole[family].number)
        assert np.array_equal(table.scaled, whole[family].scaled, equal_nan=True)
        assert np.array_equal(table.readable, whole[family].readable)
        assert table.error == whole[family].error


def test_a_shard_in_python_is_a_journal_to_merge(call, coarse_talbot, tmp_path):
    vary = {"planet.count": [3, 4, 12]}
    whole = ep.sweep(coarse_talbot, vary, jobs=1)
    for number in (1, 2):
        part = ep.sweep(coarse_talbot, vary, shard=(number, 2), journal=tmp_path / f"{number}")
        own = part["status"] != "not computed"
        assert own.sum() == number
        assert part.where(own, drop=True).equals(whole.where(own, drop=True))
        assert np.isnan(part["total"][~own]).all()
    code, _, errors = call("merge", tmp_path / "1", tmp_path / "2", "-o", tmp_path / "s.nc")
    assert code == 4
    assert "overlap" in errors
    with xr.open_dataset(tmp_path / "s.nc") as merged:
        assert merged.identical(whole)
    with pytest.raises(ep.InputError, match="must be I/N"):
        ep.sweep(coarse_talbot, vary, shard=(3, 2))


MEASURED = """# no two numbers are equal
speed [rpm],torque [N*m],temperature [degC],loss [W],uncertainty [W],rig,pinion.face_width [mm]
1013,51,38,12.7,1.9,a,15.5
2929,97,61,61.3,2.3,b,16.25
5871,103,87,140.9,3.1,a,17
4007,8.5,44,33.3,2.7,b,14.75
7919,77,93,121.1,4.3,a,13.5
"""
CYCLE = """time [s],speed [rpm],torque [N*m]
0,1009,21
5.5,3001,-11
9.25,4421,31.5
17,6203,43
23.5,811,-5.75
"""
NO_POCKETS = ("--set", "losses.mesh_pocketing.include=false")
UNCERTAIN = ("--set", "uncertainty={'surroundings.oil_air_ratio'={normal=0.0113}}")


def in_shards(call, command, option, output, count, merged):
    """What is printed when the shards of a command, in any order, are merged to a file."""
    for number in (count, *range(1, count)):
        shard = ("--shard", f"{number}/{count}", "--jobs", "1")
        code, printed, errors = call(*command, *shard, option, output)
        assert code == 0, errors
        assert f"shard-{number}-of-{count}" in printed
    assert not output.exists()
    code, printed, errors = call("merge", *files_of(output.parent, output.name), "-o", merged)
    assert code == 0, errors
    return printed


@pytest.mark.parametrize("how", ["computed", pytest.param("as-tested", marks=pytest.mark.slow)])
def test_shards_of_a_comparison_are_that_of_one_run(call, tmp_path, monkeypatch, how):
    monkeypatch.chdir(tmp_path)
    Path("measured.csv").write_text(MEASURED)
    command = ("compare", "talbot-2012-pair", "measured.csv", *NO_POCKETS, *UNCERTAIN)
    command += ("--group", "rig")
    if how == "as-tested":
        command += ("--load-dependent", how, "--component", "load_dependent")
    code, whole, errors = call(*command, "--jobs", "1", "--json", "one.json", "--plot", "one.png")
    assert code == 0, errors
    drawn = ("--plot", "shards.png")
    output = tmp_path / "shards.json"
    printed = in_shards(call, (*command, *drawn), "--json", output, 3, "merged.json")
    assert Path("merged.json").read_bytes() == Path("one.json").read_bytes()
    assert Path("shards.png").read_bytes() == Path("one.png").read_bytes()
    one, merged = (text.replace("one.", "X.") for text in (whole, printed))
    lines = [line for line in one.splitlines() if not line.startswith("Wrote")]
    assert [line for line in merged.splitlines() if not line.startswith("Wrote")] == lines
    points = json.loads(Path("one.json").read_text())["points"]
    computed = [point["computed [W]"] for point in points]
    assert len({*computed}) == len(computed) == 5
    # measurements are in the shards, and not looked for again
    Path("measured.csv").unlink()
    code, _, errors = call("merge", *files_of(tmp_path, output.name), "-o", "again.json")
    assert code == 0, errors
    assert Path("again.json").read_bytes() == Path("one.json").read_bytes()


@pytest.mark.usefixtures("fails_at_high_speed")
def test_a_comparison_with_points_that_fail_is_the_same_in_shards(call, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("measured.csv").write_text(MEASURED)
    command = ("compare", "talbot-2012-pair", "measured.csv", *NO_POCKETS)
    code, whole, errors = call(*command, "--jobs", "1", "--json", "one.json")
    assert code == 0, errors
    assert "2 of 5 points could not be computed" in " ".join(whole.split())
    in_shards(call, command, "--json", tmp_path / "shards.json", 2, "merged.json")
    assert Path("merged.json").read_bytes() == Path("one.json").read_bytes()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ending", "option"),
    [
        pytest.param(".nc", "-o", marks=pytest.mark.slow),
        (".csv", "-o"),
        pytest.param(".json", "--json", marks=pytest.mark.slow),
    ],
)
def test_shards_of_a_duty_cycle_are_that_of_one_run(call, tmp_path, monkeypatch, ending, option):
    monkeypatch.chdir(tmp_path)
    Path("cycle.csv").write_text(CYCLE)
    command = ("duty", "talbot-2012-pair", "cycle.csv", *NO_POCKETS)
    command += ("--temperature", "41 degC", "--temperature", "83 degC")
    one, shards = tmp_path / f"one{ending}", tmp_path / f"shards{ending}"
    code, whole, errors = call(*command, "--jobs", "1", option, one, "--map", "one-map.nc")
    assert code == 0, errors
    kept = ("--map", "shards-map.nc")
    printed = in_shards(call, (*command, *kept), option, shards, 3, tmp_path / f"merged{ending}")
    assert (tmp_path / f"merged{ending}").read_bytes() == one.read_bytes()
    assert Path("shards-map.nc").read_bytes() == Path("one-map.nc").read_bytes()
    tables = [line for line in whole.splitlines() if not line.startswith("Wrote")]
    assert [line for line in printed.splitlines() if not line.startswith("Wrote")] == tables


@pytest.mark.slow
def test_shards_find_their_cycle_and_no_other(call, tmp_path, monkeypatch):
    computed, elsewhere = tmp_path / "computed", tmp_path / "elsewhere"
    for folder in (computed, elsewhere):
        folder.mkdir()
    monkeypatch.chdir(computed)
    Path("cycle.csv").write_text(CYCLE)
    command = ("duty", "talbot-2012-pair", "cycle.csv", *NO_POCKETS)
    output = computed / "d.csv"
    in_shards(call, command, "-o", output, 2, "merged.csv")
    shards = files_of(computed, "d.csv")
    monkeypatch.chdir(elsewhere)
    assert call("merge", *shards, "-o", "d.csv")[0] == 0  # where the shards were computed
    assert Path("d.csv").read_bytes() == (computed / "merged.csv").read_bytes()
    Path("cycle.csv").write_text(CYCLE.replace("-5.75", "-5.25"))
    code, _, errors = call("merge", *shards, "-o", "e.csv")
    assert code == 2
    assert "has changed since then" in " ".join(errors.split())
    Path("cycle.csv").unlink()
    (computed / "cycle.csv").unlink()
    code, _, errors = call("merge", *shards, "-o", "e.csv")
    assert code == 2
    assert "cannot be read: No such file" in " ".join(errors.split())
    assert not Path("e.csv").exists()


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--fit", "pinion.roughness", "--json", "c.json"), "each round of a fit"),
        (("--journal", "kept", "--json", "c.json"), "are kept beside the file of --json"),
        (("--json", "-"), "must name the file"),
        ((), "must name the file"),
    ],
)
def test_what_is_not_for_shards_of_a_comparison_is_told(call, tmp_path, monkeypatch, options, told):
    monkeypatch.chdir(tmp_path)
    Path("measured.csv").write_text(MEASURED)
    shard = ("--shard", "1/2")
    code, _, errors = call("compare", "talbot-2012-pair", "measured.csv", *shard, *options)
    assert code == 2
    assert told in " ".join(errors.split())
    assert [file.name for file in tmp_path.iterdir()] == ["measured.csv"]


@pytest.mark.parametrize(
    ("source", "options", "told"),
    [
        ("map.nc", ("-o", "d.nc"), "applies to a case, not to a map"),
        ("talbot-2012-pair", (), "must name the file"),
        ("talbot-2012-pair", ("--json", "-"), "must be the only output file"),
        ("talbot-2012-pair", ("--json", "d.json", "-o", "d.nc"), "must be the only output file"),
        ("talbot-2012-pair", ("--journal", "kept", "-o", "d.nc"), "file of -o or --json"),
        ("talbot-2012-pair", ("--json", "d.txt"), "must end in .nc or .csv or .json"),
    ],
)
def test_what_is_not_for_shards_of_a_cycle_is_told(
    call, tmp_path, monkeypatch, source, options, told
):
    monkeypatch.chdir(tmp_path)
    Path("cycle.csv").write_text(CYCLE)
    code, _, errors = call("duty", source, "cycle.csv", "--shard", "1/2", *options)
    assert code == 2
    assert told in " ".join(errors.split())
    assert [file.name for file in tmp_path.iterdir()] == ["cycle.csv"]


@pytest.mark.slow
def test_a_calibration_and_a_duty_cycle_go_on(call, cluster, tmp_path):
    case = ep.load_case("talbot-2012-pair").updated({"losses.mesh_pocketing.include": False})
    lines = ["speed [rpm],torque [N*m],temperature [degC],loss [W]"]
    for speed, torque in ((1000, 50), (3000, 100), (6000, 100)):
        point = case.updated(
            {"operation.speed": f"{speed} rpm", "operation.torque": f"{torque} N*m"}
        )
        loss = 1.1 * ep.solve(point).total
        lines.append(f"{speed},{torque},90,{loss}")
    measured = tmp_path / "measured.csv"
    measured.write_text("\n".join(lines))
    off = ("--set", "losses.mesh_pocketing.include=false")
    command = ("compare", "talbot-2012-pair", measured, *off, "--fit", "pinion.roughness")
    cycle = tmp_path / "cycle.csv"
    cycle.write_text("time [s],speed [rpm],torque [N*m]\n0,1000,20\n5,3000,-10\n9,4000,30\n")
    duty = ("duty", "talbot-2012-pair", cycle, *off)
    for arguments in (command, duty):
        plain = call(*arguments, "--jobs", "1", "--json", "-")
        assert plain[0] == 0, plain[2]
        folder = tmp_path / arguments[0]
        kept = call(*arguments, "--dask", cluster, "--journal", folder, "--json", "-")
        assert json.loads(kept[1]) == json.loads(plain[1])
        files = sorted(folder.iterdir())
        assert len(files) >= 2
        before = [file.read_bytes() for file in files]
        again = call(*arguments, "--jobs", "1", "--journal", folder, "--json", "-")
        assert again[1] == plain[1]
        assert [file.read_bytes() for file in files] == before  # nothing was computed again


def test_a_journal_in_a_file_is_refused_where_it_is_a_folder(call, tmp_path):
    (tmp_path / "file").touch()
    (tmp_path / "cycle.csv").write_text("time [s],speed [rpm],torque [N*m]\n0,1000,20\n5,3000,10\n")
    duty = ("duty", "talbot-2012-pair", tmp_path / "cycle.csv", "--journal", tmp_path / "file")
    code, _, errors = call(*duty)
    assert code == 2
    assert "cannot hold a folder" in errors


def test_a_cluster_of_another_version_is_refused(cluster, monkeypatch):
    from epicyclic.study.sweeps import runner

    version = runner.metadata.version("epicyclic")
    told = iter([version, "0.0.0"])  # here, then in the worker, which is in this process
    monkeypatch.setattr(runner.metadata, "version", lambda name: next(told, "0.0.0"))
    case = ep.load_case("talbot-2012-pair")
    with pytest.raises(ep.InputError, match=r"have version 0\.0\.0"):
        Runner(dask=cluster).run(make_plan(case, {"operation.torque": ["1 N*m"]}))


def test_an_interruption_cancels_what_the_cluster_has_left(cluster, tmp_path):
    import distributed

    def stop(done, total):
        if done:
            raise KeyboardInterrupt

    case = ep.load_case("talbot-2012-pair")
    vary = {"operation.torque": [f"{i} N*m" for i in range(1, 800)]}
    with pytest.raises(KeyboardInterrupt):
        ep.sweep(case, vary, dask=cluster, journal=tmp_path / "points", progress=stop)
    kept = (tmp_path / "points").read_bytes().count(b'"row":')
    assert 0 < kept < 799
    with distributed.Client(cluster) as client:
        deadline = time.monotonic() + 30
        while client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)):
            assert time.monotonic() < deadline, "tasks are left"
            time.sleep(0.1)


def test_columns_hold_what_was_added():
    from epicyclic.study.sweeps.runner import Row

    rows = Rows(3)
    rows.add(2, Row("converged", numbers={"total": 1.5}))
    rows.add(0, Row("failed", "no reason"))
    assert rows.status == ["failed", "not computed", "converged"]
    assert rows.failures == ["no reason"]
    assert np.array_equal(rows.numbers("total"), [np.nan, np.nan, 1.5], equal_nan=True)
    assert np.isnan(rows.numbers("efficiency")).all()
