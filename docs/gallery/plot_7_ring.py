"""
A ring that is crushed: contact of a body with itself
=====================================================

A thin rubber ring is pressed flat between two plates until its inside touches itself.
``self_contact`` is all that it takes.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
from pictures import draw

import carom

ring = carom.Body(
    name="ring",
    material="rubber",
    self_contact=True,
    mesh=carom.Ring(centre=[0.0, 0.0], inner_radius=0.8, outer_radius=1.0, divisions=[64, 3]),
)
stamp = carom.Displacement(y="-1.65*min(t, 1)")
scenario = carom.Scenario(
    title="A ring is crushed",
    analysis=carom.Dynamic(end_time=1.0, time_step=4e-3),
    output=carom.Output(fields_every=0.02, history_every=4e-3),
    materials={
        "rubber": carom.NeoHookean(
            young=1e4, poisson=0.4, density=1.0, damping=carom.Damping(stiffness=2e-3)
        )
    },
    bodies=[ring],
    obstacles=[
        carom.Plane(name="bed", point=[0.0, -1.001], normal=[0.0, 1.0]),
        carom.Plane(name="stamp", point=[0.0, 1.001], normal=[0.0, -1.0], motion=stamp),
    ],
    contact=carom.Contact(friction=0.3),
)
result = carom.run(scenario, out=mkdtemp())
own = [c for c in result.summary["contacts"] if c["pair"] == ["ring", "ring"]]
print(f"the ring touches itself first at {own[0]['onset']:.3f} s")

# %%
# Colours are von Mises' stress.

draw(result, [0.3, 0.7, 1.0], field="von-mises")
plt.show()
