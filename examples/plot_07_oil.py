"""
A friction model for an oil that nobody has tested
==================================================

For an oil without a model of its own, the program falls back on formulas from gear tests with
other oils. Instead, contacts of this oil can be simulated and a model fitted to them. The
campaign here is as small as one can be, to show the way; :doc:`/how-to/characterise-oil` says
what a serious one takes.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt

import epicyclic as ep

folder = Path(tempfile.mkdtemp()) / "vg150"

# %%
# Simulating
# ----------
# Every contact is a pair of rough surfaces in mixed lubrication. Narrow ranges suit the pair of
# gears below; every finished contact is kept in the folder, and an interrupted campaign goes on
# where it stopped.

model = ep.characterise_oil(
    "iso-vg-150-pao",
    folder,
    size=16,
    seed=7,
    ranges={
        "radius": (4.0, 9.0),
        "slide_to_roll_ratio": (0.1, 1.0),
        "temperature": (50.0, 80.0),
        "roughness1": (0.1, 0.2),
        "roughness2": (0.1, 0.2),
        "hertz_pressure": (0.6, 1.6),
        "rolling_speed": (4.0, 20.0),
    },
    changes={"numerics.nodes": 128},
)
print(sorted(path.name for path in folder.iterdir()))
print(model.simulations)

# %%
# Using it
# --------
# ``models.oil_model`` names the file. Beside it stand the models that ``epicyclic friction``
# offers for any oil.

pair = ep.load_case("talbot-2012-pair").updated(
    {
        "lubricant.oil": "iso-vg-150-pao",
        "operation.torque": "110 N*m",
        "operation.speed": "4000 rpm",
        "operation.oil_inlet_temperature": "65 degC",
        "pinion.roughness": "0.15 um",
        "gear.roughness": "0.18 um",
    }
)
own = {"models.friction": "fitted", "models.oil_model": str(folder / "model.json")}
choices = {
    "fitted to this oil": own,
    "Schlenk": {"models.friction": "schlenk"},
    "Niemann and Winter": {"models.friction": "niemann-winter"},
    "Doleschel": {"models.friction": "doleschel"},
}
sliding = {
    name: ep.solve(pair.updated(change)).losses["mesh_sliding"] for name, change in choices.items()
}
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
axes.barh(list(sliding), list(sliding.values()))
axes.invert_yaxis()
axes.set(xlabel="sliding loss [W]", title="One pair, one oil, four models of friction")

# %%
# Do not take the spread of the bars for a ranking. Look at the flags: where a model leaves the
# range that it was made in, the result says so, with the watts that this concerns.

for warning in ep.solve(pair.updated(own)).warnings:
    if warning.startswith("Out of range"):
        print("-", warning)
