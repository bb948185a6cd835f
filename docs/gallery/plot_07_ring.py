"""
A ring that is crushed: contact of a body with itself
=====================================================

A thin rubber ring is pressed flat between two plates until its inside touches itself.
Nothing needs to be said for that: every body may touch itself.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
from pictures import draw

import carom

ring = carom.Body(
    name="ring",
    material="rubber",
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

# %%
# An observer looks at the run as it goes. This one notes the way of the stamp, and the force with
# which it presses, which the history, having all contacts in one, does not tell.

ways: list[float] = []
forces: list[float] = []


def note_force(state: carom.State) -> None:
    """Note how far down the stamp is [m] and with what force it presses [N]."""
    ways.append(1.65 * state.time)
    forces.append(-state.contacts.force("ring", by="stamp")[1])


observer = carom.Observer(note_force, every=5e-3)
result = carom.run(scenario, out=mkdtemp(), observers=[observer])
own = [c for c in result.summary["contacts"] if c["pair"] == ["ring", "ring"]]
print(f"the ring touches itself first at {own[0]['onset']:.3f} s")

# %%
# Colours are von Mises' stress.

draw(result, [0.3, 0.7, 1.0], field="von-mises")
plt.show()

# %%
# The ring gives way softly, until its halves meet.

figure, axes = plt.subplots(layout="constrained")
axes.plot(ways, forces)
axes.axvline(1.65 * own[0]["onset"], color="0.6", linestyle=":")
axes.set_xlabel("way of the stamp [m]; dotted: the ring touches itself")
axes.set_ylabel("force of the stamp, on 1 m of depth [N]")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/ring.png'
