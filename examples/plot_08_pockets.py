"""
Oil that is squeezed out of the mesh
====================================

A tooth that enters a space drives out what is in it, oil and air, through ever narrower gaps.
At high speed this pocketing loss can exceed the friction of the teeth. The pair of gears is the
example of Talbot (2012), Table 4.1.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt

import epicyclic as ep
from epicyclic.show.plots.pockets import section_figure

case = ep.load_case("talbot-2012-pair")
print(f"pocketing loss: {ep.solve(case).losses['mesh_pocketing']:.1f} W")

# %%
# One pocket through its life
# ---------------------------
# The section is drawn at six moments, the gaps marked. Pressure peaks while the gap closes
# faster than the volume shrinks.

mesh = ep.pocket_details(case)["mesh"]
print(f"highest pressure {float(mesh.pressure.max()):.2f} {mesh.pressure.attrs['units']}")
picture = section_figure(mesh)

# %%
# What the designer can do
# ------------------------
# The helix angle opens the ends of the pockets one after the other. ``pocketing_study`` varies
# it with the transverse section kept as it is.

study = ep.pocketing_study(
    case,
    ["helix-angle"],
    ranges={"helix-angle": ["0 deg", "5 deg", "10 deg", "15 deg", "20 deg", "30 deg"]},
    levels={"face-width": ["15 mm"], "speed": ["7000 rpm", "10000 rpm"]},
)["helix-angle"]
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for speed in study.speed.to_numpy():
    loss = study.pocketing_loss.sel(speed=speed).squeeze()
    axes.plot(study.helix_angle, loss, "o-", label=f"{speed:.0f}")
axes.set(xlabel="helix angle [°]", ylabel="pocketing loss [W]", title="Face width 15 mm")
axes.set_ylim(0)
axes.legend(title="speed [rpm]")

# %%
# For many operating points
# -------------------------
# The flow depends on speed, density and ambient pressure through one number only. A table over
# that number is computed once; cases that name its file look the loss up, at any speed and
# temperature.

table = ep.pocketing_table(case, ["2500 rpm", "5000 rpm", "10000 rpm"], ["40 degC", "90 degC"])
print(table.power.sel(mesh="mesh", driver=1).to_series().round(2).to_string())

path = Path(tempfile.mkdtemp()) / "pockets.nc"
table.to_netcdf(path)
looked_up = ep.solve(
    case.updated({"models.pocketing_table": str(path), "operation.speed": "8300 rpm"})
)
solved = ep.solve(case.updated({"operation.speed": "8300 rpm"}))
print(f"at 8300 rpm: {looked_up.losses['mesh_pocketing']:.3f} W from the table, "
      f"{solved.losses['mesh_pocketing']:.3f} W solved")  # fmt: skip
