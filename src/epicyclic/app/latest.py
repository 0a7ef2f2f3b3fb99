"""Work that follows what changes faster than it can be done."""

from __future__ import annotations

from collections.abc import Awaitable, Callable


class Latest:
    """Does work again after each change, for the last one: what comes meanwhile never queues.

    Work that has begun is done to its end, so that it follows a value that never stands still.

    Parameters
    ----------
    work : callable
        Looks itself at what is to be done.
    """

    def __init__(self, work: Callable[[], Awaitable[None]]) -> None:
        self._work = work
        self._wanted = 0
        self._is_running = False

    async def want(self) -> None:
        """Have the work done for what is now; returns at once if it is being done for before."""
        self._wanted += 1
        if self._is_running:
            return
        self._is_running = True
        try:
            done = 0
            while done != self._wanted:
                done = self._wanted
                await self._work()
        finally:
            self._is_running = False
