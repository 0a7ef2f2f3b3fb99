"""Whatever a REXS file says, it becomes a case file that can be read, or a clear error."""

from __future__ import annotations

import tomllib

from hypothesis import given, settings
from hypothesis import strategies as st

import epicyclic as ep
from rexs_files import eaxle, pair, planetary, wind

VALUES = st.sampled_from(
    [0, -1, 1e308, 1e-300, "NaN", "", "abc", True, -60, 10**30, [1.0], [], ["x"], None]
) | st.text(max_size=8)
UNITS = st.sampled_from(["mm", "none", "", "kg", "C", "°", "furlong", "N m"])


@settings(max_examples=25)
@given(st.data())
def test_changed_files_are_read_or_refused(tmp_path_factory, data):
    parts = data.draw(st.sampled_from([planetary, pair, eaxle, wind]))()
    for _ in range(data.draw(st.integers(1, 4))):
        number = data.draw(st.sampled_from(sorted(parts.components)))
        component = parts.components[number]
        change = data.draw(st.sampled_from(["value", "type", "name", "drop", "relation"]))
        if change == "value" and component["attributes"]:
            name = data.draw(st.sampled_from(sorted(component["attributes"])))
            component["attributes"][name] = (data.draw(VALUES), data.draw(UNITS))
        elif change == "type":
            types = sorted({item["type"] for item in parts.components.values()})
            component["type"] = data.draw(st.sampled_from(types))
        elif change == "name":
            component["name"] = data.draw(st.text(max_size=8))
        elif change == "drop":
            parts.relations = [item for item in parts.relations if number not in item[1].values()]
        elif parts.relations:
            parts.relations.pop(data.draw(st.integers(0, len(parts.relations) - 1)))
    file = tmp_path_factory.mktemp("rexs") / "gears.rexsj"
    file.write_text(parts.json(), encoding="utf-8")
    problems = None
    try:
        found = ep.read_rexs(file)
        assert tomllib.loads(found.text())["kind"] == found.kind
        found.geometry_notes(found.case())
    except ep.InputError as error:
        problems = error.problems
    assert problems is None or problems
