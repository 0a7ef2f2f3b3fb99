"""Calibrate the pressure-viscosity coefficient of the oil `atf-talbot-2012`.

Talbot (2012) states no pressure-viscosity coefficient. The three planet-bearing losses printed with
Fig. 3.4 (4000 rpm, 333 N m on the branch, S_co = 0.141 um) fix it at three temperatures. Run this
after any change to the planet-bearing model and put the printed values into
src/epicyclic/library/oils/atf-talbot-2012.toml; these three losses are calibration, not validation.
"""

from __future__ import annotations

from dataclasses import replace

from scipy.optimize import brentq

import epicyclic as ep
from epicyclic.build.gear_sets import roller_bearing
from epicyclic.build.machine import build
from epicyclic.losses.planet_bearing import mixed_ehl_rolling_loss, roller_loads

PUBLISHED = {"40 degC": 236.0, "60 degC": 195.0, "90 degC": 181.0}
"""Oil inlet temperature: loss of one planet bearing, Talbot (2012), p. 70. [W]"""


def calibrate(temperature: str, loss: float) -> float:
    """The pressure-viscosity coefficient at which one planet bearing loses `loss` watts. [1/Pa]"""
    case = ep.load_case("talbot-2012-n3").updated(
        {"operation.torque": "999 N*m", "operation.oil_inlet_temperature": temperature}
    )
    assert isinstance(case, ep.PlanetaryCase)
    assert case.planet_bearing is not None
    bearing = roller_bearing(case.planet_bearing, case.numerics)
    built = build(case)
    load = built.planet_loads()["planet_bearing"]
    loads = roller_loads(bearing, load.force, 0.0, load.moment_x, load.moment_y)
    speeds = built.state().speeds
    speed = speeds["planet"] - speeds["carrier"]
    oil = built.fluids.oil

    def excess(alpha: float) -> float:
        return (
            mixed_ehl_rolling_loss(
                bearing, loads, speed, replace(oil, pressure_viscosity=alpha)
            ).loss
            - loss
        )

    return float(brentq(excess, 5e-9, 30e-9, xtol=1e-15))


if __name__ == "__main__":
    for temperature, loss in PUBLISHED.items():
        print(f"{temperature}: {calibrate(temperature, loss) * 1e9:.4f} 1/GPa")
