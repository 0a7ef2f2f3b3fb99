"""Trains for tests, as tables of cases."""

from __future__ import annotations

import copy
import tomllib
from importlib import resources
from typing import Any

import epicyclic as ep

PUBLISHED = tomllib.loads(
    resources.files("epicyclic.validation").joinpath("trains.toml").read_text(encoding="utf-8")
)


def published(name: str) -> dict[str, Any]:
    """A train of the validation, to be changed."""
    return copy.deepcopy(PUBLISHED[name])


def one_set(gears, meshes, held, ends, efficiency=0.99, planets=3):
    """A listed set S: `ends` are input and output member, `held` stands still."""
    return {
        "kind": "train",
        "sets": {
            "S": {
                "planets": planets,
                "mesh_efficiency": efficiency,
                "meshes": meshes,
                "gears": gears,
            }
        },
        "shafts": {"in": [f"S.{ends[0]}"], "out": [f"S.{ends[1]}"], "housing": [f"S.{held}"]},
        "operation": {"input": "in", "output": "out", "torque": "7 N*m", "speed": "1300 rpm"},
    }


def simple(sun, ring, held, ends, efficiency=0.99):
    """A simple planetary set."""
    gears = {
        "sun": {"teeth": sun},
        "planet": {"teeth": max(5, (ring - sun) // 2)},
        "ring": {"teeth": ring, "internal": True},
    }
    meshes = [["sun", "planet"], ["planet", "ring"]]
    return one_set(gears, meshes, held, ends, efficiency)


def stepped(sun, wide, narrow, ring, held, ends, efficiency=0.99):
    """Sun and ring with stepped planets between them."""
    gears = {
        "sun": {"teeth": sun},
        "wide": {"teeth": wide, "body": "planet"},
        "narrow": {"teeth": narrow, "body": "planet"},
        "ring": {"teeth": ring, "internal": True},
    }
    return one_set(gears, [["sun", "wide"], ["narrow", "ring"]], held, ends, efficiency)


def double_planet(sun, ring, held, ends, efficiency=0.99):
    """Sun, two planets that mesh with each other, ring."""
    gears = {
        "sun": {"teeth": sun},
        "inner_planet": {"teeth": 17},
        "outer_planet": {"teeth": 19},
        "ring": {"teeth": ring, "internal": True},
    }
    meshes = [["sun", "inner_planet"], ["inner_planet", "outer_planet"], ["outer_planet", "ring"]]
    return one_set(gears, meshes, held, ends, efficiency)


def plus(a, wide, narrow, b, held, ends, efficiency=0.99):
    """Two suns with stepped planets between them."""
    gears = {
        "A": {"teeth": a},
        "wide": {"teeth": wide, "body": "planet"},
        "narrow": {"teeth": narrow, "body": "planet"},
        "B": {"teeth": b},
    }
    return one_set(gears, [["A", "wide"], ["narrow", "B"]], held, ends, efficiency)


def wolfrom(sun, wide, fixed, narrow, out, efficiency=0.99):
    """The published Wolfrom set with other teeth."""
    train = published("wolfrom")
    own = train["sets"]["W"]
    own["mesh_efficiency"] = efficiency
    teeth = {"sun": sun, "wide": wide, "fixed_ring": fixed, "narrow": narrow, "output_ring": out}
    for name, count in teeth.items():
        own["gears"][name]["teeth"] = count
    return train


def turned_round(train):
    """The same with input and output exchanged."""
    turned = copy.deepcopy(train)
    operation = turned["operation"]
    operation["input"], operation["output"] = operation["output"], operation["input"]
    return turned


SMALL = {
    "numerics.mesh_positions": 5,
    "numerics.contact_segments": 5,
    "sets.pair.losses.mesh_pocketing.include": False,
    "sets.planets.losses.sun_mesh_pocketing.include": False,
    "sets.planets.losses.ring_mesh_pocketing.include": False,
}
"""Few points and no pocketing for the built-in e-axle."""


def small_axle(**changes):
    """The built-in e-axle, quickly solved."""
    return ep.load_case("train-eaxle").updated(SMALL | changes)
