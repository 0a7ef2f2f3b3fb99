"""Checks of the source itself: layers, types, style, and what an import may cost."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def run(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    "command",
    [
        ("lint-imports",),
        ("mypy",),
        ("ruff", "check", "src", "tests", "benchmarks", "scripts", "docs"),
        ("ruff", "format", "--check", "src", "tests", "benchmarks", "scripts", "docs"),
    ],
    ids=["layers", "types", "style", "format"],
)
def test_tool_is_satisfied(command):
    tool = Path(sys.executable).with_name(command[0])
    result = run(str(tool), *command[1:])
    assert result.returncode == 0, result.stdout + result.stderr


def test_importing_the_package_loads_nothing_heavy():
    code = (
        "import sys, epicyclic; "
        "print([m for m in ('numba', 'numpy', 'pint', 'pydantic', 'xarray', 'pandas', 'scipy', "
        "'matplotlib', 'rich') if m in sys.modules])"
    )
    assert run(sys.executable, "-c", code).stdout.strip() == "[]"


def test_solving_loads_no_table_or_plot_library():
    code = (
        "import sys, epicyclic as ep; ep.solve(ep.load_case('talbot-2012')); "
        "print([m for m in ('xarray', 'pandas', 'matplotlib', 'rich', 'joblib') "
        "if m in sys.modules])"
    )
    assert run(sys.executable, "-c", code).stdout.strip() == "[]"


def test_public_names_are_documented_and_importable():
    import epicyclic as ep

    for name in ep.__all__:
        assert (getattr(ep, name).__doc__ or "").strip(), name
    with pytest.raises(AttributeError, match="no_such_name"):
        ep.no_such_name  # noqa: B018


def test_architecture_names_every_package():
    """Its modules are listed from their docstrings when the page is built."""
    source = ROOT / "src" / "epicyclic"
    packages = {path.parent.name for path in source.glob("*/__init__.py")}
    packages |= {path.stem for path in source.glob("*.py") if not path.name.startswith("__")}
    text = (ROOT / "docs" / "development" / "architecture.md").read_text(encoding="utf-8")
    (listed,) = re.findall(r"```\{modules\}\n(.*?)```", text, re.DOTALL)
    assert sorted(listed.split()) == sorted(packages)


def test_documentation_builds_without_warnings(tmp_path):
    build = Path(sys.executable).with_name("sphinx-build")
    result = run(str(build), "-W", "-n", "-q", "-b", "html", "docs", str(tmp_path / "html"))
    assert result.returncode == 0, result.stdout + result.stderr
