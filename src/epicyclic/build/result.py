"""From the solution of a machine to the result that the user sees, with its notes."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property, lru_cache, partial
from itertools import chain, pairwise
from typing import Any, TypeVar, cast

import numpy as np

from epicyclic.build.machine import IN_BATH, Built
from epicyclic.build.models import ONLY_WITH, SetCase, oil_share, standing_of, with_lubrication
from epicyclic.case.case import Case, TrainCase
from epicyclic.case.tables.models import ContactSolver, LoadSharing
from epicyclic.case.tables.operation import SHARE_KEY, HousingTable, ThermalTable
from epicyclic.case.tables.uncertainty import stated_values
from epicyclic.contact.fitted_models import changed_properties
from epicyclic.gears.assembly import spacing_notes
from epicyclic.gears.gear import HOUSING
from epicyclic.gears.gearing import DEFAULT_RIM_THICKNESS, rim_thickness
from epicyclic.gears.mesh import are_evenly_spaced
from epicyclic.gears.rules import tooth_notes
from epicyclic.losses.contact import LOAD_DISTRIBUTIONS
from epicyclic.losses.friction import CONTAINS_ROLLING, TALBOT_FLUID
from epicyclic.losses.ranges import ModelUse, SomeFlags, ValidityFlag
from epicyclic.losses.reliability import RELIABILITY
from epicyclic.losses.shaft_bearing import SHAFT_BEARING_RELIABILITY
from epicyclic.losses.windage import DRAG_METHODS, LAMINAR_RIMS, DragModel
from epicyclic.machine.disc import churned, disc_loss, drags_by_model
from epicyclic.machine.element import OIL, Figures, Note, State, joined_key, note_watts
from epicyclic.machine.gear_mesh import MeshFigures
from epicyclic.machine.gear_set import GearSet, GearSetResult
from epicyclic.machine.heat import AGREEMENT, Answer, Settled, heat_of
from epicyclic.machine.planets import SHARING_METHODS, BearingFigures
from epicyclic.machine.pocket_flow import oil_in_mesh
from epicyclic.machine.shaft_parts import ShaftBearing
from epicyclic.machine.solve import Solution, stage_torques
from epicyclic.oil.oil import Oil, oil_state
from epicyclic.result.result import (
    HeatBalance,
    HeatPath,
    LossTerm,
    MemberState,
    OilSupply,
    PowerFlow,
    Result,
    Train,
    in_words,
)
from epicyclic.units import GIGAPASCAL, NEWTON, WATT, percent, torque_text


def oil_supplies(
    cases: Mapping[str, SetCase],
    sets: Mapping[str, GearSet] | None = None,  # For what the speeds make of it.
    state: State | None = None,
) -> Iterator[tuple[str, OilSupply]]:
    """How oil gets to the gears of each set that says so, by the key of the set."""
    for key, case in cases.items():
        if case.lubrication is None:
            continue
        share, method = oil_share(case), case.lubrication.method
        supply = OilSupply(method, share.share, *share.band, share.grade, share.source)
        if sets is not None and state is not None:
            discs = [disc for discs in sets[key].discs.values() for disc in discs]
            meshes = {duty.gears.key: oil_in_mesh(duty) for duty in sets[key].mean_duties(state)}
            supply = replace(supply, churning=churned(discs, state), meshes=meshes)
        yield key, supply


# Notes: what a user must know about a result besides its numbers.


NOT_INCLUDED = "Not included"  # Begins the note that names loss terms which are missing.
UNCOVERED = "No friction model covers"  # Begins the note on what no model is made for.
GEAR_PRESSURE = 2.4e9
"""1.6 times the endurance limit of 1.5 GPa of case-hardened steel: life factor for static load of
ISO 6336-2, limit of ISO 6336-5, grade MQ (general knowledge). [Pa]"""
BEARING_PRESSURE = 4.0e9
"""Pressure of a roller on its race at the static load rating of ISO 76 (general knowledge). [Pa]"""
IDLE_PART = 0.3  # Part of the most loaded roller without load from which a result says so. [1]
SOFT = 20e9  # Modulus below which a material is a plastic: metals have 40 GPa or more. [Pa]
LEAST_SLOPE, LARGEST_SLOPE = 1.0, 5.5
"""Slopes of ASTM D341 between which all lubricants are: silicones have 1.2, oils of a viscosity
index below zero 4.6, by viscosities from general knowledge. [1]"""
LEAST_CONTACT = 0.75  # Share of the contact lines that carries below which a result says so. [1]


def case_notes(
    case: SetCase,
    found: GearSetResult,
    turning: Collection[str],  # Central gears that turn.
) -> Iterator[str]:
    """What a user must know about a set: its oil, its load, its flows, its planets."""
    before, behind = _notes_of_tables(case)
    yield from before
    figures = {
        name: found.figures[name]
        for name in found.figures
        if (own := found.extremes.get(name)) is None
        or own.pressure > GEAR_PRESSURE
        or own.share < LEAST_CONTACT
    }
    for name, mesh in figures.items():
        if isinstance(mesh, MeshFigures) and mesh.contact_share < LEAST_CONTACT:
            yield (
                f"Only {percent(mesh.contact_share, 0)} of the contact lines of the "
                f"{name.replace('_', ' ')} carry load: the deviations of the flanks exceed the "
                "deflection of the teeth. Contact that begins or ends beyond the path of contact "
                "is not modelled."
            )
    yield from pressure_notes(figures)
    yield from found.notes
    yield from behind
    if case.sharing is not None and found.shares:
        yield from _share_notes(case.sharing, found.shares)
    for name, table, _ in case.gearing.rings():
        if name in turning and rim_thickness(table) is None:
            yield Note(
                f"{case.gearing.key(name)}.rim_thickness is not given, so the drag of the turning "
                f"ring is computed for a rim of {DEFAULT_RIM_THICKNESS:g} normal modules."
            )


@lru_cache(maxsize=16)
def _notes_of_tables(case: SetCase) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """What is known before anything is solved: what comes before the other notes, and behind."""
    before: list[str] = list(map(Note, (*fluid_notes(case), *lubrication_notes(case))))
    oil = case.lubricant.oil
    warm = sorted(point.temperature for point in oil.kinematic_viscosity)
    slopes = [oil_state(oil, (one + two) / 2).d341_slope for one, two in pairwise(warm)]
    if not LEAST_SLOPE < min(slopes) <= max(slopes) < LARGEST_SLOPE:
        before.append(
            f"The viscosity of {oil.name} changes with temperature as that of no lubricant does: "
            "correct it at one of its temperatures."
        )
    if len(oil.density) > 1 and oil.density_slope != Oil.model_fields["density_slope"].default:
        before.append(f"density_slope of {oil.name} has no effect beside several densities.")
    before += [*load_notes(case), *tooth_notes(case.gearing)]
    behind = [*case.found, *spacing_notes(case.gearing)]
    if case.gearing.listed and case.models.mesh_loads == "without-losses":
        without = "models.mesh_loads = without-losses"
        behind.append(f"{without} has no effect on a set whose gears are listed.")
    bare = any(getattr(it, "cage", "") == "full-complement" for it in case.bearings.values())
    if bare and case.models.bearing == "auto":
        behind.append(
            "models.bearing = auto is Palmgren's formula for rollers without a cage; "
            "full-complement computes how they rub on each other."
        )
    for key in sorted(case.models.model_fields_set & {key for _, key in ONLY_WITH}):
        roles, words = ONLY_WITH["models", key]
        chosen = [case.chosen.get(role, "") for role in roles]
        changed = getattr(case.models, key) != type(case.models).model_fields[key].default
        if changed and not any(word in name for word in words for name in chosen):
            behind.append(f"models.{key} has no effect with models.{roles[0]} = {chosen[0]}.")
    friction = case.chosen["friction"]
    for name, model, stated in (
        ("friction_table", "table", case.friction_table is not None),
        ("contact_solver", "ehl-direct", case.contact_solver != ContactSolver()),
    ):
        if stated and friction != model:
            behind.append(f"[{name}] has no effect with models.friction = {friction}.")
    return tuple(before), tuple(map(Note, behind))


def fluid_notes(case: SetCase) -> Iterator[str]:
    """What was made for another oil than that of the case, and what the case changes in it."""
    oil, models = case.lubricant.oil, case.chosen
    bearing = any(name in models.get("bearing", "") for name in ("mixed-ehl", "full-complement"))
    fluids = {
        "friction": (models["friction"], case.friction.made_for),
        "rolling": (models["rolling"], case.rolling.made_for),
        "bearing": ("mixed-ehl", TALBOT_FLUID if bearing else None),
    }
    for key, (name, fluid) in fluids.items():
        if fluid is not None and fluid.key != oil.friction_regression:
            made = f"the regression {name} was made for {fluid.title}"
            yield f"models.{key}: {made}, not for {oil.name}."
    given = case.models.oil_model is not None
    if given and any("fitted" in name for name in models.values()):
        model = case.oil_model
        if model is not None and model.oil != oil:
            yield f"models.oil_model was fitted for {model.oil.name}, not for {oil.name}."
    changed = changed_properties(oil)
    if not given and changed and "auto" in (getattr(case.models, key, "") for key in RELIABILITY):
        yield (
            f"The models built in for {oil.name} are not used, because this oil differs from it in "
            f"{', '.join(changed)}; 'epicyclic oil characterise' fits models for it."
        )
    if case.models.temperatures != "inlet" and case.friction.takes_oil_temperature:
        yield (
            f"models.friction: {models['friction']} was fitted to tests by their oil "
            "temperature, so it uses the temperature of the oil around the gears and not of "
            "the flanks."
        )
    if models["friction"] in CONTAINS_ROLLING or (
        "schlenk" in models["friction"] and "lubricant_factor" not in oil.model_fields_set
    ):
        found = oil.lubricant_factor
        source = f" ({found.source})" if found.source else ""
        yield f"models.friction: the oil has X_L = {found.value:g}{source}."
    factor = case.lubricant.pressure_viscosity_factor
    if factor != 1:
        yield f"The pressure-viscosity coefficient of the oil is multiplied by {factor:g}."


def lubrication_notes(case: SetCase) -> Iterator[str]:
    """What a stated share of oil overrides, and what is left out of the losses."""
    table = case.lubrication
    if table is None:
        return
    if "oil_air_ratio" in case.surroundings.model_fields_set:
        yield (
            f"{SHARE_KEY} has no effect: the share of oil follows from [lubrication]; give a "
            "known share as oil_share there."
        )
    if table.method == "jet" and table.oil_flow is None:
        yield (
            "lubrication.oil_flow is not given: the oil that jets bring between the teeth, and the "
            "power that accelerates it, are left out."
        )
    if table.method == "grease":
        yield (
            f"{UNCOVERED} starved films of grease: films and friction are those of enough base "
            "oil, lubricant.oil, and the churning of the grease is left out; the band does not "
            "contain that difference."
        )
    if table.method == "dip":
        left_out = ["of planets"] if case.gearing.planets else []
        left_out += ["inside rings"] if list(case.gearing.rings()) else []
        if left_out:
            yield f"Churning {' and '.join(left_out)} is not modelled."


def pressure_notes(figures: Mapping[str, object]) -> Iterator[str]:
    """Contacts pressed beyond what steel bears, and rollers of which much carries nothing."""
    for key, found in figures.items():
        name = key.replace("_", " ")
        if isinstance(found, MeshFigures) and found.hertz_pressure_max > GEAR_PRESSURE:
            yield (
                f"The contact pressure on the teeth of the {name} is "
                f"{GIGAPASCAL.text(found.hertz_pressure_max, 3)}; hardened steel withstands "
                f"about {GIGAPASCAL.text(GEAR_PRESSURE, 2)} for a few load cycles."
            )
        if isinstance(found, BearingFigures):
            if found.hertz_pressure_max > BEARING_PRESSURE:
                yield (
                    f"The contact pressure on the rollers of the {name} is "
                    f"{GIGAPASCAL.text(found.hertz_pressure_max, 3)}; at the static load rating "
                    f"of a roller bearing it is {GIGAPASCAL.text(BEARING_PRESSURE, 2)}."
                )
            idle = 0.0  # part of the most loaded roller that carries nothing
            if found.loads is not None and found.roller_load_max:
                rollers = found.loads.intensity.sum(axis=2)
                row, most = np.unravel_index(int(rollers.argmax()), rollers.shape)
                idle = float(np.mean(found.loads.intensity[row, most] == 0))
            if idle > IDLE_PART:
                yield (
                    f"{name.capitalize()}: {percent(idle, 0)} of the length of the most loaded "
                    f"roller carries none of its {NEWTON.text(found.roller_load_max, 3)}, "
                    f"because a moment of {torque_text(found.moment, 3)} tilts the planet."
                )


def load_notes(case: SetCase) -> Iterator[str]:
    """Deviations that the load distribution ignores, and rims that leave what is assumed."""
    model, gearing = case.models.load_distribution, case.gearing
    deviates = any(mesh.table.misalignment for mesh in gearing.meshes) or any(
        getattr(table, key, None) is not None
        for table in gearing.tables.values()
        for key in ("micro_geometry", "micro_geometry_ring_side")
    )
    if deviates and not LOAD_DISTRIBUTIONS[model].takes_deviations:
        yield (
            f"models.load_distribution = {model} ignores micro-geometry and misalignment; "
            "compliance takes them into account."
        )
    soft = [
        name.replace("_", " ")
        for name, table in gearing.tables.items()
        if table.material.elastic_modulus < SOFT
    ]
    if soft:
        yield (
            f"{UNCOVERED} plastic gears ({', '.join(soft)}): all hold for metal in "
            "oil, and the band does not contain that difference."
        )
    for name, table, ring in gearing.rings():
        thickness, key = rim_thickness(table), gearing.key(name)
        if thickness is None:
            continue
        height = ring.root_radius - ring.tip_radius
        if thickness < height:
            yield (
                f"{key}.rim_thickness is less than the tooth height, {1e3 * height:.4g} mm: the "
                "deflection of so thin a rim is outside what the compliance model covers."
            )
        even = are_evenly_spaced(gearing.planet_angles or (0.0,))
        if not even or (case.sharing is not None and case.sharing.method != "equal"):
            yield (
                f"{key}.rim_thickness: the rim deflection assumes evenly spaced and equally "
                "loaded planets, but these are "
                f"{'not equally loaded' if even else 'not evenly spaced'}."
            )


def general_notes(
    terms: Iterable[LossTerm], input_power: float, efficiency: float | None
) -> Iterator[str]:
    """Notes on what is missing, what is scaled, and on efficiency near zero load."""
    missing: dict[str, list[str]] = {}
    for term in terms:
        if term.left_out:
            missing.setdefault(term.left_out, []).append(term.name)
        elif term.factor != 1.0:
            text = f"{in_words(term.name)} is multiplied by {term.factor:g}."
            yield Note(text, abs(term.watts - term.watts / term.factor)) if term.factor else text
    for reason, names in missing.items():
        yield f"{NOT_INCLUDED}: {', '.join(names)} ({reason})."
    if efficiency == 0.0 and input_power > 0:
        yield (
            "No power reaches the output: the losses consume all input power, so the output "
            "must be driven."
        )


def _share_notes(sharing: LoadSharing, shares: tuple[float, ...]) -> Iterator[str]:
    if len(set(shares)) > 1:
        most = shares.index(max(shares)) + 1
        yield Note(f"Meshes and bearing are those of planet {most}, the most loaded one.")
    idle = [str(number) for number, share in enumerate(shares, 1) if share == 0]
    if idle and sharing.method in ("closed-form", "direct"):
        beyond = ""
        if sharing.method == "closed-form":
            beyond = ", and load_sharing.method = closed-form is replaced by direct"
        yield (
            f"No load reaches {'planet' if len(idle) == 1 else 'planets'} {', '.join(idle)} of "
            f"{len(shares)}: the position errors exceed the deflection of the others{beyond}."
        )
    usual = LoadSharing()
    idle_keys = {"mesh_load_factor"} if sharing.method != "mesh-load-factor" else set()
    if sharing.method not in ("closed-form", "direct"):
        idle_keys |= {"position_errors", "floating_member", "support_stiffness", "pin_stiffness"}
    elif sharing.floating_member == "none":
        idle_keys.add("support_stiffness")
    for key in LoadSharing.model_fields:
        if key in idle_keys and getattr(sharing, key) != getattr(usual, key):
            idle_key = f"load_sharing.{key}"
            yield Note(f"{idle_key} has no effect with load_sharing.method = {sharing.method}.")


def assemble(case: Case, built: Built, settled: Settled) -> Result:
    """The result of a case from the solution of its machine."""
    solution = settled.solution
    losses = solution.losses
    terms = tuple(
        LossTerm(
            name, it.watts, it.group, it.method, it.source, it.factor, it.left_out, dict(it.shares)
        )
        for name in built.layout.losses
        for it in (losses[name],)
    )
    flow = PowerFlow(
        {
            name: MemberState(solution.speeds.get(name, 0.0), solution.torques.get(name, 0.0))
            for name in built.layout.members
        },
        solution.input_power,
        solution.efficiency,
    )
    figures, extremes = (
        {
            joined_key(key, name) if name else key: partial(found.__getitem__, name)
            for key, result in solution.results.items()
            for found in (getattr(result, kind),)
            for name in found
        }
        for kind in ("figures", "extremes")
    )

    def among(keys: Collection[str]) -> Figures[Any]:
        return Figures({key: figures.pop(key) for key in keys if key in figures})

    methods = dict(_methods(built))
    sources = [term.source for term in terms if not term.left_out]
    sources += [source for _, source in methods.values()]
    supplies = dict(oil_supplies(built.set_cases, built.sets, solution.state))
    fluids = None if built.known_fluids is None else solution.state.fluids
    flags: SomeFlags = () if fluids is None else fluids.flags
    sharing = built.sets[""].sharing if "" in built.sets else None
    alone = solution.results.get("")  # of a set by itself
    return Result(
        title=case.title,
        kind=case.kind,
        layout=built.layout,
        terms=terms,
        flow=flow,
        meshes=among(built.layout.meshes),
        bearings=among(built.layout.bearings),
        parts=Figures(figures),
        extremes=Figures(extremes),
        fluid=None if fluids is None else fluids.figures,
        models={
            joined_key(key, name): model
            for key, own in built.set_cases.items()
            for name, model in own.chosen.items()
        },
        standing=_WhenRead(partial(_standing, built, supplies, solution.state)),
        flags=(*flags, *_flags(solution)),
        notes=(
            *general_notes(terms, flow.input_power, flow.efficiency),
            *_solution_notes(case, settled),
            *_set_notes(built, solution),
        ),
        load_methods={key: title for key, (title, _) in methods.items()},
        load_sources={key: source for key, (_, source) in methods.items()},
        sources=tuple(dict.fromkeys(filter(None, sources))),
        case=case,
        planet_angles=() if sharing is None else sharing.angles,
        planet_shares=alone.shares if isinstance(alone, GearSetResult) else (),
        train=_train(case, built, solution),
        heat=_heat(case, built, settled),
        lubrication=supplies,
    )


Item = TypeVar("Item")


class _WhenRead(Mapping[str, Item]):
    """What is made when somebody reads it, which sweeps do not."""

    def __init__(self, make: Callable[[], Iterator[tuple[str, Item]]]) -> None:
        self._make = make

    @cached_property
    def _made(self) -> dict[str, Item]:
        return dict(self._make())

    def __getitem__(self, key: str) -> Item:
        return self._made[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._made)

    def __len__(self) -> int:
        return len(self._made)

    def __reduce__(self) -> tuple[Any, ...]:
        return dict, (self._made,)


def _heat(case: Case, built: Built, settled: Settled) -> HeatBalance | None:
    """Temperatures and the paths of the heat; None if everything is at the inlet temperature."""
    if built.thermal is None:
        return None
    answer, solution = settled.answer, settled.solution
    return HeatBalance(
        model=case.models.temperatures,
        temperatures=answer.temperatures,
        sources=heat_of(solution.losses.values()),
        ways=tuple(_heat_paths(case, answer)),
        given=answer.given,
        residual=answer.residual,
        evaluations=settled.evaluations,
    )


def _heat_paths(case: Case, answer: Answer) -> Iterator[HeatPath]:
    flows = answer.flows or {}
    for link in answer.links:
        how = link.conductance, link.method, link.source
        yield HeatPath(link.key, link.hot, link.target, flows[link.key], *how)
    power = case.thermal.cooler_power
    if answer.links and power:
        yield HeatPath("oil-cooler", OIL, "cooler", power, math.nan, "given power", "given")


def _flags(solution: Solution) -> Iterator[ValidityFlag]:
    """Flags of all elements, those of a train with the name of their set."""
    for key, result in solution.results.items():
        if not key:
            yield from result.flags
            continue
        for flag in result.flags:
            yield replace(flag, use=_within(key, flag.use))


@lru_cache(maxsize=256)
def _within(key: str, use: ModelUse) -> ModelUse:
    """The use of a model in a set of a train."""
    return replace(use, where=f"{key}: {use.where}")


def _methods(built: Built) -> Iterator[tuple[str, tuple[str, str]]]:
    """How the load along the teeth and between planets is found, for each set."""
    for key, own in built.sets.items():
        distribution = LOAD_DISTRIBUTIONS[own.meshes[0].models.load_distribution]
        yield joined_key(key, "load_distribution"), (distribution.title, distribution.source)
        if own.sharing is not None:
            yield joined_key(key, "load_sharing"), SHARING_METHODS[own.sharing.method]


def _standing(
    built: Built, supplies: Mapping[str, OilSupply], state: State
) -> Iterator[tuple[str, str]]:
    for key, supply in supplies.items():
        idle = supply.method == "dip" and not supply.churning
        remark = "; no turning part reaches the oil" if idle else ""
        yield joined_key(key, "lubrication"), supply.text + remark
    for key, own in built.set_cases.items():
        for role, phrase in standing_of(own).items():
            compared = supplies[key].comparison if role == "churning" else ""
            yield joined_key(key, role), f"{compared}; {phrase}" if compared else phrase
    for key, turning in built.sets.items():
        model = cast(DragModel, built.set_cases[key].chosen["drag"])
        if model == LAMINAR_RIMS:  # gears have no teeth
            continue
        found = drags_by_model(chain(*turning.discs.values()), state).items()
        beside = ", ".join(f"{name} {WATT.text(watts, 3)}" for name, watts in found)
        phrase = f"{model}: {DRAG_METHODS[model].reliability}"
        yield joined_key(key, "drag"), f"gears: {beside}; {phrase}" if beside else phrase
    for element in built.machine.elements:
        if isinstance(element, ShaftBearing):
            name = element.model.name
            phrase = f"{name}: {SHAFT_BEARING_RELIABILITY[name]}"
            yield joined_key(element.key, "shaft_bearing"), phrase


def _set_notes(built: Built, solution: Solution) -> Iterator[str]:
    for key, own in built.set_cases.items():
        found = solution.results[key]
        assert isinstance(found, GearSetResult)
        turning = {
            name.removesuffix("_drag")
            for name, discs in built.sets[key].discs.items()
            if solution.speeds[discs[0].body] != 0
        }
        discs, oil = [*chain(*built.sets[key].discs.values())], own.lubrication
        if oil is not None and oil.method == "dip" and discs:
            wetted = [it.sump.part.wetted_angle if it.dips and it.sump else 0.0 for it in discs]
            idle = "" if any(wetted) else "no turning part reaches the oil of the sump."
            if min(wetted) >= math.pi:
                idle = 'all turning parts are below the oil; method = "submerged" is for that.'
            if idle:
                yield Note(f"{key}: {idle}") if key else idle
            for disc in discs:
                if (sump := disc.sump) is None or not disc.dips:
                    continue
                dips = sump.power(sump.model, solution.speeds[disc.body], solution.state)
                above = disc_loss([replace(disc, sump=None)], solution.state)[0].watts
                if dips < above:
                    words = f"{disc.where}: by churning, it loses {WATT.text(dips, 3)}; above the "
                    words += f"oil it would lose {WATT.text(above, 3)}, of which none is added."
                    yield Note(f"{key}: {words}" if key else words, above - dips)
        for note in case_notes(own, found, turning):
            yield Note(f"{key}: {note}", note_watts(note)) if key else note
    for result in solution.results.values():
        if not isinstance(result, GearSetResult):
            yield from result.notes


_OF_HOUSING = {"height", "length", "air_speed", "emissivity", "fin_factor"}, {"coefficient"}
"""Keys of [thermal.housing] that iso-14179-1 does not use, and those of no other method."""


def _idle_heat(case: Case) -> Iterator[str]:
    """Keys of [thermal] without effect on a heat network beside the others."""
    table, housing = case.thermal, case.thermal.housing
    sets = case.computed_sets if isinstance(case, TrainCase) else [("", case)]
    wet = {with_lubrication(table, own.lubrication, None).lubrication for _, own in sets}
    way = f"with thermal.lubrication = {', '.join(sorted(wet))}"
    idle = {"bulk": "with models.temperatures = network"}
    idle |= {"bath_share": way} if wet <= {"spray", "submerged"} else {}
    idle |= {"jet_effectiveness": way} if wet <= {*IN_BATH} else {}
    if not table.cooler_conductance:
        idle["coolant_temperature"] = "without cooler_conductance"
    usual = ThermalTable()
    for key in sorted(key for key in idle if getattr(table, key) != getattr(usual, key)):
        yield f"thermal.{key} has no effect {idle[key]}."
    if housing is not None:
        usual_housing = HousingTable(area="1 m^2", method=housing.method)
        for key in sorted(_OF_HOUSING[housing.method != "iso-14179-1"]):
            if getattr(housing, key) != getattr(usual_housing, key):
                yield f"thermal.housing.{key} has no effect with method = {housing.method}."


def _solution_notes(case: Case, settled: Settled) -> Iterator[str]:
    """What is stated to no effect or beyond sense, and what is odd about torques and heat."""
    solution, thermal = settled.solution, case.thermal
    flows = thermal.oil_flow, getattr(case.lubrication, "oil_flow", None)
    if settled.answer.links and all(flows) and flows[0] != flows[1]:
        yield Note("Heat leaves by thermal.oil_flow, which differs from lubrication.oil_flow.")
    power = thermal.cooler_power if settled.answer.links else 0.0
    if power and power > (lost := sum(it.watts for it in solution.losses.values())):
        taken, given_off = (WATT.text(it, 3) for it in (power, lost))
        yield (
            f"thermal.cooler_power removes {taken}, and all losses are {given_off}: the cooler "
            "also cools the oil that flows in. Give at most the losses, or cooler_conductance."
        )
    if settled.answer.links:
        yield from map(Note, _idle_heat(case))
    for value in stated_values(case)[0].values() if getattr(case, "uncertainty", {}) else ():
        if value is not None and value.remark:
            yield f'uncertainty."{value.key}": {value.remark}. Correct the limits or the value.'
    if isinstance(case, TrainCase) and getattr(case.lubrication, "oil_level", None) is not None:
        tables = (table.lubrication for _, table in case.computed_sets)
        if case.lubrication not in tables:
            yield Note("lubrication.oil_level has no effect: no set dips by it.")
    stated_models = case.models.model_fields_set
    for name, own in case.computed_sets if stated_models and isinstance(case, TrainCase) else ():
        beside = stated_models - own.models.model_fields_set
        beside -= {"temperatures", "load_dependent"}  # which hold for the whole train
        idle = ", ".join(it for it in sorted(beside) if it in type(own.models).model_fields)
        if idle:
            yield Note(f"sets.{name}.models replaces [models]; not used for this set: {idle}.")
    if solution.jammed and isinstance(case, TrainCase):
        yield (
            "Self-locking: under this torque on the input, friction in the meshes keeps the "
            "train at rest, whatever the torque on the output. It stands still and loses no "
            "power."
        )
    elif solution.self_locking and isinstance(case, TrainCase):
        output = case.shape.shaft_of(case.operation.output) or ""
        yield (
            "Self-locking: no power passes from the input to the output; the output "
            f"{case.operation.output} must be driven too, with "
            f"{torque_text(solution.torques[output])}."
        )
    if not solution.unique and isinstance(case, TrainCase):
        yield (
            "The load of some members is statically indeterminate (brakes, clutches or meshes "
            "in parallel); of all torques in balance, the smallest are shown."
        )
    for key in sorted(solution.floating):
        yield (
            f"{in_words(key.removeprefix('.'))}: almost no torque is transmitted, and the teeth "
            "float within their backlash: the losses on either flank would press them against "
            "the other one. The losses shown are those on one flank. On the other flank the "
            "loss of the flow through the pockets differs, so the loss jumps within a small "
            "range of torque."
        )
    held = sorted(key for key in solution.standing if solution.meshes[key])
    if held:
        yield (
            f"{', '.join(in_words(key) for key in held)}: the teeth do not roll on each other, so "
            "their torques are those without friction. Static friction can also hold other "
            "torques, within the limits set by the given efficiency in both directions."
        )
    if settled.change > AGREEMENT:
        yield (
            f"Temperatures and losses agree to {settled.change:.1g} K only, because a loss "
            "scatters from one evaluation to the next, such as that of a flow through pockets "
            "that is not periodic."
        )


def _train(case: Case, built: Built, solution: Solution) -> Train | None:
    if not isinstance(case, TrainCase):
        return None
    ends = case.operation.input, case.operation.output
    driven, output = (case.shape.shaft_of(name) or "" for name in ends)
    return Train(
        state=case.operation.state or "",
        ratio=solution.ratio,
        power_ratio=solution.power_ratio,
        rolling={key: solution.rolling[key] for key in built.layout.rolling},
        clutches=solution.couplings,
        stages=_WhenRead(partial(_stages, built, solution)),
        self_locking=solution.self_locking,
        jammed=solution.jammed,
        input=driven,
        output=output,
    )


def _stages(built: Built, solution: Solution) -> Iterator[tuple[str, dict[str, float]]]:
    shafts = {*built.layout.members, HOUSING}
    for name, taken in stage_torques(built.machine, solution).items():
        yield name, {body: torque for body, torque in taken.items() if body in shafts}
