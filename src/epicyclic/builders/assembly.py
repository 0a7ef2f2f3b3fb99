"""From the solution of a machine to the result that the user sees."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from epicyclic.builders.built import Built
from epicyclic.builders.models import resolve_models, standing_of
from epicyclic.builders.notes import case_notes, general_notes
from epicyclic.builders.set_case import set_cases
from epicyclic.builders.supplies import solved_supplies
from epicyclic.case.case import Case
from epicyclic.case.train import TrainCase
from epicyclic.gears.gear import HOUSING
from epicyclic.losses.contact import LOAD_DISTRIBUTIONS
from epicyclic.losses.ranges import SomeFlags, ValidityFlag
from epicyclic.losses.shaft_bearing import SHAFT_BEARING_RELIABILITY
from epicyclic.machine.element import OIL, Loss, joined_key
from epicyclic.machine.gear_mesh import MeshFigures
from epicyclic.machine.gear_set import GearSetResult
from epicyclic.machine.heat import AGREEMENT, Answer, Settled, heat_of
from epicyclic.machine.planets import SHARING_METHODS, BearingFigures
from epicyclic.machine.shaft_parts import ShaftBearing
from epicyclic.machine.solve import Solution, stage_torques
from epicyclic.result.result import (
    HeatBalance,
    HeatWay,
    LossTerm,
    MemberState,
    OilSupply,
    PowerFlow,
    Result,
    Train,
    in_words,
)

Methods = dict[str, tuple[str, str]]


def assemble(case: Case, built: Built, settled: Settled) -> Result:
    """The result of a case from the solution of its machine."""
    solution = settled.solution
    losses = dict(_losses(solution))
    terms = tuple(_term(name, losses[name]) for name in built.layout.losses)
    flow = PowerFlow(
        {
            name: MemberState(solution.speeds.get(name, 0.0), solution.torques.get(name, 0.0))
            for name in built.layout.members
        },
        solution.input_power,
        solution.efficiency,
    )
    figures = dict(_figures(solution))
    methods = dict(_methods(built))
    supplies = dict(solved_supplies(case, built.sets, solution))
    fluids = None if built.known_fluids is None else solution.state.fluids
    flags: SomeFlags = () if fluids is None else fluids.flags
    sharing = built.sets[""].sharing if "" in built.sets else None
    return Result(
        title=case.title,
        kind=case.kind,
        layout=built.layout,
        terms=terms,
        flow=flow,
        meshes={key: item for key, item in figures.items() if isinstance(item, MeshFigures)},
        bearings={key: item for key, item in figures.items() if isinstance(item, BearingFigures)},
        parts={
            key: item
            for key, item in figures.items()
            if not isinstance(item, MeshFigures | BearingFigures)
        },
        fluid=None if fluids is None else fluids.figures,
        models=dict(_models(case, built)),
        standing=dict(_standing(case, built, supplies)),
        flags=(*flags, *_flags(solution)),
        notes=(
            *general_notes(terms, flow.input_power, flow.efficiency),
            *_train_notes(case, solution),
            *_floating_notes(solution),
            *_heat_notes(settled),
            *_set_notes(case, built, solution),
        ),
        load_methods={key: title for key, (title, _) in methods.items()},
        load_sources={key: source for key, (_, source) in methods.items()},
        sources=_sources(terms, methods),
        case=case,
        planet_angles=() if sharing is None else sharing.angles,
        planet_shares=next(
            (
                item.shares
                for key, item in solution.results.items()
                if isinstance(item, GearSetResult) and not key
            ),
            (),
        ),
        train=_train(case, built, solution),
        heat=_heat(case, built, settled),
        lubrication=supplies,
    )


def _heat(case: Case, built: Built, settled: Settled) -> HeatBalance | None:
    """Temperatures and the ways of the heat; None if everything is at the inlet temperature."""
    if built.thermal is None:
        return None
    answer, solution = settled.answer, settled.solution
    return HeatBalance(
        model=case.models.temperatures,
        temperatures=answer.temperatures,
        sources=heat_of(solution),
        ways=tuple(_ways(case, answer)),
        given=answer.given,
        residual=answer.residual,
        evaluations=settled.evaluations,
    )


def _ways(case: Case, answer: Answer) -> Iterator[HeatWay]:
    flows = answer.flows or {}
    for link in answer.links:
        yield HeatWay(
            link.key,
            link.hot,
            link.target,
            flows[link.key],
            link.conductance,
            link.method,
            link.source,
        )
    power = case.thermal.cooler_power
    if answer.links and power:
        yield HeatWay("oil-cooler", OIL, "cooler", power, math.nan, "given power", "given")


def _losses(solution: Solution) -> Iterator[tuple[str, Loss]]:
    yield from solution.given.items()
    for key, result in solution.results.items():
        for name, loss in result.losses.items():
            yield joined_key(key, name), loss


def _term(name: str, loss: Loss) -> LossTerm:
    return LossTerm(
        name, loss.watts, loss.group, loss.method, loss.source, loss.factor, loss.left_out
    )


def _figures(solution: Solution) -> Iterator[tuple[str, Any]]:
    for key, result in solution.results.items():
        for name, item in result.figures.items():
            yield joined_key(key, name) if name else key, item


def _flags(solution: Solution) -> Iterator[ValidityFlag]:
    """Flags of all elements, those of a train with the name of their set."""
    for key, result in solution.results.items():
        if not key:
            yield from result.flags
            continue
        for flag in result.flags:
            yield replace(flag, use=replace(flag.use, where=f"{key}: {flag.use.where}"))


def _methods(built: Built) -> Iterator[tuple[str, tuple[str, str]]]:
    """How the load along the teeth and between planets is found, for each set."""
    for key, own in built.sets.items():
        distribution = LOAD_DISTRIBUTIONS[own.meshes[0].models.load_distribution]
        yield joined_key(key, "load_distribution"), (distribution.title, distribution.source)
        if own.sharing is not None:
            yield joined_key(key, "load_sharing"), SHARING_METHODS[own.sharing.method]


def _sources(terms: Iterable[LossTerm], methods: Methods) -> tuple[str, ...]:
    """Sources of the terms that are included and of the load, each once, in order."""
    sources = [term.source for term in terms if not term.left_out]
    sources += [source for _, source in methods.values()]
    return tuple(dict.fromkeys(source for source in sources if source))


def _models(case: Case, built: Built) -> Iterator[tuple[str, str]]:
    for key, own in set_cases(case, built.sets):
        for name, model in resolve_models(own).items():
            yield joined_key(key, name), model


def _standing(
    case: Case, built: Built, supplies: Mapping[str, OilSupply]
) -> Iterator[tuple[str, str]]:
    for key, supply in supplies.items():
        idle = supply.method == "dip" and not supply.churning
        remark = "; nothing that turns reaches the oil" if idle else ""
        yield joined_key(key, "lubrication"), supply.text + remark
    for key, own in set_cases(case, built.sets):
        for role, phrase in standing_of(own).items():
            compared = supplies[key].comparison if role == "churning" else ""
            yield joined_key(key, role), f"{compared}; {phrase}" if compared else phrase
    for element in built.machine.elements:
        if isinstance(element, ShaftBearing):
            name = element.model.name
            phrase = f"{name}: {SHAFT_BEARING_RELIABILITY[name]}"
            yield joined_key(element.key, "shaft_bearing"), phrase


def _set_notes(case: Case, built: Built, solution: Solution) -> Iterator[str]:
    for key, own in set_cases(case, built.sets):
        found = solution.results[key]
        assert isinstance(found, GearSetResult)
        turning = {
            name.removesuffix("_drag")
            for name, discs in built.sets[key].discs.items()
            if solution.speeds[discs[0].body] != 0
        }
        for note in case_notes(own, found, turning):
            yield f"{key}: {note}" if key else note
    for result in solution.results.values():
        if not isinstance(result, GearSetResult):
            yield from result.notes


def _train_notes(case: Case, solution: Solution) -> Iterator[str]:
    if not isinstance(case, TrainCase):
        return
    if solution.jammed:
        yield (
            "Self-locking: whatever the torque on the output, friction in the meshes does not let "
            "the train turn under this torque on the input; it stands still, and nothing is lost."
        )
    elif solution.self_locking:
        output = case.shape.shaft_of(case.operation.output) or ""
        yield (
            "Self-locking: no power passes from the input to the output; the output "
            f"{case.operation.output} must be driven too, with "
            f"{solution.torques[output]:.6g} N*m."
        )
    if not solution.unique:
        yield (
            "Some members share their load in more than one possible way (brakes, clutches or "
            "meshes in parallel): of all torques in balance, the smallest are shown."
        )


def _heat_notes(settled: Settled) -> Iterator[str]:
    if settled.change > AGREEMENT:
        yield (
            f"Temperatures and losses agree to {settled.change:.1g} K only: a loss scatters from "
            "one evaluation to the next, as that of a flow through pockets that does not repeat."
        )


def _floating_notes(solution: Solution) -> Iterator[str]:
    for key in sorted(solution.floating):
        yield (
            f"{in_words(key.removeprefix('.'))}: next to no torque passes, and the teeth float in "
            "their backlash: with the losses on either flank they would be pressed to the other "
            "one. The losses are those on one flank; on the other the flow through the pockets "
            "loses another amount, so that the loss jumps over a small range of torque."
        )


def _train(case: Case, built: Built, solution: Solution) -> Train | None:
    if not isinstance(case, TrainCase):
        return None
    ends = [
        case.shape.shaft_of(name) or "" for name in (case.operation.input, case.operation.output)
    ]
    shafts = {*built.layout.members, HOUSING}
    return Train(
        state=case.operation.state or "",
        ratio=solution.ratio,
        power_ratio=solution.power_ratio,
        rolling={key: solution.rolling[key] for key in built.layout.rolling},
        clutches=solution.couplings,
        stages={
            name: {body: torque for body, torque in taken.items() if body in shafts}
            for name, taken in stage_torques(built.machine, solution).items()
        },
        self_locking=solution.self_locking,
        jammed=solution.jammed,
        input=ends[0],
        output=ends[1],
    )
