"""How oil gets to the gears of a case, and what follows from it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from epicyclic.builders.lubrication import oil_share
from epicyclic.builders.set_case import set_cases
from epicyclic.case.case import Case
from epicyclic.case.train import TrainCase
from epicyclic.machine.disc import churned
from epicyclic.machine.gear_set import GearSet
from epicyclic.machine.pocket_flow import oil_in_mesh
from epicyclic.machine.solve import Solution
from epicyclic.result.result import OilSupply


def stated_supplies(case: Case) -> Iterator[tuple[str, OilSupply]]:
    """How oil gets to the gears of each set that says so, by the key of the set."""
    sets = dict(case.computed_sets) if isinstance(case, TrainCase) else [""]
    for key, own in set_cases(case, sets):
        if own.lubrication is not None:
            share = oil_share(own)
            method = own.lubrication.method
            yield key, OilSupply(method, share.share, *share.band, share.grade, share.source)


def solved_supplies(
    case: Case, sets: Mapping[str, GearSet], solution: Solution
) -> Iterator[tuple[str, OilSupply]]:
    """The same with what the speeds make of it."""
    for key, supply in stated_supplies(case):
        own = sets[key]
        discs = [disc for discs in own.discs.values() for disc in discs]
        yield (
            key,
            replace(
                supply,
                churning=churned(discs, solution.state),
                meshes={duty.key: oil_in_mesh(duty) for duty in own.mean_duties(solution.state)},
            ),
        )
