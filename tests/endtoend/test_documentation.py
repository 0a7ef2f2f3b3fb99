"""The blocks of the documentation, run page by page in an empty folder as a reader would.

Of every page these blocks are run, in their order:

- ``console``: each line that begins with ``$ ``, with its continuations;
- ``python``: as one program with the blocks before;
- ``{code-block}`` with a ``:caption:``: the file of that name.

A comment on the line above a block changes that: ``% test: slow`` leaves it to ``pytest -m slow``,
``% test: skip (WHY)`` leaves it out, ``% test: ends with 5`` expects that exit code.
"""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

import click
import pytest

from epicyclic.cli.main import cli, main

DOCS = Path(__file__).parents[2] / "docs"
BLOCK = re.compile(
    r"(?:^% test: (?P<note>[^\n]+)\n)?"
    r"^```(?P<kind>console|python|\{code-block\}[^\n]*)\n"
    r"(?:^:caption: (?P<file>[^\n]+)\n\n?)?"
    r"(?P<text>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
NOTE = re.compile(r"slow|skip \(.+\)|ends with (?P<code>\d+)")


@dataclass(frozen=True)
class Block:
    """A block of a page: its kind, text, file name, and the note above it."""

    kind: str
    text: str
    file: str
    note: str

    @property
    def commands(self):
        """The command lines of a console."""
        lines = self.text.replace("\\\n", " ").splitlines()
        return [shlex.split(line[2:]) for line in lines if line.startswith("$ ")]

    @property
    def exit_code(self):
        return int(NOTE.fullmatch(self.note)["code"] or 0) if self.note else 0


def blocks_of(page):
    found = BLOCK.finditer((DOCS / page).read_text(encoding="utf-8"))
    blocks = [
        Block(match["kind"], match["text"], match["file"] or "", match["note"] or "")
        for match in found
    ]
    return [block for block in blocks if block.kind in ("console", "python") or block.file]


PAGES = sorted(str(path.relative_to(DOCS)) for path in DOCS.rglob("*.md"))
RUN = [page for page in PAGES if any(not block.file for block in blocks_of(page))]
LONG = (
    "index.md",
    "tutorial/index.md",
    "how-to/compare-friction.md",
    "how-to/compare-measured.md",
    "how-to/design.md",
    "how-to/reproduce.md",
    "how-to/uncertainty.md",
    "how-to/loss-map.md",
    "how-to/look-at-a-mesh.md",
    "how-to/duty-cycle.md",
    "how-to/pockets.md",
    "how-to/sweep.md",
)
"""Pages that take longer than the default suite allows, even without their slow blocks."""
SLOW = [
    page for page in RUN if page in LONG or any(block.note == "slow" for block in blocks_of(page))
]


def run_block(block, names, monkeypatch):
    if block.file:
        Path(block.file).write_text(block.text, encoding="utf-8")
    elif block.kind == "python":
        exec(compile(block.text, "the page", "exec"), names)
    else:
        for command in block.commands:
            assert command[0] == "epicyclic", f"not run by this test: {command}"
            monkeypatch.setattr("sys.argv", command)
            code = 0
            try:
                main()
            except SystemExit as ended:
                code = ended.code
            assert code == block.exit_code, shlex.join(command)


def run_page(page, folder, monkeypatch, left_out):
    monkeypatch.chdir(folder)
    names = {"__name__": "the page"}
    for block in blocks_of(page):
        if block.note.partition(" ")[0] not in left_out:
            run_block(block, names, monkeypatch)


@pytest.mark.parametrize("page", [page for page in RUN if page not in LONG])
def test_blocks_of_a_page_run(page, tmp_path, monkeypatch):
    run_page(page, tmp_path, monkeypatch, ("slow", "skip"))


@pytest.mark.parametrize("page", RUN)
def test_commands_of_a_page_are_understood(page, monkeypatch):
    """Also those that are slow: each has the options that the page gives it."""
    monkeypatch.setattr(click.Command, "invoke", lambda command, context: None)
    for block in blocks_of(page):
        if block.kind == "console" and not (block.exit_code or block.note.startswith("skip")):
            for _, *arguments in block.commands:
                cli.main(arguments, standalone_mode=False)


@pytest.mark.parametrize(
    "page",
    [
        # this one compares all figures, as tests/validation does
        pytest.param(
            page, marks=getattr(pytest.mark, "campaign" if page == "validation.md" else "slow")
        )
        for page in SLOW
    ],
)
def test_all_blocks_of_a_page_run(page, tmp_path, monkeypatch):
    run_page(page, tmp_path, monkeypatch, ("skip",))


@pytest.mark.parametrize("page", PAGES)
def test_notes_above_blocks_are_understood(page):
    text = (DOCS / page).read_text(encoding="utf-8")
    notes = re.findall(r"^% test: (.*)$", text, re.MULTILINE)
    assert all(NOTE.fullmatch(note) for note in notes)
    assert notes == [match["note"] for match in BLOCK.finditer(text) if match["note"]]


def test_blocks_are_recognised(tmp_path, monkeypatch):
    page = tmp_path / "page.md"
    page.write_text(
        "```{code-block} toml\n:caption: a.toml\n\nx = 1\n```\n"
        "% test: ends with 2\n```console\n$ epicyclic check \\\n    a.toml\n1 problem:\n```\n"
        "```python\nimport pathlib\n"
        "assert pathlib.Path('a.toml').read_text() == 'x = 1\\n'\n```\n"
        "% test: skip (it fails)\n```python\nraise ValueError('of the block')\n```\n"
        "```text\nnothing\n```\n",
        encoding="utf-8",
    )
    monkeypatch.setitem(globals(), "DOCS", tmp_path)
    blocks = blocks_of("page.md")
    assert [block.file or block.kind for block in blocks] == [
        "a.toml", "console", "python", "python",
    ]  # fmt: skip
    assert blocks[1].commands == [["epicyclic", "check", "a.toml"]]
    run_page("page.md", tmp_path, monkeypatch, ("skip",))
    with pytest.raises(ValueError, match="of the block"):
        run_page("page.md", tmp_path, monkeypatch, left_out=())
