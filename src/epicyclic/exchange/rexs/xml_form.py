"""REXS as XML; comments and all that is not understood stay as they are."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from lxml import etree

from epicyclic.case.wording import one_line
from epicyclic.exchange.rexs.content import RawComponent, RawRelation
from epicyclic.exchange.rexs.model import Attribute, Coded, Component, Relation, refuse

_DECLARATION = '<?xml version="1.0" encoding="UTF-8"?>\n'

_BEFORE_ROOT = re.compile(r"\ufeff?(?:\s+|<\?.*?\?>|<!--.*?-->)*", re.DOTALL)
"""Declaration and comments; the library that reads the elements does not keep them as they are."""


class XmlContent:
    """A file in XML, as its elements."""

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
            raise refuse(f"is not sound XML: {message}.", "Export it again.") from None
        if root.getroottree().docinfo.doctype:
            raise refuse("has a document type, which REXS has not.", "Remove it.")
        if _name(root) != "model":
            raise refuse("is not REXS: its first element is not model.", "Name a REXS file.")
        encoding = root.getroottree().docinfo.encoding or "UTF-8"
        before = _BEFORE_ROOT.match(data.decode(encoding, "replace"))
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

    def components(self) -> Iterator[RawComponent]:
        return map(_component, self._component_elements())

    def relations(self) -> Iterator[RawRelation]:
        for holder in _children(self.root, "relations"):
            for element in _children(holder, "relation"):
                refs = tuple(
                    (ref.get("role", ""), ref.get("id")) for ref in _children(element, "ref")
                )
                yield RawRelation(
                    element.get("id"), element.get("type", ""), element.get("order"), refs
                )

    def load_cases(self) -> Iterator[tuple[Any, Iterator[RawComponent]]]:
        for spectrum in _children(self.root, "load_spectrum"):
            for element in _children(spectrum, "load_case"):
                yield element.get("id"), map(_component, _children(element, "component"))

    def set_attribute(self, component: int, attribute: Attribute) -> None:
        if self._by_id is None:
            self._by_id = {item.get("id", "").strip(): item for item in self._component_elements()}
        element = self._by_id[str(component)]
        for child in _children(element, "attribute"):
            if child.get("id") == attribute.id:
                _fill(child, attribute)
                return
        _fill(_appended(element, "attribute", {"id": attribute.id}), attribute)

    def add(self, part: Component | Relation) -> None:
        if isinstance(part, Component):
            holder = next(_children(self.root, "components"))
            head = {"id": str(part.id), "type": part.type, "name": part.name}
            element = etree.SubElement(holder, "component", head)
            for attribute in part.attributes.values():
                _fill(etree.SubElement(element, "attribute", {"id": attribute.id}), attribute)
            return
        holder = next(_children(self.root, "relations"))
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
        after = "".join(map(_written, self.root.itersiblings()))
        text = f"{self.before}{_written(self.root)}\n{after}"
        return text.encode(tree.docinfo.encoding or "UTF-8", "xmlcharrefreplace")

    def _component_elements(self) -> Iterator[etree._Element]:
        for holder in _children(self.root, "components"):
            yield from _children(holder, "component")


def _written(element: etree._Element) -> str:
    text: str = etree.tostring(element, encoding="unicode", with_tail=False)
    return text


def _name(element: etree._Element) -> str:
    """Tag without its namespace; nothing for comments and the like."""
    return etree.QName(element).localname if isinstance(element.tag, str) else ""


def _children(element: etree._Element, name: str) -> Iterator[etree._Element]:
    return (child for child in element if _name(child) == name)


def _component(element: etree._Element) -> RawComponent:
    attributes = tuple(
        Attribute(child.get("id", ""), child.get("unit"), _value(child))
        for child in _children(element, "attribute")
    )
    return RawComponent(
        element.get("id"), element.get("type", ""), element.get("name", ""), attributes
    )


def _value(element: etree._Element) -> Any:
    for child in element:
        name = _name(child)
        if name == "array" and child.get("code"):
            return Coded(child.get("code", ""), child.text or "")
        if name == "array":
            return tuple((entry.text or "").strip() for entry in _children(child, "c"))
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
            etree.SubElement(array, "c").text = _text(value)
    else:
        element.text = _text(attribute.value)


def _text(value: Any) -> str:
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
