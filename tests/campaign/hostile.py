"""Hostile files: sound ones of every kind with other numbers, sizes, types and names in them.

Unlike random damage these files are whole in their own format: what is wrong is what they say. A
generator of files by number; `test_hostile.py` gives each to its reader.
"""

from __future__ import annotations

import io
import json
import random
import re
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas as pd

__all__ = ["hostile_file"]

NAMES = (
    "", " ", "\u202egnp.exe", "a" * 70_000, "x\u0000y", "=cmd|' /C calc'!A0", "\x1b[2J", "../../x",
    "\ud7ff", "é" * 300, "__class__", "{}", "%s%n", "\r\n[sets]",
)  # fmt: skip
NUMBERS = (
    "nan", "-inf", "1e400", "-1e308", "1e-320", "0x7f", "1_000", "1,000.5", "1.000,5", "١٢", "--3",
    "9" * 5000, "true", "1e5 N*m*m*m*m", "1 degC*degC", "9**9**9 N*m", "12 V", "NaN rpm",
)  # fmt: skip
VALUES: tuple[Any, ...] = (
    None, True, [], {}, [[[]]], "", "\u0000", -0.0, 10**400, 1e308, float("nan"), [None] * 5000,
    {"": {"": ""}}, "a" * 100_000, ["1 N*m"] * 3000, {"__proto__": 1},
)  # fmt: skip
DEEP = 3000


def hostile_file(name: str, sound: bytes, others: list[bytes], number: int) -> bytes:
    """The hostile file of a number, made of a `sound` one of this kind."""
    rng = random.Random(f"{name} {number}")
    suffix = name.rpartition(".")[2]
    if rng.random() < 0.1:
        return rng.choice(others)  # a sound file of another kind
    make: Callable[[bytes, random.Random], bytes] = {
        "nc": _netcdf, "json": _json, "rexsj": _json, "parquet": _parquet, "xlsx": _workbook,
        "partial": _lines, "shard": _lines, "x3p": _spliced, "rexsz": _spliced,
    }.get(suffix, _text)  # fmt: skip
    return make(sound, rng)


def _text(sound: bytes, rng: random.Random) -> bytes:
    text = sound.decode()
    lines = text.splitlines()
    numbers = [match.span() for match in re.finditer(r"-?\d+\.?\d*(e-?\d+)?", text)]
    start, end = rng.choice(numbers)
    word = rng.choice(re.findall(r"[A-Za-z_]{3,}", text) or ["0"])
    ways: tuple[Callable[[], str], ...] = (
        lambda: text[:start] + rng.choice(NUMBERS) + text[end:],
        lambda: text.replace(word, rng.choice(NAMES)),
        lambda: "\n".join([*lines, *[rng.choice(lines)] * rng.choice((1, 30_000))]),
        lambda: "\n".join(rng.sample(lines, len(lines))),
        lambda: "\n".join(line for line in lines if rng.random() < 0.7),
        lambda: "\n".join(lines[: len(lines) // 2] + lines),
        lambda: text[:end] + "[" * DEEP + "]" * DEEP + text[end:],
        lambda: text[:end] + "," * 50_000 + text[end:],
        lambda: re.sub(r"-?\d+\.?\d*", lambda _: rng.choice(NUMBERS[:10]), text),
        lambda: text.replace(",", ";").replace(".", ","),
        lambda: "\ufeff" * 3 + text.upper(),
    )
    return rng.choice(ways)().encode(rng.choice(("utf-8", "utf-8", "utf-16")), "surrogatepass")


def _json(sound: bytes, rng: random.Random) -> bytes:
    content = json.loads(sound)
    places: list[tuple[Any, Any]] = []

    def collect(node: Any) -> None:
        for key in node if isinstance(node, dict) else range(len(node)):
            places.append((node, key))
            if isinstance(node[key], dict | list):
                collect(node[key])

    collect(content)
    for _ in range(rng.choice((1, 1, 5))):
        node, key = rng.choice(places)
        if isinstance(node, dict) and rng.random() < 0.3:
            node[rng.choice(NAMES)] = node.get(key)
        elif key in node or isinstance(node, list):
            node[key] = rng.choice(VALUES)
    text = json.dumps(content)
    if rng.random() < 0.1:
        text = text[:-1] + ', "a": ' + "[" * 100_000 + "]" * 100_000 + "}"
    return text.encode()


def _lines(sound: bytes, rng: random.Random) -> bytes:
    """Journals and shards: a line of JSON for each point."""
    lines = sound.splitlines()
    at = rng.randrange(len(lines))
    ways: tuple[Callable[[], list[bytes]], ...] = (
        lambda: [
            *lines[:at],
            _json(lines[at], rng) if lines[at][:1] in b"{[" else b"x",
            *lines[at:],
        ],
        lambda: lines * 2,
        lambda: lines[::-1],
        lambda: [lines[at]] * 5000,
        lambda: lines[at:],
        lambda: [*lines, b"{}" * 20_000],
    )
    return b"\n".join(rng.choice(ways)()) + b"\n"


def _spliced(sound: bytes, rng: random.Random) -> bytes:
    """Archives: parts of it twice, in another order, or with a comment."""
    cut = rng.randrange(1, len(sound))
    made = sound[:cut] + rng.randbytes(3000) + sound[cut:]
    ways = sound + sound, sound[cut:] + sound[:cut], sound + b"x" * 100_000, made, sound[:cut] * 3
    return rng.choice(ways)


def _table(frame: pd.DataFrame, rng: random.Random) -> pd.DataFrame:
    column = rng.choice(list(frame.columns))
    ways: tuple[Callable[[], pd.DataFrame], ...] = (
        lambda: frame.assign(**{column: rng.choice([["a"] * len(frame), [True] * len(frame)])}),
        lambda: frame.assign(**{column: [np.nan] * len(frame)}),
        lambda: frame.assign(**{column: [10.0 ** rng.uniform(-300, 300)] * len(frame)}),
        lambda: frame.drop(columns=column),
        lambda: frame.rename(columns={column: rng.choice(NAMES[:3] + NAMES[4:7])}),
        lambda: frame.iloc[:0],
        lambda: pd.concat([frame] * 2000),
        lambda: frame.join(pd.DataFrame(1.0, frame.index, [f"c{n}" for n in range(1500)])),
        lambda: frame.assign(**{column: pd.Timestamp("1677-09-22")}),
        lambda: frame.T.reset_index().astype(str).rename(columns=str),
    )
    return rng.choice(ways)()


def _parquet(sound: bytes, rng: random.Random) -> bytes:
    frame = pd.read_parquet(io.BytesIO(sound))
    if rng.random() < 0.2:
        frame = frame.assign(**{frame.columns[0]: [[{"a": [1]}]] * len(frame)})
    else:
        frame = _table(frame, rng)
    file = io.BytesIO()
    frame.to_parquet(file, index=False)
    return file.getvalue()


def _workbook(sound: bytes, rng: random.Random) -> bytes:
    file = io.BytesIO()
    frame = _table(pd.read_excel(io.BytesIO(sound)), rng)
    frame = frame.rename(columns=lambda name: re.sub(r"[\x00-\x1f]", "", str(name))[:30_000])
    frame.to_excel(file, index=False, sheet_name=rng.choice(("Sheet1", "=1+1", "a'b")))
    return file.getvalue()


def _netcdf(sound: bytes, rng: random.Random) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "file.nc"
        path.write_bytes(sound)
        with h5py.File(path, "a") as file:
            _altered(file, rng)
        return path.read_bytes()


def _altered(file: Any, rng: random.Random) -> None:
    names = [name for name in file if isinstance(file[name], h5py.Dataset)]
    holders = [file, *(file[name] for name in names)]
    holder = rng.choice([it for it in holders if len(it.attrs)])
    attribute = rng.choice(list(holder.attrs))
    way = rng.randrange(6 if names else 3)
    if way == 0:
        holder.attrs[attribute] = rng.choice(("", "x" * 60_000, "{" * 5000, "\ud7ff[2J", "1 N*m"))
    elif way == 1:
        holder.attrs[attribute] = rng.choice((np.nan, -1, np.zeros(5000), True, 2**62))
    elif way == 2:
        del holder.attrs[attribute]
    elif way == 3:
        del file[rng.choice(names)]
    else:
        name = rng.choice(names)
        kept = dict(file[name].attrs) if way == 4 else {}
        shape = file[name].shape
        del file[name]
        data: Any = rng.choice((np.full(shape, np.nan), np.full(shape, 10.0**300), np.array("x"),
                                np.zeros((2, 2, 2)), np.full(shape, -7), np.zeros(0)))  # fmt: skip
        data = data if data.dtype.kind != "U" else np.bytes_("x")
        made = file.create_dataset(name, data=data)
        for key, value in kept.items():
            if key not in ("DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME"):
                made.attrs[key] = value
