"""Standard input and output as the server of agents reads and writes them: messages of one line."""

from __future__ import annotations

import io
import json
import os
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

from mcp_types import INVALID_REQUEST, PARSE_ERROR, jsonrpc_message_adapter

LARGEST_MESSAGE = 4_000_000
"""A call of the longest arguments has less. [bytes]"""
_HEAD, _NUMBER = 200, re.compile(rb'"id"\s*:\s*(\d{1,15})\b')


@contextmanager
def bounded_wire() -> Iterator[None]:
    """Serve from streams that pass on messages only, and answer what is none themselves.

    Meanwhile nothing else reads from standard input, and what else is printed goes to standard
    error. So it is with the streams of the server, which pass over what they cannot read, of any
    length.
    """
    given = sys.stdin, sys.stdout
    with os.fdopen(os.dup(0), "rb") as source, os.fdopen(os.dup(1), "wb") as sink:
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        os.close(nothing)
        os.dup2(2, 1)
        sys.stdin, sys.stdout = io.TextIOWrapper(_Messages(source, sink)), io.TextIOWrapper(sink)
        try:
            yield
        finally:
            sys.stdin, sys.stdout = given


class _Messages(io.BufferedIOBase):
    """The lines that are messages; `sink`, whose writes are whole, gets answers to the others."""

    def __init__(self, source: BinaryIO, sink: BinaryIO) -> None:
        self._source, self._sink = source, sink

    def readable(self) -> bool:
        return True

    def read1(self, size: int = -1, /) -> bytes:
        """The next message, of any size."""
        while line := self._source.readline(LARGEST_MESSAGE):
            if self._is_message(line):
                return line
        return b""

    def _is_message(self, line: bytes) -> bool:
        if len(line) == LARGEST_MESSAGE and not line.endswith(b"\n"):
            head = _NUMBER.search(line[:_HEAD])
            while line and not line.endswith(b"\n"):
                line = self._source.readline(LARGEST_MESSAGE)
            reason = f"The message has more than {LARGEST_MESSAGE / 1e6:g} MB."
            self._refuse(int(head[1]) if head else None, INVALID_REQUEST, reason)
            return False
        if not line.strip():
            return False
        try:
            found = json.loads(line)
        except (ValueError, RecursionError):
            self._refuse(None, PARSE_ERROR, "The message is not JSON.")
            return False
        number = found.get("id") if isinstance(found, dict) else None
        try:
            jsonrpc_message_adapter.validate_json(line, by_name=False)
            is_message = "id" not in found or type(number) in (str, int)  # No bool.
        except ValueError:
            is_message = False
        if not is_message:
            self._refuse(number, INVALID_REQUEST, "This is no message of JSON-RPC 2.0.")
        return is_message

    def _refuse(self, number: object, code: int, reason: str) -> None:
        known = number if type(number) in (str, int) else None
        answer = {"jsonrpc": "2.0", "id": known, "error": {"code": code, "message": reason}}
        self._sink.write(json.dumps(answer).encode() + b"\n")
        self._sink.flush()
