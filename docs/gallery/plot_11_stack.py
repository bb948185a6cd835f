"""
A stack at rest: flush boxes of unequal meshes
==============================================

Five boxes with flush sides, whose meshes do not fit, stand on one another. Nodes of both sides are
checked, so no box sinks into another and none slides.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
from pictures import draw

import carom

boxes = [
    carom.Body(
        name=f"box-{k}",
        material="rubber",
        mesh=carom.Rectangle(corner=[0.0, float(k)], size=[1.0, 1.0], divisions=[cells, cells]),
    )
    for k, cells in enumerate([4, 6, 4, 6, 4])
]
scenario = carom.Scenario(
    title="A stack at rest",
    analysis=carom.Dynamic(end_time=3.0, time_step=2e-3, gravity=[0.0, -9.81]),
    output=carom.Output(fields_every=0.1, history_every=0.02),
    materials={
        "rubber": carom.NeoHookean(
            young=1e6, poisson=0.3, density=1000.0, damping=carom.Damping(mass=5.0, stiffness=1e-3)
        )
    },
    bodies=boxes,
    obstacles=[carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])],
    contact=carom.Contact(friction=0.3),
)
result = carom.run(scenario, out=mkdtemp())
print(f"deepest penetration {result.summary['penetration']['max_depth']:.0e} m")

# %%
# Colours are von Mises' stress.

draw(result, [0.0, 0.2, 3.0], field="von-mises")
plt.show()

# %%
# What moves comes to rest.

figure, axes = plt.subplots(layout="constrained")
axes.semilogy(result.history["time"][1:], result.history["kinetic"][1:])
axes.set_xlabel("time [s]")
axes.set_ylabel("kinetic energy, of 1 m of depth [J]")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/stack.png'
