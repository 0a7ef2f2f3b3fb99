"""REXS files with several stages: read as one train, run, results into them."""

from __future__ import annotations

import math
import tomllib

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.plugins.rexs.exporting import train_parts
from epicyclic.plugins.rexs.model import Component
from rexs_files import (
    CASING,
    DRIVEN,
    FIRST,
    LOAD,
    SECOND,
    THIRD,
    UNIT,
    Parts,
    bearing,
    eaxle,
    hold,
    mm,
    none,
    pair,
    run,
    shaft,
    two_planetary,
    wind,
)
from rexs_files import add_pair as with_pair
from rexs_files import add_planetary as with_planetary

COARSE = {"numerics.mesh_positions": 4, "numerics.contact_segments": 4}
MOTOR, WHEELS = 20, 24


@pytest.fixture
def read(tmp_path):
    """Write parts to a file and read it."""

    def reading(parts: Parts, suffix=".rexs", **options):
        return ep.read_rexs(parts.write(tmp_path / f"gears{suffix}"), **options)

    return reading


def needed(found):
    return {lack.key for lack in found.missing if lack.needed}


@pytest.mark.parametrize("suffix", [".rexs", ".rexsj"])
def test_pair_and_planetary_set_become_a_train(read, suffix):
    found = read(eaxle(), suffix)
    assert (found.kind, found.component) == ("train", 'gear_unit 1 "unit", 2 stages')
    assert needed(found) == set()
    case = found.case()
    assert case.shafts == {
        "motor": ("pair.pinion",),
        "mid": ("pair.gear", "set.sun"),
        "wheels": ("set.carrier",),
        "housing": ("set.ring",),
    }
    operation = case.operation
    assert (operation.input, operation.output) == ("motor", "wheels")
    assert operation.torque == 100.0
    assert operation.speed == pytest.approx(3000 * math.pi / 30)
    assert case.positions == {"pair.pinion": pytest.approx(0.04), "pair.gear": pytest.approx(0.04)}
    assert (case.sets["pair"].hand, case.sets["pair"].direction) == ("right", pytest.approx(0.0))
    assert case.sets["set"].planet.count == 3
    assert found.geometry_notes(case) == ()


def test_bearings_come_from_the_file(read):
    case = read(eaxle()).case()
    left, right = case.bearings["left"], case.bearings["right"]
    assert (left.type, right.type) == ("deep-groove", "cylindrical")
    assert (left.shaft, left.against, left.locating, right.locating) == (
        "motor", "housing", True, False,
    )  # fmt: skip
    sizes = (left.bore, left.outside_diameter, left.width, left.position)
    assert sizes == pytest.approx((0.03, 0.062, 0.016, 0.01))
    assert left.dynamic_load_rating == pytest.approx(20e3)
    assert left.static_load_rating == pytest.approx(11e3)


def test_stages_in_series_with_equal_names(read):
    found = read(two_planetary())
    assert list(found.tables["sets"]) == ["stage", f"stage_{SECOND}"]
    shafts = found.case().shafts
    assert shafts["between"] == ("stage.carrier", f"stage_{SECOND}.sun")
    assert shafts["housing"] == ("stage.ring", f"stage_{SECOND}.ring")
    result = ep.solve(found.case(COARSE))
    assert result.train.ratio == pytest.approx((1 + 60 / 24) ** 2)


def test_wind_gearbox_runs(read):
    found = read(wind())
    case = found.case(COARSE)
    assert list(case.sets) == ["low", "middle", "high"]
    assert (case.operation.input, case.operation.output) == ("rotor", "generator")
    result = ep.solve(case)
    assert result.train.ratio == pytest.approx(-1 / ((1 + 60 / 24) ** 2 * 36 / 24))
    assert 0.8 < result.efficiency < 1
    assert set(result.stage_losses) == {"low", "middle", "high"}


def test_one_stage_is_still_chosen_by_its_id(read):
    assert read(eaxle(), component=FIRST).kind == "gear_pair"
    assert read(eaxle(), component=SECOND).kind == "planetary"


def test_text_is_a_case_file_with_origins(read, tmp_path):
    found = read(eaxle())
    text = found.text()
    assert '"pair.pinion" = "40 mm"' in text
    assert "# support_vector of cylindrical_gear 1001" in text
    file = tmp_path / "train.toml"
    file.write_text(text, encoding="utf-8")
    assert ep.load_case(file) == found.case()
    changes = {
        'positions."pair.gear"': "41 mm",
        "sets.set.efficiency": 0.98,
        "seals.front": {"shaft": "motor", "diameter": "30 mm"},
    }
    file.write_text(found.text(changes), encoding="utf-8")
    assert ep.load_case(file) == found.case(changes)
    assert found.case(changes).positions["pair.gear"] == pytest.approx(0.041)


def test_what_is_lacking_is_needed(read):
    parts = eaxle()
    parts.relations = [
        item for item in parts.relations if item[1].get("part") not in (LOAD, DRIVEN)
    ]
    for number in (80, FIRST + 1):
        parts.set(number, support_vector=None)
    parts.set(81, inner_diameter=None)
    parts.components[CASING]["attributes"].clear()
    found = read(parts)
    keys = {
        "operation.input", "operation.output", "operation.torque", "operation.speed",
        "operation.oil_inlet_temperature", 'positions."pair.pinion"', "bearings.left.position",
        "bearings.right.bore",
    }  # fmt: skip
    assert needed(found) == keys
    text = found.text()
    assert tomllib.loads(text)["kind"] == "train"
    lines = [line for line in text.splitlines() if "NEEDED. The file" in line]
    assert len(lines) == len(keys)
    assert any(line.startswith('# "pair.pinion" = ...') for line in lines)
    with pytest.raises(ep.InputError) as excinfo:
        found.case()
    told = " ".join(problem.remedy for problem in excinfo.value.problems)
    assert "The file has no external_load with torque_around_u_axis" in told
    assert "Set operation.output. The shafts of a single set are motor, wheels." in told


def test_what_follows_from_the_rest_is_not_needed(read):
    """A file without a centre distance runs: it follows from the profile shifts."""
    parts = eaxle()
    for component in parts.components.values():
        component["attributes"].pop("center_distance", None)
    found = read(parts)
    assert needed(found)
    assert found.case().computed
    assert not any(lack.needed for lack in found.lacking())
    assert "NEEDED. The file" not in found.text()
    missing = {"operation.torque": None}
    assert any(lack.needed for lack in found.lacking(missing))
    assert "NEEDED. The file" in found.text(missing)


def test_gears_without_shafts_need_shafts(read):
    parts = eaxle()
    parts.relations = [item for item in parts.relations if item[1].get("part") != FIRST + 2]
    found = read(parts)
    assert needed(found) == {"shafts"}
    (lack,) = [lack for lack in found.missing if lack.needed]
    assert "pair and set" in lack.instead
    with pytest.raises(ep.InputError, match="Set shafts"):
        found.case()
    joined = {"shafts.sun_shaft": ["pair.gear", "set.sun"]}
    assert found.case(joined).shape.shaft_of("pair.gear") == "sun_shaft"


def test_brakes_and_clutches_become_states(read):
    parts = Parts("2.0.0")
    parts.components |= two_planetary().components
    parts.relations += two_planetary().relations
    del parts.components[71]
    parts.relations = [item for item in parts.relations if item[1].get("assembly") != 71]
    hold(parts, 72, 24, is_engaged=([True, False], "none"))
    parts.add(73, "switchable_coupling", "clutch", is_engaged=([False, True], "none"))
    parts.relate("side", assembly=73, inner_part=24, outer_part=21)
    found = read(parts)
    assert needed(found) == {"operation.state"}
    case = found.case({"operation.state": "1"})
    assert case.states["1"].fixed == ("ring_2",)
    assert case.states["2"].joined == (("ring_2", "between"),)
    parts.set(UNIT, gear_shift_index=none(2), number_of_gears=none(2))
    again = read(parts).case(COARSE)
    assert again.operation.state == "2"
    assert ep.solve(again).train.ratio == pytest.approx(1 + 60 / 24)  # the second set is locked


def test_further_speeds_close_a_train_with_more_freedom(read):
    parts = two_planetary()
    parts.relations = [item for item in parts.relations if item[1].get("assembly") != 71]
    assert needed(read(parts)) == {"operation.speeds"}
    parts.set(24, rotational_speed=(50.0, "1 / min"))
    found = read(parts)
    assert found.case().operation.speeds == {"ring_2": pytest.approx(50 * math.pi / 30)}
    parts.set(24, rotational_speed=(0.0, "1 / min"))
    assert "stage_2000.ring" in read(parts).case().shafts["housing"]


def test_several_stated_torques(read):
    parts = eaxle()
    parts.set(DRIVEN, torque_around_u_axis=(-500.0, "N m"))
    found = read(parts)
    assert found.tables["operation"]["input"] == "motor"
    assert found.tables["operation"]["output"] == "wheels"
    assert any("is used as the input" in note for note in found.notes)
    parts.add(62, "external_load", "pump", torque_around_u_axis=(-3.0, "N m"))
    parts.relate("assembly", assembly=21, part=62)
    parts.set(DRIVEN, torque_around_u_axis=None)
    assert read(parts).case().operation.torques == {"mid": -3.0}


def test_backward_input_turns_the_axis(read):
    """The input of a case turns forward: along the other axis, if need be."""
    parts = eaxle()
    parts.set(MOTOR, rotational_speed=(-3000.0, "1 / min"))
    parts.set(LOAD, torque_around_u_axis=(-100.0, "N m"))
    parts.set(81, axial_force_absorption=none("positive"))
    case = read(parts).case()
    assert case.operation.torque == 100.0
    assert case.positions["pair.pinion"] == pytest.approx(-0.04)
    assert case.bearings["right"].axial_sense == "negative"
    parts.set(MOTOR, rotational_speed=(3000.0, "1 / min"))
    parts.set(LOAD, torque_around_u_axis=(100.0, "N m"))
    assert read(parts).case().bearings["right"].axial_sense == "positive"


def test_bearings_that_statics_cannot_solve_need_forces(read):
    parts = eaxle()
    bearing(parts, 82, "middle", MOTOR, 20.0)
    found = read(parts)
    assert needed(found) == {"bearings.middle.radial_force"}
    assert found.case({"bearings.middle.radial_force": "100 N"})
    for number in (80, 82):
        del parts.components[number]
        parts.relations = [item for item in parts.relations if number not in item[1].values()]
    assert needed(read(parts)) == {"bearings.right.radial_force"}


def test_bearings_of_other_kinds(read):
    parts = eaxle()
    bearing(parts, 82, "Lager ä", WHEELS, 100.0, 61.4, "radial_tapered_roller_bearing")
    bearing(parts, 83, "", WHEELS, 130.0, 61.4, "angular_contact_ball_bearing")
    parts.add(84, "concept_bearing", "soft")
    parts.relate("side", assembly=84, inner_part=21, outer_part=CASING)
    bearing(parts, 85, "pilot", MOTOR, 90.0, outer=21)
    found = read(parts)
    keys = {"bearings.Lager_a.axial_factor", "bearings.bearing_83.type"}
    assert needed(found) == keys | {"bearings.right.radial_force"}
    assert "bearings.soft" in {lack.key for lack in found.missing}
    assert found.tables["bearings"]["pilot"]["against"] == "mid"
    parts.set(82, axial_factor_y_2=none(1.6))
    parts.set(83, bearing_type=none("radial_needle_roller_bearing"))
    case = read(parts).case({"bearings.right.radial_force": "100 N"})
    assert case.bearings["Lager_a"].axial_factor == 1.6
    assert case.bearings["bearing_83"].type == "needle"


def test_positions_along_a_shaft_without_axes(read):
    """u coordinates: of the middle of a gear; in version 1.0 of its side."""
    for version, middle in (("1.0", 0.05), ("1.1", 0.04)):
        parts = eaxle(version)
        for component in parts.components.values():
            for name in ("support_vector", "u_axis_vector"):
                component["attributes"].pop(name, None)
        for gear in (FIRST + 1, FIRST + 2):
            parts.set(gear, u_coordinate_on_shaft=mm(40.0))
        for number, place in ((80, 10.0), (81, 75.0)):
            parts.set(number, u_coordinate_on_shaft_inner_side=mm(place))
        for new, old in FORMER[version].items():
            parts.rename(new, old)
        found = read(parts)
        assert 'positions."pair.gear"' not in found.origins  # on one of two coupled shafts
        position = found.tables["positions"]["pair.pinion"]
        assert float(position.split()[0]) == pytest.approx(1e3 * middle)
        assert found.tables["bearings"]["left"]["position"] == "10 mm"


def turned(axis, degrees):
    """Rotation about an axis."""
    one, two, three = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -three, two], [three, 0, -one], [-two, one, 0]])
    angle = math.radians(degrees)
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


@pytest.mark.parametrize("axes", ["of all parts", "of the parts in the unit", "of none"])
@pytest.mark.parametrize(
    ("about", "degrees"),
    [((0, 0, 1), 60.0), ((0, 1, 0), 90.0), ((0, 0, 1), 90.0), ((0.1, 0.7, -0.3), 140.0),
     ((0.0, 1.0, 2.0), 33.0)],
)  # fmt: skip
def test_it_does_not_matter_how_the_gear_unit_stands(read, about, degrees, axes):
    """With the axis of the gear unit in global coordinates, in its own, or not stated."""
    rotation = turned(about, degrees)
    parts = eaxle()
    expected = read(parts).tables
    parts = eaxle()
    for number, component in parts.components.items():
        for name in ("support_vector", "u_axis_vector"):
            given = component["attributes"].get(name)
            if given is not None:
                parts.set(number, **{name: ((rotation @ given[0]).tolist(), given[1])})
            if name == "u_axis_vector" and axes == "of none":
                component["attributes"].pop(name, None)
    if axes == "of all parts":
        parts.set(UNIT, u_axis_vector=((rotation @ [1.0, 0, 0]).tolist(), "mm"))
    elif axes == "of the parts in the unit":
        parts.set(UNIT, u_axis_vector=([1.0, 0.0, 0.0], "mm"))
    found = read(parts).tables
    places = [
        [lengths["positions"]["pair.pinion"], lengths["positions"]["pair.gear"],
         *(bearing["position"] for bearing in lengths["bearings"].values())]
        for lengths in (expected, found)
    ]  # fmt: skip
    one, two = ([float(place.split()[0]) for place in own] for own in places)
    assert len(set(one)) > 2
    assert two == pytest.approx(one, abs=1e-5)
    if about[0] == 0:
        assert found["sets"]["pair"]["direction"] == expected["sets"]["pair"]["direction"]


FORMER = {
    "1.0": {
        "arithmetic_mean_roughness_flank_iso_4287_1997": "arithmetic_average_roughness_flank",
        "radial_dynamic_load_rating": "dynamic_capacity",
        "radial_static_load_rating": "static_capacity",
    },
    "1.1": {},
}


def test_version_1_0(read):
    parts = eaxle("1.0")
    for new, old in FORMER["1.0"].items():
        parts.rename(new, old)
    for component in parts.components.values():
        if component["type"] == "cylindrical_gear_flank":
            component["type"] = "flank_geometry"
            component["attributes"]["normal_pressure_angle"] = (20.0, "°")
        if component["type"] == "coupling":
            component["type"] = "fixed_coupling"
    assert read(parts).case() == read(eaxle()).case()
    single = pair("1.0")
    single.rename("arithmetic_mean_roughness_flank_iso_4287_1997",
                  "arithmetic_average_roughness_flank")  # fmt: skip
    assert read(single).case() == read(pair()).case()


def test_stages_that_are_not_read_are_told(read):
    parts = eaxle()
    parts.add(500, "bevel_stage", "bevel")
    parts.relate("stage", stage=THIRD, gear_1=FIRST + 2, gear_2=500)
    parts.add(THIRD, "cylindrical_stage", "third", center_distance=mm(61.4))
    parts.relations.pop()
    with pytest.raises(ep.InputError, match="third"):
        read(parts)
    del parts.components[THIRD]
    assert any("bevel_stage 500" in note for note in read(parts).notes)
    parts = eaxle()
    shaft(parts, 25, "end", 0.0, 122.8)
    with_pair(parts, THIRD, "next", (25, 21), 40.0, (122.8, 61.4))
    assert not any("appears in" in note for note in read(parts).notes)
    parts.relations = [item for item in parts.relations if item[1].get("stage") != THIRD]
    parts.relate("stage", stage=THIRD, gear_1=FIRST + 2, gear_2=THIRD + 1)
    assert any("appears in 2 sets" in note for note in read(parts).notes)


def test_files_of_too_many_parts_are_refused(read):
    parts = pair()
    for number in range(400, 450):
        parts.add(number, "cylindrical_stage", "more")
    with pytest.raises(ep.InputError, match="51 stages"):
        read(parts)
    parts = pair()
    for number in range(400, 450):
        parts.add(number, "planetary_stage", "more")
    with pytest.raises(ep.InputError, match="50 stages"):
        read(parts)
    parts = eaxle()
    for number in range(4000, 4400):
        bearing(parts, number, "more", MOTOR, 10.0)
    with pytest.raises(ep.InputError, match="402 bearings"):
        read(parts)


def test_names_are_safe(read):
    names = ('a"b]\n[c', "=;#'", "housing", "7", "ß" * 99)
    parts = two_planetary()
    for number, name in zip((FIRST, SECOND, 20, 21, 22), names, strict=True):
        parts.components[number]["name"] = name
    found = read(parts, ".rexsj")
    text = found.text()
    assert tomllib.loads(text)["sets"].keys() == {"a_b_c", f"stage_{SECOND}"}
    shafts = tomllib.loads(text)["shafts"]
    assert shafts.keys() == {"housing_20", "shaft_7", "s" * 32, "housing"}
    assert found.case()


# --- results --------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    file = eaxle().write(tmp_path_factory.mktemp("rexs") / "gears.rexs")
    return file, ep.solve(ep.read_rexs(file).case(COARSE))


def written(parts, number, name):
    own = {child.get("id"): child for child in parts[number]}
    return float(own[name].text)


def test_results_go_to_stages_shafts_and_bearings(tmp_path, solved):
    from lxml import etree

    file, result = solved
    target = tmp_path / "out.rexs"
    ep.write_rexs(target, result, original=file)
    parts = {int(item.get("id")): item for item in etree.parse(target).iter("component")}
    custom = "custom_epicyclic_"
    assert written(parts, UNIT, f"{custom}total") == pytest.approx(result.total)
    for number, name in ((FIRST, "pair"), (SECOND, "set")):
        loss = result.stage_losses[name]
        assert written(parts, number, f"{custom}total") == pytest.approx(loss)
    wheels = result.flow.members["wheels"]
    assert written(parts, WHEELS, f"{custom}torque") == pytest.approx(wheels.torque)
    assert written(parts, WHEELS, f"{custom}speed") == pytest.approx(wheels.speed * 30 / math.pi)
    left = result.stage_losses["left"]
    assert written(parts, 80, "total_frictional_power_loss") == pytest.approx(left)
    assert written(parts, FIRST, "radial_contact_ratio") > 1
    assert ep.read_rexs(target).tables == ep.read_rexs(file).tables


def test_results_belong_into_their_own_file(tmp_path, solved):
    file, result = solved
    other = two_planetary().write(tmp_path / "other.rexs")
    with pytest.raises(ep.InputError, match=r"sets\.pair.*is not in the file"):
        ep.write_rexs(tmp_path / "out.rexs", result, original=other)
    with pytest.raises(ep.InputError, match="names one stage"):
        ep.write_rexs(tmp_path / "out.rexs", result, original=file, component=FIRST)
    single = pair().write(tmp_path / "single.rexs")
    with pytest.raises(ep.InputError, match="has one stage"):
        ep.write_rexs(tmp_path / "out.rexs", result, original=single)
    parts = eaxle()
    parts.set(FIRST + 1, number_of_teeth=none(25))
    with pytest.raises(ep.InputError, match=r"sets\.pair\.pinion\.teeth"):
        ep.write_rexs(tmp_path / "out.rexs", result, original=parts.write(tmp_path / "z.rexs"))
    assert not (tmp_path / "out.rexs").exists()


@pytest.mark.parametrize("suffix", [".rexs", ".rexsj", ".rexsz"])
def test_new_file_describes_the_train(tmp_path, solved, suffix):
    _, result = solved
    target = tmp_path / f"new{suffix}"
    ep.write_rexs(target, result)
    found = ep.read_rexs(target)
    assert needed(found) == set()
    first, again = ep.load_case(result.inputs), found.case()
    for key in ("shafts", "positions", "operation"):
        assert getattr(again, key) == getattr(first, key), key
    assert {name: table.position for name, table in again.bearings.items()} == {
        name: table.position for name, table in first.bearings.items()
    }
    assert again.sets["pair"].hand == "right"


def test_new_file_keeps_states_and_refuses_other_sets(tmp_path):
    parts = two_planetary()
    hold(parts, 71, 24, is_engaged=([True, False], "none"))
    parts.set(UNIT, gear_shift_index=none(1))
    case = ep.read_rexs(parts.write(tmp_path / "states.rexs")).case(COARSE)
    result = ep.solve(case)
    ep.write_rexs(tmp_path / "new.rexsj", result)
    again = ep.read_rexs(tmp_path / "new.rexsj").case()
    assert again.states == case.states
    given = ep.solve(case.updated({"sets.stage.efficiency": 0.98}))
    with pytest.raises(ep.InputError, match=r"sets\.stage.*neither a planetary set"):
        ep.write_rexs(tmp_path / "no.rexs", given)
    ep.write_rexs(tmp_path / "yes.rexs", given, original=tmp_path / "states.rexs")


def test_planetary_sets_with_carriers_on_several_shafts(read):
    parts = Parts("2.0.0")
    parts.components |= eaxle().components
    parts.relations += eaxle().relations
    shaft(parts, 30, "carrier front", 70.0, 61.4)
    parts.relate("planet_carrier_shaft", planetary_stage=SECOND, shaft=30)
    assert read(parts).case().shafts["wheels"] == ("set.carrier",)


def test_train_without_unit_and_names(read):
    parts = Parts("2.0.0")
    for number in range(10, 14):
        parts.add(number, "shaft")
    with_planetary(parts, FIRST, "", {"sun": 10, "ring": 11, "carrier": 12})
    with_pair(parts, SECOND, "", (12, 13), 0.0)
    run(parts, 10, 13, 1.0, 100.0)
    found = read(parts)
    assert found.component == f"planetary_stage {FIRST}, 2 stages"
    assert found.tables["sets"].keys() == {f"stage_{FIRST}", f"stage_{SECOND}"}
    assert needed(found) == {
        "operation.oil_inlet_temperature", "operation.speeds", "lubricant.oil",
    }  # fmt: skip


def test_bearings_without_a_name_there_are_written_without_their_type():
    changed = {"shaft": "motor", "position": "0 mm", "designation": "7207 B", "locating": True}
    case = ep.load_case("train-eaxle").updated({"bearings.motor_front": changed})
    bearings = {
        part.name: part.get("bearing_type")
        for part in train_parts(case)
        if isinstance(part, Component) and part.type.startswith("rolling_bearing_with_catalog")
    }
    assert bearings["motor_front"] is None
    assert bearings["motor_rear"].text() == "radial_roller_bearing"
