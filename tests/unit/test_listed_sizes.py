"""What a listed set leaves out of its gears is found from the rest."""

from __future__ import annotations

import copy

import pytest

import epicyclic as ep
import listed_trains
from problems import problems_of

X = "profile_shift_coefficient"


def tables_of(kind, gears=(), distances=False, **own):
    """Tables of a kind of set without the profile shifts of some gears, or its distances."""
    tables = copy.deepcopy(getattr(listed_trains, kind)())
    own_set = tables["sets"]["S"]
    for name in gears:
        del own_set["gears"][name][X]
    if distances:
        own_set["gears"].pop("center_distance", None)
        for mesh in own_set.get("mesh", {}).values():
            mesh.pop("center_distance", None)
    for key, value in own.items():
        owner, name = key.split("__")
        own_set.setdefault(owner, {}).setdefault(name, {}).update(value)
    return tables


def meshes(case):
    gearing = case.gearings["S"]
    return {mesh.key: gearing.geometry(mesh) for mesh in gearing.meshes}


def computed(case):
    """Keys that are computed; where planets stand is assumed."""
    return [one.key for one in case.found if "assumed" not in one.how]


@pytest.mark.parametrize(
    ("kind", "gears"),
    [
        ("stepped", ("wide", "ring")),
        ("stepped", ("sun", "narrow")),
        ("double_planet", ("inner", "outer", "ring")),
        ("ravigneaux", ("short", "long_front", "ring", "large_sun")),
        ("layshaft", ("drive", "driven")),
    ],
)
def test_profile_shifts_leave_no_backlash(kind, gears):
    case = ep.load_case(tables_of(kind, gears))
    found = set(computed(case))
    assert found == {f"sets.S.gears.{name}.{X}" for name in gears}
    touching = [
        geometry.normal_backlash
        for geometry in meshes(case).values()
        if {geometry.gear1.name, geometry.gear2.name} & set(gears)
    ]
    # a gear with two mates is the thinner of what they leave, so that one of them may have play
    assert min(touching) == pytest.approx(0.0, abs=1e-9)
    assert sum(abs(backlash) < 1e-9 for backlash in touching) >= len(touching) - 1


def test_distances_of_one_planet_are_found_once():
    case = ep.load_case(tables_of("stepped", distances=True))
    assert computed(case) == ["sets.S.mesh.sun-wide.center_distance"]
    distances = case.gearings["S"].distances
    assert len(set(distances.values())) == 1
    geometry = meshes(case)
    tight, loose = geometry["sun_wide_mesh"], geometry["narrow_ring_mesh"]
    assert tight.normal_backlash == pytest.approx(0.0, abs=1e-9)
    # worked from the stated distance of 52.5 mm, with more play inside a ring that moves away
    assert distances["sun_wide_mesh"] == pytest.approx(52.4711e-3, abs=1e-7)
    assert loose.normal_backlash > 10e-6


def test_distances_of_planets_that_mesh():
    case = ep.load_case(tables_of("double_planet", distances=True))
    assert [key.split(".")[3] for key in computed(case)] == [
        "sun-inner", "outer-inner", "outer-ring",
    ]  # fmt: skip
    assert all(abs(mesh.normal_backlash) < 1e-9 for mesh in meshes(case).values())


def test_a_stated_backlash_is_kept_and_must_agree():
    own = {"mesh__narrow-ring": {"normal_backlash": "0.07 mm"}}
    case = ep.load_case(tables_of("stepped", ("ring",), **own))
    assert meshes(case)["narrow_ring_mesh"].normal_backlash == pytest.approx(70e-6, rel=1e-9)
    (problem,) = problems_of(ep.load_case, tables_of("stepped", **own))
    assert problem.key == "sets.S.mesh.narrow-ring.normal_backlash"
    assert "contradicts" in problem.allowed


def test_allowances_thin_what_is_found():
    fits = {"gears__narrow": {"tooth_thickness_fit": "26cd"}}
    case = ep.load_case(tables_of("stepped", ("ring",), **fits))
    mesh = meshes(case)["narrow_ring_mesh"]
    narrow = case.gearings["S"].gear("narrow")
    mean = (54 + 54 + 50) / 2 if narrow.reference_radius < 25e-3 else (70 + 70 + 60) / 2
    thinned = mean * 1e-6 / (2 * narrow.rack.normal_module * 0.363970234)
    shift = case.sets["S"].members["narrow"].profile_shift_coefficient
    assert narrow.profile_shift_coefficient == pytest.approx(shift - thinned, rel=1e-6)
    assert mesh.normal_backlash == pytest.approx(mean * 1e-6 * 0.9397, rel=1e-3)


def test_a_rack_by_name_is_that_of_its_numbers():
    tables = tables_of("stepped")
    named = copy.deepcopy(tables)
    named["sets"]["S"]["gears"]["basic_rack"] = "iso-53-d"
    gears = tables["sets"]["S"]["gears"]
    gears |= {"addendum_coefficient": 1.0, "dedendum_coefficient": 1.4}
    one, two = (ep.load_case(it).gearings["S"] for it in (named, tables))
    for name, member in one.tables.items():
        assert one.gear(name) == two.gear(name)
        module = one.racks[name].normal_module
        radius = None if member.internal else pytest.approx(0.39 * module)
        assert member.tool_tip_radius == radius
    both = copy.deepcopy(named)
    both["sets"]["S"]["gears"]["dedendum_coefficient"] = 1.3
    (problem,) = problems_of(ep.load_case, both)
    assert "conflicts" in problem.allowed


def test_a_shift_that_no_case_can_state():
    own = {"mesh__narrow-ring": {"center_distance": "60 mm"}}
    own["mesh__sun-wide"] = {"center_distance": "60 mm"}
    problems = problems_of(ep.load_case, tables_of("stepped", ("sun",), **own))
    assert problems[0].key == "sets.S.gears.sun.profile_shift_coefficient"
    assert "would have to be" in problems[0].allowed


def test_gears_of_other_racks_tell_no_profile_shift():
    tables = tables_of("stepped", ("sun",))
    tables["sets"]["S"]["gears"]["sun"]["transverse_module"] = "1.6 mm"
    (problem,) = problems_of(ep.load_case, tables)
    assert problem.key == "sets.S.gears.sun.profile_shift_coefficient"
    assert "same basic rack" in problem.allowed
