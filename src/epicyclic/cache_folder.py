"""Folders in which the package keeps what it would otherwise make at every start.

What is kept there is run as code, so that nobody else may be able to write to it.
"""

from __future__ import annotations

import os
import stat
import tempfile
from pathlib import Path

import platformdirs

_USER = os.getuid() if hasattr(os, "getuid") else None
"""Number of the user; None where temporary folders are those of one user anyway (Windows)."""


def private_folder(name: str) -> Path | None:
    """A folder of this user to which nobody else can write, made if need be; None if none can be.

    Without a home that can be written to things are kept until the machine starts again.
    """
    for has_home in (True, False):
        try:
            folder = Path(platformdirs.user_cache_dir("epicyclic")) / name
            if not has_home:
                folder = Path(tempfile.gettempdir()) / f"epicyclic-{_USER}" / name
            folder.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            folder.mkdir(mode=0o700, exist_ok=True)
        except OSError:
            continue
        if is_private(folder) and is_private(folder.parent) and os.access(folder, os.W_OK):
            return folder
    return None


def is_private(folder: Path) -> bool:
    """True if a folder is that of this user, and nobody else may write to it."""
    try:
        found = folder.stat()
    except OSError:
        return False
    others = found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
    return _USER is None or (found.st_uid == _USER and not others)
