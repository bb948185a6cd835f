"""
Billiard balls in space
=======================

A ball with spin hits two others on a table with friction: an oblique impact in space, in which
friction between the balls and on the table turns spin into motion. The balls are soft, so that
the deformation is seen, and the mesh is coarse, so that this page is quick to make.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
from pictures import draw

import carom

RADIUS = 0.03


def ball(name: str, x: float, y: float, **motion: list[float]) -> carom.Body:
    """Describe a ball on the table."""
    mesh = carom.Ball(centre=[x, y, 1.001 * RADIUS], radius=RADIUS, divisions=4)
    return carom.Body(name=name, material="soft", mesh=mesh, **motion)


scenario = carom.Scenario(
    title="Billiard",
    dimension=3,
    analysis=carom.Dynamic(end_time=0.03, time_step=3e-4, gravity=[0.0, 0.0, -9.81]),
    output=carom.Output(fields_every=1e-3, history_every=3e-4),
    materials={"soft": carom.NeoHookean(young=5e6, poisson=0.35, density=1700.0)},
    bodies=[
        ball("cue", -0.075, 0.008, velocity=[3.0, 0.0, 0.0], spin=[0.0, 0.0, 60.0]),
        ball("second", 0.0, -0.031),
        ball("third", 0.0, 0.031),
    ],
    obstacles=[carom.Plane(name="table", point=[0.0, 0.0, 0.0], normal=[0.0, 0.0, 1.0])],
    contact=carom.Contact(friction=0.2),
)
result = carom.run(scenario, out=mkdtemp())
energy = result.summary["energy"]
print(f"friction took {energy['friction'] / energy['initial']:.2%} of the energy")
print(f"not explained: {energy['max_defect'] / energy['initial']:.1e} of it")

# %%
# Who met whom, when and how hard, as a table of pandas:

meetings = result.to_pandas("contacts")
print(meetings[meetings["second"] != "table"].round(5).to_string(index=False))

# %%
# Before, during and after; colours are the speed.

draw(result, [0.0, 0.012, 0.03], field="velocity")
plt.show()

# %%
# The spin of the cue ball about the vertical, and that which the others get.

figure, axes = plt.subplots(layout="constrained")
for name in ("cue", "second", "third"):
    axes.plot(1e3 * result.history["time"], result.history[f"{name}.spin_z"], label=name)
axes.set_xlabel("time [ms]")
axes.set_ylabel("spin about the vertical [rad/s]")
axes.legend()
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/billiard.png'
