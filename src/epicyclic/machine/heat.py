"""Temperatures and losses of a machine that agree: heat network, bulk temperatures, iteration."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cache, cached_property, partial
from typing import Any, Literal, NamedTuple, cast

import numpy as np

from epicyclic.arrays import (
    Alone,
    Apart,
    FloatArray,
    itself,
    joined,
    larger,
    largest,
    points_in,
    taken,
)
from epicyclic.contact.temperatures import bulk_rise_of_flash, bulk_rise_of_loss
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import ConvergenceError, InputError, Problem, one_problem, raise_any
from epicyclic.gears.gear import HOUSING
from epicyclic.machine import convection as shell
from epicyclic.machine.convection import Fluid
from epicyclic.machine.element import OIL, Fluids, Loss, joined_key
from epicyclic.machine.gear_mesh import GearMesh, MeshFigures
from epicyclic.machine.gear_set import GearSet
from epicyclic.machine.heat_flow import Link, Network
from epicyclic.machine.heat_paths import (
    INLET,
    OF_SHAFT,
    STEEL,
    Seen,
    Wetting,
    bearing_capacity,
    bearing_links,
    carrier_node,
    gear_set_capacities,
    gear_set_links,
)
from epicyclic.machine.machine import Machine, Operation
from epicyclic.machine.planets import BearingFigures
from epicyclic.machine.shaft_parts import ShaftBearing
from epicyclic.machine.solve import Solution, Wanted, solve_machine, solve_machines, start_of
from epicyclic.units import celsius_text, known_text

AGREEMENT = 3e-5
"""Change of a temperature from one pass to the next at which losses and heat agree. [K]"""
NEARLY = 1e-3
"""Change of a temperature from which on torques agree with the losses in each pass. [K]"""
NEAR = 0.1  # Change of expected temperatures, over that of the last pass, with which they serve.
QUICK = 0.5
"""Change of expected temperatures over the one before up to which they are repeated; also how much
warmer a temperature may make itself. [1]"""
STEEPEST, MOST_MORE = 0.3, 2.0
"""Rise of the logarithm of an expected loss with its temperature [1/K], and factor by which it goes
with its torque, at most."""
MOST_PASSES = 40
SCATTERING_FROM, SCATTER = 15, 0.02
"""Passes after which a larger change is agreement [K]: that of the losses of a flow through pockets
that does not repeat, which scatter."""
COLDEST, HOTTEST = 200.0, 770.0
"""Between which losses are computed; beyond them no gearbox is left to compute. [K]"""


@dataclass(frozen=True, slots=True)
class Answer:
    """What the heat of the losses leads to."""

    pointwise = True

    temperatures: Mapping[str, float]  # Temperatures of all nodes. [K]
    links: tuple[Link, ...] = ()  # Paths of heat; empty where temperatures follow from formulas.
    flows: Mapping[str, float] | None = None  # Heat through every link. [W]
    # Temperatures of nodes that are given. [K]
    given: Mapping[str, float] = field(default_factory=dict[str, float])
    # Largest heat of a node that does not leave it, over all heat or the largest flow. [1]
    residual: float = 0.0


class _Asked(NamedTuple):
    """The temperatures of a network that a point asks for."""

    network: NetworkModel
    around: float  # Temperature of the oil, for its properties. [K]
    seen: Seen


class _Heated(NamedTuple):
    """What it gets: temperatures, and all of its answer, of which only the last one is read."""

    temperatures: Mapping[str, float]  # [K]
    answer: Callable[[], Answer]


@dataclass(frozen=True, slots=True)
class Settled:
    """A machine whose temperatures and losses agree."""

    solution: Solution
    answer: Answer
    evaluations: int  # Evaluations of the losses.
    change: float = 0.0  # Largest change of a temperature in the last of them. [K]


def heat_of(losses: Iterable[Loss]) -> dict[str, float]:
    """Heat that losses bring to each thermal node. [W]"""
    heat: dict[str, float] = {}
    for loss in losses:
        for node, share in loss.heat:
            heat[node] = heat.get(node, 0.0) + share * loss.watts
    return heat


_Pass = tuple[Mapping[str, float], Solution, _Heated]  # Temperatures [K], losses there, and so on.


def settle(points: Sequence[tuple[Machine, Operation, ThermalModel]]) -> list[Settled | Exception]:
    """Temperatures and losses that agree at each operating point, or what is wrong with it.

    Each pass is one for all points that still need it; those of which only a whole solution is left
    wait for the others. See `_passes` for what is raised.
    """
    passes = [_passes(*point) for point in points]
    found: dict[int, Settled | Exception] = {}
    answers: dict[int, Any] = dict.fromkeys(range(len(passes)))
    asked: dict[int, _Asked | Wanted] = {}
    while answers or asked:
        for number, answer in answers.items():
            own = passes[number]
            try:
                failed = isinstance(answer, Exception)
                asked[number] = own.throw(answer) if failed else own.send(answer)
            except StopIteration as done:
                found[number] = done.value
            except Exception as error:
                found[number] = error
        # heat first, then losses, then whole solutions
        turns = {n: 0 if isinstance(it, _Asked) else 1 + it.whole for n, it in asked.items()}
        first = min(turns.values(), default=0)
        those = {number: asked.pop(number) for number, turn in turns.items() if turn == first}
        answer_all: Any = solve_machines if first else _answers
        answers = dict(zip(those, answer_all([*those.values()]), strict=True))
    return [found[number] for number in range(len(passes))]


def _answers(asked: Sequence[_Asked]) -> list[_Heated | Exception]:
    """Temperatures of the networks of several points, of alike ones at once."""
    found: list[_Heated | Exception] = []
    if len(asked) > 1:
        networks, *those = zip(*asked, strict=True)
        with suppress(Alone, Apart, ConvergenceError, InputError):  # single points tell of them
            answer = networks[0].beside(networks).heated(*map(joined, those))
            return taken(_heated(answer), range(len(asked)))
    for network, around, seen in asked:
        try:
            found.append(_heated(network.heated(around, seen)))
        except Exception as error:
            found.append(error)
    return found


def _heated(answer: Answer) -> _Heated:
    return _Heated(answer.temperatures, partial(itself, answer))


def _passes(
    machine: Machine, operation: Operation, model: ThermalModel
) -> Generator[_Asked | Wanted, Any, Settled]:
    """The passes of one point: asks for solutions until its temperatures agree. Theory (W27).

    From the third on, each pass is at the temperatures that the two before let expect. Raises
    `ConvergenceError` if there is no equilibrium, or only one that no gearbox survives.
    """
    unheated = cache(partial(start_of, machine, operation))  # of a block nobody asks for it
    found: list[_Pass] = []
    at, change = _values(model.start), math.inf
    while len(found) < MOST_PASSES:
        held, earlier = _held(model, at), found[-1][1] if found else None
        solution, agrees = yield Wanted(
            machine, operation, model.fluids(held), unheated, earlier, change <= NEARLY
        )
        if isinstance(model, NetworkModel):
            answer = yield _Asked(model, held[OIL], model.seen(solution, solution.losses.values()))
        else:
            answer = _heated(model.answer(solution))
        found.append((held, solution, answer))
        reached = _values(answer.temperatures)
        change = float(np.abs(reached - at).max())
        if agrees and change <= (AGREEMENT if len(found) <= SCATTERING_FROM else SCATTER):
            if reached.min() < COLDEST or reached.max() > HOTTEST:
                break
            return Settled(solution, answer.answer(), len(found), change)
        at = reached
        if len(found) > 1:
            at = yield from _expected(model, *found[-2:])
    start = model.fluids(dict(model.start))  # where losses and torques may not even agree
    solve_machine(Wanted(machine, operation, start, unheated))
    raise _no_equilibrium(found)


def _values(temperatures: Mapping[str, float]) -> FloatArray:
    return np.array([*temperatures.values()])


def _held(model: ThermalModel, values: FloatArray) -> dict[str, float]:
    return dict(zip(model.start, np.clip(values, COLDEST, HOTTEST).tolist(), strict=True))


def _expected(
    model: ThermalModel, before: _Pass, last: _Pass
) -> Generator[_Asked, _Heated, FloatArray]:
    """Temperatures that agree with the losses which two passes let expect. [K]"""
    at, reached = _values(last[0]), _values(last[2].temperatures)
    if not isinstance(model, NetworkModel):  # not all follow from losses: the secant of each
        step, rise = at - _values(before[0]), reached - _values(before[2].temperatures)
        slopes = np.divide(rise, step, out=np.zeros_like(at), where=step != 0)
        return np.asarray(at + (reached - at) / (1 - np.minimum(slopes, QUICK)))

    def ahead(values: FloatArray) -> _Asked:
        held = _held(model, values)
        return _Asked(model, held[OIL], model.seen(last[1], _expected_losses(before, last, held)))

    def off(values: FloatArray) -> FloatArray:
        _, around, seen = ahead(values)
        return _values(model.heated(around, seen).temperatures) - values

    found, change, near = reached, math.inf, max(AGREEMENT, NEAR * np.abs(reached - at).max())
    try:
        while change > near:
            old, former = found, change
            found = _values((yield ahead(old)).temperatures)
            change = np.abs(found - old).max()
            if change > max(QUICK * former, near):
                from scipy.optimize import root  # takes a sixth of a second

                done = root(off, at)
                return np.asarray(done.x if done.success else reached)
    except ConvergenceError:  # what does not hold for expected losses may hold for others
        return reached
    return found


def _expected_losses(
    before: _Pass, last: _Pass, temperatures: Mapping[str, float]
) -> Iterator[Loss]:
    """The last losses as two passes let expect them at other temperatures.

    The logarithm of each goes on with the mean temperature of what it heats. Those that are shares
    of the power of a mesh go with its torque, too, which lags one pass behind.
    """
    (then, older, _), (now, solution, _) = before, last
    torques, seen, old_losses = solution.meshes, solution.state.torques, older.losses
    for key, loss in solution.losses.items():
        if key in solution.given:
            yield loss
            continue
        own, old, new = (
            sum(share * nodes.get(node, 0.0) for node, share in loss.heat)
            for nodes in (now, then, temperatures)
        )
        slope, was = 0.0, old_losses[key].watts
        if loss.watts and was and own != old:
            slope = math.log(loss.watts / was) / (own - old)
        watts = loss.watts * math.exp(max(-STEEPEST, min(slope, STEEPEST)) * (new - own))
        if loss.mesh and torques[loss.mesh] * seen[loss.mesh] > 0:
            watts *= min(torques[loss.mesh] / seen[loss.mesh], MOST_MORE)
        yield loss._replace(watts=watts)


def _no_equilibrium(found: Sequence[_Pass]) -> ConvergenceError:
    """What to say of temperatures beyond all bounds, or that do not settle within them."""
    for _, _, answer in found:  # the first to leave the bounds tells on which side they are left
        coldest, hottest = (end(answer.temperatures.values()) for end in (min, max))
        if coldest < COLDEST:
            node = min(answer.temperatures, key=answer.temperatures.__getitem__)
            return ConvergenceError(
                f"more heat is removed than generated: the {node.replace('_', ' ')} would be "
                f"colder than {celsius_text(COLDEST, 4)}, the lowest temperature at which losses "
                "are computed. Give a smaller thermal.cooler_power, or "
                "thermal.cooler_conductance, which cannot remove more heat than is generated."
            )
        if hottest > HOTTEST:
            break
    before, temperatures = found[-2:][0][2].temperatures, found[-1][2].temperatures
    node = max(temperatures, key=temperatures.__getitem__)
    reached = f"{node.replace('_', ' ')} {celsius_text(temperatures[node], 4)}"
    if OIL in temperatures and node != OIL:
        reached += f", oil {celsius_text(temperatures[OIL], 4)}"
    if hottest <= HOTTEST:
        change = max(abs(value - before[node]) for node, value in temperatures.items())
        return ConvergenceError(
            f"temperatures and losses do not settle: after {len(found)} passes they still change "
            f"by {change:.2g} K, near {reached}, because a loss jumps or scatters there. Change "
            'the operating point a little, or set models.temperatures = "inlet".'
        )
    return ConvergenceError(
        f"thermal runaway: the heat balance closes only above {celsius_text(HOTTEST, 4)}, the "
        f"highest temperature at which losses are computed. After {len(found)} passes the "
        f"temperatures are: {reached}. Remove more heat (thermal.oil_flow, "
        "thermal.cooler_conductance, a larger [thermal.housing]), or transmit less power."
    )


# Bulk temperatures of gears from their own meshes, with the oil at its inlet temperature.

BulkMethod = Literal["iso-6336-20", "iso-6336-22"]


@dataclass(frozen=True, slots=True)
class _Side:
    """A mesh that warms a gear."""

    element: str  # Key of its set.
    mesh: GearMesh
    mates: int  # Gears that the gear meets in it.
    parallel: int  # How many of this mesh the set has.


@dataclass(frozen=True, slots=True)
class FlankModel:
    """Gears warmer than the oil by what their meshes do to them; nothing else is."""

    machine: Machine
    oil: float  # Temperature of the oil. [K]
    method: BulkMethod  # One of `BULK_METHODS`.
    lubrication_factors: Mapping[str, float]  # X_S of each set, by its key. [1]
    # Oil and mixture at the temperatures of the nodes that they meet.
    fluids: Callable[[Mapping[str, float]], Fluids]

    @property
    def start(self) -> Mapping[str, float]:
        """All gears as warm as the oil. [K]"""
        return dict.fromkeys(_sides(self.machine), self.oil)

    def answer(self, solution: Solution) -> Answer:
        """Bulk temperatures of all gears."""
        rise = BULK_METHODS[self.method]
        return Answer(
            {
                node: self.oil + rise(sides, solution, self.lubrication_factors[sides[0].element])
                for node, sides in _sides(self.machine).items()
            },
            given={OIL: self.oil},
        )


def _sides(machine: Machine) -> dict[str, list[_Side]]:
    """The meshes of every gear, by its thermal node."""
    found: dict[str, list[_Side]] = {}
    for own in machine.elements:
        if isinstance(own, GearSet):
            planets = {planet.nodes[0] for planet in own.planets}
            for mesh in own.meshes:
                for node in mesh.nodes:
                    mates = 1 if node in planets else own.count
                    found.setdefault(node, []).append(_Side(own.key, mesh, mates, own.count))
    return found


def _rise_of_flash(sides: list[_Side], solution: Solution, lubrication_factor: float) -> float:
    """ISO/TS 6336-20 with the mean flash temperature of its loaded meshes. Theory (W7)."""
    flashes, mates = [], 0
    for side in sides:
        figures = solution.results[side.element].figures[side.mesh.key]
        assert isinstance(figures, MeshFigures)
        if not math.isnan(figures.flash_temperature_mean):
            flashes.append(figures.flash_temperature_mean)
            mates += side.mates
    mean = sum(flashes) / len(flashes) if flashes else 0.0
    return bulk_rise_of_flash(mean, lubrication_factor, mates)


def _rise_of_loss(sides: list[_Side], solution: Solution, lubrication_factor: float) -> float:
    """ISO/TS 6336-22 from the loss of one mesh, the mean of those of a gear. Theory (W4)."""
    rises = []
    for side in sides:
        losses = solution.results[side.element].losses
        watts = losses[f"{side.mesh.key}_sliding"].watts / side.parallel
        sizes = side.mesh.mesh.center_distance, side.mesh.mesh.face_width
        rises.append(bulk_rise_of_loss(watts, *sizes, lubrication_factor))
    return sum(rises) / len(rises)


BULK_METHODS: Mapping[str, Callable[[list[_Side], Solution, float], float]] = {
    "iso-6336-20": _rise_of_flash,
    "iso-6336-22": _rise_of_loss,
}
"""How much warmer than the oil a gear is."""


# The network of a machine: nodes of its parts, the oil and the housing, and the paths between.

AMBIENT = "air"
COOLANT = "coolant"
FUNCK = "ISO/TR 14179-2 (Funck 1985), second hand"
LEAST_INSIDE = 10.0
"""Conductance from oil to wall over that from oil to air, at least, by ISO/TR 14179-1. [1]"""
SAME = 1e-13  # Relative error of the temperature of the housing. [1]
WALLS = (1.0, 1e7)  # Between which the housing may be while temperatures settle. [K]
OUTFLOW = "oil-outflow"  # Path of the oil that leaves.
LEAST_FLOW = 1e-9  # With which the oil is warmest, over that which carries all heat. [1]
AT_REST = 1.0  # Conductance that makes a part without heat as warm as the oil. [W/K]
LEAST_SHARE = 0.01
"""Oil for a part without heat over that for one with all the heat: an estimate. [1]"""
SMALLEST_HEAT = 1e-6
"""With which a gearbox without heat shares its oil; residuals are over this at least. [W]"""


@dataclass(frozen=True, slots=True)
class Housing:
    """What the housing gives to its surroundings. Areas in m^2, coefficients in W/(m^2 K)."""

    method: Literal["iso-14179-2", "iso-14179-1"]  # ``"iso-14179-2"`` or ``"iso-14179-1"``.
    area: float
    inner_area: float
    height: float  # [m]
    length: float  # [m]
    air_speed: float  # [m/s]
    emissivity: float  # [1]
    fin_factor: float  # [1]
    inner_coefficient: float  # From the oil to the wall. [W/(m^2 K)]
    coefficient: float  # From the oil to the air. [W/(m^2 K)]
    foundation: float  # [W/K]

    def outside(self, wall: float, air: float) -> float:
        """Coefficient from the wall to the air. Theory (W9), (W10), (W11). [W/(m^2 K)]"""
        convection = shell.free_convection(self.height, wall, air)
        if self.air_speed:  # slow air cools no less than air at rest
            sizes = self.length, self.height
            convection = max(convection, shell.forced_convection(self.air_speed, *sizes, wall, air))
        return self.fin_factor * convection + shell.radiation(self.emissivity, wall, air)

    def links(self, wall: float, air: float) -> Iterator[Link]:
        """From the oil to the wall, and from there to the air. Theory (W12)."""
        inside = self.inner_coefficient * self.inner_area
        if self.method == "iso-14179-1":
            whole = self.coefficient * self.area
            # the coefficient is that of both paths together, whatever the wall adds
            inside = max(inside, LEAST_INSIDE * whole)
            outside = whole * inside / (inside - whole)
            how = "coefficient from oil to air", "ISO/TR 14179-1, second hand"
        else:
            outside = self.outside(wall, air) * self.area
            how = "convection and radiation", FUNCK
        yield Link("oil-housing", OIL, HOUSING, inside, "splash on the wall", FUNCK)
        yield Link("housing-air", HOUSING, AMBIENT, outside, *how)
        if self.foundation:
            yield Link("housing-foundation", HOUSING, AMBIENT, self.foundation, "given")


@dataclass(frozen=True, slots=True)
class Change:
    """What the user does to a conductance or capacity: another value [W/K, J/K], a factor [1]."""

    pointwise = True

    value: float | None
    scale: float

    def __call__(self, computed: float) -> float:
        """What becomes of a computed value."""
        return self.scale * (computed if self.value is None else self.value)


@dataclass(frozen=True, slots=True)
class Wet:
    """How oil gets to gears."""

    pointwise = True

    bath: float  # Share of them that dips into oil. [1]
    effectiveness: float  # Effectiveness of jets. [1]


@dataclass(frozen=True, slots=True)
class HeatSettings:
    """How heat leaves the parts of a machine."""

    pointwise = True

    inlet: float  # Temperature of the oil. [K]
    outlet: float | None  # Where it was measured. [K]
    flow: float  # Flow of oil. [m^3/s]
    wet: Wet  # How oil gets to what is in no set.
    wet_sets: Mapping[str, Wet]  # How it gets to each set.
    # Shares of the flow that meet some of the nodes; what is left meets the others, as their heat
    # demands. [1]
    jet_shares: Mapping[str, float]
    press_fit: float  # [W/(m^2 K)]
    shaft: float  # From a part to the shaft it is on. [W/K]
    ambient: float  # [K]
    coolant: float  # [K]
    cooler_power: float  # [W]
    cooler: float  # [W/K]
    housing: Housing | None
    changes: Mapping[str, Change]  # By the key of the link.
    oil_volume: float | None  # [m^3]
    housing_mass: float | None  # Mass of steel that stores as much as the housing. [kg]
    capacity_changes: Mapping[str, Change]  # By the node.


@dataclass(frozen=True)
class NetworkModel:
    """Heat flows between all parts of a machine, the oil and the surroundings."""

    machine: Machine
    settings: HeatSettings
    fluids: Callable[[Mapping[str, float]], Fluids]  # As of `FlankModel`.
    # The oil, and its mixture with air, as heat sees them, at a temperature.
    media_at: Callable[[float], tuple[Fluid, Fluid]]

    @property
    def start(self) -> Mapping[str, float]:
        """Everything at the temperature of the oil inlet. [K]"""
        return dict.fromkeys(self.nodes, self.settings.inlet)

    @cached_property
    def nodes(self) -> tuple[str, ...]:
        """All nodes of unknown temperature."""
        carriers = {
            carrier_node(own): None
            for own in self.machine.elements
            if isinstance(own, GearSet) and any(planet.bearing for planet in own.planets)
        }
        ends = (OIL,) if self.settings.housing is None else (OIL, HOUSING)
        return (*self.wetted, *carriers, *self.shafts, *ends)

    @cached_property
    def wetted(self) -> tuple[str, ...]:
        """Nodes that oil can be thrown on: gears, pins, bearings of shafts."""
        found: dict[str, None] = {}
        for own in self.machine.elements:
            if isinstance(own, GearSet):
                found |= dict.fromkeys(_wetted_nodes(own))
            elif isinstance(own, ShaftBearing):
                found[own.key] = None
        return tuple(found)

    @cached_property
    def shafts(self) -> Mapping[str, tuple[str, ...]]:
        """Nodes of shafts that join parts of more than one element, with the nodes on them."""
        on: dict[str, dict[str, str]] = {}
        for own in self.machine.elements:
            for body, node in _seats(own):
                if body != HOUSING:
                    on.setdefault(body, {})[node] = own.key
        return {
            f"{body}_shaft": tuple(nodes)
            for body, nodes in on.items()
            if len(set(nodes.values())) > 1
        }

    def heated(
        self,
        around: float,  # Temperature of the oil, for its properties. [K]
        seen: Seen,
    ) -> Answer:
        """Temperatures at which the heat of the losses leaves. Theory (W26).

        Raises `InputError` if the heat of a part has no way out, `Alone` of several points if a
        flow or the temperature of the housing is sought for each.
        """
        own, heat = self.settings, seen.heat
        others = own.outlet is not None and (own.housing is not None or own.cooler > 0)
        if points_in(heat.values()) and (others or own.housing is not None):
            raise Alone
        is_open = others and sum(heat.values()) > 0 and OUTFLOW not in own.changes
        network = self._to_outlet(around, seen) if is_open else self._with_flow(around, seen)
        found = network.steady(heat)
        flows = network.flows(found)
        whole = larger(sum(map(abs, heat.values())), largest(flows.values()))
        residual = largest(network.residuals(found, heat).values()) / larger(whole, SMALLEST_HEAT)
        return Answer(found, network.links, flows, network.given, residual)

    def beside(self, models: Sequence[NetworkModel]) -> NetworkModel:
        """This of several points; raises `Alone` unless all have its machine."""
        if any(it.machine != self.machine for it in models):
            raise Alone

        def media_of_each(around: Any) -> tuple[Fluid, Fluid]:
            each = zip(models, np.ravel(around).tolist(), strict=True)
            found: tuple[Fluid, Fluid] = joined([it.media_at(own) for it, own in each])
            return found

        settings = self.settings
        if any(it.settings != settings for it in models):
            settings = joined([it.settings for it in models])
        return replace(self, settings=settings, media_at=media_of_each)

    def _with_flow(self, around: float, seen: Seen, flow: float | None = None) -> Network:
        fixed = self._fixed_links(around, seen, flow)
        return self._with_wall(fixed, seen.heat, self._wall(fixed, seen.heat))

    def _to_outlet(self, around: float, seen: Seen) -> Network:
        """The network with as much flow as lets the oil leave at its stated temperature."""
        from scipy.optimize import brentq

        outlet, heat = self.settings.outlet, seen.heat
        assert outlet is not None

        def excess(flow: float) -> float:
            return self._with_flow(around, seen, flow).steady(heat)[OIL] - outlet

        most = sum(heat.values()) / (outlet - self.settings.inlet)
        least = LEAST_FLOW * most
        if (left := excess(least)) < 0:
            raise ConvergenceError(
                f"the oil cannot leave at {celsius_text(outlet, 4)}: other paths would keep it "
                f"at {celsius_text(outlet + left, 4)} even if none left. Correct "
                "thermal.oil_outlet_temperature or these paths, or give thermal.oil_flow."
            )
        while excess(most) > 0:  # heat comes in on other paths
            most *= 2
        flow = float(brentq(excess, least, most, xtol=SAME, rtol=SAME))
        return self._with_flow(around, seen, flow)

    def network(self, temperature: float, solution: Solution) -> Network:
        """The network with oil and housing at one temperature. [K]"""
        seen = self.seen(solution, solution.losses.values())
        return self._with_wall(self._fixed_links(temperature, seen), seen.heat, temperature)

    def seen(self, solution: Solution, losses: Iterable[Loss]) -> Seen:
        """What the network depends on, with the losses of a solution or others."""
        rollers = {
            joined_key(own.key, planet.key): cast(
                BearingFigures, solution.results[own.key].figures[planet.key]
            ).heat_conductance
            for own in self.machine.elements
            if isinstance(own, GearSet)
            for planet in own.planets
            if planet.bearing is not None
        }
        heat = heat_of(losses)
        heat[OIL] = heat.get(OIL, 0.0) - self.settings.cooler_power
        if self.settings.housing is None:
            heat[OIL] += heat.pop(HOUSING, 0.0)
        return Seen(solution.state.speeds, heat, rollers)

    def _wall(self, fixed: Sequence[Link], heat: Mapping[str, float]) -> float:
        """Temperature of the housing, on which the heat to the air depends. [K]"""
        if self.settings.housing is None:
            return math.nan
        from scipy.optimize import brentq  # takes a third of a second

        def off(wall: float) -> float:
            return self._with_wall(fixed, heat, wall).steady(heat)[HOUSING] - wall

        # the warmer the wall is taken to be, the better it is cooled: one temperature fits
        coldest, hottest = WALLS
        try:
            return float(brentq(off, coldest, hottest, xtol=SAME, rtol=SAME))
        except InputError:
            raise
        except ValueError:  # there is no equilibrium, which those who ask for one tell
            return coldest if off(coldest) < 0 else hottest

    def _with_wall(self, fixed: Sequence[Link], heat: Mapping[str, float], wall: float) -> Network:
        """The network with the housing at a temperature, as far as conductances depend on it."""
        own = self.settings
        outside = () if own.housing is None else own.housing.links(wall, own.ambient)
        links = (*fixed, *map(self._changed, outside))
        given = {INLET: own.inlet, AMBIENT: own.ambient, COOLANT: own.coolant}
        met = {node for link in links for node in (link.hot, link.cold, link.target)}
        network = Network(self.nodes, {node: given[node] for node in given if node in met}, links)
        raise_any(_no_such("thermal.jet_shares", "part", own.jet_shares, self.wetted))
        paths = [link.key for link in links]
        raise_any(_no_such("thermal.conductances", "heat path", own.changes, paths))
        left = network.cut_off()
        if any(node == OIL or heat.get(node) for node in left):
            lost, power = sum(heat.values()) + own.cooler_power, own.cooler_power
            if own.outlet is not None and 0 < power >= lost:
                allowed = "leaves no heat to the oil that flows out: the losses are "
                allowed += f"{known_text(lost)}."
                remedy = "Give less, or thermal.oil_flow instead of thermal.oil_outlet_temperature."
                raise one_problem("thermal.cooler_power", known_text(power), allowed, remedy)
            if own.outlet is not None and not any(heat.values()):
                allowed = "cannot be reached: without losses the leaving oil has no heat."
                key, shown = "thermal.oil_outlet_temperature", celsius_text(own.outlet, 4)
                raise one_problem(key, shown, allowed, "Give thermal.oil_flow, or a speed.")
            allowed = f"the heat of {', '.join(left)} has no path out of the gearbox."
            raise one_problem("thermal", "", allowed, _OUTLET_REMEDY)
        # parts at rest, which nothing heats or cools, are as warm as the oil
        resting = (
            Link(f"{node}-oil", node, OIL, AT_REST, "at rest", "any conductance serves")
            for node in left
        )
        return replace(network, links=(*links, *resting))

    def _fixed_links(
        self,
        around: float,  # Temperature of the oil, for its properties. [K]
        seen: Seen,
        carried: float | None = None,  # Heat capacity of the flow; None: as stated. [W/K]
    ) -> tuple[Link, ...]:
        """All paths of the heat but that to the air."""
        own = self.settings
        oil, mixture = self.media_at(around)
        if carried is None and own.outlet is not None:
            carried = larger(sum(seen.heat.values()), 0.0) / (own.outlet - own.inlet)
        elif carried is None:
            carried = oil.density * oil.heat_capacity * own.flow
        shares = self.jet_shares(seen.heat)

        def wetting(wet: Wet) -> Wetting:
            around, jet = oil if wet.bath else mixture, wet.effectiveness * carried
            return Wetting(around, wet.bath, jet, shares, own.press_fit)

        return tuple(map(self._changed, self._paths(seen, wetting, carried)))

    def capacities(self) -> dict[str, float]:
        """Heat that each node stores for a kelvin. Theory (W35). [J/K]

        Raises `InputError` with everything that is not known of the oil and the housing.
        """
        own = self.settings
        oil, _ = self.media_at(own.inlet)
        found: dict[str, float | None] = dict.fromkeys(self.shafts, OF_SHAFT)
        for element in self.machine.elements:
            if isinstance(element, GearSet):
                found |= gear_set_capacities(element)
            elif isinstance(element, ShaftBearing):
                found[element.key] = bearing_capacity(element)
        mass, volume = own.housing_mass, own.oil_volume
        found[OIL] = oil.density * oil.heat_capacity * volume if volume else None
        found[HOUSING] = mass * STEEL.heat_capacity if mass else None
        known = {node: found[node] for node in self.nodes}
        problems = _no_such("thermal.capacities", "part", own.capacity_changes, known)
        for node in own.capacity_changes.keys() & known:
            change, computed = own.capacity_changes[node], known[node]
            if change.value is not None or computed is not None:
                known[node] = change(computed or 0.0)
        for node, (key, example) in _STATED_CAPACITIES.items():
            if node in known and known[node] is None:
                allowed = f"is not given, but the warm-up rate of the {node} depends on it."
                remedy = f'Give it, as "{example}", or thermal.capacities.{node}.value.'
                problems.append(Problem(key, "", allowed, remedy))
        raise_any(problems)
        return {node: value for node, value in known.items() if value is not None}

    def jet_shares(self, heat: Mapping[str, float]) -> dict[str, float]:
        """The oil goes where the heat arises, unless the user says otherwise. Theory (W30)."""
        given = self.settings.jet_shares
        own = {node: heat.get(node, 0.0) for node in self._met_by_jets() if node not in given}
        left = larger(0.0, 1 - sum(given.values()))
        even = LEAST_SHARE * sum(own.values()) + SMALLEST_HEAT
        weights = {node: watts + even for node, watts in own.items()}
        total = sum(weights.values())
        return dict(given) | {node: left * weight / total for node, weight in weights.items()}

    def _met_by_jets(self) -> tuple[str, ...]:
        """Nodes to which oil is not brought by a bath alone; all where it is nowhere else."""
        elsewhere: set[str] = set()
        for own in self.machine.elements:
            if isinstance(own, GearSet) and not self.settings.wet_sets[own.key].effectiveness:
                elsewhere |= set(_wetted_nodes(own))
            elif isinstance(own, ShaftBearing) and not self.settings.wet.effectiveness:
                elsewhere.add(own.key)
        return tuple(node for node in self.wetted if node not in elsewhere) or self.wetted

    def _paths(
        self, seen: Seen, wetting: Callable[[Wet], Wetting], carried: float
    ) -> Iterator[Link]:
        housing = self.settings.housing is not None
        for own in self.machine.elements:
            if isinstance(own, GearSet):
                found = gear_set_links(own, seen, wetting(self.settings.wet_sets[own.key]))
            elif isinstance(own, ShaftBearing):
                found = bearing_links(own, wetting(self.settings.wet))
            else:
                continue
            yield from (link for link in found if housing or link.cold != HOUSING)
        how = self.settings.shaft, "along the shaft", "given"
        for shaft, nodes in self.shafts.items():
            yield from (Link(f"{node}-{shaft}", node, shaft, *how) for node in nodes)
        if carried:
            yield Link(OUTFLOW, OIL, INLET, carried, "flow of oil", "energy balance")
        if self.settings.cooler:
            yield Link("oil-coolant", OIL, COOLANT, self.settings.cooler, "cooler", "given")

    def _changed(self, link: Link) -> Link:
        change = self.settings.changes.get(link.key)
        return link if change is None else replace(link, conductance=change(link.conductance))


ThermalModel = FlankModel | NetworkModel  # How temperatures follow from losses.


_OUTLET_REMEDY = (
    "Give thermal.oil_flow or thermal.oil_outlet_temperature, [thermal.housing] or "
    "thermal.cooler_conductance; for single parts thermal.jet_shares or thermal.conductances."
)
_STATED_CAPACITIES = {
    OIL: ("thermal.oil_volume", "5 l"),
    HOUSING: ("thermal.housing.mass", "40 kg"),
}
"""Key and example of what the heat capacities of oil and housing follow from."""


def _wetted_nodes(own: GearSet) -> Iterator[str]:
    """Gears and pins of a set."""
    yield from (node for mesh in own.meshes for node in mesh.nodes)
    yield from (planet.nodes[1] for planet in own.planets if planet.bearing)


def _seats(own: object) -> Iterator[tuple[str, str]]:
    """Bodies of an element with the thermal nodes on them, planets left out."""
    if isinstance(own, GearSet):
        planets = {planet.nodes[0] for planet in own.planets}
        for mesh in own.meshes:
            for body, node in zip(mesh.bodies, mesh.nodes, strict=True):
                if node not in planets:
                    yield body, node
        if any(planet.bearing for planet in own.planets):
            yield own.carrier, carrier_node(own)
    elif isinstance(own, ShaftBearing):
        yield from ((body, own.key) for body in own.between)


def _no_such(table: str, noun: str, given: Iterable[str], known: Iterable[str]) -> list[Problem]:
    allowed = f"is not a {noun} here; these are {', '.join(known)}."
    return [
        Problem(f"{table}.{name}", "", allowed, "Use one of these names.")
        for name in sorted({*given} - {*known})
    ]
