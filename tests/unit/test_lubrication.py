"""The table [lubrication]: what follows from it, in sets, pairs and trains, and what is refused."""

from __future__ import annotations

import json
import math
from itertools import chain

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.figure import Figure

import asymmetric
import epicyclic as ep
import listed_trains
from epicyclic import library
from epicyclic.build.machine import build
from epicyclic.cli.main import cli
from epicyclic.gears.gearing import outside_radius
from epicyclic.losses.drag import Dipped, SumpOil, changenet_velex, disc_drag, iso_14179_1
from epicyclic.oil.oil import mixture_state, oil_state
from epicyclic.show.plots.drawing import plot_oil
from epicyclic.show.summary import headline
from epicyclic.study.bands.inputs import uncertain_values
from epicyclic.study.bands.plan import look_nearby
from epicyclic.study.bands.study import quick_band, quick_known
from epicyclic.study.shapes import gear_shapes
from problems import only, problems_of
from trains import small_axle

QUICK = {
    "numerics.mesh_positions": 8,
    "numerics.contact_segments": 6,
    "models.pocketing": "incompressible",
}
DIP = {"method": "dip", "oil_level": "-21 mm", "oil_volume": "1.9 l"}
JETS = {"method": "jet", "oil_flow": "2.3 l/min", "jet_speed": "11 m/s"}
METHODS = {
    "jet": {},
    "spray": {},
    "flow": {"oil_flow": "1.7 l/min"},
    "drained": {},
    "dip": {"oil_level": "-21 mm", "oil_volume": "1.9 l"},
    "submerged": {},
    "grease": {},
}
DRAGS = ("sun_drag", "ring_drag", "carrier_drag")
RPM = math.pi / 30


def planetary(table=None, **changes):
    changed = {"models.planet_tilt": "left-out", "losses.sun_drag": None, "load_sharing": None}
    return _updated(asymmetric.planetary(), changed, table, changes)


def pair(table=None, **changes):
    return _updated(asymmetric.gear_pair(), {}, table, changes)


def _updated(tables, changed, table, changes):
    lubrication = {} if table is None else {"lubrication": table}
    more = {key.replace("__", "."): value for key, value in changes.items()}
    del tables["surroundings"]["oil_air_ratio"]
    return ep.load_case(tables).updated(QUICK | changed | lubrication | more)


def oil_of(case):
    return oil_state(case.lubricant.oil, case.operation.oil_inlet_temperature)


def sump(case, volume=1.9e-3):
    oil = oil_of(case)
    return SumpOil(oil.density, oil.kinematic_viscosity, volume)


# --- the share of oil -----------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
def test_share_and_band_of_each_method(method):
    known = library.named("lubrication")[method]
    case = pair(METHODS[method] | {"method": method, "oil_share_factor": 0.9})
    supply = ep.solve(case).lubrication[""]
    middle = 0.9 * known["oil_share"]
    assert supply.share == pytest.approx(middle)
    assert supply.low == pytest.approx(middle / known["lognormal_factor"] ** 1.96)
    assert supply.high == pytest.approx(min(1.0, middle * known["lognormal_factor"] ** 1.96))
    assert supply.grade == ("read" if method == "jet" else "estimate")
    assert supply.grade == "read" or supply.source.startswith("estimate")


def test_the_share_decides_drag_and_pocketing_as_a_given_one_does():
    by_method = ep.solve(pair({"method": "spray", "oil_share_factor": 1.3}))
    given = ep.solve(pair(surroundings__oil_air_ratio=1.3 * 0.05))
    known = ep.solve(pair({"method": "drained", "oil_share": 1.3 * 0.05}))
    assert by_method.losses == pytest.approx(given.losses, rel=1e-12)
    assert known.losses == pytest.approx(given.losses, rel=1e-12)
    assert known.lubrication[""].grade == "given"


def test_jets_without_a_flow_say_what_is_left_out():
    unknown, known = ep.solve(pair({"method": "jet"})), ep.solve(pair(JETS))
    assert any("oil_flow is not given" in note for note in unknown.notes)
    assert not any("oil_flow" in note for note in known.notes)
    assert sum(unknown.losses.values()) < sum(known.losses.values())


def test_a_given_ratio_has_no_effect_and_says_so():
    table = {"method": "submerged"}
    alone = ep.solve(pair(table))
    both = ep.solve(pair(table, surroundings__oil_air_ratio=0.02))
    assert both.losses == alone.losses
    assert any("oil_air_ratio has no effect" in note for note in both.notes)
    assert not any("oil_air_ratio" in note for note in alone.notes)


def test_more_oil_in_the_order_of_the_methods():
    losses = [
        ep.solve(pair(METHODS[method] | {"method": method})).load_independent
        for method in ("drained", "spray", "submerged")
    ]
    assert losses == sorted(losses)
    assert losses[0] < 0.5 * losses[1] < 0.1 * losses[2]


@pytest.mark.parametrize(
    ("table", "share_added"),
    [
        (JETS, True),
        (JETS | {"nozzle_side": "out-of-mesh"}, False),
        (JETS | {"oil_share": 0.05}, False),
        ({"method": "flow", "oil_flow": "2.3 l/min"}, True),
        ({"method": "spray", "oil_flow": "2.3 l/min"}, False),
    ],
)
def test_oil_fed_into_the_mesh_fills_its_spaces(table, share_added):
    """Flow over the volume of half the rings of teeth that pass; a pair has one mesh."""
    case = pair(table)
    (mesh,) = case.gearings[""].geometries
    passing = 0.0
    for gear, rpm in ((mesh.gear1, 3350), (mesh.gear2, 3350 * 19 / 43)):
        ring = math.pi * (gear.tip_radius**2 - gear.root_radius**2)
        passing += rpm / 60 * ring * gear.face_width / 2
    added = 2.3e-3 / 60 / passing if share_added else 0.0
    supply = ep.solve(case).lubrication[""]
    assert supply.meshes["mesh"] == pytest.approx(0.05 + added)
    assert added == 0.0 or 0.001 < added < 0.1


def test_oil_is_fed_to_every_mesh_of_every_planet():
    flow, other = (
        ep.solve(planetary({"method": "flow", "oil_flow": f"{litres} l/min"})).lubrication[""]
        for litres in (1.2, 3.6)
    )
    for mesh in ("sun_mesh", "ring_mesh"):
        added = [supply.meshes[mesh] - supply.share for supply in (flow, other)]
        assert added[1] == pytest.approx(3 * added[0])
    sun = flow.meshes["sun_mesh"] - flow.share
    case = planetary()
    one, two = case.gearings[""].geometries[0], 8
    members = ep.solve(case).flow.members
    relative = abs(members["sun"].speed - members["carrier"].speed)
    passing = 0.0
    for gear, speed in ((one.gear1, relative), (one.gear2, relative * 31 / 23)):
        ring = math.pi * (gear.tip_radius**2 - gear.root_radius**2)
        passing += speed / (2 * math.pi) * ring * gear.face_width / 2
    assert sun == pytest.approx(1.2e-3 / 60 / two / passing)


# --- churning and jets ----------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["changenet-velex", "iso-14179-1"])
def test_what_dips_churns_and_the_rest_drags(model):
    case = planetary(DIP | {"churning": model})
    result = ep.solve(case.updated({"models.drag": "seetharaman-kahraman"}))  # planets do not drag
    torque = {"changenet-velex": changenet_velex, "iso-14179-1": iso_14179_1}[model]
    sun = case.gearings[""].gear("sun")
    ring = case.gearings[""].gear("ring")
    outside = outside_radius(ring, case.ring)
    module = 2.1e-3
    parts = {
        "sun": Dipped(
            sun.reference_radius,
            sun.tip_radius,
            27.2e-3,
            sun.tip_radius - 21e-3,
            module,
            31,
            sun.tip_radius - sun.root_radius,
            math.radians(20.5),
            math.radians(14.3),
        ),
        "ring": Dipped(outside, outside, ring.face_width, outside - 21e-3, module),
        "carrier": Dipped(74e-3, 74e-3, 44e-3, 53e-3, module),
    }
    assert all(part.depth > 0.01 for part in parts.values())
    for name, part in parts.items():
        speed = result.flow.members[name].speed
        expected = torque(part, speed, sump(case)) * abs(speed)
        assert result.losses[f"{name}_drag"] == pytest.approx(expected, rel=1e-9)
    churning = result.lubrication[""].churning
    assert churning[model] == pytest.approx(sum(result.losses[f"{n}_drag"] for n in parts))
    assert set(churning) == {"changenet-velex", "iso-14179-1"}
    assert len(set(churning.values())) == 2


def test_a_gear_above_the_oil_turns_in_the_mixture():
    laminar = {"models.drag": "seetharaman-kahraman"}
    case = planetary(DIP | {"oil_level": "-60 mm"}).updated(laminar)
    result = ep.solve(case)
    sun = case.gearings[""].gear("sun")
    mixture = mixture_state(oil_of(case), 0.1, case.surroundings.pressure)
    expected = sum(disc_drag(sun.tip_radius, 27.2e-3, 2900 * RPM, mixture))
    assert result.losses["sun_drag"] == pytest.approx(expected, rel=1e-9)
    assert result.losses["carrier_drag"] > 0
    assert any("Churning of planets" in note for note in result.notes)


def test_a_result_says_if_nothing_dips():
    result = ep.solve(pair(DIP | {"oil_level": "-400 mm"}))
    assert result.lubrication[""].churning == {}
    assert "no turning part reaches the oil" in result.standing["lubrication"]
    assert "no turning part" not in ep.solve(pair(DIP)).standing["lubrication"]
    words = "no turning part reaches the oil of the sump."
    assert words in result.notes
    assert words not in ep.solve(pair(DIP)).notes


@pytest.mark.parametrize(("level", "told"), [("-400 mm", 0), ("-26.8 mm", 1), ("490 mm", 0)])
def test_gears_that_lose_less_as_they_dip_than_above_the_oil_say_so(level, told):
    result = ep.solve(pair(DIP | {"oil_level": level}))
    found = [note for note in result.notes if "of which none is added" in note]
    assert len(found) == told


@pytest.mark.parametrize(("level", "told"), [("-12 mm", False), ("490 mm", True)])
def test_a_result_says_if_all_is_below_the_oil(level, told):
    words = 'all turning parts are below the oil; method = "submerged" is for that.'
    assert (words in ep.solve(pair(DIP | {"oil_level": level})).notes) == told


def test_depths_of_single_parts_are_those_of_a_level():
    case = pair({"method": "dip", "oil_level": "-12 mm", "oil_volume": "1.9 l"})
    (mesh,) = case.gearings[""].geometries
    depths = {gear.name: f"{1e3 * gear.tip_radius - 12!r} mm" for gear in (mesh.gear1, mesh.gear2)}
    single = pair({"method": "dip", "immersion": depths, "oil_volume": "1.9 l"})
    assert ep.solve(single).losses == pytest.approx(ep.solve(case).losses, rel=1e-9)
    only_gear = pair(
        {"method": "dip", "immersion": {"gear": depths["gear"]}, "oil_volume": "1.9 l"}
    )
    assert ep.solve(only_gear).lubrication[""].churning["changenet-velex"] > 0
    assert ep.solve(only_gear).losses["drag"] < ep.solve(case).losses["drag"]


def test_the_volume_of_the_sump_is_stated_once():
    table = {key: value for key, value in DIP.items() if key != "oil_volume"}
    taken = ep.solve(planetary(table, thermal__oil_volume="1.9 l"))
    assert taken.losses == ep.solve(planetary(DIP)).losses


@pytest.mark.parametrize(("side", "along"), [("in-mesh", -1), ("out-of-mesh", 1), ("radial", 0)])
def test_jets_take_momentum_from_the_gears_that_turn(side, along):
    """Sun and ring turn and take half of 2.3 l/min each."""
    without, jets = (
        ep.solve(planetary(table)) for table in ({"method": "jet"}, JETS | {"nozzle_side": side})
    )
    case = planetary()
    density = oil_of(case).density
    for name, teeth in (("sun", 31), ("ring", case.ring.teeth)):
        pitch = teeth * 2.1e-3 / math.cos(math.radians(14.3)) / 2
        speed = abs(jets.flow.members[name].speed) * pitch
        expected = density * 1.15e-3 / 60 * speed * max(speed + along * 11, 0)
        taken = jets.losses[f"{name}_drag"] - without.losses[f"{name}_drag"]
        assert taken == pytest.approx(expected, rel=1e-6, abs=1e-9)
    assert jets.losses["carrier_drag"] == pytest.approx(without.losses["carrier_drag"])


def test_a_held_ring_leaves_all_of_the_oil_to_the_sun():
    held = {"operation.second_input": None, "operation.second_speed": None}
    case = planetary(JETS).updated(held | {"operation.fixed": "ring"})
    plain = case.updated({"lubrication.oil_flow": None, "lubrication.jet_speed": None})
    taken = ep.solve(case).losses["sun_drag"] - ep.solve(plain).losses["sun_drag"]
    speed = 2900 * RPM * 31 * 2.1e-3 / math.cos(math.radians(14.3)) / 2
    expected = oil_of(case).density * 2.3e-3 / 60 * speed * max(speed - 11, 0)
    assert taken == pytest.approx(expected, rel=1e-6, abs=1e-9)


def test_churning_beyond_its_range_is_told_by_watts():
    result = ep.solve(planetary(DIP | {"oil_level": "40 mm"}))
    flags = [flag for flag in result.flags if flag.quantity == "immersion depth over the diameter"]
    assert {flag.use.where for flag in flags} == {"sun", "ring", "carrier"}
    (told,) = [text for text in result.warnings if "immersion depth over the diameter" in text]
    churned = sum(result.losses[name] for name in DRAGS)
    assert f"{churned:.3g} W in all" in told


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("speed", ["0 rpm", "1e-160 rpm", "0.01 rpm", "60000 rpm"])
def test_losses_are_finite_at_any_speed(method, speed):
    table = METHODS[method] | {"method": method}
    result = ep.solve(
        pair(table, operation__speed=speed, losses__mesh_pocketing={"include": False})
    )
    assert all(math.isfinite(watts) and watts >= 0 for watts in result.losses.values())


def test_drag_grows_with_the_level_and_the_speed():
    tables = [DIP | {"oil_level": f"{level} mm"} for level in (-28, -13, 7)]
    losses = [ep.solve(pair(table)).losses["drag"] for table in tables]
    assert losses == sorted(losses)
    assert len(set(losses)) == 3
    by_speed = [
        ep.solve(pair(DIP, operation__speed=f"{rpm} rpm")).losses["drag"]
        for rpm in (310, 620, 1250, 2500, 4900)
    ]
    assert by_speed == sorted(by_speed)


# --- the band -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("table", "key", "factor"),
    [
        (None, "surroundings.oil_air_ratio", 2.0),
        ({"method": "drained"}, "lubrication.oil_share_factor", 3.0),
        ({"method": "jet"}, "lubrication.oil_share_factor", 2.0),
        ({"method": "jet", "oil_share": 0.033}, "lubrication.oil_share", 2.0),
    ],
)
def test_one_key_carries_how_well_the_share_is_known(table, key, factor):
    values, problems = uncertain_values(pair(table))
    assert not problems
    (value,) = [one for one in values if "oil_share" in one.key or "oil_air" in one.key]
    assert (value.key, value.kind, value.spread) == (key, "lognormal", (factor,))


def test_the_share_widens_the_band_of_the_total():
    """The two ends of the share make the losses that the share itself makes."""
    case = pair({"method": "spray"}, operation__torque="3.7 N*m")
    nearby = look_nearby(case, ep.solve(case))
    place = [value.key for value in nearby.values].index("lubrication.oil_share_factor")
    for end, share in zip(nearby.ends[place], (0.05 / 2.5, 0.05 * 2.5), strict=True):
        own = ep.solve(pair({"method": "spray", "oil_share": share}, operation__torque="3.7 N*m"))
        assert dict(zip(nearby.outputs.losses, end, strict=True)) == pytest.approx(
            {name: own.losses[name] for name in nearby.outputs.losses}, rel=1e-9
        )
    band = quick_band(nearby)
    drivers = [name for name, _ in band.drivers[:2]]
    assert set(drivers) == {"lubrication.oil_share_factor", "model_form.windage"}
    total = band.results[nearby.outputs.names.index("total")]
    low, high = np.quantile(total, [0.025, 0.975])
    assert low < ep.solve(case).total < high


def test_a_stated_uncertainty_counts():
    stated = {"lubrication.oil_share_factor": {"lognormal_factor": 1.21}}
    values, _ = uncertain_values(pair({"method": "spray"}, uncertainty=stated))
    (value,) = [one for one in values if one.key == "lubrication.oil_share_factor"]
    assert (value.spread, value.source) == ((1.21,), "given by the case")


def test_churning_has_a_factor_of_its_own():
    nearby = look_nearby(pair(DIP), ep.solve(pair(DIP)))
    kinds = dict(zip(nearby.outputs.losses, nearby.outputs.kinds, strict=True))
    assert kinds["drag"] == {"churning": 1.0}
    (value,) = [one for one in nearby.values if one.key == "model_form.churning"]
    assert value.spread == (2.0,)
    assert not {"model_form.drag", "model_form.windage"} & {one.key for one in nearby.values}
    for model, kind in (("auto", "windage"), ("theodorsen-regier", "drag")):
        case = pair().updated({"models.drag": model})
        mixture = look_nearby(case, ep.solve(case))
        assert f"model_form.{kind}" in {one.key for one in mixture.values}


# --- temperatures ---------------------------------------------------------------------------------


def rises(case):
    result = ep.solve(case)
    inlet = case.operation.oil_inlet_temperature
    return {
        node: kelvin - inlet for node, kelvin in result.heat.temperatures.items() if node != "oil"
    }


@pytest.mark.parametrize(
    ("method", "lubrication"),
    [("jet", "spray"), ("drained", "spray"), ("dip", "dip"), ("submerged", "submerged")],
)
def test_temperatures_take_the_method(method, lubrication):
    table = METHODS[method] | {"method": method}
    for models in ("flank", "network"):
        common = {"models__temperatures": models, "thermal__oil_flow": "3.1 l/min"}
        given = common | {"thermal__lubrication": lubrication}
        assert rises(pair(table, **common)) == rises(pair(table, **given))


def test_flanks_are_as_warm_as_the_factor_of_the_method():
    losses = {"losses.mesh_pocketing.include": False, "losses.drag.include": False}
    jet, bath = (
        rises(
            pair(METHODS[method] | {"method": method}, models__temperatures="flank").updated(losses)
        )
        for method in ("jet", "submerged")
    )
    for node in ("pinion", "gear"):
        assert 4 * bath[node] < jet[node] < 8 * bath[node]


def test_the_flow_to_the_gears_is_that_of_the_heat():
    heat = {"models__temperatures": "network"}
    spray = {"method": "spray", "oil_flow": "2.3 l/min"}
    own = rises(pair(spray, **heat))
    assert own == rises(pair({"method": "spray"}, **heat, thermal__oil_flow="2.3 l/min"))
    assert own != rises(pair(spray | {"oil_flow": "2.9 l/min"}, **heat))


def test_of_more_oil_only_what_meets_the_gears_cools_them():
    heat = {"models__temperatures": "network", "thermal__oil_flow": "4.6 l/min"}
    half = pair({"method": "spray", "oil_flow": "2.3 l/min"}, **heat)
    weaker = pair({"method": "spray"}, **heat, thermal__jet_effectiveness=0.25)
    assert rises(half) == pytest.approx(rises(weaker), rel=1e-9)


def test_the_bath_share_of_the_heat_follows_from_the_level():
    """Depths of 14 mm below the axes: theta of each gear from its tip circle."""
    heat = {"models__temperatures": "network", "thermal__oil_flow": "3.1 l/min"}
    table = {"method": "dip", "oil_level": "-14 mm", "oil_volume": "1.9 l"}
    case = pair(table, **heat)
    (mesh,) = case.gearings[""].geometries
    angles = [math.acos(14e-3 / gear.tip_radius) for gear in (mesh.gear1, mesh.gear2)]
    share = sum(angles) / 2 / math.pi
    assert 0.2 < share < 0.5
    assert rises(case) == pytest.approx(
        rises(pair(table, **heat, thermal__bath_share=share)), rel=1e-9
    )
    assert rises(case) != rises(pair(table, **heat, thermal__bath_share=0.3))


def test_warming_up_takes_the_volume_of_the_sump():
    heat = {"thermal__oil_flow": "2.2 l/min", "models__temperatures": "network"}
    curves = [
        ep.warm_up(case, "40 s", "22 degC")
        for case in (
            pair(DIP, **heat),
            pair({"method": "dip", "oil_level": "-21 mm"}, **heat, thermal__oil_volume="1.9 l"),
        )
    ]
    assert curves[0].equals(curves[1])


# --- trains ---------------------------------------------------------------------------------------


def train_of(tables, table):
    tables["lubrication"] = table
    tables["surroundings"].pop("oil_air_ratio", None)
    changes = QUICK | {"models.planet_tilt": "left-out"}
    return ep.load_case(tables).updated(changes)


@pytest.mark.parametrize("tables", [listed_trains.train_of_planetary, listed_trains.listed_simple])
@pytest.mark.parametrize("table", [DIP, JETS])
def test_a_set_of_a_train_is_lubricated_as_alone(tables, table):
    found = ep.solve(train_of(tables(), table))
    single = ep.solve(planetary(table))
    assert found.lubrication["S"].share == single.lubrication[""].share
    for name in DRAGS:
        assert found.losses[f"S.{name}"] == pytest.approx(single.losses[name], rel=1e-9)


def test_a_level_that_no_set_dips_by_is_told():
    shared = {f"lubrication.{key}": value for key, value in DIP.items()}
    own = {f"sets.{name}.{key}": it for name in ("pair", "planets") for key, it in shared.items()}
    words = "lubrication.oil_level has no effect: no set dips by it."
    assert words not in ep.solve(small_axle(**shared)).notes
    assert words not in ep.solve(small_axle(**own | {"lubrication.method": "drained"})).notes
    own |= {f"sets.{name}.lubrication.oil_level": "-3 mm" for name in ("pair", "planets")}
    assert words in ep.solve(small_axle(**shared | own)).notes


def test_each_set_of_a_train_may_have_its_own_method():
    shared = {"lubrication.method": "jet", "lubrication.oil_flow": "1.3 l/min"}
    own = shared | {"sets.planets.lubrication.method": "drained"}
    none, jets, both = (ep.solve(small_axle(**changes)) for changes in ({}, shared, own))
    assert {key: item.method for key, item in both.lubrication.items()} == {
        "pair": "jet",
        "planets": "drained",
    }
    assert both.losses["pair.drag"] == pytest.approx(jets.losses["pair.drag"], rel=1e-9)
    assert jets.losses["pair.drag"] > none.losses["pair.drag"]
    for name in ("planets.sun_drag", "planets.carrier_drag"):
        assert both.losses[name] < none.losses[name] <= jets.losses[name]
    assert {key: item["method"] for key, item in both.to_dict()["lubrication"].items()} == {
        "pair": "jet",
        "planets": "drained",
    }
    keys = {value.key for value in uncertain_values(small_axle(**own))[0]}
    factors = {key for key in keys if "oil_share" in key or "oil_air" in key}
    assert factors == {"lubrication.oil_share_factor", "sets.planets.lubrication.oil_share_factor"}


def test_flanks_of_each_set_follow_its_method():
    heat = {"models.temperatures": "flank", "lubrication.method": "spray"}
    spray, bath = (
        ep.solve(small_axle(**heat, **more)).heat.temperatures
        for more in ({}, {"sets.planets.lubrication.method": "submerged"})
    )
    inlet = 273.15 + 80
    assert bath["pair.pinion"] == pytest.approx(spray["pair.pinion"], abs=1.0)
    assert bath["planets.sun"] - inlet < 0.3 * (spray["planets.sun"] - inlet)


def test_heat_of_each_set_leaves_as_its_method_says():
    heat = {
        "models.temperatures": "network",
        "lubrication.method": "jet",
        "lubrication.oil_flow": "1.3 l/min",
    }
    jets, both = (
        ep.solve(small_axle(**heat, **more)).heat
        for more in ({}, {"sets.planets.lubrication.method": "submerged"})
    )
    ways = [{way.key: way for way in it.ways} for it in (jets, both)]
    assert {"pair.pinion-jet", "planets.sun-jet", "planets.pin-jet"} <= set(ways[0])
    jetted = {key for key in ways[1] if key.endswith("-jet")}
    assert {"pair.pinion-jet", "pair.gear-jet", "motor_front-jet"} <= jetted
    assert not any(key.startswith("planets.") for key in jetted)
    # each set had a flow of its own, of oil that is somewhat colder then
    carried = [sum(w.conductance for k, w in it.items() if k.endswith("-jet")) for it in ways]
    assert carried[1] == pytest.approx(carried[0] / 2, rel=0.05)
    assert ways[1]["planets.sun-oil"].conductance > 3 * ways[0]["planets.sun-oil"].conductance
    assert ways[1]["pair.gear-oil"].conductance == pytest.approx(
        ways[0]["pair.gear-oil"].conductance, rel=0.2
    )


# --- one level for a housing ---------------------------------------------------------------------


SUMP = {"lubrication": {"method": "dip", "oil_volume": "1.9 l"}, "sets.pair.direction": "-37 deg"}


def depths(case):
    """By set and part. [m]"""
    found = {key: own.discs.values() for key, own in build(case).sets.items()}
    return {
        (key, disc.where): disc.sump.part.depth
        for key, discs in found.items()
        for disc in chain.from_iterable(discs)
        if disc.sump is not None
    }


def test_one_oil_level_is_the_immersions_that_follow_from_it():
    level = small_axle(**SUMP | {"housing.oil_level": "-23 mm"})
    (mesh,) = level.gearings["pair"].geometries
    drop = mesh.center_distance * math.sin(math.radians(37))
    found = depths(level)
    assert found["pair", "pinion"] == pytest.approx(max(mesh.gear1.tip_radius - 0.023, 0))
    assert found["pair", "gear"] == pytest.approx(mesh.gear2.tip_radius - 0.023 + drop)
    sun = level.gearings["planets"].gear("sun")
    assert found["planets", "sun"] == pytest.approx(max(sun.tip_radius - 0.023 + drop, 0))
    stated = small_axle(
        **SUMP,
        **{
            f"sets.{name}.lubrication": {
                "method": "dip",
                "oil_volume": "1.9 l",
                "immersion": {
                    part: f"{1e3 * deep!r} mm" for (key, part), deep in found.items() if key == name
                },
            }
            for name in ("pair", "planets")
        },
    )
    assert depths(stated) == pytest.approx(found, rel=1e-12)
    assert build(stated).sets["pair"].discs == build(level).sets["pair"].discs


def test_a_level_counts_from_any_shaft_or_the_bottom_in_any_position():
    drop = small_axle().gearings["pair"].geometries[0].center_distance * math.sin(0.3)
    down = SUMP | {"sets.pair.direction": "-0.3 rad"}
    wanted = depths(small_axle(**down | {"housing.oil_level": "-23 mm"}))
    for own in (
        {"oil_level": f"{1e3 * drop - 23!r} mm", "shaft": "planets.sun"},
        {"oil_depth": "31 mm", "bottom": "54 mm"},
    ):
        assert depths(small_axle(**down | {"housing": own})) == pytest.approx(wanted, rel=1e-12)
    turned = {"sets.pair.direction": "0.9 rad", "housing.oil_level": "-23 mm"}
    turned["housing.tilt"] = "-1.2 rad"
    assert depths(small_axle(**SUMP | turned)) == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "key", "said"),
    [
        ({}, "lubrication.oil_level", "[housing]"),
        ({"housing.oil_depth": "9 mm"}, "housing.bottom", "belongs to oil_depth"),
        ({"housing": {"oil_level": "9 mm", "shaft": "moter"}}, "housing.shaft", "'motor'"),
        ({"housing.oil_level": "9 mm", "lubrication.oil_level": "8 mm"}, "housing", "no effect"),
    ],
)
def test_a_level_that_cannot_be_has_one_clear_problem(changes, key, said):
    problem = only(problems_of(lambda: small_axle(**SUMP | changes)))
    assert problem.key == key
    assert said in f"{problem.allowed} {problem.remedy}"


@pytest.mark.slow
def test_gears_are_drawn_in_the_oil():
    shapes = gear_shapes(small_axle(**SUMP | {"housing.oil_level": "-23 mm"}))
    gear, planet = shapes["pair.gear"], shapes["planets.planet"]
    assert float(gear["oil_depth"]) == pytest.approx(
        float(gear["tip_diameter"]) / 2 - 23 - float(gear["stands_y"][0])
    )
    assert "oil_depth" not in planet
    assert planet.sizes["place"] > 1
    ax = plot_oil(shapes, Figure().subplots())
    assert "oil at rest" in [text.get_text() for text in ax.get_legend().get_texts()]


# --- what is refused ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("table", "key", "said"),
    [
        ({"method": "jets"}, "lubrication.method", '"jet"'),
        ({"oil_flow": "2 l/min"}, "lubrication.method", "is missing"),
        ({"method": "flow"}, "lubrication.oil_flow", "is missing"),
        ({"method": "jet", "oil_flow": "2 mm"}, "lubrication.oil_flow", "l/min"),
        ({"method": "jet", "oil_level": "-9 mm"}, "lubrication.oil_level", "has no effect"),
        ({"method": "jet", "jet_speed": "9 m/s"}, "lubrication.jet_speed", "without oil_flow"),
        ({"method": "jet", "nozzle_side": "radial"}, "lubrication.nozzle_side", "oil_flow"),
        ({"method": "drained", "churning": "iso-14179-1"}, "lubrication.churning", "has no effect"),
        ({"method": "dip", "oil_volume": "1.9 l"}, "lubrication.oil_level", "is missing"),
        ({"method": "dip", "oil_level": "-9 mm"}, "lubrication.oil_volume", "is missing"),
        (
            DIP | {"immersion": {"gear": "9 mm"}},
            "lubrication.oil_level, lubrication.immersion",
            "twice",
        ),
        (
            {"method": "dip", "immersion": {"geer": "9 mm"}, "oil_volume": "1.9 l"},
            "lubrication.immersion.geer",
            "pinion, gear",
        ),
        (
            {"method": "jet", "oil_share": 0.031, "oil_share_factor": 1.2},
            "lubrication.oil_share, lubrication.oil_share_factor",
            "exclude",
        ),
        (DIP | {"oil_volume": "0 l"}, "lubrication.oil_volume", "> 0"),
        ({"method": "jet", "oil_share": 1.2}, "lubrication.oil_share", "<= 1"),
        ({"method": "jet", "oil_share_factor": 0}, "lubrication.oil_share_factor", "> 0"),
        ({"method": "jet", "side": "radial"}, "lubrication.side", "known key"),
    ],
)
def test_bad_tables_have_one_clear_problem(table, key, said):
    problem = only(problems_of(pair, table))
    assert problem.key == key
    assert said in f"{problem.allowed} {problem.remedy}"


@pytest.mark.parametrize(
    ("table", "changes", "key"),
    [
        (DIP, {"thermal__lubrication": "spray"}, "thermal.lubrication"),
        (JETS, {"thermal__lubrication": "submerged"}, "thermal.lubrication"),
        (DIP, {"thermal__oil_volume": "2.1 l"}, "lubrication.oil_volume, thermal.oil_volume"),
        ({"method": "jet"}, {"models__temperatures": "network"}, "thermal"),
        (
            JETS,
            {"uncertainty": {"surroundings.oil_air_ratio": {"lognormal_factor": 1.3}}},
            'uncertainty."surroundings.oil_air_ratio"',
        ),
    ],
)
def test_contradictions_have_one_clear_problem(table, changes, key):
    def read():
        return pair(table, **changes)

    assert only(problems_of(read)).key == key


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"sets.pair.lubrication.method": "jet"}, "sets.pair.lubrication"),
        (
            {
                "lubrication.method": "dip",
                "lubrication.immersion": {"gear": "7 mm"},
                "lubrication.oil_volume": "1.9 l",
            },
            "lubrication.immersion",
        ),
        (
            {
                "lubrication.method": "drained",
                "sets.pair.lubrication": {"method": "dip", "oil_level": "-7 mm"},
                "thermal.oil_volume": None,
            },
            "sets.pair.lubrication.oil_volume",
        ),
        (
            {
                "lubrication.method": "jet",
                "sets.pair.lubrication": {"method": "drained", "oil_flow": "1 l/min"},
            },
            "sets.pair.lubrication.oil_flow",
        ),
        (
            {
                "lubrication.method": "jet",
                "thermal.lubrication": "spray",
                "sets.pair.lubrication": {"method": "submerged"},
            },
            "thermal.lubrication",
        ),
    ],
)
def test_bad_tables_of_a_train_have_one_clear_problem(changes, key):
    def read():
        return small_axle(**changes)

    assert only(problems_of(read)).key == key


# --- what is shown --------------------------------------------------------------------------------


def test_command_and_json_say_how_the_gears_are_lubricated():
    given = ["--set", "lubrication.method=dip", "--set", "lubrication.oil_level=-9 mm"]
    given += ["--set", "lubrication.oil_volume=1.9 l", "--set", "operation.torque=100 N*m"]
    run = CliRunner().invoke(cli, ["run", "talbot-2012-pair", "--details", *given])
    assert run.exit_code == 0
    text = " ".join(run.output.split())
    assert "lubrication: dip: share of oil 0.1 (95 %: 0.017 to 0.6; estimate:" in text
    assert "churning: changenet-velex " in text
    assert "iso-14179-1 " in text
    shown = CliRunner().invoke(cli, ["run", "talbot-2012-pair", *given, "--json"])
    found = json.loads(shown.output)
    assert found["models"]["lubrication"] == "dip"
    assert found["models"]["churning"] == "changenet-velex"
    supply = found["lubrication"]
    assert supply["method"] == "dip"
    share = supply["oil_share"]
    assert share["low"] < share["value"] == 0.1 < share["high"]
    assert share["unit"] == "1"
    assert supply["churning"]["changenet-velex"]["unit"] == "W"
    assert found["losses"]["drag"] == pytest.approx(supply["churning"]["changenet-velex"]["value"])


def test_check_says_how_the_gears_are_lubricated():
    check = ["check", "train-eaxle", "--set", "lubrication.method=jet"]
    shown = CliRunner().invoke(cli, [*check, "--set", "sets.planets.lubrication.method=drained"])
    assert shown.exit_code == 0
    assert "Lubrication of pair: jet: share of oil 0.05 (95 %: 0.013 to 0.19;" in shown.output
    assert "Lubrication of planets: drained: share of oil 0.01 (95 %" in shown.output
    assert "Lubrication" not in CliRunner().invoke(cli, ["check", "train-eaxle"]).output


def test_grease_lubricates_with_its_base_oil_and_says_what_no_model_covers():
    greased = ep.solve(pair({"method": "grease"}))
    assert greased.losses == ep.solve(pair({"method": "drained"})).losses
    assert any("No friction model covers starved films of grease" in it for it in greased.notes)
    known = quick_known(pair({"method": "grease"}), greased)
    lines = [it for it in headline(greased, known) if "95 % band" in it]
    assert lines
    assert all(it.endswith("of what the models cover") for it in lines)


def test_without_the_table_a_result_has_none_of_it():
    result = ep.solve(pair())
    assert result.lubrication == {}
    assert "lubrication" not in result.to_dict()
    assert not {"lubrication", "churning"} & result.models.keys()


@pytest.mark.parametrize("method", METHODS)
def test_inputs_give_the_case_again(method):
    case = pair(METHODS[method] | {"method": method})
    again = ep.load_case(case.inputs())
    assert again == case
    assert ep.solve(again).to_dict() == ep.solve(case).to_dict()
