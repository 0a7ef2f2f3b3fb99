"""Propagation of what is uncertain: published figures, coverage, bad tables."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from rich.console import Console
from scipy import stats

import epicyclic as ep
from asymmetric import gear_pair
from epicyclic.case.tables.uncertainty import UncertainValue
from epicyclic.errors import InputError
from epicyclic.losses.pocket_tables import FlowFamily
from epicyclic.show.page import Listing
from epicyclic.show.plots.catalogue import available
from epicyclic.show.uncertainty_tables import pair_tables, uncertainty_items
from epicyclic.study.bands.inputs import uncertain_values
from epicyclic.study.bands.plan import at_deviations, look_nearby
from epicyclic.study.bands.samples import (
    cut_off,
    make_samples,
    quantiles,
    sample_summary,
    sobol_indices,
    standard_uncertainty,
)
from epicyclic.study.bands.study import quick_dataset
from epicyclic.study.sweeps.run import write_dataset

ISOLATED = {
    "losses.mesh_pocketing.include": False,
    "numerics.mesh_positions": 8,
    "numerics.contact_segments": 6,
}
"""Quick to solve."""


def normal(key, value=0.0, deviation=1.0, **more):
    return UncertainValue(key, "", value, "normal", (deviation,), **more)


def uniform(key, low, high):
    return UncertainValue(key, "", (low + high) / 2, "uniform", (low, high))


def at_all(samples, function):
    """A function at A, at B, and at A with each group from B."""
    mixed = [function(samples.mixed(number)) for number in range(len(samples.groups))]
    return function(samples.a)[None], function(samples.b)[None], np.array(mixed)[:, None]


@pytest.fixture(scope="module")
def case():
    return ep.load_case(gear_pair()).updated(ISOLATED)


@pytest.fixture(scope="module")
def study(case):
    return ep.uncertainty(case, samples=16, jobs=1)


def test_a_loss_that_nothing_changes_has_no_table_of_causes(study):
    """As that of a train whose losses are all given."""
    title = "Causes of the uncertainty of the total loss"
    idle = study.assign(contribution=study["contribution"] * 0.0)
    shown = {it.title: it for it in uncertainty_items(idle)}
    assert shown[title] == Listing((), title)
    assert {it.title: it for it in uncertainty_items(study)}[title].rows


def test_indices_of_the_function_of_ishigami():
    """a = 7, b = 0.1: exact indices, to 0.01."""
    samples = make_samples([uniform(key, -math.pi, math.pi) for key in "abc"], 2**12, 5)
    (first, low, high), (total, *_) = sobol_indices(
        *at_all(
            samples, lambda x: np.sin(x[0]) + 7 * np.sin(x[1]) ** 2 + 0.1 * x[2] ** 4 * np.sin(x[0])
        ),
        seed=1,
    )
    assert first[0] == pytest.approx([0.3139, 0.4424, 0.0], abs=0.01)
    assert total[0] == pytest.approx([0.5576, 0.4424, 0.2437], abs=0.01)
    assert (low <= first).all()
    assert (first <= high).all()


@pytest.mark.parametrize(
    ("values", "end"),
    [
        ([normal(key) for key in "abcd"], 3.92),
        ([uniform(key, -math.sqrt(3), math.sqrt(3)) for key in "abcd"], 3.88),
    ],
    ids=["normal", "rectangular"],
)
def test_sums_of_jcgm_101(values, end):
    """JCGM 101:2008, 9.2: four inputs of unit variance."""
    samples = make_samples(values, 2**13, 3)
    found = sample_summary(np.concatenate([samples.a.sum(axis=0), samples.b.sum(axis=0)]))
    assert found.standard_uncertainty == pytest.approx(2.0, rel=2e-3)
    assert (found.low, found.high) == pytest.approx((-end, end), abs=0.02)
    assert found.shortest_high - found.shortest_low == pytest.approx(2 * end, abs=0.06)


@pytest.mark.slow
def test_bands_hold_the_truth_as_often_as_they_say():
    """Of 1000 truths that are off as stated, 93 to 97 % lie within their bands."""
    rng = np.random.default_rng(20)
    held = 0
    for number in range(1000):
        a, b, c, low = rng.uniform(2.0, 3.0, 4)
        values = [
            normal("a", a, 0.3), normal("b", b, 0.2), uniform("d", low, low + 1.7),
            UncertainValue("c", "", c, "lognormal", (1.3,)),
        ]  # fmt: skip
        samples = make_samples(values, 128, number)
        found = sample_summary(np.concatenate([samples.a.prod(axis=0), samples.b.prod(axis=0)]))
        truth = (
            (a + 0.3 * rng.standard_normal())
            * (b + 0.2 * rng.standard_normal())
            * (low + 1.7 * rng.random())
            * c * math.exp(math.log(1.3) * rng.standard_normal())
        )  # fmt: skip
        held += found.low <= truth <= found.high
    assert 0.93 <= held / 1000 <= 0.97


@pytest.mark.slow
def test_small_uncertainties_add_up_as_in_the_gum(case):
    """Linear limit: u_c from contributions of single inputs, to 1 %."""
    small = {
        "pinion.roughness": {"normal": "0.4 %"},
        "gear.roughness": {"normal": "0.7 %"},
        "surroundings.oil_air_ratio": {"lognormal_factor": 1.006},
        "lubricant.pressure_viscosity_factor": {"normal": "0.3 %"},
        "operation.oil_inlet_temperature": {"normal": "0.05 K"},
        "models.boundary_friction": {"exact": True},
        "thermal.jet_effectiveness": {"exact": True},
        "model_form.windage": {"exact": True},
    }
    kinds = ("sliding", "rolling")
    small |= {f"model_form.{kind}": {"lognormal_factor": 1.004} for kind in kinds}
    data = ep.uncertainty(case.updated({"uncertainty": small}), samples=64, jobs=1)
    total = data.sel(result="total")
    expected = math.sqrt(float((total["contribution"] ** 2).sum()))
    assert float(total["standard_uncertainty"]) == pytest.approx(expected, rel=0.01)
    assert float(total["mean"]) == pytest.approx(float(total["nominal"]), rel=1e-4)


@pytest.mark.slow
def test_workers_give_the_same_file(case, tmp_path):
    one = ep.uncertainty(case, samples=16, jobs=1)
    two = ep.uncertainty(case, samples=16, jobs=2, journal=tmp_path / "kept")
    assert one.identical(two)
    assert not one.identical(ep.uncertainty(case, samples=16, seed=2, jobs=1))


@pytest.mark.slow
def test_results_of_a_case_are_those_without_uncertainty(case, study):
    result = ep.solve(case)
    for name, watts in result.losses.items():
        if name in study["result"]:
            assert float(study["nominal"].sel(result=name)) == pytest.approx(watts, rel=1e-12)
    assert float(study["nominal"].sel(result="total")) == pytest.approx(result.total, rel=1e-12)
    efficiency = float(study["nominal"].sel(result="efficiency"))
    assert efficiency == pytest.approx(result.efficiency, rel=1e-12)
    losses = study["value"].sel(result=["load_dependent", "load_independent"]).sum("result")
    assert losses.values == pytest.approx(study["value"].sel(result="total").values)


def test_each_input_moves_the_losses_that_depend_on_it(study):
    moved = study["contribution"]
    assert not moved.sel(input="thermal.jet_effectiveness").any()
    share = moved.sel(input="surroundings.oil_air_ratio")
    assert float(share.sel(result="drag")) > 0
    # but for what the loss adds to the load of the teeth
    assert abs(float(share.sel(result="mesh_rolling"))) < 1e-3 * float(share.sel(result="drag"))
    sliding = moved.sel(input="model_form.sliding")
    assert float(sliding.sel(result="mesh_sliding")) == pytest.approx(
        float(sliding.sel(result="total"))
    )
    pinion, gear = (moved.sel(input=f"{it}.roughness", result="total") for it in ("pinion", "gear"))
    assert float(pinion) != pytest.approx(float(gear), rel=0.05)


@pytest.mark.slow
def test_the_quick_band_is_that_of_many_samples(case):
    study = ep.uncertainty(case, samples=64, jobs=1)
    band = quick_dataset(case, ep.solve(case))
    quick, total = (data.sel(result="total") for data in (band, study))
    width = float(total["high"] - total["low"])
    assert float(quick["low"]) == pytest.approx(float(total["low"]), abs=0.1 * width)
    assert float(quick["high"]) == pytest.approx(float(total["high"]), abs=0.15 * width)
    shares, alone = (data.sel(sum="total").to_series() for data in
                     (study["total_order"], band["first_order"]))  # fmt: skip
    assert alone.idxmax() == shares.idxmax()
    assert alone.sum() == pytest.approx(1.0)


def test_flows_through_pockets_stay_where_they_are_nearly_the_same(monkeypatch):
    """With voids, and oil that is 3 K colder or warmer."""
    fast = ep.load_case("talbot-2012-pair").updated({
        "operation.speed": "9000 rpm",
        "surroundings.oil_air_ratio": 0.3,
        "uncertainty": {
            "operation.oil_inlet_temperature": {"normal": "3 K"},
            "surroundings.oil_air_ratio": {"exact": True},
        },
    })  # fmt: skip
    result = ep.solve(fast)
    assert any("contain voids" in note for note in result.warnings)
    solved = []
    flow = FlowFamily.flow
    monkeypatch.setattr(FlowFamily, "flow", lambda *at: (solved.append(at), flow(*at))[1])
    near = look_nearby(fast, result)
    monkeypatch.undo()
    assert len(set(solved)) == 1
    (number,) = (
        i for i, it in enumerate(near.values) if it.key == "operation.oil_inlet_temperature"
    )
    pockets = near.outputs.losses.index("mesh_pocketing")
    for end, degrees in zip(near.ends[number, :, pockets], (87, 93), strict=True):
        own = fast.updated({"operation.oil_inlet_temperature": f"{degrees} degC"})
        assert end == pytest.approx(ep.solve(own).losses["mesh_pocketing"], rel=2e-3)
        assert end != result.losses["mesh_pocketing"]


@pytest.mark.slow
def test_a_report_shows_the_band_of_a_stored_result_and_of_samples(case, study, tmp_path):
    kept = ep.record(case)
    ep.save_result(kept, tmp_path / "result.nc")
    page = ep.report_html(ep.open_result(tmp_path / "result.nc"))
    assert page == ep.report_html(kept)
    (data,) = kept.group("uncertainty").values()
    total = data.sel(result="total")
    assert data.identical(quick_dataset(case, ep.solve(case)))
    assert "Uncertainty of this result" in page
    assert f">{float(total['low']):.1f}<" in page.replace("</data>", "<")
    assert {"drivers", "band"} <= set(available(kept))
    write_dataset(study, tmp_path / "samples.nc")
    sampled = ep.report_html(ep.open_result(tmp_path / "samples.nc"))
    assert "with others" in sampled
    assert f">{float(study['low'].sel(result='total')):.1f}<" in sampled.replace("</data>", "<")


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("first_order", "must be numbers over sum, driver"),
        ("distribution", "is missing for every input"),
        ("unit", "is missing for every result"),
    ],
)
def test_a_damaged_uncertainty_is_refused(study, tmp_path, name, reason):
    damaged = study.drop_vars(name) if name != "first_order" else study.assign(first_order=3.0)
    write_dataset(damaged, tmp_path / "damaged.nc")
    with pytest.raises(InputError, match=reason):
        ep.open_result(tmp_path / "damaged.nc")


@pytest.mark.slow
def test_correlated_inputs_share_their_part_of_the_variance(case):
    together = {
        "pinion.roughness": {"normal": "0.06 um"},
        "gear.roughness": {"normal": "0.09 um", "correlated": {"pinion.roughness": 0.9}},
    }
    data = ep.uncertainty(case.updated({"uncertainty": together}), samples=64, jobs=1)
    assert "pinion.roughness + gear.roughness" in data["driver"].values
    drawn = data["drawn"].sel(input=["pinion.roughness", "gear.roughness"])
    assert np.corrcoef(drawn.values)[0, 1] == pytest.approx(0.9, abs=0.05)


@pytest.mark.slow
def test_a_paired_difference_is_known_better_than_an_unpaired_one(case):
    data = ep.compare_cases(case, case.updated({"gear.roughness": "0.31 um"}), samples=64, jobs=1)
    total = data.sel(result="total")
    assert total["standard_uncertainty"] < 0.6 * total["unpaired_uncertainty"]
    assert total["low"] < total["difference"] < total["high"]
    assert "surroundings.oil_air_ratio" in data.attrs["shared"]
    assert "gear.roughness" not in data.attrs["shared"].split(", ")


def test_a_case_compared_with_itself_is_neither_smaller_nor_larger(case):
    same = ep.compare_cases(case, case, samples=16, jobs=1)
    assert not same["difference"].sel(result="total").any()
    console = Console(width=100)
    with console.capture() as shown:
        console.print(pair_tables(same.assign_attrs(first_title="A" * 60, second_title="B" * 60)))
    head, less, *rows = map(str.rstrip, shown.get().splitlines())
    assert (head, less) == ("B" * 60, "less " + "A" * 60)
    chances = {row.split()[-1] for row in rows if row.startswith(("load-dependent ", "total "))}
    assert chances == {"-"}


@pytest.mark.parametrize("times", [(), (0.0,), (-1.0, 2.0), (math.nan, 1.0), (math.inf,)])
def test_times_of_a_compared_cycle_are_not_negative(case, times):
    with pytest.raises(InputError, match="points: must have times of 0 or more, not all 0"):
        ep.compare_cases(case, case, samples=16, points=[(time, {}) for time in times])


@pytest.mark.slow
def test_a_cycle_is_compared_with_the_same_draw_at_all_its_points(case):
    other = case.updated({"gear.roughness": "0.31 um", "gears.center_distance": "108.03 mm"})
    times = 3.0, 1.7
    changes = (
        {"operation.torque": "41 N*m", "operation.speed": "2100 rpm"},
        {"operation.torque": "-13 N*m", "operation.oil_inlet_temperature": "47 degC"},
    )
    alone = [
        ep.compare_cases(case.updated(it), other.updated(it), samples=16, jobs=1) for it in changes
    ]
    whole = ep.compare_cases(
        case, other, samples=16, jobs=1, points=[*zip(times, changes, strict=True)]
    )
    weights = np.array(times) / sum(times)
    for name in ("first", "second", "difference"):
        apart = np.array([it[name].sel(result="total") for it in alone])
        # Points that are solved together agree with single ones to LOSS_AGREEMENT, 1e-7.
        assert float(whole[name].sel(result="total")) == pytest.approx(weights @ apart, rel=1e-7)
    spreads = np.array([it.standard_uncertainty.sel(result="total") for it in alone])
    known = float(whole.standard_uncertainty.sel(result="total"))
    assert np.hypot.reduce(weights * spreads) < known <= weights @ spreads * (1 + 1e-9)
    lost, power = (
        weights @ [getattr(ep.solve(case.updated(it)), name) for it in changes]
        for name in ("total", "input_power")
    )
    efficiency = float(whole["first"].sel(result="efficiency"))
    assert efficiency == pytest.approx(1 - lost / power, rel=1e-12)


@pytest.mark.parametrize(
    ("value", "whole"),
    [
        (normal("x", 3.0, 1.5, low=0.4, high=7.0), stats.norm(3.0, 1.5)),
        (
            UncertainValue("x", "", 3.0, "lognormal", (1.7,), 1.1, 9.0),
            stats.lognorm(math.log(1.7), scale=3.0),
        ),
        (UncertainValue("x", "", 3.0, "uniform", (-1.0, 5.0), 0.0, 4.5), stats.uniform(-1.0, 6.0)),
    ],
)
def test_spreads_are_those_of_scipy(value, whole):
    assert standard_uncertainty(value) == pytest.approx(whole.std(), rel=1e-12)
    assert cut_off(value) == pytest.approx(whole.cdf(value.low) + whole.sf(value.high), rel=1e-12)


@pytest.mark.parametrize("value", [normal("x", 3.1, 0.7), uniform("x", 1.2, 4.9)])
def test_values_some_deviations_off_are_so_many_standard_uncertainties_off(value):
    found = at_deviations(value, np.array([-1.3, 0.0, 0.8]))
    assert (found - value.value) / standard_uncertainty(value) == pytest.approx([-1.3, 0.0, 0.8])


def test_values_that_cannot_be_are_cut_off_and_told(case):
    value = normal("clearance", 4.0, 3.0, low=0.0)
    drawn = quantiles(value, np.linspace(0.0, 1.0, 11)[1:-1])
    assert (drawn > 0).all()
    assert cut_off(value) == pytest.approx(0.0912, abs=1e-4)
    assert standard_uncertainty(uniform("x", 1.0, 4.0)) == pytest.approx(3 / math.sqrt(12))


def test_a_case_without_any_uncertainty_is_told_and_can_be_compared(case):
    exact = {value.key: {"exact": True} for value in look_nearby(case, ep.solve(case)).values}
    known = case.updated({"uncertainty": exact})
    for ask in (ep.uncertainty, lambda it, samples: ep.compare_cases(it, it, samples=samples)):
        with pytest.raises(InputError, match="leaves nothing uncertain"):
            ask(known, samples=16)
    found = ep.compare_cases(known, case, samples=16).sel(result="total")
    other = ep.compare_cases(case, known, samples=16).sel(result="total")
    assert found["standard_uncertainty"] == other["standard_uncertainty"] > 0
    assert found["low"] == -other["high"]
    with pytest.raises(InputError, match="must be true, or left out"):
        case.updated({"uncertainty": {"gear.roughness": {"exact": False}}})


@pytest.mark.slow
def test_samples_without_a_result_are_counted(case):
    """Centre distances of which some make the gears jam."""
    jams = {"gears.center_distance": {"tolerance": ["-0.45 mm", "0.7 mm"]}}
    data = ep.uncertainty(case.updated({"uncertainty": jams}), samples=16, jobs=1)
    failed = data["status"].values == "failed"
    assert 0 < data.attrs["failed"] == failed.sum() < failed.size
    assert all(text for text in data["message"].values[failed])
    assert np.isfinite(float(data["low"].sel(result="total")))
    assert np.isfinite(data["total_order"]).all()


def test_every_problem_of_the_table_is_told(case):
    with pytest.raises(InputError) as caught:
        case.updated(
            {
                "uncertainty": {
                    "gear.rougness": {"normal": "1 um"},
                    "pinion.roughness": {"normal": "3 rpm"},
                    "gear.roughness": {"uniform": ["2 um", "1 um"]},
                    "model_form.slding": {"lognormal_factor": 1.2},
                    "model_form.rolling": {"normal": "10 %"},
                    "lubricant.oil": {"normal": "1 %"},
                    "surroundings.oil_air_ratio": {
                        "normal": "1 %", "correlated": {"x": 0.3, "gear.roughness": 1.2},
                    },
                }
            }
        )  # fmt: skip
    told = {problem.key: str(problem) for problem in caught.value.problems}
    assert set(told) == {
        'uncertainty."gear.rougness"',
        'uncertainty."pinion.roughness"',
        'uncertainty."gear.roughness"',
        'uncertainty."model_form.slding"',
        'uncertainty."model_form.rolling"',
        'uncertainty."lubricant.oil"',
        'uncertainty."surroundings.oil_air_ratio".correlated.x',
        'uncertainty."surroundings.oil_air_ratio".correlated."gear.roughness"',
    }
    assert "gear.roughness" in told['uncertainty."gear.rougness"']
    assert "sliding" in told['uncertainty."model_form.slding"']


@pytest.mark.parametrize(
    ("table", "limits"),
    [
        ({"uniform": ["20 degC", "30 degC"]}, "20 to 30 °C"),
        ({"tolerance": ["1 K", "2 K"]}, "71 to 72 °C"),
        ({"uniform": ["70 degC", "72 degC"]}, ""),
        ({"tolerance": ["-1 K", "0 K"]}, ""),
    ],
)
def test_limits_without_the_value_of_the_case_are_told(case, table, limits):
    key = "operation.oil_inlet_temperature"
    own = case.updated({key: "70 degC", "uncertainty": {key: table}})
    wanted = f"the limits {limits} leave out the value of the case, 70 °C"
    (value,) = [it for it in uncertain_values(own)[0] if it.key == key]
    assert (value.remark == wanted) if limits else not value.remark
    told = [it for it in ep.solve(own).warnings if "leave out" in it]
    assert told == (
        [f'uncertainty."{key}": {wanted}. Correct the limits or the value.'] * bool(limits)
    )
    sources = ep.uncertainty(own, samples=16, jobs=1)["distribution_source"].values
    assert any("leave out" in it for it in sources) == bool(limits)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"normal": "nan %"}, "is not a number"),
        ({"tolerance": ["-inf %", "3 %"]}, "is not a number"),
        ({"tolerance": ["0 N*m", "0 N*m"]}, "must give the lower limit, then a higher one"),
    ],
)
def test_a_width_of_none_is_refused(case, table, words):
    with pytest.raises(InputError, match=words) as caught:
        case.updated({"uncertainty": {"operation.torque": table}})
    assert [problem.key for problem in caught.value.problems] == ['uncertainty."operation.torque"']


def test_an_oil_given_by_its_name_has_no_keys_of_its_own():
    key = "lubricant.oil.density_slope.value"
    case = ep.load_case("talbot-2012-pair")
    with pytest.raises(InputError, match="has no keys") as caught:
        case.updated({"uncertainty": {key: {"normal": "3 %"}}})
    assert [problem.key for problem in caught.value.problems] == [f'uncertainty."{key}"']


def test_every_assumption_has_a_source():
    for name in ("talbot-2012", "talbot-2012-pair", "train-eaxle"):
        own = ep.load_case(name)
        values, problems = uncertain_values(own, ("sliding", "seals"))
        assert not problems
        assert all(value.source for value in values)
        assert not any(value.text.endswith(" um") for value in values)
        pairs = itertools.pairwise(sorted(value.key for value in values))
        assert all(one != two for one, two in pairs)


def test_a_set_that_states_no_model_parameter_has_that_of_the_train():
    """Varied in the train and in the sets at once, its band would count twice."""
    key, own = "models.hurst_exponent", "sets.planets.models.hurst_exponent"
    axle = ep.load_case("train-eaxle")
    for case, found in ((axle, {key}), (axle.updated({own: 0.42}), {key, own})):
        assert {it.key for it in uncertain_values(case)[0] if it.key.endswith(key)} == found
