"""
Is the better design really better?
===================================

A computed loss is uncertain: roughness, clearances and the oil around the gears are known
within limits, and the models have errors of their own. Still, the difference of two designs can
be known far better than either of them, because most of what is uncertain is the same in both.
"""

import matplotlib.pyplot as plt

import epicyclic as ep

ground = ep.load_case("talbot-2012-pair").updated(
    {
        "operation.torque": "90 N*m",
        "operation.speed": "4500 rpm",
        "pinion.roughness": "0.45 um",
        "gear.roughness": "0.5 um",
    }
)
polished = ground.updated({"pinion.roughness": "0.12 um", "gear.roughness": "0.1 um"})

# %%
# How well each is known
# ----------------------
# Where the case says nothing about an input, a distribution is assumed and named with its
# source.

bands = {
    "ground": ep.uncertainty(ground, samples=32),
    "polished": ep.uncertainty(polished, samples=32),
}
for name, data in bands.items():
    total = data.sel(result="total")
    print(f"{name:9} {float(total.nominal):6.1f} W, 95 % from {float(total.low):.1f} "
          f"to {float(total.high):.1f} W")  # fmt: skip

# %%
# What that is due to, as total Sobol indices: the share of the variance that would be gone if
# the input were known. From few samples an estimate may exceed the whole; it is drawn as 100 %.

drivers = bands["ground"].total_order.sel(sum="total").to_series().nlargest(6)[::-1]
names = bands["ground"].input_name.to_series()
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
axes.barh([names.get(key, key) for key in drivers.index], 100 * drivers.clip(upper=1.0))
axes.set(xlabel="share of the variance of the total loss [%]", title="Ground flanks")

# %%
# How well the difference is known
# --------------------------------
# ``compare_cases`` draws once what both cases share.

both = ep.compare_cases(ground, polished, samples=64).sel(result="total")
print(f"polished loses {-float(both.difference):.1f} W less (95 %: {-float(both.high):.1f} to "
      f"{-float(both.low):.1f} W)")  # fmt: skip
print(f"u of the difference {float(both.standard_uncertainty):.1f} W; "
      f"{float(both.unpaired_uncertainty):.1f} W if the two were drawn apart")  # fmt: skip
print(f"probability that polishing pays: {float(both.probability):.3f}")
