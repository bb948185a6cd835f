"""
Backspin: a ball that comes back
================================

A ball is thrown forward with backspin. At every bounce friction turns spin into motion, until it
rolls, or comes back: what a table-tennis player does with a chop.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np

import carom

RADIUS, FRICTION, RESTITUTION, GRAVITY = 0.02, 0.25, 0.8, 9.81
FORWARD, SPIN, HEIGHT = 0.6, 120.0, 0.2
ball = carom.RigidBody(
    name="ball",
    density=100.0,
    round=True,
    mesh=carom.Disc(centre=[0.0, HEIGHT + RADIUS], radius=RADIUS, divisions=8),
    velocity=[FORWARD, 0.0],
    spin=SPIN,
)
scenario = carom.Scenario(
    title="Backspin",
    analysis=carom.Dynamic(end_time=1.2, time_step=5e-4, gravity=[0.0, -GRAVITY]),
    output=carom.Output(fields_every=0.01),
    bodies=[ball],
    obstacles=[carom.Plane(name="table", point=[0.0, 0.0], normal=[0.0, 1.0])],
    contact=carom.Contact(condition="endpoint", friction=FRICTION, restitution=RESTITUTION),
)
result = carom.run(scenario, out=mkdtemp())
history = result.history

# %%
# The first bounce in closed form. Sliding friction takes Δv = μ (1 + e) v_n as long as the lowest
# point slides, and leaves it at rest otherwise; a disc has κ = 3.

falling = np.sqrt(2.0 * GRAVITY * HEIGHT)
sliding = FORWARD + SPIN * RADIUS
loss = min(FRICTION * (1.0 + RESTITUTION) * falling, sliding / 3.0)
after = int(np.argmax(history["ball.v_y"] > 0.0))
found, expected = history["ball.v_x"][after], FORWARD - loss
print(f"after the first bounce {found:+.4f} m/s, expected {expected:+.4f} m/s")
print(f"at the end {history['ball.v_x'][-1]:+.4f} m/s")

# %%
# The way of its centre.

figure, axes = plt.subplots(layout="constrained")
axes.plot(history["ball.x"], history["ball.y"])
axes.set_xlabel("x [m]")
axes.set_ylabel("height of the centre [m]")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/backspin.png'
