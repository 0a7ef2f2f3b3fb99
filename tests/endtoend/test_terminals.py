"""Unusual terminals and names: a plain error or a replacement sign, never a traceback."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import epicyclic as ep

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs a POSIX shell")

LONG = "x" * 300
RUN = f"{sys.executable} -m epicyclic"


def shell(command, folder, **environment):
    return subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=os.environ | environment,
        capture_output=True,
        check=False,
        timeout=300,
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("encoding", "command"),
    [("cp1252", "run talbot-2012-pair"), ("ascii", "oils"), ("latin-1", "cases")],
)
def test_signs_that_a_terminal_does_not_know_are_replaced(tmp_path, encoding, command):
    done = shell(f"{RUN} {command}", tmp_path, PYTHONIOENCODING=encoding)
    assert done.returncode == 0, done.stderr
    shown = done.stdout.decode(encoding)  # nothing that the terminal does not know
    assert len(shown.splitlines()) > 5


@pytest.mark.slow
@pytest.mark.parametrize(
    "command",
    [
        "schema",
        "run --json",
        pytest.param("run talbot-2012-pair", marks=pytest.mark.slow),
        pytest.param("--help", marks=pytest.mark.slow),
    ],
)
def test_a_full_disk_behind_the_output_is_told(tmp_path, command):
    command = command.replace("--json", "talbot-2012-pair --json")
    done = shell(f"{RUN} {command} > /dev/full", tmp_path)
    assert done.returncode == 2
    assert (
        done.stderr.decode()
        == "The system refused access to the output: No space left on device.\n"
    )


def test_a_pipe_that_is_closed_early_is_no_error(tmp_path):
    done = shell(f"{RUN} schema | head -c 100 > /dev/null; echo ${{PIPESTATUS[0]}}", tmp_path)
    assert done.stdout.decode().strip() in ("0", "141")  # all of it may have been written before
    assert done.stderr == b""


@pytest.mark.parametrize(
    "command",
    ["schema", "cases", pytest.param("run talbot-2012-pair --json -", marks=pytest.mark.slow)],
)
def test_an_output_that_is_closed_is_told(tmp_path, command):
    done = shell(f"{RUN} {command} >&-", tmp_path)
    assert done.returncode == 2
    assert done.stderr.decode() == "The system refused access to the output: not writable.\n"


@pytest.mark.parametrize("command", ["schema", "cases"])
def test_a_pipe_without_a_reader_has_its_code(tmp_path, command):
    done = shell(f"(sleep 0; exec {RUN} {command}) | true; echo ${{PIPESTATUS[0]}}", tmp_path)
    assert done.stdout.decode().strip() == "141"
    assert done.stderr == b""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "code"),
    [
        ("run talbot-2012-pair --save r.nc", 2),
        *(
            pytest.param(command, code, marks=pytest.mark.slow)
            for command, code in (
                ("run talbot-2012-pair", 0), ("run case.toml", 2), ("init", 2),
                ("map talbot-2012 --speed 1:9:3rpm --torque 1:9:3N*m -o m.nc", 2),
            )
        ),
    ],
)  # fmt: skip
def test_a_deleted_folder_is_told(tmp_path, command, code):
    done = shell(f"mkdir gone; cd gone; rmdir ../gone; {RUN} {command}", tmp_path)
    assert done.returncode == code, done.stderr
    assert b"Error of the program" not in done.stderr


COMMANDS = (
    "run {name}.toml",
    "run talbot-2012-pair --save {name}.nc",
    "run talbot-2012-pair --json {name}.json",
    "run talbot-2012-pair --set models.oil_model={name}.json",
    "run talbot-2012-pair --set models.pocketing_table={name}.nc",
    "duty {name}.nc cycle.csv",
    "duty talbot-2012-pair {name}.csv",
    "sweep talbot-2012-pair --vary operation.speed=1,2rpm -o {name}.csv",
    "init {name}.toml",
    "report {name}.nc -o r.html",
    "report talbot-2012-pair -o {name}.html",
    "compare talbot-2012-pair {name}.csv",
    "rexs import {name}.rexs",
    "merge {name} -o x.csv",
    "oil show {name}",
    "oil fit {name}",
    "oil characterise atf-talbot-2012 --size 4 -o {name}",
    "pockets-table talbot-2012-pair --speed 1,2rpm -o {name}.nc",
    "contact --set surface1.profile={name}.csv",
    "{name}",
)


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS)
def test_impossible_names_are_told(tmp_path, monkeypatch, capsys, command):
    from epicyclic.cli.main import main

    monkeypatch.chdir(tmp_path)
    given = ["epicyclic", *(part.format(name=LONG) for part in command.split())]
    monkeypatch.setattr("sys.argv", given)
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2, capsys.readouterr().err
    assert len(capsys.readouterr().err) < 3000
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("sign", ["\x1b[31m", "\x07", "\x00", "\x9b2J", "\ud800"])
def test_control_characters_come_no_further_than_the_case(sign):
    with pytest.raises(ep.InputError, match=r"title.*contains control characters") as error:
        ep.load_case("talbot-2012", {"title": f"gears{sign}!"})
    assert sign not in str(error.value)
    with pytest.raises(ep.InputError, match="extra") as error:
        ep.load_case("talbot-2012", {f"extra{sign}": 1})
    assert sign not in str(error.value)


def test_titles_of_several_lines_are_allowed():
    case = ep.load_case("talbot-2012", {"title": "gears\n\tand more"})
    assert case.title == "gears\n\tand more"


def test_titles_in_a_file_are_checked(tmp_path):
    path = tmp_path / "case.toml"
    text = Path(ep.__file__).parent / "library" / "cases" / "talbot-2012-pair.toml"
    lines = text.read_text(encoding="utf-8").splitlines()
    lines = [r'title = "a\u001b]0;b"' if line.startswith("title") else line for line in lines]
    path.write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(ep.InputError, match=r"title.*contains control characters"):
        ep.load_case(path)
