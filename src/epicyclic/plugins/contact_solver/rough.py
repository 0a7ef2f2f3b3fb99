"""Transient contact of two moving rough surfaces: averages of friction, contact and film."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass, field
from epicyclic.errors import Status
from epicyclic.oil.rheology import DEFAULT, PRESETS
from epicyclic.plugins.contact_solver.conditions import Heating, LineContact, flow_easing, thinning
from epicyclic.plugins.contact_solver.kernels_linear import groups_for
from epicyclic.plugins.contact_solver.kernels_rough import Column, march, masses
from epicyclic.plugins.contact_solver.kernels_steady import deflection_matrix
from epicyclic.plugins.contact_solver.steady import SmoothSolution, expected_film, solve_smooth
from epicyclic.plugins.contact_solver.surfaces import SMOOTH, Profile
from epicyclic.units import percent

# Means over time of a rough contact, aided by the same contact on a coarse grid.
#
# Which ridges happen to meet makes most of the scatter of a rough contact, and a coarse grid sees
# the same ridges at a tenth of the cost. So a short simulation tells how the fine grid differs from
# the coarse one, and a long one on the coarse grid alone averages over the roughness: a regression
# estimator, as in multilevel Monte Carlo methods. The mean is that of the fine grid whatever the
# coarse one is worth; only the error depends on it.

GROWTH = 1.5
"""Largest growth of the number of fine blocks between looks at the error: an early look tells
little of how many it takes. [1]"""
SOME_MORE = 1.05  # Growth of both numbers where the error is hardly larger than wanted. [1]
LAGS = 2  # Blocks that follow one another and are alike: a ridge stays for that long. [1]
RUN, FEWEST_RUNS = 8, 16
"""Blocks of a run, which shares little with the next, and runs from which a variance is found."""
STUDENT = 0.6
"""Student's t at one standard error is 1 + 0.6/nu of the normal one with nu degrees of freedom,
within 2 % from two of them on. [1]"""
ROUNDING = 1e-20
"""Variation over the sum of squares of a coarse series that is nothing but rounding. [1]"""
MOST_AID = 32  # Blocks on the coarse grid for each on the fine one at most. [1]


class Estimate(NamedTuple):
    """A mean, and where its error comes from. Theory (H34), (H35)."""

    value: float
    # Variances over a block of what the coarse grid does not explain, widened for a small sample,
    # and of what it does.
    own: float
    aid: float
    blocks: int  # Numbers of blocks on the fine and on the coarse grid.
    aid_blocks: int  # Numbers of blocks on the fine and on the coarse grid.

    @property
    def error(self) -> float:
        """Standard error of the mean."""
        explained = self.aid / self.aid_blocks if self.aid_blocks else 0.0
        return math.sqrt(self.own / self.blocks + explained)

    def within(self, tolerance: float) -> bool:
        """The error is at most `tolerance` times the mean."""
        return self.error <= tolerance * self.value


class Plan(NamedTuple):
    """Numbers of blocks on the fine and on the coarse grid."""

    blocks: int
    aid_blocks: int


def aided_mean(
    fine: FloatArray,  # Means over blocks.
    # Means of the same blocks on the coarse grid, and of those that follow; none if m < n.
    coarse: FloatArray,
) -> Estimate:
    """Mean of `fine`, from its blocks and the longer series of the coarse grid.

    Theory (H34), (H35).

    Examples
    --------
    >>> fine, coarse = np.array([1.0, 3.0, 2.0]), np.array([1.5, 3.5, 2.5, 4.5, 4.5])
    >>> round(aided_mean(fine, coarse).value, 6)
    2.8
    """
    count, aid_count = fine.size, coarse.size
    if not np.isfinite(fine).all():
        return Estimate(math.nan, math.nan, 0.0, count, 0)
    value, same, power, steady = float(fine.mean()), np.zeros(count), 0.0, True
    if aid_count >= count and np.isfinite(coarse).all():
        same = coarse[:count] - coarse[:count].mean()
        power = float(same @ same)
        steady = power <= ROUNDING * float(coarse @ coarse)
    if steady:
        return Estimate(value, _variance(fine, 1) * _widening(count - 1), 0.0, count, 0)
    slope = float(fine @ same) / power
    away = float(coarse.mean() - coarse[:count].mean())
    value += slope * away
    by_slope = 1 + count * away**2 / power
    own = _variance(fine - slope * same, 2) * _widening(count - 2) * by_slope
    return Estimate(value, own, slope**2 * _variance(coarse, 1), count, aid_count)


def _variance(blocks: FloatArray, fitted: int) -> float:
    """Variance of a block, with what it shares with the next: a ridge crosses the contact in four.

    `fitted` numbers were found from the blocks. Many of them tell what neighbours share also where
    it is less than nothing, which a few would only seem to tell.
    """
    if blocks.size < FEWEST_RUNS * RUN:
        rest = blocks - blocks.mean()
        shared = sum(max(0.0, float(rest[lag:] @ rest[:-lag])) for lag in range(1, LAGS + 1))
        return (float(rest @ rest) + 2 * shared) / max(1, blocks.size - fitted)
    runs: FloatArray = blocks[blocks.size % RUN :].reshape(-1, RUN).mean(axis=1)
    rest = runs - runs.mean()
    own, next_ = float(rest @ rest), float(rest[1:] @ rest[:-1])
    return RUN * (own + 2 * max(next_, -own / 8)) / (runs.size - fitted)


def _widening(freedom: int) -> float:
    """Factor on the variance of a mean, because the scatter is known from a few blocks only.

    Neighbours are alike: two blocks tell of it as much as one.
    """
    return (1 + STUDENT / max(freedom / 2, 1)) ** 2


def next_plan(
    estimate: Estimate,  # Estimate of what has been simulated.
    tolerance: float,  # Wanted error over the mean.
    cost: float,  # Cost of a block on the coarse grid, over that of one on the fine grid. [1]
    most: int,  # Blocks on the fine grid.
) -> Plan:
    """How many blocks to have before the next look at the error. Theory (H36).

    Examples
    --------
    >>> next_plan(Estimate(1.0, own=0.01, aid=0.04, blocks=8, aid_blocks=8), 0.05, 0.1, 64)
    Plan(blocks=8, aid_blocks=32)
    """
    _, own, aid, blocks, aid_blocks = estimate
    wanted = (tolerance * estimate.value) ** 2
    if wanted == 0:
        return Plan(min(most, math.ceil(GROWTH * blocks)), aid_blocks)
    cheapest = math.sqrt(own) * (math.sqrt(own) + math.sqrt(cost * aid)) / wanted
    more = min(most, math.ceil(min(max(cheapest, blocks), GROWTH * blocks)))
    if aid == 0:
        return Plan(more, 0)
    left = wanted - own / more
    if blocks == most and left <= 0:  # no series on the coarse grid is long enough
        return Plan(blocks, aid_blocks)
    # towards numbers not reached yet both grow in the cheapest proportion
    needed = more * math.sqrt(aid / (cost * own)) if more < cheapest else aid / left
    highest = MOST_AID * more
    aided = math.ceil(min(max(needed, more, aid_blocks), highest))
    if more == blocks and aided == aid_blocks:  # the scatter of a small sample stands in the way
        longer, aided = (math.ceil(SOME_MORE * number) for number in (blocks, aid_blocks))
        return Plan(min(most, longer), min(aided, highest))
    return Plan(more, aided)


NODES = 512  # Nodes by default: some 125 in a half-width.
TOLERANCE = 1e-2
"""Largest change of a pressure in the last Newton step of a time step, over the largest pressure or
p_h; what is left is its square, or the share of it that the linear system leaves. [1]"""
LINEAR_TOLERANCE, COARSE_LINEAR_TOLERANCE = 0.1, 0.3
"""Residual of the linear system of a Newton step over its start. 0.3 raises the friction on the
fine grid by up to 0.7 %; on the coarse one, an aid to the averages, that does not matter. [1]"""
MAX_ITERATIONS = 40  # Newton steps of a time step, doubled in a second attempt.
STILL, GRID_GROWTH, SETTLING = 2.0, 1.0, 2.0
"""Times b/u_r in which the smooth contact settles on the grid, in which the roughness grows, and
until averages begin. [1]"""
LEAD = 1.0
"""Last part of these times in which the fine grid settles, from what roughness adds on the coarse
one. [1]"""
BLOCK, FEWEST_BLOCKS, MOST_BLOCKS = 0.5, 8, 1024
"""Time of a block in b/u_r, fewest blocks of an average, most times b/u_r of one."""
FEWEST_COARSE_NODES, COARSE_SPACING = 96, 0.3
"""Fewest nodes of the grid that aids the averages, and their distance over the correlation length
of the roughness; at most half of the nodes. [1]"""
COST_EXPONENT = 1.3
"""The time of a step rises with this power of the number of nodes, measured from 96 nodes of a
coarse grid to 768 of a fine one: 1.2 to 1.45. [1]"""
BRIEF = 64  # Number of blocks where many contacts are solved and the error of each is weighed.
FINEST_FEATURE = 0.2
"""Largest way of a surface in a time step, over the correlation length of its roughness. [1]"""
MOST_NODES_A_STEP = 4
"""Nodes by which the oil moves in a time step at most: 1/32 of a half-width by default."""
STATIONARY = 0.02
"""Standard error of the mean friction over it at which a simulation ends by default. [1]"""
LARGEST_UNSOLVED_SHARE = 0.01
"""Share of time steps without convergence above which a result is failed. [1]"""
MOST_FRAMES = 60  # Moments kept at most, the last ones.


@dataclass(frozen=True, slots=True)
class AsperityContact:
    """Where surfaces touch, and their friction there. Theory (H23)."""

    # Film below which boundary layers and roughness finer than a stylus resolves carry the load:
    # thinner films than the default do not converge on a grid. [m]
    film: float = PRESETS[DEFAULT].film
    friction: float = PRESETS[DEFAULT].friction  # Shear stress over pressure where they touch. [1]


@dataclass(frozen=True, eq=False)
class Frame:
    """One moment of a simulation. Time in s, pressure [Pa] and film [m] of shape (n,)."""

    time: float
    pressure: FloatArray
    film: FloatArray


@dataclass(frozen=True, eq=False)
class RoughSolution:
    """Averages of a transient rough contact."""

    smooth: SmoothSolution  # The same contact without roughness, where the simulation starts.
    # Failed if the friction did not become stationary or too many steps had no solution.
    status: Status
    message: str  # Why it failed; empty if it did not.
    # What follows is of a simulation; without a smooth contact there is none.
    x: FloatArray = field(default_factory=lambda: np.empty(0))  # [m]
    # What heat takes off ln(mu) at each x. [1]
    thinned: FloatArray = field(default_factory=lambda: np.empty(0))
    # Coefficient at every step that counts. [1]
    friction: FloatArray = field(default_factory=lambda: np.empty(0))
    friction_coefficient: float = math.nan  # Mean, from the means of blocks. [1]
    friction_error: float = math.nan  # Standard error of the mean. [1]
    asperity_friction_share: float = math.nan  # Share of friction from touching surfaces. [1]
    contact_share: float = math.nan  # Touching length over 2 b_h. [1]
    asperity_load_share: float = math.nan  # Load on touching surfaces over W'. [1]
    minimum_film: float = math.nan  # Least film of all moments. [m]
    mean_least_film: float = math.nan  # Mean over all moments of the least film. [m]
    mean_central_film: float = math.nan  # Mean over all moments of the film at x = 0. [m]
    # Mean over all moments of the highest pressure; above the hardness of a surface it would yield,
    # and this solution be wrong there. [Pa]
    mean_highest_pressure: float = math.nan
    # Power per length of the pressure flow: mean and its standard error. [W/m]
    rolling_loss: float = math.nan
    rolling_loss_error: float = math.nan
    # Share of Rq that the grid resolves, of the surface that loses more. [1]
    roughness_kept: float = math.nan
    steps: int = 0  # Time steps in all.
    unsolved_steps: int = 0  # Those without convergence.
    frames: Sequence[Frame] = field(default_factory=list)  # The last moments, if asked for.


class _State(NamedTuple):
    """Scaled pressure and mass at each node, and the approach."""

    pressure: FloatArray
    mass: FloatArray
    approach: float


class _Simulation:
    """State of a simulation between calls of the kernel, in scaled units."""

    def __init__(
        self, smooth: SmoothSolution, surfaces: tuple[Profile, Profile], nodes: int,
        asperities: AsperityContact, frame_interval: float | None = None,
        heating: Heating | None = None, frozen: bool = False,
        linear_tolerance: float = LINEAR_TOLERANCE,
    ) -> None:  # fmt: skip
        contact = smooth.contact
        self.linear_tolerance, self.frozen = linear_tolerance, frozen
        self.smooth = smooth
        self.contact, self.asperities = contact, asperities
        self.boundary_friction = asperities.friction if contact.sliding_speed else 0.0
        easing = flow_easing(contact, heating)
        parabola = math.sqrt(2 * expected_film(contact, easing))
        inlet, outlet = -(1 + max(1.5, 3 * parabola)), 1 + max(0.5, 1.5 * parabola)
        self.x: FloatArray = np.linspace(inlet, outlet, nodes, dtype=np.float64)
        self.dx = float(self.x[1] - self.x[0])
        self.stride = _stride(contact, surfaces, self.dx * contact.half_width)
        fluid = contact.scaled_fluid(easing)
        self.fluid = fluid._replace(poiseuille=self.stride * fluid.poiseuille)
        reach = self.x - self.x[0]
        cell = np.array([-self.dx, 0.0, self.dx], dtype=np.float64)
        row = deflection_matrix(reach, cell)[:, 1]
        self.kernel_row = np.concatenate([row[::-1], row[1:]])

        x = smooth.x / contact.half_width
        known = smooth.pressure / contact.hertz_pressure
        self.pressure = np.interp(self.x, x, known)
        self.pressure[-1] = 0
        self.smooth_pressure = self.pressure.copy()
        rise = np.interp(self.x, x, smooth.temperature_rise)
        self.thinned = thinning(contact, heating, self.pressure * contact.hertz_pressure, rise)
        # the smooth pressure before the grid, and half a cell into it
        outside = np.append(x[x < inlet], [inlet, inlet + self.dx])
        upstream = np.append(np.interp(outside[:-1], x, known), 0.0)
        self.base = self.x**2 / 2 + deflection_matrix(self.x, outside) @ upstream
        self.load = math.pi / 2 - float(np.trapezoid(upstream[:-1], outside[:-1]))
        self.film = self.base + np.convolve(
            self.kernel_row, np.append(0.0, self.pressure[1:]), "valid"
        )
        center = float(np.interp(0, x, smooth.film)) / contact.film_scale
        self.approach = center - float(np.interp(0, self.x, self.film))
        self.film += self.approach
        self.active = self.pressure > 0
        self.active[0] = self.active[-1] = False
        self.now = np.empty(nodes)
        masses(self.pressure, self.film, self.fluid, self.now)
        self.before = self.now.copy()
        self.groups = groups_for(nodes)
        spacing = self.dx * contact.half_width
        self.roughness_kept = min(surface.kept(spacing) for surface in surfaces)
        heights = [surface.resampled(spacing) / contact.film_scale for surface in surfaces]
        self.heights = [  # longer than their period, as the kernel wants them
            np.take(row, np.arange(-1, row.size + nodes + 1), mode="wrap") for row in heights
        ]
        moved = 0 if frozen else self.stride
        self.shifts = [
            moved * speed / contact.rolling_speed * row.size * spacing / surface.length
            for speed, row, surface in zip(
                (contact.speed1, contact.speed2), heights, surfaces, strict=True
            )
        ]
        self.steps = self.tried = self.unsolved = 0
        self.records: list[FloatArray] = []  # Of the blocks that count, and their means.
        self.means: list[FloatArray] = []
        self.frames: deque[Frame] = deque(maxlen=MOST_FRAMES)
        self.center = int(np.argmin(np.abs(self.x)))
        self.steps_to_frame = 0
        if frame_interval is not None:
            time = frame_interval * contact.rolling_speed / contact.half_width
            self.steps_to_frame = self.step_count(time)
        self.still = self.step_count(STILL)
        self.time = 0.0
        self.smooth_power = float(self.march(self.still)[-1, Column.FLOW_POWER])
        self.smooth_state = _State(self.pressure.copy(), self.now.copy(), self.approach)

    def add_block(self) -> None:
        """Another block of the averages."""
        self.records.append(self.advance(BLOCK))
        self.means.append(self.records[-1].mean(axis=0))

    def advance(self, time: float) -> FloatArray:
        """Records of a `time` in b/u_r, shape (steps, 9); keeps frames if they are asked for.

        What whole steps lack of one time is added to the next: grids stay in step.
        """
        self.time += time
        left = max(1, self.still + self.step_count(self.time) - self.steps)
        parts = []
        while left > 0:
            steps = min(left, self.steps_to_frame or left)
            parts.append(self.march(steps))
            left -= steps
            if self.steps_to_frame:
                self.frames.append(self.frame())
        return np.concatenate(parts)

    def go_on_from(self, other: _Simulation) -> None:
        """Take what roughness adds on another grid; the smooth state stays that of this one."""
        self.time = other.time
        self.steps = self.still + self.step_count(self.time)
        smooth, its = self.smooth_state, other.smooth_state
        added = np.interp(self.x, other.x, other.pressure - its.pressure)
        self.pressure[:] = np.maximum(smooth.pressure + added, 0.0)
        self.pressure[0], self.pressure[-1] = smooth.pressure[0], 0.0
        self.active[:] = self.pressure > 0
        self.active[0] = False
        self.now[:] = smooth.mass * np.interp(self.x, other.x, other.now / its.mass)
        self.before[:] = self.now
        self.approach = smooth.approach + other.approach - its.approach

    def march(self, steps: int) -> FloatArray:
        """Records of `steps` more time steps, shape (steps, 9)."""
        records = np.zeros((steps, len(Column)))
        scale = self.contact.film_scale
        self.approach = march(
            self.pressure, self.film, self.now, self.before, self.active, self.approach,
            self.smooth_pressure, self.base, self.kernel_row, self.groups,
            self.heights[0], self.heights[1], self.shifts[0], self.shifts[1], self.stride,
            self.center, self.steps - self.still, self.step_count(GRID_GROWTH), self.fluid,
            self.thinned, self.dx, self.load,
            self.asperities.film / scale, self.boundary_friction, TOLERANCE, self.linear_tolerance,
            MAX_ITERATIONS, records,
        )  # fmt: skip
        self.steps += steps
        self.tried += steps
        self.unsolved += int((~(records[:, Column.ERROR] < TOLERANCE)).sum())
        return records

    @property
    def work(self) -> float:
        """Work of a time b/u_r, in a unit of its own."""
        return math.pow(self.x.size, COST_EXPONENT) / (self.stride * self.dx)

    def step_count(self, time: float) -> int:
        """Time steps in `time`, in b/u_r."""
        return max(1, round(time / (self.stride * self.dx)))

    def frame(self) -> Frame:
        """This moment."""
        contact = self.contact
        way = self.steps * self.stride * self.dx * contact.half_width
        return Frame(
            way / contact.rolling_speed,
            self.pressure * contact.hertz_pressure,
            self.film * contact.film_scale,
        )


def _stride(contact: LineContact, surfaces: Sequence[Profile], spacing: float) -> int:
    """Nodes by which the oil may move in a time step without missing any roughness."""
    ways = [
        FINEST_FEATURE * surface.correlation_length * contact.rolling_speed / speed
        for surface, speed in zip(surfaces, (contact.speed1, contact.speed2), strict=True)
        if surface.rms > 0 and speed > 0
    ]
    return max(1, min([MOST_NODES_A_STEP, *(int(way / spacing) for way in ways)]))


def solve_rough(
    contact: LineContact,
    surface1: Profile = SMOOTH,  # Moving with the speeds of the contact.
    surface2: Profile = SMOOTH,  # Moving with the speeds of the contact.
    asperities: AsperityContact | None = None,
    nodes: int = NODES,
    frame_interval: float | None = None,  # Time between kept moments; none are kept by default. [s]
    # Isothermal without; with it the film has the temperature of the smooth contact.
    heating: Heating | None = None,
    # Hold the roughness still where it is and let the oil flow past: the steady rough contact.
    frozen: bool = False,
    # Times b/u_r after which it is given up if the friction is still not known.
    most_blocks: int = MOST_BLOCKS,
    # Standard error of the mean friction over it at which it is known. [1]
    tolerance: float = STATIONARY,
    # Called with the numbers of blocks done and expected.
    progress: Callable[[int, int], None] | None = None,
) -> RoughSolution:
    """Simulate until the mean friction is known well enough. Theory (H21), (H25)."""
    smooth = solve_smooth(contact, heating=heating)
    if smooth.status is not Status.CONVERGED:
        return RoughSolution(smooth, Status.FAILED, f"the smooth contact: {smooth.message}")
    surfaces = (surface1, surface2)
    asperities = asperities or AsperityContact()
    run = _Simulation(smooth, surfaces, nodes, asperities, frame_interval, heating, frozen)
    coarse = _coarse_nodes(run, surfaces)
    aid = _Simulation(
        smooth, surfaces, coarse, asperities, None, heating, frozen,
        linear_tolerance=COARSE_LINEAR_TOLERANCE,
    )  # fmt: skip
    _settle(run, aid)
    most = math.ceil(most_blocks / BLOCK)
    plan = Plan(fewest := min(FEWEST_BLOCKS, most), fewest)
    while True:
        for grid, wanted in zip((run, aid), plan, strict=True):
            while len(grid.means) < wanted:
                grid.add_block()
                if progress is not None and grid is run:
                    progress(len(grid.means), wanted)
        means = _means(run, aid)
        judged = means.friction if contact.sliding_speed else means.rolling
        if not math.isfinite(judged.value) or judged.within(tolerance):
            break
        before, plan = plan, next_plan(judged, tolerance, aid.work / run.work, most)
        if plan == before:
            break
    return _solution(run, means, _failure(run, judged, tolerance))


def _coarse_nodes(run: _Simulation, surfaces: Sequence[Profile]) -> int:
    """Nodes of the grid that aids the averages of a simulation."""
    finest = min((s.correlation_length for s in surfaces if s.rms > 0), default=math.inf)
    span = float(run.x[-1] - run.x[0]) * run.contact.half_width
    wanted = math.ceil(span / (COARSE_SPACING * finest))
    return min(max(wanted, FEWEST_COARSE_NODES), run.x.size // 2)


def _settle(run: _Simulation, aid: _Simulation) -> None:
    """Up to where averages begin, on the fine grid and on the coarse one."""
    aid.advance(GRID_GROWTH + SETTLING - LEAD)
    if run.frozen:  # the end is wanted, not an average
        run.advance(GRID_GROWTH + SETTLING - LEAD)
    else:
        run.go_on_from(aid)
    for each in (run, aid):
        each.advance(LEAD)


@dataclass(frozen=True, slots=True)
class _Means:
    """Averages in time, scaled but for the rolling loss; `rest` by `Column`."""

    friction: Estimate
    rolling: Estimate
    rest: Sequence[float]


def _means(run: _Simulation, aid: _Simulation) -> _Means:
    """Averages from both grids; of the rolling loss the smooth one and what roughness adds."""
    on, by, contact = np.array(run.means), np.array(aid.means), run.contact
    power = contact.hertz_pressure * contact.film_scale * contact.rolling_speed
    smooth = run.smooth.rolling_loss
    flow, flow_by = on[:, Column.FLOW_POWER] - run.smooth_power, by[:, Column.FLOW_POWER]
    return _Means(
        aided_mean(_shear(on), _shear(by)),
        aided_mean(smooth + power * flow, power * flow_by),
        [aided_mean(on[:, column], by[:, column]).value for column in Column],
    )


def _failure(run: _Simulation, judged: Estimate, tolerance: float) -> str:
    """Why there is no result to rely on; empty if there is."""
    if not math.isfinite(judged.value):
        return "a time step failed"
    if not judged.within(tolerance):
        what = "friction" if run.contact.sliding_speed else "rolling loss"
        share = judged.error / abs(judged.value)
        return (
            f"{what} reaches an uncertainty of {percent(share)} only after {run.tried} time steps"
        )
    if run.unsolved > LARGEST_UNSOLVED_SHARE * run.tried:
        return f"{run.unsolved} of {run.tried} time steps did not converge"
    return ""


def _shear(records: FloatArray) -> FloatArray:
    """Integral of the shear stress at every step, shape (steps,)."""
    total: FloatArray = records[:, Column.FLUID_SHEAR] + records[:, Column.ASPERITY_SHEAR]
    return total


def _solution(run: _Simulation, means: _Means, message: str) -> RoughSolution:
    contact = run.contact
    load = math.pi / 2
    records, mean, shear = np.concatenate(run.records), means.rest, means.friction
    touching = mean[Column.ASPERITY_SHEAR] / shear.value if shear.value > 0 else 0.0
    return RoughSolution(
        smooth=run.smooth,
        status=Status.FAILED if message else Status.CONVERGED,
        message=message,
        x=run.x * contact.half_width,
        thinned=run.thinned,
        friction=_shear(records) / load,
        friction_coefficient=shear.value / load,
        friction_error=shear.error / load,
        asperity_friction_share=touching,
        contact_share=mean[Column.CONTACT_SHARE],
        asperity_load_share=mean[Column.ASPERITY_LOAD] / load,
        minimum_film=float(records[:, Column.LEAST_FILM].min()) * contact.film_scale,
        mean_least_film=mean[Column.LEAST_FILM] * contact.film_scale,
        mean_central_film=mean[Column.CENTRAL_FILM] * contact.film_scale,
        mean_highest_pressure=mean[Column.HIGHEST_PRESSURE] * contact.hertz_pressure,
        rolling_loss=means.rolling.value,
        rolling_loss_error=means.rolling.error,
        roughness_kept=run.roughness_kept,
        steps=run.tried,
        unsolved_steps=run.unsolved,
        frames=list(run.frames),
    )
