"""Whatever is done to a case, it stays a case or becomes a list of problems to act on."""

from __future__ import annotations

import datetime
import re
import time
from functools import partial
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import epicyclic
from epicyclic.case.case import read_case
from epicyclic.errors import InputError
from epicyclic.messages import value_at
from epicyclic.schema.read import changed_at, plain
from limits import is_soon

EXAMPLES = 60
SLOWEST = 1.0  # s of processor time: others may use the machine too
INTERNAL = re.compile(
    r"pydantic|Traceback|Input should|\b(NoneType|None|tuple|dict|instance|str|int)\b"
)

property_test = settings(
    derandomize=True,
    deadline=None,
    max_examples=EXAMPLES,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


def paths_of(tables, path=()):
    """Every table, array and value below `tables`."""
    for key, value in tables.items() if isinstance(tables, dict) else enumerate(tables):
        yield (*path, key)
        if isinstance(value, dict | list | tuple):
            yield from paths_of(value, (*path, key))


def full_case(name):
    """The tables of a built-in case with the tables that it leaves out."""
    tables = read_case(name).inputs()
    tables["friction_table"] = {
        "film_ratio": [0.1, 1.0],
        "hertz_pressure": ["0.5 GPa", "1 GPa"],
        "friction": [[0.1, 0.09], [0.05, 0.04]],
    }
    if tables["kind"] == "planetary":
        tables["planet"]["angles"] = [f"{turn} deg" for turn in (0, 120, 240)]
        tables["thrust_bearing"] = {"mean_diameter": "60 mm"}
    return tables


CASES = {name: full_case(name) for name in ("talbot-2012", "talbot-2012-pair")}
PATHS = {name: list(paths_of(tables)) for name, tables in CASES.items()}

text = st.text(max_size=12)
numbers = st.one_of(
    st.integers(),
    st.integers(-3, 300),
    st.floats(),
    st.sampled_from([-0.0, 10**400, -(10**30), 2**63, 1e308, 5e-324]),
)
units = st.sampled_from(
    ["mm", "m", "um", "µm", "N*m", "Nm", "rpm", "Hz", "1/min", "rad/s", "deg", "rad", "degC", "K",
     "°C", "delta_degC", "GPa", "bar", "mm^2/s", "cSt", "kg/m^3", "1/GPa", "kg", "%", "parsec",
     "mm**99999999", "**9**9 mm", "(m", "m)", "1", "/", "lightyear", "m^-9", "mm mm mm"]
)  # fmt: skip
quantities = st.builds(
    lambda number, space, unit: f"{number}{space}{unit}",
    st.one_of(st.floats(), st.integers(-10, 1000)),
    st.sampled_from(["", " "]),
    units,
)
names = st.sampled_from(
    ["sun", "ring", "steel", "shaved", "iso-vg-100-pao", "planetary", "gear_pair", "table", "auto",
     "mixed-ehl", "caged", "full-complement", "gold", "roelands", "true", "73", "0.05", "5 %"]
)  # fmt: skip
scalars = st.one_of(
    numbers, text, quantities, names, st.booleans(), st.none(), st.binary(max_size=3),
    st.just(datetime.date(2024, 2, 29)), st.just(1j), st.just(object()),
)  # fmt: skip
junk = st.recursive(
    scalars,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(st.one_of(text, names, st.integers()), inner, max_size=4),
    ),
    max_leaves=8,
)


def outcome(action):
    """What `action` raises; None if it ends well. It may not take long."""
    start = time.thread_time()
    try:
        action()
        found = None
    except InputError as error:
        found = error
    assert is_soon(time.thread_time() - start, SLOWEST)
    return found


def check_problems(error):
    """Each problem says where, what is allowed and what to do, in one line of plain words."""
    assert error.problems
    for problem in error.problems:
        assert problem.key
        assert problem.allowed.endswith(".")
        assert problem.remedy.endswith((".", "?")), problem
        line = str(problem)
        assert "\n" not in line
        assert line.isprintable()
        assert len(line) < 700
        assert not INTERNAL.search(problem.allowed + problem.remedy), line


@st.composite
def mutations(draw):
    """Name of a built-in case, and keys with their new values; None removes a key."""
    name = draw(st.sampled_from(list(CASES)))
    key = st.sampled_from(PATHS[name])
    changes = []
    for _ in range(draw(st.integers(1, 3))):
        path = draw(key)
        if isinstance(path[-1], str) and draw(st.booleans()):
            path = (*path[:-1], draw(st.one_of(text, names)))
        changes.append((path, draw(junk)))
    return name, changes


def extended(more, table):
    return table | more


def replaced(new, _old):
    return new


def mutated(name, changes):
    """The tables of a case after those changes that are still possible after the ones before."""
    tables = plain(CASES[name])
    for path, value in changes:
        owner = value_at(tables, path[:-1])
        if isinstance(owner, dict):
            tables = changed_at(tables, path[:-1], partial(extended, {path[-1]: value}))
        elif isinstance(owner, tuple) and path[-1] < len(owner):
            tables = changed_at(tables, path, partial(replaced, value))
    return tables


@pytest.mark.slow
@property_test
@given(mutations())
def test_a_mutated_case_is_a_case_or_a_list_of_problems(mutation):
    tables = mutated(*mutation)
    error = outcome(lambda: read_case(tables))
    if error is not None:
        check_problems(error)


@property_test
@given(st.dictionaries(st.one_of(text, names), junk, max_size=5))
def test_any_mapping_is_a_case_or_a_list_of_problems(tables):
    error = outcome(lambda: read_case(tables))
    assert error is not None
    check_problems(error)


LENGTHS = {
    "gears": ("center_distance", "normal_module", "transverse_module"),
    "sun": ("tip_diameter", "root_diameter", "tooth_thickness", "thickness_diameter"),
    "planet_bearing": ("roller_diameter", "pin_diameter", "diametral_clearance"),
}
LENGTHS |= dict.fromkeys(("planet", "ring", "pinion", "gear"), LENGTHS["sun"])


@st.composite
def geometries(draw):
    """A built-in case with other tooth numbers, lengths and angles, in or out of all reason."""
    name = draw(st.sampled_from(list(CASES)))
    tables = plain(read_case(name).inputs())
    for table in tables.keys() & LENGTHS.keys():
        owner = tables[table]
        for key in owner.keys() & set(LENGTHS[table]):
            if draw(st.booleans()):
                factor = draw(st.one_of(st.floats(0.9, 1.1), st.floats(1e-3, 20)))
                number, unit = owner[key].split()
                owner[key] = f"{float(number) * factor} {unit}"
        if "teeth" in owner:
            if draw(st.booleans()):
                owner["teeth"] = draw(st.one_of(st.integers(5, 40), st.integers(5, 2000)))
            if draw(st.booleans()):
                owner["profile_shift_coefficient"] = draw(st.floats(-3, 5))
                del owner["tooth_thickness"], owner["thickness_diameter"]
            for key in draw(st.sets(st.sampled_from(["tip_diameter", "root_diameter"]))):
                owner.pop(key, None)
            if draw(st.booleans()):
                owner["tool_tip_radius"] = f"{draw(st.floats(0, 5))} mm"
    gears = tables["gears"]
    gears["helix_angle"] = f"{draw(st.floats(0, 45))} deg"
    gears["addendum_coefficient"] = draw(st.floats(0.01, 3))
    gears["dedendum_coefficient"] = draw(st.floats(0.01, 4))
    if "planet" in tables:
        tables["planet"]["count"] = draw(st.integers(1, 24))
        if draw(st.booleans()):
            angles = draw(st.lists(st.floats(-360, 360), max_size=5))
            tables["planet"]["angles"] = tuple(f"{angle} deg" for angle in angles)
    elif draw(st.booleans()):
        tables["gear"]["internal"] = True
    return tables


@pytest.mark.slow
@property_test
@given(geometries())
def test_any_geometry_is_a_case_or_a_list_of_problems(tables):
    error = outcome(lambda: read_case(tables))
    if error is not None:
        check_problems(error)


FILES = [
    path.read_text(encoding="utf-8")
    for path in sorted((Path(epicyclic.__file__).parent / "library" / "cases").glob("*.toml"))
]
PIECES = [
    "=", '"', "'", "[", "]", "[[", "{", "}", ",", ".", "#", "\n", "\r", "\0", "\\", "\ufeff", " ",
    "1e", "0x", "nan", '"""', "teeth = 5\n", "[sun]\n", "\u2028", "\x1b", "a.b.c = 1\n",
]  # fmt: skip


@st.composite
def files(draw):
    """A case file with some stretches cut out, doubled or replaced."""
    content = draw(st.sampled_from(FILES))
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(content)))
        stop = draw(st.one_of(st.just(start), st.integers(start, min(len(content), start + 60))))
        new = draw(st.one_of(st.sampled_from(PIECES), text, st.just(2 * content[start:stop])))
        content = content[:start] + new + content[stop:]
    return content.encode("utf-8", errors="surrogatepass")


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return tmp_path_factory.mktemp("case") / "case.toml"


@property_test
@given(content=st.one_of(files(), st.binary(max_size=200)))
def test_any_file_is_a_case_or_a_list_of_problems(file, content):
    file.write_bytes(content)
    error = outcome(lambda: read_case(file))
    if error is not None:
        assert error.problems
        for problem in error.problems:
            assert problem.allowed.endswith(".")
            assert problem.remedy.endswith((".", "?"))
            assert str(problem).isprintable()
