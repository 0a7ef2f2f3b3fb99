"""
Eight gears from four sets
==========================

An automatic gearbox is a set of planetary sets whose members are held by brakes and joined by
clutches. This page works out ratio, efficiency and power flow of an eight-speed gearbox in all
its gears, from tooth numbers and an assumed efficiency of each set. Then it looks at a drive in
which far more power circulates than passes through.
"""

import matplotlib.pyplot as plt

import epicyclic as ep

case = ep.load_case("train-8hp70")
results = {gear: ep.solve(case.updated({"operation.state": gear})) for gear in case.states}
for gear, result in results.items():
    train = result.train
    print(f"{gear:>8}: ratio {train.ratio:7.3f}, efficiency {100 * result.efficiency:6.2f} %, "
          f"power ratio {train.power_ratio:5.2f}")  # fmt: skip

# %%
# The power ratio is the rolling power of all meshes over the input power: what the teeth have
# to pass on between them. Losses follow it, not the ratio of the gear.

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
axes.bar(list(results), [100 * (1 - result.efficiency) for result in results.values()])
axes.set(xlabel="gear", ylabel="bars: loss [% of the input power]", title=case.title)
right = axes.twinx()
right.plot(list(results), [one.train.power_ratio for one in results.values()], "ko")
right.set_ylabel("dots: power ratio")
right.set_ylim(0)

# %%
# The gear with the greatest loss, drawn: arrows are as wide as the power that they carry.

worst = max(results, key=lambda gear: 1 - results[gear].efficiency)
picture = results[worst].plot("power-flow")

# %%
# Much power for little
# ---------------------
# A Wolfrom set reaches a large ratio with two ring gears of nearly equal tooth numbers. Its
# planets pass on a multiple of the input power, and so a mesh efficiency that looks harmless
# costs a large part of it. Driven from the output the set may lock itself.

wolfrom = {
    "kind": "train",
    "title": "Wolfrom set",
    "sets": {
        "W": {
            "planets": 3,
            "mesh_efficiency": 0.99,
            "meshes": [["sun", "wide"], ["wide", "fixed_ring"], ["narrow", "output_ring"]],
            "gears": {
                "sun": {"teeth": 12},
                "wide": {"teeth": 33, "body": "planet"},
                "narrow": {"teeth": 30, "body": "planet"},
                "fixed_ring": {"teeth": 78, "internal": True},
                "output_ring": {"teeth": 75, "internal": True},
            },
        }
    },
    "shafts": {"input": ["W.sun"], "output": ["W.output_ring"], "housing": ["W.fixed_ring"]},
    "operation": {"input": "input", "output": "output", "torque": "1 N*m", "speed": "3000 rpm"},
}
result = ep.solve(ep.load_case(wolfrom))
print(f"ratio {result.train.ratio:.1f}, efficiency {100 * result.efficiency:.1f} %, "
      f"power ratio {result.train.power_ratio:.2f}")  # fmt: skip
picture = result.plot("power-flow")
