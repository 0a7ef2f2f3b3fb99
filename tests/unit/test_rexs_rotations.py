"""REXS files of gear units that stand in any way: the same import, the same losses."""

from __future__ import annotations

import math

import numpy as np
import pytest

import epicyclic as ep
from rexs_files import (
    FIRST,
    SECOND,
    STAGE,
    UNIT,
    Parts,
    add_pair,
    bearing,
    mm,
    none,
    planetary,
    run,
    shaft,
    surroundings,
)

COARSE = {"numerics.mesh_positions": 4, "numerics.contact_segments": 4}
AXES = ("of all parts", "of the parts in the unit", "without the unit", "of none")
"""With the axis of the gear unit in global coordinates, in its own, not stated; and no axes."""
TEETH = 24 + 60  # Of sun and ring: planets stand at multiples of 360 degrees over it.


@pytest.fixture
def read(tmp_path):
    """Write parts to a file and read it."""

    def reading(parts: Parts):
        return ep.read_rexs(parts.write(tmp_path / "gears.rexs"))

    return reading


def any_rotation(rng):
    """A rotation of which none is more probable than another."""
    found, scale = np.linalg.qr(rng.normal(size=(3, 3)))
    found = found @ np.diag(np.sign(np.diag(scale)))
    return found if np.linalg.det(found) > 0 else found @ np.diag([-1.0, 1.0, 1.0])


def stood_otherwise(parts, seed, axes):
    """The whole unit turned and shifted."""
    rng = np.random.default_rng(seed)
    rotation, shift = any_rotation(rng), rng.uniform(-700, 700, size=3)
    for number, component in parts.components.items():
        own = component["attributes"]
        if "support_vector" in own:
            place = rotation @ own["support_vector"][0] + shift
            parts.set(number, support_vector=(place.tolist(), "mm"))
        if "u_axis_vector" in own:
            axis = None if axes == "of none" else (rotation @ own["u_axis_vector"][0]).tolist()
            parts.set(number, u_axis_vector=axis and (axis, "mm"))
    if axes == "of all parts":
        parts.set(UNIT, u_axis_vector=((rotation @ [1.0, 0, 0]).tolist(), "mm"))
    elif axes == "of the parts in the unit":
        parts.set(UNIT, u_axis_vector=([1.0, 0.0, 0.0], "mm"))
    return parts


def three_shafts():
    """Two pairs on three shafts that lie in no plane, each on two bearings of other kinds."""
    parts = Parts("2.0.0")
    surroundings(parts)
    starts = {20: (3.0, 0.0, 0.0), 21: (7.0, 47.1, 39.4), 22: (1.5, -11.2, 58.6)}
    names = ("in", "mid", "out")
    on = [shaft(parts, number, name) for number, name in zip(starts, names, strict=True)]
    add_pair(parts, FIRST, "A", (on[0], on[1]), 40.0)
    add_pair(parts, SECOND, "B", (on[1], on[2]), 71.3, hand=-1)
    owners = {**{number: number for number in starts}, FIRST + 1: 20, FIRST + 2: 21,
              SECOND + 1: 21, SECOND + 2: 22}  # fmt: skip
    run(parts, on[0], on[2], 97.0, 2900.0)
    tapered, ball, rollers = (
        f"radial_{kind}_bearing" for kind in ("tapered_roller", "grooved_ball", "roller")
    )
    for number, own, place, kind, support in (
        (80, 20, 10.2, tapered, "positive"), (81, 20, 95.1, tapered, "negative"),
        (82, 21, 14.2, ball, "both_directions"), (83, 21, 99.7, rollers, "no_direction"),
        (84, 22, 17.9, tapered, "positive"), (85, 22, 88.9, tapered, "negative"),
    ):  # fmt: skip
        bearing(parts, number, f"bearing {number}", own, place, kind=kind, support=support)
        parts.set(number, axial_factor_y_2=none(1.3 + number / 100))
        owners[number] = own
    for number, own in owners.items():
        along = parts.components[number]["attributes"]["support_vector"][0][0]
        place = [starts[own][0] if number == own else along, *starts[own][1:]]
        parts.set(number, support_vector=(place, "mm"))
    return parts


def uneven():
    """A planetary set with planets at uneven places and two plates, in axes of their own."""
    parts = planetary()
    ahead = ([1.0, 0.0, 0.0], "mm")
    for number, place in zip((20, 21, 22), (0, 29, 57), strict=True):
        angle = math.radians(17 + place * 360 / TEETH)
        point = [5.0, 42.94 * math.cos(angle), 42.94 * math.sin(angle)]
        parts.set(number, support_vector=(point, "mm"), u_axis_vector=ahead)
    parts.set(5, support_vector=([7.5, 0.0, 0.0], "mm"), u_axis_vector=ahead)
    parts.add(300, "planet_carrier", "carrier")
    parts.relate("assembly", assembly=STAGE, part=300)
    for number, place, length in ((301, 3.0, 8.0), (302, 41.0, 9.5)):
        parts.add(number, "side_plate", f"plate {number}", outer_diameter=mm(0.4 * number),
                  length=mm(length), support_vector=([place, 0.0, 0.0], "mm"),
                  u_axis_vector=ahead)  # fmt: skip
        parts.relate("assembly", assembly=300, part=number)
    return parts


def amounts(places):
    return np.array([float(place.split()[0]) for place in places])


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("seed", range(3))
def test_a_train_stands_in_any_way(read, axes, seed):
    """Places along the shafts differ by one shift, directions by one turn."""
    tables = [
        read(parts).tables
        for parts in (three_shafts(), stood_otherwise(three_shafts(), seed, axes))
    ]
    places = [
        amounts([*own["positions"].values(), *(it["position"] for it in own["bearings"].values())])
        for own in tables
    ]
    assert places[1] - places[1][0] == pytest.approx(places[0] - places[0][0], abs=1.1e-6)
    angles = [amounts(own.pop("direction") for own in it["sets"].values()) for it in tables]
    turns = (angles[1] - angles[0]) % 360
    assert turns[1] == pytest.approx(turns[0], abs=1.1e-6)
    for own in tables:
        own.pop("positions")
        for table in own["bearings"].values():
            table.pop("position")
    assert tables[0] == tables[1]


@pytest.mark.slow
@pytest.mark.parametrize("axes", AXES)
def test_a_train_loses_the_same_however_it_stands(read, axes):
    found = ep.solve(read(three_shafts()).case(COARSE))
    turned = ep.solve(read(stood_otherwise(three_shafts(), 11, axes)).case(COARSE))
    assert turned.losses == pytest.approx(found.losses, rel=1e-9)


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("seed", range(3))
def test_a_planetary_set_stands_in_any_way(read, axes, seed):
    """Planets at uneven places, plates of unlike length: every value is the same."""
    expected = read(uneven()).tables
    assert expected["planet"]["angles"] == ["0.000000 deg", "124.285714 deg", "244.285714 deg"]
    assert expected["carrier"]["width"] == "47.5 mm"
    assert read(stood_otherwise(uneven(), seed, axes)).tables == expected


def test_planets_in_axes_of_several_parts_have_no_angles(read):
    parts = uneven()
    parts.set(21, reference_component_for_position=none(5))
    assert "angles" not in read(parts).tables["planet"]


@pytest.mark.parametrize(("places", "axis"), [((5.0, 63.0), 1.0), ((63.0, 5.0), -1.0)])
def test_plates_reach_as_far_as_their_axes_point(read, places, axis):
    parts = uneven()
    for number, place in zip((301, 302), places, strict=True):
        parts.set(number, support_vector=([place, 0.0, 0.0], "mm"),
                  u_axis_vector=([axis, 0.0, 0.0], "mm"))  # fmt: skip
    assert read(parts).tables["carrier"]["width"] == "67.5 mm"


def test_places_are_in_their_units(read):
    expected = read(three_shafts()).tables
    parts = three_shafts()
    for number, component in parts.components.items():
        place = component["attributes"].get("support_vector")
        if place is not None and number % 2:
            parts.set(number, support_vector=([1e3 * it for it in place[0]], "mum"))
    assert read(parts).tables == expected
    parts.set(81, support_vector=([95.1, 0.0, 0.0], "m"))
    parts.set(82, support_vector=([14.2, 0.0, 0.0], "deg"))
    with pytest.raises(ep.InputError) as told:
        read(parts)
    assert [it.key.split()[-1] for it in told.value.problems] == ['81"', '82"']
    assert "mm or mum" in str(told.value)
