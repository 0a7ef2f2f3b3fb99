"""The plug-ins of this package, and what each offers to the core.

A plug-in is a package in `epicyclic.plugins`, or `epicyclic.validation`, whose light ``__init__``
declares a `PlugIn` by the name ``PLUG_IN``. The core never imports a plug-in: it asks here for what
it needs by the name that a user gives, and the module behind it is imported then.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Mapping
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Literal

Kind = Literal[
    "commands",  # Click commands by their names.
    "case_readers",  # By the ending of a file, `epicyclic.study.load.CaseReader`.
    "map_formats",  # By the name of a format of loss maps, `epicyclic.study.maps.formats.Format`.
    # By its name in ``models.friction``, a function of a case that returns a
    # `epicyclic.losses.friction.FrictionModel`.
    "friction_models",
    # By the key of a table of a case, a function of a case that has it, and of its result or None,
    # that returns items of a page for ``check``, ``run --details`` and reports.
    "details",
    # By `Plan.kind`, classes of plans whose shards ``merge`` puts together, and for each a function
    # of a plan and a path that returns an `epicyclic.cli.many.Write`.
    "plans",
    "plan_writers",
]
PlugIn = Mapping[Kind, Mapping[str, str]]
"""What a plug-in offers: for each name the place, ``"module:object"`` within the plug-in."""


@cache
def plug_ins() -> Mapping[str, PlugIn]:
    """The plug-ins that are there, by the names of their packages."""
    folder = find_spec("epicyclic.plugins")
    found = [] if folder is None else pkgutil.iter_modules(folder.submodule_search_locations)
    packages = [f"epicyclic.plugins.{module.name}" for module in found if module.ispkg]
    if find_spec("epicyclic.validation") is not None:
        packages.append("epicyclic.validation")
    return {package: import_module(package).PLUG_IN for package in packages}


@cache
def offered(kind: Kind) -> Mapping[str, str]:
    """What all plug-ins offer of one kind: names, and where each is."""
    return {
        name: f"{package}.{place}"
        for package, plug_in in plug_ins().items()
        for name, place in plug_in.get(kind, {}).items()
    }


def load(kind: Kind, name: str) -> Any:
    """The object that a plug-in offers under a name; KeyError if none does."""
    module, _, attribute = offered(kind)[name].partition(":")
    return getattr(import_module(module), attribute)
