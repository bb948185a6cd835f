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

# sphinx_gallery_thumbnail_number = 1
