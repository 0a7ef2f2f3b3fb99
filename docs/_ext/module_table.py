"""The directive ``modules``: every module of the package with the first line of its docstring."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

SOURCE = Path(__file__).parents[2] / "src" / "epicyclic"


def modules(package: Path) -> Iterator[tuple[str, str]]:
    """Dotted name and summary of every module of a package, its own first."""
    for path in sorted(package.rglob("*.py"), key=lambda one: (one.stem != "__init__", one)):
        name = ".".join(path.relative_to(SOURCE).with_suffix("").parts).removesuffix(".__init__")
        doc = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
        if doc:
            yield name, " ".join(doc.split("\n\n")[0].split())


class Modules(SphinxDirective):
    """One table for each package named in the content, in that order."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        lines: list[str] = []
        for package in map(str.strip, self.content):
            path = SOURCE / package
            found = modules(path) if path.is_dir() else _single(path.with_suffix(".py"))
            (name, summary), *rest = found
            lines += [f"**{name}**: {summary}", ""]
            if rest:
                lines += ["| Module | What it holds |", "|---|---|"]
                lines += [f"| `{one}` | {text} |" for one, text in rest]
                lines.append("")
        node = nodes.container()
        self.state.nested_parse(StringList(lines, source=__file__), self.content_offset, node)
        return node.children


def _single(path: Path) -> Iterator[tuple[str, str]]:
    doc = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    yield path.stem, " ".join(doc.split("\n\n")[0].split())


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("modules", Modules)
    return {"parallel_read_safe": True}
