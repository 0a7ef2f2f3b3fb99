"""All NetCDF files of users are read through one door, and maps are checked behind it."""

from __future__ import annotations

import os
import sys
import time

import h5py
import netCDF4
import numpy as np
import pytest
import xarray as xr

import epicyclic as ep
from epicyclic.cli.main import main
from epicyclic.losses.pocket_tables import read_stored
from epicyclic.netcdf_file import read_groups
from epicyclic.show.record import open_map
from limits import MOST_MEMORY, is_soon, peak_memory


@pytest.fixture
def file(pair_map, tmp_path):
    path = tmp_path / "map.nc"
    ep.write_map(pair_map, path)
    return path


def changed(variable, index, value):
    def change(data):
        data[variable][index] = value

    return change


def with_attribute(variable, name, value):
    def change(data):
        (data[variable] if variable else data).setncattr(name, value)

    return change


def swapped(data):
    data["torque"][:] = data["torque"][::-1]


def bomb(data):
    data.createDimension("many", 4 * 10**9)
    data.createVariable("huge", "f8", ("many",), zlib=True, chunksizes=(10**6,))


def bomb_of_texts(data):
    data.createDimension("many", 4 * 10**9)
    data.createVariable("huge", str, ("many",))


HOSTILE = {
    "gained power": (changed("total", (1, 1, 0), -3.0), "total: must not be below 0."),
    "gained torque": (changed("torque_loss", (1, 1, 0), -2.0), "torque_loss: must not be below 0."),
    "which exceeds": (changed("efficiency", (1, 1, 0), 1.07), "efficiency: must not exceed 1."),
    "nowhere": (changed("speed", 1, np.nan), "speed: must have finite values."),
    "endless": (changed("temperature", 1, np.inf), "temperature: must "),
    "unsorted": (swapped, "torque: must be increasing."),
    "twice": (changed("torque", 1, -100.0), "torque: must be increasing."),
    "other unit": (with_attribute("speed", "units", "rad/s"), "speed = rad/s: must be in rpm."),
    "times": (with_attribute("temperature", "units", "days since 1970-01-01"), "must be in degC."),
    "unit of losses": (with_attribute("total", "units", "kW"), "total = kW: must be in W."),
    "endless loss": (changed("mesh_sliding", (1, 1, 1), -np.inf), "mesh_sliding: must be finite."),
    "junk case": (with_attribute("", "case", "{}"), "must name the kind of the case"),
    "no json": (with_attribute("", "case", "junk"), "case: "),
    "bomb": (bomb, "contains more than"),
    "bomb of texts": (bomb_of_texts, "contains more than"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_duty_cycle_refuses_a_damaged_map(file, tmp_path, monkeypatch, capsys, name):
    change, reason = HOSTILE[name]
    with netCDF4.Dataset(file, "a") as data:
        change(data)
    cycle = tmp_path / "cycle.csv"
    cycle.write_text("speed [rpm],torque [N*m],temperature [degC],duration [s]\n900,40,60,7\n")
    monkeypatch.setattr("sys.argv", ["epicyclic", "duty", str(file), str(cycle)])
    with pytest.raises(SystemExit) as ended:
        main()
    shown = capsys.readouterr()
    assert ended.value.code == 2, shown
    assert shown.out == ""
    assert reason in shown.err


@pytest.mark.parametrize("read", [ep.open_result, open_map, read_stored])
@pytest.mark.skipif(sys.platform == "win32", reason="needs named pipes")
def test_a_pipe_is_refused_at_once(tmp_path, read):
    os.mkfifo(tmp_path / "pipe.nc")
    with pytest.raises(ep.InputError, match="is not a file"):
        read(tmp_path / "pipe.nc")


def test_a_dataset_in_memory_is_checked_as_well(pair_map):
    cycle = {"speed [rpm]": [900.0], "torque [N*m]": [40.0], "duration [s]": [7.0]}
    for axis in ("speed", "torque"):
        backwards = pair_map.isel({axis: slice(None, None, -1)})
        with pytest.raises(ep.InputError, match=f"{axis}: must be increasing"):
            ep.duty_cycle(backwards, cycle, ["60 degC"])


def test_texts_of_many_points_are_as_long_as_each_is(tmp_path):
    shape = (40, 30)
    numbers = np.arange(1200.0).reshape(shape)
    notes = np.array([f"point {number}" for number in range(1200)], dtype=object).reshape(shape)
    notes[7, 3] = "x" * 50_000  # of which xarray makes 240 MB
    written = xr.Dataset(
        {
            "total": (("a", "b"), numbers),
            "message": (("a", "b"), notes + "!"),
            "status": (("a", "b"), notes + "?"),
            "warnings": (("a", "b"), notes, {"long_name": "words", "units": "1"}),
        },
        {
            "a": np.linspace(1, 5, 40),
            "material": ("a", [f"steel {number}" for number in range(40)]),
            "place": (("a", "b"), [[f"{i} of {j}" for j in range(30)] for i in range(40)]),
        },
        {"title": "one"},
    )
    written.to_netcdf(tmp_path / "many.nc")
    read = read_groups(tmp_path / "many.nc")[""]
    xr.testing.assert_identical(read, written)
    assert read["warnings"].dtype == object
    assert list(read.data_vars) == ["total", "message", "status", "warnings"]
    assert list(read.coords) == ["a", "material", "place"]


def test_a_result_is_no_map(talbot_record, tmp_path):
    ep.save_result(talbot_record, tmp_path / "result.nc")
    with pytest.raises(ep.InputError, match="is a stored result"):
        open_map(tmp_path / "result.nc")


@pytest.mark.parametrize("damage", ["no rest", "too long", "endless"])
def test_a_heap_without_an_end_is_refused(tmp_path, damage):
    """HDF5 itself never comes back from the first one."""
    path = tmp_path / "texts.nc"
    with netCDF4.Dataset(path, "w") as data:
        data.createDimension("place", 3)
        data.createVariable("text", str, ("place",))[:] = np.array(["one", "three", "five"], object)
    assert read_groups(path)[""]["text"].values.tolist() == ["one", "three", "five"]
    content = bytearray(path.read_bytes())
    heap = content.index(b"GCOL")
    first = heap + 16
    size = int.from_bytes(content[first + 8 : first + 16], "little")
    rest = first
    while content[rest : rest + 2] != b"\0\0":
        rest += 16 + -(-int.from_bytes(content[rest + 8 : rest + 16], "little") // 8) * 8
    at, wrong = {
        "no rest": (rest + 8, 0),
        "too long": (first + 8, size + 4096),
        "endless": (first + 8, 2**64 - 16),
    }[damage]
    content[at : at + 8] = wrong.to_bytes(8, "little")
    path.write_bytes(content)
    with pytest.raises(ep.InputError, match="a heap of texts is incomplete"):
        read_groups(path)


def external(file, other):
    file.create_dataset("outside", (18,), "f8", external=[(str(other), 0, 144)])


def virtual(file, other):
    layout = h5py.VirtualLayout((18,), "f8")
    layout[:] = h5py.VirtualSource(str(other), "losses", (18,))
    file.create_virtual_dataset("outside", layout)


def growing(file, other):
    """HDF5 looks into the other file to know how long this is."""
    layout = h5py.VirtualLayout((18,), "f8", maxshape=(None,))
    source = h5py.VirtualSource(str(other), "losses", (18,), maxshape=(None,))
    layout[: h5py.h5s.UNLIMITED] = source[: h5py.h5s.UNLIMITED]
    file.create_virtual_dataset("outside", layout)


def linked(file, other):
    file["outside"] = h5py.ExternalLink(str(other), "losses")


def named(file, other):
    file["inside"] = h5py.SoftLink("/total")


def round_again(file):
    file["loop"] = file["/"]


def round_below(file):
    inner = file.create_group("meshes/sun_mesh")
    inner["up"] = file["meshes"]


def twice(file):
    file["again"] = file["total"]


def crowd(file):
    for number in range(2500):
        file.create_group(f"group {number}")


def tower(file):
    file.create_group("/".join(["floor"] * 700))


def many_labels(file):
    for number in range(21_000):
        file["total"].attrs[f"label {number}"] = 0.5 * number


def lists(file):
    file.create_dataset("lists", (3,), h5py.vlen_dtype(float))


POINTING = {
    external: "points at other files",
    virtual: "points at other files",
    growing: "points at other files",
    linked: "contains links",
    named: "contains links",
}
ENDLESS = {
    round_again: "in two places",
    round_below: "in two places",
    twice: "in two places",
    crowd: "contains more than",
    tower: "contains more than",
    many_labels: "contains more than",
    lists: "other than numbers and texts",
}


def assert_refused_soon(file, reason):
    before, start = peak_memory(), time.process_time()
    for read in (ep.open_result, read_stored):
        with pytest.raises(ep.InputError, match=reason):
            read(file)
    assert is_soon(time.process_time() - start)
    assert peak_memory() - before < MOST_MEMORY


@pytest.mark.parametrize("change", POINTING, ids=lambda change: change.__name__)
@pytest.mark.parametrize("what", ["pipe", "file"])
@pytest.mark.skipif(sys.platform == "win32", reason="needs named pipes")
def test_what_lies_elsewhere_is_refused_unread(file, tmp_path, change, what):
    """From the pipe nobody would ever come back."""
    other = tmp_path / "other"
    if what == "pipe":
        os.mkfifo(other)
    else:
        with h5py.File(other, "w") as theirs:
            theirs.create_dataset("losses", data=np.linspace(3, 20, 18), maxshape=(None,))
    with h5py.File(file, "a") as own:
        change(own, other)
    assert_refused_soon(file, POINTING[change])


@pytest.mark.parametrize(
    "change",
    [pytest.param(one, marks=pytest.mark.slow) if one is many_labels else one for one in ENDLESS],
    ids=lambda change: change.__name__,
)
def test_loops_and_masses_are_refused_soon(file, change):
    with h5py.File(file, "a") as own:
        change(own)
    assert_refused_soon(file, ENDLESS[change])


@pytest.mark.skipif(sys.platform != "linux", reason="needs a limit of memory")
def test_a_text_of_a_false_length_takes_no_more_memory(tmp_path):
    """HDF5 takes as much memory as what points at a text says, and looks at the text later."""
    path = tmp_path / "texts.nc"
    with netCDF4.Dataset(path, "w") as data:
        data.createDimension("place", 3)
        data.createVariable("text", str, ("place",))[:] = np.array(["one", "three", "five"], object)
    content = bytearray(path.read_bytes())
    heap = content.index(b"GCOL").to_bytes(8, "little")
    length = content.index((5).to_bytes(4, "little") + heap)
    content[length : length + 4] = (1_900_000_000).to_bytes(4, "little")
    path.write_bytes(content)
    before = peak_memory()
    with pytest.raises(ep.InputError, match="is damaged"):
        read_groups(path)
    assert peak_memory() - before < MOST_MEMORY


OWN = {
    "DIMENSION_LIST": (True, 7, [1, 2, 3], "x", h5py.Empty("f")),
    "NAME": (np.arange(3000), np.array([b"a"] * 40), 3),
    "CLASS": (5, np.array([b"DIMENSION_SCALE"] * 2)),
    "_Netcdf4Dimid": (2**40, -1, np.arange(3000), "x"),
    "_Netcdf4Coordinates": (np.arange(3000), 2**31, -2, 0.5),
    "_Quantize_": (np.arange(3000), "x"),
    "_nc3_strict": (np.arange(3000), 1.5),
}


@pytest.mark.parametrize("name", OWN)
def test_attributes_that_the_library_believes_are_checked_unread(tmp_path, name):
    """Where they are of another type or size, it overwrites memory, and ends the process."""
    for number, value in enumerate(OWN[name]):
        path = tmp_path / f"{number}.nc"
        xr.Dataset({"loss": ("speed", [1.5, 2.5])}, {"speed": [3.0, 4.0]}).to_netcdf(path)
        assert set(read_groups(path)[""]) == {"loss"}
        path = path.rename(tmp_path / f"{number}-changed.nc")
        with h5py.File(path, "a") as data:
            place = data["loss" if name in ("DIMENSION_LIST", "_Netcdf4Coordinates") else "speed"]
            place.attrs.pop(name, None)
            place.attrs[name] = value
        with pytest.raises(ep.InputError, match=f"attribute {name} is not one of NetCDF"):
            read_groups(path)
