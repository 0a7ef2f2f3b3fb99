"""REXS files into cases: what is read, how it is named, what is told to be lacking."""

from __future__ import annotations

import base64
import math
import re
import struct
import tomllib

import pytest

import epicyclic as ep
from epicyclic.gears.flanks import RA_OVER_RQ
from epicyclic.plugins.rexs.draft import Draft
from epicyclic.plugins.rexs.gears import _shifts
from epicyclic.plugins.rexs.model import id_in, term, versions
from rexs_files import (
    CASING,
    OIL,
    PLANET,
    PLANETS,
    RING,
    STAGE,
    SUN,
    SUN_SHAFT,
    Parts,
    mm,
    pair,
    planetary,
)
from rexs_files import none as no_unit

ROUGH = {"planet_bearing.roller_roughness": "0.1 um", "planet_bearing.race_roughness": "0.1 um"}
"""What no REXS file can give."""


@pytest.fixture
def read(tmp_path):
    """Write parts to a file and read it."""

    def reading(parts: Parts, suffix=".rexs", **options):
        return ep.read_rexs(parts.write(tmp_path / f"gears{suffix}"), **options)

    return reading


def meshes(case):
    return case.gearings[""].geometries


def problems(excinfo):
    return {problem.key: problem for problem in excinfo.value.problems}


def test_planetary_set_becomes_a_case(read):
    case = read(planetary()).case(ROUGH)
    assert (case.sun.teeth, case.planet.teeth, case.ring.teeth, case.planet.count) == (
        24,
        18,
        60,
        3,
    )
    assert case.gears.normal_module == pytest.approx(2e-3)
    assert case.gears.helix_angle == pytest.approx(math.radians(12))
    assert case.gears.center_distance == pytest.approx(42.94e-3)
    assert case.ring.tip_diameter == pytest.approx(119.6e-3)
    assert (case.operation.input, case.operation.fixed) == ("sun", "ring")
    assert case.operation.torque == 100.0
    assert case.operation.speed == pytest.approx(1500 * math.pi / 30)
    assert case.operation.oil_inlet_temperature == pytest.approx(353.15)
    assert case.sun.roughness == pytest.approx(0.4e-6 / RA_OVER_RQ, rel=1e-5)  # six digits written
    bearing = case.planet_bearing
    assert (bearing.rows, bearing.rollers_per_row) == (1, 14)
    assert bearing.pin_diameter == pytest.approx(14e-3)  # pitch circle less one roller
    assert bearing.diametral_clearance == pytest.approx(10e-6)
    oil = case.lubricant.oil
    assert oil.kind == "mineral"
    assert oil.pressure_viscosity.point[0].value == pytest.approx(22e-9)  # 0.022 mm^2/N
    assert oil.density[0].value == pytest.approx(880)


def test_all_forms_of_a_file_give_the_same(read):
    xml, json = read(planetary()), read(planetary(), ".rexsj")
    assert xml.tables == json.tables
    assert xml.origins == json.origins


def test_pair_becomes_a_case_with_the_smaller_gear_as_pinion(read):
    case = read(pair()).case()
    assert (case.kind, case.pinion.teeth, case.gear.teeth) == ("gear_pair", 24, 36)
    assert case.operation.torque == 50.0


def test_every_value_says_where_it_comes_from(read):
    found = read(planetary())
    text = found.text()
    line = next(line for line in text.splitlines() if line.startswith("tip_diameter"))
    assert line.endswith('# tip_diameter of cylindrical_gear 10 "sun"')
    assert "and 2 more" in found.origins["planet.face_width"]
    given = tomllib.loads(text)
    assert given["sun"]["teeth"] == 24
    assert not found.origins.keys() & {lack.key for lack in found.missing}


def test_text_reads_back_as_the_same_case(read, tmp_path):
    found = read(planetary())
    file = tmp_path / "case.toml"
    file.write_text(found.text(ROUGH), encoding="utf-8")
    assert ep.load_case(file) == found.case(ROUGH)


def test_text_says_what_the_user_changed(read):
    text = read(planetary()).text({"planet_bearing": None, "sun.roughness": "0.3 um"})
    assert re.search(r"^# \[planet_bearing\] +# Removed by the user\.$", text, re.MULTILINE)
    assert re.search(r'^roughness = "0.3 um" +# Set by the user\.$', text, re.MULTILINE)
    assert "rolling_element" not in text


def test_lacking_values_are_told_by_their_rexs_id(read):
    parts = planetary()
    parts.set(SUN, arithmetic_mean_roughness_flank_iso_4287_1997=None, tip_diameter=None)
    found = read(parts)
    lacks = {lack.key: lack for lack in found.missing}
    assert lacks["sun.roughness"].needed
    assert "arithmetic_mean_roughness_flank_iso_4287_1997" in lacks["sun.roughness"].attribute
    assert f"cylindrical_gear {SUN}" in lacks["sun.roughness"].attribute
    assert not lacks["sun.tip_diameter"].needed
    assert "addendum_coefficient" in lacks["sun.tip_diameter"].instead
    with pytest.raises(ep.InputError) as excinfo:
        found.case(ROUGH)
    assert list(problems(excinfo)) == ["sun.roughness"]
    assert "cylindrical_gear 10" in problems(excinfo)["sun.roughness"].remedy
    assert found.case({**ROUGH, "sun.roughness": "ground"}).sun.roughness > 0


def test_lacking_profile_shift_says_which_one_closes_the_mesh(read):
    parts = planetary()
    for flank in (100 + RING, 200 + RING):
        parts.set(flank, addendum_modification_coefficient=None)
    found = read(parts)
    lack = next(lack for lack in found.missing if lack.key == "ring.profile_shift_coefficient")
    closing = float(lack.instead.split()[3])
    assert lack.needed
    case = found.case({**ROUGH, "ring.profile_shift_coefficient": closing})
    backlash = meshes(case)[1].backlash
    assert 0 <= backlash < 2e-9  # the shift has six decimals: 2 m_n tan(alpha) 1e-6


@pytest.mark.parametrize("teeth", [(15, 23), (17, 31), (21, 44), (12, 69)])
def test_shifts_that_close_a_mesh_stay_as_they_are(teeth):
    given = {
        "gears.normal_module": "2.5 mm",
        "gears.normal_pressure_angle": "20 deg",
        "gears.helix_angle": "0 deg",
        "gears.center_distance": f"{2.5 * sum(teeth) / 2!r} mm",
    }
    for gear, number in zip(("pinion", "gear"), teeth, strict=True):
        given |= {f"{gear}.teeth": number, f"{gear}.profile_shift_coefficient": 0.0}
    draft = Draft({"kind": "gear_pair"})
    for key, value in given.items():
        draft.give(key, value, "file")
    _shifts(draft, "", "pinion", "gear", "gear")
    assert draft.tables["gear"]["profile_shift_coefficient"] == 0.0
    assert not draft.notes


def test_shift_of_the_ring_with_the_other_sign_is_noticed(read):
    parts = planetary()
    x_planet, x_ring = 0.2, -0.2  # sum zero closes the mesh at the reference distance
    for number in PLANETS:
        for flank in (100, 200):
            parts.set(flank + PLANET + number,
                      addendum_modification_coefficient=no_unit(x_planet))  # fmt: skip
    for flank in (100, 200):
        parts.set(flank + RING, addendum_modification_coefficient=no_unit(-x_ring))
    notes = [note for note in read(parts).notes if "other sign" in note]
    assert len(notes) == 1
    assert f"ring.profile_shift_coefficient = {x_ring}" in notes[0]


def test_negative_teeth_and_diameters_of_a_ring_are_magnitudes(read):
    parts = planetary()
    parts.set(RING, number_of_teeth=no_unit(-60), tip_diameter=mm(-119.6))
    for number in PLANETS:
        parts.set(60 + number, center_distance=mm(-42.94))
    for number in PLANETS:
        parts.set(50 + number, center_distance=None)
    assert read(parts).case(ROUGH) == read(planetary()).case(ROUGH)


def test_hands_of_helices_must_fit(read):
    parts = planetary()
    parts.set(RING, helix_angle_reference_diameter=(12.0, "deg"))
    notes = read(parts).notes
    assert ["same hand" in note for note in notes] == [True]
    assert not read(planetary()).notes


def test_planets_must_be_alike(read):
    parts = planetary()
    parts.set(PLANET + 1, face_width=mm(21.0))
    with pytest.raises(ep.InputError, match="must be equal"):
        read(parts)


def test_figures_of_the_file_are_compared_with_the_geometry(read):
    parts = planetary()
    diameter = 24 * 2 / math.cos(math.radians(12))
    parts.set(SUN, reference_diameter_cylindrical_gear=mm(diameter), base_diameter=mm(50.0))
    parts.set(50, radial_contact_ratio=no_unit(1.9))
    found = read(parts)
    notes = found.geometry_notes(found.case(ROUGH))
    assert [note.split()[0] for note in notes] == ["base_diameter", "radial_contact_ratio"]


UNTIL_2 = {
    "arithmetic_mean_roughness_flank_iso_4287_1997": "arithmetic_average_roughness_flank",
    "reference_diameter_rolling_bearing": "reference_diameter",
}


@pytest.mark.parametrize(("version", "ids"), [("1.2", UNTIL_2), ("1.7", UNTIL_2), ("2.0", {})])
def test_ids_of_earlier_versions_are_known(read, version, ids):
    parts = planetary(version)
    for new, old in ids.items():
        parts.rename(new, old)
    if version == "1.2":  # one type for the flanks of all gears, and the degree sign
        for component in parts.components.values():
            if component["type"] == "cylindrical_gear_flank":
                component["type"] = "flank_geometry"
                component["attributes"]["normal_pressure_angle"] = (20.0, "°")
    assert read(parts).case(ROUGH) == read(planetary()).case(ROUGH)


def test_vocabulary_knows_when_ids_changed():
    assert id_in("base_diameter", "1.7") == "base_circle_diameter"
    assert id_in("base_diameter", "2.0.0") == "base_diameter"
    assert id_in("root_diameter", "1.1") is None
    assert id_in("operating_radial_bearing_clearance", "1.0") == "radial_backlash"
    assert versions()[0] == "1.0"
    assert term("tip_diameter").unit == "mm"


def test_units_of_the_file_are_converted(read):
    parts = planetary()
    parts.set(SUN, face_width=(20_000.0, "mum"))
    assert read(parts).case(ROUGH).sun.face_width == pytest.approx(20e-3)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"face_width": ("NaN", "mm")}, "not a finite number"),
        ({"face_width": ("1e999", "mm")}, "not a finite number"),
        ({"face_width": ("1_0", "mm")}, "not a finite number"),
        ({"face_width": ("wide", "mm")}, "not a finite number"),
        ({"face_width": (20.0, "furlong")}, "which REXS does not have"),
    ],
)
def test_values_that_cannot_be_read_are_told(read, change, told):
    parts = planetary()
    parts.set(SUN, **change)
    with pytest.raises(ep.InputError, match=told) as excinfo:
        read(parts)
    assert list(problems(excinfo)) == [f'face_width of cylindrical_gear {SUN} "sun"']


def test_unit_of_another_kind_is_a_problem_of_the_key(read):
    parts = planetary()
    parts.set(SUN, face_width=(20.0, "kg"))
    with pytest.raises(ep.InputError) as excinfo:
        read(parts).case(ROUGH)
    assert "sun.face_width" in problems(excinfo)


def test_load_case_comes_before_the_component(read, tmp_path):
    parts = planetary()
    parts.load_cases = {7: {8: {"torque_around_u_axis": (-40.0, "N m")}}}
    assert read(parts).case(ROUGH).operation.torque == 100.0
    assert any("load cases: 7" in note for note in read(parts).notes)
    # against the speed, power flows out of the sun: coasting
    assert read(parts, load_case=7).case(ROUGH).operation.torque == -40.0
    with pytest.raises(ep.InputError, match="It has 7"):
        read(parts, load_case=8)


def test_torques_of_several_loads_add_up(read):
    parts = planetary()
    parts.add(500, "external_load", "another", torque_around_u_axis=(20.0, "N m"))
    parts.relate("assembly", assembly=SUN_SHAFT, part=500)
    assert read(parts).case(ROUGH).operation.torque == 120.0


def test_power_and_speed_give_the_torque(read):
    parts = planetary()
    parts.set(8, torque_around_u_axis=None, power=(10.0, "kW"))
    torque = read(parts).case(ROUGH).operation.torque
    assert torque == pytest.approx(10e3 / (1500 * math.pi / 30))


@pytest.mark.parametrize(
    ("speed", "expected"),
    [(-600.0, {"second_input": "ring", "second_speed": "600 rpm"}), (0.0, {"fixed": "ring"})],
)
def test_speed_of_a_second_member(read, speed, expected):
    parts = planetary()
    parts.relations = [item for item in parts.relations if 9 not in item[1].values()]
    parts.set(SUN_SHAFT, rotational_speed=(-1500.0, "1 / min"))
    parts.set(6, rotational_speed=(speed, "1 / min"))
    found = read(parts)
    operation = dict(found.tables["operation"])
    # the sun turns backward: its speed is taken as a magnitude, that of the ring relative to it
    assert operation.pop("speed") == "1500 rpm"
    assert {key: operation[key] for key in expected} == expected
    assert found.case(ROUGH).operation.torque == -100.0


def test_neither_held_nor_driven_is_told(read):
    parts = planetary()
    parts.relations = [item for item in parts.relations if 9 not in item[1].values()]
    parts.set(8, torque_around_u_axis=None)
    needed = {lack.key for lack in read(parts).missing if lack.needed}
    assert {"operation.fixed", "operation.input", "operation.torque"} <= needed


def test_tooth_thickness_stands_in_for_the_profile_shift(read):
    parts = planetary()
    for flank in (100 + SUN, 200 + SUN):
        parts.set(flank, addendum_modification_coefficient=None)
    reference = 24 * 2 / math.cos(math.radians(12))
    thickness = math.pi * reference / 24 / 2
    parts.set(SUN, reference_diameter_cylindrical_gear=mm(reference),
              transverse_tooth_thickness_at_reference_diameter=mm(thickness))  # fmt: skip
    case, usual = read(parts).case(ROUGH), read(planetary()).case(ROUGH)
    one, two = (meshes(item)[0].backlash for item in (case, usual))
    assert one == pytest.approx(two, abs=1e-12)  # x = 0 in both, fifteen digits


def test_root_and_tip_rounding_come_from_a_rack_shaped_tool(read):
    parts = planetary()
    parts.set(SUN, root_diameter=None)
    parts.add(
        300, "rack_shaped_tool", "hob",
        addendum_coefficient_reference_profile=no_unit(1.4),
        tip_corner_radius_factor_reference_profile=no_unit(0.25),
    )  # fmt: skip
    parts.relate("ordered_reference", 1, origin=SUN, referenced=300)
    sun = read(parts).case(ROUGH).sun
    reference = 24 * 2e-3 / math.cos(math.radians(12))
    assert sun.root_diameter == pytest.approx(reference - 2 * 1.4 * 2e-3)
    assert sun.tool_tip_radius == pytest.approx(0.5e-3)


def test_tip_diameter_comes_from_the_basic_profile(read):
    parts = planetary()
    for gear, factor in ((SUN, 1.1), (RING, 0.9)):
        parts.set(gear, tip_diameter=None)
        for flank in (100, 200):
            parts.set(flank + gear, addendum_coefficient_basic_profile=no_unit(factor))
    case = read(parts).case(ROUGH)
    module = 2e-3 / math.cos(math.radians(12))
    assert case.sun.tip_diameter == pytest.approx(24 * module + 2 * 1.1 * 2e-3)
    assert case.ring.tip_diameter == pytest.approx(60 * module - 2 * 0.9 * 2e-3)


def test_pressure_viscosity_by_the_parameters_of_agma_925(read):
    parts = planetary()
    name = "parameter_{}_for_calculation_of_pressure_viscosity_coefficient_agma_925_2003"
    parts.set(OIL, pressure_viscosity_coefficient_at_38_degrees_celsius=None)
    parts.set(OIL, **{name.format("k"): no_unit(0.010326), name.format("s"): no_unit(0.0507)})
    law = read(parts).case(ROUGH).lubricant.oil.pressure_viscosity
    nu = 100.0
    # alpha in mm^2/N of eta in mPa s; 1 mm^2/N = 1000/GPa
    assert law.s * nu**law.t == pytest.approx(1e3 * 0.010326 * (0.88 * nu) ** 0.0507, rel=1e-5)


@pytest.mark.parametrize("flanks", [2, 1])
def test_flank_modifications_are_taken_where_their_meaning_is_plain(read, flanks):
    """Not where only one flank of a gear has them."""
    parts = planetary()
    for side, number in ((100, 301), (200, 302))[:flanks]:
        parts.add(
            number, "tip_relief", tip_relief_depth=mm(0.02), tip_relief_datum_diameter=mm(51.0),
            shape_of_relief=no_unit("linear"),
        )  # fmt: skip
        parts.relate("reference", origin=side + SUN, referenced=number)
        parts.add(number + 10, "helix_slope", helix_slope=mm(0.01))
        parts.relate("reference", origin=side + SUN, referenced=number + 10)
    found = read(parts)
    relief, lacks = found.case(ROUGH).sun.micro_geometry, {lack.key for lack in found.missing}
    assert "sun.micro_geometry.lead_slope" in lacks
    assert ("sun.micro_geometry.tip_relief" in lacks) == (flanks == 1)
    if flanks == 2:
        assert relief.tip_relief == pytest.approx(20e-6)
        assert relief.tip_relief_diameter == pytest.approx(51e-3)


def test_carrier_is_as_wide_as_its_plates_stand(read):
    parts = planetary()
    parts.add(310, "planet_carrier", "carrier")
    parts.relate("assembly", assembly=STAGE, part=310)
    for number, place in ((311, 0.0), (312, 30.0)):
        parts.add(
            number, "side_plate", outer_diameter=mm(130.0), length=mm(8.0),
            support_vector=([place, 0.0, 0.0], "mm"),
        )  # fmt: skip
        parts.relate("assembly", assembly=310, part=number)
    carrier = read(parts, ".rexsj").case(ROUGH).carrier
    assert (carrier.outer_diameter, carrier.width) == pytest.approx((0.13, 0.038))


def test_arrays_in_base64_are_read(read, tmp_path):
    parts = planetary()
    places = {20: (1.0, 42.94, 0.0), 21: (1.0, 0.0, 42.94), 22: (1.0, -42.94, 0.0)}
    for shaft, place in {SUN_SHAFT: (0.0, 0.0, 0.0), **places}.items():
        text = base64.b64encode(struct.pack("<3d", *place)).decode()
        parts.set(shaft, support_vector=(text, "mm"))
    xml = parts.xml()
    for line in xml.splitlines():
        if "support_vector" in line:
            start, _, end = line.partition('">')
            value, _, _ = end.partition("<")
            coded = f'{start}"><array code="float64">{value}</array></attribute>'
            xml = xml.replace(line, coded.replace('unit="mm"">', 'unit="mm">'))
    file = tmp_path / "coded.rexs"
    file.write_text(xml, encoding="utf-8")
    angles = [float(text.split()[0]) for text in ep.read_rexs(file).tables["planet"]["angles"]]
    assert angles == pytest.approx([0.0, 90.0, 180.0])


def test_one_of_several_stages_is_chosen_by_its_id(read):
    parts = pair()
    parts.add(400, "cylindrical_stage", "another", center_distance=mm(61.4))
    parts.relate("stage", stage=400, gear_1=SUN, gear_2=RING)
    assert read(parts).kind == "train"
    assert read(parts, component=400).component == 'cylindrical_stage 400 "another"'
    with pytest.raises(ep.InputError, match="is neither"):
        read(parts, component=SUN)


def test_sets_that_are_not_covered_are_told(read):
    parts = planetary()
    parts.relations = [
        relation for relation in parts.relations if relation[1].get("stage") not in (50, 60)
    ]
    with pytest.raises(ep.InputError, match="3 planets, 1 rings and 4 meshes"):
        read(parts)


def test_file_without_a_temperature_says_so(read):
    parts = planetary()
    parts.set(CASING, temperature_lubricant=None)
    found = read(parts)
    assert "temperature_lubricant" in str(
        next(lack for lack in found.missing if lack.key == "operation.oil_inlet_temperature")
    )


def test_concept_bearing_leaves_the_bearing_out(read):
    parts = planetary()
    for number in PLANETS:
        parts.components[70 + number] = {
            "type": "concept_bearing", "name": "", "attributes": {},
        }  # fmt: skip
    found = read(parts)
    lack = next(lack for lack in found.missing if lack.key == "planet_bearing")
    assert not lack.needed
    assert found.case().planet_bearing is None


def test_ball_bearings_are_left_out(read):
    parts = planetary()
    for number in PLANETS:
        parts.set(70 + number, bearing_type=no_unit("radial_grooved_ball_bearing"))
    found = read(parts)
    lack = next(lack for lack in found.missing if lack.key == "planet_bearing")
    assert 'bearing 0" is not one' in lack.attribute
    assert found.case().planet_bearing is None


def test_load_case_takes_rexs_files_and_changes(tmp_path):
    file = planetary().write(tmp_path / "gears.rexs")
    case = ep.load_case(file, {**ROUGH, "operation.torque": "50 N*m"})
    assert case.operation.torque == 50.0
    assert case.source == str(file)
    talbot = ep.load_case("talbot-2012", {"operation.torque": "500 N*m"})
    assert talbot.operation.torque == 500.0
