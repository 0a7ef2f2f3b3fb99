"""What the pressure-viscosity coefficient of the test fluid means for its planet bearings.

Run: python scripts/compare_roller_contacts.py MODEL.json

Talbot (2012) prints three losses of one planet bearing (Fig. 3.4) and no coefficient. A roller has
a contact with each race, and the formula (Eq. 3.5) one. Side by side: the coefficient of the oil
library, calibrated with the loss of the outer race only; Gold's for mineral oils; and one
calibrated with the losses of both races added. For each the loss of Eq. 3.5 with one race and with
both, and that of contacts simulated with this package, with both, by the fit in MODEL.json.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from scipy.optimize import brentq

import epicyclic as ep
from epicyclic.build.gear_sets import roller_bearing
from epicyclic.build.machine import build
from epicyclic.contact.fitted_models import read_oil_model
from epicyclic.losses.planet_bearing import (
    RollerBearing,
    fitted_rolling_loss,
    mixed_ehl_rolling_loss,
    roller_loads,
)
from epicyclic.losses.rolling import FittedRolling
from epicyclic.oil.oil import OilState

PUBLISHED = {"40 degC": 236.0, "60 degC": 195.0, "90 degC": 181.0}
"""Oil inlet temperature: loss of one planet bearing, Talbot (2012), p. 70. [W]"""
MINERAL = (9.904, 0.139)
"""s and t of Gold et al. (2001) for mineral oils, as commonly quoted."""

Loss = Callable[[OilState], float]


class _OuterAsInner(RollerBearing):
    """The bearing whose outer contacts are those with the inner race."""

    @property
    def outer_radius(self) -> float:
        return self.inner_radius


def main(file: Path) -> None:
    fitted = FittedRolling(read_oil_model(file), "structured", "bearing_rolling_loss")
    print("temperature, alpha [1/GPa], Eq. 3.5 one race, both; simulated; printed [W]")
    for temperature, printed in PUBLISHED.items():
        oil, losses = losses_at(temperature, fitted)
        nu = oil.kinematic_viscosity * 1e6
        both = brentq(
            lambda alpha, oil=oil, losses=losses, printed=printed: (
                losses["both, Eq. 3.5"](replace(oil, pressure_viscosity=alpha)) - printed
            ),
            3e-9, 30e-9,
        )  # fmt: skip
        coefficients = {
            "calibrated": oil.pressure_viscosity,
            "gold-mineral": MINERAL[0] * nu ** MINERAL[1] * 1e-9,
            "both races": float(both),
        }
        for name, alpha in coefficients.items():
            at = replace(oil, pressure_viscosity=alpha)
            found = " ".join(f"{loss(at):7.0f}" for loss in losses.values())
            print(f"{temperature} {name:13} {alpha * 1e9:6.2f} {found} {printed:7.0f}")


def losses_at(temperature: str, fitted: FittedRolling) -> tuple[OilState, Mapping[str, Loss]]:
    """The oil, and the loss of the bearing as a function of it. [W]"""
    case = ep.load_case("talbot-2012-n3").updated(
        {"operation.torque": "999 N*m", "operation.oil_inlet_temperature": temperature}
    )
    assert isinstance(case, ep.PlanetaryCase)
    assert case.planet_bearing is not None
    outer = roller_bearing(case.planet_bearing, case.numerics)
    inner = _OuterAsInner(**{name: getattr(outer, name) for name in outer.__dataclass_fields__})
    built = build(case)
    load = built.planet_loads()["planet_bearing"]
    loads = roller_loads(outer, load.force, 0.0, load.moment_x, load.moment_y)
    speeds = built.state().speeds
    speed = speeds["planet"] - speeds["carrier"]

    def printed_formula(bearing: RollerBearing, oil: OilState) -> float:
        return mixed_ehl_rolling_loss(bearing, loads, speed, oil, oil_held=False).loss

    return built.fluids.oil, {
        "one, Eq. 3.5": lambda oil: printed_formula(outer, oil),
        "both, Eq. 3.5": lambda oil: printed_formula(outer, oil) + printed_formula(inner, oil),
        "simulated": lambda oil: fitted_rolling_loss(outer, loads, speed, oil, fitted).loss,
    }


if __name__ == "__main__":
    main(Path(sys.argv[1]))
