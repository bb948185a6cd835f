"""
Hertz: a ball pressed into a block
==================================

A rigid ball of radius 1 m is pressed into an elastic block, static, as a body of revolution. It
is the template ``static-hertz`` of ``carom new``. Hertz gives the force F = 4/3 E* √R δ^(3/2) for
a half-space; the block is held at its bottom and so is somewhat stiffer.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
from pictures import draw

import carom

epoxy = carom.LinearElastic(young=3e9, poisson=0.35, density=1200.0)
block = carom.Body(
    name="block",
    material="epoxy",
    hypothesis="axisymmetric",
    mesh=carom.Rectangle(corner=[0.0, -0.1], size=[0.1, 0.1], divisions=[60, 60]),
)
ball = carom.RigidSphere(
    name="ball", centre=[0.0, 1.0], radius=1.0, motion=carom.Displacement(y="-80e-6*t")
)
scenario = carom.Scenario(
    title="Static Hertz contact",
    analysis=carom.Static(end_time=1.0, time_step=0.1),
    output=carom.Output(fields_every=0.1, history_every=0.1),
    materials={"epoxy": epoxy},
    bodies=[block],
    motions=[carom.Fixed(body="block", on="bottom")],
    obstacles=[ball],
)
result = carom.run(scenario, out=mkdtemp())

# %%
# Force against depth.

depth = 80e-6 * result.history["time"]
stiffness = 4 / 3 * epoxy.young / (1 - epoxy.poisson**2)
hertz = stiffness * np.sqrt(ball.radius) * depth**1.5
force = result.history["normal_force"]
print(f"at {1e6 * depth[-1]:.0f} µm: {force[-1]:.0f} N, Hertz {hertz[-1]:.0f} N")

figure, axes = plt.subplots(layout="constrained")
axes.plot(1e6 * depth, force, "o", label="carom, block of 0.1 m")
axes.plot(1e6 * depth, hertz, label="Hertz, half-space")
axes.set_xlabel("depth [µm]")
axes.set_ylabel("force [N]")
axes.legend()
plt.show()

# %%
# Stress at the end. The largest is below the surface, where metals begin to yield: about half the
# radius of contact √(R δ) deep. Fields are read where they are indexed, here one frame.

fields = result.fields
normal, shear = np.split(fields["stress"][-1], 2, axis=1)  # xx yy zz and xy yz xz of every cell
deviator = normal - normal.mean(axis=1, keepdims=True)
mises = np.sqrt(1.5 * (deviator**2 + 2.0 * shear**2).sum(axis=1))
middles = fields.points[fields.connectivity].mean(axis=1)
radius = np.sqrt(ball.radius * depth[-1])
print(f"largest at {-middles[mises.argmax(), 1] / radius:.2f} times the radius of contact deep")

draw(result, [1.0], field="von-mises", magnification=50.0)
plt.show()

# sphinx_gallery_thumbnail_path = 'images/thumbnail-hertz.png'
