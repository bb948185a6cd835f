"""
The tennis racket: a spin that turns over
=========================================

A body that spins about its middle axis of inertia does not go on doing so: it turns over, again and
again, while energy and angular momentum stay what they are. Try it with a racket, a book, a phone.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
from pictures import draw

import carom

racket = carom.RigidBody(
    name="racket",
    density=1000.0,
    mesh=carom.Box(corner=[-0.3, -0.15, -0.05], size=[0.6, 0.3, 0.1], divisions=[6, 3, 1]),
    spin=[0.02, 10.0, 0.0],
)
scenario = carom.Scenario(
    title="A spin that turns over",
    dimension=3,
    analysis=carom.Dynamic(end_time=4.0, time_step=2e-3),
    output=carom.Output(fields_every=0.02),
    bodies=[racket],
)
result = carom.run(scenario, out=mkdtemp())
history = result.history

# %%
# Euler's equations for the spin in the body's own axes, by the classical method of Runge and Kutta, are the other
# opinion. They are compared in the energy and in the time of the first turn.

sides = np.array([0.6, 0.3, 0.1])
inertia = sides.prod() * 1000.0 / 12.0 * ((sides**2).sum() - sides**2)
print("moments of inertia", inertia.round(3), "kg m²")


def rate(spin: np.ndarray) -> np.ndarray:
    """Return how the spin changes in axes of the body [rad/s²]."""
    return np.cross(inertia * spin, spin) / inertia


spin, step, exact = np.array([0.02, 10.0, 0.0]), 1e-4, []
for _ in range(40_000):
    exact.append(spin)
    a = rate(spin)
    b = rate(spin + step / 2 * a)
    c = rate(spin + step / 2 * b)
    spin = spin + step / 6 * (a + 2 * b + 2 * c + rate(spin + step * c))
first = step * int(np.argmax(np.array(exact)[:, 1] < 0.0))

# %%
# The turn is seen by the corner farthest out: the long side of the body points the other way.

displacement = result.fields["displacement"]
points = result.fields.points
ends = [int(np.argmin(points[:, 1])), int(np.argmax(points[:, 1]))]
times = result.fields.times
axis = np.array([(points + displacement[k])[ends[1]] - (points + displacement[k])[ends[0]] for k in range(len(times))])
drift = np.abs(history["kinetic"] - history["kinetic"][0]).max() / history["kinetic"][0]
print(f"the energy changes by {drift:.0e} of itself")
print(f"Euler's equations turn over at {first:.3f} s")

draw(result, [0.0, 1.0, 1.2, 1.4, 2.0], field="body")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/racket.png'
