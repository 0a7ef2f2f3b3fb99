"""The published figures computed: one function for each kind of figure."""

from __future__ import annotations

import itertools
import math
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.build.machine import Built, build
from epicyclic.build.models import fluids_of
from epicyclic.case.case import Case, read_case
from epicyclic.contact.elastic_teeth import LoadedMesh
from epicyclic.contact.temperatures import (
    LUBRICATION_FACTORS,
    Solid,
    bulk_rise_of_loss,
    iso_mean_friction,
    roughness_factor,
)
from epicyclic.gears.mesh import Mesh
from epicyclic.kernels.line_contact import flash_temperature, hertz_half_width
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.friction import (
    pitch_point_pressure,
    pitch_point_radius,
    pitch_point_sum_speed,
    specific_load,
)
from epicyclic.losses.mesh import ohlendorf_closed_form, ohlendorf_loss_factor
from epicyclic.losses.planet_bearing import RollerBearing, roller_loads
from epicyclic.oil.oil import MixtureState
from epicyclic.result.result import Result
from epicyclic.study.solve import loaded_meshes, mesh_contacts, solve

# What other programs print, computed: one function for each kind of figure.
#
# Each takes plain values as `programs.toml` has them, among them the name of a case in the folder
# ``cases``, and returns a number in the unit stated there.

_GEOMETRY: dict[str, Callable[[Mesh], float]] = {
    "pressure_angle": lambda mesh: math.degrees(mesh.operating_pressure_angle),
    "path_of_contact": lambda mesh: 1e3 * (mesh.path_end - mesh.path_start),
    "contact_ratio": lambda mesh: mesh.transverse_contact_ratio,
}
_OF_CONTACT: dict[str, Callable[[MeshContact], float]] = {
    "loss_factor": lambda it: ohlendorf_loss_factor(it.mesh),  # By the integral. [1]
    # By the closed form, beyond its range as well. [1]
    "closed_loss_factor": lambda it: ohlendorf_closed_form(it.mesh),
    "pitch_pressure": lambda it: pitch_point_pressure(it) / 1e6,  # Of Hertz. [MPa]
    # Of the minimum film along the contact lines. [um]
    "smallest_film": lambda it: float(it.minimum_film.min()) * 1e6,
    "largest_film": lambda it: float(it.minimum_film.max()) * 1e6,
}
"""What follows from the contact of a mesh alone."""


@cache
def _case(name: str) -> Case:
    file = resources.files("epicyclic.validation").joinpath("cases", f"{name}.toml")
    return read_case(Path(str(file)))


@cache
def _contacts(case: str) -> Mapping[str, MeshContact]:
    return mesh_contacts(_case(case))


@cache
def _loaded(case: str) -> Mapping[str, LoadedMesh]:
    return loaded_meshes(_case(case))


@cache
def _solved(case: str, friction: str | float, load_distribution: str = "compliance") -> Result:
    """The case with a friction model, or with a coefficient of friction."""
    changes: dict[str, Any] = {"models.load_distribution": load_distribution}
    if isinstance(friction, str):
        changes["models.friction"] = friction
    else:
        changes |= {"models.friction": "constant", "models.constant_friction": friction}
    return solve(_case(case).updated(changes))


def _planets(case: str) -> int:
    return _case(case).gearings[""].count or 1


def local_loss_factor(case: str, mesh: str, load_distribution: str) -> float:
    """Sliding loss along the contact lines over power and constant friction. [1]"""
    friction = 0.05  # any: it cancels out
    loss = _solved(case, friction, load_distribution).losses[f"{mesh}_sliding"]
    return loss / (friction * _planets(case) * _contacts(case)[mesh].input_power)


def closed_loss(case: str, mesh: str, friction: float) -> float:
    """Loss of one mesh: power, friction, and loss factor by the closed form. [kW]"""
    contact = _contacts(case)[mesh]
    return friction * contact.input_power * ohlendorf_closed_form(contact.mesh) / 1e3


def local_loss(case: str, mesh: str, friction: float) -> float:
    """Loss of one mesh, along the contact lines. [kW]"""
    return _solved(case, friction).losses[f"{mesh}_sliding"] / _planets(case) / 1e3


def single_stiffness_of(mesh: LoadedMesh) -> float:
    """c': largest stiffness of a lone pair of teeth per face width. [N/(mm um)]"""
    alone = (mesh.pair_force > 0).sum(axis=1) == 1
    return float(mesh.secant_stiffness[alone].max()) / mesh.mesh.face_width / 1e9


def mesh_stiffness_of(mesh: LoadedMesh) -> float:
    """c_gamma: mean stiffness over the mesh period per face width. [N/(mm um)]"""
    return mesh.mean(mesh.secant_stiffness) / mesh.mesh.face_width / 1e9


# Each takes plain values as `published.toml` has them and returns a number in the unit stated
# there.

TEST_TORQUES = (250, 500, 750, 1000)  # Loaded tests: torque on the sun. [N m]
TEST_SPEEDS = (1000, 2000, 3000, 4000)  # Speeds of the sun. [rpm]
AS_IN_THE_SOURCE = {
    "models.preset": "talbot-2012",
    "models.mesh_loads": "without-losses",
    "models.pocketing": "talbot-2012",
    "planet.mass": "0 kg",
}
"""Its regressions and its flow through pockets; Talbot (2012), Eq. 3.7 and 3.8, p. 68: no losses,
no centrifugal force."""
BESIDE_THE_SET = {
    "thrust_bearing": {"mean_diameter": "72.5 mm", "between": "sun-carrier"},
    "seals": {
        lip: {"shaft": "sun", "diameter": "60 mm"} for lip in ("union_inside", "union_outside")
    },
    "uncertainty": {
        "thrust_bearing.mean_diameter": {"normal": "6 mm"},
        "seals.union_inside.diameter": {"normal": "5 mm"},
        "seals.union_outside.diameter": {"normal": "5 mm"},
    },
}
"""Thrust bearing (p. 138) and rotary union (p. 144) of the test article, of assumed sizes: 1000 N m
in a shaft that is hollow for the oil give 60 mm at 24 N/mm2; ISO 104 has the bearing 81112 for it,
and ISO 6194-1 the lips on both sides of the oil."""
KELVIN = 273.15  # 0 degC in kelvin.


def source_case() -> Case:
    """The set of the dissertation, computed as there."""
    return read_case("talbot-2012").updated(AS_IN_THE_SOURCE | BESIDE_THE_SET)


def planet_bearing(built: Built) -> RollerBearing:
    """The planet bearing of the set of the dissertation."""
    (planet,) = built.sets[""].planets
    assert planet.bearing is not None
    assert isinstance(planet.bearing.bearing, RollerBearing)
    return planet.bearing.bearing


class LoadedTest(NamedTuple):
    """What of a `Result` a test of the dissertation under load is about. [W]"""

    input_power: float
    load_dependent: float
    load_independent: float = math.nan


LoadedTests = Callable[[str, str, Iterable[int]], Sequence[LoadedTest | Result]]
"""Those at a temperature, with a finish and some numbers of planets, torques and speeds rising."""


def loaded_conditions(
    temperature: str, finish: str, planets: Iterable[int]
) -> list[dict[str, Any]]:
    """The keys of the case that the loaded tests change."""
    return [
        {
            "operation.oil_inlet_temperature": temperature,
            "operation.torque": f"{torque} N*m",
            "operation.speed": f"{speed} rpm",
            "planet.count": count,
            "planet.roughness": finish,
        }
        for count, torque, speed in itertools.product(planets, TEST_TORQUES, TEST_SPEEDS)
    ]


@cache
def _computed_test(*changes: tuple[str, Any]) -> Result:
    return solve(source_case().updated(dict(changes)))


def _computed_tests(temperature: str, finish: str, planets: Iterable[int]) -> list[Result]:
    conditions = loaded_conditions(temperature, finish, planets)
    return [_computed_test(*changes.items()) for changes in conditions]


WITHOUT_FLOW = {f"losses.{mesh}_pocketing.include": False for mesh in ("sun_mesh", "ring_mesh")}
"""Pockets have no part in the loss of a bearing, and take time."""


def helical(angle: float) -> dict[str, Any]:
    """The transverse geometry held, so that the torque gives the same radial force. Eq. 3.7."""
    gears = source_case().given()["gears"]
    module, pressure, helix = (
        float(str(gears[key]).split()[0])
        for key in ("normal_module", "normal_pressure_angle", "helix_angle")
    )
    cosine = math.cos(math.radians(helix))
    transverse = math.degrees(math.atan(math.tan(math.radians(pressure)) / cosine))
    return {
        "gears.normal_module": None,
        "gears.normal_pressure_angle": None,
        "gears.transverse_module": f"{module / cosine!r} mm",
        "gears.transverse_pressure_angle": f"{transverse!r} deg",
        "gears.helix_angle": f"{angle} deg",
    }


def planet_bearing_loss(
    temperature: str = "90 degC",
    composite_roughness: float = math.hypot(0.1, 0.1),  # [um]
    branch_torque: float = 333,  # [N m]
    speed: int = 4000,  # [rpm]
    helix_angle: float | None = None,  # [deg]
    **changes: Any,
) -> float:
    """Rolling loss of one planet bearing; other keys as in a case. [W]"""
    rough = f"{composite_roughness / math.sqrt(2)} um"
    case = read_case("talbot-2012").updated({  # without what turns beside the set
        **AS_IN_THE_SOURCE,
        "operation.torque": f"{3 * branch_torque} N*m",
        "operation.speed": f"{speed} rpm",
        "operation.oil_inlet_temperature": temperature,
        "planet_bearing.roller_roughness": rough,
        "planet_bearing.race_roughness": rough,
        **WITHOUT_FLOW,
        **({} if helix_angle is None else helical(helix_angle)),
        **changes,
    })  # fmt: skip
    result = solve(case)
    return result.losses["planet_bearing_mechanical"] / len(result.planet_shares)


def planet_bearing_ratio(before: dict[str, Any], after: dict[str, Any]) -> float:
    """Loss of a planet bearing with some of its conditions over that with others. [1]"""
    return planet_bearing_loss(**after) / planet_bearing_loss(**before)


def planet_bearing_change(
    before: dict[str, Any], after: dict[str, Any], extreme: str = ""
) -> float:
    """Change of the loss of a planet bearing, or the extreme of it over the speeds. [%]"""
    changes = [
        100 * (planet_bearing_ratio({**before, **own}, {**after, **own}) - 1)
        for own in ([{"speed": speed} for speed in TEST_SPEEDS] if extreme else [{}])
    ]
    return min(changes) if extreme == "smallest" else max(changes)


def azimuth_of_gained_rollers(low: int, high: int, couple: bool) -> float:
    """Smallest azimuth of a roller that carries load at the branch torque `high`, not at `low`.

    Torques in N m. With `couple` false the tilting couple of the helical meshes is left out. [deg]
    """
    gained = _loaded_rollers(high, couple) & ~_loaded_rollers(low, couple)
    azimuth = np.arange(gained.size) * 360 / gained.size
    return float(np.minimum(azimuth, 360 - azimuth)[gained].min())


def _loaded_rollers(branch_torque: int, couple: bool) -> BoolArray:
    """Which rollers carry load in either row."""
    built = build(source_case().updated({"operation.torque": f"{3 * branch_torque} N*m"}))
    load = built.planet_loads()["planet_bearing"]
    moments = (load.moment_x, load.moment_y) if couple else (0.0, 0.0)
    loads = roller_loads(planet_bearing(built), load.force, 0.0, *moments)
    loaded: BoolArray = loads.intensity.sum(axis=(0, 2)) > 0
    return loaded


def _mixture(temperature: str) -> MixtureState:
    """That with the case's share of oil."""
    warm = source_case().updated({"operation.oil_inlet_temperature": temperature})
    return fluids_of(warm).mixture


def composite_roughness(planet: str, others: str) -> float:
    """Of the flanks of the sun mesh. [um]"""
    given = {"planet.roughness": planet, "sun.roughness": others, "ring.roughness": others}
    contact = mesh_contacts(source_case().updated(given))["sun_mesh"]
    return float(np.mean(contact.composite_roughness)) * 1e6


def branch_slope(
    temperature: str, finish: str, planets: list[int], tests: LoadedTests = _computed_tests
) -> float:
    """Slope of P_LD/n over P_in/n through all tests, of a line with intercept. [%]"""
    results = tests(temperature, finish, planets)
    counts = np.repeat(planets, len(TEST_TORQUES) * len(TEST_SPEEDS))
    power = np.array([result.input_power for result in results]) / counts
    loss = np.array([result.load_dependent for result in results]) / counts
    return 100 * slopes(power, loss)["with intercept"]


def slopes(over: FloatArray, values: FloatArray) -> dict[str, float]:
    """Those of two straight lines through points."""
    return {
        "with intercept": float(np.polyfit(over, values, 1)[0]),
        "through the origin": float(over @ values / (over @ over)),
    }


def slope_gain(temperature: str, tests: LoadedTests = _computed_tests) -> float:
    """Slope of all shaved sets less that of six polished planets. [%]"""
    return branch_slope(temperature, "shaved", [3, 4, 5, 6], tests=tests) - branch_slope(
        temperature, "chemically-polished", [6], tests=tests
    )


def loss_in_test(
    part: str,  # ``"load_dependent"``, ``"load_independent"``, ``"without_union"``, ``"total"``.
    temperature: str,
    planets: int,
    finish: str = "shaved",
    torque: int = 1000,
    speed: int = 4000,
    unit: str = "kW",
    tests: LoadedTests = _computed_tests,
) -> float:
    """A power of one test, in the unit."""
    place = TEST_TORQUES.index(torque) * len(TEST_SPEEDS) + TEST_SPEEDS.index(speed)
    power = _part(tests(temperature, finish, [planets])[place], part)
    return power if unit == "W" else power / 1e3


def _part(test: LoadedTest | Result, part: str) -> float:
    if part == "total":
        return test.load_dependent + test.load_independent
    if part == "without_union":  # the predictions of the source leave it out, p. 144
        assert isinstance(test, Result)
        union = sum(watts for key, watts in test.losses.items() if key.startswith("union"))
        return test.load_independent - union
    return float(getattr(test, part))


def loss_change(
    part: str, before: dict[str, Any], after: dict[str, Any], tests: LoadedTests = _computed_tests
) -> float:
    """By how much a power of one test exceeds that of another. [kW]"""
    one, other = (loss_in_test(part, **own, tests=tests) for own in (before, after))
    return other - one


def spin_share(
    temperature: str, planets: int, torque: int, tests: LoadedTests = _computed_tests
) -> float:
    """P_LI/P at 4000 rpm. [%]"""
    spin, total = (
        loss_in_test(part, temperature, planets, torque=torque, tests=tests)
        for part in ("load_independent", "total")
    )
    return 100 * spin / total


def prediction_difference(
    measured: float,  # [kW]
    part: str,
    temperature: str,
    planets: int,
    tests: LoadedTests = _computed_tests,
) -> float:
    """(measured - predicted)/measured at 1000 N m and 4000 rpm. Eq. 5.13. [%]"""
    predicted = loss_in_test(part, temperature, planets, tests=tests)
    return 100 * (measured - predicted) / measured


def loss_share(
    temperature: str,
    planets: int,
    extreme: str,
    part: str = "load_dependent",
    tests: LoadedTests = _computed_tests,
) -> float:
    """Extreme of a loss over P_in over the tests of a number of planets. [%]"""
    results = tests(temperature, "shaved", [planets])
    values = [100 * _part(result, part) / result.input_power for result in results]
    return min(values) if extreme == "smallest" else max(values)


def branch_loss_ratio(temperature: str, tests: LoadedTests = _computed_tests) -> float:
    """P_LD/n with six planets over that with three, mean of all tests. [1]"""
    three, six = (tests(temperature, "shaved", [planets]) for planets in (3, 6))
    ratios = [b.load_dependent / a.load_dependent / 2 for a, b in zip(three, six, strict=True)]
    return float(np.mean(ratios))


def branch_spin(temperature: str, speed: int = 4000, tests: LoadedTests = _computed_tests) -> float:
    """A third of P_LI with six less that with three planets. Eq. 5.14b. [W]"""
    three, six = ({"temperature": temperature, "planets": it, "speed": speed} for it in (3, 6))
    return 1e3 * loss_change("load_independent", three, six, tests) / 3


def branch_spin_exponent(temperature: str, tests: LoadedTests = _computed_tests) -> float:
    """Slope of the logarithm of `branch_spin` over that of the speed. [1]"""
    losses = [branch_spin(temperature, speed, tests) for speed in TEST_SPEEDS]
    return float(np.polyfit(np.log(TEST_SPEEDS), np.log(losses), 1)[0])


NOMINAL_BACKLASH = 0.1  # Of the example pair. Table 4.1. [mm]


def pocketing_figure(
    model: str,
    of: dict[str, Any],
    over: dict[str, Any] | None = None,
    unit: str = "W",
    exponent: bool = False,
) -> float:
    """Pocketing loss of the example pair under conditions `of` at 10000 rpm [W].

    With `over` its ratio to that under these [1], or its change in %; with `exponent` the slope of
    its logarithm over that of the speed [1].
    """
    if exponent:
        speeds = np.arange(1000, 10001, 1000)
        losses = [_pocketing(model, speed=f"{speed} rpm", **of) for speed in speeds]
        return float(np.polyfit(np.log(speeds), np.log(losses), 1)[0])
    loss = _pocketing(model, **of)
    if over is None:
        return loss
    ratio = loss / _pocketing(model, **over)
    return 100 * (ratio - 1) if unit == "%" else ratio


@cache
def _pocketing(
    model: str,
    helix_angle: str,
    face_width: str = "15 mm",
    speed: str = "10000 rpm",
    oil_air_ratio: float = 0.05,
    backlash: float = NOMINAL_BACKLASH,  # [mm]
) -> float:
    thickness = f"{math.pi - backlash / 2:.4f} mm"  # of both, at the operating circles. Table 4.1
    case = read_case("talbot-2012-pair").updated({
        "gears.helix_angle": helix_angle,
        "operation.speed": speed,
        "surroundings.oil_air_ratio": oil_air_ratio,
        "models.pocketing": model,
        **dict.fromkeys(("pinion.face_width", "gear.face_width"), face_width),
        **dict.fromkeys(("pinion.tooth_thickness", "gear.tooth_thickness"), thickness),
    })  # fmt: skip
    return solve(case).losses["mesh_pocketing"]


def _standard_mesh(teeth1: int, teeth2: int, internal: bool) -> LoadedMesh:
    """Spur gears of ISO 53, profile A, without shift, of steel of 206 GPa, under 300 N/mm."""
    module, width, line_load = 4.0, 40.0, 300.0  # mm, mm, N/mm
    distance = module * (teeth2 + (-teeth1 if internal else teeth1)) / 2
    base_radius = module * teeth1 / 2 * math.cos(math.radians(20))
    gear = {
        "face_width": f"{width} mm",
        "profile_shift_coefficient": 0.0,
        "roughness": "ground",
        "material": {"elastic_modulus": "206 GPa"},
    }
    case = read_case(
        {
            "kind": "gear_pair",
            "operation": {
                "torque": f"{line_load * width * base_radius / 1e3} N*m",
                "speed": "1000 rpm",
                "oil_inlet_temperature": "60 degC",
            },
            "gears": {
                "normal_module": f"{module} mm",
                "normal_pressure_angle": "20 deg",
                "helix_angle": "0 deg",
                "center_distance": f"{distance} mm",
            },
            "pinion": gear | {"teeth": teeth1},
            "gear": gear | {"teeth": teeth2, "internal": internal},
            "lubricant": {"oil": "iso-vg-100-mineral"},
        }
    )
    return loaded_meshes(case)["mesh"]


@cache
def data_file(name: str) -> dict[str, Any]:
    """What a data file beside this module holds."""
    file = resources.files("epicyclic.validation").joinpath(name)
    return tomllib.loads(file.read_text(encoding="utf-8"))


def _train(train: str, changes: Mapping[str, Any]) -> Result:
    tables = data_file("trains.toml").get(train)
    case = read_case(train if tables is None else tables)
    return solve(case.updated(changes))


def train_ratio(train: str, **changes: Any) -> float:
    """Speed of the input over that of the output, signed. [1]"""
    result = _train(train, changes).train
    assert result is not None
    assert result.ratio is not None
    return result.ratio


def train_efficiency(train: str, **changes: Any) -> float:
    """Power out over power in; 0 if the train is self-locking. [1]"""
    efficiency = _train(train, changes).efficiency
    assert efficiency is not None
    return efficiency


def bulk_temperature(mesh: str) -> float:
    """ISO/TS 6336-22, from the friction and the loss factor printed beside it. [degC]"""
    given = data_file("temperatures.toml")[mesh]
    rise = bulk_rise_of_loss(
        given["power"] * given["mean_friction"] * given["loss_factor"],
        given["center_distance"],
        given["face_width"],
        LUBRICATION_FACTORS[given["lubrication"]],
    )
    return float(given["oil_temperature"] + rise)


def pair_bulk_temperature(pair: str) -> float:
    """ISO/TS 6336-22, with the friction and the loss factor of a pair of gears. [degC]"""
    given, contact = _loaded_pair(pair)
    rise = bulk_rise_of_loss(
        contact.input_power * _mean_friction(pair) * ohlendorf_loss_factor(contact.mesh),
        contact.mesh.center_distance,
        contact.mesh.face_width,
        LUBRICATION_FACTORS[given["lubrication"]],
    )
    return contact.oil.temperature - KELVIN + rise


def pair_flash_temperature(pair: str, line_load: float) -> float:
    """ISO/TS 6336-22, at the start of the path of contact under a line load in N/m. [K]"""
    contact = _loaded_pair(pair)[1]
    mesh, start = contact.mesh, contact.mesh.path_start
    speed1, speed2 = contact.speed1 * start, contact.speed2 * mesh.curvature2(start)
    carried = Solid(**data_file("temperatures.toml")["steel"]).effusivity
    rise = flash_temperature(
        _mean_friction(pair),
        line_load,
        speed1 - speed2,
        speed1,
        speed2,
        hertz_half_width(
            line_load, mesh.equivalent_radius(start), contact.flanks.equivalent_modulus
        ),
        carried,
        carried,
    )
    return float(rise)


@cache
def _loaded_pair(pair: str) -> tuple[dict[str, Any], MeshContact]:
    given = data_file("temperatures.toml")[pair]
    return given, mesh_contacts(read_case(given["case"]))["mesh"]


def _mean_friction(pair: str) -> float:
    given, contact = _loaded_pair(pair)
    radius = pitch_point_radius(contact)
    return iso_mean_friction(
        specific_load(contact),
        pitch_point_sum_speed(contact),
        radius,
        contact.oil.dynamic_viscosity,
        roughness_factor(given["roughness_ra"], radius),
        contact.oil.lubricant_factor,
    )


def _of_contact(figure: Callable[[MeshContact], float]) -> Callable[[str, str], float]:
    return lambda case, mesh: figure(_contacts(case)[mesh])


FIGURES: Mapping[str, Callable[..., float]] = {
    **{name: _of_contact(figure) for name, figure in _OF_CONTACT.items()},
    # Operating pressure angle [deg], path of contact [mm], or transverse contact ratio [1].
    "mesh_geometry": lambda case, mesh, figure: _GEOMETRY[figure](_contacts(case)[mesh].mesh),
    # Through the meshes of all planets, relative to the carrier. [kW]
    "mesh_power": lambda case, mesh: _planets(case) * _contacts(case)[mesh].input_power / 1e3,
    # Mean coefficient of friction of a model. [1]
    "mean_friction": lambda case, mesh, friction: (
        _solved(case, friction).meshes[mesh].friction_mean
    ),
    # Sliding loss along the contact lines. [W]
    "sliding_loss": lambda case, mesh, load_distribution, friction: (
        _solved(case, friction, load_distribution).losses[f"{mesh}_sliding"]
    ),
    # Loss of all meshes, along the contact lines, with the friction of each. [kW]
    "stage_loss": lambda case, **friction: sum(
        _planets(case) * local_loss(case, mesh, it) for mesh, it in friction.items()
    ),
    # c' and c_gamma of a mesh under its load, and of a standard spur mesh. [N/(mm um)]
    "program_single_stiffness": lambda case, mesh: single_stiffness_of(_loaded(case)[mesh]),
    "program_mesh_stiffness": lambda case, mesh: mesh_stiffness_of(_loaded(case)[mesh]),
    "single_stiffness": lambda **gears: single_stiffness_of(_standard_mesh(**gears)),
    "mean_mesh_stiffness": lambda **gears: mesh_stiffness_of(_standard_mesh(**gears)),
    "mixture_density": lambda temperature: _mixture(temperature).density,  # [kg/m^3]
    # Dynamic. [mPa s]
    "mixture_viscosity": lambda temperature: _mixture(temperature).dynamic_viscosity * 1e3,
    **{
        function.__name__: function
        for function in (
            local_loss_factor, closed_loss, local_loss, planet_bearing_loss,
            planet_bearing_ratio, planet_bearing_change, azimuth_of_gained_rollers,
            composite_roughness, branch_slope, slope_gain, loss_in_test, loss_change, spin_share,
            prediction_difference, loss_share, branch_loss_ratio, branch_spin,
            branch_spin_exponent, pocketing_figure, train_ratio, train_efficiency,
            bulk_temperature, pair_bulk_temperature, pair_flash_temperature,
        )
    },
}  # fmt: skip
