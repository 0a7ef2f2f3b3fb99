"""Plug-ins: what they declare is there, and the core works without any of them."""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import get_args

import click
import pytest

import epicyclic as ep
from epicyclic.errors import InputError
from epicyclic.registry import Kind, load, offered, plug_ins
from epicyclic.study.maps.formats import Format
from epicyclic.study.sweeps.runner import Plan

PACKAGE = Path(ep.__file__).parent


@pytest.mark.parametrize("kind", get_args(Kind))
def test_what_plug_ins_declare_is_there_and_declared_once(kind):
    names = [name for plug_in in plug_ins().values() for name in plug_in.get(kind, {})]
    assert names
    assert len(set(names)) == len(names)
    found = {name: load(kind, name) for name in offered(kind)}
    for name, item in found.items():
        if kind == "commands":
            assert isinstance(item, click.Command)
            assert item.name == name
        elif kind == "map_formats":
            assert isinstance(item, Format)
        elif kind == "plans":
            assert issubclass(item, Plan)
            assert item.kind == name
            assert name in offered("plan_writers")
        else:
            assert callable(item)


def test_every_folder_of_plug_ins_is_found():
    folders = {path.parent.name for path in (PACKAGE / "plugins").glob("*/__init__.py")}
    assert {name.rpartition(".")[2] for name in plug_ins()} == folders | {"validation"}


@pytest.mark.slow
@pytest.mark.parametrize(
    "gone",
    [
        "plugins",
        pytest.param("plugins/app", marks=pytest.mark.slow),
        pytest.param("validation", marks=pytest.mark.slow),
    ],
)
def test_the_rest_works_without_a_plug_in(gone, tmp_path):
    copy = tmp_path / "epicyclic"
    shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.rmtree(copy / gone)
    for words in (["--help"], ["cases"], ["check", "talbot-2012"]):
        done = subprocess.run(
            [sys.executable, "-m", "epicyclic", *words],
            env={**os.environ, "PYTHONPATH": str(tmp_path)},
            cwd=tmp_path,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        assert not done.stderr
        if words == ["--help"]:
            commands = {line.split()[0] for line in done.stdout.splitlines() if line.strip()}
            assert {"run", "sweep", "merge"} <= commands
            assert ("app" in commands) == (gone == "validation")
            assert ("validate" in commands) == (gone != "validation")


def test_a_model_of_a_missing_plug_in_is_refused(monkeypatch):
    monkeypatch.setattr("epicyclic.build.models.offered", lambda kind: {})
    case = ep.load_case("talbot-2012-pair").updated({"models.friction": "ehl-direct"})
    with pytest.raises(InputError, match="plug-in that is not installed"):
        ep.solve(case)
