"""The server of the app: one address on this machine, with a token."""

from __future__ import annotations

import secrets
import signal
import socket
import tempfile
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import NoReturn

import uvicorn
from fastapi import FastAPI
from nicegui import app as nicegui_app
from nicegui import ui

from epicyclic.case.messages import one_line
from epicyclic.errors import InputError, Problem
from epicyclic.plugins.app.case_form import Desk, Shelves
from epicyclic.plugins.app.guard import Guard
from epicyclic.plugins.app.page import Page, add_assets

LOOPBACK = ("127.0.0.1", "localhost", "::1")  # Addresses that only this machine can reach.
ANY = ("0.0.0.0", "::")  # Stand for every address of this machine.
_TOKEN_BYTES = 24
RECONNECT = 10.0  # For so long a page may be out of reach before its work ends. [s]
_OF_TAB = "tab"  # Key in the storage of a tab.
TERMINATED = 128 + signal.SIGTERM  # Exit code after a signal, as shells have it.


def serve(
    desk: Desk,
    host: str,  # The address that is listened at.
    port: int,  # 0 for any that is free.
    told: Callable[[str], None],  # Called with the address to open.
) -> None:
    """Serve a case until the command is interrupted."""
    token = secrets.token_urlsafe(_TOKEN_BYTES)
    with closing(_listening(host, port)) as listening:
        bound, found = listening.getsockname()[:2]
        names = names_of(host, bound)
        hosts = [f"{name}:{found}" for name in names]
        with _shelves(desk) as shelves:
            app = Guard(application(shelves), token, hosts)
            told(f"http://{hosts[0]}/?token={token}")
            config = uvicorn.Config(
                app, log_level="error", access_log=False, timeout_graceful_shutdown=1
            )
            uvicorn.Server(config).run(sockets=[listening])


def names_of(
    # host, bound: The address as the user names it, and as the system writes it, which browsers do
    # too.
    host: str,
    bound: str,
) -> list[str]:
    """What browsers may call the address; the first one is shown."""
    if host in LOOPBACK:
        names = [host, *LOOPBACK]
    elif bound in ANY:
        names = [*_own_names(), *LOOPBACK]
    else:
        names = [host.lower(), bound]
    return [f"[{name}]" if ":" in name else name for name in dict.fromkeys(names)]


def _own_names() -> list[str]:
    """The name of this machine and its addresses, as far as it knows them by its name."""
    own = socket.gethostname().lower()
    with suppress(OSError):
        return [own, *(str(found[4][0]) for found in socket.getaddrinfo(own, None))]
    return []


@contextmanager
def _shelves(desk: Desk) -> Iterator[Shelves]:
    """Processes and a folder that last as long as the server."""
    signal.signal(signal.SIGTERM, _leave)  # what is below would be skipped
    with tempfile.TemporaryDirectory(prefix="epicyclic-app-") as folder:
        shelves = Shelves(desk, Path(folder))
        try:
            yield shelves
        finally:
            shelves.close()


def _leave(number: int, frame: object) -> NoReturn:
    raise SystemExit(TERMINATED)


def _listening(host: str, port: int) -> socket.socket:
    """A socket that listens at an address, before anything else is started."""
    if not host:
        raise _not_listening(host, port, "no address would be every address of this machine")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listening = socket.socket(family, socket.SOCK_STREAM)
    try:
        listening.bind((host, port))
        listening.listen()  # who comes before the server is up waits
    except (OSError, OverflowError, TypeError) as error:  # the last of signs that no name has
        listening.close()
        raise _not_listening(host, port, getattr(error, "strerror", None) or str(error)) from None
    return listening


def _not_listening(host: str, port: int, told: str) -> InputError:
    address = one_line(f"{host}:{port}")
    problem = Problem("--host", address, f"cannot be listened at: {told}.", "Take another.")
    return InputError([problem], "the command")


def application(shelves: Shelves) -> FastAPI:
    """The pages, without anything that keeps others away."""
    app = FastAPI(openapi_url=None)

    async def root() -> None:
        await show(shelves)

    ui.run_with(
        app,
        root=root,
        title="Epicyclic",
        show_welcome_message=False,
        binding_refresh_interval=None,
        reconnect_timeout=RECONNECT,
    )
    return app


async def show(shelves: Shelves) -> None:
    """The page of the tab that asks for one, with the case that this tab had before."""
    add_assets()
    page = ui.context.client
    await page.connected()
    tab = page.tab_id
    if tab is None:
        return  # gone again
    known = nicegui_app.storage.tab
    shelf = shelves.take(tab, page.id, known.get(_OF_TAB, ""))
    known[_OF_TAB] = tab  # the storage is copied with a tab that is duplicated
    if shelf is None:
        ui.label(
            f"{shelves.most} tabs with this app are open, and no more can be: each computes by "
            "itself. Close one, and load this page again."
        ).classes("problem full")
        return
    page.on_delete(lambda: shelves.leave(tab, page.id))
    Page(shelf).build()
