"""REXS files that are broken or hostile, and what writing leaves as it is."""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
import zipfile

import pytest

import epicyclic as ep
from epicyclic.plugins.rexs import files as rexs_file
from epicyclic.plugins.rexs.files import read_document
from epicyclic.plugins.rexs.model import build_model
from limits import is_soon
from rexs_files import STAGE, SUN, pair, planetary
from rexs_files import none as no_unit

COARSE = {"numerics.mesh_positions": 4, "numerics.contact_segments": 4}

HEAD = '<?xml version="1.0"?>\n<model version="1.5" applicationId="a" date="d">'
ENTITIES = "".join(
    f'<!ENTITY {chr(c + 1)} "{f"&{chr(c)};" * 10}">' for c in range(ord("a"), ord("s"))
)
BOMB = f'<!DOCTYPE model [<!ENTITY a "aaaaaaaaaa">{ENTITIES}]>'
SECRET = '<!DOCTYPE model [<!ENTITY a SYSTEM "file:///etc/hostname">]>'


def zipped(**members: bytes) -> bytes:
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as target:
        for name, content in members.items():
            target.writestr(name.replace("__", "."), content)
    return archive.getvalue()


def archive_of(*members: tuple[str, bytes]) -> bytes:
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as target:
        for name, content in members:
            target.writestr(name, content)
    return archive.getvalue()


def xml(body: str) -> bytes:
    return f"{HEAD}{body}</model>".encode()


GOOD = pair().xml().encode()

BROKEN = {
    "empty": (b"", "is empty"),
    "blank": (b" \n", "is empty"),
    "cut short": (GOOD[: len(GOOD) // 2], "not valid XML"),
    "cut in the head": (b"<?xml", "not valid XML"),
    "not XML": (b"hello", "not valid XML"),
    "another XML": (b"<html/>", "first element is not model"),
    "binary": (bytes(range(256)), "not valid XML"),
    "wrong encoding": (GOOD.replace(b"stage B", b"st\xe4ge B"), "not valid XML"),
    "unknown encoding": (GOOD.replace(b"UTF-8", b"EBCDIC-X"), "not valid XML"),
    **{
        f"encoding {name}": (GOOD.replace(b"UTF-8", name), "not known here")
        for name in (b"ARMSCII-8", b"NEXTSTEP", b"KOI8-RU", b"JAVA")
    },
    "zero byte": (GOOD.replace(b"stage B", b"st\0ge B"), "not valid XML"),
    "deep": (xml("<a>" * 5000 + "</a>" * 5000), "not valid XML"),
    "entities": (f"{BOMB}<model version='1.5'>&s;</model>".encode(), "valid XML|document type"),
    "entities in an attribute": (f"{BOMB}<model version='&s;'/>".encode(), "valid XML"),
    "file entity": (f"{SECRET}<model version='1.5'>&a;</model>".encode(), "document type"),
    "file entity in an attribute": (f"{SECRET}<model version='&a;'/>".encode(), "valid XML"),
    "no version": (b"<model/>", 'version ""'),
    "later version": (xml("").replace(b"1.5", b"3.0"), 'version "3.0"'),
    "no gears": (xml(""), "no stages"),
    "id twice": (xml("<components><component id='1' type='a'/><component id='1' type='a'/>"
                     "</components>"), "component 1: appears twice"),
    "id of no number": (xml("<components><component id='one' type='a'/></components>"), "integer"),
    "attribute twice": (xml("<components><component id='1' type='a'><attribute id='x'/>"
                            "<attribute id='x'/></component></components>"), "x twice"),
    "relation twice": (xml("<relations><relation id='1' type='a'/><relation id='1' type='a'/>"
                           "</relations>"), "relation 1: appears twice"),
    "relation to nothing": (xml("<relations><relation id='1' type='a'><ref id='9' role='b'/>"
                                "</relation></relations>"), "component 9, which does not exist"),
    "load case of nothing": (xml("<load_spectrum id='1'><load_case id='1'><component id='9' "
                                 "type='a'/></load_case></load_spectrum>"), "component 9"),
    "JSON cut short": (pair().json().encode()[:500], "not valid JSON"),
    "JSON of another kind": (b'{"a": 1}', 'no object "model"'),
    "JSON list": (b"[1]", 'no object "model"'),
    "JSON NaN": (b'{"model": {"version": NaN}}', "not valid JSON: expected value at line 1"),
    "JSON deep": (b'{"model":' + b"[" * 100_000, "not valid JSON: recursion limit exceeded"),
    "JSON of long numbers": (b'{"model": {"version": ' + b"9" * 5000 + b"}}", "valid JSON"),
    "JSON in Latin-1": ('{"model": "ä"}'.encode("latin-1"), "not UTF-8"),
    "JSON of wrong types": (b'{"model": {"version": "1.5", "components": 3}}', "list of objects"),
    "not an archive": (b"PK\x03\x04 no archive", "not a valid archive"),
    "archive with a shifted directory": (zipped(a__rexs=GOOD)[8:], "valid XML|valid archive"),
    "archive with other sizes": (zipped(a__rexs=GOOD).replace(b"a.rexs", b"b.rexs", 1), "archive"),
    "archive cut short": (zipped(a__rexs=GOOD)[:300], "not a valid archive"),
    "empty archive": (archive_of(), "no member in REXS"),
    "archive of two": (zipped(a__rexs=GOOD, b__rexs=GOOD), "2 members"),
    "archive that leads out": (archive_of(("../a.rexs", GOOD)), "outside of it"),
    "archive to a root": (archive_of(("a.rexs", GOOD), ("/etc/b", b"")), "outside of it"),
    "archive to a drive": (archive_of(("C:\\a.rexs", GOOD)), "outside of it"),
    "archive in archive": (zipped(a__rexs=zipped(a__rexs=GOOD)), "not valid XML"),
}  # fmt: skip


@pytest.mark.parametrize("name", BROKEN)
def test_broken_files_are_told(tmp_path, name):
    content, told = BROKEN[name]
    file = tmp_path / "gears.rexs"
    file.write_bytes(content)
    with pytest.raises(ep.InputError, match=told) as excinfo:
        ep.read_rexs(file)
    assert excinfo.value.source == str(file)


def test_file_that_is_none_is_told(tmp_path):
    for path in (tmp_path, tmp_path / "no.rexs"):
        with pytest.raises(ep.InputError, match="cannot be read"):
            ep.read_rexs(path)


MAKE_HOSTILE = """
import io, os, sys, zipfile
from pathlib import Path
import epicyclic as ep
from epicyclic.plugins.rexs.files import LARGEST, MOST_SIGNS
head = b'<model version="1.5"><components>'
tail = b'</components></model>'
most = MOST_SIGNS - 20

def archive():
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as target:
        with target.open("a.rexs", "w") as member:
            for _ in range(100):
                member.write(bytes(1_000_000))
    return data.getvalue()

def many(text):
    signs = sum(map(text.count, (b"<", b"=", b":")))
    return b"".join(text % number for number in range(most // signs))

files = {
    "elements": lambda: head + b"<a/> " * most + tail,
    "attributes": lambda: head + b"<a " + many(b'a%d="" ') + b"/>" + tail,
    "components": lambda: head + many(b'<component id="%d" type="a" />') + tail,
    "text": lambda: head + b'<a b="' + b"x" * (LARGEST - 200) + b'"/>' + tail,
    "too long": lambda: bytes(2 * LARGEST),
    "too many": lambda: head + b"<a/>" * 2 * most + tail,
    "lists": lambda: b'{"model":{"version":"1.5","a":[' + b"[]," * most + b"[]]}}",
    "keys": lambda: b'{"model":{' + many(b'"%d":1,') + b'"version":"1.5"}}',
    "archive": archive,
}
ep.read_rexs  # imported once, by the parent of all
for name, make in files.items():
    file = Path(sys.argv[1]) / "hostile.rexs"
    file.write_bytes(make())
    child = os.fork()
    if not child:
        try:
            ep.read_rexs(file)
        except ep.InputError:
            os._exit(0)
        os._exit(1)
    _, status, used = os.wait4(child, 0)
    print(status, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, name)
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="each file is read in a process of its own")
def test_hostile_files_end_in_time_and_memory(tmp_path):
    """Within 5 s of processor time and 500 MB, libraries included."""
    command = [sys.executable, "-c", MAKE_HOSTILE, str(tmp_path)]
    found = subprocess.run(command, capture_output=True, text=True, check=True)
    lines = [line.split(" ", 3) for line in found.stdout.splitlines()]
    assert len(lines) == 9
    assert [name for status, *_, name in lines if status != "0"] == []
    assert is_soon(max(float(seconds) for _, seconds, _, _ in lines)), found.stdout
    assert max(float(memory) for _, _, memory, _ in lines) < 500, found.stdout


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    folder = tmp_path_factory.mktemp("rexs")
    file = pair().write(folder / "gears.rexs")
    return ep.solve(ep.load_case(file, COARSE))


def attributes(path, component):
    model = build_model(read_document(path).content)
    return {item.id: item.value for item in model.components[component].attributes}


def test_results_are_added_and_all_else_stays(tmp_path, solved):
    parts = pair()
    parts.set(STAGE, overlap_contact_ratio=no_unit("0.123"), unknown_to_all=no_unit("kept"))
    text = parts.xml().replace("<components>", '<components xmlns:x="urn:x"><!-- ä --><x:y z="1"/>')
    original = tmp_path / "original.rexs"
    original.write_text(text, encoding="utf-8")
    file = tmp_path / "out.rexs"
    ep.write_rexs(file, solved, original)
    lines = file.read_text(encoding="utf-8").splitlines()
    kept = [line for line in lines if "custom_epicyclic" not in line]
    added = [line for line in kept if line not in text.splitlines()]
    assert [re.search('id="(.*?)"', line)[1] for line in added] == [
        "radial_contact_ratio", "operating_viscosity",
    ]  # fmt: skip
    assert [line for line in kept if line not in added] == text.splitlines()
    stage = attributes(file, STAGE)
    assert stage["overlap_contact_ratio"] == "0.123"  # of another program, not ours to change
    assert float(stage["custom_epicyclic_total"]) == pytest.approx(solved.total)
    assert float(stage["custom_epicyclic_power_loss"]) == pytest.approx(
        sum(watts for name, watts in solved.losses.items() if name.startswith("mesh_"))
    )


def test_attributes_that_a_version_does_not_know_are_not_written(tmp_path, solved):
    parts = pair("1.2")
    for component in parts.components.values():
        component["type"] = component["type"].replace("cylindrical_gear_flank", "flank_geometry")
    out = tmp_path / "out.rexs"
    ep.write_rexs(out, solved, parts.write(tmp_path / "gears.rexs"))
    standard = {name for name in attributes(out, STAGE) if not name.startswith("custom_")}
    assert standard == {"center_distance", "radial_contact_ratio", "overlap_contact_ratio"}


def test_results_are_replaced_when_written_again(tmp_path, solved):
    file = pair().write(tmp_path / "gears.rexs")
    first, second = tmp_path / "first.rexs", tmp_path / "second.rexs"
    ep.write_rexs(first, solved, file)
    ep.write_rexs(second, solved, first)
    assert first.read_bytes() == second.read_bytes()


def test_json_keeps_what_is_unknown(tmp_path, solved):
    file = pair().write(tmp_path / "gears.rexsj")
    out = tmp_path / "out.rexsj"
    ep.write_rexs(out, solved, file)
    before, after = (json.loads(path.read_text(encoding="utf-8"))["model"] for path in (file, out))
    assert after["note"] == before["note"]
    assert after["relations"] == before["relations"]
    for old, new in zip(before["components"], after["components"], strict=True):
        assert new["attributes"][: len(old["attributes"])] == old["attributes"]
    assert attributes(out, STAGE)["custom_epicyclic_total"] == pytest.approx(solved.total)


def test_archive_keeps_its_other_members(tmp_path, solved):
    file = tmp_path / "gears.rexsz"
    file.write_bytes(archive_of(("m/gears.rexs", GOOD), ("gde/flank.xml", b"<gde/>")))
    out = tmp_path / "out.rexsz"
    ep.write_rexs(out, solved, file)
    with zipfile.ZipFile(out) as archive:
        assert archive.namelist() == ["m/gears.rexs", "gde/flank.xml"]
        assert archive.read("gde/flank.xml") == b"<gde/>"
    assert "custom_epicyclic_total" in attributes(out, STAGE)


def test_results_belong_into_their_own_file(tmp_path, solved):
    parts = pair()
    parts.set(SUN, number_of_teeth=no_unit(23))
    file = parts.write(tmp_path / "other.rexs")
    out = tmp_path / "out.rexs"
    with pytest.raises(ep.InputError, match=r"pinion\.teeth = 24: is 23\.0"):
        ep.write_rexs(out, solved, file)
    assert not out.exists()


def test_too_much_beside_the_model_is_not_copied(tmp_path, solved, monkeypatch):
    monkeypatch.setattr(rexs_file, "_LARGEST_REST", 100)
    file = tmp_path / "gears.rexsz"
    file.write_bytes(archive_of(("gears.rexs", GOOD), ("big", b"x" * 101)))
    assert ep.read_rexs(file).kind == "gear_pair"
    with pytest.raises(ep.InputError, match="too many files beside"):
        ep.write_rexs(tmp_path / "out.rexsz", solved, file)


def test_new_file_describes_the_same_pair(tmp_path, solved):
    for suffix in (".rexs", ".rexsj", ".rexsz"):
        file = tmp_path / f"new{suffix}"
        ep.write_rexs(file, solved)
        found = ep.read_rexs(file)
        case, first = found.case(), ep.load_case(solved.inputs)
        assert found.geometry_notes(case) == ()
        for table in ("pinion", "gear"):
            again, given = getattr(case, table), getattr(first, table)
            for key in ("teeth", "face_width", "profile_shift_coefficient", "roughness"):
                # fifteen digits of lengths, six of the roughness
                assert getattr(again, key) == pytest.approx(getattr(given, key), rel=1e-5, abs=1e-9)
        assert case.gears.center_distance == pytest.approx(first.gears.center_distance)
        assert case.operation == first.operation


def test_new_file_describes_the_same_planetary_set(tmp_path, talbot):
    file = tmp_path / "new.rexs"
    ep.write_rexs(file, ep.solve(talbot.updated(COARSE)))
    tables = ep.read_rexs(file).tables
    assert tables["planet"]["count"] == 3
    assert tables["operation"] == {
        "fixed": "ring", "input": "sun", "speed": "4000 rpm", "torque": "1000 N*m",
        "oil_inlet_temperature": "90 degC",
    }  # fmt: skip
    assert tables["planet_bearing"]["pin_diameter"] == "25.991 mm"
    assert tables["planet_bearing"]["rows"] == 2
    assert tables["carrier"] == {"outer_diameter": "230 mm", "width": "60 mm"}
    assert tables["ring"]["tip_diameter"] == "229.6 mm"


def test_planetary_results_go_to_meshes_and_bearings(tmp_path):
    file = planetary().write(tmp_path / "gears.rexs")
    rough = {"planet_bearing.roller_roughness": "0.1 um", "planet_bearing.race_roughness": "0.1 um"}
    result = ep.solve(ep.load_case(file, {**COARSE, **rough}))
    out = tmp_path / "out.rexs"
    ep.write_rexs(out, result, file)
    bearing = float(attributes(out, 70)["total_frictional_power_loss"])
    losses = result.losses
    assert 3 * bearing == pytest.approx(
        losses["planet_bearing_mechanical"] + losses["planet_bearing_viscous"]
    )
    torque = float(attributes(out, 70)["total_frictional_torque"])
    assert torque * result.bearing.speed == pytest.approx(bearing)
    meshes = sum(float(attributes(out, n)["custom_epicyclic_power_loss"]) for n in (50, 51, 52))
    assert meshes == pytest.approx(sum(v for k, v in losses.items() if k.startswith("sun_mesh_")))
    assert "custom_epicyclic_carrier_drag" not in attributes(out, STAGE)  # left out: no carrier
