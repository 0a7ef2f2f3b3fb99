"""A gearbox of one temperature: what it stores, and what it gives to its surroundings."""

from __future__ import annotations

from typing import TYPE_CHECKING

from epicyclic.builders.build import build
from epicyclic.case.case import Case
from epicyclic.errors import one_problem
from epicyclic.machine.element import OIL
from epicyclic.machine.heat import NetworkModel
from epicyclic.study.maps.tables import map_inputs
from epicyclic.study.solve import solve

if TYPE_CHECKING:
    import xarray as xr

CAPACITY, CONDUCTANCE = "lumped_heat_capacity", "lumped_conductance"
SURROUNDINGS = "surroundings_temperature"
"""Attributes of a map whose temperature follows from its losses, in J/K, W/K and K."""


def with_temperature_state(data: xr.Dataset, case: Case) -> xr.Dataset:
    """A map with what makes its temperature follow from the losses, for an FMU.

    Parameters
    ----------
    data : xarray.Dataset
        From `loss_map`, with all parts at the temperature of the oil, over two temperatures or
        more.
    case : PlanetaryCase, GearPairCase or TrainCase
        Whose network of heat, settled at its operating point, gives the conductance.

    Raises
    ------
    InputError
        If the map has no axis of temperatures or was made at settled ones, or if what the case
        stores is not known.
    """
    check_axis(data.sizes.get("temperature", 0))
    if map_inputs(data).get("models", {}).get("temperatures") == "network":
        allowed = "must be inlet: the map is to hold the losses at the temperature of the oil."
        raise one_problem(
            "models.temperatures", '"network"', allowed, "Make the map anew.", "the map"
        )
    return data.assign_attrs(lumped(case))


def check_axis(count: int) -> None:
    """Raise `InputError` unless a map has several temperatures."""
    if count < 2:
        allowed = "must have two or more values, so that it can change."
        raise one_problem("temperature", "", allowed, 'Give more, as "20,60,100 degC".', "the map")


def lumped(case: Case) -> dict[str, float]:
    """Attributes of a map whose temperature follows from its losses. Theory (W39).

    Raises
    ------
    InputError
        If no temperatures follow from the losses, or what the case stores is not known.
    """
    if not case.computed:
        allowed = "has losses that are all given: no temperature follows from them."
        raise one_problem("case", "", allowed, "Choose one with an oil.")
    warm = case.updated({"models.temperatures": "network"})
    model = build(warm).thermal
    assert isinstance(model, NetworkModel)
    capacity = sum(model.capacities().values())
    heat = solve(warm).heat
    assert heat is not None
    leaving = [(heat.given[way.into], way.watts) for way in heat.ways if way.into in heat.given]
    whole = sum(watts for _, watts in leaving)
    if not whole > 0:
        allowed = "loses no power at its operating point, which tells the way of the heat."
        raise one_problem("operation", "", allowed, "Give a speed.")
    around = sum(kelvin * watts for kelvin, watts in leaving) / whole
    conductance = whole / (heat.temperatures[OIL] - around)
    return {CAPACITY: capacity, CONDUCTANCE: conductance, SURROUNDINGS: around}
