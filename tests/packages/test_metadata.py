"""What archives and catalogues read says the same as pyproject.toml."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
SCRIPT = runpy.run_path(str(ROOT / "scripts" / "update_metadata.py"))
HINT = "run scripts/update_metadata.py"


@pytest.mark.parametrize("name", ["CITATION.cff", "codemeta.json", ".zenodo.json"])
def test_a_file_of_metadata_is_up_to_date(name):
    assert (ROOT / name).read_text(encoding="utf-8") == SCRIPT["files"]()[name], HINT


def test_the_citation_names_the_authors_of_the_package():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert cited["authors"] == SCRIPT["described"]()["authors"]


def test_a_new_version_reaches_every_file():
    project = {**SCRIPT["described"](), "version": "7.3.1", "license": "MIT"}
    text = SCRIPT["citation"](project, "version: 0.1.0\nlicense: BSD-3-Clause\nreferences: []\n")
    assert text == "version: 7.3.1\nlicense: MIT\nreferences: []\n"
    cited = {"title": "Gears", "references": []}
    assert SCRIPT["codemeta"](project, cited)["version"] == "7.3.1"
    assert SCRIPT["zenodo"](project, cited)["license"] == "mit"
