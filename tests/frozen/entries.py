"""What is tried for a text: inputs as plain data, and what the package says of them.

An entry is a dictionary:

``call``
    What is called, of `CALLS`.
``case``
    A built-in case, a file, a table of the bases, or tables.
``patch``
    What is changed in the tables before they are read, as JSON merge patch; None deletes a key.
``changes``
    What is changed in the case that was read, by dotted keys.
``with``
    Further arguments of the call; of a command its arguments, as one list.
``files``
    Files in the folder, by name.
``made``
    Names of `MADE`: files made by commands.
``damage``
    Changes of a file, by its name: lists of what is done, to what, and how.
"""

from __future__ import annotations

import copy
import os
import shutil
from collections.abc import Callable, Mapping
from contextlib import chdir
from pathlib import Path
from typing import Any

import numpy as np

import epicyclic as ep
from frozen.command import run_command

__all__ = ["CALLS", "MADE", "Maker", "outcome_of"]

Entry = Mapping[str, Any]
Tables = dict[str, Any]

QUICK = (
    "--set", "numerics.mesh_positions=5", "--set", "numerics.contact_segments=5",
    "--set", "losses.mesh_pocketing.include=false", "--jobs", "1",
)  # fmt: skip
MAP = ("--torque", "-50,0,100 N*m", *QUICK)
MADE: dict[str, list[str]] = {
    "map.nc": [
        "map", "talbot-2012-pair", "--speed", "0,1000,3000 rpm", "--temperature", "40,90 degC",
        *MAP, "-o", "map.nc"],
    "cool.nc": ["map", "talbot-2012-pair", "--speed", "500,3000 rpm", *MAP, "-o", "cool.nc"],
    "rest.nc": ["map", "talbot-2012-pair", "--speed", "0 rpm", *MAP, "-o", "rest.nc"],
    "backwards.nc": [
        "map", "talbot-2012-pair", "--speed", "-1000,0,1000 rpm", *MAP, "-o", "backwards.nc"],
    "varied.nc": [
        "map", "talbot-2012-pair", "--speed", "0,1000 rpm", "--vary", "pinion.roughness=0.2,0.4 um",
        *MAP, "-o", "varied.nc"],
    "states.nc": [
        "map", "train-8hp70", "--speed", "0,1000 rpm", "--torque", "0,100 N*m", "--states", "1,2",
        "--jobs", "1", "-o", "states.nc"],
    "network.nc": [
        "map", "talbot-2012-pair", "--speed", "0,1000 rpm", "--temperature", "40,90 degC",
        "--set", "models.temperatures=network", "--set", "thermal.oil_flow=2 l/min",
        *MAP, "-o", "network.nc"],
    "set.nc": ["run", "talbot-2012", "--save", "set.nc", "--json", "set.json"],
    "pair.nc": ["run", "talbot-2012-pair", "--save", "pair.nc", "--json", "pair.json"],
    "sweep.nc": [
        "sweep", "talbot-2012-pair", "--vary", "operation.speed=1000,2000 rpm", *QUICK,
        "-o", "sweep.nc"],
    "a.nc.shard-1-of-2": [
        "sweep", "talbot-2012-pair", "--vary", "operation.speed=1000,2000 rpm", *QUICK,
        "--shard", "1/2", "-o", "a.nc"],
    "a.nc.shard-2-of-2": [
        "sweep", "talbot-2012-pair", "--vary", "operation.speed=1000,2000 rpm", *QUICK,
        "--shard", "2/2", "-o", "a.nc"],
    "b.nc.shard-1-of-2": [
        "sweep", "talbot-2012-pair", "--vary", "operation.speed=1000,2500 rpm", *QUICK,
        "--shard", "1/2", "-o", "b.nc"],
    "driven.nc": [
        "map", "talbot-2012", "--speed", "0,1000 rpm", "--torque", "-50,0,100 N*m",
        "--set", "operation.fixed=", "--set", "operation.second_input=ring",
        "--set", "operation.second_speed=30 rpm",
        "--set", "numerics.mesh_positions=5", "--set", "numerics.contact_segments=5",
        "--set", "losses.sun_mesh_pocketing.include=false",
        "--set", "losses.ring_mesh_pocketing.include=false", "--jobs", "1", "-o", "driven.nc"],
    "band.nc": ["uncertainty", "talbot-2012-pair", "--samples", "16", *QUICK, "-o", "band.nc"],
    "pockets.nc": [
        "pockets-table", "talbot-2012-pair", "--speed", "9000,10000 rpm",
        "--set", "numerics.pocket_slices=6", "--set", "numerics.pocket_steps=10", "--jobs", "1",
        "-o", "pockets.nc"],
}  # fmt: skip
"""Files and the commands that make them."""


class Maker:
    """Makes each file of `MADE` once, in a folder of its own."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def give(self, name: str, folder: Path) -> None:
        """Put a copy of a file into a folder."""
        own = self._folder / name
        if not own.exists():
            done = run_command(MADE[name], self._folder)
            assert done.code == 0, done.errors
        shutil.copy(own, folder / name)


def outcome_of(entry: Entry, bases: Mapping[str, Tables], folder: Path, maker: Maker) -> Tables:
    """What the package says of an entry, tried in an empty folder."""
    for name, content in entry.get("files", {}).items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, str):
            file.write_bytes(content.encode())
        else:
            file.write_bytes(bytes(content))
    for name in entry.get("made", ()):
        maker.give(name, folder)
    for name, edits in entry.get("damage", {}).items():
        damage(folder / name, edits)
    if entry["call"] == "command":
        return _of_command(entry["with"], folder)
    with chdir(folder):
        return _of_call(entry, bases)


def _of_command(arguments: list[str], folder: Path) -> Tables:
    done = run_command(arguments, folder)
    said = {"output": done.output, "errors": done.errors}
    return {"code": done.code} | {key: _plain(text, folder) for key, text in said.items() if text}


def _of_call(entry: Entry, bases: Mapping[str, Tables]) -> Tables:
    try:
        given = CALLS[entry["call"]](_source(entry, bases), entry)
    except ep.InputError as error:
        problems = [[it.key, it.value, it.allowed, it.remedy] for it in error.problems]
        return {"source": error.source, "problems": _everywhere(problems)}
    except ep.EpicyclicError as error:
        return {"error": str(error)}
    except (TypeError, ValueError) as error:  # of a wrong argument
        return {"wrong": f"{type(error).__name__}: {error}"}
    return {"said": given}


def _plain(text: str, folder: Path) -> str:
    """A text without what differs between machines."""
    return text.replace(str(folder), "FOLDER").replace(os.path.realpath(folder), "FOLDER")


def _everywhere(content: Any) -> Any:
    if isinstance(content, list):
        return [_everywhere(item) for item in content]
    return _plain(content, Path.cwd())


# --- cases ----------------------------------------------------------------------------------------


def _source(entry: Entry, bases: Mapping[str, Tables]) -> str | Tables:
    source = entry.get("case", "")
    tables = bases.get(source) if isinstance(source, str) else source
    if tables is None:
        assert "patch" not in entry, "of tables only"
        return source
    return merged(tables, entry["patch"]) if "patch" in entry else copy.deepcopy(tables)


def merged(tables: Any, patch: Any) -> Any:
    """Tables changed by a merge patch (RFC 7396)."""
    if not isinstance(patch, dict):
        return copy.deepcopy(patch)
    found = copy.deepcopy(tables) if isinstance(tables, dict) else {}
    for key, item in patch.items():
        if item is None:
            found.pop(key, None)
        else:
            found[key] = merged(found.get(key), item)
    return found


def _case(source: str | Tables, entry: Entry) -> Any:
    case = ep.load_case(source)
    return case.updated(entry["changes"]) if "changes" in entry else case


# --- calls ----------------------------------------------------------------------------------------


def _load(source: str | Tables, entry: Entry) -> Any:
    case = ep.load_case(source, entry["changes"]) if "changes" in entry else ep.load_case(source)
    return case.kind


def _update(source: str | Tables, entry: Entry) -> Any:
    return _case(source, entry).kind


def _solve(source: str | Tables, entry: Entry) -> Any:
    result = ep.solve(_case(source, entry))
    return {"status": str(result.status), "warnings": list(result.warnings)}


def _solve_for(source: str | Tables, entry: Entry) -> Any:
    ep.solve_for(_case(source, entry), *entry["with"])
    return None


def _table(source: str | Tables, entry: Entry) -> Any:
    ep.solve(_case(source, entry)).table(**entry["with"])


def _save(source: str | Tables, entry: Entry) -> Any:
    ep.solve(_case(source, entry)).save(**entry["with"])


def _plot(source: str | Tables, entry: Entry) -> Any:
    ep.solve(_case(source, entry)).plot(**entry["with"])


def _read_rexs(source: str | Tables, entry: Entry) -> Any:
    return list(ep.read_rexs(source, **entry.get("with", {})).notes)


def _write_rexs(source: str | Tables, entry: Entry) -> Any:
    ep.write_rexs(result=ep.solve(_case(source, entry)), **entry["with"])


def _open_result(source: str | Tables, entry: Entry) -> Any:
    ep.open_result(source)


def _save_result(source: str | Tables, entry: Entry) -> Any:
    ep.save_result(_case(source, entry), **entry["with"])


def _compare_cases(source: str | Tables, entry: Entry) -> Any:
    ep.compare_cases(_case(source, entry), ep.load_case(entry["with"][0]), samples=64)


def _characterise_oil(source: str | Tables, entry: Entry) -> Any:
    ep.characterise_oil(source, **entry["with"])


def _with_case(name: str) -> Callable[[str | Tables, Entry], Any]:
    def call(source: str | Tables, entry: Entry) -> Any:
        getattr(ep, name)(_case(source, entry), **entry.get("with", {}))

    return call


CALLS: dict[str, Callable[[str | Tables, Entry], Any]] = {
    "load": _load,
    "update": _update,
    "solve": _solve,
    "solve_for": _solve_for,
    "table": _table,
    "save": _save,
    "plot": _plot,
    "read_rexs": _read_rexs,
    "write_rexs": _write_rexs,
    "open_result": _open_result,
    "save_result": _save_result,
    "compare_cases": _compare_cases,
    "characterise_oil": _characterise_oil,
    **{
        name: _with_case(name)
        for name in (
            "sweep", "loss_map", "duty_cycle", "warm_up", "compare_measured", "pocketing_study",
            "pocketing_table", "mesh_details", "pocket_details", "heat_balance", "uncertainty",
            "loaded_meshes", "mesh_contacts", "record", "report_html",
        )
    },
}  # fmt: skip
"""Public functions, and `command`."""


# --- damaged files --------------------------------------------------------------------------------


def damage(file: Path, edits: list[list[Any]]) -> None:
    """Change a NetCDF file: places in it read "group/name". Of a journal lose the last line."""
    import netCDF4

    if edits == ["last line"]:
        file.write_bytes(b"".join(file.read_bytes().splitlines(keepends=True)[:-1]))
        return
    with netCDF4.Dataset(file, "a") as data:
        data.set_auto_mask(False)
        for what, place, *how in edits:
            group, _, name = place.rpartition("/")
            owner = data[group] if group else data
            match what:
                case "attribute":
                    owner.setncattr(name, how[0])
                case "no attribute":
                    owner.delncattr(name)
                case "rename":
                    owner.renameVariable(name, how[0])
                case "words":
                    array = owner[name]
                    kept = array.dimensions, array.__dict__
                    owner.renameVariable(name, f"{name}_before")
                    words = owner.createVariable(name, str, kept[0])
                    words.setncatts({k: it for k, it in kept[1].items() if k != "_FillValue"})
                case "fill":
                    owner[name][...] = np.nan if how[0] is None else how[0]
                case "first":
                    owner[name][(0,) * owner[name].ndim] = np.nan if how[0] is None else how[0]
                case "reverse":
                    owner[name][:] = owner[name][::-1]
                case _:
                    raise ValueError(what)
