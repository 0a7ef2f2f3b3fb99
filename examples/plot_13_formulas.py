"""
Formulas without a case
=======================

The formulas behind the losses, for numbers and arrays: friction and rolling of one contact over its
load, windage of a gear, friction of a bearing and of a plain pin over their speed.
"""

import matplotlib.pyplot as plt
import numpy as np

import epicyclic as ep

OIL, HOT = "iso-vg-100-pao", "80 degC"
oil = ep.oil_properties(OIL, HOT)
print(f"{1e6 * oil['kinematic_viscosity']:.1f} mm²/s, {oil['density']:.0f} kg/m³")

# %%
# One contact
# -----------
# The load grows, the film hardly becomes thinner: friction rises because the oil shears under a
# higher pressure, and because asperities carry more. Rolling hardly depends on the load.

loads = np.linspace(50e3, 800e3, 12)  # [N/m]
contact = {
    "line_load": loads,
    "radius": "12 mm",
    "rolling_speed": "9 m/s",
    "temperature": HOT,
    "oil": OIL,
}
rough = {"roughness1": "0.3 um", "roughness2": "0.5 um"}
found = ep.line_contact(**contact)
slipping = contact | rough | {"sliding_speed": "2.5 m/s"}

_, axes = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
for model in ("mixed-lubrication", "benedict-kelley", "xu-2007"):
    axes[0].plot(1e-9 * found.hertz_pressure, ep.friction(model, **slipping), label=model)
axes[0].set(xlabel="contact pressure [GPa]", ylabel="coefficient of friction", ylim=(0, None))
axes[0].legend()
axes[1].plot(1e-3 * loads, ep.rolling_loss("goksem-hargreaves", **contact))
axes[1].set(xlabel="line load [N/mm]", ylabel="rolling loss [W/m]", ylim=(0, 3000))

# %%
# What turns
# ----------
# The drag of a gear in an oil mist overtakes the friction of its bearing.

speeds = np.linspace(500, 16000, 12) * np.pi / 30  # [rad/s]
gear = ep.windage(
    diameter="180 mm",
    width="28 mm",
    speed=speeds,
    temperature=HOT,
    oil=OIL,
    oil_share=0.01,
    teeth=59,
)
bearing = ep.bearing_loss("6208", speed=speeds, temperature=HOT, oil=OIL, radial_force="1.7 kN")
pin = ep.plain_pin(
    diameter="25 mm",
    length="31 mm",
    clearance="40 um",
    force="1.7 kN",
    speed=speeds,
    temperature=HOT,
    oil=OIL,
)

_, axis = plt.subplots(figsize=(7, 4), layout="constrained")
for name, watts in (("gear", gear), ("bearing 6208", bearing), ("plain pin", pin["watts"])):
    axis.loglog(speeds * 30 / np.pi, watts, label=name)
axis.set(xlabel="speed [rpm]", ylabel="loss [W]")
axis.legend()
