"""
An e-axle up to 25,000 rpm
==========================

Losses without load grow with a power of the speed of two to three, and decide at the speeds of
electric motors. What they are, and how well they are known, over the speed range of a motor.
"""

import matplotlib.pyplot as plt
import numpy as np

import epicyclic as ep
from epicyclic.study.bands.study import quick_dataset

SPEEDS = (5000, 7500, 11200, 16700, 25000)
GROUPS = {
    "teeth under load": ("_sliding", "_rolling"),
    "pockets between teeth": ("_pocketing",),
    "rims, faces and teeth in the mist": ("drag",),
    "bearings": ("_mechanical", "_viscous", ".mechanical", ".viscous"),
    "seals": (".friction",),
}

axle = ep.load_case("train-eaxle")
bands = [
    quick_dataset(case, ep.solve(case))
    for case in (axle.updated({"operation.speed [rpm]": speed}) for speed in SPEEDS)
]

# %%
# What the losses are, and how well they are known
# ------------------------------------------------
# The width of each strip is the sum of the 95 % bands of its terms, as if all erred together.

figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
for label, ends in GROUPS.items():
    names = [name for name in bands[0].result.values if str(name).endswith(ends)]
    own = [band.sel(result=names) for band in bands]
    nominal, low, high = (
        np.array([float(band[key].sum()) for band in own]) for key in ("nominal", "low", "high")
    )
    (line,) = axes.plot(SPEEDS, nominal, "o-", label=label)
    axes.fill_between(SPEEDS, low, high, color=line.get_color(), alpha=0.2)
axes.set(xscale="log", yscale="log", xlabel="speed of the motor [rpm]", ylabel="loss [W]")
axes.set_xticks(SPEEDS, [f"{speed:,}" for speed in SPEEDS], minor=False)
axes.minorticks_off()
axes.set_title(axle.title)
axes.legend()

# %%
# How fast they grow
# ------------------
# The exponent of the speed between one point and the next. That of the drag lies between the 2.5
# of a laminar disc and the 3 of form drag, and passes from one to the other without a kink. That
# of the pockets rises where the flow between the teeth reaches the speed of sound of the mixture.

for label, ends in GROUPS.items():
    names = [name for name in bands[0].result.values if str(name).endswith(ends)]
    watts = [float(band.nominal.sel(result=names).sum()) for band in bands]
    exponents = np.diff(np.log(watts)) / np.diff(np.log(SPEEDS))
    print(f"{label:34}", *(f"{one:5.2f}" for one in exponents))
