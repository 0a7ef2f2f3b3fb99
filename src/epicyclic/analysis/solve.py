"""`solve`: the losses of a case.

Parts that do not depend on the operating point (geometry, contact lines, load shape), and parts
that depend on some of it only (roller loads on the torque), are cached by what they depend on, so
that a sweep does them once.
"""

from __future__ import annotations

import math

from epicyclic.analysis.pair import pair_duty, solve_pair
from epicyclic.analysis.parts import MeshDuty, elastic_loads, fluids_of, load_mesh
from epicyclic.analysis.planetary import most_loaded_duties, planetary_duties, solve_planetary
from epicyclic.analysis.pockets import flow_numbers
from epicyclic.analysis.result import Result
from epicyclic.case.case import Case, PlanetaryCase
from epicyclic.elasticity.loaded_mesh import LoadedMesh
from epicyclic.errors import ConvergenceError
from epicyclic.losses.contact import MeshContact
from epicyclic.pocketing.similarity import FlowFamily
from epicyclic.pocketing.table import FlowTables

__all__ = ["loaded_duties", "loaded_meshes", "mesh_contacts", "pocket_flow_numbers", "solve"]


def solve(case: Case, *, flow_tables: FlowTables | None = None) -> Result:
    """The losses of a case.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
        From `load_case`.
    flow_tables : mapping, optional
        Tables of flows through pockets, as `sweep` makes them for its points; flows that they do
        not hold are solved.

    Returns
    -------
    Result

    Raises
    ------
    ConvergenceError
        If an iteration ends without a solution, or a loss is no finite number.
    """
    tables = flow_tables or {}
    if isinstance(case, PlanetaryCase):
        result = solve_planetary(case, tables)
    else:
        result = solve_pair(case, tables)
    bad = [term.name for term in result.terms if not math.isfinite(term.watts)]
    if bad:
        raise ConvergenceError(
            f"{', '.join(bad)} came out as no finite number: the case is far outside the range of "
            "the models; choose others (models.friction, models.rolling, models.bearing)."
        )
    return result


def pocket_flow_numbers(case: Case) -> tuple[tuple[FlowFamily, float], ...]:
    """Family and number of the flow through the pockets of every mesh whose loss is included."""
    if isinstance(case, PlanetaryCase):
        duties: tuple[MeshDuty, ...] = planetary_duties(case, 1 / case.planet.count)
    else:
        duties = (pair_duty(case),)
    return tuple(flow_numbers(case, duties, fluids_of(case).mixture))


def mesh_contacts(case: Case) -> dict[str, MeshContact]:
    """Conditions along the contact lines of every mesh of a case; empty without load or motion.

    Of a planetary set both meshes of the most loaded planet.
    """
    oil = fluids_of(case).oil
    contacts = {
        duty.key: load_mesh(duty, case.models, case.numerics, oil) for duty in loaded_duties(case)
    }
    return {key: contact for key, contact in contacts.items() if contact is not None}


def loaded_meshes(case: Case) -> dict[str, LoadedMesh]:
    """Every mesh of a case under load, with elastic teeth whatever ``models.load_distribution`` is.

    Line loads, load of each pair of teeth, contact pattern, transmission error and stiffness over
    the mesh period; of a planetary set for the most loaded planet. Empty without load.
    """
    return {
        duty.key: elastic_loads(duty, case.numerics)
        for duty in loaded_duties(case)
        if duty.torque1 != 0
    }


def loaded_duties(case: Case) -> tuple[MeshDuty, ...]:
    """The mesh of a pair, or both meshes of the planet that carries most."""
    return most_loaded_duties(case) if isinstance(case, PlanetaryCase) else (pair_duty(case),)
