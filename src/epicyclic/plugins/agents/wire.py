"""Standard input and output as the server of agents reads and writes them: messages of one line."""

from __future__ import annotations

import io
import json
import os
import re
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, BinaryIO

from mcp_types import jsonrpc_message_adapter

LARGEST_MESSAGE = 4_000_000
"""A call of the longest arguments has less. [bytes]"""
_HEAD, _NUMBER = 200, re.compile(rb'"id"\s*:\s*(\d{1,15})\b')
_NO_JSON, _NO_MESSAGE = -32700, -32600  # Codes of JSON-RPC 2.0.


@contextmanager
def bounded_wire() -> Iterator[None]:
    """Serve from streams that pass on messages only, and answer what is none themselves.

    Meanwhile nothing else reads from standard input, and what else is printed goes to standard
    error. So it is with the streams of the server, which pass over what they cannot read, of any
    length.
    """
    given = sys.stdin, sys.stdout
    with os.fdopen(os.dup(0), "rb") as source, os.fdopen(os.dup(1), "wb", buffering=0) as sink:
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        os.close(nothing)
        os.dup2(2, 1)
        answers = _Answers(sink)
        messages = io.BufferedReader(_Messages(source, answers))
        sys.stdin, sys.stdout = io.TextIOWrapper(messages), io.TextIOWrapper(answers)
        try:
            yield
        finally:
            sys.stdin, sys.stdout = given


class _Answers(io.BufferedIOBase):
    """Where each answer is written whole, whoever writes it."""

    def __init__(self, sink: BinaryIO) -> None:
        self._sink, self._one_at_a_time = sink, threading.Lock()

    def writable(self) -> bool:
        return True

    def write(self, content: Any, /) -> int:
        data = memoryview(content).cast("B")
        done = 0
        with self._one_at_a_time:
            while done < len(data):  # a pipe takes a part
                done += self._sink.write(data[done:]) or 0
        return done

    def refuse(self, number: object, code: int, reason: str) -> None:
        """Answer what is no message."""
        known = number if isinstance(number, str | int) and not isinstance(number, bool) else None
        answer = {"jsonrpc": "2.0", "id": known, "error": {"code": code, "message": reason}}
        self.write(json.dumps(answer).encode() + b"\n")


class _Messages(io.RawIOBase):
    """The lines that are messages."""

    def __init__(self, source: BinaryIO, answers: _Answers) -> None:
        self._source, self._answers, self._left = source, answers, b""

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: Any, /) -> int:
        room = memoryview(buffer).cast("B")
        while not self._left:
            line = self._source.readline(LARGEST_MESSAGE)
            if not line:
                return 0
            self._left = line if self._is_message(line) else b""
        size = min(len(room), len(self._left))
        room[:size], self._left = self._left[:size], self._left[size:]
        return size

    def _is_message(self, line: bytes) -> bool:
        if len(line) == LARGEST_MESSAGE and not line.endswith(b"\n"):
            head = _NUMBER.search(line[:_HEAD])
            while line and not line.endswith(b"\n"):
                line = self._source.readline(LARGEST_MESSAGE)
            reason = f"The message has more than {LARGEST_MESSAGE / 1e6:g} MB."
            self._answers.refuse(int(head[1]) if head else None, _NO_MESSAGE, reason)
            return False
        if not line.strip():
            return False
        try:
            found = json.loads(line)
        except (ValueError, RecursionError):
            self._answers.refuse(None, _NO_JSON, "The message is not JSON.")
            return False
        number = found.get("id", "none") if isinstance(found, dict) else None
        try:
            jsonrpc_message_adapter.validate_json(line, by_name=False)
            is_message = isinstance(number, str | int) and not isinstance(number, bool)
        except ValueError:
            is_message = False
        if not is_message:
            number = None if number == "none" else number
            self._answers.refuse(number, _NO_MESSAGE, "This is no message of JSON-RPC 2.0.")
        return is_message
