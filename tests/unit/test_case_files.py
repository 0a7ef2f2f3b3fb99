"""Files and names of cases: any editor's file is read, a line that is not TOML is explained."""

from __future__ import annotations

import os
import stat
import threading
from pathlib import Path

import pytest

import epicyclic as ep
from epicyclic.case.case import GearPairCase, PlanetaryCase, read_case
from epicyclic.errors import InputError
from epicyclic.library import builtin_case
from problems import only, problems_of

FOLDER = Path(ep.__file__).with_name("library") / "cases"
TALBOT = (FOLDER / "talbot-2012.toml").read_text(encoding="utf-8")
PAIR = (FOLDER / "talbot-2012-pair.toml").read_text(encoding="utf-8")


@pytest.fixture
def write(tmp_path):
    """Writes a case file and returns its path."""

    def write(content, name="case.toml"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def test_files_names_and_tables_make_the_same_case(write):
    by_name = read_case("talbot-2012")
    by_file = read_case(write(TALBOT))
    by_text = read_case(str(write(TALBOT)))
    by_tables = read_case(builtin_case("talbot-2012"))
    assert by_name == by_file == by_text == by_tables
    assert isinstance(by_name, PlanetaryCase)
    assert isinstance(read_case("talbot-2012-pair"), GearPairCase)


def test_a_case_knows_where_it_came_from(write):
    path = write(TALBOT)
    assert read_case(path).source == str(path)
    assert read_case("talbot-2012-n6").source == "talbot-2012-n6"
    assert read_case(builtin_case("talbot-2012")).source == "the given tables"


@pytest.mark.parametrize("change", ["\ufeff{}", "{}\r\n", "# only a comment first\n{}", "{}"])
def test_files_of_every_editor_are_read(write, change):
    text = change.format(TALBOT)
    if "\r" in change:
        text = text.replace("\n", "\r\n").replace("\r\r", "\r")
    assert read_case(write(text)) == read_case("talbot-2012")


def test_a_file_needs_no_suffix_and_goes_before_a_built_in_case(write, monkeypatch):
    path = write(PAIR, "talbot-2012")
    monkeypatch.chdir(path.parent)
    assert read_case("talbot-2012").kind == "gear_pair"
    path.unlink()
    path.mkdir()
    assert read_case("talbot-2012").kind == "planetary"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("talbot", "Did you mean 'talbot-2012' or 'talbot-2012-pair'?"),
        ("talbot-2012-n7", "n3 or n4 or n5 or n6"),
        ("xyz", "'epicyclic cases'"),
        ("a\0b", "epicyclic cases"),
        ("x" * 5000, "epicyclic cases"),
        (None, "Give one of these."),
        (5, "Give one of these."),
        (b"talbot-2012", "Give one of these."),
    ],
)
def test_names_of_nothing(name, words):
    problem = only(problems_of(read_case, name))
    assert problem.key == "CASE"
    assert problem.value
    assert words in problem.remedy


@pytest.mark.parametrize("name", ["missing.toml", "no/such/case.toml", "no/such/case", "a\0b.toml"])
def test_missing_files(name):
    assert "cannot be read" in only(problems_of(read_case, name)).allowed


def test_folders_pipes_and_devices_are_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe.toml")
    assert "a folder" in only(problems_of(read_case, tmp_path)).allowed
    assert "a folder" in only(problems_of(read_case, "")).allowed
    for path in (tmp_path / "pipe.toml", "/dev/zero", "/dev/null"):
        assert "not a regular file" in only(problems_of(read_case, path)).allowed


def test_a_pipe_nobody_writes_to_does_not_block(tmp_path):
    path = tmp_path / "pipe.toml"
    os.mkfifo(path)
    done = threading.Event()

    def read():
        with pytest.raises(InputError):
            read_case(path)
        done.set()

    threading.Thread(target=read, daemon=True).start()
    assert done.wait(10)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_files_without_permission(write):
    path = write(TALBOT)
    path.chmod(stat.S_IWUSR)
    assert "Permission denied" in only(problems_of(read_case, path)).allowed


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "is empty"),
        (b"# nothing\n\n", "is empty"),
        (b"\xef\xbb\xbf", "is empty"),
        (b"\x7fELF\x00\x01", "is not text"),
        ("kind = 'planetary'".encode("utf-16"), "is not text"),
        (TALBOT.replace("Talbot", "T\u00e4lbot").encode("latin-1"), "byte 0xe4 in line"),
        (b"a" * 1_000_001, "too large"),
        (b"x = " + b"[" * 100_000, "nested"),
        (b"x = " + b"[" * 100 + b"]" * 100, "nested"),
        (b".".join([b"a"] * 100_000) + b" = 1", "nested"),
        (b"x = [" + b"1," * 100_000 + b"]", "too many"),
        (b"teeth = " + b"9" * 5000, "5000 digits"),
        (b"[sun\nteeth = 3", "is not TOML"),
        (b"[sun]\nteeth = 3\n[sun]\nteeth = 4", "declares a table twice (line 3)"),
        (b"just some words", "is not TOML"),
        (b"\x1b[31m", "is not TOML"),
        (b"<html></html>", "is not TOML"),
        (b"PK\x03\x04\x05", "is not TOML"),
    ],
    ids=lambda value: repr(value)[:24],
)
def test_files_that_are_no_case(write, content, words):
    path = write(content)
    assert words in only(problems_of(read_case, path)).allowed
    with pytest.raises(InputError) as caught:
        read_case(path)
    assert all(line.isprintable() for line in str(caught.value).splitlines())
    assert caught.value.source.endswith("case.toml")


@pytest.mark.parametrize(("ending", "text"), [("csv", "speed,torque\n1,2\n"), ("json", "{}")])
def test_a_table_or_result_in_place_of_a_case_is_told_by_its_ending(tmp_path, ending, text):
    path = tmp_path / f"loss.{ending}"
    path.write_text(text)
    problem = only(problems_of(read_case, path))
    assert problem.allowed == f"the file ends with .{ending} and holds no case."


def test_a_line_that_is_not_toml_is_shown(write):
    problem = only(problems_of(read_case, write(TALBOT.replace("[sun]", "[sun"))))
    assert problem.value.startswith("line ")
    assert problem.value.endswith(": [sun")
    assert problem.remedy == "Correct this line."


@pytest.mark.parametrize(
    ("line", "remedy"),
    [
        ("torque = 1000 N*m", 'Put the value in quotes: torque = "1000 N*m".'),
        ("torque = 1000 N*m   # on the sun", 'Put the value in quotes: torque = "1000 N*m".'),
        ("torque = “1000 N*m”", 'Put the value in quotes: torque = "1000 N*m".'),
        ('torque = "1000 N*m', 'Put the value in quotes: torque = "1000 N*m".'),
        ("torque =", "Give a value."),
    ],
)
def test_missing_quotes_are_mended_and_told(write, line, remedy):
    text = TALBOT.replace('torque = "1000 N*m"', line, 1)
    problem = only(problems_of(read_case, write(text)))
    assert problem.key == "operation.torque"
    number = 1 + next(i for i, row in enumerate(text.splitlines()) if row.startswith("torque"))
    assert f"is not TOML (line {number})" in problem.allowed
    assert problem.remedy == remedy


def test_missing_quotes_in_an_array_of_tables_are_mended_and_told(write):
    array = "[[lubricant.oil.density]]\ntemperature = '40 degC'\nvalue = 871 kg/m^3\n"
    text = TALBOT.replace('oil = "atf-talbot-2012"', "", 1) + "\n" + array
    found = problems_of(read_case, write(text))
    (problem,) = (it for it in found if "is not TOML" in it.allowed)
    assert problem.key == "lubricant.oil.density[0].value"
    assert problem.remedy == 'Put the value in quotes: value = "871 kg/m^3".'
    assert not any("\ue000" in str(it) for it in found)


@pytest.mark.parametrize(
    ("line", "remedy"),
    [
        ("oil_air_ratio = 0,05", "Write 0.05."),
        ("oil_air_ratio = .05", "Write 0.05."),
        ("oil_air_ratio = True", "Write true."),
    ],
)
def test_numbers_that_are_not_toml(write, line, remedy):
    text = TALBOT.replace("oil_air_ratio = 0.05", line, 1)
    problem = only(problems_of(read_case, write(text)))
    assert problem.key == "surroundings.oil_air_ratio"
    assert problem.remedy == remedy


def test_a_line_that_quotes_do_not_mend_is_told_once(write):
    text = TALBOT.replace("face_width", '"face_width', 1)
    problem = only(problems_of(read_case, write(text)))
    assert '"face_width = "30.9 mm"' in problem.value


def test_a_table_that_a_dotted_key_has_made_already_is_explained(write):
    text = b"[sun]\nmicro_geometry.tip_relief = '5 um'\n[sun.micro_geometry]"
    problem = only(problems_of(read_case, write(text)))
    assert problem.allowed == "declares a table twice (line 3)."
    assert "a dotted key, such as micro_geometry.tip_relief" in problem.remedy


def test_a_key_given_twice_is_told(write):
    text = TALBOT.replace("count = 3", "count = 3\ncount = 4")
    problem = only(problems_of(read_case, write(text)))
    assert "count = 4" in problem.value
    assert "a second time" in problem.allowed


def test_bad_lines_do_not_hide_each_other_nor_the_rest(write):
    text = TALBOT.replace('"1000 N*m"', "1000 N*m").replace('"4000 rpm"', "4000 rpm")
    text = text.replace("teeth = 73", "teeth = 3").replace("[carrier]", "[carriar]")
    problems = problems_of(read_case, write(text))
    assert [problem.key for problem in problems] == [
        "operation.torque",
        "operation.speed",
        "sun.teeth",
        "carriar",
    ]


def test_too_many_bad_lines_are_no_case(write):
    problems = problems_of(read_case, write("\n".join(f"a{i} = b c" for i in range(1000))))
    assert len(problems) < 100
