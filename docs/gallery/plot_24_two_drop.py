"""
A small ball on a large one: thrown higher than it fell
=======================================================

A small disc falls on top of a large one. The large one comes back from the floor and meets the
small one still falling, which leaves with nearly three times the speed that it had, and so rises to
nearly nine times the height.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
from pictures import draw

import carom

SPEED, LARGE, SMALL = 2.0, 0.1, 0.02  # m/s, m, m


def disc(name: str, radius: float, bottom: float) -> carom.RigidBody:
    """Describe a disc that falls."""
    return carom.RigidBody(
        name=name,
        density=1000.0,
        round=True,
        mesh=carom.Disc(centre=[0.0, bottom + radius], radius=radius, divisions=6),
        velocity=[0.0, -SPEED],
    )


scenario = carom.Scenario(
    title="A small ball on a large one",
    analysis=carom.Dynamic(end_time=0.1, time_step=1e-4),
    output=carom.Output(fields_every=1e-3),
    bodies=[disc("large", LARGE, 0.02), disc("small", SMALL, 0.02 + 2 * LARGE + 0.01)],
    obstacles=[carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])],
    contact=carom.Contact(condition="endpoint", friction=0.0, restitution=1.0),
)
result = carom.run(scenario, out=mkdtemp())
history = result.history

# %%
# Two impacts without loss, one after the other: v = v₀ (3 M − m)/(M + m).

ratio = (LARGE / SMALL) ** 2
expected = SPEED * (3.0 * ratio - 1.0) / (ratio + 1.0)
print(f"the small disc leaves at {history['small.v_y'][-1]:.4f} m/s, expected {expected:.4f} m/s")

draw(result, [0.0, 0.016, 0.03], field="velocity")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/two-drop.png'
