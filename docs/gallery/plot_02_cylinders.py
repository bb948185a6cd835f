"""
Two cylinders in a box: friction makes spin
===========================================

The second problem of Magnain, Feng and Cros (2005), until the cylinders have met:
``examples/two_cylinders.py``. With friction the first one comes off the floor turning, slower,
and the two meet later.
"""

# %%
# .. literalinclude:: ../../examples/two_cylinders.py
#    :pyobject: scenario

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import two_cylinders
from pictures import draw

import carom

results = {}
for friction in (0.0, 0.2):
    scenario = two_cylinders.scenario(friction=friction).with_overrides(["analysis.end_time=3"])
    results[friction] = carom.run(scenario, out=mkdtemp())
    print(f"μ = {friction}: the cylinders meet at {two_cylinders.meeting(results[friction]):.3f} s")

# %%
# With friction, on the floor and when the two meet; colours are von Mises' stress.

draw(results[0.2], [1.55, 2.9], field="von-mises")
plt.show()

# %%
# Spin comes from the floor, at the expense of the motion along it.

figure, axes = plt.subplots(layout="constrained")
for friction, result in results.items():
    axes.plot(result.history["time"], result.history["left.spin"], label=f"μ = {friction}")
axes.set_xlabel("time [s]")
axes.set_ylabel("spin of the left cylinder [rad/s]")
axes.legend()
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/cylinders.png'
