"""REXS as JSON; all that is not understood stays as it is."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from pydantic_core import from_json

from epicyclic.case.wording import one_line
from epicyclic.exchange.rexs.content import RawComponent, RawRelation
from epicyclic.exchange.rexs.model import Attribute, Coded, Component, Relation, refuse


class JsonContent:
    """A file in JSON, as its objects."""

    def __init__(self, data: dict[str, Any]) -> None:
        self.data = data
        self.model = data["model"]
        self._by_id: dict[str, dict[str, Any]] | None = None

    @classmethod
    def parse(cls, content: bytes) -> JsonContent:
        """Read a file."""
        try:
            data = from_json(content.decode("utf-8-sig"), allow_inf_nan=False)
        except UnicodeDecodeError:
            raise refuse("is not UTF-8 text.", "Save it as UTF-8 text.") from None
        except ValueError as error:
            message = one_line(str(error), 200)
            raise refuse(f"is not sound JSON: {message}.", "Export it again.") from None
        if not isinstance(data, dict) or not isinstance(data.get("model"), dict):
            raise refuse('is not REXS: it has no object "model".', "Name a REXS file.")
        return cls(data)

    @classmethod
    def empty(cls, head: dict[str, str]) -> JsonContent:
        """A file without parts; `head` are the attributes of the model."""
        return cls({"model": {**head, "relations": [], "components": []}})

    def version(self) -> str:
        return str(self.model.get("version", ""))

    def components(self) -> Iterator[RawComponent]:
        return map(_component, _objects(self.model, "components"))

    def relations(self) -> Iterator[RawRelation]:
        for item in _objects(self.model, "relations"):
            refs = tuple((_text(ref, "role"), ref.get("id")) for ref in _objects(item, "refs"))
            yield RawRelation(item.get("id"), _text(item, "type"), item.get("order"), refs)

    def load_cases(self) -> Iterator[tuple[Any, Iterator[RawComponent]]]:
        spectra = self.model.get("load_spectrum")
        holder = {"": spectra if isinstance(spectra, list) else [spectra] if spectra else []}
        for spectrum in _objects(holder, ""):
            for item in _objects(spectrum, "load_cases"):
                yield item.get("id"), map(_component, _objects(item, "components"))

    def set_attribute(self, component: int, attribute: Attribute) -> None:
        if self._by_id is None:
            items = _objects(self.model, "components")
            self._by_id = {str(item.get("id")).strip(): item for item in items}
        attributes = self._by_id[str(component)].setdefault("attributes", [])
        for place, item in enumerate(attributes):
            if item.get("id") == attribute.id:
                attributes[place] = _written(attribute)
                return
        attributes.append(_written(attribute))

    def add(self, part: Component | Relation) -> None:
        if isinstance(part, Component):
            attributes = [_written(attribute) for attribute in part.attributes.values()]
            item = {"id": part.id, "type": part.type, "name": part.name, "attributes": attributes}
            self.model["components"].append(item)
            return
        order = {} if part.order is None else {"order": part.order}
        refs = [{"id": number, "role": role} for role, number in part.refs]
        self.model["relations"].append({"id": part.id, "type": part.type, **order, "refs": refs})

    def to_bytes(self) -> bytes:
        return (json.dumps(self.data, ensure_ascii=False, indent=2) + "\n").encode()


def _objects(owner: dict[str, Any], name: str) -> list[dict[str, Any]]:
    items = owner.get(name) or []
    if not isinstance(items, list) or not all(isinstance(item, dict) for item in items):
        raise refuse(f'is not REXS: "{name}" is not a list of objects.', "Name a REXS file.")
    return items


def _text(owner: dict[str, Any], name: str) -> str:
    return str(owner.get(name) or "")


def _component(item: dict[str, Any]) -> RawComponent:
    attributes = tuple(map(_attribute, _objects(item, "attributes")))
    return RawComponent(item.get("id"), _text(item, "type"), _text(item, "name"), attributes)


def _attribute(item: dict[str, Any]) -> Attribute:
    """The attribute; its value stands under the name of its type."""
    values = [(name, value) for name, value in item.items() if name not in ("id", "unit")]
    name, value = values[0] if values else ("", None)
    if name.endswith("_array_coded") and isinstance(value, dict):
        value = Coded(_text(value, "code"), _text(value, "value"))
    elif isinstance(value, list):
        is_plain = not any(isinstance(entry, list | dict) for entry in value)
        value = tuple(value) if is_plain else None
    elif isinstance(value, dict):
        value = None
    return Attribute(_text(item, "id"), item.get("unit") and str(item["unit"]), value)


def _written(attribute: Attribute) -> dict[str, Any]:
    value = attribute.value
    first = value[0] if isinstance(value, tuple) else value
    kind = "boolean" if isinstance(first, bool) else "string"
    if kind == "string" and isinstance(first, int | float):
        kind = "integer" if isinstance(first, int) else "floating_point"
    if isinstance(value, tuple):
        kind, value = f"{kind}_array", list(value)
    return {"id": attribute.id, "unit": attribute.unit or "none", kind: value}
