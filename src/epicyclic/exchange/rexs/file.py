"""REXS files: XML, JSON, or either in a ZIP archive; read with bounds, written whole.

Nothing of an archive is unpacked to disk, and nothing that a file names elsewhere is read.
"""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from epicyclic.case.wording import one_line
from epicyclic.errors import InputError
from epicyclic.exchange.rexs.model import refuse
from epicyclic.text_file import read_bytes

if TYPE_CHECKING:
    from epicyclic.exchange.rexs.content import Content

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
    from epicyclic.exchange.rexs.json_form import JsonContent
    from epicyclic.exchange.rexs.xml_form import XmlContent

    name = str(path).lower()
    content = JsonContent.empty(head) if name.endswith(_JSON) else XmlContent.empty(head)
    return Document(content, "rexs-model.rexs" if name.endswith(_ZIP) else "")


def read_document(
    path: Path,
    *,
    with_others: bool = False,  # Read the other members of an archive too, for writing them again.
) -> Document:
    """Read a file, whatever its name says of its form.

    Raises
    ------
    InputError
        If it is no such file, is too large, or is not sound.
    """
    try:
        data = read_bytes(path, "REXS", LARGEST)
        return (
            _from_archive(data, with_others) if data.startswith(b"PK") else Document(_parse(data))
        )
    except InputError as error:
        raise InputError(error.problems, one_line(str(path), 500)) from None


def _from_archive(data: bytes, with_others: bool) -> Document:
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return _unpacked(archive, with_others)
    except InputError:
        raise
    except Exception as error:  # what a broken archive raises has no common base
        message = one_line(str(error), 200)
        raise refuse(f"is not a sound archive: {message}.", "Pack it again.") from None


def _unpacked(archive: zipfile.ZipFile, with_others: bool) -> Document:
    infos = archive.infolist()
    members = [info for info in infos if info.filename.lower().endswith((*_XML, *_JSON))]
    if len(members) != 1:
        what = "no member" if not members else f"{len(members)} members"
        raise refuse(f"is an archive with {what} in REXS.", "Pack one file .rexs or .rexsj.")
    for info in infos:
        parts = info.filename.replace("\\", "/").split("/")
        if ".." in parts or parts[0] == "" or ":" in parts[0]:
            shown = one_line(info.filename)
            raise refuse(
                f"is an archive with a member that leads out of it: {shown}.", "Repack it."
            )
    model = _member(archive, members[0], LARGEST)
    if len(model) > LARGEST:
        raise refuse(
            f"is larger than {LARGEST // 10**6} MB.", "Export the gears without local results."
        )
    content = _parse(model)
    others: list[tuple[zipfile.ZipInfo, bytes]] = []
    left = _LARGEST_REST
    for info in infos if with_others else ():
        if info is not members[0]:
            others.append((info, _member(archive, info, left)))
            left -= len(others[-1][1])
            if left < 0:
                raise refuse("is an archive with too much beside the model.", "Take that out.")
    return Document(content, members[0].filename, tuple(others))


def _member(archive: zipfile.ZipFile, info: zipfile.ZipInfo, largest: int) -> bytes:
    with archive.open(info) as member:
        return member.read(largest + 1)


def _parse(data: bytes) -> Content:
    from epicyclic.exchange.rexs.json_form import JsonContent
    from epicyclic.exchange.rexs.xml_form import XmlContent

    if not data.strip():
        raise refuse("is empty.", "Name a REXS file.")
    is_json = data.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] in (b"{", b"[")
    signs = (b"{", b"[", b":") if is_json else (b"<", b"=")
    if sum(map(data.count, signs)) > MOST_SIGNS:
        raise refuse("has too many parts.", "Export the gears without local results.")
    return JsonContent.parse(data) if is_json else XmlContent.parse(data)
