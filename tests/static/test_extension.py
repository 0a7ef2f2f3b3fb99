"""What a newcomer adds touches few files, and works: tried in a copy of the package.

A friction model, an element, a key of a case, an output figure and a loss family. Each addition is
a list of edits: the file, what stands there, and what takes its place; a file that is not there is
made. The element is the one of CONTRIBUTING.md, as it is printed there.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "src" / "epicyclic"
Edit = tuple[str, str, str]

FRICTION: list[Edit] = [
    (
        "losses/friction.py",
        "    for model in (\n",
        """    for model in (
        FrictionFormula(
            name="halved",
            title="half of a constant",
            source="a test",
            reliability="made up",
            function=lambda contact, given: np.full_like(contact.line_load, given.constant / 2),
        ),
""",
    ),
    ("case/tables/models.py", '    "mixed-ehl",\n', '    "mixed-ehl",\n    "halved",\n'),
]


def printed() -> tuple[str, ...]:
    """The blocks of Python with which CONTRIBUTING.md adds an element, in their order."""
    text = (SOURCE.parents[1] / "CONTRIBUTING.md").read_text(encoding="utf-8")
    part = text.partition("## Add a loss")[2].partition("## Where things are")[0]
    return tuple(re.findall(r"```python\n(.*?)```", part, re.DOTALL))


ELEMENT, TABLE, BUILDER, TEST = printed()
FUNCTION, LINE = BUILDER.split("\n\n\n")
BRAKE: list[Edit] = [
    ("machine/magnet_brake.py", "", ELEMENT),
    (
        "case/tables/elements.py",
        "class ElementTables(Table):\n",
        f"{TABLE}\n\nclass ElementTables(Table):\n",
    ),
    (
        "case/tables/elements.py",
        "    drags: dict[str, DragTable] = Field(default={})\n",
        "    drags: dict[str, DragTable] = Field(default={})\n"
        "    magnet_brakes: dict[str, MagnetBrakeTable] = Field(default={})\n",
    ),
    ("build/elements.py", "_BUILDERS: Mapping", f"{FUNCTION}\n\n\n_BUILDERS: Mapping"),
    ("build/elements.py", '    "drags": _drag,\n', f'    "drags": _drag,\n    {LINE}'),
    (
        "build/elements.py",
        "from epicyclic.case.tables.elements import",
        "from epicyclic.machine.magnet_brake import MagnetBrake\n"
        "from epicyclic.case.tables.elements import MagnetBrakeTable\n"
        "from epicyclic.case.tables.elements import",
    ),
]

KEY: list[Edit] = [
    (
        "case/tables/models.py",
        '    factor: Number = option("Multiplies the term."',
        '    share: Number = option("Counted part.", 1.0, ge=0, le=1)\n'
        '    factor: Number = option("Multiplies the term."',
    ),
    (
        "build/gear_sets.py",
        "LossChoice(option.include, option.factor)",
        "LossChoice(option.include, option.factor * option.share)",
    ),
]

FIGURE: list[Edit] = [
    (
        "machine/gear_mesh.py",
        '    overlap_ratio: float = figure("overlap ratio", NUMBER)\n',
        '    overlap_ratio: float = figure("overlap ratio", NUMBER)\n'
        '    total_contact_ratio: float = figure("total contact ratio", NUMBER)\n',
    ),
    (
        "machine/gear_mesh.py",
        '"overlap_ratio": mesh.overlap_ratio,',
        '"overlap_ratio": mesh.overlap_ratio,\n'
        '            "total_contact_ratio": mesh.overlap_ratio + mesh.transverse_contact_ratio,',
    ),
]

FAMILY: list[Edit] = [
    (
        "losses/made_up.py",
        "",
        '"""Loss of a carrier, made up."""\n\n\ndef made_up(speed):\n'
        '    """Loss. [W]"""\n    return 1e-6 * abs(speed) ** 3\n',
    ),
    (
        "machine/gear_set.py",
        "        if self.thrust is not None:\n",
        """        if "carrier_made_up" in self.choices:
            watts = made_up(state.speeds[self.carrier])
            losses["carrier_made_up"] = Loss(
                LOAD_INDEPENDENT, watts, "made up", "a test", brakes=((self.carrier, HOUSING, 1.0),)
            )
        if self.thrust is not None:
""",
    ),
    (
        "machine/gear_set.py",
        "from epicyclic.machine.disc import",
        "from epicyclic.losses.made_up import made_up\nfrom epicyclic.machine.disc import",
    ),
    (
        "case/tables/models.py",
        "    thrust_bearing_viscous: LossOption = _AS_COMPUTED\n",
        "    thrust_bearing_viscous: LossOption = _AS_COMPUTED\n"
        "    carrier_made_up: LossOption = _AS_COMPUTED\n",
    ),
]

COARSE = {"numerics.pocket_slices": 6, "numerics.pocket_steps": 10}
PROGRAMS = {
    "friction": """
low = case.updated({"models.friction": "halved", "models.constant_friction": 0.06})
high = case.updated({"models.friction": "constant", "models.constant_friction": 0.03})
print(ep.solve(low).losses["sun_mesh_sliding"] / ep.solve(high).losses["sun_mesh_sliding"])
""",
    "element": """
train = ep.load_case("train-eaxle").updated(coarse)
brake = {"shaft": train.operation.input, "torque": "0.7 N*m"}
result = ep.solve(train.updated({"magnet_brakes": {"B": brake}}))
result.save("braked.nc")
read = ep.open_result("braked.nc").result.parts["B.brake"]
assert type(read).__name__ == "MagnetBrakeFigures", read
assert abs(read.torque - 0.7) < 1e-12, read
for key, value in (("torque", "-0.7 N*m"), ("shaft", "moter")):
    try:
        train.updated({"magnet_brakes": {"B": brake | {key: value}}})
    except ep.InputError as error:
        assert f"magnet_brakes.B.{key}" in str(error)
    else:
        raise AssertionError(key)
print(result.losses["B.braking"] / (0.7 * train.operation.speed))
""",
    "key": """
part = case.updated({"losses.sun_drag.share": 0.25})
print(4 * ep.solve(part).losses["sun_drag"] / ep.solve(case).losses["sun_drag"])
""",
    "figure": """
numbers = {it.key: it.value for it in ep.solve(case).numbers()}
mesh = "sun_mesh_"
total = numbers[mesh + "transverse_contact_ratio"] + numbers[mesh + "overlap_ratio"]
print(numbers[mesh + "total_contact_ratio"] / total)
""",
    "family": """
result = ep.solve(case)
speed = result.flow.members["carrier"].speed
print(result.losses["carrier_made_up"] / (1e-6 * abs(speed) ** 3))
""",
}
ADDITIONS = {
    "friction": (FRICTION, 2),
    "element": (BRAKE, 3),
    "key": (KEY, 3),
    "figure": (FIGURE, 2),
    "family": (FAMILY, 8),
}


def edited(text: str, before: str, after: str) -> str:
    assert text.count(before) >= 1, f"{before!r} is not there any more"
    return text.replace(before, after, 1)


@pytest.mark.parametrize("name", ADDITIONS)
def test_an_addition_touches_few_files(name):
    edits, most = ADDITIONS[name]
    assert len({file for file, _, _ in edits}) <= most
    for file, before, _ in edits:
        assert before in (SOURCE / file).read_text(encoding="utf-8") if before else True


@pytest.mark.slow
def test_all_additions_work_together(tmp_path):
    """In one copy, as its kernels are compiled for it."""
    copy = tmp_path / "epicyclic"
    shutil.copytree(SOURCE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    for edits, _ in ADDITIONS.values():
        for file, before, after in edits:
            path = copy / file
            text = edited(path.read_text(encoding="utf-8"), before, after) if before else after
            path.write_text(text, encoding="utf-8")
    program = f"""
import epicyclic as ep
coarse = {json.dumps(COARSE)}
case = ep.load_case("talbot-2012").updated(coarse)
"""
    program += "".join(PROGRAMS.values())
    found = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(tmp_path)},
        check=False,
    )
    assert found.returncode == 0, found.stderr
    (tmp_path / "test_magnet_brake.py").write_text(TEST, encoding="utf-8")
    test = [sys.executable, "-m", "pytest", "-q", "-c", os.devnull, "test_magnet_brake.py"]
    subprocess.run(test, cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(tmp_path)}, check=True)
    ratios = [float(line) for line in found.stdout.split()]
    assert ratios == pytest.approx([1.0] * len(PROGRAMS), rel=1e-9)
