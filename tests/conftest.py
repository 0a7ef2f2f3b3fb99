"""Shared by all tests: the published test article, gears made to order, seeded property tests."""

from __future__ import annotations

import gc
import math

import pytest
from hypothesis import settings

import epicyclic as ep
from epicyclic.files import look_seldom
from epicyclic.gears.gear import BasicRack, Gear, half_angle_from_profile_shift
from epicyclic.gears.mesh import Mesh
from epicyclic.oil.oil import oil_state
from epicyclic.study.sweeps import run

settings.register_profile("epicyclic", derandomize=True, deadline=None, max_examples=30)
settings.load_profile("epicyclic")

look_seldom()

CELSIUS = 273.15
COARSE = {"numerics.pocket_slices": 6, "numerics.pocket_steps": 10}
"""For tests to which the figures of the pockets do not matter."""


def pytest_collection_finish():
    """What is loaded by then stays: Python need not look through it for garbage again and again."""
    gc.freeze()


@pytest.fixture
def fails_at_high_speed(monkeypatch):
    """Points of sweeps above 600 rad/s have no result."""
    solve_together = run.solve_together

    def fails(cases, *tables):
        return [
            ep.ConvergenceError("the test says no") if case.operation.speed > 600 else result
            for case, result in zip(cases, solve_together(cases, *tables), strict=True)
        ]

    monkeypatch.setattr(run, "solve_together", fails)


@pytest.fixture(scope="session")
def talbot():
    """The test article of Talbot (2012): 3 planets, 1000 N m, 4000 rpm, 90 degC."""
    return ep.load_case("talbot-2012")


@pytest.fixture(scope="session")
def coarse_talbot(talbot):
    """The same with few slices and steps in the pockets."""
    return talbot.updated(COARSE)


@pytest.fixture(scope="session")
def coarse_options():
    """What makes the same of it on a command line."""
    return [option for key, value in COARSE.items() for option in ("--set", f"{key}={value}")]


@pytest.fixture(scope="session")
def talbot_record(talbot):
    """Its result with everything that reports and plots show."""
    return ep.record(talbot)


@pytest.fixture(scope="session")
def pair_map():
    """A small loss map of the published gear pair, two temperatures and torques of both signs."""
    return ep.loss_map(
        ep.load_case("talbot-2012-pair").updated(
            {"losses.mesh_pocketing.include": False, "models.load_distribution": "uniform"}
        ),
        speed=["0 rpm", "2000 rpm", "6000 rpm"],
        torque=["-100 N*m", "0 N*m", "100 N*m"],
        temperature=["40 degC", "90 degC"],
        jobs=1,
    )


@pytest.fixture(scope="session")
def talbot_meshes(talbot):
    """Its sun and ring mesh."""
    return talbot.gearings[""].geometries


@pytest.fixture(scope="session")
def atf(talbot):
    """The test fluid by temperature in degC."""

    def state(celsius):
        return oil_state(talbot.lubricant.oil, celsius + CELSIUS)

    return state


@pytest.fixture(scope="session")
def make_gear():
    """Gears of the proportions of ISO 53."""

    def gear(
        teeth,
        x=0.0,
        *,
        internal=False,
        alpha=20.0,
        beta=0.0,
        module=2e-3,
        addendum=1.0,
        dedendum=1.25,
        width=20e-3,
        name="gear",
    ):
        helix = math.radians(beta)
        alpha_t = math.atan(math.tan(math.radians(alpha)) / math.cos(helix))
        rack = BasicRack(module / math.cos(helix), alpha_t, helix)
        reference = teeth * rack.transverse_module / 2
        outward = -module if internal else module
        return Gear(
            name=name,
            rack=rack,
            teeth=teeth,
            internal=internal,
            thickness_half_angle=half_angle_from_profile_shift(rack, teeth, x),
            tip_radius=reference + outward * (x + addendum),
            root_radius=reference + outward * (x - dedendum),
            face_width=width,
        )

    return gear


@pytest.fixture(scope="session")
def make_mesh(make_gear):
    """Meshes of such gears, at the reference centre distance unless another is given."""

    def mesh(teeth1, teeth2, *, internal=False, x1=0.0, x2=0.0, center_distance=None, **kwargs):
        one = make_gear(teeth1, x1, name="pinion", **kwargs)
        two = make_gear(teeth2, x2, internal=internal, name="wheel", **kwargs)
        side = -1 if internal else 1
        reference = two.reference_radius + side * one.reference_radius
        return Mesh("mesh", one, two, center_distance or reference)

    return mesh
