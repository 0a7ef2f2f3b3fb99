"""The oil at a temperature, and its mixture with air."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from epicyclic.elements.figures import FluidFigures
from epicyclic.losses.validity import ModelUse, Range, SomeFlags, ValidityFlag, check_ranges
from epicyclic.lubricant.oil import Oil
from epicyclic.lubricant.properties import (
    MixtureState,
    OilState,
    extrapolated_viscosity,
    mixture_state,
    oil_state,
)
from epicyclic.units import CELSIUS, SQUARE_MM_PER_SECOND

_VISCOSITY = Range(
    "kinematic_viscosity",
    "kinematic viscosity",
    2.0,
    2e7,
    SQUARE_MM_PER_SECOND,
    "ASTM D341, form for 2 mm^2/s and more",
)


@dataclass(frozen=True, slots=True)
class Fluids:
    """The oil, its mixture with air, and flags on both."""

    oil: OilState
    mixture: MixtureState
    pressure: float  # Ambient. [Pa]
    flags: SomeFlags
    # Oil at the contacts whose temperature differs, by the keys of meshes and bearings.
    contacts: Mapping[str, OilState] = field(default_factory=dict[str, OilState], hash=False)

    def at(self, contact: str) -> OilState:
        """The oil at a contact, at the temperature of its surfaces."""
        return self.contacts.get(contact, self.oil)

    def mixed(self, oil_fraction: float) -> MixtureState:
        """The oil with another share of it in the mixture, by volume."""
        if oil_fraction == self.mixture.oil_fraction:
            return self.mixture
        return mixture_state(self.oil, oil_fraction, self.pressure)

    @property
    def figures(self) -> FluidFigures:
        """The properties for the user."""
        return FluidFigures(
            kinematic_viscosity=self.oil.kinematic_viscosity,
            dynamic_viscosity=self.oil.dynamic_viscosity,
            density=self.oil.density,
            pressure_viscosity=self.oil.pressure_viscosity,
            mixture_density=self.mixture.density,
            mixture_viscosity=self.mixture.dynamic_viscosity,
        )


def oil_at(oil: Oil, temperature: float, pressure_viscosity_factor: float = 1.0) -> OilState:
    """Properties of an oil at `temperature` in kelvin, its alpha multiplied by a factor."""
    state = oil_state(oil, temperature)
    return replace(state, pressure_viscosity=pressure_viscosity_factor * state.pressure_viscosity)


def fluids_at(
    oil: Oil,
    temperature: float,  # [K]
    *,
    oil_air_ratio: float,  # Oil share by volume at ambient pressure. [1]
    pressure: float,  # Ambient. [Pa]
    # Multiplies the pressure-viscosity coefficient of the oil. [1]
    pressure_viscosity_factor: float = 1.0,
) -> Fluids:
    """Oil and mixture at one temperature."""
    state = oil_at(oil, temperature, pressure_viscosity_factor)
    mixture = mixture_state(state, oil_air_ratio, pressure)
    return Fluids(state, mixture, pressure, oil_flags(oil, temperature))


def oil_flags(oil: Oil, temperature: float) -> tuple[ValidityFlag, ...]:
    """Where properties of an oil at a temperature leave the data behind them."""
    viscosity = extrapolated_viscosity(oil, temperature)
    return check_ranges(
        ModelUse("oil", oil.name, "properties"),
        (_temperature_range(oil), _VISCOSITY),
        {"temperature": temperature, "kinematic_viscosity": viscosity},
    )


def _temperature_range(oil: Oil) -> Range:
    low, high = (CELSIUS.to_display(limit) for limit in oil.temperature_range)
    return Range("temperature", "temperature", low, high, CELSIUS, "data of this oil")
