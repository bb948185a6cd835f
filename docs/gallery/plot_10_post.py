"""
A plate on a post: corners and edges of obstacles
=================================================

A coarse plate falls on a post that is narrower than its cells: no node of the plate ever comes near
the post. It is the corners of the post that meet the facets of the plate, and its edges that cross
theirs.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
from pictures import draw

import carom

plate = carom.Body(
    name="plate",
    material="rubber",
    mesh=carom.Box(corner=[-0.5, -0.5, 0.31], size=[1.0, 1.0, 0.1], divisions=[5, 5, 2]),
)
scenario = carom.Scenario(
    title="A plate on a post",
    dimension=3,
    analysis=carom.Dynamic(end_time=1.0, time_step=2e-3, gravity=[0.0, 0.0, -9.81]),
    output=carom.Output(fields_every=0.05),
    materials={
        "rubber": carom.NeoHookean(
            young=1e6, poisson=0.3, density=1000.0, damping=carom.Damping(mass=5.0, stiffness=1e-3)
        )
    },
    bodies=[plate],
    obstacles=[
        carom.RigidBox(name="post", corner=[-0.08, -0.08, 0.0], size=[0.16, 0.16, 0.3]),
    ],
    contact=carom.Contact(friction=0.3),
)

# %%
# Nothing is in anything: the two differ by round-off.

result = carom.run(scenario, out=mkdtemp())
print(f"deepest penetration {result.summary['penetration']['max_depth']:.0e} m")

# %%
# Colours are von Mises' stress.

draw(result, [0.0, 0.2, 1.0], field="von-mises")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/post.png'
