"""What the builders hand on: a machine, how it is driven, and the words about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from epicyclic.machine.element import Fluids, State, joined_key
from epicyclic.machine.gear_mesh import MeshDuty
from epicyclic.machine.gear_set import GearSet
from epicyclic.machine.heat import Answer, Settled, ThermalModel, settle
from epicyclic.machine.machine import Machine, Operation
from epicyclic.machine.planets import PlanetLoad
from epicyclic.machine.solve import lossless_state, solve_machine
from epicyclic.result.result import Layout


@dataclass(frozen=True, slots=True)
class Built:
    """A machine that can be solved."""

    machine: Machine
    operation: Operation
    known_fluids: Fluids | None  # Oil and mixture; None if every loss is given.
    # Those whose losses are computed; the key of a single set is empty.
    sets: Mapping[str, GearSet]
    layout: Layout  # What its result consists of.
    # How temperatures follow from losses; None if all are those of the oil inlet.
    thermal: ThermalModel | None = None

    @property
    def fluids(self) -> Fluids:
        """Oil and mixture of a machine that computes losses."""
        assert self.known_fluids is not None, "a machine of given efficiencies has no oil"
        return self.known_fluids

    def solve(self) -> Settled:
        """Torques, losses and temperatures that agree."""
        if self.thermal is None:
            solution = solve_machine(self.machine, self.operation, self.known_fluids)
            return Settled(solution, Answer({}), 1)
        return settle(self.machine, self.operation, self.thermal)

    def state(self) -> State:
        """Speeds, and torques as without losses."""
        return lossless_state(self.machine, self.operation, self.known_fluids)

    def loaded_state(self) -> State:
        """Speeds, torques and oil in balance with all losses."""
        return self.solve().solution.state

    def loaded_duties(self, state: State) -> dict[str, MeshDuty]:
        """The meshes of the planet that carries most, of every set, by their keys."""
        return {
            joined_key(name, duty.key): duty
            for name, own in self.sets.items()
            for duty in own.loaded_duties(state)
        }

    def mean_duties(self) -> dict[str, MeshDuty]:
        """The meshes of a planet that carries its mean share, of every set, by their keys."""
        state = self.state()
        return {
            joined_key(name, duty.key): duty
            for name, own in self.sets.items()
            for duty in own.mean_duties(state)
        }

    def planet_loads(self) -> dict[str, PlanetLoad]:
        """Load on the bearing of a planet that carries its mean share, of every set."""
        state = self.state()
        return {
            joined_key(name, key): load
            for name, own in self.sets.items()
            for key, load in own.mean_loads(state).items()
        }
