"""Checks of the source itself: layers, types, style, and what an import may cost."""

from __future__ import annotations

import ast
import inspect
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from limits import is_soon

ROOT = Path(__file__).parents[2]
LONGEST_BUILD = 230
"""Of the documentation with its gallery executed, processor time; of ten examples it was 180, and
three more, on designs, high speeds and formulas, take 35. [s]"""


def run(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    "command",
    [
        ("lint-imports",),
        pytest.param(("mypy",), marks=pytest.mark.slow),
        ("ruff", "check", "src", "tests", "benchmarks", "scripts", "docs", "examples"),
        ("ruff", "format", "--check", "src", "tests", "benchmarks", "scripts", "docs", "examples"),
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


def test_solving_and_the_command_of_every_day_load_no_optimiser_table_or_plot_library():
    """They take over a second; the flanks that `run` warms settle without an optimiser.

    numba asks for scipy.linalg as it loads, which takes a tenth of a `run` that calls none of it.
    """
    code = (
        "import sys, epicyclic as ep; ep.solve(ep.load_case('talbot-2012'))\n"
        "heavy = {'scipy.linalg', 'scipy.optimize', 'matplotlib', 'pandas', 'xarray'}\n"
        "print(sorted((heavy | {'rich', 'loky'}) & sys.modules.keys()))\n"
        "sys.argv = ['epicyclic', 'run', 'talbot-2012']\n"
        "import epicyclic.__main__ as command, contextlib, io\n"
        "with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):\n"
        "    command.main()\n"
        "print(sorted(heavy & sys.modules.keys()))"
    )
    assert run(sys.executable, "-c", code).stdout.split() == ["[]", "[]"]


def test_public_names_are_documented_and_importable():
    import epicyclic as ep

    for name in ep.__all__:
        assert (getattr(ep, name).__doc__ or "").strip(), name
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = ep.no_such_name


def test_rules_name_every_package():
    """Its modules are listed from their docstrings when the page is built."""
    source = ROOT / "src" / "epicyclic"
    packages = {path.parent.name for path in source.glob("*/__init__.py")}
    packages |= {path.stem for path in source.glob("*.py") if not path.name.startswith("__")}
    text = (ROOT / "docs" / "development" / "rules.md").read_text(encoding="utf-8")
    (listed,) = re.findall(r"```\{modules\}\n(.*?)```", text, re.DOTALL)
    assert sorted(listed.split()) == sorted(packages)


@pytest.mark.slow
@pytest.mark.parametrize(
    "gallery",
    [
        pytest.param("plot_gallery=0", id="without its gallery"),
        pytest.param("sphinx_gallery_conf.run_stale_examples=1", id="gallery"),
    ],
)
def test_documentation_builds_without_warnings(tmp_path, gallery):
    build = Path(sys.executable).with_name("sphinx-build")
    before = processor_seconds()
    result = run(
        str(build), "-W", "-n", "-q", "-b", "html", "-D", gallery, "docs", str(tmp_path / "html")
    )
    assert result.returncode == 0, result.stdout + result.stderr
    assert is_soon(processor_seconds() - before, LONGEST_BUILD)
    assert list(fetched_by_pages(tmp_path / "html")) == []
    links = dict(links_to_code(tmp_path / "html" / "theory"))
    assert any("gears.gear.html" in link for link in links)
    assert [link for link, leads in links.items() if not leads] == []


def links_to_code(folder):
    """Links of the theory manual to the lines of functions, and whether they lead there."""
    for page in folder.glob("*.html"):
        links = re.findall(r'href="(\.\./source/[^"]+)"', page.read_text(encoding="utf-8"))
        for link in links:
            path, _, line = link.partition("#")
            yield link, f'id="{line}"' in (folder / path).read_text(encoding="utf-8")


def processor_seconds():
    """Of processes that this one has started and that have ended."""
    used = os.times()
    return used.children_user + used.children_system


def fetched_by_pages(folder):
    """What a browser would get from a network to show the pages: scripts, styles, pictures."""
    tag = re.compile(r"<(?:script|link|img|iframe|source)\b[^>]*")
    address = re.compile(r"""(?:src|href)=["']((?:https?:)?//[^"']+)""")
    style = re.compile(r"""(?:url\(|@import)\s*["']?((?:https?:)?//[^"')]+)""")
    for path in folder.rglob("*.html"):
        for found in tag.findall(path.read_text(encoding="utf-8")):
            if 'rel="canonical"' not in found:
                yield from address.findall(found)
    for path in folder.rglob("*.css"):
        yield from style.findall(path.read_text(encoding="utf-8"))


def test_pages_that_fetch_from_a_network_are_found(tmp_path):
    (tmp_path / "page.html").write_text(
        '<a href="https://example.org/read">x</a><img src="local.png">'
        '<script async src="https://example.org/a.js"></script><link href="//example.org/b.css">',
        encoding="utf-8",
    )
    (tmp_path / "style.css").write_text(
        'a{background:url(dot.png)}@font-face{src:url("http://example.org/c.woff")}',
        encoding="utf-8",
    )
    assert sorted(fetched_by_pages(tmp_path)) == [
        "//example.org/b.css", "http://example.org/c.woff", "https://example.org/a.js",
    ]  # fmt: skip


def test_examples_of_the_gallery_use_every_public_function():
    import epicyclic as ep

    used = set()
    for path in (ROOT / "examples").glob("plot_*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                used |= {node.attr} if node.value.id == "ep" else set()
    functions = {name for name in ep.__all__ if inspect.isfunction(getattr(ep, name))}
    assert functions - used == set()


@pytest.mark.slow
def test_examples_of_docstrings_run():
    options = ("-q", "-n", "0", "-p", "no:cacheprovider", "--doctest-modules")
    done = run(sys.executable, "-m", "pytest", *options, "src/epicyclic")
    assert done.returncode == 0, done.stdout[-3000:]
