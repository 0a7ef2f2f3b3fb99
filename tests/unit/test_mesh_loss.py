"""Load-dependent loss of a mesh against the loss factors of the literature."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import epicyclic as ep
from contacts import loaded_contact, with_overlap_ratio
from epicyclic.losses.friction import FRICTION_MODELS, FrictionMap, FrictionSettings, friction_model
from epicyclic.losses.mesh import local_loss, loss_factor_loss, mean_friction, ohlendorf_loss_factor
from epicyclic.losses.rolling import ROLLING_MODELS
from epicyclic.machine.gear_mesh import MOSTLY_ENOUGH, PEAK_SHARE, _exceeded
from reference.gear_loss import equal_sharing_loss_factor, uniform_load_loss_factor

SETTINGS = FrictionSettings(
    0.04, 0.10, 0.02, FrictionMap((("film_ratio", (0.1, 3.0)),), (0.09, 0.03))
)


def constant(value):
    return friction_model("constant", FrictionSettings(constant=value))


NO_ROLLING = ROLLING_MODELS["goksem-hargreaves"]

# FZG type C and gears of other shape; every tip ratio below 1 and both together above 1
SPUR = [
    pytest.param({"teeth1": 20, "teeth2": 41}, id="external"),
    pytest.param({"teeth1": 30, "teeth2": 30}, id="unity"),
    pytest.param({"teeth1": 17, "teeth2": 90, "x1": 0.4, "x2": -0.4}, id="shifted"),
    pytest.param({"teeth1": 25, "teeth2": 80, "internal": True, "addendum": 0.8}, id="internal"),
    pytest.param(
        {"teeth1": 26, "teeth2": 125, "internal": True, "alpha": 22.5, "x1": 0.2, "x2": -0.2},
        id="internal, shifted",
    ),
]


def loss_factor(mesh, oil, **kwargs):
    """Sliding loss of the local method over friction and power passed on."""
    contact = loaded_contact(mesh, oil, **kwargs)
    loss = local_loss(contact, constant(0.05), NO_ROLLING)
    return loss.sliding / (0.05 * kwargs.get("torque", 200.0) * kwargs.get("speed", 200.0))


def reference(formula, mesh):
    return formula(
        mesh.gear1.teeth,
        mesh.gear2.teeth,
        mesh.tip_contact_ratios[0],
        mesh.tip_contact_ratios[1],
        mesh.gear1.rack.base_helix_angle,
        internal=mesh.internal,
    )


# --- Ohlendorf ------------------------------------------------------------------------------------


@pytest.mark.parametrize("shape", SPUR)
def test_loss_factor_is_that_of_ohlendorf(make_mesh, shape):
    mesh = make_mesh(**shape)
    assert ohlendorf_loss_factor(mesh) == pytest.approx(
        reference(equal_sharing_loss_factor, mesh), rel=1e-11
    )


def test_loss_factors_of_the_test_article(talbot_meshes):
    # worked out separately; half a unit of the last digit. Its internal value, 0.05650, is given
    # as 0.05649 in a separate computation: a whole unit there.
    sun_mesh, ring_mesh = talbot_meshes
    assert ohlendorf_loss_factor(sun_mesh) == pytest.approx(0.09653, abs=0.5e-5)
    assert ohlendorf_loss_factor(ring_mesh) == pytest.approx(0.05650, abs=1e-5)
    assert reference(equal_sharing_loss_factor, sun_mesh) == pytest.approx(0.09653, abs=0.5e-5)


def with_tip_ratios(mesh, tip1, tip2):
    """The mesh with tips moved so that the path of contact has these lengths in base pitches."""
    pitch = mesh.gear1.rack.transverse_base_pitch
    curvature1 = mesh.pitch_point + tip1 * pitch
    curvature2 = mesh.curvature2(mesh.pitch_point - tip2 * pitch)
    mesh = replace(
        mesh,
        gear1=replace(mesh.gear1, tip_radius=math.hypot(mesh.gear1.base_radius, curvature1)),
        gear2=replace(mesh.gear2, tip_radius=math.hypot(mesh.gear2.base_radius, curvature2)),
    )
    assert mesh.tip_contact_ratios[0] == pytest.approx(tip1, rel=1e-9)
    assert mesh.tip_contact_ratios[1] == pytest.approx(tip2, rel=1e-9)
    return mesh


@pytest.mark.parametrize(
    ("tip1", "tip2", "bracket"),
    # worked out separately: 2 int |s|/N(s) ds; Ohlendorf's bracket holds for the first
    [(0.8, 0.8, 0.6800), (1.2, 0.4, 0.9600), (0.4, 1.2, 0.9600), (1.1, 1.2, 1.11667)],
)
@pytest.mark.parametrize("internal", [False, True])
def test_loss_factor_beyond_the_limits_of_the_closed_form(make_mesh, tip1, tip2, bracket, internal):
    mesh = with_tip_ratios(make_mesh(60, 150, internal=internal), tip1, tip2)
    factor = math.pi * (1 / 60 + (-1 if internal else 1) / 150)
    assert ohlendorf_loss_factor(mesh) / factor == pytest.approx(bracket, abs=0.5e-5)


@pytest.mark.parametrize("shape", SPUR)
def test_local_method_on_spur_gears_is_ohlendorf(make_mesh, atf, shape):
    mesh = make_mesh(**shape)
    # Uniform load along the lines of a spur mesh is equal sharing. The rule for averages leaves
    # 0.17 % with 20 positions, times 1.5; the demand on this program is 1 %.
    assert loss_factor(mesh, atf(60)) == pytest.approx(
        reference(equal_sharing_loss_factor, mesh), rel=0.0025
    )


@pytest.mark.parametrize("shape", SPUR)
def test_local_method_converges_to_ohlendorf(make_mesh, atf, shape):
    mesh = make_mesh(**shape)
    exact = reference(equal_sharing_loss_factor, mesh)
    errors = [
        abs(loss_factor(mesh, atf(60), positions=n, segments=2) / exact - 1) for n in (20, 80, 320)
    ]
    # |s| has a kink at the pitch point, so that single steps are erratic; 16-fold refinement gains
    # 256 by the second order and scatters by up to 4 about it
    assert errors[2] < errors[0] / 50 or errors[2] < 1e-5


@pytest.mark.parametrize(("tip1", "tip2"), [(1.2, 0.4), (0.4, 1.2), (1.1, 1.2)])
def test_local_method_agrees_beyond_the_limits_of_the_closed_form(make_mesh, atf, tip1, tip2):
    mesh = with_tip_ratios(make_mesh(60, 150), tip1, tip2)
    # 200 positions: some 1e-5 by the rule for averages
    assert loss_factor(mesh, atf(60), positions=200) == pytest.approx(
        ohlendorf_loss_factor(mesh), rel=2e-5
    )


# --- helical gears --------------------------------------------------------------------------------


@pytest.mark.parametrize("overlap", [1.0, 2.0])
@pytest.mark.parametrize("internal", [False, True])
def test_helical_gears_of_integer_overlap_have_the_closed_form(make_mesh, atf, overlap, internal):
    mesh = with_overlap_ratio(make_mesh(30, 100, beta=20.0, internal=internal), overlap)
    exact = reference(uniform_load_loss_factor, mesh)
    # measured 0.09 % with 20 positions and segments, 6.5e-6 with 160 of each; times 1.5
    assert loss_factor(mesh, atf(60)) == pytest.approx(exact, rel=1.4e-3)
    fine = loss_factor(mesh, atf(60), positions=160, segments=160)
    assert fine == pytest.approx(exact, rel=1e-5)


def test_wide_helical_gears_approach_the_closed_form(make_mesh, atf):
    errors = []
    for width in (0.0357, 0.1357, 0.5357):
        mesh = make_mesh(30, 50, beta=15.0, width=width)
        errors.append(
            abs(
                loss_factor(mesh, atf(60), positions=60, segments=60)
                / reference(uniform_load_loss_factor, mesh)
                - 1
            )
        )
    # 0.4 % at an overlap ratio of 1.5, falling with its square to 3e-5 at 22
    assert errors[0] < 6e-3
    assert errors[2] < 1e-4


def test_reference_forms_meet_where_one_pair_carries_all():
    # eps_alpha = 1 with one pair in contact: both brackets are eps_1^2 + eps_2^2
    for tip in (0.2, 0.5):
        one = equal_sharing_loss_factor(20, 60, tip, 1 - tip, 0.3)
        assert one == pytest.approx(uniform_load_loss_factor(20, 60, tip, 1 - tip, 0.3), rel=1e-12)
    with pytest.raises(ValueError, match="eps_1 <= 1"):
        equal_sharing_loss_factor(20, 60, 1.2, 0.3)
    with pytest.raises(ValueError, match="eps_alpha >= 1"):
        equal_sharing_loss_factor(20, 60, 0.4, 0.3)


def test_minimum_energy_load_lowers_the_loss_of_spur_gears(make_mesh, atf):
    mesh = make_mesh(20, 41)
    uniform = loss_factor(mesh, atf(60))
    shaped = loss_factor(mesh, atf(60), model="minimum-energy")
    # the pairs at the ends of the path, which slide fastest, carry 0.36 instead of half: 0.948
    assert 0.93 < shaped / uniform < 0.97


# --- laws -----------------------------------------------------------------------------------------


def test_loss_is_linear_in_constant_friction(make_mesh, atf):
    contact = loaded_contact(make_mesh(30, 50, beta=15.0), atf(60))
    one = local_loss(contact, constant(0.01), NO_ROLLING)
    seven = local_loss(contact, constant(0.07), NO_ROLLING)
    assert seven.sliding == pytest.approx(7 * one.sliding, rel=1e-12)
    assert seven.rolling == one.rolling
    assert mean_friction(contact, seven.friction) == pytest.approx(0.07, rel=1e-12)
    none = local_loss(contact, constant(0.0), NO_ROLLING)
    assert none.sliding == 0.0


@pytest.mark.parametrize("rolling", sorted(ROLLING_MODELS))
@pytest.mark.parametrize("friction", sorted(FRICTION_MODELS))
def test_members_of_an_external_pair_can_be_swapped(make_mesh, atf, friction, rolling):
    mesh = make_mesh(23, 47, beta=12.0, x1=0.2, x2=0.1, center_distance=72.3e-3)
    swapped = replace(mesh, gear1=mesh.gear2, gear2=mesh.gear1)
    ratio = mesh.ratio
    losses = []
    for item, torque, speed, rough in (
        (mesh, 150.0, 300.0, (0.2e-6, 0.5e-6)),
        (swapped, 150.0 * ratio, 300.0 / ratio, (0.5e-6, 0.2e-6)),
    ):
        contact = loaded_contact(item, atf(60), torque=torque, speed=speed, rough=rough)
        losses.append(
            local_loss(contact, friction_model(friction, SETTINGS), ROLLING_MODELS[rolling])
        )
    assert losses[1].sliding == pytest.approx(losses[0].sliding, rel=1e-9)
    assert losses[1].rolling == pytest.approx(losses[0].rolling, rel=1e-9)


@pytest.mark.parametrize("friction", sorted(FRICTION_MODELS))
def test_losses_are_positive_and_small(make_mesh, atf, friction):
    contact = loaded_contact(make_mesh(30, 50, beta=15.0), atf(60))
    for name in ROLLING_MODELS:
        loss = local_loss(contact, friction_model(friction, SETTINGS), ROLLING_MODELS[name])
        assert 0 < loss.sliding < 0.03 * contact.input_power
        assert 0 < loss.rolling < 0.01 * contact.input_power
        assert 0.002 < mean_friction(contact, loss.friction) < 0.12


@pytest.mark.parametrize("friction", sorted(FRICTION_MODELS))
def test_quick_method_is_mean_friction_times_loss_factor(make_mesh, atf, friction):
    mesh = make_mesh(25, 80, internal=True, beta=10.0)
    contact = loaded_contact(mesh, atf(60), torque=150.0, speed=250.0)
    model = friction_model(friction, SETTINGS)
    quick = loss_factor_loss(contact, model)
    assert quick.rolling == 0.0
    local = local_loss(contact, model, NO_ROLLING)
    mean = mean_friction(contact, quick.friction)
    assert mean == pytest.approx(mean_friction(contact, local.friction), rel=1e-12)
    factor = ohlendorf_loss_factor(mesh)
    assert quick.sliding == pytest.approx(150 * 250 * mean * factor, rel=1e-10)


def test_mean_friction_is_weighted_with_the_sliding_power(make_mesh, atf):
    contact = loaded_contact(make_mesh(20, 41), atf(60))

    class Half:
        """Friction on the recess side only."""

        name, title, source, made_for, ranges = "half", "half", "test", None, ()

        def flags(self, role, contact, loss):
            return ()

        def coefficient(self, contact):
            return np.where(contact.path > 0, 0.1, 0.0)

    loss = local_loss(contact, Half(), NO_ROLLING)
    # power of the recess side: e1^2 with one pair, as the integral of |s| over the line load
    power = contact.line_load * np.abs(contact.sliding_speed) * contact.weight
    share = power[contact.path > 0].sum() / power.sum()
    assert mean_friction(contact, loss.friction) == pytest.approx(0.1 * share, rel=1e-12)
    assert 0.3 < share < 0.7


def test_sliding_changes_sign_at_the_pitch_point(make_mesh, atf):
    for internal in (False, True):
        contact = loaded_contact(make_mesh(25, 80, internal=internal), atf(60))
        # beyond the pitch point the addendum of member 1, the faster surface, slides ahead
        assert np.array_equal(np.sign(contact.sliding_speed), np.sign(contact.path))
        # v_g = omega_1 (1 +- 1/u) times the distance from the pitch point
        rate = 200.0 * (1 + (-1 if internal else 1) / contact.mesh.ratio)
        assert contact.sliding_speed == pytest.approx(rate * contact.path, rel=1e-9, abs=1e-9)


def test_local_conditions_at_the_pitch_point(make_mesh, atf):
    mesh = make_mesh(25, 80, beta=20.0)
    contact = loaded_contact(mesh, atf(60), positions=400, segments=50)
    at = np.abs(contact.path).argmin()
    speed = 200.0 * mesh.operating_radius1 * math.sin(mesh.operating_pressure_angle)
    slack = abs(contact.path[at]) / mesh.pitch_point * 2
    assert contact.rolling_speed[at] == pytest.approx(speed, rel=slack)
    # normal section: rho_n = rho_t/cos(beta_b)
    rho1, rho2 = mesh.pitch_point, mesh.curvature2(mesh.pitch_point)
    cosine = math.cos(mesh.gear1.rack.base_helix_angle)
    assert contact.radius[at] == pytest.approx(rho1 * rho2 / (rho1 + rho2) / cosine, rel=slack)
    # the concave flank of a ring closes up to the pinion: 1/rho = 1/rho1 - 1/rho2
    mesh = make_mesh(25, 80, internal=True)
    contact = loaded_contact(mesh, atf(60))
    rho1 = contact.path + mesh.pitch_point
    rho2 = rho1 + mesh.line_of_action
    assert 1 / contact.radius == pytest.approx(1 / rho1 - 1 / rho2, rel=1e-9)
    assert contact.pitch_line_speed == pytest.approx(200.0 * mesh.operating_radius1, rel=1e-12)


def test_average_normal_force_is_the_transmitted_one(make_mesh, atf):
    mesh = make_mesh(30, 50, beta=15.0)
    contact = loaded_contact(mesh, atf(60), torque=300.0)
    normal = 300.0 / mesh.gear1.base_radius / math.cos(mesh.gear1.rack.base_helix_angle)
    assert float(contact.line_load @ contact.weight) == pytest.approx(normal, rel=1e-10)
    assert contact.input_power == pytest.approx(300.0 * 200.0, rel=1e-12)


# --- through the case -----------------------------------------------------------------------------


@pytest.fixture(scope="module")
def pair():
    return ep.load_case("talbot-2012-pair").updated(
        {"operation.torque": "150 N*m", "operation.speed": "3000 rpm"}
    )


@pytest.mark.parametrize(
    "changes", [{}, {"models.friction": "schlenk", "models.mesh": "loss-factor"}]
)
def test_sign_of_torque_and_speed_does_not_change_the_loss(pair, changes):
    # whether the pinion drives decides which flanks bound the pockets
    pair = pair.updated({**changes, "losses.mesh_pocketing.include": False})
    forward = ep.solve(pair).losses
    for torque, speed in (
        ("-150 N*m", "3000 rpm"),
        ("150 N*m", "-3000 rpm"),
        ("-150 N*m", "-3000 rpm"),
    ):
        turned = pair.updated({"operation.torque": torque, "operation.speed": speed})
        assert ep.solve(turned).losses == pytest.approx(forward, rel=1e-12)


def test_units_of_the_case_do_not_change_the_loss(pair):
    def inches(text):
        return f"{float(text.split()[0]) / 25.4!r} inch"

    changes = {
        "operation.torque": f"{150 / 1.3558179483314004!r} ft*lbf",
        "operation.speed": f"{3000 * math.pi / 30!r} rad/s",
        "operation.oil_inlet_temperature": "194 degF",
        "gears.helix_angle": f"{math.radians(15)!r} rad",
        "gears.center_distance": inches("50"),
        "gears.transverse_module": inches("2"),
    }
    for gear, root in (("pinion", "44.60"), ("gear", "46.00")):
        for key, value in (
            ("face_width", "15"),
            ("tip_diameter", "54.00"),
            ("root_diameter", root),
            ("tooth_thickness", "3.0916"),
            ("thickness_diameter", "50.00"),
        ):
            changes[f"{gear}.{key}"] = inches(value)
        changes[f"{gear}.roughness"] = f"{0.4 / 0.0254!r} microinch"
    # all numbers are converted exactly but for rounding, which exponents of the regression enlarge
    assert ep.solve(pair.updated(changes)).losses == pytest.approx(ep.solve(pair).losses, rel=1e-9)


@pytest.mark.parametrize(
    ("preset", "least"),
    [({"models.preset": "talbot-2012"}, 1e-9), ({}, 1e-15)],  # rolling of rigid films: root of load
)
def test_loss_goes_to_zero_with_the_load(pair, preset, least):
    pair = pair.updated(preset)
    mesh_terms = ("mesh_sliding", "mesh_rolling")
    previous = None
    for torque in (10.0, 1.0, 0.1, 1e-3, 1e-6, least):
        losses = ep.solve(pair.updated({"operation.torque": f"{torque!r} N*m"})).losses
        now = sum(losses[term] for term in mesh_terms)
        assert now > 0
        if previous is not None:
            assert now < previous
        previous = now
    assert previous < 1e-6
    losses = ep.solve(pair.updated({"operation.torque": "0 N*m"})).losses
    assert all(losses[term] == 0.0 for term in mesh_terms)


def test_loss_goes_to_zero_with_the_speed(pair):
    losses = ep.solve(pair.updated({"operation.speed": "1e-6 rpm"})).losses
    assert 0 < losses["mesh_sliding"] < 1e-6
    assert 0 < losses["mesh_rolling"] < 1e-6
    losses = ep.solve(pair.updated({"operation.speed": "0 rpm"})).losses
    assert all(loss == 0.0 for loss in losses.values())


def test_resolution_of_the_default_is_enough(pair):
    coarse = ep.solve(pair).losses
    fine = ep.solve(
        pair.updated({"numerics.mesh_positions": 100, "numerics.contact_segments": 100})
    ).losses
    # measured 3e-4, from load peaks at the ends of the contact lines; times 1.5
    assert coarse["mesh_sliding"] == pytest.approx(fine["mesh_sliding"], rel=5e-4)
    assert coarse["mesh_rolling"] == pytest.approx(fine["mesh_rolling"], rel=5e-4)


@pytest.mark.parametrize("mesh", ["local", "loss-factor"])
@pytest.mark.parametrize(("torque", "rpm"), [(1e-230, 1e-160), (1e-300, 1e-300), (31.0, 1e-310)])
def test_powers_too_small_for_a_number_have_a_friction_still(pair, mesh, torque, rpm):
    friction = {"models.friction": "constant", "models.constant_friction": 0.061}
    point = {"operation.torque": f"{torque} N*m", "operation.speed": f"{rpm} rpm"}
    result = ep.solve(pair.updated({**friction, **point, "models.mesh": mesh}))
    assert 0 <= result.losses["mesh_sliding"] < 1e-290
    assert result.meshes["mesh"].friction_mean == pytest.approx(0.061, rel=1e-12)


@pytest.mark.parametrize("light", [False, True], ids=["enough", "all are sorted"])
def test_what_a_part_of_the_contact_exceeds(light):
    """As of all points in their order, also where those that carry most are very short."""
    rng = np.random.default_rng(6)
    values, weight, other = rng.random((3, 400))
    if light:
        weight[values > 1 - 2 * MOSTLY_ENOUGH] *= 1e-3
    order = np.argsort(values)
    below = np.cumsum(weight[order])
    expected = order[np.searchsorted(below, (1 - PEAK_SHARE) * below[-1])]
    assert _exceeded(values, weight, other) == [values[expected], other[expected]]
    heavy = weight[order[-round(MOSTLY_ENOUGH * 400) :]].sum() > PEAK_SHARE * weight.sum()
    assert heavy != light
    assert _exceeded(np.zeros(3), np.zeros(3)) == [0.0]
