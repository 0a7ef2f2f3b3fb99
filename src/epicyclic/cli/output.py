"""Files that commands write: whole or not at all."""

from __future__ import annotations

import io
import signal
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.errors import InputError, Problem

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["PICTURES", "check_picture", "draw", "finishing", "picture_bytes", "write_file"]

PICTURES = (".png", ".svg", ".pdf")


def check_picture(option: str, path: Path, formats: Sequence[str] = PICTURES) -> None:
    if path.suffix not in formats:
        allowed = f"must end in {', '.join(formats)}."
        problem = Problem(option, str(path), allowed, "Choose one of these formats.")
        raise InputError([problem], "the command")


def draw(figure: Figure, path: Path) -> None:
    write_file(path, picture_bytes(figure, path))
    click.echo(f"Wrote {path}.")


def picture_bytes(figure: Figure, path: Path) -> bytes:
    """What a file of the type of `path` holds of a figure."""
    picture = io.BytesIO()
    figure.savefig(picture, format=path.suffix[1:])
    return picture.getvalue()


def write_file(path: Path, content: str | bytes) -> None:
    """Write `content` to a file whole or not at all, or to a device or pipe as it is."""
    data = content.encode() if isinstance(content, str) else content
    target = path.resolve()
    temporary = target.with_name(f".{target.name}.tmp")
    try:
        if target.exists() and not target.is_file():
            target.write_bytes(data)  # must not be replaced by a file
            return
        temporary.write_bytes(data)
        temporary.replace(target)
    except OSError as error:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        allowed = f"cannot be written: {error.strerror}."
        problem = Problem("FILE", str(path), allowed, "Name another file.")
        raise InputError([problem], "the command") from None


@contextmanager
def finishing(what: str) -> Iterator[None]:
    """Put off the first interruption until all is done: it would leave the file half written.

    Libraries that write files may also hang for ever when they are interrupted.
    """
    usual = signal.getsignal(signal.SIGINT)

    def put_off(*_: object) -> None:
        signal.signal(signal.SIGINT, usual)
        click.echo(f"{what} Interrupt again to stop.", err=True)

    signal.signal(signal.SIGINT, put_off)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, usual)
