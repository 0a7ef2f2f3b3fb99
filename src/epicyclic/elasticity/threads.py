"""Linear algebra on one thread.

The matrices here are small: threads cost more than they save. More than one would also round
differently, so that a sweep in many processes would not give the bits of one process.
"""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from functools import cache
from importlib import import_module

from threadpoolctl import ThreadpoolController


def one_thread() -> AbstractContextManager[object]:
    """A context in which matrix products and decompositions use one thread."""
    blas = _blas()
    if all(library.num_threads == 1 for library in blas.lib_controllers):
        return nullcontext()  # as in workers: to set limits takes a tenth of a solution
    context: AbstractContextManager[object] = blas.limit(limits=1)
    return context


@cache
def _blas() -> ThreadpoolController:
    import_module("scipy.linalg")  # compiled kernels call its library, which must be there first
    return ThreadpoolController().select(user_api="blas")
