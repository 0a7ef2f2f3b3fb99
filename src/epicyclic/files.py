"""Files: text that users give, files that are written whole or not at all; and garbage."""

from __future__ import annotations

import csv
import errno
import gc
import hashlib
import io
import json
import os
import re
import shutil
import stat
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any, NoReturn

from epicyclic.errors import InputError, Problem

# Text files that users give: read whole if they are no larger than such a file can be, as UTF-8.
#
# Everything that reads a file of the user goes through here, so that devices, folders, huge files
# and other encodings end in the same messages.


_MEGABYTE = 1_000_000
_SEAL = "fingerprint"
_MAKE_AGAIN = "Make it again."
_LONGEST_REASON = 200
_WITHOUT_WAITING = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
_PROBE = 65_536  # More than the start of any file. [bytes]


def read_text(
    path: Path,
    noun: str,  # What the file should be, ``"case"`` for a case file, for messages.
    largest: int,  # Size beyond which it is something else. [bytes]
) -> str:
    """The text of a file. Raises `InputError` if it is not a file, too large, or not UTF-8 text."""
    return decode(read_bytes(path, noun, largest), noun)


def read_bytes(path: Path, noun: str, largest: int, *, whole: bool = True) -> bytes:
    """The content of a file, or its start. Parameters and errors as for `read_text`."""
    kind = "a file"
    content: bytes | None = b""
    try:
        # a pipe or a device could keep the program waiting for ever
        if path.exists() and not path.is_file():
            kind = "a folder" if path.is_dir() else "not a regular file"
        else:
            with os.fdopen(os.open(path, _WITHOUT_WAITING), "rb") as file:
                content = file.read(largest + 1)
    except OSError as error:
        refuse(f"cannot be read: {error.strerror}.", "Check the path.")
    except ValueError:
        refuse("cannot be read: a path has no zero character.", "Check the path.")
    if kind != "a file":
        refuse(f"cannot be read: it is {kind}.", f"Give a {noun} file.")
    if content is None:  # the system may write there some day
        refuse("cannot be read: it has no content now.", f"Give a {noun} file.")
    if whole and len(content) > largest:
        size = f"{largest / _MEGABYTE:g} MB"
        refuse(f"is too large to be a {noun} file (over {size}).", f"Give a {noun} file.")
    return content


def decode(content: bytes, noun: str) -> str:
    """`content` as text; raises `InputError` unless it is UTF-8."""
    if b"\0" in content:
        refuse("is not text: it contains zero bytes.", f"Give a {noun} file saved as UTF-8 text.")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        where = f"byte 0x{content[error.start]:02x} in line {line}"
        refuse(f"is not UTF-8 text: {where}.", "Save it as UTF-8 text.")


def csv_rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """Line number and cells of each row; the separator is that of the header.

    Lines that begin with # are skipped.
    """
    kept = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    separator = max(",;\t", key=kept[0][1].count) if kept else ","
    for number, line in kept:  # line by line: a quote that stays open spoils one row only
        try:
            (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
        except csv.Error as error:
            refuse(f"is not CSV: {error} in line {number}.", "Correct this line.")
        yield number, [cell.strip() for cell in cells]


def check_archive(content: bytes, noun: str, largest: int, remedy: str) -> None:
    """Raise `InputError` unless `content` is a zip archive that unpacks to `largest` bytes or less.

    `noun` with its article: ``"an X3P file"``.
    """
    import zipfile

    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            unpacked = sum(item.file_size for item in archive.infolist())
    except Exception:  # damaged archives end in many kinds of errors
        refuse(f"is not {noun}.", remedy)
    if unpacked > largest:
        refuse(f"expands to more than {largest / _MEGABYTE:g} MB.", remedy)


_COLUMN = re.compile(r"\[\n\s*([-+.,eE\d\s]+)\]")
"""A list of numbers with each on a line of its own: they share one line."""


def sealed(content: Mapping[str, Any], indent: int | None = None) -> str:
    """JSON with a fingerprint of its content, so that `unsealed` sees whether it was altered."""
    separators = (",", ":") if indent is None else (",", ": ")
    whole = {**content, _SEAL: _fingerprint(content)}
    text = json.dumps(whole, indent=indent, separators=separators)
    return _COLUMN.sub(lambda found: "[" + " ".join(found[1].split()) + "]", text) + "\n"


def unsealed(text: str) -> dict[str, Any]:
    """The content of a text from `sealed`; raises `InputError` if it is none, or was altered."""
    try:
        content = json.loads(text)
    except (ValueError, RecursionError) as error:
        refuse(f"is not JSON: {str(error)[:_LONGEST_REASON]}.", _MAKE_AGAIN)
    if not isinstance(content, dict) or _SEAL not in content:
        refuse("has no fingerprint.", _MAKE_AGAIN)
    if content.pop(_SEAL) != _fingerprint(content):
        refuse("was altered: its fingerprint does not match its content.", _MAKE_AGAIN)
    return content


def _fingerprint(content: Mapping[str, Any]) -> str:
    text = json.dumps(content, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def refuse(allowed: str, remedy: str) -> NoReturn:
    """Raise the `InputError` of a file as a whole."""
    raise InputError([Problem("", "", f"the file {allowed}", remedy)])


# Files that are written whole or not at all: the only way in which the package writes results.
#
# A file is made in a private folder beside the one that it replaces. Nobody else can put a link
# into that folder, and whatever ends the writer leaves the old file as it was. What a killed writer
# leaves behind is removed by the next one that writes to the same folder.

PREFIX = ".epicyclic-"  # Begins the names of the private folders.
FILE, REMEDY = "FILE", "Name another file."


def check_place(*paths: Path | None) -> None:
    """Raise `InputError` unless a file can be written to each of `paths` that is given."""
    for path in filter(None, paths):
        with _plain_errors(path):
            folder = path.absolute().parent
            with suppress(FileNotFoundError):
                path.lstat()  # raises for a name that is too long
            if not folder.is_dir():
                allowed = "lies in a folder that does not exist."
                raise _error(path, FILE, allowed, "Create it first.")
            if path.exists() and not path.is_file():
                raise _error(path, FILE, "is a folder or no regular file.", REMEDY)
            if not os.access(folder, os.W_OK):
                allowed = "lies in a folder without write permission."
                raise _error(path, FILE, allowed, "Move it.")


def make_folder(path: Path, option: str = FILE) -> None:
    """Make a folder, unless there is one; raises `InputError` if it cannot be made."""
    try:
        _check_name(path)
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        allowed = f"cannot hold a folder: {error.strerror}."
        raise _error(path, option, allowed, "Name another folder.") from None


def check_folder(path: Path, option: str = FILE) -> None:
    """Raise `InputError` unless there is a folder to write to or it can be made; it is not kept."""
    new = [it for it in (path, *path.parents) if not os.path.lexists(it)]
    make_folder(path, option)
    is_open = os.access(path, os.W_OK)
    for folder in new:
        folder.rmdir()
    if not is_open:
        raise _error(path, option, "is without write permission.", "Name another folder.")


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A file to be written in a private folder; it replaces `path` if nothing goes wrong.

    A file that is replaced keeps its permissions, a new one gets those that the umask of the user
    leaves it. A link is followed. Raises `InputError` if the file cannot be written: the disk is
    full, the name is too long.
    """
    with _plain_errors(path):
        target = path.resolve()
        if target.exists() and not os.access(target, os.W_OK):
            raise PermissionError(errno.EACCES, "it is write-protected")
        _remove_leftovers(target.parent)
        with _private_folder(target.parent) as folder:
            temporary = folder / target.name
            try:
                yield temporary
            except PermissionError:  # netCDF4 says so of a full disk too: what does the system say?
                temporary.unlink(missing_ok=True)
                temporary.write_bytes(bytes(_PROBE))
                raise
            if target.exists():
                temporary.chmod(stat.S_IMODE(target.stat().st_mode))
            temporary.replace(target)


def write_file(path: Path, content: str | bytes) -> None:
    """Write `content` to a file whole or not at all, or to a device or pipe as it is.

    Raises `InputError`: As for `whole_file`.
    """
    data = content.encode() if isinstance(content, str) else content
    with _plain_errors(path):
        if path.exists() and not path.is_file():
            path.write_bytes(data)  # must not be replaced by a file
            return
    with whole_file(path) as temporary:
        temporary.write_bytes(data)


@contextmanager
def _plain_errors(path: Path) -> Iterator[None]:
    """What the system and the libraries raise if a file cannot be written, as `InputError`."""
    try:
        _check_name(path)
        yield
    except BrokenPipeError:  # of a pipe whose reader has seen enough
        raise
    except OSError as error:
        raise _error(path, FILE, f"cannot be written: {error.strerror or error}.", REMEDY) from None
    except RuntimeError as error:
        if not str(error).startswith("NetCDF: "):
            raise
        allowed = f"cannot be written: {error} (a full disk is one cause)."
        raise _error(path, FILE, allowed, REMEDY) from None


def _check_name(path: Path) -> None:
    if "\0" in str(path):
        raise OSError(errno.EINVAL, "a name has no zero character")


def _error(path: Path, option: str, allowed: str, remedy: str) -> InputError:
    return InputError([Problem(option, str(path), allowed, remedy)], "the command")


@contextmanager
def _private_folder(parent: Path) -> Iterator[Path]:
    """A new folder that nobody else may enter, locked while it is in use.

    The system releases the lock however this process ends.
    """
    with ExitStack() as stack:
        while True:
            made = tempfile.TemporaryDirectory(
                prefix=PREFIX, dir=parent, ignore_cleanup_errors=True
            )
            folder = Path(stack.enter_context(made))
            handle = _locked(folder, wait=True)
            if handle is not None:
                stack.callback(os.close, handle)
            if folder.exists():  # else another writer removed it before it was locked
                break
        yield folder


def _remove_leftovers(parent: Path) -> None:
    """Remove the private folders of this user in `parent` that nobody holds any more."""
    for folder in parent.glob(f"{PREFIX}*"):
        handle = _locked(folder, wait=False)
        if handle is not None:
            if os.fstat(handle).st_uid == os.geteuid():
                shutil.rmtree(folder, ignore_errors=True)
            os.close(handle)


def _locked(folder: Path, *, wait: bool) -> int | None:
    """A handle that holds the lock of a folder; None if another has it, or there are no locks."""
    if sys.platform == "win32":  # where the folder of a living writer cannot be removed anyway
        return None
    import fcntl

    try:
        handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    except OSError:
        return None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:
        os.close(handle)
        return None
    return handle


# How often Python looks through memory for what nothing refers to any more.

NEW_OBJECTS = 300_000
"""So many make Python look for garbage. A start makes 250,000, all of them to stay."""


def look_seldom() -> None:
    """Look less often than Python does by itself, in a process that is the program's own."""
    gc.set_threshold(NEW_OBJECTS)
