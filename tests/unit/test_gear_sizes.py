"""Centre distances and profile shifts that a case leaves out; teeth that do not fit."""

import math

import pytest

from epicyclic import load_case, solve
from epicyclic.gears.gear import BasicRack
from epicyclic.gears.mesh import closed_center_distance, profile_shift_sum, recommended_backlash
from epicyclic.gears.rules import tooth_notes
from epicyclic.units import MILLIMETRE
from problems import only, problems_of

X = "profile_shift_coefficient"
SET = {
    "kind": "planetary",
    "operation": {
        "input": "sun",
        "fixed": "ring",
        "torque": "150 N*m",
        "speed": "15000 rpm",
        "oil_inlet_temperature": "80 degC",
    },
    "gears": {
        "normal_module": "1.25 mm",
        "normal_pressure_angle": "20 deg",
        "helix_angle": "19 deg",
        "center_distance": "38.7 mm",
    },
    "sun": {"teeth": 31, "face_width": "26 mm", X: 0.26, "roughness": "0.3 um"},
    "planet": {"teeth": 27, "count": 4, "face_width": "25 mm", X: 0.02, "roughness": "0.4 um"},
    "ring": {"teeth": 85, "face_width": "24 mm", X: -0.42, "roughness": "0.8 um"},
    "lubricant": {"oil": "atf-dexron-vi"},
}


def changed(**tables):
    """The set with some keys changed; None leaves one out."""
    case = {key: dict(value) if isinstance(value, dict) else value for key, value in SET.items()}
    for name, keys in tables.items():
        case.setdefault(name, {})
        case[name] |= keys
        case[name] = {key: value for key, value in case[name].items() if value is not None}
    return case


def meshes(case):
    return case.gearings[""].geometries


def test_published_sums_of_profile_shifts():
    # a calculation after ISO 21771:2007, Eq. 62 and 63: m_n 3.5 mm, alpha_n 20, alpha_t
    # 21.2990642859, z 31 and 30, a 116.5 mm, j_n 0.03 mm (scribd 376176518)
    transverse = math.radians(21.2990642859)
    beta = math.acos(math.tan(math.radians(20)) / math.tan(transverse))
    rack = BasicRack(3.5e-3 / math.cos(beta), transverse, beta)
    assert profile_shift_sum(rack, 61, 116.5e-3) == pytest.approx(0.651877131252, abs=1e-8)
    assert profile_shift_sum(rack, 61, 116.5e-3, 30e-6) == pytest.approx(0.639346541, abs=1e-8)


def test_a_published_planetary_set():
    # University of Ljubljana, LECAD, program pg: m 1.75 mm, z 21, 43 and -108, d_ring -189 mm,
    # a 56.8 mm, x 0.4380, 0.0426 and 0.0000
    rack = BasicRack(1.75e-3, math.radians(20), 0.0)
    assert profile_shift_sum(rack, 21 + 43, 56.8e-3) == pytest.approx(0.4380 + 0.0426, abs=1e-4)
    ring_mesh = profile_shift_sum(rack, 43 - 108, 56.8e-3)
    assert ring_mesh == pytest.approx(0.0426 + 0.0000, abs=5e-4)
    assert closed_center_distance(rack, 43 - 108, 0.0426) == pytest.approx(56.8e-3, abs=1e-6)


@pytest.mark.parametrize(
    ("left_out", "kept"),
    [
        (("sun",), ("ring_mesh",)),
        (("ring",), ("sun_mesh",)),
        (("sun", "ring"), ()),
        (("planet", "ring"), ()),
        (("sun", "planet"), ()),
    ],
)
def test_profile_shifts_that_are_left_out_close_their_meshes(left_out, kept):
    case = load_case(changed(**{name: {X: None} for name in left_out}))
    sun_mesh, ring_mesh = meshes(case)
    usual = meshes(load_case(changed()))
    for name, mesh, then in zip(
        ("sun_mesh", "ring_mesh"), (sun_mesh, ring_mesh), usual, strict=True
    ):
        expected = then.backlash if name in kept else 0.0
        assert mesh.backlash == pytest.approx(expected, abs=1e-12)
    assert {one.key for one in case.found} == {f"{name}.{X}" for name in left_out}


def test_a_planet_takes_the_thinner_of_both_meshes():
    case = load_case(changed(planet={X: None}))
    backlashes = [mesh.backlash for mesh in meshes(case)]
    assert min(backlashes) == pytest.approx(0.0, abs=1e-12)
    assert max(backlashes) > 1e-6


def test_the_stated_backlash_is_left():
    case = load_case(
        changed(
            sun={X: None},
            ring={X: None},
            sun_mesh={"normal_backlash": "61 um"},
            ring_mesh={"normal_backlash": "83 um"},
        )
    )
    sun_mesh, ring_mesh = meshes(case)
    assert sun_mesh.normal_backlash == pytest.approx(61e-6, rel=1e-9)
    assert ring_mesh.normal_backlash == pytest.approx(83e-6, rel=1e-9)


def test_the_centre_distance_follows_from_profile_shifts():
    case = load_case(changed(gears={"center_distance": None}))
    assert meshes(case)[0].backlash == pytest.approx(0.0, abs=1e-12)
    assert case.found[0].key == "gears.center_distance"
    without_sun = load_case(changed(gears={"center_distance": None}, sun={X: None}))
    assert meshes(without_sun)[1].backlash == pytest.approx(0.0, abs=1e-12)
    assert without_sun.gears.center_distance != case.gears.center_distance


def test_what_is_found_reads_again_as_the_same_case():
    case = load_case(changed(sun={X: None}, sun_mesh={"normal_backlash": "61 um"}))
    again = load_case(case.inputs())
    assert again == case
    assert again.found == ()
    assert X not in case.given()["sun"]
    assert case.updated({"planet.teeth": 26, "ring.profile_shift_coefficient": 0.1}).sun != case.sun


@pytest.mark.parametrize(
    ("tables", "key", "words"),
    [
        (
            {"gears": {"center_distance": None}, "planet": {X: None}},
            "gears.center_distance",
            "cannot be computed from a mesh",
        ),
        (
            {"sun": {X: None}, "planet": {X: None}, "ring": {X: None}},
            f"sun.{X}, planet.{X}, ring.{X}",
            "is missing",
        ),
        ({"sun": {X: None}, "gears": {"center_distance": "45 mm"}}, f"sun.{X}", "would have to be"),
        ({"sun_mesh": {"normal_backlash": "80 um"}}, "sun_mesh.normal_backlash", "contradicts"),
        (
            {"sun": {X: None}, "gears": {"center_distance": "30 mm"}},
            "gears.center_distance",
            "exceed",
        ),
        (
            {"gears": {"center_distance": None}, "sun": {X: -3.0}, "planet": {X: -3.0}},
            f"sun.{X}, planet.{X}",
            "too thin for any",
        ),
    ],
)
def test_what_cannot_be_found(tables, key, words):
    found = {problem.key: problem for problem in problems_of(load_case, changed(**tables))}
    assert words in found[key].allowed


def test_a_mistake_elsewhere_hides_no_left_out_key_and_adds_none():
    problem = only(problems_of(load_case, changed(sun={X: None}, ring={"teeth": "many"})))
    assert problem.key == "ring.teeth"


def test_disagreement_below_the_printed_digits_is_adjusted_and_told():
    closed = load_case(changed(sun={X: None})).sun.profile_shift_coefficient
    printed = math.ceil(closed * 1e4) / 1e4
    case = load_case(changed(sun={X: printed}))
    assert case.sun.profile_shift_coefficient == pytest.approx(closed, abs=1e-12)
    (told,) = case.found
    assert "nm too thick" in told.how
    assert any("nm too thick" in note for note in solve(case).warnings)
    assert problems_of(load_case, changed(sun={X: printed + 2e-3}))  # more than a digit


def test_too_thick_teeth_are_told_with_what_fits():
    problems = problems_of(load_case, changed(sun={X: 0.35}))
    (problem,) = [one for one in problems if "too thick" in one.allowed]
    needed = problem.remedy.split("Zero backlash needs ")[1].split(", or ")[0]
    proposed = dict(part.split(" = ") for part in needed.split(" or "))
    for key, value in proposed.items():
        fitted = changed(sun={X: 0.35})
        table, name = key.split(".")
        fitted[table] |= {name: float(value)}
        case = load_case(fitted)
        assert 0 <= meshes(case)[0].normal_backlash < 0.2e-6
    distance = problem.remedy.split('gears.center_distance = "')[1].split('"')[0]
    mesh = meshes(
        load_case(changed(sun={X: 0.35}, gears={"center_distance": distance}, ring={X: None}))
    )[0]
    assert 0 <= mesh.normal_backlash < 1e-6


def test_the_other_sign_of_a_ring_is_proposed_where_it_fits():
    problems = problems_of(load_case, changed(ring={X: 0.42}))
    (problem,) = [one for one in problems if "too thick" in one.allowed]
    assert "With the other sign, -0.42" in problem.remedy
    assert len(str(problem)) < 600
    tight = problems_of(load_case, changed(ring={X: -0.30}))
    assert all("other sign" not in one.remedy for one in tight)


def test_gross_backlash_is_warned_of_and_usual_backlash_is_not():
    assert list(tooth_notes(load_case(changed()).gearings[""])) == []
    sun_mesh, ring_mesh = tooth_notes(load_case(changed(planet={"teeth": 26})).gearings[""])
    assert "sun mesh has a normal backlash" in sun_mesh
    proposed = float(ring_mesh.split(f"ring.{X} = ")[1].split(" has")[0].split(" it")[0])
    case = load_case(changed(planet={"teeth": 26}, ring={X: proposed}))
    mesh = meshes(case)[1]
    usual = recommended_backlash(mesh.gear1.rack, mesh.center_distance)
    assert mesh.normal_backlash == pytest.approx(usual, abs=0.2e-6)
    assert usual == pytest.approx(
        2 / 3 * (0.06e-3 + 0.0005 * MILLIMETRE.parse("38.7 mm") + 0.0375e-3)
    )


def test_a_gear_far_wider_than_its_mates_is_named():
    widths = [31.0, 23.0, 23.0]
    for sun, meshes_named in ((45.9, 0), (46.1, 1)):
        widths[0] = sun
        gears = zip(("sun", "planet", "ring"), widths, strict=True)
        wide = changed(**{name: {"face_width": f"{width} mm"} for name, width in gears})
        found = list(tooth_notes(load_case(wide).gearings[""]))
        assert len(found) == meshes_named
    assert found == [
        "The face widths of the sun mesh are 46.1 mm and 23 mm; only the latter carries load."
    ]


def test_sets_of_trains_find_theirs_too():
    train = {
        "kind": "train",
        "operation": {
            key: SET["operation"][key] for key in ("torque", "speed", "oil_inlet_temperature")
        }
        | {"input": "front.sun", "output": "front.carrier"},
        "sets": {
            "front": {
                key: changed(sun={X: None})[key] for key in ("gears", "sun", "planet", "ring")
            }
        },
        "shafts": {"housing": ["front.ring"]},
        "lubricant": SET["lubricant"],
    }
    case = load_case(train)
    assert [one.key for one in case.found] == [f"sets.front.sun.{X}"]
    assert case.sets["front"].sun == load_case(changed(sun={X: None})).sun


def test_a_ring_of_negative_teeth_is_the_same_ring():
    usual = load_case(changed(ring={"tip_diameter": "112.9 mm"}))
    signed = load_case(changed(ring={"teeth": -85, "tip_diameter": "-112.9 mm"}))
    assert signed == usual
    (told,) = signed.found
    assert (told.key, told.value) == ("ring.teeth", "85")
    assert "ISO 21771" in told.how
    assert signed.given()["ring"]["teeth"] == -85
    assert usual.found == ()


def test_a_published_ring_as_din_3960_has_it():
    # University of Ljubljana, LECAD, program pg: d -189.0000 mm, d_a -185.4992 mm, and with the
    # planet's x of 0.0426 no backlash at a 56.8 mm, where x of the ring is 0.0000
    gears = SET["gears"] | {"normal_module": "1.75 mm", "helix_angle": "0 deg"}
    ring = {"teeth": -108, X: None, "tip_diameter": "-185.4992 mm", "face_width": "41.5 mm"}
    tables = {
        "kind": "gear_pair",
        "operation": {"torque": "9 N*m", "speed": "700 rpm", "oil_inlet_temperature": "60 degC"},
        "gears": gears | {"center_distance": "56.8 mm"},
        "pinion": SET["planet"] | {"teeth": 43, X: 0.0426, "tip_diameter": "78.8170 mm"},
        "gear": SET["ring"] | ring,
        "lubricant": SET["lubricant"],
    }
    del tables["pinion"]["count"], tables["gear"][X]
    case = load_case(tables)
    assert case.gear.internal
    assert case.gear.tip_diameter == pytest.approx(185.4992e-3)
    assert case.gear.profile_shift_coefficient == pytest.approx(0.0, abs=5e-4)
    assert {one.key for one in case.found} == {"gear.teeth", f"gear.{X}"}


@pytest.mark.parametrize(
    ("table", "teeth"), [("sun", -31), ("planet", -27), ("ring", -4), ("ring", True)]
)
def test_only_rings_may_have_negative_teeth(table, teeth):
    problem = only(problems_of(load_case, changed(**{table: {"teeth": teeth}})))
    assert problem.key == f"{table}.teeth"


def test_rings_of_trains_may_have_negative_teeth():
    sets = {
        "given": {"sun": {"teeth": 30}, "ring": {"teeth": -72}, "efficiency": 0.98},
        "pair": {"pinion": {"teeth": 19}, "gear": {"teeth": -61}, "efficiency": 0.97},
        "listed": {
            "gears": {"small": {"teeth": 21}, "large": {"teeth": -67}},
            "meshes": [["small", "large"]],
            "mesh_efficiency": 0.99,
        },
    }
    for name, table in sets.items():
        member, other = {"given": ("sun", "carrier"), "pair": ("pinion", "gear")}.get(
            name, ("small", "large")
        )
        case = load_case(
            {
                "kind": "train",
                "operation": {
                    "input": f"{name}.{member}",
                    "output": f"{name}.{other}",
                    "torque": "10 N*m",
                    "speed": "100 rpm",
                },
                "sets": {name: table},
                "shafts": {"housing": ["given.ring"]} if name == "given" else {},
            }
        )
        positive = case.inputs()["sets"][name]
        assert "-" not in str([one["teeth"] for one in _gears(positive)])
        assert case.found[0].key.startswith(f"sets.{name}.")
        assert solve(case).train.ratio > 0  # internal meshes do not reverse


def _gears(table):
    return [
        one
        for one in (table.get("gears", table)).values()
        if isinstance(one, dict) and "teeth" in one
    ]
