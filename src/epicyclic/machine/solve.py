"""Losses and torques of a machine that agree, and the power that each part of it takes."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, reduce
from operator import and_
from typing import Any, NamedTuple, cast

import numpy as np

from epicyclic.arrays import (
    TINY,
    Alone,
    Apart,
    BoolArray,
    Each,
    FloatArray,
    Points,
    apart,
    either,
    every,
    isfinite,
    joined,
    larger,
    largest,
    one_by_one,
    part_of_each,
    side_by_side,
    taken,
)
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import ConvergenceError, EpicyclicError, is_interrupt
from epicyclic.machine.balance import (
    NO_POWER,
    ROUNDING,
    Balance,
    Directions,
    Friction,
    Statics,
    drives_first,
    find_directions,
    speeds_of,
)
from epicyclic.machine.element import (
    LOAD_DEPENDENT,
    Element,
    ElementResult,
    Fluids,
    Loss,
    State,
    joined_key,
)
from epicyclic.machine.machine import Machine, Operation, forces_of

# What elements have answered so far, and what they would answer to loads next to those.
#
# Losses and torques agree after some passes, each with a little other loads. A loss over the load
# that it follows is there so nearly a straight line that most passes need not ask its element
# again, or only for the parts of which that does not hold.


Losses = Mapping[str, Loss]
CAUTION = 2.0  # How much larger the error of predicted losses is taken to be than its estimate. [1]
STEEP, STEEPEST = 3.0, 10.0  # Power with which few losses rise with a load, and none. [1]
NEAR = 3e-5  # Change of a load over which the figures of an answer serve. [1]


@dataclass(frozen=True, slots=True)
class Answer:
    """The last answer of an element, and the one before."""

    pointwise = True

    loads: Mapping[str, float]  # As from `Element.loads`.
    result: ElementResult
    # None if there is none; the last one again for points whose loads or losses changed sides.
    before: Answer | None = None

    def predicted(
        self,
        loads: Mapping[str, float],
        allowed: float,  # Error of all losses together, relative. [1]
    ) -> tuple[Losses, frozenset[str]]:
        """Losses that the element would answer; the loads by which those that follow them serve.

        If all do, they are off by no more than `allowed` together. Figures and flags are those of
        the last answer, to loads no farther off than `NEAR`.
        """
        before, known = (self.before or self).result.losses, self.result.losses
        follows, bent = zip(*((loss.follows, loss.bent) for loss in known.values()), strict=True)
        alike = self.alike(loads, self.result)
        steps = {it: self._step(loads, it) for it in dict.fromkeys(follows)}
        step = _Step(*map(side_by_side, zip(*map(steps.get, follows), strict=True)))
        watts = side_by_side(loss.watts for loss in known.values())
        older = side_by_side(before[name].watts for name in known)
        with np.errstate(over="ignore", invalid="ignore"):  # of errors without bound
            errors = apart(CAUTION * step.error(watts, older, bent) * watts)
            # no prediction makes a loss negative
            line = apart(np.maximum(watts * (watts < 0), watts + step.part * (watts - older)))
        losses = {
            name: known[name]._replace(watts=own) for name, own in zip(known, line, strict=True)
        }
        off: dict[tuple[str, ...], Any] = {}
        for it, error in zip(follows, errors, strict=True):
            off[it] = off.get(it, 0.0) + error
        most = allowed * sum(loss.watts for loss in losses.values())
        near = {follows: alike & (step.size <= NEAR) for follows, step in steps.items()}
        holds = reduce(and_, near.values(), alike & (sum(off.values()) <= most))
        if every(holds):
            return losses, frozenset(loads)
        serve = {it: near[it] & (len(off) * error <= most) for it, error in off.items()}
        return losses, frozenset(key for it in serve if every(serve[it]) for key in it)

    def then(
        self, loads: Mapping[str, float], result: ElementResult, serve: frozenset[str]
    ) -> Answer:
        """The next answer; what follows the loads that `serve` is still that to the last ones."""
        own = {**loads, **{key: self.loads[key] for key in serve}}
        alike, old = self.alike(loads, result), self.before or self
        # no line leads through answers that are not alike, and what contacts were like nobody asks
        before = {key: (old if key in serve else self).loads[key] for key in loads}
        losses = _mixed(self.result.losses, old.result.losses, serve)
        older = Answer(
            {key: either(alike, load, own[key]) for key, load in before.items()},
            ElementResult(
                {
                    name: loss._replace(watts=either(alike, losses[name].watts, loss.watts))
                    for name, loss in result.losses.items()
                }
            ),
        )
        return Answer(own, result, older)

    def alike(self, loads: Mapping[str, float], result: ElementResult) -> Any:
        """Whether loads have the same signs, and losses act at the same places."""
        same: Any = all(
            (loss.mesh, loss.brakes)
            == (self.result.losses[name].mesh, self.result.losses[name].brakes)
            for name, loss in result.losses.items()
        )
        for key, load in loads.items():
            same = ((load * self.loads[key] > 0) | (load == self.loads[key])) & same
        return same

    def _step(self, loads: Mapping[str, float], follows: tuple[str, ...]) -> _Step:
        """From the last loads that losses follow to these, along the line from those before."""
        keys = follows or tuple(loads)
        before = (self.before or self).loads
        new, last, old = ([those[key] for key in keys] for those in (loads, self.loads, before))
        size = largest(new)
        ways = [one - two for one, two in zip(last, old, strict=True)]
        length = sum(way**2 for way in ways)
        moved = length > (ROUNDING * size) ** 2
        ahead = sum((one - two) * way for one, two, way in zip(new, last, ways, strict=True))
        part = ahead * moved / larger(length, TINY)
        on_line = [two + part * way for two, way in zip(last, ways, strict=True)]
        aside = _apart(on_line, new)
        beside = aside * (aside > ROUNDING) * moved
        return _Step(part, _apart(old, last) * moved, _apart(last, new), beside)


class _Step(NamedTuple):
    """A step of the loads along the line through the last two, or one for each of some losses."""

    part: Any  # How far it goes, over the step before. [1]
    before: Any  # Size of the step before, relative to the largest load. [1]
    size: Any  # Size of this one, likewise. [1]
    aside: Any  # How far it ends beside the line, relative. [1]

    def error(self, watts: FloatArray, older: FloatArray, bent: Sequence[float]) -> Any:
        """Estimate of the errors of losses on the lines through their `older` watts, relative.

        A loss goes with some power of its load, the slope of which bends the line, and which
        changes a little itself. What changed more than any power would, because it scatters or
        follows something else too, may change by as much again.
        """
        change = np.abs(watts - older) / np.maximum(np.abs(watts), TINY)
        power = change / np.maximum(self.before, TINY)
        bend = power * np.abs(power - 1) / 2 + bent
        smooth = bend * self.size * (self.before + self.size) + STEEP * self.aside
        error = np.where(power <= STEEPEST, smooth, change + STEEPEST * self.size)
        error = np.where((watts == 0) & (watts != older), math.inf, error * (watts != older))
        return np.where(self.before == 0, STEEP * self.size, error)


def _mixed(losses: Losses, others: Losses, serve: frozenset[str]) -> Losses:
    """Losses, but `others` of those that follow one of the loads that `serve`."""
    return {
        name: others[name] if serve.intersection(loss.follows) else loss
        for name, loss in losses.items()
    }


def _apart(old: list[float], new: list[float]) -> float:
    """Largest change of a load, relative to the largest load. [1]"""
    size = largest(new)
    return largest(two - one for one, two in zip(old, new, strict=True)) / larger(size, TINY)


AGREEMENT = 5e-10
"""Relative change of each load from one pass to the next at which torques and losses agree. [1]"""
PREDICTED = 0.1
"""Error of a predicted loss over the change of the loads from one pass to the next, at most: losses
are small beside powers, so that the error leaves less of the change than a pass does. [1]"""
LOSS_AGREEMENT = 1e-7
"""Error of predicted losses, at most, however little losses move the loads. [1]"""
LIKELY = 0.9985  # Efficiency of a mesh that the first pass begins with. [1]
PLAIN_PASSES, SECANTS = 15, 40
"""Passes in which loads follow the losses, and of a method of secants."""
SMALL_STEPS = ((0.5, 20), (0.2, 85))
"""Share of a step by which loads follow the losses before and after secants, and for how many
passes: losses that rise steeply from no load may throw a small load to and fro. [1]"""
MOST_TORQUE = 1e15
"""Torque at a mesh, far above what a case can state, from which losses and torques only drive each
other up. [N m]"""
MOST_BRANCHES = 8  # Directions of the rolling powers that are tried with the losses of elements.
FEWEST = 4  # Points from which on they are solved together: fewer take longer than one by one.
MOST_OF_A_MESH = 0.5
"""Share of the rolling power of a mesh up to which a loss is a share of it, else friction. [1]"""


@dataclass(frozen=True, slots=True)
class Solution:
    """A machine in balance."""

    pointwise = True

    speeds: Mapping[str, float]  # Of every body. [rad/s]
    torques: Mapping[str, float]  # From outside, on every body. [N m]
    couplings: Mapping[str, float]  # Torque through each clutch. [N m]
    # Torque that each mesh takes up at its first gear, at the load of its driving gear. [N m]
    meshes: Mapping[str, float]
    drives: Mapping[str, bool]  # For each mesh, True if its first gear drives it.
    # Rolling power of each mesh, positive if its first gear drives. [W]
    rolling: Mapping[str, float]
    results: Mapping[str, ElementResult]  # By the key of the element.
    given: Mapping[str, Loss]  # Losses of the meshes of given efficiency, by the key of the mesh.
    # Speed of the input over that of the output; None if that stands still. [1]
    ratio: float | None
    self_locking: bool  # True if the output must be driven too.
    jammed: bool  # True if the machine stands still, whatever the torque on the output.
    unique: bool  # False if meshes or clutches share a load in more than one possible way.
    # Meshes that next to no power passes: with the losses of either direction of the power it has
    # the other one, so that the teeth lie on neither flank.
    floating: frozenset[str]
    # Meshes of given efficiency whose teeth do not roll: friction holds them, either way.
    standing: frozenset[str]
    state: State  # That the elements saw.

    @property
    def losses(self) -> dict[str, Loss]:
        """Losses of all elements and meshes by their keys."""
        own = {
            joined_key(key, name): loss
            for key, result in self.results.items()
            for name, loss in result.losses.items()
        }
        return {**own, **self.given}

    @property
    def input_power(self) -> float:
        """Power that enters, at all shafts where it does. Theory (P5). [W]"""
        return sum(power for power in self._powers() if power > 0)

    @property
    def efficiency(self) -> float | None:
        """Power that leaves over power that enters. Theory (P6). [1]

        0 if the losses take all of it; None if no power enters.
        """
        entering = self.input_power
        if not entering:
            return 0.0 if self.jammed else None
        leaves = any(power < 0 for power in self._powers())
        lost = sum(loss.watts for loss in self.losses.values())
        return max(0.0, 1 - lost / entering) if leaves else 0.0

    @property
    def power_ratio(self) -> float | None:
        """Sum of the rolling powers of all meshes over the power that enters. Theory (T7). [1]"""
        entering = self.input_power
        return sum(map(abs, self.rolling.values())) / entering if entering else None

    def _powers(self) -> list[float]:
        """Powers of all bodies, without what is rounding. [W]"""
        powers = [torque * self.speeds[body] for body, torque in self.torques.items()]
        limit = NO_POWER * largest(powers)
        return [power for power in powers if abs(power) > limit]


def lossless_state(machine: Machine, operation: Operation, fluids: Fluids | None) -> State:
    """Speeds, and torques as without losses: what elements see first."""
    speeds = speeds_of(machine, operation.speeds)
    found = Statics(machine, operation, speeds).balance()
    forces = forces_of(machine.layouts, found.meshes)
    drives = drives_first(found.powers, dict.fromkeys(found.powers, True))
    return State(speeds, found.meshes, forces, cast(Fluids, fluids), lossless=True, drives=drives)


@dataclass(frozen=True, slots=True)
class Start:
    """What a solution starts from, whatever the oil."""

    statics: Statics
    lossless: Balance
    directions: Directions  # With the given efficiencies.
    ratio: float | None  # Speed of the input over that of the output. [1]
    efficiencies: Mapping[str, float]  # Given ones, 1 where teeth do not roll. [1]
    standing: frozenset[str]  # Meshes of given efficiency whose teeth do not roll.


def start_of(machine: Machine, operation: Operation) -> Start:
    """Speeds, torques without losses, and the directions of the rolling powers."""
    speeds = speeds_of(machine, operation.speeds)
    statics = Statics(machine, operation, speeds)
    lossless = statics.balance()
    efficiencies: dict[str, float] = {}
    standing: set[str] = set()
    moves = any(operation.speeds.values())
    for row in machine.rows:
        # teeth that do not roll lose nothing, as of a set that clutches lock or of a differential
        # straight ahead: friction may then act either way, or not at all
        stands = moves and row.efficiency < 1 and speeds[row.first] == speeds[row.carrier]
        efficiencies[row.key] = 1.0 if stands else row.efficiency
        if stands:
            standing.add(row.key)
    directions = find_directions(statics, lossless, efficiencies)
    output = speeds[operation.output]
    ratio = speeds[operation.input] / output if output else None
    if directions.jammed:  # it stands still, whatever the speeds were meant to be
        statics = Statics(machine, operation, dict.fromkeys(speeds, 0.0))
    return Start(statics, lossless, directions, ratio, efficiencies, frozenset(standing))


class Wanted(NamedTuple):
    """A solution that somebody asks for."""

    machine: Machine
    operation: Operation
    fluids: Fluids | None  # None if every loss is given.
    # That of `start_of`, kept for solutions that differ in the oil only.
    start: Callable[[], Start] | None = None
    earlier: Solution | None = None  # At nearly the same temperatures, to begin with.
    # False for the losses of the oil at the loads of `earlier`, or at those without losses, and the
    # loads that follow: they lag one pass behind, which is enough as long as temperatures change.
    whole: bool = True


def solve_machine(
    wanted: Wanted,
    trail: Trail | None = None,  # Filled; that of a block of which this is a part.
) -> tuple[Solution, bool]:
    """Torques and losses, and whether they agree. Theory (T5), (T6).

    Whole solutions also where losses decide the directions of powers. Raises `ConvergenceError` if
    losses and torques do not agree, or grow beyond all bounds.
    """
    machine, operation, fluids, begin, earlier, whole = wanted
    start = start_of(machine, operation) if begin is None else begin()
    trail = Trail() if trail is None else trail
    if not whole and (lagging := _one_pass(wanted, start, trail)):
        return lagging
    directions, powers = start.directions, start.lossless.powers
    drives = directions.drives
    branch = _Branch(machine, operation, start, fluids, trail, earlier, drives)
    if earlier is None:  # as the losses of one pass turn them
        drives = drives_first(branch.follow().powers, drives)
    else:
        one, other = (drives_first(powers, dict.fromkeys(powers, way)) for way in (True, False))
        undecided = {key for key in powers if one[key] != other[key]}
        drives = {**drives, **{key: earlier.drives[key] for key in undecided}}
    tried: list[Mapping[str, bool]] = []
    while drives not in tried and len(tried) < MOST_BRANCHES:
        tried.append(drives)
        branch = replace(branch, drives=drives, passes=0)
        last = _converged(branch)
        drives = drives_first(last.powers, drives)
    floating = frozenset(key for key, first in drives.items() if first != branch.drives[key])
    if floating:
        branch = replace(branch, braking=floating, passes=0)
        last = _converged(branch)
    if last.efficiencies != start.efficiencies and not directions.jammed:
        directions = find_directions(start.statics, start.lossless, last.efficiencies or {})
    return branch.solution(last, directions), True


def _one_pass(wanted: Wanted, start: Start, trail: Trail) -> tuple[Solution, bool] | None:
    """What is wanted that is not whole; None where losses decide the directions of powers."""
    machine, operation, fluids, _, earlier, _ = wanted
    drives, powers, braking = start.directions.drives, start.lossless.powers, frozenset[str]()
    led = drives_first(powers, {key: not first for key, first in drives.items()})
    if earlier is not None:
        drives, powers, braking = earlier.drives, earlier.rolling, earlier.floating
        led = drives_first(powers, drives)
    if any(led[key] != first for key, first in drives.items() if key not in braking):
        return None
    branch = _Branch(machine, operation, start, fluids, trail, earlier, drives, braking)
    found = branch.follow()
    return branch.solution(found, start.directions), found.efficiencies is not None


def _together(wanted: Sequence[Wanted]) -> Wanted:
    """Several solutions as one; raises `Apart` if they begin in different ways."""
    machine = joined([it.machine for it in wanted], part_of_each)
    operation = joined([it.operation for it in wanted])
    fluids = joined([replace(cast(Fluids, it.fluids), flags=()) for it in wanted])
    earlier = [it.earlier for it in wanted if it.earlier is not None]
    if not earlier:
        return Wanted(machine, operation, fluids, whole=wanted[0].whole)
    names = "meshes", "rolling", "drives", "floating"
    begun = {name: joined([getattr(it, name) for it in earlier]) for name in names}
    results = {
        key: ElementResult({}, loaded=joined([it.results[key].loaded for it in earlier], Each))
        for key in earlier[0].results
    }
    first = replace(earlier[0], results=results, **begun)
    return Wanted(machine, operation, fluids, None, first, wanted[0].whole)


def solve_machines(
    wanted: Sequence[Wanted],  # All whole, or none; all with `earlier`, or none.
    *,
    bare: bool = False,  # True if nobody reads more of the elements than their losses.
) -> list[tuple[Solution, bool] | Exception]:
    """As `solve_machine` has each of them, or what that raises."""
    found: dict[int, tuple[Solution, bool] | Exception] = {}
    left: list[tuple[Sequence[int], Trail]] = []
    if wanted:
        left.append((range(len(wanted)), Trail()))
    while left:
        rows, trail = left.pop()
        machine, _, fluids, *_ = wanted[rows[0]]
        several = (getattr(it, "several", False) for it in machine.elements)
        trails = [Trail() for _ in rows]
        if len(rows) < FEWEST or fluids is None or not all(several):
            if trail.known:
                trails = trail.parts(range(len(rows)))
        else:
            try:
                solution, agree = solve_machine(_together([wanted[row] for row in rows]), trail)
            except Apart as parting:
                left += _parted(rows, parting.rows, trail)
                continue
            except EpicyclicError:
                left += _parted(rows, np.arange(len(rows)) < len(rows) // 2, trail)
                continue
            except Exception as error:  # `Alone`, or what single points tell of themselves
                if is_interrupt(error):
                    raise KeyboardInterrupt from error
            else:
                results = solution.results
                if bare:
                    results = {key: ElementResult(it.losses) for key, it in results.items()}
                elif not (agree or wanted[rows[0]].whole):  # a step on the way
                    results = {key: replace(it, flags=(), notes=()) for key, it in results.items()}
                state = replace(solution.state, fluids=fluids, earlier={})
                one = replace(solution, results=results, state=state)
                each = taken(one, range(len(rows)), final=True)
                for row, own in zip(rows, each, strict=True):
                    state = replace(own.state, fluids=wanted[row].fluids)
                    found[row] = replace(own, state=state), agree
                continue
        for row, its in zip(rows, trails, strict=True):
            try:
                found[row] = solve_machine(wanted[row], its)
            except Exception as error:
                found[row] = error
    return [found[row] for row in range(len(wanted))]


def _parted(
    rows: Sequence[int], side: BoolArray, trail: Trail
) -> Iterator[tuple[Sequence[int], Trail]]:
    """The points of either side of a block, and how far they have come."""
    sides = [np.flatnonzero(~side), np.flatnonzero(side)]
    for places, its in zip(sides, trail.parts(sides), strict=True):
        yield [rows[place] for place in places.tolist()], its


@dataclass
class Trail:
    """What has been found so far: where a block parts, its parts go on from there."""

    # Torques after each pass of the block that parted, which this is to follow.
    ahead: list[Balance] = field(default_factory=list[Balance])
    passed: list[Balance] = field(default_factory=list[Balance])  # The same here.
    known: dict[str, _Known] = field(default_factory=dict[str, "_Known"])  # By key of the element.
    begun: Balance | None = None  # Torques that the pass under way began with.
    state: State | None = None  # That the elements saw last.

    def parts(self, rows: Sequence[Any]) -> list[Trail]:
        """That of each of some points, a number in `rows`, or of several, an array of them."""
        each = taken((self.passed, self.known, self.begun, self.state), rows)
        return [
            Trail(list(passed), [], dict(known), begun, state)
            for passed, known, begun, state in each
        ]


class _Known(NamedTuple):
    """What an element has answered: each pass goes on from it."""

    answer: Answer  # When it was last evaluated.
    # The last answer, which may be a predicted one, and the loads that it belongs to.
    result: ElementResult
    loads: Mapping[str, float]
    # Which of its gears drove then: pockets are others on the other flank.
    drives: Mapping[str, bool]


def _answered(
    element: Element,
    state: State,
    known: _Known | None,
    allowed: float,  # Relative error of predicted losses.
) -> _Known:
    """The answer of an element to a state: the last one, one predicted from it, or a new one."""
    drives = {key: it for key, it in state.drives.items() if key.startswith(f"{element.key}.")}
    last_one = None if known is None else known.result
    loads = element.loads(state, last_one)
    if known is None or not all(every(known.drives[key] == it) for key, it in drives.items()):
        result = element.evaluate(state, last_one)
        return _Known(Answer(loads, result), result, loads, drives)
    if _agrees(known.loads, loads):
        return known
    passed = _apart([known.loads[key] for key in loads], [*loads.values()])
    last = known.answer
    predicted, serve = last.predicted(loads, larger(allowed, PREDICTED * passed))
    if serve >= loads.keys():
        return _Known(last, replace(last.result, losses=predicted), loads, drives)
    result = element.evaluate(replace(state, serve=serve), known.result)
    whole = replace(result, losses=_mixed(result.losses, predicted, serve))
    return _Known(last.then(loads, result, serve), whole, loads, drives)


@dataclass
class _Branch:
    """One choice of the directions of the rolling powers."""

    machine: Machine
    operation: Operation
    start: Start
    fluids: Fluids | None
    trail: Trail  # What has been found so far.
    earlier: Solution | None  # Whose loads and results it begins with.
    drives: Mapping[str, bool]  # For each mesh, True if its first gear drives it.
    # Meshes whose losses are friction, whichever gear drives.
    braking: frozenset[str] = frozenset()
    passes: int = 0  # So far.

    @cached_property
    def unlost(self) -> Balance:
        """Torques with no losses but given ones."""
        given = self.start.efficiencies
        if all(efficiency == 1 for efficiency in given.values()):
            return self.start.lossless
        return self.start.statics.balance(self.drives, given)

    @property
    def results(self) -> dict[str, ElementResult]:
        """The last results of the elements, by their keys."""
        return {key: known.result for key, known in self.trail.known.items()}

    def solution(self, found: Balance, directions: Directions) -> Solution:
        """The losses of the last pass, and torques."""
        start, how = self.start, "efficiency given by the case"
        lost = {row.key: 1 - row.efficiency for row in self.machine.rows if row.efficiency < 1}
        given = {
            key: Loss(LOAD_DEPENDENT, share * abs(found.powers[key]), how, mesh=key)
            for key, share in lost.items()
        }
        return Solution(
            speeds=start.statics.speeds, torques=found.torques, couplings=found.couplings,
            meshes=found.meshes, drives=self.drives, rolling=found.powers, results=self.results,
            given=given, ratio=start.ratio, self_locking=directions.locking,
            jammed=directions.jammed, unique=found.unique, floating=self.braking,
            standing=start.standing, state=cast(State, self.trail.state),
        )  # fmt: skip

    def begin(self) -> Balance:
        """Torques with the losses that are known so far."""
        if self.trail.passed:
            return self._with_losses(self.unlost)[0]
        if self.earlier is not None:
            return self.under(self.unlost, self.earlier.meshes)
        whole = {it.key for it in self.machine.elements if getattr(it, "reference", None)}
        likely = {
            key: given if key.partition(".")[0] in whole else LIKELY * given
            for key, given in self.start.efficiencies.items()
        }
        return self.start.statics.balance(self.drives, likely)

    def under(self, found: Balance, meshes: Mapping[str, float]) -> Balance:
        """`found` with other loads of the meshes."""
        speeds = self.start.statics.speeds
        powers = {
            row.key: meshes[row.key] * (speeds[row.first] - speeds[row.carrier])
            for row in self.machine.rows
        }
        return replace(found, meshes=meshes, powers=powers)

    def follow(self, last: Balance | None = None) -> Balance:
        """Torques with the losses that those of `last` lead to; with efficiencies if they agree.

        Without, with those of the torques to begin with. Raises `ConvergenceError` if losses or
        torques grow beyond all bounds.
        """
        self.passes += 1
        trail = self.trail
        if trail.ahead:
            trail.passed.append(trail.ahead.pop(0))
            return trail.passed[-1]
        trail.begun = found = last or trail.begun or self.begin()
        trail.state = state = State(
            self.start.statics.speeds,
            found.meshes,
            one_by_one(forces_of, self.machine.layouts, found.meshes),
            cast(Fluids, self.fluids),
            lossless=not trail.passed and self.earlier is None,
            drives=self.drives,
            earlier={} if self.earlier is None else self.earlier.results,
        )
        # an error of the losses changes the loads about as much as the losses do of which it is
        # that share: it may change them by less than they have to agree
        moved = _apart([self.unlost.meshes[key] for key in found.meshes], [*found.meshes.values()])
        allowed = AGREEMENT / larger(moved, AGREEMENT / LOSS_AGREEMENT)
        with np.errstate(over="ignore"):  # a loss may be too large for a number
            for element in self.machine.elements:  # those that have answered to it stay as they are
                known = trail.known.get(element.key)
                trail.known[element.key] = _answered(element, state, known, allowed)
        results = self.results.values()
        if not isfinite(sum(loss.watts for it in results for loss in it.losses.values())):
            raise self.disagreement()
        new, efficiencies = self._with_losses(found)
        agrees = _agrees(found.meshes, new.meshes)
        if not agrees and not largest(new.meshes.values()) < MOST_TORQUE:
            raise self.disagreement()
        trail.begun = None
        trail.passed.append(replace(new, efficiencies=efficiencies) if agrees else new)
        return trail.passed[-1]

    def disagreement(self) -> ConvergenceError:
        """What to say if losses and torques do not agree."""
        return ConvergenceError(
            f"losses and torques do not agree after {self.passes} passes: the losses grow with the "
            "torques that they cause. Either the gears are close to self-locking in this direction "
            "of power; then they turn only with smaller losses or with reversed power. Or a "
            "formula fails far outside its range; then choose another models.friction or "
            'models.rolling, or models.oil_beyond_range = "held".'
        )

    def _with_losses(self, found: Balance) -> tuple[Balance, dict[str, float]]:
        """Torques with the losses of the elements, and the efficiencies of the meshes."""
        efficiencies, frictions = effects_of(
            self.start.efficiencies, found.powers, self.results.values(), self.braking
        )
        return self.start.statics.balance(self.drives, efficiencies, frictions), efficiencies


def _converged(branch: _Branch) -> Balance:
    """Torques and losses that agree, with these directions of the rolling powers.

    Nearly always plain repetition finds them. Half steps settle most loads that steep losses throw
    to and fro; those that follow their losses slowly are left to secants, the rest to small steps.
    """
    found = _repeated(branch, None, 1.0, PLAIN_PASSES)
    found = _repeated(branch, found, *SMALL_STEPS[0])
    if found.efficiencies is None:
        found = _by_secants(branch, found)
    found = _repeated(branch, found, *SMALL_STEPS[1])
    if found.efficiencies is None:
        raise branch.disagreement()
    return found


def _repeated(branch: _Branch, found: Balance | None, share: float, passes: int) -> Balance:
    """After so many passes, or when losses and torques agree; loads go that share of each step."""
    for _ in range(passes):
        if found is not None and found.efficiencies is not None:
            break
        new = branch.follow(found)
        if found is not None and new.efficiencies is None and share < 1:
            meshes = {
                key: old + share * (new.meshes[key] - old) for key, old in found.meshes.items()
            }
            new = branch.under(new, meshes)
        found = new
    return cast(Balance, found)


def _by_secants(branch: _Branch, first: Balance) -> Balance:
    """By Broyden's method on the loads of the meshes; as the `first` where that leads nowhere."""
    if any(isinstance(load, Points) for load in first.meshes.values()):
        raise Alone
    from scipy.optimize import NoConvergence, broyden1  # takes a third of a second, rarely needed

    last = first
    start = np.array(list(first.meshes.values()))
    size = np.where(start, np.abs(start), 1.0)

    def change(values: FloatArray) -> FloatArray:
        nonlocal last
        if not np.isfinite(values).all():
            raise branch.disagreement()
        tried = branch.under(first, dict(zip(first.meshes, map(float, values * size), strict=True)))
        with np.errstate(divide="warn", invalid="warn"):
            last = branch.follow(tried)
        return np.array(list(last.meshes.values())) / size - values

    def left(_: FloatArray) -> float:
        return 1.0 if last.efficiencies is None else 0.0

    try:
        with np.errstate(divide="ignore", invalid="ignore"):  # secants through one point
            broyden1(
                change, start / size, alpha=1.0, f_tol=0.5, tol_norm=left, maxiter=SECANTS,
                line_search=None,
            )  # fmt: skip
    except (NoConvergence, ConvergenceError):
        return first
    except ValueError as problem:
        if "Jacobian" in str(problem):  # no step leaves a load at which the losses jump
            return first
        raise
    return last


def _agrees(old: Mapping[str, float], new: Mapping[str, float]) -> bool:
    size = largest(new.values())
    return all(
        every(abs(load - old[key]) <= AGREEMENT * abs(load) + ROUNDING * size)
        for key, load in new.items()
    )


def effects_of(
    given: Mapping[str, float],  # Efficiencies of the meshes without the losses of `results`.
    powers: Mapping[str, float],  # Rolling power of each mesh. [W]
    results: Iterable[ElementResult],
    braking: Collection[str] = (),  # Meshes whose losses are friction in any case.
) -> tuple[dict[str, float], list[Friction]]:
    """Efficiencies of the meshes, and friction between bodies, that the losses stand for."""
    efficiencies = dict(given)
    frictions = []
    for result in results:
        for loss in result.losses.values():
            power = 0.0 if loss.mesh in braking else abs(powers.get(loss.mesh, 0.0))
            if loss.mesh and loss.watts < MOST_OF_A_MESH * power:
                efficiencies[loss.mesh] -= loss.watts / power
            elif not every(loss.watts == 0):
                frictions += [
                    Friction((one, two), share * loss.watts) for one, two, share in loss.brakes
                ]
    return efficiencies, frictions


def stage_torques(machine: Machine, solution: Solution) -> dict[str, dict[str, float]]:
    """Torque that each set and each other part takes from every body and from the housing.

    Torque times speed is the power that enters the part there; over all bodies these powers sum to
    its loss. The torques of all parts and clutches on a body balance the one from outside.

    By set or part and body. [N m]
    """
    taken: dict[str, dict[str, float]] = {}
    for stage, body, torque in _torques(machine, solution):
        own = taken.setdefault(stage, {})
        own[body] = own.get(body, 0.0) + torque
    return taken


def _torques(machine: Machine, solution: Solution) -> Iterator[tuple[str, str, float]]:
    """Stage, body and torque taken, one by one."""
    given = {
        row.key: 1.0 if row.key in solution.standing else row.efficiency for row in machine.rows
    }
    powers, braking = solution.rolling, solution.floating
    efficiencies, _ = effects_of(given, powers, solution.results.values(), braking)
    for row in machine.rows:
        eta, drives = efficiencies[row.key], solution.drives[row.key]
        per_tooth = solution.meshes[row.key] / row.teeth[0]
        for body, coefficient in row.terms(1.0 if drives else eta, eta if drives else 1.0):
            yield row.key.partition(".")[0], body, per_tooth * coefficient
    for stage, result in solution.results.items():
        _, frictions = effects_of(given, powers, [result], braking)
        for friction in frictions:
            one, two = friction.between
            difference = solution.speeds[one] - solution.speeds[two]
            if difference:
                yield stage, one, friction.watts / difference
                yield stage, two, -friction.watts / difference
