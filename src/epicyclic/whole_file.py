"""Files that are written whole or not at all: the only way in which the package writes results.

A file is made in a private folder beside the one that it replaces. Nobody else can put a link into
that folder, and whatever ends the writer leaves the old file as it was. What a killed writer leaves
behind is removed by the next one that writes to the same folder.
"""

from __future__ import annotations

import errno
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from epicyclic.errors import InputError, Problem

try:
    import fcntl
except ImportError:  # Windows, where the folder of a living writer cannot be removed anyway
    fcntl = None  # type: ignore[assignment]

PREFIX = ".epicyclic-"
"""Begins the names of the private folders."""
OPTION, FILE, REMEDY = "-o", "FILE", "Name another file."


def check_place(path: Path) -> None:
    """Raise `InputError` unless a file can be written to `path`."""
    with _plain_errors(path, OPTION):
        folder = path.absolute().parent
        with suppress(FileNotFoundError):
            path.lstat()  # raises for a name that is too long
        if (path.exists() and not path.is_file()) or not folder.is_dir():
            raise _error(path, OPTION, "is no place for a file.", "Name a file in a folder.")
        if not os.access(folder, os.W_OK):
            allowed = "lies in a folder without write permission."
            raise _error(path, OPTION, allowed, "Move it.")


def make_folder(path: Path, option: str = OPTION) -> None:
    """Make a folder, unless there is one; raises `InputError` if it cannot be made."""
    try:
        _check_name(path)
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        allowed = f"is no place for a folder: {error.strerror}."
        raise _error(path, option, allowed, "Name another folder.") from None


@contextmanager
def whole_file(path: Path, option: str = OPTION) -> Iterator[Path]:
    """A file to be written in a private folder; it replaces `path` if nothing goes wrong.

    A file that is replaced keeps its permissions, a new one gets those that the umask of the user
    leaves it. A link is followed.

    Raises
    ------
    InputError
        If the file cannot be written: the disk is full, the name is too long. `option` is that of
        its problem.
    """
    with _plain_errors(path, option):
        target = path.resolve()
        if target.exists() and not os.access(target, os.W_OK):
            raise PermissionError(errno.EACCES, "it is write-protected")
        _remove_leftovers(target.parent)
        with _private_folder(target.parent) as folder:
            temporary = folder / target.name
            yield temporary
            if target.exists():
                temporary.chmod(stat.S_IMODE(target.stat().st_mode))
            temporary.replace(target)


def write_file(path: Path, content: str | bytes) -> None:
    """Write `content` to a file whole or not at all, or to a device or pipe as it is.

    Raises
    ------
    InputError
        As for `whole_file`.
    """
    data = content.encode() if isinstance(content, str) else content
    with _plain_errors(path, FILE):
        if path.exists() and not path.is_file():
            path.write_bytes(data)  # must not be replaced by a file
            return
    with whole_file(path, FILE) as temporary:
        temporary.write_bytes(data)


@contextmanager
def _plain_errors(path: Path, option: str) -> Iterator[None]:
    """What the system and the libraries raise if a file cannot be written, as `InputError`."""
    try:
        _check_name(path)
        yield
    except BrokenPipeError:  # of a pipe whose reader has seen enough
        raise
    except OSError as error:
        raise _error(path, option, f"cannot be written: {_reason(error)}.", REMEDY) from None
    except RuntimeError as error:
        if not str(error).startswith("NetCDF: "):
            raise
        allowed = f"cannot be written: {error} (a full disk is one cause)."
        raise _error(path, option, allowed, REMEDY) from None


def _check_name(path: Path) -> None:
    if "\0" in str(path):
        raise OSError(errno.EINVAL, "no name has a zero character")


def _reason(error: OSError) -> str:
    return error.strerror or str(error)


def _error(path: Path, option: str, allowed: str, remedy: str) -> InputError:
    return InputError([Problem(option, str(path), allowed, remedy)], "the command")


# --- private folders, and what killed writers leave of them ---------------------------------------


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
    if fcntl is None:
        return None
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
