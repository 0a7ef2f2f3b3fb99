"""
Crowning against misalignment
=============================

Shafts bend and housings are never true. A few micrometres of misalignment move the load to one
end of the face; crowning brings it back, at the price of higher pressure in the middle. How
much crowning is right?
"""

import matplotlib.pyplot as plt
import numpy as np

import epicyclic as ep

case = ep.load_case("talbot-2012-pair").updated(
    {
        "operation.torque": "75 N*m",
        "operation.speed": "3000 rpm",
        "mesh.misalignment": "14 um",
        "pinion.micro_geometry.tip_relief": "16 um",
        "pinion.micro_geometry.tip_relief_roll_length": "2.2 mm",
        "gear.micro_geometry.tip_relief": "18 um",
        "gear.micro_geometry.tip_relief_roll_length": "2.4 mm",
    }
)

# %%
# Where the load is
# -----------------
# The plane of action of the misaligned pair without crowning: the contact lines, coloured by
# the load on them.

picture = ep.solve(case).plot("line-load")

# %%
# The right amount
# ----------------
# ``loaded_meshes`` gives loads and transmission error alone, without the losses, and so is the
# quickest way to look at many variants.

amounts = np.array([0, 3, 6, 9, 12, 16, 20, 25])
variants = [case.updated({"pinion.micro_geometry.lead_crown": f"{each} um"}) for each in amounts]
loaded = [ep.loaded_meshes(variant)["mesh"] for variant in variants]
highest = np.array([mesh.line_load.max() for mesh in loaded]) / 1e3
errors = np.array([np.ptp(mesh.transmission_error) for mesh in loaded]) * 1e6

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
axes.plot(amounts, highest, "o-", color="tab:blue")
axes.set(xlabel="crowning of the pinion [µm]", title="Misalignment 14 µm")
axes.set_ylabel("highest line load [N/mm]", color="tab:blue")
right = axes.twinx()
right.plot(amounts, errors, "s--", color="tab:orange")
right.set_ylabel("range of the transmission error [µm]", color="tab:orange")

# %%
# The crowning with the lowest peak, and what it does to the plane of action:

best = variants[int(highest.argmin())]
print(f"lowest peak at {amounts[highest.argmin()]} um")
picture = ep.solve(best).plot("line-load")

# %%
# Does it cost power?
# -------------------
# ``mesh_details`` has the load, pressure, sliding and friction at every point,
# ``mesh_contacts`` the same conditions as plain arrays for formulas of one's own. Sums over
# ``weight`` are averages over the mesh period: here that of the sliding speed, weighted by the
# load.

for name, variant in (("without", case), ("with", best)):
    details = ep.mesh_details(variant)["mesh"]
    contact = ep.mesh_contacts(variant)["mesh"]
    load = contact.weight * contact.line_load
    sliding = (load * abs(contact.sliding_speed)).sum() / load.sum()
    print(f"{name:7} crowning: highest Hertz pressure {float(details.hertz_pressure.max()):.2f} "
          f"{details.hertz_pressure.attrs['units']}, mean sliding speed {sliding:.3f} m/s, "
          f"sliding loss {ep.solve(variant).losses['mesh_sliding']:.1f} W")  # fmt: skip
