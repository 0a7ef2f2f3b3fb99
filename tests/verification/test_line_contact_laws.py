"""Laws of shear, heat of sliding and steady roughness of the line-contact solver."""

from __future__ import annotations

import math

import numpy as np
import pytest

from contacts import sinusoidal_profile
from epicyclic.errors import InputError, Status
from epicyclic.oil.rheology import Barus, Carreau, LimitingStress, Newtonian, ReeEyring, Roelands
from epicyclic.plugins.contact_solver import rough
from epicyclic.plugins.contact_solver.conditions import (
    ContactOil,
    Heating,
    LineContact,
    inlet_factor,
    temperature_rise,
)
from epicyclic.plugins.contact_solver.kernels_fluid import mean_shear, thinning_factor
from epicyclic.plugins.contact_solver.kernels_rough import face_terms
from epicyclic.plugins.contact_solver.kernels_steady import deflection_matrix, solve_steady
from epicyclic.plugins.contact_solver.rough import AsperityContact, solve_rough
from epicyclic.plugins.contact_solver.steady import solve_smooth
from epicyclic.plugins.contact_solver.surfaces import SMOOTH, generate_profile

RADIUS, MODULUS = 0.01, 2.2e11
LAWS = (
    Newtonian(), ReeEyring(4e6), ReeEyring(4e6, 0.01), LimitingStress(1e6, 0.04),
    Carreau(5e6, 0.4), Carreau(5e6, 1.0),
)  # fmt: skip
STEEL = math.sqrt(46 * 7850 * 460)


def contact_of(p_h, speed, slip, law=None, oil_law=None, viscosity=0.02):
    load = 2 * math.pi * RADIUS * p_h**2 / MODULUS
    oil = ContactOil(viscosity, oil_law or Roelands(1.5e-8), law or Newtonian())
    return LineContact(
        load, RADIUS, MODULUS, speed * (1 + slip / 2), speed * (1 - slip / 2), oil
    )  # fmt: skip


@pytest.mark.parametrize("law", LAWS, ids=repr)
@pytest.mark.parametrize("pressure", [0.0, 0.3, 0.9])
def test_pressure_flow_feels_the_tangent_of_the_flow_curve(law, pressure):
    # factor = mu/(d tau/d gamma): by differences of the stress itself
    fluid = contact_of(1e9, 5.0, 0.3, law).scaled_fluid()
    film, step = 0.02, 1e-5
    higher, lower = (
        mean_shear(pressure, film, 0.0, fluid._replace(sliding=fluid.sliding * (1 + s)))
        for s in (step, -step)
    )
    newtonian = mean_shear(pressure, film, 0.0, fluid._replace(shear_law=0))
    viscosity = newtonian * film / fluid.sliding
    factor, exponent, softening = thinning_factor(viscosity, film, pressure, fluid)
    tangent = newtonian * 2 * step / (higher - lower) if higher > lower else math.inf
    if isinstance(law, LimitingStress) and tangent > 1.05:
        assert 1 < factor < tangent  # a plug is not made to flow without limit
    else:
        rel = 1e-2 if isinstance(law, LimitingStress) else 1e-4
        assert factor == pytest.approx(tangent, rel=rel)
    moved = [thinning_factor(viscosity * (1 + s), film, pressure, fluid)[0] for s in (step, -step)]
    assert exponent == pytest.approx((math.log(moved[0] / moved[1])) / (2 * step), abs=1e-4)
    moved = [thinning_factor(viscosity, film, pressure + s, fluid)[0] for s in (step, -step)]
    slope = math.log(moved[0] / moved[1]) / (2 * step)
    assert exponent * softening == pytest.approx(slope, abs=1e-3 * (1 + abs(slope)))


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_stress_of_an_even_film_has_the_closed_form_of_its_law(law):
    # constant viscosity and a heavy load make the film even
    contact = contact_of(0.3e9, 2.0, 0.02, law, Barus(1e-15), viscosity=0.05)
    solution = solve_smooth(contact)
    assert solution.status is Status.CONVERGED
    full = solution.pressure > 0
    newton = 0.05 * 0.04 / solution.film[full]
    if isinstance(law, Newtonian):
        expected = newton
    else:
        stress = law.stress + getattr(law, "slope", 0.0) * solution.pressure[full]
        expected = {
            ReeEyring: stress * np.arcsinh(newton / stress),
            LimitingStress: stress * (1 - np.exp(-newton / stress)),
            Carreau: newton
            * (1 + (newton / stress) ** 2) ** ((getattr(law, "exponent", 1) - 1) / 2),
        }[type(law)]
    assert solution.shear_stress[full] == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("law", LAWS, ids=repr)
@pytest.mark.parametrize("p_h", [0.5e9, 1.5e9, 3e9])
def test_every_law_converges_smooth(law, p_h):
    solution = solve_smooth(contact_of(p_h, 10.0, 0.8, law))
    assert solution.status is Status.CONVERGED, solution.message
    assert solution.mass_error < 1e-5
    if isinstance(law, LimitingStress):
        limit = law.stress + law.slope * solution.pressure
        assert (solution.shear_stress <= limit * (1 + 1e-12)).all()


def test_bad_constants_of_a_law_are_named():
    with pytest.raises(InputError) as error:
        contact_of(1e9, 5.0, 0.1, Carreau(-1.0, 1.5))
    keys = {problem.key for problem in error.value.problems}
    assert keys == {"oil.shear_law.stress", "oil.shear_law.exponent"}


def test_an_endless_stress_is_refused():
    # inf times arsinh(0) is not a number
    with pytest.raises(InputError, match=r"oil\.shear_law\.stress"):
        contact_of(1e9, 5.0, 0.1, ReeEyring(math.inf))


HEATING = Heating(0.03, 0.14, STEEL, STEEL)


def test_heat_of_the_inlet_thins_the_film_by_the_printed_factor():
    contact = contact_of(1e9, 20.0, 0.5)
    factor = inlet_factor(contact, HEATING)
    load = 0.03 * 0.02 * 20.0**2 / 0.14
    assert factor == pytest.approx(1 / (1 + 0.1 * (1 + 14.8 * 0.5**0.83) * load**0.64), rel=1e-12)
    cold, warm = solve_smooth(contact), solve_smooth(contact, heating=HEATING)
    # the film follows the viscosity to a power near that of the formula, not exactly
    assert warm.central_film / cold.central_film == pytest.approx(factor, rel=0.03)


def test_film_and_flash_temperature_of_an_even_source():
    # Carslaw and Jaeger: an even heat q over the length l of a fast moving surface warms its end
    # by 2 q sqrt(l)/(sqrt(pi) sqrt(k rho c u)); a source even over a film adds q h/(12 k)
    contact = contact_of(1e9, 10.0, 0.2, Newtonian(), Barus(1e-15))
    x = np.linspace(-1e-4, 1e-4, 401)
    film, pressure = np.full_like(x, 1e-7), np.full_like(x, 1e8)
    rise = temperature_rise(contact, Heating(0.0, 0.14, STEEL, STEEL), x, pressure, film)
    heat = 0.02 * 2.0**2 / 1e-7
    carried = STEEL * (math.sqrt(11.0) + math.sqrt(9.0))
    flash = 2 * heat * math.sqrt(2e-4) / (math.sqrt(math.pi) * carried)
    # each node is found to 0.001 K; the rest is the quadrature
    assert rise[-1] == pytest.approx(flash + heat * 1e-7 / (12 * 0.14), abs=0.02)
    assert rise[0] == pytest.approx(heat * 1e-7 / (12 * 0.14), abs=0.02)


def test_heat_lowers_friction_and_its_temperature_is_consistent():
    contact = contact_of(1.5e9, 15.0, 0.5, ReeEyring(5e6))
    cold, warm = solve_smooth(contact), solve_smooth(contact, heating=HEATING)
    assert warm.friction_coefficient < cold.friction_coefficient
    assert cold.temperature_rise.max() == 0
    # all the heat leaves with the surfaces: energy balance at the exit, from the flash formula
    heat = warm.shear_stress * contact.sliding_speed
    i = warm.x.size // 2
    cells = np.diff(warm.x)
    middle = (warm.x[1:] + warm.x[:-1]) / 2
    upstream = middle < warm.x[i]
    source = ((heat[1:] + heat[:-1]) / 2 * cells)[upstream] / np.sqrt(warm.x[i] - middle[upstream])
    carried = STEEL * (math.sqrt(contact.speed1) + math.sqrt(contact.speed2))
    expected = source.sum() / (math.sqrt(math.pi) * carried) + heat[i] * warm.film[i] / 12 / 0.14
    assert warm.temperature_rise[i] == pytest.approx(expected, rel=0.05)  # midpoint rule at x - s


@pytest.mark.parametrize(
    "law", [LimitingStress(1e6, 0.05), ReeEyring(5e6, 0.02), Newtonian()], ids=repr
)
def test_heat_that_thins_the_oil_most_has_a_temperature(law):
    # repeated passes over the whole film swing here between two temperatures
    contact = contact_of(2e9, 20.0, 0.5, law, viscosity=0.05)
    cold, hot = solve_smooth(contact), solve_smooth(contact, heating=HEATING)
    assert cold.status is hot.status is Status.CONVERGED
    assert hot.friction_coefficient < cold.friction_coefficient
    heat = hot.shear_stress * contact.sliding_speed
    root = np.sqrt(np.maximum(np.subtract.outer(hot.x, hot.x), 0))
    carried = STEEL * (math.sqrt(contact.speed1) + math.sqrt(contact.speed2))
    cells = 2 * (root[:, :-1] - root[:, 1:]) / (math.sqrt(math.pi) * carried)
    expected = cells @ (heat[1:] + heat[:-1]) / 2 + heat * hot.film / 12 / 0.14
    # each node to 0.001 K, which the softest oil turns into some hundredths of the heat
    assert hot.temperature_rise == pytest.approx(expected, rel=0.01, abs=0.05)


def test_frozen_roughness_is_the_steady_rough_contact():
    # marching in time against Newton's method on the steady equations, another discretisation
    contact = contact_of(0.8e9, 10.0, 0.0)
    wave = sinusoidal_profile(0.02e-6, 0.5 * contact.half_width)
    smooth = solve_smooth(contact)
    run = rough._Simulation(smooth, (wave, SMOOTH), 385, AsperityContact(), frozen=True)
    run.advance(6.0)
    before = run.film.copy()
    run.advance(0.5)
    assert run.film == pytest.approx(before, rel=1e-3)  # steady

    points = np.arange(run.x.size) * run.dx * contact.half_width
    period = wave.length
    heights = 0.02e-6 * np.cos(2 * math.pi * points / period) / contact.film_scale
    gap = run.base - heights
    matrix = deflection_matrix(run.x, run.x)
    start = np.interp(run.x, smooth.x / contact.half_width, smooth.pressure)
    fluid = contact.scaled_fluid()
    pressure, film, _, _, iterations, _ = solve_steady(
        run.x, gap, matrix, run.load, fluid,
        start / contact.hertz_pressure, run.approach, 1e-6, 60,
    )  # fmt: skip
    assert iterations > 0
    inside = np.abs(run.x) < 0.9
    assert run.film[inside] == pytest.approx(film[inside], rel=0.02)  # two second-order schemes
    assert np.trapezoid(pressure, run.x) == pytest.approx(run.load, rel=1e-6)


@pytest.mark.slow
def test_long_time_steps_change_a_waviness_by_less_than_half_a_percent(monkeypatch):
    # 14 steps a wave at the longest; second order would allow (2 pi/14)^2/12 = 1.7 % for the motion
    contact = contact_of(0.8e9, 10.0, 0.0)
    wave = sinusoidal_profile(0.02e-6, 0.5 * contact.half_width)
    smooth = solve_smooth(contact)
    amplitudes = []
    for stride in (1, 4):
        monkeypatch.setattr(rough, "_stride", lambda *_, stride=stride: stride)
        run = rough._Simulation(smooth, (wave, SMOOTH), 513, AsperityContact())
        run.advance(4.0)
        films = []
        for _ in range(run.step_count(1.0)):
            run.march(1)
            films.append(np.interp(0.0, run.x, run.film))
        phase = 4 * math.pi * stride * run.dx * np.arange(len(films))
        harmonics = np.column_stack([np.ones_like(phase), np.cos(phase), np.sin(phase)])
        _, cosine, sine = np.linalg.lstsq(harmonics, np.array(films))[0]
        amplitudes.append(math.hypot(cosine, sine))
    assert amplitudes[1] == pytest.approx(amplitudes[0], rel=5e-3)


def test_mass_passes_every_section_of_a_rough_contact_alike():
    contact = contact_of(1e9, 5.0, 0.25, ReeEyring(5e6))
    film = solve_smooth(contact).minimum_film
    pair = (generate_profile(film / 2, 20e-6, 4e-3, 1), generate_profile(film / 2, 20e-6, 4e-3, 2))
    run = rough._Simulation(solve_smooth(contact), pair, 512, AsperityContact())
    run.advance(3.0)
    n = run.x.size
    rho, slope = np.empty(n), np.empty(n)
    conductance, terms = np.empty(n - 1), np.empty((n - 1, 4))
    flows = []
    for _ in range(run.step_count(8.0)):
        run.march(1)
        face_terms(
            run.pressure, run.film, run.fluid, run.dx, rho, slope, conductance, terms
        )  # fmt: skip
        mass = rho * run.film
        pressure_flow = conductance * np.diff(run.pressure) / run.stride
        flows.append((mass[1:] + mass[:-1]) / 2 - pressure_flow)
    flow = np.mean(flows, axis=0)[np.abs(run.x[1:]) < 0.9]
    # what is stored changes by some per cent of one film in 8 b/u_r
    assert flow == pytest.approx(flow.mean(), rel=0.05)


def test_rough_contacts_take_laws_and_heat():
    for law in (LimitingStress(1e6, 0.04), ReeEyring(5e6, 0.01)):
        contact = contact_of(1e9, 10.0, 0.3, law)
        rms = solve_smooth(contact).minimum_film / 2
        pair = (generate_profile(rms, 20e-6, 4e-3, 1), generate_profile(rms, 20e-6, 4e-3, 2))
        cold = solve_rough(contact, *pair, nodes=256)
        warm = solve_rough(contact, *pair, nodes=256, heating=HEATING)
        assert cold.status is warm.status is Status.CONVERGED
        assert warm.friction_coefficient < cold.friction_coefficient
