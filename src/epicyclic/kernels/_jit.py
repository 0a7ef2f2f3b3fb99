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


def cache_directory(kernel_folder: Path) -> Path:
    """Folder for the machine code of the kernels now in `kernel_folder`."""
    digest = hashlib.sha256()
    for source in sorted(kernel_folder.glob("*.py")):
        digest.update(source.read_bytes())
    name = f"kernels-{digest.hexdigest()[:16]}"
    folder = Path(platformdirs.user_cache_dir("epicyclic")) / name
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:  # a home that cannot be written to: compile once for each start of the machine
        folder = Path(tempfile.gettempdir()) / f"epicyclic-{name}"
    return folder


_CACHE_DIR = (
    os.environ["NUMBA_CACHE_DIR"]
    if "NUMBA_CACHE_DIR" in os.environ
    else str(cache_directory(Path(__file__).parent))
)


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile `function` at first call and keep the machine code on disk.

    ``fastmath`` stays off, because it makes NaN checks vanish; division by zero gives inf, and
    callers check that results are finite.
    """
    config: Any = numba.config
    previous = config.CACHE_DIR
    config.CACHE_DIR = _CACHE_DIR
    try:
        compiled: Callable[P, R] = numba.njit(
            cache=True, fastmath=False, error_model="numpy", nogil=True
        )(function)
    finally:
        config.CACHE_DIR = previous
    return compiled
