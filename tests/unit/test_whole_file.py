"""Files are written whole or not at all, and nothing is left behind."""

from __future__ import annotations

import os
import resource
import signal
import stat
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

import epicyclic as ep
from epicyclic.files import PREFIX, check_place, make_folder, whole_file, write_file

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX files")


def names_in(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.fixture
def umask():
    """A umask that no default is equal to."""
    before = os.umask(0o027)
    yield 0o027
    os.umask(before)


def test_permissions_of_a_new_file_follow_the_umask(tmp_path, umask):
    write_file(tmp_path / "new.json", "{}")
    with whole_file(tmp_path / "new.nc") as temporary:
        xr.Dataset({"x": 1.0}).to_netcdf(temporary, engine="netcdf4")
    for name in names_in(tmp_path):
        assert stat.S_IMODE((tmp_path / name).stat().st_mode) == 0o640, name


@pytest.mark.parametrize("mode", [0o600, 0o664])
def test_a_file_that_is_replaced_keeps_its_permissions(tmp_path, umask, mode):
    path = tmp_path / "old.json"
    path.write_text("old")
    path.chmod(mode)
    write_file(path, "new")
    assert path.read_text() == "new"
    assert stat.S_IMODE(path.stat().st_mode) == mode


def test_predictable_names_lead_nowhere(tmp_path):
    victim = tmp_path / "victim"
    victim.write_text("precious")
    for name in (".r.json.tmp", f"{PREFIX}r.json"):
        (tmp_path / name).symlink_to(victim)
    write_file(tmp_path / "r.json", "{}")
    assert victim.read_text() == "precious"
    assert (tmp_path / "r.json").read_text() == "{}"


def test_the_folder_of_the_unfinished_file_is_private(tmp_path):
    with whole_file(tmp_path / "r.json") as temporary:
        assert stat.S_IMODE(temporary.parent.stat().st_mode) == 0o700
        temporary.write_text("{}")
    assert names_in(tmp_path) == ["r.json"]


def test_an_error_leaves_the_old_file(tmp_path):
    path = tmp_path / "r.json"
    path.write_text("old")

    def interrupted():
        with whole_file(path) as temporary:
            temporary.write_text("new")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert path.read_text() == "old"
    assert names_in(tmp_path) == ["r.json"]


@pytest.fixture
def full_disk(request):
    """Files cannot grow beyond a few kilobytes, or at all, as on a full disk."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (request.param, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("full_disk", [0, 3, 4096], indirect=True)
@pytest.mark.parametrize("name", ["r.nc", "r.csv", "r.parquet"])
def test_a_full_disk_is_told_plainly(tmp_path, full_disk, name):
    from epicyclic.study.sweeps.run import write_dataset

    data = xr.Dataset({"loss": ("point", np.random.default_rng(1).random(100_000))})
    with pytest.raises(ep.InputError, match="cannot be written") as error:
        write_dataset(data, tmp_path / name)
    assert "ermission" not in str(error.value)
    assert names_in(tmp_path) == []


@pytest.mark.parametrize("name", ["x" * 300, "a\0b", "folder/is/not/there.nc"])
@pytest.mark.parametrize("call", [check_place, lambda path: write_file(path, "{}")])
def test_impossible_names_are_told_plainly(tmp_path, name, call):
    with pytest.raises(ep.InputError) as error:
        call(tmp_path / name)
    assert len(error.value.problems) == 1
    assert names_in(tmp_path) == []


@pytest.mark.parametrize("name", ["x" * 300, "a\0b", "file/below"])
def test_impossible_folders_are_told_plainly(tmp_path, name):
    (tmp_path / "file").write_text("")
    with pytest.raises(ep.InputError, match="cannot hold a folder"):
        make_folder(tmp_path / name)


def test_a_name_of_the_greatest_length_can_be_written(tmp_path):
    path = tmp_path / ("x" * 250 + ".json")
    write_file(path, "{}")
    assert path.read_text() == "{}"


def test_a_write_protected_file_is_not_replaced(tmp_path, monkeypatch):
    path = tmp_path / "r.json"
    path.write_text("old")
    usual = os.access
    # root may write to all files
    monkeypatch.setattr(os, "access", lambda p, mode: p != path and usual(p, mode))
    with pytest.raises(ep.InputError, match="write-protected"):
        write_file(path, "new")
    assert path.read_text() == "old"


WRITER = """\
import signal, sys, time
from pathlib import Path
from epicyclic.files import whole_file
signal.signal(signal.SIGINT, signal.default_int_handler)  # a suite in the background ignores it
with whole_file(Path(sys.argv[1])) as temporary:
    temporary.write_text("half")
    print("writing", flush=True)
    time.sleep(60)
"""


def test_what_a_killed_writer_leaves_is_removed_by_the_next(tmp_path):
    path = tmp_path / "r.json"
    path.write_text("old")
    writers = []
    for _ in range(2):
        writers.append(
            subprocess.Popen([sys.executable, "-c", WRITER, str(path)], stdout=subprocess.PIPE)
        )
        assert writers[-1].stdout.readline() == b"writing\n"
    killed, alive = writers
    killed.kill()
    killed.communicate()
    assert len(names_in(tmp_path)) == 3
    write_file(tmp_path / "other.json", "{}")
    left = names_in(tmp_path)
    assert left[1:] == ["other.json", "r.json"]  # the folder of the one that lives stays
    assert left[0].startswith(PREFIX)
    alive.send_signal(signal.SIGINT)
    alive.communicate()
    assert path.read_text() == "old"
    assert names_in(tmp_path) == ["other.json", "r.json"]
