"""Commented case files, written from the schema and the values of a case."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from datetime import date, time
from pathlib import Path
from typing import Any

from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from epicyclic import library
from epicyclic.case.case import KINDS, TrainCase, read_case
from epicyclic.case.gear_tables import SharedGears
from epicyclic.case.tables.elements import ElementTables
from epicyclic.case.tables.uncertainty import DistributionTable
from epicyclic.case.train_tables import ListedSet, PlanetarySet, form_of_set
from epicyclic.messages import key_parts
from epicyclic.schema.fields import choices_of, dict_value, entry_of, quantity_of, table_of

_EXAMPLES = {"planetary": "talbot-2012", "gear_pair": "talbot-2012-pair"}
_TRAIN = "train-eaxle"
_TRAIN_HEAD = f"""\
# A case file of epicyclic, kind train, filled in with the built-in case {_TRAIN}.
# Every dimensional value carries its unit. The tables of a set are those of a case of kind
# planetary or gear_pair: 'epicyclic init --kind planetary' writes all their keys. A set with teeth
# and efficiency = 0.99 only has that given loss in place of computed ones.
"""
_TRAIN_STATES = """
# A gearbox with brakes and clutches has states; operation.state = "1" chooses the one that runs:
# [states.1]
# fixed = ["ring"]                     # shafts that brakes hold
# joined = [["motor", "middle"]]       # shafts that clutches join

# Drag of a clutch, a pump or another part, from a table:
# [drags.pump]
# between = ["motor", "housing"]
# speed = ["0 rpm", "5000 rpm", "10000 rpm"]
# torque = ["0.1 N*m", "0.15 N*m", "0.2 N*m"]

# [lubrication]                        # of all sets; a set may have its own
# method = "jet"                       # instead of surroundings.oil_air_ratio
# oil_flow = "2 l/min"

# [housing]                            # with method = "dip": one level of oil for all sets
# oil_level = "-60 mm"                 # above the axis of the input shaft

# [models]                             # of all sets; a set may have its own, [sets.pair.models]
# friction = "schlenk"                 # 'epicyclic friction CASE' compares them
"""
COMMENT_COLUMN = 44
_SPELT_OUT = ("micro_geometry", "micro_geometry_ring_side", "topography", "oil", "housing")
"""Tables within a table whose keys are listed."""


def case_template(kind: str) -> str:
    """A case file of `kind` with every key: given ones with values, defaults commented out.

    That of a train, whose sets have the keys of the other kinds, is a built-in one.
    """
    if kind == "train":
        _, mark, tables = library.case_source(_TRAIN).partition('kind = "train"')
        return f"{_TRAIN_HEAD}{mark}{tables}{_TRAIN_STATES}"
    name = _EXAMPLES[kind]
    head = [
        f"A case file of epicyclic, kind {kind}: {name} with the default models.",
        "Every dimensional value carries its unit. Commented-out keys have defaults.",
    ]
    # a case of one's own starts from the default models
    example = {key: table for key, table in library.builtin_case(name).items() if key != "models"}
    if kind == "gear_pair":  # that case is one without load
        example["operation"] = {**example["operation"], "torque": "60 N*m"}
    return case_text(example, head)


def text_like(name: str) -> str:
    """A commented case file with the values of a case, a built-in one or a file.

    That of a train is its own file. Raises `InputError` if there is no such case, or it is not
    sound.
    """
    case = read_case(name)
    if isinstance(case, TrainCase):
        if name in library.names("cases"):
            return library.case_source(name)
        return Path(name).read_text(encoding="utf-8")
    head = [f"A case file of epicyclic, kind {case.kind}, with the values of {name}."]
    return case_text(case.given(), [*head, "Commented-out keys have defaults."])


def case_text(
    tables: Mapping[str, Any],  # The tables of a case, with its kind; they need not be complete.
    head: list[str],  # Lines of comment at the top.
    # Comments of single keys by their dotted names, in place of the schema's description. With
    # these, tables of which nothing is given or told are only named.
    about: Mapping[str, str] | None = None,
) -> str:
    """A case file: keys of `tables` with values, the others commented out."""
    if tables["kind"] == "train":
        return _train_text(tables, head, about or {})
    fields = KINDS[tables["kind"]].model_fields
    writer = _Writer(tables, about or {})
    keys = [key for key, field in fields.items() if _is_table(field)]
    shown = [key for key in keys if about is None or writer.is_known(key)]
    lines = writer.head(head)
    lines += [line for key in shown for line in writer.table(key, fields[key])]
    left_out = [f"[{key}]" for key in keys if key not in shown]
    if left_out:
        lines += ["", "# Defaults hold for these tables; 'epicyclic init' writes all their keys:"]
        lines.append(f"# {', '.join(left_out)}")
    return "\n".join(lines) + "\n"


class _Writer:
    """Writes the lines of `tables`; `about` has comments of single keys."""

    def __init__(self, tables: Mapping[str, Any], about: Mapping[str, str]) -> None:
        self.tables = tables
        self.about = about

    def head(self, comments: list[str]) -> list[str]:
        """The first lines: comments, kind and title."""
        title = toml_value(self.tables.get("title", ""))
        kind = toml_value(self.tables["kind"])
        return [*(f"# {line}" for line in comments), f"kind = {kind}", f"title = {title}"]

    def is_known(self, key: str) -> bool:
        """True if a table is given, or there is a comment of it or a key of it."""
        return key in self.tables or self.tells_of(key)

    def tells_of(self, key: str) -> bool:
        """True if there is a comment of `key` or of one below it."""
        return any(name == key or name.startswith(f"{key}.") for name in self.about)

    def table(self, key: str, field: FieldInfo, values: Any = None) -> list[str]:
        """The lines of the table at `key`; by default with the values of the case."""
        values = self.tables.get(key, {}) if values is None else values
        table = table_of(field.annotation)
        assert table is not None
        if not isinstance(values, Mapping):
            return ["", f"# [{key}] = {toml_value(values)}"]
        doc = (table.__doc__ or "").strip().splitlines()[0]
        mark = "" if values or field.is_required() else "# "
        # named parts have a table each, values of "uncertainty" stand in one by the name of a key
        parts = dict_value(field.annotation) is not None and table is not DistributionTable
        place = f"{key}.NAME" if parts and not values else key
        lines = ["", f"{mark}[{place}]".ljust(COMMENT_COLUMN) + f"# {self.about.get(key, doc)}"]
        if dict_value(field.annotation) is not None:
            lines += [f"{toml_key(name)} = {toml_value(value)}" for name, value in values.items()]
            if not parts:
                lines += [f'# "NAME" = {{ {name} = ... }}' for name in table.model_fields]
            if place == key:
                return lines
        for name, inner in table.model_fields.items():
            lines += self._field_lines(place, name, inner, values)
        return lines

    def _field_lines(
        self, key: str, name: str, field: FieldInfo, values: Mapping[str, Any], prefix: str = ""
    ) -> list[str]:
        """Lines of one key of table `key`; a table within it appears as dotted keys."""
        subtable = table_of(field.annotation)
        full = f"{prefix}{name}"
        about = self.about.get(f"{key}.{full}", _about(field))
        given = values.get(name)
        spelt_out = (
            name in _SPELT_OUT
            and subtable is not None
            and isinstance(given, Mapping)
            and given.keys() <= subtable.model_fields.keys()  # an oil by its grade has others
        )
        if given is not None and not spelt_out:
            return [_line(f"{full} = {toml_value(given)}", about)]
        if subtable is None or isinstance(field.default, str):
            return [_line(f"# {full} = {_default(field)}", about)]
        if dict_value(field.annotation) is not None:
            keys = ", ".join(f"{it} = {_default(own)}" for it, own in subtable.model_fields.items())
            return [_line(f"# {full} = {{ NAME = {{ {keys} }} }}", about)]
        if key == "losses":
            return [_line(f"# {name} = {{ include = true, factor = 1.0 }}", "")]
        is_short = bool(self.about) and given is None and not self.tells_of(f"{key}.{full}.")
        if (is_short or name not in _SPELT_OUT) and field.default in (None, PydanticUndefined):
            return [_line(f"# {full} = {{ ... }}", about)]
        return [
            line
            for inner, below in subtable.model_fields.items()
            for line in self._field_lines(key, inner, below, given or {}, f"{full}.")
        ]


def _line(text: str, about: str) -> str:
    return f"{text.ljust(COMMENT_COLUMN - 1)} # {about}" if about else text


def _about(field: FieldInfo) -> str:
    quantity = quantity_of(field.annotation, tuple(field.metadata))
    parts = [field.description or "", " | ".join(choices_of(field.annotation))]
    if not field.description and quantity is not None:
        parts.append(quantity.describe())
    return " ".join(part for part in parts if part)


def _default(field: FieldInfo) -> str:
    if field.default is not None and not field.is_required():
        return toml_value(field.default)
    quantity = quantity_of(field.annotation, tuple(field.metadata))
    return _nested(field.annotation, f'"... {quantity.display}"' if quantity is not None else "...")


def _nested(annotation: Any, value: str) -> str:
    """`value` as the entry of an array, or of an array of arrays, if the key holds one."""
    entry = entry_of(annotation)
    return value if entry is None else f"[{_nested(entry, value)}, ...]"


def toml_key(name: str) -> str:
    """A key as TOML writes it, in quotes if it needs them."""
    bare = name.isascii() and name.replace("-", "").replace("_", "").isalnum()
    return name if bare else json.dumps(name, ensure_ascii=False)


def toml_keys(names: Sequence[str]) -> str:
    """A key within tables, whole: where a message would show a part of a name, it is another."""
    return ".".join(map(toml_key, names))


def toml_value(value: Any) -> str:
    """`value` as TOML writes it on one line; text, numbers and booleans are those of JSON."""
    if isinstance(value, Mapping):
        entries = [f"{toml_key(key)} = {toml_value(item)}" for key, item in value.items()]
        return f"{{ {', '.join(entries)} }}" if entries else "{}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, date | time):
        return value.isoformat()
    return json.dumps(value, ensure_ascii=False)


_LISTS = {
    "shafts": "members that always turn together; members not named turn alone",
    "positions": "positions of gears along their shafts, for the forces on bearings",
}
_DEFAULTS = (
    "lubrication",
    "housing",
    "surroundings",
    "thermal",
    "friction_table",
    "models",
    "contact_solver",
    "numerics",
    "uncertainty",
)


def _train_text(tables: Mapping[str, Any], head: list[str], about: Mapping[str, str]) -> str:
    """The file of a train; keys of bearings and the like that nothing is said of are left out."""
    writer = _TrainWriter(tables, about)
    fields = TrainCase.model_fields
    lines = [*writer.head(head), *writer.table("operation", fields["operation"])]
    lines += [*writer.entries("shafts"), *writer.parts("states"), *writer.entries("positions")]
    known = [key for key in _DEFAULTS if writer.is_known(key)]
    lines += [line for key in ("lubricant", *known) for line in writer.table(key, fields[key])]
    lines += [line for name in tables.get("sets", {}) for line in writer.one_set(name)]
    lines += [line for kind in ElementTables.model_fields for line in writer.parts(kind)]
    left_out = ", ".join(f"[{key}]" for key in _DEFAULTS if key not in known)
    lines += ["", f"# Defaults hold for the tables {left_out},"]
    lines.append(
        "# and for those of the sets that are not here: mesh, models, numerics, losses, ..."
    )
    return "\n".join(lines) + "\n"


class _TrainWriter(_Writer):
    """Writes the tables of a train."""

    def entries(self, key: str) -> list[str]:
        """A table of the user's names, one line each."""
        lines = ["", f"[{key}]".ljust(COMMENT_COLUMN) + f"# {self.about.get(key, _LISTS[key])}"]
        return [*lines, *self._keys(key, self.tables.get(key, {}))]

    def one_set(self, name: str) -> list[str]:
        """The tables of a set."""
        place = toml_keys(["sets", name])
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
            if key in values or self.tells_of(full):
                lines += self.table(full, field, values.get(key, {}))
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
            for line in self.table(f"{place}.{toml_keys([name])}", one, gear)
        ]

    def parts(self, kind: str) -> Iterator[str]:
        """States, bearings and the like."""
        given = self.tables.get(kind, {})
        for name in dict.fromkeys([*given, *self._told(kind)]):
            key = toml_keys([kind, name])
            mark = "" if name in given else "# "
            yield ""
            yield self._line(f"{mark}[{key}]", key)
            yield from self._keys(key, given.get(name, {}))

    def _keys(self, place: str, given: Mapping[str, Any]) -> Iterator[str]:
        """The keys of a table that are given, then those of which something is told."""
        for name, value in given.items():
            key = toml_key(name)
            yield self._line(f"{key} = {toml_value(value)}", f"{place}.{key}")
        for key in (toml_key(name) for name in self._told(place) if name not in given):
            yield self._line(f"# {key} = ...", f"{place}.{key}")

    def _told(self, place: str) -> Iterator[str]:
        """Names below a table of which something is told, each once."""
        start = len(key_parts(place))
        known = [key_parts(key) for key in self.about if key.startswith(f"{place}.")]
        return iter(dict.fromkeys(parts[start] for parts in known))

    def _line(self, text: str, key: str) -> str:
        return _line(text, self.about.get(key, ""))


def _is_table(field: FieldInfo) -> bool:
    return table_of(field.annotation) is not None
