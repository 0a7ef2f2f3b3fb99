"""Write the tables of the theory manual that say which function implements which equation.

Run it after a function that cites an equation, "Theory (G4).", was moved or renamed. A table keeps
its equations; its functions are those that cite them.
"""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
CITATION = re.compile(r"Theory (\([A-Z]\d+\)(?:,\s+\([A-Z]\d+\))*)\.")
TAG = re.compile(r"\(([A-Z]\d+)\)")
ROW = re.compile(r"\| \((?P<tag>[A-Z]\d+)\) \| `[\w.]+` \|")


def citations() -> dict[str, list[str]]:
    """Dotted names of the classes and functions that cite each equation."""
    found: dict[str, list[str]] = defaultdict(list)
    source = ROOT / "src"
    for path in sorted((source / "epicyclic").rglob("*.py")):
        module = ".".join(path.relative_to(source).with_suffix("").parts)
        for name, text in docstrings(ast.parse(path.read_text(encoding="utf-8")), module):
            for group in CITATION.findall(text):
                for tag in TAG.findall(group):
                    found[tag].append(name)
    return found


def docstrings(node: ast.AST, name: str) -> Iterator[tuple[str, str]]:
    """Dotted name and docstring of every class and function below `node`."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.ClassDef | ast.FunctionDef):
            yield f"{name}.{child.name}", ast.get_docstring(child) or ""
            yield from docstrings(child, f"{name}.{child.name}")


def updated(text: str, citing: dict[str, list[str]]) -> str:
    """A page with its tables made anew."""
    lines: list[str] = []
    written: set[str] = set()
    for line in text.splitlines():
        row = ROW.fullmatch(line)
        if row is None:
            lines.append(line)
            written = set()
        elif row["tag"] not in written:
            written.add(row["tag"])
            names = dict.fromkeys(citing.get(row["tag"], []))
            lines += [f"| ({row['tag']}) | `{name}` |" for name in names]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Update every page of the manual."""
    citing = citations()
    for page in sorted((ROOT / "docs" / "theory").glob("*.md")):
        text = page.read_text(encoding="utf-8")
        new = updated(text, citing)
        if new != text:
            page.write_text(new, encoding="utf-8")
            print(f"{page.relative_to(ROOT)} updated")


if __name__ == "__main__":
    main()
