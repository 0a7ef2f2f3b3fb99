"""The numbers of the theory manual and their citations in the code belong together, one to one.

A tag is ``\\tag{G4}`` in docs/theory; a citation is "Theory (G4)." in a docstring. Tags with a
small letter, ``\\tag{B10a}``, mark steps of a derivation and are not cited.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
SOURCE = ROOT / "src" / "epicyclic"

TAG = re.compile(r"\\tag\{([^}]*)\}")
TAG_FORM = re.compile(r"[A-Z]\d+[a-z]?")
CITATION = re.compile(r"Theory (\([A-Z]\d+\)(?:,\s+\([A-Z]\d+\))*)\.")
CITED = re.compile(r"\(([A-Z]\d+)\)")
ROW = re.compile(r"^\| \((?P<tag>[^)]*)\) \| `(?P<name>[\w.]+)` \|$", re.MULTILINE)


def manual() -> dict[str, str]:
    """Text of every page of the manual by the name of its file."""
    pages = {page.name: page.read_text(encoding="utf-8") for page in DOCS.glob("theory/*.md")}
    assert pages
    return pages


def tags_of(text: str) -> list[str]:
    return TAG.findall(text)


def citations_of(text: str) -> list[str]:
    return [tag for group in CITATION.findall(text) for tag in CITED.findall(group)]


def is_step(tag: str) -> bool:
    return tag[-1].isalpha()


def all_tags() -> list[str]:
    return [tag for text in manual().values() for tag in tags_of(text)]


def docstrings() -> Iterator[tuple[str, str]]:
    """Dotted name and docstring of every class and function of the package."""
    for path in sorted(SOURCE.rglob("*.py")):
        module = ".".join(path.relative_to(ROOT / "src").with_suffix("").parts)
        yield from _docstrings(ast.parse(path.read_text(encoding="utf-8")), module)


def _docstrings(node: ast.AST, name: str) -> Iterator[tuple[str, str]]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.ClassDef | ast.FunctionDef):
            yield f"{name}.{child.name}", ast.get_docstring(child) or ""
            yield from _docstrings(child, f"{name}.{child.name}")


@cache
def citing() -> set[tuple[str, str]]:
    """Pairs of tag and dotted name of the class or function that cites it."""
    return {(tag, name) for name, text in docstrings() for tag in citations_of(text)}


def listed() -> set[tuple[str, str]]:
    """The same pairs as the tables of the manual have them."""
    return {
        (match["tag"], match["name"]) for text in manual().values() for match in ROW.finditer(text)
    }


def unmatched_mentions(text: str) -> list[str]:
    """What follows the word Theory in `text` and is not a citation in the agreed form."""
    found = [match.start() for match in re.finditer(r"Theory \(", text)]
    good = {match.start() for match in CITATION.finditer(text)}
    return [text[start : start + 30] for start in found if start not in good]


def test_no_tag_twice() -> None:
    assert [tag for tag, count in Counter(all_tags()).items() if count > 1] == []


def test_tags_have_the_agreed_form_and_one_letter_a_page() -> None:
    letters: dict[str, str] = {}
    for name, text in manual().items():
        for tag in tags_of(text):
            assert TAG_FORM.fullmatch(tag), tag
            assert letters.setdefault(tag[0], name) == name, tag
    assert len(letters) == len(set(letters.values())) > 0


@pytest.mark.slow
def test_every_citation_is_in_the_manual() -> None:
    assert {tag for tag, _ in citing()} - set(all_tags()) == set()


def test_every_equation_is_cited() -> None:
    numbered = {tag for tag in all_tags() if not is_step(tag)}
    assert numbered
    assert numbered - {tag for tag, _ in citing()} == set()


def test_tables_of_the_manual_name_exactly_the_functions_that_cite() -> None:
    assert listed() - citing() == set(), "listed in the manual, but not cited there"
    assert citing() - listed() == set(), "cited, but not listed in the manual"


def test_citations_have_the_agreed_form() -> None:
    wrong = {
        path.name: mentions
        for path in SOURCE.rglob("*.py")
        if (mentions := unmatched_mentions(path.read_text(encoding="utf-8")))
    }
    assert wrong == {}


def test_equations_mentioned_in_the_documentation_exist() -> None:
    tags = set(all_tags())
    letters = "".join({tag[0] for tag in tags})
    mention = re.compile(rf"\(([{letters}]\d+[a-z]?)\)")
    missing = {
        page.name: unknown
        for page in DOCS.rglob("*.md")
        if "_build" not in page.parts
        and (unknown := set(mention.findall(page.read_text(encoding="utf-8"))) - tags)
    }
    assert missing == {}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Base pitch. Theory (G4). [m]", ["G4"]),
        ("Theory (B1), (B2).", ["B1", "B2"]),
        ("Theory (B1),\n    (B2).", ["B1", "B2"]),
        ("Theory (G4)", []),
        ("Theory (4).", []),
    ],
)
def test_citations_are_found(text: str, expected: list[str]) -> None:
    assert citations_of(text) == expected
    assert bool(unmatched_mentions(text)) == (not expected)
