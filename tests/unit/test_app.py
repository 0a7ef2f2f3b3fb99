"""The app without a browser: form, changes, commands, the guard, the simulated page."""

from __future__ import annotations

import asyncio
import json
import shlex

import pytest
from click.testing import CliRunner

pytest.importorskip("nicegui", reason="optional")

from nicegui import ui

import app_tasks
from epicyclic.case.case import build_case
from epicyclic.errors import InputError
from epicyclic.library import minimal_case
from epicyclic.plugins.app import worker as tasks
from epicyclic.plugins.app.case_form import Desk, Shelves, built_in, form_of, opened, received
from epicyclic.plugins.app.page import LARGEST_BODY, Guard, names_of
from epicyclic.plugins.app.views import _values
from epicyclic.plugins.app.worker import EndedError, Latest, Worker, WorkError
from epicyclic.schema.fields import all_keys
from epicyclic.show.page import Drawing
from epicyclic.study.operating import OPERATING
from epicyclic.study.solve import solve
from listed_trains import ravigneaux

TOKEN, HOST = "the-token", "127.0.0.1:4711"


# --- the form -------------------------------------------------------------------------------------


def _groups(group):
    yield group
    for inner in group.groups:
        yield from _groups(inner)


@pytest.mark.parametrize("name", ["talbot-2012", "talbot-2012-pair"])
def test_the_form_has_every_key_of_the_schema_that_holds_a_value(name):
    desk = opened(name)
    shown = {entry.key for entry in desk.form().walk()}
    presets = (".material.", "lubricant.oil.", "NAME")
    expected = {key for key in all_keys(type(desk.case)) if not any(one in key for one in presets)}
    named = {group.key for group in _groups(desk.form()) if group.sample}
    assert expected - shown - named == {"kind"}


def test_numbers_are_shown_in_the_unit_of_the_field_and_typed_in_it(talbot):
    entries = {entry.key: entry for entry in form_of(talbot.given()).walk()}
    torque = entries["operation.torque"]
    assert (torque.text, torque.unit) == ("1000", "N·m")
    assert torque.value("730") == "730 N*m"
    assert torque.value("0.73 kN*m") == "0.73 kN*m"
    assert [torque.shown(it) for it in ("0.73 kN*m", "7", "nan", "3 kg")] == [
        "730",
        "7",
        "nan",
        "3 kg",
    ]
    assert torque.value("  ") is None
    faster = form_of(talbot.updated({"operation.speed": "25 rev/s"}).given())
    assert {it.key: it.text for it in faster.walk()}["operation.speed"] == "1500"


def test_fields_of_a_train_are_those_of_its_sets():
    keys = {entry.key for entry in opened("train-eaxle").form().walk()}
    assert {"operation.speed", "sets.planets.sun.teeth", "sets.pair.gears.normal_module"} <= keys


def test_tables_of_names_take_new_ones_wherever_the_schema_has_them():
    found = {group.key: group for group in _groups(opened("train-8hp70").form()) if group.kinds}
    plain = {"shafts", "positions", "operation.speeds", "operation.torques", "thermal.jet_shares"}
    tables = {"sets", "states", "bearings", "seals", "drags", "uncertainty", "thermal.conductances"}
    assert plain | tables <= found.keys()
    assert all(found[key].sample for key in plain)
    assert not any(found[key].sample for key in tables)
    assert found["positions"].sample.unit == "mm"
    kinds = {kind.about: kind.tables for kind in found["sets"].kinds}
    assert kinds["A gear pair of given efficiency."] == {"pinion": {}, "gear": {}, "efficiency": ""}
    assert len(kinds) == 6


def test_gears_of_a_listed_set_stand_beside_what_they_share():
    tables = ravigneaux()
    desk = Desk("x", tables, lambda changes: build_case(tables, changes, "x"))
    assert desk.case is not None, desk.problems
    ((name, table),) = desk.current["sets"].items()
    gears = desk.form().find(f"sets.{name}.gears")
    listed = {gear for gear, value in table["gears"].items() if isinstance(value, dict)}
    assert {group.name for group in gears.groups} == listed
    assert all(group.is_own for group in gears.groups)
    assert f"sets.{name}.gears.normal_module" in {entry.key for entry in gears.entries}
    assert desk.add(gears.key, "further", {}) == ""
    assert desk.problems_of(f"{gears.key}.further.teeth")


def test_captions_are_without_the_marks_of_the_manual():
    told = {group.about for group in _groups(form_of(ravigneaux()))}
    assert "What belongs to one mesh of a listed set, [sets.NAME.mesh.GEAR-GEAR]." in told
    assert not any("`" in text for text in told)


def test_each_form_of_a_set_that_is_added_is_the_one_of_its_fields():
    desk = opened("train-8hp70")
    sets = desk.form().find("sets")
    for number, kind in enumerate(sets.kinds):
        assert desk.add("sets", f"new{number}", kind.tables) == ""
        group = desk.form().find(f"sets.new{number}")
        assert group.about == kind.about
        shown = {entry.key.split(".")[2] for entry in group.walk()}
        assert {key for key, value in kind.tables.items() if value == ""} <= shown
    assert {problem.key.split(".")[1] for problem in desk.problems} >= {"new0", "new3"}


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
    from epicyclic.cli.common import load_with

    desk = opened("talbot-2012")
    desk.change("operation.torque", "310 N*m")
    desk.change("planet.count", 5)
    desk.change("models.friction", None)
    desk.change("title", "a b' c")
    words = shlex.split(desk.command())
    assert words[:3] == ["epicyclic", "run", "talbot-2012"]
    assert load_with(words[2], words[4::2]) == desk.case


# --- names ----------------------------------------------------------------------------------------


def test_a_name_is_added_renamed_and_removed_with_the_checks_of_the_case_file():
    desk = opened("train-eaxle")
    before = desk.case
    assert desk.add("bearings", "N1", {}) == ""
    missing = {problem.key for problem in desk.problems}
    assert {"bearings.N1.type", "bearings.N1.shaft"} <= missing
    assert desk.problems_of("bearings.N1.bore")[0].allowed.startswith("is missing")
    assert desk.rename("bearings.N1", "N 2") == ""
    assert desk.problems_of('bearings."N 2".bore')
    desk.remove('bearings."N 2"')
    assert desk.changes == {}
    assert desk.case == before


def test_a_dot_in_the_name_of_a_set_is_told_as_in_a_case_file():
    desk = opened("train-8hp70")
    (name, *_) = desk.current["sets"]
    assert desk.rename(f"sets.{name}", "P.1") == ""
    assert any("is not a valid name for a set" in problem.allowed for problem in desk.problems)
    assert desk.case is None


def test_what_names_a_state_that_is_gone_is_told():
    desk = opened("train-8hp70")
    state = desk.current["operation"]["state"]
    desk.remove(f'states."{state}"' if not str(state).isalnum() else f"states.{state}")
    assert desk.problems_of("operation.state")


def test_values_under_names_are_read_with_their_unit():
    desk = opened("talbot-2012")
    assert desk.add("uncertainty", "sun.roughness", {"normal": "12 %"}) == ""
    assert desk.case is not None
    assert desk.case.uncertainty["sun.roughness"].normal == "12 %"
    assert desk.form().find('uncertainty."sun.roughness"').name == "sun.roughness"
    assert desk.add("uncertainty", "sun.rougness", {"normal": "12 %"}) == ""
    assert desk.problems
    desk.remove('uncertainty."sun.rougness"')
    sample = desk.form().find("lubrication.immersion").sample
    assert sample.value("17") == "17 mm"


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("  ", "missing"),
        ('a"b', "quotation"),
        ("a\\b", "backslashes"),
        ("a\nb", "control"),
        ("planets", "already"),
    ],
)
def test_a_name_that_cannot_be_is_refused_at_once(name, told):
    desk = opened("train-eaxle")
    assert told in desk.add("sets", name, {})
    assert told in desk.rename("sets.pair", name)
    assert desk.changes == {}


def test_a_case_with_names_of_the_user_comes_back_from_its_command_and_its_file(tmp_path):
    from epicyclic.cli.common import load_with

    desk = opened("train-eaxle")
    assert desk.rename("sets.pair", "last stage") == ""
    for key, value in _with_other_names(desk.current, "pair", "last stage").items():
        desk.change(key, value)
    assert desk.case is not None, desk.problems
    words = shlex.split(desk.command())
    assert load_with(words[2], words[4::2]) == desk.case
    file = tmp_path / "saved.toml"
    file.write_text(desk.text(), encoding="utf-8")
    assert opened(str(file)).case == desk.case


@pytest.mark.parametrize("kind", ["gear_pair", "planetary", "train"])
def test_saved_cases_keep_what_is_stated_in_short(tmp_path, kind):
    """An oil by grade and kind, and all else that the short files state."""
    short, saved = tmp_path / "short.toml", tmp_path / "saved.toml"
    short.write_text(minimal_case(kind), encoding="utf-8")
    desk = opened(str(short))
    assert desk.case is not None
    saved.write_text(desk.text(), encoding="utf-8")
    assert opened(str(saved)).case == desk.case


def _with_other_names(tables, old, new):
    """Tables that name a set, with its other name."""
    text = {key: json.dumps(tables[key]) for key in tables if key not in ("sets", "kind", "title")}
    return {
        key: json.loads(it.replace(f'"{old}.', f'"{new}.')) for key, it in text.items() if old in it
    }


# --- what follows an input, and what each tab has -------------------------------------------------


def test_work_follows_the_last_value_and_never_queues():
    done, now = [], [0]

    async def work():
        seen = now[0]
        await asyncio.sleep(0.01)
        done.append(seen)

    async def run():
        latest = Latest(work)
        wanted = []
        for value in range(1, 24):
            now[0] = value
            wanted.append(asyncio.ensure_future(latest.want()))
            await asyncio.sleep(0.001)
        await asyncio.gather(*wanted)

    asyncio.run(run())
    assert 1 < len(done) < 20
    assert done == sorted(done)  # the last twice if it was there before it was asked for
    assert done[-1] == 23


def test_each_tab_has_a_case_of_its_own_that_outlives_its_page(tmp_path):
    shelves = Shelves(opened("talbot-2012"), tmp_path, most=2)
    first, second = shelves.take("a", "page 1"), shelves.take("b", "page 2")
    first.desk.change("operation.torque", "310 N*m")
    assert second.desk.changes == {}
    assert first.folder != second.folder
    assert shelves.take("c", "page 3") is None
    assert shelves.take("a", "page 4") is first
    shelves.leave("a", "page 1")  # the page that was loaded again
    assert not first.quick.is_closed
    shelves.leave("a", "page 4")
    assert all(worker.is_closed for worker in first.workers)
    copied = shelves.take("c", "page 5", before="a")
    assert copied.desk.changes == first.desk.changes
    assert copied.desk is not first.desk
    shelves.leave("c", "page 5")
    back = shelves.take("a", "page 6")
    assert back.desk is first.desk
    assert not any(worker.is_closed for worker in back.workers)
    shelves.close()
    assert all(worker.is_closed for shelf in (back, second) for worker in shelf.workers)


def test_cases_of_closed_tabs_are_forgotten_with_their_files(tmp_path, monkeypatch):
    monkeypatch.setattr("epicyclic.plugins.app.case_form.MOST_KEPT", 3)
    shelves = Shelves(opened("talbot-2012"), tmp_path, most=2)
    folders = []
    for number in range(5):
        folders.append(shelves.take(f"tab {number}", "page").folder)
        shelves.leave(f"tab {number}", "page")
    assert [folder.exists() for folder in folders] == [False, False, True, True, True]


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


def _ask(kind="http", path="/", query="", bodies=(b"",), hosts=(HOST,), **headers):
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
            for name, texts in ({"host": HOST} | headers).items()
            for text in ([texts] if isinstance(texts, str) else texts)
        ],
    }
    asyncio.run(Guard(_inner, TOKEN, hosts)(scope, receive, send))
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
        ("", {"cookie": COOKIE, "origin": ["http://evil.example", f"http://{HOST}"]}),
        ("", {"cookie": COOKIE, "origin": [f"http://{HOST}", "http://evil.example"]}),
        ("", {"cookie": COOKIE, "host": ["evil.example:4711", HOST]}),
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
    assert _ask(cookie=COOKIE, content_length=["9", "2"])[0]["status"] == 413
    part = b"x" * (LARGEST_BODY // 2 + 1)
    assert _ask(cookie=COOKIE, bodies=(part, part))[0]["status"] == 499
    assert _ask(cookie=COOKIE, bodies=(part, b"x"))[0]["status"] == 200


def test_a_length_of_thousands_of_digits_is_too_large():
    assert _ask(cookie=COOKIE, content_length="9" * 5000)[0]["status"] == 413


@pytest.mark.parametrize("host", ["127.0.0.1", "[::1]"])
def test_browsers_leave_out_the_usual_port(host):
    cookie = f"epicyclic-80={TOKEN}"
    for origin in ({}, {"origin": f"http://{host}"}):
        sent = _ask(hosts=[f"{host}:80"], cookie=cookie, **({"host": host} | origin))
        assert sent[0]["status"] == 200
    assert _ask(cookie=COOKIE, host=host)[0]["status"] == 403


def test_every_answer_forbids_what_lies_elsewhere():
    for sent in (_ask(), _ask(cookie=COOKIE), _ask(query=f"token={TOKEN}")):
        headers = dict(sent[0]["headers"])
        assert b"default-src 'self'" in headers[b"content-security-policy"]
        assert headers[b"x-frame-options"] == b"DENY"


def test_a_port_that_is_taken_and_a_case_that_is_none_are_told():
    import socket

    from epicyclic.cli.main import cli

    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        options = ["talbot-2012", "--port", str(taken.getsockname()[1]), "--no-browser"]
        found = CliRunner().invoke(cli, ["app", *options])
    assert isinstance(found.exception, InputError)
    assert "cannot be used as a server address" in str(found.exception)
    assert isinstance(CliRunner().invoke(cli, ["app", "talbot-2013"]).exception, InputError)


# --- the page -------------------------------------------------------------------------------------


class _Here:
    """In place of the worker: does the work here, but for pictures."""

    async def do(self, task, *arguments, progress=lambda *at: None):
        if task is tasks.picture:
            return [Drawing(arguments[1], f"picture of {arguments[1]}", "<svg></svg>")]
        return task(*arguments, progress)

    def end(self):
        pass


class _Held(_Here):
    """Computes no chapters beyond the first one."""

    async def do(self, task, *arguments, progress):
        if task is tasks.answered and arguments[1] == "":
            await asyncio.Event().wait()
        return await super().do(task, *arguments, progress=progress)


@pytest.fixture
def simulate(tmp_path):
    from nicegui.testing import user_simulation

    from epicyclic.plugins.app.case_form import Shelf
    from epicyclic.plugins.app.page import Page, add_assets

    def run(desk: Desk, script, *, chapter="", slow=_Here) -> None:
        async def root():
            add_assets()
            Page(Shelf(desk, tmp_path, chapter, _Here(), slow(), _Here())).build()

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
        found.clear().type("0.5 kN*m").trigger("change")
        await user.should_not_see("has a unit that measures something else", retries=50)
        assert (field.value, desk.case["operation.torque"]) == ("500", 500.0)

    simulate(desk, script)


@pytest.mark.parametrize(
    ("chapter", "tab", "shown"),
    [
        ("", "Summary", "picture of losses"),
        pytest.param("map", "Summary", "Compute", marks=pytest.mark.slow),
        ("gears", "Gears", "mesh periods"),
        # of a planet; a pair has none
        pytest.param("bearing", "Summary", "picture of losses", marks=pytest.mark.slow),
    ],
)
def test_a_chapter_is_shown_before_the_others_are_known(simulate, chapter, tab, shown):
    desk = opened("talbot-2012-pair")
    desk.change("losses.mesh_pocketing.include", False)

    async def script(user):
        await user.should_see("Studies", retries=200)
        found = [[one.props["label"] for one in tabs] for tabs in user.find(ui.tabs).elements]
        assert [tab, "Map", "Compare", "Designs"] in found
        await user.should_see(shown, retries=200)

    simulate(desk, script, chapter=chapter, slow=_Held)


@pytest.mark.slow
def test_a_picture_can_be_saved_once_it_is_drawn(simulate):
    desk = opened("talbot-2012-pair")
    desk.change("losses.mesh_pocketing.include", False)
    drawn = asyncio.Event()

    class _Slow(_Held):
        async def do(self, task, *arguments, progress):
            if task is tasks.turning:
                await drawn.wait()
            return await super().do(task, *arguments, progress=progress)

    async def script(user):
        await user.should_see("mesh periods", retries=200)
        await user.should_not_see("svg")
        drawn.set()
        await user.should_see("svg", retries=200)

    simulate(desk, script, chapter="gears", slow=_Slow)


@pytest.mark.slow
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
        user.find("Studies").click()
        await user.should_see("Compare", retries=50)
        user.find("Compare").click()
        await user.should_see("Keep the current case, then change it", retries=50)
        user.find("Command").click()
        await user.should_see("epicyclic run talbot-2012-pair", retries=50)

    simulate(desk, script)


@pytest.mark.slow
@pytest.mark.parametrize(
    "typed",
    ["nan", "3 kg", *(pytest.param(text, marks=pytest.mark.slow) for text in ("inf", "-1e308"))],
)
def test_the_slider_of_what_is_no_number_begins_at_zero(simulate, typed):
    desk = opened("talbot-2012-pair")
    desk.change("losses.mesh_pocketing.include", False)
    key = "operation.torque"

    async def script(user):
        await user.should_see("total loss", retries=200)
        user.find(marker=key).clear().type(typed).trigger("change")
        await user.should_see("total loss", retries=200)
        user.find(marker=f"tune-{key}").click()
        await user.should_see(marker=f"slider-{key}", retries=50)
        (slider,) = user.find(marker=f"slider-{key}").elements
        assert (slider.props["min"], slider.value, slider.props["max"]) == (0, 0, 1)

    simulate(desk, script)


def test_the_name_of_a_state_is_no_number_that_moves(simulate):
    async def script(user):
        await user.should_see(marker="tune-operation.torque", retries=50)
        await user.should_see(marker="operation.state")
        await user.should_not_see(marker="tune-operation.state")

    desk = opened("train-8hp70")
    assert desk.current["operation"]["state"] == "1"
    simulate(desk, script)


def test_the_losses_of_two_cases_stand_in_one_picture_in_one_unit():
    case = opened("talbot-2012-pair").case.updated({"losses.mesh_pocketing.include": False})
    cases = (
        case.updated({"operation.speed": "310 rpm"}),
        case.updated({"operation.torque": "7 kN*m"}),
    )

    def tell(done, total):
        pass

    (drawn,) = tasks.beside(*cases, ("kept", "now"), tasks.IN_PAGE, tell)
    labels = list(drawn.plot["layout"]["yaxis"]["ticktext"])
    totals = [trace["x"][labels.index("total")] for trace in drawn.plot["data"]]
    watts = [solve(one).total for one in cases]
    assert drawn.plot["layout"]["xaxis"]["title"]["text"] == "power loss, kW"
    assert totals == pytest.approx([1e-3 * one for one in watts], rel=1e-6)
    assert watts[0] < 1e3 < 1e4 < watts[1]


def test_a_map_without_speeds_is_no_result():
    study = tasks.Study(opened("talbot-2012-pair").case, torque="0:310:3 N*m", is_map=True)
    with pytest.raises(InputError, match=r"operation\.speed: has no values"):
        tasks.answered(study, "", lambda done, total: None)


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
        received([("mine.toml", text.encode())], tmp_path)


def test_an_uploaded_name_cannot_leave_its_folder(tmp_path, talbot):
    text = Desk("x", talbot.given(), lambda changes: talbot).text()
    folder = tmp_path / "own"
    folder.mkdir()
    desk = received([("../mine.toml", text.encode())], folder)
    assert desk.source == "mine.toml"
    assert desk.case == talbot
    assert [path.name for path in tmp_path.iterdir()] == ["own"]


@pytest.mark.parametrize("second", ["mine.toml", "other/mine.toml", "Mine.TOML"])
def test_of_two_files_of_one_name_neither_wins(second, tmp_path, talbot):
    files = [("mine.toml", b"kind"), ("film.csv", b"7"), (second, b"torque"), ("film.csv", b"8")]
    with pytest.raises(InputError) as error:
        received(files, tmp_path)
    problems = [(one.value, one.allowed) for one in error.value.problems]
    assert problems[-1] == ('"film.csv"', "is the name of 2 files.")
    assert len(problems) == 2
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("names", [("a.csv",), ("a.toml", "b.toml"), ("a.toml", "b.rexs")])
def test_one_of_the_files_of_an_upload_is_a_case(names, tmp_path):
    with pytest.raises(InputError, match="One of the files must be a case"):
        received([(name, b"") for name in names], tmp_path)


def test_only_built_in_cases_are_opened_by_name(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text('kind = "planetary"')
    with pytest.raises(InputError, match="not a built-in case"):
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


@pytest.mark.parametrize("name", ["..", "", "a\0b", "a\nb", "\x1b[31m", "\udcff", "x" * 300])
def test_what_is_no_name_of_a_file_is_refused(name, tmp_path, talbot):
    text = Desk("x", talbot.given(), lambda changes: talbot).text().encode()
    for files in ([(name, text)], [("mine.toml", text), (name, b"")]):
        with pytest.raises(InputError, match="Rename it") as error:
            received(files, tmp_path)
        assert str(error.value).isascii()
        assert str(tmp_path) not in str(error.value)


@pytest.mark.parametrize("value", ["3", "[1, 2]", '"x"', "2020-01-01"])
@pytest.mark.parametrize(
    "key",
    ["operation", "models", "losses.mesh_pocketing", "uncertainty", "uncertainty.x", "shafts",
     "sets", "sets.a", "sets.a.sun", "states.a", "bearings", "bearings.a", "bearings.a.seal"],
)  # fmt: skip
def test_a_value_in_the_place_of_a_table_is_told_before_a_form_is_shown(key, value, tmp_path):
    file = tmp_path / "case.toml"
    kind = "train" if key.partition(".")[0] in ("sets", "states", "shafts", "bearings") else "pair"
    file.write_text(f'kind = "{kind.replace("pair", "gear_pair")}"\n{key} = {value}\n')
    with pytest.raises(InputError, match=key.partition(".")[0]):
        opened(str(file))


def test_a_date_is_shown_as_a_case_file_has_it(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text('kind = "gear_pair"\ntitle = 2020-02-03\n')
    desk = opened(str(file))
    assert desk.problems_of("title")
    assert {entry.key: entry.text for entry in desk.form().entries}["title"] == "2020-02-03"
    assert "title = 2020-02-03" in desk.text()


@pytest.mark.parametrize("name", ["talbot-2012-pair", "train-8hp70"])
def test_a_saved_case_is_the_same_case(name, tmp_path):
    desk = opened(name)
    desk.change("operation.speed", "1234 rpm")
    file = tmp_path / "saved.toml"
    file.write_text(desk.text(), encoding="utf-8")
    assert opened(str(file)).case == desk.case


# --- the worker -----------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_worker_tells_progress_and_errors_and_can_be_ended():
    told = []

    async def use(worker):
        assert await worker.do(app_tasks.doubled, 21, progress=lambda *at: told.append(at)) == 42
        assert told == [(1, 3)]
        with pytest.raises(InputError, match="too few"):
            await worker.do(app_tasks.refused, progress=print)
        with pytest.raises(WorkError, match="ZeroDivisionError: no number"):
            await worker.do(app_tasks.broken, progress=print)
        with pytest.raises(EndedError):
            await worker.do(app_tasks.endless, progress=lambda *at: worker.end())
        assert await worker.do(app_tasks.doubled, 4, progress=lambda *at: None) == 8
        waiting = asyncio.ensure_future(worker.do(app_tasks.endless, progress=lambda *at: None))
        await asyncio.sleep(0.1)
        worker.close()
        with pytest.raises(EndedError):
            await waiting
        with pytest.raises(EndedError):
            await worker.do(app_tasks.doubled, 3, progress=print)

    async def run():
        worker = Worker()
        try:
            await use(worker)
        finally:
            worker.end()

    asyncio.run(run())


@pytest.mark.slow
@pytest.mark.parametrize(
    "task", [app_tasks.doubled, pytest.param(app_tasks.endless, marks=pytest.mark.slow)]
)
def test_a_worker_that_is_closed_between_two_answers_ends_its_work(task):
    async def run():
        worker = Worker()
        arguments = (23,) if task is app_tasks.doubled else ()
        told = []

        def close(*count):  # an answer is here, and the next one is still to be waited for
            told.append(count)
            worker.close()

        with pytest.raises(EndedError):
            await worker.do(task, *arguments, progress=close)
        with pytest.raises(EndedError):
            await worker.do(app_tasks.doubled, 3, progress=print)
        assert len(told) == 1
        worker.close()

    asyncio.run(run())


# --- where it listens -----------------------------------------------------------------------------


def test_names_of_the_address():
    assert names_of("127.0.0.1", "127.0.0.1") == ["127.0.0.1", "localhost", "[::1]"]
    assert names_of("192.0.2.7", "192.0.2.7") == ["192.0.2.7"]
    assert names_of("2001:DB8:0::7", "2001:db8::7") == ["[2001:db8:0::7]", "[2001:db8::7]"]
    assert names_of("Desk.example", "192.0.2.7") == ["desk.example", "192.0.2.7"]
    assert {"127.0.0.1", "localhost"} < set(names_of("0.0.0.0", "0.0.0.0"))


def test_a_machine_that_does_not_know_its_own_name_has_loopback_addresses(monkeypatch):
    monkeypatch.setattr("socket.gethostname", lambda: "no-such-host.invalid")
    assert names_of("::", "::") == ["127.0.0.1", "localhost", "[::1]"]


@pytest.mark.parametrize("host", ["", "a\0b", "\udcff", "a" * 300, "no-such-host.invalid"])
def test_what_is_no_address_is_told(host):
    from epicyclic.cli.main import cli

    found = CliRunner().invoke(cli, ["app", "talbot-2012", "--host", host, "--no-browser"])
    assert isinstance(found.exception, InputError)
    assert "cannot be used as a server address" in str(found.exception)
    assert len(str(found.exception)) < 300


def test_another_host_is_told_what_it_means(monkeypatch):
    from epicyclic.cli.main import cli
    from epicyclic.plugins.app import page as serve

    asked = []
    monkeypatch.setattr(serve, "serve", lambda desk, *where: asked.append(where[:2]))
    found = CliRunner().invoke(cli, ["app", "talbot-2012", "--host", "192.0.2.7", "--port", "8080"])
    assert asked == [("192.0.2.7", 8080)]
    assert "not encrypted" in found.stderr
    assert not CliRunner().invoke(cli, ["app", "talbot-2012"]).stderr


@pytest.mark.parametrize(
    ("axis", "given", "values"),
    [
        ("torque", "137", "-137:137:13 N*m"),
        ("torque", "-41", "-41:41:13 N*m"),
        ("speed", "2300", "0:2300:9 rpm"),
        ("torque", "0", "0 N*m"),
        ("temperature", "83", "83 degC"),
        ("temperature", "", ""),
        ("torque", "nan", ""),
        ("speed", "1e308", ""),
        ("temperature", "-inf", ""),
    ],
)
def test_a_map_reaches_the_speed_of_the_case_and_its_torque_in_both_directions(axis, given, values):
    assert _values(axis, OPERATING[axis], given) == values
