"""Where compiled kernels and units are kept, and what happens when that place is not sound."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import platformdirs
import pytest

from epicyclic import cache_folder
from epicyclic.cache_folder import private_folder
from epicyclic.kernels import compiling as _jit
from epicyclic.kernels.contact_load import local_law

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX permissions")


@pytest.fixture
def source(tmp_path):
    package = tmp_path / "package"
    (package / "kernels").mkdir(parents=True)
    (package / "plugins" / "solver").mkdir(parents=True)
    (package / "kernels" / "one.py").write_text("x = 1\n")
    return package


@pytest.fixture
def places(tmp_path, monkeypatch):
    """Stand-ins for the user's cache folder and for the folder of temporary files."""
    home, temporary = tmp_path / "home", tmp_path / "tmp"
    temporary.mkdir()
    monkeypatch.setattr(platformdirs, "user_cache_dir", lambda _: str(home))
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(temporary))
    return home, temporary


@pytest.mark.parametrize("added", ["kernels/two.py", "plugins/solver/kernels_two.py"])
def test_the_folder_changes_with_any_kernel(source, added):
    before = _jit.cache_name(source)
    (source / added).write_text("y = 2\n")
    assert before != _jit.cache_name(source)


@pytest.mark.parametrize("given", [None, "shared"])
def test_every_version_has_a_folder_of_its_own(places, tmp_path, monkeypatch, given):
    parent = places[0]
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    if given is not None:
        parent = tmp_path / given
        monkeypatch.setenv("NUMBA_CACHE_DIR", str(parent))
    package = Path(_jit.__file__).parents[1]
    assert _jit._chosen_directory() == parent / _jit.cache_name(package)


def test_without_a_home_the_folder_of_temporary_files_serves(places):
    home, temporary = places
    home.write_text("a file where the folder should be")
    folder = private_folder("units")
    assert temporary in folder.parents
    assert folder.parent.stat().st_mode & 0o077 == 0


def test_a_folder_of_another_user_is_not_taken(places, monkeypatch):
    monkeypatch.setattr(cache_folder, "_USER", -1)  # all folders belong to somebody else
    assert private_folder("units") is None


@pytest.mark.parametrize("mode", [0o770, 0o707, 0o1777])
@pytest.mark.parametrize("which", ["folder", "parent"])
def test_a_folder_that_others_can_write_to_is_not_taken(places, mode, which):
    home, temporary = places
    (home / "units").mkdir(parents=True)
    (home / "units" if which == "folder" else home).chmod(mode)
    assert temporary in private_folder("units").parents


def test_the_kernels_of_this_run_are_kept():
    assert _jit._CACHE_DIR is not None
    assert Path(_jit._CACHE_DIR).is_dir()
    cached = local_law._cache
    assert cached.cache_path == str(_jit._CACHE_DIR)  # wherever the package is


KERNEL = """\
from epicyclic.kernels.compiling import cache_notes, kernel

@kernel
def half(x):
    return x / 2

print(half(7.0), *cache_notes(), sep="\\n")
"""


def outcome(folder, *, cache=None, before="", **environment):
    """What a small program with one kernel prints, with a cache folder of its own."""
    program = folder / "program.py"
    program.write_text(before + KERNEL)
    settings = os.environ | {"XDG_CACHE_HOME": str(cache or folder / "cache")} | environment
    settings.pop("NUMBA_CACHE_DIR", None) if "NUMBA_CACHE_DIR" not in environment else None
    number, *notes = _output(program, settings).splitlines()
    assert number == "3.5"
    return notes


CALLER = """\
from epicyclic.kernels.compiling import kernel
from program import half

@kernel
def and_one(x):
    return half(x) + 1

print(and_one(9.0), sum(half.stats.cache_hits.values()), sum(and_one.stats.cache_hits.values()))
"""


@pytest.mark.slow
def test_a_kernel_is_compiled_with_one_that_was_kept(tmp_path):
    """What callers are compiled with is kept beside the machine code, and read only then."""
    assert outcome(tmp_path) == []
    settings = os.environ | {"XDG_CACHE_HOME": str(tmp_path / "cache")}
    settings.pop("NUMBA_CACHE_DIR", None)
    caller = tmp_path / "caller.py"
    caller.write_text(CALLER)
    for _ in range(2):  # compiled, and kept
        *_, said = _output(caller, settings).splitlines()
        assert said.startswith("5.5 1 ")
    assert said == "5.5 1 1"


def emptied(path):
    path.write_bytes(b"")


def with_a_wrong_byte(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 0x40
    path.write_bytes(content)


def cut(path):
    path.write_bytes(path.read_bytes()[:-30])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "damage"),
    [
        ("*.nbc", with_a_wrong_byte),
        *(
            pytest.param(kind, damage, marks=pytest.mark.slow)
            for kind, damage in (
                ("*.nbi", emptied), ("*.nbi", with_a_wrong_byte), ("*.nbi", cut),
                ("*.nbc", emptied), ("*.nbc", cut),
            )
        ),
    ],
)  # fmt: skip
def test_damaged_code_is_compiled_again(tmp_path, kind, damage):
    assert outcome(tmp_path) == []
    files = list((tmp_path / "cache").rglob(kind))
    assert len(files) == 1
    damage(files[0])
    notes = outcome(tmp_path)
    if damage is not with_a_wrong_byte or kind == "*.nbc":  # the index may still be readable
        assert len(notes) == 1
        assert str(files[0].parent) in notes[0]
    assert outcome(tmp_path) == []  # repaired


FULL = """\
import resource
resource.setrlimit(resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
"""


def test_a_full_disk_costs_time_only(tmp_path):
    (note,) = outcome(tmp_path, before=FULL)
    assert note.startswith("Compiled code cannot be kept in ")
    assert str(tmp_path / "cache") in note


@pytest.mark.slow
def test_a_folder_of_the_user_must_be_private_too(tmp_path):
    given = tmp_path / "given"
    given.mkdir()
    assert outcome(tmp_path, NUMBA_CACHE_DIR=str(given)) == []
    assert list(given.rglob("*.nbc"))
    given.chmod(0o777)
    (note,) = outcome(tmp_path, NUMBA_CACHE_DIR=str(given))
    assert note == f"NUMBA_CACHE_DIR is not used, because others may write to {given}."


TWO = """\
import os
import sys
from epicyclic.kernels.compiling import kernel
from epicyclic.kernels import listeners

told, copies, fork = [], [], os.fork
listeners.append(lambda: told.append(os.getpid()))
__name__ = "epicyclic.two"  # listeners are told of kernels of the package only
sys.modules[__name__] = sys.modules["__main__"]
os.fork = lambda: copies.append(os.getpid()) or fork()

@kernel
def half(x):
    return x / 2

@kernel
def and_one(x):
    return half(x) + 1

@kernel
def less_three(x):
    return x - 3

assert (and_one(7.0), less_three(11.0)) == (4.5, 8.0)
assert set(told) <= {os.getpid()}
hits = [sum(one.stats.cache_hits.values()) for one in (half, and_one, less_three)]
print(3.5, len(told), len(copies), hits, sep="\\n")
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere kernels are compiled in place")
def test_kernels_are_compiled_in_a_copy_of_the_process(tmp_path):
    """The copy keeps the memory of the compiler; this process reads what it has put on the disk."""
    program = tmp_path / "one" / "program.py"
    program.parent.mkdir()
    program.write_text(TWO)
    assert printed(program) == ["3", "2", "[0, 1, 1]"]
    assert printed(program) == ["0", "0", "[0, 1, 1]"]
    elsewhere = program.parent.rename(tmp_path / "two") / "program.py"  # and another time
    elsewhere.write_text(TWO)
    assert printed(elsewhere) == ["0", "0", "[0, 1, 1]"]
    elsewhere.write_text(TWO.replace("x - 3", "x - 2 - 1"))
    assert printed(elsewhere)[0] == "3"


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere kernels are compiled in place")
def test_a_copy_that_can_keep_nothing_is_made_once(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(FULL + TWO)
    told, copies, hits = printed(program)
    assert copies == "1"
    assert told == "3"  # each once, though two of them compiled in the copy before
    assert hits == "[0, 0, 0]"


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere kernels are compiled in place")
def test_of_programs_that_start_together_one_compiles_a_kernel(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(TWO.replace("told, copies", "input()\ntold, copies", 1))
    running = [
        subprocess.Popen(
            [sys.executable, str(program)],
            env=settings_beside(program),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for _ in range(2)
    ]
    for process in running:  # both have imported all that they need, and wait for a line
        process.stdin.write("\n")
        process.stdin.flush()
    told = [int(process.communicate()[0].splitlines()[1]) for process in running]
    assert sum(told) == 3, told


WRONG = """
import numpy, pytest
from numba.core.errors import TypingError
from epicyclic.kernels.compiling import kernel

@kernel
def halved(x):
    return x / 2.0

@kernel
def both(x, y):
    return halved(x) + halved(y)

with pytest.raises(TypingError):
    both("of words", (2.0, 5.0))
print(both(3.0, 4.0))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere kernels are compiled in place")
def test_a_kernel_that_cannot_be_compiled_is_not_waited_for(tmp_path):
    program = tmp_path / "program.py"
    program.write_text("print()\n" + WRONG)
    assert printed(program) == ["3.5"]


COMING = """\
from threading import enumerate, main_thread
from epicyclic.kernels import ahead
ahead.append(lambda: less_three(11.0))
assert and_one(7.0) == 4.5
for thread in enumerate():  # one follows the copy that does the work to come
    if thread is not main_thread():
        thread.join()
before = len(copies)
assert less_three(11.0) == 8.0
assert not ahead and len(copies) == before == 2

assert ("""


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere kernels are compiled in place")
def test_kernels_of_work_to_come_are_compiled_meanwhile(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(TWO.replace("assert (", COMING, 1))
    assert printed(program) == ["3", "2", "[0, 1, 1]"]


def settings_beside(program):
    """The environment with a cache folder beside a program."""
    settings = os.environ | {"XDG_CACHE_HOME": str(program.parent / "cache")}
    settings.pop("NUMBA_CACHE_DIR", None)
    return settings


def printed(program):
    """What a program prints with a cache folder beside it, but for its first line."""
    return _output(program, settings_beside(program)).splitlines()[1:]


def _output(program, settings):
    done = subprocess.run(
        [sys.executable, str(program)],
        env=settings,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout
