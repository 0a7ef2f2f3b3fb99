"""What each tab of a browser has of its own: a case, and processes that work for it."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from epicyclic.app.desk import Desk
from epicyclic.app.worker import Worker

MOST_TABS = 8
"""That are open at a time: each has up to three processes of some 300 MB."""
MOST_KEPT = 50
"""Cases of tabs that are open or were, so that a tab that comes back finds its changes."""
BEHIND = 5
"""Niceness of what may take longer than key figures."""


@dataclass
class Shelf:
    """What is kept for one tab while its page is loaded again."""

    desk: Desk  # The case that is open.
    folder: Path  # For uploaded files.
    chapter: str = ""  # That is open.
    # Follows every value of an input; draws what takes longer; computes maps.
    quick: Worker = field(default_factory=Worker)
    slow: Worker = field(default_factory=lambda: Worker(BEHIND))
    maps: Worker = field(default_factory=lambda: Worker(BEHIND))

    @property
    def workers(self) -> Iterator[Worker]:
        """All of them."""
        yield from (self.quick, self.slow, self.maps)

    def close(self) -> None:
        """End all work."""
        for worker in self.workers:
            worker.close()


class Shelves:
    """The shelves of all tabs.

    Parameters
    ----------
    desk : Desk
        The case that tabs begin with.
    folder : Path
        For uploaded files.
    most : int
        Tabs that may be open at a time.
    """

    def __init__(self, desk: Desk, folder: Path, most: int = MOST_TABS) -> None:
        self._desk, self._folder, self.most = desk, folder, most
        self._kept: dict[str, Shelf] = {}
        self._pages: dict[str, str] = {}

    def take(
        self,
        # tab, page: What the tab and its present page are called; a page that is loaded again is
        # another.
        tab: str,
        page: str,
        before: str = "",  # The tab that this one was duplicated from.
    ) -> Shelf | None:
        """The shelf of a tab; None if too many are open."""
        is_open = tab in self._pages
        if not is_open and len(self._pages) >= self.most:
            return None
        shelf = self._kept.pop(tab, None)
        if shelf is None:
            origin = self._kept[before].desk if before in self._kept else self._desk
            shelf = Shelf(origin.copy(), Path(tempfile.mkdtemp(dir=self._folder)))
        elif not is_open:
            shelf = Shelf(shelf.desk, shelf.folder, shelf.chapter)
        self._kept[tab] = shelf
        self._pages[tab] = page
        self._forget()
        return shelf

    def leave(self, tab: str, page: str) -> None:
        """End the work for a tab, if it shows that page still."""
        if self._pages.get(tab) == page:
            del self._pages[tab]
            self._kept[tab].close()

    def close(self) -> None:
        """End all work."""
        for shelf in self._kept.values():
            shelf.close()

    def _forget(self) -> None:
        """Forget the tabs that were closed longest ago."""
        closed = [tab for tab in self._kept if tab not in self._pages]
        for tab in closed[: max(0, len(self._kept) - MOST_KEPT)]:
            shutil.rmtree(self._kept.pop(tab).folder, ignore_errors=True)
