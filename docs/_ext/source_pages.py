"""Links from equations to the code: functions that a table of the theory manual names.

A cell that holds a dotted name, as scripts/update_theory_tables.py writes it, becomes a link to the
line of its module where that function or class begins. A name that is not there ends the build.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

from docutils import nodes
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import PythonLexer
from sphinx.application import Sphinx
from sphinx.util import logging

SOURCE = Path(__file__).parents[2] / "src"
FOLDER = "source"
NAME = re.compile(r"epicyclic(\.\w+)+")
CELL = re.compile(r"(?<=\| `)epicyclic(\.\w+)+(?=` \|)")

logger = logging.getLogger(__name__)


@lru_cache
def module_of(name: str) -> Path | None:
    """The file in which a dotted name is defined; None if there is none."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        path = SOURCE.joinpath(*parts[:count]).with_suffix(".py")
        if path.is_file():
            return path
    return None


@lru_cache
def lines_of(path: Path) -> dict[str, int]:
    """Line in which each class and function of a module begins, by its dotted name."""
    module = ".".join(path.relative_to(SOURCE).with_suffix("").parts)
    return dict(_definitions(ast.parse(path.read_text(encoding="utf-8")), module))


def _definitions(node: ast.AST, name: str) -> Iterator[tuple[str, int]]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.ClassDef | ast.FunctionDef):
            yield f"{name}.{child.name}", child.lineno
            yield from _definitions(child, f"{name}.{child.name}")


def page_of(path: Path) -> str:
    return f"{FOLDER}/{'.'.join(path.relative_to(SOURCE).with_suffix('').parts)}"


def link_names(app: Sphinx, doctree: nodes.document, docname: str) -> None:
    """Make links of the names in tables of the theory manual."""
    if not docname.startswith("theory/") or app.builder.format != "html":
        return
    for cell in list(doctree.findall(nodes.entry)):
        for literal in list(cell.findall(nodes.literal)):
            name = literal.astext()
            if NAME.fullmatch(name):
                link = _link(app, docname, name)
                literal.replace_self(nodes.reference("", "", literal.deepcopy(), **link))


def _link(app: Sphinx, docname: str, name: str) -> dict[str, Any]:
    path = module_of(name)
    line = lines_of(path).get(name) if path else None
    if path is None or line is None:
        logger.warning("%s: there is no function %s", docname, name)
        return {}
    place = app.builder.get_relative_uri(docname, page_of(path))
    return {"internal": True, "refuri": f"{place}#line-{line}"}


def pages(app: Sphinx) -> Iterator[tuple[str, dict[str, Any], str]]:
    """A page for each module that the manual names."""
    texts = [page.read_text(encoding="utf-8") for page in Path(app.srcdir).glob("theory/*.md")]
    named = {match[0] for text in texts for match in CELL.finditer(text)}
    formatter = HtmlFormatter(linenos="inline", lineanchors="line")
    for path in sorted({path for name in named if (path := module_of(name))}):
        code = highlight(path.read_text(encoding="utf-8"), PythonLexer(), formatter)
        title = page_of(path).removeprefix(f"{FOLDER}/")
        yield page_of(path), {"title": title, "body": f"<h1>{title}</h1>\n{code}"}, "page.html"


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("doctree-resolved", link_names)
    app.connect("html-collect-pages", pages)
    return {"parallel_read_safe": True}
