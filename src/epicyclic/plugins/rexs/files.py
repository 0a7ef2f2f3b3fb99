"""REXS files: XML, JSON, or either in a ZIP archive; read with bounds, written whole."""

from __future__ import annotations

import io
import json
import re
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lxml import etree
from pydantic_core import from_json

from epicyclic.dataclass import dataclass
from epicyclic.errors import InputError, problems_in
from epicyclic.files import read_bytes, refuse
from epicyclic.messages import one_line
from epicyclic.plugins.rexs.model import Attribute, Coded, Component, Relation

# REXS as JSON; all that is not understood stays as it is.


class JsonContent:
    """A file in JSON, as its objects. `set_attribute` replaces one with the same id."""

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
            refuse("is not UTF-8 text.", "Save it as UTF-8 text.")
        except ValueError as error:
            message = one_line(str(error), 200)
            refuse(f"is not valid JSON: {message}.", "Export it again.")
        if not isinstance(data, dict) or not isinstance(data.get("model"), dict):
            refuse('is not REXS: it has no object "model".', "Name a REXS file.")
        return cls(data)

    @classmethod
    def empty(cls, head: dict[str, str]) -> JsonContent:
        """A file without parts; `head` are the attributes of the model."""
        return cls({"model": {**head, "relations": [], "components": []}})

    def version(self) -> str:
        return str(self.model.get("version", ""))

    def components(self) -> Iterator[Component]:
        return map(_component, _objects(self.model, "components"))

    def relations(self) -> Iterator[Relation]:
        for item in _objects(self.model, "relations"):
            refs = tuple((_text(ref, "role"), _id(ref)) for ref in _objects(item, "refs"))
            yield Relation(_id(item), _text(item, "type"), refs, item.get("order"))

    def load_cases(self) -> Iterator[tuple[Any, Iterator[Component]]]:
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
            attributes = [_written(attribute) for attribute in part.attributes]
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
        refuse(f'is not REXS: "{name}" is not a list of objects.', "Name a REXS file.")
    return items


def _id(owner: dict[str, Any] | etree._Element) -> Any:
    """An id as the file has it; `build_model` checks it."""
    return owner.get("id")


def _text(owner: dict[str, Any], name: str) -> str:
    return str(owner.get(name) or "")


def _component(item: dict[str, Any]) -> Component:
    attributes = tuple(map(_attribute, _objects(item, "attributes")))
    return Component(_id(item), _text(item, "type"), _text(item, "name"), attributes)


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


# REXS as XML; comments and all that is not understood stay as they are.


_DECLARATION = '<?xml version="1.0" encoding="UTF-8"?>\n'

_BEFORE_ROOT = re.compile(r"\ufeff?(?:\s+|<\?.*?\?>|<!--.*?-->)*", re.DOTALL)
"""Declaration and comments; the library that reads the elements does not keep them as they are."""

_COMPONENTS = "{*}components/{*}component"  # In any namespace, or none.


class XmlContent:
    """A file in XML, as its elements; the same methods as `JsonContent`."""

    def __init__(self, root: etree._Element, before: str = _DECLARATION) -> None:
        self.root = root
        self.before = before
        self._by_id: dict[str, etree._Element] | None = None

    @classmethod
    def parse(cls, data: bytes) -> XmlContent:
        """Read a file, without entities and without what lies elsewhere."""
        parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
        try:
            root = etree.fromstring(data, parser)
        except (etree.XMLSyntaxError, ValueError, LookupError) as error:
            message = one_line(str(error).removesuffix(" (<string>, line 1)"), 200)
            refuse(f"is not valid XML: {message}.", "Export it again.")
        if root.getroottree().docinfo.doctype:
            refuse("has a document type, which REXS does not allow.", "Remove it.")
        if _name(root) != "model":
            refuse("is not REXS: its first element is not model.", "Name a REXS file.")
        encoding = root.getroottree().docinfo.encoding or "UTF-8"
        try:
            before = _BEFORE_ROOT.match(data.decode(encoding, "replace"))
        except (LookupError, ValueError):  # the library knows more encodings than Python
            told = f"is in the encoding {one_line(encoding)}, which is not known here."
            refuse(told, "Save it as UTF-8.")
        return cls(root, before[0] if before else "")

    @classmethod
    def empty(cls, head: dict[str, str]) -> XmlContent:
        """A file without parts; `head` are the attributes of the model."""
        root = etree.Element("model", head)
        for name in ("relations", "components"):
            etree.SubElement(root, name)
        return cls(root)

    def version(self) -> str:
        return str(self.root.get("version", ""))

    def components(self) -> Iterator[Component]:
        return map(_component_xml, self.root.iterfind(_COMPONENTS))

    def relations(self) -> Iterator[Relation]:
        for element in self.root.iterfind("{*}relations/{*}relation"):
            refs = tuple((ref.get("role", ""), _id(ref)) for ref in element.iterfind("{*}ref"))
            order: Any = element.get("order")
            yield Relation(_id(element), element.get("type", ""), refs, order)

    def load_cases(self) -> Iterator[tuple[Any, Iterator[Component]]]:
        for element in self.root.iterfind("{*}load_spectrum/{*}load_case"):
            yield element.get("id"), map(_component_xml, element.iterfind("{*}component"))

    def set_attribute(self, component: int, attribute: Attribute) -> None:
        if self._by_id is None:
            items = self.root.iterfind(_COMPONENTS)
            self._by_id = {item.get("id", "").strip(): item for item in items}
        element = self._by_id[str(component)]
        for child in element.iterfind("{*}attribute"):
            if child.get("id") == attribute.id:
                _fill(child, attribute)
                return
        _fill(_appended(element, "attribute", {"id": attribute.id}), attribute)

    def add(self, part: Component | Relation) -> None:
        if isinstance(part, Component):
            holder = next(self.root.iterfind("{*}components"))
            head = {"id": str(part.id), "type": part.type, "name": part.name}
            element = etree.SubElement(holder, "component", head)
            for attribute in part.attributes:
                _fill(etree.SubElement(element, "attribute", {"id": attribute.id}), attribute)
            return
        holder = next(self.root.iterfind("{*}relations"))
        head = {"id": str(part.id), "type": part.type}
        if part.order is not None:
            head["order"] = str(part.order)
        element = etree.SubElement(holder, "relation", head)
        for role, number in part.refs:
            etree.SubElement(element, "ref", {"id": str(number), "role": role})

    def to_bytes(self) -> bytes:
        tree = self.root.getroottree()
        if not self.root.text:  # made here, not read
            etree.indent(tree)
        after = "".join(map(_written_xml, self.root.itersiblings()))
        text = f"{self.before}{_written_xml(self.root)}\n{after}"
        return text.encode(tree.docinfo.encoding or "UTF-8", "xmlcharrefreplace")


def _written_xml(element: etree._Element) -> str:
    text: str = etree.tostring(element, encoding="unicode", with_tail=False)
    return text


def _name(element: etree._Element) -> str:
    """Tag without its namespace; nothing for comments and the like."""
    return etree.QName(element).localname if isinstance(element.tag, str) else ""


def _component_xml(element: etree._Element) -> Component:
    attributes = tuple(
        Attribute(child.get("id", ""), child.get("unit"), _value(child))
        for child in element.iterfind("{*}attribute")
    )
    return Component(_id(element), element.get("type", ""), element.get("name", ""), attributes)


def _value(element: etree._Element) -> Any:
    for child in element:
        name = _name(child)
        if name == "array" and child.get("code"):
            return Coded(child.get("code", ""), child.text or "")
        if name == "array":
            return tuple((entry.text or "").strip() for entry in child.iterfind("{*}c"))
        if name:
            return None  # matrices are kept, but nothing here reads them
    return (element.text or "").strip()


def _fill(element: etree._Element, attribute: Attribute) -> None:
    element.set("unit", attribute.unit or "none")
    for child in list(element):
        element.remove(child)
    if isinstance(attribute.value, tuple):
        array = etree.SubElement(element, "array")
        for value in attribute.value:
            etree.SubElement(array, "c").text = _text_xml(value)
    else:
        element.text = _text_xml(attribute.value)


def _text_xml(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _appended(parent: etree._Element, name: str, head: dict[str, str]) -> etree._Element:
    """A new last child, indented like the others, in the namespace of its parent."""
    namespace = etree.QName(parent).namespace
    children = list(parent)
    before = parent.getprevious()
    outside = before.tail if before is not None else getattr(parent.getparent(), "text", None)
    child = etree.SubElement(parent, f"{{{namespace}}}{name}" if namespace else name, head)
    if children:
        child.tail = children[-1].tail
        children[-1].tail = parent.text
    elif outside is not None and not outside.strip():
        parent.text = f"{outside}  "
        child.tail = outside
    return child


Content = JsonContent | XmlContent

# Nothing of an archive is unpacked to disk, and nothing that a file names elsewhere is read.


_XML, _JSON, _ZIP = (".rexs", ".rexs.xml"), (".rexsj", ".rexs.json"), (".rexsz", ".rexs.zip")

LARGEST = 20_000_000
"""A gear unit takes some hundred kilobytes; more than this is not read. [bytes]"""

MOST_SIGNS = 600_000
"""Signs that open elements, attributes, objects and lists: each takes memory beyond its length.
A file of a gear unit has ten thousand."""

_LARGEST_REST = 50_000_000
"""Other members of an archive are copied up to this size, all together. [bytes]"""


@dataclass(frozen=True, slots=True)
class Document:
    """A file that has been read."""

    content: Content  # Its parts.
    member: str = ""  # Name of the member of the archive that holds them; empty without an archive.
    others: tuple[tuple[zipfile.ZipInfo, bytes], ...] = ()  # The other members of the archive.

    def to_bytes(self) -> bytes:
        """The file."""
        data = self.content.to_bytes()
        if not self.member:
            return data
        archive = io.BytesIO()
        with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as target:
            target.writestr(self.member, data)
            for info, content in self.others:
                target.writestr(info, content)
        return archive.getvalue()


def is_rexs(path: str | Path) -> bool:
    """True if a name ends as those of REXS files."""
    return str(path).lower().endswith((*_XML, *_JSON, *_ZIP))


def stem(path: str | Path) -> str:
    """Name of a file without its folder and without the ending of REXS files."""
    name = Path(path).name
    endings = sorted((*_XML, *_JSON, *_ZIP), key=len, reverse=True)
    found = next((ending for ending in endings if name.lower().endswith(ending)), "")
    return name[: len(name) - len(found)]


def new_document(path: str | Path, head: dict[str, str]) -> Document:
    """An empty file in the form that the end of its name stands for."""
    name = str(path).lower()
    content = JsonContent.empty(head) if name.endswith(_JSON) else XmlContent.empty(head)
    return Document(content, "rexs-model.rexs" if name.endswith(_ZIP) else "")


def read_document(
    path: Path,
    *,
    with_others: bool = False,  # Read the other members of an archive too, for writing them again.
) -> Document:
    """Read a file, whatever its name says of its form.

    Raises `InputError` if it is no such file, is too large, or is not sound.
    """
    with problems_in(one_line(str(path), 500)):
        data = read_bytes(path, "REXS", LARGEST)
        is_archive = data.startswith(b"PK")
        return _from_archive(data, with_others) if is_archive else Document(_parse(data))


def _from_archive(data: bytes, with_others: bool) -> Document:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return _unpacked(archive, with_others)
    except InputError:
        raise
    except Exception as error:  # what a broken archive raises has no common base
        message = one_line(str(error), 200)
        refuse(f"is not a valid archive: {message}.", "Pack it again.")


def _unpacked(archive: zipfile.ZipFile, with_others: bool) -> Document:
    infos = archive.infolist()
    members = [info for info in infos if info.filename.lower().endswith((*_XML, *_JSON))]
    if len(members) != 1:
        what = "no member" if not members else f"{len(members)} members"
        refuse(f"is an archive with {what} in REXS.", "Pack one file .rexs or .rexsj.")
    for info in infos:
        parts = info.filename.replace("\\", "/").split("/")
        if ".." in parts or parts[0] == "" or ":" in parts[0]:
            shown = one_line(info.filename)
            refuse(f"is an archive with a member outside of it: {shown}.", "Repack it.")
    model = _member(archive, members[0], LARGEST)
    if len(model) > LARGEST:
        remedy = "Export the gears without local results."
        refuse(f"is larger than {LARGEST // 10**6} MB.", remedy)
    content = _parse(model)
    others: list[tuple[zipfile.ZipInfo, bytes]] = []
    left = _LARGEST_REST
    for info in infos if with_others else ():
        if info is not members[0]:
            others.append((info, _member(archive, info, left)))
            left -= len(others[-1][1])
            if left < 0:
                refuse("is an archive with too many files beside the model.", "Remove them.")
    return Document(content, members[0].filename, tuple(others))


def _member(archive: zipfile.ZipFile, info: zipfile.ZipInfo, largest: int) -> bytes:
    with archive.open(info) as member:
        return member.read(largest + 1)


def _parse(data: bytes) -> Content:
    if not data.strip():
        refuse("is empty.", "Name a REXS file.")
    is_json = data.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] in (b"{", b"[")
    signs = (b"{", b"[", b":") if is_json else (b"<", b"=")
    if sum(map(data.count, signs)) > MOST_SIGNS:
        refuse("has too many parts.", "Export the gears without local results.")
    return JsonContent.parse(data) if is_json else XmlContent.parse(data)
