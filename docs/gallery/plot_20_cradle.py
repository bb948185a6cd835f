"""
Newton's cradle: a wave hands a blow on
=======================================

One disc hits four that hang side by side, and it seems that only the last one flies off. What hands
the blow on is a wave in the discs, and so the others are left with a little: rigid bodies that
exchange their velocities in pairs are an idealisation.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
from pictures import draw

import carom

SPEED, RADIUS = 1.0, 0.5
discs = [
    carom.Body(
        name=f"disc-{k}",
        material="elastic",
        mesh=carom.Disc(centre=[(2.0 * RADIUS + 1e-4) * k, 0.0], radius=RADIUS, divisions=8),
        velocity=[SPEED if k == 0 else 0.0, 0.0],
    )
    for k in range(5)
]
scenario = carom.Scenario(
    title="Newton's cradle",
    analysis=carom.Dynamic(end_time=0.3, time_step=5e-4),
    output=carom.Output(fields_every=5e-3),
    materials={"elastic": carom.SaintVenantKirchhoff(young=2e6, poisson=0.3, density=1000.0)},
    bodies=discs,
    contact=carom.Contact(friction=0.0),
)
result = carom.run(scenario, out=mkdtemp())
history = result.history
for k in range(5):
    print(f"disc {k}: {history[f'disc-{k}.v_x'][-1]:+.4f} m/s at the end")
momentum = np.sum([history[f"disc-{k}.v_x"] for k in range(5)], axis=0)
print(f"their sum differs from {SPEED:g} m/s by at most {abs(momentum - SPEED).max():.0e} m/s")

# %%
# Colours are the velocity: the blow is on its way.

draw(result, [0.0, 0.04, 0.08], field="velocity")
plt.show()

# %%
# Mean velocities. Each disc passes on what it got while it is still being pressed itself.

figure, axes = plt.subplots(layout="constrained")
for k in range(5):
    axes.plot(history["time"], history[f"disc-{k}.v_x"], label=f"disc {k}")
axes.set_xlabel("time [s]")
axes.set_ylabel("mean velocity [m/s]")
axes.legend()
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/cradle.png'
