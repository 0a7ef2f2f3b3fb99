"""Roller bearing of a planet: load on every slice of every roller, and the rolling loss.

Axes: x along the radial load, y across it in the plane of rotation; the bearing turns about z. The
first roller stands under the load, as in Talbot (2012), Fig. 3.1.
"""

from __future__ import annotations

import math
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.arrays import (
    TINY,
    AtOnce,
    BoolArray,
    FloatArray,
    IntArray,
    Points,
    either,
    hypot,
    larger,
    of_points,
    points_in,
    row_by_row,
    side_by_side,
    total,
)
from epicyclic.contact.line_contact import Flanks, LineContacts
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import ConvergenceError
from epicyclic.kernels.line_contact import hertz_pressure, line_load_at_pressure
from epicyclic.kernels.mixed_ehl import needle_rolling_loss_at
from epicyclic.kernels.roller_bearing import solve_roller_loads
from epicyclic.losses.drag import SPEED_PARAMETER, speed_parameter
from epicyclic.losses.friction import PRESSURE_VISCOSITY_RANGE, VISCOSITY_RANGE, beyond_data
from epicyclic.losses.mixed_lubrication import RUN_IN, mixed_friction
from epicyclic.losses.ranges import (
    Flags,
    ModelUse,
    Range,
    SomeFlags,
    ValidityFlag,
    check_contacts,
    check_ranges,
    held_in_range,
)
from epicyclic.losses.rolling import FittedRolling, RaceContacts, weight_of_fit
from epicyclic.oil.oil import OilState
from epicyclic.units import (
    CELSIUS,
    GIGAPASCAL,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    NEWTON,
    torque_text,
)

FULL_COMPLEMENT = "full-complement"
"""Name of the rolling loss with what rollers without a cage rub on each other and on races."""
FITTED_OR_PALMGREN = "fitted-or-palmgren"
"""Name of the fitted loss with that of Palmgren beyond the simulations."""
TOLERANCE = 1e-9  # Residual force over the largest load at which the balance counts as met. [1]
MAX_ITERATIONS = 100
STIFFNESS_STEP = 0.01  # Relative step of the force in `radial_stiffness`. [1]
LEAST_FORCE = 1e-9
"""Force there, at least: what smaller ones press is rounding beside the clearance. [N]"""
FIRST_APPROACH = 1e-5  # Displacement beyond the clearance at which the iteration starts. [m]

BEARING_RELIABILITY = {
    "mixed-ehl": "calibrated on three printed losses of one bearing; a fourth, with smoother "
    "rollers, is reproduced within 10 %",
    FULL_COMPLEMENT: "rolling as mixed-ehl, which was made for caged rollers; sliding between "
    "rollers and by skew from statics and a traction model, not compared with measured bearings",
    "palmgren": "its source gives a range of a factor of 2 for caged rollers",
    "reynolds": "solutions of a rigid bearing, aligned ones within 1 % of published ones; not "
    "compared with measured planets, and in mixed friction as uncertain as its boundary friction",
}
"""How well each model is known to be right, as a phrase."""

_SOURCE = "Talbot (2012), Table 3.1"
_PRESSURE = Range("hertz_pressure", "Hertz pressure", 0.25, 3.0, GIGAPASCAL, _SOURCE)
_RACE = Range("roughness1", "rms roughness of the races", 0.02, 0.10, MICROMETRE, _SOURCE)
_ROLLER = Range("roughness2", "rms roughness of the rollers", 0.055, 0.165, MICROMETRE, _SOURCE)
_COMPOSITE = Range(
    "composite_roughness", "composite rms roughness", math.hypot(0.02, 0.055),
    math.hypot(0.10, 0.165), MICROMETRE, _SOURCE,
)  # fmt: skip
_RADIUS = Range("radius", "equivalent radius", 0.5, 4.0, MILLIMETRE, _SOURCE)
_SPEED = Range("rolling_speed", "rolling speed", 1.0, 20.0, METRE_PER_SECOND, _SOURCE)
NEEDLE_RANGES = (
    Range("temperature", "oil temperature", 25.0, 100.0, CELSIUS, _SOURCE),
    VISCOSITY_RANGE,
    PRESSURE_VISCOSITY_RANGE,
    _RADIUS,
    _RACE,
    _ROLLER,
    _SPEED,
    _PRESSURE,
)
"""Ranges of the 2,880 simulations behind Eq. 3.5."""
PALMGREN_RANGES = (
    Range(
        "hertz_pressure",
        "Hertz pressure",
        None,
        4.0,
        GIGAPASCAL,
        "static load rating of roller bearings, ISO 76",
    ),
    SPEED_PARAMETER,
)
"""Ranges of the coefficient f1."""


@dataclass(frozen=True)
class RollerBearing:
    """A cylindrical roller or needle bearing."""

    pointwise = True

    rows: int
    rollers_per_row: int
    roller_diameter: float  # [m]
    roller_length: float  # [m]
    inner_diameter: float  # [m]
    diametral_clearance: float  # [m]
    crown_drop: float  # Crown drop of the profile at the ends of a roller. [m]
    crown_length_fraction: float  # Crowned part of the length, at each end. [1]
    row_gap: float  # Axial gap between the rollers of neighbouring rows. [m]
    roller_roughness: float  # rms. [m]
    race_roughness: float  # rms. [m]
    equivalent_modulus: float  # E_eq. [Pa]
    slices: int  # On each roller.

    if TYPE_CHECKING:  # what follows from them
        outer_diameter: float = field(init=False)  # Of the outer race. [m]
        pitch_diameter: float = field(init=False)  # d_m, mean of the two races. [m]
        # Equivalent radius of the contact at the inner and at the outer race. [m]
        inner_radius: float = field(init=False)
        outer_radius: float = field(init=False)
        slice_width: float = field(init=False)  # [m]
        # From the middle of the bearing to the outer end of its rollers. [m]
        half_width: float = field(init=False)
        # Axial position of the slices, shape (rows, slices). [m]
        slice_positions: FloatArray = field(init=False)
        # Drop of the profile at each slice, a parabola over the crowned ends. [m]
        crown: FloatArray = field(init=False)
        azimuth: FloatArray = field(init=False)  # Of each roller from the load. [rad]

    def __post_init__(self) -> None:
        """Diameters, radii of contact, widths and slices. Theory (B4), (B5), (B6), (B7)."""
        inner, roller = self.inner_diameter / 2, self.roller_diameter / 2
        outer = inner + 2 * roller + self.diametral_clearance / 2  # (B4)
        length, width = self.roller_length, self.roller_length / self.slices
        within = (np.arange(self.slices) + 0.5) * width - length / 2
        middles = (np.arange(self.rows) - (self.rows - 1) / 2) * (length + self.row_gap)
        positions, crown = middles[..., None] + within[..., None, :], np.zeros(self.slices)  # (B7)
        crowned = self.crown_length_fraction * length
        if crowned:
            depth = np.abs(within) - (length / 2 - crowned)
            crown = self.crown_drop * (np.maximum(depth, 0.0) / crowned) ** 2  # (B6)
        azimuth = np.arange(self.rollers_per_row) * 2 * math.pi / self.rollers_per_row
        for array in (positions, crown, azimuth):
            array.flags.writeable = False
        vars(self).update(
            outer_diameter=2 * outer,
            pitch_diameter=inner + outer,  # (B4)
            inner_radius=roller * inner / (inner + roller),  # (B5)
            outer_radius=roller * outer / (outer - roller),  # (B5)
            slice_width=width,
            half_width=(self.rows * length + (self.rows - 1) * self.row_gap) / 2,
            slice_positions=positions,
            crown=crown,
            azimuth=azimuth,
        )

    def roller_mass(self, density: float) -> float:
        """Mass of one roller. [kg]"""
        return density * math.pi / 4 * self.roller_diameter**2 * self.roller_length

    def rolling_speed(self, speed: float) -> float:
        """u_r = d_m omega (1 - d_r^2/d_m^2)/4. Talbot (2012), Eq. 3.4. Theory (B12). [m/s]"""
        ratio = self.roller_diameter / self.pitch_diameter
        return self.pitch_diameter * abs(speed) * (1 - ratio**2) / 4


@dataclass(frozen=True, slots=True, eq=False)
class RollerLoads:
    """Load distribution of a bearing.

    Attributes
    ----------
    azimuth : ndarray, shape (rollers,)
        Azimuth of each roller from the direction of the load. [rad]
    intensity : ndarray, shape (rows, rollers, slices)
        Load per length of each slice. [N/m]
    displacement : ndarray, shape (4,)
        Outer against inner race: delta_x, delta_y [m], theta_x, theta_y [rad].
    """

    pointwise = True

    azimuth: FloatArray
    intensity: FloatArray
    displacement: FloatArray


@dataclass(frozen=True, slots=True)
class BearingLoss:
    """Rolling loss of one bearing and its flags."""

    pointwise = True

    loss: float
    flags: SomeFlags = ()
    rolling: float = 1.0  # Share found as rolling in oil, of which (V1) is the least. [1]


@lru_cache(maxsize=1024)
def roller_loads(
    bearing: RollerBearing,
    force_x: float,  # Radial load of the outer race along x. [N]
    force_y: float,  # The same along y. [N]
    # moment_x, moment_y: Moments that tilt the outer race in the plane of the axis and x, and of
    # the axis and y: a load F_x at height z has the moment_x F_x z. [N m]
    moment_x: float,
    moment_y: float,
) -> RollerLoads:
    """Load on every slice under radial forces and moments.

    Raises `ConvergenceError` if the balance of forces is not found.
    """
    half_width = bearing.half_width
    load = side_by_side([force_x, force_y, moment_x / half_width, moment_y / half_width])
    return _loaded(bearing, load, _start(bearing, load), near=False)


def roller_loads_next_to(
    # bearing, force, moment_x, moment_y: As for `roller_loads`, which has the same solution but for
    # its tolerance.
    bearing: RollerBearing,
    last: RollerLoads,
    force: float,
    moment_x: float,
    moment_y: float,
) -> RollerLoads:
    """Load on every slice under nearly the load of `last`, which saves most of the work."""
    half_width = bearing.half_width
    load = side_by_side([force, 0.0, moment_x / half_width, moment_y / half_width])
    start = np.asarray(last.displacement) * side_by_side([1.0, 1.0, half_width, half_width])
    return _loaded(bearing, load, start, near=True)


def _loaded(
    bearing: RollerBearing, load: FloatArray, start: FloatArray, *, near: bool
) -> RollerLoads:
    """The bearing under forces and moments over its half-width, from the displacements `start`."""
    half_width = bearing.half_width
    intensity, state, iterations = _solved(bearing, load, start, near=near)
    if (iterations < 0).any():
        force_x, force_y, *moments = load.reshape(-1, 4)[np.argmax(iterations < 0)].tolist()
        raise ConvergenceError(
            "the load distribution of the planet bearing was not found under "
            f"{NEWTON.text(math.hypot(force_x, force_y), 4)} and "
            f"{torque_text(half_width * math.hypot(*moments), 4)}; "
            "check roller length and clearance, or use the bearing model 'palmgren'."
        )
    state[..., 2:] /= half_width
    for array in (intensity, state):
        array.flags.writeable = False
    if load.ndim > 1:
        intensity, state = of_points(intensity), of_points(state)
    return RollerLoads(bearing.azimuth, intensity, state)


def _solved(
    bearing: RollerBearing,
    load: FloatArray,
    start: FloatArray,
    *,
    held: bool = False,
    near: bool = False,
) -> tuple[FloatArray, FloatArray, IntArray]:
    """What `solve_roller_loads` finds, of one point without its axis."""
    reach = side_by_side([bearing.half_width])[..., None]
    sizes = side_by_side([bearing.slice_width, bearing.diametral_clearance])
    count, rows, slices = points_in(vars(bearing).values()) or 1, bearing.rows, bearing.slices
    at, crown, own = (
        np.array(np.broadcast_to(table, (count, *shape)), order="C")
        for table, shape in (
            (bearing.slice_positions / reach, (rows, slices)),
            (bearing.crown, (slices,)),
            (sizes, (2,)),
        )
    )
    found: Any = solve_roller_loads(
        np.atleast_2d(load), np.atleast_2d(start), bearing.azimuth, at, crown, own,
        TOLERANCE, MAX_ITERATIONS, held, near,
    )  # fmt: skip
    intensity, state, steps = (it.reshape(load.shape[:-1] + it.shape[1:]) for it in found)
    return intensity, state, steps


def tilting_moments(
    bearing: RollerBearing,
    force: float,  # [N]
    tilt_x: float,  # In the plane of the axis and x. [rad]
    tilt_y: float,  # In that of the axis and y. [rad]
) -> tuple[float, float]:
    """Moments that hold the outer race tilted under a radial force along x. Theory (B10). [N m]

    Raises `ConvergenceError` if the balance of forces is not found.
    """
    half_width = bearing.half_width
    load = np.array([force, 0.0, 0.0, 0.0])
    start = _start(bearing, load)
    start[2:] = tilt_x * half_width, tilt_y * half_width
    intensity, _, iterations = _solved(bearing, load, start, held=True)
    if iterations < 0:
        raise ConvergenceError(
            "the load distribution of the planet bearing was not found under "
            f"{NEWTON.text(force, 4)} with tilts of {tilt_x:.4g} and {tilt_y:.4g} rad; "
            "check roller length and clearance."
        )
    positions, azimuth = bearing.slice_positions, bearing.azimuth
    turning = (intensity * bearing.slice_width * positions[:, None, :]).sum(axis=(0, 2))
    return float(turning @ np.cos(azimuth)), float(turning @ np.sin(azimuth))


def radial_stiffness(bearing: RollerBearing, force: float) -> float:
    """Stiffness dF/ddelta of a bearing under `force` without moment. Theory (S7). [N/m]"""
    middle = max(force, LEAST_FORCE)
    low, high = ((1 + sign * STIFFNESS_STEP) * middle for sign in (-1, 1))
    closer, farther = (
        roller_loads(bearing, load, 0.0, 0.0, 0.0).displacement[0] for load in (low, high)
    )
    return float((high - low) / (farther - closer))


def _start(bearing: RollerBearing, load: FloatArray) -> FloatArray:
    """A displacement that closes the clearance in the direction of the force."""
    start = np.zeros_like(load)
    radial = np.hypot(load[..., :1], load[..., 1:2])
    closed = bearing.diametral_clearance / 2 + FIRST_APPROACH
    start[..., :2] = load[..., :2] / np.where(radial > 0, radial, 1.0) * closed
    return start


def mixed_ehl_rolling_loss(
    bearing: RollerBearing,
    loads: RollerLoads,
    speed: float,
    oil: OilState,
    *,
    oil_held: bool = True,
) -> BearingLoss:
    """P_mb = w sum P_WD over the loaded slices. Talbot (2012), Eq. 3.5 and 3.6. [W]

    Theory (B13), (B15). As printed, one evaluation for each loaded slice; with the radius of the
    outer race, the reading that reproduces the published effects of roughness and size. Conditions
    outside Table 3.1 are held at its limits; the loss beyond them is that of `beyond_data`. Without
    `oil_held` the formula is continued beyond its oil.
    """
    carried = _carried(loads)
    if carried.size == 0 or speed == 0:
        return BearingLoss(0.0)
    modulus, radius = bearing.equivalent_modulus, bearing.outer_radius
    rolling = bearing.rolling_speed(speed)
    viscosity, alpha = oil.dynamic_viscosity, oil.pressure_viscosity
    if oil_held:
        viscosity = held_in_range(viscosity, VISCOSITY_RANGE)
        alpha = held_in_range(alpha, PRESSURE_VISCOSITY_RANGE)
    alike = np.ones_like(carried)
    held_pressure = held_in_range(hertz_pressure(carried, radius * alike, modulus), _PRESSURE)
    held_radius, held_speed = held_in_range(radius, _RADIUS), held_in_range(rolling, _SPEED)
    rough = held_in_range(hypot(bearing.race_roughness, bearing.roller_roughness), _COMPOSITE)
    numbers = held_speed, viscosity, alpha, held_radius, rough, modulus
    density = row_by_row(needle_rolling_loss_at, [held_pressure], numbers)
    held_load = line_load_at_pressure(held_pressure, held_radius * alike, modulus)
    local = bearing.slice_width * density * beyond_data(carried, held_load, rolling, held_speed)
    return BearingLoss(total(local), Flags(AtOnce(_flags, bearing, carried, speed, oil, local)))


def _flags(
    bearing: RollerBearing, carried: FloatArray, speed: float, oil: OilState, local: FloatArray
) -> tuple[ValidityFlag, ...]:
    """Flags of `mixed_ehl_rolling_loss`, with its loss at every slice."""
    contacts = _contacts(bearing, carried, speed, oil, (bearing.outer_radius,))
    use = ModelUse("bearing", "mixed-ehl", "planet bearing")
    return check_contacts(use, NEEDLE_RANGES, contacts, local)


def fitted_rolling_loss(
    bearing: RollerBearing,
    loads: RollerLoads,
    speed: float,
    oil: OilState,
    model: FittedRolling,
    beyond: BearingLoss | None = None,  # That of Palmgren, which takes over beyond the simulations.
    *,
    alone: bool = False,  # True of rollers under less than any simulated load: (R5) is theirs.
) -> BearingLoss:
    """Rolling loss of the contacts of all rollers with both races, fitted to simulated ones. [W]

    Theory (O9), (O11). What was simulated is one contact, and a roller has two; the published
    formula is evaluated once for a slice, as its source does.
    """
    radii = bearing.outer_radius, bearing.inner_radius
    contacts = _contacts(bearing, _carried(loads), speed, oil, radii)
    if contacts is None:
        return BearingLoss(0.0)
    local = bearing.slice_width * model.loss_density(contacts)
    whole = total(local)
    if beyond is None:
        use = ModelUse("bearing", model.name, "planet bearing")
        flags = Flags(AtOnce(check_contacts, use, model.ranges, contacts, local))
        return BearingLoss(whole, flags)
    domain = model.model.fits[model.quantity].domain
    weighed = contacts.held({"hertz_pressure": domain["hertz_pressure"]}) if alone else contacts
    within = total(weight_of_fit(model.model, model.quantity, weighed) * local)
    share = either(within == whole, 1.0, within / larger(whole, TINY))
    use = ModelUse("bearing", FITTED_OR_PALMGREN, "planet bearing", instead="palmgren")
    flags = Flags(
        AtOnce(check_contacts, use, model.ranges, contacts, local),
        partial(_beyond_flags, share, beyond.flags),
    )
    return BearingLoss(within + (1 - share) * beyond.loss, flags, share)


def _beyond_flags(share: float, flags: SomeFlags) -> SomeFlags:
    """The flags of the loss that takes over, where it does."""
    return flags if share < 1 else ()


def _carried(loads: RollerLoads) -> FloatArray:
    """Load of each loaded slice; of several points of each that is loaded at any. [N/m]"""
    if isinstance(loads.intensity, Points):
        each = loads.intensity.reshape(len(loads.intensity), -1)
        return each[:, np.asarray(each > 0).any(axis=0)]
    return loads.intensity[loads.intensity > 0]


def _contacts(
    bearing: RollerBearing,
    carried: FloatArray,  # Load of each slice, at each point. [N/m]
    speed: float,
    oil: OilState,
    radii: tuple[float, ...],
) -> RaceContacts | None:
    """The loaded slices with races of some equivalent radii; None without load or motion."""
    if carried.size == 0 or speed == 0:
        return None
    load = np.concatenate([carried] * len(radii), axis=-1).view(type(carried))
    rolling = bearing.rolling_speed(speed)
    return RaceContacts(
        line_load=load,
        radius=np.repeat(side_by_side(radii), carried.shape[-1], axis=-1),
        rolling_speed=rolling * np.ones_like(load),
        sliding_speed=np.zeros_like(load),
        flanks=Flanks(bearing.equivalent_modulus, bearing.race_roughness, bearing.roller_roughness),
        oil=oil,
        races=radii,
        speed=rolling,
    )


def centrifugal_forces(
    bearing: RollerBearing,
    azimuth: FloatArray,  # Of rollers, from the load. [rad]
    density: float,  # Of a roller. [kg/m^3]
    pin_radius: float,  # From the axis of the set to that of the pin. [m]
    carrier: float,  # Speed of the carrier. [rad/s]
    speed: float,  # Speed of the planet against the carrier. [rad/s]
    outward: float,  # Azimuth that points away from the axis of the set. [rad]
) -> FloatArray:
    """Force of each roller away from the pin; a negative one presses it on the pin. [N]

    Theory (B20). Rollers turn around the pin with their cage, and with the carrier.
    """
    cage = carrier + speed / 2 * (1 + bearing.roller_diameter / bearing.pitch_diameter)
    orbit = pin_radius * carrier**2 * np.cos(outward - azimuth)
    return bearing.roller_mass(density) * (orbit + bearing.pitch_diameter / 2 * cage**2)


def pressed_alone(loads: RollerLoads, forces: FloatArray, length: float) -> RollerLoads:
    """Rollers pressed on one race over their `length`, by what of `forces` exceeds their load."""
    over = side_by_side([length])[..., None]
    carried = loads.intensity.mean(axis=-1) * over
    alone = np.maximum(np.abs(forces)[..., None, :] - carried, 0.0) / over
    return replace(loads, intensity=alone[..., None])


@dataclass(frozen=True, slots=True)
class Rubbing:
    """What the rollers of a bearing without a cage lose beside rolling."""

    play: float  # Way that all rollers of a row have together around the pitch circle. [m]
    touching: int  # Pairs of rollers that press each other, of all rows.
    force: float  # Largest force between two rollers. [N]
    skew: float  # To which the play lets a roller turn. [rad]
    between: float  # Sliding of rollers on each other. [W]
    skewed: float  # Sliding of loaded rollers along the axis. [W]


def rubbing(
    bearing: RollerBearing,
    loads: RollerLoads,
    speed: float,
    oil: OilState,
    pull: float,  # With which the carrier pulls each roller outward. [N]
    outward: float,  # Azimuth of that pull from the most loaded rollers. [rad]
) -> Rubbing:
    """Sliding of rollers without a cage. Theory (B21), (B23).

    Neighbours meet with opposite speeds, which draw no oil between them: boundary friction.
    """
    count, surface = bearing.rollers_per_row, bearing.rolling_speed(speed)
    step = 2 * math.asin(bearing.roller_diameter / bearing.pitch_diameter)
    play = max(0.0, 2 * math.pi - count * step) * bearing.pitch_diameter / 2  # (B21)
    along = pull * np.sin(outward - loads.azimuth)
    loaded = loads.intensity.sum(axis=2) > 0
    pressed = np.concatenate([_pressed(row, along, outward - loads.azimuth) for row in loaded])
    skew = 2 * play / (count * bearing.roller_length)  # (B23)
    skewed = 0.0
    carrying = loads.intensity[loads.intensity > 0]
    for radius in (bearing.inner_radius, bearing.outer_radius) if carrying.size and speed else ():
        contacts = LineContacts(
            line_load=carrying,
            radius=np.full_like(carrying, radius),
            rolling_speed=np.full_like(carrying, surface),
            sliding_speed=np.full_like(carrying, skew * surface),
            flanks=Flanks(
                bearing.equivalent_modulus, bearing.race_roughness, bearing.roller_roughness
            ),
            oil=oil,
        )
        friction = mixed_friction(contacts, RUN_IN)
        skewed += float(friction @ carrying) * bearing.slice_width * skew * surface
    return Rubbing(
        play,
        int(np.count_nonzero(pressed > LEAST_FORCE)),
        float(pressed.max(initial=0.0)),
        skew,
        oil.boundary_friction * float(pressed.sum()) * 2 * surface,
        skewed,
    )


def _pressed(loaded: BoolArray, along: FloatArray, angle: FloatArray) -> FloatArray:
    """Forces between the rollers of a row. Theory (B22). [N]

    Loaded rollers are held by their races. Between them the others lean on each other, and part
    where nothing presses them together. Without any load the chain parts farthest from the pull.
    """
    first = int(np.argmax(loaded)) if loaded.any() else int(np.argmin(np.cos(angle)))
    held, own = np.roll(loaded, -first), np.roll(along, -first)
    ends = np.flatnonzero(held)
    starts = ends if ends.size else np.array([-1])
    found = []
    for start, end in zip(starts, [*starts[1:], loaded.size], strict=True):
        summed = np.concatenate([[0.0], np.cumsum(own[start + 1 : end])])
        found.append(summed - summed.min())
    return np.concatenate(found)


def palmgren_loss(coefficient: float, force: float, pitch_diameter: float, speed: float) -> float:
    """P_mb = f1 F_r d_m omega. Talbot (2012), Eq. 3.1, after Palmgren, Harris. Theory (B16). [W]"""
    return coefficient * force * pitch_diameter * abs(speed)


def palmgren_flags(
    bearing: RollerBearing, loads: RollerLoads, speed: float
) -> tuple[ValidityFlag, ...]:
    """Flags of `palmgren_loss` on the most loaded slice, at the inner race."""
    if speed == 0:
        return ()
    highest = float(loads.intensity.max())
    values: dict[str, FloatArray | float] = {
        "hertz_pressure": hertz_pressure(highest, bearing.inner_radius, bearing.equivalent_modulus),
        "speed_parameter": speed_parameter(speed, bearing.pitch_diameter),
    }
    return check_ranges(ModelUse("bearing", "palmgren", "planet bearing"), PALMGREN_RANGES, values)
