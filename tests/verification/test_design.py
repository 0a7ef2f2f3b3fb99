"""The search for designs and the front of micro-geometry, against brute force and single cases."""

from __future__ import annotations

import contextlib
import copy
import inspect
import io
import json
import math
import time

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import linprog

from asymmetric import gear_pair
from epicyclic.case.case import read_case
from epicyclic.errors import InputError
from epicyclic.plugins.design import candidates as enumerating
from epicyclic.plugins.design import search as searching
from epicyclic.plugins.design.candidates import LAYOUTS, case_tables, distances, sizes
from epicyclic.plugins.design.commands import design as command
from epicyclic.plugins.design.mass import parts, rotor_dynamics, rotor_text
from epicyclic.plugins.design.relief import Relief, relief_front
from epicyclic.plugins.design.report import fates_table, front_of, stored
from epicyclic.plugins.design.search import case_text, design, dominated, screen, search
from epicyclic.plugins.design.task import read_task
from epicyclic.study.load import load_case
from epicyclic.study.meshes import mesh_details
from epicyclic.study.sweeps.run import write_netcdf
from epicyclic.study.sweeps.runner import Runner
from problems import problems_of

ROUNDING = 1e-6  # Case files have nine digits, face widths six.


def task_of(*arrangements, ratio=4.1, **choices):
    return {
        "title": "a task",
        "ratio": ratio,
        "operation": {"torque": "61 N*m", "speed": "2900 rpm", "oil_inlet_temperature": "70 degC"},
        "choices": {
            "arrangements": list(arrangements),
            "module": ["1.5 mm", "2 mm"],
            "helix_angle": ["0 deg", "17 deg"],
            "pinion_teeth": [18, 23],
            "profile_shift": [0.1, 0.3],
            "distance_shift": [0.2],
            "width_ratio": [0.7, 1.1],
            **choices,
        },
        "limits": {"pitting": 1.05, "bending": 1.45},
        "search": {"solved": 12, "batch": 4, "polished": 0},
        "case": {
            "lubricant": {"oil": "iso-vg-100-mineral"},
            "strength": {"life": "700 h"},
            "numerics": {"mesh_positions": 6, "contact_segments": 6},
        },
    }


def test_help_shows_a_whole_task_and_what_lacks_one_names_it(tmp_path):
    shown = inspect.cleandoc(command.help).split("\b\n")[1]
    path = tmp_path / "task.toml"
    path.write_text(shown)
    assert read_task(path).choices.module == (0.0015, 0.002)
    for text in ("", "# nothing", "ratio = 4.2"):
        path.write_text(text)
        with pytest.raises(InputError, match="'epicyclic design --help' shows") as caught:
            read_task(path)
        assert "init" not in str(caught.value)


RATIOS = {"pair": 3.1, "planetary": 4.1, "stepped": 12.3, "wolfrom": 40.0, "two-stage": 17.3}


@pytest.mark.parametrize(
    "name",
    [name if name == "pair" else pytest.param(name, marks=pytest.mark.slow) for name in RATIOS],
)
def test_screened_sizes_are_those_of_the_case(name):
    """Ratio, centre distance, contact ratio, backlash and ring are what the case itself has."""
    task = read_task(task_of(name, ratio=RATIOS[name]))
    found = screen(task)
    passing = found.table[found.table.fate == ""]
    checked = 0
    for number in passing.index[:: max(1, len(passing) // (6 if name == "pair" else 25))]:
        row = passing.loc[number].dropna().to_dict()
        try:
            case = read_case(case_tables(task, row))
        except InputError:
            continue  # tips and fillets are checked there only
        checked += 1
        meshes = [mesh for own in case.gearings.values() for mesh in own.geometries]
        assert len(meshes) == len(LAYOUTS[name].meshes)
        least = min(mesh.transverse_contact_ratio + mesh.overlap_ratio for mesh in meshes)
        known = found.bounds.loc[number, "contact_ratio"] * task.limits.contact_ratio
        assert known == pytest.approx(least, rel=1e-4)
        for mesh in meshes:
            assert mesh.normal_backlash == pytest.approx(task.choices.backlash, abs=1e-8)
        distance = distances(passing.loc[[number]].dropna(axis=1))[0]
        assert meshes[0].center_distance == pytest.approx(distance, rel=ROUNDING)
        assert meshes[0].face_width == pytest.approx(
            row["width_ratio"] * 2 * meshes[0].gear1.reference_radius, rel=1e-5
        )
        external = {gear for mesh in meshes for gear in (mesh.gear1, mesh.gear2)}
        tips = [
            2 * it.tip_radius * it.tip_half_angle * math.cos(it.rack.helix_angle)
            / it.rack.normal_module
            for it in external if not it.internal
        ]  # fmt: skip
        known = found.bounds.loc[number, "tip_thickness"] * task.limits.tip_thickness
        assert known == pytest.approx(min(tips), rel=1e-4)
        bodies = [part for part in parts(case) if not part.name.endswith("carrier")]
        mass = sum(part.count * part.mass for part in bodies)
        assert row["mass"] == pytest.approx(mass, rel=0.02)  # of rings tips leave involutes
    assert checked >= 1


def test_planets_that_touch_each_other_are_screened_out():
    """Of stepped planets both gears count: the narrow one may be the larger one."""
    raw = task_of("wolfrom", ratio=40.0, planets=[4, 5], pinion_teeth=[13, 20], step=6)
    raw["limits"] = {"ratio_error": 0.3, "pitting": 0.01, "bending": 0.01, "contact_ratio": 1.0}
    found = screen(read_task(raw))
    passing = found.table[found.table.fate == ""]
    assert (found.table.fate == "planets touch each other").any()
    checked = 0
    for number in passing.index[:: max(1, len(passing) // 40)]:
        tables = case_tables(found.task, passing.loc[number].dropna().to_dict())
        told = [problem.allowed for problem in problems_of(read_case, tables)]
        assert not any("neighbour" in text for text in told)
        checked += 1
    assert checked > 20


def test_every_candidate_has_one_fate_and_they_sum_up():
    raw = task_of("planetary", "pair", planets=[3, 4, 7])
    raw["limits"] |= {"diameter": "150 mm", "width": "60 mm", "mass": "3 kg"}
    found = screen(read_task(raw))
    found.table.loc[found.table.fate == "", "fate"] = "passes"
    assert sum(found.fates.values()) == len(found.table)
    wanted = {
        "planets do not fit between the gears at equal angles",
        "planets touch each other",
        "diameter",
        "mass",
        "passes",
    }
    assert wanted <= found.fates.keys()


@pytest.mark.parametrize(
    "name",
    ["planetary", *(pytest.param(it, marks=pytest.mark.slow) for it in RATIOS if it[0] in "sw")],
)
def test_backlash_is_how_far_the_output_turns_with_the_input_held(name):
    """Against the largest rotation that keeps every mesh within its play, by linear programming."""
    task = read_task(task_of(name, ratio=RATIOS[name]))
    found = screen(task)
    number = found.table.index[found.table.fate == ""][-1]
    (gearing,) = found.case(number).gearings.values()
    columns = {"planet": 0, "output_ring": 1, "carrier": 2}  # all else is held
    rows, plays = [], []
    for mesh in gearing.geometries:
        first, second = mesh.gear1, mesh.gear2
        row = np.zeros(3)
        for gear, side in ((first, 1), (second, -1 if mesh.internal else 1)):
            body = gearing.bodies[gear.name]
            row[0] += side * gear.base_radius * (body in gearing.planets)
            if body not in gearing.planets:
                row[2] -= side * gear.base_radius  # against the carrier
                if gear.name == "output_ring":
                    row[1] += side * gear.base_radius
        rows.append(row)
        plays.append(mesh.normal_backlash / math.cos(first.rack.base_helix_angle) / 2)
    output = np.zeros(3)
    output[columns["output_ring" if name == "wolfrom" else "carrier"]] = -1.0
    most = linprog(
        output, np.vstack([rows, np.negative(rows)]), [*plays, *plays], bounds=(None, None)
    )
    assert 2 * -most.fun == pytest.approx(found.table.loc[number, "backlash"], rel=1e-5)


@pytest.mark.parametrize(
    ("limits", "key"),
    [
        ({"diameter": "37 mm"}, "limits.diameter"),
        ({"width": "3 mm"}, "limits.width"),
        ({"mass": "12 g"}, "limits.mass"),
        ({"pitting": 60}, "limits.pitting"),
        ({"bending": 90}, "limits.bending"),
        ({"contact_ratio": 8}, "limits.contact_ratio"),
        ({"backlash": "0.7 arcmin"}, "limits.backlash"),
    ],
)
def test_an_impossible_task_names_the_limit_and_by_how_much(limits, key, monkeypatch):
    raw = task_of("planetary")
    raw["limits"] |= limits
    with pytest.raises(InputError) as error:
        design(raw)
    (problem,) = error.value.problems
    assert problem.key == key
    assert "%: the nearest of" in problem.allowed
    strong = {"pitting": 1e3, "bending": 1e3}
    monkeypatch.setattr(searching, "evaluate", lambda *it: made_up(*it) | strong)
    relaxed = problem.remedy.removeprefix("Relax it to ").split(", or")[0]
    name = key.removeprefix("limits.")
    raw["limits"][name] = relaxed if " " in relaxed else float(relaxed)
    assert design(raw, jobs=1).fronts


def test_a_folder_is_made_only_for_designs_that_were_found(tmp_path):
    raw = task_of("pair", ratio=3.1)
    raw["limits"]["diameter"] = "23 mm"
    path, folder = tmp_path / "task.toml", tmp_path / "new" / "designs"
    path.write_text(case_text(raw))
    for options in ([], ["--screen"], ["--journal", str(folder)]):
        with contextlib.suppress(InputError):
            command.main([str(path), "-o", str(folder), *options], standalone_mode=False)
        assert sorted(tmp_path.iterdir()) == [path]
    for option in ("-o", "--journal"):
        with pytest.raises(InputError) as caught:
            command.main([str(path), option, str(path / "x")], standalone_mode=False)
        assert [it.key for it in caught.value.problems] == [option]


@pytest.mark.parametrize(
    ("shares", "factor"), [((0.3, 0.5), "1.25"), ((0.3, 0.7), None), ((None, None), None)]
)
def test_shares_of_the_cycle_that_are_not_the_whole_are_told(shares, factor):
    """Points without a share count alike, which needs no word."""
    raw = task_of("pair")
    raw["cycle"] = [raw["operation"] | ({} if it is None else {"share": it}) for it in shares]
    note = fates_table(screen(read_task(raw))).note
    assert ("multiplied by" in note) == (factor is not None)
    assert factor is None or f"sum to 0.8, not to 1: multiplied by {factor}." in note


def test_of_many_combinations_the_stated_number_is_drawn(monkeypatch):
    raw = task_of("planetary", "pair")
    whole = screen(read_task(raw))
    assert whole.combinations == len(whole.table)
    raw["search"] |= {"most_candidates": 37, "seed": 5}
    one, two = (screen(read_task(raw)) for _ in range(2))
    assert one.combinations == len(whole.table)
    assert len(one.table) == 37
    assert one.table.equals(two.table)
    known = set(map(tuple, whole.table.astype(str).to_numpy()))
    drawn = set(map(tuple, one.table.astype(str).to_numpy()))
    assert len(drawn) == 37
    assert drawn <= known
    monkeypatch.setattr(enumerating, "MOST_TEETH", 5)
    with pytest.raises(InputError, match="combinations of teeth"):
        screen(read_task(raw))


def test_all_problems_of_a_task_are_told_at_once():
    raw = task_of("planetary")
    raw["choices"]["pinion_teeth"] = [30, 20]
    raw["case"]["sun"] = {"teeth": 3}
    del raw["case"]["lubricant"]
    with pytest.raises(InputError) as error:
        read_task(raw)
    keys = {problem.key for problem in error.value.problems}
    assert keys == {"choices.pinion_teeth", "case.sun", "case.lubricant"}


def test_no_choice_is_given_twice_and_a_cycle_moves():
    raw = task_of("pair", module=["2 mm", "0.002 m"])
    raw["cycle"] = [raw["operation"] | {"speed": "0 rpm"}, raw["operation"] | {"torque": "0 N*m"}]
    with pytest.raises(InputError) as error:
        read_task(raw)
    assert [problem.key for problem in error.value.problems] == ["cycle", "choices.module"]


def test_no_choice_may_be_empty_or_out_of_range():
    raw = task_of("planetary")
    raw["cycle"] = [raw["operation"] | {"torque": "17 N*m"}]
    wrong = {"arrangements": [], "module": [], "distance_shift": [], "planets": [0, 3]}
    raw["choices"] |= wrong | {"width_ratio": [0.6, -0.5]}
    raw["search"]["objectives"] = []
    with pytest.raises(InputError) as error:
        read_task(raw)
    keys = {problem.key.split("[")[0] for problem in error.value.problems}
    assert {f"choices.{name}" for name in (*wrong, "width_ratio")} | {"search.objectives"} == {
        key.removesuffix(".0").removesuffix(".1") for key in keys
    }


def test_tables_that_all_cases_share_are_checked_before_anything_is_solved():
    raw = task_of("planetary")
    raw["case"] |= {"lubricant": {"oil": "nonsense"}, "numerics": {"mesh_positions": 1}}
    raw["case"] |= {"strength": {"gears": 3}, "models": 7}
    with pytest.raises(InputError) as error:
        screen(read_task(raw))
    keys = {problem.key for problem in error.value.problems}
    assert keys == {
        "case.lubricant.oil", "case.numerics.mesh_positions", "case.strength.gears", "case.models"
    }  # fmt: skip


@pytest.mark.parametrize(
    ("name", "named"),
    [
        ("planetary", {"sun", "ring"}),
        ("pair", set()),
        ("stepped", {"S.sun", "S.ring"}),
        ("two-stage", {"A.sun", "B.sun", "A.ring", "B.ring"}),
    ],
)
def test_materials_of_gears_reach_every_arrangement(name, named):
    raw = task_of(name, ratio=RATIOS[name])
    stated = {"sun": {"material": "nitrided-mq"}, "ring": {"material": "nitrided-mq"}}
    raw["case"]["strength"]["gears"] = stated
    raw["choices"]["arrangements"] = list(dict.fromkeys([name, "planetary", "pair"]))
    task = read_task(raw)
    found = screen(task)
    row = found.table[found.table.arrangement == name].iloc[0].dropna().to_dict()
    assert set(case_tables(task, row)["strength"]["gears"]) == named
    raw["case"]["strength"]["gears"] = {"sum": {"material": "nitrided-mq"}}
    with pytest.raises(InputError, match="is no gear of the arrangements"):
        screen(read_task(raw))


def test_files_of_a_task_are_beside_it(tmp_path):
    raw = task_of("pair")
    raw["case"]["models"] = {"friction": "mixed-ehl", "oil_model": "measured.nc"}
    (tmp_path / "task.toml").write_text(case_text(raw))
    read = read_task(tmp_path / "task.toml")
    assert read.case["models"] == {
        "friction": "mixed-ehl", "oil_model": str(tmp_path / "measured.nc")
    }  # fmt: skip


def test_dominated_rows():
    values = np.array([[1.0, 5.0], [2.0, 3.0], [2.5, 3.0], [4.0, 1.0], [4.0, 1.0], [5.0, 2.0]])
    assert dominated(values, values).tolist() == [False, False, True, False, False, True]


def made_up(task, row):
    """A loss that falls with size and profile shift, without solving; all safeties are met."""
    size = 1e3 * row["module"] * row["width_ratio"] * row.get("pinion", row.get("sun"))
    loss = 31.0 + 5200.0 / size - 47.0 * row["shift"]
    return {"loss": loss, "pitting": 7.1, "bending": 8.3}


def test_a_search_ends_when_all_are_solved(monkeypatch):
    monkeypatch.setattr(searching, "evaluate", made_up)
    raw = task_of("pair", ratio=3.1, pinion_teeth=[18, 18], module=["2 mm"])
    raw["search"] |= {"solved": 1000, "objectives": ["loss", "transmission_error"]}
    raw["limits"] = {"pitting": 0.05, "bending": 0.05}
    monkeypatch.setattr(
        searching, "evaluate", lambda *it: made_up(*it) | {"transmission_error": it[1]["pinion"]}
    )
    found = search(read_task(raw), raw, Runner(1))
    assert not found.fates.keys() & {"", "not solved"}


def test_a_short_search_solves_some_of_every_arrangement(monkeypatch):
    monkeypatch.setattr(searching, "evaluate", made_up)
    raw = task_of("pair", "planetary", ratio=4.1, pinion_teeth=[18, 19])
    raw["limits"] |= {"pitting": 0.05, "bending": 0.05}
    raw["search"] |= {"solved": 3, "batch": 3}
    table = search(read_task(raw), raw, Runner(1)).table
    assert set(table.arrangement[table.loss.notna()]) == {"pair", "planetary"}


def test_a_polished_design_meets_the_limits_and_the_front_is_told_anew(monkeypatch):
    monkeypatch.setattr(searching, "evaluate", made_up)
    raw = task_of("pair", ratio=3.1)
    raw["limits"] |= {"pitting": 0.05, "bending": 0.05, "tip_thickness": 0.61}
    raw["search"] |= {"solved": 40, "polished": 1}
    task = read_task(raw)
    found = search(task, raw, Runner(1))
    (number,) = found.table.index[found.table.polished_shift.notna()]
    own = sizes(task, found.table.loc[[number]].dropna(axis=1))
    assert min(it[0] for it in own.margins.values()) >= 1 - 1e-9
    assert found.table.loc[number, "mass"] == pytest.approx(own.mass[0], rel=1e-12)
    start = found.table.loc[number, "polished_shift"]
    assert found.table.loc[number, "shift"] > start
    before = sizes(task, found.table.loc[[number]].dropna(axis=1).assign(shift=start))
    assert own.mass[0] <= before.mass[0]  # the other objective is no worse
    values = found.table.loc[found.fronts, ["loss", "mass"]].to_numpy()
    assert not dominated(values, values).any()


def test_what_only_solved_designs_tell_is_counted_apart_from_bounds(monkeypatch):
    """Coarse gears lose less than fine ones, which are lighter and solved first, let expect."""

    def over_bound(row):
        return 1.01 if row["module"] > 1.8e-3 else 1.4

    def coarse_loses_less(task, row):
        bound = float(sizes(task, pd.DataFrame([dict(row)])).loss[0])
        return made_up(task, row) | {"loss": over_bound(row) * bound}

    raw = task_of("pair", ratio=3.1, pinion_teeth=[18, 50], helix_angle=["0 deg"])
    raw["choices"]["profile_shift"] = [0.1]
    raw["limits"] |= {"pitting": 0.05, "bending": 0.05}
    raw["search"] |= {"solved": 40, "batch": 8}
    monkeypatch.setattr(searching, "evaluate", coarse_loses_less)
    found = search(read_task(raw), raw, Runner(1))
    losses = found.table.bound * found.table.apply(over_bound, axis=1)
    values = np.column_stack([losses, found.table.mass])
    passing = (found.bounds >= 1 - 1e-9).all(axis=1)
    beaten = dominated(values, values[passing])
    assert {searching.BEATEN, searching.LIKELY, "not solved"} <= found.fates.keys()
    assert beaten[found.table.fate == searching.BEATEN].all()
    assert not beaten[found.table.fate == searching.LIKELY].all()


@pytest.mark.slow
def test_a_stored_search_has_its_front_and_the_cases_of_its_points(monkeypatch, tmp_path):
    monkeypatch.setattr(searching, "evaluate", lambda *it: made_up(*it) | {"bearing_life": 317.0})
    raw = task_of("pair", ratio=3.1, pinion_teeth=[18, 19])
    raw["limits"] |= {"pitting": 0.05, "bending": 0.05}
    raw["search"] |= {"solved": 8, "batch": 8}
    found = search(read_task(raw), raw, Runner(1))
    path = tmp_path / "candidates.nc"
    write_netcdf(found.dataset(), path)
    again = stored(path)
    assert (again.fronts, again.chosen) == (found.fronts, sorted(found.chosen))
    front = front_of(again)
    shown = {number for trace in front.chart.plot["data"] for number in trace["customdata"]}
    assert shown == set(front.cases) == set(found.table.index[found.table.loss.notna()])
    number = found.chosen[0]
    assert "bearing life [h]" in front.tables[1].head
    assert front.cases[number] == case_text(case_tables(found.task, found.table.loc[number]))
    write_netcdf(found.dataset().drop_vars("bound"), path)
    with pytest.raises(InputError, match="no dataset of designs"):
        stored(path)


@pytest.mark.slow
def test_ten_thousand_candidates_are_screened_in_two_minutes():
    raw = task_of("planetary", "pair", module=["1.5 mm", "1.75 mm", "2 mm"])
    raw["choices"] |= {
        "pinion_teeth": [17, 33],
        "profile_shift": [0.0, 0.1, 0.2, 0.3, 0.4],
        "width_ratio": [0.5, 0.7, 0.9, 1.1, 1.3],
    }
    start = time.perf_counter()
    found = screen(read_task(raw))
    assert len(found.table) > 10_000
    assert time.perf_counter() - start < 120


@pytest.mark.campaign
def test_search_finds_what_brute_force_finds():
    raw = task_of("pair", ratio=3.1, pinion_teeth=[17, 31], distance_shift=[0.0, 0.3])
    raw["choices"]["module"] = ["1.25 mm", "1.5 mm", "2 mm"]
    raw["search"] = {"solved": 3000, "batch": 16, "polished": 0}  # more than pass the screens
    task = read_task(raw)
    brute = search(task, raw, Runner(1), brute=True)
    quick = search(task, raw, Runner(1))
    assert len(brute.table) >= 2000
    assert "not solved" not in quick.fates
    assert quick.fronts == brute.fronts
    assert len(quick.fronts) > 1
    solved = quick.table.loss.notna().sum(), brute.table.loss.notna().sum()
    assert solved[0] < solved[1]


@pytest.mark.slow
def test_a_search_goes_on_from_its_journal_and_repeats(tmp_path, monkeypatch):
    raw = task_of("pair", ratio=3.1)
    raw["limits"] = {"pitting": 0.5, "bending": 0.5}
    first = design(raw, jobs=1, journal=tmp_path / "journal")

    def fail(*_):
        raise AssertionError("solved again")

    monkeypatch.setattr(searching, "evaluate", fail)
    again = design(raw, jobs=1, journal=tmp_path / "journal")
    assert again.fates == first.fates
    assert again.fronts == first.fronts
    other = copy.deepcopy(raw)
    other["operation"]["torque"] = "62 N*m"
    with pytest.raises(InputError):
        design(other, jobs=1, journal=tmp_path / "journal")


@pytest.mark.slow
@pytest.mark.parametrize("name", ["pair", "planetary", "stepped", "wolfrom", "two-stage"])
def test_designs_are_cases_that_run_and_have_their_loss(name):
    raw = task_of(name, ratio=RATIOS[name])
    raw["limits"] = {"pitting": 0.05, "bending": 0.05}
    raw["search"] |= {"solved": 3, "batch": 3}
    found = design(raw, jobs=1)
    number = found.chosen[0]
    from epicyclic.study.solve import solve

    result = solve(found.case(number))
    assert result.total == pytest.approx(found.table.loc[number, "loss"], rel=1e-9)
    if name != "pair":
        assert result.total > 0
    ratio = abs(float(found.table.loc[number, "ratio"]))
    assert ratio == pytest.approx(RATIOS[name], rel=0.03 + 1e-9)
    speeds = result.values()
    if name in ("planetary",):
        assert speeds["sun_speed"] / speeds["carrier_speed"] == pytest.approx(ratio, rel=1e-9)


RELIEF = {  # Sun relief [um]: sun sliding [W], transmission error [um], pressure [GPa], flash [K].
    5: (1133, 0.430, 1.246, 70.9),
    15: (915, 0.288, 1.314, 38.7),
    25: (832, 0.366, 1.370, 41.4),
    35: (801, 0.441, 1.440, 43.5),
    45: (786, 0.424, 1.491, 44.7),
}
ALONE = {
    "models.preset": "talbot-2012",
    "losses.sun_mesh_pocketing.include": False,
    "losses.ring_mesh_pocketing.include": False,
    "planet.micro_geometry.tip_relief": "20 um",
    "planet.micro_geometry.tip_relief_roll_length": "2 mm",
    "sun.micro_geometry.tip_relief": "5 um",
    "sun.micro_geometry.tip_relief_roll_length": "2 mm",
}


def test_relief_under_no_load_is_an_input_error():
    vary = {"sun.micro_geometry.tip_relief": ["15 um"]}
    with pytest.raises(InputError) as caught:
        relief_front(Relief(load_case("talbot-2012"), "sun_mesh", vary, loads=[]), Runner(1))
    assert [problem.key for problem in caught.value.problems] == ["loads"]


def test_relief_of_a_set_of_a_train():
    case = load_case("train-eaxle")
    vary = {"sets.pair.pinion.micro_geometry.lead_crown": ["0 um", "5 um"]}
    data = relief_front(Relief(case, "pair.mesh", vary), Runner(1))
    assert float(data.transmission_error[1]) < float(data.transmission_error[0])
    idle = load_case("talbot-2012-pair")
    vary = {"pinion.micro_geometry.lead_crown": ["0 um", "5 um"]}
    with pytest.raises(InputError, match="the mesh carries no load"):
        relief_front(Relief(idle, "mesh", vary), Runner(1))


@pytest.mark.slow
def test_relief_of_the_test_article():
    """As this package computed it before; the loss there has 122 W of pocketing on top."""
    case = load_case("talbot-2012", ALONE)
    names = ("loss", "transmission_error", "pressure", "flash")
    vary = {"sun.micro_geometry.tip_relief": [f"{amount} um" for amount in RELIEF]}
    data = relief_front(Relief(case, "sun_mesh", vary, objectives=names), Runner(1))
    for place, (_, error, pressure, flash) in enumerate(RELIEF.values()):
        one = data.isel(variant=place)
        assert one.transmission_error.item() == pytest.approx(error, abs=6e-4)
        assert one.pressure.item() == pytest.approx(pressure, abs=6e-4)
        assert one.flash.item() == pytest.approx(flash, abs=0.06)
    slid = np.array([sliding for sliding, *_ in RELIEF.values()])
    fall = np.diff(data.loss.to_numpy())
    # ring mesh and bearing change a little with the losses of the sun mesh
    assert fall == pytest.approx(np.diff(slid), abs=0.06 * abs(np.diff(slid)).max())
    assert data.front.to_numpy().tolist() == [
        not any(
            all(data[name][other] <= data[name][place] for name in names)
            and any(data[name][other] < data[name][place] for name in names)
            for other in range(5)
        )
        for place in range(5)
    ]


@pytest.mark.slow
def test_tolerance_gives_a_band_around_every_variant():
    case = load_case("talbot-2012", ALONE)
    vary = {"sun.micro_geometry.tip_relief": ["15 um", "35 um"]}
    data = relief_front(Relief(case, "sun_mesh", vary, tolerance=4e-6), Runner(1))
    shifted = relief_front(
        Relief(case, "sun_mesh", {"sun.micro_geometry.tip_relief": ["19 um", "39 um"]}), Runner(1)
    )
    half = (data.loss_high - data.loss_low).to_numpy() / 2
    assert half == pytest.approx(np.abs((shifted.loss - data.loss).to_numpy()), rel=1e-6)
    assert math.isclose(float((data.loss_high + data.loss_low)[0]), 2 * float(data.loss[0]))


def test_harmonics_for_rotor_dynamics_give_back_stiffness_and_transmission_error():
    case = load_case(gear_pair(), {"numerics.mesh_positions": 40, "numerics.contact_segments": 6})
    found = rotor_dynamics(case)
    (own,) = found["meshes"].values()
    course = mesh_details(case)["mesh"]
    width = case.gearings[""].geometries[0].face_width
    known = {
        "stiffness_{}_N_per_m": 1e9 * width * course.mesh_stiffness.to_numpy(),
        "transmission_error_{}_m": 1e-6 * course.transmission_error.to_numpy(),
    }
    turned = own["teeth"][0] * np.radians(course.roll_angle.to_numpy())
    for name, values in known.items():
        amplitudes = np.array(own[name.format("amplitude")])
        phases = np.radians(own[name[: name.index("{")] + "phase_deg"])
        waves = np.cos(np.outer(turned, np.arange(1, len(phases) + 1)) + phases)
        rebuilt = own[name.format("mean")] + waves @ amplitudes
        assert np.ptp(rebuilt - values) < 0.12 * np.ptp(values)
        assert own[name.format("mean")] == pytest.approx(course.weight.to_numpy() @ values)
    assert own["frequency_Hz"] == pytest.approx(case.operation.speed / (2 * math.pi) * 19)
    table = pd.read_csv(io.StringIO(rotor_text(found, ".csv")))
    rows = table[table.quantity == "stiffness_amplitude_N_per_m"]
    assert rows.value.astype(float).tolist() == own["stiffness_amplitude_N_per_m"]
    assert json.loads(rotor_text(found, ".json")) == found
