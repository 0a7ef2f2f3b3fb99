"""
The first stage of a wind turbine's gearbox
===========================================

Slow, heavily loaded, full of oil: the first stage of a 3 MW turbine is in every way the
opposite of an e-axle. Two questions are asked of it here. How does the efficiency fall at part
load, where turbines run most of the time? And how much oil must flow through the stage to keep
it at the temperature for which the oil was chosen?
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt

import epicyclic as ep

case = ep.load_case(
    {
        "kind": "planetary",
        "title": "3 MW wind turbine, stage 1",
        "operation": {
            "input": "carrier",
            "fixed": "ring",
            "torque": "2.0 MN*m",
            "speed": "13 rpm",
            "oil_inlet_temperature": "55 degC",
        },
        "gears": {
            "normal_module": "14 mm",
            "normal_pressure_angle": "20 deg",
            "helix_angle": "7.5 deg",
            "center_distance": "427 mm",
        },
        "sun": {
            "teeth": 21,
            "face_width": "330 mm",
            "profile_shift_coefficient": 0.24,
            "roughness": "ground",
        },
        "planet": {"teeth": 39, "count": 3, "face_width": "320 mm", "roughness": "ground"},
        "ring": {"teeth": 99, "face_width": "320 mm", "roughness": "Ra 0.8 um"},
        "sun_mesh": {"normal_backlash": "0.35 mm"},
        "ring_mesh": {"normal_backlash": "0.4 mm"},
        "planet_bearing": {
            "rows": 2,
            "rollers_per_row": 20,
            "roller_diameter": "45 mm",
            "roller_length": "120 mm",
            "pin_diameter": "280 mm",
            "diametral_clearance": "0.16 mm",
            "roller_roughness": "0.1 um",
            "race_roughness": "0.2 um",
        },
        "carrier": {"outer_diameter": "1300 mm", "width": "500 mm"},
        "load_sharing": {"method": "mesh-load-factor", "mesh_load_factor": 1.1},
        "lubricant": {"oil": {"iso_vg": 320, "kind": "pao"}},
        "surroundings": {"oil_air_ratio": 0.25},
    }
)
rated = ep.solve(case)
print(rated)
picture = rated.plot("losses")

# %%
# Part load
# ---------
# A sweep takes the product of the values of any keys. Its dataset has a unit on every number; its
# dimensions are called as the axes of a map, ``torque`` and ``temperature``, or as their keys with
# underscores, ``planet_count``.

sweep = ep.sweep(
    case,
    {
        "operation.torque": [f"{share} MN*m" for share in (0.1, 0.25, 0.5, 1.0, 1.5, 2.0)],
        "operation.oil_inlet_temperature": ["40 degC", "55 degC", "70 degC"],
    },
)
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for temperature, line in sweep.efficiency.groupby("temperature"):
    axes.plot(sweep.torque / 1e6, 100 * line.squeeze(), "o-", label=f"{temperature:g}")
axes.set(xlabel="torque of the rotor [MN m]", ylabel="efficiency [%]", title=case.title)
axes.legend(title="oil inlet [°C]")

# %%
# How much oil
# ------------
# With a network of heat, temperatures follow from the losses. ``heat_balance`` shows them for a
# stated flow through the stage, and ``solve_for`` finds the flow at which the oil leaves at a
# wanted temperature.

flow = case.updated({"thermal.oil_flow": "40 l/min"})
heat = ep.heat_balance(flow)
for part, kelvin in sorted(heat.temperatures.items(), key=lambda item: -item[1]):
    print(f"{part:20} {kelvin - 273.15:6.1f} degC")

# %%
found = ep.solve_for(case, "oil_flow", "65 degC")
print(f"{found.key} = {60e3 * found.value:.1f} l/min")

# %%
# To the manufacturer
# -------------------
# REXS is the exchange format of gearbox programs. A REXS file carries gears and results to
# them, and comes back as a case; the import says what the file could not tell.

path = Path(tempfile.mkdtemp()) / "stage.rexs"
ep.write_rexs(path, rated)
again = ep.read_rexs(path)
print(len(path.read_text(encoding="utf-8").splitlines()), "lines of REXS; not in them:")
for note in again.missing:
    print("-", note)
