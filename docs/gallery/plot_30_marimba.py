"""
A marimba: where to strike a bar
================================

A bar that nothing holds is struck by a mallet of hard rubber. Which of its modes ring, and so how
it sounds, hangs on the place: a mode that does not move there has nothing of the energy. The bar is
a reduced body, which vibrates in few shapes, and carom splits its energy over them.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
from pictures import draw

import carom

LENGTH, HEIGHT, RADIUS, SPEED = 0.36, 0.02, 0.015, 1.0
MODES = 4


def strike(place: float) -> carom.Result:
    """Return the run in which the mallet comes down at a place, from 0 at an end to 1."""
    bar = carom.ReducedBody(
        name="bar",
        material="rosewood",
        hypothesis="plane-stress",
        thickness=0.05,
        mesh=carom.Rectangle(corner=[0.0, 0.0], size=[LENGTH, HEIGHT], divisions=[72, 4]),
        contact_sets=["top"],
        modes=12,
    )
    mallet = carom.Body(
        name="mallet",
        material="rubber",
        hypothesis="plane-stress",
        thickness=0.03,
        mesh=carom.Disc(centre=[place * LENGTH, HEIGHT + RADIUS], radius=RADIUS, divisions=6),
        velocity=[0.0, -SPEED],
    )
    scenario = carom.Scenario(
        title="A struck bar",
        analysis=carom.Dynamic(end_time=2e-3, time_step=4e-6),
        output=carom.Output(fields_every=1e-4),
        materials={
            "rosewood": carom.LinearElastic(young=16e9, poisson=0.3, density=800.0),
            "rubber": carom.LinearElastic(young=500e6, poisson=0.4, density=1200.0),
        },
        bodies=[bar, mallet],
    )
    return carom.run(scenario, out=mkdtemp())


# %%
# The first mode of a free bar has its nodes at 22.4 % of the length, where marimbas have their
# cords; the second one moves nothing in the middle.

PLACES = {"in the middle": 0.5, "between": 0.36, "at the cord": 0.224, "near the end": 0.06}
runs = {name: strike(place) for name, place in PLACES.items()}
shares = {}
for name, result in runs.items():
    energies = carom.modal_energies(result, count=MODES, bodies=["bar"])["bar"]
    rings = energies.energies[-1]
    shares[name] = rings / result.summary["energy"]["initial"]
    told = ", ".join(f"{share:.1%}" for share in shares[name])
    print(f"{name}: {told} of the energy in modes 1 to {MODES}")
print("frequencies:", ", ".join(f"{f:.0f} Hz" for f in energies.frequencies))

# %%
# Its energy by modes, as the mallet has left.

figure, axes = plt.subplots(layout="constrained")
for k, (name, values) in enumerate(shares.items()):
    axes.bar(np.arange(1, MODES + 1) + 0.2 * (k - 1.5), 100 * values, 0.2, label=name)
axes.set_xticks(range(1, MODES + 1))
axes.set_xlabel("mode")
axes.set_ylabel("share of the energy [%]")
axes.legend(frameon=False)
plt.show()

# %%
# The bar after the blow near its end; displacements are a hundred times as large.

draw(runs["near the end"], [4e-4, 8e-4], field="von-mises", magnification=100.0)
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/marimba.png'
