"""Commented case files of trains, as far as the tables are known."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from pydantic.fields import FieldInfo

from epicyclic.case.element_kinds import ELEMENT_KINDS
from epicyclic.case.fields import dict_value, table_of
from epicyclic.case.gear_tables import SharedGears
from epicyclic.case.template import COMMENT_COLUMN, TableWriter, toml_key, toml_value
from epicyclic.case.train import TrainCase, form_of_set
from epicyclic.case.train_tables import ListedSet, PlanetarySet
from epicyclic.case.wording import dotted, key_parts

_LISTS = {
    "shafts": "what turns together, always; members not named turn alone",
    "positions": "of gears along their shafts, for the forces on bearings",
}
_DEFAULTS = (
    "lubrication",
    "surroundings",
    "thermal",
    "friction_table",
    "models",
    "contact_solver",
    "numerics",
    "uncertainty",
)


def train_text(tables: Mapping[str, Any], head: list[str], about: Mapping[str, str]) -> str:
    """The file of a train; parameters as of `epicyclic.case.template.case_text`.

    Keys of bearings and the like that are neither given nor told are left out.
    """
    writer = _TrainWriter(tables, about)
    lines = [*(f"# {line}" for line in head), 'kind = "train"']
    lines.append(f"title = {toml_value(tables.get('title', ''))}")
    lines += writer.table("operation")
    lines += writer.entries("shafts")
    lines += writer.states()
    lines += writer.entries("positions")
    lines += writer.table("lubricant")
    lines += [line for key in _DEFAULTS if writer.is_known(key) for line in writer.table(key)]
    lines += [line for name in tables.get("sets", {}) for line in writer.one_set(name)]
    lines += [line for kind in ELEMENT_KINDS for line in writer.parts(kind)]
    left_out = [f"[{key}]" for key in _DEFAULTS if not writer.is_known(key)]
    lines += ["", f"# Defaults hold for the tables {', '.join(left_out)},", f"# {writer.left_out}"]
    return "\n".join(lines) + "\n"


class _TrainWriter:
    """Writes the tables of a train."""

    left_out = "and for those of the sets that are not here: mesh, models, numerics, losses, ..."

    def __init__(self, tables: Mapping[str, Any], about: Mapping[str, str]) -> None:
        self.tables = tables
        self.about = about
        self.writer = TableWriter(about)

    def is_known(self, key: str) -> bool:
        """True if a table is given, or there is a comment of it or a key of it."""
        return key in self.tables or self.writer.tells_of(key)

    def table(self, key: str) -> list[str]:
        """A table of the train that is not of the user's names."""
        field = TrainCase.model_fields[key]
        return self._table(key, field, self.tables.get(key, {}))

    def _table(self, key: str, field: FieldInfo, values: Any) -> list[str]:
        table = table_of(field.annotation)
        assert table is not None
        if not isinstance(values, Mapping):
            return ["", f"# [{key}] = {toml_value(values)}"]
        return self.writer.table_lines(key, table, values, field)

    def entries(self, key: str) -> list[str]:
        """A table of the user's names, one line each."""
        lines = ["", f"[{key}]".ljust(COMMENT_COLUMN) + f"# {self.about.get(key, _LISTS[key])}"]
        for name, value in self.tables.get(key, {}).items():
            lines.append(self._line(f"{toml_key(name)} = {toml_value(value)}", dotted([key, name])))
        for name in self._told(key):
            if name not in self.tables.get(key, {}):
                lines.append(self._line(f"# {toml_key(name)} = ...", dotted([key, name])))
        return lines

    def states(self) -> list[str]:
        """What brakes and clutches do, state by state."""
        lines = []
        for name, state in self.tables.get("states", {}).items():
            key = dotted(["states", name])
            lines += ["", self._line(f"[{key}]", key)]
            lines += [f"{toml_key(inner)} = {toml_value(value)}" for inner, value in state.items()]
        return lines

    def one_set(self, name: str) -> list[str]:
        """The tables of a set."""
        place = dotted(["sets", name])
        values = self.tables["sets"][name]
        form = form_of_set(values)[0] or PlanetarySet
        fields = {key: field for key, field in form.model_fields.items() if _is_table(field)}
        of_gears = fields.pop("members", None)
        if of_gears is not None:  # in a file they stand below what all gears share
            fields["gears"] = ListedSet.model_fields["gears"]
        lines = ["", f"[{place}]"]
        for key, value in values.items():
            if key not in fields:
                lines.append(self._line(f"{toml_key(key)} = {toml_value(value)}", f"{place}.{key}"))
        for key, field in fields.items():
            full = f"{place}.{key}"
            if key in values or self.writer.tells_of(full):
                lines += self._table(full, field, values.get(key, {}))
                if key == "gears" and of_gears is not None:
                    lines += self._listed_gears(full, of_gears, values["gears"])
        return lines

    def _listed_gears(self, place: str, field: FieldInfo, gears: Mapping[str, Any]) -> list[str]:
        """A table of each gear of a listed set."""
        one = FieldInfo.from_annotation(dict_value(field.annotation))
        return [
            line
            for name, gear in gears.items()
            if name not in SharedGears.model_fields
            for line in self._table(f"{place}.{dotted([name])}", one, gear)
        ]

    def parts(self, kind: str) -> Iterator[str]:
        """Bearings and the like."""
        given = self.tables.get(kind, {})
        for name in dict.fromkeys([*given, *self._told(kind)]):
            key = dotted([kind, name])
            mark = "" if name in given else "# "
            yield ""
            yield self._line(f"{mark}[{key}]", key)
            for inner, value in given.get(name, {}).items():
                text = f"{toml_key(inner)} = {toml_value(value)}"
                yield self._line(text, f"{key}.{inner}")
            for inner in self._told(key):
                if inner not in given.get(name, {}):
                    yield self._line(f"# {toml_key(inner)} = ...", f"{key}.{inner}")

    def _told(self, place: str) -> Iterator[str]:
        """Names below a table of which something is told, each once."""
        start = len(key_parts(place))
        known = [key_parts(key) for key in self.about if key.startswith(f"{place}.")]
        return iter(dict.fromkeys(parts[start] for parts in known))

    def _line(self, text: str, key: str) -> str:
        told = self.about.get(key)
        return f"{text.ljust(COMMENT_COLUMN - 1)} # {told}" if told else text


def _is_table(field: FieldInfo) -> bool:
    return table_of(field.annotation) is not None
