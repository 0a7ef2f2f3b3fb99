"""The page, the server that gives it, and who may talk to it."""

from __future__ import annotations

import asyncio
import hmac
import secrets
import signal
import socket
import sys
import tempfile
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import closing, suppress
from functools import partial
from importlib import resources
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI
from nicegui import app as nicegui_app
from nicegui import events, ui
from starlette.datastructures import MutableHeaders
from starlette.requests import HTTPConnection
from starlette.responses import PlainTextResponse, RedirectResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocketClose

from epicyclic import library
from epicyclic.case.case import Case
from epicyclic.errors import EpicyclicError, InputError, one_problem
from epicyclic.messages import one_line
from epicyclic.plugins.app import worker as tasks
from epicyclic.plugins.app.case_form import ENDINGS, Desk, Shelf, Shelves, built_in, received
from epicyclic.plugins.app.fields import Form
from epicyclic.plugins.app.views import (
    Chapters,
    CompareView,
    DesignView,
    Do,
    Failure,
    MapView,
    View,
    download,
    key_figures,
    mark_behind,
    save_menu,
)
from epicyclic.plugins.app.worker import Doing, Latest, Study
from epicyclic.show.page import KeyFigure

# Who may talk to the app: browsers of this machine that know its token.


LARGEST_BODY = 10_000_000
"""Largest request: a case file is a page of text, a REXS file may have some megabytes. [bytes]"""
_MOST_DIGITS = 20  # Most digits of the length of a request; Python refuses to read thousands.
_USUAL_PORT = 80
_FORBIDDEN, _TOO_LARGE, _SEE_OTHER = 403, 413, 303
_CLOSED = 1008  # Code of a websocket that is refused: against the policy.

HEADERS = {
    "content-security-policy": "default-src 'self'; script-src 'self' 'unsafe-inline' "
    "'unsafe-eval'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' "
    "data:; form-action 'self'; base-uri 'self'; frame-ancestors 'none'; object-src 'none'",
    "referrer-policy": "no-referrer",
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
}
"""Headers of every answer: a page loads nothing from elsewhere and stands in no other page."""


class Guard:
    """An ASGI application before another one; refuses what does not come from its own page.

    The token is in the first address, and from then on in a cookie. A name with port that is not
    among the hosts, but leads to this machine, is an attack by rebinding.
    """

    def __init__(self, app: ASGIApp, token: str, hosts: Collection[str]) -> None:
        self.app, self.token, self.hosts = app, token, frozenset(hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Refuse, let in with a cookie, or hand on."""
        if scope["type"] in ("http", "websocket"):
            answering = self._answering(HTTPConnection(scope))
            await answering(scope, _bounded(receive), _with_headers(send))
        else:
            await self.app(scope, receive, send)

    def _answering(self, asked: HTTPConnection) -> ASGIApp:
        """The application that answers."""
        # a header given twice is a list, and none of what may be
        headers = {name: ", ".join(asked.headers.getlist(name)) for name in asked.headers}
        if not self._is_own(headers):
            return _refusal(asked, _FORBIDDEN, "This is not the address of the app.")
        if asked.scope["type"] == "http" and self._has_token(asked):
            cookie = f"{self._name}={self.token}; Path=/; HttpOnly; SameSite=Strict"
            return RedirectResponse("/", _SEE_OTHER, {"set-cookie": cookie})
        if not self._is_token(asked.cookies.get(self._name, "")):
            text = "Open the address with its token, as printed by the command."
            return _refusal(asked, _FORBIDDEN, text)
        length = headers.get("content-length", "0")
        is_number = length.isdecimal() and len(length) <= _MOST_DIGITS
        if not is_number or int(length) > LARGEST_BODY:
            return _refusal(asked, _TOO_LARGE, "This is too large.")
        return self.app

    def _is_own(self, headers: Mapping[str, str]) -> bool:
        """True if the browser has the page from here, as far as it tells."""
        host, origin = headers.get("host", ""), headers.get("origin")
        # browsers leave out the port that addresses have by themselves
        full = host if ":" in host.rpartition("]")[2] else f"{host}:{_USUAL_PORT}"
        return full in self.hosts and origin in (None, f"http://{host}")

    def _has_token(self, asked: HTTPConnection) -> bool:
        is_page = asked.scope["method"] == "GET" and asked.scope["path"] == "/"
        return is_page and self._is_token(asked.query_params.get("token", ""))

    def _is_token(self, given: str) -> bool:
        return hmac.compare_digest(given.encode(), self.token.encode())

    @property
    def _name(self) -> str:
        """Name of the cookie: browsers do not tell ports apart."""
        return f"epicyclic-{min(self.hosts).rpartition(':')[2]}"


def _refusal(asked: HTTPConnection, status: int, text: str) -> ASGIApp:
    if asked.scope["type"] == "websocket":
        return WebSocketClose(_CLOSED, text)
    return PlainTextResponse(text, status)


def _bounded(receive: Receive) -> Receive:
    """Ends a request that turns out too large, whatever it said of its length."""
    total = 0

    async def call() -> Message:
        nonlocal total
        message = await receive()
        if message["type"] == "http.request":
            total += len(message.get("body", b""))
            if total > LARGEST_BODY:
                return {"type": "http.disconnect"}
        return message

    return call


def _with_headers(send: Send) -> Send:
    async def call(message: Message) -> None:
        if message["type"] == "http.response.start":
            message.setdefault("headers", [])
            MutableHeaders(scope=message).update(HEADERS)
        await send(message)

    return call


# Opening and saving: files go through the browser, never by a path on the page.


CASE_FILE = ".toml"
RESULTS = {
    CASE_FILE: "Case file, .toml",
    ".nc": "Result with all fields, .nc",
    ".json": "Result as JSON, .json",
    ".html": "Report, .html",
    ".pdf": "Report, .pdf",
    ".rexs": "REXS file with the results, .rexs",
}
MOST_FILES = 20


def ask_for_case(
    folder: Path,  # In which uploaded files are kept, each time in a new folder.
    then: Callable[[Desk], None],
) -> None:
    """Ask for a case, built in or a file of the user; call `then` with its desk."""
    with ui.dialog() as dialog, ui.card().classes("asking"):
        ui.label("Open a case").classes("section")
        told = ui.label("").classes("told")

        def take(make: Callable[[], Desk]) -> None:
            try:
                desk = make()
            except InputError as error:
                # where a received file lies is of no use to who sent it
                told.set_text(str(InputError(error.problems, Path(error.source).name)))
                return
            dialog.close()
            then(desk)

        async def upload(event: events.MultiUploadEventArguments) -> None:
            files = [(file.name, await file.read()) for file in event.files]
            own = Path(tempfile.mkdtemp(dir=folder))
            take(lambda: received(files, own))

        with ui.row():
            for name in library.names("cases"):
                ui.button(name, on_click=lambda name=name: take(lambda: built_in(name))).props(
                    "outline no-caps dense"
                )
        ui.label(f"Or your own file, {', '.join(ENDINGS)}, with the files that it names:").classes(
            "soft"
        )
        ui.upload(
            label="Drop files here, or choose them",
            multiple=True,
            max_file_size=LARGEST_BODY,
            max_total_size=LARGEST_BODY,
            max_files=MOST_FILES,
            auto_upload=True,
            on_multi_upload=upload,
            on_rejected=lambda: told.set_text(f"Files of up to {LARGEST_BODY // 10**6} MB."),
        ).props("flat bordered").classes("upload")
    dialog.open()


def case_menu(desk: Callable[[], Desk], do: Do) -> None:
    """A menu of all that can be saved of a case."""

    async def save(ending: str) -> None:
        now = desk()
        if ending == CASE_FILE:
            ui.download(now.text().encode(), f"{_stem(now)}{ending}")
        elif now.case is None:
            ui.notify("The case has problems. Correct them first.")
        else:
            original = now.original if ending == ".rexs" else None
            suffix = Path(original).suffix if original else ending
            await download(do, Study(now.case), suffix, original, _stem(now))

    save_menu("Save", RESULTS, save)


def _stem(desk: Desk) -> str:
    return Path(desk.source).stem or "case"


# The page: the form of a case on the left, what follows from it on the right.


_TURN_OVER = "() => document.querySelector('.desk').classList.toggle('editing')"
"""Where there is no room for both, the form is shown in the place of the results, or back."""
_VERBS = {"run": (), "check": (), "report": ("-o", "report.html")}
"""Commands that do what the page does, and what they need more."""


# NiceGUI also resizes a chart that was removed while its script was loading.
_GONE = """addEventListener("unhandledrejection", (event) => {
  if (String(event.reason).includes("displayed plot div")) event.preventDefault();
});"""


def add_assets() -> None:
    """What the page needs before it is connected."""
    files = resources.files("epicyclic.plugins.app")
    style, script = ((files / it).read_text(encoding="utf-8") for it in ("app.css", "turning.js"))
    ui.add_css(style)
    ui.add_body_html(f"<script>{script}{_GONE}</script>")


class Page:
    """What a browser shows of the open case."""

    def __init__(self, shelf: Shelf) -> None:
        self._shelf = shelf
        self._is_moving = False
        self._banded: Case | None = None  # Whose bands are shown.
        self._quick = Latest(self._follow_figures)
        self._slow = Latest(self._follow_chapters)

    @property
    def desk(self) -> Desk:
        """The open case."""
        return self._shelf.desk

    def build(self) -> None:
        """Make the page; results follow when they are known."""
        shelf = self._shelf
        with ui.header().classes("bar"):
            ui.label("Epicyclic").classes("name")
            self._title = ui.label().classes("title")
            ui.space()
            show = ui.button("Inputs", icon="edit").props("flat no-caps").classes("narrow")
            show.on("click", js_handler=_TURN_OVER)
            ask = partial(self._choose, self._open)
            ui.button("Open", icon="folder_open", on_click=ask).props("flat no-caps")
            case_menu(lambda: self.desk, self._do)
            ui.button("Command", icon="terminal", on_click=self._show_command).props("flat no-caps")
        with ui.element("div").classes("desk"):
            self._form_place = ui.element("aside")
            with ui.element("section").classes("results"):
                self._problems = ui.element("div").classes("problems")
                self._failed = Failure()
                with ui.element("div") as self._results:
                    self._figures = ui.element("div").classes("key-figures")
                    self._doing = Doing(shelf.slow.end)
                    views: dict[str, View] = {
                        "map": MapView(lambda: self.desk, shelf.maps),
                        "compare": CompareView(lambda: self.desk, self._do, self._choose),
                        "designs": DesignView(shelf.folder, shelf.maps, self._open_design),
                    }
                    self._chapters = Chapters(
                        shelf, self._do, views, self._slow.want, self._show_figures
                    )
        self._build_form()
        ui.timer(0, self._follow, once=True)

    def _build_form(self) -> None:
        self._form_place.clear()
        with self._form_place:
            self._form = Form(self.desk, self._follow, partial(self._follow, is_moving=True))

    def _choose(self, then: Any) -> None:
        ask_for_case(self._shelf.folder, then)

    def _open(self, desk: Desk) -> None:
        self._shelf.desk = desk
        self._figures.clear()
        self._chapters.clear()
        self._build_form()
        with self._results:
            ui.timer(0, self._follow, once=True)

    def _open_design(self, desk: Desk) -> None:
        """Show what follows from a design, in place of the front that it was chosen from."""
        self._shelf.chapter = ""
        self._open(desk)

    async def _do(self, *work: Any) -> Any:
        return await self._shelf.slow.do(*work, progress=self._doing.progress)

    async def _follow(self, *, is_moving: bool = False) -> None:
        """After a change of the case, or while an input moves."""
        self._is_moving = is_moving
        self._tell()
        if self.desk.case is not None:
            self._chapters.age(Study(self.desk.case))
            await asyncio.gather(self._quick.want(), self._slow.want())

    def _tell(self) -> None:
        """Title and problems of the case as it is."""
        self._title.set_text(self.desk.title)
        self._form.show_problems()
        self._problems.clear()
        with self._problems:
            for problem in self.desk.problems:
                ui.label(str(problem)).classes("problem")
        self._failed.tell("")
        self._results.classes(**{"add" if self.desk.problems else "remove": "stale"})
        mark_behind(self._figures, self.desk.case is not None)

    async def _follow_figures(self) -> None:
        """Key figures of the case as it is."""
        desk, case = self.desk, self.desk.case
        if case is None:
            return
        try:
            figures = await self._shelf.quick.do(tasks.moved, case, progress=self._doing.progress)
        except EpicyclicError:
            return  # what follows the chapters says it
        if desk is self.desk and self._banded != case:
            self._show_figures(Study(case), figures)

    def _show_figures(self, study: Study, figures: Sequence[KeyFigure]) -> None:
        """Key figures of a study, with their bands if these are known."""
        if self._figures.is_deleted:
            return
        if any(figure.band for figure in figures):
            self._banded = study.case
        self._figures.clear()
        with self._figures:
            key_figures(figures)
        mark_behind(self._figures, study.case != self.desk.case)

    async def _follow_chapters(self) -> None:
        """All else of the case as it is."""
        case = self.desk.case
        if case is None:
            return
        self._failed.tell("")  # what was cancelled is of an earlier case
        study = Study(case)

        def is_wanted() -> bool:
            """A picture that lags behind is better than none while an input moves."""
            return self._is_moving or case is self.desk.case

        def is_at_rest() -> bool:
            return not self._is_moving and case is self.desk.case

        try:
            with self._doing.shown("solving"):
                await self._chapters.follow(study, is_wanted)
                if is_at_rest():
                    await self._chapters.complete(study, is_at_rest)
        except EpicyclicError as error:
            self._failed.tell(str(error))
        if self.desk.case is not None and not self._figures.is_deleted:
            self._chapters.age(Study(self.desk.case))

    def _show_command(self) -> None:
        with ui.dialog() as dialog, ui.card().classes("command"):
            ui.label("Equivalent command")
            for verb, more in _VERBS.items():
                ui.code(self.desk.command(verb, *more), language="bash").classes("wrapped")
        dialog.open()


# The server of the app: one address on this machine, with a token.


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
        hosts = [f"{name}:{found}" for name in names_of(host, bound)]
        # else folder and processes would be left
        signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(TERMINATED))
        with (
            tempfile.TemporaryDirectory(prefix="epicyclic-app-") as folder,
            closing(Shelves(desk, Path(folder))) as shelves,
        ):
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


def _listening(host: str, port: int) -> socket.socket:
    """A socket that listens at an address, before anything else is started."""
    if not host:
        told = "an empty address would mean every address of this machine"
        raise _not_listening(host, port, told)
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
    allowed = f"cannot be used as a server address: {told}."
    address = one_line(f"{host}:{port}")
    return one_problem("--host", address, allowed, "Choose another.", "the command")


def application(shelves: Shelves) -> FastAPI:
    """The pages, without anything that keeps others away."""
    app = FastAPI(openapi_url=None)
    ui.run_with(
        app,
        root=partial(show, shelves),
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
            f"{shelves.most} tabs with this app are open, which is the limit because each "
            "computes separately. Close one and reload this page."
        ).classes("problem full")
        return
    page.on_delete(lambda: shelves.leave(tab, page.id))
    Page(shelf).build()
