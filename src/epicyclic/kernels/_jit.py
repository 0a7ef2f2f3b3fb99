"""The one decorator for compiled kernels, and where their machine code is kept.

numba's own cache looks at the file that defines a kernel, not at the kernels it calls, so an edited
callee in another file would leave stale physics in its callers. The cache folder is therefore named
after the content of every kernel file.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import numba
import platformdirs

__all__ = ["kernel"]

P = ParamSpec("P")
R = TypeVar("R")


_USER = os.getuid() if hasattr(os, "getuid") else None
"""Number of the user; None where temporary folders are those of one user anyway (Windows)."""


def cache_directory(kernel_folder: Path) -> Path | None:
    """Folder for the machine code of the kernels now in `kernel_folder`; None if there is none."""
    digest = hashlib.sha256()
    for source in sorted(kernel_folder.glob("*.py")):
        digest.update(source.read_bytes())
    name = f"kernels-{digest.hexdigest()[:16]}"
    folder = Path(platformdirs.user_cache_dir("epicyclic")) / name
    # without a home that can be written to: compile once for each start of the machine
    temporary = Path(tempfile.gettempdir()) / f"epicyclic-{_USER}" / name
    return folder if _is_own(folder) else temporary if _is_own(temporary) else None


def _is_own(folder: Path) -> bool:
    """True if nobody else can have put machine code into `folder`, made if need be."""
    try:
        folder.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        folder.mkdir(mode=0o700, exist_ok=True)
        owners = {path.stat().st_uid for path in (folder, folder.parent)}
    except OSError:
        return False
    return os.access(folder, os.W_OK) and (_USER is None or owners == {_USER})


_CACHE_DIR = (
    Path(os.environ["NUMBA_CACHE_DIR"])
    if "NUMBA_CACHE_DIR" in os.environ
    else cache_directory(Path(__file__).parent)
)


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile `function` at first call and keep the machine code on disk.

    ``fastmath`` stays off, because it makes NaN checks vanish; division by zero gives inf, and
    callers check that results are finite.
    """
    config: Any = numba.config
    previous = config.CACHE_DIR
    config.CACHE_DIR = str(_CACHE_DIR or "")
    try:
        compiled: Callable[P, R] = numba.njit(
            cache=_CACHE_DIR is not None, fastmath=False, error_model="numpy", nogil=True
        )(function)
    finally:
        config.CACHE_DIR = previous
    return compiled
