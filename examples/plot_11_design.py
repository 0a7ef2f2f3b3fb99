"""
Three searches for a design
===========================

A stage of an e-axle, the joint of a robot and a stage of a wind turbine: each is a task with a
ratio, a duty cycle, limits and choices. All combinations are counted, screened and solved in the
order of what they can reach at best. The same tables in a file are what ``epicyclic design``
reads.
"""

import matplotlib.pyplot as plt

import epicyclic as ep

COARSE = {"mesh_positions": 8, "contact_segments": 8, "bearing_slices": 6}


def show(found, against="mass", scale=1.0, unit="kg"):
    """Solved designs by arrangement; those that no other one beats are ringed."""
    for fate, count in found.fates.items():
        print(f"{count:7,} {fate}")
    table = found.table[found.table.loss.notna()]
    _, axes = plt.subplots(figsize=(7, 4), layout="constrained")
    for name, rows in table.groupby("arrangement"):
        axes.scatter(rows.loss, scale * rows[against], label=name, alpha=0.6)
    front = table.loc[found.fronts].sort_values("loss")
    axes.plot(front.loss, scale * front[against], "ko", markersize=12, fillstyle="none")
    axes.set(xlabel="loss over the cycle [W]", ylabel=f"{against} [{unit}]", title=found.task.title)
    axes.legend()
    return front


# %%
# A stage of an e-axle
# --------------------
# Little time at full torque, much at part load: the loss is averaged over both.

axle = ep.design(
    {
        "title": "E-axle stage, ratio 4.2",
        "ratio": 4.2,
        "operation": {"torque": "150 N*m", "speed": "6000 rpm", "oil_inlet_temperature": "80 degC"},
        "cycle": [
            {
                "torque": "150 N*m",
                "speed": "3000 rpm",
                "oil_inlet_temperature": "80 degC",
                "share": 0.1,
            },
            {
                "torque": "35 N*m",
                "speed": "7000 rpm",
                "oil_inlet_temperature": "70 degC",
                "share": 0.9,
            },
        ],
        "choices": {
            "arrangements": ["planetary", "pair"],
            "module": ["1.25 mm", "1.5 mm", "2 mm"],
            "helix_angle": ["15 deg", "22 deg"],
            "pinion_teeth": [21, 31],
            "planets": [3, 4],
            "profile_shift": [0.1, 0.3],
            "distance_shift": [0.3],
            "width_ratio": [0.6, 0.9],
        },
        "limits": {"diameter": "250 mm", "pitting": 1.1, "bending": 1.5},
        "search": {"solved": 24, "batch": 12},
        "case": {
            "lubricant": {"oil": "atf-dexron-vi"},
            "strength": {"life": "3000 h"},
            "numerics": COARSE,
        },
    }
)
show(axle)[["arrangement", "sun", "module", "loss", "mass", "pitting", "bending"]]

# %%
# The joint of a robot
# --------------------
# Four arrangements of one ratio. A Wolfrom set is small but lets power circulate; two stages
# need room along the axis.

joint = ep.design(
    {
        "title": "Robot joint, ratio 9.6",
        "ratio": 9.6,
        "operation": {"torque": "1.3 N*m", "speed": "3000 rpm", "oil_inlet_temperature": "50 degC"},
        "choices": {
            "arrangements": ["planetary", "stepped", "wolfrom", "two-stage"],
            "module": ["0.5 mm"],
            "pinion_teeth": [15, 27],
            "planets": [3],
            "profile_shift": [0.25],
            "distance_shift": [0.2],
            "width_ratio": [0.6],
            "step": 14,
            "backlash": "20 um",
        },
        "limits": {"ratio_error": 0.02, "diameter": "90 mm", "pitting": 0.9, "bending": 1.2},
        "search": {"objectives": ["loss", "diameter", "width"], "solved": 36, "batch": 12},
        "case": {
            "lubricant": {"oil": "iso-vg-68-pao"},
            "strength": {"life": "2000 h"},
            "numerics": COARSE,
        },
    }
)
show(joint, "diameter", 1e3, "mm")[["arrangement", "loss", "diameter", "width"]]

# %%
# A stage of a wind turbine
# -------------------------
# The sun counts as the input here, as in every task; a turbine drives the carrier.

wind = ep.design(
    {
        "title": "Wind stage, ratio 5.6",
        "ratio": 5.6,
        "operation": {"torque": "80 kN*m", "speed": "250 rpm", "oil_inlet_temperature": "60 degC"},
        "choices": {
            "arrangements": ["planetary"],
            "module": ["10 mm", "12 mm", "14 mm"],
            "helix_angle": ["7.5 deg"],
            "pinion_teeth": [19, 25],
            "planets": [3, 4],
            "profile_shift": [0.3],
            "distance_shift": [0.1, 0.3],
            "width_ratio": [0.9, 1.2],
            "backlash": "0.3 mm",
            "roughness": "Ra 0.5 um",
        },
        "limits": {"pitting": 1.2, "bending": 1.5, "micropitting": 1.0},
        "search": {"solved": 24, "batch": 12},
        "case": {
            "lubricant": {"oil": {"iso_vg": 320, "kind": "pao"}},
            "strength": {"life": "175000 h", "application_factor": 1.25},
            "numerics": COARSE,
        },
    }
)
show(wind)[["sun", "planets", "module", "loss", "mass", "pitting", "micropitting"]]

# %%
# Safeties of the chosen design
# -----------------------------

best = wind.case(wind.chosen[0])
for name, value in ep.strength(best).least().items():
    print(f"{name:18} {value:10.4g}")
