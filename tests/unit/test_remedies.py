"""A number that a remedy states is the one that helps: applied, its check passes."""

import random
import re

import pytest

from epicyclic import InputError, load_case
from frozen.broken_cases import bases

PROPOSED = (
    re.compile(r'(?P<key>[\w.]+) = (?P<value>"[^"]+"|-?\d[\d.]*\d|\d)(?= |,|;|\.)'),
    re.compile(r"Make (?P<key>[\w.]+) at (?:most|least) (?P<value>[\d.]+ mm)"),
)
SETS = {  # where the gears of a case stand, and their names
    "asymmetric planetary": ("", ("sun", "planet", "ring")),
    "asymmetric pair": ("", ("pinion", "gear")),
    "small set": ("", ("sun", "planet", "ring")),
    "train-eaxle": ("sets.planets.", ("sun", "planet", "ring")),
    "listed stepped": ("sets.S.gears.", ("sun", "wide", "narrow", "ring")),
    "listed double_planet": ("sets.S.gears.", ("sun", "inner", "outer", "ring")),
}
BASES = bases()


def problems(tables, changes):
    try:
        load_case(tables, changes)
    except InputError as error:
        return error.problems
    return ()


def breaks(draw, name):
    """One or two dimensions of gears that are up to three modules off."""
    prefix, gears = SETS[name]
    gearing = load_case(BASES[name]).gearings[prefix.split(".")[1] if prefix else ""]
    for gear in draw.sample(gears, draw.choice((1, 2))):
        key, made = f"{prefix}{gear}.", gearing.gear(gear)
        off = draw.uniform(-3, 3) * made.rack.normal_module
        which = draw.choice(("tip", "root", "shift"))
        if which == "shift":
            yield f"{key}profile_shift_coefficient", round(draw.uniform(-0.8, 0.9), 3)
            yield f"{key}tooth_thickness", None
            yield f"{key}thickness_diameter", None
        else:
            radius = made.tip_radius if which == "tip" else made.root_radius
            yield f"{key}{which}_diameter", f"{1e3 * (2 * radius + off):.3f} mm"


def kind(problem):
    """The check that it comes from."""
    return problem.key, re.sub(r"[\d.]+", "#", problem.allowed)


def proposals(name, problem):
    """Keys and values that a remedy states, one after the other."""
    prefix = SETS[name][0].removesuffix("gears.")
    for pattern in PROPOSED:
        for match in pattern.finditer(problem.remedy):
            key, value = match["key"], match["value"]
            number = float(value) if re.fullmatch(r"-?[\d.]+", value) else value.strip('"')
            yield (key if key.startswith(prefix) else prefix + key), number


@pytest.mark.parametrize(
    "seed", [pytest.param(seed, marks=pytest.mark.slow if seed else ()) for seed in range(12)]
)
def test_what_a_remedy_states_helps(seed):
    draw, tried = random.Random(seed), 0
    for name in SETS:
        for _ in range(3):
            changes = dict(breaks(draw, name))
            for problem in problems(BASES[name], changes):
                limit = problem.remedy.startswith("Make ")
                for key, value in proposals(name, problem):
                    tried += 1
                    for left in problems(BASES[name], changes | {key: value}):
                        assert kind(left) != kind(problem), (changes, key, value)
                        # the limit is that of all meshes and checks of the gear
                        again = left.key == problem.key and left.remedy.startswith("Make ")
                        assert not (limit and again), (changes, key, value, left)
    assert tried


def both(tables, *changes):
    """Keys of the problems of each change, and of all at once."""
    alone = [{it.key for it in problems(tables, change)} for change in changes]
    at_once = {it.key for it in problems(tables, {k: v for it in changes for k, v in it.items()})}
    return alone, at_once


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        (
            "train-eaxle",
            (
                {"sets.pair.pinion.tip_diameter": "40 mm"},
                {"sets.planets.planet_bearing.rollers_per_row": 80},
                {"sets.planets.carrier.open_width": "200 mm"},
                {"bearings.motor_rear.outside_diameter": "10 mm"},
                {'positions."pair.gear"': None},
                {"operation.output": "nowhere"},
            ),
        ),
        (
            "train-eaxle",  # a table that is not valid hides no bearing
            (
                {"sets.planets.sun.face_width": "3 s"},
                {"bearings.motor_rear.outside_diameter": "10 mm"},
            ),
        ),
        (
            "asymmetric planetary",
            (
                {"sun.tip_diameter": "40 mm"},
                {"planet.count": 17},
                {"planet_bearing.rollers_per_row": 80},
                {"ring.rim_thickness": "1 um"},
                {"operation.fixed": "sun", "operation.input": "sun"},
                {"sun_mesh.normal_backlash": "0.9 mm"},
            ),
        ),
        (
            "listed double_planet",
            (
                {"sets.S.gears.transverse_module": None},
                {"sets.S.planet_bearing.rollers_per_row": 80},
                {"operation.output": "nowhere"},
            ),
        ),
    ],
)
def test_one_mistake_hides_no_other(name, changes):
    alone, at_once = both(BASES[name], *changes)
    assert all(alone)
    for keys in alone:
        assert keys <= at_once


@pytest.mark.parametrize(
    ("planet", "key", "advice"),
    [
        ({"teeth": 37}, "planet.teeth", "Correct it, or leave it out."),
        ({"teeth": 31, "count": 7}, "planet.count", "Use at most 6"),
    ],
)
def test_sets_of_given_efficiency_are_assembled_too(planet, key, advice):
    train = {
        "kind": "train",
        "sets": {"S": {"sun": {"teeth": 41}, "ring": {"teeth": 104}, "efficiency": 0.97}},
        "shafts": {"housing": ["S.ring"]},
        "operation": {
            "input": "S.sun",
            "output": "S.carrier",
            "torque": "7 N*m",
            "speed": "90 rpm",
        },
    }
    assert not problems(train, {})
    train["sets"]["S"]["planet"] = planet
    (problem,) = problems(train, {})
    assert problem.key == f"sets.S.{key}"
    assert problem.remedy.startswith(advice)


@pytest.mark.parametrize("pressure", ["0.7 bar", "0.01 bar", "3 Pa"])
def test_the_pressure_of_voids_that_a_remedy_names_is_taken(pressure):
    changes = {"surroundings.pressure": pressure, "models.pocket_void_pressure": "0.9 bar"}
    with pytest.raises(InputError) as caught:
        load_case("talbot-2012-pair", changes)
    (problem,) = caught.value.problems
    taken = re.fullmatch(r"Take (.+)\.", problem.remedy)[1]
    assert load_case("talbot-2012-pair", changes | {problem.key: taken})


@pytest.mark.parametrize(
    ("value", "remedy"),
    [("-31", "Increase it to 5"), ("2", "Increase it to 5"), ("7000", "Reduce it to 2000"),
     ("37", "Write 37, without quotes."), ("37.0", "Write 37."), ("37.5", "Round it."),
     (float("nan"), "Give a finite number."), (1e300, "Reduce it to 2000"), (0.5, "Increase")],
)  # fmt: skip
def test_a_number_in_quotes_that_would_not_do_is_not_proposed(value, remedy):
    (problem,) = problems("talbot-2012-pair", {"gear.teeth": value})
    assert problem.remedy.startswith(remedy)


@pytest.mark.parametrize(
    ("case", "key", "value", "remedy"),
    [
        ("talbot-2012-pair", "gears.helix_angle", "-13.1 deg", 'Write "13.1 deg"; in trains hand'),
        ("train-8hp70", "sets.P1.efficiency", 97, "Write 0.97 for 97 %."),
        ("train-8hp70", "sets.P1.efficiency", 1.2, "Reduce it to 1 or less."),
        ("talbot-2012-pair", "hand", "left", "The keys are"),
    ],
)
def test_a_value_that_fits_and_means_the_same_is_proposed(case, key, value, remedy):
    (problem,) = problems(case, {key: value})
    assert problem.remedy.startswith(remedy)


@pytest.mark.parametrize("grade", ["ISO VG 220", "VG 220", "iso_vg_220"])
def test_a_grade_names_every_kind_of_oil(grade):
    (problem,) = problems("talbot-2012-pair", {"lubricant.oil": grade})
    assert problem.remedy == "Did you mean 'iso-vg-220-mineral' or 'iso-vg-220-pao'?"
