"""Where compiled kernels are kept."""

from __future__ import annotations

import tempfile
from pathlib import Path

import platformdirs
import pytest

from epicyclic.kernels import _jit


@pytest.fixture
def source(tmp_path):
    folder = tmp_path / "kernels"
    folder.mkdir()
    (folder / "one.py").write_text("x = 1\n")
    return folder


@pytest.fixture
def places(tmp_path, monkeypatch):
    """Stand-ins for the user's cache folder and for the folder of temporary files."""
    home, temporary = tmp_path / "home", tmp_path / "tmp"
    temporary.mkdir()
    monkeypatch.setattr(platformdirs, "user_cache_dir", lambda _: str(home))
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(temporary))
    return home, temporary


def test_the_folder_changes_with_any_kernel(source, places):
    before = _jit.cache_directory(source)
    (source / "two.py").write_text("y = 2\n")
    after = _jit.cache_directory(source)
    assert before != after
    assert before.parent == after.parent == places[0]


def test_without_a_home_the_folder_of_temporary_files_serves(source, places):
    home, temporary = places
    home.write_text("a file where the folder should be")
    folder = _jit.cache_directory(source)
    assert temporary in folder.parents
    assert folder.parent.stat().st_mode & 0o077 == 0


def test_a_folder_of_another_user_is_not_taken(source, places, monkeypatch):
    monkeypatch.setattr(_jit, "_USER", -1)  # all folders belong to somebody else
    assert _jit.cache_directory(source) is None


def test_the_kernels_of_this_run_are_kept():
    assert _jit._CACHE_DIR is not None
    assert Path(_jit._CACHE_DIR).is_dir()
