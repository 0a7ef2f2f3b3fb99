"""
What a test bench says about the oil in the air
===============================================

Hardly any drawing says how much oil hangs in the air around the gears, and yet drag and
pocketing losses depend on it. A few measured points can. This page fits that share to losses
that Talbot measured on his test article, and asks how far the fitted value may be trusted.
"""

import matplotlib.pyplot as plt
import pandas as pd

import epicyclic as ep
from epicyclic.show.plots.measured import plot_points

case = ep.load_case("talbot-2012")

# %%
# The measurements
# ----------------
# Losses of the set with three planets at 4000 rpm: Talbot (2012), Fig. 2.4 and p. 31; the
# differences to 40 °C are from p. 37. The source has a torque sensor of 225 N·m with a resolution
# of 0.05 % (p. 23), which is 47 W at this speed; 60 W are assumed, for all that is uncertain.

measured = pd.DataFrame(
    {
        "speed [rpm]": 4000,
        "torque [N*m]": [1000, 1000, 0, 0],
        "temperature [degC]": [90, 40, 90, 40],
        "component": ["load_dependent"] * 2 + ["load_independent"] * 2,
        "loss [kW]": [3.21, 3.00, 0.57, 0.76],
        "uncertainty [kW]": 0.06,
    }
)
before = ep.compare_measured(case, measured)
before.table()

# %%
# The fit
# -------
# The two points at 40 °C are held out: the fit must not see them, so that they can speak
# against it.

comparison = ep.compare_measured(
    case, measured, fit=["surroundings.oil_air_ratio"], hold_out="temperature=40"
)
for value in comparison.fit.parameters:
    print(f"{value.key} = {value.value:.3g}, 95 % from {value.low:.3g} to {value.high:.3g}")

# %%
# Agreement with the points of a fit is no validation. What remains at the points that were held
# out is. Rings are the residuals before the fit, over the uncertainty of the measurement; squares
# are the points held out.

figure, axes = plt.subplots(figsize=(7.5, 4), layout="constrained")
plot_points(comparison, axes)
axes.legend()

# %%
# The calibrated case carries the fitted value and its uncertainty. Everything that is computed from
# it takes these in place of what is assumed otherwise.

calibrated = comparison.calibrated_case
print(ep.solve(calibrated))
print(calibrated.uncertainty)
