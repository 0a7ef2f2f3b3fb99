"""Loss maps as FMUs, run in FMPy, against the interpolation in the map itself."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from scipy.integrate import solve_ivp

import epicyclic as ep
from epicyclic.plugins.simulators import fmu
from epicyclic.study.maps.tables import make_lookup
from epicyclic.study.operating import shaft_power

HOW_TO = Path(__file__).parents[2] / "docs" / "how-to" / "fmu.md"


@pytest.fixture(scope="module")
def data():
    """Without pockets, whose flow takes most of the time of a test; title that XML cannot hold."""
    changes = {"title": 'gears <of>\n"A & B"'}
    changes |= {f"losses.{mesh}_mesh_pocketing.include": False for mesh in ("sun", "ring")}
    return ep.loss_map(
        ep.load_case("talbot-2012").updated(changes),
        ["-500 rpm", "0 rpm", "500 rpm", "3000 rpm"],
        ["-800 N*m", "-10 N*m", "0 N*m", "10 N*m", "800 N*m"],
        ["40 degC", "90 degC"],
        jobs=1,
    )


@pytest.fixture(scope="module")
def path(data, tmp_path_factory):
    place = tmp_path_factory.mktemp("fmu") / "loss map.fmu"
    ep.write_map(data, place)
    return place


def signals(rows=60):
    """Inputs in SI units, inside of the map."""
    random = np.random.default_rng(3)
    columns = {
        "time": np.arange(rows, dtype=float),
        "speed": random.uniform(-500, 3000, rows) * np.pi / 30,
        "torque": random.choice([-1, 1], rows) * 10 ** random.uniform(-2, 2.9, rows),
        "temperature": random.uniform(40, 90, rows) + 273.15,
    }
    columns["torque"][0] = columns["speed"][1] = 0.0
    table = np.zeros(rows, [(name, float) for name in columns])
    for name, values in columns.items():
        table[name] = values
    return table


def run(path, table, kind):
    """The outputs for each row of inputs; a step of co-simulation ends with those of its start."""
    result = fmpy.simulate_fmu(
        path, fmi_type=kind, input=table, start_time=0, stop_time=len(table), step_size=1,
        output_interval=1,
    )  # fmt: skip
    shift = 1 if kind == "CoSimulation" else 0
    return result[shift : shift + len(table)]


@pytest.mark.parametrize("kind", ["CoSimulation", "ModelExchange"])
def test_a_simulator_gets_what_interpolation_in_the_map_gives(data, path, kind):
    table = signals()
    found = run(path, table, kind)
    lookup = make_lookup(data)
    rpm, torque = table["speed"] * 30 / np.pi, table["torque"]
    nodes, weights = lookup.corners(rpm, torque, table["temperature"] - 273.15)
    torque_loss = (lookup.total[nodes] * weights).sum(axis=0)
    tolerance = {"rtol": 1e-11, "atol": 1e-11}  # rounding, of the units too
    np.testing.assert_allclose(found["torque_loss"], torque_loss, **tolerance)
    np.testing.assert_allclose(found["power_loss"], shaft_power(torque_loss, abs(rpm)), **tolerance)
    for number, name in enumerate(lookup.components):
        parts = (lookup.torques[number].ravel()[nodes] * weights).sum(axis=0)
        np.testing.assert_allclose(found[name], shaft_power(parts, abs(rpm)), **tolerance)
    driving = torque * np.where(rpm < 0, -1, 1)
    entering = np.maximum(driving, 0) + np.maximum(torque_loss - driving, 0)
    efficiency = 1 - torque_loss / entering
    np.testing.assert_allclose(found["efficiency"], efficiency, atol=1e-11)
    assert found["inside_map"].all()


def test_nodes_have_the_losses_of_the_map(data, path):
    table = signals(4)
    for row, point in enumerate([(3000, 800, 90), (500, -10, 40), (-500, 10, 90), (3000, 0, 40)]):
        speed, torque, celsius = point
        table[row] = (row, speed * np.pi / 30, torque, celsius + 273.15)
        wanted = data.sel(speed=speed, torque=torque, temperature=celsius)
        found = run(path, table, "CoSimulation")[row]
        assert found["power_loss"] == pytest.approx(float(wanted["total"]), rel=1e-12)
        assert found["sun_mesh_sliding"] == pytest.approx(float(wanted["sun_mesh_sliding"]))
        efficiency = float(wanted["efficiency"].fillna(0))
        assert found["efficiency"] == pytest.approx(efficiency, rel=1e-9)


def test_points_outside_are_said_and_taken_at_the_border(data, path):
    table = signals(3)
    table["speed"], table["torque"], table["temperature"] = 4000 * np.pi / 30, 10, 363.15
    found = run(path, table, "CoSimulation")
    border = float(data["torque_loss"].sel(speed=3000, torque=10, temperature=90))
    assert not found["inside_map"].any()
    np.testing.assert_allclose(found["torque_loss"], border, rtol=1e-12)


def test_the_description_has_units_and_nothing_to_complain_of(path):
    assert validate_fmu(path) == []
    description = fmpy.read_model_description(path, validate_model_structure=True)
    assert description.fmiVersion == "2.0"
    units = {item.name: item.unit for item in description.modelVariables}
    assert units["speed"] == "rad/s"
    assert units["temperature"] == "K"
    assert units["torque_loss"] == "N.m"
    assert units["power_loss"] == units["carrier_drag"] == "W"
    with zipfile.ZipFile(path) as archive:
        names = archive.namelist()
        page = archive.read("documentation/index.html").decode()
    for name in ("win64/loss_map.dll", "linux64/loss_map.so", "darwin64/loss_map.dylib"):
        assert f"binaries/{name}" in names
    assert "sources/loss_map.c" in names
    assert "<dt>reference shaft</dt><dd>sun</dd>" in page
    assert "gears &lt;of&gt;" in page


@pytest.mark.slow
def test_the_same_map_makes_the_same_identity(data, path, tmp_path):
    ep.write_map(data, tmp_path / "again.fmu")
    ep.write_map(data.isel(speed=slice(1, None)), tmp_path / "other.fmu")
    one, again, other = (
        fmpy.read_model_description(place).guid
        for place in (path, tmp_path / "again.fmu", tmp_path / "other.fmu")
    )
    assert one == again != other


def test_missing_libraries_are_named(data, tmp_path, monkeypatch):
    monkeypatch.setattr(fmu, "find_spec", lambda name: None)
    with pytest.raises(ep.InputError, match="needs fmpy and ziglang") as error:
        ep.write_map(data, tmp_path / "map.fmu")
    assert "epicyclic[fmu]" in str(error.value)
    assert list(tmp_path.iterdir()) == []


def test_a_compiler_that_fails_leaves_nothing(data, tmp_path, monkeypatch):
    monkeypatch.setattr(fmu, "_OPTIONS", ("-no-such-option",))
    with pytest.raises(ep.EpicyclicError, match="compiler failed"):
        ep.write_map(data, tmp_path / "map.fmu")
    assert list(tmp_path.iterdir()) == []


def test_the_how_to_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (code,) = re.findall(r"```python\n(.*?)```", HOW_TO.read_text(encoding="utf-8"), re.DOTALL)
    names = {}
    exec(code, names)
    assert 0.9 < names["result"]["efficiency"][-1] < 1
    assert [path.name for path in tmp_path.iterdir()] == ["loss_map.fmu"]


STORES = {
    "thermal.oil_flow": None,
    "thermal.oil_volume": "1 l",
    "thermal.lubrication": "dip",
    "thermal.housing": {"area": "0.3 m^2", "mass": "8 kg"},
}


@pytest.fixture(scope="module")
def heated(tmp_path_factory):
    """A map whose temperature follows from its losses, and its FMU."""
    changes = STORES | {"losses.mesh_pocketing.include": False, "operation.torque": "60 N*m"}
    case = ep.load_case("talbot-2012-pair").updated(changes)
    data = ep.loss_map(
        case,
        ["0 rpm", "1500 rpm", "3000 rpm"],
        ["0 N*m", "50 N*m", "100 N*m"],
        ["10 degC", "40 degC", "110 degC"],
        jobs=1,
    )
    data = ep.with_temperature_state(data, case)
    place = tmp_path_factory.mktemp("heated") / "heated.fmu"
    ep.write_map(data, place)
    return data, place


def test_the_temperature_of_an_fmu_follows_from_its_losses(heated):
    data, place = heated
    lookup = make_lookup(data)
    capacity, conductance = data.attrs["lumped_heat_capacity"], data.attrs["lumped_conductance"]
    speed, torque, around = 2500.0, np.array([20.0, 90.0]), 283.15

    def rise(time, kelvin):
        point = (np.array([speed]), torque[[int(time >= 1200)]], kelvin - 273.15)
        nodes, weights = lookup.corners(*point)
        loss = shaft_power((lookup.total[nodes] * weights).sum(axis=0), np.array([abs(speed)]))
        return (loss - conductance * (kelvin - around)) / capacity

    times = np.arange(0, 2401, 60.0)
    first = solve_ivp(rise, (0, 1200), [290.0], t_eval=times[:21], rtol=1e-9, max_step=10)
    then = solve_ivp(
        rise, (1200, 2400), first.y[:, -1], t_eval=times[21:], rtol=1e-9, max_step=10
    )  # fmt: skip
    wanted = np.append(first.y[0], then.y[0])

    table = np.zeros(4, [(name, float) for name in ("time", "speed", "torque")])
    table["time"] = [0, 1200, 1200, 2400]
    table["speed"], table["torque"] = speed * np.pi / 30, np.repeat(torque, 2)
    result = fmpy.simulate_fmu(
        place,
        input=table,
        start_values={"temperature": 290.0, "surroundings_temperature": around},
        stop_time=2400,
        step_size=60,
        output_interval=60,
    )
    assert result["temperature"] == pytest.approx(wanted, abs=1e-3)
    assert wanted[-1] - wanted[0] > 5
    assert validate_fmu(place) == []
    description = fmpy.read_model_description(place, validate_model_structure=True)
    assert description.modelExchange is None


def test_a_lumped_gearbox_settles_as_its_network_does(heated):
    data, _ = heated
    changes = STORES | {"losses.mesh_pocketing.include": False, "operation.torque": "60 N*m"}
    case = ep.load_case("talbot-2012-pair").updated(changes | {"models.temperatures": "network"})
    result = ep.solve(case)
    rise = result.heat.temperatures["oil"] - data.attrs["surroundings_temperature"]
    assert data.attrs["surroundings_temperature"] == pytest.approx(293.15)
    assert data.attrs["lumped_conductance"] * rise == pytest.approx(result.total, rel=1e-6)


def test_a_temperature_state_needs_temperatures_of_the_oil(heated):
    data, _ = heated
    case = ep.load_case("talbot-2012-pair").updated(STORES)
    with pytest.raises(ep.InputError, match="two or more"):
        ep.with_temperature_state(data.isel(temperature=[0]), case)
    with pytest.raises(ep.InputError, match="oil_volume"):
        ep.with_temperature_state(data, case.updated({"thermal.oil_volume": None}))
