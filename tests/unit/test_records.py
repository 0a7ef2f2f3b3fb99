"""Files of results: what they keep, and what is refused."""

from __future__ import annotations

import json
import math
import tracemalloc

import netCDF4
import pytest
import xarray as xr

import epicyclic as ep
from epicyclic.errors import InputError
from epicyclic.machine.element import note_watts
from epicyclic.show.record import open_map


@pytest.fixture(scope="module")
def content(talbot_record, tmp_path_factory):
    path = tmp_path_factory.mktemp("records") / "result.nc"
    ep.save_result(talbot_record, path)
    return path.read_bytes()


@pytest.fixture
def file(content, tmp_path):
    """A stored result."""
    path = tmp_path / "result.nc"
    path.write_bytes(content)
    return path


def test_a_file_gives_back_what_was_kept(talbot_record, file):
    found = ep.open_result(file)
    assert found.result.to_json() == talbot_record.result.to_json()
    # not in the JSON; it orders warnings
    concerned = [list(map(note_watts, it.result.notes)) for it in (found, talbot_record)]
    assert concerned[0] == concerned[1]
    assert any(map(math.isfinite, concerned[1]))
    assert found.given == talbot_record.given
    assert found.created == talbot_record.created
    assert found.numbers.identical(talbot_record.numbers)
    assert list(found.fields) == list(talbot_record.fields)
    for path, data in talbot_record.fields.items():
        assert found.fields[path].identical(data), path


def test_a_file_explains_itself_to_other_programs(talbot, file):
    with xr.open_datatree(file, engine="netcdf4") as tree:
        assert float(tree["total"]) == ep.solve(talbot).total
        assert tree["total"].attrs["units"] == "W"
        assert tree["meshes/sun_mesh/line_load"].attrs["units"] == "N/mm"
        result = json.loads(tree.attrs["result"])
        assert ep.load_case(result["inputs"]) == talbot
        for node in tree.subtree:
            for name, array in node.data_vars.items():
                if array.dtype.kind == "f":
                    assert array.attrs["long_name"], name
                    assert array.attrs["units"], name


def test_the_json_of_a_result_is_what_a_record_holds(talbot, talbot_record):
    result = json.loads(ep.solve(talbot).to_json())
    assert talbot_record.result.to_dict() == result


def test_a_map_is_read_as_it_was_written(pair_map, tmp_path):
    ep.write_map(pair_map, tmp_path / "map.nc")
    found = ep.open_result(tmp_path / "map.nc")
    xr.testing.assert_equal(found["torque_loss"], pair_map["torque_loss"])
    assert found.attrs == pair_map.attrs


@pytest.mark.parametrize("name", ["result.txt", "no-folder/result.nc"])
def test_there_must_be_a_place_for_the_file(talbot_record, tmp_path, name):
    with pytest.raises(InputError):
        ep.save_result(talbot_record, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def _attribute(name, value):
    def change(file):
        with netCDF4.Dataset(file, "a") as data:
            data.setncattr(name, value)

    return change


def _json(**changes):
    def change(file):
        with netCDF4.Dataset(file, "a") as data:
            data.result = json.dumps(json.loads(data.result) | changes)

    return change


def _renamed(group, name):
    def change(file):
        with netCDF4.Dataset(file, "a") as data:
            data[group].renameVariable(name, "other")

    return change


def _gear(**attributes):
    def change(file):
        with netCDF4.Dataset(file, "a") as data:
            data["gears/sun"].setncatts(attributes)

    return change


def _value(path, value):
    def change(file):
        with netCDF4.Dataset(file, "a") as data:
            data[path][...] = value

    return change


def _unlabelled(file):
    with netCDF4.Dataset(file, "a") as data:
        data["meshes/ring_mesh/line_load"].delncattr("units")


def _other_dimensions(file):
    with netCDF4.Dataset(file, "a") as data:
        group = data["meshes/sun_mesh"]
        group.renameVariable("pair_load", "other")
        group.createVariable("pair_load", "f8", ("segment",)).setncatts(
            {"long_name": "x", "units": "N"}
        )


def _bomb(file):
    """A few kilobytes that declare 80 GB."""
    with netCDF4.Dataset(file, "a") as data:
        data.createDimension("many", 10**10)
        data.createVariable("huge", "f8", ("many",), zlib=True, chunksizes=(10**6,))


def _truncated(file):
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])


def _broken(file):
    content = bytearray(file.read_bytes())
    content[4000:60000] = b"\xff" * 56000
    file.write_bytes(content)


HOSTILE = {
    "text": (lambda file: file.write_text("total = 1"), "is not a NetCDF 4 file"),
    "empty": (lambda file: file.write_bytes(b""), "is not a NetCDF 4 file"),
    "signature-only": (lambda file: file.write_bytes(b"\x89HDF\r\n\x1a\n"), "is damaged"),
    "truncated": (_truncated, "is damaged"),
    "overwritten": (_broken, "is damaged"),
    "other-format": (_attribute("format", "something"), "neither a stored result nor a loss map"),
    "later-version": (_attribute("format_version", 99), "format version 99"),
    "no-json": (_attribute("result", "{"), "result: "),
    "nested": (_attribute("given", "[" * 100_000), "given: "),
    "no-date": (_attribute("created", "yesterday"), "created: "),
    "not-a-number": (_json(total=float("nan")), "result.total: "),
    "text-for-number": (_json(losses={"drag": "much"}), "result.losses.drag: "),
    "other-groups": (_json(groups={}), "name different losses"),
    "no-operation": (_json(inputs={"kind": "planetary"}), "must state operation"),
    "no-version": (_json(versions={}), "version of epicyclic"),
    "missing-variable": (_renamed("views/sun_mesh", "path_x"), "views/sun_mesh/path_x: is missing"),
    "no-label": (_unlabelled, "meshes/ring_mesh/line_load: has no label or no unit"),
    "other-dimensions": (_other_dimensions, "must be numbers over mesh_position, contact_line"),
    "nowhere": (
        _value("gears/sun/center_x", float("nan")),
        "center_x: must not have missing values",
    ),
    "endless": (_value("meshes/sun_mesh/line_load", float("inf")), "line_load: must not exceed"),
    "without-size": (_value("gears/ring/tip_diameter", 0.0), "tip_diameter: must be positive"),
    "endless-teeth": (_gear(teeth=10**9), "gears/sun/teeth = 1000000000"),
    "teeth-in-words": (_gear(teeth="many"), "gears/sun/teeth = many"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_file_that_is_not_sound_is_refused_with_the_reason(file, name):
    change, reason = HOSTILE[name]
    change(file)
    with pytest.raises(InputError) as caught:
        ep.open_result(file)
    assert reason in str(caught.value)
    assert str(file) in str(caught.value)


def test_a_file_that_declares_more_than_it_holds_takes_no_memory(file):
    _bomb(file)
    tracemalloc.start()
    with pytest.raises(InputError, match="contains more than"):
        ep.open_result(file)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 50e6


def test_what_is_no_file_is_refused(tmp_path):
    for path in (tmp_path, tmp_path / "missing.nc"):
        with pytest.raises(InputError, match="does not exist or is not a file"):
            ep.open_result(path)


def test_a_map_without_its_text_is_refused(pair_map, tmp_path):
    pair_map.drop_vars(["status", "total"]).to_netcdf(tmp_path / "map.nc")
    with pytest.raises(InputError) as caught:
        ep.open_result(tmp_path / "map.nc")
    assert [problem.key for problem in caught.value.problems] == ["total", "status"]


def test_a_sweep_is_no_map_and_what_is_neither_is_refused(tmp_path):
    case = ep.load_case("talbot-2012-pair").updated({"losses.mesh_pocketing.include": False})
    swept = ep.sweep(case, {"operation.torque": ["10 N*m"]})
    swept.to_netcdf(tmp_path / "sweep.nc")
    with pytest.raises(InputError, match="is not a loss map; it lacks"):
        open_map(tmp_path / "sweep.nc")
    swept.drop_vars("status").to_netcdf(tmp_path / "sweep.nc")
    with pytest.raises(InputError, match="neither a stored result nor a loss map"):
        ep.open_result(tmp_path / "sweep.nc")


@pytest.mark.parametrize("name", ["status", "message", "warnings"])
@pytest.mark.parametrize("change", ["renamed", "numbers"])
def test_a_sweep_without_its_texts_is_refused(tmp_path, name, change):
    vary = {"operation.speed": ["700 rpm", "1300 rpm"]}
    data = ep.sweep(ep.load_case("train-8hp70"), vary)
    path = tmp_path / "sweep.nc"
    data = (
        data.rename({name: "other"}) if change == "renamed" else data.assign({name: data["total"]})
    )
    data.to_netcdf(path, engine="netcdf4")
    with pytest.raises(ep.InputError, match=rf"{name}: must have a text|neither a stored result"):
        ep.open_result(path)
