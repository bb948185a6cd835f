"""
Dominoes: a row that falls by itself
====================================

The first of twelve dominoes is pushed. Each falls upon the next, and energy that was stored in
standing upright feeds a wave of falling that soon has a speed of its own.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
from pictures import draw

import carom

HEIGHT, WIDTH, SPACING, COUNT = 0.044, 0.0075, 0.022, 12
dominoes = [
    carom.RigidBody(
        name=f"domino-{k}",
        density=1000.0,
        mesh=carom.Rectangle(corner=[SPACING * k, 0.0], size=[WIDTH, HEIGHT], divisions=[1, 4]),
        spin=-16.0 if k == 0 else 0.0,
    )
    for k in range(COUNT)
]
scenario = carom.Scenario(
    title="Dominoes",
    analysis=carom.Dynamic(end_time=0.55, time_step=1e-4, gravity=[0.0, -9.81]),
    output=carom.Output(fields_every=0.01),
    bodies=dominoes,
    obstacles=[carom.Plane(name="table", point=[0.0, 0.0], normal=[0.0, 1.0])],
    contact=carom.Contact(condition="endpoint", friction=0.4, restitution=0.0),
)
result = carom.run(scenario, out=mkdtemp())
history = result.history

# %%
# When each begins to turn, and how fast the wave is.

turning = [history[f"domino-{k}.spin"] < -0.5 for k in range(COUNT)]
assert all(turns.any() for turns in turning)
starts = np.array([history["time"][turns.argmax()] for turns in turning])
speed = SPACING / np.diff(starts)
print("speed of the wave from each to the next [m/s]:", speed.round(2))
lost = history["friction"][-1] + history["normal_contact"][-1]
defect = result.summary["energy"]["max_defect"]
print(f"friction and impacts took {lost:.3f} J; not explained: {defect:.0e} J")

draw(result, [0.0, 0.15, 0.3, 0.55], field="body")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/dominoes.png'
