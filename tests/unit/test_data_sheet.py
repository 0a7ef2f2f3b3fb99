"""What `check` shows of a sound case."""

import io

import pytest
from rich.console import Console
from test_gear_sizes import X, changed
from test_tooth_measures import RING, TABLES

from epicyclic import load_case
from epicyclic.show.data_sheet import data_sheet, reservations
from epicyclic.study.data_sheet import data_sheets


def shown(case, width=80):
    console = Console(width=width, file=io.StringIO())
    console.print(data_sheet(case))
    return console.file.getvalue()


def row(text, label):
    (line,) = [line.strip() for line in text.splitlines() if line.strip().startswith(label)]
    return line.removeprefix(label).split()


def test_a_printed_pair_is_shown_as_printed():
    # MESYS AG, online calculation of helical gears: module 1 mm, 20 teeth: d 20, d_b 18.7939,
    # d_a 22, d_f 17.5, s_n 1.5708, s_an 0.6949, balls of 1.7 mm 22.2941, span over 2 teeth 4.7083
    gears = TABLES["gears"] | {
        "normal_module": "1 mm",
        "helix_angle": "0 deg",
        "center_distance": "26.5 mm",
    }
    own = TABLES["pinion"] | {"teeth": 20, X: 0.0}
    case = load_case(
        TABLES | {"gears": gears, "pinion": own, "gear": TABLES["gear"] | {"teeth": 33, X: None}}
    )
    text = shown(case)
    printed = {
        "reference diameter d": "20.000",
        "base diameter d_b": "18.794",
        "tip diameter d_a": "22.000",
        "root diameter d_f": "17.500",
        "normal thickness s_n": "1.571",
        "tip thickness s_a": "0.695",
        "measuring ball D_M": "1.700",
        "dimension over balls M_d": "22.294",
    }
    for label, value in printed.items():
        assert row(text, label)[0] == value, label
    assert "gear.profile_shift_coefficient = 0.0000: computed from the mesh" in " ".join(
        text.split()
    )


def test_specific_sliding_is_that_of_the_speeds():
    for tables in (TABLES, TABLES | RING):
        (sheet,) = data_sheets(load_case(tables)).values()
        (found,) = sheet.meshes
        mesh, speed1 = found.mesh, 100.0
        speed2 = speed1 / mesh.ratio
        for member, place in ((1, mesh.path_start), (2, mesh.path_end)):
            rolling = (speed1 * place, speed2 * mesh.curvature2(place))
            own, other = rolling if member == 1 else rolling[::-1]
            expected = (own - other) / own
            assert found.specific_sliding[member - 1] == pytest.approx(expected, rel=1e-12)


def test_a_helical_ring_has_no_span_and_columns_line_up():
    text = shown(load_case(changed(ring={"roughness": "Rz 3 um"})))
    assert row(text, "span W_k")[2] == "-"
    assert row(text, "roughness Rq") == ["0.300", "0.400", "0.627", "µm"]
    lines = text.splitlines()
    start = next(k for k, line in enumerate(lines) if "teeth z" in line)
    table = lines[start : start + 15]
    ends = {line.index(" mm") for line in table if line.rstrip().endswith("mm")}
    assert len(ends) == 1
    assert "Rz = 6 Ra" in text


def test_every_computed_set_of_a_train_has_a_sheet():
    case = load_case("train-eaxle")
    sheets = data_sheets(case)
    assert sheets.keys() == case.sets.keys()
    assert [one.mesh.name for one in sheets["planets"].meshes] == ["sun mesh", "ring mesh"]
    assert "Gears, pair" in shown(case)
    listed = load_case("train-8hp70")
    assert data_sheets(listed) == {}  # all efficiencies are given


def test_too_little_backlash_and_clearance_are_points_to_check():
    case = load_case("talbot-2012-pair")
    texts = list(reservations(case))
    (mesh,) = data_sheets(case)[""].meshes
    assert len(texts) == 2
    assert f"{1e6 * mesh.mesh.normal_backlash:.1f} µm, less than the " in texts[0]
    assert "tip clearance of the pinion in the mesh is 0.000 mm" in texts[1]
    thinner = {"pinion.tooth_thickness": "3.08 mm", "gear.root_diameter": "45.4 mm"}
    assert not list(reservations(case.updated(thinner)))
    assert "clearance" in " ".join(reservations(case.updated({"gear.tooth_thickness": "3.07 mm"})))


def test_gears_that_do_not_belong_together_are_points_to_check():
    case = load_case("talbot-2012").updated({"ring.teeth": 120})
    spaced, shifted, *_ = reservations(case)
    assert spaced.startswith("3 planets cannot be equally spaced, because (73 + 120)/3 is not an ")
    assert shifted.startswith("The profile shift of the ring is -2.88: ")
    stated = case.updated({"planet.angles": ["0 deg", "119.3782 deg", "240.6218 deg"]})
    assert not [text for text in reservations(stated) if "spaced" in text]
