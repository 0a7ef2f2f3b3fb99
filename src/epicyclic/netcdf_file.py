"""NetCDF files that users give: the only door through which the package reads them.

A file is opened only if it is a regular file of HDF5 and not too large, and if all in it lies in
itself, and once only: netCDF4 reads other files that it names, and goes round in loops of groups.
It is read only if what it declares is not too much either: a few kilobytes can declare terabytes.
Times are not decoded. Texts lie in heaps without a checksum, over which HDF5 loops for ever where a
size in them is damaged; what points at a text states its length, which HDF5 believes.
"""

from __future__ import annotations

import mmap
import struct
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from epicyclic.errors import InputError, printable
from epicyclic.files import read_bytes, refuse

if TYPE_CHECKING:
    import h5py
    import netCDF4
    import xarray as xr

LARGEST = 400_000_000
"""A result takes a few megabytes, a map of a million points less than this. [bytes]"""
MOST_VARIABLES, MOST_ATTRIBUTES, DEEPEST = 2000, 20_000, 10
"""Of all groups together, which count as variables; and of groups in groups."""
MOST_MEMORY = 450_000_000
"""Beyond what is in use and a few times the file: texts take more as objects of Python. [bytes]"""
TEXTS = 4
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
_OWN_ATTRIBUTES = {
    "CLASS": ("text", False),
    "NAME": ("text", False),
    "DIMENSION_LIST": ("axes", True),
    "_NCProperties": ("text", False),
    "_Netcdf4Coordinates": ("integer", True),
    "_Netcdf4Dimid": ("integer", False),
    "_Quantize": ("integer", False),
    "_nc3_strict": ("integer", False),
}
"""Attributes that netCDF4 reads as its own, by name or how it begins: what they hold, and whether
for each axis."""
_LONGEST_REASON = 120
_MAKE_AGAIN = "Create it again."


def read_groups(path: Path) -> dict[str, xr.Dataset]:
    """All that a file holds, in memory: the root by an empty name, groups by their path.

    Raises `InputError` if it is no NetCDF file, is damaged, or holds too much.
    """
    import netCDF4
    import xarray as xr

    with _checked(path), netCDF4.Dataset(path) as file, texts_not_copied():
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
            if sum(sizes) > LARGEST:
                _refuse_mass()
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

    with _checked(path), netCDF4.Dataset(path) as file:
        if name not in file.ncattrs():
            refuse(f"has no attribute {name}.", _MAKE_AGAIN)
        return str(file.getncattr(name))


@contextmanager
def _checked(path: Path) -> Iterator[None]:
    """Where a file is opened that can be; whatever is wrong in it ends in an `InputError`."""
    import h5py

    _check(path)
    with _damage_told(), _bounded_memory(MOST_MEMORY + TEXTS * path.stat().st_size):
        with h5py.File(path) as file:
            _check_objects(file)
        yield


def _check_objects(file: h5py.File) -> None:
    """Raise `InputError` unless all objects lie in the file, each in one place, and are few."""
    import h5py

    inside, known = h5py.HardLink, (h5py.h5t.INTEGER, h5py.h5t.FLOAT, h5py.h5t.STRING)
    left, seen, attributes = [(file["/"], 0)], set(), 0
    while left:
        one, depth = left.pop()
        about = h5py.h5o.get_info(one.id)
        attributes += about.num_attrs
        if attributes > MOST_ATTRIBUTES:
            _refuse_mass()
        _check_own_attributes(one)
        if about.addr in seen:
            refuse("contains a group or variable in two places.", _MAKE_AGAIN)
        seen.add(about.addr)
        if isinstance(one, h5py.Group):
            if len(one) + len(left) + len(seen) > MOST_VARIABLES or depth > DEEPEST:
                _refuse_mass()
            if not all(type(one.get(name, getlink=True)) is inside for name in one):
                refuse("contains links.", _MAKE_AGAIN)
            left += [(one[name], depth + 1) for name in one]
            continue
        if not isinstance(one, h5py.Dataset) or one.id.get_type().get_class() not in known:
            refuse("contains types other than numbers and texts.", _MAKE_AGAIN)
        made = one.id.get_create_plist()
        if made.get_external_count() or made.get_layout() == h5py.h5d.VIRTUAL:
            refuse("points at other files.", _MAKE_AGAIN)


def _check_own_attributes(one: h5py.Group | h5py.Dataset) -> None:
    """Raise `InputError` unless attributes of netCDF4 are what it takes them for, unseen.

    One of another type or size overwrites memory, and ends the process or worse.
    """
    import h5py

    kinds = {"integer": h5py.h5t.INTEGER, "text": h5py.h5t.STRING, "axes": h5py.h5t.VLEN}
    for name in one.attrs:
        known = "_Quantize" if name.startswith("_Quantize") else name
        if known not in _OWN_ATTRIBUTES:
            continue
        kind, for_each_axis = _OWN_ATTRIBUTES[known]
        attribute = one.attrs.get_id(name)
        sound = attribute.get_type().get_class() == kinds[kind]
        sound &= attribute.get_space().get_simple_extent_npoints() == (
            one.ndim if for_each_axis and isinstance(one, h5py.Dataset) else 1
        )
        if sound and kind == "axes":
            sound = attribute.get_type().get_super().get_class() == h5py.h5t.REFERENCE
        if sound and kind == "integer":
            values = np.asarray(one.attrs[name])
            sound = bool(((values >= 0) & (values <= MOST_VARIABLES)).all())
        if not sound:
            refuse(f"is damaged: its attribute {name} is not one of NetCDF.", _MAKE_AGAIN)


def _refuse_mass() -> NoReturn:
    refuse("contains more than a result or a map.", "Give one of these.")


@contextmanager
def _bounded_memory(most: int) -> Iterator[None]:
    """Let this process take so many bytes more; where the system counts them."""
    if sys.platform != "linux":
        yield
        return
    import resource

    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[5])
    before, largest = resource.getrlimit(resource.RLIMIT_DATA)
    limits = [pages * resource.getpagesize() + most, before, largest]
    soft = min(limit for limit in limits if limit != resource.RLIM_INFINITY)
    resource.setrlimit(resource.RLIMIT_DATA, (soft, largest))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_DATA, (before, largest))


def _check(path: Path) -> None:
    """Raise `InputError` unless a file can be opened: a pipe would keep the program waiting."""
    try:
        if not path.is_file():
            refuse("does not exist or is not a file.", "Check the path.")
        if path.stat().st_size > LARGEST:
            refuse(f"is larger than {LARGEST // 10**6} MB.", "Give a smaller file.")
        if not read_bytes(path, "NetCDF", len(_SIGNATURE), whole=False).startswith(_SIGNATURE):
            refuse("is not a NetCDF 4 file.", _MAKE_AGAIN)
        with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
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
        reason = printable(" ".join(str(error).split()))[:_LONGEST_REASON] or type(error).__name__
        refuse(f"is damaged: {reason}.", _MAKE_AGAIN)
