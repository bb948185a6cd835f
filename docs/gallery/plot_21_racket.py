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
# The other opinion: Euler's equations for the spin in the axes of the body, by the method of Runge
# and Kutta.

sides = np.array([0.6, 0.3, 0.1])
inertia = sides.prod() * 1000.0 / 12.0 * ((sides**2).sum() - sides**2)
print("moments of inertia", inertia.round(3), "kg m²")


def rate(spin: np.ndarray) -> np.ndarray:
    """Return how the spin changes in axes of the body [rad/s²]."""
    return np.asarray(np.cross(inertia * spin, spin) / inertia)


spin, step, middle = np.array([0.02, 10.0, 0.0]), 1e-3, []
for _ in range(4000):
    middle.append(spin[1])
    a = rate(spin)
    b = rate(spin + step / 2 * a)
    c = rate(spin + step / 2 * b)
    spin = spin + step / 6 * (a + 2 * b + 2 * c + rate(spin + step * c))
expected = step * np.flatnonzero(np.diff(np.sign(middle)))

# %%
# The middle axis of the body, as its nodes show it, points up and down by turns.

fields = result.fields
corner = fields.points[0]
along = int(np.argmin(np.abs(fields.points - corner - [0.0, 0.3, 0.0]).sum(axis=1)))
moved = [fields.points + displacement for displacement in fields["displacement"]]
points = np.array([places[along] - places[0] for places in moved])
found = fields.times[np.flatnonzero(np.diff(np.sign(points[:, 1])))]
drift = np.abs(history["kinetic"] / history["kinetic"][0] - 1.0).max()
print("turns over at", found.round(2), "s; by Euler's equations at", expected.round(2), "s")
print(f"the energy changes by at most {drift:.0e} of itself")

draw(result, [0.0, 1.0, 1.1, 1.2], field="body")
plt.show()

figure, axes = plt.subplots(layout="constrained")
axes.plot(fields.times, points[:, 1] / 0.3)
for time in expected:
    axes.axvline(time, color="0.6", linestyle=":")
axes.set_xlabel("time [s]; dotted: the turns by Euler's equations")
axes.set_ylabel("upward part of the middle axis")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/racket.png'
