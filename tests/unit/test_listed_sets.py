"""Sets whose gears and meshes are listed: what they are built of, and what they are refused for."""

from __future__ import annotations

import copy
import math
from dataclasses import replace
from fractions import Fraction

import pytest

import epicyclic as ep
import listed_trains
from epicyclic.build.machine import build
from epicyclic.case.train_tables import ListedGear
from epicyclic.gears.mesh import closing_number, nearest_places, pin_angle
from epicyclic.machine.disc import disc_loss
from listed_trains import BEARING, CARRIER
from problems import only, problems_of

KINDS = ("wolfrom", "stepped", "double_planet", "ravigneaux", "plus", "layshaft")


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """Compilation and imports must not count as time of a check."""
    for kind in KINDS:
        ep.load_case(getattr(listed_trains, kind)())


@pytest.mark.parametrize("kind", ["wolfrom", "ravigneaux", "layshaft"])
def test_gears_of_one_body_meet_the_oil_as_one(kind):
    """Jets bring all of the oil that flows, and each path of heat has a name of its own."""
    tables = getattr(listed_trains, kind)()
    tables |= {"models": {"temperatures": "network"}}
    tables |= {"thermal": {"oil_flow": "2.3 l/min", "jet_effectiveness": 0.7}}
    ways = ep.solve(ep.load_case(tables)).heat.ways
    names = [way.key for way in ways]
    assert len(names) == len({*names})
    found = {way.key: way.conductance for way in ways}
    jets = sum(own for name, own in found.items() if name.endswith("-jet"))
    assert jets == pytest.approx(0.7 * found["oil-outflow"], rel=1e-9)


@pytest.mark.parametrize("kind", ["wolfrom", "ravigneaux", "stepped"])
def test_all_gears_of_a_planet_drag(kind):
    """Each alone gives its part of the whole."""
    built = build(ep.load_case(getattr(listed_trains, kind)()))
    state, discs = built.state(), built.sets["S"].discs["planets_drag"]
    whole, _ = disc_loss(discs, state)
    parts = [disc_loss([disc], state)[0] for disc in discs]
    assert len({part.watts for part in parts}) == len(parts) > 1
    assert whole.watts == pytest.approx(sum(part.watts for part in parts), rel=1e-12)
    assert sum(share for *_, share in whole.brakes) == pytest.approx(1.0, rel=1e-12)


def changed(kind, **changes):
    """Tables of a kind of set with some keys changed, ``gears__sun__teeth``; None removes one."""
    tables = copy.deepcopy(getattr(listed_trains, kind)())
    for key, value in changes.items():
        *path, last = key.split("__")
        owner = tables["sets"]["S"]
        for part in path:
            owner = owner.setdefault(part, {})
        if value is None:
            del owner[last]
        else:
            owner[last] = value
    return tables


def found(kind, **changes):
    return problems_of(ep.load_case, changed(kind, **changes))


def gearing_of(kind, **changes):
    case = ep.load_case(changed(kind, **changes))
    return case.gearings["S"]


def of_mesh(kind, mesh, **keys):
    return found(kind, mesh={**getattr(listed_trains, kind)()["sets"]["S"]["mesh"], mesh: keys})


# --- what a listed set is built of ----------------------------------------------------------------


def test_models_that_those_of_a_set_replace_are_told():
    case = ep.load_case("train-eaxle").updated({"models.friction": "benedict-kelley"})
    own = case.updated({"sets.pair.models.drag": "anderson-loewenthal"})
    words = "sets.pair.models replaces [models]; not used for this set: friction."
    assert words in ep.solve(own).notes
    assert words not in ep.solve(case).notes
    warm = own.updated({"models.friction": None, "models.temperatures": "network"})
    assert not any("replaces [models]" in note for note in ep.solve(warm).notes)
    both = own.updated({"sets.pair.models.friction": "schlenk"})
    assert words not in ep.solve(both).notes


def test_losses_have_the_names_of_their_meshes_bodies_and_gears():
    shape = gearing_of("stepped")
    assert shape.terms == (
        "sun_wide_mesh_sliding",
        "sun_wide_mesh_rolling",
        "narrow_ring_mesh_sliding",
        "narrow_ring_mesh_rolling",
        "planet_bearing_mechanical",
        "planet_bearing_viscous",
        "sun_wide_mesh_pocketing",
        "narrow_ring_mesh_pocketing",
        "sun_drag",
        "ring_drag",
        "carrier_drag",
        "planets_drag",
    )
    fixed = gearing_of("layshaft")
    assert fixed.terms[-4:] == ("drive_drag", "lay_wheel_drag", "lay_pinion_drag", "driven_drag")
    assert not any("bearing" in term or "carrier" in term for term in fixed.terms)


def test_a_loss_can_be_left_out_or_scaled():
    plain = ep.solve(ep.load_case(listed_trains.layshaft()))
    case = changed(
        "layshaft",
        losses={
            "lay_wheel_drag": {"include": False},
            "lay_pinion_driven_mesh_pocketing": {"factor": 2.0},
        },
    )
    result = ep.solve(ep.load_case(case))
    assert result.losses["S.lay_wheel_drag"] == 0.0
    key = "S.lay_pinion_driven_mesh_pocketing"
    assert result.losses[key] == pytest.approx(2 * plain.losses[key], rel=1e-12)
    assert any("S.lay_wheel_drag (left out by the case)" in note for note in result.notes)
    words = key.replace(".", ": ").replace("_", " ")
    assert f"{words} is multiplied by 2." in result.notes


def test_losses_act_on_the_bodies_of_their_own_elements_even_if_one_name_begins_another():
    """Planets p and p_bearing, gears s and s_p: no loss may be taken for one of another part."""
    tables = listed_trains.double_planet()
    text = {"sun": "p_p", "inner": "p", "outer": "p_bearing"}
    own = tables["sets"]["S"]
    own["gears"] = {text.get(name, name): item for name, item in own["gears"].items()}
    own["meshes"] = [[text.get(gear, gear) for gear in pair] for pair in own["meshes"]]
    own["mesh"] = {
        "-".join(text.get(gear, gear) for gear in name.split("-")): item
        for name, item in own["mesh"].items()
    }
    tables["shafts"]["in"] = ["S.p_p"]
    built = build(ep.load_case(tables))
    losses = built.solve().solution.results["S"].losses
    carrier = "out"
    assert losses["p_bearing_mechanical"].brakes == (("S.p", carrier, 1.0),)
    assert losses["p_bearing_bearing_mechanical"].brakes == (("S.p_bearing", carrier, 1.0),)
    assert losses["p_p_p_mesh_sliding"].mesh == "S.p_p_p_mesh"
    assert losses["p_p_p_mesh_rolling"].brakes == (("in", carrier, 0.5), ("S.p", carrier, 0.5))
    assert losses["p_p_bearing_mesh_pocketing"].brakes == (
        ("S.p", carrier, 0.5),
        ("S.p_bearing", carrier, 0.5),
    )
    assert losses["p_bearing_ring_mesh_rolling"].brakes == (
        ("S.p_bearing", carrier, 0.5),
        ("housing", carrier, 0.5),
    )


def test_own_keys_of_a_gear_come_before_those_that_all_share():
    meshes = {
        mesh.key: mesh.mesh for mesh in build(ep.load_case(changed("stepped"))).sets["S"].meshes
    }
    wide, narrow = meshes["sun_wide_mesh"].gear2, meshes["narrow_ring_mesh"].gear1
    assert wide.rack.transverse_module == pytest.approx(1.5e-3)
    assert narrow.rack.transverse_module == pytest.approx(1.75e-3)
    assert [math.degrees(gear.rack.helix_angle) for gear in (wide, narrow)] == pytest.approx(
        [16, 11]
    )
    assert meshes["narrow_ring_mesh"].center_distance == pytest.approx(52.5e-3)  # of the other mesh


def test_mass_of_a_planet_is_the_sum_of_its_gears():
    sets = [
        build(ep.load_case(changed("wolfrom", **keys))).sets["S"]
        for keys in ({}, {"gears__narrow__mass": "0.3 kg"}, {"gears__wide__mass": None})
    ]
    given, sum_of_two, estimated = (own.planets[0] for own in sets)
    assert given.mass == 0.4
    assert sum_of_two.mass == pytest.approx(0.7)
    assert estimated.mass_estimated
    assert not given.mass_estimated
    assert 0.05 < estimated.mass < 2


def test_hands_follow_from_mates_and_bodies():
    shape = gearing_of("ravigneaux")
    assert shape.hands == {
        "small_sun": 1,
        "short": -1,
        "long_front": 1,
        "long_rear": 1,
        "large_sun": -1,
        "ring": 1,
    }
    shape = gearing_of("ravigneaux", gears__ring__hand="left")
    assert shape.hands["small_sun"] == -1
    # steps of one body may differ
    shape = gearing_of("stepped", gears__wide__hand="left", gears__narrow__hand="right")
    assert shape.hands == {"sun": 1, "wide": -1, "narrow": 1, "ring": 1}


def test_gears_of_a_planet_stand_side_by_side_unless_stated():
    shape = gearing_of("stepped")
    places = shape.positions
    assert places == {"wide": pytest.approx(-13e-3), "narrow": pytest.approx(9.5e-3)}
    shape = gearing_of("stepped", gears__narrow__axial_position="20 mm")
    assert shape.positions["narrow"] == pytest.approx(20e-3)


def test_what_the_order_of_the_meshes_decides_is_told():
    """Which of two planets is ahead, and how gears stand on one body, if they have a bearing."""

    def told(kind, **changes):
        return [str(it) for it in ep.load_case(changed(kind, **changes)).found]

    notes = told("ravigneaux", planet_bearing=BEARING)
    key = 'sets.S.meshes[1] = ["short", "long_front"]'
    assert f"{key}: long is assumed ahead of short in the sense of positive speeds." in notes
    key, how = "sets.S.gears.wide.axial_position", "side by side in the order of the meshes."
    assert f"{key} = -13 mm: assumed, {how}" in told("stepped")
    stated = told("stepped", gears__wide__axial_position="-14 mm")
    assert [note for note in stated if how in note] == [
        f"sets.S.gears.narrow.axial_position = 9.5 mm: assumed, {how}"
    ]
    assert not any("assumed" in note for note in told("stepped", planet_bearings=None))


def test_two_bearings_of_a_planet_are_told_once_with_their_tables():
    pin = {"pin_diameter": "9 mm", "length": "31 mm", "diametral_clearance": "30 um"}
    pin |= {"pin_roughness": "0.4 um", "bore_roughness": "0.8 um"}
    problem = only(found("stepped", planet_bearing=BEARING, planet_pin=pin))
    assert problem.key == "sets.S.planet_pin"
    assert "together with [sets.S.planet_bearing];" in problem.allowed


def test_pins_of_planets_that_mesh_stand_at_their_centre_distance():
    shape = gearing_of("ravigneaux")
    pins = shape.pins
    assert pins["short"].radius == pytest.approx(36e-3)
    assert pins["long"].radius == pytest.approx(42.75e-3)
    assert math.dist(pins["short"].place, pins["long"].place) == pytest.approx(29.25e-3)
    assert pins["long"].angle > pins["short"].angle  # listed after the short planet
    own = listed_trains.ravigneaux()["sets"]["S"]
    meshes = [own["meshes"][0], own["meshes"][1][::-1], *own["meshes"][2:]]
    shape = gearing_of("ravigneaux", meshes=meshes)
    turned = shape.pins
    assert turned["long"].angle - turned["short"].angle == pytest.approx(
        pins["short"].angle - pins["long"].angle
    )


def test_directions_of_meshes_for_forces_on_shafts():
    shape = gearing_of("layshaft")
    assert shape.directions == {
        "drive_lay_wheel_mesh": 0.0,
        "lay_pinion_driven_mesh": pytest.approx(math.pi),
    }
    shape = gearing_of("ravigneaux")
    pins, directions = shape.pins, shape.directions
    assert directions["large_sun_long_rear_mesh"] == pytest.approx(pins["long"].angle)
    back = directions["long_front_ring_mesh"] - pins["long"].angle
    assert abs(math.remainder(back, 2 * math.pi)) == pytest.approx(math.pi)


def test_forces_on_shaft_bearings_are_those_of_the_pair():
    forces = []
    for kind in ("train_of_pair", "listed_pair"):
        tables = getattr(listed_trains, kind)()
        bearing = {
            "shaft": "in",
            "type": "cylindrical",
            "bore": "40 mm",
            "outside_diameter": "80 mm",
        }
        tables["bearings"] = {
            "left": bearing | {"position": "-30 mm", "locating": True},
            "right": bearing | {"position": "55 mm"},
        }
        tables["positions"] = {"S.pinion": "0 mm"}
        state = build(ep.load_case(tables)).state()
        forces.append({name: (load.radial, load.axial) for name, load in state.forces.items()})
    assert forces[0] == forces[1]
    assert forces[0]["left"][1] > 0


def test_notes_on_flanks_and_rings_carry_the_key_of_their_gear():
    case = changed(
        "stepped",
        models={"load_distribution": "uniform"},
        gears__ring__rim_thickness="1 mm",
        gears__sun__micro_geometry={"lead_crown": "3 um"},
    )
    notes = " ".join(ep.solve(ep.load_case(case)).notes)
    assert "S: gears.ring.rim_thickness is less than the tooth height" in notes
    assert "S: models.load_distribution = uniform ignores micro-geometry" in notes


def test_models_of_a_listed_set_are_shown():
    models = ep.solve(ep.load_case(listed_trains.ravigneaux())).models
    assert models["S.friction"] == "mixed-lubrication"
    assert models["S.bearing"] == "fitted-or-palmgren"
    assert "S.bearing" not in ep.solve(ep.load_case(listed_trains.layshaft())).models


def test_each_planet_has_its_own_bearing():
    tables = changed(
        "ravigneaux",
        planet_bearings={"long": BEARING | {"cage": "full-complement", "pin_diameter": "11 mm"}},
    )
    tables["sets"]["S"]["planet_bearings"]["long"]["rollers_per_row"] = 13
    own = build(ep.load_case(tables)).sets["S"]
    short, long = (planet.bearing for planet in own.planets)
    assert (short.palmgren_coefficient, long.palmgren_coefficient) == (0.0003, 0.00055)
    assert (short.bearing.rollers_per_row, long.bearing.rollers_per_row) == (12, 13)


def test_planet_without_a_bearing_loses_nothing_there():
    result = ep.solve(ep.load_case(changed("ravigneaux", planet_bearing=None)))
    assert result.losses["S.short_bearing_mechanical"] == 0.0
    assert result.losses["S.long_bearing_mechanical"] > 0.0
    assert any("the case has no bearing of short" in note for note in result.notes)


# --- assembly -------------------------------------------------------------------------------------


def fits(arm, meshes):
    """True if a planet of two steps fits at a part of a turn, found by trying all teeth.

    `meshes`: teeth of the step and of its central gear, negative for a ring.
    """
    (one, first), (two, second) = meshes
    return any(
        (Fraction(first) * arm + tooth) / one * two % 1 == Fraction(second) * arm % 1
        for tooth in range(one)
    )


@pytest.mark.parametrize(
    "meshes",
    [
        ((50, 20), (21, -81)),
        ((50, 20), (20, -80)),
        ((42, 40), (41, 41)),
        ((23, 31), (23, -78)),
        ((24, 18), (36, -90)),
    ],
)
def test_stepped_planets_fit_where_trying_all_teeth_finds_it(meshes):
    (one, first), (two, second) = meshes
    number = closing_number([({"p": one}, first), ({"p": two}, second)])
    assert number == abs(two * first - one * second) // math.gcd(one, two)
    for count in range(2, 13):
        assert fits(Fraction(1, count), meshes) == (number % count == 0), count
        assert fits(Fraction(1, number), meshes)


def test_places_of_simple_and_double_planets_have_the_known_steps():
    # (z_s + z_r) for a planet between sun and ring, (z_r - z_s) for two that mesh with each other
    assert closing_number([({"p": 23}, 31), ({"p": 23}, -78)]) == 109
    inner, outer = ({"a": 18}, 30), ({"b": 17}, -78)
    assert closing_number([inner, ({"a": 18, "b": 17}, 0), outer]) == 48
    assert closing_number([({"p": 23}, 31)]) == 0


def test_unequal_places_are_the_nearest_that_fit():
    assert nearest_places(3, 0) == pytest.approx([0, 2 * math.pi / 3, 4 * math.pi / 3])
    step = 2 * math.pi / 109
    assert nearest_places(4, 109) == pytest.approx([0, 27 * step, 54 * step, 82 * step])


def test_pins_form_a_triangle():
    assert pin_angle(3.0, 4.0, 5.0) == pytest.approx(math.pi / 2)
    with pytest.raises(ValueError, match="triangle"):
        pin_angle(3.0, 4.0, 8.0)


def test_alike_planets_are_preferred_to_single_ones_and_these_to_unequal_spacing():
    alike = gearing_of("stepped")
    assert replace(alike, count=3).arrangement.individual is False
    single = gearing_of("plus")
    assert replace(single, count=3).arrangement.individual is True
    assert replace(single, count=2).arrangement.individual is False
    double = gearing_of("double_planet")
    uneven = replace(double, count=5).arrangement
    assert uneven.individual is False
    assert [round(math.degrees(angle), 6) for angle in uneven.angles] == [0, 75, 142.5, 217.5, 285]


def test_planets_that_must_be_made_one_by_one_are_told():
    notes = " ".join(ep.solve(ep.load_case(listed_trains.plus(3))).notes)
    assert "3 equally spaced planets cannot be identical" in notes
    assert "82/3 is not an integer" in notes
    assert "if there are 1 or 2." in notes


# --- one test for each problem --------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_sound_sets_have_no_problems(kind):
    assert found(kind) == ()


@pytest.mark.parametrize("key", ["transverse_module", "normal_pressure_angle", "helix_angle"])
def test_rack_that_no_gear_states(key):
    problem = only(found("wolfrom", **{f"gears__{key}": None}))
    told = "normal_module" if key == "transverse_module" else key
    assert problem.key == f"sets.S.gears.{told}"
    assert problem.allowed == "is missing."


def test_rack_that_one_gear_lacks():
    gears = {
        f"gears__{gear}__helix_angle": "16 deg" for gear in ("sun", "wide")
    }  # narrow and ring have their own
    assert found("stepped", gears__helix_angle=None, **gears) == ()
    gears.pop("gears__wide__helix_angle")
    problem = only(found("stepped", gears__helix_angle=None, **gears))
    assert problem.key == "sets.S.gears.wide.helix_angle"


def test_rack_stated_twice():
    problem = only(found("wolfrom", gears__normal_module="2 mm"))
    assert problem.key == "sets.S.gears.normal_module, sets.S.gears.transverse_module"
    twice = {"gears__sun__normal_module": "2 mm", "gears__sun__transverse_module": "2 mm"}
    assert "gears.sun.normal_module" in only(found("wolfrom", **twice)).key


def test_keys_of_a_gear_are_told_where_the_user_wrote_them():
    problem = only(found("wolfrom", gears__wide__roughness=None))
    assert problem.key == "sets.S.gears.wide.roughness"
    assert problem.remedy.endswith("to [sets.S.gears.wide].")
    left = {"gears__narrow__profile_shift_coefficient": None}
    left["gears__output_ring__profile_shift_coefficient"] = None
    problem = only(found("wolfrom", **left))
    assert problem.key == (
        "sets.S.gears.narrow.profile_shift_coefficient, "
        "sets.S.gears.output_ring.profile_shift_coefficient"
    )


def test_gear_that_cannot_be_cut():
    problem = only(found("wolfrom", gears__sun__tip_diameter="38 mm"))
    assert problem.key == "sets.S.gears.sun.tip_diameter"
    assert problem.value == '"38 mm"'
    assert "gears.sun.profile_shift_coefficient" in problem.remedy


def test_a_tip_circle_far_from_the_teeth_names_those_that_it_belongs_to():
    problem = only(found("wolfrom", gears__sun__tip_diameter="60 mm"))  # 12 teeth, module 2 mm
    assert problem.key == "sets.S.gears.sun.teeth, sets.S.gears.sun.tip_diameter"
    assert "28 teeth" in problem.remedy  # 28 of 2 mm, and an addendum on either side


def test_mesh_without_backlash():
    keys = {
        problem.key for problem in found("wolfrom", gears__narrow__profile_shift_coefficient=0.1)
    }
    assert any("narrow.profile_shift_coefficient" in key for key in keys)


def test_mates_of_different_module_or_helix():
    problems = found("wolfrom", gears__wide__transverse_module="2.1 mm")
    assert [problem.key for problem in problems] == ["sets.S.meshes[0]", "sets.S.meshes[1]"]
    assert "normal modules 2 mm and 2.1 mm" in problems[0].allowed
    problem = only(found("stepped", gears__ring__helix_angle="12 deg"))
    assert "helix angles 11 deg and 12 deg" in problem.allowed


def test_centre_distance_that_nothing_states():
    left = {f"gears__{name}__profile_shift_coefficient": None for name in ("sun", "fixed_ring")}
    left["gears__narrow__profile_shift_coefficient"] = None
    problem = only(found("wolfrom", gears__center_distance=None, **left))
    assert problem.key == "sets.S.mesh.sun-wide.center_distance"
    assert "sun and wide or wide and fixed_ring or narrow and output_ring" in problem.allowed
    assert problem.remedy.startswith('Add center_distance = "... mm" to [sets.S.mesh.sun-wide]')


def test_centre_distances_that_put_one_pin_at_two_places():
    problem = only(of_mesh("stepped", "narrow-ring", center_distance="52.9 mm"))
    assert problem.key == (
        "sets.S.mesh.sun-wide.center_distance, sets.S.mesh.narrow-ring.center_distance"
    )
    assert "sun-wide 52.5 mm, narrow-ring 52.9 mm" in problem.allowed
    # a = a_d needs no shift in sum
    assert "coefficients add up to 0.0000 (now -0.0200)" in problem.remedy


def test_profile_shift_that_would_fit_a_centre_distance_leaves_no_backlash():
    mesh = {
        "sun-wide": {"center_distance": "52.9 mm"},
        "narrow-ring": {"center_distance": "52.5 mm"},
    }
    problem = only(found("stepped", mesh=mesh))
    total = float(problem.remedy.split("coefficients add up to ")[1].split(" (now")[0])
    assert total < -0.1
    del mesh["narrow-ring"]
    for more, sound in ((-1e-4, True), (1e-3, False)):
        shift = {"gears__narrow__profile_shift_coefficient": total + 0.17 + more}
        assert (found("stepped", mesh=mesh, **shift) == ()) == sound


def test_planets_that_cannot_stand_at_their_centre_distance():
    problem = only(of_mesh("double_planet", "outer-inner", center_distance="120 mm"))
    assert problem.key == "sets.S.mesh.outer-inner.center_distance"
    assert "48 mm and 61 mm" in problem.allowed
    assert problem.remedy == "It must be from 13 mm to 109 mm."


def test_planet_without_a_central_gear():
    tables = changed("double_planet")
    own = tables["sets"]["S"]
    own["gears"]["extra"] = own["gears"]["outer"] | {"planet": True}
    own["meshes"].append(["outer", "extra"])
    own["gears"]["center_distance"] = "35 mm"
    keys = [problem.key for problem in problems_of(ep.load_case, tables)]
    assert keys == ["sets.S.gears.extra"]


@pytest.mark.parametrize(
    ("kind", "planets", "gears", "most"),
    [
        ("wolfrom", 4, "neighbouring wide", 3),
        ("double_planet", 6, "inner and outer", 4),
        ("ravigneaux", 6, "short and long_front", 4),
    ],
)
def test_planets_that_touch(kind, planets, gears, most):
    problem = only(found(kind, planets=planets))
    assert problem.key == "sets.S.planets"
    assert gears in problem.allowed
    assert f"at most {most} planets" in problem.remedy


def test_planets_that_do_not_share_a_plane_cannot_touch():
    """The wide rear part of the long planet passes behind the short planets, if these end there."""
    rear = {"planets": 4, "gears__long_rear__teeth": 25, "gears__large_sun__teeth": 32}
    assert found("ravigneaux", **rear) == ()
    problem = only(found("ravigneaux", gears__short__face_width="30 mm", **rear))
    assert "short and long_rear" in problem.allowed


def test_planets_for_which_there_are_no_places():
    # N = gcd(92, 2): sun 22 and ring 70 on 24 teeth, another sun 21 on 23
    gears = listed_trains.rack(2.0, distance=46.0)
    own = {"transverse_module": "2.09 mm"}
    gears |= {
        "sun": listed_trains.gear(22, -0.01),
        "wide": listed_trains.gear(24, -0.01, body="planet"),
        "ring": listed_trains.gear(70, -0.01, internal=True),
        "narrow": listed_trains.gear(23, -0.01, body="planet", **own),
        "second": listed_trains.gear(21, -0.01, **own),
    }
    meshes = [["sun", "wide"], ["wide", "ring"], ["second", "narrow"]]
    tables = changed("wolfrom", gears=gears, meshes=meshes, planet_bearing=None)
    tables["shafts"] = {"in": ["S.sun"], "out": ["S.second"], "housing": ["S.ring"]}
    problem = only(problems_of(ep.load_case, tables))
    assert problem.key == "sets.S.planets"
    assert "multiples of 360/2 deg" in problem.allowed
    assert problem.remedy.startswith("Use 1 or 2,")


def test_number_of_planets_missing_or_needless():
    assert "sets.S.planets" in [problem.key for problem in found("wolfrom", planets=None)]
    assert only(found("layshaft", planets=3)).key == "sets.S.planets"
    assert only(found("layshaft", carrier=CARRIER)).key == "sets.S.carrier"
    assert only(found("layshaft", planet_bearing=BEARING)).key == "sets.S.planet_bearing"


def test_a_hand_belongs_to_a_gear():
    assert only(found("stepped", hand="left")).remedy == "Write gears.NAME.hand."


def test_hands_that_cannot_mesh():
    hands = {"gears__sun__hand": "right", "gears__wide__hand": "right"}
    problem = only(found("stepped", **hands))
    assert problem.key == "sets.S.gears.sun.hand, sets.S.gears.wide.hand"
    assert "opposite hands" in problem.allowed
    hands = {"gears__small_sun__hand": "right", "gears__ring__hand": "left"}
    assert "hands" in found("ravigneaux", **hands)[0].allowed
    # without a helix there is no hand
    straight = {"gears__sun__hand": "right", "gears__wide__hand": "right"}
    assert found("wolfrom", **straight) == ()


def test_hand_is_a_word():
    assert "right" in only(found("stepped", gears__sun__hand=1)).allowed
    assert ListedGear.model_fields["hand"].default is None


def test_gears_of_a_planet_that_overlap():
    places = {"gears__wide__axial_position": "0 mm", "gears__narrow__axial_position": "3 mm"}
    problem = only(found("wolfrom", **places))
    assert "overlap by 16 mm" in problem.allowed
    assert problem.remedy == "Place them at least 19 mm apart."


def test_bearing_that_does_not_fit():
    bore = BEARING | {"pin_diameter": "60 mm"}
    problem = only(found("wolfrom", planet_bearing=bore))
    assert problem.key == "sets.S.planet_bearing.pin_diameter"
    assert "root circle of 55 mm" in problem.allowed  # of the narrow step
    problem = only(found("stepped", planet_bearings={"planet": bore}))
    assert problem.key == "sets.S.planet_bearings.planet.pin_diameter"
    many = {"planet": BEARING | {"rollers_per_row": 60}}
    assert only(found("stepped", planet_bearings=many)).key.endswith("rollers_per_row")
    full = {"planet": BEARING | {"cage": "full-complement"}}
    problem = only(found("stepped", planet_bearings=full, models={"bearing": "mixed-ehl"}))
    assert problem.key == "sets.S.models.bearing"


def test_bearing_of_no_planet():
    problem = only(found("stepped", planet_bearings={"planet": BEARING, "sun": BEARING}))
    assert problem.key == "sets.S.planet_bearings.sun"


def test_unknown_loss():
    problem = only(found("wolfrom", losses={"sun_wide_mesh_slidng": {"include": False}}))
    assert problem.key == "sets.S.losses.sun_wide_mesh_slidng"
    assert problem.remedy == "Did you mean 'sun_wide_mesh_sliding'?"


def test_load_sharing_that_knows_only_simple_sets():
    problem = only(found("wolfrom", load_sharing={"method": "direct"}))
    assert problem.key == "sets.S.load_sharing.method"
    sharing = {"method": "mesh-load-factor", "mesh_load_factor": 4}
    assert only(found("wolfrom", load_sharing=sharing)).key.endswith("mesh_load_factor")


def test_tilt_of_planets():
    assert (
        "mesh with each other"
        in only(found("double_planet", models={"planet_tilt": "coupled"})).allowed
    )
    assert found("stepped", models={"planet_tilt": "coupled"}) == ()
    problem = only(found("stepped", models={"planet_tilt": "coupled"}, planet_bearings=None))
    assert problem.key == "sets.S.models.planet_tilt"


def test_names_that_mean_two_things():
    tables = listed_trains.wolfrom()
    own = tables["sets"]["S"]
    own["gears"]["carrier"] = own["gears"].pop("sun")
    own["meshes"][0] = ["carrier", "wide"]
    tables["shafts"]["in"] = ["S.carrier"]
    keys = [problem.key for problem in problems_of(ep.load_case, tables)]
    assert "sets.S.gears.carrier" in keys
    tables = listed_trains.layshaft()
    own = tables["sets"]["S"]
    for old, new in (("drive", "a_b"), ("lay_wheel", "c"), ("lay_pinion", "a"), ("driven", "b_c")):
        own["gears"][new] = own["gears"].pop(old)
    own["meshes"], own["mesh"] = [["a_b", "c"], ["a", "b_c"]], {}
    tables["shafts"] = {"in": ["S.a_b"], "out": ["S.b_c"]}
    problem = only(problems_of(ep.load_case, tables))
    assert "as another mesh, a_b_c_mesh" in problem.allowed


def test_friction_table_of_the_train_serves_its_sets():
    tables = changed("wolfrom") | {
        "models": {"friction": "table"},
        "friction_table": {"film_ratio": [0.1, 1.0], "friction": [0.1, 0.05]},
    }
    assert problems_of(ep.load_case, tables) == ()
    del tables["friction_table"]
    assert "models.friction" in problems_of(ep.load_case, tables)[0].key


def test_geometry_may_stay_where_efficiencies_are_given():
    given = ep.solve(ep.load_case(changed("double_planet", mesh_efficiency=0.99)))
    assert given.losses.keys() == {"S.sun_inner_mesh", "S.inner_outer_mesh", "S.outer_ring_mesh"}
    mesh = {"sun-inner": {"center_distance": "48 mm", "efficiency": 0.5}}
    worse = ep.solve(ep.load_case(changed("double_planet", mesh_efficiency=0.99, mesh=mesh)))
    assert worse.efficiency < given.efficiency


def test_names_of_gears_may_have_hyphens():
    tables = listed_trains.layshaft()
    own = tables["sets"]["S"]
    own["gears"]["lay-pinion"] = own["gears"].pop("lay_pinion")
    own["meshes"][1] = ["lay-pinion", "driven"]
    own["mesh"] = {"driven-lay-pinion": {"misalignment": "5 um"}}
    (_, element) = build(ep.load_case(tables)).sets["S"].meshes
    assert element.deviations.misalignment == pytest.approx(5e-6)
