"""One and the same thing, stated otherwise, gives the same result and the same statements."""

from __future__ import annotations

import copy
import math
import time

import numpy as np
import pytest

import asymmetric
import epicyclic as ep
import listed_trains
import trains
from epicyclic.machine.pocket_flow import flow_family
from epicyclic.show.template import case_text
from epicyclic.study.bands.plan import known_values, look_nearby
from epicyclic.study.bands.study import quick_band
from epicyclic.study.friction import compare_friction, recommended
from epicyclic.study.heat import beyond_range
from epicyclic.study.maps.cycle import open_cycle
from epicyclic.study.solve import build_computed

SAME = 1e-9
COARSE = {"pocket_slices": 8, "pocket_steps": 12, "mesh_positions": 8, "contact_segments": 6}


# --- backlash that rounding leaves ----------------------------------------------------------------

INCH = 25.4


def pair_without_backlash():
    """The pair of the source, the thickness of one gear left out: it follows, without backlash."""
    left_out = {"gear.tooth_thickness": None, "gear.thickness_diameter": None}
    return ep.load_case("talbot-2012-pair").updated(left_out)


@pytest.mark.parametrize(
    ("changes", "near"),
    [
        ({"gears.center_distance": f"{50 / INCH!r} in"}, SAME),
        ({"gears.transverse_module": f"{2 / INCH!r} in"}, SAME),
        ({"gears.transverse_pressure_angle": f"{math.radians(20)!r} rad"}, SAME),
        ({"pinion.thickness_diameter": f"{50e6!r} nm"}, SAME),
        ({"mesh.normal_backlash": "0 mm"}, SAME),
        # a change of 1e-12 m, by what it is worth
        ({"gears.center_distance": "50.000000001 mm"}, 1e-8),
        ({"gears.center_distance": "49.999999999 mm"}, 1e-8),
        ({"mesh.normal_backlash": "0.000000001 um"}, 1e-8),
    ],
)
@pytest.mark.parametrize("pocketing", ["incompressible", "isentropic"])
def test_backlash_that_rounding_leaves_decides_nothing(changes, near, pocketing):
    case = pair_without_backlash().updated({"models.pocketing": pocketing})
    case = case.updated({f"numerics.{key}": value for key, value in COARSE.items()})
    expected = ep.solve(case)
    found = ep.solve(case.updated(changes))
    assert expected.losses["mesh_pocketing"] > 10
    assert found.total == pytest.approx(expected.total, rel=near)
    assert found.meshes["mesh"].backlash == expected.meshes["mesh"].backlash == 0


def flows(case):
    (duty,) = build_computed(case).mean_duties().values()
    return flow_family(duty)


@pytest.mark.parametrize("key", ["tip_diameter", "root_diameter", "tooth_thickness"])
@pytest.mark.parametrize("nudge", [1 - 4e-16, 1 + 4e-16, 1 - 1e-12, 1 + 1e-12])
def test_gears_that_differ_by_rounding_are_equal(key, nudge):
    """Which gear the time steps follow hangs on sizes, not on how they were rounded."""
    sizes = {"teeth": 27, "tip_diameter": 57.2, "root_diameter": 48.1, "tooth_thickness": 2.9}
    texts = {name: it if name == "teeth" else f"{it} mm" for name, it in sizes.items()}
    changes = {f"{gear}.{name}": it for gear in ("pinion", "gear") for name, it in texts.items()}
    changes |= {f"{gear}.thickness_diameter": "53 mm" for gear in ("pinion", "gear")}
    case = ep.load_case("talbot-2012-pair", changes | {"gears.center_distance": "53.7 mm"})
    found = {}
    for speed in ("700 rpm", "-700 rpm"):
        for gear in ("pinion", "gear"):
            other = {f"{gear}.{key}": f"{sizes[key] * nudge!r} mm", "operation.speed": speed}
            family = flows(case.updated(other))
            tip1, tip2 = family.mesh.gear1.tip_radius, family.mesh.gear2.tip_radius
            found[speed, gear] = family.drives1, tip1 == pytest.approx(tip2, rel=1e-9)
    assert len(set(found.values())) == 1


def test_whether_a_void_is_below_no_pressure_does_not_hang_on_rounding():
    void = {"models.pocket_void_pressure": "0 bar", "models.pocketing": "incompressible"}
    case = ep.load_case("talbot-2012-pair").updated(void)
    for pressure in ("1.01325 bar", "101325.0 Pa", "0.987 bar", "14.7 psi", "0.3 bar"):
        (told,) = (
            text
            for text in ep.solve(case.updated({"surroundings.pressure": pressure})).warnings
            if "voids" in text or "impossible" in text
        )
        assert "contain voids" in told, pressure


# --- which gear is called the pinion --------------------------------------------------------------


@pytest.mark.parametrize(
    ("friction", "rolling"),
    [
        ("fitted", "fitted"),
        ("fitted-or-schlenk", "fitted-or-goksem-hargreaves"),
        ("mixed-ehl+pairing", "mixed-ehl+pairing"),
        ("mixed-ehl", "mixed-ehl"),
        ("schlenk", "goksem-hargreaves"),
        *((name, "auto") for name in ("xu-2007", "doleschel", "matsumoto", "mixed-lubrication")),
    ],
)
@pytest.mark.parametrize("oil", ["75w-90-gear-oil", "atf-dexron-ulv"])
def test_which_gear_is_called_the_pinion_changes_nothing(friction, rolling, oil):
    """The gear that drives is stated second then, so that its torque has the other sign."""
    case = ep.load_case("talbot-2012-pair").given()
    case["lubricant"]["oil"] = oil
    case["models"] |= {"friction": friction, "rolling": rolling}
    case["operation"] |= {"torque": "61 N*m", "speed": "2900 rpm"}
    case["numerics"] = COARSE
    case["pinion"] |= {"roughness": "1.5 um", "face_width": "15.7 mm"}
    case["gear"] |= {"tip_diameter": "53.2 mm", "roughness": "0.41 um"}
    other = copy.deepcopy(case)
    other["pinion"], other["gear"] = case["gear"], case["pinion"]
    other["operation"]["torque"] = "-61 N*m"
    expected, found = (ep.solve(ep.load_case(it)) for it in (case, other))
    assert expected.losses["mesh_sliding"] > 1
    assert found.losses == pytest.approx(expected.losses, rel=SAME)
    shares = [sorted(flag.share for flag in it.flags) for it in (expected, found)]
    assert shares[0] == pytest.approx(shares[1], rel=1e-6)


# --- attribution in every form --------------------------------------------------------------------


def told_of(tables, **models):
    """What is said of a case at 120 °C, where formulas leave their range."""
    tables = copy.deepcopy(tables)
    tables["lubricant"] = {"oil": "atf-talbot-2012"}
    tables["models"] = {"friction": "mixed-ehl", "rolling": "mixed-ehl"} | models
    tables["operation"]["oil_inlet_temperature"] = "120 degC"
    tables["numerics"] = listed_trains.NUMERICS
    tables.pop("losses", None)
    case = ep.load_case(tables)
    result = ep.solve(case)
    concerned = sorted(  # properties of the oil concern no loss of their own
        watts for watts, group in result.flags_with_loss if group[0].use.role not in ("drag", "oil")
    )
    rows = compare_friction(case, brief=True)
    return {
        "total": result.total,
        "concerned": concerned,
        "beyond": beyond_range(case, result).share,
        "outside": {row.name: row.outside for row in rows},
        "best": recommended(rows),
    }


def renamed_set(tables, name):
    """The train with another name of its set S."""
    tables = copy.deepcopy(tables)
    tables["sets"] = {name: tables["sets"]["S"]}
    tables["shafts"] = {
        shaft: [member.replace("S.", f"{name}.") for member in members]
        for shaft, members in tables["shafts"].items()
    }
    return tables


@pytest.mark.parametrize(
    "forms",
    [
        pytest.param(
            lambda: (
                {key: it for key, it in asymmetric.gear_pair().items() if key != "losses"},
                listed_trains.train_of_pair(),
                listed_trains.listed_pair(),
                renamed_set(listed_trains.train_of_pair(), "first_stage"),
            ),
            id="pair",
        ),
        pytest.param(
            lambda: (
                listed_trains.train_of_planetary(),
                listed_trains.listed_simple(),
                renamed_set(listed_trains.listed_simple(), "first_stage"),
            ),
            id="planetary",
        ),
    ],
)
def test_every_form_of_a_set_has_equal_statements(forms):
    expected, *others = map(told_of, forms())
    assert max(expected["concerned"]) > 100
    assert expected["outside"]["mixed-ehl"] > 0.9
    for found in others:
        assert found["total"] == pytest.approx(expected["total"], rel=SAME)
        assert found["concerned"] == pytest.approx(expected["concerned"], rel=1e-6)
        assert found["beyond"] == pytest.approx(expected["beyond"], rel=1e-6)
        assert found["outside"] == pytest.approx(expected["outside"], rel=1e-6)
        assert found["best"][0].name == expected["best"][0].name
        assert found["best"][1] == expected["best"][1]


# --- bands of what is derived ---------------------------------------------------------------------


@pytest.mark.parametrize("torque", ["0 N*m", "0.07 N*m", "-0.4 N*m", "3 N*m", "-71 N*m"])
def test_the_band_of_the_efficiency_is_from_the_draws_of_the_loss(torque):
    """What the other shaft gives or takes follows from the loss; the torque is of one shaft."""
    case = ep.load_case("talbot-2012-pair").updated({"operation.torque": torque})
    case = case.updated({f"numerics.{key}": value for key, value in COARSE.items()})
    exact = {"operation.torque": {"exact": True}, "operation.speed": {"exact": True}}
    case = case.updated({"uncertainty": exact})
    result = ep.solve(case)
    band = quick_band(look_nearby(case, result))
    *_, losses, efficiencies = band.results
    power = result.flow.members["pinion"].power
    entering = [max(power, 0.0) + max(loss - power, 0.0) for loss in losses]
    expected = [max(0.0, 1 - loss / whole) for loss, whole in zip(losses, entering, strict=True)]
    assert losses.std() > 0.01 * losses.mean()
    assert efficiencies == pytest.approx(expected, abs=1e-9)
    assert band.nearby.nominal[-1] == pytest.approx(result.efficiency, abs=1e-12)


# --- assumptions where they cannot act ------------------------------------------------------------


@pytest.mark.parametrize(
    ("case", "shared"),
    [
        (lambda: ep.load_case("talbot-2012"), ["load_sharing.mesh_load_factor"]),
        (lambda: ep.load_case("talbot-2012").updated({"planet.count": 1}), []),
        (lambda: ep.load_case(listed_trains.listed_pair()), []),
        (lambda: ep.load_case(listed_trains.layshaft()), []),
        (lambda: ep.load_case(listed_trains.wolfrom()), ["sets.S.load_sharing.mesh_load_factor"]),
        (lambda: ep.load_case(listed_trains.wolfrom()).updated({"sets.S.planets": 1}), []),
    ],
)
def test_only_planets_that_share_a_load_have_an_assumed_sharing(case, shared):
    case = case()
    coarse = {f"numerics.{key}": value for key, value in listed_trains.NUMERICS.items()}
    values = known_values(case, ep.solve(case.updated(coarse)))
    assert [value.key for value in values if "load_sharing" in value.key] == shared


# --- trains that lose nothing, and long ones ------------------------------------------------------


def lossless():
    return trains.simple(20, 70, "ring", ("sun", "carrier"), efficiency=1.0)


@pytest.mark.filterwarnings("error")
def test_a_train_of_which_every_efficiency_is_one_loses_nothing_anywhere(tmp_path):
    case = ep.load_case(lossless())
    assert ep.solve(case).total == 0
    assert quick_band(look_nearby(case, ep.solve(case))).results[-1] == pytest.approx(1.0)
    grid = {"speed": ["310 rpm", "970 rpm"], "torque": ["1.7 N*m", "5.3 N*m"]}
    loss_map = ep.loss_map(case, **grid, jobs=1)
    assert (loss_map["efficiency"] == 1).all()
    assert (ep.uncertainty(loss_map, samples=16, jobs=1)["high"].sel(result="total") == 0).all()
    banded = ep.uncertainty(case, samples=16, jobs=1)
    assert banded["low"].sel(result="efficiency") == banded["nominal"].sel(result="efficiency") == 1
    compared = ep.compare_cases(case, case, samples=16, jobs=1)
    assert compared["difference"].sel(result="total") == 0
    cycle = {"time [s]": [0, 1.3, 2.9], "speed [rpm]": [310, 500, 970], "torque [N*m]": [2, 3, 5]}
    assert ep.duty_cycle(case, cycle, jobs=1)["total_efficiency"] == 1


@pytest.mark.parametrize(
    "arguments",
    [
        ["run"],
        ["run", "--json", "-"],
        pytest.param(["report", "-o", "page.html"], marks=pytest.mark.slow),
        ["plot", "losses", "-o", "l.png"],
    ],
)
def test_the_commands_show_a_train_that_loses_nothing(arguments, tmp_path, monkeypatch):
    from click.testing import CliRunner

    from epicyclic.cli.main import cli

    monkeypatch.chdir(tmp_path)
    (tmp_path / "case.toml").write_text(case_text(lossless(), []))
    name, *rest = arguments
    found = CliRunner().invoke(cli, [name, "case.toml", *rest])
    assert found.exit_code == 0, found.output


def chain(count, *, to_fast=False):
    """Sets one after the other, each of the ratio 4.5."""
    sets = {
        f"S{number}": {"sun": {"teeth": 20}, "ring": {"teeth": 70}, "efficiency": 0.98}
        for number in range(count)
    }
    shafts = {
        "fast": ["S0.sun"],
        **{f"m{it}": [f"S{it}.carrier", f"S{it + 1}.sun"] for it in range(count - 1)},
        "slow": [f"S{count - 1}.carrier"],
        "housing": [f"S{number}.ring" for number in range(count)],
    }
    ends = ("slow", "fast") if to_fast else ("fast", "slow")
    operation = {"input": ends[0], "output": ends[1], "torque": "7 N*m", "speed": "1300 rpm"}
    return {"kind": "train", "sets": sets, "shafts": shafts, "operation": operation}


def numbers_of(result):
    return {figure.key: figure.value for figure in result.numbers()}


def test_a_long_chain_has_its_ratio():
    assert numbers_of(ep.solve(ep.load_case(chain(12))))["ratio"] == pytest.approx(
        4.5**12, rel=1e-9
    )


@pytest.mark.parametrize("to_fast", [False, True])
@pytest.mark.parametrize("count", [19, 24, 30])
def test_a_shaft_that_turns_is_not_said_to_stand_still(count, to_fast):
    with pytest.raises(ep.InputError) as error:
        ep.load_case(chain(count, to_fast=to_fast))
    (problem,) = error.value.problems
    assert f"{4.5**count:.2g} times as fast as shaft slow" in problem.allowed
    assert "drown in rounding" in problem.allowed


def test_a_shaft_that_stands_still_is_said_to():
    tables = chain(3)
    tables["shafts"]["aside"] = tables["shafts"].pop("slow")
    tables["shafts"]["slow"] = ["S3.sun"]
    tables["sets"]["S3"] = copy.deepcopy(tables["sets"]["S0"])
    tables["shafts"]["housing"] += ["S3.ring", "S3.carrier"]
    with pytest.raises(ep.InputError, match="stands still at any speed"):
        ep.load_case(tables)


def test_too_many_sets_are_refused_at_once():
    start = time.process_time()
    with pytest.raises(ep.InputError, match="sets = 1000 sets: must be at most 64"):
        ep.load_case(chain(1000))
    assert time.process_time() - start < 2


# --- shares of a spectrum -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("shares", "told"),
    [
        ((0.2, 0.3, 0.5), ""),
        ((20, 30, 50), ""),
        ((0.2, 0.3, 0.4), "its shares sum to 0.9, not to 1: multiplied by 1.11111"),
        ((20, 30, 43), "its shares sum to 93, not to 1: multiplied by 0.0107527"),
        ((0.333, 0.333, 0.333), "its shares sum to 0.999, not to 1: multiplied by 1.001"),
    ],
)
def test_shares_that_do_not_sum_to_one_are_told_with_their_factor(shares, told):
    cycle = {"share": shares, "speed [rpm]": [310, 500, 970], "torque [N*m]": [2, 3, 5]}
    found = open_cycle(cycle)
    assert found.title().partition("; ")[2] == told
    (piece,) = found.pieces()
    assert piece.duration == pytest.approx(3600 * np.array(shares) / sum(shares), rel=1e-12)


def test_a_cycle_knows_the_keys_of_a_case_and_names_what_it_does_not_use():
    cycle = {
        "duration [s]": [3, 5],
        "operation.speed [rpm]": [310, 500],
        "operation.torque [N*m]": [2, 3],
        "operation.oil_inlet_temperature [degC]": [20, 70],
        "planet.count": [3, 4],
    }
    found = open_cycle(cycle)
    assert found.ranges["temperature"] == (20.0, 70.0)
    assert found.title({"temperature"}).partition("; ")[2] == (
        "columns not used: temperature [degC], planet.count"
    )


@pytest.mark.parametrize("name", ["share", "duration [s]"])
@pytest.mark.parametrize(
    "values", [[3e-320, 1e-320], [2e-200, 0.0], [7e150, 1.0], [9e307, 1.7e308]]
)
def test_weights_over_which_no_number_is_finite_are_refused(name, values):
    cycle = {"speed [rpm]": [900, 1700], "torque [N*m]": [40, -70], name: values}
    with pytest.raises(ep.InputError, match="next to nothing, or beyond all bounds"):
        open_cycle(cycle)


def test_the_result_of_a_cycle_tells_the_factor_of_its_shares():
    cycle = {"share": [0.2, 0.3, 0.4], "speed [rpm]": [310, 500, 970], "torque [N*m]": [2, 3, 5]}
    case = ep.load_case(trains.simple(20, 70, "ring", ("sun", "carrier"), efficiency=0.98))
    told = "its shares sum to 0.9, not to 1: multiplied by 1.11111"
    assert ep.duty_cycle(case, cycle, jobs=1).attrs["cycle"].partition("; ")[2] == told


# --- order in a file ------------------------------------------------------------------------------


def differential(left, right, output, speed):
    """A differential of spur gears, its cage driven; the wheels in this order."""
    planets = {left: "inner", right: "outer"}
    own = {
        "planets": 2,
        "mesh_efficiency": 0.97,
        "meshes": [[left, planets[left]], [planets[left], planets[right]], [planets[right], right]],
        "gears": {
            left: {"teeth": 24},
            planets[left]: {"teeth": 17, "planet": True},
            planets[right]: {"teeth": 17, "planet": True},
            right: {"teeth": 24},
        },
    }
    (other,) = {left, right} - {output}
    shafts = {left: [f"D.{left}"], right: [f"D.{right}"], "cage": ["D.carrier"]}
    operation = {"input": "cage", "output": output, "torque": "100 N*m", "speed": "500 rpm"}
    operation["speeds"] = {other: f"{speed} rpm"}
    return {"kind": "train", "sets": {"D": own}, "shafts": shafts, "operation": operation}


@pytest.mark.parametrize("flipped", [False, True])
@pytest.mark.parametrize(
    ("clutches", "torques"),
    [
        # 100 N m on sun and ring by their teeth, 21 and 71
        ([["in", "mid"]], {"in+mid": 100 * 71 / 92}),
        ([["mid", "in"]], {"mid+in": -100 * 71 / 92}),
        ([["out", "in"]], {"out+in": -100.0}),
        ([["in", "mid"], ["mid", "out"]], {"in+mid": None, "mid+out": None}),
    ],
)
def test_a_set_that_clutches_lock_is_split_by_its_teeth_in_any_order(flipped, clutches, torques):
    meshes = [["planet", "sun"], ["planet", "ring"]] if flipped else None
    result = ep.solve(ep.load_case(locked(clutches, meshes)))
    found = result.train.clutches
    other = ep.solve(ep.load_case(locked(clutches[::-1]))).train.clutches
    assert found == pytest.approx(other, rel=SAME)
    assert all(found[key] == pytest.approx(it, rel=SAME) for key, it in torques.items() if it)
    loaded = "out+in" not in torques
    assert any("torques are those without friction" in note for note in result.notes) is loaded
    assert any("indeterminate" in note for note in result.notes) is (len(clutches) > 1)


def locked(clutches, meshes=None):
    """A set of given efficiency whose three shafts clutches join."""
    tables = trains.simple(21, 71, "ring", ("sun", "carrier"), efficiency=0.93)
    if meshes is not None:
        tables["sets"]["S"]["meshes"] = meshes
    tables["shafts"] = {"in": ["S.sun"], "mid": ["S.ring"], "out": ["S.carrier"]}
    tables["states"] = {"1": {"joined": clutches}}
    tables["operation"] |= {"state": "1", "torque": "100 N*m"}
    return tables


@pytest.mark.parametrize("wheels", [("a", "b"), ("b", "a")])
@pytest.mark.parametrize("output", ["a", "b"])
def test_straight_ahead_both_wheels_have_the_same_torque_in_any_order(wheels, output):
    result = ep.solve(ep.load_case(differential(*wheels, output, 500)))
    torques = [result.flow.members[wheel].torque for wheel in ("a", "b")]
    assert torques == pytest.approx([-50, -50], rel=SAME)
    assert any("torques are those without friction" in note for note in result.notes)
    in_a_bend = ep.solve(ep.load_case(differential(*wheels, output, 510)))
    torques = [in_a_bend.flow.members[wheel].torque for wheel in ("a", "b")]
    assert max(torques) - min(torques) > 4
    assert not any("do not roll" in note for note in in_a_bend.notes)
