"""
An e-axle up to 25,000 rpm
==========================

Losses without load grow with the second to third power of the speed and dominate at the speeds of
electric motors. This study shows them, with their uncertainty, over the speed range of a motor.
"""

import matplotlib.pyplot as plt
import numpy as np

import epicyclic as ep

SPEEDS = (5000, 7500, 11200, 16700, 25000)
GROUPS = {
    "teeth under load": ("_sliding", "_rolling"),
    "pockets between teeth": ("_pocketing",),
    "rims, faces and teeth in the mist": ("drag",),
    "bearings": ("_mechanical", "_viscous", ".mechanical", ".viscous"),
    "seals": (".friction",),
}

axle = ep.load_case("train-eaxle")
cases = [axle.updated({"operation.speed [rpm]": speed}) for speed in SPEEDS]
bands = [ep.record(it, groups=["uncertainty"]).fields["uncertainty/result"] for it in cases]

# %%
# The losses and their uncertainty
# --------------------------------
# The width of each strip is the sum of the 95 % bands of its terms, as if their errors were fully
# correlated.

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
# The exponent of the speed between neighbouring points. For drag it rises smoothly from 2.5, that
# of a laminar disc, to 3, that of form drag. For the pockets it rises where the flow between the
# teeth approaches the speed of sound of the mixture.

for label, ends in GROUPS.items():
    names = [name for name in bands[0].result.values if str(name).endswith(ends)]
    watts = [float(band.nominal.sel(result=names).sum()) for band in bands]
    exponents = np.diff(np.log(watts)) / np.diff(np.log(SPEEDS))
    print(f"{label:34}", *(f"{one:5.2f}" for one in exponents))
