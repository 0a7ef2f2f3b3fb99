"""Uncertainty over maps and duty cycles: the same inputs at all points."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from click.testing import CliRunner

import epicyclic as ep
import listed_trains
from asymmetric import gear_pair
from epicyclic.case.tables.uncertainty import UncertainValue
from epicyclic.cli.main import cli
from epicyclic.errors import InputError
from epicyclic.machine.solve import LOSS_AGREEMENT
from epicyclic.result.stored import read_result, stated_result
from epicyclic.show.html import report_html
from epicyclic.show.uncertainty_tables import LIMITS, map_band_tables, uncertainty_items
from epicyclic.study.bands.plan import Outputs, outputs_of
from epicyclic.study.bands.points import Energies
from epicyclic.study.bands.samples import fit_curves, index_values, make_samples
from epicyclic.study.sweeps.run import write_dataset

ISOLATED = {
    "losses.mesh_pocketing.include": False,
    "numerics.mesh_positions": 8,
    "numerics.contact_segments": 6,
}
"""Quick to solve, and no flow is interpolated."""
SPEEDS, TORQUES, CELSIUS = (0, 2700), (-70, 0, 190), (0, 55)
CYCLE = {
    "duration [s]": [11.0, 7.0, 3.0, 5.0],
    "speed [rpm]": [900.0, 1700.0, 2500.0, 2100.0],
    "torque [N*m]": [150.0, 90.0, 40.0, -60.0],
}


@pytest.fixture(scope="module")
def case():
    return ep.load_case(gear_pair()).updated(ISOLATED)


@pytest.fixture(scope="module")
def plain_map(case):
    return ep.loss_map(
        case,
        [f"{speed} rpm" for speed in SPEEDS],
        [f"{torque} N*m" for torque in TORQUES],
        [f"{celsius} degC" for celsius in CELSIUS],
        jobs=1,
    )


@pytest.fixture(scope="module")
def over_map(plain_map):
    return ep.uncertainty(plain_map, samples=32, jobs=1)


def at(case, speed, torque, celsius="55"):
    return case.updated(
        {
            "operation.speed": f"{speed} rpm",
            "operation.torque": f"{torque} N*m",
            "operation.oil_inlet_temperature": f"{celsius} degC",
        }
    )


@pytest.mark.slow
@pytest.mark.parametrize(("speed", "torque", "celsius"), [(2700, 190, 0), (2700, -70, 55)])
def test_a_point_of_a_map_is_as_uncertain_as_the_case_there(case, over_map, speed, torque, celsius):
    alone = ep.uncertainty(at(case, speed, torque, celsius), samples=32, jobs=1)
    point = over_map.sel(speed=speed, torque=torque, temperature=celsius)
    for name in ("nominal", "mean", "standard_uncertainty", "low", "high", "shortest_low"):
        # points of other torques share their blocks, and keep what losses have to agree to
        np.testing.assert_allclose(
            point[name].sel(result=alone["result"]), alone[name], rtol=LOSS_AGREEMENT, err_msg=name
        )
    np.testing.assert_allclose(
        point["sampled_total"], alone["value"].sel(result="total"), rtol=LOSS_AGREEMENT
    )


@pytest.mark.slow
def test_the_torque_loss_has_a_band_at_rest_where_no_power_is_lost(over_map):
    rest = over_map.sel(speed=0, torque=190, temperature=55)
    assert rest["high"].sel(result="total") == 0
    low, nominal, high = (
        float(rest[name].sel(result="torque_loss")) for name in ("low", "nominal", "high")
    )
    assert 0 < low < nominal < high
    moving = over_map.sel(speed=2700, torque=190, temperature=55)
    to_watts = 2700 * np.pi / 30
    assert float(moving["high"].sel(result="torque_loss")) * to_watts == pytest.approx(
        float(moving["high"].sel(result="total")), rel=1e-12
    )


@pytest.mark.slow
def test_drivers_over_a_map_are_those_of_the_indices_at_a_point(case, over_map):
    alone = ep.uncertainty(at(case, 2700, 190), samples=512, jobs=1)
    point = over_map.sel(speed=2700, torque=190, temperature=55)
    assert float(point["explained"]) > 0.98
    for name in ("first_order", "total_order"):
        exact = alone[name].sel(sum="total")
        assert float(abs(point[name] - exact).max()) < 0.06, name
    assert float(exact.max()) > 0.3


@pytest.mark.slow
def test_what_limits_the_trust_in_a_map_is_told_where_it_is_largest(over_map):
    (advice,) = (it for it in uncertainty_items(over_map) if it.title == LIMITS)
    mean = (over_map["first_order"] * over_map["total"]).sum(over_map["total"].dims)
    first = str(mean["driver"][int(mean.values.argmax())].values)
    about = over_map.sel(input=first)
    assert advice.items[0].startswith(f"{about['input_name'].item()}: up to ")
    assert advice.items[0].endswith(f"; {about['input_advice'].item()}.")
    width = over_map.sel(result="total")["high"] - over_map.sel(result="total")["low"]
    alone = width * np.sqrt(over_map["first_order"].sel(driver=first).clip(0.0))
    largest = alone.isel(alone.argmax(alone.dims))
    assert f"{float(largest):.3g} W of the band" in advice.items[0]
    assert f"torque {float(largest['torque']):g} N·m" in advice.items[0]
    assert 1 <= len(advice.items) <= 3


@pytest.mark.slow
def test_a_map_with_its_uncertainty_remains_a_map(plain_map, over_map, tmp_path):
    write_dataset(over_map, tmp_path / "band.nc")
    read = ep.open_result(tmp_path / "band.nc")
    ep.write_map(read, tmp_path / "band.csv")
    ep.write_map(plain_map, tmp_path / "plain.csv")
    band, plain = (pd.read_csv(tmp_path / name, comment="#") for name in ("band.csv", "plain.csv"))
    assert set(band) - set(plain) == {"explained", "failed_samples"}
    pd.testing.assert_frame_equal(band[list(plain)], plain)
    cycle = {**CYCLE, "temperature [degC]": [50.0, 20.0, 40.0, 30.0]}
    assert ep.duty_cycle(read, cycle, samples=2).identical(
        ep.duty_cycle(plain_map, cycle, samples=2)
    )
    page = report_html(read)
    assert "95 % band of the total loss, W, at 55 °C" in page
    assert "95 % band of the total loss" not in report_html(plain_map)


@pytest.mark.slow
def test_energies_are_sums_of_the_same_samples_at_all_points(case):
    cycle = {name: [*column[:2], column[3]] for name, column in CYCLE.items()}
    over_cycle = ep.uncertainty(case, cycle, samples=16, jobs=1)
    kilo = np.zeros(32)
    entering = 0.0
    columns = zip(*cycle.values(), strict=True)
    apart = 0.0
    celsius = case.given()["operation"]["oil_inlet_temperature"].split()[0]
    for seconds, speed, torque in columns:
        alone = ep.uncertainty(at(case, speed, torque, celsius), samples=16, jobs=1)
        watts = alone["value"].sel(result="total").values
        kilo += watts * seconds / 1e3
        apart = np.hypot(apart, watts.std(ddof=1) * seconds / 1e3)
        at_shaft = speed * np.pi / 30 * torque
        entering = entering + (at_shaft if torque > 0 else watts - at_shaft) * seconds / 1e3
    total, efficiency = (over_cycle.sel(result=name) for name in ("total", "efficiency"))
    np.testing.assert_allclose(total["value"], kilo, rtol=1e-9)
    np.testing.assert_allclose(efficiency["value"], 1 - kilo / entering, rtol=1e-9)
    # inputs that are off throughout do not average out
    assert float(total["standard_uncertainty"]) > 1.3 * apart
    assert float(over_cycle["point_error"]) == 0
    assert str(total["unit"].values) == "kJ"


@pytest.mark.slow
def test_some_points_stand_for_a_long_cycle(case):
    number = np.arange(40)
    cycle = {
        "time [s]": number * 2.0,
        "speed [rpm]": 1500 + 1200 * np.sin(number / 7),
        "torque [N*m]": 90 + 80 * np.cos(number / 11),
    }
    whole, some = (
        ep.uncertainty(case, cycle, samples=16, points=points, jobs=1) for points in (40, 10)
    )
    exact, found = (
        float(data["standard_uncertainty"].sel(result="total")) for data in (whole, some)
    )
    assert 0 < float(some["point_error"]) < 0.1 * exact
    assert abs(found - exact) < 3 * float(some["point_error"])
    assert found != exact
    nominal = [float(data["nominal"].sel(result="total")) for data in (whole, some)]
    assert nominal[1] == pytest.approx(nominal[0], rel=2e-3)
    assert float(some["curves_explain"]) > 0.98


@pytest.mark.slow
@pytest.mark.parametrize("cycle", [None, CYCLE], ids=["map", "cycle"])
def test_workers_give_the_same_file(case, plain_map, cycle, tmp_path):
    source = plain_map.isel(temperature=[1]) if cycle is None else case
    for jobs in (1, 2):
        data = ep.uncertainty(source, cycle, samples=16, jobs=jobs)
        write_dataset(data, tmp_path / f"{jobs}.nc")
    one, two = (xr.load_dataset(tmp_path / f"{jobs}.nc") for jobs in (1, 2))
    assert one.identical(two)


@pytest.mark.slow
def test_groups_are_those_of_a_test_rig_where_the_case_says_so(case):
    """What torque adds is less, and known better, than the sum of what depends on the load."""
    tested = at(case, 2100, 120).updated({"models.load_dependent": "as-tested"})
    data = ep.uncertainty(tested, samples=16, jobs=1)
    exact = ep.solve(tested)
    for name in ("load_dependent", "load_independent", "total"):
        assert float(data["nominal"].sel(result=name)) == pytest.approx(
            getattr(exact, name), rel=1e-12
        )
    first = {key: float(data["drawn"].sel(input=key, sample=0)) for key in data["input"].values}
    factors = {key.partition(".")[2]: first.pop(key) for key in list(first) if "model_form" in key}
    units = dict(zip(data["input"].values, data["input_unit"].values, strict=True))
    changes = {
        key: f"{number!r} {units[key]}" if units[key] != "1" else number
        for key, number in first.items()
    }
    changed = tested.updated({**changes, "models.load_dependent": "computed"})
    unloaded = ep.solve(changed.updated({"operation.torque": "0 N*m"})).losses
    kinds = {"mesh_sliding": "sliding", "mesh_rolling": "rolling", "drag": "windage"}
    assert set(kinds.values()) == set(factors)
    alone = sum(
        watts * factors[kinds[name]] if name in kinds else watts for name, watts in unloaded.items()
    )
    assert float(data["value"].sel(result="load_independent", sample=0)) == pytest.approx(
        alone, rel=1e-9
    )
    cycle = {name: column[:2] for name, column in CYCLE.items()}
    energy = ep.uncertainty(tested, cycle, samples=32, jobs=1)
    parts = energy["value"].sel(result=["load_dependent", "load_independent"]).sum("result")
    np.testing.assert_allclose(parts, energy["value"].sel(result="total"), rtol=1e-12)
    watts = [ep.solve(at(tested, *point)) for point in ((900, 150), (1700, 90))]
    alone = sum(
        it.load_independent * seconds / 1e3
        for it, seconds in zip(watts, CYCLE["duration [s]"], strict=False)
    )
    assert float(energy["nominal"].sel(result="load_independent")) == pytest.approx(alone, rel=1e-9)


def test_causes_of_the_band_of_a_map_are_told_where_they_are_largest():
    plane = {"speed": ("speed", [900.0, 2700.0], {"units": "rpm"}),
             "torque": ("torque", [40.0, 190.0], {"units": "N*m"})}  # fmt: skip
    total = [[30.0, 110.0], [70.0, 260.0]]
    data = xr.Dataset(
        {
            "total": (("speed", "torque"), total),
            "low": (("result", "speed", "torque"), [[[20.0, 90.0], [60.0, 210.0]]]),
            "high": (("result", "speed", "torque"), [[[41.0, 130.0], [85.0, 320.0]]]),
            "first_order": (
                ("driver", "speed", "torque"),
                [[[0.9, 0.25], [0.3, 0.1]], [[0.05, 0.6], [0.5, 0.8]], [[0.01, 0.0], [0.02, 0.01]]],
            ),
            "explained": (("speed", "torque"), [[0.99, 0.98], [0.97, 0.995]]),
            "input_name": ("input", ["oil level", "friction", "play"]),
            "input_advice": ("input", ["measure it", "test it", "leave it"]),
        },
        {**plane, "result": ["total"], "driver": ["a", "b", "c"], "input": ["a", "b", "c"]},
    )
    band, causes, limits = map_band_tables(data)
    assert [cell.text for cell in band.rows[1]] == ["2700", "60 to 85", "210 to 320"]
    rows = [[cell.text for cell in row] for row in causes.rows]  # c is nowhere worth a row
    assert [(row[0], row[2], row[3]) for row in rows] == [
        ("friction", "80.0 %", "speed 2700 rpm, torque 190 N·m"),
        ("oil level", "90.0 %", "speed 900 rpm, torque 40 N·m"),
    ]
    assert "97.0 % or more" in causes.note
    assert limits.items[0] == (
        f"friction: up to {110 * 0.8**0.5:.3g} W of the band, at speed 2700 rpm, torque 190 N·m; "
        "test it."
    )


def value(key, kind, spread):
    return UncertainValue(key, "", 1.5, kind, (spread,))


def test_energies_of_samples_follow_from_losses_at_points():
    """Two points, power at the shaft in the first and at the other end in the second."""
    outputs = Outputs(
        ("drag", "sliding"), np.array([False, True]), ({"drag": 1.0}, {"sliding": 1.0})
    )
    time, shaft = np.array([3.0, 1.7]), np.array([900.0, -400.0])
    by_map = np.array([[11.0, 7.0], [23.0, 13.0]])  # losses, points
    losses = by_map.T[:, :, None] * [[1.0, 1.6], [1.0, 0.7]]  # points, losses, samples
    total = losses.sum(axis=1, keepdims=True)
    results = np.concatenate([losses, 0 * total, 0 * total, total, 0 * total], axis=1)
    whole = 3.0 * 900 + 1.7 * (400 + 20)
    energies = Energies(outputs, ({}, {}), shaft, time, by_map, by_map @ time, whole, True)
    drag, sliding, dependent, independent, lost, efficiency = energies.of(results)
    assert drag == pytest.approx(np.array([1.0, 1.6]) * 44.9e-3)  # kJ
    assert sliding == pytest.approx(np.array([1.0, 0.7]) * 91.1e-3)
    assert dependent == pytest.approx(sliding)
    assert independent == pytest.approx(drag)
    assert lost == pytest.approx(drag + sliding)
    entering = 3.0 * 900 + 1.7 * (400 + total[1, 0])
    assert 1 - efficiency == pytest.approx(1e3 * lost / entering)


def test_a_gear_that_dips_churns_in_every_form():
    oil = {"method": "dip", "oil_volume": "0.6 l"}
    own = oil | {"immersion": {"gear": "7 mm"}}
    found = []
    for form in (listed_trains.train_of_pair, listed_trains.listed_pair):
        case = ep.load_case(form()).updated({"lubrication": oil, "sets.S.lubrication": own})
        result = ep.solve(case)
        stored, _ = read_result(json.loads(json.dumps(stated_result(result))))
        for each in (result, stored):
            found.append({"churning": 0.0, "windage": 0.0, "sliding": 0.0})
            for term, kinds in zip(each.terms, outputs_of(case, each).kinds, strict=True):
                for kind in kinds.keys() & found[-1]:
                    found[-1][kind] += kinds[kind] * term.watts
    assert min(found[0].values()) > 1
    assert found[1:] == [pytest.approx(found[0], rel=1e-9)] * 3


def test_curves_meet_products_of_powers():
    """ln P is linear: the indices of one loss are those of a product of lognormal factors."""
    values = [value("a", "lognormal", 1.2), value("model_form.sliding", "lognormal", 1.4)]
    mask = np.array([True, False])
    samples = make_samples(values, 16, 3)
    drawn = np.concatenate([samples.a, samples.b], axis=1)
    losses = np.array([7 * drawn[0] ** 2 * drawn[1], np.full(32, 4.0)])
    curves = fit_curves(mask, samples, losses)
    assert curves.explained == pytest.approx(1, abs=1e-12)
    np.testing.assert_allclose(
        curves.at(drawn), [losses[0], losses[1], losses.sum(axis=0)], rtol=1e-12
    )
    sets = curves.sets(make_samples(values, 2**13, 5))[:, -1:]
    first, total = index_values(sets[0], sets[1], sets[2:])
    parts = np.expm1(np.array([2 * np.log(1.2), np.log(1.4)]) ** 2)
    whole = np.prod(1 + parts) - 1
    np.testing.assert_allclose(first[0], parts / whole, atol=0.01)
    np.testing.assert_allclose(total[0], parts * (1 + parts[::-1]) / whole, atol=0.01)


def test_curves_of_too_few_samples_explain_nothing():
    values = [value(f"k{number}", "normal", 0.1 + 0.01 * number) for number in range(16)]
    samples = make_samples(values, 16, 3)
    mask = np.array([True])
    drawn = np.concatenate([samples.a, samples.b], axis=1)
    losses = np.array([100 + drawn.sum(axis=0)])
    losses[0, 1::3] = np.nan  # as of samples without a solution
    few = fit_curves(mask, samples, losses)
    assert np.isnan(few.explained)
    assert np.isnan(few.at(drawn)[-1]).all()


@pytest.mark.slow
def test_too_few_samples_tell_no_causes():
    """Of 20 inputs, six of which are models, curves have 35 columns: 32 of 16 samples are fewer."""
    quick = ISOLATED | {"models.temperatures": "inlet", "numerics.contact_segments": 7}
    del quick["losses.mesh_pocketing.include"]
    pockets = {f"losses.{mesh}_mesh_pocketing.include": False for mesh in ("sun", "ring")}
    case = ep.load_case("talbot-2012").updated(quick | pockets)
    few = "16 samples are too few to tell the causes. Take 32 or more."
    over = ep.uncertainty(ep.loss_map(case, ["900 rpm"], ["60 N*m"], jobs=1), samples=16, jobs=1)
    _, causes, notes = uncertainty_items(over)
    assert causes.items == (few,)
    assert not any("Without effect" in note or "At most" in note for note in notes.items)
    energy = ep.uncertainty(case, CYCLE, ["60 degC"], samples=16, points=2, jobs=1)
    _, causes, _, notes = uncertainty_items(energy)
    assert {row[-1].text for row in causes.rows} == {"-"}
    assert few in notes.items
    assert np.isnan([over["first_order"].max(), energy["first_order"].max()]).all()


@pytest.mark.slow
def test_a_key_without_a_distribution_at_some_points_is_told(case):
    shares = {"surroundings.oil_air_ratio": [0.0, 0.3]}
    data = ep.loss_map(case, ["900 rpm"], ["60 N*m"], vary=shares, jobs=1)
    with pytest.raises(InputError, match=r"oil_air_ratio.*only at some operating points"):
        ep.uncertainty(data, samples=16)
    known = case.updated({"uncertainty": {"surroundings.oil_air_ratio": {"exact": True}}})
    data = ep.loss_map(known, ["900 rpm"], ["60 N*m"], vary=shares, jobs=1)
    found = ep.uncertainty(data, samples=16, jobs=1)
    assert (found["high"] > found["low"]).sel(result="total").all()


@pytest.mark.slow
def test_what_cannot_be_sampled_is_told(case, plain_map):
    for source, options, message in (
        (case, {"cycle": CYCLE, "temperature": ["40 degC", "50 degC"]}, "must be a single value"),
        (case, {"cycle": CYCLE, "points": 1}, "must be 2 or more"),
        (plain_map, {"samples": 20}, "power of 2"),
        (plain_map.assign_attrs(case="{}"), {}, "not made by this version"),
        (xr.Dataset(), {}, "not a loss map"),
    ):
        with pytest.raises(InputError, match=message):
            ep.uncertainty(source, **options)


@pytest.mark.slow
def test_the_command_on_a_map(plain_map, over_map, tmp_path):
    ep.write_map(plain_map, tmp_path / "map.nc")
    output, picture = tmp_path / "band.nc", tmp_path / "band.png"
    run = CliRunner().invoke(
        cli,
        [
            "uncertainty",
            str(tmp_path / "map.nc"),
            "--jobs",
            "1",
            "-o",
            str(output),
            "--plot",
            str(picture),
        ],
    )
    assert run.exit_code == 0, run.output
    assert "95 % band of the total loss, W, at 0 °C" in run.output
    assert xr.load_dataset(output).identical(over_map.load())
    pictures = {path.stem for path in tmp_path.glob("*.png")}
    assert pictures == {"band-drivers", "band-band", "band-lines"}
    assert not list(tmp_path.glob("*.partial"))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["talbot-2012", "--speed", "900 rpm"], "--speed: needs both"),
        (["talbot-2012", "--points", "9"], "--points: requires a cycle"),
        (["talbot-2012", "--temperature", "50 degC"], "--temperature: requires"),
        (["map.nc", "--set", "a=1", "--speed", "900 rpm"], "--speed: applies to a case alone"),
        (["talbot-2012", "none.csv"], "cannot be read"),
    ],
)
def test_options_that_do_not_go_together(arguments, message):
    run = CliRunner().invoke(cli, ["uncertainty", *arguments])
    assert run.exit_code != 0
    assert message in str(run.exception)
