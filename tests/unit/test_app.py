"""The app without a browser: form, changes, commands, the guard, the simulated page."""

from __future__ import annotations

import asyncio
import shlex

import pytest
from click.testing import CliRunner

pytest.importorskip("nicegui", reason="optional")

import app_tasks
from epicyclic.app import tasks
from epicyclic.app.desk import Desk, built_in, opened, received
from epicyclic.app.form import form_of
from epicyclic.app.guard import LARGEST_BODY, Guard
from epicyclic.app.serve import names_of
from epicyclic.app.worker import Ended, Worker, WorkError
from epicyclic.case.fields import all_keys
from epicyclic.errors import InputError

TOKEN, HOST = "the-token", "127.0.0.1:4711"


# --- the form -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["talbot-2012", "talbot-2012-pair"])
def test_the_form_has_every_key_of_the_schema_that_holds_a_value(name):
    desk = opened(name)
    shown = {entry.key for entry in desk.form().walk()}
    presets = (".material.", "lubricant.oil.", "NAME")
    expected = {key for key in all_keys(type(desk.case)) if not any(one in key for one in presets)}
    assert expected - shown == {"kind"}


def test_numbers_are_shown_in_the_unit_of_the_field_and_typed_in_it(talbot):
    entries = {entry.key: entry for entry in form_of(talbot.given()).walk()}
    torque = entries["operation.torque"]
    assert (torque.text, torque.unit) == ("1000", "N·m")
    assert torque.value("730") == "730 N*m"
    assert torque.value("0.73 kN*m") == "0.73 kN*m"
    assert torque.value("  ") is None
    faster = form_of(talbot.updated({"operation.speed": "25 rev/s"}).given())
    assert {it.key: it.text for it in faster.walk()}["operation.speed"] == "1500"


def test_fields_of_a_train_are_those_of_its_sets():
    keys = {entry.key for entry in opened("train-eaxle").form().walk()}
    assert {"operation.speed", "sets.planets.sun.teeth", "sets.pair.gears.normal_module"} <= keys


# --- changes --------------------------------------------------------------------------------------


def test_a_wrong_value_is_a_problem_of_its_field_and_the_case_is_not_solved():
    desk = opened("talbot-2012")
    desk.change("operation.torque", "3 kg")
    assert desk.case is None
    (problem,) = desk.problems_of("operation.torque")
    assert "unit" in problem.allowed
    desk.change("operation.torque", "310 N*m")
    assert desk.case is not None
    assert not desk.problems
    assert desk.changes == {"operation.torque": "310 N*m"}


def test_what_is_put_back_is_no_change():
    desk = opened("talbot-2012")
    desk.change("operation.torque", "310 N*m")
    desk.change("operation.torque", desk.tables["operation"]["torque"])
    assert desk.changes == {}


def test_the_command_gives_the_same_case():
    from epicyclic.cli.options import load_with

    desk = opened("talbot-2012")
    desk.change("operation.torque", "310 N*m")
    desk.change("planet.count", 5)
    desk.change("models.friction", None)
    desk.change("title", "a b' c")
    words = shlex.split(desk.command())
    assert words[:3] == ["epicyclic", "run", "talbot-2012"]
    assert load_with(words[2], words[4::2]) == desk.case


# --- who may talk to it ---------------------------------------------------------------------------


async def _inner(scope, receive, send):
    if scope["type"] == "http":
        more = True
        while more:
            message = await receive()
            more = message.get("more_body", False)
        status = 200 if message["type"] == "http.request" else 499
        await send({"type": "http.response.start", "status": status, "headers": []})
        await send({"type": "http.response.body", "body": b"inside"})
    else:
        await send({"type": "websocket.accept"})


def _ask(kind="http", path="/", query="", bodies=(b"",), **headers):
    """What the guard sends."""
    sent = []
    messages = [
        {"type": "http.request", "body": body, "more_body": number + 1 < len(bodies)}
        for number, body in enumerate(bodies)
    ]

    async def receive():
        return messages.pop(0) if kind == "http" else {"type": "websocket.connect"}

    async def send(message):
        sent.append(message)

    scope = {
        "type": kind,
        "method": "GET",
        "path": path,
        "query_string": query.encode(),
        "headers": [
            (name.replace("_", "-").encode(), text.encode())
            for name, text in ({"host": HOST} | headers).items()
        ],
    }
    asyncio.run(Guard(_inner, TOKEN, [HOST])(scope, receive, send))
    return sent


COOKIE = f"epicyclic-4711={TOKEN}"


def test_the_token_in_the_address_becomes_a_cookie():
    first = _ask(query=f"token={TOKEN}")[0]
    headers = dict(first["headers"])
    assert first["status"] == 303
    assert headers[b"location"] == b"/"
    assert COOKIE in headers[b"set-cookie"].decode()
    for word in ("HttpOnly", "SameSite=Strict"):
        assert word in headers[b"set-cookie"].decode()
    assert _ask(cookie=COOKIE)[1]["body"] == b"inside"
    assert _ask(query=f"token={TOKEN}", cookie=COOKIE)[0]["status"] == 303


@pytest.mark.parametrize(
    ("query", "headers"),
    [
        ("", {}),
        ("token=wrong", {}),
        ("token=", {}),
        ("", {"cookie": "epicyclic-4711=wrong"}),
        ("", {"cookie": "epicyclic-4712=the-token"}),
        (f"token={TOKEN}", {"host": "evil.example:4711"}),
        ("", {"cookie": COOKIE, "host": "evil.example:4711"}),
        ("", {"cookie": COOKIE, "host": "127.0.0.1:80"}),
        ("", {"cookie": COOKIE, "origin": "http://evil.example"}),
        ("", {"cookie": COOKIE, "origin": "null"}),
        ("", {"cookie": COOKIE, "origin": "http://127.0.0.1:80"}),
    ],
)
@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_others_are_refused_also_at_the_websocket(kind, query, headers):
    first = _ask(kind, query=query, **headers)[0]
    refused = {"http": first.get("status") == 403, "websocket": first["type"] == "websocket.close"}
    assert refused[kind]


def test_the_token_opens_no_websocket_and_no_other_path():
    assert _ask("websocket", query=f"token={TOKEN}")[0]["type"] == "websocket.close"
    assert _ask(path="/_nicegui/x", query=f"token={TOKEN}")[0]["status"] == 403
    assert _ask("websocket", cookie=COOKIE)[0]["type"] == "websocket.accept"
    assert (
        _ask("websocket", cookie=COOKIE, origin=f"http://{HOST}")[0]["type"] == "websocket.accept"
    )


def test_what_is_too_large_is_refused_whatever_it_says():
    assert _ask(cookie=COOKIE, content_length=str(LARGEST_BODY + 1))[0]["status"] == 413
    assert _ask(cookie=COOKIE, content_length="many")[0]["status"] == 413
    part = b"x" * (LARGEST_BODY // 2 + 1)
    assert _ask(cookie=COOKIE, bodies=(part, part))[0]["status"] == 499
    assert _ask(cookie=COOKIE, bodies=(part, b"x"))[0]["status"] == 200


def test_every_answer_forbids_what_lies_elsewhere():
    for sent in (_ask(), _ask(cookie=COOKIE), _ask(query=f"token={TOKEN}")):
        headers = dict(sent[0]["headers"])
        assert b"default-src 'self'" in headers[b"content-security-policy"]
        assert headers[b"x-frame-options"] == b"DENY"


def test_a_port_that_is_taken_and_a_case_that_is_none_are_told():
    import socket

    from epicyclic.cli.app import app

    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        options = ["talbot-2012", "--port", str(taken.getsockname()[1]), "--no-browser"]
        found = CliRunner().invoke(app, options)
    assert isinstance(found.exception, InputError)
    assert "cannot be listened at" in str(found.exception)
    assert isinstance(CliRunner().invoke(app, ["talbot-2013"]).exception, InputError)


# --- the page -------------------------------------------------------------------------------------


class _Here:
    """In place of the worker: does the work here, but for pictures."""

    async def do(self, task, *arguments, progress):
        return b"<svg></svg>" if task is tasks.picture else task(*arguments, progress)

    def end(self):
        pass


@pytest.fixture
def simulate(tmp_path):
    from nicegui.testing import user_simulation

    from epicyclic.app.page import Page, Shelf

    def run(desk: Desk, script) -> None:
        async def root():
            await Page(Shelf(desk, _Here(), _Here(), tmp_path)).build()

        async def visit():
            async with user_simulation(root=root) as user:
                await user.open("/")
                await script(user)

        asyncio.run(visit())

    return run


def test_the_page_shows_form_and_losses_and_the_message_beside_a_wrong_field(simulate):
    desk = opened("talbot-2012-pair")
    desk.change("losses.mesh_pocketing.include", False)

    async def script(user):
        await user.should_see("Talbot 2012, Table 4.1")
        await user.should_see("total loss", retries=200)
        found = user.find(marker="operation.torque")
        (field,) = found.elements
        found.clear().type("3 kg").trigger("change")
        await user.should_see("has a unit that measures something else", retries=50)
        assert "measures something else" in field.error
        assert desk.case is None

    simulate(desk, script)


def test_another_case_is_opened_and_a_group_shows_its_fields_when_it_is_opened(simulate):
    desk = opened("talbot-2012-pair")
    desk.change("losses.mesh_pocketing.include", False)

    async def script(user):
        await user.should_see("total loss", retries=200)
        await user.should_not_see(marker="gears.normal_module")
        user.find(marker="group-gears").click()
        (box,) = user.find(marker="group-gears").elements
        box.set_value(True)
        await user.should_see(marker="gears.normal_module", retries=50)
        user.find("Compare").click()
        await user.should_see("Keep the case, change it", retries=50)
        user.find("Command").click()
        await user.should_see("epicyclic run talbot-2012-pair", retries=50)

    simulate(desk, script)


# --- files ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", ["/etc/passwd", "../secret.json", "C:\\secret.json", ".."])
def test_no_path_on_the_machine_is_opened(path, tmp_path, talbot):
    desk = opened("talbot-2012")
    desk.change("models.oil_model", path)
    (problem,) = desk.problems_of("models.oil_model")
    assert "beside the case" in problem.allowed
    assert desk.case is None
    tables = talbot.given()
    text = Desk("x", tables | {"models": {"oil_model": path}}, lambda changes: talbot).text()
    with pytest.raises(InputError, match="beside the case"):
        received("mine.toml", {"mine.toml": text.encode()}, tmp_path)


def test_an_uploaded_name_cannot_leave_its_folder(tmp_path, talbot):
    text = Desk("x", talbot.given(), lambda changes: talbot).text()
    folder = tmp_path / "own"
    folder.mkdir()
    desk = received("../mine.toml", {"../mine.toml": text.encode()}, folder)
    assert desk.source == "mine.toml"
    assert desk.case == talbot
    assert [path.name for path in tmp_path.iterdir()] == ["own"]


def test_only_built_in_cases_are_opened_by_name(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text('kind = "planetary"')
    with pytest.raises(InputError, match="no built-in case"):
        built_in(str(file))


def test_a_broken_case_is_opened_with_its_problems(tmp_path):
    file = tmp_path / "broken.toml"
    file.write_text('kind = "gear_pair"\n[operation]\ntorque = "3 kg"\n')
    desk = opened(str(file))
    assert desk.case is None
    assert "unit" in desk.problems_of("operation.torque")[0].allowed
    assert "missing" in desk.problems_of("operation.speed")[0].allowed
    file.write_text("kind = 3")
    with pytest.raises(InputError):
        opened(str(file))


@pytest.mark.parametrize("name", ["talbot-2012-pair", "train-8hp70"])
def test_a_saved_case_is_the_same_case(name, tmp_path):
    desk = opened(name)
    desk.change("operation.speed", "1234 rpm")
    file = tmp_path / "saved.toml"
    file.write_text(desk.text(), encoding="utf-8")
    assert opened(str(file)).case == desk.case


# --- the worker -----------------------------------------------------------------------------------


def test_the_worker_tells_progress_and_errors_and_can_be_ended():
    told = []

    async def use(worker):
        assert await worker.do(app_tasks.doubled, 21, progress=lambda *at: told.append(at)) == 42
        assert told == [(1, 3)]
        with pytest.raises(InputError, match="too few"):
            await worker.do(app_tasks.refused, progress=print)
        with pytest.raises(WorkError, match="ZeroDivisionError: no number"):
            await worker.do(app_tasks.broken, progress=print)
        with pytest.raises(Ended):
            await worker.do(app_tasks.endless, progress=lambda *at: worker.end())
        assert await worker.do(app_tasks.doubled, 4, progress=lambda *at: None) == 8

    async def run():
        worker = Worker()
        try:
            await use(worker)
        finally:
            worker.end()

    asyncio.run(run())


# --- where it listens -----------------------------------------------------------------------------


def test_names_of_the_address():
    assert names_of("127.0.0.1") == ["127.0.0.1", "localhost", "[::1]"]
    assert names_of("192.0.2.7") == ["192.0.2.7"]
    assert names_of("2001:db8::7") == ["[2001:db8::7]"]
    assert {"127.0.0.1", "localhost"} < set(names_of("0.0.0.0"))


def test_another_host_is_told_what_it_means(monkeypatch):
    from epicyclic.app import serve
    from epicyclic.cli.app import app

    asked = []
    monkeypatch.setattr(serve, "serve", lambda desk, *where: asked.append(where[:2]))
    found = CliRunner().invoke(app, ["talbot-2012", "--host", "192.0.2.7", "--port", "8080"])
    assert asked == [("192.0.2.7", 8080)]
    assert "not encrypted" in found.stderr
    assert not CliRunner().invoke(app, ["talbot-2012"]).stderr
