"""Where the power of a train flows: through which set from which shaft, and how much circulates."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from epicyclic.dataclass import dataclass, replace
from epicyclic.gears.gear import HOUSING
from epicyclic.result.result import Result

NO_POWER = 1e-9  # Power and torque, relative to the largest one, that is none. [1]


@dataclass(frozen=True, slots=True)
class Line:
    """Shafts that turn together: one, or several that closed clutches join."""

    key: str  # The shafts, ``"input+third"``.
    shafts: tuple[str, ...]
    speed: float  # [rad/s]
    torque: float  # From outside. [N m]
    passed: float  # That it passes on: what parts and the outside bring in. [N m]
    clutches: Mapping[str, float]  # Torque through each of its clutches. [N m]
    # ``"input"``, ``"output"``, ``"held"``, ``"at rest"`` without a brake of its own, ``"driven"``,
    # ``"loaded"``, ``"idle"``, or empty for a shaft that passes power on.
    role: str

    @property
    def power(self) -> float:
        """That enters from outside. [W]"""
        return self.torque * self.speed


@dataclass(frozen=True, slots=True)
class Link:
    """What joins a set or part to a line."""

    stage: str
    line: str
    members: tuple[str, ...]  # Members of the set, ``("sun",)``; empty for other parts.
    torque: float  # That the stage takes from the line. [N m]
    power: float  # That enters the stage here. [W]
    # How much of it returns to where it came from; of the sign of `power`. [W]
    circulating: float = 0.0


@dataclass(frozen=True, slots=True)
class Stage:
    """A set, bearing, seal or drag."""

    loss: float  # [W]
    rolling: Mapping[str, float]  # Rolling power of its meshes, ``"sun_mesh"``. [W]


@dataclass(frozen=True, slots=True)
class TrainFlow:
    """The power flow of a train."""

    lines: Mapping[str, Line]
    stages: Mapping[str, Stage]
    links: tuple[Link, ...]  # Also those of lines at rest, which carry torque but no power.

    def of_stage(self, key: str) -> tuple[Link, ...]:
        """The links of a stage."""
        return tuple(link for link in self.links if link.stage == key)

    def of_line(self, key: str) -> tuple[Link, ...]:
        """The links of a line."""
        return tuple(link for link in self.links if link.line == key)

    @property
    def circulating(self) -> float:
        """Largest power that circulates through one link. [W]"""
        return max((abs(link.circulating) for link in self.links), default=0.0)


def power_flow(result: Result) -> TrainFlow:
    """The power flow of a result; a single set or pair is one stage.

    A link circulates what flows in closed loops from stage to stage; the rest leads from where
    power enters to where it leaves or is lost. Where several loops share a link, the split between
    them is one of several possible ones.
    """
    members, train = result.flow.members, result.train
    speeds = {name: member.speed for name, member in members.items()}
    torques = {name: member.torque for name, member in members.items()}
    stages: Mapping[str, Mapping[str, float]]  # Torque that each takes from each shaft. [N m]
    clutches: Mapping[str, float]  # Torque through each closed one. [N m]
    rolling: Mapping[str, float]  # Of each mesh. [W]
    shafts: Mapping[str, Sequence[str]]  # Members of each that has a name of its own.
    if train is None:
        stage = "gear set" if result.kind == "planetary" else "gear pair"
        powers = {name: member.power for name, member in members.items()}
        ends = max(powers, key=powers.__getitem__), min(powers, key=powers.__getitem__)
        stages, losses, clutches, rolling = {stage: torques}, {stage: result.total}, {}, {}
        shafts = {name: (f"{stage}.{name}",) for name in torques}
    else:
        ends = train.input, train.output
        stages, losses = train.stages, result.stage_losses
        clutches, rolling, shafts = train.clutches, train.rolling, result.inputs.get("shafts", {})
    largest = max((abs(torque) for own in stages.values() for torque in own.values()), default=0.0)
    lines = {
        "+".join(group): _line(group, speeds, torques, stages, clutches, ends, NO_POWER * largest)
        for group in _groups(speeds, clutches)
    }
    line_of = {shaft: key for key, line in lines.items() for shaft in line.shafts}
    links = []
    for stage, taken in stages.items():
        found: dict[str, list[str]] = {}
        for shaft in taken:
            found.setdefault(line_of.get(shaft, HOUSING), []).append(shaft)
        for key, own in found.items():
            torque = sum(taken[shaft] for shaft in own)
            speed = lines[key].speed if key in lines else 0.0
            names = tuple(name for shaft in own for name in _members(stage, shaft, shafts))
            links.append(Link(stage, key, names, torque, torque * speed))
    of_meshes: dict[str, dict[str, float]] = {}
    for mesh, power in rolling.items():
        stage, _, name = mesh.partition(".")
        of_meshes.setdefault(stage, {})[name] = power
    return TrainFlow(
        lines,
        {key: Stage(losses.get(key, 0.0), of_meshes.get(key, {})) for key in stages},
        _with_loops(links),
    )


def _groups(shafts: Iterable[str], clutches: Iterable[str]) -> list[tuple[str, ...]]:
    """Shafts that clutches join, together; the others alone; in the order of `shafts`."""
    owner = {shaft: {shaft} for shaft in shafts}
    for clutch in clutches:
        one, _, two = clutch.partition("+")
        both = owner[one] | owner[two]
        owner |= dict.fromkeys(both, both)
    groups = (tuple(shaft for shaft in owner if shaft in group) for group in owner.values())
    return list(dict.fromkeys(groups))


def _line(
    group: tuple[str, ...],
    speeds: Mapping[str, float],
    torques: Mapping[str, float],
    stages: Mapping[str, Mapping[str, float]],
    clutches: Mapping[str, float],
    ends: tuple[str, str],
    none: float,
) -> Line:
    speed = speeds[group[0]]
    outside = sum(torques[shaft] for shaft in group)
    given = [outside, *(-sum(own.get(shaft, 0.0) for shaft in group) for own in stages.values())]
    passed = sum(torque for torque in given if torque > 0)
    if ends[0] in group:
        role = "input"
    elif ends[1] in group:
        role = "output"
    elif speed == 0:
        role = "held" if abs(outside) > none else "at rest"
    elif abs(outside) > none:
        role = "driven" if outside * speed > 0 else "loaded"
    else:
        role = "" if passed > none else "idle"
    own_clutches = {key: clutches[key] for key in clutches if set(key.split("+")) <= {*group}}
    return Line("+".join(group), group, speed, outside, passed, own_clutches, role)


def _members(stage: str, shaft: str, shafts: Mapping[str, Sequence[str]]) -> list[str]:
    prefix = f"{stage}." if stage else ""
    return [
        name.removeprefix(prefix)
        for name in shafts.get(shaft, [shaft])
        if name.startswith(prefix) and "." not in name.removeprefix(prefix)
    ]


def _with_loops(links: Sequence[Link]) -> tuple[Link, ...]:
    """Links with the power that circulates: loops are taken out one by one, the shortest first."""
    left = [abs(link.power) for link in links]
    none = NO_POWER * max(left, default=0.0)
    while loop := _shortest_loop(links, left, none):
        least = min(left[number] for number in loop)
        for number in loop:
            left[number] -= least
    found = []
    for link, rest in zip(links, left, strict=True):
        share = abs(link.power) - rest
        circulating = share if share > none else 0.0
        found.append(replace(link, circulating=circulating if link.power > 0 else -circulating))
    return tuple(found)


def _shortest_loop(links: Sequence[Link], left: Sequence[float], none: float) -> list[int]:
    """Numbers of the links of a loop; none if power flows in no loop any more."""
    onward: dict[tuple[str, str], list[tuple[tuple[str, str], int]]] = {}
    for number, link in enumerate(links):
        if left[number] > none:
            line, stage = ("line", link.line), ("stage", link.stage)
            start, end = (line, stage) if link.power > 0 else (stage, line)
            onward.setdefault(start, []).append((end, number))
    loops = [loop for start in onward if (loop := _way_back(onward, start))]
    return min(loops, key=len, default=[])


def _way_back(
    onward: Mapping[tuple[str, str], list[tuple[tuple[str, str], int]]], start: tuple[str, str]
) -> list[int]:
    """The shortest way from `start` back to it, as numbers of links."""
    ways: dict[tuple[str, str], list[int]] = {}
    front: list[tuple[tuple[str, str], list[int]]] = [(start, [])]
    for place, way in front:
        for end, number in onward.get(place, ()):
            if end == start:
                return [*way, number]
            if end not in ways:
                ways[end] = [*way, number]
                front.append((end, ways[end]))
    return []
