"""Write what archives and catalogues read: CITATION.cff, codemeta.json and .zenodo.json.

All that they say is in pyproject.toml, but for the works to cite, which are in CITATION.cff. Run it
after a change of either.
"""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).parents[1]


def described() -> dict[str, Any]:
    """The table ``[project]`` of pyproject.toml."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    project: dict[str, Any] = tomllib.loads(text)["project"]
    return project


def citation(project: dict[str, Any], text: str) -> str:
    """CITATION.cff with version and licence of the project."""
    for key in ("version", "license"):
        text = re.sub(rf"^{key}: .*$", f"{key}: {project[key]}", text, flags=re.MULTILINE)
    return text


def reference(work: dict[str, Any]) -> str:
    """A work to cite, in a line."""
    authors = ", ".join(f"{one['family-names']}, {one['given-names']}" for one in work["authors"])
    return f"{authors} ({work['year']}). {work['title']}. {work['institution']['name']}."


def codemeta(project: dict[str, Any], cited: dict[str, Any]) -> dict[str, Any]:
    """Terms of CodeMeta 3.0."""
    return {
        "@context": "https://w3id.org/codemeta/3.0",
        "@type": "SoftwareSourceCode",
        "name": cited["title"],
        "identifier": project["name"],
        "description": project["description"],
        "version": project["version"],
        "license": f"https://spdx.org/licenses/{project['license']}",
        "author": [
            {"@type": "Organization", "name": author["name"]} for author in project["authors"]
        ],
        "keywords": project["keywords"],
        "programmingLanguage": "Python",
        "runtimePlatform": f"Python {project['requires-python']}",
        "softwareRequirements": project["dependencies"],
        "referencePublication": [
            {
                "@type": "Thesis",
                "name": work["title"],
                "author": [
                    {
                        "@type": "Person",
                        "familyName": author["family-names"],
                        "givenName": author["given-names"],
                    }
                    for author in work["authors"]
                ],
                "datePublished": str(work["year"]),
            }
            for work in cited["references"]
        ],
    }


def zenodo(project: dict[str, Any], cited: dict[str, Any]) -> dict[str, Any]:
    """Terms of a deposit at Zenodo."""
    return {
        "upload_type": "software",
        "title": cited["title"],
        "description": project["description"],
        "version": project["version"],
        "license": project["license"].lower(),
        "creators": [{"name": author["name"]} for author in project["authors"]],
        "keywords": project["keywords"],
        "access_right": "open",
        "references": [reference(work) for work in cited["references"]],
    }


def files() -> dict[str, str]:
    """Every file and what it should hold."""
    project = described()
    text = citation(project, (ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    cited = yaml.safe_load(text)
    tables = {"codemeta.json": codemeta(project, cited), ".zenodo.json": zenodo(project, cited)}
    return {
        "CITATION.cff": text,
        **{
            name: json.dumps(table, indent=2, ensure_ascii=False) + "\n"
            for name, table in tables.items()
        },
    }


def main() -> None:
    """Write the files that are not as they should be."""
    for name, text in files().items():
        path = ROOT / name
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
            print(f"{name} updated")


if __name__ == "__main__":
    main()
