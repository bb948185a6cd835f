"""
A ring thrown at a wall
=======================

A thin ring folds upon itself. Nothing is said of that in the case: every body may touch itself, and
is searched for it once it has come near.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
from pictures import draw

import carom

ring = carom.Body(
    name="ring",
    material="rubber",
    mesh=carom.Ring(centre=[0.0, 0.0], inner_radius=0.8, outer_radius=1.0, divisions=[60, 3]),
    velocity=[15.0, -5.0],
)
scenario = carom.Scenario(
    title="A ring thrown at a wall",
    analysis=carom.Dynamic(end_time=0.3, time_step=4e-4),
    output=carom.Output(fields_every=5e-3),
    materials={"rubber": carom.NeoHookean(young=1e6, poisson=0.3, density=1000.0)},
    bodies=[ring],
    obstacles=[carom.Plane(name="wall", point=[1.1, 0.0], normal=[-1.0, 0.0])],
    contact=carom.Contact(friction=0.5),
)
result = carom.run(scenario, out=mkdtemp())
own = [c for c in result.summary["contacts"] if c["pair"] == ["ring", "ring"]]
print(f"the ring touches itself first at {own[0]['onset']:.3f} s")

# %%
# Colours are von Mises' stress.

draw(result, [0.0, 0.1, 0.15, 0.3], field="von-mises")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/thumbnail-ring.png'
