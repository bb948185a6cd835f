"""
Two bars: a wave there and back
===============================

Two elastic bars of 10 m hit head-on at 2 m/s. The exact solution is that of a wave: they touch at
0.01 s, press on each other while the wave runs to their free ends and back, 2L/c = 0.02 s, and
exchange their velocities. This is the first problem of Magnain, Feng and Cros (2005),
``examples/two_bars.py``.
"""

# %%
# .. literalinclude:: ../../examples/two_bars.py
#    :pyobject: scenario

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
import two_bars

import carom

result = carom.run(two_bars.scenario(), out=mkdtemp())
(contact,) = result.summary["contacts"]
print(f"in contact from {contact['onset']:.4f} s to {contact['release']:.4f} s")

# %%
# The mean velocities are exchanged while the wave passes, and the energy is strain energy in the
# meantime. The condition ``gap`` takes half a per cent of the energy where the bars meet, as the
# paper's scheme does.

history = result.history
figure, (above, below) = plt.subplots(2, sharex=True, layout="constrained")
for name in ("left", "right"):
    above.plot(1e3 * history["time"], history[f"{name}.v_x"], label=name)
above.set_ylabel("mean velocity [m/s]")
above.legend()
for term in ("kinetic", "strain", "total"):
    below.plot(1e3 * history["time"], 1e3 * history[term], label=term)
for axes in (above, below):
    axes.axvspan(10.0, 30.0, color="0.93", zorder=0)
below.set_xlabel("time [ms]; grey: the exact time of contact")
below.set_ylabel("energy [mJ]")
below.legend()
plt.show()

# %%
# The wave itself: ``carom.Simulation`` goes through time by hand and shows every node at any
# moment. Behind the front, which leaves the middle at c = 1000 m/s and comes back from the free
# ends, the bars first stand still and then move apart. Waves as short as a cell lag behind the
# front; nothing damps them.

simulation = carom.Simulation(two_bars.scenario())
speed, touch, length = 1e3, 0.01, 10.0  # m/s, s, m
figure, places = plt.subplots(3, sharex=True, sharey=True, figsize=(6.4, 6.0), layout="constrained")
for axes, time in zip(places, (0.014, 0.018, 0.026), strict=True):
    simulation.advance(time)
    for name, bar in simulation.bodies.items():
        x, v = bar.positions[:, 0], bar.velocity[:, 0]
        axes.plot(x, v, ".", markersize=3, label=name)
    front = speed * (time - touch)
    place = np.linspace(-length, length, 2001)
    coming = np.where(np.abs(place) > front, -np.sign(place), 0.0)
    going = np.where(np.abs(place) > 2.0 * length - front, np.sign(place), 0.0)
    axes.plot(place, coming + going, "k:", linewidth=1, label="exact")
    axes.set_title(f"t = {1e3 * simulation.time:.0f} ms", fontsize=10)
    axes.set_ylabel("velocity [m/s]")
axes.set_xlabel("x [m]")
places[0].legend()
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/bars.png'
