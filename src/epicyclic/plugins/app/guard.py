"""Who may talk to the app: browsers of this machine that know its token."""

from __future__ import annotations

import hmac
from collections.abc import Collection, Mapping
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs

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

    Parameters
    ----------
    app : ASGI application
    token : str
        In the first address; a cookie has it from then on.
    hosts : collection of str
        What the browser may call the app, with the port: another name that leads to this machine
        is an attack by rebinding.
    """

    def __init__(self, app: Any, token: str, hosts: Collection[str]) -> None:
        self.app, self.token, self.hosts = app, token, frozenset(hosts)

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Refuse, let in with a cookie, or hand on."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = {
            name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]
        }
        if not self._is_own(headers):
            await _refuse(scope, receive, send, _FORBIDDEN, "This address is not that of the app.")
        elif scope["type"] == "http" and self._has_token(scope):
            await _answer(send, _SEE_OTHER, "", {"location": "/", "set-cookie": self._cookie()})
        elif self._has_cookie(headers):
            await self._hand_on(scope, receive, send, headers)
        else:
            text = "Open the address with its token, as the command has printed it."
            await _refuse(scope, receive, send, _FORBIDDEN, text)

    def _is_own(self, headers: Mapping[str, str]) -> bool:
        """True if the browser has the page from here, as far as it tells."""
        host, origin = headers.get("host", ""), headers.get("origin")
        # browsers leave out the port that addresses have by themselves
        full = host if ":" in host.rpartition("]")[2] else f"{host}:{_USUAL_PORT}"
        return full in self.hosts and origin in (None, f"http://{host}")

    def _has_cookie(self, headers: Mapping[str, str]) -> bool:
        try:
            found = SimpleCookie(headers.get("cookie", "")).get(self._name)
        except CookieError:
            return False
        return found is not None and self._is_token(found.value)

    def _has_token(self, scope: Any) -> bool:
        given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])
        return bool(scope["method"] == "GET" and scope["path"] == "/" and self._is_token(given[0]))

    def _is_token(self, given: str) -> bool:
        return hmac.compare_digest(given.encode(), self.token.encode())

    @property
    def _name(self) -> str:
        """Name of the cookie: browsers do not tell ports apart."""
        return f"epicyclic-{min(self.hosts).rpartition(':')[2]}"

    def _cookie(self) -> str:
        return f"{self._name}={self.token}; Path=/; HttpOnly; SameSite=Strict"

    async def _hand_on(
        self, scope: Any, receive: Any, send: Any, headers: Mapping[str, str]
    ) -> None:
        length = headers.get("content-length", "0")
        is_number = length.isdecimal() and len(length) <= _MOST_DIGITS
        if not is_number or int(length) > LARGEST_BODY:
            await _refuse(scope, receive, send, _TOO_LARGE, "This is too large.")
            return
        await self.app(scope, _bounded(receive), _with_headers(send))


def _bounded(receive: Any) -> Any:
    """Ends a request that turns out too large, whatever it said of its length."""
    total = 0

    async def call() -> Any:
        nonlocal total
        message = await receive()
        if message["type"] == "http.request":
            total += len(message.get("body", b""))
            if total > LARGEST_BODY:
                return {"type": "http.disconnect"}
        return message

    return call


def _with_headers(send: Any) -> Any:
    async def call(message: Any) -> None:
        if message["type"] == "http.response.start":
            added = [(name.encode(), value.encode()) for name, value in HEADERS.items()]
            message = {**message, "headers": [*message.get("headers", ()), *added]}
        await send(message)

    return call


async def _refuse(scope: Any, receive: Any, send: Any, status: int, text: str) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": _CLOSED, "reason": text})
    else:
        await _answer(send, status, text, {})


async def _answer(send: Any, status: int, text: str, headers: Mapping[str, str]) -> None:
    body = text.encode()
    head = HEADERS | {"content-type": "text/plain; charset=utf-8", "content-length": str(len(body))}
    pairs = [(name.encode(), value.encode()) for name, value in (head | dict(headers)).items()]
    await send({"type": "http.response.start", "status": status, "headers": pairs})
    await send({"type": "http.response.body", "body": body})
