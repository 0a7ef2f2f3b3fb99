"""Sizes of the pages of a Parquet file: a page is read as a whole, however large it is.

Readers offer the sizes of columns only. Those of pages stand in their headers, in the compact form
of Apache Thrift: https://github.com/apache/parquet-format, parquet.thrift, ``struct PageHeader``.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

if TYPE_CHECKING:
    import pyarrow.parquet as pq

LARGEST_HEADER = 1 << 16
"""Bytes within which the header of a page must end; most have some twenty."""
_STOP, _TRUE, _FALSE, _BYTE, _DOUBLE, _BINARY, _STRUCT = 0, 1, 2, 3, 7, 8, 12
_LISTS = (9, 10)
_DEEPEST = 20


def largest_page(
    path: Path,
    file: pq.ParquetFile,  # The same, open.
    columns: Iterable[str],
    enough: int,  # Size up to which it does not matter; columns of no more are not looked into.
) -> int:
    """Size of the largest page of some columns, unpacked, or of the first beyond `enough`. [bytes]

    Raises
    ------
    ArrowInvalid
        If the header of a page cannot be read.
    """
    wanted, largest = set(columns), 0
    with path.open("rb") as source:
        for group in range(file.metadata.num_row_groups):
            for number in range(file.metadata.num_columns):
                chunk = file.metadata.row_group(group).column(number)
                if chunk.path_in_schema.split(".")[0] not in wanted:
                    continue
                if max(chunk.total_uncompressed_size, chunk.total_compressed_size) <= enough:
                    continue
                largest = max(largest, _largest_of(source, chunk, enough))
                if largest > enough:
                    return largest
    return largest


def _largest_of(source: BinaryIO, chunk: pq.ColumnChunkMetaData, enough: int) -> int:
    """Size of the largest page of one column of a row group."""
    place = chunk.data_page_offset
    if chunk.has_dictionary_page and chunk.dictionary_page_offset:
        place = min(place, chunk.dictionary_page_offset)
    end, largest = place + chunk.total_compressed_size, 0
    while place < end:
        source.seek(place)
        header = _Compact(source.read(LARGEST_HEADER))
        unpacked, packed = header.sizes()
        largest = max(largest, unpacked, packed)
        if largest > enough:
            break
        place += header.place + packed
    return largest


def _invalid(what: str) -> Exception:
    import pyarrow as pa

    error: Exception = pa.ArrowInvalid(f"the header of a page {what}")
    return error


class _Compact:
    """The little of the compact form of Thrift that headers of pages need."""

    def __init__(self, content: bytes) -> None:
        self._content, self.place = content, 0

    def sizes(self) -> tuple[int, int]:
        """Unpacked and packed size of the page whose header this is: fields 2 and 3."""
        found = {}
        for field, kind in self._fields():
            if field in (2, 3):
                found[field] = self._number()
            else:
                self._skip(kind, 0)
        if min(found.get(2, -1), found.get(3, -1)) < 0:
            raise _invalid("has no sizes")
        return found[2], found[3]

    def _fields(self) -> Iterable[tuple[int, int]]:
        """Number and kind of each field of a struct; what follows it must be read in between."""
        field = 0
        while (head := self._byte()) & 0x0F != _STOP:
            field = field + (head >> 4) if head >> 4 else self._number()
            yield field, head & 0x0F

    def _byte(self) -> int:
        if self.place >= len(self._content):
            raise _invalid("does not end")
        self.place += 1
        return self._content[self.place - 1]

    def _varint(self) -> int:
        value = shift = 0
        while True:
            byte = self._byte()
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value

    def _number(self) -> int:
        """A signed whole number."""
        value = self._varint()
        return (value >> 1) ^ -(value & 1)

    def _skip(self, kind: int, depth: int) -> None:
        """Go past a value."""
        if depth > _DEEPEST:
            raise _invalid("is too deep")
        if kind in (_TRUE, _FALSE):
            return
        if kind == _BYTE:
            self.place += 1
        elif kind == _DOUBLE:
            self.place += 8
        elif kind == _BINARY:
            length = self._varint()
            self.place += length
        elif kind == _STRUCT:
            for _, inner in self._fields():
                self._skip(inner, depth + 1)
        elif kind in _LISTS:
            head = self._byte()
            for _ in range(self._varint() if head >> 4 == 15 else head >> 4):
                self._skip_entry(head & 0x0F, depth)
        elif kind in (4, 5, 6):
            self._varint()
        else:
            raise _invalid("holds something unknown")

    def _skip_entry(self, kind: int, depth: int) -> None:
        """Go past an entry of a list, where truths take a byte."""
        self._skip(_BYTE if kind in (_TRUE, _FALSE) else kind, depth + 1)
