"""
A bowling ball: from sliding to rolling
=======================================

A ball that is thrown without spin slides until friction has given it the spin to roll. It always
ends with five sevenths of its speed, whatever the friction: that only says how soon.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np

import carom

MASS, RADIUS, FRICTION, SPEED, GRAVITY = 6.8, 0.108, 0.15, 7.0, 9.81
ball = carom.RigidBody(
    name="ball",
    mass=MASS,
    round=True,
    mesh=carom.Ball(centre=[0.0, 0.0, RADIUS], radius=RADIUS, divisions=4),
    velocity=[SPEED, 0.0, 0.0],
)
scenario = carom.Scenario(
    title="A bowling ball",
    dimension=3,
    analysis=carom.Dynamic(end_time=2.0, time_step=1e-3, gravity=[0.0, 0.0, -GRAVITY]),
    output=carom.Output(fields_every=0.05),
    bodies=[ball],
    obstacles=[carom.Plane(name="lane", point=[0.0, 0.0, 0.0], normal=[0.0, 0.0, 1.0])],
    contact=carom.Contact(condition="endpoint", friction=FRICTION),
)
result = carom.run(scenario, out=mkdtemp())
history = result.history

# %%
# In closed form it rolls from 2 v₀/(7 μ g) on.

slip = history["ball.v_x"] - RADIUS * history["ball.spin_y"]
rolls = history["time"][np.argmax(np.abs(slip) < 1e-6 * SPEED)]
print(f"rolls from {rolls:.3f} s on, expected {2 * SPEED / (7 * FRICTION * GRAVITY):.3f} s")
print(f"at {history['ball.v_x'][-1]:.4f} m/s, expected {5 / 7 * SPEED:.4f} m/s")

figure, axes = plt.subplots(layout="constrained")
axes.plot(history["time"], history["ball.v_x"], label="velocity")
axes.plot(history["time"], RADIUS * history["ball.spin_y"], label="spin times radius")
axes.set_xlabel("time [s]")
axes.set_ylabel("velocity [m/s]")
axes.legend()
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/bowling.png'
