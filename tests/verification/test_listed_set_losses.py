"""Listed sets against sets of the same gears, statics in space, and balances of power."""

from __future__ import annotations

import copy
import math

import numpy as np
import pytest

import epicyclic as ep
import listed_trains
from epicyclic.build.machine import build
from epicyclic.machine.gear_mesh import MeshDuty
from epicyclic.machine.machine import mesh_force
from epicyclic.machine.planets import PlanetContact, planet_load

KINDS = ("wolfrom", "stepped", "double_planet", "ravigneaux", "plus", "layshaft")
TORQUES = (60.0, -45.0)


def solved(tables, **operation):
    tables = copy.deepcopy(tables)
    tables["operation"] |= operation
    return ep.solve(ep.load_case(tables))


def inner_losses(result):
    return {
        name.removeprefix("S.").replace("planet_ring", "ring").replace("sun_planet", "sun"): watts
        for name, watts in result.losses.items()
        if not name.endswith("thrust_bearing_viscous")
    }


# --- the same gears in another form ---------------------------------------------------------------


def both(listed, other):
    """Both forms of a set, built."""
    return [build(ep.load_case(getattr(listed_trains, name)())) for name in (listed, other)]


def test_simple_set_has_the_losses_of_the_planetary_set_under_the_same_loads():
    """Every number, tilt and unequal load of the planets too; both see the loads without losses."""
    one, two = (
        built.sets["S"].evaluate(built.state())
        for built in both("listed_simple", "train_of_planetary")
    )
    assert one.shares == two.shares
    for name, loss in one.losses.items():
        key = name.replace("sun_planet_mesh", "sun_mesh").replace("planet_ring_mesh", "ring_mesh")
        assert loss.watts == two.losses[key].watts, name
        assert loss.watts > 0 or name.endswith("drag")


def test_simple_set_and_pair_have_the_losses_of_the_usual_ones():
    """In balance with all losses, where those of the set itself react on its loads."""
    one = inner_losses(solved(listed_trains.listed_simple()))
    two = inner_losses(solved(listed_trains.train_of_planetary()))
    assert one == pytest.approx(two, rel=1e-9)
    one = solved(listed_trains.listed_pair()).losses
    two = solved(listed_trains.train_of_pair()).losses
    for kind in ("sliding", "rolling", "pocketing"):
        found = one[f"S.pinion_gear_mesh_{kind}"]
        assert found == pytest.approx(two[f"S.mesh_{kind}"], rel=1e-9)
    drags = one["S.pinion_drag"] + one["S.gear_drag"]
    assert drags == pytest.approx(two["S.drag"], rel=1e-14)


def test_meshes_of_given_efficiency_lose_as_much_as_computed_ones_that_have_it():
    """Sliding alone is a share of the power of a mesh: the two kinds of sets must then agree."""
    tables = listed_trains.wolfrom()
    kept = {
        f"{mesh}_sliding"
        for mesh in ("sun_wide_mesh", "wide_fixed_ring_mesh", "narrow_output_ring_mesh")
    }
    names = {name.removeprefix("S.") for name in solved(tables).losses}
    tables["sets"]["S"]["losses"] = {name: {"include": False} for name in names - kept}
    computed = solved(tables)
    given = copy.deepcopy(tables)
    own = given["sets"]["S"] = {key: tables["sets"]["S"][key] for key in ("planets", "meshes")}
    own["gears"] = {
        name: {key: gear[key] for key in ("teeth", "body", "internal") if key in gear}
        for name, gear in tables["sets"]["S"]["gears"].items()
        if isinstance(gear, dict)
    }
    own["mesh_efficiency"] = 0.99
    own["mesh"] = {}
    for one, two in own["meshes"]:
        key = f"S.{one}_{two}_mesh"
        share = computed.losses[f"{key}_sliding"] / abs(computed.train.rolling[key])
        own["mesh"][f"{one}-{two}"] = {"efficiency": 1 - share}
    assert solved(given).efficiency == pytest.approx(computed.efficiency, rel=1e-9)


# --- balances -------------------------------------------------------------------------------------


@pytest.mark.parametrize("torque", TORQUES)
@pytest.mark.parametrize("kind", KINDS)
def test_powers_of_all_shafts_sum_to_the_losses(kind, torque):
    result = solved(getattr(listed_trains, kind)(), torque=f"{torque} N*m")
    powers = [shaft.speed * shaft.torque for shaft in result.flow.members.values()]
    largest = max(map(abs, powers))
    assert sum(powers) == pytest.approx(sum(result.losses.values()), abs=1e-10 * largest)
    if not result.train.self_locking:
        assert 0 < result.efficiency < 1


def test_load_and_losses_vanish_with_the_torque():
    result = solved(listed_trains.ravigneaux(), torque="0 N*m")
    assert all(watts >= 0 for watts in result.losses.values())
    assert result.losses["S.long_front_ring_mesh_sliding"] < 1.0


@pytest.mark.parametrize("kind", ["stepped", "double_planet", "ravigneaux"])
def test_mirrored_set_has_the_same_losses(kind):
    """Seen in a mirror that holds the axis: speeds and torques turn round, hands change, and the
    second planet stands behind the first instead of ahead. Seen in one across the axis: hands and
    places along the axis change."""
    tables = getattr(listed_trains, kind)()
    own = tables["sets"]["S"]
    own["models"] = {"planet_tilt": "coupled" if kind == "stepped" else "left-out"}
    # the flow in the pockets depends a little on which gear is counted first
    own["losses"] = {
        f"{one}_{two}_mesh_pocketing": {"include": False} for one, two in own["meshes"]
    }
    plain = inner_losses(solved(tables))

    along = copy.deepcopy(tables)
    own = along["sets"]["S"]
    central = {"sun", "ring", "small_sun", "large_sun"}
    own["meshes"] = [pair if central & {*pair} else pair[::-1] for pair in own["meshes"]]
    own["losses"] = {
        f"{one}_{two}_mesh_pocketing": {"include": False} for one, two in own["meshes"]
    }
    next(gear for gear in own["gears"].values() if isinstance(gear, dict))["hand"] = "left"
    turned = inner_losses(solved(along, torque="-60 N*m", speed="-2000 rpm"))
    for name, watts in plain.items():
        swapped = name.replace("inner_outer", "outer_inner")
        swapped = swapped.replace("short_long_front", "long_front_short")
        # to 1e-5: points of contact that are counted from the other gear
        assert turned[swapped] == pytest.approx(watts, rel=1e-5), name

    across = copy.deepcopy(tables)
    gears = across["sets"]["S"]["gears"]
    next(gear for gear in gears.values() if isinstance(gear, dict))["hand"] = "left"
    for name, place in PLACES.get(kind, {}).items():
        gears[name]["axial_position"] = f"{-1e3 * place} mm"
    mirrored = inner_losses(solved(across))
    for name, watts in plain.items():
        assert mirrored[name] == pytest.approx(watts, rel=1e-8), name


def test_side_on_which_the_second_planet_stands_matters_to_the_bearings():
    """The same as to turn the torque round."""
    tables = listed_trains.double_planet()
    turned, behind = copy.deepcopy(tables), copy.deepcopy(tables)
    turned["operation"]["torque"] = "-60 N*m"
    meshes = behind["sets"]["S"]["meshes"]
    meshes[1] = meshes[1][::-1]
    for body in ("inner", "outer"):
        forces = [
            build(ep.load_case(case)).planet_loads()[f"S.{body}_bearing"].force
            for case in (tables, turned, behind)
        ]
        assert abs(forces[1] / forces[0] - 1) > 0.1
        assert forces[2] == pytest.approx(forces[1], rel=1e-12)


def test_plus_set_that_cannot_be_driven_back_is_self_locking():
    tables = listed_trains.plus()
    teeth = {"A": (99, 0.24), "wide": (100, 0.24), "narrow": (101, -0.27), "B": (100, -0.27)}
    own = tables["sets"]["S"]
    for name, (count, shift) in teeth.items():
        own["gears"][name] |= {"teeth": count, "profile_shift_coefficient": shift}
    own["gears"]["center_distance"] = "150 mm"
    own["carrier"] = {"outer_diameter": "333 mm", "width": "60 mm"}
    own["models"] = own.get("models", {}) | {"friction": "schlenk"}
    driven = solved(tables)
    assert driven.train.ratio == pytest.approx(-9999)
    assert 0 <= driven.efficiency < 0.1
    tables["operation"] |= {"input": "out", "output": "in", "speed": "1 rpm"}
    back = solved(tables)
    assert back.train.self_locking
    assert back.efficiency == 0.0
    assert any("Self-locking" in note for note in back.notes)


def test_losses_that_grow_beyond_bounds_next_to_self_locking_are_told_in_plain_words():
    case = ep.load_case(listed_trains.plus()).updated(
        {
            "models.friction": "constant",
            "models.constant_friction": 0.3,
            "models.load_distribution": "uniform",
            "operation.torque": "-10 N*m",
        }
    )
    with pytest.raises(ep.ConvergenceError, match=r"self-locking.*smaller losses.*reversed power"):
        ep.solve(case)
    assert ep.solve(case.updated({"operation.torque": "10 N*m"})).efficiency > 0


def test_planet_that_carries_more_heats_its_meshes_more():
    tables = listed_trains.stepped()
    own = tables["sets"]["S"]
    own["models"] = own.get("models", {}) | {"friction": "schlenk", "bearing": "palmgren"}
    for name in ("wide", "narrow"):
        own["gears"][name]["mass"] = "0 kg"
    even = solved(tables)
    tables["sets"]["S"]["load_sharing"] = {"method": "mesh-load-factor", "mesh_load_factor": 1.4}
    uneven = solved(tables)
    key = "S.planet_bearing"
    assert uneven.bearings[key].radial_force == pytest.approx(
        1.4 * even.bearings[key].radial_force, rel=1e-2
    )
    assert uneven.efficiency < even.efficiency


# --- load on the bearings of planets --------------------------------------------------------------

# pins on one arm by hand: a, and the angle of the law of cosines for the second planet
PINS = {
    "stepped": {"planet": (52.5e-3, 0.0)},
    "wolfrom": {"planet": (45e-3, 0.0)},
    "plus": {"planet": (61.5e-3, 0.0)},
    "double_planet": {
        "inner": (48e-3, 0.0),
        "outer": (61e-3, math.acos((48**2 + 61**2 - 35**2) / (2 * 48 * 61))),
    },
    "ravigneaux": {
        "short": (36e-3, 0.0),
        "long": (42.75e-3, math.acos((36**2 + 42.75**2 - 29.25**2) / (2 * 36 * 42.75))),
    },
}
# hands of the gears, the first right-handed; of spur gears it has no meaning
HANDS = {
    "stepped": {"wide": -1, "narrow": -1},
    "double_planet": {"inner": -1, "outer": 1},
    "ravigneaux": {"short": -1, "long_front": 1, "long_rear": 1},
}
# middle of the face from the middle of the bearing, gears side by side
PLACES = {
    "stepped": {"wide": -13e-3, "narrow": 9.5e-3},
    "wolfrom": {"wide": -9e-3, "narrow": 10e-3},
    "plus": {"wide": -10e-3, "narrow": 10e-3},
    "ravigneaux": {"long_front": -11e-3, "long_rear": 12.5e-3},
}


def forces_on(kind, built, body):
    """Points and forces of all meshes on a planet in fixed axes, z along the shafts."""
    case_set = listed_trains.__dict__[kind]()["sets"]["S"]
    bodies = {
        name: gear.get("body", name)
        for name, gear in case_set["gears"].items()
        if isinstance(gear, dict)
    }
    state = built.state()
    radius, angle = PINS[kind][body]
    pin = radius * np.array([math.cos(angle), math.sin(angle)])
    points, forces = [], []
    for element in built.sets["S"].meshes:
        mesh, share = element.mesh, state.torques[f"S.{element.key}"] / case_set["planets"]
        for own, other, member in ((mesh.gear1, mesh.gear2, 1), (mesh.gear2, mesh.gear1, 2)):
            if bodies[own.name] != body:
                continue
            # teeth push both gears of an external mesh round in one sense
            torque = -share if member == 1 else -share * mesh.ratio
            axis = np.zeros(2)
            if bodies[other.name] in PINS[kind]:
                a, turned = PINS[kind][bodies[other.name]]
                axis = a * np.array([math.cos(turned), math.sin(turned)])
            toward = axis - pin
            if other.internal:
                toward = -toward
            direction = math.atan2(toward[1], toward[0])
            r_w = mesh.operating_radius1 if member == 1 else mesh.operating_radius2
            hand = HANDS.get(kind, {}).get(own.name, 1)
            force = mesh_force(
                torque,
                r_w,
                mesh.operating_pressure_angle,
                mesh.operating_helix_tangent,
                hand,
                direction,
            )
            place = PLACES.get(kind, {}).get(own.name, 0.0)
            points.append([r_w * math.cos(direction), r_w * math.sin(direction), place])
            forces.append(force)
    return np.array(points), np.array(forces), angle


@pytest.mark.parametrize("torque", TORQUES)
@pytest.mark.parametrize(
    ("kind", "body"), [(kind, body) for kind, bodies in PINS.items() for body in bodies]
)
def test_load_of_a_planet_bearing_is_the_sum_of_all_mesh_forces(kind, body, torque):
    tables = getattr(listed_trains, kind)()
    for gear in tables["sets"]["S"]["gears"].values():
        if isinstance(gear, dict):
            gear["mass"] = "0 kg"
    tables["operation"]["torque"] = f"{torque} N*m"
    built = build(ep.load_case(tables))
    load = built.planet_loads()[f"S.{body}_bearing"]
    points, forces, _ = forces_on(kind, built, body)
    total = forces.sum(axis=0)
    moment = np.cross(points, forces).sum(axis=0)
    arms = np.abs(np.cross(points, forces)).max()
    # the torques of all meshes on the planet balance
    assert moment[2] == pytest.approx(0.0, abs=1e-12 * arms)
    assert load.force == pytest.approx(math.hypot(*total[:2]), rel=1e-12)
    tilting = math.hypot(*moment[:2])
    assert math.hypot(load.moment_x, load.moment_y) == pytest.approx(tilting, rel=1e-12)
    # the moment vector about an axis is the first moment of the radial forces turned by 90 degrees
    along = np.array([*total[:2], 0.0]) / load.force
    across = np.cross([0.0, 0.0, 1.0], along)
    assert load.moment_y == pytest.approx(-float(moment @ along), abs=1e-12 * arms)
    assert abs(load.moment_x) == pytest.approx(abs(float(moment @ across)), abs=1e-12 * arms)
    same_sense = load.moment_x * float(moment @ across)
    # y of the load points along z if the first mesh turns the planet in the positive sense
    key = next(m.key for m in built.sets["S"].meshes if m.key in mesh_keys(built, body))
    positive = built.state().torques[f"S.{key}"] < 0
    if abs(load.moment_x) > 1e-9 * arms:
        assert (same_sense > 0) == positive


def mesh_keys(built, body):
    """Meshes of the planet of a body."""
    planet = next(own for own in built.sets["S"].planets if own.key == f"{body}_bearing")
    return [mesh.mesh for mesh in planet.meshes]


def test_centrifugal_force_pulls_the_planet_outward():
    tables = listed_trains.stepped()
    built = build(ep.load_case(tables))
    _, forces, angle = forces_on("stepped", built, "planet")
    carrier = built.state().speeds["out"]
    outward = 0.6 * 52.5e-3 * carrier**2
    total = forces.sum(axis=0)[:2] + outward * np.array([math.cos(angle), math.sin(angle)])
    load = built.planet_loads()["S.planet_bearing"]
    assert load.force == pytest.approx(math.hypot(*total), rel=1e-12)
    assert outward > 1e-3 * load.force


def test_two_equal_meshes_on_opposite_sides_leave_no_force():
    """A planet that two mates turn in one sense from opposite sides: forces cancel, and so do the
    couples of the axial forces; only these themselves add up."""
    mesh = build(ep.load_case(listed_trains.stepped())).sets["S"].meshes[0]
    duty = MeshDuty(mesh, 12.0, 100.0, True)
    contacts = [PlanetContact(duty, 2, side * 1j, 1, -1) for side in (1.0, -1.0)]
    load = planet_load(contacts, 0.0)
    alone = planet_load(contacts[:1], 0.0)
    assert load.force < 1e-12 * alone.force
    assert abs(load.moment_x) + abs(load.moment_y) < 1e-12 * abs(alone.moment_y)
    assert sum(contact.axial_force for contact in contacts) == 2 * contacts[0].axial_force


def test_steps_of_opposite_sense_and_one_hand_push_the_planet_less_along_its_axis():
    """Axial forces of both steps act against each other if both have one hand."""
    sums = []
    for hand in ("left", "right"):
        tables = listed_trains.stepped()
        tables["sets"]["S"]["gears"]["narrow"]["hand"] = hand
        tables["sets"]["S"]["gears"]["sun"]["hand"] = "right"
        built = build(ep.load_case(tables))
        (planet,) = built.sets["S"].planets
        duties = {duty.gears.key: duty for duty in built.sets["S"].mean_duties(built.state())}
        sums.append(
            abs(
                sum(
                    own.hand
                    * math.copysign(1, -duties[own.mesh].torque1)
                    * abs(duties[own.mesh].torque1)
                    / duties[own.mesh].gears.mesh.operating_radius1
                    * duties[own.mesh].gears.mesh.operating_helix_tangent
                    for own in planet.meshes
                )
            )
        )
    assert sums[0] < 0.7 * sums[1]
