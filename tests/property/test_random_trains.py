"""Ten thousand random trains: each is solved, or refused by the names of what is wrong."""

from __future__ import annotations

import math
import random
from collections import Counter

import pytest

import epicyclic as ep

ALL, BLOCK = 10_000, 2_000
BALANCE = 1e-10
"""Powers of all shafts less the loss, over the largest power: rounding of a linear system."""


def random_set(draw: random.Random) -> tuple[dict, list[str]]:
    """The tables of a set, and its members."""
    form = draw.choice(["simple", "simple", "simple", "pair", "stepped", "double", "wolfrom"])
    efficiency = draw.choice([1.0, draw.uniform(0.9, 0.999), draw.uniform(0.3, 0.9)])
    sun = draw.randint(12, 60)
    ring = sun + 2 * draw.randint(12, 50)
    if form == "simple":
        tables = {"sun": {"teeth": sun}, "ring": {"teeth": ring}, "efficiency": efficiency}
        return tables, ["sun", "ring", "carrier"]
    if form == "pair":
        internal = draw.random() < 0.3
        gear = {"teeth": ring if internal else draw.randint(12, 90), "internal": internal}
        return {"pinion": {"teeth": sun}, "gear": gear, "efficiency": efficiency}, [
            "pinion",
            "gear",
        ]
    gears = {"sun": {"teeth": sun}, "ring": {"teeth": ring, "internal": True}}
    if form == "double":
        gears |= {"one": {"teeth": 15}, "two": {"teeth": draw.randint(12, 30)}}
        meshes = [["sun", "one"], ["one", "two"], ["two", "ring"]]
        members = ["sun", "ring", "carrier"]
    else:
        gears |= {
            "wide": {"teeth": draw.randint(12, 40), "body": "planet"},
            "narrow": {"teeth": draw.randint(11, sun + 5), "body": "planet"},
        }
        meshes = [["sun", "wide"], ["narrow", "ring"]]
        members = ["sun", "ring", "carrier"]
        if form == "wolfrom":
            gears["second_ring"] = {"teeth": ring + draw.randint(-3, 3), "internal": True}
            meshes.append(["wide", "second_ring"])
            members.append("second_ring")
    tables = {"planets": 3, "mesh_efficiency": efficiency, "meshes": meshes, "gears": gears}
    return tables, members


def freedoms_of(members: list[str]) -> int:
    """Of a set by itself."""
    return 2 if "carrier" in members else 1


def random_train(seed: int) -> dict:
    """A train of up to six sets, its members joined, held and driven at random."""
    draw = random.Random(seed)
    sets, members, owners = {}, [], []
    for number in range(draw.randint(1, 6)):
        tables, own = random_set(draw)
        sets[f"S{number}"] = tables
        owners.append(own)
        members += [f"S{number}.{member}" for member in own]
    draw.shuffle(members)
    left = list(members)
    shafts = {}
    for number in range(draw.randint(0, len(members) // 2)):
        joined = [left.pop() for _ in range(min(len(left), draw.choice([2, 2, 2, 3])))]
        if len(joined) > 1:
            shafts[f"shaft{number}"] = joined
    names = [*shafts, *left]
    draw.shuffle(names)
    freedoms = len(names) - sum(len(own) - freedoms_of(own) for own in owners)
    right = draw.random() < 0.8
    wanted = freedoms - 1 if right else draw.randint(0, max(0, len(names) - 2))
    held = names[: min(max(0, wanted), len(names) - 2)]
    free = [name for name in names if name not in held] or names
    state = {"fixed": held}
    if draw.random() < 0.3 and len(free) > 3:
        state["joined"] = [draw.sample(free, 2)]
    return {
        "kind": "train",
        "sets": sets,
        "shafts": shafts,
        "states": {"x": state},
        "operation": {
            "state": "x",
            "input": free[0],
            "output": free[-1] if len(free) > 1 else names[-1],
            "torque": f"{draw.choice([0.0, 1e-6, 1.0, -30.0, 4000.0])} N*m",
            "speed": f"{draw.choice([0.0, 1e-3, 1500.0, -900.0])} rpm",
        },
    }


def outcome(seed: int) -> str:
    """How a train ends; raises if it ends in anything but a result or named problems."""
    tables = random_train(seed)
    try:
        case = ep.load_case(tables)
    except ep.InputError as error:
        for problem in error.problems:
            assert problem.key.startswith(("operation", "sets", "shafts", "states")), seed
            assert problem.allowed.endswith("."), seed
            assert len(str(problem)) < 1500, seed
        kinds = {problem.key.split(".")[0] for problem in error.problems}
        return f"refused: {', '.join(sorted(kinds))}"
    result = ep.solve(case)
    numbers = [item.value for item in result.numbers() if item.key not in MAY_BE_MISSING]
    assert all(map(math.isfinite, numbers)), seed
    powers = [member.power for member in result.flow.members.values()]
    largest = max([1e-12, *map(abs, powers)])
    assert abs(sum(powers) - result.total) <= BALANCE * largest, seed
    assert all(loss >= 0 for loss in result.losses.values()), seed
    if result.efficiency is None:
        return "no power"
    assert 0 <= result.efficiency <= 1 + 1e-12, seed
    if result.train.self_locking:
        assert any("Self-locking" in warning for warning in result.warnings), seed
        return "self-locking"
    return "solved"


MAY_BE_MISSING = ("efficiency", "load_dependent_efficiency", "power_ratio", "ratio")
"""None without power, or with an output that stands still."""


def count(seeds: range) -> Counter[str]:
    counts = Counter(outcome(seed) for seed in seeds)
    print("\n".join(f"{number:6d} {name}" for name, number in counts.most_common()))
    return counts


@pytest.mark.parametrize(
    ("first", "block"),
    [
        (400, 400),  # two of them are self-locking
        *(pytest.param(first, BLOCK, marks=pytest.mark.slow) for first in range(0, ALL, BLOCK)),
    ],
)
def test_random_trains_are_solved_or_refused_by_name(first, block):
    counts = count(range(first, first + block))
    assert counts["solved"] > block // 10
    assert counts["self-locking"] > 0
