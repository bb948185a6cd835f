"""
Stick and slip: why bows sing and brakes squeal
===============================================

A block on a moving belt is held by a spring. It rides with the belt until the spring pulls harder
than static friction holds, slips back, and sticks again: steady motion in, oscillation out.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
from pictures import draw

import carom

MASS, STIFFNESS, BELT, STATIC, KINETIC, GRAVITY = 1.0, 100.0, 0.1, 0.5, 0.3, 10.0
block = carom.RigidBody(
    name="block",
    mass=MASS,
    mesh=carom.Rectangle(corner=[0.0, 0.0], size=[0.2, 0.1], divisions=[2, 1]),
    velocity=[BELT, 0.0],
)
spring = carom.Spring(
    name="spring",
    between=(carom.Place(body="block", point=[0.0, 0.05]), carom.Place(point=[-0.5, 0.05])),
    stiffness=STIFFNESS,
)
belt = carom.Plane(
    name="belt", point=[0.0, 0.0], normal=[0.0, 1.0], motion=carom.Displacement(x=f"{BELT}*t")
)
scenario = carom.Scenario(
    title="Stick and slip",
    analysis=carom.Dynamic(end_time=4.0, time_step=1e-3, gravity=[0.0, -GRAVITY]),
    output=carom.Output(fields_every=0.02),
    bodies=[block],
    springs=[spring],
    obstacles=[belt],
    contact=carom.Contact(
        condition="endpoint", friction=carom.StaticKinetic(static=STATIC, kinetic=KINETIC)
    ),
)
result = carom.run(scenario, out=mkdtemp())
history = result.history
draw(result, [0.0, 0.5, 0.8], field="velocity", edges=False)

# %%
# In closed form: the block slips when k x = μ_s m g, then swings about μ_k m g / k with ω = √(k/m).

ride = STATIC * MASS * GRAVITY / STIFFNESS / BELT
print(f"first slip expected at {ride:.3f} s")
x = history["block.x"] - history["block.x"][0]
rides = history["block.v_x"] >= 0.99 * BELT
slips = np.flatnonzero(rides[:-1] & ~rides[1:])
print("slips begin at", history["time"][slips].round(3), "s")
omega = np.sqrt(STIFFNESS / MASS)
jump = (STATIC - KINETIC) * MASS * GRAVITY / STIFFNESS
swing = 2.0 * (np.pi - np.arctan(jump * omega / BELT)) / omega
period = swing + 2.0 * jump / BELT
print(f"period expected {period:.3f} s, found {np.diff(history['time'][slips]).mean():.3f} s")

figure, axes = plt.subplots(layout="constrained")
axes.plot(history["time"], 1e3 * x)
axes.set_xlabel("time [s]")
axes.set_ylabel("way of the block [mm]")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/stick-slip.png'
