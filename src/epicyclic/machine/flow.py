"""Which part of a machine takes how much torque from which shaft."""

from __future__ import annotations

from collections.abc import Iterator

from epicyclic.machine.balance import Friction
from epicyclic.machine.machine import Machine
from epicyclic.machine.solve import Solution, effects_of


def stage_torques(machine: Machine, solution: Solution) -> dict[str, dict[str, float]]:
    """Torque that each set and each other part takes from every body and from the housing.

    Torque times speed is the power that enters the part there; over all bodies these powers sum to
    its loss. The torques of all parts and clutches on a body balance the one from outside.

    Returns
    -------
    dict of str to dict of str to float
        By set or part and body. [N m]
    """
    taken: dict[str, dict[str, float]] = {}
    for stage, body, torque in _torques(machine, solution):
        own = taken.setdefault(stage, {})
        own[body] = own.get(body, 0.0) + torque
    return taken


def _torques(machine: Machine, solution: Solution) -> Iterator[tuple[str, str, float]]:
    """Stage, body and torque taken, one by one."""
    efficiencies, _ = effects_of(machine, solution.rolling, solution.results.values())
    for row in machine.rows:
        eta, drives = efficiencies[row.key], solution.drives[row.key]
        per_tooth = solution.meshes[row.key] / row.teeth[0]
        for body, coefficient in row.terms(1.0 if drives else eta, eta if drives else 1.0):
            yield row.key.partition(".")[0], body, per_tooth * coefficient
    for stage, result in solution.results.items():
        _, frictions = effects_of(machine, solution.rolling, [result])
        for friction in frictions:
            for body, torque in _friction_torques(friction, solution):
                yield stage, body, torque


def _friction_torques(friction: Friction, solution: Solution) -> Iterator[tuple[str, float]]:
    one, two = friction.between
    difference = solution.speeds[one] - solution.speeds[two]
    if difference:
        yield one, friction.watts / difference
        yield two, -friction.watts / difference
