"""The skill for agents, and the read-only tools of the server (Model Context Protocol)."""

from __future__ import annotations

import asyncio
import os
import re
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
    assert "N·m" in key.structured_content["allowed"] or "N*m" in key.structured_content["allowed"]
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
