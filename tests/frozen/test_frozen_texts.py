"""What is said of broken cases, commands and files, and of some sound ones, is as frozen.

make_frozen.py, beside this file, says what was frozen and how; improved_texts.toml names the parts
of texts that were improved since.
"""

from __future__ import annotations

import pytest

from frozen.entries import Maker, outcome_of
from frozen.texts import IMPROVED, OTHERWISE, frozen_texts, improved, kept

FROZEN = frozen_texts()
ENTRIES = [
    pytest.param(name, marks=() if entry["quick"] else pytest.mark.slow)
    for name, entry in FROZEN["entries"].items()
    if name not in OTHERWISE
]


@pytest.fixture(scope="session")
def maker(tmp_path_factory):
    """Makes the files that entries need."""
    return Maker(tmp_path_factory.mktemp("made"))


@pytest.mark.parametrize("name", ENTRIES)
def test_texts_are_the_frozen_ones(name, tmp_path, maker):
    entry = FROZEN["entries"][name]
    if entry["call"] == "command" and entry["with"][:1] == ["run"] and "output" in entry["outcome"]:
        entry = entry | {"with": [*entry["with"], "--details"]}  # with which it prints that now
    found = outcome_of(entry, FROZEN["bases"], tmp_path, maker)
    assert kept(found) == improved(entry["outcome"]), f"see the head of {IMPROVED}"
