"""`solve`: the losses of a case, and its sets with computed losses."""

from __future__ import annotations

import gc
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from typing import Any

from epicyclic.build.machine import Built, build, solve_all
from epicyclic.build.result import assemble
from epicyclic.case.case import Case, TrainCase
from epicyclic.case.tables.models import AS_TESTED, COMPUTED
from epicyclic.contact.elastic_teeth import LoadedMesh
from epicyclic.errors import one_problem
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.pocket_tables import FlowFamily, FlowTables, scaled_figures, table_around
from epicyclic.machine.element import OIL
from epicyclic.machine.gear_mesh import elastic_loads, load_mesh
from epicyclic.machine.heat import Settled
from epicyclic.machine.pocket_flow import flow_numbers, flow_requests
from epicyclic.result.physical import judged
from epicyclic.result.result import Result
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.operating import AXES


def build_computed(case: Case) -> Built:
    """The machine of a case with gears.

    Raises `InputError` if it is a train in which every set has a given efficiency: there are no
    teeth to look at.
    """
    built = build(case)
    if not built.sets or built.known_fluids is None:
        allowed = "have given efficiencies only, so their teeth are unknown."
        remedy = (
            "Give the gears of a set (module, face widths, roughness) instead of its efficiency."
        )
        raise one_problem("sets", "", allowed, remedy, case.source)
    return built


# `solve`: the losses of a case.
#
# Parts that do not depend on the operating point (geometry, contact lines, load shape), and parts
# that depend on some of it only (roller loads on the torque), are cached by what they depend on, so
# that a sweep does them once.

WARMER = (30.0, 60.0)
"""How much warmer than its inlet the oil is where tables are asked for flows through pockets; they
are read between two of their flows where one between them was foretold. [K]"""


def solve(
    case: Case,
    *,
    # Tables of flows through pockets; flows that they do not hold are solved.
    flow_tables: FlowTables | None = None,
) -> Result:
    """The losses of a case; errors as for `epicyclic.solve`."""
    (found,) = solve_together([case], flow_tables)
    if isinstance(found, Exception):
        raise found
    return found


def solve_together(
    cases: Sequence[Case], flow_tables: FlowTables | None
) -> list[Result | Exception]:
    """The losses of cases, or what is wrong with each of them.

    As `solve` has them but for rounding, whichever cases are solved together.
    """
    found = _each_of(assemble, cases, flow_tables)
    tested = {
        number: case
        for number, case in enumerate(cases)
        if case.models.load_dependent == AS_TESTED and not isinstance(found[number], Exception)
    }
    unloaded = _each_of(assemble, list(tested.values()), flow_tables, without_torque)
    for number, other in zip(tested, unloaded, strict=True):
        found[number] = (
            other if isinstance(other, Exception) else replace(found[number], unloaded=other.total)
        )
    return [it if isinstance(it, Exception) else judged(it) for it in found]


def losses_and_powers(
    cases: Sequence[Case],
    flow_tables: FlowTables,
    changed: Callable[[Case], Case] | None = None,  # To what no longer forms its losses as tested.
) -> list[tuple[dict[str, float], float] | Exception]:
    """Losses and input power alone of cases whose losses are not formed as tested. [W]"""
    return _each_of(_losses_and_power, cases, flow_tables, changed)


def _each_of(
    found_of: Callable[[Case, Built, Settled], Any],
    cases: Sequence[Case],
    flow_tables: FlowTables | None,
    changed: Callable[[Case], Case] | None = None,
) -> list[Any]:
    """What follows from the solution of each case, `changed`, or what is wrong with it."""
    found: dict[int, Any] = {}
    built: dict[bool, dict[int, tuple[Case, Built]]] = {True: {}, False: {}}
    for number, case in enumerate(cases):
        try:
            own = case if changed is None else changed(case)
            one = build(own, flow_tables)
        except Exception as error:
            found[number] = error
        else:
            built[one.thermal is None][number] = own, one
    with ExitStack() as after:
        if gc.isenabled():  # hardly anything is garbage meanwhile: to look for it takes a tenth
            gc.disable()
            after.callback(gc.enable)
        for those in built.values():
            bare = found_of is _losses_and_power
            every = solve_all([one for _, one in those.values()], bare=bare)
            for (number, of), settled in zip(those.items(), every, strict=True):
                found[number] = settled
                if not isinstance(settled, Exception):
                    try:
                        found[number] = found_of(*of, settled)
                    except Exception as error:
                        found[number] = error
    return [found[number] for number in range(len(cases))]


def _losses_and_power(case: Case, built: Built, settled: Settled) -> tuple[dict[str, float], float]:
    solution = settled.solution
    losses = {name: solution.losses[name].watts for name in built.layout.losses}
    return losses, solution.input_power


def without_torque(case: Case) -> Case:
    """The case with no torque but that which its losses cause."""
    changes = {"models.load_dependent": COMPUTED, AXES["torque"]: "0 N*m"}
    if isinstance(case, TrainCase):
        changes |= {f"operation.torques.{shaft}": "0 N*m" for shaft in case.operation.torques}
    return case.updated(changes)


def pocket_flow_numbers(case: Case) -> tuple[tuple[FlowFamily, float], ...]:
    """Family and number of the flow through the pockets of every mesh whose loss is included.

    Where the oil warms up, also the numbers in oil that is warmer by `WARMER`.
    """
    built = build(case)
    if built.known_fluids is None:
        return ()
    duties = tuple(built.mean_duties().values())
    fluids = [built.fluids]
    if built.thermal is not None and OIL in built.thermal.start:
        around = built.fluids.oil.temperature
        fluids += [
            built.thermal.fluids(dict.fromkeys(built.thermal.start, around + rise))
            for rise in WARMER
        ]
    return tuple(number for each in fluids for number in flow_numbers(duties, each))


def flows_around(
    case: Case,
    reach: float,  # Difference of the numbers, relative, at most. [1]
) -> FlowTables:
    """The flows of a case, for flows of nearly the same number. Theory (Q22)."""
    built = build(case)
    if built.known_fluids is None:
        return {}
    duties = tuple(built.mean_duties().values())
    found = {}
    for family, speed, mixture, pressure in flow_requests(duties, built.fluids):
        figures = family.figures(speed, mixture, pressure)
        if figures.periodic:
            scaled = scaled_figures(figures, speed, mixture.density)
            found[family] = table_around(family.number(speed, mixture, pressure), scaled, reach)
    return found


def mesh_contacts(case: CaseSource) -> dict[str, MeshContact]:
    """Conditions along the contact lines of every mesh of a case; empty without load or motion.

    Of a planetary set both meshes of the most loaded planet.
    """
    built = build_computed(as_case(case))
    state = built.loaded_state()
    contacts = {
        key: load_mesh(duty, state.fluids.at(key), state.fluids.oil)
        for key, duty in built.loaded_duties(state).items()
    }
    return {key: contact for key, contact in contacts.items() if contact is not None}


def loaded_meshes(case: CaseSource) -> dict[str, LoadedMesh]:
    """Every mesh of a case under load, with elastic teeth whatever ``models.load_distribution`` is.

    Line loads, load of each pair of teeth, contact pattern, transmission error and stiffness over
    the mesh period; of a planetary set for the most loaded planet. Empty without load.
    """
    built = build_computed(as_case(case))
    duties = built.loaded_duties(built.loaded_state())
    return {key: elastic_loads(duty) for key, duty in duties.items() if duty.torque1 != 0}
