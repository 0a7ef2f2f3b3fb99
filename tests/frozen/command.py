"""The command ``epicyclic`` within this process, for many short runs, and files for it."""

from __future__ import annotations

import contextlib
import io
import json
import os
import signal
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest import mock

from epicyclic.__main__ import main

__all__ = ["Done", "run_command", "toml_of"]

SETTINGS = {"EPICYCLIC_PROGRESS": "0", "COLUMNS": "100"}
"""Of the environment: nothing on progress, one width."""


@dataclass(frozen=True)
class Done:
    """What a command has said."""

    code: int
    output: str
    errors: str


def run_command(arguments: Sequence[str], folder: Path) -> Done:
    """Run the command in a folder, as a user would."""
    before = Path.cwd()
    settings = {key: os.environ.get(key) for key in SETTINGS}
    argv, handler = sys.argv, signal.getsignal(signal.SIGINT)
    program = sys.modules["__main__"]
    package = program.__package__
    output, errors = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2))
    code = 0
    os.environ.update(SETTINGS)
    os.chdir(folder)
    sys.argv = ["epicyclic", *arguments]
    program.__package__ = None  # from which its help would take another name
    try:
        with (
            contextlib.redirect_stdout(output),
            contextlib.redirect_stderr(errors),
            mock.patch("gc.freeze"),  # for a process that is about to end, as this one is not
        ):
            main()
    except SystemExit as end:
        code = int(end.code or 0)
    finally:
        sys.argv = argv
        program.__package__ = package
        os.chdir(before)
        signal.signal(signal.SIGINT, handler)
        for key, value in settings.items():
            if value is None:
                del os.environ[key]
            else:
                os.environ[key] = value
    return Done(code, written(output), written(errors))


def written(stream: io.TextIOWrapper) -> str:
    """What has been written to a stream."""
    stream.flush()
    buffer = stream.buffer
    assert isinstance(buffer, io.BytesIO)
    return buffer.getvalue().decode()


def toml_of(tables: dict[str, Any]) -> str:
    """Tables as TOML, one line for each."""
    return "".join(f"{json.dumps(key)} = {_value(item)}\n" for key, item in tables.items())


def _value(item: Any) -> str:
    if isinstance(item, dict):
        inner = ", ".join(f"{json.dumps(key)} = {_value(each)}" for key, each in item.items())
        return f"{{ {inner} }}"
    if isinstance(item, list | tuple):
        return f"[{', '.join(map(_value, item))}]"
    return json.dumps(item, ensure_ascii=False)
