"""Built-in data: oils, materials, surface finishes and published cases, as TOML files.

Every value stands in its file with its source; the functions here only read.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

__all__ = [
    "bearing_tables",
    "builtin_case",
    "case_variants",
    "named",
    "names",
    "oil_model_file",
    "oil_table",
    "strength_table",
    "uncertainty_table",
]


_ROOT = resources.files("epicyclic.library")


def _read(file: Traversable) -> dict[str, Any]:
    return tomllib.loads(file.read_text(encoding="utf-8"))


@cache
def names(folder: Literal["cases", "oils"]) -> tuple[str, ...]:
    """Names of the built-in oils, or of the built-in cases without their variants."""
    files = (entry.name for entry in _ROOT.joinpath(folder).iterdir())
    return tuple(sorted(name.removesuffix(".toml") for name in files if name.endswith(".toml")))


def oil_table(name: str) -> dict[str, Any]:
    """The data of one built-in oil. Raises `KeyError` if there is no such oil."""
    if name not in names("oils"):
        raise KeyError(name)
    return _read(_ROOT.joinpath("oils", f"{name}.toml")) | {"name": name}


@cache
def oil_model_file(name: str) -> Path | None:
    """The file of the models fitted for a built-in oil; None if there is none."""
    file = Path(str(_ROOT.joinpath("oilmodels", f"{name}.json")))
    return file if name in names("oils") and file.is_file() else None


@cache
def named(kind: Literal["materials", "finishes", "lubrication"]) -> Mapping[str, Mapping[str, Any]]:
    """Built-in steels of gears and bearings, surface finishes, or shares of oil, by name.

    The shares are those around gears by how they are lubricated, and how well they are known.
    """
    tables = _read(_ROOT.joinpath(f"{kind}.toml"))
    return MappingProxyType({name: MappingProxyType(table) for name, table in tables.items()})


@cache
def case_variants() -> dict[str, list[dict[str, Any]]]:
    """For each built-in case, its groups of variants: word in the name -> keys it sets."""
    return _read(_ROOT.joinpath("variants.toml"))


def case_source(name: str) -> str:
    """The file of a built-in case, with its comments."""
    return _ROOT.joinpath("cases", f"{name}.toml").read_text(encoding="utf-8")


def minimal_case(kind: str) -> str:
    """A commented file of `kind` with only what a case must state."""
    return _ROOT.joinpath("minimal", f"{kind}.toml").read_text(encoding="utf-8")


def builtin_case(name: str) -> dict[str, Any]:
    """The tables of a built-in case or of one of its variants.

    A variant is named by words after the name of its case, at most one of each group, in any order:
    ``talbot-2012-n6-polished-40C``. Raises `KeyError` if there is no such case or variant.
    """
    bases = (file for file in names("cases") if f"{name}-".startswith(f"{file}-"))
    base = max(bases, key=len, default="")
    if not base:
        raise KeyError(name)
    table = _read(_ROOT.joinpath("cases", f"{base}.toml"))
    words = name[len(base) :].split("-")[1:]
    if words:
        table["title"] = ", ".join([table["title"].split(",")[0], *words])
    for group in case_variants().get(base, []):
        chosen = [word for word in words if word in group["words"]]
        if len(chosen) > 1:
            raise KeyError(name)
        for word in chosen:
            words.remove(word)
            for key, value in group["words"][word].items():
                section, _, field = key.rpartition(".")
                (table[section] if section else table)[field] = value
    if words:
        raise KeyError(name)
    return table


@cache
def uncertainty_table() -> dict[str, Any]:
    """What is assumed of values and models whose uncertainty a case does not state."""
    return _read(_ROOT.joinpath("uncertainty.toml"))


@cache
def strength_table() -> dict[str, Any]:
    """Strength of gear materials, and load stages of oils, by the names of their tables."""
    return _read(_ROOT.joinpath("strength.toml"))


@cache
def bearing_tables(name: Literal["dimensions", "skf-2018"]) -> dict[str, Any]:
    """Of rolling bearings: sizes of the ISO plans, or constants of SKF."""
    return _read(_ROOT.joinpath("bearings", f"{name}.toml"))
