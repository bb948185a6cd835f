"""
A bullet and a thin wall
========================

A block flies a sixteenth of its size in a step against a wall that is half as thick as its cells.
Contacts are looked for along its path, and what goes through something unseen fails its step.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
from pictures import draw

import carom

speed = 20.0
bullet = carom.Body(
    name="bullet",
    material="steel",
    mesh=carom.Rectangle(corner=[-0.1, 0.05], size=[0.2, 0.2], divisions=[8, 8]),
    velocity=[0.0, -speed],
)
wall = carom.Body(
    name="wall",
    material="steel",
    mesh=carom.Rectangle(corner=[-0.5, -0.02], size=[1.0, 0.04], divisions=[40, 2]),
)
scenario = carom.Scenario(
    title="A bullet and a thin wall",
    analysis=carom.Dynamic(end_time=0.03, time_step=1e-4),
    output=carom.Output(fields_every=1e-3),
    materials={"steel": carom.NeoHookean(young=5e7, poisson=0.3, density=1000.0)},
    bodies=[bullet, wall],
    contact=carom.Contact(friction=0.2),
)
result = carom.run(scenario, out=mkdtemp())
print(f"deepest penetration {result.summary['penetration']['max_depth']:.0e} m")

# %%
# Colours are von Mises' stress.

draw(result, [0.0, 0.006, 0.02], field="von-mises")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/bullet.png'
