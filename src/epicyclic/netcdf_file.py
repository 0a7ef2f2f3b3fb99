"""NetCDF files that users give: the only door through which the package reads them.

A file is opened only if it is a regular file of HDF5 and not too large, and is read only if what it
declares is not too much either: a few kilobytes can declare terabytes. Times are not decoded. Texts
lie in heaps without a checksum, over which HDF5 loops for ever where a size in them is damaged.
"""

from __future__ import annotations

import mmap
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.errors import InputError, printable
from epicyclic.files import refuse

if TYPE_CHECKING:
    import netCDF4
    import xarray as xr

LARGEST = 400_000_000
"""A result takes a few megabytes, a map of a million points less than this. [bytes]"""
MOST_VARIABLES = 2000
LONG = 1000
"""Texts of more points than this are read apart: xarray makes all as long as the longest one."""
POINTER = 8  # Of a text, which is known only when it is read. [bytes]
_SIGNATURE = b"\x89HDF\r\n\x1a\n"  # First bytes of HDF5, in which NetCDF 4 files are kept.
_HEAP = struct.Struct("<4sB3xQ")
"""Head of a heap: signature, version, size of all of it. HDF5 File Format Specification, "Global
Heap", second hand. [bytes]"""
_HEAP_OBJECT = struct.Struct("<H6xQ")
"""Head of what lies in a heap: number, 0 for the free rest, and size. [bytes]"""
_HEAP_SIGNATURE, _HEAP_VERSION = b"GCOL", 1
_LONGEST_REASON = 120
_MAKE_AGAIN = "Create it again."


def read_groups(path: Path) -> dict[str, xr.Dataset]:
    """All that a file holds, in memory: the root by an empty name, groups by their path.

    Raises `InputError` if it is no NetCDF file, is damaged, or holds too much.
    """
    import netCDF4
    import xarray as xr

    _check(path)
    with _damage_told(), netCDF4.Dataset(path) as file, texts_not_copied():
        groups = list(_groups(file))
        left_out = {name for group in groups for name in _long_texts(group)}
        texts = {
            group.path: {name: own for name, own in group.variables.items() if name in left_out}
            for group in groups
        }
        with xr.open_datatree(
            path, engine="netcdf4", decode_times=False, drop_variables=left_out
        ) as tree:
            sizes = [data.nbytes for node in tree.subtree for data in node.variables.values()]
            sizes += [POINTER * text.size for own in texts.values() for text in own.values()]
            if len(sizes) > MOST_VARIABLES or sum(sizes) > LARGEST:
                refuse("contains more than a result or a map.", "Give one of these.")
            tree.load()
            return {
                node.path.strip("/"): node.to_dataset(inherit=False).assign(
                    {name: _text(text) for name, text in texts[node.path].items()}
                )
                for node in tree.subtree
                if node.path == "/" or node.has_data
            }


def _groups(group: netCDF4.Dataset) -> Iterator[netCDF4.Dataset]:
    """A group and all in it."""
    yield group
    for inner in group.groups.values():
        yield from _groups(inner)


def _long_texts(group: netCDF4.Dataset) -> set[str]:
    """Names of texts over many points, axes and what stands beside them left out."""
    listed = [getattr(own, "coordinates", "") for own in (group, *group.variables.values())]
    axes = {*group.dimensions, *" ".join(map(str, listed)).split()}
    long = {name for name, own in group.variables.items() if own.dtype is str and own.size > LONG}
    return long - axes


def _text(variable: netCDF4.Variable[Any]) -> tuple[tuple[str, ...], NDArray[Any], dict[str, Any]]:
    """Dimensions, values and attributes."""
    about = {name: variable.getncattr(name) for name in variable.ncattrs()}
    about.pop("coordinates", None)  # which xarray writes, and takes away
    return variable.dimensions, np.asarray(variable[...], dtype=object), about


@contextmanager
def texts_not_copied() -> Iterator[None]:
    """Keep texts the strings they are: pandas would copy them for pyarrow, and back, each time."""
    import pandas as pd

    with pd.option_context("mode.string_storage", "python"):
        yield


def read_attribute(path: Path, name: str) -> str:
    """A text attribute of the root; none of the arrays is read. Errors as for `read_groups`."""
    import netCDF4

    _check(path)
    with _damage_told(), netCDF4.Dataset(path) as file:
        if name not in file.ncattrs():
            refuse(f"has no attribute {name}.", _MAKE_AGAIN)
        return str(file.getncattr(name))


def _check(path: Path) -> None:
    """Raise `InputError` unless a file can be opened: a pipe would keep the program waiting."""
    try:
        if not path.is_file():
            refuse("does not exist or is not a file.", "Check the path.")
        if path.stat().st_size > LARGEST:
            refuse(f"is larger than {LARGEST // 10**6} MB.", "Give a smaller file.")
        with path.open("rb") as file:
            if file.read(len(_SIGNATURE)) != _SIGNATURE:
                refuse("is not a NetCDF 4 file.", _MAKE_AGAIN)
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
                if not all(_ends(data, place) for place in _heaps(data)):
                    refuse("is damaged: a heap of texts is incomplete.", _MAKE_AGAIN)
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        refuse(f"cannot be read: {getattr(error, 'strerror', None) or error}.", "Check the path.")


def _heaps(data: mmap.mmap) -> Iterator[int]:
    """Where what looks like the head of a heap is."""
    place = data.find(_HEAP_SIGNATURE)
    while place >= 0:
        if place + _HEAP.size <= len(data):
            _, version, size = _HEAP.unpack_from(data, place)
            if version == _HEAP_VERSION and place + size <= len(data):
                yield place
        place = data.find(_HEAP_SIGNATURE, place + 1)


def _ends(data: mmap.mmap, heap: int) -> bool:
    """Whether one goes on in a heap from each object to the next until its end."""
    end = heap + _HEAP.unpack_from(data, heap)[2]
    place = heap + _HEAP.size
    while place + _HEAP_OBJECT.size <= end:
        number, size = _HEAP_OBJECT.unpack_from(data, place)
        step = size if number == 0 else _HEAP_OBJECT.size + -(-size // 8) * 8
        if not 0 < step <= end - place:
            return False
        place += step
    return True


@contextmanager
def _damage_told() -> Iterator[None]:
    """What the libraries raise on damaged files, which is anything, as `InputError`."""
    try:
        yield
    except InputError:
        raise
    except Exception as error:
        reason = printable(" ".join(str(error).split()))[:_LONGEST_REASON]
        refuse(f"is damaged: {reason}.", _MAKE_AGAIN)
