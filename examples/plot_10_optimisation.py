"""
An optimiser from outside
=========================

Any optimiser that can call a Python function can drive a case. Here SciPy looks for the number
of teeth, the helix angle and the profile shift with which a pair of gears loses least, at a
fixed centre distance and nearly the same ratio. Fine teeth with a large helix angle would
always win; two things hold them back, the axial force that the bearings take and the load that
a tooth root carries.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import minimize

import epicyclic as ep

DISTANCE, RATIO, WIDTH = 91.5, 2.6, 30.0  # mm, 1, mm
TORQUE = 130.0  # N·m
TANGENTIAL = 1e3 * TORQUE * (1 + RATIO) / DISTANCE  # at the pitch circle [N]
AXIAL = 1800.0  # what the bearings take [N]
UNIT_LOAD = 105.0  # tangential force over face width and module [N/mm2]


def module_of(pinion_teeth, helix):
    """Normal module that fits the centre distance. [mm]"""
    teeth = pinion_teeth + round(RATIO * pinion_teeth)
    return 2 * (DISTANCE - 0.3) * np.cos(np.radians(helix)) / teeth


def pair(pinion_teeth, helix, shift):
    """A pair whose module follows from teeth, helix and centre distance."""
    gear_teeth = round(RATIO * pinion_teeth)
    return ep.load_case(
        {
            "kind": "gear_pair",
            "title": f"{pinion_teeth}/{gear_teeth} teeth",
            "operation": {
                "torque": f"{TORQUE} N*m",
                "speed": "5200 rpm",
                "oil_inlet_temperature": "80 degC",
            },
            "gears": {
                "normal_module": f"{module_of(pinion_teeth, helix)} mm",
                "normal_pressure_angle": "20 deg",
                "helix_angle": f"{helix} deg",
                "center_distance": f"{DISTANCE} mm",
            },
            "pinion": {
                "teeth": pinion_teeth,
                "face_width": "31 mm",
                "profile_shift_coefficient": shift,
                "roughness": "0.35 um",
            },
            "gear": {"teeth": gear_teeth, "face_width": f"{WIDTH} mm", "roughness": "0.45 um"},
            "mesh": {"normal_backlash": "70 um"},
            "lubricant": {"oil": "atf-dexron-vi"},
            "surroundings": {"oil_air_ratio": 0.03},
        }
    )


# %%
# What the optimiser sees
# -----------------------
# The loss, with a penalty on teeth that are loaded beyond the bound. A case that cannot be
# built, because its teeth would be pointed or would interfere, raises ``InputError``; one
# without a solution raises ``ConvergenceError``. Both are an ``EpicyclicError``, and count as
# very bad.


def objective(variables, teeth):
    helix, shift = variables
    try:
        loss = ep.solve(pair(teeth, helix, shift)).total
    except ep.EpicyclicError:
        return 1e5
    overload = TANGENTIAL / (WIDTH * module_of(teeth, helix)) / UNIT_LOAD - 1
    return loss * (1 + 20 * max(0.0, overload))


# %%
# Whole numbers outside, continuous ones inside
# ---------------------------------------------
# Each number of teeth is optimised by itself over profile shift and helix angle, whose bound is
# the axial force.

steepest = np.degrees(np.arctan(AXIAL / TANGENTIAL))
found = {
    teeth: minimize(
        objective,
        x0=(14.0, 0.15),
        args=(teeth,),
        method="Nelder-Mead",
        bounds=[(6, steepest), (-0.1, 0.5)],
        options={"maxfev": 22, "initial_simplex": [(14, 0.15), (18, 0.15), (14, 0.35)]},
    )
    for teeth in (23, 27, 29, 31)
}
for teeth, optimum in found.items():
    helix, shift = optimum.x
    unit = TANGENTIAL / (WIDTH * module_of(teeth, helix))
    print(f"{teeth} teeth: helix {helix:5.1f} deg, x1 {shift:6.3f}, unit load {unit:5.1f} N/mm2, "
          f"objective {optimum.fun:6.1f} W")  # fmt: skip

# %%
# Where the gain comes from
# -------------------------

start = ep.solve(pair(23, 14.0, 0.15))
best = min(found, key=lambda teeth: found[teeth].fun)
result = ep.solve(pair(best, *found[best].x))
names = [name.replace("_", " ") for name in start.losses]
place = np.arange(len(names))
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
axes.barh(place - 0.2, list(start.losses.values()), 0.4, label="start")
axes.barh(place + 0.2, list(result.losses.values()), 0.4, label="optimum")
axes.set_yticks(place, names)
axes.invert_yaxis()
axes.set(xlabel="loss [W]", title=f"{start.total:.0f} W before, {result.total:.0f} W after")
axes.legend()

# %%
# A unit load is no proof of strength. ``ep.strength`` rates a case after ISO 6336, and
# ``ep.design`` searches with these safeties as limits.
