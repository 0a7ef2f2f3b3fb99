"""Linear algebra on one thread.

The matrices here are small: threads cost more than they save. More than one would also round
differently, so that a sweep in many processes would not give the bits of one process.
"""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from functools import cache
from importlib import import_module

from threadpoolctl import ThreadpoolController

__all__ = ["one_thread"]


def one_thread() -> AbstractContextManager[object]:
    """A context in which matrix products and decompositions use one thread."""
    if _has_one_thread():
        return nullcontext()
    context: AbstractContextManager[object] = _controller().limit(limits=1, user_api="blas")
    return context


@cache
def _has_one_thread() -> bool:
    """True in a process that was started so, as workers are: limits take a tenth of a solution."""
    return all(
        library["num_threads"] == 1
        for library in _controller().info()
        if library["user_api"] == "blas"
    )


@cache
def _controller() -> ThreadpoolController:
    import_module("scipy.linalg")  # compiled kernels call its library, which must be there first
    return ThreadpoolController()
