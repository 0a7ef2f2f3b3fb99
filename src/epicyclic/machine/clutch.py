"""Open wet clutches and synchronizers: drag of the oil in the gaps between their friction faces."""

from __future__ import annotations

import math
from typing import ClassVar

from epicyclic.dataclass import dataclass
from epicyclic.losses.ranges import ModelUse, Range, check_ranges
from epicyclic.machine.element import (
    LOAD_INDEPENDENT,
    ElementResult,
    Loss,
    Note,
    PartFigures,
    State,
    figure,
)
from epicyclic.machine.shaft_parts import ShaftPart
from epicyclic.units import NEWTON_METRE, NUMBER, RPM

METHOD = "shear of the oil film in the gaps, as far as the oil supply fills them"
SOURCE = (
    "thin film of a Newtonian oil; N. Petroff (1883), C. Aphale et al., J. Tribol. 128 (2006) 422, "
    "both second hand"
)
_RANGES = (
    Range("reynolds", "Reynolds number of the gap", None, 1300.0, NUMBER,
          "transition of plane Couette flow, general knowledge"),
    Range("inertia", "reduced Reynolds number of the gap", None, 10.0, NUMBER,
          "inertia of the film against its viscosity, estimate"),
)  # fmt: skip
RADIAL_FLOW = 20.0
"""Of the flow that centrifugal force draws through a gap, between a wall that turns and one that
rests. Theory (J34)."""


@dataclass(frozen=True, eq=False)
class ClutchFigures(PartFigures):
    """What an engineer checks by eye on an open clutch; NaN without slip."""

    speed: float = figure("speed difference", RPM)
    friction_torque: float = figure("drag torque", NEWTON_METRE)
    filled: float = figure("drag over that of full gaps", NUMBER)


def film_drag(
    viscosity: float,  # Dynamic, of the oil. [Pa s]
    density: float,  # [kg/m^3]
    speeds: tuple[float, float],  # Of both faces against the housing. [rad/s]
    inner: float,  # Radii of the faces. [m]
    outer: float,  # Radii of the faces. [m]
    gap: float,  # [m]
    slope: float = 1.0,  # Sine of the half angle of a cone; 1 for plates.
    flow: float = math.inf,  # Of oil through the gap. [m^3/s]
) -> tuple[float, float]:
    """Torque of one gap, and its ratio to that of a full gap. Theory (J33), (J34). [N m], [1]

    Examples
    --------
    A gap of 0.2 mm between radii of 60 and 75 mm, in oil of 30 mPa s, at 1500 rpm:

    >>> torque, _ = film_drag(0.03, 850.0, (50 * math.pi, 0.0), 0.060, 0.075, 0.2e-3)
    >>> round(torque, 4)
    0.6914
    """
    one, two = speeds
    shear = math.pi * viscosity * abs(one - two) / (2 * gap * slope)
    full = outer**4 - inner**4
    # mean of the squared speed over the gap, each layer weighted with its share in the flow
    turning = (3 * one**2 + 4 * one * two + 3 * two**2) / 3
    drawn = math.pi * density * turning * gap**3 * slope / (RADIAL_FLOW * viscosity)
    if drawn * outer**2 <= flow:
        return shear * full, 1.0
    edge = flow / drawn  # square of the radius up to which the oil fills the gap
    square = min(max(edge, inner**2), outer**2)
    filled = square**2 - inner**4 + 2 * edge * (outer**2 - square)
    return shear * filled, filled / full


@dataclass(frozen=True, slots=True)
class Clutch(ShaftPart):
    """An open clutch or synchronizer between two bodies, which transmits no torque but its drag."""

    key: str  # First part of the key of its loss.
    between: tuple[str, str]  # The two bodies, one of which may be `HOUSING`.
    gaps: int
    inner: float  # Radii of the faces. [m]
    outer: float  # Radii of the faces. [m]
    gap: float  # [m]
    slope: float  # Sine of the half angle of the cone; 1 for plates.
    flow: float | None  # Oil to all gaps; None if unknown. [m^3/s]

    terms: ClassVar = ("shear",)
    figure_types: ClassVar = (("clutch", ClutchFigures),)

    def answer(self, state: State) -> ElementResult:
        """See `ShaftPart`."""
        one, two = (state.speeds[body] for body in self.between)
        oil, slip = state.fluids.oil, abs(one - two)
        flow = math.inf if self.flow is None else self.flow / self.gaps
        torque, filled = film_drag(
            oil.dynamic_viscosity, oil.density, (one, two), self.inner, self.outer, self.gap,
            self.slope, flow,
        )  # fmt: skip
        torque *= self.gaps
        loss = Loss(LOAD_INDEPENDENT, torque * slip, METHOD, SOURCE, brakes=((*self.between, 1.0),))
        values = {
            "reynolds": slip * self.outer * self.gap / oil.kinematic_viscosity,
            "inertia": slip * self.gap**2 / oil.kinematic_viscosity,
        }
        turning, key = slip > 0, f"clutches.{self.key}.oil_flow"
        untold = f"{key} is not given: full gaps are taken, the most they drag."
        return ElementResult(
            losses={"shear": loss},
            figures={
                "clutch": ClutchFigures(
                    speed=slip,
                    friction_torque=torque if turning else math.nan,
                    filled=filled if turning else math.nan,
                )
            },
            flags=check_ranges(ModelUse("drag", "film", self.key), _RANGES, values),
            notes=(Note(untold, loss.watts),) if self.flow is None and loss.watts else (),
        )
