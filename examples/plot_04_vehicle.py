"""
From gears to a vehicle model
=============================

A vehicle simulation wants a table: torque loss over speed, torque and oil temperature. This
page makes one for a reduction gear, runs it over a drive, hands it on as an FMU and as a VECTO
table, and checks that the FMU says the same as the program that wrote it.
"""

import tempfile
from pathlib import Path

import fmpy
import matplotlib.pyplot as plt
import numpy as np

import epicyclic as ep

folder = Path(tempfile.mkdtemp())
case = ep.load_case("talbot-2012-pair").updated(
    {
        "operation.torque": "60 N*m",
        "operation.speed": "3000 rpm",
        "thermal.lubrication": "dip",
        "thermal.oil_volume": "1.2 l",
        "thermal.housing.area": "0.3 m^2",
        "thermal.housing.mass": "11 kg",
    }
)

# %%
# The map
# -------
# Torques of both signs, because a vehicle coasts and recuperates, and temperatures from a cold
# start upwards.

data = ep.loss_map(
    case,
    speed=["0 rpm", "500 rpm", "1500 rpm", "3000 rpm", "6000 rpm"],
    torque=["-120 N*m", "-60 N*m", "-15 N*m", "0 N*m", "15 N*m", "60 N*m", "120 N*m"],
    temperature=["0 degC", "30 degC", "60 degC", "100 degC"],
)
warm = data.torque_loss.sel(temperature=60)
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for torque in (0, 15, 60, 120):
    axes.plot(data.speed, warm.sel(torque=torque), "o-", label=f"{torque} N·m")
axes.set(xlabel="speed of the pinion [rpm]", ylabel="torque loss [N·m]", title="Oil at 60 °C")
axes.set_ylim(-0.05, 2.2)
axes.legend(title="torque", ncols=4, loc="upper center")

# %%
# A drive
# -------
# Ten minutes with three stops. The energy lost is split by component, and a sample of the
# points is solved again to say how far interpolating in the map is off.

seconds = np.arange(0.0, 600.0, 2.0)
speed = 2600 * np.clip(1.2 * np.sin(np.pi * seconds / 200) ** 2 - 0.1, 0, 1)
torque = 8 + 0.8 * np.gradient(speed, seconds)
drive = {"time [s]": seconds, "speed [rpm]": speed, "torque [N*m]": torque}
energy = ep.duty_cycle(data, drive, ["60 degC"])
lost = energy.energy_lost.sum("mode").squeeze()
print(lost.to_series().round(3).to_string())
print(f"error of interpolation: {float(energy.interpolation_error.squeeze()):.3f} kJ")

# %%
# The same with a cold gearbox
# ----------------------------
# The drive starts at 0 °C and is repeated for an hour. Whether cold oil costs energy or saves
# it depends on what dominates: stiff oil drags, but its thick films keep the flanks apart. The
# last line compares with a gearbox that is warm all the time.

course = ep.warm_up(case, "1 h", "0 degC", cycle=drive)
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for node in ("pinion", "gear", "oil", "housing"):
    axes.plot(course.time / 60, course.temperature.sel(node=node), label=node)
axes.set(xlabel="time [min]", ylabel="temperature [°C]", title="Cold start")
axes.legend()
print(f"lost in an hour {float(course.energy_lost[-1]):.0f} kJ; "
      f"warm all the time {float(course.energy_lost_settled):.0f} kJ")  # fmt: skip

# %%
# To other programs
# -----------------
# VECTO reads a table of one temperature. An FMU holds the whole map; here it also gets a
# temperature that follows from its losses.

ep.write_map(data.sel(temperature=[60]), folder / "reduction.vtlm")
print((folder / "reduction.vtlm").read_text(encoding="utf-8").splitlines()[0])
ep.write_map(data, folder / "reduction.fmu")
ep.write_map(ep.with_temperature_state(data, case), folder / "warming.fmu")

# %%
# Does the FMU agree?
# -------------------
# ``fmpy`` simulates it, as a vehicle simulation would.

point = {"speed": 2000 * np.pi / 30, "torque": 40.0, "temperature": 333.15}
simulated = fmpy.simulate_fmu(str(folder / "reduction.fmu"), start_values=point, stop_time=1.0)
table = data.torque_loss.sel(temperature=60).interp(speed=2000, torque=40)
print(f"torque loss of the FMU {simulated['torque_loss'][-1]:.6f} N·m, "
      f"of the map {float(table):.6f} N·m")  # fmt: skip
