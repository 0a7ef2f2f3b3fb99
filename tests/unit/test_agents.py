"""The skill for agents, and the read-only tools of the server (Model Context Protocol)."""

from __future__ import annotations

import asyncio
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import epicyclic as ep
from epicyclic.cli.main import cli
from frozen.command import run_command

TOOLS = ["check", "compare-cases", "explain-key", "map", "run", "uncertainty"]


def called(tmp_path, *calls):
    """Answers of the server over standard input and output, in an empty folder."""
    mcp = pytest.importorskip("mcp", reason="optional")
    command = mcp.StdioServerParameters(
        command=sys.executable, args=["-m", "epicyclic", "mcp"], env=dict(os.environ), cwd=tmp_path
    )

    async def ask():
        async with mcp.Client(command, read_timeout_seconds=600) as client:
            tools = (await client.list_tools()).tools
            return tools, [await client.call_tool(*call) for call in calls]

    return asyncio.run(ask())


def text_of(answer):
    (content,) = answer.content
    return content.text


def test_the_skill_is_installed_as_it_is_in_the_package(tmp_path):
    done = run_command(("skill", str(tmp_path / "skills")), tmp_path)
    assert done.code == 0
    installed = (tmp_path / "skills" / "epicyclic" / "SKILL.md").read_text(encoding="utf-8")
    head = re.match(r"---\nname: epicyclic\ndescription: (.+)\n---\n", installed)
    assert 100 < len(head[1]) < 1024
    again = run_command(("skill", str(tmp_path / "skills")), tmp_path)
    assert again.code == 0
    assert [path.name for path in (tmp_path / "skills" / "epicyclic").iterdir()] == ["SKILL.md"]


def test_the_skill_names_commands_tools_and_options_that_there_are():
    skill = (Path(ep.__file__).parent / "plugins/agents/skill/SKILL.md").read_text(encoding="utf-8")
    lines = re.findall(r"`epicyclic ([a-z-]+)([^`]*)`", skill)
    assert len(lines) > 12
    for name, rest in lines:
        command = cli.get_command(None, name)
        known = {option for it in command.params for option in it.opts}
        assert set(re.findall(r"--[a-z]+", rest)) <= known, name
    assert set(re.findall(r"^\|.*\| `([a-z-]+)`[^|]*\|$", skill, re.MULTILINE)) == set(TOOLS)


def test_a_folder_that_is_a_file_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    done = run_command(("skill", str(tmp_path / "file")), tmp_path)
    assert done.code == 2
    assert "FOLDER" in done.errors


@pytest.mark.slow
def test_a_client_gets_the_answers_of_the_commands(tmp_path):
    torque = "operation.torque=512 N*m"
    tools, (run, refused, unknown, sheet, plane, key, no_key, large) = called(
        tmp_path,
        ("run", {"case": "talbot-2012-pair", "changes": [torque]}),
        ("run", {"case": "talbot-2012-pair", "changes": ["pinion.teeth=2", "operation.sped=3"]}),
        ("check", {"case": "nothing.toml"}),
        ("check", {"case": "talbot-2012"}),
        ("map", {"case": "train-8hp70", "speed": "1000,2500 rpm", "torque": "90,210 N*m",
                 "states": ["3", "R"]}),
        ("explain-key", {"key": "operation.torque"}),
        ("explain-key", {"key": "operation.torqe"}),
        ("map", {"case": "train-8hp70", "speed": "1000:2500:21 rpm", "torque": "1:9:20 N*m",
                 "states": ["3"]}),
    )  # fmt: skip
    assert sorted(tool.name for tool in tools) == TOOLS
    assert all(tool.annotations.read_only_hint for tool in tools)
    result = ep.solve(ep.load_case("talbot-2012-pair", {"operation.torque": "512 N*m"}))
    assert run.structured_content["total"] == pytest.approx(result.total, rel=1e-12)
    low, high = run.structured_content["band"]["total"]
    assert low < result.total < high
    said = run_command(("run", "talbot-2012-pair", "--set", torque), tmp_path).output
    assert text_of(run).strip() == said.strip()
    assert refused.is_error
    assert [it["key"] for it in refused.structured_content["problems"]] == [
        "operation.sped", "pinion.teeth"
    ]  # fmt: skip
    options = ("--set", "pinion.teeth=2", "--set", "operation.sped=3")
    told = run_command(("run", "talbot-2012-pair", *options), tmp_path).errors
    assert text_of(refused).strip() == told.strip()
    assert unknown.is_error
    assert "nothing.toml" in text_of(unknown)
    assert "contact ratio" in text_of(sheet)
    assert len(text_of(plane).strip().splitlines()) == 1 + 2 * 2 * 2
    assert key.structured_content["unit"] == "N*m"
    assert no_key.is_error
    assert "operation.torque" in text_of(no_key)
    assert large.is_error
    assert "420 points" in text_of(large)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_client_gets_bands_and_comparisons(tmp_path):
    _, (band, pair, many) = called(
        tmp_path,
        ("uncertainty", {"case": "train-eaxle", "samples": 16}),
        ("compare-cases", {"first": "talbot-2012-pair", "second": "talbot-2012-pair",
                           "samples": 16}),
        ("uncertainty", {"case": "train-eaxle", "samples": 4096}),
    )  # fmt: skip
    total = band.structured_content["total"]
    assert total["low"] < total["nominal"] < total["high"]
    assert pair.structured_content["total"]["difference"] == 0
    assert many.is_error
    assert "1024" in text_of(many)


HELLO = {"protocolVersion": "2025-06-18", "capabilities": {},
         "clientInfo": {"name": "any", "version": "1"}}  # fmt: skip


class Wire:
    """The server, spoken to in bytes."""

    def __init__(self, folder):
        command = [sys.executable, "-m", "epicyclic", "mcp"]
        streams = dict.fromkeys(("stdin", "stdout"), subprocess.PIPE)
        self.process = subprocess.Popen(command, cwd=folder, **streams)
        self.ask(1, "initialize", HELLO)
        self.send(json.dumps({"jsonrpc": "2.0", "method": "notifications/initialized"}).encode())

    def send(self, line):
        self.process.stdin.write(line + b"\n")
        self.process.stdin.flush()

    def answer(self):
        return json.loads(self.process.stdout.readline())

    def ask(self, number, method, params):
        message = {"jsonrpc": "2.0", "id": number, "method": method, "params": params}
        self.send(json.dumps(message).encode())
        answer = self.answer()
        assert answer["id"] == number
        return answer.get("result", answer.get("error"))

    def call(self, number, tool, **arguments):
        return self.ask(number, "tools/call", {"name": tool, "arguments": arguments})

    def peak(self):
        """[MB]"""
        status = Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        return int(re.search(r"VmHWM:\s*(\d+)", status)[1]) / 1e3


@pytest.fixture
def wire(tmp_path):
    pytest.importorskip("mcp", reason="optional")
    made = Wire(tmp_path)
    with made.process:
        yield made
        made.process.kill()


NO_MESSAGES = [
    (b"{", None, -32700), (b"\xff\xfe", None, -32700), (b"[" * 200_000, None, -32700),
    (b"[]", None, -32600), (b"7", None, -32600),
    (b'{"jsonrpc":"2.0","id":5}', 5, -32600),
    (b'{"jsonrpc":"2.0","id":[],"method":"ping"}', None, -32600),
    (b'{"jsonrpc":"2.0","id":6,"method":"ping","x":"\\ud800"}', 6, -32600),
]  # fmt: skip
"""Lines, and the number and code of the answer to each."""


def endless(size):
    return b'{"jsonrpc":"2.0","id":8,"method":"' + b"x" * size + b'"}', 8, -32600


def test_messages_alone_are_passed_on(tmp_path):
    pytest.importorskip("mcp", reason="optional")
    echo = (
        "import os, sys\nfrom epicyclic.plugins.agents.wire import bounded_wire\n"
        "with bounded_wire():\n    os.write(1, b'aside')\n"
        "    for line in sys.stdin:\n        sys.stdout.write(line)\n        sys.stdout.flush()\n"
    )
    wrong = [*NO_MESSAGES, endless(4_000_000)]
    passed = b'{"jsonrpc":"2.0","id":3,"method":"ping","params":{"a":"' + b"y" * 99_999 + b'"}}'
    given = b"\n".join([*(line for line, *_ in wrong), b"", passed, b""])
    command = [sys.executable, "-c", echo]
    done = subprocess.run(command, input=given, cwd=tmp_path, capture_output=True, check=True)
    *answers, last = done.stdout.splitlines()
    found = [(it["id"], it["error"]["code"]) for it in map(json.loads, answers)]
    assert found == [(number, code) for _, number, code in wrong]
    assert last == passed
    assert done.stderr == b"aside"


def test_files_that_are_no_cases_are_not_told(tmp_path, monkeypatch):
    pytest.importorskip("mcp", reason="optional")
    from epicyclic.plugins.agents.tools import server

    monkeypatch.chdir(tmp_path)
    (tmp_path / "secret.key").write_text("hidden = words that nobody may see")
    (tmp_path / "link.toml").symlink_to(tmp_path / "secret.key")
    for path in ("secret.key", "link.toml"):
        found = asyncio.run(server().call_tool("check", {"case": path}))
        assert found.is_error
        assert "must lead to a file .toml" in text_of(found)
        assert "nobody may see" not in text_of(found)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_what_is_no_message_is_answered(wire):
    """Once each, in 500 MB; the server goes on."""
    for line, number, code in [*NO_MESSAGES, endless(150_000_000)]:
        wire.send(line)
        found = wire.answer()
        assert (found["id"], found["error"]["code"]) == (number, code), line[:50]
    assert "operation.torque" in str(wire.call(9, "explain-key", key="operation.torque"))
    assert wire.peak() < 500


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="needs links and pipes")
def test_paths_that_lead_elsewhere_are_refused(wire, tmp_path):
    """No line of a file that is no case is told, and nothing waits for a pipe."""
    (tmp_path / "secret.key").write_text("hidden = words that nobody may see")
    (tmp_path / "link.toml").symlink_to(tmp_path / "secret.key")
    (tmp_path / "round.toml").symlink_to(tmp_path / "round.toml")
    os.mkfifo(tmp_path / "pipe.toml")
    before = sorted(tmp_path.iterdir())
    paths = [
        "secret.key", "link.toml", f"../{tmp_path.name}/secret.key", "round.toml", "pipe.toml",
        "/dev/zero", "/dev/stdin", "/proc/self/mem", "/proc/self/environ", "a\0.toml", "\x1b[2J",
        "x" * 5000,
    ]  # fmt: skip
    for number, path in enumerate(paths, start=10):
        found = wire.call(number, "check", case=path)
        (content,) = found["content"]
        assert found["isError"], path
        assert content["text"].startswith("1 problem"), path
        assert "nobody may see" not in content["text"], path
        assert "\x1b" not in content["text"]
    assert sorted(tmp_path.iterdir()) == before
    assert wire.peak() < 500


@pytest.mark.slow
def test_a_cancelled_call_ends(wire):
    """At the next point, so that the next call need not wait for all of them."""
    arguments = {"case": "train-8hp70", "speed": "500:6000:20 rpm", "torque": "10:200:20 N*m",
                 "states": ["1"]}  # fmt: skip
    message = {"jsonrpc": "2.0", "id": 30, "method": "tools/call",
               "params": {"name": "map", "arguments": arguments}}  # fmt: skip
    wire.send(json.dumps(message).encode())
    cancel = {"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": 30}}
    wire.send(json.dumps(cancel).encode())
    assert "operation.torque" in str(wire.call(31, "explain-key", key="operation.torque"))
