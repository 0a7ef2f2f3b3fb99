"""What a refused or killed command leaves behind: nothing that the next one cannot use."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import pytest

import epicyclic as ep


@pytest.mark.parametrize(
    "arguments",
    [
        ("sweep", "talbot-2012-pair", "--vary", "operation.speed=1,2 rpm", "-o", "s.csv"),
        ("oil", "characterise", "atf-talbot-2012", "--size", "8", "-o", "atf"),
        ("study", "talbot-2012-pair", "--what", "speed", "-o", "folder"),
        ("reproduce", "5", "--figure", "5.1", "-o", "folder"),
    ],
    ids=lambda arguments: arguments[0],
)
def test_a_cluster_that_is_not_there_leaves_nothing(tmp_path, monkeypatch, capsys, arguments):
    from epicyclic.cli.main import main

    monkeypatch.chdir(tmp_path)
    command = ["epicyclic", *arguments, "--dask", "tcp://127.0.0.1:no-port"]
    monkeypatch.setattr("sys.argv", command)
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    assert "cannot be reached" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_campaign_in_python_leaves_nothing_either(tmp_path):
    with pytest.raises(ep.InputError, match="cannot be reached"):
        ep.characterise_oil(
            "atf-talbot-2012", tmp_path / "atf", size=8, dask="tcp://127.0.0.1:no-port"
        )
    assert list(tmp_path.iterdir()) == []


def workers_of(session):
    """Processes of a session that are alive."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if fields[3] == str(session) and fields[0] != "Z":
            found.append(entry.name)
    return found


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_workers_of_a_killed_command_end_quietly(tmp_path):
    with (tmp_path / "errors").open("w") as errors:
        process = subprocess.Popen(
            [sys.executable, "-m", "epicyclic", "oil", "characterise", "atf-talbot-2012",
             "--size", "64", "--jobs", "2", "-o", str(tmp_path / "atf")],
            stdout=errors, stderr=errors, start_new_session=True,
        )  # fmt: skip
        journal = tmp_path / "atf" / "simulations.partial"
        deadline = time.monotonic() + 180
        while not (journal.exists() and b'"row":' in journal.read_bytes()):
            assert process.poll() is None
            assert time.monotonic() < deadline
            time.sleep(0.1)
        assert len(workers_of(process.pid)) > 2
        locks = [path.name for path in Path("/dev/shm").glob(f"sem.loky-{process.pid}-*")]
        assert locks
        process.kill()
        process.wait()
        deadline = time.monotonic() + 20
        while workers_of(process.pid):
            assert time.monotonic() < deadline, "workers are left"
            time.sleep(0.1)
    assert not any((Path("/dev/shm") / name).exists() for name in locks)
    said = (tmp_path / "errors").read_text().splitlines()
    assert said[0] == "64 contacts, 0 of them already simulated."
    assert all(line.startswith("contacts: ") for line in said[1:])  # progress, where it takes long
