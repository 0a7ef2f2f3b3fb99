"""Default tips are shortened so that profile shifts take no tip clearance."""

import pytest

from epicyclic import load_case
from epicyclic.study.data_sheet import data_sheets
from listed_trains import double_planet, stepped

PAIR = {
    "kind": "gear_pair",
    "operation": {"torque": "50 N*m", "speed": "1000 rpm", "oil_inlet_temperature": "60 degC"},
    "gears": {"normal_module": "3 mm", "normal_pressure_angle": "20 deg", "helix_angle": "0 deg"},
    "pinion": {
        "teeth": 12,
        "face_width": "30 mm",
        "profile_shift_coefficient": 0.6,
        "roughness": "0.4 um",
    },
    "gear": {
        "teeth": 24,
        "face_width": "29 mm",
        "profile_shift_coefficient": 0.36,
        "roughness": "0.5 um",
    },
    "lubricant": {"oil": "atf-dexron-vi"},
}


def mesh_of(changes=None):
    return load_case(PAIR, changes or {}).gearings[""].geometries[0]


def test_the_default_tip_keeps_the_clearance_of_the_rack():
    mesh = mesh_of()
    assert 2e3 * mesh.gear1.tip_radius == pytest.approx(44.840, abs=5e-4)
    assert mesh.transverse_contact_ratio == pytest.approx(1.202, abs=5e-4)
    assert mesh.tip_clearances == pytest.approx([0.25 * 3e-3] * 2, abs=1e-12)
    pinion, _ = data_sheets(load_case(PAIR))[""].gears
    assert pinion.tip_alteration == pytest.approx(-0.3801e-3, abs=1e-7)


def test_a_key_brings_the_former_tips():
    mesh = mesh_of({"gears.tip_alteration": "none"})
    assert mesh.gear1.tip_radius == pytest.approx(18e-3 + 3e-3 * 1.6)
    assert mesh.tip_clearances == pytest.approx([0.3699e-3] * 2, abs=1e-7)


def test_what_backlash_leaves_is_not_taken_twice():
    # the clearance that a larger centre distance brings needs no shortening
    near, far = mesh_of(), mesh_of({"gears.center_distance": "56.62 mm"})
    longer = far.gear2.tip_radius - near.gear2.tip_radius
    assert longer == pytest.approx(56.62e-3 - near.center_distance)
    assert far.tip_clearances == pytest.approx([0.75e-3] * 2, abs=1e-12)


def test_allowances_do_not_change_the_tip():
    thinner = mesh_of({"pinion.tooth_thickness_allowance": ["-60 um", "-100 um"]})
    assert thinner.gear1.tip_radius == pytest.approx(mesh_of().gear1.tip_radius, rel=1e-12)


def test_a_stated_tip_stays_and_its_mate_is_shortened():
    mesh = mesh_of({"pinion.tip_diameter": "45.1 mm"})
    assert mesh.gear1.tip_radius == pytest.approx(22.55e-3)
    assert mesh.gear2.tip_radius == pytest.approx(mesh_of().gear2.tip_radius, rel=1e-12)


def shortenings(case):
    """Of each gear, by its default tip without alteration. [mm]"""
    found = {}
    key = "sets.S.gears.tip_alteration" if case["kind"] == "train" else "gears.tip_alteration"
    now, former = load_case(case), load_case(case, {key: "none"})
    for one, other in zip(now.gearings.values(), former.gearings.values(), strict=True):
        for name in one.tables:
            found[name] = 1e3 * (other.gear(name).tip_radius - one.gear(name).tip_radius)
    return found


def test_planets_take_what_sun_and_ring_need():
    case = {
        "kind": "planetary",
        "operation": {
            "input": "sun",
            "fixed": "ring",
            "torque": "150 N*m",
            "speed": "1500 rpm",
            "oil_inlet_temperature": "80 degC",
        },
        "gears": PAIR["gears"] | {"helix_angle": "11 deg"},
        "sun": PAIR["pinion"] | {"teeth": 19},
        "planet": PAIR["gear"] | {"teeth": 25, "count": 4},
        "ring": {"teeth": 69, "face_width": "28 mm", "roughness": "0.8 um"},
        "lubricant": PAIR["lubricant"],
    }
    found = shortenings(case)
    sun_mesh, ring_mesh = load_case(case).gearings[""].geometries
    assert found["sun"] == found["planet"] == pytest.approx(0.317, abs=5e-4)
    assert sun_mesh.tip_clearances == pytest.approx([0.75e-3] * 2, abs=1e-12)
    # internal: the clearance of the rack and more, the ring as it was
    assert found["ring"] == 0
    assert min(ring_mesh.tip_clearances) > 0.75e-3


def test_steps_of_a_planet_are_shortened_by_their_own_meshes():
    case = stepped()
    gears = case["sets"]["S"]["gears"]
    gears["sun"]["profile_shift_coefficient"] = 0.5
    gears["wide"]["profile_shift_coefficient"] = 0.2
    case["sets"]["S"]["mesh"]["sun-wide"]["center_distance"] = "53.47 mm"
    del gears["ring"]["profile_shift_coefficient"]
    gears["narrow"]["profile_shift_coefficient"] = 0.31
    found = shortenings(case)
    assert found["sun"] == found["wide"] == pytest.approx(0.0393, abs=5e-5)
    assert found["narrow"] == found["ring"] == 0


def test_a_gear_between_two_others_takes_the_larger_shortening():
    case = double_planet()
    case["sets"]["S"]["gears"]["sun"]["profile_shift_coefficient"] = 0.4
    case["sets"]["S"]["gears"]["inner"]["profile_shift_coefficient"] = 0.5
    case["sets"]["S"]["gears"]["outer"]["profile_shift_coefficient"] = 0.15
    case["sets"]["S"]["gears"]["ring"].pop("profile_shift_coefficient")
    case["sets"]["S"]["mesh"] = {
        "sun-inner": {"center_distance": "49.72 mm"},
        "outer-inner": {"center_distance": "36.2 mm"},
        "outer-ring": {"center_distance": "61 mm"},
    }
    found = shortenings(case)
    assert found["sun"] > 0
    assert found["outer"] > 0
    assert found["sun"] != found["outer"]
    assert found["inner"] == max(found["sun"], found["outer"])
