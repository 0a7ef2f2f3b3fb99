"""The packages that users install: what is in them, and that they run outside the tree.

Tests that install take minutes and need a package index: they are slow.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

import epicyclic as ep

ROOT = Path(__file__).parents[2]
LARGEST_WHEEL = 3_000_000
"""Of which most is fitted models of oils. [byte]"""
CORE = (
    "tests/frozen/test_frozen_results.py",
    "tests/unit/test_damaged_files.py",
    "tests/unit/test_records.py",
    "tests/unit/test_report_html.py",
    "tests/unit/test_sweep_plots.py",
)
"""What passes through all the libraries: results, files, pictures, reports."""


def run(*command: object, folder: Path) -> str:
    """What a command prints, run in a folder outside the tree, whatever PYTHONPATH adds to it."""
    result = subprocess.run(
        [str(part) for part in command],
        cwd=folder,
        env={key: value for key, value in os.environ.items() if key != "PYTHONPATH"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def uv(*arguments: object, folder: Path) -> None:
    run(sys.executable, "-m", "uv", "--quiet", *arguments, folder=folder)


def environment_with(folder: Path, *requirements: object) -> Path:
    """Programs of a new environment in which `requirements` are installed and nothing else."""
    uv("venv", "--python", sys.executable, "env", folder=folder)
    uv("pip", "install", "--python", "env", *requirements, folder=folder)
    return folder / "env" / ("Scripts" if sys.platform == "win32" else "bin")


@pytest.fixture(scope="module")
def packages(tmp_path_factory):
    """The folder of the sdist and of the wheel that is built from it."""
    folder = tmp_path_factory.mktemp("dist")
    run(sys.executable, "-m", "build", "--no-isolation", "-o", folder, ROOT, folder=folder)
    return folder


@pytest.fixture(scope="module")
def wheel(packages):
    (found,) = packages.glob("*.whl")
    return found


@pytest.fixture(scope="module")
def sdist(packages):
    (found,) = packages.glob("*.tar.gz")
    return found


def sources(folder):
    return {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / folder).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def test_the_wheel_holds_the_whole_package_and_is_small(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    package = {name.removeprefix("src/") for name in sources("src/epicyclic")}
    assert package <= names
    assert all(".dist-info/" in name for name in names - package)
    assert wheel.stat().st_size < LARGEST_WHEEL


def test_the_sdist_holds_what_its_tests_and_its_manual_need(sdist):
    with tarfile.open(sdist) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    wanted = {"README.md", "LICENSE", "CITATION.cff", "CHANGELOG.md", "codemeta.json"}
    for folder in ("tests", "scripts", "benchmarks"):
        wanted |= {name for name in sources(folder) if name.endswith(".py")}
    wanted |= {name for name in sources("docs") if name.endswith(".md")}
    assert wanted <= names


@pytest.mark.slow
@pytest.mark.parametrize("package", ["wheel", "sdist"])
def test_a_package_runs_in_an_environment_of_its_own(package, request, tmp_path, talbot):
    programs = environment_with(tmp_path, request.getfixturevalue(package))
    where = run(programs / "python", "-c", "import epicyclic; print(epicyclic.__file__)",
                folder=tmp_path)  # fmt: skip
    assert Path(where.strip()).is_relative_to(tmp_path)
    printed = json.loads(run(programs / "epicyclic", "run", "talbot-2012", "--json",
                             folder=tmp_path))  # fmt: skip
    assert printed["total"] == pytest.approx(ep.solve(talbot).total, rel=1e-12)


@pytest.mark.slow
@pytest.mark.skipif(sys.version_info >= (3, 12), reason="the oldest wheels are of Python 3.11")
def test_the_lowest_declared_versions_do(wheel, tmp_path):
    """Warnings of old libraries about each other are no errors here."""
    tools = ("pytest==8.0.0", "hypothesis==6.100.0", "pytest-xdist==3.6.1", "jsonschema==4.20.0")
    lowest = ("--resolution", "lowest-direct", "--extra", "x3p", "-r", ROOT / "pyproject.toml")
    programs = environment_with(tmp_path, *lowest, *tools)
    uv("pip", "install", "--python", "env", "--no-deps", wheel, folder=tmp_path)
    options = ("-n", "0", "-q", "-p", "no:cacheprovider", "-o", "filterwarnings=ignore")
    run(programs / "python", "-m", "pytest", *options, *(ROOT / test for test in CORE),
        folder=tmp_path)  # fmt: skip
