"""Measured losses against computed ones, and fits to them, on measurements made by the model."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import curve_fit

import epicyclic as ep
from epicyclic.case.keys import Parameter
from epicyclic.show.plots.measured import measured_figure
from epicyclic.study.measured.fit import fit_parameters
from epicyclic.study.measured.residuals import MeasuredPoints
from epicyclic.study.measured.table import Measurements, parse_measurements
from epicyclic.study.sweeps.run import with_unloaded
from epicyclic.study.sweeps.runner import Row, Rows, failed_row
from epicyclic.study.table_file import read_grid

TRUTH = {"mesh_sliding": 1.2, "drag": 0.8}
KEYS = [f"losses.{name}.factor" for name in TRUTH]


@pytest.fixture(scope="module")
def case():
    """A pair without pockets: a millisecond a point."""
    return ep.load_case("talbot-2012-pair").updated(
        {"losses.mesh_pocketing.include": False, "operation.torque": "100 N*m"}
    )


@pytest.fixture(scope="module")
def tests(case):
    """Conditions and losses of a gear pair whose sliding and drag differ from the model's."""
    truth = case.updated({f"losses.{name}.factor": value for name, value in TRUTH.items()})
    rows = []
    for speed in (2000, 4000, 8000):
        for torque in (0, 120):
            for temperature in (60, 90):
                operation = {
                    "operation.speed": f"{speed} rpm",
                    "operation.torque": f"{torque} N*m",
                    "operation.oil_inlet_temperature": f"{temperature} degC",
                }
                rows.append((speed, torque, temperature, ep.solve(truth.updated(operation)).total))
    names = ["speed [rpm]", "torque [N*m]", "temperature [degC]", "loss [W]"]
    return pd.DataFrame(rows, columns=names)


def noisy(tests, seed, relative=0.02, absolute=0.2):
    """`tests` with normal errors of stated size."""
    sigma = relative * tests["loss [W]"] + absolute
    loss = tests["loss [W]"] + sigma * np.random.default_rng(seed).standard_normal(len(tests))
    return tests.assign(**{"loss [W]": loss, "uncertainty [W]": sigma})


def test_the_model_meets_its_own_losses(case, tests):
    exact = case.updated({f"losses.{name}.factor": value for name, value in TRUTH.items()})
    comparison = ep.compare_measured(exact, tests)
    # the table keeps 14 digits
    np.testing.assert_allclose(comparison.computed, comparison.measured.loss, rtol=1e-13)
    assert all(row.rms < 1e-13 * comparison.computed.max() for row in comparison.errors)
    assert [row.group for row in comparison.errors] == ["", "temperature 60", "temperature 90"]
    assert [row.count for row in comparison.errors] == [12, 6, 6]
    assert comparison.calibrated is None


def test_error_figures_are_those_of_the_table(case, tests):
    measured = tests["loss [W]"].to_numpy()
    comparison = ep.compare_measured(case, noisy(tests.assign(), 1, relative=0.0, absolute=1e-12))
    error = comparison.computed - measured
    figures = comparison.errors[0]
    # noise of 1e-12 W
    assert figures.bias == pytest.approx(error.mean(), rel=1e-9)
    assert figures.rms == pytest.approx(math.sqrt((error**2).mean()), rel=1e-9)
    assert figures.mean_percentage == pytest.approx(np.abs(error / measured).mean(), rel=1e-9)
    worst = np.argmax(np.abs(error))
    assert figures.largest == pytest.approx(error[worst], rel=1e-9)
    assert figures.largest_line == worst + 1
    assert figures.chi_squared == pytest.approx((error**2).sum() * 1e24, rel=1e-6)


def test_residuals_are_drawn_as_computed_less_measured(case, tests):
    comparison = ep.compare_measured(case, tests)
    axes = {ax.get_title("left"): ax for ax in measured_figure(comparison).axes}
    error = comparison.computed - comparison.measured.loss
    for title in ("Residuals over speed", "Residuals over torque", "Residuals by point"):
        ax = axes[title]
        lines = [it[0] for it in ax.containers] or ax.lines[:2]
        drawn = np.concatenate([line.get_ydata() for line in lines])
        np.testing.assert_allclose(np.sort(drawn), np.sort(error), rtol=1e-12)


@pytest.mark.slow
def test_a_fit_without_noise_finds_the_inputs(case, tests):
    fit = ep.compare_measured(case, tests, fit=KEYS).fit
    found = [item.value for item in fit.parameters]
    # losses are linear in these factors: what is left is the tolerance of the fit
    assert found == pytest.approx(list(TRUTH.values()), rel=1e-6)
    assert fit.degrees_of_freedom == 10


DECAY = {"a": 50.0, "b": 2.0, "c": 5.0}


class Decay:
    """Points of a model without physics, a exp(-b x) + c, that is nonlinear and costs nothing."""

    def __init__(self, seed, weighted):
        self.x = np.linspace(0, 2, 15)
        exact = self.losses(**DECAY)
        sigma = 0.5 + 0.02 * exact if weighted else np.full(15, 1.0)
        loss = exact + sigma * np.random.default_rng(seed).standard_normal(15)
        self.measured = Measurements(
            "made up", (1,) * 15, ({},) * 15, {}, ("total",) * 15, loss,
            sigma if weighted else None, {},
        )  # fmt: skip

    def losses(self, a, b, c):
        return a * np.exp(-b * self.x) + c

    def shared(self):
        return self

    def compute(self, *settings):
        return [SimpleNamespace(loss=self.losses(**keys)) for keys in settings]


@pytest.mark.slow
@pytest.mark.parametrize("weighted", [True, False], ids=["with uncertainties", "from the scatter"])
def test_intervals_cover_the_inputs_as_often_as_they_say(weighted):
    parameters = [Parameter(key, "", 1.3 * value, 0.0, 1e3) for key, value in DECAY.items()]
    hits = np.zeros(3)
    for seed in range(200):
        points = Decay(seed, weighted)
        fit = fit_parameters(points, parameters, np.ones(15, dtype=bool), 0.8)
        hits += [item.low <= DECAY[item.key] <= item.high for item in fit.parameters]
    # 160 of 200 expected; the binomial distribution leaves 145 to 174 with 99 %. Intervals that are
    # widened where the scatter exceeds the uncertainties cover more often.
    assert (hits >= 145).all(), hits
    assert (hits <= (190 if weighted else 174)).all(), hits


def test_intervals_and_correlations_are_those_of_curve_fit():
    points = Decay(1, weighted=True)
    parameters = [Parameter(key, "", 1.3 * value, 0.0, 1e3) for key, value in DECAY.items()]
    fit = fit_parameters(points, parameters, np.ones(15, dtype=bool), 0.95)
    values, covariance = curve_fit(
        lambda x, a, b, c: a * np.exp(-b * x) + c,
        points.x,
        points.measured.loss,
        p0=[65, 2.6, 6.5],
        sigma=points.measured.uncertainty,
        absolute_sigma=True,
    )
    errors = np.sqrt(np.diag(covariance)) * fit.widening
    # the last derivatives are differences over 1 % to both sides
    assert [item.value for item in fit.parameters] == pytest.approx(list(values), rel=1e-4)
    assert [item.standard_error for item in fit.parameters] == pytest.approx(list(errors), rel=5e-3)
    deviation = np.sqrt(np.diag(covariance))
    np.testing.assert_allclose(
        fit.correlation, covariance / np.outer(deviation, deviation), atol=5e-3
    )


@pytest.mark.parametrize(
    ("size", "words"),
    [
        (10, "far from linear within the interval of c"),
        (30, "the ends of the profile of b"),  # any large b does
    ],
)
def test_a_strongly_curved_model_is_told(size, words):
    points = Decay(1, weighted=True)
    points.measured = replace(points.measured, uncertainty=size * points.measured.uncertainty)
    parameters = [Parameter(key, "", 1.3 * value, -1e3, 1e3) for key, value in DECAY.items()]
    fit = fit_parameters(points, parameters, np.ones(15, dtype=bool), 0.95)
    assert any(words in note for note in fit.warnings)
    alike = fit_parameters(Decay(1, weighted=True), parameters, np.ones(15, dtype=bool), 0.95)
    assert not any("far from linear" in note or "profile" in note for note in alike.warnings)


def test_an_input_held_at_the_range_of_a_model_means_nothing():
    class Held(Decay):
        def losses(self, a, b, c):
            return super().losses(max(a, 80.0), b, c)

    points = Held(1, weighted=True)
    points.measured = Decay(1, weighted=True).measured
    parameters = [
        Parameter(key, "", value, 0.0, 1e3) for key, value in (("a", 90.0), ("b", 2.0), ("c", 5.0))
    ]
    fit = fit_parameters(points, parameters, np.ones(15, dtype=bool), 0.95)
    assert any(note.startswith("a has no influence at its") for note in fit.warnings)
    assert math.isnan(fit.parameters[0].low)
    assert math.isfinite(fit.parameters[1].low)


@pytest.mark.slow
def test_intervals_of_the_model_cover_the_inputs(case, tests):
    hits = 0
    for seed in range(20):
        fit = ep.compare_measured(case, noisy(tests, seed), fit=KEYS, confidence=0.8).fit
        for item, truth in zip(fit.parameters, TRUTH.values(), strict=True):
            hits += item.low <= truth <= item.high
    # 32 of 40 expected, or some more where intervals are widened; binomial, 99 %
    assert 25 <= hits <= 39


@pytest.mark.slow
def test_a_fit_of_physical_inputs_of_a_planetary_set(talbot):
    keys = ["surroundings.oil_air_ratio", "lubricant.pressure_viscosity_factor", "planet.roughness"]
    values = [0.08, 1.1, "0.3 um"]
    bare = talbot.updated(
        {f"losses.{mesh}_mesh_pocketing.include": False for mesh in ("sun", "ring")}
    )
    truth = bare.updated(dict(zip(keys, values, strict=True)))
    data = ep.sweep(
        truth,
        {
            "operation.speed": ["1000 rpm", "2000 rpm", "4000 rpm"],
            "operation.torque": ["0 N*m", "400 N*m", "1000 N*m"],
            "operation.oil_inlet_temperature": ["40 degC", "90 degC"],
        },
        jobs=1,
    )
    table = data["total"].to_dataframe()["total"].reset_index()
    table.columns = ["speed [rpm]", "torque [N*m]", "temperature [degC]", "loss [W]"]
    fit = ep.compare_measured(bare, noisy(table, 3, 0.003, 0.5), fit=keys, jobs=1).fit
    for item, wanted in zip(fit.parameters, [0.08, 1.1, 0.3], strict=True):
        # three standard errors: one in 370 by chance, with this seed settled
        assert abs(item.value - wanted) < 3 * item.standard_error, item
        assert item.standard_error < 0.2 * item.value
    assert fit.parameters[2].unit == "um"


@pytest.mark.slow
def test_calibrated_and_held_out_points_are_kept_apart(case, tests):
    table = noisy(tests, 5)
    table.loc[table["temperature [degC]"] == 90, "loss [W]"] *= 1.5
    comparison = ep.compare_measured(case, table, fit=KEYS, hold_out="temperature=90")
    alone = ep.compare_measured(case, table[table["temperature [degC]"] == 60], fit=KEYS)
    assert [item.value for item in comparison.fit.parameters] == pytest.approx(
        [item.value for item in alone.fit.parameters], rel=1e-9
    )
    sets = {(row.state, row.points): row for row in comparison.errors if not row.group}
    assert [row.count for row in sets.values()] == [6, 6, 6, 6]
    assert sets["CALIBRATED", "held-out points"].rms > 5 * sets["CALIBRATED", "fitted points"].rms
    assert "CALIBRATED [W]" in comparison.table().columns


@pytest.mark.slow
def test_a_random_share_is_that_of_the_seed(case, tests):
    one, again, other = (
        ep.compare_measured(case, tests, fit=KEYS, hold_out=0.25, seed=seed).held_out
        for seed in (1, 1, 2)
    )
    assert one.sum() == round(0.25 * len(tests))
    assert (one == again).all()
    assert (one != other).any()


@pytest.mark.slow
def test_what_cannot_be_told_apart_is_said(case, tests):
    keys = ["losses.drag.factor", "surroundings.oil_air_ratio", "losses.mesh_sliding.factor"]
    fit = ep.compare_measured(case, noisy(tests, 7), fit=keys).fit
    assert any("cannot be separated" in note for note in fit.warnings)


def test_a_parameter_at_its_bound_has_an_interval_on_one_side(case, tests):
    table = tests.assign(**{"loss [W]": tests["loss [W]"] * 25})
    sticky = case.updated({"models.friction": "constant", "models.constant_friction": 0.9})
    fit = ep.compare_measured(sticky, table, fit=["models.constant_friction"]).fit
    (item,) = fit.parameters
    assert item.at_bound
    assert item.value == pytest.approx(1.0, rel=1e-9)  # the method stays within its bounds
    assert 0.5 < item.low < item.high == 1.0
    assert any("its interval ends there" in note for note in fit.warnings)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"fit": ["losses.mesh_pocketing.factor"]}, "no influence"),
        ({"fit": ["pinion.teeth"]}, "not a continuous number"),
        ({"fit": ["models.friction"]}, "not a continuous number"),
        ({"fit": ["operation.speed"]}, "given by a column"),
        ({"fit": ["pinion.roughnes"]}, "pinion.roughness"),
        ({"fit": ["gear.rim_thickness"]}, "no value in the case"),
        ({"fit": ["mesh.misalignment"]}, "is 0 in the case"),
        ({"fit": KEYS, "hold_out": "temperature=70"}, "no row"),
        ({"fit": KEYS, "hold_out": "1.5"}, "share"),
        ({"hold_out": 0.3}, "no keys are fitted"),
        ({"group": "rig"}, "not a column"),
        ({"component": "mesh_slidng"}, "is not a loss"),
    ],
)
def test_what_cannot_be_done_is_refused(case, tests, options, words):
    with pytest.raises(ep.InputError, match=words):
        ep.compare_measured(case, tests, **options)


def test_columns_of_losses_that_are_not_read_are_told(case, tests):
    table = tests.assign(**{"efficiency [%]": 97.5, "torque loss [N*m]": 0.3})
    (note,) = (it for it in ep.compare_measured(case, table).notes if "column" in it)
    assert note == "the losses are those of the column loss; not used: torque_loss, efficiency."


def test_more_inputs_than_points_are_refused(case, tests):
    with pytest.raises(ep.InputError, match="2 inputs cannot be fitted to 1"):
        ep.compare_measured(case, tests[:1], fit=KEYS)


def test_a_fit_that_does_not_converge_says_so(case, tests, monkeypatch):
    from epicyclic.study.measured import fit

    monkeypatch.setattr(fit, "MOST_ROUNDS", 1)
    with pytest.raises(ep.ConvergenceError, match="did not converge"):
        ep.compare_measured(case, tests, fit=KEYS)


@pytest.mark.usefixtures("fails_at_high_speed")
def test_points_that_fail_are_named_and_left_out(case, tests):
    comparison = ep.compare_measured(case, tests, fit=KEYS, jobs=1)
    assert comparison.errors[0].count == 8
    assert comparison.fit.points == 8
    assert np.isnan(comparison.computed).sum() == 4
    assert "4 of 12 points could not be computed; line 9: the test says no" in comparison.notes
    assert '"computed [W]": null' in comparison.to_json()


def test_terms_and_sums_of_them_can_be_measured(case, tests):
    table = tests.assign(component=["mesh_sliding", "mesh_sliding + drag", "load_dependent"] * 4)
    comparison = ep.compare_measured(case, table)
    by_hand = []
    for changes, name in zip(
        comparison.measured.changes, comparison.measured.component, strict=True
    ):
        result = ep.solve(case.updated(changes))
        losses = result.losses | {"load_dependent": result.load_dependent}
        by_hand.append(sum(losses[part.strip()] for part in name.split("+")))
    np.testing.assert_array_equal(comparison.computed, by_hand)


def test_other_units_mean_the_same(case, tests):
    other = pd.DataFrame(
        {
            "operation.speed [rad/s]": tests["speed [rpm]"] * math.pi / 30,
            "Torque [kN*m]": tests["torque [N*m]"] / 1e3,
            "temperature": [f"{value + 273.15} K" for value in tests["temperature [degC]"]],
            "loss [kW]": tests["loss [W]"] / 1e3,
            "uncertainty [%]": 2.0,
        }
    )
    one, same = ep.compare_measured(case, tests), ep.compare_measured(case, other)
    # factors of 60 and 1000 round
    np.testing.assert_allclose(same.computed, one.computed, rtol=1e-12)
    np.testing.assert_allclose(same.measured.uncertainty, 0.02 * one.measured.loss, rtol=1e-12)


def load_dependent_tests():
    """Load-dependent losses as a table of measurements has them."""
    rows = [
        (speed, torque, 60, "load_dependent", 100.0)
        for speed in (2000, 6000)
        for torque in (0, 60, 120)
    ]
    names = ["speed [rpm]", "torque [N*m]", "temperature [degC]", "component", "loss [W]"]
    return pd.DataFrame(rows, columns=names)


def test_as_tested_at_inlet_temperature_is_what_depends_on_the_load(case):
    """Of teeth that carry nothing without torque."""
    case = case.updated({"models.mesh_loads": "without-losses"})
    table = load_dependent_tests()
    computed = ep.compare_measured(case, table).computed
    tested = ep.compare_measured(case, table, load_dependent="as-tested")
    # a difference of total losses: rounding of these
    np.testing.assert_allclose(tested.computed, computed, rtol=1e-12, atol=1e-11)
    assert tested.computed[0] == 0
    assert tested.to_dict()["load_dependent"] == "as-tested"


@pytest.fixture(scope="module")
def warm(case):
    return case.updated({"models.temperatures": "network", "thermal.oil_flow": "1 l/min"})


def test_as_tested_is_total_loss_loaded_less_unloaded(warm):
    table = load_dependent_tests()
    tested = ep.compare_measured(warm, table, load_dependent="as-tested").computed
    computed = ep.compare_measured(warm, table).computed
    for number, row in table.iterrows():
        point = {
            "operation.speed": f"{row['speed [rpm]']} rpm",
            "operation.oil_inlet_temperature": "60 degC",
        }
        loaded, unloaded = (
            ep.solve(warm.updated({**point, "operation.torque": f"{torque} N*m"})).total
            for torque in (row["torque [N*m]"], 0)
        )
        # the text of the table keeps 14 digits
        assert tested[number] == pytest.approx(loaded - unloaded, rel=1e-9, abs=1e-9)
    # the loaded oil is hotter and drags less
    assert (tested[computed > 0] < computed[computed > 0]).all()


def test_points_of_equal_speed_share_the_one_without_torque():
    points = [
        {"operation.torque": f"{t} N*m", "operation.speed": s} for s in (1, 2) for t in (5, 6)
    ]
    everything, unloaded = with_unloaded(points)
    assert unloaded.tolist() == [4, 4, 5, 5]
    assert everything[:4] == tuple(points)
    assert [point["operation.torque"] for point in everything[4:]] == ["0 N*m"] * 2
    assert [point["operation.speed"] for point in everything[4:]] == [1, 2]


def test_other_losses_are_not_touched_by_a_rig(warm):
    table = load_dependent_tests()
    table.loc[1, "component"] = "load_independent"
    table.loc[2, "component"] = "load_dependent + drag"
    tested = ep.compare_measured(warm, table, load_dependent="as-tested")
    computed = ep.compare_measured(warm, table)
    assert tested.computed[1] == computed.computed[1]
    drag = ep.compare_measured(warm, table.assign(component="drag")).computed
    every = ep.compare_measured(
        warm, table.assign(component="load_dependent"), load_dependent="as-tested"
    ).computed
    assert tested.computed[2] == pytest.approx(every[2] + drag[2], rel=1e-12)


def test_a_point_without_torque_that_fails_is_told(case):
    table = parse_measurements(read_grid(load_dependent_tests().iloc[1:2]), case)
    rows = Rows(2)
    rows.add(0, Row("ok", numbers={"total": 5.0}))
    rows.add(1, failed_row("runs away"))
    runner = SimpleNamespace(within=lambda plan: SimpleNamespace(run=lambda plan: rows))
    (computed,) = MeasuredPoints(case, table, runner, "as-tested").compute({})
    assert math.isnan(computed.loss[0])
    assert computed.messages == ("runs away",)


@pytest.mark.parametrize(
    ("options", "key", "word"),
    [
        ({"load_dependent": "tested"}, "load_dependent", "must be computed or as-tested"),
        ({"component": "total"}, "load_dependent", "none were measured"),
        ({"outlet": "80 degC"}, "thermal.oil_outlet_temperature", "without torque"),
    ],
)
def test_what_cannot_be_formed_as_tested_is_refused(case, options, key, word):
    table = load_dependent_tests()
    if "component" in options:
        table = table.assign(component=options["component"])
    if "outlet" in options:
        table = table.assign(**{"thermal.oil_outlet_temperature": options["outlet"]})
    with pytest.raises(ep.InputError) as caught:
        ep.compare_measured(case, table, load_dependent=options.get("load_dependent", "as-tested"))
    assert [(problem.key, word in problem.allowed) for problem in caught.value.problems] == [
        (key, True)
    ]
